// SPDX-License-Identifier: MIT
// The GLB writer on scenes made by hand: what rigs that Mien generates do not have.
#include "integrations/program/gltf/glb_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

namespace mien::gltf {
namespace {

using nlohmann::json;

/// The two parts of a file, after a look at its frame.
struct Parts {
  json text;
  std::string binary;
};

uint32_t word_at(const std::string& bytes, size_t at) {
  uint32_t word = 0;
  for (size_t i = 0; i < 4; ++i) {
    word |= static_cast<uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  }
  return word;
}

Parts read(const std::string& bytes) {
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(word_at(bytes, 8), bytes.size());
  const uint32_t size = word_at(bytes, 12);
  EXPECT_EQ(size % 4, 0u);
  EXPECT_EQ(word_at(bytes, 20 + size), bytes.size() - 28 - size);
  return {json::parse(bytes.substr(20, size)), bytes.substr(28 + size)};
}

std::vector<float> floats(const Parts& parts, size_t accessor) {
  const json& entry = parts.text["accessors"][accessor];
  const json& view = parts.text["bufferViews"][entry["bufferView"].get<size_t>()];
  const std::string shape = entry["type"];
  const size_t width = shape == "SCALAR" ? 1 : shape == "MAT4" ? 16 : shape.back() - '0';
  std::vector<float> values(entry["count"].get<size_t>() * width);
  const size_t begin = view["byteOffset"].get<size_t>() + entry.value("byteOffset", 0);
  for (size_t i = 0; i < values.size(); ++i) {
    const uint32_t bits = word_at(parts.binary, begin + 4 * i);
    std::memcpy(&values[i], &bits, sizeof(bits));
  }
  return values;
}

/// A fan of triangles around vertex 0.
Mesh fan(size_t vertices) {
  Mesh mesh;
  mesh.name = "fan";
  for (uint32_t v = 0; v < vertices; ++v) mesh.positions.push_back({float(v), float(v % 7), 0});
  for (uint32_t v = 2; v < vertices; ++v) {
    mesh.triangles.insert(mesh.triangles.end(), {0, v - 1, v});
  }
  return mesh;
}

Scene scene_of(Mesh mesh) {
  Scene scene;
  scene.name = "scene";
  scene.materials.emplace_back();
  scene.materials[0].name = "gray";
  scene.meshes.push_back(std::move(mesh));
  scene.lod_names = {"LOD 0"};
  scene.lods = {{0}};
  return scene;
}

Joint joint_at(const char* name, uint32_t parent, math::Vec3d place) {
  Joint joint;
  joint.name = name;
  joint.parent = parent;
  joint.bind.translation = joint.pose.translation = place;
  return joint;
}

MorphTarget target_of(size_t count) {
  MorphTarget target;
  target.name = "target";
  for (uint32_t v = 0; v < count; ++v) {
    target.vertices.push_back(2 * v);
    target.positions.push_back({1, -2, float(v)});
  }
  return target;
}

TEST(GlbWriter, NodesUndoTheQuantizationOfMeshesWithoutSkin) {
  Mesh mesh = fan(9);  // x from 0 to 8, y from 0 to 6
  mesh.targets.push_back(target_of(2));
  const Parts parts = read(write_glb(scene_of(std::move(mesh)), Encoding::kQuantized));
  EXPECT_EQ(parts.text["extensionsRequired"], json::array({"KHR_mesh_quantization"}));
  const json& node = parts.text["nodes"][0];
  EXPECT_EQ(node["translation"], json::array({4.0, 3.0, 0.0}));
  EXPECT_EQ(node["scale"], json::array({4.0, 4.0, 4.0}));
  const json& primitive = parts.text["meshes"][0]["primitives"][0];
  const json& positions =
      parts.text["accessors"][primitive["attributes"]["POSITION"].get<size_t>()];
  EXPECT_EQ(positions["componentType"], 5122);
  EXPECT_EQ(positions["normalized"], true);
  EXPECT_EQ(positions["min"], json::array({-32767, -24575, 0}));
  EXPECT_EQ(positions["max"], json::array({32767, 24575, 0}));
  // What targets move is a quarter as well, and is not moved to the center.
  const json& moves = parts.text["accessors"][primitive["targets"][0]["POSITION"].get<size_t>()];
  EXPECT_EQ(moves["min"], json::array({0, -16384, 0}));
  EXPECT_EQ(moves["max"], json::array({8192, 0, 8192}));
}

TEST(GlbWriter, StillMeshHasNoSkeleton) {
  const Parts parts = read(write_glb(scene_of(fan(4))));
  EXPECT_FALSE(parts.text.contains("skins"));
  EXPECT_FALSE(parts.text.contains("animations"));
  EXPECT_EQ(parts.text["nodes"].size(), 1u);
  EXPECT_EQ(parts.text["scenes"][0]["nodes"], json::array({0}));
  const json& attributes = parts.text["meshes"][0]["primitives"][0]["attributes"];
  EXPECT_EQ(attributes.size(), 1u);
  const json& accessor = parts.text["accessors"][attributes["POSITION"].get<size_t>()];
  EXPECT_EQ(accessor["min"], json::array({0.0, 0.0, 0.0}));
  EXPECT_EQ(accessor["max"], json::array({3.0, 3.0, 0.0}));
}

TEST(GlbWriter, IndicesAreAsWideAsTheyHaveToBe) {
  for (const auto& [vertices, type] : {std::pair<size_t, int>{65535, 5123}, {65536, 5125}}) {
    Mesh mesh = fan(vertices);
    mesh.targets.push_back(target_of(3));
    const Parts parts = read(write_glb(scene_of(std::move(mesh))));
    const json& primitive = parts.text["meshes"][0]["primitives"][0];
    EXPECT_EQ(parts.text["accessors"][primitive["indices"].get<size_t>()]["componentType"], type);
    // 65535 is a number of a vertex like any other here.
    const json& target = parts.text["accessors"][primitive["targets"][0]["POSITION"].get<size_t>()];
    EXPECT_EQ(target["sparse"]["indices"]["componentType"], 5123);
  }
  Mesh mesh = fan(65537);
  mesh.targets.push_back(target_of(3));
  const Parts parts = read(write_glb(scene_of(std::move(mesh))));
  const json& target = parts.text["meshes"][0]["primitives"][0]["targets"][0];
  EXPECT_EQ(parts.text["accessors"][target["POSITION"].get<size_t>()]["sparse"]["indices"]
                      ["componentType"],
            5125);
}

TEST(GlbWriter, TargetsAreSparseWhereThatIsSmaller) {
  Mesh mesh = fan(100);
  // 14 bytes each against 12 for each of 100 vertices.
  for (const size_t count : {size_t{0}, size_t{1}, size_t{50}}) {
    mesh.targets.push_back(target_of(count));
  }
  mesh.targets.push_back(target_of(0));
  for (uint32_t v = 0; v < 86; ++v) {
    mesh.targets[3].vertices.push_back(v);
    mesh.targets[3].positions.push_back({0, 0, -1});
  }
  mesh.targets[1].weight = 0.5f;
  const Parts parts = read(write_glb(scene_of(std::move(mesh))));
  const json& written = parts.text["meshes"][0];
  EXPECT_EQ(written["weights"], json::array({0.0, 0.5, 0.0, 0.0}));
  EXPECT_EQ(written["extras"]["targetNames"].size(), 4u);
  std::vector<json> accessors;
  for (const json& target : written["primitives"][0]["targets"]) {
    EXPECT_FALSE(target.contains("NORMAL"));
    accessors.push_back(parts.text["accessors"][target["POSITION"].get<size_t>()]);
    EXPECT_EQ(accessors.back()["count"], 100);
  }
  EXPECT_FALSE(accessors[0].contains("sparse") || accessors[0].contains("bufferView"));
  EXPECT_EQ(accessors[1]["sparse"]["count"], 1);
  EXPECT_EQ(accessors[2]["sparse"]["count"], 50);
  EXPECT_EQ(accessors[2]["max"], json::array({1.0, 0.0, 49.0}));
  EXPECT_FALSE(accessors[3].contains("sparse"));
  EXPECT_TRUE(accessors[3].contains("bufferView"));
  const std::vector<float> dense =
      floats(parts, written["primitives"][0]["targets"][3]["POSITION"].get<size_t>());
  EXPECT_EQ(dense[3 * 85 + 2], -1);
  EXPECT_EQ(dense[3 * 86 + 2], 0);
}

TEST(GlbWriter, InverseBindsComeFromParentsThatFollow) {
  Mesh mesh = fan(3);
  mesh.influences = 4;
  mesh.joints.assign(12, 0);
  mesh.weights = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  Scene scene = scene_of(std::move(mesh));
  // The child stands before its parent; a second root stands by.
  scene.joints = {joint_at("child", 1, {0, 2, 0}), joint_at("parent", kNone, {1, 0, 0}),
                  joint_at("other", kNone, {0, 0, 5})};
  const double half = std::sqrt(0.5);
  scene.joints[1].bind.rotation = {0, 0, half, half};  // a quarter turn about z
  scene.joints[1].pose = scene.joints[1].bind;
  scene.joints[0].pose.scale = {2, 1, 1};
  const Parts parts = read(write_glb(scene));
  const json& nodes = parts.text["nodes"];
  EXPECT_EQ(nodes[0]["children"], json::array({2, 3}));
  EXPECT_EQ(nodes[2]["children"], json::array({1}));
  EXPECT_EQ(nodes[1]["scale"], json::array({2.0, 1.0, 1.0}));
  const json& skin = parts.text["skins"][0];
  EXPECT_EQ(skin["joints"], json::array({1, 2, 3}));
  const std::vector<float> binds = floats(parts, skin["inverseBindMatrices"].get<size_t>());
  // The child is at (1, 0, 0) + a quarter turn of (0, 2, 0) = (-1, 0, 0); its x points up.
  const float expected[16] = {0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1};
  for (size_t i = 0; i < 16; ++i) EXPECT_NEAR(binds[i], expected[i], 1e-6) << i;
  EXPECT_EQ(binds[32 + 14], -5);
}

TEST(GlbWriter, ManyJointsHaveWideNumbers) {
  for (const auto& [count, type] : {std::pair<uint32_t, int>{256, 5121}, {257, 5123}}) {
    Mesh mesh = fan(3);
    mesh.influences = 12;
    mesh.joints.assign(36, 0);
    mesh.weights.assign(36, 0);
    for (size_t v = 0; v < 3; ++v) {
      mesh.joints[12 * v] = static_cast<uint16_t>(count - 1);
      mesh.weights[12 * v] = 1;
    }
    Scene scene = scene_of(std::move(mesh));
    for (uint32_t j = 0; j < count; ++j) {
      scene.joints.push_back(joint_at("j", j == 0 ? kNone : j - 1, {0, 0, 1}));
    }
    const Parts parts = read(write_glb(scene));
    const json& attributes = parts.text["meshes"][0]["primitives"][0]["attributes"];
    for (const char* set : {"JOINTS_0", "JOINTS_1", "JOINTS_2"}) {
      EXPECT_EQ(parts.text["accessors"][attributes[set].get<size_t>()]["componentType"], type);
    }
    const std::vector<float> binds =
        floats(parts, parts.text["skins"][0]["inverseBindMatrices"].get<size_t>());
    EXPECT_EQ(binds[16 * (count - 1) + 14], -static_cast<float>(count));
  }
}

TEST(GlbWriter, AnimationNeedsTimesAndTracks) {
  Scene scene = scene_of(fan(3));
  scene.animation.name = "none";
  scene.animation.times = {0, 1};
  EXPECT_FALSE(read(write_glb(scene)).text.contains("animations"));
  scene.meshes[0].targets.push_back(target_of(1));
  scene.animation.weights = {{0, {0.25f, 0.75f}}};
  const Parts parts = read(write_glb(scene));
  const json& animation = parts.text["animations"][0];
  EXPECT_EQ(animation["channels"][0]["target"], json({{"node", 0}, {"path", "weights"}}));
  const json& sampler = animation["samplers"][0];
  EXPECT_EQ(floats(parts, sampler["input"].get<size_t>()), (std::vector<float>{0, 1}));
  EXPECT_EQ(floats(parts, sampler["output"].get<size_t>()), (std::vector<float>{0.25f, 0.75f}));
  EXPECT_EQ(parts.text["accessors"][sampler["input"].get<size_t>()]["max"], json::array({1.0}));
}

TEST(GlbWriter, NamesNeedNotBeUtf8) {
  Scene scene = scene_of(fan(3));
  scene.meshes[0].name = "caf\xe9 \"\n";
  EXPECT_EQ(read(write_glb(scene)).text["meshes"][0]["name"], "caf\xef\xbf\xbd \"\n");
}

TEST(GlbWriter, RefusesWhatIsNoNumber) {
  for (const float bad : {NAN, INFINITY, -INFINITY}) {
    Scene scene = scene_of(fan(3));
    scene.meshes[0].positions[1][2] = bad;
    try {
      write_glb(scene);
      ADD_FAILURE();
    } catch (const ExportError& error) {
      EXPECT_EQ(error.status, MIEN_ERROR_DNA_VALUE);
      EXPECT_EQ(error.where, "mesh fan");
    }
    scene = scene_of(fan(3));
    scene.meshes[0].targets.push_back(target_of(1));
    scene.meshes[0].targets[0].positions[0][0] = bad;
    EXPECT_THROW(write_glb(scene), ExportError);
  }
}

}  // namespace
}  // namespace mien::gltf
