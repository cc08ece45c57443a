# SPDX-License-Identifier: MIT
"""mien.farm: arrays of Dask hold what instances compute, whatever the chunks."""
import os
import sys
import tempfile
import unittest

import mien
from support import dna_of, numpy, pattern, rig_of

try:
    import dask
    import dask.array
    from mien import farm
except ImportError:
    print("NOT TESTED: mien.farm; this interpreter has no Dask (python3-dask)", file=sys.stderr)
    dask = None

FRAMES = 9


@unittest.skipIf(dask is None, "NOT TESTED: mien.farm; this interpreter has no Dask")
class Farm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.rig = rig_of()
        cls.deformer = mien.Deformer(dna_of(), cls.rig)
        cls.rig.bake(cls.path("head.rig"), cls.deformer)
        names = cls.rig.names(mien.Kind.RAW_CONTROL)
        cls.rows = numpy.array([pattern(len(names), f) for f in range(FRAMES)], numpy.float32)
        numpy.save(cls.path("take.npy"), cls.rows)
        mien.Clip.build(names, cls.rows).save(cls.path("take.clip"))
        dask.config.set(scheduler="synchronous")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder.name, name)

    def test_joints_and_positions(self):
        face, pose = self.rig.instance(), self.deformer.instance()
        mesh = self.deformer.mesh(0)
        for take in ("take.npy", "take.clip"):
            rig, take = self.path("head.rig"), self.path(take)
            joints = [farm.evaluate(rig, take, chunk=chunk).compute() for chunk in (4, 1000)]
            faces = [farm.deform(rig, take, mesh.name, chunk=chunk).compute() for chunk in (2, 1000)]
            self.assertEqual(joints[0].tobytes(), joints[1].tobytes())
            self.assertEqual(faces[0].tobytes(), faces[1].tobytes())
            for f in range(FRAMES):
                face.reset()
                face.raw_controls = self.rows[f]
                face.evaluate()
                pose.update(face)
                pose.deform(0)
                numpy.testing.assert_array_equal(joints[0][f], face.joints)
                numpy.testing.assert_array_equal(faces[0][f], pose.positions(0))

    def test_zarr_and_npy(self):
        joints = farm.evaluate(self.path("head.rig"), self.path("take.npy"), chunk=4)
        dask.array.to_npy_stack(self.path("stack"), joints)
        numpy.testing.assert_array_equal(dask.array.from_npy_stack(self.path("stack")).compute(), joints.compute())
        try:
            import zarr
        except ImportError:
            print("NOT TESTED: arrays as Zarr; there is no python3-zarr", file=sys.stderr)
            return
        joints.to_zarr(self.path("joints.zarr"))
        numpy.testing.assert_array_equal(zarr.open(self.path("joints.zarr"))[:], joints.compute())

    def test_bake(self):
        dna_of().save(self.path("head.dna"))
        dask.compute(farm.bake(self.path("head.dna"), self.path("baked.rig")))
        found, wanted = (farm.evaluate(self.path(name), self.path("take.npy")).compute()
                         for name in ("baked.rig", "head.rig"))
        numpy.testing.assert_array_equal(found, wanted)

    def test_pieces_do_not_raise(self):
        program = self.path("program")  # prints its arguments and fails for the second piece
        with open(program, "w") as file:
            file.write("#!/bin/sh\necho \"$@\" >&2\n[ \"$4\" != 2/3 ]\n")
        os.chmod(program, 0o755)
        done = dask.compute(*farm.render("job.json", 3, program))
        self.assertEqual([(piece, code) for piece, code, _ in done], [(1, 0), (2, 1), (3, 0)])
        self.assertEqual(done[1][2], "farm job.json --piece 2/3 --resume --quiet\n")

    def test_wrong_arguments(self):
        rig, take = self.path("head.rig"), self.path("take.npy")
        with self.assertRaises(mien.ArgumentError):
            farm.evaluate(rig, take, chunk=0)
        with self.assertRaises(mien.ArgumentError):
            farm.render("job.json", 0)
        with self.assertRaises(mien.FileError):
            farm.evaluate(self.path("none.rig"), take)
        with self.assertRaises(mien.OutOfRangeError):
            farm.evaluate(rig, take, lod=99).compute()
        with self.assertRaises(mien.UnknownNameError):
            farm.deform(rig, take, "no such mesh")


if __name__ == "__main__":
    unittest.main()
