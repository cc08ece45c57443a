// SPDX-License-Identifier: MIT
#include "author/document/control_errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "author/document/control_poses.h"
#include "tests/support/documents.h"

namespace mien {
namespace {

/// All positions of a mesh where one raw control is 1, or none (a control past the end).
std::vector<Vec3> posed(const dna::DnaView& view, uint32_t mesh, uint32_t control) {
  Arena arena(default_allocator());
  author::ControlPoses poses;
  const auto controls = arena.array<double>(author::kMaxControls);
  const auto channels = arena.array<double>(view.defn.channel_names.count);
  const auto skin = arena.array<author::Rigid>(view.defn.joint_names.count);
  std::vector<Vec3> out(view.geom.meshes[mesh].positions.xs.count);
  EXPECT_TRUE(poses.prepare(view, arena));
  poses.controls(control, controls);
  poses.channels(controls, channels);
  EXPECT_TRUE(poses.skin(controls, arena, skin));
  poses.deform(mesh, skin, channels, {out.data(), out.size()});
  return out;
}

// Only what moves is computed; the result is that of all positions.
TEST(MeasureControls, IsTheDifferenceOfAllPositions) {
  for (const char* rig : {"small", "tiny", "small_rot"}) {
    SCOPED_TRACE(rig);
    const DocumentHandle document = document_of(golden::read_rig(rig));
    const DnaHandle old_dna = dna_of(document);
    const dna::DnaView& before = old_dna->view;
    // Other numbers of controls, fewer targets, half of the joints stay where they are.
    const uint32_t first = 0;
    std::vector<uint32_t> joints;
    for (uint32_t j = 0; j < before.defn.joint_names.count; j += 2) joints.push_back(j);
    ASSERT_EQ(mien_document_remove(document.get(), MIEN_KIND_RAW_CONTROL, &first, 1, nullptr),
              MIEN_OK);
    ASSERT_EQ(
        mien_document_remove(document.get(), MIEN_KIND_BLEND_SHAPE_CHANNEL, &first, 1, nullptr),
        MIEN_OK);
    ASSERT_EQ(mien_document_clear_joints(document.get(), joints.data(), joints.size(), nullptr),
              MIEN_OK);
    const DnaHandle new_dna = dna_of(document);
    const dna::DnaView& after = new_dna->view;
    const uint32_t controls = after.defn.raw_control_names.count;
    ASSERT_EQ(controls + 1, before.defn.raw_control_names.count);

    std::vector<author::ControlError> found(controls + 5);
    uint32_t count = 0;
    Error error;
    ASSERT_EQ(author::measure_controls(before, after, default_allocator(),
                                       {found.data(), found.size()}, count, error),
              Status::kOk);
    ASSERT_EQ(count, controls);
    const dna::Array<uint16_t> meshes = after.defn.lod_meshes.at(0);
    double all_worst = 0;
    for (uint32_t c = 0; c < controls; ++c) {
      double worst = 0, moved = 0, squares = 0;
      size_t positions = 0;
      for (uint32_t i = 0; i < meshes.count; ++i) {
        const auto rest = posed(before, meshes[i], before.first_psd() + 60000),
                   old_pose = posed(before, meshes[i], c + 1),
                   new_pose = posed(after, meshes[i], c);
        for (size_t v = 0; v < rest.size(); ++v) {
          const double distance = length(old_pose[v] - new_pose[v]);
          worst = std::max(worst, distance);
          moved = std::max(moved, length(old_pose[v] - rest[v]));
          squares += distance * distance;
        }
        positions += rest.size();
      }
      EXPECT_EQ(found[c].control, c);
      EXPECT_NEAR(found[c].worst, worst, 1e-5) << c;
      EXPECT_NEAR(found[c].moved, moved, 1e-5) << c;
      EXPECT_NEAR(found[c].rms, std::sqrt(squares / static_cast<double>(positions)), 1e-5) << c;
      all_worst = std::max(all_worst, worst);
    }
    EXPECT_GT(all_worst, 1e-3);
    // No more than there is room for.
    ASSERT_EQ(author::measure_controls(before, after, default_allocator(), {found.data(), 1}, count,
                                       error),
              Status::kOk);
    EXPECT_EQ(count, 1u);
  }
}

}  // namespace
}  // namespace mien
