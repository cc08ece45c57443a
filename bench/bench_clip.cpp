// SPDX-License-Identifier: MIT
// Clips: playing by a frame, between frames and backward, seeking, building and verifying, on the
// generated curves that the sizes of clips are stated for.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "author/base/random.h"
#include "runtime/anim/clip_builder.h"
#include "runtime/anim/clip_sampler.h"
#include "tests/support/clip_curves.h"

namespace mien {
namespace {

constexpr uint32_t kFrames = 3600;

struct Source {
  Curves curves;
  std::vector<std::string> names;
  std::vector<Span<const char>> name_views;
  std::vector<uint8_t> snaps;
  ClipBytes file;
  Clip clip;
  double active = 0;  // channels in a grid or in floats, on average

  Source(Curves made, uint32_t snap)
      : curves(std::move(made)), snaps(curves.channels, static_cast<uint8_t>(snap)) {
    for (uint32_t c = 0; c < curves.channels; ++c) names.push_back("control" + std::to_string(c));
    for (const std::string& name : names) name_views.push_back({name.data(), name.size()});
    std::vector<ChannelReport> reports(curves.channels);
    Error error;
    if (build_clip(desc(), default_allocator(), {reports.data(), reports.size()}, file, error) !=
            Status::kOk ||
        open_clip(file.bytes, file.size, clip, error) != Status::kOk) {
      abort();
    }
    for (const ChannelReport& report : reports) {
      active += report.blocks[kBlockGrid] + report.blocks[kBlockFloat];
    }
    active /= clip.block_count();
  }
  ~Source() { release_clip(file); }

  ClipDesc desc() const {
    ClipDesc desc;
    desc.frame_count = curves.frames;
    desc.values = curves.values.data();
    desc.names = {name_views.data(), name_views.size()};
    desc.snaps = {snaps.data(), snaps.size()};
    return desc;
  }
};

Curves curves_of(int64_t material) {
  switch (material) {
    case 0: return authored_keys(1, kFrames);
    case 1: return clean_solve(1, kFrames);
    case 2: return dense_noise(1, kFrames);
    default: return phone_capture(1, kFrames);
  }
}

struct Playing {
  Source source;
  std::vector<uint8_t> memory;
  ClipSampler sampler;

  Playing(const benchmark::State& state, const PlayDesc& desc, bool reverse)
      : source(curves_of(state.range(0)), static_cast<uint32_t>(state.range(1))) {
    const SamplerLimits limits = {source.clip.channel_count, source.clip.changing_count, reverse};
    Placer measure(nullptr);
    place_clip_sampler(measure, limits, sampler);
    memory.resize(measure.size() + kBlockAlignment);
    const auto at = reinterpret_cast<uintptr_t>(memory.data());
    Placer placer(memory.data() + (align_up(at, kBlockAlignment) - at));
    place_clip_sampler(placer, limits, sampler);
    Error error;
    if (start_clip(sampler, source.clip, desc, error) != Status::kOk) abort();
  }

  void count(benchmark::State& state) const {
    state.counters["active"] = source.active;
    state.counters["per_active"] =
        benchmark::Counter(static_cast<double>(state.iterations()) * source.active,
                           benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  }
};

void play(benchmark::State& state, double frames, Interpolation interpolation, bool reverse) {
  PlayDesc desc;
  desc.looping = Looping::kLoop;
  desc.interpolation = interpolation;
  Playing playing(state, desc, reverse);
  const auto step =
      static_cast<int64_t>(frames * static_cast<double>(playing.source.clip.ticks_per_frame));
  for (auto _ : state) {
    advance_clip(playing.sampler, step);
    benchmark::DoNotOptimize(sample_clip(playing.sampler).data);
  }
  playing.count(state);
}

void play_frames(benchmark::State& state) { play(state, 1, Interpolation::kLinear, false); }
void play_between(benchmark::State& state) { play(state, 0.73, Interpolation::kLinear, false); }
void play_catmull_rom(benchmark::State& state) {
  play(state, 0.73, Interpolation::kCatmullRom, false);
}
void play_backward(benchmark::State& state) { play(state, -1, Interpolation::kLinear, true); }

void seek(benchmark::State& state) {
  Playing playing(state, {}, false);
  Random random = Random::from_seed(1, 1);
  for (auto _ : state) {
    seek_clip(playing.sampler, random.below(kFrames) * playing.source.clip.ticks_per_frame);
    benchmark::DoNotOptimize(sample_clip(playing.sampler).data);
  }
  playing.count(state);
}

void build(benchmark::State& state) {
  const Source source(curves_of(state.range(0)), static_cast<uint32_t>(state.range(1)));
  for (auto _ : state) {
    ClipBytes made;
    Error error;
    benchmark::DoNotOptimize(build_clip(source.desc(), default_allocator(), {}, made, error));
    release_clip(made);
  }
  state.SetBytesProcessed(state.iterations() * static_cast<int64_t>(source.curves.raw_bytes()));
}

void open_and_verify(benchmark::State& state) {
  const Source source(curves_of(state.range(0)), static_cast<uint32_t>(state.range(1)));
  for (auto _ : state) {
    Clip clip;
    Error error;
    open_clip(source.file.bytes, source.file.size, clip, error);
    benchmark::DoNotOptimize(verify_clip(clip, error));
  }
  state.SetBytesProcessed(state.iterations() * static_cast<int64_t>(source.file.size));
}

void open(benchmark::State& state) {
  const Source source(curves_of(state.range(0)), static_cast<uint32_t>(state.range(1)));
  for (auto _ : state) {
    Clip clip;
    Error error;
    benchmark::DoNotOptimize(open_clip(source.file.bytes, source.file.size, clip, error));
  }
}

/// Authored, solved, dense and captured; lossless and snapped.
void materials(benchmark::internal::Benchmark* b) {
  b->ArgNames({"material", "snap"});
  for (int64_t material = 0; material < 4; ++material) {
    for (int64_t snap : {int64_t{kNoSnap}, int64_t{kDefaultSnap}}) b->Args({material, snap});
  }
}

BENCHMARK(play_frames)->Apply(materials);
BENCHMARK(play_between)->Apply(materials);
BENCHMARK(play_catmull_rom)->Apply(materials);
BENCHMARK(play_backward)->Apply(materials);
BENCHMARK(seek)->Apply(materials);
BENCHMARK(build)->Apply(materials)->Unit(benchmark::kMillisecond);
BENCHMARK(open)->Apply(materials);
BENCHMARK(open_and_verify)->Apply(materials)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mien
