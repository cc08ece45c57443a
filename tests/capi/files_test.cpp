// SPDX-License-Identifier: MIT
// Files behind mien.h: reading them in both ways, writing them so that nothing is lost if it fails,
// and what is no file but a pipe or a device.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/support/counting_allocator.h"
#include "tests/support/golden.h"
#include "tests/support/memory_stream.h"
#include "tests/support/misuse.h"

namespace mien {
namespace {

namespace fs = std::filesystem;

Bytes read_all(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(in), {});
}

void write_all(const std::string& path, const Bytes& bytes) {
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
  ASSERT_TRUE(out.flush());
}

/// A folder of its own for each test.
class Files : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "mien_files_XXXXXX";
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder = pattern;
    dna = generate_dna(MIEN_PRESET_TINY, 1);
    bytes = write_dna(dna.get());
  }
  void TearDown() override { fs::remove_all(folder); }

  std::string path(const std::string& name) const { return folder + "/" + name; }
  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      found.push_back(entry.path().filename());
    }
    std::sort(found.begin(), found.end());
    return found;
  }
  MienStatus write(const std::string& to, MienError* error = nullptr) const {
    return mien_dna_write_file(dna.get(), to.c_str(), nullptr, error);
  }
  DnaHandle open(const std::string& from, uint32_t access = MIEN_FILE_MAP) const {
    MienDnaDesc desc = sized<MienDnaDesc>();
    desc.file_access = access;
    MienError error = sized<MienError>();
    MienDna* opened = nullptr;
    EXPECT_EQ(mien_dna_open_file(from.c_str(), &desc, &opened, &error), MIEN_OK) << error.message;
    return DnaHandle(opened);
  }

  std::string folder;
  DnaHandle dna;
  Bytes bytes;  // what writing `dna` gives
};

// Reading -----------------------------------------------------------------------------------------

TEST_F(Files, MappedOrRead) {
  write_all(path("a.dna"), bytes);
  const DnaHandle mapped = open(path("a.dna")), read = open(path("a.dna"), MIEN_FILE_READ);
  EXPECT_EQ(info_of(mapped).is_mapped, 1u);
  EXPECT_EQ(info_of(read).is_mapped, 0u);
  EXPECT_EQ(info_of(mapped).file_bytes, bytes.size());
  EXPECT_EQ(info_of(read).file_bytes, bytes.size());
  EXPECT_GE(info_of(read).memory_bytes, info_of(mapped).memory_bytes + bytes.size());
  EXPECT_EQ(write_dna(mapped.get()), bytes);
  EXPECT_EQ(write_dna(read.get()), bytes);
}

// "for files that others may truncate meanwhile"
TEST_F(Files, ReadFilesMayBeTruncated) {
  write_all(path("a.dna"), bytes);
  const DnaHandle read = open(path("a.dna"), MIEN_FILE_READ);
  fs::resize_file(path("a.dna"), 0);
  EXPECT_EQ(write_dna(read.get()), bytes);
}

// What the structs say about memory is what the allocator was asked for.
TEST_F(Files, MemoryIsCounted) {
  write_all(path("a.dna"), bytes);
  for (uint32_t access : {uint32_t{MIEN_FILE_MAP}, uint32_t{MIEN_FILE_READ}}) {
    KeepingAllocator kept;
    MienDnaDesc desc = sized<MienDnaDesc>();
    desc.file_access = access;
    desc.allocator = &kept.interface;
    MienDna* opened = nullptr;
    ASSERT_EQ(mien_dna_open_file(path("a.dna").c_str(), &desc, &opened, nullptr), MIEN_OK);
    const DnaHandle from(opened);
    EXPECT_EQ(info_of(from).memory_bytes, kept.live_bytes);

    // A rig is one block, and so is an instance.
    const size_t before = kept.live_bytes;
    MienRigDesc rig_desc = sized<MienRigDesc>();
    rig_desc.allocator = &kept.interface;
    MienRig* rig = nullptr;
    MienInstance* instance = nullptr;
    ASSERT_EQ(mien_rig_create(opened, &rig_desc, &rig, nullptr), MIEN_OK);
    const RigHandle made(rig);
    EXPECT_EQ(info_of(made).rig_bytes, kept.live_bytes - before);
    const size_t blocks = kept.blocks.size(), with_rig = kept.live_bytes;
    const auto instance_desc = desc_with<MienInstanceDesc>(&kept.interface);
    ASSERT_EQ(mien_instance_create(rig, &instance_desc, &instance, nullptr), MIEN_OK);
    const InstanceHandle character(instance);
    EXPECT_EQ(kept.blocks.size(), blocks + 1);
    EXPECT_EQ(info_of(made).instance_bytes, kept.live_bytes - with_rig);
    EXPECT_EQ(mien_rig_evaluate(rig, instance, 0), MIEN_OK);
    EXPECT_EQ(kept.blocks.size(), blocks + 1) << "evaluation allocates nothing";
  }
}

