// SPDX-License-Identifier: MIT
// Rigs with geometry for tests of the deformer, and the deformer once more in double precision:
// straight from the formulas, sharing no code with the library. Templates take duals, too.
#pragma once

#include <array>
#include <random>
#include <vector>

#include "integrations/program/model/dual.h"
#include "runtime/load/dna/format/dna_view.h"
#include "tests/support/rig_handles.h"

namespace mien {

struct DestroyDeform {
  void operator()(MienDeformer* deformer) const { mien_deformer_destroy(deformer); }
  void operator()(MienDeformerInstance* instance) const {
    mien_deformer_instance_destroy(instance);
  }
};
using DeformerHandle = std::unique_ptr<MienDeformer, DestroyDeform>;
using DeformerInstanceHandle = std::unique_ptr<MienDeformerInstance, DestroyDeform>;

DeformerHandle create_deformer(const MienDna* dna, const MienRig* rig, MienDeformerDesc desc = {},
                               MienStatus expected = MIEN_OK);
DeformerInstanceHandle create_deformer_instance(const MienDeformer* deformer, uint64_t lods = 0);
MienMesh mesh_of(const MienDeformer* deformer, uint32_t mesh);

/// What a random rig is like.
struct DeformRigOptions {
  uint32_t joints = 12;
  uint32_t meshes = 2;
  uint32_t rows = 9, columns = 11;  // of the grid that each mesh is
  uint32_t least_influences = 0, max_influences = 14;
  bool one_root = false;
  uint32_t channels = 5;
  uint32_t rotation_sequence = 0;
  int32_t rotation_signs[3] = {1, 1, 1};
  uint32_t rotation_unit = 0;
  double height = 0;           // of the whole rig above the origin
  bool clockwise = false;      // faces
  bool normals = true;         // stored
  double neutral_angles = 90;  // degrees
};

/// The bytes of a file: one LOD of everything. Joints stand in any order; positions have from 0 to
/// `max_influences` influences, faces three to six corners, every third mesh column a seam.
std::vector<uint8_t> random_deform_rig(uint32_t seed, const DeformRigOptions& options);

/// Deltas for all joints and weights for all channels.
struct DeformValues {
  std::vector<float> joints, channels;
};
/// `scale_skew` 0: uniform scales.
DeformValues random_values(const MienRig* rig, uint32_t seed, double scale_skew = 0.1);

template <class T>
using Vec3Of = std::array<T, 3>;
using Vec3d = Vec3Of<double>;
using Vec4d = std::array<double, 4>;
template <class T>
using Matrix4Of = std::array<std::array<T, 4>, 4>;  // [row][column]
using Matrix4d = Matrix4Of<double>;

struct PlainDeformer {
  const dna::DnaView& view;
  bool quaternions = false;
  bool add_angles = false;
  bool fix_weights = false;

  // Stage by stage.
  template <class T>
  std::vector<Matrix4Of<T>> locals(const std::vector<T>& values) const;
  template <class T>
  std::vector<Matrix4Of<T>> models_of(const std::vector<Matrix4Of<T>>& locals) const;
  template <class T>
  std::vector<Matrix4Of<T>> skins_of(std::vector<Matrix4Of<T>> models) const;
  template <class T>
  std::vector<Vec3Of<T>> positions_of(uint32_t mesh, const std::vector<Matrix4Of<T>>& skins,
                                      const std::vector<T>& channels) const;

  // From joint values.
  std::vector<Matrix4d> models(const std::vector<float>& values) const;
  std::vector<Matrix4d> skins(const std::vector<float>& values) const;
  std::vector<Vec3d> positions(uint32_t mesh, const DeformValues& values) const;
  /// Unit; of vertices.
  std::vector<Vec3d> skinned_normals(uint32_t mesh, const DeformValues& values) const;
  std::vector<Vec3d> recomputed_normals(uint32_t mesh, const DeformValues& values) const;
  /// x y z, unit, and w. `normals`: x y z of the neutral mesh per vertex.
  std::vector<Vec4d> neutral_tangents(uint32_t mesh, Span<const float> normals) const;
  /// Of vertices, not normalized.
  std::vector<Vec3d> skinned_tangents(uint32_t mesh, const DeformValues& values,
                                      const std::vector<Vec4d>& neutral) const;
  double diagonal(uint32_t mesh) const;

 private:
  std::vector<Vec3d> directions(uint32_t mesh, const std::vector<Vec3d>& positions) const;
};

/// A file with all that deforms it.
struct Deformed {
  std::vector<uint8_t> bytes;  // the DNA points into them
  DnaHandle dna;
  RigHandle rig;
  DeformerHandle deformer;
  DeformerInstanceHandle instance;

  explicit Deformed(std::vector<uint8_t> file, MienDeformerDesc desc = {},
                    uint32_t rotation = MIEN_ROTATION_OUTPUT_EULER)
      : bytes(std::move(file)), dna(open_dna(bytes)),
        rig(create_rig(dna.get(), MIEN_ISA_ENVIRONMENT, MIEN_OK, rotation)),
        deformer(create_deformer(dna.get(), rig.get(), desc)),
        instance(create_deformer_instance(deformer.get())) {}

  static void update(MienDeformerInstance* instance, const DeformValues& values) {
    EXPECT_EQ(mien_deformer_instance_update_from_values(
                  instance, values.joints.data(), values.joints.size(), values.channels.data(),
                  values.channels.size()),
              MIEN_OK);
  }
  void update(const DeformValues& values) { update(instance.get(), values); }
  void deform(uint32_t mesh, uint32_t normals = MIEN_NORMALS_DEFAULT) {
    EXPECT_EQ(mien_deformer_instance_deform(instance.get(), mesh, normals, nullptr), MIEN_OK);
  }
  static Span<const float> positions(const MienDeformerInstance* instance, uint32_t mesh) {
    MienFloatView view = {};
    EXPECT_EQ(mien_deformer_instance_positions(instance, mesh, &view), MIEN_OK);
    return {view.data, view.count};
  }
  static Span<const float> normals(const MienDeformerInstance* instance, uint32_t mesh) {
    MienFloatView view = {};
    EXPECT_EQ(mien_deformer_instance_normals(instance, mesh, &view), MIEN_OK);
    return {view.data, view.count};
  }
  Span<const float> positions(uint32_t mesh) const { return positions(instance.get(), mesh); }
  Span<const float> normals(uint32_t mesh) const { return normals(instance.get(), mesh); }
  Span<const float> matrices() const {
    MienFloatView view = {};
    EXPECT_EQ(mien_deformer_instance_joint_matrices(instance.get(), &view), MIEN_OK);
    return {view.data, view.count};
  }
  Span<const float> skins() const {
    MienFloatView view = {};
    EXPECT_EQ(mien_deformer_instance_skin_matrices(instance.get(), &view), MIEN_OK);
    return {view.data, view.count};
  }
  /// Positions and normals, to be compared later.
  std::vector<float> results(uint32_t mesh) const {
    std::vector<float> all(positions(mesh).begin(), positions(mesh).end());
    all.insert(all.end(), normals(mesh).begin(), normals(mesh).end());
    return all;
  }
};

/// Largest difference of two numbers at the same place.
double largest_difference(Span<const float> a, Span<const float> b);

/// Largest distance between the two.
double largest_error(Span<const float> made, const std::vector<Vec3d>& expected);

}  // namespace mien
