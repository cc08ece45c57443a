// SPDX-License-Identifier: MIT
// mien export: a rig with its geometry, as a GLB, VRM, USD or OBJ file.
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include "integrations/program/commands/attachments.h"
#include "integrations/program/commands/bake_report.h"
#include "integrations/program/commands/exported_rig.h"
#include "integrations/program/gltf/bake_skeleton.h"
#include "integrations/program/gltf/expression_bake.h"
#include "integrations/program/gltf/expression_file.h"
#include "integrations/program/gltf/glb_writer.h"
#include "integrations/program/gltf/morph_limit.h"
#include "integrations/program/gltf/obj_writer.h"
#include "integrations/program/gltf/usd_writer.h"
#include "integrations/program/gltf/vrm.h"
#include "integrations/program/io/clip_file.h"
#include "integrations/program/io/controls.h"
#include "integrations/program/io/json_writer.h"
#include "integrations/program/io/matched_names.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/output.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

struct ExportOptions {
  OutputFile output;
  std::string rig, format, lod = "0", animation, clip, rate, mouth_close, bake, names;
  std::vector<std::string> authors;  // of a VRM
  std::vector<std::string> settings;
  GlbOptions glb;
  AttachmentOptions attachments;
  std::string morphs;    // at most so many, or empty
  std::string textures;  // folder
  bool link_textures = false;
  OutputFile residuals;
  bool correctives = false, point_cache = false, skeleton = false;
  bool bakes_unasked = false;  // as nothing was said: without the table of errors

  bool moves() const { return !animation.empty() || !clip.empty(); }
};

enum class Format { kGlb, kObj, kVrm, kUsda };

constexpr const char* kCannotExport = "cannot export";
constexpr double kDefaultRate = 30;
constexpr uint64_t kMostMorphs = 65535;
constexpr double kNotableClose = 0.005;  // of the size: a millimeter or two of a head
constexpr double kUnseenError = 1e-5;    // of the size, by integers

// Options -----------------------------------------------------------------------------------------

Format parse_format(const ExportOptions& options) {
  if (!options.format.empty()) return static_cast<Format>(parse_word("--format", options.format));
  if (options.output.path == "-") return Format::kGlb;
  const size_t dot = options.output.path.rfind('.');
  const std::string ending = dot == std::string::npos ? "" : options.output.path.substr(dot + 1);
  for (size_t i = 0; i < option_words("--format").size(); ++i) {
    if (ending == option_words("--format")[i]) return static_cast<Format>(i);
  }
  fail_usage("-o " + options.output.path, "the name does not tell the format",
             "let it end in .glb, .vrm, .usda or .obj, or add --format");
}

double frames_per_second(const ExportOptions& options) {
  if (options.rate.empty()) return kDefaultRate;
  if (!options.clip.empty()) {
    fail_usage("--fps " + options.rate, "a clip has its own rate", "leave out --fps");
  }
  if (options.animation.empty()) {
    fail_usage("--fps " + options.rate, "there is no animation", "add --animation FRAMES");
  }
  double rate = 0;
  const char* end = options.rate.data() + options.rate.size();
  const auto [stop, error] = std::from_chars(options.rate.data(), end, rate);
  if (error == std::errc() && stop == end && rate > 0 && rate <= 1e6) return rate;
  fail_usage("--fps \"" + options.rate + "\"", "not a number above 0", "write it as 30 or 29.97");
}

