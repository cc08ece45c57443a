// SPDX-License-Identifier: MIT
// For a build without libmien-author: `mien gen`, `mien demo-head` and `mien author` say so.
#include <mien_author.h>

#include <cstring>

namespace {

MienStatus fail_unsupported(MienError* error, const char* message) {
  error->status = MIEN_ERROR_UNSUPPORTED;
  error->byte_offset = MIEN_NO_OFFSET;
  std::strncpy(error->message, message, sizeof(error->message) - 1);
  return MIEN_ERROR_UNSUPPORTED;
}

}  // namespace

MienStatus mien_dna_generate(const MienGenerateDesc*, MienDna** out_dna, MienError* error) {
  *out_dna = nullptr;
  return fail_unsupported(
      error, "this build of mien has no generator (MIEN_BUILD_COMPILER=OFF): use a full build");
}

MienStatus mien_author_rig(const MienAuthorMesh*, const MienAuthorDesc*, MienDna** out_dna,
                           MienAuthorReport** out_report, MienError* error) {
  *out_dna = nullptr;
  *out_report = nullptr;
  return fail_unsupported(
      error, "this build of mien makes no rigs (MIEN_BUILD_COMPILER=OFF): use a full build");
}

MienStatus mien_author_report_json(const MienAuthorReport*, MienStringView* out_json) {
  *out_json = {};
  return MIEN_ERROR_UNSUPPORTED;
}

void mien_author_report_close(MienAuthorReport*) {}
