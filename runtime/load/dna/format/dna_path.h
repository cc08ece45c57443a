// SPDX-License-Identifier: MIT
// Fields by name: "bhvr.joints.jointGroups[7].values". Grammar: layer, then .field or [index].
#pragma once

#include "runtime/base/status.h"
#include "runtime/load/dna/format/dna_view.h"

namespace mien::dna {

/// Numbers of MIEN_FIELD_... in mien.h.
enum class FieldType : uint32_t { kRecord, kList, kString, kU8, kU16, kU32, kI32, kF32 };

struct FieldRef {
  FieldType type = FieldType::kRecord;
  uint64_t count = 0;  // elements, bytes of a string, fields of a record
  const uint8_t* bytes =
      nullptr;             // of a string or of big-endian numbers; null for records and lists
  uint8_t number[4] = {};  // a single number, big-endian; `bytes` is then null
  bool is_array = false;   // of numbers, though it may hold one or none
};

/// kName if there is no such field, kIndex if an index is past the end.
Status find_field(const DnaView& view, const char* path, FieldRef& out, Error& error);

/// Name of field `index` of the record at `path`; of layer `index` for "". Static, terminated.
Status find_field_name(const DnaView& view, const char* path, uint32_t index, const char*& out,
                       Error& error);

}  // namespace mien::dna
