// SPDX-License-Identifier: MIT
// How much stack the calls of a frame use, against what mien.h says of them: measured on a thread whose
// stack is filled before.
#if defined(__has_feature)
#define MIEN_HAS_FEATURE(name) __has_feature(name)
#else
#define MIEN_HAS_FEATURE(name) 0
#endif

// Sanitizers add to every frame, and unoptimized builds keep every temporary apart.
#if defined(__linux__) && defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__) && !MIEN_HAS_FEATURE(address_sanitizer) &&         \
    !MIEN_HAS_FEATURE(thread_sanitizer) && !MIEN_HAS_FEATURE(undefined_behavior_sanitizer)

#include <gtest/gtest.h>
#include <pthread.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/golden.h"
#include "tests/support/rig_handles.h"

namespace mien::golden {
namespace {

constexpr size_t kStack = size_t{512} << 10;
constexpr uint8_t kFill = 0xA5;
constexpr size_t kEvaluate = size_t{48} << 10, kDeform = size_t{16} << 10;  // what mien.h says

void* run(void* call) {
  (*static_cast<std::function<void()>*>(call))();
  return nullptr;
}

size_t touched_by(std::function<void()> call) {
  const std::unique_ptr<void, decltype(&std::free)> stack(std::aligned_alloc(4096, kStack),
                                                          &std::free);
  auto* bytes = static_cast<uint8_t*>(stack.get());
  std::fill(bytes, bytes + kStack, kFill);
  pthread_attr_t attributes;
  pthread_t thread;
  EXPECT_EQ(pthread_attr_init(&attributes), 0);
  EXPECT_EQ(pthread_attr_setstack(&attributes, bytes, kStack), 0);
  EXPECT_EQ(pthread_create(&thread, &attributes, &run, &call), 0);
  EXPECT_EQ(pthread_join(thread, nullptr), 0);
  pthread_attr_destroy(&attributes);
  const uint8_t* lowest = std::find_if(bytes, bytes + kStack, [](uint8_t b) { return b != kFill; });
  return static_cast<size_t>(bytes + kStack - lowest);
}

/// Beyond what the thread itself takes.
size_t stack_of(const std::function<void()>& call) {
  const size_t thread = touched_by([] {});
  const size_t all = touched_by(call);
  return all > thread ? all - thread : 0;
}

struct CloseMeshes {
  void operator()(MienDeformer* deformer) const { mien_deformer_destroy(deformer); }
  void operator()(MienDeformerInstance* meshes) const { mien_deformer_instance_destroy(meshes); }
};

class Stack : public testing::TestWithParam<const char*> {};

TEST_P(Stack, OfAFrameIsWhatTheHeaderSays) {
  if (GetParam() == std::string(kHead) && !has_head()) GTEST_SKIP() << no_head();
  const std::vector<uint8_t> bytes = read_rig(GetParam());
  const DnaHandle dna = open_dna(bytes);
  ASSERT_TRUE(dna);
  size_t evaluating = 0, deforming = 0;
  for (uint32_t isa = MIEN_ISA_SCALAR; isa <= MIEN_ISA_NEON; ++isa) {
    if (!mien_isa_available(isa)) continue;
    for (uint32_t storage : {MIEN_STORAGE_32_BIT, MIEN_STORAGE_16_BIT}) {
      MienRigDesc rig_desc = sized<MienRigDesc>();
      rig_desc.isa = isa;
      rig_desc.storage = storage;
      MienRig* made = nullptr;
      ASSERT_EQ(mien_rig_create(dna.get(), &rig_desc, &made, nullptr), MIEN_OK);
      const RigHandle rig(made);

      constexpr uint32_t kCharacters = 40;  // more than a packet of 32
      std::vector<InstanceHandle> owned;
      std::vector<MienInstance*> characters;
      for (uint32_t i = 0; i < kCharacters; ++i) {
        MienInstance* instance = nullptr;
        ASSERT_EQ(mien_instance_create(rig.get(), nullptr, &instance, nullptr), MIEN_OK);
        owned.emplace_back(instance);
        characters.push_back(instance);
        MienMutableFloatView raw;
        ASSERT_EQ(mien_instance_raw_controls(instance, &raw), MIEN_OK);
        std::fill(raw.data, raw.data + raw.count, 0.25f + 0.01f * static_cast<float>(i));
      }
      const std::vector<uint32_t> lods(kCharacters, 0);
      const MienBatchDesc batch_size = batch_desc(kCharacters);
      MienBatch* batch = nullptr;
      ASSERT_EQ(mien_batch_create(rig.get(), &batch_size, &batch, nullptr), MIEN_OK);
      const BatchHandle batch_owner(batch);
      evaluating = std::max(evaluating, stack_of([&] {
                              EXPECT_EQ(mien_rig_evaluate(rig.get(), characters[0], 0), MIEN_OK);
                            }));
      evaluating = std::max(
          evaluating, stack_of([&] {
            EXPECT_EQ(mien_rig_evaluate_batch(rig.get(), batch, characters.data(), lods.data(),
                                              kCharacters, MIEN_STAGE_ALL, nullptr),
                      MIEN_OK);
          }));

      MienDeformer* deformer = nullptr;
      MienDeformerDesc deformer_desc = sized<MienDeformerDesc>();
      deformer_desc.with_tangents = 1;
      deformer_desc.storage = storage;
      ASSERT_EQ(mien_deformer_create(dna.get(), rig.get(), &deformer_desc, &deformer, nullptr),
                MIEN_OK);
      const std::unique_ptr<MienDeformer, CloseMeshes> deformer_owner(deformer);
      MienDeformerInfo info = sized<MienDeformerInfo>();
      ASSERT_EQ(mien_deformer_info(deformer, &info), MIEN_OK);
      MienDeformerInstance* meshes = nullptr;
      ASSERT_EQ(mien_deformer_instance_create(deformer, nullptr, &meshes, nullptr), MIEN_OK);
      const std::unique_ptr<MienDeformerInstance, CloseMeshes> meshes_owner(meshes);
      ASSERT_EQ(mien_deformer_instance_update(meshes, characters[0]), MIEN_OK);
      for (uint32_t normals : {MIEN_NORMALS_NONE, MIEN_NORMALS_SKINNED, MIEN_NORMALS_RECOMPUTED}) {
        for (uint32_t index = 0; index < info.mesh_count; ++index) {
          MienMesh mesh = sized<MienMesh>();
          ASSERT_EQ(mien_deformer_mesh(deformer, index, &mesh), MIEN_OK);
          if (mesh.vertex_count == 0) continue;
          std::vector<float> vertices(size_t{mesh.vertex_count} * 10);
          MienVertexOutput output = sized<MienVertexOutput>();
          output.vertex_capacity = mesh.vertex_count;
          output.positions = {vertices.data(), 40, MIEN_VERTEX_FORMAT_FLOAT32X3};
          output.normals = {vertices.data() + 3, 40, MIEN_VERTEX_FORMAT_FLOAT32X3};
          output.tangents = {vertices.data() + 6, 40, MIEN_VERTEX_FORMAT_FLOAT32X4};
          deforming = std::max(deforming, stack_of([&] {
                                 EXPECT_EQ(mien_deformer_instance_write_vertices(
                                               meshes, index, normals, &output, nullptr),
                                           MIEN_OK);
                               }));
          deforming = std::max(
              deforming, stack_of([&] {
                EXPECT_EQ(mien_deformer_instance_deform(meshes, index, normals, nullptr), MIEN_OK);
              }));
        }
      }
    }
  }
  EXPECT_GT(deforming, size_t{0});
  EXPECT_LE(evaluating, kEvaluate);
  EXPECT_LE(deforming, kDeform);
}

INSTANTIATE_TEST_SUITE_P(Rigs, Stack, testing::Values("small", "body", "ml", "ml_ext", kHead));

}  // namespace
}  // namespace mien::golden

#endif
