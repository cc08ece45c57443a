// SPDX-License-Identifier: MIT
// The fields of every layer of the DNA format, once. Reader, writer, path look-up and size
// computation all walk these descriptions, so they cannot disagree.
//
// A record lists its members in `fields`, in file order, under the names of the format
// (docs/dna-format.md, 6 "Layers, field by field"). The visitor is called as visit(name, member)
// for each. A record with kIsBlock is stored with its size in front (or, in 2.1, the offset of its
// end), so that it can be skipped.
#pragma once

#include "runtime/load/dna/format/dna_types.h"

namespace mien::dna {

// Shared pieces ---------------------------------------------------------------------------------

struct Vec3Array {
  Array<float> xs, ys, zs;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("xs", s.xs);
    visit("ys", s.ys);
    visit("zs", s.zs);
  }
};

/// Elements of LOD l: indices[lods[l]].
struct LodMap {
  Array<uint16_t> lods;
  List<Array<uint16_t>> indices;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("lods", s.lods);
    visit("indices", s.indices);
  }

  /// Empty past the end. The row number has been checked when the file was opened.
  Array<uint16_t> at(size_t lod) const {
    return lod < lods.count ? indices[lods[lod]] : Array<uint16_t>{};
  }
};

/// Row i: for an input within [from, to] add slope * input + cut to the output.
struct ConditionalTable {
  Array<uint16_t> input_indices, output_indices;
  Array<float> from_values, to_values, slope_values, cut_values;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("inputIndices", s.input_indices);
    visit("outputIndices", s.output_indices);
    visit("fromValues", s.from_values);
    visit("toValues", s.to_values);
    visit("slopeValues", s.slope_values);
    visit("cutValues", s.cut_values);
  }
};

// desc ------------------------------------------------------------------------------------------

struct MetadataPair {
  String key, value;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("key", s.key);
    visit("value", s.value);
  }
};

struct FileCoordinateSystem {
  uint16_t x_axis = 0, y_axis = 0, z_axis = 0;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("xAxis", s.x_axis);
    visit("yAxis", s.y_axis);
    visit("zAxis", s.z_axis);
  }
};

struct Descriptor {
  String name;
  uint16_t archetype = 0, gender = 0, age = 0;
  List<MetadataPair> metadata;
  uint16_t translation_unit = 0, rotation_unit = 0;
  FileCoordinateSystem coordinate_system;
  uint16_t lod_count = 0, max_lod = 0;
  String complexity, db_name;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("name", s.name);
    visit("archetype", s.archetype);
    visit("gender", s.gender);
    visit("age", s.age);
    visit("metadata", s.metadata);
    visit("translationUnit", s.translation_unit);
    visit("rotationUnit", s.rotation_unit);
    visit("coordinateSystem", s.coordinate_system);
    visit("lodCount", s.lod_count);
    visit("maxLOD", s.max_lod);
    visit("complexity", s.complexity);
    visit("dbName", s.db_name);
  }
};

// dsce ------------------------------------------------------------------------------------------

struct RotationSign {
  int32_t x = 1, y = 1, z = 1;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("x", s.x);
    visit("y", s.y);
    visit("z", s.z);
  }
};

struct DescriptorExtension {
  uint32_t rotation_sequence = 0;
  RotationSign rotation_sign;
  uint8_t face_winding_order = 0;  // not in files numbered 2.1 ... 2.7

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("rotationSequence", s.rotation_sequence);
    visit("rotationSign", s.rotation_sign);
    if (visit.has_face_winding()) visit("faceWindingOrder", s.face_winding_order);
  }
};

// defn ------------------------------------------------------------------------------------------

struct MeshChannelMapping {
  Array<uint16_t> from, to;  // mesh, channel

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("from", s.from);
    visit("to", s.to);
  }
};

