// SPDX-License-Identifier: MIT
#include "author/document/renumber.h"

#include <algorithm>

#include "author/document/deep_copy.h"
#include "author/document/turn_order.h"

namespace mien::author {

using dna::Array;
using dna::List;
using dna::NewArray;

namespace {

/// Applies a renumbering to fields. After memory ran out it does nothing.
class Renumberer {
 public:
  Renumberer(const Renumbering& numbers, Arena& arena) : numbers_(numbers), arena_(arena) {}

  bool ok() const { return ok_; }
  void fail() { ok_ = false; }
  uint32_t new_of(uint32_t old) const {
    return old < numbers_.new_of.count ? numbers_.new_of[old] : kGone;
  }

  // Fields with an element for each of the kind -----------------------------------------------------

  template <class T>
  void owned(Array<T>& array) {
    const Array<T> old = array;
    if (!ok_ || stays(old.count)) return;
    const NewArray<T> out = make<T>(new_count(old.count));
    for (uint32_t k = 0; k < out.count; ++k) {
      const uint32_t from = numbers_.old_of[k];
      out.set(k, from < old.count ? old[from] : T{});
    }
    array = out;
  }
  template <class T>
  void owned(List<T>& list) {
    const List<T> old = list;
    if (!ok_ || stays(old.count)) return;
    const Span<T> out = arena_.array<T>(new_count(old.count));
    if (out.count != new_count(old.count)) return void(ok_ = false);
    for (size_t k = 0; k < out.count; ++k) {
      const uint32_t from = numbers_.old_of[k];
      if (from < old.count) out[k] = old[from];
    }
    list = {out.data, static_cast<uint32_t>(out.count)};
  }
  void owned(dna::Vec3Array& vectors) {
    owned(vectors.xs);
    owned(vectors.ys);
    owned(vectors.zs);
  }

  // Fields with numbers -----------------------------------------------------------------------------

  /// A set: numbers that are gone drop out, those that become one stay once.
  void listed(Array<uint16_t>& list) {
    const Array<uint16_t> old = list;
    if (!ok_ || same(old)) return;
    const NewArray<uint16_t> out = make<uint16_t>(old.count);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < out.count; ++i) {
      const uint32_t number = new_of(old[i]);
      if (number == kGone || is_among(Array<uint16_t>(out).first(kept), number)) continue;
      out.set(kept++, static_cast<uint16_t>(number));
    }
    list = Array<uint16_t>(out).first(kept);
  }
  void listed(dna::LodMap& map) {
    if (!copy(map.indices)) return;
    for (Array<uint16_t>& row : map.indices) listed(row);
  }

  /// Numbers, none of which is gone.
  void renamed(Array<uint16_t>& array) {
    const Array<uint16_t> old = array;
    if (!ok_ || same(old)) return;
    const NewArray<uint16_t> out = make<uint16_t>(old.count);
    for (uint32_t i = 0; i < out.count; ++i) out.set(i, static_cast<uint16_t>(new_of(old[i])));
    array = out;
  }

  /// Rows of a table: those whose `key` is gone drop out of all its columns. A key is `width` times a
  /// number of the kind, plus something less.
  template <class... Columns>
  void rows(uint32_t width, Array<uint16_t>& key, Columns&... columns) {
    rows_of_lods(nullptr, width, key, columns...);
  }
  /// The same where `lods` says how many of the first rows each LOD has.
  template <class... Columns>
  void rows_of_lods(Array<uint16_t>* lods, uint32_t width, Array<uint16_t>& key,
                    Columns&... columns) {
    const Array<uint16_t> old = key;
    if (!ok_ || same(old, width)) return;
    const Span<uint32_t> kept = arena_.array<uint32_t>(old.count);
    const NewArray<uint16_t> out = make<uint16_t>(old.count);
    if (!kept.data) ok_ = false;
    if (!ok_) return;
    uint32_t count = 0;
    for (uint32_t i = 0; i < old.count; ++i) {
      const uint32_t number = new_of(old[i] / width);
      if (number == kGone) continue;
      out.set(count, static_cast<uint16_t>(number * width + old[i] % width));
      kept[count++] = i;
    }
    key = Array<uint16_t>(out).first(count);
    (pick(columns, kept.first(count), old.count), ...);
    if (!lods) return;
    const Array<uint16_t> old_lods = *lods;
    const NewArray<uint16_t> new_lods = make<uint16_t>(old_lods.count);
    for (uint32_t l = 0; l < new_lods.count; ++l) {
      const uint32_t* end = std::lower_bound(kept.data, kept.data + count, uint32_t{old_lods[l]});
      new_lods.set(l, static_cast<uint16_t>(end - kept.data));
    }
    *lods = new_lods;
  }

