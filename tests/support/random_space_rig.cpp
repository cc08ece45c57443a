// SPDX-License-Identifier: MIT
#include "tests/support/random_space_rig.h"

#include <string>
#include <vector>

#include "tests/support/tiny_rig.h"

namespace mien::dna {
namespace {

constexpr uint32_t kJoints = 9, kLods = 2;
constexpr uint32_t kRaw = kSpaceRigPlainControls + 4 * kSpaceRigQuaternions;
constexpr uint32_t kPsds = 2, kMl = 20, kPoses = 3, kSolvers = 4;
constexpr uint32_t kFirstPsd = kRaw, kFirstMl = kFirstPsd + kPsds, kFirstRbf = kFirstMl + kMl;

// Joints 0 ... 4: rows. 5, 6: twist and swing. 7, 8: networks.
constexpr uint32_t kRowJoints = 5, kTwistJoint = 5, kSwingJoint = 6, kMlJoint = 7;

struct Builder {
  Random& random;
  const SpaceRigOptions& options;
  Arena& arena;
  DnaView view = {};

  template <class T>
  Array<T> numbers(const std::vector<T>& from) {
    const NewArray<T> array = new_array<T>(arena, from.size());
    for (size_t i = 0; i < from.size(); ++i) array.set(i, from[i]);
    return array;
  }
  template <class T>
  List<T> items(const std::vector<T>& from) {
    const Span<T> span = arena.array<T>(from.size());
    for (size_t i = 0; i < from.size(); ++i) span[i] = from[i];
    return {span.data, static_cast<uint32_t>(span.count)};
  }
  String name(const std::string& from) {
    uint8_t* chars = static_cast<uint8_t*>(arena.allocate(from.size(), 1));
    memcpy(chars, from.data(), from.size());
    return {chars, static_cast<uint32_t>(from.size())};
  }
  List<String> names(const char* stem, uint32_t count) {
    std::vector<String> all;
    for (uint32_t i = 0; i < count; ++i) all.push_back(name(stem + std::to_string(i)));
    return items(all);
  }
  LodMap everywhere(uint32_t count) {
    std::vector<uint16_t> all;
    for (uint32_t i = 0; i < count; ++i) all.push_back(static_cast<uint16_t>(i));
    return {numbers<uint16_t>({0, 0}), items<Array<uint16_t>>({numbers(all)})};
  }
  float between(double low, double high) { return static_cast<float>(random.between(low, high)); }
  Array<float> floats(size_t count, double low, double high) {
    std::vector<float> all(count);
    for (float& value : all) value = between(low, high);
    return numbers(all);
  }
  uint16_t quaternion(uint32_t number, uint32_t part) const {
    return static_cast<uint16_t>(kSpaceRigPlainControls + 4 * number + part);
  }
  Array<uint16_t> quaternion(uint32_t number) {
    return numbers<uint16_t>({quaternion(number, 0), quaternion(number, 1), quaternion(number, 2),
                              quaternion(number, 3)});
  }
  double unit() const { return view.desc.rotation_unit == 0 ? 57.29577951308232 : 1.0; }

  void make_descriptor() {
    const CoordinateSystem system = random_system(random);
    view.loaded = kLayersAll;
    std::vector<IndexEntry> index;
    for (const LayerKind& kind : kLayerKinds) {
      index.push_back({kind.code, kind.layer_version, nullptr, 0});
    }
    view.index = items(index);
    view.desc.coordinate_system = {static_cast<uint16_t>(system.axes[0]),
                                   static_cast<uint16_t>(system.axes[1]),
                                   static_cast<uint16_t>(system.axes[2])};
    view.desc.translation_unit = static_cast<uint16_t>(system.translation_unit);
    view.desc.rotation_unit = static_cast<uint16_t>(system.rotation_unit);
    view.desc.lod_count = kLods;
    view.dsce.rotation_sequence = system.rotation_sequence;
    view.dsce.rotation_sign = {system.rotation_signs[0], system.rotation_signs[1],
                               system.rotation_signs[2]};
    view.dsce.face_winding_order = static_cast<uint8_t>(system.face_winding);
  }

