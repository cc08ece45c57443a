// SPDX-License-Identifier: MIT
// What is not chosen is never touched. The file lies in memory of our own, where pages that nobody
// has a reason to look at cannot be read: a touch is a fault, and the fault tells the byte.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cinttypes>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "runtime/load/dna/dna_reader.h"
#include "tests/support/dna_bytes.h"
#include "tests/support/memory_stream.h"
#include "tests/support/rig_handles.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

using dna::DnaView;

const size_t kPage = static_cast<size_t>(sysconf(_SC_PAGESIZE));

// Guarded file ------------------------------------------------------------------------------------

/// Address range of the guarded file, for the handler of faults.
uintptr_t g_begin = 0, g_end = 0;

void on_fault(int, siginfo_t* info, void*) {
  const uintptr_t at = reinterpret_cast<uintptr_t>(info->si_addr);
  char text[100];
  const int n = at >= g_begin && at < g_end
                    ? snprintf(text, sizeof(text), "touched byte %zu of the file\n",
                               static_cast<size_t>(at - g_begin))
                    : snprintf(text, sizeof(text), "a fault outside the file\n");
  if (write(STDERR_FILENO, text, static_cast<size_t>(n)) < 0) _exit(2);
  _exit(1);
}

/// A copy of a file, of which pages can be made unreadable.
class GuardedFile {
 public:
  explicit GuardedFile(const Bytes& file) : size_(file.size()) {
    mapped_ = (size_ + kPage - 1) / kPage * kPage;
    void* memory =
        mmap(nullptr, mapped_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    EXPECT_NE(memory, MAP_FAILED);
    bytes_ = static_cast<uint8_t*>(memory);
    memcpy(bytes_, file.data(), size_);
    readable_.assign(mapped_ / kPage, true);
    g_begin = reinterpret_cast<uintptr_t>(bytes_);
    g_end = g_begin + mapped_;
    struct sigaction action = {};
    action.sa_sigaction = on_fault;
    action.sa_flags = SA_SIGINFO;
    sigaction(SIGSEGV, &action, &old_segv_);
    sigaction(SIGBUS, &action, &old_bus_);
  }
  ~GuardedFile() {
    sigaction(SIGSEGV, &old_segv_, nullptr);
    sigaction(SIGBUS, &old_bus_, nullptr);
    munmap(bytes_, mapped_);
  }
  GuardedFile(const GuardedFile&) = delete;
  GuardedFile& operator=(const GuardedFile&) = delete;

  const uint8_t* bytes() const { return bytes_; }
  size_t size() const { return size_; }

  /// Pages that hold bytes of this range and no others.
  void forbid(size_t from, size_t to) {
    for (size_t page = (from + kPage - 1) / kPage; (page + 1) * kPage <= to; ++page) {
      readable_[page] = false;
      EXPECT_EQ(mprotect(bytes_ + page * kPage, kPage, PROT_NONE), 0);
    }
  }
  void forbid_all() {
    readable_.assign(readable_.size(), false);
    EXPECT_EQ(mprotect(bytes_, mapped_, PROT_NONE), 0);
  }
  size_t forbidden_bytes() const {
    return kPage * static_cast<size_t>(std::count(readable_.begin(), readable_.end(), false));
  }

  DnaHandle open(uint32_t layers, uint64_t lods = 0, bool skip_targets = false) const {
    MienDnaDesc desc = sized<MienDnaDesc>();
    desc.layers = layers;
    desc.lods = lods;
    desc.skip_blend_shape_targets = skip_targets;
    MienError error = sized<MienError>();
    MienDna* dna = nullptr;
    EXPECT_EQ(mien_dna_open_memory(bytes_, size_, &desc, &dna, &error), MIEN_OK) << error.message;
    return DnaHandle(dna);
  }

 private:
  size_t size_, mapped_ = 0;
  uint8_t* bytes_ = nullptr;
  std::vector<bool> readable_;
  struct sigaction old_segv_ = {}, old_bus_ = {};
};

void evaluate_all_lods(const RigHandle& rig) {
  Character character(rig);
  for (uint32_t lod = 0; lod < info_of(rig).lod_count; ++lod) {
    for (size_t i = 0; i < character.raw.count; ++i) character.raw[i] = 0.5f;
    character.evaluate(lod);
  }
}

// Layers ------------------------------------------------------------------------------------------

/// The tiny rig with each layer on pages of its own; gaps between layers are allowed.
struct SpreadFile {
  struct Place {
    std::string code;
    size_t begin, end;  // whole pages
  };
  Bytes bytes;
  std::vector<Place> places;

