// SPDX-License-Identifier: MIT
// Guesses for options of `mien author` that were not given: the axes of a mesh, its unit, and where the
// head of a whole body is.
#pragma once

#include <array>
#include <string>

#include "integrations/program/mesh/mesh_file.h"

namespace mien::cli {

/// Directions of the file: axis 0 to 2, and sign.
struct FileAxis {
  size_t axis;
  double sign;

  /// As --up and --front take it: x or -x.
  std::string word() const { return (sign < 0 ? "-" : "") + std::string(1, "xyz"[axis]); }
};

struct MeshStand {
  FileAxis up = {1, 1}, front = {2, 1};

  size_t left_axis() const { return 3 - up.axis - front.axis; }
  double height_of(const double* p) const { return up.sign * p[up.axis]; }
  double depth_of(const double* p) const { return front.sign * p[front.axis]; }
};

/// The axes of a mesh, derived from its shape: the plane of symmetry, the nose, which stands out from the
/// middle of the face, and the throat below it.
struct StandGuess {
  MeshStand stand;
  double symmetry_error = 0;  // of the halves as given, in shares of the diagonal
  double turned_degrees =
      0;                    // about no axis of the file: how far the head is turned; 0 if it is not
  size_t turned_about = 0;  // the axis of the file about which
};
StandGuess guess_stand(const MeshFile& mesh, const MeshStand& given);

/// Where the head of a body ends. Heights are along `up`.
struct BodyGuess {
  bool is_body = false;
  double low[3], high[3];  // box of the head and the shoulders, in the unit and axes of the mesh;
                           // infinite where there is no limit
  double head_height = 0;  // from the neck to the top; 0 if there is no neck
  double height = 0;       // of all
};
BodyGuess guess_body(const MeshFile& mesh, const MeshStand& stand);

/// Centimeters per unit of the mesh, for a head of this height: the usual unit that gives it the size of a
/// head.
struct UnitGuess {
  double centimeters = 1;
  const char* name = "cm";
};
UnitGuess guess_unit(double head_height);

}  // namespace mien::cli
