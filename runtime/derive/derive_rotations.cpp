// SPDX-License-Identifier: MIT
// Derivatives of rotations: quaternion joints, angles that become quaternions, twists and swings, ML joints
// (docs/derivatives.md, 5). Each output is a small matrix of derivatives times what it reads.
#include <cmath>

#include "runtime/base/half.h"
#include "runtime/derive/derive_stages.h"
#include "runtime/derive/dual.h"

namespace mien {
namespace {

template <int N>
DualQuaternion<N> from_angles(const RotationConvention& convention, const Dual<N>* angles) {
  DualQuaternion<N> q;
  for (const uint8_t axis : convention.axes) {
    const Dual<N> half = (0.5 * convention.signs[axis] * convention.to_radians) * angles[axis];
    DualQuaternion<N> turn;
    (axis == 0 ? turn.x : axis == 1 ? turn.y : turn.z) = sine(half);
    turn.w = cosine(half);
    q = turn * q;
  }
  return q;
}

// docs/rig-evaluation.md, 4.6: the form that is accurate near the poles. At a pole itself the angles have no
// derivative; that of the third one alone is given there.
template <int N>
void to_angles(const RotationConvention& convention, const DualQuaternion<N>& q, Dual<N>* angles) {
  const Dual<N>* parts[] = {&q.x, &q.y, &q.z};
  const double parity = convention.parity;
  const Dual<N> x = *parts[convention.axes[0]], z = *parts[convention.axes[2]];
  const Dual<N> y = parity * *parts[convention.axes[1]], w = q.w;
  const Dual<N> u1 = w + y, v1 = x - z, u2 = w - y, v2 = x + z;
  const Dual<N> n1 = u1 * u1 + v1 * v1, n2 = u2 * u2 + v2 * v2;
  const Dual<N> cosine = square_root(n1 * n2);
  const Dual<N> second = parity * arc_tangent(2.0 * (w * y - x * z), cosine);
  Dual<N> first, third;
  if (cosine.value < (n1.value + n2.value) * 0.5e-7) {
    const bool upper = n2.value < n1.value;
    const Dual<N> u = upper ? u1 : u2, v = upper ? -1.0 * v1 : v2;
    third = arc_tangent(2.0 * (u * v), (u - v) * (u + v));
  } else {
    first = arc_tangent(u1 * v2 + u2 * v1, u1 * u2 - v1 * v2);
    third = arc_tangent(u1 * v2 - u2 * v1, u1 * u2 + v1 * v2);
  }
  const auto put = [&](uint8_t axis, const Dual<N>& angle) {
    angles[axis] = (convention.signs[axis] / double{convention.to_radians}) * angle;
  };
  put(convention.axes[0], first);
  put(convention.axes[1], second);
  put(convention.axes[2], third);
}

/// The rotation as the rig's outputs have it: four numbers, or three angles and 0. slopes[row][variable].
template <int N>
void output_slopes(const Rig& rig, const DualQuaternion<N>& q, float* slopes) {
  Dual<N> parts[4] = {q.x, q.y, q.z, q.w};
  if (!rig.quaternion_outputs) {
    to_angles(rig.rotation, q, parts);
    parts[3] = 0.0;
  }
  for (int r = 0; r < 4; ++r) {
    for (int i = 0; i < N; ++i) {
      const double slope = parts[r].by[i];
      slopes[r * N + i] = std::isfinite(slope) ? saturated(slope) : 0.0f;
    }
  }
}

template <int N>
DualQuaternion<N> variables(const float* q) {
  return {Dual<N>::variable(q[0], 0), Dual<N>::variable(q[1], 1), Dual<N>::variable(q[2], 2),
          Dual<N>::variable(q[3], 3)};
}

// Quaternion joints -------------------------------------------------------------------------------

struct Product {  // of plain quaternions
  double x = 0, y = 0, z = 0, w = 1;
};
Product operator*(const Product& a, const Product& b) {
  return {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
double length_of(const Product& q) {
  return std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
}

Product step_value(const Rig& rig, size_t step, size_t lane) {
  const RotationTable& table = rig.rotations;
  const auto at = [&](size_t k) -> double {
    const size_t i = (step * 4 + k) * kBlockLanes + lane;
    return rig.half_storage ? float_from_half(table.halves[i]) : table.values[i];
  };
  return {at(0), at(1), at(2), at(3)};
}

// With unit factors A = L_n ... L_1; by the control of step s: L_n ... L_{s+1} (Q_s - 1) L_{s-1} ... L_1
// divided by the length of L_s, without the part along A, which the normalization removes.
void linearize_turn(Derivatives& d, uint32_t lane_number) {
  const Rig& rig = *d.rig;
  const RotationTable& table = rig.rotations;
  const size_t block = lane_number / kBlockLanes, lane = lane_number % kBlockLanes;
  const size_t first = table.first_steps[block];
  const size_t of_lod = size_t{d.lod} * table.block_count() + block;
  const auto steps = static_cast<size_t>(table.lane_steps_at_lod[of_lod * kBlockLanes + lane]);
  const auto weight_of = [&](size_t s) {
    const double w = d.values[table.columns[(first + s) * kBlockLanes + lane]];
    return w > -1e7 ? std::min(w, 1e7) : -1e7;
  };
  const auto factor_of = [&](size_t s, double& length) {
    const Product q = step_value(rig, first + s, lane);
    const double w = weight_of(s);
    const Product f = {w * q.x, w * q.y, w * q.z, w * q.w + (1 - w)};
    length = length_of(f);
    return Product{f.x / length, f.y / length, f.z / length, f.w / length};
  };
  Product product;
  for (size_t s = 0; s < steps; ++s) {
    double* prefix = d.turn_prefixes.data + s * 4;
    prefix[0] = product.x;
    prefix[1] = product.y;
    prefix[2] = product.z;
    prefix[3] = product.w;
    double length;
    product = factor_of(s, length) * product;
  }
  const float unit[4] = {static_cast<float>(product.x), static_cast<float>(product.y),
                         static_cast<float>(product.z), static_cast<float>(product.w)};
  float to_output[16];
  output_slopes(rig, made_unit(variables<4>(unit)), to_output);
  Product after;
  for (size_t s = steps; s-- > 0;) {
    const double* prefix = d.turn_prefixes.data + s * 4;
    double length;
    const Product factor = factor_of(s, length);
    const Product q = step_value(rig, first + s, lane);
    const Product change = after * (Product{q.x, q.y, q.z, q.w - 1} *
                                    Product{prefix[0], prefix[1], prefix[2], prefix[3]});
    const double by[4] = {change.x / length, change.y / length, change.z / length,
                          change.w / length};
    float* slopes = d.turn_slopes.data + ((first + s) * kBlockLanes + lane) * 4;
    for (int r = 0; r < 4; ++r) {
      double slope = 0;
      for (int k = 0; k < 4; ++k) slope += to_output[4 * r + k] * by[k];
      slopes[r] = saturated(slope);
    }
    after = after * factor;
  }
}

// Twists and swings -------------------------------------------------------------------------------

using Turn4 = DualQuaternion<4>;

/// From q (t = 0) to the identity (t = 1), the short way.
Turn4 slerp_to_identity(const Turn4& q, double t) {
  const double sign = q.w.value < 0 ? -1 : 1;
  const Dual<4> c = sign * q.w;
  Dual<4> from = 1 - t, to = t;
  if (c.value <= 1 - 1.0 / (1 << 23)) {
    const Dual<4> angle = arc_cosine(c);
    const Dual<4> scale = Dual<4>(1.0) / square_root((Dual<4>(1.0) - c) * (Dual<4>(1.0) + c));
    from = sine((1 - t) * angle) * scale;
    to = sine(t * angle) * scale;
  }
  return {from * q.x, from * q.y, from * q.z, from * q.w + sign * to};
}

// docs/rig-evaluation.md, 7. The axis u is 1 for the twist, -1 for its inverse.
void linearize_twist(Derivatives& d, uint32_t lane_number) {
  const Rig& rig = *d.rig;
  const TwistSwingTable& table = rig.twist_swing;
  const size_t block = lane_number / kBlockLanes, lane = lane_number % kBlockLanes;
  const auto row = [&](size_t r) {
    return double{table.lanes[(block * kTwistSwingRows + r) * kBlockLanes + lane]};
  };
  float in[4];
  for (size_t k = 0; k < 4; ++k) {
    in[k] = d.values[table.inputs[(block * 4 + k) * kBlockLanes + lane]];
  }
  Turn4 q = variables<4>(in);
  const double squared = squared_length(q).value;
  if (squared > 0 && !(squared > 1e-18 && squared < 1e18)) q = made_unit(q);
  Turn4 twist = {row(0) * q.x, row(1) * q.y, row(2) * q.z, q.w};
  if (squared_length(twist).value > 0) {
    const Dual<4> scale = Dual<4>(1.0) / square_root(squared_length(twist));
    twist = {twist.x * scale, twist.y * scale, twist.z * scale, twist.w * scale};
  } else {
    twist = {};
  }
  const double blend = row(3);
  Turn4 result;
  if (row(4) > 0) {
    const Turn4 whole = q * twist;
    const Dual<4> length = squared_length(whole);
    Turn4 rest;
    if (length.value > 0) {
      rest = {-1.0 * whole.x / length, -1.0 * whole.y / length, -1.0 * whole.z / length,
              whole.w / length};
    }
    result = twist * slerp_to_identity(rest, blend);
  } else {
    result = slerp_to_identity(twist, blend);
  }
  output_slopes(rig, result, d.twist_slopes.data + size_t{lane_number} * 16);
}

// ML joints ---------------------------------------------------------------------------------------

/// The rotation of a joint from its output before, y, and the controls x: slopes by x [4][4], by y [4][4].
void linearize_ml_joint(Derivatives& d, const Instance& instance, size_t index) {
  const Rig& rig = *d.rig;
  const MlJoint& joint = rig.ml.joints[index];
  if (joint.rotation_control == kNoControl) return;
  float* const by_x = d.ml_joint_slopes.data + index * 32;
  float* const by_y = by_x + 16;
  const float* x = d.values.data + joint.rotation_control;
  Turn4 turn;
  if (rig.ml.quaternion_rotations) {
    turn = made_unit(variables<4>(x));
  } else {
    const Dual<4> angles[3] = {Dual<4>::variable(x[0], 0), Dual<4>::variable(x[1], 1),
                               Dual<4>::variable(x[2], 2)};
    turn = from_angles(rig.rotation, angles);
  }
  std::fill(by_x, by_x + 32, 0.0f);
  if (!rig.quaternion_outputs) {
    for (int i = 0; i < 3; ++i) by_y[5 * i] = 1.0f;
    if (!rig.ml.quaternion_rotations) {
      for (int i = 0; i < 3; ++i) by_x[5 * i] = 1.0f;
    } else {
      output_slopes(rig, turn, by_x);
    }
    return;
  }
  const float* now = instance.joints.data + rotation_value(rig, joint.joint);
  const Turn4 back = {-turn.x.value, -turn.y.value, -turn.z.value, turn.w.value};
  const Turn4 before = back * Turn4{now[0], now[1], now[2], now[3]};
  const float y[4] = {static_cast<float>(before.x.value), static_cast<float>(before.y.value),
                      static_cast<float>(before.z.value), static_cast<float>(before.w.value)};
  output_slopes(rig, turn * Turn4{y[0], y[1], y[2], y[3]}, by_x);
  output_slopes(
      rig, Turn4{turn.x.value, turn.y.value, turn.z.value, turn.w.value} * variables<4>(y), by_y);
}

bool runs(const Derivatives& d, const MlJoint& joint) { return is_at_lod(joint.lods, d.lod); }

uint32_t parts_of_output(const Rig& rig) { return rig.quaternion_outputs ? 4 : 3; }

template <uint32_t L>
void clear_rotation(const Rig& rig, float* rotation) {
  for (uint32_t r = 0; r < parts_of_output(rig); ++r) clear<L>(rotation + size_t{r} * L);
}

}  // namespace

/// The sums of a rotation's parts, apart from the buffers: compilers must assume that those overlap. Not in the
/// unnamed namespace, because what for_each_step() takes captures it.
template <uint32_t L>
struct RotationSums {
  const uint32_t count;
  float parts[4][L] = {};

  explicit RotationSums(const Rig& rig) : count(parts_of_output(rig)) {}
  /// Adds one input times its slopes by part, `stride` apart.
  void add(const float* input, const float* slopes, size_t stride) {
    // All four of a single direction, which takes no loop.
    const size_t n = L == 1 ? 4 : count;
    for (size_t r = 0; r < n; ++r) add_scaled<L>(parts[r], input, slopes[r * stride]);
  }
  void store(float* rotation) const {
    for (size_t r = 0; r < count; ++r) std::copy(parts[r], parts[r] + L, rotation + r * L);
  }
};

void convert_rotation_slopes(Derivatives& d, float* x, float* slopes) {
  const Rig& rig = *d.rig;
  const CoordinateChange& change = rig.ml.change;
  std::fill(slopes, slopes + 16, 0.0f);
  Dual<4> out[4];
  if (rig.ml.quaternion_rotations) {
    const Turn4 q = made_unit(variables<4>(x));
    const Dual<4>* parts[] = {&q.x, &q.y, &q.z};
    for (int i = 0; i < 3; ++i) out[i] = double{change.turn[i]} * *parts[change.from[i]];
    out[3] = q.w;
  } else if (change.carries_angles) {
    for (int i = 0; i < 3; ++i) {
      out[i] = change.angle[i] * Dual<4>::variable(x[change.from[i]], change.from[i]);
    }
  } else {
    const Dual<4> angles[3] = {Dual<4>::variable(x[0], 0), Dual<4>::variable(x[1], 1),
                               Dual<4>::variable(x[2], 2)};
    const Turn4 q = from_angles(rig.ml.rotation, angles);
    const Dual<4>* parts[] = {&q.x, &q.y, &q.z};
    Turn4 changed;
    changed.x = double{change.turn[0]} * *parts[change.from[0]];
    changed.y = double{change.turn[1]} * *parts[change.from[1]];
    changed.z = double{change.turn[2]} * *parts[change.from[2]];
    changed.w = q.w;
    to_angles(rig.rotation, changed, out);
  }
  const int parts = rig.ml.quaternion_rotations ? 4 : 3;
  for (int r = 0; r < parts; ++r) {
    x[r] = static_cast<float>(out[r].value);
    for (int i = 0; i < 4; ++i) slopes[4 * r + i] = static_cast<float>(out[r].by[i]);
  }
}

void linearize_rotations(Derivatives& d, const Instance& instance) {
  const Rig& rig = *d.rig;
  for_each_output(rig.rotations.turns, d.lod, turn_blocks(rig, d.lod),
                  [&](const RotationOutput& output) { linearize_turn(d, output.lane); });
  for_each_angle_joint(rig, d.lod, [&](uint32_t joint) {
    const float* angles =
        instance.joints_and_angles.data + rig.joint_value_count() + size_t{joint} * 3;
    const Dual<3> three[3] = {Dual<3>::variable(angles[0], 0), Dual<3>::variable(angles[1], 1),
                              Dual<3>::variable(angles[2], 2)};
    output_slopes(rig, from_angles(rig.rotation, three), d.angle_slopes.data + size_t{joint} * 12);
  });
  for_each_output(rig.twist_swing.outputs, d.lod, twist_blocks(rig, d.lod),
                  [&](const RotationOutput& output) { linearize_twist(d, output.lane); });
  for (size_t j = 0; j < rig.ml.joints.count; ++j) {
    if (runs(d, rig.ml.joints[j])) linearize_ml_joint(d, instance, j);
  }
}

template <uint32_t L>
void push_rotations(Derivatives& d) {
  const Rig& rig = *d.rig;
  const uint32_t parts = parts_of_output(rig);
  const float* const x = d.controls.data;
  for_each_output(rig.rotations.turns, d.lod, turn_blocks(rig, d.lod),
                  [&](const RotationOutput& output) {
                    RotationSums<L> sums(rig);
                    for_each_step(rig, d.lod, output.lane, [&](uint16_t control, size_t step) {
                      sums.add(x + size_t{control} * L, d.turn_slopes.data + step * 4, 1);
                    });
                    sums.store(d.joints.data + rotation_value(rig, output.joint) * L);
                  });
  for_each_angle_joint(rig, d.lod, [&](uint32_t joint) {
    const float* angles = d.joints.data + (rig.joint_value_count() + size_t{joint} * 3) * L;
    const float* slopes = d.angle_slopes.data + size_t{joint} * 12;
    RotationSums<L> sums(rig);
    for (size_t k = 0; k < 3; ++k) sums.add(angles + k * L, slopes + k, 3);
    sums.store(d.joints.data + rotation_value(rig, joint) * L);
  });
  for_each_output(rig.twist_swing.outputs, d.lod, twist_blocks(rig, d.lod),
                  [&](const RotationOutput& output) {
                    const float* slopes = d.twist_slopes.data + size_t{output.lane} * 16;
                    RotationSums<L> sums(rig);
                    for (size_t k = 0; k < 4; ++k) {
                      const size_t control = twist_input(rig.twist_swing, output.lane, k);
                      sums.add(x + control * L, slopes + k, 4);
                    }
                    sums.store(d.joints.data + rotation_value(rig, output.joint) * L);
                  });
  for (size_t j = 0; j < rig.ml.joints.count; ++j) {
    const MlJoint& joint = rig.ml.joints[j];
    if (!runs(d, joint)) continue;
    float* const out = d.joints.data + size_t{joint.joint} * rig.joint_attributes * L;
    float* const scale = out + size_t{rig.joint_attributes - 3} * L;
    for (uint32_t i = 0; i < 3; ++i) {
      if (joint.translation[i] != kNoControl)
        add_scaled<L>(out + size_t{i} * L, x + size_t{joint.translation[i]} * L, 1.0f);
      if (joint.scale[i] != kNoControl)
        add_scaled<L>(scale + size_t{i} * L, x + size_t{joint.scale[i]} * L, 1.0f);
    }
    if (joint.rotation_control == kNoControl) continue;
    const float* by_x = d.ml_joint_slopes.data + j * 32;
    const float* by_y = by_x + 16;
    float before[4][L];
    for (uint32_t r = 0; r < parts; ++r) take<L>(before[r], out + (3 + size_t{r}) * L);
    const uint32_t inputs = rig.ml.quaternion_rotations ? 4 : 3;
    for (uint32_t r = 0; r < parts; ++r) {
      float* to = out + (3 + size_t{r}) * L;
      for (uint32_t k = 0; k < parts; ++k) add_scaled<L>(to, before[k], by_y[4 * r + k]);
      for (uint32_t k = 0; k < inputs; ++k) {
        add_scaled<L>(to, x + (size_t{joint.rotation_control} + k) * L, by_x[4 * r + k]);
      }
    }
  }
}

template <uint32_t L>
void pull_rotations(Derivatives& d) {
  const Rig& rig = *d.rig;
  const uint32_t parts = parts_of_output(rig);
  float* const x = d.controls.data;
  for (size_t j = rig.ml.joints.count; j-- > 0;) {
    const MlJoint& joint = rig.ml.joints[j];
    if (!runs(d, joint)) continue;
    float* const out = d.joints.data + size_t{joint.joint} * rig.joint_attributes * L;
    float* const scale = out + size_t{rig.joint_attributes - 3} * L;
    for (uint32_t i = 0; i < 3; ++i) {
      if (joint.translation[i] != kNoControl)
        add_scaled<L>(x + size_t{joint.translation[i]} * L, out + size_t{i} * L, 1.0f);
      if (joint.scale[i] != kNoControl)
        add_scaled<L>(x + size_t{joint.scale[i]} * L, scale + size_t{i} * L, 1.0f);
    }
    if (joint.rotation_control == kNoControl) continue;
    const float* by_x = d.ml_joint_slopes.data + j * 32;
    const float* by_y = by_x + 16;
    float after[4][L];
    for (uint32_t r = 0; r < parts; ++r) take<L>(after[r], out + (3 + size_t{r}) * L);
    const uint32_t inputs = rig.ml.quaternion_rotations ? 4 : 3;
    for (uint32_t r = 0; r < parts; ++r) {
      for (uint32_t k = 0; k < parts; ++k) {
        add_scaled<L>(out + (3 + size_t{k}) * L, after[r], by_y[4 * r + k]);
      }
      for (uint32_t k = 0; k < inputs; ++k) {
        add_scaled<L>(x + (size_t{joint.rotation_control} + k) * L, after[r], by_x[4 * r + k]);
      }
    }
  }
  for_each_output_backwards(
      rig.twist_swing.outputs, d.lod, twist_blocks(rig, d.lod), [&](const RotationOutput& output) {
        float* from = d.joints.data + rotation_value(rig, output.joint) * L;
        const float* slopes = d.twist_slopes.data + size_t{output.lane} * 16;
        for (uint32_t r = 0; r < parts; ++r) {
          for (uint32_t k = 0; k < 4; ++k) {
            add_scaled<L>(x + size_t{twist_input(rig.twist_swing, output.lane, k)} * L,
                          from + size_t{r} * L, slopes[4 * r + k]);
          }
        }
        clear_rotation<L>(rig, from);
      });
  // A joint has its angles from one group; more than one writes the same.
  for_each_angle_joint(rig, d.lod, [&](uint32_t joint) {
    float* from = d.joints.data + rotation_value(rig, joint) * L;
    float* angles = d.joints.data + (rig.joint_value_count() + size_t{joint} * 3) * L;
    const float* slopes = d.angle_slopes.data + size_t{joint} * 12;
    for (uint32_t r = 0; r < 4; ++r) {
      for (uint32_t k = 0; k < 3; ++k) {
        add_scaled<L>(angles + size_t{k} * L, from + size_t{r} * L, slopes[3 * r + k]);
      }
    }
    clear_rotation<L>(rig, from);
  });
  for_each_output_backwards(
      rig.rotations.turns, d.lod, turn_blocks(rig, d.lod), [&](const RotationOutput& output) {
        float* from = d.joints.data + rotation_value(rig, output.joint) * L;
        for_each_step(rig, d.lod, output.lane, [&](uint16_t control, size_t step) {
          const float* slopes = d.turn_slopes.data + step * 4;
          for (uint32_t r = 0; r < parts; ++r) {
            add_scaled<L>(x + size_t{control} * L, from + size_t{r} * L, slopes[r]);
          }
        });
        clear_rotation<L>(rig, from);
      });
}

template void push_rotations<1>(Derivatives&);
template void push_rotations<kBatchLanes>(Derivatives&);
template void pull_rotations<1>(Derivatives&);
template void pull_rotations<kBatchLanes>(Derivatives&);

}  // namespace mien
