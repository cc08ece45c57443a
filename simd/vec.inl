// SPDX-License-Identifier: MIT
// Vectors of floats: our names over xsimd. Only this file and quad.inl know xsimd and ask which instruction
// set this is; a kernel written with their names is right for every width.
//
// | name                   | meaning                                                              |
// |------------------------|----------------------------------------------------------------------|
// | Vec                    | kWidth floats                                                        |
// | Mask                   | kWidth booleans                                                      |
// | load                   | from memory aligned to the vector                                    |
// | load_any               | from any address                                                     |
// | load_big_endian        | from any address, bytes of each float in the order of files          |
// | load_half              | kWidth halves (IEEE binary16) as floats, exact for finite ones; from |
// |                        | memory aligned to half a vector                                      |
// | load_fixed             | kWidth 16-bit integers as floats, from any address                   |
// | store                  | to any address                                                       |
// | store_fixed            | whole numbers up to 32767 in magnitude, as 16-bit integers, to       |
// |                        | memory aligned to half a vector                                      |
// | store_first            | the leading floats, fewer than kWidth, to any address                |
// | broadcast              | the same float in each lane                                          |
// | load_four, one_of<n>   | four floats from any address, and number n of them in each lane: less|
// |                        | work for the cache than four broadcasts                              |
// | take_after             | for compilers, changes the four once a sum is known: else they make  |
// |                        | one_of all numbers first, where no registers are left for those      |
// | + - *                  | rounded once each, never fused: kernels are built without contraction|
// | divide, square_root    | correctly rounded                                                    |
// | mul_add(a, b, c)       | a * b + c: rounded once on AVX2, AVX-512 and NEON, twice on scalar   |
// |                        | and SSE2                                                             |
// | absolute               | without the sign                                                     |
// | at_least, at_most      | NaN becomes the bound                                                |
// | at_most_or_nan         | NaN stays                                                            |
// | less(a, b), equal(a, b)| a mask                                                               |
// | select(m, a, b)        | a where m, else b                                                    |
// | keep(m, a)             | a where m, else 0                                                    |
// | any(m)                 | whether a lane of a mask is set                                      |
// | with_sign(v, s)        | the magnitude of v, the sign bit of s                                |
// | flip_sign(v, s)        | -v where the sign bit of s is set                                    |
// | shift_bits<n>(v)       | the bits of each float, moved up by n                                |
// | nonzero_of_file        | of 32 floats as load_big_endian reads them, bit k: number k is       |
// |                        | neither 0 nor -0                                                     |
// | different_lanes(a, b)  | bit k: the bits of lane k differ                                     |
// | sum_of_lanes           | of 16 lanes, in kVecsPerBlock vectors: one half is added to the      |
// |                        | other until one is left                                              |
// | saturate               | to the range of finite floats; NaN becomes the lowest                |
// | AsFast, AsPortable     | how a kernel multiplies and adds: by mul_add, or rounding twice      |
// |                        | everywhere                                                           |
// | VecPair, MaskPair      | two of them, with the names above                                    |
// | Make<V>                | from(address), of(float): a V, which is a Vec or a VecPair           |
//
// The block of a joint matrix is narrower than the widest vectors:
//
// | BlockVec               | kBlockWidth floats, at most kJointBlockRows: a Vec, or half of one   |
// | load_block             | from aligned memory: floats, or 16-bit integers made floats          |
// | store_block            | to aligned memory                                                    |
// | broadcast_block        | the same float in each lane; mul_add as above                        |
// | load_pair              | a Vec of two blocks, on AVX-512 only                                 |
//
// Single floats: bits_of, and higher_of and lower_of, where NaN becomes the bound.
//
// Some intrinsics remain, for what xsimd 8.1 lacks: halves, widening of 16-bit integers, stores under a mask,
// parts of a vector, the bits of a mask. Other intrinsics have comments that say how xsimd differs.
//
// The including kernels_<isa>.cpp defines first:
//
//   MIEN_KERNEL_ISA    name of the instruction set, and of the namespace of its kernels
//   MIEN_KERNEL_AVX2   (or _SCALAR, _SSE2, _AVX512, _NEON) so that the preprocessor can ask
//   xsimd              a name of its own, so that no two kernel objects share an inline function
//
// Everything is in an unnamed namespace for the same reason; kernel files use nothing but the files
// of this folder and C headers.

