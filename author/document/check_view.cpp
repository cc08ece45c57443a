// SPDX-License-Identifier: MIT
#include "author/document/check_view.h"

#include "runtime/load/dna/check/dna_check.h"

namespace mien::author {
namespace {

bool keep_first(void* user, const dna::Finding& finding) {
  if (finding.status == Status::kOk) return true;
  Error& error = *static_cast<Error*>(user);
  fail(error, finding.status, kNoOffset, "%s: %s; an operation needs a valid document",
       finding.field, finding.message);
  return false;
}

}  // namespace

Status check_view(const dna::DnaView& view, Error& error) {
  Error found;
  const dna::FindingSink sink{&found, keep_first, false};
  if (dna::check_definition(view, sink)) dna::check_layers(view, sink);
  if (found.status != Status::kOk) error = found;
  return found.status;
}

Status check_document(const Document& document, Error& error) {
  return document.checked() ? Status::kOk : check_view(document.view(), error);
}

Status check_document(Document& document, Error& error) {
  const Status status = check_document(static_cast<const Document&>(document), error);
  if (status == Status::kOk) document.set_checked();
  return status;
}

Status check_indices(Span<const uint32_t> indices, uint32_t count, const char* what, Error& error) {
  for (uint32_t index : indices) {
    if (index < count) continue;
    return fail(error, Status::kIndex, kNoOffset, "there is no %s %u: the document has %u", what,
                index, count);
  }
  return Status::kOk;
}

}  // namespace mien::author
