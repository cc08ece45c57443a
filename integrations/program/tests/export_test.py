#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien export`: what GLB and OBJ files hold, that a viewer deforms them as Mien does, and failures.

    export_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)
"""
import json
import math
import os
import random
import re

from exported import ExportTest, distance, say, set_up, size_of, with_descriptor
from glb import Glb
import golden_rigs
import program
from program import DONE, FILE, INVALID, USAGE, main, path, read, run, write


def setUpModule():
    set_up("tiny", "small", "medium")


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


class Failures(ExportTest):
    def test_help_and_completion(self):
        text = self.ok("export", "--help").stdout.decode()
        for word in ("Examples:", "--bake", "--animation", "--lod", "--set", "--influences"):
            self.assertIn(word, text)
        script = self.ok("completion", "bash").stdout.decode()
        self.assertIn("'export --influences')\n      COMPREPLY=($(compgen -W '1 2 4 8 12'", script)
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
        self.fails(USAGE, "export", rig, "-o", out, "--bake", "arkit", "--influences", "3", says="--influences")
        self.fails(USAGE, "export", rig, "-o", out, "--quantize", "--no-quantize", says="--quantize")
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


if __name__ == "__main__":
    main()
