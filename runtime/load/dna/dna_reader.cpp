// SPDX-License-Identifier: MIT
#include "runtime/load/dna/dna_reader.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>

#include "runtime/load/dna/check/dna_check.h"
#include "runtime/load/dna/convert/convert_coordinates.h"
#include "runtime/load/dna/convert/lod_selection.h"
#include "runtime/load/dna/format/pose_controls.h"
#include "runtime/load/dna/format/record_size.h"

namespace mien::dna {
namespace {

constexpr size_t kHeaderBytes = 7;
constexpr size_t kIndexEntryBytes = 16;

// Section table of version 2.1, in file order. "behavior" has no bytes: it starts where controls
// do.
enum Section {
  kSDescriptor,
  kSDefinition,
  kSBehavior,
  kSControls,
  kSJoints,
  kSChannels,
  kSMaps,
  kSGeometry,
  kSectionCount
};
constexpr size_t kSectionTableEnd = kHeaderBytes + 4 * kSectionCount;

/// Reads the fields of one record after another within [at, limit), which are offsets in the file.
class FieldReader {
 public:
  FieldReader(const DnaView& view, const FindingSink& sink, Arena& arena)
      : view_(view), sink_(sink), arena_(arena) {}

  const uint8_t* kept_meshes = nullptr;  // one byte for each of mesh_count; null keeps all
  size_t mesh_count = 0;
  bool skip_blend_shape_targets = false;

  bool has_face_winding() const { return version_has_face_winding(view_.version); }

  /// `data` are the bytes from offset `from` to offset `to`. False if the record could not be read;
  /// the finding has been reported.
  template <class Record>
  bool read_record(const char* layer, const uint8_t* data, size_t from, size_t to, Record& record) {
    begin(data, from, to);
    depth_ = 0;
    good_ = true;
    path_[depth_++] = {layer, kNoIndex};
    Record::fields(record, *this);
    return good_;
  }

  /// The same layer in several sections: the parts of the behavior layer in version 2.1.
  template <class Record>
  bool read_part(const char* layer, const char* part, const uint8_t* data, size_t from, size_t to,
                 Record& record) {
    begin(data, from, to);
    depth_ = 0;
    good_ = true;
    path_[depth_++] = {layer, kNoIndex};
    (*this)(part, record);
    return good_;
  }

  size_t position() const { return at_; }

  template <class T>
  void operator()(const char* name, T& member) {
    if (!good_) return;
    path_[depth_++] = {name, kNoIndex};
    read(member);
    --depth_;
  }

 private:
  static constexpr uint32_t kNoIndex = ~uint32_t{0};
  static constexpr int kDepth = 16;
  static constexpr uint32_t kMaxWarnings = 32;
  struct Step {
    const char* name;
    uint32_t index;
    uint32_t inner_index = kNoIndex;  // lists of lists have two
  };

  void begin(const uint8_t* data, size_t from, size_t to) {
    data_ = data;
    data_begin_ = at_ = from;
    limit_ = to;
  }
  const uint8_t* here() const { return data_ + (at_ - data_begin_); }

  template <class T, std::enable_if_t<std::is_arithmetic<T>::value, int> = 0>
  void read(T& value) {
    if (!need(sizeof(T))) return;
    value = load_big_endian<T>(here());
    at_ += sizeof(T);
  }

  void read(String& string) {
    uint32_t count;
    if (!read_count(1, count)) return;
    string.data = here();
    string.count = count;
    at_ += count;
  }

  template <class T>
  void read(Array<T>& array) {
    uint32_t count;
    if (!read_count(sizeof(T), count)) return;
    array.data = here();
    array.count = count;
    at_ += size_t{count} * sizeof(T);
  }

  template <class T>
  void read(List<T>& list) {
    if (std::is_same<T, BlendShapeTarget>::value && skip_blend_shape_targets) return;
    uint32_t count;
    if (!read_count(smallest_size<T>(), count) || count == 0) return;
    Span<T> items = arena_.array<T>(count);
    if (!items.data) return report(Status::kMemory, at_, "no memory for %u elements", count);
    list.items = items.data;
    list.count = count;
    Step& step = path_[depth_ - 1];
    uint32_t& index = step.index == kNoIndex ? step.index : step.inner_index;
    for (uint32_t i = 0; i < count && good_; ++i) {
      index = i;
      read_element(list.items[i], i);
    }
    index = kNoIndex;
  }

