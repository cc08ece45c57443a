// SPDX-License-Identifier: MIT
// The tables of the cage: points, curves between them, patches between those.
#pragma once

#include "author/generate/head/form.h"

namespace mien::head::cage {

/// A point of the cage: x in centimeters in the front view, or the share of the way around the head.
struct At {
  double x, y;
  bool around = false;
};
constexpr At around(double share, double y) { return {share, y, true}; }

/// The last row below the crown.
inline constexpr double kCrownRow = kCrownY - 0.15;

enum Node : uint8_t {
  kEnd,  // of a list
  // The middle of the face, from below.
  kBottomFront,
  kCollarFrontLow,
  kCollarFront,
  kThroat,
  kChin,
  kLipBottom,
  kLipTop,
  kColumella,
  kTip,
  kRidge,
  kBridge,
  kGlabella,
  kCrownFront,
  // Nose.
  kWing,
  kWingLow,
  kWingHigh,
  kNoseSide,
  kNostrilLowIn,
  kNostrilLowOut,
  kNostrilHighOut,
  kNostrilHighIn,
  // Loops around mouth and eye.
  kLipSide,
  kCheek,
  kInnerLow,
  kInner,
  kInnerHigh,
  kOuterLow,
  kOuter,
  kOuterHigh,
  // From the temple past the ear to its lobe; around the ear.
  kTempleHigh,
  kTemple,
  kTempleLow,
  kLobe,
  kEarFrontLow,
  kEarFrontHigh,
  kEarBackLow,
  kEarBackHigh,
  // The back of the head.
  kCrownBack,
  kBackHigh,
  kBack,
  kNape,
  // Below the ear, and behind.
  kCollarSide,
  kCollarSideLow,
  kBottomSide,
  kCollarBack,
  kCollarBackLow,
  kBottomBack,
  kNodeCount
};

inline constexpr At kNodes[kNodeCount] = {
    {0, 0},
    {0, -22},              // kBottomFront
    {0, -17.65},           // kCollarFrontLow
    {0, -17.35},           // kCollarFront
    {0, -12.4},            // kThroat
    {0, -10.6},            // kChin
    {0, -8.05},            // kLipBottom
    {0, -4.92},            // kLipTop
    {0, -4.66},            // kColumella
    {0, -3.25},            // kTip
    {0, -2.45},            // kRidge
    {0, -0.6},             // kBridge
    {0, 2.2},              // kGlabella
    {0, kCrownRow},        // kCrownFront
    {1.84, -4.52},         // kWing
    {1.76, -4.30},         // kWingLow
    {1.75, -3.12},         // kWingHigh
    {1.70, -2.45},         // kNoseSide
    {0.15, -4.66},         // kNostrilLowIn
    {1.40, -4.36},         // kNostrilLowOut
    {1.44, -3.14},         // kNostrilHighOut
    {0.20, -3.30},         // kNostrilHighIn
    {2.95, -5.35},         // kLipSide
    {4.75, -3.7},          // kCheek
    {1.50, -1.05},         // kInnerLow
    {1.02, 0.15},          // kInner
    {1.45, 1.85},          // kInnerHigh
    {4.95, -1.15},         // kOuterLow
    {5.65, 0.35},          // kOuter
    {5.15, 1.95},          // kOuterHigh
    around(0.455, 4.3),    // kTempleHigh
    around(0.435, 2.1),    // kTemple
    around(0.418, -1.6),   // kTempleLow
    around(0.450, -4.0),   // kLobe
    around(0.470, -3.8),   // kEarFrontLow
    around(0.468, 2.2),    // kEarFrontHigh
    around(0.585, -3.6),   // kEarBackLow
    around(0.600, 2.2),    // kEarBackHigh
    around(1, kCrownRow),  // kCrownBack
    around(1, 4.6),        // kBackHigh
    around(1, 1.6),        // kBack
    around(1, -5.0),       // kNape
    around(0.64, -17.35),  // kCollarSide
    around(0.64, -17.65),  // kCollarSideLow
    around(0.64, -22),     // kBottomSide
    around(1, -17.35),     // kCollarBack
    around(1, -17.65),     // kCollarBackLow
    around(1, -22),        // kBottomBack
};

/// What has one number of segments.
enum Strip : uint8_t {
  kOne,
  kCollar,
  kTipRows,
  kNoseColumns,
  kNostrilColumns,
  kWingRows,
  kCheekRows,
  kInnerLowRows,
  kInnerHighRows,
  kInnerRows,
  kOuterLowRows,
  kOuterHighRows,
  kEyeLow,
  kEyeHigh,
  kMuzzle,
  kLips,
  kSide,
  kBeforeEar,
  kEar,
  kBehindEar,
  kEarRows,
  kBehindFace,
  kForehead,
  kNeck,
  kChest,
  kAllColumns,
  kStripCount
};

struct Curve {
  uint8_t from, to;
  Strip strip;
  uint32_t via_count = 0;
  At via[5] = {};
  double hold = 0;  // see Spot
};

/// Creases of the form, which edges follow.
inline constexpr double kHeld = 0.7;

inline constexpr Curve kCurves[] = {
    // The middle of the face.
    {kBottomFront, kCollarFrontLow, kChest},
    {kCollarFrontLow, kCollarFront, kCollar},
    {kCollarFront, kThroat, kNeck},
    {kThroat, kChin, kSide},
    {kChin, kLipBottom, kMuzzle},
    {kLipTop, kColumella, kOne},
    {kColumella, kTip, kWingRows},
    {kTip, kRidge, kTipRows},
    {kRidge, kBridge, kCheekRows},
    {kBridge, kGlabella, kInnerRows},
    {kGlabella, kCrownFront, kForehead, 2, {{0, 5.5}, {0, 9.5}}},
    // Nose: its base, its sides, the border around the nostril.
    {kLipTop, kWing, kNoseColumns, 2, {{0.55, -4.92}, {1.35, -4.74}}},
    {kWing, kWingLow, kOne},
    {kWingLow, kWingHigh, kWingRows, 1, {{1.86, -3.65}}, kHeld},
    {kWingHigh, kNoseSide, kTipRows},
    {kNoseSide, kInnerLow, kCheekRows},
    {kColumella, kNostrilLowIn, kOne},
    {kNostrilLowIn, kNostrilLowOut, kNostrilColumns, 2, {{0.70, -4.62}, {1.08, -4.52}}, kHeld},
    {kNostrilLowOut, kWingLow, kOne},
    {kNostrilLowOut, kNostrilHighOut, kWingRows, 1, {{1.66, -3.72}}, kHeld},
    {kNostrilHighOut, kWingHigh, kOne},
    {kNostrilHighIn, kNostrilHighOut, kNostrilColumns, 1, {{0.92, -3.10}}},
    {kTip, kNostrilHighIn, kOne},
    {kNostrilLowIn, kNostrilHighIn, kWingRows, 1, {{0.15, -3.98}}, 0.3},
    {kRidge, kNoseSide, kNoseColumns},
    {kBridge, kInnerLow, kNoseColumns, 1, {{0.8, -0.65}}},
    {kGlabella, kInnerHigh, kNoseColumns, 1, {{0.8, 2.12}}},
    // The loop around the mouth along the nasolabial fold, and the one at the end of the muzzle.
    {kWing, kLipSide, kEyeLow, 1, {{2.42, -4.80}}},
    {kLipSide, kLipBottom, kLips, 4, {{3.42, -6.2}, {3.42, -7.1}, {2.6, -7.85}, {1.3, -8.08}}},
    {kNoseSide, kCheek, kEyeLow, 2, {{2.6, -2.75}, {3.7, -3.10}}},
    {kCheek, kChin, kLips, 4, {{5.2, -5.4}, {5.0, -7.3}, {3.9, -9.0}, {2.1, -10.25}}},
    {kLipSide, kCheek, kMuzzle},
    // Around the eye.
    {kInnerLow, kOuterLow, kEyeLow, 2, {{2.6, -1.62}, {3.9, -1.68}}},
    {kOuterLow, kOuter, kOuterLowRows, 1, {{5.5, -0.45}}},
    {kOuter, kOuterHigh, kOuterHighRows, 1, {{5.55, 1.2}}},
    {kInnerHigh, kOuterHigh, kEyeHigh, 2, {{2.7, 2.52}, {4.0, 2.60}}},
    {kInnerLow, kInner, kInnerLowRows, 1, {{1.14, -0.45}}},
    {kInner, kInnerHigh, kInnerHighRows, 1, {{1.10, 1.05}}},
    // From the face to the ear.
    {kCheek, kOuterLow, kCheekRows},
    {kCheek, kLobe, kSide, 1, {{5.9, -3.95}}},
    {kOuterLow, kTempleLow, kSide},
    {kOuter, kTemple, kSide},
    {kOuterHigh, kTempleHigh, kSide},
    {kLobe, kTempleLow, kCheekRows},
    {kTempleLow, kTemple, kOuterLowRows},
    {kTemple, kTempleHigh, kOuterHighRows},
    {kLobe,
     kThroat,
     kLips,
     4,
     {around(0.465, -6.3), around(0.425, -8.8), around(0.34, -11.0), around(0.19, -12.1)}},
    // Around the ear and behind it.
    {kLobe, kEarFrontLow, kBeforeEar},
    {kEarFrontLow, kEarBackLow, kEar},
    {kEarBackLow, kNape, kBehindEar},
    {kTemple, kEarFrontHigh, kBeforeEar},
    {kEarFrontHigh, kEarBackHigh, kEar},
    {kEarBackHigh, kBack, kBehindEar},
    {kEarFrontLow, kEarFrontHigh, kEarRows, 1, {around(0.445, -0.8)}},
    {kEarBackLow, kEarBackHigh, kEarRows},
    {kNape, kBack, kEarRows},
    {kBack, kBackHigh, kOuterHighRows},
    {kTempleHigh, kBackHigh, kBehindFace},
    {kBackHigh, kCrownBack, kForehead},
    {kCrownFront, kCrownBack, kAllColumns},
    // Neck and chest.
    {kCollarSide, kLobe, kNeck, 2, {around(0.60, -12.5), around(0.535, -8.0)}},
    {kCollarBack, kNape, kNeck},
    {kCollarBackLow, kCollarBack, kCollar},
    {kBottomBack, kCollarBackLow, kChest},
    {kCollarFront, kCollarSide, kLips},
    {kCollarFrontLow, kCollarSideLow, kLips},
    {kBottomFront, kBottomSide, kLips},
    {kCollarSide, kCollarBack, kBehindFace},
    {kCollarSideLow, kCollarBackLow, kBehindFace},
    {kBottomSide, kBottomBack, kBehindFace},
};
inline constexpr uint32_t kCurveCount = sizeof(kCurves) / sizeof(kCurves[0]);

/// Patches by their sides: bottom, right, top, left; bottom and top go to the right, the others up.
inline constexpr uint8_t kPatches[][4][5] = {
    // Nose.
    {{kLipTop, kWing},
     {kWing, kWingLow},
     {kColumella, kNostrilLowIn, kNostrilLowOut, kWingLow},
     {kLipTop, kColumella}},
    {{kColumella, kNostrilLowIn},
     {kNostrilLowIn, kNostrilHighIn},
     {kTip, kNostrilHighIn},
     {kColumella, kTip}},
    {{kNostrilLowOut, kWingLow},
     {kWingLow, kWingHigh},
     {kNostrilHighOut, kWingHigh},
     {kNostrilLowOut, kNostrilHighOut}},
    {{kTip, kNostrilHighIn, kNostrilHighOut, kWingHigh},
     {kWingHigh, kNoseSide},
     {kRidge, kNoseSide},
     {kTip, kRidge}},
    {{kRidge, kNoseSide}, {kNoseSide, kInnerLow}, {kBridge, kInnerLow}, {kRidge, kBridge}},
    {{kBridge, kInnerLow},
     {kInnerLow, kInner, kInnerHigh},
     {kGlabella, kInnerHigh},
     {kBridge, kGlabella}},
    // Muzzle, beside and below the mouth.
    {{kWing, kLipSide},
     {kLipSide, kCheek},
     {kNoseSide, kCheek},
     {kWing, kWingLow, kWingHigh, kNoseSide}},
    {{kLipSide, kLipBottom}, {kLipBottom, kChin}, {kCheek, kChin}, {kLipSide, kCheek}},
    // Cheek, side of the face, jaw.
    {{kNoseSide, kCheek}, {kCheek, kOuterLow}, {kInnerLow, kOuterLow}, {kNoseSide, kInnerLow}},
    {{kCheek, kLobe}, {kLobe, kTempleLow}, {kOuterLow, kTempleLow}, {kCheek, kOuterLow}},
    {{kOuterLow, kTempleLow}, {kTempleLow, kTemple}, {kOuter, kTemple}, {kOuterLow, kOuter}},
    {{kOuter, kTemple}, {kTemple, kTempleHigh}, {kOuterHigh, kTempleHigh}, {kOuter, kOuterHigh}},
    {{kCheek, kChin}, {kChin, kThroat}, {kLobe, kThroat}, {kCheek, kLobe}},
    // Around the ear.
    {{kLobe, kEarFrontLow},
     {kEarFrontLow, kEarFrontHigh},
     {kTemple, kEarFrontHigh},
     {kLobe, kTempleLow, kTemple}},
    {{kEarBackLow, kNape}, {kNape, kBack}, {kEarBackHigh, kBack}, {kEarBackLow, kEarBackHigh}},
    {{kTemple, kEarFrontHigh, kEarBackHigh, kBack},
     {kBack, kBackHigh},
     {kTempleHigh, kBackHigh},
     {kTemple, kTempleHigh}},
    // Forehead and scalp.
    {{kGlabella, kInnerHigh, kOuterHigh, kTempleHigh, kBackHigh},
     {kBackHigh, kCrownBack},
     {kCrownFront, kCrownBack},
     {kGlabella, kCrownFront}},
    // Neck, collar, chest.
    {{kCollarFront, kCollarSide}, {kCollarSide, kLobe}, {kThroat, kLobe}, {kCollarFront, kThroat}},
    {{kCollarSide, kCollarBack},
     {kCollarBack, kNape},
     {kLobe, kEarFrontLow, kEarBackLow, kNape},
     {kCollarSide, kLobe}},
    {{kCollarFrontLow, kCollarSideLow, kCollarBackLow},
     {kCollarBackLow, kCollarBack},
     {kCollarFront, kCollarSide, kCollarBack},
     {kCollarFrontLow, kCollarFront}},
    {{kBottomFront, kBottomSide, kBottomBack},
     {kBottomBack, kCollarBackLow},
     {kCollarFrontLow, kCollarSideLow, kCollarBackLow},
     {kBottomFront, kCollarFrontLow}},
};

}  // namespace mien::head::cage
