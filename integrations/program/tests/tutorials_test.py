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
BLOCK = re.compile(r"<!-- (run|file: [\w.-]+) -->\n```\w+\n(.*?)^```$", re.DOTALL | re.MULTILINE)

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

    def follow(self, name, outputs, until=None):
        """Does what the tutorial says, up to the heading `until`; all `outputs` have to be there in the end."""
        text = (ROOT / "docs" / "tutorials" / (name + ".md")).read_text(encoding="utf-8")
        blocks = BLOCK.findall(text.split(f"\n## {until}\n")[0])
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

    def skipTest(self, reason):
        print(reason, file=sys.stderr)  # unittest itself does not tell, and ./dev collects these lines
        super().skipTest(reason)

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
                                              "pictures/head-turn.png", "talk.png", "talk.glb", "hello.clip", "hello.png",
                                              "hello.glb"])
        self.assertRegex(printed, r"jawOpen turns the jaw by 2\d degrees")
        self.assertIn("eye_r looks up with eyeLookUpRight: shape", printed)

    def find_python(self, *modules):
        """An interpreter that has them all, or None."""
        for python in (sys.executable, "/usr/bin/python3"):
            if subprocess.run([python, "-c", "import " + ", ".join(modules)], stderr=subprocess.DEVNULL,
                              check=False).returncode == 0:
                return python
        return None

    def test_solving(self):
        python = self.find_python("numpy")
        if not python:
            self.skipTest("NOT TESTED: the tutorial on solving; no Python has NumPy")
        with_torch = self.find_python("numpy", "torch")
        programs = Path(self.folder) / "bin"
        programs.mkdir()
        (programs / "python3").symlink_to(with_torch or python)
        self.environment.update(PATH=f"{programs}:{self.environment['PATH']}", PYTHONDONTWRITEBYTECODE="1",
                                PYTHONPATH=str(ROOT / "integrations" / "python"), MIEN_LIBRARY=str(library))
        until = None if with_torch else "A network trained through the rig"
        printed = self.follow("solving", ["take.clip", "report.json", "pictures/solve.png"], until)
        self.assertRegex(printed, r"frame 12: 0\.3\d mm, jawOpen 0\.(69|7\d)")
        if not with_torch:
            self.skipTest("NOT TESTED: a network trained through the rig; no Python has PyTorch (python3-torch)")
        before, after = (float(re.search(word + r": +([\d.]+) mm", printed)[1]) for word in ("before", "after"))
        self.assertLess(after, 0.5 * before)

    def test_viewers(self):
        self.follow("viewers", ["head.glb", "joints.glb", "smile.obj", "smile.mtl"])

    def test_engine_loop(self):
        self.needs_compiler()
        printed = self.follow("engine-loop", ["loop"])
        self.assertIn("64 characters, 100 frames, 990 joint values each", printed)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    mien, library = (Path(sys.argv.pop(1)).resolve() for _ in range(2))
    unittest.main()