  template <class Record, std::enable_if_t<std::is_class<Record>::value, int> = 0>
  void read(Record& record) {
    if (!IsBlock<Record>::value) {
      Record::fields(record, *this);
      return;
    }
    size_t end;
    if (!read_block_end(end)) return;
    const size_t outer = limit_;
    limit_ = end;
    Record::fields(record, *this);
    if (good_ && at_ != end && sink_.thorough) {
      warn(at_, "%zu bytes at the end of this block are of no known use", end - at_);
    }
    limit_ = outer;
    at_ = end;
  }

  template <class T>
  void read_element(T& element, uint32_t) {
    read(element);
  }

  // A mesh of a LOD that was not chosen is skipped.
  void read_element(Mesh& mesh, uint32_t index) {
    if (!kept_meshes || (index < mesh_count && kept_meshes[index])) return read(mesh);
    size_t end;
    if (read_block_end(end)) at_ = end;
  }

  bool need(size_t bytes) {
    if (bytes <= limit_ - at_) return true;
    report(Status::kDnaTruncated, at_, "needs %zu bytes, but only %zu are left", bytes,
           limit_ - at_);
    return false;
  }

  bool read_count(size_t element_bytes, uint32_t& count) {
    if (!need(4)) return false;
    count = load_big_endian<uint32_t>(here());
    if (count > (limit_ - at_ - 4) / element_bytes) {
      report(Status::kDnaTruncated, at_,
             "states %u elements of at least %zu bytes, but only %zu bytes are left", count,
             element_bytes, limit_ - at_ - 4);
      return false;
    }
    at_ += 4;
    return true;
  }

  // From 2.2 on a block starts with its size, in 2.1 with the offset of its end.
  bool read_block_end(size_t& end) {
    if (!need(4)) return false;
    const uint32_t value = load_big_endian<uint32_t>(here());
    at_ += 4;
    const bool fits = view_.version == 1 ? value >= at_ && value <= limit_ : value <= limit_ - at_;
    if (!fits) {
      report(Status::kDnaStructure, at_ - 4, "block %s %u does not fit into the %zu bytes left",
             view_.version == 1 ? "end" : "size", value, limit_ - at_);
      return false;
    }
    end = view_.version == 1 ? value : at_ + value;
    return true;
  }

  void format_path(char* text, size_t capacity) const {
    size_t used = 0;
    text[0] = 0;
    for (int i = 0; i < depth_ && used < capacity; ++i) {
      const Step& step = path_[i];
      int n = snprintf(text + used, capacity - used, i ? ".%s" : "%s", step.name);
      used += static_cast<size_t>(n);
      for (uint32_t index : {step.index, step.inner_index}) {
        if (index == kNoIndex || used >= capacity) continue;
        used += static_cast<size_t>(snprintf(text + used, capacity - used, "[%u]", index));
      }
    }
  }

  MIEN_PRINTF(4, 0)
  void send(Status status, size_t offset, const char* format, va_list arguments) {
    char field[200], message[200];
    format_path(field, sizeof(field));
    vsnprintf(message, sizeof(message), format, arguments);
    if (!sink_.report(sink_.user, {status, offset, field, message})) good_ = false;
  }

  MIEN_PRINTF(4, 5)
  void report(Status status, size_t offset, const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    send(status, offset, format, arguments);
    va_end(arguments);
    good_ = false;
  }

  MIEN_PRINTF(3, 4)
  void warn(size_t offset, const char* format, ...) {
    if (++warnings_ > kMaxWarnings) return;  // a file of small blocks could have millions
    va_list arguments;
    va_start(arguments, format);
    send(Status::kOk, offset, format, arguments);
    va_end(arguments);
  }

