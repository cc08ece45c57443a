# SPDX-License-Identifier: MIT
"""Wrong values, shapes, types and files: the exception that says so, with all it should carry."""
import os
import pickle
import tempfile
import unittest
from pathlib import Path

import mien
from support import dna_of, fresh_rig, needs_numpy, numpy, pattern, rig_of


class Arrays(unittest.TestCase):
    def setUp(self):
        self.rig = rig_of()
        self.face = self.rig.instance()
        self.count = self.rig.count(mien.Kind.RAW_CONTROL)

    def unchanged_by(self, exception, values, target=None, name="raw_controls"):
        target = target or self.face
        before = getattr(target, name).copy()
        with self.assertRaises(exception):
            setattr(target, name, values)
        numpy.testing.assert_array_equal(getattr(target, name), before)

    @needs_numpy
    def test_wrong_shapes(self):
        n = self.count
        for shape in ((n - 1,), (n + 1,), (0,), (1,), (1, n), (n, 1), (2, n), (1, 1, n)):
            self.unchanged_by(mien.ArgumentError, numpy.zeros(shape, "f"))
        self.unchanged_by(ValueError, [])
        batch = self.rig.batch(3)
        for shape in ((2, n), (3, n - 1), (n, 3), (3, 1), (1, n), (3, n, 1), (n + 1,)):
            self.unchanged_by(mien.ArgumentError, numpy.zeros(shape, "f"), batch)

    @needs_numpy
    def test_wrong_types(self):
        n = self.count
        for values in (numpy.zeros(n, complex), numpy.array(["x"] * n), numpy.array([None] * n),
                       numpy.zeros(n, "datetime64[s]"), "text", None, {}, object()):
            self.unchanged_by(TypeError, values)
        self.unchanged_by((TypeError, ValueError), [[1, 2], [3]])

    @needs_numpy
    def test_other_numbers_are_converted(self):
        n = self.count
        wanted = numpy.array(pattern(n), "f")
        for kind in ("f8", "f2", ">f4", ">f8"):
            self.face.raw_controls = wanted.astype(kind)
            numpy.testing.assert_array_equal(self.face.raw_controls,
                                             wanted.astype(kind).astype("f"))
        self.face.raw_controls = numpy.arange(n, dtype=">i2")
        numpy.testing.assert_array_equal(self.face.raw_controls, numpy.arange(n))
        self.face.raw_controls = pattern(n)
        numpy.testing.assert_array_equal(self.face.raw_controls, wanted)
        self.face.raw_controls = 0.25
        self.assertTrue((self.face.raw_controls == 0.25).all())

    @needs_numpy
    def test_input_that_is_not_contiguous(self):
        n = self.count
        wide = numpy.arange(3 * n, dtype="f")
        self.face.raw_controls = wide[::3]
        numpy.testing.assert_array_equal(self.face.raw_controls, wide[::3])
        self.face.raw_controls = wide[:n][::-1]
        numpy.testing.assert_array_equal(self.face.raw_controls, wide[:n][::-1])
        self.face.raw_controls = self.face.raw_controls[::-1]  # over itself
        numpy.testing.assert_array_equal(self.face.raw_controls, wide[:n])
        batch, rows = self.rig.batch(4), numpy.arange(4 * n, dtype="f8").reshape(n, 4).T
        batch.raw_controls = rows
        numpy.testing.assert_array_equal(batch.raw_controls, rows)

    @needs_numpy
    def test_outputs_cannot_be_written(self):
        batch = self.rig.batch(2)
        for thing in (self.face, batch):
            for name in ("controls", "joints", "blend_shapes", "animated_maps"):
                values = getattr(thing, name)
                self.assertFalse(values.flags.writeable, name)
                with self.assertRaises(ValueError):
                    values[...] = 1
                with self.assertRaises(ValueError):
                    values.flags.writeable = True
                with self.assertRaises(AttributeError):
                    setattr(thing, name, 0)
        for name in ("neutral_joint_values", "joint_parents", "initial_raw_controls"):
            with self.assertRaises(ValueError):
                getattr(self.rig, name).flags.writeable = True

    @needs_numpy
    def test_views_are_views(self):
        face, batch = self.face, self.rig.batch(3)
        self.assertIs(face.joints, face.joints)
        self.assertIs(face.raw_controls, face.raw_controls)
        joints = face.joints
        face.raw_controls[:] = pattern(self.count)
        face.evaluate()
        self.assertTrue(joints.any())
        self.assertTrue(numpy.shares_memory(face.controls, face.raw_controls))
        self.assertTrue(numpy.shares_memory(batch.joints, batch[1].joints))
        self.assertFalse(numpy.shares_memory(batch[0].joints, batch[1].joints))
        batch.raw_controls[1] = face.raw_controls
        batch[1].evaluate()
        numpy.testing.assert_array_equal(batch.joints[1], joints)

    @needs_numpy
    def test_indices_past_the_end(self):
        for values in (self.face.raw_controls, self.face.joints, self.rig.joint_parents):
            with self.assertRaises(IndexError):
                values[len(values)]


