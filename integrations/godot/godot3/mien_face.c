/* SPDX-License-Identifier: MIT
 * MienFace: a native script for Godot 3 that extends Spatial and is one character. It has the methods of MienFace3D for
 * Godot 4, on the same face.c. Also usable in the editor: it is a tool. */
#include <stdlib.h>
#include <string.h>

#include "../face.h"
#include "gdnative.h"

#if defined(_WIN32)
#define MIEN_EXPORT __declspec(dllexport)
#else
#define MIEN_EXPORT __attribute__((visibility("default")))
#endif

/* ---- what Godot offers ---------------------------------------------------------------------------- */

static const Gd3Core* core;
#define GD3(place, result, ...) ((result(*)(__VA_ARGS__))core->functions[place])

static void destroy(Gd3Variant* variant) { GD3(GD3_VARIANT_DESTROY, void, Gd3Variant*)(variant); }

static Gd3String string_of(const char* text) {
  return GD3(GD3_STRING_FROM_UTF8, Gd3String, const char*)(text);
}

static void destroy_string(Gd3String* string) { GD3(GD3_STRING_DESTROY, void, Gd3String*)(string); }

static Gd3Variant variant_of_int(int64_t number) {
  Gd3Variant variant;
  GD3(GD3_VARIANT_NEW_INT, void, Gd3Variant*, int64_t)(&variant, number);
  return variant;
}

static Gd3Variant variant_of_bool(uint8_t truth) {
  Gd3Variant variant;
  GD3(GD3_VARIANT_NEW_BOOL, void, Gd3Variant*, uint8_t)(&variant, truth);
  return variant;
}

static Gd3Variant variant_of_text(const char* text) {
  Gd3Variant variant;
  Gd3String string = string_of(text);
  GD3(GD3_VARIANT_NEW_STRING, void, Gd3Variant*, const Gd3String*)(&variant, &string);
  destroy_string(&string);
  return variant;
}

static Gd3Variant variant_of_bytes(const void* bytes, size_t size) {
  Gd3Variant variant;
  Gd3Bytes array;
  GD3(GD3_BYTES_NEW, void, Gd3Bytes*)(&array);
  if (size != 0 && size <= INT32_MAX) {
    GD3(GD3_BYTES_RESIZE, void, Gd3Bytes*, int)(&array, (int)size);
    void* access = GD3(GD3_BYTES_WRITE, void*, Gd3Bytes*)(&array);
    memcpy(GD3(GD3_WRITE_POINTER, uint8_t*, const void*)(access), bytes, size);
    GD3(GD3_WRITE_DESTROY, void, void*)(access);
  }
  GD3(GD3_VARIANT_NEW_BYTES, void, Gd3Variant*, const Gd3Bytes*)(&variant, &array);
  GD3(GD3_BYTES_DESTROY, void, Gd3Bytes*)(&array);
  return variant;
}

static int32_t type_of(const Gd3Variant* variant) {
  return GD3(GD3_VARIANT_TYPE, int32_t, const Gd3Variant*)(variant);
}

/* Empty if it is longer. */
static void read_text(const Gd3Variant* variant, char* out_text, size_t capacity) {
  Gd3String string = GD3(GD3_VARIANT_AS_STRING, Gd3String, const Gd3Variant*)(variant);
  Gd3CharString bytes = GD3(GD3_STRING_TO_UTF8, Gd3CharString, const Gd3String*)(&string);
  const char* text = GD3(GD3_CHARS_DATA, const char*, const Gd3CharString*)(&bytes);
  const size_t length = text ? strlen(text) : 0;
  out_text[0] = 0;
  if (length < capacity && text) memcpy(out_text, text, length + 1);
  GD3(GD3_CHARS_DESTROY, void, Gd3CharString*)(&bytes);
  destroy_string(&string);
}

/* Calls a method of an object and frees the arguments. */
static Gd3Variant call_object(Gd3Variant* object, const char* method, Gd3Variant* arguments,
                              int count) {
  const Gd3Variant* list[2] = {&arguments[0], &arguments[1]};
  Gd3CallError error = {0, 0, 0};
  Gd3String name = string_of(method);
  Gd3Variant result =
      GD3(GD3_VARIANT_CALL, Gd3Variant, Gd3Variant*, const Gd3String*, const Gd3Variant**, int,
          Gd3CallError*)(object, &name, list, count, &error);
  destroy_string(&name);
  for (int i = 0; i < count; ++i) destroy(&arguments[i]);
  return result;
}

static void report(MienStatus status, const MienError* error, const char* method) {
  GD3(GD3_PRINT_ERROR, void, const char*, const char*, const char*, int)
  (error->message[0] ? error->message : mien_status_name(status), method, __FILE__, __LINE__);
}

/* ---- methods -------------------------------------------------------------------------------------- */

