# SPDX-License-Identifier: MIT
"""Commands on files: import, reload, re-point."""
import os

import bpy
from bpy.props import BoolProperty, CollectionProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from . import build_rig, live, rig_file


def active_rig(context):
    """The character of the active object."""
    return live.rig_of(context.object)


class RigOperator:
    """Of commands that need a character."""

    @classmethod
    def poll(cls, context):
        if active_rig(context) is None:
            cls.poll_message_set("Select a character that was imported from a .dna file")
            return False
        return True

    def fail(self, error):
        self.report({"ERROR"}, str(error))
        return {"CANCELLED"}


class MIEN_OT_import(bpy.types.Operator, ImportHelper):
    """Import the rig of a face or body from a .dna file, or from the .uasset of a character"""

    bl_idname = "mien.import_rig"
    bl_label = "Import Facial Rig"
    bl_options = {"REGISTER", "UNDO", "PRESET"}

    filename_ext = ".dna"
    filter_glob: StringProperty(default="*.dna;*.uasset", options={"HIDDEN"})
    files: CollectionProperty(type=bpy.types.OperatorFileListElement, options={"HIDDEN", "SKIP_SAVE"})
    directory: StringProperty(subtype="DIR_PATH", options={"HIDDEN", "SKIP_SAVE"})
    all_lods: BoolProperty(name="All LODs", default=True, description="Import every level of detail, each in a collection")
    shape_keys: BoolProperty(name="Shape Keys", default=True, description="Import blend shape targets")
    custom_normals: BoolProperty(name="Custom Normals", default=True,
                                 description="Use the normals of the file. Without them Blender draws faster")
    face_board: BoolProperty(name="Face Board", default=True, description="Build sliders for the GUI controls")

    def execute(self, context):
        directory = self.directory or os.path.dirname(self.filepath)
        paths = [os.path.join(directory, file.name) for file in self.files if file.name] or [self.filepath]
        manager = context.window_manager
        manager.progress_begin(0, 100)
        try:
            for path in paths:
                rig_file.forget(path)
                made = build_rig.import_rig(
                    context, path, lods=None if self.all_lods else [0], with_shapes=self.shape_keys,
                    with_normals=self.custom_normals, with_board=self.face_board,
                    progress=lambda share: manager.progress_update(int(100 * share)))
                self.report({"INFO"}, f"{made.name}: {len(made.data.bones)} bones, {len(live.meshes_of(made))} meshes")
        except (OSError, ValueError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        finally:
            manager.progress_end()
        return {"FINISHED"}


class MIEN_OT_reload(bpy.types.Operator, RigOperator):
    """Read the rig file again, after it changed on disk"""

    bl_idname = "mien.reload"
    bl_label = "Reload Rig File"

    def execute(self, context):
        rig_object = active_rig(context)
        rig_file.forget(live.path_of(rig_object))
        live.refresh(rig_object)
        try:
            live.file_of(rig_object)
        except (OSError, ValueError) as error:
            return self.fail(error)
        return {"FINISHED"}


class MIEN_OT_locate(bpy.types.Operator, RigOperator, ImportHelper):
    """Choose the rig file of this character, after it was moved or renamed"""

    bl_idname = "mien.locate"
    bl_label = "Locate Rig File"
    bl_options = {"REGISTER", "UNDO"}

    filename_ext = ".dna"
    filter_glob: StringProperty(default="*.dna;*.uasset", options={"HIDDEN"})

    def execute(self, context):
        rig_object = active_rig(context)
        rig_file.forget(self.filepath)
        try:
            found = rig_file.open_file(self.filepath)
        except (OSError, ValueError) as error:
            return self.fail(error)
        problem = live.difference(rig_object, found)
        if problem:
            return self.fail(f"{self.filepath}: is another rig: {problem}")
        rig_object.mien.path = self.filepath
        return {"FINISHED"}


class MIEN_OT_reset(bpy.types.Operator, RigOperator):
    """Set every control of the character and of its face board to its initial value"""

    bl_idname = "mien.reset"
    bl_label = "Reset Face"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        rig_object = active_rig(context)
        try:
            found = live.file_of(rig_object)
        except (OSError, ValueError) as error:
            return self.fail(error)
        for name, value in zip(found.controls, found.rig.initial_raw_controls.tolist()):
            rig_object[name] = value
        if rig_object.mien.board is not None:
            for bone in rig_object.mien.board.pose.bones:
                bone.location = (0, 0, 0)
            rig_object.mien.board.update_tag()
        rig_object.update_tag()
        return {"FINISHED"}


_CLASSES = [MIEN_OT_import, MIEN_OT_reload, MIEN_OT_locate, MIEN_OT_reset]

if hasattr(bpy.types, "FileHandler"):  # dropping files, since Blender 4.1
    class MIEN_FH_rig(bpy.types.FileHandler):
        bl_idname = "MIEN_FH_rig"
        bl_label = "Facial rig"
        bl_import_operator = "mien.import_rig"
        bl_file_extensions = ".dna;.uasset"

        @classmethod
        def poll_drop(cls, context):
            return context.area is not None and context.area.type in {"VIEW_3D", "OUTLINER"}

    _CLASSES.append(MIEN_FH_rig)


def _menu(self, _context):
    self.layout.operator(MIEN_OT_import.bl_idname, text="Facial rig (.dna, .uasset)")


def register():
    for made in _CLASSES:
        bpy.utils.register_class(made)
    bpy.types.TOPBAR_MT_file_import.append(_menu)


def unregister():
    bpy.types.TOPBAR_MT_file_import.remove(_menu)
    for made in reversed(_CLASSES):
        bpy.utils.unregister_class(made)
