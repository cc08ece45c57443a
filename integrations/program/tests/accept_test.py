#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien accept`: what it checks of files of every kind, and that checks can fail.

    accept_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)
"""
import json
import os
import re
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "..", "tests", "support"))
from program import FILE, INVALID, USAGE, ProgramTest, main, make, make_folder, path, read, run, write  # noqa: E402

# The smaller golden rigs: every stage, both numberings of rotations, learned behavior, RBF solvers.
GOLDEN = os.path.join(HERE, "..", "..", "..", "tests", "golden")


def setUpModule():
    make_folder()
    make("gen", "-o", path("tiny.dna"), "--preset", "tiny")
    make("gen", "-o", path("small.dna"), "--preset", "small")
    make("gen", "-o", path("body.dna"), "--preset", "metahuman-body")


def columns(matrix):
    return [matrix[4 * c:4 * c + 4] for c in range(4)]


class Accept(ProgramTest):
    def report(self, rig, *options):
        return self.json("accept", rig, "--report", "-", "--quiet", *options)

    def test_rigs_of_every_kind_pass_every_check(self):
        golden = sorted(os.path.join(GOLDEN, name) for name in os.listdir(GOLDEN) if name.endswith(".dna"))
        self.assertGreater(len(golden), 3)
        for rig in [path("tiny.dna"), path("small.dna"), path("body.dna")] + golden:
            report = self.report(rig)
            for check in report["checks"]:
                self.assertTrue(check["passed"], (rig, check))
            names = [check["name"] for check in report["checks"]]
            for name in ("valid", "round trip", "double precision, scalar", "instruction sets", "subsets", "bake",
                         "deform"):
                self.assertIn(name, names)
            self.assertTrue(report["passed"])

    def test_counts_are_those_of_info(self):
        info = self.json("info", path("body.dna"), "--json")["counts"]
        report = self.report(path("body.dna"))
        for ours, theirs in (("joints", "joints"), ("raw_controls", "raw_controls"),
                             ("rbf_solvers", "rbf_solvers"), ("rbf_poses", "rbf_poses"), ("twists", "twists"),
                             ("swings", "swings"), ("meshes", "meshes")):
            self.assertEqual(report["counts"][ours], info[theirs], ours)
        for lods in (report["histograms"]["joints_per_lod"], report["histograms"]["vertices_per_lod"]):
            self.assertEqual(len(lods), report["counts"]["lods"])
        self.assertEqual({t["lod"] for t in report["timings"]}, set(range(report["counts"]["lods"])))

    def test_a_report_tells_nothing_of_the_character(self):
        names = self.names("small.dna", "joints") + self.names("small.dna", "raw")
        name = self.json("info", path("small.dna"), "--json")["name"]
        for ending in ("json", "html"):
            out = path("report." + ending)
            self.ok("accept", path("small.dna"), "--report", out)
            text = read("report." + ending).decode()
            self.assertNotIn("small.dna", text)
            self.assertNotIn(name, text)
            words = set(re.findall(r"[A-Za-z_][A-Za-z0-9_.]{5,}", text))
            self.assertFalse(words & set(names))
            self.ok("accept", path("small.dna"), "--report", out, "--names")
            self.assertIn(name, read("report." + ending).decode())

    def test_the_page_stands_alone(self):
        self.ok("accept", path("tiny.dna"), "--report", path("page.html"))
        page = read("page.html").decode()
        self.assertTrue(page.startswith("<!doctype html>"))
        for word in ("<script", "http:", "https:", "@import", "<link", "src="):
            self.assertNotIn(word, page)
        for tag in ("table", "main", "div", "header", "footer"):
            self.assertEqual(len(re.findall("<%s[ >]" % tag, page)), page.count("</%s>" % tag), tag)

    def test_a_file_inside_another(self):
        asset = write("x.uasset", b"\xc1\x83\x2a\x9e" + bytes(700) + read("tiny.dna") + bytes(50))
        report = self.report(asset)
        self.assertTrue(report["passed"])
        self.assertEqual(report["bytes"], len(read("tiny.dna")))

    def test_a_file_that_is_not_canonical_fails_the_round_trip_alone(self):
        # Bytes behind the end of file are lost when it is written again.
        padded = write("padded.dna", read("tiny.dna") + b"more")
        done = run("accept", padded, "--report", path("padded.json"))
        if done.returncode == INVALID:
            return  # the reader refuses it, which is as good
        self.assertEqual(done.returncode, USAGE, done.stderr)
        report = json.loads(read("padded.json"))
        self.assertEqual([c["name"] for c in report["checks"] if not c["passed"]], ["round trip"])
        self.assertFalse(report["passed"])

    def pose(self, rig, control, unit=1.0, axes=(0, 1, 2)):
        """The joints of a rig in a pose, from a GLB that opens in it: translations in the world."""
        glb = path("pose.glb")
        self.ok("export", rig, "-o", glb, "--set", control + "=1", "--quiet", "--force")
        data = read("pose.glb")
        size = int.from_bytes(data[12:16], "little")
        nodes = json.loads(data[20:20 + size])["nodes"]
        parents = {child: n for n, node in enumerate(nodes) for child in node.get("children", [])}

        def matrix(node):
            x, y, z, w = node.get("rotation", [0, 0, 0, 1])
            s = node.get("scale", [1, 1, 1])
            t = node.get("translation", [0, 0, 0])
            turn = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                    [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                    [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
            return [[turn[r][c] * s[c] for c in range(3)] + [t[r]] for r in range(3)] + [[0, 0, 0, 1]]

        def times(a, b):
            return [[sum(a[r][k] * b[k][c] for k in range(4)) for c in range(4)] for r in range(4)]

        joints = {}
        for n, node in enumerate(nodes[1:], 1):
            if "mesh" in node:
                continue
            world, at = matrix(node), parents.get(n)
            while at is not None:
                world, at = times(matrix(nodes[at]), world), parents.get(at)
            joints[node["name"]] = {"translation": [world[r][3] * unit for r in range(3)]}
        return joints

    def test_poses_of_an_engine(self):
        # The writer of GLB goes another way: quaternions in meters, composed in Python.
        control = self.names("small.dna", "raw")[0]
        joints = self.pose(path("small.dna"), control, 100)
        document = {"unit": "cm", "poses": [{"controls": {control: 1}, "joints": joints}]}
        poses = write("poses.json", json.dumps(document))
        report = self.report(path("small.dna"), "--poses", poses)
        check = report["checks"][-1]
        self.assertEqual(check["name"], "pose 0")
        self.assertIn("%d joints" % len(joints), check["detail"])
        # In another unit.
        document["unit"] = "mm"
        for joint in joints.values():
            joint["translation"] = [10 * x for x in joint["translation"]]
        self.report(path("small.dna"), "--poses", write("mm.json", json.dumps(document)), "--tolerance", "0.1")

        name = next(iter(joints))
        joints[name]["translation"][1] += 5
        wrong = write("wrong.json", json.dumps(document))
        done = run("accept", path("small.dna"), "--poses", wrong, "--report", path("wrong.report.json"))
        self.assertEqual(done.returncode, USAGE, done.stderr)
        check = json.loads(read("wrong.report.json"))["checks"][-1]
        self.assertFalse(check["passed"])
        self.assertIn("off by 5 at most", check["detail"])
        self.assertNotIn(name, check["detail"])
        self.report(path("small.dna"), "--poses", wrong, "--tolerance", "6")

    def test_poses_that_cannot_be_used(self):
        joint = self.names("tiny.dna", "joints")[0]
        good = {"controls": {}, "joints": {joint: {"translation": [0, 0, 0]}}}
        for document, says in (
                ([], "expected an object"),
                ({"poses": []}, "expected an array"),
                ({"poses": [good], "unit": "furlong"}, "unit"),
                ({"poses": [good], "unit": 3}, "unit"),
                ({"poses": [good], "system": "nowhere"}, "nowhere"),
                ({"poses": [dict(good, lod=99)]}, "LOD"),
                ({"poses": [dict(good, controls={"nothing": 1})]}, "nothing"),
                ({"poses": [dict(good, joints={"nowhere": {"translation": [0, 0, 0]}})]}, "nowhere"),
                ({"poses": [dict(good, joints={joint: {"translation": [0, 0]}})]}, "3 numbers"),
                ({"poses": [dict(good, joints={joint: {"rotation": [0, 0, 0, 1]}})]}, "translation"),
                ({"poses": [dict(good, joints={})]}, "joints"),
                ({"poses": [dict(good, more=1)]}, "more"),
        ):
            poses = write("bad.json", json.dumps(document))
            self.fails(INVALID, "accept", path("tiny.dna"), "--poses", poses, says=says)
        self.fails(INVALID, "accept", path("tiny.dna"), "--poses", write("bad.json", "{"), says="bad.json")
        self.fails(FILE, "accept", path("tiny.dna"), "--poses", path("none.json"), says="none.json")

    def test_wrong_use(self):
        tiny = path("tiny.dna")
        self.fails(USAGE, "accept", says="FILE")
        self.fails(USAGE, "accept", tiny, "--report", path("report.txt"), says=".json")
        self.fails(USAGE, "accept", tiny, "--tolerance", "-1", says="--tolerance")
        self.fails(USAGE, "accept", tiny, "--report", tiny, says="report")
        self.fails(FILE, "accept", path("none.dna"), says="none.dna")
        self.fails(INVALID, "accept", write("noise.dna", bytes(range(256)) * 9), says="noise.dna")
        self.fails(INVALID, "accept", write("half.dna", read("tiny.dna")[:4000]), says="half.dna")


if __name__ == "__main__":
    main()
