// SPDX-License-Identifier: MIT
// Kernels by themselves. Dense layers, for one character and for 32 at once, against what the core could
// do: the peak is measured in the same run, by multiply-adds that touch no memory, and `of_peak` is the
// share of it that a layer reaches. Products of padding do not count. Times are those of the processor:
// what else runs on the machine does not count.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

#include "bench/bench_support.h"
#include "runtime/base/half.h"
#include "simd/kernels.h"

#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

namespace mien::bench {
namespace {

// Twelve sums, each of which waits for itself only, are more than a core has under way. The asm
// hides from the compiler what they come to. Names, because it might keep an array in memory.
#define MIEN_PEAK(name, attribute, Type, Constraint, zero, step)                                  \
  attribute void name(size_t rounds) {                                                            \
    Type a = (zero), b = a, c = a, d = a, e = a, f = a, g = a, h = a, i = a, j = a, k = a, l = a; \
    for (size_t r = 0; r < rounds; ++r) {                                                         \
      a = step(a), b = step(b), c = step(c), d = step(d), e = step(e), f = step(f);               \
      g = step(g), h = step(h), i = step(i), j = step(j), k = step(k), l = step(l);               \
      asm volatile("" : "+" Constraint(a), "+" Constraint(b), "+" Constraint(c));                 \
      asm volatile("" : "+" Constraint(d), "+" Constraint(e), "+" Constraint(f));                 \
      asm volatile("" : "+" Constraint(g), "+" Constraint(h), "+" Constraint(i));                 \
      asm volatile("" : "+" Constraint(j), "+" Constraint(k), "+" Constraint(l));                 \
    }                                                                                             \
  }
constexpr int kSums = 12;

#if defined(__x86_64__)
#define MIEN_SCALAR(s) ((s)*0.5f + 0.25f)
#define MIEN_SSE2(s) _mm_add_ps(_mm_mul_ps(s, _mm_set1_ps(0.5f)), _mm_set1_ps(0.25f))
#define MIEN_AVX2(s) _mm256_fmadd_ps(s, _mm256_set1_ps(0.5f), _mm256_set1_ps(0.25f))
#define MIEN_AVX512(s) _mm512_fmadd_ps(s, _mm512_set1_ps(0.5f), _mm512_set1_ps(0.25f))
MIEN_PEAK(scalar_peak, , float, "x", 0.5f, MIEN_SCALAR)
MIEN_PEAK(sse2_peak, , __m128, "x", _mm_set1_ps(0.5f), MIEN_SSE2)
MIEN_PEAK(avx2_peak, __attribute__((target("avx2,fma"))), __m256, "x", _mm256_set1_ps(0.5f),
          MIEN_AVX2)
MIEN_PEAK(avx512_peak, __attribute__((target("avx512f"))), __m512, "v", _mm512_set1_ps(0.5f),
          MIEN_AVX512)
#elif defined(__aarch64__)
#define MIEN_SCALAR(s) ((s)*0.5f + 0.25f)
#define MIEN_NEON(s) vfmaq_f32(vdupq_n_f32(0.25f), s, vdupq_n_f32(0.5f))
MIEN_PEAK(scalar_peak, , float, "w", 0.5f, MIEN_SCALAR)
MIEN_PEAK(neon_peak, , float32x4_t, "w", vdupq_n_f32(0.5f), MIEN_NEON)
#endif

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Floating-point operations per second, the best of several tries.
double measure_peak(Isa isa) {
  void (*run)(size_t) = scalar_peak;
  double width = 1;
#if defined(__x86_64__)
  if (isa == Isa::kSse2) run = sse2_peak, width = 4;
  if (isa == Isa::kAvx2) run = avx2_peak, width = 8;
  if (isa == Isa::kAvx512) run = avx512_peak, width = 16;
#elif defined(__aarch64__)
  if (isa == Isa::kNeon) run = neon_peak, width = 4;
#endif
  constexpr size_t kRounds = 200000;
  double best = 0;
  for (int i = 0; i < 15; ++i) {
    const double start = processor_seconds();
    run(kRounds);
    const double time = processor_seconds() - start;
    if (time > 0) best = std::max(best, 2 * kSums * width * kRounds / time);
  }
  return best;
}

double peak(Isa isa) {
  static double peaks[kIsaCount] = {};
  double& known = peaks[static_cast<uint32_t>(isa)];
  if (known == 0) known = measure_peak(isa);
  return known;
}

template <class T>
T* aligned(std::vector<T>& storage, size_t count) {
  storage.assign(count + 64 / sizeof(T), T());
  const size_t past = reinterpret_cast<uintptr_t>(storage.data()) % 64 / sizeof(T);
  return storage.data() + (past ? 64 / sizeof(T) - past : 0);
}

/// `characters` is 1, or up to kBatchLanes for a batch.
void dense(benchmark::State& state, const KernelTable* kernels, uint32_t inputs, uint32_t outputs,
           bool halves, uint32_t characters) {
  const uint32_t rows = (outputs + kBlockLanes - 1) / kBlockLanes * kBlockLanes;
  const size_t count = size_t{rows} * inputs;
  const uint32_t lanes = characters == 1 ? 1 : kBatchLanes;
  std::vector<float> value_storage, bias_storage, output_storage, input_storage;
  std::vector<uint16_t> half_storage;
  float* values = aligned(value_storage, halves ? 0 : count);
  uint16_t* half_values = aligned(half_storage, halves ? count : 0);
  for (size_t i = 0; i < count; ++i) {
    const float value = std::sin(static_cast<float>(i));
    if (halves) {
      half_values[i] = half_from_float(value);
    } else {
      values[i] = value;
    }
  }
  float* in = aligned(input_storage, size_t{inputs} * lanes);
  for (uint32_t i = 0; i < inputs * lanes; ++i) in[i] = std::cos(static_cast<float>(i));
  const auto fill = [&](auto& args) {
    args.values = values;
    args.biases = aligned(bias_storage, rows);
    args.inputs = in;
    args.outputs = aligned(output_storage, size_t{rows} * lanes);
    args.column_count = inputs;
    args.row_count = outputs;
    args.function = 1;
  };
  DenseLayerArgs layer = {};
  DenseBatchArgs batch = {};
  fill(layer);
  if (halves) layer.values = half_values;
  layer.halves = halves;
  if (characters > 1) fill(batch);
  batch.lane_count = characters;
  const double most = peak(kernels->isa);
  const double start = processor_seconds();
  for (auto _ : state) {
    if (characters == 1) {
      kernels->dense_layer(layer);
    } else {
      kernels->dense_batch(batch);
    }
    benchmark::ClobberMemory();
  }
  const double time = processor_seconds() - start;
  const double operations =
      2.0 * inputs * outputs * characters * static_cast<double>(state.iterations());
  state.counters["gflops"] = operations / time / 1e9;
  state.counters["peak"] = most / 1e9;
  state.counters["of_peak"] = operations / time / most;
}

const int kRegistered = [] {
  // Of the networks of golden rigs, the largest of each kind; of a head; then larger ones: what fits the
  // first cache, the second, and none.
  const uint32_t sizes[][2] = {{39, 49}, {49, 23},   {24, 30},   {45, 90},   {49, 96},    {64, 64},
                               {96, 96}, {128, 128}, {256, 256}, {512, 512}, {1024, 1024}};
  for (uint32_t isa = 1; isa < kIsaCount; ++isa) {
    const KernelTable* kernels = kernels_for(static_cast<Isa>(isa));
    if (!kernels) continue;
    for (const auto& size : sizes) {
      for (bool halves : {false, true}) {
        for (uint32_t characters : {1u, kBatchLanes}) {
          if (halves && characters != 1) continue;  // batches have floats
          const std::string name = std::string(characters == 1 ? "dense/" : "dense_of_32/") +
                                   kernels->name + "/" + std::to_string(size[0]) + "x" +
                                   std::to_string(size[1]) + (halves ? "/f16" : "/f32");
          benchmark::RegisterBenchmark(name.c_str(), dense, kernels, size[0], size[1], halves,
                                       characters);
        }
      }
    }
  }
  return 0;
}();

}  // namespace
}  // namespace mien::bench
