// SPDX-License-Identifier: MIT
#include "integrations/program/commands/edit_options.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "integrations/program/commands/options.h"
#include "integrations/program/edit/arrays.h"
#include "integrations/program/io/dna_fields.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/json_check.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

// Values ------------------------------------------------------------------------------------------

[[noreturn]] void fail_edit_value(const Document& document, const std::string& why,
                                  const std::string& what_to_do) {
  fail_usage(document.edit, why, what_to_do);
}

struct NamePair {
  std::string first, second;
};

/// At the first separator, or the last one.
NamePair split_pair(const Document& document, const std::string& value, char separator,
                    const char* form, bool at_last = false) {
  const size_t at = at_last ? value.rfind(separator) : value.find(separator);
  if (at == std::string::npos || at == 0 || at + 1 == value.size()) {
    fail_edit_value(document, std::string("this is not ") + form, std::string("write ") + form);
  }
  return {value.substr(0, at), value.substr(at + 1)};
}

/// Finite numbers, separated by commas.
std::vector<double> parse_list(const Document& document, const std::string& list) {
  std::vector<double> numbers;
  const char* at = list.data();
  const char* const end = at + list.size();
  while (true) {
    double number = 0;
    const auto [stop, error] = std::from_chars(at, end, number);
    if (error != std::errc() || !std::isfinite(number) ||
        !std::isfinite(static_cast<float>(number)) || (stop != end && *stop != ',')) {
      fail_edit_value(document, "\"" + list + "\" is not a list of finite numbers",
                      "separate them by commas, without spaces");
    }
    numbers.push_back(number);
    if (stop == end) return numbers;
    at = stop + 1;
  }
}

std::vector<double> parse_list_of(const Document& document, const std::string& list, size_t count,
                                  const char* form) {
  std::vector<double> numbers = parse_list(document, list);
  if (numbers.size() != count) {
    fail_edit_value(document, "these are not " + std::to_string(count) + " numbers",
                    std::string("write ") + form);
  }
  return numbers;
}

uint32_t kind_named(const Document& document, const std::string& word) {
  static const Words words = {"joint", "mesh", "blend-shape", "animated-map", "raw",
                              "gui",   "psd",  "ml",          "rbf"};
  constexpr uint32_t kKinds[] = {
      MIEN_KIND_JOINT,        MIEN_KIND_MESH,        MIEN_KIND_BLEND_SHAPE_CHANNEL,
      MIEN_KIND_ANIMATED_MAP, MIEN_KIND_RAW_CONTROL, MIEN_KIND_GUI_CONTROL,
      MIEN_KIND_PSD_CONTROL,  MIEN_KIND_ML_CONTROL,  MIEN_KIND_RBF_CONTROL};
  for (size_t i = 0; i < words.size(); ++i) {
    if (words[i] == word) return kKinds[i];
  }
  fail_edit_value(document, "\"" + word + "\" is not one of " + list_of(words, "and"),
                  nearest_question(word, words, "choose one of them"));
}

struct MeshAndFile {
  std::string name;
  uint32_t mesh;
  std::string path;
};

MeshAndFile parse_mesh_and_file(const Document& document, const std::string& value) {
  const NamePair pair = split_pair(document, value, '=', "MESH=FILE");
  return {pair.first, find_element(document, MIEN_KIND_MESH, pair.first), pair.second};
}

std::string amount_text(uint64_t count, const std::string& noun) {
  return grouped(count) + " " + noun + (count == 1 ? "" : noun.back() == 'h' ? "es" : "s");
}

std::string length_text(double length) {
  char digits[32];
  const auto end =
      std::to_chars(digits, digits + sizeof(digits), length, std::chars_format::general, 3);
  return std::string(digits, end.ptr);
}

// Edits -------------------------------------------------------------------------------------------

/// Calls a function of the library with the document, `given` and a place for what went wrong.
template <class Function, class... Given>
void edited(const Document& document, Function* function, Given... given) {
  auto error = sized<MienError>();
  check_edit(document, function(document.get(), given..., &error), error);
}

/// Calls edit(mesh) for the mesh of this name, or for "all".
template <class EditMesh>
std::string edit_meshes(const Document& document, const std::string& name, EditMesh&& edit) {
  if (name != "all") {
    edit(find_element(document, MIEN_KIND_MESH, name));
    return "mesh \"" + name + "\"";
  }
  const uint64_t count = field_count(document, "geom.meshes");
  for (uint32_t mesh = 0; mesh < count; ++mesh) edit(mesh);
  return "all meshes";
}

