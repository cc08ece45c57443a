// SPDX-License-Identifier: MIT
#include "author/generate/synthetic/rig.h"

#include <algorithm>

#include "author/generate/synthetic/body.h"

namespace mien {
namespace synthetic {
namespace {

// Descriptor and definition ----------------------------------------------------------------------

bool fill_descriptor(const char* preset, uint32_t lod_count, uint64_t seed, bool learned,
                     Arena& arena, dna::Descriptor& out) {
  out.archetype = 5;  // other
  out.gender = 2;     // other
  out.age = 30;
  out.coordinate_system = {0, 2, 4};  // left, up, front: right-handed
  out.lod_count = static_cast<uint16_t>(lod_count);
  const char* keys[] = {"generator", "preset", "seed", "learned"};
  const Text values[] = {Text().add("mien gen"), Text().add(preset), Text().add(seed),
                         Text().add("yes")};
  if (!make(arena, learned ? 4 : 3, out.metadata)) return false;
  for (size_t i = 0; i < out.metadata.count; ++i) {
    if (!copy_text(arena, Text().add(keys[i]), out.metadata[i].key)) return false;
    if (!copy_text(arena, values[i], out.metadata[i].value)) return false;
  }
  return copy_text(arena, Text().add("synthetic_").add(preset), out.name) &&
         copy_text(arena, Text().add("mien_").add(preset), out.complexity) &&
         copy_text(arena, Text().add("mien_synthetic"), out.db_name);
}

bool fill_joint_definition(const Head& head, Arena& arena, dna::Definition& out) {
  size_t count = head.joints.count;
  dna::NewArray<uint16_t> parents;
  dna::NewArray<float> values[6];
  if (!make(arena, count, out.joint_names) || !make(arena, count, parents)) return false;
  for (dna::NewArray<float>& v : values) {
    if (!make(arena, count, v)) return false;
  }
  for (size_t i = 0; i < count; ++i) {
    const Joint& joint = head.joints[i];
    out.joint_names[i] = joint.name;
    parents.set(i, joint.parent);
    const double numbers[6] = {joint.translation.x, joint.translation.y, joint.translation.z,
                               joint.rotation.x,    joint.rotation.y,    joint.rotation.z};
    for (int k = 0; k < 6; ++k) values[k].set(i, static_cast<float>(numbers[k]));
  }
  out.joint_hierarchy = parents;
  out.neutral_translations = {values[0], values[1], values[2]};
  out.neutral_rotations = {values[3], values[4], values[5]};
  auto in_lod = [&head](size_t lod, size_t joint) { return head.joint_in_lod(joint, lod); };
  return make_lod_map(arena, head.sizes->lod_count, count, in_lod, out.lod_joints);
}

bool fill_control_names(const Head& head, Arena& arena, dna::Definition& out) {
  const size_t raw_count = head.raw_count();
  if (!make(arena, raw_count, out.raw_control_names)) return false;
  for (size_t i = 0; i < raw_count; ++i) {
    Text name;
    if (!head.is_input(i)) name.add("CTRL_expressions.");
    name.add(head.controls[i].name);
    if (!copy_text(arena, name, out.raw_control_names[i])) return false;
  }
  out.gui_control_names = {head.gui_names.data, head.sizes->gui_count};
  return true;
}

// Tables ------------------------------------------------------------------------------------------

struct NewTable {
  dna::NewArray<uint16_t> inputs, outputs;
  dna::NewArray<float> from, to, slope, cut;

  bool allocate(Arena& arena, size_t rows) {
    return make(arena, rows, inputs) && make(arena, rows, outputs) && make(arena, rows, from) &&
           make(arena, rows, to) && make(arena, rows, slope) && make(arena, rows, cut);
  }
  void set(size_t row, size_t input, size_t output, const Ramp& ramp) const {
    inputs.set(row, static_cast<uint16_t>(input));
    outputs.set(row, static_cast<uint16_t>(output));
    from.set(row, ramp.from);
    to.set(row, ramp.to);
    slope.set(row, ramp.slope);
    cut.set(row, ramp.cut);
  }
  dna::ConditionalTable table() const { return {inputs, outputs, from, to, slope, cut}; }
};

bool fill_controls(const Head& head, uint64_t seed, Arena& arena, dna::Controls& out) {
  size_t raw_count = head.raw_count(), ramps = 0, members = 0;
  for (const Control& control : head.controls) {
    ramps += control.ramp_count;
    members += control.member_count;
  }
  NewTable table;
  dna::NewArray<uint16_t> rows, columns;
  dna::NewArray<float> weights;
  if (!table.allocate(arena, ramps) || !make(arena, members, rows) ||
      !make(arena, members, columns) || !make(arena, members, weights)) {
    return false;
  }

  Random random = Random::from_seed(seed, kWeightStream);
  size_t row = 0, entry = 0;
  for (size_t c = 0; c < head.controls.count; ++c) {
    const Control& control = head.controls[c];
    for (uint16_t r = 0; r < control.ramp_count; ++r)
      table.set(row++, control.gui, c, control.ramps[r]);
    // A few correctives reach 1 before their members do.
    float first_weight = c >= raw_count && random.chance(0.05) ? 2.0f : 1.0f;
    for (uint16_t m = 0; m < control.member_count; ++m) {
      rows.set(entry, static_cast<uint16_t>(c));
      columns.set(entry, control.members[m]);
      weights.set(entry++, m == 0 ? first_weight : 1.0f);
    }
  }
  out.psd_count = static_cast<uint16_t>(head.sizes->psd_count);
  out.conditionals = table.table();
  out.psds = {rows, columns, weights};
  return true;
}

// Joint groups ------------------------------------------------------------------------------------

struct GroupMaker {
  const Head& head;
  Random random;
  Arena& arena;
  Span<uint16_t> joint_buffer, column_buffer;  // room for all joints and columns
  Span<uint8_t> outlier;                       // by column
  Span<double> influence;                      // by column

