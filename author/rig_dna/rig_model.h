// SPDX-License-Identifier: MIT
// A rig that is ready to be written, and the functions that write its parts. Each fills its part of
// a DNA view and returns false if memory ran out.
#pragma once

#include <initializer_list>

#include "author/fit/correctives.h"
#include "author/fit/regions.h"
#include "author/fit/stacked_lods.h"
#include "runtime/load/dna/format/dna_view.h"

namespace mien::author {

/// Controls are the expressions, which are the shapes of `mesh`, and then the combinations.
struct RigModel {
  const AuthorMesh& mesh;
  const Placement& placement;
  Name name;
  Span<const Combination> combinations;
  Span<const FittedLod> lods;
  JointDeltas deltas;  // by control
  JointRegions regions;
  Span<const uint32_t> channels;    // controls with blend shapes, the strongest first
  uint32_t shape_channels[2] = {};  // how many of them exist at LOD 0 and LOD 1

  uint32_t lod_count() const { return static_cast<uint32_t>(lods.count); }
  uint32_t expression_count() const { return static_cast<uint32_t>(mesh.shapes.count); }
  uint32_t control_count() const {
    return expression_count() + static_cast<uint32_t>(combinations.count);
  }
  Name control_name(uint32_t control) const {
    return control < expression_count() ? mesh.shapes[control].name
                                        : combinations[control - expression_count()].name;
  }
  bool in_lod(uint32_t bone, size_t lod) const {
    return placement.bones[bone].kind != BoneKind::kFacial ||
           bone - placement.first_facial < placement.lod_facial_counts[lod];
  }
  uint32_t channels_in_lod(size_t lod) const { return lod < 2 ? shape_channels[lod] : 0; }
};

/// A string made of several parts.
bool join_text(Arena& arena, std::initializer_list<Name> parts, dna::String& out);

/// Names, axes, units.
bool fill_descriptor(const RigModel& rig, Arena& arena, dna::DnaView& out);
/// A GUI control for each raw control; correctives.
bool fill_controls(const RigModel& rig, Arena& arena, Arena& scratch, dna::DnaView& out);
/// Joint names, hierarchy, neutral pose, joint groups.
bool fill_joints(const RigModel& rig, Arena& arena, Arena& scratch, dna::DnaView& out);
/// Meshes of every LOD, blend shape channels.
bool fill_meshes(const RigModel& rig, Arena& arena, const Allocator& allocator, dna::DnaView& out);

}  // namespace mien::author
