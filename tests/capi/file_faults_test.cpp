// SPDX-License-Identifier: MIT
// A file system that fails: of each call that reads or writes a file, every k-th call of the system fails
// in turn, or does half of what it was asked for. The status says so, a file that was there is there as it
// was, and nothing is left behind.
#if defined(__linux__) && defined(__LP64__)

#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

#include "tests/support/baked_bytes.h"
#include "tests/support/bytes.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/documents.h"
#include "tests/support/memory_stream.h"
#include "tests/support/public_functions.h"
#include "tests/support/rig_handles.h"

// The calls of the system, in front of those of the C library -------------------------------------

namespace {

struct FailingSystem {
  size_t fail_at = 0;   // this call, counted from 1; 0: none
  bool halves = false;  // reads and writes do half instead of failing, and nothing else fails
  size_t calls = 0;
  const char* failed = nullptr;  // which call it was
};
thread_local FailingSystem* g_system = nullptr;

bool fails(const char* call, bool can_do_half = false) {
  if (!g_system || ++g_system->calls != g_system->fail_at) return false;
  if (g_system->halves && !can_do_half) return false;
  g_system->failed = call;
  errno = EIO;
  return true;
}

/// What the name would mean without this file.
template <class Call>
Call* next(const char* name) {
  return reinterpret_cast<Call*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(arguments, mode_t) : 0;
  va_end(arguments);
  if (fails("open")) return -1;
  return next<int(const char*, int, ...)>("open")(path, flags, mode);
}

int fstat(int descriptor, struct stat* about) noexcept {
  if (fails("fstat")) return -1;
  return next<int(int, struct stat*)>("fstat")(descriptor, about);
}

ssize_t read(int descriptor, void* to, size_t size) {
  if (fails("read", true)) {
    if (!g_system->halves) return -1;
    size = (size + 1) / 2;
  }
  return next<ssize_t(int, void*, size_t)>("read")(descriptor, to, size);
}

ssize_t write(int descriptor, const void* from, size_t size) {
  if (fails("write", true)) {
    if (!g_system->halves) return -1;
    size = (size + 1) / 2;
  }
  return next<ssize_t(int, const void*, size_t)>("write")(descriptor, from, size);
}

int close(int descriptor) {
  const bool failing = fails("close");
  const int status = next<int(int)>("close")(descriptor);
  if (failing) errno = EIO;
  return failing ? -1 : status;
}

int fchmod(int descriptor, mode_t mode) noexcept {
  if (fails("fchmod")) return -1;
  return next<int(int, mode_t)>("fchmod")(descriptor, mode);
}

int rename(const char* from, const char* to) noexcept {
  if (fails("rename")) return -1;
  return next<int(const char*, const char*)>("rename")(from, to);
}

}  // extern "C"

namespace mien {
namespace {

namespace fs = std::filesystem;

Bytes contents(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(in), {});
}

void put(const std::string& path, const Bytes& bytes) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
  ASSERT_TRUE(out.flush());
}

size_t open_descriptors() {
  size_t count = 0;
  for (const auto& entry : fs::directory_iterator("/proc/self/fd")) count += !entry.path().empty();
  return count;
}

/// Public functions that read or write files or streams, by their names.
std::set<std::string> functions_of_files() {
  std::set<std::string> found;
  for (const PublicFunction& function : kPublicFunctions) {
    const std::string name = function.name;
    for (const std::string end : {"_file", "_stream"}) {
      if (name.size() > end.size() &&
          name.compare(name.size() - end.size(), end.size(), end) == 0) {
        found.insert(name);
      }
    }
  }
  return found;
}

/// Runs a call on a system that fails at the k-th of its calls. False if there are not as many.
bool run_failing(size_t k, bool halves, const std::function<MienStatus()>& call, MienStatus& status,
                 std::string& failed) {
  FailingSystem system;
  system.fail_at = k;
  system.halves = halves;
  g_system = &system;
  status = call();
  g_system = nullptr;
  failed = system.failed ? system.failed : "";
  return system.calls >= k;
}

