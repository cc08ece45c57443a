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
  EXPECT_EQ(count, 10u);
  MienMixAntagonists pairs[3] = {};
  ASSERT_EQ(mien_mix_antagonists(head().rig.get(), pairs, 2, &count), MIEN_OK);
  EXPECT_EQ(count, 10u);
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
  std::vector<uint16_t> lanes(head().controls.size() + 2);
  ASSERT_EQ(mien_mix_mirror(head().deformer.get(), lanes.data(), lanes.size(), nullptr), MIEN_OK);
  EXPECT_EQ(lanes[head().control("mouthSmileLeft")], head().control("mouthSmileRight"));
  EXPECT_EQ(lanes[head().control("jawOpen")], head().control("jawOpen"));
  EXPECT_EQ(lanes[53], 53);
  EXPECT_EQ(mien_mix_mirror(head().deformer.get(), lanes.data(), 51, nullptr), MIEN_ERROR_MISMATCH);
  EXPECT_EQ(mien_mix_mirror(head().deformer.get(), nullptr, 52, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_mix_mirror(nullptr, lanes.data(), 52, nullptr), MIEN_ERROR_NULL_ARGUMENT);
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
    const size_t lane_count = names_of(rig, MIEN_KIND_RAW_CONTROL).size();
    std::vector<uint16_t> lanes(lane_count);
    std::vector<float> mask(lane_count);
    const uint32_t group = 0;
    MienMixDesc mix_desc = sized<MienMixDesc>();
    mix_desc.allocator = &allocator;
    mix_desc.deformer = deformer.get();
    mix_desc.guards = MIEN_GUARD_ALL;
    const std::function<MienStatus(MienError*)> calls[] = {
        [&](MienError* error) {
          return mien_mix_mirror(deformer.get(), lanes.data(), lane_count, error);
        },
        [&](MienError* error) {
          return mien_mix_mask(rig.get(), &group, 1, 0, mask.data(), lane_count, error);
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

}  // namespace
}  // namespace mien
