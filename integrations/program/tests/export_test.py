#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien export`: what GLB and OBJ files hold, that a viewer deforms them as Mien does, and failures.

    export_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)

Rigs come from `mien gen` and from tests/golden. The Khronos validator runs where Node.js is installed
and its package is in $MIEN_GLTF_VALIDATOR/node_modules (default: build/gltf_validator, which
`./dev test` fills); Blender runs where it is installed.
"""
import json
import math
import os
import random
import re
import shutil
import struct
import subprocess
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "tests", "support"))
import golden_rigs  # noqa: E402
from glb import Glb, Obj  # noqa: E402
import program  # noqa: E402
from program import (DONE, USAGE, INVALID, FILE, ProgramTest, main,  # noqa: E402
                     make, make_folder, path, read, run, write)

PRESETS = ("tiny", "small", "medium", "large")

here = os.path.dirname(os.path.abspath(__file__))
project = os.path.dirname(os.path.dirname(os.path.dirname(here)))
validator = os.environ.get("MIEN_GLTF_VALIDATOR") or os.path.join(project, "build", "gltf_validator")


def setUpModule():
    make_folder()
    for preset in PRESETS:
        make("gen", "-o", path(preset + ".dna"), "--preset", preset)


def say(text):
    print(text, file=sys.stderr, flush=True)


def skip(what):
    say("NOT TESTED: " + what)
    raise unittest.SkipTest(what)


def makes_heads():
    return b"demo-head" in run("--help").stdout


def with_descriptor(dna, unit=None, axes=None, metadata=()):
    """The DNA with another descriptor, which is put behind all the rest."""
    count, = struct.unpack_from(">I", dna, 7)
    for entry in range(11, 11 + 16 * count, 16):
        if dna[entry:entry + 4] == b"desc":
            break
    offset, size = struct.unpack_from(">II", dna, entry + 8)
    desc = dna[offset:offset + size]
    at = 4 + struct.unpack_from(">I", desc)[0] + 6
    pairs, = struct.unpack_from(">I", desc, at)
    end = at + 4
    for _ in range(2 * pairs):
        end += 4 + struct.unpack_from(">I", desc, end)[0]
    text = b"".join(struct.pack(">I", len(word)) + word for pair in metadata for word in pair)
    rest = bytearray(desc[end:])
    if unit is not None:
        struct.pack_into(">H", rest, 0, unit)
    if axes is not None:
        struct.pack_into(">3H", rest, 4, *axes)
    desc = desc[:at] + struct.pack(">I", pairs + len(metadata)) + desc[at + 4:end] + text + rest
    result = bytearray(dna + desc)
    struct.pack_into(">II", result, entry + 8, len(dna), len(desc))
    return bytes(result)


def distance(a, b):
    return math.sqrt(sum((x - y) ** 2 for x, y in zip(a, b)))


def size_of(points):
    points = list(points)
    return distance([min(p[k] for p in points) for k in range(3)],
                    [max(p[k] for p in points) for k in range(3)])


class ExportTest(ProgramTest):
    def glb(self, rig, *options, **more):
        """With all influences and moves, unless the options say otherwise."""
        if not {"--influences", "--bake"} & set(options):
            options += ("--influences", "12")
        if not {"--quantize", "--bake"} & set(options):
            options += ("--exact",)
        return Glb(self.ok("export", rig, "-o", "-", *options, **more).stdout)

    def obj(self, rig, *options):
        return Obj(self.ok("export", rig, "-o", "-", "--format", "obj", *options).stdout.decode())

    def names(self, rig, kind):
        return self.ok("info", rig, "--names", kind).stdout.decode().splitlines()

    def info(self, rig):
        return json.loads(self.ok("info", rig, "--json").stdout)

    def worst(self, glb, obj, frame=None, weights=None):
        """Largest distance of a vertex from where OBJ has it, as a share of the size."""
        most, size = 0, size_of(p for group in obj.groups.values() for p in group["positions"].values())
        shown = glb.mesh_nodes(0)
        self.assertEqual([glb.json["nodes"][n]["name"] for n in shown], list(obj.groups))
        for number in shown:
            points = glb.deformed(number, frame, weights)
            group = obj.groups[glb.json["nodes"][number]["name"]]
            for vertex, position in group["positions"].items():
                most = max(most, distance(points[vertex], position))
        return most / size

    def random_pose(self, rig, seed, share=0.5):
        """Options, and the same as a frame."""
        random.seed(seed)
        values = {name: round(random.random(), 3) for name in self.names(rig, "raw")
                  if random.random() < share}
        settings = [word for name, value in values.items() for word in ("--set", "%s=%g" % (name, value))]
        return settings, {"raw": values}


class Deformation(ExportTest):
    """The skinned and morphed GLB against Mien's own deformer, which writes the OBJ."""

    def test_neutral_and_poses(self):
        for preset in ("tiny", "small"):
            rig = path(preset + ".dna")
            self.assertLess(self.worst(self.glb(rig), self.obj(rig)), 1e-6)
            for seed in range(4):
                settings, _ = self.random_pose(rig, seed)
                still, posed = self.obj(rig), self.obj(rig, *settings)
                worst = self.worst(self.glb(rig, *settings), posed)
                self.assertLess(worst, 3e-6, preset)
                # The pose is worth comparing.
                moved = max(distance(a, b) for name in still.groups for a, b in
                            zip(still.groups[name]["positions"].values(),
                                posed.groups[name]["positions"].values()))
                size = size_of(still.groups["head_lod0_mesh"]["positions"].values())
                self.assertGreater(moved, size / 200)

    def test_every_lod(self):
        rig = path("small.dna")
        settings, _ = self.random_pose(rig, 7)
        for lod in range(self.info(rig)["lod_count"]):
            options = ["--lod", str(lod), *settings]
            glb = self.glb(rig, *options)
            self.assertEqual(glb.json["scenes"][0]["name"], "LOD %d" % lod)
            self.assertLess(self.worst(glb, self.obj(rig, *options)), 3e-6)

    def test_all_lods_share_the_skeleton(self):
        rig = path("small.dna")
        info = self.info(rig)
        settings, _ = self.random_pose(rig, 8)
        glb = self.glb(rig, "--lod", "all", *settings)
        self.assertEqual([s["name"] for s in glb.json["scenes"]],
                         ["LOD %d" % lod for lod in range(info["lod_count"])])
        self.assertEqual(glb.json["scene"], 0)
        self.assertEqual(len(glb.json["skins"]), 1)
        meshes = set()
        for number, scene in enumerate(glb.json["scenes"]):
            self.assertEqual(scene["nodes"][0], 0)
            meshes |= set(glb.mesh_nodes(number))
        self.assertEqual(len(meshes), info["counts"]["meshes"])
        self.assertLess(self.worst(glb, self.obj(rig, "--lod", "0", *settings)), 3e-6)
        # A coarse mesh follows its own joints, which its own LOD moves in the same way.
        coarse = self.obj(rig, "--lod", "2", *settings)
        size = size_of(p for group in coarse.groups.values() for p in group["positions"].values())
        for node in glb.mesh_nodes(2):
            points = glb.deformed(node)
            for vertex, position in coarse.groups[glb.json["nodes"][node]["name"]]["positions"].items():
                self.assertLess(distance(points[vertex], position), 3e-6 * size)

    def test_animation_plays_the_frames(self):
        rig = path("tiny.dna")
        poses = [self.random_pose(rig, seed) for seed in range(3)]
        frames = json.dumps({"frames": [{}] + [frame for _, frame in poses]})
        glb = self.glb(rig, "--animation", "-", "--fps", "24", stdin=frames.encode())
        animation, = glb.json["animations"]
        times = glb.accessor(animation["samplers"][0]["input"])
        self.assertEqual(len(times), 4)
        for i, time in enumerate(times):
            self.assertAlmostEqual(time, i / 24, places=6)
        self.assertLess(self.worst(glb, self.obj(rig), frame=0), 3e-6)
        for i, (settings, _) in enumerate(poses):
            self.assertLess(self.worst(glb, self.obj(rig, *settings), frame=i + 1), 3e-6)
        # Joints that stay where they are have no channels.
        targets = {(c["target"]["node"], c["target"]["path"]) for c in animation["channels"]}
        self.assertEqual(len(targets), len(animation["channels"]))
        still = self.glb(rig, "--animation", "-", stdin=b'{"frames": [{}, {}]}')
        paths = {c["target"]["path"] for c in still.json["animations"][0]["channels"]}
        self.assertEqual(paths, {"weights"})

    def test_gui_controls_and_masks_are_frames_too(self):
        rig = path("tiny.dna")
        gui = self.names(rig, "gui")[0]
        frames = {"frames": [{"gui": {gui: 0.7}}]}
        glb = self.glb(rig, "--animation", "-", stdin=json.dumps(frames).encode())
        self.assertLess(self.worst(glb, self.obj(rig, "--set", gui + "=0.7"), frame=0), 3e-6)

    def test_units_and_axes(self):
        """Whatever the axes are called, the deformed shape is the deformer's, in meters, and its
        triangles face outwards."""
        left, right, up, down, front, back = range(6)
        rig = path("tiny.dna")
        settings, _ = self.random_pose(rig, 3)
        plain = self.glb(rig)
        number = plain.mesh_nodes(0)[0]
        reference = plain.deformed(number)
        for unit, axes in ((1, (left, up, front)), (0, (right, up, front)), (0, (right, up, back)),
                           (0, (front, left, up)), (1, (down, back, right)), (0, (up, right, front))):
            dna = write("axes.dna", with_descriptor(read("tiny.dna"), unit, axes))
            glb = self.glb(dna, *settings)
            self.assertLess(self.worst(glb, self.obj(dna, *settings)), 3e-6, axes)
            turned = self.glb(dna).deformed(number)
            basis = {left: (1, 0, 0), right: (-1, 0, 0), up: (0, 1, 0), down: (0, -1, 0),
                     front: (0, 0, 1), back: (0, 0, -1)}
            scale = 100 if unit else 1
            for a, b in zip(reference[::7], turned[::7]):
                expected = [scale * sum(a[k] * basis[axes[k]][i] for k in range(3)) for i in range(3)]
                self.assertLess(distance(expected, b), 1e-6 * scale)
            self.check_winding(self.glb(dna))
        crooked = write("axes.dna", with_descriptor(read("tiny.dna"), 0, (left, right, front)))
        self.fails(INVALID, "export", crooked, "-o", path("x.glb"), says=("axes", "coordinateSystem"))

    def check_winding(self, glb):
        for mesh in glb.json["meshes"]:
            primitive, = mesh["primitives"]
            points = glb.accessor(primitive["attributes"]["POSITION"])
            normals = glb.accessor(primitive["attributes"]["NORMAL"])
            corners = glb.accessor(primitive["indices"])
            outward = 0
            for i in range(0, len(corners), 3):
                a, b, c = (points[v] for v in corners[i:i + 3])
                u, v = [b[k] - a[k] for k in range(3)], [c[k] - a[k] for k in range(3)]
                area = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
                outward += sum(x * y for x, y in zip(area, normals[corners[i]])) > 0
            self.assertGreater(outward, 0.99 * len(corners) / 3)

    def test_fewer_influences_cost_little(self):
        rig = path("small.dna")
        settings, _ = self.random_pose(rig, 1)
        done = self.ok("export", rig, "-o", path("four.glb"), "--influences", "4", *settings)
        self.assertIn("follow more than 4 joints", done.stderr)
        four = Glb(read("four.glb"))
        for mesh in four.json["meshes"]:
            self.assertNotIn("JOINTS_1", mesh["primitives"][0]["attributes"])
        worst = self.worst(four, self.obj(rig, *settings))
        say("4 of 8 influences, small: off by %.2g of the size at most" % worst)
        self.assertLess(worst, 0.02)
        self.assertEqual(self.ok("export", rig, "-o", "-", *settings).stdout, read("four.glb"))
        self.assertLess(self.worst(self.glb(rig, "--influences", "8", *settings), self.obj(rig, *settings)), 3e-6)

    def test_loss_of_fewer_influences_is_what_the_note_says(self):
        """The worst of the expressions, measured once more from outside."""
        rig = path("small.dna")
        done = self.ok("export", rig, "-o", path("four.glb"))
        note = re.search(r"(\d+) of (\d+) positions .* off by ([\d.e-]+) mm rms, ([\d.e-]+) mm at most, with (\S+)\.",
                         done.stderr)
        self.assertTrue(0 < int(note[1]) <= int(note[2]), done.stderr)
        self.assertLess(float(note[3]), float(note[4]))
        posed = self.obj(rig, "--set", note[5] + "=1")
        size = size_of(p for g in posed.groups.values() for p in g["positions"].values())
        off = {}
        for count in ("4", "8"):
            glb = self.glb(rig, "--influences", count, "--set", note[5] + "=1")
            off[count] = self.worst(glb, posed) * size * 1000
        self.assertAlmostEqual(off["4"], float(note[4]), delta=0.06 * off["4"])
        self.assertLess(off["8"], 1e-2 * off["4"])

    def test_golden_rigs(self):
        """Files by another writer: more than 8 influences, weights that do not sum to 1, neutral
        rotations, radians, other orders of rotation, networks."""
        for name, rig in golden_rigs.rigs().items():
            settings, _ = self.random_pose(rig, 5, 0.2)
            if self.info(rig)["counts"]["raw_controls"] > 400:
                settings = settings[:400]
            self.assertLess(self.worst(self.glb(rig, *settings), self.obj(rig, *settings)), 1e-4, name)


