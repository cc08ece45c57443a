#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien bake`, and baked rigs where a DNA file may be: the same results, and clear refusals.

    cli_bake_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)
"""
import json
import os
import struct
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "tests", "support"))
from program import USAGE, INVALID, FILE, ProgramTest, main, make, make_folder, path, read, write  # noqa: E402


def setUpModule():
    make_folder()
    for name, options in (("small", ["--preset", "small"]), ("ml", ["--preset", "tiny", "--ml"])):
        make("gen", "-o", path(name + ".dna"), *options)
        make("bake", path(name + ".dna"), "-o", path(name + ".rig"))
    write("frames.json", json.dumps({"frames": [{}, {"gui": {}, "raw_after_gui": {"0": 0.7, "3": 1.0}}]}))


class Bake(ProgramTest):
    def evaluated(self, rig, *options, stdin=b""):
        return self.json("eval", rig, "--input", path("frames.json"), "--lod", "all", *options, stdin=stdin)

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
        self.ok("bake", path("small.dna"), "-o", path("chosen.rig"), *options)
        dna, rig = self.evaluated(path("small.dna"), *options), self.evaluated(path("chosen.rig"))
        self.assertEqual(rig["frames"], dna["frames"])
        self.assertEqual(rig["rotation"], "quaternion")
        self.evaluated(path("chosen.rig"), "--rotation", "quaternion", "--isa", "scalar")
        for option, value in (("--rotation", "quaternion"), ("--storage", "f16"),
                              ("--ml-masks", "blend"), ("--lods", "0"), ("--system", "unity"),
                              ("--layers", "behavior")):
            self.fails(USAGE, "eval", path("small.rig"), "--input", path("frames.json"), option,
                         value, says="decided when the file was baked")

    def test_the_same_bytes_by_any_way(self):
        done = self.ok("bake", "-", "-o", "-", stdin=read("small.dna"))
        self.assertEqual(done.stdout, read("small.rig"))

    def test_info(self):
        dna = self.json("info", path("small.dna"), "--json")
        rig = self.json("info", path("small.rig"), "--json")
        self.assertTrue(rig["baked"])
        for key in ("gui_controls", "raw_controls", "psd_controls", "joints", "joint_groups",
                    "blend_shape_channels", "animated_maps", "meshes"):
            self.assertEqual(rig["counts"][key], dna["counts"][key], key)
        self.assertEqual(len(rig["lods"]), len(dna["lods"]))
        for key in rig["lods"][0]:
            self.assertEqual(rig["lods"][0][key], dna["lods"][0][key], key)
        self.assertIn(b"a baked file", self.ok("info", path("small.rig")).stdout)
        self.fails(USAGE, "info", path("small.rig"), "--names", "raw", says="DNA file")

    def test_bench(self):
        result = self.json("bench", path("ml.rig"), "--json", "--quick", "--isa", "all")
        self.assertEqual(result["csr"], [])
        self.assertTrue(all(row["evaluate_ns"] > 0 for row in result["rows"]))
        self.ok("bench", path("ml.rig"), "--quick")
        self.fails(USAGE, "bench", "-", says="give its path", stdin=read("ml.rig"))

    def test_render(self):
        """The synthetic rig has no vertex colors, so nothing tells the images apart."""
        def drawn(rig, *options, stdin=b""):
            return self.ok("render", rig, "-o", "-", "--size", "96x96", *options, stdin=stdin).stdout

        for options in ([], ["--lod", "1"], ["--turntable", "3"]):
            image = drawn(path("small.dna"), *options)
            self.assertEqual(drawn(path("small.rig"), *options), image, options)
        self.assertEqual(drawn("-", stdin=read("small.rig")), drawn(path("small.dna")))
        self.assertNotEqual(drawn(path("small.dna"), "--lod", "1"), drawn(path("small.dna")))
        self.fails(INVALID, "render", path("small.rig"), "--lod", "9", "-o", path("out.png"),
                     says="LOD 9 is out of range")
        self.ok("bake", path("small.dna"), "-o", path("bare.rig"), "--layers", "behavior")
        self.fails(INVALID, "render", path("bare.rig"), "-o", path("out.png"),
                     says="no geometry")

    def test_tolerance(self):
        sizes = []
        for tolerance in ("0.01mm", "0.5mm,0.02cm"):
            self.ok("bake", path("ml.dna"), "-o", path("reduced.rig"), "--tolerance", tolerance, "--report",
                    path("report.json"), "--force")
            report = json.loads(read("report.json"))
            self.assertEqual(report["unit"], "cm")
            self.assertGreaterEqual(report["poses"], 1000)
            for lod in report["lods"]:
                self.assertLessEqual(lod["rms"], lod["worst"])
                self.assertLessEqual(lod["worst"], lod["tolerance"])
            sizes.append(report["after"])
        self.assertEqual([round(lod["tolerance"], 9) for lod in report["lods"]], [0.05, 0.02, 0.02])
        self.assertLess(sizes[1]["deltas"], sizes[0]["deltas"])
        self.assertLess(sizes[1]["skin_weights"], sizes[0]["skin_weights"])
        self.assertEqual(self.json("info", path("reduced.rig"), "--json")["storage"], "f16")
        self.evaluated(path("reduced.rig"))
        first = read("reduced.rig")
        done = self.ok("bake", path("ml.dna"), "-o", path("again.rig"), "--tolerance", "0.05,0.02")
        self.assertEqual(read("again.rig"), first)
        self.assertIn("Distance of positions from the original", done.stderr)

    def test_tolerance_of_regions_and_clips(self):
        joint = self.ok("info", path("ml.dna"), "--names", "joints").stdout.decode().split()[2]
        self.ok("bake", path("ml.dna"), "-o", path("regions.rig"), "--tolerance", "0.5mm", "--region",
                f"{joint}=0.05mm", "--region", "*=0.3mm", "--report", path("regions.json"), "--force")
        report = json.loads(read("regions.json"))
        self.assertEqual([region["names"] for region in report["regions"]], [joint, "*"])
        for region, tolerance in zip(report["regions"], (0.005, 0.03)):
            self.assertAlmostEqual(region["tolerance"], tolerance)
            self.assertLessEqual(region["worst"], region["tolerance"])

    def test_pictures(self):
        self.ok("bake", path("ml.dna"), "-o", path("drawn.rig"), "--tolerance", "0.5mm", "--pictures", path("drawn"))
        self.ok("bake", path("ml.dna"), "-o", path("plain.rig"), "--tolerance", "0.5mm")
        self.assertEqual(read("drawn.rig"), read("plain.rig"))
        image = read("drawn/distance.png")
        self.assertEqual(image[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(struct.unpack(">I", image[16:20]), (1464,))
        bake = ["bake", path("ml.dna"), "-o", path("out.rig")]
        self.fails(USAGE, *bake, "--pictures", path("drawn"), says="add --tolerance")
        self.fails(USAGE, "bake", "-", "-o", path("out.rig"), "--tolerance", "1mm", "--pictures", path("drawn"),
                   says="put it in a file")

    def test_tolerance_refusals(self):
        bake = ["bake", path("ml.dna"), "-o", path("none.rig")]
        for word in ("0", "-1mm", "x", "1 km", "nan", "1e999", "0.1mm,"):
            self.fails(USAGE, *bake, "--tolerance", word, says="give numbers with um, mm, cm, m")
        self.fails(USAGE, *bake, "--report", path("report.json"), says="add --tolerance")
        self.fails(INVALID, *bake, "--tolerance", "1mm", "--no-geometry", says="no geometry")
        for region in ("lip", "=1mm"):
            self.fails(USAGE, *bake, "--tolerance", "1mm", "--region", region, says="names of joints or meshes")
        self.fails(USAGE, *bake, "--tolerance", "1mm", "--region", "lip=0", says="not a distance")
        self.fails(USAGE, *bake, "--tolerance", "1mm", "--region", "nobody=1mm", says="no position")
        self.fails(USAGE, *bake, "--region", "lip=1mm", says="add --tolerance")
        self.fails(USAGE, *bake, "--clip", path("none.clip"), says="add --tolerance")
        self.fails(INVALID, *bake, "--tolerance", "1e-9", "--storage", "f16", says="16-bit storage alone")
        self.assertFalse(os.path.exists(path("none.rig")))

    def test_what_needs_the_dna_says_so(self):
        for command in (["convert", path("small.rig"), "-o", path("out.dna")],
                        ["bake", path("small.rig"), "-o", path("out.rig")],
                        ["export", path("small.rig"), "-o", path("out.glb")]):
            self.fails(INVALID, *command, says="this is a baked file, and the command needs a DNA file")
            self.assertFalse(os.path.exists(command[-1]))
        self.fails(INVALID, "convert", "-", "-o", path("out.dna"), stdin=read("small.rig"),
                     says="this is a baked file")

    def test_damage(self):
        whole = read("small.rig")
        for name, content, says in (
                ("cut", whole[:-64], "ends after"), ("head", whole[:40], "within its header"),
                ("version", whole[:12] + b"\x63" + whole[13:], "version"),
                ("order", whole[:8] + whole[8:12][::-1] + whole[12:], "byte order"),
                ("table", whole[:1024].ljust(len(whole), b"\xff"), "another kind of machine"),
                ("arrays", whole[:8192].ljust(len(whole), b"\xff"), "baked file is damaged")):
            write(name + ".rig", content)
            for command in ("info", "eval"):
                more = ["--input", path("frames.json")] if command == "eval" else []
                self.fails(INVALID, command, path(name + ".rig"), *more, says=says)

    def test_failures(self):
        self.fails(FILE, "bake", path("none.dna"), "-o", path("out.rig"))
        self.fails(FILE, "bake", path("small.dna"), "-o", path("none/out.rig"))
        self.fails(INVALID, "bake", path("frames.json"), "-o", path("out.rig"))
        self.fails(USAGE, "bake", path("small.dna"))
        self.fails(USAGE, "bake", path("small.dna"), "-o", path("out.rig"), "--isa", "scalar")
        self.assertFalse(os.path.exists(path("out.rig")))


if __name__ == "__main__":
    main()
