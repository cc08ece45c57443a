// SPDX-License-Identifier: MIT
// Finds shapes that are combinations, and pairs of expressions that would need one.
#include <algorithm>
#include <cstring>

#include "author/base/dna_making.h"
#include "author/fit/correctives.h"

namespace mien::author {

namespace {

int compare(Name a, Name b) {
  const size_t n = std::min(a.count, b.count);
  const int order = n > 0 ? memcmp(a.data, b.data, n) : 0;
  return order != 0 ? order : a.count < b.count ? -1 : a.count > b.count;
}

constexpr size_t kMaxLookups = 10000;  // for one name

/// Shapes by name.
struct Directory {
  Span<const Shape> shapes;
  Span<uint32_t> sorted;

  uint32_t find(Name name) const {
    const uint32_t* at = std::lower_bound(
        sorted.begin(), sorted.end(), name,
        [this](uint32_t s, Name wanted) { return compare(shapes[s].name, wanted) < 0; });
    return at != sorted.end() && compare(shapes[*at].name, name) == 0 ? *at : kNone;
  }
};

/// The shapes that `name` consists of, from its end; 0 if it is not made of two or more. Gives up
/// where names were made to be ambiguous in a great many ways.
size_t split(const Directory& directory, Name name, uint32_t (&members)[kMaxMembers]) {
  size_t ends[kMaxMembers + 1] = {name.count};
  size_t tried[kMaxMembers] = {name.count};  // where the search for the next part goes on
  size_t depth = 0, lookups = 0;
  const auto is_separator = [&](size_t i) { return name.data[i] == '_' || name.data[i] == '+'; };
  for (;;) {
    // The next start before the last one tried, of a part that ends at ends[depth].
    size_t start = tried[depth];
    uint32_t found = kNone;
    while (start > 0 && found == kNone) {
      --start;
      if (start > 0 && !is_separator(start - 1)) continue;
      if (start == 0 && depth == 0) continue;  // the whole name
      if (++lookups > kMaxLookups) return 0;
      found = directory.find({name.data + start, ends[depth] - start});
    }
    tried[depth] = start;
    if (found == kNone) {
      if (depth == 0) return 0;
      --depth;
      continue;
    }
    members[depth] = found;
    if (start == 0) return depth + 1;
    if (depth + 1 == kMaxMembers || start < 2) continue;
    ++depth;
    ends[depth] = tried[depth] = start - 1;
  }
}

bool same_members(Span<const uint32_t> a, Span<const uint32_t> b) {
  return a.count == b.count && std::equal(a.begin(), a.end(), b.begin());
}

}  // namespace

bool find_combinations(Span<const Shape> shapes, Arena& arena, Span<Shape>& expressions,
                       Span<Combination>& combinations) {
  Directory directory = {shapes, {}};
  Span<uint32_t> number;  // of an expression; kNone: a combination
  if (!make(arena, shapes.count, directory.sorted) || !make(arena, shapes.count, number) ||
      !make(arena, shapes.count, expressions) || !make(arena, shapes.count, combinations)) {
    return false;
  }
  for (uint32_t s = 0; s < shapes.count; ++s) directory.sorted[s] = s;
  std::sort(directory.sorted.begin(), directory.sorted.end(), [&](uint32_t a, uint32_t b) {
    const int order = compare(shapes[a].name, shapes[b].name);
    return order != 0 ? order < 0 : a < b;
  });
  uint32_t members[kMaxMembers];
  for (size_t s = 0; s < shapes.count; ++s) {
    number[s] = split(directory, shapes[s].name, members) > 1 ? kNone : 0;
  }
  size_t expression_count = 0, count = 0;
  for (size_t s = 0; s < shapes.count; ++s) {
    const size_t parts = number[s] == kNone ? split(directory, shapes[s].name, members) : 0;
    Span<uint32_t> list;
    if (!make(arena, parts, list)) return false;
    bool usable = parts > 0;
    for (size_t i = 0; i < parts; ++i) {
      list[i] = members[i];
      usable = usable && number[members[i]] != kNone;
    }
    std::sort(list.begin(), list.end());
    for (size_t i = 1; i < parts; ++i) usable = usable && list[i] != list[i - 1];
    for (size_t c = 0; c < count; ++c) {
      usable = usable && !same_members(combinations[c].members, list);
    }
    if (usable) {
      combinations[count++] = {shapes[s].name, list, shapes[s].displacements};
    } else {
      number[s] = static_cast<uint32_t>(expression_count);
      expressions[expression_count++] = shapes[s];
    }
  }
  expressions.count = expression_count;
  combinations.count = count;
  for (size_t c = 0; c < count; ++c) {
    Span<uint32_t> list;
    if (!make(arena, combinations[c].members.count, list)) return false;
    for (size_t i = 0; i < list.count; ++i) list[i] = number[combinations[c].members[i]];
    combinations[c].members = list;
  }
  // Insertion keeps the order of equal ones.
  for (size_t i = 1; i < count; ++i) {
    for (size_t k = i; k > 0; --k) {
      if (combinations[k - 1].members.count <= combinations[k].members.count) break;
      std::swap(combinations[k - 1], combinations[k]);
    }
  }
  return true;
}

bool add_overlaps(const AuthorMesh& mesh, uint32_t limit, const ParallelFor& parallel, Arena& arena,
                  Arena& scratch, Span<Combination>& combinations) {
  const size_t shapes = mesh.shapes.count;
  struct Pair {
    double strength = 0;
    uint32_t first = 0, second = 0;
  };
  Span<double> energies, overlaps;  // [first * shapes + second]
  Span<Pair> pairs;
  if (!make(scratch, shapes, energies) || !make(scratch, shapes * shapes, overlaps)) return false;
  struct Task {
    Span<const Shape> shapes;
    Span<double> energies, overlaps;
  } task = {mesh.shapes, energies, overlaps};
  run_tasks(
      parallel, static_cast<uint32_t>(shapes),
      [](void* context, uint32_t a) {
        const Task& t = *static_cast<const Task*>(context);
        for (uint32_t b = a; b < t.shapes.count; ++b) {
          double sum = 0;
          for (const uint32_t v : t.shapes[a].moving) {
            const Vec3f x = t.shapes[a].displacements[v], y = t.shapes[b].displacements[v];
            sum += std::max(0.0, double{x.x} * double{y.x} + double{x.y} * double{y.y} +
                                     double{x.z} * double{y.z});
          }
          (a == b ? t.energies[a] : t.overlaps[a * t.shapes.count + b]) = sum;
        }
      },
      &task);
  const auto qualifies = [&](size_t a, size_t b) {
    return overlaps[a * shapes + b] > 0.15 * std::min(energies[a], energies[b]);
  };
  size_t count = 0;
  for (size_t a = 0; a < shapes; ++a) {
    for (size_t b = a + 1; b < shapes; ++b) count += qualifies(a, b);
  }
  if (!make(scratch, count, pairs)) return false;
  count = 0;
  for (uint32_t a = 0; a < shapes; ++a) {
    for (uint32_t b = a + 1; b < shapes; ++b) {
      if (!qualifies(a, b)) continue;
      const uint32_t members[2] = {a, b};
      bool is_given = false;
      for (const Combination& c : combinations) {
        is_given = is_given || same_members(c.members, {members, 2});
      }
      if (!is_given) pairs[count++] = {overlaps[a * shapes + b], a, b};
    }
  }
  std::sort(pairs.begin(), pairs.begin() + count, [](const Pair& x, const Pair& y) {
    if (x.strength != y.strength) return x.strength > y.strength;
    return x.first != y.first ? x.first < y.first : x.second < y.second;
  });
  count = std::min<size_t>(count, limit);

  // Pairs come before combinations of three or more.
  Span<Combination> all;
  if (!make(arena, combinations.count + count, all)) return false;
  size_t used = 0, next = 0;
  while (next < combinations.count && combinations[next].members.count == 2) {
    all[used++] = combinations[next++];
  }
  for (size_t i = 0; i < count; ++i) {
    Span<uint32_t> members;
    if (!make(arena, 2, members)) return false;
    members[0] = pairs[i].first;
    members[1] = pairs[i].second;
    all[used++].members = members;
  }
  while (next < combinations.count) all[used++] = combinations[next++];
  combinations = all;
  return true;
}

}  // namespace mien::author
