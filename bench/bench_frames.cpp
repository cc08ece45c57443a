// SPDX-License-Identifier: MIT
// Frames of a character that keeps what did not change (MIEN_REUSE_UNCHANGED), and sums ("sums":
// MIEN_REUSE_SUMS), beside the same frames evaluated in full: nothing moves; one control, three or ten of those
// that are not 0, drawn anew for each frame, as are their values; all of the mouth; everything. And packets, in
// one call and one by one.
//
// Counters: `frame` is the time of a frame in seconds (an iteration is 64 frames), `of_full` that
// time by the one of a full evaluation in the same run, `moving` the number of raw controls that
// change from frame to frame, `touched` the share of the joint rows whose groups read a control or
// a corrective that changes, `per_character` a packet's time by its number, `speedup` and
// `speedup_asleep` as compare_two_threads() says.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <ctime>
#include <memory>
#include <random>

#include "bench/bench_support.h"
#include "bench/thread_pool.h"

namespace mien::bench {
namespace {

enum class Moving { kNothing, kOne, kThree, kTen, kMouth, kEverything };

const MienDna* behavior() {
  static const MienDna* dna = open_rig(kBehaviorLayers, 0);
  return dna;
}

struct Destroy {
  void operator()(MienRig* rig) const { mien_rig_destroy(rig); }
  void operator()(MienInstance* instance) const { mien_instance_destroy(instance); }
  void operator()(MienBatch* batch) const { mien_batch_destroy(batch); }
};

std::unique_ptr<MienRig, Destroy> rig_of(uint32_t isa, uint32_t reuse) {
  MienRigDesc desc = sized<MienRigDesc>();
  desc.isa = isa;
  desc.reuse = reuse;
  MienError error = sized<MienError>();
  MienRig* rig = nullptr;
  require(mien_rig_create(behavior(), &desc, &rig, &error), error);
  return std::unique_ptr<MienRig, Destroy>(rig);
}

std::unique_ptr<MienInstance, Destroy> instance_of(const MienRig* rig) {
  MienError error = sized<MienError>();
  MienInstance* instance = nullptr;
  require(mien_instance_create(rig, nullptr, &instance, &error), error);
  return std::unique_ptr<MienInstance, Destroy>(instance);
}

MienMutableFloatView raw_of(MienInstance* instance) {
  MienMutableFloatView raw = {};
  require(mien_instance_raw_controls(instance, &raw));
  return raw;
}

/// A share of the controls, drawn anew for each character: values in (0, 1].
std::vector<float> draw(size_t count, double activity, std::mt19937& random) {
  std::vector<float> values(count);
  std::vector<size_t> order(count);
  for (size_t i = 0; i < count; ++i) order[i] = i;
  for (size_t i = 0; i + 1 < count; ++i) {
    std::swap(order[i], order[i + random() % (count - i)]);
  }
  const auto active = static_cast<size_t>(std::lround(activity * static_cast<double>(count)));
  for (size_t i = 0; i < active; ++i) {
    values[order[i]] = static_cast<float>((random() >> 8) + 1) / 16777216.0f;
  }
  return values;
}

bool of_the_mouth(std::string name) {
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const char* part : {"mouth", "jaw", "lip"}) {
    if (name.find(part) != std::string::npos) return true;
  }
  return false;
}

/// Raw controls of the mouth by their names; the first tenth of all where names say nothing.
std::vector<uint32_t> mouth_controls(const MienRig* rig) {
  uint32_t count = 0;
  require(mien_rig_count(rig, MIEN_KIND_RAW_CONTROL, &count));
  std::vector<uint32_t> found;
  for (uint32_t i = 0; i < count; ++i) {
    MienStringView name = {};
    require(mien_rig_name(rig, MIEN_KIND_RAW_CONTROL, i, &name));
    if (of_the_mouth(std::string(name.data, name.count))) found.push_back(i);
  }
  if (found.empty()) {
    for (uint32_t i = 0; i < (count + 9) / 10; ++i) found.push_back(i);
  }
  return found;
}

/// Frames that are played to and fro.
struct Clip {
  std::vector<std::vector<float>> frames;
  size_t moving = 0;  // controls that change between the first two

