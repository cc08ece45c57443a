#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien export --attach`, `--attach-rigid`, `--morphs`: meshes of other files that follow the face.

    attach_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)
"""
import json
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "tests", "support"))
import glb  # noqa: E402
from program import FILE, INVALID, USAGE, ProgramTest, main, make, make_folder, path, read, run, write  # noqa: E402


def setUpModule():
    make_folder()
    make("demo-head", "-o", path("head.dna"))
    make("export", path("head.dna"), "-o", path("plain.glb"), "--bake", "arkit", "--lod", "4", "--quiet", "--exact")


def apart(a, b):
    return sum((x - y) ** 2 for x, y in zip(a, b)) ** 0.5


def obj(name, points, triangles):
    lines = ["o " + name] + ["v %.9g %.9g %.9g" % tuple(p) for p in points]
    return "\n".join(lines + ["f %d %d %d" % tuple(i + 1 for i in t) for t in triangles]) + "\n"


class File:
    """Neutral positions, triangles and targets of the meshes of a GLB."""

    def __init__(self, name):
        self.file = glb.Glb(read(name))
        self.json = self.file.json
        self.meshes = {mesh["name"]: mesh for mesh in self.json["meshes"]}

    def positions(self, mesh):
        return self.file.accessor(self.meshes[mesh]["primitives"][0]["attributes"]["POSITION"])

    def triangles(self, mesh):
        flat = self.file.accessor(self.meshes[mesh]["primitives"][0]["indices"])
        flat = [i[0] if isinstance(i, (list, tuple)) else i for i in flat]
        return [flat[i:i + 3] for i in range(0, len(flat), 3)]

    def targets(self, mesh):
        names = self.meshes[mesh]["extras"]["targetNames"]
        targets = self.meshes[mesh]["primitives"][0]["targets"]
        return {name: self.file.accessor(target["POSITION"]) for name, target in zip(names, targets)}

    def skin(self, mesh):
        attributes = self.meshes[mesh]["primitives"][0]["attributes"]
        return [dict(zip(j, w)) for j, w in zip(self.file.accessor(attributes["JOINTS_0"]),
                                                self.file.accessor(attributes["WEIGHTS_0"]))]


class Attach(ProgramTest):
    @classmethod
    def setUpClass(cls):
        cls.plain = File("plain.glb")
        cls.base = max((m for m in cls.plain.meshes if "targetNames" in cls.plain.meshes[m].get("extras", {})),
                       key=lambda m: len(cls.plain.positions(m)))

    def patch(self, count=40):
        """Triangles of the skin around the vertex that jawOpen moves the most, and their vertices in the file."""
        moves = self.plain.targets(self.base)["jawOpen"]
        center = max(range(len(moves)), key=lambda v: apart(moves[v], (0, 0, 0)))
        places = self.plain.positions(self.base)
        near = sorted(self.plain.triangles(self.base), key=lambda t: min(apart(places[v], places[center]) for v in t))
        triangles = near[:count]
        vertices = sorted({v for t in triangles for v in t})
        return vertices, [[vertices.index(v) for v in t] for t in triangles]

    def export(self, *options, name="out.glb"):
        self.ok("export", path("head.dna"), "-o", path(name), "--bake", "arkit", "--lod", "4", "--quiet", "--exact",
                "--force", *options)
        return File(name)

    def test_a_copy_of_the_skin_moves_as_the_skin(self):
        vertices, triangles = self.patch()
        places = self.plain.positions(self.base)
        out = self.export("--attach", write("copy.obj", obj("beard", [places[v] for v in vertices], triangles)))
        neutral, targets, base = out.positions("beard"), out.targets("beard"), self.plain.targets(self.base)
        self.assertEqual(list(targets), list(base))
        moved = 0
        for name, moves in targets.items():
            for v, p in enumerate(neutral):
                same = [base[name][b] for b in vertices if apart(places[b], p) < 1e-7]
                self.assertLess(min(apart(moves[v], s) for s in same), 2e-5, (name, v))
                moved = max(moved, apart(moves[v], (0, 0, 0)))
        self.assertGreater(moved, 0.005)
        for weights in out.skin("beard"):
            self.assertAlmostEqual(sum(weights.values()), 1, 5)

    def test_their_errors_are_measured(self):
        """Those of a copy of some skin are no larger than those of all of it."""
        vertices, triangles = self.patch()
        places = self.plain.positions(self.base)
        write("copy.obj", obj("copy", [places[v] for v in vertices], triangles))
        done = self.ok("export", path("head.dna"), "-o", path("measured.glb"), "--bake", "arkit", "--lod", "4", "--force",
                       "--attach", path("copy.obj"), "--attach", path("copy.obj"), "--residuals", path("loss.json"))
        self.assertIn("copy, attached, in combinations: off by", done.stdout.decode())
        loss = json.loads(read("loss.json"))
        self.assertEqual(list(loss["attached"]), ["copy", "copy 2"])
        copy = loss["attached"]["copy"]
        self.assertEqual(list(copy["shapes"]), list(loss["shapes"]))
        for own, all_ in ((copy["shapes"]["jawOpen"], loss["shapes"]["jawOpen"]),
                          (copy["shapes"]["jawOpen"]["combined"], loss["shapes"]["jawOpen"]["combined"]),
                          (copy["combinations"]["targets"], loss["combinations"]["targets"])):
            self.assertGreater(own["mean"], 0)
            self.assertLessEqual(own["mean"], own["rms"])
            self.assertLessEqual(own["rms"], own["worst"])
            self.assertLessEqual(own["worst"], all_["worst"] + 0.01)

    def test_cards_above_the_skin_keep_their_distance(self):
        vertices, triangles = self.patch()
        places = self.plain.positions(self.base)
        normals = self.plain.file.accessor(self.plain.meshes[self.base]["primitives"][0]["attributes"]["NORMAL"])
        above = [[p + 0.002 * n for p, n in zip(places[v], normals[v])] for v in vertices]
        out = self.export("--attach", write("card.obj", obj("hair", above, triangles)))
        neutral, moves = out.positions("hair"), out.targets("hair")["jawOpen"]
        skin = self.plain.targets(self.base)["jawOpen"]
        for v, p in enumerate(neutral):
            b = min(vertices, key=lambda b: apart(above[vertices.index(b)], p))
            posed = [x + y for x, y in zip(p, moves[v])]
            under = [x + y for x, y in zip(places[b], skin[b])]
            self.assertLess(abs(apart(posed, under) - 0.002), 0.0015)

    def test_rigid_parts_keep_their_shape(self):
        vertices, _ = self.patch(1)
        x, y, z = self.plain.positions(self.base)[vertices[0]]
        # A curved plate in front of the jaw.
        points = [[x + 0.004 * i, y + 0.004 * k, z + 0.004 + 0.0005 * i * i] for i in range(-4, 5) for k in range(9)]
        triangles = [t for i in range(8) for k in range(8) for a in [9 * i + k]
                     for t in ([a, a + 9, a + 1], [a + 1, a + 9, a + 10])]
        out = self.export("--attach-rigid", write("glasses.obj", obj("glasses", points, triangles)))
        neutral, targets = out.positions("glasses"), out.targets("glasses")
        largest = 0
        for name, moves in targets.items():
            posed = [[x + y for x, y in zip(p, m)] for p, m in zip(neutral, moves)]
            for i in range(0, len(posed), 7):
                for k in range(i + 1, len(posed), 5):
                    self.assertLess(abs(apart(posed[i], posed[k]) - apart(neutral[i], neutral[k])), 5e-6, name)
            largest = max(largest, max(apart(m, (0, 0, 0)) for m in moves))
        self.assertGreater(largest, 0.005, "it follows the jaw")

    def test_the_same_in_the_other_formats(self):
        vertices, triangles = self.patch()
        places = self.plain.positions(self.base)
        card = write("card.obj", obj("hair", [places[v] for v in vertices], triangles))
        for out in ("x.vrm", "x.usda"):
            done = self.ok("export", path("head.dna"), "-o", path(out), "--lod", "4", "--attach", card)
            self.assertIn("hair follows " + self.base, done.stderr)
            self.assertIn(b"hair", read(out))
        # Not only baked: by skin weights and the blend shapes of the rig.
        self.ok("export", path("head.dna"), "-o", path("rig.glb"), "--lod", "4", "--attach", card, "--quiet",
                "--skeleton")
        self.assertIn("hair", File("rig.glb").meshes)

    def test_fewer_morphs(self):
        done = run("export", path("head.dna"), "-o", path("few.glb"), "--bake", "arkit", "--lod", "4", "--morphs", "20",
                   "--exact")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("32 morph targets are left out", done.stderr)
        few = File("few.glb")
        kept = few.targets(self.base)
        self.assertEqual(len(kept), 20)
        whole = self.plain.targets(self.base)
        least = min(max(apart(m, (0, 0, 0)) for m in moves) for moves in kept.values() if any(map(any, moves)))
        self.assertIn("jawOpen", kept)
        for name, moves in whole.items():
            if name in kept:
                self.assertEqual(moves, kept[name])
            else:
                self.assertIn(name, done.stderr)
        self.assertGreater(least, 0)

    def test_wrong_use(self):
        head, out = path("head.dna"), path("no.glb")
        self.fails(FILE, "export", head, "-o", out, "--attach", path("none.obj"), "--quiet", says="none.obj")
        self.fails(INVALID, "export", head, "-o", out, "--attach", write("bad.obj", "v 0 0\n"), "--quiet",
                   says="bad.obj")
        self.fails(USAGE, "export", head, "-o", path("no.obj"), "--attach", path("card.obj"), says="--attach")
        self.fails(USAGE, "export", head, "-o", out, "--morphs", "many", says="--morphs")


if __name__ == "__main__":
    main()
