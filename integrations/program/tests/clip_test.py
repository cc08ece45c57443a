#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien clip`: takes become clips and come back bit for bit; rates, snapping, and clear refusals.

    cli_clip_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)
"""
import json
import os
import random
import struct
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "tests", "support"))
from program import (USAGE, INVALID, FILE, ProgramTest,  # noqa: E402
                     main, make_folder, path, read, write)

# The 61 channels of the Live Link Face app, in its order.
LIVE_LINK = (
    "EyeBlinkLeft EyeLookDownLeft EyeLookInLeft EyeLookOutLeft EyeLookUpLeft EyeSquintLeft "
    "EyeWideLeft EyeBlinkRight EyeLookDownRight EyeLookInRight EyeLookOutRight EyeLookUpRight "
    "EyeSquintRight EyeWideRight JawForward JawRight JawLeft JawOpen MouthClose MouthFunnel "
    "MouthPucker MouthRight MouthLeft MouthSmileLeft MouthSmileRight MouthFrownLeft "
    "MouthFrownRight MouthDimpleLeft MouthDimpleRight MouthStretchLeft MouthStretchRight "
    "MouthRollLower MouthRollUpper MouthShrugLower MouthShrugUpper MouthPressLeft MouthPressRight "
    "MouthLowerDownLeft MouthLowerDownRight MouthUpperUpLeft MouthUpperUpRight BrowDownLeft "
    "BrowDownRight BrowInnerUp BrowOuterUpLeft BrowOuterUpRight CheekPuff CheekSquintLeft "
    "CheekSquintRight NoseSneerLeft NoseSneerRight TongueOut HeadYaw HeadPitch HeadRoll "
    "LeftEyeYaw LeftEyePitch LeftEyeRoll RightEyeYaw RightEyePitch RightEyeRoll").split()


def setUpModule():
    make_folder()


def bits(value):
    """Of the nearest 32-bit float."""
    return struct.unpack("<I", struct.pack("<f", value))[0]


def nearest(text):
    """The nearest 32-bit float."""
    return struct.unpack("<f", struct.pack("<f", float(text)))[0]


def random_floats(count, seed):
    """Of all sizes: denormals, zeros of both signs, huge ones."""
    generator = random.Random(seed)
    values = [0.0, -0.0, 1.0, 1.401298464324817e-45, 3.4028234663852886e38, 0.1, 1 / 3]
    while len(values) < count:
        value = struct.unpack("<f", struct.pack("<I", generator.getrandbits(32)))[0]
        if value == value and abs(value) != float("inf"):
            values.append(value)
    generator.shuffle(values)
    return values


class ClipTest(ProgramTest):
    def build(self, text, *options, name="take"):
        source = write(name + ".in", text)
        self.ok("clip", "build", source, "-o", path(name + ".clip"), *options)
        return path(name + ".clip")

    def refuse_take(self, text, says, *options, code=INVALID):
        source = write("wrong.in", text)
        self.fails(code, "clip", "build", source, "-o", path("wrong.clip"), *options, says=says)
        self.assertFalse(os.path.exists(path("wrong.clip")))

    def info(self, clip):
        return self.json("clip", "info", clip, "--json")

    def rows(self, clip):
        """Header, and floats, of the clip as CSV."""
        lines = self.ok("clip", "export", clip, "-o", "-").stdout.decode().splitlines()
        return lines[0].split(","), [[nearest(v) for v in line.split(",")] for line in lines[1:]]


class RoundTrip(ClipTest):
    def test_any_floats_come_back_bit_for_bit(self):
        names = ["jawOpen", "a,b", 'say "ah"', "mouth.close", "é", "with space"]
        for seed, rate in enumerate(("60", "30000/1001", "24", "1001/8", "0.5")):
            values = random_floats(6 * 70, seed)
            frames = [values[i:i + 6] for i in range(0, len(values), 6)]
            document = {"frames": [{"raw": dict(zip(names, row))} for row in frames]}
            first = self.build(json.dumps(document), "--rate", rate, name="first")
            for ending in ("csv", "json"):
                table = path("back." + ending)
                self.ok("clip", "export", first, "-o", table)
                self.ok("clip", "build", table, "-o", path("second.clip"))
                self.assertEqual(read("second.clip"), read("first.clip"), (rate, ending))
                self.ok("clip", "export", path("second.clip"), "-o", path("again." + ending))
                self.assertEqual(read("again." + ending), read("back." + ending))
            with open(path("back.json"), encoding="utf-8") as file:
                back = json.load(file)
            for row, frame in zip(frames, back["frames"]):
                self.assertEqual([bits(v) for v in row], [bits(frame["raw"][n]) for n in names])

    def test_values_are_the_nearest_floats(self):
        # Rounding these to double first would give the other neighbor.
        tie = "1.00000005960464477539062500000000000000001"
        clip = self.build(f"time,a,b,c,d\n0,{tie},1e-60,-1e-60,+2.5E-1\n", name="near")
        _, rows = self.rows(clip)
        self.assertEqual(bits(rows[0][1]), bits(1) + 1)
        self.assertEqual([bits(v) for v in rows[0][2:]], [0, 0x80000000, bits(0.25)])
        clip = self.build('{"frames": [{"raw": {"a": %s, "b": -0.0, "c": 2}}]}' % tie, name="near")
        self.assertEqual([bits(v) for v in self.rows(clip)[1][0][1:]],
                         [bits(1) + 1, 0x80000000, bits(2)])

    def test_differences_from_a_frame_and_from_a_clip(self):
        table = "time,a,b\n0,0.5,1\n1,0.75,1\n2,0.25,3\n"
        rows = lambda *options: [row[1:] for row in self.rows(self.build(table, *options))[1]]
        self.assertEqual(rows("--minus", "0"), [[0, 0], [0.25, 0], [-0.25, 2]])
        self.assertEqual(rows("--minus", "2"), [[0.25, -2], [0.5, -2], [0, 0]])
        self.assertEqual(rows("--minus", "nothing"), [[0.5, 1], [0.75, 1], [0.25, 3]])
        # A shorter one, whose last frame stays, without a channel.
        base = self.build("time,x,a\n0,9,0.5\n1,9,0.25\n", name="base")
        self.assertEqual(rows("--minus", base), [[0, 1], [0.5, 1], [0, 3]])
        self.assertIn(b"differences", self.ok("clip", "info", path("take.clip")).stdout)
        self.refuse_take(table, "no frame 3", "--minus", "3")
        self.refuse_take("time,c\n0,1\n", "in common", "--minus", base)
        self.refuse_take(table, "none.clip", "--minus", "none.clip", code=FILE)

    def test_csv_in_the_dialects_of_programs(self):
        plain = self.build("time,a,b\n0,1,2\n1,3,4\n", name="plain")
        for text in ("time,a,b\r\n0,1,2\r\n1,3,4\r\n", "\ufefftime,a,b\n0,1,2\n1,3,4",
                     'Time,"a","b"\n0, 1 ,2\n\n1,3,"4"\n\n', "time,a,b\r0,1,2\r1,3,4\r"):
            self.assertEqual(read(os.path.basename(self.build(text))),
                             read(os.path.basename(plain)), text)

    def test_streams(self):
        text = b"time,a\n0,1\n0.5,2\n"
        clip = self.ok("clip", "build", "-", "-o", "-", stdin=text).stdout
        self.assertEqual(self.ok("clip", "export", "-", "-o", "-", stdin=clip).stdout, text)
        self.assertIn(b"2 frames", self.ok("clip", "verify", "-", stdin=clip).stdout)

    def test_the_frames_of_eval(self):
        self.ok("gen", "-o", path("tiny.dna"))
        names = json.loads(self.ok("info", path("tiny.dna"), "--json", "--names", "raw").stdout)
        name = names["names"]["raw"][0]
        clip = self.build(json.dumps({"frames": [{"raw": {name: 0.25}}, {}, {"raw": {name: 1}}]}))
        self.ok("clip", "export", clip, "-o", path("frames.json"))
        out = self.ok("eval", path("tiny.dna"), "--input", path("frames.json")).stdout
        self.assertEqual([f["lods"][0]["raw"][0] for f in json.loads(out)["frames"]], [0.25, 0, 1])

    def test_the_output_of_play(self):
        document = {"rig": "x", "rate": 30, "controls": ["b", "a"], "variables": ["gaze.x"],
                    "events": [], "frames": [{"time": 0, "raw": [1, 2], "variables": [0]},
                                             {"time": 1 / 30, "raw": [3, 4], "stages": {},
                                              "guards": {}}]}
        clip = self.build(json.dumps(document))
        self.assertEqual(self.info(clip)["rate"], [30, 1])
        header, rows = self.rows(clip)
        self.assertEqual((header, [row[1:] for row in rows]), (["time", "b", "a"], [[1, 2], [3, 4]]))


    def test_events(self):
        frames = [{"raw": {"a": k / 4}} for k in range(4)]
        events = [{"time": 0.05, "layer": "talk", "name": "M", "value": 0.25},
                  {"tick": 1, "name": "start"}]
        clip = self.build(json.dumps({"rate": 60, "events": events, "frames": frames}))
        self.assertIn(b"events            2\n", self.ok("clip", "info", clip).stdout)
        self.ok("clip", "export", clip, "-o", path("events.json"))
        with open(path("events.json"), encoding="utf-8") as file:
            found = json.load(file)["events"]
        # Seconds are read as 32-bit floats.
        tick = round(struct.unpack("f", struct.pack("f", 0.05))[0] * 705600000)
        self.assertEqual([(e["tick"], e["name"], e["value"]) for e in found],
                         [(1, "start", 0), (tick, "M", 0.25)])
        self.ok("clip", "build", path("events.json"), "-o", path("again.clip"))
        with open(clip, "rb") as one, open(path("again.clip"), "rb") as other:
            self.assertEqual(one.read(), other.read())
        table = self.ok("clip", "export", clip, "-o", path("events.csv"))
        self.assertIn("no place for its 2 events", str(table.stderr))

    def test_events_that_close_lips(self):
        frames = [{"raw": {"a": k / 4}} for k in range(60)]
        events = [{"time": 0.25, "name": "M", "value": 0.125}, {"time": 0.5, "name": "ah"},
                  {"time": 0.5, "name": "f", "value": 0.0625}]
        clip = self.build(json.dumps({"rate": 60, "events": events, "frames": frames}),
                          "--close", "m,b,p=lips", "--close", "F,v=lip-to-teeth")
        self.ok("clip", "export", clip, "-o", path("events.json"))
        with open(path("events.json"), encoding="utf-8") as file:
            found = json.load(file)["events"]
        self.assertEqual([(e["time"], e["name"], e["value"]) for e in found],
                         [(0.25, "M", 0.125), (0.25, "close:lips", 0.125), (0.5, "ah", 0),
                          (0.5, "f", 0.0625), (0.5, "close:lip-to-teeth", 0.0625)])
        with open(path("bad.json"), "w", encoding="utf-8") as file:
            json.dump({"rate": 60, "events": events, "frames": frames}, file)
        for option, code in (("m=lip", 1), ("m", 1), ("=lips", 1), ("ah=lips", 2)):
            self.fails(code, "clip", "build", path("bad.json"), "-o", path("bad.clip"), "--close",
                       option)
        done = self.ok("clip", "build", path("bad.json"), "-o", path("bad.clip"), "--close", "b=lips")
        self.assertIn("no event has one of these names", done.stderr)


class Information(ClipTest):
    def test_json(self):
        rows = "".join(f"{i / 60!r},{i % 7 / 8},0.5\n" for i in range(600))
        info = self.info(self.build("time,jawOpen,still\n" + rows, "--loop", "wrap"))
        size = os.path.getsize(path("take.clip"))
        self.assertEqual(info, {
            "rate": [60, 1], "frames": 600, "channels": ["jawOpen", "still"],
            "changing_channels": 1, "bytes": size, "raw_bytes": 4800,
            "ratio": round(4800 / size, 1), "snap": 0, "loop": "wrap"})

    def test_text(self):
        clip = self.build("time,jawOpen\n0,0.1\n0.04,0.2\n", "--snap", "2^-11")
        text = self.ok("clip", "info", clip).stdout.decode()
        for part in ("2, 0.040 s, clamp", "25 per second", "1/2,048", "jawOpen"):
            self.assertIn(part, text)

    def test_verify(self):
        clip = self.build("time,a\n0,0.1\n0.04,0.2\n0.08,0.15\n")
        self.assertIn("3 frames", self.ok("clip", "verify", clip).stdout.decode())
        self.assertEqual(self.ok("clip", "verify", clip, "--quiet").stdout, b"")
        damaged = bytearray(read("take.clip"))
        damaged[-24] ^= 1
        with open(path("damaged.clip"), "wb") as file:
            file.write(damaged)
        self.fails(INVALID, "clip", "verify", path("damaged.clip"), says="damaged.clip")

    def test_other_files_are_no_clips(self):
        write("text.clip", "time,a\n")
        for action in ("info", "verify"):
            self.fails(INVALID, "clip", action, path("text.clip"), says="not a clip")
            self.fails(INVALID, "clip", action, "-", stdin=b"text", says="standard input")
            self.fails(FILE, "clip", action, path("nowhere.clip"), says="nowhere.clip")
        clip = self.build("time,a\n0,1\n")
        cut = write("cut.clip", "")
        with open(cut, "wb") as file:
            file.write(read("take.clip")[:-8])
        self.fails(INVALID, "clip", "info", cut, says="ends after")
        self.fails(USAGE, "clip", "export", clip, "-o", path("x.txt"), says=".csv")
        self.fails(FILE, "clip", "export", clip, "-o", "/nonexistent/x.csv")


class Rates(ClipTest):
    def rate(self, text, *options):
        return self.info(self.build(text, *options))["rate"]

    def table(self, times):
        return "time,a\n" + "".join(f"{time},{i % 3}\n" for i, time in enumerate(times))

    def test_found_from_exact_times(self):
        for rate in ([60, 1], [24, 1], [25, 1], [30000, 1001], [24000, 1001], [2997, 50], [1, 2],
                     [1000, 1], [7, 3], [59, 1]):
            times = [repr(k * rate[1] / rate[0]) for k in range(50)]
            self.assertEqual(self.rate(self.table(times)), rate)

    def test_found_from_rounded_times(self):
        for hertz, decimals in ((60, 3), (60, 2), (30, 3), (24, 2), (120, 4), (25, 2), (50, 3)):
            times = [f"{100 + k / hertz:.{decimals}f}" for k in range(200)]
            self.assertEqual(self.rate(self.table(times)), [hertz, 1], (hertz, decimals))
        times = [f"{k * 1.001 / 30:.4f}" for k in range(3000)]
        self.assertEqual(self.rate(self.table(times)), [30000, 1001])

    def test_given(self):
        one = "time,a\n5,1\n"
        self.assertEqual(self.rate(one), [60, 1])
        for word, rate in (("24", [24, 1]), ("29.97", [30000, 1001]), ("23.976", [24000, 1001]),
                           ("59.94", [60000, 1001]), ("30000/1001", [30000, 1001]),
                           ("12.5", [25, 2])):
            self.assertEqual(self.rate(one, "--rate", word), rate, word)
        frames = '{"frames": [{"raw": {"a": 1}}, {"raw": {"a": 0}}]}'
        self.assertEqual(self.rate(frames), [60, 1])
        self.assertEqual(self.rate(frames, "--rate", "25"), [25, 1])
        for word in ("0", "-1", "fast", "1/0", "0.001", "60fps", "1e9", ""):
            self.refuse_take(one, "--rate", "--rate", word, code=USAGE)

    def test_rows_off_the_rate(self):
        times = [k / 60 for k in range(40)]
        times[25:] = [time + 1 / 60 for time in times[25:]]  # a frame is missing
        text = self.table(times)
        self.refuse_take(text, ["row 27", "60 frames per second", "--resample"])
        self.refuse_take(self.table([0, 0.1, 0.2]), ["row 3", "--rate"], "--rate", "60")
        self.refuse_take(self.table([k / 60 for k in range(9)]), "row 6", "--rate", "59")
        document = {"frames": [{"time": t, "raw": {"a": 0}} for t in (0, 0.1, 0.25, 0.35, 0.45)]}
        self.refuse_take(json.dumps(document), "frames[2]")

    def test_resampling(self):
        clip = self.build("time,a,b\n1,0,0\n1.05,1,8\n1.1,1,8\n1.3,0,-8\n", "--resample", "--rate",
                          "20")
        _, rows = self.rows(clip)
        self.assertEqual([row[1] for row in rows], [0, 1, 1, 0.75, 0.5, 0.25, 0])
        self.assertEqual([round(row[2], 6) for row in rows], [0, 8, 8, 4, 0, -4, -8])
        same = self.table([repr(k / 60) for k in range(100)])
        self.build(same, "--resample", name="resampled")
        self.build(same, name="plain")
        self.assertEqual(read("resampled.clip"), read("plain.clip"))
        self.refuse_take("time,a\n0,0\n1e12,0\n", "far apart", "--resample", "--rate", "60")
        self.refuse_take('{"frames": [{"raw": {"a": 1}}]}', "no times", "--resample")


class Choices(ClipTest):
    def test_snap(self):
        text = "time,a\n" + "".join(f"{k / 60!r},{(k * 37 % 101) / 101!r}\n" for k in range(90))
        whole = self.build(text, name="whole")
        for word, step in (("1/2048", 2 ** -11), ("2^-9", 2 ** -9), ("0.0009765625", 2 ** -10)):
            clip = self.build(text, "--snap", word)
            self.assertEqual(self.info(clip)["snap"], step)
            for exact, rounded in zip(self.rows(whole)[1], self.rows(clip)[1]):
                self.assertEqual(rounded[1] % step, 0)
                self.assertLessEqual(abs(rounded[1] - exact[1]), step / 2)
            self.assertLess(self.info(clip)["bytes"], self.info(whole)["bytes"])
        self.build(text, "--snap", "0")
        self.assertEqual(read("take.clip"), read("whole.clip"))
        for word in ("0.001", "1/256", "1/131072", "-1/512", "2048", "nan", "fine", "1/0", ""):
            self.refuse_take(text, "--snap", "--snap", word, code=USAGE)

    def test_steps_that_move_nothing_on_a_rig(self):
        rig = path("steps.dna")
        self.ok("demo-head", "-o", rig)
        rows = "\n".join(f"{i / 60},{i * 0.0123456 % 1},{i * 0.0311 % 1}" for i in range(200))
        text = "time,jawOpen,unknown\n" + rows + "\n"
        exact, seen = self.build(text), self.build(text, "--rig", rig, name="seen")
        coarse = self.build(text, "--rig", rig, "--tolerance", "1", name="coarse")
        sizes = [self.info(clip)["bytes"] for clip in (exact, seen, coarse)]
        self.assertEqual(sizes, sorted(sizes, reverse=True))
        self.assertEqual(self.info(coarse)["snap"], 1 / 512)
        self.fails(USAGE, "clip", "build", "x", "-o", "y", "--tolerance", "1", says="--rig")
        self.fails(USAGE, "clip", "build", "x", "-o", "y", "--rig", rig, "--snap", "1/512",
                   says="--snap")
        for word in ("0", "-1", "nan", "much"):
            self.fails(USAGE, "clip", "build", "x", "-o", "y", "--rig", rig, "--tolerance", word,
                       says="--tolerance")

    def test_names_of_a_take_on_a_rig(self):
        rig = path("names.dna")
        self.ok("demo-head", "-o", rig)
        take = write("named.csv", "time,mouth_smile_L,grin,hat\n0,0,0,0\n0.0166666667,1,1,1\n")
        names = write("grin.json", '{"grin": {"mouthStretch_L": 0.5, "jaw_open": 0.25}}')
        done = self.ok("clip", "build", take, "--rig", rig, "--names", names, "-o", path("named.clip"))
        self.assertIn("2 names stand for other controls of this rig: "
                      "grin is 0.25 jawOpen + 0.5 mouthStretchLeft; mouth_smile_L is mouthSmileLeft", done.stderr)
        self.assertIn("1 of 3 channels drive nothing on the rig", done.stderr)
        self.assertIn("the first is hat", done.stderr)
        # The file also wins over the control of a channel's own name.
        own = write("own.json", '{"jawOpen": {"mouthPucker": 0.5}}')
        for values in ("0,0.5\n0.0166666667,1,0.5", "1,0\n0.0166666667,1,1"):
            done = self.ok("clip", "build", write("own.csv", "time,jawOpen,mouthSmileLeft\n0," + values + "\n"),
                           "--rig", rig, "--names", own, "-o", path("own.clip"))
            self.assertIn("jawOpen is 0.5 mouthPucker", done.stderr)
            self.assertNotIn("drive nothing", done.stderr)
        # What no channel drives is not said to be matched.
        done = self.ok("clip", "build", write("twice.csv", "time,mouth_smile_L,MouthSmileLeft\n0,0,0\n"), "--rig", rig,
                       "-o", path("twice.clip"))
        self.assertNotIn("mouth_smile_L is", done.stderr)
        self.assertIn("the first is mouth_smile_L", done.stderr)
        self.fails(USAGE, "clip", "build", take, "--names", names, "-o", path("named.clip"), says="--rig")
        self.fails(INVALID, "clip", "build", take, "--rig", rig, "--names", write("wrong.json", '{"grin": "none"}'),
                   "-o", path("none.clip"), says='the rig has no raw control "none"')

    def test_channels(self):
        text = "time,jawOpen,CTRL_expressions.mouthClose,jawLeft,browUp\n0,1,2,3,4\n"
        self.assertEqual(self.info(self.build(text, "--channels", "jaw*,mouthClose"))["channels"],
                         ["jawOpen", "CTRL_expressions.mouthClose", "jawLeft"])
        self.assertEqual(self.rows(self.build(text, "--channels", "browup"))[1], [[0, 4]])
        self.refuse_take(text, ["jawOpne", "did you mean \"jawOpen\"?"], "--channels",
                         "browUp,jawOpne")
        self.refuse_take(text, "a name is empty", "--channels", "browUp,,jawOpen", code=USAGE)

    def test_loop(self):
        self.refuse_take("time,a\n0,1\n", "--loop", "--loop", "round", code=USAGE)

    def test_outputs_do_not_replace_inputs(self):
        source = write("same.csv", "time,a\n0,1\n")
        self.fails(USAGE, "clip", "build", source, "-o", source)
        clip = self.build("time,a\n0,1\n", name="kept.csv")
        self.assertTrue(clip.endswith(".csv.clip"))

    def test_usage(self):
        self.fails(USAGE, "clip", says="no command is given")
        self.fails(USAGE, "clip", "biuld", "x", says='did you mean "build"?')
        self.fails(USAGE, "clip", "build", "x", says="--output")
        self.fails(USAGE, "clip", "build", "x", "-o", "y", "--snpa", "1", says='"--snap"')
        self.fails(FILE, "clip", "build", path("nowhere.csv"), "-o", path("x.clip"))
        for words in (["clip"], ["clip", "build"], ["clip", "export"]):
            self.assertIn(b"clip", self.ok("help", *words).stdout)
        self.fails(USAGE, "help", "clip", "biuld", says='did you mean "build"?')
        self.assertIn(b"--resample", self.ok("completion", "bash").stdout)


class LiveLink(ClipTest):
    def take(self, times, values=None, header=None):
        text = "Timecode,BlendshapeCount," + ",".join(header or LIVE_LINK) + "\n"
        for i, time in enumerate(times):
            row = values[i] if values else [round((i * 7 + c) % 11 / 10, 3) for c in range(61)]
            text += f"{self.timecode(time)},61," + ",".join(map(repr, row)) + "\n"
        return text

    @staticmethod
    def timecode(seconds):
        whole = int(seconds)
        return (f"{whole // 3600 % 24:02}:{whole // 60 % 60:02}:{whole % 60:02}:"
                f"{(seconds - whole) * 60:06.3f}")

    def test_rows_and_names_of_the_app(self):
        generator = random.Random(4)
        times, time = [], 36000.25
        for _ in range(300):
            times.append(time)
            time += 1 / 59.98 + generator.uniform(-0.002, 0.002)
        clip = self.build(self.take(times))
        info = self.info(clip)
        self.assertEqual((info["rate"], info["frames"], info["channels"]),
                         ([60, 1], 300, LIVE_LINK))
        row = self.rows(clip)[1][200]
        self.assertEqual(row[1:], [nearest(round((200 * 7 + c) % 11 / 10, 3)) for c in range(61)])

    def test_other_rates_and_midnight(self):
        times = [86399.5 + k / 30 for k in range(60)]
        self.assertEqual(self.info(self.build(self.take(times)))["rate"], [30, 1])
        self.assertEqual(self.info(self.build(self.take(times), "--rate", "24"))["rate"], [24, 1])

    def test_resampling_keeps_the_time(self):
        times = [k / 50 for k in range(51)]
        clip = self.build(self.take(times), "--resample", "--rate", "60")
        self.assertEqual((self.info(clip)["frames"], self.info(clip)["rate"]), (61, [60, 1]))

    def test_frames_that_were_left_out_are_noted(self):
        times = [k / 60 for k in range(120) if not 40 < k < 70]
        source = write("gap.csv", self.take(times))
        done = self.ok("clip", "build", source, "-o", path("gap.clip"))
        self.assertIn("1.983 s were recorded, the clip takes 2.000 s", done.stderr)
        self.assertIn("--resample --rate 60", done.stderr)
        done = self.ok("clip", "build", source, "-o", path("gap.clip"), "--resample", "--rate", "60")
        self.assertEqual(done.stderr, "")
        self.assertEqual(self.info(path("gap.clip"))["frames"], 120)

    def test_what_is_wrong(self):
        good = self.take([0, 1 / 60])
        self.refuse_take(good.replace("00:00:00:01.000", "00:00:99:01.000"), ["row 3", "column 1"])
        self.refuse_take(good.replace("00:00:00:01.000", "one"), "timecode")
        self.refuse_take(good.replace("00:00:00:01.000", "00:00:00:00.000"), "not later")
        self.refuse_take(good.rsplit(",", 1)[0] + "\n", ["row 3", "62 columns", "63"])


class WrongTakes(ClipTest):
    def test_cells(self):
        for cell, says in (("", "is empty"), ("x", "not a number"), ("nan", "not a finite"),
                           ("inf", "not a finite"), ("1e39", "not a finite"), ("0x1", "not a number"),
                           ("1 2", "not a number"), ("1.2.3", "not a number")):
            self.refuse_take(f"time,a,jawOpen\n0,1,1\n1,1,{cell}\n",
                             ["row 3, column 3 (jawOpen)", says])

    def test_times(self):
        for cell, says in (("x", "not a time"), ("", "not a time"), ("inf", "not a time"),
                           ("0", "not later"), ("-1", "not later")):
            self.refuse_take(f"time,a\n0,1\n{cell},1\n", ["row 3, column 1 (time)", says])

    def test_tables(self):
        self.refuse_take("", "empty")
        self.refuse_take("time,a\n", "no rows")
        self.refuse_take("jawOpen,a\n1,2\n", ['the first column is "jawOpen", not "time"', "seconds"])
        self.refuse_take("time;a\n1;2\n", "commas")
        self.refuse_take("\ufeffx,y\n0,1\n".encode("utf-16-le"), "UTF-16")
        self.refuse_take("time,a,\n0,1,\n", "column 3")
        self.refuse_take("time,a,b,a\n0,1,2,3\n", ["column 4", "column 2"])
        self.refuse_take("time,a\n0,1\n1\n", ["row 3", "1 column,", "2"])
        self.refuse_take("time,a\n0,1\n1,2,3\n", "row 3")
        self.refuse_take("time,a\n0,\"1\n1,2\n", ["row 2", "quotation mark"])
        self.refuse_take("time,\"a\n0,1\n1,2\n", ["row 1", "quotation mark"])
        self.refuse_take("\0\0\0\0", "neither JSON")

    def test_json(self):
        for document, says in (
                ({"frames": []}, "frames"), ({"frame": [{}]}, "frames"),
                ({"frames": [1]}, "frames[0]"), ({"frames": [{}], "fps": 3}, "\"fps\""),
                ({"frames": [{"raw": {"a": "x"}}]}, "frames[0].raw[\"a\"]"),
                ({"frames": [{"raw": {"a": None}}]}, "expected a number"),
                ({"frames": [{"raw": [1]}]}, "no names"),
                ({"frames": [{"raw": 1}]}, "expected an array"),
                ({"frames": [{"row": {}}]}, "\"raw\""),
                ({"frames": [{"ml_mask": [1]}]}, "ml_mask"),
                ({"controls": ["a"], "frames": [{"raw": [1, 2]}]}, "2 numbers"),
                ({"controls": ["a", "a"], "frames": [{"raw": [1, 2]}]}, "twice"),
                ({"controls": [1], "frames": [{}]}, "names"),
                ({"rate": 0, "frames": [{}]}, "rate"), ({"rate": "x", "frames": [{}]}, "rate"),
                ({"events": 1, "frames": [{}]}, "it is not a list"),
                ({"events": [1], "frames": [{}]}, "events[0]: expected an object"),
                ({"events": [{"name": "M"}], "frames": [{}]}, "it has no time"),
                ({"events": [{"time": 0}], "frames": [{}]}, "it has no name"),
                ({"events": [{"time": -1, "name": "M"}], "frames": [{}]}, "its time is -1"),
                ({"events": [{"tick": 0.5, "name": "M"}], "frames": [{}]}, "its tick is 0.5"),
                ({"events": [{"tick": 0, "nam": "M"}], "frames": [{}]}, "no member \"nam\""),
                ({"events": [{"time": 1, "name": "M"}], "frames": [{}]},
                 "after the last of 1 frames, at 1 s"), ([1], "frames"),
                ({"frames": [{"time": 1}, {"time": 0}]}, "ascend"),
                ({"frames": [{"time": 1}, {}]}, "time")):
            self.refuse_take(json.dumps(document), says)
        self.refuse_take('{"frames": [{"raw": {"a": 1e39}}]}', ["1e39", "byte 30"])
        self.refuse_take('{"frames": [{"raw": {"a": 1, "a": 2}}]}', "twice")
        self.refuse_take('{"frames": [', "wrong.in")

    def test_limits(self):
        names = ",".join(f"c{i}" for i in range(513))
        rows = "".join(f"{k}," + ",".join([str(k)] * 513) + "\n" for k in range(2))
        self.refuse_take(f"time,{names}\n{rows}", "512")


if __name__ == "__main__":
    main()
