// SPDX-License-Identifier: MIT
#include "author/document/document.h"

#include <new>

#include "author/base/dna_making.h"
#include "runtime/base/file_pages.h"
#include "runtime/load/dna/dna_reader.h"

namespace mien::author {

// Memory of edits -----------------------------------------------------------------------------------

/// In front of each block; as long as the largest alignment, which therefore stays.
struct EditMemory::Block {
  Block *newer, *older;
  size_t size;  // without this header
};

namespace {

constexpr size_t kHeader = kBlockAlignment;

}  // namespace

EditMemory::EditMemory(const Allocator& from)
    : arena(tracked()), allocator_(from), blocks_(nullptr) {
  static_assert(sizeof(Block) <= kHeader, "a header fits");
}

Allocator EditMemory::tracked() {
  Allocator tracking;
  tracking.user = this;
  tracking.allocate = allocate;
  tracking.release = release;
  return tracking;
}

void* EditMemory::allocate(void* user, size_t size, size_t) {
  EditMemory& self = *static_cast<EditMemory*>(user);
  if (size > SIZE_MAX - kHeader) return nullptr;
  void* memory = self.allocator_.get(size + kHeader, kBlockAlignment);
  if (!memory) return nullptr;
  Block* block = new (memory) Block{nullptr, self.blocks_, size};
  if (self.blocks_) self.blocks_->newer = block;
  self.blocks_ = block;
  return static_cast<uint8_t*>(memory) + kHeader;
}

void EditMemory::release(void* user, void* block, size_t size, size_t) {
  EditMemory& self = *static_cast<EditMemory*>(user);
  if (!block) return;
  Block* header = reinterpret_cast<Block*>(static_cast<uint8_t*>(block) - kHeader);
  (header->newer ? header->newer->older : self.blocks_) = header->older;
  if (header->older) header->older->newer = header->newer;
  self.allocator_.put(header, size + kHeader, kBlockAlignment);
}

bool EditMemory::holds(const void* address) const {
  const auto at = reinterpret_cast<uintptr_t>(address);
  for (const Block* block = blocks_; block; block = block->older) {
    const uintptr_t first = reinterpret_cast<uintptr_t>(block) + kHeader;
    if (at >= first && at - first < block->size) return true;
  }
  return false;
}

EditMemory* EditMemory::create(const Allocator& allocator) {
  void* memory = allocator.get(sizeof(EditMemory), alignof(EditMemory));
  return memory ? new (memory) EditMemory(allocator) : nullptr;
}

void EditMemory::destroy() {
  const Allocator allocator = allocator_;
  arena.clear();
  this->~EditMemory();
  allocator.put(this, sizeof(EditMemory), alignof(EditMemory));
}

// Documents -----------------------------------------------------------------------------------------

Status no_memory(Error& error, const char* what) {
  return fail(error, Status::kMemory, kNoOffset, "no memory for %s", what);
}

Document::~Document() {
  while (marks_) {
    Mark* older = marks_->older;
    allocator_.put(marks_, sizeof(Mark), alignof(Mark));
    marks_ = older;
  }
  release_edits_after(nullptr);
  if (base_) base_->destroy();
  close_file(file_);
}

void Document::release_edits_after(EditMemory* end) {
  while (edits_ != end) {
    EditMemory* older = edits_->older;
    edits_->destroy();
    edits_ = older;
  }
}

Status Document::create_empty(Error& error) {
  base_ = EditMemory::create(allocator_);
  if (!base_ || !fill_index(8, base_->arena, view_)) return no_memory(error, "a document");
  original_ = view_;
  return Status::kOk;
}

Status Document::open(const MappedFile& file, bool keep_unknown, Error& error) {
  file_ = file;
  base_ = EditMemory::create(allocator_);
  if (!base_) return no_memory(error, "a document");
  dna::ReadOptions options;
  options.keep_unknown = keep_unknown;
  const Status status = dna::read_dna(file.bytes, file.size, options, base_->arena, view_, error);
  if (status != Status::kOk) return status;
  // Offsets in the file mean nothing once it changes.
  view_.file = nullptr;
  view_.segments = nullptr;
  original_ = view_;
  checked_ = original_checked_ = true;
  return Status::kOk;
}

void Document::forget_pages() const { mien::forget_pages(file_); }

Status Document::mark(uint64_t& out, Error& error) {
  void* memory = allocator_.get(sizeof(Mark), alignof(Mark));
  if (!memory) return no_memory(error, "a mark");
  marks_ = new (memory) Mark{view_, edits_, checked_, ++last_mark_, marks_};
  out = last_mark_;
  return Status::kOk;
}

Status Document::undo(uint64_t number, Error& error) {
  const Mark* found = marks_;
  while (found && found->number > number) found = found->older;
  if (number != 0 && (!found || found->number != number)) {
    return fail(error, Status::kIndex, kNoOffset,
                "mark %llu is not one of this document, or undoing to an earlier one removed it",
                static_cast<unsigned long long>(number));
  }
  while (marks_ && marks_->number > number) {
    Mark* older = marks_->older;
    allocator_.put(marks_, sizeof(Mark), alignof(Mark));
    marks_ = older;
  }
  view_ = number == 0 ? original_ : marks_->view;
  checked_ = number == 0 ? original_checked_ : marks_->checked;
  release_edits_after(number == 0 ? nullptr : marks_->edits);
  return Status::kOk;
}

// Edits ---------------------------------------------------------------------------------------------

Edit::~Edit() {
  if (memory_) memory_->destroy();
}

bool Edit::begin(Error& error) {
  view = document_.view_;
  memory_ = EditMemory::create(document_.allocator_);
  if (!memory_) no_memory(error, "an edit");
  return memory_ != nullptr;
}

void Edit::commit(bool keeps_valid) {
  view.ml_control_count = view.mlbh.control_names.count;
  memory_->older = document_.edits_;
  document_.edits_ = memory_;
  document_.view_ = view;
  document_.checked_ = document_.checked_ && keeps_valid;
  memory_ = nullptr;
}

// Layers --------------------------------------------------------------------------------------------

Status clear_layers(Document& document, uint16_t version, Error& error) {
  Edit edit(document);
  if (!edit.begin(error)) return error.status;
  edit.view.version = version;
  edit.view.index = {};
  edit.commit();
  return Status::kOk;
}

Status add_layer(Document& document, uint32_t code, uint32_t layer_version,
                 Span<const uint8_t> bytes, Error& error) {
  const dna::DnaView& view = document.view();
  char name[5] = {};
  store_big_endian(reinterpret_cast<uint8_t*>(name), code);
  const dna::LayerKind* kind = dna::find_layer_kind(code, layer_version);
  if (kind && bytes.count != 0) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "layer %s is of a known kind: its fields are written, not bytes", name);
  }
  if (view.version == 1 && (!kind || kind->since > 1)) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "a file of version 2.1 has the layers desc, defn, bhvr and geom, not %s", name);
  }
  for (const dna::IndexEntry& entry : view.index) {
    if (entry.code == code && entry.layer_version == layer_version) {
      return fail(error, Status::kInvalidArgument, kNoOffset, "layer %s is in the list already",
                  name);
    }
  }
  Edit edit(document);
  if (!edit.begin(error)) return error.status;
  const uint32_t count = view.index.count;
  dna::List<dna::IndexEntry> index;
  uint8_t* copy = nullptr;
  if (bytes.count != 0) copy = static_cast<uint8_t*>(edit.arena().allocate(bytes.count, 1));
  if (!make(edit.arena(), size_t{count} + 1, index) || (bytes.count != 0 && !copy)) {
    return no_memory(error, "a layer");
  }
  if (copy) memcpy(copy, bytes.data, bytes.count);
  for (uint32_t i = 0; i < count; ++i) index[i] = view.index[i];
  index[count].code = code;
  index[count].layer_version = layer_version;
  index[count].data = copy;
  index[count].size = static_cast<uint32_t>(bytes.count);
  edit.view.index = index;
  edit.commit();
  return Status::kOk;
}

}  // namespace mien::author
