# SPDX-License-Identifier: MIT
"""The live rig: what Blender evaluates when a control changes, on each frame, in renders and in bakes.

Three kinds of drivers do it, so that the dependency graph knows the order, with or without a window:

    controls, board ──> carrier ──> armature["mien_outputs"] ──> a bone without parent ──> all bones
                                                      └───────> one shape key of each mesh

The carrier evaluates the rig. It writes the transforms of all bones of the evaluated armature, and the weights of the
channels into the array "mien_outputs". The bones depend on it through the drivers of the bones without parents, which read
the array. The driver of a shape key writes the values of all keys of its mesh. integrations/blender/README.md has the
measurements that led here.
"""
import threading

import bpy
import numpy as np

from .binding import mien
from .rig_file import open_file

OUTPUTS = "mien_outputs"  # x of the bones without parents, weights of channels, weights of maps

_characters = {}  # names of objects and kinds of evaluation -> Character
_messages = {}  # name of an armature object -> why it is not evaluated


def neutral_matrices(rig_file):
    """float64 (joints, 4, 4): model matrices of the neutral joints."""
    values = rig_file.converted.neutral_joint_values.astype(np.float64)  # tx ty tz qx qy qz qw ...
    local = np.zeros((len(values), 4, 4))
    local[:, :3, :3] = rotations(values[:, 3:7])
    local[:, :3, 3] = values[:, :3]
    local[:, 3, 3] = 1
    model = local.copy()
    for joint in _parents_first(rig_file.rig.joint_parents):
        parent = int(rig_file.rig.joint_parents[joint])
        if parent != joint:
            model[joint] = model[parent] @ local[joint]
    return model


def _parents_first(parents):
    parents = np.asarray(parents).tolist()
    done, order = [False] * len(parents), []
    for joint in range(len(parents)):
        chain = []
        while not done[joint]:
            done[joint] = True
            chain.append(joint)
            joint = parents[joint]
        order += reversed(chain)
    return order


def rotations(quaternions):
    """(n, 3, 3) from x y z w."""
    x, y, z, w = (quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)).T
    return np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),
                     2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
                     2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)], axis=1).reshape(-1, 3, 3)


def path_of(rig_object):
    """The absolute path of the rig file, relative ones being relative to the file that has the object."""
    return bpy.path.abspath(rig_object.mien.path, library=rig_object.library)


def file_of(rig_object):
    """The RigFile of a character. Raises ValueError or OSError."""
    return open_file(path_of(rig_object))


