// SPDX-License-Identifier: MIT
#include "capi/arguments/fields.h"

#include <algorithm>

namespace mien::capi {

using dna::DnaView;

static_assert(MIEN_FIELD_F32 == int(dna::FieldType::kF32), "dna_path.h and mien.h agree");

MienStatus copy_path(const char* path, size_t count, char (&out)[kMaxPath + 1], MienError* error) {
  if (!path) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "path is NULL");
  if (count > kMaxPath || memchr(path, 0, count)) {
    return give_error(
        error, MIEN_ERROR_NAME,
        "\"%.*s...\" is not a field: its path of %zu bytes is longer than %zu or has a "
        "zero byte",
        static_cast<int>(std::min<size_t>(count, 60)), path, count, kMaxPath);
  }
  memcpy(out, path, count);
  out[count] = 0;
  return MIEN_OK;
}

namespace {

MienStatus find(const DnaView& view, const char* path, size_t count, char (&copy)[kMaxPath + 1],
                dna::FieldRef& field, MienError* error) {
  if (MienStatus status = copy_path(path, count, copy, error)) return status;
  Error detail;
  if (dna::find_field(view, copy, field, detail) != Status::kOk) return give_error(detail, error);
  return MIEN_OK;
}

/// For messages about a field whose type is not the one that the caller expects.
const char* content_of(dna::FieldType type) {
  switch (type) {
    case dna::FieldType::kRecord: return "a record";
    case dna::FieldType::kList: return "a list";
    case dna::FieldType::kString: return "a string";
    case dna::FieldType::kF32: return "floats";
    default: return "integers";
  }
}

MienStatus wrong_type(const FieldSource& source, const char* path, const dna::FieldRef& field,
                      const char* wanted, MienError* error) {
  const char *part = "", *call = "";
  switch (field.type) {
    case dna::FieldType::kRecord: part = "the paths of its fields"; break;
    case dna::FieldType::kList: part = "the paths of its elements"; break;
    case dna::FieldType::kString: call = "_read_string()"; break;
    case dna::FieldType::kF32: call = "_read_floats()"; break;
    default: call = "_read_integers()"; break;
  }
  return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                    "%.120s holds %s, not %s: read it with %s%s%s", path, content_of(field.type),
                    wanted, part, *call ? source.object : "", call);
}

/// Copies big-endian elements of type From into `out`.
template <class From, class To>
void copy_elements(const dna::FieldRef& field, uint64_t first, uint64_t count, To* out) {
  const uint8_t* bytes = field.bytes ? field.bytes : field.number;
  for (uint64_t i = 0; i < count; ++i) {
    out[i] = static_cast<To>(load_big_endian<From>(bytes + (first + i) * sizeof(From)));
  }
}

MienStatus check_range(const dna::FieldRef& field, const char* path, uint64_t first, uint64_t count,
                       const void* out, MienError* error) {
  if (first > field.count || count > field.count - first) {
    return give_error(error, MIEN_ERROR_INDEX, "%.120s has %llu elements, not %llu from %llu on",
                      path, static_cast<unsigned long long>(field.count),
                      static_cast<unsigned long long>(count),
                      static_cast<unsigned long long>(first));
  }
  if (!out && count != 0) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "out is NULL");
  return MIEN_OK;
}

}  // namespace

MienStatus clear_field(MienDnaField* out_field, MienError* error) {
  const MienStatus cleared = clear_struct(out_field);
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (cleared == MIEN_OK) return MIEN_OK;
  return give_error(error, cleared,
                    "out_field is NULL, or its struct_size is not sizeof(MienDnaField)");
}

MienStatus describe_field(const DnaView& view, const char* given, size_t path_count,
                          MienDnaField* out_field, MienError* error) {
  char path[kMaxPath + 1];
  dna::FieldRef field;
  if (MienStatus status = find(view, given, path_count, path, field, error)) return status;
  MienDnaField result = {};
  result.type = static_cast<uint32_t>(field.type);
  result.count = field.count;
  result.is_array = field.is_array;
  result.byte_offset = field.bytes ? view.offset_of(field.bytes) : MIEN_NO_OFFSET;
  write_struct(out_field, result);
  return succeed(error);
}

MienStatus name_field(const DnaView& view, const char* given, size_t path_count, uint32_t index,
                      MienStringView* out_name, MienError* error) {
  char path[kMaxPath + 1];
  if (MienStatus status = copy_path(given, path_count, path, error)) return status;
  const char* name = nullptr;
  Error detail;
  if (dna::find_field_name(view, path, index, name, detail) != Status::kOk) {
    return give_error(detail, error);
  }
  *out_name = {name, strlen(name)};
  return succeed(error);
}

MienStatus read_field(const FieldSource& source, const char* given, size_t path_count,
                      uint64_t first, uint64_t count, float* out, MienError* error) {
  char path[kMaxPath + 1];
  dna::FieldRef field;
  if (MienStatus status = find(source.view, given, path_count, path, field, error)) return status;
  if (field.type != dna::FieldType::kF32) return wrong_type(source, path, field, "floats", error);
  if (MienStatus status = check_range(field, path, first, count, out, error)) return status;
  copy_elements<float>(field, first, count, out);
  return succeed(error);
}

MienStatus read_field(const FieldSource& source, const char* given, size_t path_count,
                      uint64_t first, uint64_t count, int64_t* out, MienError* error) {
  char path[kMaxPath + 1];
  dna::FieldRef field;
  if (MienStatus status = find(source.view, given, path_count, path, field, error)) return status;
  const bool integer = field.type >= dna::FieldType::kU8 && field.type <= dna::FieldType::kI32;
  if (!integer) return wrong_type(source, path, field, "integers", error);
  if (MienStatus status = check_range(field, path, first, count, out, error)) return status;
  switch (field.type) {
    case dna::FieldType::kU8: copy_elements<uint8_t>(field, first, count, out); break;
    case dna::FieldType::kU16: copy_elements<uint16_t>(field, first, count, out); break;
    case dna::FieldType::kU32: copy_elements<uint32_t>(field, first, count, out); break;
    default: copy_elements<int32_t>(field, first, count, out); break;
  }
  return succeed(error);
}

MienStatus read_field(const FieldSource& source, const char* given, size_t path_count,
                      MienStringView* out_string, MienError* error) {
  char path[kMaxPath + 1];
  dna::FieldRef field;
  if (MienStatus status = find(source.view, given, path_count, path, field, error)) return status;
  if (field.type != dna::FieldType::kString)
    return wrong_type(source, path, field, "a string", error);
  *out_string = {reinterpret_cast<const char*>(field.bytes), static_cast<size_t>(field.count)};
  return succeed(error);
}

MienStatus field_bytes(const FieldSource& source, const char* given, size_t path_count,
                       MienStringView* out_bytes, MienError* error) {
  char path[kMaxPath + 1];
  dna::FieldRef field;
  if (MienStatus status = find(source.view, given, path_count, path, field, error)) return status;
  size_t size = 1;
  switch (field.type) {
    case dna::FieldType::kString: break;
    case dna::FieldType::kU8: break;
    case dna::FieldType::kU16: size = 2; break;
    case dna::FieldType::kRecord:
    case dna::FieldType::kList: size = 0; break;
    default: size = 4; break;
  }
  if (size == 0 || (field.type != dna::FieldType::kString && !field.is_array)) {
    return wrong_type(source, path, field, "an array or a string", error);
  }
  *out_bytes = {reinterpret_cast<const char*>(field.bytes), size_t(field.count) * size};
  return succeed(error);
}

}  // namespace mien::capi