// "memory taken is at most six times the bytes of the chosen layers", but for what the handle
// itself takes.
TEST_F(Files, MemoryIsBounded) {
  std::vector<Bytes> files = {bytes, write_dna(generate_dna(MIEN_PRESET_SMALL, 1).get())};
  for (const std::string& name : golden::present_names()) files.push_back(golden::read_rig(name));
  for (const Bytes& file : files) {
    MienDna* opened = nullptr;
    ASSERT_EQ(mien_dna_open_memory(file.data(), file.size(), nullptr, &opened, nullptr), MIEN_OK);
    const DnaHandle from(opened);
    EXPECT_LE(info_of(from).memory_bytes, 6 * file.size() + 20 * 1024);
  }
}

/// Of LOD 0 alone, against the values of the pieces that are not all zeros (8 floats each).
double rig_bytes_per_stored_byte(const Bytes& file) {
  const RigHandle rig = create_rig(open_dna(file, 1).get());
  MienRigStatistics statistics = sized<MienRigStatistics>();
  EXPECT_EQ(mien_rig_statistics(rig.get(), 0, &statistics), MIEN_OK);
  const double stored = static_cast<double>(statistics.joint_entry_count) * sizeof(float);
  const double ratio = static_cast<double>(info_of(rig).rig_bytes) / stored;
  printf("rig of %llu bytes: %.3f times the stored pieces\n",
         static_cast<unsigned long long>(info_of(rig).rig_bytes), ratio);
  return ratio;
}

// rig bytes <= 1.1 * (1.1 * values of the stored pieces): a tenth for their block numbers and the
// tables of columns, and a tenth of it all for tables, correctives, names and the neutral pose.
constexpr double kMaxPerStoredByte = 1.1 * 1.1;

TEST_F(Files, ALargeRigIsLittleMoreThanItsMatrix) {
  EXPECT_LE(rig_bytes_per_stored_byte(write_dna(generate_dna(MIEN_PRESET_LARGE, 1).get())),
            kMaxPerStoredByte);
}

TEST_F(Files, AHeadIsLittleMoreThanItsMatrix) {
  if (!golden::has_head()) GTEST_SKIP() << golden::no_head();
  const Bytes file = golden::read_rig(golden::kHead);
  EXPECT_LE(rig_bytes_per_stored_byte(file), kMaxPerStoredByte);
  EXPECT_LE(info_of(create_rig(open_dna(file).get())).instance_bytes, 40u * 1024);
}

TEST_F(Files, FilesThatCannotBeOpened) {
  write_all(path("a.dna"), bytes);
  write_all(path("empty.dna"), {});
  const struct {
    std::string path;
    MienStatus status;
  } cases[] = {{path("none.dna"), MIEN_ERROR_FILE_OPEN},
               {path("none/a.dna"), MIEN_ERROR_FILE_OPEN},
               {path("a.dna/b.dna"), MIEN_ERROR_FILE_OPEN},
               {"", MIEN_ERROR_FILE_OPEN},
               {path(std::string(5000, 'x')), MIEN_ERROR_FILE_OPEN},
               {folder, MIEN_ERROR_FILE_READ},
               {path("empty.dna"), MIEN_ERROR_DNA_SIGNATURE},
               {"/dev/null", MIEN_ERROR_DNA_SIGNATURE}};
  for (const auto& c : cases) {
    for (uint32_t access : {uint32_t{MIEN_FILE_MAP}, uint32_t{MIEN_FILE_READ}}) {
      MienDnaDesc desc = sized<MienDnaDesc>();
      desc.file_access = access;
      MienError error = sized<MienError>();
      MienDna* opened = dna.get();
      EXPECT_EQ(mien_dna_open_file(c.path.c_str(), &desc, &opened, &error), c.status) << c.path;
      EXPECT_EQ(opened, nullptr);
      EXPECT_EQ(error.status, c.status);
      EXPECT_GT(strlen(error.message), 0u);
    }
    // A report says the same, or tells it as a finding.
    MienReport* report = nullptr;
    MienError error = sized<MienError>();
    const MienStatus status = mien_dna_validate_file(c.path.c_str(), nullptr, &report, &error);
    EXPECT_EQ(error.status, status);
    if (c.status == MIEN_ERROR_DNA_SIGNATURE) {
      MienFinding finding = sized<MienFinding>();
      EXPECT_EQ(status, MIEN_OK) << "the file could be examined";
      EXPECT_EQ(mien_report_finding(report, 0, &finding), MIEN_OK);
      EXPECT_EQ(finding.status, c.status);
    } else {
      EXPECT_EQ(status, c.status);
      EXPECT_EQ(report, nullptr);
    }
    mien_report_destroy(report);
  }
}

