// SPDX-License-Identifier: MIT
#include "integrations/program/commands/solve_target.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>

#include "integrations/program/commands/baked_rig.h"
#include "integrations/program/commands/moving_mesh.h"
#include "integrations/program/commands/solve_joints.h"
#include "integrations/program/commands/solve_landmarks.h"
#include "integrations/program/commands/solve_mask.h"
#include "integrations/program/commands/solve_meshes.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/npy_reader.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

std::string shape_text(const std::vector<uint64_t>& shape) {
  std::string text;
  for (const uint64_t n : shape) text += (text.empty() ? "" : " x ") + std::to_string(n);
  return text.empty() ? "one number" : text;
}

/// Frames of `rows` rows of `columns` numbers; an array of two dimensions is one frame.
SolveTarget read_array(const TargetOptions& options, size_t rows, size_t columns,
                       const std::string& wanted) {
  const std::string shown = shown_name(options.path);
  auto array = std::make_shared<NpyArray>(
      read_npy_or_npz(read_any_bytes(options.path, "cannot read target"), shown, true));
  std::vector<uint64_t> shape = array->shape;
  if (shape.size() == 2) shape.insert(shape.begin(), 1);
  if (shape.size() != 3 || shape[1] != rows || shape[2] != columns) {
    fail(kInvalid, "cannot solve", shown,
         "its shape is " + shape_text(array->shape) + ", the rig needs frames x " +
             std::to_string(rows) + " x " + std::to_string(columns),
         "give " + wanted);
  }
  if (shape[0] == 0) {
    fail(kInvalid, "cannot solve", shown, "it has no frames", "give one at least");
  }
  SolveTarget target;
  target.frame_count = shape[0];
  target.width = rows * columns;
  target.read = [array, width = target.width](size_t frame, float* row) {
    std::copy_n(array->numbers.data() + frame * width, width, row);
  };
  return target;
}

SolveTarget read_joints(const TargetOptions& options, const SolvedRig& rig,
                        const Session& session) {
  if (ends_with(options.path, ".glb")) return read_glb_joints(options, rig, session);
  if (!is_array_file(options.path)) {
    fail_usage("--kind joints", "joints are read from NPY and NPZ files and from GLB",
               "give frames x joints x 9 numbers as `mien eval` writes joints, as .npy, or an "
               "animated .glb");
  }
  return read_array(options, rig_count(rig.rig, MIEN_KIND_JOINT), joint_width(rig),
                    "the joint values that `mien eval` writes, for all joints in their order");
}

}  // namespace

float parse_weight(const char* option, const std::string& word) {
  if (word.empty()) return 0;
  float weight = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, weight);
  if (error == std::errc() && stop == end && weight >= 0 && std::isfinite(weight)) return weight;
  fail_usage(std::string(option) + " \"" + word + "\"", "not a number from 0 on",
             "give a number such as 0.01");
}

SolvedRig open_solved_rig(const std::string& path, bool geometry, const Session& session) {
  SolvedRig out;
  if (is_baked_file(path)) {
    out.baked = open_baked_rig(path, LoadOptions{}, RigOptions{});
    out.shown = out.baked->shown;
    out.rig = out.baked->rig.get();
    out.deformer = out.baked->deformer.get();
    if (geometry && !out.deformer) {
      fail(kInvalid, "cannot solve", out.shown, "the baked file has no geometry",
           "bake it with its geometry, or give the DNA file");
    }
    return out;
  }
  const uint32_t layers = kEvaluationLayers | (geometry ? uint32_t{MIEN_LAYER_GEOMETRY} : 0);
  out.file = open_rig_file(path, parse_load_options(LoadOptions{}, layers), session);
  out.shown = out.file->shown;
  out.own_rig = create_rig(*out.file, parse_rig_options(RigOptions{}));
  out.rig = out.own_rig.get();
  if (!geometry) return out;
  if (!has_geometry(*out.file)) {
    fail(kInvalid, "cannot solve", out.shown, "the rig has no geometry", "give a file with meshes");
  }
  auto error = sized<MienError>();
  MienDeformer* deformer = nullptr;
  check(mien_deformer_create(out.file->dna.get(), out.rig, nullptr, &deformer, &error), &error,
        "cannot compile geometry", out.shown);
  out.own_deformer.reset(deformer);
  out.deformer = deformer;
  return out;
}

MienMesh mesh_of(const SolvedRig& rig, uint32_t mesh) {
  auto found = sized<MienMesh>();
  check(mien_deformer_mesh(rig.deformer, mesh, &found), nullptr, "cannot read mesh", rig.shown);
  return found;
}

uint32_t joint_width(const SolvedRig& rig) {
  const uint32_t joints = rig_count(rig.rig, MIEN_KIND_JOINT);
  return joints != 0 ? rig_info(rig.rig).joint_value_count / joints : 0;
}

