# SPDX-License-Identifier: MIT
"""That Python sees the numbers of C, with and without NumPy, alone and in batches."""
import io
import os
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor

import mien
from support import dna_of, needs_numpy, numpy, pattern, rig_of, run


class Values(unittest.TestCase):
    def test_versions(self):
        from mien import _api
        self.assertEqual(mien.version(), _api.VERSION)
        self.assertTrue(mien.isa_available(mien.Isa.SCALAR))
        self.assertEqual(mien.isa_name(mien.Isa.AVX2), "avx2")

    def test_counts_and_names(self):
        rig, info = rig_of(), dna_of().info
        self.assertEqual(rig.count(mien.Kind.JOINT), info.joint_count)
        names = rig.names(mien.Kind.JOINT)
        self.assertEqual(names, dna_of().read("defn.jointNames"))
        for kind in mien.Kind:
            self.assertEqual(len(rig.names(kind)), rig.count(kind))
        self.assertEqual(rig.find(mien.Kind.JOINT, names[5]), 5)
        self.assertEqual(rig.name(mien.Kind.JOINT_GROUP, 0), "")

    def test_a_baked_rig_is_the_rig(self):
        rig = rig_of()
        data = rig.to_bytes()
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "face.rig")
            rig.bake(path)
            with open(path, "rb") as file:
                self.assertEqual(file.read(), data)
            rigs = [mien.Rig.open(path, check=mien.BakedCheck.FULL),
                    mien.Rig.open(path, access=mien.FileAccess.MAP), mien.Rig.from_bytes(data)]
            for again in rigs:
                self.assertEqual(again.to_bytes(), data)
                self.assertEqual(again.names(mien.Kind.JOINT), rig.names(mien.Kind.JOINT))
                again.close()
        with self.assertRaises(mien.DnaError):
            mien.Rig.from_bytes(b"DNA")

    def test_a_baked_file_gives_rig_and_deformer(self):
        rig = rig_of()
        deformer = mien.Deformer(dna_of(), rig)
        data = rig.to_bytes(deformer)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "face.rig")
            rig.bake(path, deformer)
            files = [mien.Baked.open(path), mien.Baked.open(path, access=mien.FileAccess.MAP),
                     mien.Baked.from_bytes(data, check=mien.BakedCheck.FULL),
                     mien.Baked.from_stream(io.BytesIO(data))]
            for baked in files:
                self.assertEqual(baked.info.file_bytes, len(data))
                again = baked.rig(isa=mien.Isa.SCALAR)
                meshes = baked.deformer(again)
                baked.close()
                self.assertEqual(again.to_bytes(meshes), data)
                self.assertEqual(meshes.mesh(0).name, deformer.mesh(0).name)
                meshes.instance().deform(0)
        without = mien.Baked.from_bytes(rig.to_bytes())
        with self.assertRaises(mien.Error) as raised:
            without.deformer(without.rig())
        self.assertEqual(raised.exception.status, mien.Status.BAKED_PART)
        with self.assertRaises(mien.Error) as raised:
            without.deformer(rig)
        self.assertEqual(raised.exception.status, mien.Status.MISMATCH)

    def test_streams(self):
        data = dna_of().to_bytes()
        archive = io.BytesIO(b"before" + data)
        archive.seek(6)
        with mien.Dna.from_stream(archive, layers=mien.Layer.BEHAVIOR) as dna:
            self.assertEqual(dna.info.raw_control_count, dna_of().info.raw_control_count)

        class Broken(io.BytesIO):
            def read(self, size=-1):
                raise RuntimeError("the network is down")

        class Short(io.BytesIO):
            def read(self, size=-1):
                return super().read(1) if self.tell() < 100 else b""

        for use in (mien.Dna.from_stream, mien.Baked.from_stream):
            with self.assertRaisesRegex(RuntimeError, "network"):
                use(Broken(data))
            with self.assertRaises(mien.FileError):
                use(Short(data))
            with self.assertRaises(TypeError):
                use(io.StringIO("text"))

    def test_a_control_by_name(self):
        rig = rig_of()
        face, name = rig.instance(), rig.name(mien.Kind.RAW_CONTROL, 4)
        face[name] = 0.5
        self.assertEqual(face.raw_controls[4], 0.5)
        self.assertEqual(face[name], 0.5)

    @needs_numpy
    def test_shapes(self):
        rig = rig_of()
        turned = rig_of(rotation=mien.RotationOutput.QUATERNION)
        face, batch = rig.instance(), rig.batch(3)
        joints = rig.count(mien.Kind.JOINT)
        self.assertEqual(face.joints.shape, (joints, 9))
        self.assertEqual(turned.instance().joints.shape, (joints, 10))
        self.assertEqual(rig.neutral_joint_values.shape, (joints, 9))
        self.assertEqual(turned.neutral_joint_values.shape, (joints, 10))
        self.assertEqual(batch.joints.shape, (3, joints, 9))
        self.assertEqual(face.controls.shape, (rig.info.control_count,))
        for name, kind in (("gui_controls", mien.Kind.GUI_CONTROL),
                           ("raw_controls", mien.Kind.RAW_CONTROL), ("ml_masks", mien.Kind.ML_MASK),
                           ("blend_shapes", mien.Kind.BLEND_SHAPE_CHANNEL),
                           ("animated_maps", mien.Kind.ANIMATED_MAP)):
            self.assertEqual(getattr(face, name).shape, (rig.count(kind),))
            self.assertEqual(getattr(batch, name).shape, (3, rig.count(kind)))
            self.assertEqual(getattr(face, name).dtype, numpy.float32)
        parts = [face.raw_controls, face.psd_controls, face.ml_controls, face.rbf_controls]
        numpy.testing.assert_array_equal(numpy.concatenate(parts), face.controls)
        self.assertEqual(rig.joint_parents.shape, (joints,))
        self.assertLess(rig.psd_inputs(0).max(), rig.info.control_count)
        self.assertTrue((rig.lod_indices(mien.Kind.JOINT, 0) < joints).all())

    @needs_numpy
    def test_inputs_of_any_count_can_be_assigned(self):
        for preset in (mien.Preset.TINY, mien.Preset.SMALL, mien.Preset.MEDIUM):
            for thing in (rig_of(preset).instance(), rig_of(preset).batch(2),
                          rig_of(preset).batch(0)):
                for name in ("gui_controls", "raw_controls", "ml_masks"):
                    setattr(thing, name, 0.5)
                    self.assertTrue((getattr(thing, name) == 0.5).all())
                thing.evaluate()
                thing.map_gui_to_raw()
                thing.reset()

    @needs_numpy
    def test_outputs_stay_within_what_may_vary(self):
        rig = rig_of()
        face = rig.instance()
        face.raw_controls = 0.5
        for lod in range(rig.lod_count):
            face.evaluate(lod)
            moved = set(numpy.flatnonzero(face.joints))
            self.assertLessEqual(moved, set(rig.variable_joint_values(lod).tolist()))
            self.assertGreater(rig.statistics(lod).joint_entry_count, 0)

    @needs_numpy
    def test_a_batch_gives_the_bits_of_single_characters(self):
        for rig in (rig_of(), rig_of(rotation=mien.RotationOutput.QUATERNION), rig_of(mien.Preset.LARGE)):
            n, count = 7, rig.count(mien.Kind.RAW_CONTROL)
            batch, in_parts, face = rig.batch(n), rig.batch(n, tasks=4), rig.instance()
            rows = numpy.array([pattern(count, i) for i in range(n)], "f")
            lods = [i % rig.lod_count for i in range(n)]
            for lod in (0, lods):
                batch.raw_controls = rows
                batch.evaluate(lod)
                with ThreadPoolExecutor(3) as threads:
                    in_parts.raw_controls = rows
                    in_parts.evaluate(lod, threads=threads)
                numpy.testing.assert_array_equal(in_parts.joints, batch.joints)
                for i in range(n):
                    face.raw_controls = rows[i]
                    face.evaluate(lods[i] if lod else 0)
                    for name in ("controls", "joints", "blend_shapes", "animated_maps"):
                        numpy.testing.assert_array_equal(getattr(batch, name)[i],
                                                         getattr(face, name))

    @needs_numpy
    def test_maps_and_stages(self):
        rig = rig_of()
        face, batch = rig.instance(), rig.batch(2)
        face.gui_controls = 0.5
        batch.gui_controls = 0.5
        face.map_gui_to_raw()
        batch.map_gui_to_raw()
        self.assertTrue(face.raw_controls.any())
        numpy.testing.assert_array_equal(batch.raw_controls[1], face.raw_controls)
        face.gui_controls = 0
        face.map_raw_to_gui()
        self.assertTrue(face.gui_controls.any())
        face.evaluate(stages=mien.Stage.PSD | mien.Stage.RBF | mien.Stage.ML)
        self.assertFalse(face.joints.any())
        face.evaluate_joint_group(0)
        some = numpy.count_nonzero(face.joints)
        face.evaluate()
        self.assertGreater(numpy.count_nonzero(face.joints), some)
        for solver in range(rig.count(mien.Kind.RBF_SOLVER)):
            face.evaluate_rbf_solver(solver)
        for setup in range(rig.count(mien.Kind.TWIST_SWING)):
            face.evaluate_twist_swing(setup)
        face.reset()
        numpy.testing.assert_array_equal(face.raw_controls, rig.initial_raw_controls)
        self.assertFalse(face.joints.any())

    def test_without_numpy(self):
        """The same bits through memoryviews."""
        code = """
import hashlib, mien
rig = mien.Rig(mien.Dna.generate(mien.Preset.SMALL, seed=7))
face = rig.instance()
face.raw_controls = [i % 5 / 5 for i in range(len(face.raw_controls))]
face[rig.name(mien.Kind.RAW_CONTROL, 3)] = 1.5
face.evaluate(1)
print(type(face.joints).__name__, hashlib.sha256(bytes(face.joints)).hexdigest())
"""
        with_it = run(code).split()
        without = run(code, without_numpy=True).split()
        self.assertEqual(without[0], "memoryview")
        self.assertEqual(with_it[1], without[1])
        run("""
import mien
dna = mien.Dna.generate()
rig = mien.Rig(dna)
face, batch = rig.instance(), rig.batch(3)
assert dna.read("defn.neutralJointTranslations.xs").typecode == "f"
assert len(face.joints) == rig.info.joint_value_count and face.joints.readonly
face.raw_controls = 0.5
face.ml_masks = 1
batch[1].raw_controls[:] = face.raw_controls
face.evaluate()
batch.evaluate()
assert batch[1].joints == face.joints and len(rig.joint_parents) == rig.count(mien.Kind.JOINT)
for wrong in ([1.0], [0.5] * 99):
    try: face.raw_controls = wrong
    except mien.ArgumentError: pass
    else: raise AssertionError(wrong)
for wrong in ("text", None, ["x"]):
    try: face.raw_controls = wrong
    except TypeError: pass
    else: raise AssertionError(wrong)
try: face.joints[0] = 1
except TypeError: pass
else: raise AssertionError("written")
try: batch.joints
except ImportError: pass
else: raise AssertionError("no NumPy, yet an array")
kept = face.joints
wanted = bytes(kept)
face.close(); rig.close()
assert bytes(kept) == wanted
""", without_numpy=True)


if __name__ == "__main__":
    unittest.main()
