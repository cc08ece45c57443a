// SPDX-License-Identifier: MIT
#include "integrations/program/reduce/proof.h"

#include <algorithm>
#include <cmath>

namespace mien::cli {

ProofPoses::ProofPoses(const MienRig* rig, const std::vector<ProofTake>& performances)
    : rig_(rig), performances_(performances), raw_count_(rig_count(rig, MIEN_KIND_RAW_CONTROL)),
      psd_count_(rig_count(rig, MIEN_KIND_PSD_CONTROL)) {
  MienFloatView initial{};
  check(mien_rig_initial_raw_controls(rig, &initial), nullptr, "cannot reduce", "");
  initial_.assign(initial.data, initial.data + initial.count);
  for (const ProofTake& performance : performances) frame_count_ += performance.frames.size();
}

const ProofTake* ProofPoses::performance_of(size_t& pose) const {
  if (pose < single_count() + kSparse) return nullptr;
  pose -= single_count() + kSparse;
  const ProofTake* performance = performances_.data();
  for (; pose >= performance->frames.size(); ++performance) pose -= performance->frames.size();
  return performance;
}

void ProofPoses::set(size_t pose, MienMutableFloatView raw) const {
  if (const ProofTake* performance = performance_of(pose)) {
    const std::vector<float>& frame = performance->frames[pose];
    std::copy(frame.begin(), frame.end(), raw.data);
    return;
  }
  std::copy(initial_.begin(), initial_.end(), raw.data);
  if (pose < raw_count_) {
    raw.data[pose] = 1;
  } else if (pose < single_count()) {
    MienIndex16View inputs{};
    check(mien_rig_psd_inputs(rig_, static_cast<uint32_t>(pose - raw_count_), &inputs), nullptr,
          "cannot reduce", "");
    for (size_t i = 0; i < inputs.count; ++i) {
      if (inputs.data[i] < raw_count_) raw.data[inputs.data[i]] = 1;
    }
  } else if (raw_count_ != 0) {
    std::mt19937 random(static_cast<uint32_t>(pose - single_count()));
    const auto unit = [&random] { return static_cast<float>(random() >> 8) / 16777216.0f; };
    const float activity = 0.02f + 0.08f * unit();
    const auto active = std::max<size_t>(static_cast<size_t>(activity * float(raw_count_)), 1);
    for (size_t i = 0; i < active; ++i) {
      const size_t control = random() % raw_count_;
      raw.data[control] = unit();
    }
  }
}

std::string ProofPoses::describe(size_t pose) const {
  if (const ProofTake* performance = performance_of(pose)) {
    return "frame " + std::to_string(pose) + " of " + performance->shown;
  }
  if (pose < raw_count_) {
    return rig_name(rig_, MIEN_KIND_RAW_CONTROL, static_cast<uint32_t>(pose)) + " at 1";
  }
  if (pose < single_count()) {
    return "the inputs of corrective " +
           rig_name(rig_, MIEN_KIND_PSD_CONTROL, static_cast<uint32_t>(pose - raw_count_)) +
           " at 1";
  }
  std::vector<float> values(raw_count_);
  set(pose, {values.data(), values.size()});
  std::string text;
  for (uint32_t c = 0; c < raw_count_; ++c) {
    if (values[c] == initial_[c]) continue;
    char value[32];
    std::snprintf(value, sizeof(value), " %.3f", double{values[c]});
    text += (text.empty() ? "" : ", ") + rig_name(rig_, MIEN_KIND_RAW_CONTROL, c) + value;
  }
  return "sample " + std::to_string(pose - single_count()) + ": " + text;
}

namespace {
struct Farthest {
  double square = 0;
  uint32_t mesh = 0, position = 0;
};

/// Raises each of `largest` to the square of the distance of its position.
void add_distances(const MienFloatView& before, const MienFloatView& after,
                   std::vector<float>& largest) {
  largest.resize(before.count / 3);
  for (size_t p = 0; p < largest.size(); ++p) {
    float square = 0;
    for (size_t i = 3 * p; i < 3 * p + 3; ++i) {
      square += (after.data[i] - before.data[i]) * (after.data[i] - before.data[i]);
    }
    largest[p] = std::max(largest[p], square);
  }
}

/// Squares of distances -> distances, and those of the worst pose of LOD 0.
void finish_map(Character& original, Character& reduced, const ProofPoses& poses, size_t worst,
                ProofMap& map) {
  for (Character* character : {&original, &reduced}) {
    poses.set(worst, character->raw());
    character->evaluate(0);
  }
  const MienMutableFloatView raw = original.raw();
  map.raw.assign(raw.data, raw.data + raw.count);
  map.in_worst_pose.resize(map.largest.size());
  const MienIndex16View meshes = original.meshes_of(0);
  for (size_t m = 0; m < meshes.count; ++m) {
    const uint32_t mesh = meshes.data[m];
    add_distances(original.deformed(mesh), reduced.deformed(mesh), map.in_worst_pose[mesh]);
  }
  for (auto* distances : {&map.in_worst_pose, &map.largest}) {
    for (std::vector<float>& of_mesh : *distances) {
      for (float& distance : of_mesh) distance = std::sqrt(distance);
    }
  }
}
}  // namespace

Proof prove(Character& original, Character& reduced, const Tolerances& tolerances, double limit,
            const std::vector<ProofTake>& performances) {
  const ProofPoses poses(original.rig.get(), performances);
  const uint32_t lod_count = rig_info(original.rig.get()).lod_count;
  Proof proof;
  proof.pose_count = poses.count();
  proof.lods.resize(lod_count);
  proof.regions.resize(tolerances.regions.size() + 1);
  proof.map.largest.resize(rig_count(original.rig.get(), MIEN_KIND_MESH));
  std::vector<double> squares(lod_count);
  std::vector<uint64_t> compared(lod_count);
  size_t worst = 0;
  for (size_t pose = 0; pose < poses.count() && proof.share <= limit; ++pose) {
    poses.set(pose, original.raw());
    poses.set(pose, reduced.raw());
    for (uint32_t lod = 0; lod < lod_count; ++lod) {
      LodProof& of_lod = proof.lods[lod];
      original.evaluate(lod);
      reduced.evaluate(lod);
      // Of each region, in this pose.
      std::vector<Farthest> farthest(proof.regions.size());
      const MienIndex16View meshes = original.meshes_of(lod);
      for (size_t m = 0; m < meshes.count; ++m) {
        const MienFloatView before = original.deformed(meshes.data[m]);
        const MienFloatView after = reduced.deformed(meshes.data[m]);
        double sum = 0;
        for (size_t i = 0; i < before.count; i += 3) {
          double square = 0;
          for (size_t k = 0; k < 3; ++k) {
            const double off = double{after.data[i + k]} - double{before.data[i + k]};
            square += off * off;
          }
          sum += square;
          const auto position = static_cast<uint32_t>(i / 3);
          Farthest& of_region = farthest[tolerances.region_at(meshes.data[m], position)];
          if (square > of_region.square) of_region = {square, meshes.data[m], position};
        }
        if (lod == 0) add_distances(before, after, proof.map.largest[meshes.data[m]]);
        squares[lod] += sum;
        compared[lod] += before.count / 3;
      }
      for (size_t r = 0; r < farthest.size(); ++r) {
        const double distance = std::sqrt(farthest[r].square);
        const double share = distance / tolerances.at(lod, r);
        if (distance > of_lod.worst) {
          of_lod.worst = distance;
          of_lod.pose = pose;
          of_lod.mesh = farthest[r].mesh;
          of_lod.position = farthest[r].position;
        }
        if (share > proof.regions[r].share) {
          proof.regions[r] = {distance, share, pose, lod, farthest[r].mesh, farthest[r].position,
                              ""};
        }
        // Not a number is too far, too.
        if (!(share <= proof.share) || !std::isfinite(squares[lod])) {
          proof.share = std::isfinite(squares[lod]) ? share : INFINITY;
          worst = pose;
        }
      }
    }
  }
  for (RegionProof& region : proof.regions) region.shown_pose = poses.describe(region.pose);
  for (uint32_t lod = 0; lod < lod_count; ++lod) {
    if (compared[lod]) proof.lods[lod].rms = std::sqrt(squares[lod] / double(compared[lod]));
  }
  proof.worst_pose = poses.describe(worst);
  if (lod_count != 0) finish_map(original, reduced, poses, proof.lods[0].pose, proof.map);
  return proof;
}

}  // namespace mien::cli
