// SPDX-License-Identifier: MIT
#include "author/place/linkage.h"

#include <algorithm>

#include "author/base/dna_making.h"

namespace mien::author {

namespace {

/// An interval of points, named by its first one.
struct Group {
  double sum, weight;
  uint32_t next;      // first point of the group above, or the number of points
  uint32_t previous;  // of the group below; of the lowest, itself
  uint32_t version;   // counts changes: earlier pairs with it are stale

  double mean() const { return sum / weight; }
};

struct Pair {
  double distance;
  uint32_t left, right;
  uint32_t left_version, right_version;

  bool operator<(const Pair& other) const {
    return distance != other.distance ? distance < other.distance : left < other.left;
  }
};

struct Linking {
  Span<Group> groups;
  Span<Pair> heap;
  size_t heap_count = 0;

  static bool later(const Pair& a, const Pair& b) { return b < a; }

  void push(uint32_t left, uint32_t right) {
    const Group &a = groups[left], &b = groups[right];
    heap[heap_count++] = {b.mean() - a.mean(), left, right, a.version, b.version};
    std::push_heap(heap.data, heap.data + heap_count, later);
  }
  Pair pop() {
    std::pop_heap(heap.data, heap.data + heap_count, later);
    return heap[--heap_count];
  }
  /// Neither group has changed since. A group that merged into the one below has another version.
  bool valid(const Pair& pair) const {
    return groups[pair.left].version == pair.left_version &&
           groups[pair.right].version == pair.right_version;
  }
};

}  // namespace

bool link_on_line(Span<const double> values, Span<const double> weights, Arena& arena,
                  Arena& scratch, Linkage& out) {
  const uint32_t n = static_cast<uint32_t>(values.count);
  Linking linking;
  // Every merge makes two pairs.
  if (!make(arena, n, out.order) || !make(arena, n - 1, out.merges) ||
      !make(scratch, n, linking.groups) || !make(scratch, size_t{3} * n, linking.heap)) {
    return false;
  }
  for (uint32_t i = 0; i < n; ++i) out.order[i] = i;
  std::sort(out.order.begin(), out.order.end(), [&](uint32_t a, uint32_t b) {
    return values[a] != values[b] ? values[a] < values[b] : a < b;
  });
  // Means are relative to the lowest value, so that they stay precise far from the origin.
  const double lowest = values[out.order[0]];
  for (uint32_t i = 0; i < n; ++i) {
    const double weight = weights.empty() ? 1 : weights[out.order[i]];
    linking.groups[i] = {(values[out.order[i]] - lowest) * weight, weight, i + 1, i ? i - 1 : 0, 0};
  }
  for (uint32_t i = 0; i + 1 < n; ++i) linking.push(i, i + 1);

  for (uint32_t merged = 0; merged + 1 < n;) {
    const Pair pair = linking.pop();
    if (!linking.valid(pair)) continue;
    Group &left = linking.groups[pair.left], &right = linking.groups[pair.right];
    out.merges[merged++] = {pair.distance, pair.right};
    left.sum += right.sum;
    left.weight += right.weight;
    left.next = right.next;
    ++left.version;
    ++right.version;
    if (left.next < n) {
      linking.groups[left.next].previous = pair.left;
      linking.push(pair.left, left.next);
    }
    if (pair.left > 0) linking.push(left.previous, pair.left);
  }
  return true;
}

void Linkage::group_starts(uint32_t count, uint32_t* out) const {
  out[0] = 0;
  // The remaining boundaries are those of the merges that were not done.
  for (uint32_t i = 1; i < count; ++i) out[i] = merges[merges.count - i].boundary;
  std::sort(out + 1, out + count);
}

}  // namespace mien::author
