// SPDX-License-Identifier: MIT
// mien bench: evaluation times per LOD and instruction set, compared with a plain sparse matrix, times
// of stages, and of whole frames.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>

#include "integrations/program/commands/baked_rig.h"
#include "integrations/program/commands/bench_frame.h"
#include "integrations/program/commands/bench_measurement.h"
#include "integrations/program/commands/bench_stage.h"
#include "integrations/program/io/cpu.h"
#include "integrations/program/io/dna_fields.h"
#include "integrations/program/io/json_writer.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

struct BenchOptions {
  std::string rig;
  bool json = false, quick = false;
  LoadOptions load;
  RigOptions evaluation;
};

std::string compiler_name() {
#if defined(__clang__)
  return __VERSION__;
#elif defined(__GNUC__)
  return "GCC " __VERSION__;
#else
  return "unknown";
#endif
}

using FrameRows = std::vector<FrameRow>;

void write_json(const Measurement& measured, const StageTable& stages, const FrameRows& frames,
                const std::string& name) {
  Output output("-");
  JsonWriter json(output);
  using Layout = JsonWriter::Layout;
  json.begin_object(Layout::kLines);
  json.member("rig", name);
  json.member("cpu", cpu_name());
  json.member("compiler", compiler_name());
  json.key("csr");
  json.begin_array(Layout::kLines);
  for (const CsrRow& row : measured.csr) {
    json.begin_object();
    json.member("lod", row.lod);
    json.key("joints_ns");
    json.fixed(row.joints_ns, 1);
    json.end_object();
  }
  json.end_array();
  json.key("rows");
  json.begin_array(Layout::kLines);
  for (const BenchRow& row : measured.rows) {
    json.begin_object();
    json.member("isa", mien_isa_name(row.engine->info.isa));
    json.member("storage", row.engine->info.storage == MIEN_STORAGE_16_BIT ? "f16" : "f32");
    json.member("rotation", row.engine->info.rotation_output == MIEN_ROTATION_OUTPUT_QUATERNION
                                ? "quaternion"
                                : "euler");
    json.member("arithmetic", arithmetic_word(row.engine->info));
    json.member("lod", row.lod);
    json.key("activity");
    json.shortest(kActivities[row.activity]);
    json.member("shared_controls", row.shared);
    json.member("characters", row.instances);
    json.key("evaluate_ns");
    json.fixed(row.evaluate_ns, 1);
    json.key("joints_ns");
    json.fixed(row.joints_ns, 1);
    json.member("bytes_touched", row.bytes_touched);
    json.end_object();
  }
  json.end_array();
  json.key("stages");
  json.begin_array(Layout::kLines);
  for (const StageRow& row : stages.rows) {
    json.begin_object();
    json.member("isa", mien_isa_name(row.engine->info.isa));
    json.member("storage", row.engine->info.storage == MIEN_STORAGE_16_BIT ? "f16" : "f32");
    json.member("lod", stages.lod);
    json.key("activity");
    json.shortest(kActivities[kStageActivity]);
    json.member("characters", row.characters);
    for (size_t s = 0; s < row.ns.size(); ++s) {
      json.key(stages.stages[s].member);
      json.fixed(row.ns[s], 1);
    }
    json.end_object();
  }
  json.end_array();
  json.key("frames");
  json.begin_array(Layout::kLines);
  for (const FrameRow& row : frames) {
    json.begin_object();
    json.member("isa", mien_isa_name(row.info.isa));
    json.member("storage", row.info.storage == MIEN_STORAGE_16_BIT ? "f16" : "f32");
    json.member("characters", row.characters);
    json.key("evaluate_ns");
    json.fixed(row.evaluate_ns, 1);
    json.key("pose_ns");
    json.fixed(row.pose_ns, 1);
    json.key("deform_ns");
    json.fixed(row.deform_ns, 1);
    json.end_object();
  }
  json.end_array();
  json.end_object();
  json.finish();
  output.commit();
}

