// SPDX-License-Identifier: MIT
// A good rig passes in silence; each way to break one thing is found, at its place, as what it is.
#include "runtime/load/dna/check/dna_check.h"

#include <gtest/gtest.h>

#include "tests/support/damage.h"

namespace mien::dna {
namespace {

TEST(DnaCheckTest, TinyRigIsClean) {
  Arena arena(default_allocator());
  const DnaView view = tiny_rig(arena);
  for (bool thorough : {false, true}) {
    KeptFindings report;
    EXPECT_TRUE(check(view, report, thorough));
    EXPECT_EQ(report.findings.size(), 0u) << report.text();
  }
}

TEST(DnaCheckTest, NothingIsClean) {
  for (uint32_t loaded : {uint32_t{kLayerDescriptor}, uint32_t{kLayersAll}}) {
    DnaView view;
    view.loaded = loaded;
    view.desc.coordinate_system = {1, 2, 4};
    for (const uint16_t lods : {0, 2}) {  // of which nothing has a list
      view.desc.lod_count = lods;
      KeptFindings report;
      EXPECT_TRUE(check(view, report, true));
      EXPECT_EQ(report.findings.size(), 0u) << report.text();
    }
  }
}

// Damage ----------------------------------------------------------------------------------------

JointGroup& group(DnaView& v, size_t g) { return v.bhvr.joints.groups[g]; }
Mesh& mesh(DnaView& v) { return v.geom.meshes[0]; }

List<String> many_names(Arena& a, size_t count) {
  const Span<String> span = a.array<String>(count);
  for (String& name : span) name = text("x");
  return {span.data, static_cast<uint32_t>(count)};
}

const Damage kDefinitionCases[] = {
    {"LodCount", kLimit, "desc.lodCount", [](DnaView& v, Arena&) { v.desc.lod_count = 34; }},
    {"Archetype", kWarning, "desc.archetype", [](DnaView& v, Arena&) { v.desc.archetype = 6; }},
    {"Gender", kWarning, "desc.gender", [](DnaView& v, Arena&) { v.desc.gender = 3; }},
    {"TranslationUnit", kValue, "desc.translationUnit",
     [](DnaView& v, Arena&) { v.desc.translation_unit = 2; }},
    {"RotationUnit", kValue, "desc.rotationUnit",
     [](DnaView& v, Arena&) { v.desc.rotation_unit = 2; }},
    {"UnknownAxisX", kValue, "desc.coordinateSystem.xAxis",
     [](DnaView& v, Arena&) { v.desc.coordinate_system.x_axis = 6; }},
    {"UnknownAxisY", kValue, "desc.coordinateSystem.yAxis",
     [](DnaView& v, Arena&) { v.desc.coordinate_system.y_axis = 6; }},
    {"UnknownAxisZ", kValue, "desc.coordinateSystem.zAxis",
     [](DnaView& v, Arena&) { v.desc.coordinate_system.z_axis = 6; }},
    {"SingularAxes", kWarning, "desc.coordinateSystem",
     [](DnaView& v, Arena&) {
       v.desc.coordinate_system = {1, 0, 4};
     }},
    {"SingularAxesYZ", kWarning, "desc.coordinateSystem",
     [](DnaView& v, Arena&) {
       v.desc.coordinate_system = {1, 4, 5};
     }},
    {"SingularAxesZX", kWarning, "desc.coordinateSystem",
     [](DnaView& v, Arena&) {
       v.desc.coordinate_system = {1, 2, 0};
     }},
    {"DuplicateMetadata", kWarning, "desc.metadata[2].key",
     [](DnaView& v, Arena& a) {
       v.desc.metadata = list<MetadataPair>(
           a, {{text("a"), text("1")}, {text("b"), text("2")}, {text("a"), text("3")}});
     }},
    {"RotationSequence", kValue, "dsce.rotationSequence",
     [](DnaView& v, Arena&) { v.dsce.rotation_sequence = 6; }},
    {"RotationSign", kValue, "dsce.rotationSign.y",
     [](DnaView& v, Arena&) { v.dsce.rotation_sign.y = 0; }},
    {"FaceWinding", kValue, "dsce.faceWindingOrder",
     [](DnaView& v, Arena&) { v.dsce.face_winding_order = 2; }},

    {"LodList", kReference, "defn.lodJointMapping.lods",
     [](DnaView& v, Arena& a) {
       v.defn.lod_joints.lods = be(a, U16{0, 2});
     }},
    {"LodJoint", kReference, "defn.lodJointMapping.indices[1]",
     [](DnaView& v, Arena& a) {
       v.defn.lod_joints.indices[1] = be(a, U16{0, 3});
     }},
    {"LodChannel", kReference, "defn.lodBlendShapeMapping.indices[0]",
     [](DnaView& v, Arena& a) {
       v.defn.lod_channels.indices[0] = be(a, U16{0, 2});
     }},
    {"LodMap", kReference, "defn.lodAnimatedMapMapping.indices[0]",
     [](DnaView& v, Arena& a) { v.defn.lod_maps.indices[0] = be(a, U16{1}); }},
    {"LodMesh", kReference, "defn.lodMeshMapping.indices[0]",
     [](DnaView& v, Arena& a) { v.defn.lod_meshes.indices[0] = be(a, U16{1}); }},
    {"LodMapShort", kWarning, "defn.lodMeshMapping.lods",
     [](DnaView& v, Arena& a) { v.defn.lod_meshes.lods = be(a, U16{0}); }},
    {"LodMapLong", kWarning, "defn.lodMeshMapping.lods",
     [](DnaView& v, Arena& a) {
       v.defn.lod_meshes.lods = be(a, U16{0, 0, 0});
     }},
    {"LodDuplicate", kWarning, "defn.lodJointMapping.indices[1]",
     [](DnaView& v, Arena& a) {
       v.defn.lod_joints.indices[1] = be(a, U16{0, 1, 0});
     }},
    {"LodZeroLacksJoint", kWarning, "defn.lodJointMapping.indices[1]",
     [](DnaView& v, Arena& a) {
       v.defn.lod_joints.indices[0] = be(a, U16{0, 2});
     }},

    {"TooManyJointsForTheirValues", kLimit, "defn.jointNames",
     [](DnaView& v, Arena& a) { v.defn.joint_names = many_names(a, 65536 / 9 + 1); }},
    {"AsManyJointsAsHaveNumbers", kLimit, "defn.jointNames",
     [](DnaView& v, Arena& a) { v.defn.joint_names = many_names(a, 65535); }},
    {"TooManyGuiControls", kLimit, "defn.guiControlNames",
     [](DnaView& v, Arena& a) { v.defn.gui_control_names = many_names(a, 65536); }},
    {"TooManyRawControls", kLimit, "defn.rawControlNames",
     [](DnaView& v, Arena& a) { v.defn.raw_control_names = many_names(a, 65536); }},
    {"TooManyJoints", kLimit, "defn.jointNames",
     [](DnaView& v, Arena& a) { v.defn.joint_names = many_names(a, 65536); }},
    {"TooManyJointsWithParents", kLimit, "defn.jointNames",
     [](DnaView& v, Arena& a) {
       v.defn.joint_names = many_names(a, 65536);
       const NewArray<uint16_t> parents = new_array<uint16_t>(a, 65536);
       for (uint32_t j = 0; j < parents.count; ++j) parents.set(j, 0);
       v.defn.joint_hierarchy = parents;
     }},
    {"TooManyChannels", kLimit, "defn.blendShapeChannelNames",
     [](DnaView& v, Arena& a) { v.defn.channel_names = many_names(a, 65536); }},
    {"TooManyMaps", kLimit, "defn.animatedMapNames",
     [](DnaView& v, Arena& a) { v.defn.map_names = many_names(a, 65536); }},
    {"TooManyMeshes", kLimit, "defn.meshNames",
     [](DnaView& v, Arena& a) { v.defn.mesh_names = many_names(a, 65536); }},
    {"TooManyJointValues", kLimit, "defn.jointNames",
     [](DnaView& v, Arena& a) { v.defn.joint_names = many_names(a, 7282); }},
    {"NulInName", kWarning, "defn.jointNames[1]",
     [](DnaView& v, Arena&) {
       v.defn.joint_names[1] = {reinterpret_cast<const uint8_t*>("ja\0w"), 4};
     }},
    {"MappingMesh", kReference, "defn.meshBlendShapeChannelMapping.from",
     [](DnaView& v, Arena& a) { v.defn.mesh_channels.from = be(a, U16{1}); }},
    {"MappingChannel", kReference, "defn.meshBlendShapeChannelMapping.to",
     [](DnaView& v, Arena& a) { v.defn.mesh_channels.to = be(a, U16{2}); }},
    {"MappingLengths", kStructure, "defn.meshBlendShapeChannelMapping.to",
     [](DnaView& v, Arena&) { v.defn.mesh_channels.to = {}; }},

    {"ParentMissing", kReference, "defn.jointHierarchy",
     [](DnaView& v, Arena& a) {
       v.defn.joint_hierarchy = be(a, U16{0, 3, 1});
     }},
    {"ParentsShort", kStructure, "defn.jointHierarchy",
     [](DnaView& v, Arena& a) {
       v.defn.joint_hierarchy = be(a, U16{0, 0});
     }},
    {"ParentCycle", kValue, "defn.jointHierarchy",
     [](DnaView& v, Arena& a) {
       v.defn.joint_hierarchy = be(a, U16{0, 2, 1});
     }},
    {"ParentCycleWithTail", kValue, "defn.jointHierarchy",
     [](DnaView& v, Arena& a) {
       v.defn.joint_hierarchy = be(a, U16{1, 2, 1});
     }},
    {"TwoRoots", kWarning, "defn.jointHierarchy",
     [](DnaView& v, Arena& a) {
       v.defn.joint_hierarchy = be(a, U16{0, 1, 1});
     }},
    {"NeutralShort", kStructure, "defn.neutralJointTranslations.xs",
     [](DnaView& v, Arena& a) {
       v.defn.neutral_translations.xs = be(a, F32{0, 0});
     }},
    {"NeutralUneven", kStructure, "defn.neutralJointRotations.zs",
     [](DnaView& v, Arena& a) {
       v.defn.neutral_rotations.zs = be(a, F32{0, 0});
     }},
    {"NeutralNan", kWarning, "defn.neutralJointTranslations.ys",
     [](DnaView& v, Arena& a) {
       v.defn.neutral_translations.ys = be(a, F32{0, kNan, 0});
     }},
};

const Damage kBehaviorCases[] = {
    {"GuiInput", kReference, "bhvr.controls.conditionals.inputIndices",
     [](DnaView& v, Arena& a) {
       v.bhvr.controls.conditionals.input_indices = be(a, U16{0, 2, 1});
     }},
    {"RawOutput", kReference, "bhvr.controls.conditionals.outputIndices",
     [](DnaView& v, Arena& a) {
       v.bhvr.controls.conditionals.output_indices = be(a, U16{0, 1, 3});
     }},
    {"ConditionalLengths", kStructure, "bhvr.controls.conditionals.cutValues",
     [](DnaView& v, Arena& a) {
       v.bhvr.controls.conditionals.cut_values = be(a, F32{0, 0});
     }},
    {"ConditionalInfinity", kWarning, "bhvr.controls.conditionals.slopeValues",
     [](DnaView& v, Arena& a) {
       v.bhvr.controls.conditionals.slope_values = be(a, F32{1, kInfinity, 1});
     }},
    {"ConditionalNanFrom", kWarning, "bhvr.controls.conditionals.fromValues",
     [](DnaView& v, Arena& a) {
       v.bhvr.controls.conditionals.from_values = be(a, F32{0, kNan, -1});
     }},
    {"ConditionalNanTo", kWarning, "bhvr.controls.conditionals.toValues",
     [](DnaView& v, Arena& a) {
       v.bhvr.controls.conditionals.to_values = be(a, F32{1, kNan, 0});
     }},
    {"ConditionalNanCut", kWarning, "bhvr.controls.conditionals.cutValues",
     [](DnaView& v, Arena& a) {
       v.bhvr.controls.conditionals.cut_values = be(a, F32{kNan, 0, 0});
     }},
    {"PsdNan", kWarning, "bhvr.controls.psds.values",
     [](DnaView& v, Arena& a) {
       v.bhvr.controls.psds.values = be(a, F32{1, 1, 1, kNan});
     }},
    {"PsdRowBelow", kReference, "bhvr.controls.psds.rows",
     [](DnaView& v, Arena& a) {
       v.bhvr.controls.psds.rows = be(a, U16{2, 3, 4, 4});
     }},
    {"PsdRowAbove", kReference, "bhvr.controls.psds.rows",
     [](DnaView& v, Arena& a) {
       v.bhvr.controls.psds.rows = be(a, U16{3, 3, 4, 5});
     }},
    {"PsdColumn", kReference, "bhvr.controls.psds.columns",
     [](DnaView& v, Arena& a) {
       v.bhvr.controls.psds.columns = be(a, U16{0, 1, 0, 11});
     }},
    {"PsdLengths", kStructure, "bhvr.controls.psds.values",
     [](DnaView& v, Arena& a) {
       v.bhvr.controls.psds.values = be(a, F32{1, 1, 1});
     }},
    {"TooManyControls", kLimit, "bhvr.controls.psdCount",
     [](DnaView& v, Arena&) { v.bhvr.controls.psd_count = 65530; }},

    {"TooManyJointGroups", kLimit, "bhvr.joints.jointGroups",
     [](DnaView& v, Arena& a) { v.bhvr.joints.groups = too_many<JointGroup>(a); }},
    {"JointInput", kReference, "bhvr.joints.jointGroups[1].inputIndices",
     [](DnaView& v, Arena& a) {
       group(v, 1).input_indices = be(a, U16{0, 4, 11});
     }},
    {"JointValue", kReference, "bhvr.joints.jointGroups[1].outputIndices",
     [](DnaView& v, Arena& a) {
       group(v, 1).output_indices = be(a, U16{21, 22, 23, 27});
     }},
    {"GroupJoint", kReference, "bhvr.joints.jointGroups[0].jointIndices",
     [](DnaView& v, Arena& a) {
       group(v, 0).joint_indices = be(a, U16{1, 3});
     }},
    {"GroupValues", kStructure, "bhvr.joints.jointGroups[0].values",
     [](DnaView& v, Arena& a) {
       group(v, 0).values = be(a, F32{1, 2, 3, 4, 5});
     }},
    {"GroupLodsShort", kStructure, "bhvr.joints.jointGroups[0].lods",
     [](DnaView& v, Arena& a) { group(v, 0).lods = be(a, U16{3}); }},
    {"GroupLodsLarge", kStructure, "bhvr.joints.jointGroups[0].lods",
     [](DnaView& v, Arena& a) {
       group(v, 0).lods = be(a, U16{4, 1});
     }},
    {"GroupLodsRising", kValue, "bhvr.joints.jointGroups[0].lods",
     [](DnaView& v, Arena& a) {
       group(v, 0).lods = be(a, U16{1, 2});
     }},
    {"GroupLodsLong", kWarning, "bhvr.joints.jointGroups[0].lods",
     [](DnaView& v, Arena& a) {
       group(v, 0).lods = be(a, U16{3, 1, 0});
     }},
    {"GroupRowsUnused", kWarning, "bhvr.joints.jointGroups[0].lods",
     [](DnaView& v, Arena& a) {
       group(v, 0).lods = be(a, U16{2, 1});
     }},
    {"GroupNan", kWarning, "bhvr.joints.jointGroups[0].values",
     [](DnaView& v, Arena& a) {
       group(v, 0).values = be(a, F32{1, 2, 3, 4, 5, kNan});
     }},
    {"GroupColumnTwice", kWarning, "bhvr.joints.jointGroups[0].inputIndices",
     [](DnaView& v, Arena& a) {
       group(v, 0).input_indices = be(a, U16{3, 3});
     }},
    {"RowTwiceInGroup", kWarning, "bhvr.joints.jointGroups[0].outputIndices",
     [](DnaView& v, Arena& a) {
       group(v, 0).output_indices = be(a, U16{12, 10, 12});
     }},
    {"RowInTwoGroups", kWarning, "bhvr.joints.jointGroups[1].outputIndices",
     [](DnaView& v, Arena& a) {
       group(v, 1).output_indices = be(a, U16{21, 22, 23, 12});
       group(v, 1).joint_indices = be(a, U16{1, 2});
     }},
    {"GroupLacksJoint", kWarning, "bhvr.joints.jointGroups[1].jointIndices",
     [](DnaView& v, Arena& a) { group(v, 1).joint_indices = be(a, U16{0}); }},
    {"RowsOfManyGroups", kWarning, "bhvr.joints.jointGroups[1].outputIndices",
     [](DnaView& v, Arena& a) {
       v.bhvr.joints.groups = list<JointGroup>(a, {group(v, 0), group(v, 0), group(v, 1)});
     }},
    {"RowCount", kWarning, "bhvr.joints.rowCount",
     [](DnaView& v, Arena&) { v.bhvr.joints.row_count = 26; }},
    {"ColCount", kWarning, "bhvr.joints.colCount",
     [](DnaView& v, Arena&) { v.bhvr.joints.col_count = 10; }},

    {"ChannelInput", kReference, "bhvr.blendShapeChannels.inputIndices",
     [](DnaView& v, Arena& a) {
       v.bhvr.channels.input_indices = be(a, U16{0, 11});
     }},
    {"ChannelOutput", kReference, "bhvr.blendShapeChannels.outputIndices",
     [](DnaView& v, Arena& a) {
       v.bhvr.channels.output_indices = be(a, U16{0, 2});
     }},
    {"ChannelLengths", kStructure, "bhvr.blendShapeChannels.outputIndices",
     [](DnaView& v, Arena& a) { v.bhvr.channels.output_indices = be(a, U16{0}); }},
    {"ChannelLodsShort", kStructure, "bhvr.blendShapeChannels.lods",
     [](DnaView& v, Arena&) { v.bhvr.channels.lods = {}; }},
    {"ChannelLodsRising", kValue, "bhvr.blendShapeChannels.lods",
     [](DnaView& v, Arena& a) {
       v.bhvr.channels.lods = be(a, U16{1, 2});
     }},
    {"ChannelTwice", kWarning, "bhvr.blendShapeChannels.outputIndices",
     [](DnaView& v, Arena& a) {
       v.bhvr.channels.output_indices = be(a, U16{1, 1});
     }},
    {"MapInput", kReference, "bhvr.animatedMaps.conditionals.inputIndices",
     [](DnaView& v, Arena& a) { v.bhvr.maps.conditionals.input_indices = be(a, U16{11}); }},
    {"MapOutput", kReference, "bhvr.animatedMaps.conditionals.outputIndices",
     [](DnaView& v, Arena& a) { v.bhvr.maps.conditionals.output_indices = be(a, U16{1}); }},
    {"MapLodsLarge", kStructure, "bhvr.animatedMaps.lods",
     [](DnaView& v, Arena& a) {
       v.bhvr.maps.lods = be(a, U16{2, 0});
     }},
    {"MapLengths", kStructure, "bhvr.animatedMaps.conditionals.toValues",
     [](DnaView& v, Arena&) { v.bhvr.maps.conditionals.to_values = {}; }},
};

const Damage kGeometryCases[] = {
    {"MoreMeshesThanNames", kStructure, "geom.meshes",
     [](DnaView& v, Arena& a) {
       v.geom.meshes = list<Mesh>(a, {mesh(v), Mesh{}});
     }},
    {"FewerMeshesThanNames", kWarning, "geom.meshes",
     [](DnaView& v, Arena& a) {
       v.defn.mesh_names = list<String>(a, {text("face"), text("eye")});
     }},
    {"PositionLengths", kStructure, "geom.meshes[0].positions.ys",
     [](DnaView& v, Arena& a) {
       mesh(v).positions.ys = be(a, F32{0, 0});
     }},
    {"PositionNan", kWarning, "geom.meshes[0].positions.zs",
     [](DnaView& v, Arena& a) {
       mesh(v).positions.zs = be(a, F32{0, 0, 0, 0, 0, kNan});
     }},
    {"NormalLengths", kStructure, "geom.meshes[0].normals.zs",
     [](DnaView& v, Arena&) { mesh(v).normals.zs = {}; }},
    {"UvLengths", kStructure, "geom.meshes[0].textureCoordinates.vs",
     [](DnaView& v, Arena&) { mesh(v).texture_coordinates.vs = {}; }},
    {"UvNan", kWarning, "geom.meshes[0].textureCoordinates.us",
     [](DnaView& v, Arena& a) {
       mesh(v).texture_coordinates.us = be(a, F32{0, 0, 0, 0, 0, kNan});
     }},
    {"UvInfinity", kWarning, "geom.meshes[0].textureCoordinates.vs",
     [](DnaView& v, Arena& a) {
       mesh(v).texture_coordinates.vs = be(a, F32{kInfinity, 0, 0, 0, 0, 0});
     }},
    {"LayoutLengths", kStructure, "geom.meshes[0].layouts.normals",
     [](DnaView& v, Arena& a) {
       mesh(v).layouts.normals = be(a, U32{0, 1, 2, 3, 4});
     }},
    {"LayoutPosition", kReference, "geom.meshes[0].layouts.positions",
     [](DnaView& v, Arena& a) {
       mesh(v).layouts.positions = be(a, U32{0, 1, 2, 3, 4, 6});
     }},
    {"LayoutUv", kReference, "geom.meshes[0].layouts.textureCoordinates",
     [](DnaView& v, Arena& a) {
       mesh(v).layouts.texture_coordinates = be(a, U32{0, 1, 2, 3, 4, 70000});
     }},
    {"LayoutNormal", kReference, "geom.meshes[0].layouts.normals",
     [](DnaView& v, Arena& a) {
       mesh(v).layouts.normals = be(a, U32{0xffffffff, 1, 2, 3, 4, 5});
     }},
    {"LayoutWithoutNormals", kWarning, "geom.meshes[0].layouts.normals",
     [](DnaView& v, Arena&) { mesh(v).normals = {}; }},
    {"FaceLayout", kReference, "geom.meshes[0].faces[1].layoutIndices",
     [](DnaView& v, Arena& a) {
       mesh(v).faces[1].layout_indices = be(a, U32{1, 2, 5, 6});
     }},
    {"FaceOfTwo", kWarning, "geom.meshes[0].faces[1].layoutIndices",
     [](DnaView& v, Arena& a) {
       mesh(v).faces[1].layout_indices = be(a, U32{1, 2});
     }},
    {"SkinCount", kStructure, "geom.meshes[0].skinWeights",
     [](DnaView& v, Arena&) { mesh(v).skin_weights.count = 5; }},
    {"SkinLengths", kStructure, "geom.meshes[0].skinWeights[3].jointIndices",
     [](DnaView& v, Arena& a) {
       mesh(v).skin_weights[3].joint_indices = be(a, U16{0, 1});
     }},
    {"SkinJoint", kReference, "geom.meshes[0].skinWeights[5].jointIndices",
     [](DnaView& v, Arena& a) { mesh(v).skin_weights[5].joint_indices = be(a, U16{3}); }},
    {"SkinSum", kWarning, "geom.meshes[0].skinWeights[0].weights",
     [](DnaView& v, Arena& a) {
       mesh(v).skin_weights[0].weights = be(a, F32{0.25f, 0.7f});
     }},
    {"SkinNan", kWarning, "geom.meshes[0].skinWeights[0].weights",
     [](DnaView& v, Arena& a) {
       mesh(v).skin_weights[0].weights = be(a, F32{0.25f, kNan});
     }},
    {"MaximumInfluence", kWarning, "geom.meshes[0].maximumInfluencePerVertex",
     [](DnaView& v, Arena&) { mesh(v).maximum_influence_per_vertex = 1; }},
    {"TargetLengths", kStructure, "geom.meshes[0].blendShapeTargets[0].deltas.xs",
     [](DnaView& v, Arena& a) {
       mesh(v).blend_shape_targets[0].vertex_indices = be(a, U32{1, 2, 3});
     }},
    {"DeltaLengths", kStructure, "geom.meshes[0].blendShapeTargets[0].deltas.zs",
     [](DnaView& v, Arena&) { mesh(v).blend_shape_targets[0].deltas.zs = {}; }},
    {"TargetVertex", kReference, "geom.meshes[0].blendShapeTargets[0].vertexIndices",
     [](DnaView& v, Arena& a) {
       mesh(v).blend_shape_targets[0].vertex_indices = be(a, U32{1, 6});
     }},
    {"TargetChannel", kReference, "geom.meshes[0].blendShapeTargets[0].blendShapeChannelIndex",
     [](DnaView& v, Arena&) { mesh(v).blend_shape_targets[0].channel_index = 2; }},
    {"DeltaNan", kWarning, "geom.meshes[0].blendShapeTargets[0].deltas.xs",
     [](DnaView& v, Arena& a) {
       mesh(v).blend_shape_targets[0].deltas.xs = be(a, F32{kNan, 0});
     }},
};

class DnaCheck : public testing::TestWithParam<Damage> {};
TEST_P(DnaCheck, FindsIt) { expect_found(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Definition, DnaCheck, testing::ValuesIn(kDefinitionCases), damage_name);
INSTANTIATE_TEST_SUITE_P(Behavior, DnaCheck, testing::ValuesIn(kBehaviorCases), damage_name);
INSTANTIATE_TEST_SUITE_P(Geometry, DnaCheck, testing::ValuesIn(kGeometryCases), damage_name);

// What is allowed -------------------------------------------------------------------------------

TEST(DnaCheckTest, EmptyGroupNeedsNoLods) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  JointGroup& g = group(view, 1);
  g = {};
  expect_no_findings(view);
  g.lods = be(arena, U16{0, 0});
  g.input_indices = be(arena, U16{0, 1});
  g.joint_indices = be(arena, U16{2});
  expect_no_findings(view);
}

TEST(DnaCheckTest, ParentMayComeAfterChild) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  view.defn.joint_hierarchy = be(arena, U16{2, 0, 2});
  expect_no_findings(view);
}

TEST(DnaCheckTest, MeshMayHaveNoSkin) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  mesh(view).skin_weights = {};
  expect_no_findings(view);
}

