// SPDX-License-Identifier: MIT
// Controls and correctives.

#pragma once

#include "simd/control_kernels.h"
#include "simd/quad.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

constexpr float kLowest = -3.40282347e38f;

void nonzero(const NonzeroArgs& args) {
  const float* const values = args.values;
  const size_t count = args.count;
  const Vec zero = broadcast(0.0f);
  for (size_t first = 0; first < count; first += 64) {
    const size_t left = count - first;
    uint64_t word = 0;
    size_t i = 0;
    for (; i + kWidth <= (left < 64 ? left : 64); i += kWidth) {
      const uint64_t lanes = different_lanes(absolute(load(values + first + i)), zero);
      word |= lanes << i;
    }
    for (; i < 64 && i < left; ++i) word |= uint64_t{values[first + i] != 0.0f} << i;
    args.words[first / 64] = word;
  }
}

void different(const DifferentArgs& args) {
  const float *const values = args.values, *const others = args.others;
  const size_t count = args.count;
  for (size_t first = 0; first < count; first += 64) {
    const size_t left = count - first, end = left < 64 ? left : 64;
    uint64_t word = 0;
    size_t i = 0;
    for (; i + kWidth <= end; i += kWidth) {
      const uint64_t lanes =
          different_lanes(load_any(values + first + i), load_any(others + first + i));
      word |= lanes << i;
    }
    for (; i < end; ++i) {
      word |= uint64_t{bits_of(values[first + i]) != bits_of(others[first + i])} << i;
    }
    args.words[first / 64] = word;
  }
}

inline float corrective(const float* controls, const uint16_t* inputs, size_t count, float weight) {
  float product = 1.0f;
  for (size_t i = 0; i < count; ++i) {
    product *= lower_of(higher_of(controls[inputs[i]], 0.0f), 1.0f);
  }
  return higher_of(lower_of(product * weight, 1.0f), kLowest);
}

uint64_t psds(const PsdArgs& args) {
  float* const controls = args.controls;
  const uint64_t* const marks = args.marks;
  const uint16_t* const outputs = args.outputs;
  uint64_t changed = 0;
  const auto note = [&](size_t entry, uint32_t differs) {
    changed |= marks[outputs[entry]] & (uint64_t{0} - uint64_t{differs});
  };
  const Quad zero = broadcast4(0.0f), one = broadcast4(1.0f), lowest = broadcast4(kLowest);
  for (size_t e = 0; e < args.count;) {
    const size_t length = args.run_lengths[e];
    const size_t end = e + length < args.count ? e + length : args.count;
    const uint16_t* inputs = args.inputs + args.first_inputs[e];
    const size_t n = args.first_inputs[e + 1] - args.first_inputs[e];
    for (; e + 4 <= end; e += 4, inputs += 4 * n) {
      Quad product = one;
      for (size_t i = 0; i < n; ++i) {
        product = product * lower4(higher4(gather4(controls, inputs + i, n), zero), one);
      }
      const Quad values = higher4(lower4(product * load4(args.weights + e), one), lowest);
      const uint32_t lanes = different_lanes4(values, gather4(controls, outputs + e, 1));
      scatter4(controls, outputs + e, values);
      note(e, lanes & 1);
      note(e + 1, lanes >> 1 & 1);
      note(e + 2, lanes >> 2 & 1);
      note(e + 3, lanes >> 3);
    }
    for (; e < end; ++e, inputs += n) {
      const float value = corrective(controls, inputs, n, args.weights[e]);
      float& output = controls[outputs[e]];
      const uint32_t differs = bits_of(value) != bits_of(output);
      output = value;
      note(e, differs);
    }
  }
  return changed;
}

uint32_t psd_list(const PsdListArgs& args) {
  float* const controls = args.controls;
  const uint32_t* const first_inputs = args.first_inputs;
  uint16_t* changed = args.changed;
  for (uint32_t i = 0; i < args.count; ++i) {
    const uint16_t e = args.entries[i];
    const uint32_t first = first_inputs[e];
    const float value =
        corrective(controls, args.inputs + first, first_inputs[e + 1u] - first, args.weights[e]);
    float& output = controls[args.outputs[e]];
    const bool differs = bits_of(value) != bits_of(output);
    output = value;
    *changed = e;
    changed += differs;
  }
  return static_cast<uint32_t>(changed - args.changed);
}

inline Vec clamp01(Vec v) { return at_most(at_least(v, broadcast(0.0f)), broadcast(1.0f)); }

void psd_batch(const PsdBatchArgs& args) {
  for (size_t e = 0; e < args.count; ++e) {
    const Vec weight = broadcast(args.weights[e]);
    const size_t first = args.first_inputs[e], end = args.first_inputs[e + 1];
    uint32_t changed = 0;
    for (size_t lane = 0; lane < kBatchLanes; lane += kWidth) {
      Vec product = broadcast(1.0f);
      for (size_t i = first; i < end; ++i) {
        const float* const input = args.controls + size_t{args.inputs[i]} * kBatchLanes + lane;
        product = product * clamp01(load(input));
      }
      float* const output = args.controls + size_t{args.outputs[e]} * kBatchLanes + lane;
      const Vec value = at_least(at_most(product * weight, broadcast(1.0f)), broadcast(kLowest));
      changed |= different_lanes(value, load(output)) << lane;
      store(output, value);
    }
    args.changed[e] = changed;
  }
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
