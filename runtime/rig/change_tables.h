// SPDX-License-Identifier: MIT
// What a change of each control reaches, for rigs whose instances keep the sums of the joint matrix
// (MIEN_REUSE_SUMS; runtime/eval/changes.h). Made from a compiled rig, beside it; immutable, too.
#pragma once

#include "runtime/base/object.h"
#include "runtime/base/span.h"

namespace mien {

struct Rig;

/// The entries of a table that read each control.
struct ControlReaders {
  Span<uint32_t> first;  // [control] into entries, one more at the end
  Span<uint32_t> entries;

  Span<uint32_t> of(size_t control) const {
    return entries.slice(first[control], first[control + 1] - first[control]);
  }
};

/// Words for a set of `count` bits.
constexpr size_t bit_words(size_t count) { return (count + 63) / 64; }

struct ChangeTables : Object {
  static constexpr uint32_t kTag = 0x6D43'4854;

  ControlReaders psds;           // entries of PsdTable
  ControlReaders channels;       // entries of ChannelTable
  bool single_channels = false;  // no two entries write one channel
  uint32_t word_count = 0;       // for a set of block rows
  Span<uint64_t>
      block_rows;  // [column][word]: bit b % 64 of word b / 64: has a block in block row b
  // The joint value or angle that a packed row writes at a LOD; the number past the last one if it writes
  // none, or if another row writes the same one later.
  Span<uint32_t> first_row_output;  // [lod] into row_outputs, one more at the end
  Span<uint16_t> row_outputs;       // [packed row] of the LOD's panels
};

/// Null if memory ran out.
const ChangeTables* create_change_tables(const Rig& rig, const Allocator& allocator);

}  // namespace mien
