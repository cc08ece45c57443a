// SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>

#include "author/base/dna_making.h"
#include "author/rigging/rigging.h"

namespace mien::author {

namespace {

/// JSON text that grows in an arena. It no longer changes after memory ran out.
class Json {
 public:
  explicit Json(Arena& arena) : arena_(&arena) {}

  void text(const char* chars, size_t count) {
    if (count > room_.count - used_ && !grow(count)) return;
    memcpy(room_.data + used_, chars, count);
    used_ += count;
  }
  void raw(const char* terminated) { text(terminated, strlen(terminated)); }

  Json& key(const char* name) {
    separate();
    raw("\"");
    raw(name);
    raw("\":");
    first_ = true;  // the value needs no comma
    return *this;
  }
  void key(Name name) {
    string(name);
    raw(":");
    first_ = true;
  }
  void open(const char* bracket) {
    separate();
    raw(bracket);
    first_ = true;
  }
  void close(const char* bracket) {
    raw(bracket);
    first_ = false;
  }
  void number(double value) {
    separate();
    char digits[40];
#if defined(__EMSCRIPTEN__)  // its library has no std::to_chars() of floats, and one locale only
    text(digits, static_cast<size_t>(snprintf(digits, sizeof(digits), "%.9g", value)));
#else
    const auto end =
        std::to_chars(digits, digits + sizeof(digits), value, std::chars_format::general, 9).ptr;
    text(digits, static_cast<size_t>(end - digits));
#endif
  }
  void whole(uint64_t value) {
    separate();
    char digits[24];
    const auto end = std::to_chars(digits, digits + sizeof(digits), value).ptr;
    text(digits, static_cast<size_t>(end - digits));
  }
  void word(const char* value) {  // true, false, null
    separate();
    raw(value);
  }
  void boolean(bool value) { word(value ? "true" : "false"); }
  /// Bytes that are not valid UTF-8 are escaped one by one.
  void string(Name name) {
    separate();
    raw("\"");
    for (size_t i = 0; i < name.count;) {
      const size_t length = utf8_length(name, i);
      const uint8_t byte = static_cast<uint8_t>(name[i]);
      if (length == 1 && (byte == '"' || byte == '\\')) {
        raw("\\");
        text(name.data + i, 1);
      } else if (length == 0 || byte < 0x20 || byte == 0x7F) {
        raw("\\u00");
        constexpr char kDigits[] = "0123456789abcdef";
        text(kDigits + (byte >> 4), 1);
        text(kDigits + (byte & 15), 1);
      } else {
        text(name.data + i, length);
      }
      i += length ? length : 1;
    }
    raw("\"");
  }
  void string(const char* terminated) { string(Name{terminated, strlen(terminated)}); }
  void point(Vec3 p) {
    open("[");
    number(p.x);
    number(p.y);
    number(p.z);
    close("]");
  }

  bool failed() const { return failed_; }
  Span<const char> result() const { return {room_.data, used_}; }

