// SPDX-License-Identifier: MIT
#include "author/document/control_poses.h"

#include <algorithm>
#include <cmath>

#include "author/base/dna_making.h"
#include "author/base/exact_math.h"
#include "runtime/load/dna/format/quaternion_columns.h"

namespace mien::author {

bool ControlPoses::prepare(const dna::DnaView& view, Arena& arena) {
  view_ = &view;
  convention_ = convention_of(view);
  const uint32_t joints = view.defn.joint_names.count;
  Span<uint8_t> done;
  Span<uint32_t> chain;
  if (!make(arena, joints, order_) || !make(arena, joints, binds_) ||
      !make(arena, joints, neutrals_) || !make(arena, joints, done) ||
      !make(arena, joints, chain)) {
    return false;
  }
  uint32_t ordered = 0;
  for (uint32_t j = 0; j < joints; ++j) {
    uint32_t length = 0;
    for (uint32_t up = j; !done[up]; up = view.defn.joint_hierarchy[up]) {
      chain[length++] = up;
      done[up] = 1;
    }
    while (length != 0) {
      const uint32_t joint = chain[--length], parent = view.defn.joint_hierarchy[joint];
      const Rigid local = neutrals_[joint] = neutral_of(view, convention_, joint);
      binds_[joint] = parent == joint ? local : local * binds_[parent];
      order_[ordered++] = joint;
    }
  }
  for (const dna::JointRepresentation& joint : view.jbmd.joints)
    quaternions_ |= joint.rotation == 1;
  return true;
}

void ControlPoses::controls(uint32_t pose, Span<double> out) const {
  std::fill(out.begin(), out.end(), 0.0);
  const dna::PsdTable& psds = view_->bhvr.controls.psds;
  const uint32_t raw = view_->first_psd();
  if (pose < raw) out[pose] = 1;
  for (uint32_t i = 0; pose >= raw && i < psds.rows.count; ++i) {
    if (psds.rows[i] == pose && psds.columns[i] < raw) out[psds.columns[i]] = 1;
  }
  // The weights times the clamped inputs, at most 1. Those of a pose see its raw controls only.
  for (uint32_t i = 0; i < psds.rows.count; ++i) {
    if (psds.rows[i] >= raw) out[psds.rows[i]] = 1;
  }
  for (uint32_t i = 0; i < psds.rows.count; ++i) {
    if (psds.rows[i] < raw) continue;
    const double input = psds.columns[i] < raw ? out[psds.columns[i]] : 0;
    out[psds.rows[i]] *= double{psds.values[i]} * clamp01(input);
  }
  for (uint32_t p = raw; p < view_->first_ml(); ++p) out[p] = std::min(out[p], 1.0);
}

bool ControlPoses::add_quaternions(const dna::JointGroup& group, uint32_t rows,
                                   Span<const double> controls, Arena& scratch,
                                   Span<Quaternion> out) const {
  const uint32_t columns = group.input_indices.count, joints = static_cast<uint32_t>(out.count);
  Span<uint32_t> first_rows, order;
  Span<float> angles;
  Span<uint8_t> active;
  if (!make(scratch, columns, first_rows) || !make(scratch, columns, order) ||
      !make(scratch, size_t{joints} * 3, angles) || !make(scratch, joints, active)) {
    return false;
  }
  for (uint32_t r = 0; r < rows; ++r) {
    const uint32_t output = group.output_indices[r];
    if (!dna::is_quaternion_row(*view_, output)) continue;
    active[output / 9] = 1;
    out[output / 9] = {};
  }
  const uint32_t turning = dna::order_quaternion_columns(*view_, group, first_rows, order, nullptr);
  for (uint32_t k = 0; k < turning; ++k) {
    const double weight = controls[group.input_indices[order[k]]];
    if (weight == 0) continue;
    std::fill(angles.begin(), angles.end(), 0.0f);
    for (uint32_t r = 0; r < group.output_indices.count; ++r) {
      const uint32_t output = group.output_indices[r];
      if (!dna::is_quaternion_row(*view_, output)) continue;
      angles[size_t{output / 9} * 3 + output % 9 - 3] =
          group.values[size_t{r} * columns + order[k]];
    }
    for (uint32_t j = 0; j < joints; ++j) {
      const float* a = angles.data + size_t{j} * 3;
      if (!active[j] || (a[0] == 0 && a[1] == 0 && a[2] == 0)) continue;
      Quaternion q = quaternion_from_euler(convention_, a);
      const auto w = static_cast<float>(weight);
      q = {w * q.x, w * q.y, w * q.z, w * q.w + (q.w >= 0 ? 1 - w : w - 1)};
      out[j] = normalized(q) * out[j];
    }
  }
  return true;
}

bool ControlPoses::skin(Span<const double> controls, Arena& scratch, Span<Rigid> out) const {
  const uint32_t joints = view_->defn.joint_names.count;
  Span<double> values;
  Span<Quaternion> turns;
  if (!make(scratch, size_t{joints} * 9, values) || !make(scratch, joints, turns)) return false;
  for (const dna::JointGroup& group : view_->bhvr.joints.groups) {
    const uint32_t columns = group.input_indices.count;
    const uint32_t rows = group.lods.count ? group.lods[0] : 0;
    for (uint32_t r = 0; r < rows; ++r) values[group.output_indices[r]] = 0;
    for (uint32_t c = 0; c < columns; ++c) {
      const double input = controls[group.input_indices[c]];
      if (input == 0) continue;
      for (uint32_t r = 0; r < rows; ++r) {
        values[group.output_indices[r]] += input * double{group.values[size_t{r} * columns + c]};
      }
    }
    if (quaternions_ && !add_quaternions(group, rows, controls, scratch, turns)) return false;
  }
  // Models in place of skin matrices, which need the models of parents.
  for (uint32_t i = 0; i < joints; ++i) {
    const uint32_t joint = order_[i], parent = view_->defn.joint_hierarchy[joint];
    const double* delta = values.data + size_t{joint} * 9;
    Rigid local = neutrals_[joint];
    const bool quaternion = quaternions_ && dna::is_quaternion_joint(*view_, joint);
    bool moves = quaternion;
    for (int k = 0; k < 9; ++k) moves |= delta[k] != 0;
    if (!moves) {
      out[joint] = parent == joint ? local : local * out[parent];
      continue;
    }
    Matrix3 turn;
    if (quaternion) {
      turn = matrix_from_quaternion(turns[joint]);
    } else {
      const float angles[3] = {float(delta[3]), float(delta[4]), float(delta[5])};
      turn = matrix_from_euler(convention_, angles);
    }
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) turn.m[r][c] *= 1 + delta[6 + r];
    }
    local.turn = turn * local.turn;
    local.place = local.place + Vec3{delta[0], delta[1], delta[2]};
    out[joint] = parent == joint ? local : local * out[parent];
  }
  for (uint32_t j = 0; j < joints; ++j) out[j] = inverse(binds_[j]) * out[j];
  return true;
}