class Numbers(unittest.TestCase):
    def setUp(self):
        self.rig = rig_of()
        self.face = self.rig.instance()

    def test_lods(self):
        batch = self.rig.batch(2)
        for lod in (self.rig.lod_count, -1, 2**32, 2**64, -2**32):
            for use in (self.face.evaluate, batch.evaluate, lambda lod: batch.evaluate([0, lod]),
                        self.rig.statistics, self.rig.variable_joint_values,
                        lambda lod: self.face.evaluate(lod, mien.Stage.PSD),
                        lambda lod: self.face.evaluate_joint_group(0, lod),
                        lambda lod: self.rig.lod_indices(mien.Kind.JOINT, lod)):
                with self.assertRaises((mien.OutOfRangeError)) as caught:
                    use(lod)
                self.assertIsInstance(caught.exception, IndexError)
        for lod in ("0", None, 0.5, [0]):
            with self.assertRaises((TypeError, mien.ArgumentError)):
                self.face.evaluate(lod)
        for lods in ([0], [0, 0, 0], "ab", [0, None], 1.5, None):
            with self.assertRaises((TypeError, mien.ArgumentError)):
                batch.evaluate(lods)

    @needs_numpy
    def test_numbers_of_numpy(self):
        self.face.evaluate(numpy.int64(0))
        self.face.evaluate(numpy.uint8(0))
        self.rig.batch(3).evaluate(numpy.array([0, 1, 0]))
        self.assertEqual(self.rig.name(mien.Kind.JOINT, numpy.int16(1)),
                         self.rig.name(mien.Kind.JOINT, 1))

    def test_indices_and_kinds(self):
        rig, face = self.rig, self.face
        for use in (lambda: rig.name(mien.Kind.JOINT, rig.count(mien.Kind.JOINT)),
                    lambda: rig.name(mien.Kind.JOINT, -1), lambda: rig.psd_inputs(10**6),
                    lambda: rig.name(mien.Kind.JOINT, 2**32),
                    lambda: face.evaluate_joint_group(10**6),
                    lambda: face.evaluate_rbf_solver(10**6),
                    lambda: face.evaluate_twist_swing(10**6)):
            with self.assertRaises(mien.OutOfRangeError):
                use()
        for use in (lambda: rig.count(99), lambda: rig.name(99, 0), lambda: rig.find(99, "x"),
                    lambda: rig.lod_indices(mien.Kind.RAW_CONTROL, 0),
                    lambda: face.evaluate(0, 64)):
            with self.assertRaises(mien.ArgumentError):
                use()

    def test_names(self):
        for name in ("", "nobody", "x" * 100000, "CTRL_\udcff", "a\0b"):
            with self.assertRaises(mien.UnknownNameError) as caught:
                self.rig.find(mien.Kind.JOINT, name)
            self.assertIsInstance(caught.exception, KeyError)
            self.assertEqual(caught.exception.status, mien.Status.NAME)
            with self.assertRaises(KeyError):
                self.face[name]
        self.assertIn("raw control 'nobody'", str(self._error(lambda: self.face["nobody"])))
        with self.assertRaises((TypeError, AttributeError)):
            self.rig.find(mien.Kind.JOINT, 3)

    def test_names_of_other_tools(self):
        for name in ("", "nobody", "x" * 100000, "CTRL_\udcff", "a\0b"):
            for use in (self.rig.match, mien.control_name):
                with self.assertRaises(mien.UnknownNameError):
                    use(name)
        self.assertEqual(mien.control_name("AU12_L"), "mouthSmileLeft")
        name = self.rig.names(mien.Kind.RAW_CONTROL)[0]
        self.assertEqual(self.rig.match(name.upper()), (mien.NameMatch.AS_WRITTEN, {0: 1.0}))

    def test_descriptions(self):
        dna = dna_of()
        for use in (lambda: mien.Rig(dna, isa=99), lambda: mien.Rig(dna, rotation=2),
                    lambda: mien.Rig(dna, ml_masks=9), lambda: mien.Rig(dna, storage=9),
                    lambda: mien.Rig(dna, arithmetic=9), lambda: mien.Dna.generate(flags=99),
                    lambda: mien.Rig(dna, isa=-1), lambda: mien.Dna.generate(99),
                    lambda: mien.Dna.open("x", lods=[]), lambda: mien.Dna.open("x", lods=[64])):
            with self.assertRaises(mien.Error):
                use()
        absent = [isa for isa in mien.Isa if not mien.isa_available(isa)]
        for isa in absent:
            self.assertEqual(self._error(lambda: mien.Rig(dna, isa=isa)).status, mien.Status.ISA)
        for count in (-1, 2**20 + 1, 2**64):
            with self.assertRaises(mien.ArgumentError):
                self.rig.batch(count)
        for tasks in (-1, 2**32):
            with self.assertRaises(mien.OutOfRangeError):
                self.rig.batch(1, tasks)
        with self.assertRaises(mien.ArgumentError):
            self.rig.batch(2).evaluate(stages=1 << 20)
        self.assertGreater(self.rig.batch(3, tasks=2).scratch_bytes, 0)
        with self.assertRaises((TypeError, AttributeError)):
            mien.Rig("head.dna")

    def test_structs_take_their_own_fields_alone(self):
        for name, values in (("MienRigDesc", {"isaa": 1}), ("MienRigDesc", {"struct_size": 1}),
                             ("MienDnaDesc", {"reserved": 0}), ("MienRigInfo", {"lod_count": 1})):
            with self.assertRaises(TypeError):
                getattr(mien._api, name)(**values)
        desc = mien._api.MienRigDesc(arithmetic=mien.Arithmetic.PORTABLE)
        self.assertEqual((desc.arithmetic, desc.isa), (1, 0))

    def test_documentation_tells_why_calls_fail(self):
        self.assertIn("OutOfRangeError (LOD): the rig has no such LOD", mien.Instance.evaluate.__doc__)
        self.assertNotIn("MISMATCH", mien.Instance.evaluate.__doc__)
        self.assertIn("Raises:", mien.Rig.__init__.__doc__)

    def test_instances_of_other_rigs(self):
        stranger = fresh_rig().instance()
        stranger.rig = self.rig
        with self.assertRaises(mien.ArgumentError) as caught:
            stranger.evaluate()
        self.assertEqual(caught.exception.status, mien.Status.MISMATCH)

    def _error(self, use):
        with self.assertRaises(mien.Error) as caught:
            use()
        return caught.exception