uint32_t find_mesh(const SolvedRig& rig, const std::string& name) {
  const uint32_t count = rig_count(rig.rig, MIEN_KIND_MESH);
  NearestName nearest(name);
  for (uint32_t m = 0; m < count; ++m) {
    const std::string own = rig_name(rig.rig, MIEN_KIND_MESH, m);
    nearest.offer(own);
    const MienMesh mesh = mesh_of(rig, m);
    if (name.empty() ? (mesh.lods & 1) != 0 && mesh.position_count != 0 : own == name) return m;
  }
  if (name.empty()) {
    fail(kInvalid, "cannot solve", rig.shown, "LOD 0 has no mesh", "name one with --mesh");
  }
  fail(kInvalid, "cannot solve", rig.shown, "no mesh is named \"" + one_line(name) + "\"",
       nearest.question("'mien info RIG --names meshes' lists the names"));
}

bool is_array_file(const std::string& path) {
  return ends_with(path, ".npy") || ends_with(path, ".npz");
}

uint32_t main_mesh(const SolveTarget& target) {
  std::map<uint32_t, size_t> counts;
  for (const MienSolvePoint& point : target.points) ++counts[point.mesh];
  return std::max_element(counts.begin(), counts.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

const char* kind_word(TargetKind kind) {
  switch (kind) {
    case TargetKind::kVertices: return "vertices";
    case TargetKind::kJoints: return "joints";
    case TargetKind::kLandmarks3: return "landmarks3";
    case TargetKind::kLandmarks2: return "landmarks2";
    case TargetKind::kWeights: return "weights";
    default: return "surface";
  }
}

void split_kind(TargetOptions& options) {
  const std::string all = options.path;
  for (const TargetKind kind :
       {TargetKind::kVertices, TargetKind::kJoints, TargetKind::kLandmarks3,
        TargetKind::kLandmarks2, TargetKind::kWeights, TargetKind::kSurface}) {
    const std::string prefix = std::string(kind_word(kind)) + ":";
    if (all.compare(0, prefix.size(), prefix) != 0) continue;
    if (!options.kind.empty() && options.kind != kind_word(kind)) {
      fail_usage("TARGET " + one_line(all), "--kind says " + options.kind, "leave one of them out");
    }
    options.kind = kind_word(kind);
    options.path = all.substr(prefix.size());
    return;
  }
}

TargetKind find_kind(const TargetOptions& options) {
  if (!options.kind.empty()) {
    return static_cast<TargetKind>(parse_word("solve --kind", options.kind));
  }
  if (!options.from.empty()) return TargetKind::kWeights;
  if (ends_with(options.path, ".csv")) {
    // The first line has a column NAME.z, or not.
    const std::string text = read_text(options.path, "cannot read target");
    const std::string header = text.substr(0, text.find('\n'));
    const bool deep = header.find(".z,") != std::string::npos || ends_with(header, ".z") ||
                      ends_with(header, ".z\r");
    return deep ? TargetKind::kLandmarks3 : TargetKind::kLandmarks2;
  }
  if (ends_with(options.path, ".json") || ends_with(options.path, ".clip")) {
    fail_usage("TARGET " + one_line(options.path), "these are controls of another rig",
               "name that rig: --from OTHER.dna");
  }
  return TargetKind::kVertices;
}

SolveTarget open_target(const TargetOptions& options, TargetKind kind, const SolvedRig& rig,
                        const Session& session) {
  SolveTarget target;
  if (kind == TargetKind::kJoints) {
    target = read_joints(options, rig, session);
  } else if (kind == TargetKind::kLandmarks3 || kind == TargetKind::kLandmarks2) {
    target = read_landmarks(options, kind == TargetKind::kLandmarks2, rig);
  } else {
    const uint32_t mesh = find_mesh(rig, options.mesh);
    const uint32_t count = mesh_of(rig, mesh).position_count;
    if (kind == TargetKind::kWeights) {
      target = read_weights(options, rig, mesh, session);
    } else if (is_array_file(options.path)) {
      target = read_array(options, count, 3,
                          "the positions of mesh " + rig_name(rig.rig, MIEN_KIND_MESH, mesh) +
                              ", in the order of the file");
    } else if (kind == TargetKind::kSurface) {
      target = read_surfaces(options, rig);
    } else {
      target = read_meshes(options, rig, mesh);
    }
    if (kind == TargetKind::kVertices && is_array_file(options.path) && !options.unit.empty()) {
      const double units = RigSpace(rig).units_of(options.unit);
      target.read = [read = target.read, units, width = target.width](size_t frame, float* row) {
        read(frame, row);
        for (size_t i = 0; i < width; ++i) row[i] = static_cast<float>(row[i] * units);
      };
    }
    for (uint32_t p = 0; p < count; ++p) target.points.push_back({mesh, {p, p, p}, {1, 0, 0}});
  }
  target.kind = kind;
  if (options.mask.empty()) return target;
  std::vector<float> weights = read_mask(options.mask, rig, target);
  for (size_t i = 0; i < target.weights.size(); ++i) weights[i] *= target.weights[i];
  target.weights = weights;
  return target;
}

}  // namespace mien::cli