 private:
  void separate() {
    if (!first_) raw(",");
    first_ = false;
  }
  static size_t utf8_length(Name text, size_t at) {
    const uint8_t lead = static_cast<uint8_t>(text[at]);
    const size_t length = lead < 0x80       ? 1
                          : lead >> 5 == 6  ? 2
                          : lead >> 4 == 14 ? 3
                          : lead >> 3 == 30 ? 4
                                            : 0;
    if (length == 0 || length > text.count - at) return 0;
    uint32_t code = length == 1 ? lead : lead & (0x7Fu >> length);
    for (size_t i = 1; i < length; ++i) {
      const uint8_t next = static_cast<uint8_t>(text[at + i]);
      if (next >> 6 != 2) return 0;
      code = code << 6 | (next & 0x3Fu);
    }
    constexpr uint32_t kSmallest[] = {0, 0, 0x80, 0x800, 0x10000};
    return code >= kSmallest[length] && code <= 0x10FFFF && code >> 11 != 27 ? length : 0;
  }
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
  bool first_ = true, failed_ = false;
};

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
  if (place.group_count == 0) return json.word("null");
  json.open("{");
  json.key("counts").open("[");
  for (uint32_t g = 0; g < place.group_count; ++g) json.whole(place.group_sizes[g]);
  json.close("]");
  json.key("borders").open("[");
  for (uint32_t g = 0; g < place.border_count; ++g) json.number(place.borders[g]);
  json.close("]");
  json.key("depths").open("[");
  for (uint32_t g = 0; g < place.group_count; ++g) {
    json.open("[");
    json.number(place.group_depths[g].front);
    json.number(place.group_depths[g].back);
    json.close("]");
  }
  json.close("]");
  json.key("merge_distances").open("[");
  for (const Merge& merge : place.linkage.merges) json.number(merge.distance);
  json.close("]");
  json.close("}");
}

void write_throat(const PlaceReport& place, Json& json) {
  const Throat& throat = place.throat;
  json.key("throat");
  if (throat.found) {
    json.open("{");
    json.key("y").number(throat.y);
    json.key("z").number(throat.z);
    json.key("depth").number(throat.depth);
    json.key("depth_of_height").number(throat.depth / throat.height);
    json.key("nose").open("[");
    json.number(throat.nose_y);
    json.number(throat.nose_z);
    json.close("]");
    json.close("}");
  } else {
    json.word("null");
  }
  json.key("notch_of_height").number(throat.height > 0 ? throat.depth / throat.height : 0);
}

void write_landmarks(const Rigging& rigging, Json& json) {
  json.key("landmarks").open("{");
  for (uint32_t k = 0; k < kLandmarkCount; ++k) {
    const Landmark& mark = rigging.place.landmarks.of[k];
    json.key(kLandmarkNames[k]);
    if (!mark.known) {
      json.word("null");
      continue;
    }
    json.open("{");
    json.key("position").point(rigging.read.mesh.frame.to_file(mark.at));
    json.key("confidence").number(mark.confidence);
    json.key("given").boolean(mark.given);
    json.key("used").boolean(mark.is_used);
    json.close("}");
  }
  json.close("}");
}

void write_objective(const PlaceReport& place, Json& json) {
  json.key("objective").open("{");
  json.key("chosen").number(place.runs[place.chosen_run].objective);
  json.key("chosen_run").whole(place.chosen_run);
  json.key("runs").open("[");
  for (uint32_t r = 0; r < place.run_count; ++r) json.number(place.runs[r].objective);
  json.close("]");
  json.key("starts").open("[");
  for (uint32_t r = 0; r < place.run_count; ++r) json.string(start_name(place.runs[r].start));
  json.close("]");
  json.key("rounds").open("[");
  for (uint32_t r = 0; r < place.run_count; ++r) json.whole(place.runs[r].rounds);
  json.close("]");
  json.close("}");
}

void write_bones(const Rigging& rigging, Json& json) {
  json.key("joints").whole(rigging.placement.bones.count);
  json.key("facial_joints").whole(rigging.placement.facial_count);
  json.key("bones").open("[");
  for (const Bone& bone : rigging.placement.bones) {
    json.open("{");
    json.key("name").string(bone.name);
    json.key("kind").string(kind_name(bone.kind));
    json.key("parent").whole(bone.parent);
    json.key("mirror").whole(bone.mirror);
    if (bone.kind == BoneKind::kFacial) json.key("rank").whole(bone.rank);
    json.key("position").point(rigging.read.mesh.frame.to_file(bone.position));
    json.close("}");
  }
  json.close("]");
}

void write_weights(const char* key, const WeightReport& weights, Json& json) {
  json.key(key).open("{");
  json.key("influences").whole(weights.max_influences);
  json.key("worst_sum").number(weights.worst_sum);
  json.key("least").number(weights.least);
  json.key("split_supports").whole(weights.split_supports);
  json.key("roughness").number(weights.roughness);
  json.key("idle_bones").whole(weights.idle_bones);
  json.key("rigid_components").whole(weights.rigid_components);
  json.key("following_components").whole(weights.following_components);
  json.close("}");
}

void write_gaze(const Rigging& rigging, Json& json) {
  constexpr const char* kWays[kGazeWays] = {"left", "right", "up", "down"};
  constexpr const char* kSources[] = {"none", "shape", "completed", "added"};
  json.key("gaze").open("[");
  for (const GazeEye& eye : rigging.gaze.eyes) {
    if (eye.bone == kNone) continue;
    json.open("{");
    json.key("joint").string(rigging.placement.bones[eye.bone].name);
    for (uint32_t way = 0; way < kGazeWays; ++way) json.key(kWays[way]).string(eye.controls[way]);
    json.key("sources").open("{");
    for (uint32_t way = 0; way < kGazeWays; ++way) {
      json.key(kWays[way]).string(kSources[static_cast<size_t>(eye.sources[way])]);
    }
    json.close("}");
    json.close("}");
  }
  json.close("]");
}

bool write_mask(const MeshSource& source, const Rigging& rigging, Arena& arena, Json& json) {
  Span<uint8_t> in;
  if (!make(arena, source.positions.count / 3, in)) return false;
  for (uint32_t v : rigging.placement.mask) in[rigging.read.source_vertices[v]] = 1;
  json.key("mask").open("[");
  for (uint32_t v = 0; v < in.count; ++v) {
    if (in[v]) json.whole(v);
  }
  json.close("]");
  return true;
}

void write_fit(const Rigging& rigging, Json& json) {
  const AuthorMesh& mesh = rigging.read.mesh;
  const RigReport& rig = rigging.rig;
  json.key("fit");
  if (mesh.shapes.empty()) {
    json.word("null");
  } else {
    json.open("{");
    json.key("error").number(rig.rig.error);
    json.key("joints_error").number(rig.joints.error);
    json.key("translations_error").number(rig.translations.error);
    json.key("rotations_error").number(rig.rotations.error);
    json.key("median").number(rig.rig.median);
    json.key("worst").number(rig.rig.worst);
    json.key("rms").number(rig.rig.rms * mesh.diagonal);
    json.key("max").number(rig.rig.max * mesh.diagonal);
    json.key("joints_rms").number(rig.joints.rms * mesh.diagonal);
    json.key("joints_max").number(rig.joints.max * mesh.diagonal);
    for (const bool joints : {false, true}) {
      const FitError& fit = joints ? rig.joints : rig.rig;
      json.key(joints ? "joints_per_shape" : "per_shape").open("{");
      // Raw controls are the expressions, without shapes that combine others.
      const dna::List<dna::String> names = rigging.dna.defn.raw_control_names;
      for (uint32_t s = 0; s < fit.shapes.count && s < names.count; ++s) {
        json.key(Name{names[s].chars(), names[s].count});
        json.number(fit.shapes[s].error);
      }
      json.close("}");
    }
    json.key("correctives").whole(rig.correctives.given + rig.correctives.made);
    json.key("targets").whole(rig.target_count);
    json.key("target_threshold").number(rig.target_threshold);
    json.key("target_vertices").whole(rig.target_vertices);
    json.key("target_share").number(rig.target_share);
    json.close("}");
  }
  if (!mesh.shapes.empty()) {
    const GroupReport& groups = rig.groups;
    json.key("joint_groups").open("{");
    json.key("groups").whole(groups.groups);
    json.key("nonzeros").whole(groups.nonzeros);
    json.key("stored").whole(groups.stored);
    json.key("full").whole(groups.full);
    json.key("density").number(static_cast<double>(groups.nonzeros) /
                               static_cast<double>(std::max<uint64_t>(groups.stored, 1)));
    json.key("outliers").whole(groups.pruned.outliers);
    json.key("faint").whole(groups.pruned.faint);
    json.key("padding").open("[");
    for (const double padding : groups.padding) json.number(padding);
    json.close("]");
    json.key("error_before").number(groups.before.error);
    json.key("error_removed").number(groups.removed.error);
    json.key("error_refitted").number(groups.refitted.error);
    constexpr double kHead = 300;  // millimeters from corner to corner
    json.key("rms_on_30_cm_mm").open("[");
    for (const FitError* error : {&groups.before, &groups.removed, &groups.refitted}) {
      json.number(error->rms * kHead);
    }
    json.close("]");
    json.close("}");
  }
  json.key("lods").open("[");
  const Span<const uint32_t> counts = rigging.placement.lod_facial_counts;
  for (size_t lod = 0; lod < counts.count; ++lod) {
    json.open("{");
    json.key("facial_joints").whole(counts[lod]);
    json.key("joints").whole(rigging.placement.bones.count - rigging.placement.facial_count +
                             counts[lod]);
    if (lod < rigging.place.lod_objectives.count && rigging.place.run_count > 0) {
      json.key("objective").number(rigging.place.lod_objectives[lod]);
    }
    const LodReport& report = rig.lods[lod];
    json.key("vertices").whole(report.vertices);
    json.key("triangles").whole(report.triangles);
    json.key("surface_rms").number(report.surface_rms);
    json.key("surface_max").number(report.surface_max);
    if (!mesh.shapes.empty()) {
      json.key("error").number(report.error);
      json.key("joints_error").number(report.joints_error);
      json.key("collapsed_error").number(report.collapsed_error);
      json.key("new_weights_error").number(report.new_error);
      json.key("channels").whole(report.channels);
    }
    json.close("}");
  }
  json.close("]");
}

}  // namespace

