// SPDX-License-Identifier: MIT
// Quads: four floats on every instruction set. A column of a matrix, or a point and a fourth float that is
// ignored.
//
// | name                   | meaning                                                              |
// |------------------------|----------------------------------------------------------------------|
// | load4, store4, store3  | from and to any address; store3 writes the first three; load4 also   |
// |                        | converts 16-bit integers                                             |
// | load2, store2          | two floats; the others are 0, or not written                         |
// | add_sparse4            | to four quads: a weight times three 16-bit integers for each quad    |
// |                        | whose bit of a mask is set                                           |
// | add_sparse_fields4     | the same with three fields of 10 bits in 32, and a weight 2^-22 times|
// |                        | as large                                                             |
// | load_lanes4            | load4 for lane4: one load, not one for each lane                     |
// | broadcast4             | the same float in each lane                                          |
// | + - *                  | rounded once each, never fused                                       |
// | mul_add4, mul_sub4     | a * b + c, a * b - c: fused where mul_add of vec.inl is              |
// | divide4, square_root4  | correctly rounded                                                    |
// | higher4, lower4        | NaN in the first becomes the second                                  |
// | yzx4                   | the first three, turned by one                                       |
// | cross4                 | the cross product of the first three                                 |
// | gather4, scatter4      | lane i from or to place at[i], or at[i * stride]                     |
// | gather                 | a Vec: lane i from place at[i]                                       |
// | lane4<k>               | lane k in each lane                                                  |
// | squared_lengths        | of kWidth quads, 64-byte aligned: a Vec of z * z + (y * y + x * x),  |
// |                        | with mul_add, of the first three lanes of each                       |
// | different_lanes4(a, b) | bit k: the bits of lane k differ                                     |
// | join_bits4(a, b, n)    | the low n bits of a, and above them those of b                       |
// | transpose4             | four quads, rows to columns                                          |
// | QuadPair               | two quads, in one vector where there is one so wide                  |
// | ..._pair4              | load_big_endian of either half, saturate, transpose, store of        |
// |                        | QuadPairs; store to memory aligned to the pair                       |
// | ColumnVec              | neighboring columns of a matrix: a Vec, of the scalar kernels a Quad |
// | ..._column_vec         | load, broadcast, mul_add of ColumnVecs, as in vec.inl                |
// | columns4(m, q)         | the four columns of a matrix in ColumnVecs                           |
//
// Some intrinsics stay. What xsimd 8.1 lacks: single lanes, parts of a vector, the bits of a mask,
// four floats that fuse beside AVX2. On NEON it refines estimates of root and quotient, fuses only
// if a macro of the compiler says so, its min and max keep NaN, and it zips halves.

#pragma once

#include "simd/vec.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

#if defined(MIEN_KERNEL_SCALAR)

