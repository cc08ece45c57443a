// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cinttypes>
#include <cstdio>

#include "runtime/base/arena.h"
#include "runtime/mix/mix_fields.h"
#include "runtime/mix/mix_file.h"

namespace mien {
namespace {

/// Shared by bytes and text: elements are copied before they are walked, because visitors may write them.
template <class To>
struct MixOutput {
  To& to() { return static_cast<To&>(*this); }
  void count(const char* name, uint32_t number, uint32_t) { to().value(name, number); }
  template <class T>
  void value(Field field, const Limits&, T number) {
    to().value(field.name, number);
  }
  template <class T, class Names>
  void choice(Field field, const Names&, T number) {
    to().value(field.name, static_cast<uint8_t>(number));
  }
  void pair(const char* name, uint16_t curve, float value) {
    to().value(name, curve);
    to().value(name, value);
  }
  void curves(const char* name, Span<const uint16_t> list) {
    for (uint16_t curve : list) to().value(name, curve);
  }
  void keep(const GazeTable&, const GazeTable*) {}
  void mask(const char* name, Span<const float> numbers) {
    to().row(name, numbers, [](size_t) { return 0.0f; });
  }
  template <class T, class Fields>
  void list(const char* name, Span<const T> items, uint32_t, Fields fields) {
    to().value(name, static_cast<uint32_t>(items.count));
    for (size_t i = 0; i < items.count; ++i) {
      T item = items[i];
      to().element(name, i, [&] { fields(item); });
    }
  }
  template <class Fields>
  void element(const char*, size_t, Fields fields) {
    fields();
  }
};

/// Counts bytes, and writes those for which there is room.
struct Sink {
  uint8_t* data;
  size_t room;
  size_t size = 0;

  void put(const void* bytes, size_t count) {
    if (size <= room && count <= room - size && count != 0) memcpy(data + size, bytes, count);
    size += count;
  }
};

struct MixBytes : MixOutput<MixBytes> {
  using MixOutput::value;
  const Mix& mix;
  const CurveMap& map;
  Sink& sink;

  MixBytes(const Mix& m, const CurveMap& curves, Sink& to) : mix(m), map(curves), sink(to) {}

  void place(const char*, uint16_t number) {
    number = to_little_endian(number);
    sink.put(&number, sizeof(number));
  }
  template <class T>
  void value(const char*, T number) {
    number = to_little_endian(number);
    sink.put(&number, sizeof(number));
  }
  void value(const char*, bool flag) { value("", static_cast<uint8_t>(flag)); }
  void value(const char*, uint16_t curve) { place("", map.file_curve_of[curve]); }
  void names(const char*, uint32_t) {
    value("", map.name_count);
    for (uint32_t i = 0; i < map.name_count; ++i) {
      const Span<char> name = mix.names[map.curve_of[i]];
      value("", static_cast<uint32_t>(name.count));
      sink.put(name.data, name.count);
    }
  }
  void curves(const char*, Span<const uint16_t> list) {
    value("", static_cast<uint32_t>(list.count));
    MixOutput::curves("", list);
  }
  void pairs(const char*, Span<const uint16_t> list, Span<const float> values) {
    curves("", list);
    for (float number : values) value("", number);
  }
  template <class T, class Otherwise>
  void row(const char*, Span<const T> numbers, Otherwise) {
    const bool there = !numbers.empty() && map.curve_of.count != 0;  // otherwise as if left out
    value("", there);
    for (size_t i = 0; there && i < map.curve_of.count; ++i) value("", numbers[map.curve_of[i]]);
  }
};

struct MixText : MixOutput<MixText> {
  using MixOutput::value;
  const Mix& mix;
  const CurveMap& map;
  Sink& sink;
  char path[64] = "";

  MixText(const Mix& m, const CurveMap& curves, Sink& to) : mix(m), map(curves), sink(to) {}

