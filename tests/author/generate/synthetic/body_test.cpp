// SPDX-License-Identifier: MIT
// The generated body, and learned behavior of any generated rig: what is in them, and that all of
// it moves something.
#include "author/generate/synthetic/body.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "tests/support/bytes.h"
#include "tests/support/rig_handles.h"

namespace mien {
namespace {

Bytes body_file(uint64_t seed, uint32_t flags = 0) {
  return write_dna(generate_dna(MIEN_PRESET_BODY, seed, flags).get());
}

std::string findings_of(const Bytes& bytes) {
  MienReport* report = nullptr;
  EXPECT_EQ(mien_dna_validate_memory(bytes.data(), bytes.size(), nullptr, &report, nullptr),
            MIEN_OK);
  uint32_t errors = 0, warnings = 0;
  EXPECT_EQ(mien_report_counts(report, &errors, &warnings), MIEN_OK);
  std::string text;
  for (uint32_t i = 0; i < errors + warnings; ++i) {
    MienFinding finding = sized<MienFinding>();
    EXPECT_EQ(mien_report_finding(report, i, &finding), MIEN_OK);
    text += std::string(finding.field.data, finding.field.count) + ": " +
            std::string(finding.message.data, finding.message.count) + "\n";
  }
  mien_report_destroy(report);
  return text;
}

TEST(SyntheticBody, HasTheCountsOfAProductionBody) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_BODY, 0);
  MienDnaInfo info = sized<MienDnaInfo>();
  ASSERT_EQ(mien_dna_info(dna.get(), &info), MIEN_OK);
  EXPECT_EQ(info.lod_count, 4u);
  EXPECT_EQ(info.raw_control_count, 176u);
  EXPECT_EQ(info.rbf_control_count, 670u);
  EXPECT_EQ(info.rbf_pose_count, 670u);
  EXPECT_EQ(info.rbf_solver_count, 72u);
  EXPECT_EQ(info.joint_count, 342u);
  EXPECT_EQ(info.joint_group_count, 72u);
  EXPECT_EQ(info.twist_count, 22u);
  EXPECT_EQ(info.swing_count, 16u);
  EXPECT_EQ(info.mesh_count, 4u);
  uint32_t turned = 0;
  for (const dna::JointRepresentation& joint : dna->view.jbmd.joints) turned += joint.rotation;
  EXPECT_GT(turned, 100u);
  EXPECT_LT(turned, 160u);
}

TEST(SyntheticBody, HasSolversOfEveryKind) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_BODY, 0);
  std::set<uint16_t> types, distances, functions, normalizations, radii, axes;
  std::set<uint32_t> inputs;
  for (const dna::RbfSolver& solver : dna->view.rbfb.solvers) {
    types.insert(solver.solver_type);
    distances.insert(solver.distance_method);
    functions.insert(solver.function_type);
    normalizations.insert(solver.normalize_method);
    radii.insert(solver.automatic_radius);
    axes.insert(solver.twist_axis);
    inputs.insert(solver.raw_control_indices.count);
  }
  EXPECT_EQ(types.size(), 2u);
  EXPECT_EQ(distances.size(), 4u);
  EXPECT_EQ(functions.size(), 5u);
  EXPECT_EQ(normalizations.size(), 2u);
  EXPECT_EQ(radii.size(), 2u);
  EXPECT_EQ(axes.size(), 3u);
  EXPECT_EQ(inputs, (std::set<uint32_t>{4, 8}));
  uint32_t dependent = 0;
  for (const dna::RbfPoseControls& pose : dna->view.rbfe.poses) {
    dependent += pose.input_control_indices.count != 0;
  }
  EXPECT_GT(dependent, 10u);
}

TEST(SyntheticBody, PassesAllChecksInSilence) {
  for (uint64_t seed : {0u, 1u, 77u}) {
    for (uint32_t flags : {0u, uint32_t{MIEN_GENERATE_ML}}) {
      EXPECT_EQ(findings_of(body_file(seed, flags)), "");
    }
  }
}

