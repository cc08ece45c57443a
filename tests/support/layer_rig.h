// SPDX-License-Identifier: MIT
// A rig of the layers that drive controls and rotations, as plain vectors: written as a DNA file
// for the library, and evaluated a second time by rbf_model, ml_model and rotation_model, in double
// precision and as literally as the formulas of docs/rig-evaluation.md read.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "tests/support/plain_rig.h"

namespace mien {

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

struct PlainOperation {
  dna::MlOperationType type;
  std::vector<uint32_t> parameters;
  std::vector<std::pair<uint16_t, uint16_t>> dependencies;  // set, operation
};
using PlainOperationSet = std::vector<PlainOperation>;

using LodIndices = std::vector<std::vector<uint16_t>>;  // [lod]

struct LayerRig {
  PlainRig base;  // its counts, groups, channels, maps
  uint16_t ml_count = 0, rbf_count = 0;
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
  std::vector<PlainOperationSet> operations;                 // of one type; all at every LOD
  std::vector<std::pair<uint16_t, uint16_t>> ml_parameters;  // key, value
  std::vector<std::pair<uint16_t, uint16_t>> ml_joints;      // control, attribute

  uint16_t first_ml() const { return static_cast<uint16_t>(base.raw_count + base.psd_count); }
  uint16_t first_rbf() const { return static_cast<uint16_t>(first_ml() + ml_count); }
  uint32_t control_count() const { return first_rbf() + rbf_count; }
  bool has(const LodIndices& list, uint32_t lod, uint32_t index) const;
};

/// Lists and arrays lie in `arena`.
dna::DnaView to_view(const LayerRig& rig, Arena& arena);

/// Opened with all checks. The handle of the file keeps nothing of the rig.
struct LayerFile {
  explicit LayerFile(const LayerRig& rig);
  std::vector<uint8_t> bytes;
  DnaHandle dna;
};

/// The controls of a new instance (docs/rig-evaluation.md, 1.2 "Initial values").
std::vector<double> initial_controls(const LayerRig& rig);

/// A row of random raw controls, with every quaternion of `quaternions` (first control) of
/// length 1.
std::vector<float> random_raw(const LayerRig& rig, const std::vector<uint16_t>& quaternions,
                              Random& random);

}  // namespace mien
