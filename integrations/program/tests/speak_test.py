#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien speak`: text, sound and phonemes become takes, the same bytes each time; files of any content give an error."""
import ctypes.util
import json
import math
import os
import random
import struct
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "tests", "support"))
from program import (FILE, INVALID, USAGE, ProgramTest, cost, growth, main, make, make_folder, path,  # noqa: E402
                     read, run, write)

HAS_ESPEAK = ctypes.util.find_library("espeak-ng") is not None
HAS_SPHINX = ctypes.util.find_library("pocketsphinx") is not None and os.path.exists(
    "/usr/share/pocketsphinx/model/en-us/en-us/mdef")


def setUpModule():
    make_folder()
    make("demo-head", "-o", path("head.dna"))
    make("gen", "--preset", "metahuman-head", "-o", path("metahuman.dna"))


def phonemes(*rows, **more):
    return json.dumps({"phonemes": [{"label": label, "begin": begin, "end": end} for label, begin, end in rows], **more})


MAMA = (("m", 0.2, 0.3), ("a", 0.3, 0.45), ("m", 0.45, 0.55), ("a", 0.55, 0.75))

LONG = '''File type = "ooTextFile"
Object class = "TextGrid"

xmin = 0
xmax = 1
tiers? <exists>
size = 2
item []:
    item [1]:
        class = "IntervalTier"
        name = "words"
        xmin = 0
        xmax = 1
        intervals: size = 1
        intervals [1]:
            xmin = 0
            xmax = 1
            text = "a ""word"" that is much longer than any label of a phoneme is allowed to be: 63 bytes"
    item [2]:
        class = "IntervalTier"
        name = "phones"
        xmin = 0
        xmax = 1
        intervals: size = 6
'''


def long_grid(rows):
    text = LONG.replace("size = 6", "size = %d" % len(rows))
    for i, (label, begin, end) in enumerate(rows):
        text += '        intervals [%d]:\n            xmin = %g\n            xmax = %g\n            text = "%s"\n' % (
            i + 1, begin, end, label)
    return text


def short_grid(rows):
    lines = ['File type = "ooTextFile"', 'Object class = "TextGrid"', "", "0", "1", "<exists>", "1", '"IntervalTier"',
             '"phones"', "0", "1", str(len(rows))]
    for label, begin, end in rows:
        lines += ["%g" % begin, "%g" % end, '"%s"' % label]
    return "\n".join(lines) + "\n"


WITH_PAUSES = (("", 0, 0.2), *MAMA, ("sil", 0.75, 1))


def wav(samples, rate=16000, kind=1, bits=16, channels=1):
    if bits == 16:
        data = struct.pack("<%dh" % len(samples), *(int(32767 * s) for s in samples))
    else:
        data = struct.pack("<%df" % len(samples), *samples)
    block = channels * bits // 8
    form = struct.pack("<HHIIHH", kind, channels, rate, rate * block, block, bits)
    return b"RIFF" + struct.pack("<I", 36 + len(data)) + b"WAVEfmt " + struct.pack("<I", 16) + form + b"data" + \
        struct.pack("<I", len(data)) + data


def buzz(seconds, formants, rate=16000):
    """A voice of 120 Hz with its energy near some frequencies."""
    wave = []
    for i in range(int(seconds * rate)):
        t = i / rate
        wave.append(0.4 * sum(math.sin(2 * math.pi * 120 * k * t) * sum(
            math.exp(-((120 * k - f) / 120) ** 2) for f in formants) for k in range(1, 30)) / len(formants))
    return [max(-1, min(1, s)) for s in wave]