  void make_definition() {
    Definition& d = view.defn;
    d.lod_joints = everywhere(kJoints);
    d.lod_channels = everywhere(1);
    d.lod_maps = everywhere(2);
    d.lod_meshes = everywhere(1);
    std::vector<String> raw;
    for (uint32_t i = 0; i < kSpaceRigPlainControls; ++i)
      raw.push_back(name("c" + std::to_string(i)));
    for (uint32_t q = 0; q < kSpaceRigQuaternions; ++q) {
      for (const char* part : {".qx", ".qy", ".qz", ".qw"}) {
        raw.push_back(name("driver" + std::to_string(q) + part));
      }
    }
    d.raw_control_names = items(raw);
    d.gui_control_names = names("gui", 1);
    d.joint_names = names("joint", kJoints);
    d.channel_names = names("channel", 1);
    d.map_names = names("map", 2);
    d.mesh_names = names("mesh", 1);
    d.joint_hierarchy = numbers(std::vector<uint16_t>(kJoints, 0));
    d.neutral_translations = {floats(kJoints, -9, 9), floats(kJoints, -9, 9),
                              floats(kJoints, -9, 9)};
    const double most = unit();
    d.neutral_rotations = {floats(kJoints, -most, most), floats(kJoints, -most, most),
                           floats(kJoints, -most, most)};
  }

  void make_controls() {
    Controls& c = view.bhvr.controls;
    c.psd_count = kPsds;
    c.conditionals = {numbers<uint16_t>({0}), numbers<uint16_t>({0}), numbers<float>({0}),
                      numbers<float>({1}),    numbers<float>({1}),    numbers<float>({0})};
    // w never changes its sign, so a corrective may read it.
    c.psds = {numbers<uint16_t>({kFirstPsd, kFirstPsd, kFirstPsd + 1, kFirstPsd + 1}),
              numbers<uint16_t>({0, 1, 2, quaternion(0, 3)}), numbers<float>({1, 1, 1, 0.5f})};
  }

  // Rows in any order, some missing; the first group gives joints what the second one does not.
  void make_groups() {
    std::vector<JointRepresentation> representations(kJoints);
    for (uint32_t j = 0; j < kRowJoints; ++j) {
      const bool turns = !options.euler_rows || random.chance(0.4);
      representations[j].rotation = turns ? 1 : 0;
    }
    view.jbmd.joints = items(representations);
    std::vector<JointGroup> groups;
    const uint32_t limits[] = {0, 2, kRowJoints};
    for (uint32_t g = 0; g < 2; ++g) {
      std::vector<uint16_t> inputs, outputs;
      for (uint32_t j = limits[g]; j < limits[g + 1]; ++j) {
        // Rows of a joint lie next to each other, so that LODs keep or drop its rotation as a
        // whole.
        std::vector<uint16_t> own;
        for (uint32_t k = 0; k < 9; ++k) {
          if (random.chance(0.75)) own.push_back(static_cast<uint16_t>(9 * j + k));
        }
        for (size_t i = own.size(); i > 1; --i) {
          std::swap(own[i - 1], own[random.below(static_cast<uint32_t>(i))]);
        }
        outputs.insert(outputs.end(), own.begin(), own.end());
      }
      for (uint16_t c = 0; c < kSpaceRigPlainControls; ++c) inputs.push_back(c);
      inputs.push_back(kFirstPsd);
      inputs.push_back(kFirstPsd + 1);
      for (uint16_t p = 0; p < kPoses; ++p) inputs.push_back(static_cast<uint16_t>(kFirstRbf + p));
      const size_t plain = inputs.size();
      for (uint32_t part = 0; part < 4; ++part) inputs.push_back(quaternion(1, part));
      std::vector<float> values;
      size_t coarse = 0;
      for (size_t r = 0; r < outputs.size(); ++r) {
        const uint32_t k = outputs[r] % 9;
        const double most = k < 3 ? 5 : k < 6 ? 0.3 * unit() : 0.3;
        for (size_t c = 0; c < inputs.size(); ++c) {
          // A column that changes its sign may not turn by quaternions.
          const bool turns = k >= 3 && k < 6 && representations[outputs[r] / 9].rotation == 1;
          const bool may = c < plain || !turns;
          values.push_back(may && random.chance(0.6) ? between(-most, most) : 0.0f);
        }
        const bool cut = r + 1 == outputs.size() || outputs[r + 1] / 9 != outputs[r] / 9;
        if (cut && random.chance(0.5)) coarse = r + 1;
      }
      groups.push_back({numbers<uint16_t>(
                            {static_cast<uint16_t>(outputs.size()), static_cast<uint16_t>(coarse)}),
                        numbers(inputs),
                        numbers(outputs),
                        numbers(values),
                        {}});
    }
    view.bhvr.joints.row_count = 9 * kJoints;
    view.bhvr.joints.col_count = kFirstRbf + kPoses;
    view.bhvr.joints.groups = items(groups);
  }

