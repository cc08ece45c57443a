// SPDX-License-Identifier: MIT
#include "tests/support/random_layer_rig.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace mien {
namespace {

struct Builder {
  Random& random;
  bool wild;
  LayerRig rig = {};

  uint16_t below(uint32_t n) { return static_cast<uint16_t>(random.below(n)); }
  float number(double range) {
    if (wild && random.chance(0.3)) return wild_float(random);
    return static_cast<float>(random.between(-range, range));
  }
  std::vector<float> numbers(size_t count, double range) {
    std::vector<float> all(count);
    for (float& value : all) value = number(range);
    return all;
  }
  std::vector<uint16_t> any_of(size_t count, uint32_t n) {
    std::vector<uint16_t> all(count);
    for (uint16_t& index : all) index = below(n);
    return all;
  }
  std::vector<uint16_t> quaternion() {
    const auto first = static_cast<uint16_t>(4 + 4 * below(2));
    return {first, static_cast<uint16_t>(first + 1), static_cast<uint16_t>(first + 2),
            static_cast<uint16_t>(first + 3)};
  }

  void make_solvers() {
    for (int s = 0; s < 6; ++s) {
      PlainRbfSolver solver;
      solver.distance = below(4);
      solver.type = below(2);
      solver.function = below(5);
      solver.normalize = below(2);
      solver.automatic_radius = below(2);
      solver.axis = below(3);
      solver.radius = wild ? number(90) : 60;
      solver.threshold = wild && random.chance(0.2) ? number(1) : 0.001f;
      solver.inputs = solver.distance == 0 && random.chance(0.5) ? any_of(3, 4) : quaternion();
      const uint32_t poses = 1 + below(18);
      for (uint32_t p = 0; p < poses; ++p) {
        for (size_t i = 0; i < solver.inputs.size(); ++i) solver.targets.push_back(number(1));
        solver.poses.push_back(static_cast<uint16_t>(rig.poses.size()));
        PlainRbfPose pose = {wild ? number(2) : 1.0f, {}, {}, {}};
        pose.outputs = {static_cast<uint16_t>(rig.first_rbf() + rig.rbf_count++)};
        pose.weights = {number(2)};
        if (random.chance(0.1)) pose.inputs = any_of(1, 4);
        rig.poses.push_back(pose);
      }
      rig.solvers.push_back(solver);
    }
    if (random.chance(0.3)) rig.poses[0].outputs[0] = rig.poses.back().outputs[0];
  }

  void make_networks() {
    for (int n = 0; n < 3; ++n) {
      PlainNetwork network;
      network.inputs = any_of(3, rig.base.raw_count);
      uint32_t inputs = 3;
      for (int l = 0; l < 2; ++l) {
        const uint32_t width = l == 1 ? 7 : 1 + below(20);
        network.layers.push_back(
            {numbers(width, 1), numbers(size_t{width} * inputs, 1), below(5), {number(1)}});
        inputs = width;
      }
      for (uint16_t i = 0; i < 7; ++i) {
        network.outputs.push_back(static_cast<uint16_t>(rig.first_ml() + 7 * n + i));
      }
      rig.networks.push_back(network);
    }
    rig.regions = {{0}, {1, 2}};
    const bool quaternions = random.chance(0.5);
    const auto rotation = static_cast<uint16_t>(quaternions ? 4 : 3);
    rig.ml_parameters = {{uint16_t{0}, uint16_t{0}},
                         {uint16_t{1}, static_cast<uint16_t>(quaternions)},
                         {uint16_t{2}, uint16_t{0}}};
    if (random.chance(0.5)) {
      for (uint16_t key = 3; key < 6; ++key) {
        rig.ml_parameters.push_back({key, static_cast<uint16_t>(2 * (key - 3) + below(2))});
      }
      for (uint16_t key = 6; key < 9; ++key) rig.ml_parameters.push_back({key, below(2)});
      rig.ml_parameters.push_back({uint16_t{9}, below(6)});
    }
    for (uint16_t k = 0; k < rotation + 6; ++k) {
      rig.ml_joints.push_back({static_cast<uint16_t>(rig.first_ml() + k), k});
    }
    if (random.chance(0.5)) return;
    // The same with operations: two networks, their weighted sum into the third.
    uint32_t bits[2];
    for (uint32_t& b : bits) {
      const float weight = number(1);
      memcpy(&b, &weight, sizeof(b));
    }
    PlainNetwork& last = rig.networks[2];
    last.layers[0].weights = numbers(last.layers[0].biases.size() * 7, 1);
    std::vector<uint32_t> outputs, more;
    for (uint32_t i = 0; i < 7; ++i) {
      outputs.push_back(rig.first_ml() + i);
      more.push_back(rig.first_ml() + 7 + i);
    }
    rig.operations = {
        {{OperationType::kGather, {0, 1, 2}, {}}},
        {{OperationType::kMlp, {0}, {{0, 0}}}, {OperationType::kMlp, {1}, {{0, 0}}}},
        {{OperationType::kWeightedSum, {7, bits[0], bits[1]}, {{1, 0}, {1, 1}}}},
        {{OperationType::kMlp, {2}, {{2, 0}}}},
        {{OperationType::kScatter, outputs, {{3, 0}}}, {OperationType::kScatter, more, {{1, 0}}}}};
  }

