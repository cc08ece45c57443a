#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien eval` and `mien convert` against rigs with known results.

    golden_cli_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)

README.md beside this file describes the rigs, the results, and how they are compared.
"""
import array
import json
import os
import struct
import subprocess
import sys
import unittest

ISAS = ("scalar", "sse2", "avx2", "avx512", "neon")
TOLERANCES = ("psd", "ml", "rbf", "joints.euler", "joints.quat", "blendShapes", "animatedMaps")
OUTPUTS = {"raw": "raw", "psd": "psd", "ml": "ml", "rbf": "rbf", "joints": "joints.euler",
           "blend_shapes": "blendShapes", "animated_maps": "animatedMaps"}

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import golden_rigs  # noqa: E402

mien = os.environ.get("MIEN_BIN", "")


def say(text):
    print(text, file=sys.stderr, flush=True)


def run(*arguments, stdin=b""):
    done = subprocess.run([mien, *arguments], input=stdin, capture_output=True, timeout=300)
    assert done.returncode == 0, (arguments, done.returncode, done.stderr)
    return done.stdout


def read_records(path):
    """Name -> (dimensions, numbers or text)."""
    with open(path, "rb") as file:
        data = file.read()
    assert data[:8] == b"RIGGOLD1", path
    count, at, records = struct.unpack_from("<I", data, 8)[0], 12, {}
    for _ in range(count):
        length = struct.unpack_from("<H", data, at)[0]
        name = data[at + 2:at + 2 + length].decode()
        kind, rank = data[at + 2 + length:at + 4 + length]
        dims = struct.unpack_from("<%dI" % rank, data, at + 4 + length)
        at += 4 + length + 4 * rank
        total = 1
        for size in dims:
            total *= size
        numbers = array.array("fHIB"[kind])
        numbers.frombytes(data[at:at + total * numbers.itemsize])
        if sys.byteorder == "big":
            numbers.byteswap()
        at += total * numbers.itemsize
        records[name] = (dims, numbers.tobytes().decode() if kind == 3 else numbers)
    assert at == len(data), path
    return records


class Rig:
    def __init__(self, path):
        self.path = path
        self.records = read_records(path[:-len(".dna")] + ".golden.bin")
        counts = self.records["meta.counts"][1]
        self.lods, self.frames = counts[2], counts[12]
        self.counts = dict(zip(("gui", "raw", "psd", "ml", "rbf"), counts[3:8]))
        self.tolerances = dict(zip(TOLERANCES, self.records["meta.tolerance"][1]))
        self.info = json.loads(run("info", self.path, "--json", "--quiet"))

    def row(self, record, frame):
        dims, numbers = self.records[record]
        return list(numbers[frame * dims[1]:(frame + 1) * dims[1]])

    def is_gui(self, frame):
        return self.records["in.mode"][1][frame] == 0

    def input(self):
        frames = []
        for f in range(self.frames):
            raw = self.row("in.raw", f)
            if self.is_gui(f):
                quaternions = self.records["in.quatRaw"][1]
                frame = {"gui": self.row("in.gui", f), "raw_after_gui": {str(i): raw[i] for i in quaternions}}
            else:
                frame = {"raw": raw}
            mask = self.row("in.mlMask", f)
            if mask:
                frame["ml_mask"] = mask
            frames.append(frame)
        return json.dumps({"frames": frames}).encode()


def same_signs(values, expected):
    """`expected` with each quaternion of the sign that is nearer: both mean the same rotation."""
    expected = list(expected)
    for q in range(3, len(expected), 10):
        if sum(a * b for a, b in zip(values[q:q + 4], expected[q:q + 4])) < 0:
            expected[q:q + 4] = [-part for part in expected[q:q + 4]]
    return expected


class Golden(unittest.TestCase):
    def compare(self, rig, isa, rotation, result):
        """Number of values compared; fails with the worst one."""
        turn = 360.0 if rig.info["units"]["rotation"] == "degrees" else 6.283185307179586
        compared, worst = 0, (0.0, "")
        self.assertEqual(len(result["frames"]), rig.frames)
        self.assertEqual(result["rotation"], rotation)
        for f, frame in enumerate(result["frames"]):
            self.assertEqual([lod["lod"] for lod in frame["lods"]], list(range(rig.lods)))
            for lod in frame["lods"]:
                for key, record in OUTPUTS.items():
                    if key == "joints" and rotation == "quaternion":
                        record = "joints.quat"
                    expected = rig.row("lod%d.%s" % (lod["lod"], record), f)
                    values = lod[key]
                    self.assertEqual(len(values), len(expected), (key, f))
                    if key == "raw":
                        tolerance = 2e-6 if rig.is_gui(f) else 0.0
                    else:
                        tolerance = rig.tolerances[record] + 1e-5 * max(map(abs, expected), default=0.0)
                    if record == "joints.quat":
                        expected = same_signs(values, expected)
                    for i, (mine, wanted) in enumerate(zip(values, expected)):
                        error = abs(mine - wanted)
                        if error > tolerance and record == "joints.euler" and i % 9 in (3, 4, 5):
                            error = abs((mine - wanted + turn / 2) % turn - turn / 2)
                        compared += 1
                        excess = error / tolerance if tolerance else (float("inf") if error else 0.0)
                        if excess > worst[0]:
                            worst = (excess, "frame %d, LOD %d, %s[%d]: %r, expected %r, tolerance %.3g"
                                     % (f, lod["lod"], key, i, mine, wanted, tolerance))
        self.assertLessEqual(worst[0], 1.0, (isa, worst[1]))
        return compared

    def check(self, name, path):
        rig = Rig(path)
        frames = rig.input()
        for isa in available:
            for rotation in ("euler", "quaternion"):
                with self.subTest(isa=isa, rotation=rotation):
                    result = json.loads(run("eval", rig.path, "--input", "-", "--quiet", "--lod", "all", "--isa", isa,
                                            "--rotation", rotation, stdin=frames))
                    compared = self.compare(rig, isa, rotation, result)
                    self.assertGreater(compared, 0)
                    say("%s, %s, %s: %d values agree" % (name, isa, rotation, compared))
        with open(rig.path, "rb") as file:
            self.assertEqual(run("convert", rig.path, "-o", "-"), file.read())
        self.assertTrue(json.loads(run("validate", rig.path, "--json"))["valid"])


def add_tests():
    """One test for each rig."""
    global available
    rigs = golden_rigs.rigs()
    available = [isa for isa in ISAS
                 if subprocess.run([mien, "info", rigs["tiny"], "--isa", isa], capture_output=True).returncode == 0]
    assert "scalar" in available, "the program does not open %s" % rigs["tiny"]
    say("Not available on this CPU: %s" % ", ".join(isa for isa in ISAS if isa not in available))
    for name, path in rigs.items():
        setattr(Golden, "test_" + name, lambda self, name=name, path=path: self.check(name, path))


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-") and os.path.exists(sys.argv[1]):
        mien = sys.argv.pop(1)
    if not mien:
        sys.exit("usage: golden_cli_test.py path/to/mien (or MIEN_BIN)")
    mien = os.path.abspath(mien)
    add_tests()
    unittest.main()