  /// Columns of a matrix of `rows` rows: those whose number is gone drop out.
  void columns(Array<uint16_t>& key, Array<float>& values, uint32_t rows) {
    const Array<uint16_t> old = key;
    const Array<float> matrix = values;
    if (!ok_ || same(old)) return;
    const NewArray<uint16_t> out = make<uint16_t>(old.count);
    const NewArray<float> kept = make<float>(matrix.count);
    uint32_t count = 0;
    for (uint32_t i = 0; ok_ && i < old.count; ++i) {
      if (new_of(old[i]) != kGone) out.set(count++, static_cast<uint16_t>(new_of(old[i])));
    }
    for (uint32_t r = 0, k = 0; ok_ && r < rows; ++r) {
      for (uint32_t c = 0; c < old.count; ++c) {
        if (new_of(old[c]) != kGone) kept.set(k++, matrix[r * old.count + c]);
      }
    }
    if (!ok_) return;
    key = Array<uint16_t>(out).first(count);
    values = Array<float>(kept).first(size_t{rows} * count);
  }

  bool any_gone(const Array<uint16_t>& numbers) const {
    for (uint32_t i = 0; i < numbers.count; ++i) {
      if (new_of(numbers[i]) == kGone) return true;
    }
    return false;
  }

  template <class T>
  bool copy(List<T>& list) {
    ok_ = ok_ && copy_list(arena_, list);
    return ok_;
  }

 private:
  template <class T>
  NewArray<T> make(size_t count) {
    const NewArray<T> array = dna::new_array<T>(arena_, count);
    if (count == 0 || array.data) return array;
    ok_ = false;
    return {};
  }

  /// Lists may be shorter than the kind (jbmd), whose other elements have defaults.
  bool stays(uint32_t count) const {
    if (numbers_.old_of.count < count) return false;
    if (count == numbers_.new_of.count && numbers_.old_of.count != count) return false;
    for (uint32_t i = 0; i < count; ++i) {
      if (numbers_.old_of[i] != i) return false;
    }
    return true;
  }
  uint32_t new_count(uint32_t old_count) const {
    if (old_count == numbers_.new_of.count) return static_cast<uint32_t>(numbers_.old_of.count);
    uint32_t count = 0;  // up to the last that has data
    for (uint32_t k = 0; k < numbers_.old_of.count; ++k) {
      if (numbers_.old_of[k] < old_count) count = k + 1;
    }
    return count;
  }

  bool same(const Array<uint16_t>& numbers, uint32_t width = 1) const {
    for (uint32_t i = 0; i < numbers.count; ++i) {
      if (new_of(numbers[i] / width) != numbers[i] / width) return false;
    }
    return true;
  }
  bool is_among(const Array<uint16_t>& list, uint32_t number) {
    if (several_become_one()) {
      for (uint32_t i = 0; i < list.count; ++i) {
        if (list[i] == number) return true;
      }
    }
    return false;
  }
  bool several_become_one() {
    if (several_ == 2) {
      size_t kept = 0, with_data = 0;
      for (uint32_t number : numbers_.new_of) kept += number != kGone;
      for (uint32_t old : numbers_.old_of) with_data += old != kGone;
      several_ = kept > with_data;
    }
    return several_ == 1;
  }

  /// Elements of a column; columns of matrices have several elements for each row.
  template <class T>
  void pick(Array<T>& array, const Span<uint32_t>& kept, uint32_t rows) {
    const Array<T> old = array;
    const uint32_t width = rows ? old.count / rows : 0;
    const NewArray<T> out = make<T>(kept.count * width);
    if (!ok_ || out.count == 0) return void(array = {});
    const size_t bytes = size_t{width} * sizeof(T);
    for (size_t k = 0; k < kept.count; ++k)
      memcpy(out.data + k * bytes, old.data + kept[k] * bytes, bytes);
    array = out;
  }

  const Renumbering& numbers_;
  Arena& arena_;
  bool ok_ = true;
  int several_ = 2;  // not known yet
};

}  // namespace

