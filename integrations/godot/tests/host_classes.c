/* SPDX-License-Identifier: MIT
 * Godot's objects: the classes that the extension uses or extends, their methods with the types of arguments, and as much
 * behavior as a test needs. Names and types are those of Godot's class reference (4.2). */
#include <math.h>
#include <stdio.h>

#include "host.h"

char project_folder[1024], saved_path[1024];
int errors, list_changes, library;
Object* import_plugin;
const char *editor_plugin, *missing;
GdVariant saved;

/* ---- Godot's classes ------------------------------------------------------------------------------- */

static const struct {
  const char *name, *parent;
} kClasses[] = {{"Object", NULL},
                {"Node", "Object"},
                {"Node3D", "Node"},
                {"Skeleton3D", "Node3D"},
                {"GeometryInstance3D", "Node3D"},
                {"MeshInstance3D", "GeometryInstance3D"},
                {"EditorPlugin", "Node"},
                {"RefCounted", "Object"},
                {"Resource", "RefCounted"},
                {"ArrayMesh", "Resource"},
                {"EditorImportPlugin", "RefCounted"},
                {"ProjectSettings", "Object"},
                {"RenderingServer", "Object"},
                {"ResourceSaver", "Object"}};

/* Methods with the types of their arguments; those behind `required` have defaults. -1: any. */
static const struct {
  const char *owner, *name;
  int required, count;
  int32_t types[5];
} kMethods[] = {
    {"Object", "get", 1, 1, {GD_STRING_NAME}},
    {"Object", "set", 2, 2, {GD_STRING_NAME, -1}},
    {"Object", "notify_property_list_changed", 0, 0, {0}},
    {"Node", "add_child", 1, 3, {GD_OBJECT, GD_BOOL, GD_INT}},
    {"Node", "get_node_or_null", 1, 1, {GD_NODE_PATH}},
    {"Node", "queue_free", 0, 0, {0}},
    {"Node3D", "set_visible", 1, 1, {GD_BOOL}},
    {"Skeleton3D", "find_bone", 1, 1, {GD_STRING}},
    {"Skeleton3D", "set_bone_pose_position", 2, 2, {GD_INT, GD_VECTOR3}},
    {"Skeleton3D", "set_bone_pose_rotation", 2, 2, {GD_INT, GD_QUATERNION}},
    {"Skeleton3D", "set_bone_pose_scale", 2, 2, {GD_INT, GD_VECTOR3}},
    {"MeshInstance3D", "find_blend_shape_by_name", 1, 1, {GD_STRING_NAME}},
    {"MeshInstance3D", "set_blend_shape_value", 2, 2, {GD_INT, GD_FLOAT}},
    {"MeshInstance3D", "set_mesh", 1, 1, {GD_OBJECT}},
    {"Resource", "get_rid", 0, 0, {0}},
    {"ArrayMesh",
     "add_surface_from_arrays",
     2,
     5,
     {GD_INT, GD_ARRAY, GD_ARRAY, GD_DICTIONARY, GD_INT}},
    {"ArrayMesh", "get_surface_count", 0, 0, {0}},
    {"ArrayMesh", "surface_get_format", 1, 1, {GD_INT}},
    {"RenderingServer", "mesh_surface_get_format_offset", 3, 3, {GD_INT, GD_INT, GD_INT}},
    {"RenderingServer", "mesh_surface_get_format_normal_tangent_stride", 2, 2, {GD_INT, GD_INT}},
    {"RenderingServer",
     "mesh_surface_update_vertex_region",
     4,
     4,
     {GD_RID, GD_INT, GD_INT, GD_PACKED_BYTES}},
    {"ProjectSettings", "globalize_path", 1, 1, {GD_STRING}},
    {"ResourceSaver", "save", 1, 3, {GD_OBJECT, GD_STRING, GD_INT}},
    {"EditorPlugin", "add_import_plugin", 1, 2, {GD_OBJECT, GD_BOOL}},
    {"EditorPlugin", "remove_import_plugin", 1, 1, {GD_OBJECT}},
};

/* As strict as Godot: a String for a StringName, a whole number for a float, and nothing for an object will do. */
static int can_be(int32_t given, int32_t wanted) {
  return wanted < 0 || given == wanted || (wanted == GD_STRING_NAME && given == GD_STRING) ||
         (wanted == GD_FLOAT && given == GD_INT) || (wanted == GD_OBJECT && given == GD_NIL);
}

