// SPDX-License-Identifier: MIT
#include "integrations/program/accept/accepted_rig.h"

#include <cmath>
#include <cstring>

#include "integrations/program/math/random.h"

namespace mien::cli {

namespace {

constexpr char kCannot[] = "cannot check rig";
constexpr uint32_t kPoses = 24;

/// Turns by up to 90 degrees about any axis.
void draw_rotation(math::Random& random, float* xyzw) {
  double axis[3], squared = 0;
  do {
    squared = 0;
    for (double& part : axis) {
      part = 2 * random.unit() - 1;
      squared += part * part;
    }
  } while (squared > 1 || squared < 1e-3);
  const double half = random.unit() * 0.25 * 3.14159265358979323846;
  for (int i = 0; i < 3; ++i) {
    xyzw[i] = static_cast<float>(axis[i] / std::sqrt(squared) * std::sin(half));
  }
  xyzw[3] = static_cast<float>(std::cos(half));
}

std::vector<std::vector<float>> draw_poses(const MienRig* rig, const model::LayerRig& model) {
  MienFloatView initial{};
  check(mien_rig_initial_raw_controls(rig, &initial), nullptr, kCannot, "");
  const std::vector<float> start(initial.data, initial.data + initial.count);
  const std::vector<uint16_t> quaternions = quaternion_inputs(model);
  std::vector<bool> turns(start.size());
  for (const uint16_t first : quaternions) {
    for (size_t k = 0; k < 4; ++k) turns[first + k] = true;
  }
  std::vector<std::vector<float>> poses = {start};
  math::Random random;
  for (uint32_t p = 0; p < kPoses; ++p) {
    std::vector<float> raw = start;
    for (size_t i = 0; i < raw.size(); ++i) {
      const bool is_on = random.unit() < 0.2 || i % kPoses == p;
      const double value = random.unit();
      if (is_on && !turns[i]) raw[i] = static_cast<float>(value);
    }
    for (const uint16_t first : quaternions) draw_rotation(random, raw.data() + first);
    poses.push_back(raw);
  }
  return poses;
}

std::vector<float> copied(const MienFloatView& view) {
  return std::vector<float>(view.data, view.data + view.count);
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
}

}  // namespace

Results evaluate_fresh(const MienRig* rig, const std::vector<float>& raw, uint32_t lod) {
  MienInstance* made = nullptr;
  auto error = sized<MienError>();
  check(mien_instance_create(rig, nullptr, &made, &error), &error, kCannot, "");
  const Instance instance(made);
  MienMutableFloatView controls{};
  check(mien_instance_raw_controls(made, &controls), nullptr, kCannot, "");
  for (size_t i = 0; i < controls.count && i < raw.size(); ++i) controls.data[i] = raw[i];
  check(mien_rig_evaluate(rig, made, lod), nullptr, kCannot, "");
  MienFloatView all{}, joints{}, channels{}, maps{};
  check(mien_instance_controls(made, &all), nullptr, kCannot, "");
  check(mien_instance_joints(made, &joints), nullptr, kCannot, "");
  check(mien_instance_blend_shapes(made, &channels), nullptr, kCannot, "");
  check(mien_instance_animated_maps(made, &maps), nullptr, kCannot, "");
  return {copied(all), copied(joints), copied(channels), copied(maps)};
}

bool same_bits(const Results& a, const Results& b) {
  return same_bits(a.controls, b.controls) && same_bits(a.joints, b.joints) &&
         same_bits(a.channels, b.channels) && same_bits(a.maps, b.maps);
}

AcceptedRig open_accepted_rig(const std::string& path, const Session& session) {
  AcceptedRig result;
  result.file = open_rig_file(path, sized<MienDnaDesc>(), session);
  result.rig = create_rig(result, MIEN_ISA_BEST, MIEN_ROTATION_OUTPUT_EULER);
  result.model = read_rig_model(result.file, result.rig.get());
  result.poses = draw_poses(result.rig.get(), result.model);
  return result;
}

std::vector<uint32_t> present_isas() {
  std::vector<uint32_t> isas;
  for (uint32_t isa = MIEN_ISA_SCALAR; isa <= MIEN_ISA_NEON; ++isa) {
    if (mien_isa_available(isa)) isas.push_back(isa);
  }
  return isas;
}

Rig create_rig(const AcceptedRig& from, uint32_t isa, uint32_t rotation_output) {
  auto desc = sized<MienRigDesc>();
  desc.isa = isa;
  desc.rotation_output = rotation_output;
  return create_rig(from.file, desc);
}

}  // namespace mien::cli
