// SPDX-License-Identifier: MIT
#include "runtime/rig/stage_access.h"

#include <algorithm>

#include "runtime/rig/rig.h"

namespace mien {
namespace {

// The table of stage_access.h: each function calls f(control) for what a stage reads or writes at
// any LOD, once or more often.

template <class Controls, class F>
void each_of(const Controls& controls, F&& f) {
  for (const uint16_t control : controls) f(control);
}

template <class F>
void each_of_joint(const MlTable& ml, const MlJoint& joint, F&& f) {
  for (int i = 0; i < 3; ++i) {
    if (joint.translation[i] != kNoControl) f(joint.translation[i]);
    if (joint.scale[i] != kNoControl) f(joint.scale[i]);
  }
  if (joint.rotation_control == kNoControl) return;
  const uint32_t parts = ml.quaternion_rotations ? 4 : 3;
  for (uint32_t i = 0; i < parts; ++i) f(joint.rotation_control + i);
}

template <class F>
void ml_reads(const Rig& rig, F&& f) {
  const MlTable& ml = rig.ml;
  for (const MlStep& step : ml.steps) {
    each_of(ml.controls.slice(step.first_gather, step.gather_count), f);
  }
  if (!ml.converts) return;
  // Conversion is in place. Controls that are not raw get their initial values before the networks
  // run, so what it finds there was written in the same run.
  for (const MlJoint& joint : ml.joints) {
    each_of_joint(ml, joint, [&](uint32_t control) {
      if (control < rig.raw_count) f(control);
    });
  }
}
template <class F>
void ml_writes(const Rig& rig, F&& f) {
  const MlTable& ml = rig.ml;
  for (const MlStep& step : ml.steps) {
    each_of(ml.controls.slice(step.first_scatter, step.scatter_count), f);
  }
  if (!ml.converts) return;
  for (const MlJoint& joint : ml.joints) each_of_joint(ml, joint, f);
}

template <class F>
void rbf_reads(const Rig& rig, F&& f) {
  for (const auto* controls : {&rig.rbf.inputs, &rig.rbf.rotations, &rig.rbf.pose_inputs}) {
    each_of(*controls, f);
  }
}
template <class F>
void rbf_writes(const Rig& rig, F&& f) {
  each_of(rig.rbf.pose_outputs, f);
}

template <class F>
void psd_reads(const Rig& rig, F&& f) {
  const uint32_t end = rig.raw_count + rig.psd_count;
  for (const uint16_t control : rig.psds.inputs) {
    // A corrective comes after those that it depends on, at each LOD.
    if (control < rig.raw_count || control >= end) f(control);
  }
}
template <class F>
void psd_writes(const Rig& rig, F&& f) {
  each_of(rig.psds.outputs, f);
}

template <class F>
void joint_reads(const Rig& rig, F&& f) {
  each_of(rig.joints.columns, f);
  each_of(rig.rotations.columns, f);
  each_of(rig.twist_swing.inputs, f);
  for (const MlJoint& joint : rig.ml.joints) each_of_joint(rig.ml, joint, f);
}

void mark_panels(const JointMatrix& joints, const Span<Uses>& uses) {
  const uint32_t panel_count = joints.panel_count();
  for (size_t k = 0; k < joints.columns.count; ++k) {
    const ColumnPart* parts = joints.parts.data + k * joints.panels.count;
    Uses marks = 0;
    for (uint32_t c = 0; c < panel_count; ++c) {
      const bool has_blocks =
          parts[c].pairs != parts[c + 1].pairs || parts[c].singles != parts[c + 1].singles;
      marks |= Uses{has_blocks} << panel_bit(joints, c);
    }
    uses[joints.columns[k]] |= marks;
  }
}

}  // namespace

void fill_stage_access(Rig& rig) {
  const Span<Uses>& uses = rig.control_uses;
  const auto mark = [&](uint32_t stage) {
    return [&uses, stage](uint32_t control) { uses[control] |= stage; };
  };
  ml_reads(rig, mark(kStageMl));
  rbf_reads(rig, mark(kStageRbf));
  psd_reads(rig, mark(kStagePsd));
  joint_reads(rig, mark(kStageJoints));
  each_of(rig.channels.inputs, mark(kStageBlendShapes));
  each_of(rig.maps.inputs, mark(kStageAnimatedMaps));
  mark_panels(rig.joints, uses);

  // By now only readers are marked.
  const auto find_feedback = [&](uint32_t stage) {
    return [&rig, stage](uint32_t control) {
      rig.feedback_stages |= rig.control_uses[control] & stage;
    };
  };
  ml_writes(rig, find_feedback(kStageMl));
  rbf_writes(rig, find_feedback(kStageRbf));

  const auto include = [](ControlRange& range) {
    return [&range](uint32_t control) {
      range.first = range.end == 0 ? control : std::min(range.first, control);
      range.end = std::max(range.end, control + 1);
    };
  };
  ml_writes(rig, include(rig.ml_writes));
  rbf_writes(rig, include(rig.rbf_writes));

  ml_writes(rig, mark(kStageMl));
  rbf_writes(rig, mark(kStageRbf));
  psd_writes(rig, mark(kStagePsd));
}

}  // namespace mien
