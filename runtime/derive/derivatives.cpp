// SPDX-License-Identifier: MIT
#include "runtime/derive/derivatives.h"

#include "runtime/derive/derive_stages.h"
#include "runtime/derive/jacobian.h"
#include "simd/derivative_kernels.h"

namespace mien {
namespace {

void place_networks(const Rig& rig, Placer& placer, Derivatives& d) {
  const MlTable& ml = rig.ml;
  size_t slopes = 0, transposed = 0, widest = 0;
  for (const NetworkLayer& layer : ml.layers) {
    transposed += padded(size_t{layer.input_count}) * layer.output_count;
    widest =
        std::max({widest, padded(size_t{layer.output_count}), padded(size_t{layer.input_count})});
  }
  widest = std::max(widest, padded(size_t{ml.widest_layer}));
  d.ml_masks = placer.array<float>(ml.steps.count);
  d.first_transposed = placer.array<uint64_t>(ml.layers.count);
  d.first_slope = placer.array<uint64_t>(ml.steps.count);
  for (size_t s = 0; s < ml.steps.count; ++s) {
    if (!placer.measuring()) d.first_slope[s] = slopes;
    for (uint32_t l = 0; l < ml.steps[s].layer_count; ++l) {
      slopes += padded(ml.layers[ml.steps[s].first_layer + l].output_count);
    }
  }
  d.slopes = placer.array<float>(slopes);
  d.transposed = placer.array<float>(transposed, kBlockAlignment);
  d.forward_weights = placer.array<float>(rig.half_storage ? ml.halves.count : 0, kBlockAlignment);
  d.zero_biases = placer.array<float>(widest, kBlockAlignment);
  d.ml_triples = placer.array<float>(ml.joints.count * 6);
  d.ml_turns = placer.array<float>(ml.joints.count * 16);
  d.ml_joint_slopes = placer.array<float>(ml.joints.count * 32);
  d.ml_values = placer.array<float>(size_t{ml.buffer_size} * kBatchLanes, kBlockAlignment);
  for (Span<float>& layer : d.ml_layers) {
    layer = placer.array<float>(widest * kBatchLanes, kBlockAlignment);
  }
}

void place_solvers(const Rig& rig, Placer& placer, Derivatives& d) {
  const RbfTable& rbf = rig.rbf;
  size_t slopes = 0, scratch = 0, poses = 0;
  d.rbf_first = placer.array<uint32_t>(rbf.plans.count);
  for (size_t s = 0; s < rbf.plans.count; ++s) {
    const RbfSolverPlan& plan = rbf.plans[s];
    if (!placer.measuring()) d.rbf_first[s] = static_cast<uint32_t>(slopes);
    slopes += size_t{plan.pose_count} * rbf_input_count(plan);
    const size_t compared = plan.input_count, count = plan.pose_count;
    scratch = std::max(scratch, compared * 6 + count * (2 * compared + 2));
    poses = std::max(poses, count);
  }
  d.rbf_slopes = placer.array<float>(slopes);
  d.rbf_scratch = placer.array<double>(scratch);
  d.rbf_factors = placer.array<float>(rbf.pose_scales.count);
  d.rbf_lanes = placer.array<float>(poses * kBatchLanes);
}

void place_joints(const Rig& rig, Placer& placer, Derivatives& d) {
  const JointMatrix& joints = rig.joints;
  const RotationTable& table = rig.rotations;
  size_t most_steps = 0;
  const size_t steps = table.first_steps.empty() ? 0 : table.first_steps[table.block_count()];
  for (const uint32_t count : table.steps_at_lod) most_steps = std::max<size_t>(most_steps, count);
  d.turn_slopes = placer.array<float>(steps * kBlockLanes * 4);
  d.turn_prefixes = placer.array<double>(most_steps * 4);
  d.angle_slopes = placer.array<float>(rig.quaternion_outputs ? size_t{rig.joint_count} * 12 : 0);
  d.twist_slopes = placer.array<float>(size_t{rig.twist_swing.block_count()} * kBlockLanes * 16);
  const size_t block_rows =
      joints.panels.empty() ? 0 : joints.panels[joints.panel_count()].first_block_row;
  const size_t angles = rig.quaternion_outputs ? size_t{rig.joint_count} * 3 : 0;
  d.value_rows = placer.array<uint32_t>(rig.joint_value_count() + angles);
  // Rows in pairs of block rows, which finish_sums() needs, too.
  const size_t rows = align_up(block_rows, size_t{2}) * kJointBlockRows;
  d.row_values = placer.array<uint32_t>(rows);
  d.columns_by_length = placer.array<uint32_t>(joints.columns.count);
  d.moved_columns = placer.array<uint8_t>(joints.columns.count);
  d.block_starts = placer.array<uint32_t>(block_rows + 1);
  d.block_ends = placer.array<uint32_t>(block_rows);
  size_t blocks = 0;
  for (size_t c = 0; c < joints.columns.count; ++c) {
    blocks += joints.blocks_before(c, joints.panel_count());
  }
  d.blocks = placer.array<InputBlock>(blocks + kBatchAhead);
  d.moving = placer.array<uint8_t>(rig.control_count);
  d.packed_rows = placer.array<float>(rows * kTransposedLanes, kBlockAlignment);
  d.joints = placer.array<float>((rig.joint_value_count() + angles) * kBatchLanes, kBlockAlignment);
}

void place_geometry(const Rig& rig, const Deformer& deformer, Placer& placer, Derivatives& d) {
  const size_t joints = rig.joint_count;
  place_joint_pose(deformer.skeleton, placer, d.pose);
  d.local_slopes = placer.array<float>(joints * (9 * 4 + 9));
  for (Span<float>* parts : {&d.locals, &d.models, &d.skins}) {
    *parts = placer.array<float>(joints * kMatrixParts * kBatchLanes, kBlockAlignment);
  }
  d.matrices = placer.array<float>(joints * kMatrixFloats, kBlockAlignment);
  d.linear_matrices = placer.array<float>(joints * kMatrixFloats, kBlockAlignment);
  size_t positions = 0;
  for (const DeformMesh& mesh : deformer.meshes) {
    positions = std::max<size_t>(positions, mesh.position_count);
  }
  d.shaped = placer.array<float>(size_t{kBlockPositions} * 4, kBlockAlignment);
  d.shaped_change = placer.array<float>(size_t{kBlockPositions} * 4, kBlockAlignment);
  d.skinned_change = placer.array<float>(positions * 3 + 4, kBlockAlignment);
  d.moved = placer.array<float>(positions * 3 + 4, kBlockAlignment);
}

void place(const Rig& rig, const Deformer* deformer, Placer& placer, Derivatives& d) {
  d.values = placer.array<float>(rig.control_count, kBlockAlignment);
  d.channels = placer.array<float>(rig.channel_count);
  d.gui_slopes = placer.array<TableSlope>(rig.gui_to_raw.inputs.count);
  d.map_slopes = placer.array<TableSlope>(rig.maps.inputs.count);
  d.psd_slopes = placer.array<float>(rig.psds.inputs.count);
  place_networks(rig, placer, d);
  place_solvers(rig, placer, d);
  place_joints(rig, placer, d);
  d.gui = placer.array<float>(size_t{rig.gui_count} * kBatchLanes, kBlockAlignment);
  d.controls = placer.array<float>(size_t{rig.control_count} * kBatchLanes, kBlockAlignment);
  d.maps = placer.array<float>(size_t{rig.map_count} * kBatchLanes, kBlockAlignment);
  d.weights = placer.array<float>(size_t{rig.channel_count} * kBatchLanes, kBlockAlignment);
  if (deformer) place_geometry(rig, *deformer, placer, d);
}

// The chain ---------------------------------------------------------------------------------------

bool has_stage(const Derivatives& d, uint32_t stage) { return (d.stages & stage) != 0; }

/// Where the numbers of a point are; matrices and positions are apart.
const Span<float>& buffer_of(const Derivatives& d, Point point) {
  switch (point) {
    case Point::kGui: return d.gui;
    case Point::kRaw: return d.controls;
    case Point::kControls: return d.controls;
    case Point::kJoints: return d.joints;
    case Point::kLocals: return d.locals;
    case Point::kModels: return d.models;
    case Point::kSkins: return d.skins;
    case Point::kChannels: return d.weights;
    case Point::kMaps: return d.maps;
    case Point::kPositions: break;
  }
  return d.moved;
}

bool is_matrix(Point point) { return point >= Point::kLocals && point <= Point::kSkins; }

template <uint32_t L>
void load(Derivatives& d, Point point, uint32_t count, const float* rows) {
  const size_t size = point_size(d, point, 0);
  float* const buffer = buffer_of(d, point).data;
  if (L == kBatchLanes && !is_matrix(point)) {
    const float* lanes[kBatchLanes];
    for (uint32_t k = 0; k < count; ++k) lanes[k] = rows + k * size;
    d.rig->kernels->gather_lanes(lanes, count, size, buffer);
    return;
  }
  for (uint32_t k = 0; k < count; ++k) {
    for (size_t i = 0; i < size; ++i) {
      const size_t at = place_in_buffer(point, i);
      if (at != kNoPlace) buffer[at * L + k] = rows[k * size + i];
    }
  }
}

template <uint32_t L>
void save(Derivatives& d, Point point, uint32_t count, float* rows) {
  const size_t size = point_size(d, point, 0);
  const float* const buffer = buffer_of(d, point).data;
  if (L == kBatchLanes && !is_matrix(point)) {
    float* lanes[kBatchLanes];
    for (uint32_t k = 0; k < count; ++k) lanes[k] = rows + k * size;
    d.rig->kernels->scatter_lanes(buffer, size, count, lanes, 0);
    return;
  }
  for (uint32_t k = 0; k < count; ++k) {
    for (size_t i = 0; i < size; ++i) {
      const size_t at = place_in_buffer(point, i);
      rows[k * size + i] = at == kNoPlace ? 0.0f : buffer[at * L + k];
    }
  }
}

/// Of buffers that stages do not write in full.
void clear_buffers(std::initializer_list<const Span<float>*> buffers, uint32_t lanes) {
  for (const Span<float>* buffer : buffers) {
    std::fill(buffer->data, buffer->data + buffer->count / kBatchLanes * lanes, 0.0f);
  }
}
void clear_for_push(Derivatives& d, Point from, Point to, uint32_t lanes) {
  clear_buffers({&d.controls, &d.weights}, lanes);
  if (to == Point::kMaps) clear_buffers({&d.maps}, lanes);
  if (from == Point::kChannels) clear_buffers({&d.skins}, lanes);
  const bool joints_count = to >= Point::kJoints && to <= Point::kPositions;
  if (!has_stage(d, kStageJoints) && joints_count) clear_buffers({&d.joints}, lanes);
}
void clear_for_pull(Derivatives& d, Point to, uint32_t lanes) {
  clear_buffers({&d.gui, &d.controls, &d.weights}, lanes);
  if (to >= Point::kJoints && to <= Point::kPositions) clear_buffers({&d.joints}, lanes);
  if (to == Point::kPositions) clear_buffers({&d.skins}, lanes);
}

/// Whether the stage that leads from `point` to the next one lies between `from` and `to`.
bool passes(Point from, Point to, Point point) { return from <= point && point < to; }

/// The chain up to what is in buffers: skin matrices and channel weights for positions.
template <uint32_t L>
void push_buffers(Derivatives& d, Point from, Point to) {
  const bool to_positions = to == Point::kPositions;
  const Point end = to == Point::kChannels || to == Point::kMaps ? Point::kControls : to;
  if (passes(from, end, Point::kGui)) push_gui<L>(d);
  if (passes(from, end, Point::kRaw)) {
    if (has_stage(d, kStageMl)) push_ml<L>(d);
    if (has_stage(d, kStageRbf)) push_rbf<L>(d);
    if (has_stage(d, kStagePsd)) push_psds<L>(d);
  }
  if (from <= Point::kControls && has_stage(d, kStageBlendShapes) &&
      (to == Point::kChannels || to_positions)) {
    push_channels<L>(d);
  }
  if (to == Point::kMaps && has_stage(d, kStageAnimatedMaps)) push_maps<L>(d);
  if (passes(from, end, Point::kControls) && has_stage(d, kStageJoints)) {
    push_joint_rows<L>(d);
    push_rotations<L>(d);
  }
  if (passes(from, end, Point::kJoints)) push_locals<L>(d);
  if (passes(from, end, Point::kLocals)) push_models<L>(d);
  if (passes(from, end, Point::kModels)) push_skins<L>(d);
}

template <uint32_t L>
void push_lanes(Derivatives& d, Point from, Point to, uint32_t mesh, uint32_t count,
                const float* directions, float* outputs) {
  clear_for_push(d, from, to, L);
  d.lane_count = count;
  load<L>(d, from, count, directions);
  push_buffers<L>(d, from, to);
  if (to != Point::kPositions) return save<L>(d, to, count, outputs);
  const size_t size = point_size(d, to, mesh);
  for (uint32_t k = 0; k < count; ++k) push_positions(d, mesh, k, L, outputs + k * size);
}

template <uint32_t L>
void pull_lanes(Derivatives& d, Point from, Point to, uint32_t mesh, uint32_t count,
                const float* gradients, float* outputs) {
  clear_for_pull(d, to, L);
  d.lane_count = count;
  const bool to_positions = to == Point::kPositions;
  d.all_move = from == Point::kControls;
  if (to_positions) {
    const size_t size = point_size(d, to, mesh);
    for (uint32_t k = 0; k < count; ++k) pull_positions(d, mesh, k, L, gradients + k * size);
  } else {
    load<L>(d, to, count, gradients);
  }
  const Point end = to == Point::kChannels || to == Point::kMaps ? Point::kControls : to;
  if (passes(from, end, Point::kModels)) pull_skins<L>(d);
  if (passes(from, end, Point::kLocals)) pull_models<L>(d);
  if (passes(from, end, Point::kJoints)) pull_locals<L>(d);
  if (passes(from, end, Point::kControls) && has_stage(d, kStageJoints)) {
    pull_rotations<L>(d);
    pull_joint_rows<L>(d);
  }
  if (to == Point::kMaps && has_stage(d, kStageAnimatedMaps)) pull_maps<L>(d);
  if (from <= Point::kControls && has_stage(d, kStageBlendShapes) &&
      (to == Point::kChannels || to_positions)) {
    pull_channels<L>(d);
  }
  if (passes(from, end, Point::kRaw)) {
    if (has_stage(d, kStagePsd)) pull_psds<L>(d);
    if (has_stage(d, kStageRbf)) pull_rbf<L>(d);
    if (has_stage(d, kStageMl)) pull_ml<L>(d);
  }
  if (passes(from, end, Point::kGui)) pull_gui<L>(d);
  save<L>(d, from, count, outputs);
}

/// Runs lanes of kBatchLanes rows, and single rows one at a time.
template <class One, class Many>
void in_lanes(uint32_t count, One&& one, Many&& many) {
  uint32_t k = 0;
  for (; count - k > 1; k += std::min(count - k, kBatchLanes)) {
    many(k, std::min(count - k, kBatchLanes));
  }
  if (k < count) one(k);
}

}  // namespace

// Columns of a color share a direction. Each row has an entry of at most one of them, so it gets what a
// direction of that column alone gives.
void find_jacobian(Derivatives& d, const Jacobian& jacobian, const uint8_t* wanted, float* values) {
  constexpr uint32_t L = kBatchLanes;
  const Span<uint32_t>& first = jacobian.first_of_color;
  const auto is_wanted = [&](uint32_t column) { return !wanted || wanted[column] != 0; };
  for (uint32_t color = 0; color < jacobian.color_count();) {
    clear_for_push(d, jacobian.from, jacobian.to, L);
    clear_buffers({&buffer_of(d, jacobian.from)}, L);
    // Lanes of the next colors that have a wanted column.
    uint32_t colors[L];
    d.lane_count = 0;
    for (; color < jacobian.color_count() && d.lane_count < L; ++color) {
      bool any = false;
      for (const uint32_t c :
           jacobian.by_color.slice(first[color], first[color + 1] - first[color])) {
        if (!is_wanted(c)) continue;
        any = true;
        const size_t at = jacobian.column_places[c];
        buffer_of(d, jacobian.from).data[at * L + d.lane_count] = 1.0f;
      }
      if (any) colors[d.lane_count++] = color;
    }
    if (d.lane_count == 0) return;
    push_buffers<L>(d, jacobian.from, jacobian.to);
    const bool to_positions = jacobian.to == Point::kPositions;
    for (uint32_t k = 0; k < d.lane_count; ++k) {
      if (to_positions) push_positions(d, jacobian.mesh, k, L, d.moved.data);
      const float* const results = to_positions ? d.moved.data : buffer_of(d, jacobian.to).data + k;
      const size_t stride = to_positions ? 1 : L;
      const uint32_t begin = first[colors[k]], end = first[colors[k] + 1];
      for (const uint32_t c : jacobian.by_color.slice(begin, end - begin)) {
        if (!is_wanted(c)) continue;
        for (size_t e = jacobian.first_entry[c]; e < jacobian.first_entry[c + 1]; ++e) {
          values[e] = results[jacobian.row_places[jacobian.rows[e]] * stride];
        }
      }
    }
  }
}

size_t derivatives_size(const Rig& rig, const Deformer* deformer) {
  return block_bytes<Derivatives>(
      [&](Placer& placer, Derivatives& d) { place(rig, deformer, placer, d); });
}

Derivatives* create_derivatives(const Rig& rig, const Deformer* deformer,
                                const Allocator& allocator) {
  auto* const d = create_object<Derivatives>(allocator, [&](Placer& placer, Derivatives& placed) {
    place(rig, deformer, placer, placed);
  });
  if (!d) return nullptr;
  d->rig = share(rig);
  if (deformer) d->deformer = share(*deformer);
  pack_networks(*d);
  count_blocks(*d);
  return d;
}

size_t point_size(const Derivatives& d, Point point, uint32_t mesh) {
  const Rig& rig = *d.rig;
  switch (point) {
    case Point::kGui: return rig.gui_count;
    case Point::kRaw: return rig.raw_count;
    case Point::kControls: return rig.control_count;
    case Point::kJoints: return rig.joint_value_count();
    case Point::kLocals:
    case Point::kModels:
    case Point::kSkins: return d.deformer ? size_t{rig.joint_count} * kMatrixFloats : 0;
    case Point::kPositions: return size_t{d.deformer->meshes[mesh].position_count} * 3;
    case Point::kChannels: return rig.channel_count;
    case Point::kMaps: return rig.map_count;
  }
  return 0;
}

bool leads_to(Point from, Point to) {
  if (from == Point::kMaps) return false;
  if (from == Point::kChannels) return to == Point::kPositions;
  if (to == Point::kChannels || to == Point::kMaps) return from <= Point::kControls;
  return from < to;
}

void linearize(Derivatives& d, const Instance& instance, uint32_t stages) {
  const Rig& rig = *d.rig;
  if (!d.linearized || d.lod != instance.lod) {
    d.lod = instance.lod;
    find_joint_rows(d);
  }
  d.stages = stages;
  std::copy(instance.controls.begin(), instance.controls.end(), d.values.begin());
  std::copy(instance.channels.begin(), instance.channels.end(), d.channels.begin());
  std::fill(d.moving.begin(), d.moving.end(), uint8_t{0});
  std::fill(d.moving.data, d.moving.data + rig.raw_count, uint8_t{1});
  linearize_tables(d, instance);
  if (stages & kStageMl) linearize_ml(d, instance);
  if (stages & kStageRbf) linearize_rbf(d);
  if (stages & kStagePsd) linearize_psds(d);
  if (stages & kStageJoints) linearize_rotations(d, instance);
  if (d.deformer) linearize_pose(d, instance);
  d.linearized = true;
}

void push(Derivatives& d, Point from, Point to, uint32_t mesh, uint32_t count,
          const float* directions, float* outputs) {
  const size_t in = point_size(d, from, mesh), out = point_size(d, to, mesh);
  in_lanes(
      count,
      [&](uint32_t k) {
        push_lanes<1>(d, from, to, mesh, 1, directions + k * in, outputs + k * out);
      },
      [&](uint32_t k, uint32_t n) {
        push_lanes<kBatchLanes>(d, from, to, mesh, n, directions + k * in, outputs + k * out);
      });
}

void pull(Derivatives& d, Point from, Point to, uint32_t mesh, uint32_t count,
          const float* gradients, float* outputs) {
  const size_t in = point_size(d, to, mesh), out = point_size(d, from, mesh);
  in_lanes(
      count,
      [&](uint32_t k) {
        pull_lanes<1>(d, from, to, mesh, 1, gradients + k * in, outputs + k * out);
      },
      [&](uint32_t k, uint32_t n) {
        pull_lanes<kBatchLanes>(d, from, to, mesh, n, gradients + k * in, outputs + k * out);
      });
}

}  // namespace mien
