// SPDX-License-Identifier: MIT
// Files from outside: cut off, flipped, contradicting themselves. Whatever the bytes are, opening
// gives a known status and a sentence, what opens can be used to the end (exercise_dna.h tells
// how), and memory stays in proportion to the file. hostile_test.cpp has files made with more
// thought.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include "runtime/load/dna/format/dna_view.h"
#include "tests/support/dna_bytes.h"
#include "tests/support/exercise_dna.h"
#include "tests/support/long_run.h"
#include "tests/support/rig_handles.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

/// Every layer, as a file of version 2.`version`.
Bytes tiny_file(uint16_t version) {
  Arena arena(default_allocator());
  dna::DnaView view = dna::tiny_rig(arena);
  if (version == 1) {
    // 2.1 has no place for the pose control that the tongue listens to.
    view.bhvr.joints.groups[1].input_indices = dna::be<uint16_t>(arena, {0, 4, 2});
  }
  return dna::written(view, version);
}

Bytes generated_file(uint16_t version) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_TINY, 7);
  return dna::written(dna->view, version);
}

/// Lives through many broken files; keeps the worst and the tally of ends.
class Survivor {
 public:
  void live_through(const uint8_t* bytes, size_t size, const std::string& what) {
    // A block of its own, so that the address sanitizer sees the first byte past the end.
    const std::unique_ptr<uint8_t[]> copy(new uint8_t[size]);
    if (size) memcpy(copy.get(), bytes, size);
    const Life life = live(copy.get(), size);
    EXPECT_EQ(life.broken, "") << what;
    ++lives_;
    opened_ += life.opened == MIEN_OK;
    compiled_ += life.opened == MIEN_OK && life.compiled == MIEN_OK;
    open_.add(life.open_peak, size);
    rig_.add(life.rig_peak, size);
    report_.add(life.report_peak, size);
  }
  void live_through(const Bytes& bytes, const std::string& what) {
    live_through(bytes.data(), bytes.size(), what);
  }

  size_t lives() const { return lives_; }
  size_t opened() const { return opened_; }

  ~Survivor() {
    printf("%zu files, %zu opened, %zu compiled\n", lives_, opened_, compiled_);
    open_.print("opening");
    rig_.print("a rig and its instance");
    report_.print("a report");
  }

 private:
  // What memory is in proportion to shows in large files only.
  struct Peak {
    size_t bytes = 0;
    double ratio = 0;

    void add(size_t taken, size_t file_size) {
      bytes = std::max(bytes, taken);
      if (file_size >= 100000) ratio = std::max(ratio, double(taken) / double(file_size));
    }
    void print(const char* of) const {
      printf("  %s took at most %zu bytes", of, bytes);
      printf(ratio > 0 ? ", %.1f x a large file\n" : "\n", ratio);
    }
  };

  size_t lives_ = 0, opened_ = 0, compiled_ = 0;
  Peak open_, rig_, report_;
};

/// Cut, set and flipped at every `stride`-th byte; the header and the index at every byte.
void break_everywhere(const Bytes& good, size_t stride, Survivor& survivor) {
  constexpr size_t kFront = 200;
  auto step = [&](size_t at) { return at < kFront ? 1 : stride; };
  for (size_t cut = 0; cut < good.size(); cut += step(cut)) {
    survivor.live_through(good.data(), cut, "cut at " + std::to_string(cut));
  }
  Bytes bad = good;
  for (size_t at = 0; at < good.size(); at += step(at)) {
    const std::string where = " at " + std::to_string(at);
    for (uint8_t value : {uint8_t{0}, uint8_t{0xFF}}) {
      bad[at] = value;
      if (bad[at] != good[at]) survivor.live_through(bad, std::to_string(value) + where);
    }
    for (int bit = 0; bit < 8; ++bit) {
      bad[at] = static_cast<uint8_t>(good[at] ^ (1 << bit));
      survivor.live_through(bad, "bit " + std::to_string(bit) + where);
    }
    bad[at] = good[at];
  }
}

class Version : public testing::TestWithParam<uint16_t> {};
INSTANTIATE_TEST_SUITE_P(Malformed, Version, testing::Values(1, 2, 5, 8));