std::string apply_rename(Document& document, const std::string& value) {
  const char* const form = "KIND:OLD=NEW";
  const NamePair kind_and_names = split_pair(document, value, ':', form);
  const NamePair names = split_pair(document, kind_and_names.second, '=', form);
  const uint32_t kind = kind_named(document, kind_and_names.first);
  const uint32_t index = find_element(document, kind, names.first);
  edited(document, mien_document_rename, kind, index, names.second.c_str());
  return std::string("renamed ") + kind_noun(kind) + " \"" + names.first + "\" to \"" +
         names.second + "\"";
}

std::string apply_remove(Document& document, const std::string& value) {
  const NamePair pair = split_pair(document, value, ':', "KIND:NAME");
  const uint32_t kind = kind_named(document, pair.first);
  const uint32_t index = find_element(document, kind, pair.second);
  edited(document, mien_document_remove, kind, &index, 1);
  return std::string("removed ") + kind_noun(kind) + " \"" + pair.second + "\"";
}

std::string apply_clear(Document& document, const std::string& value) {
  const std::string animation = "joint-animation";
  if (value.compare(0, animation.size() + 1, animation + ":") == 0) {
    const std::string name = value.substr(animation.size() + 1);
    const uint32_t joint = find_element(document, MIEN_KIND_JOINT, name);
    edited(document, mien_document_clear_joints, &joint, 1);
    return "removed what moves joint \"" + name + "\"";
  }
  static const Words words = {"blend-shapes", "animated-maps", animation};
  constexpr uint32_t kKinds[] = {MIEN_KIND_BLEND_SHAPE_CHANNEL, MIEN_KIND_ANIMATED_MAP,
                                 MIEN_KIND_JOINT};
  for (size_t i = 0; i < words.size(); ++i) {
    if (words[i] != value) continue;
    edited(document, mien_document_clear, kKinds[i]);
    return "removed all " + (i == 2 ? "that moves joints" : value);
  }
  fail_edit_value(document, "\"" + value + "\" is not one of " + list_of(words, "and"),
                  nearest_question(value, words, "or write joint-animation:NAME"));
}

std::string apply_neutral(Document& document, const std::string& value) {
  const char* const form = "JOINT:tx,ty,tz or JOINT:tx,ty,tz,rx,ry,rz";
  const NamePair pair = split_pair(document, value, ':', form, true);
  const std::vector<double> numbers = parse_list(document, pair.second);
  if (numbers.size() != 3 && numbers.size() != 6) {
    fail_edit_value(document, "these are not 3 or 6 numbers", std::string("write ") + form);
  }
  const std::vector<float> transform(numbers.begin(), numbers.end());
  const uint32_t joint = find_element(document, MIEN_KIND_JOINT, pair.first);
  edited(document, mien_document_set_neutral, joint, transform.data(),
         numbers.size() == 6 ? transform.data() + 3 : nullptr, 1);
  return "moved joint \"" + pair.first + "\"";
}

void apply_placement(const Document& document, const MienPlacement& placement) {
  edited(document, mien_document_place, &placement);
}

std::string apply_scale(Document& document, const std::string& value) {
  auto placement = sized<MienPlacement>();
  placement.scale = parse_list_of(document, value, 1, "one number")[0];
  if (placement.scale <= 0) fail_edit_value(document, "a scale is above 0", "write 2, or 0.01");
  apply_placement(document, placement);
  return "scaled by " + value;
}

std::string apply_translate(Document& document, const std::string& value) {
  auto placement = sized<MienPlacement>();
  const std::vector<double> numbers = parse_list_of(document, value, 3, "x,y,z");
  std::copy(numbers.begin(), numbers.end(), placement.translation);
  apply_placement(document, placement);
  return "moved by " + value;
}

std::string apply_rotate(Document& document, const std::string& value) {
  auto placement = sized<MienPlacement>();
  const std::vector<double> numbers = parse_list_of(document, value, 3, "x,y,z, in degrees");
  std::copy(numbers.begin(), numbers.end(), placement.rotation);
  apply_placement(document, placement);
  return "rotated by " + value + " degrees";
}

std::string apply_positions(Document& document, const std::string& value) {
  const MeshAndFile given = parse_mesh_and_file(document, value);
  const std::vector<float> positions =
      read_positions(document, given.path, mesh_positions(document, given.mesh));
  edited(document, mien_document_set_positions, given.mesh, positions.data(), positions.size() / 3);
  return "set " + amount_text(positions.size() / 3, "position") + " of mesh \"" + given.name + "\"";
}

