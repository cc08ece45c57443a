// SPDX-License-Identifier: MIT
// View -> rig: the blocks of compilation. compile_rig() measures, allocates once, and lets each
// block fill its arrays.
#pragma once

#include "runtime/base/arena.h"
#include "runtime/base/status.h"
#include "runtime/load/dna/format/dna_view.h"
#include "runtime/rig/rig.h"
#include "simd/isa.h"
#include "simd/joint_kernels.h"

namespace mien {

struct CompileOptions {
  const KernelTable* kernels = nullptr;
  bool quaternion_outputs = false;  // joint rotations as quaternions instead of Euler angles
  bool blend_masks = false;         // ML masks blend instead of switching
  bool half_storage = false;        // matrices and weights in 16 bits
  bool portable = false;            // the same bits on every instruction set
  bool always_evaluate = false;     // results are never kept, even if their inputs did not change
};

/// Packs a checked view (definition and behavior loaded). On success `out` is one block of
/// `allocator`, to be given back by release(); the view is no longer needed.
Status compile_rig(const dna::DnaView& view, const CompileOptions& options,
                   const Allocator& allocator, Rig*& out, Error& error);

// The blocks. place_...() says how much memory a block takes (its spans get their counts, and their data
// when the block row is there); fill_...() writes it. `scratch` is temporary memory for the compilation.

void place_controls(const dna::DnaView& view, Placer& placer, Rig& rig);
/// kMemory (scratch), or kDnaValue for correctives that depend on each other in a cycle.
Status fill_controls(const dna::DnaView& view, Arena& scratch, Rig& rig, Error& error);

/// The data of a joint group that planning needs.
struct GroupColumns {
  Span<uint16_t> inputs;   // controls
  Span<uint64_t> nonzero;  // [row][column / 64] bit column % 64: the number is not zero
  uint32_t row_count, words_per_row;

  const uint64_t* row(uint32_t r) const { return nonzero.data + size_t{r} * words_per_row; }
  bool is_nonzero(uint32_t r, uint32_t column) const {
    return (row(r)[column / 64] >> column % 64 & 1) != 0;
  }
  bool is_zero(uint32_t r) const {
    uint64_t any = 0;
    for (uint32_t w = 0; w < words_per_row; ++w) any |= row(r)[w];
    return any == 0;
  }
};

/// Rows of one joint group in one block row; the rows between them write nothing.
struct PlannedRows {
  uint32_t group;
  uint32_t block_row;
  uint16_t rows[kJointBlockRows];
  uint8_t reaches[kJointBlockRows];  // how many LODs, counted from 0, reach a row
  uint8_t row_count;
  uint8_t first_in_block;  // packed row of the block row; rows of other groups may follow
  bool contested;
  bool whole;  // fills its block row, and lists no control twice

  uint8_t reach() const { return reaches[0]; }  // of the whole range: the rows are in order
};

/// The blocks of a control in two neighboring block rows, the first of which has an even number.
struct BlockHalves {
  uint16_t control;
  uint8_t is_pair;    // a block in both
  uint8_t is_second;  // only one, in the second
};

/// The blocks of a control, single ones and pairs: first how many entries there are, then where the
/// next of either kind goes.
struct PlannedColumn {
  struct Next {
    uint32_t entry;  // into JointMatrix::block_rows
    uint32_t block;
  } next[2];  // [is a pair]
};

/// A target before its panel is sorted.
struct PlannedTarget {
  JointTarget target;
  uint8_t kind;   // into kTargetRows
  uint8_t reach;  // how many LODs, counted from 0
};

/// The plan for the joint groups, in scratch memory: made once, before anything is placed.
struct JointPlan {
  Span<GroupColumns> groups;
  Span<uint8_t> uses;               // of all rows of all groups
  Span<uint8_t> reaches;            // of all rows of all groups: how many LODs, counted from 0
  Span<PlannedRows> rows;           // by block row
  Span<uint32_t> first_rows;        // [block row] into rows, one more at the end
  Span<uint8_t> block_row_reaches;  // never rises
  size_t block_count = 0, entry_count = 0, column_count = 0;
  uint32_t panel_size = 0;       // block rows
  size_t panel_ends = 0;         // panels, and one more
  Span<PlannedTarget> targets;   // by panel, then those of all panels if they fit a tile
  Span<uint32_t> first_targets;  // [panel] into targets, one more; and one at the end
  Span<PlannedColumn> columns;   // [control]
  Span<uint32_t> places;  // [control] its last block of an even block row, or before the odd one's
  Span<uint64_t> blocks;  // by rows, a bit for each column of their group: not all zeros
  Span<BlockHalves> halves;     // by pairs of block rows
  Span<uint32_t> first_halves;  // [block row / 2] into halves, one more at the end

  Span<RowStrip> strips;        // one more at the end; while they are filled, of the inputs so far
  Span<uint32_t> strip_of_row;  // [block row]
  uint32_t first_strip_control = 0;

