// SPDX-License-Identifier: MIT
#include "integrations/program/model/rotation_model.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "integrations/program/model/ml_model.h"

namespace mien::model {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kAxes[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};

ModelQuaternion turn_about(int axis, double angle) {
  ModelQuaternion q;
  (axis == 0 ? q.x : axis == 1 ? q.y : q.z) = std::sin(angle / 2);
  q.w = std::cos(angle / 2);
  return q;
}

ModelQuaternion conjugate(const ModelQuaternion& q) { return {-q.x, -q.y, -q.z, q.w}; }
double squared(const ModelQuaternion& q) { return q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w; }

ModelQuaternion inverse(const ModelQuaternion& q) {
  const ModelQuaternion c = conjugate(q);
  const double s = squared(q);
  return {c.x / s, c.y / s, c.z / s, c.w / s};
}

/// docs/rig-evaluation.md, 7 "Twist and swing".
ModelQuaternion twist_of(const ModelQuaternion& q, int axis) {
  ModelQuaternion part = {0, 0, 0, q.w};
  (axis == 0 ? part.x : axis == 1 ? part.y : part.z) = axis == 0 ? q.x : axis == 1 ? q.y : q.z;
  return squared(part) > 0 ? unit(part) : ModelQuaternion{};
}

ModelQuaternion slerp_to_one(const ModelQuaternion& p, double t) {
  const double sign = p.w < 0 ? -1 : 1, cosine = p.w * sign;
  double from = 1 - t, to = t;
  if (cosine <= 1 - std::ldexp(1.0, -23)) {
    const double angle = std::acos(cosine);
    from = std::sin((1 - t) * angle) / std::sin(angle);
    to = std::sin(t * angle) / std::sin(angle);
  }
  return {p.x * from, p.y * from, p.z * from, p.w * from + to * sign};
}

/// Outputs while they are computed: angles in Euler mode, quaternions else.
struct Outputs {
  const LayerRig& rig;
  bool quaternions;
  ModelConvention convention;
  std::vector<ModelJoint> joints;
  std::vector<std::array<double, 3>> angles;

