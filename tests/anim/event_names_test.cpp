// SPDX-License-Identifier: MIT
#include "runtime/anim/event_names.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/counting_allocator.h"

namespace mien {
namespace {

std::string as_text(Span<const char> name) { return {name.data, name.count}; }

struct Listed {
  Arena arena{default_allocator()};
  std::vector<ClipEventDesc> events;
  ClipDesc desc;

  explicit Listed(const std::vector<std::string>& names) : events(names.size()) {
    std::vector<Span<const char>> views;
    for (const std::string& name : names) views.push_back({name.data(), name.size()});
    EXPECT_TRUE(list_event_names({views.data(), views.size()}, {events.data(), events.size()},
                                 arena, desc));
    // Each event still has its name, and each name is there once, in order.
    EXPECT_EQ(desc.events.count, names.size());
    for (size_t e = 0; e < names.size(); ++e) {
      EXPECT_EQ(as_text(desc.event_names[desc.events[e].name]), names[e]);
    }
    for (size_t n = 1; n < desc.event_names.count; ++n) {
      EXPECT_LT(as_text(desc.event_names[n - 1]), as_text(desc.event_names[n]));
    }
  }
};

TEST(EventNames, AreListedOnceAndSorted) {
  EXPECT_EQ(Listed({"blink", "step", "blink", "aha", "step", "blink"}).desc.event_names.count, 3u);
  EXPECT_EQ(Listed({"a", "ab", "", "b", "aa"}).desc.event_names.count, 5u);
  EXPECT_EQ(Listed({std::string("a\0b", 3), std::string("a\0c", 3), "a"}).desc.event_names.count,
            3u);
  EXPECT_EQ(Listed(std::vector<std::string>(1000, "same")).desc.event_names.count, 1u);
}

TEST(EventNames, NoEventsHaveNone) { EXPECT_TRUE(Listed({}).desc.event_names.empty()); }

TEST(EventNames, FailWithoutMemory) {
  for (size_t fail_at : {1, 2}) {
    CountingAllocator counting;
    counting.fail_at = fail_at;
    const MienAllocator given = counting.get();
    Allocator allocator = {given.user, given.allocate, given.release};
    allocator.arena_chunk = 0;
    {
      Arena arena(allocator);
      const Span<const char> names[] = {{"a", 1}};
      ClipEventDesc events[1] = {};
      ClipDesc desc;
      EXPECT_FALSE(list_event_names({names, 1}, {events, 1}, arena, desc));
      EXPECT_TRUE(desc.event_names.empty());
    }
    EXPECT_TRUE(counting.clean());
  }
}

}  // namespace
}  // namespace mien