  SpreadFile() {
    Arena arena(default_allocator());
    std::vector<dna::Layer> layers = dna::layers_of(dna::written(dna::tiny_rig(arena)));
    layers.push_back(dna::layer("abcd 1.0", Bytes(3 * kPage, 0xEE)));
    bytes = dna::file_of(8, layers);
    bytes.resize(11 + 16 * layers.size());
    for (size_t i = 0; i < layers.size(); ++i) {
      bytes.resize((bytes.size() + kPage - 1) / kPage * kPage);
      const size_t begin = bytes.size();
      dna::set32(bytes, 11 + 16 * i + 8, static_cast<uint32_t>(begin));
      bytes.insert(bytes.end(), layers[i].bytes.begin(), layers[i].bytes.end());
      bytes.resize((bytes.size() + kPage - 1) / kPage * kPage);
      places.push_back({layers[i].code, begin, bytes.size()});
    }
  }
};

/// The codes of the layers that a selection reads: what it names, and what that needs.
std::string codes_read(uint32_t layers) {
  std::string codes = "desc dsce";
  if (layers == 0) return codes + " defn bhvr geom mlbh mlbe rbfb rbfe jbmd twsw";
  if (layers & ~uint32_t{MIEN_LAYER_DESCRIPTOR}) codes += " defn";
  if (layers & (MIEN_LAYER_BEHAVIOR | MIEN_LAYER_RBF_BEHAVIOR)) codes += " bhvr";
  if (layers & MIEN_LAYER_GEOMETRY) codes += " geom";
  if (layers & MIEN_LAYER_MACHINE_LEARNED_BEHAVIOR) codes += " mlbh mlbe";
  if (layers & MIEN_LAYER_RBF_BEHAVIOR) codes += " rbfb rbfe mlbh";  // the number of ML controls
  if (layers & MIEN_LAYER_JOINT_BEHAVIOR_METADATA) codes += " jbmd";
  if (layers & MIEN_LAYER_TWIST_SWING_BEHAVIOR) codes += " twsw";
  return codes;
}

TEST(LoadOnly, ChosenLayers) {
  const SpreadFile spread;
  for (uint32_t layers = 0; layers <= MIEN_LAYER_ALL; ++layers) {
    SCOPED_TRACE("layers " + std::to_string(layers));
    GuardedFile file(spread.bytes);
    const std::string codes = codes_read(layers);
    for (const SpreadFile::Place& place : spread.places) {
      if (codes.find(place.code) == std::string::npos) file.forbid(place.begin, place.end);
    }
    EXPECT_GT(file.forbidden_bytes(), 0u);  // the unknown layer at the least
    const DnaHandle dna = file.open(layers);
    ASSERT_TRUE(dna);
    if (layers != 0 && !(layers & (MIEN_LAYER_BEHAVIOR | MIEN_LAYER_RBF_BEHAVIOR))) continue;
    const RigHandle rig = create_rig(dna.get());
    file.forbid_all();  // a rig has its own copy of all that it needs
    evaluate_all_lods(rig);
  }
}

// A stream is asked for the header, the index and the chosen layers, each byte at most once.
TEST(LoadOnly, ChosenLayersOfAStream) {
  const SpreadFile spread;
  const MemoryStream stream(spread.bytes);
  const size_t index_end = 11 + 16 * spread.places.size();
  for (uint32_t layers = 0; layers <= MIEN_LAYER_ALL; ++layers) {
    SCOPED_TRACE("layers " + std::to_string(layers));
    const std::string codes = codes_read(layers);
    Arena arena(default_allocator());
    DnaView view;
    Error error;
    dna::ReadOptions options;
    options.layers = layers;
    options.keep_unknown = false;
    stream.ranges.clear();
    ASSERT_EQ(dna::read_dna(stream.get(), options, arena, view, error), Status::kOk)
        << error.message;
    size_t read = 0;
    for (const auto& [offset, size] : stream.ranges) {
      if (offset + size <= index_end) continue;
      read += size;
      const auto holds = [&, begin = offset](const SpreadFile::Place& place) {
        return place.begin <= begin && begin < place.end;
      };
      const auto place = std::find_if(spread.places.begin(), spread.places.end(), holds);
      ASSERT_NE(place, spread.places.end()) << offset;
      EXPECT_NE(codes.find(place->code), std::string::npos) << place->code;
      EXPECT_LE(offset + size, place->end);
    }
    size_t chosen = 0;
    for (uint32_t i = 0; i < view.index.count; ++i) {
      if (view.index[i].data) chosen += view.index[i].size;
    }
    const bool counts_ml = (layers & MIEN_LAYER_RBF_BEHAVIOR) != 0 &&
                           (layers & MIEN_LAYER_MACHINE_LEARNED_BEHAVIOR) == 0;
    EXPECT_EQ(read, chosen + (counts_ml ? 4 : 0));
  }
}

// Dropping unknown layers does not mean looking at them; nor does keeping them.
TEST(LoadOnly, UnknownLayersAreCarriedUnread) {
  const SpreadFile spread;
  GuardedFile file(spread.bytes);
  const SpreadFile::Place& unknown = spread.places.back();
  ASSERT_EQ(unknown.code, "abcd");
  file.forbid(unknown.begin, unknown.end);
  for (uint32_t policy : {MIEN_UNKNOWN_LAYERS_KEEP, MIEN_UNKNOWN_LAYERS_DROP}) {
    MienDnaDesc desc = sized<MienDnaDesc>();
    desc.unknown_layers = policy;
    MienDna* opened = nullptr;
    ASSERT_EQ(mien_dna_open_memory(file.bytes(), file.size(), &desc, &opened, nullptr), MIEN_OK);
    const DnaHandle dna(opened);
    size_t size = 0;
    EXPECT_EQ(mien_dna_write_memory(dna.get(), nullptr, nullptr, 0, &size, nullptr), MIEN_OK);
    const bool kept = size > unknown.end - unknown.begin;
    EXPECT_EQ(kept, policy == MIEN_UNKNOWN_LAYERS_KEEP);
  }
}

// The guard bites: each layer, forbidden, is missed by a selection that names it.
TEST(LoadOnlyDeathTest, AForbiddenLayerThatIsChosenFaults) {
  testing::FLAGS_gtest_death_test_style = "fast";
  const SpreadFile spread;
  for (const SpreadFile::Place& place : spread.places) {
    if (place.code == "abcd") continue;
    // Compilers for some CPUs read the bytes of a number one by one, in any order.
    std::string first = std::to_string(place.begin);
    for (size_t i = 1; i < 4; ++i) first += "|" + std::to_string(place.begin + i);
    EXPECT_EXIT(
        {
          GuardedFile file(spread.bytes);
          file.forbid(place.begin, place.end);
          file.open(MIEN_LAYER_ALL);
        },
        testing::ExitedWithCode(1), "touched byte (" + first + ") ")
        << place.code;
  }
}

// A rig of production size ------------------------------------------------------------------------

/// The large preset, and where things lie in its file.
class LargeFile : public testing::Test {
 protected:
  static Bytes bytes;
  static DnaHandle whole;

