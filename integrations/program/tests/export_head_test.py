#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien export` of the head in the box: size, accuracy, orientation, baked animation.

    export_head_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)
"""
import json
import os
import re

from exported import ExportTest, distance, makes_heads, say, set_up, size_of, skip
from glb import Glb
from program import USAGE, main, make, path, read, write


def setUpModule():
    set_up()


class ProceduralHead(ExportTest):
    """Its controls are the ARKit expressions, its vertices have colors."""

    @classmethod
    def setUpClass(cls):
        if not makes_heads():
            skip("the procedural head; this program does not make one")
        make("demo-head", "-o", path("head.dna"))

    def test_deforms_as_mien_does(self):
        rig = path("head.dna")
        settings = [w for s in ("jawOpen=0.8", "mouthSmileLeft=1", "eyeBlinkRight=0.7", "eyeLookUpLeft=1",
                                "tongueOut=0.5", "browInnerUp=1") for w in ("--set", s)]
        worst = self.worst(self.glb(rig, *settings), self.obj(rig, *settings))
        say("procedural head: %.2g of the size" % worst)
        self.assertLess(worst, 1e-5)

    def test_small_by_default_and_as_good(self):
        """What the README says: 7.5 MB at most, and what is left out cannot be seen. glTF without extensions."""
        rig, largest = path("head.dna"), 0
        self.ok("export", rig, "-o", path("default.glb"), "--skeleton", "-q", "--force")
        size = os.path.getsize(path("default.glb"))
        self.assertLess(size, 7.5e6)
        self.assertNotIn("extensionsUsed", Glb(read("default.glb")).json)
        for seed in range(3):
            settings, _ = self.random_pose(rig, seed)
            small, exact = (Glb(self.ok("export", rig, "-o", "-", "--skeleton", *options, *settings).stdout)
                            for options in ([], ["--exact"]))
            for number in exact.mesh_nodes(0):
                largest = max(largest, max(map(distance, small.deformed(number), exact.deformed(number))))
        say("procedural head: %.2f MB, off by %.2f mm at most" % (size / 1e6, largest * 1000))
        self.assertLess(largest, 0.2e-3)

    def test_whole_expressions_if_nothing_is_said(self):
        """Sliders of a viewer move it as it is: the file of --bake arkit, without its table; joints where they are asked for."""
        rig = path("head.dna")
        done = self.ok("export", rig, "-o", path("plain.glb"), "--lod", "6")
        self.assertIn("52 expressions of ARKit", done.stderr)
        self.assertEqual(done.stdout, b"")
        self.ok("export", rig, "-o", path("asked.glb"), "--lod", "6", "--bake", "arkit")
        self.assertEqual(read("plain.glb"), read("asked.glb"))
        joints = Glb(self.ok("export", rig, "-o", "-", "--lod", "6", "--skeleton").stdout)
        posed = Glb(self.ok("export", rig, "-o", "-", "--lod", "6", "--set", "jawOpen=1").stdout)
        moving = Glb(self.ok("export", rig, "-o", "-", "--lod", "6", "--animation", write(
            "still.json", '{"frames": [{}]}')).stdout)
        bones = [len(file.json["skins"][0]["joints"]) for file in (joints, posed, moving, Glb(read("plain.glb")))]
        self.assertEqual(bones[:3], [bones[0]] * 3)
        self.assertGreater(bones[0], 4 * bones[3])
        # A rig that lacks some expressions keeps what would be lost.
        make("gen", "-o", path("small.dna"), "--preset", "small")
        done = self.ok("export", path("small.dna"), "-o", path("few.glb"))
        self.assertNotIn("ARKit", done.stderr)
        self.assertEqual(read("few.glb"), self.ok("export", path("small.dna"), "-o", "-", "--skeleton").stdout)
        for wrong in (("x.glb", "--bake", "arkit"), ("x.vrm",), ("x.obj",)):
            self.fails(USAGE, "export", rig, "-o", path(wrong[0]), "--skeleton", *wrong[1:], says="--skeleton")

    def test_baked_and_small_by_default(self):
        """Below 6 MB, in integers that move no vertex by more than a hundred-thousandth of the size."""
        rig = path("head.dna")
        done = self.ok("export", rig, "-o", path("baked.glb"), "--bake", "arkit")
        self.assertLess(os.path.getsize(path("baked.glb")), 6e6)
        self.assertEqual(Glb(read("baked.glb")).json["extensionsRequired"], ["KHR_mesh_quantization"])
        bound = float(re.search(r"stored in integers: off by ([\d.]+) mm", done.stdout.decode())[1]) / 1000
        lod = ("--lod", "3", "--bake", "arkit")
        small, exact = (Glb(self.ok("export", rig, "-o", "-", *lod, *more).stdout) for more in ((), ("--exact",)))
        node = exact.node_of("head_lod3_mesh")
        size = size_of(exact.deformed(node))
        self.assertLess(bound, 1e-5 * size * 2)
        for weights in ({}, {"jawOpen": 1}, {"mouthSmileLeft": 1}):
            largest = max(map(distance, small.deformed(node, weights=weights), exact.deformed(node, weights=weights)))
            self.assertLess(largest, (1 + len(weights)) * bound * 1.01 + 1e-7)
            self.assertGreater(largest, 0)
        self.ok("export", rig, "-o", path("head.vrm"))
        self.assertLess(os.path.getsize(path("head.vrm")), 6e6)

    def test_faces_the_front_with_its_left_side_on_the_left(self):
        glb = self.glb(path("head.dna"), "--lod", "3")
        points = {glb.json["nodes"][n]["name"]: glb.deformed(n) for n in glb.mesh_nodes(0)}
        head = points["head_lod3_mesh"]
        middle = [(min(p[k] for p in head) + max(p[k] for p in head)) / 2 for k in range(3)]
        self.assertTrue(0.15 < max(p[1] for p in head) - min(p[1] for p in head) < 0.6)
        for name, sign in (("eyeLeft_lod3_mesh", 1), ("eyeRight_lod3_mesh", -1)):
            eye = [sum(p[k] for p in points[name]) / len(points[name]) for k in range(3)]
            self.assertGreater(sign * eye[0], 0.02)
            self.assertGreater(eye[1], middle[1])
            self.assertGreater(eye[2], middle[2])
        for mesh in glb.json["meshes"]:
            self.assertIn("COLOR_0", mesh["primitives"][0]["attributes"])

    def test_baked_animation(self):
        rig = path("head.dna")
        frames = [{}, {"raw": {"jawOpen": 1}}, {"raw": {"mouthSmileLeft": 0.25, "browInnerUp": 0.5}}]
        glb = self.glb(rig, "--lod", "3", "--bake", "arkit", "--animation", "-",
                       stdin=json.dumps({"frames": frames}).encode())
        self.assertEqual({c["target"]["path"] for c in glb.json["animations"][0]["channels"]}, {"weights"})
        node = glb.node_of("head_lod3_mesh")
        names = glb.target_names(node)
        self.assertEqual(len(names), 52)
        for i, frame in enumerate(frames):
            weights = dict(zip(names, glb.posed_nodes(i)[node]["weights"]))
            self.assertEqual({n: w for n, w in weights.items() if w}, frame.get("raw", {}))
        self.assertLess(self.worst(glb, self.obj(rig, "--lod", "3", "--set", "jawOpen=1"), frame=1), 5e-6)
        posed = self.glb(rig, "--lod", "3", "--bake", "arkit", "--set", "jawOpen=1", "--mouth-close", "alone")
        self.assertEqual(posed.deformed(node), glb.deformed(node, 1))


    def test_mouth_closes_with_the_jaw(self):
        rig = path("head.dna")
        closed = self.obj(rig, "--lod", "3", "--set", "jawOpen=1", "--set", "mouthClose=1")
        weights = {"jawOpen": 1, "mouthClose": 1}
        alone = self.ok("export", rig, "-o", path("alone.glb"), "--lod", "3", "--bake", "arkit", "--no-quantize")
        self.assertIn("--mouth-close jaw", alone.stderr)
        self.assertGreater(self.worst(Glb(read("alone.glb")), closed, weights=weights), 0.01)
        jaw = self.ok("export", rig, "-o", path("jaw.glb"), "--lod", "3", "--bake", "arkit", "--mouth-close", "jaw",
                      "--no-quantize")
        self.assertEqual(jaw.stderr, "")
        self.assertLess(self.worst(Glb(read("jaw.glb")), closed, weights=weights), 5e-6)
        self.assertLess(self.worst(Glb(read("jaw.glb")), self.obj(rig, "--lod", "3"), weights={}), 1e-6)


if __name__ == "__main__":
    main()
