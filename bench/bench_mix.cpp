// SPDX-License-Identifier: MIT
// Mixing: its parts on rows of 256 curves, and whole steps of a character beside the evaluation of its
// rig, so that their ratio comes from one run.
//
// The character is the one of face_scene.h: two clips, a stream, moods, a reaction, blinks, breath,
// noise, six measured guards. A quarter of the rig's raw controls is active.
//
// Counters: `of_evaluation` is the time of a step by that of an evaluation in the same run, `step` and
// `evaluation` are these times in seconds, medians per character; `active` is the mean share of raw
// controls that are not 0; `median` and `p99_9` are of single steps in seconds, without an evaluation
// in between; `per_character` is the time of one of many.
#include <algorithm>
#include <chrono>
#include <ctime>

#include "bench/face_scene.h"
#include "capi/handles.h"
#include "runtime/eval/evaluate.h"
#include "runtime/mix/mix_rows.h"
#include "tests/support/placed_guards.h"

namespace mien::bench {
namespace {

constexpr size_t kCurves = 256;

struct Rows {
  alignas(64) float x[2 * kCurves], cover[2 * kCurves], mask[kCurves], row[2 * kCurves];
  alignas(64) float lower[kCurves], upper[kCurves];

  Rows() {
    Random random = Random::from_seed(1, 0);
    for (size_t i = 0; i < 2 * kCurves; ++i) {
      x[i] = static_cast<float>(random.real());
      cover[i] = 1;
      row[i] = static_cast<float>(random.real());
    }
    for (size_t i = 0; i < kCurves; ++i) {
      mask[i] = static_cast<float>(random.real());
      lower[i] = 0;
      upper[i] = 1;
    }
  }
};

std::vector<uint16_t> first_curves(uint32_t count) {
  std::vector<uint16_t> curves;
  for (uint16_t l = 0; l < count; ++l) curves.push_back(l);
  return curves;
}

// Parts
// ------------------------------------------------------------------------------------------------

/// A layer of a clip, with a mask and channels for all curves; poses have no cover.
void masked_layer(benchmark::State& state, Isa isa, BlendMode mode, bool covered) {
  const KernelTable* const kernels = kernels_for(isa);
  Rows rows;
  for (auto _ : state) {
    memcpy(rows.row, rows.upper, sizeof(rows.upper));  // repeated blending leads to denormals
    kernels->blend_row(
        {rows.x, covered ? rows.cover : nullptr, rows.mask, rows.row, kCurves, 0.5f, mode});
    benchmark::ClobberMemory();
  }
}

/// What a transition adds to a layer: offsets of the values; of what clips cover, too, if they differ
/// in that.
void inertial_transition(benchmark::State& state, Isa isa, size_t count) {
  const KernelTable* const kernels = kernels_for(isa);
  Rows rows;
  alignas(64) static float quintics[4][2 * kCurves];
  const QuinticRows out = {quintics[0], quintics[1], quintics[2], quintics[3]};
  start_quintics(rows.x, rows.x, rows.row, 0, 2 * kCurves, out);
  for (auto _ : state) {
    kernels->add_quintics(out, 0.4f, count, rows.x, rows.row);
    benchmark::ClobberMemory();
  }
}

/// Eight layers of poses that have all curves, with masks; 48 pairs of antagonists; limits.
struct DenseMix {
  Mix* mix = nullptr;
  explicit DenseMix(Isa isa) {
    Random random = Random::from_seed(2, 0);
    std::vector<float> values(kCurves), mask(kCurves), lower(kCurves, 0.0f), upper(kCurves, 1.0f);
    for (float& v : values) v = static_cast<float>(random.real());
    for (float& m : mask) m = static_cast<float>(random.real());
    const std::vector<uint16_t> curves = first_curves(kCurves);
    const PoseDesc pose = {{curves.data(), curves.size()}, {values.data(), values.size()}};
    LayerDesc layers[8];
    for (LayerDesc& layer : layers) {
      layer.mode = BlendMode::kScreen;
      layer.source = LayerSource::kPoses;
      layer.mask = {mask.data(), mask.size()};
      layer.pose_count = 1;
    }
    std::vector<AntagonistPair> pairs;
    for (uint16_t l = 0; l < 96; l += 2) pairs.push_back({l, static_cast<uint16_t>(l + 1), 1});
    MixDesc desc;
    desc.raw_count = kCurves;
    desc.layers = {layers, 8};
    desc.poses = {&pose, 1};
    desc.antagonists = {pairs.data(), pairs.size()};
    desc.lower = {lower.data(), lower.size()};
    desc.upper = {upper.data(), upper.size()};
    desc.kernels = kernels_for(isa);
    Error error;
    scene_requires(create_mix(desc, default_allocator(), mix, error));
  }
  ~DenseMix() { release(mix); }

