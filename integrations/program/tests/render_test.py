#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien render` and `mien inspect` from outside: pictures, sheets, frames, heat maps, and every way to
ask for them wrongly.

    render_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)

Rigs come from `mien gen` and from tests/golden.
"""
import base64
import json
import os
import struct
import sys
from pathlib import Path

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "tests", "support"))
import golden_rigs  # noqa: E402
import program  # noqa: E402
from picture import Picture  # noqa: E402
from program import USAGE, INVALID, FILE, ProgramTest, main, make, make_folder, path, write  # noqa: E402

GAP = 6


def setUpModule():
    make_folder()
    for preset in ("tiny", "small"):
        make("gen", "-o", path(preset + ".dna"), "--preset", preset)


class RenderTest(ProgramTest):
    def fails(self, *arguments, **more):
        self.assertEqual(super().fails(*arguments, **more).stdout, b"")

    def picture(self, *arguments, rig="tiny", **more):
        self.ok("render", path(rig + ".dna"), "-o", path("out.png"), *arguments, **more)
        with open(path("out.png"), "rb") as file:
            return Picture(file.read())

    def names(self, rig, kind):
        return self.ok("info", path(rig + ".dna"), "--names", kind).stdout.decode().splitlines()


class Render(RenderTest):
    def test_a_picture_shows_something_on_a_background(self):
        picture = self.picture()
        self.assertEqual((picture.width, picture.height), (640, 640))
        corner, middle = picture.at(3, 3), picture.at(320, 300)
        self.assertLess(max(corner), 80)
        self.assertGreater(middle[0], 110)
        self.assertGreater(middle[0], middle[2] + 20)  # skin is warm

    def test_sizes(self):
        for text, size in (("8x8", (8, 8)), ("97x31", (97, 31)), ("50", (50, 50)), ("64x300", (64, 300))):
            picture = self.picture("--size", text)
            self.assertEqual((picture.width, picture.height), size)
        for text in ("", "7", "0x0", "100x", "x100", "-5x5", "1e3", "4097x64", "64x99999", "64x64x64",
                     "64X64", "999999999999x1", "64 x 64"):
            self.fails(USAGE, "render", path("tiny.dna"), "-o", path("no.png"), "--size", text,
                       says="--size" if text else "empty")

    def test_the_same_bytes_every_time(self):
        arguments = ("render", path("small.dna"), "-o", "-", "--size", "120", "--set",
                     "eyeBlinkL=1", "--camera", "three-quarter")
        first = self.ok(*arguments).stdout
        self.assertEqual(self.ok(*arguments).stdout, first)
        self.assertEqual(Picture(first).width, 120)

    def test_cameras_differ(self):
        seen = []
        for camera in ("front", "three-quarter", "three-quarter-right", "side", "side-right", "back",
                       "above", "below", "20,10", "20,10,2", "20,10,2,45", "-20,0", "0,-90"):
            rows = self.picture("--size", "64", "--camera", camera).rows
            self.assertNotIn(rows, seen, camera)
            seen.append(rows)
        self.assertEqual(self.picture("--size", "64", "--camera", "0,0").rows, seen[0])
        for camera in ("fornt", "1", "1,x", "1,2,3,4,5", "nan,0", "0,91", "0,0,0", "0,0,1,1",
                       "1,2,", "1e99,0", "inf,0", ",", "0 ,0"):
            self.fails(USAGE, "render", path("tiny.dna"), "-o", path("no.png"), "--camera", camera,
                       says="--camera")
        self.fails(USAGE, "render", path("tiny.dna"), "-o", path("no.png"), "--camera", "fornt",
                   says='did you mean "front"')

    def test_targets(self):
        whole = self.picture("--size", "64").rows
        for target in ("eyes", "eyeLeft*", "EYELEFT_MESH", "*eye*"):
            self.assertNotEqual(self.picture("--size", "64", "--target", target).rows, whole)
        self.assertEqual(self.picture("--size", "64", "--target", "eyeLeft*").rows,
                         self.picture("--size", "64", "--target", "eyeLeft_mesh").rows)
        self.fails(INVALID, "render", path("tiny.dna"), "-o", path("no.png"), "--target", "nose*",
                   says=["nose*", "--target"])

    def test_controls_move_the_face(self):
        still = self.picture("--size", "96").rows
        raw = self.picture("--size", "96", "--set", "CTRL_expressions.mouthCornerPullL=1").rows
        self.assertNotEqual(raw, still)
        # Without the prefix.
        self.assertEqual(self.picture("--size", "96", "--set", "mouthCornerPullL=1").rows, raw)
        self.assertEqual(self.picture("--size", "96", "--set", "mouthCornerPullL=0").rows, still)
        gui = self.names("tiny", "gui")[0]
        self.assertNotEqual(self.picture("--size", "96", "--set", gui + "=1").rows, still)

    def test_wrong_controls(self):
        def wrong(code, setting, *says):
            self.fails(code, "render", path("tiny.dna"), "-o", path("no.png"), "--set", setting,
                       says=says)
        wrong(INVALID, "mouthCornerPulL=1", 'did you mean "CTRL_expressions.mouthCornerPullL"')
        wrong(INVALID, "zzz=1", "zzz", "--names raw,gui")
        for value in ("", "x", "1x", " 1", "0.5,"):
            wrong(USAGE, "mouthCornerPullL=" + value, "not a number")
        for value in ("nan", "inf", "-inf", "1e99", "3e38"):
            wrong(USAGE, "mouthCornerPullL=" + value, "finite")
        wrong(USAGE, "mouthCornerPullL", "NAME=VALUE")
        wrong(USAGE, "=1", "NAME=VALUE")

    def test_lods_and_meshes(self):
        coarse = self.picture("--size", "64", "--lod", "2", "--wireframe").rows
        self.assertNotEqual(self.picture("--size", "64", "--wireframe").rows, coarse)
        head = self.picture("--size", "64", "--meshes", "head*").rows
        self.assertNotEqual(self.picture("--size", "64").rows, head)
        self.assertEqual(self.picture("--size", "64", "--meshes", "head*,nothing").rows, head)
        no = ("render", path("tiny.dna"), "-o", path("no.png"))
        self.fails(INVALID, *no, "--lod", "3", says="LOD")
        self.fails(USAGE, *no, "--lod", "all", says="--lod")
        self.fails(USAGE, *no, "--lod", "64", says="--lod")
        self.fails(INVALID, *no, "--meshes", "haed_lod0_mesh", says='did you mean "head_lod0_mesh"')

    def test_samples_and_backgrounds(self):
        light = self.picture("--size", "64", "--background", "light")
        self.assertGreater(min(light.at(2, 2)), 180)
        pictures = [self.picture("--size", "64", "--samples", n).rows for n in ("1", "4", "16")]
        self.assertNotEqual(pictures[0], pictures[1])
        self.assertNotEqual(pictures[1], pictures[2])
        no = ("render", path("tiny.dna"), "-o", path("no.png"))
        self.fails(USAGE, *no, "--samples", "2", says="--samples")
        self.fails(USAGE, *no, "--background", "blue", says="--background")

    def test_vertex_colors(self):
        colors = self.with_colors("head_lod0_mesh", lambda n: bytes([20, 40, 220]) * n)
        blue = Picture(self.ok("render", colors, "-o", "-", "--size", "64").stdout).at(32, 30)
        self.assertGreater(blue[2], blue[0] + 60)
        # Colors that do not fit are not used; a note says so.
        plain = self.ok("render", path("tiny.dna"), "-o", "-", "--size", "64").stdout
        for content in (lambda n: b"\1\2\3" * (n - 1), lambda n: b"\1" * (3 * n + 1), lambda n: b""):
            done = self.ok("render", self.with_colors("head_lod0_mesh", content), "-o", "-", "--size", "64")
            self.assertIn("mien.colors.head_lod0_mesh", done.stderr)
            self.assertEqual(done.stdout, plain)
            done = self.ok("render", "-q", self.with_colors("head_lod0_mesh", content), "-o", "-",
                           "--size", "64")
            self.assertEqual(done.stderr, "")

    def with_colors(self, mesh, content):
        """tiny.dna in version 2.2, with one more pair in the metadata of its descriptor."""
        self.ok("convert", path("tiny.dna"), "-o", path("v22.dna"), "--version", "2.2")
        data = Path(path("v22.dna")).read_bytes()
        shown = json.loads(self.ok("inspect", path("tiny.dna"), "mouthCornerPullL", "--json").stdout)
        count = [m for m in shown["meshes"] if m["name"] == mesh][0]["positions"]

        # Behind signature and version: a table of layers, each with code, version, offset and size.
        layers, = struct.unpack(">I", data[7:11])
        table = [list(struct.unpack(">4sIII", data[11 + 16 * i:27 + 16 * i])) for i in range(layers)]
        desc = [layer for layer in table if layer[0] == b"desc"][0]
        at = desc[2]
        name, = struct.unpack(">I", data[at:at + 4])
        at += 4 + name + 2 + 2 + 2  # archetype, gender, age
        pairs, = struct.unpack(">I", data[at:at + 4])

        def text(s):
            return struct.pack(">I", len(s)) + s
        added = text(b"mien.colors." + mesh.encode()) + text(base64.b64encode(content(count)))
        for layer in table:
            layer[2] += len(added) if layer[2] > desc[2] else 0
        desc[3] += len(added)
        head = data[:11] + b"".join(struct.pack(">4sIII", *layer) for layer in table)
        return write("colored.dna", head + data[len(head):at] + struct.pack(">I", pairs + 1) + added +
                     data[at + 4:])

    def test_output(self):
        for arguments in ([], ["-o", ""]):
            self.fails(USAGE, "render", path("tiny.dna"), *arguments)
        self.fails(FILE, "render", path("tiny.dna"), "-o", path("none/out.png"), says="none/out.png")
        self.fails(FILE, "render", path("tiny.dna"), "-o", program.folder, says="irectory")
        self.fails(FILE, "render", path("missing.dna"), "-o", path("no.png"), says="missing.dna")
        self.fails(FILE, "render", path("tiny.dna"), "-o", "/dev/full", says="/dev/full")
        write("out.png", "old")
        self.picture("--size", "16")
        self.assertEqual([n for n in os.listdir(program.folder) if n.startswith(".")], [])
        done = self.ok("render", "-", "-o", "-", "--size", "16",
                       stdin=Path(path("tiny.dna")).read_bytes())
        self.assertEqual(Picture(done.stdout).width, 16)

    def test_rigs_that_cannot_be_drawn(self):
        self.ok("convert", path("tiny.dna"), "-o", path("bare.dna"), "--layers", "behavior")
        self.fails(INVALID, "render", path("bare.dna"), "-o", path("no.png"), says="geometry")
        os.remove(path("bare.dna"))
        broken = write("broken.dna", b"DNA no more")
        self.fails(INVALID, "render", broken, "-o", path("no.png"), says="broken.dna")
        data = Path(path("tiny.dna")).read_bytes()
        cut = write("cut.dna", data[:len(data) // 2])
        self.fails(INVALID, "render", cut, "-o", path("no.png"), says="cut.dna")

    def test_golden_rigs(self):
        for rig in golden_rigs.rigs().values():
            picture = Picture(self.ok("render", rig, "-o", "-", "--size", "48").stdout)
            self.assertEqual((picture.width, picture.height), (48, 48))


class Several(RenderTest):
    def tiles(self, picture, tile, columns, count, labels=True):
        """Checks the grid; returns the tiles and, per tile, whether there is ink below it."""
        label = int(max(9.0, min(26.0, tile / 15)) * 1.7) if labels else 0
        rows = (count + columns - 1) // columns
        self.assertEqual(picture.width, GAP + columns * (tile + GAP))
        self.assertEqual(picture.height, GAP + rows * (tile + label + GAP))
        page = picture.at(0, 0)
        found, inked = [], []
        for i in range(rows * columns):
            x, y = GAP + i % columns * (tile + GAP), GAP + i // columns * (tile + label + GAP)
            below = b"".join(picture.part(x, y + tile, tile, label))
            inked.append(below != bytes(page) * (len(below) // 3))
            found.append(picture.part(x, y, tile, tile))
        self.assertEqual(inked, [labels] * count + [False] * (rows * columns - count))
        return found

    def test_a_sheet_has_a_labeled_tile_for_each_control(self):
        for rig in ("tiny", "small"):
            count = len(self.names(rig, "raw"))
            picture = self.picture("--sheet", "--size", "48", "--columns", "7", rig=rig)
            tiles = self.tiles(picture, 48, 7, count)
            self.assertGreater(len({b"".join(t) for t in tiles[:count]}), count * 2 // 3)

    def test_a_tile_is_the_picture_of_its_control(self):
        sheet = self.picture("--sheet", "--select", "mouthCornerPullL", "--size", "64", "--target", "eyes")
        single = self.picture("--set", "mouthCornerPullL=1", "--size", "64", "--target", "eyes")
        self.assertEqual(self.tiles(sheet, 64, 1, 1)[0], single.part(0, 0, 64, 64))

    def test_selection(self):
        raw = [n.split(".")[-1] for n in self.names("small", "raw")]
        for pattern, wanted in (("jaw*", [n for n in raw if n.startswith("jaw")]),
                                ("*BLINK?", [n for n in raw if "Blink" in n]),
                                ("CTRL_expressions.brow*,jawOpen",
                                 [n for n in raw if n.startswith("brow") or n == "jawOpen"]),
                                ("*", raw)):
            if not wanted:
                continue
            picture = self.picture("--sheet", "--select", pattern, "--size", "16", "--columns", "5", rig="small")
            self.tiles(picture, 16, min(5, len(wanted)), len(wanted))
        no = ("render", path("tiny.dna"), "-o", path("no.png"))
        self.fails(INVALID, *no, "--sheet", "--select", "eyeBlinkX", says='did you mean "CTRL_expressions.eyeBlink')
        self.fails(USAGE, *no, "--select", "jaw*", says="--sheet")
        self.fails(USAGE, *no, "--sheet", "--columns", "0", says="--columns")
        self.fails(USAGE, *no, "--sheet", "--columns", "x", says="--columns")
        self.fails(USAGE, *no, "--columns", "3", says="--columns")
        self.fails(USAGE, *no, "--sheet", "--size", "4096", says="--size")

    def test_turntables(self):
        picture = self.picture("--turntable", "5", "--size", "40")
        tiles = self.tiles(picture, 40, 5, 5, labels=False)
        self.assertEqual(len({b"".join(t) for t in tiles}), 5)
        self.assertEqual(self.picture("--turntable", "1", "--size", "40").width, 40)
        no = ("render", path("tiny.dna"), "-o", path("no.png"))
        for number in ("0", "-1", "x", "3601", "1.5"):
            self.fails(USAGE, *no, "--turntable=" + number, says="--turntable")

    def test_frames(self):
        frames = write("frames.json", json.dumps({"frames": [
            {}, {"raw": {"CTRL_expressions.mouthCornerPullL": 1}}, {"gui": {}}]}))
        picture = self.picture("--frames", frames, "--size", "40", "--columns", "2")
        tiles = self.tiles(picture, 40, 2, 3)
        self.assertEqual(tiles[0], tiles[2])
        self.assertNotEqual(tiles[0], tiles[1])

        self.ok("render", path("tiny.dna"), "--frames", frames, "--size", "40", "-o", path("f-%04d.png"))
        numbered = sorted(n for n in os.listdir(program.folder) if n.startswith("f-"))
        self.assertEqual(numbered, ["f-0000.png", "f-0001.png", "f-0002.png"])
        for i, name in enumerate(numbered):
            self.assertEqual(Picture(Path(path(name)).read_bytes()).part(0, 0, 40, 40), tiles[i])
            os.remove(path(name))
        # Files of their own are as large as single pictures.
        self.ok("render", path("tiny.dna"), "--turntable", "1", "-o", path("t%d.png"), "--samples", "1")
        self.assertEqual(Picture(Path(path("t0.png")).read_bytes()).width, 640)
        os.remove(path("t0.png"))
        text = Path(frames).read_bytes()
        self.assertEqual(self.picture("--frames", "-", "--size", "40", "--columns", "2", stdin=text).rows,
                         picture.rows)

    def test_wrong_frames(self):
        no = ("render", path("tiny.dna"), "-o", path("no.png"))
        self.fails(FILE, *no, "--frames", path("none.json"), says="none.json")
        self.fails(INVALID, *no, "--frames", "-", says="JSON", stdin=b"{")
        self.fails(INVALID, *no, "--frames", "-", says="empty", stdin=b'{"frames": []}')
        self.fails(INVALID, *no, "--frames", "-", says="did you mean",
                   stdin=b'{"frames": [{"raw": {"CTRL_expressions.mouthCornerPulL": 1}}]}')
        self.fails(INVALID, *no, "--frames", "-", says="frames[0]", stdin=b'{"frames": [{"raw": [1]}]}')
        self.fails(INVALID, *no, "--frames", "-", says="large",
                   stdin=b'{"frames": [{"raw": {"CTRL_expressions.mouthCornerPullL": 1e99}}]}')
        self.fails(USAGE, "render", "-", "-o", path("no.png"), "--frames", "-", says="standard input")
        self.fails(USAGE, *no, "--frames", "x", "--sheet", says="exclude each other")
        self.fails(USAGE, *no, "--turntable", "3", "--sheet", says="exclude each other")
        self.fails(USAGE, *no, "--frames", "x", "--set", "a=1", says="--set")
        for name in ("%s.png", "%d-%d.png", "%", "%100d.png", "100%.png"):
            self.fails(USAGE, "render", path("tiny.dna"), "--sheet", "-o", path(name), says="%04d")
        self.fails(FILE, "render", path("tiny.dna"), "--turntable", "2", "-o", path("none/%d.png"),
                   says="none/0.png")


class Inspect(RenderTest):
    def inspect(self, rig, control, *more):
        def refuse(name):
            raise AssertionError("not a number of JSON: " + name)
        done = self.ok("inspect", path(rig + ".dna"), control, "--json", *more)
        return json.loads(done.stdout, parse_constant=refuse)

    def evaluate(self, rig, raw):
        frames = json.dumps({"frames": [{"raw": raw}]}).encode()
        done = self.ok("eval", path(rig + ".dna"), "--input", "-", "--lod", "0", stdin=frames)
        return json.loads(done.stdout)["frames"][0]["lods"][0]

    def test_it_tells_what_evaluation_does(self):
        for control in self.names("small", "raw")[::7]:
            found = self.inspect("small", control)
            pose, rest = self.evaluate("small", {control: 1}), self.evaluate("small", {})
            self.assertEqual(found["control"], control)
            self.assertEqual(found["kind"], "raw")
            moved = {i // 9 for i, (a, b) in enumerate(zip(pose["joints"], rest["joints"])) if a != b}
            self.assertEqual({j["index"] for j in found["joints"]}, moved)
            names = self.names("small", "joints")
            for joint in found["joints"]:
                at = joint["index"] * 9
                self.assertEqual(joint["name"], names[joint["index"]])
                change = [pose["joints"][at + k] - rest["joints"][at + k] for k in range(9)]
                self.assertEqual(joint["change"], change)
                self.assertAlmostEqual(joint["translation"], sum(c * c for c in change[:3]) ** 0.5, 5)
                self.assertAlmostEqual(joint["rotation"], max(map(abs, change[3:6])), 5)
            for kind in ("channels", "maps"):
                values = pose["blend_shapes" if kind == "channels" else "animated_maps"]
                before = rest["blend_shapes" if kind == "channels" else "animated_maps"]
                self.assertEqual({c["index"]: c["value"] for c in found[kind]},
                                 {i: v for i, v in enumerate(values) if v != before[i]})

    def test_correctives(self):
        raw = self.names("small", "raw")
        some = 0
        for control in raw[::5]:
            for corrective in self.inspect("small", control)["correctives"]:
                inputs = [control] + corrective["with"]
                pose = self.evaluate("small", {name: 1 for name in inputs})
                self.assertEqual(pose["psd"][corrective["index"]], corrective["value_together"])
                alone = self.evaluate("small", {control: 1})
                self.assertEqual(alone["psd"][corrective["index"]], corrective["value_alone"])
                self.assertGreaterEqual(corrective["beyond_sum"], 0)
                some += corrective["beyond_sum"] > 0.001
        self.assertGreater(some, 3)

    def test_regions(self):
        left = self.inspect("tiny", "mouthCornerPullL")
        right = self.inspect("tiny", "mouthCornerPullR")
        head = left["meshes"][0]
        self.assertEqual(head["name"], "head_lod0_mesh")
        self.assertGreater(head["max_distance"], 0)
        self.assertGreater(head["moved"], 0)
        self.assertLess(head["moved"], head["positions"])
        for k in range(3):
            self.assertLessEqual(head["box_min"][k], head["center"][k])
            self.assertLessEqual(head["center"][k], head["box_max"][k])
        # x points to the left of the character.
        self.assertGreater(head["center"][0], right["meshes"][0]["center"][0])
        still = self.inspect("tiny", "mouthCornerPullL", "--value", "0")
        self.assertEqual(still["joints"], [])
        self.assertEqual([m["moved"] for m in still["meshes"]], [0] * len(still["meshes"]))

    def test_gui_controls(self):
        gui = self.names("small", "gui")[0]
        found = self.inspect("small", gui)
        self.assertEqual(found["kind"], "gui")
        self.assertGreaterEqual(len(found["raw"]), 1)

    def test_text(self):
        text = self.ok("inspect", path("small.dna"), "jawOpen").stdout.decode()
        for word in ("CTRL_expressions.jawOpen", "Joints", "Blend shape channels", "Animated maps",
                     "Correctives", "Meshes", " cm"):
            self.assertIn(word, text)
        self.assertNotIn("\033", text)

    def test_without_geometry(self):
        self.ok("convert", path("small.dna"), "-o", path("bare.dna"), "--layers", "behavior")
        found = self.inspect("bare", "jawOpen")
        self.assertEqual(found["meshes"], [])
        self.assertEqual(found["joints"], self.inspect("small", "jawOpen")["joints"])
        self.assertIn("Meshes  none", self.ok("inspect", path("bare.dna"), "jawOpen").stdout.decode())
        self.fails(INVALID, "inspect", path("bare.dna"), "jawOpen", "-o", path("no.png"),
                   says="geometry")
        os.remove(path("bare.dna"))

    def test_heat_maps(self):
        self.ok("inspect", path("tiny.dna"), "mouthCornerPullL", "-o", path("heat.png"), "--size", "100")
        picture = Picture(Path(path("heat.png")).read_bytes())
        os.remove(path("heat.png"))
        self.assertEqual(picture.width, 3 * GAP + 200)
        def hot(picture):
            return sum(r > 1.5 * b and r > 100 for x in range(100) for y in range(100)
                       for r, g, b in [picture.at(GAP + x, GAP + y)])
        self.assertGreater(hot(picture), 20)
        self.ok("inspect", path("tiny.dna"), "mouthCornerPullL", "--value", "0", "-o",
                path("heat.png"), "--size", "100")
        self.assertEqual(hot(Picture(Path(path("heat.png")).read_bytes())), 0)
        os.remove(path("heat.png"))

    def test_wrong_usage(self):
        tiny = path("tiny.dna")
        self.fails(USAGE, "inspect", says="RIG is required")
        self.fails(USAGE, "inspect", tiny, says="CONTROL is required")
        self.fails(INVALID, "inspect", tiny, "mouthCornerPulL", says='did you mean "CTRL_expressions.mouth')
        self.fails(INVALID, "inspect", tiny, "psd0", says="psd0")
        for value in ("x", "nan", "inf", "1e99"):
            self.fails(USAGE, "inspect", tiny, "mouthCornerPullL", "--value", value, says="--value")
        self.fails(USAGE, "inspect", tiny, "mouthCornerPullL", "-o", "-", says="standard output")
        self.fails(USAGE, "inspect", tiny, "mouthCornerPullL", "-o", path("no.png"), "--camera", "up",
                   says="--camera")
        self.fails(USAGE, "inspect", tiny, "mouthCornerPullL", "-o", path("no.png"), "--size", "1",
                   says="--size")
        self.fails(INVALID, "inspect", tiny, "mouthCornerPullL", "--lod", "9", says="LOD")
        self.fails(USAGE, "inspect", tiny, "mouthCornerPullL", "--value", "3e38", says="finite")
        self.fails(FILE, "inspect", tiny, "mouthCornerPullL", "-o", path("none/heat.png"),
                   says="none/heat.png")


class Surroundings(RenderTest):
    def test_help_and_completion(self):
        for command in ("render", "inspect"):
            text = self.ok(command, "--help").stdout.decode()
            self.assertIn("Examples:", text)
            self.assertIn("mien " + command, text)
            for line in text.splitlines():
                self.assertLessEqual(len(line), 96, line)
        for shell in ("bash", "zsh", "fish"):
            script = self.ok("completion", shell).stdout.decode()
            for word in ("render", "inspect", "three-quarter", "turntable", "wireframe"):
                self.assertIn(word, script)


if __name__ == "__main__":
    main()
