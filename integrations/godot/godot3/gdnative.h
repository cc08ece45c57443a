/* SPDX-License-Identifier: MIT
 * The part of Godot 3's native interface (core 1.0, native scripts 1.0; 64-bit systems, single precision) that the class
 * uses. The functions of the core are a table, of which each is named here by its place. */
#ifndef MIEN_GODOT3_GDNATIVE_H
#define MIEN_GODOT3_GDNATIVE_H

#include <stdint.h>

/* Opaque values in memory of the library, by their sizes. */
typedef struct {
  uint64_t opaque[3];
} Gd3Variant;
typedef struct {
  void* opaque;
} Gd3String, Gd3CharString, Gd3Bytes;
typedef void* Gd3Object;

/* Rows of the basis, then the origin. */
typedef struct {
  float rows[3][3], origin[3];
} Gd3Transform;

enum {
  GD3_NIL = 0,
  GD3_BOOL = 1,
  GD3_INT = 2,
  GD3_REAL = 3,
  GD3_STRING = 4,
  GD3_OBJECT = 17,
  GD3_BYTES = 20
};

typedef struct {
  int32_t error, argument, expected;
} Gd3CallError;

typedef void (*Gd3Function)(void);

/* Places in the table of the core. */
enum {
  GD3_BYTES_NEW = 155,
  GD3_BYTES_RESIZE = 164,
  GD3_BYTES_READ = 165,
  GD3_BYTES_WRITE = 166,
  GD3_BYTES_SIZE = 169,
  GD3_BYTES_DESTROY = 170,
  GD3_READ_POINTER = 268,
  GD3_READ_DESTROY = 270,
  GD3_WRITE_POINTER = 296,
  GD3_WRITE_DESTROY = 298,
  GD3_VARIANT_TYPE = 507,
  GD3_VARIANT_NEW_NIL = 509,
  GD3_VARIANT_NEW_BOOL = 510,
  GD3_VARIANT_NEW_INT = 512,
  GD3_VARIANT_NEW_REAL = 513,
  GD3_VARIANT_NEW_STRING = 514,
  GD3_VARIANT_NEW_TRANSFORM = 523,
  GD3_VARIANT_NEW_BYTES = 530,
  GD3_VARIANT_AS_INT = 539,
  GD3_VARIANT_AS_REAL = 540,
  GD3_VARIANT_AS_STRING = 541,
  GD3_VARIANT_AS_BYTES = 557,
  GD3_VARIANT_CALL = 564,
  GD3_VARIANT_DESTROY = 570,
  GD3_CHARS_DATA = 572,
  GD3_CHARS_DESTROY = 573,
  GD3_STRING_TO_UTF8 = 678,
  GD3_STRING_FROM_UTF8 = 681,
  GD3_STRING_DESTROY = 721,
  GD3_PRINT_ERROR = 741
};

typedef struct {
  uint32_t type; /* of an extension: GD3_NATIVESCRIPT or another one */
  uint32_t major, minor;
  const void* next;
} Gd3Api;

typedef struct {
  Gd3Api api;
  uint32_t extension_count;
  const Gd3Api** extensions;
  Gd3Function functions[1]; /* many */
} Gd3Core;

/* Functions that Godot calls with `data`, until it calls `free_data`. */
typedef struct {
  void* (*create)(Gd3Object object, void* data);
  void* data;
  void (*free_data)(void* data);
} Gd3Create;
typedef struct {
  void (*destroy)(Gd3Object object, void* data, void* instance);
  void* data;
  void (*free_data)(void* data);
} Gd3Destroy;
typedef struct {
  Gd3Variant (*call)(Gd3Object object, void* data, void* instance, int count,
                     Gd3Variant** arguments);
  void* data;
  void (*free_data)(void* data);
} Gd3Method;
typedef struct {
  int32_t remote; /* 0: not called by other computers */
} Gd3MethodAttributes;

enum { GD3_NATIVESCRIPT = 1 };

typedef struct {
  Gd3Api api;
  void (*register_class)(void* library, const char* name, const char* base, Gd3Create, Gd3Destroy);
  void (*register_tool_class)(void* library, const char* name, const char* base, Gd3Create,
                              Gd3Destroy);
  void (*register_method)(void* library, const char* class_name, const char* name,
                          Gd3MethodAttributes, Gd3Method);
} Gd3NativeScript;

typedef struct {
  uint8_t in_editor;
  uint64_t core_hash, editor_hash, no_hash;
  void *report_version_mismatch, *report_loading_error;
  Gd3Object library;
  const Gd3Core* core;
  const Gd3String* path;
} Gd3InitOptions;

#endif
