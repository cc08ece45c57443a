/* SPDX-License-Identifier: MIT */
#include "node.h"

#include <stdlib.h>
#include <string.h>

GdPropertyInfo node_fixed_properties[FIXED_PROPERTIES];
GdString node_control_hint;

/* ---- opening -------------------------------------------------------------------------------------- */

void node_close(Node* node) {
  for (uint32_t m = 0; m < node->mesh_count; ++m) surface_close(&node->surfaces[m]);
  for (uint32_t c = 0; c < node->controls.count; ++c)
    gd.destroy[GD_STRING_NAME](&node->controls.names[c]);
  for (int t = 0; t < TARGETS; ++t) free(node->targets[t].indices);
  free(node->surfaces);
  free(node->shown);
  free(node->controls.names);
  free(node->controls.list);
  memset(node->targets, 0, sizeof node->targets);
  node->surfaces = NULL;
  node->shown = NULL;
  memset(&node->controls, 0, sizeof node->controls);
  node->mesh_count = 0;
  face_close(&node->face);
}

/* Meshes that this node made are freed with it; for another rig, they go before. */
void node_drop_geometry(Node* node) {
  for (uint32_t m = 0; m < node->mesh_count; ++m) {
    surface_close(&node->surfaces[m]);
    if (!node->shown[m]) continue;
    GdObject instance = gd.object_get_instance_from_id(node->shown[m]);
    node->shown[m] = 0;
    if (!instance) continue;
    GdVariant nothing = gd_call_object(instance, &gd_names.queue_free, NULL, 0);
    gd.variant_destroy(&nothing);
  }
}

/* The face is open: room for its meshes, and a name for each of its controls. */
static MienStatus prepare_node(Node* node) {
  uint32_t controls = 0, meshes = 0;
  if (mien_rig_count(node->face.rig, MIEN_KIND_RAW_CONTROL, &controls) != MIEN_OK) controls = 0;
  if (mien_rig_count(node->face.rig, MIEN_KIND_MESH, &meshes) != MIEN_OK) meshes = 0;
  node->surfaces = calloc(meshes + 1, sizeof *node->surfaces);
  node->shown = calloc(meshes + 1, sizeof *node->shown);
  ControlProperties* properties = &node->controls;
  properties->names = calloc(controls + 1, sizeof *properties->names);
  properties->list = calloc(FIXED_PROPERTIES + controls, sizeof *properties->list);
  if (!node->surfaces || !node->shown || !properties->names || !properties->list)
    return MIEN_ERROR_MEMORY;
  node->mesh_count = meshes;
  memcpy(properties->list, node_fixed_properties, sizeof node_fixed_properties);
  for (uint32_t c = 0; c < controls; ++c) {
    char name[600] = "controls/";
    face_name(&node->face, MIEN_KIND_RAW_CONTROL, c, name + 9, sizeof name - 9);
    gd.string_name_new_with_utf8_chars(&properties->names[c], name);
    properties->count = c + 1;
    const GdPropertyInfo property = {GD_FLOAT,      &properties->names[c], &gd_names.none,
                                     GD_HINT_RANGE, &node_control_hint,    GD_USAGE_DEFAULT};
    properties->list[FIXED_PROPERTIES + c] = property;
  }
  node->is_changed = 1;
  return MIEN_OK;
}

static int64_t finish_opening(Node* node, MienStatus status, const MienError* error) {
  if (status == MIEN_OK) status = prepare_node(node);
  if (status != MIEN_OK) {
    node_close(node);
    gd.print_error(error->message[0] ? error->message : mien_status_name(status), "MienFace3D",
                   __FILE__, __LINE__, 1);
  }
  GdVariant nothing = gd_call_object(node->object, &gd_names.notify_property_list_changed, NULL, 0);
  gd.variant_destroy(&nothing);
  return status;
}

int64_t node_open(Node* node, const char* path) {
  MienError error = mien_error_default();
  node_drop_geometry(node);
  node_close(node);
  return finish_opening(node, face_open(&node->face, path, &error), &error);
}

