// SPDX-License-Identifier: MIT
#include "integrations/program/reduce/prune.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "integrations/program/io/dna_fields.h"

namespace mien::cli {

namespace {

constexpr size_t kBlockRows = 8;  // that the joint matrix stores together

void must(MienStatus status, const MienError& error) { check(status, &error, "cannot reduce", ""); }

std::vector<int64_t> integers_at(const MienDocument* document, const std::string& path) {
  auto field = sized<MienDnaField>();
  auto error = sized<MienError>();
  must(mien_document_field(document, path.c_str(), &field, &error), error);
  std::vector<int64_t> values(field.count);
  must(mien_document_read_integers(document, path.c_str(), 0, values.size(), values.data(), &error),
       error);
  return values;
}

std::vector<PrunedGroup> read_groups(const MienDocument* document) {
  auto field = sized<MienDnaField>();
  auto error = sized<MienError>();
  must(mien_document_field(document, "bhvr.joints.jointGroups", &field, &error), error);
  std::vector<PrunedGroup> groups(field.count);
  for (size_t g = 0; g < groups.size(); ++g) {
    PrunedGroup& group = groups[g];
    const auto path = [g](const char* name) { return element("bhvr.joints.jointGroups", g, name); };
    group.path = path(".values");
    group.inputs = integers_at(document, path(".inputIndices"));
    group.outputs = integers_at(document, path(".outputIndices"));
    group.lods = integers_at(document, path(".lods"));
    group.values.resize(group.inputs.size() * group.outputs.size());
    must(mien_document_read_floats(document, group.path.c_str(), 0, group.values.size(),
                                   group.values.data(), &error),
         error);
  }
  return groups;
}

/// Rows in the order in which the joint matrix has them: those that more LODs reach first, then by output.
std::vector<size_t> rows_in_order(const PrunedGroup& group) {
  const auto reach = [&group](size_t row) {
    size_t lod = 0;
    while (lod < group.lods.size() && group.lods[lod] > static_cast<int64_t>(row)) ++lod;
    return lod;
  };
  std::vector<size_t> rows(group.outputs.size()), reaches(rows.size());
  std::iota(rows.begin(), rows.end(), size_t{0});
  for (const size_t row : rows) reaches[row] = reach(row);
  std::stable_sort(rows.begin(), rows.end(), [&](size_t a, size_t b) {
    return reaches[a] != reaches[b] ? reaches[a] > reaches[b] : group.outputs[a] < group.outputs[b];
  });
  return rows;
}

}  // namespace

Pruning::Pruning(const MienDna* dna, Character& original, const Tolerances& tolerances)
    : original_(original), reaches_(joint_reaches(original, tolerances)),
      influence_importance_(mien::cli::influence_importance(original, tolerances)),
      least_tolerance_(tolerances.least()) {
  const bool degrees = rig_info(original.rig.get()).rotation_unit == MIEN_ROTATION_UNIT_DEGREES;
  radians_ = degrees ? 3.14159265358979323846 / 180 : 1;
  MienDocument* made = nullptr;
  auto error = sized<MienError>();
  must(mien_document_create(dna, nullptr, &made, &error), error);
  document_.reset(made);
  groups_ = read_groups(made);
}

/// Sets whole blocks to 0, because a block with one number takes as much memory and time as a full one.
/// Returns whether rows were left without any numbers: blocks have other rows then.
bool Pruning::prune_blocks(const PrunedGroup& group, double limit,
                           std::vector<float>& values) const {
  const size_t columns = group.inputs.size();
  const auto used = [&](size_t row) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(row * columns);
    return std::any_of(first, first + static_cast<std::ptrdiff_t>(columns),
                       [](float value) { return value != 0; });
  };
  std::vector<size_t> rows = rows_in_order(group);
  rows.erase(std::remove_if(rows.begin(), rows.end(), [&](size_t row) { return !used(row); }),
             rows.end());
  for (size_t first = 0; first < rows.size(); first += kBlockRows) {
    const size_t end = std::min(first + kBlockRows, rows.size());
    for (size_t c = 0; c < columns; ++c) {
      double square = 0;
      for (size_t r = first; r < end; ++r) {
        const auto output = static_cast<size_t>(group.outputs[rows[r]]);
        const JointReach& reach = reaches_[output / 9];
        const size_t attribute = output % 9;
        const double unit = attribute < 3   ? reach.shift
                            : attribute < 6 ? reach.turn * radians_
                                            : reach.turn;
        const double value = double{values[rows[r] * columns + c]};
        if (value != 0) square += value * unit * value * unit;
      }
      if (!(square <= limit * limit)) continue;
      for (size_t r = first; r < end; ++r) values[rows[r] * columns + c] = 0;
    }
  }
  return !std::all_of(rows.begin(), rows.end(), used);
}

