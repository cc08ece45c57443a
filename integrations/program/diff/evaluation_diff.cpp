// SPDX-License-Identifier: MIT
#include "integrations/program/diff/evaluation_diff.h"

#include <algorithm>
#include <cmath>

#include "integrations/program/io/rig_file.h"

namespace mien::cli {

namespace {

constexpr const char* kCannot = "cannot compare";
constexpr size_t kJointValues = 9;

/// A rig that is evaluated one control at a time.
struct Evaluated {
  Rig rig;
  Instance instance;
  const float* joints = nullptr;
  const float* blend_shapes = nullptr;
  const float* animated_maps = nullptr;

  Evaluated(const MienDna* dna, const char* shown) {
    auto error = sized<MienError>();
    MienRig* made = nullptr;
    check(mien_rig_create(dna, nullptr, &made, &error), &error, kCannot, shown);
    rig.reset(made);
    MienInstance* created = nullptr;
    check(mien_instance_create(made, nullptr, &created, &error), &error, kCannot, shown);
    instance.reset(created);
  }

  void evaluate(uint32_t control) {
    check(mien_instance_reset(instance.get()), nullptr, kCannot, "");
    MienMutableFloatView raw{};
    check(mien_instance_raw_controls(instance.get(), &raw), nullptr, kCannot, "");
    raw.data[control] = 1;
    check(mien_rig_evaluate(rig.get(), instance.get(), 0), nullptr, kCannot, "");
    joints = view(mien_instance_joints);
    blend_shapes = view(mien_instance_blend_shapes);
    animated_maps = view(mien_instance_animated_maps);
  }

  const float* view(MienStatus (*of)(const MienInstance*, MienFloatView*)) const {
    MienFloatView values{};
    check(of(instance.get(), &values), nullptr, kCannot, "");
    return values.data;
  }
};

struct Match {
  uint32_t before, after;
};

/// Elements of a kind that both rigs have, by name or as renamed.
std::vector<Match> matches(const Evaluated& before, const Evaluated& after, uint32_t kind,
                           const RenamedByKind& renamed) {
  std::unordered_map<std::string, uint32_t> new_indices;
  const uint32_t new_count = rig_count(after.rig.get(), kind);
  for (uint32_t i = 0; i < new_count; ++i) {
    new_indices.emplace(rig_name(after.rig.get(), kind, i), i);
  }
  const auto names = renamed.find(kind);
  std::vector<Match> found;
  const uint32_t count = rig_count(before.rig.get(), kind);
  for (uint32_t i = 0; i < count; ++i) {
    std::string name = rig_name(before.rig.get(), kind, i);
    if (names != renamed.end()) {
      const auto now = names->second.find(name);
      if (now != names->second.end()) name = now->second;
    }
    const auto there = new_indices.find(name);
    if (there != new_indices.end()) found.push_back({i, there->second});
  }
  return found;
}

double difference(float from, float to) {
  return std::abs(static_cast<double>(to) - static_cast<double>(from));
}

double largest_difference(const std::vector<Match>& pairs, const float* from, const float* to) {
  double largest = 0;
  for (const Match& pair : pairs) {
    largest = std::max(largest, difference(from[pair.before], to[pair.after]));
  }
  return largest;
}

void compare_joints(const std::vector<Match>& joints, const Evaluated& before,
                    const Evaluated& after, ControlChange& change) {
  double largest = 0;
  for (const Match& joint : joints) {
    double* const of_kind[] = {&change.translation, &change.rotation, &change.scale};
    for (size_t v = 0; v < kJointValues; ++v) {
      const double found = difference(before.joints[kJointValues * joint.before + v],
                                      after.joints[kJointValues * joint.after + v]);
      *of_kind[v / 3] = std::max(*of_kind[v / 3], found);
      if (found <= largest) continue;
      largest = found;
      change.joint = rig_name(before.rig.get(), MIEN_KIND_JOINT, joint.before);
    }
  }
}

bool has_behavior(const MienDna* dna) {
  auto field = sized<MienDnaField>();
  return mien_dna_field(dna, "bhvr", &field, nullptr) == MIEN_OK;
}

}  // namespace

void diff_evaluation(const MienDna* before, const MienDna* after, const RenamedByKind& renamed,
                     DnaDiff& diff) {
  if (!has_behavior(before) || !has_behavior(after)) return;
  Evaluated old_rig(before, "the first file"), new_rig(after, "the second file");
  const auto of_kind = [&](uint32_t kind) { return matches(old_rig, new_rig, kind, renamed); };
  const std::vector<Match> controls = of_kind(MIEN_KIND_RAW_CONTROL);
  const std::vector<Match> joints = of_kind(MIEN_KIND_JOINT);
  const std::vector<Match> channels = of_kind(MIEN_KIND_BLEND_SHAPE_CHANNEL);
  const std::vector<Match> maps = of_kind(MIEN_KIND_ANIMATED_MAP);
  diff.evaluated = true;
  diff.compared_controls = static_cast<uint32_t>(controls.size());
  for (const Match& control : controls) {
    old_rig.evaluate(control.before);
    new_rig.evaluate(control.after);
    ControlChange change;
    compare_joints(joints, old_rig, new_rig, change);
    change.blend_shape = largest_difference(channels, old_rig.blend_shapes, new_rig.blend_shapes);
    change.animated_map = largest_difference(maps, old_rig.animated_maps, new_rig.animated_maps);
    if (change.joint.empty() && change.blend_shape == 0 && change.animated_map == 0) continue;
    change.control = rig_name(old_rig.rig.get(), MIEN_KIND_RAW_CONTROL, control.before);
    diff.controls.push_back(change);
  }
}

}  // namespace mien::cli
