# SPDX-License-Identifier: MIT
"""Closing, forking and threads, in every order: exceptions or right answers, never a crash."""
import copy
import gc
import os
import pickle
import sys
import threading
import unittest
import weakref

import mien
from support import fresh_rig, needs_numpy, numpy, pattern, rig_of, run


def evaluated(rig, phase=0, lod=0):
    """Joint values of a character of its own, as a list."""
    with rig.instance() as face:
        face.raw_controls = pattern(len(face.raw_controls), phase)
        face.evaluate(lod)
        return face.joints.tolist()


class Closing(unittest.TestCase):
    def test_everything_raises_after_close(self):
        rig = fresh_rig()
        face = rig.instance()
        name = rig.name(mien.Kind.RAW_CONTROL, 0)
        face.close()
        self.assertTrue(face.closed)
        for use in (lambda: face.evaluate(), lambda: face.evaluate(stages=mien.Stage.PSD),
                    lambda: face.map_gui_to_raw(), lambda: face.map_raw_to_gui(),
                    lambda: face.evaluate_joint_group(0), lambda: face.evaluate_rbf_solver(0),
                    lambda: face.evaluate_twist_swing(0), lambda: face.reset(),
                    lambda: face.raw_controls, lambda: face.joints, lambda: face.ml_masks,
                    lambda: face[name], lambda: face.__setitem__(name, 1),
                    lambda: face.__enter__()):
            with self.assertRaises(mien.ClosedError):
                use()
        with self.assertRaises(mien.ClosedError):
            face.raw_controls = 0

    def test_closing_twice(self):
        dna = mien.Dna.generate()
        rig = mien.Rig(dna)
        for thing in (rig.instance(), rig.batch(2), dna, rig):
            thing.close()
            thing.close()
            with self.assertRaises(mien.ClosedError):
                thing.__enter__()
            self.assertIn("closed", repr(thing))

    def test_with_closes_when_an_exception_passes(self):
        rig = fresh_rig()
        with self.assertRaises(ZeroDivisionError):
            with rig.instance() as face:
                1 / 0
        self.assertTrue(face.closed)

    @needs_numpy
    def test_arrays_survive_their_instance(self):
        face = rig_of().instance()
        face.raw_controls = pattern(len(face.raw_controls))
        face.evaluate()
        joints, raw, corner = face.joints, face.raw_controls, face.joints[3:, :3][::2]
        wanted, wanted_corner = joints.copy(), corner.copy()
        face.close()
        del face
        gc.collect()
        others = [rig_of().instance() for _ in range(20)]  # would take freed memory
        for other in others:
            other.raw_controls = 0.5
            other.evaluate()
        numpy.testing.assert_array_equal(joints, wanted)
        numpy.testing.assert_array_equal(corner, wanted_corner)
        raw[:] = 3  # still writable, though nobody will read it
        del joints
        numpy.testing.assert_array_equal(corner, wanted_corner)

    @needs_numpy
    def test_arrays_survive_rig_and_dna(self):
        dna = mien.Dna.generate(mien.Preset.SMALL)
        rig = mien.Rig(dna)
        face = rig.instance()
        face.evaluate()
        neutral, parents, joints = rig.neutral_joint_values, rig.joint_parents, face.joints
        wanted = neutral.copy()
        for thing in (rig, dna, face):
            thing.close()
        del rig, dna, face
        gc.collect()
        numpy.testing.assert_array_equal(neutral, wanted)
        self.assertTrue((parents <= numpy.arange(len(parents))).all())
        self.assertTrue(numpy.isfinite(joints).all())

    @needs_numpy
    def test_arrays_survive_their_batch(self):
        batch = rig_of().batch(3)
        batch.raw_controls = pattern(batch.raw_controls.shape[1])
        batch.evaluate()
        one, row, wanted = batch[1], batch.joints[2], batch.joints[2].copy()
        batch.close()
        with self.assertRaises(mien.ClosedError):
            one.evaluate()
        for use in (batch.evaluate, batch.reset, batch.map_gui_to_raw, lambda: batch.joints):
            with self.assertRaises(mien.ClosedError):
                use()
        del batch, one
        gc.collect()
        rig_of().batch(8).evaluate()
        numpy.testing.assert_array_equal(row, wanted)

    @needs_numpy
    def test_an_instance_survives_its_batch(self):
        rig = rig_of()
        one = rig.batch(3)[1]
        gc.collect()
        one.raw_controls = pattern(len(one.raw_controls))
        one.evaluate()
        self.assertEqual(one.joints.tolist(), evaluated(rig))

    def test_memory_is_released_at_once(self):
        face = fresh_rig().instance()
        handle = weakref.ref(face._handle)
        joints = face.joints
        face.close()
        self.assertIsNotNone(handle())
        del joints
        self.assertIsNone(handle())  # no collector needed

    def test_memory_of_batches_is_released_at_once(self):
        batch = fresh_rig().batch(4)
        slab = weakref.ref(batch._slab)
        batch[0].evaluate()
        batch.evaluate()
        del batch
        self.assertIsNone(slab())

    def test_a_closed_rig_evaluates_no_more(self):
        rig = fresh_rig()
        face, batch = rig.instance(), rig.batch(2)
        rig.close()
        for use in (face.evaluate, face.map_gui_to_raw, batch.evaluate, rig.instance,
                    lambda: rig.batch(1), lambda: rig.count(mien.Kind.JOINT),
                    lambda: rig.names(mien.Kind.JOINT), lambda: rig.joint_parents,
                    lambda: rig.statistics(0)):
            with self.assertRaises(mien.ClosedError):
                use()
        self.assertEqual(len(face.raw_controls), face.raw_controls.shape[0])

    def test_the_bytes_of_a_dna_are_kept(self):
        data = mien.Dna.generate(mien.Preset.SMALL).to_bytes()
        changing = bytearray(data)
        dna, copied = mien.Dna.from_bytes(bytes(data)), mien.Dna.from_bytes(changing)
        changing[:] = b"\xff" * len(changing)
        del data
        gc.collect()
        self.assertEqual(dna.read("defn.jointNames"), copied.read("defn.jointNames"))
        mien.Rig(copied).instance().evaluate()

    def test_addresses_do_not_travel(self):
        dna = mien.Dna.generate()
        rig = mien.Rig(dna)
        face = rig.instance()
        for thing in (dna, face, rig.batch(2), face._handle, rig._handle, dna._handle):
            for travel in (pickle.dumps, copy.copy, copy.deepcopy):
                with self.assertRaises(TypeError):
                    travel(thing)

    def test_rigs_travel_as_baked_bytes(self):
        rig = mien.Rig(mien.Dna.generate(mien.Preset.SMALL))
        other = pickle.loads(pickle.dumps(rig))
        self.assertEqual(other.to_bytes(), rig.to_bytes())
        self.assertIs(copy.copy(rig), rig)
        self.assertIs(copy.deepcopy(rig), rig)
        face = other.instance()
        rig.close()
        face.evaluate()

    def test_baked_bytes_live_as_long_as_what_reads_them(self):
        dna = mien.Dna.generate(mien.Preset.SMALL)
        made = mien.Rig(dna)
        data = made.to_bytes(mien.Deformer(dna, made))
        count = sys.getrefcount(data)
        baked = mien.Baked.from_bytes(data)
        rig = baked.rig()
        deformer = baked.deformer(rig)
        face, pose = rig.instance(), deformer.instance()
        for thing in (baked, rig, deformer):
            thing.close()
        gc.collect()
        self.assertGreater(sys.getrefcount(data), count)
        face.reset()
        pose.deform(0)
        face.close()
        self.assertGreater(sys.getrefcount(data), count)
        pose.close()
        del baked, rig, deformer, face, pose, thing
        gc.collect()
        self.assertEqual(sys.getrefcount(data), count)

    def test_end_of_the_process_with_everything_open(self):
        run("""
import mien
dna = mien.Dna.generate(mien.Preset.SMALL)
rig = mien.Rig(dna)
faces = [rig.instance() for _ in range(3)]
batch = rig.batch(4)
arrays = [face.joints for face in faces]
class Cycle: pass
Cycle.itself, Cycle.things = Cycle, (dna, rig, faces, batch, arrays)
batch.evaluate()
""")