  void make_channels_and_maps() {
    view.bhvr.channels = {numbers<uint16_t>({1, 1}), numbers<uint16_t>({quaternion(2, 3)}),
                          numbers<uint16_t>({0})};
    view.bhvr.maps.lods = numbers<uint16_t>({3, 3});
    view.bhvr.maps.conditionals = {
        numbers<uint16_t>({quaternion(0, 0), quaternion(0, 1), quaternion(1, 2)}),
        numbers<uint16_t>({0, 0, 1}),
        numbers<float>({-1, 0.5f, -0.5f}),
        numbers<float>({0, -0.25f, 1}),
        numbers<float>({-0.5f, 0.75f, 0.5f}),
        numbers<float>({0.1f, 0.2f, 0.25f})};
  }

  // One solver for each distance; the plain one reads part of a quaternion too.
  void make_solvers() {
    std::vector<RbfSolver> solvers(kSolvers);
    for (uint32_t s = 0; s < kSolvers; ++s) {
      RbfSolver& solver = solvers[s];
      solver.name = name("solver" + std::to_string(s));
      solver.raw_control_indices =
          s == 0 ? numbers<uint16_t>({3, quaternion(0, 1), quaternion(2, 0)}) : quaternion(s - 1);
      const uint32_t poses = kPoses, inputs = solver.raw_control_indices.count;
      solver.pose_indices = numbers<uint16_t>({0, 1, 2});
      solver.raw_control_values = floats(size_t{poses} * inputs, -1, 1);
      solver.radius = static_cast<float>(0.9 * unit());
      solver.solver_type = static_cast<uint16_t>(random.below(2));
      solver.automatic_radius = static_cast<uint16_t>(random.below(2));
      solver.distance_method = static_cast<uint16_t>(s);
      solver.normalize_method = static_cast<uint16_t>(random.below(2));
      solver.function_type = static_cast<uint16_t>(random.below(5));
      solver.twist_axis = static_cast<uint16_t>(random.below(3));
    }
    view.rbfb.solvers = items<RbfSolver>({solvers[random.below(kSolvers)]});
    view.rbfb.lod_solvers = everywhere(1);
    std::vector<RbfPose> poses;
    std::vector<RbfPoseControls> controls;
    for (uint32_t p = 0; p < kPoses; ++p) {
      poses.push_back({name("pose" + std::to_string(p)), 1.0f});
      RbfPoseControls c;
      if (p != 0) c.input_control_indices = numbers<uint16_t>({quaternion(0, p), quaternion(1, 0)});
      c.output_control_indices = numbers<uint16_t>({static_cast<uint16_t>(kFirstRbf + p)});
      c.output_control_weights = numbers<float>({between(-1, 1)});
      controls.push_back(c);
    }
    view.rbfb.poses = items(poses);
    view.rbfe.pose_control_names = names("pose", kPoses);
    view.rbfe.poses = items(controls);
  }

