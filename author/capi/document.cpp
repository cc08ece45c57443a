// SPDX-License-Identifier: MIT
// Documents: creating, fields, undoing, and converting to files. mien_author.h is the manual.
#include "author/capi/document.h"

#include "author/document/document_file.h"
#include "author/document/field_edit.h"
#include "runtime/base/mapped_file.h"
#include "runtime/load/dna/format/dna_writer.h"

using namespace mien;
using namespace mien::capi;
using author::Document;
using author::FilePieces;

namespace {

Status open_document(const MienDna* dna, Document& document, MienError* error) {
  size_t size = 0;
  if (MienStatus status = mien_dna_write_memory(dna, nullptr, nullptr, 0, &size, error)) {
    return static_cast<Status>(status);
  }
  uint8_t* bytes = static_cast<uint8_t*>(document.allocator().get(size, kBlockAlignment));
  if (!bytes) {
    give_error(error, MIEN_ERROR_MEMORY, "no memory for a document of %zu bytes", size);
    return Status::kMemory;
  }
  const MienStatus written = mien_dna_write_memory(dna, nullptr, bytes, size, &size, error);
  Error detail;
  const MappedFile copy{bytes, size, false, size, document.allocator()};
  const Status opened = document.open(copy, true, detail);
  if (written != MIEN_OK) return static_cast<Status>(written);
  if (opened != Status::kOk) give_error(detail, error);
  return opened;
}

/// A document as the bytes of its file.
struct FileOf {
  const dna::DnaView& view;
  dna::WriteOptions options;
  uint64_t size;

  explicit FileOf(const Document& document) : view(document.view()) {
    options.version = view.version;
    size = dna::encoded_size(view, options);
  }
  static size_t MIEN_CALLBACK read(void* user, uint64_t offset, void* buffer, size_t size) {
    const FileOf& file = *static_cast<const FileOf*>(user);
    dna::encode_range(file.view, file.options, offset, size, static_cast<uint8_t*>(buffer));
    return size;
  }
};

MienStatus check_size(const FileOf& file, MienError* error) {
  if (file.size <= UINT32_MAX) return MIEN_OK;
  return give_error(
      error, MIEN_ERROR_DNA_LIMIT,
      "the file would have %llu bytes, DNA files hold less than 4 GiB: remove LODs or targets",
      static_cast<unsigned long long>(file.size));
}

template <class Read>
MienStatus read_of(const MienDocument* document, MienError* error, const Read& read) {
  if (MienStatus status = check_document(document, error)) return status;
  return read(document->document.view());
}

/// Calls write(path, detail) with a checked path.
template <class Write>
MienStatus write_to(MienDocument* document, const char* given, MienError* error,
                    const Write& write) {
  if (MienStatus status = check_document(document, error)) return status;
  char path[kMaxPath + 1];
  if (MienStatus status = copy_path(given, length_of(given), path, error)) return status;
  Error detail;
  return finish(write(path, detail), detail, error);
}

/// Creates a document, which `open` fills; it says what is wrong if it fails.
template <class Open>
MienStatus create(const MienDocumentDesc* desc, MienDocument** out_document, MienError* error,
                  const Open& open) {
  MienDocumentDesc known;
  if (MienStatus status = read_desc(desc, known, "MienDocumentDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  const MienStatus in_range = check_fields(
      {{"MienDocumentDesc.file_access", known.file_access, MIEN_FILE_READ},
       {"MienDocumentDesc.unknown_layers", known.unknown_layers, MIEN_UNKNOWN_LAYERS_DROP}},
      error);
  if (in_range != MIEN_OK) return in_range;
  MienDocument* made = create_object<MienDocument>(allocator);
  if (!made) return give_error(error, MIEN_ERROR_MEMORY, "no memory for a document");
  const Status status = open(made->document, known);
  if (status != Status::kOk) {
    mien_document_destroy(made);
    return static_cast<MienStatus>(status);
  }
  *out_document = made;
  return succeed(error);
}

/// Calls write(view, options, size) with the file that the document becomes.
template <class Write>
MienStatus write_document(const MienDocument* document, const MienWriteDesc* desc, MienError* error,
                          const Write& write) {
  if (MienStatus status = check_document(document, error)) return status;
  MienWriteDesc known;
  if (MienStatus status = read_desc(desc, known, "MienWriteDesc", error)) return status;
  const MienStatus in_range = check_fields(
      {{"MienWriteDesc.version", known.version, 8},
       {"MienWriteDesc.unknown_layers", known.unknown_layers, MIEN_UNKNOWN_LAYERS_DROP}},
      error);
  if (in_range != MIEN_OK) return in_range;
  const Document& of = document->document;
  dna::WriteOptions options;
  options.version = known.version ? static_cast<uint16_t>(known.version) : of.view().version;
  options.keep_unknown = known.unknown_layers == MIEN_UNKNOWN_LAYERS_KEEP;
  Arena arena(of.allocator());
  dna::DnaView view;
  uint64_t size = 0;
  Error detail;
  if (author::plan_file(of, options, arena, view, size, detail) != Status::kOk) {
    return give_error(detail, error);
  }
  return write(view, options, static_cast<size_t>(size));
}

/// Calls write(pieces).
template <class Write>
MienStatus write_pieces(const MienDocument* document, const MienWriteDesc* desc, MienError* error,
                        const Write& write) {
  return write_document(
      document, desc, error,
      [&](const dna::DnaView& view, const dna::WriteOptions& options, size_t size) {
        Arena arena(document->document.allocator());
        FilePieces pieces(view, options, size);
        if (!pieces.begin(arena)) {
          return give_error(error, MIEN_ERROR_MEMORY, "no memory for a piece of the file");
        }
        return write(pieces);
      });
}

MienStatus check_values(const void* values, uint64_t count, const char* name, MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (values || count == 0) return MIEN_OK;
  return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "%s is NULL, but its count is not 0", name);
}

}  // namespace