struct Quad {
  float v[4];
};
template <class F>
[[gnu::always_inline]] inline Quad lanes4(F&& f) {
  return {{f(0), f(1), f(2), f(3)}};
}
inline Quad load_big_endian4(const uint8_t* from) {
  return lanes4([&](int i) { return load_big_endian(from + 4 * i); });
}
[[gnu::always_inline]] inline Quad load4(const float* from) {
  return {{from[0], from[1], from[2], from[3]}};
}
[[gnu::always_inline]] inline Quad load4(const int16_t* from) {
  return lanes4([&](int i) { return static_cast<float>(from[i]); });
}
[[gnu::always_inline]] inline Quad load_lanes4(const float* from) { return load4(from); }
[[gnu::always_inline]] inline void store4(float* to, const Quad& q) {
  for (int i = 0; i < 4; ++i) to[i] = q.v[i];
}
[[gnu::always_inline]] inline Quad load2(const float* from) { return {{from[0], from[1], 0, 0}}; }
[[gnu::always_inline]] inline void store2(float* to, const Quad& q) {
  for (int i = 0; i < 2; ++i) to[i] = q.v[i];
}
[[gnu::always_inline]] inline void store3(float* to, const Quad& q) {
  for (int i = 0; i < 3; ++i) to[i] = q.v[i];
}
[[gnu::always_inline]] inline Quad broadcast4(float value) {
  return {{value, value, value, value}};
}
[[gnu::always_inline]] inline Quad operator+(const Quad& a, const Quad& b) {
  return lanes4([&](int i) { return a.v[i] + b.v[i]; });
}
[[gnu::always_inline]] inline Quad operator-(const Quad& a, const Quad& b) {
  return lanes4([&](int i) { return a.v[i] - b.v[i]; });
}
[[gnu::always_inline]] inline Quad operator*(const Quad& a, const Quad& b) {
  return lanes4([&](int i) { return a.v[i] * b.v[i]; });
}
[[gnu::always_inline]] inline Quad mul_add4(const Quad& a, const Quad& b, const Quad& c) {
  return a * b + c;
}
[[gnu::always_inline]] inline Quad mul_sub4(const Quad& a, const Quad& b, const Quad& c) {
  return a * b - c;
}
inline Quad divide4(const Quad& a, const Quad& b) {
  return lanes4([&](int i) { return a.v[i] / b.v[i]; });
}
inline Quad square_root4(const Quad& a) {
  return lanes4([&](int i) { return __builtin_sqrtf(a.v[i]); });
}
template <int kLane>
[[gnu::always_inline]] inline Quad lane4(const Quad& a) {
  return broadcast4(a.v[kLane]);
}
inline Quad yzx4(const Quad& a) { return {{a.v[1], a.v[2], a.v[0], a.v[3]}}; }
inline Quad higher4(const Quad& a, const Quad& b) {
  return lanes4([&](int i) { return higher_of(a.v[i], b.v[i]); });
}
inline Quad lower4(const Quad& a, const Quad& b) {
  return lanes4([&](int i) { return lower_of(a.v[i], b.v[i]); });
}
inline Quad gather4(const float* from, const uint16_t* at, size_t stride) {
  return lanes4([&](size_t i) { return from[at[i * stride]]; });
}
inline void scatter4(float* to, const uint16_t* at, const Quad& q) {
  for (size_t i = 0; i < 4; ++i) to[at[i]] = q.v[i];
}
inline uint32_t different_lanes4(const Quad& a, const Quad& b) {
  uint32_t different = 0;
  for (size_t i = 0; i < 4; ++i) different |= different_lanes(a.v[i], b.v[i]) << i;
  return different;
}
inline Quad join_bits4(const Quad& low, const Quad& high, int n) {
  return lanes4([&](int i) {
    return float_of((bits_of(low.v[i]) & ((1u << n) - 1)) | bits_of(high.v[i]) << n);
  });
}
inline void transpose4(Quad& a, Quad& b, Quad& c, Quad& d) {
  const Quad rows[4] = {a, b, c, d};
  Quad* const columns[4] = {&a, &b, &c, &d};
  for (int i = 0; i < 4; ++i) *columns[i] = lanes4([&](int k) { return rows[k].v[i]; });
}
using ColumnVec = Quad;
[[gnu::always_inline]] inline ColumnVec load_column_vec(const float* from) { return load4(from); }
[[gnu::always_inline]] inline ColumnVec broadcast_column_vec(float value) {
  return broadcast4(value);
}
[[gnu::always_inline]] inline ColumnVec mul_add_column_vec(const ColumnVec& a, const ColumnVec& b,
                                                           const ColumnVec& c) {
  return mul_add4(a, b, c);
}
[[gnu::always_inline]] inline void columns4(const ColumnVec* m, Quad* columns) {
  for (int i = 0; i < 4; ++i) columns[i] = m[i];
}

#else

#if defined(MIEN_KERNEL_SSE2) || defined(MIEN_KERNEL_NEON)
using Quad = Vec;
#else
using Quad = xsimd::batch<float, xsimd::sse2>;
#endif
using QuadBits = xsimd::batch<uint32_t, Quad::arch_type>;

