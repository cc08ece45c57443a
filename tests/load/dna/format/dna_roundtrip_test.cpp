// SPDX-License-Identifier: MIT
// Files that are read and written again: the same bytes for the same version, and for others what
// the format says stays, goes, or is added (docs/dna-format.md, 4 to 6, 9, 14 and 15).
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "author/generate/synthetic/rig.h"
#include "runtime/load/dna/check/check_written.h"
#include "runtime/load/dna/dna_reader.h"
#include "runtime/load/dna/format/dna_writer.h"
#include "tests/support/dna_bytes.h"
#include "tests/support/golden.h"
#include "tests/support/tiny_rig.h"

namespace mien::dna {
namespace {

/// A file that has been read, with the memory that its view lies in.
struct Read {
  Bytes bytes;
  Arena arena{default_allocator()};
  DnaView view;
  Error error;
  Status status;

  explicit Read(Bytes file, const ReadOptions& options = {}) : bytes(std::move(file)) {
    status = read_dna(bytes.data(), bytes.size(), options, arena, view, error);
    EXPECT_EQ(status, Status::kOk) << error.message;
  }
};

Bytes rewritten(const Bytes& file) {
  const Read read(file);
  return written(read.view, read.view.version);
}
Bytes rewritten(const Bytes& file, uint16_t version, bool keep_unknown = true) {
  return written(Read(file).view, version, keep_unknown);
}

/// The tiny rig, but that its behavior reads raw controls and correctives only: what old versions
/// leave out does not take anything away from it.
DnaView classic_rig(Arena& arena) {
  DnaView view = tiny_rig(arena);
  view.bhvr.joints.groups[1].input_indices = be<uint16_t>(arena, {0, 4, 2});
  return view;
}

/// With the layers of its version and no others.
Bytes tiny_file(uint16_t version = 8) {
  Arena arena(default_allocator());
  return written(classic_rig(arena), version, false);
}

void expect_same(const Bytes& a, const Bytes& b, const std::string& what) {
  if (a == b) return;
  size_t at = 0;
  while (at < a.size() && at < b.size() && a[at] == b[at]) ++at;
  ADD_FAILURE() << what << ": " << a.size() << " and " << b.size() << " bytes, differ from " << at;
}

const std::string kNames[9] = {
    "",
    "desc defn bhvr geom",
    "desc defn bhvr geom",
    "desc defn bhvr geom mlbh",
    "desc defn bhvr geom mlbh rbfb jbmd twsw",
    "desc defn bhvr geom mlbh rbfb rbfe jbmd twsw",
    "desc defn bhvr geom mlbh rbfb rbfe jbmd twsw mlbe",
    "desc defn bhvr geom mlbh rbfb rbfe jbmd twsw mlbe dsce",
    "desc defn bhvr geom mlbh rbfb rbfe jbmd twsw mlbe dsce",
};

// The same version ----------------------------------------------------------------------------

TEST(DnaRoundtrip, EveryVersionOfTinyRig) {
  for (uint16_t version = 1; version <= 8; ++version) {
    const Bytes file = tiny_file(version);
    ASSERT_EQ(file[6], version);
    if (version > 1) {
      EXPECT_EQ(layer_names(file), kNames[version]);
    }
    expect_same(rewritten(file), file, "2." + std::to_string(version));
  }
}

TEST(DnaRoundtrip, EveryVersionOfGeneratedRigs) {
  for (SyntheticPreset preset : {SyntheticPreset::kTiny, SyntheticPreset::kSmall}) {
    Arena arena(default_allocator());
    DnaView view;
    ASSERT_TRUE(make_synthetic_rig(preset, 11, arena, view));
    for (uint16_t version = 1; version <= 8; ++version) {
      const Bytes file = written(view, version);
      expect_same(rewritten(file), file, "2." + std::to_string(version));
    }
  }
}

// Other numbers of the generation go by the rules of 2.8 and keep their number.
TEST(DnaRoundtrip, VersionsThatAreNotKnown) {
  for (int version : {0, 9, 255, 256, 65535}) {
    Bytes file = tiny_file();
    file[5] = static_cast<uint8_t>(version >> 8);
    file[6] = static_cast<uint8_t>(version);
    EXPECT_EQ(layers_of(file).back().bytes.size(), 17u);
    expect_same(rewritten(file), file, "2." + std::to_string(version));
  }
}

// Versions written one over another, up and down: what both ends know stays.
TEST(DnaRoundtrip, DownAndUpAgain) {
  for (uint16_t low = 2; low <= 8; ++low) {
    for (uint16_t high = low; high <= 8; ++high) {
      const Bytes file = tiny_file(low);
      const Bytes up = rewritten(file, high);
      EXPECT_EQ(layers_of(up).size(), layers_of(tiny_file(high)).size());
      const Bytes back = rewritten(rewritten(up, low, false), high, false);
      expect_same(back, up, std::to_string(low) + " to " + std::to_string(high));
    }
  }
}

// Other versions ----------------------------------------------------------------------------------

TEST(DnaVersions, LayersAreCarriedDown) {
  const Bytes file = tiny_file();
  const std::vector<Layer> layers = layers_of(file);
  for (uint16_t version = 2; version <= 8; ++version) {
    const Bytes down = rewritten(file, version);
    EXPECT_EQ(layer_names(down), kNames[8]) << "2." << version;
    const std::vector<Layer> kept = layers_of(down);
    for (size_t i = 0; i + 1 < kept.size(); ++i) {
      EXPECT_EQ(kept[i].bytes, layers[i].bytes) << kept[i].code << " in 2." << version;
    }
    // dsce is last; its length goes by the version of the file.
    EXPECT_EQ(kept.back().bytes.size(), version == 8 ? 17u : 16u);
    expect_same(rewritten(down), down, "2." + std::to_string(version));
    EXPECT_EQ(layer_names(rewritten(file, version, false)), kNames[version]);
  }
}

TEST(DnaVersions, KnownLayersAreAppendedInTheirOrder) {
  const Bytes old = tiny_file(2);
  for (uint16_t version = 2; version <= 8; ++version) {
    const Bytes up = rewritten(old, version);
    EXPECT_EQ(layer_names(up), kNames[version]);
    const std::vector<Layer> layers = layers_of(up), old_layers = layers_of(old);
    for (size_t i = 0; i < 4; ++i) EXPECT_EQ(layers[i].bytes, old_layers[i].bytes);
  }
  // Their empty forms, by section 6. Rotation signs are 1 by default.
  const std::vector<Layer> layers = layers_of(rewritten(old, 8));
  const size_t sizes[] = {24, 16, 8, 4, 8, 20};
  for (size_t i = 4; i < 10; ++i) {
    EXPECT_EQ(layers[i].bytes, Bytes(sizes[i - 4], 0)) << layers[i].code;
  }
  EXPECT_EQ(layers[10].bytes, Bytes({0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0}));
}

TEST(DnaVersions, EmptyClassicLayers) {
  const std::vector<Layer> layers = layers_of(written(DnaView(), 2));
  const size_t sizes[] = {36, 92, 86, 4};
  ASSERT_EQ(layers.size(), 4u);
  for (size_t i = 0; i < 4; ++i) EXPECT_EQ(layers[i].bytes, Bytes(sizes[i], 0));
  DnaView view;
  view.geom.meshes = {new Mesh(), 1};
  EXPECT_EQ(layers_of(written(view, 2))[3].bytes.size(), 4u + 4 + 58);
  delete view.geom.meshes.items;
}

TEST(DnaVersions, DescriptorExtensionLosesItsLastByte) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  view.dsce = {3, {1, -1, 1}, 1};
  const Bytes file = written(view);
  EXPECT_EQ(layers_of(file)[10].bytes,
            Bytes({0, 0, 0, 3, 0, 0, 0, 1, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0, 0, 1, 1}));
  const Read down(rewritten(file, 7)), back(rewritten(down.bytes, 8));
  EXPECT_EQ(down.view.dsce.rotation_sequence, 3u);
  EXPECT_EQ(down.view.dsce.rotation_sign.y, -1);
  EXPECT_EQ(down.view.dsce.face_winding_order, 0u);
  EXPECT_EQ(back.view.dsce.rotation_sequence, 3u);
  EXPECT_EQ(back.view.dsce.rotation_sign.y, -1);
  EXPECT_EQ(back.view.dsce.face_winding_order, 0u) << "2.7 has no place for it";
}

TEST(DnaVersions, OldestKeepsTheFourClassicLayers) {
  const Bytes file = tiny_file(), oldest = rewritten(file, 1);
  EXPECT_EQ(Bytes(oldest.end() - 3, oldest.end()), Bytes({'A', 'N', 'D'}));
  const Read read(oldest);
  ASSERT_EQ(read.view.index.count, 4u);
  for (uint32_t i = 0; i < 4; ++i) EXPECT_EQ(read.view.index[i].code, kLayerKinds[i].code);
  EXPECT_EQ(read.view.mlbh.control_names.count, 0u);
  EXPECT_EQ(read.view.rbfb.poses.count + read.view.rbfe.poses.count, 0u);
  EXPECT_EQ(read.view.jbmd.joints.count + read.view.twsw.twists.count, 0u);
  EXPECT_EQ(read.view.mlbe.types.count, 0u);

  // A fresh index of the version; the classic layers as they were.
  for (uint16_t version = 2; version <= 8; ++version) {
    const Bytes up = rewritten(oldest, version);
    EXPECT_EQ(layer_names(up), kNames[version]);
    for (size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(layers_of(up)[i].bytes, layers_of(file)[i].bytes) << kLayerKinds[i].name;
    }
    expect_same(rewritten(up, 1), oldest, "and back");
  }
}

std::vector<std::string> sorted_names(const Bytes& file) {
  std::vector<std::string> names;
  for (const Layer& layer : layers_of(file)) names.push_back(layer.code);
  std::sort(names.begin(), names.end());
  return names;
}

// Whatever is dropped, the result is canonical: complete, and the same when it is written again.
TEST(DnaVersions, DroppingLeavesACanonicalFile) {
  for (uint16_t from = 3; from <= 8; ++from) {
    const Bytes carried = rewritten(tiny_file(from), 2);
    EXPECT_EQ(layer_names(rewritten(carried, 2, false)), kNames[2]);
    for (uint16_t to = 2; to <= 8; ++to) {
      const Bytes dropped = rewritten(carried, to, false);
      EXPECT_EQ(sorted_names(dropped), sorted_names(tiny_file(to)))
          << "2." << from << " in 2.2 to 2." << to;  // what was missing stands at the end
      expect_same(rewritten(dropped), dropped, "again");
    }
  }
}

// What a version knows is written as that version, whatever the version of the file was.
TEST(DnaVersions, LayersThatTheTargetKnowsAreNotDropped) {
  const Bytes file = tiny_file();
  const Bytes carried = rewritten(file, 2);
  for (uint16_t to = 3; to <= 8; ++to) {
    expect_same(rewritten(carried, to, false), rewritten(file, to, false), std::to_string(to));
  }
}

// Layers that take controls away from a behavior that reads them. (RBF behavior without the ML
// controls that come before its own is refused by the C interface: capi_dna_test.)
TEST(DnaVersions, WhatIsWrittenOpensAgain) {
  Arena arena(default_allocator());
  const Bytes file = written(tiny_rig(arena));
  for (uint16_t version = 1; version <= 8; ++version) Read(rewritten(file, version, false));
  for (uint32_t layers : {kLayerBehavior, kLayerMachineLearned, kLayerTwistSwing}) {
    ReadOptions options;
    options.layers = layers;
    Read(written(Read(file, options).view));
  }
}

Status check_written_as(const DnaView& view, uint16_t version, bool keep_unknown,
                        std::string* message = nullptr) {
  Arena arena(default_allocator());
  Error error;
  const Status status = check_written(view, {version, keep_unknown}, arena, error);
  if (message) *message = error.message;
  return status;
}

// Networks whose operations say what comes in, and pose controls that are more than poses.
TEST(DnaVersions, WhatWouldNotOpenIsNotWritten) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  view.mlbh.networks[0].input_indices = {};  // the gather has them
  // A second mistake, which is not told: more outputs than values.
  view.mlbh.networks[0].output_indices = be<uint16_t>(arena, {5, 6, 7, 8, 5, 6, 7, 8, 5, 6, 7, 8});
  std::string message;
  for (uint16_t version = 1; version <= 8; ++version) {
    const bool needs_operations = version >= 3 && version < 6;
    EXPECT_EQ(check_written_as(view, version, false, &message),
              needs_operations ? Status::kDnaStructure : Status::kOk)
        << version;
    if (needs_operations) {
      EXPECT_NE(message.find("mlbh.neuralNetworks[0].layers[0].weights"), std::string::npos)
          << message;
    }
    EXPECT_EQ(check_written_as(view, version, true), Status::kOk) << version;
  }
  view = tiny_rig(arena);
  Span<String> names = arena.array<String>(3);
  for (uint32_t i = 0; i < 3; ++i) names[i] = view.rbfb.poses[i % 2].name;
  view.rbfe.pose_control_names = {names.data, 3};
  view.bhvr.joints.groups[1].input_indices = be<uint16_t>(arena, {0, 4, 11});
  for (uint16_t version = 1; version <= 8; ++version) {
    EXPECT_EQ(check_written_as(view, version, false),
              version == 4 ? Status::kDnaReference : Status::kOk)
        << version;
    const Bytes bytes = written(view, version, false);
    Arena memory(default_allocator());
    DnaView out;
    Error error;
    EXPECT_EQ(read_dna(bytes.data(), bytes.size(), {}, memory, out, error),
              check_written_as(view, version, false));
  }
}

