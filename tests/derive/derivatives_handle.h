// SPDX-License-Identifier: MIT
// Derivatives that destroy themselves, and their products as vectors.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "runtime/derive/derivatives.h"
#include "tests/support/rig_handles.h"

namespace mien {

struct DestroyDerivatives {
  void operator()(MienDerivatives* d) const { mien_derivatives_destroy(d); }
};
using DerivativesHandle = std::unique_ptr<MienDerivatives, DestroyDerivatives>;

inline DerivativesHandle create_derivatives(const MienRig* rig,
                                            const MienDeformer* deformer = nullptr) {
  MienDerivativesDesc desc = mien_derivatives_desc_default();
  desc.deformer = deformer;
  MienDerivatives* made = nullptr;
  MienError error = sized<MienError>();
  EXPECT_EQ(mien_derivatives_create(rig, &desc, &made, &error), MIEN_OK) << error.message;
  return DerivativesHandle(made);
}

inline size_t size_of(const DerivativesHandle& d, uint32_t point, uint32_t mesh = 0) {
  size_t size = 0;
  EXPECT_EQ(mien_derivatives_size(d.get(), point, mesh, &size), MIEN_OK);
  return size;
}

inline std::vector<float> forward(const DerivativesHandle& d, uint32_t from, uint32_t to,
                                  const std::vector<float>& rows, uint32_t count = 1,
                                  uint32_t mesh = 0) {
  std::vector<float> out(size_of(d, to, mesh) * count);
  EXPECT_EQ(mien_derivatives_forward(d.get(), from, to, mesh, count, rows.data(), out.data()),
            MIEN_OK);
  return out;
}
inline std::vector<float> reverse(const DerivativesHandle& d, uint32_t from, uint32_t to,
                                  const std::vector<float>& rows, uint32_t count = 1,
                                  uint32_t mesh = 0) {
  std::vector<float> out(size_of(d, from, mesh) * count);
  EXPECT_EQ(mien_derivatives_reverse(d.get(), from, to, mesh, count, rows.data(), out.data()),
            MIEN_OK);
  return out;
}
inline void linearize(const DerivativesHandle& d, const Character& character,
                      uint32_t stages = MIEN_STAGE_ALL) {
  EXPECT_EQ(mien_derivatives_linearize(d.get(), character.instance.get(), stages), MIEN_OK);
}

}  // namespace mien
