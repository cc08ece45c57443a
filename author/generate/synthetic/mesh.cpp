// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "author/generate/synthetic/head.h"

namespace mien::synthetic {
namespace {

struct Grid {
  uint32_t rows, columns;  // columns: a multiple of 4
};
constexpr Grid kGrids[] = {{128, 192}, {96, 128}, {72, 96}, {54, 72}, {40, 56}, {30, 40},
                           {22, 32},   {16, 24},  {12, 16}, {8, 12},  {6, 8}};
constexpr uint32_t kGridCount = sizeof(kGrids) / sizeof(kGrids[0]);

struct Point2 {
  double x, y;
};

/// Point `step` of `count` around the unit circle, from (1, 0) towards (0, 1). By quarters of the
/// rational parametrization, since sine and cosine round differently from library to library.
Point2 on_circle(uint32_t step, uint32_t count) {
  uint32_t quarter = 4 * step / count % 4;
  double t = static_cast<double>(4 * step % count) / count;
  double c = (1 - t * t) / (1 + t * t), s = 2 * t / (1 + t * t);
  switch (quarter) {
    case 0: return {c, s};
    case 1: return {-s, c};
    case 2: return {-c, -s};
    default: return {s, -c};
  }
}

Vec3 point_at(const dna::Vec3Array& points, size_t i) {
  return {points.xs[i], points.ys[i], points.zs[i]};
}

// Surface ---------------------------------------------------------------------------------------

/// Rows of vertices from the lower pole to the upper one, each counter-clockwise from the front as seen from
/// above; then the poles. The first column of texture coordinates is repeated, so there are more layouts than
/// positions, as in real meshes.
bool make_surface(const Ellipsoid& shape, Grid grid, Arena& arena, dna::Mesh& out) {
  uint32_t rows = grid.rows, columns = grid.columns;
  uint32_t points = rows * columns, corners = rows * (columns + 1);
  NewVec3s positions, normals;
  dna::NewArray<float> us, vs;
  dna::NewArray<uint32_t> of_position, of_uv, of_normal;
  if (!positions.allocate(arena, points + 2) || !normals.allocate(arena, points + 2) ||
      !make(arena, corners + 2, us) || !make(arena, corners + 2, vs) ||
      !make(arena, corners + 2, of_position) || !make(arena, corners + 2, of_uv) ||
      !make(arena, corners + 2, of_normal)) {
    return false;
  }

  auto set_point = [&](uint32_t i, Vec3 on_sphere) {
    Vec3 r = shape.radii;
    positions.set(i, shape.center + Vec3{on_sphere.x * r.x, on_sphere.y * r.y, on_sphere.z * r.z});
    Vec3 across = {on_sphere.x / r.x, on_sphere.y / r.y, on_sphere.z / r.z};
    normals.set(i, unit(across));
  };
  auto set_corner = [&](uint32_t i, uint32_t point, double u, double v) {
    us.set(i, static_cast<float>(u));
    vs.set(i, static_cast<float>(v));
    of_position.set(i, point);
    of_uv.set(i, i);
    of_normal.set(i, point);
  };
  for (uint32_t row = 0; row < rows; ++row) {
    Point2 height = on_circle(row + 1, 2 * (rows + 1));
    for (uint32_t column = 0; column <= columns; ++column) {
      uint32_t point = row * columns + column % columns;
      Point2 around = on_circle(column % columns, columns);
      set_point(point, {height.y * around.y, -height.x, height.y * around.x});
      set_corner(row * (columns + 1) + column, point, static_cast<double>(column) / columns,
                 static_cast<double>(row + 1) / (rows + 1));
    }
  }
  set_point(points, {0, -1, 0});
  set_point(points + 1, {0, 1, 0});
  set_corner(corners, points, 0.5, 0);
  set_corner(corners + 1, points + 1, 0.5, 1);
  out.positions = positions;
  out.normals = normals;
  out.texture_coordinates = {us, vs};
  out.layouts = {of_position, of_uv, of_normal};
  return true;
}

/// Quads between the rows, triangles at the poles; counter-clockwise from outside.
bool make_faces(Grid grid, Arena& arena, dna::Mesh& out) {
  uint32_t quads = (grid.rows - 1) * grid.columns, stride = grid.columns + 1;
  dna::NewArray<uint32_t> corners;
  if (!make(arena, quads * 4 + grid.columns * 6, corners)) return false;
  if (!make(arena, quads + grid.columns * 2, out.faces)) return false;
  uint32_t face = 0, corner = 0;
  auto add = [&](const uint32_t* layouts, uint32_t count) {
    out.faces[face++].layout_indices = {corners.data + corner * sizeof(uint32_t), count};
    for (uint32_t i = 0; i < count; ++i) corners.set(corner++, layouts[i]);
  };
  uint32_t top = (grid.rows - 1) * stride, bottom_pole = grid.rows * stride;
  for (uint32_t column = 0; column < grid.columns; ++column) {
    for (uint32_t row = 0; row + 1 < grid.rows; ++row) {
      uint32_t at = row * stride + column;
      const uint32_t quad[4] = {at, at + 1, at + stride + 1, at + stride};
      add(quad, 4);
    }
    const uint32_t below[3] = {bottom_pole, column + 1, column};
    const uint32_t above[3] = {top + column, top + column + 1, bottom_pole + 1};
    add(below, 3);
    add(above, 3);
  }
  return true;
}

// Skin ------------------------------------------------------------------------------------------

constexpr uint32_t kMaxInfluences = 8;
constexpr uint32_t kMaxBones = kMaxInfluences - 2;  // neck and head come on top

struct Weight {
  double value;
  uint16_t joint;
};

double smooth_step(double from, double to, double x) {
  double t = std::min(std::max((x - from) / (to - from), 0.0), 1.0);
  return t * t * (3 - 2 * t);
}

struct Bone {
  Vec3 place;
  uint16_t joint = 0;
};

/// Weights of one vertex: its nearest bones by compact Shepard weights, which reach 0 where the
/// next bone would come in, fading into head and neck away from the bones. `bones` ascend in
/// height.
uint32_t weigh_vertex(Vec3 vertex, Span<const Bone> bones, double spacing,
                      Weight (&out)[kMaxInfluences]) {
  Weight nearest[kMaxBones + 1];  // by squared distance, ascending
  uint32_t found = 0;
  auto is_below = [](const Bone& bone, double y) { return bone.place.y < y; };
  const Bone* above = std::lower_bound(bones.begin(), bones.end(), vertex.y, is_below);
  const Bone* below = above;  // one past the next one below
  while (above != bones.end() || below != bones.begin()) {
    double up = above != bones.end() ? above->place.y - vertex.y : 1e30;
    double down = below != bones.begin() ? vertex.y - below[-1].place.y : 1e30;
    double step = std::min(up, down);
    if (found > kMaxBones && step * step >= nearest[kMaxBones].value) break;
    const Bone& bone = up <= down ? *above++ : *--below;
    Vec3 apart = bone.place - vertex;
    double squared = dot(apart, apart);
    if (found > kMaxBones && squared >= nearest[kMaxBones].value) continue;
    uint32_t at = found > kMaxBones ? kMaxBones : found++;
    for (; at > 0 && nearest[at - 1].value > squared; --at) nearest[at] = nearest[at - 1];
    nearest[at] = {squared, bone.joint};
  }

  uint32_t count = std::min(found, kMaxBones);
  double end = std::sqrt(nearest[found - 1].value) * (found > kMaxBones ? 1.0001 : 2.0) + 0.1;
  double sum = 0;
  for (uint32_t i = 0; i < count; ++i) {
    double distance = std::sqrt(nearest[i].value) + 0.1;  // a bone may lie on the vertex
    double w = (end - distance) / (end * distance);
    out[i] = {w * w, nearest[i].joint};
    sum += w * w;
  }
  double fade = smooth_step(spacing, 3 * spacing, std::sqrt(nearest[0].value));
  double neck = smooth_step(-9, -13, vertex.y);
  for (uint32_t i = 0; i < count; ++i) out[i].value *= (1 - fade) / sum;
  out[count++] = {fade * (1 - neck), kHeadJoint};
  out[count++] = {fade * neck, kNeckJoint};

  uint32_t kept = 0;
  sum = 0;
  for (uint32_t i = 0; i < count; ++i) {
    if (out[i].value < 1e-4) continue;
    out[kept++] = out[i];
    sum += out[i].value;
  }
  for (uint32_t i = 0; i < kept; ++i) out[i].value /= sum;
  return kept;
}

/// Stores floats; the largest absorbs the rounding errors of the others.
bool store_weights(const Weight* weights, uint32_t count, Arena& arena,
                   dna::VertexSkinWeights& out) {
  dna::NewArray<float> values;
  dna::NewArray<uint16_t> joints;
  if (!make(arena, count, values) || !make(arena, count, joints)) return false;
  uint32_t largest = 0;
  for (uint32_t i = 1; i < count; ++i) {
    if (weights[i].value > weights[largest].value) largest = i;
  }
  double rest = 1;
  for (uint32_t i = 0; i < count; ++i) {
    float value = static_cast<float>(weights[i].value);
    if (i != largest) rest -= value;
    values.set(i, value);
    joints.set(i, weights[i].joint);
  }
  values.set(largest, static_cast<float>(rest));
  out = {values, joints};
  return true;
}

bool make_skin(const Head& head, uint32_t lod, Arena& arena, dna::Mesh& out) {
  Span<Bone> bones;
  if (!make(arena, head.joints.count, bones) ||
      !make(arena, out.positions.xs.count, out.skin_weights)) {
    return false;
  }
  size_t count = 0;
  for (size_t j = kJawJoint; j < head.joints.count; ++j) {
    if (head.joints[j].inside || !head.joint_in_lod(j, lod)) continue;
    bones[count++] = {head.joints[j].position, static_cast<uint16_t>(j)};
  }
  bones = bones.first(count);
  std::sort(bones.begin(), bones.end(), [](const Bone& a, const Bone& b) {
    return a.place.y < b.place.y || (a.place.y == b.place.y && a.joint < b.joint);
  });
  double spacing = std::sqrt(500.0 / static_cast<double>(count));  // the mask has about 500 cm2
  out.maximum_influence_per_vertex = 0;
  for (uint32_t v = 0; v < out.skin_weights.count; ++v) {
    Weight weights[kMaxInfluences];
    uint32_t used = weigh_vertex(point_at(out.positions, v), bones, spacing, weights);
    if (!store_weights(weights, used, arena, out.skin_weights[v])) return false;
    out.maximum_influence_per_vertex =
        std::max(out.maximum_influence_per_vertex, static_cast<uint16_t>(used));
  }
  return true;
}

bool make_rigid_skin(uint16_t joint, Arena& arena, dna::Mesh& out) {
  if (!make(arena, out.positions.xs.count, out.skin_weights)) return false;
  const Weight all = {1, joint};
  out.maximum_influence_per_vertex = 1;
  for (dna::VertexSkinWeights& weights : out.skin_weights) {
    if (!store_weights(&all, 1, arena, weights)) return false;
  }
  return true;
}

// Blend shape targets ---------------------------------------------------------------------------

/// Calls visit(vertex, squared distance) for the vertices of a head nearer than `limit` squared, which
/// `visit` may lower. Skips whole rows, because their vertices have the same height.
template <class Visit>
void visit_near(const dna::Mesh& mesh, uint32_t columns, Vec3 place, double& limit,
                const Visit& visit) {
  uint32_t count = mesh.positions.xs.count;
  for (uint32_t first = 0, end; first < count; first = end) {
    end = first + columns < count ? first + columns : first + 1;  // the poles are rows of one
    double up = mesh.positions.ys[first] - place.y;
    if (up * up >= limit) continue;
    for (uint32_t v = first; v < end; ++v) {
      Vec3 apart = point_at(mesh.positions, v) - place;
      double squared = dot(apart, apart);
      if (squared < limit) visit(v, squared);
    }
  }
}

/// A bump on the skin nearest to the control's home. `moved` has room for all vertices.
bool make_target(const Head& head, const Control& control, Random& random, uint32_t columns,
                 Span<uint32_t> moved, Arena& arena, const dna::Mesh& mesh,
                 dna::BlendShapeTarget& out) {
  uint32_t nearest = 0, count = 0;
  double least = 1e30, radius = head.sizes->target_radius, limit = radius * radius;
  visit_near(mesh, columns, control.home, least, [&](uint32_t v, double squared) {
    nearest = v;
    least = squared;
  });
  Vec3 center = point_at(mesh.positions, nearest);
  visit_near(mesh, columns, center, limit, [&](uint32_t v, double) { moved[count++] = v; });

  NewVec3s deltas;
  dna::NewArray<uint32_t> vertices;
  if (!deltas.allocate(arena, count) || !make(arena, count, vertices)) return false;
  Vec3 way;
  way.x = random.normal() * 0.1;
  way.y = random.normal() * 0.1;
  way.z = random.normal() * 0.1;
  for (uint32_t i = 0; i < count; ++i) {
    Vec3 apart = point_at(mesh.positions, moved[i]) - center;
    deltas.set(i, way * falloff(dot(apart, apart), radius));
    vertices.set(i, moved[i]);
  }
  out.deltas = deltas;
  out.vertex_indices = vertices;
  return true;
}

/// LOD 0 has a target for each channel, LOD 1 for those `kept`, with equal bumps.
bool make_targets(const Head& head, uint64_t seed, uint32_t lod, uint32_t columns,
                  Span<const uint8_t> kept, Arena& arena, dna::Mesh& out) {
  uint32_t count = 0;
  for (uint8_t k : kept) count += lod == 0 || k;
  Span<uint32_t> moved;
  if (!make(arena, count, out.blend_shape_targets) || !make(arena, out.positions.xs.count, moved)) {
    return false;
  }
  uint32_t target = 0;
  for (uint32_t c = 0; c < kept.count; ++c) {
    if (lod != 0 && !kept[c]) continue;
    Random random = Random::from_seed(seed, kFirstTargetStream + c);
    const Control& control = head.controls[head.control_of_channel(c)];
    dna::BlendShapeTarget& made = out.blend_shape_targets[target++];
    made.channel_index = static_cast<uint16_t>(c);
    if (!make_target(head, control, random, columns, moved, arena, out, made)) return false;
  }
  return true;
}

/// Lists which mesh has which channel, from the targets.
bool map_channels(const dna::Geometry& geometry, Arena& arena, dna::MeshChannelMapping& out) {
  size_t count = 0, entry = 0;
  for (const dna::Mesh& mesh : geometry.meshes) count += mesh.blend_shape_targets.count;
  dna::NewArray<uint16_t> from, to;
  if (!make(arena, count, from) || !make(arena, count, to)) return false;
  for (uint32_t m = 0; m < geometry.meshes.count; ++m) {
    for (const dna::BlendShapeTarget& target : geometry.meshes[m].blend_shape_targets) {
      from.set(entry, static_cast<uint16_t>(m));
      to.set(entry++, target.channel_index);
    }
  }
  out = {from, to};
  return true;
}

}  // namespace

bool make_meshes(const Head& head, uint64_t seed, Span<const uint8_t> kept, Arena& arena,
                 dna::DnaView& out) {
  const Sizes& sizes = *head.sizes;
  uint32_t lod_count = sizes.lod_count;
  dna::List<dna::Mesh>& meshes = out.geom.meshes;
  dna::List<dna::String>& names = out.defn.mesh_names;
  if (!make(arena, lod_count + 2, meshes) || !make(arena, lod_count + 2, names)) return false;

  for (uint32_t lod = 0; lod < lod_count; ++lod) {
    dna::Mesh& mesh = meshes[lod];
    Grid grid = kGrids[std::min(sizes.first_grid + lod, kGridCount - 1)];
    Text name;
    name.add("head_lod").add(uint64_t{lod}).add("_mesh");
    if (!copy_text(arena, name, names[lod]) || !make_surface(kSkull, grid, arena, mesh) ||
        !make_faces(grid, arena, mesh) || !make_skin(head, lod, arena, mesh)) {
      return false;
    }
    if (lod < 2 && !make_targets(head, seed, lod, grid.columns, kept, arena, mesh)) return false;
  }

  // The first joint of each eye region is the center of the eyeball.
  Regions regions;
  Grid grid = kGrids[std::min(sizes.first_grid + 4, kGridCount - 1)];
  for (uint32_t i = 0; i < 2; ++i) {
    dna::Mesh& mesh = meshes[lod_count + i];
    Ellipsoid eye = kLeftEye;
    if (i == 1) eye.center.x = -eye.center.x;
    uint8_t region = regions.find(kEye, i == 0 ? 1 : -1);
    uint16_t joint = 0;
    while (head.joints[joint].region != region) ++joint;
    Text name;
    name.add(i == 0 ? "eyeLeft_mesh" : "eyeRight_mesh");
    if (!copy_text(arena, name, names[lod_count + i]) || !make_surface(eye, grid, arena, mesh) ||
        !make_faces(grid, arena, mesh) || !make_rigid_skin(joint, arena, mesh)) {
      return false;
    }
  }

  auto in_lod = [lod_count](size_t lod, size_t mesh) { return mesh == lod || mesh >= lod_count; };
  return make_lod_map(arena, lod_count, meshes.count, in_lod, out.defn.lod_meshes) &&
         map_channels(out.geom, arena, out.defn.mesh_channels);
}

}  // namespace mien::synthetic