/// What only some formats have a place for.
void check_format(const ExportOptions& options, Format format) {
  if (format == Format::kUsda && (options.glb.quantize || options.glb.exact)) {
    fail_usage(options.glb.quantize ? "--quantize" : "--exact", "USD text holds whole floats",
               "leave it out, or write a .glb file");
  }
  if (format == Format::kVrm && options.moves()) {
    fail_usage(options.clip.empty() ? "--animation" : "--clip",
               "a VRM is a character without animation", "write a .glb file");
  }
  if (format == Format::kVrm && options.lod == "all") {
    fail_usage("--lod all", "a VRM shows all its meshes at once", "choose one LOD");
  }
  if (!options.authors.empty() && format != Format::kVrm) {
    fail_usage("--author", "only a VRM names its authors", "write a .vrm file");
  }
  const bool attaches = !options.attachments.soft.empty() || !options.attachments.rigid.empty();
  const char* shapes = attaches ? "--attach" : !options.morphs.empty() ? "--morphs" : nullptr;
  if (shapes && (format == Format::kObj || options.point_cache)) {
    fail_usage(shapes, "it is for files with morph targets", "write a .glb, .vrm or .usda file");
  }
  if (options.link_textures && format != Format::kGlb) {
    fail_usage("--link-textures",
               format == Format::kVrm ? "a VRM holds its textures" : "this format always does that",
               "leave it out");
  }
  if (!options.textures.empty() && options.glb.no_uvs) {
    fail_usage("--textures", "textures need texture coordinates", "leave out --no-uvs");
  }
  if (!options.morphs.empty()) parse_number("--morphs", options.morphs, kMostMorphs);
  if (!options.point_cache) return;
  if (format != Format::kUsda) {
    fail_usage("--point-cache", "only USD files have one", "write a .usda file");
  }
  if (!options.moves()) fail_usage("--point-cache", "there is no animation", "add --clip CLIP");
  if (!options.bake.empty()) {
    fail_usage("--point-cache", "a cache has no shapes", "leave out --point-cache or --bake");
  }
}

void check_combination(const ExportOptions& options, Format format) {
  if (options.rig == "-" && options.animation == "-") {
    fail_usage("--animation -", "standard input cannot be both RIG and FRAMES",
               "put one of them in a file");
  }
  if (options.moves() && !options.settings.empty()) {
    fail_usage("--set", "the animation sets the controls", "leave out --set or the animation");
  }
  if (!options.animation.empty() && !options.clip.empty()) {
    fail_usage("--clip " + options.clip, "a file has one animation",
               "leave out --clip or --animation");
  }
  const char* only_glb = !options.bake.empty()        ? "--bake"
                         : !options.animation.empty() ? "--animation"
                         : !options.clip.empty()      ? "--clip"
                                                      : options.glb.named();
  if (format == Format::kObj && only_glb) {
    fail_usage(only_glb, "an OBJ file holds one still pose", "write a .glb file");
  }
  check_format(options, format);
  if (!options.mouth_close.empty()) {
    parse_word("--mouth-close", options.mouth_close);
    if (options.bake.empty()) fail_usage("--mouth-close", "nothing is baked", "add --bake arkit");
  }
  if (options.correctives && options.bake.empty()) {
    fail_usage("--correctives", "nothing is baked", "add --bake arkit");
  }
  if (!options.names.empty() && options.bake.empty()) {
    fail_usage("--names " + options.names, "nothing is baked", "add --bake arkit");
  }
  if (options.skeleton && (!options.bake.empty() || format == Format::kVrm)) {
    fail_usage("--skeleton", "baked expressions are instead of the joints that move a face",
               "leave out --skeleton or --bake, or write a .glb file");
  }
  if (options.skeleton && format == Format::kObj) {
    fail_usage("--skeleton", "an OBJ file has no joints", "write a .glb file");
  }
  if (!options.residuals.path.empty() && options.bake.empty()) {
    fail_usage("--residuals", "nothing is baked", "add --bake arkit");
  }
}

// GLB ---------------------------------------------------------------------------------------------

