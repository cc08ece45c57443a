// SPDX-License-Identifier: MIT
#include "runtime/dna/lod_selection.h"

#include "runtime/dna/turn_columns.h"

namespace mien::dna {
namespace {

/// Old number -> new number, or kGone.
using Numbers = Span<uint32_t>;
constexpr uint32_t kGone = ~uint32_t{0};

uint32_t new_number(const Numbers& numbers, uint32_t old) {
  return old < numbers.count ? numbers[old] : kGone;
}

class LodSelector {
 public:
  LodSelector(DnaView& view, uint64_t lods, Arena& arena)
      : view_(view), lods_(lods), arena_(arena) {
    while (!(lods >> first_ & 1)) ++first_;
    for (uint64_t rest = lods; rest; rest &= rest - 1) ++count_;
  }

  bool run() {
    keep_turn_order();
    if (out_of_memory_) return false;
    number_survivors();
    if (out_of_memory_) return false;
    select_definition();
    select_behavior();
    select_geometry();
    select_networks();
    select_operations();
    select_ml_joints();
    select_solvers();
    select_joint_metadata();
    select_twists_and_swings();
    view_.desc.max_lod = static_cast<uint16_t>(view_.desc.max_lod + first_);
    view_.desc.lod_count = static_cast<uint16_t>(count_);
    return !out_of_memory_;
  }

 private:
  // Memory ------------------------------------------------------------------------------------

  template <class T>
  Span<T> make(size_t count) {
    Span<T> span = arena_.array<T>(count);
    if (count && !span.data) out_of_memory_ = true;
    return span;
  }

  template <class T>
  NewArray<T> make_array(size_t count) {
    NewArray<T> array = new_array<T>(arena_, count);
    if (count && !array.data) {
      out_of_memory_ = true;
      return {};
    }
    return array;
  }

  // Survivors ---------------------------------------------------------------------------------

  Numbers number(Span<uint8_t> kept) {
    Numbers numbers = make<uint32_t>(kept.count);
    uint32_t next = 0;
    for (size_t i = 0; i < numbers.count; ++i) numbers[i] = kept[i] ? next++ : kGone;
    return numbers;
  }

  Span<uint8_t> marked(const LodMap& map, size_t count) {
    Span<uint8_t> marks = make<uint8_t>(count);
    if (marks.count == count) mark_lod_elements(map, lods_, marks);
    return marks;
  }

  uint32_t rows_left(Array<uint16_t> lods) const { return first_ < lods.count ? lods[first_] : 0; }

  void number_survivors() {
    const Definition& defn = view_.defn;
    const Behavior& bhvr = view_.bhvr;

    Span<uint8_t> joints = marked(defn.lod_joints, defn.joint_names.count);
    Span<uint8_t> channels = marked(defn.lod_channels, defn.channel_names.count);
    Span<uint8_t> maps = marked(defn.lod_maps, defn.map_names.count);
    Span<uint8_t> meshes = marked(defn.lod_meshes, defn.mesh_names.count);
    Span<uint8_t> fine = make<uint8_t>(defn.joint_names.count);
    if (out_of_memory_) return;

    // Joints in no list of LOD 0 belong to no LOD in particular: they stay.
    mark_lod_elements(defn.lod_joints, 1, fine);
    for (size_t j = 0; j < joints.count; ++j) joints[j] |= !fine[j];

    // What the remaining rows write.
    for (const JointGroup& group : bhvr.joints.groups) {
      const uint32_t rows = rows_left(group.lods);
      for (uint32_t r = 0; r < rows; ++r) joints[group.output_indices[r] / 9] = 1;
    }
    const uint32_t channel_rows = rows_left(bhvr.channels.lods);
    for (uint32_t r = 0; r < channel_rows; ++r) channels[bhvr.channels.output_indices[r]] = 1;
    const uint32_t map_rows = rows_left(bhvr.maps.lods);
    for (uint32_t r = 0; r < map_rows; ++r) maps[bhvr.maps.conditionals.output_indices[r]] = 1;

    joints_ = number(joints);
    channels_ = number(channels);
    maps_ = number(maps);
    meshes_ = number(meshes);
    for (uint32_t j = 0; j < defn.joint_hierarchy.count; ++j) {
      if (defn.joint_hierarchy[j] == j) {
        root_ = new_number(joints_, j);
        break;
      }
    }
    if (root_ == kGone) root_ = 0;
  }