static const char* parent_of(const char* name) {
  for (size_t c = 0; c < sizeof kClasses / sizeof *kClasses; ++c) {
    if (!strcmp(kClasses[c].name, name)) return kClasses[c].parent;
  }
  assert(0 && "a class that Godot does not have");
  return NULL;
}

static int inherits(const char* name, const char* base) {
  while (name && strcmp(name, base) != 0) name = parent_of(name);
  return name != NULL;
}

/* ---- the extension's classes ------------------------------------------------------------------------ */

typedef struct {
  const char *name, *parent;
  GdClassInfo2 info;
  struct {
    const char* name;
    GdMethodInfo info;
    GdPropertyInfo arguments[2], result;
  } methods[16];
  int method_count, object_count;
} Class;

static Class classes[8];
static int count_of_classes;

static Class* find_class(const char* name) {
  for (int c = 0; c < count_of_classes; ++c) {
    if (!strcmp(classes[c].name, name)) return &classes[c];
  }
  return NULL;
}

int class_count(void) { return count_of_classes; }

int method_count(void) {
  int count = 0;
  for (int c = 0; c < count_of_classes; ++c) count += classes[c].method_count;
  return count;
}

static void register_class(void* owner, const GdStringName* name, const GdStringName* parent,
                           const GdClassInfo2* info) {
  assert(owner == &library && !find_class(name_text(name)) && count_of_classes < 8);
  assert(parent_of(name_text(parent)) && !info->is_virtual && !info->is_abstract);
  assert(info->create_instance && info->free_instance);
  assert(!info->get_property_list || (info->free_property_list && info->set && info->get));
  Class* made = &classes[count_of_classes++];
  memset(made, 0, sizeof *made);
  made->name = name_text(name);
  made->parent = name_text(parent);
  made->info = *info;
}

static void check_property(const GdPropertyInfo* property, int has_name) {
  assert(property->type > GD_NIL && property->type < GD_TYPE_COUNT && property->hint_string);
  assert(!has_name || *name_text(property->name));
  name_text(property->class_name);
  assert(property->hint_string->opaque && (property->usage & ~(uint32_t)GD_USAGE_DEFAULT) == 0);
  if (property->hint == GD_HINT_RESOURCE_TYPE) assert(*name_text(property->class_name));
}

static void register_method(void* owner, const GdStringName* name, const GdMethodInfo* info) {
  Class* in = find_class(name_text(name));
  assert(owner == &library && in && in->method_count < 16 && info->argument_count <= 2);
  assert(info->flags == GD_METHOD_NORMAL && info->call && info->ptrcall && info->has_result);
  for (int m = 0; m < in->method_count; ++m)
    assert(strcmp(in->methods[m].name, name_text(info->name)) != 0);
  in->methods[in->method_count].name = name_text(info->name);
  in->methods[in->method_count].info = *info;
  for (uint32_t i = 0; i < info->argument_count; ++i) {
    check_property(&info->arguments[i], 1);
    in->methods[in->method_count].arguments[i] = info->arguments[i];
  }
  check_property(info->result, 0);
  in->methods[in->method_count].result = *info->result;
  in->methods[in->method_count].info.arguments = in->methods[in->method_count].arguments;
  in->methods[in->method_count].info.result = &in->methods[in->method_count].result;
  ++in->method_count;
}

static void unregister_class(void* owner, const GdStringName* name) {
  /* The last one first, without objects. */
  assert(owner == &library && count_of_classes > 0);
  assert(!strcmp(classes[count_of_classes - 1].name, name_text(name)));
  assert(classes[count_of_classes - 1].object_count == 0);
  --count_of_classes;
}

static void add_editor_plugin(const GdStringName* name) {
  const Class* plugin = find_class(name_text(name));
  assert(plugin && inherits(plugin->parent, "EditorPlugin") && !editor_plugin);
  editor_plugin = plugin->name;
}

static void remove_editor_plugin(const GdStringName* name) {
  assert(editor_plugin && !strcmp(editor_plugin, name_text(name)));
  editor_plugin = NULL;
}

const GdClassInfo2* class_info(const Object* object) {
  return object->extension ? &((const Class*)object->extension)->info : NULL;
}

