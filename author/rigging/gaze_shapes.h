// SPDX-License-Identifier: MIT
// Expressions that turn the eyes: those of the input, completed where they only move lids, and new ones
// where there are none. So every rig with eyes can look around.
#pragma once

#include "author/mesh/author_mesh.h"
#include "runtime/base/arena.h"

namespace mien::author {

/// To the character's left and right, up and down.
enum GazeWay : uint32_t { kLookLeft, kLookRight, kLookUp, kLookDown, kGazeWays };

/// Where a control that turns an eye comes from.
enum class GazeSource : uint8_t {
  kNoControl,  // there is none
  kShape,      // a shape turns the eyeball
  kCompleted,  // a shape of that name did not turn the eyeball: its rotation was added
  kAdded       // no such shape: eyeball and lids were added
};

struct GazeEye {
  uint32_t bone = kNone;
  Name controls[kGazeWays];
  GazeSource sources[kGazeWays] = {};
};

struct GazeReport {
  GazeEye eyes[2];  // left, right; without a bone if there is no such eye
};

/// The meaning of a name like eyeLookOutLeft, EyeLookUp_R, eyeLookLeftL or lookDown. A name without a side
/// means both eyes. False if the name has nothing to do with the gaze.
struct GazeName {
  bool of_eye[2] = {true, true};  // left, right
  bool is_inward = false, is_outward = false;
  GazeWay way = kLookLeft;  // if neither

  GazeWay way_of(uint32_t eye) const {
    if (is_inward || is_outward) return (eye == 0) == is_outward ? kLookLeft : kLookRight;
    return way;
  }
};
bool read_gaze_name(Name name, GazeName& out);

/// Completes and adds expressions for the left and the right eye of `placement`, if they are eyeballs of the
/// mesh. `mesh` gets a new list of shapes in `arena`; shapes that need nothing are kept. New ones have the names of
/// ARKit, or those of MetaHuman's raw controls. False if memory ran out.
bool add_gaze_shapes(const Placement& placement, bool metahuman_names, Arena& arena,
                     const Allocator& allocator, AuthorMesh& mesh, GazeReport& report);

}  // namespace mien::author
