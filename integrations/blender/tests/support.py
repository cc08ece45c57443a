# SPDX-License-Identifier: MIT
"""What the tests share. They run in Blender, with the add-on installed: see run.py."""
import os
import sys
import tempfile

import bpy
import numpy as np

ADDON = os.environ.get("MIEN_ADDON", "mien_blender")
addon = sys.modules[ADDON]
mien = sys.modules[ADDON + ".binding"].mien
live = sys.modules[ADDON + ".live"]
FOLDER = tempfile.mkdtemp(prefix="mien-blender-")


def module(name):
    return sys.modules[f"{ADDON}.{name}"]


def generated(preset):
    """The path of a generated rig, made once."""
    path = os.path.join(FOLDER, f"{preset}.dna")
    if not os.path.exists(path):
        mien.Dna.generate(mien.Preset[preset.upper()], seed=3).save(path)
    return path


def empty_scene():
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=False)


def import_rig(path, **options):
    assert bpy.ops.mien.import_rig(filepath=path, **options) == {"FINISHED"}
    return live.rig_of(bpy.context.object)


def set_controls(rig_object, values):
    """Raw controls by name or as a list of all."""
    names = live.file_of(rig_object).controls
    for name, value in values.items() if hasattr(values, "items") else zip(names, values):
        rig_object[name] = float(value)
    rig_object.update_tag()
    bpy.context.view_layer.update()


def vertices(thing):
    """float64 (n, 3) of an evaluated mesh object, in the world."""
    evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    found = np.zeros(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", found)
    evaluated.to_mesh_clear()
    world = np.array(thing.matrix_world, np.float64)
    return found.reshape(-1, 3) @ world[:3, :3].T + world[:3, 3]


class Reference:
    """The same rig in Mien alone: in the axes and angles of the file, converted here."""

    def __init__(self, path):
        self.dna = mien.Dna.open(path)
        self.rig = mien.Rig(self.dna)
        self.deformer = mien.Deformer(self.dna, self.rig)
        self.face = self.rig.instance()
        self.pose = self.deformer.instance()
        names = self.rig.names(mien.Kind.MESH)
        self.meshes = {name: i for i, name in enumerate(names)}
        info = self.dna.info
        assert info.axes == (mien.Direction.LEFT, mien.Direction.UP, mien.Direction.FRONT), info.axes
        self.scale = 0.01 if info.translation_unit == mien.TranslationUnit.CENTIMETERS else 1
        corners = np.concatenate([mesh.positions for mesh in self.deformer.meshes if mesh.position_count])
        self.diagonal = float(np.linalg.norm(corners.max(0) - corners.min(0))) * self.scale

    def vertices(self, controls, mesh, lod=0, gui=None):
        """float64 (n, 3) in Blender's axes: x to the character's left, y to the back, z up."""
        self.face.raw_controls[:] = controls
        if gui is not None:
            self.face.gui_controls[:] = gui
            self.face.map_gui_to_raw()
        self.face.evaluate(lod=lod)
        self.pose.update(self.face)
        self.pose.deform(self.meshes[mesh])
        x, y, z = self.pose.positions(self.meshes[mesh]).astype(np.float64).T * self.scale
        return np.stack([x, -z, y], axis=1)


def shown_meshes(rig_object):
    return [thing for thing in live.meshes_of(rig_object) if not thing.users_collection[0].hide_viewport]


def largest_error(rig_object, reference, controls, gui=None):
    """The largest distance of a vertex to where Mien puts it, as a share of the diagonal."""
    most = 0.0
    for thing in shown_meshes(rig_object):
        name = thing.name
        while name not in reference.meshes:  # a copy: head_lod0_mesh.001
            name = name.rpartition(".")[0]
        expected = reference.vertices(controls, name, rig_object.mien.lod, gui)
        most = max(most, float(np.linalg.norm(vertices(thing) - expected, axis=1).max()))
    return most / reference.diagonal
