// SPDX-License-Identifier: MIT
// Correctives.

#pragma once

#include "simd/vec.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

inline Vec clamp01(Vec v) { return at_most(at_least(v, broadcast(0.0f)), broadcast(1.0f)); }

void psd_batch(const PsdBatchArgs& args) {
  for (size_t e = 0; e < args.count; ++e) {
    const Vec weight = broadcast(args.weights[e]);
    const size_t first = args.first_inputs[e], end = args.first_inputs[e + 1];
    for (size_t lane = 0; lane < kBatchLanes; lane += kWidth) {
      Vec product = broadcast(1.0f);
      for (size_t i = first; i < end; ++i) {
        const float* const input = args.controls + size_t{args.inputs[i]} * kBatchLanes + lane;
        product = product * clamp01(load(input));
      }
      float* const output = args.controls + size_t{args.outputs[e]} * kBatchLanes + lane;
      const Vec value = at_most(product * weight, broadcast(1.0f));
      store(output, at_least(value, broadcast(-3.40282347e38f)));
    }
  }
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
