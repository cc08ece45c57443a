// SPDX-License-Identifier: MIT
#include "runtime/load/dna/check/dna_checker.h"

#include <cstdio>

namespace mien::dna {
namespace {

size_t spell(const Field& field, char* out, size_t capacity) {
  size_t used = field.parent ? spell(*field.parent, out, capacity) : 0;
  auto append = [&](int n) {
    used += static_cast<size_t>(n);
    if (used >= capacity) used = capacity - 1;
  };
  const char* dot = field.parent && field.name[0] ? "." : "";
  append(snprintf(out + used, capacity - used, "%s%s", dot, field.name));
  if (field.item != Field::kNoItem)
    append(snprintf(out + used, capacity - used, "[%u]", field.item));
  return used;
}

// FNV-1a over the names.
uint32_t pattern_of(const Field& field) {
  uint32_t hash = field.parent ? pattern_of(*field.parent) : 2166136261u;
  hash = (hash ^ '.') * 16777619u;
  for (const char* at = field.name; *at; ++at)
    hash = (hash ^ static_cast<uint8_t>(*at)) * 16777619u;
  return hash;
}

// Controls are numbered raw, PSD, ML, RBF. Without RBF pose controls a number past the others may
// be that of one whose layer was not loaded, or was lost when the file was written for an old
// version: such a control stays 0.
uint32_t find_control_limit(const DnaView& view) {
  const bool counted = view.rbfe.pose_control_names.count != 0;
  return counted ? view.control_count() : 65536;
}

uint32_t find_first_lod(uint64_t lods) {
  uint32_t first = 0;
  while (lods != 0 && !(lods >> first & 1)) ++first;
  return first;
}

uint32_t find_end_lod(uint64_t lods) {
  if (lods == 0) return kAllLods;
  uint32_t end = 64;
  while (!(lods >> (end - 1) & 1)) --end;
  return end;
}

}  // namespace

Checker::Checker(const DnaView& dna, const FindingSink& sink, uint64_t lods)
    : view(dna), thorough(sink.thorough), control_limit(find_control_limit(dna)),
      first_lod(find_first_lod(lods)), end_lod(find_end_lod(lods)), sink_(sink) {}

// Findings --------------------------------------------------------------------------------------

void Checker::error(const Field& field, Status status, uint64_t offset, const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  add(field, status, offset, format, arguments);
  va_end(arguments);
}

void Checker::known_controls(const Field& field, const Array<uint16_t>& indices) {
  const uint32_t known = view.control_count();
  if (!thorough || control_limit <= known) return;
  for (uint32_t i = 0; i < indices.count && !stopped_; ++i) {
    if (indices[i] < known) continue;
    warning(field, offset(indices, i), "element %u is %u, but there are %u controls: it stays 0", i,
            unsigned{indices[i]}, known);
  }
}

void Checker::warning(const Field& field, uint64_t offset, const char* format, ...) {
  if (!thorough) return;
  va_list arguments;
  va_start(arguments, format);
  add(field, Status::kOk, offset, format, arguments);
  va_end(arguments);
}

void Checker::add(const Field& field, Status status, uint64_t offset, const char* format,
                  va_list list) {
  if (stopped_) return;
  Tally& tally = tally_of(field);
  if (++tally.count < kMaxFindings) {
    char path[200], message[200];
    spell(field, path, sizeof(path));
    vsnprintf(message, sizeof(message), format, list);
    send(status, offset, path, message);
    return;
  }
  if (tally.count == kMaxFindings) {
    tally.held_offset = offset;
    spell(field, tally.held_field, sizeof(tally.held_field));
    vsnprintf(tally.held_message, sizeof(tally.held_message), format, list);
  }
  if (tally.held_status == Status::kOk) tally.held_status = status;
}

void Checker::send(Status status, uint64_t offset, const char* field, const char* message) {
  if (!sink_.report(sink_.user, {status, offset, field, message})) stopped_ = true;
}

Checker::Tally& Checker::tally_of(const Field& field) {
  const uint32_t pattern = pattern_of(field);
  for (size_t i = 0; i < tally_count_; ++i) {
    if (tallies_[i].pattern == pattern) return tallies_[i];
  }
  if (tally_count_ == kTallies) return tallies_[kTallies - 1];  // all others share the last entry
  Tally& tally = tallies_[tally_count_++];
  tally = {};
  tally.pattern = pattern;
  return tally;
}

bool Checker::finish() {
  for (size_t i = 0; i < tally_count_ && !stopped_; ++i) {
    const Tally& tally = tallies_[i];
    if (tally.count < kMaxFindings) continue;
    const uint64_t held = tally.count - kMaxFindings + 1;
    char message[100];
    snprintf(message, sizeof(message), "from here on %llu more findings for this field",
             static_cast<unsigned long long>(held));
    send(tally.held_status, tally.held_offset, tally.held_field,
         held == 1 ? tally.held_message : message);
  }
  return !stopped_;
}

// Lengths ---------------------------------------------------------------------------------------

void Checker::wrong_length(const Field& field, uint64_t offset, uint64_t count, uint64_t expected,
                           const char* of) {
  error(field, Status::kDnaStructure, offset, "has %llu elements, but there are %llu %s",
        static_cast<unsigned long long>(count), static_cast<unsigned long long>(expected), of);
}

void Checker::equal_lengths(const Field& record, std::initializer_list<Length> arrays) {
  const Length& first = *arrays.begin();
  for (const Length& array : arrays) {
    if (array.count == first.count) continue;
    error(Field{&record, array.name}, Status::kDnaStructure, view.offset_of(array.data),
          "has %u elements, but %s has %u", array.count, first.name, first.count);
  }
}

void Checker::numbered(const Field& field, uint64_t count) {
  if (count <= 65535) return;
  error(field, Status::kDnaLimit, kNoOffset, "has %llu elements; at most 65535 can be numbered",
        static_cast<unsigned long long>(count));
}

void Checker::names(const Field& field, const List<String>& list) {
  numbered(field, list.count);
  if (!thorough) return;
  for (uint32_t i = 0; i < list.count; ++i) {
    const String& name = list[i];
    if (name.count == 0 || !memchr(name.data, 0, name.count)) continue;
    warning(Field{field.parent, field.name, i}, view.offset_of(name.data),
            "holds a NUL byte, where many programs end a string");
  }
}

// Numbers ---------------------------------------------------------------------------------------

void Checker::enumeration(const Field& field, uint64_t offset, unsigned value, unsigned last) {
  if (value <= last) return;
  error(field, Status::kDnaValue, offset, "is %u; valid values are 0 to %u", value, last);
}

void Checker::informative_enumeration(const Field& field, uint64_t offset, unsigned value,
                                      unsigned last) {
  if (value > last) warning(field, offset, "is %u; known values are 0 to %u", value, last);
}

void Checker::finite(const Field& field, const Array<float>& values) {
  if (!thorough) return;
  constexpr uint32_t kExponent = 0x7f800000;  // all ones in NaN and infinity only
  auto is_odd = [&](uint32_t i) {
    return (load_big_endian<uint32_t>(values.data + i * sizeof(float)) & kExponent) == kExponent;
  };
  for (uint32_t i = 0; i < values.count && !stopped_; ++i) {
    if (is_odd(i)) {
      warning(field, offset(values, i), "element %u is %g", i, static_cast<double>(values[i]));
    }
  }
}

void Checker::unique(const Field& field, const Array<uint16_t>& numbers, Status repeated) {
  if ((!thorough && repeated == Status::kOk) || numbers.count < 2) return;
  const auto report = [&](uint32_t i) {
    if (repeated == Status::kOk) {
      warning(field, offset(numbers, i), "element %u repeats %u", i, unsigned{numbers[i]});
    } else {
      error(field, repeated, offset(numbers, i), "element %u repeats %u", i, unsigned{numbers[i]});
    }
  };
  if (numbers.count <= 32) {  // marks take longer to clear than that
    for (uint32_t i = 1; i < numbers.count && !stopped_; ++i) {
      uint32_t k = 0;
      while (numbers[k] != numbers[i]) ++k;
      if (k != i) report(i);
    }
    return;
  }
  Marks seen;
  for (uint32_t i = 0; i < numbers.count && !stopped_; ++i) {
    if (seen.has(numbers[i])) report(i);
    seen.set(numbers[i]);
  }
}

// Shared records --------------------------------------------------------------------------------

void Checker::vectors(const Field& field, const Vec3Array& v) {
  equal_lengths(field, {length("xs", v.xs), length("ys", v.ys), length("zs", v.zs)});
  finite(Field{&field, "xs"}, v.xs);
  finite(Field{&field, "ys"}, v.ys);
  finite(Field{&field, "zs"}, v.zs);
}

void Checker::lod_map(const Field& field, const LodMap& map, uint32_t limit, const char* of,
                      Status repeated) {
  const Field lods{&field, "lods"};
  indices_below(lods, map.lods, map.indices.count, "lists");
  const bool nothing_to_list = limit == 0 && map.lods.count == 0;
  if (map.lods.count != view.desc.lod_count && !nothing_to_list) {
    warning(lods, offset(map.lods), "has %u entries for %u LODs", map.lods.count,
            unsigned{view.desc.lod_count});
  }
  const auto check_row = [&](uint32_t i) {
    if (i >= map.indices.count || stopped_) return;
    const Field row{&field, "indices", i};
    indices_below(row, map.indices[i], limit, of);
    unique(row, map.indices[i], repeated);
  };
  if (end_lod == kAllLods) {
    for (uint32_t i = 0; i < map.indices.count; ++i) check_row(i);
    return;
  }
  // LOD 0 tells which joints are of some LOD at all.
  if (first_lod != 0 && map.lods.count != 0) check_row(map.lods[0]);
  for (uint32_t l = first_lod; l < map.lods.count && l < end_lod; ++l) check_row(map.lods[l]);
}

void Checker::row_counts(const Field& field, const Array<uint16_t>& lods, uint32_t rows) {
  const unsigned lod_count = view.desc.lod_count;
  if (lods.count < lod_count && rows != 0) {
    error(field, Status::kDnaStructure, offset(lods), "has %u entries for %u LODs", lods.count,
          lod_count);
  } else if (lods.count != lod_count && lods.count != 0) {
    warning(field, offset(lods), "has %u entries for %u LODs", lods.count, lod_count);
  }
  const uint32_t end = lods.count < end_lod ? lods.count : end_lod;
  bool bad = false;
  for (uint32_t l = first_lod, limit = rows; l < end; ++l) {
    bad |= lods[l] > limit;
    limit = lods[l];
  }
  for (uint32_t l = first_lod; bad && l < end && !stopped_; ++l) {
    const unsigned used = lods[l];
    if (used > rows) {
      error(field, Status::kDnaStructure, offset(lods, l), "LOD %u uses %u rows, but there are %u",
            l, used, rows);
    } else if (l > 0 && used > lods[l - 1]) {
      error(field, Status::kDnaValue, offset(lods, l),
            "LOD %u uses %u rows, more than the finer LOD "
            "before it with %u",
            l, used, unsigned{lods[l - 1]});
    }
  }
  if (lods.count != 0 && lods[0] < rows) {
    warning(field, offset(lods), "no LOD uses the last %u of %u rows", rows - lods[0], rows);
  }
}

void Checker::conditionals(const Field& field, const ConditionalTable& t, uint32_t input_limit,
                           const char* inputs, uint32_t output_limit, const char* outputs) {
  equal_lengths(field,
                {length("inputIndices", t.input_indices), length("outputIndices", t.output_indices),
                 length("fromValues", t.from_values), length("toValues", t.to_values),
                 length("slopeValues", t.slope_values), length("cutValues", t.cut_values)});
  indices_below(Field{&field, "inputIndices"}, t.input_indices, input_limit, inputs);
  indices_below(Field{&field, "outputIndices"}, t.output_indices, output_limit, outputs);
  finite(Field{&field, "fromValues"}, t.from_values);
  finite(Field{&field, "toValues"}, t.to_values);
  finite(Field{&field, "slopeValues"}, t.slope_values);
  finite(Field{&field, "cutValues"}, t.cut_values);
}

}  // namespace mien::dna
