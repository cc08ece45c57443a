// SPDX-License-Identifier: MIT
// Removing GUI, raw and PSD controls.
#pragma once

#include "author/document/elements.h"

namespace mien::author {

/// What happens as if a raw or PSD control stayed 0: see mien_document_remove(). Expects a valid document and
/// indices that exist.
Status remove_controls(Document& document, Kind kind, Span<const uint32_t> indices, Error& error);

}  // namespace mien::author
