// SPDX-License-Identifier: MIT
// What a change of each control reaches, for rigs whose instances keep the sums of the joint matrix
// (MIEN_REUSE_SUMS; runtime/eval/changes.h). Made from a compiled rig, beside it; immutable, too.
#pragma once

#include "runtime/base/object.h"
#include "runtime/base/span.h"
#include "simd/joint_kernels.h"

namespace mien {

struct Rig;

/// Lists, one after the other.
template <class T>
struct Lists {
  Span<uint32_t> first;  // [list] into items, one more at the end
  Span<T> items;

  Span<T> of(size_t list) const { return items.slice(first[list], first[list + 1] - first[list]); }
};

/// Words for a set of `count` bits.
constexpr size_t bit_words(size_t count) { return (count + 63) / 64; }

/// A corrective that reads a control.
struct PsdReader {
  uint16_t entry;  // of PsdTable
  uint16_t other;  // another control that it reads, if any
};

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

  Lists<PsdReader> psds;         // [control] correctives that read it
  Lists<uint32_t> channels;      // [control] entries of ChannelTable that read it
  Lists<uint32_t> maps;          // [control] animated maps that read it
  Lists<uint32_t> map_rows;      // [animated map] its rows in Rig::maps, ascending
  bool nested_psds = false;      // some correctives read others
  bool single_channels = false;  // no two entries write one channel
  RowRuns runs;
  Span<float> largest;  // [column] magnitude of its values, before and after scaling
};

/// Null if memory ran out.
const ChangeTables* create_change_tables(const Rig& rig, const Allocator& allocator);

}  // namespace mien
