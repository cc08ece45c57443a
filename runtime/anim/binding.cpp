// SPDX-License-Identifier: MIT
#include "runtime/anim/binding.h"

#include <cmath>

#include "runtime/anim/control_names.h"
#include "runtime/anim/match_controls.h"
#include "runtime/base/arena.h"

namespace mien {
namespace {

constexpr uint32_t kNone = kNoName;
constexpr uint8_t kByChannel = 1, kByMatrix = 2, kByGui = 3;

// Building ----------------------------------------------------------------------------------------

/// `weight` times the value of a channel goes to a target: a raw control, then GUI controls.
struct Share {
  uint32_t source, target;
  float weight;
};

/// Shares of channels whose names match other controls: at most two per channel, one for each side, except
/// for expressions of a vocabulary, each of which a single channel drives.
constexpr size_t kMostOfExpressions = 512;
size_t most_matched(const Clip& clip) {
  return 2 * size_t{clip.channel_count} + kMostOfExpressions;
}

/// BindingScratch memory of binding. Targets are raw controls, then GUI controls.
struct BindingScratch {
  Allocator allocator;
  size_t block_size = 0;
  Span<uint16_t> raw_order, gui_order, channel_order;
  Span<uint8_t> driven_by;                 // [target]
  Span<uint8_t> is_used;                   // [channel]
  Span<Share> shares;                      // of the matrix, then of matched names; begins empty
  Span<uint32_t> share_order;              // shares by target
  Span<ControlKey> by_spelling, by_alias;  // raw controls
  Span<uint16_t> slots;                    // [GUI control] its number in the binding

  void place(Placer& placer, const Clip& clip, const Rig& rig, size_t entries) {
    raw_order = placer.array<uint16_t>(rig.raw_count);
    gui_order = placer.array<uint16_t>(rig.gui_count);
    channel_order = placer.array<uint16_t>(clip.channel_count);
    driven_by = placer.array<uint8_t>(size_t{rig.raw_count} + rig.gui_count);
    is_used = placer.array<uint8_t>(clip.channel_count);
    shares = placer.array<Share>(entries + most_matched(clip)).first(0);
    share_order = placer.array<uint32_t>(entries + most_matched(clip));
    by_spelling = placer.array<ControlKey>(rig.raw_count);
    by_alias = placer.array<ControlKey>(rig.raw_count);
    slots = placer.array<uint16_t>(rig.gui_count);
  }
};

/// Lists begin empty, with room for their largest size.
void place_binding(Placer& placer, const Clip& clip, const Rig& rig, size_t entries,
                   Binding& binding) {
  const uint32_t channels = clip.channel_count, raws = rig.raw_count;
  binding.copies = placer.array<BoundCopy>(clip.changing_count).first(0);
  binding.constants = placer.array<BoundCopy>(channels - clip.changing_count).first(0);
  const size_t shares = entries + most_matched(clip);
  binding.sums = placer.array<BoundSum>(channels + shares).first(0);
  binding.terms = placer.array<BoundTerm>(channels + shares).first(0);
  binding.rows = placer.array<BoundRow>(rig.gui_to_raw.inputs.count).first(0);
  binding.mapped_controls = placer.array<uint16_t>(raws).first(0);
  binding.controls = placer.array<uint16_t>(raws).first(0);
  binding.missing_channels = placer.array<uint16_t>(channels).first(0);
  binding.extra_controls = placer.array<uint16_t>(raws).first(0);
}

template <class T>
void append(Span<T>& list, const T& item) {
  list.data[list.count++] = item;
}

struct Binder {
  const Clip& clip;
  const Rig& rig;
  Span<const MatrixEntry> matrix;
  BindingScratch& scratch;
  Binding& binding;

  void find_targets() {
    NameIndex<RigNames> raws = {raw_names, scratch.raw_order};
    NameIndex<RigNames> guis = {gui_names, scratch.gui_order};
    NameIndex<Clip> channels = {clip, scratch.channel_order};
    raws.sort();
    guis.sort();
    channels.sort();
    const auto target_of = [&](Span<const char> name) {
      const uint32_t raw = raws.find(name);
      if (raw != kNone) return raw;
      const uint32_t gui = guis.find(name);
      return gui == kNone ? kNone : rig.raw_count + gui;
    };
    for (uint32_t c = 0; c < clip.channel_count; ++c) {
      const uint32_t target = target_of(clip.name(c));
      if (target == kNone || scratch.driven_by[target]) continue;
      scratch.driven_by[target] = kByChannel;
      scratch.is_used[c] = 1;
      bind_channel(c, target);
    }
    for (const MatrixEntry& entry : matrix) {
      const uint32_t source = channels.find(entry.source);
      const uint32_t target = target_of(entry.control);
      const bool there = source != kNone && target != kNone;
      binding.missing_entries += !there;
      if (there) add_share(source, target, entry.weight);
    }
    match_names(raws);
  }