class Takes(ProgramTest):
    def frames(self, *arguments):
        self.ok("speak", *arguments, "-o", path("take.json"))
        return json.loads(read("take.json"))

    def test_the_same_input_gives_the_same_bytes(self):
        source = write("mama.json", phonemes(*MAMA))
        for end in ("clip", "json"):
            self.ok("speak", "--phonemes", source, "-o", path("one." + end))
            self.ok("speak", "--phonemes", source, "-o", path("two." + end))
            self.assertEqual(read("one." + end), read("two." + end))
        self.ok("clip", "verify", path("one.clip"))

    def test_forms_of_text_grids_and_json_give_the_same_take(self):
        self.ok("speak", "--phonemes", write("mama.json", phonemes(*MAMA, seconds=1)), "-o", path("a.clip"))
        aligner = {"start": 0, "end": 1, "tiers": {"phones": {"type": "interval",
                                                             "entries": [[b, e, label] for label, b, e in MAMA]}}}
        grid = long_grid(WITH_PAUSES)
        for name, content in (("long.TextGrid", grid), ("short.TextGrid", short_grid(WITH_PAUSES)),
                              ("wide.TextGrid", b"\xff\xfe" + grid.encode("utf-16-le")),
                              ("big.TextGrid", b"\xfe\xff" + grid.encode("utf-16-be")),
                              ("mfa.json", json.dumps(aligner))):
            self.ok("speak", "--phonemes", write(name, content), "-o", path("b.clip"))
            self.assertEqual(read("a.clip"), read("b.clip"), name)

    def test_alphabets_agree(self):
        takes = []
        for labels in (("ʃ", "aɪ", "θ", "ɹ"), ("SH", "AY1", "TH", "R"), ("S", "aI", "T", "r\\")):
            rows = [(label, 0.1 * i + 0.2, 0.1 * i + 0.3) for i, label in enumerate(labels)]
            frames = self.frames("--phonemes", write("word.json", phonemes(*rows)))["frames"]
            takes.append([frame["raw"]["mouthFunnel"] for frame in frames])
        self.assertGreater(max(takes[0]), 0.2)
        self.assertEqual(takes[0], takes[1])
        self.assertEqual(takes[0], takes[2])

    def test_unknown_labels_are_named(self):
        rows = (*MAMA, ("\u2603", 0.8, 0.9))
        done = self.ok("speak", "--phonemes", write("snow.json", phonemes(*rows)), "-o", path("snow.clip"))
        self.assertIn("no sound is known for 1 label: \u2603", done.stderr)
        self.fails(INVALID, "speak", "--phonemes", write("none.json", phonemes(("\u2603", 0, 1))), "-o", path("no.clip"),
                   says="no label is of a known alphabet")

    def test_events_name_phonemes_and_closures(self):
        events = self.frames("--phonemes", write("mama.json", phonemes(*MAMA, ("f", 0.8, 0.9), ("s", 0.9, 1))))["events"]
        names = [(event["name"], round(event["time"], 2)) for event in events]
        for expected in (("m", 0.2), ("close:lips", 0.2), ("close:lips", 0.45), ("close:lip-to-teeth", 0.8),
                         ("close:teeth", 0.9)):
            self.assertIn(expected, names)

    def test_rounding_is_anticipated(self):
        """Lips round during consonants before u, not during the same consonants before i."""
        rounded = []
        for vowel in "ui":
            rows = (("a", 0.2, 0.3), ("s", 0.3, 0.38), ("t", 0.38, 0.45), (vowel, 0.45, 0.6))
            frames = self.frames("--phonemes", write("stu.json", phonemes(*rows)))["frames"]
            rounded.append(frames[round(0.42 * 60)]["raw"]["mouthPucker"])
        self.assertGreater(rounded[0], 0.15)
        self.assertLess(rounded[1], 0.02)

    def test_stress_opens_the_jaw_and_raises_brows(self):
        def speak(stress):
            rows = [{"label": label, "begin": begin, "end": end} for label, begin, end in MAMA]
            rows[1]["stress"], rows[3]["stress"] = stress
            frames = self.frames("--phonemes", write("stress.json", json.dumps({"phonemes": rows})))["frames"]
            jaw = [frame["raw"]["jawOpen"] for frame in frames]
            brow = [frame["raw"]["browInnerUp"] for frame in frames]
            return max(jaw[18:27]), max(jaw[33:45]), brow.index(max(brow)) / 60
        first, second = speak(("primary", "none")), speak(("none", "primary"))
        self.assertGreater(first[0], second[0])
        self.assertGreater(second[1], first[1])
        self.assertLess(first[2], second[2])

    def test_phrases_end_with_a_blink_and_the_head_beats(self):
        take = self.frames("--phonemes", write("mama.json", phonemes(*MAMA, ("m", 2.5, 2.6), ("a", 2.6, 2.8))))
        lids = [frame["raw"]["eyeBlinkLeft"] for frame in take["frames"]]
        self.assertGreater(max(lids[45:60]), 0.9)
        self.assertEqual(max(lids[:44]), 0)
        self.assertEqual(take["variables"], ["head.up"])
        self.assertLess(min(frame["variables"][0] for frame in take["frames"]), -0.02)

    def test_clips_carry_the_beats_of_the_head(self):
        source = write("mama.json", phonemes(*MAMA))
        up = [frame["variables"][0] for frame in self.frames("--phonemes", source)["frames"]]
        self.ok("speak", "--phonemes", source, "-o", path("beats.clip"))
        self.assertEqual(json.loads(self.ok("clip", "info", path("beats.clip"), "--json").stdout)["channels"][-1], "head.up")
        # As frames, and back.
        self.ok("clip", "export", path("beats.clip"), "-o", path("beats.json"))
        frames = json.loads(read("beats.json"))
        self.assertEqual(frames["variables"], ["head.up"])
        self.assertEqual([frame["variables"][0] for frame in frames["frames"]], up)
        self.ok("eval", path("head.dna"), "--input", path("beats.json"), "-o", path("out.json"))
        self.ok("clip", "build", path("beats.json"), "-o", path("again.clip"))
        self.assertEqual(read("again.clip"), read("beats.clip"))
        # In a scene; a loop begins again.
        for loop, later in ((True, up[:20]), (False, [up[-1]] * 20)):
            scene = {"rate": 60, "seconds": 3, "layers": [{"name": "talk", "source": {"clip": "beats.clip", "loop": loop}}]}
            done = self.ok("play", write("scene.json", json.dumps(scene)), path("head.dna"), "-o", path("played.json"))
            self.assertNotIn("head.up", done.stderr)
            played = json.loads(read("played.json"))
            at = played["variables"].index("head.up")
            beats = [frame["variables"][at] for frame in played["frames"]]
            self.assertEqual(beats[:len(up) + 20], up + later)

    def test_rigs_with_other_names(self):
        source = write("mama.json", phonemes(*MAMA))
        take = self.frames("--phonemes", source, "--rig", path("metahuman.dna"))
        controls = self.names("metahuman.dna", "raw")
        self.assertEqual(take["controls"], controls)
        self.assertEqual(len(take["frames"][0]["raw"]), len(controls))
        at = controls.index("CTRL_expressions.mouthLipsTogetherUL")
        self.assertGreater(max(frame["raw"][at] for frame in take["frames"]), 0.005)
        self.ok("eval", path("metahuman.dna"), "--input", path("take.json"), "-o", path("out.json"))
        self.fails(INVALID, "speak", "--phonemes", source, "--rig", self.body(), "-o", path("no.clip"), says="none of the controls")

    def body(self):
        make("gen", "--preset", "body", "-o", path("body.dna"))
        return path("body.dna")


