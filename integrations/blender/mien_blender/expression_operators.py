# SPDX-License-Identifier: MIT
"""Commands on expressions: bake them to shape keys, keep and apply poses."""
import json

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty, StringProperty

from . import expressions, live
from .build_meshes import name_of_part
from .operators import RigOperator, active_rig

_SET_ITEMS = [("arkit", "ARKit", "52 expressions of face capture"), ("visemes", "Visemes", "15 of Oculus lip sync"),
              ("visemes22", "Visemes 22", "22 of cloud voices"), ("unified", "Unified Expressions", "Of VR face tracking"),
              ("emotions", "Emotions", "7 prototypes"), ("vrm", "VRM", "17 presets of VRM 1.0")]


def mesh_things(rig_object, rig_file, lod):
    """(object, name of the mesh) of the meshes of a LOD."""
    found = []
    names = rig_file.rig.names(expressions.mien.Kind.MESH)
    for thing in live.meshes_of(rig_object):
        name = name_of_part(thing, names)
        if name is not None and lod in rig_file.deformer.mesh(name).lods:
            found.append((thing, name))
    return found


class MIEN_OT_bake_shapes(bpy.types.Operator, RigOperator):
    """Copy the meshes of the current LOD, with a shape key for each expression of standard sets, for programs without rigs"""

    bl_idname = "mien.bake_shapes"
    bl_label = "Bake to Shape Keys"
    bl_options = {"REGISTER", "UNDO"}

    sets: EnumProperty(name="Sets", items=_SET_ITEMS, options={"ENUM_FLAG"}, default={"arkit"})

    def invoke(self, context, _event):
        return context.window_manager.invoke_props_dialog(self)

    def execute(self, context):
        rig_object, manager = active_rig(context), context.window_manager
        names = [name for name, _, _ in _SET_ITEMS if name in self.sets]
        if not names:
            return self.fail("choose at least one set")
        collection = None
        manager.progress_begin(0, 100)
        try:
            rig_file = live.file_of(rig_object)
            things = mesh_things(rig_object, rig_file, rig_object.mien.lod)
            if not things:
                return self.fail(f"{rig_object.name} has no meshes of LOD {rig_object.mien.lod}")
            collection = bpy.data.collections.new(f"{rig_object.name} {' '.join(names)}")
            context.scene.collection.children.link(collection)
            copies, missing = expressions.bake_shapes(rig_object, rig_file, things, names, collection,
                                                      lambda share: manager.progress_update(int(100 * share)))
        except (OSError, ValueError) as error:
            if collection is not None:
                bpy.data.collections.remove(collection)
            return self.fail(error)
        finally:
            manager.progress_end()
        if missing:
            self.report({"WARNING"}, f"{len(missing)} expressions need controls that the rig lacks: {'; '.join(missing)}")
        self.report({"INFO"}, f"{len(copies)} meshes in {collection.name}")
        return {"FINISHED"}


def store_pose(rig_object, name, values):
    """Adds a pose to the library of a character, or replaces it. values: controls that are not initial, by name."""
    poses = rig_object.mien.poses
    pose = next((p for p in poses if p.name == name), None) or poses.add()
    pose.name, pose.values = name, json.dumps(values)
    return pose


class MIEN_OT_store_pose(bpy.types.Operator, RigOperator):
    """Keep the raw controls as they are now, what the face board gives included, in the library of the character"""

    bl_idname = "mien.store_pose"
    bl_label = "Store Pose"
    bl_options = {"REGISTER", "UNDO"}

    name: StringProperty(name="Name", default="Pose")

    def invoke(self, context, _event):
        return context.window_manager.invoke_props_dialog(self)

    def execute(self, context):
        rig_object = active_rig(context)
        try:
            rig_file = live.file_of(rig_object)
            raw = live.raw_controls(rig_object, context.evaluated_depsgraph_get())
        except (OSError, ValueError) as error:
            return self.fail(error)
        initial = rig_file.rig.initial_raw_controls
        store_pose(rig_object, self.name, {name: float(value) for name, value, start in
                                           zip(rig_file.controls, raw, initial) if value != start})
        return {"FINISHED"}


class MIEN_OT_store_set(bpy.types.Operator, RigOperator):
    """Fill the library of the character with a standard set of expressions"""

    bl_idname = "mien.store_set"
    bl_label = "Add Expressions"
    bl_options = {"REGISTER", "UNDO"}

    set: EnumProperty(name="Set", items=_SET_ITEMS)

    def execute(self, context):
        rig_object = active_rig(context)
        try:
            rig_file = live.file_of(rig_object)
        except (OSError, ValueError) as error:
            return self.fail(error)
        found, missing = expressions.on_rig(rig_file.rig, self.set)
        for name, plus, _minus in found:
            values = {}
            for control, value in plus:
                control = rig_file.controls[control]
                values[control] = min(1.0, values.get(control, 0.0) + value)
            store_pose(rig_object, name, values)
        if missing:
            self.report({"WARNING"}, f"{len(missing)} expressions need controls that the rig lacks: {'; '.join(missing)}")
        return {"FINISHED"}


class MIEN_OT_apply_pose(bpy.types.Operator, RigOperator):
    """Set the controls of a pose; with an amount below 1, part of the way from what they are now"""

    bl_idname = "mien.apply_pose"
    bl_label = "Apply Pose"
    bl_options = {"REGISTER", "UNDO"}

    index: IntProperty(options={"HIDDEN"})
    amount: FloatProperty(name="Amount", default=1, min=0, max=1, subtype="FACTOR")

    def execute(self, context):
        rig_object = active_rig(context)
        if not 0 <= self.index < len(rig_object.mien.poses):
            return self.fail(f"there is no pose {self.index}: the library has {len(rig_object.mien.poses)}")
        values = json.loads(rig_object.mien.poses[self.index].values)
        try:
            rig_file = live.file_of(rig_object)
        except (OSError, ValueError) as error:
            return self.fail(error)
        for name, start in zip(rig_file.controls, rig_file.rig.initial_raw_controls.tolist()):
            now = rig_object.get(name, start)
            rig_object[name] = now + self.amount * (values.get(name, start) - now)
        if context.scene.tool_settings.use_keyframe_insert_auto:
            for name in rig_file.controls:
                rig_object.keyframe_insert(live.control_path(name))
        rig_object.update_tag()
        return {"FINISHED"}


class MIEN_OT_remove_pose(bpy.types.Operator, RigOperator):
    """Remove a pose from the library of the character"""

    bl_idname = "mien.remove_pose"
    bl_label = "Remove Pose"
    bl_options = {"REGISTER", "UNDO"}

    index: IntProperty(options={"HIDDEN"})

    def execute(self, context):
        active_rig(context).mien.poses.remove(self.index)
        return {"FINISHED"}


_CLASSES = (MIEN_OT_bake_shapes, MIEN_OT_store_pose, MIEN_OT_store_set, MIEN_OT_apply_pose, MIEN_OT_remove_pose)


def register():
    for made in _CLASSES:
        bpy.utils.register_class(made)


def unregister():
    for made in reversed(_CLASSES):
        bpy.utils.unregister_class(made)
