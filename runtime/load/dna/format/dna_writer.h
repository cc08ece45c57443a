// SPDX-License-Identifier: MIT
// View -> canonical file bytes (docs/dna-format.md, 14 "Writing a canonical file"), through the
// same field descriptions that the reader walks.
#pragma once

#include "runtime/load/dna/format/dna_view.h"

namespace mien::dna {

struct WriteOptions {
  uint16_t version = 8;      // 2.version
  bool keep_unknown = true;  // also layers that the version does not know yet
};

/// True if the file will have the layer.
bool is_written(const DnaView& view, const LayerKind& kind, const WriteOptions& options);

/// Bytes of the file. The format numbers them with 32 bits: a caller refuses more.
uint64_t encoded_size(const DnaView& view, const WriteOptions& options);

/// Writes exactly encoded_size() bytes.
void encode(const DnaView& view, const WriteOptions& options, uint8_t* out);

/// Writes only the bytes `first` ... `first` + `count` of the file. Walks all lists.
void encode_range(const DnaView& view, const WriteOptions& options, uint64_t first, size_t count,
                  uint8_t* out);

}  // namespace mien::dna
