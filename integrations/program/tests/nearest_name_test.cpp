// SPDX-License-Identifier: MIT
#include "integrations/program/io/nearest_name.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace mien::cli {
namespace {

std::string nearest(const std::string& name, const std::vector<std::string>& candidates) {
  return nearest_question(name, candidates, "none");
}

TEST(NearestName, FindsSlipsOfTheHand) {
  const std::vector<std::string> names = {"CTRL_expressions.jawOpen", "browInnerUp",
                                          "mouthSmileLeft"};
  EXPECT_EQ(nearest("jawopen", names), "did you mean \"CTRL_expressions.jawOpen\"?");
  EXPECT_EQ(nearest("jwaOpen", names), "did you mean \"CTRL_expressions.jawOpen\"?");
  EXPECT_EQ(nearest("browInerUp", names), "did you mean \"browInnerUp\"?");
  EXPECT_EQ(nearest("mouthSmileLeftt", names), "did you mean \"mouthSmileLeft\"?");
  EXPECT_EQ(nearest("mouthSmlieLfet", names), "did you mean \"mouthSmileLeft\"?");
  EXPECT_EQ(nearest("noseSneer", names), "none");
  EXPECT_EQ(nearest("", names), "none");
  EXPECT_EQ(nearest("jaw", {}), "none");
}

/// Without a limit and with the whole table, as the textbook has it.
size_t plain_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<size_t>> d(a.size() + 1, std::vector<size_t>(b.size() + 1));
  for (size_t i = 0; i <= a.size(); ++i) {
    for (size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] =
          std::min({d[i - 1][j - 1] + (a[i - 1] != b[j - 1]), d[i - 1][j] + 1, d[i][j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
      }
    }
  }
  return d[a.size()][b.size()];
}

TEST(NearestName, IsTheNearestOfThoseThatAreNear) {
  std::mt19937 random(1);
  const auto word = [&](size_t longest) {
    std::string text(random() % (longest + 1), 'a');
    for (char& c : text) c = static_cast<char>('a' + random() % 3);
    return text;
  };
  size_t found = 0;
  for (int round = 0; round < 5000; ++round) {
    const std::string name = word(24);
    std::vector<std::string> candidates;
    for (int i = 0; i < 6; ++i) candidates.push_back(word(24));
    std::string expected = "none";
    size_t best = std::min<size_t>(name.size() / 4, 5) + 2;
    for (const std::string& candidate : candidates) {
      if (candidate.empty() || plain_distance(name, candidate) >= best) continue;
      best = plain_distance(name, candidate);
      expected = "did you mean \"" + candidate + "\"?";
    }
    candidates.erase(std::remove(candidates.begin(), candidates.end(), ""), candidates.end());
    ASSERT_EQ(nearest(name, candidates), expected) << name;
    found += expected != "none";
  }
  EXPECT_GT(found, 300u);
}

// A file of 1 MB can be one name, and a rig has 65,535 of them.
TEST(NearestName, TakesStepsInProportionToTheLetters) {
  NearestName endless(std::string(1 << 20, 'x'));
  for (int i = 0; i < 1000; ++i) endless.offer(std::string(1 << 20, 'x'));
  EXPECT_EQ(endless.steps(), 0u) << "nobody mistypes that";

  constexpr size_t kLetters = 1000, kCandidates = 1000, kWidth = 2 * 7;
  NearestName longest(std::string(kLetters, 'x'));
  for (size_t i = 0; i < kCandidates; ++i) longest.offer(std::string(kLetters, 'y'));
  EXPECT_GE(longest.steps(), kCandidates * kLetters) << "all are compared";
  EXPECT_LE(longest.steps(), kCandidates * kLetters * kWidth);
}

}  // namespace
}  // namespace mien::cli