// "read into memory where the system cannot map (pipes)"
TEST_F(Files, PipesAreReadToTheirEnd) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  for (uint32_t preset : {MIEN_PRESET_TINY, MIEN_PRESET_SMALL}) {  // one that does not fit into it
    const Bytes sent = write_dna(generate_dna(preset, 2).get());
    std::thread writer([&] { write_all(path("pipe"), sent); });
    const DnaHandle read = open(path("pipe"));
    writer.join();
    EXPECT_EQ(info_of(read).is_mapped, 0u);
    EXPECT_EQ(info_of(read).file_bytes, sent.size());
    EXPECT_EQ(write_dna(read.get()), sent);
  }
}

// Writing -----------------------------------------------------------------------------------------

TEST_F(Files, WritesWhatMemoryGets) {
  EXPECT_EQ(write(path("a.dna")), MIEN_OK);
  EXPECT_EQ(read_all(path("a.dna")), bytes);
  write_all(path("a.dna"), Bytes(3 * bytes.size(), 7));
  EXPECT_EQ(write(path("a.dna")), MIEN_OK);
  EXPECT_EQ(read_all(path("a.dna")), bytes);
  EXPECT_EQ(write(path("a gesicht \xC3\xA4\xF0\x9F\x99\x82.dna")), MIEN_OK);
  EXPECT_EQ(read_all(path("a gesicht \xC3\xA4\xF0\x9F\x99\x82.dna")), bytes);
  EXPECT_EQ(names().size(), 2u) << "no temporary file is left";
}

TEST_F(Files, FailuresLeaveNothingBehind) {
  write_all(path("file"), {1, 2, 3});
  fs::create_directory(path("folder"));
  const std::vector<std::string> before = names();
  for (const std::string& to :
       {path("none/a.dna"), path("file/a.dna"), path("folder"), folder, std::string(),
        path(std::string(5000, 'x')), std::string("/proc/a.dna")}) {
    MienError error = sized<MienError>();
    EXPECT_EQ(write(to, &error), MIEN_ERROR_FILE_WRITE) << to;
    EXPECT_EQ(error.status, MIEN_ERROR_FILE_WRITE);
    EXPECT_GT(strlen(error.message), to.empty() ? 0u : 10u);
  }
  EXPECT_EQ(names(), before);
  EXPECT_EQ(read_all(path("file")), Bytes({1, 2, 3}));
  EXPECT_TRUE(fs::is_empty(path("folder")));
}

// A disk that is full in the middle of a file, as far as a test can have one.
TEST_F(Files, FailureLeavesTheOldFile) {
  const Bytes old = {'o', 'l', 'd'};
  write_all(path("a.dna"), old);
  rlimit limit;
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
  const rlimit small = {bytes.size() / 2, limit.rlim_max};
  void (*const handler)(int) = signal(SIGXFSZ, SIG_IGN);
  MienError error = sized<MienError>();
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const MienStatus over = write(path("a.dna"), &error), fresh = write(path("b.dna"));
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  signal(SIGXFSZ, handler);
  EXPECT_EQ(over, MIEN_ERROR_FILE_WRITE);
  EXPECT_EQ(fresh, MIEN_ERROR_FILE_WRITE);
  EXPECT_GT(strlen(error.message), 0u);
  EXPECT_EQ(read_all(path("a.dna")), old);
  EXPECT_EQ(names(), std::vector<std::string>{"a.dna"});
}

// What, where and why: of a long path its end, in whole characters.
TEST_F(Files, MessagesNameTheFile) {
  std::string folders;
  for (int i = 0; i < 30; ++i) folders += "/f\u00f6lder";
  MienDna* opened = nullptr;
  MienError error = sized<MienError>();
  for (const std::string& where : {path("not-there.dna"), path(folders + "/not-there.dna")}) {
    ASSERT_EQ(mien_dna_open_file(where.c_str(), nullptr, &opened, &error), MIEN_ERROR_FILE_OPEN);
    const std::string said = error.message;
    EXPECT_EQ(said.rfind("cannot open ", 0), 0u) << said;
    EXPECT_NE(said.find("/not-there.dna: " + std::string(strerror(ENOENT))), std::string::npos)
        << said;
  }
  const std::string said = error.message;
  const size_t cut = said.find("...");
  ASSERT_NE(cut, std::string::npos) << said;
  EXPECT_NE(static_cast<unsigned char>(said[cut + 3]) & 0xC0, 0x80) << "within a character";
}

