// SPDX-License-Identifier: MIT
// Meshes, joints and shapes from elsewhere: copying, merging, projecting, conforming, transplanting.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/support/bytes.h"
#include "tests/support/document_edits.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

using Weights = std::map<std::string, double>;  // [joint]

std::string mesh_path(size_t mesh, const char* rest) {
  return "geom.meshes[" + std::to_string(mesh) + "]." + rest;
}

std::vector<Weights> named_weights_of(const DocumentHandle& d, size_t mesh) {
  const auto names = strings_of(d, "defn.jointNames");
  std::vector<Weights> all(field_of(d, mesh_path(mesh, "skinWeights")).count);
  for (size_t v = 0; v < all.size(); ++v) {
    const std::string path = mesh_path(mesh, "skinWeights[") + std::to_string(v) + "]";
    const auto joints = integers_of(d, path + ".jointIndices");
    const auto weights = floats_of(d, path + ".weights");
    for (size_t i = 0; i < joints.size(); ++i)
      all[v][names[static_cast<size_t>(joints[i])]] += weights[i];
  }
  return all;
}

using Target = std::map<int64_t, std::vector<float>>;  // [vertex] delta
std::map<std::string, Target> targets_of(const DocumentHandle& d, size_t mesh) {
  const auto names = strings_of(d, "defn.blendShapeChannelNames");
  std::map<std::string, Target> all;
  for (size_t t = 0; t < field_of(d, mesh_path(mesh, "blendShapeTargets")).count; ++t) {
    const std::string path = mesh_path(mesh, "blendShapeTargets[") + std::to_string(t) + "]";
    const auto x = floats_of(d, path + ".deltas.xs"), y = floats_of(d, path + ".deltas.ys"),
               z = floats_of(d, path + ".deltas.zs");
    const auto vertices = integers_of(d, path + ".vertexIndices");
    Target& target =
        all[names[static_cast<size_t>(integers_of(d, path + ".blendShapeChannelIndex")[0])]];
    for (size_t i = 0; i < vertices.size(); ++i) {
      if (x[i] != 0 || y[i] != 0 || z[i] != 0) target[vertices[i]] = {x[i], y[i], z[i]};
    }
  }
  for (auto it = all.begin(); it != all.end();)
    it = it->second.empty() ? all.erase(it) : std::next(it);
  return all;
}

uint32_t find(const DocumentHandle& d, uint32_t kind, const std::string& name) {
  uint32_t index = 0;
  EXPECT_EQ(mien_document_find(d.get(), kind, name.c_str(), &index, nullptr), MIEN_OK) << name;
  return index;
}

TEST(CopyMesh, BringsBackAMeshThatWasRemoved) {
  const Bytes bytes = golden::read_rig("small");
  const DocumentHandle other = document_of(bytes), document = document_of(bytes);
  const auto names = strings_of(other, "defn.meshNames");
  for (uint32_t mesh = 0; mesh < names.size(); ++mesh) {
    ASSERT_EQ(mien_document_undo(document.get(), 0, nullptr), MIEN_OK);
    if (names.size() > 1) {
      ASSERT_EQ(mien_document_remove(document.get(), MIEN_KIND_MESH, &mesh, 1, nullptr), MIEN_OK);
    }
    uint32_t made = 0;
    MienError error = sized<MienError>();
    ASSERT_EQ(mien_document_copy_mesh(document.get(), other.get(), mesh, &made, &error), MIEN_OK)
        << error.message;
    EXPECT_EQ(string_of(document, "defn.meshNames[" + std::to_string(made) + "]"), names[mesh]);
    EXPECT_EQ(named_weights_of(document, made), named_weights_of(other, mesh));
    EXPECT_EQ(targets_of(document, made), targets_of(other, mesh));
    for (const char* field : {"positions.xs", "normals.zs", "textureCoordinates.us"}) {
      EXPECT_EQ(floats_of(document, mesh_path(made, field)),
                floats_of(other, mesh_path(mesh, field)));
    }
    // The same LODs, the same pairs with channels.
    for (size_t lod = 0; lod < field_of(other, "defn.lodMeshMapping.lods").count; ++lod) {
      const auto has = [&](const DocumentHandle& d, uint32_t number) {
        const auto rows = integers_of(d, "defn.lodMeshMapping.lods");
        const auto list =
            integers_of(d, "defn.lodMeshMapping.indices[" + std::to_string(rows[lod]) + "]");
        return std::count(list.begin(), list.end(), number);
      };
      EXPECT_EQ(has(document, made), has(other, mesh)) << lod;
    }
    EXPECT_EQ(field_of(document, "defn.meshBlendShapeChannelMapping.from").count,
              field_of(other, "defn.meshBlendShapeChannelMapping.from").count);
    EXPECT_TRUE(dna_of(document));
  }
}

