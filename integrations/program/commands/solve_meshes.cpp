// SPDX-License-Identifier: MIT
#include "integrations/program/commands/solve_meshes.h"

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "integrations/program/commands/moving_mesh.h"
#include "integrations/program/io/bound_clip.h"
#include "integrations/program/io/clip_file.h"
#include "integrations/program/io/controls.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/text.h"
#include "integrations/program/math/vector.h"
#include "integrations/program/mesh/mesh_file.h"

namespace mien::cli {

namespace {

using math::Vec3d;

// Meshes from files -------------------------------------------------------------------------------

/// The first position of the mesh in a file and how many it has: those that faces of objects of its name use,
/// or all of them if no object has the name.
std::pair<size_t, size_t> find_positions(const MeshFile& file, const std::string& name) {
  std::vector<size_t> first_corner = {0};
  for (const uint32_t size : file.face_sizes) first_corner.push_back(first_corner.back() + size);
  uint32_t low = UINT32_MAX, high = 0;
  for (const MeshObject& object : file.objects) {
    if (object.name != name) continue;
    for (size_t c = first_corner[object.first_face];
         c < first_corner[object.first_face + object.face_count]; ++c) {
      low = std::min(low, file.corners[c]);
      high = std::max(high, file.corners[c]);
    }
  }
  if (low > high) return {0, file.position_count()};
  return {low, size_t{high} - low + 1};
}

/// From the unit and axes of files to those of a rig.
struct FileSpace {
  RigSpace space;
  std::string unit;

  Vec3d place(const MeshFile& file, const Vec3d& point) const {
    if (!file.in_meters) return point * space.units_of(unit);
    return space.from_gltf(point) * (unit.empty() ? 1 : parse_unit(unit) / 100);
  }
};

/// From the positions of files to those of the mesh of a rig.
struct MeshReader {
  MienMesh mesh;
  std::string name;
  FileSpace space;

  MeshReader(const SolvedRig& solved, uint32_t index, const std::string& unit)
      : mesh(mesh_of(solved, index)), name(rig_name(solved.rig, MIEN_KIND_MESH, index)),
        space({RigSpace(solved), unit}) {}