typedef struct {
  Face face;
  int64_t* bones; /* of the skeleton with this id, for each joint; -1: it has none of the name */
  int64_t skeleton;
} Node;

static int64_t id_of(Gd3Variant* object) {
  Gd3Variant none[2], id = call_object(object, "get_instance_id", none, 0);
  const int64_t number = GD3(GD3_VARIANT_AS_INT, int64_t, const Gd3Variant*)(&id);
  destroy(&id);
  return number;
}

static void forget_bones(Node* node) {
  free(node->bones);
  node->bones = NULL;
}

static Gd3Variant open_path(Node* node, Gd3Variant** arguments) {
  char path[4096];
  MienError error = mien_error_default();
  read_text(arguments[0], path, sizeof path);
  forget_bones(node);
  const MienStatus status = face_open(&node->face, path, &error);
  if (status != MIEN_OK) report(status, &error, "MienFace.open");
  return variant_of_int(status);
}

static Gd3Variant open_bytes(Node* node, Gd3Variant** arguments) {
  MienError error = mien_error_default();
  Gd3Bytes bytes = GD3(GD3_VARIANT_AS_BYTES, Gd3Bytes, const Gd3Variant*)(arguments[0]);
  const int size = GD3(GD3_BYTES_SIZE, int, const Gd3Bytes*)(&bytes);
  void* access = GD3(GD3_BYTES_READ, void*, const Gd3Bytes*)(&bytes);
  const void* data = GD3(GD3_READ_POINTER, const void*, const void*)(access);
  forget_bones(node);
  const MienStatus status =
      face_open_bytes(&node->face, data ? data : "", size > 0 ? (size_t)size : 0, &error);
  GD3(GD3_READ_DESTROY, void, void*)(access);
  GD3(GD3_BYTES_DESTROY, void, Gd3Bytes*)(&bytes);
  if (status != MIEN_OK) report(status, &error, "MienFace.open_bytes");
  return variant_of_int(status);
}

static Gd3Variant bake(Node* node, Gd3Variant** arguments) {
  (void)node;
  char path[4096];
  void* bytes = NULL;
  size_t size = 0;
  MienError error = mien_error_default();
  read_text(arguments[0], path, sizeof path);
  const MienStatus status = face_bake(path, &bytes, &size, &error);
  if (status != MIEN_OK) report(status, &error, "MienFace.bake");
  Gd3Variant result = variant_of_bytes(bytes, size);
  free(bytes);
  return result;
}

static Gd3Variant set_control(Node* node, Gd3Variant** arguments) {
  char name[512];
  read_text(arguments[0], name, sizeof name);
  const double value = GD3(GD3_VARIANT_AS_REAL, double, const Gd3Variant*)(arguments[1]);
  return variant_of_bool(face_set_control(&node->face, name, value));
}

static Gd3Variant evaluate(Node* node, Gd3Variant** arguments) {
  const int64_t lod = GD3(GD3_VARIANT_AS_INT, int64_t, const Gd3Variant*)(arguments[0]);
  return variant_of_bool(face_evaluate(&node->face, lod));
}

/* Poses replace the rests of the bones that have the names of joints. */
static int find_bones(Node* node, Gd3Variant* skeleton) {
  const int64_t id = id_of(skeleton);
  if (node->bones && node->skeleton == id) return 1;
  forget_bones(node);
  node->bones = malloc((node->face.joint_count + 1) * sizeof(int64_t));
  if (!node->bones) return 0;
  node->skeleton = id;
  for (uint32_t j = 0; j < node->face.joint_count; ++j) {
    char name[512];
    face_name(&node->face, MIEN_KIND_JOINT, j, name, sizeof name);
    Gd3Variant arguments[2] = {variant_of_text(name)};
    Gd3Variant found = call_object(skeleton, "find_bone", arguments, 1);
    node->bones[j] = type_of(&found) == GD3_INT
                         ? GD3(GD3_VARIANT_AS_INT, int64_t, const Gd3Variant*)(&found)
                         : -1;
    destroy(&found);
    if (node->bones[j] < 0) continue;
    arguments[0] = variant_of_int(node->bones[j]);
    arguments[1] = variant_of_bool(1);
    Gd3Variant nothing = call_object(skeleton, "set_bone_disable_rest", arguments, 2);
    destroy(&nothing);
  }
  return 1;
}