TEST(CopyMesh, HandsInfluenceOfOtherJointsToAncestors) {
  const Bytes bytes = golden::read_rig("small");
  const DocumentHandle other = document_of(bytes), document = document_of(bytes),
                       model = document_of(bytes);
  const auto parents = integers_of(other, "defn.jointHierarchy");
  std::vector<uint32_t> gone;
  for (uint32_t j = 0; j < parents.size(); ++j) {
    if (parents[j] != j && j % 2) gone.push_back(j);
  }
  for (const DocumentHandle* d : {&document, &model}) {
    ASSERT_EQ(mien_document_remove(d->get(), MIEN_KIND_JOINT, gone.data(), gone.size(), nullptr),
              MIEN_OK);
  }
  uint32_t made = 0;
  ASSERT_EQ(mien_document_copy_mesh(document.get(), other.get(), 0, &made, nullptr), MIEN_OK);
  const auto found = named_weights_of(document, made), wanted = named_weights_of(model, 0);
  ASSERT_EQ(found.size(), wanted.size());
  for (size_t v = 0; v < found.size(); ++v) {
    ASSERT_EQ(found[v].size(), wanted[v].size());
    for (const auto& [name, weight] : wanted[v])
      EXPECT_NEAR(found[v].at(name), weight, 1e-6) << v << name;
  }
}

TEST(CopyLayers, TakesThemWhole) {
  const DocumentHandle other = document_of(golden::read_rig("body")),
                       document = document_of(golden::read_rig("body"));
  ASSERT_EQ(mien_document_clear(document.get(), MIEN_KIND_JOINT, nullptr), MIEN_OK);
  ASSERT_EQ(
      mien_document_copy_layers(document.get(), other.get(),
                                MIEN_LAYER_BEHAVIOR | MIEN_LAYER_TWIST_SWING_BEHAVIOR, nullptr),
      MIEN_OK);
  EXPECT_EQ(bytes_of(document), golden::read_rig("body"));
  EXPECT_EQ(mien_document_copy_layers(document.get(), other.get(), 1024, nullptr),
            MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_document_copy_layers(document.get(), document.get(), 1, nullptr),
            MIEN_ERROR_INVALID_ARGUMENT);
}

