// SPDX-License-Identifier: MIT
// mien bench: how long evaluation takes, per LOD and instruction set, beside a plain sparse matrix.
//
//     rows (isa, LOD, activity, characters) and the yardsticks  ->  rounds over all of them,
//     a few samples each per round  ->  medians
//
// Samples repeat their controls, so the rigs keep no results: bench_evaluate times those that do.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <optional>
#include <random>

#include "integrations/cli/bench_csr.h"
#include "integrations/cli/fields.h"
#include "integrations/cli/image_file.h"
#include "integrations/cli/json_writer.h"
#include "integrations/cli/options.h"
#include "integrations/cli/text.h"

namespace mien::cli {

namespace {

struct BenchOptions {
  std::string rig;
  bool json = false, quick = false;
  LoadOptions load;
  RigOptions evaluation;
};

constexpr double kActivities[] = {0.05, 0.08, 0.25, 0.5, 1.0};
constexpr size_t kActivityCount = std::size(kActivities);
constexpr uint32_t kCharacters = 64;

// A crowd in the distance, speaking: at the finest LOD and this activity only.
constexpr uint32_t kThrong = 512;
constexpr size_t kSpeech = 1;  // of kActivities

// Asking the clock takes some hundred nanoseconds: a sample repeats its work until it takes at
// least this long.
constexpr double kSampleNs = 50000.0;

/// Rounds go on until both the fewest are done and the time is used up, or the most are done.
struct Plan {
  size_t fewest_rounds, max_rounds;
  double seconds;
};
constexpr Plan kFullPlan = {15, 500, 20.0};
constexpr Plan kQuickPlan = {2, 25, 2.0};

// One character costs so little beside a crowd that it is looked at more often.
constexpr size_t kSamplesOfOne = 5;

/// What this thread has worked so far: other programs on the machine do not count, and nothing here
/// waits. Where the system cannot tell: the time of day.
double work_ns() {
#if defined(CLOCK_THREAD_CPUTIME_ID)
  timespec time{};
  if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time) == 0) {
    return static_cast<double>(time.tv_sec) * 1e9 + static_cast<double>(time.tv_nsec);
  }
#endif
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double, std::nano>(now).count();
}

double median(std::vector<double>& samples) {
  if (samples.empty()) return 0.0;
  const auto middle = samples.begin() + static_cast<std::ptrdiff_t>(samples.size() / 2);
  std::nth_element(samples.begin(), middle, samples.end());
  return *middle;
}

/// One pass if that takes long enough, else the mean of as many as are needed.
template <class Pass>
double time_per_pass(const Pass& pass) {
  double start = work_ns();
  pass();
  const double one_ns = work_ns() - start;
  if (one_ns >= kSampleNs) return one_ns;
  const size_t repeats = static_cast<size_t>(kSampleNs / std::max(one_ns, 20.0)) + 1;
  start = work_ns();
  for (size_t i = 0; i < repeats; ++i) pass();
  return (work_ns() - start) / static_cast<double>(repeats);
}

/// Raw controls of all characters at one activity.
struct ControlSets {
  size_t count;  // controls of one character
  std::vector<float> own, shared;

  const float* of(bool is_shared, size_t character) const {
    return (is_shared ? shared : own).data() + character * count;
  }
};

/// Exactly `activity` of the controls are not zero. `shared`: the same ones for all characters, of
/// which there are kCharacters; `own` has kThrong.
ControlSets draw_controls(size_t count, double activity, std::mt19937& random) {
  ControlSets sets = {count, std::vector<float>(count * kThrong),
                      std::vector<float>(count * kCharacters)};
  const auto active = static_cast<size_t>(std::lround(activity * static_cast<double>(count)));
  std::vector<size_t> order(count);
  for (size_t i = 0; i < count; ++i) order[i] = i;
  // Not std::shuffle, whose result depends on the standard library.
  const auto shuffle = [&] {
    for (size_t i = 0; i + 1 < count; ++i) std::swap(order[i], order[i + random() % (count - i)]);
  };
  const auto draw = [&](float* controls) {
    for (size_t i = 0; i < active; ++i) {
      controls[order[i]] = static_cast<float>((random() >> 8) + 1) / 16777216.0f;  // in (0, 1]
    }
  };
  shuffle();
  for (size_t c = 0; c < kCharacters; ++c) draw(sets.shared.data() + c * count);
  for (size_t c = 0; c < kThrong; ++c) {
    shuffle();
    draw(sets.own.data() + c * count);
  }
  return sets;
}

