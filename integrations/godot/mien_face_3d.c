/* SPDX-License-Identifier: MIT
 * MienFace3D: a node of Godot 4 that is one character. It has a rig and its controls as properties, evaluates when they
 * change, and shows the result: in the bones of a Skeleton3D and the blend shapes of a MeshInstance3D that have the names of
 * joints and channels, or in meshes of its own. Extension classes run in the editor as in the game. */
#include <stdlib.h>
#include <string.h>

#include "classes.h"
#include "node.h"

static GdString hints[4]; /* none, MienRig, Skeleton3D, MeshInstance3D */

/* _process(delta): each frame, in the editor and in the game. Does nothing unless a property changed. */
static void process(void* instance, const void* const* arguments, void* result) {
  (void)arguments, (void)result;
  Node* node = instance;
  if (!node->is_changed || !node->face.instance) return;
  node->is_changed = 0;
  node_show(node);
}

static GdVirtual get_virtual(void* userdata, const GdStringName* name) {
  (void)userdata;
  return gd_is_equal(name, &gd_names._process) ? process : NULL;
}

/* ---- properties ------------------------------------------------------------------------------------ */

static int find_control(const Node* node, const GdStringName* name, uint32_t* out_control) {
  for (uint32_t c = 0; c < node->controls.count; ++c) {
    if (!gd_is_equal(name, &node->controls.names[c])) continue;
    *out_control = c;
    return 1;
  }
  return 0;
}

static double number_of(const GdVariant* value) {
  double number = 0;
  int64_t whole = 0;
  if (gd.variant_get_type(value) == GD_FLOAT) gd.to[GD_FLOAT](&number, value);
  if (gd.variant_get_type(value) != GD_INT) return number;
  gd.to[GD_INT](&whole, value);
  return (double)whole;
}

static uint8_t set_property(void* instance, const GdStringName* name, const GdVariant* value) {
  Node* node = instance;
  const int32_t type = gd.variant_get_type(value);
  uint32_t control = 0;
  node->is_changed = 1;
  if (gd_is_equal(name, &gd_names.rig)) {
    if (type != GD_OBJECT && type != GD_NIL) return 0;
    gd.variant_destroy(&node->rig);
    node->rig = gd_copy(value);
    node_open_resource(node);
    return 1;
  }
  if (gd_is_equal(name, &gd_names.lod)) {
    node->lod = (int64_t)number_of(value);
    return 1;
  }
  if (gd_is_equal(name, &gd_names.show_geometry)) {
    if (type != GD_BOOL) return 0;
    gd.to[GD_BOOL](&node->shows_geometry, value);
    if (!node->shows_geometry) node_drop_geometry(node);
    return 1;
  }
  if (gd_is_equal(name, &gd_names.skeleton) || gd_is_equal(name, &gd_names.mesh)) {
    GdVariant* path = &node->paths[gd_is_equal(name, &gd_names.mesh) ? MESH : SKELETON];
    if (type != GD_NODE_PATH && type != GD_NIL) return 0;
    gd.variant_destroy(path);
    *path = gd_copy(value);
    return 1;
  }
  if (!find_control(node, name, &control) || (type != GD_FLOAT && type != GD_INT)) return 0;
  float* number = node_control(node, control);
  if (number) *number = (float)number_of(value);
  return number != NULL;
}

static uint8_t get_property(void* instance, const GdStringName* name, GdVariant* result) {
  Node* node = instance;
  uint32_t control = 0;
  if (gd_is_equal(name, &gd_names.rig)) {
    *result = gd_copy(&node->rig);
  } else if (gd_is_equal(name, &gd_names.lod)) {
    *result = gd_int(node->lod);
  } else if (gd_is_equal(name, &gd_names.show_geometry)) {
    *result = gd_bool(node->shows_geometry);
  } else if (gd_is_equal(name, &gd_names.skeleton)) {
    *result = gd_copy(&node->paths[SKELETON]);
  } else if (gd_is_equal(name, &gd_names.mesh)) {
    *result = gd_copy(&node->paths[MESH]);
  } else if (find_control(node, name, &control)) {
    const float* number = node_control(node, control);
    const double value = number ? (double)*number : 0;
    *result = gd_value(GD_FLOAT, &value);
  } else {
    return 0;
  }
  return 1;
}

