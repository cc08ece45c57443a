#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What all commands share, and `mien info`, `validate`, `gen`, `bench` and `completion`.

    commands_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)

All rigs come from `mien gen`.
"""
import json
import math
import os
import random
import resource
import shutil
import stat
import struct
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "tests", "support"))
import program  # noqa: E402
from program import (DONE, USAGE, INVALID, FILE, INTERNAL, ProgramTest, main,  # noqa: E402
                     make, make_folder, path, read, run, write)

PRESETS = ("tiny", "small", "medium", "large", "body")


def setUpModule():
    make_folder()
    for preset in PRESETS:
        make("gen", "-o", path(preset + ".dna"), "--preset", preset)


class General(ProgramTest):
    def test_help_and_version_end_well(self):
        text = self.ok("--help").stdout.decode()
        for command in ("info", "validate", "eval", "convert", "gen", "demo-head", "bench", "completion"):
            self.assertIn("\n  " + command + " ", text)
            help_text = self.ok(command, "--help").stdout
            self.assertIn(b"Examples:", help_text)
            self.assertIn(b"mien " + command.encode(), help_text)
            self.assertEqual(self.ok("help", command).stdout, help_text)
        self.assertIn("Subcommands:", self.ok("help").stdout.decode())
        bare = run()
        self.assertEqual((bare.returncode, bare.stderr), (USAGE, ""))
        self.assertEqual(bare.stdout, self.ok("help").stdout)
        self.assertRegex(self.ok("--version").stdout.decode(), r"^mien \d+\.\d+\.\d+\n$")

    def test_layer_words_are_in_the_help(self):
        text = self.ok("info", "--help").stdout.decode()
        for word in ("descriptor", "definition", "behavior", "geometry", "ml", "rbf",
                     "geometry-without-blend-shapes", "joint-metadata", "twist-swing", "all"):
            self.assertIn(word, text)
            self.ok("info", path("tiny.dna"), "--layers", word)

    def test_wrong_usage(self):
        tiny = path("tiny.dna")
        self.fails(USAGE, "--quiet", says="no command")
        self.fails(USAGE, "evl", says='did you mean "eval"')
        self.fails(USAGE, "help", "evl", says='did you mean "eval"')
        self.fails(USAGE, "--nope", says="--nope")
        self.fails(USAGE, "info", says="RIG is required")
        self.fails(USAGE, "info", tiny, "more", says="more")
        self.fails(USAGE, "info", tiny, "--jsn", says='did you mean "--json"')
        self.fails(USAGE, "info", tiny, "--names", "jints", says='did you mean "joints"')
        self.fails(USAGE, "eval", tiny, says="--input")
        self.fails(USAGE, "eval", tiny, "--inptu", "x", says='did you mean "--input"')
        self.fails(USAGE, "eval", tiny, "--input", "-", "--lod", "first", says="--lod")
        self.fails(USAGE, "eval", "-", "--input", "-", says="standard input")
        self.fails(USAGE, "eval", tiny, "--input", "-", "--layers", "geometry", says="behavior")
        self.fails(USAGE, "convert", tiny, says="--output")
        self.fails(USAGE, "convert", tiny, "-o", "", says="empty")
        self.fails(USAGE, "convert", tiny, "-o", path("x"), "--version", "2.9", says="2.9")
        self.fails(USAGE, "convert", tiny, "-o", path("x"), "--version", "2", says="2.1")
        self.fails(USAGE, "convert", tiny, "-o", path("x"), "--unknown", "maybe", says="keep")
        self.fails(USAGE, "gen", says="--output")
        self.fails(USAGE, "gen", "-o", path("x"), "--preset", "larg", says='did you mean "large"')
        self.fails(USAGE, "gen", "-o", path("x"), "--seed", "-1")
        self.fails(USAGE, "gen", "-o", path("x"), "--seed", "1.5", says="1.5")
        self.fails(USAGE, "gen", "-o", path("x"), "--seed", "18446744073709551616")
        self.fails(USAGE, "demo-head", says="--output")
        self.fails(USAGE, "demo-head", "-o", path("x"), "--seed", "x", says="x")
        self.fails(USAGE, "demo-head", "-o", path("x"), "--preset", "tiny", says="--preset")
        self.fails(USAGE, "completion", "csh", says='did you mean "zsh"')
        self.assertFalse(os.path.exists(path("x")))

    def test_wrong_choices_of_what_to_load(self):
        tiny = path("tiny.dna")
        self.fails(USAGE, "info", tiny, "--layers", "behavor", says='did you mean "behavior"')
        self.fails(USAGE, "info", tiny, "--layers", "geometry,,rbf")
        self.fails(USAGE, "info", tiny, "--layers", "geometry,geometry-without-blend-shapes")
        self.fails(USAGE, "info", tiny, "--lods", "1,x", says='"x"')
        self.fails(USAGE, "info", tiny, "--lods", "2-1", says="1-2")
        self.fails(USAGE, "info", tiny, "--lods", "-1")
        self.fails(USAGE, "info", tiny, "--max-lod", "2", "--min-lod", "1", says="finest")
        self.fails(INVALID, "info", tiny, "--lods", "9", says="3")
        self.fails(USAGE, "info", tiny, "--lods", "1000", says="LOD 32 is the last")
        self.fails(INVALID, "info", tiny, "--max-lod", "3", says="LOD")

    def test_words_that_options_do_not_take_are_refused(self):
        tiny = path("tiny.dna")
        for command in (["eval", tiny, "--input", "-"], ["bench", tiny, "--quick"], ["info", tiny]):
            self.fails(USAGE, *command, "--storage", "f64", says="f16")
            self.fails(USAGE, *command, "--rotation", "matrix", says="euler")
            self.fails(USAGE, *command, "--ml-masks", "half", says="blend")
            self.fails(USAGE, *command, "--isa", "avx9", says="avx2")
            self.fails(USAGE, *command, "--arithmetic", "exact", says="portable")
        for storage in ("f32", "f16"):
            self.ok("info", tiny, "--storage", storage, "--rotation", "quaternion",
                    "--isa", "scalar")

    def test_an_absent_instruction_set_is_wrong_usage(self):
        absent = [isa for isa in ("sse2", "neon")
                  if run("info", path("tiny.dna"), "--isa", isa).returncode != DONE]
        self.assertTrue(absent)  # no machine has both
        for isa in absent:
            self.fails(USAGE, "info", path("tiny.dna"), "--isa", isa, says=isa)

    def test_files_that_cannot_be_read(self):
        frames = write("neutral.json", '{"frames": [{}]}')
        for name in (path("missing.dna"), program.folder):
            self.fails(FILE, "info", name, says=name)
            self.fails(FILE, "validate", name, says=name)
            self.fails(FILE, "eval", name, "--input", frames, says=name)
            self.fails(FILE, "convert", name, "-o", path("x"), says=name)
            self.fails(FILE, "bench", name, says=name)
            self.fails(FILE, "eval", path("tiny.dna"), "--input", name, says=name)
        self.assertFalse(os.path.exists(path("x")))

    def test_files_that_cannot_be_written(self):
        tiny = path("tiny.dna")
        frames = write("neutral.json", '{"frames": [{}]}')
        for target in (path("missing/x"), program.folder, "/dev/full"):
            self.fails(FILE, "gen", "-o", target, says=target)
            self.fails(FILE, "convert", tiny, "-o", target, says=target)
            self.fails(FILE, "eval", tiny, "--input", frames, "-o", target, says=target)
        with open("/dev/full", "wb") as full:
            for command in (["info", tiny], ["info", tiny, "--json"], ["validate", tiny],
                            ["gen", "-o", "-"], ["completion", "bash"],
                            ["eval", tiny, "--input", frames]):
                self.fails(FILE, *command, stdout=full, says="standard output")

    def test_files_that_are_no_rigs(self):
        frames = write("neutral.json", '{"frames": [{}]}')
        small = read("small.dna")
        version3 = small[:3] + b"\0\3" + small[5:]
        for name, content in (("text.dna", b"this is no DNA file, but long enough to be one " * 9),
                              ("empty.dna", b""), ("short.dna", small[:5]),
                              ("version3.dna", version3),
                              ("half.dna", small[:len(small) // 2])):
            rig = write(name, content)
            self.fails(INVALID, "info", rig, says=name)
            self.fails(INVALID, "eval", rig, "--input", frames, says=name)
            self.fails(INVALID, "convert", rig, "-o", path("x"), says=name)
            self.fails(INVALID, "bench", rig, says=name)
            self.fails(INVALID, "validate", rig, says=name)
            self.fails(INVALID, "info", "-", stdin=content, says="standard input")
        self.fails(INVALID, "info", path("half.dna"), says="byte ")
        self.assertFalse(os.path.exists(path("x")))

    def test_damaged_files_end_with_a_code_of_ours(self):
        chance = random.Random(3)
        small = read("tiny.dna")
        for _ in range(15):  # tests/fuzz/commands.py goes on
            damaged = bytearray(small[:chance.randrange(len(small))] if chance.random() < 0.3 else small)
            for _ in range(chance.randrange(1, 6)):
                if damaged:
                    damaged[chance.randrange(len(damaged))] = chance.randrange(256)
            rig = write("damaged.dna", bytes(damaged))
            for command in (["info", rig], ["validate", rig], ["convert", rig, "-o", path("y.dna")],
                            ["eval", rig, "--input", "-"]):
                done = run(*command, stdin=b'{"frames": [{}]}')
                self.assertIn(done.returncode, (DONE, INVALID), (command, done.stderr))

    def test_an_instruction_set_of_the_environment(self):
        self.fails(USAGE, "info", path("tiny.dna"), "--layers", "behavior", env={"MIEN_ISA": "abacus"},
                   says="MIEN_ISA")
        self.assertEqual(self.json("info", path("tiny.dna"), "--json", env={"MIEN_ISA": "scalar"})["rig"]["isa"],
                         "scalar")

    def test_out_of_memory(self):
        def limited(megabytes, *arguments):
            limit = megabytes << 20
            return run(*arguments, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
        codes = set()
        for megabytes in range(16, 100, 21):
            if limited(megabytes, "--version").returncode != DONE:
                continue
            for command in (["gen", "-o", path("big.dna"), "--preset", "large"],
                            ["eval", path("large.dna"), "--input", write("neutral.json", '{"frames": [{}]}')],
                            ["convert", path("large.dna"), "-o", path("big.dna")]):
                done = limited(megabytes, *command)
                self.assertIn(done.returncode, (DONE, INTERNAL), done.stderr)
                self.assertEqual(len(done.stderr.splitlines()), done.returncode != DONE, done.stderr)
                codes.add(done.returncode)
        if not codes:
            self.skipTest("NOT TESTED: too little memory; the program cannot start with little (a sanitizer?)")
        self.assertEqual(codes, {DONE, INTERNAL})
        self.assertEqual([name for name in os.listdir(program.folder) if name.startswith(".mien")], [])

    def test_names_with_control_characters_stay_on_one_line(self):
        self.fails(FILE, "info", path("two\nlines.dna"), says="two\\nlines.dna")


class Info(ProgramTest):
    def test_text(self):
        text = self.ok("info", path("tiny.dna")).stdout.decode()
        for word in ("Layers", "Counts", "Levels of detail", "Metadata", "degrees", "bhvr"):
            self.assertIn(word, text)
        self.assertNotIn("\033", text)
        for line in text.splitlines():
            self.assertEqual(line, line.rstrip())

    def test_json(self):
        for preset in PRESETS:
            info = self.json("info", path(preset + ".dna"), "--json")
            self.assertEqual(info["file_bytes"], os.path.getsize(path(preset + ".dna")))
            self.assertEqual(info["version"], "2.8")
            self.assertEqual(len(info["lods"]), info["lod_count"])
            self.assertEqual(info["lods"][0]["joints"], info["counts"]["joints"])
            last = info["layers"][-1]
            self.assertEqual(last["offset"] + last["bytes"], info["file_bytes"])
            self.assertTrue(all(layer["known"] and layer["loaded"] for layer in info["layers"]))
        info = self.json("info", path("large.dna"), "--json")
        self.assertEqual(info["counts"]["joints"], 870)
        self.assertEqual(info["lod_count"], 8)

    def test_every_kind_of_behavior_is_listed(self):
        self.ok("gen", "-o", path("all.dna"), "--preset", "body", "--ml")
        info = self.json("info", path("all.dna"), "--json")
        behavior = info["behavior"]
        self.assertEqual(sum(behavior["joint_rotations"].values()), 342)
        self.assertGreater(behavior["joint_rotations"]["quaternions"], 100)
        for tally in ("rbf_types", "rbf_distances", "rbf_functions"):
            self.assertEqual(sum(behavior[tally].values()), 72)
            self.assertNotIn(0, behavior[tally].values())
        self.assertEqual(behavior["following_joints"], {"twist": 66, "swing": 32})
        self.assertEqual(behavior["ml_regions"], {"with_masks": 12})
        self.assertNotIn(0, behavior["ml_activations"].values())
        self.assertEqual(behavior["ml_operations"], {"unspecified": 0, "gather": 12, "scatter": 4,
                                                     "network": 16, "weighted_sum": 4})
        self.assertEqual(behavior["ml_joints"],
                         {"by_euler_angles": 0, "by_quaternions": 32, "without_turning": 0})
        self.assertEqual([lod["rbf_solvers"] for lod in info["lods"]], [72, 72, 44, 0])
        text = self.ok("info", path("all.dna")).stdout.decode()
        for line in ("joints follow by  66 twist, 32 swing\n", "ML moves joints   32 by quaternions\n"):
            self.assertIn(line, text)
        part = self.json("info", path("all.dna"), "--json", "--layers", "definition")["behavior"]
        self.assertEqual(sum(part["rbf_types"].values()), 0)
        self.assertEqual(part["joint_rotations"]["euler_angles"], 342)

    def test_names(self):
        info = self.json("info", path("small.dna"), "--json", "--names", "all")
        counts = {"gui": "gui_controls", "raw": "raw_controls", "joints": "joints", "maps": "animated_maps",
                  "channels": "blend_shape_channels", "meshes": "meshes"}
        for kind, count in counts.items():
            self.assertEqual(len(info["names"][kind]), info["counts"][count])
            self.assertEqual(self.names("small.dna", kind), info["names"][kind])
        two = self.ok("info", path("small.dna"), "--names", "raw,gui").stdout.decode().splitlines()
        self.assertEqual(two[0], "gui")
        self.assertIn("raw", two)

    def test_only_what_is_named_is_loaded(self):
        info = self.json("info", path("small.dna"), "--json", "--layers", "definition")
        loaded = {layer["code"] for layer in info["layers"] if layer["loaded"]}
        self.assertEqual(loaded - {"desc", "dsce", "defn"}, set())
        self.assertIn("defn", loaded)
        self.assertIsNone(info["rig"])
        self.assertGreater(info["counts"]["joints"], 0)
        self.assertEqual(info["counts"]["joint_groups"], 0)

    def test_lods(self):
        whole = self.json("info", path("medium.dna"), "--json")
        last = whole["lod_count"] - 1
        for options in (["--lods", "1,%d" % last], ["--lods", "%d,1" % last]):
            part = self.json("info", path("medium.dna"), "--json", *options)
            self.assertEqual(part["lod_count"], 2)
            self.assertEqual(part["max_lod"], whole["max_lod"] + 1)
            self.assertEqual(part["lods"][1]["meshes"], whole["lods"][last]["meshes"])
        for options, count in ((["--max-lod", "1"], last), (["--min-lod", "1"], 2),
                               (["--max-lod", "1", "--min-lod", "1"], 1), (["--lods", "0-1"], 2),
                               (["--max-lod", "1", "--lods", "0-1"], 2),  # the list wins
                               (["--min-lod", "65535"], last + 1), (["--lods", "0-60000"], last + 1)):
            part = self.json("info", path("medium.dna"), "--json", *options)
            self.assertEqual(part["lod_count"], count, options)

    def test_a_missing_lod_among_those_named_is_noted(self):
        done = self.ok("info", path("tiny.dna"), "--lods", "0,9")
        self.assertIn("mien: note:", done.stderr)
        self.assertEqual(self.ok("info", path("tiny.dna"), "--lods", "0,9", "--quiet").stderr, "")
        self.assertEqual(self.ok("--quiet", "info", path("tiny.dna"), "--lods", "0,9").stderr, "")

    def test_standard_input(self):
        info = self.json("info", "-", "--json", stdin=read("small.dna"))
        self.assertEqual(info["file"], "standard input")
        self.assertFalse(info["mapped"])


class Validate(ProgramTest):
    def test_generated_rigs_are_valid(self):
        for preset in PRESETS:
            report = self.json("validate", path(preset + ".dna"), "--json")
            self.assertEqual((report["valid"], report["errors"], report["findings"]), (True, 0, []))
        self.assertIn(b"valid", self.ok("validate", path("tiny.dna")).stdout)
        self.assertEqual(self.ok("validate", path("tiny.dna"), "--quiet").stdout, b"")
        self.ok("validate", "-", stdin=read("tiny.dna"))

    def damaged(self):
        """tiny.dna with two joints that have no parent."""
        content = bytearray(read("tiny.dna"))
        count = len(self.names("tiny.dna", "joints"))
        info = self.json("info", path("tiny.dna"), "--json")
        layer = next(layer for layer in info["layers"] if layer["code"] == "defn")
        # jointHierarchy is the last array before two times three arrays of floats.
        at = layer["offset"] + layer["bytes"] - 6 * (4 + 4 * count) - 2 * count
        self.assertEqual(struct.unpack_from(">I", content, at - 4)[0], count)
        struct.pack_into(">HH", content, at + 2, 7777, 8888)
        return write("orphans.dna", bytes(content)), at + 2

    def test_every_finding_is_listed(self):
        rig, offset = self.damaged()
        done = self.fails(INVALID, "validate", rig, "--json", says="orphans.dna")
        report = json.loads(done.stdout)
        self.assertFalse(report["valid"])
        self.assertEqual(report["errors"], len([f for f in report["findings"] if f["severity"] == "error"]))
        self.assertGreaterEqual(report["errors"], 2)
        first = report["findings"][0]
        self.assertIn("defn.jointHierarchy", first["field"])
        self.assertEqual(first["status"], "DNA_REFERENCE")
        self.assertEqual(first["offset"], offset)
        self.assertIn("7777", first["message"])
        text = self.fails(INVALID, "validate", rig).stdout.decode()
        self.assertEqual(len(text.splitlines()), len(report["findings"]))
        self.assertIn("8888", text)
        self.assertIn("byte %d" % offset, text)
        self.fails(INVALID, "info", rig, says=("7777", "byte %d" % offset))

    def test_truncation(self):
        rig = write("cut.dna", read("tiny.dna")[:-10])
        done = self.fails(INVALID, "validate", rig, "--json")
        self.assertEqual(json.loads(done.stdout)["findings"][0]["status"], "DNA_TRUNCATED")


class Generate(ProgramTest):
    def test_the_head_in_the_box_is_valid_and_depends_on_its_seed(self):
        for seed in ("0", "7"):
            self.ok("demo-head", "-o", path("person%s.dna" % seed), "--seed", seed)
            report = self.json("validate", path("person%s.dna" % seed), "--json")
            self.assertEqual((report["valid"], report["findings"]), (True, []))
        self.assertEqual(self.ok("demo-head", "-o", "-").stdout, read("person0.dna"))
        self.assertNotEqual(read("person7.dna"), read("person0.dna"))
        names = self.names("person0.dna", "raw")
        self.assertEqual(len(names), 72)
        self.assertIn("jawOpen", names)

    def test_the_same_seed_gives_the_same_bytes(self):
        for seed in ("0", "1", "18446744073709551615"):
            self.ok("gen", "-o", path("a.dna"), "--seed", seed)
            done = self.ok("gen", "-o", "-", "--seed", seed)
            self.assertEqual(done.stdout, read("a.dna"))
        self.assertNotEqual(read("a.dna"), read("tiny.dna"))
        self.assertEqual(self.ok("gen", "-o", "-").stdout, read("tiny.dna"))

    def test_body_and_networks(self):
        counts = self.json("info", path("body.dna"), "--json")["counts"]
        expected = {"raw_controls": 176, "rbf_controls": 670, "rbf_solvers": 72, "rbf_poses": 670,
                    "twists": 22, "swings": 16, "joints": 342, "neural_networks": 0}
        self.assertEqual({key: counts[key] for key in expected}, expected)
        for preset in PRESETS:
            self.ok("gen", "-o", path("ml.dna"), "--preset", preset, "--ml")
            report = self.json("validate", path("ml.dna"), "--json")
            self.assertEqual(report["findings"], [])
            learned = self.json("info", path("ml.dna"), "--json")["counts"]
            self.assertGreaterEqual(learned["neural_networks"], 4)
            self.assertGreaterEqual(learned["ml_controls"], 20)
        self.ok("gen", "-o", path("again.dna"), "--preset", "body", "--ml")
        self.assertEqual(read("again.dna"), read("ml.dna"))

    def test_outputs_are_replaced_whole(self):
        write("old.dna", "something else")
        os.chmod(path("old.dna"), 0o600)
        os.symlink("old.dna", path("link.dna"))
        self.ok("gen", "-o", path("link.dna"))
        self.assertTrue(os.path.islink(path("link.dna")))
        self.assertEqual(read("old.dna"), read("tiny.dna"))
        self.assertEqual(stat.S_IMODE(os.stat(path("old.dna")).st_mode), 0o600)
        self.ok("gen", "-o", "/dev/null")
        self.assertTrue(stat.S_ISCHR(os.stat("/dev/null").st_mode))
        self.assertEqual([name for name in os.listdir(program.folder) if name.startswith(".mien")], [])

    def test_a_relative_name_is_written_here(self):
        self.ok("gen", "-o", "here.dna", cwd=program.folder)
        self.assertEqual(read("here.dna"), read("tiny.dna"))


class Bench(ProgramTest):
    ROW = ["isa", "storage", "rotation", "arithmetic", "lod", "activity", "shared_controls", "characters",
           "evaluate_ns", "joints_ns", "bytes_touched"]

    def test_json(self):
        result = self.json("bench", path("tiny.dna"), "--quick", "--json", "--isa", "all")
        self.assertEqual(list(result), ["rig", "cpu", "compiler", "csr", "rows", "stages", "frames"])
        lods = self.json("info", path("tiny.dna"), "--json")["lod_count"]
        self.assertEqual([row["lod"] for row in result["csr"]], list(range(lods)))
        for row in result["csr"]:
            self.assertEqual(list(row), ["lod", "joints_ns"])
            self.assertGreater(row["joints_ns"], 0)
        isas = {row["isa"] for row in result["rows"]}
        self.assertIn("scalar", isas)
        expected = {(isa, lod, activity, *batch) for isa in isas for lod in range(lods)
                    for activity in (0.05, 0.08, 0.25, 0.5, 1.0)
                    for batch in ((1, False), (64, False), (64, True))}
        expected |= {(isa, 0, 0.08, 512, False) for isa in isas}
        keys = [(row["isa"], row["lod"], row["activity"], row["characters"], row["shared_controls"])
                for row in result["rows"]]
        self.assertEqual(len(keys), len(set(keys)))
        self.assertEqual(set(keys), expected)
        for row in result["rows"]:
            self.assertEqual(list(row), self.ROW)
            self.assertEqual((row["storage"], row["rotation"], row["arithmetic"]), ("f32", "euler", "fast"))
            self.assertGreater(row["evaluate_ns"], 0)
            self.assertGreater(row["joints_ns"], 0)
            self.assertGreaterEqual(row["bytes_touched"], 0)
            self.assertTrue(math.isfinite(row["evaluate_ns"] + row["joints_ns"]))
        # Active controls decide which part of the matrix is touched, on each instruction set the same.
        touched = {}
        for row in result["rows"]:
            if row["characters"] == 1:
                touched.setdefault((row["lod"], row["activity"]), set()).add(row["bytes_touched"])
        self.assertTrue(all(len(of_all) == 1 for of_all in touched.values()))
        for lod in range(lods):
            by_activity = [min(touched[lod, activity]) for activity in (0.05, 0.08, 0.25, 0.5, 1.0)]
            self.assertLess(by_activity[0], by_activity[-1])
            self.assertEqual(max(by_activity), by_activity[-1])
        self.assertGreater(max(max(of_all) for of_all in touched.values()), 0)

    def test_stages_that_the_rig_has(self):
        last = ["joints_ns", "blend_shapes_ns", "animated_maps_ns", "evaluate_ns"]
        make("gen", "-o", path("body_to_time.dna"), "--preset", "body")
        for name, first, isa in (("tiny.dna", ["psd_ns"], "all"), ("body_to_time.dna", ["rbf_ns"], "scalar")):
            result = self.json("bench", path(name), "--quick", "--json", "--isa", isa, "--lods", "0")
            isas = list(dict.fromkeys(row["isa"] for row in result["rows"]))
            self.assertEqual([(row["isa"], row["characters"]) for row in result["stages"]],
                             [(isa, count) for isa in isas for count in (1, 64)])
            for row in result["stages"]:
                stages = [key for key in row if key.endswith("_ns")]
                self.assertEqual(stages[:1] + stages[-1:], first + last[-1:])
                self.assertIn("joints_ns", stages)
                for stage in stages:
                    self.assertGreater(row[stage], 0)
        text = self.ok("bench", path("tiny.dna"), "--quick", "--isa", "all").stdout.decode()
        self.assertIn("Stages at LOD 0", text)
        self.assertRegex(text, r"\nscalar( +[0-9.]+)+ +1\.0( +[0-9.]+)+ +1\.0\n")

    def test_frames_of_a_file_with_geometry(self):
        result = self.json("bench", path("tiny.dna"), "--quick", "--json", "--isa", "all")
        isas = list(dict.fromkeys(row["isa"] for row in result["rows"]))
        self.assertEqual([(row["isa"], row["characters"]) for row in result["frames"]],
                         [(isa, count) for isa in isas for count in (1, 64)])
        for row in result["frames"]:
            for stage in ("evaluate_ns", "pose_ns", "deform_ns"):
                self.assertGreater(row[stage], 0)
        text = self.ok("bench", path("tiny.dna"), "--quick", "--isa", "scalar").stdout.decode()
        self.assertIn("Whole frames at LOD 0", text)
        self.assertRegex(text, r"\nscalar( +[0-9.]+){4} +1\.0( +[0-9.]+){5}\n$")
        result = self.json("bench", path("tiny.dna"), "--quick", "--json", "--lods", "0",
                           "--layers", "behavior")
        self.assertEqual(result["frames"], [])

    def test_one_instruction_set_and_one_lod(self):
        result = self.json("bench", path("tiny.dna"), "--quick", "--json", "--isa", "scalar", "--lods", "0")
        self.assertEqual({row["isa"] for row in result["rows"]}, {"scalar"})
        self.assertEqual(len(result["rows"]), 16)
        result = self.json("bench", path("tiny.dna"), "--quick", "--json", "--lods", "0",
                           env={"MIEN_ISA": "scalar"})
        self.assertEqual({row["isa"] for row in result["rows"]}, {"scalar"})
        result = self.json("bench", path("tiny.dna"), "--quick", "--json", "--lods", "0", "--isa", "scalar",
                           "--arithmetic", "portable")
        self.assertEqual({row["arithmetic"] for row in result["rows"]}, {"portable"})

    def test_text(self):
        text = self.ok("bench", path("tiny.dna"), "--quick", "--lods", "0", "--isa", "scalar").stdout.decode()
        self.assertIn("x CSR", text)
        self.assertEqual(len([line for line in text.splitlines() if line.startswith("scalar")]), 8)
        self.fails(USAGE, "bench", path("tiny.dna"), "--layers", "definition")


class Completion(ProgramTest):
    def test_scripts_parse(self):
        parsed = []
        for shell in ("bash", "zsh", "fish"):
            script = self.ok("completion", shell).stdout
            for word in (b"--max-lod", b"validate", b"geometry-without-blend-shapes", b"quaternion"):
                self.assertIn(word, script.replace(b"-l max-lod", b"--max-lod"))
            if shutil.which(shell):
                check = subprocess.run([shell, "-n"], input=script, stderr=subprocess.PIPE)
                self.assertEqual((check.returncode, check.stderr), (0, b""), shell)
                parsed.append(shell)
        self.assertIn("bash", parsed)

    def complete(self, *words):
        script = self.ok("completion", "bash").stdout.decode() + (
            "COMP_WORDS=(mien %s); COMP_CWORD=%d; _mien; printf '%%s\\n' \"${COMPREPLY[@]}\"\n"
            % (" ".join("'%s'" % word for word in words), len(words)))
        done = subprocess.run(["bash"], input=script.encode(), stdout=subprocess.PIPE, cwd=program.folder)
        return done.stdout.decode().split()

    def test_bash_completes(self):
        self.assertEqual(self.complete("va"), ["validate"])
        self.assertEqual(self.complete("gen", "--preset", "l"), ["large"])
        self.assertEqual(self.complete("gen", "--preset", "b"), ["body"])
        self.assertIn("unreal-mesh", self.complete("convert", "--system", "unr"))
        self.assertEqual(self.complete("bench", "--isa", "a"), ["avx2", "avx512", "all"])
        self.assertEqual(self.complete("eval", "--isa", "a"), ["avx2", "avx512"])
        self.assertEqual(self.complete("eval", "--max"), ["--max-lod"])
        self.assertEqual(self.complete("completion", ""), ["bash", "zsh", "fish"])
        self.assertEqual(self.complete("help", "in"), ["info", "inspect"])
        self.assertEqual(self.complete("bench", "--arithmetic", ""), ["fast", "portable"])
        self.assertIn("large.dna", self.complete("info", "la"))
        self.assertIn("large.dna", self.complete("convert", "-o", "la"))


if __name__ == "__main__":
    main()
