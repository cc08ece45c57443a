// SPDX-License-Identifier: MIT
// Fields by name: every field of every layer under the name that the format gives it, and nothing
// under any other.
#include "runtime/load/dna/format/dna_path.h"

#include <gtest/gtest.h>

#include <cstring>
#include <set>

#include "runtime/load/dna/dna_reader.h"
#include "runtime/load/dna/format/record_size.h"
#include "tests/support/dna_bytes.h"
#include "tests/support/tiny_rig.h"

namespace mien::dna {
namespace {

class DnaPath : public testing::Test {
 protected:
  DnaPath() {
    const Status status = read_dna(bytes.data(), bytes.size(), {}, arena, view, error);
    EXPECT_EQ(status, Status::kOk) << error.message;
  }

  FieldRef find(const std::string& path) {
    FieldRef found;
    const Status status = find_field(view, path.c_str(), found, error);
    EXPECT_EQ(status, Status::kOk) << path << ": " << error.message;
    return found;
  }

  Arena made{default_allocator()}, arena{default_allocator()};
  Bytes bytes = written(tiny_rig(made));
  DnaView view;
  Error error;
};

// By the book -------------------------------------------------------------------------------------

// docs/dna-format.md, 6 "Layers, field by field", with what the tiny rig has there. Numbers: u8 u16
// u32 i32 f32.
constexpr struct {
  const char* path;
  const char* type;
  uint64_t count;
} kFields[] = {
    {"", "record", 11},
    {"desc", "record", 12},
    {"desc.name", "string", 4},
    {"desc.archetype", "u16", 1},
    {"desc.gender", "u16", 1},
    {"desc.age", "u16", 1},
    {"desc.metadata", "list", 1},
    {"desc.metadata[0]", "record", 2},
    {"desc.metadata[0].key", "string", 6},
    {"desc.metadata[0].value", "string", 14},
    {"desc.translationUnit", "u16", 1},
    {"desc.rotationUnit", "u16", 1},
    {"desc.coordinateSystem", "record", 3},
    {"desc.coordinateSystem.xAxis", "u16", 1},
    {"desc.coordinateSystem.yAxis", "u16", 1},
    {"desc.coordinateSystem.zAxis", "u16", 1},
    {"desc.lodCount", "u16", 1},
    {"desc.maxLOD", "u16", 1},
    {"desc.complexity", "string", 1},
    {"desc.dbName", "string", 6},
    {"dsce", "record", 3},
    {"dsce.rotationSequence", "u32", 1},
    {"dsce.rotationSign", "record", 3},
    {"dsce.rotationSign.x", "i32", 1},
    {"dsce.rotationSign.y", "i32", 1},
    {"dsce.rotationSign.z", "i32", 1},
    {"dsce.faceWindingOrder", "u8", 1},
    {"defn", "record", 14},
    {"defn.lodJointMapping", "record", 2},
    {"defn.lodJointMapping.lods", "u16", 2},
    {"defn.lodJointMapping.indices", "list", 2},
    {"defn.lodJointMapping.indices[1]", "u16", 2},
    {"defn.lodJointMapping.indices[1][1]", "u16", 1},
    {"defn.lodBlendShapeMapping.indices[0]", "u16", 2},
    {"defn.lodAnimatedMapMapping.indices[1]", "u16", 0},
    {"defn.lodMeshMapping.indices", "list", 1},
    {"defn.guiControlNames", "list", 2},
    {"defn.rawControlNames", "list", 3},
    {"defn.jointNames", "list", 3},
    {"defn.jointNames[2]", "string", 6},
    {"defn.blendShapeChannelNames", "list", 2},
    {"defn.animatedMapNames", "list", 1},
    {"defn.meshNames", "list", 1},
    {"defn.meshBlendShapeChannelMapping", "record", 2},
    {"defn.meshBlendShapeChannelMapping.from", "u16", 1},
    {"defn.meshBlendShapeChannelMapping.to", "u16", 1},
    {"defn.jointHierarchy", "u16", 3},
    {"defn.jointHierarchy[2]", "u16", 1},
    {"defn.neutralJointTranslations", "record", 3},
    {"defn.neutralJointTranslations.xs", "f32", 3},
    {"defn.neutralJointTranslations.ys[1]", "f32", 1},
    {"defn.neutralJointRotations.zs", "f32", 3},
    {"bhvr", "record", 4},
    {"bhvr.controls", "record", 3},
    {"bhvr.controls.psdCount", "u16", 1},
    {"bhvr.controls.conditionals", "record", 6},
    {"bhvr.controls.conditionals.inputIndices", "u16", 3},
    {"bhvr.controls.conditionals.outputIndices", "u16", 3},
    {"bhvr.controls.conditionals.fromValues", "f32", 3},
    {"bhvr.controls.conditionals.toValues", "f32", 3},
    {"bhvr.controls.conditionals.slopeValues", "f32", 3},
    {"bhvr.controls.conditionals.cutValues", "f32", 3},
    {"bhvr.controls.psds", "record", 3},
    {"bhvr.controls.psds.rows", "u16", 4},
    {"bhvr.controls.psds.columns", "u16", 4},
    {"bhvr.controls.psds.values", "f32", 4},
    {"bhvr.joints", "record", 3},
    {"bhvr.joints.rowCount", "u16", 1},
    {"bhvr.joints.colCount", "u16", 1},
    {"bhvr.joints.jointGroups", "list", 2},
    {"bhvr.joints.jointGroups[1]", "record", 5},
    {"bhvr.joints.jointGroups[1].lods", "u16", 2},
    {"bhvr.joints.jointGroups[1].inputIndices", "u16", 3},
    {"bhvr.joints.jointGroups[1].outputIndices", "u16", 4},
    {"bhvr.joints.jointGroups[1].values", "f32", 12},
    {"bhvr.joints.jointGroups[1].jointIndices", "u16", 1},
    {"bhvr.blendShapeChannels", "record", 3},
    {"bhvr.blendShapeChannels.lods", "u16", 2},
    {"bhvr.blendShapeChannels.inputIndices", "u16", 2},
    {"bhvr.blendShapeChannels.outputIndices", "u16", 2},
    {"bhvr.animatedMaps", "record", 2},
    {"bhvr.animatedMaps.lods", "u16", 2},
    {"bhvr.animatedMaps.conditionals.cutValues", "f32", 1},
    {"geom", "record", 1},
    {"geom.meshes", "list", 1},
    {"geom.meshes[0]", "record", 8},
    {"geom.meshes[0].positions.xs", "f32", 6},
    {"geom.meshes[0].textureCoordinates", "record", 2},
    {"geom.meshes[0].textureCoordinates.us", "f32", 6},
    {"geom.meshes[0].textureCoordinates.vs", "f32", 6},
    {"geom.meshes[0].normals.zs", "f32", 6},
    {"geom.meshes[0].layouts", "record", 3},
    {"geom.meshes[0].layouts.positions", "u32", 6},
    {"geom.meshes[0].layouts.textureCoordinates", "u32", 6},
    {"geom.meshes[0].layouts.normals", "u32", 6},
    {"geom.meshes[0].faces", "list", 2},
    {"geom.meshes[0].faces[1].layoutIndices", "u32", 4},
    {"geom.meshes[0].maximumInfluencePerVertex", "u16", 1},
    {"geom.meshes[0].skinWeights", "list", 6},
    {"geom.meshes[0].skinWeights[0].weights", "f32", 2},
    {"geom.meshes[0].skinWeights[5].jointIndices", "u16", 1},
    {"geom.meshes[0].blendShapeTargets", "list", 1},
    {"geom.meshes[0].blendShapeTargets[0].deltas", "record", 3},
    {"geom.meshes[0].blendShapeTargets[0].deltas.ys", "f32", 2},
    {"geom.meshes[0].blendShapeTargets[0].vertexIndices", "u32", 2},
    {"geom.meshes[0].blendShapeTargets[0].blendShapeChannelIndex", "u16", 1},
    {"mlbh", "record", 4},
    {"mlbh.mlControlNames", "list", 4},
    {"mlbh.lodNeuralNetworkMapping.indices[0]", "u16", 1},
    {"mlbh.neuralNetworkToMeshRegion", "record", 2},
    {"mlbh.neuralNetworkToMeshRegion.regionNames", "list", 1},
    {"mlbh.neuralNetworkToMeshRegion.regionNames[0]", "list", 1},
    {"mlbh.neuralNetworkToMeshRegion.regionNames[0][0]", "string", 5},
    {"mlbh.neuralNetworkToMeshRegion.indices[0]", "list", 1},
    {"mlbh.neuralNetworkToMeshRegion.indices[0][0]", "u16", 1},
    {"mlbh.neuralNetworkToMeshRegion.indices[0][0][0]", "u16", 1},
    {"mlbh.neuralNetworks", "list", 1},
    {"mlbh.neuralNetworks[0]", "record", 3},
    {"mlbh.neuralNetworks[0].outputIndices", "u16", 4},
    {"mlbh.neuralNetworks[0].inputIndices", "u16", 2},
    {"mlbh.neuralNetworks[0].layers", "list", 2},
    {"mlbh.neuralNetworks[0].layers[0]", "record", 4},
    {"mlbh.neuralNetworks[0].layers[0].biases", "f32", 3},
    {"mlbh.neuralNetworks[0].layers[1].weights", "f32", 12},
    {"mlbh.neuralNetworks[0].layers[0].functionId", "u16", 1},
    {"mlbh.neuralNetworks[0].layers[0].parameters", "f32", 1},
    {"mlbe", "record", 2},
    {"mlbe.mlbTypeData", "list", 1},
    {"mlbe.mlbTypeData[0]", "record", 2},
    {"mlbe.mlbTypeData[0].lodMLOperationMappings", "list", 3},
    {"mlbe.mlbTypeData[0].lodMLOperationMappings[2].lods", "u16", 2},
    {"mlbe.mlbTypeData[0].operations", "list", 3},
    {"mlbe.mlbTypeData[0].operations[1]", "list", 1},
    {"mlbe.mlbTypeData[0].operations[1][0]", "record", 4},
    {"mlbe.mlbTypeData[0].operations[1][0].parameters", "u32", 5},
    {"mlbe.mlbTypeData[0].operations[1][0].mlOperationSetDependencyIndices", "u16", 1},
    {"mlbe.mlbTypeData[0].operations[1][0].mlOperationDependencyIndices", "u16", 1},
    {"mlbe.mlbTypeData[0].operations[1][0].operationType", "u16", 1},
    {"mlbe.mlbJoints", "record", 4},
    {"mlbe.mlbJoints.parameterKeys", "u16", 3},
    {"mlbe.mlbJoints.parameterValues", "u16", 3},
    {"mlbe.mlbJoints.inputIndices", "u16", 4},
    {"mlbe.mlbJoints.outputIndices", "u16", 4},
    {"rbfb", "record", 3},
    {"rbfb.lodSolverMapping.lods", "u16", 2},
    {"rbfb.solvers", "list", 1},
    {"rbfb.solvers[0]", "record", 12},
    {"rbfb.solvers[0].name", "string", 5},
    {"rbfb.solvers[0].rawControlIndices", "u16", 2},
    {"rbfb.solvers[0].poseIndices", "u16", 2},
    {"rbfb.solvers[0].rawControlValues", "f32", 4},
    {"rbfb.solvers[0].radius", "f32", 1},
    {"rbfb.solvers[0].weightThreshold", "f32", 1},
    {"rbfb.solvers[0].solverType", "u16", 1},
    {"rbfb.solvers[0].automaticRadius", "u16", 1},
    {"rbfb.solvers[0].distanceMethod", "u16", 1},
    {"rbfb.solvers[0].normalizeMethod", "u16", 1},
    {"rbfb.solvers[0].functionType", "u16", 1},
    {"rbfb.solvers[0].twistAxis", "u16", 1},
    {"rbfb.poses", "list", 2},
    {"rbfb.poses[1].name", "string", 4},
    {"rbfb.poses[1].scale", "f32", 1},
    {"rbfe", "record", 2},
    {"rbfe.poseControlNames", "list", 2},
    {"rbfe.poses", "list", 2},
    {"rbfe.poses[1].inputControlIndices", "u16", 1},
    {"rbfe.poses[1].outputControlIndices", "u16", 1},
    {"rbfe.poses[1].outputControlWeights", "f32", 1},
    {"jbmd", "record", 1},
    {"jbmd.jointRepresentations", "list", 3},
    {"jbmd.jointRepresentations[2]", "record", 3},
    {"jbmd.jointRepresentations[2].translation", "u16", 1},
    {"jbmd.jointRepresentations[2].rotation", "u16", 1},
    {"jbmd.jointRepresentations[2].scale", "u16", 1},
    {"twsw", "record", 2},
    {"twsw.twists", "list", 1},
    {"twsw.twists[0]", "record", 4},
    {"twsw.twists[0].twistBlendWeights", "f32", 1},
    {"twsw.twists[0].twistOutputJointIndices", "u16", 1},
    {"twsw.twists[0].twistInputControlIndices", "u16", 4},
    {"twsw.twists[0].twistAxis", "u16", 1},
    {"twsw.swings[0].swingBlendWeights", "f32", 1},
    {"twsw.swings[0].swingOutputJointIndices", "u16", 1},
    {"twsw.swings[0].swingInputControlIndices", "u16", 4},
    {"twsw.swings[0].twistAxis", "u16", 1},
};

const char* type_name(FieldType type) {
  constexpr const char* kNames[] = {"record", "list", "string", "u8", "u16", "u32", "i32", "f32"};
  return kNames[static_cast<size_t>(type)];
}

TEST_F(DnaPath, FieldsHaveTheNamesOfTheFormat) {
  for (const auto& expected : kFields) {
    const FieldRef found = find(expected.path);
    EXPECT_STREQ(type_name(found.type), expected.type) << expected.path;
    EXPECT_EQ(found.count, expected.count) << expected.path;
    const bool has_bytes = found.type == FieldType::kString || found.count != 1 ||
                           std::string(expected.path).back() == ']';
    if (found.type == FieldType::kRecord || found.type == FieldType::kList) {
      EXPECT_EQ(found.bytes, nullptr) << expected.path;
    } else if (has_bytes) {
      EXPECT_NE(view.offset_of(found.bytes), kNoOffset) << expected.path;
    }
  }
}

TEST_F(DnaPath, Values) {
  EXPECT_EQ(load_big_endian<uint16_t>(find("desc.archetype").number), 5);
  EXPECT_EQ(load_big_endian<uint16_t>(find("desc.coordinateSystem.zAxis").number), 4);
  EXPECT_EQ(load_big_endian<int32_t>(find("dsce.rotationSign.y").number), 1);
  EXPECT_EQ(load_big_endian<float>(find("rbfb.solvers[0].radius").number), 60.0f);
  EXPECT_EQ(load_big_endian<float>(find("bhvr.joints.jointGroups[0].values[0]").bytes), 20.0f);
  EXPECT_EQ(load_big_endian<uint32_t>(find("geom.meshes[0].faces[1].layoutIndices[2]").bytes), 5u);
  const FieldRef name = find("defn.jointNames[2]");
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(name.bytes), name.count), "tongue");
}

