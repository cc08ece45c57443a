// SPDX-License-Identifier: MIT
// Clips through mien.h: what goes in comes out, players and bindings, wrong arguments, and every
// allocation failing once. What the format and the sampler do is tested in tests/anim.
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>

#include "capi/handles.h"
#include "tests/support/clip_curves.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/damage.h"
#include "tests/support/memory_stream.h"
#include "tests/support/misuse.h"

namespace mien {
namespace {

MienStringView view(const char* text) { return {text, strlen(text)}; }

/// Rows of values with names, as a desc points to them.
struct Take {
  Curves curves;
  std::vector<std::string> names;
  std::vector<MienStringView> views;
  std::vector<MienClipEvent> events;

  explicit Take(Curves what) : curves(std::move(what)) {
    for (uint32_t c = 0; c < curves.channels; ++c) names.push_back("channel" + std::to_string(c));
  }
  MienClipDesc desc() {
    views.clear();
    for (const std::string& name : names) views.push_back({name.data(), name.size()});
    MienClipDesc desc = sized<MienClipDesc>();
    desc.frame_count = curves.frames;
    desc.channel_count = curves.channels;
    desc.names = views.data();
    desc.values = curves.values.data();
    desc.events = events.data();
    desc.event_count = static_cast<uint32_t>(events.size());
    return desc;
  }
};

ClipHandle build(const MienClipDesc& desc, MienStatus expected = MIEN_OK,
                 const char* message = nullptr) {
  MienError error = sized<MienError>();
  MienClip* clip = nullptr;
  EXPECT_STREQ(mien_status_name(mien_clip_build(&desc, &clip, &error)), mien_status_name(expected))
      << error.message;
  EXPECT_EQ(clip == nullptr, expected != MIEN_OK);
  if (message) {
    EXPECT_NE(std::string(error.message).find(message), std::string::npos) << error.message;
  }
  return ClipHandle(clip);
}

MienClipInfo info_of(const ClipHandle& clip) {
  MienClipInfo info = sized<MienClipInfo>();
  EXPECT_EQ(mien_clip_info(clip.get(), &info), MIEN_OK);
  return info;
}

MienClipChannel channel_of(const ClipHandle& clip, uint32_t index) {
  MienClipChannel channel = sized<MienClipChannel>();
  EXPECT_EQ(mien_clip_channel(clip.get(), index, &channel), MIEN_OK);
  return channel;
}

Bytes bytes_of(const ClipHandle& clip) {
  size_t size = 0;
  EXPECT_EQ(mien_clip_write_memory(clip.get(), nullptr, 0, &size, nullptr), MIEN_OK);
  Bytes bytes(size);
  EXPECT_EQ(mien_clip_write_memory(clip.get(), bytes.data(), size, &size, nullptr), MIEN_OK);
  return bytes;
}

ClipHandle open_bytes(const Bytes& bytes, MienStatus expected = MIEN_OK) {
  MienClip* clip = nullptr;
  MienError error = sized<MienError>();
  EXPECT_EQ(mien_clip_open_memory(bytes.data(), bytes.size(), nullptr, &clip, &error), expected)
      << error.message;
  return ClipHandle(clip);
}

std::vector<float> read_all(const ClipHandle& clip) {
  const MienClipInfo info = info_of(clip);
  std::vector<float> values(size_t{info.frame_count} * info.channel_count);
  EXPECT_EQ(mien_clip_read(clip.get(), 0, info.frame_count, values.data(), 0, nullptr), MIEN_OK);
  return values;
}

PlayerHandle player_of(const ClipHandle& clip, const MienClipPlayerDesc* desc = nullptr) {
  MienClipPlayer* player = nullptr;
  MienError error = sized<MienError>();
  EXPECT_EQ(mien_clip_player_create(clip.get(), desc, &player, &error), MIEN_OK) << error.message;
  return PlayerHandle(player);
}

std::vector<float> sample(const PlayerHandle& player) {
  MienFloatView values = {};
  EXPECT_EQ(mien_clip_player_sample(player.get(), &values), MIEN_OK);
  return {values.data, values.data + values.count};
}

std::vector<std::string> passed_events(const PlayerHandle& player) {
  std::vector<std::string> names;
  MienClipEvent event;
  uint32_t found = 0;
  while (mien_clip_player_next_event(player.get(), &event, &found) == MIEN_OK && found) {
    names.emplace_back(event.name.data, event.name.count);
  }
  EXPECT_EQ(event.name.data, nullptr) << "nothing is left behind after the last event";
  return names;
}

// Building and opening ----------------------------------------------------------------------------

TEST(CapiClip, EveryBitComesBack) {
  for (const Curves& curves : {clean_solve(3, 200), phone_capture(3, 131), dense_noise(3, 65)}) {
    Take take(curves);
    const ClipHandle clip = build(take.desc());
    EXPECT_EQ(mien_clip_verify(clip.get(), nullptr), MIEN_OK);
    EXPECT_TRUE(same_bits(span_of(read_all(clip)), span_of(curves.values)));
    const Bytes bytes = bytes_of(clip);
    const ClipHandle opened = open_bytes(bytes);
    EXPECT_TRUE(same_bits(span_of(read_all(opened)), span_of(curves.values)));
    EXPECT_EQ(bytes_of(opened), bytes);
  }
}

TEST(CapiClip, FramesOfHalfRateClipsAreRead) {
  Curves curves(2, 129);
  for (uint32_t f = 0; f < curves.frames; ++f) {
    curves.at(f, 0) = static_cast<float>(f) / 128;
    curves.at(f, 1) = 1 - static_cast<float>(f / 2 * 2 + f % 2) / 256;
  }
  Take take(curves);
  const ClipHandle clip = build(take.desc());
  EXPECT_TRUE(same_bits(span_of(read_all(clip)), span_of(curves.values)));
  float row[2];
  for (uint32_t f = 129; f-- > 0;) {
    ASSERT_EQ(mien_clip_read(clip.get(), f, 1, row, 0, nullptr), MIEN_OK);
    EXPECT_EQ(row[0], curves.at(f, 0)) << f;
  }
}

TEST(CapiClip, RowsMayHaveGaps) {
  Take take(clean_solve(5, 40));
  MienClipDesc desc = take.desc();
  std::vector<float> wide(size_t{40} * 300, 7);
  for (uint32_t f = 0; f < 40; ++f) {
    memcpy(&wide[size_t{f} * 300], &take.curves.values[size_t{f} * kFaceControls],
           kFaceControls * sizeof(float));
  }
  desc.values = wide.data();
  desc.frame_stride = 300;
  const ClipHandle clip = build(desc);
  std::vector<float> out(size_t{3} * 260, 9);
  ASSERT_EQ(mien_clip_read(clip.get(), 30, 3, out.data(), 260, nullptr), MIEN_OK);
  for (uint32_t f = 0; f < 3; ++f) {
    for (uint32_t c = 0; c < 260; ++c) {
      EXPECT_EQ(out[f * 260 + c], c < kFaceControls ? take.curves.at(30 + f, c) : 9.0f);
    }
  }
}

TEST(CapiClip, WithoutChannelsRowsMayBeNull) {
  Take take(Curves(0, 5));
  const ClipHandle clip = build(take.desc());
  EXPECT_EQ(mien_clip_read(clip.get(), 0, 5, nullptr, 0, nullptr), MIEN_OK);
  EXPECT_EQ(mien_clip_read(clip.get(), 1, 4, nullptr, 7, nullptr), MIEN_OK);
  float untouched = 3;
  EXPECT_EQ(mien_clip_read(clip.get(), 0, 5, &untouched, 0, nullptr), MIEN_OK);
  EXPECT_EQ(untouched, 3);
  EXPECT_EQ(mien_clip_read(clip.get(), 1, 5, nullptr, 0, nullptr), MIEN_ERROR_INDEX);
}

TEST(CapiClip, TellsWhatItWasBuiltOf) {
  Take take(clean_solve(1, 90));
  take.names[7] = "CTRL_expressions.jawOpen";
  take.events = {
      {705600000, view("M"), 0.5f, 0}, {0, view("AA"), 1, 0}, {705600000, view("AA"), 2, 0}};
  MienClipDesc desc = take.desc();
  desc.rate_numerator = 30000;
  desc.rate_denominator = 1001;
  desc.looping = MIEN_LOOPING_WRAP;
  desc.is_delta = 1;
  const ClipHandle clip = build(desc);
  const MienClipInfo info = info_of(clip);
  EXPECT_EQ(info.rate_numerator, 30000u);
  EXPECT_EQ(info.rate_denominator, 1001u);
  EXPECT_EQ(info.frame_count, 90u);
  EXPECT_EQ(info.channel_count, kFaceControls);
  EXPECT_EQ(info.event_count, 3u);
  EXPECT_EQ(info.looping, uint32_t{MIEN_LOOPING_WRAP});
  EXPECT_EQ(info.is_delta, 1u);
  EXPECT_EQ(info.snap, 0.0f);
  EXPECT_EQ(info.is_mapped, 0u);
  EXPECT_EQ(info.ticks_per_frame, 23543520);
  EXPECT_EQ(info.length, 90 * 23543520);
  EXPECT_EQ(info.file_bytes, bytes_of(clip).size());

  uint32_t index = 0;
  EXPECT_EQ(mien_clip_find_channel(clip.get(), "CTRL_expressions.jawOpen", &index), MIEN_OK);
  EXPECT_EQ(index, 7u);
  EXPECT_EQ(mien_clip_find_channel_n(clip.get(), "channel8 and more", 8, &index), MIEN_OK);
  EXPECT_EQ(index, 8u);
  EXPECT_EQ(mien_clip_find_channel(clip.get(), "jawOpen", &index), MIEN_ERROR_NAME);

  const char* names[] = {"AA", "M", "AA"};
  const float values[] = {1, 0.5f, 2};
  for (uint32_t e = 0; e < 3; ++e) {
    MienClipEvent event = {};
    ASSERT_EQ(mien_clip_event(clip.get(), e, &event), MIEN_OK);
    EXPECT_EQ(std::string(event.name.data, event.name.count), names[e]);
    EXPECT_EQ(event.value, values[e]);
    EXPECT_EQ(event.tick, e == 0 ? 0 : 705600000);
  }
  MienClipEvent event = {};
  EXPECT_EQ(mien_clip_event(clip.get(), 3, &event), MIEN_ERROR_INDEX);
}

TEST(CapiClip, EventsShareTheirNames) {
  Take take(Curves(1, 1000));
  const std::string name(40, 'p');
  for (int64_t e = 0; e < 500; ++e) take.events.push_back({e, {name.data(), 40}, 0, 0});
  EXPECT_LT(info_of(build(take.desc())).file_bytes, 64 + 500 * 16 + 200u);
}

TEST(CapiClip, DefaultsAreSixtyFramesThatClamp) {
  Take take(Curves(1, 2));
  const MienClipInfo info = info_of(build(take.desc()));
  EXPECT_EQ(info.rate_numerator, 60u);
  EXPECT_EQ(info.rate_denominator, 1u);
  EXPECT_EQ(info.looping, uint32_t{MIEN_LOOPING_CLAMP});
  EXPECT_EQ(info.length, MIEN_TICKS_PER_SECOND / 60);
}

TEST(CapiClip, ReportsHowChannelsWereStored) {
  Curves curves = phone_capture(2, 200);
  for (uint32_t f = 0; f < 200; ++f) curves.at(f, 3) = 0.25f, curves.at(f, 4) = f % 2 ? 0.5f : 0;
  Take take(curves);
  MienClipDesc desc = take.desc();
  std::vector<float> steps(kCaptureChannels, 1.0f / 2048);
  steps[0] = 0;
  steps[5] = 1.0f / 512;
  desc.snaps = steps.data();
  const ClipHandle clip = build(desc);
  EXPECT_EQ(info_of(clip).snap, 1.0f / 512) << "the coarsest";
  EXPECT_EQ(channel_of(clip, 0).max_error, 0.0f);
  EXPECT_GT(channel_of(clip, 1).max_error, 0.0f);
  EXPECT_LE(channel_of(clip, 1).max_error, 0.5f / 2048);
  EXPECT_LE(channel_of(clip, 5).max_error, 0.5f / 512);
  EXPECT_EQ(channel_of(clip, 3).is_changing, 0u);
  EXPECT_EQ(channel_of(clip, 3).rest, 0.25f);
  EXPECT_EQ(channel_of(clip, 3).bits, 0u);
  const MienClipChannel grid = channel_of(clip, 4);
  EXPECT_EQ(grid.is_changing, 1u);
  EXPECT_EQ(grid.rest, 0.0f);
  EXPECT_EQ(grid.zero_blocks + grid.constant_blocks + grid.grid_blocks + grid.float_blocks, 4u);
  EXPECT_EQ(grid.grid_blocks, 4u);
  EXPECT_GT(grid.bits, 200u);

  const Bytes bytes = bytes_of(clip);
  const ClipHandle opened = open_bytes(bytes);
  EXPECT_EQ(info_of(opened).snap, 1.0f / 512);
  EXPECT_EQ(channel_of(opened, 4).grid_blocks, 0u) << "a file does not say";
  EXPECT_EQ(channel_of(opened, 4).is_changing, 1u);
}

TEST(CapiClip, OneStepServesAllChannels) {
  Take take(phone_capture(2, 64));
  MienClipDesc desc = take.desc();
  desc.snap = 1.0f / 1024;
  const ClipHandle clip = build(desc);
  EXPECT_EQ(info_of(clip).snap, 1.0f / 1024);
  const std::vector<float> values = read_all(clip);
  for (size_t i = 0; i < values.size(); ++i) {
    ASSERT_EQ(values[i] * 1024, std::floor(values[i] * 1024));
    ASSERT_NEAR(values[i], take.curves.values[i], 0.5 / 1024);
  }
}

TEST(CapiClip, FilesAreMappedOrRead) {
  char path[] = "/tmp/mien_clip_XXXXXX";
  const int file = mkstemp(path);
  ASSERT_GE(file, 0);
  close(file);
  Take take(clean_solve(1, 90));
  ASSERT_EQ(mien_clip_write_file(build(take.desc()).get(), path, nullptr), MIEN_OK);
  for (uint32_t access : {MIEN_FILE_MAP, MIEN_FILE_READ}) {
    MienClipOpenDesc desc = sized<MienClipOpenDesc>();
    KeepingAllocator kept;
    desc.file_access = access;
    desc.allocator = &kept.interface;
    MienClip* opened = nullptr;
    ASSERT_EQ(mien_clip_open_file(path, &desc, &opened, nullptr), MIEN_OK);
    ClipHandle clip(opened);
    EXPECT_EQ(info_of(clip).is_mapped, access == MIEN_FILE_MAP ? 1u : 0u);
    EXPECT_EQ(info_of(clip).memory_bytes, kept.live_bytes);
    EXPECT_TRUE(same_bits(span_of(read_all(clip)), span_of(take.curves.values)));
    clip.reset();
    EXPECT_EQ(kept.live_bytes, 0u);
  }
  remove(path);
  MienClip* none = nullptr;
  EXPECT_EQ(mien_clip_open_file(path, nullptr, &none, nullptr), MIEN_ERROR_FILE_OPEN);
}

TEST(CapiClip, StreamsAreReadOnce) {
  Take take(clean_solve(1, 90));
  const Bytes bytes = bytes_of(build(take.desc()));
  for (bool reads_short : {false, true}) {
    for (size_t fail_at : {0, 1}) {
      MemoryStream memory(bytes);
      memory.fail_at = fail_at;
      memory.reads_short = reads_short;
      const Stream stream = memory.get();
      const MienStream given = {stream.user, stream.size, stream.read};
      MienClip* opened = nullptr;
      EXPECT_EQ(mien_clip_open_stream(&given, nullptr, &opened, nullptr),
                fail_at ? MIEN_ERROR_FILE_READ : MIEN_OK);
      const ClipHandle clip(opened);
      EXPECT_EQ(memory.reads, 1u);
      EXPECT_EQ(memory.wrong, "");
      if (fail_at == 0) {
        EXPECT_EQ(bytes_of(clip), bytes);
      }
    }
  }
  MienClip* opened = nullptr;
  const MienStream empty = {nullptr, 0, MemoryStream::read};
  EXPECT_EQ(mien_clip_open_stream(&empty, nullptr, &opened, nullptr), MIEN_ERROR_CLIP_SIGNATURE);
}

TEST(CapiClip, DamagedFilesAreRefusedWithTheirPlace) {
  Take take(clean_solve(1, 90));
  const Bytes bytes = bytes_of(build(take.desc()));
  const auto refuse = [](const Bytes& file) {
    MienError error = sized<MienError>();
    MienClip* clip = nullptr;
    const MienStatus status =
        mien_clip_open_memory(file.data(), file.size(), nullptr, &clip, &error);
    EXPECT_EQ(clip, nullptr);
    EXPECT_EQ(error.status, status);
    EXPECT_NE(error.byte_offset, MIEN_NO_OFFSET);
    return std::string(mien_status_name(status));
  };
  Bytes cut(bytes.begin(), bytes.end() - 1), signature = bytes, version = bytes, count = bytes;
  signature[0] ^= 1;
  version[kAtVersion] = 9;
  count[40] ^= 1;
  EXPECT_EQ(refuse(cut), "CLIP_TRUNCATED");
  EXPECT_EQ(refuse(signature), "CLIP_SIGNATURE");
  EXPECT_EQ(refuse(version), "CLIP_VERSION");
  EXPECT_EQ(refuse(count), "CLIP_STRUCTURE");
  EXPECT_EQ(refuse({}), "CLIP_SIGNATURE");

  Bytes payload = bytes;
  payload[bytes.size() - 40] ^= 0x10;
  const ClipHandle opened = open_bytes(payload);
  EXPECT_EQ(mien_clip_verify(opened.get(), nullptr), MIEN_ERROR_CLIP_CHECKSUM);
}

TEST(CapiClip, DamagedCurvesGiveZerosAndSaySo) {
  Take take(dense_noise(1, 150));
  const ClipHandle whole = build(take.desc());
  Bytes bytes = bytes_of(whole);
  store_little_endian<uint32_t>(&bytes[capi::object(whole.get())->view.at.block_ends],
                                UINT32_MAX);  // of blocks 0, 1
  const ClipHandle clip = open_bytes(bytes);
  std::vector<float> rows(size_t{64} * kFaceControls, 7);
  EXPECT_EQ(mien_clip_read(clip.get(), 0, 64, rows.data(), 0, nullptr), MIEN_ERROR_CLIP_STRUCTURE);
  EXPECT_EQ(mien_clip_read(clip.get(), 128, 22, rows.data(), 0, nullptr), MIEN_OK);
  EXPECT_TRUE(same_bits(Span<const float>{rows.data(), kFaceControls},
                        {&take.curves.values[size_t{128} * kFaceControls], kFaceControls}));
  const PlayerHandle player = player_of(clip);
  for (float value : sample(player)) EXPECT_EQ(value, 0.0f);
  MienClipPlayerInfo info = sized<MienClipPlayerInfo>();
  ASSERT_EQ(mien_clip_player_info(player.get(), &info), MIEN_OK);
  EXPECT_EQ(info.is_damaged, 1u);
}

// Wrong takes -------------------------------------------------------------------------------------

TEST(CapiClip, WrongTakesAreNamed) {
  Take take(clean_solve(1, 90));
  const auto with = [&](const std::function<void(MienClipDesc&)>& change, MienStatus status,
                        const char* message) {
    MienClipDesc desc = take.desc();
    change(desc);
    build(desc, status, message);
  };
  const MienStatus invalid = MIEN_ERROR_INVALID_ARGUMENT, null = MIEN_ERROR_NULL_ARGUMENT;
  with([](auto& d) { d.frame_count = 0; }, invalid, "at least one frame");
  with([](auto& d) { d.frame_count = 1u << 29; }, MIEN_ERROR_CLIP_LIMIT, "at most");
  with([](auto& d) { d.frame_stride = 250; }, invalid, "stride");
  with([](auto& d) { d.rate_numerator = 1, d.rate_denominator = 100; }, invalid, "rate");
  with([](auto& d) { d.snap = 0.001f; }, invalid, "MienClipDesc.snap is 0.001");
  with([](auto& d) { d.snap = 1.0f / 256; }, invalid, "2^-9");
  with([](auto& d) { d.snap = -1.0f / 512; }, invalid, "2^-9");
  with([](auto& d) { d.snap = std::numeric_limits<float>::quiet_NaN(); }, invalid, "2^-9");
  with([](auto& d) { d.looping = 3; }, invalid, "looping");
  with([](auto& d) { d.names = nullptr; }, null, "names");
  with([](auto& d) { d.values = nullptr; }, null, "values");
  with([](auto& d) { d.events = nullptr, d.event_count = 1; }, null, "events");
  const MienClipEvent late[] = {{705600000 / 60 * 90, view("x"), 0, 0}};
  with([&](auto& d) { d.events = late, d.event_count = 1; }, invalid, "event 0");
  const MienClipEvent unnamed[] = {{0, {nullptr, 2}, 0, 0}};
  with([&](auto& d) { d.events = unnamed, d.event_count = 1; }, null, "event 0");

  take.views[5].data = nullptr;
  MienClipDesc desc = take.desc();
  take.views[5] = {nullptr, 3};
  build(desc, null, "channel 5");
  take.views[5] = {"", 0};
  build(desc, MIEN_ERROR_NAME, "empty");
  take.views[5] = take.views[6];
  build(desc, MIEN_ERROR_NAME, "channel6");
  take.curves.at(31, 40) = std::numeric_limits<float>::infinity();
  build(take.desc(), MIEN_ERROR_CLIP_VALUE, "frame 31, channel 40 (\"channel40\")");

  Take wide(Curves(513, 2));
  for (uint32_t c = 0; c < 513; ++c) wide.curves.at(1, c) = 1;
  build(wide.desc(), MIEN_ERROR_CLIP_LIMIT, "512");
}

TEST(CapiClip, ReadingPastTheEndIsRefused) {
  Take take(clean_solve(1, 90));
  const ClipHandle clip = build(take.desc());
  std::vector<float> rows(size_t{90} * kFaceControls);
  float* out = rows.data();
  EXPECT_EQ(mien_clip_read(clip.get(), 90, 1, out, 0, nullptr), MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_clip_read(clip.get(), 1, 90, out, 0, nullptr), MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_clip_read(clip.get(), 2, UINT32_MAX, out, 0, nullptr), MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_clip_read(clip.get(), 0, 1, out, 250, nullptr), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_clip_read(clip.get(), 0, 1, nullptr, 0, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_clip_read(clip.get(), 90, 0, nullptr, 0, nullptr), MIEN_OK);
}

// Players -----------------------------------------------------------------------------------------

TEST(CapiClip, PlayersGiveTheBitsOfFramesAndValuesBetween) {
  Take take(clean_solve(2, 100));
  const ClipHandle clip = build(take.desc());
  const PlayerHandle player = player_of(clip);
  const int64_t frame = info_of(clip).ticks_per_frame;
  for (int64_t f : {0, 1, 50, 99, 3}) {
    ASSERT_EQ(mien_clip_player_seek(player.get(), f * frame), MIEN_OK);
    const float* row = &take.curves.values[static_cast<size_t>(f) * kFaceControls];
    EXPECT_TRUE(same_bits(span_of(sample(player)), {row, kFaceControls}));
  }
  ASSERT_EQ(mien_clip_player_advance(player.get(), frame / 2), MIEN_OK);
  const std::vector<float> between = sample(player);
  for (uint32_t c = 0; c < kFaceControls; ++c) {
    const float a = take.curves.at(3, c), b = take.curves.at(4, c);
    EXPECT_NEAR(between[c], (a + b) / 2, 1e-6f);
  }
}

TEST(CapiClip, PlayersTakeSpeedLoopingAndInterpolation) {
  Curves curves(1, 4);
  for (uint32_t f = 0; f < 4; ++f) curves.at(f, 0) = static_cast<float>(f);
  Take take(curves);
  const ClipHandle clip = build(take.desc());
  const int64_t frame = info_of(clip).ticks_per_frame;
  MienClipPlayerDesc desc = sized<MienClipPlayerDesc>();
  desc.looping = MIEN_LOOPING_WRAP;
  desc.interpolation = MIEN_INTERPOLATION_STEP;
  desc.speed_numerator = -3;
  desc.speed_denominator = 2;
  desc.reverse = 1;
  const PlayerHandle player = player_of(clip, &desc);
  EXPECT_EQ(sample(player)[0], 0.0f);
  ASSERT_EQ(mien_clip_player_advance(player.get(), frame), MIEN_OK);
  EXPECT_EQ(sample(player)[0], 2.0f) << "frame 2.5";
  MienClipPlayerInfo info = sized<MienClipPlayerInfo>();
  ASSERT_EQ(mien_clip_player_info(player.get(), &info), MIEN_OK);
  EXPECT_EQ(info.tick, frame * 5 / 2);
  EXPECT_EQ(info.loops, -1);
  EXPECT_EQ(info.looping, uint32_t{MIEN_LOOPING_WRAP});
  EXPECT_EQ(info.is_damaged, 0u);
  ASSERT_EQ(mien_clip_player_set_speed(player.get(), 1, 2), MIEN_OK);
  ASSERT_EQ(mien_clip_player_advance(player.get(), frame), MIEN_OK);
  EXPECT_EQ(sample(player)[0], 3.0f);

  desc = sized<MienClipPlayerDesc>();
  desc.start_tick = frame * 3 / 2;
  EXPECT_EQ(sample(player_of(clip, &desc))[0], 1.5f);
  const PlayerHandle still = player_of(clip);
  ASSERT_EQ(mien_clip_player_set_speed(still.get(), 0, 1), MIEN_OK);
  ASSERT_EQ(mien_clip_player_advance(still.get(), frame), MIEN_OK);
  EXPECT_EQ(sample(still)[0], 0.0f);
}

TEST(CapiClip, PlayersPassEventsInOrder) {
  Take take(Curves(1, 60));
  take.events = {{0, view("start"), 0, 0}, {705600000 / 2, view("half"), 0, 0}};
  MienClipDesc desc = take.desc();
  desc.looping = MIEN_LOOPING_WRAP;
  ClipHandle clip = build(desc);
  const PlayerHandle player = player_of(clip);
  EXPECT_TRUE(passed_events(player).empty()) << "nothing was passed yet";
  ASSERT_EQ(mien_clip_player_advance(player.get(), MIEN_TICKS_PER_SECOND), MIEN_OK);
  EXPECT_EQ(passed_events(player), (std::vector<std::string>{"start", "half", "start"}));
  EXPECT_TRUE(passed_events(player).empty());
  ASSERT_EQ(mien_clip_player_advance(player.get(), MIEN_TICKS_PER_SECOND), MIEN_OK);
  ASSERT_EQ(mien_clip_player_seek(player.get(), 0), MIEN_OK);
  EXPECT_TRUE(passed_events(player).empty()) << "a seek passes none";

  // The clip lives as long as its player.
  clip.reset();
  ASSERT_EQ(mien_clip_player_advance(player.get(), MIEN_TICKS_PER_SECOND * 2 / 3), MIEN_OK);
  EXPECT_EQ(passed_events(player), (std::vector<std::string>{"start", "half"}));
  EXPECT_EQ(sample(player)[0], 0.0f);
}

TEST(CapiClip, WrongPlayersAreRefused) {
  Take take(Curves(1, 2));
  const ClipHandle clip = build(take.desc());
  const auto refuse = [&](const std::function<void(MienClipPlayerDesc&)>& change) {
    MienClipPlayerDesc desc = sized<MienClipPlayerDesc>();
    change(desc);
    MienError error = sized<MienError>();
    MienClipPlayer* player = nullptr;
    EXPECT_EQ(mien_clip_player_create(clip.get(), &desc, &player, &error),
              MIEN_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(player, nullptr);
    EXPECT_NE(error.message[0], 0);
  };
  refuse([](auto& d) { d.looping = 3; });
  refuse([](auto& d) { d.interpolation = 3; });
  refuse([](auto& d) { d.reserved = 1; });
  refuse([](auto& d) { d.speed_numerator = 1; });
  refuse([](auto& d) { d.speed_denominator = -1; });
  refuse([](auto& d) { d.speed_numerator = (1 << 20) + 1, d.speed_denominator = 1; });
  const PlayerHandle player = player_of(clip);
  EXPECT_EQ(mien_clip_player_set_speed(player.get(), 1, 0), MIEN_ERROR_INVALID_ARGUMENT);
  const int64_t most = int64_t{1} << 40;
  EXPECT_EQ(mien_clip_player_advance(player.get(), most), MIEN_OK);
  EXPECT_EQ(mien_clip_player_advance(player.get(), most + 1), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_clip_player_advance(player.get(), -most - 1), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_clip_player_seek(player.get(), INT64_MIN), MIEN_OK);
  EXPECT_EQ(mien_clip_player_seek(player.get(), INT64_MAX), MIEN_OK);
}

// Bindings ----------------------------------------------------------------------------------------

struct Bound {
  RigHandle rig = create_rig(generate_dna(MIEN_PRESET_HEAD, 0).get());
  ClipHandle clip;

  BindingHandle bind(const std::vector<std::string>& names,
                     const std::vector<MienMatrixEntry>& matrix = {},
                     MienStatus expected = MIEN_OK) {
    Take take(Curves(static_cast<uint32_t>(names.size()), 1));
    take.names = names;
    clip = build(take.desc());
    MienClipBindingDesc desc = sized<MienClipBindingDesc>();
    desc.matrix = matrix.data();
    desc.matrix_count = matrix.size();
    MienClipBinding* binding = nullptr;
    EXPECT_EQ(mien_clip_binding_create(clip.get(), rig.get(), &desc, &binding, nullptr), expected);
    return BindingHandle(binding);
  }
  uint32_t raw(const char* name) const {
    uint32_t index = 0;
    EXPECT_EQ(mien_rig_find(rig.get(), MIEN_KIND_RAW_CONTROL, name, &index), MIEN_OK) << name;
    return index;
  }
};

MienClipBindingInfo info_of(const BindingHandle& binding) {
  MienClipBindingInfo info = sized<MienClipBindingInfo>();
  EXPECT_EQ(mien_clip_binding_info(binding.get(), &info), MIEN_OK);
  return info;
}

TEST(CapiClip, BindingsDriveControlsByNameAndMatrix) {
  Bound bound;
  const BindingHandle binding =
      bound.bind({"JAWOPEN", "nothing", "joy"}, {{view("joy"), view("mouthSmileLeft"), 0.5f, 0},
                                                 {view("joy"), view("noSuchControl"), 1, 0},
                                                 {view("grief"), view("mouthSmileRight"), 1, 0}});
  const MienClipBindingInfo info = info_of(binding);
  const uint32_t count = count_of(bound.rig, MIEN_KIND_RAW_CONTROL);
  EXPECT_EQ(info.channel_count, 3u);
  EXPECT_EQ(info.raw_control_count, count);
  EXPECT_EQ(info.missing_entry_count, 2u);
  ASSERT_EQ(info.controls.count, 2u);
  EXPECT_EQ(info.extra_controls.count, count - 2);
  ASSERT_EQ(info.missing_channels.count, 1u);
  EXPECT_EQ(info.missing_channels.data[0], 1u);

  std::vector<float> row(count, 9);
  const float values[] = {0.3f, 0.7f, 0.5f};
  ASSERT_EQ(mien_clip_binding_apply(binding.get(), values, 3, row.data(), count), MIEN_OK);
  EXPECT_EQ(row[bound.raw("jawOpen")], 0.3f);
  EXPECT_EQ(row[bound.raw("mouthSmileLeft")], 0.25f);
  EXPECT_EQ(row[bound.raw("mouthSmileRight")], 9.0f);

  bound.rig.reset();
  bound.clip.reset();
  ASSERT_EQ(mien_clip_binding_apply(binding.get(), values, 3, row.data(), count), MIEN_OK);
}

TEST(CapiClip, BindingsGoThroughTheTableOfTheRig) {
  Bound bound;
  Arena arena(default_allocator());
  bound.rig = create_rig(open_dna(write_view(dna::tiny_rig(arena))).get());
  const std::vector<std::string> gui = names_of(bound.rig, MIEN_KIND_GUI_CONTROL);
  const BindingHandle binding = bound.bind({gui[0]});
  Character face(bound.rig);
  std::vector<float> row(face.raw.count, 0);
  for (float value : {-1.0f, -0.25f, 0.0f, 0.3f, 1.0f, 2.0f}) {
    ASSERT_EQ(mien_clip_binding_apply(binding.get(), &value, 1, row.data(), row.size()), MIEN_OK);
    for (float& control : face.gui) control = 0;
    face.gui[0] = value;
    face.map_gui_to_raw();
    const MienIndex16View driven = info_of(binding).controls;
    EXPECT_GT(driven.count, 0u);
    for (size_t i = 0; i < driven.count; ++i) {
      EXPECT_EQ(row[driven.data[i]], face.raw[driven.data[i]]) << value;
    }
  }
}

TEST(CapiClip, WrongBindingsAreRefused) {
  Bound bound;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  bound.bind({"a"}, {{view("a"), view("jawOpen"), nan, 0}}, MIEN_ERROR_INVALID_ARGUMENT);
  bound.bind({"a"}, {{{nullptr, 1}, view("jawOpen"), 1, 0}}, MIEN_ERROR_NULL_ARGUMENT);
  const BindingHandle binding = bound.bind({"a"});
  std::vector<float> row(count_of(bound.rig, MIEN_KIND_RAW_CONTROL));
  const float value = 1;
  const MienClipBinding* b = binding.get();
  const MienStatus invalid = MIEN_ERROR_INVALID_ARGUMENT, null = MIEN_ERROR_NULL_ARGUMENT;
  EXPECT_EQ(mien_clip_binding_apply(b, &value, 1, row.data(), row.size()), MIEN_OK);
  EXPECT_EQ(mien_clip_binding_apply(b, &value, 2, row.data(), row.size()), invalid);
  EXPECT_EQ(mien_clip_binding_apply(b, &value, 1, row.data(), row.size() - 1), invalid);
  EXPECT_EQ(mien_clip_binding_apply(b, nullptr, 1, row.data(), row.size()), null);
  EXPECT_EQ(mien_clip_binding_apply(b, &value, 1, nullptr, row.size()), null);
}

// Misuse ------------------------------------------------------------------------------------------

class ClipMisuse : public Misuse {
 protected:
  void SetUp() override {
    Misuse::SetUp();
    Take take(Curves(1, 2));
    clip = build(take.desc());
    player = player_of(clip);
    MienClipBinding* made = nullptr;
    ASSERT_EQ(mien_clip_binding_create(clip.get(), rig, nullptr, &made, nullptr), MIEN_OK);
    binding.reset(made);
  }

  std::vector<Outcome> calls_on(MienClip* c) {
    Caller to;
    to.into_struct<MienClipInfo>("info", [&](auto* o) { return mien_clip_info(c, o); });
    to.into_struct<MienClipChannel>("channel", [&](auto* o) { return mien_clip_channel(c, 0, o); });
    to.plain<uint32_t>("find", [&](auto* o) { return mien_clip_find_channel(c, "channel0", o); });
    to.only_error("verify", [&](auto* e) { return mien_clip_verify(c, e); });
    float row;
    to.only_error("read", [&](auto* e) { return mien_clip_read(c, 0, 1, &row, 0, e); });
    to.only_error("write_file", [&](auto* e) { return mien_clip_write_file(c, "/dev/null", e); });
    to.with_error<size_t>("write_memory", [&](auto* o, auto* e) {
      return mien_clip_write_memory(c, nullptr, 0, o, e);
    });
    to.with_error<MienClipPlayer*>("player", [&](auto* o, auto* e) {
      const MienStatus status = mien_clip_player_create(c, nullptr, o, e);
      mien_clip_player_destroy(*o);
      return status;
    });
    to.with_error<MienClipBinding*>("binding", [&](auto* o, auto* e) {
      const MienStatus status = mien_clip_binding_create(c, rig, nullptr, o, e);
      mien_clip_binding_destroy(*o);
      return status;
    });
    return to.outcomes;
  }
  std::vector<Outcome> calls_on(MienClipPlayer* p) {
    Caller to;
    to.into_struct<MienClipPlayerInfo>("info",
                                       [&](auto* o) { return mien_clip_player_info(p, o); });
    to.nothing("seek", [&] { return mien_clip_player_seek(p, 0); });
    to.nothing("speed", [&] { return mien_clip_player_set_speed(p, 1, 1); });
    to.nothing("advance", [&] { return mien_clip_player_advance(p, 1); });
    to.plain<MienFloatView>("sample", [&](auto* o) { return mien_clip_player_sample(p, o); });
    MienClipEvent event;
    to.plain<uint32_t>("event", [&](auto* o) { return mien_clip_player_next_event(p, &event, o); });
    return to.outcomes;
  }
  std::vector<Outcome> calls_on(MienClipBinding* b) {
    Caller to;
    to.into_struct<MienClipBindingInfo>("info",
                                        [&](auto* o) { return mien_clip_binding_info(b, o); });
    MienMutableFloatView raw = {};
    EXPECT_EQ(mien_instance_raw_controls(instance, &raw), MIEN_OK);
    const float value = 0;
    to.nothing("apply", [&] { return mien_clip_binding_apply(b, &value, 1, raw.data, raw.count); });
    return to.outcomes;
  }

  ClipHandle clip;
  PlayerHandle player;
  BindingHandle binding;
};

TEST_F(ClipMisuse, HandlesOfAnotherKindAreRefused) {
  alignas(8) uint8_t zeros[64] = {};
  expect_all(calls_on(clip.get()), MIEN_OK);
  expect_all(calls_on(player.get()), MIEN_OK);
  expect_all(calls_on(binding.get()), MIEN_OK);
  expect_all(calls_on(static_cast<MienClip*>(nullptr)), MIEN_ERROR_NULL_ARGUMENT);
  expect_all(calls_on(static_cast<MienClipPlayer*>(nullptr)), MIEN_ERROR_NULL_ARGUMENT);
  expect_all(calls_on(static_cast<MienClipBinding*>(nullptr)), MIEN_ERROR_NULL_ARGUMENT);
  void* const c = clip.get();
  void* const p = player.get();
  void* const b = binding.get();
  for (void* wrong : {c, p, b, static_cast<void*>(rig), static_cast<void*>(zeros)}) {
    if (wrong != c) {
      expect_all(calls_on(static_cast<MienClip*>(wrong)), MIEN_ERROR_HANDLE);
      mien_clip_close(static_cast<MienClip*>(wrong));
    }
    if (wrong != p) {
      expect_all(calls_on(static_cast<MienClipPlayer*>(wrong)), MIEN_ERROR_HANDLE);
      mien_clip_player_destroy(static_cast<MienClipPlayer*>(wrong));
    }
    if (wrong != b) {
      expect_all(calls_on(static_cast<MienClipBinding*>(wrong)), MIEN_ERROR_HANDLE);
      mien_clip_binding_destroy(static_cast<MienClipBinding*>(wrong));
    }
  }
  expect_all(calls_on(clip.get()), MIEN_OK);
}

TEST_F(ClipMisuse, NullArguments) {
  const MienStatus null = MIEN_ERROR_NULL_ARGUMENT;
  MienClip* none = clip.get();
  EXPECT_EQ(mien_clip_build(nullptr, &none, nullptr), null);
  EXPECT_EQ(none, nullptr);
  const MienClipDesc desc = sized<MienClipDesc>();
  EXPECT_EQ(mien_clip_build(&desc, nullptr, nullptr), null);
  EXPECT_EQ(mien_clip_open_file(nullptr, nullptr, &none, nullptr), null);
  EXPECT_EQ(mien_clip_open_file("x", nullptr, nullptr, nullptr), null);
  EXPECT_EQ(mien_clip_open_memory(nullptr, 9, nullptr, &none, nullptr), null);
  EXPECT_EQ(mien_clip_open_memory("x", 1, nullptr, nullptr, nullptr), null);
  EXPECT_EQ(mien_clip_open_stream(nullptr, nullptr, &none, nullptr), null);
  EXPECT_EQ(mien_clip_write_file(clip.get(), nullptr, nullptr), null);
  EXPECT_EQ(mien_clip_write_memory(clip.get(), nullptr, 9, nullptr, nullptr), null);
  size_t size = 0;
  EXPECT_EQ(mien_clip_write_memory(clip.get(), nullptr, 9, &size, nullptr), null);
  EXPECT_EQ(mien_clip_info(clip.get(), nullptr), null);
  EXPECT_EQ(mien_clip_channel(clip.get(), 0, nullptr), null);
  EXPECT_EQ(mien_clip_event(clip.get(), 0, nullptr), null);
  EXPECT_EQ(mien_clip_find_channel(clip.get(), "x", nullptr), null);
  uint32_t index = 7;
  EXPECT_EQ(mien_clip_find_channel(clip.get(), nullptr, &index), null);
  EXPECT_EQ(mien_clip_find_channel_n(clip.get(), nullptr, 1, &index), null);
  EXPECT_EQ(mien_clip_player_create(clip.get(), nullptr, nullptr, nullptr), null);
  EXPECT_EQ(mien_clip_player_info(player.get(), nullptr), null);
  EXPECT_EQ(mien_clip_player_sample(player.get(), nullptr), null);
  MienClipEvent event;
  EXPECT_EQ(mien_clip_player_next_event(player.get(), nullptr, &index), null);
  EXPECT_EQ(mien_clip_player_next_event(player.get(), &event, nullptr), null);
  EXPECT_EQ(mien_clip_binding_create(clip.get(), rig, nullptr, nullptr, nullptr), null);
  MienClipBinding* bound = nullptr;
  EXPECT_EQ(mien_clip_binding_create(clip.get(), nullptr, nullptr, &bound, nullptr), null);
  MienClipBindingDesc matrix = sized<MienClipBindingDesc>();
  matrix.matrix_count = 1;
  EXPECT_EQ(mien_clip_binding_create(clip.get(), rig, &matrix, &bound, nullptr), null);
  EXPECT_EQ(mien_clip_binding_info(binding.get(), nullptr), null);
}

TEST_F(ClipMisuse, StructsOfTheWrongSizeAreRefused) {
  const MienStatus size = MIEN_ERROR_STRUCT_SIZE;
  Longer<MienClipDesc> longer;
  Take take(Curves(1, 2));
  longer.known = take.desc();
  longer.known.struct_size = sizeof(longer);
  MienClip* made = nullptr;
  EXPECT_EQ(mien_clip_build(&longer.known, &made, nullptr), MIEN_OK);
  mien_clip_close(made);
  longer.tail[3] = 1;
  EXPECT_EQ(mien_clip_build(&longer.known, &made, nullptr), size);
  EXPECT_EQ(made, nullptr);
  MienClipOpenDesc open = sized<MienClipOpenDesc>();
  --open.struct_size;
  EXPECT_EQ(mien_clip_open_memory("x", 1, &open, &made, nullptr), size);
  MienClipPlayerDesc play = sized<MienClipPlayerDesc>();
  --play.struct_size;
  MienClipPlayer* playing = nullptr;
  EXPECT_EQ(mien_clip_player_create(clip.get(), &play, &playing, nullptr), size);
  MienClipBindingDesc bind = sized<MienClipBindingDesc>();
  --bind.struct_size;
  MienClipBinding* bound = nullptr;
  EXPECT_EQ(mien_clip_binding_create(clip.get(), rig, &bind, &bound, nullptr), size);
  MienClipInfo info = sized<MienClipInfo>();
  --info.struct_size;
  EXPECT_EQ(mien_clip_info(clip.get(), &info), size);
  MienError error = sized<MienError>();
  --error.struct_size;
  EXPECT_EQ(mien_clip_verify(clip.get(), &error), size);
  open = sized<MienClipOpenDesc>();
  open.file_access = 2;
  EXPECT_EQ(mien_clip_open_memory("x", 1, &open, &made, nullptr), MIEN_ERROR_INVALID_ARGUMENT);
  open = sized<MienClipOpenDesc>();
  open.reserved = 2;
  EXPECT_EQ(mien_clip_open_memory("x", 1, &open, &made, nullptr), MIEN_ERROR_INVALID_ARGUMENT);
}

// Memory ------------------------------------------------------------------------------------------

/// Makes an object with each of its requests failing in turn; returns how many requests it makes.
template <class Object, class Make>
size_t survive_every_failure(Make&& make) {
  CountingAllocator whole;
  const MienAllocator all = whole.get();
  EXPECT_EQ(make(&all, nullptr), MIEN_OK);
  EXPECT_TRUE(whole.clean()) << whole.first_wrong;
  for (size_t k = 1; k <= whole.requests; ++k) {
    for (bool keep_failing : {false, true}) {
      CountingAllocator counter;
      counter.fail_at = k;
      counter.keep_failing = keep_failing;
      const MienAllocator allocator = counter.get();
      MienError error = sized<MienError>();
      EXPECT_STREQ(mien_status_name(make(&allocator, &error)), "MEMORY") << k;
      EXPECT_NE(error.message[0], 0);
      EXPECT_TRUE(counter.clean()) << counter.first_wrong;
    }
  }
  return whole.requests;
}

TEST(CapiClip, EveryAllocationMayFail) {
  Take take(clean_solve(1, 70));
  take.events = {{0, view("a"), 0, 0}};
  const ClipHandle clip = build(take.desc());
  const Bytes bytes = bytes_of(clip);
  const RigHandle rig = create_rig(generate_dna(MIEN_PRESET_TINY, 1).get());
  EXPECT_EQ(survive_every_failure<MienClip>([&](const MienAllocator* allocator, MienError* error) {
              MienClipDesc desc = take.desc();
              desc.allocator = allocator;
              MienClip* made = clip.get();
              const MienStatus status = mien_clip_build(&desc, &made, error);
              EXPECT_EQ(made == nullptr, status != MIEN_OK);
              mien_clip_close(made);
              return status;
            }),
            4u);
  EXPECT_EQ(survive_every_failure<MienClip>([&](const MienAllocator* allocator, MienError* error) {
              const auto desc = desc_with<MienClipOpenDesc>(allocator);
              MienClip* made = clip.get();
              const MienStatus status =
                  mien_clip_open_memory(bytes.data(), bytes.size(), &desc, &made, error);
              EXPECT_EQ(made == nullptr, status != MIEN_OK);
              mien_clip_close(made);
              return status;
            }),
            1u);
  EXPECT_EQ(survive_every_failure<MienClip>([&](const MienAllocator* allocator, MienError* error) {
              const auto desc = desc_with<MienClipOpenDesc>(allocator);
              MemoryStream memory(bytes);
              const Stream stream = memory.get();
              const MienStream given = {stream.user, stream.size, stream.read};
              MienClip* made = clip.get();
              const MienStatus status = mien_clip_open_stream(&given, &desc, &made, error);
              EXPECT_EQ(made == nullptr, status != MIEN_OK);
              mien_clip_close(made);
              return status;
            }),
            1u);
  EXPECT_EQ(survive_every_failure<MienClip>([&](const MienAllocator* allocator, MienError* error) {
              const auto desc = desc_with<MienClipPlayerDesc>(allocator);
              MienClipPlayer* made = nullptr;
              const MienStatus status = mien_clip_player_create(clip.get(), &desc, &made, error);
              mien_clip_player_destroy(made);
              return status;
            }),
            1u);
  survive_every_failure<MienClip>([&](const MienAllocator* allocator, MienError* error) {
    const auto desc = desc_with<MienClipBindingDesc>(allocator);
    MienClipBinding* made = nullptr;
    const MienStatus status = mien_clip_binding_create(clip.get(), rig.get(), &desc, &made, error);
    mien_clip_binding_destroy(made);
    return status;
  });

  // Playing takes none.
  CountingAllocator counter;
  const MienAllocator allocator = counter.get();
  const auto desc = desc_with<MienClipPlayerDesc>(&allocator);
  const PlayerHandle player = player_of(clip, &desc);
  EXPECT_EQ(counter.requests, 1u);
  EXPECT_EQ(counter.bytes, info_of(clip).player_bytes);
  for (int i = 0; i < 200; ++i) {
    ASSERT_EQ(mien_clip_player_advance(player.get(), 7000000), MIEN_OK);
    sample(player);
  }
  EXPECT_EQ(counter.requests, 1u);
}

TEST(ArkitMatrix, IsWrittenAsFarAsThereIsRoom) {
  size_t count = 9;
  ASSERT_EQ(mien_arkit_matrix(nullptr, 0, &count), MIEN_OK);
  ASSERT_GT(count, 52u);
  std::vector<MienMatrixEntry> entries(count + 1,
                                       MienMatrixEntry{{nullptr, 7}, {nullptr, 7}, 9, 9});
  ASSERT_EQ(mien_arkit_matrix(entries.data(), 1, &count), MIEN_OK);
  EXPECT_EQ(std::string(entries[0].channel.data, entries[0].channel.count), "eyeBlinkLeft");
  EXPECT_EQ(std::string(entries[0].control.data, entries[0].control.count), "eyeBlinkL");
  EXPECT_EQ(entries[1].weight, 9.0f);
  ASSERT_EQ(mien_arkit_matrix(entries.data(), entries.size(), &count), MIEN_OK);
  EXPECT_EQ(count + 1, entries.size());
  EXPECT_EQ(entries.back().weight, 9.0f);
  EXPECT_EQ(mien_arkit_matrix(nullptr, 1, &count), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(count, 0u);
  EXPECT_EQ(mien_arkit_matrix(nullptr, 0, nullptr), MIEN_ERROR_NULL_ARGUMENT);
}

}  // namespace
}  // namespace mien
