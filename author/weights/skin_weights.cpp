// SPDX-License-Identifier: MIT
#include "author/weights/skin_weights.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "author/base/dna_making.h"
#include "author/base/exact_math.h"
#include "author/mesh/point_tree.h"
#include "author/weights/body_weights.h"
#include "author/weights/carriers.h"

namespace mien::author {

namespace {

constexpr float kLeastWeight = 1e-4f;
// Noise: relative to the 99th percentile of the displacements of a shape, and to the diagonal.
constexpr double kNoise = 0.03, kLeastMotion = 2e-4;

/// Inputs of the weights of the skin.
struct Weighing {
  const AuthorMesh& mesh;
  const Placement& placement;
  Arena& scratch;
  SkinWeights& out;
  uint32_t facial = 0;  // bones in use
  uint32_t head = 0;
  uint32_t jaw = kNone;  // if places follow it by Placement::jaw_share
  BodyChain body = {};
  double spacing = 0;
  SurfaceGraph graph = {};

  // The nearest m + 1 bones of each vertex, nearest first.
  uint32_t lists = 0;  // m + 1
  Span<uint16_t> near = {};
  Span<double> distances = {};
  Span<uint8_t> counts = {};
};

/// The shortest paths to a vertex known so far in the search, for as many bones as it may keep. Others need
/// not be queued.
struct ShortestWays {
  uint32_t capacity = 0;
  Span<uint16_t> bones = {};
  Span<double> distances = {};
  Span<uint8_t> counts = {};

