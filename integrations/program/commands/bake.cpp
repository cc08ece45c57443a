// SPDX-License-Identifier: MIT
// mien bake: a DNA file -> a baked file: the compiled rig and its geometry, used in place.
#include <cmath>
#include <cstdlib>

#include "integrations/program/commands/bake_images.h"
#include "integrations/program/commands/options.h"
#include "integrations/program/io/bound_clip.h"
#include "integrations/program/io/clip_file.h"
#include "integrations/program/io/output.h"
#include "integrations/program/io/rig_file.h"
#include "integrations/program/reduce/reduce.h"

namespace mien::cli {

namespace {

struct BakeOptions {
  std::string rig;
  OutputFile output;
  bool no_geometry = false;
  std::string tolerance, report, pictures;
  std::vector<std::string> regions, clips;
  LoadOptions load;
  RigOptions evaluation;
};

/// "0.02mm" -> a distance in the unit of the file. `option` is for the message.
double parse_distance(const std::string& option, const std::string& word, bool file_in_meters) {
  constexpr struct {
    const char* name;
    double meters;
  } kUnits[] = {{"mm", 1e-3}, {"cm", 1e-2}, {"um", 1e-6}, {"m", 1}};
  char* rest = nullptr;
  double distance = std::strtod(word.c_str(), &rest);
  bool known = *rest == 0;
  for (const auto& unit : kUnits) {
    if (known || rest != std::string(unit.name)) continue;
    distance *= unit.meters * (file_in_meters ? 1 : 100);
    known = true;
  }
  if (!known || rest == word.c_str() || !(distance > 0) || !std::isfinite(distance)) {
    fail_usage(option, "\"" + word + "\" is not a distance above 0",
               "give numbers with um, mm, cm, m or nothing for the unit of the file: 0.02mm");
  }
  return distance;
}

/// "0.02mm,0.1mm", and regions such as "lip*=0.01mm".
Tolerances parse_tolerances(const BakeOptions& options, bool file_in_meters) {
  const std::string& list = options.tolerance;
  std::vector<double> lods;
  for (size_t first = 0, end = 0; end != std::string::npos; first = end + 1) {
    end = list.find(',', first);
    lods.push_back(
        parse_distance("--tolerance " + list, list.substr(first, end - first), file_in_meters));
  }
  Tolerances tolerances(lods);
  for (const std::string& region : options.regions) {
    const size_t sign = region.rfind('=');
    if (sign == std::string::npos || sign == 0) {
      fail_usage("--region " + region, "there are no names and a distance with = between",
                 "give names of joints or meshes and a distance: --region \"*lip*=0.01mm\"");
    }
    tolerances.regions.push_back(
        {region.substr(0, sign),
         parse_distance("--region " + region, region.substr(sign + 1), file_in_meters)});
  }
  return tolerances;
}

/// All frames of a clip, on a rig.
ProofTake read_performance(const std::string& path, const MienRig* rig, const Session& session) {
  const ClipFile clip = open_clip_file(path);
  const ClipBinding binding =
      bind_clip(clip.clip.get(), rig, NamesFile(), "cannot bind clip", clip.shown, session);
  MienFloatView initial{};
  check(mien_rig_initial_raw_controls(rig, &initial), nullptr, "cannot reduce", clip.shown);
  ProofTake performance;
  performance.shown = clip.shown;
  for_each_frame(clip, [&](uint32_t, const float* values) {
    std::vector<float>& raw =
        performance.frames.emplace_back(initial.data, initial.data + initial.count);
    check(mien_clip_binding_apply(binding.get(), values, clip.info.channel_count, raw.data(),
                                  raw.size()),
          nullptr, "cannot reduce", clip.shown);
  });
  return performance;
}

void write_baked(const MienRig* rig, const MienDeformer* deformer, const std::string& path,
                 const Session& session) {
  const std::string shown = path == "-" ? "standard output" : path;
  auto error = sized<MienError>();
  size_t size = 0;
  check(mien_bake_memory(rig, deformer, nullptr, 0, &size, &error), &error, "cannot bake", shown);
  std::vector<char> bytes(size);
  check(mien_bake_memory(rig, deformer, bytes.data(), size, &size, &error), &error, "cannot bake",
        shown);
  Output output(path);
  output.write(bytes.data(), size);
  output.commit();
  note_written(session, path, size);
}

void bake_reduced(const BakeOptions& options, const MienRigDesc& desc, const RigFile& file,
                  const Session& session) {
  const bool meters = file.info.translation_unit == MIEN_TRANSLATION_UNIT_METERS;
  const std::string unit = meters ? "m" : "cm";
  ReduceOptions how = {parse_tolerances(options, meters), desc, file.shown, {}};
  if (!options.clips.empty()) {
    const Rig rig = create_rig(file, desc);
    for (const std::string& path : options.clips) {
      how.performances.push_back(read_performance(path, rig.get(), session));
    }
  }
  Reduced reduced;
  {
    const Progress progress(session, "reducing " + file.shown);
    reduced = reduce_rig(file.dna.get(), how);
  }
  if (!(reduced.proof.share <= 1)) {
    fail(kInvalid, "cannot reduce", file.shown,
         "16-bit storage alone moves positions farther than the tolerance",
         "give a larger --tolerance, or leave out --storage");
  }
  if (!session.quiet) {
    std::fputs(reduction_text(reduced, unit).c_str(), stderr);
  }
  std::string image;
  if (!options.pictures.empty()) image = draw_reduction(reduced, options.rig, session);
  write_baked(reduced.rig.get(), reduced.deformer.get(), options.output.path, session);
  if (!image.empty()) {
    const OutputFolder folder(options.pictures);
    Output drawn(folder.file("distance.png"));
    drawn.write(image);
    drawn.commit();
  }
  if (options.report.empty()) return;
  const std::string json = reduction_json(reduced, unit);
  Output report(options.report);
  report.write(json);
  report.commit();
  note_written(session, options.report, json.size());
}

void run(const BakeOptions& options, const Session& session) {
  const uint32_t geometry = options.no_geometry ? 0 : uint32_t{MIEN_LAYER_GEOMETRY};
  const MienDnaDesc desc = parse_load_options(options.load, kEvaluationLayers | geometry);
  require_behavior(desc);
  const MienRigDesc rig_desc = parse_rig_options(options.evaluation);
  refuse_terminal(options.output.path, session, "a baked file");
  refuse_replacing(options.output, {options.rig});
  if (!options.report.empty()) {
    if (options.tolerance.empty()) {
      fail_usage("--report", "there is nothing to report without --tolerance", "add --tolerance");
    }
    refuse_missing_folder(options.report);
    refuse_replacing({options.report, options.output.force}, {options.rig, options.output.path});
  }
  if (!options.pictures.empty()) {
    if (options.tolerance.empty()) {
      fail_usage("--pictures", "there is nothing to draw without --tolerance", "add --tolerance");
    }
    if (options.rig == "-") {
      fail_usage("RIG -", "the rig is read again for pictures", "put it in a file");
    }
    refuse_missing_folder(options.pictures);
  }
  if (!options.tolerance.empty()) {
    parse_tolerances(options, false);
  } else if (!options.regions.empty() || !options.clips.empty()) {
    fail_usage(options.regions.empty() ? "--clip" : "--region",
               "nothing is reduced without --tolerance", "add --tolerance");
  }
  const RigFile file = open_rig_file(options.rig, desc, session);
  if (!options.tolerance.empty()) {
    if ((desc.layers & MIEN_LAYER_GEOMETRY) == 0 || !has_geometry(file)) {
      fail(kInvalid, "cannot reduce", file.shown,
           "there is no geometry whose positions could be compared",
           "leave --tolerance out, or load the geometry");
    }
    return bake_reduced(options, rig_desc, file, session);
  }
  const Rig rig = create_rig(file, rig_desc);
  Deformer deformer;
  if ((desc.layers & MIEN_LAYER_GEOMETRY) != 0 && has_geometry(file)) {
    auto error = sized<MienError>();
    MienDeformer* made = nullptr;
    check(mien_deformer_create(file.dna.get(), rig.get(), nullptr, &made, &error), &error,
          "cannot compile geometry", file.shown);
    deformer.reset(made);
  }
  write_baked(rig.get(), deformer.get(), options.output.path, session);
}

}  // namespace

Command add_bake_command(CLI::App& app, const Session& session) {
  auto options = std::make_shared<BakeOptions>();
  CLI::App* bake = app.add_subcommand("bake", "Compile a rig into a file that opens instantly");
  bake->add_option("RIG", options->rig, "DNA file; - reads standard input")
      ->type_name("")
      ->required();
  add_output_options(*bake, options->output, "File to write; - is standard output")->required();
  bake->add_flag("--no-geometry", options->no_geometry, "Leave the meshes out");
  bake->add_option("--tolerance", options->tolerance,
                   "Reduce the rig: no position of a mesh moves farther than this. A list\nis for "
                   "LODs 0, 1, ..., the last one for all others")
      ->type_name("0.02mm");
  bake->add_option(
          "--region", options->regions,
          "With --tolerance: another one for positions of a mesh or a joint, the\none that "
          "moves them most; the first of several that fit counts")
      ->type_name("NAMES=0.01mm")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  bake->add_option("--clip", options->clips,
                   "With --tolerance: measure the distance in all frames of this clip, too")
      ->type_name("CLIP")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  bake->add_option("--report", options->report, "Write what --tolerance did as JSON")
      ->type_name("R.json");
  bake->add_option("--pictures", options->pictures,
                   "With --tolerance: draw how far positions of LOD 0 moved as a PNG\nfile in this "
                   "folder")
      ->type_name("DIR");
  add_load_options(*bake, options->load);
  add_rig_options(*bake, options->evaluation, false);
  bake->footer(
      "A baked file opens in microseconds, and all processes that open it share its memory. It\n"
      "gives the same results as the DNA file, on every instruction set; the options chosen here\n"
      "are fixed. info, validate, eval, play, bench, render and inspect accept it in place of a\n"
      "DNA file.\n"
      "With --tolerance, 16-bit storage is chosen, and numbers that move positions little are\n"
      "removed: blocks of the joint matrix, blend shape deltas, skin weights. The distance from "
      "the\n"
      "original is measured at all LODs, with each raw control at 1, the inputs of each "
      "corrective\n"
      "at 1, and in 1,000 poses with a few random controls; the largest one stays within the\n"
      "tolerance.\n"
      "Keep the DNA file: a later version of Mien may require baking again.\n\n"
      "Examples:\n"
      "  mien bake head.dna -o head.rig\n"
      "  mien bake head.dna -o phone.rig --max-lod 3 --storage f16\n"
      "  mien bake head.dna -o small.rig --tolerance 0.02mm,0.1mm --report small.json\n"
      "  mien bake head.dna -o small.rig --tolerance 0.1mm --region \"*lip*=0.01mm\"\n"
      "  mien bake head.dna -o server.rig --no-geometry\n"
      "  mien eval head.rig --input frames.json");
  return {bake, [options, &session] { run(*options, session); }};
}

}  // namespace mien::cli
