#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien bake`, and baked rigs where a DNA file may be: the same results, and clear refusals.

    cli_bake_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

DONE, USAGE, INVALID, FILE, INTERNAL = range(5)

mien = os.environ.get("MIEN_BIN", "")
folder = ""


def setUpModule():
    global folder
    folder = tempfile.mkdtemp(prefix="mien-bake-")
    for name, options in (("small", ["--preset", "small"]), ("ml", ["--preset", "tiny", "--ml"])):
        done = run("gen", "-o", path(name + ".dna"), *options)
        assert done.returncode == DONE, done.stderr
        done = run("bake", path(name + ".dna"), "-o", path(name + ".rig"))
        assert done.returncode == DONE, done.stderr
    with open(path("frames.json"), "w", encoding="utf-8") as file:
        json.dump({"frames": [{}, {"gui": {}, "raw_after_gui": {"0": 0.7, "3": 1.0}}]}, file)


def tearDownModule():
    shutil.rmtree(folder)


def path(name):
    return os.path.join(folder, name)


def read(name):
    with open(path(name), "rb") as file:
        return file.read()


def run(*arguments, stdin=b""):
    return subprocess.run([mien, *arguments], input=stdin, capture_output=True, check=False)


class Bake(unittest.TestCase):
    def refused(self, code, *arguments, says="", stdin=b""):
        done = run(*arguments, stdin=stdin)
        text = done.stderr.decode()
        self.assertEqual(done.returncode, code, text)
        self.assertEqual(text.count("\n"), 1, text)
        self.assertIn(says, text)

    def evaluated(self, rig, *options, stdin=b""):
        done = run("eval", rig, "--input", path("frames.json"), "--lod", "all", *options, stdin=stdin)
        self.assertEqual(done.returncode, DONE, done.stderr.decode())
        return json.loads(done.stdout)

    def test_the_same_results(self):
        for name in ("small", "ml"):
            dna = self.evaluated(path(name + ".dna"))
            for result in (self.evaluated(path(name + ".rig")),
                           self.evaluated("-", stdin=read(name + ".rig"))):
                self.assertIsNone(result["rig"])
                self.assertIsNone(result["version"])
                for key in ("lod_count", "rotation", "frames"):
                    self.assertEqual(result[key], dna[key])

    def test_what_was_chosen_stays(self):
        options = ["--rotation", "quaternion", "--storage", "f16", "--lods", "0"]
        self.assertEqual(
            run("bake", path("small.dna"), "-o", path("chosen.rig"), *options).returncode, DONE)
        dna, rig = self.evaluated(path("small.dna"), *options), self.evaluated(path("chosen.rig"))
        self.assertEqual(rig["frames"], dna["frames"])
        self.assertEqual(rig["rotation"], "quaternion")
        self.evaluated(path("chosen.rig"), "--rotation", "quaternion", "--isa", "scalar")
        for option, value in (("--rotation", "quaternion"), ("--storage", "f16"),
                              ("--ml-masks", "blend"), ("--lods", "0"), ("--system", "unity"),
                              ("--layers", "behavior")):
            self.refused(USAGE, "eval", path("small.rig"), "--input", path("frames.json"), option,
                         value, says="decided when the file was baked")

    def test_the_same_bytes_by_any_way(self):
        done = run("bake", "-", "-o", "-", stdin=read("small.dna"))
        self.assertEqual(done.returncode, DONE, done.stderr.decode())
        self.assertEqual(done.stdout, read("small.rig"))

    def test_info(self):
        dna = json.loads(run("info", path("small.dna"), "--json").stdout)
        rig = json.loads(run("info", path("small.rig"), "--json").stdout)
        self.assertTrue(rig["baked"])
        for key in ("gui_controls", "raw_controls", "psd_controls", "joints", "joint_groups",
                    "blend_shape_channels", "animated_maps", "meshes"):
            self.assertEqual(rig["counts"][key], dna["counts"][key], key)
        self.assertEqual(len(rig["lods"]), len(dna["lods"]))
        for key in rig["lods"][0]:
            self.assertEqual(rig["lods"][0][key], dna["lods"][0][key], key)
        text = run("info", path("small.rig"))
        self.assertEqual(text.returncode, DONE)
        self.assertIn(b"a baked file", text.stdout)
        self.refused(USAGE, "info", path("small.rig"), "--names", "raw", says="DNA file")

    def test_bench(self):
        done = run("bench", path("ml.rig"), "--json", "--quick", "--isa", "all")
        self.assertEqual(done.returncode, DONE, done.stderr.decode())
        result = json.loads(done.stdout)
        self.assertEqual(result["csr"], [])
        self.assertTrue(all(row["evaluate_ns"] > 0 for row in result["rows"]))
        self.assertEqual(run("bench", path("ml.rig"), "--quick").returncode, DONE)
        self.refused(USAGE, "bench", "-", says="give its path", stdin=read("ml.rig"))

    def test_render(self):
        """The synthetic rig has no vertex colors, so nothing tells the images apart."""
        def drawn(rig, *options, stdin=b""):
            done = run("render", rig, "-o", "-", "--size", "96x96", *options, stdin=stdin)
            self.assertEqual(done.returncode, DONE, done.stderr.decode())
            return done.stdout

        for options in ([], ["--lod", "1"], ["--turntable", "3"]):
            image = drawn(path("small.dna"), *options)
            self.assertEqual(drawn(path("small.rig"), *options), image, options)
        self.assertEqual(drawn("-", stdin=read("small.rig")), drawn(path("small.dna")))
        self.assertNotEqual(drawn(path("small.dna"), "--lod", "1"), drawn(path("small.dna")))
        self.refused(INVALID, "render", path("small.rig"), "--lod", "9", "-o", path("out.png"),
                     says="LOD 9 is out of range")
        self.assertEqual(run("bake", path("small.dna"), "-o", path("bare.rig"), "--layers",
                             "behavior").returncode, DONE)
        self.refused(INVALID, "render", path("bare.rig"), "-o", path("out.png"),
                     says="no geometry")

    def test_what_needs_the_dna_says_so(self):
        for command in (["convert", path("small.rig"), "-o", path("out.dna")],
                        ["bake", path("small.rig"), "-o", path("out.rig")],
                        ["export", path("small.rig"), "-o", path("out.glb")]):
            self.refused(INVALID, *command, says="this is a baked file, and the command needs a DNA file")
            self.assertFalse(os.path.exists(command[-1]))
        self.refused(INVALID, "convert", "-", "-o", path("out.dna"), stdin=read("small.rig"),
                     says="this is a baked file")

    def test_damage(self):
        whole = read("small.rig")
        for name, content, says in (
                ("cut", whole[:-64], "ends after"), ("head", whole[:40], "within its header"),
                ("version", whole[:12] + b"\x63" + whole[13:], "version"),
                ("order", whole[:8] + whole[8:12][::-1] + whole[12:], "byte order"),
                ("table", whole[:-64 * (len(whole) // 128)][:4096].ljust(len(whole), b"\xff"),
                 "baked file is damaged")):
            with open(path(name + ".rig"), "wb") as file:
                file.write(content)
            for command in ("info", "eval"):
                more = ["--input", path("frames.json")] if command == "eval" else []
                self.refused(INVALID, command, path(name + ".rig"), *more, says=says)

    def test_failures(self):
        self.refused(FILE, "bake", path("none.dna"), "-o", path("out.rig"))
        self.refused(FILE, "bake", path("small.dna"), "-o", path("none/out.rig"))
        self.refused(INVALID, "bake", path("frames.json"), "-o", path("out.rig"))
        self.refused(USAGE, "bake", path("small.dna"))
        self.refused(USAGE, "bake", path("small.dna"), "-o", path("out.rig"), "--isa", "scalar")
        self.assertFalse(os.path.exists(path("out.rig")))


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        mien = sys.argv.pop(1)
    unittest.main()
