// SPDX-License-Identifier: MIT
// Compiling rigs and deformers, while any one array cannot be had.
#include "runtime/load/compile/compile_deformer.h"
#include "runtime/load/compile/compile_rig.h"
#include "tests/support/deform_rig.h"
#include "tests/support/failing_arrays.h"
#include "tests/support/random_layer_rig.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

std::vector<uint8_t> tiny() {
  Arena arena(default_allocator());
  return write_view(dna::tiny_rig(arena));
}

size_t fail_compiling(const MienDna* dna, bool other_form) {
  CompileOptions options;
  options.kernels = capi::object(create_rig(dna).get())->kernels;
  options.quaternion_outputs = options.half_storage = options.blend_masks = other_form;
  return fail_every_array([&](const Allocator& allocator, Error& error) {
    Rig* rig = nullptr;
    const Status status = compile_rig(capi::object(dna)->view, options, allocator, rig, error);
    EXPECT_EQ(rig == nullptr, status != Status::kOk);
    if (rig) release(rig);
    return status;
  });
}

TEST(CompileMemory, EachArrayOfARig) {
  const std::vector<uint8_t> bytes = tiny();
  EXPECT_GT(fail_compiling(open_dna(bytes).get(), false), 20u);
  EXPECT_GT(fail_compiling(generate_dna(MIEN_PRESET_SMALL, 1).get(), false), 20u);
  for (uint64_t seed : {1, 2, 3}) {
    Random random = Random::from_seed(15, seed);
    const LayerFile file(random_layer_rig(random, false, seed == 3));
    EXPECT_GT(fail_compiling(file.dna.get(), true), 20u);
  }
}

TEST(CompileMemory, EachArrayOfADeformer) {
  for (const std::vector<uint8_t>& bytes : {tiny(), random_deform_rig(3, {})}) {
    const DnaHandle dna = open_dna(bytes);
    const RigHandle rig = create_rig(dna.get());
    DeformOptions options;
    options.kernels = capi::object(rig.get())->kernels;
    options.tangents = true;
    EXPECT_GT(fail_every_array([&](const Allocator& allocator, Error& error) {
                Deformer* deformer = nullptr;
                const Status status = compile_deformer(dna->view, *capi::object(rig.get()), options,
                                                       allocator, deformer, error);
                EXPECT_EQ(deformer == nullptr, status != Status::kOk);
                if (deformer) release(deformer);
                return status;
              }),
              10u);
  }
}

}  // namespace
}  // namespace mien