class Forking(unittest.TestCase):
    @unittest.skipUnless(hasattr(os, "fork"), "NOT TESTED: no fork on this system")
    def test_parent_and_child_have_a_character_each(self):
        rig = rig_of()
        face, batch = rig.instance(), rig.batch(2)
        face.raw_controls = pattern(len(face.raw_controls))
        face.evaluate()
        before, wanted = face.joints.tolist(), evaluated(rig, 1)
        child = os.fork()
        if child == 0:
            code = 1
            try:
                face.raw_controls = pattern(len(face.raw_controls), 1)
                face.evaluate()
                batch.evaluate()
                same = face.joints.tolist() == wanted
                face.close()
                rig.close()
                code = 0 if same else 2
            finally:
                os._exit(code)
        self.assertEqual(os.waitpid(child, 0)[1], 0)
        self.assertEqual(face.joints.tolist(), before)
        face.evaluate()
        self.assertEqual(face.joints.tolist(), before)

    @unittest.skipUnless(hasattr(os, "fork"), "NOT TESTED: no fork on this system")
    def test_worker_processes(self):
        run("""
import multiprocessing, mien
rig = mien.Rig(mien.Dna.generate(mien.Preset.SMALL))
def work(value):
    face = rig.instance()
    face.raw_controls = value
    face.evaluate()
    return bytes(face.joints)
values = [i / 10 for i in range(8)]
with multiprocessing.get_context("fork").Pool(4) as pool:
    assert pool.map(work, values) == [work(value) for value in values]
""")


