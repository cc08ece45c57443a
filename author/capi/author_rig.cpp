// SPDX-License-Identifier: MIT
// Rigs from meshes. mien_author.h is the manual.
#include "author/capi/made_file.h"
#include "author/rigging/rigging.h"
#include "capi/arguments/arguments.h"
#include "runtime/base/object.h"

using namespace mien;
using namespace mien::capi;

static_assert(MIEN_ERROR_AUTHOR_MESH == int(Status::kAuthorMesh) &&
                  MIEN_ERROR_AUTHOR_REFUSED == int(Status::kAuthorRefused) &&
                  MIEN_ERROR_AUTHOR_CANCELED == int(Status::kAuthorCanceled),
              "status.h and mien.h number the same statuses");
static_assert(MIEN_BONE_TONGUE == int(author::BoneKind::kTongue) &&
                  MIEN_SYMMETRY_OFF == int(author::Symmetry::kOff),
              "the enums agree");

struct MienAuthorReport : Object {
  static constexpr uint32_t kTag = 0x6D41'5250;

  Span<const char> text;
};

namespace {

constexpr uint32_t kMaxFacialJoints = 7000;

author::Name name_of(MienStringView view) { return {view.data, view.data ? view.count : 0}; }

/// An array of the caller: a count without a pointer is an error.
template <class T>
bool is_there(const T* data, size_t count) {
  return data != nullptr || count == 0;
}

/// Axis 0 to 2, and sign, of a direction.
struct Direction {
  uint8_t axis;
  int8_t sign;
};
Direction direction_of(uint32_t value, uint32_t otherwise) {
  if (value == MIEN_MESH_AXIS_DEFAULT) value = otherwise;
  const bool minus = value >= MIEN_MESH_AXIS_MINUS_X;
  return {static_cast<uint8_t>(value - (minus ? MIEN_MESH_AXIS_MINUS_X : MIEN_MESH_AXIS_X)),
          static_cast<int8_t>(minus ? -1 : 1)};
}

/// The third axis of a right-handed frame: up x front points to the character's left.
author::Frame frame_of(Direction up, Direction front) {
  author::Frame frame;
  const uint8_t left = static_cast<uint8_t>(3 - up.axis - front.axis);
  const bool even = (up.axis + 1) % 3 == front.axis;
  frame.axis[0] = left;
  frame.axis[1] = up.axis;
  frame.axis[2] = front.axis;
  frame.sign[0] = static_cast<int8_t>(up.sign * front.sign * (even ? 1 : -1));
  frame.sign[1] = up.sign;
  frame.sign[2] = front.sign;
  return frame;
}

MienStatus check_mesh(const MienAuthorMesh& mesh, MienError* error) {
  const struct {
    bool there;
    const char* name;
  } arrays[] = {
      {is_there(mesh.positions, mesh.position_count), "positions"},
      {is_there(mesh.corners, mesh.corner_count), "corners"},
      {is_there(mesh.uvs, mesh.uv_count), "uvs"},
      {is_there(mesh.objects, mesh.object_count), "objects"},
      {is_there(mesh.shapes, mesh.shape_count), "shapes"},
  };
  for (const auto& array : arrays) {
    if (array.there) continue;
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT,
                      "MienAuthorMesh.%s is NULL, but its count is not 0", array.name);
  }
  const size_t most = UINT32_MAX;
  if (mesh.position_count > most || mesh.corner_count > most || mesh.face_count > most ||
      mesh.uv_count > most || mesh.object_count > most || mesh.shape_count > 65535) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienAuthorMesh has more elements than a file can hold");
  }
  if (!mesh.face_sizes && mesh.face_count != mesh.corner_count / 3) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienAuthorMesh.face_sizes is NULL: %zu triangles have %zu corners, not %zu",
                      mesh.face_count, 3 * mesh.face_count, mesh.corner_count);
  }
  for (size_t s = 0; s < mesh.shape_count; ++s) {
    const MienAuthorShape& shape = mesh.shapes[s];
    if (!is_there(shape.displacements, shape.position_count) ||
        (!shape.positions && shape.position_count != mesh.position_count)) {
      return give_error(
          error, MIEN_ERROR_INVALID_ARGUMENT,
          "shape %zu has %zu displacements: without positions, one for each of %zu is "
          "expected",
          s, shape.displacements ? shape.position_count : 0, mesh.position_count);
    }
  }
  return MIEN_OK;
}

size_t lod_count(const MienAuthorDesc& desc) {
  return desc.lods ? desc.lods : author::PlaceOptions().lods;
}

