// SPDX-License-Identifier: MIT
// Correctives.

#pragma once

#include "simd/vec.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

constexpr float kLowest = -3.40282347e38f;

PsdChanges psds(const PsdArgs& args) {
  float* const controls = args.controls;
  uint64_t marks = 0;
  uint32_t any = 0;
  for (size_t e = 0; e < args.count; ++e) {
    const size_t first = args.first_inputs[e], end = args.first_inputs[e + 1];
    float product = 1.0f;
    for (size_t i = first; i < end; ++i) {
      const float input = controls[args.inputs[i]];
      product *= lower_of(higher_of(input, 0.0f), 1.0f);
    }
    const float value = higher_of(lower_of(product * args.weights[e], 1.0f), kLowest);
    const size_t output = args.outputs[e];
    const uint32_t difference = bits_of(value) ^ bits_of(controls[output]);
    controls[output] = value;
    marks |= args.marks[output] & (uint64_t{0} - uint64_t{difference != 0});
    any |= difference;
  }
  return {marks, any != 0};
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