class Text(ProgramTest):
    def test_without_the_library_the_package_is_named(self):
        if HAS_ESPEAK:
            self.skipTest("NOT TESTED: mien speak without espeak-ng; it is installed")
        self.fails(FILE, "speak", "hello", "-o", path("no.clip"), says="espeak-ng")

    def test_texts_in_three_languages(self):
        if not HAS_ESPEAK:
            self.skipTest("NOT TESTED: mien speak TEXT; espeak-ng is not installed")
        for voice, text in (("en-us", "Hello, my friend."), ("de", "Guten Morgen, schöne Welt."),
                            ("es", "Buenos días, mi amigo.")):
            arguments = ("speak", text, "--voice", voice)
            self.ok(*arguments, "-o", path("a.clip"), "--wav", path("a.wav"), "--save-phonemes", path("a.json"))
            self.ok(*arguments, "-o", path("b.clip"), "--wav", path("b.wav"))
            self.assertEqual(read("a.clip"), read("b.clip"))
            self.assertEqual(read("a.wav"), read("b.wav"))
            # What was saved gives the same take.
            self.ok("speak", "--phonemes", path("a.json"), "-o", path("c.clip"))
            self.assertEqual(read("a.clip"), read("c.clip"))
            saved = json.loads(read("a.json"))
            self.assertIn("primary", [row.get("stress") for row in saved["phonemes"]])
            self.assertAlmostEqual(saved["seconds"], (len(read("a.wav")) - 44) / 2 / 22050, places=3)
        # A voice may be named by its language. Softness, tones and other languages within a text are no labels.
        for voice, text in (("en-gb", "Hello."), ("fr-fr", "Bonjour."), ("ru", "\u041f\u0440\u0438\u0432\u0435\u0442."),
                            ("ru", "\u041f\u0440\u0438\u0432\u0435\u0442, Bob.")):
            done = self.ok("speak", text, "--voice", voice, "-o", path("a.clip"), "--save-phonemes", path("a.json"))
            self.assertEqual(done.stderr, "")
            labels = [row["label"] for row in json.loads(read("a.json"))["phonemes"]]
            self.assertFalse([label for label in labels if label[0] in "(\u02b2"], labels)
        self.fails(USAGE, "speak", "hello", "--voice", "klingon-opera", "-o", path("no.clip"), says="no such voice")
        self.fails(INVALID, "speak", "...", "-o", path("no.clip"), says="nothing in it that can be said")

    def test_what_is_asked_must_fit(self):
        source = write("mama.json", phonemes(*MAMA))
        self.fails(USAGE, "speak", "-o", path("no.clip"), says="nothing to say")
        self.fails(USAGE, "speak", "a", "--phonemes", source, "-o", path("no.clip"), says="more than one")
        self.fails(USAGE, "speak", "--phonemes", source, "-o", path("no.txt"), says=".clip or .json")
        self.fails(USAGE, "speak", "--phonemes", source, "-o", path("no.clip"), "--wav", path("no.wav"), says="--wav")
        self.fails(USAGE, "speak", "--phonemes", source, "-o", path("no.clip"), "--text", "a", says="--text")
        self.fails(USAGE, "speak", "--phonemes", source, "-o", path("no.clip"), "--rate", "0", says="--rate")
        self.fails(USAGE, "speak", "--phonemes", source, "-o", source, says="mama.json")
        self.fails(FILE, "speak", "--phonemes", path("missing.json"), "-o", path("no.clip"), says="missing.json")


