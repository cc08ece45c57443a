/* SPDX-License-Identifier: MIT
 * What the methods of Godot's classes do in the test. Their arguments were checked. */
#include <math.h>
#include <stdio.h>

#include "host.h"

void host_run(Object* object, const char* method, const GdVariant* const* arguments, int64_t count,
              GdVariant* result);

static int64_t int_of(const GdVariant* variant) {
  int64_t number;
  take(&number, GD_INT, variant);
  return number;
}

static Object* object_of(const GdVariant* variant) {
  Object* object = NULL;
  if (type_of(variant) == GD_OBJECT) take(&object, GD_OBJECT, variant);
  return object;
}

/* ---- Skeleton3D and MeshInstance3D ------------------------------------------------------------------ */

static void find_target(Object* object, const GdVariant* name, GdVariant* result) {
  int64_t found = -1;
  for (int i = 0; i < object->count; ++i) {
    if (!strcmp(object->names[i], text_of(name))) found = i;
  }
  make(result, GD_INT, &found);
}

static int set_target(Object* object, const char* method, const GdVariant* const* arguments) {
  static const struct {
    const char* name;
    int32_t type;
    int at;
  } kSetters[] = {{"set_bone_pose_position", GD_VECTOR3, 0},
                  {"set_bone_pose_rotation", GD_QUATERNION, 3},
                  {"set_bone_pose_scale", GD_VECTOR3, 7}};
  for (int s = 0; s < 3; ++s) {
    if (strcmp(method, kSetters[s].name) != 0) continue;
    const int64_t bone = int_of(arguments[0]);
    assert(bone >= 0 && bone < object->count);
    take(&object->values[bone][kSetters[s].at], kSetters[s].type, arguments[1]);
    return 1;
  }
  if (strcmp(method, "set_blend_shape_value") != 0) return 0;
  double weight;
  const int64_t shape = int_of(arguments[0]);
  assert(shape >= 0 && shape < object->count);
  take(&weight, GD_FLOAT, arguments[1]);
  object->values[shape][0] = (float)weight;
  return 1;
}

/* ---- ArrayMesh and RenderingServer ------------------------------------------------------------------ */

/* Mesh.ArrayFormat of a surface with positions, normals, texture coordinates and indices, version 2. */
static const uint64_t kFormat = 1u | 1u << 1 | 1u << 4 | 1u << 12 | (uint64_t)1 << 35;

static void* copy_of(const Block* block) {
  void* copy = malloc(block->count * block->element_size);
  assert(copy);
  memcpy(copy, block->data, block->count * block->element_size);
  return copy;
}

static void add_surface(Object* mesh, const GdVariant* const* arguments, int64_t count) {
  const Block* arrays = block_of(arguments[1]);
  assert(count == 5 && int_of(arguments[0]) == 3 && arrays->count == 13 && !mesh->buffer);
  assert(block_of(arguments[2])->count == 0 && int_of(arguments[4]) == 1 << 26);
  const GdVariant* items = (const GdVariant*)(const void*)arrays->data;
  for (int i = 0; i < 13; ++i) {
    assert(type_of(&items[i]) == (i <= 1    ? GD_PACKED_VECTOR3
                                  : i == 4  ? GD_PACKED_VECTOR2
                                  : i == 12 ? GD_PACKED_INT32
                                            : GD_NIL));
  }
  const Block *positions = block_of(&items[0]), *indices = block_of(&items[12]);
  const size_t vertices = positions->count;
  assert(vertices > 0 && block_of(&items[1])->count == vertices &&
         block_of(&items[4])->count == vertices);
  assert(indices->count > 0 && indices->count % 3 == 0);
  for (size_t i = 0; i < indices->count; ++i) {
    int32_t index;
    memcpy(&index, indices->data + 4 * i, 4);
    assert(index >= 0 && (size_t)index < vertices);
  }
  mesh->vertex_count = vertices;
  mesh->buffer_size = 16 * vertices;
  mesh->buffer = calloc(vertices, 16);
  assert(mesh->buffer);
  memcpy(mesh->buffer, positions->data, 12 * vertices);
  mesh->texture_coordinates = copy_of(block_of(&items[4]));
  mesh->indices = copy_of(indices);
  mesh->index_count = indices->count;
  mesh->format = kFormat | (uint64_t)int_of(arguments[4]);
}

static uint64_t hash_of(const Block* block) {
  uint64_t hash = 0xcbf29ce484222325;
  for (size_t i = 0; i < block->count; ++i) hash = (hash ^ block->data[i]) * 0x100000001b3;
  return hash;
}

