// SPDX-License-Identifier: MIT
// The differences between two DNA files: names, fields, and the effects of controls.
#pragma once

#include <mien.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace mien::cli {

class JsonWriter;

/// Of one list of names.
struct NameChanges {
  std::string kind;  // "joints", "meshes", ...
  std::vector<std::string> added, removed;
  std::vector<std::pair<std::string, std::string>>
      renamed;             // an old name and a new one at its place
  bool reordered = false;  // names of both files have another order

  bool any() const { return !added.empty() || !removed.empty() || !renamed.empty() || reordered; }
};

/// Fields of one path; of lists of lists, all elements together: "geom.meshes[0].skinWeights[].weights".
struct FieldChange {
  enum Kind { kNumbers, kText, kCount, kAdded, kRemoved };

  std::string path;
  Kind kind = kNumbers;
  uint64_t changed = 0;  // numbers that differ
  double largest = 0;    // difference of them
  std::string from, to;  // text, or numbers of elements
};

/// Largest differences of the results of one raw control at 1, LOD 0, over what both files have.
struct ControlChange {
  std::string control;
  double translation = 0, rotation = 0, scale = 0;  // of joints, in the units of the files
  double blend_shape = 0, animated_map = 0;
  std::string joint;  // with the largest difference
};

struct DnaDiff {
  std::vector<NameChanges> names;  // of kinds that have any
  std::vector<FieldChange> fields;
  bool evaluated = false;               // both files have behavior
  uint32_t compared_controls = 0;       // raw controls of both
  std::vector<ControlChange> controls;  // of these, the ones that differ

  bool any() const { return !names.empty() || !fields.empty(); }
};

/// Fails with kInvalid if a rig cannot be compiled.
DnaDiff diff_dna(const MienDna* before, const MienDna* after);

/// For people; "" if nothing differs.
std::string diff_text(const DnaDiff& diff);

void write_diff(const DnaDiff& diff, JsonWriter& json);

}  // namespace mien::cli
