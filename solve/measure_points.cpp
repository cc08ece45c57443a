// SPDX-License-Identifier: MIT
// The metric of points, P^T P, where P are their derivatives by all controls at the neutral pose: of all points, as many
// at a time as keep P small.
//
//     positions that a part of the points reads -> their deformer -> derivatives, kDirections controls at a time
//     -> effects [control][point of the part][axis] -> sums of products, over few rows of P at a time: only controls
//     that move one of these points take part
#include <algorithm>
#include <cstring>

#include "solve/fit.h"

namespace mien {
namespace {

constexpr size_t kPartBytes = 32u << 20;  // of effects
constexpr size_t kLeastPart = 256;        // points

/// A part of the points, and memory for it.
struct Part {
  Span<uint32_t> positions;  // of a mesh that its points read, ascending
  Span<uint32_t> places;     // [point][3] in those of its mesh
  Span<float> directions;    // kDirections of [control]
  Span<float> moved;         // kDirections of [position][3]
  Span<float> effects;       // [control][point][3]
  Span<double> panel;        // [control that moves one of the points][kPanel]
  Span<uint32_t> active;     // these controls
};

/// Of the points on a mesh.
void list_part(const MienFit& fit, uint32_t mesh, size_t first, size_t count, Part& part,
               size_t& used) {
  uint32_t* end = part.positions.data;
  for (size_t i = 0; i < count; ++i) {
    const MienSolvePoint& point = fit.points[first + i];
    if (point.mesh == mesh) end = std::copy(point.positions, point.positions + 3, end);
  }
  const Span<uint32_t> all = part.positions.first(static_cast<size_t>(end - part.positions.data));
  std::sort(all.begin(), all.end());
  used = static_cast<size_t>(std::unique(all.begin(), all.end()) - all.begin());
  for (size_t i = 0; i < count; ++i) {
    if (fit.points[first + i].mesh != mesh) continue;
    for (size_t n = 0; n < 3; ++n) {
      part.places[3 * i + n] = static_cast<uint32_t>(
          std::lower_bound(all.begin(), all.begin() + used, fit.points[first + i].positions[n]) -
          all.begin());
    }
  }
}

/// Effects of all controls on those of `count` points from `first` on that are on a mesh. False if memory ran out.
bool measure_part(MienFit& fit, uint32_t mesh, const MienDeformer* whole, size_t first,
                  size_t count, Part& part) {
  const uint32_t of_rig = fit.meshes[mesh].mesh;
  size_t used = 0;
  list_part(fit, mesh, first, count, part, used);
  if (used == 0) return true;
  const MienAllocator allocator = {fit.allocator.user, fit.allocator.allocate,
                                   fit.allocator.release};
  MienDeformer* deformer = nullptr;
  if (mien_deformer_create_subset(whole, of_rig, part.positions.data, used, &allocator, &deformer,
                                  nullptr) != MIEN_OK) {
    return false;
  }
  MienDerivativesDesc desc = mien_derivatives_desc_default();
  desc.deformer = deformer;
  desc.allocator = &allocator;
  MienDerivatives* derivatives = nullptr;
  const bool made =
      mien_derivatives_create(fit.rig, &desc, &derivatives, nullptr) == MIEN_OK &&
      mien_derivatives_linearize(derivatives, fit.instance, MIEN_STAGE_ALL) == MIEN_OK;
  mien_deformer_destroy(deformer);
  for (size_t c = 0; made && c < fit.control_count; c += kDirections) {
    const size_t directions = std::min<size_t>(kDirections, fit.control_count - c);
    std::fill(part.directions.begin(), part.directions.end(), 0.0f);
    for (size_t k = 0; k < directions; ++k) part.directions[k * fit.control_count + c + k] = 1;
    static_cast<void>(mien_derivatives_forward(
        derivatives, MIEN_POINT_CONTROLS, MIEN_POINT_POSITIONS, of_rig,
        static_cast<uint32_t>(directions), part.directions.data, part.moved.data));
    for (size_t k = 0; k < directions; ++k) {
      const float* const moved = part.moved.data + k * used * 3;
      float* const effects = part.effects.data + (c + k) * count * 3;
      for (size_t i = 0; i < count; ++i) {
        const MienSolvePoint& point = fit.points[first + i];
        if (point.mesh != mesh) continue;
        if (is_position(point)) {
          const float* const from = moved + size_t{part.places[3 * i]} * 3;
          std::copy(from, from + 3, effects + 3 * i);
          continue;
        }
        double sum[3] = {};
        for (size_t n = 0; n < 3; ++n) {
          const float* const from = moved + size_t{part.places[3 * i + n]} * 3;
          for (size_t axis = 0; axis < 3; ++axis)
            sum[axis] += double{point.weights[n]} * from[axis];
        }
        for (size_t axis = 0; axis < 3; ++axis) {
          effects[3 * i + axis] = static_cast<float>(sum[axis]);
        }
      }
    }
  }
  mien_derivatives_destroy(derivatives);
  return made;
}

/// Tested as bits, which is faster; -0 counts as something.
bool is_zero(const float* row, size_t count) {
  uint64_t any = 0, two;
  size_t i = 0;
  for (; i + 2 <= count; i += 2) {
    std::memcpy(&two, row + i, sizeof two);
    any |= two;
  }
  return any == 0 && (i == count || row[i] == 0);
}

/// Adds the products of all pairs of controls over rows of P, to the lower triangle of the metric.
void add_products(MienFit& fit, size_t row_count, const Part& part) {
  for (size_t first = 0; first < row_count; first += kPanel) {
    const size_t rows = std::min(kPanel, row_count - first);
    size_t active = 0;
    for (uint32_t c = 0; c < fit.control_count; ++c) {
      const float* const from = part.effects.data + c * row_count + first;
      if (is_zero(from, rows)) continue;
      double* const to = part.panel.data + active * kPanel;
      std::fill(std::copy(from, from + rows, to), to + kPanel, 0.0);
      part.active[active++] = c;
    }
    for_each_product(part.panel.data, active, [&](size_t a, size_t b, double sum) {
      fit.point_metric[size_t{part.active[a]} * fit.control_count + part.active[b]] += sum;
    });
  }
}

}  // namespace

bool measure_points(MienFit& fit, Span<const MienDeformer*> deformers, Arena& arena) {
  const size_t controls = fit.control_count;
  const size_t size = std::min(
      fit.points.count, std::max(kLeastPart, kPartBytes / sizeof(float) / 3 / (controls + 1)));
  Part part;
  part.positions = arena.array<uint32_t>(size * 3);
  part.places = arena.array<uint32_t>(size * 3);
  part.directions = arena.array<float>(kDirections * controls);
  part.moved = arena.array<float>(kDirections * std::min(size * 3, fit.position_count) * 3);
  part.effects = arena.array<float>(controls * size * 3);
  part.panel = arena.array<double>(controls * kPanel);
  part.active = arena.array<uint32_t>(controls);
  if (!part.positions.data || !part.places.data || !part.directions.data || !part.moved.data ||
      !part.effects.data || !part.panel.data || !part.active.data) {
    return controls == 0;
  }
  size_t sample = 0;
  for (size_t first = 0; first < fit.points.count; first += size) {
    const size_t count = std::min(size, fit.points.count - first);
    for (uint32_t m = 0; m < fit.meshes.count; ++m) {
      if (!measure_part(fit, m, deformers[m], first, count, part)) return false;
    }
    add_products(fit, count * 3, part);
    for (; sample < fit.samples.count && fit.samples[sample] < first + count; ++sample) {
      for (size_t c = 0; c < controls; ++c) {
        const float* const from = part.effects.data + (c * count + fit.samples[sample] - first) * 3;
        std::copy(from, from + 3, fit.sample_effects.data + (c * fit.samples.count + sample) * 3);
      }
    }
  }
  for (size_t a = 0; a < controls; ++a) {
    for (size_t b = 0; b < a; ++b) {
      fit.point_metric[b * controls + a] = fit.point_metric[a * controls + b];
    }
  }
  return true;
}

}  // namespace mien
