// SPDX-License-Identifier: MIT
// A rig with geometry, as the exporter reads it: the handles, the colors of its meshes, and the
// conversion from the axes and units of its file to those of glTF.
#pragma once

#include "integrations/program/gltf/scene.h"
#include "integrations/program/io/handles.h"
#include "integrations/program/io/mesh_appearance.h"

namespace mien::gltf {

using cli::sized;

/// Not owned. All of the same file, opened with the LODs that are to be exported.
struct RigHandles {
  const MienDna* dna = nullptr;
  const MienRig* rig = nullptr;
  const MienDeformer* deformer = nullptr;
};

/// Throws ExportError unless `status` is MIEN_OK.
void check(MienStatus status, const char* what);

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

  /// sRGB colors of a mesh, r g b for each position, or empty.
  const std::vector<uint8_t>& colors(uint32_t mesh) const { return colors_[mesh].rgb; }
  /// Why colors of the file were not used, mesh by mesh.
  std::vector<std::string> color_problems() const;

  /// From the axes and units of the file to meters, x left, y up, z front.
  math::Vec3d point(const float* xyz) const;
  /// The same without the unit.
  math::Vec3d direction(const float* xyz) const;
  /// Ten floats, as mien_deformer_instance_local_transforms() gives them.
  math::Transform transform(const float* values) const;
  double meters_per_unit() const { return meters_; }

  /// Whether the triangles face inwards, so that their order has to be reversed for glTF. The
  /// normals tell, where there are any: what files say about their winding is not always true.
  bool has_inward_triangles(const MienMesh& mesh) const;

 private:
  RigHandles handles_;
  math::Vec3d axes_[3];  // where x, y and z of the file point
  double handedness_ = 1, meters_ = 1;
  std::vector<cli::VertexColors> colors_;
};

}  // namespace mien::gltf