/* Controls follow the rig, so a scene that is loaded opens the rig before it sets them. Those at 0 are not stored. */
static const GdPropertyInfo* list_properties(void* instance, uint32_t* count) {
  Node* node = instance;
  *count = FIXED_PROPERTIES + node->controls.count;
  if (!node->controls.list) return node_fixed_properties;
  for (uint32_t c = 0; c < node->controls.count; ++c) {
    const float* value = node_control(node, c);
    node->controls.list[FIXED_PROPERTIES + c].usage =
        value && *value != 0 ? GD_USAGE_DEFAULT : GD_USAGE_EDITOR;
  }
  return node->controls.list;
}

/* The list belongs to the node. */
static void free_list(void* instance, const GdPropertyInfo* list) { (void)instance, (void)list; }

static void describe_properties(void) {
  static const char* const kHints[] = {"", "MienRig", "Skeleton3D", "MeshInstance3D"};
  for (int h = 0; h < 4; ++h) gd.string_new_with_utf8_chars(&hints[h], kHints[h]);
  gd.string_new_with_utf8_chars(&node_control_hint, "0,1,0.001");
  const GdPropertyInfo list[FIXED_PROPERTIES] = {
      {GD_OBJECT, &gd_names.rig, &gd_names.MienRig, GD_HINT_RESOURCE_TYPE, &hints[1],
       GD_USAGE_DEFAULT},
      {GD_INT, &gd_names.lod, &gd_names.none, 0, &hints[0], GD_USAGE_DEFAULT},
      {GD_NODE_PATH, &gd_names.skeleton, &gd_names.none, GD_HINT_NODE_PATH_TYPES, &hints[2],
       GD_USAGE_DEFAULT},
      {GD_NODE_PATH, &gd_names.mesh, &gd_names.none, GD_HINT_NODE_PATH_TYPES, &hints[3],
       GD_USAGE_DEFAULT},
      {GD_BOOL, &gd_names.show_geometry, &gd_names.none, 0, &hints[0], GD_USAGE_DEFAULT}};
  memcpy(node_fixed_properties, list, sizeof list);
}

/* ---- the methods of the class --------------------------------------------------------------------- */

typedef struct {
  const char* name;
  uint32_t argument_count;
  struct {
    const char* name;
    int32_t type;
  } arguments[2];
  int32_t result; /* GD_INT or GD_BOOL */
} Method;

enum { OPEN, SET_CONTROL, EVALUATE, DRIVE_SKELETON, DRIVE_MESH, DRIVE_VERTICES, METHODS };

static Method methods[METHODS] = {
    {"open", 1, {{"path", GD_STRING}}, GD_INT},
    {"set_control", 2, {{"name", GD_STRING}, {"value", GD_FLOAT}}, GD_BOOL},
    {"evaluate", 1, {{"lod", GD_INT}}, GD_BOOL},
    {"drive_skeleton", 1, {{"skeleton", GD_OBJECT}}, GD_BOOL},
    {"drive_mesh", 1, {{"mesh", GD_OBJECT}}, GD_BOOL},
    {"drive_vertices", 2, {{"mesh_instance", GD_OBJECT}, {"mesh", GD_STRING}}, GD_BOOL},
};

/* Arguments point to values of the types. */
static void ptrcall(void* userdata, void* instance, const void* const* arguments, void* result) {
  Node* node = instance;
  const int method = (int)((const Method*)userdata - methods);
  char text[4096] = "";
  for (uint32_t i = 0; i < methods[method].argument_count; ++i) {
    if (methods[method].arguments[i].type == GD_STRING)
      gd_read_text(arguments[i], text, sizeof text);
  }
  switch (method) {
    case OPEN: *(int64_t*)result = node_open(node, text); break;
    case SET_CONTROL:
      *(uint8_t*)result = face_set_control(&node->face, text, *(const double*)arguments[1]);
      node->is_changed = 1;
      break;
    case EVALUATE:
      *(uint8_t*)result = face_evaluate(&node->face, *(const int64_t*)arguments[0]);
      break;
    case DRIVE_SKELETON:
      *(uint8_t*)result = node_drive_skeleton(node, *(const GdObject*)arguments[0]);
      break;
    case DRIVE_MESH:
      *(uint8_t*)result = node_drive_mesh(node, *(const GdObject*)arguments[0]);
      break;
    default:
      *(uint8_t*)result = node_drive_vertices(node, *(const GdObject*)arguments[0], text);
      break;
  }
}