/// The sets after --bake, one after the other.
gltf::ExpressionSet parse_sets(const ExportOptions& options) {
  gltf::MouthClose mouth_close = gltf::MouthClose::kAlone;
  if (!options.mouth_close.empty()) {
    mouth_close = static_cast<gltf::MouthClose>(parse_word("--mouth-close", options.mouth_close));
  }
  const Words& known = gltf::expression_set_names();
  gltf::ExpressionSet all;
  std::istringstream words(options.bake);
  std::string word;
  while (std::getline(words, word, ',')) {
    const bool is_file = word.size() > 5 && word.compare(word.size() - 5, 5, ".json") == 0;
    if (!is_file && std::find(known.begin(), known.end(), word) == known.end()) {
      fail_usage("--bake \"" + word + "\"", "there is no such set",
                 nearest_question(
                     word, known,
                     "choose of " + list_of(known, "and") + ", or a file that ends in .json"));
    }
    for (gltf::Expression& expression :
         is_file ? gltf::read_expression_set(word) : gltf::expression_set(word, mouth_close)) {
      for (const gltf::Expression& other : all) {
        if (other.name != expression.name) continue;
        fail(kInvalid, kCannotExport, "--bake " + options.bake,
             "two expressions are named \"" + one_line(other.name) + "\"", "leave one of them out");
      }
      all.push_back(std::move(expression));
    }
  }
  return all;
}

void note_missing(const ExportedRig& face, const std::vector<std::string>& missing,
                  const Session& session) {
  if (missing.empty()) return;
  std::string text;
  for (const std::string& name : missing) text += (text.empty() ? "" : ", ") + one_line(name);
  note(session, face.file.shown + ": the rig lacks controls of " + std::to_string(missing.size()) +
                    " expressions, which get no target: " + text);
}

/// Raw controls that a baked file has no weight for.
void note_lost_controls(ExportedRig& face, const gltf::RigExpressions& set,
                        const std::vector<const Frame*>& frames, const Session& session) {
  std::vector<bool> is_known(rig_count(face.rig.get(), MIEN_KIND_RAW_CONTROL));
  for (const gltf::RigExpression& expression : set.expressions) is_known[expression.control] = true;
  MienFloatView initial{};
  check(mien_rig_initial_raw_controls(face.rig.get(), &initial), nullptr, kCannotExport,
        face.file.shown);
  std::vector<bool> is_lost(is_known.size());
  for (const Frame* frame : frames) {
    face.apply(*frame);
    const MienFloatView raw = face.raw_controls();
    for (size_t i = 0; i < is_known.size(); ++i) {
      if (!is_known[i] && raw.data[i] != initial.data[i]) is_lost[i] = true;
    }
  }
  const auto lost = std::count(is_lost.begin(), is_lost.end(), true);
  if (lost == 0) return;
  note(session,
       face.file.shown + ": " + std::to_string(lost) +
           " controls that were set are not baked expressions: the file has no targets for them");
}

/// Leaves the largest morph targets, and says what the others would have moved.
void keep_morphs(gltf::Scene& scene, const ExportOptions& options, const Session& session) {
  if (options.morphs.empty()) return;
  const uint64_t most = parse_number("--morphs", options.morphs, kMostMorphs);
  const gltf::MorphLoss loss = limit_morphs(most, scene);
  if (loss.names.empty()) return;
  char off[96];
  std::snprintf(off, sizeof(off), "%.3g mm at most, %.3g mm rms", loss.max * 1000, loss.rms * 1000);
  std::string names;
  for (const std::string& name : loss.names) names += (names.empty() ? "" : ", ") + one_line(name);
  note(session, shown_name(options.rig) + ": " + std::to_string(loss.names.size()) +
                    " morph targets are left out, which move vertices by " + off + ": " + names);
}

gltf::ImageOptions image_options(const ExportOptions& options, Format format) {
  gltf::ImageOptions images;
  images.embed = format != Format::kUsda && !options.link_textures;
  if (options.output.path != "-") {
    images.folder = std::filesystem::path(options.output.path).parent_path().string();
  }
  return images;
}

/// Of a scene in the format. With integers only where that loses nothing to see, unless it was asked for.
std::string scene_bytes(const ExportedRig& face, gltf::Scene& scene, Format format, double rate,
                        const Attachments& attachments, const ExportOptions& options,
                        const Session& session, const gltf::Vrm* vrm = nullptr) {
  keep_morphs(scene, options, session);
  apply_options(scene, options.glb);
  // What is said beside the rig comes later, and wins.
  add_attached_materials(attachments, image_options(options, format), scene, session);
  add_materials(face, options.textures, image_options(options, format), scene, session);
  if (format != Format::kUsda) return glb_bytes(scene, options.glb, vrm);
  gltf::UsdOptions usd;
  usd.rate = rate;
  return write_usda(scene, usd);
}

