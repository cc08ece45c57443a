// SPDX-License-Identifier: MIT
// Mixes as files: what is opened mixes like what was written, for any rig with the controls, and is
// written with the same bytes. Whatever the bytes are: a mix or a refusal.
#include "runtime/mix/mix_file.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/bytes.h"
#include "tests/support/mix_scene.h"
#include "tests/support/mix_setup.h"

namespace mien {
namespace {

/// Raw controls with these names.
struct NamedRig {
  std::string chars;
  std::vector<uint32_t> ends = {0};
  Rig rig;

  explicit NamedRig(const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      chars += name;
      ends.push_back(static_cast<uint32_t>(chars.size()));
    }
    rig.raw_count = static_cast<uint32_t>(names.size());
    list() = {{ends.data(), ends.size()}, {&chars[0], chars.size()}, {}};
  }
  NameList& list() { return rig.names[static_cast<size_t>(Kind::kRawControl)]; }
};

std::vector<std::string> numbered(uint32_t count, const std::string& name = "control") {
  std::vector<std::string> names;
  for (uint32_t i = 0; i < count; ++i) names.push_back(name + std::to_string(i));
  return names;
}

Bytes written(const Mix& mix) {
  size_t size = 0, again = 0;
  Error error;
  EXPECT_EQ(write_mix(mix, {}, size, error), Status::kOk) << error.message;
  Bytes bytes(size);
  EXPECT_EQ(write_mix(mix, {bytes.data(), size}, again, error), Status::kOk);
  EXPECT_EQ(size, again);
  return bytes;
}

std::string text_of(const Mix& mix) {
  size_t size = 0;
  Error error;
  EXPECT_EQ(write_mix_text(mix, {}, size, error), Status::kOk) << error.message;
  std::string text(size, '?');
  EXPECT_EQ(write_mix_text(mix, {&text[0], size}, size, error), Status::kOk);
  return text;
}

Status opens(const Bytes& bytes, const Rig* rig, MixHandle& out, Error& error) {
  Mix* mix = nullptr;
  const Status status =
      open_mix({bytes.data(), bytes.size()}, rig, default_allocator(), mix, error);
  EXPECT_EQ(mix != nullptr, status == Status::kOk);
  out.reset(mix);
  return status;
}

MixHandle opened(const Bytes& bytes, const Rig* rig = nullptr) {
  MixHandle mix;
  Error error;
  EXPECT_EQ(opens(bytes, rig, mix, error), Status::kOk) << error.message;
  return mix;
}

void fix_checksum(Bytes& bytes) {
  store_little_endian(bytes.data() + kAtChecksum, clip_checksum(bytes.data(), bytes.size()));
}

/// A scene and a gaze.
struct GazeMix {
  NamedRig named = NamedRig(numbered(12));
  GazeTable gaze = {};
  const uint16_t place[5] = {12, 13, 14, 9, 10};
  const float amounts[5] = {1, 1, 0, 0.5f, 0.5f};
  MixInput input = MixInput(12, 3);