/// Three columns: microseconds of the evaluation and of its joint stage, and how many times as fast as
/// the CSR row the evaluation is, if there is one.
std::string times_text(const BenchRow& row, double csr_ns) {
  char text[64];
  const double ratio = row.evaluate_ns > 0 ? csr_ns / row.evaluate_ns : 0.0;
  std::snprintf(text, sizeof(text),
                csr_ns > 0 ? "  %10.2f %10.2f %7.1f" : "  %10.2f %10.2f       -",
                row.evaluate_ns / 1000, row.joints_ns / 1000, ratio);
  return text;
}

/// As in the tables of docs/speed.md.
std::string row_name(const MienRigInfo& info) {
  const bool half = info.storage == MIEN_STORAGE_16_BIT;
  return mien_isa_name(info.isa) + std::string(half ? ", 16 bits" : "");
}

/// Both numbers of characters of an instruction set in one line.
void write_stages(const StageTable& table, Output& output, bool colors) {
  output.write(
      "\nStages at LOD " + std::to_string(table.lod) + ", " +
      std::to_string(std::lround(100 * kActivities[kStageActivity])) +
      " % active, microseconds per character. joints: joint groups, then twists and\nswings, then "
      "joints of networks. x scalar: the scalar time of all stages / this one, in the same "
      "run.\n\n");
  const size_t width = 11 * table.stages.size() + 10;
  char line[64];
  std::string head(15, ' '), columns;
  for (const char* title : {"1 character", "64 characters"}) {
    const std::string text = title;
    head += std::string(width - text.size() - 12, ' ') + text + std::string(12, ' ');
  }
  for (const Stage& stage : table.stages) {
    std::snprintf(line, sizeof(line), " %10s", stage.name);
    columns += line;
  }
  columns += "  x scalar";
  output.write(paint(head.substr(0, head.find_last_not_of(' ') + 1), Style::kBold, colors) + "\n");
  output.write(paint(std::string(15, ' ') + columns + columns, Style::kBold, colors) + "\n");
  const bool has_scalar = table.rows[0].engine->info.isa == MIEN_ISA_SCALAR;
  for (size_t r = 0; r < table.rows.size(); ++r) {
    const StageRow& row = table.rows[r];
    std::string text;
    if (r % 2 == 0) {
      std::snprintf(line, sizeof(line), "%-15s", row_name(row.engine->info).c_str());
      text = line;
    }
    for (const double ns : row.ns) {
      std::snprintf(line, sizeof(line), " %10.2f", ns / 1000);
      text += line;
    }
    const double ratio = table.rows[r % 2].ns.back() / std::max(row.ns.back(), 1.0);
    std::snprintf(line, sizeof(line), has_scalar ? " %9.1f" : "         -", ratio);
    output.write(text + line + (r % 2 == 1 ? "\n" : ""));
  }
}

void write_frames(const FrameRows& frames, Output& output, bool colors) {
  if (frames.empty()) return;
  output.write(
      "\nWhole frames at LOD 0, 25 % active, microseconds per character: evaluation, matrices of "
      "the "
      "joints,\nall meshes with skinned normals, and their sum. x scalar: the scalar sum / this "
      "sum, in "
      "the same run.\n\n");
  char line[160];
  const char* columns = "    evaluate       pose     deform      frame  x scalar";
  std::snprintf(line, sizeof(line), "%-15s  %53s  %53s\n", "", "1 character              ",
                "64 characters             ");
  output.write(paint(line, Style::kBold, colors));
  std::snprintf(line, sizeof(line), "%-15s", "");
  output.write(paint(line + std::string(columns) + columns, Style::kBold, colors) + "\n");
  constexpr size_t kColumns = std::size(kCharacters);
  const bool has_scalar = frames[0].info.isa == MIEN_ISA_SCALAR;
  for (size_t i = 0; i < frames.size(); i += kColumns) {
    std::snprintf(line, sizeof(line), "%-15s", row_name(frames[i].info).c_str());
    std::string text = line;
    for (size_t k = 0; k < kColumns; ++k) {
      const FrameRow& row = frames[i + k];
      std::snprintf(line, sizeof(line), "  %10.2f %10.2f %10.2f %10.2f", row.evaluate_ns / 1000,
                    row.pose_ns / 1000, row.deform_ns / 1000, row.frame_ns() / 1000);
      text += line;
      const double ratio = frames[k].frame_ns() / std::max(row.frame_ns(), 1.0);
      std::snprintf(line, sizeof(line), has_scalar ? " %9.1f" : "         -", ratio);
      text += line;
    }
    output.write(text + "\n");
  }
}