/// Every frame of every mesh, as the rig deforms it.
std::string cache_bytes(ExportedRig& face, const std::vector<Frame>& frames, double rate,
                        const ExportOptions& options, const Session& session) {
  gltf::RigScene scene = make_still_scene(*face.source, face.scene_options(options.glb));
  note_losses(face, scene.losses, session);
  apply_options(scene.scene, options.glb);
  add_materials(face, options.textures, image_options(options, Format::kUsda), scene.scene,
                session);
  Progress progress(session, "deforming", scene.rig_meshes.size() * frames.size());
  gltf::UsdOptions usd;
  usd.rate = rate;
  usd.cached_frames = frames.size();
  usd.posed = [&](size_t mesh, size_t frame) {
    progress.at(mesh * frames.size() + frame);
    face.apply(frames[frame]);
    return gltf::posed_vertices(*face.source, scene.rig_meshes[mesh], face.pose.get());
  };
  return write_usda(scene.scene, usd);
}

std::string baked_bytes(ExportedRig& face, const Frame& still, const std::vector<Frame>& frames,
                        double rate, Format format, const ExportOptions& options,
                        const Session& session) {
  MatchedNames names(face.rig.get(), NamesFile(options.names), kCannotExport);
  const gltf::RigExpressions set = gltf::find_expressions(parse_sets(options), names);
  const bool is_posed = !options.settings.empty() || !frames.empty();
  if (is_posed && !set.by_name()) {
    fail(kInvalid, kCannotExport, face.file.shown,
         "not all baked expressions are controls of the rig, so controls cannot be their weights",
         "leave out --bake, or --set and --animation");
  }
  gltf::RigScene scene = gltf::make_still_scene(*face.source, face.scene_options(options.glb));
  note_missing(face, set.missing, session);
  names.note_matched(face.file.shown, session);
  gltf::add_bake_skeleton(*face.source, face.scene_options(options.glb).influences, scene);
  note_baked_losses(face, scene.losses, session);
  gltf::BakeReport report;
  {
    Progress progress(session, "baking expressions", 1);
    report = gltf::bake_expressions(*face.source, set, options.correctives, scene,
                                    [&](double share) { progress.at_share(share); });
  }
  if (options.mouth_close.empty() && !options.correctives &&
      report.max_close_with_jaw > kNotableClose * report.diagonal) {
    note(session, face.file.shown +
                      ": on this rig mouthClose moves differently when the jaw is open; for "
                      "captured data add --mouth-close jaw");
  }

  std::vector<const Frame*> posed = {&still};
  for (const Frame& frame : frames) posed.push_back(&frame);
  if (is_posed) {
    note_lost_controls(face, set, posed, session);
    std::vector<std::vector<float>> weights;
    for (const Frame* frame : posed) {
      face.apply(*frame);
      weights.push_back(gltf::expression_weights(set, face.raw_controls()));
    }
    gltf::set_baked_pose(scene, weights[0]);
    weights.erase(weights.begin());
    scene.scene.animation = gltf::baked_animation(scene, weights, "frames", rate);
  }
  gltf::Vrm vrm;
  if (format == Format::kVrm) {
    const std::vector<std::string> unknown = {"unknown"};
    vrm = make_person(scene.scene.name, options.authors.empty() ? unknown : options.authors, scene);
    vrm.looks = measure_looks(*face.source, set);
  }
  const Attachments attached = add_attachments(options.attachments, scene.scene, session);
  {
    Progress progress(session, "measuring attached meshes", 1);
    measure_attached(*face.source, set, scene, attached.meshes, report,
                     [&](double share) { progress.at_share(share); });
  }
  ExportOptions encoded = options;
  if (format == Format::kGlb && !options.glb.exact && !options.glb.no_quantize) {
    encoded.glb.quantize = options.glb.quantize ||
                           gltf::quantization_error(scene.scene) <= kUnseenError * report.diagonal;
  }
  const std::string bytes = scene_bytes(face, scene.scene, format, rate, attached, encoded, session,
                                        format == Format::kVrm ? &vrm : nullptr);
  FILE* const to = options.output.path == "-" ? stderr : stdout;
  const bool tells = !session.quiet && !options.bakes_unasked;
  if (tells) print_bake_report(report, to);
  if (tells && encoded.glb.quantize) {
    std::fprintf(to, "stored in integers: off by %.4f mm more, at most\n",
                 gltf::quantization_error(scene.scene) * 1000);
  }
  if (!options.residuals.path.empty()) {
    Output residuals(options.residuals.path);
    residuals.write(bake_report_json(report, set.missing));
    residuals.commit();
  }
  return bytes;
}

