// SPDX-License-Identifier: MIT
// A rig of the layers that drive controls and rotations, as plain vectors. rbf_model, ml_model and
// rotation_model evaluate it in double precision and as literally as the formulas of
// docs/rig-evaluation.md read.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "integrations/program/model/plain_rig.h"

namespace mien::model {

struct PlainRbfSolver {
  std::vector<uint16_t> inputs, poses;
  std::vector<float> targets;  // [pose][input]
  float radius = 60, threshold = 0.001f;
  // Numbers of the format: interpolative 1; 0 is on; Euclidean, quaternion, swing, twist; always 1;
  // Gaussian, exponential, linear, cubic, quintic; x y z.
  uint16_t type = 0, automatic_radius = 1, distance = 0, normalize = 0, function = 0, axis = 0;
};

struct PlainRbfPose {
  float scale = 1;
  std::vector<uint16_t> inputs, outputs;
  std::vector<float> weights;
};

/// A twist or a swing.
struct PlainTurn {
  uint16_t axis;
  std::vector<uint16_t> inputs;  // x y z w
  std::vector<uint16_t> joints;
  std::vector<float> blends;
};

struct PlainNetworkLayer {
  std::vector<float> biases, weights;  // [output][input]
  uint16_t function = 0;
  std::vector<float> parameters;
};

struct PlainNetwork {
  std::vector<uint16_t> inputs, outputs;
  std::vector<PlainNetworkLayer> layers;
};

/// Numbers of the format.
enum class OperationType : uint16_t { kUnspecified, kGather, kScatter, kMlp, kWeightedSum };

struct PlainOperation {
  OperationType type;
  std::vector<uint32_t> parameters;
  std::vector<std::pair<uint16_t, uint16_t>> dependencies;  // set, operation
};
using PlainOperationSet = std::vector<PlainOperation>;

using LodIndices = std::vector<std::vector<uint16_t>>;  // [lod]

struct LayerRig {
  PlainRig base;  // its counts, groups, channels, maps
  uint16_t ml_count = 0, rbf_count = 0;
  uint16_t absent_count = 0;  // controls that are read, but have no name: always 0
  uint16_t rotation_unit = 0, sequence = 0;
  std::array<int, 3> signs = {1, 1, 1};
  std::array<uint16_t, 3> axes = {1, 2, 4};  // right, up, front
  std::vector<uint16_t> rotations;           // [joint] 1: represented by a quaternion
  LodIndices lod_joints;                     // empty: all at every LOD
  std::vector<uint16_t> raw_w;               // raw controls whose name ends in .w
  std::vector<uint16_t> ml_w;                // the same, counted from the first ML control

  std::vector<PlainRbfSolver> solvers;
  std::vector<PlainRbfPose> poses;
  LodIndices lod_solvers;  // empty: all at every LOD

  std::vector<PlainTurn> twists, swings;

  std::vector<PlainNetwork> networks;
  LodIndices lod_networks;                                   // empty: all at every LOD
  std::vector<std::vector<uint16_t>> regions;                // of one mesh: networks
  std::vector<PlainOperationSet> operations;                 // of one type
  std::vector<LodIndices> lod_operations;                    // [set]; empty: all at every LOD
  std::vector<std::pair<uint16_t, uint16_t>> ml_parameters;  // key, value
  std::vector<std::pair<uint16_t, uint16_t>> ml_joints;      // control, attribute

  uint16_t first_ml() const { return static_cast<uint16_t>(base.raw_count + base.psd_count); }
  uint16_t first_rbf() const { return static_cast<uint16_t>(first_ml() + ml_count); }
  uint32_t control_count() const { return first_rbf() + rbf_count + absent_count; }
  bool has(const LodIndices& list, uint32_t lod, uint32_t index) const;
};

/// The controls of a new instance (docs/rig-evaluation.md, 1.2 "Initial values").
template <class T = double>
std::vector<T> initial_controls(const LayerRig& rig);

}  // namespace mien::model
