#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Small files that ask for much: time and memory are bounded by their size (SECURITY.md, "What is promised")."""
import json
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "tests", "support"))
from program import INVALID, ProgramTest, cost, growth, main, make, make_folder, path, write  # noqa: E402


def setUpModule():
    make_folder()
    make("gen", "--preset", "tiny", "-o", path("tiny.dna"))


class LimitsTest(ProgramTest):
    def grows_with_the_size(self, arguments_of, count=60000):
        """arguments_of(N) is a command with an input of N items. One that took the square would take 16 times as long
        for four times the items."""
        ratio = growth(arguments_of(count // 4), arguments_of(count))
        self.assertLess(ratio, 9, arguments_of(count)[:2])


class Takes(LimitsTest):
    def test_names_and_frames_multiply(self):
        def build(count):
            frames = [{"raw": {"n%d" % i: 1}} for i in range(count)]
            source = write("wide%d.json" % count, json.dumps({"rate": 60, "frames": frames}))
            return "clip", "build", source, "-o", path("no.clip")
        self.fails(INVALID, *build(15000), says="15000 frames")
        self.grows_with_the_size(build)
        self.assertLess(cost(*build(15000))[1], 200e6)

    def test_many_names_in_one_frame(self):
        def build(count):
            frames = [{"raw": {"n%d" % i: i % 2 for i in range(count)}}]
            source = write("many%d.json" % count, json.dumps({"rate": 60, "frames": frames}))
            return "clip", "build", source, "-o", path("many.clip")
        self.ok(*build(60000))
        self.grows_with_the_size(build)

    def test_tables_take_what_they_hold(self):
        def build(count):
            rows = ["time," + ",".join("n%d" % i for i in range(count))]
            rows += ["%g" % (i / 60) + ",1" * count for i in range(2)]
            return "clip", "build", write("wide%d.csv" % count, "\n".join(rows) + "\n"), "-o", path("wide.clip")
        self.ok(*build(60000))
        self.grows_with_the_size(build)
        self.assertLess(cost(*build(60000))[1], 200e6)
        source = write("far.csv", "time,a,b\n0,1,2\n0.1,2,3\n1e6,3,4\n")
        self.fails(INVALID, "clip", "build", source, "-o", path("no.clip"), "--resample", "--rate", "60",
                   says="so far apart")
        self.assertLess(cost("clip", "build", source, "-o", path("no.clip"), "--resample", "--rate", "60")[1],
                        200e6)


class Frames(LimitsTest):
    def test_frames_name_controls_of_the_rig_once(self):
        def evaluate(count):
            frames = [{"raw": {"n%d" % i: 1 for i in range(count)}}]
            return "eval", path("tiny.dna"), "-i", write("frames%d.json" % count, json.dumps({"frames": frames}))
        self.fails(INVALID, *evaluate(60000), says='"n0"')
        self.grows_with_the_size(evaluate)
        twice = write("twice.json", '{"frames": [{"raw": {"0": 1, "0": 0}}]}')
        self.fails(INVALID, "eval", path("tiny.dna"), "-i", twice, says="twice")


class Expressions(LimitsTest):
    def test_expressions_with_many_controls(self):
        def export(count):
            source = write("expressions%d.json" % count, json.dumps({"aa": {"n%d" % i: 1 for i in range(count)}}))
            return "export", path("tiny.dna"), "--bake", source, "-o", path("no.glb")
        self.fails(INVALID, *export(20000), says="none of the expressions")
        self.grows_with_the_size(export)
        source = write("expressions.json", json.dumps({"e%d" % i: {"a": 1} for i in range(513)}))
        self.fails(INVALID, "export", path("tiny.dna"), "--bake", source, "-o", path("no.glb"),
                   says="more than 512 expressions")


class Scenes(LimitsTest):
    def test_large_scenes_are_refused_or_read_at_once(self):
        def scene(**members):
            return json.dumps({"layers": [], **members})
        layer = {"name": "a", "source": {"generator": "blink"}}

        def play(source):
            return "play", source, path("tiny.dna"), "-o", path("no.json")
        many = {"name%d" % i: 1 for i in range(60000)}
        for text, says in (
                (scene(layers=[layer] * 17), "at most 16"),
                (scene(layers=[{**layer, "name": "x" * 256}]), "255 bytes"),
                (scene(reactions=[{"name": "x" * 256, "preset": "glare"}]), "255 bytes"),
                (scene(layers=[{"name": "a", "source": {"poses": {"p": many}}}]), "name"),
                (scene(**many), "name0")):
            source = write("large.json", text)
            self.fails(INVALID, *play(source), says=says)
            self.assertLess(cost(*play(source))[1], 300e6, says)

        def many_members(count):
            members = {"name%d" % i: 1 for i in range(count)}
            return play(write("members%d.json" % count, scene(**members)))

        def many_names(count):
            poses = {"p": {"name%d" % i: 1 for i in range(count)}}
            layers = [{"name": "a", "source": {"poses": poses}}]
            return play(write("names%d.json" % count, scene(layers=layers)))
        self.grows_with_the_size(many_members)
        self.grows_with_the_size(many_names)


if __name__ == "__main__":
    main()