  void make_joints() {
    for (int g = 0; g < 3; ++g) {
      PlainGroup group;
      group.inputs = any_of(1 + below(20), rig.control_count());
      const uint32_t rows = 1 + below(30);
      for (uint32_t r = 0; r < rows; ++r) {
        group.outputs.push_back(below(9u * rig.base.joint_count));
        const std::vector<float> row = numbers(group.inputs.size(), 20);
        group.values.insert(group.values.end(), row.begin(), row.end());
      }
      group.lods = {static_cast<uint16_t>(rows), below(rows + 1)};
      rig.base.groups.push_back(group);
    }
    for (int i = 0; i < 3; ++i) {
      std::vector<PlainTurn>& turns = i == 2 ? rig.twists : rig.swings;
      const std::vector<uint16_t> joints = any_of(2, rig.base.joint_count);
      turns.push_back({below(3), quaternion(), joints, numbers(2, 1.5)});
    }
    rig.twists.push_back({below(3), rig.swings[0].inputs, {0}, {number(1)}});
  }

  void make_tables() {
    PlainRig& base = rig.base;
    for (int r = 0; r < 12; ++r) {
      const float a = number(1), b = number(1);
      base.gui_to_raw.push_back({below(base.gui_count), below(4), a, b, number(2), number(1)});
      base.maps.push_back(
          {below(rig.control_count()), below(base.map_count), a, b, number(2), number(1)});
    }
    base.map_lods = {12, 5};
    for (uint16_t c = 0; c < base.channel_count; ++c) {
      base.channel_inputs.push_back(below(rig.control_count()));
      base.channel_outputs.push_back(c);
    }
    base.channel_lods = {base.channel_count, 1};
    // Correctives read raw, learned and pose controls.
    for (uint16_t p = 0; p < base.psd_count; ++p) {
      for (int k = 0; k < 3; ++k) {
        const uint16_t column = below(rig.control_count());
        const bool corrective = column >= base.raw_count && column < rig.first_ml();
        base.psds.push_back({static_cast<uint16_t>(base.raw_count + p),
                             corrective ? uint16_t{0} : column, number(2)});
      }
    }
  }

  /// About half of a list becomes any controls.
  void tangle(std::vector<uint16_t>& controls) {
    for (uint16_t& control : controls) {
      if (random.chance(0.5)) control = below(rig.control_count());
    }
  }
  LodIndices some_at_each_lod(size_t count) {
    LodIndices lists(rig.base.lod_count);
    for (std::vector<uint16_t>& list : lists) {
      for (size_t i = 0; i < count; ++i) {
        if (random.chance(0.7)) list.push_back(static_cast<uint16_t>(i));
      }
    }
    return lists;
  }
  void tangle_all() {
    for (PlainNetwork& network : rig.networks) {
      tangle(network.inputs);
      tangle(network.outputs);
    }
    for (PlainOperationSet& set : rig.operations) {
      for (PlainOperation& operation : set) {
        const bool controls =
            operation.type == OperationType::kGather || operation.type == OperationType::kScatter;
        for (uint32_t& parameter : operation.parameters) {
          if (controls && random.chance(0.5)) parameter = below(rig.control_count());
        }
      }
    }
    for (PlainRbfSolver& solver : rig.solvers) tangle(solver.inputs);
    for (PlainRbfPose& pose : rig.poses) {
      if (random.chance(0.3)) pose.inputs = any_of(2, rig.control_count());
      tangle(pose.outputs);
    }
    for (auto& [control, attribute] : rig.ml_joints) {
      if (random.chance(0.2)) control = below(rig.control_count() - 4);
    }
    rig.lod_solvers = some_at_each_lod(rig.solvers.size());
    if (rig.operations.empty()) rig.lod_networks = some_at_each_lod(rig.networks.size());
  }
};

}  // namespace

float wild_float(Random& random) {
  constexpr float kMax = std::numeric_limits<float>::max();
  const float often[] = {0, -0.0f, 1, -1, kMax, -kMax, 1e-45f, -1e-45f, 1.17549435e-38f, 1e19f};
  if (random.chance(0.3)) return often[random.below(10)];
  const double size = std::ldexp(random.between(1, 2), static_cast<int>(random.below(276)) - 149);
  const double bounded = std::fmin(size, kMax);
  return static_cast<float>(random.chance(0.5) ? bounded : -bounded);
}

LayerRig random_layer_rig(Random& random, bool wild, bool tangled) {
  Builder make = {random, wild};
  LayerRig& rig = make.rig;
  rig.base.lod_count = 2;
  rig.base.gui_count = 3;
  rig.base.raw_count = 12;
  rig.base.psd_count = 4;
  rig.base.joint_count = 6;
  rig.base.channel_count = 5;
  rig.base.map_count = 3;
  rig.ml_count = 21;
  rig.rotation_unit = make.below(2);
  rig.sequence = make.below(6);
  for (int& sign : rig.signs) sign = random.chance(0.5) ? 1 : -1;
  for (int j = 0; j < 6; ++j) rig.rotations.push_back(make.below(2));
  rig.raw_w = {7, 11};
  make.make_solvers();
  make.make_networks();
  make.make_joints();
  make.make_tables();
  if (tangled) make.tangle_all();
  return rig;
}

}  // namespace mien