class Systems(unittest.TestCase):
    @needs_numpy
    def test_a_file_in_another_system(self):
        data = dna_of().to_bytes()
        names = mien.coordinate_system_names()
        self.assertIn("unreal", names)
        for name in names:
            system = mien.coordinate_system(name)
            dna = mien.Dna.from_bytes(data, system=name)
            self.assertEqual(dna.info.axes, system.axes)
            same = mien.Dna.from_bytes(data, system=system)
            numpy.testing.assert_array_equal(mien.Rig(dna).neutral_joint_values,
                                             mien.Rig(same).neutral_joint_values)
        meters = mien.coordinate_system("maya")._replace(
            translation_unit=mien.TranslationUnit.METERS)
        dna = mien.Dna.from_bytes(data, system=meters)
        self.assertEqual(dna.info.translation_unit, mien.TranslationUnit.METERS)
        numpy.testing.assert_allclose(mien.Rig(dna).neutral_joint_values[:, :3] * 100,
                                      rig_of().neutral_joint_values[:, :3], atol=1e-4)

    def test_systems_that_are_none(self):
        data = dna_of().to_bytes()
        for name in ("", "nothing", "Unreal", "x" * 10000, "a\0b"):
            with self.assertRaises(mien.UnknownNameError):
                mien.Dna.from_bytes(data, system=name)
        flat = mien.coordinate_system("maya")._replace(axes=(0, 0, 0))
        for wrong in (flat, flat._replace(axes=(0, 2, 99)), flat._replace(rotation_rule=99)):
            with self.assertRaises(mien.Error):
                mien.Dna.from_bytes(data, system=wrong)
        for wrong in (flat._replace(axes="xyz"), flat._replace(axes=(1, 2, 3, 4)), 3, b"maya"):
            with self.assertRaises((TypeError, ValueError, RuntimeError, AttributeError)):
                mien.Dna.from_bytes(data, system=wrong)


