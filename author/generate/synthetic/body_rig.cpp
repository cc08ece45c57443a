// SPDX-License-Identifier: MIT
// The body as definition and behavior.
#include <cmath>

#include "author/generate/synthetic/body.h"

namespace mien::synthetic {
namespace {

// A solver for each driver, and a second one for the first drivers: production bodies have this many.
constexpr uint32_t kSolverCount = 72, kPoseCount = 670;
constexpr uint32_t kMaxJoints = 8;  // corrective joints of a driver

enum BodyStream : uint64_t { kPoseStream = 2000, kRowStream, kBlendStream };

struct Rotation {
  double parts[4];  // x y z w
};

// Of unit length. Square roots are the same everywhere; sines are not.
Rotation draw_rotation(Random& random, double size) {
  Rotation r = {{random.normal() * size, random.normal() * size, random.normal() * size, 1}};
  double length = 0;
  for (double part : r.parts) length += part * part;
  length = std::sqrt(length);
  for (double& part : r.parts) part /= length;
  return r;
}

struct BodyRigMaker {
  const Body& body;
  uint64_t seed;
  Arena& arena;
  dna::DnaView& out;
  uint32_t first_pose_control;

  uint32_t driver_count() const { return static_cast<uint32_t>(body.drivers.count); }
  uint32_t driver_of(uint32_t solver) const { return solver % driver_count(); }
  uint32_t solvers_of(uint32_t driver) const {
    return driver + driver_count() < kSolverCount ? 2 : 1;
  }
  static uint32_t poses_of(uint32_t solver) {
    return kPoseCount / kSolverCount + (solver < kPoseCount % kSolverCount ? 1 : 0);
  }
  uint32_t first_pose_of(uint32_t solver) const {
    uint32_t first = 0;
    for (uint32_t s = 0; s < solver; ++s) first += poses_of(s);
    return first;
  }

  /// The solver that moves a corrective joint; its joint group has the same number.
  uint32_t solver_of(const BodyJoint& joint) const {
    return joint.driver + joint.ordinal % solvers_of(joint.driver) * driver_count();
  }

  bool fill_definition() {
    dna::Definition& defn = out.defn;
    const size_t count = body.joints.count;
    dna::NewArray<uint16_t> parents;
    dna::NewArray<float> xs, ys, zs, zeros;
    if (!make(arena, count, defn.joint_names) || !make(arena, count, parents) ||
        !make(arena, count, xs) || !make(arena, count, ys) || !make(arena, count, zs) ||
        !make(arena, count, zeros) ||
        !make(arena, 4 * body.drivers.count, defn.raw_control_names)) {
      return false;
    }
    for (size_t j = 0; j < count; ++j) {
      const BodyJoint& joint = body.joints[j];
      const Vec3 way = joint.position - body.joints[joint.parent].position;
      defn.joint_names[j] = joint.name;
      parents.set(j, joint.parent);
      xs.set(j, static_cast<float>(way.x));
      ys.set(j, static_cast<float>(way.y));
      zs.set(j, static_cast<float>(way.z));
      zeros.set(j, 0.0f);
    }
    defn.joint_hierarchy = parents;
    defn.neutral_translations = {xs, ys, zs};
    defn.neutral_rotations = {zeros, zeros, zeros};
    for (size_t d = 0; d < body.drivers.count; ++d) {
      const dna::String& name = body.joints[body.drivers[d].joint].name;
      const char* const parts[] = {".qx", ".qy", ".qz", ".qw"};
      for (size_t part = 0; part < 4; ++part) {
        if (!copy_text(arena, Text().add(name).add(parts[part]),
                       defn.raw_control_names[4 * d + part])) {
          return false;
        }
      }
    }
    auto in_lod = [this](size_t lod, size_t joint) { return body.joint_in_lod(joint, lod); };
    auto nothing = [](size_t, size_t) { return false; };
    return make_lod_map(arena, kBodyLodCount, count, in_lod, defn.lod_joints) &&
           make_lod_map(arena, kBodyLodCount, 0, nothing, defn.lod_channels) &&
           make_lod_map(arena, kBodyLodCount, 0, nothing, defn.lod_maps);
  }