struct Definition {
  LodMap lod_joints, lod_channels, lod_maps, lod_meshes;
  List<String> gui_control_names, raw_control_names, joint_names, channel_names, map_names,
      mesh_names;
  MeshChannelMapping mesh_channels;
  Array<uint16_t> joint_hierarchy;
  Vec3Array neutral_translations, neutral_rotations;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("lodJointMapping", s.lod_joints);
    visit("lodBlendShapeMapping", s.lod_channels);
    visit("lodAnimatedMapMapping", s.lod_maps);
    visit("lodMeshMapping", s.lod_meshes);
    visit("guiControlNames", s.gui_control_names);
    visit("rawControlNames", s.raw_control_names);
    visit("jointNames", s.joint_names);
    visit("blendShapeChannelNames", s.channel_names);
    visit("animatedMapNames", s.map_names);
    visit("meshNames", s.mesh_names);
    visit("meshBlendShapeChannelMapping", s.mesh_channels);
    visit("jointHierarchy", s.joint_hierarchy);
    visit("neutralJointTranslations", s.neutral_translations);
    visit("neutralJointRotations", s.neutral_rotations);
  }
};

// bhvr ------------------------------------------------------------------------------------------

/// Sparse matrix: corrective `rows[i]` depends on control `columns[i]` with weight `values[i]`.
struct PsdTable {
  Array<uint16_t> rows, columns;
  Array<float> values;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("rows", s.rows);
    visit("columns", s.columns);
    visit("values", s.values);
  }
};

struct Controls {
  uint16_t psd_count = 0;
  ConditionalTable conditionals;  // GUI control -> raw control
  PsdTable psds;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("psdCount", s.psd_count);
    visit("conditionals", s.conditionals);
    visit("psds", s.psds);
  }
};

/// A dense piece of the joint matrix, row-major; `lods[l]` leading rows exist at LOD l.
struct JointGroup {
  Array<uint16_t> lods, input_indices, output_indices;
  Array<float> values;
  Array<uint16_t> joint_indices;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("lods", s.lods);
    visit("inputIndices", s.input_indices);
    visit("outputIndices", s.output_indices);
    visit("values", s.values);
    visit("jointIndices", s.joint_indices);
  }
};

struct Joints {
  uint16_t row_count = 0, col_count = 0;
  List<JointGroup> groups;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("rowCount", s.row_count);
    visit("colCount", s.col_count);
    visit("jointGroups", s.groups);
  }
};

struct BlendShapeChannels {
  Array<uint16_t> lods, input_indices, output_indices;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("lods", s.lods);
    visit("inputIndices", s.input_indices);
    visit("outputIndices", s.output_indices);
  }
};

struct AnimatedMaps {
  Array<uint16_t> lods;
  ConditionalTable conditionals;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("lods", s.lods);
    visit("conditionals", s.conditionals);
  }
};

/// Four parts back to back; in 2.1 each has a section of its own.
struct Behavior {
  Controls controls;
  Joints joints;
  BlendShapeChannels channels;
  AnimatedMaps maps;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("controls", s.controls);
    visit("joints", s.joints);
    visit("blendShapeChannels", s.channels);
    visit("animatedMaps", s.maps);
  }
};

// geom ------------------------------------------------------------------------------------------

struct TextureCoordinates {
  Array<float> us, vs;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("us", s.us);
    visit("vs", s.vs);
  }
};

/// Corner k combines position, uv and normal with these indices.
struct VertexLayouts {
  Array<uint32_t> positions, texture_coordinates, normals;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("positions", s.positions);
    visit("textureCoordinates", s.texture_coordinates);
    visit("normals", s.normals);
  }
};

struct Face {
  Array<uint32_t> layout_indices;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("layoutIndices", s.layout_indices);
  }
};

struct VertexSkinWeights {
  Array<float> weights;
  Array<uint16_t> joint_indices;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("weights", s.weights);
    visit("jointIndices", s.joint_indices);
  }
};

struct BlendShapeTarget {
  Vec3Array deltas;
  Array<uint32_t> vertex_indices;
  uint16_t channel_index = 0;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("deltas", s.deltas);
    visit("vertexIndices", s.vertex_indices);
    visit("blendShapeChannelIndex", s.channel_index);
  }
};