  void set(uint32_t joint, const ModelQuaternion& q) {
    joints[joint].rotation = q;
    if (!quaternions) angles[joint] = model_angles(convention, q);
  }
};

// 4.3, 4.4, 4.7
void add_rows(const std::vector<double>& controls, uint32_t lod, Outputs& out) {
  const LayerRig& rig = out.rig;
  for (const PlainGroup& group : rig.base.groups) {
    const size_t columns = group.inputs.size();
    for (size_t r = 0; r < group.lods[lod]; ++r) {
      const uint32_t joint = group.outputs[r] / 9, k = group.outputs[r] % 9;
      const bool rotation = k >= 3 && k < 6;
      if (rotation && !rig.rotations.empty() && rig.rotations[joint] == 1) continue;
      double sum = 0;
      bool any = false;
      for (size_t c = 0; c < columns; ++c) {
        sum += double{group.values[r * columns + c]} * controls[group.inputs[c]];
        any |= group.values[r * columns + c] != 0;
      }
      if (!any) continue;
      if (k < 3) out.joints[joint].translation[k] = sum;
      if (rotation) out.angles[joint][k - 3] = sum;
      if (k >= 6) out.joints[joint].scale[k - 6] = sum;
    }
  }
  for (size_t j = 0; j < out.joints.size(); ++j) {
    out.joints[j].rotation = model_quaternion(out.convention, out.angles[j]);
  }
}

// 4.3, 4.8: as literally as it is told there.
void quaternion_joints(const PlainGroup& group, const std::vector<double>& controls, uint32_t lod,
                       Outputs& out) {
  const LayerRig& rig = out.rig;
  const size_t columns = group.inputs.size();
  struct JointRow {
    size_t row;
    uint32_t joint, axis;
  };
  std::vector<JointRow> rows;
  std::vector<size_t> row_counts(rig.base.lod_count);
  for (size_t r = 0; r < group.lods[0]; ++r) {
    const uint32_t joint = group.outputs[r] / 9, k = group.outputs[r] % 9;
    const float* values = group.values.data() + r * columns;
    const bool any = std::any_of(values, values + columns, [](float v) { return v != 0; });
    if (k < 3 || k >= 6 || rig.rotations.empty() || rig.rotations[joint] != 1 || !any) continue;
    rows.push_back({r, joint, k - 3});
    for (size_t l = 0; l < row_counts.size(); ++l) row_counts[l] += r < group.lods[l];
  }
  const auto significant = [&](size_t column, size_t row_count) {
    for (size_t i = 0; i < row_count; ++i) {
      if (group.values[rows[i].row * columns + column] != 0) return true;
    }
    return false;
  };
  std::vector<size_t> order;
  for (size_t c = 0; c < columns; ++c) {
    if (significant(c, rows.size())) order.push_back(c);
  }
  // The exchanges for all LODs come first: they make one order for all of them.
  size_t used = order.size();
  std::vector<size_t> used_at(rig.base.lod_count);
  for (size_t l = 0; l < rig.base.lod_count; ++l) {
    bool found = true;
    while (found) {
      found = false;
      for (size_t c = used; c-- > 0 && !found;) {
        if (significant(order[c], row_counts[l])) continue;
        std::swap(order[c], order[--used]);
        found = true;
      }
    }
    used_at[l] = used;
  }
  std::map<uint32_t, std::array<size_t, 3>> turned;  // joint -> row of each axis, counted from 1
  for (size_t i = 0; i < rows.size(); ++i) {
    if (i < row_counts[lod]) turned[rows[i].joint];
  }
  for (const JointRow& row : rows) {
    if (turned.count(row.joint)) turned[row.joint][row.axis] = row.row + 1;
  }
  for (const auto& [joint, axis_rows] : turned) {
    ModelQuaternion a;
    for (size_t i = 0; i < used_at[lod]; ++i) {
      std::array<double, 3> angles = {};
      for (int k = 0; k < 3; ++k) {
        if (axis_rows[k]) angles[k] = group.values[(axis_rows[k] - 1) * columns + order[i]];
      }
      const ModelQuaternion q = model_quaternion(out.convention, angles);
      const double w = controls[group.inputs[order[i]]], b = q.w >= 0 ? 1 : -1;
      a = unit({w * q.x, w * q.y, w * q.z, w * q.w + b * (1 - w)}) * a;
    }
    out.set(joint, a);
  }
}

bool exists(const LayerRig& rig, uint32_t lod, uint32_t joint) {
  return rig.has(rig.lod_joints, lod, joint);
}

void twist(const PlainTurn& turn, const ModelQuaternion& q, uint32_t lod, Outputs& out) {
  for (size_t i = 0; i < turn.joints.size(); ++i) {
    if (!exists(out.rig, lod, turn.joints[i])) continue;
    out.set(turn.joints[i], slerp_to_one(q, turn.blends[i]));
  }
}

void twist_and_swing(const std::vector<double>& controls, uint32_t lod, Outputs& out) {
  const LayerRig& rig = out.rig;
  const auto input = [&](const PlainTurn& turn) {
    return ModelQuaternion{controls[turn.inputs[0]], controls[turn.inputs[1]],
                           controls[turn.inputs[2]], controls[turn.inputs[3]]};
  };
  std::vector<uint8_t> merged(rig.twists.size());
  for (const PlainTurn& swing : rig.swings) {
    const ModelQuaternion v = conjugate(twist_of(input(swing), swing.axis));
    const ModelQuaternion s = inverse(input(swing) * v);
    for (size_t i = 0; i < swing.joints.size(); ++i) {
      if (!exists(rig, lod, swing.joints[i])) continue;
      out.set(swing.joints[i], v * slerp_to_one(s, swing.blends[i]));
    }
    for (size_t t = 0; t < rig.twists.size(); ++t) {
      if (merged[t] || rig.twists[t].inputs != swing.inputs) continue;
      merged[t] = 1;
      twist(rig.twists[t], v, lod, out);
    }
  }
  for (size_t t = 0; t < rig.twists.size(); ++t) {
    if (!merged[t])
      twist(rig.twists[t], twist_of(input(rig.twists[t]), rig.twists[t].axis), lod, out);
  }
}

// 8.6. What a joint's rotation takes stands in consecutive controls.
void add_learned(const std::vector<double>& controls, uint32_t lod, Outputs& out) {
  const LayerRig& rig = out.rig;
  const MlJointLayout layout = ml_joint_layout(rig);
  std::vector<uint8_t> turned(out.joints.size());
  for (const auto& [control, attribute] : rig.ml_joints) {
    const uint32_t joint = attribute / layout.width, k = attribute % layout.width;
    if (!exists(rig, lod, joint)) continue;
    ModelJoint& to = out.joints[joint];
    if (k < layout.translation) {
      to.translation[k] += controls[control];
    } else if (k >= layout.translation + layout.rotation) {
      to.scale[k - layout.translation - layout.rotation] += controls[control];
    } else if (!turned[joint]) {
      turned[joint] = 1;
      const double* x = controls.data() + control;
      if (layout.rotation == 4) {
        const ModelQuaternion q = unit({x[0], x[1], x[2], x[3]});
        to.rotation = q * to.rotation;
        const std::array<double, 3> angles = model_angles(out.convention, q);
        for (int i = 0; i < 3; ++i) out.angles[joint][i] += angles[i];
      } else {
        to.rotation = model_quaternion(out.convention, {x[0], x[1], x[2]}) * to.rotation;
        for (int i = 0; i < 3; ++i) out.angles[joint][i] += x[i];
      }
    }
  }
}

}  // namespace

