/* SPDX-License-Identifier: MIT
 * MienFace3D: a node of Godot 4 that is one character. It opens a rig, takes controls by name, evaluates, and sets the
 * bones of a Skeleton3D and the blend shapes of a MeshInstance3D that have the names of joints and channels.
 *
 * The functions of Skeleton3D and MeshInstance3D are called by name, so no numbers of a version are compiled in. */
#include <mien.h>
#include <stdlib.h>
#include <string.h>

#include "face.h"
#include "gdextension.h"

#if defined(_WIN32)
#define MIEN_EXPORT __declspec(dllexport)
#else
#define MIEN_EXPORT __attribute__((visibility("default")))
#endif

/* ---- what Godot offers ---------------------------------------------------------------------------- */

static struct {
  void* library;
  GdObject (*classdb_construct_object)(const GdStringName*);
  void (*object_set_instance)(GdObject, const GdStringName*, void*);
  void (*classdb_register_extension_class2)(void*, const GdStringName*, const GdStringName*,
                                            const GdClassInfo2*);
  void (*classdb_register_extension_class_method)(void*, const GdStringName*, const GdMethodInfo*);
  void (*classdb_unregister_extension_class)(void*, const GdStringName*);
  void (*string_name_new_with_latin1_chars)(GdStringName*, const char*, uint8_t);
  void (*string_new_with_utf8_chars)(GdString*, const char*);
  int64_t (*string_to_utf8_chars)(const GdString*, char*, int64_t);
  void (*variant_call)(GdVariant*, const GdStringName*, const GdVariant* const*, int64_t,
                       GdVariant*, GdCallError*);
  void (*variant_destroy)(GdVariant*);
  int32_t (*variant_get_type)(const GdVariant*);
  void (*print_error)(const char*, const char*, const char*, int32_t, uint8_t);
  void (*destroy_string)(void*);
  void (*from[GD_OBJECT + 1])(GdVariant*, void*); /* of each type used */
  void (*to[GD_OBJECT + 1])(void*, const GdVariant*);
} gd;

static GdStringName class_name, parent_name, empty_name;
static GdString empty_string;

static GdStringName name_of(const char* text) {
  GdStringName name;
  gd.string_name_new_with_latin1_chars(&name, text, 1);
  return name;
}

/* ---- one character -------------------------------------------------------------------------------- */

enum { SKELETON, MESH, TARGETS };

/* Indices of bones or blend shapes in an object of the scene, looked up once. -1: it has none of the name. */
typedef struct {
  GdObject object;
  int64_t* indices;
} Targets;

/* A node: its character, and what it drives. */
typedef struct {
  Face face;
  Targets targets[TARGETS];
  GdStringName find_bone, set_position, set_rotation, set_scale, find_shape, set_shape;
} Node;

static void close_node(Node* node) {
  face_close(&node->face);
  for (int t = 0; t < TARGETS; ++t) free(node->targets[t].indices);
  memset(node->targets, 0, sizeof node->targets);
}

static int64_t open_node(Node* node, const char* path) {
  close_node(node);
  MienError error = mien_error_default();
  const MienStatus status = face_open(&node->face, path, &error);
  if (status != MIEN_OK)
    gd.print_error(error.message[0] ? error.message : mien_status_name(status), "MienFace3D.open",
                   __FILE__, __LINE__, 0);
  return status;
}

/* Calls a method of an object. Frees the arguments, of which each is a value of a type. */
static int64_t call_object(GdObject object, const GdStringName* method, GdVariant* arguments,
                           int count) {
  const GdVariant* list[2] = {&arguments[0], &arguments[1]};
  GdVariant self, result = {{0}};
  GdCallError error = {0};
  int64_t number = -1;
  gd.from[GD_OBJECT](&self, &object);
  gd.variant_call(&self, method, list, count, &result, &error);
  if (error.error == GD_CALL_OK && gd.variant_get_type(&result) == GD_INT)
    gd.to[GD_INT](&number, &result);
  gd.variant_destroy(&result);
  gd.variant_destroy(&self);
  for (int i = 0; i < count; ++i) gd.variant_destroy(&arguments[i]);
  return number;
}

