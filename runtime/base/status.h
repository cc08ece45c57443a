// SPDX-License-Identifier: MIT
// Status codes and the detail of one error. The numbers are those of MienStatus in capi/include/mien.h,
// which asserts that they agree; a number is never given a second meaning.
#pragma once

#include <cstddef>
#include <cstdint>

/// Lets the compiler check arguments against a format, as of printf; `first` is 0 for a va_list.
#if defined(__GNUC__)
#if defined( \
    __MINGW32__)  // whose C++ programs print by the rules of C99, not by those of the system
#define MIEN_PRINTF(format_number, first) __attribute__((format(gnu_printf, format_number, first)))
#else
#define MIEN_PRINTF(format_number, first) __attribute__((format(printf, format_number, first)))
#endif
#else
#define MIEN_PRINTF(format_number, first)
#endif

namespace mien {

enum class Status : int32_t {
  kOk = 0,
  // arguments
  kNullArgument = 1,
  kInvalidArgument = 2,
  kStructSize = 3,
  kHandle = 4,
  kMismatch = 5,
  kIndex = 6,
  kLod = 7,
  kName = 8,
  kIsa = 9,
  // memory
  kMemory = 10,
  // the build
  kUnsupported = 11,
  // files
  kFileOpen = 20,
  kFileRead = 21,
  kFileWrite = 22,
  // DNA
  kDnaSignature = 30,
  kDnaVersion = 31,
  kDnaTruncated = 32,
  kDnaStructure = 33,
  kDnaReference = 34,
  kDnaLimit = 35,
  kDnaLayer = 36,
  kDnaValue = 37,
  // baked files
  kBakedSignature = 50,
  kBakedVersion = 51,
  kBakedTruncated = 52,
  kBakedStructure = 53,
  kBakedChecksum = 54,
  kBakedPart = 55,
  // clips
  kClipSignature = 60,
  kClipVersion = 61,
  kClipTruncated = 62,
  kClipStructure = 63,
  kClipChecksum = 64,
  kClipValue = 65,
  kClipLimit = 66,
  // mixes
  kMixSignature = 70,
  kMixVersion = 71,
  kMixTruncated = 72,
  kMixStructure = 73,
  kMixChecksum = 74,
  // authoring
  kAuthorMesh = 80,
  kAuthorRefused = 81,
  kAuthorCanceled = 82,
};

/// Name of a status as in mien.h, without its prefix ("DNA_TRUNCATED"). Static storage; "UNKNOWN" for a
/// number that is not a status.
const char* status_name(Status status);

constexpr uint64_t kNoOffset = ~uint64_t{0};

/// What went wrong, and where in the file if that applies.
struct Error {
  Status status = Status::kOk;
  uint64_t byte_offset = kNoOffset;
  char message[236] = {};
};

/// Writes the error and returns its status, so that a check reads `return fail(error, ...)`.
/// A message that does not fit is cut at the end of the array. It may quote names and letters out of
/// files: it is made printable.
MIEN_PRINTF(4, 5)
Status fail(Error& error, Status status, uint64_t byte_offset, const char* format, ...);

/// Replaces, in place, each control character and each byte that is not part of valid UTF-8 by '?': a
/// message must not move the cursor of a terminal, whatever the file says.
void make_printable(char* text);

}  // namespace mien