  static void SetUpTestSuite() {
    bytes = write_dna(generate_dna(MIEN_PRESET_LARGE, 1).get());
    whole = open_dna(bytes);
    ASSERT_TRUE(whole);
  }
  static void TearDownTestSuite() {
    whole.reset();
    bytes = {};
  }

  static const DnaView& view() { return whole->view; }
  static size_t offset(const void* address) {
    return static_cast<size_t>(view().offset_of(address));
  }

  template <class T>
  static void forbid(GuardedFile& file, const dna::Array<T>& array, size_t first = 0) {
    file.forbid(offset(array.data) + first * sizeof(T), offset(array.data) + array.byte_count());
  }
  static void forbid(GuardedFile& file, const dna::Vec3Array& vectors) {
    forbid(file, vectors.xs);
    forbid(file, vectors.ys);
    forbid(file, vectors.zs);
  }

  static size_t mesh_begin(uint32_t m) {  // behind the size of its block
    return offset(view().geom.meshes[m].positions.xs.data) - 4;
  }
  static size_t mesh_end(uint32_t m) {
    return mesh_begin(m) + dna::number32(bytes, mesh_begin(m) - 4);
  }
  static size_t layer_begin(dna::LayerId id) {
    return offset(view().index[static_cast<size_t>(id)].data);
  }
  static size_t layer_end(dna::LayerId id) {
    return layer_begin(id) + view().index[static_cast<size_t>(id)].size;
  }

  static bool lod_has_mesh(uint32_t lod, uint32_t mesh) {
    const dna::Array<uint16_t> meshes = view().defn.lod_meshes.at(lod);
    for (uint32_t i = 0; i < meshes.count; ++i) {
      if (meshes[i] == mesh) return true;
    }
    return false;
  }