void write_text(const Measurement& measured, const StageTable& stages, const FrameRows& frames,
                const std::string& name, const Session& session) {
  Output output("-");
  const bool colors = session.terminal.out_colors;
  const size_t samples = measured.rows.empty() ? 0 : measured.rows[0].joints_samples.size();
  output.write(
      paint(one_line(name), Style::kBold, colors) + " on " + one_line(cpu_name()) + ", " +
      compiler_name() + "\nMicroseconds per instance, medians of " + std::to_string(samples) +
      ": evaluate is everything, joints the joint stage of it.\n"
      "active: the share of raw controls that are not zero. x CSR: CSR time / evaluate, where "
      "CSR is\nthe joint matrix in compressed sparse rows, which skips no control that is "
      "zero.\n\n");
  char line[160];
  std::snprintf(line, sizeof(line), "%-15s %3s %6s  %29s  %29s  %29s\n", "", "", "",
                "1 instance         ", "64 instances        ", "64 instances, same controls");
  output.write(paint(line, Style::kBold, colors));
  const char* columns = "    evaluate     joints   x CSR";
  std::snprintf(line, sizeof(line), "%-15s %3s %6s", "", "LOD", "active");
  output.write(paint(line + std::string(columns) + columns + columns, Style::kBold, colors) + "\n");

  // A baked file has no CSR rows.
  const auto csr_ns_at = [&](uint32_t lod) {
    for (const CsrRow& row : measured.csr) {
      if (row.lod == lod) return row.joints_ns;
    }
    return 0.0;
  };
  for (const uint32_t lod : measured.lods) {
    const double csr_ns = csr_ns_at(lod);
    std::snprintf(line, sizeof(line), "%-15s %3u %6s  %10s %10.2f %7.1f\n", "CSR", lod, "all", "",
                  csr_ns / 1000, 1.0);
    if (!measured.csr.empty()) output.write(line);
    // One line for the three rows of an engine, LOD and activity.
    for (size_t i = 0; i + 2 < measured.rows.size(); i += 3) {
      const BenchRow* row = &measured.rows[i];
      if (row->instances == kManyInstances) break;
      if (row->lod != lod) continue;
      std::snprintf(line, sizeof(line), "%-15s %3u %4.0f %%", row_name(row->engine->info).c_str(),
                    lod, 100 * kActivities[row->activity]);
      output.write(line + times_text(row[0], csr_ns) + times_text(row[1], csr_ns) +
                   times_text(row[2], csr_ns) + "\n");
    }
  }
  std::snprintf(line, sizeof(line), "\n%u instances, %.0f %% active\n", kManyInstances,
                100 * kActivities[kManyActivity]);
  output.write(paint(line, Style::kBold, colors));
  for (const BenchRow& row : measured.rows) {
    if (row.instances != kManyInstances) continue;
    std::snprintf(line, sizeof(line), "%-15s %3u %4.0f %%", row_name(row.engine->info).c_str(),
                  row.lod, 100 * kActivities[row.activity]);
    output.write(line + times_text(row, csr_ns_at(row.lod)) + "\n");
  }
  write_stages(stages, output, colors);
  write_frames(frames, output, colors);
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
  const MienDnaDesc desc =
      parse_load_options(options.load, kEvaluationLayers | MIEN_LAYER_GEOMETRY);
  require_behavior(desc);
  const std::vector<MienRigDesc> descs = choose_rigs(options.evaluation);

  std::optional<RigFile> dna;
  BenchSource source;
  source.shown = shown_name(options.rig);
  if (!is_baked_file(options.rig)) {
    dna = open_rig_file(options.rig, desc, session);
    source.dna = &*dna;
  } else if (options.rig == "-") {
    fail_usage("RIG -", "a baked file is opened once for each instruction set", "give its path");
  } else {
    note(session, source.shown + ": a baked file has no plain matrix to compare with (CSR)");
  }
  // Samples repeat the same controls, so nothing may be reused.
  source.make_rig = [&](MienRigDesc rig_desc) {
    rig_desc.reuse = MIEN_REUSE_NOTHING;
    if (dna) return create_rig(*dna, rig_desc);
    RigOptions evaluation = options.evaluation;
    evaluation.isa = rig_desc.isa == MIEN_ISA_ENVIRONMENT ? "" : mien_isa_name(rig_desc.isa);
    return open_baked_rig(options.rig, options.load, evaluation, rig_desc.reuse).rig;
  };
  const bool named =
      !options.load.lods.empty() || !options.load.max_lod.empty() || !options.load.min_lod.empty();
  const auto choose_lods = [&](uint32_t count) {
    std::vector<uint32_t> lods;
    for (uint32_t lod = 0; lod < count; ++lod) lods.push_back(lod);
    // People look at the finest, a middle and the coarsest first.
    if (!options.json && !named && count > 3) lods = {0, count / 2, count - 1};
    return lods;
  };
  Measurement measured = prepare_measurement(source, descs, choose_lods);
  const BenchPlan& plan = options.quick ? kQuickPlan : kFullPlan;
  measure(measured, plan, session);
  const BenchPlan short_plan = {plan.min_rounds, plan.max_rounds, plan.seconds / 4};
  const StageTable stages = measure_stages(measured, short_plan, session);
  FrameRows frames;
  if (dna && (desc.layers & MIEN_LAYER_GEOMETRY) != 0) {
    frames = measure_frames(*dna, descs, short_plan, session);
  }
  const std::string name = dna ? read_string(*dna, "desc.name") : source.shown;
  if (options.json) {
    write_json(measured, stages, frames, name);
  } else {
    write_text(measured, stages, frames, name, session);
  }
}

}  // namespace

