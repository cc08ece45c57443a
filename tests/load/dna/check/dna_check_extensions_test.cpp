// SPDX-License-Identifier: MIT
// The layers that came after 2.2, broken in every way that matters.
#include <gtest/gtest.h>

#include "tests/support/damage.h"

namespace mien::dna {
namespace {

RbfSolver& solver(DnaView& v) { return v.rbfb.solvers[0]; }
NeuralNetwork& network(DnaView& v) { return v.mlbh.networks[0]; }
MlOperation& operation(DnaView& v, size_t set) { return v.mlbe.types[0].operations[set][0]; }

const Damage kSolverCases[] = {
    {"MoreRepresentationsThanJoints", kStructure, "jbmd.jointRepresentations",
     [](DnaView& v, Arena& a) {
       v.jbmd.joints = list<JointRepresentation>(a, {{}, {}, {}, {}});
     }},
    {"RotationRepresentation", kValue, "jbmd.jointRepresentations[2].rotation",
     [](DnaView& v, Arena&) { v.jbmd.joints[2].rotation = 2; }},
    {"TranslationRepresentation", kValue, "jbmd.jointRepresentations[0].translation",
     [](DnaView& v, Arena&) { v.jbmd.joints[0].translation = 1; }},
    {"ScaleRepresentation", kValue, "jbmd.jointRepresentations[1].scale",
     [](DnaView& v, Arena&) { v.jbmd.joints[1].scale = 1; }},
    {"TooManyTwists", kLimit, "twsw.twists",
     [](DnaView& v, Arena& a) { v.twsw.twists = too_many<Twist>(a); }},
    {"TooManySwings", kLimit, "twsw.swings",
     [](DnaView& v, Arena& a) { v.twsw.swings = too_many<Swing>(a); }},
    {"TwistWeights", kStructure, "twsw.twists[0].twistBlendWeights",
     [](DnaView& v, Arena&) { v.twsw.twists[0].blend_weights = {}; }},
    {"TwistJoint", kReference, "twsw.twists[0].twistOutputJointIndices",
     [](DnaView& v, Arena& a) { v.twsw.twists[0].output_joint_indices = be(a, U16{3}); }},
    {"TwistInputs", kStructure, "twsw.twists[0].twistInputControlIndices",
     [](DnaView& v, Arena& a) {
       v.twsw.twists[0].input_control_indices = be(a, U16{5, 6, 7});
     }},
    {"TwistControl", kReference, "twsw.twists[0].twistInputControlIndices",
     [](DnaView& v, Arena& a) {
       v.twsw.twists[0].input_control_indices = be(a, U16{5, 6, 7, 11});
     }},
    {"TwistAxis", kValue, "twsw.twists[0].twistAxis",
     [](DnaView& v, Arena&) { v.twsw.twists[0].twist_axis = 3; }},
    {"SwingWeights", kStructure, "twsw.swings[0].swingBlendWeights",
     [](DnaView& v, Arena& a) {
       v.twsw.swings[0].blend_weights = be(a, F32{1, 1});
     }},
    {"SwingJoint", kReference, "twsw.swings[0].swingOutputJointIndices",
     [](DnaView& v, Arena& a) { v.twsw.swings[0].output_joint_indices = be(a, U16{65535}); }},
    {"SwingAxis", kValue, "twsw.swings[0].twistAxis",
     [](DnaView& v, Arena&) { v.twsw.swings[0].twist_axis = 3; }},
    {"SwingNan", kWarning, "twsw.swings[0].swingBlendWeights",
     [](DnaView& v, Arena& a) { v.twsw.swings[0].blend_weights = be(a, F32{kNan}); }},

    {"TooManySolvers", kLimit, "rbfb.solvers",
     [](DnaView& v, Arena& a) { v.rbfb.solvers = too_many<RbfSolver>(a); }},
    {"TooManyPoses", kLimit, "rbfb.poses",
     [](DnaView& v, Arena& a) { v.rbfb.poses = too_many<RbfPose>(a); }},
    {"LodSolver", kReference, "rbfb.lodSolverMapping.indices[0]",
     [](DnaView& v, Arena& a) { v.rbfb.lod_solvers.indices[0] = be(a, U16{1}); }},
    {"SolverInput", kReference, "rbfb.solvers[0].rawControlIndices",
     [](DnaView& v, Arena& a) {
       solver(v).raw_control_indices = be(a, U16{0, 11});
     }},
    {"SolverPose", kReference, "rbfb.solvers[0].poseIndices",
     [](DnaView& v, Arena& a) {
       solver(v).pose_indices = be(a, U16{0, 2});
     }},
    {"SolverValues", kStructure, "rbfb.solvers[0].rawControlValues",
     [](DnaView& v, Arena& a) {
       solver(v).raw_control_values = be(a, F32{0, 0, 1});
     }},
    {"SolverType", kValue, "rbfb.solvers[0].solverType",
     [](DnaView& v, Arena&) { solver(v).solver_type = 2; }},
    {"SolverAutomatic", kValue, "rbfb.solvers[0].automaticRadius",
     [](DnaView& v, Arena&) { solver(v).automatic_radius = 2; }},
    {"SolverDistance", kValue, "rbfb.solvers[0].distanceMethod",
     [](DnaView& v, Arena&) { solver(v).distance_method = 4; }},
    {"SolverNormalize", kValue, "rbfb.solvers[0].normalizeMethod",
     [](DnaView& v, Arena&) { solver(v).normalize_method = 2; }},
    {"SolverFunction", kValue, "rbfb.solvers[0].functionType",
     [](DnaView& v, Arena&) { solver(v).function_type = 5; }},
    {"SolverAxis", kValue, "rbfb.solvers[0].twistAxis",
     [](DnaView& v, Arena&) { solver(v).twist_axis = 3; }},
    {"SolverAngles", kWarning, "rbfb.solvers[0].rawControlIndices",
     [](DnaView& v, Arena&) { solver(v).distance_method = 1; }},
    {"SolverRadius", kWarning, "rbfb.solvers[0].radius",
     [](DnaView& v, Arena&) { solver(v).radius = kInfinity; }},
    {"SolverThreshold", kWarning, "rbfb.solvers[0].weightThreshold",
     [](DnaView& v, Arena&) { solver(v).weight_threshold = kNan; }},
    {"SolverValueNan", kWarning, "rbfb.solvers[0].rawControlValues",
     [](DnaView& v, Arena& a) {
       solver(v).raw_control_values = be(a, F32{0, 0, 1, kNan});
     }},
    {"PoseWeightNan", kWarning, "rbfe.poses[0].outputControlWeights",
     [](DnaView& v, Arena& a) { v.rbfe.poses[0].output_control_weights = be(a, F32{kNan}); }},
    {"PoseScale", kWarning, "rbfb.poses[1].scale",
     [](DnaView& v, Arena&) { v.rbfb.poses[1].scale = kNan; }},
    {"PoseCount", kStructure, "rbfe.poses", [](DnaView& v, Arena&) { v.rbfe.poses.count = 1; }},
    {"PoseInput", kReference, "rbfe.poses[1].inputControlIndices",
     [](DnaView& v, Arena& a) { v.rbfe.poses[1].input_control_indices = be(a, U16{11}); }},
    {"PoseOutput", kReference, "rbfe.poses[0].outputControlIndices",
     [](DnaView& v, Arena& a) { v.rbfe.poses[0].output_control_indices = be(a, U16{11}); }},
    {"PoseWeights", kStructure, "rbfe.poses[0].outputControlWeights",
     [](DnaView& v, Arena&) { v.rbfe.poses[0].output_control_weights = {}; }},
};

const Damage kNetworkCases[] = {
    {"TooManyNetworks", kLimit, "mlbh.neuralNetworks",
     [](DnaView& v, Arena& a) { v.mlbh.networks = too_many<NeuralNetwork>(a); }},
    {"TooManyLayers", kLimit, "mlbh.neuralNetworks[0].layers",
     [](DnaView& v, Arena& a) { network(v).layers = too_many<NetworkLayer>(a); }},
    {"LodNetwork", kReference, "mlbh.lodNeuralNetworkMapping.indices[0]",
     [](DnaView& v, Arena& a) { v.mlbh.lod_networks.indices[0] = be(a, U16{1}); }},
    {"NetworkInput", kReference, "mlbh.neuralNetworks[0].inputIndices",
     [](DnaView& v, Arena& a) {
       network(v).input_indices = be(a, U16{0, 11});
     }},
    {"NetworkOutput", kReference, "mlbh.neuralNetworks[0].outputIndices",
     [](DnaView& v, Arena& a) {
       network(v).output_indices = be(a, U16{5, 6, 7, 11});
     }},
    {"WeightsFirst", kStructure, "mlbh.neuralNetworks[0].layers[0].weights",
     [](DnaView& v, Arena& a) {
       network(v).layers[0].weights = be(a, F32{1, 2, 3, 4, 5});
     }},
    {"WeightsChain", kStructure, "mlbh.neuralNetworks[0].layers[1].weights",
     [](DnaView& v, Arena& a) {
       network(v).layers[1].weights = be(a, F32{1, 2, 3, 4, 5, 6, 7, 8});
     }},
    {"WeightsWithoutBiases", kStructure, "mlbh.neuralNetworks[0].layers[0].weights",
     [](DnaView& v, Arena&) { network(v).layers[0].biases = {}; }},
    {"WeightsAlone", kStructure, "mlbh.neuralNetworks[0].layers[0].weights",
     [](DnaView& v, Arena& a) {
       v.mlbe = {};
       network(v).layers[0].weights = be(a, F32{1, 2, 3});  // fits one input, but there are two
     }},
    {"OutputsAlone", kStructure, "mlbh.neuralNetworks[0].outputIndices",
     [](DnaView& v, Arena& a) {
       v.mlbe = {};
       network(v).output_indices = be(a, U16{5, 6, 7, 8, 5});
     }},
    {"OutputsWithoutLayers", kStructure, "mlbh.neuralNetworks[0].outputIndices",
     [](DnaView& v, Arena&) {
       v.mlbe = {};
       network(v).layers = {};
     }},
    {"Activation", kWarning, "mlbh.neuralNetworks[0].layers[1].functionId",
     [](DnaView& v, Arena&) { network(v).layers[1].function_id = 5; }},
    {"LeakyRelu", kWarning, "mlbh.neuralNetworks[0].layers[0].parameters",
     [](DnaView& v, Arena&) { network(v).layers[0].parameters = {}; }},
    {"BiasNan", kWarning, "mlbh.neuralNetworks[0].layers[1].biases",
     [](DnaView& v, Arena& a) {
       network(v).layers[1].biases = be(a, F32{0, 0, 0, kNan});
     }},
    {"WeightNan", kWarning, "mlbh.neuralNetworks[0].layers[0].weights",
     [](DnaView& v, Arena& a) {
       network(v).layers[0].weights = be(a, F32{1, 2, 3, 4, 5, -kInfinity});
     }},
    {"SlopeNan", kWarning, "mlbh.neuralNetworks[0].layers[0].parameters",
     [](DnaView& v, Arena& a) { network(v).layers[0].parameters = be(a, F32{kNan}); }},
    {"RegionMeshes", kStructure, "mlbh.neuralNetworkToMeshRegion.regionNames",
     [](DnaView& v, Arena&) {
       v.defn.mesh_names = {}, v.defn.lod_meshes = {}, v.defn.mesh_channels = {};
     }},
    {"RegionLists", kStructure, "mlbh.neuralNetworkToMeshRegion.indices",
     [](DnaView& v, Arena&) { v.mlbh.mesh_regions.indices = {}; }},
    {"RegionCount", kStructure, "mlbh.neuralNetworkToMeshRegion.indices[0]",
     [](DnaView& v, Arena&) { v.mlbh.mesh_regions.region_names[0] = {}; }},
    {"RegionNetwork", kReference, "mlbh.neuralNetworkToMeshRegion.indices[0][0]",
     [](DnaView& v, Arena& a) { v.mlbh.mesh_regions.indices[0][0] = be(a, U16{1}); }},
    {"MissingLodNetworks", kWarning, "mlbh.lodNeuralNetworkMapping.lods",
     [](DnaView& v, Arena&) {
       v.mlbe = {};
       v.mlbh.lod_networks = {};
     }},

    {"TooManySets", kLimit, "mlbe.mlbTypeData[0].operations",
     [](DnaView& v, Arena& a) { v.mlbe.types[0].operations = too_many<List<MlOperation>>(a); }},
    {"TooManyOperations", kLimit, "mlbe.mlbTypeData[0].operations[0]",
     [](DnaView& v, Arena& a) { v.mlbe.types[0].operations[0] = too_many<MlOperation>(a); }},
    {"LodOperation", kReference, "mlbe.mlbTypeData[0].lodMLOperationMappings[1].indices[0]",
     [](DnaView& v, Arena& a) { v.mlbe.types[0].lod_operations[1].indices[0] = be(a, U16{1}); }},
    {"OperationSets", kStructure, "mlbe.mlbTypeData[0].lodMLOperationMappings",
     [](DnaView& v, Arena&) { v.mlbe.types[0].lod_operations.count = 2; }},
    {"DependencyLengths", kStructure,
     "mlbe.mlbTypeData[0].operations[1][0].mlOperationDependencyIndices",
     [](DnaView& v, Arena&) { operation(v, 1).operation_dependencies = {}; }},
    {"DependencySet", kReference,
     "mlbe.mlbTypeData[0].operations[1][0].mlOperationSetDependencyIndices",
     [](DnaView& v, Arena& a) { operation(v, 1).set_dependencies = be(a, U16{3}); }},
    {"DependencyOnSameSet", kValue,
     "mlbe.mlbTypeData[0].operations[1][0].mlOperationSetDependencyIndices",
     [](DnaView& v, Arena& a) { operation(v, 1).set_dependencies = be(a, U16{1}); }},
    {"DependencyOnLaterSet", kValue,
     "mlbe.mlbTypeData[0].operations[1][0].mlOperationSetDependencyIndices",
     [](DnaView& v, Arena& a) { operation(v, 1).set_dependencies = be(a, U16{2}); }},
    {"DependencyOperation", kReference,
     "mlbe.mlbTypeData[0].operations[2][0].mlOperationDependencyIndices",
     [](DnaView& v, Arena& a) { operation(v, 2).operation_dependencies = be(a, U16{1}); }},
    {"GatherControl", kReference, "mlbe.mlbTypeData[0].operations[0][0].parameters",
     [](DnaView& v, Arena& a) {
       operation(v, 0).parameters = be(a, U32{0, 11});
     }},
    {"ScatterControl", kReference, "mlbe.mlbTypeData[0].operations[2][0].parameters",
     [](DnaView& v, Arena& a) {
       operation(v, 2).parameters = be(a, U32{5, 6, 7, 65541});
     }},
    {"MlpWithoutNetwork", kStructure, "mlbe.mlbTypeData[0].operations[1][0].parameters",
     [](DnaView& v, Arena&) { operation(v, 1).parameters = {}; }},
    {"MlpNetwork", kReference, "mlbe.mlbTypeData[0].operations[1][0].parameters",
     [](DnaView& v, Arena& a) { operation(v, 1).parameters = be(a, U32{1}); }},
    {"MlpLimits", kStructure, "mlbe.mlbTypeData[0].operations[1][0].parameters",
     [](DnaView& v, Arena& a) {
       operation(v, 1).parameters = be(a, U32{0, 3, 3, 4});
     }},
    {"MlpLimitTooLarge", kStructure, "mlbe.mlbTypeData[0].operations[1][0].parameters",
     [](DnaView& v, Arena& a) {
       operation(v, 1).parameters = be(a, U32{0, 3, 4, 4, 4});
     }},
    {"MlpWidth", kStructure, "mlbe.mlbTypeData[0].operations[1][0].parameters",
     [](DnaView& v, Arena& a) {
       operation(v, 0).parameters = be(a, U32{0, 1, 2});
     }},
    {"SumWithoutParameters", kStructure, "mlbe.mlbTypeData[0].operations[2][0].parameters",
     [](DnaView& v, Arena&) {
       operation(v, 2).type = 4;
       operation(v, 2).parameters = {};
     }},
    {"SumWeights", kStructure, "mlbe.mlbTypeData[0].operations[2][0].parameters",
     [](DnaView& v, Arena& a) {
       operation(v, 2).type = 4;
       operation(v, 2).parameters = be(a, U32{4});
     }},
    {"SumWidth", kStructure, "mlbe.mlbTypeData[0].operations[2][0].parameters",
     [](DnaView& v, Arena& a) {
       operation(v, 2).type = 4;
       operation(v, 2).parameters = be(a, U32{5, 0x3f800000});
     }},
    {"SumNan", kWarning, "mlbe.mlbTypeData[0].operations[2][0].parameters",
     [](DnaView& v, Arena& a) {
       operation(v, 2).type = 4;
       operation(v, 2).parameters = be(a, U32{4, 0x7fc00000});
     }},
    {"OperationType", kWarning, "mlbe.mlbTypeData[0].operations[2][0].operationType",
     [](DnaView& v, Arena&) { operation(v, 2).type = 5; }},

    {"MlJointInput", kReference, "mlbe.mlbJoints.inputIndices",
     [](DnaView& v, Arena& a) {
       v.mlbe.joints.input_indices = be(a, U16{5, 6, 7, 11});
     }},
    {"MlJointValue", kReference, "mlbe.mlbJoints.outputIndices",
     [](DnaView& v, Arena& a) {
       v.mlbe.joints.output_indices = be(a, U16{23, 24, 25, 30});
     }},
    {"MlJointLengths", kStructure, "mlbe.mlbJoints.outputIndices",
     [](DnaView& v, Arena& a) {
       v.mlbe.joints.output_indices = be(a, U16{23, 24, 25});
     }},
    {"MlJointKeys", kStructure, "mlbe.mlbJoints.parameterValues",
     [](DnaView& v, Arena& a) {
       v.mlbe.joints.parameter_values = be(a, U16{0, 1});
     }},
    {"MlJointWithoutKeys", kValue, "mlbe.mlbJoints.outputIndices",
     [](DnaView& v, Arena&) {
       v.mlbe.joints.parameter_keys = v.mlbe.joints.parameter_values = {};
     }},
    {"MlJointRotation", kValue, "mlbe.mlbJoints.parameterValues[1]",
     [](DnaView& v, Arena& a) {
       v.mlbe.joints.parameter_values = be(a, U16{0, 2, 0});
     }},
    {"MlJointKeyTwice", kValue, "mlbe.mlbJoints.parameterKeys",
     [](DnaView& v, Arena& a) {
       v.mlbe.joints.parameter_keys = be(a, U16{0, 1, 1});
     }},
    {"MlJointUnknownKey", kWarning, "mlbe.mlbJoints.parameterKeys",
     [](DnaView& v, Arena& a) {
       v.mlbe.joints.parameter_keys = be(a, U16{0, 1, 2, 10});
       v.mlbe.joints.parameter_values = be(a, U16{0, 1, 0, 0});
     }},
    {"MlJointScale", kValue, "mlbe.mlbJoints.parameterValues[3]",
     [](DnaView& v, Arena& a) {
       v.mlbe.joints.parameter_keys = be(a, U16{0, 1, 2, 0x8000});
       v.mlbe.joints.parameter_values = be(a, U16{0, 1, 0, 2});
     }},
    {"MlJointScaleTwice", kValue, "mlbe.mlbJoints.parameterKeys",
     [](DnaView& v, Arena& a) {
       v.mlbe.joints.parameter_keys = be(a, U16{0, 1, 2, 0x8000, 0x8000});
       v.mlbe.joints.parameter_values = be(a, U16{0, 1, 0, 1, 1});
     }},
};

class DnaCheckExtensions : public testing::TestWithParam<Damage> {};
TEST_P(DnaCheckExtensions, FindsIt) { expect_found(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Solver, DnaCheckExtensions, testing::ValuesIn(kSolverCases), damage_name);
INSTANTIATE_TEST_SUITE_P(Network, DnaCheckExtensions, testing::ValuesIn(kNetworkCases),
                         damage_name);

// Names of ML and RBF controls count twice: as names, and among all controls.
// Representations, directions of axes and the sequence become enumerations and places in tables.
TEST(DnaCheckExtensionsTest, ValuesOfMlJointsAreInRange) {
  // Signs, keys 6 to 8, may be anything: evaluation takes what is not 1 for -1.
  const uint16_t last[10] = {0, 1, 0, 5, 5, 5, 65535, 65535, 65535, 5};
  for (uint32_t key = 0; key < 10; ++key) {
    for (uint32_t value = 0; value <= last[key] + 1u && value <= 65535;
         value += last[key] > 5 ? 13107 : 1) {
      Arena arena(default_allocator());
      DnaView view = tiny_rig(arena);
      MlJoints& joints = view.mlbe.joints;
      joints.parameter_keys = be(arena, U16{0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
      const NewArray<uint16_t> values = new_array<uint16_t>(arena, 10);
      for (uint32_t k = 0; k < 10; ++k) values.set(k, k == 1 || k == 3);
      values.set(key, static_cast<uint16_t>(value));
      joints.parameter_values = values;
      joints.output_indices = joints.input_indices = {};
      KeptFindings report;
      check(view, report, false);
      const std::string field = "mlbe.mlbJoints.parameterValues[" + std::to_string(key) + "]";
      EXPECT_EQ(report.has(kValue, field), value > last[key]) << value << "\n" << report.text();
      EXPECT_EQ(report.errors(), value > last[key]);
    }
  }
}

// Of those that a network depends on, gathers come first: others count where nothing is gathered.
TEST(DnaCheckExtensionsTest, NetworksTakeWhatIsGathered) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  operation(view, 2) =
      operation(view, 1);  // of two inputs; the network before it gives four values
  operation(view, 2).set_dependencies = be(arena, U16{1, 0});
  operation(view, 2).operation_dependencies = be(arena, U16{0, 0});
  KeptFindings report;
  EXPECT_TRUE(check(view, report, false));
  EXPECT_EQ(report.errors(), 0u) << report.text();
  operation(view, 2).set_dependencies = be(arena, U16{1});
  operation(view, 2).operation_dependencies = be(arena, U16{0});
  check(view, report, false);
  EXPECT_TRUE(report.has(kStructure, "mlbe.mlbTypeData[0].operations[2][0].parameters"));
}

// What is wrong itself gives nothing to those that depend on it.
TEST(DnaCheckExtensionsTest, SumsOfWhatGivesNothing) {
  const auto expect = [](uint16_t type, U32 parameters) {
    Arena arena(default_allocator());
    DnaView view = tiny_rig(arena);
    operation(view, 1).type = type;
    operation(view, 1).parameters = be(arena, parameters);
    operation(view, 2).type = 4;
    operation(view, 2).parameters = be(arena, U32{1, 0x3f800000});
    KeptFindings report;
    check(view, report, true);
    EXPECT_TRUE(report.has(kStructure, "mlbe.mlbTypeData[0].operations[2][0].parameters"))
        << report.text();
  };
  expect(4, {});   // a sum
  expect(3, {});   // a network without its number
  expect(3, {1});  // one that is not there
}

TEST(DnaCheckExtensionsTest, TooManyControlNames) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  view.mlbh.control_names = too_many<String>(arena);
  view.rbfe.pose_control_names = too_many<String>(arena);
  KeptFindings report;
  check(view, report, true);
  EXPECT_TRUE(report.has(kLimit, "mlbh.mlControlNames")) << report.text();
  EXPECT_TRUE(report.has(kLimit, "rbfe.poseControlNames")) << report.text();
  EXPECT_TRUE(report.has(kLimit, "bhvr.controls.psdCount")) << report.text();
}

// What is allowed -------------------------------------------------------------------------------

TEST(DnaCheckExtensionsTest, DistancesOfRotationsTakeFourControls) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  RbfSolver& rotations = solver(view);
  rotations.distance_method = 1;
  rotations.raw_control_indices = be(arena, U16{0, 1, 2, 0});
  const NewArray<float> values = new_array<float>(arena, 4 * rotations.pose_indices.count);
  for (uint32_t i = 0; i < values.count; ++i) values.set(i, i % 4 == 3 ? 1.0f : 0.0f);
  rotations.raw_control_values = values;
  expect_no_findings(view);
}

TEST(DnaCheckExtensionsTest, NetworksMayStandAlone) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  view.mlbe = {};
  expect_no_findings(view);
  // More values than wanted are left over.
  network(view).output_indices = be(arena, U16{5, 6, 7});
  expect_no_findings(view);
}

TEST(DnaCheckExtensionsTest, OperationsMayMakeNetworkLodsNeedless) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  view.mlbh.lod_networks = {};
  expect_no_findings(view);
}

TEST(DnaCheckExtensionsTest, WeightedSumOfGatheredAndComputed) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  MlOperation& sum = operation(view, 2);
  sum.type = static_cast<uint16_t>(MlOperationType::kWeightedSum);
  sum.set_dependencies = be(arena, U16{0, 1});
  sum.operation_dependencies = be(arena, U16{0, 0});
  sum.parameters = be(arena, U32{2, 0x3f800000, 0x3f000000});  // the first two of each, 1 and 0.5
  expect_no_findings(view);
  sum.parameters = be(arena, U32{3, 0x3f800000, 0x3f000000});  // the gather gives two only
  KeptFindings report;
  check(view, report, true);
  EXPECT_TRUE(report.has(kStructure, "mlbe.mlbTypeData[0].operations[2][0].parameters"));
}

}  // namespace
}  // namespace mien::dna
