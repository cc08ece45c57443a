// SPDX-License-Identifier: MIT
// A fit: the targets of a rig, the effects of its controls, and the memory of a solve. Built on the public
// interface of libmien alone.
//
//     control row -> evaluate -> joints, points -> residuals -> gradient, in reverse
//                        |-> derivatives of controls by raw controls: D
//     metric G of controls, once -> D^T G D: the matrix of a Gauss-Newton step
//
// docs/solving.md.
#pragma once

#include "capi/arguments/arguments.h"
#include "capi/include/mien_solve.h"
#include "runtime/base/allocator.h"
#include "runtime/base/arena.h"
#include "runtime/base/span.h"

constexpr uint32_t kFitTag = 0x6D46'4954;

struct MienFit {
  uint32_t tag = 0;
  mien::Allocator allocator;
  size_t block_size = 0;
  const MienRig* rig = nullptr;  // kept by the instance
  MienInstance* instance = nullptr;
  MienDerivatives* derivatives = nullptr;
  MienDeformerInstance* deformed = nullptr;  // with points

  uint32_t lod = 0, mesh = 0;
  size_t raw_count = 0, control_count = 0, joint_count = 0;
  size_t position_count = 0, triangle_count = 0;  // of the mesh

  mien::Span<float> raw;           // of the instance
  mien::Span<const float> joints;  // of the instance
  mien::Span<float> initial;       // [raw control]
  mien::Span<uint32_t> controls;   // that may move
  mien::Span<float> lower, upper;  // beside controls
  mien::Span<uint32_t> symmetric;  // pairs of places in `controls`
  mien::Span<MienSolvePoint> points;
  mien::Span<float> joint_weights;   // [joint value]
  mien::Span<uint32_t> triangles;    // [triangle][3] of the mesh, by positions
  bool inward = false;               // how they are wound
  mien::Span<uint32_t> samples;      // points that stand for all in steps
  mien::Span<float> sample_effects;  // [control][sample][3], at the neutral pose
  mien::Span<float> joint_metric,
      point_metric;                 // [control][control]; G without the weights of a frame
  mien::Span<float> observability;  // [raw control]

  // Memory of a solve.
  mien::Span<float> start, prior, best;           // [raw control]
  mien::Span<float> joint_gradient;               // [joint value]
  mien::Span<float> position_gradient;            // [position][3]
  mien::Span<float> from_joints, from_positions;  // [raw control]
  mien::Span<float> metric_row;                   // [control]
  mien::Span<double> matrix, factor;              // [free][free]
  mien::Span<double> gradient, step, work;        // [control that may move]
  mien::Span<uint32_t> free;                      // places in `controls`
  mien::Span<uint32_t> inputs;                    // their raw controls
  mien::Span<uint32_t> rows, columns, first;      // D by free control
  mien::Span<float> values;
  mien::Span<double> surface, targets;  // [point][3]: in model space; where it is drawn to
  mien::Span<double> normals;  // [point][3] of the surface, or of the one that it is drawn to
  mien::Span<double> weights;  // [point]: 0 if it is missing
  mien::Span<double> pulls;    // [point]: weights, less those of outliers
  mien::Span<double> lost;     // [point]: squared distance of one without a target, or -1
  mien::Span<float> position_normals;  // [position][3]
  mien::Span<float> direction, moved;  // [raw control]; [position][3]
  mien::Span<float> step_effects;      // [control that may move][sample][3]
  mien::Span<uint8_t> measured;        // [control that may move] its effects are those of this pose
  mien::Span<double> row, wide;        // [motion and free]; that squared
};

namespace mien {

/// Fills the metrics and the observability. Temporary memory comes from the arena. False if it ran out.
bool measure_rig(MienFit& fit, Arena& arena);

/// D at the values of the instance, for the free controls. `first` gets where each begins.
void list_free_derivatives(MienFit& fit, size_t free_count);

/// matrix += factor * D^T metric D, [free][free].
void project_metric(MienFit& fit, const float* metric, double factor, size_t free_count);

/// factor = the Cholesky factor of matrix with `damping` of its diagonal added; false if it is not definite.
bool factor_matrix(const double* matrix, size_t count, double damping, double* factor);
/// x = solution for the right side in x.
void solve_factored(const double* factor, size_t count, double* x);

/// The rotation (rows) and translation that move `from` nearest to `to`, with weights; x y z each.
void fit_rigid(const double* from, const double* to, const double* weights, size_t count,
               double* rotation, double* translation);

}  // namespace mien