// All of them -------------------------------------------------------------------------------------

/// Calls itself for every field of a record, asks for it by path, and compares.
struct Walker {
  explicit Walker(const DnaView& of) : view(of) {}

  const DnaView& view;
  std::string path;
  size_t fields = 0, numbers = 0;

  bool has_face_winding() const { return version_has_face_winding(view.version); }

  template <class T>
  void operator()(const char* name, const T& member) {
    // The name at its place in the list of names.
    const std::string record = path;
    const char* found = nullptr;
    Error error;
    EXPECT_EQ(find_field_name(view, record.c_str(), index_++, found, error), Status::kOk) << record;
    EXPECT_STREQ(found, name);
    step("." + std::string(name), member);
  }

  template <class T>
  void step(const std::string& part, const T& member) {
    const std::string before = path;
    const uint32_t index = index_;
    path += part;
    index_ = 0;
    ++fields;
    look(member);
    path = before;
    index_ = index;
  }

 private:
  FieldRef found(FieldType type, uint64_t count) {
    FieldRef ref;
    Error error;
    EXPECT_EQ(find_field(view, path.c_str(), ref, error), Status::kOk) << error.message;
    EXPECT_EQ(ref.type, type) << path;
    EXPECT_EQ(ref.count, count) << path;
    return ref;
  }
  static FieldType type_of(uint8_t) { return FieldType::kU8; }
  static FieldType type_of(uint16_t) { return FieldType::kU16; }
  static FieldType type_of(uint32_t) { return FieldType::kU32; }
  static FieldType type_of(int32_t) { return FieldType::kI32; }
  static FieldType type_of(float) { return FieldType::kF32; }

