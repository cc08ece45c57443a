// SPDX-License-Identifier: MIT
// Reading at its edges: sinks that have heard enough, layers that are too small, LODs that cannot be.
#include "runtime/load/dna/dna_reader.h"

#include <gtest/gtest.h>

#include "tests/support/dna_bytes.h"
#include "tests/support/kept_findings.h"
#include "tests/support/memory_stream.h"
#include "tests/support/tiny_rig.h"

namespace mien::dna {
namespace {

class DnaReader : public testing::Test {
 protected:
  Arena arena{default_allocator()};
  DnaView tiny = tiny_rig(arena), read;
  Error error;

  Status open(const Bytes& file, const ReadOptions& options) {
    read = {};
    error = {};
    return read_dna(file.data(), file.size(), options, arena, read, error);
  }
  void expect(const Bytes& file, const ReadOptions& options, Status status, const char* words) {
    EXPECT_EQ(open(file, options), status) << error.message;
    EXPECT_NE(std::string(error.message).find(words), std::string::npos) << error.message;
  }
  /// Findings of a sink that has enough of `enough`.
  size_t examine(const Bytes& file, size_t enough) {
    KeptFindings report;
    report.enough = enough;
    read = {};
    examine_dna(file.data(), file.size(), arena, read, report.sink(true));
    EXPECT_EQ(report.errors(), 0u) << report.text();
    return report.findings.size();
  }
  static ReadOptions lods(uint64_t chosen) {
    ReadOptions options;
    options.lods = chosen;
    return options;
  }
};

TEST_F(DnaReader, WarningsMayEndAnExamination) {
  std::vector<Layer> layers = layers_of(written(tiny));
  for (Layer& layer : layers) {
    if (layer.code == "desc" || layer.code == "defn") layer.bytes.resize(layer.bytes.size() + 3);
  }
  const Bytes file = file_of(8, layers);
  EXPECT_EQ(examine(file, SIZE_MAX), 2u);
  EXPECT_EQ(examine(file, 2), 2u);
  EXPECT_EQ(examine(file, 1), 1u);
}

TEST_F(DnaReader, SectionsMayEndAnExamination) {
  tiny.bhvr.joints.groups[1].input_indices = be<uint16_t>(arena, {0, 4, 2});
  Bytes file = written(tiny, 1);
  constexpr size_t kBehavior = 7 + 4 * 2;
  set32(file, kBehavior, number32(file, kBehavior) + 1);
  const size_t all = examine(file, SIZE_MAX);
  EXPECT_GE(all, 1u);
  EXPECT_EQ(examine(file, 1), 1u);
}

// A mesh more than the definition knows is read, so that it can be told of.
TEST_F(DnaReader, MeshesWithoutNamesAreInNoLod) {
  tiny.geom.meshes = list<Mesh>(arena, {tiny.geom.meshes[0], tiny.geom.meshes[0]});
  expect(written(tiny), lods(1), Status::kDnaStructure, "geom.meshes");
}

TEST_F(DnaReader, AMeshThatIsPassedOverEndsWithinTheFile) {
  tiny.defn.lod_meshes.indices = list<Array<uint16_t>>(arena, {be<uint16_t>(arena, {0}), {}});
  tiny.defn.lod_meshes.lods = be<uint16_t>(arena, {0, 1});
  std::vector<Layer> layers = layers_of(written(tiny));
  EXPECT_EQ(open(file_of(8, layers), lods(2)), Status::kOk) << error.message;
  for (Layer& layer : layers) {
    if (layer.code == "geom") set32(layer.bytes, 4, 0xFFFFFFFF);
  }
  expect(file_of(8, layers), lods(2), Status::kDnaStructure, "block size");
}

// As many records as there is room for: of the smallest kind, which have no bytes but their size.
TEST_F(DnaReader, EmptyNamesTakeFourBytesEach) {
  tiny.mlbh = {};
  tiny.mlbe = {};
  tiny.twsw = {};
  tiny.mlbh.control_names = {arena.array<String>(5000).data, 5000};
  EXPECT_EQ(open(written(tiny), {}), Status::kOk) << error.message;
  EXPECT_EQ(read.mlbh.control_names.count, 5000u);
}

TEST_F(DnaReader, MoreLodsThanThereAreBits) {
  for (const uint16_t count : {64, 65, 65535}) {
    tiny.desc.lod_count = count;
    expect(written(tiny), lods(1), Status::kDnaLimit, "desc.lodCount");
  }
}

// Numbers of pose controls begin behind those of ML controls, whose layer is not read.
TEST_F(DnaReader, TheCountOfMlControlsHasToFitTheirLayer) {
  ReadOptions options;
  options.layers = kLayerRbf;
  std::vector<Layer> layers = layers_of(written(tiny));
  Layer* learned = nullptr;
  for (Layer& layer : layers) {
    if (layer.code == "mlbh") learned = &layer;
  }
  ASSERT_TRUE(learned);
  ASSERT_EQ(open(file_of(8, layers), options), Status::kOk) << error.message;
  EXPECT_EQ(read.ml_control_count, 4u);
  const Bytes whole = learned->bytes;
  set32(learned->bytes, 0, static_cast<uint32_t>(whole.size()));
  expect(file_of(8, layers), options, Status::kDnaTruncated, "mlbh.mlControlNames");
  for (const size_t size : {size_t{0}, size_t{3}}) {
    learned->bytes.assign(whole.begin(), whole.begin() + static_cast<ptrdiff_t>(size));
    expect(file_of(8, layers), options, Status::kDnaTruncated, "mlbh.mlControlNames");
  }
}

TEST_F(DnaReader, TheCountOfMlControlsOfAStreamMayNotBeHad) {
  const Bytes file = written(tiny);
  ReadOptions options;
  options.layers = kLayerRbf;
  // Each read in turn gives nothing.
  const auto failing = [&](size_t k) {
    struct Source {
      MemoryStream stream;
      size_t left;
    } source = {MemoryStream(file), k};
    const Stream stream = {&source, file.size(),
                           [](void* user, uint64_t offset, void* data, size_t size) -> size_t {
                             Source& s = *static_cast<Source*>(user);
                             if (s.left-- == 0) return 0;
                             const Stream of = s.stream.get();
                             return of.read(of.user, offset, data, size);
                           }};
    Arena own(default_allocator());
    DnaView view;
    return read_dna(stream, options, own, view, error);
  };
  size_t k = 0;
  while (failing(k) == Status::kFileRead && k < 100) ++k;
  EXPECT_GT(k, 5u);
  EXPECT_EQ(failing(k), Status::kOk) << error.message;
}

TEST_F(DnaReader, EmptyUnknownLayersOfAStream) {
  std::vector<Layer> layers = layers_of(written(tiny));
  layers.push_back(layer("abcd 1.0"));
  const MemoryStream source(file_of(8, layers));
  ReadOptions options;
  options.keep_unknown = true;
  EXPECT_EQ(read_dna(source.get(), options, arena, read, error), Status::kOk) << error.message;
  EXPECT_EQ(read.index.count, layers.size());
}

}  // namespace
}  // namespace mien::dna