  bool make_zero_lods(dna::Array<uint16_t>& to) {
    dna::NewArray<uint16_t> lods;
    if (!make(arena, kBodyLodCount, lods)) return false;
    for (size_t l = 0; l < kBodyLodCount; ++l) lods.set(l, uint16_t{0});
    to = lods;
    return true;
  }

  // Joint groups ------------------------------------------------------------------------------

  /// Corrective joints of a group, those of the coarsest LODs first.
  uint32_t find_joints(uint32_t group, uint16_t (&joints)[kMaxJoints]) const {
    uint32_t count = 0;
    for (uint16_t ordinal = 0; ordinal < kMaxJoints; ++ordinal) {
      for (size_t j = body.base_count; j < body.joints.count; ++j) {
        const BodyJoint& joint = body.joints[j];
        if (joint.kind != BodyJointKind::kCorrective || joint.ordinal != ordinal) continue;
        if (solver_of(joint) == group) joints[count++] = static_cast<uint16_t>(j);
      }
    }
    return count;
  }

  bool fill_group(uint32_t number, Random& random, dna::JointGroup& group) {
    uint16_t joints[kMaxJoints];
    uint16_t attributes[kMaxJoints];
    const uint32_t joint_count = find_joints(number, joints);
    uint32_t rows = 0;
    for (uint32_t j = 0; j < joint_count; ++j) {
      attributes[j] = 0x3F;  // translation and rotation, and scale for some
      for (int k = 6; k < 9; ++k) attributes[j] |= (random.chance(0.4) ? 1 : 0) << k;
      for (uint32_t bits = attributes[j]; bits; bits &= bits - 1) ++rows;
    }
    // The first pose is the rest pose: it moves nothing.
    const uint32_t columns = poses_of(number) - 1, first = first_pose_of(number) + 1;
    dna::NewArray<uint16_t> lods, inputs, outputs, members;
    dna::NewArray<float> values;
    if (!make(arena, kBodyLodCount, lods) || !make(arena, columns, inputs) ||
        !make(arena, rows, outputs) || !make(arena, joint_count, members) ||
        !make(arena, size_t{rows} * columns, values)) {
      return false;
    }
    for (uint32_t c = 0; c < columns; ++c) {
      inputs.set(c, static_cast<uint16_t>(first_pose_control + first + c));
    }
    uint32_t at_lod[kBodyLodCount] = {}, row = 0;
    for (uint32_t j = 0; j < joint_count; ++j) {
      members.set(j, joints[j]);
      for (uint32_t k = 0; k < 9; ++k) {
        if (!(attributes[j] >> k & 1)) continue;
        outputs.set(row, static_cast<uint16_t>(9 * joints[j] + k));
        const double deviation = k < 3 ? 0.8 : k < 6 ? 9.0 : 0.08;  // cm, degrees, factor
        for (uint32_t c = 0; c < columns; ++c) {
          const double delta = random.chance(0.85) ? random.normal() * deviation : 0.0;
          values.set(row * columns + c, static_cast<float>(delta));
        }
        ++row;
      }
      for (size_t l = 0; l < kBodyLodCount; ++l) {
        if (body.joint_in_lod(joints[j], l)) at_lod[l] = row;
      }
    }
    for (size_t l = 0; l < kBodyLodCount; ++l) lods.set(l, static_cast<uint16_t>(at_lod[l]));
    group = {lods, inputs, outputs, values, members};
    return true;
  }

  bool fill_behavior() {
    dna::Behavior& bhvr = out.bhvr;
    bhvr.joints.row_count = static_cast<uint16_t>(9 * body.joints.count);
    bhvr.joints.col_count = static_cast<uint16_t>(first_pose_control + kPoseCount);
    if (!make(arena, kSolverCount, bhvr.joints.groups)) return false;
    Random random = Random::from_seed(seed, kRowStream);
    for (uint32_t g = 0; g < kSolverCount; ++g) {
      if (!fill_group(g, random, bhvr.joints.groups[g])) return false;
    }
    return make_zero_lods(bhvr.channels.lods) && make_zero_lods(bhvr.maps.lods);
  }

