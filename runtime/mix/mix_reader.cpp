// SPDX-License-Identifier: MIT
#include <cinttypes>
#include <cstdio>

#include "runtime/anim/control_names.h"
#include "runtime/base/arena.h"
#include "runtime/mix/mix_fields.h"
#include "runtime/mix/mix_file.h"

namespace mien {
namespace {

Status damaged_mix(Error& error, uint64_t offset, const char* what) {
  return fail(error, Status::kMixStructure, offset,
              "%s: the mix is damaged or was not written by Mien; write it again", what);
}

/// After an error, everything that is read is zero.
struct MixReader {
  Span<const uint8_t> bytes;
  const Rig* rig;
  Arena& arena;
  Error& error;
  size_t at = kMixHeaderSize;
  Status status = Status::kOk;
  uint32_t raw_count = 0, curve_count = 0;  // of the mix
  NameList listed = {};                     // the names of the file
  CurveMap map = {};

  void refuse(Status why) {
    if (status == Status::kOk) status = why;
  }
  void refuse(const char* what) {
    if (status == Status::kOk) status = damaged_mix(error, at, what);
  }
  template <class T>
  Span<T> room(size_t count) {
    const Span<T> items = arena.array<T>(count);
    if (items.count != count && status == Status::kOk) {
      status = fail(error, Status::kMemory, kNoOffset, "no memory to open a mix");
    }
    return items;
  }
  const uint8_t* take(size_t count) {
    if (status == Status::kOk && count > bytes.count - at) refuse("ends too early");
    if (status != Status::kOk) return nullptr;
    at += count;
    return bytes.data + at - count;
  }
  template <class T>
  T number() {
    const uint8_t* from = take(sizeof(T));
    return from ? load_little_endian<T>(from) : T{};
  }
  /// Reads the number of elements that take `size` bytes or more each.
  uint32_t bounded(uint32_t most, size_t size) {
    const auto count = number<uint32_t>();
    if (count <= most && size_t{count} * size <= bytes.count - at) return count;
    refuse("a count");
    return 0;
  }

  template <class T>
  void value(Field field, const Limits&, T& to) {
    value(field.name, to);
  }
  template <class T>
  void value(const char*, T& to) {
    to = number<T>();
  }
  void value(const char* name, bool& to) {
    const auto flag = number<uint8_t>();
    if (flag > 1) refuse(name);
    to = flag == 1;
  }
  void value(const char* name, uint16_t& curve) {
    const auto place = number<uint16_t>();
    if (status == Status::kOk && place >= map.curve_of.count) refuse(name);
    curve = status == Status::kOk ? map.curve_of[place] : uint16_t{0};
  }
  void place(const char*, uint16_t& to) { to = number<uint16_t>(); }
  template <class T, class Names>
  void choice(Field, const Names&, T& to) {
    to = static_cast<T>(number<uint8_t>());
  }
  void count(const char*, uint32_t& to, uint32_t most) { to = bounded(most, 1); }
  void pair(const char* name, uint16_t& curve, float& to) {
    value(name, curve);
    value(name, to);
  }
  void curves(const char* name, Span<const uint16_t>& to) {
    const Span<uint16_t> list = room<uint16_t>(bounded(kMaxCurves, sizeof(uint16_t)));
    for (uint16_t& curve : list) value(name, curve);
    to = list;
  }
  void pairs(const char* name, Span<const uint16_t>& list, Span<const float>& values) {
    curves(name, list);
    const Span<float> numbers = room<float>(list.count);
    for (float& each : numbers) value(name, each);
    values = numbers;
  }
  void mask(const char* name, Span<const float>& to) {
    row(name, to, [](size_t) { return 0.0f; });
  }
  template <class T, class Otherwise>
  void row(const char* name, Span<const T>& to, Otherwise otherwise) {
    bool there = false;
    value(name, there);
    if (!there) return;
    const Span<T> numbers = room<T>(curve_count);
    for (size_t l = 0; l < numbers.count; ++l) numbers[l] = otherwise(l);
    for (size_t i = 0; i < map.curve_of.count && status == Status::kOk; ++i) {
      value(name, numbers[map.curve_of[i]]);
    }
    to = numbers;
  }
  template <class T, class Fields>
  void list(const char*, Span<const T>& to, uint32_t most, Fields fields) {
    const Span<T> items = room<T>(bounded(most, 1));
    for (size_t i = 0; i < items.count && status == Status::kOk; ++i) fields(items[i]);
    to = items;
  }
  void keep(const GazeTable& gaze, const GazeTable*& to) {
    const Span<GazeTable> kept = room<GazeTable>(1);
    if (!kept.empty()) kept[0] = gaze;
    to = kept.data;
  }