/* The server reads what it got until the next update, as it does in a thread of its own: nobody may write to it. */
static void update_region(const GdVariant* const* arguments) {
  Object* mesh;
  const Block* data = block_of(arguments[3]);
  memcpy(&mesh, &arguments[0]->opaque[1], sizeof mesh);
  const int64_t offset = int_of(arguments[2]);
  assert(mesh->buffer && int_of(arguments[1]) == 0 && offset >= 0);
  assert((size_t)offset + data->count <= mesh->buffer_size && data->count > 0);
  if (mesh->in_flight.opaque[0]) {
    assert(hash_of(mesh->in_flight.opaque[0]) == mesh->in_flight_hash);
    packed_destroy(&mesh->in_flight);
  }
  take(&mesh->in_flight, GD_PACKED_BYTES, arguments[3]);
  mesh->in_flight_hash = hash_of(data);
  memcpy(mesh->buffer + offset, data->data, data->count);
  ++mesh->update_count;
}

/* ---- the others ------------------------------------------------------------------------------------- */

static void add_child(Object* parent, const GdVariant* const* arguments, int64_t count) {
  Object* child = object_of(arguments[0]);
  assert(child && is_class(child, "Node") && !child->parent && count == 3);
  assert(int_of(arguments[2]) >= 0 && int_of(arguments[2]) <= 2);
  child->parent = parent;
  ++parent->child_count;
}

/* Paths are names of targets: the test hangs nodes below others by their ids. */
static void get_node(const GdVariant* path, GdVariant* result) {
  Object* found;
  if (sscanf(text_of(path), "%p", (void**)&found) == 1) make(result, GD_OBJECT, &found);
}

static void globalize(const GdVariant* path, GdVariant* result) {
  char text[2048];
  GdString string;
  assert(!strncmp(text_of(path), "res://", 6));
  snprintf(text, sizeof text, "%s/%s", project_folder, text_of(path) + 6);
  string_new(&string, text);
  make(result, GD_STRING, &string);
  string_destroy(&string);
}

static void save(const GdVariant* const* arguments, int64_t count, GdVariant* result) {
  const int64_t ok = 0;
  assert(count >= 2 && is_class(object_of(arguments[0]), "Resource"));
  if (type_of(&saved) != GD_NIL) variant_destroy(&saved);
  variant_copy(&saved, arguments[0]);
  snprintf(saved_path, sizeof saved_path, "%s", text_of(arguments[1]));
  make(result, GD_INT, &ok);
}

void host_run(Object* object, const char* method, const GdVariant* const* arguments, int64_t count,
              GdVariant* result) {
#define IS(name) (!strcmp(method, name))
  if (IS("find_bone") || IS("find_blend_shape_by_name")) {
    find_target(object, arguments[0], result);
  } else if (set_target(object, method, arguments)) {
  } else if (IS("get")) {
    get_property(object, text_of(arguments[0]), result);
  } else if (IS("set")) {
    assert(set_property(object, text_of(arguments[0]), arguments[1]));
  } else if (IS("notify_property_list_changed")) {
    ++list_changes;
  } else if (IS("add_child")) {
    add_child(object, arguments, count);
  } else if (IS("get_node_or_null")) {
    get_node(arguments[0], result);
  } else if (IS("queue_free")) {
    assert(object->parent && !object->is_queued);
    object->is_queued = 1;
  } else if (IS("set_visible")) {
    uint8_t visible;
    take(&visible, GD_BOOL, arguments[0]);
    object->is_visible = visible;
  } else if (IS("set_mesh")) {
    assert(is_class(object_of(arguments[0]), "ArrayMesh"));
    if (object->has_mesh) variant_destroy(&object->mesh);
    variant_copy(&object->mesh, arguments[0]);
    object->has_mesh = 1;
  } else if (IS("get_rid")) {
    make(result, GD_RID, &object);
  } else if (IS("add_surface_from_arrays")) {
    add_surface(object, arguments, count);
  } else if (IS("get_surface_count")) {
    const int64_t surfaces = object->buffer != NULL;
    make(result, GD_INT, &surfaces);
  } else if (IS("surface_get_format")) {
    assert(object->buffer && int_of(arguments[0]) == 0);
    make(result, GD_INT, &object->format);
  } else if (IS("mesh_surface_get_format_offset")) {
    const int64_t offset = 12 * int_of(arguments[1]);
    assert(((uint64_t)int_of(arguments[0]) & kFormat) == kFormat && int_of(arguments[2]) == 1);
    make(result, GD_INT, &offset);
  } else if (IS("mesh_surface_get_format_normal_tangent_stride")) {
    const int64_t stride = 4;
    make(result, GD_INT, &stride);
  } else if (IS("mesh_surface_update_vertex_region")) {
    update_region(arguments);
  } else if (IS("globalize_path")) {
    globalize(arguments[0], result);
  } else if (IS("save")) {
    save(arguments, count, result);
  } else if (IS("add_import_plugin")) {
    assert(!import_plugin && is_class(object_of(arguments[0]), "EditorImportPlugin"));
    import_plugin = object_of(arguments[0]);
    own(import_plugin);
  } else {
    assert(IS("remove_import_plugin") && import_plugin == object_of(arguments[0]));
    disown(import_plugin);
    import_plugin = NULL;
  }
}