  bool allocate() {
    return make(arena, head.joints.count, joint_buffer) &&
           make(arena, head.controls.count, column_buffer) &&
           make(arena, head.controls.count, outlier) && make(arena, head.controls.count, influence);
  }

  /// Joints of the group, those of the coarsest LODs first.
  Span<uint16_t> find_joints(size_t group) const {
    size_t count = 0;
    for (size_t j = 0; j < head.joints.count; ++j) {
      const Joint& joint = head.joints[j];
      if (joint.region == kNoRegion || joint.group != group) continue;
      joint_buffer[count++] = static_cast<uint16_t>(j);
    }
    Span<uint16_t> joints = joint_buffer.first(count);
    std::sort(joints.begin(), joints.end(), [this](uint16_t a, uint16_t b) {
      uint16_t rank_a = head.joints[a].rank, rank_b = head.joints[b].rank;
      return rank_a < rank_b || (rank_a == rank_b && a < b);
    });
    return joints;
  }

  /// Controls that reach one of the joints, and one percent of the others: production files have such
  /// unneeded columns, and the rig compiler has to handle them.
  Span<uint16_t> find_columns(Span<const uint16_t> joints) {
    size_t count = 0;
    for (size_t c = 0; c < head.controls.count; ++c) {
      bool reaches = false;
      for (uint16_t j : joints) {
        reaches = reaches || head.influence(head.controls[c], head.joints[j]) > 0;
      }
      if (!reaches && (head.is_input(c) || !random.chance(0.01))) continue;
      outlier[count] = !reaches;
      column_buffer[count++] = static_cast<uint16_t>(c);
    }
    if (count == 0) {  // no group without columns
      outlier[0] = true;
      column_buffer[count++] = static_cast<uint16_t>(random.below(head.sizes->raw_count));
    }
    return column_buffer.first(count);
  }

  float draw_delta(int attribute, uint16_t control, double influence_here) {
    double deviation = attribute < 3 ? 0.25 : attribute < 6 ? 4.0 : 0.05;  // cm, degrees, factor
    if (control >= head.raw_count()) deviation *= 0.5;
    return static_cast<float>(random.normal() * deviation * influence_here);
  }

  void fill_values(Span<const uint16_t> joints, Span<const uint16_t> columns,
                   const dna::NewArray<uint16_t>& outputs, const dna::NewArray<float>& values) {
    size_t row = 0;
    for (uint16_t j : joints) {
      const Joint& joint = head.joints[j];
      for (size_t c = 0; c < columns.count; ++c) {
        influence[c] = head.influence(head.controls[columns[c]], joint);
      }
      for (int attribute = 0; attribute < 9; ++attribute) {
        if (!(joint.attributes >> attribute & 1)) continue;
        outputs.set(row, static_cast<uint16_t>(j * 9 + attribute));
        for (size_t c = 0; c < columns.count; ++c) {
          bool moves = influence[c] > 0 && random.chance(kEntryShare);
          float delta = moves ? draw_delta(attribute, columns[c], influence[c]) : 0.0f;
          values.set(row * columns.count + c, delta);
        }
        ++row;
      }
    }
    for (size_t c = 0; c < columns.count; ++c) {
      if (!outlier[c]) continue;
      size_t at = random.below(static_cast<uint32_t>(row));
      values.set(at * columns.count + c, draw_delta(0, columns[c], 0.2));
    }
  }