inline Quad load4(const float* from) { return Quad::load_unaligned(from); }
inline void store4(float* to, Quad q) { q.store_unaligned(to); }
inline Quad broadcast4(float value) { return Quad(value); }
inline Quad join_bits4(Quad low, Quad high, int n) {
  const QuadBits bits = (xsimd::bitwise_cast<QuadBits>(low) & QuadBits((1u << n) - 1)) |
                        (xsimd::bitwise_cast<QuadBits>(high) << n);
  return xsimd::bitwise_cast<Quad>(bits);
}

#if defined(MIEN_KERNEL_NEON)

inline Quad load4(const int16_t* from) { return vcvtq_f32_s32(vmovl_s16(vld1_s16(from))); }
inline Quad load2(const float* from) { return vcombine_f32(vld1_f32(from), vdup_n_f32(0)); }
inline void store2(float* to, Quad q) { vst1_f32(to, vget_low_f32(q)); }
inline void store3(float* to, Quad q) {
  vst1_f32(to, vget_low_f32(q));
  vst1q_lane_f32(to + 2, q, 2);
}
inline Quad load_lanes4(const float* from) { return load4(from); }
inline Quad load_big_endian4(const uint8_t* from) { return load_big_endian(from); }
inline Quad mul_add4(Quad a, Quad b, Quad c) { return vfmaq_f32(c, a, b); }
inline Quad mul_sub4(Quad a, Quad b, Quad c) { return vfmaq_f32(vnegq_f32(c), a, b); }
inline Quad divide4(Quad a, Quad b) { return divide(a, b); }
inline Quad square_root4(Quad a) { return square_root(a); }
template <int kLane>
inline Quad lane4(Quad a) {
  return vdupq_laneq_f32(a, kLane);
}
inline Quad yzx4(Quad a) { return vextq_f32(vextq_f32(a, a, 3), a, 2); }
inline Quad higher4(Quad a, Quad b) { return at_least(a, b); }
inline Quad lower4(Quad a, Quad b) { return at_most(a, b); }
inline Quad gather4(const float* from, const uint16_t* at, size_t stride) {
  Quad q = Quad(vld1q_dup_f32(from + at[0]));
  q = vld1q_lane_f32(from + at[stride], q, 1);
  q = vld1q_lane_f32(from + at[2 * stride], q, 2);
  return vld1q_lane_f32(from + at[3 * stride], q, 3);
}
inline void scatter4(float* to, const uint16_t* at, Quad q) {
  vst1q_lane_f32(to + at[0], q, 0);
  vst1q_lane_f32(to + at[1], q, 1);
  vst1q_lane_f32(to + at[2], q, 2);
  vst1q_lane_f32(to + at[3], q, 3);
}
inline uint32_t different_lanes4(Quad a, Quad b) { return different_lanes(a, b); }
inline void transpose4(Quad& a, Quad& b, Quad& c, Quad& d) {
  const float32x4x2_t ab = vtrnq_f32(a, b), cd = vtrnq_f32(c, d);
  a = vcombine_f32(vget_low_f32(ab.val[0]), vget_low_f32(cd.val[0]));
  b = vcombine_f32(vget_low_f32(ab.val[1]), vget_low_f32(cd.val[1]));
  c = vcombine_f32(vget_high_f32(ab.val[0]), vget_high_f32(cd.val[0]));
  d = vcombine_f32(vget_high_f32(ab.val[1]), vget_high_f32(cd.val[1]));
}

#else

inline Quad load4(const int16_t* from) {
  const __m128i narrow = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(from));
#if defined(MIEN_KERNEL_SSE2)
  return _mm_cvtepi32_ps(_mm_srai_epi32(_mm_unpacklo_epi16(narrow, narrow), 16));
#else
  return _mm_cvtepi32_ps(_mm_cvtepi16_epi32(narrow));
