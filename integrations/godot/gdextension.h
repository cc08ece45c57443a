/* SPDX-License-Identifier: MIT
 * The part of Godot's extension interface (4.2 and later, builds with single precision) that the classes use. Its functions
 * are asked for by name; names, structs and numbers are those of the interface. */
#ifndef MIEN_GODOT_GDEXTENSION_H
#define MIEN_GODOT_GDEXTENSION_H

#include <stdint.h>

/* Opaque values in memory of the extension, by their sizes on 64-bit systems. */
typedef struct {
  uint64_t opaque[3];
} GdVariant;
typedef struct {
  void* opaque;
} GdStringName;
typedef struct {
  void* opaque;
} GdString;
typedef struct {
  void* opaque[2];
} GdPackedArray; /* of any type of element */
typedef void* GdObject;

enum {
  GD_NIL = 0,
  GD_BOOL = 1,
  GD_INT = 2,
  GD_FLOAT = 3,
  GD_STRING = 4,
  GD_VECTOR3 = 9,
  GD_QUATERNION = 15,
  GD_STRING_NAME = 21,
  GD_NODE_PATH = 22,
  GD_RID = 23,
  GD_OBJECT = 24,
  GD_DICTIONARY = 27,
  GD_ARRAY = 28,
  GD_PACKED_BYTES = 29,
  GD_PACKED_INT32 = 30,
  GD_PACKED_STRINGS = 34,
  GD_PACKED_VECTOR2 = 35,
  GD_PACKED_VECTOR3 = 36,
  GD_TYPE_COUNT = 38
};
enum { GD_METHOD_NORMAL = 1 };
enum { GD_USAGE_NONE = 0, GD_USAGE_STORAGE = 2, GD_USAGE_EDITOR = 4, GD_USAGE_DEFAULT = 6 };
enum { GD_HINT_RANGE = 1, GD_HINT_RESOURCE_TYPE = 17, GD_HINT_NODE_PATH_TYPES = 26 };
enum { GD_CALL_OK = 0, GD_CALL_INVALID_ARGUMENT = 2, GD_CALL_TOO_MANY = 3, GD_CALL_TOO_FEW = 4 };
enum { GD_LEVEL_SCENE = 2, GD_LEVEL_EDITOR = 3 };

typedef struct {
  int32_t error; /* GD_CALL_... */
  int32_t argument, expected;
} GdCallError;

typedef struct {
  int32_t type; /* GD_... */
  GdStringName *name, *class_name;
  uint32_t hint;
  GdString* hint_string;
  uint32_t usage;
} GdPropertyInfo;

/* Runs a virtual method: arguments point to values, `result` to an empty one. */
typedef void (*GdVirtual)(void* instance, const void* const* arguments, void* result);

typedef struct {
  uint8_t is_virtual, is_abstract, is_exposed;
  uint8_t (*set)(void* instance, const GdStringName* name, const GdVariant* value);
  uint8_t (*get)(void* instance, const GdStringName* name, GdVariant* result);
  const GdPropertyInfo* (*get_property_list)(void* instance, uint32_t* count);
  void (*free_property_list)(void* instance, const GdPropertyInfo* list);
  void *property_can_revert, *property_get_revert, *validate_property, *notification, *to_string,
      *reference, *unreference;
  GdObject (*create_instance)(void* class_userdata);
  void (*free_instance)(void* class_userdata, void* instance);
  void* recreate_instance;
  GdVirtual (*get_virtual)(void* class_userdata, const GdStringName* name);
  void *get_virtual_call_data, *call_virtual_with_data, *get_rid, *class_userdata;
} GdClassInfo2;

typedef struct {
  GdStringName* name;
  void* method_userdata;
  void (*call)(void* method_userdata, void* instance, const GdVariant* const* arguments,
               int64_t count, GdVariant* result, GdCallError* error);
  void (*ptrcall)(void* method_userdata, void* instance, const void* const* arguments,
                  void* result);
  uint32_t flags;
  uint8_t has_result;
  GdPropertyInfo* result;
  int32_t result_metadata;
  uint32_t argument_count;
  GdPropertyInfo* arguments;
  const int32_t* argument_metadata;
  uint32_t default_count;
  GdVariant** defaults;
} GdMethodInfo;

typedef void (*GdFunction)(void);
typedef GdFunction (*GdGetProcAddress)(const char* name);

typedef struct {
  int32_t minimum_level; /* GD_LEVEL_... */
  void* userdata;
  void (*initialize)(void* userdata, int32_t level);
  void (*deinitialize)(void* userdata, int32_t level);
} GdInitialization;

#endif