TEST_P(Version, GoodFilesLiveToTheEnd) {
  for (const Bytes& file : {tiny_file(GetParam()), generated_file(GetParam())}) {
    const Life life = live(file.data(), file.size());
    EXPECT_EQ(life.broken, "");
    EXPECT_EQ(life.opened, MIEN_OK) << life.message;
    EXPECT_EQ(life.compiled, MIEN_OK) << life.message;
  }
}

TEST_P(Version, EveryByteOfASmallFile) {
  const Bytes good = tiny_file(GetParam());
  Survivor survivor;
  break_everywhere(good, byte_stride(), survivor);
  EXPECT_GT(survivor.lives(), 9 * good.size() / byte_stride());
  // Floats and strings may hold anything: not all that is broken is refused.
  EXPECT_GT(survivor.opened(), survivor.lives() / 20);
  EXPECT_LT(survivor.opened(), survivor.lives());
}

TEST_P(Version, SomeBytesOfAGeneratedFile) {
  const Bytes good = generated_file(GetParam());
  Survivor survivor;
  break_everywhere(good, good.size() / 40, survivor);
  EXPECT_GT(survivor.opened(), 0u);
  EXPECT_LT(survivor.opened(), survivor.lives());
}

// Anything that is cut off is told from a whole file: no layer may silently lack its end.
TEST_P(Version, NoCutFileOpens) {
  for (const Bytes& good : {tiny_file(GetParam()), generated_file(GetParam())}) {
    const size_t stride = std::max<size_t>(1, good.size() / 2000);
    for (size_t cut = 0; cut < good.size(); cut += stride) {
      MienDna* dna = nullptr;
      MienError error = sized<MienError>();
      const MienStatus status = mien_dna_open_memory(good.data(), cut, nullptr, &dna, &error);
      const MienStatus expected = cut < 3 ? MIEN_ERROR_DNA_SIGNATURE : MIEN_ERROR_DNA_TRUNCATED;
      // 2.1 does not say how long it is: what is missing may show as a contradiction.
      const bool structure = GetParam() == 1 && status == MIEN_ERROR_DNA_STRUCTURE;
      EXPECT_TRUE(status == expected || structure) << "cut at " << cut << ": " << error.message;
      EXPECT_EQ(dna, nullptr);
    }
  }
}

// Every 32-bit number that says where and how much.
TEST_P(Version, OffsetsSizesAndCountsOfTheContainer) {
  const Bytes good = tiny_file(GetParam());
  const uint32_t size = static_cast<uint32_t>(good.size());
  const uint32_t extremes[] = {0, 1, size - 1, size, size + 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF};
  std::vector<size_t> places;
  if (GetParam() == 1) {
    for (size_t s = 0; s < 8; ++s) places.push_back(7 + 4 * s);
  } else {
    places.push_back(7);
    const size_t layers = dna::number32(good, 7);
    for (size_t i = 0; i < 4 * layers; ++i) places.push_back(11 + 4 * i);
  }
  Survivor survivor;
  for (size_t place : places) {
    for (uint32_t value : extremes) {
      Bytes bad = good;
      dna::set32(bad, place, value);
      survivor.live_through(bad, std::to_string(value) + " at " + std::to_string(place));
    }
  }
  // Two at a time, where they have to add up: an offset and the size beside it.
  for (size_t i = 1; GetParam() != 1 && i < places.size(); i += 4) {
    for (uint32_t offset : extremes) {
      for (uint32_t bytes : extremes) {
        Bytes bad = good;
        dna::set32(bad, places[i + 2], offset);
        dna::set32(bad, places[i + 3], bytes);
        survivor.live_through(bad, std::to_string(offset) + " + " + std::to_string(bytes));
      }
    }
  }
}

// Every count in every layer, found as a big-endian number that fits: also what is no count.
TEST_P(Version, CountsInsideLayers) {
  const Bytes good = tiny_file(GetParam());
  const uint32_t size = static_cast<uint32_t>(good.size());
  Survivor survivor;
  for (size_t at = 7; at + 4 <= good.size(); at += byte_stride()) {
    if (dna::number32(good, at) > 64) continue;
    for (uint32_t value : {dna::number32(good, at) + 1, size, 0x10000u, 0x7FFFFFFFu, 0xFFFFFFFFu}) {
      Bytes bad = good;
      dna::set32(bad, at, value);
      survivor.live_through(bad, std::to_string(value) + " at " + std::to_string(at));
    }
  }
}

