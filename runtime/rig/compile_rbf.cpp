// SPDX-License-Identifier: MIT
// RBF solvers, twists and swings (rig-evaluation 6 and 7).
#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/rig/compile_rig.h"

namespace mien {
namespace {

// Production solvers have some tens of poses. Automatic radii and interpolation take time and
// memory with the square of it and more, so a file must not ask for any number.
constexpr uint32_t kMostPoses = 1024;
constexpr size_t kMostInverseFloats = size_t{4} << 20;

enum Function : uint16_t { kGaussian, kExponential, kLinear, kCubic, kQuintic };

uint32_t padded(uint32_t count) { return static_cast<uint32_t>(align_up(count, kBlockRows)); }

bool is_interpolative(const dna::RbfSolver& solver) { return solver.solver_type == 1; }

/// Distance of two targets. In single precision and in this order because files were made for it:
/// the angle of nearly equal rotations is mostly rounding (rig-evaluation 10).
float target_distance(const RbfTable& rbf, const RbfSolverPlan& s, uint32_t a, uint32_t b) {
  const uint32_t stride = padded(s.pose_count);
  const float* targets = rbf.targets.data + s.first_target + stride;
  const auto at = [&](uint32_t input, uint32_t pose) {
    return targets[size_t{input} * stride + pose];
  };
  float sum = 0;
  if (!s.angular) {
    for (uint32_t i = 0; i < s.input_count; ++i) {
      const float d = at(i, a) - at(i, b);
      sum += d * d;
    }
    return std::sqrt(sum);
  }
  for (uint32_t i = 0; i + 4 <= s.input_count; i += 4) {
    float dot = 0;
    for (uint32_t k = 0; k < 4; ++k) dot += at(i + k, a) * at(i + k, b);
    const float u = dot * dot;
    const float angle = u > 1 ? 0 : std::acos(2 * u - 1);
    sum += angle * angle;
  }
  return std::sqrt(sum);
}

double weight(uint8_t function, double x) {
  switch (function) {
    case kGaussian:
    case kExponential: return std::exp(-x);
    case kLinear: return std::max(0.0, 1 - x);
    case kCubic: return std::max(0.0, 1 - x * x * x);
    default: return std::max(0.0, 1 - x * x * x * x * x);
  }
}

/// The weight functions take distance times this: 1/r^2, 2/r or 1/r.
float distance_scale(uint8_t function, double radius) {
  double scale = 1 / radius;
  if (function == kGaussian) scale /= radius;
  if (function == kExponential) scale *= 2;
  return static_cast<float>(scale);
}

double automatic_radius(const RbfTable& rbf, const RbfSolverPlan& s) {
  double sum = 0;
  for (uint32_t a = 0; a < s.pose_count; ++a) {
    for (uint32_t b = 0; b < a; ++b) sum += target_distance(rbf, s, a, b);
  }
  const double pairs = 0.5 * s.pose_count * (s.pose_count - 1.0);
  return pairs > 0 ? sum / pairs : 0;
}

/// Gauss-Jordan with partial pivoting, in place: `m` is n x 2n, the identity on the right.
/// A column without a pivot gets a tiny one, as the reference does.
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

bool fill_inverse(RbfTable& rbf, const RbfSolverPlan& s, Arena& scratch) {
  const uint32_t n = s.pose_count;
  const size_t width = size_t{n} * 2;
  Span<double> m = scratch.array<double>(n * width);
  if (!m.data && n != 0) return false;
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
      const double v = m[r * width + first + c];
      blocks[(size_t{r / kBlockRows} * n + c) * kBlockRows + r % kBlockRows] =
          std::isfinite(v) ? static_cast<float>(v) : 0.0f;
    }
  }
  return true;
}

/// Floats that the targets of a solver take.
size_t target_floats(uint32_t poses, uint32_t inputs) {
  return size_t{padded(poses)} * (size_t{inputs} + 1);
}

