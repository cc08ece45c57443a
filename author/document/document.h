// SPDX-License-Identifier: MIT
// A DNA file that can be changed.
//
//     Document
//       bytes        the file it was opened from, which never changes
//       view         the current state: its arrays point into the bytes or into the memory of an edit
//       edits        memory of each edit, the newest first
//       marks        earlier states: a copy of the view, and which edits had been made
//
// Nothing that a view points to is overwritten, so an edit costs what it changes, a mark costs a copy of
// the view, undoing is assigning one, and an edit that fails leaves no trace. The exception is field
// writes: no other state can see the arrays made by writes since the last mark or other edit, so later
// writes change these in place.
#pragma once

#include "runtime/base/arena.h"
#include "runtime/base/mapped_file.h"
#include "runtime/base/status.h"
#include "runtime/load/dna/format/dna_view.h"

namespace mien::author {

/// Memory that one edit took, or the field writes between two other edits. Knows its blocks.
class EditMemory {
 public:
  explicit EditMemory(const Allocator& from);

  /// In the allocator's memory; null if it ran out.
  static EditMemory* create(const Allocator& allocator);
  void destroy();

  Arena arena;  // first: it takes blocks from the members below until it ends

  bool holds(const void* address) const;

  EditMemory* older = nullptr;
  bool for_fields = false;  // field writes may go on using it

 private:
  struct Block;
  static void* allocate(void* user, size_t size, size_t alignment);
  static void release(void* user, void* block, size_t size, size_t alignment);
  Allocator tracked();

  Allocator allocator_;
  Block* blocks_;
};

struct Mark {
  dna::DnaView view;
  EditMemory* edits;  // the newest at that time
  bool checked;
  uint64_t number;
  Mark* older;
};

class Document {
 public:
  explicit Document(const Allocator& allocator) : allocator_(allocator) {}
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;
  ~Document();

  /// A file of version 2.8 with all layers, empty.
  Status create_empty(Error& error);

  /// Reads a file and checks it. Takes ownership of it, even if it fails. Errors of read_dna().
  Status open(const MappedFile& file, bool keep_unknown, Error& error);

  const dna::DnaView& view() const { return view_; }

  /// True if the view is known to pass check_view(): it was read from a file and only changed by edits that
  /// keep it valid, or has been checked since.
  bool checked() const { return checked_; }
  void set_checked() { checked_ = true; }
  const Allocator& allocator() const { return allocator_; }

  /// The state before the first edit.
  const dna::DnaView& original() const { return original_; }

  /// Lets pages of the file leave memory, where an operation takes much of its own.
  void forget_pages() const;

  /// A number for undo(), larger than those before; 0 is the state before the first edit.
  Status mark(uint64_t& out, Error& error);
  /// Goes back to a mark. Later marks become invalid, this one stays valid.
  Status undo(uint64_t mark, Error& error);

 private:
  friend class Edit;
  friend class FieldEdit;
  /// The newest edits, back to `end`, are released.
  void release_edits_after(EditMemory* end);

  Allocator allocator_;
  MappedFile file_;
  EditMemory* base_ = nullptr;  // lists of the file
  dna::DnaView view_, original_;
  bool checked_ = false, original_checked_ = false;
  EditMemory* edits_ = nullptr;
  Mark* marks_ = nullptr;
  uint64_t last_mark_ = 0;
};

/// A change of a document that happens completely or not at all:
///
///     Edit edit(document);
///     if (!edit.begin(error)) return error.status;
///     ... edit.view = ..., with new lists and arrays in edit.arena() ...
///     edit.commit();
class Edit {
 public:
  explicit Edit(Document& document) : document_(document) {}
  Edit(const Edit&) = delete;
  Edit& operator=(const Edit&) = delete;
  ~Edit();

  bool begin(Error& error);
  /// `keeps_valid`: a view that was valid before still is. Otherwise it is checked before it is used again.
  void commit(bool keeps_valid = false);

  dna::DnaView view;
  Arena& arena() { return memory_->arena; }

 private:
  Document& document_;
  EditMemory* memory_ = nullptr;
};

/// Makes the document a file of version 2.version with an empty list of layers; fields stay.
Status clear_layers(Document& document, uint16_t version, Error& error);
/// Appends a layer to the list. kInvalidArgument if it is there already, is of a known kind and has bytes, or
/// version 2.1 cannot have it.
Status add_layer(Document& document, uint32_t code, uint32_t layer_version,
                 Span<const uint8_t> bytes, Error& error);

/// kMemory, with a message that names `what` was wanted.
Status no_memory(Error& error, const char* what);

}  // namespace mien::author
