// SPDX-License-Identifier: MIT
// Our names over xsimd: the only file that knows xsimd, and the only one that asks which
// instruction set this is. A kernel written with these names is right for every width.
//
//   Vec             kWidth floats
//   load            from memory aligned to the vector
//   load_half       widens kWidth halves (IEEE binary16) from memory aligned to half a vector:
//   exact.
//                   What is stored is finite: infinities and NaN need not survive
//   store           to any address
//   store_first     leading floats of a vector, fewer than kWidth, to any address
//   broadcast       the same float in each lane
//   + - *           rounded once each: never fused (the kernels are built without contraction)
//   divide, square_root   correctly rounded
//   absolute              without the sign
//   at_least, at_most     NaN becomes the bound
//   at_most_or_nan        NaN stays
//   select(m,a,b)   a where m, else b; masks come from less(a,b)
//   keep(m,a)       a where m, else 0
//   saturate        to the range of finite floats
//   power_of_two(n) 2^n for whole n in -126 ... 127
//   round_to_whole(v, p)  the nearest whole number n, and p = 2^n; for |v| up to 126
//   sum_of_lanes(v) of kVecsPerBlock vectors, 16 lanes: one half added to the other until one is
//   left mul_add(a,b,c)  a * b + c, rounded once where the hardware fuses (AVX2, AVX-512, NEON),
//   else
//                   rounded after each step (scalar, SSE2). By intrinsic: xsimd 8.1 leaves the
//                   choice to the compiler on AVX-512 and NEON.
//
// A block of a joint matrix is narrower than the widest vectors:
//
//   BlockVec        kBlockWidth floats, at most kJointBlockRows: Vec, or half of it
//   load_block      kBlockWidth floats, aligned; or as many 16-bit integers made floats
//   store_block, broadcast_block, mul_add   as above
//   load_pair       a Vec of two blocks, on AVX-512
//
//   different_lanes(a,b)   bit k: the bits of lane k differ
//   higher_of, lower_of, bits_of   of a single float
//
// Quads are four floats on every instruction set: a column of a matrix, a point and one float that
// nobody looks at. Names as above, with a 4: load4 and store4 take any address, store3 writes the
// first three.
//
//   higher4, lower4   NaN in the first becomes the second
//   gather4, scatter4 lane i from or to place at[i], or at[i * stride]
//   different_lanes4  as below
//   cross4(a,b)     the cross product of the first three
//   join_bits4(a,b,n) the low n bits of a, and above them those of b
//   transpose4      four quads, rows to columns
//   columns4(m,q)   the four columns of a matrix of 16 floats in 16 / kWidth Vecs
//
// The including kernels_<isa>.cpp defines first:
//
//   MIEN_KERNEL_ISA    name of the instruction set, and of the namespace of its kernels
//   MIEN_KERNEL_AVX2   (or _SCALAR, _SSE2, _AVX512, _NEON) so that the preprocessor can ask
//   xsimd              a name of its own, so that no two kernel objects share an inline function
//
// Everything is in an unnamed namespace for the same reason; in kernel files use nothing but this,
// kernels.h and C headers.

#pragma once

#include <stddef.h>
#include <stdint.h>

#include "simd/kernels.h"

#if !defined(MIEN_KERNEL_SCALAR)
#if !defined(xsimd)
#error "rename xsimd before including it: see above"
#endif
#include <xsimd/xsimd.hpp>
#endif

