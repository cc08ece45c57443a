// SPDX-License-Identifier: MIT
// Clips as files: what opening accepts, what it refuses and how, and what damaged bytes lead to.
#include "runtime/anim/clip.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "runtime/base/mapped_file.h"
#include "tests/support/bytes.h"
#include "tests/support/exercise_clip.h"
#include "tests/support/long_run.h"
#include "tests/support/made_clip.h"
#include "tests/support/temporary_path.h"

namespace mien {
namespace {

/// A bit of everything: constant, solved and captured channels, events, three blocks.
ClipInput small_input() {
  const Curves smooth = clean_solve(3, 150), noisy = phone_capture(3, 150);
  Curves curves(40, 150);
  for (uint32_t f = 0; f < 150; ++f) {
    for (uint32_t c = 0; c < 20; ++c) curves.at(f, c) = smooth.at(f, c);
    for (uint32_t c = 0; c < 18; ++c) curves.at(f, 20 + c) = noisy.at(f, 43 + c);
    curves.at(f, 38) = 0.25f;
  }
  ClipInput input(curves);
  input.events = {{705600000, "step", 1}, {0, "start", 0.5f}, {705600000, "breath", -2}};
  return input;
}

Status open_bytes(const Bytes& bytes, Error& error) {
  Clip clip;
  const Status status = open_clip(bytes.data(), bytes.size(), clip, error);
  EXPECT_EQ(status == Status::kOk, clip.bytes != nullptr);
  return status;
}

/// With the checksum that belongs to the bytes.
Bytes sealed(Bytes bytes) {
  store_little_endian(bytes.data() + kAtChecksum, clip_checksum(bytes.data(), bytes.size()));
  return bytes;
}

std::string text(Span<const char> name) { return {name.data, name.count}; }

TEST(ClipChecksum, IsTheOneOfCastagnoli) {
  const uint8_t digits[] = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(crc32c(digits, 9), 0xE3069283u);
  EXPECT_EQ(crc32c(digits, 0), 0u);
}

TEST(ClipRate, FramesOfUsualRatesAreWholeTicks) {
  for (uint32_t rate : {24u, 25u, 30u, 48u, 50u, 60u, 90u, 100u, 120u, 240u, 1000u}) {
    EXPECT_EQ(ticks_per_frame(rate, 1) * rate, kTicksPerSecond) << rate;
  }
  for (uint32_t rate : {24000u, 30000u, 60000u}) {
    EXPECT_EQ(ticks_per_frame(rate, 1001) * rate, kTicksPerSecond * 1001) << rate;
  }
}

TEST(ClipRate, OthersAreRoundedToTheNearestTick) {
  EXPECT_EQ(ticks_per_frame(2997, 50), 11771772);  // 11771771.77
  EXPECT_EQ(ticks_per_frame(1411200000, 1), 1);    // half a tick
}

TEST(ClipRate, RatesOutOfRangeHaveNone) {
  EXPECT_EQ(ticks_per_frame(0, 1), 0);
  EXPECT_EQ(ticks_per_frame(1, 0), 0);
  EXPECT_EQ(ticks_per_frame(1, 7), 0);
  EXPECT_EQ(ticks_per_frame(1500000000, 1), 0);
  EXPECT_GT(ticks_per_frame(1, 6), 0);
  EXPECT_EQ(ticks_per_frame(UINT32_MAX, UINT32_MAX), kTicksPerSecond);
}

TEST(Clip, TellsWhatItWasBuiltOf) {
  ClipInput input = small_input();
  input.rate_numerator = 30000;
  input.rate_denominator = 1001;
  input.wraps = input.is_delta = true;
  const MadeClip made(input);
  const Clip& clip = made.clip;
  EXPECT_EQ(clip.frame_count, 150u);
  EXPECT_EQ(clip.channel_count, 40u);
  EXPECT_LE(clip.changing_count, 38u);
  EXPECT_EQ(clip.rate_numerator, 30000u);
  EXPECT_EQ(clip.rate_denominator, 1001u);
  EXPECT_EQ(clip.length(false), 149 * clip.ticks_per_frame);
  EXPECT_EQ(clip.length(true), 150 * clip.ticks_per_frame);
  EXPECT_TRUE(clip.has(kClipWraps) && clip.has(kClipIsDelta));
  EXPECT_FALSE(clip.has(kClipSnapped) || clip.has(kClipHalfRate));
  EXPECT_EQ(clip.snap, kNoSnap);
  for (uint32_t c = 0; c < 40; ++c) {
    EXPECT_EQ(text(clip.name(c)), input.names[c]) << "channels keep their order";
    EXPECT_EQ(find_channel(clip, clip.name(c)), c);
  }
  EXPECT_EQ(clip.rest(38), 0.25f);
  EXPECT_EQ(find_channel(clip, {"control0", 8}), kNoChannel);
}

TEST(Clip, EventsAreInOrderOfTimeThenOfInput) {
  const MadeClip made(small_input());
  ASSERT_EQ(made.clip.event_count, 3u);
  const char* names[] = {"start", "step", "breath"};
  const float values[] = {0.5f, 1, -2};
  const int64_t ticks[] = {0, 705600000, 705600000};
  for (uint32_t e = 0; e < 3; ++e) {
    const ClipEvent event = made.clip.event(e);
    EXPECT_EQ(text(event.name), names[e]);
    EXPECT_EQ(event.value, values[e]);
    EXPECT_EQ(event.tick, ticks[e]);
  }
}

TEST(Clip, IsReadAtAnyAddress) {
  const MadeClip made(small_input());
  const Curves expected = decoded(made.clip);
  for (size_t shift = 1; shift < 8; ++shift) {
    Bytes room(made.bytes.size() + shift);
    memcpy(room.data() + shift, made.bytes.data(), made.bytes.size());
    Clip clip;
    Error error;
    ASSERT_EQ(open_clip(room.data() + shift, made.bytes.size(), clip, error), Status::kOk);
    EXPECT_EQ(verify_clip(clip, error), Status::kOk);
    EXPECT_TRUE(same_bits(decoded(clip), expected));
  }
}

TEST(Clip, IsUsedInAMappedFile) {
  const MadeClip made(small_input());
  const std::string path = temporary_path("clip");
  Error error;
  ASSERT_EQ(
      write_file(path.c_str(), made.bytes.data(), made.bytes.size(), default_allocator(), error),
      Status::kOk);
  MappedFile file;
  ASSERT_EQ(open_file(path.c_str(), FileAccess::kMap, {}, default_allocator(), file, error),
            Status::kOk);
  Clip clip;
  ASSERT_EQ(open_clip(file.bytes, file.size, clip, error), Status::kOk) << error.message;
  EXPECT_TRUE(same_bits(decoded(clip), decoded(made.clip)));
  close_file(file);
  remove(path.c_str());
}

TEST(Clip, OfConstantsAndEventsHasNoBlocks) {
  Curves curves(2, 1000);
  for (uint32_t f = 0; f < 1000; ++f) curves.at(f, 1) = -0.0f;
  ClipInput input(curves);
  input.events = {{5, "hit", 1}};
  const MadeClip made(input);
  EXPECT_EQ(made.clip.block_count(), 0u);
  EXPECT_LT(made.bytes.size(), 250u);
  EXPECT_TRUE(same_bits(decoded(made.clip), curves));
}

TEST(Clip, MayHaveNoChannels) {
  ClipInput input(Curves(0, 3));
  input.events = {{5, "hit", 1}};
  const MadeClip made(input);
  EXPECT_EQ(OwnSampler(made.clip).at_tick(0).count, 0u);
}

// Wrong files -------------------------------------------------------------------------------------

TEST(ClipRefuses, OtherFiles) {
  Error error;
  EXPECT_EQ(open_bytes({}, error), Status::kClipSignature);
  EXPECT_EQ(open_bytes(Bytes(200, 0), error), Status::kClipSignature);
  Bytes bytes = small_input().build();
  bytes[3] ^= 0x20;
  EXPECT_EQ(open_bytes(bytes, error), Status::kClipSignature);
  bytes = small_input().build();
  bytes.resize(kClipHeaderSize - 1);
  EXPECT_EQ(open_bytes(bytes, error), Status::kClipSignature);
}

TEST(ClipRefuses, OtherVersions) {
  Bytes bytes = small_input().build();
  store_little_endian<uint32_t>(bytes.data() + kAtVersion, kClipVersion + 1);
  Error error;
  EXPECT_EQ(open_bytes(bytes, error), Status::kClipVersion);
  EXPECT_EQ(error.byte_offset, kAtVersion);
  EXPECT_NE(std::string(error.message).find("version " + std::to_string(kClipVersion + 1)),
            std::string::npos)
      << error.message;
}

TEST(ClipRefuses, EveryTruncation) {
  const Bytes bytes = small_input().build();
  for (size_t size = kClipHeaderSize; size < bytes.size(); ++size) {
    const Bytes part(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(size));
    Error error;
    ASSERT_EQ(open_bytes(part, error), Status::kClipTruncated) << size;
    ASSERT_EQ(error.byte_offset, size);
    // Also if the header agrees with what is left.
    Bytes trimmed = part;
    store_little_endian<uint64_t>(trimmed.data() + kAtSize, size);
    ASSERT_EQ(open_bytes(trimmed, error), Status::kClipStructure) << size;
  }
}

TEST(ClipRefuses, BytesAfterTheEnd) {
  Bytes bytes = small_input().build();
  bytes.resize(bytes.size() + 8);
  Error error;
  EXPECT_EQ(open_bytes(bytes, error), Status::kClipStructure);
  store_little_endian<uint64_t>(bytes.data() + kAtSize, bytes.size());
  EXPECT_EQ(open_bytes(bytes, error), Status::kClipStructure);
}

struct Forgery {
  const char* name;
  void (*apply)(Bytes& bytes, const Clip& clip);
};
void PrintTo(const Forgery& forgery, std::ostream* out) { *out << forgery.name; }
std::string forgery_name(const testing::TestParamInfo<Forgery>& info) { return info.param.name; }

template <class T>
void put(Bytes& bytes, uint64_t at, T value) {
  store_little_endian<T>(bytes.data() + at, value);
}
constexpr size_t kFlags = 24, kRate = 28, kFrames = 36, kChannels = 40, kChanging = 44,
                 kEvents = 48, kNames = 52, kNameBytes = 56, kSnap = 60;

const Forgery kForgeries[] = {
    {"UnknownFlag", [](Bytes& b, const Clip&) { put<uint32_t>(b, kFlags, 16); }},
    {"HalfRateOfAnEvenNumber", [](Bytes& b, const Clip&) { put<uint32_t>(b, kFlags, 4); }},
    {"RateOfZero", [](Bytes& b, const Clip&) { put<uint32_t>(b, kRate, 0); }},
    {"RateOverZero", [](Bytes& b, const Clip&) { put<uint32_t>(b, kRate + 4, 0); }},
    {"NoFrames", [](Bytes& b, const Clip&) { put<uint32_t>(b, kFrames, 0); }},
    {"FramesWithoutBlocks", [](Bytes& b, const Clip&) { put<uint32_t>(b, kFrames, 1u << 28); }},
    {"TooManyFrames", [](Bytes& b, const Clip&) { put<uint32_t>(b, kFrames, UINT32_MAX); }},
    {"TooManyChannels", [](Bytes& b, const Clip&) { put<uint32_t>(b, kChannels, UINT32_MAX); }},
    {"OneMoreChannel", [](Bytes& b, const Clip& c) { put(b, kChannels, c.channel_count + 1); }},
    {"MoreChangingThanChannels", [](Bytes& b, const Clip&) { put<uint32_t>(b, kChanging, 41); }},
    {"TooManyChanging",
     [](Bytes& b, const Clip&) {
       put<uint32_t>(b, kChanging, 513);
       put<uint32_t>(b, kChannels, 0xFFFF);
     }},
    {"ManyEvents", [](Bytes& b, const Clip&) { put<uint32_t>(b, kEvents, UINT32_MAX); }},
    {"ManyNames", [](Bytes& b, const Clip&) { put<uint32_t>(b, kNames, UINT32_MAX); }},
    {"FewerNamesThanChannels", [](Bytes& b, const Clip&) { put<uint32_t>(b, kNames, 39); }},
    {"LongNames", [](Bytes& b, const Clip&) { put<uint32_t>(b, kNameBytes, UINT32_MAX); }},
    {"ShortNames", [](Bytes& b, const Clip& c) { put(b, kNameBytes, c.name_bytes - 1); }},
    {"StepWithoutItsFlag", [](Bytes& b, const Clip&) { put<uint32_t>(b, kSnap, 9); }},
    {"FlagWithoutItsStep", [](Bytes& b, const Clip&) { put<uint32_t>(b, kFlags, kClipSnapped); }},
    {"StepOutOfRange",
     [](Bytes& b, const Clip&) {
       put<uint32_t>(b, kFlags, kClipSnapped);
       put<uint32_t>(b, kSnap, 17);
     }},
    {"EmptyName", [](Bytes& b, const Clip& c) { put<uint32_t>(b, c.at.name_ends, 0); }},
    {"NamesThatGoBack", [](Bytes& b, const Clip& c) { put<uint32_t>(b, c.at.name_ends + 8, 3); }},
    {"NameBeyondTheOthers",
     [](Bytes& b, const Clip& c) { put<uint32_t>(b, c.at.name_ends + 8, 0x7FFFFFFF); }},
    {"RestOfInfinity",
     [](Bytes& b, const Clip& c) {
       put<float>(b, c.at.rests + 4, std::numeric_limits<float>::infinity());
     }},
    {"RestOfNaN",
     [](Bytes& b, const Clip& c) {
       put<float>(b, c.at.rests + 4, std::numeric_limits<float>::quiet_NaN());
     }},
    {"ChangingChannelTwice",
     [](Bytes& b, const Clip& c) {
       put<uint16_t>(b, c.at.changing + 2, static_cast<uint16_t>(c.changing(0)));
     }},
    {"ChangingChannelThatIsNone",
     [](Bytes& b, const Clip& c) {
       put<uint16_t>(b, c.at.changing + 2 * (c.changing_count - 1), 40);
     }},
    {"EventsOutOfOrder", [](Bytes& b, const Clip& c) { put<int64_t>(b, c.at.events, 1 << 30); }},
    {"EventBeforeTheBeginning", [](Bytes& b, const Clip& c) { put<int64_t>(b, c.at.events, -1); }},
    {"EventAfterTheEnd",
     [](Bytes& b, const Clip& c) { put<int64_t>(b, c.at.events + 32, c.length(true)); }},
    {"EventWithoutName",
     [](Bytes& b, const Clip& c) { put<uint32_t>(b, c.at.events + 8, c.name_count); }},
    {"EventOfNaN",
     [](Bytes& b, const Clip& c) {
       put<float>(b, c.at.events + 12, std::numeric_limits<float>::quiet_NaN());
     }},
    {"BlocksThatAreLonger",
     [](Bytes& b, const Clip& c) {
       put<uint32_t>(b, c.at.block_ends + 4 * (c.block_count() - 1), UINT32_MAX);
     }},
};

class ClipForgery : public testing::TestWithParam<Forgery> {};

TEST_P(ClipForgery, IsRefusedWithItsPlace) {
  Bytes bytes = small_input().build();
  const MadeClip made(bytes);
  GetParam().apply(bytes, made.clip);
  Error error;
  EXPECT_EQ(open_bytes(sealed(bytes), error), Status::kClipStructure) << error.message;
  EXPECT_LT(error.byte_offset, bytes.size());
  EXPECT_NE(error.message[0], 0);
}

INSTANTIATE_TEST_SUITE_P(All, ClipForgery, testing::ValuesIn(kForgeries), forgery_name);

TEST(ClipVerify, FindsEveryChangedBit) {
  const Bytes bytes = small_input().build();
  for (size_t bit = 0; bit < bytes.size() * 8; bit += 13) {
    Bytes changed = bytes;
    changed[bit / 8] ^= static_cast<uint8_t>(1u << (bit % 8));
    Clip clip;
    Error error;
    if (open_clip(changed.data(), changed.size(), clip, error) != Status::kOk) continue;
    ASSERT_EQ(verify_clip(clip, error), Status::kClipChecksum) << "bit " << bit;
  }
}

TEST(ClipVerify, FindsBlocksThatAreNone) {
  const MadeClip made(small_input());
  const uint64_t ends = made.clip.at.block_ends;
  for (uint32_t end : {0u, 1u, 100000u, UINT32_MAX}) {
    Bytes bytes = made.bytes;
    put<uint32_t>(bytes, ends, end);
    bytes = sealed(bytes);
    Clip clip;
    Error error;
    ASSERT_EQ(open_clip(bytes.data(), bytes.size(), clip, error), Status::kOk) << error.message;
    EXPECT_EQ(verify_clip(clip, error), Status::kClipStructure) << end;
    EXPECT_NE(std::string(error.message).find("block 0"), std::string::npos) << error.message;
  }
}

TEST(ClipVerify, FindsFloatsThatAreNotFinite) {
  Curves curves(1, 2);
  curves.at(0, 0) = 1.41421354f;  // odd bits, on no grid
  curves.at(1, 0) = 1.73205078f;
  const MadeClip made((ClipInput(curves)));
  // Mode 2, order 2, masked 1, short runs 1, shift 5 bits; then the first float, ordered.
  const uint64_t first = made.clip.at.blocks * 8 + 11;
  Bytes bytes = made.bytes;
  for (uint64_t bit = first + 23; bit < first + 31; ++bit) {
    bytes[bit / 8] |= static_cast<uint8_t>(1u << (bit % 8));
  }
  bytes = sealed(bytes);
  Clip clip;
  Error error;
  ASSERT_EQ(open_clip(bytes.data(), bytes.size(), clip, error), Status::kOk);
  EXPECT_EQ(verify_clip(clip, error), Status::kClipStructure);
  OwnSampler own(clip);
  EXPECT_EQ(own.at_frame(0)[0], 0);
  EXPECT_TRUE(own.sampler.decoder.damaged);
}

TEST(ClipDamage, GivesZerosForTheBlockAndNothingElse) {
  const MadeClip made(small_input());
  const Curves expected = decoded(made.clip);
  Bytes bytes = made.bytes;
  put<uint32_t>(bytes, made.clip.at.block_ends, UINT32_MAX);  // of blocks 0 and 1
  Clip clip;
  Error error;
  ASSERT_EQ(open_clip(bytes.data(), bytes.size(), clip, error), Status::kOk);
  OwnSampler own(clip);
  for (uint32_t f = 0; f < 150; ++f) {
    const Span<const float> values = own.at_frame(f);
    for (uint32_t i = 0; i < clip.changing_count; ++i) {
      const uint32_t c = clip.changing(i);
      ASSERT_EQ(values[c], f < 128 ? 0 : expected.at(f, c)) << f;
    }
    EXPECT_EQ(values[38], 0.25f);
  }
  EXPECT_TRUE(own.sampler.decoder.damaged);
}

/// Two blocks of a channel of each kind, for tests of millions.
ClipInput tiny_input() {
  const Curves smooth = clean_solve(3, 80), noisy = phone_capture(3, 80);
  Curves curves(7, 80);
  for (uint32_t f = 0; f < 80; ++f) {
    for (uint32_t c = 0; c < 4; ++c) curves.at(f, c) = smooth.at(f, 4 * c);
    for (uint32_t c = 0; c < 2; ++c) curves.at(f, 4 + c) = noisy.at(f, 51 + c);
    curves.at(f, 6) = 0.25f;
  }
  ClipInput input(curves, kDefaultSnap);
  input.snaps[4] = input.snaps[5] = kNoSnap;
  input.names = {"a", "b", "c", "d", "e", "f", "g"};
  input.events = {{705600000, "step", 1}, {0, "start", 0.5f}};
  return input;
}

/// Any change of any byte, some of them sealed so that only decoding can notice.
TEST(ClipDamage, MutatedBytesAreRefusedOrPlayedSafely) {
  ClipInput half(Curves(4, 129));
  for (uint32_t f = 0; f < 129; ++f) {
    for (uint32_t c = 0; c < 4; ++c) half.curves.at(f, c) = static_cast<float>(f * c) / 128;
  }
  half.wraps = true;
  const Bytes originals[] = {tiny_input().build(), half.build()};
  std::minstd_rand random(first_seed());
  int opened = 0, unnoticed = 0;
  for (size_t i = 0; i < rounds(1500, 10000000); ++i) {
    Bytes bytes = originals[i % 2];
    for (uint32_t changes = 1 + random() % 3; changes > 0; --changes) {
      const size_t limit = random() % 3 == 0 ? kClipHeaderSize : bytes.size();
      uint8_t& byte = bytes[random() % limit];
      const uint8_t values[] = {0, 0xFF, static_cast<uint8_t>(byte ^ (1u << random() % 8)),
                                static_cast<uint8_t>(byte + 1), static_cast<uint8_t>(random())};
      byte = values[random() % 5];
    }
    if (i % 3 != 0) bytes = sealed(bytes);
    // A block that ends where the file does, so that the address sanitizer sees a step past it.
    const std::unique_ptr<uint8_t[]> exact(new uint8_t[bytes.size()]);
    memcpy(exact.get(), bytes.data(), bytes.size());
    const ClipExercise exercise(exact.get(), bytes.size(), 1u << i / 2 % 6);
    ASSERT_EQ(exercise.broken, "") << "mutation " << i;
    opened += exercise.opened == Status::kOk;
    unnoticed += exercise.opened == Status::kOk && exercise.verified == Status::kOk;
  }
  EXPECT_GT(opened, 500) << "the mutations reach blocks";
  EXPECT_GT(unnoticed, 50) << "and values";
}

}  // namespace
}  // namespace mien
