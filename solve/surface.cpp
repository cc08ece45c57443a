// SPDX-License-Identifier: MIT
#include "solve/surface.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "capi/arguments/arguments.h"
#include "runtime/base/arena.h"

using namespace mien;
using namespace mien::capi;

namespace {

constexpr double kFacesTheSameWay = 0.5;  // cosine of 60 degrees
constexpr uint32_t kMostAround = 64;      // triangles in which a border is looked for

struct Point3 {
  double x, y, z;
};
Point3 operator-(const Point3& a, const Point3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(const Point3& a, const Point3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Point3 cross(const Point3& a, const Point3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Point3 along(const Point3& from, const Point3& side, double share) {
  return {from.x + side.x * share, from.y + side.y * share, from.z + side.z * share};
}
template <class T>
Point3 point_of(const T* xyz) {
  return {double{xyz[0]}, double{xyz[1]}, double{xyz[2]}};
}

Point3 nearest_on_edge(const Point3& p, const Point3& a, const Point3& b) {
  const Point3 side = b - a;
  const double length = dot(side, side);
  const double share = length > 0 ? dot(p - a, side) / length : 0;
  return along(a, side, std::min(std::max(share, 0.0), 1.0));
}

Point3 nearest_on_triangle(const Point3& p, const Point3& a, const Point3& b, const Point3& c) {
  const Point3 ab = b - a, ac = c - a, normal = cross(ab, ac);
  const double area = dot(normal, normal);
  if (area > 0) {
    const Point3 ap = p - a;
    const double v = dot(cross(ap, ac), normal) / area, w = dot(cross(ab, ap), normal) / area;
    if (v >= 0 && w >= 0 && v + w <= 1) return along(along(a, ab, v), ac, w);
  }
  Point3 best = nearest_on_edge(p, a, b);
  for (const Point3& other : {nearest_on_edge(p, b, c), nearest_on_edge(p, c, a)}) {
    if (dot(p - other, p - other) < dot(p - best, p - best)) best = other;
  }
  return best;
}

constexpr size_t kBoxFloats = 12,
                 kBoxedRange = 16;  // positions of shorter ranges are all looked at

void split(MienFitSurface& s, size_t begin, size_t end) {
  while (begin < end) {
    const size_t middle = begin + (end - begin) / 2;
    float* const box = s.boxes.data + middle * kBoxFloats;
    for (size_t k = 0; k < 3; ++k) {
      box[k] = box[6 + k] = HUGE_VALF;
      box[3 + k] = box[9 + k] = -HUGE_VALF;
    }
    for (size_t i = begin; i < end; ++i) {
      const float* p = s.positions.data + size_t{s.order[i]} * 3;
      const float* n = s.normals.data + size_t{s.order[i]} * 3;
      for (size_t k = 0; k < 3; ++k) {
        box[k] = std::min(box[k], p[k]), box[3 + k] = std::max(box[3 + k], p[k]);
        box[6 + k] = std::min(box[6 + k], n[k]), box[9 + k] = std::max(box[9 + k], n[k]);
      }
    }
    uint8_t axis = 0;
    for (uint8_t k = 1; k < 3; ++k) {
      if (box[3 + k] - box[k] > box[3 + axis] - box[axis]) axis = k;
    }
    std::nth_element(s.order.data + begin, s.order.data + middle, s.order.data + end,
                     [&](uint32_t a, uint32_t b) {
                       const float x = s.positions[size_t{a} * 3 + axis];
                       const float y = s.positions[size_t{b} * 3 + axis];
                       return x != y ? x < y : a < b;
                     });
    s.axes[middle] = axis;
    split(s, begin, middle);
    begin = middle + 1;
  }
}

struct Search {
  const MienFitSurface& surface;
  Point3 point, normal;
  double squared;  // of the best so far
  uint32_t best = UINT32_MAX;

  /// Whether the range of a box may have a nearer position that faces the same way. Rounded like distances, so that
  /// it leaves out none. Planes alone do not: a surface that is far away, or near but turned away, has all of its
  /// positions on both sides of them.
  bool may_have(const float* box) const {
    const double at[3] = {point.x, point.y, point.z}, way[3] = {normal.x, normal.y, normal.z};
    double out[3], same[3];
    for (size_t k = 0; k < 3; ++k) {
      out[k] = std::max({double{box[k]} - at[k], at[k] - double{box[3 + k]}, 0.0});
      same[k] = std::max(way[k] * double{box[6 + k]}, way[k] * double{box[9 + k]});
    }
    if (out[0] * out[0] + out[1] * out[1] + out[2] * out[2] >= squared) return false;
    return dot(normal, normal) == 0 || same[0] + same[1] + same[2] >= kFacesTheSameWay;
  }

  void visit(size_t begin, size_t end) {
    while (begin < end) {
      const size_t middle = begin + (end - begin) / 2;
      if (end - begin >= kBoxedRange && !may_have(surface.boxes.data + middle * kBoxFloats)) return;
      const uint32_t at = surface.order[middle];
      const Point3 p = point_of(surface.positions.data + size_t{at} * 3);
      const Point3 d = point - p;
      const double distance = dot(d, d);
      const bool faces =
          dot(normal, normal) == 0 ||
          dot(normal, point_of(surface.normals.data + size_t{at} * 3)) >= kFacesTheSameWay;
      if (faces && distance < squared) squared = distance, best = at;
      if (end - begin == 1) return;
      const uint8_t axis = surface.axes[middle];
      const double side = axis == 0 ? d.x : axis == 1 ? d.y : d.z;
      // The half that has the point, then the other one if it may have a nearer one.
      if (side < 0) {
        visit(begin, middle);
        begin = middle + 1;
      } else {
        visit(middle + 1, end);
        end = middle;
      }
      if (side * side >= squared) return;
    }
  }
};

MienStatus check_surface(const MienFitSurfaceDesc& desc, MienError* error) {
  if ((desc.position_count != 0 && !desc.positions) ||
      (desc.triangle_count != 0 && !desc.triangles)) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT,
                      "MienFitSurfaceDesc has a count for an array that is NULL");
  }
  if (desc.triangle_count == 0 || desc.position_count > UINT32_MAX ||
      desc.triangle_count > UINT32_MAX / 3) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienFitSurfaceDesc has %zu triangles and %zu positions", desc.triangle_count,
                      desc.position_count);
  }
  for (size_t i = 0; i < desc.position_count * 3; ++i) {
    if (std::isfinite(desc.positions[i])) continue;
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienFitSurfaceDesc.positions[%zu] is not finite", i / 3);
  }
  for (size_t i = 0; i < desc.triangle_count * 3; ++i) {
    if (desc.triangles[i] < desc.position_count) continue;
    return give_error(error, MIEN_ERROR_INDEX,
                      "MienFitSurfaceDesc.triangles[%zu] has position %u of %zu", i / 3,
                      desc.triangles[i], desc.position_count);
  }
  return MIEN_OK;
}

