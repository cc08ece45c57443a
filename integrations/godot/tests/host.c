/* SPDX-License-Identifier: MIT
 * Plays Godot: implements the functions that the extension asks for, registers the class, makes a node of it, calls its
 * methods as GDScript does, and compares what a skeleton and a mesh got with the library. Counts strings, variants and
 * nodes, none of which may be left. */
#undef NDEBUG
#include <assert.h>
#include <mien.h>
#include <mien_author.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../gdextension.h"

uint8_t mien_godot_init(GdGetProcAddress get, void* library, GdInitialization* initialization);

/* ---- values: a variant is its type, then the value; a string is a pointer to its bytes ------------- */

static int strings, variants, errors;

typedef struct {
  char kind; /* 's'keleton, 'm'esh or 'n'ode */
  int count;
  const char* names[512];
  float values[512][10];
  void* face;
} Object;

static char* copy_text(const char* text) {
  char* copy = malloc(strlen(text) + 1);
  assert(copy);
  strcpy(copy, text);
  ++strings;
  return copy;
}
static void string_name_new(GdStringName* out, const char* text, uint8_t is_static) {
  assert(is_static);
  out->opaque = (void*)(uintptr_t)text;
}
static void string_new(GdString* out, const char* text) { out->opaque = copy_text(text); }
static void string_destroy(void* string) {
  free(((GdString*)string)->opaque);
  --strings;
}
static int64_t string_to_utf8(const GdString* string, char* out, int64_t size) {
  const size_t length = strlen(string->opaque);
  memcpy(out, string->opaque, length < (size_t)size ? length : (size_t)size);
  return (int64_t)length;
}
static size_t size_of(int32_t type) {
  return type == GD_BOOL ? 1 : type == GD_VECTOR3 ? 12 : type == GD_QUATERNION ? 16 : 8;
}
static void make(GdVariant* out, int32_t type, const void* value) {
  ++variants;
  memset(out, 0xee, sizeof *out);
  out->opaque[0] = (uint64_t)type;
  if (type != GD_STRING) {
    memcpy(&out->opaque[1], value, size_of(type));
    return;
  }
  char* copy = copy_text(((const GdString*)value)->opaque);
  memcpy(&out->opaque[1], &copy, sizeof copy);
}
static void take(void* out, int32_t type, const GdVariant* variant) {
  assert((int32_t)variant->opaque[0] == type || (type == GD_FLOAT && variant->opaque[0] == GD_INT));
  if (type == GD_FLOAT && variant->opaque[0] == GD_INT) {
    *(double*)out = (double)(int64_t)variant->opaque[1];
  } else if (type == GD_STRING) {
    char* text;
    memcpy(&text, &variant->opaque[1], sizeof text);
    string_new(out, text);
  } else {
    memcpy(out, &variant->opaque[1], size_of(type));
  }
}
#define TYPES(X) \
  X(GD_BOOL) X(GD_INT) X(GD_FLOAT) X(GD_STRING) X(GD_VECTOR3) X(GD_QUATERNION) X(GD_OBJECT)
#define CONVERSIONS(type)                                                          \
  static void from_##type(GdVariant* out, void* value) { make(out, type, value); } \
  static void to_##type(void* out, const GdVariant* variant) { take(out, type, variant); }
TYPES(CONVERSIONS)
static GdFunction get_from(int32_t type) {
#define FROM(t) \
  if (type == t) return (GdFunction)from_##t;
  TYPES(FROM)
  return NULL;
}
static GdFunction get_to(int32_t type) {
#define TO(t) \
  if (type == t) return (GdFunction)to_##t;
  TYPES(TO)
  return NULL;
}
static GdFunction get_destructor(int32_t type) {
  assert(type == GD_STRING);
  return (GdFunction)string_destroy;
}
static void variant_destroy(GdVariant* variant) {
  if (variant->opaque[0] == GD_STRING) {
    GdString string;
    memcpy(&string, &variant->opaque[1], sizeof string);
    string_destroy(&string);
  }
  if (variant->opaque[0] != GD_NIL) --variants;
}
static int32_t variant_type(const GdVariant* variant) { return (int32_t)variant->opaque[0]; }

/* ---- Skeleton3D and MeshInstance3D, as far as they are called -------------------------------------- */

