// SPDX-License-Identifier: MIT
// What a change of each control reaches, for rigs whose instances keep the sums of the joint matrix
// (MIEN_REUSE_SUMS; runtime/eval/changes.h). Made from a compiled rig, beside it; immutable, too.
#pragma once

#include "runtime/base/object.h"
#include "runtime/base/span.h"
#include "simd/joint_kernels.h"

namespace mien {

struct Rig;

/// Lists of numbers, one after the other.
struct NumberLists {
  Span<uint32_t> first;  // [list] into numbers, one more at the end
  Span<uint32_t> numbers;

  Span<uint32_t> of(size_t list) const {
    return numbers.slice(first[list], first[list + 1] - first[list]);
  }
};

/// Words for a set of `count` bits.
constexpr size_t bit_words(size_t count) { return (count + 63) / 64; }

/// The packed rows in runs, in the order and with the limits of FinishRunsArgs. Each LOD writes all rows of a
/// run, to neighboring joint values or angles, or none. Rows that others overwrite at a LOD count as not
/// written.
struct RowRuns {
  uint32_t first_words[kMaxRunRows + 1] = {};  // those of FinishRunsArgs
  uint32_t word_count = 0;                     // of a set of runs
  Span<uint32_t> rows;                         // [run] its first packed row
  Span<uint16_t> outputs;                      // [lod][run] where that row goes
  Span<uint64_t> at_lod;                       // [lod][word]: the LOD writes it
  Span<uint64_t> of_column;                    // [column][word]: the column has a value in it
};

struct ChangeTables : Object {
  static constexpr uint32_t kTag = 0x6D43'4854;

  NumberLists psds;              // [control] entries of PsdTable that read it
  NumberLists channels;          // [control] entries of ChannelTable that read it
  NumberLists maps;              // [control] animated maps that read it
  NumberLists map_rows;          // [animated map] its rows in Rig::maps, ascending
  bool nested_psds = false;      // some correctives read others
  bool single_channels = false;  // no two entries write one channel
  RowRuns runs;
};

/// Null if memory ran out.
const ChangeTables* create_change_tables(const Rig& rig, const Allocator& allocator);

}  // namespace mien
