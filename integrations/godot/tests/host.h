/* SPDX-License-Identifier: MIT
 * A host that plays Godot 4: its values with their owners, the classes that the extension uses with the arguments that they
 * take, and its reference counts. Whatever Godot would refuse fails an assertion. */
#ifndef MIEN_GODOT_TESTS_HOST_H
#define MIEN_GODOT_TESTS_HOST_H

#undef NDEBUG
#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "../gdextension.h"

/* ---- values (host_values.c) ------------------------------------------------------------------------- */

/* What is alive: must be as before when a test ends. */
typedef struct {
  int strings, names, variants, blocks, objects;
} Alive;
extern Alive alive;

/* A packed array or an array: shared by reference count, copied before it is written. */
typedef struct {
  int refs;
  int32_t type; /* GD_PACKED_..., GD_ARRAY */
  size_t count, element_size;
  unsigned char* data;
} Block;

size_t element_size_of(int32_t type);
Block* block_of(const GdVariant* variant);

void make(GdVariant* out, int32_t type, const void* value); /* copies a value */
void take(void* out, int32_t type, const GdVariant* variant);
int32_t type_of(const GdVariant* variant);
const char* text_of(const GdVariant* variant); /* of a String, StringName or NodePath */
void string_new(GdString* out, const char* text);
void string_destroy(void* string);
GdStringName name_of(const char* text); /* counted: destroy it */
void name_destroy(void* name);
const char* name_text(const GdStringName* name);
void variant_destroy(GdVariant* variant);
void variant_copy(GdVariant* out, const GdVariant* variant);
void packed_destroy(void* array);

/* A function of the interface that deals with values, by its name; NULL if it is none. */
GdFunction value_function(const char* name);

/* A method of a packed array, an Array or a String. */
void call_value(GdVariant* self, const char* method, const GdVariant* const* arguments,
                int64_t count, GdVariant* result);

/* ---- objects (host_classes.c) ----------------------------------------------------------------------- */

enum { MAX_TARGETS = 512 };

typedef struct Object {
  uint64_t id;
  const char* class_name; /* of Godot's own classes */
  int refs, is_new;       /* of a RefCounted: it begins with one that its first owner takes over */
  const void* extension;  /* its class, or NULL */
  void* instance;
  struct Object* parent;
  int child_count, is_visible, is_queued; /* queue_free() */
  /* Skeleton3D and MeshInstance3D: targets by name */
  int count;
  const char* names[MAX_TARGETS];
  float values[MAX_TARGETS][10];
  GdVariant mesh;
  int has_mesh;
  /* ArrayMesh: what the RenderingServer has of it */
  unsigned char* buffer;
  float* texture_coordinates;
  int32_t* indices;
  size_t index_count;
  size_t buffer_size, vertex_count;
  uint64_t format;
  GdPackedArray in_flight; /* the last update, which the server still reads */
  uint64_t in_flight_hash;
  int update_count;
} Object;

extern char project_folder[1024]; /* of res:// */
extern int errors;                /* that were printed */
extern int list_changes;          /* notify_property_list_changed() */
extern Object* import_plugin;     /* that an EditorPlugin added */
extern const char* editor_plugin; /* class that the extension added */
extern GdVariant saved;           /* by ResourceSaver */
extern char saved_path[1024];

Object* construct(const char* class_name); /* of Godot or of the extension */
void free_object(Object* object);
void end_frame(void); /* frees what is queued */
Object* next_child(const Object* parent,
                   const Object* after); /* in the order of their creation; NULL at the end */
int is_class(const Object* object, const char* class_name);
void own(Object* object);
void disown(Object* object);

/* The extension's part of an object. */
const GdClassInfo2* class_info(const Object* object);
GdVirtual virtual_of(const Object* object, const char* name);
const GdMethodInfo* find_method(const Object* object, const char* name);
uint8_t set_property(Object* object, const char* name, const GdVariant* value);
uint8_t get_property(Object* object, const char* name, GdVariant* result);

GdFunction get_proc_address(const char* name);
extern const char* missing; /* a function that this Godot does not have */
extern int library;
int class_count(void); /* that the extension has registered */
int method_count(void);

#endif
