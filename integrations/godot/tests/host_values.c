/* SPDX-License-Identifier: MIT
 * Godot's values. A variant is its type and the value, or a pointer to a shared one. */
#include <stdio.h>

#include "host.h"

Alive alive;

/* ---- strings, and names that are interned ----------------------------------------------------------- */

static char* copy_text(const char* text) {
  char* copy = malloc(strlen(text) + 1);
  assert(copy);
  strcpy(copy, text);
  return copy;
}

void string_new(GdString* out, const char* text) {
  out->opaque = copy_text(text);
  ++alive.strings;
}

void string_destroy(void* string) {
  GdString* s = string;
  assert(s->opaque && alive.strings > 0);
  free(s->opaque);
  s->opaque = NULL;
  --alive.strings;
}

static int64_t string_to_utf8(const GdString* string, char* out, int64_t size) {
  const size_t length = strlen(string->opaque);
  memcpy(out, string->opaque, length < (size_t)size ? length : (size_t)size);
  return (int64_t)length;
}

enum { MAX_NAMES = 8192 };
static char* interned[MAX_NAMES];

static GdStringName intern(const char* text) {
  GdStringName name;
  size_t i = 0;
  while (interned[i] && strcmp(interned[i], text) != 0) ++i;
  assert(i + 1 < MAX_NAMES);
  if (!interned[i]) interned[i] = copy_text(text);
  name.opaque = interned[i];
  return name;
}

static void name_new_static(GdStringName* out, const char* text, uint8_t is_static) {
  assert(is_static);
  *out = intern(text);
}

static void name_new(GdStringName* out, const char* text) {
  *out = intern(text);
  ++alive.names;
}

GdStringName name_of(const char* text) {
  GdStringName name;
  name_new(&name, text);
  return name;
}

void name_destroy(void* name) {
  assert(((GdStringName*)name)->opaque && alive.names > 0);
  ((GdStringName*)name)->opaque = NULL;
  --alive.names;
}

const char* name_text(const GdStringName* name) {
  for (size_t i = 0; interned[i]; ++i) {
    if (interned[i] == name->opaque) return interned[i];
  }
  assert(0 && "a name that Godot did not make");
  return NULL;
}

/* ---- arrays ----------------------------------------------------------------------------------------- */

size_t element_size_of(int32_t type) {
  switch (type) {
    case GD_PACKED_BYTES: return 1;
    case GD_PACKED_INT32: return 4;
    case GD_PACKED_VECTOR2: return 8;
    case GD_PACKED_VECTOR3: return 12;
    case GD_PACKED_STRINGS: return sizeof(GdString);
    default: assert(type == GD_ARRAY || type == GD_DICTIONARY); return sizeof(GdVariant);
  }
}

static Block* block_new(int32_t type) {
  Block* block = calloc(1, sizeof *block);
  assert(block);
  block->refs = 1;
  block->type = type;
  block->element_size = element_size_of(type);
  ++alive.blocks;
  return block;
}

static void block_release(Block* block) {
  if (!block) return;
  assert(block->refs > 0);
  if (--block->refs != 0) return;
  for (size_t i = 0; i < block->count; ++i) {
    unsigned char* element = block->data + i * block->element_size;
    if (block->type == GD_PACKED_STRINGS) string_destroy(element);
    if (block->type == GD_ARRAY) variant_destroy((GdVariant*)(void*)element);
  }
  free(block->data);
  free(block);
  --alive.blocks;
}

static void block_resize(Block* block, size_t count) {
  block->data = realloc(block->data, count * block->element_size + 1);
  assert(block->data);
  if (count > block->count) {
    memset(block->data + block->count * block->element_size, 0,
           (count - block->count) * block->element_size);
  }
  block->count = count;
}

/* Before it is written. */
static Block* block_unshare(Block* block) {
  if (block->refs == 1) return block;
  assert(block->type != GD_ARRAY && block->type != GD_PACKED_STRINGS);
  Block* copy = block_new(block->type);
  block_resize(copy, block->count);
  memcpy(copy->data, block->data, block->count * block->element_size);
  block_release(block);
  return copy;
}

void packed_destroy(void* array) {
  GdPackedArray* a = array;
  block_release(a->opaque[0]);
  a->opaque[0] = a->opaque[1] = NULL;
}

static void* packed_write(GdPackedArray* array, int64_t index) {
  Block* block = array->opaque[0];
  assert(block && index >= 0 && (size_t)index < block->count);
  array->opaque[0] = block = block_unshare(block);
  return block->data + (size_t)index * block->element_size;
}
static uint8_t* bytes_write(GdPackedArray* array, int64_t index) {
  return packed_write(array, index);
}
static const uint8_t* bytes_read(const GdPackedArray* array, int64_t index) {
  const Block* block = array->opaque[0];
  assert(block && index >= 0 && (size_t)index < block->count);
  return block->data + index;
}
static int32_t* int32_write(GdPackedArray* array, int64_t index) {
  return packed_write(array, index);
}