// Controls of layers that were left out cannot be told from those that never were.
TEST(DnaCheckTest, ControlsOfLayersNotLoaded) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  group(view, 1).input_indices = be(arena, U16{0, 4, 12});
  KeptFindings strict;
  check(view, strict, false);
  EXPECT_TRUE(strict.has(kReference, "bhvr.joints.jointGroups[1].inputIndices"));

  view.loaded &= ~uint32_t{kLayerRbf};
  view.rbfb = {};
  view.rbfe = {};
  KeptFindings lenient;
  EXPECT_TRUE(check(view, lenient, false));
  EXPECT_EQ(lenient.findings.size(), 0u) << lenient.text();
  // Those that are there are not told of.
  view.bhvr.joints.col_count = 13;
  KeptFindings thorough;
  EXPECT_TRUE(check(view, thorough, true));
  ASSERT_EQ(thorough.findings.size(), 1u) << thorough.text();
  EXPECT_TRUE(thorough.has(kWarning, "bhvr.joints.jointGroups[1].inputIndices"));
}

// Correctives of correctives: circles are left to the compilation of a rig ------------------------

TEST(DnaCheckTest, CorrectiveOfCorrective) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  view.bhvr.controls.psds.columns = be(arena, U16{0, 4, 0, 2});
  expect_no_findings(view);
}