#endif
}
inline Quad load2(const float* from) {
  return _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from)));
}
inline void store2(float* to, Quad q) { _mm_storel_pi(reinterpret_cast<__m64*>(to), q); }
inline void store3(float* to, Quad q) {
  _mm_storel_pi(reinterpret_cast<__m64*>(to), q);
  _mm_store_ss(to + 2, _mm_movehl_ps(q, q));
}
#if defined(MIEN_KERNEL_SSE2)
inline Quad load_big_endian4(const uint8_t* from) { return load_big_endian(from); }
inline Quad mul_add4(Quad a, Quad b, Quad c) { return a * b + c; }
inline Quad mul_sub4(Quad a, Quad b, Quad c) { return a * b - c; }
#else
inline Quad mul_add4(Quad a, Quad b, Quad c) { return _mm_fmadd_ps(a, b, c); }
inline Quad mul_sub4(Quad a, Quad b, Quad c) { return _mm_fmsub_ps(a, b, c); }
#endif
inline Quad load_lanes4(const float* from) {
  Quad q = load4(from);
#if !defined(MIEN_KERNEL_SSE2)
  __asm__("" : "+x"(q.data));  // makes the compiler forget that it came from memory
#endif
  return q;
}
template <int kLane>
inline Quad lane4(Quad a) {
  return _mm_shuffle_ps(a, a, 0x55 * kLane);
}
inline Quad divide4(Quad a, Quad b) { return a / b; }
inline Quad square_root4(Quad a) { return xsimd::sqrt(a); }
inline Quad yzx4(Quad a) {
  return xsimd::swizzle(a, xsimd::batch_constant<QuadBits, 1, 2, 0, 3>());
}
#if defined(__wasm__)
inline Quad higher4(Quad a, Quad b) { return at_least(a, b); }
inline Quad lower4(Quad a, Quad b) { return at_most(a, b); }
#else
inline Quad higher4(Quad a, Quad b) { return xsimd::max(a, b); }
inline Quad lower4(Quad a, Quad b) { return xsimd::min(a, b); }
#endif
inline Quad gather4(const float* from, const uint16_t* at, size_t stride) {
  float first = from[at[0]];
#if defined(__wasm__)
  // Clang 14 would otherwise move this load after the stores that follow.
  __asm__("" : "+r"(first));
#endif
  return _mm_setr_ps(first, from[at[stride]], from[at[2 * stride]], from[at[3 * stride]]);
}
inline void scatter4(float* to, const uint16_t* at, Quad q) {
  const __m128 upper = _mm_movehl_ps(q, q);
  _mm_store_ss(to + at[0], q);
  _mm_store_ss(to + at[1], _mm_shuffle_ps(q, q, 1));
  _mm_store_ss(to + at[2], upper);
  _mm_store_ss(to + at[3], _mm_shuffle_ps(upper, upper, 1));
}
inline uint32_t different_lanes4(Quad a, Quad b) { return different_lanes_of_four(a, b); }
inline void transpose4(Quad& a, Quad& b, Quad& c, Quad& d) {
  const Quad ac = xsimd::zip_lo(a, c), ac_high = xsimd::zip_hi(a, c);
  const Quad bd = xsimd::zip_lo(b, d), bd_high = xsimd::zip_hi(b, d);
  a = xsimd::zip_lo(ac, bd);
  b = xsimd::zip_hi(ac, bd);
  c = xsimd::zip_lo(ac_high, bd_high);
  d = xsimd::zip_hi(ac_high, bd_high);
}

#endif

using ColumnVec = Vec;
inline ColumnVec load_column_vec(const float* from) { return load(from); }
inline ColumnVec broadcast_column_vec(float value) { return broadcast(value); }
inline ColumnVec mul_add_column_vec(ColumnVec a, ColumnVec b, ColumnVec c) {
  return mul_add(a, b, c);
}
inline void columns4(const ColumnVec* m, Quad* columns) {
#if defined(MIEN_KERNEL_AVX2)
  for (int i = 0; i < 2; ++i) {
    columns[2 * i] = _mm256_castps256_ps128(m[i]);
    columns[2 * i + 1] = _mm256_extractf128_ps(m[i], 1);
  }
#elif defined(MIEN_KERNEL_AVX512)
  columns[0] = _mm512_castps512_ps128(m[0]);
  columns[1] = _mm512_extractf32x4_ps(m[0], 1);
  columns[2] = _mm512_extractf32x4_ps(m[0], 2);
  columns[3] = _mm512_extractf32x4_ps(m[0], 3);
#else
  // Without a loop, because some compilers would keep it and store the columns in memory.
  columns[0] = m[0];
  columns[1] = m[1];
  columns[2] = m[2];
  columns[3] = m[3];
#endif
}

