#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What people see of the `mien` program: help, numbers, progress, and formats for other programs.

    manners_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)
"""
import csv
import io
import json
import os
import pty
import re
import shutil
import struct
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "tests", "support"))
import program  # noqa: E402
from program import (DONE, USAGE, FILE, ProgramTest, main,  # noqa: E402
                     make, make_folder, path, read, write)


def setUpModule():
    make_folder()
    for arguments in (["gen", "-o", path("small.dna"), "--preset", "small"],
                      ["gen", "-o", path("large.dna"), "--preset", "large"], ["demo-head", "-o", path("head.dna")],
                      ["bake", path("small.dna"), "-o", path("small.rig")]):
        make(*arguments)
    write("frames.json", '{"frames": [{}]}')


COMMANDS = ("info", "validate", "accept", "eval", "convert", "gen", "demo-head", "export", "render", "inspect", "bake", "bench",
            "view", "completion", "help", "clip", "clip build", "clip info", "clip verify", "clip export")


class Help(ProgramTest):
    def test_help_fits_80_columns(self):
        for command in ([],) + tuple(name.split() for name in COMMANDS):
            text = self.ok("help", *command).stdout.decode()
            self.assertLessEqual(max(len(line) for line in text.splitlines()), 80, command)
            self.assertGreater(len(text.splitlines()), 5)

    def test_examples_of_the_help_run(self):
        """All that read and write files; a few need other inputs."""
        work = path("examples")
        os.mkdir(work)
        shutil.copy(path("head.dna"), work)
        for name in ("frames.json", "take.json"):
            shutil.copy(path("frames.json"), os.path.join(work, name))
        subprocess.run([program.mien, "bake", "head.dna", "-o", "head.rig"], cwd=work, check=True)
        ran = 0
        for command in ("eval", "convert", "gen", "export", "bake", "inspect"):
            text = self.ok("help", command).stdout.decode()
            for line in text[text.index("Examples:"):].splitlines()[1:]:
                if "CTRL_C_jaw" in line or "take" in line and command != "eval":
                    continue
                # Some write other rigs of this name. A tolerance is measured in many poses.
                rig = "small.dna" if "--tolerance" in line else "head.dna"
                shutil.copy(path(rig), os.path.join(work, "head.dna"))
                line = line.strip().replace("mien ", '"$MIEN" ')
                done = subprocess.run(["bash", "-c", line], cwd=work, capture_output=True, check=False,
                                      env={**os.environ, "MIEN": program.mien})
                self.assertEqual(done.returncode, DONE, (line, done.stderr))
                ran += 1
        self.assertGreater(ran, 15)


class Terminal(ProgramTest):
    def on_terminal(self, *arguments):
        """What a person reads on standard error."""
        own, programs = pty.openpty()
        child = subprocess.Popen([program.mien, *arguments], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                 stderr=programs, env={**os.environ, "TERM": "xterm"})
        os.close(programs)
        text = b""
        while True:
            try:
                piece = os.read(own, 65536)
            except OSError:  # the other end is closed
                break
            if not piece:
                break
            text += piece
        os.close(own)
        self.assertEqual(child.wait(), DONE, text)
        return text.decode()

    def test_a_closing_line_names_the_file_its_size_and_the_time(self):
        out = path("closing.glb")
        commands = (["demo-head", "-o", out], ["gen", "-o", out], ["convert", path("small.dna"), "-o", out],
                    ["bake", path("small.dna"), "-o", out], ["export", path("small.dna"), "-o", out],
                    ["eval", path("small.dna"), "-i", path("frames.json"), "-o", out])
        for command in commands:
            lines = self.on_terminal(*command).splitlines()
            found = re.fullmatch(r"wrote (.*), ([0-9.]+) (KB|MB|bytes), ([0-9.]+) s", lines[-1].split("\033[K")[-1])
            self.assertTrue(found, lines)
            self.assertEqual(found[1], out)
            scale = {"bytes": 1, "KB": 1e3, "MB": 1e6}[found[3]]
            self.assertAlmostEqual(float(found[2]) * scale, os.path.getsize(out), delta=0.06 * scale)
            self.assertNotIn("wrote", self.on_terminal(*command, "--quiet"))
            self.assertNotIn("wrote", self.ok(*command).stderr)
        self.assertNotIn("wrote", self.on_terminal("gen", "-o", "-"))

    def test_what_takes_long_shows_how_far_it_is(self):
        command = ["bench", path("large.dna"), "--quick", "--lods", "0"]
        text = self.on_terminal(*command, "--isa", "all")  # more than the second after which a bar is shown
        self.assertRegex(text, r"measuring  \[=*>? *\] +\d+ %  \d+(\.\d)? s left")
        self.assertTrue(text.endswith("\r\033[K"), text[-80:])  # the line goes
        self.assertEqual(self.on_terminal(*command, "--quiet"), "")
        self.assertEqual(self.ok(*command).stderr, "")

    def test_what_is_short_shows_nothing(self):
        self.assertNotIn("[", self.on_terminal("gen", "-o", "-").replace("\033[K", ""))


class Numbers(ProgramTest):
    def test_large_numbers_have_separators_and_sizes_units(self):
        text = self.ok("info", path("head.dna")).stdout.decode()
        megabytes = f"{os.path.getsize(path('head.dna')) / 1e6:.1f}".replace(".", r"\.")
        self.assertRegex(text, f"size +{megabytes} MB, mapped; " + r"\d+\.\d MB of memory")
        self.assertRegex(text, r"vertices +\d\d,\d{3}\n")
        self.assertRegex(text, r"geom +1\.1 +\d{3},\d{3} +\d\d,\d{3},\d{3}\n")

    def test_inspect_states_its_order_and_leaves_out_what_is_tiny(self):
        text = self.ok("inspect", path("small.dna"), "jawOpen").stdout.decode()
        self.assertIn("the strongest first", text)
        self.assertIn("the largest first", text)
        found = json.loads(self.ok("inspect", path("small.dna"), "jawOpen", "--json").stdout)
        largest = max(joint["rotation"] for joint in found["joints"])
        for value in re.findall(r"([0-9.e+-]+) deg", text):
            self.assertGreaterEqual(float(value), largest / 1000)

    def test_bench_explains_its_columns_and_times_what_matters(self):
        text = self.ok("bench", path("large.dna"), "--quick").stdout.decode()
        for words in ("active: the share of raw controls", "x CSR: CSR time / evaluate", "compressed sparse rows"):
            self.assertIn(words, text)
        rows = [line.split() for line in text.splitlines() if re.match(r"\w+ +\d+ +\d+ %", line)]
        self.assertEqual(len({row[0] for row in rows}), 1)
        self.assertEqual([int(row[1]) for row in rows], [0] * 5 + [4] * 5 + [7] * 5 + [0])
        text = self.ok("bench", path("small.dna"), "--quick", "--storage", "f16", "--lods", "1").stdout.decode()
        self.assertRegex(text, r"\w+, 16 bits +0 ")


class Formats(ProgramTest):
    def setUp(self):
        names = self.ok("info", path("small.dna"), "--names", "raw").stdout.decode().split()
        frames = [{"raw": {names[i]: 0.5, "jawOpen": 0.25 * i}} for i in range(1, 4) if names[i] != "CTRL_expressions.jawOpen"]
        self.frames = write("take.json", json.dumps({"frames": frames}))
        self.expected = json.loads(self.ok("eval", path("small.dna"), "-i", self.frames, "--lod", "all").stdout)
        self.joints = self.ok("info", path("small.dna"), "--names", "joints").stdout.decode().split("\n")[:-1]
        self.lods = [(f, lod) for f, frame in enumerate(self.expected["frames"]) for lod in frame["lods"]]

    def evaluate(self, *options):
        return self.ok("eval", path("small.dna"), "-i", self.frames, "--lod", "all", *options).stdout

    def test_csv_has_names_and_the_same_numbers(self):
        rows = list(csv.reader(io.StringIO(self.evaluate("--format", "csv").decode())))
        self.assertEqual(rows[0][:4], ["frame", "lod", self.joints[0] + ".tx", self.joints[0] + ".ty"])
        self.assertEqual(rows[0][2 + 9 * len(self.joints) - 1], self.joints[-1] + ".sz")
        self.assertEqual(len(rows) - 1, len(self.lods))
        for row, (frame, lod) in zip(rows[1:], self.lods):
            self.assertEqual(len(row), len(rows[0]))
            self.assertEqual([int(row[0]), int(row[1])], [frame, lod["lod"]])
            self.assertEqual([float(v) for v in row[2:]], lod["joints"] + lod["blend_shapes"] + lod["animated_maps"])
        header = self.evaluate("--format", "csv", "--rotation", "quaternion").decode().splitlines()[0].split(",")
        self.assertEqual(header[2:12], [self.joints[0] + "." + v for v in "tx ty tz qx qy qz qw sx sy sz".split()])

    def test_json_lines(self):
        lines = [json.loads(line) for line in self.evaluate("--format", "jsonl").decode().splitlines()]
        self.assertEqual(lines[0]["joints"], self.joints)
        self.assertEqual(lines[0]["rotation"], "euler")
        self.assertEqual(len(lines) - 1, len(self.lods))
        for line, (frame, lod) in zip(lines[1:], self.lods):
            self.assertEqual((line["frame"], line["lod"], line["joints"]), (frame, lod["lod"], lod["joints"]))
            self.assertEqual(line["blend_shapes"], lod["blend_shapes"])

    def test_npy(self):
        out = path("take.npy")
        self.evaluate("-o", out)  # the name tells the format
        content = read("take.npy")
        self.assertEqual(content[:8], b"\x93NUMPY\x01\x00")
        start = 10 + struct.unpack_from("<H", content, 8)[0]
        self.assertEqual(start % 64, 0)
        header = eval(content[10:start].decode(), {"__builtins__": {}})  # a literal, as NumPy reads it
        self.assertEqual(header, {"descr": "<f4", "fortran_order": False, "shape": (len(self.lods), len(self.joints), 9)})
        values = struct.unpack_from("<%df" % ((len(content) - start) // 4), content, start)
        self.assertEqual(list(values), [value for _, lod in self.lods for value in lod["joints"]])

    def test_wrong_formats(self):
        self.fails(USAGE, "eval", path("small.dna"), "-i", self.frames, "--format", "xml", says="jsonl")

    def test_obj_files_have_materials(self):
        self.ok("export", path("head.dna"), "-o", path("face.obj"), "--lod", "3")
        obj, mtl = read("face.obj").decode(), read("face.mtl").decode()
        self.assertIn("\nmtllib face.mtl\n", obj)
        used, made = set(re.findall(r"^usemtl (.*)$", obj, re.M)), re.findall(r"^newmtl (.*)$", mtl, re.M)
        self.assertEqual(sorted(used), sorted(made))
        self.assertGreater(len(made), 4)
        for numbers in re.findall(r"^Kd (.*)$", mtl, re.M):
            self.assertTrue(all(0 <= float(number) <= 1 for number in numbers.split()))
        piped = self.ok("export", path("head.dna"), "-o", "-", "--format", "obj", "--lod", "3").stdout
        self.assertNotIn(b"mtllib", piped)
        write("taken.mtl", "precious")
        os.chmod(path("taken.mtl"), 0o444)
        self.fails(FILE, "export", path("head.dna"), "-o", path("taken.obj"), says="taken.mtl")


if __name__ == "__main__":
    main()
