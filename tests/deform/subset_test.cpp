// SPDX-License-Identifier: MIT
// Deformers of some positions: the bits of the whole mesh, in deformation and in derivatives.
#include <cmath>
#include <cstring>

#include "tests/support/counting_allocator.h"
#include "tests/support/deform_rig.h"
#include "tests/support/plain_rig.h"

namespace mien {
namespace {

DeformerHandle create_chosen(const MienDeformer* whole, uint32_t mesh,
                             const std::vector<uint32_t>& positions, MienStatus expected = MIEN_OK,
                             const MienAllocator* memory = nullptr) {
  MienDeformer* made = nullptr;
  MienError error = sized<MienError>();
  EXPECT_EQ(mien_deformer_create_subset(whole, mesh, positions.data(), positions.size(), memory,
                                        &made, &error),
            expected)
      << error.message;
  return DeformerHandle(made);
}

/// A random rig of which half of the positions are more than a window has.
struct Large {
  std::vector<uint8_t> bytes;
  DnaHandle dna;
  RigHandle rig;
  DeformerHandle whole;

  explicit Large(uint32_t seed) {
    DeformRigOptions options;
    options.rows = 100;
    options.columns = 101;
    bytes = random_deform_rig(seed, options);
    dna = open_dna(bytes);
    rig = create_rig(dna.get());
    whole = create_deformer(dna.get(), rig.get());
  }
};

TEST(Subset, HasTheBitsOfTheWholeMesh) {
  for (uint32_t seed : {1u, 2u}) {
    Large large(seed);
    const uint32_t count = mesh_of(large.whole.get(), 1).position_count;
    std::vector<uint32_t> chosen;
    for (uint32_t i = seed; i < count; i += seed == 1 ? 2 : 37) chosen.push_back(i);
    const DeformerHandle some = create_chosen(large.whole.get(), 1, chosen);
    ASSERT_TRUE(some);
    const MienMesh mesh = mesh_of(some.get(), 1);
    EXPECT_EQ(mesh.position_count, chosen.size());
    EXPECT_EQ(mesh.vertex_count, 0u);
    EXPECT_EQ(mesh_of(some.get(), 0).position_count, 0u);
    const DeformerInstanceHandle a = create_deformer_instance(large.whole.get()),
                                 b = create_deformer_instance(some.get());
    large.whole.reset();  // the subset keeps its memory
    for (uint32_t pose = 0; pose < 3; ++pose) {
      const DeformValues values = random_values(large.rig.get(), pose);
      MienFloatView all = {}, few = {};
      for (const auto& instance : {a.get(), b.get()}) {
        ASSERT_EQ(mien_deformer_instance_update_from_values(
                      instance, values.joints.data(), values.joints.size(), values.channels.data(),
                      values.channels.size()),
                  MIEN_OK);
        ASSERT_EQ(mien_deformer_instance_deform(instance, 1, MIEN_NORMALS_DEFAULT, nullptr),
                  MIEN_OK);
        ASSERT_EQ(mien_deformer_instance_deform(instance, 0, MIEN_NORMALS_DEFAULT, nullptr),
                  MIEN_OK);
      }
      ASSERT_EQ(mien_deformer_instance_positions(a.get(), 1, &all), MIEN_OK);
      ASSERT_EQ(mien_deformer_instance_positions(b.get(), 1, &few), MIEN_OK);
      for (size_t i = 0; i < chosen.size(); ++i) {
        ASSERT_EQ(
            std::memcmp(few.data + 3 * i, all.data + size_t{chosen[i]} * 3, 3 * sizeof(float)), 0)
            << i;
      }
    }
  }
}

TEST(Subset, HasTheDerivativesOfTheWholeMesh) {
  Large large(3);
  const std::vector<uint32_t> chosen = {0, 5, 511, 512, 700, 1639};
  const DeformerHandle some = create_chosen(large.whole.get(), 0, chosen);
  ASSERT_TRUE(some);
  Character character(large.rig);
  character.evaluate(0);
  std::vector<float> moved[2];
  for (int k = 0; k < 2; ++k) {
    MienDerivativesDesc desc = sized<MienDerivativesDesc>();
    desc.deformer = k == 0 ? large.whole.get() : some.get();
    MienDerivatives* made = nullptr;
    ASSERT_EQ(mien_derivatives_create(large.rig.get(), &desc, &made, nullptr), MIEN_OK);
    ASSERT_EQ(mien_derivatives_linearize(made, character.instance.get(), MIEN_STAGE_ALL), MIEN_OK);
    size_t from = 0, to = 0;
    ASSERT_EQ(mien_derivatives_size(made, MIEN_POINT_JOINTS, 0, &from), MIEN_OK);
    ASSERT_EQ(mien_derivatives_size(made, MIEN_POINT_POSITIONS, 0, &to), MIEN_OK);
    std::vector<float> direction(from);
    for (size_t i = 0; i < from; ++i) direction[i] = std::sin(static_cast<float>(i));
    moved[k].resize(to);
    ASSERT_EQ(mien_derivatives_forward(made, MIEN_POINT_JOINTS, MIEN_POINT_POSITIONS, 0, 1,
                                       direction.data(), moved[k].data()),
              MIEN_OK);
    mien_derivatives_destroy(made);
  }
  ASSERT_EQ(moved[1].size(), chosen.size() * 3);
  for (size_t i = 0; i < moved[1].size(); ++i) {
    EXPECT_EQ(moved[1][i], moved[0][size_t{chosen[i / 3]} * 3 + i % 3]) << i;
  }
}

TEST(Subset, RefusesWrongPositions) {
  Large large(4);
  create_chosen(large.whole.get(), 9, {0}, MIEN_ERROR_INDEX);
  create_chosen(large.whole.get(), 0, {100 * 101}, MIEN_ERROR_INDEX);
  create_chosen(large.whole.get(), 0, {1, 1}, MIEN_ERROR_INVALID_ARGUMENT);
  create_chosen(large.whole.get(), 0, {2, 1}, MIEN_ERROR_INVALID_ARGUMENT);
  create_chosen(nullptr, 0, {1}, MIEN_ERROR_NULL_ARGUMENT);
  const DeformerHandle none = create_chosen(large.whole.get(), 0, {});
  EXPECT_EQ(mesh_of(none.get(), 0).position_count, 0u);
  MienDeformer* made = nullptr;
  EXPECT_EQ(mien_deformer_create_subset(large.whole.get(), 0, nullptr, 1, nullptr, &made, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  CountingAllocator memory;
  const MienAllocator allocator = memory.get();
  for (size_t k = 1;; ++k) {
    memory.restart();
    memory.fail_at = k;
    MienDeformer* some = nullptr;
    const std::vector<uint32_t> chosen = {1, 2, 3};
    const MienStatus status = mien_deformer_create_subset(large.whole.get(), 0, chosen.data(), 3,
                                                          &allocator, &some, nullptr);
    mien_deformer_destroy(some);
    EXPECT_EQ(memory.live, 0u) << k;
    if (memory.failed == 0) {
      EXPECT_EQ(status, MIEN_OK);
      break;
    }
    EXPECT_EQ(status, MIEN_ERROR_MEMORY) << k;
  }
}

}  // namespace
}  // namespace mien
