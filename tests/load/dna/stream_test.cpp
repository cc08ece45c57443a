// SPDX-License-Identifier: MIT
// A file read from a stream is the file read from memory; failures of the stream are reported, and
// nothing is left behind.
#include <gtest/gtest.h>

#include "runtime/load/dna/dna_reader.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/dna_bytes.h"
#include "tests/support/many_rigs.h"
#include "tests/support/memory_stream.h"

namespace mien::dna {
namespace {

/// A view with the arena that it lies in.
struct Opened {
  Arena arena;
  DnaView view;
  Error error;
  Status status;

  Opened(const Bytes& file, const ReadOptions& options) : arena(default_allocator()) {
    status = read_dna(file.data(), file.size(), options, arena, view, error);
  }
  Opened(const MemoryStream& stream, const ReadOptions& options,
         const Allocator& allocator = default_allocator())
      : arena(allocator) {
    status = read_dna(stream.get(), options, arena, view, error);
  }
};

void expect_same(const Bytes& file, const ReadOptions& options) {
  MemoryStream source(file);
  const Opened memory(file, options), stream(source, options);
  ASSERT_EQ(stream.status, memory.status) << stream.error.message;
  EXPECT_STREQ(stream.error.message, memory.error.message);
  EXPECT_EQ(stream.error.byte_offset, memory.error.byte_offset);
  EXPECT_EQ(source.wrong, "");
  if (memory.status != Status::kOk) return;
  source.bytes.assign(source.bytes.size(), 0xEE);  // not needed any more
  for (uint16_t version : {1, 4, 8}) {
    EXPECT_TRUE(written(stream.view, version) == written(memory.view, version)) << version;
  }
  ASSERT_EQ(stream.view.index.count, memory.view.index.count);
  for (uint32_t i = 0; i < memory.view.index.count; ++i) {
    EXPECT_EQ(stream.view.index[i].offset, memory.view.index[i].offset);
    EXPECT_EQ(stream.view.index[i].size, memory.view.index[i].size);
  }
  for (uint32_t i = 0; i < memory.view.defn.joint_names.count; ++i) {
    const void* const name = stream.view.defn.joint_names[i].data;
    EXPECT_EQ(stream.view.offset_of(name),
              memory.view.offset_of(memory.view.defn.joint_names[i].data));
  }
}

Bytes tiny_file(uint16_t version = 8) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  if (version == 1) view.bhvr.joints.groups[1].input_indices = be<uint16_t>(arena, {0, 4, 2});
  return written(view, version);
}

TEST(DnaStream, GivesTheFileThatMemoryGives) {
  for (uint16_t version = 1; version <= 8; ++version) {
    const Bytes file = tiny_file(version);
    for (uint32_t layers = 0; layers <= kLayersAll; layers += 3) {
      SCOPED_TRACE("version " + std::to_string(version) + ", layers " + std::to_string(layers));
      ReadOptions options;
      options.layers = layers;
      options.lods = layers % 4;
      options.keep_unknown = layers % 2 != 0;
      expect_same(file, options);
    }
  }
  for_each_dna(4, [](const DnaHandle& dna) { expect_same(write_dna(dna.get()), {}); });
}

TEST(DnaStream, CarriesUnknownLayers) {
  std::vector<Layer> layers = layers_of(tiny_file());
  layers.push_back(layer("abcd 1.0", Bytes(300, 0xEE)));
  const Bytes file = file_of(8, layers);
  for (const bool keep : {true, false}) {
    ReadOptions options;
    options.keep_unknown = keep;
    expect_same(file, options);
  }
}

// Damaged files: the same finding at the same byte.
TEST(DnaStream, FindsWhatMemoryFinds) {
  for (const uint16_t version : {1, 8}) {
    const Bytes whole = tiny_file(version);
    for (size_t size = 0; size <= whole.size(); size += size < 300 ? 1 : 29) {
      SCOPED_TRACE("truncated to " + std::to_string(size));
      expect_same(Bytes(whole.begin(), whole.begin() + static_cast<ptrdiff_t>(size)), {});
    }
    for (size_t at = 0; at < whole.size(); at += at < 300 ? 1 : 7) {
      SCOPED_TRACE("changed at " + std::to_string(at));
      Bytes changed = whole;
      changed[at] ^= 0xFF;
      expect_same(changed, {});
      if (testing::Test::HasFailure()) return;
    }
  }
}

TEST(DnaStream, EveryReadMayFail) {
  for (const uint16_t version : {1, 2, 8}) {
    const Bytes file = tiny_file(version);
    MemoryStream counted(file);
    ASSERT_EQ(Opened(counted, {}).status, Status::kOk);
    ASSERT_GT(counted.reads, 4u);
    for (const bool reads_short : {false, true}) {
      for (size_t k = 1; k <= counted.reads; ++k) {
        MemoryStream stream(file);
        stream.fail_at = k;
        stream.reads_short = reads_short;
        CountingAllocator counter;
        const MienAllocator allocator = counter.get();
        {
          const Opened opened(stream, {}, {allocator.user, allocator.allocate, allocator.release});
          EXPECT_EQ(opened.status, Status::kFileRead) << opened.error.message;
          EXPECT_NE(opened.error.message[0], 0);
          EXPECT_LE(opened.error.byte_offset, file.size());
          EXPECT_EQ(stream.reads, k) << "read on after a failure";
        }
        EXPECT_TRUE(counter.clean()) << counter.first_wrong;
      }
    }
  }
}

TEST(DnaStream, EveryAllocationMayFail) {
  const Bytes file = tiny_file();
  for (size_t k = 1;; ++k) {
    MemoryStream stream(file);
    CountingAllocator counter;
    counter.fail_at = k;
    const MienAllocator allocator = counter.get();
    const Opened opened(stream, {}, {allocator.user, allocator.allocate, allocator.release});
    if (counter.failed == 0) break;
    EXPECT_EQ(opened.status, Status::kMemory) << opened.error.message;
  }
}

// The size is the caller's word; what is announced still has to fit into it.
TEST(DnaStream, AnnouncedSizesAreBounded) {
  Bytes file = tiny_file();
  set32(file, 7, 0xFFFFFFFF);  // layers in the index
  MemoryStream stream(file);
  CountingAllocator counter;
  const MienAllocator allocator = counter.get();
  const Opened opened(stream, {}, {allocator.user, allocator.allocate, allocator.release});
  EXPECT_EQ(opened.status, Status::kDnaTruncated);
  EXPECT_LT(counter.peak, size_t{1} << 20);
}

}  // namespace
}  // namespace mien::dna
