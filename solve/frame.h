// SPDX-License-Identifier: MIT
// One frame while it is solved: what the caller gave, and how the target is moved as a whole.
#pragma once

#include <chrono>
#include <cmath>

#include "solve/fit.h"
#include "solve/surface.h"

namespace mien {

constexpr size_t kMostSamples =
    2000;  // of the points, for the matrix of a step: with fewer, more steps are needed
constexpr size_t kMostMotion = 7;  // rotation, translation, focal length

/// From model space to that of the targets, or to the camera.
struct Motion {
  double rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  // rows
  double translation[3] = {0, 0, 0};
  double focal[2] = {1, 1};

  void place(const double* point, double* out) const {
    for (size_t r = 0; r < 3; ++r) {
      out[r] = translation[r];
      for (size_t c = 0; c < 3; ++c) out[r] += rotation[3 * r + c] * point[c];
    }
  }
  /// out = rotation, transposed, * direction
  void turn_back(const double* direction, double* out) const {
    for (size_t c = 0; c < 3; ++c) {
      out[c] = 0;
      for (size_t r = 0; r < 3; ++r) out[c] += rotation[3 * r + c] * direction[r];
    }
  }
};

struct Frame {
  using Clock = std::chrono::steady_clock;

  MienFit& fit;
  MienFitFrame in;
  Motion motion;  // of the camera if there are images, else of all targets of points
  uint32_t missing = 0;
  bool starting = false;  // there are no best controls yet
  bool exact = false;     // steps take the effects of controls on points from the pose at hand
  uint32_t stage = 0;     // controls of later stages are held
  size_t row_count = 0;   // of constraints, at the pose at hand
  bool modeled = false;   // MienFit::pull is of this frame
  bool learns = false;    // the metric follows from the steps of the frame
  Span<const uint32_t> samples = {};  // points that stand for all
  bool own_samples = false;           // they are chosen for this frame; else MienFit::samples
  bool few = false;                   // less than half of the points count, of a kind
  Clock::time_point begin = Clock::now();