std::string apply_targets(Document& document, const std::string& value) {
  const char* const form = "MESH/CHANNEL=FILE";
  const NamePair target = split_pair(document, value, '=', form);
  const NamePair names = split_pair(document, target.first, '/', form);
  const uint32_t mesh = find_element(document, MIEN_KIND_MESH, names.first);
  const uint32_t channel = find_element(document, MIEN_KIND_BLEND_SHAPE_CHANNEL, names.second);
  const std::vector<float> deltas =
      read_deltas(document, target.second, mesh_positions(document, mesh));
  edited(document, mien_document_set_target, mesh, channel, nullptr, deltas.data(),
         deltas.size() / 3);
  return "set the target of blend shape \"" + names.second + "\" on mesh \"" + names.first + "\"";
}

std::string apply_skin_weights(Document& document, const std::string& value) {
  const MeshAndFile given = parse_mesh_and_file(document, value);
  const size_t count = mesh_positions(document, given.mesh).size() / 3;
  const WeightRows rows = read_weight_rows(document, given.path, count);
  edited(document, mien_document_set_weights, given.mesh, rows.influences, rows.joints.data(),
         rows.weights.data(), rows.weights.size());
  return "set the skin weights of mesh \"" + given.name + "\"";
}

std::string apply_limit_influences(Document& document, const std::string& value) {
  const auto influences = static_cast<uint32_t>(parse_number(document.edit, value, 65535));
  if (influences == 0) fail_edit_value(document, "each position needs one", "write 4, say");
  edit_meshes(document, "all", [&](uint32_t mesh) {
    edited(document, mien_document_limit_influences, mesh, influences);
  });
  return "limited skin weights to " + amount_text(influences, "influence");
}

std::string apply_normalize_weights(Document& document, const std::string& value) {
  return "normalized the skin weights of " + edit_meshes(document, value, [&](uint32_t mesh) {
           edited(document, mien_document_normalize_weights, mesh);
         });
}

std::string apply_smooth_weights(Document& document, const std::string& value) {
  constexpr float kStrength = 0.5f;
  constexpr uint32_t kInfluences = 8, kMostTimes = 1000;
  const NamePair pair = split_pair(document, value, '=', "MESH=TIMES", true);
  const auto times = static_cast<uint32_t>(parse_number(document.edit, pair.second, kMostTimes));
  return "smoothed the skin weights of " + edit_meshes(document, pair.first, [&](uint32_t mesh) {
           edited(document, mien_document_smooth_weights, mesh, times, kStrength, kInfluences);
         });
}

std::string apply_conform(Document& document, const std::string& value) {
  const MeshAndFile given = parse_mesh_and_file(document, value);
  const std::vector<float> positions =
      read_positions(document, given.path, mesh_positions(document, given.mesh));
  auto conformed = sized<MienConformed>();
  edited(document, mien_document_conform, given.mesh, positions.data(), positions.size() / 3,
         uint32_t{1}, &conformed);
  std::string text = "conformed the rig to mesh \"" + given.name + "\"";
  if (conformed.joint_distance > 0) {
    text += ": joint \"" + read_string(document, element("defn.jointNames", conformed.joint)) +
            "\" moved farthest, by " + length_text(conformed.joint_distance);
  }
  return text;
}

std::string apply_prune_targets(Document& document, const std::string& value) {
  const double tolerance = parse_list_of(document, value, 1, "one number")[0];
  if (tolerance < 0) fail_edit_value(document, "a length is not below 0", "write 0.001, say");
  auto pruned = sized<MienPrunedTargets>();
  edited(document, mien_document_prune_targets, static_cast<float>(tolerance), &pruned);
  return "removed " + amount_text(pruned.deltas, "delta") + " and " +
         amount_text(pruned.targets, "target");
}

std::string apply_prune_joints(Document& document, const std::string& value) {
  const std::vector<double> limits =
      parse_list_of(document, value, 3, "TRANSLATION,ROTATION,SCALE");
  auto desc = sized<MienPruneJointsDesc>();
  desc.translation = static_cast<float>(limits[0]);
  desc.rotation = static_cast<float>(limits[1]);
  desc.scale = static_cast<float>(limits[2]);
  auto pruned = sized<MienPrunedJoints>();
  edited(document, mien_document_prune_joints, &desc, &pruned);
  return "removed " + grouped(pruned.removed_count) + " of " + grouped(pruned.entry_count) +
         " entries of the joint matrix: positions move by at most " +
         length_text(pruned.worst_distance);
}

