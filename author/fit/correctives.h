// SPDX-License-Identifier: MIT
// Correctives: what a rig adds when several expressions are active together.
//
// The product of the controls of its members activates a corrective. Correctives with few members
// are fitted first: each takes up the error that remains at its pose while its members and all
// smaller correctives of theirs are active.
#pragma once

#include "author/fit/regions.h"
#include "author/fit/targets.h"

namespace mien::author {

struct Combination {
  Name name;
  Span<const uint32_t> members;     // expressions, ascending
  Span<const Vec3f> displacements;  // of the pose with all members at 1, from neutral; empty:
                                    // the damped sum of both members
};

constexpr size_t kMaxMembers = 8;

/// Shapes whose name is made of names of two to kMaxMembers other shapes, with _ or + between, are
/// combinations, in the order of their number of members; the others are `expressions`, as are
/// combinations of combinations and those with the same members as another one. False if memory ran
/// out.
bool find_combinations(Span<const Shape> shapes, Arena& arena, Span<Shape>& expressions,
                       Span<Combination>& combinations);

/// Pairs of expressions that move the same places in the same direction, those with the largest sum
/// of products of displacements first, at most `limit`. Appended to `combinations`, except pairs
/// that it has already.
bool add_overlaps(const AuthorMesh& mesh, uint32_t limit, const ParallelFor& parallel, Arena& arena,
                  Arena& scratch, Span<Combination>& combinations);

struct CorrectiveReport {
  uint32_t given = 0, made = 0;  // from combination shapes; from overlaps
  double before = 0;             // error at the poses of the given ones, without them
  double joints = 0, rig = 0;    // with their joints; with their blend shapes
};

struct CorrectiveInput {
  Fitter& fitter;
  const AuthorMesh& mesh;  // with expressions as its shapes
  const Placement& placement;
  const SkinWeights& weights;
  const JointRegions& regions;
  Span<const Combination> combinations;
  double least_effect = 0;  // of an entry of the matrix: a length
  double threshold = 0;     // of offsets of blend shapes; negative: no blend shapes
  ParallelFor parallel;
};

/// `deltas` and `targets` hold those of the expressions; those of the combinations are appended.
/// False if memory ran out.
bool fit_correctives(const CorrectiveInput& input, Arena& arena, const Allocator& allocator,
                     const JointDeltas& deltas, Span<Target> targets, CorrectiveReport& report);

}  // namespace mien::author