  const std::vector<float>& at(size_t frame) const {
    const size_t last = frames.size() - 1;
    frame %= 2 * last;
    return frames[frame <= last ? frame : 2 * last - frame];
  }
};

/// 64 frames, each with new values for `count` controls that are not 0.
void move_some(Clip& clip, size_t count, std::mt19937& random) {
  std::vector<size_t> active;
  for (size_t i = 0; i < clip.frames[0].size(); ++i) {
    if (clip.frames[0][i] != 0.0f) active.push_back(i);
  }
  while (clip.frames.size() < 64) {
    std::vector<float> frame = clip.frames.back();
    for (size_t i = 0; i < std::min(count, active.size()); ++i) {
      std::swap(active[i], active[i + random() % (active.size() - i)]);
      frame[active[i]] = static_cast<float>((random() >> 8) + 1) / 16777216.0f;
    }
    clip.frames.push_back(frame);
  }
}

Clip make_clip(const MienRig* rig, size_t count, Moving moving) {
  std::mt19937 random(7);
  Clip clip;
  clip.frames.push_back(draw(count, 0.25, random));
  switch (moving) {
    case Moving::kNothing: clip.frames.push_back(clip.frames[0]); break;
    case Moving::kOne: move_some(clip, 1, random); break;
    case Moving::kThree: move_some(clip, 3, random); break;
    case Moving::kTen: move_some(clip, 10, random); break;
    case Moving::kMouth:
      clip.frames.push_back(clip.frames[0]);
      for (const uint32_t i : mouth_controls(rig)) clip.frames[1][i] *= 0.9f;
      break;
    case Moving::kEverything:
      clip.frames.push_back(clip.frames[0]);
      for (float& value : clip.frames[1]) value *= 0.9f;
  }
  for (size_t i = 0; i < count; ++i) clip.moving += clip.frames[0][i] != clip.frames[1][i];
  return clip;
}

void play(const Clip& clip, size_t frame, const MienRig* rig, MienInstance* instance) {
  const std::vector<float>& values = clip.at(frame);
  std::copy(values.begin(), values.end(), raw_of(instance).data);
  benchmark::DoNotOptimize(mien_rig_evaluate(rig, instance, 0));
  benchmark::ClobberMemory();
}

/// What this thread has worked so far: other programs do not count.
double work_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

std::vector<int64_t> read_numbers(const std::string& path) {
  MienDnaField field = sized<MienDnaField>();
  MienError error = sized<MienError>();
  require(mien_dna_field(behavior(), path.c_str(), &field, &error), error);
  std::vector<int64_t> values(static_cast<size_t>(field.count));
  require(mien_dna_read_integers(behavior(), path.c_str(), 0, field.count, values.data(), &error),
          error);
  return values;
}

/// The share of the joint rows whose groups read what changes between the frames of a clip.
double touched_share(const Clip& clip, const MienRig* rig, MienInstance* instance) {
  std::vector<float> controls[2];
  for (size_t frame = 0; frame < 2; ++frame) {
    play(clip, frame, rig, instance);
    MienFloatView view = {};
    require(mien_instance_controls(instance, &view));
    controls[frame].assign(view.data, view.data + view.count);
  }
  MienDnaInfo info = sized<MienDnaInfo>();
  require(mien_dna_info(behavior(), &info));
  size_t rows = 0, touched = 0;
  for (uint32_t g = 0; g < info.joint_group_count; ++g) {
    const std::string at = "bhvr.joints.jointGroups[" + std::to_string(g) + "].";
    const size_t of_group = read_numbers(at + "outputIndices").size();
    bool any = false;
    for (const int64_t input : read_numbers(at + "inputIndices")) {
      const auto i = static_cast<size_t>(input);
      any |= controls[0][i] != controls[1][i];
    }
    rows += of_group;
    touched += any ? of_group : 0;
  }
  return rows ? static_cast<double>(touched) / static_cast<double>(rows) : 0.0;
}

void frames(benchmark::State& state, uint32_t isa, uint32_t reuse, Moving moving) {
  const auto keeping_rig = rig_of(isa, reuse);
  const auto full_rig = rig_of(isa, MIEN_REUSE_NOTHING);
  const auto keeping = instance_of(keeping_rig.get()), full = instance_of(full_rig.get());
  const Clip clip = make_clip(keeping_rig.get(), raw_of(keeping.get()).count, moving);
  // Turns of both, so that a slow moment hits them alike; as long, because each begins with cold caches.
  constexpr size_t kTurn = 64;
  double kept_seconds = 0, full_seconds = 0;
  size_t turns = 0;
  size_t frame = 0;
  play(clip, frame, keeping_rig.get(), keeping.get());
  for (auto _ : state) {
    const double start = work_seconds();
    for (size_t i = 1; i <= kTurn; ++i) play(clip, frame + i, keeping_rig.get(), keeping.get());
    const double middle = work_seconds();
    for (size_t i = 1; i <= kTurn; ++i) play(clip, frame + i, full_rig.get(), full.get());
    frame += kTurn;
    full_seconds += work_seconds() - middle;
    const double kept = middle - start;
    kept_seconds += kept;
    ++turns;
    state.SetIterationTime(kept);
  }
  state.counters["frame"] = kept_seconds / static_cast<double>(turns * kTurn);
  state.counters["of_full"] = kept_seconds / full_seconds;
  state.counters["moving"] = static_cast<double>(clip.moving);
  state.counters["touched"] = touched_share(clip, full_rig.get(), full.get());
}

/// Characters with controls of their own, and a batch for them.
struct Characters {
  std::unique_ptr<MienRig, Destroy> rig;
  std::vector<std::unique_ptr<MienInstance, Destroy>> owners;
  std::vector<MienInstance*> instances;
  std::vector<uint32_t> lods;
  std::unique_ptr<MienBatch, Destroy> batch;

