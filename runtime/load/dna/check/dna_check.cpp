// SPDX-License-Identifier: MIT
// The four classic layers and dsce. The others are in dna_check_extensions.cpp.
#include "runtime/load/dna/check/dna_check.h"

#include <cmath>
#include <optional>

#include "runtime/load/dna/check/dna_checker.h"

namespace mien::dna {
namespace {

constexpr unsigned kMaxLods = 33;
constexpr uint32_t kMaxJoints = 65536 / 9;  // joint values have 16-bit numbers, nine for each joint

// Descriptor ------------------------------------------------------------------------------------

void check_metadata(Checker& c, const Field& desc) {
  // Compares all pairs with each other, so only up to a number that a person would write.
  constexpr uint32_t kMaxCompared = 1024;
  const List<MetadataPair>& pairs = c.view.desc.metadata;
  const uint32_t count = pairs.count < kMaxCompared ? pairs.count : kMaxCompared;
  for (uint32_t i = 1; i < count; ++i) {
    const String& key = pairs[i].key;
    for (uint32_t k = 0; k < i; ++k) {
      const String& earlier = pairs[k].key;
      if (key.count != earlier.count) continue;
      if (key.count != 0 && memcmp(key.data, earlier.data, key.count) != 0) continue;
      const Field pair{&desc, "metadata", i};
      c.warning(Field{&pair, "key"}, c.view.offset_of(key.data),
                "is also the key of pair %u, which look-up finds first", k);
      break;
    }
  }
}

// Units and axes cross the C interface as enumerations, so they have to be ones that exist.
void check_descriptor(Checker& c) {
  const Descriptor& d = c.view.desc;
  const Field desc{nullptr, "desc"};
  // The fields between metadata and complexity have fixed sizes; the count of complexity is the last
  // of them.
  const uint64_t complexity = c.view.offset_of(d.complexity.data);
  const auto before_complexity = [&](unsigned bytes) {
    return complexity == kNoOffset ? kNoOffset : complexity - bytes;
  };
  c.enumeration(Field{&desc, "translationUnit"}, before_complexity(18), d.translation_unit, 1);
  c.enumeration(Field{&desc, "rotationUnit"}, before_complexity(16), d.rotation_unit, 1);
  const FileCoordinateSystem& axes = d.coordinate_system;
  const Field system{&desc, "coordinateSystem"};
  c.enumeration(Field{&system, "xAxis"}, before_complexity(14), axes.x_axis, 5);
  c.enumeration(Field{&system, "yAxis"}, before_complexity(12), axes.y_axis, 5);
  c.enumeration(Field{&system, "zAxis"}, before_complexity(10), axes.z_axis, 5);
  if (d.lod_count > kMaxLods) {
    c.error(Field{&desc, "lodCount"}, Status::kDnaLimit, before_complexity(8),
            "is %u; a file can have %u LODs", unsigned{d.lod_count}, kMaxLods);
  }
  if (!c.thorough) return;

  const uint64_t archetype = c.offset_after(d.name);
  c.informative_enumeration(Field{&desc, "archetype"}, archetype, d.archetype, 5);
  c.informative_enumeration(Field{&desc, "gender"},
                            archetype == kNoOffset ? kNoOffset : archetype + 2, d.gender, 2);
  // Directions 2 n and 2 n + 1 lie on the same line.
  const int x = axes.x_axis / 2, y = axes.y_axis / 2, z = axes.z_axis / 2;
  if (x == y || y == z || z == x) {
    c.warning(system, before_complexity(14), "the axes %u, %u, %u do not span space",
              unsigned{axes.x_axis}, unsigned{axes.y_axis}, unsigned{axes.z_axis});
  }
  check_metadata(c, desc);
}

// The layer is numbers only, so their offsets follow from its own.
uint64_t descriptor_extension_offset(const DnaView& view) {
  const LayerKind& kind = kLayerKinds[static_cast<size_t>(LayerId::kDsce)];
  for (const IndexEntry& entry : view.index) {
    if (entry.code == kind.code && entry.layer_version == kind.layer_version) {
      return entry.data ? entry.offset : kNoOffset;
    }
  }
  return kNoOffset;
}

void check_descriptor_extension(Checker& c) {
  const DescriptorExtension& e = c.view.dsce;
  const Field dsce{nullptr, "dsce"};
  const uint64_t begin = descriptor_extension_offset(c.view);
  auto at = [&](unsigned bytes) { return begin == kNoOffset ? kNoOffset : begin + bytes; };
  c.enumeration(Field{&dsce, "rotationSequence"}, at(0), e.rotation_sequence, 5);

  const Field signs{&dsce, "rotationSign"};
  const struct {
    const char* name;
    int32_t sign;
    unsigned byte;
  } axes[] = {
      {"x", e.rotation_sign.x, 4}, {"y", e.rotation_sign.y, 8}, {"z", e.rotation_sign.z, 12}};
  for (const auto& axis : axes) {
    if (axis.sign == 1 || axis.sign == -1) continue;
    c.error(Field{&signs, axis.name}, Status::kDnaValue, at(axis.byte), "is %d instead of 1 or -1",
            axis.sign);
  }
  c.enumeration(Field{&dsce, "faceWindingOrder"}, at(16), e.face_winding_order, 1);
}

// Definition ------------------------------------------------------------------------------------

// LOD selection takes joints that LOD 0 does not list for joints of no LOD in particular.
void check_finest_joints(Checker& c, const Field& defn) {
  const LodMap& map = c.view.defn.lod_joints;
  if (!c.thorough || map.lods.count == 0 || map.lods[0] >= map.indices.count) return;
  Marks finest;
  finest.set_all(map.indices[map.lods[0]]);
  const Field field{&defn, "lodJointMapping"};
  for (uint32_t l = 1; l < map.lods.count; ++l) {
    if (map.lods[l] >= map.indices.count) continue;
    const Array<uint16_t>& joints = map.indices[map.lods[l]];
    for (uint32_t i = 0; i < joints.count && !c.stopped(); ++i) {
      if (finest.has(joints[i])) continue;
      c.warning(Field{&field, "indices", map.lods[l]}, c.offset(joints, i),
                "LOD %u has joint %u, which LOD 0 lacks", l, unsigned{joints[i]});
    }
  }
}

// Walks from each joint towards its root, as far as the first joint seen on an earlier walk; so all
// walks together take one step per joint, but for those that find a cycle.
void check_hierarchy(Checker& c, const Field& defn) {
  const Array<uint16_t>& parents = c.view.defn.joint_hierarchy;
  const Field field{&defn, "jointHierarchy"};
  const uint32_t count = c.view.defn.joint_names.count;
  c.has_length(field, parents, count, "joints");
  c.indices_below(field, parents, count, "joints");
  if (parents.count != count || count > kMaxJoints) return;
  // If every parent precedes its children there are no cycles.
  uint16_t later = 0;
  for (uint32_t j = 0; j < count; ++j) {
    later |= static_cast<uint16_t>(parents[j] > static_cast<uint16_t>(j));
  }
  if (!c.thorough && later == 0) return;

  Marks seen;
  uint32_t roots = 0;
  for (uint32_t j = 0; j < count && !c.stopped(); ++j) {
    uint32_t at = j, steps = 0;
    while (at < count && parents[at] != at && !seen.has(static_cast<uint16_t>(at)) &&
           steps <= count) {
      at = parents[at];
      ++steps;
    }
    if (steps > count) {
      c.error(field, Status::kDnaValue, c.offset(parents, at),
              "joint %u is its own ancestor: its line of parents never ends", at);
    }
    for (at = j; at < count && !seen.has(static_cast<uint16_t>(at)); at = parents[at]) {
      seen.set(static_cast<uint16_t>(at));
    }
    if (parents[j] == j && ++roots == 2) {
      c.warning(field, c.offset(parents, j), "joint %u is a second root", j);
    }
  }
}

void check_neutral_pose(Checker& c, const Field& defn, const char* name, const Vec3Array& pose) {
  const uint32_t joints = c.view.defn.joint_names.count;
  const Field field{&defn, name};
  c.has_length(Field{&field, "xs"}, pose.xs, joints, "joints");
  c.vectors(field, pose);
}

void check_definition_layer(Checker& c) {
  const Definition& d = c.view.defn;
  const Field defn{nullptr, "defn"};
  c.names(Field{&defn, "guiControlNames"}, d.gui_control_names);
  c.names(Field{&defn, "rawControlNames"}, d.raw_control_names);
  c.names(Field{&defn, "jointNames"}, d.joint_names);
  c.names(Field{&defn, "blendShapeChannelNames"}, d.channel_names);
  c.names(Field{&defn, "animatedMapNames"}, d.map_names);
  c.names(Field{&defn, "meshNames"}, d.mesh_names);
  const uint32_t joints = d.joint_names.count;
  if (joints > kMaxJoints && joints <= 65535) {
    c.error(Field{&defn, "jointNames"}, Status::kDnaLimit, kNoOffset,
            "has %u elements; the values of at most %u joints can be numbered", joints, kMaxJoints);
  }

  c.lod_map(Field{&defn, "lodJointMapping"}, d.lod_joints, joints, "joints");
  c.lod_map(Field{&defn, "lodBlendShapeMapping"}, d.lod_channels, d.channel_names.count,
            "channels");
  c.lod_map(Field{&defn, "lodAnimatedMapMapping"}, d.lod_maps, d.map_names.count, "animated maps");
  c.lod_map(Field{&defn, "lodMeshMapping"}, d.lod_meshes, d.mesh_names.count, "meshes");
  check_finest_joints(c, defn);

  const Field pairs{&defn, "meshBlendShapeChannelMapping"};
  const MeshChannelMapping& mapping = d.mesh_channels;
  c.equal_lengths(pairs, {length("from", mapping.from), length("to", mapping.to)});
  c.indices_below(Field{&pairs, "from"}, mapping.from, d.mesh_names.count, "meshes");
  c.indices_below(Field{&pairs, "to"}, mapping.to, d.channel_names.count, "channels");

  check_hierarchy(c, defn);
  check_neutral_pose(c, defn, "neutralJointTranslations", d.neutral_translations);
  check_neutral_pose(c, defn, "neutralJointRotations", d.neutral_rotations);
}

// Behavior --------------------------------------------------------------------------------------

void check_controls(Checker& c, const Field& bhvr) {
  const Definition& d = c.view.defn;
  const Controls& controls = c.view.bhvr.controls;
  const Field field{&bhvr, "controls"};
  c.conditionals(Field{&field, "conditionals"}, controls.conditionals, d.gui_control_names.count,
                 "GUI controls", d.raw_control_names.count, "raw controls");

  const PsdTable& psds = controls.psds;
  const Field table{&field, "psds"};
  c.equal_lengths(table, {length("rows", psds.rows), length("columns", psds.columns),
                          length("values", psds.values)});
  c.indices_below(Field{&table, "columns"}, psds.columns, c.control_limit, "controls");
  c.finite(Field{&table, "values"}, psds.values);

  const uint32_t first = c.view.first_psd(), end = c.view.first_ml();
  uint32_t bad = 0;
  for (uint32_t i = 0; i < psds.rows.count; ++i) {
    bad |= static_cast<uint32_t>(psds.rows[i] - first >= end - first);
  }
  for (uint32_t i = 0; bad != 0 && i < psds.rows.count && !c.stopped(); ++i) {
    const uint32_t row = psds.rows[i];
    if (row >= first && row < end) continue;
    c.error(Field{&table, "rows"}, Status::kDnaReference, c.offset(psds.rows, i),
            "element %u is %u, but the %u correctives are numbered from %u", i, row, end - first,
            first);
  }
}

// Evaluation assigns, so a row that comes up again replaces what was there.
void mark_written(Checker& c, const Field& field, const Array<uint16_t>& outputs, Marks& written) {
  for (uint32_t i = 0; i < outputs.count && !c.stopped(); ++i) {
    if (written.has(outputs[i])) {
      c.warning(field, c.offset(outputs, i), "element %u writes %u, which is written before", i,
                unsigned{outputs[i]});
    }
    written.set(outputs[i]);
  }
}

void check_touched_joints(Checker& c, const Field& field, const JointGroup& group) {
  if (!c.thorough) return;
  Marks listed;
  listed.set_all(group.joint_indices);
  for (uint32_t i = 0; i < group.output_indices.count && !c.stopped(); ++i) {
    const uint16_t joint = group.output_indices[i] / 9;
    if (listed.has(joint)) continue;
    listed.set(joint);
    c.warning(field, c.offset(group.joint_indices), "lacks joint %u, which the group writes",
              unsigned{joint});
  }
}

void check_joints(Checker& c, const Field& bhvr) {
  const Joints& joints = c.view.bhvr.joints;
  const uint32_t joint_count = c.view.defn.joint_names.count;
  const Field field{&bhvr, "joints"};
  if (joints.groups.count != 0 && joints.row_count != 9 * joint_count) {
    c.warning(Field{&field, "rowCount"}, kNoOffset, "is %u, but %u joints have %u values",
              unsigned{joints.row_count}, joint_count, 9 * joint_count);
  }
  c.numbered(Field{&field, "jointGroups"}, joints.groups.count);

  std::optional<Marks> written;
  if (c.thorough) written.emplace();
  uint32_t columns = 0;
  for (uint32_t g = 0; g < joints.groups.count && !c.stopped(); ++g) {
    const JointGroup& group = joints.groups[g];
    const Field at{&field, "jointGroups", g};
    const uint32_t rows = group.output_indices.count;
    c.row_counts(Field{&at, "lods"}, group.lods, rows);
    c.has_length(Field{&at, "values"}, group.values, uint64_t{rows} * group.input_indices.count,
                 "rows times columns");
    c.indices_below(Field{&at, "inputIndices"}, group.input_indices, c.control_limit, "controls");
    c.known_controls(Field{&at, "inputIndices"}, group.input_indices);
    c.indices_below(Field{&at, "outputIndices"}, group.output_indices, 9 * joint_count,
                    "joint values");
    c.indices_below(Field{&at, "jointIndices"}, group.joint_indices, joint_count, "joints");
    c.finite(Field{&at, "values"}, group.values);
    c.unique(Field{&at, "inputIndices"}, group.input_indices);
    if (written) mark_written(c, Field{&at, "outputIndices"}, group.output_indices, *written);
    check_touched_joints(c, Field{&at, "jointIndices"}, group);
    for (uint32_t i = 0; c.thorough && i < group.input_indices.count; ++i) {
      if (group.input_indices[i] >= columns) columns = group.input_indices[i] + 1u;
    }
  }
  if (columns > joints.col_count) {
    c.warning(Field{&field, "colCount"}, kNoOffset, "is %u, but control %u is used",
              unsigned{joints.col_count}, columns - 1);
  }
}

void check_behavior(Checker& c) {
  const Definition& d = c.view.defn;
  const Field bhvr{nullptr, "bhvr"};
  check_controls(c, bhvr);
  check_joints(c, bhvr);

  const BlendShapeChannels& channels = c.view.bhvr.channels;
  const Field shapes{&bhvr, "blendShapeChannels"};
  const Field shape_outputs{&shapes, "outputIndices"};
  c.equal_lengths(shapes, {length("inputIndices", channels.input_indices),
                           length("outputIndices", channels.output_indices)});
  c.row_counts(Field{&shapes, "lods"}, channels.lods, channels.output_indices.count);
  c.indices_below(Field{&shapes, "inputIndices"}, channels.input_indices, c.control_limit,
                  "controls");
  c.indices_below(shape_outputs, channels.output_indices, d.channel_names.count, "channels");
  c.unique(shape_outputs, channels.output_indices);

  const AnimatedMaps& maps = c.view.bhvr.maps;
  const Field map_field{&bhvr, "animatedMaps"};
  c.row_counts(Field{&map_field, "lods"}, maps.lods, maps.conditionals.output_indices.count);
  c.conditionals(Field{&map_field, "conditionals"}, maps.conditionals, c.control_limit, "controls",
                 d.map_names.count, "animated maps");
}

// Geometry --------------------------------------------------------------------------------------

// A mesh may lack texture coordinates or normals; its layouts then refer to nothing.
void check_optional(Checker& c, const Field& field, const Array<uint32_t>& indices, uint32_t limit,
                    const char* of) {
  if (limit != 0) return c.indices_below(field, indices, limit, of);
  if (indices.count != 0) c.warning(field, c.offset(indices), "the mesh has no %s", of);
}

void check_faces(Checker& c, const Field& at, const Mesh& mesh) {
  const uint32_t corners = mesh.layouts.positions.count;
  for (uint32_t f = 0; f < mesh.faces.count && !c.stopped(); ++f) {
    const Array<uint32_t>& face = mesh.faces[f].layout_indices;
    const Field faces{&at, "faces", f};
    const Field field{&faces, "layoutIndices"};
    c.indices_below(field, face, corners, "layouts");
    if (face.count < 3) c.warning(field, c.offset(face), "a face with %u corners", face.count);
  }
}

void check_skin_weights(Checker& c, const Field& at, const Mesh& mesh) {
  const uint32_t joints = c.view.defn.joint_names.count;
  const List<VertexSkinWeights>& vertices = mesh.skin_weights;
  if (vertices.count != 0 && vertices.count != mesh.positions.xs.count) {
    c.error(Field{&at, "skinWeights"}, Status::kDnaStructure, c.offset(vertices[0].weights),
            "has %u elements, but there are %u vertices", vertices.count, mesh.positions.xs.count);
  }
  for (uint32_t v = 0; v < vertices.count && !c.stopped(); ++v) {
    const VertexSkinWeights& vertex = vertices[v];
    const Field field{&at, "skinWeights", v};
    c.indices_below(Field{&field, "jointIndices"}, vertex.joint_indices, joints, "joints");
    if (vertex.weights.count != vertex.joint_indices.count) {
      c.equal_lengths(
          field, {length("weights", vertex.weights), length("jointIndices", vertex.joint_indices)});
    }
    if (!c.thorough) continue;

    constexpr float kTolerance = 1e-3f;
    float sum = 0;
    for (uint32_t i = 0; i < vertex.weights.count; ++i) sum += vertex.weights[i];
    if (!(std::fabs(sum - 1) <= kTolerance)) {  // also if it is NaN
      c.warning(Field{&field, "weights"}, c.offset(vertex.weights), "the weights sum to %g",
                static_cast<double>(sum));
    }
    if (vertex.weights.count > mesh.maximum_influence_per_vertex) {
      c.warning(Field{&at, "maximumInfluencePerVertex"}, c.offset(vertex.weights),
                "is %u, but vertex %u has %u influences",
                unsigned{mesh.maximum_influence_per_vertex}, v, vertex.weights.count);
    }
  }
}

void check_blend_shape_targets(Checker& c, const Field& at, const Mesh& mesh) {
  const uint32_t channels = c.view.defn.channel_names.count;
  for (uint32_t t = 0; t < mesh.blend_shape_targets.count && !c.stopped(); ++t) {
    const BlendShapeTarget& target = mesh.blend_shape_targets[t];
    const Field field{&at, "blendShapeTargets", t};
    c.equal_lengths(field, {length("vertexIndices", target.vertex_indices),
                            length("deltas.xs", target.deltas.xs)});
    c.vectors(Field{&field, "deltas"}, target.deltas);
    c.indices_below(Field{&field, "vertexIndices"}, target.vertex_indices, mesh.positions.xs.count,
                    "vertices");
    if (target.channel_index >= channels) {
      c.error(Field{&field, "blendShapeChannelIndex"}, Status::kDnaReference,
              c.offset_after(target.vertex_indices), "is %u, but there are %u channels",
              unsigned{target.channel_index}, channels);
    }
  }
}

void check_mesh(Checker& c, const Field& at, const Mesh& mesh) {
  c.vectors(Field{&at, "positions"}, mesh.positions);
  c.vectors(Field{&at, "normals"}, mesh.normals);
  const TextureCoordinates& uvs = mesh.texture_coordinates;
  const Field uv_field{&at, "textureCoordinates"};
  c.equal_lengths(uv_field, {length("us", uvs.us), length("vs", uvs.vs)});
  c.finite(Field{&uv_field, "us"}, uvs.us);
  c.finite(Field{&uv_field, "vs"}, uvs.vs);

  const VertexLayouts& layouts = mesh.layouts;
  const Field field{&at, "layouts"};
  c.equal_lengths(field, {length("positions", layouts.positions),
                          length("textureCoordinates", layouts.texture_coordinates),
                          length("normals", layouts.normals)});
  c.indices_below(Field{&field, "positions"}, layouts.positions, mesh.positions.xs.count,
                  "positions");
  check_optional(c, Field{&field, "textureCoordinates"}, layouts.texture_coordinates, uvs.us.count,
                 "texture coordinates");
  check_optional(c, Field{&field, "normals"}, layouts.normals, mesh.normals.xs.count, "normals");

  check_faces(c, at, mesh);
  check_skin_weights(c, at, mesh);
  check_blend_shape_targets(c, at, mesh);
}

void check_geometry(Checker& c) {
  const List<Mesh>& meshes = c.view.geom.meshes;
  const uint32_t names = c.view.defn.mesh_names.count;
  const Field geom{nullptr, "geom"};
  if (meshes.count > names) {
    c.error(Field{&geom, "meshes"}, Status::kDnaStructure, kNoOffset,
            "has %u elements, but %u meshes have names", meshes.count, names);
  } else if (meshes.count != 0 && meshes.count < names) {
    c.warning(Field{&geom, "meshes"}, kNoOffset, "has %u elements, but %u meshes have names",
              meshes.count, names);
  }
  for (uint32_t m = 0; m < meshes.count && !c.stopped(); ++m) {
    check_mesh(c, Field{&geom, "meshes", m}, meshes[m]);
  }
}

void check_control_count(Checker& c) {
  const uint32_t count = c.view.control_count();
  if (count <= 65536) return;
  c.error(Field{nullptr, "bhvr.controls.psdCount"}, Status::kDnaLimit, kNoOffset,
          "raw, PSD, ML and RBF controls together are %u; at most 65536 can be numbered", count);
}

}  // namespace

bool check_definition(const DnaView& view, const FindingSink& sink, uint64_t lods) {
  Checker c(view, sink, lods);
  check_descriptor(c);
  check_descriptor_extension(c);
  if (view.has(kLayerDefinition)) check_definition_layer(c);
  return c.finish();
}

bool check_layers(const DnaView& view, const FindingSink& sink, uint64_t lods) {
  Checker c(view, sink, lods);
  check_control_count(c);
  // What is not loaded is empty, so these find nothing there.
  check_behavior(c);
  check_extensions(c);
  check_geometry(c);
  return c.finish();
}

}  // namespace mien::dna