  GazeMix() {
    for (uint32_t i = 0; i < 8; ++i) {
      gaze.eyes[i / 4].curves[i % 4] = static_cast<uint16_t>(i);
      for (uint32_t s = 0; s < kGazeSteps; ++s) {
        gaze.eyes[i / 4].tangents[i % 4][s] = 0.1f * static_cast<float>(s + 1);
      }
    }
    gaze.eyes[0].center[0] = 30;
    gaze.fit_error = 0.25f;
    LayerDesc& layer = input.add(BlendMode::kOverride, LayerSource::kGenerator, LayerGroup::kLife);
    layer.generator = Generator::kGaze;
    layer.period = kTicksPerSecond;
    layer.curves = {place, 5};
    layer.amounts = {amounts, 5};
    input.desc.gaze = &gaze;
    input.desc.names = named.list();
  }
};

TEST(MixFile, GivesBackItsBytes) {
  const MixScene scene(24);
  const Bytes bytes = written(*scene.mix);
  const NamedRig same(numbered(24));
  EXPECT_EQ(written(*opened(bytes, &same.rig)), bytes);
  EXPECT_EQ(written(*opened(bytes)), bytes) << "without a rig";
  EXPECT_EQ(text_of(*opened(bytes)), text_of(*scene.mix));

  GazeMix gaze;
  const Bytes other = written(*make_mix(gaze.input));
  EXPECT_EQ(written(*opened(other)), other);
  EXPECT_NE(text_of(*opened(other)).find("gaze.fit_error 0.25\n"), std::string::npos);

  MixInput empty(0);
  EXPECT_EQ(written(*opened(written(*make_mix(empty)))), written(*make_mix(empty)));
}

TEST(MixFile, OfALayerThatRepeatsACurveOpensAgain) {
  const NamedRig named(numbered(5));
  const uint16_t curves[] = {3, 3, 3, 3};
  MixInput input(5);
  LayerDesc& layer = input.add(BlendMode::kAdd, LayerSource::kStream);
  layer.curves = {curves, 4};
  layer.stream_frames = 8;
  input.desc.names = named.rig.names[static_cast<size_t>(Kind::kRawControl)];
  const Bytes bytes = written(*make_mix(input));
  EXPECT_EQ(written(*opened(bytes)), bytes);
}

TEST(MixFile, MixesLikeTheOriginal) {
  const MixScene scene(24);
  MixScene other(24);
  release(other.mix);
  const NamedRig same(numbered(24));
  other.mix = opened(written(*scene.mix), &same.rig).release();
  EXPECT_EQ(other.mix->fingerprint, scene.mix->fingerprint);
  SceneActor one(scene, 5), two(other, 5);
  one.begin();
  two.begin();
  Random mine = Random::from_seed(6, 0), its = mine;
  for (int i = 0; i < 600; ++i) {
    one.disturb(mine);
    two.disturb(its);
    const size_t bytes = scene.mix->curve_count * sizeof(float);
    ASSERT_EQ(memcmp(one.step(kSceneStep), two.step(kSceneStep), bytes), 0) << i;
  }
}

TEST(MixFile, OpensForARigWithOtherOrderSpellingAndMoreControls) {
  const NamedRig named(numbered(6));
  MixInput input(6, 1);
  input.desc.names = named.rig.names[static_cast<size_t>(Kind::kRawControl)];
  const Row mask = {1, 0.5f, 0, 1, 1, 1, 0.25f};
  LayerDesc& layer = input.add(BlendMode::kAdd, LayerSource::kPoses);
  layer.pose_count = 1;
  layer.mask = {mask.data(), mask.size()};
  input.add_pose({0, 1, 2, 6}, {0.5f, 0.25f, 1.0f, 2.0f});
  const Row lower(7, -1.0f), upper = {0.375f, 1, 1, 1, 1, 1, 1};
  input.desc.lower = {lower.data(), 7};
  input.desc.upper = {upper.data(), 7};
  const uint16_t mirror[] = {1, 0, 2, 3, 4, 5, 6};
  input.desc.mirror = {mirror, 7};
  const MixHandle original = make_mix(input);
  const Bytes bytes = written(*original);

  const NamedRig other({"new", "control5", "ctrl_expressions_CONTROL1", "control4", "control2",
                        "Control0", "control3", "newer"});
  const MixHandle mix = opened(bytes, &other.rig);
  ASSERT_EQ(mix->raw_count, 8u);
  EXPECT_EQ(mix->mirror[5], 2);
  EXPECT_EQ(mix->mirror[0], 0);
  EXPECT_EQ(mix->upper[0], kLargestFloat) << "a control that the file does not know";
  OwnMixer own(mix);
  own.pose(0, 0, 1.0f);
  const Row row = own.step(0), expected = {0, 0, 0.125f, 0, 0, 0.375f, 0, 0, 0.5f};
  EXPECT_EQ(row, expected);

  // In another order of the same names the bytes are the same.
  const NamedRig turned({"control5", "control4", "control3", "control2", "control1", "control0"});
  EXPECT_EQ(written(*opened(bytes, &turned.rig)), bytes);
}

TEST(MixFile, NamesTheControlsThatARigLacks) {
  const MixScene scene(9);
  const Bytes bytes = written(*scene.mix);
  MixHandle mix;
  Error error;
  std::vector<std::string> names = numbered(9);
  names[3] = "another";
  names[7] = "control8";  // of which one must not be taken twice
  const NamedRig poor(names), foreign(numbered(2, std::string(300, 'x')));
  EXPECT_EQ(opens(bytes, &poor.rig, mix, error), Status::kName);
  EXPECT_STREQ(error.message, "the rig lacks 2 of the 9 controls of the mix: control3, control7");
  EXPECT_EQ(opens(bytes, &foreign.rig, mix, error), Status::kName);
}

TEST(MixFile, IsNotWrittenWithoutNamesOrWithOneTwice) {
  MixInput input(3);
  input.add(BlendMode::kAdd, LayerSource::kPoses).pose_count = 1;
  input.add_pose({0, 2}, {1, 1});
  size_t size = 9;
  Error error;
  EXPECT_EQ(write_mix(*make_mix(input), {}, size, error), Status::kName);
  EXPECT_EQ(size, 0u);
  const NamedRig twice({"a", "b", "a"}), unused({"a", "b", "b"});
  input.desc.names = twice.rig.names[static_cast<size_t>(Kind::kRawControl)];
  EXPECT_EQ(write_mix_text(*make_mix(input), {}, size, error), Status::kName);
  EXPECT_NE(std::string(error.message).find("named a"), std::string::npos) << error.message;
  input.desc.names = unused.rig.names[static_cast<size_t>(Kind::kRawControl)];
  EXPECT_EQ(write_mix(*make_mix(input), {}, size, error), Status::kOk)
      << "nothing refers to the second b";
}

TEST(MixFile, TextHasALineForEachNumberAndKeepsNamesInTheirLine) {
  const NamedRig named({"jaw Open\n", "lip:low"});
  MixInput input(2, 1);
  input.desc.names = named.rig.names[static_cast<size_t>(Kind::kRawControl)];
  LayerDesc& layer = input.add(BlendMode::kScreen, LayerSource::kPoses, LayerGroup::kEmotion);
  layer.pose_count = 1;
  layer.weight = 1.0f / 3;
  input.add_pose({1, 2, 0}, {0.1f, -0x1p-25f, 3});
  const std::string text = text_of(*make_mix(input));
  const auto has = [&text](const char* line) {
    return ("\n" + text).find("\n" + std::string(line) + "\n") != std::string::npos;
  };
  EXPECT_TRUE(has("layers.0.group emotion")) << text;
  EXPECT_TRUE(has("layers.0.mode screen"));
  EXPECT_TRUE(has("layers.0.weight 0.333333343"));
  EXPECT_TRUE(has("poses.0.value lip\\x3Alow 0.100000001"));
  EXPECT_TRUE(has("poses.0.value variable:0 -2.98023224e-08"));
  EXPECT_TRUE(has("poses.0.value jaw\\x20Open\\x0A 3"));
  EXPECT_TRUE(has("reverse false"));
}

TEST(MixFile, EveryFieldIsInTheBytesAndInTheText) {
  // A change of any part gives another file and another text.
  const auto both = [](auto&& change) {
    GazeMix scene;
    const float mask[] = {1, 0.5f};
    const uint16_t curves[] = {4, 5};
    scene.input.add(BlendMode::kMax, LayerSource::kStream).curves = {curves, 2};
    scene.input.layers.back().mask = {mask, 2};
    scene.input.add(BlendMode::kAdd, LayerSource::kPoses).pose_count = 2;
    scene.input.add_pose({1, 2}, {0.5f, 0.25f});
    scene.input.add_pose({3}, {0.5f});
    Stroke strokes[2] = {{0, BlendMode::kMax, true, false, 0, 1, 2, 3, 4},
                         {1, BlendMode::kAdd, false, true, 0, 5, 6, 7, 8}};
    ReactionDesc reaction;
    reaction.strokes = {strokes, 2};
    Guard guard = scene_guard(1, {1, 2, 3, 4});
    AntagonistPair pair = {1, 2, 0.5f};
    scene.input.desc.reactions = {&reaction, 1};
    scene.input.desc.guards = {&guard, 1};
    scene.input.desc.antagonists = {&pair, 1};
    change(scene, strokes[1], reaction, guard, pair);
    const MixHandle mix = make_mix(scene.input);
    return std::make_pair(written(*mix), text_of(*mix));
  };
  using Change = void (*)(GazeMix&, Stroke&, ReactionDesc&, Guard&, AntagonistPair&);
  const Change changes[] = {
      [](GazeMix& m, Stroke&, ReactionDesc&, Guard&, AntagonistPair&) {
        m.input.desc.max_events = 9;
      },
      [](GazeMix& m, Stroke&, ReactionDesc&, Guard&, AntagonistPair&) {
        m.input.desc.player_count = 9;
      },
      [](GazeMix& m, Stroke&, ReactionDesc&, Guard&, AntagonistPair&) {
        m.input.desc.max_channels = 99;
      },
      [](GazeMix& m, Stroke&, ReactionDesc&, Guard&, AntagonistPair&) {
        m.input.desc.max_changing_channels = 3;
      },
      [](GazeMix& m, Stroke&, ReactionDesc&, Guard&, AntagonistPair&) {
        m.input.desc.reverse = true;
      },
      [](GazeMix& m, Stroke&, ReactionDesc&, Guard&, AntagonistPair&) {
        m.input.layers[1].delay = 7;
      },
      [](GazeMix& m, Stroke&, ReactionDesc&, Guard&, AntagonistPair&) {
        m.input.layers[1].stream_frames = 7;
      },
      [](GazeMix& m, Stroke&, ReactionDesc&, Guard&, AntagonistPair&) {
        m.input.layers[1].mask = {};
      },
      [](GazeMix& m, Stroke&, ReactionDesc&, Guard&, AntagonistPair&) {
        m.input.layers[1].group = LayerGroup::kSpeech;
      },
      [](GazeMix& m, Stroke&, ReactionDesc&, Guard&, AntagonistPair&) {
        m.input.layers[2].first_pose = m.input.layers[2].pose_count = 1;
      },
      [](GazeMix& m, Stroke&, ReactionDesc&, Guard&, AntagonistPair&) {
        m.input.layers[0].after_guards = 1;
      },
      [](GazeMix& m, Stroke&, ReactionDesc&, Guard&, AntagonistPair&) {
        m.input.layers[0].period = 77;
      },
      [](GazeMix& m, Stroke&, ReactionDesc&, Guard&, AntagonistPair&) { m.gaze.yaw_first = 1; },
      [](GazeMix& m, Stroke&, ReactionDesc&, Guard&, AntagonistPair&) {
        m.gaze.eyes[1].tangents[3][7] = 2;
      },
      [](GazeMix& m, Stroke&, ReactionDesc&, Guard&, AntagonistPair&) {
        m.gaze.eyes[1].curves[3] = 11;
      },
      [](GazeMix& m, Stroke&, ReactionDesc&, Guard&, AntagonistPair&) {
        static const uint16_t mirror[] = {1, 0, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14};
        m.input.desc.mirror = {mirror, 15};
      },
      [](GazeMix&, Stroke& s, ReactionDesc&, Guard&, AntagonistPair&) { s.pose = 0; },
      [](GazeMix&, Stroke& s, ReactionDesc&, Guard&, AntagonistPair&) { s.mode = BlendMode::kMax; },
      [](GazeMix&, Stroke& s, ReactionDesc&, Guard&, AntagonistPair&) { s.is_held = true; },
      [](GazeMix&, Stroke& s, ReactionDesc&, Guard&, AntagonistPair&) { s.is_lag = false; },
      [](GazeMix&, Stroke& s, ReactionDesc&, Guard&, AntagonistPair&) { s.delay = 9; },
      [](GazeMix&, Stroke& s, ReactionDesc&, Guard&, AntagonistPair&) { s.attack = 9; },
      [](GazeMix&, Stroke& s, ReactionDesc&, Guard&, AntagonistPair&) { s.hold = 9; },
      [](GazeMix&, Stroke& s, ReactionDesc&, Guard&, AntagonistPair&) { s.release = 9; },
      [](GazeMix&, Stroke&, ReactionDesc& r, Guard&, AntagonistPair&) {
        r.retrigger = Retrigger::kIgnore;
      },
      [](GazeMix&, Stroke&, ReactionDesc& r, Guard&, AntagonistPair&) { r.after_guards = true; },
      [](GazeMix&, Stroke&, ReactionDesc& r, Guard&, AntagonistPair&) { r.cooldown = 9; },
      [](GazeMix&, Stroke&, ReactionDesc& r, Guard&, AntagonistPair&) { r.adapted = 0.5f; },
      [](GazeMix&, Stroke&, ReactionDesc& r, Guard&, AntagonistPair&) { r.adapt_ticks = 9; },
      [](GazeMix&, Stroke&, ReactionDesc& r, Guard&, AntagonistPair&) { r.recover_ticks = 9; },
      [](GazeMix&, Stroke&, ReactionDesc& r, Guard&, AntagonistPair&) { r.level_on = 0.9f; },
      [](GazeMix&, Stroke&, ReactionDesc& r, Guard&, AntagonistPair&) {
        r.level_on = 0.9f;
        r.level_off = 0.8f;
      },
      [](GazeMix&, Stroke& s, ReactionDesc&, Guard&, AntagonistPair&) {
        s.is_scaled = !s.is_scaled;
      },
      [](GazeMix&, Stroke&, ReactionDesc&, Guard& g, AntagonistPair&) { g.kind = 3; },
      [](GazeMix&, Stroke&, ReactionDesc&, Guard& g, AntagonistPair&) { g.needs_speech = 1; },
      [](GazeMix&, Stroke&, ReactionDesc&, Guard& g, AntagonistPair&) { g.rest = 9; },
      [](GazeMix&, Stroke&, ReactionDesc&, Guard& g, AntagonistPair&) { g.f_on = 9; },
      [](GazeMix&, Stroke&, ReactionDesc&, Guard& g, AntagonistPair&) { g.tolerance = 9; },
      [](GazeMix&, Stroke&, ReactionDesc&, Guard& g, AntagonistPair&) { g.fit_error = 9; },
      [](GazeMix&, Stroke&, ReactionDesc&, Guard& g, AntagonistPair&) { g.gains[1] = 9; },
      [](GazeMix&, Stroke&, ReactionDesc&, Guard& g, AntagonistPair&) { g.curves[1] = 9; },
      [](GazeMix&, Stroke&, ReactionDesc&, Guard& g, AntagonistPair&) { g.together = 4; },
      [](GazeMix&, Stroke&, ReactionDesc&, Guard& g, AntagonistPair&) { g.pairs[1].gain = 9; },
      [](GazeMix&, Stroke&, ReactionDesc&, Guard& g, AntagonistPair&) { g.pair_count = 2; },
      [](GazeMix&, Stroke&, ReactionDesc&, Guard&, AntagonistPair& p) { p.stiffness = 1; },
      [](GazeMix&, Stroke&, ReactionDesc&, Guard&, AntagonistPair& p) { p.second = 11; },
  };
  const auto base = both([](auto&&...) {});
  int index = 0;
  for (const Change& change : changes) {
    const auto changed = both(change);
    EXPECT_NE(changed.first, base.first) << index;
    EXPECT_NE(changed.second, base.second) << index;
    EXPECT_EQ(written(*opened(changed.first)), changed.first) << index;
    ++index;
  }
}

TEST(MixFile, FingerprintsAndBytesStay) {
  // If a fingerprint changes, snapshots written by earlier versions are refused; if bytes change, files
  // are. Then kVersion of snapshots or kMixVersion has to change, too.
  const auto check = [](const Mix& mix, uint64_t fingerprint, uint32_t checksum, size_t size) {
    const Bytes bytes = written(mix);
    EXPECT_EQ(mix.fingerprint, fingerprint);
    EXPECT_EQ(clip_checksum(bytes.data(), bytes.size()), checksum);
    EXPECT_EQ(bytes.size(), size);
  };
  check(*MixScene(9).mix, 0xBDE6E2BCA5A3062Bu, 0x009BAD66u, 2328);
  check(*MixScene(24).mix, 0x176779CA53E691EBu, 0xFA33C69Fu, 3506);
  check(*MixScene(300).mix, 0x929B392ED18B9CDCu, 0x04F39874u, 11494);
  GazeMix gaze;
  check(*make_mix(gaze.input), 0xE2B6392CE5C0A421u, 0x6460A4B7u, 553);
}

TEST(MixFile, TruncatedAndForeignBytesAreRefused) {
  const MixScene scene(9);
  const Bytes bytes = written(*scene.mix);
  MixHandle mix;
  Error error;
  for (size_t size = 0; size < bytes.size(); ++size) {
    const Bytes part(bytes.begin(), bytes.begin() + static_cast<long>(size));
    const Status status = opens(part, nullptr, mix, error);
    ASSERT_EQ(status, size < 24 ? Status::kMixSignature : Status::kMixTruncated) << size;
  }
  Bytes longer = bytes;
  longer.push_back(0);
  EXPECT_EQ(opens(longer, nullptr, mix, error), Status::kMixStructure);
  Bytes other = bytes;
  other[kAtVersion] = 1;
  EXPECT_EQ(opens(other, nullptr, mix, error), Status::kMixVersion);
  other = bytes;
  other.back() ^= 1;
  EXPECT_EQ(opens(other, nullptr, mix, error), Status::kMixChecksum);
  other = bytes;
  other[0] = 'm';
  EXPECT_EQ(opens(other, nullptr, mix, error), Status::kMixSignature);
}

TEST(MixFile, ShorterContentsAreRefusedWhereTheyEnd) {
  // Sizes and checksums agree, so that the end comes inside of every field.
  const MixScene scene(9);
  const Bytes bytes = written(*scene.mix);
  MixHandle mix;
  Error error;
  for (size_t size = 24; size < bytes.size(); ++size) {
    Bytes part(bytes.begin(), bytes.begin() + static_cast<long>(size));
    store_little_endian(part.data() + kAtSize, uint64_t{size});
    fix_checksum(part);
    ASSERT_EQ(opens(part, nullptr, mix, error), Status::kMixStructure) << size;
  }
}

TEST(MixFile, MutatedBytesAreRefusedOrMixedSafely) {
  const MixScene scene(9);
  GazeMix gaze;
  const Bytes good[] = {written(*scene.mix), written(*make_mix(gaze.input))};
  const NamedRig rig(numbered(15));
  Random random = Random::from_seed(7, 0);
  size_t accepted = 0;
  for (int round = 0; round < 20000; ++round) {
    Bytes bytes = good[random.below(2)];
    for (uint32_t left = 1 + random.below(3); left > 0; --left) {
      const uint32_t at = 24 + random.below(static_cast<uint32_t>(bytes.size()) - 24);
      const uint32_t kind = random.below(3);
      if (kind == 0) bytes[at] ^= static_cast<uint8_t>(1u << random.below(8));
      if (kind == 1) bytes[at] = static_cast<uint8_t>(random.below(256));
      if (kind == 2) bytes.erase(bytes.begin() + at);
    }
    store_little_endian(bytes.data() + kAtSize, uint64_t{bytes.size()});
    fix_checksum(bytes);
    MixHandle mix;
    Error error;
    const Status status = opens(bytes, random.chance(0.5) ? &rig.rig : nullptr, mix, error);
    if (status != Status::kOk) {
      ASSERT_TRUE(status == Status::kMixStructure || status == Status::kName) << error.message;
      ASSERT_NE(error.message[0], 0);
      continue;
    }
    ++accepted;
    const Bytes canonical = written(*mix);
    ASSERT_EQ(written(*opened(canonical)), canonical);
    if (mixer_size(*mix, false) > 1 << 20) continue;
    OwnMixer own(mix);
    for (int i = 0; i < 3; ++i) {
      for (float value : own.step(kMillisecond * 100)) ASSERT_TRUE(std::isfinite(value));
    }
  }
  EXPECT_GT(accepted, 1000u) << "mutations must get far";
}

}  // namespace
}  // namespace mien