#pragma once

#include <stddef.h>
#include <stdint.h>

#include "simd/isa.h"
#include "simd/lanes.h"

#if !defined(MIEN_KERNEL_SCALAR)
#if !defined(xsimd)
#error "rename xsimd before including it: see above"
#endif
#include <xsimd/xsimd.hpp>
#if defined(__wasm__)
#include <wasm_simd128.h>
#endif
#endif

namespace mien::MIEN_KERNEL_ISA {
namespace {

// Single floats -----------------------------------------------------------------------------------

inline uint32_t bits_of(float value) {
  uint32_t bits;
  __builtin_memcpy(&bits, &value, sizeof(bits));
  return bits;
}
inline float float_of(uint32_t bits) {
  float value;
  __builtin_memcpy(&value, &bits, sizeof(value));
  return value;
}

// With an intrinsic: compilers turn the comparison into branches.
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

// Vectors -----------------------------------------------------------------------------------------

#if defined(MIEN_KERNEL_SCALAR)

constexpr Isa kIsa = Isa::kScalar;
constexpr size_t kWidth = 1;
using Vec = float;
using Mask = bool;

inline Vec load(const float* from) { return *from; }
inline Vec load_any(const float* from) { return *from; }
inline Vec load_half(const uint16_t* from) {
  // Moves sign, exponent and fraction to their places in a float. The factor makes up for the bias of the
  // exponent, 15 instead of 127, and is exact for subnormal halves, too.
  return float_of((*from & 0x8000u) << 16 | (*from & 0x7FFFu) << 13) * 0x1p112f;
}
inline Vec load_big_endian(const uint8_t* from) {
  uint32_t bits;
  __builtin_memcpy(&bits, from, sizeof(bits));
#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
  bits = __builtin_bswap32(bits);
#endif
  return float_of(bits);
}
inline void store(float* to, Vec value) { *to = value; }
inline void store_fixed(int16_t* to, Vec value) { *to = static_cast<int16_t>(value); }
inline void store_first(float*, Vec, size_t) {}
inline Vec broadcast(float value) { return value; }
struct FourFloats {
  const float* from;
};
inline FourFloats load_four(const float* from) { return {from}; }
template <int kNumber>
inline Vec one_of(FourFloats four) {
  return four.from[kNumber];
}
inline void take_after(FourFloats&, Vec&) {}
inline Vec mul_add(Vec a, Vec b, Vec c) { return a * b + c; }
inline Vec square_root(Vec v) { return __builtin_sqrtf(v); }
inline Vec divide(Vec a, Vec b) { return a / b; }
inline Vec absolute(Vec v) { return __builtin_fabsf(v); }
inline Vec at_least(Vec v, Vec low) { return v > low ? v : low; }
inline Vec at_most(Vec v, Vec high) { return v < high ? v : high; }
inline Vec at_most_or_nan(Vec v, Vec high) { return high < v ? high : v; }
inline Mask less(Vec a, Vec b) { return a < b; }
inline Mask equal(Vec a, Vec b) { return a == b; }
inline Vec select(Mask m, Vec a, Vec b) { return m ? a : b; }
inline Vec keep(Mask m, Vec a) { return m ? a : 0.0f; }
inline bool any(Mask m) { return m; }
inline Vec with_sign(Vec v, Vec s) { return __builtin_copysignf(v, s); }
inline Vec flip_sign(Vec v, Vec s) { return float_of(bits_of(v) ^ (bits_of(s) & 0x80000000u)); }
template <int kBits>
inline Vec shift_bits(Vec v) {
  return float_of(bits_of(v) << kBits);
}
inline uint32_t different_lanes(Vec a, Vec b) { return bits_of(a) != bits_of(b); }
inline uint32_t nonzero_of_file(const uint8_t* from) {
  uint32_t nonzero = 0;
  for (uint32_t i = 0; i < 32; ++i) {
    nonzero |= uint32_t{(bits_of(load_big_endian(from + i * 4)) << 1) != 0} << i;
  }
  return nonzero;
}

using BlockVec = Vec;
constexpr size_t kBlockWidth = 1;
inline BlockVec load_block(const float* from) { return *from; }
inline BlockVec load_block(const int16_t* from) { return *from; }
inline BlockVec broadcast_block(float value) { return value; }
inline Vec load_fixed(const int16_t* from) { return *from; }
inline void store_block(float* to, BlockVec value) { *to = value; }

#else

#if defined(MIEN_KERNEL_SSE2)
constexpr Isa kIsa = Isa::kSse2;
using Vec = xsimd::batch<float, xsimd::sse2>;
inline Vec mul_add(Vec a, Vec b, Vec c) { return a * b + c; }
inline Vec load_half(const uint16_t* from) {
  // As in the scalar version. The shift copies the sign to the right, where the mask removes it.
  const __m128i halves = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(from));
  const __m128i high = _mm_unpacklo_epi16(_mm_setzero_si128(), halves);
  const __m128i bits =
      _mm_and_si128(_mm_srai_epi32(high, 3), _mm_set1_epi32(static_cast<int>(0x8FFFE000)));
  return _mm_mul_ps(_mm_castsi128_ps(bits), _mm_set1_ps(0x1p112f));
}

#elif defined(MIEN_KERNEL_AVX2)
constexpr Isa kIsa = Isa::kAvx2;
using Vec = xsimd::batch<float, xsimd::fma3<xsimd::avx2>>;
inline Vec mul_add(Vec a, Vec b, Vec c) { return xsimd::fma(a, b, c); }
inline Vec load_half(const uint16_t* from) {
  return _mm256_cvtph_ps(_mm_load_si128(reinterpret_cast<const __m128i*>(from)));
}

#elif defined(MIEN_KERNEL_AVX512)
constexpr Isa kIsa = Isa::kAvx512;
using Vec = xsimd::batch<float, xsimd::avx512bw>;
inline Vec mul_add(Vec a, Vec b, Vec c) { return _mm512_fmadd_ps(a, b, c); }  // xsimd does not fuse
inline Vec load_half(const uint16_t* from) {
  return _mm512_cvtph_ps(_mm256_load_si256(reinterpret_cast<const __m256i*>(from)));
}

#elif defined(MIEN_KERNEL_NEON)
constexpr Isa kIsa = Isa::kNeon;
using Vec = xsimd::batch<float, xsimd::neon64>;
// xsimd fuses only if a macro of the compiler says so.
inline Vec mul_add(Vec a, Vec b, Vec c) { return vfmaq_f32(c, a, b); }
inline Vec load_half(const uint16_t* from) {
  return vcvt_f32_f16(vreinterpret_f16_u16(vld1_u16(from)));
}
#endif

constexpr size_t kWidth = Vec::size;
using Mask = Vec::batch_bool_type;
using Bits = xsimd::batch<int32_t, Vec::arch_type>;

inline Vec load(const float* from) { return Vec::load_aligned(from); }
inline Vec load_any(const float* from) { return Vec::load_unaligned(from); }
inline Vec load_big_endian(const uint8_t* from) {
#if defined(MIEN_KERNEL_SSE2)
  const __m128i bytes = _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
  const __m128i pairs = _mm_or_si128(_mm_slli_epi16(bytes, 8), _mm_srli_epi16(bytes, 8));
  return _mm_castsi128_ps(_mm_shufflehi_epi16(_mm_shufflelo_epi16(pairs, 0xB1), 0xB1));
#elif defined(MIEN_KERNEL_NEON)
  return vreinterpretq_f32_u8(vrev32q_u8(vld1q_u8(from)));
#else
  const __m128i of_four = _mm_setr_epi8(3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12);
#if defined(MIEN_KERNEL_AVX2)
  return _mm256_castsi256_ps(
      _mm256_shuffle_epi8(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from)),
                          _mm256_broadcastsi128_si256(of_four)));
