// SPDX-License-Identifier: MIT
// mien info: what a DNA file holds.
#include <algorithm>
#include <optional>

#include "integrations/program/commands/baked_rig.h"
#include "integrations/program/commands/info_baked.h"
#include "integrations/program/commands/info_behavior.h"
#include "integrations/program/commands/options.h"
#include "integrations/program/io/dna_fields.h"
#include "integrations/program/io/json_writer.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

struct InfoOptions {
  std::string rig;
  bool json = false, full = false;
  std::string names;
  LoadOptions load;
  RigOptions evaluation;
};

constexpr const char* kTranslationUnits[] = {"cm", "m"};
constexpr const char* kRotationUnits[] = {"degrees", "radians"};
constexpr const char* kDirections[] = {"left", "right", "up", "down", "front", "back"};
constexpr const char* kSequences[] = {"xyz", "xzy", "yxz", "yzx", "zxy", "zyx"};
constexpr const char* kWindings[] = {"counter-clockwise", "clockwise"};
constexpr const char* kArchetypes[] = {"asian", "black", "caucasian", "hispanic", "alien", "other"};
constexpr const char* kGenders[] = {"male", "female", "other"};

/// Files may hold numbers that have no name yet.
template <size_t count>
std::string word(const char* const (&words)[count], int64_t number) {
  const bool known = number >= 0 && static_cast<uint64_t>(number) < count;
  return known ? words[number] : "unknown (" + std::to_string(number) + ")";
}

/// 1: x, y, z are right-handed; -1: left-handed; 0: they do not span space.
int handedness(const MienDnaInfo& info) {
  int hand = 1;  // of left, up, front
  for (int i = 0; i < 3; ++i) {
    const uint32_t line = info.axes[i] / 2, next = info.axes[(i + 1) % 3] / 2;
    if (line > 2 || line == next) return 0;
    if (info.axes[i] % 2 == 1) hand = -hand;
  }
  return (info.axes[0] / 2 + 1) % 3 == info.axes[1] / 2 ? hand : -hand;
}

/// What --names can list; "[]" in a path stands for every element.
struct NameKind {
  const char* word;  // in the order of the words of --names
  uint32_t layer;
  const char* path;
};

constexpr NameKind kNameKinds[] = {
    {"gui", MIEN_LAYER_DEFINITION, "defn.guiControlNames[]"},
    {"raw", MIEN_LAYER_DEFINITION, "defn.rawControlNames[]"},
    {"ml", MIEN_LAYER_MACHINE_LEARNED_BEHAVIOR, "mlbh.mlControlNames[]"},
    {"rbf", MIEN_LAYER_RBF_BEHAVIOR, "rbfe.poseControlNames[]"},
    {"joints", MIEN_LAYER_DEFINITION, "defn.jointNames[]"},
    {"channels", MIEN_LAYER_DEFINITION, "defn.blendShapeChannelNames[]"},
    {"maps", MIEN_LAYER_DEFINITION, "defn.animatedMapNames[]"},
    {"meshes", MIEN_LAYER_DEFINITION, "defn.meshNames[]"},
    {"regions", MIEN_LAYER_MACHINE_LEARNED_BEHAVIOR,
     "mlbh.neuralNetworkToMeshRegion.regionNames[][]"},
    {"solvers", MIEN_LAYER_RBF_BEHAVIOR, "rbfb.solvers[].name"},
    {"poses", MIEN_LAYER_RBF_BEHAVIOR, "rbfb.poses[].name"},
};

/// Kinds of "--names gui,raw", in the order of kNameKinds.
std::vector<const NameKind*> parse_names(const std::string& list) {
  constexpr size_t kKinds = std::size(kNameKinds);
  bool chosen[kKinds] = {};
  for (const size_t index : parse_words("--names", list)) {
    for (size_t i = 0; i < kKinds; ++i)
      chosen[i] |= i == index || index == kKinds;  // the last: all
  }
  std::vector<const NameKind*> kinds;
  for (size_t i = 0; i < kKinds; ++i) {
    if (chosen[i]) kinds.push_back(&kNameKinds[i]);
  }
  return kinds;
}

/// Strings at every path that `pattern` stands for.
void collect_strings(const RigFile& file, const std::string& pattern,
                     std::vector<std::string>& out) {
  const size_t brackets = pattern.find("[]");
  if (brackets == std::string::npos) {
    out.push_back(read_string(file, pattern));
    return;
  }
  const std::string list = pattern.substr(0, brackets);
  const uint64_t count = field_count(file, list);
  for (uint64_t i = 0; i < count; ++i) {
    collect_strings(file, element(list, i, pattern.substr(brackets + 2)), out);
  }
}

