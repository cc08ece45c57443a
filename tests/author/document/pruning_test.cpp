// SPDX-License-Identifier: MIT
// LODs, coordinate systems and the pruning of joint matrices.
#include <gtest/gtest.h>

#include <cmath>

#include "author/document/control_poses.h"
#include "author/document/prune_joints.h"
#include "tests/support/bytes.h"
#include "tests/support/dna_bytes.h"
#include "tests/support/documents.h"

namespace mien {
namespace {

TEST(KeepLods, GivesTheFileThatOpeningWithLodsGives) {
  for (const char* rig : {"tiny", "small", "body", "ml", "ml_ext"}) {
    const Bytes bytes = golden::read_rig(rig);
    for (uint64_t lods : {uint64_t{1}, uint64_t{2}, uint64_t{3}}) {
      const DocumentHandle document = document_of(bytes);
      MienError error = sized<MienError>();
      if (mien_document_keep_lods(document.get(), lods, &error) == MIEN_ERROR_LOD) {
        EXPECT_EQ(bytes_of(document), bytes);
        continue;
      }
      EXPECT_EQ(bytes_of(document), write_dna(open_dna(bytes, lods).get())) << rig << lods;
      ASSERT_EQ(mien_document_undo(document.get(), 0, nullptr), MIEN_OK);
      EXPECT_EQ(bytes_of(document), bytes);
    }
  }
}

TEST(Convert, GivesTheFileThatOpeningInTheSystemGives) {
  for (const char* name : {"unreal", "blender"}) {
    const Bytes bytes = golden::read_rig("small");
    MienCoordinateSystem system = sized<MienCoordinateSystem>();
    ASSERT_EQ(mien_coordinate_system_find(name, &system), MIEN_OK);
    const DocumentHandle document = document_of(bytes);
    ASSERT_EQ(mien_document_convert(document.get(), &system, nullptr), MIEN_OK);
    EXPECT_EQ(bytes_of(document), write_dna(open_in_system(bytes, system).get())) << name;
    ASSERT_EQ(mien_document_undo(document.get(), 0, nullptr), MIEN_OK);
    EXPECT_EQ(bytes_of(document), bytes);
  }
}

/// Positions of LOD 0's meshes by the library, with these raw controls.
class Deformed {
 public:
  explicit Deformed(const DnaHandle& dna) : rig_(create_rig(dna.get())), character_(rig_) {
    EXPECT_EQ(mien_deformer_create(dna.get(), rig_.get(), nullptr, &deformer_, nullptr), MIEN_OK);
    EXPECT_EQ(mien_deformer_instance_create(deformer_, nullptr, &instance_, nullptr), MIEN_OK);
  }
  ~Deformed() {
    mien_deformer_instance_destroy(instance_);
    mien_deformer_destroy(deformer_);
  }
  std::vector<float> positions(uint32_t mesh, const std::vector<uint32_t>& controls) {
    std::fill(character_.raw.begin(), character_.raw.end(), 0.0f);
    for (uint32_t control : controls) character_.raw[control] = 1;
    EXPECT_EQ(mien_instance_reset(character_.instance.get()), MIEN_OK);
    for (uint32_t control : controls) character_.raw[control] = 1;
    character_.evaluate(0);
    EXPECT_EQ(mien_deformer_instance_update(instance_, character_.instance.get()), MIEN_OK);
    EXPECT_EQ(mien_deformer_instance_deform(instance_, mesh, MIEN_NORMALS_SKINNED, nullptr),
              MIEN_OK);
    MienFloatView view = {};
    EXPECT_EQ(mien_deformer_instance_positions(instance_, mesh, &view), MIEN_OK);
    return {view.data, view.data + view.count};
  }
  size_t raw_count() const { return character_.raw.count; }