#endif

// Four sparse quads. A field of 10 bits is shifted to the top of its lane, so it is 2^22 times as large, which its weight makes
// up for: both exact. Quads without numbers get zeros, because branches would be mispredicted.

#if defined(MIEN_KERNEL_SCALAR) || defined(MIEN_KERNEL_SSE2)
using SparseWeight = Quad;
inline SparseWeight sparse_weight(float weight) { return broadcast4(weight); }
inline void add_sparse4(float* quads, uint32_t mask, const int16_t* from, SparseWeight weight) {
  for (; mask != 0; mask &= mask - 1, from += 3) {
    float* at = quads + static_cast<size_t>(__builtin_ctz(mask)) * 4;
    store4(at, mul_add4(weight, load4(from), load4(at)));
  }
}
inline void add_sparse_fields4(float* quads, uint32_t mask, const int16_t* from,
                               SparseWeight weight) {
  for (; mask != 0; mask &= mask - 1, from += 2) {
    uint32_t bits;
    __builtin_memcpy(&bits, from, sizeof(bits));
    const auto top = [](uint32_t field) {
      return static_cast<float>(static_cast<int32_t>(field & ~0u << 22));
    };
    const float numbers[4] = {top(bits << 22), top(bits << 12), top(bits << 2), 0};
    float* at = quads + static_cast<size_t>(__builtin_ctz(mask)) * 4;
    store4(at, mul_add4(weight, load4(numbers), load4(at)));
  }
}
#else

/// For each mask of four quads, the place of each byte of the quads among the numbers that are stored, `kBytes` for
/// each quad whose bit is set; 0x80 elsewhere, which shuffles make 0. `kLaneBytes` is what a lane of a quad takes.
template <uint32_t kBytes, uint32_t kLaneBytes>
struct SparsePlaces {
  alignas(64) uint8_t of_mask[16][16 * kLaneBytes] = {};
  constexpr SparsePlaces() {
    for (uint32_t mask = 0; mask < 16; ++mask) {
      uint32_t next = 0;
      for (uint32_t k = 0; k < 4; ++k) {
        const bool present = (mask >> k & 1) != 0;
        for (uint32_t b = 0; b < 4 * kLaneBytes; ++b) {
          const bool stored = present && b < kBytes;
          of_mask[mask][k * 4 * kLaneBytes + b] = static_cast<uint8_t>(stored ? next + b : 0x80);
        }
        if (present) next += kBytes;
      }
    }
  }
};

#if defined(MIEN_KERNEL_AVX2) || defined(MIEN_KERNEL_AVX512)
inline __m128i load_places(const uint8_t* places) {
  return _mm_load_si128(reinterpret_cast<const __m128i*>(places));
}
inline __m128i load_words(const int16_t* words) {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(words));
}
#endif