bool write_report(const MeshSource& source, const RiggingOptions& options, const Rigging& rigging,
                  Arena& arena, Span<const char>& out) {
  const AuthorMesh& mesh = rigging.read.mesh;
  const PlaceReport& place = rigging.place;
  Json json(arena);
  json.open("{");
  json.key("mesh").open("{");
  json.key("positions").whole(source.positions.count / 3);
  json.key("loose_positions").whole(rigging.read.loose_vertices);
  json.key("dropped_faces").whole(rigging.read.dropped_faces);
  json.key("vertices").whole(mesh.positions.count);
  json.key("objects").whole(mesh.parts.count);
  json.key("components").whole(mesh.component_count);
  json.key("shapes").whole(mesh.shapes.count);
  json.key("next_area").number(mesh.next_area);
  json.key("diagonal").number(mesh.diagonal);
  json.close("}");
  json.key("seed").whole(options.place.seed);
  json.key("paper").boolean(options.place.paper);
  json.key("own_bones").boolean(!options.bones.empty());
  json.key("own_lod_meshes").boolean(!options.lod_meshes.empty());
  json.key("own_weights").boolean(!options.weights.weights.empty());
  write_landmarks(rigging, json);
  write_objective(place, json);
  write_throat(place, json);
  write_groups(place, json);
  json.key("face_only").boolean(place.face_only);
  json.key("neck").open("{");
  json.key("split").string(place.face_only ? "none" : split_name(place.neck_split));
  for (const bool head : {true, false}) {  // of groups; the front of a face has none
    json.key(head ? "head_mean" : "neck_mean");
    if (place.face_only) {
      json.word("null");
    } else {
      json.point(mesh.frame.to_file(head ? place.head_mean : place.neck_mean));
    }
  }
  json.close("}");
  json.key("symmetry").open("{");
  json.key("enforced").boolean(rigging.placement.symmetric && !place.paired);
  json.key("paired").boolean(rigging.placement.symmetric);
  json.key("error").number(place.symmetry_error);
  json.key("plane").number(rigging.placement.symmetry_plane);
  json.close("}");
  json.key("mask_positions").whole(place.mask_positions);
  json.key("mask_added_by_shapes").whole(place.added_by_shapes);
  json.key("spacing").number(place.spacing);
  json.key("uncovered").number(place.uncovered);
  json.key("jaw");
  if (place.jaw_joint) {
    json.open("{");
    json.key("shape").string(place.jaw_shape);
    json.key("added").boolean(!rigging.placement.jaw_share.empty());
    json.key("degrees").number(place.jaw_angle);
    json.close("}");
  } else {
    json.word("null");
  }
  json.key("eyes").whole(place.eye_joints);
  write_gaze(rigging, json);
  write_weights("weights", rigging.made_weights, json);
  if (!mesh.shapes.empty()) write_weights("fitted_weights", rigging.fitted_weights, json);
  write_fit(rigging, json);
  write_bones(rigging, json);
  if (!write_mask(source, rigging, arena, json)) return false;
  json.close("}");
  json.raw("\n");
  out = json.result();
  return !json.failed();
}

}  // namespace mien::author