std::vector<std::string> names_of(const RigFile& file, const NameKind& kind) {
  std::vector<std::string> names;
  if (file.info.layers & kind.layer) collect_strings(file, kind.path, names);
  return names;
}

struct Count {
  const char* key;   // in JSON
  const char* text;  // for people
  uint64_t value;
};

struct LodCounts {
  std::vector<Count> counts;
};

/// Everything that is shown, gathered before anything is printed.
struct Summary {
  std::string name, archetype, gender, complexity, database;
  int64_t age = 0;
  std::vector<MienDnaLayer> layers;
  std::vector<Count> counts;
  std::vector<LodCounts> lods;
  std::vector<Tally> behavior;
  std::vector<std::pair<std::string, std::string>> metadata;
  std::optional<MienRigInfo> rig;  // absent without behavior
};

uint64_t lod_map_count(const RigFile& file, const std::string& map, uint32_t lod) {
  const std::vector<int64_t> rows = read_integers(file, map + ".lods");
  if (lod >= rows.size()) return 0;
  return field_count(file, element(map + ".indices", static_cast<uint64_t>(rows[lod])));
}

std::vector<Count> gather_counts(const RigFile& file) {
  const MienDnaInfo& info = file.info;
  std::vector<Count> counts = {
      {"gui_controls", "GUI controls", info.gui_control_count},
      {"raw_controls", "raw controls", info.raw_control_count},
      {"psd_controls", "PSD controls (correctives)", info.psd_control_count},
      {"ml_controls", "ML controls", info.ml_control_count},
      {"rbf_controls", "RBF pose controls", info.rbf_control_count},
      {"joints", "joints", info.joint_count},
      {"joint_groups", "joint groups", info.joint_group_count},
      {"blend_shape_channels", "blend shape channels", info.blend_shape_channel_count},
      {"animated_maps", "animated maps", info.animated_map_count},
      {"meshes", "meshes", info.mesh_count},
      {"neural_networks", "neural networks", info.neural_network_count},
      {"rbf_solvers", "RBF solvers", info.rbf_solver_count},
      {"rbf_poses", "RBF poses", info.rbf_pose_count},
      {"twists", "twists", info.twist_count},
      {"swings", "swings", info.swing_count},
  };
  if (info.layers & MIEN_LAYER_GEOMETRY) {
    uint64_t vertices = 0, faces = 0, targets = 0;
    const uint64_t meshes = field_count(file, "geom.meshes");
    for (uint64_t i = 0; i < meshes; ++i) {
      vertices += field_count(file, element("geom.meshes", i, ".positions.xs"));
      faces += field_count(file, element("geom.meshes", i, ".faces"));
      targets += field_count(file, element("geom.meshes", i, ".blendShapeTargets"));
    }
    counts.push_back({"vertices", "vertices", vertices});
    counts.push_back({"faces", "faces", faces});
    counts.push_back({"blend_shape_targets", "blend shape targets", targets});
  }
  return counts;
}

Summary gather(const RigFile& file, const MienRigDesc& rig_desc, const Session& session) {
  const MienDnaInfo& info = file.info;
  Summary summary;
  summary.name = read_string(file, "desc.name");
  summary.archetype = word(kArchetypes, read_integer(file, "desc.archetype"));
  summary.gender = word(kGenders, read_integer(file, "desc.gender"));
  summary.age = read_integer(file, "desc.age");
  summary.complexity = read_string(file, "desc.complexity");
  summary.database = read_string(file, "desc.dbName");
  for (uint32_t i = 0; i < info.metadata_count; ++i) {
    summary.metadata.emplace_back(read_string(file, element("desc.metadata", i, ".key")),
                                  read_string(file, element("desc.metadata", i, ".value")));
  }
  for (uint32_t i = 0; i < info.layer_count; ++i) {
    auto layer = sized<MienDnaLayer>();
    check(mien_dna_layer(file.dna.get(), i, &layer), nullptr, "cannot examine rig", file.shown);
    summary.layers.push_back(layer);
  }
  summary.counts = gather_counts(file);
  summary.behavior = tally_behavior(file);

  const bool has_definition = (info.layers & MIEN_LAYER_DEFINITION) != 0;
  Rig rig;
  if (info.layers & MIEN_LAYER_BEHAVIOR) {
    try {
      rig = create_rig(file, rig_desc);
      summary.rig = rig_info(rig.get());
    } catch (const Failure& failure) {
      // The file can be described all the same. Running out of memory is another matter.
      if (failure.exit_code != kInvalid) throw;
      note(session, failure.what());
    }
  }
  for (uint32_t lod = 0; has_definition && lod < info.lod_count; ++lod) {
    LodCounts at = {{
        {"joints", "joints", lod_map_count(file, "defn.lodJointMapping", lod)},
        {"blend_shape_channels", "channels", lod_map_count(file, "defn.lodBlendShapeMapping", lod)},
        {"animated_maps", "maps", lod_map_count(file, "defn.lodAnimatedMapMapping", lod)},
        {"meshes", "meshes", lod_map_count(file, "defn.lodMeshMapping", lod)},
    }};
    if (rig) {
      auto statistics = sized<MienRigStatistics>();
      check(mien_rig_statistics(rig.get(), lod, &statistics), nullptr, "cannot examine rig",
            file.shown);
      at.counts.push_back({"psd_controls", "correctives", statistics.psd_count});
      at.counts.push_back({"joint_values", "joint values", statistics.joint_row_count});
      at.counts.push_back({"matrix_entries", "matrix entries", statistics.joint_entry_count});
      at.counts.push_back({"matrix_bytes", "matrix bytes", statistics.joint_byte_count});
      at.counts.push_back({"rbf_solvers", "RBF solvers", statistics.rbf_solver_count});
    }
    summary.lods.push_back(at);
  }
  return summary;
}

