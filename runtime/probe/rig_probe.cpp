// SPDX-License-Identifier: MIT
#include "runtime/probe/rig_probe.h"

#include <algorithm>
#include <cstring>

#include "runtime/deform/deform.h"
#include "runtime/eval/evaluate.h"

namespace mien {
namespace {

char lower_letter(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; }

bool same_name(Span<const char> a, const char* b) {
  if (a.count != strlen(b)) return false;
  for (size_t i = 0; i < a.count; ++i) {
    if (lower_letter(a[i]) != lower_letter(b[i])) return false;
  }
  return true;
}

}  // namespace

RigProbe::RigProbe(const Deformer& deformer, const Allocator& allocator)
    : deformer_(deformer), arena_(allocator) {
  instance_ = create_instance(*deformer.rig, allocator);
  deformed_ = create_deformer_instance(deformer, 1, allocator);
  fresh_ = arena_.array<uint8_t>(deformer.meshes.count);
  ready_ = instance_ && deformed_ && (fresh_.data || deformer.meshes.empty());
}

RigProbe::~RigProbe() {
  release(deformed_);
  release(instance_);
}

void RigProbe::clear() {
  const Span<float> initial = rig().initial_controls.first(rig().raw_count);
  std::copy(initial.begin(), initial.end(), instance_->controls.begin());
}

void RigProbe::pose() {
  evaluate(rig(), *instance_, 0, kStagesAll);
  update_deformer_instance(*deformed_, instance_->joints.data, instance_->channels.data);
  std::fill(fresh_.begin(), fresh_.end(), uint8_t{0});
}

const float* RigProbe::joint(uint32_t joint) const {
  return deformed_->joints.model.data + size_t{joint} * kMatrixFloats;
}

Vec3 RigProbe::skinned(uint32_t joint, Vec3 p) const {
  const float* m = deformed_->joints.skin.data + size_t{joint} * kMatrixFloats;
  return {m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12],
          m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13],
          m[2] * p.x + m[6] * p.y + m[10] * p.z + m[14]};
}

Span<const float> RigProbe::positions(uint32_t mesh) {
  if (!fresh_[mesh]) {
    deform(deformer_, {&deformed_, 1}, mesh, Normals::kNone, {});
    fresh_[mesh] = 1;
  }
  return deformed_->meshes[mesh].positions;
}

Vec3 RigProbe::place(const Landmark& landmark) {
  Vec3 sum;
  for (uint32_t point : landmark.points) {
    const float* at = landmark.mesh == kOfJoints
                          ? joint(point) + 12
                          : positions(landmark.mesh).data + size_t{point} * 3;
    sum = sum + Vec3{at[0], at[1], at[2]};
  }
  return sum * (1.0 / static_cast<double>(landmark.points.count));
}

Vec3 RigProbe::axis(uint32_t direction) const {
  const uint32_t* axes = rig().units.axes;
  double sizes[3] = {};
  for (int k = 0; k < 3; ++k) {
    if (axes[k] == direction) sizes[k] = 1;
    if (axes[k] == (direction ^ 1)) sizes[k] = -1;
  }
  return {sizes[0], sizes[1], sizes[2]};
}

uint16_t find_raw_control(const Rig& rig, std::initializer_list<const char*> names) {
  const NameList& list = rig.names[static_cast<size_t>(Kind::kRawControl)];
  for (uint32_t i = 0; i < rig.raw_count && i < list.count(); ++i) {
    Span<const char> name = list[i];
    for (size_t k = name.count; k-- > 0;) {
      if (name[k] != '.') continue;
      name = name.slice(k + 1, name.count - k - 1);
      break;
    }
    for (const char* wanted : names) {
      if (same_name(name, wanted)) return static_cast<uint16_t>(i);
    }
  }
  return kNoControl;
}

uint16_t find_joint(const Rig& rig, std::initializer_list<const char*> names) {
  const NameList& list = rig.names[static_cast<size_t>(Kind::kJoint)];
  for (uint32_t i = 0; i < rig.joint_count && i < list.count(); ++i) {
    for (const char* wanted : names) {
      if (same_name(list[i], wanted)) return static_cast<uint16_t>(i);
    }
  }
  return kNoJoint;
}

}  // namespace mien
