// SPDX-License-Identifier: MIT
// Files that are right in form and ask for too much: memory and time stay in proportion to the
// file, and no buffer is smaller than what is put into it.
#include <gtest/gtest.h>

#include "tests/support/cpu_time.h"
#include "tests/support/dna_bytes.h"
#include "tests/support/exercise_dna.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

Life expect_life(const Bytes& file, const std::string& what, const LifeOptions& options = {}) {
  const Life life = live(file.data(), file.size(), options);
  EXPECT_EQ(life.broken, "") << what;
  const double size = double(file.size());
  printf("%s: %zu bytes, %.1f x to open, %.1f x for a rig and its instance\n", what.c_str(),
         file.size(), double(life.open_peak) / size, double(life.rig_peak) / size);
  return life;
}

// Memory ---------------------------------------------------------------------------------------

// The worst of each list: as many of the smallest records as the file can hold.
Bytes many_records(const char* code, Bytes front, size_t record_bytes, uint32_t count, Bytes back) {
  std::vector<dna::Layer> layers = dna::layers_of(dna::file_of(8, {}));
  dna::put32(front, count);
  front.insert(front.end(), record_bytes * count, 0);
  front.insert(front.end(), back.begin(), back.end());
  layers.push_back(dna::layer(code, front));
  return dna::file_of(8, layers);
}

TEST(HostileFilesMemory, ListsOfTheSmallestRecords) {
  const struct {
    const char* code;
    size_t front_zeros, record_bytes, back_zeros;
    const char* what;
  } lists[] = {
      {"defn", 4, 4, 84, "LOD rows"},
      {"defn", 32, 4, 56, "names"},
      {"bhvr", 42, 20, 40, "joint groups"},
      {"geom", 0, 4 + 58, 0, "meshes with a size of 0"},
      {"mlbh", 0, 4, 20, "ML control names"},
      {"mlbh", 12, 4, 8, "meshes with regions"},
      {"mlbh", 20, 4 + 12, 0, "networks with a size of 0"},
      {"rbfb", 8, 4 + 36, 4, "solvers with a size of 0"},
      {"rbfb", 12, 8, 0, "poses"},
      {"rbfe", 0, 4, 4, "pose names"},
      {"rbfe", 4, 12, 0, "pose controls"},
      {"jbmd", 0, 6, 0, "joint metadata"},
      {"twsw", 0, 14, 4, "twists"},
      {"twsw", 4, 14, 0, "swings"},
      {"mlbe", 0, 8, 16, "ML types"},
      {"desc", 10, 8, 26, "metadata"},
  };
  for (const auto& list : lists) {
    for (uint32_t count : {1000u, 40000u, 200000u}) {
      expect_life(many_records(list.code, Bytes(list.front_zeros), list.record_bytes, count,
                               Bytes(list.back_zeros)),
                  std::to_string(count) + " " + list.what);
    }
  }
}

