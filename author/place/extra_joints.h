// SPDX-License-Identifier: MIT
// Joints for rigid parts: the eyeballs, and the jaw if a shape opens it.
#pragma once

#include "author/mesh/author_mesh.h"
#include "runtime/base/arena.h"

namespace mien::author {

struct Sphere {
  Vec3 center;
  double radius = 0;
  double error = 0;  // root mean square distance of the points from it
};
/// Least squares. False if the points do not determine a sphere.
bool fit_sphere(Span<const Vec3> points, Sphere& out);

struct RigidMotion {
  double rotation[3][3];
  Vec3 shift;        // p -> rotation p + shift
  double angle = 0;  // degrees

  Vec3 operator()(Vec3 p) const {
    const auto& r = rotation;
    return Vec3{dot({r[0][0], r[0][1], r[0][2]}, p), dot({r[1][0], r[1][1], r[1][2]}, p),
                dot({r[2][0], r[2][1], r[2][2]}, p)} +
           shift;
  }
};
/// The rigid motion that brings `from` nearest to `to`, by least squares (Horn 1987). Weights: empty for
/// 1 each.
RigidMotion fit_rigid(Span<const Vec3> from, Span<const Vec3> to, Span<const double> weights = {});

struct Eye {
  Vec3 center;
  double radius = 0;
  int side = 0;      // 1: x above the plane, -1: below, 0: in the middle
  double error = 0;  // rms distance of its surface from the sphere
};
constexpr uint32_t kMaxEyes = 8;

/// Eyeballs: components that cover most of a sphere of the size of an eye. Concentric shells are
/// one eye. `eye_of_component` gets the eye of each component, or kNone. False if memory ran out.
bool find_eyes(const AuthorMesh& mesh, double plane, bool symmetric, Arena& scratch,
               Eye (&eyes)[kMaxEyes], uint32_t& count, Span<uint32_t> eye_of_component);

struct Jaw {
  bool found = false;
  bool by_teeth = false;  // not by the chin
  Vec3 position;
  double angle = 0;  // degrees
  uint32_t shape = 0;
  double chin_motion = 0;   // mean displacement of the positions that move most
  RigidMotion motion = {};  // of that
};
/// Finds the jaw by the shape named like jawOpen: its rigid motion is the one that fits most of the lower
/// teeth and of everything that moves with them; without teeth, that of the chin. False if memory ran out.
bool find_jaw(const AuthorMesh& mesh, double plane, Arena& scratch, Jaw& out);

/// A component of its own, called tongue or moved by shapes of that name.
struct Tongue {
  static constexpr int kJoints = 3;
  uint32_t component = kNone;  // kNone: there is none
  Vec3 joints[kJoints];        // root first
};
/// False if memory ran out.
bool find_tongue(const AuthorMesh& mesh, Arena& scratch, Tongue& out);

/// The number of the shape that opens the jaw by its name, or kNone.
uint32_t jaw_open_shape(const AuthorMesh& mesh);

}  // namespace mien::author