  /// Files by vertices have several at one position, of which the last counts: all are the same.
  void place(const MeshFile& file, const std::string& path, const std::vector<Vec3d>& points,
             float* row) const {
    const auto [first, count] = find_positions(file, name);
    const bool by_vertex = count == mesh.vertex_count && count != mesh.position_count;
    if (!by_vertex && count != mesh.position_count) {
      fail(kInvalid, "cannot solve", path,
           "it has " + grouped(count) + " positions, mesh " + one_line(name) + " of the rig has " +
               grouped(mesh.position_count),
           "give the same topology, another mesh with --mesh, or --kind surface");
    }
    for (size_t i = 0; i < count; ++i) {
      const size_t to = by_vertex ? mesh.vertex_position_indices.data[i] : i;
      const Vec3d p = space.place(file, points[first + i]);
      for (int k = 0; k < 3; ++k) row[3 * to + static_cast<size_t>(k)] = static_cast<float>(p[k]);
    }
  }
};

std::vector<Vec3d> points_of(const MeshFile& file) {
  std::vector<Vec3d> points(file.position_count());
  for (size_t i = 0; i < points.size(); ++i) {
    points[i] = {file.positions[3 * i], file.positions[3 * i + 1], file.positions[3 * i + 2]};
  }
  return points;
}

std::vector<std::string> list_obj_files(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code reason;
  for (std::filesystem::directory_iterator it(folder, reason), end; !reason && it != end;
       it.increment(reason)) {
    const std::string file = it->path().string();
    if (ends_with(file, ".obj") || ends_with(file, ".OBJ")) files.push_back(file);
  }
  if (reason)
    fail(kFile, "cannot read", folder, reason.message(), "check the path and its permissions");
  if (files.empty()) {
    fail(kInvalid, "cannot solve", folder, "the folder has no .obj files",
         "name a folder with an OBJ for each frame");
  }
  // The order of a folder is that of the file system.
  std::sort(files.begin(), files.end());
  return files;
}

// Controls of another rig -------------------------------------------------------------------------

bool same_indices(const MienIndex32View& a, const MienIndex32View& b) {
  return a.count == b.count && std::equal(a.data, a.data + a.count, b.data);
}

bool same_topology(const MienMesh& a, const MienMesh& b) {
  return a.position_count == b.position_count && same_indices(a.triangles, b.triangles) &&
         same_indices(a.vertex_position_indices, b.vertex_position_indices);
}

/// The mesh of `other` with the topology of `mesh`: that of its name first.
uint32_t find_same_mesh(const SolvedRig& other, const SolvedRig& rig, uint32_t mesh) {
  const MienMesh own = mesh_of(rig, mesh);
  const std::string name = rig_name(rig.rig, MIEN_KIND_MESH, mesh);
  const uint32_t count = rig_count(other.rig, MIEN_KIND_MESH);
  uint32_t found = count;
  for (uint32_t m = 0; m < count; ++m) {
    if (!same_topology(own, mesh_of(other, m))) continue;
    if (rig_name(other.rig, MIEN_KIND_MESH, m) == name) return m;
    if (found == count) found = m;
  }
  if (found < count) return found;
  fail(kInvalid, "cannot solve", other.shown,
       "none of its meshes has the topology of mesh " + one_line(name) + " of " +
           one_line(rig.shown) + ", which has " + grouped(own.position_count) + " positions and " +
           grouped(own.triangle_count) + " triangles",
       "choose another mesh with --mesh, or give rigs of the same topology");
}

void require_same_space(const SolvedRig& rig, const SolvedRig& other) {
  const MienRigInfo a = rig_info(rig.rig), b = rig_info(other.rig);
  if (a.translation_unit == b.translation_unit && std::equal(a.axes, a.axes + 3, b.axes)) return;
  fail(kInvalid, "cannot solve", other.shown,
       "it has other axes or units than " + one_line(rig.shown),
       "convert one of them: mien convert IN -o OUT.dna --system NAME");
}

/// Frames of controls of a rig: JSON, or a clip whose channels are bound to the rig.
std::vector<Frame> read_controls(const std::string& path, const SolvedRig& other, Rate& rate,
                                 const Session& session) {
  std::vector<Frame> frames;
  if (!ends_with(path, ".clip")) {
    frames =
        parse_frames(read_json(path, "cannot read target"), other.rig, shown_name(path), &rate);
    if (!frames.empty()) return frames;
    fail(kInvalid, "cannot solve", shown_name(path), "it has no frames", "give one at least");
  }
  const ClipFile clip = open_clip_file(path);
  rate = {clip.info.rate_numerator, clip.info.rate_denominator};
  const ClipBinding binding =
      bind_clip(clip.clip.get(), other.rig, NamesFile(), "cannot bind clip", clip.shown, session);
  const MienClipBindingInfo info = binding_info(binding.get());
  if (info.missing_channels.count != 0) {
    note(session, one_line(other.shown) + " has no controls for " +
                      grouped(info.missing_channels.count) + " of " +
                      grouped(clip.info.channel_count) + " channels of the clip");
  }
  std::vector<float> raw(rig_count(other.rig, MIEN_KIND_RAW_CONTROL));
  for_each_frame(clip, [&](uint32_t, const float* values) {
    check(mien_clip_binding_apply(binding.get(), values, clip.info.channel_count, raw.data(),
                                  raw.size()),
          nullptr, "cannot bind clip", clip.shown);
    Frame frame;
    for (uint32_t i = 0; i < raw.size(); ++i) frame.raw.push_back({i, raw[i]});
    frames.push_back(std::move(frame));
  });
  return frames;
}

/// The meshes of frames: of each OBJ of a folder, or each morph target of a file.
struct MeshFrames {
  std::vector<std::string> files;  // of a folder
  MeshFile file;                   // else
  std::string shown;
  size_t count = 0;

  explicit MeshFrames(const std::string& path) : shown(shown_name(path)) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) {
      files = list_obj_files(path);
      count = files.size();
    } else {
      file = read_mesh_file(path);
      count = std::max(file.shapes.size(), size_t{1});
    }
  }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const MeshShape& shape : file.shapes) names.push_back(shape.name);
    return names;
  }
  /// Calls use(file, its name for messages, its positions in the frame).
  template <class F>
  auto at(size_t frame, F&& use) const {
    if (!files.empty()) {
      const std::string& path = files[frame];
      const MeshFile own = read_obj(read_mesh_bytes(path, "cannot read target"), path);
      return use(own, path, points_of(own));
    }
    std::vector<Vec3d> points = points_of(file);
    if (!file.shapes.empty()) {
      const MeshShape& shape = file.shapes[frame];
      for (size_t i = 0; i < shape.displacements.size() / 3; ++i) {
        const double* d = shape.displacements.data() + 3 * i;
        points[shape.vertices.empty() ? i : shape.vertices[i]] += Vec3d{d[0], d[1], d[2]};
      }
    }
    return use(file, shown, points);
  }
};

