// SPDX-License-Identifier: MIT
#include "runtime/load/dna/convert/lod_selection.h"

#include <algorithm>
#include <cstring>

#include "runtime/load/dna/format/quaternion_columns.h"

namespace mien::dna {
namespace {

constexpr uint32_t kGone = ~uint32_t{0};

/// Old number -> new number, or kGone. Has no lists if all elements stay, as they mostly do where
/// LOD 0 is kept.
struct Numbers {
  uint32_t count = 0;  // of old numbers
  bool all_stay = true;
  Span<uint32_t> new_of;     // [old], if any survive
  Span<uint32_t> survivors;  // [new] its old number

  bool none_stays() const { return !all_stay && survivors.empty(); }
  uint32_t operator[](uint32_t old) const {
    if (old >= count || none_stays()) return kGone;
    return all_stay ? old : new_of[old];
  }
};

void mark(const Array<uint16_t>& elements, const Span<uint8_t>& marks) {
  const Array<uint16_t> from = elements;  // local copies: bytes may alias anything
  uint8_t* const to = marks.data;
  for (uint32_t i = 0; i < from.count; ++i) to[from[i]] = 1;
}

class LodSelector {
 public:
  LodSelector(DnaView& view, uint64_t lods, Arena& arena)
      : view_(view), lods_(lods), arena_(arena) {
    while (!(lods >> first_ & 1)) ++first_;
    for (uint64_t rest = lods; rest; rest &= rest - 1) ++count_;
    neighbors_ = lods >> first_ == (uint64_t{1} << count_) - 1;
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

  static Numbers all_stay(uint32_t count) { return {count, true, {}, {}}; }

  Numbers number(const Span<uint8_t>& kept) {
    const auto count = static_cast<uint32_t>(kept.count);
    uint32_t left = 0;
    for (uint32_t i = 0; i < count; ++i) left += kept.data[i];
    if (left == count) return all_stay(count);
    if (left == 0) return {count, false, {}, {}};
    const Span<uint32_t> new_of = make<uint32_t>(count), survivors = make<uint32_t>(count);
    if (out_of_memory_) return {};
    uint32_t next = 0;
    for (uint32_t i = 0; i < count; ++i) {
      survivors[next] = i;
      new_of[i] = kept[i] ? next : kGone;
      next += kept[i];
    }
    return {count, false, new_of, survivors.first(left)};
  }

  Span<uint8_t> marked(const LodMap& map, size_t count) {
    Span<uint8_t> marks = make<uint8_t>(count);
    if (marks.count == count) mark_lod_elements(map, lods_, marks);
    return marks;
  }

  uint32_t rows_left(const Array<uint16_t>& lods) const {
    return first_ < lods.count ? lods[first_] : 0;
  }
  /// The elements that the remaining rows write.
  Array<uint16_t> kept_rows(const Array<uint16_t>& outputs, const Array<uint16_t>& lods) const {
    return outputs.first(rows_left(lods));
  }

  void number_survivors() {
    const Definition& defn = view_.defn;
    const BlendShapeChannels& channels = view_.bhvr.channels;
    const AnimatedMaps& maps = view_.bhvr.maps;
    // Rows rarely write elements that no list has; these are kept, too.
    joints_ = number_joints(false);
    if (!renumber_outputs()) {
      joints_ = number_joints(true);
      renumber_outputs();
    }
    channels_ = number_listed(defn.lod_channels, defn.channel_names.count,
                              kept_rows(channels.output_indices, channels.lods));
    maps_ = number_listed(defn.lod_maps, defn.map_names.count,
                          kept_rows(maps.conditionals.output_indices, maps.lods));
    meshes_ = number_listed(defn.lod_meshes, defn.mesh_names.count, {});
    if (out_of_memory_) return;
    for (uint32_t j = 0; j < defn.joint_hierarchy.count; ++j) {
      if (defn.joint_hierarchy[j] == j) {
        root_ = joints_[j];
        break;
      }
    }
    if (root_ == kGone) root_ = 0;
  }

  /// Elements that kept LODs list, or that kept rows write.
  Numbers number_listed(const LodMap& map, uint32_t count, const Array<uint16_t>& written) {
    if (is_every(map.at(first_), count)) return all_stay(count);
    Span<uint8_t> marks = marked(map, count);
    if (out_of_memory_) return {};
    mark(written, marks);
    return number(marks);
  }

  /// 0, 1, 2 ...: a list of everything.
  static bool is_every(const Array<uint16_t>& list, uint32_t count) {
    if (list.count != count) return false;
    uint16_t others = 0;
    for (uint32_t i = 0; i < count; ++i) others |= list[i] ^ static_cast<uint16_t>(i);
    return others == 0;
  }

  /// Joints that LOD 0 does not list belong to no LOD in particular: they stay. So all do if LOD 0
  /// does.
  Numbers number_joints(bool with_written) {
    const Definition& defn = view_.defn;
    const uint32_t count = defn.joint_names.count;
    if (lods_ & 1) return all_stay(count);
    Span<uint8_t> marks = make<uint8_t>(count);
    if (out_of_memory_) return {};
    uint8_t* const joints = marks.data;
    std::fill(marks.begin(), marks.end(), uint8_t{1});
    const Array<uint16_t> finest = defn.lod_joints.at(0);
    for (uint32_t i = 0; i < finest.count; ++i) joints[finest[i]] = 0;
    mark_lod_elements(defn.lod_joints, lods_, marks);
    if (!with_written) return number(marks);
    for (const JointGroup& group : view_.bhvr.joints.groups) {
      const Array<uint16_t> rows = kept_rows(group.output_indices, group.lods);
      for (uint32_t r = 0; r < rows.count; ++r) joints[rows[r] / 9] = 1;
    }
    return number(marks);
  }

  /// Joint values of joints that survive, as files number them: 9 * joint + attribute. False if one
  /// is of a joint that does not.
  bool renumber_outputs() {
    if (joints_.all_stay) return true;
    const List<JointGroup>& groups = view_.bhvr.joints.groups;
    new_outputs_ = make<Array<uint16_t>>(groups.count);
    if (out_of_memory_) return true;
    uint32_t all = 0;  // bits of new numbers, which are small, and of kGone, which is not
    for (uint32_t g = 0; g < groups.count; ++g) {
      const Array<uint16_t> old = kept_rows(groups[g].output_indices, groups[g].lods);
      if (old.count == 0) continue;
      if (joints_.none_stays()) return false;
      const NewArray<uint16_t> array = make_array<uint16_t>(old.count);
      const Span<uint32_t> new_of = joints_.new_of;
      for (uint32_t r = 0; r < array.count; ++r) {
        const uint32_t output = old[r], joint = output / 9, new_joint = new_of[joint];
        array.set(r, static_cast<uint16_t>(output + (new_joint - joint) * 9));
        all |= new_joint;
      }
      new_outputs_[g] = array;
    }
    return all <= 0xFFFF;
  }

  // Pieces ------------------------------------------------------------------------------------

  /// Numbers of survivors only, renewed.
  Array<uint16_t> renumbered(Array<uint16_t> old, const Numbers& numbers) {
    if (numbers.all_stay) return old;
    if (numbers.none_stays()) return {};
    const NewArray<uint16_t> array = make_array<uint16_t>(old.count);
    const Span<uint32_t> new_of = numbers.new_of;  // a local copy: bytes may alias anything
    uint32_t kept = 0;
    for (uint32_t i = 0; i < array.count; ++i) {
      const uint32_t n = new_of[old[i]];
      array.set(kept, static_cast<uint16_t>(n));
      kept += n != kGone;
    }
    return Array<uint16_t>(array).first(kept);
  }

  /// How many survivors are among the first `count` elements.
  static uint32_t survivors_of(const Numbers& numbers, uint32_t count) {
    if (numbers.all_stay) return count < numbers.count ? count : numbers.count;
    const Span<uint32_t>& all = numbers.survivors;
    return static_cast<uint32_t>(std::lower_bound(all.begin(), all.end(), count) - all.begin());
  }

  /// Elements whose own number survives.
  template <class T>
  Array<T> survivors(Array<T> old, const Numbers& numbers) {
    const uint32_t kept = survivors_of(numbers, old.count);
    if (numbers.all_stay) return old.first(kept);
    const NewArray<T> array = make_array<T>(kept);
    const Span<uint32_t> survivors = numbers.survivors;
    for (uint32_t k = 0; k < array.count; ++k) {
      memcpy(array.data + k * sizeof(T), old.data + survivors[k] * sizeof(T), sizeof(T));
    }
    return array;
  }

  /// The same for lists, in place: the list lies in our arena.
  template <class T>
  void keep_survivors(List<T>& list, const Numbers& numbers) {
    list.count = survivors_of(numbers, list.count);
    if (numbers.all_stay) return;
    for (uint32_t k = 0; k < list.count; ++k) list[k] = list.items[numbers.survivors[k]];
  }

  Vec3Array survivors(const Vec3Array& old, const Numbers& numbers) {
    return {survivors(old.xs, numbers), survivors(old.ys, numbers), survivors(old.zs, numbers)};
  }

  Array<uint16_t> kept_lods(Array<uint16_t> lods) {
    if (neighbors_) {
      const uint32_t from = first_ < lods.count ? first_ : lods.count;
      const uint32_t left = lods.count - from;
      return {lods.data + from * sizeof(uint16_t), count_ < left ? count_ : left};
    }
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
      const uint32_t mesh = meshes_[from[i]], channel = channels_[to[i]];
      if (mesh == kGone || channel == kGone) continue;
      new_from.set(kept, static_cast<uint16_t>(mesh));
      new_to.set(kept++, static_cast<uint16_t>(channel));
    }
    defn.mesh_channels = {Array<uint16_t>(new_from).first(kept),
                          Array<uint16_t>(new_to).first(kept)};

    if (!joints_.all_stay) select_hierarchy();
    defn.neutral_translations = survivors(defn.neutral_translations, joints_);
    defn.neutral_rotations = survivors(defn.neutral_rotations, joints_);
  }