#else
  return _mm512_castsi512_ps(
      _mm512_shuffle_epi8(_mm512_loadu_si512(from), _mm512_broadcast_i32x4(of_four)));
#endif
#endif
}
inline void store(float* to, Vec value) { value.store_unaligned(to); }
inline void store_fixed(int16_t* to, Vec value) {
#if defined(MIEN_KERNEL_SSE2)
  const __m128i wide = _mm_cvttps_epi32(value);
  _mm_storel_epi64(reinterpret_cast<__m128i*>(to), _mm_packs_epi32(wide, wide));
#elif defined(MIEN_KERNEL_NEON)
  vst1_s16(to, vqmovn_s32(vcvtq_s32_f32(value)));
#elif defined(MIEN_KERNEL_AVX2)
  const __m256i wide = _mm256_cvttps_epi32(value);
  _mm_store_si128(reinterpret_cast<__m128i*>(to),
                  _mm_packs_epi32(_mm256_castsi256_si128(wide), _mm256_extracti128_si256(wide, 1)));
#else
  _mm256_store_si256(reinterpret_cast<__m256i*>(to),
                     _mm512_cvtepi32_epi16(_mm512_cvttps_epi32(value)));
#endif
}
inline void store_first(float* to, Vec value, size_t count) {
#if defined(MIEN_KERNEL_AVX512)
  _mm512_mask_storeu_ps(to, static_cast<__mmask16>((1u << count) - 1), value);
#elif defined(__SSE2__)
#if defined(MIEN_KERNEL_AVX2)
  __m128 four = _mm256_castps256_ps128(value);
  if (count & 4) {
    _mm_storeu_ps(to, four);
    four = _mm256_extractf128_ps(value, 1);
    to += 4;
  }
#else
  __m128 four = value;
#endif
  if (count & 2) {
    _mm_storel_pi(reinterpret_cast<__m64*>(to), four);
    four = _mm_movehl_ps(four, four);
    to += 2;
  }
  if (count & 1) _mm_store_ss(to, four);
#else
  float lanes[kWidth];
  store(lanes, value);
  for (size_t i = 0; i < count; ++i) to[i] = lanes[i];
#endif
}
inline Vec broadcast(float value) { return Vec(value); }
inline Vec load_four(const float* from) {
#if defined(MIEN_KERNEL_SSE2)
  return _mm_loadu_ps(from);
#elif defined(MIEN_KERNEL_NEON)
  return vld1q_f32(from);
#elif defined(MIEN_KERNEL_AVX2)
  return _mm256_broadcast_ps(reinterpret_cast<const __m128*>(from));
#else
  return _mm512_broadcast_f32x4(_mm_loadu_ps(from));
#endif
}
template <int kNumber>
inline Vec one_of(Vec four) {
#if defined(MIEN_KERNEL_SSE2)
  return _mm_castsi128_ps(_mm_shuffle_epi32(_mm_castps_si128(four), kNumber * 0x55));
#elif defined(MIEN_KERNEL_NEON)
  return vdupq_laneq_f32(four, kNumber);
#elif defined(MIEN_KERNEL_AVX2)
  return _mm256_permute_ps(four, kNumber * 0x55);
#else
  return _mm512_permute_ps(four, kNumber * 0x55);
#endif
}
inline void take_after([[maybe_unused]] Vec& four, [[maybe_unused]] Vec& sum) {
#if defined(MIEN_KERNEL_AVX2)
  __m256 later = four, sooner = sum;
  asm("" : "+x"(later), "+x"(sooner));
  four = later;
  sum = sooner;
#endif
}
inline Vec absolute(Vec v) { return xsimd::abs(v); }
inline Mask less(Vec a, Vec b) { return a < b; }
inline Mask equal(Vec a, Vec b) { return a == b; }
inline Vec select(Mask m, Vec a, Vec b) { return xsimd::select(m, a, b); }
inline bool any(Mask m) { return xsimd::any(m); }
inline Vec with_sign(Vec v, Vec s) { return absolute(v) | (s & broadcast(-0.0f)); }
inline Vec flip_sign(Vec v, Vec s) { return v ^ (s & broadcast(-0.0f)); }
template <int kBits>
inline Vec shift_bits(Vec v) {
  return xsimd::bitwise_cast<Vec>(xsimd::bitwise_cast<Bits>(v) << kBits);
}
#if defined(MIEN_KERNEL_SSE2) || defined(MIEN_KERNEL_AVX2)
inline Vec keep(Mask m, Vec a) { return Vec(m.data) & a; }
#else
inline Vec keep(Mask m, Vec a) { return select(m, a, broadcast(0.0f)); }
#endif
#if defined(MIEN_KERNEL_NEON)
// xsimd refines estimates of root and quotient, and its min and max keep NaN.
inline Vec square_root(Vec v) { return vsqrtq_f32(v); }
inline Vec divide(Vec a, Vec b) { return vdivq_f32(a, b); }
inline Vec at_least(Vec v, Vec low) { return select(v > low, v, low); }
inline Vec at_most(Vec v, Vec high) { return select(v < high, v, high); }
inline Vec at_most_or_nan(Vec v, Vec high) { return select(high < v, high, v); }
#elif defined(__wasm__)
inline Vec square_root(Vec v) { return xsimd::sqrt(v); }
inline Vec divide(Vec a, Vec b) { return a / b; }
// As on x86 below, where Emscripten's headers would use a comparison and a selection of bits.
inline Vec at_least(Vec v, Vec low) {
  return __m128(wasm_f32x4_pmax(v128_t(__m128(low)), v128_t(__m128(v))));
}
inline Vec at_most(Vec v, Vec high) {
  return __m128(wasm_f32x4_pmin(v128_t(__m128(high)), v128_t(__m128(v))));
}
inline Vec at_most_or_nan(Vec v, Vec high) { return at_most(high, v); }
#else
inline Vec square_root(Vec v) { return xsimd::sqrt(v); }
inline Vec divide(Vec a, Vec b) { return a / b; }
// max and min of x86 are exactly v > low ? v : low and v < high ? v : high.
inline Vec at_least(Vec v, Vec low) { return xsimd::max(v, low); }
inline Vec at_most(Vec v, Vec high) { return xsimd::min(v, high); }
inline Vec at_most_or_nan(Vec v, Vec high) { return xsimd::min(high, v); }
#endif