TEST(DnaVersions, FilesOf4GiBAreNotWritten) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  // Only counts are looked at before a file is found too large.
  Array<float>& xs = view.geom.meshes[0].positions.xs;
  const uint64_t rest = encoded_size(view, {8, true}) - 4 * xs.count;
  const auto most = static_cast<uint32_t>((UINT32_MAX - rest) / 4);
  xs.count = most;
  EXPECT_EQ(check_written_as(view, 8, true), Status::kOk);
  xs.count = most + 1;
  std::string message;
  EXPECT_EQ(check_written_as(view, 8, true, &message), Status::kDnaLimit);
  EXPECT_NE(message.find("less than 4 GiB"), std::string::npos) << message;
}

// Unknown layers ----------------------------------------------------------------------------------

TEST(DnaUnknownLayers, SurviveInTheirPlace) {
  std::vector<Layer> layers = layers_of(tiny_file());
  const Bytes noise = {'D', 'N', 'A', 0, 0xFF, 0xFF, 0xFF, 0xFF, 1, 2, 3};
  layers.insert(layers.begin(), layer("zzzz 7.65535", noise));
  layers.insert(layers.begin() + 3, layer("desc 1.2", noise));  // no newer desc, but unknown
  layers.insert(layers.begin() + 7, layer("none 0.0"));
  layers.push_back(layer("mlbh 0.1", Bytes(1000, 0xA5)));
  layers.push_back(layer("\xFF  \x01 1.0", {1}));
  for (uint16_t version = 2; version <= 9; ++version) {
    std::vector<Layer> fitting = layers;
    for (Layer& l : fitting) {
      if (l.code == "dsce" && version < 8) l.bytes.pop_back();
    }
    const Bytes file = file_of(version, fitting);
    expect_same(rewritten(file), file, "2." + std::to_string(version));
    const std::string dropped = version > 8 ? kNames[8] : kNames[version];
    EXPECT_EQ(layer_names(rewritten(file, version, false)), dropped) << "when written";
    ReadOptions options;
    options.keep_unknown = false;
    EXPECT_EQ(layer_names(written(Read(file, options).view, version)), kNames[8]) << "when read";
  }
  const Bytes up = rewritten(file_of(8, layers), 3);
  ASSERT_EQ(layers_of(up).size(), layers.size());
  EXPECT_EQ(layers_of(up)[0].bytes, noise);
  EXPECT_EQ(layers_of(rewritten(rewritten(up, 1), 8)).size(), 11u) << "2.1 has no place for them";
}

