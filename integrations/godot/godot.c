/* SPDX-License-Identifier: MIT */
#include "godot.h"

#include <string.h>

Gd gd;
GdNames gd_names;

uint8_t gd_load(GdGetProcAddress get, void* library) {
  GdFunction found;
  gd.library = library;
#define GD_ASK(function)                   \
  if (!(found = get(#function))) return 0; \
  memcpy(&gd.function, &found, sizeof found)
  GD_ASK(classdb_construct_object);
  GD_ASK(object_set_instance);
  GD_ASK(object_get_instance_id);
  GD_ASK(object_get_instance_from_id);
  GD_ASK(global_get_singleton);
  GD_ASK(classdb_register_extension_class2);
  GD_ASK(classdb_register_extension_class_method);
  GD_ASK(classdb_unregister_extension_class);
  GD_ASK(editor_add_plugin);
  GD_ASK(editor_remove_plugin);
  GD_ASK(string_name_new_with_latin1_chars);
  GD_ASK(string_name_new_with_utf8_chars);
  GD_ASK(string_new_with_utf8_chars);
  GD_ASK(string_to_utf8_chars);
  GD_ASK(packed_byte_array_operator_index);
  GD_ASK(packed_byte_array_operator_index_const);
  GD_ASK(packed_int32_array_operator_index);
  GD_ASK(packed_vector2_array_operator_index);
  GD_ASK(packed_vector3_array_operator_index);
  GD_ASK(variant_call);
  GD_ASK(variant_construct);
  GD_ASK(variant_new_copy);
  GD_ASK(variant_new_nil);
  GD_ASK(variant_destroy);
  GD_ASK(variant_get_type);
  GD_ASK(print_error);
#undef GD_ASK
  const GdFunction from = get("get_variant_from_type_constructor"),
                   to = get("get_variant_to_type_constructor"),
                   destructor = get("variant_get_ptr_destructor");
  if (!from || !to || !destructor) return 0;
  static const int32_t kTypes[] = {
      GD_BOOL,          GD_INT,          GD_FLOAT,          GD_STRING,
      GD_VECTOR3,       GD_QUATERNION,   GD_STRING_NAME,    GD_OBJECT,
      GD_PACKED_BYTES,  GD_PACKED_INT32, GD_PACKED_STRINGS, GD_PACKED_VECTOR2,
      GD_PACKED_VECTOR3};
  for (size_t i = 0; i < sizeof kTypes / sizeof *kTypes; ++i) {
    found = ((GdFunction(*)(int32_t))from)(kTypes[i]);
    memcpy(&gd.from[kTypes[i]], &found, sizeof found);
    found = ((GdFunction(*)(int32_t))to)(kTypes[i]);
    memcpy(&gd.to[kTypes[i]], &found, sizeof found);
  }
  static const int32_t kDestroyed[] = {GD_STRING,       GD_STRING_NAME,    GD_PACKED_BYTES,
                                       GD_PACKED_INT32, GD_PACKED_VECTOR2, GD_PACKED_VECTOR3};
  for (size_t i = 0; i < sizeof kDestroyed / sizeof *kDestroyed; ++i) {
    found = ((GdFunction(*)(int32_t))destructor)(kDestroyed[i]);
    memcpy(&gd.destroy[kDestroyed[i]], &found, sizeof found);
  }
  return 1;
}

GdStringName gd_name(const char* literal) {
  GdStringName name;
  gd.string_name_new_with_latin1_chars(&name, literal, 1);
  return name;
}

int gd_is_equal(const GdStringName* a, const GdStringName* b) { return a->opaque == b->opaque; }

void gd_make_names(void) {
#define GD_MAKE(name) gd_names.name = gd_name(#name);
  GD_NAMES(GD_MAKE)
#undef GD_MAKE
  gd_names.none = gd_name("");
}

void gd_read_text(const GdString* string, char* out_text, size_t capacity) {
  const int64_t length = gd.string_to_utf8_chars(string, out_text, (int64_t)capacity - 1);
  out_text[length < 0 ? 0 : length < (int64_t)capacity ? length : (int64_t)capacity - 1] = 0;
}

GdVariant gd_nil(void) {
  GdVariant variant;
  gd.variant_new_nil(&variant);
  return variant;
}

GdVariant gd_value(int32_t type, const void* value) {
  GdVariant variant;
  gd.from[type](&variant, (void*)(uintptr_t)value);
  return variant;
}

GdVariant gd_int(int64_t number) { return gd_value(GD_INT, &number); }

GdVariant gd_bool(uint8_t truth) { return gd_value(GD_BOOL, &truth); }

GdVariant gd_text(const char* text) {
  GdString string;
  gd.string_new_with_utf8_chars(&string, text);
  const GdVariant variant = gd_value(GD_STRING, &string);
  gd.destroy[GD_STRING](&string);
  return variant;
}

GdVariant gd_name_of(const char* text) {
  GdStringName name;
  gd.string_name_new_with_utf8_chars(&name, text);
  const GdVariant variant = gd_value(GD_STRING_NAME, &name);
  gd.destroy[GD_STRING_NAME](&name);
  return variant;
}

GdVariant gd_empty(int32_t type) {
  GdVariant variant;
  GdCallError error;
  gd.variant_construct(type, &variant, NULL, 0, &error);
  return variant;
}

GdVariant gd_copy(const GdVariant* variant) {
  GdVariant copy;
  gd.variant_new_copy(&copy, variant);
  return copy;
}

GdVariant gd_singleton(const GdStringName* name) {
  GdObject object = gd.global_get_singleton(name);
  return gd_value(GD_OBJECT, &object);
}

GdVariant gd_packed(int32_t type, const void* elements, size_t count, size_t element_size) {
  GdVariant variant = gd_empty(type), size = gd_int((int64_t)count);
  gd_call_int(&variant, &gd_names.resize, &size, 1);
  if (count == 0 || gd_call_int(&variant, &gd_names.size, NULL, 0) != (int64_t)count)
    return variant; /* empty, also without memory */
  GdPackedArray array;
  gd.to[type](&array, &variant);
  gd.variant_destroy(&variant); /* otherwise writing would copy it */
  void* target = type == GD_PACKED_BYTES   ? (void*)gd.packed_byte_array_operator_index(&array, 0)
                 : type == GD_PACKED_INT32 ? (void*)gd.packed_int32_array_operator_index(&array, 0)
                 : type == GD_PACKED_VECTOR2 ? gd.packed_vector2_array_operator_index(&array, 0)
                                             : gd.packed_vector3_array_operator_index(&array, 0);
  memcpy(target, elements, count * element_size);
  variant = gd_value(type, &array);
  gd.destroy[type](&array);
  return variant;
}

GdVariant gd_call(GdVariant* self, const GdStringName* method, GdVariant* arguments, int count) {
  const GdVariant* list[5];
  GdCallError error = {0, 0, 0};
  GdVariant result = gd_nil();
  for (int i = 0; i < count; ++i) list[i] = &arguments[i];
  gd.variant_call(self, method, list, count, &result, &error);
  if (error.error != GD_CALL_OK)
    gd.print_error("a method of Godot cannot be called", __func__, __FILE__, __LINE__, 0);
  for (int i = 0; i < count; ++i) gd.variant_destroy(&arguments[i]);
  return result;
}

GdVariant gd_call_object(GdObject object, const GdStringName* method, GdVariant* arguments,
                         int count) {
  GdVariant self = gd_value(GD_OBJECT, &object);
  const GdVariant result = gd_call(&self, method, arguments, count);
  gd.variant_destroy(&self);
  return result;
}

int64_t gd_call_int(GdVariant* self, const GdStringName* method, GdVariant* arguments, int count) {
  int64_t number = -1;
  GdVariant result = gd_call(self, method, arguments, count);
  if (gd.variant_get_type(&result) == GD_INT) gd.to[GD_INT](&number, &result);
  gd.variant_destroy(&result);
  return number;
}

GdObject gd_object_of(const GdVariant* variant) {
  GdObject object = NULL;
  if (gd.variant_get_type(variant) == GD_OBJECT) gd.to[GD_OBJECT](&object, variant);
  return object;
}