void ControlPoses::channels(Span<const double> controls, Span<double> out) const {
  std::fill(out.begin(), out.end(), 0.0);
  const dna::BlendShapeChannels& table = view_->bhvr.channels;
  const uint32_t rows = table.lods.count ? table.lods[0] : 0;
  for (uint32_t i = 0; i < rows; ++i)
    out[table.output_indices[i]] = controls[table.input_indices[i]];
}

void ControlPoses::deform(uint32_t mesh, Span<const Rigid> skin, Span<const double> channels,
                          Span<Vec3> out) const {
  const dna::Mesh& of = view_->geom.meshes[mesh];
  for (uint32_t v = 0; v < out.count; ++v) out[v] = vector_of(of.positions, v);
  for (const dna::BlendShapeTarget& target : of.blend_shape_targets) {
    const double weight = channels[target.channel_index];
    for (uint32_t i = 0; weight != 0 && i < target.vertex_indices.count; ++i) {
      Vec3& p = out[target.vertex_indices[i]];
      p = p + vector_of(target.deltas, i) * weight;
    }
  }
  for (uint32_t v = 0; v < out.count && v < of.skin_weights.count; ++v)
    out[v] = skinned(of.skin_weights[v], skin, out[v]);
}

Vec3 ControlPoses::skinned(const dna::VertexSkinWeights& vertex, Span<const Rigid> skin,
                           Vec3 position) {
  if (vertex.weights.count == 0) return position;
  Vec3 sum;
  for (uint32_t i = 0; i < vertex.weights.count; ++i) {
    sum = sum + apply(position, skin[vertex.joint_indices[i]]) * double{vertex.weights[i]};
  }
  return sum;
}

}  // namespace mien::author