/* ---- variants --------------------------------------------------------------------------------------- */

static const uint64_t kDead = 0xdeaddead;

int32_t type_of(const GdVariant* variant) {
  assert(variant->opaque[0] < GD_TYPE_COUNT);
  return (int32_t)variant->opaque[0];
}

static int is_block(int32_t type) {
  return type == GD_ARRAY || type == GD_DICTIONARY || type >= GD_PACKED_BYTES;
}

/* The block of a variant, which copies of the variant share. */
typedef struct {
  int refs;
  Block* block;
} Shared;

static Shared* shared_of(const GdVariant* variant) {
  Shared* shared;
  assert(is_block(type_of(variant)));
  memcpy(&shared, &variant->opaque[1], sizeof shared);
  return shared;
}

Block* block_of(const GdVariant* variant) { return shared_of(variant)->block; }

static void make_shared(GdVariant* out, Block* block) {
  Shared* shared = malloc(sizeof *shared);
  assert(shared);
  shared->refs = 1;
  shared->block = block;
  memcpy(&out->opaque[1], &shared, sizeof shared);
}

static size_t size_of(int32_t type) {
  return type == GD_BOOL ? 1 : type == GD_VECTOR3 ? 12 : type == GD_QUATERNION ? 16 : 8;
}

void make(GdVariant* out, int32_t type, const void* value) {
  ++alive.variants;
  memset(out, 0xee, sizeof *out);
  out->opaque[0] = (uint64_t)type;
  if (type == GD_STRING || type == GD_NODE_PATH) {
    GdString copy;
    string_new(&copy, ((const GdString*)value)->opaque);
    memcpy(&out->opaque[1], &copy, sizeof copy);
  } else if (is_block(type)) {
    Block* block = ((const GdPackedArray*)value)->opaque[0];
    if (block) {
      assert(block->type == type);
      ++block->refs;
    } else {
      block = block_new(type);
    }
    make_shared(out, block);
  } else {
    if (type == GD_STRING_NAME) {
      name_text(value);
      ++alive.names;
    }
    memcpy(&out->opaque[1], value, size_of(type));
    if (type == GD_OBJECT) own(*(Object* const*)value);
  }
}

void take(void* out, int32_t type, const GdVariant* variant) {
  if (type == GD_FLOAT && type_of(variant) == GD_INT) {
    *(double*)out = (double)(int64_t)variant->opaque[1];
    return;
  }
  assert(type_of(variant) == type);
  if (type == GD_STRING) {
    string_new(out, text_of(variant));
  } else if (is_block(type)) {
    GdPackedArray* array = out;
    Block* block = block_of(variant);
    ++block->refs;
    array->opaque[0] = block;
    array->opaque[1] = NULL;
  } else {
    if (type == GD_STRING_NAME) ++alive.names;
    memcpy(out, &variant->opaque[1], size_of(type));
  }
}

const char* text_of(const GdVariant* variant) {
  const int32_t type = type_of(variant);
  char* text;
  assert(type == GD_STRING || type == GD_NODE_PATH || type == GD_STRING_NAME);
  memcpy(&text, &variant->opaque[1], sizeof text);
  return text;
}

void variant_copy(GdVariant* out, const GdVariant* variant) {
  const int32_t type = type_of(variant);
  if (type == GD_NIL) {
    memset(out, 0, sizeof *out);
  } else if (is_block(type)) {
    ++shared_of(variant)->refs;
    *out = *variant;
    ++alive.variants;
  } else {
    make(out, type, &variant->opaque[1]);
  }
}

void variant_destroy(GdVariant* variant) {
  const int32_t type = type_of(variant); /* fails for one that was destroyed before */
  if (type == GD_STRING || type == GD_NODE_PATH) string_destroy(&variant->opaque[1]);
  if (type == GD_STRING_NAME) name_destroy(&variant->opaque[1]);
  if (type == GD_OBJECT) {
    Object* object;
    memcpy(&object, &variant->opaque[1], sizeof object);
    disown(object);
  }
  if (is_block(type)) {
    Shared* shared = shared_of(variant);
    if (--shared->refs == 0) {
      block_release(shared->block);
      free(shared);
    }
  }
  if (type != GD_NIL) --alive.variants;
  variant->opaque[0] = kDead;
}

static void variant_nil(GdVariant* out) { memset(out, 0, sizeof *out); }