MienStatus check_options(const MienAuthorDesc& desc, MienError* error) {
  MienStatus status =
      check_fields({{"MienAuthorDesc.facial_joints", desc.facial_joints, kMaxFacialJoints},
                    {"MienAuthorDesc.influences", desc.influences, 12},
                    {"MienAuthorDesc.lods", desc.lods, 8},
                    {"MienAuthorDesc.groups", desc.groups, author::kMaxGroups},
                    {"MienAuthorDesc.up", desc.up, MIEN_MESH_AXIS_MINUS_Z},
                    {"MienAuthorDesc.front", desc.front, MIEN_MESH_AXIS_MINUS_Z},
                    {"MienAuthorDesc.symmetry", desc.symmetry, MIEN_SYMMETRY_OFF},
                    {"MienAuthorDesc.flags", desc.flags, 127},
                    {"MienAuthorDesc.joint_groups", desc.joint_groups, author::kMaxRegions}},
                   error);
  if (status != MIEN_OK) return status;
  if (desc.groups == 1) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienAuthorDesc.groups is 1: at least 2 are needed");
  }
  if (!(desc.unit >= 0 && desc.unit < 1e12)) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienAuthorDesc.unit is not a positive number of centimeters");
  }
  if (!(desc.lod_triangles >= 0 && desc.lod_triangles <= 1)) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienAuthorDesc.lod_triangles is %g: it is a share, at most 1",
                      desc.lod_triangles);
  }
  if (direction_of(desc.up, MIEN_MESH_AXIS_Y).axis ==
      direction_of(desc.front, MIEN_MESH_AXIS_Z).axis) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienAuthorDesc.up and .front are along the same axis");
  }
  if (!is_there(desc.bones, desc.bone_count) || !is_there(desc.name.data, desc.name.count) ||
      !is_there(desc.face_object.data, desc.face_object.count)) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT,
                      "bones or a name of MienAuthorDesc is NULL, but its count is not 0");
  }
  if (desc.name.count > 200) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT, "MienAuthorDesc.name has over 200 bytes");
  }
  for (size_t b = 0; b < desc.bone_count; ++b) {
    if (desc.bones[b].kind <= MIEN_BONE_TONGUE && desc.bones[b].name.data) continue;
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "bone %zu has no name, or a kind that is not a MIEN_BONE_...", b);
  }
  if ((desc.weights || desc.weight_joints) &&
      (!desc.weights || !desc.weight_joints || desc.bone_count == 0)) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienAuthorDesc.weights and .weight_joints go together, and with bones");
  }
  if ((desc.bone_groups || desc.bone_motions) && desc.bone_count == 0) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienAuthorDesc.bone_groups and .bone_motions go with bones");
  }
  const size_t lods = lod_count(desc);
  if (!is_there(desc.lod_meshes, desc.lod_mesh_count)) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT,
                      "MienAuthorDesc.lod_meshes is NULL, but its count is not 0");
  }
  if (desc.lod_meshes && desc.lod_mesh_count != lods - 1) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienAuthorDesc.lod_meshes has %zu meshes: %zu LODs need %zu",
                      desc.lod_mesh_count, lods, lods - 1);
  }
  if (!is_there(desc.landmarks, desc.landmark_count)) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT,
                      "MienAuthorDesc.landmarks is NULL, but its count is not 0");
  }
  if (desc.landmark_count > author::kLandmarkCount) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienAuthorDesc.landmarks has %zu landmarks: there are %u, each once",
                      desc.landmark_count, author::kLandmarkCount);
  }
  for (size_t l = 0; l < desc.lod_mesh_count; ++l) {
    if (is_there(desc.lod_meshes[l].corners, desc.lod_meshes[l].corner_count)) continue;
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT,
                      "MienAuthorLod.corners of LOD %zu is NULL, but its count is not 0", l + 1);
  }
  for (size_t lod = 0; desc.lod_joints && lod < lods; ++lod) {
    if (desc.lod_joints[lod] > 0 &&
        (lod == 0 || desc.lod_joints[lod] <= desc.lod_joints[lod - 1])) {
      continue;
    }
    return give_error(
        error, MIEN_ERROR_INVALID_ARGUMENT,
        "MienAuthorDesc.lod_joints is %u for LOD %zu: each LOD has joints, and no more "
        "than the one before it",
        desc.lod_joints[lod], lod);
  }
  if (desc.parallel && !desc.parallel->run) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT, "MienParallelFor.run is NULL");
  }
  return MIEN_OK;
}

/// The caller's structs converted to those of the library, in its memory.
struct Input {
  author::MeshSource source;
  author::RiggingOptions options;
};

template <class T>
bool make(Arena& arena, size_t count, Span<T>& out) {
  out = arena.array<T>(count);
  return out.count == count;
}

