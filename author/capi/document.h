// SPDX-License-Identifier: MIT
// The handle of a document, for the files of its chapter.
#pragma once

#include "author/document/document.h"
#include "capi/arguments/fields.h"
#include "capi/include/mien_author.h"
#include "runtime/base/object.h"

struct MienDocument : mien::Object {
  static constexpr uint32_t kTag = 0x6D44'4F43;

  mien::author::Document document;

  explicit MienDocument(const mien::Allocator& of) : document(of) {}
};

namespace mien::capi {

/// MIEN_ERROR_STRUCT_SIZE for a wrong error, too.
inline MienStatus check_document(const MienDocument* document, MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  const MienStatus status = check_tag(document, MienDocument::kTag);
  if (status == MIEN_OK) return status;
  return give_error(
      error, status,
      document ? "document is a handle of another kind, or none" : "document is NULL");
}

/// Ends a call with the status of its work.
inline MienStatus finish(Status status, const Error& detail, MienError* error) {
  return status == Status::kOk ? succeed(error) : give_error(detail, error);
}

}  // namespace mien::capi
