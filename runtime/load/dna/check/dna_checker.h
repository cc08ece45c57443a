// SPDX-License-Identifier: MIT
// Shared by the checks of all layers: paths in messages, a limit on repeated findings, and common
// comparisons. A valid file costs one tight loop per array; everything else runs only after a finding.
#pragma once

#include <cstdarg>
#include <initializer_list>

#include "runtime/load/dna/format/dna_view.h"
#include "runtime/load/dna/format/findings.h"

namespace mien::dna {

/// A field of a view. Chains live on the stack and cost nothing until the path is written out:
///
///     const Field group{&joints, "jointGroups", 3};
///     Field{&group, "values"}                        bhvr.joints.jointGroups[3].values
struct Field {
  static constexpr uint32_t kNoItem = ~uint32_t{0};

  const Field* parent = nullptr;
  const char* name = "";    // "" for the inner index of a list of lists
  uint32_t item = kNoItem;  // number within the list `name`
};

/// One array of a record, to be compared in length with others.
struct Length {
  const char* name;
  uint32_t count;
  const uint8_t* data;
};
template <class T>
Length length(const char* name, const Array<T>& array) {
  return {name, array.count, array.data};
}

/// One bit for each 16-bit number.
struct Marks {
  uint64_t words[1024] = {};

  bool has(uint16_t i) const { return words[i / 64] >> (i % 64) & 1; }
  void set(uint16_t i) { words[i / 64] |= uint64_t{1} << (i % 64); }
  void set_all(Array<uint16_t> numbers) {
    for (uint32_t i = 0; i < numbers.count; ++i) set(numbers[i]);
  }
};

constexpr uint32_t kAllLods = ~uint32_t{0};

class Checker {
 public:
  /// `lods` are those that will be selected (bit l for LOD l); 0: all.
  Checker(const DnaView& dna, const FindingSink& sink, uint64_t lods);

  const DnaView& view;
  const bool thorough;
  const uint32_t control_limit;       // first number that no control can have
  const uint32_t first_lod, end_lod;  // other LODs are not checked; end_lod may be kAllLods

  /// The sink has stopped the examination.
  bool stopped() const { return stopped_; }

  /// Reports the findings that were held back by the limit. False if the sink ended the examination.
  bool finish();

  MIEN_PRINTF(5, 6)
  void error(const Field& field, Status status, uint64_t offset, const char* format, ...);

  /// Does nothing unless the examination is thorough.
  MIEN_PRINTF(4, 5)
  void warning(const Field& field, uint64_t offset, const char* format, ...);

  // Offsets in the file -------------------------------------------------------------------------

  template <class T>
  uint64_t offset(const Array<T>& array, size_t i = 0) const {
    return view.offset_of(array.data + i * sizeof(T));
  }
  /// Of the number that follows an array or string.
  template <class T>
  uint64_t offset_after(const Array<T>& array) const {
    return view.offset_of(array.data + array.byte_count());
  }
  uint64_t offset_after(const String& string) const {
    return view.offset_of(string.data + string.count);
  }

  // Lengths -------------------------------------------------------------------------------------

  /// Reports an error if any is not as long as the first.
  void equal_lengths(const Field& record, std::initializer_list<Length> arrays);

  template <class T>
  void has_length(const Field& field, const Array<T>& array, uint64_t expected, const char* of) {
    if (array.count != expected) wrong_length(field, offset(array), array.count, expected, of);
  }

  /// Lists whose elements have 16-bit numbers.
  void numbered(const Field& field, uint64_t count);
  void names(const Field& field, const List<String>& list);

  // Numbers -------------------------------------------------------------------------------------

  /// Indices into something that has `limit` elements.
  template <class T>
  void indices_below(const Field& field, const Array<T>& indices, uint32_t limit, const char* of) {
    if (limit > static_cast<T>(~T{0})) return;
    const auto end = static_cast<T>(limit);
    T bad = 0;  // as wide as the numbers, which vectorizes well
    for (uint32_t i = 0; i < indices.count; ++i) bad |= static_cast<T>(indices[i] >= end);
    if (bad == 0) return;
    for (uint32_t i = 0; i < indices.count && !stopped_; ++i) {
      if (indices[i] < limit) continue;
      error(field, Status::kDnaReference, offset(indices, i),
            "element %u is %u, but there are %u %s", i, unsigned{indices[i]}, limit, of);
    }
  }

  /// Warns of controls that no loaded layer writes. Thorough only.
  void known_controls(const Field& field, const Array<uint16_t>& indices);

  /// Numbers of an enumeration 0 ... last. Those that evaluation branches on are errors; those that
  /// only inform are warnings.
  void enumeration(const Field& field, uint64_t offset, unsigned value, unsigned last);
  void informative_enumeration(const Field& field, uint64_t offset, unsigned value, unsigned last);

  /// Warns of NaN and infinity. Reads every number: thorough only.
  void finite(const Field& field, const Array<float>& values);

  /// Reports numbers that come up twice: with `repeated`, or as warnings, if thorough, for kOk.
  void unique(const Field& field, const Array<uint16_t>& numbers, Status repeated = Status::kOk);

  // Shared records ------------------------------------------------------------------------------

  /// Three equal lengths, finite.
  void vectors(const Field& field, const Vec3Array& vectors);
  void lod_map(const Field& field, const LodMap& map, uint32_t limit, const char* of,
               Status repeated = Status::kOk);
  /// `lods` says how many of `rows` rows each LOD uses: an entry per LOD, none larger than `rows`,
  /// none larger than the one before (LOD selection keeps the rows of the finest chosen LOD).
  void row_counts(const Field& field, const Array<uint16_t>& lods, uint32_t rows);
  void conditionals(const Field& field, const ConditionalTable& table, uint32_t input_limit,
                    const char* inputs, uint32_t output_limit, const char* outputs);

 private:
  // A field of a list counts once for the whole list here, so that a million broken vertices do not
  // make a million findings.
  struct Tally {
    uint32_t pattern;  // hash of the path without its numbers
    uint64_t count;
    Status held_status;    // error if any of those held back is one
    uint64_t held_offset;  // of the first held back
    char held_field[104];
    char held_message[120];
  };
  static constexpr uint64_t kMaxFindings = 32;  // per tally, with the summary
  static constexpr size_t kTallies = 96;

  void wrong_length(const Field& field, uint64_t offset, uint64_t count, uint64_t expected,
                    const char* of);
  MIEN_PRINTF(5, 0)
  void add(const Field& field, Status status, uint64_t offset, const char* format, va_list list);
  void send(Status status, uint64_t offset, const char* field, const char* message);
  Tally& tally_of(const Field& field);

  const FindingSink& sink_;
  bool stopped_ = false;
  size_t tally_count_ = 0;
  Tally tallies_[kTallies];  // not initialized past the count: valid files need none of them
};

/// jbmd, twsw, rbfb and rbfe, mlbh and mlbe: the layers whose numbers refer to controls and joints
/// but not to each other's insides.
void check_extensions(Checker& c);

}  // namespace mien::dna
