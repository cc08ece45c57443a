// SPDX-License-Identifier: MIT
#include "author/mesh/mesh_input.h"

#include <algorithm>
#include <cstring>

#include "author/base/dna_making.h"
#include "author/mesh/topology.h"

namespace mien::author {

namespace {

// Counts in a DNA file have 32 bits, and each joint of a vertex takes nine numbers.
constexpr size_t kMaxVertices = size_t{1} << 26;
constexpr size_t kMaxName = 200;

Status no_memory(Error& error) {
  return fail(error, Status::kMemory, kNoOffset, "no memory for the mesh");
}

template <class... T>
Status bad(Error& error, const char* format, T... values) {
  return fail(error, Status::kAuthorMesh, kNoOffset, format, values...);
}

template <class... T>
Status refuse(Error& error, const char* format, T... values) {
  return fail(error, Status::kAuthorRefused, kNoOffset, format, values...);
}

Status check_name(Name name, const char* what, size_t number, Error& error) {
  if (name.count >= 1 && name.count <= kMaxName) return Status::kOk;
  return bad(error, "the name of %s %zu has %zu bytes: 1 to %zu are allowed", what, number,
             name.count, kMaxName);
}

bool same(Name a, Name b) { return a.count == b.count && memcmp(a.data, b.data, a.count) == 0; }

Status check_source(const MeshSource& source, Error& error) {
  const size_t n = source.positions.count / 3;
  if (n > kMaxVertices || source.corners.count > 4 * kMaxVertices) {
    return refuse(error,
                  "too large: %zu positions and %zu corners of faces; %zu and %zu are allowed", n,
                  source.corners.count, kMaxVertices, 4 * kMaxVertices);
  }
  for (size_t i = 0; i < source.positions.count; ++i) {
    if (!(std::abs(source.positions[i] * source.unit) < 1e15)) {
      return bad(error, "position %zu is not a finite number below 1e15 cm", i / 3);
    }
  }
  size_t corner = 0;
  for (size_t f = 0; f < source.face_sizes.count; ++f) {
    if (source.face_sizes[f] < 3) {
      return bad(error, "face %zu has %u corners: at least 3 are needed", f, source.face_sizes[f]);
    }
    if (source.face_sizes[f] > source.corners.count - corner) {
      return bad(error, "the corners of face %zu lie beyond the %zu that there are", f,
                 source.corners.count);
    }
    corner += source.face_sizes[f];
  }
  if (corner != source.corners.count) {
    return bad(error, "%zu faces have %zu corners, but %zu are given", source.face_sizes.count,
               corner, source.corners.count);
  }
  for (size_t c = 0; c < source.corners.count; ++c) {
    if (source.corners[c] < n) continue;
    return bad(error, "corner %zu names position %u, but there are %zu", c, source.corners[c], n);
  }
  if (!source.corner_uvs.empty()) {
    const size_t uvs = source.uvs.count / 2;
    if (source.corner_uvs.count != source.corners.count) {
      return bad(error, "%zu corners, but UVs for %zu", source.corners.count,
                 source.corner_uvs.count);
    }
    for (size_t c = 0; c < source.corners.count; ++c) {
      if (source.corner_uvs[c] >= uvs) {
        return bad(error, "corner %zu names UV %u, but there are %zu", c, source.corner_uvs[c],
                   uvs);
      }
    }
    for (size_t i = 0; i < source.uvs.count; ++i) {
      if (!(std::abs(source.uvs[i]) < 1e15))
        return bad(error, "UV %zu is not a finite number", i / 2);
    }
  }
  size_t face = 0;
  for (size_t o = 0; o < source.objects.count; ++o) {
    const ObjectSource& object = source.objects[o];
    if (Status status = check_name(object.name, "object", o, error); status != Status::kOk) {
      return status;
    }
    if (object.first_face != face || object.face_count > source.face_sizes.count - face) {
      return bad(error, "object %zu has faces %u to %u of %zu, but the one before it ends at %zu",
                 o, object.first_face, object.first_face + object.face_count,
                 source.face_sizes.count, face);
    }
    face += object.face_count;
  }
  if (!source.objects.empty() && face != source.face_sizes.count) {
    return bad(error, "%zu of %zu faces are in objects", face, source.face_sizes.count);
  }
  for (size_t s = 0; s < source.shapes.count; ++s) {
    const ShapeSource& shape = source.shapes[s];
    if (Status status = check_name(shape.name, "shape", s, error); status != Status::kOk) {
      return status;
    }
    for (size_t other = 0; other < s; ++other) {
      if (!same(shape.name, source.shapes[other].name)) continue;
      return bad(error, "two shapes are named %.*s", static_cast<int>(shape.name.count),
                 shape.name.data);
    }
    const size_t count = shape.vertices.empty() ? n : shape.vertices.count;
    if (shape.displacements.count != 3 * count &&
        !(shape.vertices.empty() && shape.displacements.empty())) {
      return bad(error, "shape %zu has displacements of %zu positions: %zu are expected", s,
                 shape.displacements.count / 3, count);
    }
    for (size_t i = 0; i < shape.vertices.count; ++i) {
      if (shape.vertices[i] < n) continue;
      return bad(error, "shape %zu moves position %u, but there are %zu", s, shape.vertices[i], n);
    }
    for (size_t i = 0; i < shape.displacements.count; ++i) {
      if (!(std::abs(shape.displacements[i] * source.unit) < 1e15)) {
        return bad(error, "shape %zu moves a position by no finite number", s);
      }
    }
  }
  return Status::kOk;
}

/// The distinct vertices of `corners`, sorted, in `out`.
size_t distinct(Span<const uint32_t> corners, Span<uint32_t> out) {
  for (size_t i = 0; i < corners.count; ++i) out[i] = corners[i];
  std::sort(out.data, out.data + corners.count);
  return static_cast<size_t>(std::unique(out.data, out.data + corners.count) - out.data);
}

bool copy_name(Arena& arena, Name from, Name& out) {
  Span<char> chars;
  if (!make(arena, from.count, chars)) return false;
  if (from.count) memcpy(chars.data, from.data, from.count);
  out = {chars.data, chars.count};
  return true;
}

/// The arrays of a mesh while they are filled.
struct Building {
  Span<Vec3> positions;
  Span<uint32_t> source_vertices, face_starts, corners, corner_uvs, triangles;
  Span<Uv> uvs;
  Span<Part> parts;
  size_t vertices = 0, faces = 0, corner_count = 0, triangle_corners = 0, part_count = 0;
};

/// Faces of an object, with vertices of its own. False if memory ran out.
bool add_object(const MeshSource& source, const ObjectSource& object, size_t& first_corner,
                Arena& arena, Span<uint32_t> used, Building& building, ReadMesh& out) {
  size_t corner_count = 0;
  for (uint32_t f = 0; f < object.face_count; ++f) {
    corner_count += source.face_sizes[object.first_face + f];
  }
  const Span<const uint32_t> corners = source.corners.slice(first_corner, corner_count);
  Part part;
  part.first_vertex = static_cast<uint32_t>(building.vertices);
  part.first_face = static_cast<uint32_t>(building.faces);

  // Finds the faces to keep: those with at least three distinct vertices.
  size_t at = 0;
  const size_t kept_from = building.corner_count;
  for (uint32_t f = 0; f < object.face_count; ++f) {
    const uint32_t size = source.face_sizes[object.first_face + f];
    const uint32_t* face = corners.data + at;
    uint32_t different = 1;
    for (uint32_t k = 1; k < size && different < 3; ++k) {
      bool seen = false;
      for (uint32_t j = 0; j < k && !seen; ++j) seen = face[j] == face[k];
      different += !seen;
    }
    if (different < 3) {
      ++out.dropped_faces;
    } else {
      for (uint32_t k = 0; k < size; ++k) {
        if (!source.corner_uvs.empty()) {
          building.corner_uvs[building.corner_count] = source.corner_uvs[first_corner + at + k];
        }
        building.corners[building.corner_count++] = face[k];
      }
      building.face_starts[++building.faces] = static_cast<uint32_t>(building.corner_count);
    }
    at += size;
  }
  first_corner += corner_count;
  part.face_count = static_cast<uint32_t>(building.faces) - part.first_face;
  if (part.face_count == 0) return true;

  const Span<uint32_t> kept = building.corners.slice(kept_from, building.corner_count - kept_from);
  const size_t vertex_count = distinct(kept, used);
  for (uint32_t& corner : kept) {
    corner = part.first_vertex +
             static_cast<uint32_t>(std::lower_bound(used.data, used.data + vertex_count, corner) -
                                   used.data);
  }
  // A vertex in several objects is counted once for each, so the arrays are as long as the corners.
  for (size_t i = 0; i < vertex_count; ++i) {
    const double* p = source.positions.data + size_t{used[i]} * 3;
    building.source_vertices[building.vertices] = used[i];
    building.positions[building.vertices++] =
        source.frame.to_internal(Vec3{p[0], p[1], p[2]} * source.unit);
  }
  part.vertex_count = static_cast<uint32_t>(vertex_count);
  for (uint32_t f = part.first_face; f < building.faces; ++f) {
    for (uint32_t k = building.face_starts[f] + 2; k < building.face_starts[f + 1]; ++k) {
      const uint32_t triangle[3] = {building.corners[building.face_starts[f]],
                                    building.corners[k - 1], building.corners[k]};
      if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
        continue;
      }
      for (uint32_t vertex : triangle) building.triangles[building.triangle_corners++] = vertex;
    }
  }
  if (!copy_name(arena, object.name, part.name)) return false;
  building.parts[building.part_count++] = part;
  return true;
}

bool add_shapes(const MeshSource& source, double smallest, Arena& arena, Arena& scratch,
                ReadMesh& out) {
  const size_t n = out.mesh.positions.count, source_count = source.positions.count / 3;
  Span<Shape> shapes;
  Span<Vec3> dense;
  Span<uint32_t> moving;
  if (!make(arena, source.shapes.count, shapes)) return false;
  if (shapes.empty()) return true;
  if (!make(scratch, source_count, dense) || !make(scratch, n, moving)) return false;
  for (size_t s = 0; s < shapes.count; ++s) {
    const ShapeSource& from = source.shapes[s];
    const size_t given = from.displacements.count / 3;
    for (Vec3& d : dense) d = {};
    for (size_t i = 0; i < given; ++i) {
      const double* d = from.displacements.data + 3 * i;
      dense[from.vertices.empty() ? i : from.vertices[i]] = Vec3{d[0], d[1], d[2]} * source.unit;
    }
    Span<Vec3f> displacements;
    if (!make(arena, n, displacements)) return false;
    size_t count = 0;
    for (uint32_t v = 0; v < n; ++v) {
      const Vec3 d = source.frame.to_internal(dense[out.source_vertices[v]]);
      if (!(length(d) > smallest)) continue;
      displacements[v] = {static_cast<float>(d.x), static_cast<float>(d.y),
                          static_cast<float>(d.z)};
      moving[count++] = v;
    }
    Span<uint32_t> kept;
    if (!make(arena, count, kept)) return false;
    for (size_t i = 0; i < count; ++i) kept[i] = moving[i];
    if (!copy_name(arena, from.name, shapes[s].name)) return false;
    shapes[s].displacements = displacements;
    shapes[s].moving = kept;
    shapes[s].number = static_cast<uint32_t>(s);
  }
  out.mesh.shapes = shapes;
  return true;
}

/// The component that expressions move most, by area; without shapes the largest by area.
bool choose_skin(const MeshSource& source, Arena& arena, Arena& scratch, AuthorMesh& mesh,
                 uint32_t& out_component) {
  const size_t n = mesh.positions.count;
  Span<double> areas, motion;
  Span<double> totals[2], all_areas;
  Span<uint8_t> is_skin;
  if (!make(scratch, n, areas) || !make(scratch, n, motion) ||
      !make(scratch, mesh.component_count, totals[0]) ||
      !make(scratch, mesh.component_count, totals[1]) ||
      !make(scratch, mesh.component_count, all_areas) || !make(arena, n, is_skin)) {
    return false;
  }
  vertex_areas(mesh, areas);
  for (const Shape& shape : mesh.shapes) {
    for (uint32_t v : shape.moving) {
      const Vec3f d = shape.displacements[v];
      motion[v] += double{d.x} * d.x + double{d.y} * d.y + double{d.z} * d.z;
    }
  }
  bool named = false;
  for (const Part& part : mesh.parts) {
    const bool wanted = source.skin_object.empty() || same(part.name, source.skin_object);
    named = named || wanted;
    for (uint32_t v = part.first_vertex; v < part.first_vertex + part.vertex_count; ++v) {
      if (!wanted) continue;
      totals[0][mesh.component[v]] += areas[mesh.welded[v]] * motion[v];
      totals[1][mesh.component[v]] += areas[v];
    }
  }
  out_component = named ? 0 : kNone;
  for (uint32_t c = 1; c < mesh.component_count && named; ++c) {
    const double* a[2] = {&totals[0][c], &totals[0][out_component]};
    const double* b[2] = {&totals[1][c], &totals[1][out_component]};
    if (*a[0] > *a[1] || (*a[0] == *a[1] && *b[0] > *b[1])) out_component = c;
  }
  for (uint32_t v = 0; v < n; ++v) {
    is_skin[v] = mesh.component[v] == out_component;
    all_areas[mesh.component[v]] += areas[v];
  }
  for (uint32_t c = 0; c < mesh.component_count && named; ++c) {
    if (c == out_component || !(all_areas[out_component] > 0)) continue;
    mesh.next_area = std::max(mesh.next_area, all_areas[c] / all_areas[out_component]);
  }
  mesh.is_skin = is_skin;
  return true;
}

/// Refuses meshes on which no bones can be placed.
Status check_skin(const AuthorMesh& mesh, Arena& scratch, double& out_diagonal, Error& error) {
  Span<Vec3> skin;
  if (!make(scratch, mesh.positions.count, skin)) return no_memory(error);
  size_t places = 0;
  for (uint32_t v = 0; v < mesh.positions.count; ++v) {
    if (mesh.is_skin[v] && mesh.welded[v] == v) skin[places++] = mesh.positions[v];
  }
  if (places < 4) {
    return refuse(error, "the skin has %zu different positions: at least 4 are needed", places);
  }
  const Box box = bounding_box(skin.first(places));
  out_diagonal = box.diagonal();
  const char* const axes[] = {"width", "height", "depth"};
  const double sizes[] = {box.size().x, box.size().y, box.size().z};
  for (int i = 0; i < 3; ++i) {
    if (sizes[i] > 1e-6 * out_diagonal) continue;
    return refuse(error, "the skin is flat: its %s is %.3g cm of %.3g cm in all", axes[i], sizes[i],
                  out_diagonal);
  }
  return Status::kOk;
}

}  // namespace