  void past_the_end(const std::string& part, Status status) {
    FieldRef ref;
    Error error;
    EXPECT_EQ(find_field(view, (path + part).c_str(), ref, error), status) << path << part;
    EXPECT_EQ(error.status, status);
    EXPECT_EQ(ref.bytes, nullptr);
  }

  template <class Record, std::enable_if_t<std::is_class<Record>::value, int> = 0>
  void look(const Record& record) {
    Record::fields(record, *this);
    EXPECT_EQ(found(FieldType::kRecord, index_).bytes, nullptr);
    const char* name = nullptr;
    Error error;
    EXPECT_EQ(find_field_name(view, path.c_str(), index_, name, error), Status::kIndex) << path;
    past_the_end("[0]", Status::kName);
    past_the_end(".none", Status::kName);
  }
  template <class T>
  void look(const List<T>& list) {
    EXPECT_EQ(found(FieldType::kList, list.count).bytes, nullptr);
    for (uint32_t i = 0; i < list.count; ++i) step("[" + std::to_string(i) + "]", list[i]);
    past_the_end("[" + std::to_string(list.count) + "]", Status::kIndex);
    past_the_end(".none", Status::kName);
  }
  template <class T>
  void look(const Array<T>& array) {
    EXPECT_EQ(found(type_of(T()), array.count).bytes, array.data) << path;
    for (uint32_t i = 0; i < array.count; ++i) {
      step("[" + std::to_string(i) + "]", Element<T>{array.data + i * sizeof(T)});
    }
    past_the_end("[" + std::to_string(array.count) + "]", Status::kIndex);
    past_the_end(".none", Status::kName);
  }
  template <class T>
  struct Element {
    const uint8_t* bytes;
  };
  template <class T>
  void look(const Element<T>& element) {
    EXPECT_EQ(found(type_of(T()), 1).bytes, element.bytes) << path;
    past_the_end("[0]", Status::kName);
    ++numbers;
  }
  void look(const String& string) {
    EXPECT_EQ(found(FieldType::kString, string.count).bytes, string.data) << path;
    past_the_end("[0]", Status::kName);
    past_the_end(".none", Status::kName);
  }
  template <class T, std::enable_if_t<std::is_arithmetic<T>::value, int> = 0>
  void look(T value) {
    const FieldRef ref = found(type_of(T()), 1);
    EXPECT_EQ(ref.bytes, nullptr) << path;
    EXPECT_EQ(load_big_endian<T>(ref.number), value) << path;
    past_the_end("[0]", Status::kName);
    past_the_end(".none", Status::kName);
    ++numbers;
  }