// With intrinsics: xsimd does not give the bits of a mask.
#if defined(MIEN_KERNEL_NEON)
inline uint32_t different_lanes(Vec a, Vec b) {
  const uint32_t bits[] = {1, 2, 4, 8};
  const uint32x4_t same = vceqq_u32(vreinterpretq_u32_f32(a), vreinterpretq_u32_f32(b));
  return vaddvq_u32(vbicq_u32(vld1q_u32(bits), same));
}
#else
inline uint32_t different_lanes_of_four(__m128 a, __m128 b) {
  const __m128i same = _mm_cmpeq_epi32(_mm_castps_si128(a), _mm_castps_si128(b));
  return ~static_cast<uint32_t>(_mm_movemask_ps(_mm_castsi128_ps(same))) & 0xF;
}
inline uint32_t different_lanes(Vec a, Vec b) {
#if defined(MIEN_KERNEL_SSE2)
  return different_lanes_of_four(a, b);
#elif defined(MIEN_KERNEL_AVX2)
  const __m256i same = _mm256_cmpeq_epi32(_mm256_castps_si256(a), _mm256_castps_si256(b));
  return ~static_cast<uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(same))) & 0xFF;
#else
  return _mm512_cmpneq_epi32_mask(_mm512_castps_si512(a), _mm512_castps_si512(b));
