// SPDX-License-Identifier: MIT
#include "integrations/program/commands/solve_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "integrations/program/commands/moving_mesh.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

using math::Vec3d;

constexpr double kMostTimes = 5;
constexpr size_t kMostSeen = 2000, kLeastSeen = 10;  // points of a frame
constexpr double kOtherAxes = 3;                     // times nearer with other axes
constexpr double kPlain = 0.1;                       // of the size, that own axes are off at least

/// One of each run of `count` points, not always the same: a stride may follow the rows of a mesh, or wrong points.
std::vector<size_t> sample(size_t count) {
  std::vector<size_t> chosen;
  const size_t step = 1 + count / kMostSeen;
  uint32_t random = 1;
  for (size_t i = 0; i < count; i += step) {
    random = random * 1664525u + 1013904223u;
    chosen.push_back(i + (random >> 8) % std::min(step, count - i));
  }
  return chosen;
}

/// What four fifths of the points span along each axis: some wrong ones do not count.
Vec3d span_of(const std::vector<Vec3d>& points) {
  Vec3d span;
  std::vector<double> numbers(points.size());
  for (int k = 0; k < 3; ++k) {
    for (size_t i = 0; i < points.size(); ++i) numbers[i] = points[i][k];
    std::sort(numbers.begin(), numbers.end());
    span[k] = numbers[numbers.size() - 1 - numbers.size() / 10] - numbers[numbers.size() / 10];
  }
  return span;
}

std::string text_of(const Vec3d& span) {
  char text[96];
  std::snprintf(text, sizeof(text), "%.3g x %.3g x %.3g", span.x, span.y, span.z);
  return text;
}

/// Axes of a target, as those of the rig: 1 is x, -3 is -z.
using Axes = std::array<int, 3>;

std::vector<Axes> list_axes() {
  std::vector<Axes> all;
  Axes order = {1, 2, 3};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Axes axes = order;
      for (int k = 0; k < 3; ++k) axes[static_cast<size_t>(k)] *= signs >> k & 1 ? -1 : 1;
      all.push_back(axes);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return all;  // the rig's own axes first
}

Vec3d turned(const Vec3d& point, const Axes& axes) {
  Vec3d out;
  for (int k = 0; k < 3; ++k) {
    const int axis = axes[static_cast<size_t>(k)];
    out[k] = axis > 0 ? point[axis - 1] : -point[-axis - 1];
  }
  return out;
}

bool is_rotation(const Axes& axes) {
  const Vec3d x = turned({1, 0, 0}, axes), y = turned({0, 1, 0}, axes);
  return dot(cross(x, y), turned({0, 0, 1}, axes)) > 0;
}

struct Watch {
  const SolvedRig* rig;
  std::string shown, mesh_name, unit;
  size_t frame_count;
  bool turns;
  std::vector<float> rest;     // of the mesh
  std::vector<uint32_t> used;  // its vertices that count

  static Vec3d at(const float* row, size_t i) {
    return {double{row[3 * i]}, double{row[3 * i + 1]}, double{row[3 * i + 2]}};
  }
  [[noreturn]] void refuse(size_t frame, const std::string& why, const std::string& advice) const {
    const std::string place =
        frame_count > 1 ? shown + ", frame " + std::to_string(frame + 1) : shown;
    fail(kInvalid, "cannot solve", place, why, advice);
  }

  void check_size(size_t frame, const std::vector<Vec3d>& seen,
                  const std::vector<Vec3d>& own) const {
    const Vec3d span = span_of(seen), wanted = span_of(own);
    const double size = std::sqrt(dot(span, span)), right = std::sqrt(dot(wanted, wanted));
    if (!unit.empty() || right == 0) return;
    if (size <= kMostTimes * right && right <= kMostTimes * size) return;
    const RigSpace space(*rig);
    std::string advice = "scale it to the rig, or say its unit with --unit if its size is right";
    double nearest = 2;  // times the size
    for (const std::string& word : option_words("--unit")) {
      const double times = size * space.units_of(word) / right;
      const double off = times > 1 ? times : 1 / times;
      if (!(off < nearest)) continue;
      nearest = off;
      advice = "it seems to be in " + word + ": say so with --unit " + word;
    }
    const bool meters = space.info.translation_unit == MIEN_TRANSLATION_UNIT_METERS;
    refuse(frame,
           "four fifths of its points span " + text_of(span) + ", those of mesh " + mesh_name +
               " of the rig " + text_of(wanted) + (meters ? " m" : " cm"),
           advice);
  }