/* Finds what has the names of a kind in an object, unless that was done. */
static const int64_t* find_targets(Node* node, Targets* targets, GdObject object, uint32_t kind,
                                   uint32_t count, const GdStringName* find,
                                   int32_t argument_type) {
  if (targets->indices && targets->object == object) return targets->indices;
  free(targets->indices);
  targets->object = object;
  targets->indices = malloc((count ? count : 1) * sizeof(int64_t));
  if (!targets->indices) return NULL;
  for (uint32_t i = 0; i < count; ++i) {
    MienStringView name;
    char text[512];
    targets->indices[i] = -1;
    if (mien_rig_name(node->face.rig, kind, i, &name) != MIEN_OK || name.count >= sizeof text)
      continue;
    memcpy(text, name.data, name.count);
    text[name.count] = 0;
    GdString string;
    GdVariant argument;
    gd.string_new_with_utf8_chars(&string, text);
    gd.from[argument_type](&argument, &string);
    gd.destroy_string(&string);
    targets->indices[i] = call_object(object, find, &argument, 1);
  }
  return targets->indices;
}

static void set_bone(GdObject skeleton, const GdStringName* method, int64_t bone, int32_t type,
                     float* value) {
  GdVariant arguments[2];
  gd.from[GD_INT](&arguments[0], &bone);
  gd.from[type](&arguments[1], value);
  call_object(skeleton, method, arguments, 2);
}

static uint8_t drive_skeleton(Node* node, GdObject skeleton) {
  if (!node->face.pose || !skeleton) return 0;
  const int64_t* bones = find_targets(node, &node->targets[SKELETON], skeleton, MIEN_KIND_JOINT,
                                      node->face.joint_count, &node->find_bone, GD_STRING);
  if (!bones) return 0;
  if (!face_read_transforms(&node->face)) return 0;
  for (uint32_t j = 0; j < node->face.joint_count; ++j) {
    if (bones[j] < 0) continue;
    float* t = node->face.transforms + (size_t)10 * j;
    set_bone(skeleton, &node->set_position, bones[j], GD_VECTOR3, t);
    set_bone(skeleton, &node->set_rotation, bones[j], GD_QUATERNION, t + 3);
    set_bone(skeleton, &node->set_scale, bones[j], GD_VECTOR3, t + 7);
  }
  return 1;
}