namespace mien::MIEN_KERNEL_ISA {
namespace {

// Floats near 1.5 * 2^23 are whole numbers: adding it rounds, and the lowest bits of the sum are
// those of the number; with 127 they are what the exponent of its power of two is.
constexpr float kWholeBias = 12582912.0f + 127.0f;

#if defined(MIEN_KERNEL_SCALAR)

constexpr Isa kIsa = Isa::kScalar;
constexpr size_t kWidth = 1;
using Vec = float;

inline Vec load(const float* from) { return *from; }
inline Vec load_half(const uint16_t* from) {
  // Sign, exponent and fraction go where floats have them; the factor makes up for the bias of the
  // exponent, 15 instead of 127, and is exact for subnormal halves, too.
  const uint32_t bits = (*from & 0x8000u) << 16 | (*from & 0x7FFFu) << 13;
  float value;
  __builtin_memcpy(&value, &bits, sizeof(value));
  return value * 0x1p112f;
}
inline void store(float* to, Vec value) { *to = value; }
inline void store_first(float*, Vec, size_t) {}
inline Vec broadcast(float value) { return value; }
inline Vec mul_add(Vec a, Vec b, Vec c) { return a * b + c; }  // built with -ffp-contract=off
inline Vec square_root(Vec v) { return __builtin_sqrtf(v); }
inline Vec divide(Vec a, Vec b) { return a / b; }
inline Vec absolute(Vec v) { return __builtin_fabsf(v); }
inline Vec at_least(Vec v, Vec low) { return v > low ? v : low; }    // NaN becomes `low`
inline Vec at_most(Vec v, Vec high) { return v < high ? v : high; }  // NaN becomes `high`
inline Vec at_most_or_nan(Vec v, Vec high) { return high < v ? high : v; }
using Mask = bool;
inline Mask less(Vec a, Vec b) { return a < b; }
inline Vec select(Mask m, Vec a, Vec b) { return m ? a : b; }
using BlockVec = Vec;
constexpr size_t kBlockWidth = 1;
inline BlockVec load_block(const float* from) { return *from; }
inline BlockVec load_block(const int16_t* from) { return *from; }
inline BlockVec broadcast_block(float value) { return value; }
inline void store_block(float* to, BlockVec value) { *to = value; }
inline Vec keep(Mask m, Vec a) { return m ? a : 0.0f; }
inline Vec power_of_two(Vec n) {
  const uint32_t bits = static_cast<uint32_t>(static_cast<int32_t>(n) + 127) << 23;
  float power;
  __builtin_memcpy(&power, &bits, sizeof(power));
  return power;
}
inline Vec round_to_whole(Vec v, Vec& power) {
  const float sum = v + kWholeBias;
  uint32_t bits;
  __builtin_memcpy(&bits, &sum, sizeof(bits));
  bits <<= 23;
  __builtin_memcpy(&power, &bits, sizeof(power));
  return sum - kWholeBias;
}

#else

#if defined(MIEN_KERNEL_SSE2)
constexpr Isa kIsa = Isa::kSse2;
using Vec = xsimd::batch<float, xsimd::sse2>;
inline Vec mul_add(Vec a, Vec b, Vec c) { return _mm_add_ps(_mm_mul_ps(a, b), c); }
inline Vec load_half(const uint16_t* from) {
  // As the scalar one. The shift copies the sign to the right, where the mask takes it off again.
  const __m128i halves = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(from));
  const __m128i high = _mm_unpacklo_epi16(_mm_setzero_si128(), halves);
  const __m128i bits =
      _mm_and_si128(_mm_srai_epi32(high, 3), _mm_set1_epi32(static_cast<int>(0x8FFFE000)));
  return _mm_mul_ps(_mm_castsi128_ps(bits), _mm_set1_ps(0x1p112f));
}

#elif defined(MIEN_KERNEL_AVX2)
constexpr Isa kIsa = Isa::kAvx2;
using Vec = xsimd::batch<float, xsimd::fma3<xsimd::avx2>>;
inline Vec mul_add(Vec a, Vec b, Vec c) { return _mm256_fmadd_ps(a, b, c); }
inline Vec load_half(const uint16_t* from) {
  return _mm256_cvtph_ps(_mm_load_si128(reinterpret_cast<const __m128i*>(from)));
}

#elif defined(MIEN_KERNEL_AVX512)
constexpr Isa kIsa = Isa::kAvx512;
using Vec = xsimd::batch<float, xsimd::avx512bw>;
inline Vec mul_add(Vec a, Vec b, Vec c) { return _mm512_fmadd_ps(a, b, c); }
inline Vec load_half(const uint16_t* from) {
  return _mm512_cvtph_ps(_mm256_load_si256(reinterpret_cast<const __m256i*>(from)));
}

#elif defined(MIEN_KERNEL_NEON)
constexpr Isa kIsa = Isa::kNeon;
using Vec = xsimd::batch<float, xsimd::neon64>;
inline Vec mul_add(Vec a, Vec b, Vec c) { return vfmaq_f32(c, a, b); }
inline Vec load_half(const uint16_t* from) {
  return vcvt_f32_f16(vreinterpret_f16_u16(vld1_u16(from)));
}
#endif

constexpr size_t kWidth = Vec::size;

#if defined(MIEN_KERNEL_AVX512)
using BlockVec = xsimd::batch<float, xsimd::fma3<xsimd::avx2>>;
inline BlockVec mul_add(BlockVec a, BlockVec b, BlockVec c) { return _mm256_fmadd_ps(a, b, c); }
#else
using BlockVec = Vec;
#endif
constexpr size_t kBlockWidth = BlockVec::size;
inline BlockVec load_block(const float* from) { return BlockVec::load_aligned(from); }
inline BlockVec broadcast_block(float value) { return BlockVec(value); }
inline void store_block(float* to, BlockVec value) { value.store_aligned(to); }
#if defined(MIEN_KERNEL_SSE2)
inline BlockVec load_block(const int16_t* from) {
  const __m128i narrow = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(from));
  return _mm_cvtepi32_ps(_mm_srai_epi32(_mm_unpacklo_epi16(narrow, narrow), 16));
}
#elif defined(MIEN_KERNEL_NEON)
inline BlockVec load_block(const int16_t* from) { return vcvtq_f32_s32(vmovl_s16(vld1_s16(from))); }
#else
inline BlockVec load_block(const int16_t* from) {
  const __m128i narrow = _mm_load_si128(reinterpret_cast<const __m128i*>(from));
  return _mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(narrow));
}
#endif

