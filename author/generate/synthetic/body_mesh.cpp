// SPDX-License-Identifier: MIT
// Skin of the body: a closed tube from each base joint to the one that it follows.
#include <cmath>

#include "author/generate/synthetic/body.h"

namespace mien::synthetic {
namespace {

struct TubeGrid {
  uint32_t sides, rings;
};
constexpr TubeGrid kTubeGrids[kBodyLodCount] = {{8, 4}, {8, 3}, {8, 2}, {4, 2}};

// Eighths of a turn; four sides take every other.
constexpr double kHalf = 0.70710678118654752;
constexpr double kCircle[8][2] = {{1, 0},  {kHalf, kHalf},   {0, 1},  {-kHalf, kHalf},
                                  {-1, 0}, {-kHalf, -kHalf}, {0, -1}, {kHalf, -kHalf}};

struct TubeMaker {
  TubeMaker(const Body& of, Arena& memory, TubeGrid sizes) : body(of), arena(memory), grid(sizes) {}

  const Body& body;
  Arena& arena;
  TubeGrid grid;

  uint32_t vertex = 0, face = 0, corner = 0;
  dna::NewArray<float> positions[3], normals[3], us, vs;
  dna::NewArray<uint32_t> numbers, corners;
  dna::NewArray<float> weights;
  dna::NewArray<uint16_t> joints;
  dna::List<dna::Face> faces;
  dna::List<dna::VertexSkinWeights> skin;

  uint32_t tube_vertices() const { return grid.sides * grid.rings; }
  uint32_t tube_faces() const { return grid.sides * (grid.rings - 1) + 2; }

  bool fill(dna::Mesh& mesh) {
    const uint32_t tubes = body.base_count - 1;  // the root has no limb
    const uint32_t vertices = tubes * tube_vertices();
    const uint32_t face_count = tubes * tube_faces();
    const uint32_t corner_count = tubes * (4 * (tube_faces() - 2) + 2 * grid.sides);
    for (int k = 0; k < 3; ++k) {
      if (!make(arena, vertices, positions[k]) || !make(arena, vertices, normals[k])) return false;
    }
    if (!make(arena, vertices, us) || !make(arena, vertices, vs) ||
        !make(arena, vertices, numbers) || !make(arena, corner_count, corners) ||
        !make(arena, 2 * size_t{vertices}, weights) || !make(arena, 2 * size_t{vertices}, joints) ||
        !make(arena, face_count, faces) || !make(arena, vertices, skin)) {
      return false;
    }
    for (uint32_t j = 1; j < body.base_count; ++j) add_tube(static_cast<uint16_t>(j));
    mesh.positions = {positions[0], positions[1], positions[2]};
    mesh.normals = {normals[0], normals[1], normals[2]};
    mesh.texture_coordinates = {us, vs};
    mesh.layouts = {numbers, numbers, numbers};
    mesh.faces = faces;
    mesh.skin_weights = skin;
    mesh.maximum_influence_per_vertex = 2;
    return true;
  }

  void add_tube(uint16_t joint) {
    const BodyJoint& end = body.joints[joint];
    const Vec3 from = body.joints[end.parent].position;
    const Vec3 way = end.position - from;
    const double size = length(way);
    const double radius = 0.5 + 0.12 * size;
    const Vec3 along = unit(way);
    // Any direction that is not along the tube is suitable.
    const Vec3 helper = along.y * along.y < 0.5 ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
    const Vec3 across = unit(cross(helper, along)), up = cross(along, across);
    const uint32_t first = vertex;
    for (uint32_t ring = 0; ring < grid.rings; ++ring) {
      const double share = static_cast<double>(ring) / (grid.rings - 1);
      for (uint32_t side = 0; side < grid.sides; ++side) {
        const double* turn = kCircle[side * 8 / grid.sides];
        const Vec3 out = across * turn[0] + up * turn[1];
        add_vertex(from + way * share + out * radius, out, static_cast<double>(side) / grid.sides,
                   share, end.parent, joint);
      }
    }
    for (uint32_t ring = 0; ring + 1 < grid.rings; ++ring) {
      for (uint32_t side = 0; side < grid.sides; ++side) {
        const uint32_t next = (side + 1) % grid.sides;
        const uint32_t low = first + ring * grid.sides, high = low + grid.sides;
        const uint32_t quad[] = {low + side, low + next, high + next, high + side};
        add_face(quad, 4);
      }
    }
    uint32_t cap[8];
    const uint32_t last = first + (grid.rings - 1) * grid.sides;
    for (uint32_t side = 0; side < grid.sides; ++side) cap[side] = first + grid.sides - 1 - side;
    add_face(cap, grid.sides);
    for (uint32_t side = 0; side < grid.sides; ++side) cap[side] = last + side;
    add_face(cap, grid.sides);
  }

  // Shared evenly where limbs meet; else of the joint at which the limb begins.
  void add_vertex(Vec3 at, Vec3 normal, double u, double v, uint16_t parent, uint16_t joint) {
    const double place[3] = {at.x, at.y, at.z}, out[3] = {normal.x, normal.y, normal.z};
    for (int k = 0; k < 3; ++k) {
      positions[k].set(vertex, static_cast<float>(place[k]));
      normals[k].set(vertex, static_cast<float>(out[k]));
    }
    us.set(vertex, static_cast<float>(u));
    vs.set(vertex, static_cast<float>(v));
    numbers.set(vertex, vertex);
    const uint32_t influences = v == 1 ? 2 : 1;
    const uint32_t entry = 2 * vertex;
    for (uint32_t i = 0; i < influences; ++i) {
      weights.set(entry + i, influences == 2 ? 0.5f : 1.0f);
      joints.set(entry + i, i == 0 ? parent : joint);
    }
    skin[vertex] = {{weights.data + entry * sizeof(float), influences},
                    {joints.data + entry * sizeof(uint16_t), influences}};
    ++vertex;
  }

  void add_face(const uint32_t* vertices, uint32_t count) {
    faces[face++].layout_indices = {corners.data + corner * sizeof(uint32_t), count};
    for (uint32_t i = 0; i < count; ++i) corners.set(corner++, vertices[i]);
  }
};

}  // namespace

bool make_body_meshes(const Body& body, Arena& arena, dna::DnaView& out) {
  if (!make(arena, kBodyLodCount, out.geom.meshes) ||
      !make(arena, kBodyLodCount, out.defn.mesh_names)) {
    return false;
  }
  for (uint32_t lod = 0; lod < kBodyLodCount; ++lod) {
    TubeMaker maker(body, arena, kTubeGrids[lod]);
    Text name = Text().add("body_lod").add(uint64_t{lod}).add("_mesh");
    if (!copy_text(arena, name, out.defn.mesh_names[lod]) || !maker.fill(out.geom.meshes[lod])) {
      return false;
    }
  }
  auto in_lod = [](size_t lod, size_t mesh) { return mesh == lod; };
  return make_lod_map(arena, kBodyLodCount, kBodyLodCount, in_lod, out.defn.lod_meshes);
}

}  // namespace mien::synthetic