  const DnaView& view_;
  const FindingSink& sink_;
  Arena& arena_;
  const uint8_t* data_ = nullptr;
  size_t data_begin_ = 0, at_ = 0, limit_ = 0;
  bool good_ = true;
  uint32_t warnings_ = 0;
  int depth_ = 0;
  Step path_[kDepth] = {};
};

/// One pass over a file: container, definition, then the other layers.
class DnaReader {
 public:
  /// `bytes` is null if the file is to be read from `stream`.
  DnaReader(const uint8_t* bytes, size_t size, const Stream& stream, const ReadOptions& options,
            Arena& arena, DnaView& view, const FindingSink& sink)
      : size_(size), stream_(stream), options_(options), arena_(arena), view_(view),
        outer_sink_(sink), sink_{this, count_and_forward, sink.thorough},
        fields_(view, sink_, arena) {
    view_ = {};
    view_.file = bytes;
    view_.file_size = size;
    view_.loaded = close_layer_mask(options.layers);
    view_.lacks_blend_shape_targets = options.skip_blend_shape_targets;
  }

  /// Stops where the sink ended the examination or the rest depends on what is wrong.
  void run() {
    if (!read_header()) return;
    if (!(view_.version == 1 ? read_sections() : read_index())) return;
    expect_lists();

    // The descriptor and the definition say how to read and select everything else.
    for (LayerId id : {LayerId::kDesc, LayerId::kDsce, LayerId::kDefn}) load(id);
    choose_lods();
    if (errors_ == 0 && !ended_ && check_definition(view_, sink_, lods_) && errors_ == 0) {
      choose_meshes();
    }
    const bool definition_is_good = errors_ == 0;
    if (ended_) return;

    for (LayerId id : {LayerId::kBhvr, LayerId::kMlbh, LayerId::kRbfb, LayerId::kRbfe,
                       LayerId::kJbmd, LayerId::kTwsw, LayerId::kMlbe, LayerId::kGeom}) {
      load(id);
      if (ended_) return;
    }
    if (view_.version == 1 && view_.has(kLayerGeometry) && !view_.lacks_blend_shape_targets &&
        errors_ == 0) {
      check_end_marker();
    }
    if (!definition_is_good || !count_ml_controls()) return;
    if (!synthesize_pose_controls(view_, arena_)) {
      report(Status::kMemory, kNoOffset, "rbfe", "no memory for pose controls");
      return;
    }
    if (!check_layers(view_, sink_, lods_) || errors_ != 0) return;
    if (lods_ != 0 && !select_lods(view_, lods_, arena_)) {
      report(Status::kMemory, kNoOffset, "", "no memory to select LODs");
      return;
    }
    Error error;
    if (options_.system &&
        convert_coordinates(view_, *options_.system, arena_, error) != Status::kOk) {
      report(error.status, error.byte_offset, "", "%s", error.message);
      return;
    }
    // Converted and selected views are checked again, even if the file was valid.
    if ((lods_ != 0 || options_.system) && check_definition(view_, sink_)) {
      check_layers(view_, sink_);
    }
  }

  bool good() const { return errors_ == 0; }
  bool ended() const { return ended_; }

 private:
  static bool count_and_forward(void* self, const Finding& finding) {
    DnaReader& reader = *static_cast<DnaReader*>(self);
    if (reader.ended_) return false;
    if (finding.status != Status::kOk) ++reader.errors_;
    if (!reader.outer_sink_.report(reader.outer_sink_.user, finding)) reader.ended_ = true;
    return !reader.ended_;
  }

  MIEN_PRINTF(5, 6)
  bool report(Status status, uint64_t offset, const char* field, const char* format, ...) {
    char message[200];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof(message), format, arguments);
    va_end(arguments);
    const bool go_on = sink_.report(sink_.user, {status, offset, field, message});
    return status == Status::kOk && go_on;
  }

  /// The bytes from `offset` on, which lie within the file; of a stream they are read into the arena.
  /// Null if that failed; the finding has been reported.
  const uint8_t* fetch(uint64_t offset, size_t size) {
    if (!stream_.read) return view_.file + offset;
    const Span<FileSegment> segment = arena_.array<FileSegment>(1);
    // One more byte, so that the end of a segment is never the address of the next one.
    void* data = segment.data ? arena_.allocate(size + 1, 1) : nullptr;
    if (!data) {
      report(Status::kMemory, offset, "", "no memory for %zu bytes of the file", size);
      return nullptr;
    }
    if (size != 0 && stream_.read(stream_.user, offset, data, size) != size) {
      report(Status::kFileRead, offset, "",
             "the read function of the stream gave fewer than the %zu bytes asked for", size);
      return nullptr;
    }
    segment[0] = {static_cast<const uint8_t*>(data), offset, size, view_.segments};
    view_.segments = segment.data;
    return segment[0].data;
  }