TEST(SyntheticBody, SameSeedSameBytesOtherSeedOthers) {
  EXPECT_EQ(body_file(5), body_file(5));
  EXPECT_NE(body_file(5), body_file(6));
  EXPECT_EQ(body_file(5, MIEN_GENERATE_ML), body_file(5, MIEN_GENERATE_ML));
}

// Closed and turned outwards: what leaves through faces seen from inside comes to nothing, and the
// enclosed volume is positive.
TEST(SyntheticBody, TubesAreClosedAndFaceOutward) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_BODY, 0);
  for (const dna::Mesh& mesh : dna->view.geom.meshes) {
    std::set<std::pair<uint32_t, uint32_t>> edges;
    double volume = 0;
    const auto at = [&](uint32_t v, int k) -> double {
      return k == 0 ? mesh.positions.xs[v] : k == 1 ? mesh.positions.ys[v] : mesh.positions.zs[v];
    };
    for (const dna::Face& face : mesh.faces) {
      const auto& corners = face.layout_indices;
      for (uint32_t i = 0; i < corners.count; ++i) {
        EXPECT_TRUE(edges.insert({corners[i], corners[(i + 1) % corners.count]}).second);
      }
      for (uint32_t i = 1; i + 1 < corners.count; ++i) {
        const uint32_t a = corners[0], b = corners[i], c = corners[i + 1];
        volume += at(a, 0) * (at(b, 1) * at(c, 2) - at(b, 2) * at(c, 1)) +
                  at(a, 1) * (at(b, 2) * at(c, 0) - at(b, 0) * at(c, 2)) +
                  at(a, 2) * (at(b, 0) * at(c, 1) - at(b, 1) * at(c, 0));
      }
    }
    for (const auto& [from, to] : edges) EXPECT_EQ(edges.count({to, from}), 1u);
    EXPECT_GT(volume, 0);
    for (const dna::VertexSkinWeights& vertex : mesh.skin_weights) {
      float sum = 0;
      for (uint32_t i = 0; i < vertex.weights.count; ++i) sum += vertex.weights[i];
      EXPECT_EQ(sum, 1.0f);
    }
  }
}

/// Frames of random rotations or controls: which joint values ever change at a LOD.
std::vector<bool> moved_values(const RigHandle& rig, const MienDna* dna, uint32_t lod,
                               uint32_t frames) {
  Random random = Random::from_seed(9, lod);
  std::vector<bool> moved;
  for (uint32_t frame = 0; frame < frames; ++frame) {
    Character character(rig);
    const bool quaternions = capi::object(dna)->view.rbfb.solvers.count != 0;
    for (size_t i = 0; i < character.raw.count; i += quaternions ? 4 : 1) {
      if (!quaternions) {
        character.raw[i] = static_cast<float>(random.real());
        continue;
      }
      double q[4], length = 0;
      for (int part = 0; part < 4; ++part) {
        q[part] = part == 3 ? 1 : 0.4 * random.normal();
        length += q[part] * q[part];
      }
      for (int part = 0; part < 4; ++part) {
        character.raw[i + part] = static_cast<float>(q[part] / std::sqrt(length));
      }
    }
    character.evaluate(lod);
    moved.resize(character.joints.count);
    for (size_t i = 0; i < moved.size(); ++i) {
      EXPECT_TRUE(std::isfinite(character.joints[i]));
      if (character.joints[i] != 0) moved[i] = true;
    }
  }
  return moved;
}

TEST(SyntheticBody, EverythingMovesAtItsLods) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_BODY, 0);
  const RigHandle rig = create_rig(dna.get());
  for (uint32_t lod = 0; lod < 4; ++lod) {
    SCOPED_TRACE(lod);
    const std::vector<bool> moved = moved_values(rig, dna.get(), lod, 200);
    MienIndex16View variable;
    ASSERT_EQ(mien_rig_variable_joint_values(rig.get(), lod, &variable), MIEN_OK);
    size_t still = 0;
    for (size_t i = 0; i < variable.count; ++i) still += !moved[variable.data[i]];
    // A twist turns about one axis only: the other two angles of each of its joints rest.
    EXPECT_LE(still, 2 * (lod == 3 ? 22 : 66)) << "of " << variable.count;
    EXPECT_GT(variable.count, lod == 3 ? 50u : 300u);
  }
}

