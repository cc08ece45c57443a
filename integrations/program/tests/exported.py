# SPDX-License-Identifier: MIT
"""What the tests of `mien export` share: files that are read back, deformed, and compared with Mien's deformer."""
import json
import math
import os
import random
import struct
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "tests", "support"))
from glb import Glb, Obj  # noqa: E402
from program import ProgramTest, make, make_folder, path, run  # noqa: E402

here = os.path.dirname(os.path.abspath(__file__))
project = os.path.dirname(os.path.dirname(os.path.dirname(here)))
validator = os.environ.get("MIEN_GLTF_VALIDATOR") or os.path.join(project, "build", "gltf_validator")


def set_up(*presets):
    """A folder with rigs of these presets."""
    make_folder()
    for preset in presets:
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
        """With all joints, influences and moves, unless the options say otherwise."""
        if "--bake" not in options:
            options += ("--skeleton",)
        if not {"--influences", "--bake"} & set(options):
            options += ("--influences", "12")
        if "--quantize" not in options:
            options += ("--no-quantize",) if "--bake" in options else ("--exact",)
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
