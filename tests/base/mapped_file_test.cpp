// SPDX-License-Identifier: MIT
#include "runtime/base/mapped_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

namespace mien {
namespace {

/// Gives `letter` for ever, `step` at a time, after a beginning, and counts.
struct Endless {
  std::string beginning;
  size_t step = 1000;
  uint64_t given = 0;
  uint64_t fails_at = ~uint64_t{0};

  static int64_t read(void* user, void* to, size_t size) {
    Endless& self = *static_cast<Endless*>(user);
    if (self.given >= self.fails_at) return -1;
    const size_t count = size < self.step ? size : self.step;
    for (size_t i = 0; i < count; ++i, ++self.given) {
      const bool first = self.given < self.beginning.size();
      static_cast<char*>(to)[i] = first ? self.beginning[self.given] : 'z';
    }
    return static_cast<int64_t>(count);
  }
};

TEST(ReadToEnd, StopsAtTheWrongSignature) {
  for (const char* beginning : {"", "D", "DN", "dna", "DNB"}) {
    for (const size_t step : {1, 2, 5, 1000}) {
      Endless source{beginning, step};
      MappedFile file;
      Error error;
      bool good = false;
      ASSERT_EQ(read_to_end({&source, Endless::read}, "x", 100, {"DNA", 3}, default_allocator(),
                            file, good, error),
                Status::kOk);
      EXPECT_TRUE(good);
      EXPECT_LE(source.given, 3 + step) << beginning;
      ASSERT_EQ(file.size, source.given);
      EXPECT_EQ(memcmp(file.bytes, beginning, strlen(beginning)), 0);
      close_file(file);
    }
  }
}

TEST(ReadToEnd, StopsAtTheLimit) {
  constexpr uint64_t kLimit = 300000;
  for (const size_t step : {1000, 1 << 20}) {
    Endless source{"DNA", step};
    MappedFile file;
    Error error;
    bool good = false;
    EXPECT_EQ(read_to_end({&source, Endless::read}, "pipe", 100, {"DNA", 3, kLimit},
                          default_allocator(), file, good, error),
              Status::kFileRead);
    EXPECT_TRUE(good);
    EXPECT_EQ(file.bytes, nullptr);
    EXPECT_LE(source.given, 2 * kLimit);
    EXPECT_STREQ(error.message, "cannot read pipe: it has more than 300000 bytes");
  }
  EXPECT_EQ(FileLimits().bytes, uint64_t{1} << 32) << "what the offsets of a DNA file can reach";
}

TEST(ReadToEnd, TellsThatTheSourceFailed) {
  Endless source{"DNA", 1000, 0, 50000};
  MappedFile file;
  Error error;
  bool good = true;
  EXPECT_EQ(read_to_end({&source, Endless::read}, "x", 100, {"DNA", 3}, default_allocator(), file,
                        good, error),
            Status::kFileRead);
  EXPECT_FALSE(good);
  EXPECT_EQ(file.bytes, nullptr);
}

}  // namespace
}  // namespace mien
