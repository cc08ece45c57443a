// SPDX-License-Identifier: MIT
// The generator, for a build without libmien-author: `mien gen` and `mien demo-head` say so.
#include <cstring>

#include "capi/mien_author.h"

MienStatus mien_dna_generate(const MienGenerateDesc*, MienDna** out_dna, MienError* error) {
  static const char kMessage[] =
      "this build of mien has no generator (MIEN_BUILD_COMPILER=OFF): use a full build";
  *out_dna = nullptr;
  error->status = MIEN_ERROR_UNSUPPORTED;
  error->byte_offset = MIEN_NO_OFFSET;
  std::memcpy(error->message, kMessage, sizeof(kMessage));
  return MIEN_ERROR_UNSUPPORTED;
}