// One contradiction at a time ------------------------------------------------------------------

void expect_refused(const Bytes& bytes, MienStatus expected, const char* part_of_message = "") {
  const Life life = live(bytes.data(), bytes.size());
  EXPECT_EQ(life.broken, "");
  EXPECT_STREQ(mien_status_name(life.opened), mien_status_name(expected)) << life.message;
  EXPECT_NE(life.message.find(part_of_message), std::string::npos) << life.message;
}

void expect_accepted(const Bytes& bytes) {
  const Life life = live(bytes.data(), bytes.size());
  EXPECT_EQ(life.broken, "");
  EXPECT_EQ(life.opened, MIEN_OK) << life.message;
  EXPECT_EQ(life.compiled, MIEN_OK) << life.message;
}

constexpr size_t kEntry = 11;  // first entry of the index: code, version, offset, size

size_t entry_of(const Bytes& file, const char* code) {
  const size_t layers = dna::number32(file, 7);
  for (size_t i = 0; i < layers; ++i) {
    if (memcmp(file.data() + kEntry + 16 * i, code, 4) == 0) return kEntry + 16 * i;
  }
  ADD_FAILURE() << "no layer " << code;
  return kEntry;
}

TEST(Container, SignatureAndGeneration) {
  expect_refused({}, MIEN_ERROR_DNA_SIGNATURE, "empty");
  expect_refused({'D'}, MIEN_ERROR_DNA_SIGNATURE);
  expect_refused({'D', 'N', 'B', 0, 2, 0, 8, 0, 0, 0, 0}, MIEN_ERROR_DNA_SIGNATURE);
  expect_refused({'D', 'N', 'A', 0, 2}, MIEN_ERROR_DNA_TRUNCATED);
  Bytes file = tiny_file(8);
  for (uint16_t generation : {uint16_t{0}, uint16_t{1}, uint16_t{3}, uint16_t{0x200}}) {
    file[3] = static_cast<uint8_t>(generation >> 8);
    file[4] = static_cast<uint8_t>(generation);
    expect_refused(file, MIEN_ERROR_DNA_VERSION);
  }
}

TEST(Container, UnknownVersionsAreReadLikeTheNewest) {
  Bytes file = tiny_file(8);
  for (uint16_t version : {uint16_t{0}, uint16_t{9}, uint16_t{0xFFFF}}) {
    file[5] = static_cast<uint8_t>(version >> 8);
    file[6] = static_cast<uint8_t>(version);
    expect_accepted(file);
    const DnaHandle dna = open_dna(file);
    ASSERT_TRUE(dna);
    MienDnaInfo info = sized<MienDnaInfo>();
    ASSERT_EQ(mien_dna_info(dna.get(), &info), MIEN_OK);
    EXPECT_EQ(info.version, version);
    EXPECT_EQ(write_dna(dna.get()), file);
  }
}

TEST(Container, LayersThatOverlap) {
  Bytes file = tiny_file(8);
  const size_t desc = entry_of(file, "desc"), defn = entry_of(file, "defn");
  dna::set32(file, defn + 8, dna::number32(file, desc + 8) + 1);
  expect_refused(file, MIEN_ERROR_DNA_STRUCTURE, "within another");

  file = tiny_file(8);
  dna::set32(file, desc + 12, dna::number32(file, desc + 12) + 1);
  expect_refused(file, MIEN_ERROR_DNA_STRUCTURE, "within another");
}

// They share no bytes with the others, wherever they are said to begin.
TEST(Container, EmptyLayersMayBeginAnywhere) {
  std::vector<dna::Layer> layers = dna::layers_of(tiny_file(8));
  layers.push_back(dna::layer("abce 1.0"));  // in one place with the next, and as large
  layers.push_back(dna::layer("abcd 1.0"));
  Bytes file = dna::file_of(8, layers);
  const size_t entry = entry_of(file, "abcd");
  const auto end = static_cast<uint32_t>(file.size());
  for (uint32_t offset : {0u, 11u, dna::number32(file, entry_of(file, "bhvr") + 8) + 5, end}) {
    dna::set32(file, entry + 8, offset);
    expect_accepted(file);
  }
  dna::set32(file, entry + 8, end + 1);
  expect_refused(file, MIEN_ERROR_DNA_TRUNCATED);
}