// The same within a file that opens, and with LODs to be selected from.
TEST(HostileFilesMemory, LongListsOfEmptyThings) {
  using dna::DnaView;
  constexpr uint32_t kMany = 60000;
  const struct {
    const char* what;
    void (*fill)(DnaView& view, Arena& arena);
  } cases[] = {
      {"faces",
       [](DnaView& v, Arena& a) {
         v.geom.meshes[0].faces = {a.array<dna::Face>(kMany).data, kMany};
       }},
      {"targets",
       [](DnaView& v, Arena& a) {
         v.geom.meshes[0].blend_shape_targets = {a.array<dna::BlendShapeTarget>(kMany).data, kMany};
       }},
      {"vertices without weights",
       [](DnaView& v, Arena& a) {
         dna::Mesh& mesh = v.geom.meshes[0];
         const dna::NewArray<float> zeros = dna::new_array<float>(a, kMany);
         memset(zeros.data, 0, 4 * kMany);
         mesh.positions = {zeros, zeros, zeros};
         mesh.skin_weights = {a.array<dna::VertexSkinWeights>(kMany).data, kMany};
       }},
      {"LOD rows",
       [](DnaView& v, Arena& a) {
         v.defn.lod_joints.indices = {a.array<dna::Array<uint16_t>>(kMany).data, kMany};
       }},
      {"meshes",
       [](DnaView& v, Arena& a) {
         v.defn.mesh_names = {a.array<dna::String>(kMany).data, kMany};
         v.geom.meshes = {a.array<dna::Mesh>(kMany).data, kMany};
       }},
      {"joint groups",
       [](DnaView& v, Arena& a) {
         v.bhvr.joints.groups = {a.array<dna::JointGroup>(kMany).data, kMany};
       }},
      {"regions",
       [](DnaView& v, Arena& a) {
         v.mlbh.mesh_regions.region_names[0] = {a.array<dna::String>(kMany).data, kMany};
         v.mlbh.mesh_regions.indices[0] = {a.array<dna::Array<uint16_t>>(kMany).data, kMany};
       }},
      {"network layers",
       [](DnaView& v, Arena& a) {
         v.mlbe = {};
         v.mlbh.networks[0] = {};
         v.mlbh.networks[0].layers = {a.array<dna::NetworkLayer>(kMany).data, kMany};
       }},
      {"networks",
       [](DnaView& v, Arena& a) {
         v.mlbe = {};
         v.mlbh.networks = {a.array<dna::NeuralNetwork>(kMany).data, kMany};
       }},
      {"operation sets",
       [](DnaView& v, Arena& a) {
         v.mlbe.types[0].operations = {a.array<dna::List<dna::MlOperation>>(kMany).data, kMany};
         v.mlbe.types[0].lod_operations = {a.array<dna::LodMap>(kMany).data, kMany};
       }},
      {"operations",
       [](DnaView& v, Arena& a) {
         v.mlbe.types[0].operations[2] = {a.array<dna::MlOperation>(kMany).data, kMany};
       }},
      {"ML types",
       [](DnaView& v, Arena& a) {
         v.mlbe.types = {a.array<dna::MlType>(kMany).data, kMany};
       }},
      {"solvers",
       [](DnaView& v, Arena& a) {
         v.rbfb.solvers = {a.array<dna::RbfSolver>(kMany).data, kMany};
       }},
  };
  for (const auto& one : cases) {
    Arena arena(default_allocator());
    DnaView view = dna::tiny_rig(arena);
    one.fill(view, arena);
    const Bytes file = dna::written(view);
    expect_life(file, one.what);
    LifeOptions options;
    options.lods = 2;
    options.validate = false;
    const Life life = expect_life(file, std::string(one.what) + ", LODs selected", options);
    EXPECT_EQ(life.opened, MIEN_OK) << one.what << ": " << life.message;
  }
}

// A rig may not take what the file does not have: a name that many things share is one name.
TEST(HostileFilesMemory, RegionsOfAMeshWithALongName) {
  Arena arena(default_allocator());
  dna::DnaView view = dna::tiny_rig(arena);
  const std::string name(20000, 'm');
  view.defn.mesh_names[0] = dna::text(name.c_str());
  constexpr uint32_t kRegions = 5000;
  view.mlbh.mesh_regions.region_names[0] = {arena.array<dna::String>(kRegions).data, kRegions};
  view.mlbh.mesh_regions.indices[0] = {arena.array<dna::Array<uint16_t>>(kRegions).data, kRegions};
  const Bytes file = dna::written(view);
  expect_life(file, "regions of a mesh with a long name");
}

// Buffers --------------------------------------------------------------------------------------

/// A network of one layer with as many outputs and no inputs.
dna::NeuralNetwork network_without_inputs(Arena& arena, uint32_t outputs) {
  dna::NetworkLayer layer;
  const dna::NewArray<float> zeros = dna::new_array<float>(arena, outputs);
  for (uint32_t i = 0; i < outputs; ++i) zeros.set(i, 0);
  layer.biases = zeros;
  dna::NeuralNetwork network;
  network.layers = dna::list<dna::NetworkLayer>(arena, {layer});
  return network;
}

dna::Array<uint16_t> repeated(Arena& arena, uint32_t count, uint16_t value) {
  const dna::NewArray<uint16_t> array = dna::new_array<uint16_t>(arena, count);
  for (uint32_t i = 0; i < count; ++i) array.set(i, value);
  return array;
}

// Without names of pose controls any control number passes, so the row has to have room for it.
TEST(HostileFilesBuffers, PosesThatDriveControlsWithoutNames) {
  Arena arena(default_allocator());
  dna::DnaView view = dna::tiny_rig(arena);
  view.rbfe.pose_control_names = {};
  for (dna::RbfPoseControls& pose : view.rbfe.poses) {
    pose.output_control_indices = dna::be<uint16_t>(arena, {65535});
    pose.output_control_weights = dna::be<float>(arena, {1});
  }
  expect_life(dna::written(view), "poses that drive controls without names");
}