struct Mesh {
  static constexpr bool kIsBlock = true;
  Vec3Array positions;
  TextureCoordinates texture_coordinates;
  Vec3Array normals;
  VertexLayouts layouts;
  List<Face> faces;
  uint16_t maximum_influence_per_vertex = 0;
  List<VertexSkinWeights> skin_weights;
  List<BlendShapeTarget> blend_shape_targets;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("positions", s.positions);
    visit("textureCoordinates", s.texture_coordinates);
    visit("normals", s.normals);
    visit("layouts", s.layouts);
    visit("faces", s.faces);
    visit("maximumInfluencePerVertex", s.maximum_influence_per_vertex);
    visit("skinWeights", s.skin_weights);
    visit("blendShapeTargets", s.blend_shape_targets);
  }
};

struct Geometry {
  List<Mesh> meshes;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("meshes", s.meshes);
  }
};

// mlbh ------------------------------------------------------------------------------------------

struct NetworkLayer {
  Array<float> biases, weights;  // weights: row-major [output][input]
  uint16_t function_id = 0;
  Array<float> parameters;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("biases", s.biases);
    visit("weights", s.weights);
    visit("functionId", s.function_id);
    visit("parameters", s.parameters);
  }
};

struct NeuralNetwork {
  static constexpr bool kIsBlock = true;
  Array<uint16_t> output_indices, input_indices;
  List<NetworkLayer> layers;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("outputIndices", s.output_indices);
    visit("inputIndices", s.input_indices);
    visit("layers", s.layers);
  }
};

struct MeshRegions {
  List<List<String>> region_names;      // [mesh][region]
  List<List<Array<uint16_t>>> indices;  // [mesh][region]: networks

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("regionNames", s.region_names);
    visit("indices", s.indices);
  }
};

struct MachineLearnedBehavior {
  List<String> control_names;
  LodMap lod_networks;
  MeshRegions mesh_regions;
  List<NeuralNetwork> networks;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("mlControlNames", s.control_names);
    visit("lodNeuralNetworkMapping", s.lod_networks);
    visit("neuralNetworkToMeshRegion", s.mesh_regions);
    visit("neuralNetworks", s.networks);
  }
};

// mlbe ------------------------------------------------------------------------------------------

enum class MlOperationType : uint16_t { kUnspecified, kGather, kScatter, kMlp, kWeightedSum };

struct MlOperation {
  Array<uint32_t> parameters;
  Array<uint16_t> set_dependencies, operation_dependencies;
  uint16_t type = 0;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("parameters", s.parameters);
    visit("mlOperationSetDependencyIndices", s.set_dependencies);
    visit("mlOperationDependencyIndices", s.operation_dependencies);
    visit("operationType", s.type);
  }
};

struct MlType {
  List<LodMap> lod_operations;         // [set]
  List<List<MlOperation>> operations;  // [set][operation]

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("lodMLOperationMappings", s.lod_operations);
    visit("operations", s.operations);
  }
};

struct MlJoints {
  Array<uint16_t> parameter_keys, parameter_values, input_indices, output_indices;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("parameterKeys", s.parameter_keys);
    visit("parameterValues", s.parameter_values);
    visit("inputIndices", s.input_indices);
    visit("outputIndices", s.output_indices);
  }
};

/// Values that an ML model gives per joint: 3 for a vector or Euler angles, 4 for a quaternion, 0
/// for what it does not give (docs/dna-format.md, 8.4 "ML operations").
struct MlJointWidths {
  uint32_t translation = 0, rotation = 0, scale = 0;

  uint32_t all() const { return translation + rotation + scale; }
};

/// Keys 0, 1, 2: translation, rotation, scale.
inline MlJointWidths ml_joint_widths(const MlJoints& joints) {
  MlJointWidths widths;
  for (uint32_t i = 0; i < joints.parameter_keys.count && i < joints.parameter_values.count; ++i) {
    switch (joints.parameter_keys[i]) {
      case 0: widths.translation = 3; break;
      case 1: widths.rotation = joints.parameter_values[i] == 1 ? 4 : 3; break;
      case 2: widths.scale = 3; break;
      default: break;
    }
  }
  return widths;
}

