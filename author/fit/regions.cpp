// SPDX-License-Identifier: MIT
#include "author/fit/regions.h"

#include <algorithm>

#include "author/base/dna_making.h"

namespace mien::author {

bool link_by_distance(Span<double> matrix, uint32_t count, uint32_t groups, Arena& scratch,
                      uint16_t* out) {
  Span<uint32_t> size, nearest, group;
  if (!make(scratch, count, size) || !make(scratch, count, nearest) ||
      !make(scratch, count, group)) {
    return false;
  }
  const auto distance = [&](uint32_t a, uint32_t b) -> double& {
    return matrix[size_t{a} * count + b];
  };
  // The nearest later group of each group, so that each pair is considered once.
  const auto find_nearest = [&](uint32_t i) {
    nearest[i] = count;
    for (uint32_t k = i + 1; k < count; ++k) {
      if (size[k] == 0) continue;
      if (nearest[i] == count || distance(i, k) < distance(i, nearest[i])) nearest[i] = k;
    }
  };
  for (uint32_t i = 0; i < count; ++i) {
    size[i] = 1;
    group[i] = i;
  }
  for (uint32_t i = 0; i < count; ++i) find_nearest(i);
  for (uint32_t left = count; left > groups; --left) {
    uint32_t a = count;
    for (uint32_t i = 0; i < count; ++i) {
      if (size[i] == 0 || nearest[i] == count) continue;
      if (a == count || distance(i, nearest[i]) < distance(a, nearest[a])) a = i;
    }
    const uint32_t b = nearest[a];
    for (uint32_t k = 0; k < count; ++k) {
      if (size[k] == 0 || k == a || k == b) continue;
      const double mean =
          (size[a] * distance(a, k) + size[b] * distance(b, k)) / (size[a] + size[b]);
      distance(a, k) = mean;
      distance(k, a) = mean;
    }
    size[a] += size[b];
    size[b] = 0;
    for (uint32_t i = 0; i < count; ++i) {
      if (group[i] == b) group[i] = a;
      // Distances to the merged group have changed, so the nearest groups may have changed, too.
      if (i <= b && size[i] != 0) find_nearest(i);
    }
  }
  Span<uint32_t> number = nearest;
  uint32_t used = 0;
  for (uint32_t i = 0; i < count; ++i) {
    if (group[i] == i) number[i] = used++;
  }
  for (uint32_t i = 0; i < count; ++i) out[i] = static_cast<uint16_t>(number[group[i]]);
  return true;
}

namespace {

/// Of a bone and its mirror image, the one with the larger x.
bool is_left(const Placement& placement, uint32_t j) {
  const uint32_t other = placement.bones[j].mirror;
  const double x = placement.bones[j].position.x, y = placement.bones[other].position.x;
  return x != y ? x > y : j < other;
}

/// A mixture of distance and of the difference of translations over all controls.
bool measure_bones(const Placement& placement, const Motions& motions, Span<const uint32_t> bones,
                   Arena& scratch, Span<double>& out) {
  const size_t n = bones.count, controls = motions.items.count / motions.bone_count;
  Span<double> profiles, unlike;
  if (!make(scratch, n * n, out) || !make(scratch, n * n, unlike) ||
      !make(scratch, n * controls, profiles)) {
    return false;
  }
  for (size_t i = 0; i < n; ++i) {
    const Vec3 at = placement.bones[bones[i]].position;
    double squares = 0;
    for (size_t s = 0; s < controls; ++s) {
      double& value = profiles[i * controls + s];
      value = length(motions.of(s)[bones[i]](at) - at);
      squares += value * value;
    }
    const double scale = squares > 0 ? 1 / std::sqrt(squares) : 0;
    for (size_t s = 0; s < controls; ++s) profiles[i * controls + s] *= scale;
  }
  double distances = 0, differences = 0;
  for (size_t i = 0; i < n; ++i) {
    for (size_t k = 0; k < i; ++k) {
      double cosine = 0;
      for (size_t s = 0; s < controls; ++s) {
        cosine += profiles[i * controls + s] * profiles[k * controls + s];
      }
      out[i * n + k] =
          length(placement.bones[bones[i]].position - placement.bones[bones[k]].position);
      unlike[i * n + k] = 1 - cosine;
      distances += out[i * n + k];
      differences += 1 - cosine;
    }
  }
  const double pairs = static_cast<double>(n * (n - 1) / 2);
  const double a = distances > 0 ? 0.6 * pairs / distances : 0;
  const double b = differences > 0 ? 0.4 * pairs / differences : 0;
  for (size_t i = 0; i < n; ++i) {
    for (size_t k = 0; k < i; ++k) {
      out[i * n + k] = a * out[i * n + k] + b * unlike[i * n + k];
      out[k * n + i] = out[i * n + k];
    }
  }
  return true;
}

}  // namespace

namespace {

/// Jaw and eyes move with few controls, so each has a region of its own.
void add_rigid_bones(const Footprints& footprints, JointRegions& out) {
  for (uint32_t j = 0; j < footprints.bone_count; ++j) {
    if (!footprints.fitted[j] || footprints.facial[j]) continue;
    if (out.count < kMaxOwnRegions) ++out.count;
    out.region[j] = static_cast<uint16_t>(out.count - 1);
  }
}

}  // namespace

bool find_regions(const Placement& placement, const Footprints& footprints, const Motions& motions,
                  uint32_t wanted, Arena& arena, const Allocator& allocator, JointRegions& out) {
  Arena scratch(allocator);
  const Span<const Bone> bones = placement.bones;
  Span<uint32_t> half, middle;  // bones of the left side, or all; bones on the plane
  Span<uint16_t> group;
  if (!make(arena, bones.count, out.region) || !make(scratch, bones.count, half) ||
      !make(scratch, bones.count, middle) || !make(scratch, bones.count, group)) {
    return false;
  }
  uint32_t halves = 0, middles = 0, fitted = 0;
  for (uint32_t j = 0; j < bones.count; ++j) {
    out.region[j] = JointRegions::kNoRegion;
    if (!footprints.facial[j]) continue;
    ++fitted;
    if (!placement.symmetric) {
      half[halves++] = j;
    } else if (bones[j].mirror == j) {
      middle[middles++] = j;
    } else if (is_left(placement, j)) {
      half[halves++] = j;
    }
  }
  out.count = 0;
  if (fitted == 0) {
    add_rigid_bones(footprints, out);
    return true;
  }
  if (wanted == 0) wanted = std::max(6 * fitted / kRowsPerGroup, 1u);
  wanted = std::min(wanted, kMaxRegions);

  // Bones on the plane get their own region if there are many; otherwise they join a neighbor.
  const bool own_middle = middles > 6;
  if (wanted == 1 || halves == 0) {
    for (uint32_t j = 0; j < bones.count; ++j) {
      if (footprints.facial[j]) out.region[j] = 0;
    }
    out.count = 1;
    add_rigid_bones(footprints, out);
    return true;
  }
  uint32_t groups = wanted;
  if (placement.symmetric) groups = (wanted - (own_middle && wanted > 1)) / 2;
  groups = std::min(std::max(groups, 1u), halves);
  Span<double> matrix;
  if (!measure_bones(placement, motions, half.first(halves), scratch, matrix) ||
      !link_by_distance(matrix, halves, groups, scratch, group.data)) {
    return false;
  }
  for (uint32_t i = 0; i < halves; ++i) {
    out.region[half[i]] = group[i];
    if (placement.symmetric) {
      out.region[bones[half[i]].mirror] = static_cast<uint16_t>(groups + group[i]);
    }
  }
  out.count = placement.symmetric ? 2 * groups : groups;
  for (uint32_t i = 0; i < middles; ++i) {
    uint32_t nearest = half[0];
    for (uint32_t k = 1; k < halves; ++k) {
      const Vec3 at = bones[middle[i]].position;
      const double d = length(bones[half[k]].position - at);
      if (d < length(bones[nearest].position - at)) nearest = half[k];
    }
    out.region[middle[i]] = own_middle ? static_cast<uint16_t>(out.count) : out.region[nearest];
  }
  out.count += own_middle && middles > 0;
  add_rigid_bones(footprints, out);
  return true;
}

bool take_regions(const Placement& placement, Span<const uint8_t> own, Arena& arena,
                  JointRegions& out) {
  const Span<const Bone> bones = placement.bones;
  if (!make(arena, bones.count, out.region)) return false;
  bool used[kMaxOwnRegions] = {};
  for (size_t j = 0; j < bones.count; ++j) used[own[j]] |= is_fitted(bones[j]);
  uint16_t number[kMaxOwnRegions];
  out.count = 0;
  for (uint32_t r = 0; r < kMaxOwnRegions; ++r) {
    number[r] = static_cast<uint16_t>(out.count);
    out.count += used[r];
  }
  for (size_t j = 0; j < bones.count; ++j) {
    out.region[j] = is_fitted(bones[j]) ? number[own[j]] : JointRegions::kNoRegion;
  }
  return true;
}

double effect_of(const Bone& bone, const Moments& moments, const Affine& motion) {
  const Vec3 shift = motion(bone.position) - bone.position;
  if (!(moments.mass > 0)) return length(shift);
  const Vec3 offset = moments.center - bone.position;
  const double arm = moments.size() / moments.mass + dot(offset, offset);
  // Of a rotation by the angle a, 1 + 2 cos(a) is the trace; a^2 is 2 (1 - cos(a)) for small ones.
  const double trace = motion.rows[0].x + motion.rows[1].y + motion.rows[2].z;
  return std::sqrt(dot(shift, shift) + std::max(3 - trace, 0.0) * arm);
}

PruneReport prune(const Placement& placement, const Footprints& footprints,
                  const JointRegions& regions, double least_effect, bool full, size_t control,
                  const Motions& motions) {
  const Span<Affine> moves = motions.of(control);
  const Span<uint8_t> active = motions.active_in(control);
  double all = 0;
  double of_region[kMaxOwnRegions] = {};
  // Of the bone itself, after its parent has moved.
  const auto effect = [&](uint32_t j) {
    const Bone& bone = placement.bones[j];
    return effect_of(bone, footprints.moved_by(j), inverse(moves[bone.parent]) * moves[j]);
  };
  for (uint32_t j = 0; j < moves.count; ++j) {
    if (!active[j]) continue;
    const double e = effect(j);
    of_region[regions.region[j]] += e * e;
    all += e * e;
  }
  // Parents last: what they do is measured against.
  PruneReport report;
  for (uint32_t j = static_cast<uint32_t>(moves.count); j-- > 0;) {
    if (!footprints.fitted[j]) continue;
    const bool owned = all > 0 && of_region[regions.region[j]] >= kOwnedShare * all;
    if (active[j]) {
      const bool is_faint = effect(j) < least_effect;
      report.outliers += !owned;
      report.faint += owned && is_faint;
      if (!owned || is_faint) {
        active[j] = 0;
        moves[j] = Affine::identity();
      }
    }
    if (full && owned && footprints.facial[j]) active[j] = 1;
  }
  follow_parents(footprints, active, moves);
  return report;
}

}  // namespace mien::author