// "replacing it by renaming is safe"
TEST_F(Files, WritingOverTheOpenFile) {
  EXPECT_EQ(write(path("a.dna")), MIEN_OK);
  const DnaHandle opened = open(path("a.dna"));
  ASSERT_EQ(info_of(opened).is_mapped, 1u);

  MienWriteDesc desc = sized<MienWriteDesc>();
  desc.version = 1;
  ASSERT_EQ(mien_dna_write_file(opened.get(), path("a.dna").c_str(), &desc, nullptr), MIEN_OK);
  EXPECT_EQ(write_dna(opened.get()), bytes) << "the view is of the old file";
  EXPECT_EQ(info_of(open(path("a.dna"))).version, 1u);
  EXPECT_EQ(mien_dna_write_file(opened.get(), path("a.dna").c_str(), nullptr, nullptr), MIEN_OK);
  EXPECT_EQ(read_all(path("a.dna")), bytes);
  EXPECT_EQ(names().size(), 1u);
}

// A pipe comes first: it shows without harm that nothing is put in a device's place.
TEST_F(Files, DevicesAreWrittenToAndSurvive) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  const int reader = ::open(path("pipe").c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  ASSERT_LT(bytes.size(), 65536u) << "does not fit into a pipe";
  EXPECT_EQ(write(path("pipe")), MIEN_OK);
  Bytes arrived(bytes.size() + 1);
  const ssize_t count = ::read(reader, arrived.data(), arrived.size());
  close(reader);
  ASSERT_EQ(count, static_cast<ssize_t>(bytes.size()));
  arrived.pop_back();
  EXPECT_EQ(arrived, bytes);
  ASSERT_TRUE(fs::is_fifo(path("pipe"))) << "replaced by a file";

  EXPECT_EQ(write("/dev/null"), MIEN_OK);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  if (!fs::is_character_file("/dev/full"))
    GTEST_SKIP() << "NOT TESTED: a full disk; there is no /dev/full";
  MienError error = sized<MienError>();
  EXPECT_EQ(write("/dev/full", &error), MIEN_ERROR_FILE_WRITE);
  EXPECT_NE(std::string(error.message).find("/dev/full"), std::string::npos) << error.message;
  EXPECT_NE(std::string(error.message).find(strerror(ENOSPC)), std::string::npos) << error.message;
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
  // Larger than any buffer on the way.
  const DnaHandle large = generate_dna(MIEN_PRESET_SMALL, 1);
  EXPECT_EQ(mien_dna_write_file(large.get(), "/dev/full", nullptr, &error), MIEN_ERROR_FILE_WRITE);
  EXPECT_EQ(mien_dna_write_file(large.get(), "/dev/null", nullptr, &error), MIEN_OK);
}

TEST_F(Files, DevicesWithoutEndStopAtTheSignature) {
  if (!fs::is_character_file("/dev/zero"))
    GTEST_SKIP() << "NOT TESTED: devices without end; there is no /dev/zero";
  MienError error = sized<MienError>();
  MienDna* opened = nullptr;
  EXPECT_EQ(mien_dna_open_file("/dev/zero", nullptr, &opened, &error), MIEN_ERROR_DNA_SIGNATURE);
  MienBaked* baked = nullptr;
  EXPECT_EQ(mien_baked_open_file("/dev/zero", nullptr, &baked, &error), MIEN_ERROR_BAKED_SIGNATURE);
  MienReport* report = nullptr;
  EXPECT_EQ(mien_dna_validate_file("/dev/zero", nullptr, &report, &error), MIEN_OK);
  mien_report_destroy(report);
}

mode_t mode_of(const std::string& path) {
  struct stat about;
  return stat(path.c_str(), &about) == 0 ? about.st_mode & 07777 : 0;
}