std::string version_text(const MienDnaInfo& info) {
  return std::to_string(info.generation) + "." + std::to_string(info.version);
}

// JSON ------------------------------------------------------------------------------------------

void write_counts(JsonWriter& json, const std::vector<Count>& counts) {
  for (const Count& count : counts) json.member(count.key, count.value);
}

void write_json(const RigFile& file, const Summary& summary,
                const std::vector<const NameKind*>& kinds) {
  const MienDnaInfo& info = file.info;
  Output output("-");
  JsonWriter json(output);
  using Layout = JsonWriter::Layout;
  json.begin_object(Layout::kLines);
  json.member("file", file.shown);
  json.member("name", summary.name);
  json.member("version", version_text(info));
  json.member("file_bytes", info.file_bytes);
  json.member("memory_bytes", info.memory_bytes);
  json.member("mapped", info.is_mapped != 0);

  json.key("layers");
  json.begin_array(Layout::kLines);
  for (const MienDnaLayer& layer : summary.layers) {
    json.begin_object();
    json.member("code", std::string_view(layer.code));
    json.member("version",
                std::to_string(layer.version_major) + "." + std::to_string(layer.version_minor));
    json.member("offset", layer.byte_offset);
    json.member("bytes", layer.byte_count);
    json.member("known", layer.layer != 0);
    json.member("loaded", layer.is_loaded != 0);
    json.end_object();
  }
  json.end_array();

  json.member("archetype", summary.archetype);
  json.member("gender", summary.gender);
  json.member("age", summary.age);
  json.member("complexity", summary.complexity);
  json.member("database", summary.database);
  json.key("units");
  json.begin_object();
  json.member("translation", word(kTranslationUnits, info.translation_unit));
  json.member("rotation", word(kRotationUnits, info.rotation_unit));
  json.end_object();
  json.key("axes");
  json.begin_object();
  json.member("x", word(kDirections, info.axes[0]));
  json.member("y", word(kDirections, info.axes[1]));
  json.member("z", word(kDirections, info.axes[2]));
  json.end_object();
  json.key("system");
  const std::string system = name_of_system(info);
  if (system.empty()) {
    json.null();
  } else {
    json.value(system);
  }
  json.member("rotation_sequence", word(kSequences, info.rotation_sequence));
  json.key("rotation_signs");
  json.begin_array();
  for (const int32_t sign : info.rotation_signs) json.value(sign);
  json.end_array();
  json.member("face_winding", word(kWindings, info.face_winding));

  json.member("lod_count", info.lod_count);
  json.member("max_lod", info.max_lod);
  json.key("counts");
  json.begin_object(Layout::kLines);
  write_counts(json, summary.counts);
  json.end_object();
  json.key("behavior");
  json.begin_object(Layout::kLines);
  for (const Tally& tally : summary.behavior) {
    json.key(tally.key);
    json.begin_object();
    for (const auto& [kind, count] : tally.kinds) {
      std::string key = kind;
      std::replace(key.begin(), key.end(), ' ', '_');
      json.member(key, count);
    }
    json.end_object();
  }
  json.end_object();
  json.key("lods");
  json.begin_array(Layout::kLines);
  for (uint32_t lod = 0; lod < summary.lods.size(); ++lod) {
    json.begin_object();
    json.member("lod", lod);
    write_counts(json, summary.lods[lod].counts);
    json.end_object();
  }
  json.end_array();

  json.key("metadata");
  json.begin_array(Layout::kLines);
  for (const auto& [key, value] : summary.metadata) {
    json.begin_object();
    json.member("key", key);
    json.member("value", value);
    json.end_object();
  }
  json.end_array();

  json.key("rig");
  if (summary.rig) {
    json.begin_object();
    json.member("isa", mien_isa_name(summary.rig->isa));
    json.member("arithmetic", arithmetic_word(*summary.rig));
    json.member("rig_bytes", summary.rig->rig_bytes);
    json.member("instance_bytes", summary.rig->instance_bytes);
    json.end_object();
  } else {
    json.null();
  }
  if (!kinds.empty()) {
    json.key("names");
    json.begin_object(Layout::kLines);
    for (const NameKind* kind : kinds) {
      json.key(kind->word);
      json.begin_array(Layout::kLines);
      for (const std::string& name : names_of(file, *kind)) json.value(name);
      json.end_array();
    }
    json.end_object();
  }
  json.end_object();
  json.finish();
  output.commit();
}