  uint32_t index_ = 0;
};

TEST_F(DnaPath, EveryFieldIsFound) {
  Walker walker(view);
  for (const LayerKind& kind : kLayerKinds) {
    with_layer(view, kind.id, [&](const auto& record) { walker.step(kind.name, record); });
  }
  EXPECT_GT(walker.fields, std::size(kFields));
  EXPECT_GT(walker.numbers, 300u);
}

// Names -------------------------------------------------------------------------------------------

TEST_F(DnaPath, LayersByNumber) {
  std::set<std::string> names;
  for (uint32_t i = 0; i < kLayerIdCount; ++i) {
    const char* name = nullptr;
    ASSERT_EQ(find_field_name(view, "", i, name, error), Status::kOk);
    EXPECT_STREQ(name, kLayerKinds[i].name);
    names.insert(name);
  }
  EXPECT_EQ(names.size(), kLayerIdCount);
  const char* name = nullptr;
  EXPECT_EQ(find_field_name(view, "", kLayerIdCount, name, error), Status::kIndex);
  EXPECT_EQ(name, nullptr);
}

TEST_F(DnaPath, OnlyRecordsHaveNames) {
  for (const char* path :
       {"desc.name", "desc.age", "desc.metadata", "defn.jointNames[0]", "defn.jointHierarchy",
        "bhvr.joints.jointGroups[0].values[0]", "mlbh.neuralNetworkToMeshRegion.regionNames[0]"}) {
    const char* name = nullptr;
    EXPECT_EQ(find_field_name(view, path, 0, name, error), Status::kInvalidArgument) << path;
    EXPECT_EQ(name, nullptr);
    EXPECT_NE(std::string(error.message).find(path), std::string::npos);
  }
}

