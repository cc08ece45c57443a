// SPDX-License-Identifier: MIT
// Writes fields, with the paths of find_field().
#pragma once

#include "author/document/document.h"

namespace mien::author {

// All fail with kName or kIndex if there is no such field, kInvalidArgument if it does not hold what is
// written, kMemory; the document is then as it was.

/// Elements `first` ... `first` + `count` of an array, or a single number.
Status write_floats(Document& document, const char* path, uint64_t first, uint64_t count,
                    const float* values, Error& error);
/// The same with integers, each in the range of the field's type.
Status write_integers(Document& document, const char* path, uint64_t first, uint64_t count,
                      const int64_t* values, Error& error);

/// kInvalidArgument also for a name that another element of its list has.
Status write_string(Document& document, const char* path, const char* bytes, size_t count,
                    Error& error);

/// Replaces `removed` elements of an array or list, from `first` on, by `inserted` new ones: zeros, empty
/// strings, records of these.
Status splice(Document& document, const char* path, uint64_t first, uint64_t removed,
              uint64_t inserted, Error& error);

/// The same at the end, so that `count` elements are left.
Status resize(Document& document, const char* path, uint64_t count, Error& error);

}  // namespace mien::author