ModelQuaternion operator*(const ModelQuaternion& a, const ModelQuaternion& b) {
  return {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

ModelQuaternion unit(const ModelQuaternion& q) {
  const double n = std::sqrt(squared(q));
  return {q.x / n, q.y / n, q.z / n, q.w / n};
}

ModelConvention convention_of(const LayerRig& rig) {
  return {rig.sequence, rig.signs, rig.rotation_unit == 0};
}

ModelQuaternion model_quaternion(const ModelConvention& convention,
                                 const std::array<double, 3>& angles) {
  ModelQuaternion q;
  for (int axis : kAxes[convention.sequence]) {
    const double angle =
        angles[axis] * convention.signs[axis] * (convention.degrees ? kPi / 180 : 1);
    q = turn_about(axis, angle) * q;
  }
  return q;
}

std::array<double, 3> model_angles(const ModelConvention& convention, const ModelQuaternion& from) {
  const ModelQuaternion q = unit(from);
  const double x = q.x, y = q.y, z = q.z, w = q.w;
  const double m[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
                          {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
                          {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
  const int* axes = kAxes[convention.sequence];
  const int a = axes[0], b = axes[1], c = axes[2];
  const double p =
      convention.sequence == 0 || convention.sequence == 3 || convention.sequence == 4 ? 1 : -1;
  std::array<double, 3> angles;
  angles[b] = std::asin(std::fmax(-1, std::fmin(1, -p * m[a][c])));
  angles[a] = std::atan2(p * m[b][c], m[c][c]);
  angles[c] = std::atan2(p * m[a][b], m[a][a]);
  for (int i = 0; i < 3; ++i) {
    angles[i] *= convention.signs[i] * (convention.degrees ? 180 / kPi : 1);
  }
  return angles;
}

double angle_between(const ModelQuaternion& a, const ModelQuaternion& b) {
  const ModelQuaternion d = unit(a) * conjugate(unit(b));
  return 2 * std::atan2(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), std::fabs(d.w));
}

std::vector<ModelJoint> model_joints(const LayerRig& rig, const std::vector<double>& controls,
                                     uint32_t lod, bool quaternion_outputs) {
  Outputs out = {rig, quaternion_outputs, convention_of(rig), {}, {}};
  out.joints.resize(rig.base.joint_count);
  out.angles.resize(rig.base.joint_count);
  add_rows(controls, lod, out);
  for (const PlainGroup& group : rig.base.groups) quaternion_joints(group, controls, lod, out);
  twist_and_swing(controls, lod, out);
  add_learned(controls, lod, out);
  for (size_t j = 0; j < out.joints.size() && !quaternion_outputs; ++j) {
    out.joints[j].rotation = model_quaternion(out.convention, out.angles[j]);
  }
  return out.joints;
}

std::vector<ModelJoint> joints_of(const LayerRig& rig, const float* outputs, size_t count,
                                  bool quaternion_outputs) {
  const size_t width = quaternion_outputs ? 10 : 9;
  std::vector<ModelJoint> joints(count / width);
  for (size_t j = 0; j < joints.size(); ++j) {
    const float* v = outputs + j * width;
    ModelJoint& to = joints[j];
    to.translation = {v[0], v[1], v[2]};
    to.rotation = quaternion_outputs ? ModelQuaternion{v[3], v[4], v[5], v[6]}
                                     : model_quaternion(convention_of(rig), {v[3], v[4], v[5]});
    to.scale = {v[width - 3], v[width - 2], v[width - 1]};
  }
  return joints;
}

}  // namespace mien::model