  // RBF ---------------------------------------------------------------------------------------

  /// All distance functions, with one quaternion or together with that of the parent's driver.
  bool fill_solver(uint32_t number, Random& random, dna::RbfSolver& solver) {
    const uint32_t driver = driver_of(number), poses = poses_of(number);
    const uint32_t distance = number % 4;
    const bool two = distance == 1 && driver > 0 && number % 12 == 1;
    const uint32_t inputs = two ? 8 : 4;
    dna::NewArray<uint16_t> controls, indices;
    dna::NewArray<float> values;
    if (!make(arena, inputs, controls) || !make(arena, poses, indices) ||
        !make(arena, size_t{poses} * inputs, values)) {
      return false;
    }
    for (uint32_t i = 0; i < inputs; ++i) {
      controls.set(i, static_cast<uint16_t>(4 * (i < 4 ? driver : driver - 1) + i % 4));
    }
    for (uint32_t p = 0; p < poses; ++p) {
      indices.set(p, static_cast<uint16_t>(first_pose_of(number) + p));
      for (uint32_t i = 0; i < inputs; i += 4) {
        const Rotation r = p == 0 ? Rotation{{0, 0, 0, 1}} : draw_rotation(random, 0.4);
        for (uint32_t part = 0; part < 4; ++part) {
          values.set(p * inputs + i + part, static_cast<float>(r.parts[part]));
        }
      }
    }
    const bool second = number >= driver_count();
    Text name = Text().add(body.joints[body.drivers[driver].joint].name);
    name.add(second ? "_fine_solver" : "_solver");
    if (!copy_text(arena, name, solver.name)) return false;
    solver.raw_control_indices = controls;
    solver.pose_indices = indices;
    solver.raw_control_values = values;
    solver.radius = static_cast<float>(random.between(40, 70));
    solver.weight_threshold = 0.001f;
    solver.solver_type = number / 4 % 2;
    solver.automatic_radius = number / 8 % 2;
    solver.distance_method = static_cast<uint16_t>(distance);
    solver.normalize_method = number / 2 % 2;
    solver.function_type = number % 5;
    solver.twist_axis = body.drivers[driver].axis;
    return true;
  }

  bool fill_pose(uint32_t solver, uint32_t ordinal, Random& random) {
    const uint32_t pose = first_pose_of(solver) + ordinal, driver = driver_of(solver);
    dna::NewArray<uint16_t> inputs, outputs;
    dna::NewArray<float> weights;
    // A few poses only count while another joint is near its rest pose.
    const bool depends = ordinal != 0 && random.chance(0.04);
    if (!make(arena, depends ? 1 : 0, inputs) || !make(arena, 1, outputs) ||
        !make(arena, 1, weights)) {
      return false;
    }
    if (depends) inputs.set(0, static_cast<uint16_t>(4 * ((driver + 1) % driver_count()) + 3));
    outputs.set(0, static_cast<uint16_t>(first_pose_control + pose));
    weights.set(0, 1.0f);
    const dna::String& joint = body.joints[body.drivers[driver].joint].name;
    Text name = Text().add(joint).add(solver < driver_count() ? "_pose_" : "_fine_pose_");
    if (!copy_text(arena, name.add(uint64_t{ordinal} + 1), out.rbfb.poses[pose].name)) return false;
    out.rbfb.poses[pose].scale = 1.0f;
    out.rbfe.pose_control_names[pose] = out.rbfb.poses[pose].name;
    out.rbfe.poses[pose] = {inputs, outputs, weights};
    return true;
  }

