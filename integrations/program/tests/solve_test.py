#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien solve`: known controls come back from meshes, joints, landmarks and another rig; keys stay within their
tolerance; wrong targets are refused with one line.

    cli_solve_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)
"""
import json
import math
import os
import re
import shutil
import signal
import struct
import subprocess
import sys
import zipfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "tests", "support"))
import program  # noqa: E402
from picture import Picture  # noqa: E402
from program import (USAGE, INVALID, FILE, ProgramTest, main, make, make_folder, path, read, write)  # noqa: E402

SOURCES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..")
HEAD, TINY, SMALL = "head.dna", "tiny.dna", "small.dna"
POSE = {"jawOpen": 0.7, "mouthSmileLeft": 0.4, "browInnerUp": 0.9}


def setUpModule():
    make_folder()
    make("demo-head", "-o", path("whole.dna"))
    make("convert", path("whole.dna"), "--lods", "0", "-o", path(HEAD))
    make("gen", "--preset", "tiny", "--seed", "3", "-o", path(TINY))
    make("gen", "--preset", "small", "--seed", "3", "-o", path(SMALL))


def npy(shape, numbers):
    """An array of 32-bit floats as numpy.save() writes it."""
    header = "{'descr': '<f4', 'fortran_order': False, 'shape': (%s), }" % ", ".join(map(str, shape))
    header += " " * (-(len(header) + 11) % 64) + "\n"
    return (b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() +
            struct.pack("<%df" % len(numbers), *numbers))


def frames_of(poses):
    return json.dumps({"frames": [{"raw": pose} for pose in poses]})


def motion(count):
    """A smile that comes while the jaw opens and closes."""
    return [{"jawOpen": 0.5 - 0.5 * math.cos(0.3 * f), "mouthSmileLeft": min(1, 0.1 * f)} for f in range(count)]


class SolveTest(ProgramTest):
    made = {}

    def obj(self, pose):
        """Name and positions of the first mesh of the head in a pose, in the unit of the rig."""
        key = tuple(pose.items())
        if key not in self.made:
            self.made[key] = self.make_obj(pose)
        return self.made[key]

    def make_obj(self, pose):
        sets = [word for control, value in pose.items() for word in ("--set", f"{control}={value}")]
        self.ok("export", path(HEAD), "-o", path("posed.obj"), "--lod", "0", *sets)
        with open(path("posed.obj"), encoding="utf-8") as file:
            lines = file.read().splitlines()
        mesh = re.sub(r"^o ", "", next(line for line in lines if line.startswith("o ")))
        points, begun = [], 0
        for line in lines:
            begun += line.startswith("o ")
            if begun == 1 and line.startswith("v "):
                points.append([100 * float(x) for x in line.split()[1:4]])  # from meters
        return mesh, points

    def joints(self, rig, poses):
        write("poses.json", frames_of(poses))
        self.ok("eval", path(rig), "--input", path("poses.json"), "-o", path("joints.npy"))
        return path("joints.npy")

    def solved(self, *arguments, rig=HEAD):
        """Rows of all controls by their short names, and the report."""
        self.ok("solve", path(rig), *arguments, "-o", path("out.json"), "--report", path("report.json"), "-q")
        document, report = json.loads(read("out.json")), json.loads(read("report.json"))
        names = [name.rpartition(".")[2] for name in document["controls"]]
        rows = [dict(zip(names, frame["raw"])) for frame in document["frames"]]
        self.assertEqual(report["frames"], len(rows))
        return rows, report

    def compare(self, row, pose, within, unobservable=()):
        hidden = {name.rpartition(".")[2] for name in unobservable}
        for name, value in row.items():
            # The gaze moves the lids a little, and no other part of the skin.
            if name not in hidden and not name.startswith("eyeLook"):
                self.assertAlmostEqual(value, pose.get(name, 0), delta=within, msg=name)


class Kinds(SolveTest):
    def test_joints_of_a_generated_rig(self):
        names = [name.rpartition(".")[2] for name in self.names(SMALL, "raw")]
        poses = [{names[(7 * f + 3 * k) % len(names)]: 0.2 + 0.15 * k for k in range(5)} for f in range(6)]
        rows, report = self.solved(self.joints(SMALL, poses), "--kind", "joints", rig=SMALL)
        for row, pose in zip(rows, poses):
            self.compare(row, pose, 0.01, report["unobservable"])
        self.assertLess(report["residual"]["rms"], 1e-3)
        self.assertGreaterEqual(report["residual"]["worst"], report["residual"]["rms"])

    def test_meshes_of_each_format(self):
        mesh, points = self.obj(POSE)
        flat = [x for point in points for x in point]
        write("one.npy", npy((1, len(points), 3), flat))
        write("bare.npy", npy((len(points), 3), flat))
        with zipfile.ZipFile(path("one.npz"), "w") as file:
            file.writestr("arr_0.npy", read("bare.npy"))
        text = "".join("v %.9g %.9g %.9g\n" % tuple(point) for point in points) + "f 1 2 3\n"
        os.makedirs(path("scans"), exist_ok=True)
        self.addCleanup(shutil.rmtree, path("scans"))
        for name in ("a.obj", "b.obj"):
            write(os.path.join("scans", name), text)
        for target in ("one.npy", "bare.npy", "one.npz", os.path.join("scans", "a.obj"), "scans"):
            with self.subTest(target):
                rows, report = self.solved(path(target), "--mesh", mesh)
                self.assertEqual(len(rows), 2 if target == "scans" else 1)
                for row in rows:
                    self.compare(row, POSE, 0.01, report["unobservable"])
                self.assertLess(report["residual"]["worst"], 0.01)  # cm

    def test_units_and_axes(self):
        """Files of `mien export` say theirs; --unit says that of others."""
        sets = [word for name, value in POSE.items() for word in ("--set", f"{name}={value}")]
        self.ok("export", path(HEAD), "-o", path("own.obj"), "--lod", "0", *sets)
        mesh, points = self.obj(POSE)
        meters = [[x / 100 for x in point] for point in points]
        write("meters.npy", npy((1, len(points), 3), [x for point in meters for x in point]))
        write("meters.obj", b"# exported\n" + read("own.obj").partition(b"\n")[2])
        for target, options in (("own.obj", ()), ("own.obj", ("--unit", "m")), ("meters.obj", ("--unit", "m")),
                                ("meters.npy", ("--unit", "m"))):
            with self.subTest(target, options=options):
                rows, report = self.solved(path(target), "--mesh", mesh, *options)
                self.compare(rows[0], POSE, 0.01, report["unobservable"])
                self.assertLess(report["residual"]["worst"], 0.01)  # cm
        # The same rig in meters, z up.
        self.ok("convert", path(HEAD), "--system", "blender", "-o", path("turned.dna"))
        rows, report = self.solved(path("own.obj"), "--mesh", mesh, rig="turned.dna")
        self.compare(rows[0], POSE, 0.01, report["unobservable"])
        self.assertLess(report["residual"]["worst"], 1e-4)  # m

    def test_joints_of_an_animated_glb(self):
        poses = [{"jawOpen": 0.1}, POSE, {"mouthSmileLeft": 0.8, "browInnerUp": 0.5}]
        write("poses.json", json.dumps({"rate": 30, "frames": [{"raw": pose} for pose in poses]}))
        self.ok("export", path(HEAD), "-o", path("animated.glb"), "--animation", path("poses.json"))
        rows, report = self.solved(path("animated.glb"), "--kind", "joints")
        self.assertEqual(json.loads(read("out.json"))["rate"], 30)
        self.assertEqual(len(rows), 3)
        for row, pose in zip(rows, poses):
            self.compare(row, pose, 0.01, report["unobservable"])
        # Joints without a node count nothing, and are no reason to tell of a jump.
        moved = [datum["name"] for datum in report["by_joint"]]
        lost = [name for name in moved if "Lip" in name]
        self.assertGreater(len(lost), 10)
        data = read("animated.glb")
        for name in lost:
            self.assertEqual(data.count(f'"{name}"'.encode()), 1)
            data = data.replace(f'"{name}"'.encode(), f'"{name[::-1]}"'.encode())
        rows, report = self.solved(write("lost.glb", data), "--kind", "joints")
        for row, pose in zip(rows, poses):
            self.compare(row, pose, 0.01, report["unobservable"])
        self.assertEqual((report["missing"], report["jumped"]), (0, []))
        self.assertEqual(len(report["by_joint"]), len(moved) - len(lost))
        self.fails(INVALID, "solve", path(TINY), path("animated.glb"), "--kind", "joints", "-o", path("no.json"),
                   says="no node has the name")
        self.fails(INVALID, "solve", path(TINY), write("wrong.glb", b"glTF" + bytes(40)), "--kind", "joints", "-o",
                   path("no.json"), says="wrong.glb")

    def test_animations_that_ask_for_much_or_are_wrong(self):
        times = struct.pack("<2000f", *range(2000))
        binary = times + bytes(24000)

        def animated(edit=lambda root: None):
            channel = {"sampler": 0, "target": {"node": 0, "path": "translation"}}
            root = {"asset": {"version": "2.0"}, "nodes": [{"name": "head"}], "buffers": [{"byteLength": len(binary)}],
                    "bufferViews": [{"buffer": 0, "byteLength": 8000},
                                    {"buffer": 0, "byteOffset": 8000, "byteLength": 24000}],
                    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 2000, "type": "SCALAR"},
                                  {"bufferView": 1, "componentType": 5126, "count": 2000, "type": "VEC3"}],
                    "animations": [{"samplers": [{"input": 0, "output": 1}], "channels": [channel]}]}
            edit(root)
            text = json.dumps(root).encode()
            text += b" " * (-len(text) % 4)
            return (struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)) +
                    struct.pack("<II", len(text), 0x4E4F534A) + text +
                    struct.pack("<II", len(binary), 0x004E4942) + binary)

        def change(**members):
            def edit(root):
                animation = root["animations"][0]
                for name, value in members.items():
                    if name in animation["samplers"][0] or name == "interpolation":
                        animation["samplers"][0][name] = value
                    else:
                        animation["channels"][0][name] = value
            return edit

        def again_and_again(root):
            root["animations"][0]["channels"] *= 4000

        for edit, says in ((again_and_again, "the same data too often"),
                           (change(input=1), "SCALAR"), (change(output=0), "VEC3"), (change(sampler=1), "sampler 1"),
                           (change(interpolation="CUBICSPLINE"), "cubic splines"), (change(target=1), "a channel is wrong"),
                           (change(target={"node": 7, "path": "scale"}), "node 7"),
                           (lambda root: root["accessors"][1].update(count=1999), "number of values"),
                           (lambda root: root["bufferViews"][0].update(byteOffset=8000), "do not ascend"),
                           (lambda root: root["nodes"][0].update(scale=[1, 1]), "scale of a node")):
            source = write("hostile.glb", animated(edit))
            self.fails(INVALID, "solve", path(HEAD), source, "--kind", "joints", "-o", path("no.json"), says=says)

    def test_a_surface_of_another_topology(self):
        mesh, points = self.obj(POSE)
        self.ok("export", path(HEAD), "-o", path("posed.obj"), "--lod", "0",
                *[word for name, value in POSE.items() for word in ("--set", f"{name}={value}")])
        faces, begun = [], 0
        for line in read("posed.obj").decode().splitlines():
            begun += line.startswith("o ")
            if begun == 1 and line.startswith("f "):
                faces.append([int(word.split("/")[0]) for word in line.split()[1:]])
        # Positions in another order, polygons as triangles from their second corner, moved by 0.3 cm. Expressions of ARKit
        # alone: a surface does not tell how far a jaw is open if lipsTogether may seal the lips.
        count = len(points)
        lines = ["v %.6f %.6f %.6f" % (p[0] + 0.3, p[1], p[2]) for p in reversed(points)]
        for face in faces:
            turned = [count + 1 - i for i in face[1:] + face[:1]]
            lines += ["f %d %d %d" % (turned[0], a, b) for a, b in zip(turned[1:], turned[2:])]
        write("scan.obj", "\n".join(lines) + "\n")
        rows, report = self.solved(path("scan.obj"), "--kind", "surface", "--mesh", mesh, "--rigid", "--reach", "2",
                                   "--first", "jaw*", "--controls", ",".join(self.names(HEAD, "raw")[:52]))
        for name, value in POSE.items():
            self.assertAlmostEqual(rows[0][name], value, delta=0.02, msg=name)
        self.assertLess(report["residual"]["rms"], 0.01)  # cm
        self.assertAlmostEqual(report["by_frame"][0]["translation"][0], 0.3, delta=0.02)
        self.assertLess(report["by_region"][0]["worst"], 0.5)  # cm
        self.assertGreater(len(report["by_region"]), 5)

    def test_a_posed_glb(self):
        mesh, _ = self.obj({})
        shapes = write("shapes.json", json.dumps({"smile": {"mouthSmileLeft": 1}, "open": {"jawOpen": 1}}))
        self.ok("export", path(HEAD), "-o", path("shapes.glb"), "--bake", shapes)
        rows, report = self.solved(path("shapes.glb"), "--mesh", mesh)
        names = [frame["name"] for frame in report["by_frame"]]
        self.assertEqual(len(rows), len(names))
        self.compare(rows[names.index("open")], {"jawOpen": 1}, 0.02, report["unobservable"])

    def test_controls_of_another_rig(self):
        poses = motion(4)
        for target in ("take.json", "take.clip"):
            with self.subTest(target):
                write("take.json", json.dumps({"rate": 24, "frames": [{"raw": pose} for pose in poses]}))
                if target == "take.clip":
                    self.ok("clip", "build", path("take.json"), "-o", path("take.clip"))
                rows, report = self.solved(path(target), "--from", path(HEAD))
                self.assertEqual(json.loads(read("out.json"))["rate"], 24)
                for row, pose in zip(rows, poses):
                    self.compare(row, pose, 0.01, report["unobservable"])

    def landmarks(self, poses, columns):
        """CSV of every 40th position, by `columns` of a position, at 25 frames per second."""
        lines, numbers = [], None
        for f, pose in enumerate(poses):
            mesh, points = self.obj(pose)
            numbers = range(0, len(points), 40)
            lines.append(",".join(["%.3f" % (f / 25)] + ["%.6f" % x for i in numbers for x in columns(points[i])]))
        axes = "xyz"[:len(columns((0, 0, 0)))]
        header = ["time"] + [f"p{i}.{axis}" for i in numbers for axis in axes]
        write("landmarks.csv", "\n".join([",".join(header)] + lines) + "\n")
        return {"mesh": mesh, "points": {f"p{i}": i for i in numbers}}

    def test_landmarks_in_space(self):
        poses = motion(3)
        places = self.landmarks(poses, lambda p: p)
        name, first = next(iter(places["points"].items()))
        places["points"][name] = {"positions": [first, first, first], "weights": [0.5, 0.25, 0.25]}
        write("points.json", json.dumps(places))
        rows, report = self.solved(path("landmarks.csv"), "--landmarks", path("points.json"))
        self.assertEqual(json.loads(read("out.json"))["rate"], 25)
        for row, pose in zip(rows, poses):
            self.compare(row, pose, 0.03, report["unobservable"])
        # Missing ones, and a frame without any.
        lines = read("landmarks.csv").decode().splitlines()
        cells = lines[2].split(",")
        cells[4:7] = ["", "", ""]
        lines[2] = ",".join(cells)
        lines[3] = lines[3].split(",")[0] + "," * (len(cells) - 1)
        write("gaps.csv", "\n".join(lines))
        rows, report = self.solved(path("gaps.csv"), "--landmarks", path("points.json"))
        self.compare(rows[1], poses[1], 0.03, report["unobservable"])
        self.assertEqual(report["by_frame"][2]["status"], "no data")
        self.assertEqual(rows[2], rows[1])
        # Moved as a whole.
        write("moved.csv", "\n".join(
            line if f == 0 else ",".join(cell if c % 3 or c == 0 else "%.6f" % (float(cell) + 7)
                                         for c, cell in enumerate(line.split(",")))
            for f, line in enumerate(read("landmarks.csv").decode().splitlines())))
        rows, report = self.solved(path("moved.csv"), "--landmarks", path("points.json"), "--rigid")
        self.compare(rows[-1], poses[-1], 0.03, report["unobservable"])
        self.assertAlmostEqual(report["by_frame"][-1]["translation"][2], 7, delta=0.05)

    def test_landmarks_in_images(self):
        focal, away = 2000.0, 120.0

        def seen(p):  # x to the right of the image, y down
            return focal * p[0] / (away - p[2]) + 500, -focal * p[1] / (away - p[2]) + 400
        poses = [{"jawOpen": 0.6}, {"jawOpen": 0.3}]
        places = self.landmarks(poses, seen)
        places["camera"] = {"focal": [focal, focal], "center": [500, 400],
                            "rotation": [1, 0, 0, 0, -1, 0, 0, 0, -1], "translation": [0, 0, away]}
        write("points.json", json.dumps(places))
        rows, report = self.solved(path("landmarks.csv"), "--landmarks", path("points.json"), "--sparse", "0.01")
        for row, pose in zip(rows, poses):
            self.assertAlmostEqual(row["jawOpen"], pose["jawOpen"], delta=0.03)
        self.assertLess(report["residual"]["worst"], 1)  # pixel
        # A camera of which only the focal length is known, not exactly.
        places["camera"] = {"focal": [1.1 * focal, 1.1 * focal], "center": [500, 400]}
        write("points.json", json.dumps(places))
        rows, report = self.solved(path("landmarks.csv"), "--landmarks", path("points.json"), "--sparse", "0.01",
                                   "--rigid", "--focal")
        for row, pose, frame in zip(rows, poses, report["by_frame"]):
            self.assertAlmostEqual(row["jawOpen"], pose["jawOpen"], delta=0.05)
            self.assertAlmostEqual(frame["translation"][2] / frame["focal"][0], away / focal, delta=0.01)
        del places["camera"]
        write("points.json", json.dumps(places))
        self.fails(INVALID, "solve", path(HEAD), path("landmarks.csv"), "--landmarks", path("points.json"),
                   "-o", path("no.json"), says="camera")


class Places(SolveTest):
    """--place-landmarks: on generated heads of two persons, whose positions of the same number correspond."""
    positions = {}

    def head(self, seed):
        """Name and positions of the skin of a generated head."""
        if seed not in self.positions:
            make("demo-head", "--seed", str(seed), "-o", path("whole.dna"), "--force")
            make("convert", path("whole.dna"), "--lods", "0", "-o", path(f"person{seed}.dna"))
            make("export", path(f"person{seed}.dna"), "-o", path("person.obj"), "--lod", "0", "--force")
            skin = read("person.obj").decode().split("\no ")[1]
            self.positions[seed] = [[100 * float(x) for x in line.split()[1:4]]
                                    for line in skin.splitlines() if line.startswith("v ")]
        return f"person{seed}.dna", self.positions[seed]

    def place(self, rig, *options):
        self.ok("solve", path(rig), *options, "-o", path("places.json"), "--force", "-q")
        document = json.loads(read("places.json"))
        self.assertEqual(document["mesh"], "head_lod0_mesh")
        self.assertEqual(list(document["points"]), [str(i) for i in range(len(document["points"]))])
        return list(document["points"].values())

    def at(self, points, positions):
        return [[sum(w * positions[i][k] for i, w in zip(point["positions"], point["weights"])) for k in range(3)]
                for point in points]

    def compare_persons(self, count, *options):
        (first, _), (second, positions) = self.head(0), self.head(7)
        wanted = self.at(self.place(first, *options), positions)
        found = self.at(self.place(second, *options), positions)
        self.assertEqual(len(found), count)
        distances = [math.dist(*pair) for pair in zip(wanted, found)]
        self.assertLess(sum(distances) / count, 0.15)  # cm
        self.assertLess(max(distances), 1.2)
        return wanted

    def test_68_points(self):
        self.compare_persons(68, "--place-landmarks", "68")
        points = self.at(self.place(self.head(0)[0], "--place-landmarks", "68"), self.head(0)[1])
        # Left is +x; each pair of corners is symmetric.
        for right, left in ((0, 16), (17, 26), (36, 45), (39, 42), (31, 35), (48, 54), (60, 64)):
            self.assertLess(math.dist(points[left], [-points[right][0], *points[right][1:]]), 0.1, (left, right))
            self.assertGreater(points[left][0], 0.5)
        self.assertGreater(points[30][2], max(p[2] for i, p in enumerate(points) if i != 30))  # tip of the nose
        self.assertLess(points[8][1], min(p[1] for i, p in enumerate(points) if i not in (7, 8, 9)))
        for upper, lower in ((62, 66), (61, 67), (63, 65), (51, 57), (37, 41), (44, 46)):
            self.assertGreater(points[upper][1], points[lower][1])
        # The file is what --landmarks takes.
        lines = [",".join(["time"] + [f"{i}.{axis}" for i in range(68) for axis in "xyz"]),
                 ",".join(["0"] + ["%.5f" % x for point in points for x in point])]
        write("placed.csv", "\n".join(lines) + "\n")
        rows, report = self.solved(path("placed.csv"), "--landmarks", path("places.json"), rig=self.head(0)[0])
        self.assertLess(max(rows[0].values()), 0.01)
        self.assertLess(report["residual"]["worst"], 0.01)

    def test_mediapipe(self):
        shared = os.environ.get("MIEN_SHARED") or os.path.join(SOURCES, "..", "shared")
        face = os.path.join(shared, "data", "meshes", "mediapipe", "canonical_face_model.obj")
        if not os.path.exists(face):
            print(f"NOT TESTED: landmarks of MediaPipe; there is no {face}")
            return
        self.compare_persons(468, face, "--place-landmarks", "mediapipe")

    def test_what_cannot_be_placed(self):
        set_68 = "--place-landmarks", "68", "-o", path("no.json")
        self.fails(INVALID, "solve", path(TINY), *set_68, says="lips")
        self.fails(USAGE, "solve", path(HEAD), path("none.obj"), *set_68, says="TARGET")
        self.fails(USAGE, "solve", path(HEAD), "--place-landmarks", "mediapipe", "-o", path("no.json"), says="MediaPipe")
        self.fails(USAGE, "solve", path(HEAD), "--place-landmarks", "69", "-o", path("no.json"), says="mediapipe")
        self.fails(USAGE, "solve", path(HEAD), "--place-landmarks", "68", "-o", path("no.clip"), says=".json")
        self.fails(USAGE, "solve", path(HEAD), *set_68, "--report", path("no.json"), says="--report")
        self.fails(USAGE, "solve", path(HEAD), "-o", path("no.json"), says="TARGET")
        wrong = write("wrong.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.fails(INVALID, "solve", path(HEAD), wrong, "--place-landmarks", "mediapipe", "-o", path("no.json"),
                   says="468")


class Masks(SolveTest):
    def test_vertices_that_count(self):
        mesh, points = self.obj(POSE)
        flat = [x for point in points for x in point]
        # Everything above the nose is wrong, and the mask leaves it out.
        rest = self.obj({})[1]
        wrong = [p[k] + (1 if p[1] > -1 else 0) for p, q in zip(points, rest) for k in range(3)]
        write("wrong.npy", npy((len(points), 3), wrong))
        weights = [0 if p[1] > -1 else 1 for p in points]
        write("mask.npy", npy((len(points),), weights))
        below = [i for i, w in enumerate(weights) if w]
        ranges = []
        for i in below:
            if ranges and ranges[-1][1] == i - 1:
                ranges[-1][1] = i
            else:
                ranges.append([i, i])
        write("mask.json", json.dumps({"positions": ranges}))
        reports = []
        for mask in ("mask.npy", "mask.json"):
            rows, report = self.solved(path("wrong.npy"), "--mesh", mesh, "--mask", path(mask))
            self.assertAlmostEqual(rows[0]["jawOpen"], POSE["jawOpen"], delta=0.01)
            self.assertLess(report["residual"]["worst"], 0.05)
            reports.append(rows)
        self.assertEqual(*reports)
        rows, _ = self.solved(path("wrong.npy"), "--mesh", mesh)
        self.assertGreater(abs(rows[0]["jawOpen"] - POSE["jawOpen"]) + abs(rows[0]["browInnerUp"] - 0.9), 0.01)
        # What joints hold: the names of joints, as far as they move a vertex.
        write("one.npy", npy((len(points), 3), flat))
        jaw = next(name for name in self.names(HEAD, "joints") if "jaw" in name.lower())
        write("mask.json", json.dumps({"names": {jaw: 1}}))
        rows, report = self.solved(path("one.npy"), "--mesh", mesh, "--mask", path("mask.json"))
        self.assertLess(report["residual"]["rms"], 0.01)
        self.assertGreater(rows[0]["jawOpen"], 0.3)
        self.assertLess(rows[0]["browInnerUp"], 0.1)  # the jaw holds no brows

    def test_joints_that_count(self):
        joints = [name for name in self.names(SMALL, "joints")]
        raw = [name.rpartition(".")[2] for name in self.names(SMALL, "raw")]
        target = self.joints(SMALL, [{raw[0]: 0.5, raw[3]: 0.7}])
        write("mask.json", json.dumps({"otherwise": 1, "names": {joints[0]: 0, joints[-1]: 2}}))
        rows, report = self.solved(target, "--kind", "joints", "--mask", path("mask.json"), rig=SMALL)
        self.assertLess(report["residual"]["rms"], 1e-3)
        write("mask.npy", npy((len(joints),), [1] + [0] * (len(joints) - 1)))
        _, only = self.solved(target, "--kind", "joints", "--mask", path("mask.npy"), rig=SMALL)
        self.assertGreater(len(only["unobservable"]), len(report["unobservable"]))

    def test_landmarks_that_count(self):
        mesh, points = self.obj(POSE)
        numbers = range(0, len(points), 40)
        wrong = numbers[3]
        values = [x + (5 if i == wrong else 0) for i in numbers for x in points[i]]
        write("marks.csv", "time," + ",".join(f"p{i}.{k}" for i in numbers for k in "xyz") + "\n0," +
              ",".join("%.6f" % x for x in values) + "\n")
        write("points.json", json.dumps({"mesh": mesh, "points": {f"p{i}": i for i in numbers}}))
        write("mask.json", json.dumps({"otherwise": 1, "names": {f"p{wrong}": 0}}))
        rows, report = self.solved(path("marks.csv"), "--landmarks", path("points.json"), "--mask", path("mask.json"))
        self.compare(rows[0], POSE, 0.03, report["unobservable"])
        self.assertLess(report["residual"]["worst"], 0.05)

    def test_masks_that_do_not_fit(self):
        _, points = self.obj({})
        target = write("one.npy", npy((len(points), 3), [x for point in points for x in point]))

        def refuse(mask, says, name="wrong.json"):
            self.fails(INVALID, "solve", path(HEAD), target, "--mask", write(name, mask), "-o", path("no.json"),
                       says=says)
        refuse("[]", "object")
        refuse('{"names": ', "byte")
        refuse('{"name": {}}', "names")
        refuse('{"names": []}', "object")
        refuse('{"names": {"nobody": 1}}', "nobody")
        refuse('{"names": {"*": -1}}', "from 0 on")
        refuse('{"otherwise": "x"}', "from 0 on")
        refuse('{"positions": 1}', "list")
        refuse('{"positions": [999999999]}', "999999999")
        refuse('{"positions": [[5, 2]]}', "[5,2]")
        refuse("{}", "all weights are 0")
        refuse(npy((3,), [1, 1, 1]), "3 numbers", "wrong.mask.npy")
        refuse(npy((len(points),), [-1] * len(points)), "negative", "wrong.mask.npy")


class Reports(SolveTest):
    """What the report and the notes say of data that are missing, of jumps, and of what is left of each datum."""

    def notes(self, *arguments, rig=HEAD):
        done = self.ok("solve", path(rig), *arguments, "-o", path("out.json"), "--force")
        return [line for line in done.stderr.splitlines() if "note:" in line]

    def worst_first(self, data, report):
        self.assertEqual([d["worst"] for d in data], sorted((d["worst"] for d in data), reverse=True))
        self.assertAlmostEqual(data[0]["worst"], report["residual"]["worst"],
                               delta=1e-3 * report["residual"]["worst"] + 1e-5)
        for datum in data:
            self.assertLessEqual(datum["rms"], datum["worst"])

    def test_missing_vertices(self):
        mesh, points = self.obj(POSE)
        flat = [x for point in points for x in point]
        gaps = [math.nan if i % 3 == 0 and i // 3 % 4 == 1 else x for i, x in enumerate(flat)]
        count = sum(map(math.isnan, gaps))
        write("gaps.npy", npy((3, len(points), 3), flat + gaps + [math.nan] * len(flat)))
        arguments = path("gaps.npy"), "--mesh", mesh
        rows, report = self.solved(*arguments, "--pictures", path("drawn"))
        self.addCleanup(shutil.rmtree, path("drawn"))
        for row in rows:
            self.compare(row, POSE, 0.01, report["unobservable"])
        self.assertEqual([frame["missing"] for frame in report["by_frame"]], [0, count, len(points)])
        self.assertEqual([frame["status"] for frame in report["by_frame"]], ["converged", "converged", "no data"])
        self.assertEqual(report["missing"], count + len(points))
        self.assertEqual(report["jumped"], [])
        notes = self.notes(*arguments)
        self.assertEqual(len(notes), 2, notes)
        self.assertTrue(notes[0].endswith("1 of 3 frames have no data and hold the frame before: 2"), notes)
        self.assertIn("2 of 3 frames lack some targets, at most", notes[1])
        self.assertTrue(notes[1].endswith("points: 1, 2"), notes)

    def test_missing_joint_values(self):
        names = [name.rpartition(".")[2] for name in self.names(SMALL, "raw")]
        pose = {names[2]: 0.6, names[5]: 0.3}
        array = read(os.path.basename(self.joints(SMALL, [pose])))
        count = 9 * len(self.names(SMALL, "joints"))
        values = list(struct.unpack("<%df" % count, array[-4 * count:]))
        for i in range(0, count, 5):
            values[i] = math.nan
        target = write("gaps.npy", npy((1, count // 9, 9), values))
        rows, report = self.solved(target, "--kind", "joints", rig=SMALL)
        self.compare(rows[0], pose, 0.01, report["unobservable"])
        self.assertEqual(report["missing"], len(range(0, count, 5)))
        self.assertIn("joint values: 0", self.notes(target, "--kind", "joints", rig=SMALL)[0])
        # Quaternions are 10 values of a joint.
        self.ok("bake", path(SMALL), "-o", path("turns.mien"), "--rotation", "quaternion", "--force")
        self.fails(INVALID, "solve", path("turns.mien"), target, "--kind", "joints", "-o", path("no.json"),
                   says=f"{count // 9} x 10")
        write("poses.json", frames_of([pose]))
        self.ok("eval", path("turns.mien"), "--input", path("poses.json"), "-o", path("turns.npy"))
        again, _ = self.solved(path("turns.npy"), "--kind", "joints", rig="turns.mien")
        self.compare(again[0], pose, 0.01, report["unobservable"])
        # One joint that no control brings where it should be.
        values[3 * 9 + 1] += 0.5
        rows, report = self.solved(write("off.npy", npy((1, count // 9, 9), values)), "--kind", "joints", rig=SMALL)
        self.worst_first(report["by_joint"], report)
        self.assertEqual(report["by_joint"][0]["name"], self.names(SMALL, "joints")[3])
        self.assertLessEqual(len(report["by_joint"]), count // 9)

    def test_jumps(self):
        """A frame that has only the brows, while --sparse draws the jaw, which has no target there, to rest."""
        mesh, points = self.obj(POSE)
        flat = [x for point in points for x in point]
        above = sorted(p[1] for p in points)[len(points) * 9 // 10]
        brows = [x if points[i // 3][1] > above else math.nan for i, x in enumerate(flat)]
        write("brows.npy", npy((3, len(points), 3), flat + flat + brows))
        arguments = path("brows.npy"), "--mesh", mesh
        rows, report = self.solved(*arguments)
        self.assertEqual(report["jumped"], [])
        self.assertAlmostEqual(rows[2]["jawOpen"], POSE["jawOpen"], delta=0.01)
        rows, report = self.solved(*arguments, "--sparse", "1e-3")
        self.assertLess(rows[2]["jawOpen"], 0.2)
        self.assertEqual(report["jumped"], [2])
        self.assertEqual([frame["jumped"] for frame in report["by_frame"]], [False, False, True])
        notes = self.notes(*arguments, "--sparse", "1e-3")
        self.assertTrue(notes[0].endswith("1 of 3 frames moved farther than their targets ask for: 2"), notes)

    def test_what_is_left_of_regions_and_landmarks(self):
        mesh, points = self.obj({})
        rest = [x for point in points for x in point]
        wrong = rest[:]
        wrong[3 * 100 + 2] += 2.0  # cm: the only vertex that is off
        write("wrong.npy", npy((2, len(points), 3), rest + wrong))
        for options in ((), ("--rigid",)):
            _, report = self.solved(path("wrong.npy"), "--mesh", mesh, *options)
            regions = report["by_region"]
            self.worst_first(regions, report)
            self.assertGreater(regions[0]["worst"], 10 * regions[1]["worst"])
            self.assertEqual(regions[0]["worst_frame"], 1)
            self.assertIn(regions[0]["name"], self.names(HEAD, "joints"))
        mask = write("mask.json", json.dumps({"positions": [[101, len(points) - 1]]}))
        _, report = self.solved(path("wrong.npy"), "--mesh", mesh, "--mask", mask)
        self.assertLess(report["by_region"][0]["worst"], 0.01)
        numbers = list(range(0, len(points), 40))
        write("marks.csv", "time," + ",".join(f"p{i}.{k}" for i in numbers for k in "xyz") + "\n0," +
              ",".join("%.6f" % (x + (3 if i == numbers[7] else 0)) for i in numbers for x in points[i]) + "\n")
        places = write("points.json", json.dumps({"mesh": mesh, "points": {f"p{i}": i for i in numbers}}))
        _, report = self.solved(path("marks.csv"), "--landmarks", places, "--robust", "0.1")
        self.assertEqual(len(report["by_landmark"]), len(numbers))
        self.worst_first(report["by_landmark"], report)
        self.assertEqual(report["by_landmark"][0]["name"], f"p{numbers[7]}")


class Mixes(SolveTest):
    """Several targets in one run."""

    def setUp(self):
        self.poses = motion(4)
        self.mesh, self.rest = self.obj({})
        self.frames = [self.obj(pose)[1] for pose in self.poses]

    def landmarks(self, chosen, name="marks.csv", off=0.0, missing=()):
        """A CSV of vertices, named by their numbers."""
        lines = ["time," + ",".join(f"{p}.{axis}" for p in chosen for axis in "xyz")]
        for f, points in enumerate(self.frames):
            cells = ["" if f in missing else "%.6f" % (v + off) for p in chosen for v in points[p]]
            lines.append("%.6f,%s" % (f / 30, ",".join(cells)))
        write(name, "\n".join(lines) + "\n")
        return path(name)

    def solve(self, *targets, rig=HEAD):
        self.ok("solve", path(rig), *targets, "-o", path("mix.json"), "--report", path("mix-report.json"))
        with open(path("mix.json"), encoding="utf-8") as file:
            take = json.load(file)
        with open(path("mix-report.json"), encoding="utf-8") as file:
            report = json.load(file)
        return take, report

    def value(self, take, frame, control):
        return take["frames"][frame]["raw"][take["controls"].index(control)]

    def test_joints_and_landmarks(self):
        joints = self.joints(HEAD, self.poses)
        marks = self.landmarks(range(0, len(self.rest), 97))
        take, report = self.solve("joints:" + joints, "landmarks3:" + marks, "--weights", "1,0.1")
        self.assertEqual(list(report["by_kind"]), ["joints", "points"])
        for kind in report["by_kind"].values():
            self.assertLess(kind["rms"], 1e-2)
            self.assertLessEqual(kind["rms"], kind["worst"])
        self.assertEqual(report["residual"]["rms"], report["by_kind"]["joints"]["rms"])
        self.assertTrue(report["by_joint"])
        for f, pose in enumerate(self.poses):
            for control, value in pose.items():
                self.assertAlmostEqual(self.value(take, f, control), value, delta=0.02)
        # Landmarks that are elsewhere draw as much as they count.
        apart = self.landmarks(range(0, len(self.rest), 97), "apart.csv", off=0.3)
        left = []
        for weight in ("1000", "1", "0.0001"):
            kinds = self.solve("joints:" + joints, apart, "--weights", "1," + weight)[1]["by_kind"]
            left.append((kinds["points"]["rms"], -kinds["joints"]["rms"]))
        self.assertEqual(left, sorted(left))
        self.assertLess(left[0], left[2])

    def test_vertices_and_missing_landmarks(self):
        numbers = [v for points in self.frames for p in points for v in p]
        write("half.npy", npy((4, len(self.rest), 3), numbers))
        marks = self.landmarks((10, 500, 4000), missing=(1, 2))
        take, report = self.solve(path("half.npy"), marks)
        self.assertEqual(list(report["by_kind"]), ["points"])
        self.assertLess(report["by_kind"]["points"]["worst"], 0.01)
        self.assertTrue(report["by_region"])
        self.assertAlmostEqual(self.value(take, 3, "jawOpen"), self.poses[3]["jawOpen"], delta=0.02)

    def test_a_surface_that_landmarks_bring_near(self):
        turned = []
        for points in self.frames[3:]:
            turned.append([[-x + 30, y - 12, -z] for x, y, z in points])  # half a turn
        self.frames = turned
        self.ok("export", path(HEAD), "-o", path("scan.obj"), "--lod", "0",
                *(word for control, value in self.poses[3].items() for word in ("--set", f"{control}={value}")))
        scan = []
        with open(path("scan.obj"), encoding="utf-8") as file:
            lines = file.read().splitlines()
        begun = count = 0
        for line in lines[1:]:  # without what says meters
            begun += line.startswith("o ")
            if begun != 1:
                continue
            if line.startswith("v "):
                line = "v %.6f %.6f %.6f" % tuple(turned[0][count])
                count += 1
            scan.append(line)
        write("turned.obj", "\n".join(scan) + "\n")
        marks = self.landmarks(range(100, len(self.rest), 700))
        take, report = self.solve("surface:" + path("turned.obj"), marks, "--rigid", "--sparse", "0.0001")
        self.assertEqual(list(report["by_kind"]), ["points", "surface"])
        self.assertLess(report["by_kind"]["points"]["rms"], 0.05)
        self.assertLess(report["by_kind"]["surface"]["rms"], 0.05)
        self.assertAlmostEqual(report["by_frame"][0]["rotation"][0], -1, delta=0.01)
        self.assertAlmostEqual(self.value(take, 0, "jawOpen"), self.poses[3]["jawOpen"], delta=0.1)

    def test_landmarks_on_several_meshes(self):
        eye = "eyeLeft_lod0_mesh"
        pose = {"jawOpen": 0.4, "eyeLookOutLeft": 0.6}
        self.ok("export", path(HEAD), "-o", path("eyes.obj"), "--lod", "0",
                *(word for control, value in pose.items() for word in ("--set", f"{control}={value}")))
        meshes, name = {}, None
        with open(path("eyes.obj"), encoding="utf-8") as file:
            for line in file:
                if line.startswith("o "):
                    name = line[2:].strip()
                    meshes[name] = []
                elif line.startswith("v "):
                    meshes[name].append([100 * float(v) for v in line.split()[1:4]])
        points = {f"skin{p}": p for p in range(0, len(self.rest), 331)}
        iris = range(0, len(meshes[eye]), len(meshes[eye]) // 8)
        points.update({f"eye{p}": {"mesh": eye, "positions": [p, p, p], "weights": [1, 0, 0]} for p in iris})
        places = write("eyes.points.json", json.dumps({"mesh": self.mesh, "points": points}))
        names = sorted(points)  # those on the eye come first
        cells = [v for n in names for v in meshes[eye if n.startswith("eye") else self.mesh][
            int(n.replace("eye", "").replace("skin", ""))]]
        marks = write("eyes.csv", "time," + ",".join(f"{n}.{axis}" for n in names for axis in "xyz") + "\n0," +
                      ",".join("%.6f" % v for v in cells) + "\n")
        take, report = self.solve(marks, "--landmarks", places, "--pictures", path("eyes"))
        for control, value in pose.items():
            self.assertAlmostEqual(self.value(take, 0, control), value, delta=0.03)
        self.assertLess(report["residual"]["worst"], 0.01)
        self.assertEqual({datum["name"] for datum in report["by_landmark"]}, set(names))
        self.assertLess(max(datum["worst"] for datum in report["by_landmark"]), 0.01)
        for wrong, says in (('{"mesh": 1, "positions": [0, 0, 0], "weights": [1, 0, 0]}', "no name"),
                            ('{"mesh": "nobody", "positions": [0, 0, 0], "weights": [1, 0, 0]}', "nobody"),
                            ('{"mesh": "%s", "positions": [0, 0, 19000], "weights": [1, 0, 0]}' % eye, "19000")):
            write("wrong.points.json", '{"points": {"a": %s}}' % wrong)
            write("a.csv", "time,a.x,a.y,a.z\n0,1,2,3\n")
            self.fails(INVALID, "solve", path(HEAD), path("a.csv"), "--landmarks", path("wrong.points.json"),
                       "-o", path("no.json"), says=says)

    def test_wrong_mixes(self):
        joints = self.joints(HEAD, self.poses)
        marks = self.landmarks((1, 2, 3))
        write("images.csv", "time,1.x,1.y\n0,1,2\n")
        out = ("-o", path("mix.json"))
        for words, why in (
                (("joints:" + joints, marks), "joint values, lengths and pixels"),
                (("joints:" + joints, "joints:" + joints), "two of them are joints"),
                (("joints:" + joints, marks, "--weights", "1"), "there are 2 targets"),
                (("joints:" + joints, marks, "--weights", "1,0"), "would not count"),
                (("joints:" + joints, marks, "--weights", "1,x"), "not a number"),
                ((marks, "--weights", "1"), "there is one target"),
                ((marks, marks, "--neutral", "1", "--rigid"), "measured with one target"),
                ((marks, "landmarks2:" + path("images.csv"), "--weights", "1,1", "--rigid"), "first TARGET"),
                (("landmarks3:" + marks, "--kind", "vertices"), "--kind says vertices")):
            self.fails(USAGE, "solve", path(HEAD), *words, *out, says=why)
        write("short.csv", "time,1.x,1.y,1.z\n0,1,2,3\n")
        self.fails(INVALID, "solve", path(HEAD), marks, path("short.csv"), *out, says="it has 1 frames")


class Options(SolveTest):
    def test_keys_are_within_their_tolerance(self):
        poses = motion(24)
        write("take.json", json.dumps({"rate": 30, "frames": [{"raw": pose} for pose in poses]}))
        from_head = path("take.json"), "--from", path(HEAD)
        reduced, report = self.solved(*from_head, "--keys", "0.02")
        document = json.loads(read("out.json"))
        self.assertEqual(sum(map(len, document["keys"].values())), report["keys"])
        self.assertLess(report["keys"], len(poses) * len(reduced[0]) / 4)
        for pose, row in zip(poses, reduced):
            self.compare(row, pose, 0.02 + 0.005)  # and the solve is not exact
        jaw = next(keys for name, keys in document["keys"].items() if name.endswith("jawOpen"))
        self.assertEqual([jaw[0], jaw[-1]], [0, 23])
        # What it writes is what other commands take.
        self.ok("eval", path(HEAD), "--input", path("out.json"), "-o", path("eval.json"))
        self.ok("solve", path(HEAD), *from_head, "--keys", "0.02", "-o", path("out.clip"), "-q")
        self.ok("clip", "export", path("out.clip"), "-o", path("back.json"))
        frames = json.loads(read("back.json"))["frames"]
        self.assertEqual(len(frames), 24)
        self.assertAlmostEqual(next(v for name, v in frames[7]["raw"].items() if name.endswith("jawOpen")),
                               reduced[7]["jawOpen"], delta=1e-6)

    def test_only_some_controls_move(self):
        mesh, points = self.obj(POSE)
        write("one.npy", npy((len(points), 3), [x for point in points for x in point]))
        rows, _ = self.solved(path("one.npy"), "--mesh", mesh, "--controls", "jaw*,browInnerUp")
        moved = {name for name, value in rows[0].items() if value != 0}
        self.assertTrue({"jawOpen", "browInnerUp"} <= moved, moved)
        self.assertTrue(all(name.startswith(("jaw", "browInnerUp")) for name in moved), moved)
        again, _ = self.solved(path("one.npy"), "--mesh", mesh, "--controls", "browInnerUp,jawOpen,jaw*")
        self.assertEqual(again, rows, "the order of the list does not count")
        self.fails(INVALID, "solve", path(HEAD), path("one.npy"), "-o", path("no.json"),
                   "--controls", "jawOpen,nothing", says="nothing")

    def test_sparse_and_smooth_solves_move_less(self):
        poses = motion(6)
        write("take.json", frames_of(poses))
        from_head = path("take.json"), "--from", path(HEAD)
        rows, _ = self.solved(*from_head)
        sparse, _ = self.solved(*from_head, "--sparse", "0.01")
        self.assertLess(sum(sparse[3].values()), sum(rows[3].values()))
        smooth, _ = self.solved(*from_head, "--smooth", "1")
        travel = [sum(abs(b["jawOpen"] - a["jawOpen"]) for a, b in zip(take, take[1:])) for take in (rows, smooth)]
        self.assertLess(travel[1], 0.8 * travel[0])

    def test_the_first_controls_explain_what_they_can(self):
        """With few data, several controls would do: those of --first take it all, from joints, vertices and landmarks
        alike."""
        mesh, points = self.obj({"jawOpen": 0.5})
        rest = self.obj({})[1]
        chin = max(range(len(points)), key=lambda i: math.dist(points[i], rest[i]))
        write("one.npy", npy((len(points), 3), [x for point in points for x in point]))
        write("mask.json", json.dumps({"positions": [chin]}))
        write("marks.csv", "time,chin.x,chin.y,chin.z\n0,%.6f,%.6f,%.6f\n" % tuple(points[chin]))
        write("points.json", json.dumps({"mesh": mesh, "points": {"chin": chin}}))
        raw = [name.rpartition(".")[2] for name in self.names(SMALL, "raw")]
        joints = self.joints(SMALL, [{raw[0]: 0.5}])
        write("joint.json", json.dumps({"names": {self.names(SMALL, "joints")[21]: 1}}))
        for first, rig, target in (
                ("jawOpen", HEAD, [path("one.npy"), "--mesh", mesh, "--mask", path("mask.json")]),
                ("jawOpen", HEAD, [path("marks.csv"), "--landmarks", path("points.json")]),
                (raw[0], SMALL, [joints, "--kind", "joints", "--mask", path("joint.json")])):
            with self.subTest(target[1:]):
                rows, report = self.solved(*target, rig=rig)
                staged, of_staged = self.solved(*target, "--first", first, rig=rig)
                others = [sum(abs(v) for name, v in row.items() if name != first) for row in (rows[0], staged[0])]
                self.assertAlmostEqual(staged[0][first], 0.5, delta=0.02)
                self.assertLess(others[1], 0.05)
                self.assertGreater(others[0], 4 * others[1] + 0.05, "without it, others take a share")
                for one in (report, of_staged):
                    self.assertLess(one["residual"]["worst"], 0.01)
                self.fails(INVALID, "solve", path(rig), *target, "-o", path("no.json"), "--first", "jaw*,nobody",
                           says="nobody")

    def test_images(self):
        write("take.json", frames_of([POSE]))
        self.ok("solve", path(HEAD), path("take.json"), "--from", path(HEAD), "-o", path("out.json"),
                "--pictures", path("images"), "-q")
        self.addCleanup(shutil.rmtree, path("images"))
        self.assertEqual(os.listdir(path("images")), ["solve.png"])
        image = Picture(read(os.path.join("images", "solve.png")))
        self.assertGreater(image.width, 3 * 320)
        self.assertGreater(image.height, 360)
        joints = self.joints(TINY, [{}])
        self.ok("solve", path(TINY), joints, "--kind", "joints", "-o", path("out.json"), "--pictures",
                path("images"), "-q")

    def test_results_repeat(self):
        write("take.json", frames_of(motion(4)))
        outputs = []
        for name in ("first.clip", "second.clip"):
            self.ok("solve", path(HEAD), path("take.json"), "--from", path(HEAD), "-o", path(name), "-q")
            outputs.append(read(name))
        self.assertEqual(*outputs)

    def test_interrupts_leave_nothing(self):
        pipe = path("pipe.json")
        os.mkfifo(pipe)
        self.addCleanup(os.remove, pipe)
        before = sorted(os.listdir(program.folder))
        process = subprocess.Popen([program.mien, "solve", path(HEAD), pipe, "--from", path(HEAD), "-o",
                                    path("no.clip"), "--report", path("no.json"), "--pictures", path("none")])
        with open(pipe, "wb"):  # once it reads
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(60), 130)
        self.assertEqual(sorted(os.listdir(program.folder)), before)


class Refusals(SolveTest):
    def refuse(self, target, says, *options, code=INVALID, rig=TINY):
        self.fails(code, "solve", path(rig), target, "-o", path("no.json"), "-q", *options, says=says)

    def run_quietly(self, target):
        """Ends with a result or a message, whatever the bytes."""
        done = program.run("solve", path(TINY), target, "--kind", "joints", "-o", path("any.json"), "--force", "-q")
        self.assertIn(done.returncode, (0, INVALID), done.stderr)

    def test_arrays_of_wrong_shapes_and_numbers(self):
        self.joints(TINY, [{}, {}])
        count = len(self.names(TINY, "joints"))
        for shape, says in (((2, count + 1, 9), f"2 x {count + 1} x 9"), ((0, count, 9), "no frames"),
                            ((2, count, 10), "x 10"), ((9,), "its shape is 9"), ((), "one number")):
            numbers = [0.0] * math.prod(shape)
            self.refuse(write("wrong.npy", npy(shape, numbers)), says, "--kind", "joints")
        for value in (math.inf, -math.inf):
            self.refuse(write("wrong.npy", npy((1, count, 9), [value] + [math.nan] * (9 * count - 1))),
                        ("number 0 is not finite", "NaN where one is missing"), "--kind", "joints")
        self.refuse(write("good.npy", npy((1, count, 9), [0.0] * 9 * count)), "not finite", "--kind", "joints",
                    "--mask", write("mask.npy", npy((count,), [math.nan] * count)))
        good = npy((1, count, 9), [0.0] * 9 * count)
        for end in (0, 5, 11, 60, len(good) - 1):
            self.refuse(write("wrong.npy", good[:end]), "NPY", "--kind", "joints")
        self.refuse(write("wrong.npy", npy((1, 5, 3), [0.0] * 15)), "x 3")

        def zipped(names, compression=zipfile.ZIP_STORED):
            with zipfile.ZipFile(path("wrong.npz"), "w", compression) as file:
                for name in names:
                    file.writestr(name, good)
            return read("wrong.npz")
        whole = zipped(["a.npy"])
        self.assertEqual(self.solved(path("wrong.npz"), "--kind", "joints", rig=TINY)[1]["frames"], 1)
        for bytes_, says in ((zipped([]), "NPY"), (zipped(["a.npy", "b.npy"]), "2 arrays"),
                             (zipped(["a.npy"], zipfile.ZIP_BZIP2), "another way"), (whole[:-30], "missing"),
                             (whole[:100] + whole[-60:], "NPZ"), (whole[:50] + whole[60:], "NPZ")):
            self.refuse(write("wrong.npz", bytes_), says, "--kind", "joints")
        for at in range(len(whole) - 73, len(whole), 3):  # the list of members
            damaged = bytearray(whole)
            damaged[at] ^= 0xFF
            self.run_quietly(write("wrong.npz", bytes(damaged)))
        self.refuse(path("none.npy"), "none.npy", "--kind", "joints", code=FILE)

    def test_compressed_arrays(self):
        poses = [{name.rpartition(".")[2]: 0.3} for name in self.names(TINY, "raw")[:3]]
        array = read(os.path.basename(self.joints(TINY, poses)))

        def packed(content, file="packed.npz", **changes):
            """A file of numpy.savez_compressed(), with other numbers in its list."""
            with zipfile.ZipFile(path(file), "w", zipfile.ZIP_DEFLATED) as made:
                with made.open("arr_0.npy", "w", force_zip64=True) as member:
                    member.write(content)
            bytes_ = bytearray(read(file))
            entry = bytes_.find(b"PK\1\2")
            for name, value in changes.items():
                at, kind = {"flags": (8, "<H"), "method": (10, "<H"), "checksum": (16, "<I"), "packed": (20, "<I"),
                            "size": (24, "<I")}[name]
                struct.pack_into(kind, bytes_, entry + at, value)
            return bytes(bytes_)
        expected, _ = self.solved(write("plain.npy", array), "--kind", "joints", rig=TINY)
        whole = packed(array)
        self.assertLess(len(whole), len(array) / 2)
        self.assertEqual(self.solved(write("whole.npz", whole), "--kind", "joints", rig=TINY)[0], expected)
        try:
            import numpy
            numpy.savez_compressed(path("numpy.npz"), numpy.load(path("plain.npy")))
            self.assertEqual(self.solved(path("numpy.npz"), "--kind", "joints", rig=TINY)[0], expected)
        except ImportError:
            print("NOT TESTED: files of numpy.savez_compressed() itself; there is no numpy")
        size = len(array)
        data = whole.find(b"arr_0.npy") + 9 + 20 + 40  # in the compressed bytes
        for bytes_, says in ((packed(array, size=size - 1), "size"), (packed(array, size=size + 1), "size"),
                             (packed(array, size=2**32 - 1), "4 GiB"), (packed(array, size=2**32 - 2), "200 times"),
                             (packed(array, checksum=1), "checksum"), (packed(array, flags=1), "encrypted"),
                             (packed(array, packed=9), "damaged"), (packed(array, packed=2**31), "cut off"),
                             (packed(array, method=0), "damaged"), (packed(array, method=12), "another way"),
                             (packed(b""), "NPY"), (packed(array[:-4]), "size of the shape"),
                             (whole[:data] + bytes(30) + whole[data + 30:], "NPZ")):
            self.refuse(write("wrong.npz", bytes_), says, "--kind", "joints")
        for at in range(0, len(whole), max(1, len(whole) // 40)):
            damaged = bytearray(whole)
            damaged[at] ^= 0x10
            self.run_quietly(write("wrong.npz", bytes(damaged)))
        # A thousandth of what it would take.
        bomb = write("bomb.npz", packed(npy((1, 2**24, 1), [])[:128] + bytes(2**26)))
        self.assertLess(os.path.getsize(bomb), 2**17)
        self.refuse(bomb, "200 times", "--kind", "joints")
        arguments = "solve", path(TINY), "-o", path("any.json"), "--force", "--kind", "joints", "-q"
        peaks = [program.cost(*arguments, target, runs=1)[1] for target in (path("whole.npz"), bomb)]
        self.assertLess(peaks[1], peaks[0] + 2**23)

    def test_meshes_that_do_not_fit(self):
        self.refuse(write("wrong.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "3 positions", rig=HEAD)
        os.makedirs(path("empty"), exist_ok=True)
        self.addCleanup(os.rmdir, path("empty"))
        self.refuse(path("empty"), "no .obj", rig=HEAD)
        self.refuse(write("wrong.obj", "v nan 0 0\n"), "line 1", rig=HEAD)
        self.refuse(write("wrong.glb", b"glTF" + bytes(40)), "wrong.glb", rig=HEAD)
        self.refuse(path("wrong.obj"), "no mesh is named", "--mesh", "nose", rig=HEAD)

    def test_targets_of_another_size_or_with_other_axes(self):
        mesh, points = self.obj(POSE)

        def scaled(by):
            return write("size.npy", npy((1, len(points), 3), [by * x for point in points for x in point]))
        for by, unit in ((0.01, "m"), (10, "mm"), (0.1, "dm")):
            self.refuse(scaled(by), f"--unit {unit}", "--mesh", mesh, rig=HEAD)
        self.refuse(scaled(0), "those of mesh " + mesh, "--mesh", mesh, rig=HEAD)
        self.refuse(scaled(1000), "scale it to the rig", "--mesh", mesh, rig=HEAD)
        for by in (0.25, 4):  # another person, or a cartoon
            self.ok("solve", path(HEAD), scaled(by), "-o", path("any.json"), "--force", "-q", "--mesh", mesh)
        # Some wrong points change no size.
        wild = [1e6 if i % 20 == 0 else x for i, point in enumerate(points) for x in point]
        self.ok("solve", path(HEAD), write("wild.npy", npy((1, len(points), 3), wild)), "-o", path("any.json"), "--force",
                "-q", "--mesh", mesh, "--robust", "0.5")
        self.ok("export", path(HEAD), "-o", path("own.obj"), "--lod", "0")
        bare = write("bare.obj", read("own.obj").partition(b"\n")[2])
        for options in ((), ("--rigid",)):
            self.refuse(bare, "--unit m", "--kind", "surface", *options, rig=HEAD)
        # A frame among others.
        two = [x for by in (1, 0.01) for point in points for x in (by * point[0], by * point[1], by * point[2])]
        self.refuse(write("two.npy", npy((2, len(points), 3), two)), "frame 2", "--mesh", mesh, rig=HEAD)
        turned = [x for point in points for x in (point[0], point[2], -point[1])]
        turned = write("turned.npy", npy((1, len(points), 3), turned))
        self.refuse(turned, "x, z, -y of the rig", "--mesh", mesh, rig=HEAD)
        rows, report = self.solved(turned, "--mesh", mesh, "--rigid")
        self.compare(rows[0], POSE, 0.01, report["unobservable"])
        mirrored = [x for point in points for x in (-point[0], point[1], point[2])]
        self.refuse(write("turned.npy", npy((1, len(points), 3), mirrored)), "-x, y, z of the rig", "--mesh", mesh,
                    rig=HEAD)

    def test_controls_that_do_not_fit(self):
        self.refuse(write("take.json", '{"frames": []}'), "no frames", "--from", path(HEAD), rig=HEAD)
        self.refuse(write("take.json", frames_of([{"nothing": 1}])), "nothing", "--from", path(HEAD), rig=HEAD)
        self.refuse(write("take.json", '{"frames": [{"raw": [NaN]}]}'), "take.json", "--from", path(HEAD), rig=HEAD)
        self.refuse(write("take.json", frames_of([{}])), "topology", "--from", path(TINY), rig=HEAD)
        self.refuse(write("take.clip", b"clip"), "take.clip", "--from", path(HEAD), rig=HEAD)

    def test_landmarks_that_do_not_fit(self):
        def refuse(table, places, says):
            options = ["--landmarks", write("wrong.points.json", places)] if places else []
            self.refuse(write("wrong.csv", table), says, *options, rig=HEAD)
        good = "time,a.x,a.y,a.z\n0,1,2,3\n"
        refuse("", "", "empty")
        refuse("time\n0\n", "", "no landmarks")
        refuse("time,a.x,a.y,a.z\n0,1,2,nan\n", '{"points": {"a": 0}}', "nan")
        refuse("time,a.x,a.z,a.y\n0,1,2,3\n", '{"points": {"a": 0}}', "column 3")
        refuse("time,a.x,a.y,a.z,b.x\n0,1,2,3,4\n", '{"points": {"a": 0, "b": 1}}', "b.y")
        refuse(good, "", "--landmarks")
        refuse(good, '{"points": {"b": 0}}', "no point is named")
        refuse(good, '{"points": {"a": 999999999}}', "999999999")
        refuse(good, '{"points": {"a": -1}}', "whole number")
        refuse(good, '{"points": {"a": {"positions": [1, 2]}}}', "three")
        refuse(good, '{"points": {"a": {"positions": [1, 2, 3], "weights": [1, 0, "x"]}}}', "weights")
        refuse(good, '{"points": {"a": 0}, "camera": {"focal": [0, 1], "center": [0, 0]}}', "focal")
        refuse(good, '{"point": {"a": 0}}', "points")
        refuse(good, '{"points": ', "byte")
        refuse("time,999999999.x,999999999.y,999999999.z\n0,1,2,3\n", "", "999999999")

    def test_wrong_usage(self):
        take = write("take.json", frames_of([{}]))
        self.refuse(take, "--from", code=USAGE)
        self.refuse(take, "--from", "--kind", "weights", code=USAGE)
        self.refuse(take, "--kind", "--kind", "vertex", code=USAGE)
        self.refuse(write("a.npy", b""), "--from", "--kind", "joints", "--from", path(TINY), code=USAGE)
        self.refuse(take, "--keys", "--from", path(TINY), "--keys", "-1", code=USAGE)
        self.refuse(take, "--smooth", "--from", path(TINY), "--smooth", "nan", code=USAGE)
        self.refuse(take, "--rate", "--from", path(TINY), "--rate", "0", code=USAGE)
        self.refuse(take, "--rigid", "--kind", "joints", "--rigid", code=USAGE)
        self.refuse(take, "--focal", "--from", path(TINY), "--focal", code=USAGE)
        self.refuse(take, "--reach", "--from", path(TINY), "--reach", "1", code=USAGE)
        self.refuse(take, "--robust", "--kind", "joints", "--robust", "1", code=USAGE)
        self.refuse(take, "--landmarks", "--from", path(TINY), "--landmarks", take, code=USAGE)
        self.fails(USAGE, "solve", path(TINY), take, "--from", path(TINY), "-o", path("no.glb"), says=".clip")
        self.fails(FILE, "solve", path(TINY), take, "--from", path(TINY), "-o", path("none/no.json"), says="none")
        self.fails(INVALID, "solve", take, take, "--from", path(TINY), "-o", path("no.json"), says="take.json")


if __name__ == "__main__":
    main()