/* Arguments are variants. Whole numbers will do for numbers. */
static void call(void* userdata, void* instance, const GdVariant* const* arguments, int64_t count,
                 GdVariant* result, GdCallError* error) {
  const Method* method = userdata;
  union {
    GdString string;
    int64_t whole;
    double number;
    GdObject object;
  } values[2];
  const void* pointers[2] = {&values[0], &values[1]};
  const int64_t wanted = (int64_t)method->argument_count;
  error->error = count < wanted ? GD_CALL_TOO_FEW : count > wanted ? GD_CALL_TOO_MANY : GD_CALL_OK;
  error->expected = (int32_t)wanted;
  for (int64_t i = 0; i < count && error->error == GD_CALL_OK; ++i) {
    const int32_t type = method->arguments[i].type, given = gd.variant_get_type(arguments[i]);
    if (given == type || (type == GD_FLOAT && given == GD_INT)) continue;
    error->error = GD_CALL_INVALID_ARGUMENT;
    error->argument = (int32_t)i;
    error->expected = type;
  }
  if (error->error != GD_CALL_OK) return;
  for (int64_t i = 0; i < count; ++i) gd.to[method->arguments[i].type](&values[i], arguments[i]);
  union {
    int64_t whole;
    uint8_t truth;
  } value = {0};
  ptrcall(userdata, instance, pointers, &value);
  gd.from[method->result](result, &value);
  for (int64_t i = 0; i < count; ++i) {
    if (method->arguments[i].type == GD_STRING) gd.destroy[GD_STRING](&values[i].string);
  }
}

static GdObject create_instance(void* userdata) {
  (void)userdata;
  Node* node = calloc(1, sizeof *node);
  if (!node) return NULL;
  node->rig = node->paths[SKELETON] = node->paths[MESH] = gd_nil();
  node->object = gd.classdb_construct_object(&gd_names.Node3D);
  gd.object_set_instance(node->object, &gd_names.MienFace3D, node);
  return node->object;
}

static void free_instance(void* userdata, void* instance) {
  (void)userdata;
  Node* node = instance;
  node_close(node);
  gd.variant_destroy(&node->rig);
  for (int t = 0; t < TARGETS; ++t) gd.variant_destroy(&node->paths[t]);
  free(node);
}

static void register_method(Method* method) {
  GdStringName name = gd_name(method->name), names[3];
  GdPropertyInfo properties[3];
  for (uint32_t i = 0; i <= method->argument_count; ++i) { /* the last is the result */
    const int is_result = i == method->argument_count;
    names[i] = gd_name(is_result ? "" : method->arguments[i].name);
    const GdPropertyInfo property = {is_result ? method->result : method->arguments[i].type,
                                     &names[i],
                                     &gd_names.none,
                                     0,
                                     &hints[0],
                                     GD_USAGE_DEFAULT};
    properties[i] = property;
  }
  const int32_t metadata[2] = {0, 0};
  GdMethodInfo info;
  memset(&info, 0, sizeof info);
  info.name = &name;
  info.method_userdata = method;
  info.call = call;
  info.ptrcall = ptrcall;
  info.flags = GD_METHOD_NORMAL;
  info.has_result = 1;
  info.result = &properties[method->argument_count];
  info.argument_count = method->argument_count;
  info.arguments = properties;
  info.argument_metadata = metadata;
  gd.classdb_register_extension_class_method(gd.library, &gd_names.MienFace3D, &info);
}

void mien_register_face_3d(void) {
  describe_properties();
  GdClassInfo2 info;
  memset(&info, 0, sizeof info);
  info.is_exposed = 1;
  info.create_instance = create_instance;
  info.free_instance = free_instance;
  info.get_virtual = get_virtual;
  info.set = set_property;
  info.get = get_property;
  info.get_property_list = list_properties;
  info.free_property_list = free_list;
  gd.classdb_register_extension_class2(gd.library, &gd_names.MienFace3D, &gd_names.Node3D, &info);
  for (int m = 0; m < METHODS; ++m) register_method(&methods[m]);
}

void mien_unregister_face_3d(void) {
  gd.classdb_unregister_extension_class(gd.library, &gd_names.MienFace3D);
  for (int h = 0; h < 4; ++h) gd.destroy[GD_STRING](&hints[h]);
  gd.destroy[GD_STRING](&node_control_hint);
}
