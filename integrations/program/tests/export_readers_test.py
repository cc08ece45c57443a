#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Files of `mien export` in programs of others: the Khronos validator, where Node.js is installed and its package is in
$MIEN_GLTF_VALIDATOR/node_modules (default: build/gltf_validator, which `./dev test` fills), and Blender.

    export_readers_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)
"""
import base64
import json
import os
import shutil
import subprocess

from exported import ExportTest, distance, here, makes_heads, project, set_up, size_of, skip, validator, with_descriptor
from glb import Glb
import golden_rigs
from program import main, path, read, write


def setUpModule():
    set_up("tiny", "small", "medium", "large")


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
            "medium": [path("medium.dna")], "large": [path("large.dna"), "--lod", "2", "--skeleton"],
            "baked": [path("large.dna"), "--bake", "arkit", "--lod", "7"],
        }
        count = 1 + max(self.obj(path("tiny.dna")).groups["head_lod0_mesh"]["vertex"].values())
        colors = [(b"mien.colors.head_lod0_mesh", base64.b64encode(bytes(range(256)) * 99)[:4 * count])]
        jobs["colored"] = [write("colored.dna", with_descriptor(read("tiny.dna"), 0, (1, 2, 4), colors))]
        if makes_heads():
            self.ok("demo-head", "-o", path("head.dna"))
            jobs["head"] = [path("head.dna"), "--skeleton"]
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
