// SPDX-License-Identifier: MIT
// The file that a document becomes.
#pragma once

#include "author/document/document.h"
#include "runtime/load/dna/format/dna_writer.h"

namespace mien::author {

/// The view that reading the file of `document` would give, with all layers of its version, once it has passed
/// the checks of opening a file. It points to the document and to `arena`. kDnaStructure, kDnaReference, ... with
/// the first field that is not valid, kDnaLimit for a file of 4 GiB, kMemory.
Status view_of_file(const Document& document, Arena& arena, dna::DnaView& out, Error& error);

/// The same for a file that is written with `options`.
Status plan_file(const Document& document, const dna::WriteOptions& options, Arena& arena,
                 dna::DnaView& out, uint64_t& out_size, Error& error);

/// The bytes of a file, one piece after the other.
class FilePieces {
 public:
  static constexpr size_t kPieceBytes = size_t{8} << 20;

  FilePieces(const dna::DnaView& view, const dna::WriteOptions& options, uint64_t size)
      : view_(view), options_(options), size_(size) {}

  /// False if memory ran out.
  bool begin(Arena& arena);
  /// Valid until the next call; empty at the end.
  Span<const uint8_t> next();

 private:
  const dna::DnaView& view_;
  const dna::WriteOptions options_;
  uint64_t size_, at_ = 0;
  Span<uint8_t> buffer_;
};

}  // namespace mien::author