class Contents(ExportTest):
    def test_names_and_hierarchy(self):
        for preset in ("tiny", "small"):
            rig = path(preset + ".dna")
            glb = self.glb(rig)
            nodes = glb.json["nodes"]
            skin, = glb.json["skins"]
            self.assertEqual([nodes[j]["name"] for j in skin["joints"]], self.names(rig, "joints"))
            self.assertEqual(skin["skeleton"], 0)
            children = [child for node in nodes for child in node.get("children", [])]
            self.assertEqual(sorted(children), sorted(skin["joints"]))
            meshes = [glb.json["meshes"][nodes[n]["mesh"]]["name"] for n in glb.mesh_nodes()]
            self.assertEqual(meshes, [nodes[n]["name"] for n in glb.mesh_nodes()])
            self.assertTrue(set(meshes) <= set(self.names(rig, "meshes")))
            channels = self.names(rig, "channels")
            for node in glb.mesh_nodes():
                names = glb.target_names(node)
                self.assertTrue(set(names) <= set(channels))
                self.assertEqual(len(set(names)), len(names))

    def test_attributes(self):
        rig = path("small.dna")
        glb = self.glb(rig)
        for mesh in glb.json["meshes"]:
            primitive, = mesh["primitives"]
            kinds = {name: glb.json["accessors"][index]["count"]
                     for name, index in primitive["attributes"].items()}
            self.assertEqual(len(set(kinds.values())), 1, kinds)
            self.assertTrue({"POSITION", "NORMAL", "TEXCOORD_0", "JOINTS_0", "WEIGHTS_0"} <= set(kinds))
            for normal in glb.accessor(primitive["attributes"]["NORMAL"]):
                self.assertAlmostEqual(math.hypot(*normal), 1, places=5)
            corners = glb.accessor(primitive["indices"])
            self.assertLess(max(corners), next(iter(kinds.values())))
        self.check_uvs_are_flipped(rig, glb)

    def check_uvs_are_flipped(self, rig, glb):
        text = self.ok("export", rig, "-o", "-", "--format", "obj").stdout.decode()
        uvs = [tuple(map(float, line.split()[1:])) for line in text.splitlines() if line[:3] == "vt "]
        flat = []
        for number in glb.mesh_nodes(0):
            mesh = glb.json["meshes"][glb.json["nodes"][number]["mesh"]]
            flat += glb.accessor(mesh["primitives"][0]["attributes"]["TEXCOORD_0"])
        self.assertEqual(len(flat), len(uvs))
        for (u, v), (u2, v2) in zip(flat, uvs):
            self.assertAlmostEqual(u, u2, places=6)
            self.assertAlmostEqual(v, 1 - v2, places=6)

    def test_targets_are_sparse_and_move_what_the_file_says(self):
        rig = path("small.dna")
        glb = self.glb(rig)
        sparse = total = 0
        for mesh in glb.json["meshes"]:
            for target in mesh["primitives"][0].get("targets", []):
                total += 1
                sparse += "sparse" in glb.json["accessors"][target["POSITION"]]
                self.assertIn("NORMAL", target)
        self.assertGreater(total, 50)
        self.assertGreater(sparse, total / 2)

    def test_materials_go_by_name(self):
        glb = self.glb(path("small.dna"))
        materials = glb.json["materials"]
        used = {mesh["name"]: materials[mesh["primitives"][0]["material"]]["name"]
                for mesh in glb.json["meshes"]}
        self.assertEqual(used["head_lod0_mesh"], "skin")
        self.assertEqual({used[name] for name in used if "eye" in name}, {"eyes"})

    def test_vertex_colors(self):
        """Red, green and blue of each position, in base64, in the descriptor."""
        import base64
        still = self.obj(path("tiny.dna"))
        name = "head_lod0_mesh"
        count = 1 + max(still.groups[name]["vertex"].values())
        raw = bytes((7 * i) % 256 for i in range(3 * count))
        metadata = [(b"mien.colors." + name.encode(), base64.b64encode(raw))]
        dna = write("colored.dna", with_descriptor(read("tiny.dna"), metadata=metadata))
        obj, glb = self.obj(dna), self.glb(dna)
        node = glb.node_of(name)
        primitive, = glb.json["meshes"][glb.json["nodes"][node]["mesh"]]["primitives"]
        accessor = glb.json["accessors"][primitive["attributes"]["COLOR_0"]]
        self.assertTrue(accessor["normalized"])
        colors = glb.accessor(primitive["attributes"]["COLOR_0"])
        for vertex, position in obj.groups[name]["vertex"].items():
            expected = [c / 255 for c in raw[3 * position:3 * position + 3]]
            for a, b in zip(expected, obj.groups[name]["colors"][vertex]):
                self.assertAlmostEqual(a, b, places=6)
            linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in expected]
            for a, b in zip(linear + [1], colors[vertex]):
                self.assertAlmostEqual(a, b, places=4)
        material = glb.json["materials"][primitive["material"]]
        self.assertEqual(material["pbrMetallicRoughness"]["baseColorFactor"], [1, 1, 1, 1])
        others = [m for m in glb.json["meshes"] if m["name"] != name]
        self.assertFalse(any("COLOR_0" in m["primitives"][0]["attributes"] for m in others))
        for value in (b"", b"AAA", b"AAAA", b"!" * len(metadata[0][1]), metadata[0][1] + b"AAAA"):
            dna = write("colored.dna", with_descriptor(read("tiny.dna"), metadata=[(metadata[0][0], value)]))
            for out in ("x.glb", "x.obj"):
                self.assertIn("mien.colors." + name, self.ok("export", dna, "-o", path(out)).stderr)
            self.assertFalse(any("COLOR_0" in m["primitives"][0]["attributes"]
                                 for m in self.glb(dna).json["meshes"]))

    def test_obj_keeps_quads(self):
        obj = self.obj(path("small.dna"))
        corners = {len(face) for group in obj.groups.values() for face in group["faces"]}
        self.assertEqual(corners, {3, 4})
        text = self.ok("export", path("small.dna"), "-o", "-", "--format", "obj").stdout.decode()
        self.assertIn("\ng head_lod0_mesh\n", text)

    def test_same_bytes(self):
        rig = path("small.dna")
        frames = write("frames.json", json.dumps({"frames": [{}, self.random_pose(rig, 2)[1]]}))
        for name, options in (("a.glb", ["--lod", "all"]), ("a.glb", ["--animation", frames]),
                              ("a.obj", ["--set", self.names(rig, "raw")[0] + "=1"])):
            self.ok("export", rig, "-o", path(name), *options)
            first = read(name)
            self.ok("export", rig, "-o", path(name), *options)
            self.assertEqual(read(name), first)
            # Materials are for files only.
            first = re.sub(rb"(mtllib|usemtl) .*\n", b"", first) if name == "a.obj" else first
            piped = self.ok("export", "-", "-o", "-", "--format", name[-3:], *options,
                            stdin=read("small.dna"))
            self.assertEqual(piped.stdout, first)
            slow = self.ok("export", rig, "-o", "-", "--format", name[-3:], *options, env={"MIEN_ISA": "sse2"})
            self.assertEqual(slow.stdout, first)


