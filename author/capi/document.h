// SPDX-License-Identifier: MIT
// The handle of a document, for the files of its chapter.
#pragma once

#include "author/document/document.h"
#include "capi/arguments/fields.h"
#include "capi/include/mien_author.h"

struct MienDocument {
  uint32_t tag;
  mien::author::Document document;
};

namespace mien::capi {

constexpr uint32_t kDocumentTag = 0x6D44'4F43;

/// MIEN_ERROR_STRUCT_SIZE for a wrong error, too.
inline MienStatus check_document(const MienDocument* document, MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (!document) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "document is NULL");
  uint32_t tag = 0;
  if (reinterpret_cast<uintptr_t>(document) % alignof(uint32_t) == 0)
    memcpy(&tag, document, sizeof(tag));
  if (tag == kDocumentTag) return MIEN_OK;
  return give_error(error, MIEN_ERROR_HANDLE, "document is a handle of another kind, or none");
}

/// Ends a call with the status of its work.
inline MienStatus finish(Status status, const Error& detail, MienError* error) {
  return status == Status::kOk ? succeed(error) : give_error(detail, error);
}

}  // namespace mien::capi