MienStatus mien_document_create(const MienDna* dna, const MienDocumentDesc* desc,
                                MienDocument** out_document, MienError* error) {
  if (MienStatus status = clear_output(out_document, error)) return status;
  return create(desc, out_document, error, [&](Document& document, const MienDocumentDesc&) {
    if (dna) return open_document(dna, document, error);
    Error detail;
    const Status status = document.create_empty(detail);
    if (status != Status::kOk) give_error(detail, error);
    return status;
  });
}

MienStatus mien_document_open_file(const char* path, const MienDocumentDesc* desc,
                                   MienDocument** out_document, MienError* error) {
  if (MienStatus status = clear_output(out_document, error)) return status;
  if (!path) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "path is NULL");
  return create(desc, out_document, error, [&](Document& document, const MienDocumentDesc& known) {
    MappedFile file;
    Error detail;
    Status status = open_file(path, static_cast<FileAccess>(known.file_access), {"DNA", 3},
                              document.allocator(), file, detail);
    if (status == Status::kOk) {
      status = document.open(file, known.unknown_layers == MIEN_UNKNOWN_LAYERS_KEEP, detail);
    }
    if (status != Status::kOk) give_error(detail, error);
    return status;
  });
}

void mien_document_destroy(MienDocument* document) {
  if (check_document(document, nullptr) != MIEN_OK) return;
  document->tag = 0;
  release(document);
}

// Fields --------------------------------------------------------------------------------------------

MienStatus mien_document_field(const MienDocument* document, const char* path,
                               MienDnaField* out_field, MienError* error) {
  if (MienStatus status = clear_field(out_field, error)) return status;
  return read_of(document, error, [&](const dna::DnaView& view) {
    return describe_field(view, path, length_of(path), out_field, error);
  });
}

MienStatus mien_document_child_name(const MienDocument* document, const char* path, uint32_t index,
                                    MienStringView* out_name, MienError* error) {
  if (MienStatus status = clear_output(out_name, error)) return status;
  return read_of(document, error, [&](const dna::DnaView& view) {
    return name_field(view, path, length_of(path), index, out_name, error);
  });
}

MienStatus mien_document_read_floats(const MienDocument* document, const char* path, uint64_t first,
                                     uint64_t count, float* out, MienError* error) {
  return read_of(document, error, [&](const dna::DnaView& view) {
    return read_field({view, "mien_document"}, path, length_of(path), first, count, out, error);
  });
}

MienStatus mien_document_read_integers(const MienDocument* document, const char* path,
                                       uint64_t first, uint64_t count, int64_t* out,
                                       MienError* error) {
  return read_of(document, error, [&](const dna::DnaView& view) {
    return read_field({view, "mien_document"}, path, length_of(path), first, count, out, error);
  });
}

MienStatus mien_document_read_string(const MienDocument* document, const char* path,
                                     MienStringView* out_string, MienError* error) {
  if (MienStatus status = clear_output(out_string, error)) return status;
  return read_of(document, error, [&](const dna::DnaView& view) {
    return read_field({view, "mien_document"}, path, length_of(path), out_string, error);
  });
}

MienStatus mien_document_bytes(const MienDocument* document, const char* path,
                               MienStringView* out_bytes, MienError* error) {
  if (MienStatus status = clear_output(out_bytes, error)) return status;
  return read_of(document, error, [&](const dna::DnaView& view) {
    return field_bytes({view, "mien_document"}, path, length_of(path), out_bytes, error);
  });
}

