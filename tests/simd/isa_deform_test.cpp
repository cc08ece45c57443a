// SPDX-License-Identifier: MIT
// The deformer on every instruction set: against double precision, and against each other.
#include "tests/support/deform_rig.h"

namespace mien {
namespace {

MienDeformerDesc on(uint32_t isa) {
  MienDeformerDesc desc = {};
  desc.isa = isa;
  return desc;
}

bool fuses(uint32_t isa) { return isa != MIEN_ISA_SCALAR && isa != MIEN_ISA_SSE2; }

TEST(IsaDeform, AgreesWithDoublePrecision) {
  for (uint32_t seed = 0; seed < 12; ++seed) {
    DeformRigOptions options;
    options.rotation_sequence = seed % 6;
    options.rotation_signs[seed % 3] = -1;
    options.rotation_unit = seed % 2;
    options.clockwise = seed % 4 == 1;
    options.normals = seed % 5 != 4;
    const std::vector<uint8_t> file = random_deform_rig(seed, options);
    for (uint32_t rotation : {MIEN_ROTATION_OUTPUT_EULER, MIEN_ROTATION_OUTPUT_QUATERNION}) {
      for (uint32_t compose : {MIEN_COMPOSE_PRODUCT, MIEN_COMPOSE_EULER_ADD}) {
        if (rotation == MIEN_ROTATION_OUTPUT_QUATERNION && compose == MIEN_COMPOSE_EULER_ADD)
          continue;
        for (uint32_t isa : present_isas()) {
          SCOPED_TRACE(testing::Message() << "seed " << seed << " rotation " << rotation
                                          << " compose " << compose << " " << mien_isa_name(isa));
          MienDeformerDesc desc = on(isa);
          desc.compose = compose;
          Deformed d(file, desc, rotation);
          PlainDeformer plain = {d.dna->view};
          plain.quaternions = rotation == MIEN_ROTATION_OUTPUT_QUATERNION;
          plain.add_angles = compose == MIEN_COMPOSE_EULER_ADD;
          const DeformValues values = random_values(d.rig.get(), seed + 100);
          d.update(values);
          for (uint32_t m = 0; m < options.meshes; ++m) {
            const double diagonal = plain.diagonal(m);
            d.deform(m);
            EXPECT_LE(largest_error(d.positions(m), plain.positions(m, values)), 1e-5 * diagonal);
            EXPECT_LE(largest_error(d.normals(m), plain.recomputed_normals(m, values)), 1e-4);
            if (!options.normals) continue;
            d.deform(m, MIEN_NORMALS_SKINNED);
            EXPECT_LE(largest_error(d.normals(m), plain.skinned_normals(m, values)), 1e-4);
          }
        }
      }
    }
  }
}

// A character stands with its feet at the origin, so its head is far from it: 1.5 m.
TEST(IsaDeform, AgreesWithDoublePrecisionFarFromTheOrigin) {
  DeformRigOptions options;
  options.height = 150;
  options.rows = options.columns = 25;
  options.one_root = true;
  options.joints = 40;
  const std::vector<uint8_t> file = random_deform_rig(3, options);
  for (uint32_t isa : present_isas()) {
    SCOPED_TRACE(mien_isa_name(isa));
    Deformed d(file, on(isa));
    const PlainDeformer plain = {d.dna->view};
    const DeformValues values = random_values(d.rig.get(), 7);
    d.update(values);
    d.deform(0);
    EXPECT_LE(largest_error(d.positions(0), plain.positions(0, values)), 1e-5 * plain.diagonal(0));
  }
}

// Matrices are never fused. Meshes are the same among those that fuse, and among those that do not.
TEST(IsaDeform, SameBitsWhereThatIsPromised) {
  for (uint32_t seed = 0; seed < 6; ++seed) {
    DeformRigOptions options;
    options.rows = 40;  // more than one block
    options.columns = 30;
    options.height = seed % 2 ? 150 : 0;
    options.one_root = true;
    const std::vector<uint8_t> file = random_deform_rig(seed, options);
    std::vector<float> matrices, meshes[2];
    for (uint32_t isa : present_isas()) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << " " << mien_isa_name(isa));
      MienDeformerDesc desc = on(isa);
      desc.storage = seed < 4 ? MIEN_STORAGE_32_BIT : MIEN_STORAGE_16_BIT;
      Deformed d(file, desc);
      // Skewed every other time, which takes another way to normals.
      d.update(random_values(d.rig.get(), seed, seed % 3 ? 0.1 : 0));
      std::vector<float> own(d.matrices().begin(), d.matrices().end());
      own.insert(own.end(), d.skins().begin(), d.skins().end());
      if (matrices.empty()) matrices = own;
      EXPECT_TRUE(same_bits(span_of(own), span_of(matrices)));

      std::vector<float> made;
      for (uint32_t normals : {MIEN_NORMALS_SKINNED, MIEN_NORMALS_RECOMPUTED}) {
        d.deform(0, normals);
        const std::vector<float> results = d.results(0);
        made.insert(made.end(), results.begin(), results.end());
      }
      std::vector<float>& expected = meshes[fuses(isa)];
      if (expected.empty()) expected = made;
      EXPECT_TRUE(same_bits(span_of(made), span_of(expected)));
    }
    if (meshes[1].empty()) continue;
    Deformed d(file);
    const size_t positions = d.positions(0).count;
    const auto part = [&](int family) { return span_of(meshes[family]).first(positions); };
    EXPECT_LE(largest_difference(part(0), part(1)), 2e-6 * PlainDeformer{d.dna->view}.diagonal(0));
    // Of normals, at worst those that are recomputed from short edges far from the origin.
    EXPECT_LE(largest_difference(span_of(meshes[0]), span_of(meshes[1])), 1e-3);
  }
}

}  // namespace
}  // namespace mien
