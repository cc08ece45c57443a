// SPDX-License-Identifier: MIT
// Expressions, by names of ARKit and of MetaHuman rigs. Of each, the names that a rig has are set.
export const PRESETS = {
  Smile: {
    mouthSmileLeft: 0.8, mouthSmileRight: 0.8, cheekSquintLeft: 0.4, cheekSquintRight: 0.4,
    mouthCornerPullL: 0.8, mouthCornerPullR: 0.8, eyeCheekRaiseL: 0.5, eyeCheekRaiseR: 0.5,
  },
  Laugh: {
    jawOpen: 0.45, mouthSmileLeft: 0.9, mouthSmileRight: 0.9, cheekSquintLeft: 0.7, cheekSquintRight: 0.7,
    eyeSquintLeft: 0.5, eyeSquintRight: 0.5, mouthUpperUpLeft: 0.3, mouthUpperUpRight: 0.3,
    mouthCornerPullL: 0.9, mouthCornerPullR: 0.9, eyeCheekRaiseL: 0.8, eyeCheekRaiseR: 0.8, eyeSquintInnerL: 0.4,
    eyeSquintInnerR: 0.4,
  },
  Surprise: {
    jawOpen: 0.5, browInnerUp: 0.9, browOuterUpLeft: 0.8, browOuterUpRight: 0.8, eyeWideLeft: 0.9, eyeWideRight: 0.9,
    browRaiseInL: 0.9, browRaiseInR: 0.9, browRaiseOuterL: 0.8, browRaiseOuterR: 0.8, eyeWidenL: 0.9, eyeWidenR: 0.9,
  },
  Anger: {
    browDownLeft: 0.9, browDownRight: 0.9, noseSneerLeft: 0.5, noseSneerRight: 0.5, mouthPressLeft: 0.6,
    mouthPressRight: 0.6, eyeSquintLeft: 0.4, eyeSquintRight: 0.4, jawForward: 0.2,
    browDownL: 0.9, browDownR: 0.9, browLateralL: 0.6, browLateralR: 0.6, noseWrinkleL: 0.4, noseWrinkleR: 0.4,
    mouthPressUL: 0.5, mouthPressUR: 0.5, mouthPressDL: 0.5, mouthPressDR: 0.5,
  },
  Sadness: {
    browInnerUp: 0.8, mouthFrownLeft: 0.7, mouthFrownRight: 0.7, mouthShrugLower: 0.4, eyeLookDownLeft: 0.3,
    eyeLookDownRight: 0.3,
    browRaiseInL: 0.8, browRaiseInR: 0.8, mouthCornerDepressL: 0.7, mouthCornerDepressR: 0.7, jawChinRaiseDL: 0.4,
    jawChinRaiseDR: 0.4,
  },
  Disgust: {
    noseSneerLeft: 0.9, noseSneerRight: 0.9, mouthUpperUpLeft: 0.6, mouthUpperUpRight: 0.6, browDownLeft: 0.5,
    browDownRight: 0.5, eyeSquintLeft: 0.5, eyeSquintRight: 0.5,
    noseWrinkleL: 0.9, noseWrinkleR: 0.9, mouthUpperLipRaiseL: 0.6, mouthUpperLipRaiseR: 0.6, browDownL: 0.5,
    browDownR: 0.5,
  },
  Kiss: {
    mouthPucker: 0.9, mouthFunnel: 0.2,
    mouthLipsPurseUL: 0.9, mouthLipsPurseUR: 0.9, mouthLipsPurseDL: 0.9, mouthLipsPurseDR: 0.9,
  },
  Wink: {
    eyeBlinkLeft: 1, cheekSquintLeft: 0.6, mouthSmileLeft: 0.5, browDownLeft: 0.2,
    eyeBlinkL: 1, eyeCheekRaiseL: 0.6, mouthCornerPullL: 0.5,
  },
  "Open mouth": { jawOpen: 0.8 },
};