TEST_F(Files, WritingKeepsThePermissions) {
  for (const mode_t mode : {0600, 0640, 0444, 0664, 0755, 0400}) {
    write_all(path("a.dna"), {1});
    ASSERT_EQ(chmod(path("a.dna").c_str(), mode), 0);
    EXPECT_EQ(write(path("a.dna")), MIEN_OK);
    EXPECT_EQ(mode_of(path("a.dna")), mode);
    EXPECT_EQ(read_all(path("a.dna")), bytes);
    fs::remove(path("a.dna"));
  }
  const mode_t mask = umask(027);
  EXPECT_EQ(write(path("new.dna")), MIEN_OK);
  umask(mask);
  EXPECT_EQ(mode_of(path("new.dna")), mode_t{0640}) << "as any new file";
  // What runs as its owner is no longer what was trusted to.
  write_all(path("set.dna"), {1});
  ASSERT_EQ(chmod(path("set.dna").c_str(), 04755), 0);
  EXPECT_EQ(write(path("set.dna")), MIEN_OK);
  EXPECT_EQ(mode_of(path("set.dna")), mode_t{0755});
}

TEST_F(Files, WritingFollowsLinks) {
  fs::create_directory(path("other"));
  write_all(path("other/a.dna"), {1});
  fs::create_symlink("other/a.dna", path("link.dna"));
  fs::create_symlink("link.dna", path("link of link.dna"));
  EXPECT_EQ(write(path("link of link.dna")), MIEN_OK);
  EXPECT_EQ(read_all(path("other/a.dna")), bytes);
  EXPECT_TRUE(fs::is_symlink(path("link.dna")) && fs::is_symlink(path("link of link.dna")));
  // Nothing is made where a link leads nowhere.
  fs::create_symlink("other/none.dna", path("nowhere.dna"));
  fs::create_symlink("circle.dna", path("circle.dna"));
  for (const char* name : {"nowhere.dna", "circle.dna"}) {
    MienError error = sized<MienError>();
    EXPECT_EQ(write(path(name), &error), MIEN_ERROR_FILE_WRITE) << name;
    EXPECT_TRUE(fs::is_symlink(path(name)));
  }
  EXPECT_FALSE(fs::exists(path("other/none.dna")));
  // A name of two keeps its contents: the other one is a new file.
  write_all(path("b.dna"), {7});
  fs::create_hard_link(path("b.dna"), path("c.dna"));
  EXPECT_EQ(write(path("b.dna")), MIEN_OK);
  EXPECT_EQ(read_all(path("c.dna")), Bytes({7}));
}

TEST_F(Files, NamesMayBeAsLongAsTheSystemTakes) {
  const std::string name = std::string(251, 'n') + ".dna";
  EXPECT_EQ(write(path(name)), MIEN_OK);
  EXPECT_EQ(write(path(name)), MIEN_OK);
  EXPECT_EQ(read_all(path(name)), bytes);
  EXPECT_EQ(names(), std::vector<std::string>{name});
}

TEST_F(Files, StreamsAreReadWhereChosenAndNeededNoLonger) {
  MemoryStream source(bytes);
  const Stream inner = source.get();
  MienStream stream = {inner.user, inner.size, inner.read};
  CountingAllocator counter;
  const MienAllocator allocator = counter.get();
  MienDnaDesc desc = sized<MienDnaDesc>();
  desc.layers = MIEN_LAYER_BEHAVIOR;
  desc.allocator = &allocator;
  MienDna* opened = nullptr;
  MienError error = sized<MienError>();
  ASSERT_EQ(mien_dna_open_stream(&stream, &desc, &opened, &error), MIEN_OK) << error.message;
  DnaHandle read(opened);
  EXPECT_FALSE(info_of(read).is_mapped);
  EXPECT_EQ(info_of(read).file_bytes, bytes.size());
  EXPECT_EQ(info_of(read).memory_bytes, counter.bytes);
  source.bytes.assign(bytes.size(), 0xEE);
  EXPECT_TRUE(create_rig(read.get()));
  read.reset();
  EXPECT_TRUE(counter.clean()) << counter.first_wrong;

  source.bytes = bytes;
  source.reads = 0;
  source.fail_at = 3;
  EXPECT_EQ(mien_dna_open_stream(&stream, &desc, &opened, &error), MIEN_ERROR_FILE_READ);
  EXPECT_EQ(opened, nullptr);
  EXPECT_NE(error.message[0], 0);
  EXPECT_EQ(mien_dna_open_stream(nullptr, &desc, &opened, &error), MIEN_ERROR_NULL_ARGUMENT);
  stream.read = nullptr;
  EXPECT_EQ(mien_dna_open_stream(&stream, &desc, &opened, &error), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_TRUE(counter.clean()) << counter.first_wrong;
}

}  // namespace
}  // namespace mien
