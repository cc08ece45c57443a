// SPDX-License-Identifier: MIT
// Derivatives of local, model and skin matrices by joint values (docs/derivatives.md, 6). A matrix has
// kMatrixParts numbers that may move: three axes and the translation, x y z each.
#include <cmath>

#include "runtime/derive/derive_stages.h"
#include "runtime/derive/dual.h"

namespace mien {
namespace {

constexpr size_t kLocalSlopes = 9 * 4 + 9;  // axes by rotation, axes without scale

const float* lane_of(const Span<float>& rows, size_t row_count, size_t i) {
  return rows.data + i / kBlockLanes * row_count * kBlockLanes + i % kBlockLanes;
}

template <int N>
void set_slopes(const DualQuaternion<N>& q, float* slopes) {
  const Dual<N> one = 1.0;
  const Dual<N> axes[9] = {one - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + q.w * q.z),
                           2.0 * (q.x * q.z - q.w * q.y),       2.0 * (q.x * q.y - q.w * q.z),
                           one - 2.0 * (q.x * q.x + q.z * q.z), 2.0 * (q.y * q.z + q.w * q.x),
                           2.0 * (q.x * q.z + q.w * q.y),       2.0 * (q.y * q.z - q.w * q.x),
                           one - 2.0 * (q.x * q.x + q.y * q.y)};
  for (int a = 0; a < 9; ++a) {
    for (int i = 0; i < 4; ++i) slopes[4 * a + i] = i < N ? saturated(axes[a].by[i]) : 0.0f;
    slopes[36 + a] = static_cast<float>(axes[a].value);
  }
}

/// The part of a local matrix's lanes that joint i has: axis numbers 0 ... 8, translation 9 ... 11.
float local_part(const Derivatives& d, size_t i, size_t part) {
  return lane_of(d.pose.locals, kLocalRows, i)[part * kBlockLanes];
}

}  // namespace

void linearize_pose(Derivatives& d, const Instance& instance) {
  const Skeleton& skeleton = d.deformer->skeleton;
  pose_joints(skeleton, instance.joints.data, d.pose);
  const RotationConvention& convention = skeleton.rotation;
  for (size_t i = 0; i < skeleton.joint_count; ++i) {
    const size_t joint = skeleton.order[i];
    const float* neutral = lane_of(skeleton.neutral, kNeutralRows, i);
    const float* values = instance.joints.data + joint * skeleton.joint_attributes;
    float* slopes = d.local_slopes.data + joint * kLocalSlopes;
    const auto n = [&](size_t k) { return double{neutral[(3 + k) * kBlockLanes]}; };
    if (skeleton.quaternions()) {
      const DualQuaternion<4> delta = made_unit(
          DualQuaternion<4>{Dual<4>::variable(values[3], 0), Dual<4>::variable(values[4], 1),
                            Dual<4>::variable(values[5], 2), Dual<4>::variable(values[6], 3)});
      set_slopes(made_unit(DualQuaternion<4>{n(0), n(1), n(2), n(3)} * delta), slopes);
      continue;
    }
    DualQuaternion<3> q;
    for (const uint8_t axis : convention.axes) {
      const double rest = skeleton.compose == Compose::kEulerAdd
                              ? double{skeleton.neutral_angles[i * 3 + axis]}
                              : 0.0;
      const Dual<3> half = (0.5 * convention.signs[axis] * convention.to_radians) *
                           (Dual<3>(rest) + Dual<3>::variable(values[3 + axis], axis));
      DualQuaternion<3> turn;
      (axis == 0 ? turn.x : axis == 1 ? turn.y : turn.z) = sine(half);
      turn.w = cosine(half);
      q = turn * q;
    }
    set_slopes(made_unit(DualQuaternion<3>{n(0), n(1), n(2), n(3)} * q), slopes);
  }
}

template <uint32_t L>
void push_locals(Derivatives& d) {
  const Skeleton& skeleton = d.deformer->skeleton;
  const uint32_t rotations = skeleton.quaternions() ? 4 : 3;
  std::fill(d.locals.data, d.locals.data + size_t{skeleton.joint_count} * kMatrixParts * L, 0.0f);
  for (size_t i = 0; i < skeleton.joint_count; ++i) {
    const size_t joint = skeleton.order[i];
    const float* slopes = d.local_slopes.data + joint * kLocalSlopes;
    const float* y = d.joints.data + joint * skeleton.joint_attributes * L;
    float* to = d.locals.data + joint * kMatrixParts * L;
    const float* deltas = lane_of(d.pose.deltas, kDeltaRows, i);
    for (size_t a = 0; a < 9; ++a) {
      const size_t c = a / 3;
      const float scale = 1.0f + deltas[(7 + c) * kBlockLanes];
      for (size_t k = 0; k < rotations; ++k) {
        add_scaled<L>(to + a * L, y + (3 + k) * L, slopes[4 * a + k] * scale);
      }
      add_scaled<L>(to + a * L, y + (3 + rotations + c) * L, slopes[36 + a]);
    }
    for (size_t k = 0; k < 3; ++k) add_scaled<L>(to + (9 + k) * L, y + k * L, 1.0f);
  }
}

