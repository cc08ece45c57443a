// SPDX-License-Identifier: MIT
#include "runtime/probe/probe_controls.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "author/base/dna_making.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/cpu_time.h"
#include "tests/support/deform_rig.h"
#include "tests/support/plain_rig.h"

namespace mien {
namespace {

struct ProbedHead {
  DnaHandle dna = generate_dna(MIEN_PRESET_HEAD, 0);
  RigHandle rig = create_rig(dna.get());
  DeformerHandle handle = create_deformer(dna.get(), rig.get());
  const Deformer& deformer = *capi::object(handle.get());
  std::vector<std::string> controls = names_of(rig, MIEN_KIND_RAW_CONTROL);

  size_t control(const std::string& name) const {
    for (size_t c = 0; c < controls.size(); ++c) {
      if (controls[c] == name) return c;
    }
    ADD_FAILURE() << name;
    return 0;
  }
};

ProbedHead& head() {
  static ProbedHead made;
  return made;
}

// Antagonists -----------------------------------------------------------------------------------------

TEST(Antagonists, AreTheHalvesOfGuiControls) {
  std::vector<AntagonistPair> pairs(64);
  const uint32_t count = find_antagonists(*head().deformer.rig, {pairs.data(), pairs.size()});
  std::set<std::string> names;
  for (uint32_t i = 0; i < count; ++i) {
    names.insert(head().controls[pairs[i].first] + " " + head().controls[pairs[i].second]);
    EXPECT_EQ(pairs[i].stiffness, 1);
  }
  EXPECT_EQ(names, (std::set<std::string>{
                       "eyeBlinkLeft eyeWideLeft", "eyeBlinkRight eyeWideRight",
                       "eyeLookUpLeft eyeLookDownLeft", "eyeLookUpRight eyeLookDownRight",
                       "eyeLookOutLeft eyeLookInLeft", "eyeLookInRight eyeLookOutRight",
                       "jawLeft jawRight", "mouthLeft mouthRight", "mouthSmileLeft mouthFrownLeft",
                       "mouthSmileRight mouthFrownRight", "neckThroatUp neckThroatDown"}));
  // Without room they are counted.
  EXPECT_EQ(find_antagonists(*head().deformer.rig, {pairs.data(), 2}), count);
}

TEST(Antagonists, AreDrivenByNothingElse) {
  PlainRig plain;
  plain.gui_count = 3;
  plain.raw_count = 6;
  plain.joint_count = 1;
  plain.gui_to_raw = {
      {0, 0, 0, 1, 1, 0},  {0, 1, -1, 0, -1, 0},  // a pair
      {1, 2, 0, 1, 1, 0},  {1, 3, -1, 0, -1, 0},  // not: 3 follows another GUI control too
      {2, 3, 0, 1, 1, 0},  {2, 4, -1, 1, 1, 0},   // 4 is driven across zero
      {2, 5, -1, 0, 1, 0},                        // 5 becomes negative
  };
  const RigHandle rig = make_rig(plain);
  AntagonistPair pairs[8];
  ASSERT_EQ(find_antagonists(*capi::object(rig.get()), {pairs, 8}), 1u);
  EXPECT_EQ(pairs[0].first, 0);
  EXPECT_EQ(pairs[0].second, 1);
}

// Rows of a file are as many as somebody likes: not each can be compared with each.
TEST(Antagonists, OfLongTablesAreFoundAtOnce) {
  PlainRig plain;
  plain.gui_count = 2;
  plain.raw_count = kMaxCurves + 2;
  plain.joint_count = 1;
  constexpr uint16_t kHalf = 1000;
  for (int times = 0; times < 20; ++times) {
    for (uint16_t c = 0; c < 2 * kHalf; ++c) {
      if (c % 2 == 0) plain.gui_to_raw.push_back({1, c, 0, 1, 1, 0});
      if (c % 2 == 1) plain.gui_to_raw.push_back({1, c, -1, 0, -1, 0});
    }
  }
  // No curves of a mix.
  plain.gui_to_raw.push_back({0, kMaxCurves, 0, 1, 1, 0});
  plain.gui_to_raw.push_back({0, kMaxCurves + 1, -1, 0, -1, 0});
  const RigHandle rig = make_rig(plain);
  std::vector<AntagonistPair> pairs(size_t{kHalf} * kHalf);
  const double begin = cpu_seconds();
  ASSERT_EQ(find_antagonists(*capi::object(rig.get()), {pairs.data(), pairs.size()}), pairs.size());
  EXPECT_LT(cpu_seconds() - begin, 2) << "pairs of rows take hours";
  for (size_t i = 0; i < pairs.size(); ++i) {
    ASSERT_EQ(pairs[i].first, 2 * (i / kHalf));
    ASSERT_EQ(pairs[i].second, 2 * (i % kHalf) + 1);
  }
}

// Mirror ----------------------------------------------------------------------------------------------

std::vector<uint16_t> mirror_of(const ProbedHead& head) {
  std::vector<uint16_t> map(head.controls.size());
  Error error;
  EXPECT_EQ(find_mirror(head.deformer, default_allocator(), {map.data(), map.size()}, error),
            Status::kOk);
  return map;
}

TEST(Mirror, PairsLeftAndRightAndKeepsTheMiddle) {
  const std::vector<uint16_t> map = mirror_of(head());
  for (size_t c = 0; c < map.size(); ++c) {
    std::string name = head().controls[c];
    const size_t left = name.find("Left"), right = name.find("Right");
    if (left != std::string::npos) name.replace(left, 4, "Right");
    if (right != std::string::npos) name.replace(right, 5, "Left");
    // Names of MetaHuman rigs end in L or R.
    if (name.back() == 'L' || name.back() == 'R') name.back() = name.back() == 'L' ? 'R' : 'L';
    EXPECT_EQ(head().controls[map[c]], name);
    EXPECT_EQ(map[map[c]], c);
  }
}

// A file of a megabyte could ask for a gigabyte.
TEST(Mirror, RefusesMoreMotionsThanItCompares) {
  PlainRig plain;
  plain.raw_count = 4096;
  for (const uint16_t joints : {uint16_t{1025}, uint16_t{1}}) {
    plain.joint_count = joints;
    Arena arena(default_allocator());
    const std::vector<uint8_t> bytes = write_view(to_view(plain, arena));
    const DnaHandle dna = open_dna(bytes);
    const RigHandle rig = create_rig(dna.get());
    const DeformerHandle deformer = create_deformer(dna.get(), rig.get());
    std::vector<uint16_t> curves(plain.raw_count);
    EXPECT_EQ(mien_mix_mirror(deformer.get(), curves.data(), curves.size(), nullptr),
              joints == 1 ? MIEN_OK : MIEN_ERROR_DNA_LIMIT);
  }
}

TEST(Mirror, FindsPairsByTheirMotionWhereNamesSayNothing) {
  ProbedHead renamed;
  std::vector<std::string> names = renamed.controls;
  for (dna::String& name : renamed.dna->view.defn.raw_control_names) {
    // "mouthSmileLeft" -> "mouthSmile_1": numbers instead of sides, and not in the same order.
    std::string text(name.chars(), name.count);
    const size_t left = text.find("Left"), right = text.find("Right");
    if (left != std::string::npos) text.replace(left, 4, "_1");
    if (right != std::string::npos) text.replace(right, 5, "_2");
    ASSERT_TRUE(author::copy_text(renamed.dna->arena, author::Text().add(text.c_str()), name));
  }
  renamed.rig = create_rig(renamed.dna.get());
  const DeformerHandle deformer = create_deformer(renamed.dna.get(), renamed.rig.get());
  std::vector<uint16_t> map(names.size());
  Error error;
  ASSERT_EQ(find_mirror(*capi::object(deformer.get()), default_allocator(),
                        {map.data(), map.size()}, error),
            Status::kOk);
  EXPECT_EQ(map, mirror_of(head()));
}

TEST(Mirror, FailsWithoutALeakWhereverMemoryRunsOut) {
  std::vector<uint16_t> map(head().controls.size());
  for (size_t request = 1;; ++request) {
    CountingAllocator memory;
    memory.fail_at = request;
    const MienAllocator counted = memory.get();
    Error error;
    const Status status =
        find_mirror(head().deformer, {counted.user, counted.allocate, counted.release},
                    {map.data(), map.size()}, error);
    EXPECT_TRUE(memory.clean()) << memory.first_wrong;
    EXPECT_EQ(status, memory.failed ? Status::kMemory : Status::kOk);
    if (memory.failed == 0) break;
  }
}

// Masks -----------------------------------------------------------------------------------------------

std::vector<float> mask_of(std::vector<uint32_t> groups) {
  std::vector<float> mask(head().controls.size());
  Error error;
  EXPECT_EQ(mask_of_groups(*head().deformer.rig, {groups.data(), groups.size()}, 0.25f,
                           default_allocator(), {mask.data(), mask.size()}, error),
            Status::kOk);
  return mask;
}

TEST(Masks, AreSharesOfTheMotionOfJointGroups) {
  const std::vector<float> all = mask_of({0, 1, 2, 3, 4, 5}), none = mask_of({});
  std::vector<float> sum(all.size());
  std::vector<std::vector<float>> parts;
  for (uint32_t group = 0; group < 6; ++group) parts.push_back(mask_of({group}));
  for (size_t c = 0; c < all.size(); ++c) {
    EXPECT_NEAR(all[c], 1, 1e-6) << head().controls[c];
    EXPECT_EQ(none[c], 0);
    float parts_sum = 0;
    for (const std::vector<float>& part : parts) parts_sum += part[c];
    EXPECT_NEAR(parts_sum, 1, 1e-5);
  }
  // What brows do is done by one group almost alone, and what eyes do by another.
  const auto strongest = [&](const char* name) {
    size_t best = 0;
    for (size_t g = 0; g < parts.size(); ++g) {
      if (parts[g][head().control(name)] > parts[best][head().control(name)]) best = g;
    }
    EXPECT_GT(parts[best][head().control(name)], 0.6) << name;
    return best;
  };
  EXPECT_EQ(strongest("browInnerUp"), strongest("browOuterUpLeft"));
  EXPECT_EQ(strongest("eyeLookOutLeft"), strongest("eyeBlinkLeft"));
  EXPECT_NE(strongest("eyeLookOutLeft"), strongest("eyeLookOutRight"));
  EXPECT_NE(strongest("browInnerUp"), strongest("jawOpen"));
}

TEST(Masks, GiveControlsWithoutJointsWhatTheCallerSays) {
  PlainRig plain;
  plain.raw_count = 2;
  plain.joint_count = 1;
  plain.groups = {{{1}, {0}, {0}, {0.5f}}};  // raw control 0 moves the joint
  const RigHandle rig = make_rig(plain);
  const uint32_t group = 0;
  float mask[2];
  Error error;
  ASSERT_EQ(mask_of_groups(*capi::object(rig.get()), {&group, 1}, 0.25f, default_allocator(),
                           {mask, 2}, error),
            Status::kOk);
  EXPECT_EQ(mask[0], 1);
  EXPECT_EQ(mask[1], 0.25f);
}

TEST(Masks, AreRefusedForGroupsThatDoNotExist) {
  const uint32_t group = 6;
  std::vector<float> mask(head().controls.size());
  Error error;
  EXPECT_EQ(mask_of_groups(*head().deformer.rig, {&group, 1}, 0, default_allocator(),
                           {mask.data(), mask.size()}, error),
            Status::kIndex);
}

}  // namespace
}  // namespace mien
