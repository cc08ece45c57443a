# SPDX-License-Identifier: MIT
"""The wheel: complete, true to its list, and found without being told where the library is."""
import base64
import csv
import hashlib
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

import mien
from support import PACKAGE

CODE = """
import mien, os, sys
where = os.path.dirname(os.path.abspath(mien.__file__))
assert os.path.dirname(mien.library_path) == where, mien.library_path
rig = mien.Rig(mien.Dna.generate())
rig.instance().evaluate()
print(where)
"""


class Wheel(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = Path(directory.name)
        output = subprocess.run(
            [sys.executable, PACKAGE / "build_wheel.py", "--library", mien.library_path,
             "--output", self.directory], check=True, capture_output=True, text=True).stdout
        self.wheel = Path(output.strip())
        self.environment = {k: v for k, v in os.environ.items()
                            if k not in ("MIEN_LIBRARY", "PYTHONPATH")}

    def test_what_is_in_it(self):
        self.assertRegex(self.wheel.name, rf"^mien-{mien.version()}-py3-none-\w+\.whl$")
        with zipfile.ZipFile(self.wheel) as archive:
            self.assertIsNone(archive.testzip())
            names = archive.namelist()
            info = f"mien-{mien.version()}.dist-info"
            with archive.open(f"{info}/RECORD") as file:
                rows = list(csv.reader(file.read().decode().splitlines()))
            self.assertEqual([row[0] for row in rows], names)
            for name, digest, size in rows[:-1]:
                data = archive.read(name)
                found = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=")
                self.assertEqual((digest, size), ("sha256=" + found.decode(), str(len(data))))
            metadata = archive.read(f"{info}/METADATA").decode()
            self.assertIn(f"Version: {mien.version()}\n", metadata)
            for name in [f"mien/{file.name}" for file in (PACKAGE / "mien").glob("*.py")]:
                self.assertIn(name, names)
            self.assertIn("mien/py.typed", names)
            libraries = [name for name in names if re.match(r"mien/(lib)?mien", name)]
            self.assertEqual(len(libraries), 3, names)

    def test_it_runs_where_it_is_put(self):
        place = self.directory / "place with spaces"
        with zipfile.ZipFile(self.wheel) as archive:
            archive.extractall(place)
        output = subprocess.run([sys.executable, "-c", CODE], check=True, capture_output=True,
                                text=True, cwd="/", env={**self.environment, "PYTHONPATH": place})
        self.assertEqual(Path(output.stdout.strip()), place / "mien")

    def test_pip_takes_it(self):
        pip = [sys.executable, "-m", "pip"]
        if subprocess.run(pip + ["--version"], capture_output=True).returncode:
            self.skipTest("NOT TESTED: this interpreter has no pip")
        place = self.directory / "installed"
        for source in (self.wheel, PACKAGE):
            with tempfile.TemporaryDirectory() as place:
                result = subprocess.run(
                    pip + ["install", "--no-index", "--no-deps", "--no-build-isolation", "--quiet",
                           "--disable-pip-version-check", "--target", place, source],
                    capture_output=True, text=True,
                    env={**self.environment, "MIEN_LIBRARY": mien.library_path})
                self.assertEqual(result.returncode, 0, result.stderr)
                subprocess.run([sys.executable, "-c", CODE], check=True, cwd="/",
                               stdout=subprocess.DEVNULL,
                               env={**self.environment, "PYTHONPATH": place})

    def test_without_the_library_that_makes_files(self):
        alone = shutil.copy(mien.library_path, self.directory)
        environment = {**self.environment, "PYTHONPATH": str(PACKAGE), "MIEN_LIBRARY": alone}
        for call, error in (("from_bytes(b'no file')", "DnaError"),
                            ("generate()", "ImportError: libmien-author")):
            result = subprocess.run([sys.executable, "-c", f"import mien; mien.Dna.{call}"],
                                    capture_output=True, text=True, env=environment)
            self.assertEqual(result.returncode, 1)
            self.assertIn(error, result.stderr)

    def test_a_library_that_is_not_there(self):
        for told in ("/nonexistent/libmien.so", str(PACKAGE / "README.md")):
            result = subprocess.run([sys.executable, "-c", "import mien"], capture_output=True,
                                    text=True, env={**self.environment, "PYTHONPATH": str(PACKAGE),
                                                    "MIEN_LIBRARY": told})
            self.assertEqual(result.returncode, 1)
            self.assertIn("ImportError: libmien was not found", result.stderr)
            self.assertIn(told, result.stderr)


if __name__ == "__main__":
    unittest.main()
