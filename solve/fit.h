// SPDX-License-Identifier: MIT
// A fit: the targets of a rig, the effects of its controls, and the memory of a solve. Built on the public
// interface of libmien alone.
//
//     control row -> evaluate -> joints, points -> residuals -> gradient by all controls, in reverse
//                        |-> derivatives of controls by raw controls: D
//     metric G of controls, once -> the cost as a quadratic function of all controls (model.cpp);
//                                   D^T G D: the matrix of a Gauss-Newton step
//
// docs/solving.md.
#pragma once

#include "capi/arguments/arguments.h"
#include "capi/include/mien_solve.h"
#include "runtime/base/allocator.h"
#include "runtime/base/arena.h"
#include "runtime/base/span.h"

constexpr uint32_t kFitTag = 0x6D46'4954;

namespace mien {

/// Kinds of targets that a point may have, each with a unit of its own.
enum Kind : uint32_t { kPoints, kImages, kSurface, kKinds };
constexpr Kind kAllKinds[] = {kPoints, kImages, kSurface};

struct KindTargets {
  Span<double> targets;  // [point][3]: in the space of the targets, in the image, on the surface
  Span<double> weights;  // [point]: 0 if it is missing
  Span<double> pulls;    // [point]: weights, less those of outliers
};

/// A mesh that points are on. Where they read few of its positions, its objects are of a deformer of those alone.
struct FitMesh {
  uint32_t mesh = 0;  // of the rig
  MienDerivatives* derivatives = nullptr;
  MienDeformerInstance* deformed = nullptr;
  MienDerivatives* sample_derivatives =
      nullptr;                  // of the positions of samples; may be `derivatives`
  const float* at = nullptr;    // [position][3] of `deformed`, since it was deformed last
  size_t first = 0, count = 0;  // positions of `deformed`, in lists of those of all meshes
  size_t sample_count = 0;      // positions of `sample_derivatives`
  size_t first_whole = 0;       // of all its positions, in lists of those of all meshes
  size_t first_triangle = 0, triangle_count = 0;
  bool inward = false;  // how they are wound
};

}  // namespace mien

struct MienFit {
  uint32_t tag = 0;
  mien::Allocator allocator;
  size_t block_size = 0;
  const MienRig* rig = nullptr;  // kept by the instance
  MienInstance* instance = nullptr;
  MienDerivatives* control_derivatives = nullptr;  // up to joint values: no deformer
  MienJacobian* by_raw = nullptr;                  // of all controls by raw ones
  mien::Span<mien::FitMesh> meshes;                // ascending
  // With a deformer: those of the first mesh, for joints.
  MienDerivatives* derivatives = nullptr;
  MienDeformerInstance* deformed = nullptr;
  MienDeformerInstance* whole = nullptr;  // of whole meshes; may be `deformed`

  uint32_t lod = 0;
  size_t raw_count = 0, control_count = 0;
  size_t joint_count = 0, bone_count = 0;      // joint values; joints
  size_t position_count = 0;                   // of all meshes
  size_t whole_count = 0, triangle_count = 0;  // positions and triangles of whole meshes

  mien::Span<float> raw;                 // of the instance
  mien::Span<const float> joints;        // of the instance
  mien::Span<const float> all_controls;  // of the instance
  mien::Span<float> initial;             // [raw control]
  mien::Span<uint32_t> controls;         // that may move
  mien::Span<float> lower, upper;        // beside controls
  mien::Span<uint32_t> rotations;        // places in `controls` of quaternions: four in a row
  mien::Span<uint8_t> resting;           // [control that may move] see rest_rotations()
  mien::Span<uint32_t> symmetric;        // pairs of places in `controls`
  // Their meshes are places in `meshes`, their positions those of FitMesh::deformed, of the whole mesh, and, for each
  // sample, of FitMesh::sample_derivatives.
  mien::Span<MienSolvePoint> points, whole_points, sample_points;
  mien::Span<float> joint_weights;   // [joint value]
  mien::Span<uint32_t> triangles;    // [triangle][3] of whole meshes, by positions
  mien::Span<uint32_t> samples;      // points that stand for all in steps
  mien::Span<float> sample_effects;  // [control][sample][3], at the neutral pose
  mien::Span<double> joint_metric,
      point_metric;  // [control][control]; G without the weights of a frame
  // What controls add to joint values, by control, in a block of its own; empty unless joint values are sums.
  mien::Span<uint32_t> joint_first;  // [control + 1]
  mien::Span<uint32_t> joint_rows;
  mien::Span<float> joint_effects;
  // Raw controls that a corrective reads, directly or not: [control + 1], and the list.
  mien::Span<uint32_t> depends_first, depends_on;
  void* joint_block = nullptr;
  size_t joint_block_size = 0;
  mien::Span<float> observability;  // [raw control]