template <uint32_t L>
void pull_locals(Derivatives& d) {
  const Skeleton& skeleton = d.deformer->skeleton;
  const uint32_t rotations = skeleton.quaternions() ? 4 : 3;
  for (size_t i = 0; i < skeleton.joint_count; ++i) {
    const size_t joint = skeleton.order[i];
    const float* slopes = d.local_slopes.data + joint * kLocalSlopes;
    float* y = d.joints.data + joint * skeleton.joint_attributes * L;
    const float* from = d.locals.data + joint * kMatrixParts * L;
    const float* deltas = lane_of(d.pose.deltas, kDeltaRows, i);
    for (size_t a = 0; a < 9; ++a) {
      const size_t c = a / 3;
      const float scale = 1.0f + deltas[(7 + c) * kBlockLanes];
      for (size_t k = 0; k < rotations; ++k) {
        add_scaled<L>(y + (3 + k) * L, from + a * L, slopes[4 * a + k] * scale);
      }
      add_scaled<L>(y + (3 + rotations + c) * L, from + a * L, slopes[36 + a]);
    }
    for (size_t k = 0; k < 3; ++k) add_scaled<L>(y + k * L, from + (9 + k) * L, 1.0f);
  }
}

// model = model of the parent * local.
template <uint32_t L>
void push_models(Derivatives& d) {
  const Skeleton& skeleton = d.deformer->skeleton;
  for (size_t i = 0; i < skeleton.joint_count; ++i) {
    const size_t joint = skeleton.order[i], parent = skeleton.parents[joint];
    const float* local = d.locals.data + joint * kMatrixParts * L;
    float* to = d.models.data + joint * kMatrixParts * L;
    if (parent == joint) {
      std::copy(local, local + kMatrixParts * L, to);
      continue;
    }
    const float* moved = d.models.data + parent * kMatrixParts * L;
    const float* model = d.pose.model.data + parent * kMatrixFloats;
    std::fill(to, to + kMatrixParts * L, 0.0f);
    for (size_t c = 0; c < 4; ++c) {
      for (size_t r = 0; r < 3; ++r) {
        float* out = to + (3 * c + r) * L;
        for (size_t k = 0; k < 3; ++k) {
          add_scaled<L>(out, moved + (3 * k + r) * L, local_part(d, i, 3 * c + k));
          add_scaled<L>(out, local + (3 * c + k) * L, model[4 * k + r]);
        }
        if (c == 3) add_scaled<L>(out, moved + (9 + r) * L, 1.0f);
      }
    }
  }
}

template <uint32_t L>
void pull_models(Derivatives& d) {
  const Skeleton& skeleton = d.deformer->skeleton;
  std::fill(d.locals.data, d.locals.data + size_t{skeleton.joint_count} * kMatrixParts * L, 0.0f);
  for (size_t i = skeleton.joint_count; i-- > 0;) {
    const size_t joint = skeleton.order[i], parent = skeleton.parents[joint];
    float* local = d.locals.data + joint * kMatrixParts * L;
    const float* from = d.models.data + joint * kMatrixParts * L;
    if (parent == joint) {
      std::copy(from, from + kMatrixParts * L, local);
      continue;
    }
    float* moved = d.models.data + parent * kMatrixParts * L;
    const float* model = d.pose.model.data + parent * kMatrixFloats;
    for (size_t c = 0; c < 4; ++c) {
      for (size_t r = 0; r < 3; ++r) {
        const float* in = from + (3 * c + r) * L;
        for (size_t k = 0; k < 3; ++k) {
          add_scaled<L>(moved + (3 * k + r) * L, in, local_part(d, i, 3 * c + k));
          add_scaled<L>(local + (3 * c + k) * L, in, model[4 * k + r]);
        }
        if (c == 3) add_scaled<L>(moved + (9 + r) * L, in, 1.0f);
      }
    }
  }
}

// skin = model * inverse bind.
template <uint32_t L>
void push_skins(Derivatives& d) {
  const Skeleton& skeleton = d.deformer->skeleton;
  std::fill(d.skins.data, d.skins.data + size_t{skeleton.joint_count} * kMatrixParts * L, 0.0f);
  for (size_t joint = 0; joint < skeleton.joint_count; ++joint) {
    const float* bind = skeleton.inverse_bind.data + joint * kMatrixFloats;
    const float* model = d.models.data + joint * kMatrixParts * L;
    float* to = d.skins.data + joint * kMatrixParts * L;
    for (size_t c = 0; c < 4; ++c) {
      for (size_t k = 0; k < 4; ++k) {
        const float factor = bind[4 * c + k];
        if (factor == 0.0f) continue;
        for (size_t r = 0; r < 3; ++r) {
          add_scaled<L>(to + (3 * c + r) * L, model + (3 * k + r) * L, factor);
        }
      }
    }
  }
}

template <uint32_t L>
void pull_skins(Derivatives& d) {
  const Skeleton& skeleton = d.deformer->skeleton;
  std::fill(d.models.data, d.models.data + size_t{skeleton.joint_count} * kMatrixParts * L, 0.0f);
  for (size_t joint = 0; joint < skeleton.joint_count; ++joint) {
    const float* bind = skeleton.inverse_bind.data + joint * kMatrixFloats;
    float* model = d.models.data + joint * kMatrixParts * L;
    const float* from = d.skins.data + joint * kMatrixParts * L;
    for (size_t c = 0; c < 4; ++c) {
      for (size_t k = 0; k < 4; ++k) {
        const float factor = bind[4 * c + k];
        if (factor == 0.0f) continue;
        for (size_t r = 0; r < 3; ++r) {
          add_scaled<L>(model + (3 * k + r) * L, from + (3 * c + r) * L, factor);
        }
      }
    }
  }
}

#define MIEN_POSE_LANES(L)                    \
  template void push_locals<L>(Derivatives&); \
  template void pull_locals<L>(Derivatives&); \
  template void push_models<L>(Derivatives&); \
  template void pull_models<L>(Derivatives&); \
  template void push_skins<L>(Derivatives&);  \
  template void pull_skins<L>(Derivatives&);
MIEN_POSE_LANES(1)
MIEN_POSE_LANES(kBatchLanes)

}  // namespace mien
