# SPDX-License-Identifier: MIT
"""The face board: a slider for each GUI control of the rig, as bones of an armature beside the face.

A GUI control is named after a slider and an axis, such as "CTRL_L_mouth_corner.ty". Files do not have the places of sliders,
so they are put in rows by region, the character's right side on the left.
"""
import re

import bpy
import numpy as np

REGIONS = ("brow", "eye", "ear", "nose", "cheek", "jaw", "mouth", "lip", "teeth", "tongue", "neck", "head")
AXES = {"tx": 0, "ty": 1, "tz": 2}


def slider_of(gui_control):
    """Name and axis of the slider of a GUI control."""
    name, _, axis = gui_control.rpartition(".")
    return (name, AXES[axis]) if axis in AXES else (gui_control, 1)


def _side(name):
    found = re.search(r"(?:^|_)([LRC])(?:_|$)", name)
    return found.group(1) if found else "C"


def _region(name):
    low = name.lower()
    return next((i for i, word in enumerate(REGIONS) if word in low), len(REGIONS))


def ranges(rig_file):
    """The smallest and the largest value of each GUI control that its mapping reads."""
    count = len(rig_file.gui_controls)
    low, high = np.zeros(count), np.zeros(count)
    try:
        table = rig_file.dna.read("bhvr.controls.conditionals")
    except (ValueError, LookupError):
        return low, np.ones(count)
    # Values of the file are never converted: GUI controls have no unit.
    for control, start, end in zip(table["inputIndices"], table["fromValues"], table["toValues"]):
        if control < count:
            low[control], high[control] = min(low[control], start), max(high[control], end)
    high[low == high] = 1
    return np.maximum(low, -10), np.minimum(high, 10)


def _knob(name, points):
    """A wire mesh for bones to be drawn with; made once per file."""
    found = bpy.data.objects.get(name)
    if found is None:
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(points, [(i, (i + 1) % len(points)) for i in range(len(points))], [])
        found = bpy.data.objects.new(name, mesh)
    return found


def _layout(names):
    """Places of sliders: rows of regions, columns right, center, left."""
    places, y = {}, 0.0
    for region in range(len(REGIONS) + 1):
        mine = [name for name in names if _region(name) == region]
        columns = {side: sorted((n for n in mine if _side(n) == side), key=names.index) for side in "RCL"}
        rows = 0
        for side, center in (("R", -9.0), ("C", 0.0), ("L", 9.0)):
            for i, name in enumerate(columns[side]):
                row, column = divmod(i, 3)
                # The left side mirrors the right one.
                x = (column - 1) * 2.8 * (-1 if side == "L" else 1)
                places[name] = (center + x, y - row * 2.8)
                rows = max(rows, row + 1)
        y -= rows * 2.8 + (1.0 if rows else 0)
    return places


def build(context, rig_object, rig_file, collection):
    """Builds the board beside the head; its sliders drive the rig after live.connect()."""
    names = list(dict.fromkeys(slider_of(gui)[0] for gui in rig_file.gui_controls))
    low, high = ranges(rig_file)
    places = _layout(names)
    armature = bpy.data.armatures.new(f"{rig_object.name} board")
    board = bpy.data.objects.new(armature.name, armature)
    collection.objects.link(board)
    context.view_layer.objects.active = board
    bpy.ops.object.mode_set(mode="EDIT")
    bone_names = {}
    try:
        for name in names:
            bone = armature.edit_bones.new(name)
            x, y = places[name]
            bone.head, bone.tail = (x, y, 0), (x, y + 0.5, 0)
            bone_names[name] = bone.name
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")
    knob = _knob("mien_knob", [(0.9 * np.cos(a), 0.9 * np.sin(a), 0) for a in np.linspace(0, 2 * np.pi, 16, False)])
    for name in names:
        bone = board.pose.bones[bone_names[name]]
        bone.custom_shape = knob
        bone.lock_rotation, bone.lock_scale = (True, True, True), (True, True, True)
        bone.rotation_mode = "XYZ"
        limit = bone.constraints.new("LIMIT_LOCATION")
        limit.owner_space = "LOCAL"
        limit.use_transform_limit = True
        used = {slider_of(gui)[1]: i for i, gui in enumerate(rig_file.gui_controls) if slider_of(gui)[0] == name}
        for axis, letter in enumerate("xyz"):
            control = used.get(axis)
            bone.lock_location[axis] = control is None
            setattr(limit, f"use_min_{letter}", True)
            setattr(limit, f"use_max_{letter}", True)
            setattr(limit, f"min_{letter}", 0 if control is None else float(low[control]))
            setattr(limit, f"max_{letter}", 0 if control is None else float(high[control]))
    armature.show_names = False
    _place(rig_file, board, places)
    _frames(rig_file, board, places, low, high)
    board.mien.rig = rig_object
    board.parent = rig_object
    rig_object.mien.board = board
    return board


def _place(rig_file, board, places):
    """To the right of the face, upright, as high as the rig."""
    deformer = rig_file.deformer
    points = [mesh.positions for mesh in deformer.meshes if mesh.position_count] if deformer else []
    if not points:
        points = [rig_file.converted.neutral_joint_values[:, :3]]
    least = np.min([p.min(0) for p in points], axis=0)
    most = np.max([p.max(0) for p in points], axis=0)
    height = float(most[2] - least[2]) or 0.3
    xs, ys = [x for x, _ in places.values()], [y for _, y in places.values()]
    scale = height / (max(ys) - min(ys) + 4)
    board.scale = (scale,) * 3
    board.rotation_euler = (np.pi / 2, 0, 0)
    board.location = (most[0] + (2 - min(xs)) * scale, least[1], most[2] - (max(ys) + 2) * scale)


def _frames(rig_file, board, places, low, high):
    """The tracks of the sliders, as one mesh of edges that is not selectable."""
    points, edges = [], []
    for name, (x, y) in places.items():
        box = np.zeros((2, 2))
        for i, gui in enumerate(rig_file.gui_controls):
            slider, axis = slider_of(gui)
            # The bone's own axes: x to the right, y up.
            if slider == name and axis < 2:
                box[0, axis], box[1, axis] = low[i], high[i]
        box[0] -= 0.12
        box[1] += 0.12
        first = len(points)
        points += [(x + box[i, 0], y + box[j, 1], 0) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
        edges += [(first + i, first + (i + 1) % 4) for i in range(4)]
    mesh = bpy.data.meshes.new(f"{board.name} frames")
    mesh.from_pydata(points, edges, [])
    thing = bpy.data.objects.new(mesh.name, mesh)
    for collection in board.users_collection:
        collection.objects.link(thing)
    thing.parent = board
    thing.hide_select = True
    thing.hide_render = True


def sliders(board):
    """(bone, axis) of everything that can be moved."""
    return [(bone.name, axis) for bone in board.pose.bones for axis in range(3) if not bone.lock_location[axis]]


class BoardReader:
    """GUI controls from the bones of a board."""

    def __init__(self, board, rig_file):
        at = {bone.name: i for i, bone in enumerate(board.pose.bones)}
        self.count = len(at)
        self.locations = np.zeros((self.count, 3), np.float32)
        found = [(at.get(slider_of(gui)[0], -1), slider_of(gui)[1]) for gui in rig_file.gui_controls]
        self.index = np.array([3 * bone + axis if bone >= 0 else 0 for bone, axis in found], np.int64)
        self.missing = np.array([bone < 0 for bone, _ in found], bool)

    def read(self, board):
        board.pose.bones.foreach_get("location", self.locations.ravel())
        values = self.locations.ravel()[self.index]
        values[self.missing] = 0
        return values