class Sizes(ExportTest):
    def test_quantized(self):
        """Half the bytes, and a few micrometers of a head."""
        rig = path("small.dna")
        settings, _ = self.random_pose(rig, 3)
        posed = self.obj(rig, *settings)
        glb, plain = self.glb(rig, "--quantize", *settings), self.glb(rig, *settings)
        self.assertEqual(glb.json["extensionsRequired"], ["KHR_mesh_quantization"])
        self.assertNotIn("extensionsRequired", plain.json)
        self.assertLess(self.worst(glb, posed), 6e-5)
        self.assertLess(len(glb.binary), 0.6 * len(plain.binary))
        for mesh in glb.json["meshes"]:
            attributes = mesh["primitives"][0]["attributes"]
            for normal in glb.accessor(attributes["NORMAL"]):
                self.assertAlmostEqual(math.hypot(*normal), 1, delta=0.02)
            for name in attributes:
                # Vertices begin at multiples of four.
                accessor = glb.json["accessors"][attributes[name]]
                stride = glb.json["bufferViews"][accessor["bufferView"]].get("byteStride", 4)
                self.assertEqual((stride % 4, accessor.get("byteOffset", 0) % 4), (0, 0), name)

    def test_less_of_it(self):
        rig = path("small.dna")
        whole, less = self.glb(rig), self.glb(rig, "--no-uvs", "--no-morph-normals")
        self.assertLess(len(less.binary), 0.9 * len(whole.binary))
        for mesh in less.json["meshes"]:
            primitive, = mesh["primitives"]
            self.assertNotIn("TEXCOORD_0", primitive["attributes"])
            self.assertFalse(any("NORMAL" in target for target in primitive.get("targets", [])))
        for option in ("--exact", "--quantize", "--no-uvs", "--no-morph-normals"):
            self.fails(USAGE, "export", rig, "-o", path("x.obj"), option, says=option)
        self.fails(USAGE, "export", rig, "-o", path("x.glb"), "--exact", "--quantize", says=("--exact", "--quantize"))