std::string apply_lods(Document& document, const std::string& value) {
  const uint64_t lods = parse_lod_list(value);
  edited(document, mien_document_keep_lods, lods);
  return "kept LODs " + value;
}

/// "N M", or "N M uv".
std::string apply_make_lod(Document& document, const std::string& value) {
  const NamePair first = split_pair(document, value, ' ', "--make-lod N --from M");
  const size_t space = first.second.find(' ');
  const std::string from = first.second.substr(0, space);
  const std::string match = space == std::string::npos ? "surface" : first.second.substr(space + 1);
  if (match != "surface" && match != "uv")
    fail_edit_value(document, "\"" + match + "\" is not surface or uv", "choose one of them");
  auto desc = sized<MienProjectDesc>();
  desc.match = match == "uv" ? MIEN_MATCH_UV : MIEN_MATCH_SURFACE;
  double farthest = 0;
  edited(document, mien_document_make_lod,
         static_cast<uint32_t>(parse_number("--make-lod", first.first, 32)),
         static_cast<uint32_t>(parse_number("--from", from, 32)), &desc, &farthest);
  return "made LOD " + first.first + " from LOD " + from + ": " +
         (match == "uv" ? "texture coordinates differ" : "positions are off its surface") +
         " by at most " + length_text(farthest);
}

std::string apply_system(Document& document, const std::string& value) {
  const MienCoordinateSystem system = parse_system(value);
  edited(document, mien_document_convert, &system);
  return "converted to the units and axes of " + value;
}

std::string apply_name(Document& document, const std::string& value) {
  edited(document, mien_document_write_string, "desc.name", value.data(), value.size());
  return "named \"" + value + "\"";
}

void write_metadata(const Document& document, uint64_t index, const char* member,
                    const std::string& text) {
  edited(document, mien_document_write_string, element("desc.metadata", index, member).c_str(),
         text.data(), text.size());
}

std::string apply_metadata(Document& document, const std::string& value) {
  const size_t equals = value.find('=');
  if (equals == std::string::npos || equals == 0) {
    fail_edit_value(document, "this is not KEY=VALUE",
                    "write KEY=VALUE, or KEY= for an empty value");
  }
  const std::string key = value.substr(0, equals);
  const uint64_t count = field_count(document, "desc.metadata");
  uint64_t index = 0;
  while (index < count && read_string(document, element("desc.metadata", index, ".key")) != key) {
    ++index;
  }
  if (index == count) {
    edited(document, mien_document_resize, "desc.metadata", count + 1);
    write_metadata(document, index, ".key", key);
  }
  write_metadata(document, index, ".value", value.substr(equals + 1));
  return "set metadata \"" + key + "\"";
}

std::string apply_version(Document& document, const std::string& value) {
  document.version = 1 + static_cast<uint32_t>(parse_word("--version", value));
  return "version " + value;
}

// Parts of other files ----------------------------------------------------------------------------

std::string apply_copy_mesh(Document& document, const std::string& value) {
  const NamePair pair = split_pair(document, value, '=', "MESH=FILE");
  Document other = open_document(pair.second, *document.session);
  other.edit = document.edit;
  const uint32_t mesh = find_element(other, MIEN_KIND_MESH, pair.first);
  uint32_t copied = 0;
  edited(document, mien_document_copy_mesh, other.get(), mesh, &copied);
  return "copied mesh \"" + pair.first + "\" of " + pair.second;
}

std::string apply_copy_layers(Document& document, const std::string& value) {
  const NamePair pair = split_pair(document, value, '=', "LAYERS=FILE");
  LoadOptions layers;
  layers.layers = pair.first;
  const Document other = open_document(pair.second, *document.session);
  edited(document, mien_document_copy_layers, other.get(), parse_load_options(layers, 0).layers);
  return "copied " + pair.first + " of " + pair.second;
}

std::string apply_merge_joints(Document& document, const std::string& value) {
  // As far as exports of one character differ in the places of joints that body and head share.
  constexpr double kTolerance = 1e-3;
  const Document other = open_document(value, *document.session);
  const uint64_t before = field_count(document, "defn.jointNames");
  edited(document, mien_document_merge_joints, other.get(), kTolerance);
  return "added " + amount_text(field_count(document, "defn.jointNames") - before, "joint") +
         " of " + value;
}

