# SPDX-License-Identifier: MIT
"""Deformers and their instances: from joint values and channel weights to vertices."""
from __future__ import annotations

import ctypes
from _thread import allocate_lock
from concurrent.futures import Executor
from contextlib import ExitStack, contextmanager
from sys import byteorder
from typing import Any, Iterable, Iterator, List, Optional, Sequence, Tuple, Union

from . import _api
from ._api import (Compose, DeformerInfo, Isa, Kind, MienError, Normals, Status, Storage,
                   VertexFormat, Weights)
from ._library import lib
from ._memory import (Closable, DeformerHandle, Floats, Indices, PoseHandle, array_over, floats_of,
                      lod_bits, new_array, shaped, uint32)
from ._threads import call_with_threads
from .dna import Dna
from .errors import ArgumentError, BusyError, UnknownNameError, fail, raises
from .instance import Instance
from .rig import Rig

_byref = ctypes.byref
_NATIVE = "=@<" if byteorder == "little" else "=@>"


def _matrices(owner: Any, view: Any) -> Any:
    """16 floats per joint, column by column, as [row, column] of NumPy."""
    found = array_over(owner, view.data, view.count, "f", False, (-1, 4, 4))
    return found.transpose(0, 2, 1) if hasattr(found, "transpose") else found


class Mesh:
    """The neutral mesh `index` of a deformer. Arrays are read-only views of the deformer's memory.

      name:                of the mesh
      lods:                LODs that show it
      positions:           float32 (positions, 3)
      normals:             float32 (vertices, 3), unit length
      tangents:            float32 (vertices, 4), x y z and w; empty unless asked for
      texture_coordinates: float32 (vertices, 2), as in the file; a copy with 16-bit storage
      vertex_position_indices:    uint32 (vertices,): position of each vertex
      triangles:           uint32 (triangles, 3): vertices, wound as in the file; a copy with 16-bit storage
      target_channels:     uint16 (targets,): channel of each blend shape target
      max_influences:     joints that hold the position that most of them hold
      delta_count:         moved positions over all targets
    """

    def __init__(self, handle: DeformerHandle, index: int, name: str, mesh: Any) -> None:
        def view(of: Any, code: str, width: int = 0) -> Any:
            shape = (of.count // width, width) if width else None
            return array_over(handle, of.data, of.count, code, False, shape)

        def copy(write: Any, code: str, rows: int, width: int) -> Any:
            values, address = new_array(code, rows * width)
            status = write(handle, index, address, rows * width)
            if status:
                fail(status, f"mesh {index}")
            return shaped(values, (rows, width))

        self.index, self.name = index, name
        self.lods: List[int] = [lod for lod in range(64) if mesh.lods >> lod & 1]
        self.positions: Floats = view(mesh.positions, "f", 3)
        self.normals: Floats = view(mesh.normals, "f", 3)
        self.tangents: Floats = view(mesh.tangents, "f", 4)
        self.texture_coordinates: Floats = (
            view(mesh.texture_coordinates, "f", 2) if mesh.texture_coordinates.count or not mesh.vertex_count
            else copy(lib.mien_deformer_texture_coordinates, "f", mesh.vertex_count, 2))
        self.vertex_position_indices: Any = view(mesh.vertex_position_indices, "I")
        self.triangles: Any = (
            view(mesh.triangles, "I", 3) if mesh.triangles.count or not mesh.triangle_count
            else copy(lib.mien_deformer_triangles, "I", mesh.triangle_count, 3))
        self.target_channels: Indices = view(mesh.target_channels, "H")
        self.position_count: int = mesh.position_count
        self.vertex_count: int = mesh.vertex_count
        self.triangle_count: int = mesh.triangle_count
        self.target_count: int = mesh.target_count
        self.max_influences: int = mesh.max_influences
        self.delta_count: int = mesh.delta_count

    def __repr__(self) -> str:
        return (f"<mien.Mesh {self.index} {self.name!r}: {self.position_count} positions, "
                f"{self.vertex_count} vertices, {self.triangle_count} triangles, "
                f"{self.target_count} targets>")


class Deformer(Closable):
    """The geometry of a DNA, packed once. Immutable: any number of threads may use it at once.

        deformer = mien.Deformer(dna, rig)
        pose = deformer.instance()
        face.evaluate()
        pose.update(face)
        pose.deform(0)
        pose.positions(0)      # float32 (positions, 3) of mesh 0

    `dna` is the one that the rig was made of, with geometry loaded; both may be closed afterwards.

    isa:     `Isa`; BEST means that of the rig
    compose: how a joint's rotation is made of the neutral one and the delta, see `Compose`
    weights: whether skin weights are mended, see `Weights`
    normals: what `DeformerInstance.deform` makes if it is not told, see `Normals`
    with_tangents: computes tangents, for `DeformerInstance.write_vertices`
    storage: `Storage.BIT_16` stores blend shapes, skin weights and texture coordinates with 16 bits; then
             `influences` is an error
    delta_error: largest error of a coordinate of a delta that 16-bit storage may make to store it with 10
             bits, in translation units; 0: 2^-18 of the size of the mesh
    """

    __slots__ = ("info", "_mesh_names")

    @raises("mien_deformer_create")
    def __init__(self, dna: Dna, rig: Rig, isa: int = Isa.BEST, compose: int = Compose.PRODUCT,
                 weights: int = Weights.AS_STORED, normals: int = Normals.DEFAULT,
                 with_tangents: bool = False, storage: int = Storage.BIT_32,
                 delta_error: float = 0) -> None:
        desc = _api.MienDeformerDesc(isa=uint32(isa, "isa"), compose=uint32(compose, "compose"),
                                     weights=uint32(weights, "weights"),
                                     normals=uint32(normals, "normals"),
                                     with_tangents=bool(with_tangents),
                                     storage=uint32(storage, "storage"), delta_error=float(delta_error))
        handle, error = DeformerHandle(), MienError()
        status = lib.mien_deformer_create(dna._open(), rig._open(), _byref(desc), _byref(handle),
                                          _byref(error))
        if status:
            fail(status, "cannot make a deformer", error)
        self._take(handle, rig)

    @classmethod
    def _of(cls, handle: DeformerHandle, rig: Rig) -> Deformer:
        deformer = cls.__new__(cls)
        deformer._take(handle, rig)
        return deformer

    @raises("mien_deformer_create_subset")
    def subset(self, mesh: int, positions: Any) -> Deformer:
        """A deformer of some positions of one mesh, ascending: position i is `positions[i]` of this one. It has
        no vertices, and its other meshes are empty."""
        chosen = [uint32(position, "position") for position in positions]
        whole = self._open()
        handle, error = DeformerHandle(), MienError()
        handle.baked = whole.baked
        status = lib.mien_deformer_create_subset(
            whole, uint32(mesh, "mesh"), (ctypes.c_uint32 * len(chosen))(*chosen), len(chosen), None,
            _byref(handle), _byref(error))
        if status:
            fail(status, "cannot make a deformer", error)
        made = type(self).__new__(type(self))
        made._handle, made._mesh_names = handle, self._mesh_names
        info = _api.MienDeformerInfo()
        status = lib.mien_deformer_info(handle, _byref(info))
        if status:
            fail(status, "no info")
        made.info = DeformerInfo._of(info)
        return made

    def _take(self, handle: DeformerHandle, rig: Rig) -> None:
        self._handle = handle
        info = _api.MienDeformerInfo()
        status = lib.mien_deformer_info(handle, _byref(info))
        if status:
            fail(status, "no info")
        self.info: DeformerInfo = DeformerInfo._of(info)
        self._mesh_names = rig.names(Kind.MESH)

    @raises("mien_deformer_mesh", "mien_deformer_triangles", "mien_deformer_texture_coordinates",
            but=(Status.INVALID_ARGUMENT,))
    def mesh(self, mesh: Union[int, str]) -> Mesh:
        """A neutral mesh, by index or by name."""
        if isinstance(mesh, str):
            if mesh not in self._mesh_names:
                raise UnknownNameError(f"there is no mesh {mesh!r}", Status.NAME)
            mesh = self._mesh_names.index(mesh)
        index, handle, found = mesh, self._open(), _api.MienMesh()
        status = lib.mien_deformer_mesh(handle, uint32(index, "mesh"), _byref(found))
        if status:
            fail(status, f"mesh {index} of {self.info.mesh_count}")
        return Mesh(handle, index, self._mesh_names[index], found)

    @property
    def meshes(self) -> List[Mesh]:
        """All neutral meshes."""
        return [self.mesh(i) for i in range(self.info.mesh_count)]

    @raises("mien_deformer_influences")
    def influences(self, mesh: int, position: int) -> Tuple[Indices, Floats]:
        """uint16 (n,) joints that influence a position, and float32 (n,) their weights."""
        handle, joints, weights = self._open(), _api.MienIndex16View(), _api.MienFloatView()
        status = lib.mien_deformer_influences(handle, uint32(mesh, "mesh"),
                                              uint32(position, "position"), _byref(joints),
                                              _byref(weights))
        if status:
            fail(status, f"position {position} of mesh {mesh}")
        return (array_over(handle, joints.data, joints.count, "H", False),
                array_over(handle, weights.data, weights.count, "f", False))

    @raises("mien_deformer_mesh", "mien_deformer_target")
    def target(self, mesh: int, target: int) -> Floats:
        """float32 (positions, 3), a copy: how far a target moves each position at weight 1."""
        count = self.mesh(mesh).position_count * 3
        values, address = new_array("f", count)
        status = lib.mien_deformer_target(self._open(), uint32(mesh, "mesh"),
                                          uint32(target, "target"), address, count)
        if status:
            fail(status, f"target {target} of mesh {mesh}")
        return shaped(values, (-1, 3))

    @property
    def bind_matrices(self) -> Floats:
        """float32 (joints, 4, 4), [row, column], for column vectors: model matrices in neutral."""
        handle, view = self._open(), _api.MienFloatView()
        status = lib.mien_deformer_bind_matrices(handle, _byref(view))
        if status:
            fail(status, "bind matrices")
        return _matrices(handle, view)

    @property
    def inverse_bind_matrices(self) -> Floats:
        """float32 (joints, 4, 4): the inverses of these."""
        handle, view = self._open(), _api.MienFloatView()
        status = lib.mien_deformer_inverse_bind_matrices(handle, _byref(view))
        if status:
            fail(status, "inverse bind matrices")
        return _matrices(handle, view)

    def instance(self, lods: Optional[Iterable[int]] = None) -> DeformerInstance:
        """A new pose in neutral, with room for the meshes of these LODs; None: for all."""
        return DeformerInstance(self, lods)

    def __repr__(self) -> str:
        if self.closed:
            return "<mien.Deformer, closed>"
        return f"<mien.Deformer: {self.info.mesh_count} meshes, {self.info.joint_count} joints>"


class DeformerInstance(Closable):
    """The deformed meshes of one character. For one thread at a time: a second gets a BusyError.

    Arrays are views of the pose's own memory, as at `Instance`: each stays the same, its contents
    change with each `update` or `deform`, and it keeps the memory alive after `close()`.
    """

    __slots__ = ("deformer", "_lock")

    @raises("mien_deformer_instance_create")
    def __init__(self, deformer: Deformer, lods: Optional[Iterable[int]] = None) -> None:
        desc = _api.MienDeformerInstanceDesc(lods=lod_bits(lods))
        handle, error = PoseHandle(), MienError()
        made_for = deformer._open()
        handle.baked = made_for.baked
        status = lib.mien_deformer_instance_create(made_for, _byref(desc), _byref(handle),
                                                   _byref(error))
        if status:
            fail(status, "cannot make a pose", error)
        self._handle = handle
        self.deformer = deformer
        self._lock = allocate_lock()

    @contextmanager
    def _alone(self) -> Iterator[Any]:
        """The handle, for this thread."""
        if not self._lock.acquire(False):
            raise BusyError("another thread is working with this pose, or it is named twice",
                            Status.HANDLE)
        try:
            yield self._open()
        finally:
            self._lock.release()

    @raises("mien_deformer_instance_update")
    def update(self, instance: Instance) -> None:
        """Copies joint values and channel weights of the instance's last evaluation, and computes the
        matrices of all joints; then `deform` deforms meshes."""
        with self._alone() as handle, instance._alone() as evaluated:
            status = lib.mien_deformer_instance_update(handle, evaluated)
            if status:
                fail(status, "an instance of another rig")

    @raises("mien_deformer_instance_update_from_values")
    def update_from_values(self, joint_values: Any = None, channel_weights: Any = None) -> None:
        """The same from arrays: joint values of the shape and units of `Instance.joints` (None: no
        deltas) and one weight per channel (None: all 0)."""
        shape = (self.deformer.info.joint_count, None)
        joints, joint_count, joint_address = floats_of(joint_values, "joint_values", shape)
        weights, weight_count, weight_address = floats_of(channel_weights, "channel_weights")
        with self._alone() as handle:
            status = lib.mien_deformer_instance_update_from_values(handle, joint_address, joint_count,
                                                      weight_address, weight_count)
            if status:
                fail(status, f"{joint_count} joint values and {weight_count} channel weights")
            del joints, weights  # so far they had to live

    @raises("mien_deformer_instance_deform")
    def deform(self, mesh: int, normals: int = Normals.DEFAULT,
               threads: Optional[Executor] = None) -> None:
        """Computes `positions(mesh)` as of the last update, and normals of a kind (`Normals`).

        threads: such as a ThreadPoolExecutor, for large meshes; the result has the same bits
        """
        def call(parallel: Any) -> None:
            with self._alone() as handle:
                status = lib.mien_deformer_instance_deform(handle, uint32(mesh, "mesh"),
                                              uint32(normals, "normals"), parallel)
                if status:
                    fail(status, f"mesh {mesh}")

        call_with_threads(threads, call)

    @raises("mien_deformer_instance_write_vertices")
    def write_vertices(self, mesh: int, positions: Any = None, normals: Any = None,
                       tangents: Any = None, *, mode: int = Normals.DEFAULT,
                       threads: Optional[Executor] = None) -> None:
        """`deform`, and then writes positions, normals and tangents per vertex into arrays of yours,
        as vertex buffers of GPUs hold them. None: not written.

        The type of an array is its format: float32 (n, 3), float32 (n, 4), int16 (n, 4) for signed
        normalized integers, or uint32 (n,) for 10-10-10-2; n is at least the number of vertices.
        Arrays may be fields of a structured array, so that vertices are interleaved:

            vertex = numpy.dtype([("position", "f4", 3), ("normal", "u4"), ("tangent", "i2", 4)])
            buffer = numpy.zeros(deformer.mesh(0).vertex_count, vertex)
            instance.write_vertices(0, buffer["position"], buffer["normal"], buffer["tangent"])

        tangents: need a deformer made with `with_tangents`
        mode:     which normals, see `Normals`
        threads:  as of `deform`
        """
        output = _VertexOutput(positions, normals, tangents)

        def call(parallel: Any) -> None:
            with self._alone() as handle:
                status = lib.mien_deformer_instance_write_vertices(
                    handle, uint32(mesh, "mesh"), uint32(mode, "mode"), _byref(output.struct),
                    parallel)
                if status:
                    fail(status, f"vertices of mesh {mesh}")

        call_with_threads(threads, call)

    def _view(self, call: Any, what: str, width: int, *mesh: int) -> Any:
        handle, view = self._open(), _api.MienFloatView()
        status = call(handle, *mesh, _byref(view))
        if status:
            fail(status, what)
        if width == 16:
            return _matrices(handle, view)
        return array_over(handle, view.data, view.count, "f", False, (view.count // width, width))

    @raises("mien_deformer_instance_positions")
    def positions(self, mesh: int) -> Floats:
        """float32 (positions, 3) of the last `deform`."""
        return self._view(lib.mien_deformer_instance_positions, f"mesh {mesh}", 3, uint32(mesh, "mesh"))

    @raises("mien_deformer_instance_normals")
    def normals(self, mesh: int) -> Floats:
        """float32 (vertices, 3) of the last `deform` that computed normals."""
        return self._view(lib.mien_deformer_instance_normals, f"mesh {mesh}", 3, uint32(mesh, "mesh"))

    @property
    def joint_matrices(self) -> Floats:
        """float32 (joints, 4, 4), [row, column], for column vectors: model matrices."""
        return self._view(lib.mien_deformer_instance_joint_matrices, "joint matrices", 16)

    @property
    def skin_matrices(self) -> Floats:
        """float32 (joints, 4, 4): model matrix * inverse bind matrix, for skinning elsewhere."""
        return self._view(lib.mien_deformer_instance_skin_matrices, "skin matrices", 16)

    @property
    def local_transforms(self) -> Floats:
        """float32 (joints, 10), a copy: tx ty tz qx qy qz qw sx sy sz relative to the parent."""
        count = self.deformer.info.joint_count * 10
        values, address = new_array("f", count)
        with self._alone() as handle:
            status = lib.mien_deformer_instance_local_transforms(handle, address, count)
            if status:
                fail(status, "local transforms")
        return shaped(values, (-1, 10))

    def __repr__(self) -> str:
        return f"<mien.DeformerInstance{', closed' if self.closed else ''} of {self.deformer!r}>"


_FORMATS = {("f", 3): VertexFormat.FLOAT32X3, ("f", 4): VertexFormat.FLOAT32X4,
            ("h", 4): VertexFormat.SNORM16X4, ("I", 1): VertexFormat.SNORM10_10_10_2,
            ("L", 1): VertexFormat.SNORM10_10_10_2}


class _VertexOutput:
    """A MienVertexOutput over arrays of the caller, which it keeps alive."""

    def __init__(self, positions: Any, normals: Any, tangents: Any) -> None:
        self.views: List[memoryview] = []
        self.struct = _api.MienVertexOutput(positions=self._stream(positions, "positions"),
                                            normals=self._stream(normals, "normals"),
                                            tangents=self._stream(tangents, "tangents"))
        self.struct.vertex_capacity = min((view.shape[0] for view in self.views if view.shape),
                                          default=0)

    def _stream(self, values: Any, what: str) -> Any:
        if values is None:
            return _api.MienVertexStream()
        view = memoryview(values)
        shape, strides = view.shape or (), view.strides or ()
        width = shape[1] if len(shape) == 2 else 1 if len(shape) == 1 else 0
        vertex_format = _FORMATS.get((view.format.lstrip(_NATIVE), width))
        if vertex_format is None or view.itemsize != (2 if vertex_format == VertexFormat.SNORM16X4
                                                      else 4):
            raise ArgumentError(f"{what} takes float32 (n, 3) or (n, 4), int16 (n, 4) or uint32 "
                                f"(n,), not {view.format!r} {shape}")
        if view.readonly:
            raise ArgumentError(f"{what} is read-only")
        if strides[0] < 0 or (len(shape) == 2 and strides[1] != view.itemsize):
            raise ArgumentError(f"{what} has strides {strides}: parts of a vertex lie side by side, "
                                "and vertices at ascending addresses")
        self.views.append(view)
        return _api.MienVertexStream(data=_address_of(values, view), stride=strides[0],
                                     format=vertex_format)


def _address_of(values: Any, view: memoryview) -> int:
    """Of the first element. NumPy tells it; of other arrays all elements lie in a row."""
    interface = getattr(values, "__array_interface__", None)
    if interface is not None:
        address: int = interface["data"][0]
        return address
    return ctypes.addressof(ctypes.c_char.from_buffer(view)) if view.nbytes else 0


@raises("mien_deformer_instance_deform_batch")
def deform_batch(poses: Sequence[DeformerInstance], mesh: int, normals: int = Normals.DEFAULT,
                 threads: Optional[Executor] = None) -> None:
    """`DeformerInstance.deform` of the same mesh of several poses of one deformer: the same bits, but each
    piece of the mesh is fetched once."""
    poses = list(poses)

    def call(parallel: Any) -> None:
        with ExitStack() as stack:
            handles = [stack.enter_context(pose._alone()) for pose in poses]
            pointers = (_api.MienDeformerInstance * len(handles))(*handles)
            status = lib.mien_deformer_instance_deform_batch(pointers, len(handles), uint32(mesh, "mesh"),
                                                uint32(normals, "normals"), parallel)
            if status:
                fail(status, f"mesh {mesh} of {len(handles)} poses")

    call_with_threads(threads, call)


@raises("mien_deformer_instance_write_vertices_batch")
def write_vertices_batch(instances: Sequence[DeformerInstance], mesh: int,
                         outputs: Sequence[Sequence[Any]], mode: int = Normals.DEFAULT,
                         threads: Optional[Executor] = None) -> None:
    """`DeformerInstance.write_vertices` of the same mesh of several instances of one deformer:
    `outputs` has positions, normals and tangents of each. Arrays of different instances share no
    memory."""
    instances, count = list(instances), len(outputs)
    if len(instances) != count:
        raise ArgumentError(f"{len(instances)} instances and {count} outputs")
    made = [_VertexOutput(*output) for output in outputs]
    structs = (_api.MienVertexOutput * count)(*[output.struct for output in made])

    def call(parallel: Any) -> None:
        with ExitStack() as stack:
            handles = [stack.enter_context(instance._alone()) for instance in instances]
            pointers = (_api.MienDeformerInstance * count)(*handles)
            status = lib.mien_deformer_instance_write_vertices_batch(
                pointers, count, uint32(mesh, "mesh"), uint32(mode, "mode"), structs, parallel)
            if status:
                fail(status, f"vertices of mesh {mesh} of {count} instances")

    call_with_threads(threads, call)
