// SPDX-License-Identifier: MIT
// One count or index of a rig or deformer at a time that contradicts the others: each is found.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/baked_bytes.h"
#include "tests/support/bytes.h"
#include "tests/support/random_layer_rig.h"

namespace mien {
namespace {

/// Zeros for arrays that are longer than those of any rig here.
template <class T>
Span<T> zeros(size_t count) {
  static std::vector<T> memory;
  memory.assign(std::max(memory.size(), count), T{});
  return {memory.data(), count};
}

/// Panels of `rows` block rows each.
Span<JointPanel> panels_of(uint32_t count, uint32_t rows) {
  const Span<JointPanel> panels = zeros<JointPanel>(count + 1);
  for (uint32_t p = 0; p <= count; ++p) panels[p].first_block_row = p * rows;
  return panels;
}

/// A random rig of everything, for which `wanted` holds.
template <class F>
Bytes layers_with(bool quaternions, bool half, F&& wanted) {
  MienRigDesc desc = sized<MienRigDesc>();
  desc.rotation_output = quaternions ? MIEN_ROTATION_OUTPUT_QUATERNION : MIEN_ROTATION_OUTPUT_EULER;
  desc.storage = half ? MIEN_STORAGE_16_BIT : MIEN_STORAGE_32_BIT;
  for (uint64_t seed = 1; seed < 400; ++seed) {
    Random random = Random::from_seed(91, seed);
    const LayerFile file(random_layer_rig(random, false));
    const RigHandle rig = create_rig(file.dna.get(), desc);
    if (wanted(*capi::object(rig.get()))) return bake(rig.get());
  }
  ADD_FAILURE() << "no rig is like that";
  return {};
}

/// With a deformer in 16-bit storage.
Bytes bake_in_16_bits(const dna::DnaView& view) {
  const Bytes bytes = write_view(view);
  const DnaHandle dna = open_dna(bytes);
  const RigHandle rig = create_rig(dna.get());
  MienDeformerDesc desc = {};
  desc.storage = MIEN_STORAGE_16_BIT;
  return bake(rig.get(), create_deformer(dna.get(), rig.get(), desc).get());
}

const RbfSolverPlan* plan_with_parts(const Rig& rig) {
  for (const RbfSolverPlan& plan : rig.rbf.plans) {
    if (takes_parts(plan) && plan.input_count != 0) return &plan;
  }
  return nullptr;
}
bool has_inverses(const Rig& rig) { return !rig.rbf.inverses.empty(); }
MlStep* step_on_steps(const Rig& rig) {
  for (MlStep& step : rig.ml.steps) {
    if (step.layer_count != 0 && step.gather_count == 0 && step.dependency_count != 0) return &step;
  }
  return nullptr;
}
struct Contradiction {
  const char* what;
  void (*make)(Rig& rig);
};

void expect_found(const Bytes& file, std::initializer_list<Contradiction> all) {
  ASSERT_FALSE(file.empty());
  for (const Contradiction& contradiction : all) {
    SCOPED_TRACE(contradiction.what);
    OpenBaked opened(file);
    Rig& rig = const_cast<Rig&>(opened.arrays());
    Error error;
    ASSERT_EQ(check_rig(rig, file.size(), true, error), Status::kOk) << error.message;
    contradiction.make(rig);
    EXPECT_EQ(check_rig(rig, file.size(), true, error), Status::kBakedStructure);
    EXPECT_NE(error.message[0], 0);
  }
}

TEST(CheckBakedRig, CountsNamesAndLists) {
  expect_found(
      tiny_baked(),
      {
          {"two equal axes", [](Rig& r) { r.rotation.axes[2] = r.rotation.axes[1]; }},
          {"two other equal axes", [](Rig& r) { r.rotation.axes[2] = r.rotation.axes[0]; }},
          {"no names", [](Rig& r) { r.names[0].first = {}; }},
          {"names fewer than controls", [](Rig& r) { --r.names[1].first.count; }},
          {"names not in order",
           [](Rig& r) { std::swap(r.names[1].sorted[0], r.names[1].sorted[1]); }},
          {"a name behind one that it begins",
           [](Rig& r) {
             NameList& names = r.names[size_t(Kind::kRawControl)];
             memcpy(names.chars.data, "aba", 3);
             names.first[1] = 2;
             names.first[2] = names.first[3] = 3;
             for (uint32_t i = 0; i < 3; ++i) names.sorted[i] = i;
           }},
          {"equal names, the later one first",
           [](Rig& r) {
             NameList& names = r.names[size_t(Kind::kRawControl)];
             for (uint32_t& first : names.first) first = 0;
             for (uint32_t i = 0; i < 3; ++i) names.sorted[i] = 2 - i;
           }},
          {"a list without rows", [](Rig& r) { r.lod_joints.first = {}; }},
          {"no rows of raw to GUI controls", [](Rig& r) { r.raw_to_gui.first_row = {}; }},
          {"a run of correctives in a run",
           [](Rig& r) {
             r.psds.run_lengths[1] = 1, r.psds.run_lengths[0] = 2;
             r.psds.first_input[1] += 1;
           }},
          {"a run that ends early",
           [](Rig& r) { r.psds.run_lengths[0] = 2, r.psds.first_input[1] -= 1; }},
      });
}

TEST(CheckBakedRig, RunsOfCorrectives) {
  expect_found(bake(create_rig(generate_dna(MIEN_PRESET_SMALL, 3).get()).get()),
               {{"a run that is longer further in", [](Rig& r) {
                   const PsdTable& psds = r.psds;
                   size_t e = 0;
                   while (e + 1 < psds.run_lengths.count && psds.run_lengths[e] < 3) ++e;
                   ASSERT_LT(e + 1, psds.run_lengths.count);
                   --psds.run_lengths[e + 1];
                 }}});
}

// Names may be the same, and those of networks may be missing.
TEST(CheckBakedRig, WhatIsNoContradiction) {
  OpenBaked opened(tiny_baked());
  Rig& rig = const_cast<Rig&>(opened.arrays());
  NameList& raw = rig.names[size_t(Kind::kRawControl)];
  for (uint32_t& first : raw.first) first = 0;
  for (uint32_t i = 0; i < raw.sorted.count; ++i) raw.sorted[i] = i;
  NameList& ml = rig.names[size_t(Kind::kMlControl)];
  ASSERT_GT(rig.ml_count, 0u);
  ml.first.count = 1;
  ml.first[0] = 0;
  ml.sorted.count = 0;
  ASSERT_FALSE(rig.ml.joints.empty());
  rig.ml.joints[0].rotation_control = kNoControl;
  Error error;
  EXPECT_EQ(check_rig(rig, opened.bytes.size(), true, error), Status::kOk) << error.message;
}

TEST(CheckBakedRig, JointMatrix) {
  expect_found(
      tiny_baked(),
      {
          {"more block rows than can be numbered",
           [](Rig& r) { r.joints.panels = panels_of(kMaxBlockRows / 256 + 1, 256); }},
          {"more panels than marks",
           [](Rig& r) {
             r.joints.panels = panels_of(500, 2);
             r.joints.panel_shift = 0;
           }},
          {"no panels", [](Rig& r) { r.joints.panels = {}; }},
          {"too many panels", [](Rig& r) { r.joints.panels.count = kMaxBlockRows + 2; }},
          {"columns end before the blocks do",
           [](Rig& r) { r.joints.starts[r.joints.columns.count].first_pair -= 2; }},
          {"values of the other form", [](Rig& r) { r.joints.fixed_values = zeros<int16_t>(8); }},
          {"scales of the other form", [](Rig& r) { r.joints.scales = zeros<float>(8); }},
          {"no values", [](Rig& r) { r.joints.values = {}; }},
          {"a part of a block", [](Rig& r) { --r.joints.values.count; }},
          {"strips without inputs", [](Rig& r) { r.joints.strip_inputs = {}; }},
          {"inputs without strips", [](Rig& r) { r.joints.strips = {}; }},
          {"a strip too few", [](Rig& r) { --r.joints.strips.count; }},
          {"a strip without block rows", [](Rig& r) { r.joints.strips[1].first_block_row = 0; }},
          {"a strip of too many block rows",
           [](Rig& r) { r.joints.strips[0].first_block_row -= kMaxStripBlockRows; }},
          {"a strip that ends before it begins",
           [](Rig& r) { r.joints.strips[1].first_input = 1u << 20; }},
          {"a strip whose values are elsewhere",
           [](Rig& r) { r.joints.strips[1].first_block += 2; }},
          {"strips whose values end early",
           [](Rig& r) { r.joints.strip_values.count -= kJointBlockRows; }},
          {"values of strips in the other form",
           [](Rig& r) { r.joints.strip_fixed_values = zeros<int16_t>(8); }},
          {"strips of columns that are none",
           [](Rig& r) {
             r.joints.first_strip_column = static_cast<uint32_t>(r.joints.columns.count);
           }},
          {"an input that is no control", [](Rig& r) { r.joints.strip_inputs[0] = 0xFFFF; }},
      });
  expect_found(layers_with(false, true, [](const Rig& r) { return !r.joints.scales.empty(); }),
               {{"scales are missing", [](Rig& r) { --r.joints.scales.count; }},
                {"values of the other form", [](Rig& r) { r.joints.values = zeros<float>(8); }}});
}

TEST(CheckBakedRig, TwistsAndSwings) {
  expect_found(
      layers_with(false, false, [](const Rig& r) { return r.twist_swing.setups.count > 1; }),
      {
          {"LODs are missing", [](Rig& r) { --r.twist_swing.blocks_at_lod.count; }},
          {"a LOD with more blocks than there are",
           [](Rig& r) { r.twist_swing.blocks_at_lod[0] = r.twist_swing.block_count() + 1; }},
          {"an input too few", [](Rig& r) { --r.twist_swing.inputs.count; }},
          {"a row too few", [](Rig& r) { --r.twist_swing.lanes.count; }},
          {"an input that is no control", [](Rig& r) { r.twist_swing.inputs[0] = 0xFFFF; }},
          {"a joint that is none", [](Rig& r) { r.twist_swing.outputs[0].joint = 0xFFFF; }},
          {"a lane that is none", [](Rig& r) { r.twist_swing.outputs[0].lane = 1 << 20; }},
          {"a set-up that skips outputs", [](Rig& r) { ++r.twist_swing.setups[1].first_output; }},
          {"a set-up with too many outputs",
           [](Rig& r) { ++r.twist_swing.setups[r.twist_swing.setups.count - 1].output_count; }},
      });
}

TEST(CheckBakedRig, Rotations) {
  const auto wanted = [](const Rig& r) {
    return !r.rotations.turns.empty() && !r.rotations.angle_joints.empty();
  };
  expect_found(
      layers_with(true, false, wanted),
      {
          {"groups are missing", [](Rig& r) { --r.rotations.groups.count; }},
          {"not even an end of steps", [](Rig& r) { r.rotations.first_steps.count = 0; }},
          {"LODs are missing", [](Rig& r) { --r.rotations.blocks_at_lod.count; }},
          {"a block too few", [](Rig& r) { --r.rotations.first_steps.count; }},
          {"blocks without steps", [](Rig& r) { --r.rotations.steps_at_lod.count; }},
          {"lanes without steps", [](Rig& r) { --r.rotations.lane_steps_at_lod.count; }},
          {"a quaternion too few", [](Rig& r) { --r.rotations.values.count; }},
          {"steps that fall", [](Rig& r) { r.rotations.first_steps[0] = 1; }},
          {"a block that is not there",
           [](Rig& r) { r.rotations.blocks_at_lod[0] = r.rotations.block_count() + 1; }},
          {"more steps than a block has", [](Rig& r) { r.rotations.steps_at_lod[0] = 0xFFFF; }},
          {"angles of a joint that is not there",
           [](Rig& r) { r.rotations.angle_joints[0].joint = 0xFFFF; }},
          {"a turn of a joint that is not there",
           [](Rig& r) { r.rotations.turns[0].joint = 0xFFFF; }},
          {"a turn in a lane that is not there",
           [](Rig& r) { r.rotations.turns[0].lane = 1 << 20; }},
          {"a control that is not there", [](Rig& r) { r.rotations.columns[0] = 0xFFFF; }},
          {"a group that skips angles", [](Rig& r) { ++r.rotations.groups[0].first_angle_joint; }},
          {"a group that skips turns", [](Rig& r) { ++r.rotations.groups[0].first_turn; }},
          {"more angles than groups have", [](Rig& r) { --r.rotations.angle_joints.count; }},
      });
  expect_found(tiny_baked(), {{"angles become quaternions, which nobody asked for",
                               [](Rig& r) { r.rotations.angle_joints = zeros<AngleJoint>(1); }}});
}

TEST(CheckBakedRig, RbfSolvers) {
  const auto wanted = [](const Rig& r) { return plan_with_parts(r) && has_inverses(r); };
  expect_found(layers_with(false, false, wanted),
               {
                   {"half of a rotation",
                    [](Rig& r) { ++const_cast<RbfSolverPlan*>(plan_with_parts(r))->input_count; }},
                   {"rotations are missing",
                    [](Rig& r) {
                      r.rbf.swings.count -= kBlockLanes;
                      r.rbf.rotations.count -= 4 * kBlockLanes;
                      for (RbfSolverPlan& plan : r.rbf.plans) {
                        if (takes_parts(plan))
                          plan.input_count = uint16_t(plan.input_count + 8 * plan.angle_inputs);
                      }
                    }},
                   {"scales of poses are missing",
                    [](Rig& r) {
                      --r.rbf.pose_scales.count;
                      --r.rbf.pose_factors.count;
                    }},
                   {"targets are missing", [](Rig& r) { --r.rbf.targets.count; }},
                   {"inverses are missing", [](Rig& r) { --r.rbf.inverses.count; }},
                   {"a solver without plan", [](Rig& r) { --r.rbf.plans.count; }},
                   {"a part of a block of rotations", [](Rig& r) { --r.rbf.rotations.count; }},
                   {"a swing too few", [](Rig& r) { --r.rbf.swings.count; }},
                   {"a factor too few", [](Rig& r) { --r.rbf.pose_factors.count; }},
                   {"a control that is not there", [](Rig& r) { r.rbf.rotations[0] = 0xFFFF; }},
                   {"no poses, not even their end", [](Rig& r) { r.rbf.first_input = {}; }},
               });
}

TEST(CheckBakedRig, LearnedBehavior) {
  expect_found(layers_with(false, false, step_on_steps),
               {
                   {"layers wider than the widest", [](Rig& r) { r.ml.widest_layer = 0; }},
                   {"a layer that makes nothing of something",
                    [](Rig& r) { r.ml.layers[r.ml.layers.count - 1].output_count = 0; }},
                   {"a layer that makes nothing of nothing",
                    [](Rig& r) {
                      NetworkLayer& layer = r.ml.layers[r.ml.layers.count - 1];
                      layer.output_count = layer.input_count = 0;
                    }},
                   {"a step gathers more than the widest layer",
                    [](Rig& r) {
                      r.ml.controls = zeros<uint16_t>(1 << 16);
                      step_on_steps(r)->gather_count = r.ml.widest_layer + 1;
                    }},
                   {"a step takes more than the widest layer",
                    [](Rig& r) {
                      r.ml.buffer_size = 1 << 20;
                      const MlStep& step = *step_on_steps(r);
                      r.ml.dependencies[step.first_dependency].count = r.ml.widest_layer + 1;
                      r.ml.dependencies[step.first_dependency].first = 0;
                    }},
                   {"steps share what they depend on",
                    [](Rig& r) {
                      for (MlStep& step : r.ml.steps) {
                        step.first_dependency = 0;
                        step.dependency_count = static_cast<uint32_t>(r.ml.dependencies.count);
                        step.gather_count = 1;
                        step.layer_count = 1;
                      }
                    }},
                   {"steps share what they depend on and run nothing",
                    [](Rig& r) {
                      for (MlStep& step : r.ml.steps) {
                        step.first_dependency = 0;
                        step.dependency_count = static_cast<uint32_t>(r.ml.dependencies.count);
                        step.layer_count = 0;
                      }
                    }},
                   {"steps share what they gather",
                    [](Rig& r) {
                      for (MlStep& step : r.ml.steps) {
                        step.first_gather = 0;
                        step.gather_count =
                            std::min(r.ml.widest_layer, static_cast<uint32_t>(r.ml.controls.count));
                      }
                    }},
                   {"a system with two equal axes",
                    [](Rig& r) {
                      r.ml.converts = true;
                      for (uint8_t i = 0; i < 3; ++i)
                        r.ml.change.from[i] = i, r.ml.change.to[i] = 0;
                    }},
               });
}

TEST(CheckBakedDeformer, CountsAndIndices) {
  Arena arena(default_allocator());
  const Bytes bytes = write_view(dna::tiny_rig(arena));
  const DnaHandle dna = open_dna(bytes);
  const RigHandle rig = create_rig(dna.get());
  const Bytes file = bake(rig.get(), create_deformer(dna.get(), rig.get()).get());
  struct {
    const char* what;
    void (*make)(Deformer& deformer, DeformMesh& mesh);
  } const all[] = {
      {"a joint twice",
       [](Deformer& d, DeformMesh&) { d.skeleton.order[1] = d.skeleton.order[0]; }},
      {"neutral pose", [](Deformer& d, DeformMesh&) { --d.skeleton.neutral.count; }},
      {"bind matrices", [](Deformer& d, DeformMesh&) { --d.skeleton.bind.count; }},
      {"inverse bind matrices", [](Deformer& d, DeformMesh&) { --d.skeleton.inverse_bind.count; }},
      {"angles that are quaternions",
       [](Deformer& d, DeformMesh&) {
         d.skeleton.compose = Compose::kEulerAdd;
         d.skeleton.joint_attributes = 10;
       }},
      {"runs of targets without an end",
       [](Deformer&, DeformMesh& m) { --m.first_target_run.count; }},
      {"targets behind the last block",
       [](Deformer&, DeformMesh& m) { --m.first_target_run[m.block_count()]; }},
      {"a vertex of no position",
       [](Deformer&, DeformMesh& m) { --m.first_vertex[m.position_count]; }},
      {"a vertex without a sorted normal",
       [](Deformer&, DeformMesh& m) { m.sorted_normals.count -= 4; }},
      {"a hard edge of no position", [](Deformer&, DeformMesh& m) { m.hard_positions.count += 1; }},
      {"a direction too many", [](Deformer&, DeformMesh& m) { m.neutral_directions.count += 4; }},
      {"faces read as indices of the other size",
       [](Deformer&, DeformMesh& m) {
         m.faces =
             IndexList(Span<uint32_t>{static_cast<uint32_t*>(m.faces.data), m.faces.count / 8 * 4});
       }},
      {"a position twice in the order",
       [](Deformer&, DeformMesh& m) { m.position_indices[1] = m.position_indices[0]; }},
      {"16-bit storage with floats", [](Deformer& d, DeformMesh&) { d.half_storage = true; }},
      {"triangles that are not there", [](Deformer&, DeformMesh& m) { m.triangles = {}; }},
      {"corners of triangles that do not follow",
       [](Deformer&, DeformMesh& m) { m.corner_vertices = m.faces; }},
      {"texture coordinates twice",
       [](Deformer&, DeformMesh& m) {
         m.fixed_coordinates = {m.joints.data, m.texture_coordinates.count};
       }},
      {"normals that are no choice",
       [](Deformer& d, DeformMesh&) { d.normals = Normals::kDefault; }},
      {"more faces than can be numbered",
       [](Deformer&, DeformMesh& m) { m.faces.count = SIZE_MAX / 8 * 4; }},
  };
  // Where sizes have 32 bits, faces cannot be as many as the last says.
  size_t left = std::size(all) - (sizeof(size_t) == 4);
  for (const auto& contradiction : all) {
    if (left-- == 0) break;
    SCOPED_TRACE(contradiction.what);
    OpenBaked opened(file);
    Deformer& deformer = const_cast<Deformer&>(opened.deformer_arrays());
    Error error;
    ASSERT_EQ(check_deformer(deformer, true, error), Status::kOk) << error.message;
    contradiction.make(deformer, deformer.meshes[0]);
    EXPECT_EQ(check_deformer(deformer, true, error), Status::kBakedStructure);
  }
}

// In 16-bit storage triangles follow from faces.
TEST(CheckBakedDeformer, TrianglesOfFaces) {
  Arena arena(default_allocator());
  dna::DnaView view = dna::tiny_rig(arena);
  view.geom.meshes[0].layouts.positions = dna::be<uint32_t>(arena, {0, 1, 4, 3, 4, 1});
  view.geom.meshes[0].faces[0].layout_indices = dna::be<uint32_t>(arena, {0, 1, 2, 3});
  view.geom.meshes[0].faces[1].layout_indices = dna::be<uint32_t>(arena, {5, 4, 3});
  const Bytes file = bake_in_16_bits(view);
  const auto expect = [&](Status expected, void (*make)(DeformMesh & mesh)) {
    OpenBaked opened(file);
    Deformer& deformer = const_cast<Deformer&>(opened.deformer_arrays());
    DeformMesh& mesh = deformer.meshes[0];
    ASSERT_TRUE(mesh.triangles_follow());
    ASSERT_EQ(mesh.corner_vertices.count, 4u);
    make(mesh);
    Error error;
    EXPECT_EQ(check_deformer(deformer, true, error), expected);
    if (expected != Status::kOk) return;
    std::vector<uint32_t> triangles(9);
    ASSERT_TRUE(write_triangles(mesh, default_allocator(), triangles.data()));
    for (const uint32_t vertex : triangles) EXPECT_LT(vertex, mesh.vertex_count);
  };
  expect(Status::kOk, [](DeformMesh&) {});
  // Too few corners, which the check does not count, are the first vertex.
  expect(Status::kOk, [](DeformMesh& m) { m.corner_vertices.count = 1; });
  expect(Status::kBakedStructure, [](DeformMesh& m) { ++m.triangle_count; });
  expect(Status::kBakedStructure, [](DeformMesh& m) { --m.triangle_count; });
  expect(Status::kBakedStructure, [](DeformMesh& m) { m.faces.count -= 4; });
  expect(Status::kBakedStructure, [](DeformMesh& m) { m.faces.set(3, m.faces[2]); });
  expect(Status::kBakedStructure, [](DeformMesh& m) { m.corner_vertices.count = 9; });
  expect(Status::kBakedStructure, [](DeformMesh& m) { m.corner_vertices.set(2, m.vertex_count); });
  expect(Status::kBakedStructure, [](DeformMesh& m) { --m.fixed_coordinates.count; });
  expect(Status::kBakedStructure, [](DeformMesh& m) { m.fixed_coordinates = {}; });
}

// In 16-bit storage each run of a target says where its numbers are, and how many bits they have.
TEST(CheckBakedDeformer, NumbersOfTargets) {
  Arena arena(default_allocator());
  const Bytes file = bake_in_16_bits(dna::tiny_rig(arena));
  const auto expect = [&](Status expected, void (*make)(DeformMesh & mesh)) {
    OpenBaked opened(file);
    Deformer& deformer = const_cast<Deformer&>(opened.deformer_arrays());
    ASSERT_FALSE(deformer.meshes[0].fixed_runs.empty());
    make(deformer.meshes[0]);
    Error error;
    EXPECT_EQ(check_deformer(deformer, true, error), expected);
  };
  expect(Status::kOk, [](DeformMesh&) {});
  expect(Status::kOk, [](DeformMesh& m) { m.fixed_runs[0].scale = NAN; });
  expect(Status::kBakedStructure, [](DeformMesh& m) { m.fixed_runs[0].place += 2; });
  expect(Status::kBakedStructure, [](DeformMesh& m) { m.fixed_runs[0].place ^= 1; });
  expect(Status::kBakedStructure, [](DeformMesh& m) { m.fixed_runs[0].place = ~0u; });
  expect(Status::kBakedStructure, [](DeformMesh& m) { ++m.fixed_runs[0].groups; });
  expect(Status::kBakedStructure, [](DeformMesh& m) { m.fixed_runs[0].groups = ~0u; });
  expect(Status::kBakedStructure, [](DeformMesh& m) { ++m.target_runs[0].count; });
  // The first group: no position, one more position, one that the mesh lacks.
  expect(Status::kBakedStructure, [](DeformMesh& m) { m.fixed_deltas[0] &= ~15; });
  expect(Status::kBakedStructure, [](DeformMesh& m) { m.fixed_deltas[0] ^= 8; });
  expect(Status::kBakedStructure, [](DeformMesh& m) { m.fixed_deltas[0] |= 127 << 4; });
  expect(Status::kBakedStructure, [](DeformMesh& m) { m.fixed_deltas[0] |= -0x8000; });
  expect(Status::kBakedStructure, [](DeformMesh& m) { --m.fixed_runs.count; });
  expect(Status::kBakedStructure, [](DeformMesh& m) { --m.fixed_deltas.count; });
}

}  // namespace
}  // namespace mien