/// In the unit and axes of the rig, faces as fans of triangles.
SurfaceMesh surface_of(const MeshFile& file, const std::string& shown,
                       const std::vector<Vec3d>& points, const FileSpace& space) {
  SurfaceMesh surface;
  surface.shown = shown;
  for (const Vec3d& point : points) {
    const Vec3d p = space.place(file, point);
    for (int k = 0; k < 3; ++k) surface.positions.push_back(static_cast<float>(p[k]));
  }
  size_t first = 0;
  for (const uint32_t size : file.face_sizes) {
    for (uint32_t k = 2; k < size; ++k) {
      for (const uint32_t corner : {0u, k - 1, k})
        surface.triangles.push_back(file.corners[first + corner]);
    }
    first += size;
  }
  return surface;
}

}  // namespace

FitSurface create_surface(const SurfaceMesh& mesh) {
  auto desc = sized<MienFitSurfaceDesc>();
  desc.positions = mesh.positions.data();
  desc.position_count = mesh.positions.size() / 3;
  desc.triangles = mesh.triangles.data();
  desc.triangle_count = mesh.triangles.size() / 3;
  auto error = sized<MienError>();
  MienFitSurface* surface = nullptr;
  check(mien_fit_surface_create(&desc, &surface, &error), &error, "cannot solve", mesh.shown);
  return FitSurface(surface);
}

SolveTarget read_meshes(const TargetOptions& options, const SolvedRig& rig, uint32_t mesh) {
  SolveTarget target;
  auto reader = std::make_shared<MeshReader>(rig, mesh, options.unit);
  auto frames = std::make_shared<MeshFrames>(options.path);
  target.width = size_t{3} * reader->mesh.position_count;
  target.frame_names = frames->names();
  target.frame_count = frames->count;
  target.read = [reader, frames](size_t frame, float* row) {
    frames->at(frame,
               [&](const MeshFile& file, const std::string& path,
                   const std::vector<Vec3d>& points) { reader->place(file, path, points, row); });
  };
  return target;
}

SolveTarget read_surfaces(const TargetOptions& options, const SolvedRig& rig) {
  SolveTarget target;
  auto frames = std::make_shared<MeshFrames>(options.path);
  target.frame_names = frames->names();
  target.frame_count = frames->count;
  target.read_surface = [frames, space = FileSpace{RigSpace(rig), options.unit}](size_t frame) {
    return frames->at(frame, [&](const MeshFile& file, const std::string& path,
                                 const std::vector<Vec3d>& points) {
      return surface_of(file, path, points, space);
    });
  };
  target.read = [](size_t, float*) {};
  return target;
}

SolveTarget read_weights(const TargetOptions& options, const SolvedRig& rig, uint32_t mesh,
                         const Session& session) {
  struct Source {
    SolvedRig other;
    std::vector<Frame> frames;
    std::unique_ptr<MovingMesh> moving;
    std::vector<float> offset;  // from the rest of the other mesh to that of the rig
  };
  auto source = std::make_shared<Source>();
  source->other = open_solved_rig(options.from, true, session);
  require_same_space(rig, source->other);
  const uint32_t same = find_same_mesh(source->other, rig, mesh);
  SolveTarget target;
  source->frames = read_controls(options.path, source->other, target.rate, session);
  source->moving = std::make_unique<MovingMesh>(source->other, same);
  source->offset = MovingMesh(rig, mesh).rest();
  const std::vector<float> rest = source->moving->rest();
  for (size_t i = 0; i < rest.size(); ++i) source->offset[i] -= rest[i];
  target.frame_count = source->frames.size();
  target.width = rest.size();
  target.read = [source](size_t frame, float* row) {
    const float* moved = source->moving->positions(source->frames[frame]);
    for (size_t i = 0; i < source->offset.size(); ++i) row[i] = moved[i] + source->offset[i];
  };
  return target;
}

}  // namespace mien::cli