bool read_input(const MienAuthorMesh& mesh, const MienAuthorDesc& desc, Arena& arena, Input& out) {
  author::MeshSource& source = out.source;
  source.positions = {mesh.positions, 3 * mesh.position_count};
  source.corners = {mesh.corners, mesh.corner_count};
  if (mesh.face_sizes) {
    source.face_sizes = {mesh.face_sizes, mesh.face_count};
  } else {
    Span<uint32_t> threes;
    if (!make(arena, mesh.face_count, threes)) return false;
    for (uint32_t& size : threes) size = 3;
    source.face_sizes = threes;
  }
  if (mesh.corner_uvs) {
    source.uvs = {mesh.uvs, 2 * mesh.uv_count};
    source.corner_uvs = {mesh.corner_uvs, mesh.corner_count};
  }
  Span<author::ObjectSource> objects;
  Span<author::ShapeSource> shapes;
  Span<author::OwnBone> bones;
  Span<author::LodSource> lod_meshes;
  Span<author::OwnLandmark> landmarks;
  if (!make(arena, mesh.object_count, objects) || !make(arena, mesh.shape_count, shapes) ||
      !make(arena, desc.bone_count, bones) || !make(arena, desc.lod_mesh_count, lod_meshes) ||
      !make(arena, desc.landmark_count, landmarks)) {
    return false;
  }
  for (size_t o = 0; o < objects.count; ++o) {
    objects[o] = {name_of(mesh.objects[o].name), mesh.objects[o].first_face,
                  mesh.objects[o].face_count};
  }
  for (size_t s = 0; s < shapes.count; ++s) {
    const MienAuthorShape& shape = mesh.shapes[s];
    shapes[s].name = name_of(shape.name);
    if (shape.positions) shapes[s].vertices = {shape.positions, shape.position_count};
    // An empty list of positions moves nothing, while the library would take it for all.
    if (shape.position_count > 0) {
      shapes[s].displacements = {shape.displacements, 3 * shape.position_count};
    }
  }
  for (size_t b = 0; b < bones.count; ++b) {
    const MienAuthorBone& bone = desc.bones[b];
    bones[b] = {name_of(bone.name),
                {bone.position[0], bone.position[1], bone.position[2]},
                bone.parent,
                static_cast<author::BoneKind>(bone.kind)};
  }
  for (size_t l = 0; l < landmarks.count; ++l) {
    const MienAuthorLandmark& mark = desc.landmarks[l];
    landmarks[l] = {name_of(mark.name), {mark.position[0], mark.position[1], mark.position[2]}};
  }
  for (size_t l = 0; l < lod_meshes.count; ++l) {
    const MienAuthorLod& lod = desc.lod_meshes[l];
    lod_meshes[l].corners = {lod.corners, lod.corner_count};
    if (lod.corner_uvs) lod_meshes[l].corner_uvs = {lod.corner_uvs, lod.corner_count};
  }
  source.objects = objects;
  source.shapes = shapes;
  source.skin_object = name_of(desc.face_object);
  source.unit = desc.unit > 0 ? desc.unit : 1;
  source.frame =
      frame_of(direction_of(desc.up, MIEN_MESH_AXIS_Y), direction_of(desc.front, MIEN_MESH_AXIS_Z));

  author::RiggingOptions& options = out.options;
  author::PlaceOptions& place = options.place;
  if (desc.facial_joints) place.facial_joints = desc.facial_joints;
  if (desc.lods) place.lods = desc.lods;
  if (desc.groups) place.groups = desc.groups;
  if (desc.influences) options.influences = desc.influences;
  place.seed = desc.seed;
  place.symmetry = static_cast<author::Symmetry>(desc.symmetry);
  place.paper = (desc.flags & MIEN_AUTHOR_PAPER) != 0;
  place.neck_cut = (desc.flags & MIEN_AUTHOR_NO_NECK_CUT) == 0;
  place.mask_from_shapes = (desc.flags & MIEN_AUTHOR_MASK_FROM_SHAPES) != 0;
  place.area_density = (desc.flags & MIEN_AUTHOR_AREA_DENSITY) != 0;
  place.group_in_space = (desc.flags & MIEN_AUTHOR_GROUP_IN_SPACE) != 0;
  options.residual_targets = (desc.flags & MIEN_AUTHOR_NO_TARGETS) == 0;
  options.metahuman_names = (desc.flags & MIEN_AUTHOR_METAHUMAN_NAMES) != 0;
  if (desc.name.count) options.name = name_of(desc.name);
  options.landmarks = landmarks;
  options.bones = bones;
  options.lod_meshes = lod_meshes;
  if (desc.weights) {
    const size_t count = mesh.position_count * options.influences;
    options.weights = {{desc.weight_joints, count}, {desc.weights, count}};
  }
  if (desc.depth_groups) options.depth_groups = {desc.depth_groups, mesh.position_count};
  if (desc.mask) options.mask = {desc.mask, mesh.position_count};
  if (desc.lod_joints) place.lod_joints = {desc.lod_joints, place.lods};
  if (desc.bone_groups) options.bone_groups = {desc.bone_groups, desc.bone_count};
  if (desc.bone_motions) {
    options.bone_motions = {desc.bone_motions, 6 * desc.bone_count * mesh.shape_count};
  }
  options.joint_groups = desc.joint_groups;
  options.overlap_correctives = desc.overlap_correctives;
  if (desc.lod_triangles > 0) options.lod_triangles = desc.lod_triangles;
  return true;
}