  // A joint without its parent hangs from joint 0, unless joint 0 descends from it: then it is a
  // root. Only one can be such an ancestor: the line of parents of joint 0 ends there.
  void select_hierarchy() {
    const Array<uint16_t> parents = survivors(view_.defn.joint_hierarchy, joints_);
    NewArray<uint16_t> hierarchy = make_array<uint16_t>(parents.count);
    if (out_of_memory_ || hierarchy.count == 0) return void(view_.defn.joint_hierarchy = {});
    uint32_t top = 0;
    for (uint32_t up = joints_[parents[0]]; up != kGone && up != top; up = joints_[parents[top]]) {
      top = up;
    }
    for (uint32_t j = 0; j < hierarchy.count; ++j) {
      const uint32_t parent = joints_[parents[j]];
      const uint32_t orphan = j == top ? j : 0;
      hierarchy.set(j, static_cast<uint16_t>(parent == kGone ? orphan : parent));
    }
    view_.defn.joint_hierarchy = hierarchy;
  }

  // Which columns a LOD needs decides the order in which they turn joints represented by
  // quaternions, so a file without some LODs would turn them in another order. Rows that turn get a
  // group of their own then, behind the others, with the columns in the order of the whole file: it
  // stays.
  void keep_turn_order() {
    if (view_.jbmd.joints.count == 0) return;
    List<JointGroup>& groups = view_.bhvr.joints.groups;
    uint32_t widest = 0;
    for (const JointGroup& group : groups) {
      if (group.input_indices.count > widest) widest = group.input_indices.count;
    }
    if (widest == 0) return;
    Span<uint32_t> first_rows = make<uint32_t>(widest), order = make<uint32_t>(widest);
    Span<JointGroup> all = make<JointGroup>(size_t{groups.count} * 2);
    if (out_of_memory_) return;
    uint32_t count = groups.count;
    for (uint32_t g = 0; g < groups.count; ++g) {
      all[g] = groups[g];
      const uint32_t columns =
          order_quaternion_columns(view_, groups[g], first_rows, order, nullptr);
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
      rows += is_quaternion_row(view_, group.output_indices[r]) == turning;
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
      if (is_quaternion_row(view_, group.output_indices[r]) != turning) continue;
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
    for (uint32_t g = 0; g < bhvr.joints.groups.count; ++g) {
      JointGroup& group = bhvr.joints.groups[g];
      const uint32_t rows = rows_left(group.lods), columns = group.input_indices.count;
      group.output_indices =
          joints_.all_stay ? kept_rows(group.output_indices, group.lods) : new_outputs_[g];
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
        const uint32_t channel = channels_[target.channel_index];
        if (channel == kGone) continue;
        target.channel_index = static_cast<uint16_t>(channel);
        mesh.blend_shape_targets[kept++] = target;
      }
      mesh.blend_shape_targets.count = kept;
      for (VertexSkinWeights& vertex : mesh.skin_weights) {
        if (!joints_.all_stay || vertex.weights.count == 0) select_influences(vertex);
      }
    }
  }

