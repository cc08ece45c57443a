# SPDX-License-Identifier: MIT
"""Instances as mappings of raw controls, mistyped names, missing files, pools inside pools."""
import os
import subprocess
import sys
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import mien
from support import needs_numpy, rig_of


class Mapping(unittest.TestCase):
    def setUp(self):
        self.rig = rig_of()
        self.face = self.rig.instance()
        self.names = self.rig.names(mien.Kind.RAW_CONTROL)

    def test_reads_like_a_dict(self):
        self.assertEqual(list(self.face), self.names)
        self.assertEqual(len(self.face), len(self.names))
        self.assertIn(self.names[0], self.face)
        self.assertNotIn("no such control", self.face)
        self.assertNotIn(3, self.face)
        self.face[self.names[1]] = 0.5
        self.assertEqual(dict(self.face)[self.names[1]], 0.5)

    def test_update_sets_all_or_nothing(self):
        self.face.update({self.names[0]: 0.25, self.names[2]: 1})
        self.assertEqual(self.face[self.names[0]], 0.25)
        self.assertEqual(self.face[self.names[2]], 1.0)
        with self.assertRaises(mien.UnknownNameError):
            self.face.update({self.names[0]: 0.75, "no such control": 1})
        with self.assertRaises((TypeError, ValueError)):
            self.face.update({self.names[0]: 0.75, self.names[1]: None})
        self.assertEqual(self.face[self.names[0]], 0.25)

    def test_only_numbers_are_values(self):
        for value in (None, "1"):
            with self.assertRaises(TypeError):
                self.face[self.names[0]] = value
        self.assertEqual(self.face[self.names[0]], 0.0)

    def test_mistyped_attributes_are_refused(self):
        dna = mien.Dna.generate()
        for thing in (self.face, self.rig, self.rig.batch(2), dna, mien.Deformer(dna, mien.Rig(dna))):
            with self.assertRaises(AttributeError):
                thing.raw_control_values = 1


class Mistakes(unittest.TestCase):
    def test_a_rig_of_a_path_names_the_calls_to_use(self):
        with self.assertRaises(TypeError) as raised:
            mien.Rig("head.dna")
        self.assertIn("Dna.open", str(raised.exception))

    def test_missing_files_are_file_not_found_errors(self):
        with tempfile.TemporaryDirectory() as directory:
            path = Path(directory) / "missing.dna"
            with self.assertRaises(FileNotFoundError) as raised:
                mien.Dna.open(path)
            self.assertEqual(raised.exception.filename, str(path))
            self.assertEqual(raised.exception.errno, 2)
            self.assertIsInstance(raised.exception, mien.FileError)

    @unittest.skipIf(os.name != "posix" or os.geteuid() == 0, "root may read everything")
    def test_forbidden_files_are_permission_errors(self):
        with tempfile.NamedTemporaryFile() as file:
            os.chmod(file.name, 0)
            with self.assertRaises(PermissionError):
                mien.Dna.open(file.name)


# A deadlock would hang this process, so it happens in another one.
NESTED = """
from concurrent.futures import ThreadPoolExecutor
import mien
rig = mien.Rig(mien.Dna.generate(mien.Preset.SMALL))
batch = rig.batch(64, tasks=2)
with ThreadPoolExecutor(1) as pool:
    pool.submit(batch.evaluate, 0, threads=pool).result()
print("done")
"""


class Pools(unittest.TestCase):
    @needs_numpy
    def test_a_job_may_use_its_own_pool(self):
        done = subprocess.run([sys.executable, "-c", NESTED], capture_output=True, text=True,
                              timeout=120)
        self.assertEqual(done.stdout.strip(), "done", done.stderr)

    @needs_numpy
    def test_batches_have_the_arrays_of_instances(self):
        batch = rig_of().batch(3)
        with ThreadPoolExecutor(2) as pool:
            batch.raw_controls = 0.5
            batch.evaluate(threads=pool)
        for name in ("psd_controls", "ml_controls", "rbf_controls", "controls"):
            values = getattr(batch, name)
            self.assertEqual(values.shape[0], 3)
            for i in range(3):
                self.assertTrue((values[i] == getattr(batch[i], name)).all(), name)


if __name__ == "__main__":
    unittest.main()
