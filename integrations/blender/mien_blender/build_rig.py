# SPDX-License-Identifier: MIT
"""A rig file as objects of a scene: an armature, meshes, a collection for each LOD."""
import bpy
import numpy as np
from mathutils import Matrix

from . import build_meshes, face_board, live
from .rig_file import open_file


def _bone_length(neutral):
    """Of all bones: short against the distances between joints, so that they do not hide the face."""
    positions = neutral[:, :3, 3]
    size = float(np.linalg.norm(positions.max(0) - positions.min(0))) if len(positions) else 0
    return size / 150 or 0.01


def build_armature(context, rig_file, name):
    """An armature object whose bones have the axes of the joints."""
    armature = bpy.data.armatures.new(name)
    thing = bpy.data.objects.new(name, armature)
    context.scene.collection.objects.link(thing)
    for other in context.selected_objects:
        other.select_set(False)
    context.view_layer.objects.active = thing
    thing.select_set(True)
    neutral = live.neutral_matrices(rig_file)
    length = _bone_length(neutral)
    bpy.ops.object.mode_set(mode="EDIT")
    try:
        bones = []
        for joint, parent in enumerate(rig_file.rig.joint_parents.tolist()):
            bone = armature.edit_bones.new(rig_file.joints[joint])
            bone.head, bone.tail = (0, 0, 0), (0, length, 0)
            bone.matrix = Matrix(neutral[joint].tolist())
            bone.length = length
            bones.append((bone, parent))
        for joint, (bone, parent) in enumerate(bones):
            if parent != joint:
                bone.parent = bones[parent][0]
                bone.use_connect = False
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")
    armature.display_type = "STICK"
    for bone in thing.pose.bones:
        bone.rotation_mode = "QUATERNION"
    context.scene.collection.objects.unlink(thing)
    return thing


def _collection(name, parent):
    collection = bpy.data.collections.new(name)
    parent.children.link(collection)
    return collection


def show_lod(rig_object):
    """Shows the collection of the LOD that is evaluated, hides the others."""
    for collection in (c for home in rig_object.users_collection for c in home.children):
        if "mien_lod" in collection:
            hidden = collection["mien_lod"] != rig_object.mien.lod
            collection.hide_viewport = collection.hide_render = hidden


def import_rig(context, path, *, lods=None, with_shapes=True, with_normals=True, with_board=True, progress=None):
    """Builds a character and returns its armature object.

    lods: which to build; None: all
    progress: called with a share from 0 to 1
    """
    if context.object is not None and context.object.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    rig_file = open_file(path)
    report = progress or (lambda share: None)
    rig_object = build_armature(context, rig_file, rig_file.name)
    home = _collection(rig_object.name, context.scene.collection)
    home.objects.link(rig_object)
    report(0.1)
    # Before there are meshes: changing to edit mode and back evaluates the scene.
    if with_board and rig_file.gui_controls:
        face_board.build(context, rig_object, rig_file, home)
    wanted = set(range(rig_file.rig.lod_count) if lods is None else lods)
    meshes = [] if rig_file.deformer is None else [m for m in rig_file.deformer.meshes if wanted & set(m.lods)]
    colors = build_meshes.vertex_colors(rig_file) if meshes else {}
    collections = {}
    key_owners = []
    for number, part in enumerate(meshes):
        mesh = build_meshes.build_mesh(rig_file, part.index, colors.get(part.name), with_normals)
        thing = bpy.data.objects.new(part.name, mesh)
        for lod in sorted(wanted & set(part.lods)):
            if lod not in collections:
                collections[lod] = _collection(f"{rig_object.name} LOD {lod}", home)
                collections[lod]["mien_lod"] = lod
            collections[lod].objects.link(thing)
        thing.parent = rig_object
        build_meshes.add_weights(rig_file, part.index, thing)
        thing.modifiers.new("Armature", "ARMATURE").object = rig_object
        span = 0.9 / len(meshes)
        begin = 0.1 + number * span
        if with_shapes and build_meshes.add_shape_keys(rig_file, part.index, thing,
                                                       lambda share: report(begin + span * share)):
            key_owners.append(mesh)
        report(begin + span)
    rig_object.mien.path = path
    rig_object.mien.lod = min(collections, default=0)
    live.add_controls(rig_object, rig_file)
    live.connect(rig_object, rig_file, [mesh.shape_keys for mesh in key_owners])
    show_lod(rig_object)
    context.view_layer.objects.active = rig_object
    return rig_object