class Bones:
    """How joint values become bone transforms on one armature. Bones may have been added or turned since the import."""

    def __init__(self, rig_object, rig_file):
        pose = rig_object.pose.bones
        self.count = len(pose)
        joint_of = {name: joint for joint, name in enumerate(rig_file.joints)}
        joints = np.array([joint_of.get(bone.name, -1) for bone in pose], np.int64)
        self.mine = np.flatnonzero(joints >= 0)
        self.joints = joints[self.mine]
        self.is_all = len(self.mine) == self.count
        rest = np.zeros((self.count, 16), np.float32)
        rest_of = rig_object.data.bones
        for i, bone in enumerate(pose):
            rest[i] = np.asarray(rest_of[bone.name].matrix_local, np.float32).T.ravel()
        rest = rest.reshape(-1, 4, 4).transpose(0, 2, 1)[self.mine][:, :3, :3].astype(np.float64)
        neutral = neutral_matrices(rig_file)[self.joints][:, :3, :3]
        # A joint's motion in the axes of its bone: rest^-1 * neutral * axes of the file.
        turn = rest.transpose(0, 2, 1) @ neutral
        own = rotations(rig_file.converted.neutral_joint_values[self.joints, 3:7].astype(np.float64))
        axes = rig_file.axes.T
        # The axis of a rotation changes its sign where the axes of the file are left-handed.
        self.turn = np.ascontiguousarray(turn @ axes * np.linalg.det(axes), np.float32)
        # Translations of the file are in the parent's axes.
        self.move = np.ascontiguousarray(turn @ own.transpose(0, 2, 1) @ axes * rig_file.unit, np.float32)
        self.order = np.abs(rig_file.axes).argmax(0)  # of scales: along which axis of the file each of Blender's lies
        self.location = np.zeros((self.count, 3), np.float32)
        self.rotation = np.zeros((self.count, 4), np.float32)
        self.scale = np.ones((self.count, 3), np.float32)
        parents = {bone.name: bone.parent for bone in pose}
        self.roots = [int(i) for i in self.mine if parents[pose[int(i)].name] is None]

    def compute(self, joints):
        """From joint values: location, rotation and scale of each bone."""
        values = joints[self.joints]
        mine = slice(None) if self.is_all else self.mine
        self.location[mine] = np.einsum("nij,nj->ni", self.move, values[:, :3])
        self.rotation[mine, 1:] = np.einsum("nij,nj->ni", self.turn, values[:, 3:6])
        self.rotation[mine, 0] = values[:, 6]
        self.scale[mine] = values[:, 7:10][:, self.order] + 1

    def write(self, pose_bones, joints):
        """The same into the bones of an object."""
        if not self.is_all:  # those of the user stay as they are
            pose_bones.foreach_get("location", self.location.ravel())
            pose_bones.foreach_get("rotation_quaternion", self.rotation.ravel())
            pose_bones.foreach_get("scale", self.scale.ravel())
        self.compute(joints)
        pose_bones.foreach_set("location", self.location.ravel())
        pose_bones.foreach_set("rotation_quaternion", self.rotation.ravel())
        pose_bones.foreach_set("scale", self.scale.ravel())


class Character:
    """The instance that evaluates one armature object, in one kind of dependency graph."""

    def __init__(self, rig_object, rig_file):
        self.file = rig_file
        self.face = rig_file.rig.instance()
        self.initial = np.array(rig_file.rig.initial_raw_controls)
        self.lock = threading.Lock()
        self.bones = Bones(rig_object, rig_file)
        self.board = None
        self.keys = {}  # names of meshes -> channels of their keys

    def set_controls(self, rig_object, board_object):
        """Raw controls: what the board gives, plus the properties."""
        get, initial = rig_object.get, self.initial
        values = np.array([get(name, 0.0) for name in self.file.controls], np.float32)
        raw = self.face.raw_controls
        if board_object is None:
            raw[:] = values
            return
        if self.board is None or self.board.count != len(board_object.pose.bones):
            from .face_board import BoardReader
            self.board = BoardReader(board_object, self.file)
        raw[:] = initial
        self.face.gui_controls[:] = self.board.read(board_object)
        self.face.map_gui_to_raw()
        raw += values
        raw -= initial


def character_of(rig_object, depsgraph_mode):
    """The Character of an evaluated armature object; its file is opened when it is first needed."""
    original = rig_object.original
    key = (original.name_full, depsgraph_mode)
    found = _characters.get(key)
    path = path_of(original)
    if found is None or found.file.path != path or found.bones.count != len(rig_object.pose.bones):
        if len(_characters) > 256:  # objects were renamed or removed
            _characters.clear()
        found = _characters[key] = Character(rig_object, open_file(path))
    return found


def forget_characters():
    """After anything that may have changed objects, names or rest poses."""
    _characters.clear()


def message_of(rig_object):
    """Why a character is not evaluated, or ""."""
    return _messages.get(rig_object.name_full, "")


def raw_controls(rig_object, depsgraph):
    """float32, a copy: what the properties and the board give in this graph."""
    evaluated = rig_object.evaluated_get(depsgraph)
    character = character_of(evaluated, depsgraph.mode)
    board = rig_object.mien.board
    with character.lock:
        character.set_controls(evaluated, board.evaluated_get(depsgraph) if board else None)
        return np.array(character.face.raw_controls)


