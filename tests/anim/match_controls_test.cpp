// SPDX-License-Identifier: MIT
#include "runtime/anim/match_controls.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "runtime/anim/arkit_table.h"
#include "runtime/anim/control_aliases.h"

namespace mien {
namespace {

Span<const char> span_of(const std::string& text) { return {text.data(), text.size()}; }

std::string usual(const std::string& name) {
  char text[kMostKnownName];
  return {text, write_known_name(know_control(spell_control(span_of(name))), text)};
}

std::string spelled(const std::string& name) {
  const ControlSpelling spelling = spell_control(span_of(name));
  const char* const sides[] = {"", "<", ">"};
  return std::string(spelling.text, spelling.count) + sides[static_cast<size_t>(spelling.side)];
}

/// SortedNames of raw controls, as rigs keep them.
struct SortedNames {
  std::vector<std::string> names;
  std::vector<uint32_t> first = {0}, sorted;
  std::string chars;
  NameList list;

  explicit SortedNames(std::vector<std::string> given) : names(std::move(given)) {
    for (uint32_t i = 0; i < names.size(); ++i) {
      chars += names[i];
      first.push_back(static_cast<uint32_t>(chars.size()));
      sorted.push_back(i);
    }
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](uint32_t a, uint32_t b) { return names[a] < names[b]; });
    list = {
        {first.data(), first.size()}, {&chars[0], chars.size()}, {sorted.data(), sorted.size()}};
  }

  /// "eyeBlink_L" or "0.5 jawOpen + ..."; the same with lists and without.
  std::string match(const std::string& name, Match* how = nullptr) const {
    ControlFinder finder(list);
    const ControlMatch found = finder.match(span_of(name));
    std::vector<ControlKey> by_spelling(names.size()), by_alias(names.size());
    finder.sort({by_spelling.data(), by_spelling.size()}, {by_alias.data(), by_alias.size()});
    EXPECT_EQ(text(finder.match(span_of(name))), text(found)) << name;
    if (how) *how = found.how;
    return text(found);
  }
  std::string text(const ControlMatch& match) const {
    std::string out;
    for (uint32_t i = 0; i < match.count; ++i) {
      const ControlShare& share = match.shares[i];
      char weight[16] = "";
      if (share.weight != 1) snprintf(weight, sizeof weight, "%g ", double{share.weight});
      out += (i ? " + " : "") + (weight + names[share.control]);
    }
    return out;
  }
};

// As the ICT face model names its expressions.
const std::vector<std::string> kIct = {
    "browDown_L",       "browDown_R",       "browInnerUp_L",  "browInnerUp_R",   "browOuterUp_L",
    "browOuterUp_R",    "cheekPuff_L",      "cheekPuff_R",    "cheekSquint_L",   "cheekSquint_R",
    "eyeBlink_L",       "eyeBlink_R",       "eyeLookDown_L",  "eyeLookDown_R",   "eyeLookIn_L",
    "eyeLookIn_R",      "eyeLookOut_L",     "eyeLookOut_R",   "eyeLookUp_L",     "eyeLookUp_R",
    "eyeSquint_L",      "eyeSquint_R",      "eyeWide_L",      "eyeWide_R",       "jawForward",
    "jawLeft",          "jawOpen",          "jawRight",       "mouthClose",      "mouthDimple_L",
    "mouthDimple_R",    "mouthFrown_L",     "mouthFrown_R",   "mouthFunnel",     "mouthLeft",
    "mouthLowerDown_L", "mouthLowerDown_R", "mouthPress_L",   "mouthPress_R",    "mouthPucker",
    "mouthRight",       "mouthRollLower",   "mouthRollUpper", "mouthShrugLower", "mouthShrugUpper",
    "mouthSmile_L",     "mouthSmile_R",     "mouthStretch_L", "mouthStretch_R",  "mouthUpperUp_L",
    "mouthUpperUp_R",   "noseSneer_L",      "noseSneer_R"};