class FileFaults : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "mien_faults_XXXXXX";
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder = pattern;
    dna = generate_dna(MIEN_PRESET_TINY, 1);
    rig = create_rig(dna.get());
    MienClipDesc desc = sized<MienClipDesc>();
    const MienStringView names[] = {{"jawOpen", 7}, {"smile", 5}};
    const float values[] = {0, 1, 0.5f, 0.25f, 1, 0};
    desc.frame_count = 3;
    desc.channel_count = 2;
    desc.names = names;
    desc.values = values;
    ASSERT_EQ(mien_clip_build(&desc, &clip, nullptr), MIEN_OK);
    MienMixLayer layer = {};
    MienMixDesc of_mix = sized<MienMixDesc>();
    of_mix.layers = &layer;
    of_mix.layer_count = 1;
    ASSERT_EQ(mien_mix_create(rig.get(), &of_mix, &mix, nullptr), MIEN_OK);
  }
  /// If all tests ran.
  static void TearDownTestSuite() {
    const testing::TestSuite& suite = *testing::UnitTest::GetInstance()->current_test_suite();
    if (suite.test_to_run_count() != suite.total_test_count()) return;
    EXPECT_EQ(tested, functions_of_files());
  }
  void TearDown() override {
    mien_mix_destroy(mix);
    mien_clip_close(clip);
    fs::remove_all(folder);
  }
  std::string path(const char* name) const { return folder + "/" + name; }
  size_t files() const {
    size_t count = 0;
    for (const auto& entry : fs::directory_iterator(folder)) count += !entry.path().empty();
    return count;
  }

  /// `open` gives a status, and closes what it opened after a look at it.
  void expect_survives_reading(const char* function,
                               const std::function<MienStatus(MienError*)>& open) {
    tested.insert(function);
    const size_t descriptors = open_descriptors();
    for (const bool halves : {false, true}) {
      for (size_t k = 1;; ++k) {
        MienError error = sized<MienError>();
        MienStatus status = MIEN_OK;
        std::string failed;
        if (!run_failing(
                k, halves, [&] { return open(&error); }, status, failed))
          break;
        SCOPED_TRACE(std::to_string(k) + ": " + failed);
        EXPECT_EQ(open_descriptors(), descriptors);
        // Closing what was read loses nothing.
        if (failed.empty() || halves || failed == "close") {
          EXPECT_EQ(status, MIEN_OK) << error.message;
        } else {
          EXPECT_EQ(status, failed == "open" ? MIEN_ERROR_FILE_OPEN : MIEN_ERROR_FILE_READ);
          EXPECT_NE(std::string(error.message).find(folder), std::string::npos) << error.message;
        }
        ASSERT_LT(k, 1000u);
      }
    }
  }

  void expect_survives_writing(const char* function,
                               const std::function<MienStatus(const char*, MienError*)>& write) {
    tested.insert(function);
    const std::string to = path("file");
    ASSERT_EQ(write(to.c_str(), nullptr), MIEN_OK);
    const Bytes written = contents(to), old = {1, 2, 3};
    const size_t descriptors = open_descriptors();
    for (const bool exists : {false, true}) {
      for (const bool halves : {false, true}) {
        for (size_t k = 1;; ++k) {
          fs::remove(to);
          if (exists) put(to, old);
          MienError error = sized<MienError>();
          MienStatus status = MIEN_OK;
          std::string failed;
          const auto call = [&] { return write(to.c_str(), &error); };
          const bool more = run_failing(k, halves, call, status, failed);
          SCOPED_TRACE(std::to_string(k) + ": " + failed);
          EXPECT_EQ(open_descriptors(), descriptors);
          if (failed.empty() || halves) {
            EXPECT_EQ(status, MIEN_OK) << error.message;
            EXPECT_EQ(contents(to), written);
          } else {
            EXPECT_EQ(status, MIEN_ERROR_FILE_WRITE);
            EXPECT_NE(error.message[0], 0);
            EXPECT_EQ(fs::exists(to), exists);
            if (exists) {
              EXPECT_EQ(contents(to), old);
            }
          }
          EXPECT_EQ(files(), fs::exists(to) ? 1u : 0u) << "something was left";
          if (!more) {
            EXPECT_GT(k, 4u) << "open, write, close, rename";
            break;
          }
          ASSERT_LT(k, 1000u);
        }
      }
    }
  }

  std::string folder;
  DnaHandle dna;
  RigHandle rig;
  MienClip* clip = nullptr;
  MienMix* mix = nullptr;
  static std::set<std::string> tested;  // functions
};
std::set<std::string> FileFaults::tested;

TEST_F(FileFaults, DnaFilesAreReadOrRefused) {
  const std::string file = path("a.dna");
  put(file, write_dna(dna.get()));
  for (const uint32_t access : {MIEN_FILE_MAP, MIEN_FILE_READ}) {
    expect_survives_reading("mien_dna_open_file", [&](MienError* error) {
      MienDnaDesc desc = sized<MienDnaDesc>();
      desc.file_access = access;
      MienDna* opened = nullptr;
      const MienStatus status = mien_dna_open_file(file.c_str(), &desc, &opened, error);
      EXPECT_EQ(opened != nullptr, status == MIEN_OK);
      if (opened) {
        EXPECT_EQ(write_dna(opened), write_dna(dna.get()));
      }
      mien_dna_close(opened);
      return status;
    });
  }
}

