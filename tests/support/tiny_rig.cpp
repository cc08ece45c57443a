// SPDX-License-Identifier: MIT
#include "tests/support/tiny_rig.h"

namespace mien::dna {
namespace {

struct TinyRig {
  Arena& arena;
  DnaView view;

  Array<uint16_t> indices(std::initializer_list<uint16_t> values) {
    return be<uint16_t>(arena, values);
  }
  Array<uint32_t> wide(std::initializer_list<uint32_t> values) {
    return be<uint32_t>(arena, values);
  }
  Array<float> floats(std::initializer_list<float> values) { return be<float>(arena, values); }

  List<String> names(std::initializer_list<const char*> literals) {
    const Span<String> span = arena.array<String>(literals.size());
    size_t i = 0;
    for (const char* literal : literals) span[i++] = text(literal);
    return {span.data, static_cast<uint32_t>(span.count)};
  }

  /// LOD 0 has the first list, LOD 1 the second.
  LodMap lods(std::initializer_list<uint16_t> fine, std::initializer_list<uint16_t> coarse) {
    return {indices({0, 1}), list<Array<uint16_t>>(arena, {indices(fine), indices(coarse)})};
  }

  void make_index() {
    const Span<IndexEntry> entries = arena.array<IndexEntry>(kLayerIdCount);
    for (size_t i = 0; i < kLayerIdCount; ++i) {
      entries[i] = {kLayerKinds[i].code, kLayerKinds[i].layer_version, nullptr, 0};
    }
    view.index = {entries.data, kLayerIdCount};
  }

  void make_descriptor() {
    Descriptor& d = view.desc;
    d.name = text("tiny");
    d.archetype = 5;
    d.gender = 2;
    d.age = 30;
    d.metadata = list<MetadataPair>(arena, {{text("origin"), text("made for tests")}});
    d.coordinate_system = {1, 2, 4};  // right, up, front
    d.lod_count = 2;
    d.complexity = text("A");
    d.db_name = text("tinyDB");
  }

  void make_definition() {
    Definition& d = view.defn;
    d.lod_joints = lods({0, 1, 2}, {0, 1});
    d.lod_channels = lods({0, 1}, {0});
    d.lod_maps = lods({0}, {});
    d.lod_meshes = {indices({0, 0}), list<Array<uint16_t>>(arena, {indices({0})})};
    d.gui_control_names = names({"CTRL_jaw.ty", "CTRL_smile.tx"});
    d.raw_control_names = names({"jawOpen", "smileL", "smileR"});
    d.joint_names = names({"head", "jaw", "tongue"});
    d.channel_names = names({"jawOpen", "smile"});
    d.map_names = names({"wrinkle"});
    d.mesh_names = names({"face"});
    d.mesh_channels = {indices({0}), indices({0})};
    d.joint_hierarchy = indices({0, 0, 1});
    d.neutral_translations = {floats({0, 0, 0}), floats({150, -4, 1}), floats({0, 2, 3})};
    d.neutral_rotations = {floats({0, 10, 0}), floats({0, 0, 0}), floats({0, 0, 5})};
  }

  void make_controls() {
    Controls& c = view.bhvr.controls;
    c.psd_count = 2;
    // The smile slider drives the left side to the right of its middle, the right side to the left.
    c.conditionals.input_indices = indices({0, 1, 1});
    c.conditionals.output_indices = indices({0, 1, 2});
    c.conditionals.from_values = floats({0, 0, -1});
    c.conditionals.to_values = floats({1, 1, 0});
    c.conditionals.slope_values = floats({1, 1, -1});
    c.conditionals.cut_values = floats({0, 0, 0});
    c.psds.rows = indices({3, 3, 4, 4});
    c.psds.columns = indices({0, 1, 0, 2});
    c.psds.values = floats({1, 1, 1, 0.5f});
  }