  void add_share(uint32_t source, uint32_t target, float weight) {
    if (scratch.driven_by[target] == kByChannel) return;
    scratch.driven_by[target] = kByMatrix;
    scratch.is_used[source] = 1;
    append(scratch.shares, Share{source, target, weight});
  }

  /// Channels that drive nothing so far, in their order; not those whose name several controls have.
  void match_names(const NameIndex<RigNames>& raws) {
    ControlFinder finder(raw_names.list);
    bool is_sorted = false;
    const size_t most = scratch.shares.count + most_matched(clip);
    for (uint32_t c = 0; c < clip.channel_count; ++c) {
      bool several;
      if (scratch.is_used[c] || (raws.find(clip.name(c), several) == kNone && several)) continue;
      if (!is_sorted) finder.sort(scratch.by_spelling, scratch.by_alias);
      is_sorted = true;
      const ControlMatch match = finder.match(clip.name(c));
      if (scratch.shares.count + match.count > most || is_taken(match)) continue;
      for (uint32_t i = 0; i < match.count; ++i) {
        add_share(c, match.shares[i].control, match.shares[i].weight);
      }
    }
  }

  /// Whether another channel drives a control alone. Expressions add up.
  bool is_taken(const ControlMatch& match) const {
    for (uint32_t i = 0; i < match.count; ++i) {
      const uint8_t driven_by = scratch.driven_by[match.shares[i].control];
      if (driven_by == kByChannel) return true;
      if (driven_by != 0 && match.how != Match::kExpression) return true;
    }
    return false;
  }

  void bind_channel(uint32_t channel, uint32_t target) {
    const auto source = static_cast<uint16_t>(channel);
    if (target < rig.raw_count) {
      // Channels come in ascending order.
      while (next_changing < clip.changing_count && clip.changing(next_changing) < channel) {
        ++next_changing;
      }
      const bool changes =
          next_changing < clip.changing_count && clip.changing(next_changing) == channel;
      append(changes ? binding.copies : binding.constants,
             BoundCopy{source, static_cast<uint16_t>(target),
                       static_cast<uint16_t>(changes ? next_changing : 0)});
    } else {
      append(binding.terms, BoundTerm{source, 0, 1});
      add_sum(target, binding.terms.count - 1);
    }
  }

  /// Of the terms from `first_term` on.
  void add_sum(uint32_t target, size_t first_term) {
    const bool is_gui = target >= rig.raw_count;
    auto number = static_cast<uint16_t>(target);
    if (is_gui) {
      number = static_cast<uint16_t>(binding.gui_count++);
      scratch.slots[target - rig.raw_count] = number;
    }
    append(binding.sums, BoundSum{number, is_gui, static_cast<uint32_t>(first_term),
                                  static_cast<uint32_t>(binding.terms.count)});
  }

  void bind_shares() {
    const Span<const Share> shares = scratch.shares;
    const Span<uint32_t> order = scratch.share_order.first(shares.count);
    for (uint32_t s = 0; s < order.count; ++s) order[s] = s;
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
      return shares[a].target != shares[b].target ? shares[a].target < shares[b].target : a < b;
    });
    for (size_t i = 0; i < order.count;) {
      const uint32_t target = shares[order[i]].target;
      const size_t first_term = binding.terms.count;
      for (; i < order.count && shares[order[i]].target == target; ++i) {
        const Share& share = shares[order[i]];
        append(binding.terms, BoundTerm{static_cast<uint16_t>(share.source), 0, share.weight});
      }
      add_sum(target, first_term);
    }
  }

  /// All rows of the raw controls that some GUI control of the clip moves; the others are at 0.
  void bind_gui_controls() {
    if (binding.gui_count == 0) return;
    const auto zero_gui = static_cast<uint16_t>(binding.gui_count++);
    const ControlTable& table = rig.gui_to_raw;
    const auto is_driven = [&](uint16_t gui) {
      return scratch.driven_by[size_t{rig.raw_count} + gui] != 0;
    };
    for (size_t r = 0; r < table.inputs.count; ++r) {
      uint8_t& driven_by = scratch.driven_by[table.outputs[r]];
      if (driven_by != 0 || !is_driven(table.inputs[r])) continue;
      driven_by = kByGui;
      append(binding.mapped_controls, table.outputs[r]);
    }
    for (uint32_t r = 0; r < table.inputs.count;) {
      // Rows of a run have one input and one output.
      const uint32_t run_end = table.run_ends[r];
      const uint16_t gui = table.inputs[r], raw = table.outputs[r];
      const size_t end = binding.rows.count + (run_end - r);
      for (; r < run_end; ++r) {
        if (scratch.driven_by[raw] != kByGui) continue;
        append(binding.rows, BoundRow{is_driven(gui) ? scratch.slots[gui] : zero_gui, raw,
                                      static_cast<uint32_t>(end), table.from[r], table.to[r],
                                      table.slope[r], table.cut[r]});
      }
    }
  }