#endif
}
#endif

// With intrinsics: the bits of several masks at once. The sign is the highest bit of the first byte.
inline uint32_t nonzero_of_file(const uint8_t* from) {
#if defined(MIEN_KERNEL_NEON)
  uint32_t bits = 0;
  for (size_t i = 0; i < 32; i += kWidth) {
    bits |= different_lanes(shift_bits<1>(load_big_endian(from + i * 4)), broadcast(0.0f)) << i;
  }
  return bits;
#elif defined(MIEN_KERNEL_AVX512)
  const __m512i size = _mm512_set1_epi32(static_cast<int>(0xFFFFFF7F));
  const uint32_t low = _mm512_test_epi32_mask(_mm512_loadu_si512(from), size);
  return low | uint32_t{_mm512_test_epi32_mask(_mm512_loadu_si512(from + 64), size)} << 16;
#elif defined(MIEN_KERNEL_AVX2)
  const __m256i size = _mm256_set1_epi32(static_cast<int>(0xFFFFFF7F));
  const auto zeros = [=](size_t i) {
    const __m256i v = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from + i * 32));
    return _mm256_cmpeq_epi32(_mm256_and_si256(v, size), _mm256_setzero_si256());
  };
  const __m256i low = _mm256_packs_epi32(zeros(0), zeros(1));
  const __m256i high = _mm256_packs_epi32(zeros(2), zeros(3));
  // Groups of four from each half of each vector, in the order 0 2 4 6 1 3 5 7.
  const __m256i order = _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7);
  return ~static_cast<uint32_t>(
      _mm256_movemask_epi8(_mm256_permutevar8x32_epi32(_mm256_packs_epi16(low, high), order)));