/* Opens what a MienRig has, or closes the face. */
void node_open_resource(Node* node) {
  MienError error = mien_error_default();
  node_drop_geometry(node);
  node_close(node);
  if (!gd_object_of(&node->rig)) return;
  GdVariant name = gd_value(GD_STRING_NAME, &gd_names.baked);
  GdVariant baked = gd_call(&node->rig, &gd_names.get, &name, 1);
  if (gd.variant_get_type(&baked) != GD_PACKED_BYTES) {
    gd.print_error("the rig is no MienRig", "MienFace3D", __FILE__, __LINE__, 1);
    gd.variant_destroy(&baked);
    return;
  }
  const int64_t size = gd_call_int(&baked, &gd_names.size, NULL, 0);
  GdPackedArray bytes;
  gd.to[GD_PACKED_BYTES](&bytes, &baked);
  const void* data =
      size > 0 ? (const void*)gd.packed_byte_array_operator_index_const(&bytes, 0) : "";
  finish_opening(node, face_open_bytes(&node->face, data, size > 0 ? (size_t)size : 0, &error),
                 &error);
  gd.destroy[GD_PACKED_BYTES](&bytes);
  gd.variant_destroy(&baked);
}

float* node_control(Node* node, uint32_t control) {
  MienMutableFloatView controls;
  return node->face.instance &&
                 mien_instance_raw_controls(node->face.instance, &controls) == MIEN_OK &&
                 control < controls.count
             ? controls.data + control
             : NULL;
}

/* ---- driving -------------------------------------------------------------------------------------- */

/* Finds what has the names of a kind in an object, unless that was done. */
static const int64_t* find_targets(Node* node, Targets* targets, GdObject object, uint32_t kind,
                                   uint32_t count, const GdStringName* find) {
  const uint64_t instance = gd.object_get_instance_id(object);
  if (targets->indices && targets->instance == instance) return targets->indices;
  free(targets->indices);
  targets->instance = instance;
  targets->indices = malloc((count ? count : 1) * sizeof(int64_t));
  if (!targets->indices) return NULL;
  GdVariant self = gd_value(GD_OBJECT, &object);
  for (uint32_t i = 0; i < count; ++i) {
    char text[512];
    face_name(&node->face, kind, i, text, sizeof text);
    GdVariant name = gd_text(text);
    targets->indices[i] = gd_call_int(&self, find, &name, 1);
  }
  gd.variant_destroy(&self);
  return targets->indices;
}

static void set_target(GdVariant* self, const GdStringName* method, int64_t index, int32_t type,
                       const void* value) {
  GdVariant arguments[2] = {gd_int(index), gd_value(type, value)};
  GdVariant nothing = gd_call(self, method, arguments, 2);
  gd.variant_destroy(&nothing);
}

uint8_t node_drive_skeleton(Node* node, GdObject skeleton) {
  if (!node->face.pose || !skeleton) return 0;
  const int64_t* bones = find_targets(node, &node->targets[SKELETON], skeleton, MIEN_KIND_JOINT,
                                      node->face.joint_count, &gd_names.find_bone);
  if (!bones || !face_read_transforms(&node->face)) return 0;
  GdVariant self = gd_value(GD_OBJECT, &skeleton);
  for (uint32_t j = 0; j < node->face.joint_count; ++j) {
    if (bones[j] < 0) continue;
    const float* t = node->face.transforms + (size_t)10 * j;
    set_target(&self, &gd_names.set_bone_pose_position, bones[j], GD_VECTOR3, t);
    set_target(&self, &gd_names.set_bone_pose_rotation, bones[j], GD_QUATERNION, t + 3);
    set_target(&self, &gd_names.set_bone_pose_scale, bones[j], GD_VECTOR3, t + 7);
  }
  gd.variant_destroy(&self);
  return 1;
}

