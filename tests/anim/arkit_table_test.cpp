// SPDX-License-Identifier: MIT
// The table of ARKit expressions, bound to a rig with the controls that it names.
#include "runtime/anim/arkit_table.h"

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <set>

#include "runtime/anim/binding.h"
#include "tests/support/made_clip.h"

namespace mien {
namespace {

using Shares = std::map<std::string, float>;

/// What each expression moves, alone and at 1, on a rig with the controls of the table and those
/// that both namings share.
std::map<std::string, Shares> driven() {
  std::set<std::string> expressions = {"jawOpen",   "jawLeft",    "jawRight",
                                       "mouthLeft", "mouthRight", "tongueOut"};
  std::set<std::string> controls = expressions;
  std::vector<MatrixEntry> matrix;
  for (const ArkitEntry& entry : arkit_table()) {
    expressions.insert(entry.expression);
    controls.insert(entry.control);
    matrix.push_back({{entry.expression, strlen(entry.expression)},
                      {entry.control, strlen(entry.control)},
                      entry.weight});
  }
  std::string chars;
  std::vector<uint32_t> ends = {0};
  const std::vector<std::string> names(controls.begin(), controls.end());
  for (const std::string& name : names) {
    chars += "CTRL_expressions." + name;
    ends.push_back(static_cast<uint32_t>(chars.size()));
  }
  Rig rig;
  rig.raw_count = static_cast<uint32_t>(names.size());
  rig.names[static_cast<size_t>(Kind::kRawControl)] = {
      {ends.data(), ends.size()}, {&chars[0], chars.size()}, {}};
  ClipInput input(Curves(static_cast<uint32_t>(expressions.size()), 1));
  input.names.assign(expressions.begin(), expressions.end());
  const MadeClip made(input);
  Binding* binding = nullptr;
  Error error;
  EXPECT_EQ(bind_clip(made.clip, rig, {matrix.data(), matrix.size()}, default_allocator(), binding,
                      error),
            Status::kOk);
  EXPECT_EQ(binding->missing_channels.count + binding->missing_entries, 0u);
  EXPECT_EQ(binding->extra_controls.count, 0u);
  std::map<std::string, Shares> found;
  for (size_t e = 0; e < input.names.size(); ++e) {
    std::vector<float> values(input.names.size()), raw(names.size());
    values[e] = 1;
    float gui = 0;
    apply_binding(*binding, {values.data(), values.size()}, {&gui, 1}, {raw.data(), raw.size()});
    for (size_t c = 0; c < names.size(); ++c) {
      if (raw[c] != 0) found[input.names[e]][names[c]] = raw[c];
    }
  }
  release(binding);
  return found;
}

TEST(ArkitTable, HasAll52AndEachOnItsOwnSide) {
  const std::map<std::string, Shares> shares = driven();
  EXPECT_EQ(shares.size(), 52u);
  for (const auto& entry : shares) {
    const bool left = entry.first.find("Left") != std::string::npos;
    const bool right = entry.first.find("Right") != std::string::npos;
    std::string other = entry.first;
    if (left) other.replace(other.find("Left"), 4, "Right");
    if (right) other.replace(other.find("Right"), 5, "Left");
    EXPECT_EQ(shares.count(other), 1u) << other;
    if (!left && !right) continue;
    EXPECT_EQ(shares.at(other).size(), entry.second.size()) << entry.first;
    for (const auto& share : entry.second) {
      if (share.first == entry.first) continue;  // jawLeft and the like
      EXPECT_EQ(share.first.back(), left ? 'L' : 'R') << entry.first << " moves " << share.first;
    }
  }
}

TEST(ArkitTable, MovesWhatTheNamesMean) {
  const std::map<std::string, Shares> shares = driven();
  EXPECT_EQ(shares.at("mouthSmileLeft"), (Shares{{"mouthCornerPullL", 1}}));
  EXPECT_EQ(shares.at("eyeLookInLeft"), (Shares{{"eyeLookRightL", 1}})) << "towards the nose";
  EXPECT_EQ(shares.at("eyeLookInRight"), (Shares{{"eyeLookLeftR", 1}}));
  EXPECT_EQ(shares.at("jawOpen"), (Shares{{"jawOpen", 1}}));
  EXPECT_EQ(shares.at("mouthPucker").at("mouthFunnelUL"), 0.75f);
}

}  // namespace
}  // namespace mien
