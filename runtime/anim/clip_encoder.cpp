// SPDX-License-Identifier: MIT
#include "runtime/anim/clip_encoder.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace mien {
namespace {

constexpr uint32_t kMaxEdges = 7;

uint32_t width_of(uint32_t value) {
  uint32_t width = 0;
  while (width < 32 && value >> width != 0) ++width;
  return width;
}
/// Widths of 31 are written as 32.
uint32_t width_code(uint32_t value) {
  const uint32_t width = width_of(value);
  return width < 31 ? width : 31;
}
uint32_t zigzag(uint32_t number) { return number << 1 ^ (0u - (number >> 31)); }

/// Samples of a block in the domain of a mode.
struct Samples {
  BlockMode mode;
  uint32_t parameter;  // index of scale, or shift
  uint32_t numbers[kBlockFrames];
};

/// Finds the coarsest grid that has all the values.
bool find_grid(const float* values, uint32_t count, Samples& samples) {
  for (uint32_t g = 0; g < 16; ++g) {
    uint32_t i = 0;
    for (; i < count; ++i) {
      const double number = std::floor(static_cast<double>(values[i]) * kGridScales[g] + 0.5);
      if (!(std::abs(number) < kMaxGridNumber)) return false;  // and a finer grid would not help
      const auto k = static_cast<int32_t>(number);
      if (bits_of(static_cast<float>(k) / kGridScales[g]) != bits_of(values[i])) break;
      samples.numbers[i] = static_cast<uint32_t>(k);
    }
    if (i < count) continue;
    samples.mode = kBlockGrid;
    samples.parameter = g;
    return true;
  }
  return false;
}

void order_floats(const float* values, uint32_t count, Samples& samples) {
  uint32_t all = 0;
  for (uint32_t i = 0; i < count; ++i) all |= bits_of(values[i]);
  samples.mode = kBlockFloat;
  samples.parameter = lowest_bit(all);  // values that differ are not all +0
  for (uint32_t i = 0; i < count; ++i) {
    samples.numbers[i] = ordered_from_bits(bits_of(values[i])) >> samples.parameter;
  }
}

void put_mask(uint64_t mask, uint32_t count, BitWriter& writer) {
  uint32_t edges = 0, places[kBlockFrames];
  uint64_t before = 0;
  for (uint32_t i = 0; i < count; ++i) {
    if ((mask >> i & 1) != before) places[edges++] = i;
    before = mask >> i & 1;
  }
  if (edges > kMaxEdges) {
    writer.put(0, 3);
    writer.put(mask, 64);
    return;
  }
  writer.put(edges, 3);
  for (uint32_t i = 0; i < edges; ++i) writer.put(places[i], 6);
}

/// Writes the widths of runs as codes. With fewer bits for each code the smallest widths have to grow, which
/// makes the residuals larger.
void put_widths(uint32_t* widths, uint32_t runs, uint32_t residuals, BitWriter& writer) {
  uint32_t largest = 0, best = 0, best_bits = ~0u;
  for (uint32_t r = 0; r < runs; ++r) largest = std::max(largest, widths[r]);
  const auto least_with = [largest](uint32_t n) {
    return largest >> n == 0 ? 0 : largest + 1 - (1u << n);
  };
  for (uint32_t n = 0; n <= kWidthBits; ++n) {
    uint32_t bits = n * runs + (n < kWidthBits ? kWidthBits : 0);
    for (uint32_t r = 0; r < runs; ++r) {
      const uint32_t samples = std::min(kRunSamples, residuals - r * kRunSamples);
      bits += samples * width_of_code(std::max(widths[r], least_with(n)));
    }
    if (bits < best_bits) best = n, best_bits = bits;
  }
  const uint32_t least = least_with(best);
  writer.put(best, kWidthSizeBits);
  if (best < kWidthBits) writer.put(least, kWidthBits);
  for (uint32_t r = 0; r < runs; ++r) {
    widths[r] = std::max(widths[r], least);
    writer.put(widths[r] - least, best);
  }
}

/// `mask` has a bit for each sample that is not left out: for some of the samples, or all.
void put_samples(const Samples& samples, uint32_t count, uint64_t mask, bool linear,
                 BitWriter& writer) {
  const bool grid = samples.mode == kBlockGrid;
  const bool masked = bit_count(mask) < count;
  writer.put(samples.mode, 2);
  writer.put(linear, 1);
  writer.put(masked, 1);
  writer.put(samples.parameter, grid ? 4 : 5);
  if (masked) put_mask(mask, count, writer);

  uint32_t codes[kBlockFrames], residuals = 0, last = 0, before = 0;
  bool first = true;
  for (uint32_t i = 0; i < count; ++i) {
    if ((mask >> i & 1) == 0) continue;
    const uint32_t number = samples.numbers[i];
    if (first) {
      const uint32_t width = width_code(zigzag(number));
      if (grid) writer.put(width, kWidthBits);
      if (grid) writer.put(zigzag(number), width_of_code(width));
      if (!grid) writer.put(number, 32 - samples.parameter);
      before = number;
      first = false;
    } else {
      codes[residuals++] = zigzag(number - last - (linear ? last - before : 0));
      before = last;
    }
    last = number;
  }

  uint32_t widths[kBlockFrames / kRunSamples], runs = 0;
  for (uint32_t i = 0; i < residuals; i += kRunSamples) {
    uint32_t all = 0;
    for (uint32_t k = i; k < residuals && k < i + kRunSamples; ++k) all |= codes[k];
    widths[runs++] = width_code(all);
  }
  put_widths(widths, runs, residuals, writer);
  for (uint32_t i = 0; i < residuals; ++i) {
    writer.put(codes[i], width_of_code(widths[i / kRunSamples]));
  }
}

/// The encoding with the fewest bits so far.
struct Best {
  Samples samples;
  uint64_t mask;
  bool linear;
  uint64_t bits = ~uint64_t{0};
};

void try_samples(const Samples& samples, uint32_t count, uint64_t nonzero, Best& best) {
  const uint64_t all = count == 64 ? ~uint64_t{0} : (uint64_t{1} << count) - 1;
  for (uint64_t mask : {all, nonzero}) {
    for (bool linear : {false, true}) {
      BitWriter counter;
      put_samples(samples, count, mask, linear, counter);
      if (counter.bit < best.bits) best = {samples, mask, linear, counter.bit};
    }
    if (nonzero == all) break;
  }
}

}  // namespace

BlockMode encode_channel(const float* samples, uint32_t count, BitWriter& writer) {
  uint64_t nonzero = 0;
  bool constant = true;
  for (uint32_t i = 0; i < count; ++i) {
    constant &= bits_of(samples[i]) == bits_of(samples[0]);
    if (bits_of(samples[i]) != 0) nonzero |= uint64_t{1} << i;
  }
  if (constant) {
    const BlockMode mode = nonzero == 0 ? kBlockZero : kBlockConstant;
    writer.put(mode, 2);
    if (mode == kBlockConstant) writer.put(bits_of(samples[0]), 32);
    return mode;
  }
  Best best;
  Samples candidate;
  if (find_grid(samples, count, candidate)) try_samples(candidate, count, nonzero, best);
  order_floats(samples, count, candidate);
  try_samples(candidate, count, nonzero, best);
  put_samples(best.samples, count, best.mask, best.linear, writer);
  return best.samples.mode;
}

}  // namespace mien