/// A rig for one instruction set, with a crowd to evaluate.
struct Engine {
  Rig rig;
  MienRigInfo info;
  std::vector<Instance> instances;
  std::vector<MienInstance*> handles;
  std::vector<MienMutableFloatView> raw;
  Batch batch;
};

struct Row {
  const Engine* engine;
  uint32_t lod;
  size_t activity;
  uint32_t characters;
  bool shared;
  uint64_t bytes_touched;  // of the joint matrix, by one character: the mean of all
  std::vector<double> evaluate_samples, joints_samples;
  double evaluate_ns = 0, joints_ns = 0;
};

struct CsrRow {
  uint32_t lod;
  CsrMatrix matrix;
  std::vector<double> samples;
  double joints_ns = 0;
};

struct Bench {
  std::vector<Engine> engines;
  std::vector<ControlSets> controls;  // per activity
  std::vector<Row> rows;
  std::vector<CsrRow> csr;
  std::vector<float> csr_x, csr_y;
  float csr_sum = 0.0f;  // uses the products, so that they cannot be left out
};

// Preparation -----------------------------------------------------------------------------------

/// A DNA file, or a baked rig: that has no plain matrix to be the yardstick.
struct Source {
  std::string shown;
  std::optional<RigFile> dna;
  std::string image;  // path, if there is no DNA
  const BenchOptions& options;

  // Samples repeat the same controls, so nothing is reused.
  Rig make_rig(MienRigDesc desc) const {
    desc.reuse = MIEN_REUSE_NOTHING;
    if (dna) return create_rig(*dna, desc);
    RigOptions evaluation = options.evaluation;
    evaluation.isa = desc.isa == MIEN_ISA_BEST ? "" : mien_isa_name(desc.isa);
    return open_image(image, options.load, evaluation, desc.reuse).rig;
  }
};

Engine make_engine(const Source& file, const MienRigDesc& desc) {
  Engine engine;
  engine.rig = file.make_rig(desc);
  engine.info = rig_info(engine.rig.get());
  for (uint32_t c = 0; c < kThrong; ++c) {
    auto error = sized<MienError>();
    MienInstance* made = nullptr;
    check(mien_instance_create(engine.rig.get(), nullptr, &made, &error), &error,
          "cannot make characters", file.shown);
    engine.instances.emplace_back(made);
    engine.handles.push_back(made);
    MienMutableFloatView raw{};
    check(mien_instance_raw_controls(made, &raw), nullptr, "cannot make characters", file.shown);
    engine.raw.push_back(raw);
  }
  auto error = sized<MienError>();
  MienBatch* batch = nullptr;
  check(mien_batch_create(engine.rig.get(), kThrong, 1, nullptr, &batch, &error), &error,
        "cannot make a crowd", file.shown);
  engine.batch.reset(batch);
  return engine;
}

std::vector<DenseGroup> read_groups(const RigFile& file) {
  const std::string list = "bhvr.joints.jointGroups";
  std::vector<DenseGroup> groups(field_count(file, list));
  for (size_t i = 0; i < groups.size(); ++i) {
    groups[i].lods = read_integers(file, element(list, i, ".lods"));
    groups[i].inputs = read_integers(file, element(list, i, ".inputIndices"));
    groups[i].outputs = read_integers(file, element(list, i, ".outputIndices"));
    groups[i].values = read_floats(file, element(list, i, ".values"));
  }
  return groups;
}

void prepare_csr(Bench& bench, const RigFile& file, std::mt19937& random) {
  const std::vector<DenseGroup> groups = read_groups(file);
  const MienRigInfo& info = bench.engines[0].info;
  for (uint32_t lod = 0; lod < info.lod_count; ++lod) {
    bench.csr.push_back({lod, make_csr(groups, lod, info.joint_value_count), {}});
  }
  bench.csr_y.resize(info.joint_value_count);
  bench.csr_x.resize(info.control_count);
  for (float& x : bench.csr_x) x = static_cast<float>(random() >> 8) / 16777216.0f;
}

void set_controls(const Engine& engine, uint32_t characters, const ControlSets& controls,
                  bool shared, size_t from) {
  for (uint32_t c = 0; c < characters; ++c) {
    const size_t sets = std::max(characters, kCharacters);
    const float* source = controls.of(shared, (c + from) % sets);
    std::copy(source, source + controls.count, engine.raw[c].data);
  }
}