#else
  const __m128i size = _mm_set1_epi32(static_cast<int>(0xFFFFFF7F));
  const auto zeros = [=](size_t i) {
    const __m128i v = _mm_loadu_si128(reinterpret_cast<const __m128i*>(from + i * 16));
    return _mm_cmpeq_epi32(_mm_and_si128(v, size), _mm_setzero_si128());
  };
  const auto bits = [&](size_t i) {
    return static_cast<uint32_t>(_mm_movemask_epi8(_mm_packs_epi16(
        _mm_packs_epi32(zeros(i), zeros(i + 1)), _mm_packs_epi32(zeros(i + 2), zeros(i + 3)))));
  };
  return ~(bits(0) | bits(4) << 16);
#endif
}

// Blocks of a joint matrix ------------------------------------------------------------------------

#if defined(MIEN_KERNEL_AVX512)
using BlockVec = xsimd::batch<float, xsimd::fma3<xsimd::avx2>>;
inline BlockVec mul_add(BlockVec a, BlockVec b, BlockVec c) { return xsimd::fma(a, b, c); }
inline Vec load_pair(const float* from) { return Vec::load_aligned(from); }
inline Vec load_pair(const int16_t* from) {
  const __m256i narrow = _mm256_load_si256(reinterpret_cast<const __m256i*>(from));
  return _mm512_cvtepi32_ps(_mm512_cvtepi16_epi32(narrow));
}
#else
using BlockVec = Vec;
#endif
constexpr size_t kBlockWidth = BlockVec::size;
inline BlockVec load_block(const float* from) { return BlockVec::load_aligned(from); }
inline BlockVec broadcast_block(float value) { return BlockVec(value); }
inline void store_block(float* to, BlockVec value) { value.store_aligned(to); }
inline BlockVec load_block(const int16_t* from) {
#if defined(MIEN_KERNEL_SSE2)
  const __m128i narrow = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(from));
  return _mm_cvtepi32_ps(_mm_srai_epi32(_mm_unpacklo_epi16(narrow, narrow), 16));
#elif defined(MIEN_KERNEL_NEON)
  return vcvtq_f32_s32(vmovl_s16(vld1_s16(from)));
#else
  const __m128i narrow = _mm_load_si128(reinterpret_cast<const __m128i*>(from));
  return _mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(narrow));
#endif
}

inline Vec load_fixed(const int16_t* from) {
#if defined(MIEN_KERNEL_AVX512)
  const __m256i narrow = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
  return _mm512_cvtepi32_ps(_mm512_cvtepi16_epi32(narrow));
#elif defined(MIEN_KERNEL_AVX2)
  const __m128i narrow = _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
  return _mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(narrow));
#else
  return load_block(from);  // here from any address, too
#endif
}

#endif

// Rounding ----------------------------------------------------------------------------------------

// Floats near 1.5 * 2^23 are whole numbers: adding it rounds, and the lowest bits of the sum are those of the
// number, in two's complement.
constexpr float kRounder = 12582912.0f;

#if defined(MIEN_KERNEL_AVX2) || defined(MIEN_KERNEL_AVX512)
constexpr int kToNearest = _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC;
#endif
/// To the nearest whole number, ties to even, for |v| up to 2^22. If the host has changed the rounding mode:
/// still to the nearest, ties to either side. For 0 either zero.
#if defined(MIEN_KERNEL_AVX512)
inline Vec nearest_whole(Vec v) { return _mm512_roundscale_ps(v, kToNearest); }
#elif defined(MIEN_KERNEL_AVX2)
inline Vec nearest_whole(Vec v) { return _mm256_round_ps(v, kToNearest); }
#elif defined(MIEN_KERNEL_NEON)
inline Vec nearest_whole(Vec v) { return vrndnq_f32(v); }
#elif defined(MIEN_KERNEL_SSE2)
inline Vec nearest_whole(Vec v) {
  // In other rounding modes the rest is up to 1: if it is more than 1/2 the product is 1 or more, which
  // truncates to 1 in any mode.
  const Vec rounder = broadcast(kRounder), n = (v + rounder) - rounder;
  const Vec missed = (v - n) * broadcast(0x1.fffffep+0f);
  return n + Vec(_mm_cvtepi32_ps(_mm_cvttps_epi32(missed)));
}
#else
inline Vec nearest_whole(Vec v) {
  const Vec n = (v + kRounder) - kRounder, left = v - n;
  return n + (keep(less(0.5f, left), 1.0f) - keep(less(left, -0.5f), 1.0f));
}
#endif