bool go_on(void* user, const char* step, double share) {
  const MienAuthorDesc& desc = *static_cast<const MienAuthorDesc*>(user);
  return !desc.progress || desc.progress(desc.progress_user, step, share) == 0;
}

/// MienParallelFor's function has another calling convention on some systems.
void run_parallel(void* user, uint32_t count, void (*task)(void*, uint32_t), void* context) {
  struct Task {
    void (*task)(void*, uint32_t);
    void* context;
  } one = {task, context};
  const MienTask call = [](void* given, uint32_t index) {
    const Task& inner = *static_cast<const Task*>(given);
    inner.task(inner.context, index);
  };
  const MienParallelFor& parallel = *static_cast<const MienParallelFor*>(user);
  parallel.run(parallel.user, count, call, &one);
}

MienStatus make_report(const Input& input, const author::Rigging& rigging, Arena& arena,
                       const Allocator& allocator, MienAuthorReport** out, MienError* error) {
  Span<const char> text;
  if (author::write_report(input.source, input.options, rigging, arena, text)) {
    *out =
        create_object<MienAuthorReport>(allocator, [&](Placer& placer, MienAuthorReport& report) {
          report.text = text;
          placer.keep(report.text);
        });
  }
  return *out ? MIEN_OK : give_error(error, MIEN_ERROR_MEMORY, "no memory for the report");
}

}  // namespace

MienStatus mien_author_rig(const MienAuthorMesh* mesh, const MienAuthorDesc* desc,
                           MienDna** out_dna, MienAuthorReport** out_report, MienError* error) {
  if (out_report) *out_report = nullptr;
  if (MienStatus status = clear_output(out_dna, error)) return status;
  MienAuthorMesh known_mesh;
  MienAuthorDesc known;
  if (!mesh) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "the mesh is NULL");
  if (MienStatus status = read_desc(mesh, known_mesh, "MienAuthorMesh", error)) return status;
  if (MienStatus status = read_desc(desc, known, "MienAuthorDesc", error)) return status;
  if (MienStatus status = check_mesh(known_mesh, error)) return status;
  if (MienStatus status = check_options(known, error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;

  Arena arena(allocator);
  Input input;
  if (!read_input(known_mesh, known, arena, input)) {
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for the mesh");
  }
  input.options.user = &known;
  input.options.go_on = go_on;
  MienParallelFor parallel = {};
  if (known.parallel) {
    parallel = *known.parallel;
    input.options.parallel = {&parallel, run_parallel};
  }
  author::Rigging rigging;
  Error failure;
  const Status status =
      author::make_rig(input.source, input.options, arena, allocator, rigging, failure);
  if (status != Status::kOk) return give_error(failure, error);
  if (dna::encoded_size(rigging.dna, {}) > UINT32_MAX) {
    return give_error(error, MIEN_ERROR_DNA_LIMIT, "the file would be larger than 4 GiB");
  }
  MienAuthorReport* report = nullptr;
  if (out_report) {
    const MienStatus made = make_report(input, rigging, arena, allocator, &report, error);
    if (made != MIEN_OK) return made;
  }
  MadeFile file(allocator);
  const MienStatus opened = encode_file(rigging.dna, file)
                                ? open_made(file, known.allocator, out_dna, error)
                                : give_error(error, MIEN_ERROR_MEMORY, "no memory for the file");
  if (opened != MIEN_OK) {
    mien_author_report_close(report);
  } else if (out_report) {
    *out_report = report;
  }
  return opened;
}

MienStatus mien_author_report_json(const MienAuthorReport* author_report,
                                   MienStringView* out_json) {
  if (!out_json) return MIEN_ERROR_NULL_ARGUMENT;
  *out_json = {};
  if (MienStatus status = check_tag(author_report, MienAuthorReport::kTag)) return status;
  *out_json = {author_report->text.data, author_report->text.count};
  return MIEN_OK;
}

void mien_author_report_close(MienAuthorReport* author_report) {
  if (check_tag(author_report, MienAuthorReport::kTag) != MIEN_OK) return;
  author_report->tag = 0;
  release(author_report);
}