  void make_joint_groups() {
    view.bhvr.joints.row_count = 27;
    view.bhvr.joints.col_count = 11;
    JointGroup jaw;
    jaw.lods = indices({3, 1});
    jaw.input_indices = indices({0, 3});
    jaw.output_indices = indices({12, 10, 11});  // rx; ty, tz at LOD 0 only
    // clang-format off
    jaw.values = floats({20, 1,
                         -1, 0.5f,
                         0.25f, 0});
    // clang-format on
    jaw.joint_indices = indices({1});
    JointGroup tongue;
    tongue.lods = indices({4, 0});
    tongue.input_indices = indices({0, 4, 10});
    tongue.output_indices = indices({21, 22, 23, 24});  // rx, ry, rz, sx
    // clang-format off
    tongue.values = floats({5, 0, 2,
                            0, -3, 0,
                            1, 0, 0,
                            0.1f, 0, -0.1f});
    // clang-format on
    tongue.joint_indices = indices({2});
    view.bhvr.joints.groups = list<JointGroup>(arena, {jaw, tongue});
  }

  void make_channels_and_maps() {
    view.bhvr.channels = {indices({2, 1}), indices({0, 3}), indices({0, 1})};
    AnimatedMaps& maps = view.bhvr.maps;
    maps.lods = indices({1, 0});
    maps.conditionals.input_indices = indices({4});
    maps.conditionals.output_indices = indices({0});
    maps.conditionals.from_values = floats({0});
    maps.conditionals.to_values = floats({1});
    maps.conditionals.slope_values = floats({2});
    maps.conditionals.cut_values = floats({0});
  }

  void make_geometry() {
    Mesh m;
    m.positions = {floats({-1, 0, 1, -1, 0, 1}), floats({0, 0, 0, 1, 1, 1}),
                   floats({0, 0, 0, 0, 0, 0})};
    m.texture_coordinates = {floats({0, 0.5f, 1, 0, 0.5f, 1}), floats({0, 0, 0, 1, 1, 1})};
    m.normals = {floats({0, 0, 0, 0, 0, 0}), floats({0, 0, 0, 0, 0, 0}),
                 floats({1, 1, 1, 1, 1, 1})};
    const Array<uint32_t> same = wide({0, 1, 2, 3, 4, 5});
    m.layouts = {same, same, same};
    m.faces = list<Face>(arena, {{wide({0, 1, 4, 3})}, {wide({1, 2, 5, 4})}});
    m.maximum_influence_per_vertex = 2;
    const VertexSkinWeights head = {floats({1}), indices({0})};
    const VertexSkinWeights both = {floats({0.25f, 0.75f}), indices({0, 1})};
    m.skin_weights = list<VertexSkinWeights>(arena, {both, both, both, head, head, head});
    BlendShapeTarget open;
    open.deltas = {floats({0, 0}), floats({-0.5f, -0.25f}), floats({0, 0.125f})};
    open.vertex_indices = wide({1, 2});
    m.blend_shape_targets = list<BlendShapeTarget>(arena, {open});
    view.geom.meshes = list<Mesh>(arena, {m});
  }

  void make_network() {
    MachineLearnedBehavior& ml = view.mlbh;
    ml.control_names = names({"tongue.qx", "tongue.qy", "tongue.qz", "tongue.qw"});
    ml.lod_networks = lods({0}, {});
    ml.mesh_regions.region_names = list<List<String>>(arena, {names({"mouth"})});
    ml.mesh_regions.indices =
        list<List<Array<uint16_t>>>(arena, {list<Array<uint16_t>>(arena, {indices({0})})});
    NetworkLayer hidden;  // 2 -> 3
    hidden.biases = floats({0, 0.1f, -0.1f});
    hidden.weights = floats({1, 0, 0, 1, 0.5f, 0.5f});
    hidden.function_id = 2;  // leaky relu
    hidden.parameters = floats({0.125f});
    NetworkLayer last;  // 3 -> 4
    last.biases = floats({0, 0, 0, 1});
    last.weights = floats({0.1f, 0, 0, 0, 0.2f, 0, 0, 0, 0.3f, 0, 0, 0});
    NeuralNetwork network;
    network.input_indices = indices({0, 1});
    network.output_indices = indices({5, 6, 7, 8});
    network.layers = list<NetworkLayer>(arena, {hidden, last});
    ml.networks = list<NeuralNetwork>(arena, {network});
    view.ml_control_count = ml.control_names.count;
  }

