// SPDX-License-Identifier: MIT
#include <cstddef>

#include "runtime/baked/baked_objects.h"

namespace mien {

size_t baked_size(const Rig& rig, const Deformer* deformer) {
  const size_t parts = deformer ? 2 : 1;
  return sizeof(BakedHeader) + parts * sizeof(BakedPart) + measure_part(rig).size() +
         (deformer ? measure_part(*deformer).size() : 0);
}

void bake(const Rig& rig, const Deformer* deformer, uint8_t* bytes) {
  const size_t size = baked_size(rig, deformer);
  memset(bytes, 0, size);
  BakedHeader header = {};
  memcpy(header.magic, kBakedMagic, sizeof(kBakedMagic));
  header.byte_order = kBakedByteOrder;
  header.version = kBakedVersion;
  header.file_size = size;
  header.part_count = deformer ? 2 : 1;

  uint8_t* entry = bytes + sizeof(header);
  size_t at = sizeof(header) + header.part_count * sizeof(BakedPart);
  const auto add = [&](const auto& object) {
    BakedPart part = write_part(object, bytes + at);
    part.offset = at;
    memcpy(entry, &part, sizeof(part));
    entry += sizeof(part);
    at += part.size;
  };
  add(rig);
  if (deformer) add(*deformer);
  memcpy(bytes, &header, sizeof(header));
  header.checksum = baked_checksum(bytes, size);
  memcpy(bytes, &header, sizeof(header));
}

}  // namespace mien