class Settings(ExportTest):
    def test_names_are_found_as_people_type_them(self):
        rig = path("tiny.dna")
        name = self.names(rig, "raw")[0]
        self.assertTrue(name.startswith("CTRL_expressions."), name)
        short = name.split(".")[1]
        expected = self.ok("export", rig, "-o", "-", "--set", name + "=0.5").stdout
        self.assertEqual(self.ok("export", rig, "-o", "-", "--set", short + "=0.5").stdout, expected)
        self.fails(USAGE, "export", rig, "-o", "-", "--set", name + "=1", "--set", short + "=0.5", says="twice")
        self.assertNotEqual(self.ok("export", rig, "-o", "-").stdout, expected)
        # The rig may stand behind.
        self.assertEqual(self.ok("export", "--set", name + "=0.5", rig, "-o", "-").stdout, expected)

    def test_wrong_settings(self):
        rig, out = path("tiny.dna"), path("no.glb")
        name = self.names(rig, "raw")[0]
        for word in (name, "=1", name + "=", name + "=x", name + "=1x", name + "=nan", name + "=inf",
                     name + "=1e99"):
            self.fails(USAGE, "export", rig, "-o", out, "--set", word, says="--set")
        self.fails(INVALID, "export", rig, "-o", out, "--set", name[:-1] + "q=1",
                   says=("q", 'did you mean "%s"' % name))
        self.fails(INVALID, "export", rig, "-o", out, "--set", "zzzzzzzz=1", says="mien info")
        self.assertFalse(os.path.exists(out))