  bool fill(size_t group, dna::JointGroup& out) {
    Span<uint16_t> joints = find_joints(group);
    Span<uint16_t> columns = find_columns(joints);
    size_t lod_count = head.sizes->lod_count, row_count = 0;
    for (uint16_t j : joints) row_count += count_rows(head.joints[j]);

    dna::NewArray<uint16_t> lods, inputs, outputs, members;
    dna::NewArray<float> values;
    if (!make(arena, lod_count, lods) || !make(arena, columns.count, inputs) ||
        !make(arena, row_count, outputs) || !make(arena, row_count * columns.count, values) ||
        !make(arena, joints.count, members)) {
      return false;
    }
    for (size_t lod = 0; lod < lod_count; ++lod) {
      uint32_t rows = 0;
      for (uint16_t j : joints) rows += head.joint_in_lod(j, lod) ? count_rows(head.joints[j]) : 0;
      lods.set(lod, static_cast<uint16_t>(rows));
    }
    for (size_t c = 0; c < columns.count; ++c) inputs.set(c, columns[c]);
    for (size_t j = 0; j < joints.count; ++j) members.set(j, joints[j]);
    fill_values(joints, columns, outputs, values);
    out = {lods, inputs, outputs, values, members};
    return true;
  }

  static uint32_t count_rows(const Joint& joint) {
    uint32_t rows = 0;
    for (uint32_t mask = joint.attributes; mask; mask &= mask - 1) ++rows;
    return rows;
  }