  void make_setups() {
    const uint16_t axis = static_cast<uint16_t>(random.below(3));
    const uint32_t other = random.below(2);  // of the twist's own quaternion, or the swing's
    view.twsw.twists =
        items<Twist>({{numbers<float>({between(0, 1)}), numbers<uint16_t>({kTwistJoint}),
                       quaternion(other), static_cast<uint16_t>(random.below(3))}});
    view.twsw.swings = items<Swing>(
        {{numbers<float>({between(0, 1)}), numbers<uint16_t>({kSwingJoint}), quaternion(1), axis}});
  }

  // One network moves both ML joints. Its inputs are plain controls and a quaternion; the first ten
  // outputs go to one joint, the others to the other.
  void make_networks() {
    const uint32_t rotation = random.below(2);  // Euler angles or quaternions
    const uint32_t parts = rotation == 1 ? 4 : 3, each = 6 + parts, count = 2 * each;
    std::vector<uint16_t> inputs = {0, 4, 5}, outputs, joints;
    for (uint32_t part = 0; part < 4; ++part) inputs.push_back(quaternion(2, part));
    for (uint32_t i = 0; i < count; ++i) {
      outputs.push_back(static_cast<uint16_t>(kFirstMl + i));
      joints.push_back(static_cast<uint16_t>(kMlJoint * each + i));
    }
    NetworkLayer hidden, last;
    hidden.biases = floats(5, -0.3, 0.3);
    hidden.weights = floats(5 * inputs.size(), -1, 1);
    hidden.function_id = static_cast<uint16_t>(random.below(5));
    hidden.parameters = numbers<float>({0.1f});
    std::vector<float> weights;
    for (uint32_t r = 0; r < count; ++r) {
      const bool angle = rotation == 0 && r % each >= 3 && r % each < 6;
      const double most = angle ? 1.5 * unit() : 0.5;  // beyond a quarter turn too
      for (uint32_t c = 0; c < 5; ++c) weights.push_back(between(-most, most));
    }
    last.biases = floats(count, -0.2, 0.2);
    last.weights = numbers(weights);
    NeuralNetwork network;
    network.input_indices = numbers(inputs);
    network.output_indices = numbers(outputs);
    network.layers = items<NetworkLayer>({hidden, last});

    MachineLearnedBehavior& ml = view.mlbh;
    ml.control_names = names("ml", kMl);
    view.ml_control_count = kMl;
    ml.lod_networks = everywhere(1);
    ml.mesh_regions.region_names = items<List<String>>({names("region", 1)});
    ml.mesh_regions.indices =
        items<List<Array<uint16_t>>>({items<Array<uint16_t>>({numbers<uint16_t>({0})})});
    ml.networks = items<NeuralNetwork>({network});

    if (random.chance(0.5)) make_operations(inputs, outputs);
    MlJoints& to = view.mlbe.joints;
    std::vector<uint16_t> keys = {0, 1, 2}, values = {0, static_cast<uint16_t>(rotation), 0};
    if (random.chance(0.5)) {  // in a system of their own
      const CoordinateSystem own = random_system(random);
      for (uint16_t i = 0; i < 3; ++i) {
        keys.push_back(3 + i);
        values.push_back(static_cast<uint16_t>(own.axes[i]));
      }
      for (uint16_t i = 0; i < 3; ++i) {
        keys.push_back(6 + i);
        values.push_back(static_cast<uint16_t>(own.rotation_signs[i]));
      }
      keys.push_back(9);
      values.push_back(static_cast<uint16_t>(own.rotation_sequence));
    }
    to.parameter_keys = numbers(keys);
    to.parameter_values = numbers(values);
    to.input_indices = numbers(outputs);
    to.output_indices = numbers(joints);
  }