class Sounds(ProgramTest):
    def test_a_sound_moves_the_mouth(self):
        """As phonemes, or as a guess, which says so."""
        samples = [0.0] * 8000 + buzz(0.4, (750, 1200)) + [0.0] * 8000 + buzz(0.4, (280, 2300)) + [0.0] * 8000
        done = self.ok("speak", "--audio", write("vowels.wav", wav(samples)), "-o", path("vowels.json"))
        take = json.loads(read("vowels.json"))
        frames = take["frames"]
        self.assertEqual("source: a guess from energy and spectrum" in [event["name"] for event in take["events"]],
                         not HAS_SPHINX)
        self.assertEqual("a guess from energy and spectrum" in done.stderr, not HAS_SPHINX)
        if not HAS_SPHINX:
            self.assertGreater(max(frame["raw"]["jawOpen"] for frame in frames[30:54]), 0.08)

    def test_a_sound_with_its_text(self):
        if not HAS_SPHINX:
            self.skipTest("NOT TESTED: alignment of a sound with its text; pocketsphinx is not installed")
        if not HAS_ESPEAK:
            self.skipTest("NOT TESTED: alignment of a sound with its text; espeak-ng is not installed")
        text = "The bright lamp moves my friend."
        self.ok("speak", text, "-o", path("text.clip"), "--wav", path("text.wav"), "--save-phonemes", path("text.json"))
        done = self.ok("speak", "--audio", path("text.wav"), "--text", text, "-o", path("heard.clip"), "--save-phonemes",
                       path("heard.json"))
        self.assertEqual(done.stderr, "")
        said = [row["begin"] for row in json.loads(read("text.json"))["phonemes"] if row["label"] in "mbp"]
        heard = [row["begin"] for row in json.loads(read("heard.json"))["phonemes"] if row["label"] in ("M", "B", "P")]
        self.assertEqual(len(said), len(heard))
        for one, other in zip(said, heard):
            self.assertLess(abs(one - other), 0.12)

    def test_silence_is_no_speech(self):
        self.fails(INVALID, "speak", "--audio", write("silent.wav", wav([0.0] * 16000)), "-o", path("no.clip"),
                   says="it is silent")

    def test_formats_of_samples(self):
        samples = [0.0] * 4000 + buzz(0.5, (700, 1200)) + [0.0] * 4000
        for name, content in (("float.wav", wav(samples, kind=3, bits=32)),
                              ("cut.wav", wav(samples)[:-1001])):
            self.ok("speak", "--audio", write(name, content), "-o", path("format.clip"))

    def test_hostile_wav_files(self):
        good = wav(buzz(0.05, (700,)))
        self.fails(INVALID, "speak", "--audio", write("bad.wav", b"RIFF"), "-o", path("no.clip"), says="byte 0")
        self.fails(INVALID, "speak", "--audio", "/dev/zero", "-o", path("no.clip"), says="byte 0")
        wild = random.Random(1)
        for i in range(8):
            damaged = bytearray(good[:wild.randrange(len(good))] if i % 2 else good)
            for _ in range(3):
                if damaged:
                    damaged[wild.randrange(min(len(damaged), 44))] = wild.randrange(256)
            done = run("speak", "--audio", write("wild.wav", bytes(damaged)), "-o", path("wild.clip"))
            self.assertIn(done.returncode, (0, INVALID), done.stderr)
        # A header that promises more than the file has takes no memory for it.
        promise = good[:40] + struct.pack("<I", 0xFFFFFFF0) + good[44:]
        self.assertLess(cost("speak", "--audio", write("promise.wav", promise), "-o", path("p.clip"))[1], 500e6)


