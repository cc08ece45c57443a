// SPDX-License-Identifier: MIT
#include "integrations/program/commands/solve_joints.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "integrations/program/io/input.h"
#include "integrations/program/io/text.h"
#include "integrations/program/math/vector.h"
#include "integrations/program/mesh/glb_motion.h"

namespace mien::cli {

namespace {

using math::Vec3d;

constexpr size_t kJointWidth = 9;
constexpr double kRadian = 0.017453292519943295;

// A rotation matrix for column vectors, by rows.
using Rotation3 = std::array<double, 9>;

Rotation3 product_of(const Rotation3& a, const Rotation3& b) {
  Rotation3 out = {};
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 3; ++c) {
      for (size_t k = 0; k < 3; ++k) out[3 * r + c] += a[3 * r + k] * b[3 * k + c];
    }
  }
  return out;
}

Rotation3 inverse_of(const Rotation3& m) {
  return {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]};
}

Rotation3 rotation_about(size_t axis, double angle) {
  Rotation3 out = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
  out[3 * a + a] = out[3 * b + b] = std::cos(angle);
  out[3 * b + a] = std::sin(angle);
  out[3 * a + b] = -out[3 * b + a];
  return out;
}

Rotation3 rotation_from(double x, double y, double z, double w) {
  return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
          2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
          2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
}

/// Angles of joints as the rig has them: docs/rig-evaluation.md, "Euler angles and quaternions".
struct JointAngles {
  size_t order[3];
  double parity, unit, signs[3];

  explicit JointAngles(const MienRigInfo& info) {
    constexpr size_t kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                      {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    std::copy_n(kOrders[std::min(info.rotation_sequence, 5u)], 3, order);
    parity = (order[1] + 3 - order[0]) % 3 == 1 ? 1 : -1;
    unit = info.rotation_unit == MIEN_ROTATION_UNIT_RADIANS ? 1 : kRadian;
    std::copy_n(info.rotation_signs, 3, signs);
  }
  Rotation3 rotation(const float* angles) const {
    Rotation3 out = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    for (const size_t axis : order) {
      out = product_of(rotation_about(axis, signs[axis] * unit * double{angles[axis]}), out);
    }
    return out;
  }
  void angles(const Rotation3& m, float* out) const {
    const size_t a = order[0], b = order[1], c = order[2];
    const double middle = std::asin(std::min(std::max(-parity * m[3 * c + a], -1.0), 1.0));
    const double first = std::atan2(parity * m[3 * c + b], m[3 * c + c]);
    const double last = std::atan2(parity * m[3 * b + a], m[3 * a + a]);
    out[a] = static_cast<float>(first * signs[a] / unit);
    out[b] = static_cast<float>(middle * signs[b] / unit);
    out[c] = static_cast<float>(last * signs[c] / unit);
  }
};

/// From nodes, in meters, x to the left, y up and z to the front, to joints of a rig.
struct NodeSpace {
  Vec3d axes[3];  // where x, y and z of the rig point
  double handedness, per_meter;

  explicit NodeSpace(const MienRigInfo& info) {
    // By MIEN_DIRECTION_...
    constexpr Vec3d kNodeDirections[] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                         {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    for (int i = 0; i < 3; ++i) axes[i] = kNodeDirections[info.axes[i]];
    handedness = dot(axes[0], cross(axes[1], axes[2]));
    per_meter = info.translation_unit == MIEN_TRANSLATION_UNIT_METERS ? 1 : 100;
  }
};

/// Joint values of one joint. `neutral` are those of the neutral pose.
void find_joint_values(const NodeTransform& node, const float* neutral, const NodeSpace& space,
                       const JointAngles& angles, float* out) {
  const Vec3d t = {node[0], node[1], node[2]}, q = {node[3], node[4], node[5]};
  const double length = std::sqrt(dot(q, q) + node[6] * node[6]);
  const double scale = length > 0 ? 1 / length : 0;
  double xyz[3];
  for (size_t i = 0; i < 3; ++i) {
    out[i] = static_cast<float>(dot(t, space.axes[i]) * space.per_meter - double{neutral[i]});
    xyz[i] = dot(q, space.axes[i]) * space.handedness * scale;
    double along = 0;  // scale has no sign
    for (int k = 0; k < 3; ++k)
      along += std::fabs(space.axes[i][k]) * node[7 + static_cast<size_t>(k)];
    out[6 + i] = static_cast<float>(along - 1);
  }
  const Rotation3 local = rotation_from(xyz[0], xyz[1], xyz[2], node[6] * scale);
  // local = neutral * delta
  angles.angles(product_of(inverse_of(angles.rotation(neutral + 3)), local), out + 3);
}

}  // namespace

SolveTarget read_glb_joints(const TargetOptions& options, const SolvedRig& rig,
                            const Session& session) {
  const std::string shown = shown_name(options.path);
  const auto motion = std::make_shared<GlbMotion>(
      read_glb_motion(read_any_bytes(options.path, "cannot read target"), options.path));
  const MienRigInfo info = rig_info(rig.rig);
  const uint32_t count = rig_count(rig.rig, MIEN_KIND_JOINT);
  if (info.joint_value_count != count * kJointWidth) {
    fail(kInvalid, "cannot solve", rig.shown, "its joints have quaternions",
         "bake it with Euler angles, or give the DNA file");
  }
  std::map<std::string, uint32_t> nodes;
  for (uint32_t n = 0; n < motion->names.size(); ++n) nodes.emplace(motion->names[n], n);
  auto node_of = std::make_shared<std::vector<int64_t>>(count, -1);
  std::vector<float> weights;
  uint32_t missing = 0;
  for (uint32_t j = 0; j < count; ++j) {
    const auto found = nodes.find(rig_name(rig.rig, MIEN_KIND_JOINT, j));
    if (found != nodes.end()) (*node_of)[j] = found->second;
    missing += found == nodes.end();
    weights.insert(weights.end(), kJointWidth, found == nodes.end() ? 0.0f : 1.0f);
  }
  if (missing == count) {
    fail(kInvalid, "cannot solve", shown, "no node has the name of a joint of the rig",
         "'mien info RIG --names joints' lists the names");
  }
  if (missing != 0) {
    note(session, one_line(shown) + " has no nodes for " + grouped(missing) + " of " +
                      grouped(count) + " joints; they are missing");
  }
  MienFloatView view = {};
  check(mien_rig_neutral_joint_values(rig.rig, &view), nullptr, "cannot solve", rig.shown);
  const auto neutral = std::make_shared<std::vector<float>>(view.data, view.data + view.count);
  SolveTarget target;
  target.frame_count = motion->times.size();
  target.width = count * kJointWidth;
  if (missing != 0) target.weights = weights;
  if (target.frame_count > 1) target.rate = find_rate({motion->times, 1e-5});
  target.read = [=, space = NodeSpace(info), angles = JointAngles(info)](size_t frame, float* row) {
    const std::vector<NodeTransform> pose = sample_motion(*motion, motion->times[frame]);
    for (size_t j = 0; j < node_of->size(); ++j) {
      float* const out = row + j * kJointWidth;
      const int64_t node = (*node_of)[j];
      if (node < 0) {
        std::fill_n(out, kJointWidth, NAN);
      } else {
        find_joint_values(pose[static_cast<size_t>(node)], neutral->data() + j * kJointWidth, space,
                          angles, out);
      }
    }
  };
  return target;
}

}  // namespace mien::cli