  /// Sets 0, 1, 2: gather, run, scatter.
  void make_ml_operations() {
    auto operation = [](MlOperationType type, Array<uint32_t> parameters) {
      MlOperation o;
      o.type = static_cast<uint16_t>(type);
      o.parameters = parameters;
      return o;
    };
    MlOperation gather = operation(MlOperationType::kGather, wide({0, 1}));
    MlOperation run = operation(MlOperationType::kMlp, wide({0, 3, 3, 4, 4}));  // [layer][lod] rows
    run.set_dependencies = indices({0});
    run.operation_dependencies = indices({0});
    MlOperation scatter = operation(MlOperationType::kScatter, wide({5, 6, 7, 8}));
    scatter.set_dependencies = indices({1});
    scatter.operation_dependencies = indices({0});

    MlType type;
    type.operations = list<List<MlOperation>>(
        arena, {list<MlOperation>(arena, {gather}), list<MlOperation>(arena, {run}),
                list<MlOperation>(arena, {scatter})});
    type.lod_operations = list<LodMap>(arena, {lods({0}, {}), lods({0}, {}), lods({0}, {})});
    view.mlbe.types = list<MlType>(arena, {type});

    // Ten values per joint (the rotation is a quaternion); the tongue's begin at 20.
    MlJoints& joints = view.mlbe.joints;
    joints.parameter_keys = indices({0, 1, 2});
    joints.parameter_values = indices({0, 1, 0});
    joints.input_indices = indices({5, 6, 7, 8});
    joints.output_indices = indices({23, 24, 25, 26});
  }

  void make_solver() {
    RbfSolver s;
    s.name = text("mouth");
    s.raw_control_indices = indices({0, 1});
    s.pose_indices = indices({0, 1});
    s.raw_control_values = floats({0, 0, 1, 0});
    s.radius = 60;
    s.weight_threshold = 0.001f;
    s.solver_type = 1;       // interpolative
    s.automatic_radius = 1;  // off
    s.normalize_method = 1;  // always
    s.function_type = 1;     // exponential
    view.rbfb.lod_solvers = lods({0}, {});
    view.rbfb.solvers = list<RbfSolver>(arena, {s});
    view.rbfb.poses = list<RbfPose>(arena, {{text("rest"), 1.0f}, {text("open"), 1.0f}});

    const RbfPoseControls rest = {{}, indices({9}), floats({1})};
    const RbfPoseControls open = {indices({2}), indices({10}), floats({0.5f})};  // times smileR
    view.rbfe.pose_control_names = names({"rest", "open"});
    view.rbfe.poses = list<RbfPoseControls>(arena, {rest, open});
  }

  void make_twist_and_swing() {
    const Array<uint16_t> quaternion = indices({5, 6, 7, 8});
    view.twsw.twists = list<Twist>(arena, {{floats({0.5f}), indices({1}), quaternion, 0}});
    view.twsw.swings = list<Swing>(arena, {{floats({0.25f}), indices({2}), quaternion, 0}});
  }
};

}  // namespace

DnaView tiny_rig(Arena& arena) {
  TinyRig rig{arena, {}};
  rig.view.loaded = kLayersAll;
  rig.make_index();
  rig.make_descriptor();
  rig.make_definition();
  rig.make_controls();
  rig.make_joint_groups();
  rig.make_channels_and_maps();
  rig.make_geometry();
  rig.make_network();
  rig.make_ml_operations();
  rig.make_solver();
  rig.make_twist_and_swing();
  rig.view.jbmd.joints = list<JointRepresentation>(arena, {{0, 0, 0}, {0, 0, 0}, {0, 1, 0}});
  return rig.view;
}

}  // namespace mien::dna
