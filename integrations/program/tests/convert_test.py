#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien convert`: versions, layers, LODs, unknown layers, and other coordinate systems.

    convert_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)

All rigs come from `mien gen`.
"""
import json
import os
import shutil
import struct
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "tests", "support"))
from program import USAGE, INVALID, ProgramTest, main, make, make_folder, path, read, write  # noqa: E402

PRESETS = ("tiny", "small", "medium", "large", "body")
VERSIONS = ["2.%d" % i for i in range(1, 9)]


def setUpModule():
    make_folder()
    for preset in PRESETS:
        make("gen", "-o", path(preset + ".dna"), "--preset", preset)


class Convert(ProgramTest):
    def test_without_options_the_bytes_stay(self):
        for preset in PRESETS:
            original = read(preset + ".dna")
            self.ok("convert", path(preset + ".dna"), "-o", path("copy.dna"))
            self.assertEqual(read("copy.dna"), original)
            self.assertEqual(self.ok("convert", "-", "-o", "-", stdin=original).stdout, original)

    def test_in_place(self):
        shutil.copy(path("small.dna"), path("place.dna"))
        self.ok("convert", path("place.dna"), "-o", path("place.dna"))
        self.assertEqual(read("place.dna"), read("small.dna"))
        self.ok("convert", path("place.dna"), "-o", path("place.dna"), "--version", "2.2")
        self.assertEqual(self.json("info", path("place.dna"), "--json")["version"], "2.2")

    def test_every_version(self):
        for preset in ("tiny", "small"):
            before = self.json("info", path(preset + ".dna"), "--json")["counts"]
            for version in VERSIONS:
                old = path("v%s.dna" % version)
                done = self.ok("convert", path(preset + ".dna"), "-o", old, "--version", version)
                self.assertEqual("left out" in done.stderr, version == "2.1")
                info = self.json("info", old, "--json")
                self.assertEqual(info["version"], version)
                self.assertEqual(info["counts"], before)
                self.assertTrue(self.json("validate", old, "--json")["valid"])
                # And back: what came through is the same. 2.1 has lost its empty layers.
                self.ok("convert", old, "-o", path("back.dna"), "--version", "2.8")
                self.assertEqual(self.json("info", path("back.dna"), "--json")["counts"], before)

    def test_unknown_layers(self):
        original = read("tiny.dna")
        # The code of the last entry of the index becomes one that nobody knows.
        count = struct.unpack_from(">I", original, 7)[0]
        entry = 11 + 16 * (count - 1)
        strange = write("strange.dna", original[:entry] + b"zzzz" + original[entry + 4:])
        layers = self.json("info", strange, "--json")["layers"]
        self.assertEqual([layer["code"] for layer in layers if not layer["known"]], ["zzzz"])
        def codes(*options):
            self.ok("convert", strange, "-o", path("y.dna"), *options)
            return [layer["code"] for layer in self.json("info", path("y.dna"), "--json")["layers"]]
        self.assertIn("zzzz", codes())
        self.assertIn("zzzz", codes("--unknown", "keep"))
        self.assertNotIn("zzzz", codes("--unknown", "drop"))
        self.assertIn("zzzz", codes("--version", "2.3"))
        self.assertNotIn("zzzz", codes("--version", "2.3", "--unknown", "drop"))

    def test_layers_that_a_version_lacks_are_dropped_with_a_note(self):
        def codes(name):
            return [layer["code"] for layer in self.json("info", path(name), "--json")["layers"]]
        before = codes("small.dna")
        for version in VERSIONS:
            for unknown in ("keep", "drop"):
                done = self.ok("convert", path("small.dna"), "-o", path("old.dna"), "--version",
                               version, "--unknown", unknown)
                after = codes("old.dna")
                lost = [code for code in before if code not in after]
                keeps = version in ("2.7", "2.8") or (unknown == "keep" and version != "2.1")
                self.assertEqual(lost == [], keeps, (version, unknown, lost))
                notes = [line for line in done.stderr.splitlines() if "left out" in line]
                self.assertEqual(len(notes), 1 if lost else 0, done.stderr)
                for code in lost:
                    self.assertIn(code, notes[0])

    def test_layers_and_lods(self):
        self.ok("convert", path("medium.dna"), "-o", path("part.dna"), "--layers", "behavior",
                "--max-lod", "2")
        whole = self.json("info", path("medium.dna"), "--json")
        part = self.json("info", path("part.dna"), "--json")
        self.assertEqual(part["lod_count"], whole["lod_count"] - 2)
        self.assertEqual(part["counts"]["vertices"], 0)
        self.assertLess(part["counts"]["joints"], whole["counts"]["joints"])
        self.assertEqual(part["lods"][0]["joints"], whole["lods"][2]["joints"])
        self.assertLess(part["file_bytes"], whole["file_bytes"] / 2)
        self.assertTrue(self.json("validate", path("part.dna"), "--json")["valid"])

    def test_lod_selection_keeps_the_joint_values(self):
        controls = {name: 0.5 for name in self.names("small.dna", "raw")}
        whole = self.evaluate_one("small.dna", {"raw": controls}, lod=1)
        self.ok("convert", path("small.dna"), "-o", path("lod1.dna"), "--lods", "1")
        part = self.evaluate_one("lod1.dna", {"raw": controls})
        old, new = self.names("small.dna", "joints"), self.names("lod1.dna", "joints")
        for i, name in enumerate(new):
            k = old.index(name)
            self.assertEqual(part["joints"][9 * i:9 * i + 9], whole["joints"][9 * k:9 * k + 9], name)
        self.assertTrue(any(part["joints"]))
        # The same without a file in between.
        part = self.evaluate("small.dna", [{"raw": controls}], "--lods", "1")
        self.assertEqual(part["lod_count"], 1)
        self.assertEqual(part["frames"][0]["lods"][0]["lod"], 0)


class Systems(ProgramTest):
    def test_info_names_the_system(self):
        self.assertEqual(self.json("info", path("tiny.dna"), "--json")["system"], "maya")
        text = self.ok("info", path("tiny.dna")).stdout.decode()
        self.assertIn("system        maya\n", text)
        self.assertIn("z front: right-handed\n", text)
        self.assertIn("counter-clockwise seen from outside\n", text)
        text = self.ok("info", path("tiny.dna"), "--system", "unity").stdout.decode()
        self.assertIn("x right, y up, z front: left-handed\n", text)
        self.assertIn("units         m, degrees\n", text)
        self.assertIn("faces         clockwise seen from outside\n", text)

    def test_every_name_converts_and_is_found_again(self):
        text = self.ok("convert", "--help").stdout.decode()
        for name in ("maya", "unreal", "unreal-mesh", "unity", "godot", "blender", "gltf", "opengl",
                     "directx", "houdini"):
            self.assertIn(name, text)
            there = path(name + "_system.dna")
            self.ok("convert", path("small.dna"), "-o", there, "--system", name)
            self.assertEqual(self.json("info", there, "--json")["system"], name)
            self.assertEqual(self.json("validate", there, "--json")["errors"], 0)

    def test_axes_and_signs_come_back_exactly(self):
        self.ok("convert", path("small.dna"), "-o", path("there.dna"), "--system", "unreal")
        self.assertNotEqual(read("there.dna"), read("small.dna"))
        self.ok("convert", path("there.dna"), "-o", path("back.dna"), "--system", "maya")
        self.assertEqual(read("back.dna"), read("small.dna"))
        self.ok("convert", path("small.dna"), "-o", path("back.dna"), "--system", "maya")
        self.assertEqual(read("back.dna"), read("small.dna"))

    def test_eval_gives_numbers_of_the_system(self):
        frame = {"raw": {"CTRL_expressions.jawOpen": 1}}
        plain = self.evaluate_one("small.dna", frame)["joints"]
        frames = json.dumps({"frames": [frame]}).encode()
        turned = self.json("eval", path("small.dna"), "--input", "-", "--quiet", "--lod", "0",
                           "--system", "blender", stdin=frames)["frames"][0]["lods"][0]["joints"]
        for at in range(0, len(plain), 9):  # x left, y back, z up, in meters
            expected = (plain[at] / 100, -plain[at + 2] / 100, plain[at + 1] / 100)
            for k in range(3):
                self.assertAlmostEqual(turned[at + k], expected[k], delta=1e-6)

    def test_wrong_systems(self):
        self.fails(USAGE, "info", path("tiny.dna"), "--system", "unitty", says='did you mean "unity"')
        self.fails(USAGE, "info", path("tiny.dna"), "--rotation-order", "exact", says="--system")
        self.fails(USAGE, "info", path("tiny.dna"), "--system", "unity", "--rotation-order", "bent",
                   says="--rotation-order")
        self.fails(INVALID, "info", path("small.dna"), "--system", "unity", "--rotation-order",
                   "exact", says=["jointGroups", "several axes"])
        self.ok("info", path("small.dna"), "--system", "unity", "--rotation-order", "per-column")


if __name__ == "__main__":
    main()