void fill_targets(const dna::RbfSolver& from, const RbfSolver& solver, const RbfSolverPlan& plan,
                  RbfTable& rbf) {
  const uint32_t stride = padded(plan.pose_count);
  float* targets = rbf.targets.data + plan.first_target;
  for (uint32_t p = plan.pose_count; p < stride; ++p) {
    targets[p] = std::numeric_limits<float>::quiet_NaN();
  }
  targets += stride;
  for (uint32_t p = 0; p < plan.pose_count; ++p) {
    const auto value = [&](uint32_t i) {
      return from.raw_control_values[size_t{p} * plan.input_count + i];
    };
    const bool parts = solver.distance == kSwingAngle || solver.distance == kTwistAngle;
    for (uint32_t i = 0; i < plan.input_count; i += parts ? 4 : 1) {
      if (!parts) {
        targets[size_t{i} * stride + p] = value(i);
      } else if (i + 4 <= plan.input_count) {
        const Quaternion q = rotation_part({value(i), value(i + 1), value(i + 2), value(i + 3)},
                                           solver.twist_axis, solver.distance == kSwingAngle);
        const float out[4] = {q.x, q.y, q.z, q.w};
        for (uint32_t k = 0; k < 4; ++k) targets[size_t{i + k} * stride + p] = out[k];
      }
    }
  }
}

/// Pose controls: lists of what each pose drives.
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