class MachineLearned : public testing::TestWithParam<uint32_t> {};

TEST_P(MachineLearned, HasEveryActivationAndOperation) {
  const Bytes bytes = write_dna(generate_dna(GetParam(), 4, MIEN_GENERATE_ML).get());
  EXPECT_EQ(findings_of(bytes), "");
  const DnaHandle dna = open_dna(bytes);
  std::set<uint16_t> functions, operations;
  for (const dna::NeuralNetwork& network : dna->view.mlbh.networks) {
    for (const dna::NetworkLayer& layer : network.layers) functions.insert(layer.function_id);
  }
  for (const auto& set : dna->view.mlbe.types[0].operations) {
    for (const dna::MlOperation& operation : set) operations.insert(operation.type);
  }
  EXPECT_EQ(functions, (std::set<uint16_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(operations, (std::set<uint16_t>{1, 2, 3, 4}));
  EXPECT_EQ(dna->view.mlbe.joints.input_indices.count, dna->view.mlbh.control_names.count);
  const DnaHandle plain = generate_dna(GetParam(), 4);
  EXPECT_EQ(plain->view.mlbh.networks.count, 0u);
  EXPECT_EQ(plain->view.defn.joint_names.count, dna->view.defn.joint_names.count);
}

TEST_P(MachineLearned, JointsFollowAtTheFinerLods) {
  const DnaHandle dna = generate_dna(GetParam(), 4, MIEN_GENERATE_ML);
  const RigHandle rig = create_rig(dna.get());
  const dna::MlJoints& joints = dna->view.mlbe.joints;
  for (uint32_t lod = 0; lod < dna->view.desc.lod_count; ++lod) {
    SCOPED_TRACE(lod);
    Character character(rig);
    for (float& value : character.raw) value = 0.3f;
    character.evaluate(lod);
    // Of a scatter, as many as the limits of the LOD let through; a quaternion at rest has w = 1.
    size_t moved = 0;
    for (uint32_t i = 0; i < character.ml.count; ++i) {
      moved += character.ml[i] != (i % 10 == 6 ? 1.0f : 0.0f);
    }
    const bool active = lod < (dna->view.desc.lod_count + 1u) / 2;
    EXPECT_EQ(moved == 0, !active);
    EXPECT_EQ(moved == joints.input_indices.count, lod == 0);
  }
}

// Masks of all regions at 0: only the biases of the decoders speak.
TEST_P(MachineLearned, MasksSwitchEncoders) {
  const DnaHandle dna = generate_dna(GetParam(), 4, MIEN_GENERATE_ML);
  const RigHandle rig = create_rig(dna.get());
  Character on(rig), off(rig), rest(rig);
  for (float& value : on.raw) value = 0.3f;
  for (float& value : off.raw) value = 0.3f;
  EXPECT_GE(off.masks.count, 3u);
  for (Character* character : {&off, &rest}) {
    for (float& mask : character->masks) mask = 0;
  }
  for (Character* character : {&on, &off, &rest}) character->evaluate(0);
  EXPECT_FALSE(same_bits(on.ml, off.ml));
  EXPECT_TRUE(same_bits(off.ml, rest.ml));
}

std::string preset_name(const testing::TestParamInfo<uint32_t>& info) {
  constexpr const char* kNames[] = {"Tiny", "Small", "Medium", "Large", "Body"};
  return kNames[info.param];
}
INSTANTIATE_TEST_SUITE_P(Presets, MachineLearned, testing::Range(0u, 5u), preset_name);

}  // namespace
}  // namespace mien