// -------------------------------------------------------------------------------------------------

/// Frames of a clip, and its rate; channels that the rig lacks are named.
std::vector<Frame> clip_frames(const ExportOptions& options, const MienRig* rig, double& rate,
                               const Session& session) {
  const ClipFile clip = open_clip_file(options.clip);
  rate = double(clip.info.rate_numerator) / clip.info.rate_denominator;
  std::vector<std::vector<MienControlShare>> controls;  // of each channel
  std::string missing;
  for (const std::string& channel : channel_names(clip)) {
    controls.push_back(match_name(rig, channel).shares);
    if (controls.back().empty()) missing += (missing.empty() ? "" : ", ") + one_line(channel);
  }
  if (!missing.empty()) {
    note(session,
         clip.shown +
             ": the rig lacks the controls of these channels, which are left out: " + missing);
  }
  std::vector<Frame> frames;
  for_each_frame(clip, [&](uint32_t, const float* values) {
    Frame frame;
    for (size_t c = 0; c < controls.size(); ++c) {
      for (const MienControlShare& share : controls[c]) {
        frame.raw.push_back({share.control, share.weight * values[c]});
      }
    }
    frames.push_back(std::move(frame));
  });
  return frames;
}

Materials obj_materials(const ExportedRig& face, const ExportOptions& options,
                        const Session& session) {
  std::vector<std::string> meshes;
  for (uint32_t m = 0; m < rig_count(face.rig.get(), MIEN_KIND_MESH); ++m) {
    meshes.push_back(rig_name(face.rig.get(), MIEN_KIND_MESH, m));
  }
  return materials_of(face, options.textures, meshes, session);
}

/// Whether a file of which nothing is said holds whole expressions: a GLB in neutral, of a rig with all that
/// viewers know. Poses and animations are exact with joints alone.
bool bakes_by_default(const ExportedRig& face, Format format, const ExportOptions& options,
                      const Session& session) {
  if (format != Format::kGlb || !options.bake.empty() || options.skeleton || options.moves() ||
      !options.settings.empty() || options.lod == "all") {
    return false;
  }
  MatchedNames names(face.rig.get(), NamesFile(), kCannotExport);
  size_t lacking = 0;
  const gltf::ExpressionSet arkit = gltf::expression_set("arkit", gltf::MouthClose::kAlone);
  for (const gltf::Expression& expression : arkit) {
    if (!names.find(expression.name).found()) ++lacking;
  }
  if (lacking == 0) {
    note(session, face.file.shown +
                      ": the 52 expressions of ARKit become morph targets; --bake "
                      "chooses others, --skeleton keeps all joints");
  }
  return lacking == 0;
}

