// SPDX-License-Identifier: MIT
// Copies of arrays with new numbers, for passes that change a view. Unchanged arrays are not copied:
// they stay in the file.
#pragma once

#include <cfloat>
#include <cmath>

#include "runtime/base/coordinate_system.h"
#include "runtime/base/status.h"
#include "runtime/load/dna/format/dna_schema.h"
#include "runtime/load/dna/format/dna_view.h"

namespace mien::dna {

/// value * factor, rounded once; what would overflow is the largest number there is. A factor of 1
/// or -1 keeps all bits but the sign.
inline float scaled(float value, double factor) {
  if (factor == 1) return value;
  if (factor == -1) return -value;
  const double product = value * factor;
  if (std::isfinite(value) && std::fabs(product) > double{FLT_MAX}) {
    return product < 0 ? -FLT_MAX : FLT_MAX;
  }
  return static_cast<float>(product);
}

/// New arrays are empty once memory has run out. Those that have the numbers of an old one in their
/// order get its offset in the file, for messages.
class ConvertedArrays {
 public:
  ConvertedArrays(DnaView& view, Arena& arena)
      : view_(view), file_segments_(view.segments), arena_(arena) {}

  bool out_of_memory() const { return out_of_memory_; }
  /// Records that memory ran out; the pass reports it at its end.
  Status run_out() {
    out_of_memory_ = true;
    return Status::kOk;
  }

  /// `data` is null if memory ran out or count is 0.
  template <class T>
  NewArray<T> room(size_t count) {
    const NewArray<T> array = new_array<T>(arena_, count);
    if (count == 0 || array.data) return array;
    out_of_memory_ = true;
    return {};
  }

  /// f(i) for each i.
  template <class T, class F>
  Array<T> make(size_t count, F&& f) {
    const NewArray<T> array = room<T>(count);
    for (uint32_t i = 0; i < array.count; ++i) array.set(i, f(i));
    return array;
  }

  /// The same, where number i takes the place of old[i].
  template <class T, class F>
  Array<T> remake(const Array<T>& old, F&& f) {
    const Array<T> array = make<T>(old.count, f);
    keep_offset(array, old);
    return array;
  }

  template <class T>
  void keep_offset(const Array<T>& array, const Array<T>& old) {
    // Looked up in the file alone: the list of arrays grows with each of them.
    const uint64_t offset = view_.offset_of(old.data, file_segments_);
    if (!array.data || offset == kNoOffset) return;
    const Span<FileSegment> segment = arena_.array<FileSegment>(1);
    if (!segment.data) return void(run_out());
    segment[0] = {array.data, offset, array.count * sizeof(T), view_.segments};
    view_.segments = segment.data;
  }

  /// f(number) for each number.
  template <class T, class F>
  Array<T> map(const Array<T>& old, F&& f) {
    return remake(old, [&](uint32_t i) { return f(old[i]); });
  }

  /// The same, but `old` itself if all numbers stay.
  template <class T, class F>
  Array<T> map_if_new(const Array<T>& old, F&& f) {
    for (uint32_t i = 0; i < old.count; ++i) {
      if (f(old[i]) != old[i]) return map(old, f);
    }
    return old;
  }

  Array<float> times(const Array<float>& old, double factor) {
    if (factor == 1) return old;
    return map(old, [factor](float value) { return scaled(value, factor); });
  }

  /// Positions, translations and deltas.
  Vec3Array vectors(const Vec3Array& old, const CoordinateChange& change) {
    const Array<float>* parts[3] = {&old.xs, &old.ys, &old.zs};
    return {times(*parts[change.from[0]], change.vector[0]),
            times(*parts[change.from[1]], change.vector[1]),
            times(*parts[change.from[2]], change.vector[2])};
  }

  /// Normals: no unit.
  Vec3Array directions(const Vec3Array& old, const CoordinateChange& change) {
    CoordinateChange turn = change;
    for (int d = 0; d < 3; ++d) turn.vector[d] = static_cast<double>(change.normal[d]);
    return vectors(old, turn);
  }

 private:
  DnaView& view_;
  const FileSegment* file_segments_;  // of what was read, none of what was made here
  Arena& arena_;
  bool out_of_memory_ = false;
};

}  // namespace mien::dna
