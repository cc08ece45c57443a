# SPDX-License-Identifier: MIT
"""The sets of expressions of `mien export --bake`, on a rig: as shape keys of a copy, and as poses.

The table, expression_sets.json, is made from that of the program when the add-on is built. Controls are found as the program
finds them, by mien_rig_match().
"""
import json
import os

import bpy
import numpy as np

from .binding import mien


def sets():
    """Names of the sets -> lists of (name, ways)."""
    with open(os.path.join(os.path.dirname(__file__), "expression_sets.json"), encoding="utf-8") as file:
        return json.load(file)


def _values(rig, name, value):
    """What a name of the table stands for on a rig: [(control, value)], or None if the rig lacks it."""
    try:
        _, shares = rig.match(name)
    except mien.UnknownNameError:
        return None
    return [(control, weight * value) for control, weight in shares.items()]


def _parse(way):
    """(plus, minus) of "jawOpen 0.5 tongueOut 1 - jawOpen 0.5": lists of (name, value)."""
    sides = way.split(" - ") if " - " in way else [way, ""]
    pairs = [iter(side.split()) for side in sides]
    return [[(name, float(next(words))) for name in words] for words in pairs]


def on_rig(rig, name):
    """Expressions of a set on a rig: [(name, plus, minus)] with lists of (control, value), and what is missing, as text."""
    found, missing = [], []
    for expression, ways in sets()[name]:
        lacks = []
        for way in ways.split("|"):
            way = f"{expression} 1" if way == "=" else way
            sides = [[(control, _values(rig, control, value)) for control, value in side] for side in _parse(way)]
            lacks.append([control for side in sides for control, values in side if values is None])
            if not lacks[-1]:
                plus, minus = ([pair for _, values in side for pair in values] for side in sides)
                found.append((expression, plus, minus))
                break
        else:
            missing.append(f"{expression} ({', '.join(dict.fromkeys(lacks[0]))})")
    return found, missing


class Poser:
    """Deforms the meshes of a rig file in poses."""

    def __init__(self, rig_file):
        self.file = rig_file
        self.face = rig_file.converted.instance()
        self.pose = rig_file.deformer.instance()
        self.initial = np.array(rig_file.rig.initial_raw_controls)

    def positions(self, mesh, lod, values):
        """float32 (n, 3), a copy. Values of the same control are added, then clamped to at most 1."""
        raw = self.face.raw_controls
        raw[:] = self.initial
        for control, value in values:
            raw[control] += value
        for control, _ in values:
            raw[control] = max(self.initial[control], min(1, raw[control]))
        self.face.evaluate(lod=lod)
        self.pose.update(self.face)
        self.pose.deform(mesh, mien.Normals.NONE)
        return np.array(self.pose.positions(mesh))


def bake_shapes(rig_object, rig_file, things, names, collection, progress=None):
    """Copies of mesh objects in neutral, without a skeleton, with a shape key per expression of the sets that moves them.
    Returns the copies, and what is missing."""
    expressions, missing = [], []
    for name in names:
        found, lacks = on_rig(rig_file.rig, name)
        expressions += found
        missing += lacks
    if not expressions:
        raise ValueError(f"the rig has the controls of none of the expressions of {', '.join(names)}")
    poser, copies = Poser(rig_file), []
    mesh_names = rig_file.rig.names(mien.Kind.MESH)
    for number, (thing, mesh_name) in enumerate(things):
        index = mesh_names.index(mesh_name)
        part = rig_file.deformer.mesh(index)
        lod = min(part.lods, default=0)
        data = thing.data.copy()
        copy = bpy.data.objects.new(f"{mesh_name} {'_'.join(names)}", data)
        collection.objects.link(copy)
        copy.shape_key_clear()
        copy.matrix_world = rig_object.matrix_world
        neutral = poser.positions(index, lod, [])
        least = 2e-6 * float(np.linalg.norm(neutral.max(0) - neutral.min(0))) if len(neutral) else 0
        data.vertices.foreach_set("co", neutral.ravel())
        copy.shape_key_add(name="Basis", from_mix=False)
        for i, (name, plus, minus) in enumerate(expressions):
            moved = poser.positions(index, lod, plus)
            base = poser.positions(index, lod, minus) if minus else neutral
            if np.abs(moved - base).max(initial=0) <= least and name not in ("viseme_sil", "viseme_0_silence"):
                continue
            data.vertices.foreach_set("co", (neutral + moved - base).ravel())
            copy.shape_key_add(name=name, from_mix=False).value = 0
            if progress:
                progress((number + i / len(expressions)) / len(things))
        data.vertices.foreach_set("co", neutral.ravel())
        data.update()
        copies.append(copy)
    return copies, missing