#if defined(MIEN_KERNEL_AVX512)
using SparseWeight = __m512;
inline SparseWeight sparse_weight(float weight) { return _mm512_set1_ps(weight); }
inline void add_integers(float* at, __m512i numbers, SparseWeight weight) {
  _mm512_storeu_ps(at, _mm512_fmadd_ps(weight, _mm512_cvtepi32_ps(numbers), _mm512_loadu_ps(at)));
}
inline void add_sparse4(float* quads, uint32_t mask, const int16_t* from, SparseWeight weight) {
  struct Lanes {
    alignas(32) uint16_t place[16][16] = {};
    uint16_t stored[16] = {};
    constexpr Lanes() {
      for (uint32_t four = 0; four < 16; ++four) {
        uint32_t next = 0;
        for (uint32_t lane = 0; lane < 16; ++lane) {
          if ((four >> lane / 4 & 1) == 0 || lane % 4 == 3) continue;
          place[four][lane] = static_cast<uint16_t>(next++);
          stored[four] = static_cast<uint16_t>(stored[four] | 1u << lane);
        }
      }
    }
  };
  static constexpr Lanes kLanes;
  const __m256i spread = _mm256_maskz_permutexvar_epi16(
      kLanes.stored[mask], _mm256_load_si256(reinterpret_cast<const __m256i*>(kLanes.place[mask])),
      _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from)));
  add_integers(quads, _mm512_cvtepi16_epi32(spread), weight);
}
inline void add_sparse_fields4(float* quads, uint32_t mask, const int16_t* from,
                               SparseWeight weight) {
  static constexpr SparsePlaces<4, 1> kPlaces;
  const __m512i lanes = _mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
  const __m512i shifts = _mm512_broadcast_i32x4(_mm_setr_epi32(22, 12, 2, 32));
  const __m512i top = _mm512_set1_epi32(-(1 << 22));
  // The instruction that expands is microcode on some CPUs.
  const __m128i packed = _mm_shuffle_epi8(load_words(from), load_places(kPlaces.of_mask[mask]));
  const __m512i spread = _mm512_permutexvar_epi32(lanes, _mm512_castsi128_si512(packed));
  add_integers(quads, _mm512_and_si512(_mm512_sllv_epi32(spread, shifts), top), weight);
}
#elif defined(MIEN_KERNEL_AVX2)
using SparseWeight = __m256;
inline SparseWeight sparse_weight(float weight) { return _mm256_set1_ps(weight); }
inline void add_integers(float* at, __m256i numbers, SparseWeight weight) {
  _mm256_storeu_ps(at, _mm256_fmadd_ps(weight, _mm256_cvtepi32_ps(numbers), _mm256_loadu_ps(at)));
}
inline void add_sparse4(float* quads, uint32_t mask, const int16_t* from, SparseWeight weight) {
  static constexpr SparsePlaces<6, 2> kPlaces;
  // The first two quads; the others begin where the numbers of the first two end.
  const uint32_t low = mask & 3, high = mask >> 2;
  const int16_t* const rest = from + 3 * static_cast<size_t>(__builtin_popcount(low));
  const uint8_t* const places = kPlaces.of_mask[0];
  const __m128i first = _mm_shuffle_epi8(load_words(from), load_places(places + low * 32));
  const __m128i second = _mm_shuffle_epi8(load_words(rest), load_places(places + high * 32));
  add_integers(quads, _mm256_cvtepi16_epi32(first), weight);
  add_integers(quads + 8, _mm256_cvtepi16_epi32(second), weight);
}
inline void add_sparse_fields4(float* quads, uint32_t mask, const int16_t* from,
                               SparseWeight weight) {
  static constexpr SparsePlaces<4, 1> kPlaces;
  const __m256i low = _mm256_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1);
  const __m256i high = _mm256_setr_epi32(2, 2, 2, 2, 3, 3, 3, 3);
  const __m256i shifts = _mm256_setr_epi32(22, 12, 2, 32, 22, 12, 2, 32);
  const __m256i top = _mm256_set1_epi32(-(1 << 22));
  const __m256i packed = _mm256_castsi128_si256(
      _mm_shuffle_epi8(load_words(from), load_places(kPlaces.of_mask[mask])));
  const auto fields = [=](__m256i lanes) {
    const __m256i spread = _mm256_permutevar8x32_epi32(packed, lanes);
    return _mm256_and_si256(_mm256_sllv_epi32(spread, shifts), top);
  };
  add_integers(quads, fields(low), weight);
  add_integers(quads + 8, fields(high), weight);
}
#elif defined(MIEN_KERNEL_NEON)
using SparseWeight = Quad;
inline SparseWeight sparse_weight(float weight) { return broadcast4(weight); }
inline void add_integers(float* at, int32x4_t numbers, SparseWeight weight) {
  store4(at, mul_add4(weight, Quad(vcvtq_f32_s32(numbers)), load4(at)));
}
inline uint8x16_t load_words(const int16_t* words) {
  return vreinterpretq_u8_s16(vld1q_s16(words));
}
inline void add_sparse4(float* quads, uint32_t mask, const int16_t* from, SparseWeight weight) {
  static constexpr SparsePlaces<6, 2> kPlaces;
  const uint32_t low = mask & 3, high = mask >> 2;
  const int16_t* const rest = from + 3 * static_cast<size_t>(__builtin_popcount(low));
  const auto spread = [](const int16_t* numbers, uint32_t two) {
    return vreinterpretq_s16_u8(vqtbl1q_u8(load_words(numbers), vld1q_u8(kPlaces.of_mask[two])));
  };
  const int16x8_t first = spread(from, low), second = spread(rest, high);
  add_integers(quads, vmovl_s16(vget_low_s16(first)), weight);
  add_integers(quads + 4, vmovl_s16(vget_high_s16(first)), weight);
  add_integers(quads + 8, vmovl_s16(vget_low_s16(second)), weight);
  add_integers(quads + 12, vmovl_s16(vget_high_s16(second)), weight);
}
inline void add_sparse_fields4(float* quads, uint32_t mask, const int16_t* from,
                               SparseWeight weight) {
  static constexpr SparsePlaces<4, 1> kPlaces;
  const int32_t shift_by[4] = {22, 12, 2, 32};
  const int32x4_t shifts = vld1q_s32(shift_by);
  const uint32x4_t top = vdupq_n_u32(~0u << 22);
  const auto add = [=](float* at, uint32x4_t spread) {
    add_integers(at, vreinterpretq_s32_u32(vandq_u32(vshlq_u32(spread, shifts), top)), weight);
  };
  const uint32x4_t packed =
      vreinterpretq_u32_u8(vqtbl1q_u8(load_words(from), vld1q_u8(kPlaces.of_mask[mask])));
  add(quads, vdupq_laneq_u32(packed, 0));
  add(quads + 4, vdupq_laneq_u32(packed, 1));
  add(quads + 8, vdupq_laneq_u32(packed, 2));
  add(quads + 12, vdupq_laneq_u32(packed, 3));
}
#endif
#endif

