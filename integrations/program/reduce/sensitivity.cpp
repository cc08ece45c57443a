// SPDX-License-Identifier: MIT
#include "integrations/program/reduce/sensitivity.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "integrations/program/reduce/proof.h"

namespace mien::cli {

std::vector<JointReach> joint_reaches(const Character& character, const Tolerances& tolerances) {
  MienIndex16View parents{};
  check(mien_rig_joint_parents(character.rig.get(), &parents), nullptr, "cannot reduce", "");
  MienFloatView binds{};
  check(mien_deformer_bind_matrices(character.deformer.get(), &binds), nullptr, "cannot reduce",
        "");
  std::vector<JointReach> reaches(parents.count);
  std::vector<double> carried(parents.count);  // weights of a joint and its descendants
  std::vector<size_t> carriers;
  const uint32_t mesh_count = rig_count(character.rig.get(), MIEN_KIND_MESH);
  for (uint32_t m = 0; m < mesh_count; ++m) {
    const MienMesh mesh = character.mesh(m);
    for (uint32_t p = 0; p < mesh.position_count; ++p) {
      const double tolerance = tolerances.of_position(mesh.lods, m, p);
      MienIndex16View joints{};
      MienFloatView weights{};
      character.influences(m, p, joints, weights);
      for (size_t i = 0; i < joints.count; ++i) {
        for (size_t joint = joints.data[i];; joint = parents.data[joint]) {
          if (carried[joint] == 0) carriers.push_back(joint);
          carried[joint] += double{weights.data[i]};
          if (parents.data[joint] == joint) break;
        }
      }
      for (const size_t joint : carriers) {
        double square = 0;
        for (size_t k = 0; k < 3; ++k) {
          const double along = double{mesh.positions.data[3 * size_t{p} + k]} -
                               double{binds.data[16 * joint + 12 + k]};
          square += along * along;
        }
        const double share = std::abs(carried[joint]) / tolerance;
        reaches[joint].shift = std::max(reaches[joint].shift, share);
        reaches[joint].turn = std::max(reaches[joint].turn, share * std::sqrt(square));
        carried[joint] = 0;
      }
      carriers.clear();
    }
  }
  // Other meshes may hang on joints that move no position here.
  for (JointReach& reach : reaches) {
    if (reach.shift == 0) reach = {INFINITY, INFINITY};
  }
  return reaches;
}

namespace {

using Point = std::array<float, 3>;

/// For each joint the nearest one, from itself up, that no control moves, or the root.
std::vector<uint16_t> find_carriers(const MienRig* rig) {
  MienIndex16View parents{}, values{};
  check(mien_rig_joint_parents(rig, &parents), nullptr, "cannot reduce", "");
  check(mien_rig_variable_joint_values(rig, 0, &values), nullptr, "cannot reduce", "");
  const size_t per_joint = parents.count ? rig_info(rig).joint_value_count / parents.count : 1;
  std::vector<bool> moves(parents.count);
  for (size_t i = 0; i < values.count; ++i) moves[values.data[i] / per_joint] = true;
  std::vector<uint16_t> carriers(parents.count);
  for (size_t j = 0; j < carriers.size(); ++j) {
    size_t up = j;
    while (moves[up] && parents.data[up] != up) up = parents.data[up];
    carriers[j] = static_cast<uint16_t>(up);
  }
  return carriers;
}

Point transformed(const float* matrix, const float* p) {
  Point out{};
  for (size_t k = 0; k < 3; ++k) {
    out[k] = matrix[k] * p[0] + matrix[4 + k] * p[1] + matrix[8 + k] * p[2] + matrix[12 + k];
  }
  return out;
}

bool is_identity(const float* matrix) {
  for (size_t i = 0; i < 16; ++i) {
    if (std::abs(matrix[i] - (i % 5 == 0 ? 1.0f : 0.0f)) > 1e-6f) return false;
  }
  return true;
}

/// The influences of a mesh in one list.
struct MeshInfluences {
  MienMesh mesh;
  std::vector<float> tolerances;  // [position]
  std::vector<size_t> first;      // [position], one more at the end
  std::vector<uint16_t> joints;
  std::vector<float> weights;
};

void raise_importance(const MeshInfluences& of, const float* matrices,
                      const std::vector<bool>& rests, std::vector<float>& importance) {
  for (uint32_t p = 0; p < of.mesh.position_count; ++p) {
    const size_t first = of.first[p], end = of.first[p + 1];
    bool rest = true;
    for (size_t i = first; i < end; ++i) rest = rest && rests[of.joints[i]];
    if (rest || end - first < 2) continue;
    const float* const position = of.mesh.positions.data + 3 * size_t{p};
    Point blended{};
    float sum = 0;
    for (size_t i = first; i < end; ++i) {
      const Point alone = transformed(matrices + 16 * size_t{of.joints[i]}, position);
      for (size_t k = 0; k < 3; ++k) blended[k] += of.weights[i] * alone[k];
      sum += of.weights[i];
    }
    for (float& part : blended) part /= sum;
    for (size_t i = first; i < end; ++i) {
      const Point alone = transformed(matrices + 16 * size_t{of.joints[i]}, position);
      float square = 0;
      for (size_t k = 0; k < 3; ++k) {
        square += (alone[k] - blended[k]) * (alone[k] - blended[k]);
      }
      const float left = std::max(sum - of.weights[i], 1e-6f);
      const float off = of.weights[i] / left * std::sqrt(square) / of.tolerances[p];
      importance[i] = std::max(importance[i], off);
    }
  }
}

}  // namespace

std::vector<std::vector<float>> influence_importance(Character& character,
                                                     const Tolerances& tolerances) {
  const uint32_t mesh_count = rig_count(character.rig.get(), MIEN_KIND_MESH);
  std::vector<MeshInfluences> meshes(mesh_count);
  std::vector<std::vector<float>> importance(mesh_count);
  const std::vector<uint16_t> carriers = find_carriers(character.rig.get());
  for (uint32_t m = 0; m < mesh_count; ++m) {
    MeshInfluences& of = meshes[m];
    of.mesh = character.mesh(m);
    for (uint32_t p = 0; p < of.mesh.position_count; ++p) {
      of.tolerances.push_back(static_cast<float>(tolerances.of_position(of.mesh.lods, m, p)));
      MienIndex16View joints{};
      MienFloatView weights{};
      character.influences(m, p, joints, weights);
      of.first.push_back(of.joints.size());
      of.joints.insert(of.joints.end(), joints.data, joints.data + joints.count);
      of.weights.insert(of.weights.end(), weights.data, weights.data + weights.count);
      const bool together =
          std::all_of(joints.data, joints.data + joints.count,
                      [&](uint16_t joint) { return carriers[joint] == carriers[joints.data[0]]; });
      importance[m].resize(of.joints.size(), together ? 0.0f : INFINITY);
    }
    of.first.push_back(of.joints.size());
  }
  const std::vector<ProofTake> none;
  const ProofPoses poses(character.rig.get(), none);
  for (size_t pose = 0; pose < poses.single_count(); ++pose) {
    poses.set(pose, character.raw());
    character.evaluate(0);
    MienFloatView matrices{};
    check(mien_deformer_instance_skin_matrices(character.pose.get(), &matrices), nullptr,
          "cannot reduce", "");
    std::vector<bool> rests(matrices.count / 16);
    for (size_t j = 0; j < rests.size(); ++j) rests[j] = is_identity(matrices.data + 16 * j);
    for (uint32_t m = 0; m < mesh_count; ++m) {
      raise_importance(meshes[m], matrices.data, rests, importance[m]);
    }
  }
  return importance;
}

}  // namespace mien::cli
