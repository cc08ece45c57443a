# SPDX-License-Identifier: MIT
"""The tab "Mien" of the sidebar."""
import bpy

from . import live
from .bake_keys import is_live
from .operators import active_rig


class MienPanel:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Mien"


class MIEN_PT_rig(MienPanel, bpy.types.Panel):
    bl_label = "Facial Rig"

    def draw(self, context):
        layout, rig_object = self.layout, active_rig(context)
        if rig_object is None:
            layout.operator("mien.import_rig", icon="IMPORT")
            return
        problem = live.message_of(rig_object)
        if problem:
            box = layout.box()
            box.alert = True
            for i in range(0, len(problem), 42):
                box.label(text=problem[i:i + 42], icon="ERROR" if i == 0 else "BLANK1")
            box.operator("mien.locate", icon="FILE_FOLDER")
        layout.prop(rig_object.mien, "path")
        row = layout.row(align=True)
        row.operator("mien.reload", text="Reload", icon="FILE_REFRESH")
        row.operator("mien.locate", text="Locate", icon="FILE_FOLDER")
        layout.prop(rig_object.mien, "lod")
        layout.operator("mien.reset", icon="LOOP_BACK")
        if is_live(rig_object):
            layout.operator("mien.bake_keys", icon="KEYFRAME_HLT")
        else:
            layout.operator("mien.make_live", icon="PLAY")
        layout.operator("mien.export_rig", icon="EXPORT")


class MIEN_PT_controls(MienPanel, bpy.types.Panel):
    bl_label = "Controls"
    bl_order = 10  # last, as it is long

    @classmethod
    def poll(cls, context):
        return active_rig(context) is not None

    def draw(self, context):
        layout, rig_object = self.layout, active_rig(context)
        wanted = context.window_manager.mien_filter.lower()
        layout.prop(context.window_manager, "mien_filter", text="", icon="VIEWZOOM")
        try:
            names = live.file_of(rig_object).controls
        except (OSError, ValueError):
            names = [name for name, value in rig_object.items() if isinstance(value, float)]
        column = layout.column(align=True)
        for name in names:
            if wanted in name.lower() and name in rig_object.keys():
                column.prop(rig_object, live.control_path(name), text=name.rpartition(".")[2])


class MIEN_PT_performance(MienPanel, bpy.types.Panel):
    bl_label = "Performance"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return active_rig(context) is not None

    def draw(self, context):
        column = self.layout.column(align=True)
        column.operator("mien.import_take", icon="IMPORT")
        column.operator("mien.export_take", icon="EXPORT")
        column.separator()
        column.operator("mien.bake_shapes", icon="SHAPEKEY_DATA")


class MIEN_PT_poses(MienPanel, bpy.types.Panel):
    bl_label = "Pose Library"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return active_rig(context) is not None

    def draw(self, context):
        layout = self.layout
        row = layout.row(align=True)
        row.operator("mien.store_pose", icon="ADD")
        row.operator_menu_enum("mien.store_set", "set")
        column = layout.column(align=True)
        for index, pose in enumerate(active_rig(context).mien.poses):
            row = column.row(align=True)
            row.operator("mien.apply_pose", text=pose.name).index = index
            row.operator("mien.remove_pose", text="", icon="X").index = index


class MIEN_PT_auto_rig(MienPanel, bpy.types.Panel):
    bl_label = "Auto-Rig"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, _context):
        self.layout.label(text="From a mesh with shape keys")
        self.layout.operator("mien.auto_rig", icon="ARMATURE_DATA")


_CLASSES = (MIEN_PT_rig, MIEN_PT_controls, MIEN_PT_performance, MIEN_PT_poses, MIEN_PT_auto_rig)


def register():
    for made in _CLASSES:
        bpy.utils.register_class(made)


def unregister():
    for made in reversed(_CLASSES):
        bpy.utils.unregister_class(made)