class Files(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = Path(directory.name)
        self.data = dna_of().to_bytes()

    def test_files_that_are_not_there(self):
        for use in (mien.Dna.open, mien.validate, lambda p: dna_of().save(p / "x")):
            with self.assertRaises(OSError) as caught:
                use(self.directory / "no.dna")
            self.assertIsInstance(caught.exception, mien.FileError)
            self.assertIn("no.dna", str(caught.exception))
            self.assertIsNone(caught.exception.byte_offset)
        for use in (mien.Dna.open, mien.validate, dna_of().save):
            with self.assertRaises(mien.ArgumentError):
                use("zero\0byte")

    def test_damaged_files_tell_where(self):
        for data, status in ((self.data[:100], mien.Status.DNA_TRUNCATED),
                             (b"no DNA, but long enough to be one", mien.Status.DNA_SIGNATURE),
                             (b"", mien.Status.DNA_SIGNATURE)):
            with self.assertRaises(mien.DnaError) as caught:
                mien.Dna.from_bytes(data)
            error = caught.exception
            self.assertIsInstance(error, ValueError)
            self.assertEqual(error.status, status)
            self.assertEqual(str(error), error.message)
            self.assertLessEqual(error.byte_offset or 0, len(data))
            self.assertTrue(mien.validate(data))
            again = pickle.loads(pickle.dumps(error))
            self.assertEqual((type(again), again.status, again.message, again.byte_offset),
                             (type(error), error.status, error.message, error.byte_offset))

    def test_every_truncation_and_many_flips(self):
        data = mien.Dna.generate().to_bytes()
        for end in range(0, len(data), 401):
            with self.assertRaises(mien.DnaError):
                mien.Dna.from_bytes(data[:end])
        for i in range(0, len(data), 211):
            damaged = bytearray(data)
            damaged[i] ^= 0x81
            try:
                dna = mien.Dna.from_bytes(damaged)
                dna.read("")
                mien.Rig(dna).instance().evaluate()
            except mien.Error:
                pass

    def test_things_that_are_no_bytes(self):
        for data in (None, 3, "text", [1, 2]):
            with self.assertRaises(TypeError):
                mien.Dna.from_bytes(data)

    def test_round_trips(self):
        path = self.directory / "ünïcode.dna"
        dna_of().save(path)
        self.assertEqual(path.read_bytes(), self.data)
        for source in (path, str(path), os.fsencode(path)):
            with mien.Dna.open(source) as dna:
                self.assertEqual(dna.to_bytes(), self.data)
        self.assertEqual(mien.Dna.from_bytes(memoryview(self.data)).to_bytes(), self.data)
        self.assertFalse(mien.Dna.open(path).info.is_mapped)
        self.assertTrue(mien.Dna.open(path, access=mien.FileAccess.MAP).info.is_mapped)
        self.assertEqual(mien.Dna.from_bytes(dna_of().to_bytes(version=1)).info.version, 1)
        findings = mien.validate(path)
        self.assertEqual([f for f in findings if f.severity == mien.Severity.ERROR], [])

    def test_fields(self):
        dna = dna_of()
        info = dna.info
        names = dna.read("defn.jointNames")
        self.assertEqual(len(names), info.joint_count)
        self.assertEqual(dna.read("defn.jointNames[2]"), names[2])
        self.assertEqual(dna["desc.lodCount"], info.lod_count)
        xs = dna.read("defn.neutralJointTranslations.xs")
        self.assertEqual(len(xs), info.joint_count)
        self.assertEqual(dna.read("defn.neutralJointTranslations.xs[1]"), xs[1])
        self.assertEqual(list(dna.read("defn.neutralJointTranslations")), ["xs", "ys", "zs"])
        self.assertEqual(dna.field("defn.jointNames").type, mien.FieldType.LIST)
        self.assertIsNone(dna.field("defn").byte_offset)
        self.assertEqual(set(dna.fields()), set(dna.read("")))
        for path, error in (("defn.nothing", KeyError), ("defn.jointNames[999999]", IndexError),
                            ("a\0b", ValueError), ("[", mien.Error), ("x" * 100000, KeyError)):
            with self.assertRaises(error):
                dna.read(path)

    def test_chosen_layers_and_lods(self):
        dna = mien.Dna.from_bytes(self.data, layers=mien.Layer.DEFINITION)
        with self.assertRaises(mien.DnaError) as caught:
            mien.Rig(dna)
        self.assertEqual(caught.exception.status, mien.Status.DNA_LAYER)
        cut = mien.Dna.from_bytes(self.data, lods=[1])
        self.assertEqual(cut.info.lod_count, 1)
        with self.assertRaises(mien.OutOfRangeError):
            mien.Dna.from_bytes(self.data, lods=[63])
        for skip in (False, True):
            dna = mien.Dna.from_bytes(self.data, skip_blend_shape_targets=skip)
            self.assertEqual(dna.info.has_blend_shape_targets, not skip)


if __name__ == "__main__":
    unittest.main()
