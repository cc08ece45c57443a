// SPDX-License-Identifier: MIT
// The list of expressions, which of their pairs are corrected, and the joints that they turn.
#include <algorithm>

#include "author/generate/head/shapes.h"

namespace mien::head {

const Shape kExpressions[kExpressionCount] = {
    {"eyeBlinkLeft", Motion::kBlink, 1},
    {"eyeLookDownLeft", Motion::kLookDown, 1},
    {"eyeLookInLeft", Motion::kLookIn, 1},
    {"eyeLookOutLeft", Motion::kLookOut, 1},
    {"eyeLookUpLeft", Motion::kLookUp, 1},
    {"eyeSquintLeft", Motion::kSquint, 1},
    {"eyeWideLeft", Motion::kWide, 1},
    {"eyeBlinkRight", Motion::kBlink, -1},
    {"eyeLookDownRight", Motion::kLookDown, -1},
    {"eyeLookInRight", Motion::kLookIn, -1},
    {"eyeLookOutRight", Motion::kLookOut, -1},
    {"eyeLookUpRight", Motion::kLookUp, -1},
    {"eyeSquintRight", Motion::kSquint, -1},
    {"eyeWideRight", Motion::kWide, -1},
    {"jawForward", Motion::kJawForward, 0},
    {"jawLeft", Motion::kJawLeft, 1},
    {"jawRight", Motion::kJawLeft, -1},
    {"jawOpen", Motion::kJawOpen, 0},
    {"mouthClose", Motion::kMouthClose, 0},
    {"mouthFunnel", Motion::kFunnel, 0},
    {"mouthPucker", Motion::kPucker, 0},
    {"mouthLeft", Motion::kMouthLeft, 1},
    {"mouthRight", Motion::kMouthLeft, -1},
    {"mouthSmileLeft", Motion::kSmile, 1},
    {"mouthSmileRight", Motion::kSmile, -1},
    {"mouthFrownLeft", Motion::kFrown, 1},
    {"mouthFrownRight", Motion::kFrown, -1},
    {"mouthDimpleLeft", Motion::kDimple, 1},
    {"mouthDimpleRight", Motion::kDimple, -1},
    {"mouthStretchLeft", Motion::kStretch, 1},
    {"mouthStretchRight", Motion::kStretch, -1},
    {"mouthRollLower", Motion::kRollLower, 0},
    {"mouthRollUpper", Motion::kRollUpper, 0},
    {"mouthShrugLower", Motion::kShrugLower, 0},
    {"mouthShrugUpper", Motion::kShrugUpper, 0},
    {"mouthPressLeft", Motion::kPress, 1},
    {"mouthPressRight", Motion::kPress, -1},
    {"mouthLowerDownLeft", Motion::kLowerDown, 1},
    {"mouthLowerDownRight", Motion::kLowerDown, -1},
    {"mouthUpperUpLeft", Motion::kUpperUp, 1},
    {"mouthUpperUpRight", Motion::kUpperUp, -1},
    {"browDownLeft", Motion::kBrowDown, 1},
    {"browDownRight", Motion::kBrowDown, -1},
    {"browInnerUp", Motion::kBrowInnerUp, 0},
    {"browOuterUpLeft", Motion::kBrowOuterUp, 1},
    {"browOuterUpRight", Motion::kBrowOuterUp, -1},
    {"cheekPuff", Motion::kCheekPuff, 0},
    {"cheekSquintLeft", Motion::kCheekSquint, 1},
    {"cheekSquintRight", Motion::kCheekSquint, -1},
    {"noseSneerLeft", Motion::kSneer, 1},
    {"noseSneerRight", Motion::kSneer, -1},
    {"tongueOut", Motion::kTongueOut, 0},
    {"eyeLidPressL", Motion::kLidPress, 1},
    {"eyeLidPressR", Motion::kLidPress, -1},
    {"noseNostrilDilateL", Motion::kDilate, 1},
    {"noseNostrilDilateR", Motion::kDilate, -1},
    {"noseNasolabialDeepenL", Motion::kDeepenFold, 1},
    {"noseNasolabialDeepenR", Motion::kDeepenFold, -1},
    {"mouthLipsPressL", Motion::kLipsPress, 1},
    {"mouthLipsPressR", Motion::kLipsPress, -1},
    {"mouthLipsTogetherUL", Motion::kTogetherUpper, 1},
    {"mouthLipsTogetherUR", Motion::kTogetherUpper, -1},
    {"mouthLipsTogetherDL", Motion::kTogetherLower, 1},
    {"mouthLipsTogetherDR", Motion::kTogetherLower, -1},
    {"jawClenchL", Motion::kClench, 1},
    {"jawClenchR", Motion::kClench, -1},
    {"neckStretchL", Motion::kNeckStretch, 1},
    {"neckStretchR", Motion::kNeckStretch, -1},
    {"neckMastoidContractL", Motion::kMastoid, 1},
    {"neckMastoidContractR", Motion::kMastoid, -1},
    {"neckThroatUp", Motion::kThroatUp, 0},
    {"neckThroatDown", Motion::kThroatDown, 0},
};

namespace {

uint8_t find(Motion motion, int side) {
  uint8_t i = 0;
  while (kExpressions[i].motion != motion || kExpressions[i].side != side) ++i;
  return i;
}

}  // namespace

JointTurns turns_of(Motion motion) {
  JointTurns t;
  switch (motion) {
    case Motion::kBlink: t.upper_lid = t.lower_lid = -1; break;
    case Motion::kWide: t.upper_lid = 0.34, t.lower_lid = 0.40; break;
    case Motion::kSquint: t.upper_lid = -0.22, t.lower_lid = -1.15; break;
    case Motion::kLookUp: t.upper_lid = 0.34, t.lower_lid = -0.35, t.eye_up = 24; break;
    case Motion::kLookDown: t.upper_lid = -0.54, t.lower_lid = 0.60, t.eye_up = -26; break;
    case Motion::kLookIn: t.eye_out = -26; break;
    case Motion::kLookOut: t.eye_out = 26; break;
    case Motion::kSmile: t.lower_lid = -0.75, t.upper_lid = -0.08; break;
    case Motion::kCheekSquint: t.lower_lid = -0.9, t.upper_lid = -0.10; break;
    case Motion::kSneer: t.lower_lid = -0.45, t.upper_lid = -0.06; break;
    case Motion::kLidPress: t.lower_lid = -0.35, t.upper_lid = -0.12; break;
    case Motion::kJawOpen: t.jaw_open = kJawOpenAngle; break;
    case Motion::kFunnel: t.jaw_open = 8; break;
    case Motion::kJawForward: t.jaw_shift = {0, -0.08, 0.95}; break;
    case Motion::kJawLeft: t.jaw_shift = {1.0, -0.05, -0.05}; break;
    case Motion::kTongueOut: t.jaw_open = 10.4, t.tongue = 1; break;
    case Motion::kTongueUp: t.tongue_up = 1; break;
    default: break;
  }
  return t;
}

bool undoes_jaw(Motion m) { return m == Motion::kLessRound || m == Motion::kLessOpen; }

bool moves_jaw(Motion m) {
  return m == Motion::kJawOpen || m == Motion::kJawForward || m == Motion::kJawLeft ||
         m == Motion::kTongueOut || m == Motion::kFunnel;
}

/// Pairs that press or stretch the same skin: the worst of all, as tests/author/generate/head/combinations_test.cpp
/// measures them, and two that are common. Of those with a side, left with left and right with right.
static constexpr Motion kCrowded[][2] = {
    {Motion::kMouthLeft, Motion::kCheekPuff},   {Motion::kMouthLeft, Motion::kStretch},
    {Motion::kStretch, Motion::kCheekPuff},     {Motion::kStretch, Motion::kNeckStretch},
    {Motion::kSmile, Motion::kCheekPuff},       {Motion::kCheekPuff, Motion::kClench},
    {Motion::kFunnel, Motion::kCheekPuff},      {Motion::kPucker, Motion::kMouthLeft},
    {Motion::kMouthLeft, Motion::kSmile},       {Motion::kPucker, Motion::kCheekPuff},
    {Motion::kFrown, Motion::kCheekPuff},       {Motion::kShrugLower, Motion::kCheekPuff},
    {Motion::kFunnel, Motion::kTongueOut},      {Motion::kFunnel, Motion::kShrugLower},
    {Motion::kFunnel, Motion::kShrugUpper},     {Motion::kMouthLeft, Motion::kFrown},
    {Motion::kMouthLeft, Motion::kNeckStretch}, {Motion::kMouthLeft, Motion::kClench},
    {Motion::kDimple, Motion::kCheekPuff},      {Motion::kCheekPuff, Motion::kNeckStretch},
    {Motion::kSmile, Motion::kStretch},         {Motion::kPucker, Motion::kShrugUpper},
    {Motion::kFrown, Motion::kStretch},         {Motion::kPucker, Motion::kTongueOut},
    {Motion::kPucker, Motion::kShrugLower},     {Motion::kCheekPuff, Motion::kSneer},
    {Motion::kCheekPuff, Motion::kTongueOut},   {Motion::kSmile, Motion::kDimple},
    {Motion::kSmile, Motion::kDeepenFold},      {Motion::kFunnel, Motion::kPucker},
    {Motion::kMouthLeft, Motion::kSneer},       {Motion::kBrowInnerUp, Motion::kBrowOuterUp},
};

uint32_t list_correctives(Corrective (&out)[kMaxCorrectives]) {
  uint32_t count = 0;
  const auto add = [&](Motion a, int side_a, Motion b, int side_b, Motion motion, int side,
                       uint8_t undone = 0) {
    const uint8_t first = find(a, side_a), second = find(b, side_b);
    out[count++] = {std::min(first, second), std::max(first, second), motion,
                    static_cast<int8_t>(side), undone};
  };
  add(Motion::kJawOpen, 0, Motion::kMouthClose, 0, Motion::kSeal, 0);
  add(Motion::kJawOpen, 0, Motion::kPucker, 0, Motion::kLessRaise, 0);
  add(Motion::kJawOpen, 0, Motion::kFunnel, 0, Motion::kLessRound, 0, find(Motion::kFunnel, 0));
  add(Motion::kJawOpen, 0, Motion::kTongueOut, 0, Motion::kLessOpen, 0,
      find(Motion::kTongueOut, 0));
  add(Motion::kTongueOut, 0, Motion::kTongueOut, 0, Motion::kTongueUp, 0);
  for (int side : {1, -1}) {
    // Blinking closes the eye whatever else moves the lids.
    for (Motion m : {Motion::kSquint, Motion::kWide, Motion::kLookUp, Motion::kLookDown,
                     Motion::kSmile, Motion::kCheekSquint, Motion::kSneer, Motion::kLidPress}) {
      add(Motion::kBlink, side, m, side, Motion::kKeepLidsShut, side, find(m, side));
    }
    add(Motion::kJawOpen, 0, Motion::kSmile, side, Motion::kLessWide, side);
    add(Motion::kWide, side, Motion::kBrowDown, side, Motion::kBrowsApart, side);
    add(Motion::kJawOpen, 0, Motion::kTogetherUpper, side, Motion::kSealUpper, side);
    add(Motion::kJawOpen, 0, Motion::kTogetherLower, side, Motion::kSealLower, side);
  }
  const auto sided = [](Motion m) {
    uint32_t i = 0;
    while (kExpressions[i].motion != m) ++i;
    return kExpressions[i].side != 0;
  };
  for (const auto& [first, second] : kCrowded) {
    const bool a = sided(first), b = sided(second);
    if (!a && !b) add(first, 0, second, 0, Motion::kNotTwice, 0);
    for (int side : {1, -1}) {
      if (a || b) add(first, a ? side : 0, second, b ? side : 0, Motion::kNotTwice, side);
    }
  }
  return count;
}

Shape Shapes::shape(uint32_t index) const {
  if (index < kExpressionCount) return kExpressions[index];
  const Corrective& c = list_[index - kExpressionCount];
  return {"", c.motion, c.side};
}

uint32_t Shapes::twin(uint32_t index) const {
  if (index < kExpressionCount) {
    const Shape& s = kExpressions[index];
    return s.side == 0 ? index : find(s.motion, -s.side);
  }
  const Corrective& c = list_[index - kExpressionCount];
  if (c.side == 0) return index;
  const auto other = [this](uint32_t expression) { return static_cast<uint8_t>(twin(expression)); };
  for (uint32_t i = 0; i < corrective_count_; ++i) {
    const Corrective& d = list_[i];
    const uint8_t a = other(d.first), b = other(d.second);
    if (std::min(a, b) == c.first && std::max(a, b) == c.second) return kExpressionCount + i;
  }
  return index;
}

JointTurns Shapes::turns(uint32_t index, int side) const {
  const Shape s = shape(index);
  if (s.motion == Motion::kKeepLidsShut) {
    JointTurns t;
    if (s.side != side) return t;
    const JointTurns undone = turns_of(kExpressions[list_[index - kExpressionCount].undone].motion);
    t.upper_lid = -undone.upper_lid;
    t.lower_lid = -undone.lower_lid;
    return t;
  }
  if (undoes_jaw(s.motion)) {
    JointTurns t;
    t.jaw_open = -turns_of(kExpressions[list_[index - kExpressionCount].undone].motion).jaw_open;
    return t;
  }
  JointTurns t = turns_of(s.motion);
  if (moves_jaw(s.motion)) {  // one jaw for both halves
    if (s.side < 0) t.jaw_shift.x = -t.jaw_shift.x;
    return t;
  }
  return s.side == 0 || s.side == side ? t : JointTurns();
}

}  // namespace mien::head