  bool is_late() const {
    return in.max_seconds > 0 &&
           std::chrono::duration<double>(Clock::now() - begin).count() >= in.max_seconds;
  }
  bool has(Kind kind) const {
    if (kind == kSurface) return in.surface != nullptr;
    return (kind == kPoints ? in.points : in.images) != nullptr;
  }
  bool has_points() const { return in.points || in.images || in.surface; }
  /// Whether targets of a kind move with the motion: with images, all others stay where they are.
  bool moves(Kind kind) const { return kind == kImages || !in.images; }
  const Motion& motion_of(Kind kind) const {
    static constexpr Motion kInPlace;
    return moves(kind) ? motion : kInPlace;
  }
  /// What the caller has point i of a kind count, whether it has a target or not.
  double given_weight(Kind kind, size_t i) const {
    const bool own = kind == kSurface && in.surface_weights;
    const float* const weights = own ? in.surface_weights : in.point_weights;
    const double factor = kind == kImages && in.image_weight > 0 ? double{in.image_weight} : 1;
    return factor * double{weights ? weights[i] : 1.0f};
  }
  double robust_scale_of(Kind kind) const {
    if (kind != kImages) return double{in.robust_scale};
    const bool own = in.image_robust_scale > 0 || in.points || in.surface;
    return double{own ? in.image_robust_scale : in.robust_scale};
  }
  bool is_locked(uint32_t control) const { return in.stages && in.stages[control] > stage; }
  /// Steps need more than the metric at rest. That of rotations changes with the pose.
  bool has_rows() const {
    return in.images || in.surface || in.rigid || exact || !fit.rotations.empty();
  }
  size_t motion_count() const { return !in.rigid ? 0 : in.images && in.focal ? 7 : 6; }
  double joint_factor() const { return in.joint_weight > 0 ? in.joint_weight : 1; }
};

/// The robust cost of a squared residual, and the weight that it has in a step (S. Geman, D. McClure 1987).
inline double robust(double squared, double scale, double& weight) {
  if (!(scale > 0)) {
    weight = 1;
    return squared;
  }
  const double s = scale * scale, share = s / (s + squared);
  weight = share * share;
  return squared * share;
}

/// A sum over the data of a kind.
struct Sum {
  double squares = 0, weight = 0;
  double worst = 0;  // squared
};

/// The sums over the data at some controls.
struct Cost {
  double total = 0;
  Sum joints, points[kKinds], constraints;
  double compared_surface = 0;  // to compare a step by: compared_residual()
};

constexpr double kEnoughDecrease = 1e-6;  // of the cost: far below what noise is worth
constexpr double kEnoughOfFirst = 1e-10;  // of the cost at the start
constexpr double kEnoughStep = 1e-6;      // of a control
constexpr double kRounding = 1e-7;        // of the largest coordinate: floats have no more digits
constexpr double kFirstDamping = 1e-5;

inline double square(double v) { return v * v; }

// Cost (cost.cpp) ---------------------------------------------------------------------------------------

/// All controls, and what the targets need.
void evaluate(MienFit& fit);
/// The terms that do not depend on the rig; their part of the gradient of controls that may move is added.
double regularize(const Frame& f, const float* raw, double* gradient);
/// Where a control of MienFit::raw may move: within its bounds, and not across the kink of the sum of magnitudes. On the
/// kink, to the side that MienFit::gradient leads to; nowhere if it is 0. Parts of a rotation may leave it.
struct Limits {
  double low, high;
};
Limits limits_of(const Frame& f, size_t place);
/// The cost at the controls of the instance without those terms; with gradients of joints and positions.
Cost find_cost(Frame& f);
/// Moves the target as a whole, or the camera, to where it fits the points, which have moved.
void follow_points(Frame& f, uint32_t rounds);
/// The derivatives of the meshes, and of joints, at the pose at hand.
void linearize_points(MienFit& fit);
/// Half of the gradient of the cost by the controls that may move.
void find_gradient(Frame& f);
/// The mean weight of points: what the metric of points is multiplied by.
double point_factor(const MienFit& fit);
/// The parts of the diagonal and of symmetric pairs in the matrix of a step.
void add_regularization(Frame& f, size_t free_count);

// Constraints (constraints.cpp) -------------------------------------------------------------------------

MienStatus check_constraints(const MienFit& fit, const MienFitFrame& in);
/// Adds to the cost, and to the gradients of positions and model matrices, which are 0 or those of points.
void add_constraint_cost(Frame& f, Cost& cost);
/// The derivatives of all residuals by `from`: raw or all controls.
void list_constraint_rows(Frame& f, uint32_t from);
/// Whether joints have constraints.
bool has_joint_constraints(const Frame& f);

// Model (model.cpp) -------------------------------------------------------------------------------------

struct ModelStep {
  double farthest;   // that a control moves
  double predicted;  // the cost after it, if the model holds
  bool solved;       // the model has no lower cost within reach
};
/// Takes the cost at the best controls as a quadratic function of all controls.
void make_model(Frame& f);
/// Moves controls from the best ones to where the model is lowest. `cost` is the total at the best controls.
/// `rounding` is a cost below which nothing counts.
ModelStep minimize_model(Frame& f, double cost, double first, double rounding, double damping);
/// MienFit::step of the free controls, from those of the instance: where it would leave the bounds, a control stops
/// and the others take that into account.
void find_bounded_step(Frame& f, size_t free_count, double damping);
/// What a step may still gain: each control by itself.
struct Gains {
  double held = 0;  // those at a bound
  double all = 0;
};
constexpr double kOwnDamping = 1e-9;
constexpr double kLittle = 0.25;  // together controls gain more than each by itself
/// Controls within their bounds; and those at a bound that gain by leaving it, unless `inside_only`. Returns how many.
size_t list_model_free(Frame& f, bool inside_only, Gains& gains);
/// The derivatives of all controls by raw ones, at the values of the instance.
void linearize_controls(MienFit& fit);
/// Half of the gradient of the model by the controls that may move, from that by all controls in MienFit::metric_row.
void take_model_gradient(Frame& f, double damping);
/// The diagonal of the model's matrix.
void find_stiffness(const Frame& f);
/// The matrix of a step for the free controls.
void set_model_matrix(Frame& f, size_t free_count, double damping);
/// Moves the free controls by MienFit::step from MienFit::kept.
void move_free(MienFit& fit, size_t free_count);
/// response = metric times the change of controls; returns the change of the model's cost.
double find_change(Frame& f);
/// Control values alone.
void evaluate_controls(MienFit& fit);

// Steps (steps.cpp) -------------------------------------------------------------------------------------

/// Solves from the controls of the instance to MienFit::best.
void solve_frame(Frame& f, MienFitResult& told);
void tell_cost(const MienFitFrame& in, const Cost& cost, MienFitResult& told);

// Frames of joints (joint_frames.cpp) -------------------------------------------------------------------

/// A motion whose only targets are joint values that are sums: its frames follow from each other.
struct JointFrames {
  MienFit& fit;
  double weight = 0;        // sum of the weights of joint values
  bool follows = false;     // the pulls are those of the frame before
  size_t matrix_count = 0;  // free controls of the matrix that is kept. 0: there is none
  size_t factor_count = 0;  // of the factor at hand

