// SPDX-License-Identifier: MIT
// Maps the channels of a clip to the raw controls of a rig, found once by name.
//
//     values of channels --copies, sums----------------------------> raw controls
//                        --sums--> GUI controls --table of the rig--->
//
// A channel drives, in this order: the raw control of its name; the GUI control of its name, which the
// rig's own table maps to raw controls after sampling; or the controls that the caller's matrix lists for
// it, for captures with names of their own. Names match without regard to case, `.` matches `_`, and the
// prefix `CTRL_expressions.` may be missing. If several names match, one of them must be equal. A channel
// that drives nothing so far drives the controls that its name matches in other spellings and vocabularies
// (match_controls.h), like entries at the end of the matrix.
//
// The more direct way wins: a raw control that a channel names is driven by nothing else, and one
// that such entries drive is not driven by GUI controls.
#pragma once

#include "runtime/anim/closures.h"
#include "runtime/base/allocator.h"
#include "runtime/rig/rig.h"

namespace mien {

/// `control`, a raw control or a GUI control, gets weight * the value of channel `source`.
struct MatrixEntry {
  Span<const char> source, control;
  float weight;
};

struct BoundCopy {
  uint16_t channel, control;
  uint16_t changing;  // number of the channel among those that change, if it does
};

/// A raw control or GUI control that is the sum of weight * value, in the order of the matrix.
struct BoundSum {
  uint16_t target, is_gui;
  uint32_t first_term, end_term;
};

struct BoundTerm {
  uint16_t channel, zero;
  float weight;
};

/// A row of the rig's table: docs/rig-evaluation.md, 2.3 "GUI controls to raw controls".
struct BoundRow {
  uint16_t gui, control;
  uint32_t run_end;  // end of the rows of which only the first match counts
  float from, to, slope, cut;
};

/// Immutable, in one block of memory; refers to neither rig nor clip. GUI controls have numbers of
/// their own here: those that the clip drives, then one that is always 0 and stands for all others.
struct Binding : Object {
  static constexpr uint32_t kTag = 0x6D43'424E;

  uint32_t raw_count = 0;      // of the rig
  uint32_t channel_count = 0;  // of the clip
  uint32_t gui_count = 0;      // 0 if the clip drives none
  Span<BoundCopy> copies;      // of channels that change
  Span<BoundCopy> constants;   // of the others
  Span<BoundSum> sums;
  Span<BoundTerm> terms;
  Span<BoundRow> rows;
  Span<uint16_t> mapped_controls;   // raw controls that the rows write
  Span<uint16_t> controls;          // all raw controls that are driven, ascending
  Span<uint16_t> missing_channels;  // of the clip: they drive nothing, because the rig lacks their
                                    // names or an earlier channel drives the same control
  Span<uint16_t> extra_controls;    // raw controls that nothing drives, ascending
  Closures closures;                // of the clip
  uint32_t missing_entries = 0;     // of the matrix: no such channel or no such control
};

constexpr uint32_t kMaxBoundGuiControls = 4096;  // including the one that is always 0

/// On success, give back `out` with release(). kClipLimit for more GUI controls, kInvalidArgument for
/// weights that are not finite, kMemory.
Status bind_clip(const Clip& clip, const Rig& rig, Span<const MatrixEntry> matrix,
                 const Allocator& allocator, Binding*& out, Error& error);

/// Writes the raw controls in `binding.controls` and leaves the others alone; without `constants`, it also
/// leaves alone those that are constant from the beginning of the clip on. `values` comes from sample_clip();
/// `gui` is scratch of gui_count floats. Values that go to raw controls directly keep their bits; GUI
/// controls give the bits of the rig's own mapping.
void apply_binding(const Binding& binding, Span<const float> values, Span<float> gui,
                   Span<float> raw_controls, bool constants = true);

}  // namespace mien