static void variant_construct(int32_t type, GdVariant* out, const GdVariant* const* arguments,
                              int32_t count, GdCallError* error) {
  const GdPackedArray empty = {{NULL, NULL}};
  assert(!arguments && count == 0 && is_block(type));
  error->error = GD_CALL_OK;
  make(out, type, &empty);
}

void call_value(GdVariant* self, const char* method, const GdVariant* const* arguments,
                int64_t count, GdVariant* result) {
  Shared* shared = shared_of(self);
  if (!strcmp(method, "size")) {
    const int64_t size = (int64_t)shared->block->count;
    assert(count == 0);
    make(result, GD_INT, &size);
    return;
  }
  assert(count == 1);
  if (shared->block->type != GD_ARRAY && shared->block->type != GD_PACKED_STRINGS)
    shared->block = block_unshare(shared->block);
  Block* block = shared->block;
  if (!strcmp(method, "resize")) {
    int64_t size;
    take(&size, GD_INT, arguments[0]);
    assert(size >= 0 && block->type != GD_ARRAY && block->type != GD_PACKED_STRINGS);
    block_resize(block, (size_t)size);
    size = 0;
    make(result, GD_INT, &size);
    return;
  }
  assert(!strcmp(method, "append"));
  block_resize(block, block->count + 1);
  void* last = block->data + (block->count - 1) * block->element_size;
  if (block->type == GD_ARRAY) {
    variant_copy(last, arguments[0]);
  } else {
    assert(block->type == GD_PACKED_STRINGS);
    take(last, GD_STRING, arguments[0]);
  }
}

/* ---- the functions of the interface ----------------------------------------------------------------- */

/* clang-format off */
#define TYPES(X)                                                                          \
  X(GD_BOOL) X(GD_INT) X(GD_FLOAT) X(GD_STRING) X(GD_VECTOR3) X(GD_QUATERNION)            \
  X(GD_STRING_NAME) X(GD_OBJECT) X(GD_PACKED_BYTES) X(GD_PACKED_INT32)                    \
  X(GD_PACKED_STRINGS) X(GD_PACKED_VECTOR2) X(GD_PACKED_VECTOR3)
/* clang-format on */
#define CONVERSIONS(type)                                                          \
  static void from_##type(GdVariant* out, void* value) { make(out, type, value); } \
  static void to_##type(void* out, const GdVariant* variant) { take(out, type, variant); }
TYPES(CONVERSIONS)
static GdFunction get_from(int32_t type) {
#define FROM(t) \
  if (type == t) return (GdFunction)from_##t;
  TYPES(FROM)
  assert(0 && "a type that the host does not have");
  return NULL;
}
static GdFunction get_to(int32_t type) {
#define TO(t) \
  if (type == t) return (GdFunction)to_##t;
  TYPES(TO)
  assert(0 && "a type that the host does not have");
  return NULL;
}
static GdFunction get_destructor(int32_t type) {
  if (type == GD_STRING) return (GdFunction)string_destroy;
  if (type == GD_STRING_NAME) return (GdFunction)name_destroy;
  assert(type >= GD_PACKED_BYTES);
  return (GdFunction)packed_destroy;
}

GdFunction value_function(const char* name) {
  static const struct {
    const char* name;
    GdFunction function;
  } kFunctions[] = {
      {"string_name_new_with_latin1_chars", (GdFunction)name_new_static},
      {"string_name_new_with_utf8_chars", (GdFunction)name_new},
      {"string_new_with_utf8_chars", (GdFunction)string_new},
      {"string_to_utf8_chars", (GdFunction)string_to_utf8},
      {"packed_byte_array_operator_index", (GdFunction)bytes_write},
      {"packed_byte_array_operator_index_const", (GdFunction)bytes_read},
      {"packed_int32_array_operator_index", (GdFunction)int32_write},
      {"packed_vector2_array_operator_index", (GdFunction)packed_write},
      {"packed_vector3_array_operator_index", (GdFunction)packed_write},
      {"variant_construct", (GdFunction)variant_construct},
      {"variant_new_copy", (GdFunction)variant_copy},
      {"variant_new_nil", (GdFunction)variant_nil},
      {"variant_destroy", (GdFunction)variant_destroy},
      {"variant_get_type", (GdFunction)type_of},
      {"variant_get_ptr_destructor", (GdFunction)get_destructor},
      {"get_variant_from_type_constructor", (GdFunction)get_from},
      {"get_variant_to_type_constructor", (GdFunction)get_to},
  };
  for (size_t i = 0; i < sizeof kFunctions / sizeof *kFunctions; ++i) {
    if (!strcmp(kFunctions[i].name, name)) return kFunctions[i].function;
  }
  return NULL;
}
