// SPDX-License-Identifier: MIT
#include "integrations/program/commands/solve_residuals.h"

#include <algorithm>
#include <cmath>

#include "integrations/program/commands/solve_compare.h"

namespace mien::cli {

namespace {

constexpr const char* kWhatResidual = "cannot compare";

}  // namespace

ResidualTable::ResidualTable(const SolvedRig& rig, const SolveTarget& target)
    : rig_(rig), target_(target) {
  if (target.points.empty()) {
    auto error = sized<MienError>();
    MienInstance* instance = nullptr;
    check(mien_instance_create(rig.rig, nullptr, &instance, &error), &error, kWhatResidual,
          rig.shown);
    instance_.reset(instance);
    name_joints();
  } else {
    mesh_.emplace(rig, main_mesh(target));
    names_ = target.point_names;
    for (uint32_t i = 0; i < names_.size(); ++i) datum_.push_back(i);
    if (names_.empty()) name_regions();
  }
  if (target.kind == TargetKind::kSurface) {
    const MienMesh mesh = mesh_of(rig, target.points[0].mesh);
    for (size_t i = 0; i < mesh.triangles.count; ++i) {
      solved_.triangles.push_back(mesh.vertex_position_indices.data[mesh.triangles.data[i]]);
    }
    math::Box box;
    const std::vector<float> rest = mesh_->rest();
    for (size_t p = 0; p < rest.size() / 3; ++p) box.add(math::load3(rest.data(), p));
    far_ = kFarShare * length(box.size());
  }
  sums_.resize(names_.size());
}

void ResidualTable::name_joints() {
  for (uint32_t j = 0; j < rig_count(rig_.rig, MIEN_KIND_JOINT); ++j) {
    names_.push_back(rig_name(rig_.rig, MIEN_KIND_JOINT, j));
  }
  for (uint32_t i = 0; i < target_.width; ++i) datum_.push_back(i / joint_width(rig_));
}

/// A vertex is of the region of the joint that holds it most.
void ResidualTable::name_regions() {
  name_joints();
  datum_.clear();
  for (const MienSolvePoint& point : target_.points) {
    MienIndex16View held{};
    MienFloatView shares{};
    check(mien_deformer_influences(rig_.deformer, point.mesh, point.positions[0], &held, &shares),
          nullptr, kWhatResidual, rig_.shown);
    size_t most = 0;
    for (size_t i = 1; i < held.count; ++i) {
      if (shares.data[i] > shares.data[most]) most = i;
    }
    datum_.push_back(held.count != 0 ? held.data[most] : static_cast<uint32_t>(names_.size()));
  }
  names_.emplace_back("vertices that no joint holds");
}

void ResidualTable::add_one(size_t i, double distance, size_t frame) {
  if (!std::isfinite(distance)) return;
  if (!target_.weights.empty() && !(target_.weights[i] > 0)) return;
  Sum& sum = sums_[datum_[i]];
  sum.squares += distance * distance;
  ++sum.count;
  if (!(distance > sum.worst)) return;
  sum.worst = distance;
  sum.worst_frame = frame;
}

void ResidualTable::add_joints(const SolvedTake& take, const float* row) {
  const size_t f = take.frames.size() - 1;
  MienInstance* const instance = instance_.get();
  check(mien_instance_reset(instance), nullptr, kWhatResidual, rig_.shown);
  apply_frame(take.pose(f), rig_.rig, instance);
  check(mien_rig_evaluate(rig_.rig, instance, 0), nullptr, kWhatResidual, rig_.shown);
  MienFloatView joints{};
  check(mien_instance_joints(instance, &joints), nullptr, kWhatResidual, rig_.shown);
  for (size_t i = 0; i < joints.count; ++i) {
    add_one(i, std::fabs(double{joints.data[i]} - double{row[i]}), f);
  }
}

void ResidualTable::add_surface(const SolvedTake& take, const SurfaceMesh& surface) {
  const size_t f = take.frames.size() - 1;
  SurfaceMesh placed = surface;
  for (size_t p = 0; p < placed.positions.size() / 3; ++p) {
    const math::Vec3 at = place_target(take.frames[f], math::load3(surface.positions.data(), p));
    for (int k = 0; k < 3; ++k) placed.positions[3 * p + static_cast<size_t>(k)] = at[k];
  }
  const std::vector<float> distances =
      find_surface_distances(solved_, placed, take.reach > 0 ? std::min(take.reach, far_) : far_);
  for (size_t p = 0; p < distances.size(); ++p) add_one(p, double{distances[p]}, f);
}

void ResidualTable::add(const SolvedTake& take, const float* row, const SurfaceMesh& surface) {
  const size_t f = take.frames.size() - 1;
  if (take.frames[f].status == MIEN_FIT_NO_DATA) return;
  if (!mesh_) return add_joints(take, row);
  const float* const positions = mesh_->positions(take.pose(f));
  if (target_.kind == TargetKind::kSurface) {
    solved_.positions.assign(positions, positions + 3 * target_.points.size());
    return add_surface(take, surface);
  }
  for (const SolvedMark& mark : compare_landmarks(
           take, target_, f, row, [&](uint32_t mesh) { return mesh_->positions_of(mesh); })) {
    add_one(mark.point, double{mark.distance}, f);
  }
}

std::vector<SolvedDatum> ResidualTable::list() const {
  std::vector<SolvedDatum> data;
  for (size_t i = 0; i < sums_.size(); ++i) {
    const Sum& sum = sums_[i];
    if (sum.count == 0) continue;
    data.push_back({names_[i], std::sqrt(sum.squares / static_cast<double>(sum.count)), sum.worst,
                    sum.worst_frame});
  }
  std::stable_sort(data.begin(), data.end(),
                   [](const SolvedDatum& a, const SolvedDatum& b) { return a.worst > b.worst; });
  return data;
}

}  // namespace mien::cli
