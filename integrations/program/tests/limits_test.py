#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Small files that ask for much: time and memory are bounded by their size (SECURITY.md, "What is promised")."""
import json
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "tests", "support"))
from program import INVALID, ProgramTest, cost, main, make, make_folder, path, write  # noqa: E402


def setUpModule():
    make_folder()
    make("gen", "--preset", "tiny", "-o", path("tiny.dna"))


class Takes(ProgramTest):
    def test_names_and_frames_multiply(self):
        frames = [{"raw": {"n%d" % i: 1}} for i in range(15000)]
        source = write("wide.json", json.dumps({"rate": 60, "frames": frames}))
        self.fails(INVALID, "clip", "build", source, "-o", path("no.clip"), says="15000 frames")
        seconds, peak = cost("clip", "build", source, "-o", path("no.clip"))
        self.assertLess(seconds, 1)
        self.assertLess(peak, 200e6)

    def test_many_names_in_one_frame(self):
        frames = [{"raw": {"n%d" % i: i % 2 for i in range(60000)}}]
        source = write("many.json", json.dumps({"rate": 60, "frames": frames}))
        self.assertLess(cost("clip", "build", source, "-o", path("many.clip"))[0], 1.5)

    def test_tables_take_what_they_hold(self):
        names = ["n%d" % i for i in range(60000)]
        rows = ["time," + ",".join(names)] + ["%g" % (i / 60) + ",1" * len(names) for i in range(2)]
        source = write("wide.csv", "\n".join(rows) + "\n")
        seconds, peak = cost("clip", "build", source, "-o", path("wide.clip"))
        self.assertLess(seconds, 1.5)
        self.assertLess(peak, 200e6)
        source = write("far.csv", "time,a,b\n0,1,2\n0.1,2,3\n1e6,3,4\n")
        self.fails(INVALID, "clip", "build", source, "-o", path("no.clip"), "--resample", "--rate", "60",
                   says="so far apart")
        self.assertLess(cost("clip", "build", source, "-o", path("no.clip"), "--resample", "--rate", "60")[1],
                        200e6)


class Frames(ProgramTest):
    def test_frames_name_controls_of_the_rig_once(self):
        many = write("frames.json", json.dumps({"frames": [{"raw": {"n%d" % i: 1 for i in range(60000)}}]}))
        self.fails(INVALID, "eval", path("tiny.dna"), "-i", many, says='"n0"')
        self.assertLess(cost("eval", path("tiny.dna"), "-i", many)[0], 1)
        twice = write("twice.json", '{"frames": [{"raw": {"0": 1, "0": 0}}]}')
        self.fails(INVALID, "eval", path("tiny.dna"), "-i", twice, says="twice")


class Expressions(ProgramTest):
    def test_expressions_with_many_controls(self):
        many = {"n%d" % i: 1 for i in range(60000)}
        source = write("expressions.json", json.dumps({"aa": many}))
        arguments = ("export", path("tiny.dna"), "--bake", source, "-o", path("no.glb"))
        self.fails(INVALID, *arguments, says="none of the expressions")
        self.assertLess(cost(*arguments)[0], 1.5)
        source = write("expressions.json", json.dumps({"e%d" % i: {"a": 1} for i in range(513)}))
        self.fails(INVALID, *arguments, says="more than 512 expressions")


class Scenes(ProgramTest):
    def test_large_scenes_are_refused_or_read_at_once(self):
        def scene(**members):
            return json.dumps({"layers": [], **members})
        layer = {"name": "a", "source": {"generator": "blink"}}
        many = {"name%d" % i: 1 for i in range(60000)}
        for text, says in (
                (scene(layers=[layer] * 17), "at most 16"),
                (scene(layers=[{**layer, "name": "x" * 256}]), "255 bytes"),
                (scene(reactions=[{"name": "x" * 256, "preset": "glare"}]), "255 bytes"),
                (scene(layers=[{"name": "a", "source": {"poses": {"p": many}}}]), "name"),
                (scene(**many), "name0")):
            source = write("large.json", text)
            self.fails(INVALID, "play", source, path("tiny.dna"), "-o", path("no.json"), says=says)
            seconds, peak = cost("play", source, path("tiny.dna"), "-o", path("no.json"))
            self.assertLess(seconds, 2, says)
            self.assertLess(peak, 300e6, says)


if __name__ == "__main__":
    main()
