// SPDX-License-Identifier: MIT
#include "integrations/program/io/fingerprint.h"

#include <mien.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <vector>
#if defined(__SSE2__) && (defined(__GNUC__) || defined(__clang__))
#define MIEN_FINGERPRINT_X86 1
#include <immintrin.h>
#endif

#include "integrations/program/io/failure.h"
#include "integrations/program/math/finite.h"

namespace mien::cli {

namespace fs = std::filesystem;

namespace {

constexpr size_t kReadBytes = size_t{1} << 18;
constexpr uint64_t kOdd = 0x9e3779b97f4a7c15;

constexpr uint64_t stirred(uint64_t bits) {
  bits = (bits ^ bits >> 32) * kOdd;
  bits = (bits ^ bits >> 29) * kOdd;
  return bits ^ bits >> 32;
}

// The sums of a block are NH, as UMAC has it (RFC 4418, 5.2): two neighboring words of 32 bits, each plus a key of its
// place, are multiplied, and the products of a lane are added. A stripe has four parts of 32 bytes, with two lanes each.
constexpr size_t kStripeKeys = Fingerprint::kStripeBytes / 4;

struct Keys {
  alignas(32) uint32_t words[kStripeKeys * Fingerprint::kBlockStripes];
};

constexpr Keys make_keys() {
  Keys keys{};
  uint64_t number = 0;
  for (uint32_t& word : keys.words) word = static_cast<uint32_t>(stirred(++number * kOdd));
  return keys;
}

constexpr Keys kKeys = make_keys();

#if defined(MIEN_FINGERPRINT_X86)

template <bool kHasFloats>
inline void add_products(const unsigned char* bytes, const uint32_t* keys, __m128i& products,
                         __m128& floats) {
  __m128i words = _mm_loadu_si128(reinterpret_cast<const __m128i*>(bytes));
  if (kHasFloats) floats = _mm_add_ps(floats, _mm_castsi128_ps(words));
  words = _mm_add_epi32(words, _mm_load_si128(reinterpret_cast<const __m128i*>(keys)));
  products = _mm_add_epi64(products, _mm_mul_epu32(words, _mm_shuffle_epi32(words, 0xf5)));
}

/// Returns the sum of the stripes' floats, if they are wanted.
template <bool kHasFloats>
float add_stripes(const unsigned char* bytes, size_t count, const uint32_t* keys, uint64_t* sums) {
  auto* const to = reinterpret_cast<__m128i*>(sums);
  __m128i a = _mm_loadu_si128(to), b = _mm_loadu_si128(to + 1);
  __m128i c = _mm_loadu_si128(to + 2), d = _mm_loadu_si128(to + 3);
  __m128 p = _mm_setzero_ps(), q = p;
  for (const unsigned char* end = bytes + count * Fingerprint::kStripeBytes; bytes != end;
       bytes += Fingerprint::kStripeBytes, keys += kStripeKeys) {
    add_products<kHasFloats>(bytes, keys, a, p);
    add_products<kHasFloats>(bytes + 16, keys + 4, a, q);
    add_products<kHasFloats>(bytes + 32, keys + 8, b, p);
    add_products<kHasFloats>(bytes + 48, keys + 12, b, q);
    add_products<kHasFloats>(bytes + 64, keys + 16, c, p);
    add_products<kHasFloats>(bytes + 80, keys + 20, c, q);
    add_products<kHasFloats>(bytes + 96, keys + 24, d, p);
    add_products<kHasFloats>(bytes + 112, keys + 28, d, q);
  }
  _mm_storeu_si128(to, a), _mm_storeu_si128(to + 1, b);
  _mm_storeu_si128(to + 2, c), _mm_storeu_si128(to + 3, d);
  float four[4];
  _mm_storeu_ps(four, _mm_add_ps(p, q));
  return four[0] + four[1] + four[2] + four[3];
}

#define MIEN_AVX2 __attribute__((target("avx2")))

/// The same with 32 bytes at a time. Templates of attributes that differ are not inlined, so it has no parts.
template <bool kHasFloats>
MIEN_AVX2 float add_stripes_avx2(const unsigned char* bytes, size_t count, const uint32_t* keys,
                                 uint64_t* sums) {
  const __m256i zero = _mm256_setzero_si256();
  __m256i products[4] = {zero, zero, zero, zero};
  __m256 floats[2] = {_mm256_setzero_ps(), _mm256_setzero_ps()};
  const auto* from = reinterpret_cast<const __m256i*>(bytes);
  const auto* key = reinterpret_cast<const __m256i*>(keys);
  for (const __m256i* end = from + 4 * count; from != end; from += 4, key += 4) {
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC unroll 4
#endif
    for (size_t i = 0; i < 4; ++i) {
      __m256i words = _mm256_loadu_si256(from + i);
      if (kHasFloats) floats[i % 2] = _mm256_add_ps(floats[i % 2], _mm256_castsi256_ps(words));
      words = _mm256_add_epi32(words, _mm256_load_si256(key + i));
      const __m256i seconds = _mm256_shuffle_epi32(words, 0xf5);
      products[i] = _mm256_add_epi64(products[i], _mm256_mul_epu32(words, seconds));
    }
  }
  for (size_t i = 0; i < 4; ++i) {
    uint64_t lanes[4];
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(lanes), products[i]);
    sums[2 * i] += lanes[0] + lanes[2];
    sums[2 * i + 1] += lanes[1] + lanes[3];
  }
  float eight[8];
  _mm256_storeu_ps(eight, _mm256_add_ps(floats[0], floats[1]));
  float sum = 0;
  for (const float part : eight) sum += part;
  return sum;
}

#else  // plain C++

uint32_t word_at(const unsigned char* bytes) {
  return bytes[0] | uint32_t{bytes[1]} << 8 | uint32_t{bytes[2]} << 16 | uint32_t{bytes[3]} << 24;
}

template <bool kHasFloats>
float add_stripes(const unsigned char* bytes, size_t count, const uint32_t* keys, uint64_t* sums) {
  float float_sum = 0;
  for (; count != 0; --count, keys += kStripeKeys) {
    for (size_t pair = 0; pair < kStripeKeys / 2; ++pair, bytes += 8) {
      const uint32_t first = word_at(bytes) + keys[2 * pair];
      const uint32_t second = word_at(bytes + 4) + keys[2 * pair + 1];
      sums[pair / 4 * 2 + pair % 2] += uint64_t{first} * second;
      if (!kHasFloats) continue;
      float floats[2];
      std::memcpy(floats, bytes, 8);
      float_sum += floats[0] + floats[1];
    }
  }
  return float_sum;
}

#endif

void add_file(const std::string& path, Fingerprint& fingerprint) {
  const std::unique_ptr<FILE, int (*)(FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  std::vector<char> piece(kReadBytes);
  size_t got = 0;
  while (file && (got = std::fread(piece.data(), 1, piece.size(), file.get())) != 0) {
    fingerprint.add(piece.data(), got);
  }
  if (file && !std::ferror(file.get())) return;
  fail(kFile, "cannot read", path, std::strerror(errno), "check the path and its permissions");
}

}  // namespace

Fingerprint::Fingerprint() : Fingerprint(mien_isa_available(MIEN_ISA_AVX2) != 0) {}

void Fingerprint::mix(const unsigned char* stripes, size_t count, float* float_sum) {
  auto* add = float_sum ? add_stripes<true> : add_stripes<false>;
#if defined(MIEN_FINGERPRINT_X86)
  if (has_avx2_) add = float_sum ? add_stripes_avx2<true> : add_stripes_avx2<false>;
#else
  static_cast<void>(has_avx2_);
#endif
  while (count != 0) {
    const size_t part = std::min(count, kBlockStripes - stripe_);
    const uint32_t* const keys = kKeys.words + kStripeKeys * stripe_;
    const float sum = add(stripes, part, keys, sums_);
    if (float_sum) *float_sum += sum;
    stripes += part * kStripeBytes, count -= part, stripe_ += part;
    if (stripe_ == kBlockStripes) end_block();
  }
}

void Fingerprint::end_block() {
  for (size_t i = 0; i < 8; ++i) {
    const uint64_t bits = (lanes_[i] ^ sums_[i]) * kOdd;
    lanes_[i] = bits ^ bits >> 29;
    sums_[i] = 0;
  }
  stripe_ = 0;
}

void Fingerprint::add_bytes(const void* bytes, size_t size, float* float_sum) {
  const auto* at = static_cast<const unsigned char*>(bytes);
  while (size != 0) {
    const size_t filled = size_ % kStripeBytes;
    size_t part = std::min(size, kStripeBytes - filled);
    if (part == kStripeBytes) {
      part = size - size % kStripeBytes;
      mix(at, part / kStripeBytes, float_sum);
    } else {
      std::memcpy(rest_ + filled, at, part);
      if (filled + part == kStripeBytes) mix(rest_, 1, float_sum);
    }
    at += part, size -= part, size_ += part;
  }
}

size_t Fingerprint::add_floats(const float* numbers, size_t count) {
  if (size_ % 4 != 0) {  // words are no floats then
    add(numbers, 4 * count);
    return math::finite_count(numbers, count);
  }
  // Infinities and what is not a number stay in a sum. It may also overflow: then each is looked at.
  float sum = 0;
  add_bytes(numbers, 4 * count, &sum);
  const size_t waiting = std::min<size_t>(count, size_ % kStripeBytes / 4);
  for (size_t i = count - waiting; i < count; ++i) sum += numbers[i];
  return std::isfinite(sum) ? count : math::finite_count(numbers, count);
}

std::string Fingerprint::text() const {
  Fingerprint end = *this;
  std::memset(end.rest_ + size_ % kStripeBytes, 0, kStripeBytes - size_ % kStripeBytes);
  end.mix(end.rest_, 1, nullptr);
  end.end_block();
  uint64_t bits = size_;
  for (const uint64_t lane : end.lanes_) bits = stirred(bits ^ lane);
  char digits[17];
  std::snprintf(digits, sizeof(digits), "%016llx", static_cast<unsigned long long>(bits));
  return digits;
}

std::string file_fingerprint(const std::string& path) {
  Fingerprint fingerprint;
  std::error_code reason;
  if (!fs::is_directory(path, reason)) {
    add_file(path, fingerprint);
    return fingerprint.text();
  }
  std::vector<std::string> files;
  for (fs::directory_iterator it(path, reason), end; !reason && it != end; it.increment(reason)) {
    if (it->is_regular_file(reason)) files.push_back(it->path().string());
  }
  if (reason) {
    fail(kFile, "cannot read", path, reason.message(), "check the path and its permissions");
  }
  std::sort(files.begin(), files.end());
  for (const std::string& file : files) {
    fingerprint.add(fs::path(file).filename().string() + '\n');
    add_file(file, fingerprint);
  }
  return fingerprint.text();
}

}  // namespace mien::cli