void run(ExportOptions options, const Session& session) {
  const Format format = parse_format(options);
  double rate = frames_per_second(options);
  if (format == Format::kVrm && options.bake.empty()) options.bake = "vrm";
  check_combination(options, format);
  check_glb_options(options.glb);
  const bool binary = format == Format::kGlb || format == Format::kVrm;
  if (binary && options.output.path == "-" && session.terminal.out_is_terminal) {
    fail_usage("-o -", "a GLB file is not for a terminal", "name a file, or pipe the output");
  }
  refuse_replacing(options.output, {options.rig, options.animation, options.clip});
  if (!options.residuals.path.empty())
    refuse_replacing(options.residuals, {options.rig, options.animation});
  // Beside an OBJ file; standard output and devices have no place for it.
  OutputFile materials{"", options.output.force};
  if (format == Format::kObj && !is_stream(options.output.path)) {
    materials.path = std::filesystem::path(options.output.path).replace_extension(".mtl").string();
    refuse_replacing(materials, {options.rig});
  }
  try {
    ExportedRig face(options.rig, options.lod, session);
    note_color_problems(face, session);
    const Frame still = parse_settings(options.settings, face.rig.get(), face.file.shown);
    std::vector<Frame> frames;
    if (!options.animation.empty()) {
      frames = read_frames(options.animation, face.rig.get());
    } else if (!options.clip.empty()) {
      frames = clip_frames(options, face.rig.get(), rate, session);
    }
    if (options.moves() && frames.empty()) {
      fail(kInvalid, "cannot use frames",
           shown_name(options.clip.empty() ? options.animation : options.clip), "there are none",
           "give at least one frame");
    }
    if (bakes_by_default(face, format, options, session)) {
      options.bakes_unasked = true;
      options.bake = "arkit";
    }
    std::string bytes;
    if (format == Format::kObj) {
      face.apply(still);
      const Materials of_meshes = obj_materials(face, options, session);
      bytes = gltf::write_obj(*face.source, face.pose.get(),
                              std::filesystem::path(materials.path).filename().string(), of_meshes);
      if (!materials.path.empty()) {
        Output library(materials.path);
        library.write(
            gltf::write_mtl(*face.source, of_meshes, image_options(options, format).folder));
        library.commit();
      }
    } else if (!options.bake.empty()) {
      bytes = baked_bytes(face, still, frames, rate, format, options, session);
    } else if (options.point_cache) {
      bytes = cache_bytes(face, frames, rate, options, session);
    } else {
      gltf::RigScene scene = rig_scene(face, still, frames, rate, options.glb, session);
      const Attachments attached = add_attachments(options.attachments, scene.scene, session);
      bytes = scene_bytes(face, scene.scene, format, rate, attached, options, session);
    }
    Output output(options.output.path);
    output.write(bytes);
    output.commit();
    note_written(session, options.output.path, output.size());
  } catch (const gltf::ExportError& error) {
    fail_export(error, options.rig);
  }
}

}  // namespace

