// SPDX-License-Identifier: MIT
// The order of names, and finding one of them by its bytes or as clips do.
#include "runtime/anim/control_names.h"

#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <vector>

namespace mien {
namespace {

Span<const char> span(const std::string& text) { return {text.data(), text.size()}; }

int sign(int number) { return (number > 0) - (number < 0); }

TEST(CompareNames, IsTheOrderOfBytes) {
  const std::string names[] = {"", "A", "Aa", "B", "a", std::string("a\0", 2), "ab", "\xC3\xA4"};
  for (size_t i = 0; i < std::size(names); ++i) {
    for (size_t k = 0; k < std::size(names); ++k) {
      EXPECT_EQ(sign(compare_names(span(names[i]), span(names[k]))), i < k ? -1 : i > k) << i << k;
    }
  }
  EXPECT_EQ(compare_names({}, {nullptr, 0}), 0);
}

/// ListedNames as rigs keep them.
struct ListedNames {
  std::vector<std::string> names;
  std::vector<uint32_t> first = {0}, sorted;
  std::string chars;

  explicit ListedNames(std::vector<std::string> given)
      : names(std::move(given)), sorted(names.size()) {
    for (const std::string& name : names) {
      chars += name;
      first.push_back(static_cast<uint32_t>(chars.size()));
    }
    std::iota(sorted.begin(), sorted.end(), 0u);
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](uint32_t a, uint32_t b) { return names[a] < names[b]; });
  }
  NameList list() {
    return {
        {first.data(), first.size()}, {&chars[0], chars.size()}, {sorted.data(), sorted.size()}};
  }
};

TEST(FindName, FindsEachNameAndNoOther) {
  ListedNames names({"jawOpen", "", "browUp", "jaw", "jawOpenExtreme", "browUp", "\xFFz"});
  const NameList list = names.list();
  const uint32_t expected[] = {0, 1, 2, 3, 4, 2, 6};  // the first of those alike
  for (uint32_t i = 0; i < names.names.size(); ++i) {
    EXPECT_EQ(find_name(list, span(names.names[i])), expected[i]) << i;
  }
  for (const char* other : {"jawOpe", "JawOpen", "jawOpenE", "a", "zz", "\xFFzz"}) {
    EXPECT_EQ(find_name(list, span(std::string(other))), kNoName) << other;
  }
  EXPECT_EQ(find_name({}, span(std::string("a"))), kNoName);
}

TEST(NameIndex, MatchesWithoutCaseDotsAndPrefix) {
  ListedNames names({"CTRL_expressions.jawOpen", "mouth_Left", "MOUTH.LEFT", "single"});
  const RigNames rig_names = {names.list()};
  std::vector<uint16_t> order(names.names.size());
  NameIndex<RigNames> index = {rig_names, {order.data(), order.size()}};
  index.sort();
  const auto find = [&](const std::string& name) { return index.find(span(name)); };
  EXPECT_EQ(find("jawopen"), 0u);
  EXPECT_EQ(find("ctrl_expressions_JAWOPEN"), 0u);
  EXPECT_EQ(find("mouth_Left"), 1u) << "equal";
  EXPECT_EQ(find("mouth.left"), kNoName) << "two match, and none is equal";
  EXPECT_EQ(find("CTRL_expressions.single"), 3u);
  EXPECT_EQ(find("none"), kNoName);
}

}  // namespace
}  // namespace mien