class Baking(ExportTest):
    """The large preset has the controls that make up all 52 expressions."""

    @classmethod
    def setUpClass(cls):
        done = make("export", path("large.dna"), "-o", path("baked.glb"), "--bake", "arkit", "--lod", "4")
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

    def test_correctives(self):
        rig = path("large.dna")
        done = self.ok("export", rig, "-o", path("corrected.glb"), "--bake", "arkit", "--correctives", "--lod", "4")
        plain, corrected = re.findall(r": off by ([\d.]+) mm rms, ([\d.]+) mm at most", done.stdout.decode())
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


class ProceduralHead(ExportTest):
    """Its controls are the ARKit expressions, its vertices have colors."""

    @classmethod
    def setUpClass(cls):
        if not makes_heads():
            skip("the procedural head; this program does not make one")
        make("demo-head", "-o", path("head.dna"))

    def test_deforms_as_mien_does(self):
        rig = path("head.dna")
        settings = [w for s in ("jawOpen=0.8", "mouthSmileLeft=1", "eyeBlinkRight=0.7", "eyeLookUpLeft=1",
                                "tongueOut=0.5", "browInnerUp=1") for w in ("--set", s)]
        worst = self.worst(self.glb(rig, *settings), self.obj(rig, *settings))
        say("procedural head: %.2g of the size" % worst)
        self.assertLess(worst, 1e-5)

    def test_small_by_default_and_as_good(self):
        """What the README says: 6 MB at most, and what is left out cannot be seen. glTF without extensions."""
        rig, largest = path("head.dna"), 0
        self.ok("export", rig, "-o", path("default.glb"), "-q", "--force")
        size = os.path.getsize(path("default.glb"))
        self.assertLess(size, 6e6)
        self.assertNotIn("extensionsUsed", Glb(read("default.glb")).json)
        for seed in range(3):
            settings, _ = self.random_pose(rig, seed)
            small, exact = (Glb(self.ok("export", rig, "-o", "-", *options, *settings).stdout)
                            for options in ([], ["--exact"]))
            for number in exact.mesh_nodes(0):
                largest = max(largest, max(map(distance, small.deformed(number), exact.deformed(number))))
        say("procedural head: %.2f MB, off by %.2f mm at most" % (size / 1e6, largest * 1000))
        self.assertLess(largest, 0.2e-3)

    def test_faces_the_front_with_its_left_side_on_the_left(self):
        glb = self.glb(path("head.dna"), "--lod", "3")
        points = {glb.json["nodes"][n]["name"]: glb.deformed(n) for n in glb.mesh_nodes(0)}
        head = points["head_lod3_mesh"]
        middle = [(min(p[k] for p in head) + max(p[k] for p in head)) / 2 for k in range(3)]
        self.assertTrue(0.15 < max(p[1] for p in head) - min(p[1] for p in head) < 0.6)
        for name, sign in (("eyeLeft_lod3_mesh", 1), ("eyeRight_lod3_mesh", -1)):
            eye = [sum(p[k] for p in points[name]) / len(points[name]) for k in range(3)]
            self.assertGreater(sign * eye[0], 0.02)
            self.assertGreater(eye[1], middle[1])
            self.assertGreater(eye[2], middle[2])
        for mesh in glb.json["meshes"]:
            self.assertIn("COLOR_0", mesh["primitives"][0]["attributes"])

    def test_baked_animation(self):
        rig = path("head.dna")
        frames = [{}, {"raw": {"jawOpen": 1}}, {"raw": {"mouthSmileLeft": 0.25, "browInnerUp": 0.5}}]
        glb = self.glb(rig, "--lod", "3", "--bake", "arkit", "--animation", "-",
                       stdin=json.dumps({"frames": frames}).encode())
        self.assertEqual({c["target"]["path"] for c in glb.json["animations"][0]["channels"]}, {"weights"})
        node = glb.node_of("head_lod3_mesh")
        names = glb.target_names(node)
        self.assertEqual(len(names), 52)
        for i, frame in enumerate(frames):
            weights = dict(zip(names, glb.posed_nodes(i)[node]["weights"]))
            self.assertEqual({n: w for n, w in weights.items() if w}, frame.get("raw", {}))
        self.assertLess(self.worst(glb, self.obj(rig, "--lod", "3", "--set", "jawOpen=1"), frame=1), 5e-6)
        posed = self.glb(rig, "--lod", "3", "--bake", "arkit", "--set", "jawOpen=1", "--mouth-close", "alone")
        self.assertEqual(posed.deformed(node), glb.deformed(node, 1))


    def test_mouth_closes_with_the_jaw(self):
        rig = path("head.dna")
        closed = self.obj(rig, "--lod", "3", "--set", "jawOpen=1", "--set", "mouthClose=1")
        weights = {"jawOpen": 1, "mouthClose": 1}
        alone = self.ok("export", rig, "-o", path("alone.glb"), "--lod", "3", "--bake", "arkit")
        self.assertIn("--mouth-close jaw", alone.stderr)
        self.assertGreater(self.worst(Glb(read("alone.glb")), closed, weights=weights), 0.01)
        jaw = self.ok("export", rig, "-o", path("jaw.glb"), "--lod", "3", "--bake", "arkit", "--mouth-close", "jaw")
        self.assertEqual(jaw.stderr, "")
        self.assertLess(self.worst(Glb(read("jaw.glb")), closed, weights=weights), 5e-6)
        self.assertLess(self.worst(Glb(read("jaw.glb")), self.obj(rig, "--lod", "3"), weights={}), 1e-6)


