// SPDX-License-Identifier: MIT
// A rig with geometry as the exporter reads it: the handles, and the way from the axes and units of
// its file to those of glTF.
#pragma once

#include "integrations/gltf/scene.h"

namespace mien::gltf {

/// Not owned; all of the same file, opened with the LODs that are to be exported.
struct RigHandles {
  const MienDna* dna = nullptr;
  const MienRig* rig = nullptr;
  const MienDeformer* deformer = nullptr;
};

/// Throws ExportError unless `status` is MIEN_OK.
void check(MienStatus status, const char* what);

/// A struct of the library, zeroed, with its size set.
template <class T>
T sized() {
  T value{};
  value.struct_size = sizeof(T);
  return value;
}

class RigSource {
 public:
  explicit RigSource(const RigHandles& handles);

  const MienDna* dna() const { return handles_.dna; }
  const MienRig* rig() const { return handles_.rig; }
  const MienDeformer* deformer() const { return handles_.deformer; }

  uint32_t count(uint32_t kind) const;
  std::string name(uint32_t kind, uint32_t index) const;
  MienMesh mesh(uint32_t index) const;
  MienDnaInfo info() const;

  /// From the axes and units of the file to meters, x left, y up, z front.
  Vec3 point(const float* xyz) const;
  /// Without the unit.
  Vec3 direction(const float* xyz) const;
  /// Ten floats, as mien_deformer_instance_local_transforms() gives them.
  Transform transform(const float* values) const;
  double metres_per_unit() const { return metres_; }

  /// Whether triangles have to be turned round to be counter-clockwise from outside. The normals
  /// tell, where there are some; what files say of their winding is not always so.
  bool has_inward_triangles(const MienMesh& mesh) const;

 private:
  RigHandles handles_;
  Vec3 axes_[3];  // where x, y and z of the file point
  double handedness_ = 1, metres_ = 1;
};

}  // namespace mien::gltf
