// SPDX-License-Identifier: MIT
// The joint matrix in 16 bits: how far its results may be from those of floats, and how far they
// are.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/support/golden.h"
#include "tests/support/many_rigs.h"

namespace mien {
namespace {

RigHandle rig_with_storage(const MienDna* dna, uint32_t storage,
                           uint32_t isa = MIEN_ISA_ENVIRONMENT) {
  MienRigDesc desc = sized<MienRigDesc>();
  desc.storage = storage;
  desc.isa = isa;
  return create_rig(dna, desc);
}

/// Half a unit of the row for each control that is not zero, and what floats lose.
std::vector<double> tolerances(const dna::DnaView& view, Span<const float> controls) {
  std::vector<double> all(9 * size_t{view.defn.joint_names.count});
  for (const dna::JointGroup& group : view.bhvr.joints.groups) {
    const uint32_t columns = group.input_indices.count;
    for (uint32_t r = 0; r < group.output_indices.count; ++r) {
      double largest = 0, active = 0, products = 0;
      for (uint32_t c = 0; c < columns; ++c) {
        const double value = group.values[size_t{r} * columns + c];
        const double control = std::fabs(controls[group.input_indices[c]]);
        largest = std::max(largest, std::fabs(value));
        active += control;
        products += std::fabs(value) * control;
      }
      double& tolerance = all[group.output_indices[r]];
      tolerance =
          std::max(tolerance, active * largest / 32767 / 2 + (columns + 2) * 1.2e-7 * products);
    }
  }
  return all;
}

struct Errors {
  double largest = 0, squares = 0;
  size_t count = 0;
};

/// Evaluates both with random controls at LOD 0 and compares the joints.
Errors compare(const MienDna* dna, uint32_t isa) {
  const RigHandle floats = rig_with_storage(dna, MIEN_STORAGE_32_BIT, isa);
  const RigHandle fixed = rig_with_storage(dna, MIEN_STORAGE_16_BIT, isa);
  EXPECT_LT(info_of(fixed).rig_bytes, info_of(floats).rig_bytes);
  EXPECT_EQ(info_of(fixed).storage, uint32_t{MIEN_STORAGE_16_BIT});
  Character a(floats), b(fixed);
  Random random = Random::from_seed(31, 1);
  Errors errors;
  for (uint32_t percent : {5, 25, 50, 100}) {
    draw_controls(random, percent, a.raw);
    std::copy(a.raw.begin(), a.raw.end(), b.raw.begin());
    a.evaluate(0);
    b.evaluate(0);
    EXPECT_EQ(a.psd.count, b.psd.count);
    const std::vector<double> tolerance = tolerances(capi::object(dna)->view, a.controls);
    for (size_t i = 0; i < tolerance.size(); ++i) {
      const double error = std::fabs(double{a.joints[i]} - b.joints[i]);
      EXPECT_LE(error, tolerance[i]) << "joint value " << i << ", " << percent << " %";
      errors.largest = std::max(errors.largest, error);
      errors.squares += error * error;
      ++errors.count;
    }
  }
  return errors;
}

TEST(JointStorage, IsWithinHalfAUnitOfEachRow) {
  for (uint32_t preset : {MIEN_PRESET_TINY, MIEN_PRESET_SMALL, MIEN_PRESET_MEDIUM}) {
    for (uint32_t isa : present_isas()) {
      SCOPED_TRACE(mien_isa_name(isa));
      const Errors errors = compare(generate_dna(preset, 5).get(), isa);
      EXPECT_GT(errors.largest, 0) << "it does not store less";
    }
  }
}

TEST(JointStorage, OfAProductionHead) {
  if (!golden::has_head()) GTEST_SKIP() << golden::no_head();
  const std::vector<uint8_t> bytes = golden::read_rig(golden::kHead);
  const DnaHandle dna = open_dna(bytes);
  ASSERT_TRUE(dna);
  const Errors errors = compare(dna.get(), MIEN_ISA_ENVIRONMENT);
  std::printf("16-bit joint matrix: root mean square %.3g, largest %.3g (cm or degrees)\n",
              std::sqrt(errors.squares / static_cast<double>(errors.count)), errors.largest);
}

}  // namespace
}  // namespace mien