TEST(Container, LayersThatComeTwice) {
  std::vector<dna::Layer> layers = dna::layers_of(tiny_file(8));
  layers.push_back(layers[1]);
  expect_refused(dna::file_of(8, layers), MIEN_ERROR_DNA_STRUCTURE, "same kind");
  // Also of a kind that nobody knows.
  layers.back() = dna::layer("abcd 1.0", {1, 2, 3});
  expect_accepted(dna::file_of(8, layers));
  layers.push_back(layers.back());
  expect_refused(dna::file_of(8, layers), MIEN_ERROR_DNA_STRUCTURE, "same kind");
  // Another version of a known layer is another kind.
  layers.back() = dna::layer("desc 1.2", {1, 2, 3});
  expect_accepted(dna::file_of(8, layers));
}

TEST(Container, LayersWithinTheHeaderOrIndex) {
  for (uint32_t offset : {0u, 7u, 11u, 100u}) {
    Bytes file = tiny_file(8);
    dna::set32(file, entry_of(file, "jbmd") + 8, offset);
    expect_refused(file, MIEN_ERROR_DNA_STRUCTURE, "within the index");
  }
}

TEST(Container, LayersBeyondTheEnd) {
  Bytes file = tiny_file(8);
  const size_t dsce = entry_of(file, "dsce");
  dna::set32(file, dsce + 12, 18);
  expect_refused(file, MIEN_ERROR_DNA_TRUNCATED);
  // Offset and size whose sum is small in 32 bits.
  dna::set32(file, dsce + 8, 0xFFFFFFF0);
  dna::set32(file, dsce + 12, 0x20);
  expect_refused(file, MIEN_ERROR_DNA_TRUNCATED);
}

TEST(Container, GapsAndAnyOrderAreFine) {
  std::vector<dna::Layer> layers = dna::layers_of(tiny_file(8));
  std::reverse(layers.begin(), layers.end());
  Bytes file = dna::file_of(8, layers);
  expect_accepted(file);
  file.insert(file.end(), 5, 0xEE);
  expect_accepted(file);
}

TEST(Container, NoLayersAtAll) {
  const Bytes file = dna::file_of(8, {});
  expect_accepted(file);
  for (size_t cut = 0; cut < file.size(); ++cut) {
    expect_refused(Bytes(file.begin(), file.begin() + static_cast<ptrdiff_t>(cut)),
                   cut < 3 ? MIEN_ERROR_DNA_SIGNATURE : MIEN_ERROR_DNA_TRUNCATED);
  }
}

TEST(Container, MissingLayersReadAsDefaultsUnlessOthersNeedThem) {
  const auto without = [](const char* code) {
    std::vector<dna::Layer> kept;
    for (const dna::Layer& layer : dna::layers_of(tiny_file(8))) {
      if (layer.code != code) kept.push_back(layer);
    }
    EXPECT_EQ(kept.size(), 10u) << code;
    return dna::file_of(8, kept);
  };
  for (const char* code : {"geom", "rbfe", "jbmd", "twsw", "mlbe", "dsce"}) {
    SCOPED_TRACE(code);
    const Bytes file = without(code);
    const Life life = live(file.data(), file.size());
    EXPECT_EQ(life.broken, "");
    EXPECT_EQ(life.opened, MIEN_OK) << life.message;
  }
  expect_refused(without("desc"), MIEN_ERROR_DNA_STRUCTURE, "mlbe.mlbTypeData[0]");
  expect_refused(without("defn"), MIEN_ERROR_DNA_REFERENCE, "bhvr.controls.conditionals");
  expect_refused(without("bhvr"), MIEN_ERROR_DNA_REFERENCE, "rbfe.poses[0].outputControlIndices");
  expect_refused(without("mlbh"), MIEN_ERROR_DNA_REFERENCE, "bhvr.joints.jointGroups[1]");
  expect_refused(without("rbfb"), MIEN_ERROR_DNA_STRUCTURE, "rbfe.poses");
}