TEST_F(FileFaults, ReportsAreMadeOrRefused) {
  const std::string file = path("a.dna");
  put(file, write_dna(dna.get()));
  expect_survives_reading("mien_dna_validate_file", [&](MienError* error) {
    MienReport* report = nullptr;
    const MienStatus status = mien_dna_validate_file(file.c_str(), nullptr, &report, error);
    EXPECT_EQ(report != nullptr, status == MIEN_OK);
    mien_report_destroy(report);
    return status;
  });
}

TEST_F(FileFaults, DocumentsAreReadOrRefused) {
  const std::string file = path("a.dna");
  put(file, write_dna(dna.get()));
  for (const uint32_t access : {MIEN_FILE_MAP, MIEN_FILE_READ}) {
    expect_survives_reading("mien_document_open_file", [&](MienError* error) {
      MienDocumentDesc desc = sized<MienDocumentDesc>();
      desc.file_access = access;
      MienDocument* opened = nullptr;
      const MienStatus status = mien_document_open_file(file.c_str(), &desc, &opened, error);
      EXPECT_EQ(opened != nullptr, status == MIEN_OK);
      mien_document_destroy(opened);
      return status;
    });
  }
}

TEST_F(FileFaults, DocumentsAreWrittenWholeOrNotAtAll) {
  const DocumentHandle document = create_document(dna.get());
  expect_survives_writing("mien_document_write_file", [&](const char* to, MienError* error) {
    return mien_document_write_file(document.get(), to, nullptr, error);
  });
  // A sink that takes the first bytes only.
  tested.insert("mien_document_write_stream");
  struct Sink {
    size_t room, taken, calls;
  };
  MienByteSink to = {nullptr, [](void* user, const void*, size_t size) {
                       Sink& sink = *static_cast<Sink*>(user);
                       ++sink.calls;
                       const size_t takes = std::min(size, sink.room - sink.taken);
                       sink.taken += takes;
                       return takes;
                     }};
  const size_t size = write_dna(dna.get()).size();
  for (const size_t room : {size_t{0}, size / 2, size - 1, size}) {
    Sink sink = {room, 0, 0};
    to.user = &sink;
    MienError error = sized<MienError>();
    const MienStatus status = mien_document_write_stream(document.get(), &to, nullptr, &error);
    EXPECT_EQ(status, room == size ? MIEN_OK : MIEN_ERROR_FILE_WRITE) << error.message;
    EXPECT_EQ(sink.taken, room);
    EXPECT_GT(sink.calls, 0u);
  }
}

TEST_F(FileFaults, BakedFilesAreReadOrRefused) {
  const std::string file = path("a.mien");
  put(file, bake(rig.get()));
  for (const uint32_t access : {MIEN_FILE_MAP, MIEN_FILE_READ}) {
    expect_survives_reading("mien_baked_open_file", [&](MienError* error) {
      MienBakedDesc desc = sized<MienBakedDesc>();
      desc.file_access = access;
      desc.check = MIEN_BAKED_CHECK_FULL;
      MienBaked* opened = nullptr;
      const MienStatus status = mien_baked_open_file(file.c_str(), &desc, &opened, error);
      EXPECT_EQ(opened != nullptr, status == MIEN_OK);
      mien_baked_close(opened);
      return status;
    });
  }
}

TEST_F(FileFaults, ClipsAreReadOrRefused) {
  const std::string file = path("a.clip");
  ASSERT_EQ(mien_clip_write_file(clip, file.c_str(), nullptr), MIEN_OK);
  for (const uint32_t access : {MIEN_FILE_MAP, MIEN_FILE_READ}) {
    expect_survives_reading("mien_clip_open_file", [&](MienError* error) {
      MienClipOpenDesc desc = sized<MienClipOpenDesc>();
      desc.file_access = access;
      MienClip* opened = nullptr;
      const MienStatus status = mien_clip_open_file(file.c_str(), &desc, &opened, error);
      EXPECT_EQ(opened != nullptr, status == MIEN_OK);
      mien_clip_close(opened);
      return status;
    });
  }
}

TEST_F(FileFaults, MixesAreReadOrRefused) {
  const std::string file = path("a.mix");
  ASSERT_EQ(mien_mix_write_file(mix, file.c_str(), nullptr), MIEN_OK);
  expect_survives_reading("mien_mix_open_file", [&](MienError* error) {
    MienMix* opened = nullptr;
    const MienStatus status = mien_mix_open_file(file.c_str(), rig.get(), nullptr, &opened, error);
    EXPECT_EQ(opened != nullptr, status == MIEN_OK);
    mien_mix_destroy(opened);
    return status;
  });
}

