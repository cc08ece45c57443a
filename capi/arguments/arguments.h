// SPDX-License-Identifier: MIT
// Arguments common to all calls, whatever the handle: sized structs, errors, allocators. Both libraries are
// built with this.
#pragma once

#include <cstring>
#include <initializer_list>

#include "capi/include/mien.h"
#include "runtime/base/allocator.h"
#include "runtime/base/status.h"

namespace mien::capi {

/// Structs never grow beyond this size: a larger one was not initialized.
constexpr size_t kMaxStructSize = 4096;

/// Reads a caller's desc into `out`, which is zero where the caller's is shorter or NULL.
/// `first_size` is the size in the release that introduced the struct.
template <class T>
MienStatus read_struct(const T* in, T& out, size_t first_size = sizeof(T)) {
  memset(static_cast<void*>(&out), 0, sizeof(T));
  if (!in) return MIEN_OK;
  const size_t size = in->struct_size;
  if (size < first_size || size > kMaxStructSize) return MIEN_ERROR_STRUCT_SIZE;
  const uint8_t* bytes = reinterpret_cast<const uint8_t*>(in);
  for (size_t i = sizeof(T); i < size; ++i) {
    if (bytes[i] != 0) return MIEN_ERROR_STRUCT_SIZE;
  }
  memcpy(static_cast<void*>(&out), bytes, size < sizeof(T) ? size : sizeof(T));
  return MIEN_OK;
}

/// Clears a caller's output struct except its size, so that it stays zero on failure.
template <class T>
MienStatus clear_struct(T* out, size_t first_size = sizeof(T)) {
  if (!out) return MIEN_ERROR_NULL_ARGUMENT;
  const size_t size = out->struct_size;
  if (size < first_size || size > kMaxStructSize) return MIEN_ERROR_STRUCT_SIZE;
  memset(static_cast<void*>(out), 0, size);
  out->struct_size = size;
  return MIEN_OK;
}

/// Copies `value` to a struct that clear_struct() accepted.
template <class T>
void write_struct(T* out, T value) {
  value.struct_size = out->struct_size;
  memcpy(static_cast<void*>(out), &value,
         value.struct_size < sizeof(T) ? value.struct_size : sizeof(T));
}

inline MienStatus check_error(const MienError* error) {
  return error && (error->struct_size < sizeof(MienError) || error->struct_size > kMaxStructSize)
             ? MIEN_ERROR_STRUCT_SIZE
             : MIEN_OK;
}

/// Whether a handle is of the kind that a tag identifies: what is behind it begins with the tag
/// (runtime/base/object.h).
inline MienStatus check_tag(const void* handle, uint32_t tag) {
  if (!handle) return MIEN_ERROR_NULL_ARGUMENT;
  if (reinterpret_cast<uintptr_t>(handle) % alignof(uint32_t) != 0) return MIEN_ERROR_HANDLE;
  uint32_t found;
  memcpy(&found, handle, sizeof(found));
  return found == tag ? MIEN_OK : MIEN_ERROR_HANDLE;
}

/// Copies an error to the caller's struct, if there is one.
inline MienStatus give_error(const Error& from, MienError* to) {
  if (to) {
    to->status = static_cast<MienStatus>(from.status);
    to->byte_offset = from.byte_offset;
    memcpy(to->message, from.message, sizeof(to->message));
    memset(to + 1, 0, to->struct_size - sizeof(*to));
  }
  return static_cast<MienStatus>(from.status);
}

MIEN_PRINTF(3, 4)
MienStatus give_error(MienError* to, MienStatus status, const char* format, ...);

/// Starts a call with an output and an error: clears the output if there is one.
template <class T>
MienStatus clear_output(T* out, MienError* error) {
  if (out) *out = {};
  if (MienStatus status = check_error(error)) return status;
  return out ? MIEN_OK
             : give_error(error, MIEN_ERROR_NULL_ARGUMENT,
                          "the pointer to the result (out_...) is NULL");
}

inline MienStatus succeed(MienError* error) {
  if (error) error->status = MIEN_OK;
  return MIEN_OK;
}

/// The caller's allocator, or the heap for NULL.
inline MienStatus read_allocator(const MienAllocator* in, Allocator& out, MienError* error) {
  out = default_allocator();
  if (!in) return MIEN_OK;
  if (!in->allocate || !in->release) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "the allocator lacks a function: MienAllocator.allocate or .release is NULL");
  }
  out = {in->user, in->allocate, in->release};
  return MIEN_OK;
}

/// A caller's desc, which may be NULL; `name` is that of its type.
template <class T>
MienStatus read_desc(const T* in, T& out, const char* name, MienError* error) {
  const MienStatus status = read_struct(in, out);
  if (status == MIEN_OK) return MIEN_OK;
  return give_error(error, status,
                    "%s.struct_size is %zu, expected %zu (or more, followed by zeros): set it to "
                    "sizeof(%s) or start from its default function",
                    name, in->struct_size, sizeof(T), name);
}

/// A field whose values are 0 to `last`.
struct FieldRange {
  const char* name;
  uint32_t value, last;
};

/// MIEN_ERROR_INVALID_ARGUMENT for the first field that is out of its range.
MienStatus check_fields(std::initializer_list<FieldRange> fields, MienError* error);

}  // namespace mien::capi