GdVirtual virtual_of(const Object* object, const char* name) {
  GdStringName string = name_of(name);
  const GdClassInfo2* info = class_info(object);
  const GdVirtual found =
      info->get_virtual ? info->get_virtual(info->class_userdata, &string) : NULL;
  name_destroy(&string);
  return found;
}

const GdMethodInfo* find_method(const Object* object, const char* name) {
  const Class* in = object->extension;
  for (int m = 0; m < in->method_count; ++m) {
    if (!strcmp(in->methods[m].name, name)) return &in->methods[m].info;
  }
  assert(0 && "no such method");
  return NULL;
}

/* A property is set or read only if the list has it, as the editor and scenes do. */
static const GdPropertyInfo* listed(Object* object, const char* name) {
  const GdClassInfo2* info = class_info(object);
  uint32_t count = 0;
  const GdPropertyInfo* found = NULL;
  const GdPropertyInfo* list = info->get_property_list(object->instance, &count);
  for (uint32_t p = 0; p < count; ++p) {
    check_property(&list[p], 1);
    if (!strcmp(name_text(list[p].name), name)) found = &list[p];
  }
  info->free_property_list(object->instance, list);
  return found;
}

uint8_t set_property(Object* object, const char* name, const GdVariant* value) {
  GdStringName string = name_of(name);
  const uint8_t is_set = class_info(object)->set(object->instance, &string, value);
  assert(!is_set || listed(object, name));
  name_destroy(&string);
  return is_set;
}

uint8_t get_property(Object* object, const char* name, GdVariant* result) {
  GdStringName string = name_of(name);
  memset(result, 0, sizeof *result);
  const uint8_t has = class_info(object)->get(object->instance, &string, result);
  const GdPropertyInfo* property = listed(object, name);
  assert(!has == !property &&
         (!has || can_be(type_of(result), property->type) || type_of(result) == GD_NIL));
  name_destroy(&string);
  return has;
}

/* ---- objects ---------------------------------------------------------------------------------------- */

enum { MAX_OBJECTS = 512 };
static Object* objects[MAX_OBJECTS]; /* by id - 1 */
static uint64_t last_id;

static Object* construct_native(const char* name) {
  Object* object = calloc(1, sizeof *object);
  assert(object && last_id < MAX_OBJECTS);
  object->class_name = name;
  object->is_visible = 1;
  if (inherits(name, "RefCounted")) object->refs = object->is_new = 1;
  objects[last_id] = object;
  object->id = ++last_id;
  ++alive.objects;
  return object;
}

Object* construct(const char* name) {
  Class* extension = find_class(name);
  if (!extension) return construct_native(name);
  Object* object = extension->info.create_instance(extension->info.class_userdata);
  assert(object && object->extension == extension && object->instance);
  return object;
}

static GdObject construct_object(const GdStringName* name) { return construct(name_text(name)); }

static void set_instance(GdObject pointer, const GdStringName* name, void* instance) {
  Object* object = pointer;
  Class* extension = find_class(name_text(name));
  assert(extension && !object->extension && instance &&
         inherits(object->class_name, extension->parent));
  object->extension = extension;
  object->instance = instance;
  ++extension->object_count;
}

int is_class(const Object* object, const char* name) {
  return (object->extension && !strcmp(((const Class*)object->extension)->name, name)) ||
         inherits(object->class_name, name);
}

void free_object(Object* object) {
  assert(object->refs == 0);
  for (uint64_t i = 0; i < last_id; ++i) {
    if (objects[i] && objects[i]->parent == object) free_object(objects[i]);
  }
  if (object->extension) {
    Class* extension = (Class*)(uintptr_t)object->extension;
    extension->info.free_instance(extension->info.class_userdata, object->instance);
    --extension->object_count;
  }
  if (object->has_mesh) variant_destroy(&object->mesh);
  if (object->in_flight.opaque[0]) packed_destroy(&object->in_flight);
  objects[object->id - 1] = NULL;
  free(object->buffer);
  free(object->texture_coordinates);
  free(object->indices);
  free(object);
  --alive.objects;
}

void end_frame(void) {
  for (uint64_t i = 0; i < last_id; ++i) {
    if (!objects[i] || !objects[i]->is_queued) continue;
    --objects[i]->parent->child_count;
    free_object(objects[i]);
  }
}