TEST_F(FileFaults, FilesAreWrittenWholeOrNotAtAll) {
  expect_survives_writing("mien_dna_write_file", [&](const char* to, MienError* error) {
    return mien_dna_write_file(dna.get(), to, nullptr, error);
  });
  expect_survives_writing("mien_bake_file", [&](const char* to, MienError* error) {
    return mien_bake_file(rig.get(), nullptr, to, error);
  });
  expect_survives_writing("mien_clip_write_file", [&](const char* to, MienError* error) {
    return mien_clip_write_file(clip, to, error);
  });
  expect_survives_writing("mien_mix_write_file", [&](const char* to, MienError* error) {
    return mien_mix_write_file(mix, to, error);
  });
}

// Every read of every stream ----------------------------------------------------------------------

TEST_F(FileFaults, StreamsMayFailAtEveryRead) {
  const Bytes dna_bytes = write_dna(dna.get()), baked_bytes = bake(rig.get());
  size_t size = 0;
  ASSERT_EQ(mien_clip_write_memory(clip, nullptr, 0, &size, nullptr), MIEN_OK);
  Bytes clip_bytes(size);
  ASSERT_EQ(mien_clip_write_memory(clip, clip_bytes.data(), size, &size, nullptr), MIEN_OK);
  const auto survives = [](const char* function, const Bytes& bytes, const auto& open) {
    tested.insert(function);
    for (const bool reads_short : {false, true}) {
      for (size_t k = 1;; ++k) {
        SCOPED_TRACE("read " + std::to_string(k));
        MemoryStream source(bytes);
        source.fail_at = k;
        source.reads_short = reads_short;
        const Stream stream = source.get();
        const MienStream given = {stream.user, stream.size, stream.read};
        CountingAllocator counter;
        const MienAllocator allocator = counter.get();
        MienError error = sized<MienError>();
        const MienStatus status = open(given, allocator, error);
        EXPECT_TRUE(counter.clean()) << counter.first_wrong;
        EXPECT_EQ(source.wrong, "");
        if (source.reads < k) {
          EXPECT_EQ(status, MIEN_OK) << error.message;
          EXPECT_GT(k, 1u);
          break;
        }
        EXPECT_EQ(status, MIEN_ERROR_FILE_READ);
        EXPECT_NE(error.message[0], 0);
      }
    }
  };
  survives("mien_dna_open_stream", dna_bytes,
           [](const MienStream& stream, const MienAllocator& allocator, MienError& error) {
             const auto desc = desc_with<MienDnaDesc>(&allocator);
             MienDna* opened = nullptr;
             const MienStatus status = mien_dna_open_stream(&stream, &desc, &opened, &error);
             mien_dna_close(opened);
             return status;
           });
  survives("mien_baked_open_stream", baked_bytes,
           [](const MienStream& stream, const MienAllocator& allocator, MienError& error) {
             const auto desc = desc_with<MienBakedDesc>(&allocator);
             MienBaked* opened = nullptr;
             const MienStatus status = mien_baked_open_stream(&stream, &desc, &opened, &error);
             mien_baked_close(opened);
             return status;
           });
  survives("mien_clip_open_stream", clip_bytes,
           [](const MienStream& stream, const MienAllocator& allocator, MienError& error) {
             const auto desc = desc_with<MienClipOpenDesc>(&allocator);
             MienClip* opened = nullptr;
             const MienStatus status = mien_clip_open_stream(&stream, &desc, &opened, &error);
             mien_clip_close(opened);
             return status;
           });
}

// Writing takes memory from the allocator of what is written --------------------------------------

TEST_F(FileFaults, WritingWithoutMemoryWritesNothing) {
  CountingAllocator counter;
  const MienAllocator allocator = counter.get();
  MienRigDesc desc = desc_with<MienRigDesc>(&allocator);
  MienRig* counted = nullptr;
  ASSERT_EQ(mien_rig_create(dna.get(), &desc, &counted, nullptr), MIEN_OK);
  counter.restart();
  const std::string to = path("file");
  ASSERT_EQ(mien_bake_file(counted, nullptr, to.c_str(), nullptr), MIEN_OK);
  const size_t requests = counter.requests, bytes = counter.bytes;
  EXPECT_GE(requests, 2u);
  fs::remove(to);
  for (size_t k = 1; k <= requests; ++k) {
    counter.restart();
    counter.fail_at = k;
    MienError error = sized<MienError>();
    EXPECT_EQ(mien_bake_file(counted, nullptr, to.c_str(), &error), MIEN_ERROR_MEMORY) << k;
    EXPECT_NE(error.message[0], 0);
    EXPECT_EQ(counter.bytes, bytes);
    EXPECT_EQ(files(), 0u);
  }
  mien_rig_destroy(counted);
  EXPECT_TRUE(counter.clean()) << counter.first_wrong;
}

}  // namespace
}  // namespace mien

#endif