  // Memory of a solve.
  mien::Span<float> start, prior, best;           // [raw control]
  mien::Span<float> joint_gradient;               // [joint value]
  mien::Span<float> position_gradient;            // [position of all meshes][3]
  mien::Span<float> from_joints, from_positions;  // [raw control]
  mien::Span<float> model_gradient;               // [joint][16]
  mien::Span<float> metric_row;                   // [control]
  mien::Span<double> projected;                   // [control]
  mien::Span<uint32_t> support, places;           // controls that D has; [control] place in them
  mien::Span<double> matrix, factor, reduced;     // [free][free]
  mien::Span<double> gradient, step, work;        // [control that may move]
  mien::Span<uint32_t> free;                      // places in `controls`
  mien::Span<uint32_t> inputs;                    // their raw controls
  mien::Span<uint32_t> rows, first;               // D by free control, without entries of 0
  mien::Span<float> values;
  mien::Span<uint8_t> wanted;        // [raw control] it is free
  mien::Span<uint32_t> first_entry;  // [raw control + 1] into entries
  mien::Span<float> entries;         // of `by_raw`
  mien::Span<double> surface;        // [point][3] in model space
  mien::KindTargets kinds[mien::kKinds];
  mien::Span<double> normals;       // [point][3] of the surface that it is drawn to
  mien::Span<uint8_t> lost;         // [point] it has no target on the surface
  mien::Span<double> kept_targets;  // [point][3] on the surface, and `lost`, at the best controls
  mien::Span<uint8_t> kept_lost;
  mien::Span<float> position_normals;   // [position of whole meshes][3]
  mien::Span<float> directions, moved;  // kDirections of [raw control]; of [position][3]
  mien::Span<uint32_t> own_samples;     // of a frame
  mien::Span<uint8_t> is_sample;        // [point] scratch
  mien::Span<float> step_effects;       // [control that may move][sample][3]
  mien::Span<uint8_t> measured;    // [control that may move] its effects are those of this pose
  mien::Span<double> panel, wide;  // [motion and free][kPanel]; [motion and free] squared

  // The model of a step, and what earlier steps and constraints add to it.
  mien::Span<double> pull,
      last_pull;  // [control] half the gradient of the cost; of the model before
  mien::Span<double> change, response;  // [control] from where the model was made; G times that
  mien::Span<float> model_controls;     // [control] where the model was made
  mien::Span<uint32_t> changed;         // controls with a change
  mien::Span<double> stiffness;         // [control that may move] what moving it alone costs
  // The same of joint values and of points at the neutral pose, without the weights of a frame.
  mien::Span<double> joint_stiffness, point_stiffness;
  mien::Span<float> kept;                             // [raw control]
  mien::Span<float> constraint_rows;                  // [row][control or raw control]
  mien::Span<float> secant_rows;                      // [row][control]
  mien::Span<double> secant_weights, secant_changes;  // [row]
  size_t secant_count = 0;
  mien::Span<float> row_models;  // kRowsAtOnce of [joint][16]; of positions: `moved`, mesh by mesh
  mien::Span<float> row_parts;   // kRowsAtOnce of [control or raw control]: of a mesh
  mien::Span<double> row_residuals, row_weights, row_changes;  // [row]
  mien::Span<float> start_joints;    // [joint value] at the start of a frame
  mien::Span<double> start_surface;  // [point][3]

  // Frames of joints (joint_frames.cpp), in the block of joint effects.
  mien::Span<float> block_targets;  // [joint value][frame of a block]
  mien::Span<double> block_pulls;   // [control][frame of a block], of those that count
  mien::Span<uint32_t> counting;    // controls that count
  mien::Span<uint8_t> counts;       // [control]
  mien::Span<uint8_t> above_zero;   // [raw control]
  // Free controls of the matrix that is kept, and of the factor.
  mien::Span<uint32_t> matrix_free, factor_free;
  mien::Span<double> kept_matrix;
};

