// SPDX-License-Identifier: MIT
// Options of `mien edit` that change meshes or take parts of other files.
#include <algorithm>

#include "integrations/program/commands/edit_values.h"
#include "integrations/program/commands/options.h"
#include "integrations/program/edit/arrays.h"
#include "integrations/program/io/dna_fields.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

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
  const auto influences = static_cast<uint32_t>(parse_number("--limit-influences", value, 65535));
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
  const auto times =
      static_cast<uint32_t>(parse_number("--smooth-weights", pair.second, kMostTimes));
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

/// "N --from M", or "N --from M --match uv".
std::string apply_make_lod(Document& document, const std::string& value) {
  const std::string from_option = " --from ", match_option = " --match ";
  const size_t from_at = value.find(from_option), match_at = value.find(match_option);
  const std::string lod = value.substr(0, from_at);
  const size_t from_begin = from_at + from_option.size();
  const std::string from =
      value.substr(from_begin, match_at == std::string::npos ? match_at : match_at - from_begin);
  const std::string match =
      match_at == std::string::npos ? "surface" : value.substr(match_at + match_option.size());
  if (match != "surface" && match != "uv")
    fail_edit_value(document, "\"" + match + "\" is not surface or uv", "choose one of them");
  auto desc = sized<MienProjectDesc>();
  desc.match = match == "uv" ? MIEN_MATCH_UV : MIEN_MATCH_SURFACE;
  double farthest = 0;
  edited(document, mien_document_make_lod,
         static_cast<uint32_t>(parse_number("--make-lod", lod, 32)),
         static_cast<uint32_t>(parse_number("--from", from, 32)), &desc, &farthest);
  return "made LOD " + lod + " from LOD " + from + ": " +
         (match == "uv" ? "texture coordinates differ" : "positions are off its surface") +
         " by at most " + length_text(farthest);
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

}  // namespace

std::vector<EditOption> mesh_edit_options() {
  const char* const kMeshes = "Meshes (FILE: OBJ, NPY or JSON, in the units and axes of IN)";
  return {
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
  };
}

std::vector<EditOption> other_file_edit_options() {
  const char* const kOthers = "Parts of other DNA files";
  return {
      {"--copy-mesh", "MESH=DNA", kOthers,
       "Copy a mesh; it replaces the one of that name, or is added", apply_copy_mesh},
      {"--copy-layers", "LAYERS=DNA", kOthers,
       "Copy layers, named as for 'mien convert', with those that they need", apply_copy_layers},
      {"--merge-joints", "DNA", kOthers, "Add the joints that IN lacks, such as those of the body",
       apply_merge_joints},
      {"--split-joints", "DNA", kOthers, "Remove the joints that the other file lacks",
       apply_split_joints},
      {"--transplant", "DNA", kOthers,
       "Give the character the rig of another file: controls, joints, behavior", apply_transplant},
  };
}

}  // namespace mien::cli
