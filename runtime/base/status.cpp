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
    case Status::kUnsupported: return "UNSUPPORTED";
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
    case Status::kMixSignature: return "MIX_SIGNATURE";
    case Status::kMixVersion: return "MIX_VERSION";
    case Status::kMixTruncated: return "MIX_TRUNCATED";
    case Status::kMixStructure: return "MIX_STRUCTURE";
    case Status::kMixChecksum: return "MIX_CHECKSUM";
    case Status::kAuthorMesh: return "AUTHOR_MESH";
    case Status::kAuthorRefused: return "AUTHOR_REFUSED";
    case Status::kAuthorCanceled: return "AUTHOR_CANCELED";
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
  make_printable(error.message);
  return status;
}

void make_printable(char* text) {
  uint8_t* at = reinterpret_cast<uint8_t*>(text);
  while (*at) {
    // How many bytes follow, and the smallest code point that needs that many.
    const uint32_t lead = *at;
    const int more = lead < 0x80       ? 0
                     : lead >> 5 == 6  ? 1
                     : lead >> 4 == 14 ? 2
                     : lead >> 3 == 30 ? 3
                                       : -1;
    constexpr uint32_t kSmallest[4] = {0x20, 0xA0, 0x800, 0x10000};
    uint32_t code = more < 0 ? 0 : more == 0 ? lead : lead & (0x3Fu >> more);
    int read = 0;
    for (; read < more && at[read + 1] >> 6 == 2; ++read) code = code << 6 | (at[read + 1] & 0x3F);
    const bool good = more >= 0 && read == more && code >= kSmallest[more] && code != 0x7F &&
                      code <= 0x10FFFF && code >> 11 != 27;
    if (!good) *at = '?';
    at += good ? more + 1 : 1;
  }
}

}  // namespace mien