inline Vec squared_lengths(const float* quads) {
#if defined(MIEN_KERNEL_SCALAR)
  const Vec x = quads[0], y = quads[1], z = quads[2];
#elif defined(MIEN_KERNEL_AVX2)
  const __m256 a = load(quads), b = load(quads + 8), c = load(quads + 16), d = load(quads + 24);
  const __m256d ab = _mm256_castps_pd(_mm256_unpacklo_ps(a, b));
  const __m256d cd = _mm256_castps_pd(_mm256_unpacklo_ps(c, d));
  const __m256d ab_z = _mm256_castps_pd(_mm256_unpackhi_ps(a, b));
  const __m256d cd_z = _mm256_castps_pd(_mm256_unpackhi_ps(c, d));
  const Vec x = _mm256_castpd_ps(_mm256_unpacklo_pd(ab, cd));
  const Vec y = _mm256_castpd_ps(_mm256_unpackhi_pd(ab, cd));
  const Vec z = _mm256_castpd_ps(_mm256_unpacklo_pd(ab_z, cd_z));
#elif defined(MIEN_KERNEL_AVX512)
  const __m512 a = load(quads), b = load(quads + 16), c = load(quads + 32), d = load(quads + 48);
  const __m512d ab = _mm512_castps_pd(_mm512_unpacklo_ps(a, b));
  const __m512d cd = _mm512_castps_pd(_mm512_unpacklo_ps(c, d));
  const __m512d ab_z = _mm512_castps_pd(_mm512_unpackhi_ps(a, b));
  const __m512d cd_z = _mm512_castps_pd(_mm512_unpackhi_ps(c, d));
  const Vec x = _mm512_castpd_ps(_mm512_unpacklo_pd(ab, cd));
  const Vec y = _mm512_castpd_ps(_mm512_unpackhi_pd(ab, cd));
  const Vec z = _mm512_castpd_ps(_mm512_unpacklo_pd(ab_z, cd_z));
#else
  Quad x = load4(quads), y = load4(quads + 4), z = load4(quads + 8), w = load4(quads + 12);
  transpose4(x, y, z, w);
#endif
  const Vec sums = mul_add(z, z, mul_add(y, y, x * x));
#if defined(MIEN_KERNEL_AVX2)
  return _mm256_permutevar8x32_ps(sums, _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7));
