// SPDX-License-Identifier: MIT
#include "runtime/base/mapped_file.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "runtime/base/file_pages.h"
#include "tests/support/temporary_path.h"

namespace mien {
namespace {

namespace fs = std::filesystem;

/// A path that the functions of this test take at any length; the library adds the prefix by itself.
fs::path any_length(const fs::path& path) {
#if defined(_WIN32)
  return L"\\\\?\\" + fs::absolute(path).make_preferred().wstring();
#else
  return path;
#endif
}

/// An empty folder, for as long as it lives.
struct Folder {
  fs::path path = temporary_path("files");

  Folder() {
    std::error_code failed;
    fs::remove_all(path, failed);
    fs::create_directories(path, failed);
    EXPECT_FALSE(failed) << failed.message();
  }
  ~Folder() {
    std::error_code failed;
    fs::remove_all(path, failed);
    EXPECT_FALSE(failed) << failed.message();
  }
  size_t entries() const {
    size_t count = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
      (void)entry;
      ++count;
    }
    return count;
  }
};

Status write_text(const std::string& path, const std::string& text, Error& error) {
  return write_file(path.c_str(), reinterpret_cast<const uint8_t*>(text.data()), text.size(),
                    default_allocator(), error);
}

/// What a file says, or why it cannot be read.
std::string text_of(const std::string& path, FileAccess access) {
  MappedFile file;
  Error error;
  const Status status = open_file(path.c_str(), access, {}, default_allocator(), file, error);
  if (status != Status::kOk) return error.message;
  const std::string text(reinterpret_cast<const char*>(file.bytes), file.size);
  close_file(file);
  return text;
}

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

TEST(SystemFile, NamesAreUtf8) {
  const Folder folder;
  for (const char* name :
       {"plain.dna", "two words.dna", "h\xC3\xA4nde.dna", "\xE9\xA1\x94 \xF0\x9F\x99\x82.dna"}) {
    const std::string path = (folder.path / fs::u8path(name)).u8string();
    Error error;
    for (const char* text : {"first", "another"}) {
      ASSERT_EQ(write_text(path, text, error), Status::kOk) << error.message;
      EXPECT_EQ(text_of(path, FileAccess::kMap), text);
      EXPECT_EQ(text_of(path, FileAccess::kRead), text);
    }
    EXPECT_TRUE(fs::exists(folder.path / fs::u8path(name))) << "under this very name";
  }
  EXPECT_EQ(folder.entries(), 4u) << "no temporary files";
#if defined(_WIN32)
  Error error;
  EXPECT_EQ(write_text("\xFF\xFE.dna", "text", error), Status::kFileWrite);
  EXPECT_NE(strstr(error.message, "not UTF-8"), nullptr) << error.message;
  EXPECT_NE(text_of("\xFF\xFE.dna", FileAccess::kMap).find("not UTF-8"), std::string::npos);
#endif
}

TEST(SystemFile, NamesAndPathsMayBeAsLongAsTheSystemAllows) {
  const Folder folder;
  fs::path deep = any_length(fs::absolute(folder.path));
  for (int level = 0; level < 6; ++level) deep /= std::string(60, static_cast<char>('a' + level));
  std::error_code failed;
  fs::create_directories(deep, failed);
  ASSERT_FALSE(failed) << failed.message();
  std::string path = (deep / "face.dna").u8string();
  if (path.compare(0, 4, "\\\\?\\") == 0) path.erase(0, 4);
  ASSERT_GT(path.size(), 260u);
  const fs::path named = folder.path / (std::string(251, 'n') + ".dna");
  for (const std::string& each : {path, named.u8string()}) {
    Error error;
    for (const char* text : {"first", "another"}) {
      ASSERT_EQ(write_text(each, text, error), Status::kOk) << error.message;
      EXPECT_EQ(text_of(each, FileAccess::kMap), text);
    }
  }
  // One by one: what removes whole folders takes no such paths on Windows. Only empty ones go.
  EXPECT_TRUE(fs::remove(any_length(named), failed)) << failed.message();
  EXPECT_TRUE(fs::remove(deep / "face.dna", failed)) << failed.message();
  for (int level = 0; level < 6; ++level, deep = deep.parent_path()) {
    EXPECT_TRUE(fs::remove(deep, failed)) << failed.message();
  }
}

TEST(SystemFile, IsReplacedWholeOrNotAtAllWhileItIsMapped) {
  const Folder folder;
  const std::string path = (folder.path / "face.dna").u8string();
  Error error;
  ASSERT_EQ(write_text(path, "first", error), Status::kOk) << error.message;
  MappedFile file;
  ASSERT_EQ(open_file(path.c_str(), FileAccess::kMap, {}, default_allocator(), file, error),
            Status::kOk);
  const Status status = write_text(path, "second", error);
#if !defined(_WIN32)
  EXPECT_EQ(status, Status::kOk);
#endif
  EXPECT_TRUE(status == Status::kOk || status == Status::kFileWrite);
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(file.bytes), file.size), "first");
  close_file(file);
  EXPECT_EQ(text_of(path, FileAccess::kRead), status == Status::kOk ? "second" : "first");
  EXPECT_EQ(folder.entries(), 1u) << "no temporary files";
  EXPECT_EQ(write_text(path, "third", error), Status::kOk) << error.message;
  EXPECT_EQ(text_of(path, FileAccess::kRead), "third");
}