TEST(DnaUnknownLayers, IndexOrderIsKept) {
  std::vector<Layer> layers = layers_of(tiny_file());
  std::reverse(layers.begin(), layers.end());
  for (int turn = 0; turn < 11; ++turn) {
    std::rotate(layers.begin(), layers.begin() + 1, layers.end());
    const Bytes file = file_of(8, layers);
    const Read read(file);
    expect_same(written(read.view), file, "turn " + std::to_string(turn));
    EXPECT_EQ(read.view.defn.joint_names.count, 3u);
    ReadOptions coarse;
    coarse.lods = 2;
    EXPECT_EQ(Read(file, coarse).view.defn.joint_names.count, 2u);
  }
}

TEST(DnaUnknownLayers, MissingLayersAreDefaultsAndAppended) {
  const std::vector<Layer> all = layers_of(tiny_file());
  for (const char* missing : {"geom", "jbmd", "twsw", "mlbe", "dsce"}) {
    std::vector<Layer> layers = all;
    layers.erase(std::find_if(layers.begin(), layers.end(),
                              [&](const Layer& l) { return l.code == missing; }));
    const Bytes again = rewritten(file_of(8, layers));
    const std::vector<Layer> found = layers_of(again);
    ASSERT_EQ(found.size(), 11u);
    EXPECT_EQ(found.back().code, missing);
    for (size_t i = 0; i < layers.size(); ++i) EXPECT_EQ(found[i].bytes, layers[i].bytes);
    expect_same(rewritten(again), again, missing);
  }
  const Bytes nothing = rewritten(file_of(8, {}));
  EXPECT_EQ(layer_names(nothing), kNames[8]);
  expect_same(nothing, written(DnaView()), "a file without layers");
}

