// SPDX-License-Identifier: MIT
#include "author/document/lods.h"

#include "author/document/check_view.h"
#include "author/document/renumber.h"
#include "runtime/load/dna/convert/convert_coordinates.h"
#include "runtime/load/dna/convert/lod_selection.h"

namespace mien::author {
namespace {

/// The checks, and a view whose lists may change in place.
Status begin(Document& document, Edit& edit, Error& error) {
  if (Status s = check_document(document, error); s != Status::kOk) return s;
  if (!edit.begin(error)) return error.status;
  return copy_all_lists(edit.arena(), edit.view) ? Status::kOk : no_memory(error, "an edit");
}

}  // namespace

Status keep_lods(Document& document, uint64_t lods, Error& error) {
  const uint32_t count = document.view().desc.lod_count;
  const uint64_t existing = count >= 64 ? ~uint64_t{0} : (uint64_t{1} << count) - 1;
  if ((lods & existing) == 0) {
    return fail(error, Status::kLod, kNoOffset,
                "none of the chosen LODs exists: the document has %u, numbered from 0", count);
  }
  if ((lods & existing) == existing) return Status::kOk;
  Edit edit(document);
  if (Status s = begin(document, edit, error); s != Status::kOk) return s;
  if (!dna::select_lods(edit.view, lods & existing, edit.arena()))
    return no_memory(error, "an edit");
  edit.commit();
  return Status::kOk;
}

Status convert_document(Document& document, const CoordinateSystem& system, Error& error) {
  Edit edit(document);
  if (Status s = begin(document, edit, error); s != Status::kOk) return s;
  if (Status s = dna::convert_coordinates(edit.view, system, edit.arena(), error); s != Status::kOk)
    return s;
  edit.commit();
  return Status::kOk;
}

}  // namespace mien::author