static void variant_call(GdVariant* self, const GdStringName* method,
                         const GdVariant* const* arguments, int64_t count, GdVariant* result,
                         GdCallError* error) {
  Object* object;
  const char* name = method->opaque;
  take(&object, GD_OBJECT, self);
  memset(result, 0, sizeof *result);
  error->error = GD_CALL_OK;
  const int is_skeleton = object->kind == 's';
  if (!strcmp(name, is_skeleton ? "find_bone" : "find_blend_shape_by_name")) {
    GdString text;
    int64_t found = -1;
    assert(count == 1);
    take(&text, GD_STRING, arguments[0]);
    for (int i = 0; i < object->count; ++i) {
      if (!strcmp(object->names[i], text.opaque)) found = i;
    }
    string_destroy(&text);
    make(result, GD_INT, &found);
    return;
  }
  int64_t index;
  assert(count == 2);
  take(&index, GD_INT, arguments[0]);
  assert(index >= 0 && index < object->count);
  float* values = object->values[index];
  if (is_skeleton && !strcmp(name, "set_bone_pose_position")) {
    take(values, GD_VECTOR3, arguments[1]);
  } else if (is_skeleton && !strcmp(name, "set_bone_pose_rotation")) {
    take(values + 3, GD_QUATERNION, arguments[1]);
  } else if (is_skeleton && !strcmp(name, "set_bone_pose_scale")) {
    take(values + 7, GD_VECTOR3, arguments[1]);
  } else {
    double weight;
    assert(!is_skeleton && !strcmp(name, "set_blend_shape_value"));
    take(&weight, GD_FLOAT, arguments[1]);
    values[0] = (float)weight;
  }
}

/* ---- classes --------------------------------------------------------------------------------------- */

static int library;
static GdClassInfo2 class_info;
static struct {
  char name[32];
  GdMethodInfo info;
  int32_t types[2], result;
} methods[16];
static int method_count, is_registered;

static GdObject construct(const GdStringName* name) {
  assert(!strcmp(name->opaque, "Node3D"));
  Object* object = calloc(1, sizeof *object);
  assert(object);
  object->kind = 'n';
  return object;
}
static void set_instance(GdObject object, const GdStringName* name, void* instance) {
  assert(!strcmp(name->opaque, "MienFace3D"));
  ((Object*)object)->face = instance;
}
static void register_class(void* owner, const GdStringName* name, const GdStringName* parent,
                           const GdClassInfo2* info) {
  assert(owner == &library && !strcmp(name->opaque, "MienFace3D") &&
         !strcmp(parent->opaque, "Node3D"));
  assert(info->is_exposed && !info->is_virtual && !info->is_abstract);
  class_info = *info;
  is_registered = 1;
}
static void register_method(void* owner, const GdStringName* name, const GdMethodInfo* info) {
  assert(owner == &library && !strcmp(name->opaque, "MienFace3D") &&
         info->flags == GD_METHOD_NORMAL);
  assert(info->call && info->ptrcall && info->has_result && info->argument_count <= 2);
  strcpy(methods[method_count].name, info->name->opaque);
  methods[method_count].info = *info;
  for (uint32_t i = 0; i < info->argument_count; ++i) {
    methods[method_count].types[i] = info->arguments[i].type;
    assert(*(const char*)info->arguments[i].name->opaque &&
           info->arguments[i].usage == GD_USAGE_DEFAULT);
  }
  methods[method_count++].result = info->result->type;
}
static void unregister_class(void* owner, const GdStringName* name) {
  assert(owner == &library && !strcmp(name->opaque, "MienFace3D"));
  is_registered = 0;
}
static void print_error(const char* text, const char* function, const char* file, int32_t line,
                        uint8_t notify) {
  assert(*text && *function && *file && line > 0 && !notify);
  ++errors;
}

static const char* missing; /* a function that this Godot does not have */

static GdFunction get_proc_address(const char* name) {
  static const struct {
    const char* name;
    GdFunction function;
  } kFunctions[] = {
      {"classdb_construct_object", (GdFunction)construct},
      {"object_set_instance", (GdFunction)set_instance},
      {"classdb_register_extension_class2", (GdFunction)register_class},
      {"classdb_register_extension_class_method", (GdFunction)register_method},
      {"classdb_unregister_extension_class", (GdFunction)unregister_class},
      {"string_name_new_with_latin1_chars", (GdFunction)string_name_new},
      {"string_new_with_utf8_chars", (GdFunction)string_new},
      {"string_to_utf8_chars", (GdFunction)string_to_utf8},
      {"variant_call", (GdFunction)variant_call},
      {"variant_destroy", (GdFunction)variant_destroy},
      {"variant_get_type", (GdFunction)variant_type},
      {"variant_get_ptr_destructor", (GdFunction)get_destructor},
      {"get_variant_from_type_constructor", (GdFunction)get_from},
      {"get_variant_to_type_constructor", (GdFunction)get_to},
      {"print_error", (GdFunction)print_error},
  };
  for (size_t i = 0; i < sizeof kFunctions / sizeof *kFunctions; ++i) {
    if (!strcmp(kFunctions[i].name, name))
      return missing && !strcmp(missing, name) ? NULL : kFunctions[i].function;
  }
  printf("the extension asks for %s\n", name);
  return NULL;
}