  // Pieces ------------------------------------------------------------------------------------

  /// Numbers of survivors only, renewed.
  Array<uint16_t> renumbered(Array<uint16_t> old, const Numbers& numbers) {
    NewArray<uint16_t> array = make_array<uint16_t>(old.count);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < array.count; ++i) {
      const uint32_t n = new_number(numbers, old[i]);
      if (n != kGone) array.set(kept++, static_cast<uint16_t>(n));
    }
    return Array<uint16_t>(array).first(kept);
  }

  /// Elements whose own number survives.
  template <class T>
  Array<T> survivors(Array<T> old, const Numbers& numbers) {
    NewArray<T> array = make_array<T>(old.count);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < array.count; ++i) {
      if (new_number(numbers, i) != kGone) array.set(kept++, old[i]);
    }
    return Array<T>(array).first(kept);
  }

  /// The same for lists, in place: the list lies in our arena.
  template <class T>
  void keep_survivors(List<T>& list, const Numbers& numbers) {
    uint32_t kept = 0;
    for (uint32_t i = 0; i < list.count; ++i) {
      if (new_number(numbers, i) != kGone) list[kept++] = list[i];
    }
    list.count = kept;
  }

  Vec3Array survivors(const Vec3Array& old, const Numbers& numbers) {
    return {survivors(old.xs, numbers), survivors(old.ys, numbers), survivors(old.zs, numbers)};
  }

  Array<uint16_t> kept_lods(Array<uint16_t> lods) {
    NewArray<uint16_t> array = make_array<uint16_t>(lods.count);
    uint32_t kept = 0;
    for (uint32_t l = 0; l < array.count && l < 64; ++l) {
      if (lods_ >> l & 1) array.set(kept++, lods[l]);
    }
    return Array<uint16_t>(array).first(kept);
  }

  /// Entries of kept LODs, the rows that they name, and the new numbers in them.
  void select_map(LodMap& map, const Numbers& numbers) {
    map.lods = kept_lods(map.lods);
    Span<uint8_t> named = make<uint8_t>(map.indices.count);
    if (out_of_memory_) return;
    for (uint32_t l = 0; l < map.lods.count; ++l) named[map.lods[l]] = 1;
    Numbers rows = number(named);
    map.lods = renumbered(map.lods, rows);
    keep_survivors(map.indices, rows);
    for (Array<uint16_t>& row : map.indices) row = renumbered(row, numbers);
  }

  // Layers ------------------------------------------------------------------------------------

  void select_definition() {
    Definition& defn = view_.defn;
    select_map(defn.lod_joints, joints_);
    select_map(defn.lod_channels, channels_);
    select_map(defn.lod_maps, maps_);
    select_map(defn.lod_meshes, meshes_);
    keep_survivors(defn.joint_names, joints_);
    keep_survivors(defn.channel_names, channels_);
    keep_survivors(defn.map_names, maps_);
    keep_survivors(defn.mesh_names, meshes_);

    const Array<uint16_t> from = defn.mesh_channels.from, to = defn.mesh_channels.to;
    NewArray<uint16_t> new_from = make_array<uint16_t>(from.count);
    NewArray<uint16_t> new_to = make_array<uint16_t>(to.count);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < new_from.count && i < new_to.count; ++i) {
      const uint32_t mesh = new_number(meshes_, from[i]), channel = new_number(channels_, to[i]);
      if (mesh == kGone || channel == kGone) continue;
      new_from.set(kept, static_cast<uint16_t>(mesh));
      new_to.set(kept++, static_cast<uint16_t>(channel));
    }
    defn.mesh_channels = {Array<uint16_t>(new_from).first(kept),
                          Array<uint16_t>(new_to).first(kept)};