# ---- what the drivers call ------------------------------------------------------------------------------------


def mien_pose(rig_object, depsgraph):
    """The carrier: evaluates, writes the bones and the array; returns the first value of that."""
    original = rig_object.original
    try:
        character = character_of(rig_object, depsgraph.mode)
    except (OSError, ValueError) as error:
        _messages[original.name_full] = str(error)
        return 0.0
    _messages.pop(original.name_full, None)
    board = original.mien.board
    with character.lock:
        face = character.face
        character.set_controls(rig_object, board.evaluated_get(depsgraph) if board else None)
        lods = character.file.rig.lod_count
        face.evaluate(lod=min(max(rig_object.mien.lod, 0), lods - 1))
        bones = character.bones
        bones.write(rig_object.pose.bones, face.joints)
        array = rig_object[OUTPUTS]
        outputs = np.frombuffer(array, np.float64 if array.typecode == "d" else np.float32)
        roots, channels, maps = len(bones.roots), len(face.blend_shapes), len(face.animated_maps)
        if len(outputs) == roots + channels + maps:
            outputs[:roots] = bones.location[bones.roots, 0]
            outputs[roots:roots + channels] = face.blend_shapes
            outputs[roots + channels:] = face.animated_maps
        return float(outputs[0]) if len(outputs) else 0.0


def mien_shapes(key, depsgraph):
    """The driver of one shape key: writes all keys of the mesh; returns the value of that one."""
    keys = key.id_data
    driver = next(d for d in keys.original.animation_data.drivers if d.driver.expression.startswith("mien_shapes"))
    rig_object = driver.driver.variables[0].targets[0].id
    if rig_object is None:
        return 0.0
    evaluated = rig_object.evaluated_get(depsgraph)
    try:
        character = character_of(evaluated, depsgraph.mode)
    except (OSError, ValueError):
        return 0.0
    blocks = keys.key_blocks
    found = character.keys.get(keys.original.name_full)
    if found is None or len(found[0]) != len(blocks):
        at = {name: i for i, name in enumerate(character.file.channels)}
        channels = np.array([at.get(block.name, -1) for block in blocks])
        mine = np.flatnonzero(channels >= 0)
        found = character.keys[keys.original.name_full] = (np.zeros(len(blocks), np.float32), mine, channels[mine])
    values, mine, channels = found
    array = evaluated[OUTPUTS]
    outputs = np.frombuffer(array, np.float64 if array.typecode == "d" else np.float32)
    if len(mine) != len(blocks):
        blocks.foreach_get("value", values)
    values[mine] = outputs[len(character.bones.roots) + channels]
    blocks.foreach_set("value", values)
    return float(key.value)


# ---- setting it up --------------------------------------------------------------------------------------------


def control_path(name):
    return f'["{bpy.utils.escape_identifier(name)}"]'


def add_controls(rig_object, rig_file):
    """A property for each raw control."""
    for name, initial in zip(rig_file.controls, rig_file.rig.initial_raw_controls.tolist()):
        rig_object[name] = float(initial)
        rig_object.id_properties_ui(name).update(default=float(initial), soft_min=0.0 if initial == 0 else -1.0,
                                                 soft_max=1.0, min=-10.0, max=10.0)
        rig_object.property_overridable_library_set(control_path(name), True)


def _variable(driver, name, thing, path):
    variable = driver.variables.new()
    variable.name, variable.type = name, "SINGLE_PROP"
    variable.targets[0].id, variable.targets[0].data_path = thing, path


def _python_driver(curve, expression):
    curve.driver.type = "SCRIPTED"
    curve.driver.use_self = True
    curve.driver.expression = expression


