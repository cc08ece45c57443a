// SPDX-License-Identifier: MIT
// Fields by path as callers ask for them, of a MienDna or of what an author changes. Every function expects
// that `error` was checked and the result cleared.
#pragma once

#include "capi/arguments/arguments.h"
#include "runtime/load/dna/format/dna_path.h"

namespace mien::capi {

inline size_t length_of(const char* text) { return text ? strlen(text) : 0; }

/// Paths of fields are shorter: a record is at most five levels down, and an index has ten digits.
constexpr size_t kMaxPath = 255;

/// A null-terminated copy of `path` in `out`.
MienStatus copy_path(const char* path, size_t count, char (&out)[kMaxPath + 1], MienError* error);

/// Begins a call with a MienDnaField: clears it.
MienStatus clear_field(MienDnaField* out_field, MienError* error);

MienStatus describe_field(const dna::DnaView& view, const char* path, size_t path_count,
                          MienDnaField* out_field, MienError* error);
MienStatus name_field(const dna::DnaView& view, const char* path, size_t path_count, uint32_t index,
                      MienStringView* out_name, MienError* error);

/// The data that is read by path. Messages name the functions of its `object`: "mien_dna", "mien_document".
struct FieldSource {
  const dna::DnaView& view;
  const char* object;
};
MienStatus read_field(const FieldSource& source, const char* path, size_t path_count,
                      uint64_t first, uint64_t count, float* out, MienError* error);
MienStatus read_field(const FieldSource& source, const char* path, size_t path_count,
                      uint64_t first, uint64_t count, int64_t* out, MienError* error);
MienStatus read_field(const FieldSource& source, const char* path, size_t path_count,
                      MienStringView* out_string, MienError* error);

/// The bytes of an array or string where they are.
MienStatus field_bytes(const FieldSource& source, const char* path, size_t path_count,
                       MienStringView* out_bytes, MienError* error);

}  // namespace mien::capi
