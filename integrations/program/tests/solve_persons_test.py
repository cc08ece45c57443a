#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Heads of other people that `mien author` rigs, solved for the expressions of the generated head: the points of MediaPipe
are placed on both, and what they do on one is asked of the other. Prints the table of docs/solving.md.

    solve_persons_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)

With MIEN_PICTURES=FOLDER, pictures of the solves are kept there.
"""
import json
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(HERE, "..", "..", "..", "tests", "support")]
from program import ProgramTest, long_form, main, make, make_folder, path, read, write  # noqa: E402

SHARED = os.environ.get("MIEN_SHARED") or os.path.join(HERE, "..", "..", "..", "..", "shared")
MESHES = os.path.join(SHARED, "data", "meshes")
FACE = os.path.join(MESHES, "mediapipe", "canonical_face_model.obj")
EXPRESSIONS = [
    {"jawOpen": 0.6},
    {"mouthSmileLeft": 0.8, "mouthSmileRight": 0.8, "cheekSquintLeft": 0.4, "cheekSquintRight": 0.4},
    {"browInnerUp": 0.9, "browOuterUpLeft": 0.8, "browOuterUpRight": 0.8, "jawOpen": 0.3},
    {"mouthPucker": 0.9},
    {"noseSneerLeft": 0.8, "noseSneerRight": 0.8, "browDownLeft": 0.9, "browDownRight": 0.9, "mouthFrownLeft": 0.5,
     "mouthFrownRight": 0.5},
    {"eyeBlinkLeft": 1, "mouthLeft": 0.6}]
# What `mien author` is given, and for each expression a control that must be found, and the largest share of the motion
# that may remain. The sixth has a mouth that MakeHuman's head has no expression for.
PERSONS = {
    "MakeHuman": (["makehuman/base.obj", "--shapes", "makehuman/targets", "--unit", "dm", "--objects", "body",
                   "--crop=-1,1,5,,,"],
                  [("mouth-open", 0.25), ("mouth-corner-puller", 0.7), ("eyebrows-left-inner-up", 0.35),
                   ("mouth-pursing", 0.5), ("nose-left-elevation", 0.7), ("eye-left-closure", 0.92)]),
    "ICT-FaceKit": (["ict/ict_neutral.obj", "--shapes", "ict/ict_expressions.mshp"],
                    [("jawOpen", 0.25), ("mouthSmile_L", 0.7), ("browOuterUp_L", 0.4), ("mouthPucker", 0.7),
                     ("mouthFrown_L", 0.8), ("eyeBlink_L", 0.8)]),
}


def setUpModule():
    make_folder()
    make("demo-head", "-o", path("whole.dna"))
    make("convert", path("whole.dna"), "--lods", "0", "-o", path("generated.dna"))


def skin(rig, mesh, pose):
    """Positions of a mesh in centimeters."""
    sets = [word for control, value in pose.items() for word in ("--set", f"{control}={value}")]
    make("export", path(rig), "-o", path("posed.obj"), "--lod", "0", "--force", *sets)
    for part in read("posed.obj").decode().split("\no ")[1:]:
        lines = part.splitlines()
        if lines[0] == mesh:
            return [[100 * float(x) for x in line.split()[1:4]] for line in lines if line.startswith("v ")]
    raise AssertionError(f"{rig} has no object {mesh}")


def root_mean_square(values):
    return math.sqrt(sum(v * v for v in values) / len(values))


class Persons(ProgramTest):
    def place(self, rig):
        """Where MediaPipe's points are on a rig: the file, and the function from its positions to them."""
        places = rig + ".json"
        self.ok("solve", path(rig), FACE, "--place-landmarks", "mediapipe", "-o", path(places), "-q")
        document = json.loads(read(places))

        def points(pose):
            positions = skin(rig, document["mesh"], pose)
            return {name: [sum(w * positions[i][k] for i, w in zip(p["positions"], p["weights"])) for k in range(3)]
                    for name, p in document["points"].items()}
        return places, points

    def solve(self, person):
        arguments, wanted = PERSONS[person]
        source = [os.path.join(MESHES, word) if "/" in word else word for word in arguments]
        if not os.path.exists(source[0]):
            self.skipTest(f"NOT TESTED: {person} solved for another person's expressions; there is no {source[0]}")
        self.ok("author", *source, "-o", path("person.dna"), "--force", "-q")
        _, points = self.place("generated.dna")
        places, own_points = self.place("person.dna")
        rest, own_rest = points({}), own_points({})
        names = sorted(rest, key=int)
        scale = [(max(own_rest[n][k] for n in names) - min(own_rest[n][k] for n in names)) /
                 (max(rest[n][k] for n in names) - min(rest[n][k] for n in names)) for k in range(3)]
        lines, moved = [",".join(["time"] + [f"{n}.{axis}" for n in names for axis in "xyz"])], []
        for f, expression in enumerate(EXPRESSIONS):
            now = points(expression)
            by = {n: [scale[k] * (now[n][k] - rest[n][k]) for k in range(3)] for n in names}
            moved.append([math.hypot(*d) for d in by.values()])
            lines.append(",".join([str(f)] + ["%.6f" % (own_rest[n][k] + by[n][k]) for n in names for k in range(3)]))
        write("marks.csv", "\n".join(lines) + "\n")
        pictures = os.environ.get("MIEN_PICTURES")
        folder = ["--pictures", os.path.join(pictures, person)] if pictures else []
        self.ok("solve", path("person.dna"), path("marks.csv"), "--landmarks", path(places), "--sparse", "0.002", "-o",
                path("out.json"), "--report", path("report.json"), "--force", "-q", *folder)
        take, report = json.loads(read("out.json")), json.loads(read("report.json"))
        controls = [name.rpartition(".")[2] for name in take["controls"]]
        print(f"\n{person}: {len(controls)} controls; expression, largest motion, its root mean square, that of what is left, "
              "controls")
        for f, expression in enumerate(EXPRESSIONS):
            found = dict(zip(controls, take["frames"][f]["raw"]))
            largest = sorted(found, key=found.get, reverse=True)[:5]
            left, asked = report["by_frame"][f]["rms"], root_mean_square(moved[f])
            print("| %s | %.1f mm | %.1f mm | %.1f mm | %s |" % (
                ", ".join(f"{name} {value}" for name, value in expression.items()), 10 * max(moved[f]), 10 * asked,
                10 * left, ", ".join(f"{name} {found[name]:.2f}" for name in largest if found[name] > 0.1)))
            name, share = wanted[f]
            self.assertIn(name, largest)
            self.assertGreater(found[name], 0.25, expression)
            self.assertLess(left, share * asked, expression)

    def test_makehuman(self):
        self.solve("MakeHuman")

    @long_form
    def test_ict(self):
        self.solve("ICT-FaceKit")


if __name__ == "__main__":
    main()
