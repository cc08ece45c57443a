// SPDX-License-Identifier: MIT
// Valid files of shapes that no tool makes: each goes through its whole life, or is refused
// with the status of the limit that it exceeds.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/dna_bytes.h"
#include "tests/support/exercise_dna.h"
#include "tests/support/rig_handles.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

using dna::be;
using dna::DnaView;
using dna::list;
using dna::MlOperation;
using U16 = std::initializer_list<uint16_t>;

/// At both LODs.
dna::LodMap both_lods(Arena& a, U16 elements) {
  return {be<uint16_t>(a, {0, 0}), list<dna::Array<uint16_t>>(a, {be<uint16_t>(a, elements)})};
}

/// A sum of `outputs` values of operation 0 of a set.
MlOperation sum_of(Arena& a, uint32_t outputs, uint16_t set) {
  MlOperation sum;
  sum.type = static_cast<uint16_t>(dna::MlOperationType::kWeightedSum);
  sum.parameters = be<uint32_t>(a, {outputs, 0x3f800000});
  sum.set_dependencies = be<uint16_t>(a, {set});
  sum.operation_dependencies = be<uint16_t>(a, {0});
  return sum;
}

MlOperation& operation(DnaView& v, size_t set) { return v.mlbe.types[0].operations[set][0]; }

