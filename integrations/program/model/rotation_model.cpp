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

template <class T>
QuaternionOf<T> turn_about(int axis, const T& angle) {
  QuaternionOf<T> q;
  (axis == 0 ? q.x : axis == 1 ? q.y : q.z) = sin(angle / 2);
  q.w = cos(angle / 2);
  return q;
}

template <class T>
QuaternionOf<T> conjugate(const QuaternionOf<T>& q) {
  return {-q.x, -q.y, -q.z, q.w};
}
template <class T>
T squared(const QuaternionOf<T>& q) {
  return q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
}

template <class T>
QuaternionOf<T> inverse(const QuaternionOf<T>& q) {
  const QuaternionOf<T> c = conjugate(q);
  const T s = squared(q);
  return {c.x / s, c.y / s, c.z / s, c.w / s};
}

/// docs/rig-evaluation.md, 7 "Twist and swing".
template <class T>
QuaternionOf<T> twist_of(const QuaternionOf<T>& q, int axis) {
  QuaternionOf<T> part = {0, 0, 0, q.w};
  (axis == 0 ? part.x : axis == 1 ? part.y : part.z) = axis == 0 ? q.x : axis == 1 ? q.y : q.z;
  return unit(part);
}

template <class T>
QuaternionOf<T> slerp_to_one(const QuaternionOf<T>& p, double t) {
  const double sign = p.w < 0 ? -1 : 1;
  const T cosine = p.w * sign;
  T from = 1 - t, to = t;
  if (cosine <= 1 - std::ldexp(1.0, -23)) {
    const T angle = acos(cosine);
    from = sin((1 - t) * angle) / sin(angle);
    to = sin(t * angle) / sin(angle);
  }
  return {p.x * from, p.y * from, p.z * from, p.w * from + to * sign};
}

/// Outputs while they are computed: angles in Euler mode, quaternions else.
template <class T>
struct Outputs {
  const LayerRig& rig;
  bool quaternions;
  ModelConvention convention;
  std::vector<JointOf<T>> joints;
  std::vector<std::array<T, 3>> angles;

  void set(uint32_t joint, const QuaternionOf<T>& q) {
    joints[joint].rotation = q;
    if (!quaternions) angles[joint] = model_angles(convention, q);
  }
};