TEST(MergeJoints, AddsThoseThatAreNotThereAndSplitsThemAgain) {
  const Bytes bytes = golden::read_rig("small");
  const DocumentHandle whole = document_of(bytes), part = document_of(bytes),
                       document = document_of(bytes);
  const auto names = strings_of(whole, "defn.jointNames");
  const auto parents = integers_of(whole, "defn.jointHierarchy");
  const std::set<int64_t> inner(parents.begin(), parents.end());
  std::vector<uint32_t> gone;
  for (uint32_t j = 0; j < names.size(); ++j) {
    if (!inner.count(j) && j % 2 == 0) gone.push_back(j);
  }
  ASSERT_FALSE(gone.empty());
  for (const DocumentHandle* d : {&part, &document}) {
    ASSERT_EQ(mien_document_remove(d->get(), MIEN_KIND_JOINT, gone.data(), gone.size(), nullptr),
              MIEN_OK);
  }
  const auto part_names = strings_of(part, "defn.jointNames");
  MienError error = sized<MienError>();
  ASSERT_EQ(mien_document_merge_joints(document.get(), whole.get(), 1e-3, &error), MIEN_OK)
      << error.message;
  const auto merged = strings_of(document, "defn.jointNames");
  ASSERT_EQ(merged.size(), names.size());
  EXPECT_TRUE(std::equal(part_names.begin(), part_names.end(), merged.begin()));
  EXPECT_EQ(std::set<std::string>(merged.begin(), merged.end()),
            std::set<std::string>(names.begin(), names.end()));
  const auto merged_parents = integers_of(document, "defn.jointHierarchy");
  for (const char* axis : {"xs", "ys", "zs"}) {
    for (const char* field : {"defn.neutralJointTranslations.", "defn.neutralJointRotations."}) {
      const auto mine = floats_of(document, std::string(field) + axis),
                 theirs = floats_of(whole, std::string(field) + axis);
      for (size_t j = 0; j < merged.size(); ++j)
        EXPECT_EQ(mine[j], theirs[find(whole, MIEN_KIND_JOINT, merged[j])]);
    }
  }
  for (size_t j = 0; j < merged.size(); ++j) {
    EXPECT_EQ(merged[static_cast<size_t>(merged_parents[j])],
              names[static_cast<size_t>(parents[find(whole, MIEN_KIND_JOINT, merged[j])])]);
  }
  EXPECT_TRUE(dna_of(document));
  ASSERT_EQ(mien_document_split_joints(document.get(), part.get(), nullptr), MIEN_OK);
  EXPECT_EQ(strings_of(document, "defn.jointNames"), part_names);
  EXPECT_EQ(integers_of(document, "defn.jointHierarchy"), integers_of(part, "defn.jointHierarchy"));
  EXPECT_EQ(floats_of(document, "defn.neutralJointTranslations.xs"),
            floats_of(part, "defn.neutralJointTranslations.xs"));
  // Somewhere else.
  const float far[] = {1000, 0, 0};
  ASSERT_EQ(mien_document_set_neutral(document.get(), 0, far, nullptr, 1, nullptr), MIEN_OK);
  EXPECT_EQ(mien_document_merge_joints(document.get(), whole.get(), 1e-3, &error),
            MIEN_ERROR_MISMATCH);
  EXPECT_NE(std::string(error.message).find("stands"), std::string::npos) << error.message;
}