    Array<uint16_t> parents = survivors(defn.joint_hierarchy, joints_);
    NewArray<uint16_t> hierarchy = make_array<uint16_t>(parents.count);
    for (uint32_t j = 0; j < hierarchy.count; ++j) {
      const uint32_t parent = new_number(joints_, parents[j]);
      hierarchy.set(j, static_cast<uint16_t>(parent == kGone ? 0 : parent));
    }
    defn.joint_hierarchy = hierarchy;
    defn.neutral_translations = survivors(defn.neutral_translations, joints_);
    defn.neutral_rotations = survivors(defn.neutral_rotations, joints_);
  }

  // Which columns a LOD needs decides the order in which they turn joints represented by
  // quaternions, so a file without some LODs would turn them in another order. Rows that turn get a
  // group of their own then, behind the others, with the columns in the order of the whole file: it
  // stays.
  void keep_turn_order() {
    List<JointGroup>& groups = view_.bhvr.joints.groups;
    uint32_t widest = 0;
    for (const JointGroup& group : groups) {
      if (group.input_indices.count > widest) widest = group.input_indices.count;
    }
    if (view_.jbmd.joints.count == 0 || widest == 0) return;
    Span<uint32_t> first_rows = make<uint32_t>(widest), order = make<uint32_t>(widest);
    Span<JointGroup> all = make<JointGroup>(size_t{groups.count} * 2);
    if (out_of_memory_) return;
    uint32_t count = groups.count;
    for (uint32_t g = 0; g < groups.count; ++g) {
      all[g] = groups[g];
      const uint32_t columns = order_turn_columns(view_, groups[g], first_rows, order, nullptr);
      bool in_file_order = true;
      for (uint32_t k = 1; k < columns; ++k) in_file_order &= order[k - 1] < order[k];
      if (in_file_order) continue;
      JointGroup& turning = all[count++];
      turning = rows_of(groups[g], true, order.first(columns));
      for (uint32_t c = 0; c < groups[g].input_indices.count; ++c) order[c] = c;
      all[g] = rows_of(groups[g], false, order.first(groups[g].input_indices.count));
      if (out_of_memory_) return;
    }
    groups = {all.data, count};
  }

  /// The rows of a group that turn, or the others, with these columns.
  JointGroup rows_of(const JointGroup& group, bool turning, const Span<uint32_t>& columns) {
    JointGroup part = group;
    uint32_t rows = 0;
    for (uint32_t r = 0; r < group.output_indices.count; ++r) {
      rows += is_turning_row(view_, group.output_indices[r]) == turning;
    }
    NewArray<uint16_t> inputs = make_array<uint16_t>(columns.count);
    NewArray<uint16_t> outputs = make_array<uint16_t>(rows);
    NewArray<float> values = make_array<float>(columns.count * rows);
    NewArray<uint16_t> lods = make_array<uint16_t>(group.lods.count);
    if (out_of_memory_) return part;
    for (uint32_t c = 0; c < columns.count; ++c) inputs.set(c, group.input_indices[columns[c]]);
    uint32_t kept = 0;
    for (uint32_t l = 0; l < lods.count; ++l) lods.set(l, 0);
    for (uint32_t r = 0; r < group.output_indices.count; ++r) {
      if (is_turning_row(view_, group.output_indices[r]) != turning) continue;
      outputs.set(kept, group.output_indices[r]);
      for (uint32_t c = 0; c < columns.count; ++c) {
        values.set(kept * columns.count + c,
                   group.values[size_t{r} * group.input_indices.count + columns[c]]);
      }
      ++kept;
      for (uint32_t l = 0; l < lods.count; ++l) {
        if (group.lods[l] > r) lods.set(l, static_cast<uint16_t>(kept));
      }
    }
    part.input_indices = inputs;
    part.output_indices = outputs;
    part.values = values;
    part.lods = lods;
    return part;
  }

  void select_behavior() {
    Behavior& bhvr = view_.bhvr;
    for (JointGroup& group : bhvr.joints.groups) {
      const uint32_t rows = rows_left(group.lods), columns = group.input_indices.count;
      NewArray<uint16_t> outputs = make_array<uint16_t>(rows);
      for (uint32_t r = 0; r < outputs.count; ++r) {
        const uint32_t old = group.output_indices[r];
        outputs.set(r, static_cast<uint16_t>(joints_[old / 9] * 9 + old % 9));
      }
      group.output_indices = outputs;
      group.values = group.values.first(size_t{rows} * columns);
      if (rows == 0) group.input_indices = {};
      group.joint_indices = renumbered(group.joint_indices, joints_);
      group.lods = kept_lods(group.lods);
    }
    if (view_.has(kLayerBehavior)) {
      bhvr.joints.row_count = static_cast<uint16_t>(9 * view_.defn.joint_names.count);
    }

    BlendShapeChannels& channels = bhvr.channels;
    const uint32_t channel_rows = rows_left(channels.lods);
    channels.input_indices = channels.input_indices.first(channel_rows);
    channels.output_indices = renumbered(channels.output_indices.first(channel_rows), channels_);
    channels.lods = kept_lods(channels.lods);

    ConditionalTable& table = bhvr.maps.conditionals;
    const uint32_t map_rows = rows_left(bhvr.maps.lods);
    table.input_indices = table.input_indices.first(map_rows);
    table.output_indices = renumbered(table.output_indices.first(map_rows), maps_);
    table.from_values = table.from_values.first(map_rows);
    table.to_values = table.to_values.first(map_rows);
    table.slope_values = table.slope_values.first(map_rows);
    table.cut_values = table.cut_values.first(map_rows);
    bhvr.maps.lods = kept_lods(bhvr.maps.lods);
  }

  void select_geometry() {
    keep_survivors(view_.geom.meshes, meshes_);
    for (Mesh& mesh : view_.geom.meshes) {
      uint32_t kept = 0;
      for (BlendShapeTarget& target : mesh.blend_shape_targets) {
        const uint32_t channel = new_number(channels_, target.channel_index);
        if (channel == kGone) continue;
        target.channel_index = static_cast<uint16_t>(channel);
        mesh.blend_shape_targets[kept++] = target;
      }
      mesh.blend_shape_targets.count = kept;
      for (VertexSkinWeights& vertex : mesh.skin_weights) select_influences(vertex);
    }
  }

  // The weights that remain are scaled to make up for those of joints that are gone.
  void select_influences(VertexSkinWeights& vertex) {
    if (view_.defn.joint_names.count == 0) return void(vertex = {});  // no joint, so no root either
    const uint32_t count = vertex.weights.count;
    float dropped = 0, left = 0;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; ++i) {
      const bool gone = new_number(joints_, vertex.joint_indices[i]) == kGone;
      (gone ? dropped : left) += vertex.weights[i];
      kept += !gone;
    }
    if (kept == count && count != 0) {
      vertex.joint_indices = renumbered(vertex.joint_indices, joints_);
      return;
    }
    const bool to_root = !(left > 0);
    NewArray<float> weights = make_array<float>(to_root ? 1 : kept);
    NewArray<uint16_t> joints = make_array<uint16_t>(to_root ? 1 : kept);
    if (out_of_memory_) return;
    if (to_root) {
      weights.set(0, 1.0f);
      joints.set(0, static_cast<uint16_t>(root_));
    } else {
      const float scale = 1.0f / (dropped < 1.0f ? 1.0f - dropped : left);
      uint32_t k = 0;
      for (uint32_t i = 0; i < count; ++i) {
        const uint32_t joint = new_number(joints_, vertex.joint_indices[i]);
        if (joint == kGone) continue;
        weights.set(k, vertex.weights[i] * scale);
        joints.set(k++, static_cast<uint16_t>(joint));
      }
    }
    vertex.weights = weights;
    vertex.joint_indices = joints;
  }

  // Which operations stay decides which networks do, so operations are marked first.
  void select_networks() {
    MachineLearnedBehavior& mlbh = view_.mlbh;
    Span<uint8_t> kept = marked(mlbh.lod_networks, mlbh.networks.count);
    mark_operations();
    if (out_of_memory_) return;
    for (uint32_t t = 0; t < view_.mlbe.types.count; ++t) {
      const MlType& type = view_.mlbe.types[t];
      for (uint32_t s = 0; s < type.operations.count; ++s) {
        for (uint32_t o = 0; o < type.operations[s].count; ++o) {
          const MlOperation& operation = type.operations[s][o];
          if (operations_[t][s][o] && operation.type == uint16_t(MlOperationType::kMlp)) {
            kept[operation.parameters[0]] = 1;
          }
        }
      }
    }
    networks_ = number(kept);
    if (out_of_memory_) return;
    select_map(mlbh.lod_networks, networks_);
    keep_survivors(mlbh.networks, networks_);
    keep_survivors(mlbh.mesh_regions.region_names, meshes_);
    keep_survivors(mlbh.mesh_regions.indices, meshes_);
    for (List<Array<uint16_t>>& regions : mlbh.mesh_regions.indices) {
      for (Array<uint16_t>& networks : regions) networks = renumbered(networks, networks_);
    }
  }

  // Listed at a kept LOD, or needed by one that stays. Dependencies lie in earlier sets, so one
  // pass from the last set to the first finds them all.
  void mark_operations() {
    const List<MlType>& types = view_.mlbe.types;
    operations_ = make<Span<Span<uint8_t>>>(types.count);
    if (out_of_memory_) return;
    for (uint32_t t = 0; t < types.count; ++t) {
      const MlType& type = types[t];
      Span<Span<uint8_t>> sets = operations_[t] = make<Span<uint8_t>>(type.operations.count);
      for (uint32_t s = 0; s < sets.count && !out_of_memory_; ++s) {
        const size_t count = type.operations[s].count;
        sets[s] = s < type.lod_operations.count ? marked(type.lod_operations[s], count)
                                                : make<uint8_t>(count);
      }
      if (out_of_memory_) return;
      for (uint32_t s = static_cast<uint32_t>(sets.count); s-- > 0;) {
        for (uint32_t o = 0; o < sets[s].count; ++o) {
          if (!sets[s][o]) continue;
          const MlOperation& operation = type.operations[s][o];
          for (uint32_t d = 0; d < operation.set_dependencies.count; ++d) {
            sets[operation.set_dependencies[d]][operation.operation_dependencies[d]] = 1;
          }
        }
      }
    }
  }

  void select_operations() {
    if (out_of_memory_) return;
    const uint32_t old_lod_count = view_.desc.lod_count;
    for (uint32_t t = 0; t < view_.mlbe.types.count; ++t) {
      MlType& type = view_.mlbe.types[t];
      Span<Numbers> numbers = make<Numbers>(type.operations.count);
      for (uint32_t s = 0; s < numbers.count; ++s) {
        numbers[s] = number(operations_[t][s]);
        if (out_of_memory_) return;
        if (s < type.lod_operations.count) select_map(type.lod_operations[s], numbers[s]);
        keep_survivors(type.operations[s], numbers[s]);
        for (MlOperation& operation : type.operations[s]) {
          NewArray<uint16_t> dependencies =
              make_array<uint16_t>(operation.operation_dependencies.count);
          for (uint32_t d = 0; d < dependencies.count; ++d) {
            const uint32_t set = operation.set_dependencies[d];
            dependencies.set(
                d, static_cast<uint16_t>(numbers[set][operation.operation_dependencies[d]]));
          }
          operation.operation_dependencies = dependencies;
          if (operation.type == uint16_t(MlOperationType::kMlp)) {
            operation.parameters = mlp_parameters(operation.parameters, old_lod_count);
          }
        }
      }
    }
  }

  // Network number, then for each of its layers one row limit per LOD.
  Array<uint32_t> mlp_parameters(Array<uint32_t> old, uint32_t old_lod_count) {
    const uint32_t layers = old_lod_count ? (old.count - 1) / old_lod_count : 0;
    NewArray<uint32_t> parameters = make_array<uint32_t>(1 + size_t{layers} * count_);
    if (out_of_memory_) return {};
    parameters.set(0, networks_[old[0]]);
    uint32_t next = 1;
    for (uint32_t layer = 0; layer < layers; ++layer) {
      for (uint32_t l = 0; l < old_lod_count; ++l) {
        if (lods_ >> l & 1) parameters.set(next++, old[1 + layer * old_lod_count + l]);
      }
    }
    return parameters;
  }

  void select_ml_joints() {
    MlJoints& joints = view_.mlbe.joints;
    const uint32_t attributes = ml_joint_attributes(joints);
    if (attributes == 0) return;
    NewArray<uint16_t> inputs = make_array<uint16_t>(joints.input_indices.count);
    NewArray<uint16_t> outputs = make_array<uint16_t>(joints.output_indices.count);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < outputs.count && i < inputs.count; ++i) {
      const uint32_t old = joints.output_indices[i];
      const uint32_t joint = new_number(joints_, old / attributes);
      if (joint == kGone) continue;
      inputs.set(kept, joints.input_indices[i]);
      outputs.set(kept++, static_cast<uint16_t>(joint * attributes + old % attributes));
    }
    joints.input_indices = Array<uint16_t>(inputs).first(kept);
    joints.output_indices = Array<uint16_t>(outputs).first(kept);
  }

  void select_solvers() {
    RbfBehavior& rbfb = view_.rbfb;
    Numbers numbers = number(marked(rbfb.lod_solvers, rbfb.solvers.count));
    if (out_of_memory_) return;
    select_map(rbfb.lod_solvers, numbers);
    keep_survivors(rbfb.solvers, numbers);
  }

  void select_joint_metadata() { keep_survivors(view_.jbmd.joints, joints_); }

  template <class Setup>
  void select_outputs(List<Setup>& setups) {
    uint32_t kept = 0;
    for (Setup& setup : setups) {
      const Array<uint16_t> joints = setup.output_joint_indices;
      NewArray<float> weights = make_array<float>(joints.count);
      uint32_t k = 0;
      for (uint32_t i = 0; i < weights.count; ++i) {
        if (new_number(joints_, joints[i]) != kGone) weights.set(k++, setup.blend_weights[i]);
      }
      if (k == 0) continue;
      setup.blend_weights = Array<float>(weights).first(k);
      setup.output_joint_indices = renumbered(joints, joints_);
      setups[kept++] = setup;
    }
    setups.count = kept;
  }

  void select_twists_and_swings() {
    select_outputs(view_.twsw.twists);
    select_outputs(view_.twsw.swings);
  }

  DnaView& view_;
  uint64_t lods_;
  Arena& arena_;
  uint32_t first_ = 0, count_ = 0;  // finest kept LOD, number of kept LODs
  Numbers joints_, channels_, maps_, meshes_, networks_;
  Span<Span<Span<uint8_t>>> operations_;  // [type][set][operation]: stays
  uint32_t root_ = kGone;
  bool out_of_memory_ = false;
};

}  // namespace

void mark_lod_elements(const LodMap& map, uint64_t lods, Span<uint8_t> marks) {
  for (uint32_t l = 0; l < map.lods.count && l < 64; ++l) {
    if (!(lods >> l & 1)) continue;
    const Array<uint16_t>& row = map.indices[map.lods[l]];
    for (uint32_t i = 0; i < row.count; ++i) marks[row[i]] = 1;
  }
}

bool select_lods(DnaView& view, uint64_t lods, Arena& arena) {
  return LodSelector(view, lods, arena).run();
}

}  // namespace mien::dna
