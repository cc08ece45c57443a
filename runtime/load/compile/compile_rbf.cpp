// SPDX-License-Identifier: MIT
// RBF solvers, twists and swings (docs/rig-evaluation.md, 6 "RBF solvers" and 7 "Twist and swing").
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "runtime/base/bits.h"
#include "runtime/load/compile/compile_rig.h"
#include "runtime/rig/work.h"
#include "simd/lanes.h"
#include "simd/rbf_kernels.h"
#include "simd/rotation_kernels.h"

namespace mien {
namespace {

// Production solvers have some tens of poses. Automatic radii and interpolation take time and
// memory with the square of it and more, so a file must not ask for any number.
constexpr uint32_t kMaxPoses = 1024;
constexpr float kMaxBlend = 1e9f;  // of a twist or swing: squares of rotations must not overflow
constexpr float kMaxScale = 1e9f;  // of a pose, as RbfArgs asks

enum Function : uint16_t { kGaussian, kExponential, kLinear, kCubic, kQuintic };

bool is_interpolative(const dna::RbfSolver& solver) { return solver.solver_type == 1; }

/// Distance of two targets. In single precision and in this order because files were made for it:
/// the angle of nearly equal rotations is mostly rounding (docs/rig-evaluation.md, 10 "Numerical
/// facts").
float target_distance(const RbfTable& rbf, const RbfSolverPlan& s, uint32_t a, uint32_t b) {
  const uint32_t stride = padded(s.pose_count);
  const float* targets = rbf.targets.data + s.first_target;
  const auto at = [&](uint32_t input, uint32_t pose) {
    return targets[size_t{input} * stride + pose];
  };
  float sum = 0;
  if (s.angle_inputs == 0) {
    for (uint32_t i = 0; i < s.input_count; ++i) {
      const float d = at(i, a) - at(i, b);
      sum += d * d;
    }
    return std::sqrt(sum);
  }
  for (uint32_t i = 0; i + s.angle_inputs <= s.input_count; i += s.angle_inputs) {
    float dot = 0;
    for (uint32_t k = 0; k < s.angle_inputs; ++k) dot += at(i + k, a) * at(i + k, b);
    const float u = dot * dot;
    const float angle = u > 1 ? 0 : std::acos(2 * u - 1);
    sum += angle * angle;
  }
  return std::sqrt(sum);
}

double weight(uint8_t function, double x) {
  switch (function) {
    case kGaussian:
    case kExponential: return std::exp2(x);
    case kLinear: return std::max(0.0, 1 - x);
    case kCubic: return std::max(0.0, 1 - x * x * x);
    default: return std::max(0.0, 1 - x * x * x * x * x);
  }
}

/// The factor of the distance in the weight functions of RbfSolverPlan: 1/r, or that of exp(-d/r^2) and
/// exp(-2d/r).
double distance_scale(uint8_t function, double radius) {
  constexpr double kLog2E = 1.4426950408889634;
  if (function == kGaussian) return -kLog2E / (radius * radius);
  if (function == kExponential) return -2 * kLog2E / radius;
  return 1 / radius;
}

double automatic_radius(const RbfTable& rbf, const RbfSolverPlan& s) {
  double sum = 0;
  for (uint32_t a = 0; a < s.pose_count; ++a) {
    for (uint32_t b = 0; b < a; ++b) sum += target_distance(rbf, s, a, b);
  }
  const double pairs = 0.5 * s.pose_count * (s.pose_count - 1.0);
  return pairs > 0 ? sum / pairs : 0;
}

/// Gauss-Jordan with partial pivoting, in place: `m` is n x 2n, the identity on the right. A column
/// without a pivot gets a tiny one.
void invert(double* m, uint32_t n) {
  const size_t width = size_t{n} * 2;
  for (uint32_t c = 0; c < n; ++c) {
    uint32_t best = c;
    for (uint32_t r = c + 1; r < n; ++r) {
      if (std::fabs(m[r * width + c]) > std::fabs(m[best * width + c])) best = r;
    }
    if (best != c) std::swap_ranges(m + c * width, m + (c + 1) * width, m + best * width);
    double pivot = m[c * width + c];
    if (pivot == 0) pivot = 1e-20;
    for (size_t k = 0; k < width; ++k) m[c * width + k] /= pivot;
    for (uint32_t r = 0; r < n; ++r) {
      const double factor = m[r * width + c];
      if (r == c || factor == 0) continue;
      for (size_t k = c; k < width; ++k) m[r * width + k] -= factor * m[c * width + k];
    }
  }
}

/// `scratch` has room for 2 n^2 numbers.
void fill_inverse(RbfTable& rbf, const RbfSolverPlan& s, const Span<double>& scratch) {
  const uint32_t n = s.pose_count;
  const size_t width = size_t{n} * 2;
  const Span<double> m = scratch.first(n * width);
  std::fill(m.begin(), m.end(), 0.0);
  bool empty_row = false;
  for (uint32_t r = 0; r < n; ++r) {
    bool any = false;
    for (uint32_t c = 0; c < n; ++c) {
      const double distance = target_distance(rbf, s, r, c);
      const double w = weight(s.function, distance * double{s.scale});
      m[r * width + c] = std::isfinite(w) ? w : 0;
      any |= m[r * width + c] != 0;
    }
    m[r * width + n + r] = 1;
    empty_row |= !any;
  }
  if (!empty_row) invert(m.data, n);
  const uint32_t first = empty_row ? 0 : n;
  float* blocks = rbf.inverses.data + s.first_inverse;
  for (uint32_t r = 0; r < n; ++r) {
    for (uint32_t c = 0; c < n; ++c) {
      const auto v = static_cast<float>(m[r * width + first + c]);
      blocks[(size_t{r / kBlockLanes} * n + c) * kBlockLanes + r % kBlockLanes] =
          std::isfinite(v) ? v : 0.0f;
    }
  }
}

/// The cost, which grows with squares and cubes of pose counts.
uint64_t count_matrix_steps(const dna::DnaView& view, const RbfTable& rbf) {
  uint64_t steps = 0;
  for (uint32_t i = 0; i < rbf.plans.count; ++i) {
    const uint64_t poses = rbf.plans[i].pose_count, inputs = rbf.plans[i].input_count;
    if (rbf.plans[i].interpolative) steps += count_inversion_steps(poses, inputs);
    if (view.rbfb.solvers[i].automatic_radius == 0) steps += poses * poses * (inputs + 16) / 2;
  }
  return steps;
}

Status check_work(const dna::DnaView& view, const Rig& rig, Error& error) {
  const uint64_t budget = compile_budget(view, rig);
  const uint64_t steps = std::max(count_rbf_steps(rig, budget), count_matrix_steps(view, rig.rbf));
  if (steps <= budget) return Status::kOk;
  return fail(
      error, Status::kDnaLimit, kNoOffset,
      "rbfb.solvers: %llu steps or more to make the solvers, or to evaluate each LOD once; at most "
      "%llu are supported for a file of this size",
      static_cast<unsigned long long>(steps), static_cast<unsigned long long>(budget));
}

/// Floats per rotation for a distance function; 0 if it does not compare rotations.
uint32_t angle_inputs(uint16_t distance) {
  switch (distance) {
    case kQuaternion: return 4;
    case kSwingAngle: return 3;
    case kTwistAngle: return 2;
    default: return 0;
  }
}

/// Rotations of which a solver takes the swing or the twist.
uint32_t parted_rotations(const dna::RbfSolver& solver) {
  const bool parts = solver.distance_method == kSwingAngle || solver.distance_method == kTwistAngle;
  return parts ? solver.raw_control_indices.count / 4 : 0;
}

/// Inputs as the kernel counts them: whole rotations.
uint32_t plan_inputs(const dna::RbfSolver& solver) {
  const uint32_t count = solver.raw_control_indices.count,
                 width = angle_inputs(solver.distance_method);
  return width ? count / 4 * width : count;
}

/// Floats of the targets of a solver.
size_t target_floats(uint32_t poses, uint32_t inputs) {
  return size_t{padded(poses)} * std::max(inputs, 1u);
}

void fill_targets(const dna::RbfSolver& from, const RbfSolverPlan& plan, RbfTable& rbf) {
  const uint32_t stride = padded(plan.pose_count), width = from.raw_control_indices.count;
  float* targets = rbf.targets.data + plan.first_target;
  for (size_t i = 0; i < target_floats(plan.pose_count, plan.input_count); ++i) {
    const bool is_pose = i % stride < plan.pose_count;
    targets[i] = is_pose ? 0.0f : std::numeric_limits<float>::quiet_NaN();
  }
  const uint32_t a = from.twist_axis, b = (a + 1) % 3, c = (a + 2) % 3;
  for (uint32_t p = 0; p < plan.pose_count; ++p) {
    const auto value = [&](uint32_t i) { return from.raw_control_values[size_t{p} * width + i]; };
    if (!takes_parts(plan)) {
      for (uint32_t i = 0; i < plan.input_count; ++i) targets[size_t{i} * stride + p] = value(i);
      continue;
    }
    const bool swing = plan.angle_inputs == 3;
    for (uint32_t i = 0; i + 4 <= width; i += 4) {
      const Quaternion q =
          rotation_part({value(i), value(i + 1), value(i + 2), value(i + 3)}, a, swing);
      const float xyz[3] = {q.x, q.y, q.z};
      const float kept[3] = {swing ? xyz[b] : xyz[a], swing ? xyz[c] : q.w, q.w};
      for (uint32_t k = 0; k < plan.angle_inputs; ++k) {
        targets[size_t{i / 4 * plan.angle_inputs + k} * stride + p] = kept[k];
      }
    }
  }
}

/// Controls of the rotations of a solver, with the axis first.
void fill_rotations_of(const dna::RbfSolver& from, uint32_t first_lane, RbfTable& rbf) {
  const uint32_t a = from.twist_axis;
  const uint32_t order[4] = {a, (a + 1) % 3, (a + 2) % 3, 3};
  for (uint32_t r = 0; r < parted_rotations(from); ++r) {
    const uint32_t lane = first_lane + r;
    const size_t block = size_t{lane / kBlockLanes} * 4 * kBlockLanes;
    for (uint32_t k = 0; k < 4; ++k) {
      rbf.rotations[block + size_t{k} * kBlockLanes + lane % kBlockLanes] =
          from.raw_control_indices[r * 4 + order[k]];
    }
    rbf.swings[lane] = from.distance_method == kSwingAngle ? 1.0f : 0.0f;
  }
}

/// False if memory ran out.
bool fill_radii_and_inverses(const dna::DnaView& view, Arena& scratch, RbfTable& rbf) {
  size_t most = 0;  // of one solver
  for (const RbfSolverPlan& plan : rbf.plans) {
    if (plan.interpolative) most = std::max(most, size_t{plan.pose_count} * plan.pose_count * 2);
  }
  const Span<double> matrix = scratch.array<double>(most);
  if (most != 0 && !matrix.data) return false;
  const double to_radians = view.desc.rotation_unit == 0 ? 0.017453292519943295 : 1.0;
  for (uint32_t i = 0; i < rbf.plans.count; ++i) {
    const dna::RbfSolver& from = view.rbfb.solvers[i];
    RbfSolverPlan& plan = rbf.plans[i];
    const bool automatic = from.automatic_radius == 0;
    const double radius =
        automatic ? automatic_radius(rbf, plan) : static_cast<double>(from.radius) * to_radians;
    plan.scale = static_cast<float>(distance_scale(plan.function, radius));
    if (plan.interpolative) fill_inverse(rbf, plan, matrix);
  }
  return true;
}

/// Pose controls: the lists of controls that each pose drives.
void fill_poses(const dna::DnaView& view, RbfTable& rbf) {
  for (uint32_t p = 0; p < view.rbfe.poses.count; ++p) {
    const dna::RbfPoseControls& from = view.rbfe.poses[p];
    const uint32_t inputs = rbf.first_input[p], outputs = rbf.first_output[p];
    copy_array(from.input_control_indices,
               rbf.pose_inputs.slice(inputs, from.input_control_indices.count));
    copy_array(from.output_control_indices,
               rbf.pose_outputs.slice(outputs, from.output_control_indices.count));
    copy_array(from.output_control_weights,
               rbf.pose_weights.slice(outputs, from.output_control_weights.count));
    rbf.first_input[p + 1] = inputs + from.input_control_indices.count;
    rbf.first_output[p + 1] = outputs + from.output_control_indices.count;
  }
}

/// True if each pose drives one control, in consecutive order, without inputs to multiply by.
bool drives_in_order(const RbfTable& rbf, const RbfSolver& solver, uint32_t pose_count) {
  for (uint32_t p = 0; p < pose_count; ++p) {
    const uint32_t pose = rbf.poses[solver.first_pose + p];
    const uint32_t output = rbf.first_output[pose];
    if (rbf.first_input[pose] != rbf.first_input[pose + 1]) return false;
    if (output + 1 != rbf.first_output[pose + 1]) return false;
    if (!(std::fabs(rbf.pose_weights[output]) <= kMaxScale)) return false;
    const uint32_t first = rbf.first_output[rbf.poses[solver.first_pose]];
    if (rbf.pose_outputs[output] != rbf.pose_outputs[first] + p) return false;
  }
  return pose_count != 0;
}

/// Finds which solvers may overwrite without reading first, and whether all of them are independent.
/// `writer` is zeroed scratch: [control], the last solver found to drive it, counted from 1.
void find_order(RbfTable& rbf, const Span<uint32_t>& writer) {
  rbf.independent = true;
  for (uint32_t s = 0; s < rbf.solvers.count; ++s) {
    const RbfSolver& solver = rbf.solvers[s];
    RbfSolverPlan& plan = rbf.plans[s];
    const bool in_order = drives_in_order(rbf, solver, plan.pose_count);
    plan.first_control = kNoFirstControl;
    for (uint32_t p = 0; p < plan.pose_count; ++p) {
      const uint32_t pose = rbf.poses[solver.first_pose + p];
      for (uint32_t o = rbf.first_output[pose]; o < rbf.first_output[pose + 1]; ++o) {
        uint32_t& last = writer[rbf.pose_outputs[o]];
        rbf.independent &= last == 0 || last == s + 1;
        last = s + 1;
        if (!in_order) continue;
        if (p == 0) plan.first_control = rbf.pose_outputs[o];
        rbf.pose_factors[plan.first_lane + p] = rbf.pose_weights[o];
      }
    }
  }
  for (const Span<uint16_t>& read : {rbf.inputs, rbf.rotations}) {
    for (uint16_t control : read) rbf.independent &= writer[control] == 0;
  }
}

uint64_t input_key(const dna::Array<uint16_t>& inputs) {
  uint64_t key = 0;
  for (uint32_t i = 0; i < 4; ++i) key = key << 16 | inputs[i];
  return key;
}

}  // namespace

Status place_rbf(const dna::DnaView& view, Placer& placer, Rig& rig, Error& error) {
  RbfTable& rbf = rig.rbf;
  const auto& solvers = view.rbfb.solvers;
  size_t inputs = 0, rotations = 0, poses = 0, lanes = 0, targets = 0, inverses = 0;
  for (uint32_t i = 0; i < solvers.count; ++i) {
    const dna::RbfSolver& solver = solvers[i];
    const uint32_t count = solver.pose_indices.count;
    if (count > kMaxPoses) {
      return fail(error, Status::kDnaLimit, view.offset_of(solver.pose_indices.data),
                  "rbfb.solvers[%u].poseIndices: %u poses; at most %u are supported", i, count,
                  kMaxPoses);
    }
    rotations += parted_rotations(solver);
    if (parted_rotations(solver) == 0) inputs += plan_inputs(solver);
    poses += count;
    lanes += padded(count);
    targets += target_floats(count, plan_inputs(solver));
    if (is_interpolative(solver)) inverses += size_t{padded(count)} * count;
  }
  size_t pose_inputs = 0, pose_outputs = 0;
  for (const dna::RbfPoseControls& pose : view.rbfe.poses) {
    pose_inputs += pose.input_control_indices.count;
    pose_outputs += pose.output_control_indices.count;
  }
  const size_t pose_count = view.rbfe.poses.count;
  rbf.solvers = placer.array<RbfSolver>(solvers.count);
  rbf.plans = placer.array<RbfSolverPlan>(solvers.count);
  rbf.inputs = placer.array<uint16_t>(inputs);
  rotations = align_up(rotations, kBlockLanes);
  rbf.rotations = placer.array<uint16_t>(rotations * 4);
  rbf.swings = placer.array<float>(rotations, kBlockAlignment);
  rbf.poses = placer.array<uint16_t>(poses);
  rbf.targets = placer.array<float>(targets, kBlockAlignment);
  rbf.inverses = placer.array<float>(inverses, kBlockAlignment);
  rbf.pose_scales = placer.array<float>(lanes, kBlockAlignment);
  rbf.pose_factors = placer.array<float>(lanes, kBlockAlignment);
  rbf.first_input = placer.array<uint32_t>(pose_count + 1);
  rbf.first_output = placer.array<uint32_t>(pose_count + 1);
  rbf.pose_inputs = placer.array<uint16_t>(pose_inputs);
  rbf.pose_outputs = placer.array<uint16_t>(pose_outputs);
  rbf.pose_weights = placer.array<float>(pose_outputs);
  place_lod_lists(view.rbfb.lod_solvers, rig.lod_count, placer, rbf.lod_solvers);
  return Status::kOk;
}

Status fill_rbf(const dna::DnaView& view, Arena& scratch, Rig& rig, Error& error) {
  RbfTable& rbf = rig.rbf;
  const Span<uint32_t> writer = scratch.array<uint32_t>(rig.control_count);
  if (rig.control_count && !writer.data) {
    return fail(error, Status::kMemory, kNoOffset, "no memory to compile RBF solvers");
  }
  uint32_t input = 0, rotation = 0, pose = 0, lane = 0;
  size_t target = 0, inverse = 0;
  for (uint32_t i = 0; i < rbf.solvers.count; ++i) {
    const dna::RbfSolver& from = view.rbfb.solvers[i];
    rbf.solvers[i] = {pose};
    RbfSolverPlan& plan = rbf.plans[i];
    plan = {};
    plan.angle_inputs = static_cast<uint8_t>(angle_inputs(from.distance_method));
    plan.first_input = takes_parts(plan) ? rotation : input;
    plan.input_count = plan_inputs(from);
    plan.first_lane = lane;
    plan.pose_count = from.pose_indices.count;
    plan.first_target = target;
    plan.first_inverse = inverse;
    plan.threshold = from.weight_threshold;
    plan.function = static_cast<uint8_t>(from.function_type);
    plan.interpolative = is_interpolative(from);
    plan.always_normalize = from.normalize_method == 1;
    if (takes_parts(plan)) {
      fill_rotations_of(from, rotation, rbf);
    } else {
      copy_array(from.raw_control_indices.first(plan.input_count),
                 rbf.inputs.slice(input, plan.input_count));
      input += plan.input_count;
    }
    copy_array(from.pose_indices, rbf.poses.slice(pose, plan.pose_count));
    for (uint32_t p = 0; p < plan.pose_count; ++p) {
      const float scale = view.rbfb.poses[from.pose_indices[p]].scale;
      rbf.pose_scales[lane + p] = std::min(std::max(scale, -kMaxScale), kMaxScale);
      rbf.pose_factors[lane + p] = 1.0f;
    }
    plan.first_control = kNoFirstControl;
    fill_targets(from, plan, rbf);
    rotation += parted_rotations(from);
    pose += plan.pose_count;
    lane += padded(plan.pose_count);
    target += target_floats(plan.pose_count, plan.input_count);
    if (plan.interpolative) inverse += size_t{padded(plan.pose_count)} * plan.pose_count;
  }
  // Lanes behind the last rotation read what the last one reads.
  for (uint32_t r = rotation; r < rbf.swings.count; ++r) {
    for (uint32_t k = 0; k < 4; ++k) {
      const size_t block = size_t{r / kBlockLanes} * 4 * kBlockLanes + size_t{k} * kBlockLanes;
      rbf.rotations[block + r % kBlockLanes] = rbf.rotations[block + (rotation - 1) % kBlockLanes];
    }
  }
  fill_poses(view, rbf);
  fill_lod_lists(view.rbfb.lod_solvers, rbf.lod_solvers);
  const Status status = check_work(view, rig, error);
  if (status != Status::kOk) return status;
  if (!fill_radii_and_inverses(view, scratch, rbf)) {
    return fail(error, Status::kMemory, kNoOffset, "no memory to compile RBF solvers");
  }
  find_order(rbf, writer);
  return Status::kOk;
}

void place_twists_and_swings(const dna::DnaView& view, Placer& placer, Rig& rig) {
  const dna::TwistSwingBehavior& twsw = view.twsw;
  size_t outputs = 0;
  for (const dna::Swing& swing : twsw.swings) outputs += swing.output_joint_indices.count;
  for (const dna::Twist& twist : twsw.twists) outputs += twist.output_joint_indices.count;
  const size_t lanes = align_up(outputs, kBlockLanes);
  TwistSwingTable& table = rig.twist_swing;
  // A set-up for each swing and each twist that follows none.
  table.setups = placer.array<TwistSwing>(size_t{twsw.swings.count} + twsw.twists.count);
  table.outputs = placer.array<RotationOutput>(outputs);
  table.blocks_at_lod = placer.array<uint32_t>(rig.lod_count);
  table.inputs = placer.array<uint16_t>(4 * lanes);
  table.lanes = placer.array<float>(kTwistSwingRows * lanes, kBlockAlignment);
}

Status fill_twists_and_swings(const dna::DnaView& view, Arena& scratch, Rig& rig, Error& error) {
  const dna::TwistSwingBehavior& twsw = view.twsw;
  TwistSwingTable& table = rig.twist_swing;

  // A twist follows the first swing with the same inputs, if there is one. Sorting finds them in
  // n log n, whatever a file holds.
  struct KeyedSwing {
    uint64_t key;
    uint32_t swing;
  };
  struct OwnedTwist {
    uint32_t swing, twist;
  };
  Span<KeyedSwing> swings = scratch.array<KeyedSwing>(twsw.swings.count);
  Span<OwnedTwist> twists = scratch.array<OwnedTwist>(twsw.twists.count);
  Span<uint64_t> joint_lods = scratch.array<uint64_t>(rig.joint_count);
  if ((rig.joint_count && !joint_lods.data) || (twsw.swings.count && !swings.data) ||
      (twsw.twists.count && !twists.data)) {
    return fail(error, Status::kMemory, kNoOffset, "no memory to compile twists and swings");
  }
  mark_joint_lods(view, joint_lods);
  for (uint32_t s = 0; s < swings.count; ++s) {
    swings[s] = {input_key(twsw.swings[s].input_control_indices), s};
  }
  const auto before = [](const KeyedSwing& a, const KeyedSwing& b) {
    return a.key != b.key ? a.key < b.key : a.swing < b.swing;
  };
  std::sort(swings.begin(), swings.end(), before);
  for (uint32_t t = 0; t < twists.count; ++t) {
    const uint64_t key = input_key(twsw.twists[t].input_control_indices);
    const KeyedSwing* found =
        std::lower_bound(swings.begin(), swings.end(), KeyedSwing{key, 0}, before);
    const bool owned = found != swings.end() && found->key == key;
    twists[t] = {owned ? found->swing : twsw.swings.count, t};  // those alone come last
  }
  std::sort(twists.begin(), twists.end(), [](const OwnedTwist& a, const OwnedTwist& b) {
    return a.swing != b.swing ? a.swing < b.swing : a.twist < b.twist;
  });

  // Lanes of the outputs that more LODs reach come first.
  uint32_t next_lane[kMaxLods + 1] = {};
  const auto reach_of = [&](uint16_t joint) {
    return std::min(highest_bit(joint_lods[joint]) + 1, kMaxLods);
  };
  const auto count_outputs = [&](const auto& from) {
    const auto& joints = from.output_joint_indices;
    for (uint32_t i = 0; i < joints.count; ++i) ++next_lane[reach_of(joints[i])];
  };
  for (const dna::Swing& swing : twsw.swings) count_outputs(swing);
  for (const dna::Twist& twist : twsw.twists) count_outputs(twist);
  for (uint32_t reach = kMaxLods + 1, lane = 0; reach-- > 0;) {
    if (reach < rig.lod_count) {
      table.blocks_at_lod[reach] = static_cast<uint32_t>(align_up(lane, kBlockLanes)) / kBlockLanes;
    }
    lane += std::exchange(next_lane[reach], lane);
  }

  uint32_t setup_count = 0, output = 0, next = 0;
  const auto add_outputs = [&](const auto& from, const auto& inputs, uint32_t axis, bool has_swing,
                               bool swing) {
    for (uint32_t i = 0; i < from.output_joint_indices.count; ++i) {
      const uint16_t joint = from.output_joint_indices[i];
      const uint32_t lane = next_lane[reach_of(joint)]++;
      table.outputs[output++] = {joint_lods[joint], lane, joint, 0};
      const size_t block = lane / kBlockLanes;
      uint16_t* input = table.inputs.data + block * 4 * kBlockLanes + lane % kBlockLanes;
      for (uint32_t k = 0; k < 4; ++k) input[size_t{k} * kBlockLanes] = inputs[k];
      float* rows = table.lanes.data + block * kTwistSwingRows * kBlockLanes + lane % kBlockLanes;
      rows[size_t{axis} * kBlockLanes] = has_swing ? -1.0f : 1.0f;
      rows[3 * kBlockLanes] = std::min(std::max(from.blend_weights[i], -kMaxBlend), kMaxBlend);
      rows[4 * kBlockLanes] = swing ? 1.0f : 0.0f;
    }
  };
  const auto end_setup = [&](uint32_t first_output) {
    table.setups[setup_count++] = {first_output, output - first_output};
  };
  for (uint32_t s = 0; s < twsw.swings.count; ++s) {
    const dna::Swing& swing = twsw.swings[s];
    const uint32_t first_output = output;
    const auto& inputs = swing.input_control_indices;
    add_outputs(swing, inputs, swing.twist_axis, true, true);
    for (; next < twists.count && twists[next].swing == s; ++next) {
      add_outputs(twsw.twists[twists[next].twist], inputs, swing.twist_axis, true, false);
    }
    end_setup(first_output);
  }
  for (; next < twists.count; ++next) {
    const dna::Twist& twist = twsw.twists[twists[next].twist];
    const uint32_t first_output = output;
    add_outputs(twist, twist.input_control_indices, twist.twist_axis, false, false);
    end_setup(first_output);
  }
  table.setups.count = setup_count;
  // The padding of the last block reads the inputs of its first lane.
  for (size_t lane = output; lane % kBlockLanes != 0; ++lane) {
    for (size_t k = 0; k < 4; ++k) {
      uint16_t* inputs = table.inputs.data + (lane / kBlockLanes * 4 + k) * kBlockLanes;
      inputs[lane % kBlockLanes] = inputs[0];
    }
  }
  return Status::kOk;
}

}  // namespace mien