TEST(ControlSpelling, ReadsLettersAndASide) {
  for (const char* name : {"mouthSmileLeft", "mouthSmile_L", "mouth_smile_l", "MouthSmileL",
                           "mouth-smile-left", "Left_Mouth_Smile", "l_mouthSmile", "mouthsmileleft",
                           "mouth-left-smile", "CTRL_expressions.mouthSmileL",
                           "ctrl_expressions_mouthSmileL", "face.blend:mouth Smile L"}) {
    EXPECT_EQ(spelled(name), "mouthsmile<") << name;
  }
  EXPECT_EQ(spelled("mouthFunnelUR"), "mouthfunnelu>");
  EXPECT_EQ(spelled("AU04_R"), "au4>");
  EXPECT_EQ(spelled("AU12L"), "au12<");
  EXPECT_EQ(spelled("jawLeft"), "jaw<");
}

TEST(ControlSpelling, WordsThatEndLikeASideHaveNone) {
  EXPECT_EQ(spelled("cleft"), "cleft");
  EXPECT_EQ(spelled("upright"), "upright");
  EXPECT_EQ(spelled("mouthFunnel"), "mouthfunnel");
  EXPECT_EQ(spelled("L"), "l");
  EXPECT_EQ(spelled("left"), "left");
}

TEST(ControlSpelling, NothingIsLikeANameWithoutLettersOrWithTooMany) {
  EXPECT_TRUE(spell_control({}).empty());
  EXPECT_TRUE(spell_control(span_of("_.-")).empty());
  EXPECT_TRUE(spell_control(span_of(std::string(100, 'x'))).empty());
  const SortedNames rig({std::string(100, 'x'), std::string(100, 'x') + "_L", "_", ""});
  EXPECT_EQ(rig.match(std::string(100, 'x')), std::string(100, 'x'));
  EXPECT_EQ(rig.match(std::string(100, 'x') + "Left"), "");
  EXPECT_EQ(rig.match("-"), "");
}

TEST(ControlAliases, GiveTheUsualName) {
  EXPECT_EQ(usual("AU12_L"), "mouthSmileLeft");
  EXPECT_EQ(usual("AU12"), "mouthSmile");
  EXPECT_EQ(usual("MouthCornerPullRight"), "mouthSmileRight");
  EXPECT_EQ(usual("CTRL_expressions.mouthCornerPullR"), "mouthSmileRight");
  EXPECT_EQ(usual("EyeClosedLeft"), "eyeBlinkLeft");
  EXPECT_EQ(usual("blinkRight"), "eyeBlinkRight");
  EXPECT_EQ(usual("eye-left-closure"), "eyeBlinkLeft");
  EXPECT_EQ(usual("eyeLookLeftL"), "eyeLookOutLeft");
  EXPECT_EQ(usual("eyeLookLeftR"), "eyeLookInRight");
  EXPECT_EQ(usual("AU61_R"), "eyeLookInRight");
  EXPECT_EQ(usual("NasalDilationLeft"), "noseNostrilDilateL");
  EXPECT_EQ(usual("JAWFWD"), "jawForward");
  EXPECT_EQ(usual("eyeblinkl"), "eyeBlinkLeft") << "asset names may be in small letters";
  EXPECT_EQ(usual("mouthLeft"), "mouthLeft");
  EXPECT_EQ(usual("somethingElse"), "");
  EXPECT_EQ(usual(""), "");
}

TEST(ControlAliases, KnowEveryNameOfArkitAndNoWordTwice) {
  for (const ArkitEntry& entry : arkit_table())
    EXPECT_EQ(usual(entry.expression), entry.expression);
  for (const std::string& name : kIct) EXPECT_NE(usual(name), "") << name;
  std::set<std::string> words;
  for (const AliasRow& row : kAliases) {
    std::string text = row.aliases;
    for (size_t at = 0; at < text.size();) {
      const size_t end = std::min(text.find(' ', at), text.size());
      EXPECT_TRUE(words.insert(text.substr(at, end - at)).second) << text.substr(at, end - at);
      at = end + 1;
    }
  }
}