Status read_mesh(const MeshSource& source, Arena& arena, const Allocator& allocator, ReadMesh& out,
                 Error& error) {
  out = ReadMesh();
  if (Status status = check_source(source, error); status != Status::kOk) return status;
  if (source.face_sizes.empty()) {
    return refuse(error, "there are no faces: weights need a surface (%zu positions)",
                  source.positions.count / 3);
  }
  Arena scratch(allocator);
  const size_t corners = source.corners.count, faces = source.face_sizes.count;
  const ObjectSource whole = {{"head", 4}, 0, static_cast<uint32_t>(faces)};
  const Span<const ObjectSource> objects =
      source.objects.empty() ? Span<const ObjectSource>{&whole, 1} : source.objects;
  Building building;
  Span<uint32_t> used;
  Span<Vec3> all_positions;
  Span<uint32_t> all_sources;
  if (!make(scratch, corners, building.positions) ||
      !make(scratch, corners, building.source_vertices) ||
      !make(arena, faces + 1, building.face_starts) || !make(arena, corners, building.corners) ||
      !make(arena, source.corner_uvs.count, building.corner_uvs) ||
      !make(arena, 3 * corners, building.triangles) ||
      !make(arena, objects.count, building.parts) || !make(scratch, corners, used)) {
    return no_memory(error);
  }
  size_t first_corner = 0;
  for (const ObjectSource& object : objects) {
    if (!add_object(source, object, first_corner, arena, used, building, out)) {
      return no_memory(error);
    }
  }
  if (building.vertices == 0) {
    return refuse(error, "all %zu faces have fewer than 3 different positions", faces);
  }
  AuthorMesh& mesh = out.mesh;
  if (!make(arena, building.vertices, all_positions) ||
      !make(arena, building.vertices, all_sources) ||
      !make(arena, source.uvs.count / 2, building.uvs)) {
    return no_memory(error);
  }
  for (size_t v = 0; v < building.vertices; ++v) {
    all_positions[v] = building.positions[v];
    all_sources[v] = building.source_vertices[v];
  }
  for (size_t i = 0; i < building.uvs.count; ++i) {
    building.uvs[i] = {static_cast<float>(source.uvs[2 * i]),
                       static_cast<float>(source.uvs[2 * i + 1])};
  }
  mesh.positions = all_positions;
  mesh.face_starts = building.face_starts.first(building.faces + 1);
  mesh.corners = building.corners.first(building.corner_count);
  if (!source.corner_uvs.empty())
    mesh.corner_uvs = building.corner_uvs.first(building.corner_count);
  mesh.uvs = building.uvs;
  mesh.triangles = building.triangles.first(building.triangle_corners);
  mesh.parts = building.parts.first(building.part_count);
  mesh.frame = source.frame;
  out.source_vertices = all_sources;
  const size_t named = distinct(all_sources, used);
  out.loose_vertices = static_cast<uint32_t>(source.positions.count / 3 - named);

  Span<uint32_t> welded, component;
  const double smallest = 1e-7 * bounding_box(mesh.positions).diagonal();
  if (!add_shapes(source, smallest, arena, scratch, out) ||
      !weld(mesh.positions, mesh.shapes, arena, scratch, welded)) {
    return no_memory(error);
  }
  mesh.welded = welded;
  if (!find_components(mesh.triangles, mesh.welded, arena, scratch, component,
                       mesh.component_count)) {
    return no_memory(error);
  }
  mesh.component = component;
  uint32_t skin = 0;
  if (!choose_skin(source, arena, scratch, mesh, skin)) {
    return no_memory(error);
  }
  if (skin == kNone) {
    return refuse(error, "there is no object named %.*s",
                  static_cast<int>(source.skin_object.count), source.skin_object.data);
  }
  return check_skin(mesh, scratch, mesh.diagonal, error);
}

}  // namespace mien::author