  bool fill_rbf() {
    dna::RbfBehavior& rbfb = out.rbfb;
    if (!make(arena, kSolverCount, rbfb.solvers) || !make(arena, kPoseCount, rbfb.poses) ||
        !make(arena, kPoseCount, out.rbfe.pose_control_names) ||
        !make(arena, kPoseCount, out.rbfe.poses)) {
      return false;
    }
    Random random = Random::from_seed(seed, kPoseStream);
    for (uint32_t s = 0; s < kSolverCount; ++s) {
      if (!fill_solver(s, random, rbfb.solvers[s])) return false;
      for (uint32_t p = 0; p < poses_of(s); ++p) {
        if (!fill_pose(s, p, random)) return false;
      }
    }
    // Without corrective joints there is nothing to solve.
    auto in_lod = [this](size_t lod, size_t solver) {
      return out.bhvr.joints.groups[solver].lods[lod] != 0;
    };
    return make_lod_map(arena, kBodyLodCount, kSolverCount, in_lod, rbfb.lod_solvers);
  }

  // Joints that follow ------------------------------------------------------------------------

  bool fill_metadata() {
    if (!make(arena, body.joints.count, out.jbmd.joints)) return false;
    for (size_t j = 0; j < body.joints.count; ++j) {
      const bool turns = body.joints[j].kind == BodyJointKind::kCorrective && j % 6 != 0;
      out.jbmd.joints[j].rotation = turns ? 1 : 0;
    }
    return true;
  }

  template <class Setup>
  bool fill_setup(uint16_t driver, BodyJointKind kind, uint32_t count, Random& random,
                  Setup& setup) {
    dna::NewArray<float> weights;
    dna::NewArray<uint16_t> joints, inputs;
    if (!make(arena, count, weights) || !make(arena, count, joints) || !make(arena, 4, inputs)) {
      return false;
    }
    uint32_t at = 0;
    for (size_t j = body.base_count; j < body.joints.count; ++j) {
      const BodyJoint& joint = body.joints[j];
      if (joint.kind != kind || joint.driver != driver) continue;
      const double share = (joint.ordinal + 1.0) / (count + 1.0);
      weights.set(at, static_cast<float>(share + random.between(-0.1, 0.1)));
      joints.set(at++, static_cast<uint16_t>(j));
    }
    for (uint32_t part = 0; part < 4; ++part) {
      inputs.set(part, static_cast<uint16_t>(4 * driver + part));
    }
    setup = {weights, joints, inputs, body.drivers[driver].axis};
    return true;
  }

  bool fill_twists_and_swings() {
    uint32_t twists = 0, swings = 0;
    for (const BodyDriver& driver : body.drivers) {
      twists += driver.twists != 0;
      swings += driver.swings != 0;
    }
    if (!make(arena, twists, out.twsw.twists) || !make(arena, swings, out.twsw.swings))
      return false;
    Random random = Random::from_seed(seed, kBlendStream);
    uint32_t twist = 0, swing = 0;
    for (uint16_t d = 0; d < body.drivers.count; ++d) {
      const BodyDriver& driver = body.drivers[d];
      if (driver.twists != 0 &&
          !fill_setup(d, BodyJointKind::kTwist, driver.twists, random, out.twsw.twists[twist++])) {
        return false;
      }
      if (driver.swings != 0 &&
          !fill_setup(d, BodyJointKind::kSwing, driver.swings, random, out.twsw.swings[swing++])) {
        return false;
      }
    }
    return true;
  }
};

}  // namespace

bool make_body_rig(uint64_t seed, uint32_t ml_control_count, Arena& arena, dna::DnaView& out) {
  Body body;
  if (!make_body(arena, body)) return false;
  const uint32_t raw_count = 4 * static_cast<uint32_t>(body.drivers.count);
  BodyRigMaker maker{body, seed, arena, out, raw_count + ml_control_count};
  return maker.fill_definition() && maker.fill_behavior() && maker.fill_rbf() &&
         maker.fill_metadata() && maker.fill_twists_and_swings() &&
         make_body_meshes(body, arena, out);
}

}  // namespace mien::synthetic