  // The remaining weights are scaled to compensate for those of removed joints.
  void select_influences(VertexSkinWeights& vertex) {
    if (view_.defn.joint_names.count == 0) return void(vertex = {});  // no joints, so no root
    const uint32_t count = vertex.weights.count;
    float dropped = 0, left = 0;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; ++i) {
      const bool gone = joints_[vertex.joint_indices[i]] == kGone;
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
        const uint32_t joint = joints_[vertex.joint_indices[i]];
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
        sets[s] = marked(type.lod_operations[s], count);
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
        select_map(type.lod_operations[s], numbers[s]);
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
    const uint32_t layers = (old.count - 1) / old_lod_count;
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
      const uint32_t joint = joints_[old / attributes];
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

  /// `stays(setup)` tells whether one is kept that has lost all its output joints.
  template <class Setup, class Stays>
  void select_outputs(List<Setup>& setups, const Stays& stays) {
    uint32_t kept = 0;
    for (Setup& setup : setups) {
      const Array<uint16_t> joints = setup.output_joint_indices;
      NewArray<float> weights = make_array<float>(joints.count);
      uint32_t k = 0;
      for (uint32_t i = 0; i < weights.count; ++i) {
        if (joints_[joints[i]] != kGone) weights.set(k++, setup.blend_weights[i]);
      }
      if (k == 0 && !stays(setup)) continue;
      setup.blend_weights = Array<float>(weights).first(k);
      setup.output_joint_indices = renumbered(joints, joints_);
      setups[kept++] = setup;
    }
    setups.count = kept;
  }

  static bool same_numbers(const Array<uint16_t>& a, const Array<uint16_t>& b) {
    bool same = a.count == b.count;
    for (uint32_t i = 0; same && i < a.count; ++i) same = a[i] == b[i];
    return same;
  }

  void select_twists_and_swings() {
    const auto& twists = view_.twsw.twists;
    select_outputs(view_.twsw.twists, [](const Twist&) { return false; });
    // A twist of the inputs of a swing is the opposite of one alone (docs/rig-evaluation.md, 7 "Twist and swing").
    select_outputs(view_.twsw.swings, [&](const Swing& swing) {
      return std::any_of(twists.begin(), twists.end(), [&](const Twist& twist) {
        return same_numbers(twist.input_control_indices, swing.input_control_indices);
      });
    });
  }

  DnaView& view_;
  uint64_t lods_;
  Arena& arena_;
  uint32_t first_ = 0, count_ = 0;  // finest kept LOD, number of kept LODs
  bool neighbors_;                  // no LOD between them is dropped
  Numbers joints_, channels_, maps_, meshes_, networks_;
  Span<Array<uint16_t>>
      new_outputs_;  // [joint group] of the rows that are left, unless all joints stay
  Span<Span<Span<uint8_t>>> operations_;  // [type][set][operation]: stays
  uint32_t root_ = kGone;
  bool out_of_memory_ = false;
};

}  // namespace

void mark_lod_elements(const LodMap& map, uint64_t lods, Span<uint8_t> marks) {
  for (uint32_t l = 0; l < map.lods.count && l < 64; ++l) {
    if (lods >> l & 1) mark(map.indices[map.lods[l]], marks);
  }
}

bool select_lods(DnaView& view, uint64_t lods, Arena& arena) {
  return LodSelector(view, lods, arena).run();
}

}  // namespace mien::dna