// Details of reading ------------------------------------------------------------------------------

TEST(DnaRoundtrip, PoseControlsOfOldFilesAreSynthesized) {
  for (const Bytes& file : {tiny_file(4), file_of(8, [] {
                              std::vector<Layer> layers = layers_of(tiny_file());
                              layers[6].bytes = Bytes(8, 0);  // an empty rbfe counts as none
                              return layers;
                            }())}) {
    const Read read(file);
    const RbfBehaviorExtension& rbfe = read.view.rbfe;
    ASSERT_EQ(rbfe.poses.count, 2u);
    ASSERT_EQ(rbfe.pose_control_names.count, 2u);
    EXPECT_EQ(std::string(rbfe.pose_control_names[1].chars(), 4), "open");
    for (uint32_t i = 0; i < 2; ++i) {
      EXPECT_EQ(rbfe.poses[i].input_control_indices.count, 0u);
      ASSERT_EQ(rbfe.poses[i].output_control_indices.count, 1u);
      EXPECT_EQ(rbfe.poses[i].output_control_indices[0], 3 + 2 + 4 + i);
      EXPECT_EQ(rbfe.poses[i].output_control_weights[0], 1.0f);
    }
    // Written by versions that have the layer, and then read as it stands.
    const Bytes up = rewritten(file, 8);
    const std::vector<Layer> layers = layers_of(up);
    const auto written_layer =
        std::find_if(layers.begin(), layers.end(), [](const Layer& l) { return l.code == "rbfe"; });
    ASSERT_NE(written_layer, layers.end());
    EXPECT_EQ(written_layer->bytes.size(), 4u + 8 + 8 + 4 + 2 * (4 + 4 + 2 + 4 + 4));
    expect_same(rewritten(up), up, "synthesized");
  }
  EXPECT_EQ(layer_names(rewritten(tiny_file(4), 4)), kNames[4]) << "2.4 has no such layer";
}

