# SPDX-License-Identifier: MIT
"""mix.py: a head speaks, is glad, and closes its eyes when a flashlight hits them."""
import mien
from mien import BlendMode, MixLayer, Reaction, Stroke, ticks

FRAME = mien.TICKS_PER_SECOND // 60
with mien.Dna.generate(mien.Preset.HEAD) as dna:
    rig = mien.Rig(dna)
    deformer = mien.Deformer(dna, rig)
face = rig.instance()

# Speech: the jaw at 60 frames a second, closed for every m of "mama mama".
phases = [i % 30 for i in range(180)]
jaw = [0 if phase < 8 else (phase - 8) * (29 - phase) / 220 for phase in phases]
speech = mien.Clip.build(["jawOpen"], jaw, rate=60)

# Joy over it, held back where it would part the lips; the flashlight acts last.
joy = {"jawOpen": 0.2, "mouthSmileLeft": 0.9, "mouthSmileRight": 0.9,
       "cheekSquintLeft": 0.6, "cheekSquintRight": 0.6}
flashlight = Reaction([
    Stroke({"eyeBlinkLeft": 1, "eyeBlinkRight": 1}, BlendMode.MAX, delay=ticks(0.06),
           attack=ticks(0.07), hold=ticks(0.06), release=ticks(0.22)),
    Stroke({"eyeSquintLeft": 0.8, "eyeSquintRight": 0.8}, BlendMode.SCREEN, delay=ticks(0.09),
           attack=ticks(0.15), release=ticks(0.4), is_held=True),
], cooldown=ticks(0.25), adapted=0.6, adapt_ticks=ticks(1.5), recover_ticks=ticks(1.5))
mix = mien.Mix(rig, [MixLayer.clip(mien.LayerGroup.SPEECH), MixLayer.poses([joy])], [flashlight],
               guards=mien.Guard.LIPS, deformer=deformer)

mixer = mix.mixer()
mixer.play(0, speech, speech.bind(rig), duration=ticks(0.1))
mixer.set_pose_weight(1, 0, 0.8, ticks(0.5))
for i in range(1, 151):
    if i == 90:
        mixer.trigger(0, 1, ticks(0.6))
    mixer.step(FRAME, face)  # writes the raw controls of the face
    face.evaluate(lod=0)
    if i % 10 == 0:
        print("%3d  jaw %.4f  smile %.4f  lids %.4f  squint %.4f  joints up to %.3f"
              % (i, face["jawOpen"], face["mouthSmileLeft"], face["eyeBlinkLeft"],
                 face["eyeSquintLeft"], face.joints.max()))