bool number_kept(Span<const uint8_t> keep, Arena& arena, Renumbering& out) {
  uint32_t left = 0;
  for (uint8_t kept : keep) left += kept != 0;
  out.new_of = arena.array<uint32_t>(keep.count);
  out.old_of = arena.array<uint32_t>(left);
  if (out.new_of.count != keep.count || out.old_of.count != left) return false;
  uint32_t next = 0;
  for (uint32_t i = 0; i < keep.count; ++i) {
    out.new_of[i] = keep[i] ? next : kGone;
    if (keep[i]) out.old_of[next++] = i;
  }
  return true;
}

namespace {

/// Tables that write joints.
void renumber_joint_rows(dna::DnaView& view, Renumberer& r) {
  if (r.copy(view.bhvr.joints.groups)) {
    for (dna::JointGroup& group : view.bhvr.joints.groups) {
      r.rows_of_lods(&group.lods, 9, group.output_indices, group.values);
      r.listed(group.joint_indices);
    }
  }
  dna::MlJoints& ml = view.mlbe.joints;
  if (const uint32_t width = dna::ml_joint_attributes(ml)) {
    r.rows(width, ml.output_indices, ml.input_indices);
  }
  // A set-up that loses all its joints goes. A swing stays where twists have its inputs: they would be others
  // without it (docs/rig-evaluation.md, 7 "Twist and swing").
  const auto of_setups = [&r](auto& setups, const auto& is_needed) {
    if (!r.copy(setups)) return;
    uint32_t kept = 0;
    for (auto& setup : setups) {
      const bool had = setup.output_joint_indices.count != 0;
      r.rows(1, setup.output_joint_indices, setup.blend_weights);
      if (!had || setup.output_joint_indices.count != 0 || is_needed(setup)) setups[kept++] = setup;
    }
    setups.count = kept;
  };
  of_setups(view.twsw.twists, [](const dna::Twist&) { return false; });
  of_setups(view.twsw.swings, [&view](const dna::Swing& swing) {
    const Array<uint16_t>& inputs = swing.input_control_indices;
    for (const dna::Twist& twist : view.twsw.twists) {
      const Array<uint16_t>& others = twist.input_control_indices;
      if (others.count == inputs.count &&
          memcmp(others.data, inputs.data, inputs.byte_count()) == 0)
        return true;
    }
    return false;
  });
}

}  // namespace

bool renumber_joints(dna::DnaView& view, const Renumbering& numbers, Arena& arena) {
  const dna::DnaView before = view;
  Renumberer r(numbers, arena);
  dna::Definition& defn = view.defn;
  r.listed(defn.lod_joints);
  r.owned(defn.joint_names);
  r.renamed(defn.joint_hierarchy);
  r.owned(defn.joint_hierarchy);
  r.owned(defn.neutral_translations);
  r.owned(defn.neutral_rotations);
  renumber_joint_rows(view, r);
  if (view.bhvr.joints.row_count == 9 * numbers.new_of.count) {
    view.bhvr.joints.row_count = static_cast<uint16_t>(9 * numbers.old_of.count);
  }
  if (r.copy(view.geom.meshes)) {
    for (dna::Mesh& mesh : view.geom.meshes) {
      if (!r.copy(mesh.skin_weights)) break;
      for (dna::VertexSkinWeights& vertex : mesh.skin_weights) r.renamed(vertex.joint_indices);
    }
  }
  r.owned(view.jbmd.joints);
  return r.ok() && keep_turn_order(before, view, arena);
}

bool drop_joint_rows(dna::DnaView& view, Span<const uint8_t> keep, Arena& arena) {
  const auto count = static_cast<uint32_t>(keep.count);
  Renumbering numbers{arena.array<uint32_t>(count), {}};
  if (numbers.new_of.count != count) return false;
  for (uint32_t j = 0; j < count; ++j) numbers.new_of[j] = keep[j] ? j : kGone;
  const dna::DnaView before = view;
  Renumberer r(numbers, arena);
  renumber_joint_rows(view, r);
  return r.ok() && keep_turn_order(before, view, arena);
}

bool renumber_meshes(dna::DnaView& view, const Renumbering& numbers, Arena& arena) {
  Renumberer r(numbers, arena);
  dna::Definition& defn = view.defn;
  r.listed(defn.lod_meshes);
  r.owned(defn.mesh_names);
  r.rows(1, defn.mesh_channels.from, defn.mesh_channels.to);
  r.owned(view.geom.meshes);
  r.owned(view.mlbh.mesh_regions.region_names);
  r.owned(view.mlbh.mesh_regions.indices);
  return r.ok();
}

