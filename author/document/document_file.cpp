// SPDX-License-Identifier: MIT
#include "author/document/document_file.h"

#include <algorithm>

#include "author/base/dna_making.h"
#include "author/document/check_view.h"
#include "runtime/load/dna/check/check_written.h"
#include "runtime/load/dna/format/pose_controls.h"

namespace mien::author {
namespace {

bool lists(const dna::DnaView& view, const dna::LayerKind& kind) {
  for (const dna::IndexEntry& entry : view.index) {
    if (entry.code == kind.code && entry.layer_version == kind.layer_version) return true;
  }
  return false;
}

/// The index of the file: also the layers that the list of the document lacks. Version 2.1 has four layers in
/// one order.
bool complete_index(dna::DnaView& view, Arena& arena) {
  const dna::WriteOptions options{view.version, true};
  dna::List<dna::IndexEntry> index;
  if (!make(arena, view.index.count + dna::kLayerIdCount, index)) return false;
  uint32_t count = 0;
  if (view.version == 1) view.index = {};
  for (const dna::IndexEntry& entry : view.index) index[count++] = entry;
  for (const dna::LayerKind& kind : dna::kLayerKinds) {
    if (lists(view, kind) || !dna::is_written(view, kind, options)) continue;
    index[count].code = kind.code;
    index[count++].layer_version = kind.layer_version;
  }
  index.count = count;
  view.index = index;
  return true;
}

}  // namespace

Status view_of_file(const Document& document, Arena& arena, dna::DnaView& out, Error& error) {
  out = document.view();
  const bool all = !dna::leave_out_layers(out, {out.version, true});
  if (!complete_index(out, arena) || !dna::synthesize_pose_controls(out, arena)) {
    return no_memory(error, "the layers of a file");
  }
  if (all && document.checked()) return Status::kOk;
  return check_view(out, error);
}

bool FilePieces::begin(Arena& arena) {
  const size_t most = static_cast<size_t>(std::min<uint64_t>(size_, kPieceBytes));
  buffer_ = arena.unwritten_array<uint8_t>(most);
  return buffer_.count == most;
}

Span<const uint8_t> FilePieces::next() {
  const size_t count = static_cast<size_t>(std::min<uint64_t>(size_ - at_, buffer_.count));
  if (count != 0) dna::encode_range(view_, options_, at_, count, buffer_.data);
  at_ += count;
  return {buffer_.data, count};
}

Status plan_file(const Document& document, const dna::WriteOptions& options, Arena& arena,
                 dna::DnaView& out, uint64_t& out_size, Error& error) {
  out_size = 0;
  if (Status s = view_of_file(document, arena, out, error); s != Status::kOk) return s;
  if (Status s = dna::check_written(out, options, arena, error); s != Status::kOk) return s;
  out_size = dna::encoded_size(out, options);
  return Status::kOk;
}

}  // namespace mien::author
