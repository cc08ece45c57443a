# SPDX-License-Identifier: MIT
"""Rigs from meshes."""
from __future__ import annotations

import ctypes
import json
from concurrent.futures import Executor
from operator import index
from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple

from . import _api
from ._api import AuthorFlags, BoneKind, MeshAxis, MienError, Symmetry
from ._library import author
from ._memory import DnaHandle, numpy, uint32
from ._threads import call_with_threads
from .dna import Dna
from .errors import ArgumentError, fail, raises

_byref = ctypes.byref
_progress_type: Any = dict(_api.MienAuthorDesc._fields_)["progress"]


class AuthorBone(NamedTuple):
    """A bone placed by the caller.

    position: in the mesh, not relative to the parent
    parent:   index of a bone before this one; the first one is its own parent
    kind:     the first is the root, and facial ones stand in one run
    """

    name: str
    position: Sequence[float]
    parent: int = 0
    kind: int = BoneKind.FACIAL


class AuthoredRig(NamedTuple):
    """A rig that was made: the file, and what was found and measured (docs/authoring.md, 6)."""

    dna: Dna
    report: Dict[str, Any]


class _Given:
    """Arrays and names as the library takes them. They have to live as long as the call."""

    def __init__(self) -> None:
        self.kept: List[Any] = []

    def numbers(self, values: Any, what: str, type_: str, shape: Tuple[Optional[int], ...]) -> Any:
        """An array of that type and shape, where None stands for any length. Whole numbers are
        never made of others, nor of those that do not fit."""
        found = numpy.asarray(values)
        if found.dtype.kind not in ("uif" if type_.startswith("float") else "ui") and found.size:
            raise ArgumentError(f"{what} holds {found.dtype}: these have to be "
                                f"{'numbers' if type_.startswith('float') else 'whole numbers'}")
        if not found.size and len(shape) != found.ndim:
            found = found.reshape([0 if n is None else n for n in shape])
        if found.ndim != len(shape) or any(n not in (None, m) for n, m in zip(shape, found.shape)):
            wanted = ", ".join("any" if n is None else str(n) for n in shape)
            raise ArgumentError(f"{what} has the shape {found.shape}: ({wanted}) is needed")
        if not type_.startswith("float") and found.size:
            limits = numpy.iinfo(type_)
            if found.min() < limits.min or found.max() > limits.max:
                raise ArgumentError(f"{what} holds {found.min()} to {found.max()}: "
                                    f"{limits.min} to {limits.max} is possible")
        array = numpy.ascontiguousarray(found, type_)
        self.kept.append(array)
        return array

    def text(self, text: str) -> Any:
        encoded = text.encode("utf-8", "surrogateescape")
        self.kept.append(encoded)
        address = ctypes.cast(ctypes.c_char_p(encoded), ctypes.c_void_p)
        return _api.MienStringView(address, len(encoded))

    def faces(self, faces: Any, mesh: Any) -> None:
        if hasattr(faces, "dtype"):
            corners = self.numbers(faces, "faces", "uint32", (None, None))
            sizes = numpy.full(len(corners), corners.shape[1], "uint32")
        else:
            lists = [list(face) for face in faces]
            sizes = numpy.array([len(face) for face in lists], "uint32")
            corners = self.numbers([v for face in lists for v in face], "faces", "uint32", (None,))
        self.kept.append(sizes)
        mesh.face_sizes = sizes.ctypes.data
        mesh.face_count = len(sizes)
        mesh.corners = corners.ctypes.data
        mesh.corner_count = corners.size

    def shapes(self, shapes: Mapping[str, Any], count: int, mesh: Any) -> None:
        structs = (_api.MienAuthorShape * len(shapes))()
        self.kept.append(structs)
        mesh.shapes = structs
        mesh.shape_count = len(shapes)
        for i, (name, shape) in enumerate(shapes.items()):
            to = structs[i]
            to.name = self.text(name)
            if isinstance(shape, tuple):
                moving = self.numbers(shape[0], f"shape {name!r}", "uint32", (None,))
                to.positions, to.position_count = moving.ctypes.data, len(moving)
                moved = self.numbers(shape[1], f"shape {name!r}", "float64", (len(moving), 3))
            else:
                moved = self.numbers(shape, f"shape {name!r}", "float64", (count, 3))
                to.position_count = count
            to.displacements = moved.ctypes.data

    def objects(self, objects: Sequence[Tuple[str, int]], mesh: Any) -> None:
        structs = (_api.MienAuthorObject * len(objects))()
        self.kept.append(structs)
        mesh.objects = structs
        mesh.object_count = len(objects)
        first = 0
        for i, (name, faces) in enumerate(objects):
            structs[i].name = self.text(name)
            structs[i].first_face = uint32(first, "first face")
            structs[i].face_count = uint32(faces, "number of faces")
            first += index(faces)

    def bones(self, bones: Sequence[AuthorBone], desc: Any) -> None:
        structs = (_api.MienAuthorBone * len(bones))()
        self.kept.append(structs)
        desc.bones = structs
        desc.bone_count = len(bones)
        for i, bone in enumerate(bones):
            to = structs[i]
            to.name = self.text(bone.name)
            position = self.numbers(bone.position, f"bone {bone.name!r}", "float64", (3,))
            to.position[:] = position.tolist()
            to.parent, to.kind = uint32(bone.parent, "parent"), uint32(bone.kind, "kind")

    def landmarks(self, landmarks: Mapping[str, Any], desc: Any) -> None:
        structs = (_api.MienAuthorLandmark * len(landmarks))()
        self.kept.append(structs)
        desc.landmarks = structs
        desc.landmark_count = len(landmarks)
        for to, (name, position) in zip(structs, landmarks.items()):
            to.name = self.text(name)
            at = self.numbers(position, f"landmark {name!r}", "float64", (3,))
            to.position[:] = at.tolist()

    def weights(self, weights: Tuple[Any, Any], count: int, desc: Any) -> None:
        joints, shares = weights
        joints = self.numbers(joints, "weights[0]", "uint16", (count, None))
        shares = self.numbers(shares, "weights[1]", "float32", joints.shape)
        if desc.influences not in (0, joints.shape[1]):
            raise ArgumentError(f"weights have {joints.shape[1]} influences, not {desc.influences}")
        desc.influences = joints.shape[1]
        desc.weight_joints = joints.ctypes.data
        desc.weights = shares.ctypes.data


    def lods(self, meshes: Sequence[Any], desc: Any) -> None:
        structs = (_api.MienAuthorLod * len(meshes))()
        self.kept.append(structs)
        if desc.lods not in (0, len(meshes) + 1):
            raise ArgumentError(f"lod_meshes has {len(meshes)} LODs beside the first, "
                                f"not {desc.lods - 1}")
        desc.lods = len(meshes) + 1
        desc.lod_meshes = structs
        desc.lod_mesh_count = len(meshes)
        for i, mesh in enumerate(meshes):
            faces, uvs = mesh if isinstance(mesh, tuple) else (mesh, None)
            corners = self.numbers(faces, f"lod_meshes[{i}]", "uint32", (None, 3))
            structs[i].corners, structs[i].corner_count = corners.ctypes.data, corners.size
            if uvs is not None:
                of_corners = self.numbers(uvs, f"UVs of lod_meshes[{i}]", "uint32", corners.shape)
                structs[i].corner_uvs = of_corners.ctypes.data

    def results(self, count: int, names: Sequence[str], desc: Any, *, depth_groups: Any, mask: Any,
                lod_joints: Any, bone_groups: Any, bone_motions: Any) -> None:
        """Results of the caller in place of stages."""
        if depth_groups is not None:
            groups = self.numbers(depth_groups, "depth_groups", "uint8", (count,))
            desc.depth_groups = groups.ctypes.data
        if mask is not None:
            marks = numpy.asarray(mask)
            if marks.dtype == bool:
                marks = marks.astype("uint8")
            desc.mask = self.numbers(marks, "mask", "uint8", (count,)).ctypes.data
        if lod_joints is not None:
            joints = self.numbers(lod_joints, "lod_joints", "uint32", (None,))
            if desc.lods not in (0, len(joints)) or not len(joints):
                raise ArgumentError(f"lod_joints has {len(joints)} LODs, not {desc.lods or 8}")
            desc.lods = len(joints)
            desc.lod_joints = joints.ctypes.data
        bones = desc.bone_count
        if bone_groups is not None:
            groups = self.numbers(bone_groups, "bone_groups", "uint32", (bones,))
            desc.bone_groups = groups.ctypes.data
        if bone_motions is not None:
            unknown = sorted(set(bone_motions) - set(names))
            if unknown:
                raise ArgumentError(f"bone_motions has {unknown[0]!r}, which is no shape")
            motions = numpy.zeros((len(names), bones, 6))
            for i, name in enumerate(names):
                if name in bone_motions:
                    motions[i] = self.numbers(bone_motions[name], f"bone_motions[{name!r}]",
                                              "float64", (bones, 6))
            self.kept.append(motions)
            desc.bone_motions = motions.ctypes.data


