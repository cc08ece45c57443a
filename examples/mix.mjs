// SPDX-License-Identifier: MIT
// mix.mjs: a head speaks, is glad, and closes its eyes when a flashlight hits them.
import { BlendMode, Guard, LayerGroup, Mien, MixLayer, Preset, ticks } from "mien";

const mien = await Mien.load();
const rig = mien.createRig(mien.generate(Preset.HEAD));
const face = rig.instance();

// Speech: the jaw at 60 frames a second, closed for every m of "mama mama".
const phases = Array.from({ length: 180 }, (_, i) => i % 30);
const values = phases.map((phase) => (phase < 8 ? 0 : ((phase - 8) * (29 - phase)) / 220));
const speech = mien.buildClip({ names: ["jawOpen"], values, rateNumerator: 60, rateDenominator: 1 });

// Joy over it, held back where it would part the lips; the flashlight acts last.
const joy = {
  jawOpen: 0.2, mouthSmileLeft: 0.9, mouthSmileRight: 0.9, cheekSquintLeft: 0.6, cheekSquintRight: 0.6,
};
const flashlight = {
  strokes: [
    { pose: { eyeBlinkLeft: 1, eyeBlinkRight: 1 }, mode: BlendMode.MAX, delay: ticks(0.06), attack: ticks(0.07),
      hold: ticks(0.06), release: ticks(0.22) },
    { pose: { eyeSquintLeft: 0.8, eyeSquintRight: 0.8 }, mode: BlendMode.SCREEN, delay: ticks(0.09),
      attack: ticks(0.15), release: ticks(0.4), isHeld: true },
  ],
  cooldown: ticks(0.25), adapted: 0.6, adaptTicks: ticks(1.5), recoverTicks: ticks(1.5),
};
const mix = rig.mix({
  layers: [MixLayer.clip({ group: LayerGroup.SPEECH }), MixLayer.poses([joy])],
  reactions: [flashlight],
  guards: Guard.LIPS,
});

const mixer = mix.mixer();
mixer.play(0, speech, speech.bind(rig), { transitionTicks: ticks(0.1) });
mixer.setPoseWeight(1, 0, 0.8, ticks(0.5));
for (let i = 1; i <= 150; ++i) {
  if (i === 90) mixer.trigger(0, 1, ticks(0.6));
  mixer.step(ticks(1 / 60), face); // writes the raw controls of the face
  face.evaluate(0);
  if (i % 10 !== 0) continue;
  const { jawOpen, mouthSmileLeft, eyeBlinkLeft, eyeSquintLeft } = face.controls;
  const [jaw, smile, lids, squint] = [jawOpen, mouthSmileLeft, eyeBlinkLeft, eyeSquintLeft].map((v) => v.toFixed(4));
  const most = Math.max(...face.joints).toFixed(3);
  console.log(`${String(i).padStart(3)}  jaw ${jaw}  smile ${smile}  lids ${lids}  squint ${squint}  joints up to ${most}`);
}