 private:
  RigHandle rig_;
  Character character_;
  MienDeformer* deformer_ = nullptr;
  MienDeformerInstance* instance_ = nullptr;
};

/// A rig of which only correctives and joint groups move joints.
Bytes plain_bytes(const std::string& rig) {
  const DocumentHandle document = document_of(golden::read_rig(rig));
  for (const char* list : {"twsw.twists", "twsw.swings", "mlbe.mlbJoints.inputIndices",
                           "mlbe.mlbJoints.outputIndices", "rbfb.solvers"}) {
    EXPECT_EQ(resize(document, list, 0), MIEN_OK);
  }
  for (size_t i = 0; i < field_of(document, "rbfb.lodSolverMapping.indices").count; ++i) {
    EXPECT_EQ(resize(document, "rbfb.lodSolverMapping.indices[" + std::to_string(i) + "]", 0),
              MIEN_OK);
  }
  const auto end = static_cast<int64_t>(field_of(document, "defn.rawControlNames").count) +
                   integers_of(document, "bhvr.controls.psdCount")[0];
  for (size_t g = 0; g < field_of(document, "bhvr.joints.jointGroups").count; ++g) {
    const std::string group = "bhvr.joints.jointGroups[" + std::to_string(g) + "]";
    const auto inputs = integers_of(document, group + ".inputIndices");
    auto values = floats_of(document, group + ".values");
    for (size_t i = 0; i < values.size(); ++i) {
      if (inputs[i % inputs.size()] >= end) values[i] = 0;
    }
    EXPECT_EQ(write_floats(document, group + ".values", values), MIEN_OK);
  }
  const auto inputs = integers_of(document, "bhvr.blendShapeChannels.inputIndices");
  auto plain = inputs;
  for (int64_t& input : plain) input = input >= end ? 0 : input;
  EXPECT_EQ(write_integers(document, "bhvr.blendShapeChannels.inputIndices", plain), MIEN_OK);
  return bytes_of(document);
}

// The model that measures agrees with the library that ships.
TEST(ControlPoses, AreThoseOfTheDeformer) {
  for (const char* rig : {"small", "small_rot", "tiny"}) {
    const Bytes bytes = plain_bytes(rig);
    const DnaHandle dna = open_dna(bytes);
    const dna::DnaView& view = dna->view;
    Arena arena(default_allocator());
    author::ControlPoses poses;
    ASSERT_TRUE(poses.prepare(view, arena));
    Deformed library(dna);
    const Span<double> controls = arena.array<double>(author::kMaxControls);
    const Span<double> channels = arena.array<double>(view.defn.channel_names.count);
    const Span<author::Rigid> skin = arena.array<author::Rigid>(view.defn.joint_names.count);
    const uint32_t mesh = view.defn.lod_meshes.at(0)[0];
    const Span<Vec3> positions = arena.array<Vec3>(view.geom.meshes[mesh].positions.xs.count);
    for (uint32_t pose = 0; pose < library.raw_count(); ++pose) {
      poses.controls(pose, controls);
      Arena scratch(default_allocator());
      ASSERT_TRUE(poses.skin(controls, scratch, skin));
      poses.channels(controls, channels);
      poses.deform(mesh, skin, channels, positions);
      const auto wanted = library.positions(mesh, {pose});
      for (size_t v = 0; v < positions.count; ++v) {
        const double scale =
            1 + std::abs(double{wanted[3 * v]}) + std::abs(double{wanted[3 * v + 1]});
        ASSERT_NEAR(positions[v].x, wanted[3 * v], 1e-4 * scale) << rig << " control " << pose;
        ASSERT_NEAR(positions[v].y, wanted[3 * v + 1], 1e-4 * scale) << rig << " control " << pose;
        ASSERT_NEAR(positions[v].z, wanted[3 * v + 2], 1e-4 * scale) << rig << " control " << pose;
      }
    }
  }
}

TEST(PruneJoints, SetsSmallEntriesToZeroAndSaysWhatItCost) {
  for (const char* rig : {"small", "small_rot"}) {
    const Bytes bytes = plain_bytes(rig);
    const DocumentHandle before = document_of(bytes), after = document_of(bytes);
    MienPruneJointsDesc desc = sized<MienPruneJointsDesc>();
    desc.translation = 0.02f;
    desc.rotation = 0.5f;
    desc.scale = 0.01f;
    MienPrunedJoints pruned = sized<MienPrunedJoints>();
    MienError error = sized<MienError>();
    ASSERT_EQ(mien_document_prune_joints(after.get(), &desc, &pruned, &error), MIEN_OK)
        << error.message;

    // Every entry, by output and input: of equal ones the last row counts.
    using Matrix = std::map<std::pair<int64_t, int64_t>, float>;
    const auto collect = [](const DocumentHandle& d) {
      Matrix entries;
      for (size_t g = 0; g < field_of(d, "bhvr.joints.jointGroups").count; ++g) {
        const std::string group = "bhvr.joints.jointGroups[" + std::to_string(g) + "]";
        const auto inputs = integers_of(d, group + ".inputIndices"),
                   outputs = integers_of(d, group + ".outputIndices");
        const auto values = floats_of(d, group + ".values");
        for (size_t r = 0; r < outputs.size(); ++r) {
          for (size_t c = 0; c < inputs.size(); ++c) {
            if (values[r * inputs.size() + c] != 0)
              entries[{outputs[r], inputs[c]}] = values[r * inputs.size() + c];
          }
        }
      }
      return entries;
    };
    Matrix wanted = collect(before);
    EXPECT_EQ(pruned.entry_count, wanted.size());
    size_t removed = 0;
    for (auto it = wanted.begin(); it != wanted.end();) {
      const float limits[] = {desc.translation, desc.rotation, desc.scale};
      const bool small = std::abs(it->second) <= limits[it->first.first % 9 / 3];
      removed += small;
      it = small ? wanted.erase(it) : std::next(it);
    }
    EXPECT_GT(removed, 0u) << rig;
    EXPECT_EQ(pruned.removed_count, removed);
    EXPECT_EQ(collect(after), wanted);
    const DnaHandle old_dna = open_dna(bytes), new_dna = dna_of(after);
    ASSERT_TRUE(new_dna);

    {
      Deformed old_library(old_dna), new_library(new_dna);
      const auto distance_at = [&](const std::vector<uint32_t>& controls, size_t only) {
        const auto a = old_library.positions(pruned.worst_mesh, controls),
                   b = new_library.positions(pruned.worst_mesh, controls);
        double worst = 0;
        for (size_t v = 0; v < a.size() / 3; ++v) {
          if (only != SIZE_MAX && only != v) continue;
          worst =
              std::max(worst, double{std::hypot(a[3 * v] - b[3 * v], a[3 * v + 1] - b[3 * v + 1],
                                                a[3 * v + 2] - b[3 * v + 2])});
        }
        return worst;
      };
      const auto raw_count = static_cast<uint32_t>(old_library.raw_count());
      for (uint32_t control = 0; control < raw_count; ++control) {
        EXPECT_LE(distance_at({control}, SIZE_MAX), pruned.worst_distance + 2e-4) << control;
      }
      if (pruned.worst_control < raw_count) {
        EXPECT_NEAR(distance_at({pruned.worst_control}, pruned.worst_position),
                    pruned.worst_distance, 2e-4);
      }
    }
    ASSERT_EQ(mien_document_undo(after.get(), 0, nullptr), MIEN_OK);
    EXPECT_EQ(bytes_of(after), bytes);
    desc.scale = -1;
    EXPECT_EQ(mien_document_prune_joints(after.get(), &desc, &pruned, &error),
              MIEN_ERROR_INVALID_ARGUMENT);
    desc = sized<MienPruneJointsDesc>();
    ASSERT_EQ(mien_document_prune_joints(after.get(), &desc, &pruned, nullptr), MIEN_OK);
    EXPECT_EQ(pruned.removed_count, 0u);
    EXPECT_EQ(pruned.worst_distance, 0);
    EXPECT_EQ(bytes_of(after), bytes);
  }
}

// By all positions in all poses, although only a few of them are computed.
TEST(PruneJoints, FindsTheWorstPositionOfAllPoses) {
  for (const char* rig : {"small", "small_rot", "tiny", "body"}) {
    SCOPED_TRACE(rig);
    const Bytes bytes = golden::read_rig(rig);
    const DocumentHandle document = document_of(bytes);
    MienPruneJointsDesc desc = sized<MienPruneJointsDesc>();
    desc.translation = 0.02f;
    desc.rotation = 0.5f;
    desc.scale = 0.01f;
    MienPrunedJoints pruned = sized<MienPrunedJoints>();
    ASSERT_EQ(mien_document_prune_joints(document.get(), &desc, &pruned, nullptr), MIEN_OK);
    const DnaHandle old_dna = open_dna(bytes), new_dna = dna_of(document);
    const dna::DnaView* const views[2] = {&old_dna->view, &new_dna->view};
    Arena arena(default_allocator());
    author::ControlPoses poses[2];
    ASSERT_TRUE(poses[0].prepare(*views[0], arena) && poses[1].prepare(*views[1], arena));
    const Span<double> controls = arena.array<double>(author::kMaxControls);
    const Span<double> channels = arena.array<double>(views[0]->defn.channel_names.count);
    const dna::Array<uint16_t> meshes = views[0]->defn.lod_meshes.at(0);
    double worst = 0;
    for (uint32_t pose = 0; pose < poses[0].count(); ++pose) {
      poses[0].controls(pose, controls);
      poses[0].channels(controls, channels);
      for (uint32_t i = 0; i < meshes.count && meshes[i] < views[0]->geom.meshes.count; ++i) {
        const size_t count = views[0]->geom.meshes[meshes[i]].positions.xs.count;
        Span<Vec3> positions[2];
        Arena scratch(default_allocator());
        for (int k = 0; k < 2; ++k) {
          const auto skin = scratch.array<author::Rigid>(views[0]->defn.joint_names.count);
          positions[k] = scratch.array<Vec3>(count);
          ASSERT_TRUE(poses[k].skin(controls, scratch, skin));
          poses[k].deform(meshes[i], skin, channels, positions[k]);
        }
        for (size_t v = 0; v < count; ++v)
          worst = std::max(worst, length(positions[0][v] - positions[1][v]));
      }
    }
    EXPECT_NEAR(pruned.worst_distance, worst, 1e-9 + worst * 1e-9);
    EXPECT_GT(pruned.removed_count, 0u);
  }
}

}  // namespace
}  // namespace mien
