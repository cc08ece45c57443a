// SPDX-License-Identifier: MIT
#include "runtime/probe/probe_snaps.h"

#include <algorithm>
#include <cmath>

namespace mien {
namespace {

constexpr float kReach = 1.0f / 64;  // step over which speeds are measured: far above rounding
constexpr double kMargin = 1.05;     // margin for speeds between the values that are tried

/// One pose of a face, as positions of meshes or of joints.
struct Shape {
  RigProbe& probe;
  const Deformer& deformer;
  const Binding& binding;
  Span<float> values, gui, raw, before;

  void pose(uint32_t channel, float value) {
    std::fill(values.begin(), values.end(), 0.0f);
    values[channel] = value;
    probe.clear();
    std::copy(probe.row(), probe.row() + raw.count, raw.begin());
    apply_binding(binding, values, gui, raw);
    for (uint16_t c : binding.controls) probe.set(c, raw[c]);
    probe.pose();
  }
  /// Calls back with the coordinates of each point and its index in `before`.
  template <class Visit>
  void each(Visit visit) {
    size_t at = 0;
    const Span<uint16_t> meshes = probe.rig().lod_meshes.at(0);
    for (uint16_t mesh : meshes) {
      const Span<const float> positions = probe.positions(mesh);
      for (size_t i = 0; i + 2 < positions.count; i += 3, at += 3) visit(positions.data + i, at);
    }
    for (uint32_t j = 0; meshes.empty() && j < probe.rig().joint_count; ++j, at += 3) {
      visit(probe.joint(j) + 12, at);
    }
  }
  size_t size() {
    size_t count = 0;
    each([&count](const float*, size_t at) { count = at + 3; });
    return count;
  }
  void keep() {
    each([this](const float* from, size_t at) { std::copy(from, from + 3, before.data + at); });
  }
  /// The largest distance that a point has moved since keep().
  double moved() {
    double farthest = 0;
    each([&](const float* now, size_t at) {
      double square = 0;
      for (size_t k = 0; k < 3; ++k) {
        const double d = double{now[k]} - double{before[at + k]};
        square += d * d;
      }
      farthest = std::max(farthest, square);
    });
    return std::sqrt(farthest);
  }
};

bool drives(const Binding& binding, uint32_t channel) {
  for (uint16_t missing : binding.missing_channels) {
    if (missing == channel) return false;
  }
  return true;
}

uint8_t coarsest(double speed, double tolerance) {
  for (uint32_t n = kMinSnap; n <= kMaxSnap; ++n) {
    if (0.5 * speed / static_cast<double>(1u << n) <= tolerance) return static_cast<uint8_t>(n);
  }
  return kNoSnap;
}

}  // namespace

Status probe_snaps(const Deformer& deformer, const Binding& binding, float tolerance,
                   const Allocator& allocator, Span<uint8_t> snaps, Error& error) {
  RigProbe probe(deformer, allocator);
  Arena arena(allocator);
  Shape shape = {probe, deformer, binding, {}, {}, {}, {}};
  if (probe.ready()) {
    shape.values = arena.array<float>(binding.channel_count + 1);
    shape.gui = arena.array<float>(binding.gui_count + 1);
    shape.raw = arena.array<float>(binding.raw_count);
    probe.clear();
    probe.pose();
    shape.before = arena.array<float>(shape.size() + 1);
  }
  if (!shape.values.data || !shape.gui.data || (!shape.raw.data && binding.raw_count != 0) ||
      !shape.before.data) {
    return fail(error, Status::kMemory, kNoOffset, "no memory to try the channels on the rig");
  }
  const int first = binding.gui_count != 0 ? -4 : 0;
  for (uint32_t c = 0; c < binding.channel_count; ++c) {
    snaps[c] = kDefaultSnap;
    if (!drives(binding, c)) continue;
    double farthest = 0;
    for (int quarter = first; quarter <= 4; ++quarter) {
      const float value = static_cast<float>(quarter) / 4;
      shape.pose(c, value);
      shape.keep();
      // Towards 0, to stay within the range.
      shape.pose(c, value > 0 ? value - kReach : value + kReach);
      farthest = std::max(farthest, shape.moved());
    }
    const double speed = farthest * probe.millimeters() / double{kReach} * kMargin;
    snaps[c] = coarsest(speed, double{tolerance});
  }
  return Status::kOk;
}

}  // namespace mien