bool renumber_channels(dna::DnaView& view, const Renumbering& numbers, Arena& arena) {
  Renumberer r(numbers, arena);
  dna::Definition& defn = view.defn;
  r.listed(defn.lod_channels);
  r.owned(defn.channel_names);
  r.rows(1, defn.mesh_channels.to, defn.mesh_channels.from);
  dna::BlendShapeChannels& channels = view.bhvr.channels;
  r.rows_of_lods(&channels.lods, 1, channels.output_indices, channels.input_indices);
  if (!r.copy(view.geom.meshes)) return false;
  for (dna::Mesh& mesh : view.geom.meshes) {
    if (!r.copy(mesh.blend_shape_targets)) return false;
    uint32_t kept = 0;
    for (dna::BlendShapeTarget& target : mesh.blend_shape_targets) {
      const uint32_t channel = r.new_of(target.channel_index);
      if (channel == kGone) continue;
      target.channel_index = static_cast<uint16_t>(channel);
      mesh.blend_shape_targets[kept++] = target;
    }
    mesh.blend_shape_targets.count = kept;
  }
  return r.ok();
}

bool renumber_maps(dna::DnaView& view, const Renumbering& numbers, Arena& arena) {
  Renumberer r(numbers, arena);
  r.listed(view.defn.lod_maps);
  r.owned(view.defn.map_names);
  dna::AnimatedMaps& maps = view.bhvr.maps;
  dna::ConditionalTable& table = maps.conditionals;
  r.rows_of_lods(&maps.lods, 1, table.output_indices, table.input_indices, table.from_values,
                 table.to_values, table.slope_values, table.cut_values);
  return r.ok();
}

bool renumber_gui_controls(dna::DnaView& view, const Renumbering& numbers, Arena& arena) {
  Renumberer r(numbers, arena);
  r.owned(view.defn.gui_control_names);
  dna::ConditionalTable& table = view.bhvr.controls.conditionals;
  r.rows(1, table.input_indices, table.output_indices, table.from_values, table.to_values,
         table.slope_values, table.cut_values);
  return r.ok();
}