TEST(SystemFile, IsWholeForReadersWhileThreadsReplaceIt) {
  const Folder folder;
  const std::string path = (folder.path / "face.dna").u8string();
  constexpr size_t kSize = 20000;
  Error error;
  ASSERT_EQ(write_text(path, std::string(kSize, 'a'), error), Status::kOk) << error.message;
  std::atomic<int> written{0}, torn{0};
  std::vector<std::thread> threads;
  for (char letter : {'b', 'c', 'd'}) {
    threads.emplace_back([&, letter] {
      for (int i = 0; i < 50; ++i) {
        Error mine;
        written += write_text(path, std::string(kSize, letter), mine) == Status::kOk;
      }
    });
  }
  threads.emplace_back([&] {
    for (int i = 0; i < 100; ++i) {
      const std::string text = text_of(path, i % 2 ? FileAccess::kMap : FileAccess::kRead);
      // On Windows a file that is just being replaced may refuse to open.
      if (text.compare(0, 11, "cannot open") == 0) continue;
      torn += text.size() != kSize || text.find_first_not_of(text[0]) != std::string::npos;
    }
  });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(torn, 0);
#if defined(_WIN32)
  EXPECT_GT(written, 0);
#else
  EXPECT_EQ(written, 150);
#endif
  EXPECT_EQ(folder.entries(), 1u) << "no temporary files";
}

TEST(SystemFile, FailsWithThePathAndTheReason) {
  const Folder folder;
  const std::string path = (folder.path / "missing" / "face.dna").u8string();
  Error error;
  EXPECT_EQ(write_text(path, "text", error), Status::kFileWrite);
  EXPECT_NE(strstr(error.message, "face.dna"), nullptr) << error.message;
  EXPECT_NE(text_of(path, FileAccess::kMap).find("cannot open"), std::string::npos);
  EXPECT_NE(text_of(path, FileAccess::kMap).find("face.dna"), std::string::npos);
}

#if defined(__linux__)
/// Bytes of this process that are in memory.
size_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  size_t pages = 0, resident = 0;
  file >> pages >> resident;
  return resident * 4096;
}
#endif

TEST(ForgetPages, KeepsTheBytes) {
  const Folder folder;
  const std::string path = (folder.path / "large").string();
  std::string text(size_t{16} << 20, 'a');
  for (size_t i = 0; i < text.size(); ++i) text[i] = static_cast<char>(i * 7 + (i >> 12));
  Error error;
  ASSERT_EQ(write_text(path, text, error), Status::kOk) << error.message;
  for (FileAccess access : {FileAccess::kMap, FileAccess::kRead}) {
    MappedFile file;
    ASSERT_EQ(open_file(path.c_str(), access, {}, default_allocator(), file, error), Status::kOk);
    ASSERT_EQ(file.size, text.size());
    EXPECT_EQ(memcmp(file.bytes, text.data(), text.size()), 0);
#if defined(__linux__)
    const size_t before = resident_bytes();
    forget_pages(file);
    if (file.mapped && before != 0) {
      EXPECT_LT(resident_bytes() + text.size() / 2, before);
    }
#else
    forget_pages(file);
#endif
    EXPECT_EQ(memcmp(file.bytes, text.data(), text.size()), 0);
    close_file(file);
    forget_pages(file);  // of nothing
  }
}

}  // namespace
}  // namespace mien