// A layer that was not chosen is written in its empty form; its index entry stays.
TEST(DnaRoundtrip, LayersThatWereNotLoadedAreWrittenEmpty) {
  const Bytes file = tiny_file();
  const std::vector<Layer> all = layers_of(file), none = layers_of(written(DnaView()));
  const struct {
    uint32_t layers;
    std::vector<std::string> loaded;
  } cases[] = {{kLayerDescriptor, {"desc", "dsce"}},
               {kLayerDefinition, {"desc", "dsce", "defn"}},
               {kLayerBehavior, {"desc", "dsce", "defn", "bhvr"}},
               {kLayerGeometry, {"desc", "dsce", "defn", "geom"}},
               {kLayerMachineLearned, {"desc", "dsce", "defn", "mlbh", "mlbe"}},
               {kLayerRbf, {"desc", "dsce", "defn", "bhvr", "rbfb", "rbfe"}},
               {kLayerJointMetadata, {"desc", "dsce", "defn", "jbmd"}},
               {kLayerTwistSwing, {"desc", "dsce", "defn", "twsw"}},
               {kLayerBehavior | kLayerTwistSwing, {"desc", "dsce", "defn", "bhvr", "twsw"}}};
  for (const auto& c : cases) {
    ReadOptions options;
    options.layers = c.layers;
    const Bytes part = written(Read(file, options).view);
    EXPECT_EQ(layer_names(part), kNames[8]);
    const std::vector<Layer> layers = layers_of(part);
    for (size_t i = 0; i < layers.size(); ++i) {
      const bool loaded =
          std::find(c.loaded.begin(), c.loaded.end(), layers[i].code) != c.loaded.end();
      EXPECT_EQ(layers[i].bytes, loaded ? all[i].bytes : none[i].bytes)
          << layers[i].code << " of selection " << c.layers;
    }
  }
}