// A copy of a mesh in the same place gets the same weights and targets.
TEST(Project, ReproducesAMeshAtTheSamePlaces) {
  for (uint32_t match : {MIEN_MATCH_SURFACE, MIEN_MATCH_UV}) {
    // The texture of the head has places with several positions; that of the tiny rig has not.
    Arena arena(default_allocator());
    const Bytes tiny = write_view(dna::tiny_rig(arena));
    const DnaHandle head =
        match == MIEN_MATCH_SURFACE ? generate_dna(MIEN_PRESET_HEAD, 0) : open_dna(tiny);
    const DocumentHandle document = create_document(head.get()),
                         donor = create_document(head.get());
    // The mesh with the most targets.
    uint32_t source = 0;
    for (uint32_t m = 0; m < field_of(donor, "geom.meshes").count; ++m) {
      if (field_of(donor, mesh_path(m, "blendShapeTargets")).count >
          field_of(donor, mesh_path(source, "blendShapeTargets")).count)
        source = m;
    }
    ASSERT_EQ(mien_document_rename(donor.get(), MIEN_KIND_MESH, source, "twin", nullptr), MIEN_OK);
    uint32_t twin = 0;
    ASSERT_EQ(mien_document_copy_mesh(document.get(), donor.get(), source, &twin, nullptr),
              MIEN_OK);
    const uint32_t count = positions_of(document.get(), twin);
    const std::vector<uint16_t> root(count, 0);
    const std::vector<float> ones(count, 1.0f);
    ASSERT_EQ(mien_document_set_weights(document.get(), twin, 1, root.data(), ones.data(), count,
                                        nullptr),
              MIEN_OK);
    ASSERT_EQ(resize(document, mesh_path(twin, "blendShapeTargets"), 0), MIEN_OK);
    MienProjectDesc desc = sized<MienProjectDesc>();
    desc.match = match;
    desc.influences = 12;
    double farthest = 1;
    MienError error = sized<MienError>();
    ASSERT_EQ(mien_document_project(document.get(), twin, source, &desc, &farthest, &error),
              MIEN_OK)
        << error.message;
    EXPECT_LT(farthest, 1e-4);
    const auto wanted = named_weights_of(document, source),
               found = named_weights_of(document, twin);
    // Positions at one place in space, and places of the texture that several positions have, may get each
    // other's: all but a few are the same.
    size_t other = 0;
    for (size_t v = 0; v < wanted.size(); ++v) {
      bool same = true;
      for (const auto& [name, weight] : wanted[v]) {
        const auto at = found[v].find(name);
        same &= std::abs((at == found[v].end() ? 0 : at->second) - weight) < 2e-3;
      }
      other += !same;
    }
    EXPECT_LE(other, wanted.size() / 50) << match;
    const auto old_targets = targets_of(document, source), new_targets = targets_of(document, twin);
    size_t compared = 0, different = 0;
    for (const auto& [channel, target] : old_targets) {
      for (const auto& [vertex, delta] : target) {
        const auto t = new_targets.find(channel);
        const bool there = t != new_targets.end() && t->second.count(vertex);
        double distance = 0;
        for (size_t k = 0; k < 3; ++k)
          distance += std::abs(double{delta[k]} - (there ? t->second.at(vertex)[k] : 0));
        different += distance > 1e-3;
        ++compared;
      }
    }
    EXPECT_LE(different, compared / 40) << match;
    EXPECT_TRUE(dna_of(document));
    EXPECT_EQ(mien_document_project(document.get(), twin, twin, &desc, &farthest, &error),
              MIEN_ERROR_INVALID_ARGUMENT);
  }
}

TEST(MakeLod, GivesEveryMeshOfALodWeightsOfItsJoints) {
  const DnaHandle head = generate_dna(MIEN_PRESET_HEAD, 0);
  const DocumentHandle document = create_document(head.get());
  const auto rows = integers_of(document, "defn.lodMeshMapping.lods");
  const auto row = [&](const char* map, size_t lod) {
    const auto lods = integers_of(document, std::string("defn.") + map + ".lods");
    return integers_of(document,
                       std::string("defn.") + map + ".indices[" + std::to_string(lods[lod]) + "]");
  };
  const auto meshes = row("lodMeshMapping", 3), joints = row("lodJointMapping", 3);
  const auto all_names = strings_of(document, "defn.jointNames");
  std::set<std::string> listed;
  for (int64_t j : joints) listed.insert(all_names[static_cast<size_t>(j)]);
  double farthest = 0;
  MienError error = sized<MienError>();
  ASSERT_EQ(mien_document_make_lod(document.get(), 3, 0, nullptr, &farthest, &error), MIEN_OK)
      << error.message;
  EXPECT_TRUE(dna_of(document));
  for (int64_t mesh : meshes) {
    const auto weights = named_weights_of(document, static_cast<size_t>(mesh));
    ASSERT_FALSE(weights.empty());
    for (const Weights& vertex : weights) {
      double sum = 0;
      for (const auto& [name, weight] : vertex) {
        EXPECT_TRUE(listed.count(name)) << name;
        sum += weight;
      }
      EXPECT_NEAR(sum, 1, 1e-5);
    }
  }
  EXPECT_EQ(mien_document_make_lod(document.get(), 3, 3, nullptr, &farthest, nullptr),
            MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_document_make_lod(document.get(), 30, 0, nullptr, &farthest, nullptr),
            MIEN_ERROR_LOD);
}