namespace mien {

constexpr uint32_t kDirections = 32;  // at a time through derivatives
constexpr uint32_t kRowsAtOnce = 30;  // of constraints
static_assert(kRowsAtOnce <= kDirections, "rows of positions are in MienFit::moved");
constexpr uint32_t kMostConstraints = 64;
constexpr uint32_t kMostSecants = 32;  // rows
constexpr uint32_t kBlockFrames = 16;  // whose joint values are multiplied together

/// Fills the metrics and the observability. `deformers` are those of FitMesh::derivatives. Temporary memory comes from
/// the arena. False if it ran out.
bool measure_rig(MienFit& fit, Span<const MienDeformer*> deformers, Arena& arena);
/// The metric of points, and the effects of controls on samples (measure_points.cpp).
bool measure_points(MienFit& fit, Span<const MienDeformer*> deformers, Arena& arena);

// Rotations (rotations.cpp): a unit quaternion q among the controls. Its derivatives along q do not count.

/// Places in the `count` controls that move (NULL: all) where a quaternion begins, into `out` if it is not NULL; returns
/// how many.
size_t find_rotations(const MienRig* rig, const Span<const float>& initial, const uint32_t* moving,
                      size_t count, uint32_t* out);
/// Those of MienFit::raw get the length 1.
void normalize_rotations(MienFit& fit);
void hold_gradient(MienFit& fit);
/// MienFit::matrix of the free controls, at MienFit::raw.
void hold_matrix(MienFit& fit, size_t free_count);
/// Makes that definite along q.
void stiffen_lengths(MienFit& fit, size_t free_count);
/// MienFit::step leads from unit quaternions to unit quaternions, which turn only so far.
void turn_rotations(MienFit& fit, size_t free_count);
/// Puts those that are all but at their initial values there, and marks them: MienFit::resting. False if there are none.
bool rest_rotations(MienFit& fit);

/// Whether a point is its first position.
inline bool is_position(const MienSolvePoint& point) {
  return point.weights[0] == 1 && point.weights[1] == 0 && point.weights[2] == 0;
}

/// The entries of MienFit::by_raw, by column.
inline MienJacobianPattern pattern_of(const MienFit& fit) {
  MienJacobianPattern pattern = mien_jacobian_pattern_default();
  static_cast<void>(mien_jacobian_pattern(fit.by_raw, &pattern));
  return pattern;
}
inline Span<const uint32_t> span_of(const MienIndex32View& view) { return {view.data, view.count}; }

/// D at the values of the instance, for the free controls. `first` gets where each begins.
void list_free_derivatives(MienFit& fit, size_t free_count);

/// matrix += factor * D^T metric D, [free][free].
void project_metric(MienFit& fit, const double* metric, double factor, size_t free_count);

constexpr size_t kPanel = 48;  // numbers of a row, the last of which may be 0
/// Calls add(i, j, sum) with the product of rows i and j of a panel, j <= i, in one order of sums.
template <class F>
void for_each_product(const double* panel, size_t row_count, F&& add) {
  for (size_t i = 0; i < row_count; ++i) {
    const double* const a = panel + i * kPanel;
    for (size_t j = 0; j <= i; ++j) {
      const double* const b = panel + j * kPanel;
      double sums[4] = {};
      for (size_t n = 0; n < kPanel; n += 4) {
        for (size_t k = 0; k < 4; ++k) sums[k] += a[n + k] * b[n + k];
      }
      add(i, j, (sums[0] + sums[2]) + (sums[1] + sums[3]));
    }
  }
}

/// factor = the Cholesky factor of matrix with `damping` of its diagonal added; false if it is not definite.
bool factor_matrix(const double* matrix, size_t count, double damping, double* factor);
/// The same with as much damping as it takes to be definite.
void factor_damped(const double* matrix, size_t count, double damping, double* factor);
/// x = solution for the right side in x.
void solve_factored(const double* factor, size_t count, double* x);

/// The rotation (rows) and translation that move `from` nearest to `to`, with weights; x y z each.
void fit_rigid(const double* from, const double* to, const double* weights, size_t count,
               double* rotation, double* translation);

}  // namespace mien
