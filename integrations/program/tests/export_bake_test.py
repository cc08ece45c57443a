#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien export --bake`: expressions as targets against the rig, sets of expressions, and what the report says.

    export_bake_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)
"""
import json
import os
import re
import struct

from exported import ExportTest, distance, set_up, size_of
from glb import Glb
from program import FILE, INVALID, USAGE, main, make, path, read, write


def setUpModule():
    set_up("tiny", "large")


class Baking(ExportTest):
    """The large preset has the controls that make up all 52 expressions."""

    @classmethod
    def setUpClass(cls):
        done = make("export", path("large.dna"), "-o", path("baked.glb"), "--bake", "arkit", "--lod", "4",
                    "--no-quantize")
        cls.report = done.stdout.decode().splitlines()
        cls.glb_file = Glb(read("baked.glb"))

    def test_targets(self):
        glb = self.glb_file
        names = glb.target_names(glb.mesh_nodes()[0])
        self.assertEqual(len(set(names)), 52)
        for name in ("eyeBlinkLeft", "jawOpen", "mouthSmileRight", "browInnerUp", "tongueOut"):
            self.assertIn(name, names)

    def test_bones_of_head_neck_and_eyes_stay(self):
        rig = path("large.dna")
        glb = self.glb_file
        skin, = glb.json["skins"]
        names = [glb.json["nodes"][j]["name"] for j in skin["joints"]]
        self.assertTrue({"root", "neck", "head", "FACIAL_L_Eye1", "FACIAL_R_Eye1"} <= set(names), names)
        self.assertLess(len(names), 20)
        whole = self.glb(rig, "--lod", "4")
        for node in (glb, whole):
            node.bind = node.world_matrices(node.json["nodes"])
        for name in names:
            for a, b in zip(glb.bind[glb.node_of(name)], whole.bind[whole.node_of(name)]):
                self.assertAlmostEqual(a, b, places=5)
        # An eye turns with its bone, and the head takes all above the neck along.
        for bone, mesh in (("FACIAL_L_Eye1", "eyeLeft_mesh"), ("head", "head_lod4_mesh")):
            turned = Glb(read("baked.glb"))
            turned.json["nodes"][turned.node_of(bone)]["translation"] = [9, 9, 9]
            number = turned.node_of(mesh)
            moved = [distance(a, b) > 1 for a, b in zip(turned.deformed(number), glb.deformed(number))]
            self.assertGreater(sum(moved), len(moved) / 3, bone)

    def test_influences_and_expressions(self):
        """With fewer influences the expressions stay, and the loss of the bones is told."""
        loss = re.compile(r"(\d+) of (\d+) positions follow more than (\d) bones.*off by ([\d.]+) mm")
        told = {}
        for most in (4, 2, 1):
            done = self.ok("export", path("large.dna"), "-o", path("few.glb"), "--bake", "arkit", "--lod", "4",
                           "--no-quantize", "--influences", str(most))
            self.assertEqual(done.stdout.decode().splitlines(), self.report)
            found = loss.search(done.stderr)
            told[most] = float(found.group(4)) if found else 0.0
            few = Glb(read("few.glb"))
            for node in few.mesh_nodes():
                primitive = few.json["meshes"][few.json["nodes"][node]["mesh"]]["primitives"][0]
                weights = few.accessor(primitive["attributes"]["WEIGHTS_0"])
                self.assertNotIn("WEIGHTS_1", primitive["attributes"])
                for row in weights:
                    self.assertLessEqual(sum(weight > 0 for weight in row), most)
                    self.assertAlmostEqual(sum(row), 1, places=5)
            posed = self.obj(path("large.dna"), "--lod", "4", "--set", "jawOpen=1")
            self.assertLess(self.worst(few, posed, weights={"jawOpen": 1}), 5e-6)
        self.assertGreater(told[1], told[4])

    def test_correctives(self):
        rig = path("large.dna")
        done = self.ok("export", rig, "-o", path("corrected.glb"), "--bake", "arkit", "--correctives", "--lod", "4",
                       "--no-quantize")
        plain, corrected = re.findall(r"([\d.]+) mm rms, ([\d.]+) mm at most", done.stdout.decode())
        self.assertLess(float(corrected[0]), float(plain[0]))
        self.assertLess(float(corrected[1]), float(plain[1]))
        glb = Glb(read("corrected.glb"))
        node = glb.mesh_nodes()[0]
        names = glb.target_names(node)
        correctives = glb.json["meshes"][glb.json["nodes"][node]["mesh"]]["extras"]["correctives"]
        self.assertEqual([c["target"] for c in correctives], list(range(52, len(names))))
        # Controls of the rig that are expressions of the same name, so that --set and weights agree.
        known = {name.split(".")[-1] for name in self.names(rig, "raw")}
        tried = 0
        for corrective in correctives:
            pair = [names[i] for i in corrective["product"]]
            self.assertEqual(names[corrective["target"]], "+".join(pair))
            if not set(pair) <= known or tried == 3:
                continue
            tried += 1
            posed = self.obj(rig, "--lod", "4", *(word for name in pair for word in ("--set", name + "=1")))
            weights = dict.fromkeys(pair, 1)
            self.assertLess(self.worst(glb, posed, weights=weights), 1e-5, pair)
            self.assertGreater(self.worst(self.glb_file, posed, weights=weights), 5e-4, pair)
        self.assertGreater(tried, 0)
        self.fails(USAGE, "export", rig, "-o", path("no.glb"), "--correctives", says="--bake arkit")

    def test_each_end_is_the_rig(self):
        rig = path("large.dna")
        for name, controls in (("jawOpen", ["jawOpen=1"]), ("eyeBlinkLeft", ["eyeBlinkL=1"]),
                               ("mouthPressRight", ["mouthPressUR=1", "mouthPressDR=1"])):
            settings = [word for control in controls for word in ("--set", control)]
            posed = self.obj(rig, "--lod", "4", *settings)
            self.assertLess(self.worst(self.glb_file, posed, weights={name: 1}), 5e-6, name)
        self.assertLess(self.worst(self.glb_file, self.obj(rig, "--lod", "4"), weights={}), 1e-6)

    def test_report_is_right(self):
        """What it says of one expression, measured once more from outside."""
        rows = {line.split()[0]: line.split()[1:] for line in self.report[2:54]}
        self.assertEqual(len(rows), 52)
        self.assertIn("200 random combinations", self.report[54])
        still = self.obj(path("large.dna"), "--lod", "4")
        size = size_of(p for g in still.groups.values() for p in g["positions"].values())
        for name, control in (("jawOpen", "jawOpen"), ("mouthSmileLeft", "mouthCornerPullL")):
            half = self.obj(path("large.dna"), "--lod", "4", "--set", control + "=0.5")
            most = self.worst(self.glb_file, half, weights={name: 0.5}) * size * 1000
            self.assertAlmostEqual(most, float(rows[name][2]), delta=0.002)
            self.assertGreater(float(rows[name][0]), 1)

    def test_quiet_and_streams(self):
        rig = path("large.dna")
        options = ("--bake", "arkit", "--lod", "7")
        quiet = self.ok("export", rig, "-o", path("q.glb"), "--quiet", *options)
        self.assertEqual((quiet.stdout, quiet.stderr), (b"", ""))
        piped = self.ok("export", rig, "-o", "-", *options)
        self.assertEqual(piped.stdout, read("q.glb"))
        self.assertIn("random combinations", piped.stderr)

    def test_what_cannot_be_baked(self):
        out = path("no.glb")
        write("none.json", json.dumps({"a": {"nothing": 1}, "b": {"jawOpen": 1, "nowhere": 0.5}}))
        self.fails(INVALID, "export", path("tiny.dna"), "-o", out, "--bake", path("none.json"),
                   says=("controls of none of the expressions", "--bake"))
        self.fails(INVALID, "export", path("large.dna"), "-o", out, "--bake", "arkit", "--set", "jawOpen=1",
                   says="cannot be their weights")
        self.assertFalse(os.path.exists(out))
        for text, says in (("[]", "object"), ("{}", "expected an object"), ("{", "byte"),
                           ('{"a": {"jawOpen": 2}}', "a.jawOpen"), ('{"a": {"jawOpen": -0.1}}', "0 to 1"),
                           ('{"a": {"jawOpen": "1"}}', "a.jawOpen"), ('{"a": 1}', "none.json, a"),
                           ('{"a": {"plus": {}, "other": {}}}', "a.other"), ('{"a": {}, "a": {}}', "twice"),
                           ('{"a": {"plus": {"x": 1}, "minus": 3}}', "a.minus")):
            write("none.json", text)
            self.fails(INVALID, "export", path("large.dna"), "-o", out, "--bake", path("none.json"), says=says)
        write("many.json", json.dumps({str(i): {} for i in range(513)}))
        self.fails(INVALID, "export", path("large.dna"), "-o", out, "--bake", path("many.json"), says="512")
        self.fails(INVALID, "export", path("large.dna"), "-o", out, "--bake", "arkit,arkit", says="two expressions")
        self.fails(USAGE, "export", path("large.dna"), "-o", out, "--bake", "visems", says='"visemes"')
        self.fails(USAGE, "export", path("large.dna"), "-o", out, "--residuals", path("r.json"), says="--bake")
        self.fails(FILE, "export", path("large.dna"), "-o", out, "--bake", path("nowhere.json"), says="nowhere.json")


class ExpressionSets(ExportTest):
    """Sets of the program and of the user, on a rig with ARKit's names and one with MetaHuman's."""

    @classmethod
    def setUpClass(cls):
        make("demo-head", "-o", path("person.dna"))
        make("gen", "--preset", "metahuman-head", "-o", path("export.dna"))

    def bake(self, rig, *options):
        done = self.ok("export", path(rig), "-o", path("set.glb"), "--lod", "6", "--exact",
                       "--residuals", path("loss.json"), *options)
        names = {}
        glb = Glb(read("set.glb"))
        for mesh in glb.json["meshes"]:
            for name in mesh.get("extras", {}).get("targetNames", []):
                names[name] = True
        return done, glb, list(names), json.loads(read("loss.json"))

    def test_every_set_has_a_target_for_each_expression(self):
        counts = {"arkit": 52, "visemes": 15, "visemes22": 22, "unified": 98, "emotions": 7}
        for name, count in counts.items():
            _, _, targets, loss = self.bake("export.dna", "--bake", name)
            self.assertEqual(len(targets), count, name)
            self.assertEqual(list(loss["shapes"]), targets)
            self.assertEqual(loss["missing"], [])
        _, _, targets, _ = self.bake("export.dna", "--bake", "visemes,emotions")
        self.assertEqual(len(targets), 22)

    def test_what_a_rig_lacks_is_named_and_gets_no_target(self):
        done, _, targets, loss = self.bake("person.dna", "--bake", "unified")
        missing = [text.split(" ")[0] for text in loss["missing"]]
        self.assertIn("BrowPinchLeft", missing)
        self.assertIn("BrowPinchLeft (browLateralL)", done.stderr)
        self.assertEqual(len(targets) + len(missing), 98)
        self.assertEqual(set(targets) & set(missing), set())
        for name in ("visemes", "visemes22", "emotions", "arkit"):
            _, _, _, loss = self.bake("person.dna", "--bake", name)
            self.assertEqual(loss["missing"], [])

    def moves(self, glb, name):
        """Of each vertex of all meshes, by the target of that name."""
        moves = []
        for mesh in glb.json["meshes"]:
            names = mesh.get("extras", {}).get("targetNames", [])
            for primitive in mesh["primitives"]:
                count = glb.json["accessors"][primitive["attributes"]["POSITION"]]["count"]
                if name not in names:
                    moves += [(0.0, 0.0, 0.0)] * count
                    continue
                moves += glb.accessor(primitive["targets"][names.index(name)]["POSITION"])
        return moves

    def positions(self, *settings):
        options = [word for setting in settings for word in ("--set", setting)]
        groups = self.obj(path("person.dna"), "--lod", "6", *options).groups
        return [groups[name]["positions"][vertex] for name in groups for vertex in sorted(groups[name]["positions"])]

    def test_a_shape_is_the_rig_with_its_controls(self):
        write("own.json", json.dumps({
            "grin": {"mouthSmileLeft": 0.7, "mouthSmileRight": 0.4, "jawOpen": 0.3},
            "close": {"plus": {"jawOpen": 1, "mouthClose": 1}, "minus": {"jawOpen": 1}}, "rest": {}}))
        _, glb, targets, loss = self.bake("person.dna", "--bake", path("own.json"))
        self.assertEqual(targets, ["grin", "close", "rest"])
        rest = self.positions()
        grin = self.positions("mouthSmileLeft=0.7", "mouthSmileRight=0.4", "jawOpen=0.3")
        jaw = self.positions("jawOpen=1")
        closed = self.positions("jawOpen=1", "mouthClose=1")
        def largest(a, b):
            return max(distance(p, q) for p, q in zip(a, b))
        def largest_move(name):
            return max(distance(move, (0, 0, 0)) for move in self.moves(glb, name))
        self.assertAlmostEqual(largest_move("grin"), largest(grin, rest), delta=2e-5)
        self.assertAlmostEqual(largest_move("close"), largest(closed, jaw), delta=2e-5)
        self.assertEqual(largest_move("rest"), 0)
        self.assertGreater(loss["shapes"]["grin"]["worst"], 0)
        self.assertEqual(loss["shapes"]["rest"]["worst"], 0)

    def test_other_spellings_of_the_same_names(self):
        """A rig authored from shapes whose names have other sides, separators and cases."""
        make("export", path("person.dna"), "-o", path("shapes.glb"), "--lod", "6", "--bake", "arkit", "--exact")
        data = read("shapes.glb")
        size = struct.unpack_from("<I", data, 12)[0]
        text = data[20:20 + size].decode()
        for old, new in (("Left\"", "_L\""), ("Right\"", "_r\""), ("jawOpen", "jaw_open"), ("browInnerUp", "brow-inner-up")):
            self.assertIn(old, text)
            text = text.replace(old, new)
        # These two end in a word for a side and have none.
        for old, new in (("jaw_L", "jawLeft"), ("jaw_r", "jawRight"), ("mouth_L", "mouthLeft"), ("mouth_r", "mouthRight")):
            text = text.replace('"' + old + '"', '"' + new + '"')
        chunk = text.encode() + b" " * (-len(text.encode()) % 4)
        rest = data[20 + size:]
        write("spelled.glb", struct.pack("<4sIIII", b"glTF", 2, 20 + len(chunk) + len(rest), len(chunk), 0x4E4F534A)
              + chunk + rest)
        make("author", path("spelled.glb"), "-o", path("spelled.dna"), "--joints", "16", "--lods", "1")
        self.assertIn("mouthSmile_L", self.ok("info", path("spelled.dna"), "--names", "raw").stdout.decode().split())
        done = self.ok("export", path("spelled.dna"), "-o", path("set.glb"), "--bake", "arkit,visemes",
                       "--residuals", path("loss.json"))
        self.assertEqual(json.loads(read("loss.json"))["missing"], [], done.stderr)
        self.assertIn("mouthSmileLeft is mouthSmile_L", done.stderr)

        # Scenes and settings find them too.
        scene = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "examples", "scene.json")
        done = self.ok("play", scene, path("spelled.dna"), "-o", path("frames.csv"), "--seconds", "0.5")
        self.assertIn(b"mouthRollUpper", read("frames.csv").splitlines()[0])
        self.assertIn("cheekSquintRight is cheekSquint_r", done.stderr)
        self.ok("export", path("spelled.dna"), "-o", path("smile.obj"), "--set", "AU12_L=0.5")
        self.fails(INVALID, "export", path("spelled.dna"), "-o", path("no.obj"), "--set", "AU12=0.5",
                   says="is 2 controls of this rig")

        # What a file says goes first.
        write("names.json", b'{"jawOpen": {"jaw_open": 0.5}}')
        self.ok("export", path("spelled.dna"), "-o", path("half.glb"), "--bake", "arkit", "--names", path("names.json"),
                "--residuals", path("half.json"))
        write("names.json", b'{"jawOpen": "jaw_opem"}')
        for command in (("export", path("spelled.dna"), "-o", path("no.glb"), "--bake", "arkit"),
                        ("play", scene, path("spelled.dna"), "-o", path("no.csv"))):
            self.fails(INVALID, *command, "--names", path("names.json"), says='did you mean "jaw_open"?')
        for wrong in (b"[]", b'{"a": 1}', b'{"a": {}}', b'{"a": {"jaw_open": "1"}}', b'{"a": {"jaw_open": 1e9}}'):
            write("names.json", wrong)
            self.fails(INVALID, "export", path("spelled.dna"), "-o", path("no.glb"), "--bake", "arkit",
                       "--names", path("names.json"), says="names.json")

    def test_closures_of_speech_close_the_lips(self):
        # PP and 21_p press the lips: nothing opens them.
        _, glb, _, _ = self.bake("person.dna", "--bake", "visemes,visemes22")
        opened = max(distance(move, (0, 0, 0)) for move in self.moves(glb, "viseme_aa"))
        for name in ("viseme_PP", "viseme_21_p"):
            moved = max(distance(move, (0, 0, 0)) for move in self.moves(glb, name))
            self.assertLess(moved, opened / 2)
            self.assertGreater(moved, 0)
        for name in ("viseme_sil", "viseme_0_silence"):
            self.assertEqual(max(distance(move, (0, 0, 0)) for move in self.moves(glb, name)), 0)


if __name__ == "__main__":
    main()