TEST(DnaRoundtrip, GeometryWithoutBlendShapes) {
  ReadOptions options;
  options.layers = kLayerGeometry;
  options.skip_blend_shape_targets = true;
  for (uint16_t version : {1, 2, 8}) {
    const Read whole(tiny_file(version)), part(tiny_file(version), options);
    ASSERT_EQ(part.view.geom.meshes.count, 1u);
    Mesh mesh = whole.view.geom.meshes[0];
    EXPECT_EQ(mesh.blend_shape_targets.count, 1u);
    mesh.blend_shape_targets = {};
    DnaView expected = whole.view, found = part.view;
    expected.geom.meshes = {&mesh, 1};
    found.bhvr = expected.bhvr = {};
    EXPECT_EQ(written(found, 1), written(expected, 1));
  }
}

TEST(DnaRoundtrip, BitPatternsSurvive) {
  Arena arena(default_allocator());
  DnaView view = classic_rig(arena);
  const uint32_t bits[6] = {0x7FC12345, 0xFFFFFFFF, 0x80000000, 0x7F800001, 0x00000001, 0xFF800000};
  Bytes raw;
  for (uint32_t b : bits) put32(raw, b);
  Mesh mesh = view.geom.meshes[0];
  mesh.positions.ys = {raw.data(), 6};
  view.geom.meshes = {&mesh, 1};
  const uint8_t name[] = {'n', 0, 'u', 0, 0xFF, 0xC0, 0x80};
  view.desc.name = {name, sizeof(name)};
  view.defn.joint_names[1] = {name, 2};
  const Bytes file = written(view);
  const Read read(file);
  const Array<float>& ys = read.view.geom.meshes[0].positions.ys;
  ASSERT_EQ(ys.count, 6u);
  EXPECT_EQ(memcmp(ys.data, raw.data(), raw.size()), 0);
  for (uint32_t i = 0; i < 6; ++i) {
    const float value = ys[i];
    uint32_t found;
    memcpy(&found, &value, sizeof(found));
    EXPECT_EQ(found, bits[i]) << "element " << i;
  }
  ASSERT_EQ(read.view.desc.name.count, sizeof(name));
  EXPECT_EQ(memcmp(read.view.desc.name.data, name, sizeof(name)), 0);
  EXPECT_EQ(read.view.defn.joint_names[1].count, 2u);
  for (uint16_t version = 1; version <= 8; ++version) {
    const Bytes other = written(view, version);
    expect_same(rewritten(other), other, "2." + std::to_string(version));
  }
}

// Bytes that belong to nothing are read over and gone from what is written.
TEST(DnaRoundtrip, LeftoversAndGapsAreTolerated) {
  const Bytes file = tiny_file();
  std::vector<Layer> layers = layers_of(file);
  for (Layer& l : layers) l.bytes.insert(l.bytes.end(), {0xDE, 0xAD, 0xBE, 0xEF, 0x01});
  expect_same(rewritten(file_of(8, layers)), file, "leftovers in layers");

  // Between the index and the first layer, between layers, and behind the last one.
  layers = layers_of(file);
  Bytes gaps = file_of(8, layers);
  Bytes data;
  uint32_t gap = 1;
  for (size_t i = 0; i < layers.size(); ++i) {
    data.insert(data.end(), gap++, 0xA5);
    set32(gaps, 11 + 16 * i + 8, static_cast<uint32_t>(0xBB + data.size()));
    data.insert(data.end(), layers[i].bytes.begin(), layers[i].bytes.end());
  }
  gaps.resize(0xBB);
  gaps.insert(gaps.end(), data.begin(), data.end());
  gaps.insert(gaps.end(), 9, 0xA5);
  expect_same(rewritten(gaps), file, "gaps");

  // Layers in another order than their entries.
  Bytes swapped = gaps;
  swapped.resize(0xBB);
  std::vector<size_t> order = {5, 0, 10, 3, 1, 2, 9, 4, 8, 7, 6};
  for (size_t i : order) {
    set32(swapped, 11 + 16 * i + 8, static_cast<uint32_t>(swapped.size()));
    swapped.insert(swapped.end(), layers[i].bytes.begin(), layers[i].bytes.end());
  }
  expect_same(rewritten(swapped), file, "data in another order");

  // Inside a mesh, behind its last field: its size says so.
  layers = layers_of(file);
  Bytes& geometry = layers[3].bytes;
  geometry.insert(geometry.end(), {1, 2, 3});
  set32(geometry, 4, number32(geometry, 4) + 3);
  expect_same(rewritten(file_of(8, layers)), file, "leftovers in a mesh");
}

