// SPDX-License-Identifier: MIT
#include "integrations/program/reduce/proof.h"

#include <algorithm>
#include <cmath>

namespace mien::cli {

ProofPoses::ProofPoses(const MienRig* rig)
    : rig_(rig), raw_count_(rig_count(rig, MIEN_KIND_RAW_CONTROL)),
      psd_count_(rig_count(rig, MIEN_KIND_PSD_CONTROL)) {
  MienFloatView initial{};
  check(mien_rig_initial_raw_controls(rig, &initial), nullptr, "cannot reduce", "");
  initial_.assign(initial.data, initial.data + initial.count);
}

void ProofPoses::set(size_t pose, MienMutableFloatView raw) const {
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

double tolerance_at(const std::vector<double>& tolerances, uint32_t lod) {
  return tolerances[std::min<size_t>(lod, tolerances.size() - 1)];
}

Proof prove(Character& original, Character& reduced, const std::vector<double>& tolerances,
            double limit) {
  const ProofPoses poses(original.rig.get());
  const uint32_t lod_count = rig_info(original.rig.get()).lod_count;
  Proof proof;
  proof.pose_count = poses.count();
  proof.lods.resize(lod_count);
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
      double farthest = of_lod.worst * of_lod.worst;
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
          if (square <= farthest) continue;
          farthest = square;
          of_lod.pose = pose;
          of_lod.mesh = meshes.data[m];
          of_lod.position = static_cast<uint32_t>(i / 3);
        }
        squares[lod] += sum;
        compared[lod] += before.count / 3;
      }
      of_lod.worst = std::sqrt(farthest);
      const double share = of_lod.worst / tolerance_at(tolerances, lod);
      // Not a number is too far, too.
      if (!(share <= proof.share) || !std::isfinite(squares[lod])) {
        proof.share = std::isfinite(squares[lod]) ? share : INFINITY;
        worst = pose;
      }
    }
  }
  for (uint32_t lod = 0; lod < lod_count; ++lod) {
    if (compared[lod]) proof.lods[lod].rms = std::sqrt(squares[lod] / double(compared[lod]));
  }
  proof.worst_pose = poses.describe(worst);
  return proof;
}

}  // namespace mien::cli
