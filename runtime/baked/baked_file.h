// SPDX-License-Identifier: MIT
// The baked file: compiled objects in their memory layout, used in place.
//
//     | header, 64 bytes | table of parts, 64 bytes each | part | part | ...
//
//     part:  | numbers, 8 bytes each | arrays: offset, count, element size | array | array | ...
//
// Parts begin at multiples of 64, in the order of the table, and so do their arrays; the gaps are zero. So
// equal objects have equal bytes, and the offsets of an object, which count from the beginning of its part,
// do not depend on what else the file contains. A reader skips parts of unknown kinds. Nothing in a file
// depends on the instruction set, on the size of a pointer, or on its address. Numbers are in the byte
// order of the machine that wrote them; a file of the other order is refused.
#pragma once

#include "runtime/base/arena.h"
#include "runtime/base/shared_bytes.h"
#include "runtime/base/status.h"

namespace mien {

constexpr uint32_t kBakedVersion = 3;  // of the header and the table; each part has its own
constexpr uint32_t kBakedByteOrder = 0x0102'0304;
constexpr char kBakedMagic[8] = {'M', 'I', 'E', 'N', 'B', 'A', 'K', 'E'};

enum class PartKind : uint32_t { kRig = 1, kDeformer = 2 };

struct BakedHeader {
  char magic[8];
  uint32_t byte_order;
  uint32_t version;
  uint64_t file_size;
  uint64_t checksum;  // of all that follows this field
  uint32_t part_count;
  uint8_t zeros[28];
};
static_assert(sizeof(BakedHeader) == kBlockAlignment, "no padding");

struct BakedPart {
  uint32_t kind;
  uint32_t version;
  uint64_t offset;  // from the beginning of the file
  uint64_t size;    // a multiple of 64
  uint32_t number_count;
  uint32_t array_count;
  uint8_t zeros[32];
};
static_assert(sizeof(BakedPart) == kBlockAlignment, "no padding");

struct BakedArray {
  uint64_t offset;  // from the beginning of the part
  uint64_t count;
  uint32_t element_size;
  uint32_t zero;
};
static_assert(sizeof(BakedArray) == 24, "no padding");

/// Of bytes that are aligned to kBlockAlignment.
inline const BakedHeader* header_of(const uint8_t* bytes) {
  return static_cast<const BakedHeader*>(static_cast<const void*>(bytes));
}

enum class BakedCheck : uint32_t {
  kSafe = 0,  // whatever the bytes are, evaluation and deformation stay within the arrays
  kFull = 1,  // also compare the checksums
};

/// A file whose header and table are in order. Parts are checked when objects are made from them.
struct Baked : SharedBytes {
  static constexpr uint32_t kTag = 0x6D42'414B;

  BakedCheck check = BakedCheck::kSafe;
  const BakedPart* rig = nullptr;       // in the file; null if it has none
  const BakedPart* deformer = nullptr;  // the same
};

/// The checksum that belongs in the header.
uint64_t baked_checksum(const uint8_t* bytes, size_t size);

// Opening checks the header, the table and, for kFull, the checksum, and finds the parts. On success, give
// back `out` with release(). kBakedSignature, kBakedVersion, kBakedTruncated, kBakedStructure,
// kBakedChecksum, kMemory.

/// Errors of open_file(), too.
Status open_baked_file(const char* path, FileAccess access, BakedCheck check,
                       const Allocator& allocator, Baked*& out, Error& error);
/// The bytes are used in place and must outlive everything made from them, unless `access` is kRead or they
/// are not at a multiple of 64: then they are copied.
Status open_baked_memory(Span<const uint8_t> bytes, FileAccess access, BakedCheck check,
                         const Allocator& allocator, Baked*& out, Error& error);
/// kFileRead, too.
Status open_baked_stream(const Stream& stream, BakedCheck check, const Allocator& allocator,
                         Baked*& out, Error& error);

}  // namespace mien