/// Bytes of the joint matrix that one character's evaluation reads: the mean of kCharacters.
uint64_t bytes_touched(const Engine& engine, uint32_t lod, const ControlSets& controls,
                       bool shared) {
  set_controls(engine, kCharacters, controls, shared, 0);
  const std::vector<uint32_t> lods(kCharacters, lod);
  check(mien_rig_evaluate_batch(engine.rig.get(), engine.batch.get(), engine.handles.data(),
                                lods.data(), kCharacters, MIEN_STAGE_ALL, nullptr),
        nullptr, "cannot evaluate", "");
  uint64_t sum = 0;
  for (uint32_t c = 0; c < kCharacters; ++c) {
    auto statistics = sized<MienInstanceStatistics>();
    check(mien_instance_statistics(engine.handles[c], &statistics), nullptr, "cannot examine", "");
    sum += statistics.joint_byte_count;
  }
  return sum / kCharacters;
}

Bench prepare(const Source& file, const std::vector<MienRigDesc>& rigs) {
  Bench bench;
  std::mt19937 random(20240229);
  for (const MienRigDesc& desc : rigs) bench.engines.push_back(make_engine(file, desc));
  const MienRig* first = bench.engines[0].rig.get();
  for (const double activity : kActivities) {
    bench.controls.push_back(
        draw_controls(rig_count(first, MIEN_KIND_RAW_CONTROL), activity, random));
  }
  const uint32_t lod_count = bench.engines[0].info.lod_count;
  std::vector<uint64_t> bytes;  // [lod][activity][shared]: the same for each instruction set
  for (uint32_t lod = 0; lod < lod_count; ++lod) {
    for (const ControlSets& controls : bench.controls) {
      for (const bool shared : {false, true}) {
        bytes.push_back(bytes_touched(bench.engines[0], lod, controls, shared));
      }
    }
  }
  for (const Engine& engine : bench.engines) {
    for (uint32_t lod = 0; lod < lod_count; ++lod) {
      for (size_t activity = 0; activity < kActivityCount; ++activity) {
        const uint64_t* of_row = &bytes[(lod * kActivityCount + activity) * 2];
        bench.rows.push_back({&engine, lod, activity, 1, false, of_row[0], {}, {}});
        bench.rows.push_back({&engine, lod, activity, kCharacters, false, of_row[0], {}, {}});
        bench.rows.push_back({&engine, lod, activity, kCharacters, true, of_row[1], {}, {}});
      }
    }
  }
  for (const Engine& engine : bench.engines) {
    bench.rows.push_back({&engine, 0, kSpeech, kThrong, false, bytes[2 * kSpeech], {}, {}});
  }
  if (file.dna) prepare_csr(bench, *file.dna, random);
  return bench;
}

// Measuring -------------------------------------------------------------------------------------

void sample_row(Row& row, const ControlSets& controls, size_t number) {
  const Engine& engine = *row.engine;
  const MienRig* rig = engine.rig.get();
  // A single character has other controls in every sample.
  set_controls(engine, row.characters, controls, row.shared, number);
  MienStatus failed = MIEN_OK;
  const std::vector<uint32_t> lods(row.characters, row.lod);
  const auto crowd = [&](uint32_t stages) {
    failed |= row.characters == 1
                  ? mien_rig_evaluate_stages(rig, engine.handles[0], row.lod, stages)
                  : mien_rig_evaluate_batch(rig, engine.batch.get(), engine.handles.data(),
                                            lods.data(), row.characters, stages, nullptr);
  };
  const auto time = [&](uint32_t stages) { return time_per_pass([&] { crowd(stages); }); };
  crowd(MIEN_STAGE_ALL);  // clears what another LOD left behind
  const double evaluate_ns = time(MIEN_STAGE_ALL);
  const double joints_ns = time(MIEN_STAGE_JOINTS);
  if (failed != MIEN_OK) check(failed, nullptr, "cannot evaluate", "");
  row.evaluate_samples.push_back(evaluate_ns / row.characters);
  row.joints_samples.push_back(joints_ns / row.characters);
}

void sample_csr(CsrRow& row, Bench& bench) {
  const auto pass = [&] { multiply(row.matrix, bench.csr_x.data(), bench.csr_y.data()); };
  pass();
  row.samples.push_back(time_per_pass(pass));
  for (const float y : bench.csr_y) bench.csr_sum += y;
}