// 4.3, 4.4, 4.7
template <class T>
void add_rows(const std::vector<T>& controls, uint32_t lod, Outputs<T>& out) {
  const LayerRig& rig = out.rig;
  for (const PlainGroup& group : rig.base.groups) {
    const size_t columns = group.inputs.size();
    for (size_t r = 0; r < group.lods[lod]; ++r) {
      const uint32_t joint = group.outputs[r] / 9, k = group.outputs[r] % 9;
      const bool rotation = k >= 3 && k < 6;
      if (rotation && !rig.rotations.empty() && rig.rotations[joint] == 1) continue;
      T sum = 0;
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
template <class T>
void quaternion_joints(const PlainGroup& group, const std::vector<T>& controls, uint32_t lod,
                       Outputs<T>& out) {
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
    if (!turned.count(row.joint)) continue;
    size_t& first = turned[row.joint][row.axis];
    if (first == 0) first = row.row + 1;
  }
  for (const auto& [joint, axis_rows] : turned) {
    QuaternionOf<T> a;
    for (size_t i = 0; i < used_at[lod]; ++i) {
      std::array<double, 3> angles = {};
      for (int k = 0; k < 3; ++k) {
        if (axis_rows[k]) angles[k] = group.values[(axis_rows[k] - 1) * columns + order[i]];
      }
      const ModelQuaternion q = model_quaternion(out.convention, angles);
      const T w = controls[group.inputs[order[i]]];
      const double b = q.w >= 0 ? 1 : -1;
      a = unit(QuaternionOf<T>{w * q.x, w * q.y, w * q.z, w * q.w + b * (1 - w)}) * a;
    }
    out.set(joint, a);
  }
}

bool exists(const LayerRig& rig, uint32_t lod, uint32_t joint) {
  return rig.has(rig.lod_joints, lod, joint);
}

template <class T>
void twist(const PlainTurn& turn, const QuaternionOf<T>& q, uint32_t lod, Outputs<T>& out) {
  for (size_t i = 0; i < turn.joints.size(); ++i) {
    if (!exists(out.rig, lod, turn.joints[i])) continue;
    out.set(turn.joints[i], slerp_to_one(q, turn.blends[i]));
  }
}

template <class T>
void twist_and_swing(const std::vector<T>& controls, uint32_t lod, Outputs<T>& out) {
  const LayerRig& rig = out.rig;
  const auto input = [&](const PlainTurn& turn) {
    return QuaternionOf<T>{controls[turn.inputs[0]], controls[turn.inputs[1]],
                           controls[turn.inputs[2]], controls[turn.inputs[3]]};
  };
  std::vector<uint8_t> merged(rig.twists.size());
  for (const PlainTurn& swing : rig.swings) {
    const QuaternionOf<T> v = conjugate(twist_of(input(swing), swing.axis));
    const QuaternionOf<T> s = inverse(input(swing) * v);
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
template <class T>
void add_learned(const std::vector<T>& controls, uint32_t lod, Outputs<T>& out) {
  const LayerRig& rig = out.rig;
  const MlJointLayout layout = ml_joint_layout(rig);
  std::vector<uint8_t> turned(out.joints.size());
  for (const auto& [control, attribute] : rig.ml_joints) {
    const uint32_t joint = attribute / layout.width, k = attribute % layout.width;
    if (!exists(rig, lod, joint)) continue;
    JointOf<T>& to = out.joints[joint];
    if (k < layout.translation) {
      to.translation[k] += controls[control];
    } else if (k >= layout.translation + layout.rotation) {
      to.scale[k - layout.translation - layout.rotation] += controls[control];
    } else if (!turned[joint]) {
      turned[joint] = 1;
      const T* x = controls.data() + control;
      if (layout.rotation == 4) {
        const QuaternionOf<T> q = unit(QuaternionOf<T>{x[0], x[1], x[2], x[3]});
        to.rotation = q * to.rotation;
        const std::array<T, 3> angles = model_angles(out.convention, q);
        for (int i = 0; i < 3; ++i) out.angles[joint][i] += angles[i];
      } else {
        const std::array<T, 3> angles = {x[0], x[1], x[2]};
        to.rotation = model_quaternion(out.convention, angles) * to.rotation;
        for (int i = 0; i < 3; ++i) out.angles[joint][i] += x[i];
      }
    }
  }
}

}  // namespace

template <class T>
QuaternionOf<T> operator*(const QuaternionOf<T>& a, const QuaternionOf<T>& b) {
  return {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

template <class T>
QuaternionOf<T> unit(const QuaternionOf<T>& q) {
  const T n = sqrt(squared(q));
  if (!(n > 0)) return {};
  return {q.x / n, q.y / n, q.z / n, q.w / n};
}

ModelConvention convention_of(const LayerRig& rig) {
  return {rig.sequence, rig.signs, rig.rotation_unit == 0};
}

template <class T>
QuaternionOf<T> model_quaternion(const ModelConvention& convention,
                                 const std::array<T, 3>& angles) {
  QuaternionOf<T> q;
  for (int axis : kAxes[convention.sequence]) {
    const T angle = angles[axis] * convention.signs[axis] * (convention.degrees ? kPi / 180 : 1);
    q = turn_about(axis, angle) * q;
  }
  return q;
}

template <class T>
std::array<T, 3> model_angles(const ModelConvention& convention, const QuaternionOf<T>& from) {
  const QuaternionOf<T> q = unit(from);
  const T x = q.x, y = q.y, z = q.z, w = q.w;
  const T m[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
                     {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
                     {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
  const int* axes = kAxes[convention.sequence];
  const int a = axes[0], b = axes[1], c = axes[2];
  const double p =
      convention.sequence == 0 || convention.sequence == 3 || convention.sequence == 4 ? 1 : -1;
  std::array<T, 3> angles;
  const T sine = -p * m[a][c];
  angles[b] = asin(sine > 1 ? T(1) : sine < -1 ? T(-1) : sine);
  angles[a] = atan2(p * m[b][c], m[c][c]);
  angles[c] = atan2(p * m[a][b], m[a][a]);
  for (int i = 0; i < 3; ++i) {
    angles[i] *= convention.signs[i] * (convention.degrees ? 180 / kPi : 1);
  }
  return angles;
}

double angle_between(const ModelQuaternion& a, const ModelQuaternion& b) {
  const ModelQuaternion d = unit(a) * conjugate(unit(b));
  return 2 * std::atan2(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), std::fabs(d.w));
}

template <class T>
std::vector<JointOf<T>> model_joints(const LayerRig& rig, const std::vector<T>& controls,
                                     uint32_t lod, bool quaternion_outputs) {
  Outputs<T> out = {rig, quaternion_outputs, convention_of(rig), {}, {}};
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

#define MIEN_MODEL_ROTATIONS(T)                                                                   \
  template QuaternionOf<T> operator*(const QuaternionOf<T>&, const QuaternionOf<T>&);             \
  template QuaternionOf<T> unit(const QuaternionOf<T>&);                                          \
  template QuaternionOf<T> model_quaternion(const ModelConvention&, const std::array<T, 3>&);     \
  template std::array<T, 3> model_angles(const ModelConvention&, const QuaternionOf<T>&);         \
  template std::vector<JointOf<T>> model_joints(const LayerRig&, const std::vector<T>&, uint32_t, \
                                                bool);
MIEN_MODEL_ROTATIONS(double)
MIEN_MODEL_ROTATIONS(Dual)

}  // namespace mien::model