#if defined(MIEN_KERNEL_AVX512)
inline Vec load_pair(const float* from) { return Vec::load_aligned(from); }
inline Vec load_pair(const int16_t* from) {
  const __m256i narrow = _mm256_load_si256(reinterpret_cast<const __m256i*>(from));
  return _mm512_cvtepi32_ps(_mm512_cvtepi16_epi32(narrow));
}
#endif

inline Vec load(const float* from) { return Vec::load_aligned(from); }
inline void store(float* to, Vec value) { value.store_unaligned(to); }
inline void store_first(float* to, Vec value, size_t count) {
#if defined(MIEN_KERNEL_AVX512)
  _mm512_mask_storeu_ps(to, static_cast<__mmask16>((1u << count) - 1), value);
#else
  float lanes[kWidth];
  store(lanes, value);
  for (size_t i = 0; i < count; ++i) to[i] = lanes[i];
#endif
}
inline Vec broadcast(float value) { return Vec(value); }
#if defined(MIEN_KERNEL_NEON)
// xsimd 8.1 refines estimates here, which does not round as these do.
inline Vec square_root(Vec v) { return vsqrtq_f32(v); }
inline Vec divide(Vec a, Vec b) { return vdivq_f32(a, b); }
#else
inline Vec square_root(Vec v) { return xsimd::sqrt(v); }
inline Vec divide(Vec a, Vec b) { return a / b; }
#endif
inline Vec absolute(Vec v) { return xsimd::abs(v); }
using Mask = Vec::batch_bool_type;
inline Mask less(Vec a, Vec b) { return a < b; }
inline Vec select(Mask m, Vec a, Vec b) { return xsimd::select(m, a, b); }
#if defined(MIEN_KERNEL_SSE2)
inline Vec keep(Mask m, Vec a) { return _mm_and_ps(m, a); }
#elif defined(MIEN_KERNEL_AVX2)
inline Vec keep(Mask m, Vec a) { return _mm256_and_ps(m, a); }
#else
inline Vec keep(Mask m, Vec a) { return select(m, a, broadcast(0.0f)); }
#endif
#if defined(MIEN_KERNEL_NEON)
inline Vec at_least(Vec v, Vec low) { return select(v > low, v, low); }
inline Vec at_most(Vec v, Vec high) { return select(v < high, v, high); }
inline Vec at_most_or_nan(Vec v, Vec high) { return select(high < v, high, v); }
#else
// max and min of x86 are exactly v > low ? v : low and v < high ? v : high.
inline Vec at_least(Vec v, Vec low) { return xsimd::max(v, low); }
inline Vec at_most(Vec v, Vec high) { return xsimd::min(v, high); }
inline Vec at_most_or_nan(Vec v, Vec high) { return xsimd::min(high, v); }
#endif
using Bits = xsimd::batch<int32_t, Vec::arch_type>;
inline Vec power_of_two(Vec n) {
  const Bits sum = xsimd::bitwise_cast<Bits>(n + broadcast(kWholeBias));  // exact
  return xsimd::bitwise_cast<Vec>(sum << 23);
}
inline Vec round_to_whole(Vec v, Vec& power) {
  const Vec sum = v + broadcast(kWholeBias);
  power = xsimd::bitwise_cast<Vec>(xsimd::bitwise_cast<Bits>(sum) << 23);
  return sum - broadcast(kWholeBias);
}

#endif

// Single floats -----------------------------------------------------------------------------------

