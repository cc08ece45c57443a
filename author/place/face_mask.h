// SPDX-License-Identifier: MIT
// The places where facial bones are put: the front group in depth, without the neck.
#pragma once

#include "author/mesh/topology.h"
#include "author/place/place.h"

namespace mien::author {

/// The data that the steps of the placement share.
struct Placing {
  const AuthorMesh& mesh;
  const PlaceOptions& options;
  const ParallelFor& parallel;
  Arena& arena;    // results
  Arena& scratch;  // freed when the placement is done
  PlaceReport& report;
  Error& error;

  Box box = {};            // of the skin
  double plane = 0;        // x of the plane of symmetry
  bool has_mouth = false;  // lips are apart
  Throat profile = {};     // nose and notch below it, also where no neck is cut off
  bool symmetric = false;
  bool paired = false;  // or nearly so: bones are in pairs, but each lies where its side is
  Span<uint32_t> skin =
      {};  // places (first vertices) of the skin, sorted by z, y, x, not in the order of the file
  Span<Vec3> points = {};      // their positions
  Span<double> areas = {};     // per vertex
  Span<uint8_t> group = {};    // per place: 0 front; empty with a face only
  Span<uint8_t> in_mask = {};  // per place
  Span<uint32_t> mask = {};    // places of the mask, numbers in `skin`
};

/// Sorts the places of the skin.
Status find_skin(Placing& placing);
/// Groups in depth.
Status group_in_depth(Placing& placing);
/// Fills the mask.
Status find_mask(Placing& placing);
/// Decides whether left and right are treated as mirror images, or as pairs of unlike halves.
Status find_symmetry(Placing& placing);
/// The trunk of the skeleton.
struct Body {
  static constexpr uint32_t kMaxNecks = 3;
  Vec3 chest, necks[kMaxNecks], head;
  uint32_t neck_count = 1;
  NeckCut cut;
};
Status find_body(Placing& placing, Body& out);

inline Status no_memory(Placing& placing) {
  return fail(placing.error, Status::kMemory, kNoOffset, "no memory for placing bones");
}

}  // namespace mien::author