// Blocks: mesh, network and solver.
// The path, with the index of each list on the way.
TEST(Container, MessagesNameTheFieldThatIsCut) {
  Arena arena(default_allocator());
  const Bytes good = dna::written(dna::tiny_rig(arena));
  const DnaHandle dna = open_dna(good);
  const dna::DnaView& view = dna->view;
  const struct {
    const uint8_t* array;
    const char* path;
  } fields[] = {
      {view.bhvr.joints.groups[1].values.data, "bhvr.joints.jointGroups[1].values: "},
      {view.mlbh.networks[0].layers[1].weights.data, "mlbh.neuralNetworks[0].layers[1].weights: "},
      {view.mlbe.types[0].operations[1][0].parameters.data, "[0].operations[1][0].parameters: "},
  };
  for (const auto& field : fields) {
    Bytes bytes = good;
    dna::set32(bytes, view.offset_of(field.array) - 4, 0x7FFFFFFF);
    MienError error = sized<MienError>();
    MienDna* made = nullptr;
    EXPECT_NE(mien_dna_open_memory(bytes.data(), bytes.size(), nullptr, &made, &error), MIEN_OK);
    EXPECT_NE(strstr(error.message, field.path), nullptr) << error.message;
    mien_dna_close(made);
  }
}

TEST(Container, BlocksThatEndBeforeTheyBeginOrTooLate) {
  const Bytes good = tiny_file(8);
  for (const char* code : {"geom", "mlbh", "rbfb"}) {
    const size_t begin = dna::number32(good, entry_of(good, code) + 8);
    const size_t bytes = dna::number32(good, entry_of(good, code) + 12);
    bool found = false;
    for (size_t at = begin; at + 4 <= begin + bytes; ++at) {
      // The block is the last thing in geom and mlbh; behind the solver come the poses.
      const size_t left = begin + bytes - at - 4;
      const uint32_t value = dna::number32(good, at);
      const size_t poses = strcmp(code, "rbfb") == 0 ? 4 + 2 * (4 + 4 + 4) : 0;
      if (value != left - poses || value < 20) continue;
      found = true;
      const auto with_size = [&](uint32_t size) {
        Bytes file = good;
        dna::set32(file, at, size);
        return file;
      };
      for (uint32_t bad : {0u, 1u, value - 1}) {
        SCOPED_TRACE(bad);
        expect_refused(with_size(bad), MIEN_ERROR_DNA_TRUNCATED, "are left");
      }
      for (uint32_t bad : {uint32_t(left + 1), 0xFFFFFFFFu, 0xFFFFFF00u}) {
        SCOPED_TRACE(bad);
        expect_refused(with_size(bad), MIEN_ERROR_DNA_STRUCTURE, "does not fit into the");
      }
    }
    EXPECT_TRUE(found) << code;
  }
}

// Version 2.1 ----------------------------------------------------------------------------------

size_t section(size_t number) { return 7 + 4 * number; }

TEST(Sections, EndMarker) {
  Bytes file = tiny_file(1);
  ASSERT_EQ(std::string(file.end() - 3, file.end()), "AND");
  for (size_t i = 1; i <= 3; ++i) {
    Bytes bad = file;
    bad[bad.size() - i] ^= 0x20;
    expect_refused(bad, MIEN_ERROR_DNA_STRUCTURE, "AND");
    bad.resize(file.size() - i);
    expect_refused(bad, MIEN_ERROR_DNA_STRUCTURE, "does not fit into the");
  }
  file.push_back(0);  // what follows it is no matter
  expect_accepted(file);
}

TEST(Sections, TwoInOnePlace) {
  const Bytes good = tiny_file(1);
  constexpr size_t kBehavior = 2;  // has no bytes of its own
  for (size_t s = 0; s < 8; ++s) {
    for (size_t t = 0; t < s; ++t) {
      if (s == kBehavior || t == kBehavior) continue;
      Bytes bad = good;
      dna::set32(bad, section(s), dna::number32(good, section(t)));
      expect_refused(bad, MIEN_ERROR_DNA_STRUCTURE, "same place");
    }
  }
}

TEST(Sections, WithinTheHeader) {
  const Bytes good = tiny_file(1);
  for (size_t s = 0; s < 8; ++s) {
    for (uint32_t offset : {0u, 7u, 0x26u}) {
      Bytes bad = good;
      dna::set32(bad, section(s), offset);
      expect_refused(bad, MIEN_ERROR_DNA_STRUCTURE);
    }
  }
}