  Mixer* mixer() const {
    Mixer* made = create_mixer(*mix, 1, false, default_allocator());
    Error error;
    for (uint32_t l = 0; l < 8; ++l) scene_requires(set_pose_weight(*made, l, 0, 0.3f, 0, error));
    return made;
  }
};

void dense_layers(benchmark::State& state, Isa isa) {
  const DenseMix dense(isa);
  const auto count = static_cast<size_t>(state.range(0));
  std::vector<Mixer*> mixers;
  std::vector<float> rows(count * kCurves);
  std::vector<float*> outs;
  for (size_t i = 0; i < count; ++i) {
    mixers.push_back(dense.mixer());
    outs.push_back(rows.data() + i * kCurves);
  }
  for (auto _ : state) {
    step_mixers({mixers.data(), count}, kSceneStep, outs.data(), kCurves, nullptr, 0);
    benchmark::ClobberMemory();
  }
  using benchmark::Counter;
  state.counters["per_character"] =
      Counter(static_cast<double>(count), Counter::kIsIterationInvariantRate | Counter::kInvert);
  for (Mixer* mixer : mixers) release(mixer);
}

/// Eight guards of 24 curves and 8 pairs each, fully active, while later layers move all of the 48 curves
/// that they have together: more than any face does.
void guards(benchmark::State& state, float activation) {
  constexpr uint32_t kGuarded = 48;
  const std::vector<uint16_t> curves = first_curves(kGuarded);
  std::vector<Guard> all;
  for (uint32_t g = 0; g < kMaxGuards; ++g) all.push_back(scene_guard(g, curves));
  const PlacedGuards placed(all);
  Rows rows;
  alignas(64) float held[kCurves] = {}, back[kCurves], row[kCurves];
  const float *const before = rows.x, *const free_row =
                                          rows.row;  // curve by curve: all have guards
  scene_requires(placed.table.curves.count == kGuarded ? Status::kOk : Status::kMismatch);
  for (auto _ : state) {
    alignas(64) float distances[kMaxGuards];
    float activations[kMaxGuards];
    guard_distances(placed.table, before, distances);
    for (float& each : activations) each = activation;
    hold_guards(placed.table, before, distances, activations, free_row, back, row);
    ease_guards(free_row, before, back, kGuarded, 0.2f, held, row);
    benchmark::ClobberMemory();
  }
}

// Whole steps
// ------------------------------------------------------------------------------------------------

const MienRig* rig_for(uint32_t isa) {
  static MienRig* rigs[MIEN_ISA_NEON + 1] = {};
  if (!rigs[isa]) {
    MienDna* dna = open_rig(kBehaviorLayers, 0);
    rigs[isa] = create_rig(dna, isa);
    mien_dna_close(dna);
  }
  return rigs[isa];
}

/// The scene on the rig: a quarter of the raw controls is moved.
const MixScene& scene(uint32_t isa) {
  static const MixScene* scenes[MIEN_ISA_NEON + 1] = {};
  if (!scenes[isa]) {
    static const MeasuredHead head = measure_head();
    const uint32_t raws = capi::object(rig_for(MIEN_ISA_SCALAR))->raw_count;
    const FaceScene face(head, raws, raws / 4);
    scenes[isa] = new MixScene(face.parts, kernels_for(static_cast<Isa>(isa)));
  }
  return *scenes[isa];
}

/// A character whose mixer writes into the controls of an instance.
struct Character {
  SceneActor actor;
  MienInstance* handle = nullptr;
  Instance& instance;
  Random random;

  Character(uint32_t isa, uint64_t seed)
      : actor(scene(isa), seed), instance(make(isa)), random(Random::from_seed(seed, 4)) {
    actor.begin();
  }
  ~Character() { mien_instance_destroy(handle); }
  Character(const Character&) = delete;

  /// The row of the stream, which arrives on another thread, and the light: not part of the step.
  void prepare(size_t frame) {
    actor.push(random);
    Error error;
    if (frame % 90 == 0) trigger(*actor.mixer, 0, 1, kTicksPerSecond, error);
  }
  void step() {
    step_mixer(*actor.mixer, kSceneStep, instance.controls.data, actor.scene.raw_count, nullptr);
  }
  double active() const {
    double count = 0;
    for (uint32_t c = 0; c < actor.scene.raw_count; ++c) count += instance.controls[c] != 0;
    return count / actor.scene.raw_count;
  }