// In terms of the above ---------------------------------------------------------------------------

constexpr size_t kVecsPerBlock = kBlockLanes / kWidth;

// With intrinsics: the order of the additions is guaranteed, that of xsimd is not.
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

// Sums of finite products can overflow, and infinities of both signs give NaN. NaN becomes the lowest float.
inline Vec saturate(Vec v) {
  constexpr float kLargest = 3.40282347e38f;
  return at_most(at_least(v, broadcast(-kLargest)), broadcast(kLargest));
}

// How a kernel multiplies and adds: as is fastest on the hardware, or with the same bits on every instruction
// set.
struct AsFast {
  template <class V>
  static V mul_add(V a, V b, V c) {
    return mien::MIEN_KERNEL_ISA::mul_add(a, b, c);
  }
};
#if defined(MIEN_KERNEL_SCALAR) || defined(MIEN_KERNEL_SSE2)
using AsPortable = AsFast;  // these always round twice: one copy of each kernel is enough
#else
struct AsPortable {
  template <class V>
  static V mul_add(V a, V b, V c) {
    return a * b + c;  // kernels are built without contraction
  }
};
#endif

// Pairs of vectors --------------------------------------------------------------------------------

/// Two independent vectors that share what is loaded for both.
struct VecPair {
  Vec a, b;
};
struct MaskPair {
  Mask a, b;
};
inline VecPair operator+(VecPair x, VecPair y) { return {x.a + y.a, x.b + y.b}; }
inline VecPair operator-(VecPair x, VecPair y) { return {x.a - y.a, x.b - y.b}; }
inline VecPair operator*(VecPair x, VecPair y) { return {x.a * y.a, x.b * y.b}; }
inline VecPair absolute(VecPair v) { return {absolute(v.a), absolute(v.b)}; }
inline VecPair divide(VecPair x, VecPair y) { return {divide(x.a, y.a), divide(x.b, y.b)}; }
inline VecPair square_root(VecPair v) { return {square_root(v.a), square_root(v.b)}; }
inline VecPair at_least(VecPair v, VecPair w) { return {at_least(v.a, w.a), at_least(v.b, w.b)}; }
inline VecPair at_most(VecPair v, VecPair w) { return {at_most(v.a, w.a), at_most(v.b, w.b)}; }
inline VecPair at_most_or_nan(VecPair v, VecPair w) {
  return {at_most_or_nan(v.a, w.a), at_most_or_nan(v.b, w.b)};
}
inline MaskPair less(VecPair x, VecPair y) { return {less(x.a, y.a), less(x.b, y.b)}; }
inline VecPair select(MaskPair m, VecPair x, VecPair y) {
  return {select(m.a, x.a, y.a), select(m.b, x.b, y.b)};
}
inline VecPair keep(MaskPair m, VecPair v) { return {keep(m.a, v.a), keep(m.b, v.b)}; }
inline bool any(MaskPair m) { return any(m.a) || any(m.b); }
inline VecPair with_sign(VecPair v, VecPair s) {
  return {with_sign(v.a, s.a), with_sign(v.b, s.b)};
}
inline VecPair nearest_whole(VecPair v) { return {nearest_whole(v.a), nearest_whole(v.b)}; }
inline VecPair flip_sign(VecPair v, VecPair s) {
  return {flip_sign(v.a, s.a), flip_sign(v.b, s.b)};
}
template <int kBits>
inline VecPair shift_bits(VecPair v) {
  return {shift_bits<kBits>(v.a), shift_bits<kBits>(v.b)};
}
inline void store(float* to, VecPair v) {
  store(to, v.a);
  store(to + kWidth, v.b);
}

/// For code that is written for V, one vector or two.
template <class V>
struct Make;
template <>
struct Make<Vec> {
  static Vec from(const float* lanes) { return load(lanes); }
  static Vec of(float value) { return broadcast(value); }
};
template <>
struct Make<VecPair> {
  static VecPair from(const float* lanes) { return {load(lanes), load(lanes + kWidth)}; }
  static VecPair of(float value) {
    const Vec v = broadcast(value);
    return {v, v};
  }
};

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