/// NaN gives the bound. By instruction where there is one: compilers make branches of the other
/// way.
#if defined(MIEN_KERNEL_SSE2) || defined(MIEN_KERNEL_AVX2) || defined(MIEN_KERNEL_AVX512)
inline float higher_of(float value, float bound) {
  return _mm_cvtss_f32(_mm_max_ss(_mm_set_ss(value), _mm_set_ss(bound)));
}
inline float lower_of(float value, float bound) {
  return _mm_cvtss_f32(_mm_min_ss(_mm_set_ss(value), _mm_set_ss(bound)));
}
#else
inline float higher_of(float value, float bound) { return value > bound ? value : bound; }
inline float lower_of(float value, float bound) { return value < bound ? value : bound; }
#endif
inline uint32_t bits_of(float value) {
  uint32_t bits;
  __builtin_memcpy(&bits, &value, sizeof(bits));
  return bits;
}

// Quads -------------------------------------------------------------------------------------------

#if defined(MIEN_KERNEL_SCALAR)

struct Quad {
  float v[4];
};
template <class F>
inline Quad lanes4(F&& f) {
  return {{f(0), f(1), f(2), f(3)}};
}
inline Quad load4(const float* from) { return {{from[0], from[1], from[2], from[3]}}; }
inline void store4(float* to, const Quad& q) {
  for (int i = 0; i < 4; ++i) to[i] = q.v[i];
}
inline void store3(float* to, const Quad& q) {
  for (int i = 0; i < 3; ++i) to[i] = q.v[i];
}
inline Quad broadcast4(float value) { return {{value, value, value, value}}; }
inline Quad operator+(const Quad& a, const Quad& b) {
  return lanes4([&](int i) { return a.v[i] + b.v[i]; });
}
inline Quad operator-(const Quad& a, const Quad& b) {
  return lanes4([&](int i) { return a.v[i] - b.v[i]; });
}
inline Quad operator*(const Quad& a, const Quad& b) {
  return lanes4([&](int i) { return a.v[i] * b.v[i]; });
}
inline Quad mul_add4(const Quad& a, const Quad& b, const Quad& c) { return a * b + c; }
inline Quad mul_sub4(const Quad& a, const Quad& b, const Quad& c) { return a * b - c; }
inline Quad divide4(const Quad& a, const Quad& b) {
  return lanes4([&](int i) { return a.v[i] / b.v[i]; });
}
inline Quad square_root4(const Quad& a) {
  return lanes4([&](int i) { return __builtin_sqrtf(a.v[i]); });
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
  for (size_t i = 0; i < 4; ++i) different |= uint32_t{bits_of(a.v[i]) != bits_of(b.v[i])} << i;
  return different;
}
inline Quad join_bits4(const Quad& low, const Quad& high, int n) {
  return lanes4([&](int i) {
    const uint32_t bits = (bits_of(low.v[i]) & ((1u << n) - 1)) | bits_of(high.v[i]) << n;
    float lane;
    __builtin_memcpy(&lane, &bits, sizeof(lane));
    return lane;
  });
}
inline void transpose4(Quad& a, Quad& b, Quad& c, Quad& d) {
  const Quad rows[4] = {a, b, c, d};
  Quad* const columns[4] = {&a, &b, &c, &d};
  for (int i = 0; i < 4; ++i) *columns[i] = lanes4([&](int k) { return rows[k].v[i]; });
}
inline void columns4(const Vec* m, Quad* columns) {
  for (int i = 0; i < 4; ++i) columns[i] = load4(m + 4 * i);
}

#elif defined(MIEN_KERNEL_NEON)

