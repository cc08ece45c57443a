# SPDX-License-Identifier: MIT
"""author.py [OUT.dna]: makes a rig of a mesh and its shapes, here those of the generated head."""
import sys

import mien

with mien.Dna.generate(mien.Preset.HEAD) as head:
    source = mien.Rig(head)
    deformer = mien.Deformer(head, source)
lod, mesh = 4, deformer.mesh("head_lod4_mesh")
face, pose = source.instance(), deformer.instance()


def positions(**controls):
    face.reset()
    face.update(controls)
    face.evaluate(lod=lod)
    pose.update(face)
    pose.deform(mesh.index)
    return pose.positions(mesh.index).copy()


neutral = positions()
shapes = {name: positions(**{name: 1}) - neutral for name in ("jawOpen", "mouthSmileLeft", "browInnerUp")}
faces = mesh.vertex_position_indices[mesh.triangles]
dna, report = mien.author_rig(neutral, faces, shapes, facial_joints=60, lods=2)
print(f"{report['joints']} joints, {100 * report['fit']['error']:.1f} % off")
if len(sys.argv) > 1:
    dna.save(sys.argv[1])
