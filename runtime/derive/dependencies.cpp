// SPDX-License-Identifier: MIT
#include "runtime/derive/dependencies.h"

#include "runtime/derive/derive_stages.h"
#include "runtime/eval/stages.h"

namespace mien {
namespace {

uint64_t union_of(const uint64_t* sets, size_t count) {
  uint64_t all = 0;
  for (size_t i = 0; i < count; ++i) all |= sets[i];
  return all;
}

void spread_table(const ControlTable& table, size_t row_count, const uint64_t* inputs,
                  uint64_t* outputs) {
  for (size_t r = 0; r < row_count; ++r) {
    if (table.slope[r] != 0.0f) outputs[table.outputs[r]] |= inputs[table.inputs[r]];
  }
}

// Stages that write controls add to their sets: a stage may be left out, which keeps what was there.

void spread_triple(const Dependencies& s, const uint16_t* controls) {
  uint64_t v[3] = {};
  for (int i = 0; i < 3; ++i) v[i] = controls[i] == kNoControl ? 0 : s.controls[controls[i]];
  for (int i = 0; i < 3; ++i) {
    if (controls[i] != kNoControl) s.controls[controls[i]] |= v[s.rig->ml.change.from[i]];
  }
}

void spread_ml(const Dependencies& s) {
  const MlTable& ml = s.rig->ml;
  for (const MlStep& step : ml.steps) {
    if (!is_at_lod(step.lods, s.lod)) continue;
    uint64_t* const outputs = s.ml_values.data + step.first_output;
    if (step.layer_count == 0) {
      for_each_ml_term<1>(ml, step, s.controls.data, s.ml_values.data,
                          [&](const uint64_t* from, uint32_t i, float) { outputs[i] |= *from; });
      continue;
    }
    uint64_t all = 0;
    for_each_ml_input<1>(ml, step, s.controls.data, s.ml_values.data,
                         [&](const uint64_t* from, uint32_t) { all |= *from; });
    std::fill(outputs, outputs + step.output_count, all);
    const uint32_t count = scatter_count(*s.rig, step, s.lod);
    for (uint32_t i = 0; i < count; ++i) s.controls[ml.controls[step.first_scatter + i]] |= all;
  }
  if (!ml.converts) return;
  const uint32_t parts = ml.quaternion_rotations ? 4 : 3;
  for (const MlJoint& joint : ml.joints) {
    spread_triple(s, joint.translation);
    spread_triple(s, joint.scale);
    if (joint.rotation_control == kNoControl) continue;
    uint64_t* const rotation = s.controls.data + joint.rotation_control;
    std::fill(rotation, rotation + parts, union_of(rotation, parts));
  }
}

void spread_rbf(const Dependencies& s) {
  const RbfTable& rbf = s.rig->rbf;
  if (s.rig->rbf_count == 0) return;
  for (const uint16_t index : rbf.lod_solvers.at(s.lod)) {
    const RbfSolverPlan& plan = rbf.plans[index];
    uint64_t all = 0;
    for (uint32_t i = 0; i < rbf_input_count(plan); ++i) {
      all |= s.controls[rbf_input_control(rbf, plan, i)];
    }
    for (uint32_t t = 0; t < plan.pose_count; ++t) {
      if (plan.first_control != kNoFirstControl) {
        s.controls[plan.first_control + t] |= all;
        continue;
      }
      const uint32_t pose = rbf.poses[rbf.solvers[index].first_pose + t];
      uint64_t factor = all;
      for (uint32_t i = rbf.first_input[pose]; i < rbf.first_input[pose + 1]; ++i) {
        factor |= s.controls[rbf.pose_inputs[i]];
      }
      for (uint32_t o = rbf.first_output[pose]; o < rbf.first_output[pose + 1]; ++o) {
        s.controls[rbf.pose_outputs[o]] |= factor;
      }
    }
  }
}

void spread_psds(const Dependencies& s) {
  const PsdTable& psds = s.rig->psds;
  for (uint32_t e = 0; e < psds.count_at_lod[s.lod]; ++e) {
    for (uint32_t i = psds.first_input[e]; i < psds.first_input[e + 1]; ++i) {
      s.controls[psds.outputs[e]] |= s.controls[psds.inputs[i]];
    }
  }
}

void spread_channels(const Dependencies& s) {
  const ChannelTable& channels = s.rig->channels;
  for (uint32_t i = 0; i < channels.count_at_lod[s.lod]; ++i) {
    s.weights[channels.outputs[i]] = s.controls[channels.inputs[i]];
  }
}

void spread_joint_rows(const Dependencies& s) {
  const JointMatrix& joints = s.rig->joints;
  const uint32_t panels = joints.panels_at_lod[s.lod];
  const bool fixed = joints.values.empty();
  for (size_t c = 0; c < joints.columns.count; ++c) {
    const uint64_t set = s.controls[joints.columns[c]];
    if (set == 0) continue;
    joints.for_each_block(c, panels, [&](size_t block, size_t block_row) {
      for (size_t r = 0; r < kJointBlockRows; ++r) {
        const size_t i = block * kJointBlockRows + r;
        const bool any = fixed ? joints.fixed_values[i] != 0 : joints.values[i] != 0.0f;
        if (any) s.packed_rows[block_row * kJointBlockRows + r] |= set;
      }
    });
  }
  for (size_t value = 0; value < s.value_rows.count; ++value) {
    if (s.value_rows[value] != kNoRow) s.joints[value] = s.packed_rows[s.value_rows[value]];
  }
}

void spread_ml_joint(const Dependencies& s, const MlJoint& joint) {
  const Rig& rig = *s.rig;
  uint64_t* const out = s.joints.data + size_t{joint.joint} * rig.joint_attributes;
  uint64_t* const scale = out + rig.joint_attributes - 3;
  for (uint32_t i = 0; i < 3; ++i) {
    if (joint.translation[i] != kNoControl) out[i] |= s.controls[joint.translation[i]];
    if (joint.scale[i] != kNoControl) scale[i] |= s.controls[joint.scale[i]];
  }
  if (joint.rotation_control == kNoControl) return;
  uint64_t* const rotation = out + 3;
  const uint64_t* const x = s.controls.data + joint.rotation_control;
  if (!rig.quaternion_outputs && !rig.ml.quaternion_rotations) {  // angles are added
    for (uint32_t i = 0; i < 3; ++i) rotation[i] |= x[i];
    return;
  }
  const uint64_t turn = union_of(x, rig.ml.quaternion_rotations ? 4 : 3);
  const uint64_t before = rig.quaternion_outputs ? union_of(rotation, 4) : 0;
  for (uint32_t i = 0; i < (rig.quaternion_outputs ? 4u : 3u); ++i) rotation[i] |= before | turn;
}

void spread_rotations(const Dependencies& s) {
  const Rig& rig = *s.rig;
  const auto assign = [&](uint32_t joint, uint64_t set) {
    uint64_t* const rotation = s.joints.data + rotation_value(rig, joint);
    std::fill(rotation, rotation + (rig.quaternion_outputs ? 4 : 3), set);
  };
  for_each_output(rig.rotations.turns, s.lod, turn_blocks(rig, s.lod),
                  [&](const RotationOutput& output) {
                    uint64_t all = 0;
                    for_each_step(rig, s.lod, output.lane,
                                  [&](uint16_t control, size_t) { all |= s.controls[control]; });
                    assign(output.joint, all);
                  });
  for_each_angle_joint(rig, s.lod, [&](uint32_t joint) {
    assign(joint, union_of(s.joints.data + rig.joint_value_count() + size_t{joint} * 3, 3));
  });
  for_each_output(rig.twist_swing.outputs, s.lod, twist_blocks(rig, s.lod),
                  [&](const RotationOutput& output) {
                    uint64_t all = 0;
                    for (size_t k = 0; k < 4; ++k) {
                      all |= s.controls[twist_input(rig.twist_swing, output.lane, k)];
                    }
                    assign(output.joint, all);
                  });
  for (const MlJoint& joint : rig.ml.joints) {
    if (is_at_lod(joint.lods, s.lod)) spread_ml_joint(s, joint);
  }
}

void spread_locals(const Dependencies& s) {
  const Skeleton& skeleton = s.deformer->skeleton;
  const uint32_t rotations = skeleton.quaternions() ? 4 : 3;
  for (size_t joint = 0; joint < skeleton.joint_count; ++joint) {
    const uint64_t* y = s.joints.data + joint * skeleton.joint_attributes;
    uint64_t* const to = s.locals.data + joint * kMatrixParts;
    const uint64_t turn = union_of(y + 3, rotations);
    for (size_t a = 0; a < 9; ++a) to[a] = turn | y[3 + rotations + a / 3];
    std::copy(y, y + 3, to + 9);
  }
}

void spread_models(const Dependencies& s) {
  const Skeleton& skeleton = s.deformer->skeleton;
  for (const uint16_t joint : skeleton.order) {
    const size_t parent = skeleton.parents[joint];
    const uint64_t* local = s.locals.data + size_t{joint} * kMatrixParts;
    uint64_t* const to = s.models.data + size_t{joint} * kMatrixParts;
    if (parent == joint) {
      std::copy(local, local + kMatrixParts, to);
      continue;
    }
    const uint64_t* moved = s.models.data + parent * kMatrixParts;
    for (size_t c = 0; c < 4; ++c) {
      for (size_t r = 0; r < 3; ++r) {
        to[3 * c + r] = union_of(local + 3 * c, 3) | moved[r] | moved[3 + r] | moved[6 + r] |
                        (c == 3 ? moved[9 + r] : 0);
      }
    }
  }
}

void spread_skins(const Dependencies& s) {
  const Skeleton& skeleton = s.deformer->skeleton;
  for (size_t joint = 0; joint < skeleton.joint_count; ++joint) {
    const float* bind = skeleton.inverse_bind.data + joint * kMatrixFloats;
    const uint64_t* model = s.models.data + joint * kMatrixParts;
    uint64_t* const to = s.skins.data + joint * kMatrixParts;
    for (size_t c = 0; c < 4; ++c) {
      for (size_t k = 0; k < 4; ++k) {
        if (bind[4 * c + k] == 0.0f) continue;
        for (size_t r = 0; r < 3; ++r) to[3 * c + r] |= model[3 * k + r];
      }
    }
  }
}

void spread_positions(const Dependencies& s) {
  const DeformMesh& mesh = s.deformer->meshes[s.mesh];
  // Coordinate r of a skinned position reads row r of its matrices: one set per row, in the first column.
  for (size_t joint = 0; joint < s.deformer->skeleton.joint_count; ++joint) {
    uint64_t* const skin = s.skins.data + joint * kMatrixParts;
    for (size_t r = 0; r < 3; ++r) skin[r] |= skin[3 + r] | skin[6 + r] | skin[9 + r];
  }
  for (uint32_t block = 0; mesh.target_count != 0 && block < mesh.block_count(); ++block) {
    std::fill(s.shaped.begin(), s.shaped.end(), uint64_t{0});
    const uint32_t end = mesh.first_target_run[block + 1];
    for (uint32_t i = mesh.first_target_run[block]; i < end; ++i) {
      const TargetRun& run = mesh.target_runs[i];
      const uint64_t set = s.weights[run.channel];
      if (set == 0) continue;
      for_each_delta(mesh, run, [&](uint32_t index, const float*) { s.shaped[index] |= set; });
    }
    const uint32_t first = block * kBlockPositions;
    const uint32_t count = std::min(kBlockPositions, mesh.position_count - first);
    for (uint32_t i = 0; i < count; ++i) {
      uint64_t* const to = s.positions.data + size_t{mesh.position_of(first + i)} * 3;
      std::fill(to, to + 3, s.shaped[i]);
    }
  }
  for (const SkinRun& run : mesh.skin_runs) {
    for (uint32_t i = 0; i < run.count; ++i) {
      uint64_t* const to = s.positions.data + size_t{mesh.position_of(run.first + i)} * 3;
      const uint16_t* joints = mesh.joints.data + run.first_weight + size_t{i} * run.influences;
      for (uint32_t k = 0; k < run.influences; ++k) {
        const uint64_t* skin = s.skins.data + size_t{joints[k]} * kMatrixParts;
        for (size_t r = 0; r < 3; ++r) to[r] |= skin[r];
      }
    }
  }
}

}  // namespace

const Span<uint64_t>& Dependencies::at(Point point) const {
  switch (point) {
    case Point::kGui: return gui;
    case Point::kRaw: return controls;
    case Point::kControls: return controls;
    case Point::kJoints: return joints;
    case Point::kLocals: return locals;
    case Point::kModels: return models;
    case Point::kSkins: return skins;
    case Point::kChannels: return weights;
    case Point::kMaps: return maps;
    case Point::kPositions: break;
  }
  return positions;
}

bool place_dependencies(const Derivatives& d, Point to, uint32_t mesh, uint32_t lod, Arena& arena,
                        Dependencies& s) {
  const Rig& rig = *d.rig;
  s.rig = d.rig;
  s.deformer = d.deformer;
  s.lod = lod;
  s.mesh = mesh;
  const bool to_positions = to == Point::kPositions;
  const bool geometry = to >= Point::kLocals && to <= Point::kPositions;
  const size_t parts = geometry ? size_t{rig.joint_count} * kMatrixParts : 0;
  const size_t positions = to_positions ? d.deformer->meshes[mesh].position_count : 0;
  const std::pair<Span<uint64_t>*, size_t> lists[] = {
      {&s.gui, rig.gui_count},
      {&s.controls, rig.control_count},
      {&s.weights, rig.channel_count},
      {&s.maps, rig.map_count},
      {&s.ml_values, rig.ml.buffer_size},
      {&s.packed_rows, d.packed_rows.count},
      {&s.joints, d.value_rows.count},
      {&s.locals, parts},
      {&s.models, parts},
      {&s.skins, parts},
      {&s.positions, positions * 3},
      {&s.shaped, to_positions ? kBlockPositions : 0},
  };
  size_t all = 0;
  for (const auto& list : lists) all += list.second;
  s.sets = arena.array<uint64_t>(all);
  s.value_rows = arena.array<uint32_t>(d.value_rows.count);
  if ((!s.sets.data && all != 0) || (!s.value_rows.data && d.value_rows.count != 0)) return false;
  size_t first = 0;
  for (const auto& list : lists) {
    *list.first = s.sets.slice(first, list.second);
    first += list.second;
  }
  find_value_rows(rig, lod, s.value_rows);
  return true;
}

void find_dependencies(const Dependencies& s, Point from, Point to) {
  const bool to_positions = to == Point::kPositions;
  const bool to_channels = to == Point::kChannels || to_positions;
  const Point end = to == Point::kChannels || to == Point::kMaps ? Point::kControls : to;
  const auto passes = [&](Point point) { return from <= point && point < end; };
  if (passes(Point::kGui)) {
    const ControlTable& table = s.rig->gui_to_raw;
    spread_table(table, table.inputs.count, s.gui.data, s.controls.data);
  }
  if (passes(Point::kRaw)) {
    spread_ml(s);
    spread_rbf(s);
    spread_psds(s);
  }
  if (from <= Point::kControls && to_channels) spread_channels(s);
  if (to == Point::kMaps) {
    spread_table(s.rig->maps, s.rig->map_rows_at_lod[s.lod], s.controls.data, s.maps.data);
  }
  if (passes(Point::kControls)) {
    spread_joint_rows(s);
    spread_rotations(s);
  }
  if (passes(Point::kJoints)) spread_locals(s);
  if (passes(Point::kLocals)) spread_models(s);
  if (passes(Point::kModels)) spread_skins(s);
  if (to_positions) spread_positions(s);
}

}  // namespace mien