  bool read_header() {
    if (size_ != 0) {
      header_ = fetch(0, std::min(size_, kSectionTableEnd));
      if (!header_) return false;
    }
    if (size_ < 3 || memcmp(header_, "DNA", 3) != 0) {
      return report(Status::kDnaSignature, 0, "",
                    size_ == 0 ? "the file is empty"
                               : "the file does not start with \"DNA\": it is not a DNA file");
    }
    if (size_ < kHeaderBytes) {
      return report(Status::kDnaTruncated, size_, "",
                    "the file ends within its header: it is truncated");
    }
    view_.generation = load_big_endian<uint16_t>(header_ + 3);
    view_.version = load_big_endian<uint16_t>(header_ + 5);
    if (view_.generation != 2) {
      return report(Status::kDnaVersion, 3, "", "the file has version %u.%u; only 2.x can be read",
                    unsigned{view_.generation}, unsigned{view_.version});
    }
    if (sink_.thorough && (view_.version == 0 || view_.version > 8)) {
      return report(Status::kOk, 5, "", "version 2.%u is not known; read by the rules of 2.8",
                    unsigned{view_.version});
    }
    return true;
  }

  bool read_index() {
    if (size_ < kHeaderBytes + 4) {
      return report(Status::kDnaTruncated, size_, "",
                    "the file ends before its index: it is truncated");
    }
    const uint32_t count = load_big_endian<uint32_t>(header_ + kHeaderBytes);
    const size_t first = kHeaderBytes + 4;
    if (count > (size_ - first) / kIndexEntryBytes) {
      return report(Status::kDnaTruncated, kHeaderBytes, "",
                    "the index states %u layers, but the file has %zu bytes: it is truncated or "
                    "damaged",
                    count, size_);
    }
    if (!allocate_index(count)) return false;
    const size_t data_begin = first + kIndexEntryBytes * count;
    const uint8_t* entries = fetch(first, data_begin - first);
    if (!entries) return false;
    for (uint32_t i = 0; i < count; ++i) {
      const size_t at = first + kIndexEntryBytes * i;
      const uint8_t* entry = entries + kIndexEntryBytes * i;
      const uint32_t offset = load_big_endian<uint32_t>(entry + 8);
      const uint32_t bytes = load_big_endian<uint32_t>(entry + 12);
      if (uint64_t{offset} + bytes > size_) {
        return report(
            Status::kDnaTruncated, at + 8, "",
            "by the index, layer %u (%.4s) is at %u with %u bytes, but the file has %zu: it "
            "is truncated or damaged",
            i, entry, offset, bytes, size_);
      }
      if (bytes != 0 && offset < data_begin) {
        return report(Status::kDnaStructure, at + 8, "",
                      "by the index, layer %u (%.4s) is at %u, which is within the index", i, entry,
                      offset);
      }
      view_.index[i] = {load_big_endian<uint32_t>(entry), load_big_endian<uint32_t>(entry + 4),
                        nullptr, bytes, offset};
    }
    return check_index(data_begin) && drop_unknown() && fetch_layers();
  }

