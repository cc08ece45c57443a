// SPDX-License-Identifier: MIT
// DNA files as bytes, taken apart and put together without the library's reader and writer, so that
// tests can tell both of them what a file is.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/load/dna/format/dna_view.h"
#include "tests/support/bytes.h"

namespace mien::dna {

inline std::string text(const String& string) { return {string.chars(), string.count}; }

/// A layer of a file from 2.2 on: what its index entry says, and its bytes.
struct Layer {
  std::string code;
  uint32_t layer_version;
  Bytes bytes;
};

/// Appends numbers as a file holds them.
void put16(Bytes& bytes, uint16_t number);
void put32(Bytes& bytes, uint32_t number);

uint32_t number32(const Bytes& bytes, size_t at);
void set32(Bytes& bytes, size_t at, uint32_t number);

/// "bhvr" or "bhvr 1.7"; "" stands for 1.1 of the four classic layers and 1.0 of all others.
Layer layer(const std::string& name, Bytes bytes = {});

/// Header, index, and the layers one behind another.
Bytes file_of(uint16_t version, const std::vector<Layer>& layers);

/// The layers of a file from 2.2 on, by its index. Expects them to lie without gaps.
std::vector<Layer> layers_of(const Bytes& file);

/// "desc defn bhvr 1.7 geom": what `layers_of` gives, for comparing; known versions are left out.
std::string layer_names(const Bytes& file);

/// A view as a file of version 2.`version`, by the library's writer.
Bytes written(const DnaView& view, uint16_t version = 8, bool keep_unknown = true);

}  // namespace mien::dna
