// SPDX-License-Identifier: MIT
#include "runtime/anim/event_names.h"

#include <algorithm>

#include "runtime/anim/clip.h"

namespace mien {

bool list_event_names(Span<const Span<const char>> names, Span<ClipEventDesc> events, Arena& arena,
                      ClipDesc& desc) {
  const Span<uint32_t> by_name = arena.unwritten_array<uint32_t>(names.count);
  Span<Span<const char>> listed = arena.array<Span<const char>>(names.count);
  if (by_name.count != names.count || listed.count != names.count) return false;
  for (uint32_t e = 0; e < by_name.count; ++e) by_name[e] = e;
  std::sort(by_name.begin(), by_name.end(),
            [&](uint32_t a, uint32_t b) { return compare_names(names[a], names[b]) < 0; });
  uint32_t count = 0;
  for (uint32_t e : by_name) {
    if (count == 0 || compare_names(listed[count - 1], names[e]) != 0) listed[count++] = names[e];
    events[e].name = count - 1;
  }
  desc.events = events;
  desc.event_names = listed.first(count);
  return true;
}

}  // namespace mien
