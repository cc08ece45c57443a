// SPDX-License-Identifier: MIT
// Expressions, by names of ARKit. Of each, what the names mean on a rig is set (mien_rig_match()).
export const PRESETS = {
  Smile: {
    mouthSmileLeft: 0.8, mouthSmileRight: 0.8, cheekSquintLeft: 0.4, cheekSquintRight: 0.4,
  },
  Laugh: {
    jawOpen: 0.45, mouthSmileLeft: 0.9, mouthSmileRight: 0.9, cheekSquintLeft: 0.7, cheekSquintRight: 0.7,
    eyeSquintLeft: 0.5, eyeSquintRight: 0.5, mouthUpperUpLeft: 0.3, mouthUpperUpRight: 0.3,
  },
  Surprise: {
    jawOpen: 0.5, browInnerUp: 0.9, browOuterUpLeft: 0.8, browOuterUpRight: 0.8, eyeWideLeft: 0.9, eyeWideRight: 0.9,
  },
  Anger: {
    browDownLeft: 0.9, browDownRight: 0.9, noseSneerLeft: 0.5, noseSneerRight: 0.5, mouthPressLeft: 0.6,
    mouthPressRight: 0.6, eyeSquintLeft: 0.4, eyeSquintRight: 0.4, jawForward: 0.2,
  },
  Sadness: {
    browInnerUp: 0.8, mouthFrownLeft: 0.7, mouthFrownRight: 0.7, mouthShrugLower: 0.4, eyeLookDownLeft: 0.3,
    eyeLookDownRight: 0.3,
  },
  Disgust: {
    noseSneerLeft: 0.9, noseSneerRight: 0.9, mouthUpperUpLeft: 0.6, mouthUpperUpRight: 0.6, browDownLeft: 0.5,
    browDownRight: 0.5, eyeSquintLeft: 0.5, eyeSquintRight: 0.5,
  },
  Kiss: {
    mouthPucker: 0.9, mouthFunnel: 0.2,
  },
  Wink: {
    eyeBlinkLeft: 1, cheekSquintLeft: 0.6, mouthSmileLeft: 0.5, browDownLeft: 0.2,
  },
  "Open mouth": { jawOpen: 0.8 },
};
