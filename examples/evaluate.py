# SPDX-License-Identifier: MIT
"""evaluate.py [FILE.dna [CONTROL]]: raises a control and prints the joint that moves or turns most."""
import sys

import mien

control = sys.argv[2] if len(sys.argv) > 2 else "CTRL_expressions.jawOpen"
with mien.Dna.open(sys.argv[1]) if sys.argv[1:] else mien.Dna.generate(mien.Preset.LARGE) as dna:
    rig = mien.Rig(dna)
face = rig.instance()
if control not in face:  # some rigs leave the prefix out
    control = control.rsplit(".", 1)[-1]
face[control] = 1  # or face.raw_controls[i], written in place
face.evaluate(lod=0)
most = abs(face.joints[:, :6]).max(axis=1).argmax()  # per joint tx ty tz rx ry rz sx sy sz
d = face.joints[most]
print("%s moves %s most: by %.3f %.3f %.3f, turning it by %.3f %.3f %.3f"
      % (control, rig.name(mien.Kind.JOINT, most), *d[:6]))