using Quad = Vec;
inline Quad load4(const float* from) { return Quad(vld1q_f32(from)); }
inline void store4(float* to, Quad q) { vst1q_f32(to, q); }
inline void store3(float* to, Quad q) {
  vst1_f32(to, vget_low_f32(q));
  vst1q_lane_f32(to + 2, q, 2);
}
inline Quad broadcast4(float value) { return Quad(value); }
inline Quad mul_add4(Quad a, Quad b, Quad c) { return vfmaq_f32(c, a, b); }
inline Quad mul_sub4(Quad a, Quad b, Quad c) { return vfmaq_f32(vnegq_f32(c), a, b); }
inline Quad divide4(Quad a, Quad b) { return vdivq_f32(a, b); }
inline Quad square_root4(Quad a) { return vsqrtq_f32(a); }
inline Quad yzx4(Quad a) { return vextq_f32(vextq_f32(a, a, 3), a, 2); }
inline Quad higher4(Quad a, Quad b) { return vbslq_f32(vcgtq_f32(a, b), a, b); }
inline Quad lower4(Quad a, Quad b) { return vbslq_f32(vcltq_f32(a, b), a, b); }
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
inline uint32_t different_lanes4(Quad a, Quad b) {
  const uint32_t bits[] = {1, 2, 4, 8};
  const uint32x4_t same = vceqq_u32(vreinterpretq_u32_f32(a), vreinterpretq_u32_f32(b));
  return vaddvq_u32(vbicq_u32(vld1q_u32(bits), same));
}
inline void transpose4(Quad& a, Quad& b, Quad& c, Quad& d) {
  const float32x4x2_t ab = vtrnq_f32(a, b), cd = vtrnq_f32(c, d);
  a = vcombine_f32(vget_low_f32(ab.val[0]), vget_low_f32(cd.val[0]));
  b = vcombine_f32(vget_low_f32(ab.val[1]), vget_low_f32(cd.val[1]));
  c = vcombine_f32(vget_high_f32(ab.val[0]), vget_high_f32(cd.val[0]));
  d = vcombine_f32(vget_high_f32(ab.val[1]), vget_high_f32(cd.val[1]));
}
inline void columns4(const Vec* m, Quad* columns) {
  for (int i = 0; i < 4; ++i) columns[i] = m[i];
}

#else

using Quad = xsimd::batch<float, xsimd::sse2>;
inline Quad load4(const float* from) { return _mm_loadu_ps(from); }
inline void store4(float* to, Quad q) { _mm_storeu_ps(to, q); }
inline void store3(float* to, Quad q) {
  _mm_storel_pi(reinterpret_cast<__m64*>(to), q);
  _mm_store_ss(to + 2, _mm_movehl_ps(q, q));
}
inline Quad broadcast4(float value) { return _mm_set1_ps(value); }
#if defined(MIEN_KERNEL_SSE2)
inline Quad mul_add4(Quad a, Quad b, Quad c) { return _mm_add_ps(_mm_mul_ps(a, b), c); }
inline Quad mul_sub4(Quad a, Quad b, Quad c) { return _mm_sub_ps(_mm_mul_ps(a, b), c); }
#else
inline Quad mul_add4(Quad a, Quad b, Quad c) { return _mm_fmadd_ps(a, b, c); }
inline Quad mul_sub4(Quad a, Quad b, Quad c) { return _mm_fmsub_ps(a, b, c); }
#endif
inline Quad divide4(Quad a, Quad b) { return _mm_div_ps(a, b); }
inline Quad square_root4(Quad a) { return _mm_sqrt_ps(a); }
inline Quad yzx4(Quad a) { return _mm_shuffle_ps(a, a, _MM_SHUFFLE(3, 0, 2, 1)); }
inline Quad higher4(Quad a, Quad b) { return _mm_max_ps(a, b); }
inline Quad lower4(Quad a, Quad b) { return _mm_min_ps(a, b); }
inline Quad gather4(const float* from, const uint16_t* at, size_t stride) {
  float first = from[at[0]];
#if defined(__wasm__)
  // Clang 14 would otherwise move this load behind stores that follow.
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
inline uint32_t different_lanes4(Quad a, Quad b) {
  const __m128i same = _mm_cmpeq_epi32(_mm_castps_si128(a), _mm_castps_si128(b));
  return ~static_cast<uint32_t>(_mm_movemask_ps(_mm_castsi128_ps(same))) & 0xF;
}
inline void transpose4(Quad& a, Quad& b, Quad& c, Quad& d) {
  const __m128 ab = _mm_unpacklo_ps(a, b), cd = _mm_unpacklo_ps(c, d);
  const __m128 ab_high = _mm_unpackhi_ps(a, b), cd_high = _mm_unpackhi_ps(c, d);
  a = _mm_movelh_ps(ab, cd);
  b = _mm_movehl_ps(cd, ab);
  c = _mm_movelh_ps(ab_high, cd_high);
  d = _mm_movehl_ps(cd_high, ab_high);
}
#if defined(MIEN_KERNEL_SSE2)
inline void columns4(const Vec* m, Quad* columns) {
  for (int i = 0; i < 4; ++i) columns[i] = m[i];
}
#elif defined(MIEN_KERNEL_AVX2)
inline void columns4(const Vec* m, Quad* columns) {
  for (int i = 0; i < 2; ++i) {
    columns[2 * i] = _mm256_castps256_ps128(m[i]);
    columns[2 * i + 1] = _mm256_extractf128_ps(m[i], 1);
  }
}
#else
inline void columns4(const Vec* m, Quad* columns) {
  columns[0] = _mm512_castps512_ps128(m[0]);
  columns[1] = _mm512_extractf32x4_ps(m[0], 1);
  columns[2] = _mm512_extractf32x4_ps(m[0], 2);
  columns[3] = _mm512_extractf32x4_ps(m[0], 3);
}
#endif

#endif

#if !defined(MIEN_KERNEL_SCALAR)
using QuadBits = xsimd::batch<uint32_t, Quad::arch_type>;
inline Quad join_bits4(Quad low, Quad high, int n) {
  const QuadBits bits = (xsimd::bitwise_cast<QuadBits>(low) & QuadBits((1u << n) - 1)) |
                        (xsimd::bitwise_cast<QuadBits>(high) << n);
  return xsimd::bitwise_cast<Quad>(bits);
}
#endif

// Bit k: the bits of lane k differ.
#if defined(MIEN_KERNEL_SCALAR)
inline uint32_t different_lanes(Vec a, Vec b) { return bits_of(a) != bits_of(b); }
#elif defined(MIEN_KERNEL_AVX512)
inline uint32_t different_lanes(Vec a, Vec b) {
  return _mm512_cmpneq_epi32_mask(_mm512_castps_si512(a), _mm512_castps_si512(b));
}
#elif defined(MIEN_KERNEL_AVX2)
inline uint32_t different_lanes(Vec a, Vec b) {
  const __m256i same = _mm256_cmpeq_epi32(_mm256_castps_si256(a), _mm256_castps_si256(b));
  return ~static_cast<uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(same))) & 0xFF;
}
#else
inline uint32_t different_lanes(Vec a, Vec b) { return different_lanes4(a, b); }
#endif