/* ---- calls as GDScript makes them: with variants, or with pointers where types are known ----------- */

static int64_t call(Object* node, const char* name, int with_pointers, const void* first,
                    const void* second) {
  const void* values[2] = {first, second};
  for (int m = 0; m < method_count; ++m) {
    if (strcmp(methods[m].name, name)) continue;
    const GdMethodInfo* info = &methods[m].info;
    int64_t number = 0;
    if (with_pointers) {
      info->ptrcall(info->method_userdata, node->face, values, &number);
      return number;
    }
    GdVariant arguments[2], result = {{0}};
    const GdVariant* list[2] = {&arguments[0], &arguments[1]};
    GdCallError error = {0};
    for (uint32_t i = 0; i < info->argument_count; ++i)
      make(&arguments[i], methods[m].types[i], values[i]);
    /* Too few arguments, and one of a wrong type, are refused. */
    info->call(info->method_userdata, node->face, list, info->argument_count - 1, &result, &error);
    assert(error.error == GD_CALL_TOO_FEW);
    GdVariant wrong = {{GD_NIL}};
    const GdVariant* wrong_list[2] = {&wrong, &arguments[1]};
    info->call(info->method_userdata, node->face, wrong_list, info->argument_count, &result,
               &error);
    assert(error.error == GD_CALL_INVALID_ARGUMENT && error.argument == 0);
    info->call(info->method_userdata, node->face, list, info->argument_count, &result, &error);
    assert(error.error == GD_CALL_OK && variant_type(&result) == methods[m].result);
    take(&number, methods[m].result, &result);
    for (uint32_t i = 0; i < info->argument_count; ++i) variant_destroy(&arguments[i]);
    variant_destroy(&result);
    return number;
  }
  assert(!"no such method");
  return 0;
}

static int64_t open_rig(Object* node, const char* path, int with_pointers) {
  GdString text;
  string_new(&text, path);
  const int64_t status = call(node, "open", with_pointers, &text, NULL);
  string_destroy(&text);
  return status;
}

static const char* name_in(const MienRig* rig, uint32_t kind, uint32_t index) {
  MienStringView view;
  assert(mien_rig_name(rig, kind, index, &view) == MIEN_OK);
  char* name =
      copy_text("                                                                                ");
  assert(view.count < strlen(name));
  memcpy(name, view.data, view.count);
  name[view.count] = 0;
  return name;
}

static void name_all(Object* object, const MienRig* rig, uint32_t kind) {
  uint32_t count;
  assert(mien_rig_count(rig, kind, &count) == MIEN_OK && count > 2 && count < 512);
  /* In another order, and without the last. */
  for (uint32_t i = 0; i + 1 < count; ++i) object->names[i] = name_in(rig, kind, count - 2 - i);
  object->count = (int)count - 1;
}