Command add_export_command(CLI::App& app, const Session& session) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command = app.add_subcommand(
      "export", "Write a rig's face as GLB (glTF 2.0), VRM, USD or OBJ, posed or moving");
  command->add_option("RIG", options->rig, "DNA file with geometry; - reads standard input")
      ->type_name("")
      ->required();
  add_output_options(*command, options->output,
                     "File to write: .glb, .vrm, .usda, .obj; - is standard output")
      ->required();
  command
      ->add_option("--format", options->format,
                   "glb, vrm, usda or obj (default: by the ending of OUT)")
      ->type_name("NAME");
  command
      ->add_option("--lod", options->lod,
                   "LOD to export (default: 0), or all: a GLB with a scene for each")
      ->type_name("N");
  command
      ->add_option("--set", options->settings,
                   "Set a control, by its name or the part after the last dot:\n"
                   "jawOpen=0.6; may be repeated")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  add_glb_options(*command, options->glb);
  command
      ->add_option("--textures", options->textures,
                   "Folder of PNG and JPEG textures for the meshes or materials of their names:\n"
                   "head_basecolor.png, T_Teeth_Normal.jpg, skin_roughness.png")
      ->type_name("DIR");
  command->add_flag("--link-textures", options->link_textures,
                    "A GLB names its textures by their paths instead of holding them, as USD and\n"
                    "OBJ files always do");
  command
      ->add_option("--animation", options->animation,
                   "Write frames as an animation: JSON as for 'mien eval'; - reads standard input")
      ->type_name("FRAMES");
  command->add_option("--clip", options->clip, "Write a clip as the animation, at its rate")
      ->type_name("CLIP");
  command->add_flag("--point-cache", options->point_cache,
                    "With .usda and an animation: every vertex in every frame, as the rig\n"
                    "deforms it, without skeleton and shapes");
  command
      ->add_option("--attach", options->attachments.soft,
                   "An OBJ or GLB mesh that follows the surface in every shape: hair cards,\n"
                   "brows, a beard; in meters, y up, the face toward +z; may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command
      ->add_option("--attach-rigid", options->attachments.rigid,
                   "The same, but its connected parts keep their shape: glasses, earrings")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command
      ->add_option("--morphs", options->morphs,
                   "Keep at most so many morph targets, those that move the most; what is lost\n"
                   "is printed")
      ->type_name("N");
  command
      ->add_option("--author", options->authors,
                   "With .vrm: who made the character; may be repeated (default: unknown)")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command->add_option("--fps", options->rate, "Frames per second (default: 30)")->type_name("N");
  command
      ->add_option(
          "--bake", options->bake,
          "Write whole expressions as morph targets, with only the bones of head, neck\n"
          "and eyes: arkit (52), visemes (15 of Oculus), visemes22 (cloud voices), unified\n"
          "(Unified Expressions), vrm (presets of VRM 1.0), emotions, or a JSON file;\n"
          "several with commas. If nothing is named, a .vrm file has vrm, and a .glb file\n"
          "in neutral arkit if the rig has all 52. Prints the error compared with the full\n"
          "rig")
      ->type_name("SET");
  command->add_flag("--skeleton", options->skeleton,
                    "Keep all joints; the morph targets are the blend shape channels. It is the\n"
                    "default where nothing is baked");
  command
      ->add_option("--names", options->names,
                   "With --bake: JSON with meanings of names on this rig, before those that Mien\n"
                   "knows: {\"mouthSmileLeft\": \"smirk_L\"}; what was matched is printed")
      ->type_name("FILE");
  command
      ->add_option("--residuals", options->residuals.path,
                   "With --bake: write these errors as JSON")
      ->type_name("FILE");
  command->add_flag("--correctives", options->correctives,
                    "With --bake: add targets for the correctives of two expressions; the\n"
                    "extras of the mesh say what drives them");
  command
      ->add_option("--mouth-close", options->mouth_close,
                   "Store mouthClose as the difference from the neutral face: alone (default),\n"
                   "or from an open jaw, as captured data use it: jaw")
      ->type_name("WAY");
  command->footer(
      "A GLB in neutral has a morph target for each ARKit expression, ready for sliders. Where "
      "the\n"
      "rig lacks some, and with --skeleton, --set, --animation or --clip, it has all joints and "
      "the\n"
      "blend shape channels, but not the rig logic that drives them: a pose or an animation is "
      "then\n"
      "exact. --set chooses the pose in which it opens. Units are meters, y is up, the face looks "
      "toward +z. Materials are those\n"
      "of RIG.materials.json beside RIG.dna, with its textures; otherwise they are chosen by mesh\n"
      "name. A set of your own for --bake: {\"smile\": {\"mouthSmileLeft\": 1, ...}, ...}; a\n"
      "difference is {\"plus\": {...}, \"minus\": {...}}. --lod all puts each LOD into its own "
      "scene; viewers show the first one. The\n"
      "materials of an OBJ file are written to a file of the same name that ends in .mtl.\n\n"
      "Examples:\n"
      "  mien export head.dna -o head.glb\n"
      "  mien export head.dna -o joints.glb --skeleton\n"
      "  mien export head.dna -o smile.obj --set mouthSmileLeft=1\n"
      "  mien export head.dna -o talk.glb --animation frames.json --fps 60\n"
      "  mien export head.dna -o arkit.glb --bake arkit --lod 2\n"
      "  mien export head.dna -o talk.glb --bake visemes,emotions --residuals loss.json\n"
      "  mien export head.dna -o head.vrm --bake vrm,arkit --author \"A. Artist\"\n"
      "  mien export head.dna -o talk.usda --animation frames.json");
  return {command, [options, &session] { run(*options, session); }};
}

}  // namespace mien::cli
