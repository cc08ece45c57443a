// SPDX-License-Identifier: MIT
// Antagonists, mirror, masks and gazes through mien.h: results, wrong arguments, memory. What they find
// is tested in tests/probe.
#include <cmath>
#include <functional>

#include "tests/support/counting_allocator.h"
#include "tests/support/deform_rig.h"

namespace mien {
namespace {

struct CloseGaze {
  void operator()(MienGaze* gaze) const { mien_gaze_destroy(gaze); }
};
using GazeHandle = std::unique_ptr<MienGaze, CloseGaze>;

struct Head {
  DnaHandle dna = generate_dna(MIEN_PRESET_HEAD, 0);
  RigHandle rig = create_rig(dna.get());
  DeformerHandle deformer = create_deformer(dna.get(), rig.get());
  std::vector<std::string> controls = names_of(rig, MIEN_KIND_RAW_CONTROL);

  uint16_t control(const std::string& name) const {
    for (uint16_t c = 0; c < controls.size(); ++c) {
      if (controls[c] == name) return c;
    }
    ADD_FAILURE() << name;
    return 0;
  }
};

Head& head() {
  static Head made;
  return made;
}

TEST(MixProbes, AntagonistsAreCountedAndWrittenAsFarAsThereIsRoom) {
  size_t count = 0;
  ASSERT_EQ(mien_mix_antagonists(head().rig.get(), nullptr, 0, &count), MIEN_OK);
  EXPECT_EQ(count, 11u);
  MienMixAntagonists pairs[3] = {};
  ASSERT_EQ(mien_mix_antagonists(head().rig.get(), pairs, 2, &count), MIEN_OK);
  EXPECT_EQ(count, 11u);
  EXPECT_EQ(pairs[0].first, head().control("eyeBlinkLeft"));
  EXPECT_EQ(pairs[0].second, head().control("eyeWideLeft"));
  EXPECT_EQ(pairs[0].stiffness, 1);
  EXPECT_EQ(pairs[2].stiffness, 0);
  EXPECT_EQ(mien_mix_antagonists(nullptr, pairs, 2, &count), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(count, 0u);
  EXPECT_EQ(mien_mix_antagonists(head().rig.get(), nullptr, 2, &count), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_mix_antagonists(head().rig.get(), pairs, 2, nullptr), MIEN_ERROR_NULL_ARGUMENT);
}

TEST(MixProbes, MirrorKeepsVariables) {
  std::vector<uint16_t> curves(head().controls.size() + 2);
  ASSERT_EQ(mien_mix_mirror(head().deformer.get(), curves.data(), curves.size(), nullptr), MIEN_OK);
  EXPECT_EQ(curves[head().control("mouthSmileLeft")], head().control("mouthSmileRight"));
  EXPECT_EQ(curves[head().control("jawOpen")], head().control("jawOpen"));
  EXPECT_EQ(curves.back(), curves.size() - 1);
  EXPECT_EQ(mien_mix_mirror(head().deformer.get(), curves.data(), 51, nullptr),
            MIEN_ERROR_MISMATCH);
  EXPECT_EQ(mien_mix_mirror(head().deformer.get(), nullptr, 52, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_mix_mirror(nullptr, curves.data(), 52, nullptr), MIEN_ERROR_NULL_ARGUMENT);
}

TEST(MixProbes, MasksOfAllGroupsAreOne) {
  const uint32_t groups[] = {0, 1, 2, 3, 4, 5, 6};
  std::vector<float> mask(head().controls.size() + 1);
  const MienRig* rig = head().rig.get();
  ASSERT_EQ(mien_mix_mask(rig, groups, 6, 0.5f, mask.data(), mask.size(), nullptr), MIEN_OK);
  for (size_t c = 0; c + 1 < mask.size(); ++c) EXPECT_NEAR(mask[c], 1, 1e-6);
  EXPECT_EQ(mask.back(), 0.5f) << "a pose variable";
  EXPECT_EQ(mien_mix_mask(rig, groups, 7, 0, mask.data(), mask.size(), nullptr), MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_mix_mask(rig, groups, 6, 0, mask.data(), 51, nullptr), MIEN_ERROR_MISMATCH);
  EXPECT_EQ(mien_mix_mask(rig, nullptr, 6, 0, mask.data(), 52, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_mix_mask(rig, groups, 6, 0, nullptr, 52, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_mix_mask(nullptr, groups, 6, 0, mask.data(), 52, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
}

MienStatus create_gaze(const MienGazeDesc& desc, GazeHandle& out, std::string& message) {
  MienError error = sized<MienError>();
  MienGaze* made = nullptr;
  const MienStatus status = mien_gaze_create(head().deformer.get(), &desc, &made, &error);
  out.reset(made);
  message = error.message;
  return status;
}

TEST(Gaze, TurnsTheEyesToATarget) {
  GazeHandle gaze;
  std::string message;
  ASSERT_EQ(create_gaze(sized<MienGazeDesc>(), gaze, message), MIEN_OK) << message;
  std::vector<float> row(head().controls.size());
  const MienGazeTarget target = {300, 0, 900}, far_aside = {9000, 0, 900};
  MienGazeRest rest = {1, 1};
  ASSERT_EQ(mien_gaze_look_at(gaze.get(), &far_aside, row.data(), row.size(), &rest), MIEN_OK);
  EXPECT_GT(rest.left, 1);
  ASSERT_EQ(mien_gaze_look_at(gaze.get(), &target, row.data(), row.size(), &rest), MIEN_OK);
  EXPECT_EQ(rest.left, 0);
  EXPECT_GT(row[head().control("eyeLookOutLeft")], 0.5f);
  EXPECT_GT(row[head().control("eyeLookInRight")], 0.5f);
  EXPECT_EQ(row[head().control("eyeLookInLeft")], 0);
  const std::vector<float> before = row;
  for (float bad : {INFINITY, NAN}) {
    const MienGazeTarget wrong = {0, bad, 900};
    EXPECT_EQ(mien_gaze_look_at(gaze.get(), &wrong, row.data(), row.size(), nullptr),
              MIEN_ERROR_INVALID_ARGUMENT);
  }
  EXPECT_EQ(mien_gaze_look_at(gaze.get(), &target, row.data(), 51, nullptr), MIEN_ERROR_MISMATCH);
  EXPECT_EQ(mien_gaze_look_at(gaze.get(), nullptr, row.data(), 52, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_gaze_look_at(gaze.get(), &target, nullptr, 52, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_gaze_look_at(nullptr, &target, row.data(), 52, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(row, before);
}

TEST(Gaze, TellsWhereTheEyesAre) {
  GazeHandle gaze;
  std::string message;
  ASSERT_EQ(create_gaze(sized<MienGazeDesc>(), gaze, message), MIEN_OK) << message;
  MienGazeInfo info = sized<MienGazeInfo>();
  ASSERT_EQ(mien_gaze_info(gaze.get(), &info), MIEN_OK);
  EXPECT_NEAR(info.left_eye.left, 32, 5);
  EXPECT_NEAR(info.right_eye.left, -info.left_eye.left, 0.01f);
  EXPECT_EQ(info.right_eye.up, info.left_eye.up);
  EXPECT_LT(info.fit_error, 1);
  // Straight ahead of them no control is needed.
  std::vector<float> row(head().controls.size());
  const MienGazeTarget ahead = {0, info.left_eye.up, 1e6f};
  ASSERT_EQ(mien_gaze_look_at(gaze.get(), &ahead, row.data(), row.size(), nullptr), MIEN_OK);
  for (float value : row) EXPECT_NEAR(value, 0, 1e-3f);
  EXPECT_EQ(mien_gaze_info(gaze.get(), nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_gaze_info(nullptr, &info), MIEN_ERROR_NULL_ARGUMENT);
  info.struct_size = 4;
  EXPECT_EQ(mien_gaze_info(gaze.get(), &info), MIEN_ERROR_STRUCT_SIZE);
}

TEST(Gaze, TakesJointsByName) {
  GazeHandle gaze;
  std::string message;
  MienGazeDesc desc = sized<MienGazeDesc>();
  desc.left_eye = "L_Eye";
  EXPECT_EQ(create_gaze(desc, gaze, message), MIEN_OK) << message;
  desc.right_eye = "NoEye";
  EXPECT_EQ(create_gaze(desc, gaze, message), MIEN_ERROR_NAME);
  EXPECT_EQ(gaze, nullptr);
  desc.right_eye = "C_Root";
  EXPECT_EQ(create_gaze(desc, gaze, message), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(message.find("eye 1"), std::string::npos) << message;
  EXPECT_EQ(mien_gaze_create(head().deformer.get(), nullptr, nullptr, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  MienGaze* made = nullptr;
  EXPECT_EQ(mien_gaze_create(nullptr, nullptr, &made, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  mien_gaze_destroy(nullptr);
}

// Mirror and masks take memory from the allocator of the rig, guards from that of the mix.
TEST(MixProbes, EveryFailedAllocationIsReportedAndNothingLeaks) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 1);
  CountingAllocator memory;
  {
    const MienAllocator allocator = memory.get();
    MienRigDesc rig_desc = sized<MienRigDesc>();
    rig_desc.allocator = &allocator;
    MienRig* made_rig = nullptr;
    ASSERT_EQ(mien_rig_create(dna.get(), &rig_desc, &made_rig, nullptr), MIEN_OK);
    const RigHandle rig(made_rig);
    MienDeformerDesc deformer_desc = sized<MienDeformerDesc>();
    deformer_desc.allocator = &allocator;
    MienDeformer* made_deformer = nullptr;
    ASSERT_EQ(mien_deformer_create(dna.get(), rig.get(), &deformer_desc, &made_deformer, nullptr),
              MIEN_OK);
    const DeformerHandle deformer(made_deformer);
    const size_t curve_count = names_of(rig, MIEN_KIND_RAW_CONTROL).size();
    std::vector<uint16_t> curves(curve_count);
    std::vector<float> mask(curve_count);
    const uint32_t group = 0;
    MienMixDesc mix_desc = sized<MienMixDesc>();
    mix_desc.allocator = &allocator;
    mix_desc.deformer = deformer.get();
    mix_desc.guards = MIEN_GUARD_ALL;
    const std::function<MienStatus(MienError*)> calls[] = {
        [&](MienError* error) {
          return mien_mix_mirror(deformer.get(), curves.data(), curve_count, error);
        },
        [&](MienError* error) {
          return mien_mix_mask(rig.get(), &group, 1, 0, mask.data(), curve_count, error);
        },
        [&](MienError* error) {
          MienMix* mix = nullptr;
          const MienStatus status = mien_mix_create(rig.get(), &mix_desc, &mix, error);
          EXPECT_EQ(mix == nullptr, status != MIEN_OK);
          mien_mix_destroy(mix);
          return status;
        },
    };
    const size_t live = memory.live;
    for (const auto& call : calls) {
      for (size_t request = 1;; ++request) {
        memory.restart();
        memory.fail_at = request;
        MienError error = sized<MienError>();
        const MienStatus status = call(&error);
        EXPECT_EQ(status, memory.failed ? MIEN_ERROR_MEMORY : MIEN_OK) << error.message;
        EXPECT_EQ(memory.live, live);
        if (memory.failed == 0) {
          EXPECT_GT(request, 1u);
          break;
        }
        EXPECT_NE(error.message[0], 0);
      }
    }
    memory.fail_at = 0;
  }
  EXPECT_TRUE(memory.clean()) << memory.first_wrong;
}

TEST(Gaze, IsOfAnyMemoryOrFailsWithoutALeak) {
  for (size_t request = 1;; ++request) {
    CountingAllocator memory;
    memory.fail_at = request;
    const MienAllocator allocator = memory.get();
    MienGazeDesc desc = sized<MienGazeDesc>();
    desc.allocator = &allocator;
    GazeHandle gaze;
    std::string message;
    const MienStatus status = create_gaze(desc, gaze, message);
    EXPECT_EQ(status, memory.failed ? MIEN_ERROR_MEMORY : MIEN_OK);
    gaze.reset();
    EXPECT_TRUE(memory.clean()) << memory.first_wrong;
    if (memory.failed == 0) break;
  }
}

// Guards ------------------------------------------------------------------------------------------

/// The teeth, by the joints that hold them.
struct TeethGuard {
  uint32_t upper[1], lower[1];
  MienMixGuard guard = {};

  TeethGuard() {
    const MienRig* rig = head().rig.get();
    EXPECT_EQ(mien_rig_find(rig, MIEN_KIND_JOINT, "C_TeethUpper", upper), MIEN_OK);
    EXPECT_EQ(mien_rig_find(rig, MIEN_KIND_JOINT, "C_TeethLower", lower), MIEN_OK);
    guard.upper = {upper, 1, MIEN_NO_MESH};
    guard.lower = {lower, 1, MIEN_NO_MESH};
    guard.closed_by = MIEN_NO_CONTROL;
    guard.tolerance = 0.3f;
    guard.f_on = 4;
  }
};

/// Nothing protected, and an emotion that opens the jaw.
MixHandle guarded_mix(MienMixDesc desc, MienStatus expected = MIEN_OK) {
  static const uint16_t curves[1] = {head().control("jawOpen")};
  static const float open[1] = {0.5f};
  const MienMixPose pose = {curves, open, 1};
  MienMixLayer layer = {};
  layer.group = MIEN_LAYER_GROUP_EMOTION;
  layer.source = MIEN_LAYER_SOURCE_POSES;
  layer.pose_count = 1;
  layer.weight = 1;
  desc.layers = &layer;
  desc.layer_count = 1;
  desc.poses = &pose;
  desc.pose_count = 1;
  MienMix* mix = nullptr;
  MienError error = sized<MienError>();
  EXPECT_EQ(mien_mix_create(head().rig.get(), &desc, &mix, &error), expected) << error.message;
  return MixHandle(mix);
}

MienMixDesc desc_of(const MienMixGuard& guard, uint32_t guards = 0) {
  MienMixDesc desc = sized<MienMixDesc>();
  desc.deformer = head().deformer.get();
  desc.custom_guards = &guard;
  desc.custom_guard_count = 1;
  desc.guards = guards;
  return desc;
}

TEST(MixGuards, OfTheCallerAreMeasuredLikeTheOthers) {
  const TeethGuard teeth;
  const MixHandle mix = guarded_mix(desc_of(teeth.guard, MIEN_GUARD_TEETH | MIEN_GUARD_LIDS));
  MienMixInfo info = sized<MienMixInfo>();
  ASSERT_EQ(mien_mix_info(mix.get(), &info), MIEN_OK);
  std::vector<MienMixGuardInfo> guards(info.guard_count, sized<MienMixGuardInfo>());
  for (uint32_t i = 0; i < info.guard_count; ++i) {
    ASSERT_EQ(mien_mix_guard(mix.get(), i, &guards[i]), MIEN_OK);
  }
  ASSERT_EQ(guards.size(), 4u);
  EXPECT_EQ(guards[0].needs_speech, 1u);
  EXPECT_EQ(guards[3].needs_speech, 0u);
  ASSERT_EQ(guards[0].curves.count, guards[3].curves.count);
  ASSERT_GT(guards[0].curves.count, 0u);
  EXPECT_EQ(guards[0].curves.data[0], head().control("jawOpen"));
  for (size_t i = 0; i < guards[0].curves.count; ++i) {
    EXPECT_EQ(guards[0].curves.data[i], guards[3].curves.data[i]);
    EXPECT_EQ(guards[0].gains.data[i], guards[3].gains.data[i]);
  }
  EXPECT_EQ(guards[0].fit_error, guards[3].fit_error);
  MienMixGuardInfo wrong = sized<MienMixGuardInfo>();
  EXPECT_EQ(mien_mix_guard(mix.get(), 4, &wrong), MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_mix_guard(mix.get(), 0, nullptr), MIEN_ERROR_NULL_ARGUMENT);
}

TEST(MixGuards, OfTheCallerHoldWhatTheyMeasure) {
  const TeethGuard teeth;
  const MixHandle mix = guarded_mix(desc_of(teeth.guard));
  MienMixer* made = nullptr;
  ASSERT_EQ(mien_mixer_create(mix.get(), nullptr, &made, nullptr), MIEN_OK);
  const MixerHandle mixer(made);
  ASSERT_EQ(mien_mixer_set_pose_weight(made, 0, 0, 1, 0), MIEN_OK);
  for (int i = 0; i < 60; ++i) {
    ASSERT_EQ(mien_mixer_step(made, MIEN_TICKS_PER_SECOND / 60, nullptr), MIEN_OK);
  }
  MienMixGuardInfo info = sized<MienMixGuardInfo>();
  ASSERT_EQ(mien_mix_guard(mix.get(), 0, &info), MIEN_OK);
  MienGuardState state = sized<MienGuardState>();
  ASSERT_EQ(mien_mixer_guard(made, 0, &state), MIEN_OK);
  EXPECT_EQ(std::string(state.name.data, state.name.count), "custom");
  EXPECT_EQ(state.kind, 0u);
  EXPECT_EQ(state.activation, 1);
  EXPECT_EQ(state.protected_distance, info.rest);
  EXPECT_NEAR(state.wanted, info.rest + 0.5f * info.gains.data[0], 1e-3);
  EXPECT_GT(state.wanted, state.limit + 1);
  EXPECT_NEAR(state.distance, state.limit, 1e-3);
  MienFloatView row = {};
  ASSERT_EQ(mien_mixer_row(made, &row), MIEN_OK);
  EXPECT_LT(row.data[info.curves.data[0]], 0.1f);
}

TEST(MixGuards, RefuseWrongLandmarks) {
  const auto refused = [](MienStatus expected, auto&& change) {
    TeethGuard teeth;
    MienMixDesc desc = desc_of(teeth.guard);
    change(teeth, desc);
    guarded_mix(desc, expected);
  };
  const MienStatus invalid = MIEN_ERROR_INVALID_ARGUMENT;
  refused(MIEN_ERROR_INDEX, [](TeethGuard& t, MienMixDesc&) { t.upper[0] = 60000; });
  refused(MIEN_ERROR_INDEX, [](TeethGuard& t, MienMixDesc&) { t.guard.upper.mesh = 1000; });
  refused(invalid, [](TeethGuard& t, MienMixDesc&) { t.guard.upper.point_count = 0; });
  refused(invalid, [](TeethGuard& t, MienMixDesc&) { t.guard.upper.points = nullptr; });
  refused(invalid, [](TeethGuard& t, MienMixDesc&) { t.guard.upper.point_count = 65537; });
  refused(invalid, [](TeethGuard& t, MienMixDesc&) { t.guard.closed_by = 65536; });
  refused(invalid, [](TeethGuard& t, MienMixDesc&) { t.guard.f_on = 0; });
  refused(invalid, [](TeethGuard& t, MienMixDesc&) { t.guard.tolerance = NAN; });
  refused(invalid, [](TeethGuard&, MienMixDesc& d) { d.custom_guard_count = 9; });
  refused(MIEN_ERROR_NULL_ARGUMENT, [](TeethGuard&, MienMixDesc& d) { d.deformer = nullptr; });
}

TEST(Glare, IsTheReactionOfTheLibrary) {
  MienMixStroke strokes[5] = {};
  MienMixReaction reaction = {};
  ASSERT_EQ(mien_mix_glare(7, strokes, 5, &reaction), MIEN_OK);
  EXPECT_EQ(reaction.strokes, strokes);
  EXPECT_EQ(reaction.stroke_count, 5u);
  EXPECT_EQ(strokes[0].pose, 7u);
  EXPECT_EQ(strokes[0].mode, MIEN_BLEND_MODE_MAX + 0u);
  EXPECT_EQ(strokes[0].delay, 60 * (MIEN_TICKS_PER_SECOND / 1000));
  EXPECT_EQ(strokes[3].is_lag, 1u);
  EXPECT_EQ(strokes[4].pose, 11u);
  EXPECT_EQ(mien_mix_glare(0, strokes, 4, &reaction), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(reaction.strokes, nullptr);
  EXPECT_EQ(mien_mix_glare(0, nullptr, 5, &reaction), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_mix_glare(0, strokes, 5, nullptr), MIEN_ERROR_NULL_ARGUMENT);
}

TEST(GazeLayer, TurnsTheEyesToAPoseVariable) {
  MienGaze* gaze = nullptr;
  ASSERT_EQ(mien_gaze_create(head().deformer.get(), nullptr, &gaze, nullptr), MIEN_OK);
  const auto first = static_cast<uint16_t>(head().controls.size());
  const uint16_t curves[3] = {first, static_cast<uint16_t>(first + 1),
                              static_cast<uint16_t>(first + 2)};
  const float amounts[3] = {};
  MienMixLayer layer = {};
  layer.group = MIEN_LAYER_GROUP_LIFE;
  layer.source = MIEN_LAYER_SOURCE_GENERATOR;
  layer.generator = MIEN_GENERATOR_GAZE;
  layer.period = MIEN_TICKS_PER_SECOND;
  layer.curves = curves;
  layer.amounts = amounts;
  layer.curve_count = 3;
  layer.weight = 1;
  MienMixDesc desc = sized<MienMixDesc>();
  desc.layers = &layer;
  desc.layer_count = 1;
  desc.variable_count = 3;
  desc.gaze = gaze;
  MienMix* mix = nullptr;
  MienMixer* mixer = nullptr;
  ASSERT_EQ(mien_mix_create(head().rig.get(), &desc, &mix, nullptr), MIEN_OK);
  ASSERT_EQ(mien_mixer_create(mix, nullptr, &mixer, nullptr), MIEN_OK);
  const MienGazeTarget target = {200, 1650, 1000};
  const float place[3] = {target.left, target.up, target.front};
  for (uint32_t k = 0; k < 3; ++k) {
    ASSERT_EQ(mien_mixer_set_variable(mixer, k, place[k]), MIEN_OK);
  }
  ASSERT_EQ(mien_mixer_step(mixer, MIEN_TICKS_PER_SECOND, nullptr), MIEN_OK);
  std::vector<float> wanted(head().controls.size());
  ASSERT_EQ(mien_gaze_look_at(gaze, &target, wanted.data(), wanted.size(), nullptr), MIEN_OK);
  MienFloatView row = {};
  ASSERT_EQ(mien_mixer_row(mixer, &row), MIEN_OK);
  EXPECT_GT(wanted[head().control("eyeLookOutLeft")], 0);
  EXPECT_TRUE(same_bits({row.data, wanted.size()}, span_of(wanted)));
  mien_mixer_destroy(mixer);
  mien_mix_destroy(mix);
  mien_gaze_destroy(gaze);
}

}  // namespace
}  // namespace mien
