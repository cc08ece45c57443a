// SPDX-License-Identifier: MIT
// Positions and normals against the same in double precision, on every instruction set.
#include "tests/support/deform_rig.h"

namespace mien {
namespace {

struct Deformed {
  DnaHandle dna;
  RigHandle rig;
  DeformerHandle deformer;
  PoseHandle pose;

  Deformed(const std::vector<uint8_t>& file, MienDeformerDesc desc = {},
           uint32_t rotation = MIEN_OUTPUT_EULER)
      : dna(open_dna(file)), rig(create_rig(dna.get(), MIEN_ISA_BEST, MIEN_OK, rotation)),
        deformer(create_deformer(dna.get(), rig.get(), desc)), pose(create_pose(deformer.get())) {}

  void update(const DeformValues& values) {
    EXPECT_EQ(mien_pose_update_from_values(pose.get(), values.joints.data(), values.joints.size(),
                                           values.channels.data(), values.channels.size()),
              MIEN_OK);
  }
  void deform(uint32_t mesh, uint32_t normals = MIEN_NORMALS_DEFAULT) {
    EXPECT_EQ(mien_pose_deform(pose.get(), mesh, normals, nullptr), MIEN_OK);
  }
  MienFloatView positions(uint32_t mesh) const {
    MienFloatView view = {};
    EXPECT_EQ(mien_pose_positions(pose.get(), mesh, &view), MIEN_OK);
    return view;
  }
  MienFloatView normals(uint32_t mesh) const {
    MienFloatView view = {};
    EXPECT_EQ(mien_pose_normals(pose.get(), mesh, &view), MIEN_OK);
    return view;
  }
};

MienDeformerDesc on(uint32_t isa) {
  MienDeformerDesc desc = {};
  desc.isa = isa;
  return desc;
}

TEST(Deform, AgreesWithDoublePrecision) {
  for (uint32_t seed = 0; seed < 12; ++seed) {
    DeformRigOptions options;
    options.rotation_sequence = seed % 6;
    options.rotation_signs[seed % 3] = -1;
    options.rotation_unit = seed % 2;
    options.clockwise = seed % 4 == 1;
    options.normals = seed % 5 != 4;
    const std::vector<uint8_t> file = random_deform_rig(seed, options);
    for (uint32_t rotation : {MIEN_OUTPUT_EULER, MIEN_OUTPUT_QUATERNION}) {
      for (uint32_t compose : {MIEN_COMPOSE_PRODUCT, MIEN_COMPOSE_EULER_ADD}) {
        if (rotation == MIEN_OUTPUT_QUATERNION && compose == MIEN_COMPOSE_EULER_ADD) continue;
        for (uint32_t isa : present_isas()) {
          SCOPED_TRACE(testing::Message() << "seed " << seed << " rotation " << rotation
                                          << " compose " << compose << " " << mien_isa_name(isa));
          MienDeformerDesc desc = on(isa);
          desc.compose = compose;
          Deformed d(file, desc, rotation);
          PlainDeformer plain = {d.dna->view};
          plain.quaternions = rotation == MIEN_OUTPUT_QUATERNION;
          plain.add_angles = compose == MIEN_COMPOSE_EULER_ADD;
          const DeformValues values = random_values(d.rig.get(), seed + 100);
          d.update(values);
          for (uint32_t m = 0; m < options.meshes; ++m) {
            d.deform(m);
            EXPECT_LE(largest_error(d.positions(m), plain.positions(m, values)),
                      1e-5 * plain.diagonal(m));
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

}  // namespace
}  // namespace mien
