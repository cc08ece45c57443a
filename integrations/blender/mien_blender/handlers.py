# SPDX-License-Identifier: MIT
"""What has to be forgotten when Blender loads a file, undoes, or changes a rest pose. None of it evaluates anything."""
import bpy
from bpy.app.handlers import persistent

from . import live, rig_file


@persistent
def _loaded(*_):
    rig_file.forget()
    live.register()  # loading a file empties the names that drivers can call
    for data in (*bpy.data.objects, *bpy.data.shape_keys):
        for curve in data.animation_data.drivers if data.animation_data else ():
            if curve.driver.expression.startswith("mien_"):
                curve.driver.is_valid = True


@persistent
def _undone(*_):
    live.forget_characters()


@persistent
def _changed(_scene, depsgraph):
    if depsgraph.id_type_updated("ARMATURE"):
        live.forget_characters()


_HANDLERS = (("load_post", _loaded), ("undo_post", _undone), ("redo_post", _undone), ("depsgraph_update_post", _changed))


def register():
    for name, function in _HANDLERS:
        getattr(bpy.app.handlers, name).append(function)


def unregister():
    for name, function in _HANDLERS:
        found = getattr(bpy.app.handlers, name)
        if function in found:
            found.remove(function)
