/* SPDX-License-Identifier: MIT
 * What the classes for Godot 4 use of Godot: functions of its interface, names, values and calls. Methods of Godot's
 * classes are called by name with variants, so nothing depends on the version that the extension was built for. */
#ifndef MIEN_GODOT_GODOT_H
#define MIEN_GODOT_GODOT_H

#include <stddef.h>

#include "gdextension.h"

typedef struct {
  void* library;
  GdObject (*classdb_construct_object)(const GdStringName*);
  void (*object_set_instance)(GdObject, const GdStringName*, void*);
  uint64_t (*object_get_instance_id)(GdObject);
  GdObject (*object_get_instance_from_id)(uint64_t); /* NULL if the object is gone */
  GdObject (*global_get_singleton)(const GdStringName*);
  void (*classdb_register_extension_class2)(void*, const GdStringName*, const GdStringName*,
                                            const GdClassInfo2*);
  void (*classdb_register_extension_class_method)(void*, const GdStringName*, const GdMethodInfo*);
  void (*classdb_unregister_extension_class)(void*, const GdStringName*);
  void (*editor_add_plugin)(const GdStringName*);
  void (*editor_remove_plugin)(const GdStringName*);
  void (*string_name_new_with_latin1_chars)(GdStringName*, const char*, uint8_t);
  void (*string_name_new_with_utf8_chars)(GdStringName*, const char*);
  void (*string_new_with_utf8_chars)(GdString*, const char*);
  int64_t (*string_to_utf8_chars)(const GdString*, char*, int64_t);
  uint8_t* (*packed_byte_array_operator_index)(GdPackedArray*, int64_t);
  const uint8_t* (*packed_byte_array_operator_index_const)(const GdPackedArray*, int64_t);
  int32_t* (*packed_int32_array_operator_index)(GdPackedArray*, int64_t);
  void* (*packed_vector2_array_operator_index)(GdPackedArray*, int64_t);
  void* (*packed_vector3_array_operator_index)(GdPackedArray*, int64_t);
  void (*variant_call)(GdVariant*, const GdStringName*, const GdVariant* const*, int64_t,
                       GdVariant*, GdCallError*);
  void (*variant_construct)(int32_t, GdVariant*, const GdVariant* const*, int32_t, GdCallError*);
  void (*variant_new_copy)(GdVariant*, const GdVariant*);
  void (*variant_new_nil)(GdVariant*);
  void (*variant_destroy)(GdVariant*);
  int32_t (*variant_get_type)(const GdVariant*);
  void (*print_error)(const char*, const char*, const char*, int32_t, uint8_t);
  void (*from[GD_TYPE_COUNT])(GdVariant*, void*); /* of the types that are used */
  void (*to[GD_TYPE_COUNT])(void*, const GdVariant*);
  void (*destroy[GD_TYPE_COUNT])(void*);
} Gd;

extern Gd gd;

/* Names of classes, methods and properties. Equal names have equal pointers. */
/* clang-format off */
#define GD_NAMES(X)                                                                               \
  X(ArrayMesh) X(EditorImportPlugin) X(EditorPlugin) X(MeshInstance3D) X(MienEditorPlugin)        \
  X(MienFace3D) X(MienImporter) X(MienRig) X(Node3D) X(ProjectSettings) X(RenderingServer)        \
  X(Resource) X(ResourceSaver) X(_process) X(add_child) X(add_import_plugin)                      \
  X(add_surface_from_arrays) X(append) X(baked) X(find_blend_shape_by_name) X(find_bone) X(get)   \
  X(get_node_or_null) X(get_rid) X(get_surface_count) X(globalize_path) X(lod) X(mesh)            \
  X(mesh_surface_get_format_normal_tangent_stride) X(mesh_surface_get_format_offset)              \
  X(mesh_surface_update_vertex_region) X(notify_property_list_changed) X(queue_free)              \
  X(remove_import_plugin) X(resize) X(rig) X(save) X(set) X(set_blend_shape_value)                \
  X(set_bone_pose_position) X(set_bone_pose_rotation) X(set_bone_pose_scale) X(set_mesh)          \
  X(set_visible) X(show_geometry) X(size) X(skeleton) X(surface_get_format)
/* clang-format on */
typedef struct {
#define GD_FIELD(name) GdStringName name;
  GD_NAMES(GD_FIELD)
#undef GD_FIELD
  GdStringName none; /* "" */
} GdNames;

extern GdNames gd_names;

/* Asks for the functions. Returns 0 if this Godot lacks one. */
uint8_t gd_load(GdGetProcAddress get, void* library);

/* Makes the names, once. */
void gd_make_names(void);

/* A name of a literal. */
GdStringName gd_name(const char* literal);
int gd_is_equal(const GdStringName* a, const GdStringName* b);

/* Cut at `capacity` - 1 bytes. */
void gd_read_text(const GdString* string, char* out_text, size_t capacity);

/* Variants: destroy each with gd.variant_destroy(), or pass it to a call. */
GdVariant gd_nil(void);
GdVariant gd_value(int32_t type, const void* value); /* a copy of a value of this type */
GdVariant gd_int(int64_t number);
GdVariant gd_bool(uint8_t truth);
GdVariant gd_text(const char* text);    /* a String */
GdVariant gd_name_of(const char* text); /* a StringName */
GdVariant gd_empty(int32_t type);       /* as its constructor without arguments makes it */
GdVariant gd_copy(const GdVariant* variant);
GdVariant gd_singleton(const GdStringName* name);
/* A packed array of a type with a copy of `count` elements. */
GdVariant gd_packed(int32_t type, const void* elements, size_t count, size_t element_size);

/* Calls a method, prints an error if that is not possible, and destroys the arguments. */
GdVariant gd_call(GdVariant* self, const GdStringName* method, GdVariant* arguments, int count);
GdVariant gd_call_object(GdObject object, const GdStringName* method, GdVariant* arguments,
                         int count);
/* The same for results that are not used, or that are whole numbers; -1 if it is none. */
int64_t gd_call_int(GdVariant* self, const GdStringName* method, GdVariant* arguments, int count);

/* The object of a variant, which the variant may own; NULL if there is none. */
GdObject gd_object_of(const GdVariant* variant);

#endif
