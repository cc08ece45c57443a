#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien play`: layers, fades, reactions and guards of a scene, at their times; and clear refusals.

    cli_play_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)
"""
import json
import math
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

here = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(here, "..", "..", "..", "tests", "support"))
from glb import Glb  # noqa: E402

DONE, USAGE, INVALID, FILE, INTERNAL = range(5)

mien = os.environ.get("MIEN_BIN", "")
folder = ""


def setUpModule():
    global folder
    folder = tempfile.mkdtemp(prefix="mien-play-")
    head = os.environ.get("MIEN_HEAD")
    if head:
        shutil.copy(head, path("head.dna"))
    else:
        assert run("demo-head", "-o", path("head.dna")).returncode == DONE
    # Names of the app, of which the rig lacks one; 2 seconds.
    rows = "".join(f"{k / 60!r},{k / 120!r},{0.25},{1}\n" for k in range(121))
    write("talk.csv", "time,JawOpen,MouthSmileLeft,nobody\n" + rows)
    assert run("clip", "build", path("talk.csv"), "-o", path("talk.clip")).returncode == DONE


def tearDownModule():
    shutil.rmtree(folder)


def path(name):
    return os.path.join(folder, name)


def write(name, text):
    with open(path(name), "w", encoding="utf-8") as file:
        file.write(text)
    return path(name)


def load(name):
    with open(name, encoding="utf-8") as file:
        return json.load(file)


def run(*arguments, stdin=b""):
    return subprocess.run([mien, *arguments], input=stdin, capture_output=True, check=False)


TALK = {"name": "talk", "group": "speech", "source": {"clip": "talk.clip"}}
JOY = {"name": "joy", "group": "emotion", "mode": "screen",
       "source": {"poses": {"smile": {"mouthSmileLeft": 0.8}, "puff": {"cheekPuff": 1}}}}


class Played:
    """The frames of a scene, by control."""

    def __init__(self, document):
        self.names = document["controls"]
        self.variables = document["variables"]
        self.frames = document["frames"]
        self.document = document

    def value(self, name, frame):
        return self.frames[frame]["raw"][self.names.index(name)]

    def curve(self, name):
        return [self.value(name, f) for f in range(len(self.frames))]


class PlayTest(unittest.TestCase):
    def play(self, scene, *options):
        done = run("play", write("scene.json", json.dumps({"seconds": 2, **scene})),
                   path("head.dna"), "-q", *options)
        self.assertEqual(done.returncode, DONE, done.stderr.decode())
        return Played(json.loads(done.stdout)) if done.stdout else None

    def refused(self, scene, says, *options, code=INVALID):
        text = scene if isinstance(scene, str) else json.dumps({"seconds": 1, **scene})
        done = run("play", write("wrong.json", text), path("head.dna"), "-q", *options)
        line = done.stderr.decode()
        self.assertEqual(done.returncode, code, line)
        self.assertEqual(line.count("\n"), 1, line)
        for part in [says] if isinstance(says, str) else says:
            self.assertIn(part, line)

    def test_a_clip_drives_the_controls_of_its_names(self):
        played = self.play({"layers": [TALK]})
        self.assertEqual(len(played.frames), 121)
        for f in (0, 1, 60, 120):
            self.assertAlmostEqual(played.frames[f]["time"], f / 60, 12)
            self.assertAlmostEqual(played.value("jawOpen", f), f / 120, 6)
            self.assertEqual(played.value("mouthSmileLeft", f), 0.25)
            self.assertEqual(played.value("mouthSmileRight", f), 0)

    def test_speed_start_and_loop(self):
        source = {"clip": "talk.clip", "speed": 2, "start": 0.5, "loop": False}
        played = self.play({"rate": 30, "layers": [{**TALK, "source": source}]})
        self.assertAlmostEqual(played.value("jawOpen", 15), (0.5 + 2 * 0.5) / 2, 5)
        self.assertAlmostEqual(played.value("jawOpen", 60), 1, 6)
        source["loop"] = True
        played = self.play({"rate": 30, "layers": [{**TALK, "source": source}]})
        self.assertLess(played.value("jawOpen", 60), 0.6)
        # A third to the tick, which 0.333 would miss.
        source = {"clip": "talk.clip", "speed": 0.33333333}
        whole = self.play({"layers": [TALK]})
        third = self.play({"seconds": 6, "layers": [{**TALK, "source": source}]})
        self.assertEqual(third.curve("jawOpen")[::3], whole.curve("jawOpen"))
        source["speed"] = 0
        self.assertEqual(set(self.play({"layers": [{**TALK, "source": source}]}).curve("jawOpen")), {0})

    def test_weights_fade_at_their_times(self):
        played = self.play({"layers": [{**JOY, "mode": "override"}], "events": [
            {"time": 0.5, "layer": "joy", "weights": {"smile": 1}, "fade": 0.5},
            {"time": 1.5, "layer": "joy", "weight": 0}]})
        smile = played.curve("mouthSmileLeft")
        self.assertEqual(set(smile[:31]), {0})
        self.assertAlmostEqual(smile[45], 0.4, 5)
        self.assertAlmostEqual(smile[60], 0.8, 6)
        self.assertAlmostEqual(smile[89], 0.8, 6)
        self.assertEqual(set(smile[90:]), {0})
        self.assertTrue(all(b >= a for a, b in zip(smile[30:60], smile[31:61])))

    def test_screen_and_masks(self):
        joy = {**JOY, "source": {**JOY["source"], "weights": {"smile": 1}}}
        played = self.play({"layers": [TALK, joy]})
        self.assertAlmostEqual(played.value("mouthSmileLeft", 60), 0.25 + 0.8 * 0.75, 5)
        for mask, smile in (({"controls": ["jaw*"]}, 0.25),
                            ({"controls": ["mouth*"]}, 0.85),
                            ({"controls": ["mouth*"], "invert": True}, 0.25)):
            played = self.play({"layers": [TALK, {**joy, "mask": mask}]})
            self.assertAlmostEqual(played.value("mouthSmileLeft", 60), smile, 5)

    def test_the_light_of_a_torch(self):
        played = self.play({"layers": [TALK], "reactions": [{"name": "glare", "preset": "glare"}],
                            "events": [{"time": 1, "trigger": "glare", "hold": 0.5}]})
        lid = played.curve("eyeBlinkLeft")
        self.assertEqual(set(lid[:64]), {0})
        first = next(f for f, value in enumerate(lid) if value >= 0.9) / 60
        self.assertTrue(1.11 <= first <= 1.16, first)
        self.assertGreater(played.value("eyeSquintLeft", 85), 0.4)
        for f in range(121):
            self.assertAlmostEqual(played.value("jawOpen", f), f / 120, 5)

    def test_a_light_of_some_brightness(self):
        def squint(*levels, seconds=5):
            played = self.play({"seconds": seconds, "layers": [TALK],
                                "reactions": [{"name": "glare", "preset": "glare"}],
                                "events": [{"time": time, "level": "glare", "value": value}
                                           for time, value in levels]})
            return played.curve("eyeSquintLeft")
        self.assertEqual(max(squint((1, 0.49))), 0)
        full, half = squint((1, 1), (2, 0.34)), squint((1, 0.5), (2, 0.34))
        for f in (80, 100, 119):
            self.assertAlmostEqual(half[f], full[f] / 2, 5)
        self.assertGreater(full[119], 0.4)
        self.assertEqual(full[60 * 3:], [0] * 121)
        # From 0.35 on the light is not gone; it is only less bright.
        lasts = squint((1, 1), (2, 0.35))
        self.assertAlmostEqual(lasts[299], 0.35 * squint((1, 1))[299], 3)
        self.assertGreater(lasts[299], 0.1)

    def test_blinks_follow_the_seed(self):
        scene = {"seconds": 20, "layers": [{"name": "blink", "group": "life", "mode": "max",
                                            "source": {"generator": "blink"}}]}
        first = self.play({**scene, "seed": 7}).curve("eyeBlinkLeft")
        self.assertGreater(max(first), 0.9)
        self.assertEqual(first, self.play(scene, "--seed", "7").curve("eyeBlinkLeft"))
        self.assertNotEqual(first, self.play({**scene, "seed": 8}).curve("eyeBlinkLeft"))

    def test_guards_keep_lips_closed(self):
        rows = "".join(f"{k / 60!r},0.5,0.5\n" for k in range(121))
        write("closed.csv", "time,jawOpen,mouthClose\n" + rows)
        self.assertEqual(run("clip", "build", path("closed.csv"), "-o",
                             path("closed.clip")).returncode, DONE)
        scene = {"layers": [{**TALK, "source": {"clip": "closed.clip"}},
                            {"name": "awe", "group": "emotion", "mode": "screen", "source": {
                                "poses": {"awe": {"jawOpen": 1, "browInnerUp": 1}},
                                "weights": {"awe": 1}}}]}
        free = self.play(scene)
        held = self.play({**scene, "guards": ["lips"]})
        self.assertEqual(free.value("browInnerUp", 60), held.value("browInnerUp", 60))
        self.assertLess(held.value("jawOpen", 60), free.value("jawOpen", 60) - 0.1)

    def test_a_clip_says_when_lips_are_closed(self):
        # A mouth at rest has closed lips, too: only who knows the phonemes tells a pause from an M.
        write("talk.json", json.dumps({
            "rate": 60, "frames": [{"raw": {"jawOpen": 0}}] * 121,
            "events": [{"time": 1, "name": "M", "value": 0.1}]}))
        awe = {"name": "awe", "group": "emotion", "mode": "screen", "source": {
            "poses": {"awe": {"jawOpen": 0.5}}, "weights": {"awe": 1}}}
        jaws = []
        for options in ([], ["--close", "m,b,p=lips", "--close", "f,v=lip-to-teeth"],
                        ["--close", "m,b,p=lips", "--close", "M=lip-to-teeth"]):
            done = run("clip", "build", path("talk.json"), "-o", path("m.clip"), *options)
            self.assertEqual(done.returncode, DONE, done.stderr.decode())
            played = self.play({"guards": ["lips"], "layers": [
                {**TALK, "source": {"clip": "m.clip"}}, awe]}, "--stages", "jawOpen")
            jaws.append([played.value("jawOpen", frame) for frame in (30, 60, 63, 66, 90)])
        self.assertLess(max(jaws[0]), 0.1, "closed by the distance all the time")
        self.assertLess(max(jaws[1]), 0.1, "the guard of lip and teeth has no label")
        self.assertEqual([jaws[2][0], jaws[2][4]], [0.5, 0.5], "in the pauses")
        self.assertLess(max(jaws[2][1:4]), 0.05, "in the M")

    def test_a_guard_tells_why_it_holds_a_curve_back(self):
        scene = load(os.path.join(here, "../../../examples/scene.json"))
        played = self.play(scene, "--stages", "jawOpen", "-o", path("why.json"), "-o", path("why.svg"))
        self.assertIsNone(played)
        frames = load(path("why.json"))["frames"]
        # Lips are closed for an M while joy wants them open.
        stages, guards = dict(frames[108]["stages"]["jawOpen"]), frames[108]["guards"]
        self.assertGreater(stages["blink"], 0.25)
        self.assertEqual(stages["guards"], 0)
        self.assertTrue({"lips left", "lips center", "lips right"} <= set(guards), guards)
        center = guards["lips center"]
        self.assertGreater(center["wanted_mm"], center["limit_mm"] + 1)
        self.assertLess(center["distance_mm"], center["limit_mm"] + 0.01)
        self.assertEqual(center["activation"], 1)
        self.assertEqual(frames[12]["guards"], {}, "an open vowel is nothing to guard")
        self.assertFalse(set(guards) & {"left lids", "right lids"}, "they know nothing of the jaw")
        with open(path("why.svg"), encoding="utf-8") as file:
            svg = file.read()
        xml.etree.ElementTree.fromstring(svg)
        for words in (">held back by guards<", ">held: lips left, lips center, lips right",
                      ">lips center, mm<", ">flashlight<", ">joy<"):
            self.assertIn(words, svg)
        self.assertNotIn(">held back by limits<", svg)
        done = run("eval", path("head.dna"), "--input", path("why.json"), "-o", path("evaluated.json"))
        self.assertEqual(done.returncode, DONE, done.stderr.decode())

    def test_limits(self):
        joy = {**JOY, "mode": "add", "source": {"poses": {"p": {"mouthSmileLeft": 3}},
                                                "weights": {"p": 1}}}
        self.assertEqual(self.play({"layers": [joy]}).value("mouthSmileLeft", 9), 3)
        self.assertEqual(self.play({"layers": [joy], "limits": True}).value("mouthSmileLeft", 9), 1)

    def test_variables_and_stages(self):
        played = self.play({"layers": [TALK, JOY], "events": [
            {"time": 1, "variable": "gaze.x", "value": 0.5},
            {"time": 0, "layer": "joy", "weights": {"smile": 1}}]}, "--stages", "mouthSmileLeft")
        self.assertEqual(played.variables, ["gaze.x"])
        self.assertEqual([played.frames[f]["variables"] for f in (59, 60)], [[0], [0.5]])
        stages = played.frames[60]["stages"]["mouthSmileLeft"]
        self.assertEqual([name for name, _ in stages],
                         ["talk", "joy", "reactions", "guards", "antagonists", "limits"])
        self.assertEqual(stages[0][1], 0.25)
        self.assertAlmostEqual(stages[1][1], 0.85, 5)
        self.assertEqual(stages[-1][1], played.value("mouthSmileLeft", 60))

    def test_a_clip_and_its_differences_give_the_whole_back(self):  # B3
        rows = "".join(f"{k / 60!r},{(k * 7 % 61) / 61!r}\n" for k in range(61))
        write("nod.csv", "time,jawOpen\n" + rows)
        write("calm.csv", "time,jawOpen\n" + "".join(f"{k / 60!r},{k / 97!r}\n" for k in range(61)))
        for command in (["calm.csv", "-o", path("calm.clip")],
                        ["nod.csv", "-o", path("more.clip"), "--minus", path("calm.clip")]):
            done = run("clip", "build", path(command[0]), *command[1:])
            self.assertEqual(done.returncode, DONE, done.stderr.decode())
        layer = lambda name, **change: {"name": name, "source": {"clip": name + ".clip"}, **change}
        scene = {"seconds": 1, "layers": [layer("calm"), layer("more", mode="add")]}
        played = self.play(scene)
        for f in range(61):
            self.assertAlmostEqual(played.value("jawOpen", f), f * 7 % 61 / 61, delta=1.2e-7)
        self.refused({"layers": [layer("more")]}, "differences")

    def test_eyes_look_at_a_place(self):
        eyes = {"name": "eyes", "group": "life", "source": {"generator": "gaze"}}
        scene = {"seconds": 2, "layers": [eyes], "events": [
            {"time": 1, "variable": "gaze.x", "value": 0.3},
            {"time": 1.5, "variable": "gaze.x", "value": 3}]}
        played = self.play(scene, "--stages", "gaze.x")
        self.assertEqual(played.variables, ["gaze.x", "gaze.y", "gaze.z", "head.left", "head.up"])
        out, into = ([played.value(name, f) for f in range(121)]
                     for name in ("eyeLookOutLeft", "eyeLookInRight"))
        # Ahead they converge on a meter; a saccade begins at 1 s and takes about 60 ms.
        self.assertEqual(out[59], 0)
        self.assertGreater(played.value("eyeLookInLeft", 59), 0)
        self.assertEqual(out[60], 0)
        self.assertGreater(out[62], 0)
        self.assertGreater(out[66], 0.2)
        self.assertGreater(into[66], out[66])
        self.assertEqual(out[66], out[80])
        variables = [frame["variables"] for frame in played.frames]
        for f, (x, y, z) in ((59, (0, 0, 1)), (80, (0.3, 0, 1)), (120, (3, 0, 1))):
            for value, wanted in zip(variables[f], (x, y, z)):
                self.assertAlmostEqual(value, wanted, 5)
        self.assertAlmostEqual(played.frames[80]["stages"]["gaze.x"][0][1], 0.3, 5)
        # What is beyond the reach of the eyes is left for the head.
        self.assertEqual(variables[80][3], 0)
        self.assertGreater(variables[120][3], 1)
        # A light turns the eyes away: the reaction adds to the place.
        scene = {"seconds": 1, "layers": [eyes],
                 "reactions": [{"name": "glare", "preset": "glare"}],
                 "events": [{"time": 0, "trigger": "glare", "hold": 1}]}
        played = self.play(scene)
        self.assertGreater(played.value("eyeLookDownLeft", 59), 0.1)
        below = dict(zip(played.variables, played.frames[59]["variables"]))["gaze.y"]
        self.assertTrue(-0.4 < below < -0.2, below)

    def test_stages_are_in_the_order_in_which_they_act(self):
        """Reactions come before the layers of life that follow all others."""
        blink = {"name": "blink", "group": "life", "mode": "max", "source": {"generator": "blink"}}
        played = self.play({"layers": [TALK, JOY, blink],
                            "reactions": [{"name": "glare", "preset": "glare"}],
                            "events": [{"time": 0, "trigger": "glare", "hold": 1}]},
                           "--stages", "eyeBlinkLeft")
        self.assertEqual([name for name, _ in played.frames[30]["stages"]["eyeBlinkLeft"]],
                         ["talk", "joy", "reactions", "blink", "guards", "antagonists", "limits"])
        frame = next(f for f in played.frames if dict(f["stages"]["eyeBlinkLeft"])["reactions"] > 0.9)
        values = dict(frame["stages"]["eyeBlinkLeft"])
        self.assertEqual(values["joy"], 0)
        self.assertGreaterEqual(values["blink"], values["reactions"])

    def test_switching_clips(self):
        rows = "".join(f"{k / 60!r},0\n" for k in range(121))
        write("still.csv", "time,jawOpen\n" + rows)
        run("clip", "build", path("still.csv"), "-o", path("still.clip"))
        event = {"time": 1, "layer": "talk", "play": {"clip": "still.clip"}, "duration": 0.5}
        for transition, after in (("cut", 0), ("crossfade", 0.4), ("inertial", 0.4)):
            played = self.play({"layers": [TALK], "events": [{**event, "transition": transition}]})
            jaw = played.curve("jawOpen")
            self.assertAlmostEqual(jaw[59], 59 / 120, 5)
            self.assertGreaterEqual(jaw[61], after)
            self.assertEqual(jaw[95], 0)

    def test_every_output(self):
        names = [path("out" + end) for end in (".json", ".csv", ".clip", ".svg")]
        self.play({"layers": [TALK]}, *[word for name in names for word in ("-o", name)])
        with open(names[0], encoding="utf-8") as file:
            played = Played(json.load(file))
        xml.etree.ElementTree.parse(names[3])
        self.assertEqual(run("clip", "build", names[1], "-o", path("again.clip")).returncode, DONE)
        for clip in (names[2], path("again.clip")):
            text = run("clip", "export", clip, "-o", "-").stdout.decode().splitlines()
            row = dict(zip(text[0].split(","), text[61].split(",")))
            self.assertAlmostEqual(float(row["jawOpen"]), played.value("jawOpen", 60), 6)
        done = run("eval", path("head.dna"), "--input", names[0], "-o", path("evaluated.json"))
        self.assertEqual(done.returncode, DONE, done.stderr.decode())

    def test_a_glb_is_what_export_makes_of_the_frames(self):
        scene = {"seconds": 0.5, "layers": [TALK, JOY],
                 "events": [{"time": 0, "layer": "joy", "weights": {"smile": 1}, "fade": 0.4}]}
        for lod in "0", "3":
            self.play(scene, "-o", path("frames.json"), "-o", path("played.glb"), "--lod", lod)
            done = run("export", path("head.dna"), "--animation", path("frames.json"), "--fps", "60",
                       "--lod", lod, "-o", path("exported.glb"), "-q")
            self.assertEqual(done.returncode, DONE, done.stderr.decode())
            with open(path("played.glb"), "rb") as played, open(path("exported.glb"), "rb") as exported:
                glb = Glb(played.read())
                self.assertEqual(glb.json, Glb(exported.read()).json)
                played.seek(0), exported.seek(0)
                self.assertEqual(played.read(), exported.read())
            animation, = glb.json["animations"]
            paths = {channel["target"]["path"] for channel in animation["channels"]}
            self.assertIn("rotation", paths)

    def test_the_head_turns_in_a_glb(self):
        tangent = math.tan(math.radians(30))
        pose = lambda **values: {"seconds": 0.1, "layers": [{"name": "turn", "source": {
            "poses": {"turn": {name.replace("_", "."): value for name, value in values.items()}},
            "weights": {"turn": 1}}}]}
        self.assertEqual(run("gen", "-o", path("plain.dna"), "-q").returncode, DONE)
        with open(path("plain.dna"), "rb") as file:
            named = file.read()
        with open(path("plain.dna"), "wb") as file:  # without joints of these names
            file.write(named.replace(b"head", b"hood").replace(b"neck", b"nock"))
        # (rig, scene, degrees, where the face goes: x to its left or y up)
        for rig, scene, degrees, axis in (
                ("head.dna", pose(head_left=tangent / 2, head_turn=tangent / 2), 30, 0),
                ("head.dna", pose(head_up=tangent), 30, 1),
                ("head.dna", pose(head_left=1e6), 60, 0),
                ("plain.dna", pose(head_left=tangent), 30, 0)):
            done = run("play", write("turn.json", json.dumps(scene)), path(rig), "-q",
                       "-o", path("turn.glb"), "-o", path("frames.json"), "--force")
            self.assertEqual(done.returncode, DONE, done.stderr.decode())
            self.assertTrue(any(name.startswith("head.") for name in load(path("frames.json"))["variables"]))
            with open(path("turn.glb"), "rb") as file:
                glb = Glb(file.read())
            animation, = glb.json["animations"]
            turned, total = [], 0
            for channel in animation["channels"]:
                if channel["target"]["path"] != "rotation":
                    continue
                node = glb.json["nodes"][channel["target"]["node"]]
                sampler = animation["samplers"][channel["sampler"]]
                x, y, z, w = glb.accessor(sampler["output"])[-1]
                a, b, c, d = node.get("rotation", (0, 0, 0, 1))
                total += math.degrees(2 * math.acos(min(1, abs(x * a + y * b + z * c + w * d))))
                turned.append(node["name"])
            self.assertAlmostEqual(total, degrees, 2, (rig, turned))
            wanted = {"C_Neck01", "C_Neck02", "C_Head"} if rig == "head.dna" else {"root"}
            self.assertEqual(set(turned), wanted)
            mesh = next(i for i, node in enumerate(glb.json["nodes"]) if "skin" in node)
            before, after = glb.deformed(mesh), glb.deformed(mesh, 6)
            nose = max(range(len(before)), key=lambda v: before[v][2])
            self.assertGreater(after[nose][axis] - before[nose][axis], 0.03)

    def test_the_head_turns_in_pictures(self):
        look = ["--size", "96", "--samples", "1", "--lod", "5", "--every", "0.1"]
        event = lambda value: [{"time": 0, "variable": "head.left", "value": value}]
        self.assertEqual(run("bake", path("head.dna"), "-o", path("turned.rig"), "-q",
                             "--force").returncode, DONE)
        for rig in "head.dna", "turned.rig":
            pictures = []
            for name, value in ("still", 0), ("left", 0.5), ("right", -0.5), ("again", 0.5):
                scene = write("turn.json", json.dumps({"seconds": 0, "events": event(value)}))
                done = run("play", scene, path(rig), "-q", "-o", path(name + ".png"), "--force", *look)
                self.assertEqual(done.returncode, DONE, done.stderr.decode())
                with open(path(name + ".png"), "rb") as file:
                    pictures.append(file.read())
            self.assertEqual(pictures[1], pictures[3])
            self.assertEqual(len(set(pictures)), 3)

    def test_pictures_are_those_of_the_frames(self):
        look = ["--target", "mouth", "--size", "48x40", "--samples", "1", "--lod", "2"]
        self.play({"seconds": 1, "layers": [TALK]}, "-o", path("frames.json"), "-o",
                  path("played-%02d.png"), "--every", "0.4", *look)
        frames = load(path("frames.json"))["frames"]
        write("three.json", json.dumps({"frames": [frames[f] for f in (0, 24, 48)]}))
        done = run("render", path("head.dna"), "--frames", path("three.json"), "-o",
                   path("drawn-%02d.png"), "-q", *look)
        self.assertEqual(done.returncode, DONE, done.stderr.decode())
        pictures = []
        for number in range(3):
            with open(path(f"played-{number:02}.png"), "rb") as played, \
                    open(path(f"drawn-{number:02}.png"), "rb") as drawn:
                pictures.append(played.read())
                self.assertEqual(pictures[-1], drawn.read())
        self.assertEqual(len(set(pictures)), 3)
        self.assertFalse(os.path.exists(path("played-03.png")))

    def size_of_strip(self, *options, seconds=2):
        self.play({"layers": [TALK], "seconds": seconds}, "-o", path("strip.png"), "--lod", "5",
                  "--size", "30x20", "--samples", "1", *options)
        with open(path("strip.png"), "rb") as file:
            return struct.unpack_from(">II", file.read(), 16)

    def test_a_strip_has_a_picture_every_so_many_seconds(self):
        gap, label = 6, 15
        size = lambda columns, rows: (columns * (30 + gap) + gap, rows * (20 + label + gap) + gap)
        # 0, 0.5, ... 2 s; 16 pictures at most if nothing is said; frames are not shown twice.
        self.assertEqual(self.size_of_strip("--every", "0.5"), size(5, 1))
        self.assertEqual(self.size_of_strip("--every", "0.5", "--columns", "2"), size(2, 3))
        self.assertEqual(self.size_of_strip(), size(8, 2))
        self.assertEqual(self.size_of_strip(seconds=0), size(1, 1))
        self.assertEqual(self.size_of_strip("--every", "0.001", "--rate", "4"), size(8, 2))

    def test_options_of_outputs_that_are_not_there(self):
        for *options, says in ((["--every", "1"], "OUT.png"), (["--target", "mouth"], "OUT.png"),
                               (["--influences", "8"], "OUT.glb"), (["--lod", "2"], "OUT.png"),
                               (["-o", path("x.png"), "--every", "0"], "--every"),
                               (["-o", path("x.png"), "--every", "soon"], "--every"),
                               (["-o", path("x%d.png"), "--columns", "2"], "--columns"),
                               (["-o", path("x.png"), "--columns", "0"], "--columns"),
                               (["-o", path("x.png"), "--camera", "frunt"], "front"),
                               (["-o", path("x.png"), "--target", "nsoe"], "nsoe"),
                               (["-o", path("x.glb"), "--influences", "5"], "--influences")):
            with self.subTest(options[0]):
                code = INVALID if says == "nsoe" else USAGE
                self.refused({"layers": [TALK]}, says, *options[0], code=code)
                self.assertFalse(os.path.exists(path("x.png")))
        self.assertEqual(run("bake", path("head.dna"), "-o", path("head.rig"), "-q").returncode, DONE)
        write("scene.json", json.dumps({"seconds": 0.1, "layers": [TALK]}))
        done = run("play", path("scene.json"), path("head.rig"), "-o", path("x.glb"))
        self.assertEqual(done.returncode, USAGE)
        self.assertIn(b"give the DNA file", done.stderr)
        done = run("play", path("scene.json"), path("head.rig"), "-o", path("baked.png"), "--size", "32")
        self.assertEqual(done.returncode, DONE, done.stderr.decode())
        done = run("play", path("scene.json"), "-", "-o", path("x.png"), stdin=b"")
        self.assertEqual(done.returncode, USAGE)

    def test_the_scene_of_the_examples_closes_lips_and_lids(self):
        scene = load(os.path.join(here, "../../../examples/scene.json"))
        held = self.play(scene)
        free = self.play({**scene, "guards": []})
        lips_closed, both = round(1.2 * 60), round(1.8 * 60)
        for frame in lips_closed, both:
            self.assertGreater(free.value("jawOpen", frame), 0.25)
            self.assertEqual(held.value("jawOpen", frame), 0)
            self.assertGreater(held.value("mouthSmileLeft", frame), 0.85)
        self.assertLess(held.value("eyeBlinkLeft", lips_closed), 0.01)
        self.assertGreater(held.value("eyeBlinkLeft", both), 0.95)

    def test_variables_that_move_nothing_are_noted(self):
        for name, says in (("pupill", b'did you mean "pupil"?'), ("light", b"begin with user."),
                           ("user.light", b""), ("gaze.x", b"")):
            scene = {"seconds": 0, "events": [{"time": 0, "variable": name, "value": 0.5}]}
            done = run("play", write("scene.json", json.dumps(scene)), path("head.dna"))
            self.assertEqual(json.loads(done.stdout)["variables"], [name])
            self.assertEqual((says in done.stderr, done.stderr == b""), (True, says == b""))

    def test_short_names_of_several_controls_are_ambiguous(self):
        with open(path("head.dna"), "rb") as file:
            dna = file.read()
        with open(path("two.dna"), "wb") as file:
            file.write(dna.replace(b"browInnerUp", b"two.jawOpen"))
        for name, code in (("jawOpen", DONE), ("two.jawOpen", DONE), ("JAWOPEN", INVALID)):
            layer = {"name": "x", "source": {"poses": {"p": {name: 1}}}}
            done = run("play", write("scene.json", json.dumps({"layers": [layer]})), path("two.dna"))
            self.assertEqual(done.returncode, code, done.stderr.decode())
        self.assertIn(b"ambiguous", done.stderr)

    def test_wrong_scenes(self):
        joy = lambda **change: {"layers": [{**JOY, **change}]}
        event = lambda **e: {"layers": [TALK, JOY], "events": [{"time": 0, **e}],
                             "reactions": [{"name": "glare", "preset": "glare"}]}
        for scene, says in (
                ("[]", "expected an object"), ("{", "wrong.json"), ({"lyaers": []}, '"layers"'),
                (joy(mode="scren"), '"screen"'), (joy(group="mood"), "emotion"),
                (joy(weight=2), "layers[0].weight"), (joy(source={}), "no source"),
                (joy(mask={"controls": ["mouht*"]}), "layers[0].mask.controls"),
                (joy(source={"poses": {"p": {"mouthSmileLetf": 1}}}), '"mouthSmileLeft"'),
                (joy(source={"poses": {"p": {"jawOpen": "x"}}}), "expected a number"),
                (joy(source={"poses": {"p": {}}, "weights": {"q": 1}}), "no pose"),
                (joy(source={"generator": "noise"}), "controls"),
                (joy(source={"generator": "gaze", "eyes": ["a"]}), "two names"),
                (joy(source={"generator": "gaze", "eyes": ["a", "b"]}), "no joints"),
                (joy(source={"generator": "gaze", "period": 1}), '"period"'),
                ({"layers": [{"name": n, "source": {"generator": "gaze"}} for n in "ab"]}, "several"),
                ({"layers": [{"name": "e", "source": {"generator": "gaze"}},
                             {**JOY, "source": {"poses": {"p": {"gaze.x": 1}}}}]}, "add or override"),
                ({"layers": [TALK, TALK]}, 'two of them are named "talk"'), ({"layers": [TALK] * 17}, "16"),
                ({"layers": [{**TALK, "source": {"clip": ""}}]}, "empty"),
                ({"guards": ["lisp"]}, '"lips"'), ({"seconds": -1}, "seconds"),
                ({"reactions": [{"name": "x", "preset": "gape"}]}, "glare"),
                (event(layer="joi", weight=1), '"joy"'), (event(layer="joy"), '"weight"'),
                (event(layer="joy", play={"clip": "talk.clip"}), "no clip"),
                (event(layer="talk", weights={"a": 1}), "no poses"),
                (event(trigger="glare", strength=2), "events[0].strength"),
                (event(level="glare", value=1.5), "events[0].value"),
                (event(level="glare"), '"value"'), (event(level="galre", value=1), '"glare"'),
                (event(variable="x"), '"value"'), (event(), "what happens"),
                (event(layer="joy", weight=1, fad=1), '"fade"'),
                (joy(source={"poses": {}}), "no poses"), ({"seed": -1}, "it is -1"),
                ({"events": [{"time": 0, "trigger": "glare"}]}, '"glare" is not in the scene'),
                (joy(source={"clpi": "x"}), '"clip"'),
                (joy(mask={"controls": ["muoth*"]}), 'did you mean "mouth*"?'),
                ('{"seed": 1, "seed": 2}', 'the key "seed" twice')):
            with self.subTest(says):
                self.refused(scene, says)
        missing = {"layers": [{**TALK, "source": {"clip": "none.clip"}}]}
        self.refused(missing, "none.clip", code=FILE)
        self.refused({"layers": [TALK]}, ".svg", "-o", path("x.txt"), code=USAGE)
        self.refused({"layers": [TALK]}, "--rate", "--rate", "fast", code=USAGE)
        done = run("play", "-", "-", stdin=b"{}")
        self.assertEqual(done.returncode, USAGE)
        self.assertIn(b"both", done.stderr)
        self.refused({"layers": [TALK]}, "jawOpne", "--stages", "jawOpne")


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        mien = sys.argv.pop(1)
    unittest.main()
