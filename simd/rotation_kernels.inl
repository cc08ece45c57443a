// SPDX-License-Identifier: MIT
// Rotations of joints: quaternions and Euler angles, joints represented by quaternions, twists and
// swings. Nothing is fused, so every instruction set gives the same bits.

#pragma once

#include "simd/math.inl"
#include "simd/quad.inl"

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

// The blend is made unit by a true root and division: estimates would bend the joints. With weight 0
// it is the identity, exactly.
inline VecQuaternion blend_with_identity(const VecQuaternion& q, Vec t) {
  const Vec one = broadcast(1.0f);
  const VecQuaternion b = {t * q.x, t * q.y, t * q.z, t * q.w + (one - t)};
  const Vec length = square_root(b.x * b.x + b.y * b.y + b.z * b.z + b.w * b.w);
  const Vec scale = divide(one, length);
  return {b.x * scale, b.y * scale, b.z * scale, b.w * scale};
}

template <class V>
inline LaneQuaternion<V> multiply(const LaneQuaternion<V>& a, const LaneQuaternion<V>& b) {
  return {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

// Controls this large turn no joint any further. Up to 2^24, 1 - weight is exact, so that the
// identity blended with itself never vanishes.
inline Vec bounded(Vec weight) {
  constexpr float kLargest = 1e7f;
  return at_most(at_least(weight, broadcast(-kLargest)), broadcast(kLargest));
}

// Joints represented by quaternions ---------------------------------------------------------------

template <class Value>
inline VecQuaternion product_of_steps(const QuaternionJointArgs& args, size_t block, size_t lane) {
  const size_t first = args.first_steps[block], count = args.step_counts[block];
  const Value* values = static_cast<const Value*>(args.values) + first * 4 * kBlockLanes + lane;
  const uint16_t* columns = args.columns + first * kBlockLanes + lane;
  const Vec zero = broadcast(0.0f), lane_steps = load(args.lane_steps + block * kBlockLanes + lane);
  VecQuaternion product = {zero, zero, zero, broadcast(1.0f)};
  for (size_t s = 0; s < count; ++s, values += 4 * kBlockLanes, columns += kBlockLanes) {
    const Mask used = less(broadcast(static_cast<float>(s)), lane_steps);
    const Vec weight = keep(used, bounded(gather(args.controls, columns)));
    if (!any(less(zero, absolute(weight)))) continue;  // identities
    product = multiply(blend_with_identity(load_quaternion(values), weight), product);
  }
  // Products with identities, which others may skip, differ in the sign of zeros.
  return {product.x + zero, product.y + zero, product.z + zero, product.w + zero};
}

template <class Value>
void turn(const QuaternionJointArgs& args) {
  for (size_t block = 0; block < args.block_count; ++block) {
    for (size_t lane = 0; lane < kBlockLanes; lane += kWidth) {
      const VecQuaternion q = product_of_steps<Value>(args, block, lane);
      float* out = args.rotations + block * 4 * kBlockLanes + lane;
      store(out, q.x);
      store(out + kBlockLanes, q.y);
      store(out + 2 * kBlockLanes, q.z);
      store(out + 3 * kBlockLanes, q.w);
    }
  }
}

void quaternion_joints(const QuaternionJointArgs& args) {
  args.halves ? turn<uint16_t>(args) : turn<float>(args);
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
/// where there are as many.
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
  const V wy = w * y - x * z, cosine = square_root(n1) * square_root(n2);
  const V second = arc_tangent(wy + wy, cosine) * parity;
  const V uu = u1 * u2, uv = u2 * v1, vu = u1 * v2, vv = v1 * v2;
  const V first = arc_tangent(vu + uv, uu - vv);
  // At a pole one pair is left, and with it a - c or a + c.
  constexpr float kPole = 1e-7f;
  const auto pole = less(cosine, (n1 + n2) * M::of(0.5f * kPole));
  const auto upper = less(n2, n1);
  const V u = select(upper, u1, u2), v = select(upper, zero - v1, v2), twice = u * v;
  const V third =
      arc_tangent(select(pole, twice + twice, vu - uv), select(pole, (u - v) * (u + v), uu + vv));
  const V angles[3] = {select(pole, zero, first), second, third};
  for (size_t i = 0; i < 3; ++i) {
    const size_t axis = form.axes[i];
    L::put(to, axis, angles[i] * M::of(form.from_radians[axis]));
  }
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

/// From q (t = 0) to the identity (t = 1) and beyond, the short way.
template <class V>
[[gnu::always_inline]] inline LaneQuaternion<V> slerp_to_identity(const LaneQuaternion<V>& q, V t) {
  using M = Make<V>;
  constexpr float kParallel = 1.0f - 1.0f / (1 << 23);
  const V zero = M::of(0.0f), one = M::of(1.0f);
  const V c = absolute(q.w), s = one - t, angle = arc_cosine(c);
  const V sine = square_root((one - c) * (one + c));
  V from_sine, to_sine, cosine;
  sine_cosine(s * angle, from_sine, cosine);
  sine_cosine(t * angle, to_sine, cosine);
  const auto parallel = less(M::of(kParallel), c);
  const V from = select(parallel, s, divide(from_sine, sine));
  const V to = select(parallel, t, divide(to_sine, sine));
  return {q.x * from, q.y * from, q.z * from, q.w * from + select(less(q.w, zero), zero - to, to)};
}

/// conjugate / squared length; the identity for 0.
template <class V>
inline LaneQuaternion<V> inverse(const LaneQuaternion<V>& q) {
  const V zero = Make<V>::of(0.0f), squared = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  const auto has = less(zero, squared);
  return {keep(has, divide(zero - q.x, squared)), keep(has, divide(zero - q.y, squared)),
          keep(has, divide(zero - q.z, squared)),
          select(has, divide(q.w, squared), Make<V>::of(1.0f))};
}

constexpr float kShortest = 1e-18f, kLongest = 1e18f;  // squared

/// The squares of what is far from unit length would overflow, or vanish: it is made unit.
template <class V>
[[gnu::noinline]] void bound_lanes(LaneQuaternion<V>& q) {
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
}

template <class V>
inline LaneQuaternion<V> bounded(LaneQuaternion<V> q) {
  using M = Make<V>;
  const V zero = M::of(0.0f), squared = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  const V size = absolute(q.x) + absolute(q.y) + absolute(q.z) + absolute(q.w);
  const V small = select(less(M::of(kShortest), squared), zero, size);
  const V far = select(less(squared, M::of(kLongest)), small, M::of(1.0f));
  if (__builtin_expect(any(less(zero, far)), false)) bound_lanes(q);
  return q;
}

/// Calls f(vector) for the one or two that V is.
template <class V, class F>
inline V each_vector(F&& f) {
  if constexpr (sizeof(V) == sizeof(Vec)) {
    return f(0);
  } else {
    return {f(0), f(1)};
  }
}

/// What one vector waits for, another has ready: two together take little longer than one.
template <class V>
[[gnu::always_inline]] inline void twist_swing_lanes(const TwistSwingArgs& args, size_t lane) {
  using M = Make<V>;
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
  const V zero = M::of(0.0f), one = M::of(1.0f);
  const auto q = bounded(LaneQuaternion<V>{input(0), input(1), input(2), input(3)});
  LaneQuaternion<V> twist = {q.x * row(0), q.y * row(1), q.z * row(2), q.w};
  const V squared = twist.x * twist.x + twist.y * twist.y + twist.z * twist.z + twist.w * twist.w;
  const V length = square_root(squared);
  const auto has = less(zero, squared), swing = less(zero, row(4));
  twist = {keep(has, divide(twist.x, length)), keep(has, divide(twist.y, length)),
           keep(has, divide(twist.z, length)), select(has, divide(twist.w, length), one)};
  const auto rest = inverse(multiply(q, twist));
  const auto part = slerp_to_identity(
      LaneQuaternion<V>{select(swing, rest.x, twist.x), select(swing, rest.y, twist.y),
                        select(swing, rest.z, twist.z), select(swing, rest.w, twist.w)},
      row(3));
  const LaneQuaternion<V> before = {keep(swing, twist.x), keep(swing, twist.y),
                                    keep(swing, twist.z), select(swing, twist.w, one)};
  const auto out = multiply(before, part);
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

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