/// Neutral places in the model where no joint is turned: sums.
std::vector<double> world_x(const DocumentHandle& d) {
  const auto xs = floats_of(d, "defn.neutralJointTranslations.xs");
  const auto parents = integers_of(d, "defn.jointHierarchy");
  std::vector<double> world(xs.size());
  for (size_t j = 0; j < xs.size(); ++j) {
    size_t up = j;
    world[j] = xs[j];
    while (parents[up] != static_cast<int64_t>(up))
      world[j] += xs[up = static_cast<size_t>(parents[up])];
  }
  return world;
}

// Scaling and moving the mesh is followed exactly by everything.
TEST(Conform, FollowsAScaledAndMovedMesh) {
  const DnaHandle head = generate_dna(MIEN_PRESET_HEAD, 0);
  const DocumentHandle document = create_document(head.get());
  const Bytes before = bytes_of(document);
  for (const char* axis : {"xs", "ys", "zs"}) {
    for (float angle : floats_of(document, std::string("defn.neutralJointRotations.") + axis))
      ASSERT_EQ(angle, 0);
  }
  auto positions = positions_at(document.get(), 0);
  const auto old_positions = positions;
  for (size_t i = 0; i < positions.size(); ++i)
    positions[i] = positions[i] * 1.25f + (i % 3 == 0 ? 3.0f : 0.0f);
  const auto old_world = world_x(document);
  const auto old_targets = targets_of(document, 0);
  const auto old_values = floats_of(document, "bhvr.joints.jointGroups[0].values");
  const auto others = positions_at(document.get(), 1);
  MienConformed conformed = sized<MienConformed>();
  MienError error = sized<MienError>();
  ASSERT_EQ(mien_document_conform(document.get(), 0, positions.data(), positions.size() / 3, 1,
                                  &conformed, &error),
            MIEN_OK)
      << error.message;
  EXPECT_EQ(positions_at(document.get(), 0), positions);
  const auto new_world = world_x(document);
  double farthest = 0;
  for (size_t j = 0; j < old_world.size(); ++j) {
    EXPECT_NEAR(new_world[j], old_world[j] * 1.25 + 3, 2e-3) << j;
    farthest = std::max(farthest, std::abs(new_world[j] - old_world[j]));
  }
  EXPECT_GE(conformed.joint_distance, farthest - 1e-3);
  const auto moved = positions_at(document.get(), 1);
  for (size_t i = 0; i < moved.size(); ++i)
    EXPECT_NEAR(moved[i], others[i] * 1.25 + (i % 3 == 0 ? 3 : 0), 2e-3);
  for (const auto& [channel, target] : targets_of(document, 0)) {
    for (const auto& [vertex, delta] : target) {
      for (size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(delta[k], old_targets.at(channel).at(vertex)[k] * 1.25, 1e-4);
    }
  }
  const auto outputs = integers_of(document, "bhvr.joints.jointGroups[0].outputIndices");
  const auto values = floats_of(document, "bhvr.joints.jointGroups[0].values");
  const size_t columns = values.size() / outputs.size();
  for (size_t i = 0; i < values.size(); ++i) {
    const bool translation = outputs[i / columns] % 9 < 3;
    EXPECT_NEAR(values[i], old_values[i] * (translation ? 1.25 : 1), 1e-4);
  }
  EXPECT_TRUE(dna_of(document));
  ASSERT_EQ(mien_document_undo(document.get(), 0, nullptr), MIEN_OK);
  EXPECT_EQ(bytes_of(document), before);
}

// A bump moves what is near and nothing that is far.
TEST(Conform, MovesJointsNearAChangeOnly) {
  const DnaHandle head = generate_dna(MIEN_PRESET_HEAD, 0);
  const DocumentHandle document = create_document(head.get());
  auto positions = positions_at(document.get(), 0);
  size_t top = 1;
  for (size_t i = 1; i < positions.size(); i += 3) top = positions[i] > positions[top] ? i : top;
  const float height = positions[top];
  const auto before = world_x(document);
  for (size_t i = 0; i < positions.size(); i += 3) {
    if (positions[i + 1] > height - 1) positions[i] += 0.5f;
  }
  MienConformed conformed = sized<MienConformed>();
  ASSERT_EQ(mien_document_conform(document.get(), 0, positions.data(), positions.size() / 3, 0,
                                  &conformed, nullptr),
            MIEN_OK);
  const auto after = world_x(document);
  size_t still = 0;
  for (size_t j = 0; j < before.size(); ++j) still += std::abs(before[j] - after[j]) < 1e-4;
  EXPECT_GT(still, before.size() / 2);
  EXPECT_LT(conformed.joint_distance, 0.6);
  positions[0] = INFINITY;
  EXPECT_EQ(mien_document_conform(document.get(), 0, positions.data(), positions.size() / 3, 0,
                                  &conformed, nullptr),
            MIEN_ERROR_INVALID_ARGUMENT);
}

TEST(Transplant, OfItsOwnRigChangesNothing) {
  const DnaHandle head = generate_dna(MIEN_PRESET_HEAD, 0);
  const DocumentHandle document = create_document(head.get()), rig = create_document(head.get());
  const Bytes before = bytes_of(document);
  MienTransplantDesc desc = sized<MienTransplantDesc>();
  desc.influences = 12;
  std::vector<MienControlError> errors(100);
  size_t count = 0;
  MienError error = sized<MienError>();
  ASSERT_EQ(mien_document_transplant(document.get(), rig.get(), &desc, errors.data(), errors.size(),
                                     &count, &error),
            MIEN_OK)
      << error.message;
  EXPECT_EQ(count, field_of(rig, "defn.rawControlNames").count);
  EXPECT_EQ(bytes_of(document), before);
  for (size_t i = 0; i < count; ++i) EXPECT_EQ(errors[i].worst, 0) << i;
}

TEST(Transplant, GivesAnotherHeadTheControlsOfTheTemplate) {
  const DnaHandle head = generate_dna(MIEN_PRESET_HEAD, 0),
                  other = generate_dna(MIEN_PRESET_HEAD, 5);
  const DocumentHandle document = create_document(other.get()), rig = create_document(head.get());
  const auto positions = positions_at(document.get(), 0);
  // A character without controls.
  ASSERT_EQ(mien_document_clear(document.get(), MIEN_KIND_JOINT, nullptr), MIEN_OK);
  ASSERT_EQ(mien_document_clear(document.get(), MIEN_KIND_BLEND_SHAPE_CHANNEL, nullptr), MIEN_OK);
  MienTransplantDesc desc = sized<MienTransplantDesc>();
  desc.match = MIEN_MATCH_UV;
  size_t count = 0;
  std::vector<MienControlError> errors(100);
  MienError error = sized<MienError>();
  ASSERT_EQ(mien_document_transplant(document.get(), rig.get(), &desc, errors.data(), errors.size(),
                                     &count, &error),
            MIEN_OK)
      << error.message;
  EXPECT_EQ(positions_at(document.get(), 0), positions);
  EXPECT_GT(field_of(document, "defn.blendShapeChannelNames").count, 0u);
  ASSERT_TRUE(dna_of(document));
  size_t moving = 0;
  for (size_t i = 0; i < count; ++i) {
    EXPECT_NEAR(errors[i].moved, 0, 1e-5) << "it had no controls";
    moving += errors[i].worst > 0.05;  // so what it does now is all difference
  }
  EXPECT_GT(moving, count / 2);
  // Nothing to compare with.
  const DocumentHandle tiny = document_of(golden::read_rig("tiny"));
  for (uint32_t mesh = 0; mesh < field_of(tiny, "defn.meshNames").count; ++mesh) {
    const std::string name = "other" + std::to_string(mesh);
    ASSERT_EQ(mien_document_rename(tiny.get(), MIEN_KIND_MESH, mesh, name.c_str(), nullptr),
              MIEN_OK);
  }
  EXPECT_NE(mien_document_transplant(document.get(), tiny.get(), &desc, nullptr, 0, &count, &error),
            MIEN_OK);
}

}  // namespace
}  // namespace mien
