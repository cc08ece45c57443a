// SPDX-License-Identifier: MIT
#include "runtime/load/dna/format/dna_writer.h"

#include "runtime/load/dna/format/record_size.h"

namespace mien::dna {
namespace {

/// The bytes of a file that are wanted.
struct Window {
  uint8_t* out = nullptr;  // null: none, they are only counted
  uint64_t first = 0, end = ~uint64_t{0};

  void copy(uint64_t at, const uint8_t* bytes, size_t count) const {
    if (!out || count == 0) return;
    const uint64_t from = at < first ? first : at, to = at + count < end ? at + count : end;
    if (from < to) memcpy(out + (from - first), bytes + (from - at), size_t(to - from));
  }
};

/// Appends fields to a buffer, or only counts bytes if there is none.
class FieldWriter {
 public:
  FieldWriter(const Window& window, uint16_t version) : window_(window), version_(version) {}

  bool has_face_winding() const { return version_has_face_winding(version_); }
  uint64_t position() const { return at_; }

  template <class T>
  void operator()(const char*, const T& member) {
    write(member);
  }

  template <class T, std::enable_if_t<std::is_arithmetic<T>::value, int> = 0>
  void write(T value) {
    put(at_, value);
    at_ += sizeof(T);
  }

  void write(const String& string) {
    write(string.count);
    copy(string.data, string.count);
  }

  template <class T>
  void write(const Array<T>& array) {
    write(array.count);
    copy(array.data, array.byte_count());
  }

  template <class T>
  void write(const List<T>& list) {
    write(list.count);
    for (const T& element : list) write(element);
  }

  template <class Record, std::enable_if_t<std::is_class<Record>::value, int> = 0>
  void write(const Record& record) {
    if (!IsBlock<Record>::value) return Record::fields(record, *this);
    // From 2.2 on the size of what follows stands in front, in 2.1 the offset of its end.
    const uint64_t front = at_;
    at_ += 4;
    Record::fields(record, *this);
    put(front, static_cast<uint32_t>(version_ == 1 ? at_ : at_ - front - 4));
  }

  void copy(const uint8_t* bytes, size_t count) {
    window_.copy(at_, bytes, count);
    at_ += count;
  }

  /// Overwrites a number that was reserved earlier.
  template <class T>
  void put(uint64_t at, T value) {
    uint8_t bytes[sizeof(T)];
    store_big_endian(bytes, value);
    window_.copy(at, bytes, sizeof(T));
  }

 private:
  const Window window_;
  uint16_t version_;
  uint64_t at_ = 0;
};

bool version_knows(uint16_t version, const LayerKind& kind) {
  return version < 1 || version > 8 || kind.since <= version;
}

bool is_written(const IndexEntry& entry, const WriteOptions& options) {
  if (options.keep_unknown) return true;
  const LayerKind* kind = find_layer_kind(entry.code, entry.layer_version);
  return kind && version_knows(options.version, *kind);
}

const IndexEntry* find_entry(const DnaView& view, const LayerKind& kind) {
  for (const IndexEntry& entry : view.index) {
    if (entry.code == kind.code && entry.layer_version == kind.layer_version) return &entry;
  }
  return nullptr;
}

/// A layer of the file: of a known kind, or bytes that are carried along.
struct LayerToWrite {
  uint32_t code, layer_version;
  const LayerKind* kind;    // null: write `entry` as it is
  const IndexEntry* entry;  // null: the index lacks it
};

/// Calls f(layer) for each layer of the file, in order: those of the index, then those that the
/// version knows and the index lacks.
template <class F>
void for_each_layer(const DnaView& view, const WriteOptions& options, F&& f) {
  for (const IndexEntry& entry : view.index) {
    if (!is_written(entry, options)) continue;
    const LayerKind* kind = find_layer_kind(entry.code, entry.layer_version);
    f(LayerToWrite{entry.code, entry.layer_version, kind, &entry});
  }
  for (const LayerKind& kind : kLayerKinds) {
    if (!version_knows(options.version, kind) || find_entry(view, kind)) continue;
    f(LayerToWrite{kind.code, kind.layer_version, &kind, nullptr});
  }
}

void write_layer(const DnaView& view, const LayerToWrite& layer, FieldWriter& writer) {
  // A view that was only read in part, for looking, has entries without their bytes: written empty.
  if (!layer.kind) return writer.copy(layer.entry->data, layer.entry->data ? layer.entry->size : 0);
  with_layer(view, layer.kind->id, [&](const auto& record) { writer.write(record); });
}

void write_header(const DnaView& view, const WriteOptions& options, FieldWriter& writer) {
  writer.copy(reinterpret_cast<const uint8_t*>("DNA"), 3);
  writer.write(view.generation);
  writer.write(options.version);
}

// Header | eight section offsets | sections | "AND"
void write_sections(const DnaView& view, FieldWriter& writer) {
  uint64_t slot = writer.position();
  for (int s = 0; s < 8; ++s) writer.write(uint32_t{0});
  auto begin_section = [&] {
    writer.put(slot, static_cast<uint32_t>(writer.position()));
    slot += 4;
  };
  begin_section();
  writer.write(view.desc);
  begin_section();
  writer.write(view.defn);
  begin_section();  // "behavior": its four parts are the next sections
  begin_section();
  writer.write(view.bhvr.controls);
  begin_section();
  writer.write(view.bhvr.joints);
  begin_section();
  writer.write(view.bhvr.channels);
  begin_section();
  writer.write(view.bhvr.maps);
  begin_section();
  writer.write(view.geom);
  writer.copy(reinterpret_cast<const uint8_t*>("AND"), 3);
}

// Header | layer count | {code, layer version, offset, size} of each | layers
void write_layers(const DnaView& view, const WriteOptions& options, FieldWriter& writer) {
  uint32_t count = 0;
  for_each_layer(view, options, [&](const LayerToWrite&) { ++count; });
  writer.write(count);
  uint64_t slot = writer.position();
  for (uint64_t i = 0; i < 4 * uint64_t{count}; ++i) writer.write(uint32_t{0});

  for_each_layer(view, options, [&](const LayerToWrite& layer) {
    const uint64_t begin = writer.position();
    write_layer(view, layer, writer);
    const uint64_t numbers[] = {layer.code, layer.layer_version, begin, writer.position() - begin};
    for (uint64_t number : numbers) {
      writer.put(slot, static_cast<uint32_t>(number));
      slot += 4;
    }
  });
}

uint64_t write_file_bytes(const DnaView& view, const WriteOptions& options, const Window& window) {
  FieldWriter writer(window, options.version);
  write_header(view, options, writer);
  if (options.version == 1) {
    write_sections(view, writer);
  } else {
    write_layers(view, options, writer);
  }
  return writer.position();
}

}  // namespace

bool is_written(const DnaView& view, const LayerKind& kind, const WriteOptions& options) {
  if (version_knows(options.version, kind)) return true;
  return options.version != 1 && options.keep_unknown && find_entry(view, kind);
}

uint64_t encoded_size(const DnaView& view, const WriteOptions& options) {
  return write_file_bytes(view, options, {});
}

void encode(const DnaView& view, const WriteOptions& options, uint8_t* out) {
  write_file_bytes(view, options, {out});
}

void encode_range(const DnaView& view, const WriteOptions& options, uint64_t first, size_t count,
                  uint8_t* out) {
  write_file_bytes(view, options, {out, first, first + count});
}

}  // namespace mien::dna