// Text ------------------------------------------------------------------------------------------

std::string pad(const std::string& text, size_t width) {
  return text.size() < width ? text + std::string(width - text.size(), ' ') : text;
}

std::string pad_left(const std::string& text, size_t width) {
  return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}

/// Columns as wide as their widest cell; the first one to the left, the others to the right.
std::string table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    text += "  " + pad(row[0], widths[0]);
    for (size_t i = 1; i < row.size(); ++i) text += "  " + pad_left(row[i], widths[i]);
    text.erase(text.find_last_not_of(' ') + 1);
    text += "\n";
  }
  return text;
}

std::string property(const char* label, const std::string& value) {
  return value.empty() ? "" : "  " + pad(label, 14) + one_line(value) + "\n";
}

/// Long values, such as colors in base64, are cut.
std::string shortened(const std::string& value) {
  constexpr size_t kShown = 60;
  const std::string line = one_line(value);
  if (line.size() <= kShown + 20) return line;
  size_t end = kShown;
  while (end > 0 && (line[end] & 0xc0) == 0x80) --end;  // not within a character
  return line.substr(0, end) + "... (" + grouped(value.size()) + " bytes; --full shows all)";
}

void write_text(const RigFile& file, const Summary& summary, bool full, const Session& session) {
  const MienDnaInfo& info = file.info;
  const auto heading = [&](const std::string& text) {
    return paint(text, Style::kBold, session.terminal.out_colors) + "\n";
  };
  std::string text = heading(one_line(file.shown));
  text += property("name", summary.name);
  text += property("version", version_text(info));
  text +=
      property("size", size_text(info.file_bytes) + (info.is_mapped ? ", mapped; " : ", read; ") +
                           size_text(info.memory_bytes) + " of memory");
  text += property("character", summary.archetype + ", " + summary.gender + ", " +
                                    std::to_string(summary.age) + " years");
  text += property("complexity", summary.complexity);
  text += property("database", summary.database);
  text += property("units", word(kTranslationUnits, info.translation_unit) + ", " +
                                word(kRotationUnits, info.rotation_unit));
  text += property("system", name_of_system(info));
  const int hand = handedness(info);
  text += property("axes", "x " + word(kDirections, info.axes[0]) + ", y " +
                               word(kDirections, info.axes[1]) + ", z " +
                               word(kDirections, info.axes[2]) +
                               (hand > 0   ? ": right-handed"
                                : hand < 0 ? ": left-handed"
                                           : ": they do not span space"));
  std::string signs;
  for (const int32_t sign : info.rotation_signs) signs += sign < 0 ? " -" : " +";
  text += property("rotation", word(kSequences, info.rotation_sequence) + ", signs" + signs);
  // Files tell the winding by the plain cross product, which left-handed axes show mirrored.
  const uint32_t seen =
      hand < 0 && info.face_winding < 2 ? 1 - info.face_winding : info.face_winding;
  text += property("faces", word(kWindings, seen) + " seen from outside");
  text += property("LODs", std::to_string(info.lod_count) + ", the finest is LOD " +
                               std::to_string(info.max_lod) + " of its data base");
  if (summary.rig) {
    text += property("rig", size_text(summary.rig->rig_bytes) + ", " +
                                size_text(summary.rig->instance_bytes) + " per character, " +
                                mien_isa_name(summary.rig->isa));
  }

  text += "\n" + heading("Layers");
  std::vector<std::vector<std::string>> rows = {{"code", "version", "offset", "bytes", ""}};
  for (const MienDnaLayer& layer : summary.layers) {
    rows.push_back({one_line(layer.code),
                    std::to_string(layer.version_major) + "." + std::to_string(layer.version_minor),
                    grouped(layer.byte_offset), grouped(layer.byte_count),
                    layer.layer == 0  ? "unknown"
                    : layer.is_loaded ? ""
                                      : "not loaded"});
  }
  text += table(rows);

  text += "\n" + heading("Counts");
  rows.clear();
  for (const Count& count : summary.counts) rows.push_back({count.text, grouped(count.value)});
  text += table(rows);

  text += "\n" + heading("Behavior");
  for (const Tally& tally : summary.behavior) {
    if (tally.empty()) continue;
    std::string kinds;
    for (const auto& [kind, count] : tally.kinds) {
      if (count != 0) kinds += (kinds.empty() ? "" : ", ") + grouped(count) + " " + kind;
    }
    text += "  " + pad(tally.label, 18) + kinds + "\n";
  }

  if (!summary.lods.empty()) {
    text += "\n" + heading("Levels of detail");
    rows = {{"LOD"}};
    for (const Count& count : summary.lods[0].counts) rows[0].push_back(count.text);
    for (size_t lod = 0; lod < summary.lods.size(); ++lod) {
      rows.push_back({std::to_string(lod)});
      for (const Count& count : summary.lods[lod].counts)
        rows.back().push_back(grouped(count.value));
    }
    text += table(rows);
  }

  if (!summary.metadata.empty()) {
    text += "\n" + heading("Metadata");
    for (const auto& [key, value] : summary.metadata) {
      text += "  " + one_line(key) + " = " + (full ? one_line(value) : shortened(value)) + "\n";
    }
  }
  Output output("-");
  output.write(text);
  output.commit();
}

