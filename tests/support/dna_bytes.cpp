// SPDX-License-Identifier: MIT
#include "tests/support/dna_bytes.h"

#include <gtest/gtest.h>

#include <cstring>

#include "runtime/load/dna/format/dna_writer.h"

namespace mien::dna {
namespace {

uint32_t usual_version(const std::string& code) {
  return code == "desc" || code == "defn" || code == "bhvr" || code == "geom" ? 0x10001 : 0x10000;
}

}  // namespace

void put16(Bytes& bytes, uint16_t number) {
  bytes.push_back(static_cast<uint8_t>(number >> 8));
  bytes.push_back(static_cast<uint8_t>(number));
}

void put32(Bytes& bytes, uint32_t number) {
  put16(bytes, static_cast<uint16_t>(number >> 16));
  put16(bytes, static_cast<uint16_t>(number));
}

uint32_t number32(const Bytes& bytes, size_t at) {
  return uint32_t{bytes.at(at)} << 24 | uint32_t{bytes.at(at + 1)} << 16 |
         uint32_t{bytes.at(at + 2)} << 8 | bytes.at(at + 3);
}

void set32(Bytes& bytes, size_t at, uint32_t number) {
  for (size_t i = 0; i < 4; ++i) bytes.at(at + i) = static_cast<uint8_t>(number >> (24 - 8 * i));
}

Layer layer(const std::string& name, Bytes bytes) {
  Layer made = {name.substr(0, 4), 0, std::move(bytes)};
  unsigned major = 0, minor = 0;
  if (sscanf(name.c_str() + 4, "%u.%u", &major, &minor) == 2) {
    made.layer_version = major << 16 | minor;
  } else {
    made.layer_version = usual_version(made.code);
  }
  return made;
}

Bytes file_of(uint16_t version, const std::vector<Layer>& layers) {
  Bytes file = {'D', 'N', 'A', 0, 2};
  put16(file, version);
  put32(file, static_cast<uint32_t>(layers.size()));
  uint32_t offset = static_cast<uint32_t>(11 + 16 * layers.size());
  for (const Layer& layer : layers) {
    file.insert(file.end(), layer.code.begin(), layer.code.end());
    put32(file, layer.layer_version);
    put32(file, offset);
    put32(file, static_cast<uint32_t>(layer.bytes.size()));
    offset += static_cast<uint32_t>(layer.bytes.size());
  }
  for (const Layer& layer : layers) {
    file.insert(file.end(), layer.bytes.begin(), layer.bytes.end());
  }
  return file;
}

std::vector<Layer> layers_of(const Bytes& file) {
  std::vector<Layer> layers;
  const uint32_t count = number32(file, 7);
  size_t end = 11 + size_t{16} * count;
  for (uint32_t i = 0; i < count; ++i) {
    const size_t entry = 11 + size_t{16} * i;
    const size_t offset = number32(file, entry + 8), size = number32(file, entry + 12);
    EXPECT_EQ(offset, end) << "layer " << i;
    end = offset + size;
    if (end > file.size()) {
      ADD_FAILURE() << "layer " << i << " ends at " << end << " of " << file.size();
      break;
    }
    layers.push_back({std::string(file.begin() + static_cast<ptrdiff_t>(entry),
                                  file.begin() + static_cast<ptrdiff_t>(entry + 4)),
                      number32(file, entry + 4),
                      Bytes(file.begin() + static_cast<ptrdiff_t>(offset),
                            file.begin() + static_cast<ptrdiff_t>(end))});
  }
  EXPECT_EQ(end, file.size());
  return layers;
}

std::string layer_names(const Bytes& file) {
  std::string names;
  for (const Layer& layer : layers_of(file)) {
    if (!names.empty()) names += ' ';
    names += layer.code;
    if (layer.layer_version == usual_version(layer.code)) continue;
    names += ' ' + std::to_string(layer.layer_version >> 16) + '.' +
             std::to_string(layer.layer_version & 0xFFFF);
  }
  return names;
}

Bytes written(const DnaView& view, uint16_t version, bool keep_unknown) {
  const WriteOptions options = {version, keep_unknown};
  Bytes bytes(encoded_size(view, options));
  encode(view, options, bytes.data());
  return bytes;
}

}  // namespace mien::dna
