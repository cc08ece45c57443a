// SPDX-License-Identifier: MIT
#include "runtime/base/object.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <thread>
#include <vector>

#include "runtime/base/shared_bytes.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/memory_stream.h"
#include "tests/support/temporary_path.h"

namespace mien {
namespace {

struct Shared : Object {
  static constexpr uint32_t kTag = 7;
  Span<float> values;
};

struct User : Object {
  static constexpr uint32_t kTag = 8;
  const Shared* shared = nullptr;
  Arena arena;
  explicit User(const Allocator& from) : arena(from) {}
  ~User() { release(shared); }
};

Allocator from(CountingAllocator& counting) {
  const MienAllocator given = counting.get();
  return {given.user, given.allocate, given.release};
}

Shared* make_shared(const Allocator& allocator, size_t count) {
  return create_object<Shared>(allocator, [count](Placer& placer, Shared& made) {
    made.values = placer.array<float>(count, kBlockAlignment);
  });
}

TEST(Object, IsOneBlockWithItsArrays) {
  CountingAllocator counting;
  Shared* object = make_shared(from(counting), 10);
  ASSERT_TRUE(object);
  EXPECT_EQ(object->tag, 7u);
  EXPECT_EQ(counting.live, 1u);
  EXPECT_EQ(object->block_size, counting.bytes);
  for (float value : object->values) EXPECT_EQ(value, 0.0f);
  release(object);
  EXPECT_TRUE(counting.clean());
}

TEST(Object, BelongsToItsLastOwner) {
  CountingAllocator counting;
  Shared* shared = make_shared(from(counting), 1);
  User* users[2] = {create_object<User>(from(counting)), create_object<User>(from(counting))};
  for (User* user : users) {
    EXPECT_EQ(user->tag, 8u);
    user->shared = share(*shared);
    EXPECT_NE(user->arena.allocate(100, 1), nullptr);
  }
  EXPECT_EQ(shared->owners, 3u);
  release(shared);
  release(users[0]);
  EXPECT_EQ(shared->owners, 1u);
  EXPECT_EQ(counting.live, 3u);  // the other user, its arena, and what it shares
  release(users[1]);
  EXPECT_TRUE(counting.clean());
}

TEST(Object, IsReleasedByWhicheverThreadIsLast) {
  for (int round = 0; round < 50; ++round) {
    CountingAllocator counting;
    const Shared* shared = make_shared(from(counting), 1);
    for (int i = 0; i < 3; ++i) share(*shared);
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) threads.emplace_back([shared] { release(shared); });
    for (std::thread& thread : threads) thread.join();
    EXPECT_TRUE(counting.clean());
  }
}

TEST(Object, ReleasedMemoryHasNoTag) {
  alignas(kBlockAlignment) static uint8_t memory[1024];
  const Allocator kept = {nullptr, [](void*, size_t, size_t) -> void* { return memory; },
                          [](void*, void*, size_t, size_t) {}};
  release(make_shared(kept, 1));
  uint32_t tag = 1;
  memcpy(&tag, memory, sizeof(tag));
  EXPECT_EQ(tag, 0u);
  release(create_object<User>(kept));
  memcpy(&tag, memory, sizeof(tag));
  EXPECT_EQ(tag, 0u);
}

TEST(Object, IsNullWithoutMemory) {
  CountingAllocator counting;
  counting.fail_at = 1;
  counting.keep_failing = true;
  EXPECT_EQ(make_shared(from(counting), 1), nullptr);
  EXPECT_EQ(create_object<User>(from(counting)), nullptr);
  release<Shared>(nullptr);
  EXPECT_TRUE(counting.clean());
}

// Bytes -------------------------------------------------------------------------------------------

struct Reader : SharedBytes {
  static constexpr uint32_t kTag = 9;
  int more = 0;
};

TEST(SharedBytes, StreamIsCopiedIntoTheBlock) {
  CountingAllocator counting;
  const MemoryStream stream({1, 2, 3});
  Reader* reader = nullptr;
  Error error;
  ASSERT_EQ(create_from_stream(stream.get(), "a test", from(counting), reader, error), Status::kOk);
  EXPECT_EQ(std::vector<uint8_t>(reader->data, reader->data + reader->size), stream.bytes);
  EXPECT_EQ(reinterpret_cast<uintptr_t>(reader->data) % kBlockAlignment, 0u);
  EXPECT_EQ(counting.live, 1u);
  // What reads them may know only that they are bytes.
  const SharedBytes* bytes = share<SharedBytes>(*reader);
  release(reader);
  EXPECT_EQ(bytes->data[2], 3);
  release(bytes);
  EXPECT_TRUE(counting.clean());
}

TEST(SharedBytes, StreamThatFailsOrIsTooLargeLeavesNothing) {
  for (bool reads_short : {false, true}) {
    CountingAllocator counting;
    MemoryStream stream(std::vector<uint8_t>(100));
    stream.fail_at = 1;
    stream.reads_short = reads_short;
    Reader* reader = nullptr;
    Error error;
    EXPECT_EQ(create_from_stream(stream.get(), "a test", from(counting), reader, error),
              Status::kFileRead);
    EXPECT_EQ(reader, nullptr);
    EXPECT_TRUE(counting.clean());
  }
  CountingAllocator counting;
  counting.limit = 10000;
  for (uint64_t size : {uint64_t{20000}, UINT64_MAX, UINT64_MAX / 2}) {
    MemoryStream stream({});
    Stream large = stream.get();
    large.size = size;
    Reader* reader = nullptr;
    Error error;
    EXPECT_EQ(create_from_stream(large, "a test", from(counting), reader, error), Status::kMemory);
    EXPECT_EQ(error.message, "no memory for a test of " + std::to_string(size) + " bytes");
    EXPECT_EQ(stream.reads, 0u);
    EXPECT_TRUE(counting.clean());
  }
}

TEST(SharedBytes, FileIsClosedByTheLastOwner) {
  const std::string path = temporary_path("shared_bytes");
  const uint8_t written[] = {4, 5};
  Error error;
  ASSERT_EQ(write_file(path.c_str(), written, 2, default_allocator(), error), Status::kOk);
  for (FileAccess access : {FileAccess::kMap, FileAccess::kRead}) {
    CountingAllocator counting;
    Reader* reader = nullptr;
    ASSERT_EQ(create_from_file(path.c_str(), access, {}, "a test", from(counting), reader, error),
              Status::kOk)
        << error.message;
    ASSERT_EQ(reader->size, 2u);
    EXPECT_EQ(reader->data[1], 5);
    const SharedBytes* bytes = share<SharedBytes>(*reader);
    release(reader);
    EXPECT_EQ(bytes->data[0], 4);
    release(bytes);
    EXPECT_TRUE(counting.clean());
  }
  remove(path.c_str());
  CountingAllocator counting;
  Reader* reader = nullptr;
  EXPECT_EQ(create_from_file("/does/not/exist", FileAccess::kMap, {}, "a test", from(counting),
                             reader, error),
            Status::kFileOpen);
  EXPECT_EQ(reader, nullptr);
  EXPECT_TRUE(counting.clean());
}

}  // namespace
}  // namespace mien
