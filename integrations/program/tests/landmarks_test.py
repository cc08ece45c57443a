#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien play --live landmarks3://` and `landmarks2://`: landmarks of a known motion, sent as packets, give its controls
and its surface, also of another person, whose face is at rest at first; faces that are lost, packets that are damaged or of another size, and clear refusals.

    landmarks_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)
"""
import json
import math
import os
import random
import sys
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(HERE, "..", "..", "..", "tests", "support")]
from live_test import Listener, by_the_clock, curve  # noqa: E402
from program import FILE, INVALID, USAGE, ProgramTest, main, make, make_folder, path, read, write  # noqa: E402

HEAD = "head.dna"
POSES = [{"jawOpen": 0.6}, {"mouthSmileLeft": 0.8, "mouthSmileRight": 0.8, "jawOpen": 0.2},
         {"browInnerUp": 0.9, "jawOpen": 0.3}]
SIZE, AWAY = (1280, 720), 60.0  # of the picture; cm from the camera
# Machines that are busy must not run out of it.
PATIENT = "--solve-time", "0.5"


def setUpModule():
    make_folder()
    make("demo-head", "-o", path("whole.dna"))
    make("convert", path("whole.dna"), "--lods", "0", "-o", path(HEAD))
    write("empty.json", "{}")


def skin(pose, head=HEAD, made={}):
    """Positions of the first mesh in a pose, in the unit of the rig."""
    key = head + json.dumps(pose, sort_keys=True)
    if key not in made:
        sets = [word for control, value in pose.items() for word in ("--set", f"{control}={value}")]
        make("export", path(head), "-o", path("posed.obj"), "--lod", "0", "--force", *sets)
        text = read("posed.obj").decode().split("\no ")[1]
        made[key] = [[100 * float(x) for x in line.split()[1:4]] for line in text.splitlines() if line.startswith("v ")]
    return made[key]


def mean_distance(a, b):
    return sum(map(math.dist, a, b)) / len(a)


def turned(p, angle):
    """By an angle about the vertical axis."""
    c, s = math.cos(angle), math.sin(angle)
    return [c * p[0] + s * p[2], p[1], c * p[2] - s * p[0]]


def seen(p):
    """In shares of the picture: x to the right, y down."""
    x, y = (SIZE[0] * p[0] / (AWAY - p[2]) + SIZE[0] / 2, SIZE[1] / 2 - SIZE[0] * (p[1] - 2) / (AWAY - p[2]))
    return [x / SIZE[0], y / SIZE[1]]


class Landmarks(ProgramTest):
    numbers = None

    def places(self, name="points.json", **more):
        """Every 150th position, named by its order."""
        type(self).numbers = range(0, len(skin({})), 150)
        points = {str(i): n for i, n in enumerate(self.numbers)}
        return write(name, json.dumps({"points": points, **more}))

    def marks(self, pose, angle=0.0, see=lambda p: p, head=HEAD):
        points = skin(pose, head)
        return [[round(x, 4) for x in see(turned(points[n], angle))] for n in self.numbers]

    def frames(self, played):
        names = [name.rpartition(".")[2] for name in played["controls"]]
        return [dict(zip(names, frame["raw"])) for frame in played["frames"]]

    def assert_shows(self, played, poses, within, surface):
        """One pose after the other, by some frame each: its controls, and where they move the skin."""
        frames, begin = self.frames(played), 0
        for pose in poses:
            def distance(f):
                return max(abs(value - pose.get(name, 0)) for name, value in frames[f].items()
                           if name in pose or name in ("jawOpen", "browInnerUp"))
            best = min(range(begin, len(frames)), key=distance)
            self.assertLess(distance(best), within, pose)
            found = {name: value for name, value in frames[best].items() if value > 0.001}
            self.assertLess(mean_distance(skin(found), skin(pose)), surface, pose)
            begin = best + 1

    def play(self, scheme, poses, packet, *options, hold=18):
        """Each pose for some packets at 60 per second, while the head turns."""
        listener = Listener(scheme, "--landmarks", path("points.json"), "--seconds", str(len(poses) * hold / 60 + 1.2),
                            *options, rig=HEAD)
        k = 0
        for pose in poses:
            for _ in range(hold):
                listener.until(k / 60)
                listener.send(packet(k, pose).encode())
                k += 1
        return listener.finish()

    @by_the_clock
    def test_in_space(self):
        """With noise, and a tenth missing."""
        self.places()
        noise = random.Random(3)

        def packet(k, pose):
            marks = [[round(x + noise.gauss(0, 0.02), 4) for x in p] for p in self.marks(pose, 0.3 * math.sin(k / 20))]
            for i in range(k % 10, len(marks), 10):
                marks[i] = noise.choice([None, [math.nan, 1, 2], {"x": 1, "y": 2, "z": math.nan}])
            return json.dumps({"time": 1000 + k / 60, "landmarks": marks})
        played, said = self.play("landmarks3", POSES, packet, *PATIENT)
        self.assert_shows(played, POSES, 0.05, 0.05)
        self.assertIn("of CPU time each", said)
        self.assertNotIn("damaged", said)

    @by_the_clock
    def test_in_pictures(self):
        """By the camera of the file; and with the size of the picture alone."""
        turn = {"rotation": [1, 0, 0, 0, -1, 0, 0, 0, -1], "translation": [0, 2, AWAY]}
        known = {"focal": [SIZE[0]] * 2, "center": [SIZE[0] / 2, SIZE[1] / 2], **turn}
        for camera, sized in (({"camera": known}, False), ({}, True)):
            with self.subTest(sized=sized):
                self.places(**camera)

                def packet(k, pose):
                    marks = self.marks(pose, 0.15 * math.sin(k / 20), seen)
                    if sized:
                        return json.dumps({"size": SIZE, "landmarks": [dict(zip("xyz", (*p, 0))) for p in marks]})
                    return json.dumps([[p[0] * SIZE[0], p[1] * SIZE[1]] for p in marks])
                played, said = self.play("landmarks2", POSES[:2], packet, "--sparse", "0.01", *PATIENT)
                self.assert_shows(played, POSES[:2], 0.1, 0.1)
                self.assertNotIn("damaged", said)

    def another_person(self):
        if not os.path.exists(path("other.dna")):
            make("demo-head", "--seed", "7", "-o", path("person.dna"))
            make("convert", path("person.dna"), "--lods", "0", "-o", path("other.dna"))
        return "other.dna"

    def table(self, name, poses, see=lambda p: p, axes="xyz", scale=1.0):
        """CSV of another person's landmarks, while the head turns."""
        other = self.another_person()
        self.places(camera={"focal": [SIZE[0]] * 2, "center": [SIZE[0] / 2, SIZE[1] / 2]})
        lines = ["time," + ",".join(f"{i}.{axis}" for i in range(len(self.numbers)) for axis in axes)]
        for k, pose in enumerate(poses):
            marks = self.marks(pose, 0.2 * math.sin(k / 3), see, other)
            lines.append(",".join(f"{x:.6f}" for x in (k / 60, *(scale * x for p in marks for x in p))))
        return write(name, "\n".join(lines) + "\n")

    def solved(self, table, *options):
        """Controls of each frame, and the residual."""
        make("solve", path(HEAD), table, "--landmarks", path("points.json"), "--rigid", "-o", path("solved.json"),
             "--report", path("report.json"), "--force", *options)
        return self.frames(json.loads(read("solved.json"))), json.loads(read("report.json"))["residual"]["rms"]

    def error(self, frames, poses):
        """Root mean square over all controls of the rig."""
        names = list(frames[0])
        squares = [(frame[name] - pose.get(name, 0)) ** 2 for frame, pose in zip(frames, poses) for name in names]
        return math.sqrt(sum(squares) / len(squares))

    def test_another_person_offline(self):
        """Controls of a known motion; in meters, too, since the size is found; by first frames and by a file."""
        poses = [{}, {}, *POSES]

        def pixels(p):
            return [x * size for x, size in zip(seen(p), SIZE)]
        for see, axes, scale, sparse in ((lambda p: p, "xyz", 0.01, "0.002"), (pixels, "xy", 1.0, "0.1")):
            with self.subTest(axes=axes):
                table = self.table("face.csv", poses, see, axes, scale)
                neutral = self.table("neutral.csv", [{}, {}, {}], see, axes, scale)
                # What would be without: in the unit of the rig.
                plain = self.table("plain.csv", poses, see, axes, 1.0)
                frames, residual = self.solved(plain, "--sparse", sparse)
                before = self.error(frames[2:], POSES)
                for option in "2", neutral:
                    frames, known = self.solved(table, "--sparse", sparse, "--neutral", option)
                    self.assertLess(self.error(frames[2:], POSES), before / 1.5, option)
                    self.assertLess(self.error(frames[2:], POSES), 0.08, option)
                    self.assertLess(known, residual / 2, option)
                    self.assertLess(max(frames[0].values()), 0.05, "rest is rest")

    @by_the_clock
    def test_another_person_live(self):
        """The first packets are the face at rest, which nothing plays."""
        other = self.another_person()
        self.places()
        for scheme, see, sparse in ("landmarks3", lambda p: p, "0.002"), ("landmarks2", seen, "0.1"):
            def packet(k, pose):
                marks = self.marks(pose, 0.15 * math.sin(k / 20), see, other)
                return json.dumps({"time": k / 60, "size": SIZE, "landmarks": marks})
            played, said = self.play(scheme, [{}, *POSES[:2]], packet, "--neutral", "18", "--sparse", sparse, *PATIENT)
            self.assertIn("waiting for a neutral face in 18 packets", said)
            self.assertIn("the neutral face is known", said)
            self.assertIn("18 of the neutral face", said)
            self.assert_shows(played, POSES[:2], 0.2, 0.12)
        # From a file, nothing waits.
        neutral = self.table("neutral.csv", [{}, {}])

        def packet_in_space(k, pose):
            return json.dumps(self.marks(pose, 0.15 * math.sin(k / 20), head=other))
        played, said = self.play("landmarks3", POSES[:1], packet_in_space, "--neutral", neutral, *PATIENT)
        self.assert_shows(played, POSES[:1], 0.2, 0.12)
        self.assertNotIn("waiting", said)

    @by_the_clock
    def test_the_focal_length_is_kept(self):
        """Found from the first packets, said once, and near that of the camera; or given."""
        self.places()

        def packet(k, pose):
            return json.dumps({"size": SIZE, "landmarks": self.marks(pose, 0.3 * math.sin(k / 20), seen)})
        _, said = self.play("landmarks2", [POSES[0]] * 2, packet, "--sparse", "0.1", *PATIENT, hold=35)
        self.assertEqual(said.count("the focal length is"), 1, said)
        found = float(said.partition("the focal length is ")[2].split()[0])
        self.assertAlmostEqual(found / SIZE[0], 1, delta=0.1)
        _, said = self.play("landmarks2", POSES[:1], packet, "--focal", str(SIZE[0]), "--sparse", "0.1", *PATIENT)
        self.assertNotIn("the focal length is", said)

    @by_the_clock
    def test_a_face_that_is_lost_and_found(self):
        """It fades out, and what is no face of the rig moves nothing."""
        self.places()
        face = self.marks(POSES[0])
        elsewhere = [[p[0] + 40, p[1] - 7, p[2]] for p in self.marks(POSES[1], 0.5)]
        mixed = random.Random(8).sample(face, len(face))
        few = [p if i % 9 == 0 else None for i, p in enumerate(face)]
        listener = Listener("landmarks3", "--landmarks", path("points.json"), "--seconds", "2.2", *PATIENT, rig=HEAD)
        lost = 0
        for k in range(110):
            listener.until(k / 60)
            packet = face if k < 25 else ([], None, mixed, few)[k % 4] if k < 75 else elsewhere
            lost += 25 <= k < 75
            listener.send(json.dumps({"time": k / 60, "landmarks": packet}).encode())
        played, said = listener.finish()
        self.assertIn(f"{lost} without the face", said)
        jaw = [v for _, v in curve(played, "jawOpen")]
        first = max(range(len(jaw)), key=lambda f: jaw[f])
        self.assertAlmostEqual(jaw[first], POSES[0]["jawOpen"], delta=0.03)
        gone = jaw.index(0, first)
        self.assertAlmostEqual(jaw[-20], POSES[1]["jawOpen"], delta=0.03)
        self.assertLess(max(b - a for a, b in zip(jaw[gone:], jaw[gone + 1:])), 0.15, "it fades in")

    @by_the_clock
    def test_packets_that_are_none(self):
        self.places()
        good = self.marks(POSES[0])
        text = json.dumps({"time": 1.5, "landmarks": good})
        bad = [b"", b"{", text[:-9].encode(), json.dumps(good[:7]).encode(), b"[[1, 2]]" * 3, b"\xff" * 400,
               json.dumps({"landmarks": [[1e9, 0, 0]] * len(good)}).encode(), b'{"landmarks": {"ear": [1, 2, 3]}}',
               json.dumps({"landmarks": [p[:2] for p in good]}).encode(), b"[" * 60000, b'{"time": -3, "landmarks": []}']
        listener = Listener("landmarks3", "--landmarks", path("points.json"), "--seconds", "1.6", *PATIENT, rig=HEAD)
        damaged = 0
        for k in range(50):
            listener.until(k / 60)
            listener.send(json.dumps({"time": k / 60, "landmarks": good + [[1, 2, 3]] * (k % 2)}).encode())
            if k % 3 == 0:
                listener.send(bad[k // 3 % len(bad)])
                damaged += 1
        played, said = listener.finish()
        self.assertIn(f"{damaged} damaged", said)
        self.assertIn(f"it has 7 landmarks, but number {len(good) - 1} has a place", said)
        self.assertIn("no places for 1 landmarks", said)
        lines = [line for line in said.splitlines() if "a packet is left out" in line]
        self.assertEqual(len(lines), len(set(lines)), "each is said once")
        self.assertLessEqual(len(lines), 8)
        self.assertAlmostEqual(max(v for _, v in curve(played, "jawOpen")), POSES[0]["jawOpen"], delta=0.03)

    @by_the_clock
    def test_a_frame_has_little_time(self):
        """Packets at once: what does not fit into the time of a frame is left out, and said."""
        self.places()
        listener = Listener("landmarks3", "--landmarks", path("points.json"), "--seconds", "0.6", "--solve-time", "1e-6",
                            rig=HEAD)
        for k in range(200):
            listener.send(json.dumps(self.marks(POSES[k % 2])).encode())
        _, said = listener.finish()
        self.assertIn("solved in part for lack of time", said)
        self.assertIn("not solved for lack of time", said)

    def test_wrong_usage(self):
        places = self.places()
        play = "play", path("empty.json"), path(HEAD), "--live"
        local = "landmarks3://127.0.0.1:0"
        self.fails(USAGE, *play, local, says="--landmarks")
        self.fails(USAGE, *play, local, "--landmarks", places, "--solve-time", "2", says="--solve-time")
        self.fails(USAGE, *play, local, "--landmarks", places, "--sparse", "-1", says="--sparse")
        self.fails(USAGE, *play, local, "--landmarks", places, "--names", places, says="--names")
        self.fails(USAGE, *play, local, "--landmarks", places, "--device", "x", says="--device")
        self.fails(USAGE, *play, "landmarks://:1", "--landmarks", places, says="landmarks3://")
        self.fails(USAGE, *play, local, "--landmarks", places, "--focal", "900", says="no camera")
        self.fails(USAGE, *play, local, "--landmarks", places, "--neutral", "0", says="--neutral")
        self.fails(FILE, *play, local, "--landmarks", places, "--neutral", path("missing.csv"), says="missing.csv")
        self.fails(INVALID, *play, local, "--landmarks", places, "--neutral",
                   write("other.csv", "time,ear.x,ear.y,ear.z\n0,1,2,3\n"), says="none of the landmarks")
        for words, says in ((("--neutral", "60"), "--rigid"), (("--rigid", "--neutral", "0"), "from 1 to")):
            self.fails(USAGE, "solve", path(HEAD), write("face.csv", "time,0.x,0.y,0.z\n0,1,2,3\n"), "--landmarks",
                       places, "-o", path("no.json"), *words, says=says)
        for option in "--landmarks", "--neutral", "--focal", "--smooth", "--sparse", "--robust", "--solve-time":
            self.fails(USAGE, *play, "livelink://127.0.0.1:0", option, "0.5", says=option)
        self.fails(INVALID, *play, local, "--landmarks", write("none.json", "{}"), says="no points")
        self.fails(INVALID, *play, local, "--landmarks", write("none.json", '{"points": {"a": 999999999}}'),
                   says="999999999")
        make("convert", path(HEAD), "--layers", "behavior", "-o", path("bare.dna"))
        self.fails(INVALID, "play", path("empty.json"), path("bare.dna"), "--live", local, "--landmarks", places,
                   says="geometry")


if __name__ == "__main__":
    main()