  Characters(uint32_t isa, uint32_t count, double activity, uint32_t tasks)
      : rig(rig_of(isa, MIEN_REUSE_NOTHING)), lods(count, 0) {
    std::mt19937 random(7);
    for (uint32_t i = 0; i < count; ++i) {
      owners.push_back(instance_of(rig.get()));
      instances.push_back(owners.back().get());
      const MienMutableFloatView raw = raw_of(instances.back());
      const std::vector<float> values = draw(raw.count, activity, random);
      std::copy(values.begin(), values.end(), raw.data);
    }
    MienError error = sized<MienError>();
    MienBatch* made = nullptr;
    MienBatchDesc desc = mien_batch_desc_default();
    desc.capacity = count;
    desc.tasks = tasks;
    require(mien_batch_create(rig.get(), &desc, &made, &error), error);
    batch.reset(made);
  }
  void evaluate(const MienParallelFor* parallel) {
    benchmark::DoNotOptimize(
        mien_rig_evaluate_batch(rig.get(), batch.get(), instances.data(), lods.data(),
                                static_cast<uint32_t>(instances.size()), MIEN_STAGE_ALL, parallel));
    benchmark::ClobberMemory();
  }
};

/// In one call on two threads.
void packet_on_threads(benchmark::State& state, uint32_t isa, uint32_t count, double activity) {
  Characters characters(isa, count, activity, 2);
  compare_two_threads(state, [&](const MienParallelFor* threads) { characters.evaluate(threads); });
}

/// In one call or in one for each.
void packet(benchmark::State& state, uint32_t isa, uint32_t count, double activity, bool together) {
  Characters characters(isa, count, activity, 1);
  for (auto _ : state) {
    if (together) {
      characters.evaluate(nullptr);
    } else {
      for (MienInstance* one : characters.instances) {
        benchmark::DoNotOptimize(mien_rig_evaluate(characters.rig.get(), one, 0));
      }
      benchmark::ClobberMemory();
    }
  }
  using benchmark::Counter;
  state.counters["per_character"] =
      Counter(count, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

const int kRegistered = [] {
  const struct {
    const char* name;
    Moving moving;
  } clips[] = {{"unchanged", Moving::kNothing},    {"one_control", Moving::kOne},
               {"three_controls", Moving::kThree}, {"ten_controls", Moving::kTen},
               {"mouth", Moving::kMouth},          {"everything", Moving::kEverything}};
  for (uint32_t isa = MIEN_ISA_SCALAR; isa <= MIEN_ISA_NEON; ++isa) {
    if (!mien_isa_available(isa)) continue;
    const std::string at = std::string("/") + mien_isa_name(isa) + "/lod0/";
    for (const auto& clip : clips) {
      for (const uint32_t reuse : {MIEN_REUSE_UNCHANGED, MIEN_REUSE_SUMS}) {
        const std::string kept = reuse == MIEN_REUSE_SUMS ? "25%/sums" : "25%";
        benchmark::RegisterBenchmark((clip.name + at + kept).c_str(), frames, isa, reuse,
                                     clip.moving)
            ->UseManualTime();
      }
    }
    for (int percent : {8, 25}) {
      for (uint32_t count : {1u, 64u, 512u}) {
        const std::string which = std::to_string(count) + at + std::to_string(percent) + "%";
        benchmark::RegisterBenchmark(("crowd_of_" + which).c_str(), packet, isa, count,
                                     percent / 100.0, true);
        benchmark::RegisterBenchmark(("one_by_one_" + which).c_str(), packet, isa, count,
                                     percent / 100.0, false);
        if (count == 1) continue;
        benchmark::RegisterBenchmark(("two_threads_" + which).c_str(), packet_on_threads, isa,
                                     count, percent / 100.0)
            ->UseManualTime();
      }
    }
  }
  return 0;
}();

}  // namespace
}  // namespace mien::bench
