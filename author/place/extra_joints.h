// SPDX-License-Identifier: MIT
// Joints for what turns as a whole: eyeballs, and the jaw where a shape opens it.
#pragma once

#include "author/mesh/author_mesh.h"
#include "runtime/base/arena.h"

namespace mien::author {

struct Sphere {
  Vec3 center;
  double radius = 0;
  double error = 0;  // root mean square distance of the points from it
};
/// Least squares. False if the points do not tell a sphere.
bool fit_sphere(Span<const Vec3> points, Sphere& out);

struct RigidMotion {
  double rotation[3][3];
  Vec3 shift;        // p -> rotation p + shift
  double angle = 0;  // degrees
};
/// The rigid motion that brings `from` nearest to `to`, by least squares (Horn 1987).
RigidMotion fit_rigid(Span<const Vec3> from, Span<const Vec3> to);

struct Eye {
  Vec3 center;
  double radius = 0;
  int side = 0;  // 1: x above the plane, -1: below, 0: in the middle
};
constexpr uint32_t kMaxEyes = 8;

/// Eyeballs: components that are most of a sphere of the size of an eye. Several shells about one center
/// are one eye. `eye_of_component` gets the eye of each, or kNone. False if memory ran out.
bool find_eyes(const AuthorMesh& mesh, double plane, bool symmetric, Arena& scratch,
               Eye (&eyes)[kMaxEyes], uint32_t& count, Span<uint32_t> eye_of_component);

struct Jaw {
  bool found = false;
  Vec3 position;
  double angle = 0;  // degrees
  uint32_t shape = 0;
  double chin_motion = 0;  // mean displacement of what moves most
};
/// From the shape named like jawOpen. False if memory ran out.
bool find_jaw(const AuthorMesh& mesh, double plane, Arena& scratch, Jaw& out);

/// The number of the shape that opens the jaw by its name, or kNone.
uint32_t jaw_open_shape(const AuthorMesh& mesh);

}  // namespace mien::author