/// Keys 0 to 9 of ML joints: the tongue is a quaternion, and these are their axes.
void set_ml_system(DnaView& v, Arena& a, U16 axes) {
  const dna::NewArray<uint16_t> values = dna::new_array<uint16_t>(a, 10);
  for (uint32_t i = 0; i < 10; ++i) values.set(i, i == 1 || (i >= 6 && i < 9));
  for (uint32_t i = 0; i < 3; ++i) values.set(3 + i, axes.begin()[i]);
  v.mlbe.joints.parameter_keys = be<uint16_t>(a, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  v.mlbe.joints.parameter_values = values;
}

struct Rare {
  const char* name;
  MienStatus compiled, packed;
  void (*make)(DnaView& view, Arena& arena);
};
void PrintTo(const Rare& rare, std::ostream* out) { *out << rare.name; }

const Rare kRare[] = {
    {"AMeshOfTargetsAlone", MIEN_OK, MIEN_OK,
     [](DnaView& v, Arena& a) {
       v.geom.meshes[0] = {};
       v.geom.meshes[0].blend_shape_targets =
           list<dna::BlendShapeTarget>(a, {dna::BlendShapeTarget()});
     }},
    {"NormalsThatAreNoNumbers", MIEN_OK, MIEN_OK,
     [](DnaView& v, Arena& a) {
       const float nan = std::nanf("");
       v.geom.meshes[0].normals.zs = be<float>(a, {nan, 1, 1, 1, 1, 1});
     }},
    {"ASumOfNothing", MIEN_OK, MIEN_OK,
     [](DnaView& v, Arena& a) {
       MlOperation sum = sum_of(a, 3, 0);
       sum.parameters = be<uint32_t>(a, {3});
       sum.set_dependencies = sum.operation_dependencies = {};
       v.mlbe.types[0].operations[1] = list<MlOperation>(a, {operation(v, 1), sum});
       v.mlbe.types[0].lod_operations[1] = both_lods(a, {0, 1});
     }},
    {"ASumOfControlsWithoutNetworks", MIEN_OK, MIEN_OK,
     [](DnaView& v, Arena& a) {
       v.mlbh.networks = {};
       v.mlbh.lod_networks = {};
       v.mlbh.mesh_regions = {};
       v.mlbe.joints = {};
       dna::MlType& type = v.mlbe.types[0];
       type.operations = list<dna::List<MlOperation>>(
           a, {type.operations[0], list<MlOperation>(a, {sum_of(a, 2, 0)})});
       type.lod_operations = list<dna::LodMap>(a, {both_lods(a, {0}), both_lods(a, {0})});
     }},
    {"AScatterOfASum", MIEN_OK, MIEN_OK,
     [](DnaView& v, Arena& a) { operation(v, 1) = sum_of(a, 2, 0); }},
    {"ASumOfWhatIsScattered", MIEN_OK, MIEN_OK,
     [](DnaView& v, Arena& a) {
       dna::MlType& type = v.mlbe.types[0];
       type.operations = list<dna::List<MlOperation>>(
           a, {type.operations[0], type.operations[1], type.operations[2],
               list<MlOperation>(a, {sum_of(a, 0, 2)})});
       type.lod_operations = list<dna::LodMap>(
           a, {both_lods(a, {0}), both_lods(a, {0}), both_lods(a, {0}), both_lods(a, {0})});
     }},
    {"MlJointsWithAnUnknownParameter", MIEN_OK, MIEN_OK,
     [](DnaView& v, Arena& a) {
       v.mlbe.joints.parameter_keys = be<uint16_t>(a, {0, 1, 2, 12});
       v.mlbe.joints.parameter_values = be<uint16_t>(a, {0, 1, 0, 7});
     }},
    {"MlJointsWhoseAxesDoNotSpanSpace", MIEN_OK, MIEN_OK,
     [](DnaView& v, Arena& a) {
       set_ml_system(v, a, {0, 0, 0});
     }},
    {"ARigWhoseAxesDoNotSpanSpace", MIEN_OK, MIEN_OK,
     [](DnaView& v, Arena& a) {
       set_ml_system(v, a, {0, 2, 4});
       v.desc.coordinate_system = {0, 0, 0};
     }},
    {"ASolverOfManyPoses", MIEN_ERROR_DNA_LIMIT, MIEN_OK,
     [](DnaView& v, Arena& a) {
       const dna::NewArray<uint16_t> poses = dna::new_array<uint16_t>(a, 1025);
       for (uint32_t i = 0; i < poses.count; ++i) poses.set(i, i % 2);
       const dna::NewArray<float> values = dna::new_array<float>(a, 2 * poses.count);
       for (uint32_t i = 0; i < values.count; ++i) values.set(i, 0);
       v.rbfb.solvers[0].pose_indices = poses;
       v.rbfb.solvers[0].raw_control_values = values;
     }},
    {"APoseThatASolverRepeats", MIEN_ERROR_DNA_LIMIT, MIEN_OK,
     [](DnaView& v, Arena& a) {
       const dna::NewArray<uint16_t> outputs = dna::new_array<uint16_t>(a, 20000);
       const dna::NewArray<float> weights = dna::new_array<float>(a, outputs.count);
       for (uint32_t i = 0; i < outputs.count; ++i) outputs.set(i, 9), weights.set(i, 0);
       v.rbfe.poses[1].output_control_indices = outputs;
       v.rbfe.poses[1].output_control_weights = weights;
       const dna::NewArray<uint16_t> poses = dna::new_array<uint16_t>(a, 1000);
       for (uint32_t i = 0; i < poses.count; ++i) poses.set(i, 1);
       const dna::NewArray<float> values = dna::new_array<float>(a, 2 * poses.count);
       for (uint32_t i = 0; i < values.count; ++i) values.set(i, 0);
       v.rbfb.solvers[0].solver_type = 0;
       v.rbfb.solvers[0].pose_indices = poses;
       v.rbfb.solvers[0].raw_control_values = values;
     }},
    {"AGroupOfColumnsAlone", MIEN_OK, MIEN_OK,
     [](DnaView& v, Arena&) {
       dna::JointGroup& group = v.bhvr.joints.groups[1];
       group.lods = group.output_indices = {};
       group.values = {};
     }},
    {"NoJointsAtTheCoarseLod", MIEN_OK, MIEN_OK,
     [](DnaView& v, Arena& a) {
       v.defn.lod_joints.indices[1] = {};
       v.bhvr.joints.groups[0].lods = be<uint16_t>(a, {3, 0});
     }},
};

class RareFiles : public testing::TestWithParam<Rare> {};

TEST_P(RareFiles, LiveOrAreRefused) {
  Arena arena(default_allocator());
  DnaView view = dna::tiny_rig(arena);
  GetParam().make(view, arena);
  const Bytes file = dna::written(view);
  for (const uint64_t lods : {0, 1, 2}) {
    LifeOptions options;
    options.lods = lods;
    options.twins = true;
    const Life life = live(file.data(), file.size(), options);
    EXPECT_EQ(life.broken, "");
    EXPECT_EQ(life.opened, MIEN_OK) << life.message;
    if (lods == 2) continue;  // what is wrong may be of LOD 0
    EXPECT_EQ(life.compiled, GetParam().compiled) << life.message;
    EXPECT_EQ(life.packed, GetParam().packed) << life.message;
  }
}

INSTANTIATE_TEST_SUITE_P(Each, RareFiles, testing::ValuesIn(kRare),
                         [](const auto& each) { return each.param.name; });

// 65,535 joint values can be told apart: 10 of each joint, and 3 for each that turns.
TEST(RareFilesTest, TooManyJointsForQuaternions) {
  for (const uint32_t joints : {5041u, 5042u}) {
    Arena arena(default_allocator());
    DnaView view = dna::tiny_rig(arena);
    const dna::NewArray<uint16_t> parents = dna::new_array<uint16_t>(arena, joints);
    const dna::NewArray<float> zeros = dna::new_array<float>(arena, joints);
    const Span<dna::String> names = arena.array<dna::String>(joints);
    for (uint32_t j = 0; j < joints; ++j) {
      parents.set(j, 0), zeros.set(j, 0);
      names[j] = dna::text("joint");
    }
    view.defn.joint_names = {names.data, joints};
    view.defn.joint_hierarchy = parents;
    view.defn.neutral_translations = view.defn.neutral_rotations = {zeros, zeros, zeros};
    view.bhvr.joints.row_count = static_cast<uint16_t>(9 * joints);
    const Bytes file = dna::written(view);
    const DnaHandle dna = open_dna(file);
    ASSERT_TRUE(dna);
    auto desc = sized<MienRigDesc>();
    desc.rotation_output = MIEN_ROTATION_OUTPUT_QUATERNION;
    MienError error = sized<MienError>();
    MienRig* rig = nullptr;
    EXPECT_EQ(mien_rig_create(dna.get(), &desc, &rig, &error),
              joints > 5041 ? MIEN_ERROR_DNA_LIMIT : MIEN_OK)
        << error.message;
    mien_rig_destroy(rig);
  }
}

}  // namespace
}  // namespace mien