  static void print(const char* what, const GuardedFile& file) {
    printf("%s: %zu of %zu bytes could not be read\n", what, file.forbidden_bytes(), file.size());
  }
};
Bytes LargeFile::bytes;
DnaHandle LargeFile::whole;

TEST_F(LargeFile, BehaviorAlone) {
  GuardedFile file(bytes);
  file.forbid(layer_begin(dna::LayerId::kGeom), layer_end(dna::LayerId::kGeom));
  EXPECT_GT(file.forbidden_bytes(), file.size() / 2);
  print("behavior", file);
  const DnaHandle dna = file.open(MIEN_LAYER_BEHAVIOR);
  ASSERT_TRUE(dna);
  const RigHandle rig = create_rig(dna.get());
  file.forbid_all();
  evaluate_all_lods(rig);
}

TEST_F(LargeFile, GeometryAlone) {
  GuardedFile file(bytes);
  file.forbid(layer_begin(dna::LayerId::kBhvr), layer_end(dna::LayerId::kBhvr));
  EXPECT_GT(file.forbidden_bytes(), file.size() / 4);
  print("geometry", file);
  EXPECT_TRUE(file.open(MIEN_LAYER_GEOMETRY));
}

TEST_F(LargeFile, DefinitionAlone) {
  GuardedFile file(bytes);
  file.forbid(layer_begin(dna::LayerId::kBhvr), layer_end(dna::LayerId::kGeom));
  EXPECT_GT(file.forbidden_bytes(), file.size() * 9 / 10);
  print("definition", file);
  EXPECT_TRUE(file.open(MIEN_LAYER_DEFINITION));
}

// The targets stand last in a mesh.
TEST_F(LargeFile, GeometryWithoutBlendShapes) {
  GuardedFile file(bytes);
  for (uint32_t m = 0; m < view().geom.meshes.count; ++m) {
    const auto& targets = view().geom.meshes[m].blend_shape_targets;
    if (targets.count) file.forbid(offset(targets[0].deltas.xs.data) - 8, mesh_end(m));
  }
  EXPECT_GT(file.forbidden_bytes(), 100 * kPage);
  print("geometry without blend shapes", file);
  const DnaHandle dna = file.open(MIEN_LAYER_GEOMETRY, 0, true);
  ASSERT_TRUE(dna);
  EXPECT_EQ(dna->view.geom.meshes.count, view().geom.meshes.count);
  EXPECT_EQ(dna->view.geom.meshes[0].blend_shape_targets.count, 0u);
  EXPECT_TRUE(file.open(MIEN_LAYER_GEOMETRY | MIEN_LAYER_BEHAVIOR, 0, true));
}

// Opening checks what refers to something; plain numbers are for whoever asks for them.
TEST_F(LargeFile, OpeningReadsNoNumbers) {
  GuardedFile file(bytes);
  for (const dna::JointGroup& group : view().bhvr.joints.groups) forbid(file, group.values);
  for (const dna::Mesh& mesh : view().geom.meshes) {
    forbid(file, mesh.positions);
    forbid(file, mesh.normals);
    forbid(file, mesh.texture_coordinates.us);
    forbid(file, mesh.texture_coordinates.vs);
    for (const dna::BlendShapeTarget& target : mesh.blend_shape_targets) {
      forbid(file, target.deltas);
    }
  }
  EXPECT_GT(file.forbidden_bytes(), file.size() / 4);
  print("all layers, opening only", file);
  EXPECT_TRUE(file.open(MIEN_LAYER_ALL));
}

// LODs --------------------------------------------------------------------------------------------

class LargeFileLods : public LargeFile, public testing::WithParamInterface<uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Selections, LargeFileLods,
                         testing::Values(0x01, 0x02, 0x08, 0x80, 0xC0, 0xA4, 0xFE, 0x7F));