namespace {

/// Columns of controls that are gone become 0, so that the others go on rotating joints in their order.
bool clear_columns(dna::DnaView& view, const Renumberer& r, Arena& arena) {
  const dna::DnaView before = view;
  if (!copy_list(arena, view.bhvr.joints.groups)) return false;
  for (dna::JointGroup& group : view.bhvr.joints.groups) {
    if (!r.any_gone(group.input_indices)) continue;
    NewArray<float> values;
    if (!copy_array(arena, group.values, values)) return false;
    const uint32_t columns = group.input_indices.count;
    for (uint32_t k = 0; k < values.count; ++k) {
      if (r.new_of(group.input_indices[k % columns]) == kGone) values.set(k, 0);
    }
    group.values = values;
  }
  return keep_turn_order(before, view, arena);
}

void renumber_controls_of_behavior(dna::Behavior& bhvr, Renumberer& r) {
  dna::ConditionalTable& sliders = bhvr.controls.conditionals;
  r.rows(1, sliders.output_indices, sliders.input_indices, sliders.from_values, sliders.to_values,
         sliders.slope_values, sliders.cut_values);
  dna::PsdTable& psds = bhvr.controls.psds;
  r.rows(1, psds.rows, psds.columns, psds.values);
  r.renamed(psds.columns);
  if (r.copy(bhvr.joints.groups)) {
    for (dna::JointGroup& group : bhvr.joints.groups)
      r.columns(group.input_indices, group.values, group.output_indices.count);
  }
  r.rows_of_lods(&bhvr.channels.lods, 1, bhvr.channels.input_indices, bhvr.channels.output_indices);
  dna::ConditionalTable& maps = bhvr.maps.conditionals;
  r.rows_of_lods(&bhvr.maps.lods, 1, maps.input_indices, maps.output_indices, maps.from_values,
                 maps.to_values, maps.slope_values, maps.cut_values);
}

void renumber_controls_of_networks(dna::DnaView& view, Renumberer& r) {
  if (!r.copy(view.mlbh.networks)) return;
  for (dna::NeuralNetwork& network : view.mlbh.networks) {
    if (network.layers.count == 0) {
      r.renamed(network.output_indices);
      r.listed(network.input_indices);
      continue;
    }
    if (!r.copy(network.layers)) return;
    r.columns(network.input_indices, network.layers[0].weights, network.layers[0].biases.count);
    if (!r.any_gone(network.output_indices)) {
      r.renamed(network.output_indices);
      continue;
    }
    // Values of the last layer that no control gets are not needed.
    dna::NetworkLayer& last = network.layers[network.layers.count - 1];
    const size_t inputs = last.biases.count ? last.weights.count / last.biases.count : 0;
    last.weights = last.weights.first(inputs * network.output_indices.count);
    last.biases = last.biases.first(network.output_indices.count);
    r.rows(1, network.output_indices, last.weights, last.biases);
  }
  r.rows(1, view.mlbe.joints.input_indices, view.mlbe.joints.output_indices);
}

/// Lists of ML operations are copied.
bool renumber_controls_of_operations(dna::MachineLearnedBehaviorExtension& mlbe,
                                     const Renumberer& r, Arena& arena) {
  if (!copy_list(arena, mlbe.types)) return false;
  for (dna::MlType& type : mlbe.types) {
    if (!copy_list(arena, type.operations)) return false;
    for (List<dna::MlOperation>& set : type.operations) {
      if (!copy_list(arena, set)) return false;
      for (dna::MlOperation& operation : set) {
        if (!lists_controls(operation)) continue;
        NewArray<uint32_t> numbers;
        if (!copy_array(arena, operation.parameters, numbers)) return false;
        for (uint32_t i = 0; i < numbers.count; ++i)
          numbers.set(i, r.new_of(operation.parameters[i]));
        operation.parameters = numbers;
      }
    }
  }
  return true;
}

void renumber_controls_of_rbf(dna::DnaView& view, Renumberer& r, Arena& arena) {
  if (!r.copy(view.rbfb.solvers) || !r.copy(view.rbfe.poses)) return;
  const Span<uint8_t> keep = arena.array<uint8_t>(view.rbfb.solvers.count);
  Renumbering solvers;
  for (size_t i = 0; i < keep.count; ++i)
    keep[i] = !r.any_gone(view.rbfb.solvers[i].raw_control_indices);
  if (keep.count != view.rbfb.solvers.count || !number_kept(keep, arena, solvers)) return r.fail();
  Renumberer of_solvers(solvers, arena);
  of_solvers.listed(view.rbfb.lod_solvers);
  of_solvers.owned(view.rbfb.solvers);
  if (!of_solvers.ok()) return r.fail();
  for (dna::RbfSolver& solver : view.rbfb.solvers) r.renamed(solver.raw_control_indices);
  for (dna::RbfPoseControls& pose : view.rbfe.poses) {
    if (r.any_gone(pose.input_control_indices)) pose = {};  // a product with 0
    r.renamed(pose.input_control_indices);
    r.rows(1, pose.output_control_indices, pose.output_control_weights);
  }
}

}  // namespace

bool renumber_controls(dna::DnaView& view, Span<const uint8_t> gone, Arena& arena) {
  // Also of numbers past the last control, which those of layers that are not here may be.
  constexpr uint32_t kNumbers = 65536;
  const uint32_t raw_count = view.first_psd();
  const Renumbering numbers{arena.array<uint32_t>(kNumbers), {}};
  const uint32_t first_ml = view.first_ml(), first_rbf = view.first_rbf(),
                 end = view.control_count();
  const Span<uint8_t> keep = arena.array<uint8_t>(end);
  Renumbering raw, ml, rbf;
  if (numbers.new_of.count != kNumbers || keep.count != end) return false;
  uint32_t next = 0, kept_columns = 0, kept_psds = 0;
  for (uint32_t c = 0; c < kNumbers; ++c) {
    const bool kept = c >= gone.count || !gone[c];
    if (c < end) keep[c] = kept;
    if (c >= raw_count && c < first_ml) kept_psds += kept;
    if (c < view.bhvr.joints.col_count) kept_columns += kept;
    numbers.new_of[c] = kept ? next++ : kGone;
  }
  if (!number_kept(keep.first(raw_count), arena, raw) ||
      !number_kept(keep.slice(first_ml, first_rbf - first_ml), arena, ml) ||
      !number_kept(keep.slice(first_rbf, end - first_rbf), arena, rbf)) {
    return false;
  }
  Renumberer of_raw(raw, arena), of_ml(ml, arena), of_rbf(rbf, arena), r(numbers, arena);
  if (!clear_columns(view, r, arena)) return false;
  of_raw.owned(view.defn.raw_control_names);
  of_ml.owned(view.mlbh.control_names);
  of_rbf.owned(view.rbfe.pose_control_names);
  view.ml_control_count = view.mlbh.control_names.count;
  renumber_controls_of_behavior(view.bhvr, r);
  view.bhvr.controls.psd_count = static_cast<uint16_t>(kept_psds);
  view.bhvr.joints.col_count = static_cast<uint16_t>(kept_columns);
  renumber_controls_of_networks(view, r);
  renumber_controls_of_rbf(view, r, arena);
  const auto of_setups = [&r](auto& setups) {
    if (!r.copy(setups)) return;
    uint32_t kept = 0;
    for (auto& setup : setups) {
      if (r.any_gone(setup.input_control_indices)) continue;
      r.renamed(setup.input_control_indices);
      setups[kept++] = setup;
    }
    setups.count = kept;
  };
  of_setups(view.twsw.twists);
  of_setups(view.twsw.swings);
  return of_raw.ok() && of_ml.ok() && of_rbf.ok() && r.ok() &&
         renumber_controls_of_operations(view.mlbe, r, arena);
}