void place(const MienFitSurfaceDesc& desc, Placer& placer, MienFitSurface& s) {
  placer.array<MienFitSurface>(1);
  s.positions = placer.array<float>(desc.position_count * 3);
  s.normals = placer.array<float>(desc.position_count * 3);
  s.triangles = placer.array<uint32_t>(desc.triangle_count * 3);
  s.first_around = placer.array<uint32_t>(desc.position_count + 1);
  s.around = placer.array<uint32_t>(desc.triangle_count * 3);
  s.borders = placer.array<uint8_t>(desc.position_count);
  s.order = placer.array<uint32_t>(desc.position_count);
  s.axes = placer.array<uint8_t>(desc.position_count);
  s.boxes = placer.array<float>(desc.position_count * kBoxFloats);
}

/// Triangles between one position of each place. `first_around` is scratch: the position to use.
void join_positions(const MienFitSurfaceDesc& desc, MienFitSurface& s) {
  const size_t count = desc.position_count;
  const auto compare = [&](uint32_t a, uint32_t b) {
    const float *p = s.positions.data + size_t{a} * 3, *q = s.positions.data + size_t{b} * 3;
    for (int k = 0; k < 3; ++k) {
      if (p[k] != q[k]) return p[k] < q[k] ? -1 : 1;
    }
    return 0;
  };
  for (uint32_t i = 0; i < count; ++i) s.order[i] = i;
  std::sort(s.order.begin(), s.order.end(), [&](uint32_t a, uint32_t b) {
    const int sign = compare(a, b);
    return sign != 0 ? sign < 0 : a < b;
  });
  for (size_t i = 0; i < count; ++i) {
    const bool same = i != 0 && compare(s.order[i - 1], s.order[i]) == 0;
    s.first_around[s.order[i]] = same ? s.first_around[s.order[i - 1]] : s.order[i];
  }
  for (size_t i = 0; i < s.triangles.count; ++i) s.triangles[i] = s.first_around[desc.triangles[i]];
}