Command add_bench_command(CLI::App& app, const Session& session) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App* bench = app.add_subcommand("bench", "Measure evaluation times");
  bench->add_option("RIG", options->rig, "DNA file or baked rig; - reads standard input")
      ->type_name("")
      ->required();
  bench->add_flag("--json", options->json, "Print JSON");
  bench->add_flag("--quick", options->quick, "Take a few seconds instead of half a minute or more");
  add_load_options(*bench, options->load);
  add_rig_options(*bench, options->evaluation);
  bench->get_option("--isa")->description(
      "Instruction set, or all that this machine has\n(default: $MIEN_ISA, otherwise the best)");
  bench->footer(
      "Measures the CPU time of a single thread, on one instruction set, at the finest, a middle\n"
      "and the coarsest LOD; --lods selects others, --json has all. CSR is the joint matrix "
      "of\n"
      "the LOD in compressed sparse rows, one scalar dot product per row, measured in the same "
      "run.\n"
      "Then the stages of an evaluation are measured one by one, at 25 % activity.\n"
      "For a DNA file with geometry, also measures whole frames: evaluation, joint matrices, "
      "meshes.\n\n"
      "Examples:\n"
      "  mien bench head.dna --quick\n"
      "  mien bench head.dna --isa all --json > times.json\n"
      "  mien bench head.dna --isa avx2 --lods 0");
  return {bench, [options, &session] { run(*options, session); }};
}

}  // namespace mien::cli
