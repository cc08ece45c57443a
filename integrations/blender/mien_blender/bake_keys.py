# SPDX-License-Identifier: MIT
"""Bakes a live character to keys of its bones and shape keys, for other programs and for files without the add-on."""
import bpy
import numpy as np
from bpy.props import BoolProperty, IntProperty

from . import live
from .actions import new_action, sampled_frames, set_curve
from .operators import RigOperator, active_rig

_CHANNELS = (("location", 3), ("rotation_quaternion", 4), ("scale", 3))


def bake(context, rig_object, start, end, progress=None):
    """Keys for every bone and shape key that moves. The character then plays them, and is no longer live."""
    names = [bone.name for bone in rig_object.pose.bones]
    keys = live.keys_of(rig_object)
    frames, poses = [], {path: [] for path, _ in _CHANNELS}
    shapes = {key.name_full: [] for key in keys}
    for frame in sampled_frames(context.scene, start, end):
        depsgraph = context.evaluated_depsgraph_get()
        evaluated = rig_object.evaluated_get(depsgraph)
        for path, width in _CHANNELS:
            values = np.zeros(width * len(names), np.float32)
            evaluated.pose.bones.foreach_get(path, values)
            poses[path].append(values)
        for key in keys:
            values = np.zeros(len(key.key_blocks), np.float32)
            key.evaluated_get(depsgraph).key_blocks.foreach_get("value", values)
            shapes[key.name_full].append(values)
        frames.append(frame)
        if progress:
            progress((frame - start) / max(1, end - start))
    frames = np.array(frames, np.float64)
    rig_object.mien.live_action = rig_object.animation_data.action
    live.disconnect(rig_object, keys)
    action = new_action(f"{rig_object.name} baked", rig_object)
    for path, width in _CHANNELS:
        values = np.array(poses[path]).reshape(len(frames), len(names), width)
        rest = [1, 0, 0, 0] if width == 4 else [float(path == "scale")] * 3
        for i, name in enumerate(names):
            if np.all(values[:, i] == rest):
                continue
            for k in range(width):
                set_curve(action, rig_object, f'pose.bones["{bpy.utils.escape_identifier(name)}"].{path}', k, frames,
                          values[:, i, k])
    for key in keys:
        values = np.array(shapes[key.name_full])
        moving = [i for i in range(1, values.shape[1]) if np.any(values[:, i] != 0)]
        if moving:
            action = new_action(f"{key.name} baked", key)
        for i in moving:
            path = f'key_blocks["{bpy.utils.escape_identifier(key.key_blocks[i].name)}"].value'
            set_curve(action, key, path, 0, frames, values[:, i])
    return frames


class MIEN_OT_bake_keys(bpy.types.Operator, RigOperator):
    """Turn the performance into keys of bones and shape keys. The character stops being live; Make Live undoes that"""

    bl_idname = "mien.bake_keys"
    bl_label = "Bake to Keys"
    bl_options = {"REGISTER", "UNDO"}

    use_scene_range: BoolProperty(name="Scene Range", default=True, description="Bake the frame range of the scene")
    start: IntProperty(name="Start", default=1)
    end: IntProperty(name="End", default=250)

    def execute(self, context):
        rig_object, scene = active_rig(context), context.scene
        start, end = (scene.frame_start, scene.frame_end) if self.use_scene_range else (self.start, self.end)
        if end < start:
            return self.fail(f"the last frame, {end}, is before the first, {start}")
        if not is_live(rig_object):
            return self.fail(f"{rig_object.name} is not live: there is nothing to bake")
        manager = context.window_manager
        manager.progress_begin(0, 100)
        try:
            frames = bake(context, rig_object, start, end, lambda share: manager.progress_update(int(100 * share)))
        finally:
            manager.progress_end()
        self.report({"INFO"}, f"{len(frames)} frames baked")
        return {"FINISHED"}


def is_live(rig_object):
    data = rig_object.animation_data
    return data is not None and any(c.driver.expression.startswith("mien_pose") for c in data.drivers)


class MIEN_OT_make_live(bpy.types.Operator, RigOperator):
    """Evaluate the rig again, in place of baked keys, or after its drivers were removed or its bones changed"""

    bl_idname = "mien.make_live"
    bl_label = "Make Live"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        rig_object = active_rig(context)
        try:
            rig_file = live.file_of(rig_object)
        except (OSError, ValueError) as error:
            return self.fail(error)
        if rig_object.mien.live_action is not None:
            rig_object.animation_data.action = rig_object.mien.live_action
        keys = live.keys_of(rig_object)
        for key in keys:
            if key.animation_data:
                key.animation_data.action = None
        live.connect(rig_object, rig_file, keys)
        rig_object.update_tag()
        return {"FINISHED"}


_CLASSES = (MIEN_OT_bake_keys, MIEN_OT_make_live)


def register():
    for made in _CLASSES:
        bpy.utils.register_class(made)


def unregister():
    for made in reversed(_CLASSES):
        bpy.utils.unregister_class(made)
