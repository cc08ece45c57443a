#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the tutorials as a reader would: files are written, then the commands behind `<!-- run -->`.

    tutorials_test.py path/to/mien path/to/libmien.so [unittest options]
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
BLOCK = re.compile(r"<!-- (run|file: [\w.]+) -->\n```\w+\n(.*?)^```$", re.DOTALL | re.MULTILINE)

mien = library = None


class Tutorials(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="mien-tutorial-")
        self.addCleanup(shutil.rmtree, self.folder)
        (Path(self.folder) / "mien.pc").write_text(
            f"Name: mien\nDescription: as built\nVersion: 0.1.0\nCflags: -I{ROOT / 'capi' / 'include'}\n"
            f"Libs: -L{library.parent} -lmien\n", encoding="utf-8")
        self.environment = {**os.environ, "PATH": f"{mien.parent}:{os.environ['PATH']}",
                            "PKG_CONFIG_PATH": self.folder, "LD_LIBRARY_PATH": str(library.parent)}

    def follow(self, name, outputs):
        """Does what the tutorial says; all `outputs` have to be there in the end."""
        blocks = BLOCK.findall((ROOT / "docs" / "tutorials" / (name + ".md")).read_text(encoding="utf-8"))
        self.assertTrue(blocks)
        printed = ""
        for what, text in blocks:
            if what != "run":
                (Path(self.folder) / what.split(": ")[1]).write_text(text, encoding="utf-8")
                continue
            done = subprocess.run(["bash", "-eu", "-c", text], cwd=self.folder, env=self.environment,
                                  capture_output=True, text=True, timeout=300, check=False)
            self.assertEqual(done.returncode, 0, f"{name}:\n{text}\n{done.stdout}{done.stderr}")
            printed += done.stdout
        for output in outputs:
            self.assertTrue((Path(self.folder) / output).stat().st_size, output)
        return printed

    def needs_compiler(self):
        for program in ("cc", "pkg-config"):
            if not shutil.which(program):
                self.skipTest(f"NOT TESTED: tutorials in C; there is no {program}")

    def test_metahuman(self):
        self.needs_compiler()
        printed = self.follow("metahuman", ["open.png", "head.rig", "frame.json"])
        self.assertIn("jaw 0.00: 0 of 870 joints move\n", printed)
        moving = int(re.search(r"jaw 1.00: (\d+) of 870 joints move\n", printed)[1])
        self.assertGreater(moving, 10)

    def test_face_capture(self):
        self.follow("face-capture", ["frames.json", "take.clip", "strip.png", "talk.glb", "arkit.glb", "take-joints.csv",
                                        "take-joints.npy"])
        lines = (Path(self.folder) / "take-joints.csv").read_text(encoding="utf-8").splitlines()
        self.assertEqual(len(lines), 121)

    def test_scan_to_rig(self):
        printed = self.follow("scan-to-rig", ["talker.dna", "report.json", "pictures/jaw.png", "pictures/eyes.png",
                                              "pictures/head-turn.png", "talk.png", "talk.glb"])
        self.assertRegex(printed, r"jawOpen turns the jaw by 2\d degrees")
        self.assertIn("eye_r looks up with eyeLookUpRight: shape", printed)

    def test_viewers(self):
        self.follow("viewers", ["head.glb", "arkit.glb", "smile.obj", "smile.mtl"])

    def test_engine_loop(self):
        self.needs_compiler()
        printed = self.follow("engine-loop", ["loop"])
        self.assertIn("64 characters, 100 frames, 981 joint values each", printed)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    mien, library = (Path(sys.argv.pop(1)).resolve() for _ in range(2))
    unittest.main()