uint8_t node_drive_mesh(Node* node, GdObject mesh) {
  MienFloatView weights;
  if (!node->face.instance || !mesh) return 0;
  const int64_t* shapes =
      find_targets(node, &node->targets[MESH], mesh, MIEN_KIND_BLEND_SHAPE_CHANNEL,
                   node->face.channel_count, &gd_names.find_blend_shape_by_name);
  if (!shapes || mien_instance_blend_shapes(node->face.instance, &weights) != MIEN_OK) return 0;
  GdVariant self = gd_value(GD_OBJECT, &mesh);
  for (uint32_t c = 0; c < node->face.channel_count && c < weights.count; ++c) {
    if (shapes[c] < 0) continue;
    const double weight = (double)weights.data[c];
    set_target(&self, &gd_names.set_blend_shape_value, shapes[c], GD_FLOAT, &weight);
  }
  gd.variant_destroy(&self);
  return 1;
}

uint8_t node_drive_vertices(Node* node, GdObject mesh_instance, const char* name) {
  uint32_t mesh = 0;
  if (!node->face.rig || mien_rig_find(node->face.rig, MIEN_KIND_MESH, name, &mesh) != MIEN_OK ||
      mesh >= node->mesh_count)
    return 0;
  return surface_show(&node->surfaces[mesh], &node->face, mesh, mesh_instance);
}

/* The MeshInstance3D below this node that shows a mesh. It is internal: neither in the scene tree of the editor nor saved. */
static GdObject shown_mesh(Node* node, uint32_t mesh) {
  enum { INTERNAL_MODE_FRONT = 1 };
  GdObject instance = node->shown[mesh] ? gd.object_get_instance_from_id(node->shown[mesh]) : NULL;
  if (instance) return instance;
  instance = gd.classdb_construct_object(&gd_names.MeshInstance3D);
  GdVariant arguments[3] = {gd_value(GD_OBJECT, &instance), gd_bool(0),
                            gd_int(INTERNAL_MODE_FRONT)};
  GdVariant nothing = gd_call_object(node->object, &gd_names.add_child, arguments, 3);
  gd.variant_destroy(&nothing);
  node->shown[mesh] = gd.object_get_instance_id(instance);
  return instance;
}

/* Shows the meshes of the LOD, and hides the others. */
static void show_geometry(Node* node) {
  for (uint32_t m = 0; m < node->mesh_count && node->face.deformer; ++m) {
    MienMesh mesh = mien_mesh_default();
    if (mien_deformer_mesh(node->face.deformer, m, &mesh) != MIEN_OK) continue;
    const uint8_t is_shown = mesh.lods >> node->lod & 1;
    if (!is_shown && !node->shown[m]) continue;
    GdObject instance = shown_mesh(node, m);
    GdVariant visible = gd_bool(is_shown);
    GdVariant nothing = gd_call_object(instance, &gd_names.set_visible, &visible, 1);
    gd.variant_destroy(&nothing);
    if (is_shown) surface_show(&node->surfaces[m], &node->face, m, instance);
  }
}

/* The node at a path; NULL if there is none. */
static GdObject find_node(const Node* node, int target) {
  if (gd.variant_get_type(&node->paths[target]) != GD_NODE_PATH) return NULL;
  GdVariant path = gd_copy(&node->paths[target]);
  GdVariant found = gd_call_object(node->object, &gd_names.get_node_or_null, &path, 1);
  GdObject object = gd_object_of(&found);
  gd.variant_destroy(&found);
  return object;
}

void node_show(Node* node) {
  GdObject skeleton = find_node(node, SKELETON), mesh = find_node(node, MESH);
  if (!skeleton && !mesh && !node->shows_geometry) return;
  if (!face_evaluate(&node->face, node->lod)) {
    gd.print_error("the rig does not have this LOD", "MienFace3D", __FILE__, __LINE__, 1);
    return;
  }
  node_drive_skeleton(node, skeleton);
  node_drive_mesh(node, mesh);
  if (node->shows_geometry) show_geometry(node);
}
