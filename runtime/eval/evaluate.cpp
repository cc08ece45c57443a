// SPDX-License-Identifier: MIT
// The pipeline: which stages run, in which order, and on what.
#include "runtime/eval/evaluate.h"

#include <algorithm>
#include <cstring>

#include "runtime/eval/changes.h"
#include "runtime/eval/instance_packet.h"
#include "runtime/eval/stages.h"
#include "simd/lanes.h"

namespace mien {
namespace {

// What changed ------------------------------------------------------------------------------------

constexpr uint32_t kNoStage = 0;

/// NaN equals itself, and 0 is not -0.
bool same_bits(float a, float b) {
  uint32_t x, y;
  memcpy(&x, &a, sizeof(x));
  memcpy(&y, &b, sizeof(y));
  return x == y;
}
bool same_bits(const float* a, const float* b, size_t count) {
  return count == 0 || memcmp(a, b, count * sizeof(float)) == 0;
}

/// Applies the rule of stage_access.h to a range of controls that were written by a stage, or by other code
/// (kNoStage). `previous` has their old values, and is set to the new ones.
void note_changes(const Rig& rig, Instance& instance, const ControlRange& range, float* previous,
                  uint32_t writer) {
  if (rig.always_evaluate) return;  // everything is stale when an evaluation begins
  const float* now = instance.controls.data + range.first;
  const uint32_t count = range.end - range.first;
  Uses uses = 0;
  if (rig.changes) {
    uses = mark_changes(rig, instance, range, previous);
  } else {
    if (same_bits(previous, now, count)) return;
    // Without branches, which would be mispredicted.
    const Uses* control_uses = rig.control_uses.data + range.first;
    for (uint32_t i = 0; i < count; ++i) {
      uses |= control_uses[i] & (Uses{0} - Uses{!same_bits(previous[i], now[i])});
      previous[i] = now[i];
    }
  }
  instance.stale |= uses & ~Uses{writer & ~rig.feedback_stages};
}

/// To be called before and after a stage, or part of one, writes controls of a range.
void begin_writing(const Rig& rig, Instance& instance, const ControlRange& range) {
  if (rig.always_evaluate) return;
  const float* controls = instance.controls.data;
  std::copy(controls + range.first, controls + range.end, instance.before_writing.data);
}
void end_writing(const Rig& rig, Instance& instance, const ControlRange& range, uint32_t writer) {
  if (rig.always_evaluate) return;
  note_changes(rig, instance, range, instance.before_writing.data, writer);
  // So that raw controls among them do not count as changed by the caller.
  const uint32_t raw_end = std::min(range.end, rig.raw_count);
  for (uint32_t c = range.first; c < raw_end; ++c) instance.previous_raw[c] = instance.controls[c];
}

// Sets results to 0: those that a LOD does not write stay 0, so stages clear nothing. Raw controls belong to
// the caller.
void enter_lod(const Rig& rig, Instance& instance, uint32_t lod) {
  if (instance.lod == lod) return;
  instance.lod = lod;
  std::copy(rig.initial_controls.begin() + rig.raw_count, rig.initial_controls.end(),
            instance.controls.begin() + rig.raw_count);
  clear_results(instance);
}

/// Enters the LOD and finds the inputs that the caller changed.
void begin_evaluation(const Rig& rig, Instance& instance, uint32_t lod) {
  enter_lod(rig, instance, lod);
  if (rig.always_evaluate) instance.stale = kAllUses;
  note_changes(rig, instance, {0, rig.raw_count}, instance.previous_raw.data, kNoStage);
  const Span<float>& masks = instance.masks;
  if (same_bits(instance.previous_masks.data, masks.data, masks.count)) return;
  std::copy(masks.begin(), masks.end(), instance.previous_masks.begin());
  instance.stale |= kStageMl;
}

// Stages ------------------------------------------------------------------------------------------

using Evaluate = void(const Rig& rig, Instance& instance, uint32_t lod);

/// Runs a stage that marks its own changes, for the instances for which it is requested and stale.
void run(const InstancePacket& packet, uint32_t stage, Evaluate* evaluate_stage) {
  if (stage == 0) return;
  for (uint32_t i = 0; i < packet.count; ++i) {
    Instance& instance = *packet.instances[i];
    if ((instance.stale & stage) == 0) continue;
    instance.stale &= ~Uses{stage};
    evaluate_stage(packet.rig, instance, packet.lod);
  }
}

/// The instances of a packet for which any of the stages is stale, stored in `stale`.
InstancePacket stale_ones(const InstancePacket& packet, uint32_t stages, Instance** stale) {
  InstancePacket those = packet;
  those.instances = stale;
  those.count = 0;
  for (uint32_t i = 0; i < packet.count; ++i) {
    if (packet.instances[i]->stale & stages) stale[those.count++] = packet.instances[i];
  }
  return those;
}

/// Runs a stage for all stale instances at once.
template <class F>
void run_packet(const InstancePacket& packet, uint32_t stage, const ControlRange& writes,
                const F& evaluate_stage) {
  if (stage == 0) return;
  Instance* stale[kBatchLanes];
  const InstancePacket those = stale_ones(packet, stage, stale);
  for (uint32_t i = 0; i < those.count; ++i) {
    stale[i]->stale &= ~Uses{stage};
    begin_writing(packet.rig, *stale[i], writes);
  }
  evaluate_stage(those);
  for (uint32_t i = 0; i < those.count; ++i) end_writing(packet.rig, *stale[i], writes, stage);
}

/// Runs correctives and joints for the instances that need either, because it is not known in advance which
/// of them will be moved by changed correctives. A single instance is left to the separate stages.
/// `after_rbf`: evaluate_rbf() returned true for the whole packet.
void run_together(const InstancePacket& packet, uint32_t stages, bool after_rbf) {
  Instance* changed[kBatchLanes];
  InstancePacket those = stale_ones(packet, stages, changed);
  if (packet.rig.changes) {
    Instance** const end = std::remove_if(changed, changed + those.count, [&](Instance* instance) {
      return has_few_changes(packet.rig, *instance);
    });
    those.count = static_cast<uint32_t>(end - changed);
  }
  if (those.count < 2) return;
  if (after_rbf && those.count == packet.count) {
    gather_after_rbf(those);
  } else {
    gather_controls(those, 0, packet.rig.control_count);
  }
  if (stages & kStagePsd) evaluate_psds_together(those);
  if (stages & kStageJoints) evaluate_joints_together(those);
}

}  // namespace

void evaluate_packet(const InstancePacket& packet, uint32_t stages) {
  const Rig& rig = packet.rig;
  Uses stale = 0;
  for (uint32_t i = 0; i < packet.count; ++i) {
    begin_evaluation(rig, *packet.instances[i], packet.lod);
    stale |= packet.instances[i]->stale;
  }
  if ((stale & stages) == 0) return;
  run_packet(packet, stages & kStageMl, rig.ml_writes, evaluate_ml);
  bool after_rbf = false;
  run_packet(packet, stages & kStageRbf, rig.rbf_writes, [&](const InstancePacket& those) {
    after_rbf = evaluate_rbf(those) && those.count == packet.count;
  });
  if (packet.scratch) run_together(packet, stages & (kStagePsd | kStageJoints), after_rbf);
  run(packet, stages & kStagePsd, evaluate_psds);
  run(packet, stages & kStageJoints, evaluate_joints);
  run(packet, stages & kStageBlendShapes, evaluate_blend_shapes);
  run(packet, stages & kStageAnimatedMaps, evaluate_animated_maps);
}

void evaluate(const Rig& rig, Instance& instance, uint32_t lod, uint32_t stages) {
  Instance* const one = &instance;
  evaluate_packet(InstancePacket::of_one(rig, lod, &one), stages);
}

// Parts of a stage leave the rest of it as it was: the whole stage is stale afterwards. ------------

void evaluate_joint_group(const Rig& rig, Instance& instance, uint32_t lod, uint32_t group) {
  enter_lod(rig, instance, lod);
  evaluate_joint_rows(rig, instance, lod, kAllPanels, group);
  evaluate_rotations(rig, instance, lod, group, 1);
  drop_sums(instance);
  instance.stale |= kStageJoints | kAllPanels;
}

void evaluate_rbf_solver(const Rig& rig, Instance& instance, uint32_t lod, uint32_t solver) {
  begin_evaluation(rig, instance, lod);
  begin_writing(rig, instance, rig.rbf_writes);
  solve_rbf(rig, instance, solver);
  end_writing(rig, instance, rig.rbf_writes, kNoStage);
}

void evaluate_twist_swing(const Rig& rig, Instance& instance, uint32_t lod, uint32_t setup) {
  enter_lod(rig, instance, lod);
  apply_twists_and_swings(rig, instance, lod, setup, 1);
  drop_sums(instance);
  instance.stale |= kStageJoints | kAllPanels;
}

}  // namespace mien
