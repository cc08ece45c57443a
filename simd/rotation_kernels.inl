// SPDX-License-Identifier: MIT
// Rotations of joints: quaternions and Euler angles, joints represented by quaternions, twists and
// swings. Nothing is fused, so every instruction set gives the same bits.

#pragma once

#include "simd/math.inl"
#include "simd/quad.inl"
#include "simd/rotation_kernels.h"

namespace mien::MIEN_KERNEL_ISA {
namespace {

template <class V>
struct LaneQuaternion {
  V x, y, z, w;
};
using VecQuaternion = LaneQuaternion<Vec>;

inline VecQuaternion load_quaternion(const float* at) {
  return {load(at), load(at + kBlockLanes), load(at + 2 * kBlockLanes), load(at + 3 * kBlockLanes)};
}
inline VecQuaternion load_quaternion(const uint16_t* at) {
  return {load_half(at), load_half(at + kBlockLanes), load_half(at + 2 * kBlockLanes),
          load_half(at + 3 * kBlockLanes)};
}

/// With a true root and division: estimates would bend the joints.
template <class V>
inline LaneQuaternion<V> made_unit(const LaneQuaternion<V>& q) {
  const V length = square_root(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  const V scale = divide(Make<V>::of(1.0f), length);
  return {q.x * scale, q.y * scale, q.z * scale, q.w * scale};
}

template <class V>
inline LaneQuaternion<V> multiply(const LaneQuaternion<V>& a, const LaneQuaternion<V>& b) {
  return {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

// Joints represented by quaternions ---------------------------------------------------------------

// Larger controls turn no joint any further. Up to 2^24, 1 - weight is exact, so that the identity blended
// with itself never vanishes.
template <class V>
inline V bounded(V weight) {
  constexpr float kLargest = 1e7f;
  return at_most(at_least(weight, Make<V>::of(-kLargest)), Make<V>::of(kLargest));
}

// Blends with weights of 0 to 1 have lengths of 0.7 to 1, so their product is normalized at the end, and
// after this number of steps. With other weights it is normalized at once.
constexpr size_t kStepsUntilUnit = 32;

/// The product, so far, of the steps of some joints or characters. The result of a lane depends on that lane
/// alone.
template <class V>
struct Turn {
  using M = Make<V>;
  LaneQuaternion<V> product = {M::of(0.0f), M::of(0.0f), M::of(0.0f), M::of(1.0f)};

  /// Turns by the quaternion blended with the identity. With weight 0 that is the identity, exactly.
  void add(const LaneQuaternion<V>& q, V weight) {
    const V one = M::of(1.0f), half = M::of(0.5f);
    product = multiply({weight * q.x, weight * q.y, weight * q.z, weight * q.w + (one - weight)},
                       product);
    const auto beyond = less(half, absolute(weight - half));
    if (__builtin_expect(any(beyond), false)) make_unit(beyond);
  }
  template <class Lanes>
  void make_unit(const Lanes& lanes) {
    const LaneQuaternion<V> unit = made_unit(product);
    product = {select(lanes, unit.x, product.x), select(lanes, unit.y, product.y),
               select(lanes, unit.z, product.z), select(lanes, unit.w, product.w)};
  }
  void put(float* out) const {
    const LaneQuaternion<V> unit = made_unit(product);
    store(out, without_sign_of_zero(unit.x));
    store(out + kBlockLanes, without_sign_of_zero(unit.y));
    store(out + 2 * kBlockLanes, without_sign_of_zero(unit.z));
    store(out + 3 * kBlockLanes, without_sign_of_zero(unit.w));
  }
  // -0 becomes 0: products with identities, which others may skip, differ in it. (0 + -0 depends on the
  // rounding mode.)
  static V without_sign_of_zero(V v) { return keep(less(M::of(0.0f), absolute(v)), v); }
};

template <class Value>
inline void turn_joints(const QuaternionJointArgs& args, size_t block, size_t lane) {
  const size_t first = args.first_steps[block], count = args.step_counts[block];
  const Value* values = static_cast<const Value*>(args.values) + first * 4 * kBlockLanes + lane;
  const uint16_t* columns = args.columns + first * kBlockLanes + lane;
  const Vec zero = broadcast(0.0f), lane_steps = load(args.lane_steps + block * kBlockLanes + lane);
  Turn<Vec> turn;
  for (size_t s = 0; s < count; ++s, values += 4 * kBlockLanes, columns += kBlockLanes) {
    const Mask used = less(broadcast(static_cast<float>(s)), lane_steps);
    const Vec weight = keep(used, bounded(gather(args.controls, columns)));
    if (any(less(zero, absolute(weight)))) turn.add(load_quaternion(values), weight);
    if (s % kStepsUntilUnit == kStepsUntilUnit - 1) turn.make_unit(used);
  }
  turn.put(args.rotations + block * 4 * kBlockLanes + lane);
}

template <class Value>
void turn_joints(const QuaternionJointArgs& args) {
  for (size_t block = 0; block < args.block_count; ++block) {
    for (size_t lane = 0; lane < kBlockLanes; lane += kWidth) turn_joints<Value>(args, block, lane);
  }
}

void quaternion_joints(const QuaternionJointArgs& args) {
  args.halves ? turn_joints<uint16_t>(args) : turn_joints<float>(args);
}

// Euler angles ------------------------------------------------------------------------------------

/// Rows of a block, of one vector or two.
template <class V>
struct Lanes {
  using M = Make<V>;
  static V row(const float* at, size_t row) { return M::from(at + row * kBlockLanes); }
  static void put(float* at, size_t row, V value) { store(at + row * kBlockLanes, value); }
};

/// Calls f(first lane in memory of `rows` rows, Make<V>) for the vectors of `count` lanes, two at a time
/// where there are two.
template <class F>
inline void for_each_vector(size_t count, size_t rows, F&& f) {
  constexpr bool kPairsFit = 2 * kWidth <= kBlockLanes;
  for (size_t i = 0; i < count;) {
    const size_t at = i / kBlockLanes * rows * kBlockLanes + i % kBlockLanes;
    if constexpr (kPairsFit) {
      if (i + kWidth < count) {
        f(at, Make<VecPair>());
        i += 2 * kWidth;
        continue;
      }
    }
    f(at, Make<Vec>());
    i += kWidth;
  }
}

/// With half angles a, b, c and the sequence xyz:
///
///     w + y = (cos b + sin b) cos(a - c)        x - z = (cos b + sin b) sin(a - c)
///     w - y = (cos b - sin b) cos(a + c)        x + z = (cos b - sin b) sin(a + c)
///
/// These four are accurate near the poles too, where one pair vanishes; matrices would need double
/// precision there. Products of pairs give the sines and cosines of 2a and 2c, and the product of their
/// lengths the cosine of 2b. Other sequences turn about other axes, and odd ones against y.
template <class V>
[[gnu::always_inline]] inline void angles_of(const EulerForm& form, const float* from, float* to) {
  using M = Make<V>;
  using L = Lanes<V>;
  const V parity = M::of(form.parity), zero = M::of(0.0f);
  const V x = L::row(from, form.axes[0]), y = L::row(from, form.axes[1]) * parity;
  const V z = L::row(from, form.axes[2]), w = L::row(from, 3);
  const V u1 = w + y, v1 = x - z, u2 = w - y, v2 = x + z;
  const V n1 = u1 * u1 + v1 * v1, n2 = u2 * u2 + v2 * v2;
  const V wy = w * y - x * z, cosine = square_root(n1 * n2);
  const V second = arc_tangent_of_right_half(wy + wy, cosine) * parity;
  const V uu = u1 * u2, uv = u2 * v1, vu = u1 * v2, vv = v1 * v2;
  const V first = arc_tangent(vu + uv, uu - vv);
  // At a pole one pair is left, and with it a - c or a + c.
  constexpr float kPole = 1e-7f;
  const auto pole = less(cosine, (n1 + n2) * M::of(0.5f * kPole));
  const auto upper = less(n2, n1);
  const V u = select(upper, u1, u2), v = select(upper, zero - v1, v2), twice = u * v;
  const V third =
      arc_tangent(select(pole, twice + twice, vu - uv), select(pole, (u - v) * (u + v), uu + vv));
  // Single variables: compilers would copy an array through memory, in parts.
  const auto put = [&](size_t axis, V angle) {
    L::put(to, axis, angle * M::of(form.from_radians[axis]));
  };
  put(form.axes[0], select(pole, zero, first));
  put(form.axes[1], second);
  put(form.axes[2], third);
}

void angles_from_quaternions(const EulerArgs& args) {
  for_each_vector(args.count, 4, [&](size_t at, auto make) {
    angles_of<decltype(make.of(0.0f))>(args.form, args.from + at, args.to + at);
  });
}

/// The product of q and, on its left, the rotation about an axis, given sine and cosine of half the
/// angle.
template <class V>
inline void turn_about(size_t axis, V sine, V cosine, V (&q)[4]) {
  const size_t a = axis, b = (a + 1) % 3, c = (a + 2) % 3;
  const V qa = q[a], qb = q[b], qc = q[c], qw = q[3];
  q[a] = cosine * qa + sine * qw;
  q[b] = cosine * qb - sine * qc;
  q[c] = cosine * qc + sine * qb;
  q[3] = cosine * qw - sine * qa;
}

void quaternions_from_angles(const EulerArgs& args) {
  for_each_vector(args.count, 4, [&](size_t at, auto make) {
    using V = decltype(make.of(0.0f));
    using L = Lanes<V>;
    V q[4] = {make.of(0.0f), make.of(0.0f), make.of(0.0f), make.of(1.0f)};
    for (const size_t axis : args.form.axes) {
      V sine, cosine;
      sine_cosine(L::row(args.from + at, axis) * make.of(0.5f * args.form.to_radians[axis]), sine,
                  cosine);
      turn_about(axis, sine, cosine, q);
    }
    for (size_t k = 0; k < 4; ++k) L::put(args.to + at, k, q[k]);
  });
}

// Twists and swings -------------------------------------------------------------------------------

/// Up to a quarter turn the series is enough.
template <class V>
[[gnu::always_inline]] inline V sine_of(V x) {
  const V near = bounded_sine(x);
  const auto far = less(Make<V>::of(kHalfPi), absolute(x));
  if (__builtin_expect(!any(far), true)) return near;
  V sine, cosine;
  sine_cosine(x, sine, cosine);
  return select(far, sine, near);
}

/// From q (t = 0) to the identity (t = 1) and beyond, the short way.
template <class V>
[[gnu::always_inline]] inline LaneQuaternion<V> slerp_to_identity(const LaneQuaternion<V>& q, V t) {
  using M = Make<V>;
  constexpr float kParallel = 1.0f - 1.0f / (1 << 23);
  const V zero = M::of(0.0f), one = M::of(1.0f);
  const V c = absolute(q.w), s = one - t, angle = arc_cosine(c);
  const V scale = divide(one, square_root((one - c) * (one + c)));
  const auto parallel = less(M::of(kParallel), c);
  const V from = select(parallel, s, sine_of(s * angle) * scale);
  const V to = select(parallel, t, sine_of(t * angle) * scale);
  return {q.x * from, q.y * from, q.z * from, q.w * from + select(less(q.w, zero), zero - to, to)};
}

/// conjugate / squared length; the identity for 0.
template <class V>
inline LaneQuaternion<V> inverse(const LaneQuaternion<V>& q) {
  using M = Make<V>;
  const V zero = M::of(0.0f), squared = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  const auto has = less(zero, squared);
  const V scale = divide(M::of(1.0f), squared);
  return {keep(has, (zero - q.x) * scale), keep(has, (zero - q.y) * scale),
          keep(has, (zero - q.z) * scale), select(has, q.w * scale, M::of(1.0f))};
}

constexpr float kShortest = 1e-18f, kLongest = 1e18f;  // squared

/// For lengths far from 1, squares would overflow or vanish: normalizes those.
template <class V>
[[gnu::noinline]] LaneQuaternion<V> bound_lanes(LaneQuaternion<V> q) {
  constexpr size_t kCount = sizeof(V) / sizeof(float);
  alignas(64) float lanes[4][kCount];
  V* const parts[] = {&q.x, &q.y, &q.z, &q.w};
  for (size_t k = 0; k < 4; ++k) store(lanes[k], *parts[k]);
  for (size_t i = 0; i < kCount; ++i) {
    const float x = lanes[0][i], y = lanes[1][i], z = lanes[2][i], w = lanes[3][i];
    const float squared = x * x + y * y + z * z + w * w;
    if (squared > kShortest && squared < kLongest) continue;
    double length = 0;
    for (const auto& part : lanes) length += double{part[i]} * double{part[i]};
    length = __builtin_sqrt(length);
    if ((length > 1e-9 && length < 1e9) || !(length > 0)) continue;
    for (auto& part : lanes) part[i] = static_cast<float>(double{part[i]} / length);
  }
  for (size_t k = 0; k < 4; ++k) *parts[k] = Make<V>::from(lanes[k]);
  return q;
}

template <class V>
inline LaneQuaternion<V> bounded(LaneQuaternion<V> q) {
  using M = Make<V>;
  const V zero = M::of(0.0f), squared = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  const V size = absolute(q.x) + absolute(q.y) + absolute(q.z) + absolute(q.w);
  const V small = select(less(M::of(kShortest), squared), zero, size);
  const V far = select(less(squared, M::of(kLongest)), small, M::of(1.0f));
  if (__builtin_expect(any(less(zero, far)), false)) {
    if constexpr (sizeof(V) == sizeof(Vec)) {
      const LaneQuaternion<V> in = bound_lanes(q);
      return {in.x, in.y, in.z,
              in.w};  // so that q stays in registers, which do not have room for pairs
    } else {
      return bound_lanes(q);
    }
  }
  return q;
}

/// Calls f(vector) for the one or two vectors of V.
template <class V, class F>
inline V each_vector(F&& f) {
  if constexpr (sizeof(V) == sizeof(Vec)) {
    return f(0);
  } else {
    return {f(0), f(1)};
  }
}

/// The twist of q about the axis u, or its swing, blended toward the identity.
template <class V>
[[gnu::always_inline]] inline LaneQuaternion<V> twist_or_swing(LaneQuaternion<V> q, const V (&u)[3],
                                                               V blend, V is_swing) {
  using M = Make<V>;
  const V zero = M::of(0.0f), one = M::of(1.0f);
  q = bounded(q);
  LaneQuaternion<V> twist = {q.x * u[0], q.y * u[1], q.z * u[2], q.w};
  const V squared = twist.x * twist.x + twist.y * twist.y + twist.z * twist.z + twist.w * twist.w;
  const V scale = divide(one, square_root(squared));
  const auto has = less(zero, squared), swing = less(zero, is_swing);
  twist = {keep(has, twist.x * scale), keep(has, twist.y * scale), keep(has, twist.z * scale),
           select(has, twist.w * scale, one)};
  if (!any(swing)) return bounded(slerp_to_identity(twist, blend));
  const auto rest = inverse(multiply(q, twist));
  const auto part = slerp_to_identity(
      LaneQuaternion<V>{select(swing, rest.x, twist.x), select(swing, rest.y, twist.y),
                        select(swing, rest.z, twist.z), select(swing, rest.w, twist.w)},
      blend);
  const auto both = multiply(twist, part);
  return bounded(LaneQuaternion<V>{select(swing, both.x, part.x), select(swing, both.y, part.y),
                                   select(swing, both.z, part.z), select(swing, both.w, part.w)});
}

/// Two vectors hide each other's latency: together they take little longer than one.
template <class V>
[[gnu::always_inline]] inline void twist_swing_lanes(const TwistSwingArgs& args, size_t lane) {
  const auto at = [lane](size_t vec, size_t rows, size_t row) {
    const size_t l = lane + vec * kWidth;
    return (l / kBlockLanes * rows + row) * kBlockLanes + l % kBlockLanes;
  };
  const auto row = [&](size_t r) {
    return each_vector<V>(
        [&](size_t vec) { return load(args.lanes + at(vec, kTwistSwingRows, r)); });
  };
  const auto input = [&](size_t k) {
    return each_vector<V>(
        [&](size_t vec) { return gather(args.controls, args.inputs + at(vec, 4, k)); });
  };
  const auto out = twist_or_swing(LaneQuaternion<V>{input(0), input(1), input(2), input(3)},
                                  {row(0), row(1), row(2)}, row(3), row(4));
  const V* const parts[] = {&out.x, &out.y, &out.z, &out.w};
  for (size_t k = 0; k < 4; ++k) {
    if constexpr (sizeof(V) == sizeof(Vec)) {
      store(args.rotations + at(0, 4, k), *parts[k]);
    } else {
      store(args.rotations + at(0, 4, k), parts[k]->a);
      store(args.rotations + at(1, 4, k), parts[k]->b);
    }
  }
}

void twist_swing(const TwistSwingArgs& args) {
  const size_t count = size_t{args.block_count} * kBlockLanes;
  size_t lane = 0;
  for (; lane + kWidth < count; lane += 2 * kWidth) twist_swing_lanes<VecPair>(args, lane);
  if (lane < count) twist_swing_lanes<Vec>(args, lane);
}

// Batches: lanes are characters, and a joint is the same for all of them --------------------------

/// Calls f(first lane, where its rotation is in rows of quaternions), V lanes at a time.
template <class V, class F>
inline void for_each_lane(size_t count, F&& f) {
  for (size_t i = 0; i < count; i += sizeof(V) / sizeof(float)) {
    f(i, i / kBlockLanes * 4 * kBlockLanes + i % kBlockLanes);
  }
}

inline float value_at(const float* from) { return *from; }
inline float value_at(const uint16_t* from) {
  // As the scalar load_half() of vec.inl.
  return float_of((*from & 0x8000u) << 16 | (*from & 0x7FFFu) << 13) * 0x1p112f;
}

template <class Value>
inline void turn_characters(const QuaternionBatchArgs& args, size_t joint, size_t lane,
                            float* out) {
  const size_t block = joint / kBlockLanes, first = args.first_steps[block];
  const size_t count = args.step_counts[block], joint_lane = joint % kBlockLanes;
  const float steps = args.lane_steps[joint];
  const Value* values =
      static_cast<const Value*>(args.values) + first * 4 * kBlockLanes + joint_lane;
  const uint16_t* columns = args.columns + first * kBlockLanes + joint_lane;
  const Vec zero = broadcast(0.0f);
  Turn<Vec> turn;
  for (size_t s = 0; s < count && static_cast<float>(s) < steps; ++s) {
    const Vec weight = bounded(load(args.controls + size_t{*columns} * kBatchLanes + lane));
    if (any(less(zero, absolute(weight)))) {
      turn.add({broadcast(value_at(values)), broadcast(value_at(values + kBlockLanes)),
                broadcast(value_at(values + 2 * kBlockLanes)),
                broadcast(value_at(values + 3 * kBlockLanes))},
               weight);
    }
    if (s % kStepsUntilUnit == kStepsUntilUnit - 1) turn.product = made_unit(turn.product);
    values += 4 * kBlockLanes;
    columns += kBlockLanes;
  }
  turn.put(out);
}

template <class Value>
void turn_characters(const QuaternionBatchArgs& args) {
  const size_t blocks = (args.lane_count + kBlockLanes - 1) / kBlockLanes;
  for (size_t i = 0; i < args.count; ++i) {
    float* const out = args.rotations + i * blocks * 4 * kBlockLanes;
    // Two vectors at a time would not fit the registers.
    for_each_lane<Vec>(args.lane_count, [&](size_t lane, size_t at) {
      turn_characters<Value>(args, args.first + i, lane, out + at);
    });
  }
}

void quaternion_batch(const QuaternionBatchArgs& args) {
  args.halves ? turn_characters<uint16_t>(args) : turn_characters<float>(args);
}

/// Two vectors where a row of a block has two: they hide each other's latency.
constexpr auto twist_vec() {
  if constexpr (2 * kWidth <= kBlockLanes) {
    return Make<VecPair>();
  } else {
    return Make<Vec>();
  }
}

void twist_swing_batch(const TwistSwingBatchArgs& args) {
  using M = decltype(twist_vec());
  using TwistVec = decltype(M::of(0.0f));
  const size_t blocks = (args.lane_count + kBlockLanes - 1) / kBlockLanes;
  for (size_t i = 0; i < args.count; ++i) {
    float* const out = args.rotations + i * blocks * 4 * kBlockLanes;
    const size_t output = args.first + i, block = output / kBlockLanes;
    const uint16_t* const inputs = args.inputs + block * 4 * kBlockLanes + output % kBlockLanes;
    const float* const lanes =
        args.lanes + block * kTwistSwingRows * kBlockLanes + output % kBlockLanes;
    const auto row = [&](size_t r) { return M::of(lanes[r * kBlockLanes]); };
    for_each_lane<TwistVec>(args.lane_count, [&](size_t lane, size_t at) {
      const auto input = [&](size_t k) {
        return M::from(args.controls + size_t{inputs[k * kBlockLanes]} * kBatchLanes + lane);
      };
      const auto q =
          twist_or_swing(LaneQuaternion<TwistVec>{input(0), input(1), input(2), input(3)},
                         {row(0), row(1), row(2)}, row(3), row(4));
      store(out + at, q.x);
      store(out + at + kBlockLanes, q.y);
      store(out + at + 2 * kBlockLanes, q.z);
      store(out + at + 3 * kBlockLanes, q.w);
    });
  }
}

void scatter_rotation(const float* rotation, uint32_t lane_count, size_t first, bool quaternions,
                      float* const* rows) {
  size_t k = 0;
  for (; k + 4 <= lane_count; k += 4) {
    const float* const at = rotation + k / kBlockLanes * 4 * kBlockLanes + k % kBlockLanes;
    Quad a = load4(at), b = load4(at + kBlockLanes);
    Quad c = load4(at + 2 * kBlockLanes), d = load4(at + 3 * kBlockLanes);
    transpose4(a, b, c, d);
    const Quad* const quads[] = {&a, &b, &c, &d};
    for (size_t i = 0; i < 4; ++i) {
      if (quaternions) {
        store4(rows[k + i] + first, *quads[i]);
      } else {
        store3(rows[k + i] + first, *quads[i]);
      }
    }
  }
  for (; k < lane_count; ++k) {
    const float* const at = rotation + k / kBlockLanes * 4 * kBlockLanes + k % kBlockLanes;
    for (size_t i = 0; i < (quaternions ? 4 : 3); ++i) rows[k][first + i] = at[i * kBlockLanes];
  }
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
