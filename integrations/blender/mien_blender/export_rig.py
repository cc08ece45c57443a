# SPDX-License-Identifier: MIT
"""Writes what was edited in Blender into a copy of the rig file: neutral vertices and normals, weights, shape keys, places of
joints. All else of the file stays byte for byte what it was."""
import ctypes
import os
from dataclasses import dataclass

import bpy
import numpy as np
from bpy.props import StringProperty
from bpy_extras.io_utils import ExportHelper

from . import live, rig_file
from .binding import mien
from .build_meshes import name_of_part
from .operators import RigOperator, active_rig

LEAST_MOVE = 2e-7  # meters; a vertex that moved less is not edited
LEAST_WEIGHT = 1e-6
LEAST_TURN = 4e-3  # of a normal; Blender stores custom normals in 16 bits


class Document:
    """A DNA file that is changed field by field: mien_document_* of libmien-author."""

    def __init__(self, dna):
        library, api = mien._library, mien._api
        self._api, self._lib = api, library.author()
        self._handle, error = api.MienDocument(), api.MienError()
        self._check(self._lib.mien_document_create(dna._open(), None, ctypes.byref(self._handle), ctypes.byref(error)), error)

    def _check(self, status, error):
        if status:
            mien.errors.fail(status, "cannot change the rig file", error)

    def close(self):
        self._lib.mien_document_destroy(self._handle)
        self._handle = None

    def write(self, path, values):
        """Replaces an array, which may change its length."""
        is_float = np.asarray(values).dtype.kind == "f"
        array = np.ascontiguousarray(values, np.float32 if is_float else np.int64)
        error, encoded = self._api.MienError(), path.encode()
        self._check(self._lib.mien_document_resize(self._handle, encoded, len(array), ctypes.byref(error)), error)
        self._write(encoded, array, is_float)

    def write_number(self, path, value):
        self._write(path.encode(), np.array([value], np.int64), False)

    def _write(self, encoded, array, is_float):
        call = self._lib.mien_document_write_floats if is_float else self._lib.mien_document_write_integers
        error = self._api.MienError()
        self._check(call(self._handle, encoded, 0, len(array), array.ctypes.data, ctypes.byref(error)), error)

    def dna(self):
        """The result, checked and opened."""
        from_handle, error = mien._memory.DnaHandle(), self._api.MienError()
        self._check(self._lib.mien_document_to_dna(self._handle, None, ctypes.byref(from_handle), ctypes.byref(error)), error)
        return mien.Dna(from_handle)


@dataclass
class Edits:
    """How much was written."""

    positions: int = 0
    normals: int = 0
    weights: int = 0
    shapes: int = 0
    joints: int = 0

    def __str__(self):
        return (f"{self.positions} positions, {self.normals} normals, {self.weights} positions with other weights, "
                f"{self.shapes} shapes, {self.joints} joints")

    @property
    def none(self):
        return not (self.positions or self.normals or self.weights or self.shapes or self.joints)


class Axes:
    """From Blender's axes and meters to those of the file."""

    def __init__(self, file):
        self.file = file

    def to_file(self, points, scale=None):
        """x, y and z of the file."""
        return list((points @ self.file.axes.T * (1 / self.file.unit if scale is None else scale)).T)

    def write(self, document, path, points, changed, dna, scale=None):
        """The changed rows of x, y and z; the others keep their bits."""
        for name, values in zip(("xs", "ys", "zs"), self.to_file(points.astype(np.float64), scale)):
            stored = np.array(dna.read(f"{path}.{name}"), np.float32)
            stored[changed] = values[changed]
            document.write(f"{path}.{name}", stored)


def _points(data, count):
    values = np.zeros(3 * count, np.float32)
    data.foreach_get("co", values)
    return values.reshape(-1, 3)