MienStatus mien_document_write_floats(MienDocument* document, const char* path, uint64_t first,
                                      uint64_t count, const float* values, MienError* error) {
  if (MienStatus status = check_values(values, count, "values", error)) return status;
  return write_to(document, path, error, [&](const char* known, Error& detail) {
    return author::write_floats(document->document, known, first, count, values, detail);
  });
}

MienStatus mien_document_write_integers(MienDocument* document, const char* path, uint64_t first,
                                        uint64_t count, const int64_t* values, MienError* error) {
  if (MienStatus status = check_values(values, count, "values", error)) return status;
  return write_to(document, path, error, [&](const char* known, Error& detail) {
    return author::write_integers(document->document, known, first, count, values, detail);
  });
}

MienStatus mien_document_write_string(MienDocument* document, const char* path, const char* string,
                                      size_t string_count, MienError* error) {
  if (MienStatus status = check_values(string, string_count, "string", error)) return status;
  return write_to(document, path, error, [&](const char* known, Error& detail) {
    return author::write_string(document->document, known, string, string_count, detail);
  });
}

MienStatus mien_document_splice(MienDocument* document, const char* path, uint64_t first,
                                uint64_t removed_count, uint64_t inserted_count, MienError* error) {
  return write_to(document, path, error, [&](const char* known, Error& detail) {
    return author::splice(document->document, known, first, removed_count, inserted_count, detail);
  });
}

MienStatus mien_document_resize(MienDocument* document, const char* path, uint64_t count,
                                MienError* error) {
  return write_to(document, path, error, [&](const char* known, Error& detail) {
    return author::resize(document->document, known, count, detail);
  });
}

// Layers --------------------------------------------------------------------------------------------

MienStatus mien_document_layer_count(const MienDocument* document, uint32_t* out_version,
                                     uint32_t* out_count, MienError* error) {
  const MienStatus cleared = clear_output(out_version, error);
  if (MienStatus status = clear_output(out_count, error)) return status;
  if (cleared != MIEN_OK) return clear_output(out_version, error);
  return read_of(document, error, [&](const dna::DnaView& view) {
    *out_version = view.version;
    *out_count = view.index.count;
    return succeed(error);
  });
}

MienStatus mien_document_layer(const MienDocument* document, uint32_t index,
                               MienDnaLayer* out_layer, MienStringView* out_bytes,
                               MienError* error) {
  const MienStatus cleared = clear_struct(out_layer);
  if (MienStatus status = clear_output(out_bytes, error)) return status;
  if (cleared != MIEN_OK)
    return give_error(error, cleared, "out_layer is NULL, or its struct_size is wrong");
  return read_of(document, error, [&](const dna::DnaView& view) {
    if (index >= view.index.count) {
      return give_error(error, MIEN_ERROR_INDEX, "there is no layer %u: the list has %u", index,
                        view.index.count);
    }
    const dna::IndexEntry& entry = view.index[index];
    const dna::LayerKind* kind = dna::find_layer_kind(entry.code, entry.layer_version);
    MienDnaLayer layer = {};
    store_big_endian(reinterpret_cast<uint8_t*>(layer.code), entry.code);
    layer.layer = kind ? kind->loaded_by : uint32_t{MIEN_LAYER_UNKNOWN};
    layer.version_major = entry.layer_version >> 16;
    layer.version_minor = entry.layer_version & 0xFFFF;
    layer.byte_offset = MIEN_NO_OFFSET;
    layer.is_loaded = kind != nullptr;
    if (!kind) {
      layer.byte_count = entry.size;
      *out_bytes = {reinterpret_cast<const char*>(entry.data), entry.size};
    }
    write_struct(out_layer, layer);
    return succeed(error);
  });
}

MienStatus mien_document_clear_layers(MienDocument* document, uint32_t version, MienError* error) {
  if (MienStatus status = check_document(document, error)) return status;
  if (version < 1 || version > UINT16_MAX) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT, "version is %u, not 1 to 65535", version);
  }
  Error detail;
  return finish(author::clear_layers(document->document, static_cast<uint16_t>(version), detail),
                detail, error);
}