TEST(MatchControls, FindsArkitOnARigThatSpellsItOtherwise) {
  const SortedNames rig(kIct);
  std::set<std::string> wanted;
  for (const ArkitEntry& entry : arkit_table()) wanted.insert(entry.expression);
  std::set<std::string> found;
  for (const std::string& name : wanted) {
    const std::string match = rig.match(name);
    EXPECT_NE(match, "") << name;
    found.insert(match);
  }
  EXPECT_EQ(found.size(), wanted.size()) << "each its own";
  Match how = Match::kNone;
  EXPECT_EQ(rig.match("browInnerUp", &how), "browInnerUp_L + browInnerUp_R");
  EXPECT_EQ(how, Match::kBothSides);
  EXPECT_EQ(rig.match("mouthSmileLeft", &how), "mouthSmile_L");
  EXPECT_EQ(how, Match::kSpelling);
  EXPECT_EQ(rig.match("jawopen", &how), "jawOpen");
  EXPECT_EQ(how, Match::kAsWritten);
  EXPECT_EQ(rig.match("AU12_R", &how), "mouthSmile_R");
  EXPECT_EQ(how, Match::kAlias);
  EXPECT_EQ(rig.match("CTRL_expressions.mouthCornerPullL"), "mouthSmile_L");
  EXPECT_EQ(rig.match("blink"), "eyeBlink_L + eyeBlink_R");
  EXPECT_EQ(rig.match("AU6"), "cheekSquint_L + cheekSquint_R");
  EXPECT_EQ(rig.match("tongueOut", &how), "");
  EXPECT_EQ(how, Match::kNone);
}

TEST(MatchControls, FindsExpressionsOfSeveralControls) {
  const SortedNames rig({"CTRL_expressions.mouthFunnelUL", "CTRL_expressions.mouthFunnelUR",
                         "CTRL_expressions.mouthFunnelDL", "CTRL_expressions.mouthFunnelDR",
                         "CTRL_expressions.eyeLookLeftL", "CTRL_expressions.eyeLookRightL",
                         "CTRL_expressions.eyeLookLeftR", "CTRL_expressions.eyeLookRightR",
                         "CTRL_expressions.mouthCornerPullL", "CTRL_expressions.jawOpen"});
  const std::string group = "CTRL_expressions.";
  Match how = Match::kNone;
  EXPECT_EQ(rig.match("mouthFunnel", &how), group + "mouthFunnelUL + " + group +
                                                "mouthFunnelUR + " + group + "mouthFunnelDL + " +
                                                group + "mouthFunnelDR");
  EXPECT_EQ(how, Match::kExpression);
  EXPECT_EQ(rig.match("lookLeft"), group + "eyeLookLeftL + " + group + "eyeLookLeftR");
  EXPECT_EQ(rig.match("aa"), "0.6 " + group + "jawOpen");
  EXPECT_EQ(rig.match("mouthSmileLeft", &how), group + "mouthCornerPullL");
  EXPECT_EQ(how, Match::kAlias);
  EXPECT_EQ(rig.match("mouthSmile"), "") << "there is no right one";
  EXPECT_EQ(rig.match("mouthPucker"), "") << "a part of it is missing";
}

TEST(MatchControls, LeftAndRightAreNoPairWhereTheyAreDirections) {
  const SortedNames rig({"jawLeft", "jawRight", "mouthLeft", "mouthRight"});
  EXPECT_EQ(rig.match("jaw"), "");
  EXPECT_EQ(rig.match("mouth"), "");
  EXPECT_EQ(rig.match("JawLeft"), "jawLeft");
}

TEST(MatchControls, OfSeveralControlsWithTheSameLettersNoneIsMeant) {
  const SortedNames rig({"mouth_smile_L", "mouthSmileLeft", "blinkLeft", "eyeClosedLeft"});
  EXPECT_EQ(rig.match("mouthSmile_l"), "");
  EXPECT_EQ(rig.match("mouthSmileLeft"), "mouthSmileLeft") << "as it is written";
  EXPECT_EQ(rig.match("eyeBlinkLeft"), "eyeClosedLeft") << "the first word of the table";
}

TEST(MatchControls, AnyBytesAreANameThatMatchesAtMostItself) {
  const SortedNames rig({"a", "b"});
  for (int c = 0; c < 256; ++c) {
    for (const size_t length : {1u, 2u, 61u, 62u, 63u, 300u}) {
      const std::string name(length, static_cast<char>(c));
      const std::string match = rig.match(name);
      EXPECT_TRUE(match.empty() || match == name || (length == 1 && match.size() == 1)) << c;
    }
  }
}

}  // namespace
}  // namespace mien