 private:
  Instance& make(uint32_t isa) {
    MienError error = sized<MienError>();
    require(mien_instance_create(rig_for(isa), nullptr, &handle, &error), error);
    return *capi::object(handle);
  }
};

/// What this thread has worked so far: other programs do not count.
double work_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

/// The upper one of the two in the middle.
double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Of work_seconds() itself: a system call, which takes a tenth of a step.
double clock_seconds() {
  std::vector<double> times(1001);
  for (double& time : times) {
    const double start = work_seconds();
    time = work_seconds() - start;
  }
  return median(times);
}

/// `count` characters, one by one or as a batch.
void whole_step(benchmark::State& state, uint32_t isa, uint32_t count) {
  std::deque<Character> characters;
  std::vector<Mixer*> mixers;
  std::vector<float*> outs;
  std::vector<MienInstance*> handles;
  for (uint32_t i = 0; i < count; ++i) {
    characters.emplace_back(isa, i + 1);
    mixers.push_back(characters[i].actor.mixer.get());
    outs.push_back(characters[i].instance.controls.data);
    handles.push_back(characters[i].handle);
  }
  const uint32_t raws = scene(isa).raw_count;
  MienError error = sized<MienError>();
  MienBatch* batch = nullptr;
  MienBatchDesc desc = mien_batch_desc_default();
  desc.capacity = count;
  require(mien_batch_create(rig_for(isa), &desc, &batch, &error), error);
  const std::vector<uint32_t> lods(count, 0);
  const double reading = clock_seconds();
  std::vector<double> steps, evaluations;
  double active = 0;
  size_t frame = 0;
  for (auto _ : state) {
    for (Character& character : characters) character.prepare(frame);
    ++frame;
    const double start = work_seconds();
    step_mixers({mixers.data(), count}, kSceneStep, outs.data(), raws, nullptr, 0);
    benchmark::ClobberMemory();
    const double middle = work_seconds();
    if (count == 1) {
      benchmark::DoNotOptimize(mien_rig_evaluate(rig_for(isa), handles[0], 0));
    } else {
      benchmark::DoNotOptimize(mien_rig_evaluate_batch(
          rig_for(isa), batch, handles.data(), lods.data(), count, MIEN_STAGE_ALL, nullptr));
    }
    benchmark::ClobberMemory();
    const double end = work_seconds();
    steps.push_back(middle - start - reading);
    evaluations.push_back(end - middle - reading);
    active += characters[0].active();
    state.SetIterationTime(steps.back());
  }
  mien_batch_destroy(batch);
  const double step = median(steps), evaluation = median(evaluations);
  state.counters["step"] = step / count;
  state.counters["evaluation"] = evaluation / count;
  state.counters["of_evaluation"] = step / evaluation;
  state.counters["active"] = active / static_cast<double>(frame);
}

void single_steps(benchmark::State& state) {
  constexpr size_t kSteps = 100000;
  using Clock = std::chrono::steady_clock;
  std::vector<double> times(kSteps);
  for (auto _ : state) {
    Character character(MIEN_ISA_BEST, 1);
    for (size_t frame = 0; frame < kSteps; ++frame) {
      character.prepare(frame);
      const Clock::time_point start = Clock::now();
      character.step();
      times[frame] = std::chrono::duration<double>(Clock::now() - start).count();
    }
  }
  std::sort(times.begin(), times.end());
  state.counters["median"] = times[kSteps / 2];
  state.counters["p99_9"] = times[kSteps - kSteps / 1000];
}

const int kRegistered = [] {
  using benchmark::RegisterBenchmark;
  const struct {
    const char* name;
    BlendMode mode;
  } modes[] = {{"override", BlendMode::kOverride},
               {"add", BlendMode::kAdd},
               {"screen", BlendMode::kScreen},
               {"max", BlendMode::kMax},
               {"scale", BlendMode::kScale}};
  RegisterBenchmark("guards/8x24/active", guards, 1.0f);
  RegisterBenchmark("guards/8x24/idle", guards, 0.0f);
  for (uint32_t isa = MIEN_ISA_SCALAR; isa <= MIEN_ISA_NEON; ++isa) {
    if (!mien_isa_available(isa)) continue;
    const auto own = static_cast<Isa>(isa);
    const std::string name = mien_isa_name(isa), at = "/" + name + "/lod0/25%";
    for (const auto& each : modes) {
      const std::string layer = "masked_layer/" + name + "/" + each.name;
      RegisterBenchmark((layer + "/clip").c_str(), masked_layer, own, each.mode, true);
      RegisterBenchmark((layer + "/poses").c_str(), masked_layer, own, each.mode, false);
    }
    const std::string transition = "inertial_transition/" + name;
    RegisterBenchmark(transition.c_str(), inertial_transition, own, kCurves);
    RegisterBenchmark((transition + "/other_channels").c_str(), inertial_transition, own,
                      2 * kCurves);
    RegisterBenchmark(("dense_layers/" + name + "/8").c_str(), dense_layers, own)
        ->ArgName("characters")
        ->Arg(1)
        ->Arg(256);
    RegisterBenchmark(("step" + at).c_str(), whole_step, isa, 1u)->UseManualTime();
    RegisterBenchmark(("step_of_64" + at).c_str(), whole_step, isa, 64u)->UseManualTime();
  }
  RegisterBenchmark("single_steps", single_steps)->Iterations(1)->Unit(benchmark::kMillisecond);
  return 0;
}();

}  // namespace
}  // namespace mien::bench