  void put(const char* text) { sink.put(text, strlen(text)); }
  void put_curve(uint16_t curve) {
    char text[16];
    if (curve >= mix.raw_count) {
      snprintf(text, sizeof(text), "variable:%u", curve - mix.raw_count);
      return put(text);
    }
    // Escapes names: one stays on its line, and cannot be taken for another curve.
    for (char c : mix.names[curve]) {
      const bool plain = static_cast<unsigned char>(c) > ' ' && c != '\\' && c != ':' && c != 0x7F;
      snprintf(text, sizeof(text), plain ? "%c" : "\\x%02X",
               plain ? c : static_cast<unsigned char>(c));
      put(text);
    }
  }
  /// Nine digits give back the bits. The decimal point is that of the locale.
  void put_number(float number) {
    char text[32];
    snprintf(text, sizeof(text), "%.9g", static_cast<double>(number));
    bool pointed = false;
    for (const char* c = text; *c; ++c) {
      const bool known = strchr("0123456789+-e", *c) != nullptr;
      if (known) {
        sink.put(c, 1);
      } else if (!pointed) {
        put(".");
        pointed = true;
      }
    }
  }
  void put_number(int64_t number) {
    char text[32];
    snprintf(text, sizeof(text), "%" PRId64, number);
    put(text);
  }
  void put_number(uint32_t number) { put_number(int64_t{number}); }
  void put_number(bool flag) { put(flag ? "true" : "false"); }
  void put_number(uint16_t curve) { put_curve(curve); }

  void begin(const char* name) {
    put(path);
    put(name);
    put(" ");
  }
  template <class T>
  void value(const char* name, T number) {
    begin(name);
    put_number(number);
    put("\n");
  }
  void place(const char* name, uint16_t number) { value(name, uint32_t{number}); }
  template <class T, size_t N>
  void choice(Field field, const char* const (&names)[N], T number) {
    begin(field.name);
    const auto value = static_cast<size_t>(number);
    if (value < N) put(names[value]);
    put("\n");
  }
  void names(const char* name, uint32_t) {
    for (uint32_t i = 0; i < map.name_count; ++i) value(name, map.curve_of[i]);
  }
  template <class T>
  void pair(const char* name, uint16_t curve, T number) {
    begin(name);
    put_curve(curve);
    put(" ");
    put_number(number);
    put("\n");
  }
  void pairs(const char* name, Span<const uint16_t> list, Span<const float> values) {
    for (size_t i = 0; i < list.count; ++i) pair(name, list[i], values[i]);
  }
  template <class T, class Otherwise>
  void row(const char* name, Span<const T> numbers, Otherwise) {
    for (size_t i = 0; i < map.curve_of.count && !numbers.empty(); ++i) {
      pair(name, map.curve_of[i], numbers[map.curve_of[i]]);
    }
  }
  template <class Fields>
  void element(const char* name, size_t index, Fields fields) {
    const size_t length = strlen(path);
    snprintf(path + length, sizeof(path) - length, "%s.%zu.", name, index);
    fields();
    path[length] = 0;
  }
};

/// Finds the curves that fields name.
struct CurveFinder : MixOutput<CurveFinder> {
  using MixOutput::value;
  Span<uint16_t> used;  // [curve of the mix] kNowhere: not yet