void list_triangles(MienFitSurface& s) {
  std::fill(s.first_around.begin(), s.first_around.end(), 0u);
  for (const uint32_t p : s.triangles) ++s.first_around[p + 1];
  for (size_t p = 0; p + 1 < s.first_around.count; ++p) s.first_around[p + 1] += s.first_around[p];
  // Each list is filled from its end.
  std::fill(s.order.begin(), s.order.end(), 0u);
  for (size_t i = s.triangles.count; i-- > 0;) {
    const uint32_t p = s.triangles[i];
    s.around[s.first_around[p + 1] - ++s.order[p]] = static_cast<uint32_t>(i / 3);
  }
}

/// At a border, a neighbor is in one of the triangles around a position; elsewhere each is in two.
bool is_border(const MienFitSurface& s, uint32_t position) {
  const uint32_t begin = s.first_around[position], end = s.first_around[position + 1];
  if (end - begin > kMostAround) return false;
  for (uint32_t i = begin; i < end; ++i) {
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t neighbor = s.triangles[s.around[i] * size_t{3} + k];
      if (neighbor == position) continue;
      uint32_t found = 0;
      for (uint32_t n = begin; n < end; ++n) {
        const uint32_t* corner = s.triangles.data + size_t{s.around[n]} * 3;
        found += corner[0] == neighbor || corner[1] == neighbor || corner[2] == neighbor;
      }
      if (found == 1) return true;
    }
  }
  return false;
}

void find_vertex_normals(MienFitSurface& s) {
  const double sign =
      signed_volume(s.positions.data, s.triangles.data, s.triangles.count / 3) < 0 ? -1 : 1;
  size_t used = 0;
  for (uint32_t p = 0; p + 1 < s.first_around.count; ++p) {
    Point3 sum = {0, 0, 0};
    for (uint32_t i = s.first_around[p]; i < s.first_around[p + 1]; ++i) {
      const uint32_t* corner = s.triangles.data + size_t{s.around[i]} * 3;
      const Point3 a = point_of(s.positions.data + size_t{corner[0]} * 3);
      sum = along(sum,
                  cross(point_of(s.positions.data + size_t{corner[1]} * 3) - a,
                        point_of(s.positions.data + size_t{corner[2]} * 3) - a),
                  sign);
    }
    const double length = std::sqrt(dot(sum, sum)), scale = length > 0 ? 1 / length : 0;
    s.normals[size_t{p} * 3] = static_cast<float>(sum.x * scale);
    s.normals[size_t{p} * 3 + 1] = static_cast<float>(sum.y * scale);
    s.normals[size_t{p} * 3 + 2] = static_cast<float>(sum.z * scale);
    if (s.first_around[p] == s.first_around[p + 1]) continue;
    s.borders[p] = is_border(s, p);
    s.order[used++] = p;
  }
  s.order = s.order.first(used);
}

}  // namespace