TEST(HostileFilesBuffers, InputsThatNoLayerTakes) {
  Arena arena(default_allocator());
  dna::DnaView view = dna::tiny_rig(arena);
  view.mlbe = {};
  view.mlbh.networks[0] = network_without_inputs(arena, 0);
  view.mlbh.networks[0].input_indices = repeated(arena, 5000, 0);
  expect_life(dna::written(view), "inputs that no layer takes");
}

// An operation that gathers nothing, and depends on many that give something.
TEST(HostileFilesBuffers, DependenciesThatNoLayerTakes) {
  using dna::MlOperation;
  constexpr uint32_t kMany = 5000;
  Arena arena(default_allocator());
  dna::DnaView view = dna::tiny_rig(arena);
  view.mlbe.joints = {};
  view.mlbh.networks[0] = network_without_inputs(arena, 16);

  MlOperation gather, first, second;
  gather.type = static_cast<uint16_t>(dna::MlOperationType::kGather);
  first.type = second.type = static_cast<uint16_t>(dna::MlOperationType::kMlp);
  first.parameters = second.parameters = dna::be<uint32_t>(arena, {0});
  second.set_dependencies = repeated(arena, kMany, 0);
  const dna::NewArray<uint16_t> numbers = dna::new_array<uint16_t>(arena, kMany);
  for (uint32_t i = 0; i < kMany; ++i) numbers.set(i, i == 0 ? 0 : 1);
  second.operation_dependencies = numbers;

  auto all_lods = [&](dna::Array<uint16_t> operations) {
    return dna::LodMap{dna::be<uint16_t>(arena, {0, 0}),
                       dna::list<dna::Array<uint16_t>>(arena, {operations})};
  };
  dna::MlType type;
  type.operations = dna::list<dna::List<MlOperation>>(
      arena,
      {dna::list<MlOperation>(arena, {gather, first}), dna::list<MlOperation>(arena, {second})});
  type.lod_operations = dna::list<dna::LodMap>(
      arena, {all_lods(dna::be<uint16_t>(arena, {0, 1})), all_lods(dna::be<uint16_t>(arena, {0}))});
  view.mlbe.types = dna::list<dna::MlType>(arena, {type});
  expect_life(dna::written(view), "dependencies that no layer takes");
}

// Joints that follow ML controls, where nothing computes those.
TEST(HostileFilesBuffers, JointsWithoutOperations) {
  Arena arena(default_allocator());
  dna::DnaView view = dna::tiny_rig(arena);
  view.mlbe.types = {};
  view.mlbh.networks = {};
  view.mlbh.lod_networks = {};
  view.mlbh.mesh_regions = {};
  expect_life(dna::written(view), "joints without operations");
}

// The first control of a rotation is checked where files are; that there are three more is not.
TEST(HostileFilesBuffers, RotationsThatGoOnPastTheLastControl) {
  for (const uint16_t first : {7, 8, 10}) {
    Arena arena(default_allocator());
    dna::DnaView view = dna::tiny_rig(arena);
    ASSERT_EQ(view.control_count(), 11u);
    view.mlbe.joints.input_indices = dna::be<uint16_t>(arena, {first, 6, 7, 8});
    expect_life(dna::written(view), "a rotation that goes on past the last control");
  }
}

// Time -----------------------------------------------------------------------------------------

// Half of the columns stop at LOD 0: putting the others in front of them is no quadratic affair, which
// would take 10^10 steps. Nothing counts them, so this is time of the processor, the best of three.
TEST(HostileFilesTime, ColumnsOfAQuaternionJoint) {
  constexpr uint32_t kColumns = 200000;
  Arena arena(default_allocator());
  dna::DnaView view = dna::tiny_rig(arena);
  dna::JointGroup& tongue = view.bhvr.joints.groups[1];
  const dna::NewArray<float> values = dna::new_array<float>(arena, 2 * kColumns);
  for (uint32_t c = 0; c < kColumns; ++c) {
    values.set(c, c < kColumns / 2 ? 0 : 1);
    values.set(kColumns + c, 1);
  }
  tongue.input_indices = repeated(arena, kColumns, 1);
  tongue.output_indices = dna::be<uint16_t>(arena, {21, 22});
  tongue.values = values;
  tongue.lods = dna::be<uint16_t>(arena, {2, 1});
  LifeOptions options;
  options.validate = false;
  const Bytes file = dna::written(view);
  double seconds = 3;
  for (int i = 0; i < 3 && seconds >= 3; ++i) {
    const double begin = cpu_seconds();
    expect_life(file, "columns of a quaternion joint", options);
    seconds = cpu_seconds() - begin;
  }
  EXPECT_LT(seconds, 3) << "for a file of " << file.size() << " bytes";
}

}  // namespace
}  // namespace mien