  void check_axes(size_t frame, const std::vector<Vec3d>& seen,
                  const std::vector<Vec3d>& own) const {
    if (turns) return;
    Vec3d middle, own_middle;
    const double share = 1 / static_cast<double>(seen.size());
    for (const Vec3d& p : seen) middle += p * share;
    for (const Vec3d& p : own) own_middle += p * share;
    double first = 0, best = HUGE_VAL, size = 0;
    Axes found{};
    for (const Axes& axes : list_axes()) {
      double sum = 0;
      for (size_t i = 0; i < seen.size(); ++i) {
        const Vec3d d = (seen[i] - middle) - turned(own[i] - own_middle, axes);
        sum += dot(d, d);
      }
      if (best == HUGE_VAL) first = sum;
      if (sum < best) best = sum, found = axes;
    }
    for (const Vec3d& p : own) size += dot(p - own_middle, p - own_middle);
    if (!(first > kPlain * kPlain * size && first > kOtherAxes * kOtherAxes * best)) return;
    std::string names;
    for (const int axis : found) {
      names += (names.empty() ? "" : ", ") + std::string(axis < 0 ? "-" : "") +
               "xyz"[std::abs(axis) - 1];
    }
    refuse(frame, "its axes are not the rig's: its x, y, z are " + names + " of the rig",
           is_rotation(found) ? "turn it to the axes of the rig, or add --rigid"
                              : "write it with the axes of the rig");
  }

  void see_vertices(size_t frame, const float* row) const {
    std::vector<Vec3d> seen, own;
    for (const size_t i : sample(used.size())) {
      const Vec3d p = at(row, used[i]);
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
      seen.push_back(p);
      own.push_back(at(rest.data(), used[i]));
    }
    if (seen.size() < kLeastSeen) return;
    check_size(frame, seen, own);
    check_axes(frame, seen, own);
  }

  void see_surface(size_t frame, const SurfaceMesh& mesh) const {
    std::vector<Vec3d> seen, own;
    for (const size_t i : sample(mesh.positions.size() / 3)) {
      seen.push_back(at(mesh.positions.data(), i));
    }
    for (const size_t i : sample(used.size())) own.push_back(at(rest.data(), used[i]));
    if (!seen.empty() && own.size() >= kLeastSeen) check_size(frame, seen, own);
  }
};

}  // namespace

void watch_space(const TargetOptions& options, bool rigid, const SolvedRig& rig,
                 SolveTarget& target) {
  if (target.kind != TargetKind::kVertices && target.kind != TargetKind::kSurface) return;
  const uint32_t mesh = target.points[0].mesh;
  auto watch = std::make_shared<Watch>();
  watch->rig = &rig;
  watch->shown = shown_name(options.path);
  watch->mesh_name = one_line(rig_name(rig.rig, MIEN_KIND_MESH, mesh));
  watch->unit = options.unit;
  watch->frame_count = target.frame_count;
  watch->turns = rigid;
  watch->rest = MovingMesh(rig, mesh).rest();
  for (uint32_t i = 0; i < target.points.size(); ++i) {
    if (target.weights.empty() || target.weights[i] > 0) watch->used.push_back(i);
  }
  if (target.kind == TargetKind::kSurface) {
    target.read_surface = [read = target.read_surface, watch](size_t frame) {
      SurfaceMesh surface = read(frame);
      watch->see_surface(frame, surface);
      return surface;
    };
    return;
  }
  target.read = [read = target.read, watch](size_t frame, float* row) {
    read(frame, row);
    watch->see_vertices(frame, row);
  };
}

}  // namespace mien::cli
