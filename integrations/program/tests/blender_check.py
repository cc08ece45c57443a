# SPDX-License-Identifier: MIT
"""Run by Blender: what it makes of GLB files, as a line of JSON after "REPORT ".

    blender --background --factory-startup --python blender_check.py -- FILE...
"""
import json
import sys

import bpy
import numpy

# The importer that came with Blender 3.4 uses a name that later versions of NumPy dropped.
if not hasattr(numpy, "bool"):
    numpy.bool = bool


def report(path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=path)
    result = {"meshes": {}, "bones": {}, "actions": len(bpy.data.actions)}
    scene = bpy.context.scene
    scene.render.fps, scene.render.fps_base = 30, 1
    for armature in (o for o in bpy.data.objects if o.type == "ARMATURE"):
        for bone in armature.data.bones:
            result["bones"][bone.name] = bone.parent.name if bone.parent else None
    scene.frame_set(0)
    for thing in (o for o in bpy.data.objects if o.type == "MESH"):
        mesh = thing.data
        keys = mesh.shape_keys
        shown = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
        result["meshes"][mesh.name] = {
            "vertices": len(mesh.vertices),
            "triangles": len(mesh.polygons),
            "shape_keys": [key.name for key in keys.key_blocks][1:] if keys else [],
            "values": [key.value for key in keys.key_blocks][1:] if keys else [],
            "is_skinned": any(m.type == "ARMATURE" and m.object for m in thing.modifiers),
            "has_uvs": len(mesh.uv_layers) > 0,
            "has_colors": len(mesh.color_attributes) > 0,
            "materials": [slot.material.name for slot in thing.material_slots],
            # As deformed at frame 0, in the axes of Blender: z up, y to the back.
            "positions": [tuple(thing.matrix_world @ v.co) for v in shown.vertices],
        }
    return result


files = sys.argv[sys.argv.index("--") + 1:]
print("REPORT " + json.dumps([report(path) for path in files]))
