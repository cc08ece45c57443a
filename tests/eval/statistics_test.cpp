// SPDX-License-Identifier: MIT
// Counts of an evaluation, on a rig of which each number is known.
#include "runtime/eval/statistics.h"

#include <gtest/gtest.h>

#include "capi/handles.h"
#include "tests/support/plain_rig.h"

namespace mien {
namespace {

TEST(Statistics, CountTheColumnsOfActiveControls) {
  PlainRig plain;
  plain.raw_count = 3;
  plain.joint_count = 2;
  // Rows 4, 17 and 0 of 18; raw controls 2 and 0 drive them. Raw control 0 drives rows 4 and 0 only.
  plain.groups = {{{3}, {2, 0}, {4, 17, 0}, {1, 2, 0.5f, 0, 0, 4}}};
  Character character(make_rig(plain));
  const Rig& rig = *capi::object(character.rig);
  Instance& instance = *capi::object(character.instance.get());

  const RigStatistics all = rig_statistics(rig, 0);
  EXPECT_EQ(all.joint_count, 2u);
  EXPECT_EQ(all.joint_row_count, 3u);
  EXPECT_EQ(all.psd_count, 0u);
  EXPECT_EQ(all.quaternion_joint_count, 0u);
  EXPECT_EQ(all.rbf_solver_count, 0u);
  EXPECT_EQ(all.joint_entry_count % 8, 0u);
  EXPECT_GT(all.joint_byte_count, all.joint_entry_count);

  InstanceStatistics none = instance_statistics(instance);
  EXPECT_EQ(none.active_control_count, 0u);
  EXPECT_EQ(none.joint_column_count, 0u);
  EXPECT_EQ(none.joint_entry_count, 0u);
  EXPECT_EQ(none.joint_byte_count, 0u);

  character.raw[1] = 1;  // drives nothing
  EXPECT_EQ(instance_statistics(instance).active_control_count, 1u);
  EXPECT_EQ(instance_statistics(instance).joint_column_count, 0u);

  character.raw[1] = 0;
  uint64_t entries = 0, bytes = 0;
  for (uint32_t control : {0u, 2u}) {
    character.raw[control] = 0.5f;
    const InstanceStatistics one = instance_statistics(instance);
    EXPECT_EQ(one.active_control_count, 1u);
    EXPECT_EQ(one.joint_column_count, 1u);
    EXPECT_GE(one.joint_entry_count, 8u);
    entries += one.joint_entry_count;
    bytes += one.joint_byte_count;
    character.raw[control] = 0;
  }
  EXPECT_EQ(entries, all.joint_entry_count) << "each block belongs to one column";
  EXPECT_EQ(bytes, all.joint_byte_count);
}

}  // namespace
}  // namespace mien
