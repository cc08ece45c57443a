// SPDX-License-Identifier: MIT
// Results that are kept because their inputs did not change have the bits of those computed anew,
// whatever happened to the instance before.
#include <gtest/gtest.h>

#include "tests/support/many_rigs.h"

namespace mien {
namespace {

/// Does something to both that a caller could do.
void act(Random& random, const RigHandle& keeping, const RigHandle& plain, Character& a,
         Character& b) {
  const uint32_t lod_count = info_of(keeping).lod_count;
  static thread_local uint32_t lod = 0;
  lod = lod < lod_count ? lod : 0;
  const auto both = [&](auto&& f) {
    f(keeping, a);
    f(plain, b);
  };
  const auto copy_inputs = [&] {
    std::copy(a.raw.begin(), a.raw.end(), b.raw.begin());
    std::copy(a.masks.begin(), a.masks.end(), b.masks.begin());
  };
  switch (random.below(12)) {
    case 0: draw_controls(random, random.below(101), a.raw); break;
    case 1: std::fill(a.raw.begin(), a.raw.end(), 0.0f); break;
    case 2: lod = random.below(lod_count); break;
    case 3:
      both([](const RigHandle&, Character& c) {
        EXPECT_EQ(mien_instance_reset(c.instance.get()), MIEN_OK);
      });
      break;
    case 4:
      if (!a.masks.empty()) a.masks[random.below(static_cast<uint32_t>(a.masks.count))] = 0.5f;
      break;
    case 5: {
      const uint32_t groups = count_of(keeping, MIEN_KIND_JOINT_GROUP);
      if (groups == 0) break;
      const uint32_t group = random.below(groups);
      copy_inputs();
      both([&](const RigHandle& rig, Character& c) {
        EXPECT_EQ(mien_rig_evaluate_joint_group(rig.get(), c.instance.get(), lod, group), MIEN_OK);
      });
      break;
    }
    case 6: {
      const uint32_t solvers = count_of(keeping, MIEN_KIND_RBF_SOLVER);
      if (solvers == 0) break;
      const uint32_t solver = random.below(solvers);
      copy_inputs();
      both([&](const RigHandle& rig, Character& c) {
        EXPECT_EQ(mien_rig_evaluate_rbf_solver(rig.get(), c.instance.get(), lod, solver), MIEN_OK);
      });
      break;
    }
    default:  // one control, which most things do not depend on
      if (!a.raw.empty()) {
        a.raw[random.below(static_cast<uint32_t>(a.raw.count))] =
            static_cast<float>(random.below(9)) / 8;
      }
  }
  copy_inputs();
  const uint32_t stages = random.below(3) == 0 ? random.below(64) : uint32_t{MIEN_STAGE_ALL};
  both([&](const RigHandle&, Character& c) { c.evaluate(lod, stages); });
}

TEST(Reuse, HasTheBitsOfEvaluationAnew) {
  Random random = Random::from_seed(21, 1);
  for_each_dna(12, [&](const DnaHandle& dna) {
    for_each_rig_desc([&](MienRigDesc desc) {
      const RigHandle keeping = create_rig(dna.get(), desc);
      desc.reuse = MIEN_REUSE_NOTHING;
      const RigHandle plain = create_rig(dna.get(), desc);
      Character a(keeping), b(plain);
      for (int step = 0; step < 60; ++step) {
        act(random, keeping, plain, a, b);
        ASSERT_TRUE(same_results(a, b)) << "step " << step;
      }
    });
  });
}

// Outputs that nothing should write keep what a caller, who must not, puts there: this is how it
// shows that they were not computed.
TEST(Reuse, KeepsWhatDidNotChange) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 1);
  MienRigDesc desc = sized<MienRigDesc>();
  for (uint32_t reuse : {MIEN_REUSE_UNCHANGED, MIEN_REUSE_NOTHING}) {
    desc.reuse = reuse;
    const RigHandle rig = create_rig(dna.get(), desc);
    Character c(rig);
    std::fill(c.raw.begin(), c.raw.end(), 0.5f);
    c.evaluate(0);
    MienIndexView variable;
    ASSERT_EQ(mien_rig_variable_joint_values(rig.get(), 0, &variable), MIEN_OK);
    const float before = c.joints[variable.data[0]];
    const_cast<float&>(c.joints[variable.data[0]]) = 12345.0f;
    c.evaluate(0);
    EXPECT_EQ(c.joints[variable.data[0]], reuse == MIEN_REUSE_UNCHANGED ? 12345.0f : before);
  }
}

TEST(Reuse, IsOneOfItsValues) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_TINY, 1);
  MienRigDesc desc = sized<MienRigDesc>();
  desc.reuse = 2;
  MienRig* rig = nullptr;
  EXPECT_EQ(mien_rig_create(dna.get(), &desc, &rig, nullptr), MIEN_ERROR_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace mien