TEST(Sections, MeshThatEndsBeforeItBegins) {
  const Bytes good = tiny_file(1);
  const size_t mesh = dna::number32(good, section(7)) + 4;  // behind the number of meshes
  ASSERT_EQ(dna::number32(good, mesh), good.size() - 3);
  for (uint32_t end : {0u, 0x27u, uint32_t(mesh), uint32_t(mesh + 3), uint32_t(good.size() - 2),
                       uint32_t(good.size()), 0xFFFFFFFFu}) {
    Bytes bad = good;
    dna::set32(bad, mesh, end);
    expect_refused(bad, MIEN_ERROR_DNA_STRUCTURE);
  }
}

// Files that are none --------------------------------------------------------------------------

class Paths : public testing::Test {
 protected:
  std::string folder;

  void SetUp() override {
    namespace fs = std::filesystem;
    const fs::path made =
        fs::temp_directory_path() / ("mien_malformed_" + std::to_string(std::random_device()()));
    ASSERT_TRUE(fs::create_directory(made));
    folder = made.string();
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  void expect_status(const std::string& path, MienStatus expected) {
    for (uint32_t access : {MIEN_FILE_MAP, MIEN_FILE_READ}) {
      CountingAllocator counter;
      const MienAllocator allocator = counter.get();
      MienDnaDesc desc = sized<MienDnaDesc>();
      desc.file_access = access;
      desc.allocator = &allocator;
      MienError error = sized<MienError>();
      MienDna* dna = nullptr;
      const MienStatus status = mien_dna_open_file(path.c_str(), &desc, &dna, &error);
      EXPECT_STREQ(mien_status_name(status), mien_status_name(expected)) << error.message;
      EXPECT_EQ(dna, nullptr);
      EXPECT_NE(error.message[0], 0);
      EXPECT_TRUE(counter.clean()) << counter.first_wrong;

      MienReport* report = nullptr;
      const auto validate = desc_with<MienValidateDesc>(&allocator);
      const MienStatus examined = mien_dna_validate_file(path.c_str(), &validate, &report, &error);
      const bool is_file = expected >= MIEN_ERROR_DNA_SIGNATURE;
      EXPECT_EQ(examined, is_file ? MIEN_OK : expected) << error.message;
      EXPECT_EQ(report != nullptr, is_file);
      mien_report_destroy(report);
      EXPECT_TRUE(counter.clean()) << counter.first_wrong;
    }
  }
};

TEST_F(Paths, ThatAreNoFiles) {
  expect_status(folder + "/missing", MIEN_ERROR_FILE_OPEN);
  expect_status(folder + "/missing/file", MIEN_ERROR_FILE_OPEN);
  expect_status("", MIEN_ERROR_FILE_OPEN);
#if defined(_WIN32)
  expect_status(folder, MIEN_ERROR_FILE_OPEN);
#else
  expect_status(folder, MIEN_ERROR_FILE_READ);
#endif
  expect_status(std::string(5000, 'x'), MIEN_ERROR_FILE_OPEN);
}

TEST_F(Paths, ThatHoldNothingOrNoDna) {
  std::ofstream(folder + "/file");
  expect_status(folder + "/file", MIEN_ERROR_DNA_SIGNATURE);
  std::ofstream(folder + "/file") << "no DNA";
  expect_status(folder + "/file", MIEN_ERROR_DNA_SIGNATURE);
  std::ofstream(folder + "/file") << "DNA";
  expect_status(folder + "/file", MIEN_ERROR_DNA_TRUNCATED);
}

TEST_F(Paths, ThatCannotBeWritten) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_TINY, 0);
  std::vector<std::string> paths = {folder, folder + "/missing/file", ""};
#if !defined(_WIN32)
  paths.push_back("/dev/full");
#endif
  for (const std::string& path : paths) {
    MienError error = sized<MienError>();
    EXPECT_EQ(mien_dna_write_file(dna.get(), path.c_str(), nullptr, &error), MIEN_ERROR_FILE_WRITE)
        << path;
    EXPECT_NE(error.message[0], 0);
  }
}

}  // namespace
}  // namespace mien
