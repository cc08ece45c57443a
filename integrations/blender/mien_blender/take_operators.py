# SPDX-License-Identifier: MIT
"""Commands on performances: import as an action of the controls, export as CSV."""
import csv
import os

import bpy
import numpy as np
from bpy.props import BoolProperty, FloatProperty, StringProperty
from bpy_extras.io_utils import ExportHelper, ImportHelper

from . import live, takes
from .actions import new_action, sampled_frames, set_curve
from .face_board import slider_of
from .operators import RigOperator, active_rig


def preferences(context):
    found = context.preferences.addons.get(__package__)
    return found.preferences if found else None


def scene_rate(scene):
    return scene.render.fps / scene.render.fps_base


def to_action(rig_object, rig_file, take, name, start, rate):
    """An action of the controls that a take drives. Frame i of the take is at start + seconds * rate, which may lie between
    two frames of the scene. Returns the channels that drive nothing."""
    rows, driven, missing = takes.raw_rows(take, rig_file)
    if not driven:
        raise ValueError(f"{name}: none of its {len(take.names)} channels drives a control of this rig; the first is "
                         f"{take.names[0] if take.names else 'absent'}")
    frames = start + take.seconds * rate
    action = new_action(name, rig_object)
    for control in driven:
        set_curve(action, rig_object, live.control_path(rig_file.controls[control]), 0, frames, rows[:, control])
    return missing


def to_board(rig_object, rig_file, take, name, start, rate):
    """The same for the sliders of the face board. What they cannot make stays in the controls, so that the sum is the take."""
    rows, driven, missing = takes.raw_rows(take, rig_file)
    board = rig_object.mien.board
    if not driven:
        raise ValueError(f"{name}: none of its {len(take.names)} channels drives a control of this rig")
    face, initial = rig_file.rig.instance(), rig_file.rig.initial_raw_controls
    sliders, rest = np.zeros((len(rows), len(rig_file.gui_controls)), np.float32), np.zeros_like(rows)
    for row, slider, left in zip(rows, sliders, rest):
        face.raw_controls = row
        face.map_raw_to_gui()
        slider[:] = face.gui_controls
        face.raw_controls = initial
        face.map_gui_to_raw()
        left[:] = row - face.raw_controls + initial
    frames = start + take.seconds * rate
    action = new_action(f"{name} board", board)
    for control, gui in enumerate(rig_file.gui_controls):
        bone, axis = slider_of(gui)
        if bone in board.pose.bones:
            set_curve(action, board, f'pose.bones["{bpy.utils.escape_identifier(bone)}"].location', axis, frames,
                      sliders[:, control])
    moving = [control for control in driven if np.abs(rest[:, control] - initial[control]).max() > 1e-6]
    action = new_action(name, rig_object)
    for control in driven:
        path = live.control_path(rig_file.controls[control])
        set_curve(action, rig_object, path, 0, frames,
                  rest[:, control] if control in moving else np.full(len(frames), initial[control]))
    return missing


class MIEN_OT_import_take(bpy.types.Operator, RigOperator, ImportHelper):
    """Import a performance as an action of the controls: CSV of the Live Link Face app, CSV with a column "time", a .clip,
    frames as JSON, or a scene of mien play"""

    bl_idname = "mien.import_take"
    bl_label = "Import Performance"
    bl_options = {"REGISTER", "UNDO"}

    filename_ext = ""
    filter_glob: StringProperty(default="*.csv;*.clip;*.json", options={"HIDDEN"})
    start: FloatProperty(name="Start Frame", default=1, description="The frame of the scene where the first frame comes")
    to_board: BoolProperty(name="To Face Board", default=False,
                           description="Key the sliders of the face board, as far as they can make the performance")
    set_range: BoolProperty(name="Set Scene Range", default=True, description="Let the scene end with the performance")

    def execute(self, context):
        rig_object, path = active_rig(context), self.filepath
        try:
            rig_file = live.file_of(rig_object)
            if takes.is_scene(path):
                chosen = preferences(context)
                take = takes.play_scene(path, rig_file.path, bpy.path.abspath(chosen.program) if chosen else "")
            else:
                take = takes.read(path)
            rate = scene_rate(context.scene)
            name = os.path.splitext(os.path.basename(path))[0]
            if self.to_board and rig_object.mien.board is None:
                return self.fail(f"{rig_object.name} has no face board: its file has no GUI controls, or it was not imported")
            convert = to_board if self.to_board else to_action
            missing = convert(rig_object, rig_file, take, name, self.start, rate)
        except (OSError, ValueError) as error:
            return self.fail(error)
        if self.set_range:
            context.scene.frame_end = max(1, int(np.ceil(self.start + take.seconds[-1] * rate)))
        if missing:
            few = ", ".join(missing[:4]) + (" ..." if len(missing) > 4 else "")
            self.report({"WARNING"}, f"{len(missing)} channels drive nothing on this rig: {few}")
        self.report({"INFO"}, f"{len(take.rows)} frames, {take.seconds[-1]:.2f} s, at {rate:g} frames per second")
        return {"FINISHED"}


class MIEN_OT_export_take(bpy.types.Operator, RigOperator, ExportHelper):
    """Write the raw controls of every frame, what the face board gives included, as CSV with a column "time": mien eval,
    mien clip and mien export take it"""

    bl_idname = "mien.export_take"
    bl_label = "Export Performance"

    filename_ext = ".csv"
    filter_glob: StringProperty(default="*.csv", options={"HIDDEN"})

    def execute(self, context):
        rig_object, scene = active_rig(context), context.scene
        try:
            rig_file = live.file_of(rig_object)
        except (OSError, ValueError) as error:
            return self.fail(error)
        rate = scene_rate(scene)
        names = rig_file.rig.names(live.mien.Kind.RAW_CONTROL)
        try:
            with open(self.filepath, "w", encoding="utf-8", newline="") as file:
                writer = csv.writer(file, lineterminator="\n")
                writer.writerow(["time", *names])
                for frame in sampled_frames(scene, scene.frame_start, scene.frame_end):
                    raw = live.raw_controls(rig_object, context.evaluated_depsgraph_get())
                    writer.writerow([f"{(frame - scene.frame_start) / rate:.9f}", *map(repr, map(float, raw))])
        except OSError as error:
            return self.fail(error)
        return {"FINISHED"}


class MienPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(name="Program mien", subtype="FILE_PATH",
                            description="Plays scenes. Empty: the one on the path")

    def draw(self, _context):
        self.layout.prop(self, "program")


_CLASSES = (MienPreferences, MIEN_OT_import_take, MIEN_OT_export_take)


def register():
    for made in _CLASSES:
        bpy.utils.register_class(made)


def unregister():
    for made in reversed(_CLASSES):
        bpy.utils.unregister_class(made)