  void list_controls() {
    for (uint32_t i = 0; i < rig.raw_count; ++i) {
      append(scratch.driven_by[i] ? binding.controls : binding.extra_controls,
             static_cast<uint16_t>(i));
    }
    for (uint32_t c = 0; c < clip.channel_count; ++c) {
      if (!scratch.is_used[c]) append(binding.missing_channels, static_cast<uint16_t>(c));
    }
  }

  uint32_t next_changing = 0;
  RigNames raw_names = {rig.names[static_cast<size_t>(Kind::kRawControl)]};
  RigNames gui_names = {rig.names[static_cast<size_t>(Kind::kGuiControl)]};
};

void fill_binding(const Clip& clip, const Rig& rig, Span<const MatrixEntry> matrix,
                  BindingScratch& scratch, Binding& binding) {
  binding.raw_count = rig.raw_count;
  binding.channel_count = clip.channel_count;
  binding.closures = find_closures(clip);
  Binder binder = {clip, rig, matrix, scratch, binding};
  binder.find_targets();
  binder.bind_shares();
  binder.bind_gui_controls();
  binder.list_controls();
}

/// NaN becomes 0.
float clamped(float value) { return value > 0.0f ? (value < 1.0f ? value : 1.0f) : 0.0f; }

}  // namespace

Status bind_clip(const Clip& clip, const Rig& rig, Span<const MatrixEntry> matrix,
                 const Allocator& allocator, Binding*& out, Error& error) {
  out = nullptr;
  for (size_t e = 0; e < matrix.count; ++e) {
    if (std::isfinite(matrix[e].weight)) continue;
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "entry %zu of the matrix: the weight is not a finite number", e);
  }
  auto* const scratch = create_block<BindingScratch>(
      allocator,
      [&](Placer& placer, BindingScratch& lists) { lists.place(placer, clip, rig, matrix.count); });
  out = create_object<Binding>(allocator, [&](Placer& placer, Binding& binding) {
    place_binding(placer, clip, rig, matrix.count, binding);
  });
  if (!scratch || !out) {
    release_block(scratch);
    release(out);
    out = nullptr;
    return fail(error, Status::kMemory, kNoOffset, "no memory to bind a clip");
  }
  fill_binding(clip, rig, matrix, *scratch, *out);
  release_block(scratch);
  if (out->gui_count <= kMaxBoundGuiControls) return Status::kOk;
  fail(error, Status::kClipLimit, kNoOffset,
       "the channels drive %u GUI controls, %u is the limit; bind raw controls", out->gui_count - 1,
       kMaxBoundGuiControls - 1);
  release(out);
  out = nullptr;
  return Status::kClipLimit;
}

void apply_binding(const Binding& binding, Span<const float> values, Span<float> gui,
                   Span<float> raw_controls, bool constants) {
  assert(values.count >= binding.channel_count && gui.count >= binding.gui_count &&
         raw_controls.count >= binding.raw_count);
  for (const BoundCopy& copy : binding.copies) raw_controls[copy.control] = values[copy.channel];
  if (constants) {
    for (const BoundCopy& copy : binding.constants) {
      raw_controls[copy.control] = values[copy.channel];
    }
  }
  for (const BoundSum& sum : binding.sums) {
    const BoundTerm* term = &binding.terms[sum.first_term];
    float value = term->weight * values[term->channel];
    for (const BoundTerm* end = binding.terms.data + sum.end_term; ++term != end;) {
      value += term->weight * values[term->channel];
    }
    (sum.is_gui ? gui : raw_controls)[sum.target] = value;
  }
  if (binding.gui_count == 0) return;

  // The same sums in the same order as when the rig maps GUI controls itself.
  gui[binding.gui_count - 1] = 0;
  for (uint16_t control : binding.mapped_controls) raw_controls[control] = 0;
  for (uint32_t r = 0; r < binding.rows.count;) {
    const BoundRow& row = binding.rows[r];
    const float input = gui[row.gui];
    const bool fires = row.from <= input && input <= row.to;
    if (fires) raw_controls[row.control] += row.slope * input + row.cut;
    r = fires ? row.run_end : r + 1;
  }
  for (uint16_t control : binding.mapped_controls) {
    raw_controls[control] = clamped(raw_controls[control]);
  }
}

}  // namespace mien
