// SPDX-License-Identifier: MIT
// Derivatives of a rig at the values of an instance: products of directions with the matrix of derivatives,
// forward, and of gradients with its transpose, in reverse (docs/derivatives.md).
//
//     GUI -> raw -> controls -> joint values -> local -> model -> skin matrices -> positions
//                      |-> channels ------------------------------------------------^
//                      |-> maps
//
// linearize() computes the derivatives of each stage that depend on the values: a few numbers for each input
// of a corrective, small matrices for rotations. The products then only multiply and add. They take one
// direction at a time, or kBatchLanes, a lane each, with the same bits.
//
//     | Derivatives | coefficients of the stages | transposed networks | buffers: [value][lane] |
#pragma once

#include "runtime/base/object.h"
#include "runtime/deform/deformer.h"
#include "runtime/eval/instance.h"
#include "runtime/pose/joint_pose.h"
#include "simd/joint_kernels.h"

namespace mien {

/// Numbers of MIEN_POINT_... in mien/derivatives.h.
enum class Point : uint32_t {
  kGui,
  kRaw,
  kControls,
  kJoints,
  kLocals,
  kModels,
  kSkins,
  kPositions,
  kChannels,
  kMaps,
};

constexpr uint32_t kMatrixParts = 12;  // three axes and the translation; the last row is constant

constexpr uint32_t kNoRow = ~uint32_t{0};
constexpr uint32_t kNoValue = ~uint32_t{0};

/// The derivative of one value of a conditional table by one input, at its current value.
struct TableSlope {
  uint16_t input, output;
  float slope;
};

struct Derivatives : Object {
  static constexpr uint32_t kTag = 0x6D44'4956;

  const Rig* rig = nullptr;
  const Deformer* deformer = nullptr;  // or null
  ~Derivatives() {
    release(deformer);
    release(rig);
  }

  uint32_t lod = 0;
  uint32_t stages = 0;  // that are differentiated; results of the others are constants
  bool linearized = false;

  // Values of the instance, at which the derivatives are taken.
  Span<float> values;    // [control]
  Span<float> channels;  // [channel]
  JointPose pose;        // with a deformer

  // Coefficients.
  Span<TableSlope> gui_slopes, map_slopes;  // the first ..._count
  uint32_t gui_slope_count = 0, map_slope_count = 0;
  Span<float> psd_slopes;           // [corrective input]
  Span<float> ml_masks;             // [ML step]
  Span<uint64_t> first_slope;       // [ML step] into slopes
  Span<float> slopes;               // of network activations, layer by layer, padded
  Span<uint64_t> first_transposed;  // [layer] into transposed
  Span<float> transposed;           // weights of networks, as dense_layer has them
  Span<float>
      forward_weights;  // of networks in half storage: as floats, in the order of MlTable::halves
  Span<float> zero_biases;
  Span<float> ml_triples;       // [ML joint][6]: factors of converted translations and scales
  Span<float> ml_turns;         // [ML joint][4][4]: of converted rotations
  Span<float> ml_joint_slopes;  // [ML joint][2][4][4]: by its controls, by the rotation before
  Span<float> rbf_slopes;       // by solver: [pose][input control]
  Span<uint32_t> rbf_first;     // [solver] into rbf_slopes
  Span<double> rbf_scratch;     // of the largest solver
  Span<float> rbf_factors;      // [pose lane] results of the poses
  Span<float> turn_slopes;      // [step][lane][4]
  Span<double> turn_prefixes;   // scratch: [step][4]
  Span<float> angle_slopes;     // [joint][4][3]
  Span<float> twist_slopes;     // [lane][4][4]: by x y z w
  Span<float> local_slopes;  // [joint][9][4] axes by rotation, unscaled axes [9], with a deformer

  // The joint matrix.
  Span<uint32_t> value_rows;         // [joint value, angle] packed row that writes it at the LOD
  Span<uint32_t> row_values;         // [packed row] the value that it writes, or kNoValue
  Span<uint32_t> columns_by_length;  // neighbors have about as many blocks at the LOD
  Span<uint8_t> moved_columns;       // [column] some direction moves it
  Span<uint32_t> block_starts;       // [block row] into blocks, one more at the end
  Span<uint32_t> block_ends;         // [block row] into blocks
  Span<InputBlock> blocks;           // of moved_columns, by block row; kBatchAhead more at the end
  bool blocks_listed = false;

  Span<uint8_t> moving;     // [control] it may move with raw controls
  uint32_t lane_count = 0;  // directions in the buffers
  bool all_move = false;    // controls are the inputs: all columns count

  // Buffers, kBatchLanes of each.
  Span<float> rbf_lanes;                             // results of the largest solver
  Span<float> gui, controls, joints, maps, weights;  // weights: of channels
  Span<float> ml_values, ml_layers[2];
  Span<float>
      packed_rows;  // of the joint matrix: of one direction, or of kTransposedLanes gradients
  Span<float> locals, models, skins;  // [joint][kMatrixParts]
  Span<float> matrices;               // [joint][16] of one direction
  Span<float> linear_matrices;        // [joint][16] skin matrices without translation
  Span<float> shaped, shaped_change;  // positions of a block
  Span<float> skinned_change, moved;  // of a mesh
};

/// Bytes of the derivatives of a rig.
size_t derivatives_size(const Rig& rig, const Deformer* deformer);
/// Null if memory ran out. It becomes an owner of the rig and of the deformer, which may be null.
Derivatives* create_derivatives(const Rig& rig, const Deformer* deformer,
                                const Allocator& allocator);

/// Numbers of a point; of positions, those of a mesh.
size_t point_size(const Derivatives& derivatives, Point point, uint32_t mesh);
/// Whether values at `from` have an effect on those at `to`.
bool leads_to(Point from, Point to);

/// At the values of an instance that has been evaluated.
void linearize(Derivatives& derivatives, const Instance& instance, uint32_t stages);

/// outputs[k] = the matrix of derivatives times directions[k], rows of point_size() numbers.
void push(Derivatives& derivatives, Point from, Point to, uint32_t mesh, uint32_t count,
          const float* directions, float* outputs);
/// outputs[k] = its transpose times gradients[k].
void pull(Derivatives& derivatives, Point from, Point to, uint32_t mesh, uint32_t count,
          const float* gradients, float* outputs);

struct Jacobian;
/// Entries of the columns with a byte other than 0 in `wanted`, or of all (jacobian.h).
void find_jacobian(Derivatives& derivatives, const Jacobian& jacobian, const uint8_t* wanted,
                   float* values);

}  // namespace mien
