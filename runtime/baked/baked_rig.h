// SPDX-License-Identifier: MIT
// A compiled rig as a file that is used where it lies.
//
//     | header, 64 bytes | scalars, 8 bytes each | spans: offset, count, element size | arrays ...
//     |
//
// Arrays stand in the order of the table, each at the next multiple of 64, with zeros in between:
// first all that is checked when the image is opened, then the numbers that only evaluation reads.
// So there is one image for a rig, and opening it touches a run of neighboring pages. Nothing in
// it depends on the instruction set or on where it lies. Numbers are in the byte order of the
// machine that wrote it; one of the other order, or with other sizes, is refused.
#pragma once

#include "runtime/base/arena.h"
#include "runtime/base/status.h"
#include "runtime/rig/rig.h"

namespace mien {

/// To be raised whenever the list of scalars or spans, or the meaning of one, changes.
constexpr uint32_t kBakedVersion = 2;
constexpr uint32_t kImageByteOrder = 0x0102'0304;
constexpr char kImageMagic[8] = {'M', 'I', 'E', 'N', 'R', 'I', 'G', '\n'};

struct ImageHeader {
  char magic[8];
  uint32_t byte_order;
  uint32_t version;
  uint64_t file_size;
  uint64_t checksum;  // of all that follows this field
  uint32_t scalar_count;
  uint32_t span_count;
  uint8_t zeros[24];
};
static_assert(sizeof(ImageHeader) == kBlockAlignment, "no padding");

struct ImageSpan {
  uint64_t offset;  // from the beginning of the file
  uint64_t count;
  uint32_t element_size;
  uint32_t zero;
};

enum class ImageCheck : uint32_t {
  kSafe = 0,  // whatever the bytes are, evaluation stays within the arrays
  kFull = 1,  // and the bytes are those that were written
};

size_t image_size(const Rig& rig);
/// `bytes` has image_size() bytes.
void write_image(const Rig& rig, uint8_t* bytes);

/// The checksum that belongs into the header.
uint64_t image_checksum(const uint8_t* bytes, size_t size);

/// Makes `rig`, which is fresh, a view of an image at a multiple of 64 that outlives it. Kernels
/// and what the rig is owned by are the caller's to set.
Status read_image(const uint8_t* bytes, size_t size, ImageCheck check, Rig& rig, Error& error);

/// Every count and every index in the tables: evaluation, batches, names and statistics stay within
/// the arrays, whatever the floats are. Costs time for the tables only. `full` also proves the
/// order of names and of correctives. kBakedStructure.
Status check_rig(const Rig& rig, bool full, Error& error);

}  // namespace mien