// A file numbered below 2.8 has no winding, so no field for it.
TEST_F(DnaPath, FieldsOfTheVersion) {
  view.version = 7;
  FieldRef found;
  EXPECT_EQ(find_field(view, "dsce.faceWindingOrder", found, error), Status::kName);
  EXPECT_EQ(find("dsce").count, 2u);
  view.version = 9;
  EXPECT_EQ(find("dsce").count, 3u);
}

TEST_F(DnaPath, PrefixesAndExtensionsOfNamesAreOtherNames) {
  for (const auto& field : kFields) {
    const std::string path = field.path;
    if (path.empty() || path.back() == ']') continue;
    FieldRef found;
    EXPECT_EQ(find_field(view, (path + "s").c_str(), found, error), Status::kName) << path;
    const std::string shorter = path.substr(0, path.size() - 1);
    EXPECT_EQ(find_field(view, shorter.c_str(), found, error), Status::kName) << shorter;
  }
}

TEST_F(DnaPath, ErrorsTellWhatIsNotThere) {
  const struct {
    const char* path;
    Status status;
    const char* said;
  } cases[] = {
      {"behavior.joints", Status::kName, "\"behavior.joints\" is not a layer"},
      {"bhvr.join.rowCount", Status::kName, "\"join.rowCount\" is not a field"},
      {"bhvr.joints[0]", Status::kName, "\"[0]\" does not exist"},
      {"defn.jointNames.count", Status::kName, "\".count\" does not exist"},
      {"defn.jointNames[1", Status::kName, "\"[1\" lacks its closing bracket"},
      {"defn.jointNames[3]", Status::kIndex, "\"[3]\" is past the end: the list has 3 elements"},
      {"defn.jointHierarchy[99999999999999999999]", Status::kIndex, "3 elements"},
      {"desc.age.years", Status::kName, "\".years\" does not exist: a number"},
      {"desc.name.first", Status::kName, "\".first\" does not exist: a string"},
  };
  for (const auto& c : cases) {
    FieldRef found;
    found.count = 77;
    EXPECT_EQ(find_field(view, c.path, found, error), c.status) << c.path;
    EXPECT_EQ(error.status, c.status);
    EXPECT_EQ(error.byte_offset, kNoOffset);
    EXPECT_NE(std::string(error.message).find(c.said), std::string::npos) << error.message;
    EXPECT_EQ(found.count, 77u) << "left alone";
  }
}

}  // namespace
}  // namespace mien::dna
