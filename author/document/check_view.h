// SPDX-License-Identifier: MIT
// The checks that operations rely on. A document may be in any state while its fields are written, so an
// operation begins with the checks of opening a file, for the layers that it uses.
#pragma once

#include "author/document/document.h"

namespace mien::author {

/// kDnaStructure, kDnaReference, ... with the first field that is not valid.
Status check_view(const dna::DnaView& view, Error& error);

/// The same for a document, unless it is known to be valid.
Status check_document(Document& document, Error& error);
Status check_document(const Document& document, Error& error);

/// kIndex for the first of `indices` that is not below `count`, the number of elements called `what`.
Status check_indices(Span<const uint32_t> indices, uint32_t count, const char* what, Error& error);

}  // namespace mien::author
