// SPDX-License-Identifier: MIT
// The joint matrix: controls -> joint values (docs/rig-evaluation.md, 4 "Joint groups"), the sum of
// all joint groups, stored as a blocked sparse matrix by columns.
//
//                     column (control)
//                     0    1    2    3
//     block row 0   [ B ][ B ]     [ B ]  <- a block pair, if its column also has the block below
//     block row 1   [ B ]     [ B ][ B ]
//     ------------------------------------- row panels end where LODs stop
//     block row 2        [ B ]     [ B ]
//     block row 3        [ B ]     [ B ]
//
//     packed row         a row in the order of evaluation; those that more LODs reach come first
//     block row          packed rows 8b ... 8b + 7
//     block              the 8 values of one column in one block row
//     block pair         the blocks of one column in block rows 2i and 2i + 1, side by side
//     row panel          a run of block rows that the same LODs reach; an even number of them
//     accumulator tile   a run of row panels of at most kMaxTileBlockRows block rows: their sums fit
//                        the scratch memory at once. All panels of a face are one tile
//
// Blocks of zeros are not stored. In memory a column is a run of blocks, pairs first:
//
//     values      | column 0: pair pair ... block block ... | column 1: pair pair ... block ... | ...
//                             by ascending block row          8 zeros if the single blocks are odd
//     block_rows  | of each pair its even block row, of each single block its own | column 1 ... | ...
//
// Evaluation reads the columns of those controls that are not 0, one after the other, and no others.
// A LOD is a prefix of the panels, so it reads a prefix of the pairs and one of the single blocks.
#pragma once

#include "runtime/base/span.h"
#include "simd/joint_kernels.h"

namespace mien {

/// Where a row panel begins.
struct JointPanel {
  uint32_t first_block_row;
  uint32_t first_target;  // into JointMatrix::targets
};

/// The number of rows of each kind of target.
constexpr uint32_t kTargetRows[] = {6, 3, 1};
constexpr uint32_t kTargetKinds = 3;

constexpr uint32_t kNoColumn = ~uint32_t{0};
constexpr uint32_t kMaxPanelBlockRows = 256;
constexpr uint32_t kMaxTileBlockRows = 1024;
constexpr uint32_t kMaxBlockRows = 0x10000 / kBlockRowUnit;  // of the whole matrix
static_assert(kMaxTileBlockRows >= kMaxPanelBlockRows, "a panel fits");

/// What a block costs in fifths of a cycle, as measured on a production head: listing it for joint_batch; one pass
/// of that kernel, over its batch_step lanes; multiplying it by one input (joint_columns).
constexpr int64_t kListedCost = 12, kPassCost = 45, kFetchedCost = 12;

/// The number of block pairs and of single blocks of a column before a panel.
struct ColumnPart {
  uint16_t pairs, singles;
};

struct JointMatrix {
  Span<float> values;                // [block][8], or
  Span<int16_t> fixed_values;        // the same in units of the packed row's scale
  Span<float> scales;                // [packed row], beside fixed_values
  Span<uint16_t> block_rows;         // [entry]: an entry for each pair and each single block
  Span<uint16_t> columns;            // [column] control, ascending
  Span<uint32_t> column_of_control;  // [control] or kNoColumn
  Span<JointColumn> starts;          // [column], one more at the end
  Span<ColumnPart> parts;        // [column][panel], one more at the end of each column: the part of
                                 // the column before the panel
  Span<JointPanel> panels;       // one more at the end
  Span<uint32_t> panels_at_lod;  // leading panels

  // By panel, with packed rows counted from its first one: those of six rows, of three, of one; of each
  // kind those that more LODs reach first. After the last panel, if fits_tile(), the targets of all panels
  // follow again, in order of their outputs, with packed rows counted from the first one of the matrix.
  Span<JointTarget> targets;
  Span<uint16_t> targets_at_lod;  // [panel, or all][kind][lod]: leading ones of the kind

  // A second copy of the columns from first_strip_column on, by strips of block rows, with zeros where a
  // block row has no block. Made only where it is small and most of these columns may be in use; else all
  // are empty.
  uint32_t first_strip_column = 0;
  Span<RowStrip> strips;        // one more at the end
  Span<uint16_t> strip_inputs;  // controls, ascending in each strip
  Span<float> strip_values;     // or
  Span<int16_t> strip_fixed_values;

  Span<uint16_t> group_rows_at_lod;  // [group][lod]: leading rows of the group, as in the file
  bool contested = false;            // some output is written by rows of different panels
  uint32_t group_count = 0;
  uint32_t panel_shift = 0;  // 2^panel_shift panels share a mark (stage_access.h)

  uint32_t panel_count() const { return static_cast<uint32_t>(panels.count - 1); }
  /// Whether panel `panel` fits a tile that begins with block row `first_block_row`.
  bool in_tile(uint32_t first_block_row, uint32_t panel) const {
    return panels[panel + 1].first_block_row <= first_block_row + kMaxTileBlockRows;
  }
  /// The end of the tile that begins with panel `panel`.
  uint32_t tile_end(uint32_t panel) const {
    const uint32_t first_block_row = panels[panel].first_block_row;
    do ++panel;
    while (panel < panel_count() && in_tile(first_block_row, panel));
    return panel;
  }
  bool fits_tile() const { return panels[panel_count()].first_block_row <= kMaxTileBlockRows; }
  /// How many blocks of a column the first `panel_end` panels have.
  const ColumnPart& part(size_t column, uint32_t panel_end) const {
    return parts[column * panels.count + panel_end];
  }
  uint32_t blocks_before(size_t column, uint32_t panel_end) const {
    const ColumnPart& before = part(column, panel_end);
    return 2 * uint32_t{before.pairs} + before.singles;
  }
  /// Bytes that reading the first `panel_end` panels of a column fetches: values and block rows.
  size_t bytes_before(size_t column, uint32_t panel_end) const {
    const ColumnPart& before = part(column, panel_end);
    const size_t value_size = values.empty() ? sizeof(int16_t) : sizeof(float);
    return blocks_before(column, panel_end) * kJointBlockRows * value_size +
           (size_t{before.pairs} + before.singles) * sizeof(uint16_t);
  }
  /// Calls f(block, block row) for each block that the first `panel_end` panels of a column have.
  template <class F>
  void for_each_block(size_t column, uint32_t panel_end, F&& f) const {
    const ColumnPart& before = part(column, panel_end);
    const JointColumn& start = starts[column];
    const uint16_t* entry = block_rows.data + start.pair_entry;
    for (uint32_t i = 0; i < before.pairs; ++i) {
      const uint32_t block_row = (entry[i] & kPairBlockRows) / kBlockRowUnit;
      f(start.first_pair + 2 * i, block_row);
      f(start.first_pair + 2 * i + 1, block_row + 1);
    }
    entry = block_rows.data + start.single_entry;
    for (uint32_t i = 0; i < before.singles; ++i) {
      f(start.first_single + i, entry[i] / kBlockRowUnit);
    }
  }
};

}  // namespace mien