TEST(DnaRoundtrip, GapsInTheOldestVersion) {
  const Bytes file = tiny_file(1);
  // Move every section by a growing number of bytes.
  Bytes moved(file.begin(), file.begin() + 0x27);
  uint32_t gap = 0, shift = 0;
  for (int s = 0; s < 8; ++s) {
    const size_t slot = 7 + 4 * static_cast<size_t>(s);
    const uint32_t begin = number32(file, slot);
    const uint32_t end = s == 7 ? static_cast<uint32_t>(file.size()) : number32(file, slot + 4);
    if (s == 2) continue;  // behavior is where controls are
    moved.insert(moved.end(), ++gap, 0xA5);
    shift += gap;
    set32(moved, slot, begin + shift);
    moved.insert(moved.end(), file.begin() + begin, file.begin() + end);
    if (s == 3) set32(moved, slot - 4, begin + shift);
  }
  // The mesh says where it ends in the file.
  const uint32_t geometry = number32(moved, 0x23);
  set32(moved, geometry + 4, number32(moved, geometry + 4) + shift);
  moved.insert(moved.end(), 4, 0xA5);
  expect_same(rewritten(moved), file, "gaps between sections");
}

// Bytes by the book -------------------------------------------------------------------------------

constexpr uint32_t kWorkedSizes[11] = {87, 794, 1350, 1080, 762, 327, 228, 58, 200, 448, 17};

// The descriptor of the example of docs/dna-format.md, 15 "Worked example".
DnaView worked_example(Arena& arena) {
  DnaView view;
  view.desc.name = text("test");
  view.desc.archetype = 5;
  view.desc.gender = 2;
  view.desc.age = 42;
  view.desc.metadata = list<MetadataPair>(
      arena, {{text("key-A"), text("value-A")}, {text("key-B"), text("value-B")}});
  view.desc.translation_unit = view.desc.rotation_unit = 1;
  view.desc.coordinate_system = {1, 2, 4};
  view.desc.lod_count = 2;
  view.desc.complexity = text("A");
  view.desc.db_name = text("testDB");
  view.dsce = {3, {1, -1, 1}, 1};
  return view;
}

Bytes hex(const char* digits) {
  Bytes bytes;
  unsigned byte;
  for (int used; sscanf(digits, "%2x%n", &byte, &used) == 1; digits += used) {
    bytes.push_back(static_cast<uint8_t>(byte));
  }
  return bytes;
}

TEST(DnaWorkedExample, IndexAndDescriptor) {
  Arena arena(default_allocator());
  const Bytes file = written(worked_example(arena));
  const char* const codes[] = {"64657363", "6465666E", "62687672", "67656F6D",
                               "6D6C6268", "72626662", "72626665", "6A626D64",
                               "74777377", "6D6C6265", "64736365"};
  Bytes expected = hex("444E41 0002 0008 0000000B");
  uint32_t offset = 0xBB;
  const uint32_t sizes[11] = {87, 92, 86, 4, 24, 16, 8, 4, 8, 20, 17};
  for (size_t i = 0; i < 11; ++i) {
    const Bytes code = hex(codes[i]);
    expected.insert(expected.end(), code.begin(), code.end());
    put32(expected, i < 4 ? 0x00010001 : 0x00010000);
    put32(expected, offset);
    put32(expected, sizes[i]);
    offset += sizes[i];
  }
  const Bytes descriptor =
      hex("00000004 74657374 0005 0002 002A 00000002"
          "00000005 6B65792D41 00000007 76616C75652D41"
          "00000005 6B65792D42 00000007 76616C75652D42"
          "0001 0001 0001 0002 0004 0002 0000 00000001 41 00000006 746573744442");
  ASSERT_EQ(descriptor.size(), 87u);
  expected.insert(expected.end(), descriptor.begin(), descriptor.end());
  ASSERT_GT(file.size(), expected.size());
  EXPECT_EQ(Bytes(file.begin(), file.begin() + static_cast<ptrdiff_t>(expected.size())), expected);
  EXPECT_EQ(Bytes(file.end() - 17, file.end()), hex("00000003 00000001 FFFFFFFF 00000001 01"));
  EXPECT_EQ(file.size(), offset);
}