  /// The share of nonzero entries within a control's reach.
  static constexpr double kEntryShare = 0.62;
};

bool fill_joints(const Head& head, uint64_t seed, Arena& arena, dna::Joints& out) {
  out.row_count = static_cast<uint16_t>(9 * head.joints.count);
  out.col_count = static_cast<uint16_t>(head.controls.count);
  GroupMaker maker = {head, Random::from_seed(seed, kGroupStream), arena, {}, {}, {}, {}};
  if (!maker.allocate() || !make(arena, head.sizes->group_count, out.groups)) return false;
  for (size_t g = 0; g < out.groups.count; ++g) {
    if (!maker.fill(g, out.groups[g])) return false;
  }
  return true;
}

// Channels and maps -------------------------------------------------------------------------------

/// LOD 0 has all channels, LOD 1 those `kept`, others none.
bool fill_channels(const Head& head, uint64_t seed, Arena& arena, dna::DnaView& out,
                   Span<uint8_t>& kept) {
  const Sizes& sizes = *head.sizes;
  size_t count = sizes.channel_count, kept_count = 0;
  dna::NewArray<uint16_t> lods, inputs, outputs;
  if (!make(arena, count, kept) || !make(arena, count, out.defn.channel_names) ||
      !make(arena, sizes.lod_count, lods) || !make(arena, count, inputs) ||
      !make(arena, count, outputs)) {
    return false;
  }
  Random random = Random::from_seed(seed, kChannelStream);
  for (uint8_t& k : kept) {
    k = random.chance(0.5);
    kept_count += k;
  }

  size_t first = 0, rest = kept_count;
  for (size_t i = 0; i < count; ++i) {
    size_t control = head.control_of_channel(i);
    size_t entry = kept[i] ? first++ : rest++;
    inputs.set(entry, static_cast<uint16_t>(control));
    outputs.set(entry, static_cast<uint16_t>(i));
    Text name;
    name.add("head__").add(head.controls[control].name);
    if (!copy_text(arena, name, out.defn.channel_names[i])) return false;
  }
  for (size_t lod = 0; lod < sizes.lod_count; ++lod) {
    lods.set(lod, static_cast<uint16_t>(lod == 0 ? count : lod == 1 ? kept_count : 0));
  }
  out.bhvr.channels = {lods, inputs, outputs};
  auto in_lod = [&](size_t lod, size_t i) { return lod == 0 || (lod == 1 && kept[i]); };
  return make_lod_map(arena, sizes.lod_count, count, in_lod, out.defn.lod_channels);
}

struct MapRow {
  uint16_t input = 0, output = 0;
  Ramp ramp;
};

/// Two or three connected pieces that rise from 0 to at most 1.
uint32_t draw_pieces(size_t input, size_t output, Random& random, MapRow* rows) {
  uint32_t pieces = 2 + random.below(2);
  double x = 0, y = 0;
  for (uint32_t i = 0; i < pieces; ++i) {
    double next_x = (i + 1) * (1.0 / pieces), next_y = y + random.between(0.05, 1.0 / pieces);
    if (i + 1 == pieces) next_x = 1;
    double slope = (next_y - y) / (next_x - x);
    rows[i].input = static_cast<uint16_t>(input);
    rows[i].output = static_cast<uint16_t>(output);
    rows[i].ramp = {static_cast<float>(x), static_cast<float>(next_x), static_cast<float>(slope),
                    static_cast<float>(y - slope * x)};
    x = next_x;
    y = next_y;
  }
  return pieces;
}

bool fill_maps(const Head& head, uint64_t seed, Arena& arena, dna::DnaView& out) {
  const Sizes& sizes = *head.sizes;
  uint32_t count = sizes.map_count;
  Span<uint16_t> order, place;  // maps by importance, and the inverse
  Span<uint32_t> end;           // of the rows of the n-th map
  Span<MapRow> rows;
  dna::NewArray<uint16_t> lods;
  if (!make(arena, count, order) || !make(arena, count, place) || !make(arena, count, end) ||
      !make(arena, size_t{count} * 6, rows) || !make(arena, sizes.lod_count, lods) ||
      !make(arena, count, out.defn.map_names)) {
    return false;
  }
  Random random = Random::from_seed(seed, kMapStream);
  for (uint32_t i = 0; i < count; ++i) order[i] = static_cast<uint16_t>(i);
  for (uint32_t i = count; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);

  uint32_t row_count = 0;
  for (uint32_t n = 0; n < count; ++n) {
    uint16_t map = order[n];
    place[map] = static_cast<uint16_t>(n);
    uint32_t control = map * sizes.raw_count / count;
    Text name;
    name.add("wrinkle_").add(head.controls[control].name);
    if (!copy_text(arena, name, out.defn.map_names[map])) return false;
    row_count += draw_pieces(control, map, random, rows.data + row_count);
    if (random.chance(0.3)) {
      uint32_t corrective = head.raw_count() + random.below(sizes.psd_count);
      row_count += draw_pieces(corrective, map, random, rows.data + row_count);
    }
    end[n] = row_count;
  }

  auto maps_at = [&](size_t lod) {
    return lod + 1 == sizes.lod_count ? 0
                                      : shrink(count, static_cast<uint32_t>(lod), sizes.lod_count);
  };
  for (size_t lod = 0; lod < sizes.lod_count; ++lod) {
    uint32_t maps = maps_at(lod);
    lods.set(lod, static_cast<uint16_t>(maps ? end[maps - 1] : 0));
  }
  NewTable table;
  if (!table.allocate(arena, row_count)) return false;
  for (uint32_t r = 0; r < row_count; ++r)
    table.set(r, rows[r].input, rows[r].output, rows[r].ramp);
  out.bhvr.maps = {lods, table.table()};
  auto in_lod = [&](size_t lod, size_t map) { return place[map] < maps_at(lod); };
  return make_lod_map(arena, sizes.lod_count, count, in_lod, out.defn.lod_maps);
}

bool make_head_rig(SyntheticPreset preset, uint64_t seed, bool learned, Arena& arena,
                   dna::DnaView& out) {
  Head head;
  Span<uint8_t> kept;
  return make_head(preset, seed, arena, head) &&
         fill_descriptor(head.sizes->name, head.sizes->lod_count, seed, learned, arena, out.desc) &&
         fill_joint_definition(head, arena, out.defn) &&
         fill_control_names(head, arena, out.defn) &&
         fill_controls(head, seed, arena, out.bhvr.controls) &&
         fill_joints(head, seed, arena, out.bhvr.joints) &&
         fill_channels(head, seed, arena, out, kept) && fill_maps(head, seed, arena, out) &&
         make_neck_solver(head, arena, out) && make_meshes(head, seed, kept, arena, out);
}

uint16_t version_of(SyntheticPreset preset) {
  switch (preset) {
    case SyntheticPreset::kMetaHumanHead:
    case SyntheticPreset::kArchetype: return 5;
    case SyntheticPreset::kMetaHumanBody: return 7;
    default: return 8;
  }
}

bool make_rig(SyntheticPreset preset, uint64_t seed, bool learned, Arena& arena,
              dna::DnaView& out) {
  if (!fill_index(version_of(preset), arena, out)) return false;
  if (preset == SyntheticPreset::kBody || preset == SyntheticPreset::kMetaHumanBody) {
    const uint32_t ml_count = learned ? ml_control_count_of(preset) : 0;
    const char* name = preset == SyntheticPreset::kBody ? "body" : "metahuman-body";
    if (!fill_descriptor(name, kBodyLodCount, seed, learned, arena, out.desc) ||
        !make_body_rig(seed, ml_count, arena, out)) {
      return false;
    }
  } else if (!make_head_rig(preset, seed, learned, arena, out)) {
    return false;
  }
  return !learned || add_learned_behavior(preset, seed, arena, out);
}

}  // namespace
}  // namespace synthetic

bool make_synthetic_rig(SyntheticPreset preset, uint64_t seed, Arena& arena, dna::DnaView& out,
                        bool learned) {
  out = dna::DnaView();
  if (synthetic::make_rig(preset, seed, learned, arena, out)) return true;
  out = dna::DnaView();
  return false;
}

}  // namespace mien