  /// The targets of up to kBlockFrames frames, of which `in` is the first. False if there are other targets, or one is
  /// missing.
  bool begin_block(const MienFitFrame& in, size_t count);
  /// Frame `lane` of the block, from the controls of the instance. False: it has to be solved by itself.
  bool solve(Frame& f, size_t lane, MienFitResult& told);

  bool take_matrix(size_t free_count);
  void make_matrix(Frame& f, size_t free_count);
  void factor(size_t free_count);
  bool step(Frame& f, size_t free_count, double terms, double& value);
  double minimize(Frame& f, double first, double rounding);
};

// Points ------------------------------------------------------------------------------------------------

/// Targets and weights as given; missing ones have no weight. Chooses samples.
void read_points(Frame& f);
/// Of `count` points, at most `most`.
size_t sample_count(size_t count, size_t most);
/// Fills `out`, as many as sample_count() says.
void choose_samples(size_t count, const Span<uint32_t>& out);
/// The points at the controls of the instance, and, for a surface, their normals.
void find_points(Frame& f);
/// Where a point in model space is seen: placed, and in the image if that is the kind.
void view_point(const Frame& f, Kind kind, const double* point, double* out);
/// Where each point is drawn to, if that is a surface.
void match_surface(Frame& f);
/// The targets on the surface are those that steps are compared by.
void keep_targets(MienFit& fit);
/// What a point on a surface counts where steps are compared: points that had no target before the step count nothing,
/// whatever they find; for the others the target before the step is one that they may still have.
double compared_residual(const Frame& f, size_t point, double squared);
/// The squared residual of a point, and half of its derivative by the point in model space.
double point_residual(const Frame& f, Kind kind, size_t point, double* gradient);
/// The residuals of a point as steps see them, and their derivatives by the point where the targets are. Up to 3.
size_t point_rows(const Frame& f, Kind kind, size_t point, double (*directions)[3],
                  double* residuals);

// Motion ------------------------------------------------------------------------------------------------

/// A camera that sees the face from the front, as large and where the targets are.
void guess_camera(Frame& f);
/// Moves the targets, or the camera, nearer to the points.
void fit_motion(Frame& f, uint32_t rounds);
/// The derivatives of a residual by the numbers of the motion: row `row` of a point, which has been moved.
void list_motion(const Frame& f, const double* moved, const double* direction, size_t row,
                 double* out);

// Rows of points (rows.cpp) -----------------------------------------------------------------------------

/// matrix += J^T W J of the points by the free controls, whatever the motion, which follows them.
void add_point_rows(Frame& f, size_t free_count);

}  // namespace mien
