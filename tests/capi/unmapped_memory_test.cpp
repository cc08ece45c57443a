// SPDX-License-Identifier: MIT
// A heap whose blocks are pages of their own, gone as soon as they are released: a touch of destroyed
// memory is a fault. Owners are destroyed before what depends on them, as mien.h allows.
#include <sys/mman.h>
#include <unistd.h>

#include "tests/support/rig_handles.h"

namespace mien {
namespace {

struct Pages {
  size_t live = 0;

  MienAllocator get() { return {this, allocate, release}; }

  static size_t rounded(size_t size) {
    const auto page = static_cast<size_t>(sysconf(_SC_PAGESIZE));
    return (size + page - 1) / page * page;
  }
  // The end of the block is the end of its pages, as far as alignment lets it.
  static size_t front(size_t size, size_t alignment) {
    return (rounded(size) - size) / alignment * alignment;
  }
  static void* MIEN_CALLBACK allocate(void* user, size_t size, size_t alignment) {
    void* pages =
        mmap(nullptr, rounded(size), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (pages == MAP_FAILED) return nullptr;
    ++static_cast<Pages*>(user)->live;
    return static_cast<char*>(pages) + front(size, alignment);
  }
  static void MIEN_CALLBACK release(void* user, void* block, size_t size, size_t alignment) {
    if (!block) return;
    --static_cast<Pages*>(user)->live;
    munmap(static_cast<char*>(block) - front(size, alignment), rounded(size));
  }
};

template <class Desc>
Desc with(const MienAllocator& allocator) {
  Desc desc = sized<Desc>();
  desc.allocator = &allocator;
  return desc;
}

TEST(UnmappedMemory, OwnersGoFirst) {
  Pages pages;
  const MienAllocator allocator = pages.get();
  const std::vector<uint8_t> bytes = write_dna(generate_dna(MIEN_PRESET_TINY, 3).get());
  const auto dna_desc = with<MienDnaDesc>(allocator);
  const auto rig_desc = with<MienRigDesc>(allocator);
  const auto instance_desc = with<MienInstanceDesc>(allocator);
  const auto batch_desc = with<MienBatchDesc>(allocator);
  const auto deformer_desc = with<MienDeformerDesc>(allocator);
  const auto pose_desc = with<MienDeformerInstanceDesc>(allocator);
  MienDna* dna = nullptr;
  MienRig* rig = nullptr;
  MienInstance* instance = nullptr;
  MienBatch* batch = nullptr;
  MienDeformer* deformer = nullptr;
  MienDeformerInstance* pose = nullptr;
  ASSERT_EQ(mien_dna_open_memory(bytes.data(), bytes.size(), &dna_desc, &dna, nullptr), MIEN_OK);
  ASSERT_EQ(mien_rig_create(dna, &rig_desc, &rig, nullptr), MIEN_OK);
  ASSERT_EQ(mien_deformer_create(dna, rig, &deformer_desc, &deformer, nullptr), MIEN_OK);
  mien_dna_close(dna);
  ASSERT_EQ(mien_instance_create(rig, &instance_desc, &instance, nullptr), MIEN_OK);
  ASSERT_EQ(mien_batch_create(rig, &batch_desc, &batch, nullptr), MIEN_OK);
  ASSERT_EQ(mien_deformer_instance_create(deformer, &pose_desc, &pose, nullptr), MIEN_OK);
  EXPECT_EQ(mien_rig_evaluate(rig, instance, 0), MIEN_OK);
  const uint32_t lod = 0;
  EXPECT_EQ(mien_rig_evaluate_batch(rig, batch, &instance, &lod, 1, MIEN_STAGE_ALL, nullptr),
            MIEN_OK);
  mien_batch_destroy(batch);
  mien_deformer_destroy(deformer);
  mien_rig_destroy(rig);
  // What is left of the rig and of the deformer is kept by these two.
  EXPECT_EQ(mien_deformer_instance_update(pose, instance), MIEN_OK);
  EXPECT_EQ(mien_deformer_instance_deform(pose, 0, MIEN_NORMALS_RECOMPUTED, nullptr), MIEN_OK);
  EXPECT_EQ(mien_instance_reset(instance), MIEN_OK);
  mien_instance_destroy(instance);
  MienFloatView positions = {};
  EXPECT_EQ(mien_deformer_instance_positions(pose, 0, &positions), MIEN_OK);
  float sum = 0;
  for (size_t i = 0; i < positions.count; ++i) sum += positions.data[i];
  EXPECT_TRUE(sum == sum);
  mien_deformer_instance_destroy(pose);
  EXPECT_EQ(pages.live, 0u);
}

TEST(UnmappedMemory, FailedCallsReleaseWhatTheyTook) {
  Pages pages;
  const MienAllocator allocator = pages.get();
  const std::vector<uint8_t> bytes = write_dna(generate_dna(MIEN_PRESET_TINY, 3).get());
  const auto desc = with<MienDnaDesc>(allocator);
  for (size_t size = 0; size < bytes.size(); size += 97) {
    MienDna* dna = nullptr;
    const std::vector<uint8_t> cut(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(size));
    EXPECT_NE(mien_dna_open_memory(cut.data(), cut.size(), &desc, &dna, nullptr), MIEN_OK);
  }
  EXPECT_EQ(pages.live, 0u);
}

}  // namespace
}  // namespace mien