MienStatus mien_document_add_layer(MienDocument* document, const char* code, uint32_t version_major,
                                   uint32_t version_minor, const void* bytes, size_t size,
                                   MienError* error) {
  if (MienStatus status = check_values(bytes, size, "bytes", error)) return status;
  if (MienStatus status = check_document(document, error)) return status;
  if (!code) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "code is NULL");
  if (strlen(code) != 4) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "code is \"%.20s\"; codes of layers have four characters", code);
  }
  if (version_major > UINT16_MAX || version_minor > UINT16_MAX || size > UINT32_MAX) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "layer %s: a version is above 65535, or there are more than 4 GiB", code);
  }
  Error detail;
  return finish(author::add_layer(document->document,
                                  load_big_endian<uint32_t>(reinterpret_cast<const uint8_t*>(code)),
                                  version_major << 16 | version_minor,
                                  {static_cast<const uint8_t*>(bytes), size}, detail),
                detail, error);
}

// Undoing -------------------------------------------------------------------------------------------

MienStatus mien_document_mark(MienDocument* document, uint64_t* out_mark, MienError* error) {
  if (MienStatus status = clear_output(out_mark, error)) return status;
  if (MienStatus status = check_document(document, error)) return status;
  Error detail;
  return finish(document->document.mark(*out_mark, detail), detail, error);
}

MienStatus mien_document_undo(MienDocument* document, uint64_t mark, MienError* error) {
  if (MienStatus status = check_document(document, error)) return status;
  Error detail;
  return finish(document->document.undo(mark, detail), detail, error);
}

// Results -------------------------------------------------------------------------------------------

MienStatus mien_document_to_dna(const MienDocument* document, const MienDocumentDesc* desc,
                                MienDna** out_dna, MienError* error) {
  if (MienStatus status = clear_output(out_dna, error)) return status;
  if (MienStatus status = check_document(document, error)) return status;
  MienDocumentDesc known;
  if (MienStatus status = read_desc(desc, known, "MienDocumentDesc", error)) return status;
  FileOf file(document->document);
  if (MienStatus status = check_size(file, error)) return status;
  const MienStream stream = {&file, file.size, FileOf::read};
  MienDnaDesc open = mien_dna_desc_default();
  open.allocator = known.allocator;
  return mien_dna_open_stream(&stream, &open, out_dna, error);
}

MienStatus mien_document_write_file(const MienDocument* document, const char* path,
                                    const MienWriteDesc* desc, MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (!path) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "path is NULL");
  return write_pieces(document, desc, error, [&](FilePieces& pieces) {
    const auto next = [](void* user) { return static_cast<FilePieces*>(user)->next(); };
    Error detail;
    const Status status = write_file(path, {&pieces, next}, document->document.allocator(), detail);
    return finish(status, detail, error);
  });
}

MienStatus mien_document_write_stream(const MienDocument* document, const MienByteSink* sink,
                                      const MienWriteDesc* desc, MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (!sink || !sink->write) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "sink or sink->write is NULL");
  }
  return write_pieces(document, desc, error, [&](FilePieces& pieces) {
    while (true) {
      const Span<const uint8_t> piece = pieces.next();
      if (piece.empty()) return succeed(error);
      if (sink->write(sink->user, piece.data, piece.count) != piece.count) {
        return give_error(error, MIEN_ERROR_FILE_WRITE, "the sink did not take %zu bytes",
                          piece.count);
      }
    }
  });
}

MienStatus mien_document_write_memory(const MienDocument* document, const MienWriteDesc* desc,
                                      void* buffer, size_t capacity, size_t* out_size,
                                      MienError* error) {
  if (MienStatus status = clear_output(out_size, error)) return status;
  if (!buffer && capacity != 0) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "buffer is NULL");
  }
  return write_document(
      document, desc, error,
      [&](const dna::DnaView& view, const dna::WriteOptions& options, size_t size) {
        *out_size = size;
        if (!buffer) return succeed(error);
        if (capacity < size) {
          return give_error(
              error, MIEN_ERROR_INVALID_ARGUMENT,
              "the file has %zu bytes, the buffer %zu: call again with a buffer of this size", size,
              capacity);
        }
        dna::encode(view, options, static_cast<uint8_t*>(buffer));
        return succeed(error);
      });
}

MienStatus mien_document_validate(const MienDocument* document, const MienValidateDesc* desc,
                                  MienReport** out_report, MienError* error) {
  if (MienStatus status = clear_output(out_report, error)) return status;
  if (MienStatus status = check_document(document, error)) return status;
  const FileOf file(document->document);
  if (MienStatus status = check_size(file, error)) return status;
  const Allocator& allocator = document->document.allocator();
  const size_t size = static_cast<size_t>(file.size);
  uint8_t* bytes = static_cast<uint8_t*>(allocator.get(size, kBlockAlignment));
  if (!bytes)
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for a file of %zu bytes", size);
  dna::encode(file.view, file.options, bytes);
  const MienStatus status = mien_dna_validate_memory(bytes, size, desc, out_report, error);
  allocator.put(bytes, size, kBlockAlignment);
  return status;
}
