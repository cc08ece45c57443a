// SPDX-License-Identifier: MIT
// The references between elements. When joints, meshes, channels or maps are removed, reordered, merged or
// added, a function for each kind walks every field that is indexed by their numbers or holds them
// (docs/dna-format.md, 6 "Layers, field by field"); no other place of the author library knows these lists.
#pragma once

#include "runtime/base/arena.h"
#include "runtime/load/dna/format/dna_view.h"

namespace mien::author {

constexpr uint32_t kGone = ~uint32_t{0};

/// Old numbers and new numbers of the elements of a kind.
struct Renumbering {
  Span<uint32_t> new_of;  // [old] or kGone; several may become one
  Span<uint32_t> old_of;  // [new] whose data it takes; kGone: none, it is new and empty
};

/// Numbers where those with keep[i] == 0 are gone and the others close up. False if memory ran out.
bool number_kept(Span<const uint8_t> keep, Arena& arena, Renumbering& out);

// Arrays that change are new ones in `arena`, others stay. Lists that change are copied. Each returns false if
// memory ran out; the view must then not be used. New elements have empty names, no parent, no LODs.

/// Expects skin weights without joints that are gone, and parents as old numbers that are not gone or the
/// joint itself.
bool renumber_joints(dna::DnaView& view, const Renumbering& numbers, Arena& arena);
bool renumber_meshes(dna::DnaView& view, const Renumbering& numbers, Arena& arena);
bool renumber_channels(dna::DnaView& view, const Renumbering& numbers, Arena& arena);
bool renumber_maps(dna::DnaView& view, const Renumbering& numbers, Arena& arena);

/// Whether its parameters are numbers of controls.
inline bool lists_controls(const dna::MlOperation& operation) {
  const auto type = static_cast<dna::MlOperationType>(operation.type);
  return type == dna::MlOperationType::kGather || type == dna::MlOperationType::kScatter;
}

/// Renumbers controls of all kinds: `gone` has an element for each. What reads a control that is gone goes, or
/// reads one less; networks and solvers no longer write it. Expects that a PSD control of which an input is gone is
/// gone, and that no ML operation, nor a network that operations run, refers to one.
bool renumber_controls(dna::DnaView& view, Span<const uint8_t> gone, Arena& arena);
bool renumber_gui_controls(dna::DnaView& view, const Renumbering& numbers, Arena& arena);

/// Drops the rows of all tables that write joints with keep[joint] == 0; all joints stay.
bool drop_joint_rows(dna::DnaView& view, Span<const uint8_t> keep, Arena& arena);

/// Updates meshBlendShapeChannelMapping to the targets of the mesh: removes pairs without a target, and
/// appends missing ones.
bool pair_channels(dna::DnaView& view, uint32_t mesh, Arena& arena);

/// Lists an element at those LODs whose bits are set, and at no other. LODs that list the same share a list.
bool list_at_lods(dna::LodMap& map, uint32_t element, uint64_t lods, Arena& arena);

// For operations -------------------------------------------------------------------------------------

/// A copy of the list in `arena`, to be changed; its elements are the same. False if memory ran out.
template <class T>
bool copy_list(Arena& arena, dna::List<T>& list) {
  if (list.count == 0) return true;
  const Span<T> copy = arena.unwritten_array<T>(list.count);
  if (!copy.data) return false;
  for (uint32_t i = 0; i < list.count; ++i) new (copy.data + i) T(list.items[i]);
  list.items = copy.data;
  return true;
}

/// The same for an array.
template <class T>
bool copy_array(Arena& arena, const dna::Array<T>& array, dna::NewArray<T>& out) {
  out = dna::new_array<T>(arena, array.count);
  if (array.count != 0 && !out.data) return false;
  if (array.count != 0) memcpy(out.data, array.data, array.byte_count());
  return true;
}

/// All lists of a view, for functions that change lists in place.
bool copy_all_lists(Arena& arena, dna::DnaView& view);

}  // namespace mien::author