class Hostile(ProgramTest):
    def test_hostile_files_of_phonemes(self):
        for content, says in (("", "the file ends"), ("{", "byte"), ('{"phonemes": 1}', "no list"),
                              ('{"phonemes": [{"label": 1, "begin": 0, "end": 1}]}', "no text"),
                              (phonemes(("m", 0, 1e9)), "24 hours"), (phonemes(("m", 1, 0)), "ends before it begins"),
                              (phonemes(("m", 0, 1), ("a", 0.5, 2)), "before the one before"),
                              (phonemes(("m" * 100, 0, 1)), "63 bytes"), (phonemes(*MAMA, alphabet="runes"), "none of"),
                              (phonemes(("m", 0, 80000), ("a", 86000, 86001)), "too long for its size"),
                              (LONG, "the file ends"), (long_grid(MAMA).replace('"TextGrid"', '"Pitch"'), "no TextGrid"),
                              (short_grid(MAMA).replace("\n4\n", "\n99999999\n"), "1,000,000"),
                              (short_grid(MAMA).replace("0.45", "1e999"), "no number"),
                              (short_grid(MAMA)[:-2], "no end")):
            self.fails(INVALID, "speak", "--phonemes", write("bad", content), "-o", path("no.clip"), says=says)
        wild = random.Random(2)
        good = long_grid(WITH_PAUSES).encode()
        for _ in range(12):
            damaged = bytearray(good)
            for _ in range(4):
                damaged[wild.randrange(len(damaged))] = wild.randrange(256)
            done = run("speak", "--phonemes", write("wild", bytes(damaged)), "-o", path("wild.clip"))
            self.assertIn(done.returncode, (0, INVALID), done.stderr)

    def test_many_phonemes_take_what_they_hold(self):
        def speak(count):
            rows = [("a" if i % 2 else "m", i / 20000, (i + 1) / 20000) for i in range(count)]
            return "speak", "--phonemes", write("many%d.json" % count, phonemes(*rows)), "-o", path("many.clip")
        self.ok(*speak(20000))
        self.assertLess(growth(speak(5000), speak(20000)), 9)
        self.assertLess(cost(*speak(20000))[1], 200e6)


class Scenes(ProgramTest):
    def play(self, speech, **more):
        scene = {"rate": 60, "seconds": 1, "layers": [{"name": "talk", "group": "speech", "source": {"speech": speech}}], **more}
        self.ok("play", write("scene.json", json.dumps(scene)), path("head.dna"), "-o", path("played.json"), "-o",
                path("played.clip"))
        return json.loads(read("played.json"))

    def test_a_layer_speaks(self):
        write("mama.json", phonemes(*MAMA))
        played = self.play({"phonemes": "mama.json"})
        jaw = played["controls"].index("jawOpen")
        self.ok("speak", "--phonemes", path("mama.json"), "-o", path("take.json"))
        spoken = json.loads(read("take.json"))
        for one, other in zip(played["frames"], spoken["frames"]):
            self.assertAlmostEqual(one["raw"][jaw], other["raw"]["jawOpen"], places=6)
        # The head beats as in the take, and closures are events.
        up = played["variables"].index("head.up")
        self.assertAlmostEqual(min(f["variables"][up] for f in played["frames"]),
                               min(f["variables"][0] for f in spoken["frames"]), places=4)
        self.assertIn("close:lips", [event["name"] for event in played["events"]])

    def test_wrong_speech_in_scenes(self):
        for speech, says in (({}, "nothing to say"), ({"phonemes": "a", "text": "b"}, "both phonemes and"),
                             ({"words": "a"}, "no \"words\" here"), ({"text": 1}, "a string")):
            scene = {"layers": [{"name": "talk", "source": {"speech": speech}}]}
            self.fails(INVALID, "play", write("scene.json", json.dumps(scene)), path("head.dna"), says=says)


if __name__ == "__main__":
    main()
