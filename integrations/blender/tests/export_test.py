# SPDX-License-Identifier: MIT
"""Edits in Blender, written into a copy of the rig file."""
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(__file__))
from support import *  # noqa: E402,F403

OUT = os.path.join(FOLDER, "edited.dna")


class Export(unittest.TestCase):
    def setUp(self):
        empty_scene()
        if os.path.exists(OUT):
            os.remove(OUT)
        self.path = generated("small")
        self.rig = import_rig(self.path)
        self.thing = max(live.meshes_of(self.rig), key=lambda t: len(t.data.shape_keys.key_blocks) if t.data.shape_keys else 0)
        self.index = live.file_of(self.rig).rig.names(mien.Kind.MESH).index(self.thing.name)

    def move(self, data, vertices, by):
        for vertex in vertices:
            data[vertex].co = [a + b for a, b in zip(data[vertex].co, by)]

    def test_nothing_edited_is_the_same_file(self):
        bpy.ops.mien.export_rig(filepath=OUT)
        with open(self.path, "rb") as before, open(OUT, "rb") as after:
            self.assertEqual(before.read(), after.read())

    def test_neutral_shapes_weights_and_joints(self):
        blocks = self.thing.data.shape_keys.key_blocks
        moved, by = [3, 4, 5], np.array([0.01, -0.02, 0.005])
        for block in blocks:  # a moved neutral takes its shapes along
            self.move(block.data, moved, by)
        key = blocks[2]
        self.move(key.data, [7], (0.003, 0, 0))
        group = self.thing.vertex_groups[0]
        joint = live.file_of(self.rig).joints.index(group.name)
        for g in list(self.thing.data.vertices[9].groups):
            self.thing.vertex_groups[g.group].remove([9])
        group.add([9], 1, "REPLACE")
        bpy.context.view_layer.objects.active = self.rig
        bpy.ops.object.mode_set(mode="EDIT")
        bone = self.rig.data.edit_bones[-1]
        bone_name = bone.name
        bone.head.z += 0.01
        bone.tail.z += 0.01
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.ops.mien.export_rig(filepath=OUT)

        self.assertEqual([f for f in mien.validate(OUT) if f.severity == mien.Severity.ERROR], [])
        before, after = Reference(self.path), Reference(OUT)
        expected = before.deformer.mesh(self.index).positions.astype(np.float64).copy()
        x, y, z = by * 100
        expected[moved] += [x, z, -y]  # as the file has axes and centimeters
        found = after.deformer.mesh(self.index).positions
        self.assertLess(np.abs(found - expected).max(), 1e-4)
        untouched = np.setdiff1d(np.arange(len(found)), moved)
        self.assertTrue(np.array_equal(found[untouched], before.deformer.mesh(self.index).positions[untouched]))
        for target in range(after.deformer.mesh(self.index).target_count):
            delta = before.deformer.target(self.index, target).astype(np.float64).copy()
            if target == 1:
                delta[7, 0] += 0.3
            self.assertLess(np.abs(after.deformer.target(self.index, target) - delta).max(), 1e-4)
        joints, weights = after.deformer.influences(self.index, 9)
        self.assertEqual(([int(j) for j in joints], [float(w) for w in weights]), ([joint], [1.0]))
        place = live.file_of(self.rig).joints.index(bone_name)
        lift = (after.deformer.bind_matrices - before.deformer.bind_matrices)[place][:3, 3]
        self.assertLess(np.abs(lift - [0, 1, 0]).max(), 1e-3)
        # The edited file moves the edited character.
        self.rig.mien.path = OUT
        controls = np.random.default_rng(2).random(len(after.face.raw_controls)).astype(np.float32)
        set_controls(self.rig, controls)
        self.assertLess(largest_error(self.rig, after, controls), 1e-5)

    def test_what_cannot_be_written_is_refused(self):
        def refused(word):
            with self.assertRaises(RuntimeError) as caught:
                bpy.ops.mien.export_rig(filepath=OUT)
            self.assertIn(word, str(caught.exception))
            self.assertFalse(os.path.exists(OUT))

        self.thing.location.x = 1
        bpy.context.view_layer.update()
        refused("moved against")
        self.thing.location.x = 0
        bpy.context.view_layer.update()
        extra = self.thing.shape_key_add(name="my corrective", from_mix=False)
        refused("my corrective")
        self.thing.shape_key_remove(extra)
        name = self.rig.data.bones[-1].name
        self.rig.data.bones[-1].name = "renamed"
        refused(name)
        self.rig.data.bones["renamed"].name = name
        self.thing.data.vertices.add(1)
        refused("vertices")


if __name__ == "__main__":
    result = unittest.TextTestRunner(stream=sys.stdout, verbosity=1).run(
        unittest.defaultTestLoader.loadTestsFromModule(sys.modules["__main__"]))
    if not result.wasSuccessful():
        raise SystemExit(1)
