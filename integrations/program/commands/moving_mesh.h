// SPDX-License-Identifier: MIT
// A mesh of a rig for `mien solve`: the axes it is in, and its positions in poses.
#pragma once

#include <memory>
#include <vector>

#include "integrations/program/commands/solve_target.h"
#include "integrations/program/io/controls.h"
#include "integrations/program/math/vector.h"

namespace mien::cli {

/// By MIEN_DIRECTION_...: x to the left, y up, z to the front.
constexpr math::Vec3d kAxisDirections[] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                           {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};

/// The unit and axes of a rig.
struct RigSpace {
  MienRigInfo info;

  explicit RigSpace(const SolvedRig& rig) : info(rig_info(rig.rig)) {}

  /// From meters, x to the left, y up and z to the front.
  math::Vec3d from_gltf(math::Vec3d p) const {
    const double units = info.translation_unit == MIEN_TRANSLATION_UNIT_METERS ? 1 : 100;
    return math::Vec3d{dot(p, kAxisDirections[info.axes[0]]), dot(p, kAxisDirections[info.axes[1]]),
                       dot(p, kAxisDirections[info.axes[2]])} *
           units;
  }
  /// In units of the rig; 1 if `unit`, a word of --unit, is empty.
  double units_of(const std::string& unit) const {
    if (unit.empty()) return 1;
    return parse_unit(unit) / (info.translation_unit == MIEN_TRANSLATION_UNIT_METERS ? 100 : 1);
  }
  /// The other way, in centimeters.
  math::Vec3d to_centimeters(const float* p) const {
    math::Vec3d out;
    for (int k = 0; k < 3; ++k) out += kAxisDirections[info.axes[k]] * static_cast<double>(p[k]);
    return out * (info.translation_unit == MIEN_TRANSLATION_UNIT_METERS ? 100 : 1);
  }
};

/// A rig in motion: positions of one of its meshes.
class MovingMesh {
 public:
  MovingMesh(const SolvedRig& rig, uint32_t mesh)
      : rig_(rig), mesh_(mesh), count_(mesh_of(rig, mesh).position_count) {
    auto error = sized<MienError>();
    MienInstance* instance = nullptr;
    check(mien_instance_create(rig.rig, nullptr, &instance, &error), &error, "cannot evaluate",
          rig.shown);
    instance_.reset(instance);
    MienDeformerInstance* pose = nullptr;
    check(mien_deformer_instance_create(rig.deformer, nullptr, &pose, &error), &error,
          "cannot deform", rig.shown);
    pose_.reset(pose);
  }

  const float* positions(const Frame& frame) {
    const char* what = "cannot evaluate";
    MienInstance* instance = instance_.get();
    check(mien_instance_reset(instance), nullptr, what, rig_.shown);
    apply_frame(frame, rig_.rig, instance);
    check(mien_rig_evaluate(rig_.rig, instance, 0), nullptr, what, rig_.shown);
    check(mien_deformer_instance_update(pose_.get(), instance), nullptr, what, rig_.shown);
    return positions_of(mesh_);
  }
  /// Another mesh, in the same pose.
  const float* positions_of(uint32_t mesh) {
    const char* what = "cannot deform";
    check(mien_deformer_instance_deform(pose_.get(), mesh, MIEN_NORMALS_NONE, nullptr), nullptr,
          what, rig_.shown);
    MienFloatView view{};
    check(mien_deformer_instance_positions(pose_.get(), mesh, &view), nullptr, what, rig_.shown);
    return view.data;
  }
  std::vector<float> rest() {
    const float* all = positions({});
    return {all, all + size_t{3} * count_};
  }

 private:
  const SolvedRig& rig_;
  uint32_t mesh_, count_;
  Instance instance_;
  DeformerInstance pose_;
};

}  // namespace mien::cli