void Pruning::prune_matrix(double limit) {
  matrix_entries = 0;
  for (const PrunedGroup& group : groups_) {
    std::vector<float> values = group.values;
    for (int pass = 0; pass < 3 && prune_blocks(group, limit, values); ++pass) {
    }
    matrix_entries +=
        values.size() - static_cast<size_t>(std::count(values.begin(), values.end(), 0.0f));
    if (values == group.values) continue;
    auto error = sized<MienError>();
    must(mien_document_write_floats(document_.get(), group.path.c_str(), 0, values.size(),
                                    values.data(), &error),
         error);
  }
}

/// Drops the influences of each position, the least important first, while their sum stays below the limit;
/// the others take over their weights. Leaves meshes alone whose weights the document would not accept.
void Pruning::prune_weights(uint32_t index, double limit) {
  const MienMesh mesh = original_.mesh(index);
  const std::vector<float>& importance = influence_importance_[index];
  std::vector<std::vector<std::pair<uint16_t, float>>> left(mesh.position_count);
  size_t at = 0, kept = 0, widest = 1;
  bool acceptable = true;
  for (uint32_t p = 0; p < mesh.position_count; ++p) {
    MienIndex16View joints{};
    MienFloatView weights{};
    original_.influences(index, p, joints, weights);
    std::vector<size_t> order(joints.count);
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return importance[at + a] < importance[at + b]; });
    std::vector<bool> dropped(joints.count);
    double sum = 0, dropped_weight = 0, whole = 0;
    for (size_t i = 0; i < joints.count; ++i) whole += double{weights.data[i]};
    for (size_t k = 0; k + 1 < order.size(); ++k) {
      sum += double{importance[at + order[k]]};
      if (!(sum <= limit)) break;
      dropped[order[k]] = true;
      dropped_weight += double{weights.data[order[k]]};
    }
    const double scale = dropped_weight > 0 ? whole / (whole - dropped_weight) : 1;
    for (size_t i = 0; i < joints.count; ++i) {
      acceptable = acceptable && weights.data[i] > 0 &&
                   std::count(joints.data, joints.data + joints.count, joints.data[i]) == 1;
      if (dropped[i]) continue;
      left[p].emplace_back(joints.data[i], static_cast<float>(double{weights.data[i]} * scale));
    }
    acceptable = acceptable && joints.count != 0;
    at += joints.count;
    kept += left[p].size();
    widest = std::max(widest, left[p].size());
  }
  if (!acceptable || kept == at) {
    influences += at;
    return;
  }
  influences += kept;
  std::vector<uint16_t> joints(mesh.position_count * widest);
  std::vector<float> weights(joints.size());
  for (size_t p = 0; p < left.size(); ++p) {
    for (size_t i = 0; i < left[p].size(); ++i) {
      joints[p * widest + i] = left[p][i].first;
      weights[p * widest + i] = left[p][i].second;
    }
  }
  auto error = sized<MienError>();
  must(mien_document_set_weights(document_.get(), index, static_cast<uint32_t>(widest),
                                 joints.data(), weights.data(), weights.size(), &error),
       error);
}

Dna Pruning::prune(const PruneLimits& limits) {
  auto error = sized<MienError>();
  must(mien_document_undo(document_.get(), 0, &error), error);
  prune_matrix(limits.matrix);
  const uint32_t mesh_count = rig_count(original_.rig.get(), MIEN_KIND_MESH);
  influences = deltas = 0;
  for (uint32_t m = 0; m < mesh_count; ++m) {
    deltas += original_.mesh(m).delta_count;
    prune_weights(m, limits.deformer);
  }
  auto pruned = sized<MienPrunedTargets>();
  if (limits.deformer > 0) {
    const auto shortest = static_cast<float>(limits.deformer * least_tolerance_);
    must(mien_document_prune_targets(document_.get(), shortest, &pruned, &error), error);
  }
  deltas -= std::min<uint64_t>(deltas, pruned.deltas);
  MienDna* made = nullptr;
  must(mien_document_to_dna(document_.get(), nullptr, &made, &error), error);
  return Dna(made);
}

}  // namespace mien::cli
