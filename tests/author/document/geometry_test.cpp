// SPDX-License-Identifier: MIT
// Positions, targets, weights and placement of documents, against plain arithmetic in the test.
#include "author/document/geometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "author/base/random.h"
#include "author/document/skin.h"
#include "tests/support/bytes.h"
#include "tests/support/dna_bytes.h"
#include "tests/support/documents.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

std::vector<float> vectors_of(const DocumentHandle& document, const std::string& path) {
  const auto x = floats_of(document, path + ".xs"), y = floats_of(document, path + ".ys"),
             z = floats_of(document, path + ".zs");
  std::vector<float> all;
  for (size_t i = 0; i < x.size(); ++i) all.insert(all.end(), {x[i], y[i], z[i]});
  return all;
}

void expect_undone(const DocumentHandle& document, const Bytes& bytes) {
  ASSERT_EQ(mien_document_undo(document.get(), 0, nullptr), MIEN_OK);
  EXPECT_EQ(bytes_of(document), bytes);
}

TEST(SetPositions, ReplacesThoseOfOneMesh) {
  const Bytes bytes = golden::read_rig("small");
  const DocumentHandle document = document_of(bytes);
  auto positions = vectors_of(document, "geom.meshes[0].positions");
  for (float& x : positions) x = x * 2 + 1;
  ASSERT_EQ(mien_document_set_positions(document.get(), 0, positions.data(), positions.size() / 3,
                                        nullptr),
            MIEN_OK);
  EXPECT_EQ(vectors_of(document, "geom.meshes[0].positions"), positions);
  const Bytes after = bytes_of(document);
  ASSERT_EQ(after.size(), bytes.size());
  size_t differing = 0;
  for (size_t i = 0; i < bytes.size(); ++i) differing += bytes[i] != after[i];
  EXPECT_LE(differing, positions.size() * 4);
  expect_undone(document, bytes);
  MienError error = sized<MienError>();
  EXPECT_EQ(mien_document_set_positions(document.get(), 0, positions.data(), 3, &error),
            MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_document_set_positions(document.get(), 99, positions.data(), 3, &error),
            MIEN_ERROR_INDEX);
  positions[4] = NAN;
  EXPECT_EQ(mien_document_set_positions(document.get(), 0, positions.data(), positions.size() / 3,
                                        &error),
            MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(bytes_of(document), bytes);
}

TEST(SetTarget, ReplacesAddsAndRemoves) {
  const Bytes bytes = tiny_bytes();
  const DocumentHandle document = document_of(bytes);
  const std::string targets = "geom.meshes[0].blendShapeTargets";
  const float deltas[] = {1, 2, 3, 0, 0, 0, 4, 5, 6};
  const uint32_t vertices[] = {5, 2, 1};
  // Channel 1 has none yet.
  ASSERT_EQ(mien_document_set_target(document.get(), 0, 1, vertices, deltas, 3, nullptr), MIEN_OK);
  ASSERT_EQ(field_of(document, targets).count, 2u);
  EXPECT_EQ(integers_of(document, targets + "[1].vertexIndices"), (std::vector<int64_t>{5, 1}));
  EXPECT_EQ(vectors_of(document, targets + "[1].deltas"), (std::vector<float>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(integers_of(document, targets + "[1].blendShapeChannelIndex")[0], 1);
  const auto to = integers_of(document, "defn.meshBlendShapeChannelMapping.to");
  EXPECT_EQ(std::count(to.begin(), to.end(), 1), 1);
  EXPECT_TRUE(dna_of(document));
  // Replaced where it is.
  ASSERT_EQ(mien_document_set_target(document.get(), 0, 0, nullptr, deltas, 1, nullptr), MIEN_OK);
  EXPECT_EQ(integers_of(document, targets + "[0].blendShapeChannelIndex")[0], 0);
  EXPECT_EQ(vectors_of(document, targets + "[0].deltas"), (std::vector<float>{1, 2, 3}));
  // And gone, with its pair.
  ASSERT_EQ(mien_document_set_target(document.get(), 0, 1, nullptr, deltas, 0, nullptr), MIEN_OK);
  ASSERT_EQ(field_of(document, targets).count, 1u);
  EXPECT_EQ(integers_of(document, "defn.meshBlendShapeChannelMapping.to"),
            (std::vector<int64_t>{0}));
  EXPECT_TRUE(dna_of(document));
  expect_undone(document, bytes);
  EXPECT_EQ(mien_document_set_target(document.get(), 0, 2, nullptr, deltas, 1, nullptr),
            MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_document_set_target(document.get(), 1, 0, nullptr, deltas, 1, nullptr),
            MIEN_ERROR_INDEX);
  const uint32_t far[] = {6};
  EXPECT_EQ(mien_document_set_target(document.get(), 0, 0, far, deltas, 1, nullptr),
            MIEN_ERROR_INDEX);
}

TEST(PruneTargets, RemovesWhatIsNotLongerThanTheTolerance) {
  for (const char* rig : {"tiny", "small"}) {
    const Bytes bytes = golden::read_rig(rig);
    const DocumentHandle before = document_of(bytes), after = document_of(bytes);
    // The tolerance is the median length.
    std::vector<double> lengths;
    const auto for_each_target = [](const DocumentHandle& d, const auto& f) {
      for (size_t m = 0; m < field_of(d, "geom.meshes").count; ++m) {
        const std::string list = "geom.meshes[" + std::to_string(m) + "].blendShapeTargets";
        for (size_t t = 0; t < field_of(d, list).count; ++t)
          f(m, list + "[" + std::to_string(t) + "]");
      }
    };
    const auto length_of = [](const std::vector<float>& v, size_t i) {
      return std::sqrt(double(v[3 * i]) * v[3 * i] + double(v[3 * i + 1]) * v[3 * i + 1] +
                       double(v[3 * i + 2]) * v[3 * i + 2]);
    };
    for_each_target(before, [&](size_t, const std::string& target) {
      const auto deltas = vectors_of(before, target + ".deltas");
      for (size_t i = 0; i < deltas.size() / 3; ++i) lengths.push_back(length_of(deltas, i));
    });
    ASSERT_FALSE(lengths.empty());
    std::sort(lengths.begin(), lengths.end());
    const float tolerance = static_cast<float>(lengths[lengths.size() / 2] * 1.0001);
    using Target = std::map<int64_t, std::vector<float>>;  // [vertex]
    const auto collect = [&](const DocumentHandle& d, double least) {
      std::map<std::pair<size_t, int64_t>, Target> found;
      for_each_target(d, [&](size_t m, const std::string& path) {
        const auto deltas = vectors_of(d, path + ".deltas");
        const auto vertices = integers_of(d, path + ".vertexIndices");
        Target target;
        for (size_t i = 0; i < vertices.size(); ++i) {
          if (length_of(deltas, i) > least)
            target[vertices[i]] = {deltas[3 * i], deltas[3 * i + 1], deltas[3 * i + 2]};
        }
        if (!target.empty())
          found[{m, integers_of(d, path + ".blendShapeChannelIndex")[0]}] = target;
      });
      return found;
    };
    MienPrunedTargets pruned = sized<MienPrunedTargets>();
    ASSERT_EQ(mien_document_prune_targets(after.get(), tolerance, &pruned, nullptr), MIEN_OK);
    const auto wanted = collect(before, double{tolerance});
    EXPECT_EQ(collect(after, -1), wanted) << rig;
    EXPECT_EQ(pruned.targets, collect(before, -1).size() - wanted.size());
    EXPECT_EQ(
        pruned.deltas, lengths.size() - [&] {
          size_t left = 0;
          for (const auto& [key, target] : wanted) left += target.size();
          return left;
        }());
    EXPECT_TRUE(dna_of(after));
    expect_undone(after, bytes);
    EXPECT_EQ(mien_document_prune_targets(after.get(), -1, &pruned, nullptr),
              MIEN_ERROR_INVALID_ARGUMENT);
  }
}

// Weights -------------------------------------------------------------------------------------------

using Vertex = std::vector<std::pair<int64_t, double>>;
std::vector<Vertex> weights_of(const DocumentHandle& d, size_t mesh) {
  const std::string list = "geom.meshes[" + std::to_string(mesh) + "].skinWeights";
  std::vector<Vertex> all(field_of(d, list).count);
  for (size_t v = 0; v < all.size(); ++v) {
    const std::string path = list + "[" + std::to_string(v) + "]";
    const auto joints = integers_of(d, path + ".jointIndices");
    const auto weights = floats_of(d, path + ".weights");
    for (size_t i = 0; i < joints.size(); ++i) all[v].emplace_back(joints[i], weights[i]);
  }
  return all;
}
double sum_of(const Vertex& vertex) {
  double sum = 0;
  for (const auto& influence : vertex) sum += influence.second;
  return sum;
}

TEST(SkinWeights, AreSetAndChecked) {
  const Bytes bytes = tiny_bytes();
  const DocumentHandle document = document_of(bytes);
  std::vector<uint16_t> joints;
  std::vector<float> weights;
  for (int v = 0; v < 6; ++v) {
    joints.insert(joints.end(), {0, 2, 1});
    weights.insert(weights.end(), {0.25f, 0, 0.75f});
  }
  ASSERT_EQ(
      mien_document_set_weights(document.get(), 0, 3, joints.data(), weights.data(), 18, nullptr),
      MIEN_OK);
  for (const Vertex& vertex : weights_of(document, 0))
    EXPECT_EQ(vertex, (Vertex{{0, 0.25}, {1, 0.75}}));
  EXPECT_EQ(integers_of(document, "geom.meshes[0].maximumInfluencePerVertex")[0], 2);
  EXPECT_TRUE(dna_of(document));
  expect_undone(document, bytes);
  const auto refused = [&](size_t at, uint16_t joint, float weight, const char* said) {
    auto wrong_joints = joints;
    auto wrong_weights = weights;
    wrong_joints[at] = joint;
    wrong_weights[at] = weight;
    MienError error = sized<MienError>();
    EXPECT_EQ(mien_document_set_weights(document.get(), 0, 3, wrong_joints.data(),
                                        wrong_weights.data(), 18, &error),
              MIEN_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::string(error.message).find(said), std::string::npos) << error.message;
  };
  refused(3, 0, -0.5f, "position 1 has a weight that is negative");
  refused(4, 9, 0.5f, "a joint that does not exist");
  refused(4, 0, 0.5f, "a joint twice");
  EXPECT_EQ(
      mien_document_set_weights(document.get(), 0, 3, joints.data(), weights.data(), 15, nullptr),
      MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(bytes_of(document), bytes);
}

TEST(SkinWeights, AreNormalizedAndLimited) {
  for (const char* rig : {"small", "body"}) {
    const Bytes bytes = golden::read_rig(rig);
    const DocumentHandle document = document_of(bytes);
    const auto before = weights_of(document, 0);
    for (size_t v = 0; v < before.size(); v += 2) {
      const std::string path = "geom.meshes[0].skinWeights[" + std::to_string(v) + "].weights";
      auto weights = floats_of(document, path);
      for (float& weight : weights) weight *= 3;
      ASSERT_EQ(write_floats(document, path, weights), MIEN_OK);
    }
    ASSERT_EQ(mien_document_normalize_weights(document.get(), 0, nullptr), MIEN_OK);
    const auto normalized = weights_of(document, 0);
    for (size_t v = 0; v < before.size(); ++v) {
      ASSERT_EQ(normalized[v].size(), before[v].size());
      for (size_t i = 0; i < before[v].size(); ++i) {
        EXPECT_EQ(normalized[v][i].first, before[v][i].first);
        EXPECT_NEAR(normalized[v][i].second, before[v][i].second / sum_of(before[v]), 2e-6);
      }
    }
    for (uint32_t limit : {2u, 1u}) {
      const auto old = weights_of(document, 0);
      ASSERT_EQ(mien_document_limit_influences(document.get(), 0, limit, nullptr), MIEN_OK);
      const auto limited = weights_of(document, 0);
      for (size_t v = 0; v < old.size(); ++v) {
        Vertex wanted = old[v];
        std::stable_sort(wanted.begin(), wanted.end(),
                         [](auto& a, auto& b) { return a.second > b.second; });
        if (wanted.size() > limit) wanted.resize(limit);
        const double left = sum_of(wanted), all = sum_of(old[v]);
        ASSERT_EQ(limited[v].size(), wanted.size());
        for (const auto& [joint, weight] : limited[v]) {
          const auto found = std::find_if(wanted.begin(), wanted.end(),
                                          [joint = joint](auto& w) { return w.first == joint; });
          ASSERT_NE(found, wanted.end()) << v;
          EXPECT_NEAR(weight, found->second * all / left, 2e-6);
        }
      }
    }
    EXPECT_TRUE(dna_of(document));
    expect_undone(document, bytes);
    EXPECT_EQ(mien_document_limit_influences(document.get(), 0, 0, nullptr),
              MIEN_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(mien_document_normalize_weights(document.get(), 999, nullptr), MIEN_ERROR_INDEX);
  }
}

// The six vertices of the tiny rig: neighbors along the edges of two quads.
TEST(SkinWeights, AreSmoothedByTheMeanOfNeighbors) {
  const Bytes bytes = tiny_bytes();
  const DocumentHandle document = document_of(bytes);
  const std::vector<std::vector<int>> neighbors = {{1, 3}, {0, 2, 4}, {1, 5},
                                                   {0, 4}, {1, 3, 5}, {2, 4}};
  std::vector<std::map<int64_t, double>> now(6), then;
  const auto before = weights_of(document, 0);
  for (size_t v = 0; v < 6; ++v) now[v].insert(before[v].begin(), before[v].end());
  for (int iteration = 0; iteration < 3; ++iteration) {
    then = now;
    for (size_t v = 0; v < 6; ++v) {
      then[v].clear();
      for (const auto& [joint, weight] : now[v]) then[v][joint] += 0.6 * weight;
      for (int n : neighbors[v]) {
        for (const auto& [joint, weight] : now[static_cast<size_t>(n)]) {
          then[v][joint] += 0.4 * weight / static_cast<double>(neighbors[v].size());
        }
      }
    }
    now = then;
  }
  ASSERT_EQ(mien_document_smooth_weights(document.get(), 0, 3, 0.4f, 4, nullptr), MIEN_OK);
  const auto after = weights_of(document, 0);
  for (size_t v = 0; v < 6; ++v) {
    ASSERT_EQ(after[v].size(), now[v].size()) << v;
    for (const auto& [joint, weight] : after[v]) EXPECT_NEAR(weight, now[v][joint], 1e-6) << v;
    EXPECT_NEAR(sum_of(after[v]), 1, 1e-6);
  }
  EXPECT_TRUE(dna_of(document));
  expect_undone(document, bytes);
  EXPECT_EQ(mien_document_smooth_weights(document.get(), 0, 3, 1.5f, 4, nullptr),
            MIEN_ERROR_INVALID_ARGUMENT);
}

// Placement -----------------------------------------------------------------------------------------

/// Positions of all meshes at LOD 0 with these raw controls, by the library's deformer.
std::vector<float> deformed(const DnaHandle& dna, uint64_t seed) {
  const RigHandle rig = create_rig(dna.get());
  Character character(rig);
  Random random(seed, 5);
  for (float& value : character.raw) value = static_cast<float>(random.below(512)) / 1024;
  character.evaluate(0);
  MienDeformer* deformer = nullptr;
  EXPECT_EQ(mien_deformer_create(dna.get(), rig.get(), nullptr, &deformer, nullptr), MIEN_OK);
  MienDeformerInstance* instance = nullptr;
  EXPECT_EQ(mien_deformer_instance_create(deformer, nullptr, &instance, nullptr), MIEN_OK);
  EXPECT_EQ(mien_deformer_instance_update(instance, character.instance.get()), MIEN_OK);
  std::vector<float> all;
  for (uint32_t mesh = 0; mesh < count_of(rig, MIEN_KIND_MESH); ++mesh) {
    MienFloatView view = {};
    if (mien_deformer_instance_deform(instance, mesh, MIEN_NORMALS_SKINNED, nullptr) != MIEN_OK)
      continue;
    EXPECT_EQ(mien_deformer_instance_positions(instance, mesh, &view), MIEN_OK);
    all.insert(all.end(), view.data, view.data + view.count);
  }
  mien_deformer_instance_destroy(instance);
  mien_deformer_destroy(deformer);
  return all;
}

TEST(Place, MovesEveryDeformedPositionAlike) {
  for (const char* rig : {"tiny", "small"}) {
    const Bytes bytes = golden::read_rig(rig);
    const DocumentHandle document = document_of(bytes);
    // Only controls that do not move the root.
    const uint32_t root = 0;
    ASSERT_EQ(mien_document_clear_joints(document.get(), &root, 1, nullptr), MIEN_OK);
    if (field_of(document, "mlbe.mlbJoints.outputIndices").count != 0) {
      ASSERT_EQ(mien_document_clear(document.get(), MIEN_KIND_JOINT, nullptr), MIEN_OK);
    }
    uint64_t mark = 0;
    ASSERT_EQ(mien_document_mark(document.get(), &mark, nullptr), MIEN_OK);
    const Bytes cleared = bytes_of(document);
    MienPlacement placement = sized<MienPlacement>();
    placement.scale = 2.5;
    placement.rotation[0] = 30;
    placement.rotation[1] = -50;
    placement.rotation[2] = 110;
    placement.translation[1] = 7;
    MienError error = sized<MienError>();
    ASSERT_EQ(mien_document_place(document.get(), &placement, &error), MIEN_OK)
        << rig << error.message;
    const auto before = deformed(open_dna(cleared), 1), after = deformed(dna_of(document), 1);
    ASSERT_EQ(before.size(), after.size());
    ASSERT_FALSE(before.empty());
    double angle[3], largest = 0;
    for (int k = 0; k < 3; ++k) angle[k] = placement.rotation[k] * 3.14159265358979323846 / 180;
    for (float x : before) largest = std::max(largest, std::abs(double{x}));
    for (size_t i = 0; i < before.size(); i += 3) {
      double p[3] = {before[i] * 2.5, before[i + 1] * 2.5, before[i + 2] * 2.5};
      for (int k = 0; k < 3; ++k) {  // about x, then y, then z
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        const double s = std::sin(angle[k]), c = std::cos(angle[k]);
        const double pa = p[a], pb = p[b];
        p[a] = c * pa - s * pb;
        p[b] = s * pa + c * pb;
      }
      p[1] += 7;
      for (size_t k = 0; k < 3; ++k)
        ASSERT_NEAR(after[i + k], p[k], largest * 5e-6 + 1e-4) << rig << i;
    }
    ASSERT_EQ(mien_document_undo(document.get(), mark, nullptr), MIEN_OK);
    EXPECT_EQ(bytes_of(document), cleared);
    placement.scale = -1;
    EXPECT_EQ(mien_document_place(document.get(), &placement, &error), MIEN_ERROR_INVALID_ARGUMENT);
    placement.scale = INFINITY;
    EXPECT_EQ(mien_document_place(document.get(), &placement, &error), MIEN_ERROR_INVALID_ARGUMENT);
  }
}

TEST(Place, TranslatesWithoutTouchingOtherNumbers) {
  const Bytes bytes = golden::read_rig("small");
  const DocumentHandle document = document_of(bytes);
  MienPlacement placement = sized<MienPlacement>();
  placement.translation[0] = 1.5;
  ASSERT_EQ(mien_document_place(document.get(), &placement, nullptr), MIEN_OK);
  const DocumentHandle before = document_of(bytes);
  const auto parents = integers_of(before, "defn.jointHierarchy");
  auto xs = floats_of(before, "defn.neutralJointTranslations.xs");
  for (size_t j = 0; j < xs.size(); ++j) {
    if (parents[j] == static_cast<int64_t>(j)) xs[j] += 1.5f;
  }
  EXPECT_EQ(floats_of(document, "defn.neutralJointTranslations.xs"), xs);
  auto positions = floats_of(before, "geom.meshes[0].positions.xs");
  for (float& x : positions) x = static_cast<float>(double{x} + 1.5);
  EXPECT_EQ(floats_of(document, "geom.meshes[0].positions.xs"), positions);
  for (const char* same : {"geom.meshes[0].normals.xs", "geom.meshes[0].positions.ys",
                           "defn.neutralJointRotations.xs", "bhvr.joints.jointGroups[0].values"}) {
    EXPECT_EQ(floats_of(document, same), floats_of(before, same)) << same;
  }
}

TEST(SetNeutral, WritesTranslationsAndRotations) {
  const Bytes bytes = tiny_bytes();
  const DocumentHandle document = document_of(bytes);
  const float places[] = {1, 2, 3, 4, 5, 6}, turns[] = {7, 8, 9, 10, 11, 12};
  ASSERT_EQ(mien_document_set_neutral(document.get(), 1, places, turns, 2, nullptr), MIEN_OK);
  const auto translations = vectors_of(document, "defn.neutralJointTranslations");
  const auto rotations = vectors_of(document, "defn.neutralJointRotations");
  EXPECT_TRUE(std::equal(places, places + 6, translations.begin() + 3));
  EXPECT_TRUE(std::equal(turns, turns + 6, rotations.begin() + 3));
  expect_undone(document, bytes);
  EXPECT_EQ(mien_document_set_neutral(document.get(), 2, places, nullptr, 2, nullptr),
            MIEN_ERROR_INDEX);
}

}  // namespace
}  // namespace mien