@raises("mien_author_rig")
def author_rig(positions: Any, faces: Any, shapes: Optional[Mapping[str, Any]] = None, *,
               objects: Optional[Sequence[Tuple[str, int]]] = None, uvs: Any = None,
               corner_uvs: Any = None, facial_joints: int = 0, influences: int = 0, lods: int = 0,
               groups: int = 0, seed: int = 1, unit: float = 1.0, up: int = MeshAxis.DEFAULT,
               front: int = MeshAxis.DEFAULT, symmetry: int = Symmetry.AUTO, flags: int = 0,
               name: str = "", face_object: str = "",
               bones: Optional[Sequence[AuthorBone]] = None,
               weights: Optional[Tuple[Any, Any]] = None, depth_groups: Any = None,
               mask: Any = None, lod_joints: Optional[Sequence[int]] = None,
               bone_groups: Optional[Sequence[int]] = None,
               bone_motions: Optional[Mapping[str, Any]] = None, joint_groups: int = 0,
               overlap_correctives: int = 0, lod_triangles: float = 0.5,
               lod_meshes: Optional[Sequence[Any]] = None,
               landmarks: Optional[Mapping[str, Any]] = None,
               progress: Optional[Callable[[str, float], Any]] = None,
               executor: Optional[Executor] = None) -> AuthoredRig:
    """Makes a rig from the mesh of a head: joints, skin weights of every LOD, and for each shape a raw
    control that moves them. Needs NumPy. See docs/authoring.md.

    positions:     (n, 3), in the unit and axes that `unit`, `up` and `front` tell
    faces:         positions of the corners, counterclockwise from outside: an array (m, 3) or (m, 4),
                   or lists of any lengths
    shapes:        displacements at full value by names: (n, 3), or a pair of (k,) positions that move
                   and (k, 3). Positions that have moved minus `positions`, that is
    objects:       names and numbers of faces, in their order; None: all is one
    uvs:           (u, 2), with an index for each corner in `corner_uvs`
    facial_joints: 0: 240; influences: 0: 8; lods: 0: 8; groups: in depth, 0: 3
    unit:          centimeters of one unit of the mesh
    flags:         `AuthorFlags`, combined with |
    bones:         of the caller; None: they are placed
    weights:       of the caller, with bones: a pair of (n, k) numbers of bones and (n, k) weights
    depth_groups:  of the caller: (n,) group in depth of each position, 0 in front
    mask:          of the caller: (n,) whether facial bones are placed there
    lod_joints:    facial joints of each LOD at most, as pairs stay together; the first one has all
    bone_groups:   of the caller, with bones: the joint group of each, 0 to 255
    bone_motions:  of the caller, with bones: for names of shapes (b, 6) what each bone does at full
                   value: translation, then degrees about X, Y and Z. Of other shapes: nothing
    joint_groups:  how many are found, 1 to 24; 0: as many as have 75 rows each
    overlap_correctives: for pairs of shapes that double their motion, at most as many
    lod_triangles: share of its triangles that each further LOD keeps of the LOD before; 1: all
    lod_meshes:    of the caller, instead: (k, 3) positions of the corners of LOD 1, of LOD 2 and so on,
                   each triangle of one object; or a pair of that and (k, 3) indices of UVs
    landmarks:     points of the face by name, used instead of those that are found:
                   {"nose": (0, 1.2, 9)}; docs/authoring.md, "Landmarks", has the names
    progress:      called with the name of a step and a share from 0 to 1; what it returns, if true,
                   cancels. What it raises comes out of the call
    executor:      threads to work on; the result does not depend on them
    """
    if numpy is None:
        raise ImportError("mien.author_rig() needs NumPy: pip install numpy")
    given = _Given()
    mesh = _api.MienAuthorMesh()
    places = given.numbers(positions, "positions", "float64", (None, 3))
    mesh.positions = places.ctypes.data
    mesh.position_count = len(places)
    given.faces(faces, mesh)
    given.shapes(shapes or {}, len(places), mesh)
    if objects is not None:
        given.objects(objects, mesh)
    if uvs is not None or corner_uvs is not None:
        if uvs is None or corner_uvs is None:
            raise ArgumentError("uvs and corner_uvs go together")
        coordinates = given.numbers(uvs, "uvs", "float64", (None, 2))
        corners = given.numbers(corner_uvs, "corner_uvs", "uint32", (mesh.corner_count,))
        mesh.uvs = coordinates.ctypes.data
        mesh.uv_count = len(coordinates)
        mesh.corner_uvs = corners.ctypes.data
    desc = _api.MienAuthorDesc(
        facial_joints=uint32(facial_joints, "facial_joints"),
        influences=uint32(influences, "influences"),
        lods=uint32(lods, "lods"), groups=uint32(groups, "groups"), seed=index(seed),
        joint_groups=uint32(joint_groups, "joint_groups"),
        overlap_correctives=uint32(overlap_correctives, "overlap_correctives"),
        up=uint32(up, "up"), front=uint32(front, "front"), symmetry=uint32(symmetry, "symmetry"),
        flags=uint32(flags, "flags"), name=given.text(name), face_object=given.text(face_object),
        progress=_progress_type())
    desc.unit = float(unit)
    desc.lod_triangles = float(lod_triangles)
    if bones is not None:
        given.bones(bones, desc)
    if weights is not None:
        given.weights(weights, len(places), desc)
    given.results(len(places), list(shapes or {}), desc, depth_groups=depth_groups, mask=mask,
                  lod_joints=lod_joints, bone_groups=bone_groups, bone_motions=bone_motions)
    if landmarks is not None:
        given.landmarks(landmarks, desc)
    if lod_meshes is not None:
        given.lods(lod_meshes, desc)
    made = _make(mesh, desc, progress, executor)
    del given  # not before
    return made