TEST_P(LargeFileLods, UnchosenMeshesAndRowsAreNotTouched) {
  const uint64_t lods = GetParam();
  GuardedFile file(bytes);
  for (uint32_t m = 0; m < view().geom.meshes.count; ++m) {
    bool chosen = false;
    for (uint32_t l = 0; l < view().desc.lod_count; ++l) {
      chosen |= (lods >> l & 1) && lod_has_mesh(l, m);
    }
    if (!chosen) file.forbid(mesh_begin(m), mesh_end(m));
  }
  const size_t meshes = file.forbidden_bytes();

  // The finest chosen LOD says how many rows of a joint group are left.
  uint32_t finest = 0;
  while (!(lods >> finest & 1)) ++finest;
  for (const dna::JointGroup& group : view().bhvr.joints.groups) {
    forbid(file, group.values, size_t{group.lods[finest]} * group.input_indices.count);
  }
  const size_t rows = file.forbidden_bytes() - meshes;
  printf("LODs 0x%" PRIx64 ": %zu bytes of meshes and %zu of joint rows could not be read\n", lods,
         meshes, rows);
  EXPECT_GT(meshes, 0u);
  EXPECT_EQ(rows > 0, finest > 0);

  const DnaHandle dna = file.open(MIEN_LAYER_ALL, lods);
  ASSERT_TRUE(dna);
  const RigHandle rig = create_rig(dna.get());
  file.forbid_all();
  evaluate_all_lods(rig);

  // And what was chosen is what it is in the whole rig.
  const RigHandle full = create_rig(whole.get());
  Character small(rig), large(full);
  ASSERT_EQ(small.raw.count, large.raw.count);
  for (size_t i = 0; i < small.raw.count; ++i) small.raw[i] = large.raw[i] = 0.25f;
  small.evaluate(0);
  large.evaluate(finest);
  uint32_t moved = 0;
  const std::vector<std::string> joints = names_of(rig, MIEN_KIND_JOINT);
  for (uint32_t j = 0; j < joints.size(); ++j) {
    uint32_t k = 0;
    ASSERT_EQ(mien_rig_find_n(full.get(), MIEN_KIND_JOINT, joints[j].data(), joints[j].size(), &k),
              MIEN_OK);
    for (uint32_t a = 0; a < 9; ++a) {
      EXPECT_EQ(small.joints[9 * j + a], large.joints[9 * k + a]) << joints[j];
      moved += small.joints[9 * j + a] != 0;
    }
  }
  EXPECT_GT(moved, 0u);
}

TEST(LoadOnlyDeathTest, AForbiddenMeshThatIsChosenFaults) {
  testing::FLAGS_gtest_death_test_style = "fast";
  EXPECT_EXIT(
      {
        const Bytes bytes = write_dna(generate_dna(MIEN_PRESET_SMALL, 1).get());
        const DnaHandle whole = open_dna(bytes);
        const dna::Mesh& mesh = whole->view.geom.meshes[0];
        const size_t begin = whole->view.offset_of(mesh.positions.xs.data) - 4;
        GuardedFile file(bytes);
        file.forbid(begin, begin + dna::number32(bytes, begin - 4));
        file.open(MIEN_LAYER_GEOMETRY, 2);  // without LOD 0 all is well
        fprintf(stderr, "went by; ");
        file.open(MIEN_LAYER_GEOMETRY, 1);
      },
      testing::ExitedWithCode(1), "went by; touched byte");
}

// Mapped files ------------------------------------------------------------------------------------

/// Resident bytes of a mapped file as the kernel counts them; -1 if it does not tell.
long resident_bytes(const std::string& path) {
  std::ifstream maps("/proc/self/smaps");
  std::string line;
  bool here = false;
  while (std::getline(maps, line)) {
    if (line.find('-') != std::string::npos && line.find(path) != std::string::npos) here = true;
    if (here && line.rfind("Rss:", 0) == 0) return atol(line.c_str() + 4) * 1024;
  }
  return -1;
}

TEST_F(LargeFile, MappedPagesStayOnDisk) {
  char path[] = "/tmp/mien_resident_XXXXXX";
  const int descriptor = mkstemp(path);
  ASSERT_GE(descriptor, 0);
  ASSERT_EQ(write(descriptor, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  close(descriptor);
  // A fault may bring in the pages around it if they are in memory already: as many as the system
  // keeps in one piece, 2 MiB at most. That happens at the end of what was chosen, and for dsce at
  // the end of the file.
  constexpr size_t kAround = 2 * 1024 * 1024;
  const struct {
    const char* name;
    uint32_t layers;
    size_t chosen_bytes;
  } selections[] = {
      {"definition", MIEN_LAYER_DEFINITION, layer_end(dna::LayerId::kDefn)},
      {"behavior", MIEN_LAYER_BEHAVIOR, layer_end(dna::LayerId::kBhvr)},
      {"all", MIEN_LAYER_ALL, bytes.size()},
  };
  for (const auto& selection : selections) {
    MienDnaDesc desc = sized<MienDnaDesc>();
    desc.layers = selection.layers;
    MienDna* opened = nullptr;
    ASSERT_EQ(mien_dna_open_file(path, &desc, &opened, nullptr), MIEN_OK);
    const DnaHandle dna(opened);
    const long resident = resident_bytes(path);
    if (resident < 0) {
      unlink(path);
      GTEST_SKIP()
          << "NOT TESTED: pages that are read from disk; no resident sizes in /proc/self/smaps";
    }
    printf("%s: %ld bytes resident, %zu chosen, %zu in the file\n", selection.name, resident,
           selection.chosen_bytes, bytes.size());
    EXPECT_GT(resident, 0);
    EXPECT_LE(static_cast<size_t>(resident), selection.chosen_bytes + 2 * kAround);
  }
  unlink(path);
}

}  // namespace
}  // namespace mien
