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
  uint32_t parameter;    // index of scale, or shift
  uint32_t curve_scale;  // of floats of orders 2 and 3
  uint32_t max_order;
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
    samples.max_order = kMaxOrder;
    return true;
  }
  return false;
}

void order_floats(const float* values, uint32_t count, Samples& samples) {
  uint32_t all = 0;
  float largest = 0;
  for (uint32_t i = 0; i < count; ++i) {
    all |= bits_of(values[i]);
    largest = std::max(largest, std::abs(values[i]));
  }
  samples.mode = kBlockFloat;
  samples.parameter = lowest_bit(all);  // values that differ are not all +0
  samples.max_order = 1;
  // The largest scale that keeps integers below 2^30.
  for (uint32_t scale = 0; scale < 32 && samples.parameter == 0; ++scale) {
    if (largest * curve_scale(scale) >= 0x1p30f) break;
    samples.max_order = kMaxOrder;
    samples.curve_scale = scale;
  }
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

/// How a channel is written.
struct Form {
  uint64_t mask;  // a bit for each sample that is not left out: for some of the samples, or all
  uint32_t order;
  uint32_t run_samples;
};

/// An integer of a curve, truncated to 24 bits, as an ordered float.
uint32_t ordered_from_curve(uint32_t number, float scale) {
  const bool negative = number >> 31 != 0;
  uint32_t magnitude = negative ? 0u - number : number;
  const uint32_t width = width_of(magnitude);
  if (width > 24) magnitude &= ~uint32_t{0} << (width - 24);
  const float value = static_cast<float>(static_cast<int32_t>(magnitude & 0x7FFFFFFF)) / scale;
  return ordered_from_bits(bits_of(value) | (negative ? 1u << 31 : 0));
}

/// Predicts samples as the decoder does.
class Predictor {
 public:
  Predictor(const Samples& samples, uint32_t order, uint32_t first)
      : order_(order), curve_(samples.mode == kBlockFloat && order >= 2), last_(first) {
    number_ = first;
    if (!curve_) return;
    scale_ = curve_scale(samples.curve_scale);
    number_ = curve_number(first, scale_);
    slope_ = ordered_from_curve(number_, scale_) - first;
  }

  /// Of the sample after those that were added.
  uint32_t next() const { return last_ + slope_; }

  void add(uint32_t sample) {
    ++age_;
    const uint32_t number = curve_ ? curve_number(sample, scale_) : sample;
    const uint32_t difference = number - number_, bend = difference - difference_;
    slope_ = order_ >= 1 ? difference : 0;
    if (order_ >= 2 && age_ >= 2) slope_ += bend;
    if (order_ >= 3 && age_ >= 3) slope_ += bend - bend_;
    if (curve_) slope_ = ordered_from_curve(number + slope_, scale_) - sample;
    number_ = number;
    difference_ = difference;
    bend_ = bend;
    last_ = sample;
  }

 private:
  uint32_t order_;
  bool curve_;
  float scale_ = 1;
  uint32_t age_ = 0;  // samples after the first
  uint32_t last_, number_, slope_ = 0, difference_ = 0, bend_ = 0;
};

/// The samples that are not left out, as residuals.
struct Residuals {
  uint32_t first = 0;  // sample
  uint32_t count = 0;
  uint32_t codes[kBlockFrames];
};

void find_residuals(const Samples& samples, uint32_t count, uint64_t mask, uint32_t order,
                    Residuals& residuals) {
  uint32_t i = lowest_bit(mask);
  residuals.first = samples.numbers[i];
  residuals.count = 0;
  Predictor predictor(samples, order, residuals.first);
  for (++i; i < count; ++i) {
    if ((mask >> i & 1) == 0) continue;
    residuals.codes[residuals.count++] = zigzag(samples.numbers[i] - predictor.next());
    predictor.add(samples.numbers[i]);
  }
}

/// How the widths of runs are written.
struct Widths {
  uint32_t codes[kBlockFrames / kShortRunSamples];  // of 5 bits
  uint32_t runs = 0;
  uint32_t code_bits = 0, least = 0, largest = 0;
  uint64_t bits = ~uint64_t{0};  // of the widths and of all residuals

  /// Of the code of `code_bits` that has at least this width.
  uint32_t code(uint32_t width) const {
    const uint32_t highest = (1u << code_bits) - 1;
    if (code_bits == 0 || width <= least) return 0;
    return std::min(width - least, highest);
  }
  uint32_t width(uint32_t code) const {
    return code_bits > 0 && code == (1u << code_bits) - 1 ? largest : least + code;
  }
};

/// Chooses the codes that take the fewest bits. `samples_of_width[w]`: how many samples are in runs of width w.
void choose_codes(const uint32_t (&samples_of_width)[32], Widths& widths) {
  // Samples, and their bits, of all smaller widths.
  uint32_t samples_below[33] = {}, bits_below[33] = {};
  uint32_t smallest = 31, largest = 0;
  for (uint32_t w = 0; w < 32; ++w) {
    samples_below[w + 1] = samples_below[w] + samples_of_width[w];
    bits_below[w + 1] = bits_below[w] + samples_of_width[w] * width_of_code(w);
    if (samples_of_width[w] == 0) continue;
    smallest = std::min(smallest, w);
    largest = w;
  }
  const uint32_t samples = samples_below[32];
  widths.largest = widths.least = largest;
  widths.bits = kWidthBits + samples * width_of_code(largest);
  for (uint32_t n = 1; n <= kWidthCodeBits; ++n) {
    for (uint32_t least = smallest; least < largest; ++least) {
      // Widths below `least` grow to it, those from `escape` on to the largest.
      const uint32_t escape = std::min(least + (1u << n) - 1, 32u);
      const uint32_t bits = 2 * kWidthBits + n * widths.runs +
                            samples_below[least] * width_of_code(least) + bits_below[escape] -
                            bits_below[least] +
                            (samples - samples_below[escape]) * width_of_code(largest);
      if (bits >= widths.bits) continue;
      widths.bits = bits;
      widths.code_bits = n;
      widths.least = least;
    }
  }
}

Widths find_widths(const Residuals& residuals, uint32_t run_samples) {
  Widths widths;
  uint32_t samples_of_width[32] = {};
  for (uint32_t i = 0; i < residuals.count; i += run_samples) {
    uint32_t all = 0;
    const uint32_t end = std::min(residuals.count, i + run_samples);
    for (uint32_t k = i; k < end; ++k) all |= residuals.codes[k];
    widths.codes[widths.runs++] = width_code(all);
    samples_of_width[width_code(all)] += end - i;
  }
  choose_codes(samples_of_width, widths);
  return widths;
}

void put_samples(const Samples& samples, uint32_t count, const Form& form, BitWriter& writer) {
  const bool grid = samples.mode == kBlockGrid;
  const bool masked = bit_count(form.mask) < count;
  writer.put(samples.mode, 2);
  writer.put(form.order, 2);
  writer.put(masked, 1);
  writer.put(form.run_samples == kShortRunSamples, 1);
  const bool curve = !grid && form.order >= 2;
  writer.put(curve ? samples.curve_scale : samples.parameter, grid ? 4 : 5);
  if (masked) put_mask(form.mask, count, writer);

  Residuals residuals;
  find_residuals(samples, count, form.mask, form.order, residuals);
  if (grid) {
    const uint32_t width = width_code(zigzag(residuals.first));
    writer.put(width, kWidthBits);
    writer.put(zigzag(residuals.first), width_of_code(width));
  } else {
    writer.put(residuals.first, 32 - samples.parameter);
  }

  const Widths widths = find_widths(residuals, form.run_samples);
  writer.put(widths.code_bits, kWidthCodeSizeBits);
  writer.put(widths.least, kWidthBits);
  if (widths.code_bits > 0) writer.put(widths.largest, kWidthBits);
  for (uint32_t r = 0; r < widths.runs; ++r) {
    writer.put(widths.code(widths.codes[r]), widths.code_bits);
  }
  for (uint32_t i = 0; i < residuals.count; ++i) {
    const uint32_t code = widths.code(widths.codes[i / form.run_samples]);
    writer.put(residuals.codes[i], width_of_code(widths.width(code)));
  }
}

/// The encoding with the fewest bits so far.
struct Best {
  Samples samples;
  Form form = {};
  uint64_t bits = ~uint64_t{0} / 2;
};

/// Short runs and high orders take more time to decode: they have to save one bit of this many.
constexpr uint64_t kShortRunsSave = 20, kCurvesSave = 10;

void try_samples(const Samples& samples, uint32_t count, uint64_t nonzero, Best& best) {
  const uint64_t all = count == 64 ? ~uint64_t{0} : (uint64_t{1} << count) - 1;
  for (uint64_t mask : {all, nonzero}) {
    BitWriter mask_counter;
    if (mask != all) put_mask(mask, count, mask_counter);
    Residuals residuals;
    for (uint32_t order = 0; order <= samples.max_order; ++order) {
      find_residuals(samples, count, mask, order, residuals);
      const uint64_t head =
          mask_counter.bit +
          (samples.mode == kBlockGrid
               ? 4 + kWidthBits + width_of_code(width_code(zigzag(residuals.first)))
               : 5 + 32 - samples.parameter);
      const uint64_t bits = head + find_widths(residuals, kRunSamples).bits;
      const uint64_t short_bits = head + find_widths(residuals, kShortRunSamples).bits;
      const bool short_runs = short_bits + bits / kShortRunsSave < bits;
      const uint64_t least = short_runs ? short_bits : bits;
      const bool slower = order >= 2 && best.form.order < 2;
      if (least + (slower ? best.bits / kCurvesSave : 0) >= best.bits) continue;
      best = {samples, {mask, order, short_runs ? kShortRunSamples : kRunSamples}, least};
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
  put_samples(best.samples, count, best.form, writer);
  return best.samples.mode;
}

}  // namespace mien