class Threads(unittest.TestCase):
    def run_all(self, count, work):
        failures = []

        def guarded(i):
            try:
                work(i)
            except BaseException as error:
                failures.append(error)

        threads = [threading.Thread(target=guarded, args=(i,)) for i in range(count)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        if failures:
            raise failures[0]

    def test_eight_threads_on_one_rig(self):
        rig = rig_of(mien.Preset.MEDIUM)
        wanted = [evaluated(rig, i) for i in range(8)]

        def work(i):
            face = rig.instance()
            for turn in range(30):
                face.raw_controls = pattern(len(face.raw_controls), (i + turn) % 8)
                face.evaluate()
                self.assertEqual(face.joints.tolist(), wanted[(i + turn) % 8])
                rig.names(mien.Kind.RAW_CONTROL), rig.statistics(0), rig.joint_parents

        self.run_all(8, work)

    def test_eight_threads_on_one_instance(self):
        """A second thread gets an exception; each evaluation that is let in comes to its end."""
        rig = rig_of(mien.Preset.LARGE)
        face = rig.instance()
        counts = [0] * 8

        def work(i):
            for _ in range(200):
                try:
                    face.evaluate()
                    counts[i] += 1
                except mien.BusyError:
                    pass

        self.run_all(8, work)
        self.assertGreater(sum(counts), 0)
        face.raw_controls = pattern(len(face.raw_controls))
        face.evaluate()
        self.assertEqual(face.joints.tolist(), evaluated(rig))

    def test_closing_while_others_evaluate(self):
        rig = rig_of(mien.Preset.LARGE)
        for _ in range(10):
            faces, batch = [rig.instance() for _ in range(3)], rig.batch(4)
            start = threading.Barrier(8)

            def work(i):
                start.wait()
                if i >= 6:
                    for thing in (*faces, batch):
                        thing.close()
                    return
                try:
                    for _ in range(50):
                        (faces + [batch])[i % 4].evaluate()
                except (mien.ClosedError, mien.BusyError):
                    pass

            self.run_all(8, work)

    def test_eight_threads_on_one_dna(self):
        dna = mien.Dna.generate(mien.Preset.SMALL)

        def read():
            return list(dna.read("bhvr.joints")), dna.read("defn.jointNames")

        wanted = read()

        def work(i):
            for _ in range(20):
                self.assertEqual(read(), wanted)
                mien.Rig(dna).instance().evaluate()

        self.run_all(8, work)


if __name__ == "__main__":
    unittest.main()
