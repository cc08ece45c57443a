// SPDX-License-Identifier: MIT
#include "integrations/program/io/failure.h"

namespace mien::cli {

void fail(ExitCode code, const std::string& what, const std::string& where, const std::string& why,
          const std::string& what_to_do) {
  std::string line = what;
  if (!where.empty()) line += ", " + where;
  line += ": " + why;
  if (!what_to_do.empty()) line += "; " + what_to_do;
  throw Failure(code, line);
}

void fail_usage(const std::string& option, const std::string& why, const std::string& what_to_do) {
  fail(kUsage, option, "", why, what_to_do);
}

ExitCode exit_code_of(MienStatus status) {
  switch (status) {
    case MIEN_OK: return kDone;

    // Only an option asks for an instruction set; only a command for what this build lacks.
    case MIEN_ERROR_ISA:
    case MIEN_ERROR_UNSUPPORTED: return kUsage;

    case MIEN_ERROR_INDEX:
    case MIEN_ERROR_LOD:
    case MIEN_ERROR_NAME:
    case MIEN_ERROR_DNA_SIGNATURE:
    case MIEN_ERROR_DNA_VERSION:
    case MIEN_ERROR_DNA_TRUNCATED:
    case MIEN_ERROR_DNA_STRUCTURE:
    case MIEN_ERROR_DNA_REFERENCE:
    case MIEN_ERROR_DNA_LIMIT:
    case MIEN_ERROR_DNA_LAYER:
    case MIEN_ERROR_DNA_VALUE:
    case MIEN_ERROR_BAKED_SIGNATURE:
    case MIEN_ERROR_BAKED_VERSION:
    case MIEN_ERROR_BAKED_TRUNCATED:
    case MIEN_ERROR_BAKED_STRUCTURE:
    case MIEN_ERROR_BAKED_CHECKSUM:
    case MIEN_ERROR_CLIP_SIGNATURE:
    case MIEN_ERROR_CLIP_VERSION:
    case MIEN_ERROR_CLIP_TRUNCATED:
    case MIEN_ERROR_CLIP_STRUCTURE:
    case MIEN_ERROR_CLIP_CHECKSUM:
    case MIEN_ERROR_CLIP_VALUE:
    case MIEN_ERROR_CLIP_LIMIT:
    case MIEN_ERROR_AUTHOR_MESH:
    case MIEN_ERROR_AUTHOR_REFUSED: return kInvalid;

    case MIEN_ERROR_FILE_OPEN:
    case MIEN_ERROR_FILE_READ:
    case MIEN_ERROR_FILE_WRITE: return kFile;

    // NULL_ARGUMENT, INVALID_ARGUMENT, STRUCT_SIZE, HANDLE, MISMATCH: a bug in this program.
    default: return kInternal;
  }
}

namespace {

std::string what_to_do_about(MienStatus status, const std::string& file,
                             const std::string& about_values) {
  switch (exit_code_of(status)) {
    case kUsage: return "";  // an instruction set from the environment: the message says it all
    case kFile: return "check the path and its permissions";
    case kInternal:
      return status == MIEN_ERROR_MEMORY ? "free some memory"
                                         : "this is a bug in mien: please report it";
    default: break;
  }
  switch (status) {
    case MIEN_ERROR_DNA_SIGNATURE: return "give a DNA file";
    case MIEN_ERROR_DNA_VERSION: return "export the rig as DNA 2.1 to 2.8";
    case MIEN_ERROR_DNA_TRUNCATED: return "download or export the file again";
    case MIEN_ERROR_DNA_LAYER: return "see 'mien info' for the layers that the file has";
    case MIEN_ERROR_BAKED_SIGNATURE:
    case MIEN_ERROR_BAKED_VERSION:
    case MIEN_ERROR_BAKED_TRUNCATED:
    case MIEN_ERROR_BAKED_STRUCTURE:
    case MIEN_ERROR_BAKED_CHECKSUM: return "";  // the message says to bake again
    case MIEN_ERROR_CLIP_SIGNATURE: return "give a clip, as 'mien clip build' writes them";
    case MIEN_ERROR_CLIP_VERSION:
    case MIEN_ERROR_CLIP_TRUNCATED:
    case MIEN_ERROR_CLIP_STRUCTURE:
    case MIEN_ERROR_CLIP_CHECKSUM:
    case MIEN_ERROR_CLIP_VALUE:
    case MIEN_ERROR_CLIP_LIMIT: return about_values;
    case MIEN_ERROR_AUTHOR_MESH: return "export the mesh again";
    case MIEN_ERROR_AUTHOR_REFUSED: return "see docs/authoring.md";
    case MIEN_ERROR_LOD: return "see 'mien info' for the LODs that the file has";
    case MIEN_ERROR_DNA_VALUE:
    case MIEN_ERROR_DNA_LIMIT:
      if (!about_values.empty()) return about_values;
      [[fallthrough]];
    default: return "see 'mien validate " + file + "' for everything that is wrong";
  }
}

}  // namespace

void check(MienStatus status, const MienError* error, const std::string& what,
           const std::string& file, const std::string& what_to_do) {
  if (status == MIEN_OK) return;
  std::string where = file;
  std::string why = std::string("status ") + mien_status_name(status);
  if (error && error->message[0] != '\0') {
    why = error->message;
    // Messages about files begin with the path (possibly cut), which `where` already has.
    const std::string path = file.substr(0, 100) + ": ";
    if (why.compare(0, path.size(), path) == 0) why.erase(0, path.size());
    if (error->byte_offset != MIEN_NO_OFFSET) {
      where += ", byte " + std::to_string(error->byte_offset);
    }
  }
  fail(exit_code_of(status), what, where, why, what_to_do_about(status, file, what_to_do));
}

}  // namespace mien::cli