inline uint32_t ml_joint_attributes(const MlJoints& joints) {
  return ml_joint_widths(joints).all();
}

struct MachineLearnedBehaviorExtension {
  List<MlType> types;
  MlJoints joints;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("mlbTypeData", s.types);
    visit("mlbJoints", s.joints);
  }
};

// rbfb ------------------------------------------------------------------------------------------

struct RbfSolver {
  static constexpr bool kIsBlock = true;
  String name;
  Array<uint16_t> raw_control_indices, pose_indices;
  Array<float> raw_control_values;  // row-major [pose][input]
  float radius = 0, weight_threshold = 0;
  uint16_t solver_type = 0, automatic_radius = 0, distance_method = 0, normalize_method = 0,
           function_type = 0, twist_axis = 0;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("name", s.name);
    visit("rawControlIndices", s.raw_control_indices);
    visit("poseIndices", s.pose_indices);
    visit("rawControlValues", s.raw_control_values);
    visit("radius", s.radius);
    visit("weightThreshold", s.weight_threshold);
    visit("solverType", s.solver_type);
    visit("automaticRadius", s.automatic_radius);
    visit("distanceMethod", s.distance_method);
    visit("normalizeMethod", s.normalize_method);
    visit("functionType", s.function_type);
    visit("twistAxis", s.twist_axis);
  }
};

struct RbfPose {
  String name;
  float scale = 0;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("name", s.name);
    visit("scale", s.scale);
  }
};

struct RbfBehavior {
  LodMap lod_solvers;
  List<RbfSolver> solvers;
  List<RbfPose> poses;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("lodSolverMapping", s.lod_solvers);
    visit("solvers", s.solvers);
    visit("poses", s.poses);
  }
};

// rbfe ------------------------------------------------------------------------------------------

struct RbfPoseControls {
  Array<uint16_t> input_control_indices, output_control_indices;
  Array<float> output_control_weights;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("inputControlIndices", s.input_control_indices);
    visit("outputControlIndices", s.output_control_indices);
    visit("outputControlWeights", s.output_control_weights);
  }
};

struct RbfBehaviorExtension {
  List<String> pose_control_names;
  List<RbfPoseControls> poses;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("poseControlNames", s.pose_control_names);
    visit("poses", s.poses);
  }
};

// jbmd ------------------------------------------------------------------------------------------

struct JointRepresentation {
  uint16_t translation = 0, rotation = 0, scale = 0;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("translation", s.translation);
    visit("rotation", s.rotation);
    visit("scale", s.scale);
  }
};

struct JointBehaviorMetadata {
  List<JointRepresentation> joints;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("jointRepresentations", s.joints);
  }
};

// twsw ------------------------------------------------------------------------------------------

struct Twist {
  Array<float> blend_weights;
  Array<uint16_t> output_joint_indices, input_control_indices;
  uint16_t twist_axis = 0;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("twistBlendWeights", s.blend_weights);
    visit("twistOutputJointIndices", s.output_joint_indices);
    visit("twistInputControlIndices", s.input_control_indices);
    visit("twistAxis", s.twist_axis);
  }
};

struct Swing {
  Array<float> blend_weights;
  Array<uint16_t> output_joint_indices, input_control_indices;
  uint16_t twist_axis = 0;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("swingBlendWeights", s.blend_weights);
    visit("swingOutputJointIndices", s.output_joint_indices);
    visit("swingInputControlIndices", s.input_control_indices);
    visit("twistAxis", s.twist_axis);
  }
};

struct TwistSwingBehavior {
  List<Twist> twists;
  List<Swing> swings;

  template <class Self, class Visitor>
  static constexpr void fields(Self& s, Visitor& visit) {
    visit("twists", s.twists);
    visit("swings", s.swings);
  }
};

}  // namespace mien::dna
