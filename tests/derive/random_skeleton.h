// SPDX-License-Identifier: MIT
// Random joints and meshes in a random pose, with their derivatives.
#pragma once

#include "tests/derive/derivatives_handle.h"
#include "tests/support/deform_rig.h"

namespace mien {

/// Rounds go through all rotation sequences and signs, both units, angles and quaternions.
struct RandomSkeleton {
  bool quaternions, adds;  // rotation output; MIEN_COMPOSE_EULER_ADD
  Deformed made;
  DeformValues values;
  Character character;
  DerivativesHandle d;

  explicit RandomSkeleton(uint32_t round, uint32_t storage = MIEN_STORAGE_32_BIT)
      : quaternions(round % 3 == 2), adds(round % 6 == 1), made(make(round, storage)),
        values(random_values(made.rig.get(), round)), character(made.rig),
        d(create_derivatives(made.rig.get(), made.deformer.get())) {
    character.evaluate(0);
    Instance& instance = *reinterpret_cast<Instance*>(character.instance.get());
    std::copy(values.joints.begin(), values.joints.end(), instance.joints.begin());
    std::copy(values.channels.begin(), values.channels.end(), instance.channels.begin());
    linearize(d, character);
  }

 private:
  Deformed make(uint32_t round, uint32_t storage) const {
    DeformRigOptions options;
    options.rotation_sequence = round % 6;
    for (int i = 0; i < 3; ++i) options.rotation_signs[i] = round >> i & 1 ? -1 : 1;
    options.rotation_unit = round % 2;
    MienDeformerDesc desc = sized<MienDeformerDesc>();
    desc.compose = adds ? MIEN_COMPOSE_EULER_ADD : MIEN_COMPOSE_PRODUCT;
    desc.storage = storage;
    return Deformed(random_deform_rig(round, options), desc,
                    quaternions ? MIEN_ROTATION_OUTPUT_QUATERNION : MIEN_ROTATION_OUTPUT_EULER);
  }
};

}  // namespace mien