def _make(mesh: Any, desc: Any, progress: Optional[Callable[[str, float], Any]],
          executor: Optional[Executor]) -> AuthoredRig:
    raised: List[BaseException] = []

    def report_progress(_user: Any, step: int, share: float) -> int:
        try:
            assert progress is not None
            return 1 if progress(ctypes.string_at(step).decode(), share) else 0
        except BaseException as error:  # must not cross the library
            raised.append(error)
            return 1

    if progress is not None:
        desc.progress = _progress_type(report_progress)
    library, handle, report, error = author(), DnaHandle(), _api.MienAuthorReport(), MienError()
    status = 0

    def call(parallel: Any) -> None:
        nonlocal status
        if parallel is not None:
            desc.parallel = ctypes.pointer(parallel._obj)
        status = library.mien_author_rig(_byref(mesh), _byref(desc), _byref(handle), _byref(report),
                                         _byref(error))

    call_with_threads(executor, call)
    if raised:
        raise raised[0]
    if status:
        fail(status, "cannot make a rig", error)
    try:
        text = _api.MienStringView()
        status = library.mien_author_report_json(report, _byref(text))
        if status:
            fail(status, "no report")
        return AuthoredRig(Dna(handle), json.loads(_api.text(text)))
    finally:
        library.mien_author_report_close(report)