class Failures(ExportTest):
    def test_help_and_completion(self):
        text = self.ok("export", "--help").stdout.decode()
        for word in ("Examples:", "--bake", "--animation", "--lod", "--set", "--influences"):
            self.assertIn(word, text)
        script = self.ok("completion", "bash").stdout.decode()
        self.assertIn("'export --influences')\n      COMPREPLY=($(compgen -W '4 8 12'", script)
        self.assertIn("'export --format')\n      COMPREPLY=($(compgen -W 'glb obj vrm usda'", script)
        self.assertIn("'export --lod')\n      COMPREPLY=($(compgen -W 'all'", script)
        self.assertIn("'export --animation')\n      COMPREPLY=($(compgen -f", script)

    def test_usage(self):
        rig, out = path("tiny.dna"), path("no.glb")
        frames = write("one.json", '{"frames": [{}]}')
        self.fails(USAGE, "export", rig, says="--output")
        self.fails(USAGE, "export", "-o", out, says="RIG")
        self.fails(USAGE, "export", rig, "-o", path("no.fbx"), says=(".glb", ".obj"))
        self.fails(USAGE, "export", rig, "-o", path("none"), says=(".glb", ".obj"))
        self.fails(USAGE, "export", rig, "-o", out, "--format", "gltf", says='did you mean "glb"')
        self.fails(USAGE, "export", rig, "-o", out, "--lod", "first", says="--lod")
        self.fails(USAGE, "export", rig, "-o", out, "--influences", "6", says="--influences")
        self.fails(USAGE, "export", rig, "-o", out, "--fps", "30", says="--animation")
        for rate in ("0", "-1", "x", "nan", "1e9"):
            self.fails(USAGE, "export", rig, "-o", out, "--animation", frames, "--fps", rate, says="--fps")
        self.fails(USAGE, "export", rig, "-o", out, "--animation", frames, "--set", "a=1", says="--set")
        self.fails(USAGE, "export", "-", "-o", out, "--animation", "-", says="standard input")
        self.fails(USAGE, "export", rig, "-o", out, "--bake", "arkit", "--influences", "4", says="--influences")
        self.fails(USAGE, "export", rig, "-o", out, "--mouth-close", "jaw", says="--bake arkit")
        self.fails(USAGE, "export", rig, "-o", out, "--bake", "arkit", "--mouth-close", "jow", says='"jaw"')
        for option in (["--bake", "arkit"], ["--animation", frames], ["--influences", "4"]):
            self.fails(USAGE, "export", rig, "-o", path("no.obj"), *option, says=option[0])
        self.assertFalse(os.path.exists(out) or os.path.exists(path("no.obj")))

    def test_input(self):
        rig, out = path("tiny.dna"), path("no.glb")
        self.fails(INVALID, "export", rig, "-o", out, "--lod", "30", says=(rig, "LOD"))
        self.fails(INVALID, "export", write("bad.dna", b"DNA"), "-o", out, says="bad.dna")
        self.fails(FILE, "export", path("absent.dna"), "-o", out, says="absent.dna")
        self.fails(FILE, "export", rig, "-o", path("absent/x.glb"), "--quiet", says="absent")
        self.fails(FILE, "export", rig, "-o", out, "--animation", path("absent.json"), says="absent.json")
        self.fails(INVALID, "export", rig, "-o", out, "--animation", write("f.json", "{"), says="f.json")
        self.fails(INVALID, "export", rig, "-o", out, "--animation",
                   write("f.json", '{"frames": []}'), says=("f.json", "none"))
        self.fails(INVALID, "export", rig, "-o", out, "--animation",
                   write("f.json", '{"frames": [{"raw": {"nope": 1}}]}'), says=("f.json", "nope"))
        self.ok("convert", rig, "-o", path("bare.dna"), "--layers", "behavior")
        self.fails(INVALID, "export", path("bare.dna"), "-o", out, says="bare")
        self.assertFalse(os.path.exists(out))
        self.assertEqual([name for name in os.listdir(program.folder) if name.startswith(".mien")], [])

    def test_truncated_and_damaged_files_fail_well(self):
        whole = read("tiny.dna")
        random.seed(4)
        for _ in range(60):
            damaged = bytearray(whole[:random.randrange(len(whole))] if random.random() < 0.3 else whole)
            for _ in range(random.randrange(1, 4)):
                if damaged:
                    damaged[random.randrange(len(damaged))] ^= 1 << random.randrange(8)
            done = run("export", write("damaged.dna", bytes(damaged)), "-o", path("damaged.glb"))
            self.assertIn(done.returncode, (DONE, INVALID), done.stderr)
            if done.returncode == DONE:
                Glb(read("damaged.glb"))