class _MeshExport:
    """One mesh, from Blender into a document."""

    def __init__(self, source, file, document, axes, thing, index, edits):
        self.source, self.file, self.document, self.axes = source, file, document, axes
        self.thing, self.mesh, self.index, self.edits = thing, thing.data, index, edits
        self.part = file.deformer.mesh(index)
        self.path = f"geom.meshes[{index}]"
        if len(self.mesh.vertices) != self.part.position_count:
            raise ValueError(f"{thing.name} has {len(self.mesh.vertices)} vertices, {self.part.name} of the file has "
                             f"{self.part.position_count}: vertices must not be added, removed or reordered")
        if np.abs(np.array(thing.matrix_local) - np.eye(4)).max() > 1e-6:
            raise ValueError(f"{thing.name} was moved against its armature: apply its location, rotation and scale first")
        keys = self.mesh.shape_keys
        self.blocks = keys.key_blocks if keys else []
        count = self.part.position_count
        self.neutral = _points(self.blocks[0].data if self.blocks else self.mesh.vertices, count)

    def write_neutral(self):
        moved = np.abs(self.neutral - self.part.positions).max(1, initial=0) > LEAST_MOVE
        if not moved.any():
            return
        self.edits.positions += int(moved.sum())
        self.axes.write(self.document, f"{self.path}.positions", self.neutral, moved, self.source)
        self._write_normals()

    def _write_normals(self):
        mesh = self.mesh
        sizes, vertices = rig_file.read_faces(self.file, self.index)
        if not len(sizes):
            return
        # Of the neutral shape, whatever shape keys are on.
        neutral = mesh.copy()
        try:
            if neutral.shape_keys:
                owner = bpy.data.objects.new("neutral", neutral)
                owner.shape_key_clear()
                bpy.data.objects.remove(owner)
            neutral.vertices.foreach_set("co", self.neutral.ravel())
            neutral.update()
            if hasattr(neutral, "calc_normals_split"):  # before Blender 4.1
                neutral.calc_normals_split()
            normals = np.zeros(3 * len(neutral.loops), np.float32)
            if hasattr(neutral, "corner_normals"):
                neutral.corner_normals.foreach_get("vector", normals)
            else:
                neutral.loops.foreach_get("normal", normals)
        finally:
            bpy.data.meshes.remove(neutral)
        of_vertex = np.zeros((self.part.vertex_count, 3), np.float32)
        of_vertex[vertices] = normals.reshape(-1, 3)
        used = np.zeros(self.part.vertex_count, bool)
        used[vertices] = True
        turned = used & (np.abs(of_vertex - self.part.normals).max(1) > LEAST_TURN)
        indices = np.asarray(self.source.read(f"{self.path}.layouts.normals"))
        count = self.source.field(f"{self.path}.normals.xs").count
        by_normal, changed = np.zeros((count, 3), np.float32), np.zeros(count, bool)
        by_normal[indices[turned]] = of_vertex[turned]
        changed[indices[turned]] = True
        self.edits.normals += int(changed.sum())
        self.axes.write(self.document, f"{self.path}.normals", by_normal, changed, self.source, scale=1.0)

    def write_weights(self):
        joint_of = {name: joint for joint, name in enumerate(self.file.joints)}
        groups = [joint_of.get(group.name) for group in self.thing.vertex_groups]
        positions, joints, weights = rig_file.read_weights(self.file, self.index)
        before = [{} for _ in range(self.part.position_count)]
        for position, joint, weight in zip(positions.tolist(), joints.tolist(), weights.tolist()):
            before[position][joint] = weight
        most = self.part.max_influences
        for position, vertex in enumerate(self.mesh.vertices):
            now = {groups[g.group]: g.weight for g in vertex.groups if g.weight > 0 and groups[g.group] is not None}
            old = before[position]
            if now.keys() == old.keys() and all(abs(now[j] - old[j]) < LEAST_WEIGHT for j in now):
                continue
            if not now:
                raise ValueError(f"{self.thing.name}: vertex {position} has no weight for any joint of the rig")
            total = sum(now.values())
            path = f"{self.path}.skinWeights[{position}]"
            self.document.write(f"{path}.weights", np.array([w / total for w in now.values()], np.float32))
            self.document.write(f"{path}.jointIndices", np.array(list(now), np.int64))
            self.edits.weights += 1
            most = max(most, len(now))
        if most > self.part.max_influences:
            self.document.write_number(f"{self.path}.maximumInfluencePerVertex", most)

    def write_shapes(self):
        wanted = {self.file.channels[channel]: target for target, channel in enumerate(self.part.target_channels)}
        blocks = {block.name: block for block in self.blocks[1:]} if len(self.blocks) else {}
        if not blocks:
            return  # imported without shape keys
        extra = [name for name in blocks if name not in wanted]
        if extra:
            raise ValueError(f"{self.thing.name}: the shape key {extra[0]} is no blend shape target of the file. Targets "
                             "cannot be added here: remove it, or add it as a corrective in the tool that made the rig")
        by_channel = {int(self.source.read(f"{self.path}.blendShapeTargets[{i}].blendShapeChannelIndex")): i
                      for i in range(self.source.field(f"{self.path}.blendShapeTargets").count)}
        for name, target in wanted.items():
            if name not in blocks:
                raise ValueError(f"{self.thing.name}: the shape key {name} is missing: it may be empty, but has to exist")
            block = blocks[name]
            delta = _points(block.data, len(self.neutral)) - _points(block.relative_key.data, len(self.neutral))
            changed = np.abs(delta - self.file.deformer.target(self.index, target)).max(1) > LEAST_MOVE
            if not changed.any():
                continue
            moving = np.flatnonzero(np.abs(delta).max(1) > LEAST_MOVE)
            channel = int(self.part.target_channels[target])
            path = f"{self.path}.blendShapeTargets[{by_channel[channel]}]"
            self.document.write(f"{path}.vertexIndices", moving.astype(np.int64))
            for axis, values in zip(("xs", "ys", "zs"), self.axes.to_file(delta[moving].astype(np.float64))):
                self.document.write(f"{path}.deltas.{axis}", values.astype(np.float32))
            self.edits.shapes += 1