/// Names alone, one per line, for other programs.
void write_names(const RigFile& file, const std::vector<const NameKind*>& kinds,
                 const Session& session) {
  Output output("-");
  for (const NameKind* kind : kinds) {
    if (kinds.size() > 1) {
      output.write(paint(kind->word, Style::kBold, session.terminal.out_colors) + "\n");
    }
    const char* indent = kinds.size() > 1 ? "  " : "";
    for (const std::string& name : names_of(file, *kind))
      output.write(indent + one_line(name) + "\n");
  }
  output.commit();
}

void run(const InfoOptions& options, const Session& session) {
  const MienDnaDesc desc = parse_load_options(options.load, MIEN_LAYER_ALL);
  const MienRigDesc rig_desc = parse_rig_options(options.evaluation);
  std::vector<const NameKind*> kinds;
  if (!options.names.empty()) kinds = parse_names(options.names);

  if (is_baked_file(options.rig)) {
    if (!kinds.empty()) {
      fail_usage("--names", "a baked rig is described by its counts alone",
                 "give the DNA file that it was baked from");
    }
    const BakedFile baked = open_baked_rig(options.rig, options.load, options.evaluation);
    return write_baked_info(baked, options.json, session);
  }
  const RigFile file = open_rig_file(options.rig, desc, session);
  if (!kinds.empty() && !options.json) return write_names(file, kinds, session);
  const Summary summary = gather(file, rig_desc, session);
  if (options.json) {
    write_json(file, summary, kinds);
  } else {
    write_text(file, summary, options.full, session);
  }
}

}  // namespace

Command add_info_command(CLI::App& app, const Session& session) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* info = app.add_subcommand("info", "Show what a rig contains");
  info->add_option("RIG", options->rig, "DNA file or baked rig; - reads standard input")
      ->type_name("")
      ->required();
  info->add_flag("--json", options->json, "Print JSON");
  info->add_flag("--full", options->full, "Do not shorten long metadata values");
  info->add_option(
          "--names", options->names,
          "List names: " + list_of(option_words("--names"), "or") + "\n(separated by commas)")
      ->type_name("KINDS");
  add_load_options(*info, options->load);
  add_rig_options(*info, options->evaluation);
  info->footer(
      "Examples:\n"
      "  mien info head.dna\n"
      "  mien info head.dna --names raw\n"
      "  mien info head.dna --json | jq .counts.joints");
  return {info, [options, &session] { run(*options, session); }};
}

}  // namespace mien::cli