class Readers(ExportTest):
    """Programs that other people wrote."""

    made = []

    def files(self):
        """Names of files that together have all that the exporter writes."""
        if self.made:
            return self.made
        rig = path("small.dna")
        frames = write("frames.json", json.dumps(
            {"frames": [self.random_pose(rig, seed)[1] for seed in range(5)]}))
        jobs = {
            "tiny": [path("tiny.dna")], "small": [rig, "--lod", "all"],
            "eight": [rig, "--influences", "8"], "quantized": [rig, "--quantize"],
            "twelve": [rig, "--influences", "12"], "pose": [rig, *self.random_pose(rig, 9)[0]],
            "moving": [rig, "--animation", frames], "still": [rig, "--animation", write(
                "still.json", '{"frames": [{}]}')],
            "medium": [path("medium.dna")], "large": [path("large.dna"), "--lod", "2"],
            "baked": [path("large.dna"), "--bake", "arkit", "--lod", "7"],
        }
        import base64
        count = 1 + max(self.obj(path("tiny.dna")).groups["head_lod0_mesh"]["vertex"].values())
        colors = [(b"mien.colors.head_lod0_mesh", base64.b64encode(bytes(range(256)) * 99)[:4 * count])]
        jobs["colored"] = [write("colored.dna", with_descriptor(read("tiny.dna"), 0, (1, 2, 4), colors))]
        if makes_heads():
            self.ok("demo-head", "-o", path("head.dna"))
            jobs["head"] = [path("head.dna")]
            jobs["head_baked"] = [path("head.dna"), "--bake", "arkit", "--correctives", "--quantize", "--lod", "4"]
        for name, rig in golden_rigs.rigs().items():
            jobs["golden_" + name] = [rig, "--lod", "all"]
        for name, arguments in jobs.items():
            self.ok("export", *arguments, "-o", path(name + ".glb"), "--quiet")
        if makes_heads():
            self.ok("play", os.path.join(project, "examples", "scene.json"), path("head.dna"),
                    "--rate", "10", "-o", path("played.glb"), "--quiet")
            jobs["played"] = []
        self.made.extend(jobs)
        return self.made

    def test_khronos_validator(self):
        node = shutil.which("node") or shutil.which("nodejs")
        packages = os.path.join(validator, "node_modules")
        if not node or not os.path.isdir(os.path.join(packages, "gltf-validator")):
            skip("GLB files by the Khronos validator; Node.js or %s/gltf-validator is missing" % packages)
        names = self.files()
        done = subprocess.run([node, os.path.join(here, "gltf", "validator", "validate.js"),
                               *[path(name + ".glb") for name in names]], capture_output=True,
                              timeout=800, env={**os.environ, "NODE_PATH": packages})
        self.assertEqual(done.returncode, 0, done.stderr.decode())
        reports = [json.loads(line) for line in done.stdout.decode().splitlines()]
        self.assertEqual(len(reports), len(names))
        for name, report in zip(names, reports):
            serious = [m for m in report["messages"] if m["severity"] < 2]
            self.assertEqual((report["numErrors"], report["numWarnings"]), (0, 0), (name, serious[:5]))
            # The one remark: there is no texture for the texture coordinates.
            self.assertLessEqual({m["code"] for m in report["messages"]}, {"UNUSED_OBJECT"}, name)
        facts = dict(zip(names, (report["info"] for report in reports)))
        self.assertEqual(facts["moving"]["animationCount"], 1)
        if "played" in facts:
            self.assertEqual(facts["played"]["animationCount"], 1)
        self.assertEqual(facts["small"]["maxInfluences"], 4)
        self.assertEqual(facts["eight"]["maxInfluences"], 8)
        self.assertTrue(facts["baked"]["hasMorphTargets"] and facts["baked"]["hasSkins"])
        # It does see what is wrong.
        broken = bytearray(read("tiny.glb"))
        at = broken.index(b'"JOINTS_0"')
        broken[at:at + 10] = b'"JOINTS_7"'
        done = subprocess.run([node, os.path.join(here, "gltf", "validator", "validate.js"),
                               write("broken.glb", bytes(broken))], capture_output=True,
                              env={**os.environ, "NODE_PATH": packages})
        self.assertGreater(json.loads(done.stdout)["numErrors"], 0)

    def test_blender(self):
        blender = shutil.which("blender")
        if not blender:
            skip("GLB files in Blender; it is not installed (Debian package: blender)")
        names = [name for name in ("pose", "moving", "colored", "baked", "head_baked")
                 if name in self.files()]
        done = subprocess.run(
            [blender, "--background", "--factory-startup", "--python-exit-code", "1", "--python",
             os.path.join(here, "blender_check.py"), "--", *[path(name + ".glb") for name in names]],
            # Its Python takes the library of the first one on the path, which may not be Debian's.
            capture_output=True, timeout=800,
            env={**os.environ, "PATH": os.path.dirname(blender) + ":/usr/bin:/bin"})
        line = [line for line in done.stdout.decode().splitlines() if line.startswith("REPORT ")]
        self.assertEqual((done.returncode, len(line)), (0, 1), done.stderr.decode() + done.stdout.decode())
        for name, report in zip(names, json.loads(line[0][7:])):
            glb = Glb(read(name + ".glb"))
            frame = 0 if "animations" in glb.json else None
            joints = [glb.json["nodes"][j]["name"] for s in glb.json.get("skins", []) for j in s["joints"]]
            self.assertEqual(set(report["bones"]), set(joints), name)
            self.assertEqual(report["actions"] > 0, "animations" in glb.json, name)
            self.assertEqual(set(report["meshes"]), {m["name"] for m in glb.json["meshes"]}, name)
            for number in glb.mesh_nodes():
                node = glb.json["nodes"][number]
                mesh = glb.json["meshes"][node["mesh"]]
                seen = report["meshes"][mesh["name"]]
                primitive, = mesh["primitives"]
                self.assertEqual(seen["shape_keys"], glb.target_names(number))
                self.assertEqual(seen["is_skinned"], "skin" in node)
                self.assertEqual(seen["has_colors"], "COLOR_0" in primitive["attributes"])
                self.assertTrue(seen["has_uvs"])
                self.assertEqual(seen["materials"],
                                 [glb.json["materials"][primitive["material"]]["name"]])
                corners = glb.accessor(primitive["indices"])
                self.assertEqual(seen["triangles"], len(corners) // 3)
                used = sorted(set(corners))
                self.assertEqual(seen["vertices"], len(used))
                points = glb.deformed(number, frame)
                size = size_of(points)
                worst = max(distance((points[v][0], -points[v][2], points[v][1]), p)
                            for v, p in zip(used, seen["positions"]))
                self.assertLess(worst, 1e-4 * size, (name, mesh["name"]))


if __name__ == "__main__":
    main()
