// SPDX-License-Identifier: MIT
#include "runtime/base/status.h"

#include <cstdarg>
#include <cstdio>

namespace mien {

const char* status_name(Status status) {
  switch (status) {
    case Status::kOk: return "OK";
    case Status::kNullArgument: return "NULL_ARGUMENT";
    case Status::kInvalidArgument: return "INVALID_ARGUMENT";
    case Status::kStructSize: return "STRUCT_SIZE";
    case Status::kHandle: return "HANDLE";
    case Status::kMismatch: return "MISMATCH";
    case Status::kIndex: return "INDEX";
    case Status::kLod: return "LOD";
    case Status::kName: return "NAME";
    case Status::kIsa: return "ISA";
    case Status::kMemory: return "MEMORY";
    case Status::kFileOpen: return "FILE_OPEN";
    case Status::kFileRead: return "FILE_READ";
    case Status::kFileWrite: return "FILE_WRITE";
    case Status::kDnaSignature: return "DNA_SIGNATURE";
    case Status::kDnaVersion: return "DNA_VERSION";
    case Status::kDnaTruncated: return "DNA_TRUNCATED";
    case Status::kDnaStructure: return "DNA_STRUCTURE";
    case Status::kDnaReference: return "DNA_REFERENCE";
    case Status::kDnaLimit: return "DNA_LIMIT";
    case Status::kDnaLayer: return "DNA_LAYER";
    case Status::kDnaValue: return "DNA_VALUE";
    case Status::kBakedSignature: return "BAKED_SIGNATURE";
    case Status::kBakedVersion: return "BAKED_VERSION";
    case Status::kBakedTruncated: return "BAKED_TRUNCATED";
    case Status::kBakedStructure: return "BAKED_STRUCTURE";
    case Status::kBakedChecksum: return "BAKED_CHECKSUM";
    case Status::kBakedPart: return "BAKED_PART";
    case Status::kClipSignature: return "CLIP_SIGNATURE";
    case Status::kClipVersion: return "CLIP_VERSION";
    case Status::kClipTruncated: return "CLIP_TRUNCATED";
    case Status::kClipStructure: return "CLIP_STRUCTURE";
    case Status::kClipChecksum: return "CLIP_CHECKSUM";
    case Status::kClipValue: return "CLIP_VALUE";
    case Status::kClipLimit: return "CLIP_LIMIT";
  }
  return "UNKNOWN";
}

Status fail(Error& error, Status status, uint64_t byte_offset, const char* format, ...) {
  error.status = status;
  error.byte_offset = byte_offset;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(error.message, sizeof(error.message), format, arguments);
  va_end(arguments);
  return status;
}

}  // namespace mien