  bool make(size_t vertices, uint32_t bones_each, Arena& arena) {
    capacity = bones_each;
    return author::make(arena, vertices * capacity, bones) &&
           author::make(arena, vertices * capacity, distances) &&
           author::make(arena, vertices, counts);
  }
  /// False if the vertex has a path as short, or enough nearer bones.
  bool offer(uint32_t v, uint32_t bone, double distance) {
    uint16_t* list = bones.data + size_t{v} * capacity;
    double* ways = distances.data + size_t{v} * capacity;
    uint32_t at = 0, farthest = 0;
    for (; at < counts[v] && list[at] != bone; ++at) {
      const bool is_farther =
          ways[at] != ways[farthest] ? ways[at] > ways[farthest] : list[at] > list[farthest];
      if (is_farther) farthest = at;
    }
    if (at < counts[v]) {
      if (distance >= ways[at]) return false;
    } else if (at < capacity) {
      ++counts[v];
    } else {
      // Of equally distant bones the queue returns the one with the lower index first.
      if (distance > ways[farthest] || (distance == ways[farthest] && bone > list[farthest])) {
        return false;
      }
      at = farthest;
    }
    list[at] = static_cast<uint16_t>(bone);
    ways[at] = distance;
    return true;
  }
};

/// Searches from all bones at once, in order of distance; a vertex passes on only bones that it
/// keeps.
bool find_nearest_bones(Weighing& w) {
  const size_t n = w.mesh.positions.count;
  Span<double> depths;
  Span<uint32_t> places;
  Span<Vec3> points;
  PointTree tree;
  ShortestWays shortest;
  if (!shortest.make(n, w.lists, w.scratch) || !make(w.scratch, n * w.lists, w.near) ||
      !make(w.scratch, n * w.lists, w.distances) || !make(w.scratch, n, w.counts) ||
      !make(w.scratch, w.facial, depths) || !make(w.scratch, w.placement.mask.count, places) ||
      !make(w.scratch, w.placement.mask.count, points)) {
    return false;
  }
  size_t count = 0;
  for (uint32_t v : w.placement.mask) {
    if (w.mesh.welded[v] != v) continue;
    places[count] = v;
    points[count++] = w.mesh.positions[v];
  }
  if (count == 0 || !tree.build(points.first(count), w.scratch)) return count == 0;
  StepHeap heap(w.scratch);
  for (uint32_t b = 0; b < w.facial; ++b) {
    // All places that are equally near, so that neither side of the face is preferred.
    constexpr uint32_t kTies = 8;
    Near near[kTies];
    const Vec3 at = w.placement.bones[w.placement.first_facial + b].position;
    const uint32_t found = tree.nearest(at, kTies, near);
    depths[b] = std::sqrt(near[0].squared_distance);
    const double tie = near[0].squared_distance * (1 + 1e-6);
    for (uint32_t i = 0; i < found && near[i].squared_distance <= tie; ++i) {
      if (!heap.push({depths[b], places[near[i].point], b, 0})) return false;
    }
  }
  const auto has = [&](uint32_t v, uint32_t bone) {
    const uint16_t* list = w.near.data + size_t{v} * w.lists;
    return std::find(list, list + w.counts[v], bone) != list + w.counts[v];
  };
  while (!heap.empty()) {
    const Step step = heap.pop();
    const uint32_t v = step.vertex;
    if (w.counts[v] == w.lists || has(v, step.label)) continue;
    const size_t slot = size_t{v} * w.lists + w.counts[v]++;
    w.near[slot] = static_cast<uint16_t>(step.label);
    w.distances[slot] = step.distance;
    for (uint32_t e = w.graph.starts[v]; e < w.graph.starts[v + 1]; ++e) {
      const uint32_t to = w.graph.neighbors[e];
      if (w.counts[to] == w.lists || has(to, step.label)) continue;
      const double way = step.way + w.graph.lengths[e], depth = depths[step.label];
      const double distance = std::sqrt(way * way + depth * depth);
      if (!shortest.offer(to, step.label, distance)) continue;
      if (!heap.push({distance, to, step.label, way})) return false;
    }
  }
  return true;
}

/// Weights of a vertex that reach 0 at the distance of the next bone; they sum to one.
void kernel_weights(const Weighing& w, uint32_t v, InfluenceList& out) {
  const uint32_t found = w.counts[v];
  if (found == 0) return;
  const size_t slot = size_t{v} * w.lists;
  const uint32_t used = std::min(found, w.lists - 1);
  const double least = 1e-9 * w.mesh.diagonal;
  // Without a next bone, all reachable bones share the vertex.
  const double reach = std::max(
      found == w.lists ? w.distances[slot + found - 1] * 1.0001 : w.distances[slot + found - 1] * 2,
      2 * least);
  double sum = 0, values[kMaxAuthorInfluences];
  for (uint32_t i = 0; i < used; ++i) {
    const double part = w.distances[slot + i] / reach;
    const double value = part < 1 ? 1 - part * part : 0;
    values[i] = value * value;
    sum += values[i];
  }
  for (uint32_t i = 0; i < used; ++i) {
    out.add(w.placement.first_facial + w.near[slot + i], sum > 0 ? values[i] / sum : 1.0 / used);
  }
}

/// Divides weights of facial bones, in all 1 or less, between those below the jaw and others, so that the
/// place follows the jaw by `share`.
void share_with_jaw(const Weighing& w, double share, InfluenceList& facial) {
  const Span<const Bone> bones = w.placement.bones;
  double below = 0;
  const double all = facial.sum();
  for (uint32_t i = 0; i < facial.count; ++i) {
    if (bones[facial.joints[i]].parent == w.jaw) below += facial.values[i];
  }
  const double of_jaw = below < share * all ? share * all - below : 0;
  const double of_head = below > share * all ? below - share * all : 0;
  const double others = all - below;
  for (uint32_t i = 0; i < facial.count; ++i) {
    const bool is_below = bones[facial.joints[i]].parent == w.jaw;
    if (is_below && below > 0) facial.values[i] *= (below - of_head) / below;
    if (!is_below && others > 0) facial.values[i] *= (others - of_jaw) / others;
  }
  facial.add(w.jaw, of_jaw);
  facial.add(w.head, of_head);
}

/// The squared distance from which on a shape moves the skin: less is noise, as shapes of scans
/// have everywhere. `room` is for all vertices.
double noise_of(const AuthorMesh& mesh, const Shape& shape, Span<double> room) {
  size_t count = 0;
  for (const uint32_t v : shape.moving) {
    const Vec3f f = shape.displacements[v];
    const Vec3 d = {double{f.x}, double{f.y}, double{f.z}};
    if (mesh.is_skin[v]) room[count++] = dot(d, d);
  }
  const double least = kLeastMotion * kLeastMotion * mesh.diagonal * mesh.diagonal;
  if (count == 0) return least;
  double* most = room.data + (count - 1) * 99 / 100;
  std::nth_element(room.data, most, room.data + count);
  return std::max(least, kNoise * kNoise * *most);
}

/// The mask, and other skin that a shape moves: there are no bones below the throat, but the chin pulls the
/// skin there. False if memory ran out.
bool find_moved(const Weighing& w, Span<uint32_t>& out) {
  const AuthorMesh& mesh = w.mesh;
  Span<uint8_t> is_in;
  Span<double> room;
  if (!make(w.scratch, mesh.positions.count, is_in) ||
      !make(w.scratch, mesh.positions.count, room) || !make(w.scratch, mesh.positions.count, out)) {
    return false;
  }
  for (const uint32_t v : w.placement.mask) is_in[v] = 1;
  for (const Shape& shape : mesh.shapes) {
    const double least = noise_of(mesh, shape, room);
    for (const uint32_t v : shape.moving) {
      const Vec3f f = shape.displacements[v];
      const Vec3 d = {double{f.x}, double{f.y}, double{f.z}};
      if (mesh.is_skin[v] && dot(d, d) > least) is_in[v] = 1;
    }
  }
  size_t count = 0;
  for (uint32_t v = 0; v < mesh.positions.count; ++v) {
    if (is_in[v]) out[count++] = v;
  }
  out.count = count;
  return true;
}

bool weigh_skin(Weighing& w) {
  const AuthorMesh& mesh = w.mesh;
  Span<double> from_mask;
  Span<uint32_t> sources;
  if (!make(w.scratch, mesh.positions.count, from_mask) || !find_moved(w, sources) ||
      !surface_distances(mesh, w.graph, sources, w.scratch, from_mask)) {
    return false;
  }
  for (uint32_t v = 0; v < mesh.positions.count; ++v) {
    if (!mesh.is_skin[v] || mesh.welded[v] != v) continue;
    InfluenceList facial, list;
    kernel_weights(w, v, facial);
    const double of_jaw = w.jaw == kNone ? 0 : double{w.placement.jaw_share[v]};
    if (w.jaw != kNone) share_with_jaw(w, of_jaw, facial);
    const double t = facial.count ? clamp01(from_mask[v] / (2 * w.spacing)) : 1;
    const double outside = t * t * (3 - 2 * t);
    double shares[BodyChain::kCapacity];
    share_body(w.body, height_in_neck(w.placement, mesh.positions[v]),
               front_of_neck(w.placement, mesh.positions[v]), shares);
    const double of_head = shares[w.body.count - 1];
    for (uint32_t i = 0; i < facial.count; ++i) {
      list.add(facial.joints[i], facial.values[i] * (1 - outside) * of_head);
    }
    for (uint32_t i = 0; i + 1 < w.body.count; ++i) list.add(w.body.bones[i], shares[i]);
    list.add(w.head, outside * of_head * (1 - of_jaw));
    if (w.jaw != kNone) list.add(w.jaw, outside * of_head * of_jaw);
    store(list, v, w.out);
  }
  return true;
}

}  // namespace

double InfluenceList::sum() const {
  double total = 0;
  for (uint32_t i = 0; i < count; ++i) total += values[i];
  return total;
}

void store(const InfluenceList& list, uint32_t vertex, SkinWeights& out) {
  uint32_t order[InfluenceList::kCapacity];
  for (uint32_t i = 0; i < list.count; ++i) order[i] = i;
  std::sort(order, order + list.count, [&](uint32_t a, uint32_t b) {
    return list.values[a] != list.values[b] ? list.values[a] > list.values[b]
                                            : list.joints[a] < list.joints[b];
  });
  const uint32_t most = std::min(list.count, out.m);
  double sum = 0, all = 0;
  for (uint32_t i = 0; i < most; ++i) all += list.values[order[i]];
  uint32_t used = 0;
  for (; used < most && list.values[order[used]] >= kLeastWeight * all &&
         list.values[order[used]] > 0;
       ++used) {
    sum += list.values[order[used]];
  }
  uint16_t* joints = out.joints.data + size_t{vertex} * out.m;
  float* weights = out.weights.data + size_t{vertex} * out.m;
  double written = 0;
  for (uint32_t i = 0; i < out.m; ++i) {
    joints[i] = i < used ? static_cast<uint16_t>(list.joints[order[i]]) : uint16_t{0};
    weights[i] = i < used ? static_cast<float>(list.values[order[i]] / sum) : 0;
    written += double{weights[i]};
  }
  if (used > 0) weights[0] = static_cast<float>(weights[0] + (1 - written));
}

InfluenceList load(uint32_t vertex, const SkinWeights& from) {
  InfluenceList list;
  for (uint32_t i = 0; i < from.m; ++i) {
    list.add(from.joints[size_t{vertex} * from.m + i],
             double{from.weights[size_t{vertex} * from.m + i]});
  }
  return list;
}

namespace {

bool make_slots(const AuthorMesh& mesh, uint32_t influences, Arena& arena, SkinWeights& out) {
  out.m = influences;
  const size_t count = mesh.positions.count * influences;
  return make(arena, count, out.joints) && make(arena, count, out.weights);
}

/// Fills `out`, whose memory is allocated.
bool weigh(const AuthorMesh& mesh, const Placement& placement, const WeightOptions& options,
           const Allocator& allocator, SkinWeights& out) {
  Arena scratch(allocator);
  Weighing w = {mesh, placement, scratch, out};
  w.facial = std::min(options.facial_bones, placement.facial_count);
  w.lists = out.m + 1;
  w.head = bone_of_kind(placement, BoneKind::kHead, 0);
  if (!placement.jaw_share.empty()) w.jaw = bone_of_kind(placement, BoneKind::kJaw, kNone);
  w.body = body_chain(placement);
  if (!find_median_spacing(placement, w.facial, mesh.diagonal, scratch, w.spacing) ||
      !make_surface_graph(mesh, scratch, scratch, w.graph) || !find_nearest_bones(w) ||
      !weigh_skin(w) || !connect_supports(mesh, w.graph, placement, w.head, scratch, out)) {
    return false;
  }
  return carry_components(mesh, placement, w.head, scratch, out, nullptr);
}

/// Memory of one task: the caller's allocator is used on the calling thread only. Nothing is
/// released before all of it.
struct Block {
  uint8_t* data = nullptr;
  size_t size = 0, used = 0;