bool pair_channels(dna::DnaView& view, uint32_t mesh, Arena& arena) {
  dna::MeshChannelMapping& pairs = view.defn.mesh_channels;
  const List<dna::BlendShapeTarget>& targets = view.geom.meshes[mesh].blend_shape_targets;
  const Span<uint8_t> has = arena.array<uint8_t>(view.defn.channel_names.count);
  const NewArray<uint16_t> from = dna::new_array<uint16_t>(arena, pairs.from.count + targets.count);
  const NewArray<uint16_t> to = dna::new_array<uint16_t>(arena, pairs.from.count + targets.count);
  if (has.count != view.defn.channel_names.count || (from.count != 0 && (!from.data || !to.data)))
    return false;
  for (const dna::BlendShapeTarget& target : targets) has[target.channel_index] = 1;
  uint32_t count = 0;
  for (uint32_t i = 0; i < pairs.from.count; ++i) {
    if (pairs.from[i] == mesh && has[pairs.to[i]] == 0) continue;
    if (pairs.from[i] == mesh) has[pairs.to[i]] = 2;
    from.set(count, pairs.from[i]);
    to.set(count++, pairs.to[i]);
  }
  for (const dna::BlendShapeTarget& target : targets) {
    if (has[target.channel_index] != 1) continue;
    has[target.channel_index] = 2;
    from.set(count, static_cast<uint16_t>(mesh));
    to.set(count++, target.channel_index);
  }
  pairs = {Array<uint16_t>(from).first(count), Array<uint16_t>(to).first(count)};
  return true;
}

bool list_at_lods(dna::LodMap& map, uint32_t element, uint64_t lods, Arena& arena) {
  const uint32_t count = map.lods.count;
  const NewArray<uint16_t> rows = dna::new_array<uint16_t>(arena, count);
  const Span<Array<uint16_t>> lists = arena.array<Array<uint16_t>>(count);
  if (count != 0 && (!rows.data || !lists.data)) return false;
  uint32_t used = 0;
  for (uint32_t lod = 0; lod < count; ++lod) {
    const Array<uint16_t> old = map.at(lod);
    const bool listed = lod < 64 && (lods >> lod & 1) != 0;
    // Like an earlier LOD?
    uint32_t row = used;
    for (uint32_t l = 0; l < lod && row == used; ++l) {
      if (map.lods[l] == map.lods[lod] && (l < 64 && (lods >> l & 1) != 0) == listed)
        row = Array<uint16_t>(rows)[l];
    }
    rows.set(lod, static_cast<uint16_t>(row));
    if (row != used) continue;
    const NewArray<uint16_t> list = dna::new_array<uint16_t>(arena, size_t{old.count} + 1);
    if (!list.data) return false;
    uint32_t n = 0;
    bool there = false;
    for (uint32_t i = 0; i < old.count; ++i) {
      if (old[i] == element && (!listed || there)) continue;
      there |= old[i] == element;
      list.set(n++, old[i]);
    }
    if (listed && !there) list.set(n++, static_cast<uint16_t>(element));
    lists[used++] = Array<uint16_t>(list).first(n);
  }
  map.lods = rows;
  map.indices = {lists.data, used};
  return true;
}

bool copy_all_lists(Arena& arena, dna::DnaView& view) {
  FieldCopier<false> copier(arena);
  for (const dna::LayerKind& kind : dna::kLayerKinds) {
    dna::with_layer(view, kind.id, [&](auto& record) { copier.copy(record); });
  }
  return copier.ok;
}

}  // namespace mien::author
