# SPDX-License-Identifier: MIT
"""What the add-on keeps with objects."""
import bpy
from bpy.props import CollectionProperty, IntProperty, PointerProperty, StringProperty

from . import live, rig_file


def _path_changed(settings, _context):
    live.refresh(settings.id_data)


def _lod_changed(settings, _context):
    from .build_rig import show_lod
    show_lod(settings.id_data)
    settings.id_data.update_tag()


class MienPose(bpy.types.PropertyGroup):
    """A pose in the library of a character; `name` is every property group's own."""

    values: StringProperty(description="JSON: raw controls that are not initial, by name")


class MienObject(bpy.types.PropertyGroup):
    """Of an armature object: a character, or a face board."""

    path: StringProperty(name="Rig file", subtype="FILE_PATH", update=_path_changed, override={"LIBRARY_OVERRIDABLE"},
                         description="The .dna or .uasset file that is evaluated. // at the start: beside this .blend")
    lod: IntProperty(name="LOD", min=0, max=32, update=_lod_changed, override={"LIBRARY_OVERRIDABLE"},
                     description="Level of detail that is evaluated and shown; 0 is the finest")
    board: PointerProperty(name="Face board", type=bpy.types.Object, override={"LIBRARY_OVERRIDABLE"},
                           description="The armature whose bones are the sliders of this character")
    rig: PointerProperty(name="Character", type=bpy.types.Object, override={"LIBRARY_OVERRIDABLE"},
                         description="Of a face board: the character that it moves")
    poses: CollectionProperty(type=MienPose)
    live_action: PointerProperty(name="Live action", type=bpy.types.Action,
                                 description="What the controls play once the character is live again")


def register():
    bpy.utils.register_class(MienPose)
    bpy.utils.register_class(MienObject)
    bpy.types.Object.mien = PointerProperty(type=MienObject)
    bpy.types.WindowManager.mien_filter = StringProperty(
        name="Filter", description="Show controls whose names contain this", options={"TEXTEDIT_UPDATE"})


def unregister():
    del bpy.types.WindowManager.mien_filter
    del bpy.types.Object.mien
    bpy.utils.unregister_class(MienObject)
    bpy.utils.unregister_class(MienPose)
    rig_file.forget()
