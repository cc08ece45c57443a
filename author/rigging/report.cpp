// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>
#include <string_view>

#include "author/base/dna_making.h"
#include "author/rigging/rigging.h"
#include "author/text/json_writer.h"

namespace mien::author {

namespace {

/// Text that grows in an arena. It no longer changes after memory ran out.
class ArenaText {
 public:
  explicit ArenaText(Arena& arena) : arena_(&arena) {}

  void append(std::string_view text) {
    if (text.size() > room_.count - used_ && !grow(text.size())) return;
    memcpy(room_.data + used_, text.data(), text.size());
    used_ += text.size();
  }

  bool failed() const { return failed_; }
  Span<const char> result() const { return {room_.data, used_}; }

 private:
  bool grow(size_t wanted) {
    const Span<char> larger =
        failed_ ? Span<char>() : arena_->array<char>(room_.count * 2 + wanted + 65536);
    if (larger.empty()) {
      failed_ = true;
      return false;
    }
    if (used_) memcpy(larger.data, room_.data, used_);
    room_ = larger;
    return true;
  }

  Arena* arena_;
  Span<char> room_;
  size_t used_ = 0;
  bool failed_ = false;
};

using Json = JsonWriter<ArenaText>;
using Layout = JsonLayout;

std::string_view view(Name name) { return {name.data, name.count}; }

void write_number(Json& json, std::string_view key, double number) {
  json.key(key);
  json.rounded(number);
}

template <class... Numbers>
void write_numbers(Json& json, std::string_view key, Numbers... numbers) {
  json.key(key);
  json.begin_numbers(sizeof...(numbers));
  (json.rounded(numbers), ...);
  json.end_array();
}

void write_point(Json& json, std::string_view key, Vec3 p) {
  write_numbers(json, key, p.x, p.y, p.z);
}

const char* kind_name(BoneKind kind) {
  switch (kind) {
    case BoneKind::kRoot: return "root";
    case BoneKind::kNeck: return "neck";
    case BoneKind::kHead: return "head";
    case BoneKind::kFace: return "face";
    case BoneKind::kFacial: return "facial";
    case BoneKind::kJaw: return "jaw";
    case BoneKind::kEye: return "eye";
    case BoneKind::kChest: return "chest";
    case BoneKind::kTongue: return "tongue";
  }
  return "";
}

const char* split_name(NeckSplit split) {
  switch (split) {
    case NeckSplit::kNoNeck: return "none";
    case NeckSplit::kLinkage: return "linkage";
    case NeckSplit::kAreaLinkage: return "area_linkage";
    case NeckSplit::kPlane: return "plane";
  }
  return "";
}

const char* start_name(Start start) {
  switch (start) {
    case Start::kDenseSpread: return "dense_spread";
    case Start::kDenseSpreadRandom: return "dense_spread_random";
    case Start::kPlusPlus: return "kmeans++";
    case Start::kSwaps: return "swaps";
  }
  return "";
}

void write_groups(const PlaceReport& place, Json& json) {
  json.key("groups");
  if (place.group_count == 0) return json.null();
  json.begin_object();
  json.key("counts");
  json.begin_array();
  for (uint32_t g = 0; g < place.group_count; ++g) json.value(place.group_sizes[g]);
  json.end_array();
  json.key("borders");
  json.begin_array();
  for (uint32_t g = 0; g < place.border_count; ++g) json.rounded(place.borders[g]);
  json.end_array();
  json.key("depths");
  json.begin_array();
  for (uint32_t g = 0; g < place.group_count; ++g) {
    json.begin_array();
    json.rounded(place.group_depths[g].front);
    json.rounded(place.group_depths[g].back);
    json.end_array();
  }
  json.end_array();
  json.key("merge_distances");
  json.begin_array();
  for (const Merge& merge : place.linkage.merges) json.rounded(merge.distance);
  json.end_array();
  json.end_object();
}

void write_throat(const PlaceReport& place, Json& json) {
  const Throat& throat = place.throat;
  json.key("throat");
  if (throat.found) {
    json.begin_object();
    write_number(json, "y", throat.y);
    write_number(json, "z", throat.z);
    write_number(json, "depth", throat.depth);
    write_number(json, "depth_of_height", throat.depth / throat.height);
    write_numbers(json, "nose", throat.nose_y, throat.nose_z);
    json.end_object();
  } else {
    json.null();
  }
  write_number(json, "notch_of_height", throat.height > 0 ? throat.depth / throat.height : 0);
}

void write_landmarks(const Rigging& rigging, Json& json) {
  json.key("landmarks");
  json.begin_object(Layout::kLines);
  for (uint32_t k = 0; k < kLandmarkCount; ++k) {
    const Landmark& mark = rigging.place.landmarks.of[k];
    json.key(kLandmarkNames[k]);
    if (!mark.known) {
      json.null();
      continue;
    }
    json.begin_object();
    write_point(json, "position", rigging.read.mesh.frame.to_file(mark.at));
    write_number(json, "confidence", mark.confidence);
    json.member("given", mark.given);
    json.member("used", mark.is_used);
    json.end_object();
  }
  json.end_object();
}

void write_objective(const PlaceReport& place, Json& json) {
  json.key("objective");
  json.begin_object();
  write_number(json, "chosen", place.runs[place.chosen_run].objective);
  json.member("chosen_run", place.chosen_run);
  json.key("runs");
  json.begin_array();
  for (uint32_t r = 0; r < place.run_count; ++r) json.rounded(place.runs[r].objective);
  json.end_array();
  json.key("starts");
  json.begin_array();
  for (uint32_t r = 0; r < place.run_count; ++r) json.value(start_name(place.runs[r].start));
  json.end_array();
  json.key("rounds");
  json.begin_array();
  for (uint32_t r = 0; r < place.run_count; ++r) json.value(place.runs[r].rounds);
  json.end_array();
  json.end_object();
}

void write_bones(const Rigging& rigging, Json& json) {
  json.member("joints", rigging.placement.bones.count);
  json.member("facial_joints", rigging.placement.facial_count);
  json.key("bones");
  json.begin_array(Layout::kLines);
  for (const Bone& bone : rigging.placement.bones) {
    json.begin_object();
    json.member("name", view(bone.name));
    json.member("kind", kind_name(bone.kind));
    json.member("parent", bone.parent);
    json.member("mirror", bone.mirror);
    if (bone.kind == BoneKind::kFacial) json.member("rank", bone.rank);
    write_point(json, "position", rigging.read.mesh.frame.to_file(bone.position));
    json.end_object();
  }
  json.end_array();
}

void write_weights(const char* key, const WeightReport& weights, Json& json) {
  json.key(key);
  json.begin_object();
  json.member("influences", weights.max_influences);
  write_number(json, "worst_sum", weights.worst_sum);
  write_number(json, "least", weights.least);
  json.member("split_supports", weights.split_supports);
  write_number(json, "roughness", weights.roughness);
  json.member("idle_bones", weights.idle_bones);
  json.member("rigid_components", weights.rigid_components);
  json.member("following_components", weights.following_components);
  json.end_object();
}

void write_gaze(const Rigging& rigging, Json& json) {
  constexpr const char* kWays[kGazeWays] = {"left", "right", "up", "down"};
  constexpr const char* kSources[] = {"none", "shape", "completed", "added"};
  json.key("gaze");
  json.begin_array(Layout::kLines);
  for (const GazeEye& eye : rigging.gaze.eyes) {
    if (eye.bone == kNone) continue;
    json.begin_object();
    json.member("joint", view(rigging.placement.bones[eye.bone].name));
    for (uint32_t way = 0; way < kGazeWays; ++way) json.member(kWays[way], view(eye.controls[way]));
    json.key("sources");
    json.begin_object();
    for (uint32_t way = 0; way < kGazeWays; ++way) {
      json.member(kWays[way], kSources[static_cast<size_t>(eye.sources[way])]);
    }
    json.end_object();
    json.end_object();
  }
  json.end_array();
}

bool write_mask(const MeshSource& source, const Rigging& rigging, Arena& arena, Json& json) {
  Span<uint8_t> in;
  if (!make(arena, source.positions.count / 3, in)) return false;
  for (uint32_t v : rigging.placement.mask) in[rigging.read.source_vertices[v]] = 1;
  json.key("mask");
  json.begin_array(Layout::kRows);
  for (uint32_t v = 0; v < in.count; ++v) {
    if (in[v]) json.value(v);
  }
  json.end_array();
  return true;
}

void write_fit(const Rigging& rigging, Json& json) {
  const AuthorMesh& mesh = rigging.read.mesh;
  const RigReport& rig = rigging.rig;
  json.key("fit");
  if (mesh.shapes.empty()) {
    json.null();
  } else {
    json.begin_object(Layout::kLines);
    write_number(json, "error", rig.rig.error);
    write_number(json, "joints_error", rig.joints.error);
    write_number(json, "translations_error", rig.translations.error);
    write_number(json, "rotations_error", rig.rotations.error);
    write_number(json, "median", rig.rig.median);
    write_number(json, "worst", rig.rig.worst);
    write_number(json, "rms", rig.rig.rms * mesh.diagonal);
    write_number(json, "max", rig.rig.max * mesh.diagonal);
    write_number(json, "joints_rms", rig.joints.rms * mesh.diagonal);
    write_number(json, "joints_max", rig.joints.max * mesh.diagonal);
    for (const bool joints : {false, true}) {
      const FitError& fit = joints ? rig.joints : rig.rig;
      json.key(joints ? "joints_per_shape" : "per_shape");
      json.begin_object();
      // Raw controls are the expressions, without shapes that combine others.
      const dna::List<dna::String> names = rigging.dna.defn.raw_control_names;
      for (uint32_t s = 0; s < fit.shapes.count && s < names.count; ++s) {
        write_number(json, {names[s].chars(), names[s].count}, fit.shapes[s].error);
      }
      json.end_object();
    }
    json.member("correctives", rig.correctives.given + rig.correctives.made);
    json.member("targets", rig.target_count);
    write_number(json, "target_threshold", rig.target_threshold);
    json.member("target_vertices", rig.target_vertices);
    write_number(json, "target_share", rig.target_share);
    json.end_object();
  }
  if (!mesh.shapes.empty()) {
    const GroupReport& groups = rig.groups;
    json.key("joint_groups");
    json.begin_object();
    json.member("groups", groups.groups);
    json.member("nonzeros", groups.nonzeros);
    json.member("stored", groups.stored);
    json.member("full", groups.full);
    write_number(json, "density",
                 static_cast<double>(groups.nonzeros) /
                     static_cast<double>(std::max<uint64_t>(groups.stored, 1)));
    json.member("outliers", groups.pruned.outliers);
    json.member("faint", groups.pruned.faint);
    json.key("padding");
    json.begin_array();
    for (const double padding : groups.padding) json.rounded(padding);
    json.end_array();
    write_number(json, "error_before", groups.before.error);
    write_number(json, "error_removed", groups.removed.error);
    write_number(json, "error_refitted", groups.refitted.error);
    constexpr double kHead = 300;  // millimeters from corner to corner
    json.key("rms_on_30_cm_mm");
    json.begin_array();
    for (const FitError* error : {&groups.before, &groups.removed, &groups.refitted}) {
      json.rounded(error->rms * kHead);
    }
    json.end_array();
    json.end_object();
  }
  json.key("lods");
  json.begin_array(Layout::kLines);
  const Span<const uint32_t> counts = rigging.placement.lod_facial_counts;
  for (size_t lod = 0; lod < counts.count; ++lod) {
    json.begin_object();
    json.member("facial_joints", counts[lod]);
    json.member("joints",
                rigging.placement.bones.count - rigging.placement.facial_count + counts[lod]);
    if (lod < rigging.place.lod_objectives.count && rigging.place.run_count > 0) {
      write_number(json, "objective", rigging.place.lod_objectives[lod]);
    }
    const LodReport& report = rig.lods[lod];
    json.member("vertices", report.vertices);
    json.member("triangles", report.triangles);
    write_number(json, "surface_rms", report.surface_rms);
    write_number(json, "surface_max", report.surface_max);
    if (!mesh.shapes.empty()) {
      write_number(json, "error", report.error);
      write_number(json, "joints_error", report.joints_error);
      write_number(json, "collapsed_error", report.collapsed_error);
      write_number(json, "new_weights_error", report.new_error);
      json.member("channels", report.channels);
    }
    json.end_object();
  }
  json.end_array();
}

}  // namespace

bool write_report(const MeshSource& source, const RiggingOptions& options, const Rigging& rigging,
                  Arena& arena, Span<const char>& out) {
  const AuthorMesh& mesh = rigging.read.mesh;
  const PlaceReport& place = rigging.place;
  ArenaText text(arena);
  Json json(text);
  json.begin_object(Layout::kLines);
  json.key("mesh");
  json.begin_object();
  json.member("positions", source.positions.count / 3);
  json.member("loose_positions", rigging.read.loose_vertices);
  json.member("dropped_faces", rigging.read.dropped_faces);
  json.member("vertices", mesh.positions.count);
  json.member("objects", mesh.parts.count);
  json.member("components", mesh.component_count);
  json.member("shapes", mesh.shapes.count);
  write_number(json, "next_area", mesh.next_area);
  write_number(json, "diagonal", mesh.diagonal);
  json.end_object();
  json.member("seed", options.place.seed);
  json.member("paper", options.place.paper);
  json.member("own_bones", !options.bones.empty());
  json.member("own_lod_meshes", !options.lod_meshes.empty());
  json.member("own_weights", !options.weights.weights.empty());
  write_landmarks(rigging, json);
  write_objective(place, json);
  write_throat(place, json);
  write_groups(place, json);
  json.member("face_only", place.face_only);
  json.key("neck");
  json.begin_object();
  json.member("split", place.face_only ? "none" : split_name(place.neck_split));
  for (const bool head : {true, false}) {  // of groups; the front of a face has none
    const char* key = head ? "head_mean" : "neck_mean";
    if (place.face_only) {
      json.key(key);
      json.null();
    } else {
      write_point(json, key, mesh.frame.to_file(head ? place.head_mean : place.neck_mean));
    }
  }
  json.end_object();
  json.key("symmetry");
  json.begin_object();
  json.member("enforced", rigging.placement.symmetric && !place.paired);
  json.member("paired", rigging.placement.symmetric);
  write_number(json, "error", place.symmetry_error);
  write_number(json, "plane", rigging.placement.symmetry_plane);
  json.end_object();
  json.member("mask_positions", place.mask_positions);
  json.member("mask_added_by_shapes", place.added_by_shapes);
  write_number(json, "spacing", place.spacing);
  write_number(json, "uncovered", place.uncovered);
  json.key("jaw");
  if (place.jaw_joint) {
    json.begin_object();
    json.member("shape", view(place.jaw_shape));
    json.member("added", !rigging.placement.jaw_share.empty());
    write_number(json, "degrees", place.jaw_angle);
    json.end_object();
  } else {
    json.null();
  }
  json.member("eyes", place.eye_joints);
  write_gaze(rigging, json);
  write_weights("weights", rigging.made_weights, json);
  if (!mesh.shapes.empty()) write_weights("fitted_weights", rigging.fitted_weights, json);
  write_fit(rigging, json);
  write_bones(rigging, json);
  if (!write_mask(source, rigging, arena, json)) return false;
  json.end_object();
  text.append("\n");
  out = text.result();
  return !text.failed();
}

}  // namespace mien::author