// Many joints, worst orders ----------------------------------------------------------------------

// Walks are bounded by the square of the joints that a file can have: nothing to measure.
TEST(DnaCheckTest, CirclesOfLongHierarchies) {
  constexpr uint16_t kJoints = 7281;
  Arena arena(default_allocator());
  DnaView view;
  view.loaded = kLayersAll;
  view.desc.coordinate_system = {1, 2, 4};
  view.defn.joint_names = many_names(arena, kJoints);
  const NewArray<float> zeros = new_array<float>(arena, kJoints);
  for (size_t i = 0; i < kJoints; ++i) zeros.set(i, 0.0f);
  view.defn.neutral_translations = view.defn.neutral_rotations = {zeros, zeros, zeros};

  const NewArray<uint16_t> chain = new_array<uint16_t>(arena, kJoints);
  for (uint16_t j = 0; j < kJoints; ++j) chain.set(j, j + 1 < kJoints ? j + 1 : j);
  view.defn.joint_hierarchy = chain;
  expect_no_findings(view);

  chain.set(kJoints - 1, 0);  // one cycle through all
  KeptFindings ring;
  check(view, ring, true);
  EXPECT_EQ(ring.errors(), 1u) << ring.text();

  for (uint16_t j = 0; j + 1 < kJoints; j += 2) chain.set(j, j + 1), chain.set(j + 1, j);
  chain.set(kJoints - 1, kJoints - 1);
  KeptFindings pairs;
  check(view, pairs, true);
  EXPECT_EQ(pairs.errors(), 32u) << pairs.text();
}

}  // namespace
}  // namespace mien::dna