/* Translation, quaternion x y z w and scale. */
static Gd3Transform transform_of(const float* t) {
  const float x = t[3], y = t[4], z = t[5], w = t[6];
  const float rotation[3][3] = {
      {1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
      {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
      {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  Gd3Transform transform;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      transform.rows[row][column] = rotation[row][column] * t[7 + column];
    transform.origin[row] = t[row];
  }
  return transform;
}

static Gd3Variant drive_skeleton(Node* node, Gd3Variant** arguments) {
  if (type_of(arguments[0]) != GD3_OBJECT || !face_read_transforms(&node->face) ||
      !find_bones(node, arguments[0]))
    return variant_of_bool(0);
  for (uint32_t j = 0; j < node->face.joint_count; ++j) {
    if (node->bones[j] < 0) continue;
    const Gd3Transform pose = transform_of(node->face.transforms + (size_t)10 * j);
    Gd3Variant values[2] = {variant_of_int(node->bones[j])};
    GD3(GD3_VARIANT_NEW_TRANSFORM, void, Gd3Variant*, const Gd3Transform*)(&values[1], &pose);
    Gd3Variant nothing = call_object(arguments[0], "set_bone_pose", values, 2);
    destroy(&nothing);
  }
  return variant_of_bool(1);
}

/* A MeshInstance ignores weights of blend shapes that it lacks. */
static Gd3Variant drive_mesh(Node* node, Gd3Variant** arguments) {
  MienFloatView weights;
  if (type_of(arguments[0]) != GD3_OBJECT || !node->face.instance ||
      mien_instance_blend_shapes(node->face.instance, &weights) != MIEN_OK)
    return variant_of_bool(0);
  for (uint32_t c = 0; c < node->face.channel_count && c < weights.count; ++c) {
    char property[600] = "blend_shapes/";
    face_name(&node->face, MIEN_KIND_BLEND_SHAPE_CHANNEL, c, property + 13, sizeof property - 13);
    Gd3Variant values[2] = {variant_of_text(property)};
    GD3(GD3_VARIANT_NEW_REAL, void, Gd3Variant*, double)(&values[1], (double)weights.data[c]);
    Gd3Variant nothing = call_object(arguments[0], "set", values, 2);
    destroy(&nothing);
  }
  return variant_of_bool(1);
}

static Gd3Variant positions(Node* node, Gd3Variant** arguments) {
  char mesh[512];
  MienFloatView view = {0};
  read_text(arguments[0], mesh, sizeof mesh);
  const int is_found = face_deform(&node->face, mesh, &view);
  return variant_of_bytes(view.data, is_found ? view.count * sizeof(float) : 0);
}

typedef struct {
  const char* name;
  int argument_count;
  Gd3Variant (*run)(Node* node, Gd3Variant** arguments);
} Method;

static const Method methods[] = {{"open", 1, open_path},
                                 {"open_bytes", 1, open_bytes},
                                 {"bake", 1, bake},
                                 {"set_control", 2, set_control},
                                 {"evaluate", 1, evaluate},
                                 {"drive_skeleton", 1, drive_skeleton},
                                 {"drive_mesh", 1, drive_mesh},
                                 {"positions", 1, positions}};

static Gd3Variant call(Gd3Object object, void* data, void* instance, int count,
                       Gd3Variant** arguments) {
  (void)object;
  const Method* method = data;
  if (instance && count == method->argument_count) return method->run(instance, arguments);
  GD3(GD3_PRINT_ERROR, void, const char*, const char*, const char*, int)
  ("wrong number of arguments", method->name, __FILE__, __LINE__);
  Gd3Variant nothing;
  GD3(GD3_VARIANT_NEW_NIL, void, Gd3Variant*)(&nothing);
  return nothing;
}

static void* create_node(Gd3Object object, void* data) {
  (void)object, (void)data;
  return calloc(1, sizeof(Node));
}

static void destroy_node(Gd3Object object, void* data, void* instance) {
  (void)object, (void)data;
  Node* node = instance;
  if (!node) return;
  face_close(&node->face);
  free(node->bones);
  free(node);
}

static void free_nothing(void* data) { (void)data; }

/* ---- entries that Godot looks for ------------------------------------------------------------------ */

static const Gd3NativeScript* native_scripts;

MIEN_EXPORT void mien_gdnative_init(const Gd3InitOptions* options) {
  core = options->core;
  for (uint32_t e = 0; e < core->extension_count; ++e) {
    if (core->extensions[e]->type == GD3_NATIVESCRIPT)
      native_scripts = (const Gd3NativeScript*)core->extensions[e];
  }
}

MIEN_EXPORT void mien_gdnative_terminate(const void* options) {
  (void)options;
  core = NULL;
  native_scripts = NULL;
}

MIEN_EXPORT void mien_nativescript_init(void* library) {
  const Gd3Create create = {create_node, NULL, free_nothing};
  const Gd3Destroy end = {destroy_node, NULL, free_nothing};
  const Gd3MethodAttributes local = {0};
  if (!native_scripts) return;
  native_scripts->register_tool_class(library, "MienFace", "Spatial", create, end);
  for (size_t m = 0; m < sizeof methods / sizeof *methods; ++m) {
    const Gd3Method method = {call, (void*)&methods[m], free_nothing};
    native_scripts->register_method(library, "MienFace", methods[m].name, local, method);
  }
}