// The example's own index, with layers of the sizes that it has there.
TEST(DnaWorkedExample, IndexOfTheOriginal) {
  std::vector<Layer> layers;
  for (size_t i = 0; i < 11; ++i) {
    layers.push_back(layer(kLayerKinds[i].name, Bytes(kWorkedSizes[i])));
  }
  const Bytes file = file_of(8, layers);
  EXPECT_EQ(file.size(), 5538u);
  EXPECT_EQ(number32(file, 0x13), 0xBBu);
  EXPECT_EQ(Bytes(file.begin() + 0x1B, file.begin() + 0x2B),
            hex("6465666E 00010001 00000112 0000031A"));
  EXPECT_EQ(Bytes(file.begin() + 0xAB, file.begin() + 0xBB),
            hex("64736365 00010000 00001591 00000011"));
}

TEST(DnaWorkedExample, OldestVersion) {
  Arena arena(default_allocator());
  DnaView view = worked_example(arena);
  view.defn.lod_joints.lods = be<uint16_t>(arena, {0, 1});
  view.defn.lod_joints.indices = list<Array<uint16_t>>(
      arena, {be<uint16_t>(arena, {0, 1, 2, 3, 4, 5, 6, 7, 8}), be<uint16_t>(arena, {0})});
  const Bytes file = written(view, 1);
  const Bytes front = hex("444E41 0002 0001 00000027 0000007E");
  EXPECT_EQ(Bytes(file.begin(), file.begin() + 0x0F), front);
  // Sections of a definition with these LODs and else nothing, then empty ones.
  const uint32_t behavior = 0x7E + 92 + 4 + 4 + 18 + 4 + 2;
  EXPECT_EQ(number32(file, 0x0F), behavior);
  EXPECT_EQ(number32(file, 0x13), behavior) << "controls, the same place";
  EXPECT_EQ(number32(file, 0x17), behavior + 38);
  EXPECT_EQ(number32(file, 0x1B), behavior + 46);
  EXPECT_EQ(number32(file, 0x1F), behavior + 58);
  EXPECT_EQ(number32(file, 0x23), behavior + 86);
  EXPECT_EQ(file.size(), behavior + 86 + 4 + 3);
  EXPECT_EQ(Bytes(file.begin() + 0x61, file.begin() + 0x90),
            hex("0001 0001 0001 0002 0004 0002 0000 00000001 41 00000006 746573744442"
                "00000002 0000 0001 00000002 00000009 0000"));
  EXPECT_EQ(Bytes(file.end() - 3, file.end()), hex("414E44"));
}

// Meshes end where their own offset says, counted from the start of the file.
TEST(DnaWorkedExample, MeshBlocks) {
  const Bytes oldest = tiny_file(1), newer = tiny_file(2);
  const uint32_t geometry = number32(oldest, 0x23);
  EXPECT_EQ(number32(oldest, geometry), 1u);
  EXPECT_EQ(number32(oldest, geometry + 4), oldest.size() - 3);
  const Bytes layer = layers_of(newer)[3].bytes;
  EXPECT_EQ(number32(layer, 4), layer.size() - 8);
  EXPECT_EQ(Bytes(oldest.begin() + geometry + 8, oldest.end() - 3),
            Bytes(layer.begin() + 8, layer.end()));
}

// Golden files ------------------------------------------------------------------------------------

TEST(DnaGolden, FilesConvertToThemselves) {
  for (const std::string& name : golden::present_names()) {
    const Bytes file = golden::read_rig(name);
    const Read read(file);
    ASSERT_EQ(read.status, Status::kOk) << name;
    expect_same(written(read.view, read.view.version), file, name);
    // Through the newest version and back.
    if (read.view.version > 1) continue;
    expect_same(rewritten(rewritten(file, 8), 1), file, name);
  }
}

}  // namespace
}  // namespace mien::dna