int main(int argc, char** argv) {
  assert(argc == 2); /* a folder for files */
  char dna_path[1024], rig_path[1024];
  snprintf(dna_path, sizeof dna_path, "%s/godot_test.dna", argv[1]);
  snprintf(rig_path, sizeof rig_path, "%s/godot_test.rig", argv[1]);

  /* The same rig with the library alone, in Godot's axes. */
  MienGenerateDesc generate = mien_generate_desc_default();
  generate.preset = MIEN_PRESET_SMALL;
  MienDna *made, *dna;
  assert(mien_dna_generate(&generate, &made, NULL) == MIEN_OK);
  assert(mien_dna_write_file(made, dna_path, NULL, NULL) == MIEN_OK);
  mien_dna_close(made);
  MienCoordinateSystem system = mien_coordinate_system_default();
  assert(mien_coordinate_system_find("godot", &system) == MIEN_OK);
  MienDnaDesc desc = mien_dna_desc_default();
  desc.system = &system;
  assert(mien_dna_open_file(dna_path, &desc, &dna, NULL) == MIEN_OK);
  MienRig* rig;
  MienDeformer* deformer;
  MienInstance* instance;
  MienDeformerInstance* pose;
  assert(mien_rig_create(dna, NULL, &rig, NULL) == MIEN_OK);
  assert(mien_deformer_create(dna, rig, NULL, &deformer, NULL) == MIEN_OK);
  assert(mien_instance_create(rig, NULL, &instance, NULL) == MIEN_OK);
  assert(mien_deformer_instance_create(deformer, NULL, &pose, NULL) == MIEN_OK);
  assert(mien_bake_file(rig, deformer, rig_path, NULL) == MIEN_OK);

  /* A Godot that lacks a function is refused. */
  GdInitialization start;
  missing = "variant_call";
  assert(!mien_godot_init(get_proc_address, &library, &start));
  missing = NULL;
  assert(mien_godot_init(get_proc_address, &library, &start) &&
         start.minimum_level == GD_LEVEL_SCENE);
  for (int32_t level = 0; level < 4; ++level) {
    start.initialize(start.userdata, level);
    assert(is_registered == (level >= GD_LEVEL_SCENE));
  }
  assert(method_count == 5);
  const int kept = strings; /* what the class keeps */

  Object skeleton = {.kind = 's'}, mesh = {.kind = 'm'};
  name_all(&skeleton, rig, MIEN_KIND_JOINT);
  name_all(&mesh, rig, MIEN_KIND_BLEND_SHAPE_CHANNEL);
  Object* node = class_info.create_instance(class_info.class_userdata);
  assert(node && node->face);
  Object *skeleton_object = &skeleton, *mesh_object = &mesh, *none = NULL;
  int64_t lod = 0, no_lod = 99;
  double value = 0.5;

  /* Before a rig is open, and when it cannot be. */
  assert(!call(node, "evaluate", 0, &lod, NULL) &&
         !call(node, "drive_skeleton", 0, &skeleton_object, NULL));
  assert(open_rig(node, "no such file.dna", 0) == MIEN_ERROR_FILE_OPEN && errors == 1);
  assert(open_rig(node, "no such file.rig", 1) != MIEN_OK && errors == 2);

  for (int way = 0; way < 2; ++way) { /* variants and DNA, pointers and baked */
    assert(open_rig(node, way ? rig_path : dna_path, way) == MIEN_OK);
    GdString wrong;
    string_new(&wrong, "no such control");
    assert(!call(node, "set_control", way, &wrong, &value) &&
           !call(node, "evaluate", way, &no_lod, NULL));
    string_destroy(&wrong);
    assert(!call(node, "drive_skeleton", way, &none, NULL) &&
           !call(node, "drive_mesh", way, &none, NULL));
    MienMutableFloatView controls;
    assert(mien_instance_raw_controls(instance, &controls) == MIEN_OK);
    uint32_t raw_count, joint_count;
    assert(mien_rig_count(rig, MIEN_KIND_RAW_CONTROL, &raw_count) == MIEN_OK);
    assert(mien_rig_count(rig, MIEN_KIND_JOINT, &joint_count) == MIEN_OK);
    for (int frame = 0; frame < 3; ++frame) {
      for (uint32_t c = 0; c < raw_count; ++c) {
        const double set = (double)((c * 7 + (uint32_t)frame * 3 + (uint32_t)way) % 11) / 10;
        controls.data[c] = (float)set;
        GdString name;
        const char* text = name_in(rig, MIEN_KIND_RAW_CONTROL, c);
        name.opaque = (void*)(uintptr_t)text;
        assert(call(node, "set_control", way, &name, &set));
        string_destroy(&name);
      }
      assert(call(node, "evaluate", way, &lod, NULL));
      assert(call(node, "drive_skeleton", way, &skeleton_object, NULL));
      assert(call(node, "drive_mesh", way, &mesh_object, NULL));
      assert(mien_rig_evaluate(rig, instance, 0) == MIEN_OK);
      assert(mien_deformer_instance_update(pose, instance) == MIEN_OK);
      float transforms[512 * 10];
      MienFloatView weights;
      assert(mien_deformer_instance_local_transforms(pose, transforms, (size_t)10 * joint_count) ==
             MIEN_OK);
      assert(mien_instance_blend_shapes(instance, &weights) == MIEN_OK);
      for (int i = 0; i < skeleton.count; ++i) {
        assert(!memcmp(skeleton.values[i], transforms + 10 * (skeleton.count - 1 - i), 40));
      }
      int moved = 0;
      for (int i = 0; i < mesh.count; ++i) {
        assert(mesh.values[i][0] == weights.data[mesh.count - 1 - i]);
        moved += mesh.values[i][0] != 0;
      }
      assert(moved != 0);
    }
  }

  class_info.free_instance(class_info.class_userdata, node->face);
  free(node);
  start.deinitialize(start.userdata, GD_LEVEL_SCENE);
  assert(!is_registered && variants == 0);
  for (int i = 0; i < skeleton.count; ++i) free((void*)(uintptr_t)skeleton.names[i]);
  for (int i = 0; i < mesh.count; ++i) free((void*)(uintptr_t)mesh.names[i]);
  assert(strings - skeleton.count - mesh.count == kept);
  mien_deformer_instance_destroy(pose);
  mien_instance_destroy(instance);
  mien_deformer_destroy(deformer);
  mien_rig_destroy(rig);
  mien_dna_close(dna);
  remove(dna_path);
  remove(rig_path);
  puts("node, skeleton and mesh agree with the library");
  return 0;
}