  // No two entries of the same kind, none that share bytes; gaps are allowed.
  bool check_index(size_t data_begin) {
    const List<IndexEntry>& index = view_.index;
    Span<uint32_t> order = arena_.array<uint32_t>(index.count);
    if (index.count && !order.data) return report(Status::kMemory, kNoOffset, "", "no memory");
    for (uint32_t i = 0; i < index.count; ++i) order[i] = i;
    auto entry_at = [&](uint32_t i) { return kHeaderBytes + 4 + kIndexEntryBytes * i; };

    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
      const IndexEntry &x = index[a], &y = index[b];
      if (x.code != y.code) return x.code < y.code;
      if (x.layer_version != y.layer_version) return x.layer_version < y.layer_version;
      return a < b;
    });
    for (uint32_t i = 1; i < index.count; ++i) {
      const IndexEntry &x = index[order[i - 1]], &y = index[order[i]];
      if (x.code == y.code && x.layer_version == y.layer_version) {
        return report(Status::kDnaStructure, entry_at(order[i]), "",
                      "layers %u and %u of the index "
                      "are of the same kind",
                      order[i - 1], order[i]);
      }
    }

    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
      if (index[a].offset != index[b].offset) return index[a].offset < index[b].offset;
      if (index[a].size != index[b].size) return index[a].size < index[b].size;
      return a < b;
    });
    size_t end = data_begin;
    bool go_on = true;
    for (uint32_t i : order) {
      if (index[i].size == 0) continue;
      if (index[i].offset < end) {
        return report(Status::kDnaStructure, entry_at(i) + 8, "", "layer %u begins within another",
                      i);
      }
      if (sink_.thorough && index[i].offset > end) {
        go_on &= report(Status::kOk, end, "", "%zu bytes before layer %u belong to no layer",
                        index[i].offset - end, i);
      }
      end = size_t{index[i].offset} + index[i].size;
    }
    if (sink_.thorough && end < size_) {
      go_on &= report(Status::kOk, end, "", "%zu bytes after the last layer belong to no layer",
                      size_ - end);
    }
    return go_on;
  }

  bool drop_unknown() {
    if (options_.keep_unknown) return true;
    List<IndexEntry>& index = view_.index;
    auto unknown = [](const IndexEntry& e) { return !find_layer_kind(e.code, e.layer_version); };
    IndexEntry* end = std::remove_if(index.begin(), index.end(), unknown);
    index.count = static_cast<uint32_t>(end - index.begin());
    return true;
  }

  /// From a stream, reads only what was chosen: known layers, and unknown ones that are carried along.
  bool fetch_layers() {
    for (IndexEntry& entry : view_.index) {
      const LayerKind* kind = find_layer_kind(entry.code, entry.layer_version);
      const bool needed = kind ? view_.has(kind->loaded_by) : options_.keep_unknown;
      // In version 2.1 behavior is four sections, each fetched when it is read.
      const bool in_sections = view_.version == 1 && kind && kind->id == LayerId::kBhvr;
      if (stream_.read && (!needed || in_sections)) continue;
      entry.data = fetch(entry.offset, entry.size);
      if (!entry.data) return false;
    }
    return true;
  }

  bool read_sections() {
    if (size_ < kSectionTableEnd) {
      return report(Status::kDnaTruncated, size_, "",
                    "the file ends within its section table: it is truncated");
    }
    for (int s = 0; s < kSectionCount; ++s) {
      sections_[s] = load_big_endian<uint32_t>(header_ + kHeaderBytes + 4 * s);
      if (sections_[s] < kSectionTableEnd || sections_[s] > size_) {
        const Status status = sections_[s] > size_ ? Status::kDnaTruncated : Status::kDnaStructure;
        return report(status, kHeaderBytes + 4 * static_cast<size_t>(s), "",
                      "by the section table, section %d is at %zu, but the file has %zu bytes and "
                      "its sections "
                      "begin at %zu",
                      s, sections_[s], size_, kSectionTableEnd);
      }
    }
    // Two sections in one place would be read twice.
    for (int s = 0; s < kSectionCount; ++s) {
      for (int t = 0; t < s; ++t) {
        if (sections_[s] == sections_[t] && t != kSBehavior && s != kSBehavior) {
          return report(Status::kDnaStructure, kHeaderBytes + 4 * static_cast<size_t>(s), "",
                        "sections %d and %d begin at the same place", t, s);
        }
      }
    }
    if (sink_.thorough && sections_[kSBehavior] != sections_[kSControls] &&
        !report(Status::kOk, kHeaderBytes + 4 * kSBehavior, "",
                "the behavior section does not begin where the controls section does")) {
      return false;
    }
    if (!allocate_index(4)) return false;
    const struct {
      LayerId id;
      Section first;
      Section last;
    } layers[] = {{LayerId::kDesc, kSDescriptor, kSDescriptor},
                  {LayerId::kDefn, kSDefinition, kSDefinition},
                  {LayerId::kBhvr, kSControls, kSMaps},
                  {LayerId::kGeom, kSGeometry, kSGeometry}};
    for (const auto& layer : layers) {
      const LayerKind& kind = kLayerKinds[static_cast<size_t>(layer.id)];
      size_t begin = sections_[layer.first], end = section_end(layer.last);
      if (end < begin) end = begin;
      view_.index[static_cast<size_t>(layer.id)] = {kind.code, kind.layer_version, nullptr,
                                                    static_cast<uint32_t>(end - begin),
                                                    static_cast<uint32_t>(begin)};
    }
    return fetch_layers();
  }

  // A section ends where the next one in the file begins; the last one before the end marker.
  size_t section_end(int section) const {
    size_t end = size_ - 3;  // sections in seven places take more
    if (end < sections_[section]) end = sections_[section];
    for (int other = 0; other < kSectionCount; ++other) {
      if (other == kSBehavior) continue;
      if (sections_[other] > sections_[section] && sections_[other] < end) end = sections_[other];
    }
    return end;
  }

  void check_end_marker() {
    const size_t at = geometry_end_;
    const uint8_t* marker =
        fetch(at, 3);  // a geometry that was read ends three bytes before the file
    if (!marker) return;
    if (memcmp(marker, "AND", 3) != 0) {
      report(Status::kDnaStructure, at, "",
             "the end marker \"AND\" is missing: the file is truncated or damaged");
    } else if (sink_.thorough && size_ - at > 3) {
      report(Status::kOk, at + 3, "", "%zu bytes after the end marker", size_ - at - 3);
    }
  }

  bool allocate_index(uint32_t count) {
    if (count == 0) return true;
    Span<IndexEntry> entries = arena_.array<IndexEntry>(count);
    if (!entries.data) return report(Status::kMemory, kNoOffset, "", "no memory for the index");
    view_.index = {entries.data, count};
    return true;
  }

  // Lists of names take about as much as the names; other layers are mostly numbers, which stay in
  // the file.
  void expect_lists() {
    size_t bytes = 0;
    for (size_t i = 0; i < kLayerIdCount; ++i) {
      const LayerKind& kind = kLayerKinds[i];
      const IndexEntry* entry = find_entry(kind.id);
      if (!entry || !view_.has(kind.loaded_by)) continue;
      bytes += kind.id == LayerId::kDefn ? entry->size : entry->size / 64;
    }
    arena_.expect(bytes);
  }

  const IndexEntry* find_entry(LayerId id) const {
    const LayerKind& kind = kLayerKinds[static_cast<size_t>(id)];
    for (const IndexEntry& entry : view_.index) {
      if (entry.code == kind.code && entry.layer_version == kind.layer_version) return &entry;
    }
    return nullptr;
  }

  /// Reads a layer if it was chosen and is there.
  void load(LayerId id) {
    const LayerKind& kind = kLayerKinds[static_cast<size_t>(id)];
    const IndexEntry* entry = find_entry(id);
    if (!view_.has(kind.loaded_by) || !entry) return;
    if (view_.version == 1 && id == LayerId::kBhvr) {
      load_behavior_sections();
      return;
    }
    fields_.skip_blend_shape_targets = view_.lacks_blend_shape_targets;
    fields_.kept_meshes = kept_meshes_.data;
    fields_.mesh_count = kept_meshes_.count;
    const size_t begin = entry->offset, end = begin + entry->size;
    const bool good = with_layer(view_, id, [&](auto& record) {
      return fields_.read_record(kind.name, entry->data, begin, end, record);
    });
    if (id == LayerId::kGeom) geometry_end_ = fields_.position();
    if (good && sink_.thorough && fields_.position() != end) {
      report(Status::kOk, fields_.position(), kind.name,
             "%zu bytes at the end of this layer are of no known use", end - fields_.position());
    }
  }

  void load_behavior_sections() {
    Behavior& b = view_.bhvr;
    auto part = [&](const char* name, Section s, auto& record) {
      if (ended_) return;
      const size_t begin = sections_[s], end = section_end(s);
      const uint8_t* data = fetch(begin, end - begin);
      if (data) fields_.read_part("bhvr", name, data, begin, end, record);
    };
    part("controls", kSControls, b.controls);
    part("joints", kSJoints, b.joints);
    part("blendShapeChannels", kSChannels, b.channels);
    part("animatedMaps", kSMaps, b.maps);
  }

  // Nothing is selected if all are chosen.
  void choose_lods() {
    const unsigned lod_count = view_.desc.lod_count;
    if (options_.lods == 0 || lod_count >= 64) return;  // so many LODs are refused later
    const uint64_t existing = (uint64_t{1} << lod_count) - 1;
    lods_ = options_.lods & existing;
    none_exists_ = lods_ == 0;
    if (lods_ == existing) lods_ = 0;
  }

  // From here on a mesh that no chosen LOD shows is not read.
  void choose_meshes() {
    if (none_exists_) {
      report(Status::kLod, kNoOffset, "desc.lodCount",
             "none of the chosen LODs exists: the file has %u, "
             "numbered from 0",
             unsigned{view_.desc.lod_count});
    } else if (lods_ != 0 && view_.defn.mesh_names.count != 0) {
      kept_meshes_ = arena_.array<uint8_t>(view_.defn.mesh_names.count);
      if (!kept_meshes_.data) {
        report(Status::kMemory, kNoOffset, "", "no memory to select LODs");
        return;
      }
      mark_lod_elements(view_.defn.lod_meshes, lods_, kept_meshes_);
    }
  }

  // RBF pose controls are numbered behind the ML controls, so their number is needed even if the ML
  // layer is not loaded: it is the first four bytes of mlbh.
  bool count_ml_controls() {
    view_.ml_control_count = view_.mlbh.control_names.count;
    const IndexEntry* entry = find_entry(LayerId::kMlbh);
    if (view_.has(kLayerMachineLearned) || !view_.has(kLayerRbf) || !entry) return true;
    const uint8_t* first = entry->size < 4 ? nullptr : fetch(entry->offset, 4);
    if (entry->size >= 4 && !first) return false;
    const uint32_t count = first ? load_big_endian<uint32_t>(first) : 0;
    if (!first || count > (entry->size - 4) / 4) {
      return report(Status::kDnaTruncated, entry->offset, "mlbh.mlControlNames",
                    "states %u names, but the layer has %u bytes", count, entry->size);
    }
    view_.ml_control_count = count;
    return true;
  }

  size_t size_;
  Stream stream_;                    // `read` is null if the file lies in memory
  const uint8_t* header_ = nullptr;  // the first bytes of the file
  const ReadOptions& options_;
  Arena& arena_;
  DnaView& view_;
  const FindingSink& outer_sink_;
  FindingSink sink_;  // counts, then hands on
  FieldReader fields_;
  uint32_t errors_ = 0;
  bool ended_ = false;
  size_t sections_[kSectionCount] = {};
  size_t geometry_end_ = 0;
  uint64_t lods_ = 0;         // chosen; 0 for all
  bool none_exists_ = false;  // of those that were asked for
  Span<uint8_t> kept_meshes_;
};

