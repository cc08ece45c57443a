// SPDX-License-Identifier: MIT
#include "tests/support/plain_rig.h"

#include <algorithm>
#include <cmath>

namespace mien {
namespace {

using dna::List;
using dna::String;

// To DNA ----------------------------------------------------------------------------------------

struct ViewMaker {
  Arena& arena;

  template <class T>
  dna::Array<T> numbers(const std::vector<T>& values) {
    const dna::NewArray<T> array = dna::new_array<T>(arena, values.size());
    for (size_t i = 0; i < values.size(); ++i) array.set(i, values[i]);
    return array;
  }
  template <class T>
  List<T> list(const std::vector<T>& items) {
    const Span<T> span = arena.array<T>(items.size());
    std::copy(items.begin(), items.end(), span.begin());
    return {span.data, static_cast<uint32_t>(span.count)};
  }
  List<String> names(const char* prefix, size_t count) {
    std::vector<String> made(count);
    for (size_t i = 0; i < count; ++i) {
      const std::string name = prefix + std::to_string(i);
      const Span<uint8_t> bytes = arena.array<uint8_t>(name.size());
      std::copy(name.begin(), name.end(), bytes.begin());
      made[i] = {bytes.data, static_cast<uint32_t>(bytes.count)};
    }
    return list(made);
  }
  /// All elements at all LODs.
  dna::LodMap everywhere(size_t count, size_t lod_count) {
    std::vector<uint16_t> all(count);
    for (size_t i = 0; i < count; ++i) all[i] = static_cast<uint16_t>(i);
    return {numbers(std::vector<uint16_t>(lod_count, 0)),
            list<dna::Array<uint16_t>>({numbers(all)})};
  }
  template <class T>
  dna::Array<T> column(const PlainTable& table, T PlainRow::*member) {
    std::vector<T> values;
    for (const PlainRow& row : table) values.push_back(row.*member);
    return numbers(values);
  }
  dna::ConditionalTable table(const PlainTable& rows) {
    return {column(rows, &PlainRow::input), column(rows, &PlainRow::output),
            column(rows, &PlainRow::from),  column(rows, &PlainRow::to),
            column(rows, &PlainRow::slope), column(rows, &PlainRow::cut)};
  }
};

}  // namespace

dna::DnaView to_view(const PlainRig& plain, Arena& arena) {
  ViewMaker make{arena};
  dna::DnaView view;
  view.loaded = dna::kLayersAll;
  std::vector<dna::IndexEntry> index;
  for (const dna::LayerKind& kind : dna::kLayerKinds) {
    index.push_back({kind.code, kind.layer_version, nullptr, 0});
  }
  view.index = make.list(index);
  view.desc.coordinate_system = {1, 2, 4};
  view.desc.lod_count = plain.lod_count;

  dna::Definition& defn = view.defn;
  defn.lod_joints = make.everywhere(plain.joint_count, plain.lod_count);
  defn.lod_channels = make.everywhere(plain.channel_count, plain.lod_count);
  defn.lod_maps = make.everywhere(plain.map_count, plain.lod_count);
  defn.gui_control_names = make.names("gui", plain.gui_count);
  defn.raw_control_names = make.names("raw", plain.raw_count);
  defn.joint_names = make.names("joint", plain.joint_count);
  defn.channel_names = make.names("channel", plain.channel_count);
  defn.map_names = make.names("map", plain.map_count);
  defn.joint_hierarchy = make.numbers(std::vector<uint16_t>(plain.joint_count, 0));
  const auto zeros = make.numbers(std::vector<float>(plain.joint_count, 0));
  defn.neutral_translations = defn.neutral_rotations = {zeros, zeros, zeros};

  dna::Controls& controls = view.bhvr.controls;
  controls.psd_count = plain.psd_count;
  controls.conditionals = make.table(plain.gui_to_raw);
  std::vector<uint16_t> rows, columns;
  std::vector<float> values;
  for (const PlainPsd& triple : plain.psds) {
    rows.push_back(triple.row);
    columns.push_back(triple.column);
    values.push_back(triple.value);
  }
  controls.psds = {make.numbers(rows), make.numbers(columns), make.numbers(values)};

  std::vector<dna::JointGroup> groups;
  for (const PlainGroup& group : plain.groups) {
    std::vector<uint16_t> joints;
    for (uint16_t output : group.outputs) joints.push_back(output / 9);
    groups.push_back({make.numbers(group.lods), make.numbers(group.inputs),
                      make.numbers(group.outputs), make.numbers(group.values),
                      make.numbers(joints)});
  }
  view.bhvr.joints.row_count = static_cast<uint16_t>(9 * plain.joint_count);
  view.bhvr.joints.col_count = static_cast<uint16_t>(plain.raw_count + plain.psd_count);
  view.bhvr.joints.groups = make.list(groups);
  view.bhvr.channels = {make.numbers(plain.channel_lods), make.numbers(plain.channel_inputs),
                        make.numbers(plain.channel_outputs)};
  view.bhvr.maps = {make.numbers(plain.map_lods), make.table(plain.maps)};
  return view;
}

RigHandle make_rig(const PlainRig& plain, uint32_t isa, MienStatus expected) {
  Arena arena(default_allocator());
  const std::vector<uint8_t> bytes = write_view(to_view(plain, arena));
  const DnaHandle dna = open_dna(bytes);
  return create_rig(dna.get(), isa, expected);
}

// Random rigs -----------------------------------------------------------------------------------

namespace {

uint16_t pick(Random& random, uint32_t limit) { return static_cast<uint16_t>(random.below(limit)); }

/// Multiples of an eighth: sums and products of few of them are exact, and interval ends are met.
float eighths(Random& random, int low, int high) {
  return static_cast<float>(low * 8 + static_cast<int>(random.below((high - low) * 8u + 1))) / 8;
}

PlainTable random_table(Random& random, uint32_t rows, uint16_t inputs, uint16_t outputs) {
  PlainTable table;
  while (table.size() < rows) {
    const uint16_t input = pick(random, inputs), output = pick(random, outputs);
    for (uint32_t n = 1 + random.below(3); n > 0 && table.size() < rows; --n) {
      const float slope = random.chance(0.1) ? 0 : eighths(random, -2, 2);
      table.push_back({input, output, eighths(random, -1, 1), eighths(random, -1, 1), slope,
                       eighths(random, -1, 1)});
    }
  }
  return table;
}

/// All rows at LOD 0, then fewer and fewer.
std::vector<uint16_t> random_lods(Random& random, uint16_t lod_count, size_t rows) {
  std::vector<uint16_t> lods;
  for (uint16_t l = 0; l < lod_count; ++l) {
    lods.push_back(static_cast<uint16_t>(rows));
    rows -= random.below(static_cast<uint32_t>(rows) + 1);
  }
  return lods;
}

PlainGroup random_group(Random& random, const PlainRig& plain) {
  PlainGroup group;
  const uint32_t controls = plain.raw_count + plain.psd_count, columns = random.below(controls + 1);
  for (uint32_t c = 0; c < columns; ++c) group.inputs.push_back(pick(random, controls));
  const uint32_t rows = random.below(40);
  for (uint32_t r = 0; r < rows; ++r) group.outputs.push_back(pick(random, 9 * plain.joint_count));
  for (uint32_t r = 0; r < rows; ++r) {
    const bool zero = random.chance(0.2);
    for (uint32_t c = 0; c < columns; ++c) {
      const bool empty = zero || random.chance(0.4);
      group.values.push_back(empty ? 0 : static_cast<float>(random.between(-20, 20)));
    }
  }
  group.lods = random_lods(random, plain.lod_count, rows);
  return group;
}

}  // namespace

PlainRig random_rig(Random& random) {
  PlainRig plain;
  plain.lod_count = static_cast<uint16_t>(1 + random.below(5));
  plain.gui_count = static_cast<uint16_t>(1 + random.below(8));
  plain.raw_count = static_cast<uint16_t>(1 + random.below(12));
  plain.psd_count = static_cast<uint16_t>(random.below(14));
  plain.joint_count = static_cast<uint16_t>(1 + random.below(5));
  plain.channel_count = static_cast<uint16_t>(1 + random.below(9));
  plain.map_count = static_cast<uint16_t>(1 + random.below(4));
  const uint16_t controls = static_cast<uint16_t>(plain.raw_count + plain.psd_count);

  plain.gui_to_raw = random_table(random, random.below(40), plain.gui_count, plain.raw_count);
  // Correctives read raw controls and, by a shuffled rank, correctives of a lower one.
  std::vector<uint16_t> rank(plain.psd_count);
  for (uint16_t p = 0; p < plain.psd_count; ++p) rank[p] = p;
  for (uint16_t p = plain.psd_count; p > 1; --p) std::swap(rank[p - 1], rank[random.below(p)]);
  for (uint16_t i = 0; i < plain.psd_count; ++i) {
    for (uint32_t n = random.below(5); n > 0; --n) {
      const uint32_t column = random.below(plain.raw_count + uint32_t{i});
      const bool raw = column < plain.raw_count;
      plain.psds.push_back(
          {static_cast<uint16_t>(plain.raw_count + rank[i]),
           static_cast<uint16_t>(raw ? column : plain.raw_count + rank[column - plain.raw_count]),
           random.chance(0.7) ? 1 : eighths(random, -2, 2)});
    }
  }
  for (size_t i = plain.psds.size(); i > 1; --i) {
    std::swap(plain.psds[i - 1], plain.psds[random.below(static_cast<uint32_t>(i))]);
  }

  for (uint32_t g = random.below(5); g > 0; --g)
    plain.groups.push_back(random_group(random, plain));
  for (uint32_t r = random.below(12); r > 0; --r) {
    plain.channel_inputs.push_back(pick(random, controls));
    plain.channel_outputs.push_back(pick(random, plain.channel_count));
  }
  plain.channel_lods = random_lods(random, plain.lod_count, plain.channel_inputs.size());
  plain.maps = random_table(random, random.below(12), controls, plain.map_count);
  plain.map_lods = random_lods(random, plain.lod_count, plain.maps.size());
  return plain;
}

PlainRig tall_rig() {
  constexpr uint16_t kControls = 60, kJoints = 2000, kRows = 9;
  PlainRig plain;
  plain.lod_count = 2;
  plain.raw_count = kControls;
  plain.joint_count = kJoints;
  for (uint16_t j = 0; j < kJoints; ++j) {
    PlainGroup group;
    group.lods = {kRows, static_cast<uint16_t>(j % 4 == 0 ? kRows : 0)};
    const uint32_t own = uint32_t{j} * kControls / kJoints;  // neighbors move together
    for (uint32_t input : {own, (own + 7) % kControls, (own + 30) % kControls}) {
      group.inputs.push_back(static_cast<uint16_t>(input));
    }
    for (uint16_t r = 0; r < kRows; ++r) {
      group.outputs.push_back(static_cast<uint16_t>(j * kRows + r));
      for (uint16_t c = 0; c < 3; ++c) group.values.push_back(static_cast<float>(j % 50 + r + c));
    }
    plain.groups.push_back(group);
  }
  return plain;
}

}  // namespace mien
