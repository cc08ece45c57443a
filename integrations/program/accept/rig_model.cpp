// SPDX-License-Identifier: MIT
#include "integrations/program/accept/rig_model.h"

#include <algorithm>

#include "integrations/program/io/dna_fields.h"

namespace mien::cli {

namespace {

using model::LayerRig;

std::vector<uint16_t> shorts(const RigFile& file, const std::string& path) {
  const std::vector<int64_t> values = read_integers(file, path);
  return std::vector<uint16_t>(values.begin(), values.end());
}

uint16_t short_at(const RigFile& file, const std::string& path) {
  return static_cast<uint16_t>(read_integer(file, path));
}

/// Rows of each LOD; LODs that the file leaves out have none.
std::vector<uint16_t> row_counts(const RigFile& file, const std::string& path, uint32_t lods) {
  std::vector<uint16_t> counts = shorts(file, path);
  counts.resize(lods);
  return counts;
}

model::PlainTable read_table(const RigFile& file, const std::string& path) {
  const std::vector<uint16_t> inputs = shorts(file, path + ".inputIndices"),
                              outputs = shorts(file, path + ".outputIndices");
  const std::vector<float> from = read_floats(file, path + ".fromValues"),
                           to = read_floats(file, path + ".toValues"),
                           slope = read_floats(file, path + ".slopeValues"),
                           cut = read_floats(file, path + ".cutValues");
  model::PlainTable table;
  for (size_t i = 0; i < inputs.size(); ++i) {
    table.push_back({inputs[i], outputs[i], from[i], to[i], slope[i], cut[i]});
  }
  return table;
}

/// Elements of each LOD.
model::LodIndices read_lods(const RigFile& file, const std::string& path, uint32_t lods) {
  const std::vector<uint16_t> rows = shorts(file, path + ".lods");
  model::LodIndices result(lods);
  for (size_t lod = 0; lod < std::min<size_t>(lods, rows.size()); ++lod) {
    result[lod] = shorts(file, element(path + ".indices", rows[lod]));
  }
  return result;
}

bool ends_with_w(const std::string& name) {
  const auto ends = [&](const std::string& end) {
    return name.size() >= end.size() &&
           name.compare(name.size() - end.size(), end.size(), end) == 0;
  };
  return ends(".w") || ends(".qw");
}

std::vector<uint16_t> with_w(const MienRig* rig, uint32_t kind) {
  std::vector<uint16_t> found;
  for (uint32_t i = 0; i < rig_count(rig, kind); ++i) {
    if (ends_with_w(rig_name(rig, kind, i))) found.push_back(static_cast<uint16_t>(i));
  }
  return found;
}

void read_base(const RigFile& file, const MienRig* rig, model::PlainRig& base) {
  const auto count = [&](uint32_t kind) { return static_cast<uint16_t>(rig_count(rig, kind)); };
  base.lod_count = static_cast<uint16_t>(file.info.lod_count);
  base.gui_count = count(MIEN_KIND_GUI_CONTROL);
  base.raw_count = count(MIEN_KIND_RAW_CONTROL);
  base.psd_count = count(MIEN_KIND_PSD_CONTROL);
  base.joint_count = count(MIEN_KIND_JOINT);
  base.channel_count = count(MIEN_KIND_BLEND_SHAPE_CHANNEL);
  base.map_count = count(MIEN_KIND_ANIMATED_MAP);
  base.gui_to_raw = read_table(file, "bhvr.controls.conditionals");
  const std::vector<uint16_t> rows = shorts(file, "bhvr.controls.psds.rows"),
                              columns = shorts(file, "bhvr.controls.psds.columns");
  const std::vector<float> values = read_floats(file, "bhvr.controls.psds.values");
  for (size_t i = 0; i < rows.size(); ++i) base.psds.push_back({rows[i], columns[i], values[i]});
  for (uint64_t g = 0; g < field_count(file, "bhvr.joints.jointGroups"); ++g) {
    const std::string group = element("bhvr.joints.jointGroups", g);
    base.groups.push_back(
        {row_counts(file, group + ".lods", base.lod_count), shorts(file, group + ".inputIndices"),
         shorts(file, group + ".outputIndices"), read_floats(file, group + ".values")});
  }
  const std::string channels = "bhvr.blendShapeChannels", maps = "bhvr.animatedMaps";
  base.channel_lods = row_counts(file, channels + ".lods", base.lod_count);
  base.channel_inputs = shorts(file, channels + ".inputIndices");
  base.channel_outputs = shorts(file, channels + ".outputIndices");
  base.map_lods = row_counts(file, maps + ".lods", base.lod_count);
  base.maps = read_table(file, maps + ".conditionals");
}

void read_rbf(const RigFile& file, LayerRig& rig) {
  for (uint64_t s = 0; s < field_count(file, "rbfb.solvers"); ++s) {
    const std::string at = element("rbfb.solvers", s);
    model::PlainRbfSolver solver;
    solver.inputs = shorts(file, at + ".rawControlIndices");
    solver.poses = shorts(file, at + ".poseIndices");
    solver.targets = read_floats(file, at + ".rawControlValues");
    solver.radius = read_floats(file, at + ".radius")[0];
    solver.threshold = read_floats(file, at + ".weightThreshold")[0];
    solver.type = short_at(file, at + ".solverType");
    solver.automatic_radius = short_at(file, at + ".automaticRadius");
    solver.distance = short_at(file, at + ".distanceMethod");
    solver.normalize = short_at(file, at + ".normalizeMethod");
    solver.function = short_at(file, at + ".functionType");
    solver.axis = short_at(file, at + ".twistAxis");
    rig.solvers.push_back(solver);
  }
  rig.lod_solvers = read_lods(file, "rbfb.lodSolverMapping", rig.base.lod_count);
  // Before 2.5 each pose drives a control of its own.
  const bool has_controls = field_count(file, "rbfe.poseControlNames") != 0;
  for (uint64_t p = 0; p < field_count(file, "rbfb.poses"); ++p) {
    model::PlainRbfPose pose;
    pose.scale = read_floats(file, element("rbfb.poses", p, ".scale"))[0];
    if (has_controls) {
      const std::string at = element("rbfe.poses", p);
      pose.inputs = shorts(file, at + ".inputControlIndices");
      pose.outputs = shorts(file, at + ".outputControlIndices");
      pose.weights = read_floats(file, at + ".outputControlWeights");
    } else {
      pose.outputs = {static_cast<uint16_t>(rig.first_rbf() + p)};
      pose.weights = {1};
    }
    rig.poses.push_back(pose);
  }
}

void read_turns(const RigFile& file, const std::string& kind,
                std::vector<model::PlainTurn>& turns) {
  const std::string list = "twsw." + kind + "s";
  for (uint64_t t = 0; t < field_count(file, list); ++t) {
    const std::string at = element(list, t) + ".";
    turns.push_back({short_at(file, at + "twistAxis"),
                     shorts(file, at + kind + "InputControlIndices"),
                     shorts(file, at + kind + "OutputJointIndices"),
                     read_floats(file, at + kind + "BlendWeights")});
  }
}

void read_networks(const RigFile& file, LayerRig& rig) {
  for (uint64_t n = 0; n < field_count(file, "mlbh.neuralNetworks"); ++n) {
    const std::string at = element("mlbh.neuralNetworks", n);
    model::PlainNetwork network = {
        shorts(file, at + ".inputIndices"), shorts(file, at + ".outputIndices"), {}};
    for (uint64_t l = 0; l < field_count(file, at + ".layers"); ++l) {
      const std::string layer = element(at + ".layers", l);
      network.layers.push_back(
          {read_floats(file, layer + ".biases"), read_floats(file, layer + ".weights"),
           short_at(file, layer + ".functionId"), read_floats(file, layer + ".parameters")});
    }
    rig.networks.push_back(network);
  }
  rig.lod_networks = read_lods(file, "mlbh.lodNeuralNetworkMapping", rig.base.lod_count);
  const std::string regions = "mlbh.neuralNetworkToMeshRegion.indices";
  for (uint64_t m = 0; m < field_count(file, regions); ++m) {
    for (uint64_t r = 0; r < field_count(file, element(regions, m)); ++r) {
      rig.regions.push_back(shorts(file, element(element(regions, m), r)));
    }
  }
}

/// Sets of all types, one behind the other.
void read_operations(const RigFile& file, LayerRig& rig) {
  for (uint64_t t = 0; t < field_count(file, "mlbe.mlbTypeData"); ++t) {
    const std::string type = element("mlbe.mlbTypeData", t);
    const auto first_set = static_cast<uint16_t>(rig.operations.size());
    for (uint64_t s = 0; s < field_count(file, type + ".operations"); ++s) {
      const std::string set = element(type + ".operations", s);
      model::PlainOperationSet operations;
      for (uint64_t o = 0; o < field_count(file, set); ++o) {
        const std::string at = element(set, o);
        model::PlainOperation operation{};
        operation.type = static_cast<model::OperationType>(short_at(file, at + ".operationType"));
        for (const int64_t value : read_integers(file, at + ".parameters")) {
          operation.parameters.push_back(static_cast<uint32_t>(value));
        }
        const std::vector<uint16_t> sets = shorts(file, at + ".mlOperationSetDependencyIndices"),
                                    others = shorts(file, at + ".mlOperationDependencyIndices");
        for (size_t d = 0; d < sets.size(); ++d) {
          operation.dependencies.emplace_back(static_cast<uint16_t>(first_set + sets[d]),
                                              others[d]);
        }
        operations.push_back(operation);
      }
      rig.operations.push_back(operations);
      rig.lod_operations.push_back(
          read_lods(file, element(type + ".lodMLOperationMappings", s), rig.base.lod_count));
    }
  }
  const auto pairs = [&](const std::string& first, const std::string& second) {
    const std::vector<uint16_t> a = shorts(file, "mlbe.mlbJoints." + first),
                                b = shorts(file, "mlbe.mlbJoints." + second);
    std::vector<std::pair<uint16_t, uint16_t>> result;
    for (size_t i = 0; i < a.size(); ++i) result.emplace_back(a[i], b[i]);
    return result;
  };
  rig.ml_parameters = pairs("parameterKeys", "parameterValues");
  rig.ml_joints = pairs("inputIndices", "outputIndices");
}

}  // namespace

LayerRig read_rig_model(const RigFile& file, const MienRig* made) {
  const MienRigInfo info = rig_info(made);
  LayerRig rig;
  read_base(file, made, rig.base);
  rig.ml_count = static_cast<uint16_t>(rig_count(made, MIEN_KIND_ML_CONTROL));
  rig.rbf_count = static_cast<uint16_t>(rig_count(made, MIEN_KIND_RBF_CONTROL));
  rig.absent_count = static_cast<uint16_t>(info.control_count - rig.control_count());
  rig.rotation_unit = static_cast<uint16_t>(info.rotation_unit);
  rig.sequence = static_cast<uint16_t>(info.rotation_sequence);
  for (size_t i = 0; i < 3; ++i) {
    rig.signs[i] = info.rotation_signs[i];
    rig.axes[i] = static_cast<uint16_t>(info.axes[i]);
  }
  rig.rotations.resize(rig.base.joint_count);
  const uint64_t represented = field_count(file, "jbmd.jointRepresentations");
  for (uint64_t j = 0; j < std::min<uint64_t>(represented, rig.rotations.size()); ++j) {
    rig.rotations[j] = short_at(file, element("jbmd.jointRepresentations", j, ".rotation"));
  }
  rig.lod_joints = read_lods(file, "defn.lodJointMapping", rig.base.lod_count);
  rig.raw_w = with_w(made, MIEN_KIND_RAW_CONTROL);
  rig.ml_w = with_w(made, MIEN_KIND_ML_CONTROL);
  read_rbf(file, rig);
  read_turns(file, "twist", rig.twists);
  read_turns(file, "swing", rig.swings);
  read_networks(file, rig);
  read_operations(file, rig);
  return rig;
}

std::vector<uint16_t> quaternion_inputs(const LayerRig& rig) {
  std::vector<uint16_t> first;
  const auto add = [&](const std::vector<uint16_t>& inputs) {
    for (size_t i = 0; i + 4 <= inputs.size(); i += 4) {
      const uint16_t x = inputs[i];
      const bool consecutive = inputs[i + 1] == x + 1 && inputs[i + 2] == x + 2 &&
                               inputs[i + 3] == x + 3 && x + 3 < rig.base.raw_count;
      if (consecutive && std::count(first.begin(), first.end(), x) == 0) first.push_back(x);
    }
  };
  for (const model::PlainTurn& turn : rig.twists) add(turn.inputs);
  for (const model::PlainTurn& turn : rig.swings) add(turn.inputs);
  for (const model::PlainRbfSolver& solver : rig.solvers) {
    if (solver.distance != 0) add(solver.inputs);
  }
  return first;
}

}  // namespace mien::cli
