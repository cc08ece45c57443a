// SPDX-License-Identifier: MIT
#include "integrations/program/reduce/reduce.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace mien::cli {
namespace {

using DocumentOwner = std::unique_ptr<MienDocument, Destroy<MienDocument, mien_document_destroy>>;

Dna tiny() {
  auto desc = sized<MienGenerateDesc>();
  desc.preset = MIEN_PRESET_TINY;
  MienDna* made = nullptr;
  EXPECT_EQ(mien_dna_generate(&desc, &made, nullptr), MIEN_OK);
  return Dna(made);
}

DocumentOwner document_of(const Dna& dna) {
  MienDocument* made = nullptr;
  EXPECT_EQ(mien_document_create(dna.get(), nullptr, &made, nullptr), MIEN_OK);
  return DocumentOwner(made);
}

Dna dna_of(const DocumentOwner& document) {
  MienDna* made = nullptr;
  EXPECT_EQ(mien_document_to_dna(document.get(), nullptr, &made, nullptr), MIEN_OK);
  return Dna(made);
}

Character character_of(const Dna& dna, uint32_t storage = MIEN_STORAGE_32_BIT,
                       uint32_t deformer_storage = MIEN_STORAGE_32_BIT) {
  auto desc = sized<MienRigDesc>();
  desc.storage = storage;
  return Character(dna.get(), desc, deformer_storage, 0, "tiny");
}

/// Position 5 of mesh 0 stands 0.25 farther along x.
Dna with_one_position_moved(const Dna& dna) {
  const Character character = character_of(dna);
  const MienMesh mesh = character.mesh(0);
  std::vector<float> positions(mesh.positions.data, mesh.positions.data + mesh.positions.count);
  positions[3 * 5] += 0.25f;
  const DocumentOwner document = document_of(dna);
  EXPECT_EQ(mien_document_set_positions(document.get(), 0, positions.data(), mesh.position_count,
                                        nullptr),
            MIEN_OK);
  return dna_of(document);
}

TEST(Proof, OfTheSameRigFindsNoDistance) {
  const Dna dna = tiny();
  Character one = character_of(dna), other = character_of(dna);
  const Proof proof = prove(one, other, {1}, 1);
  EXPECT_EQ(proof.share, 0);
  EXPECT_EQ(proof.lods.size(), 3u);
  EXPECT_EQ(proof.pose_count, rig_count(one.rig.get(), MIEN_KIND_RAW_CONTROL) +
                                  rig_count(one.rig.get(), MIEN_KIND_PSD_CONTROL) + 1000);
}

TEST(Proof, FindsTheOnePositionThatDiffers) {
  const Dna dna = tiny();
  Character one = character_of(dna), other = character_of(with_one_position_moved(dna));
  const Proof proof = prove(one, other, {1, 0.5}, INFINITY);
  EXPECT_EQ(proof.lods[0].mesh, 0u);
  EXPECT_EQ(proof.lods[0].position, 5u);
  EXPECT_NEAR(proof.lods[0].worst, 0.25, 0.1);
  EXPECT_GE(proof.lods[0].worst, 0.2499);
  EXPECT_GT(proof.lods[0].rms, 0);
  EXPECT_LT(proof.lods[0].rms, proof.lods[0].worst / 2);
  EXPECT_NEAR(proof.map.largest[0][5], proof.lods[0].worst, 1e-5);
  EXPECT_NEAR(proof.map.in_worst_pose[0][5], proof.lods[0].worst, 1e-5);
  EXPECT_LT(proof.map.largest[0][6], 1e-5f);
  double share = 0;
  for (uint32_t lod = 0; lod < 3; ++lod) {
    share = std::max(share, proof.lods[lod].worst / (lod == 0 ? 1 : 0.5));
  }
  EXPECT_DOUBLE_EQ(proof.share, share);
  EXPECT_GT(prove(one, other, {1}, 0.1).share, 0.1);
}

TEST(Proof, FindsThatAnInfiniteEntryIsTooFar) {
  const Dna dna = tiny();
  const DocumentOwner document = document_of(dna);
  const float infinite = INFINITY;
  ASSERT_EQ(mien_document_write_floats(document.get(), "bhvr.joints.jointGroups[0].values", 0, 1,
                                       &infinite, nullptr),
            MIEN_OK);
  Character one = character_of(dna), other = character_of(dna_of(document));
  EXPECT_GT(prove(one, other, {1e30}, 1).share, 1);
}

TEST(Pruning, ChangesNothingAtALimitOf0) {
  const Dna dna = tiny();
  Character original = character_of(dna);
  Pruning pruning(dna.get(), original, {0.01});
  const Dna pruned = pruning.prune({});
  Character result = character_of(pruned);
  EXPECT_LE(prove(original, result, {1}, 1).share, 1e-5);
  const uint64_t entries = pruning.matrix_entries, deltas = pruning.deltas;
  pruning.prune({1000, 1});
  EXPECT_LT(pruning.matrix_entries, entries);
  EXPECT_LT(pruning.deltas, deltas);
  pruning.prune({});
  EXPECT_EQ(pruning.matrix_entries, entries);
  EXPECT_EQ(pruning.deltas, deltas);
}

/// Other meshes may hang on them.
TEST(Pruning, KeepsJointsThatMoveNoPosition) {
  Dna dna = tiny();
  const DocumentOwner document = document_of(dna);
  const uint32_t mesh_count = rig_count(character_of(dna).rig.get(), MIEN_KIND_MESH);
  for (uint32_t m = 0; m < mesh_count; ++m) {
    const size_t positions = character_of(dna).mesh(m).position_count;
    const std::vector<uint16_t> joints(positions, 0);
    const std::vector<float> weights(positions, 1.0f);
    ASSERT_EQ(mien_document_set_weights(document.get(), m, 1, joints.data(), weights.data(),
                                        positions, nullptr),
              MIEN_OK);
  }
  dna = dna_of(document);
  Character original = character_of(dna);
  Pruning pruning(dna.get(), original, {0.01});
  pruning.prune({});
  const uint64_t entries = pruning.matrix_entries;
  const Dna pruned = pruning.prune({1e30, 0});
  EXPECT_GT(entries, 0u);
  EXPECT_EQ(pruning.matrix_entries, entries);
}

TEST(Reduction, StaysWithinTheToleranceOfEachLod) {
  const Dna dna = tiny();
  ReduceOptions options = {{0.05, 0.01}, sized<MienRigDesc>(), "tiny", {}};
  const Reduced reduced = reduce_rig(dna.get(), options);
  EXPECT_EQ(reduced.storage, uint32_t{MIEN_STORAGE_16_BIT});
  EXPECT_EQ(reduced.deformer_storage, uint32_t{MIEN_STORAGE_16_BIT});
  EXPECT_LT(reduced.after.rig_bytes, reduced.before.rig_bytes);
  EXPECT_LT(reduced.after.deformer_bytes, reduced.before.deformer_bytes);
  EXPECT_LT(reduced.after.deltas, reduced.before.deltas);
  // Measured anew, not by what it says.
  Character original = character_of(dna),
            result = character_of(reduced.dna, reduced.storage, reduced.deformer_storage);
  const Proof proof = prove(original, result, {1}, INFINITY);
  EXPECT_LE(proof.lods[0].worst, 0.05);
  EXPECT_LE(proof.lods[1].worst, 0.01);
  EXPECT_LE(proof.lods[2].worst, 0.01);
  EXPECT_GT(proof.lods[0].worst, 0);
  EXPECT_EQ(proof.lods[0].worst, reduced.proof.lods[0].worst);
  EXPECT_EQ(result.rig_bytes(), reduced.after.rig_bytes);
  EXPECT_EQ(result.deformer_bytes(), reduced.after.deformer_bytes);
}

TEST(Reduction, RegionsHaveTolerancesOfTheirOwn) {
  const Dna dna = tiny();
  Tolerances tolerances({0.05});
  Character original = character_of(dna);
  const std::string mesh = rig_name(original.rig.get(), MIEN_KIND_MESH, 0);
  // A joint that moves some positions of mesh 0 most.
  MienIndex16View joints{};
  MienFloatView weights{};
  original.influences(0, 0, joints, weights);
  const size_t most = static_cast<size_t>(
      std::max_element(weights.data, weights.data + weights.count) - weights.data);
  const std::string joint = rig_name(original.rig.get(), MIEN_KIND_JOINT, joints.data[most]);
  tolerances.regions = {{joint, 1e-4}, {mesh, 0.03}};
  find_regions(original, tolerances);
  EXPECT_EQ(tolerances.region_at(0, 0), 1u);
  EXPECT_EQ(tolerances.of_position(1, 0, 0), 1e-4);
  EXPECT_EQ(tolerances.least(), 1e-4);

  const Reduced reduced = reduce_rig(dna.get(), {tolerances, sized<MienRigDesc>(), "tiny", {}});
  ASSERT_EQ(reduced.proof.regions.size(), 3u);
  EXPECT_LE(reduced.proof.regions[0].worst, 0.05);
  EXPECT_LE(reduced.proof.regions[1].worst, 1e-4);
  EXPECT_LE(reduced.proof.regions[2].worst, 0.03);
  EXPECT_LE(reduced.proof.share, 1);
  EXPECT_FALSE(reduced.proof.regions[1].shown_pose.empty());
}

TEST(Proof, PerformancesAreMorePoses) {
  const Dna dna = tiny();
  Character one = character_of(dna), other = character_of(with_one_position_moved(dna));
  const size_t count = rig_count(one.rig.get(), MIEN_KIND_RAW_CONTROL);
  const std::vector<ProofTake> takes = {{"first", {}},
                                        {"second", {std::vector<float>(count, 0.25f)}}};
  const ProofPoses poses(one.rig.get(), takes);
  const Proof proof = prove(one, other, {1}, INFINITY, takes);
  EXPECT_EQ(proof.pose_count, prove(one, other, {1}, INFINITY).pose_count + 1);
  EXPECT_EQ(poses.describe(poses.count() - 1), "frame 0 of second");
  poses.set(poses.count() - 1, one.raw());
  for (size_t i = 0; i < count; ++i) EXPECT_EQ(one.raw().data[i], 0.25f);
}

TEST(Reduction, KeepsFloatsWhere16BitsAreTooCoarse) {
  const Dna dna = tiny();
  const Reduced reduced = reduce_rig(dna.get(), {{1e-5}, sized<MienRigDesc>(), "tiny", {}});
  EXPECT_EQ(reduced.storage, uint32_t{MIEN_STORAGE_32_BIT});
  EXPECT_EQ(reduced.deformer_storage, uint32_t{MIEN_STORAGE_32_BIT});
  EXPECT_LE(reduced.proof.share, 1);
}

}  // namespace
}  // namespace mien::cli
