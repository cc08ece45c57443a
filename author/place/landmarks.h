// SPDX-License-Identifier: MIT
// Points of a face that joints are placed by: found on the mesh, each with a confidence, or given by the
// caller.
#pragma once

#include "author/mesh/author_mesh.h"

namespace mien::author {

enum class LandmarkKind : uint8_t {
  kNose,      // tip
  kThroat,    // deepest point between chin and neck
  kLipUpper,  // middle of each lip, where it is in front
  kLipLower,
  kMouthLeft,  // corners
  kMouthRight,
  kChin,
  kJaw,      // axis of the jaw, in the middle between left and right
  kEyeLeft,  // centers of the eyeballs
  kEyeRight,
  kHead,  // pivots of head and neck
  kNeck
};
constexpr uint32_t kLandmarkCount = 12;

/// As callers and the report spell them: nose, lip_upper, mouth_l and so on.
constexpr const char* kLandmarkNames[kLandmarkCount] = {
    "nose", "throat", "lip_upper", "lip_lower", "mouth_l", "mouth_r",
    "chin", "jaw",    "eye_l",     "eye_r",     "head",    "neck"};

struct Landmark {
  bool known = false;
  bool given = false;     // by the caller, or the mirror image of one that was
  bool is_used = false;   // joints were placed by it
  double confidence = 0;  // 0 to 1; given: 1
  Vec3 at;
};

struct Landmarks {
  Landmark of[kLandmarkCount];

  Landmark& operator[](LandmarkKind kind) { return of[static_cast<size_t>(kind)]; }
  const Landmark& operator[](LandmarkKind kind) const { return of[static_cast<size_t>(kind)]; }

  bool is_given(LandmarkKind kind) const { return (*this)[kind].given; }
  /// Unless the caller gave it.
  void found(LandmarkKind kind, Vec3 at, double confidence) {
    Landmark& landmark = (*this)[kind];
    if (landmark.given) return;
    landmark.known = true;
    landmark.at = at;
    landmark.confidence = confidence < 0 ? 0 : confidence > 1 ? 1 : confidence;
  }
};

}  // namespace mien::author
