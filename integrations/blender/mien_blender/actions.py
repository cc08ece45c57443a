# SPDX-License-Identifier: MIT
"""Actions from arrays: one call per curve, not one per key."""
import bpy
import numpy as np


def new_action(name, owner):
    """A new action, made the one that `owner` plays."""
    data = owner.animation_data or owner.animation_data_create()
    action = bpy.data.actions.new(name)
    action.use_fake_user = True
    data.action = action
    return action


def _curve(action, owner, path, index):
    if hasattr(action, "fcurve_ensure_for_datablock"):  # actions with slots, since Blender 4.4
        return action.fcurve_ensure_for_datablock(owner, path, index=index)
    return action.fcurves.find(path, index=index) or action.fcurves.new(path, index=index)


def set_curve(action, owner, path, index, frames, values, group="", is_stepped=False):
    """Replaces a curve of the action by keys at `frames`; a constant curve gets one key."""
    values = np.asarray(values, np.float64)
    curve = _curve(action, owner, path, index)
    if len(curve.keyframe_points):
        curve.keyframe_points.clear() if hasattr(curve.keyframe_points, "clear") else _clear(curve)
    if np.all(values == values[0]):
        frames, values = frames[:1], values[:1]
    curve.keyframe_points.add(len(values))
    curve.keyframe_points.foreach_set("co", np.column_stack([frames, values]).ravel())
    # Linear: 1; constant: 0. What lies between the frames of a clip is the straight line.
    kind = 0 if is_stepped else 1
    curve.keyframe_points.foreach_set("interpolation", np.full(len(values), kind, np.int32))
    curve.update()
    return curve


def _clear(curve):
    while len(curve.keyframe_points):
        curve.keyframe_points.remove(curve.keyframe_points[-1], fast=True)


def sampled_frames(scene, start, end):
    """Sets the scene to each frame from start to end, and yields it; the frame of before is set at the end."""
    before = scene.frame_current
    try:
        for frame in range(start, end + 1):
            scene.frame_set(frame)
            yield frame
    finally:
        scene.frame_set(before)
