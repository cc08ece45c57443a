#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Odd uses of the `mien` program: endless inputs, outputs that would destroy something, slips of the hand.

    traps_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)
"""
import json
import os
import shutil
import stat
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "tests", "support"))
import program  # noqa: E402
from program import (DONE, USAGE, INVALID, FILE, ProgramTest, long_form, main,  # noqa: E402
                     make, make_folder, path, read, run, write)


def setUpModule():
    make_folder()
    for arguments in (["gen", "-o", path("small.dna"), "--preset", "small"], ["demo-head", "-o", path("head.dna")],
                      ["bake", path("small.dna"), "-o", path("small.rig")]):
        make(*arguments)
    write("frames.json", '{"frames": [{}]}')


class EndlessInputs(ProgramTest):
    def pipe(self, piece, *arguments):
        """Runs the program with `piece` repeated for ever as its input; returns its failure."""
        child = subprocess.Popen([program.mien, *arguments], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
                                 stderr=subprocess.PIPE)
        written = 0
        try:
            while True:
                written += os.write(child.stdin.fileno(), piece)
        except BrokenPipeError:
            pass
        child.stdin.close()
        error = child.stderr.read().decode()
        child.stderr.close()
        return child.wait(), error, written

    def test_what_is_no_rig_is_told_by_its_first_bytes(self):
        for command in (["info"], ["validate"], ["convert", "-o", path("x")], ["bake", "-o", path("x")],
                        ["eval", "-i", path("frames.json")], ["render", "-o", path("x.png")],
                        ["export", "-o", path("x.glb")], ["bench"]):
            code, error, written = self.pipe(b"y\n" * 4096, command[0], "-", *command[1:])
            self.assertEqual(code, INVALID, error)
            self.assertLess(written, 1 << 20)
            self.fails(INVALID, command[0], "/dev/zero", *command[1:], says="/dev/zero")

    def test_what_is_no_json_is_told_by_its_first_bytes(self):
        self.fails(INVALID, "eval", path("small.dna"), "-i", "/dev/zero", says="byte 1")
        code, error, written = self.pipe(b"y\n" * 4096, "eval", path("small.dna"), "-i", "-")
        self.assertEqual(code, INVALID, error)
        self.assertLess(written, 1 << 20)

    @long_form
    def test_json_from_a_pipe_has_a_largest_size(self):
        code, error, written = self.pipe(b" " * (1 << 20), "eval", path("small.dna"), "-i", "-")
        self.assertEqual(code, INVALID, error)
        self.assertIn("512 MiB", error)
        self.assertLess(written, 514 << 20)

    def test_json_has_a_largest_size(self):
        with open(path("sparse.json"), "wb") as file:
            file.write(b"{")
            file.truncate(513 << 20)
        self.fails(INVALID, "eval", path("small.dna"), "-i", path("sparse.json"), says="512 MiB")
        os.remove(path("sparse.json"))

    def test_pipes_with_names_are_read_as_well(self):
        command = '"$1" info --json <(cat "$2") && "$1" eval "$2" -i <(echo "{\\"frames\\": []}")'
        done = subprocess.run(["bash", "-c", command, "bash", program.mien, path("small.dna")], capture_output=True, check=False)
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertIn(b'"frames": []', done.stdout)


class Outputs(ProgramTest):
    def test_an_output_that_is_an_input_is_refused(self):
        shutil.copy(path("head.dna"), path("mine.dna"))
        os.symlink("mine.dna", path("link.dna"))
        write("mine.json", '{"frames": [{}]}')
        mine, link = path("mine.dna"), path("link.dna")
        before = read("mine.dna")
        for command in (["export", mine, "-o", mine, "--format", "glb"], ["bake", mine, "-o", mine],
                        ["bake", link, "-o", mine], ["bake", mine, "-o", link],
                        ["eval", mine, "-i", path("mine.json"), "-o", path("mine.json")],
                        ["eval", mine, "-i", path("mine.json"), "-o", mine],
                        ["export", mine, "--animation", path("mine.json"), "-o", path("mine.json"), "--format", "glb"]):
            self.fails(USAGE, *command, says=("also an input", "--force"))
        # Images have names of their own.
        shutil.copy(mine, path("mine.png"))
        for command in (["render", path("mine.png"), "-o", path("mine.png")],
                        ["inspect", path("mine.png"), "jawOpen", "-o", path("mine.png")]):
            self.fails(USAGE, *command, says="also an input")
        self.assertEqual(read("mine.dna"), before)
        self.assertEqual(read("mine.png"), before)
        self.ok("bake", mine, "-o", mine, "--force")
        self.assertEqual(read("mine.dna")[:8], b"MIENBAKE")

    def test_a_file_is_converted_in_place(self):
        shutil.copy(path("small.dna"), path("place.dna"))
        self.ok("convert", path("place.dna"), "-o", path("place.dna"), "--version", "2.2")
        self.assertEqual(json.loads(self.ok("info", path("place.dna"), "--json").stdout)["version"], "2.2")

    def test_a_read_only_file_is_refused(self):
        write("keep", "precious")
        os.chmod(path("keep"), 0o444)
        for command in (["gen"], ["demo-head"], ["convert", path("small.dna")], ["bake", path("small.dna")],
                        ["eval", path("small.dna"), "-i", path("frames.json")]):
            self.fails(FILE, *command, "-o", path("keep"), says=("read-only", "--force"))
        self.assertEqual(read("keep"), b"precious")
        self.ok("gen", "-o", path("keep"), "--force")
        self.assertEqual(read("keep")[:3], b"DNA")
        self.assertEqual(stat.S_IMODE(os.stat(path("keep")).st_mode), 0o444)

    def test_images_are_named_png(self):
        for name in ("r.jpg", "r.JPEG", "r.dna", "r.webp"):
            self.fails(USAGE, "render", path("head.dna"), "-o", path(name), says=".png")
            self.fails(USAGE, "inspect", path("head.dna"), "jawOpen", "-o", path(name), says=".png")
            self.assertFalse(os.path.exists(path(name)))
        self.ok("render", path("head.dna"), "-o", path("R.PNG"), "--size", "32", "--lod", "7")
        self.assertEqual(read("R.PNG")[:4], b"\x89PNG")


class Slips(ProgramTest):
    def frames(self, text, *options):
        return ("eval", path("small.dna"), "-i", write("slip.json", text), *options)

    def test_controls_are_set_once_and_in_reason(self):
        png = ["-o", path("slip.png"), "--size", "32", "--lod", "7"]
        for value in ("1e30", "-1e30", "1001", "inf", "nan", "1e999"):
            self.fails(USAGE, "render", path("head.dna"), "--set", "jawOpen=" + value, *png, says="-1000 to 1000")
            self.fails(USAGE, "inspect", path("head.dna"), "jawOpen", "--value", value, says="-1000 to 1000")
        self.fails(USAGE, "render", path("head.dna"), "--set", "jawOpen=1", "--set", "jawOpen=0", *png, says="twice")
        self.fails(USAGE, "export", path("small.dna"), "--set", "jawOpen=1", "--set", "CTRL_expressions.jawOpen=1",
                   "-o", path("x.glb"), says="twice")
        self.ok("render", path("head.dna"), "--set", "jawOpen=1", "--set", "jawLeft=1", *png)

    def test_short_names_resolve_in_frames(self):
        long = self.ok(*self.frames('{"frames": [{"raw": {"CTRL_expressions.jawOpen": 1}}]}')).stdout
        self.assertEqual(self.ok(*self.frames('{"frames": [{"raw": {"jawOpen": 1}}]}')).stdout, long)
        self.assertNotEqual(self.ok(*self.frames('{"frames": [{}]}')).stdout, long)
        self.fails(INVALID, *self.frames('{"frames": [{"raw": {"jawOpn": 1}}]}'),
                   says='did you mean "CTRL_expressions.jawOpen"')
        self.fails(INVALID, *self.frames('{"frames": [{"gui": {"ty": 1}}]}'), says=("ambiguous", ".ty"))

    def test_keys_of_frames_are_known_and_stand_once(self):
        self.fails(INVALID, *self.frames('{"frames": [], "fps": 30}'), says='"fps"')
        self.fails(INVALID, *self.frames('{"frame": [], "frames": []}'), says='did you mean "frames"')
        self.fails(INVALID, *self.frames('{"frames": [{}], "frames": []}'), says='"frames" twice')
        self.fails(INVALID, *self.frames('{"frames": [{"raw": {"jawOpen": 1, "jawOpen": 0}}]}'), says='"jawOpen" twice')
        self.fails(INVALID, *self.frames('{"frames": [{"raw": {"jawOpen": 1, "CTRL_expressions.jawOpen": 0}}]}'),
                   says="twice")
        self.fails(INVALID, *self.frames('{"frames": [{"gui": {}, "raw_after_gui": {"0": 1, "00": 0}}]}'), says="twice")
        # What `mien play` writes beside the controls.
        self.ok(*self.frames('{"rig": "a", "rate": 60, "controls": [], "variables": [], "events": [], '
                             '"frames": [{"time": 0.0, "raw": {}, "variables": [], "stages": {}}]}'))

    def test_numbers_past_the_range_have_a_place(self):
        text = '{"frames": [{"raw": {"jawOpen": 1e999}}]}'
        self.fails(INVALID, *self.frames(text), says="byte %d" % (text.index("1e999") + 5))

    def test_exit_codes_tell_usage_from_what_a_file_lacks(self):
        head, frames, png = path("head.dna"), path("frames.json"), path("lod.png")
        for lod, code in (("99", USAGE), ("33", USAGE), ("99999999999999999999", USAGE), ("x", USAGE), ("8", INVALID)):
            self.fails(code, "eval", head, "-i", frames, "--lod", lod, says="LOD")
            self.fails(code, "render", head, "-o", png, "--lod", lod)
            self.fails(code, "export", head, "-o", path("lod.glb"), "--lod", lod)
            self.fails(code, "info", head, "--lods", lod)
            self.fails(code, "info", head, "--max-lod", lod)
        self.fails(INVALID, "render", head, "-o", png, "--set", "jawOpn=1", says='did you mean "jawOpen"')
        self.fails(INVALID, "inspect", head, "jawOpn", says='did you mean "jawOpen"')

    def test_messages_do_not_contradict_themselves(self):
        head, png = path("head.dna"), path("message.png")
        self.fails(USAGE, "render", head, "-o", png, "--camera", "0,0,0", says='zoom "0" is not a number from 0.1 to 20')
        self.fails(USAGE, "eval", head, "-i", path("frames.json"), "--lod", "ALL", says='did you mean "all"')
        self.fails(USAGE, "render", head, "-o", png, "--lod", "all", says="count from 0")
        done = self.fails(INVALID, "info", path("small.dna"), "--system", "unity", "--rotation-order", "exact")
        self.assertNotIn("validate", done.stderr)
        self.assertIn("--rotation-order", done.stderr)

    def test_metadata_is_shortened(self):
        text = self.ok("info", path("head.dna")).stdout
        self.assertLess(max(len(line) for line in text.splitlines()), 200)
        self.assertIn(b"--full", text)
        full = self.ok("info", path("head.dna"), "--full").stdout
        self.assertGreater(max(len(line) for line in full.splitlines()), 10000)
        self.assertNotIn(b"--full", full)


class Validate(ProgramTest):
    def test_several_files(self):
        cut = write("cut.dna", read("small.dna")[:-10])
        small, head, missing = path("small.dna"), path("head.dna"), path("missing.dna")
        text = self.ok("validate", small, head).stdout.decode()
        self.assertEqual([line.rsplit(": ", 1)[1] for line in text.splitlines()], ["valid", "valid"])
        reports = json.loads(self.ok("validate", small, head, "--json").stdout)
        self.assertEqual([(report["file"], report["valid"]) for report in reports], [(small, True), (head, True)])
        done = run("validate", cut, missing, head)
        self.assertEqual(done.returncode, FILE)
        self.assertIn("head.dna: valid", done.stdout.decode())
        self.assertEqual(len(done.stderr.splitlines()), 2, done.stderr)
        self.assertEqual(run("validate", head, cut).returncode, INVALID)
        reports = json.loads(run("validate", cut, missing, head, "--json").stdout)
        self.assertEqual([report["valid"] for report in reports], [False, True])

    def test_baked_files(self):
        self.assertIn(b"valid baked file", self.ok("validate", path("small.rig")).stdout)
        self.assertTrue(json.loads(self.ok("validate", path("small.rig"), "--json").stdout)["valid"])
        broken = write("broken.rig", read("small.rig")[:-100])
        done = self.fails(INVALID, "validate", broken)
        self.assertNotIn("repair", done.stderr)
        self.assertEqual(self.fails(INVALID, "validate", broken, "--json").stdout, b"")


if __name__ == "__main__":
    main()
