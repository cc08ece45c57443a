// SPDX-License-Identifier: MIT
#include "runtime/probe/probe_gaze.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace mien {
namespace {

constexpr double kLeastTangent = 0.05;  // about three degrees
constexpr double kMaxAcross = 0.35;     // of the tangent in the direction itself

struct Eye {
  Vec3 left, up, front, center;  // center of the neutral pose, in the rig's unit
  uint32_t joint;
};

/// To the left, up and to the front.
Vec3 direction_of(const RigProbe& probe, const Eye& eye) {
  const Vec3 d =
      probe.skinned(eye.joint, eye.center + eye.front) - probe.skinned(eye.joint, eye.center);
  return {dot(d, eye.left), dot(d, eye.up), dot(d, eye.front)};
}

/// Tangents to the left and up, each from where the eye looks straight ahead in the other.
void tangents_of(Vec3 d, bool yaw_first, double& across, double& above) {
  across = d.x / (yaw_first ? std::sqrt(d.y * d.y + d.z * d.z) : d.z);
  above = d.y / (yaw_first ? d.z : std::sqrt(d.x * d.x + d.z * d.z));
}

void pose(RigProbe& probe, std::initializer_list<uint16_t> controls, float value) {
  probe.clear();
  for (uint16_t c : controls) probe.set(c, value);
  probe.pose();
}

/// The tangent of a direction; the component across it goes to `aside`.
double part_of(Vec3 d, uint32_t direction, double& aside) {
  if (!(d.z > 0)) return 0;
  const double across = d.x / d.z, above = d.y / d.z;
  aside = std::fabs(direction < kGazeUp ? above : across);
  const double sign = direction % 2 == 0 ? 1 : -1;
  return sign * (direction < kGazeUp ? across : above);
}

/// The error in degrees between where the eye looks and where the table says, with two controls at a value.
double miss(RigProbe& probe, const Eye& eye, const GazeEye& table, uint32_t horizontal,
            uint32_t vertical, uint32_t step, bool yaw_first) {
  pose(probe, {table.curves[horizontal], table.curves[vertical]},
       static_cast<float>(step + 1) / kGazeSteps);
  double across, above;
  tangents_of(direction_of(probe, eye), yaw_first, across, above);
  const double x = std::fabs(across) - double{table.tangents[horizontal][step]};
  const double y = std::fabs(above) - double{table.tangents[vertical][step]};
  return 57.29577951308232 * std::sqrt(x * x + y * y);
}

}  // namespace

Status probe_gaze(const Deformer& deformer, const uint32_t (&eyes)[2], const Allocator& allocator,
                  GazeTable& out, Error& error) {
  const Rig& rig = *deformer.rig;
  out = GazeTable();
  for (uint32_t joint : eyes) {
    if (joint < rig.joint_count) continue;
    return fail(error, Status::kIndex, kNoOffset, "joint %u of %u", joint, rig.joint_count);
  }
  RigProbe probe(deformer, allocator);
  if (!probe.ready()) return fail(error, Status::kMemory, kNoOffset, "no memory to probe the gaze");
  Eye measured[2];
  for (uint32_t e = 0; e < 2; ++e) {
    const float* at = deformer.skeleton.bind.data + size_t{eyes[e]} * kMatrixFloats + 12;
    Eye& eye = measured[e];
    eye = {probe.axis(0), probe.axis(2), probe.axis(4), {at[0], at[1], at[2]}, eyes[e]};
    GazeEye& table = out.eyes[e];
    const Vec3 center = eye.center * probe.millimeters();
    table.center[0] = static_cast<float>(dot(center, eye.left));
    table.center[1] = static_cast<float>(dot(center, eye.up));
    table.center[2] = static_cast<float>(dot(center, eye.front));

    double best[4] = {};
    for (uint16_t c = 0; c < rig.raw_count; ++c) {
      pose(probe, {c}, 1);
      const Vec3 d = direction_of(probe, eye);
      for (uint32_t way = 0; way < 4; ++way) {
        double aside = 0;
        const double tangent = part_of(d, way, aside);
        if (tangent < kLeastTangent || aside > kMaxAcross * tangent || tangent <= best[way])
          continue;
        best[way] = tangent;
        table.curves[way] = c;
      }
    }
    for (uint32_t way = 0; way < 4; ++way) {
      static constexpr const char* kNames[] = {"left", "right", "up", "down"};
      float before = 0;
      for (uint32_t i = 0; i < kGazeSteps && best[way] > 0; ++i) {
        pose(probe, {table.curves[way]}, static_cast<float>(i + 1) / kGazeSteps);
        double aside = 0;
        const float tangent = static_cast<float>(part_of(direction_of(probe, eye), way, aside));
        if (!(tangent > before)) best[way] = 0;
        before = table.tangents[way][i] = tangent;
      }
      if (best[way] > 0) continue;
      out = GazeTable();
      return fail(error, Status::kInvalidArgument, kNoOffset,
                  "no raw control turns eye %u %s, farther with each step", e, kNames[way]);
    }
  }
  // Which of the two rotations carries the axis of the other: the order that fits better.
  double worst[2] = {};
  for (uint32_t order = 0; order < 2; ++order) {
    for (uint32_t e = 0; e < 2; ++e) {
      for (uint32_t horizontal : {kGazeLeft, kGazeRight}) {
        for (uint32_t vertical : {kGazeUp, kGazeDown}) {
          for (uint32_t step : {kGazeSteps / 2 - 1, kGazeSteps - 1}) {
            worst[order] = std::max(worst[order], miss(probe, measured[e], out.eyes[e], horizontal,
                                                       vertical, step, order == 1));
          }
        }
      }
    }
  }
  out.yaw_first = worst[1] < worst[0];
  out.fit_error = static_cast<float>(worst[out.yaw_first]);
  return Status::kOk;
}

Status create_gaze(const Deformer& deformer, const uint32_t (&eyes)[2], const Allocator& allocator,
                   Gaze*& out, Error& error) {
  out = nullptr;
  GazeTable table;
  const Status status = probe_gaze(deformer, eyes, allocator, table, error);
  if (status != Status::kOk) return status;
  out = create_object<Gaze>(allocator, [](Placer&, Gaze&) {});
  if (!out) return fail(error, Status::kMemory, kNoOffset, "no memory for a gaze");
  out->raw_count = deformer.rig->raw_count;
  out->table = table;
  return status;
}

bool find_eyes(const Rig& rig, uint32_t (&eyes)[2]) {
  eyes[0] = find_joint(rig, {"L_Eye", "FACIAL_L_Eye", "eye_l"});
  eyes[1] = find_joint(rig, {"R_Eye", "FACIAL_R_Eye", "eye_r"});
  return eyes[0] != kNoJoint && eyes[1] != kNoJoint;
}

}  // namespace mien
