# SPDX-License-Identifier: MIT
"""The auto-rig: from a mesh with shape keys to a rig file and a character, by libmien-author."""
import os
import queue
import threading

import bpy
import numpy as np
from bpy.props import EnumProperty, IntProperty, StringProperty

from . import build_rig, live, rig_file
from .binding import mien

_AXES = [("X", "X", ""), ("Y", "Y", ""), ("Z", "Z", ""), ("MINUS_X", "-X", ""), ("MINUS_Y", "-Y", ""), ("MINUS_Z", "-Z", "")]


def head_of(thing, scene):
    """Arguments of mien.author_rig from a mesh object with shape keys, in the world's axes."""
    mesh = thing.data
    keys = mesh.shape_keys.key_blocks if mesh.shape_keys else []
    if len(keys) < 2:
        raise ValueError(f"{thing.name} has no shape keys: each expression has to be one")
    world = np.array(thing.matrix_world, np.float64)

    def points(data):
        values = np.zeros(3 * len(mesh.vertices), np.float32)
        data.foreach_get("co", values)
        return values.reshape(-1, 3).astype(np.float64)

    basis = points(keys[0].data)
    shapes = {}
    for key in list(keys)[1:]:
        moved = (points(key.data) - points(key.relative_key.data)) @ world[:3, :3].T
        moving = np.flatnonzero(np.abs(moved).max(1) > 1e-7)
        shapes[key.name] = moving, moved[moving]
    faces = [list(polygon.vertices) for polygon in mesh.polygons]
    found = {"positions": basis @ world[:3, :3].T + world[:3, 3], "faces": faces, "shapes": shapes,
             "objects": [(thing.name, len(faces))], "unit": 100 * scene.unit_settings.scale_length}
    if mesh.uv_layers:
        uvs = np.zeros(2 * len(mesh.loops), np.float32)
        mesh.uv_layers.active.data.foreach_get("uv", uvs)
        unique, corners = np.unique(uvs.reshape(-1, 2), axis=0, return_inverse=True)
        found["uvs"], found["corner_uvs"] = unique.astype(np.float64), corners.ravel().astype(np.uint32)
    return found


running = []  # jobs of operators that are waiting for them


class Job:
    """The work, in a thread of its own. It touches nothing of Blender's."""

    def __init__(self, arguments, path):
        self.arguments, self.path = arguments, path
        self.progress, self.canceled = queue.SimpleQueue(), threading.Event()
        self.error, self.report = None, None
        self.thread = threading.Thread(target=self._work, daemon=True)
        self.thread.start()

    def _step(self, step, share):
        self.progress.put((step, share))
        return self.canceled.is_set()

    def _work(self):
        try:
            made = mien.author_rig(**self.arguments, progress=self._step)
            if not self.canceled.is_set():
                made.dna.save(self.path)
                self.report = made.report
        except Exception as error:  # shown by the operator
            self.error = error

    @property
    def is_done(self):
        return not self.thread.is_alive()


class MIEN_OT_auto_rig(bpy.types.Operator):
    """Make a facial rig from the active mesh: each shape key becomes a control. Esc cancels"""

    bl_idname = "mien.auto_rig"
    bl_label = "Auto-Rig"
    bl_options = {"REGISTER", "UNDO"}

    filepath: StringProperty(name="Rig File", subtype="FILE_PATH", description="The .dna file to write")
    joints: IntProperty(name="Facial Joints", default=240, min=1, max=1000)
    lods: IntProperty(name="LODs", default=4, min=1, max=8)
    influences: IntProperty(name="Influences", default=8, min=1, max=12, description="Joints per vertex at most")
    up: EnumProperty(name="Up", items=_AXES, default="Z")
    front: EnumProperty(name="Front", items=_AXES, default="MINUS_Y", description="Where the face looks")

    _job = _timer = None

    @classmethod
    def poll(cls, context):
        thing = context.object
        if thing is None or thing.type != "MESH" or not thing.data.shape_keys:
            cls.poll_message_set("Select a mesh with shape keys")
            return False
        return True

    def _start(self, context):
        thing = context.object
        arguments = head_of(thing, context.scene)
        arguments.update(facial_joints=self.joints, lods=self.lods, influences=self.influences, name=thing.name,
                         up=mien.MeshAxis[self.up], front=mien.MeshAxis[self.front])
        path = bpy.path.abspath(self.filepath) if self.filepath else \
            os.path.join(bpy.path.abspath("//") or bpy.app.tempdir, bpy.path.clean_name(thing.name) + ".dna")
        self._job = Job(arguments, path)

    def _finish(self, context):
        job = self._job
        if job.canceled.is_set():
            self.report({"WARNING"}, "Canceled: nothing was written")
            return {"CANCELLED"}
        try:
            if job.error is not None:
                raise job.error
            rig_file.forget(job.path)
            made = build_rig.import_rig(context, job.path)
        except (OSError, ValueError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        share = job.report["fit"]["error"]
        self.report({"INFO"}, f"{made.name}: {len(made.data.bones)} bones; residual {100 * share:.1f} % of the motion; "
                    f"written to {job.path}")
        return {"FINISHED"}

    def execute(self, context):
        try:
            self._start(context)
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        if bpy.app.background:
            self._job.thread.join()
            return self._finish(context)
        running.append(self._job)
        manager = context.window_manager
        self._timer = manager.event_timer_add(0.1, window=context.window)
        manager.progress_begin(0, 100)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def invoke(self, context, _event):
        return context.window_manager.invoke_props_dialog(self)

    def modal(self, context, event):
        if event.type == "ESC":
            self._job.canceled.set()
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        while not self._job.progress.empty():
            step, share = self._job.progress.get()
            context.window_manager.progress_update(int(100 * share))
            context.workspace.status_text_set(f"Auto-rig: {step}, {100 * share:.0f} %. Esc cancels")
        if not self._job.is_done:
            return {"RUNNING_MODAL"}
        running.remove(self._job)
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)
        return self._finish(context)


_CLASSES = (MIEN_OT_auto_rig,)


def register():
    for made in _CLASSES:
        bpy.utils.register_class(made)


def unregister():
    for made in reversed(_CLASSES):
        bpy.utils.unregister_class(made)