bool keep_first_error(void* user, const Finding& finding) {
  if (finding.status == Status::kOk) return true;
  Error& error = *static_cast<Error*>(user);
  if (finding.field[0]) {
    fail(error, finding.status, finding.byte_offset, "%s: %s", finding.field, finding.message);
  } else {
    fail(error, finding.status, finding.byte_offset, "%s", finding.message);
  }
  return false;
}

}  // namespace

namespace {

Status read(const uint8_t* bytes, size_t size, const Stream& stream, const ReadOptions& options,
            Arena& arena, DnaView& out, Error& error) {
  Error first;
  const FindingSink sink{&first, keep_first_error, false};
  DnaReader reader(bytes, size, stream, options, arena, out, sink);
  reader.run();
  if (reader.good()) return Status::kOk;
  error = first;
  return error.status;
}

}  // namespace

Status read_dna(const uint8_t* bytes, size_t size, const ReadOptions& options, Arena& arena,
                DnaView& out, Error& error) {
  return read(bytes, size, {}, options, arena, out, error);
}

Status read_dna(const Stream& stream, const ReadOptions& options, Arena& arena, DnaView& out,
                Error& error) {
  const size_t size = static_cast<size_t>(std::min<uint64_t>(stream.size, SIZE_MAX));
  return read(nullptr, size, stream, options, arena, out, error);
}

bool examine_dna(const uint8_t* bytes, size_t size, Arena& arena, DnaView& out,
                 const FindingSink& sink) {
  const ReadOptions options;
  DnaReader reader(bytes, size, {}, options, arena, out, sink);
  reader.run();
  return !reader.ended();
}

}  // namespace mien::dna