  uint32_t block_row_count() const { return static_cast<uint32_t>(block_row_reaches.count); }
};

/// kMemory (scratch), or kDnaLimit for more block rows or blocks than can be numbered.
Status plan_joints(const dna::DnaView& view, const Rig& rig, Arena& scratch, JointPlan& plan,
                   Error& error);
void place_joints(const dna::DnaView& view, const JointPlan& plan, Placer& placer, Rig& rig);
/// Also marks in `reach` how many LODs, counted from 0, read each control through a joint group.
/// The plan must not be used afterwards.
void fill_joints(const dna::DnaView& view, JointPlan& plan, Span<uint8_t> reach, Rig& rig);

/// After joints, twists and swings, and before the neutral pose.
void fill_variable_joint_values(const dna::DnaView& view, Rig& rig);

/// A quaternion joint of one group, before it is assigned a lane.
struct PlannedTurn {
  uint64_t lods;  // bit l: a LOD turns it
  uint32_t group;
  uint32_t rows[3];  // about x y z, or ~0
  uint32_t steps;    // columns that turn it
  uint32_t lane;     // among those of all groups
  uint16_t joint;
  uint8_t reach;  // how many LODs, counted from 0
};

/// The plan for the rotations of joint groups, in scratch memory: made once, before anything is placed.
struct RotationPlan {
  Span<GroupColumns> columns;  // [group]
  Span<GroupRotations> groups;
  Span<AngleJoint> angle_joints;
  Span<PlannedTurn> turns;       // by group
  Span<uint32_t> sorted;         // turns in the order of their lanes
  Span<uint32_t> used_at_lod;    // [turn][lod] leading steps
  Span<uint32_t> first_columns;  // [group] into order, one more at the end
  Span<uint32_t> order;          // columns of their groups, in the order in which they turn
  size_t step_count = 0;         // of all blocks
};

/// Call it after plan_joints(). kMemory (scratch).
Status plan_rotations(const dna::DnaView& view, const JointPlan& joints, const Rig& rig,
                      Arena& scratch, RotationPlan& plan, Error& error);
void place_rotations(const RotationPlan& plan, Placer& placer, Rig& rig);
void fill_rotations(const dna::DnaView& view, const RotationPlan& plan, Rig& rig);

/// Steps that compiling, and a frame at each LOD, may take (work.h). A rig may be large because of layers
/// that cause no work, so the smaller of the two sizes counts; then a compiled rig opens as a baked file, too.
uint64_t compile_budget(const dna::DnaView& view, const Rig& rig);

/// kDnaLimit for a solver too large to be made, and for work that is out of proportion.
Status place_rbf(const dna::DnaView& view, Placer& placer, Rig& rig, Error& error);
Status fill_rbf(const dna::DnaView& view, Arena& scratch, Rig& rig, Error& error);

/// kDnaLimit for operations that repeat values or networks too often.
Status place_ml(const dna::DnaView& view, Placer& placer, Rig& rig, Error& error);
Status fill_ml(const dna::DnaView& view, Arena& scratch, Rig& rig, Error& error);
/// How many LODs, counted from 0, read a control to move a joint.
void mark_ml_joint_inputs(const dna::DnaView& view, uint32_t lod_count, Span<uint8_t> reach);

void place_twists_and_swings(const dna::DnaView& view, Placer& placer, Rig& rig);
Status fill_twists_and_swings(const dna::DnaView& view, Arena& scratch, Rig& rig, Error& error);

/// [joint]: bit l is set if LOD l lists it; all are if no LOD does.
void mark_joint_lods(const dna::DnaView& view, Span<uint64_t> lods);

void place_lod_lists(const dna::LodMap& map, uint32_t lod_count, Placer& placer, LodLists& lists);
void fill_lod_lists(const dna::LodMap& map, LodLists& lists);

/// Correctives, once every reader of a control has marked its reach.
Status fill_psds(const dna::DnaView& view, Span<uint8_t> reach, Arena& scratch, Rig& rig,
                 Error& error);

/// Leading rows of a table at a LOD; 0 past the end of the list.
inline uint32_t rows_at_lod(const dna::Array<uint16_t>& lods, uint32_t lod) {
  return lod < lods.count ? lods[lod] : 0;
}

/// How many LODs, counted from 0, reach a row.
inline uint8_t lod_reach(const dna::Array<uint16_t>& lods, uint32_t lod_count, uint32_t row) {
  uint32_t reach = lod_count;
  while (reach > 0 && rows_at_lod(lods, reach - 1) <= row) --reach;
  return static_cast<uint8_t>(reach);
}

/// Big-endian array -> native array of at least its length.
template <class T, class U>
void copy_array(const dna::Array<T>& from, const Span<U>& to) {
  for (uint32_t i = 0; i < from.count; ++i) to[i] = static_cast<U>(from[i]);
}

}  // namespace mien
