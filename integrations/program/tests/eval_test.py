#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien eval`: what it takes, what it computes and writes, and every wrong frame.

    eval_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)

All rigs come from `mien gen`.
"""
import json
import os
import random
import shutil
import signal
import struct
import subprocess
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "tests", "support"))
import program  # noqa: E402
from program import (DONE, USAGE, INVALID, ProgramTest, main, make,  # noqa: E402
                     make_folder, path, read, run, write)


def setUpModule():
    make_folder()
    for preset in ("tiny", "small", "medium", "large"):
        make("gen", "-o", path(preset + ".dna"), "--preset", preset)


def float32(number):
    return struct.unpack("<f", struct.pack("<f", number))[0]


class Eval(ProgramTest):
    def test_shape(self):
        info = self.json("info", path("small.dna"), "--json")
        counts = info["counts"]
        sizes = {"raw": counts["raw_controls"], "psd": counts["psd_controls"], "ml": counts["ml_controls"],
                 "rbf": counts["rbf_controls"], "joints": 9 * counts["joints"],
                 "blend_shapes": counts["blend_shape_channels"], "animated_maps": counts["animated_maps"]}
        result = self.evaluate("small.dna", [{}, {"raw": {}}], "--lod", "all")
        self.assertEqual(list(result), ["rig", "version", "lod_count", "rotation", "arithmetic", "frames"])
        self.assertEqual((result["rig"], result["version"]), (info["name"], "2.8"))
        self.assertEqual((result["rotation"], result["lod_count"]), ("euler", info["lod_count"]))
        self.assertEqual(len(result["frames"]), 2)
        for frame in result["frames"]:
            self.assertEqual([lod["lod"] for lod in frame["lods"]], list(range(info["lod_count"])))
            for lod in frame["lods"]:
                self.assertEqual(list(lod), ["lod"] + list(sizes))
                for key, size in sizes.items():
                    self.assertEqual(len(lod[key]), size, key)
                    self.assertFalse(any(lod[key]), key)  # neutral

    def test_by_name_and_by_number_are_the_same(self):
        names = self.names("small.dna", "raw")
        values = [float32(0.3 + 0.5 * i / len(names)) for i in range(len(names))]
        by_number = self.evaluate_one("small.dna", {"raw": values})
        by_name = self.evaluate_one("small.dna", {"raw": dict(reversed(list(zip(names, values))))})
        self.assertEqual(by_number, by_name)
        self.assertTrue(any(by_number["joints"]) and any(by_number["psd"]))
        self.assertTrue(any(by_number["blend_shapes"]) and any(by_number["animated_maps"]))
        one = self.evaluate_one("small.dna", {"raw": {names[4]: 0.5}})["raw"]
        self.assertEqual(one, [0.5 if i == 4 else 0 for i in range(len(names))])

    def test_numbers_come_back_as_the_same_float(self):
        names = self.names("tiny.dna", "raw")
        chance = random.Random(5)
        values = [struct.unpack("<f", struct.pack("<I", chance.randrange(0x00000001, 0x3f800000)))[0]
                  for _ in names]
        raw = self.evaluate_one("tiny.dna", {"raw": values})["raw"]
        self.assertEqual([struct.pack("<f", number) for number in raw],
                         [struct.pack("<f", number) for number in values])
        text = self.ok("eval", path("tiny.dna"), "-i", "-", stdin=json.dumps(
            {"frames": [{"raw": [0.1] * len(names)}]}).encode()).stdout.decode()
        # Read as a double it is the very float, which 0.1 and 0.100000001 are not.
        self.assertIn("[0.10000000149011612,", text)

    def test_gui_frames(self):
        gui, raw = self.names("small.dna", "gui"), self.names("small.dna", "raw")
        everything = [0.5] * len(gui)
        mapped = self.evaluate_one("small.dna", {"gui": everything})["raw"]
        self.assertTrue(any(mapped))
        self.assertEqual(self.evaluate_one("small.dna", {"gui": dict(zip(gui, everything))})["raw"], mapped)
        # The result is that of the mapped raw controls.
        by_gui = self.evaluate_one("small.dna", {"gui": everything})
        self.assertEqual(self.evaluate_one("small.dna", {"raw": mapped}), by_gui)
        after = self.evaluate_one("small.dna", {"gui": everything, "raw_after_gui": {"3": 0.25, raw[1]: 0.75}})
        expected = list(mapped)
        expected[3], expected[1] = 0.25, 0.75
        self.assertEqual(after["raw"], expected)

    def test_frames_and_lods_start_afresh(self):
        names = self.names("small.dna", "raw")
        frames = [{"raw": [0.9] * len(names)}, {"raw": {names[0]: 0.5}}, {"gui": [1.0] * len(self.names("small.dna", "gui"))}, {}]
        together = self.evaluate("small.dna", frames, "--lod", "all")["frames"]
        self.assertEqual([[frame["lods"][0]] for frame in together],
                         [frame["lods"] for frame in self.evaluate("small.dna", frames)["frames"]])
        for i, frame in enumerate(frames):
            for lod in together[i]["lods"]:
                self.assertEqual(lod, self.evaluate_one("small.dna", frame, lod["lod"]))
        self.assertFalse(any(together[3]["lods"][0]["raw"]))

    def test_instruction_sets_agree(self):
        frames = [{"raw": [(i * 7 % 11) / 10 for i in range(len(self.names("medium.dna", "raw")))]}]
        reference = self.evaluate("medium.dna", frames, "--isa", "scalar", "--lod", "all")["frames"][0]["lods"]
        compared = 0
        for isa in ("sse2", "avx2", "avx512", "neon"):
            if run("info", path("tiny.dna"), "--isa", isa).returncode != DONE:
                continue
            compared += 1
            for mine, scalar in zip(self.evaluate("medium.dna", frames, "--isa", isa, "--lod", "all")["frames"][0]["lods"], reference):
                for key in ("psd", "joints", "blend_shapes", "animated_maps"):
                    largest = max(map(abs, scalar[key]), default=0)
                    for a, b in zip(mine[key], scalar[key]):
                        self.assertLessEqual(abs(a - b), 1e-5 + 1e-5 * largest, (isa, key))
        self.assertGreater(compared, 0)

    def test_portable_arithmetic_has_the_same_bits_everywhere(self):
        frames = [{"raw": [(i * 7 % 11) / 10 for i in range(len(self.names("medium.dna", "raw")))]}]
        fast = self.evaluate("medium.dna", frames)
        self.assertEqual(fast["arithmetic"], "fast")
        portable = ["--arithmetic", "portable"]
        reference = self.evaluate("medium.dna", frames, "--isa", "scalar", *portable)
        self.assertEqual(reference["arithmetic"], "portable")
        self.assertEqual(self.evaluate("medium.dna", frames, *portable), reference)
        baked = path("portable.rig")
        self.ok("bake", path("medium.dna"), "-o", baked, *portable)
        self.assertEqual(self.evaluate("portable.rig", frames, *portable)["frames"], reference["frames"])
        self.assertEqual(self.json("info", baked, "--json")["arithmetic"], "portable")
        self.ok("bake", path("medium.dna"), "-o", path("fast.rig"))
        self.fails(USAGE, "info", path("fast.rig"), *portable, says=("--arithmetic portable", "bake again"))

    def test_geometry_is_not_needed(self):
        self.ok("convert", path("small.dna"), "-o", path("lean.dna"), "--layers", "behavior")
        frame = {"raw": [0.5] * len(self.names("small.dna", "raw"))}
        self.assertEqual(self.evaluate_one("lean.dna", frame), self.evaluate_one("small.dna", frame))
        self.assertEqual(self.evaluate("small.dna", [frame], "--layers", "all"),
                         self.evaluate("small.dna", [frame]))

    def test_input_and_output(self):
        frames = write("one.json", '{"frames": [{}], "rate": 60}')
        self.ok("eval", path("tiny.dna"), "--input", frames, "-o", path("out.json"))
        by_pipe = self.ok("eval", "-", "--input", frames, stdin=read("tiny.dna")).stdout
        self.assertEqual(read("out.json"), by_pipe)
        by_input = self.ok("eval", path("tiny.dna"), "--input", "-", "-o", "-", stdin=read("one.json")).stdout
        self.assertEqual(by_input, by_pipe)
        self.assertEqual(self.evaluate("tiny.dna", [])["frames"], [])

    def refused(self, frame, *says):
        text = frame if isinstance(frame, (str, bytes)) else json.dumps({"frames": [{}, frame]})
        text = text.encode() if isinstance(text, str) else text
        write("old.json", "old")
        done = self.fails(INVALID, "eval", path("tiny.dna"), "--input", "-", "-o", path("old.json"),
                          stdin=text, says=says)
        self.assertEqual(read("old.json"), b"old")
        self.assertEqual([name for name in os.listdir(program.folder) if name.startswith(".mien")], [])
        return done

    def test_unknown_names(self):
        raw, gui = self.names("tiny.dna", "raw")[2], self.names("tiny.dna", "gui")[1]
        self.refused({"raw": {raw[:-1] + "x": 1}}, "frames[1].raw", raw[:-1] + "x", 'did you mean "')
        self.refused({"raw": {raw.upper(): 1}}, 'did you mean "%s"' % raw)
        self.refused({"gui": {gui[1:]: 1}}, "frames[1].gui", 'did you mean "%s"' % gui)
        self.refused({"gui": {}, "raw_after_gui": {"completely different": 1}}, "--names raw")
        self.refused({"raw": {"3": 1}}, '"3"')
        self.refused({"raws": {}}, 'did you mean "raw"')
        self.refused({"something": {}}, "something")

    def test_wrong_counts_and_indices(self):
        raw, gui = len(self.names("tiny.dna", "raw")), len(self.names("tiny.dna", "gui"))
        self.refused({"raw": [0] * (raw + 1)}, "%d numbers given, %d expected" % (raw + 1, raw))
        self.refused({"raw": []}, "0 numbers given, %d expected" % raw)
        self.refused({"gui": [0] * (gui - 1)}, "%d numbers given, %d expected" % (gui - 1, gui))
        self.refused({"ml_mask": [1]}, "1 numbers given, 0 expected")
        self.refused({"gui": {}, "raw_after_gui": {str(raw): 1}}, str(raw), "out of range")
        self.refused({"gui": {}, "raw_after_gui": {"99999999999999999999": 1}}, "out of range")
        self.ok("eval", path("tiny.dna"), "--input", "-", stdin=b'{"frames": [{"ml_mask": []}]}')
        self.fails(INVALID, "eval", path("tiny.dna"), "--input", "-", "--lod", "3", says=("LOD 3", "there are 3"))

    def test_wrong_json(self):
        count = len(self.names("tiny.dna", "raw"))
        def with_number(text):
            return '{"frames": [{"raw": [%s]}]}' % ",".join([text] * count)
        self.refused("", "byte")
        self.refused("{", "byte 2")
        self.refused("[]", "frames")
        self.refused("{}", "frames")
        self.refused('{"frames": {}}', "frames")
        self.refused('{"frames": [[]]}', "frames[0]")
        self.refused('{"frames": [{}]} {}', "byte")
        self.refused(b'{"frames": [{"raw": {"\xff": 1}}]}', "byte", "\\xff")
        for number in ("NaN", "nan", "Infinity", "-Infinity", "1e999", "-1e999", "1e39", "3.5e38", "0x1"):
            self.refused(with_number(number))
        for value in ("true", "null", '"1"', "[1]", "{}"):
            self.refused(with_number(value), "frames[0].raw[0]", "number")
        self.refused({"raw": 1}, "frames[1].raw")
        self.refused({"raw": None}, "frames[1].raw")
        self.refused({"gui": {}, "raw_after_gui": [1]}, "raw_after_gui")
        self.refused({"raw": {}, "gui": {}}, "both")
        self.refused({"raw_after_gui": {}}, "without gui")
        self.ok("eval", path("tiny.dna"), "--input", "-", stdin=with_number("1e-50").encode())

    def test_what_overflows_saturates(self):
        lod = self.evaluate_one("tiny.dna", {"raw": [3.4e38] * len(self.names("tiny.dna", "raw"))})
        largest = max(abs(value) for value in lod["joints"])
        self.assertGreater(largest, 3e38)
        self.assertLess(largest, 3.5e38)

    def has_open_output(self, child):
        """Waits until the program has opened its temporary file, with a name or without."""
        files = "/proc/%d/fd" % child.pid
        for _ in range(2000):
            for number in os.listdir(files):
                try:
                    target = os.readlink(os.path.join(files, number))
                except OSError:
                    continue
                if target.startswith(program.folder) and ("(deleted)" in target or "/.mien-" in target):
                    return True
            time.sleep(0.005)
        return False

    def test_a_killed_process_leaves_nothing_behind(self):
        try:
            os.close(os.open(program.folder, os.O_TMPFILE | os.O_WRONLY))
        except OSError:
            self.skipTest("NOT TESTED: a killed process; this file system has no files without names")
        child = subprocess.Popen([program.mien, "eval", path("large.dna"), "--input", "-", "-o", path("never.json")],
                                 stdin=subprocess.PIPE, stderr=subprocess.DEVNULL)
        frames = [{"raw": [0.5] * len(self.names("large.dna", "raw"))}] * 400
        child.stdin.write(json.dumps({"frames": frames}).encode())
        child.stdin.close()
        self.assertTrue(self.has_open_output(child))
        child.kill()
        self.assertEqual(child.wait(), -signal.SIGKILL)
        self.assertEqual([name for name in os.listdir(program.folder) if name.startswith(".mien")], [])
        self.assertFalse(os.path.exists(path("never.json")))

    def test_files_of_killed_processes_are_removed(self):
        """Where files have names from the start. Only what is old, of no living process, and named so."""
        if not shutil.which("cc"):
            self.skipTest("NOT TESTED: files that killed processes left; there is no C compiler")
        source = write("named.c", """
            #define _GNU_SOURCE
            #include <errno.h>
            #include <fcntl.h>
            #include <sys/syscall.h>
            #include <unistd.h>
            int open(const char* path, int flags, ...) {
              if ((flags & O_TMPFILE) == O_TMPFILE) return errno = EOPNOTSUPP, -1;
              return (int)syscall(SYS_openat, AT_FDCWD, path, flags, 0666);
            }""")
        subprocess.run(["cc", "-shared", "-fPIC", source, "-o", path("named.so")], check=True)
        child = subprocess.Popen(["true"])
        child.wait()
        living = os.getpid()
        names = {".mien-%d-0" % child.pid: True, ".mien-%d-1" % child.pid: False, ".mien-%d-0" % living: False,
                 ".mien-%d-0x" % child.pid: False, "mien-%d-0" % child.pid: False}
        for name in names:
            os.utime(write(name, "old"), (0, 0))
        os.utime(path(".mien-%d-1" % child.pid))  # young
        self.ok("eval", path("tiny.dna"), "--input", "-", "-o", path("out.json"), stdin=b'{"frames": [{}]}',
                env={"LD_PRELOAD": path("named.so")})
        for name, removed in names.items():
            self.assertEqual(os.path.exists(path(name)), not removed, name)
            if not removed:
                os.remove(path(name))

    def test_an_interrupt_leaves_nothing_behind(self):
        target = path("never.json")
        frames = [{"raw": [0.5] * len(self.names("large.dna", "raw"))}] * 400
        frames = write("many.json", json.dumps({"frames": frames}))
        child = subprocess.Popen([program.mien, "eval", path("large.dna"), "--input", frames, "-o", target],
                                 stderr=subprocess.DEVNULL)
        self.assertTrue(self.has_open_output(child))
        child.send_signal(signal.SIGTERM)
        self.assertEqual(child.wait(), -signal.SIGTERM)
        self.assertEqual([name for name in os.listdir(program.folder) if name.startswith(".mien")], [])
        self.assertFalse(os.path.exists(target))


if __name__ == "__main__":
    main()