// (a * b.yzx - a.yzx * b) is the cross product, turned by one.
inline Quad cross4(const Quad& a, const Quad& b) { return yzx4(mul_sub4(a, yzx4(b), yzx4(a) * b)); }
constexpr size_t kVecsPerBlock = kBlockLanes / kWidth;

inline float sum_of_lanes(const Vec (&vecs)[kVecsPerBlock]) {
#if defined(MIEN_KERNEL_SCALAR)
  float sums[8], four[4];
  for (size_t i = 0; i < 8; ++i) sums[i] = vecs[i] + vecs[i + 8];
  for (size_t i = 0; i < 4; ++i) four[i] = sums[i] + sums[i + 4];
  return (four[0] + four[2]) + (four[1] + four[3]);
#elif defined(MIEN_KERNEL_NEON)
  const Vec four = (vecs[0] + vecs[2]) + (vecs[1] + vecs[3]);
  const float32x2_t two = vadd_f32(vget_low_f32(four), vget_high_f32(four));
  return vget_lane_f32(two, 0) + vget_lane_f32(two, 1);
#else
#if defined(MIEN_KERNEL_SSE2)
  const __m128 four = (vecs[0] + vecs[2]) + (vecs[1] + vecs[3]);
#else
#if defined(MIEN_KERNEL_AVX2)
  const __m256 eight = vecs[0] + vecs[1];
#else
  const __m512d all = _mm512_castps_pd(vecs[0]);
  const __m256 eight = _mm256_add_ps(_mm256_castpd_ps(_mm512_castpd512_pd256(all)),
                                     _mm256_castpd_ps(_mm512_extractf64x4_pd(all, 1)));
#endif
  const __m128 four = _mm_add_ps(_mm256_castps256_ps128(eight), _mm256_extractf128_ps(eight, 1));
#endif
  const __m128 two = _mm_add_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_add_ss(two, _mm_shuffle_ps(two, two, 1)));
#endif
}

// Sums of finite products can overflow, and infinities of both signs cancel to nothing sensible.
// What is not a number becomes the lowest.
inline Vec saturate(Vec v) {
  constexpr float kLargest = 3.40282347e38f;
  return at_most(at_least(v, broadcast(-kLargest)), broadcast(kLargest));
}

// How a kernel multiplies and adds: as the hardware does best, or with the same bits on every
// instruction set.
struct AsFast {
  template <class V>
  static V mul_add(V a, V b, V c) {
    return mien::MIEN_KERNEL_ISA::mul_add(a, b, c);
  }
};
struct AsPortable {
  template <class V>
  static V mul_add(V a, V b, V c) {
    return a * b + c;  // kernels are built without contraction
  }
};

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