namespace mien {

double signed_volume(const float* positions, const uint32_t* triangles, size_t triangle_count) {
  Point3 mean = {0, 0, 0};
  for (size_t i = 0; i < triangle_count * 3; ++i) {
    mean = along(mean, point_of(positions + size_t{triangles[i]} * 3), 1);
  }
  const double share = 1 / std::max(3.0 * static_cast<double>(triangle_count), 1.0);
  mean = {mean.x * share, mean.y * share, mean.z * share};
  double volume = 0;
  for (size_t t = 0; t < triangle_count; ++t) {
    Point3 corner[3];
    for (size_t k = 0; k < 3; ++k) {
      corner[k] = point_of(positions + size_t{triangles[3 * t + k]} * 3) - mean;
    }
    volume += dot(corner[0], cross(corner[1], corner[2]));
  }
  return volume;
}

bool find_nearest(const MienFitSurface& surface, const double* point, const double* normal,
                  double reach, SurfacePoint& out) {
  Search search = {surface, point_of(point), point_of(normal), reach * reach};
  search.visit(0, surface.order.count);
  if (search.best == UINT32_MAX) return false;
  // Of the triangles around the nearest position.
  double best = HUGE_VAL;
  for (uint32_t i = surface.first_around[search.best]; i < surface.first_around[search.best + 1];
       ++i) {
    const uint32_t* corner = surface.triangles.data + size_t{surface.around[i]} * 3;
    Point3 at[3];
    for (int k = 0; k < 3; ++k) at[k] = point_of(surface.positions.data + size_t{corner[k]} * 3);
    const Point3 found = nearest_on_triangle(search.point, at[0], at[1], at[2]);
    const Point3 d = search.point - found;
    if (!(dot(d, d) < best)) continue;
    best = dot(d, d);
    out.position[0] = found.x;
    out.position[1] = found.y;
    out.position[2] = found.z;
  }
  for (int k = 0; k < 3; ++k) {
    out.normal[k] = surface.normals[size_t{search.best} * 3 + static_cast<size_t>(k)];
  }
  out.border = surface.borders[search.best] != 0;
  return true;
}

}  // namespace mien

MienStatus mien_fit_surface_create(const MienFitSurfaceDesc* desc, MienFitSurface** out_surface,
                                   MienError* error) {
  if (MienStatus status = clear_output(out_surface, error)) return status;
  if (!desc) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "desc is NULL");
  MienFitSurfaceDesc known;
  if (MienStatus status = read_desc(desc, known, "MienFitSurfaceDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  if (MienStatus status = check_surface(known, error)) return status;
  MienFitSurface measured;
  Placer sizes(nullptr);
  place(known, sizes, measured);
  void* block = allocator.get(sizes.size(), kBlockAlignment);
  if (!block) {
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for a surface of %zu bytes",
                      sizes.size());
  }
  Placer placer(block);
  place(known, placer, measured);
  auto* const surface = new (block) MienFitSurface(measured);
  surface->allocator = allocator;
  surface->block_size = sizes.size();
  std::copy(known.positions, known.positions + known.position_count * 3, surface->positions.data);
  join_positions(known, *surface);
  list_triangles(*surface);
  find_vertex_normals(*surface);
  split(*surface, 0, surface->order.count);
  surface->tag = kFitSurfaceTag;
  *out_surface = surface;
  return succeed(error);
}

void mien_fit_surface_destroy(MienFitSurface* surface) {
  if (check_tag(surface, kFitSurfaceTag) != MIEN_OK) return;
  surface->tag = 0;
  const Allocator allocator = surface->allocator;
  allocator.put(surface, surface->block_size, kBlockAlignment);
}
