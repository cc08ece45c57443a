// SPDX-License-Identifier: MIT
// A DNA file is the same from a path, from memory and from a stream, and nothing stays of one that did not
// open.
#include "runtime/load/dna/dna_file.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "tests/support/dna_bytes.h"
#include "tests/support/failing_arrays.h"
#include "tests/support/memory_stream.h"
#include "tests/support/temporary_path.h"
#include "tests/support/tiny_rig.h"

namespace mien::dna {
namespace {

Bytes tiny() {
  Arena arena(default_allocator());
  return written(tiny_rig(arena));
}

/// A file on disk, which goes with it.
struct FileOnDisk {
  std::string path = temporary_path("dna_file.dna");

  explicit FileOnDisk(const Bytes& bytes) {
    FILE* file = fopen(path.c_str(), "wb");
    EXPECT_EQ(fwrite(bytes.data(), 1, bytes.size(), file), bytes.size());
    fclose(file);
  }
  ~FileOnDisk() { remove(path.c_str()); }
};

/// Opens in the way `way`: 0 path, 1 memory, 2 stream.
Status open_in(int way, const FileOnDisk& disk, const MemoryStream& stream,
               const Allocator& allocator, DnaFile*& out, Error& error) {
  if (way == 0) {
    return open_dna_file(disk.path.c_str(), FileAccess::kRead, {}, allocator, out, error);
  }
  if (way == 1) {
    const Span<const uint8_t> bytes = {stream.bytes.data(), stream.bytes.size()};
    return open_dna_memory(bytes, {}, allocator, out, error);
  }
  return open_dna_stream(stream.get(), {}, allocator, out, error);
}

TEST(DnaFile, IsTheSameInEachWayAndGivesBackItsMemory) {
  const Bytes bytes = tiny();
  const FileOnDisk disk(bytes);
  const MemoryStream stream(bytes);
  for (int way = 0; way < 3; ++way) {
    const size_t requests = fail_every_array([&](const Allocator& allocator, Error& error) {
      DnaFile* file = nullptr;
      const Status status = open_in(way, disk, stream, allocator, file, error);
      EXPECT_EQ(file != nullptr, status == Status::kOk) << way;
      if (!file) return status;
      EXPECT_EQ(file->tag, DnaFile::kTag);
      EXPECT_EQ(written(file->view), bytes) << way;
      release(file);
      return status;
    });
    EXPECT_GT(requests, 1u);
  }
}

TEST(DnaFile, ThatDoesNotOpenLeavesNothing) {
  Bytes bytes = tiny();
  bytes.resize(bytes.size() / 2);
  const FileOnDisk disk(bytes);
  const MemoryStream stream(bytes);
  for (int way = 0; way < 3; ++way) {
    CountingAllocator counter;
    const MienAllocator given = counter.get();
    const Allocator allocator = {given.user, given.allocate, given.release, 0};
    auto* file = reinterpret_cast<DnaFile*>(&counter);
    Error error;
    EXPECT_NE(open_in(way, disk, stream, allocator, file, error), Status::kOk) << way;
    EXPECT_EQ(file, nullptr) << way;
    EXPECT_NE(error.message[0], 0) << way;
    EXPECT_TRUE(counter.clean()) << way << counter.first_wrong;
  }
  DnaFile* file = nullptr;
  Error error;
  const std::string none = temporary_path("dna_file_that_is_not_there.dna");
  EXPECT_EQ(open_dna_file(none.c_str(), FileAccess::kRead, {}, default_allocator(), file, error),
            Status::kFileOpen);
  EXPECT_EQ(file, nullptr);
}

TEST(DnaFile, OutlivesItsHandleWhileItHasOwners) {
  const Bytes bytes = tiny();
  DnaFile* file = nullptr;
  Error error;
  ASSERT_EQ(open_dna_memory({bytes.data(), bytes.size()}, {}, default_allocator(), file, error),
            Status::kOk)
      << error.message;
  const DnaFile* second = share(*file);
  release(file);
  EXPECT_EQ(written(second->view), bytes);
  release(second);
}

}  // namespace
}  // namespace mien::dna