Object* next_child(const Object* parent, const Object* after) {
  for (uint64_t i = after ? after->id : 0; i < last_id; ++i) {
    if (objects[i] && objects[i]->parent == parent) return objects[i];
  }
  return NULL;
}

/* What a variant does to the count of its object. */
void own(Object* object) {
  if (!object || !inherits(object->class_name, "RefCounted")) return;
  assert(object->refs > 0);
  if (object->is_new) {
    object->is_new = 0;
  } else {
    ++object->refs;
  }
}

void disown(Object* object) {
  if (!object || !inherits(object->class_name, "RefCounted")) return;
  assert(object->refs > 0 && !object->is_new);
  if (--object->refs == 0) free_object(object);
}

static uint64_t id_of(GdObject object) { return ((Object*)object)->id; }

static GdObject object_of_id(uint64_t id) {
  assert(id != 0 && id <= last_id);
  return objects[id - 1];
}

static GdObject get_singleton(const GdStringName* name) {
  static Object singletons[3];
  static const char* const kNames[] = {"ProjectSettings", "RenderingServer", "ResourceSaver"};
  for (int s = 0; s < 3; ++s) {
    singletons[s].class_name = kNames[s];
    if (!strcmp(kNames[s], name_text(name))) return &singletons[s];
  }
  assert(0 && "no such singleton");
  return NULL;
}

/* ---- calls ------------------------------------------------------------------------------------------ */

void host_run(Object* object, const char* method, const GdVariant* const* arguments, int64_t count,
              GdVariant* result);

static void variant_call(GdVariant* self, const GdStringName* name,
                         const GdVariant* const* arguments, int64_t count, GdVariant* result,
                         GdCallError* error) {
  Object* object;
  const char* method = name_text(name);
  memset(result, 0, sizeof *result);
  error->error = GD_CALL_OK;
  for (int64_t i = 0; i < count; ++i) type_of(arguments[i]); /* they are alive */
  if (type_of(self) != GD_OBJECT) {
    call_value(self, method, arguments, count, result);
    return;
  }
  take(&object, GD_OBJECT, self);
  assert(object);
  for (size_t m = 0; m < sizeof kMethods / sizeof *kMethods; ++m) {
    if (strcmp(kMethods[m].name, method) != 0 || !inherits(object->class_name, kMethods[m].owner))
      continue;
    assert(count >= kMethods[m].required && count <= kMethods[m].count);
    for (int64_t i = 0; i < count; ++i) assert(can_be(type_of(arguments[i]), kMethods[m].types[i]));
    host_run(object, method, arguments, count, result);
    return;
  }
  printf("%s has no method %s\n", object->class_name, method);
  assert(0 && "a method that Godot does not have");
}

static void print_error(const char* text, const char* function, const char* file, int32_t line,
                        uint8_t notify) {
  assert(*text && *function && *file && line > 0 && notify <= 1);
  ++errors;
}

GdFunction get_proc_address(const char* name) {
  static const struct {
    const char* name;
    GdFunction function;
  } kFunctions[] = {
      {"classdb_construct_object", (GdFunction)construct_object},
      {"object_set_instance", (GdFunction)set_instance},
      {"object_get_instance_id", (GdFunction)id_of},
      {"object_get_instance_from_id", (GdFunction)object_of_id},
      {"global_get_singleton", (GdFunction)get_singleton},
      {"classdb_register_extension_class2", (GdFunction)register_class},
      {"classdb_register_extension_class_method", (GdFunction)register_method},
      {"classdb_unregister_extension_class", (GdFunction)unregister_class},
      {"editor_add_plugin", (GdFunction)add_editor_plugin},
      {"editor_remove_plugin", (GdFunction)remove_editor_plugin},
      {"variant_call", (GdFunction)variant_call},
      {"print_error", (GdFunction)print_error},
  };
  if (missing && !strcmp(missing, name)) return NULL;
  for (size_t i = 0; i < sizeof kFunctions / sizeof *kFunctions; ++i) {
    if (!strcmp(kFunctions[i].name, name)) return kFunctions[i].function;
  }
  const GdFunction found = value_function(name);
  if (!found) printf("the extension asks for %s\n", name);
  return found;
}
