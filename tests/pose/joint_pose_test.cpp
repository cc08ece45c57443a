// SPDX-License-Identifier: MIT
// Joint values -> local transforms, model and skin matrices.
#include "runtime/pose/joint_pose.h"

#include <cmath>

#include "tests/support/deform_rig.h"

namespace mien {
namespace {

/// Largest difference of 16 floats per joint, column by column, and matrices.
double difference(Span<const float> made, const std::vector<Matrix4d>& expected) {
  EXPECT_EQ(made.count, expected.size() * 16);
  double largest = 0;
  for (size_t j = 0; j < expected.size() && j * 16 < made.count; ++j) {
    for (size_t r = 0; r < 4; ++r) {
      for (size_t c = 0; c < 4; ++c) {
        const double error = std::fabs(made[j * 16 + c * 4 + r] - expected[j][r][c]);
        if (!(error <= largest)) largest = error;
      }
    }
  }
  return largest;
}

struct Case {
  uint32_t rotation, compose;
};
constexpr Case kCases[] = {{MIEN_ROTATION_OUTPUT_EULER, MIEN_COMPOSE_PRODUCT},
                           {MIEN_ROTATION_OUTPUT_EULER, MIEN_COMPOSE_EULER_ADD},
                           {MIEN_ROTATION_OUTPUT_QUATERNION, MIEN_COMPOSE_PRODUCT}};

struct Joints : Deformed {
  PlainDeformer plain;