  explicit CurveFinder(Span<uint16_t> curves) : used(curves) {}
  template <class T>
  void value(const char*, T) {}
  void value(const char*, uint16_t curve) { used[curve] = 0; }
  void place(const char*, uint16_t) {}
  void names(const char*, uint32_t) {}
  void pairs(const char*, Span<const uint16_t> list, Span<const float>) { curves("", list); }
  template <class T, class Otherwise>
  void row(const char*, Span<const T> numbers, Otherwise otherwise) {
    for (size_t l = 0; l < numbers.count; ++l) {
      if (numbers[l] != otherwise(l)) used[l] = 0;
    }
  }
};

/// The curves of the file, in an arena.
Status map_curves(const Mix& mix, MixDesc& desc, Arena& arena, CurveMap& map, Error& error) {
  map.curve_of = arena.array<uint16_t>(mix.used_curves() + 1);
  map.file_curve_of = arena.array<uint16_t>(mix.used_curves() + 1);  // never empty
  if (!map.curve_of.data || !map.file_curve_of.data) {
    return fail(error, Status::kMemory, kNoOffset, "no memory to write a mix");
  }
  std::fill(map.file_curve_of.begin(), map.file_curve_of.end(), kNowhere);
  CurveFinder finder(map.file_curve_of);
  visit_mix(finder, desc);
  // A layer lists as many curves as there are, at most. One that repeats some takes names of others with it.
  size_t longest = 0, count = mix.variable_count;
  for (const LayerDesc& layer : mix.layers) longest = std::max(longest, layer.curves.count);
  for (uint16_t l = 0; l < mix.raw_count; ++l) count += map.file_curve_of[l] != kNowhere;
  for (uint16_t l = 0; l < mix.raw_count && count < longest; ++l) {
    if (map.file_curve_of[l] != kNowhere) continue;
    map.file_curve_of[l] = 0;
    ++count;
  }
  for (uint16_t l = 0; l < mix.raw_count; ++l) {
    if (map.file_curve_of[l] != kNowhere) map.curve_of[map.name_count++] = l;
  }
  if (map.name_count != 0 && mix.names.count() != mix.raw_count) {
    return fail(error, Status::kName, kNoOffset,
                "the controls of the mix have no names to write them by");
  }
  uint16_t* const curves = map.curve_of.data;
  std::sort(curves, curves + map.name_count, [&mix](uint16_t a, uint16_t b) {
    return compare_names(mix.names[a], mix.names[b]) < 0;
  });
  for (uint32_t i = 0; i < map.name_count; ++i) {
    const Span<char> name = mix.names[curves[i]];
    if (name.count > kMaxNameLength) {
      return fail(error, Status::kName, kNoOffset, "control %u has a name of %zu bytes; %zu fit",
                  curves[i], name.count, kMaxNameLength);
    }
    if (i == 0 || compare_names(mix.names[curves[i - 1]], name) != 0) continue;
    return fail(error, Status::kName, kNoOffset,
                "two controls that the mix uses are named %.*s: a file could not tell which is "
                "which",
                static_cast<int>(name.count), name.data);
  }
  map.curve_of.count = size_t{map.name_count} + mix.variable_count;
  for (uint32_t v = 0; v < mix.variable_count; ++v) {
    curves[map.name_count + v] = static_cast<uint16_t>(mix.raw_count + v);
  }
  for (uint16_t i = 0; i < map.curve_of.count; ++i) map.file_curve_of[curves[i]] = i;
  return Status::kOk;
}

template <class Output>
Status write(const Mix& mix, Sink& sink, Error& error) {
  Arena arena(mix.allocator);
  MixDesc desc = mix;
  CurveMap map;
  const Status status = map_curves(mix, desc, arena, map, error);
  if (status != Status::kOk) return status;
  Output output(mix, map, sink);
  visit_mix(output, desc);
  return Status::kOk;
}

}  // namespace

Status write_mix(const Mix& mix, Span<uint8_t> out, size_t& size, Error& error) {
  size = 0;
  Sink sink = {out.data, out.count};
  sink.put(kMixMagic, sizeof(kMixMagic));
  sink.size = kMixHeaderSize;
  const Status status = write<MixBytes>(mix, sink, error);
  if (status != Status::kOk) return status;
  size = sink.size;
  if (size > out.count) return Status::kOk;
  store_little_endian(out.data + kAtVersion, kMixVersion);
  store_little_endian(out.data + kAtSize, uint64_t{size});
  store_little_endian(out.data + kAtChecksum, clip_checksum(out.data, size));
  return Status::kOk;
}

Status write_mix_text(const Mix& mix, Span<char> out, size_t& size, Error& error) {
  Sink sink = {reinterpret_cast<uint8_t*>(out.data), out.count};
  const Status status = write<MixText>(mix, sink, error);
  size = status == Status::kOk ? sink.size : 0;
  return status;
}

}  // namespace mien
