// SPDX-License-Identifier: MIT
#include "integrations/program/accept/check_deform.h"

#include <algorithm>
#include <cmath>

namespace mien::cli {

namespace {

using math::Matrix;
using math::Vec3d;

constexpr char kCannotDeform[] = "cannot check geometry";
constexpr double kAllowed = 1e-5;  // of the diagonal of the mesh
constexpr size_t kDeformPoses = 5;

Vec3d at(const float* xyz) { return {xyz[0], xyz[1], xyz[2]}; }

Vec3d times(const Matrix& m, const Vec3d& v) {
  return {m.m[0][0] * v.x + m.m[0][1] * v.y + m.m[0][2] * v.z + m.m[0][3],
          m.m[1][0] * v.x + m.m[1][1] * v.y + m.m[1][2] * v.z + m.m[1][3],
          m.m[2][0] * v.x + m.m[2][1] * v.y + m.m[2][2] * v.z + m.m[2][3]};
}

/// A mesh with its targets and weights.
struct Model {
  MienMesh mesh;
  std::vector<std::vector<float>> targets;
  double diagonal = 0;
};

Model model_of(const MienDeformer* deformer, uint32_t number) {
  Model model{sized<MienMesh>(), {}, 0};
  check(mien_deformer_mesh(deformer, number, &model.mesh), nullptr, kCannotDeform, "");
  math::Boxd box;
  for (size_t p = 0; p < model.mesh.position_count; ++p) {
    box.add(at(model.mesh.positions.data + 3 * p));
  }
  model.diagonal = box.empty() ? 0 : length(box.size());
  for (uint32_t t = 0; t < model.mesh.target_count; ++t) {
    model.targets.emplace_back(size_t{3} * model.mesh.position_count);
    check(
        mien_deformer_target(deformer, number, t, model.targets[t].data(), model.targets[t].size()),
        nullptr, kCannotDeform, "");
  }
  return model;
}

/// Targets, then weighted sums of skin matrices.
double largest_distance(const MienDeformer* deformer, uint32_t number, const Model& model,
                        const std::vector<float>& channels, const std::vector<Matrix>& skin,
                        const MienFloatView& positions) {
  double most = 0;
  for (uint32_t p = 0; p < model.mesh.position_count; ++p) {
    Vec3d point = at(model.mesh.positions.data + size_t{3} * p);
    for (size_t t = 0; t < model.targets.size(); ++t) {
      const float weight = channels[model.mesh.target_channels.data[t]];
      if (std::fabs(weight) < 1e-5f) continue;
      point += at(model.targets[t].data() + size_t{3} * p) * double{weight};
    }
    MienIndex16View joints{};
    MienFloatView weights{};
    check(mien_deformer_influences(deformer, number, p, &joints, &weights), nullptr, kCannotDeform,
          "");
    Vec3d sum = joints.count == 0 ? point : Vec3d{};
    for (size_t i = 0; i < joints.count; ++i) {
      sum += times(skin[joints.data[i]], point) * double{weights.data[i]};
    }
    const double off = length(sum - at(positions.data + size_t{3} * p));
    most = off >= 0 ? std::max(most, off) : HUGE_VAL;
  }
  return most;
}

}  // namespace

std::vector<Matrix> joint_matrices(const MienRig* rig, const MienDeformerInstance* pose) {
  MienIndex16View parents{};
  check(mien_rig_joint_parents(rig, &parents), nullptr, kCannotDeform, "");
  std::vector<float> values(10 * parents.count);
  check(mien_deformer_instance_local_transforms(pose, values.data(), values.size()), nullptr,
        kCannotDeform, "");
  std::vector<Matrix> matrices(parents.count);
  std::vector<bool> known(parents.count);
  std::vector<size_t> path;
  for (size_t joint = 0; joint < parents.count; ++joint) {
    // Parents may follow their children.
    for (size_t j = joint; !known[j]; j = parents.data[j]) {
      path.push_back(j);
      known[j] = true;
    }
    for (; !path.empty(); path.pop_back()) {
      const size_t j = path.back();
      const float* v = values.data() + 10 * j;
      const Matrix local = math::matrix_of({at(v), {v[3], v[4], v[5], v[6]}, at(v + 7)});
      matrices[j] = parents.data[j] == j ? local : matrices[parents.data[j]] * local;
    }
  }
  return matrices;
}

Check check_deform(const AcceptedRig& rig, const Session& session) {
  if (!has_geometry(rig.file)) return skipped_check("deform", "the file has no geometry");
  auto error = sized<MienError>();
  MienDeformer* made = nullptr;
  check(mien_deformer_create(rig.file.dna.get(), rig.rig.get(), nullptr, &made, &error), &error,
        kCannotDeform, rig.file.shown);
  const Deformer deformer(made);
  MienDeformerInstance* instance = nullptr;
  check(mien_deformer_instance_create(made, nullptr, &instance, &error), &error, kCannotDeform,
        rig.file.shown);
  const DeformerInstance pose(instance);
  std::vector<Matrix> inverse_binds;
  for (const Matrix& bind : joint_matrices(rig.rig.get(), instance)) {
    inverse_binds.push_back(inverse(bind));
  }
  const uint32_t meshes = rig_count(rig.rig.get(), MIEN_KIND_MESH);
  Check result{"deform", true, false, ""};
  double worst = 0;
  std::string where;
  Progress progress(session, "deforming", meshes);
  for (uint32_t m = 0; m < meshes; ++m) {
    progress.at(m);
    const Model model = model_of(made, m);
    for (uint32_t lod = 0; lod < rig.lod_count(); ++lod) {
      if (!(model.mesh.lods >> lod & 1)) continue;
      for (size_t p = 0; p < std::min(kDeformPoses, rig.poses.size()); ++p) {
        const Results results = evaluate_fresh(rig.rig.get(), rig.poses[p], lod);
        check(mien_deformer_instance_update_from_values(
                  instance, results.joints.data(), results.joints.size(), results.channels.data(),
                  results.channels.size()),
              nullptr, kCannotDeform, "");
        std::vector<Matrix> skin = joint_matrices(rig.rig.get(), instance);
        for (size_t j = 0; j < skin.size(); ++j) skin[j] = skin[j] * inverse_binds[j];
        check(mien_deformer_instance_deform(instance, m, MIEN_NORMALS_RECOMPUTED, nullptr), nullptr,
              kCannotDeform, "");
        MienFloatView positions{};
        check(mien_deformer_instance_positions(instance, m, &positions), nullptr, kCannotDeform,
              "");
        const double off = largest_distance(made, m, model, results.channels, skin, positions) /
                           std::max(model.diagonal, 1e-30);
        if (off <= worst) continue;
        worst = off;
        where = "mesh " + std::to_string(m) + " at LOD " + std::to_string(lod) + " in pose " +
                std::to_string(p);
      }
    }
  }
  result.passed = worst <= kAllowed;
  result.detail = std::to_string(meshes) + " meshes in " +
                  std::to_string(std::min(kDeformPoses, rig.poses.size())) +
                  " poses against skinning in double precision: off by " + short_number(worst) +
                  " of the diagonal at most";
  if (!result.passed) result.detail += ", " + where;
  return result;
}

}  // namespace mien::cli
