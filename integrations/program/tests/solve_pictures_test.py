#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien solve --pictures`: target, solved and distance for each kind of target, and heat where the distance is.

    solve_pictures_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)
"""
import json
import math
import os
import shutil
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(HERE, "..", "..", "..", "tests", "support")]
from picture import Picture  # noqa: E402
from program import ProgramTest, main, make, make_folder, path, read, write  # noqa: E402

HEAD = "head.dna"
WIDTH, HEIGHT, GAP, LABEL = 320, 360, 6, 36  # of a tile, and what is around it
AWAY = 100.0  # cm from the camera


def setUpModule():
    make_folder()
    make("demo-head", "-o", path("whole.dna"))
    make("convert", path("whole.dna"), "--lods", "0", "-o", path(HEAD))
    make("export", path(HEAD), "-o", path("rest.obj"), "--lod", "0")


def skin():
    """Name, positions in centimeters, and faces of the first object at rest."""
    lines = read("rest.obj").decode().split("\no ")[1].splitlines()
    faces = [[int(word.split("/")[0]) - 1 for word in line.split()[1:]] for line in lines if line.startswith("f ")]
    first = min(min(face) for face in faces)
    return (lines[0], [[100 * float(x) for x in line.split()[1:4]] for line in lines if line.startswith("v ")],
            [[i - first for i in face] for face in faces])


class Pictures(ProgramTest):
    def heat(self, *arguments):
        """Solves without moving anything, and draws: the hot pixels of the distance, their middle in shares of the tile,
        and the blue dots of the target."""
        self.ok("solve", path(HEAD), *arguments, "--controls", "jawLeft", "-o", path("out.json"), "--force",
                "--pictures", path("images"), "-q")
        self.addCleanup(shutil.rmtree, path("images"), True)
        image = Picture(read(os.path.join("images", "solve.png")))
        self.assertEqual((image.width, image.height), (3 * (WIDTH + GAP) + GAP, HEIGHT + LABEL + 2 * GAP))

        def spots(column, wanted):
            tile = image.part(GAP + column * (WIDTH + GAP), GAP, WIDTH, HEIGHT)
            return [(x, y) for y, row in enumerate(tile) for x in range(WIDTH)
                    if wanted(*row[3 * x:3 * x + 3]) and not (column == 2 and x < 90 and y < 95)]  # the legend
        hot = spots(2, lambda r, g, b: r > 90 and r > 2 * g and r > 1.2 * b)
        middle = [sum(s[k] for s in hot) / max(len(hot), 1) / (WIDTH, HEIGHT)[k] for k in range(2)]
        dots = len(spots(0, lambda r, g, b: b > 200 and b > 1.3 * g and b > 3 * r))
        none = len(spots(2, lambda r, g, b: b > 1.12 * r and b > 1.04 * g))
        return len(hot), middle, dots, none

    def assert_at_the_nose(self, middle):
        self.assertAlmostEqual(middle[0], 0.4, delta=0.08)
        self.assertAlmostEqual(middle[1], 0.5, delta=0.1)

    def nose(self, positions):
        """The tip, which is moved by a centimeter in each target."""
        return max(range(len(positions)), key=lambda i: positions[i][2])

    def test_vertices(self):
        name, positions, _ = skin()
        tip = positions[self.nose(positions)]
        lines = ["v %.6f %.6f %.6f" % (p[0], p[1], p[2] + math.exp(-(math.dist(p, tip) / 1.5)**2)) for p in positions]
        write("one.obj", "\n".join(lines) + "\nf 1 2 3\n")
        hot, middle, dots, none = self.heat(path("one.obj"), "--mesh", name)
        self.assertGreater(hot, 50)
        self.assert_at_the_nose(middle)
        self.assertEqual(dots, 0)

    def test_landmarks(self):
        """In space; and in pictures, as a camera in front of the face sees them."""
        name, positions, _ = skin()
        tip = self.nose(positions)
        # Fewer than 150, whose dots are larger.
        front = [i for i in range(0, len(positions), 75) if positions[i][2] > 6] + [tip]
        self.assertLess(len(front), 150)
        for kind, axes in (("landmarks3", "xyz"), ("landmarks2", "xy")):
            with self.subTest(kind):
                marks = [list(positions[i]) for i in front]
                marks[-1][0] += 1
                if kind == "landmarks2":
                    marks = [[1000 * p[0] / (AWAY - p[2]) + 500, -1000 * p[1] / (AWAY - p[2]) + 400] for p in marks]
                write("marks.csv", ",".join(["time"] + [f"{i}.{axis}" for i in front for axis in axes]) + "\n0," +
                      ",".join("%.5f" % x for p in marks for x in p) + "\n")
                write("points.json", json.dumps({"mesh": name, "camera": {
                    "focal": [1000, 1000], "center": [500, 400], "rotation": [1, 0, 0, 0, -1, 0, 0, 0, -1],
                    "translation": [0, 0, AWAY]}}))
                hot, middle, dots, none = self.heat(path("marks.csv"), "--landmarks", path("points.json"))
                self.assertGreater(hot, 15)
                self.assert_at_the_nose(middle)
                self.assertGreater(dots, 10 * len(front) / 3, "a third of them at least are seen")
                self.assertGreater(none, 500, "the neck has no landmarks")

    def test_surfaces(self):
        """A scan of the face with another nose. Skin that it lacks has no target."""
        name, positions, faces = skin()
        tip = positions[self.nose(positions)]
        moved = [[p[0], p[1], p[2] + math.exp(-(math.dist(p, tip) / 1.5)**2)] for p in positions]
        kept = [face for face in faces if all(positions[i][2] > 3 for i in face)]
        write("scan.obj", "".join("v %.6f %.6f %.6f\n" % tuple(p) for p in moved) +
              "".join("f " + " ".join(str(i + 1) for i in face) + "\n" for face in kept))
        hot, middle, dots, none = self.heat(path("scan.obj"), "--kind", "surface", "--mesh", name, "--reach", "2")
        self.assertGreater(hot, 50)
        self.assert_at_the_nose(middle)
        self.assertGreater(none, 500)


if __name__ == "__main__":
    main()
