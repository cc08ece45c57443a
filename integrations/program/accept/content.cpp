// SPDX-License-Identifier: MIT
#include "integrations/program/accept/content.h"

#include <algorithm>
#include <chrono>
#include <map>

#include "integrations/program/io/dna_fields.h"

namespace mien::cli {

namespace {

constexpr char kCannotRead[] = "cannot read rig";
constexpr int kSamples = 25;

void add_counts(const AcceptedRig& rig, Content& content) {
  const std::pair<const char*, uint32_t> kinds[] = {
      {"gui_controls", MIEN_KIND_GUI_CONTROL},
      {"raw_controls", MIEN_KIND_RAW_CONTROL},
      {"correctives", MIEN_KIND_PSD_CONTROL},
      {"ml_controls", MIEN_KIND_ML_CONTROL},
      {"rbf_controls", MIEN_KIND_RBF_CONTROL},
      {"joints", MIEN_KIND_JOINT},
      {"joint_groups", MIEN_KIND_JOINT_GROUP},
      {"blend_shape_channels", MIEN_KIND_BLEND_SHAPE_CHANNEL},
      {"animated_maps", MIEN_KIND_ANIMATED_MAP},
      {"meshes", MIEN_KIND_MESH},
      {"rbf_solvers", MIEN_KIND_RBF_SOLVER}};
  for (const auto& [name, kind] : kinds) {
    content.counts.push_back({name, rig_count(rig.rig.get(), kind)});
  }
  const model::LayerRig& model = rig.model;
  content.counts.push_back({"rbf_poses", model.poses.size()});
  content.counts.push_back({"twists", model.twists.size()});
  content.counts.push_back({"swings", model.swings.size()});
  content.counts.push_back({"neural_networks", model.networks.size()});
  content.counts.push_back({"ml_regions", model.regions.size()});
  content.counts.push_back({"lods", rig.lod_count()});
  content.counts.push_back({"layers", rig.file.info.layer_count});
}

/// By LOD.
Histogram per_lod(const AcceptedRig& rig, const char* name, const char* unit, uint32_t kind) {
  Histogram result{name, unit, {}};
  for (uint32_t lod = 0; lod < rig.lod_count(); ++lod) {
    MienIndex16View indices{};
    check(mien_rig_lod_indices(rig.rig.get(), kind, lod, &indices), nullptr, kCannotRead, "");
    result.bars.push_back({"LOD " + std::to_string(lod), indices.count});
  }
  return result;
}

Histogram bars_of(const char* name, const char* unit, const std::map<size_t, uint64_t>& counted) {
  Histogram result{name, unit, {}};
  for (const auto& [key, value] : counted) result.bars.push_back({std::to_string(key), value});
  return result;
}

/// The smallest power of two that is not less.
size_t rounded_up(size_t value) {
  size_t power = value == 0 ? 0 : 1;
  while (power < value) power *= 2;
  return power;
}

void add_behavior(const AcceptedRig& rig, Content& content) {
  const model::PlainRig& base = rig.model.base;
  std::map<size_t, uint64_t> inputs_of_psd, columns, entries;
  std::map<uint16_t, size_t> inputs;
  for (const model::PlainPsd& triple : base.psds) ++inputs[triple.row];
  for (const auto& [row, count] : inputs) ++inputs_of_psd[count];
  for (const model::PlainGroup& group : base.groups) {
    ++columns[rounded_up(group.inputs.size())];
    for (const float value : group.values) ++entries[value == 0 ? 0 : 1];
  }
  content.histograms.push_back(per_lod(rig, "joints_per_lod", "joints", MIEN_KIND_JOINT));
  content.histograms.push_back(
      per_lod(rig, "channels_per_lod", "blend shape channels", MIEN_KIND_BLEND_SHAPE_CHANNEL));
  content.histograms.push_back(bars_of("inputs_per_corrective", "correctives", inputs_of_psd));
  content.histograms.push_back(bars_of("columns_per_joint_group_up_to", "joint groups", columns));
  content.histograms.push_back(
      {"joint_matrix_entries", "entries", {{"zero", entries[0]}, {"not zero", entries[1]}}});
  std::map<size_t, uint64_t> poses;
  for (const model::PlainRbfSolver& solver : rig.model.solvers) ++poses[solver.poses.size()];
  if (!poses.empty()) {
    content.histograms.push_back(bars_of("poses_per_rbf_solver", "RBF solvers", poses));
  }
}

void add_geometry(const AcceptedRig& rig, Content& content) {
  if (!has_geometry(rig.file)) return;
  auto error = sized<MienError>();
  MienDeformer* made = nullptr;
  check(mien_deformer_create(rig.file.dna.get(), rig.rig.get(), nullptr, &made, &error), &error,
        kCannotRead, rig.file.shown);
  const Deformer deformer(made);
  std::map<size_t, uint64_t> influences;
  Histogram vertices{"vertices_per_lod", "vertices", {}};
  for (uint32_t lod = 0; lod < rig.lod_count(); ++lod) {
    vertices.bars.push_back({"LOD " + std::to_string(lod), 0});
  }
  uint64_t positions = 0, triangles = 0, targets = 0, deltas = 0;
  for (uint32_t m = 0; m < rig_count(rig.rig.get(), MIEN_KIND_MESH); ++m) {
    auto mesh = sized<MienMesh>();
    check(mien_deformer_mesh(made, m, &mesh), nullptr, kCannotRead, "");
    positions += mesh.position_count;
    triangles += mesh.triangle_count;
    targets += mesh.target_count;
    deltas += mesh.delta_count;
    for (uint32_t lod = 0; lod < rig.lod_count(); ++lod) {
      if (mesh.lods >> lod & 1) vertices.bars[lod].value += mesh.vertex_count;
    }
    for (uint32_t p = 0; p < mesh.position_count; ++p) {
      MienIndex16View joints{};
      MienFloatView weights{};
      check(mien_deformer_influences(made, m, p, &joints, &weights), nullptr, kCannotRead, "");
      ++influences[joints.count];
    }
  }
  content.counts.push_back({"positions", positions});
  content.counts.push_back({"triangles", triangles});
  content.counts.push_back({"blend_shape_targets", targets});
  content.counts.push_back({"blend_shape_deltas", deltas});
  content.histograms.push_back(vertices);
  content.histograms.push_back(bars_of("influences_per_position", "positions", influences));
}

void add_timings(const AcceptedRig& rig, Content& content) {
  using Clock = std::chrono::steady_clock;
  for (const uint32_t isa : present_isas()) {
    const Rig made = create_rig(rig, isa, MIEN_ROTATION_OUTPUT_EULER);
    MienInstance* instance = nullptr;
    auto error = sized<MienError>();
    check(mien_instance_create(made.get(), nullptr, &instance, &error), &error, kCannotRead, "");
    const Instance owner(instance);
    MienMutableFloatView raw{};
    check(mien_instance_raw_controls(instance, &raw), nullptr, kCannotRead, "");
    for (uint32_t lod = 0; lod < rig.lod_count(); ++lod) {
      std::vector<double> samples;
      for (int sample = 0; sample < kSamples; ++sample) {
        const std::vector<float>& pose =
            rig.poses[1 + static_cast<size_t>(sample) % (rig.poses.size() - 1)];
        std::copy(pose.begin(), pose.end(), raw.data);
        const auto start = Clock::now();
        check(mien_rig_evaluate(made.get(), instance, lod), nullptr, kCannotRead, "");
        samples.push_back(std::chrono::duration<double, std::micro>(Clock::now() - start).count());
      }
      std::nth_element(samples.begin(), samples.begin() + kSamples / 2, samples.end());
      content.timings.push_back({mien_isa_name(isa), lod, samples[kSamples / 2]});
    }
  }
}

}  // namespace

Content content_of(const AcceptedRig& rig) {
  Content content;
  content.version = "2." + std::to_string(rig.file.info.version);
  content.bytes = rig.file.info.file_bytes;
  add_counts(rig, content);
  add_behavior(rig, content);
  add_geometry(rig, content);
  add_timings(rig, content);
  return content;
}

}  // namespace mien::cli