void measure(Bench& bench, const Plan& plan, const Session& session) {
  const size_t work = bench.rows.size() + bench.csr.size();
  const double start = work_ns();
  Progress progress(session, "round 1, row", work);
  for (size_t round = 0; round < plan.max_rounds; ++round) {
    if (round >= plan.fewest_rounds && work_ns() - start > plan.seconds * 1e9) break;
    size_t done = 0;
    for (CsrRow& row : bench.csr) {
      for (size_t i = 0; i < kSamplesOfOne; ++i) sample_csr(row, bench);
    }
    for (Row& row : bench.rows) {
      progress.at("round " + std::to_string(round + 1) + ", row", done++);
      const size_t samples = row.characters == 1 ? kSamplesOfOne : 1;
      for (size_t i = 0; i < samples; ++i) {
        sample_row(row, bench.controls[row.activity], round * samples + i);
      }
    }
  }
  for (CsrRow& row : bench.csr) row.joints_ns = median(row.samples);
  for (Row& row : bench.rows) {
    row.evaluate_ns = median(row.evaluate_samples);
    row.joints_ns = median(row.joints_samples);
  }
}

// Showing ---------------------------------------------------------------------------------------

std::string cpu_name() {
  std::ifstream file("/proc/cpuinfo");
  std::string line;
  while (std::getline(file, line)) {
    if (line.compare(0, 10, "model name") != 0) continue;
    const size_t colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string compiler_name() {
#if defined(__clang__)
  return __VERSION__;
#elif defined(__GNUC__)
  return "GCC " __VERSION__;
#else
  return "unknown";
#endif
}

void write_json(const Bench& bench, const std::string& name) {
  Output output("-");
  JsonWriter json(output);
  using Layout = JsonWriter::Layout;
  json.begin_object(Layout::kLines);
  json.member("rig", name);
  json.member("cpu", cpu_name());
  json.member("compiler", compiler_name());
  json.key("csr");
  json.begin_array(Layout::kLines);
  for (const CsrRow& row : bench.csr) {
    json.begin_object();
    json.member("lod", row.lod);
    json.key("joints_ns");
    json.fixed(row.joints_ns, 1);
    json.end_object();
  }
  json.end_array();
  json.key("rows");
  json.begin_array(Layout::kLines);
  for (const Row& row : bench.rows) {
    json.begin_object();
    json.member("isa", mien_isa_name(row.engine->info.isa));
    json.member("storage", row.engine->info.storage == MIEN_STORAGE_F16 ? "f16" : "f32");
    json.member("rotation",
                row.engine->info.rotation == MIEN_OUTPUT_QUATERNION ? "quaternion" : "euler");
    json.member("lod", row.lod);
    json.key("activity");
    json.shortest(kActivities[row.activity]);
    json.member("shared_controls", row.shared);
    json.member("characters", row.characters);
    json.key("evaluate_ns");
    json.fixed(row.evaluate_ns, 1);
    json.key("joints_ns");
    json.fixed(row.joints_ns, 1);
    json.member("bytes_touched", row.bytes_touched);
    json.end_object();
  }
  json.end_array();
  json.end_object();
  json.finish();
  output.commit();
}

/// "12.3" microseconds and "24.1" times as fast as the yardstick, if there is one, in columns.
std::string times_text(const Row& row, double csr_ns) {
  char text[64];
  const double ratio = row.joints_ns > 0 ? csr_ns / row.joints_ns : 0.0;
  std::snprintf(text, sizeof(text),
                csr_ns > 0 ? "  %10.2f %10.2f %7.1f" : "  %10.2f %10.2f       -",
                row.evaluate_ns / 1000, row.joints_ns / 1000, ratio);
  return text;
}

void write_text(const Bench& bench, const std::string& name, const Session& session) {
  Output output("-");
  const bool colors = session.terminal.out_colours;
  output.write(paint(one_line(name), Style::kBold, colors) + " on " + one_line(cpu_name()) + ", " +
               compiler_name() + "\nmicroseconds per character, medians of " +
               std::to_string(bench.rows.empty() ? 0 : bench.rows[0].joints_samples.size()) +
               "; x CSR: times as fast as the joint matrix in compressed rows\n\n");
  char line[160];
  std::snprintf(line, sizeof(line), "%-6s %3s %6s  %29s  %29s  %29s\n", "", "", "",
                "1 character       ", "64, own controls     ", "64, shared controls   ");
  output.write(paint(line, Style::kBold, colors));
  const char* columns = "    evaluate     joints   x CSR";
  std::snprintf(line, sizeof(line), "%-6s %3s %6s", "isa", "LOD", "active");
  output.write(paint(line + std::string(columns) + columns + columns, Style::kBold, colors) + "\n");

  // A baked rig has none.
  const auto yardstick = [&](uint32_t lod) {
    return bench.csr.empty() ? 0.0 : bench.csr[lod].joints_ns;
  };
  const uint32_t lod_count = bench.engines[0].info.lod_count;
  for (uint32_t lod = 0; lod < lod_count; ++lod) {
    const double csr_ns = yardstick(lod);
    std::snprintf(line, sizeof(line), "%-6s %3u %6s  %10s %10.2f %7.1f\n", "CSR", lod, "all", "",
                  csr_ns / 1000, 1.0);
    if (!bench.csr.empty()) output.write(line);
    // Three rows in a line, as prepare() made them; those of the throng stand behind.
    for (size_t i = 0; i + 2 < bench.rows.size(); i += 3) {
      const Row* row = &bench.rows[i];
      if (row->characters == kThrong) break;
      if (row->lod != lod) continue;
      std::snprintf(line, sizeof(line), "%-6s %3u %4.0f %%", mien_isa_name(row->engine->info.isa),
                    lod, 100 * kActivities[row->activity]);
      output.write(line + times_text(row[0], csr_ns) + times_text(row[1], csr_ns) +
                   times_text(row[2], csr_ns) + "\n");
    }
  }
  std::snprintf(line, sizeof(line), "\n%u characters with controls of their own\n", kThrong);
  output.write(paint(line, Style::kBold, colors));
  for (const Row& row : bench.rows) {
    if (row.characters != kThrong) continue;
    std::snprintf(line, sizeof(line), "%-6s %3u %4.0f %%", mien_isa_name(row.engine->info.isa),
                  row.lod, 100 * kActivities[row.activity]);
    output.write(line + times_text(row, yardstick(row.lod)) + "\n");
  }
  output.commit();
}

std::vector<MienRigDesc> choose_rigs(RigOptions& options) {
  if (options.isa != "all") return {parse_rig_options(options)};
  options.isa.clear();
  MienRigDesc desc = parse_rig_options(options);
  std::vector<MienRigDesc> descs;
  for (desc.isa = MIEN_ISA_SCALAR; desc.isa <= MIEN_ISA_NEON; ++desc.isa) {
    if (mien_isa_available(desc.isa)) descs.push_back(desc);
  }
  return descs;
}

void run(BenchOptions options, const Session& session) {
  const MienDnaDesc desc = parse_load_options(options.load, kEvaluationLayers);
  require_behavior(desc);
  const std::vector<MienRigDesc> rigs = choose_rigs(options.evaluation);
  Source file = {shown_name(options.rig), std::nullopt, "", options};
  if (!is_image(options.rig)) {
    file.dna = open_rig_file(options.rig, desc, session);
  } else if (options.rig == "-") {
    fail_usage("RIG -", "a baked rig is opened once for each instruction set", "put it in a file");
  } else {
    file.image = options.rig;
    note(session, file.shown + ": a baked rig has no plain matrix to compare with (CSR)");
  }
  Bench bench = prepare(file, rigs);
  measure(bench, options.quick ? kQuickPlan : kFullPlan, session);
  const std::string name = file.dna ? read_string(*file.dna, "desc.name") : file.shown;
  if (options.json) {
    write_json(bench, name);
  } else {
    write_text(bench, name, session);
  }
}

}  // namespace

Command add_bench_command(CLI::App& app, const Session& session) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App* bench = app.add_subcommand("bench", "Measure evaluation times");
  bench->add_option("RIG", options->rig, "DNA file or baked rig; - reads standard input")
      ->type_name("")
      ->required();
  bench->add_flag("--json", options->json, "JSON, for other programs");
  bench->add_flag("--quick", options->quick, "A few seconds instead of half a minute or more");
  add_load_options(*bench, options->load);
  add_rig_options(*bench, options->evaluation);
  bench->get_option("--isa")->description(
      "Instruction set, or all that this machine has\n(default: $MIEN_ISA, else the best)");
  bench->footer(
      "The yardstick (CSR) is the joint matrix of the LOD in compressed sparse rows, one scalar\n"
      "dot product per row, measured in the same run.\n\n"
      "Examples:\n"
      "  mien bench head.dna --quick\n"
      "  mien bench head.dna --isa all --json > times.json\n"
      "  mien bench head.dna --isa avx2 --lods 0");
  return {bench, [options, &session] { run(*options, session); }};
}

}  // namespace mien::cli