  void make_operations(const std::vector<uint16_t>& inputs, const std::vector<uint16_t>& outputs) {
    const auto wide = [&](const std::vector<uint16_t>& from) {
      return numbers(std::vector<uint32_t>(from.begin(), from.end()));
    };
    const auto operation = [](MlOperationType type, Array<uint32_t> parameters) {
      MlOperation o;
      o.type = static_cast<uint16_t>(type);
      o.parameters = parameters;
      return o;
    };
    MlOperation gather = operation(MlOperationType::kGather, wide(inputs));
    MlOperation run = operation(MlOperationType::kMlp, wide({0}));
    MlOperation scatter = operation(MlOperationType::kScatter, wide(outputs));
    run.set_dependencies = run.operation_dependencies = numbers<uint16_t>({0});
    scatter.set_dependencies = numbers<uint16_t>({1});
    scatter.operation_dependencies = numbers<uint16_t>({0});
    MlType type;
    type.operations = items<List<MlOperation>>(
        {items<MlOperation>({gather}), items<MlOperation>({run}), items<MlOperation>({scatter})});
    type.lod_operations = items<LodMap>({everywhere(1), everywhere(1), everywhere(1)});
    view.mlbe.types = items<MlType>({type});
  }

  void make_mesh() {
    Mesh m;
    m.positions = {floats(4, -9, 9), floats(4, -9, 9), floats(4, -9, 9)};
    m.normals = {floats(4, -1, 1), floats(4, -1, 1), floats(4, -1, 1)};
    m.texture_coordinates = {floats(4, 0, 1), floats(4, 0, 1)};
    const Array<uint32_t> same = numbers<uint32_t>({0, 1, 2, 3});
    m.layouts = {same, same, same};
    m.faces = items<Face>({{same}, {numbers<uint32_t>({2, 1, 0})}});
    m.maximum_influence_per_vertex = 1;
    m.skin_weights =
        items(std::vector<VertexSkinWeights>(4, {numbers<float>({1}), numbers<uint16_t>({0})}));
    m.blend_shape_targets = items<BlendShapeTarget>(
        {{{floats(2, -1, 1), floats(2, -1, 1), floats(2, -1, 1)}, numbers<uint32_t>({0, 3}), 0}});
    view.geom.meshes = items<Mesh>({m});
    view.defn.mesh_channels = {numbers<uint16_t>({0}), numbers<uint16_t>({0})};
  }
};

}  // namespace

CoordinateSystem random_system(Random& random) {
  CoordinateSystem system;
  uint32_t lines[3] = {0, 1, 2};
  for (uint32_t i = 3; i > 1; --i) std::swap(lines[i - 1], lines[random.below(i)]);
  for (int i = 0; i < 3; ++i) {
    system.axes[i] = 2 * lines[i] + random.below(2);
    system.rotation_signs[i] = random.chance(0.5) ? 1 : -1;
  }
  system.translation_unit = random.below(2);
  system.rotation_unit = random.below(2);
  system.rotation_sequence = random.below(6);
  system.face_winding = random.below(2);
  return system;
}

DnaView random_space_rig(Random& random, const SpaceRigOptions& options, Arena& arena) {
  Builder builder{random, options, arena};
  builder.make_descriptor();
  builder.make_definition();
  builder.make_controls();
  builder.make_groups();
  builder.make_channels_and_maps();
  if (options.networks) {
    builder.make_networks();
  } else {
    builder.view.mlbh.control_names = builder.names("ml", kMl);
    builder.view.ml_control_count = kMl;
  }
  builder.make_solvers();
  builder.make_setups();
  builder.make_mesh();
  return builder.view;
}

}  // namespace mien::dna
