// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/rig_source.h"

#include <cmath>

namespace mien::gltf {

using math::Transform;
using math::Vec3d;

namespace {

// By MIEN_DIRECTION_...: left, right, up, down, front, back of the character.
constexpr Vec3d kDirections[] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                 {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};

}  // namespace

void check(MienStatus status, const char* what) {
  if (status == MIEN_OK) return;
  throw ExportError(status, "", std::string(what) + ": status " + mien_status_name(status), "");
}

RigSource::RigSource(const RigHandles& handles) : handles_(handles) {
  const MienDnaInfo info = this->info();
  for (int i = 0; i < 3; ++i) axes_[i] = kDirections[info.axes[i]];
  handedness_ = dot(axes_[0], cross(axes_[1], axes_[2]));
  if (handedness_ == 0) {
    throw ExportError(MIEN_ERROR_DNA_VALUE, "desc.coordinateSystem",
                      "two axes have the same direction", "correct the file");
  }
  for (uint32_t m = 0; m < count(MIEN_KIND_MESH); ++m) {
    colors_.push_back(
        cli::read_vertex_colors(dna(), name(MIEN_KIND_MESH, m), mesh(m).position_count));
  }
  meters_ = info.translation_unit == MIEN_TRANSLATION_UNIT_METERS ? 1 : 0.01;
}

uint32_t RigSource::count(uint32_t kind) const {
  uint32_t count = 0;
  check(mien_rig_count(rig(), kind, &count), "cannot read rig");
  return count;
}

std::string RigSource::name(uint32_t kind, uint32_t index) const {
  MienStringView view{};
  check(mien_rig_name(rig(), kind, index, &view), "cannot read rig");
  return std::string(view.data, view.count);
}

MienMesh RigSource::mesh(uint32_t index) const {
  auto mesh = sized<MienMesh>();
  check(mien_deformer_mesh(deformer(), index, &mesh), "cannot read mesh");
  return mesh;
}

MienDnaInfo RigSource::info() const {
  auto info = sized<MienDnaInfo>();
  check(mien_dna_info(dna(), &info), "cannot read rig");
  return info;
}

std::vector<std::string> RigSource::color_problems() const {
  std::vector<std::string> problems;
  for (const cli::VertexColors& colors : colors_) {
    if (!colors.problem.empty()) problems.push_back(colors.problem);
  }
  return problems;
}

Vec3d RigSource::direction(const float* xyz) const {
  return axes_[0] * xyz[0] + axes_[1] * xyz[1] + axes_[2] * xyz[2];
}

Vec3d RigSource::point(const float* xyz) const { return direction(xyz) * meters_; }

Transform RigSource::transform(const float* values) const {
  Transform result;
  result.translation = point(values);
  // The axis of a rotation reverses when the handedness changes.
  const Vec3d axis = direction(values + 3) * handedness_;
  result.rotation = normalized(math::Quaternion{axis.x, axis.y, axis.z, values[6]});
  const Vec3d scale = direction(values + 7);
  for (int i = 0; i < 3; ++i) {
    // Scale has no sign: it follows its axis, wherever that points.
    const double sign = axes_[0][i] + axes_[1][i] + axes_[2][i];
    result.scale[i] = scale[i] * sign;
  }
  return result;
}

bool RigSource::has_inward_triangles(const MienMesh& mesh) const {
  double outward = 0;
  const auto position = [&](uint32_t vertex) {
    return point(mesh.positions.data + size_t{3} * mesh.vertex_position_indices.data[vertex]);
  };
  for (size_t t = 0; t < mesh.triangle_count; ++t) {
    const uint32_t* corner = mesh.triangles.data + 3 * t;
    const Vec3d a = position(corner[0]);
    const Vec3d area = cross(position(corner[1]) - a, position(corner[2]) - a);
    for (int k = 0; k < 3; ++k) {
      outward += dot(area, direction(mesh.normals.data + size_t{3} * corner[k]));
    }
  }
  return outward < 0;
}

}  // namespace mien::gltf