#elif defined(MIEN_KERNEL_AVX512)
  return _mm512_permutexvar_ps(
      _mm512_setr_epi32(0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15), sums);
#else
  return sums;
#endif
}

#if defined(MIEN_KERNEL_AVX2) || defined(MIEN_KERNEL_AVX512)
using QuadPair = BlockVec;
inline QuadPair load_big_endian_pair4(const uint8_t* low, const uint8_t* high) {
  const __m128i of_four = _mm_setr_epi8(3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12);
  const __m128i a = _mm_loadu_si128(reinterpret_cast<const __m128i*>(low));
  const __m128i b = _mm_loadu_si128(reinterpret_cast<const __m128i*>(high));
  return _mm256_castsi256_ps(
      _mm256_shuffle_epi8(_mm256_inserti128_si256(_mm256_castsi128_si256(a), b, 1),
                          _mm256_broadcastsi128_si256(of_four)));
}
inline QuadPair saturate_pair4(QuadPair q) {
  const QuadPair largest(3.40282347e38f);
  return xsimd::min(xsimd::max(q, -largest), largest);
}
inline void transpose_pair4(QuadPair& a, QuadPair& b, QuadPair& c, QuadPair& d) {
  const __m256 ac = _mm256_unpacklo_ps(a, c), ac_high = _mm256_unpackhi_ps(a, c);
  const __m256 bd = _mm256_unpacklo_ps(b, d), bd_high = _mm256_unpackhi_ps(b, d);
  a = _mm256_unpacklo_ps(ac, bd);
  b = _mm256_unpackhi_ps(ac, bd);
  c = _mm256_unpacklo_ps(ac_high, bd_high);
  d = _mm256_unpackhi_ps(ac_high, bd_high);
}
inline void store_pair4(float* to, QuadPair q) { store_block(to, q); }
#else
struct QuadPair {
  Quad low, high;
};
inline QuadPair load_big_endian_pair4(const uint8_t* low, const uint8_t* high) {
  return {load_big_endian4(low), load_big_endian4(high)};
}
inline QuadPair saturate_pair4(const QuadPair& q) {
  const Quad largest = broadcast4(3.40282347e38f), lowest = broadcast4(-3.40282347e38f);
  return {lower4(higher4(q.low, lowest), largest), lower4(higher4(q.high, lowest), largest)};
}
inline void transpose_pair4(QuadPair& a, QuadPair& b, QuadPair& c, QuadPair& d) {
  transpose4(a.low, b.low, c.low, d.low);
  transpose4(a.high, b.high, c.high, d.high);
}
inline void store_pair4(float* to, const QuadPair& q) {
  store4(to, q.low);
  store4(to + 4, q.high);
}
#endif

// Single loads: gather instructions are not faster, and some are slowed down by microcode updates.
inline Vec gather(const float* from, const uint16_t* at) {
#if defined(MIEN_KERNEL_SCALAR)
  return from[*at];
#elif defined(MIEN_KERNEL_AVX2)
  return _mm256_insertf128_ps(_mm256_castps128_ps256(gather4(from, at, 1)),
                              gather4(from, at + 4, 1), 1);
#elif defined(MIEN_KERNEL_AVX512)
  const __m256 low = _mm256_insertf128_ps(_mm256_castps128_ps256(gather4(from, at, 1)),
                                          gather4(from, at + 4, 1), 1);
  const __m256 high = _mm256_insertf128_ps(_mm256_castps128_ps256(gather4(from, at + 8, 1)),
                                           gather4(from, at + 12, 1), 1);
  return _mm512_castpd_ps(
      _mm512_insertf64x4(_mm512_castps_pd(_mm512_castps256_ps512(low)), _mm256_castps_pd(high), 1));
#else
  return gather4(from, at, 1);
#endif
}

// a * b.yzx - a.yzx * b is the cross product, turned by one.
inline Quad cross4(const Quad& a, const Quad& b) { return yzx4(mul_sub4(a, yzx4(b), yzx4(a) * b)); }

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