def _write_joints(rig_object, file, source, document, axes, edits):
    """Places of joints whose bones were moved in edit mode."""
    neutral = live.neutral_matrices(file)
    bones = rig_object.data.bones
    places = neutral[:, :3, 3].copy()
    for joint, name in enumerate(file.joints):
        if name not in bones:
            raise ValueError(f"the bone {name} is missing: bones of the rig must not be removed or renamed")
        head = np.array(bones[name].head_local, np.float64)
        if np.abs(head - places[joint]).max() > 10 * LEAST_MOVE:
            places[joint] = head
            edits.joints += 1
        turned = np.abs(np.array(bones[name].matrix_local.to_3x3()) - neutral[joint, :3, :3]).max()
        if turned > 0.01:
            raise ValueError(f"the bone {name} was turned: moved bones are exported, turned ones are not")
    if not edits.joints:
        return
    parents = np.asarray(file.rig.joint_parents, np.int64)
    is_root = parents == np.arange(len(parents))
    offsets = places - places[parents]
    before = neutral[:, :3, 3] - neutral[parents][:, :3, 3]
    changed = np.abs(offsets - before).max(1) > LEAST_MOVE
    changed |= is_root & (np.abs(places - neutral[:, :3, 3]).max(1) > LEAST_MOVE)
    local = np.einsum("nji,nj->ni", neutral[parents][:, :3, :3], offsets)
    local[is_root] = places[is_root]
    axes.write(document, "defn.neutralJointTranslations", local, changed, source)


def export(rig_object):
    """The edited file as bytes, and what was edited. Raises ValueError if something was edited that cannot be written."""
    file, edits = live.file_of(rig_object), Edits()
    with mien.Dna.from_bytes(file.data) as source:
        axes, document = Axes(file), Document(source)
        try:
            names = file.rig.names(mien.Kind.MESH)
            for thing in live.meshes_of(rig_object):
                name = name_of_part(thing, names)
                if name is None:
                    continue  # the user's own, such as glasses
                part = _MeshExport(source, file, document, axes, thing, names.index(name), edits)
                part.write_neutral()
                part.write_weights()
                part.write_shapes()
            _write_joints(rig_object, file, source, document, axes, edits)
            with document.dna() as made:
                return made.to_bytes(), edits
        finally:
            document.close()


def check(rig_object, data):
    """Raises ValueError if a file does not hold the meshes as they are in Blender."""
    file = rig_file.from_bytes(data)
    names = file.rig.names(mien.Kind.MESH)
    for thing in live.meshes_of(rig_object):
        name = name_of_part(thing, names)
        if name is None:
            continue
        part = file.deformer.mesh(names.index(name))
        blocks = thing.data.shape_keys.key_blocks if thing.data.shape_keys else []
        neutral = _points(blocks[0].data if len(blocks) else thing.data.vertices, part.position_count)
        if np.abs(neutral - part.positions).max(initial=0) > 1e-5:
            raise ValueError(f"{thing.name}: its vertices were not written as they are")
        for target, channel in enumerate(part.target_channels if len(blocks) else ()):
            block = blocks[file.channels[channel]]
            delta = _points(block.data, len(neutral)) - _points(block.relative_key.data, len(neutral))
            if np.abs(delta - file.deformer.target(part.index, target)).max() > 1e-5:
                raise ValueError(f"{thing.name}: the shape key {block.name} was not written as it is")


class MIEN_OT_export_rig(bpy.types.Operator, RigOperator, ExportHelper):
    """Write a copy of the rig file with the edited neutral, weights, shape keys and places of joints. All else stays as it
    was"""

    bl_idname = "mien.export_rig"
    bl_label = "Export Edited Rig"

    filename_ext = ".dna"
    filter_glob: StringProperty(default="*.dna", options={"HIDDEN"})

    def execute(self, context):
        rig_object = active_rig(context)
        if rig_object.mode == "EDIT" or any(thing.mode == "EDIT" for thing in live.meshes_of(rig_object)):
            return self.fail("leave edit mode first: what is edited there is not in the mesh yet")
        path = bpy.path.abspath(self.filepath)
        try:
            data, edits = export(rig_object)
            check(rig_object, data)
            temporary = path + ".part"
            with open(temporary, "wb") as made:
                made.write(data)
            os.replace(temporary, path)
        except (OSError, ValueError) as error:
            return self.fail(error)
        rig_file.forget(path)
        if edits.none:
            self.report({"WARNING"}, f"{path}: nothing was edited, this is a copy")
        else:
            self.report({"INFO"}, f"{path}: {edits}")
        return {"FINISHED"}


def register():
    bpy.utils.register_class(MIEN_OT_export_rig)


def unregister():
    bpy.utils.unregister_class(MIEN_OT_export_rig)