  void names(const char* name, uint32_t variable_count) {
    const uint32_t count = bounded(kMaxCurves, sizeof(uint32_t));
    listed.first = room<uint32_t>(size_t{count} + 1);
    listed.chars = room<char>(bytes.count - at);  // more than all names
    for (uint32_t i = 0; i < count && status == Status::kOk; ++i) {
      const auto length = number<uint32_t>();
      if (length > kMaxNameLength) return refuse(name);
      const uint8_t* from = take(length);
      if (!from) return;
      const uint32_t begin = listed.first[i];
      if (length != 0) memcpy(listed.chars.data + begin, from, length);
      listed.first[i + 1] = begin + length;
      if (i > 0 && compare_names(listed[i - 1], listed[i]) >= 0) return refuse(name);
    }
    raw_count = rig ? rig->raw_count : count;
    if (raw_count > kMaxCurves || variable_count > kMaxCurves - raw_count) {
      return refuse("more curves than a mix can have");
    }
    curve_count = raw_count + variable_count;
    map.name_count = count;
    map.curve_of = room<uint16_t>(size_t{count} + variable_count + 1);
    if (status != Status::kOk) return;
    listed.chars.count = listed.first[count];
    map.curve_of.count = size_t{count} + variable_count;
    for (uint32_t i = 0; i < count; ++i) map.curve_of[i] = static_cast<uint16_t>(i);
    for (uint32_t v = 0; v < variable_count; ++v) {
      map.curve_of[count + v] = static_cast<uint16_t>(raw_count + v);
    }
    if (rig) find_names();
  }
  void find_names() {
    const RigNames rig_names = {rig->names[static_cast<size_t>(Kind::kRawControl)]};
    NameIndex<RigNames> index = {rig_names, room<uint16_t>(raw_count)};
    const Span<uint8_t> taken = room<uint8_t>(raw_count);
    if (status != Status::kOk) return;
    index.sort();
    size_t missing = 0;
    char text[160] = "";
    for (uint32_t i = 0; i < listed.count(); ++i) {
      const Span<const char> name = listed[i];
      const uint32_t curve = index.find(name);
      if (curve != kNoName && !taken[curve]) {
        taken[curve] = 1;
        map.curve_of[i] = static_cast<uint16_t>(curve);
        continue;
      }
      const size_t length = strlen(text);
      if (length + name.count + 8 < sizeof(text)) {
        snprintf(text + length, sizeof(text) - length, "%s%.*s", missing ? ", " : "",
                 static_cast<int>(name.count), name.data);
      }
      ++missing;
    }
    if (missing == 0) return;
    refuse(fail(error, Status::kName, kNoOffset,
                "the rig lacks %zu of the %u controls of the mix: %s", missing, listed.count(),
                text));
  }
};

Status check_header(Span<const uint8_t> bytes, Error& error) {
  if (bytes.count < kMixHeaderSize || memcmp(bytes.data, kMixMagic, sizeof(kMixMagic)) != 0) {
    return fail(error, Status::kMixSignature, 0,
                "not a mix: it does not begin with the signature of mixes");
  }
  const auto version = load_little_endian<uint32_t>(bytes.data + kAtVersion);
  if (version != kMixVersion) {
    return fail(error, Status::kMixVersion, kAtVersion,
                "the mix has version %u, this library reads %u; write it again", version,
                kMixVersion);
  }
  const auto size = load_little_endian<uint64_t>(bytes.data + kAtSize);
  if (size > bytes.count) {
    return fail(error, Status::kMixTruncated, bytes.count,
                "the mix ends after %zu of %" PRIu64 " bytes; fetch or write it again", bytes.count,
                size);
  }
  if (size < bytes.count) return damaged_mix(error, size, "bytes after the end");
  const auto sum = load_little_endian<uint32_t>(bytes.data + kAtChecksum);
  if (sum == clip_checksum(bytes.data, bytes.count)) return Status::kOk;
  return fail(error, Status::kMixChecksum, kAtChecksum,
              "the mix has changed since it was written; fetch or write it again");
}

}  // namespace

Status open_mix(Span<const uint8_t> bytes, const Rig* rig, const Allocator& allocator, Mix*& out,
                Error& error) {
  out = nullptr;
  Status status = check_header(bytes, error);
  if (status != Status::kOk) return status;
  Arena arena(allocator);
  MixReader reader = {bytes, rig, arena, error};
  MixDesc desc;
  visit_mix(reader, desc);
  if (reader.status == Status::kOk && reader.at != bytes.count) reader.refuse("its end");
  if (reader.status != Status::kOk) return reader.status;
  desc.raw_count = reader.raw_count;
  desc.names = rig ? rig->names[static_cast<size_t>(Kind::kRawControl)] : reader.listed;
  if (rig) desc.kernels = rig->kernels;
  desc.max_bound_gui = bound_gui_limit(rig ? rig->gui_count : 0);
  status = create_mix(desc, allocator, out, error);
  // The file is wrong if create_mix() refuses its desc.
  if (status == Status::kInvalidArgument) error.status = status = Status::kMixStructure;
  return status;
}

}  // namespace mien