  Joints(const std::vector<uint8_t>& file, const Case& c)
      : Deformed(file, desc(c), c.rotation), plain{dna->view} {
    plain.quaternions = c.rotation == MIEN_ROTATION_OUTPUT_QUATERNION;
    plain.add_angles = c.compose == MIEN_COMPOSE_EULER_ADD;
  }
  static MienDeformerDesc desc(const Case& c) {
    MienDeformerDesc result = {};
    result.compose = c.compose;
    return result;
  }
};

TEST(JointPose, MatricesInEveryConvention) {
  for (uint32_t sequence = 0; sequence < 6; ++sequence) {
    for (uint32_t signs = 0; signs < 8; ++signs) {
      DeformRigOptions options;
      options.joints = 37;  // two whole blocks of lanes and some more
      options.rotation_sequence = sequence;
      options.rotation_unit = signs % 2;
      for (uint32_t k = 0; k < 3; ++k) options.rotation_signs[k] = signs >> k & 1 ? -1 : 1;
      const std::vector<uint8_t> file = random_deform_rig(sequence * 8 + signs, options);
      for (const Case& c : kCases) {
        SCOPED_TRACE(testing::Message() << "sequence " << sequence << " signs " << signs
                                        << " rotation " << c.rotation << " compose " << c.compose);
        Joints joints(file, c);
        const DeformValues values = random_values(joints.rig.get(), signs);
        joints.update(values);
        EXPECT_LE(difference(joints.matrices(), joints.plain.models(values.joints)), 3e-5);
        EXPECT_LE(difference(joints.skins(), joints.plain.skins(values.joints)), 1e-4);
      }
    }
  }
}

TEST(JointPose, BindMatricesAndTheirInverses) {
  for (const Case& c : kCases) {
    Joints joints(random_deform_rig(1, {}), c);
    MienFloatView bind = {}, inverse = {};
    ASSERT_EQ(mien_deformer_bind_matrices(joints.deformer.get(), &bind), MIEN_OK);
    ASSERT_EQ(mien_deformer_inverse_bind_matrices(joints.deformer.get(), &inverse), MIEN_OK);
    DeformValues values = random_values(joints.rig.get(), 0);
    for (size_t i = 0; i < values.joints.size(); ++i) {
      values.joints[i] = joints.plain.quaternions && i % 10 == 6 ? 1 : 0;
    }
    EXPECT_LE(difference({bind.data, bind.count}, joints.plain.models(values.joints)), 3e-6);
    // An instance is created in the neutral pose.
    EXPECT_LE(largest_difference(joints.matrices(), {bind.data, bind.count}), 5e-6);
    for (size_t j = 0; j < bind.count; j += 16) {
      for (size_t r = 0; r < 4; ++r) {
        for (size_t k = 0; k < 4; ++k) {
          double sum = 0;
          for (size_t i = 0; i < 4; ++i)
            sum += double(bind.data[j + i * 4 + r]) * inverse.data[j + k * 4 + i];
          EXPECT_NEAR(sum, r == k, 5e-6);
        }
      }
    }
  }
}

// The two rules are one where the neutral rotation is zero, and differ elsewhere.
TEST(JointPose, RulesOfComposition) {
  for (double angles : {0.0, 60.0}) {
    DeformRigOptions options;
    options.neutral_angles = angles;
    const std::vector<uint8_t> file = random_deform_rig(1, options);
    Joints product(file, kCases[0]), sum(file, kCases[1]);
    const DeformValues values = random_values(product.rig.get(), 2);
    product.update(values);
    sum.update(values);
    const double apart = largest_difference(product.matrices(), sum.matrices());
    if (angles == 0) {
      EXPECT_LE(apart, 1e-5);
    } else {
      EXPECT_GT(apart, 0.05);
    }
  }
}

TEST(JointPose, LocalTransformsMakeTheMatrices) {
  for (const Case& c : kCases) {
    Joints joints(random_deform_rig(4, {}), c);
    const DeformValues values = random_values(joints.rig.get(), 5);
    joints.update(values);
    const uint32_t count = count_of(joints.rig, MIEN_KIND_JOINT);
    std::vector<float> locals(count * 10 + 1, -7.0f);
    ASSERT_EQ(mien_deformer_instance_local_transforms(joints.instance.get(), locals.data(),
                                                      locals.size()),
              MIEN_OK);
    EXPECT_EQ(locals.back(), -7);
    MienIndex16View parents = {};
    ASSERT_EQ(mien_rig_joint_parents(joints.rig.get(), &parents), MIEN_OK);
    for (uint32_t j = 0; j < count; ++j) {
      const float* l = locals.data() + j * 10;
      EXPECT_NEAR(l[3] * l[3] + l[4] * l[4] + l[5] * l[5] + l[6] * l[6], 1, 1e-6);
      // A point in the frame of the joint, by hand, then up the parents.
      Vec3d point = {0.3, -0.7, 1.1};
      for (uint32_t at = j;; at = parents.data[at]) {
        l = locals.data() + at * 10;
        const Vec3d scaled = {point[0] * l[7], point[1] * l[8], point[2] * l[9]};
        const Vec3d axis = {l[3], l[4], l[5]};
        const auto cross = [](const Vec3d& a, const Vec3d& b) {
          return Vec3d{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                       a[0] * b[1] - a[1] * b[0]};
        };
        const Vec3d once = cross(axis, scaled), twice = cross(axis, once);
        for (size_t k = 0; k < 3; ++k)
          point[k] = scaled[k] + 2 * (l[6] * once[k] + twice[k]) + l[k];
        if (parents.data[at] == at) break;
      }
      const float* m = joints.matrices().data + j * 16;
      for (size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(point[k], m[k] * 0.3 - m[4 + k] * 0.7 + m[8 + k] * 1.1 + m[12 + k], 2e-5);
      }
    }
  }
}

TEST(JointPose, QuaternionsOfAnyLength) {
  Joints joints(random_deform_rig(4, {}), kCases[2]);
  DeformValues values = random_values(joints.rig.get(), 5, 0);
  joints.update(values);
  const std::vector<float> expected(joints.matrices().begin(), joints.matrices().end());
  for (float factor : {1e-12f, 3.0f, 1e15f, -1.0f}) {
    DeformValues scaled = values;
    for (size_t i = 0; i < scaled.joints.size(); ++i) {
      if (i % 10 >= 3 && i % 10 < 7) scaled.joints[i] *= factor;
    }
    joints.update(scaled);
    EXPECT_LE(largest_difference(joints.matrices(), span_of(expected)), 1e-5) << factor;
  }
  // Zero reads as the identity.
  DeformValues identity = values, zero = values;
  for (size_t i = 0; i < values.joints.size(); ++i) {
    if (i % 10 >= 3 && i % 10 < 7) {
      identity.joints[i] = i % 10 == 6;
      zero.joints[i] = 0;
    }
  }
  joints.update(identity);
  const std::vector<float> still(joints.matrices().begin(), joints.matrices().end());
  joints.update(zero);
  EXPECT_TRUE(same_bits(joints.matrices(), span_of(still)));
}

TEST(JointPose, WholeTurnsChangeNothing) {
  for (uint32_t unit : {0u, 1u}) {
    DeformRigOptions options;
    options.rotation_unit = unit;
    for (const Case& c : {kCases[0], kCases[1]}) {
      Joints joints(random_deform_rig(4, options), c);
      const DeformValues values = random_values(joints.rig.get(), 5);
      joints.update(values);
      const std::vector<float> expected(joints.skins().begin(), joints.skins().end());
      for (int turns : {1, -1, 5, 1000}) {
        DeformValues more = values;
        for (size_t i = 0; i < more.joints.size(); ++i) {
          const float angle = unit == 0 ? 360.0f : 6.28318531f;
          if (i % 9 >= 3 && i % 9 < 6) more.joints[i] += turns * angle;
        }
        joints.update(more);
        // What the sum itself loses to rounding.
        EXPECT_LE(largest_difference(joints.skins(), span_of(expected)),
                  turns == 1000 ? 2e-2 : 2e-4);
      }
      // Any finite angle is a rotation.
      for (float angle : {1e8f, 3e38f, -3e38f}) {
        DeformValues huge = values;
        huge.joints[3] = angle;
        joints.update(huge);
        for (float value : joints.matrices()) EXPECT_LT(std::fabs(value), 100);
      }
    }
  }
}

TEST(JointPose, WhatIsNoNumberStaysNoNumber) {
  Joints joints(random_deform_rig(4, {}), kCases[0]);
  DeformValues values = random_values(joints.rig.get(), 5);
  for (float& value : values.joints) value = NAN;
  for (float& value : values.channels) value = NAN;
  joints.update(values);
  joints.deform(0);
  joints.deform(0, MIEN_NORMALS_SKINNED);
  joints.update(random_values(joints.rig.get(), 5));
  joints.deform(0);
  for (float value : joints.positions(0)) EXPECT_TRUE(std::isfinite(value));
}

// Opening refuses circles up to the number of joints that a rig can have; a skeleton does not rely
// on it.
TEST(JointPose, CirclesOfParentsAreRefused) {
  const std::vector<uint8_t> file = random_deform_rig(4, {});
  for (uint32_t length : {2u, 3u, 12u}) {
    const DnaHandle dna = open_dna(file);
    const RigHandle rig = create_rig(dna.get());
    Rig& inside = *capi::object(rig.get());
    for (uint32_t j = 0; j < length; ++j) {
      inside.joint_parents[j] = static_cast<uint16_t>((j + 1) % length);
    }
    MienError error = sized<MienError>();
    MienDeformer* made = nullptr;
    EXPECT_EQ(mien_deformer_create(dna.get(), rig.get(), nullptr, &made, &error),
              MIEN_ERROR_DNA_VALUE);
    EXPECT_EQ(made, nullptr);
    EXPECT_NE(strstr(error.message, "its own ancestor"), nullptr) << error.message;
  }
}

TEST(JointPose, ParentsComeFirst) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    DeformRigOptions options;
    options.joints = 50;
    Deformed d(random_deform_rig(seed, options));
    const Skeleton& skeleton = capi::object(d.deformer.get())->skeleton;
    std::vector<bool> seen(skeleton.joint_count);
    for (uint16_t joint : skeleton.order) {
      const uint16_t parent = skeleton.parents[joint];
      EXPECT_TRUE(parent == joint || seen[parent]);
      EXPECT_FALSE(seen[joint]);
      seen[joint] = true;
    }
  }
}

}  // namespace
}  // namespace mien