  Allocator allocator(size_t arena_chunk) {
    return {this,
            [](void* user, size_t wanted, size_t alignment) -> void* {
              Block& block = *static_cast<Block*>(user);
              const size_t at = align_up(block.used, alignment);
              if (at > block.size || wanted > block.size - at) return nullptr;
              block.used = at + wanted;
              return block.data + at;
            },
            [](void*, void*, size_t, size_t) {}, arena_chunk};
  }
};

/// What a task usually needs, with room for growing queues.
size_t likely_memory(const AuthorMesh& mesh, uint32_t influences) {
  const size_t lists = influences + 1;
  return mesh.positions.count * (lists * 64 + 512) + mesh.triangles.count * 64 + 65536;
}

}  // namespace

bool make_skin_weights(const AuthorMesh& mesh, const Placement& placement,
                       const WeightOptions& options, Arena& arena, const Allocator& allocator,
                       SkinWeights& out) {
  return make_slots(mesh, options.influences, arena, out) &&
         weigh(mesh, placement, options, allocator, out);
}

bool make_lod_weights(const AuthorMesh& mesh, const Placement& placement,
                      Span<const WeightOptions> options, const ParallelFor& parallel, Arena& arena,
                      const Allocator& allocator, Span<SkinWeights> out) {
  assert(options.count <= kWeightLanes);
  struct Lane {
    Block block;
    bool done = false;
  };
  struct Task {
    const AuthorMesh& mesh;
    const Placement& placement;
    Span<const WeightOptions> options;
    Span<SkinWeights> out;
    size_t arena_chunk;
    Lane lanes[kWeightLanes] = {};
  } task = {mesh, placement, options, out, allocator.arena_chunk};
  for (size_t l = 0; l < out.count; ++l) {
    if (!make_slots(mesh, options[l].influences, arena, out[l])) return false;
  }
  Arena blocks(allocator);
  if (parallel.run && out.count > 1) {
    for (size_t l = 0; l < out.count; ++l) {
      Block& block = task.lanes[l].block;
      block.size = likely_memory(mesh, options[l].influences);
      block.data = static_cast<uint8_t*>(blocks.allocate(block.size, kBlockAlignment));
      if (!block.data) return false;
    }
    run_tasks(
        parallel, static_cast<uint32_t>(out.count),
        [](void* context, uint32_t l) {
          Task& t = *static_cast<Task*>(context);
          t.lanes[l].done = weigh(t.mesh, t.placement, t.options[l],
                                  t.lanes[l].block.allocator(t.arena_chunk), t.out[l]);
        },
        &task);
    blocks.clear();
  }
  // Sequentially, or again if a task needed more than that.
  for (size_t l = 0; l < out.count; ++l) {
    if (!task.lanes[l].done && !weigh(mesh, placement, options[l], allocator, out[l])) return false;
  }
  return true;
}

}  // namespace mien::author