std::string apply_split_joints(Document& document, const std::string& value) {
  const Document other = open_document(value, *document.session);
  const uint64_t before = field_count(document, "defn.jointNames");
  edited(document, mien_document_split_joints, other.get());
  return "removed " + amount_text(before - field_count(document, "defn.jointNames"), "joint") +
         " that " + value + " does not have";
}

std::string apply_transplant(Document& document, const std::string& value) {
  const Document rig = open_document(value, *document.session);
  std::vector<MienControlError> errors(field_count(rig, "defn.rawControlNames"));
  size_t count = 0;
  edited(document, mien_document_transplant, rig.get(), nullptr, errors.data(), errors.size(),
         &count);
  std::string text = "gave the character the rig of " + value;
  const auto worst = std::max_element(
      errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(count),
      [](const MienControlError& a, const MienControlError& b) { return a.worst < b.worst; });
  if (count != 0) {
    text += ": control \"" +
            read_string(document, element("defn.rawControlNames", worst->control)) +
            "\" differs most from before, by " + length_text(worst->worst) + " where it moved " +
            length_text(worst->moved);
  }
  return text;
}

const EditOption* find_edit_option(const std::string& name) {
  for (const EditOption& option : edit_options()) {
    if (name == option.name) return &option;
  }
  return nullptr;
}

}  // namespace

const std::vector<EditOption>& edit_options() {
  static const char* const kNames = "Names and what is there";
  static const char* const kPlaces = "Places";
  static const char* const kMeshes = "Meshes (FILE: OBJ, NPY or JSON, in the units and axes of IN)";
  static const char* const kOthers = "Parts of other DNA files";
  static const std::vector<EditOption> options = {
      {"--rename", "KIND:OLD=NEW", kNames,
       "KIND: joint, mesh, blend-shape, animated-map, raw, gui, ml or rbf", apply_rename},
      {"--remove", "KIND:NAME", kNames,
       "KIND: joint, mesh, blend-shape, animated-map, raw, gui or psd (psd0, psd1, ...). What\n"
       "refers to it is removed, too; children of a joint go to its parent and keep their place",
       apply_remove},
      {"--clear", "WHAT", kNames,
       "blend-shapes (channels too), animated-maps, joint-animation, or\njoint-animation:NAME for "
       "one joint",
       apply_clear},
      {"--lods", "LIST", kNames, "Keep only these LODs, such as 2-7; renumbered from 0",
       apply_lods},
      {"--name", "NAME", kNames, "Name of the character", apply_name},
      {"--metadata", "KEY=VALUE", kNames, "Add or replace a pair of the descriptor",
       apply_metadata},
      {"--version", "V", kNames, "Version to write, 2.1 to 2.8 (default: that of IN)",
       apply_version},
      {"--neutral", "JOINT:NUMBERS", kPlaces,
       "tx,ty,tz or tx,ty,tz,rx,ry,rz: neutral transform relative to the parent", apply_neutral},
      {"--scale", "F", kPlaces, "Scale the whole character about the origin", apply_scale},
      {"--rotate", "X,Y,Z", kPlaces,
       "Rotate it about the origin: right-handed degrees about x, then y, then z", apply_rotate},
      {"--translate", "X,Y,Z", kPlaces, "Move it", apply_translate},
      {"--system", "NAME", kPlaces,
       "Convert to the units, axes and winding of an engine or tool, as 'mien convert'",
       apply_system},
      {"--positions", "MESH=FILE", kMeshes, "Replace the positions of a mesh", apply_positions},
      {"--conform", "MESH=FILE", kMeshes,
       "The same, and let joints, targets and other meshes follow the new shape", apply_conform},
      {"--targets", "MESH/CHANNEL=FILE", kMeshes,
       "Replace the target of a blend shape: an OBJ is the posed shape, NPY and JSON hold\ndeltas",
       apply_targets},
      {"--skin-weights", "MESH=FILE", kMeshes,
       "Replace skin weights: NPY of positions x joints, or JSON [[[joint, weight], ...], ...]",
       apply_skin_weights},
      {"--limit-influences", "N", kMeshes, "Keep the N largest weights of each position",
       apply_limit_influences},
      {"--normalize-weights", "MESH", kMeshes,
       "Scale the weights of each position to a sum of 1; MESH may be all",
       apply_normalize_weights},
      {"--smooth-weights", "MESH=TIMES", kMeshes,
       "Mix the weights of each position with those of its neighbors; MESH may be all",
       apply_smooth_weights},
      {"--prune-targets", "LENGTH", kMeshes, "Remove deltas that are not longer than this",
       apply_prune_targets},
      {"--prune-joints", "T,R,S", kMeshes,
       "Remove entries of the joint matrix not above these, for translation, rotation and\nscale; "
       "prints what that moves",
       apply_prune_joints},
      {"--make-lod", "N", kMeshes,
       "Compute joints, weights and targets of LOD N from a finer one; followed by --from",
       apply_make_lod},
      {"--from", "M", kMeshes, "The finer LOD", nullptr},
      {"--match", "HOW", kMeshes,
       "After --from: by the nearest place in space, surface (default), or in the texture, uv",
       nullptr},
      {"--copy-mesh", "MESH=DNA", kOthers, "Copy a mesh, over the one of that name or as a new one",
       apply_copy_mesh},
      {"--copy-layers", "LAYERS=DNA", kOthers,
       "Copy layers, named as for 'mien convert', with those that they need", apply_copy_layers},
      {"--merge-joints", "DNA", kOthers, "Add the joints that IN lacks, such as those of the body",
       apply_merge_joints},
      {"--split-joints", "DNA", kOthers, "Remove the joints that the other file lacks",
       apply_split_joints},
      {"--transplant", "DNA", kOthers,
       "Give the character the rig of another file: controls, joints, behavior", apply_transplant},
  };
  return options;
}