/// Finds which solvers may write without looking, and whether all may run side by side.
/// `writer` is zeroed scratch: [control], the last solver found to drive it, counted from 1.
void find_direct_solvers(RbfTable& rbf, const Span<uint32_t>& writer) {
  for (uint32_t s = 0; s < rbf.solvers.count; ++s) {
    RbfSolver& solver = rbf.solvers[s];
    const RbfSolverPlan& plan = rbf.plans[s];
    solver.direct = true;
    for (uint32_t p = 0; p < plan.pose_count; ++p) {
      const uint32_t pose = rbf.poses[solver.first_pose + p];
      solver.direct &= rbf.first_input[pose] == rbf.first_input[pose + 1] &&
                       rbf.first_output[pose] + 1 == rbf.first_output[pose + 1];
      for (uint32_t o = rbf.first_output[pose]; o < rbf.first_output[pose + 1]; ++o) {
        uint32_t& last = writer[rbf.pose_outputs[o]];
        solver.direct &= last != s + 1;
        last = s + 1;
      }
    }
    for (uint32_t p = 0; p < plan.pose_count && solver.direct; ++p) {
      const uint32_t output = rbf.first_output[rbf.poses[solver.first_pose + p]];
      rbf.direct_outputs[plan.first_lane + p] = rbf.pose_outputs[output];
      rbf.pose_factors[plan.first_lane + p] = rbf.pose_weights[output];
    }
  }
  rbf.independent = true;
  for (uint16_t control : rbf.inputs) rbf.independent &= writer[control] == 0;
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
  size_t inputs = 0, poses = 0, lanes = 0, targets = 0, inverses = 0;
  for (uint32_t i = 0; i < solvers.count; ++i) {
    const dna::RbfSolver& solver = solvers[i];
    const uint32_t count = solver.pose_indices.count;
    if (count > kMostPoses) {
      return fail(error, Status::kDnaLimit, view.offset_of(solver.pose_indices.data),
                  "rbfb.solvers[%u].poseIndices: %u poses; a solver may have %u", i, count,
                  kMostPoses);
    }
    inputs += solver.raw_control_indices.count;
    poses += count;
    lanes += padded(count);
    targets += target_floats(count, solver.raw_control_indices.count);
    if (is_interpolative(solver)) inverses += size_t{padded(count)} * count;
  }
  if (inverses > kMostInverseFloats) {
    return fail(error, Status::kDnaLimit, kNoOffset,
                "rbfb.solvers: the interpolative solvers need %zu matrix entries; %zu are allowed",
                inverses, kMostInverseFloats);
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
  rbf.poses = placer.array<uint16_t>(poses);
  rbf.targets = placer.array<float>(targets, kBlockAlignment);
  rbf.inverses = placer.array<float>(inverses, kBlockAlignment);
  rbf.pose_scales = placer.array<float>(lanes, kBlockAlignment);
  rbf.pose_factors = placer.array<float>(lanes, kBlockAlignment);
  rbf.direct_outputs = placer.array<uint16_t>(lanes);
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
  const double to_radians = view.desc.rotation_unit == 0 ? 0.017453292519943295 : 1.0;
  uint32_t input = 0, pose = 0, lane = 0;
  size_t target = 0, inverse = 0;
  for (uint32_t i = 0; i < rbf.solvers.count; ++i) {
    const dna::RbfSolver& from = view.rbfb.solvers[i];
    RbfSolver& solver = rbf.solvers[i];
    solver = {pose, static_cast<uint8_t>(from.distance_method),
              static_cast<uint8_t>(from.twist_axis), false};
    RbfSolverPlan& plan = rbf.plans[i];
    plan = {};
    plan.first_input = input;
    plan.input_count = from.raw_control_indices.count;
    plan.first_lane = lane;
    plan.pose_count = from.pose_indices.count;
    plan.first_target = target;
    plan.first_inverse = inverse;
    plan.threshold = from.weight_threshold;
    plan.function = static_cast<uint8_t>(from.function_type);
    plan.angular = solver.distance != kEuclidean;
    plan.interpolative = is_interpolative(from);
    plan.always_normalize = from.normalize_method == 1;
    copy_array(from.raw_control_indices, rbf.inputs.slice(input, plan.input_count));
    copy_array(from.pose_indices, rbf.poses.slice(pose, plan.pose_count));
    for (uint32_t p = 0; p < plan.pose_count; ++p) {
      rbf.pose_scales[lane + p] = view.rbfb.poses[from.pose_indices[p]].scale;
      rbf.pose_factors[lane + p] = 1.0f;
    }
    fill_targets(from, solver, plan, rbf);
    const bool automatic = from.automatic_radius == 0;
    plan.scale =
        distance_scale(plan.function, automatic ? automatic_radius(rbf, plan)
                                                : static_cast<double>(from.radius) * to_radians);
    if (plan.interpolative && !fill_inverse(rbf, plan, scratch)) {
      return fail(error, Status::kMemory, kNoOffset, "no memory to compile RBF solver %u", i);
    }
    input += plan.input_count;
    pose += plan.pose_count;
    lane += padded(plan.pose_count);
    target += target_floats(plan.pose_count, plan.input_count);
    if (plan.interpolative) inverse += size_t{padded(plan.pose_count)} * plan.pose_count;
  }
  fill_poses(view, rbf);
  find_direct_solvers(rbf, writer);
  fill_lod_lists(view.rbfb.lod_solvers, rbf.lod_solvers);
  return Status::kOk;
}

void place_twists_and_swings(const dna::DnaView& view, Placer& placer, Rig& rig) {
  const dna::TwistSwingBehavior& twsw = view.twsw;
  size_t outputs = 0;
  for (const dna::Swing& swing : twsw.swings) outputs += swing.output_joint_indices.count;
  for (const dna::Twist& twist : twsw.twists) outputs += twist.output_joint_indices.count;
  // A set-up for each swing and each twist that follows none.
  rig.twist_swing.setups = placer.array<TwistSwing>(size_t{twsw.swings.count} + twsw.twists.count);
  rig.twist_swing.outputs = placer.array<TwistSwingOutput>(outputs);
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

  uint32_t setup_count = 0, output = 0, next = 0;
  const auto add_setup = [&](const dna::Array<uint16_t>& inputs, uint16_t axis) {
    TwistSwing setup = {};
    for (uint32_t i = 0; i < 4; ++i) setup.inputs[i] = inputs[i];
    setup.axis = static_cast<uint8_t>(axis);
    return setup;
  };
  const auto add_outputs = [&](const auto& from) {
    for (uint32_t i = 0; i < from.output_joint_indices.count; ++i) {
      const uint16_t joint = from.output_joint_indices[i];
      table.outputs[output++] = {joint_lods[joint], joint, from.blend_weights[i]};
    }
    return from.output_joint_indices.count;
  };
  for (uint32_t s = 0; s < twsw.swings.count; ++s) {
    const dna::Swing& swing = twsw.swings[s];
    TwistSwing setup = add_setup(swing.input_control_indices, swing.twist_axis);
    setup.has_swing = true;
    setup.first_swing = output;
    setup.swing_count = add_outputs(swing);
    setup.first_twist = output;
    for (; next < twists.count && twists[next].swing == s; ++next) {
      setup.twist_count += add_outputs(twsw.twists[twists[next].twist]);
    }
    table.setups[setup_count++] = setup;
  }
  for (; next < twists.count; ++next) {
    const dna::Twist& twist = twsw.twists[twists[next].twist];
    TwistSwing setup = add_setup(twist.input_control_indices, twist.twist_axis);
    setup.first_twist = output;
    setup.twist_count = add_outputs(twist);
    table.setups[setup_count++] = setup;
  }
  table.setups.count = setup_count;
  return Status::kOk;
}

}  // namespace mien
