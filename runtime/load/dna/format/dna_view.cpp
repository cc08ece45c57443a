// SPDX-License-Identifier: MIT
#include "runtime/load/dna/format/dna_view.h"

#include "runtime/base/status.h"

namespace mien::dna {

const LayerKind* find_layer_kind(uint32_t code, uint32_t layer_version) {
  for (const LayerKind& kind : kLayerKinds) {
    if (kind.code == code && kind.layer_version == layer_version) return &kind;
  }
  return nullptr;
}

uint32_t close_layer_mask(uint32_t layers) {
  if (layers == 0) return kLayersAll;
  if (layers & kLayerRbf) layers |= kLayerBehavior;
  if (layers & ~uint32_t{kLayerDescriptor}) layers |= kLayerDefinition;
  return layers | kLayerDescriptor;
}

uint64_t DnaView::offset_of(const void* address, const FileSegment* first) const {
  const uintptr_t at = reinterpret_cast<uintptr_t>(address);
  const auto within = [&](const uint8_t* data, size_t size) {
    const uintptr_t begin = reinterpret_cast<uintptr_t>(data);
    return data && at >= begin && at - begin <= size;
  };
  const auto from = [&](const uint8_t* data) { return at - reinterpret_cast<uintptr_t>(data); };
  if (within(file, file_size)) return from(file);
  for (const FileSegment* segment = first; segment; segment = segment->next) {
    if (within(segment->data, segment->size)) return segment->offset + from(segment->data);
  }
  return kNoOffset;
}

}  // namespace mien::dna