std::vector<Edit> join_options(const std::vector<Edit>& edits) {
  std::vector<Edit> joined;
  std::string before;  // the option before
  for (const Edit& edit : edits) {
    const bool follows = edit.option == "--from" || edit.option == "--match";
    const char* const wanted = edit.option == "--match" ? "--from" : "--make-lod";
    if (follows ? before != wanted : before == "--make-lod") break;
    if (follows) {
      joined.back().value += " " + edit.value;
    } else {
      joined.push_back(edit);
    }
    before = edit.option;
  }
  size_t used = 0;
  for (const Edit& edit : joined) {
    used += 1;
    for (char c : edit.option == "--make-lod" ? edit.value : std::string()) used += c == ' ';
  }
  if (before == "--make-lod" || used != edits.size()) {
    fail_usage("--make-lod", "--make-lod, --from and --match go together, in this order",
               "write --make-lod 3 --from 0");
  }
  return joined;
}

std::vector<std::string> apply_edits(Document& document, const std::vector<Edit>& edits) {
  std::vector<std::string> done;
  for (const Edit& edit : edits) {
    document.edit = edit.option + " " + edit.value;
    try {
      done.push_back(find_edit_option(edit.option)->apply(document, edit.value));
    } catch (const Failure& failure) {
      if (edit.script.empty() || failure.exit_code != kUsage) throw;
      throw Failure(kInvalid, "invalid script, " + edit.script + ": " + failure.what());
    }
  }
  return done;
}

std::vector<Edit> read_edit_script(const std::string& path) {
  const char* const example = "write [[\"--rename\", \"joint:a=b\"], [\"--scale\", \"2\"]]";
  const char* const what = "invalid script";
  const auto script =
      parse_json<nlohmann::json>(read_text(path, "cannot read script"), what, path, example);
  if (!script.is_array()) fail(kInvalid, what, path, "this is not a list of commands", example);
  std::vector<Edit> edits;
  for (size_t i = 0; i < script.size(); ++i) {
    const auto& words = script[i];
    const std::string where = path + ", command " + std::to_string(i);
    bool valid = words.is_array() && !words.empty() && words.size() % 2 == 0;
    for (size_t k = 0; valid && k < words.size(); ++k) {
      valid = words[k].is_string() && !words[k].get_ref<const std::string&>().empty();
    }
    if (!valid) fail(kInvalid, what, where, "not an option and its value, as strings", example);
    for (size_t k = 0; k < words.size(); k += 2) {
      if (find_edit_option(words[k]) == nullptr) {
        Words names;
        for (const EditOption& option : edit_options()) names.emplace_back(option.name);
        fail(kInvalid, what, where, "there is no edit " + words[k].dump(),
             nearest_question(words[k].get<std::string>(), names, "see 'mien help edit'"));
      }
      edits.push_back({words[k], words[k + 1], path});
    }
  }
  try {
    return join_options(edits);
  } catch (const Failure& failure) {
    throw Failure(kInvalid, std::string(what) + ", " + path + ": " + failure.what());
  }
}

}  // namespace mien::cli