def connect(rig_object, rig_file, keys):
    """Adds the drivers, and removes those that an earlier call added."""
    disconnect(rig_object, keys)
    roots = [bone for bone in rig_object.pose.bones if bone.parent is None and bone.name in set(rig_file.joints)]
    rig_object[OUTPUTS] = [0.0] * max(1, len(roots) + len(rig_file.channels) + len(rig_file.maps))
    carrier = rig_object.driver_add(f'["{OUTPUTS}"]', 0)
    _python_driver(carrier, "mien_pose(self, depsgraph)")
    for i, name in enumerate(rig_file.controls):
        _variable(carrier.driver, f"c{i}", rig_object, control_path(name))
    board = rig_object.mien.board
    if board is not None:
        from .face_board import sliders
        for i, (bone, axis) in enumerate(sliders(board)):
            _variable(carrier.driver, f"b{i}", board,
                      f'pose.bones["{bpy.utils.escape_identifier(bone)}"].location[{axis}]')
    for i, bone in enumerate(roots):
        curve = bone.driver_add("location", 0)
        curve.driver.type = "SCRIPTED"
        curve.driver.expression = "x"
        _variable(curve.driver, "x", rig_object, f'["{OUTPUTS}"][{i}]')
    names = set(rig_file.channels)
    for key in keys:
        block = next((b for b in key.key_blocks if b.name in names), None)
        if block is not None:
            curve = block.driver_add("value")
            _variable(curve.driver, "x", rig_object, f'["{OUTPUTS}"][0]')
            _python_driver(curve, "mien_shapes(self, depsgraph)")
    forget_characters()


def difference(rig_object, rig_file):
    """Why a file cannot drive this character, or ""."""
    for name in rig_file.controls:
        if name not in rig_object.keys():
            return f"it has the control {name}, which this character lacks"
    for name in rig_file.joints:
        if name not in rig_object.data.bones:
            return f"it has the joint {name}, which this character lacks"
    if OUTPUTS in rig_object.keys():
        roots = sum(bone.parent is None and bone.name in set(rig_file.joints) for bone in rig_object.data.bones)
        channels = len(rig_object[OUTPUTS]) - roots - len(rig_file.maps)
        if channels != len(rig_file.channels) and len(rig_object[OUTPUTS]) > 1:
            return f"it has {len(rig_file.channels)} blend shape channels, this character has {channels}"
    return ""


def disconnect(rig_object, keys):
    """Removes the drivers that `connect` adds; what they last gave stays in bones and shape keys."""
    for owner in (rig_object, *keys):
        for curve in list(owner.animation_data.drivers) if owner.animation_data else ():
            expression = curve.driver.expression
            reads = any(OUTPUTS in t.data_path for v in curve.driver.variables for t in v.targets)
            if expression.startswith("mien_") or (expression == "x" and reads):
                owner.animation_data.drivers.remove(curve)
    forget_characters()


def meshes_of(rig_object):
    """The mesh objects of a character: its children that its armature deforms."""
    return [thing for thing in rig_object.children if thing.type == "MESH" and
            any(m.type == "ARMATURE" and m.object == rig_object for m in thing.modifiers)]


def keys_of(rig_object):
    """The shape keys of its meshes."""
    return list({thing.data.shape_keys.name_full: thing.data.shape_keys for thing in meshes_of(rig_object)
                 if thing.data.shape_keys}.values())


def rig_of(thing):
    """The armature object of the character that an object belongs to, or None."""
    while thing is not None:
        if thing.type == "ARMATURE" and thing.mien.path:
            return thing
        if thing.type == "ARMATURE" and thing.mien.rig is not None:  # a face board
            return thing.mien.rig
        thing = thing.parent
    return None


def refresh(rig_object):
    """Evaluates again, after the file or the path changed."""
    forget_characters()
    rig_object.update_tag()


def register():
    names = bpy.app.driver_namespace
    names["mien_pose"], names["mien_shapes"] = mien_pose, mien_shapes
    forget_characters()
    _messages.clear()


def unregister():
    for name in ("mien_pose", "mien_shapes"):
        bpy.app.driver_namespace.pop(name, None)
    forget_characters()