static uint8_t drive_mesh(Node* node, GdObject mesh) {
  MienFloatView weights;
  if (!node->face.instance || !mesh) return 0;
  const int64_t* shapes =
      find_targets(node, &node->targets[MESH], mesh, MIEN_KIND_BLEND_SHAPE_CHANNEL,
                   node->face.channel_count, &node->find_shape, GD_STRING);
  if (!shapes || mien_instance_blend_shapes(node->face.instance, &weights) != MIEN_OK) return 0;
  for (uint32_t c = 0; c < node->face.channel_count && c < weights.count; ++c) {
    if (shapes[c] < 0) continue;
    int64_t shape = shapes[c];
    double weight = (double)weights.data[c];
    GdVariant arguments[2];
    gd.from[GD_INT](&arguments[0], &shape);
    gd.from[GD_FLOAT](&arguments[1], &weight);
    call_object(mesh, &node->set_shape, arguments, 2);
  }
  return 1;
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

enum { OPEN, SET_CONTROL, EVALUATE, DRIVE_SKELETON, DRIVE_MESH, METHODS };

static Method methods[METHODS] = {
    {"open", 1, {{"path", GD_STRING}}, GD_INT},
    {"set_control", 2, {{"name", GD_STRING}, {"value", GD_FLOAT}}, GD_BOOL},
    {"evaluate", 1, {{"lod", GD_INT}}, GD_BOOL},
    {"drive_skeleton", 1, {{"skeleton", GD_OBJECT}}, GD_BOOL},
    {"drive_mesh", 1, {{"mesh", GD_OBJECT}}, GD_BOOL},
};

/* Arguments point to values of the types. */
static void ptrcall(void* userdata, void* instance, const void* const* arguments, void* result) {
  Node* node = instance;
  const int method = (int)((const Method*)userdata - methods);
  char text[4096] = "";
  if (methods[method].arguments[0].type == GD_STRING) {
    const int64_t length = gd.string_to_utf8_chars(arguments[0], text, sizeof text - 1);
    text[length < 0 ? 0 : length < (int64_t)sizeof text ? length : (int64_t)sizeof text - 1] = 0;
  }
  switch (method) {
    case OPEN: *(int64_t*)result = open_node(node, text); break;
    case SET_CONTROL:
      *(uint8_t*)result = face_set_control(&node->face, text, *(const double*)arguments[1]);
      break;
    case EVALUATE:
      *(uint8_t*)result = face_evaluate(&node->face, *(const int64_t*)arguments[0]);
      break;
    case DRIVE_SKELETON:
      *(uint8_t*)result = drive_skeleton(node, *(const GdObject*)arguments[0]);
      break;
    default: *(uint8_t*)result = drive_mesh(node, *(const GdObject*)arguments[0]); break;
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
  if (method->arguments[0].type == GD_STRING) gd.destroy_string(&values[0].string);
}

static GdObject create_instance(void* userdata) {
  (void)userdata;
  Node* node = calloc(1, sizeof *node);
  if (!node) return NULL;
  node->find_bone = name_of("find_bone");
  node->set_position = name_of("set_bone_pose_position");
  node->set_rotation = name_of("set_bone_pose_rotation");
  node->set_scale = name_of("set_bone_pose_scale");
  node->find_shape = name_of("find_blend_shape_by_name");
  node->set_shape = name_of("set_blend_shape_value");
  GdObject object = gd.classdb_construct_object(&parent_name);
  gd.object_set_instance(object, &class_name, node);
  return object;
}

static void free_instance(void* userdata, void* instance) {
  (void)userdata;
  close_node(instance);
  free(instance);
}

static void register_method(Method* method) {
  GdStringName name = name_of(method->name), names[3];
  GdPropertyInfo properties[3];
  for (uint32_t i = 0; i <= method->argument_count; ++i) { /* the last is the result */
    const int is_result = i == method->argument_count;
    names[i] = name_of(is_result ? "" : method->arguments[i].name);
    const GdPropertyInfo property = {is_result ? method->result : method->arguments[i].type,
                                     &names[i],
                                     &empty_name,
                                     0,
                                     &empty_string,
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
  gd.classdb_register_extension_class_method(gd.library, &class_name, &info);
}

static void initialize(void* userdata, int32_t level) {
  (void)userdata;
  if (level != GD_LEVEL_SCENE) return;
  class_name = name_of("MienFace3D");
  parent_name = name_of("Node3D");
  empty_name = name_of("");
  gd.string_new_with_utf8_chars(&empty_string, "");
  GdClassInfo2 info;
  memset(&info, 0, sizeof info);
  info.is_exposed = 1;
  info.create_instance = create_instance;
  info.free_instance = free_instance;
  gd.classdb_register_extension_class2(gd.library, &class_name, &parent_name, &info);
  for (int m = 0; m < METHODS; ++m) register_method(&methods[m]);
}

static void deinitialize(void* userdata, int32_t level) {
  (void)userdata;
  if (level == GD_LEVEL_SCENE) gd.classdb_unregister_extension_class(gd.library, &class_name);
}

/* The entry that mien.gdextension names. Refuses a Godot that lacks a function. */
MIEN_EXPORT uint8_t mien_godot_init(GdGetProcAddress get, void* library,
                                    GdInitialization* initialization) {
  gd.library = library;
  GdFunction found;
#define MIEN_ASK(function)                 \
  if (!(found = get(#function))) return 0; \
  memcpy(&gd.function, &found, sizeof found)
  MIEN_ASK(classdb_construct_object);
  MIEN_ASK(object_set_instance);
  MIEN_ASK(classdb_register_extension_class2);
  MIEN_ASK(classdb_register_extension_class_method);
  MIEN_ASK(classdb_unregister_extension_class);
  MIEN_ASK(string_name_new_with_latin1_chars);
  MIEN_ASK(string_new_with_utf8_chars);
  MIEN_ASK(string_to_utf8_chars);
  MIEN_ASK(variant_call);
  MIEN_ASK(variant_destroy);
  MIEN_ASK(variant_get_type);
  MIEN_ASK(print_error);
  const GdFunction from = get("get_variant_from_type_constructor"),
                   to = get("get_variant_to_type_constructor"),
                   destructor = get("variant_get_ptr_destructor");
  if (!from || !to || !destructor) return 0;
  const int32_t types[] = {GD_BOOL,    GD_INT,        GD_FLOAT, GD_STRING,
                           GD_VECTOR3, GD_QUATERNION, GD_OBJECT};
  for (size_t i = 0; i < sizeof types / sizeof *types; ++i) {
    found = ((GdFunction(*)(int32_t))from)(types[i]);
    memcpy(&gd.from[types[i]], &found, sizeof found);
    found = ((GdFunction(*)(int32_t))to)(types[i]);
    memcpy(&gd.to[types[i]], &found, sizeof found);
  }
  found = ((GdFunction(*)(int32_t))destructor)(GD_STRING);
  memcpy(&gd.destroy_string, &found, sizeof found);
  initialization->minimum_level = GD_LEVEL_SCENE;
  initialization->userdata = NULL;
  initialization->initialize = initialize;
  initialization->deinitialize = deinitialize;
  return 1;
}
