# SPDX-License-Identifier: MIT
"""Derivatives of a rig: products of directions and gradients, and their matrices. Needs NumPy."""
from __future__ import annotations

import ctypes
from _thread import allocate_lock
from contextlib import contextmanager
from typing import Any, Iterator, Optional

from . import _api
from ._api import MienError, Point, Stage, Status
from ._library import lib
from ._memory import Closable, DerivativesHandle, Floats, JacobianHandle, array_over, numpy, uint32
from .deformer import Deformer
from .errors import ArgumentError, BusyError, fail, raises
from .instance import Instance
from .rig import Rig

_byref = ctypes.byref


class Derivatives(Closable):
    """Derivatives of a rig at one pose (docs/derivatives.md). For one thread at a time.

        derivatives = mien.Derivatives(rig, deformer)
        face.evaluate()
        derivatives.linearize(face)
        derivatives.jvp(direction)                                   # of joint values
        derivatives.vjp(gradient, to=mien.Point.POSITIONS, mesh=0)   # of raw controls

    deformer: needed for points from `Point.LOCALS` to `Point.POSITIONS`
    """

    __slots__ = ("_lock",)

    @raises("mien_derivatives_create")
    def __init__(self, rig: Rig, deformer: Optional[Deformer] = None) -> None:
        if numpy is None:
            raise ImportError("derivatives need NumPy")
        desc = _api.MienDerivativesDesc(deformer=deformer and deformer._open())
        handle, error = DerivativesHandle(), MienError()
        status = lib.mien_derivatives_create(rig._open(), _byref(desc), _byref(handle), _byref(error))
        if status:
            fail(status, "cannot make derivatives", error)
        handle.kept = rig._open(), deformer and deformer._open()
        self._handle = handle
        self._lock = allocate_lock()

    @contextmanager
    def _alone(self) -> Iterator[Any]:
        """The handle, for this thread."""
        if not self._lock.acquire(False):
            raise BusyError("another thread is working with these derivatives", Status.HANDLE)
        try:
            yield self._open()
        finally:
            self._lock.release()

    @raises("mien_derivatives_size")
    def size(self, point: int, mesh: int = 0) -> int:
        """How many numbers a point has."""
        return self._size(self._open(), point, mesh)

    def _size(self, handle: Any, point: int, mesh: int) -> int:
        found = ctypes.c_size_t()
        status = lib.mien_derivatives_size(handle, uint32(point, "point"), uint32(mesh, "mesh"),
                                           _byref(found))
        if status:
            fail(status, f"{point!r} of mesh {mesh}")
        return found.value

    @raises("mien_derivatives_linearize")
    def linearize(self, instance: Instance, stages: int = Stage.ALL) -> None:
        """Computes the derivatives at the last evaluation of the instance. Results of stages that are
        left out count as constants."""
        with self._alone() as handle, instance._alone() as evaluated:
            status = lib.mien_derivatives_linearize(handle, evaluated, uint32(stages, "stages"))
            if status:
                fail(status, "an instance of another rig")

    @raises("mien_derivatives_forward")
    def jvp(self, directions: Any, of: int = Point.RAW, to: int = Point.JOINTS, mesh: int = 0) -> Floats:
        """Jacobian-vector products: how the numbers at `to` change along directions of those at `of`.
        One direction or rows of them, (n,) or (count, n); the result has as many."""
        return self._multiply(lib.mien_derivatives_forward, directions, of, to, mesh, of, to)

    @raises("mien_derivatives_reverse")
    def vjp(self, gradients: Any, of: int = Point.RAW, to: int = Point.JOINTS, mesh: int = 0) -> Floats:
        """Vector-Jacobian products: gradients by the numbers at `to` become those by the numbers at
        `of`. One gradient or rows of them."""
        return self._multiply(lib.mien_derivatives_reverse, gradients, of, to, mesh, to, of)

    def _multiply(self, call: Any, rows: Any, of: int, to: int, mesh: int, given: int, wanted: int) -> Any:
        found = numpy.asarray(rows)
        with self._alone() as handle:
            width = self._size(handle, given, mesh)
            shape = found.shape[:1] if found.ndim == 2 or found.ndim == 1 and width != found.size else ()
            if found.dtype.kind not in "fiub" or found.size != width * (shape[0] if shape else 1):
                raise ArgumentError(f"rows of {width} numbers are needed, not {found.dtype} of the shape "
                                    f"{found.shape}")
            packed = numpy.ascontiguousarray(found, "f")
            count = shape[0] if shape else 1
            out = numpy.empty((count, self._size(handle, wanted, mesh)), "f")
            status = 0
            if count:
                status = call(handle, uint32(of, "of"), uint32(to, "to"), uint32(mesh, "mesh"), count,
                              packed.ctypes.data, out.ctypes.data)
            if status:
                fail(status, f"from {of!r} to {to!r}: linearize first, and name points in their order")
        return out if shape else out[0]

    @raises("mien_derivatives_jacobian")
    def jacobian(self, jacobian: Jacobian, wanted: Any = None, out: Any = None) -> Floats:
        """The entries of a matrix at the pose that was linearized: float32 (entries,).

        wanted: a boolean per column: entries of the others are not computed
        out:    float32 (entries,) to write to, of which those entries keep their values; a new array has 0
                there
        """
        columns = None if wanted is None else numpy.ascontiguousarray(wanted, bool).reshape(-1)
        if columns is not None and columns.size != jacobian.shape[1]:
            raise ArgumentError(f"`wanted` takes {jacobian.shape[1]} columns, not {columns.size}")
        count = jacobian.rows.size
        if out is None:
            out = numpy.zeros(count, "f")
        elif not (isinstance(out, numpy.ndarray) and out.dtype == "f" and out.shape == (count,)
                  and out.flags.c_contiguous and out.flags.writeable):
            raise ArgumentError(f"`out` is not a writable float32 array of the shape ({count},)")
        with self._alone() as handle:
            status = lib.mien_derivatives_jacobian(
                handle, jacobian._open(), None if columns is None else columns.ctypes.data,
                0 if columns is None else columns.size, out.ctypes.data, count)
            if status:
                fail(status, "a matrix for another rig, deformer or LOD, or nothing was linearized")
        return out

    def __repr__(self) -> str:
        return "<mien.Derivatives, closed>" if self.closed else "<mien.Derivatives>"


class Jacobian(Closable):
    """A sparse matrix of derivatives of the numbers at `to`, its rows, by those at `of`: which entries may be
    other than 0 in some pose. `Derivatives.jacobian()` computes them. Any threads may use one at the same
    time.

        jacobian = mien.Jacobian(derivatives, to=mien.Point.JOINTS)
        values = derivatives.jacobian(jacobian)
        scipy.sparse.coo_matrix((values, (jacobian.rows, jacobian.columns)), jacobian.shape)

    inputs, outputs: only these columns, and these rows, which ascend
    lod:             of the evaluations

    rows, columns: uint32 (entries,), by column, then by row; read-only
    shape:         of the matrix
    directions:    how many directions compute all columns
    """

    __slots__ = ("rows", "columns", "shape", "directions")

    @raises("mien_jacobian_create", "mien_jacobian_pattern")
    def __init__(self, derivatives: Derivatives, of: int = Point.RAW, to: int = Point.JOINTS, mesh: int = 0,
                 lod: int = 0, inputs: Any = None, outputs: Any = None) -> None:
        given = [None if numbers is None else numpy.ascontiguousarray(numbers, "uint32").reshape(-1)
                 for numbers in (inputs, outputs)]
        desc = _api.MienJacobianDesc(
            from_point=uint32(of, "of"), to_point=uint32(to, "to"), mesh=uint32(mesh, "mesh"),
            lod=uint32(lod, "lod"),
            inputs=given[0] is not None and given[0].ctypes.data or None,
            outputs=given[1] is not None and given[1].ctypes.data or None,
            input_count=0 if given[0] is None else given[0].size,
            output_count=0 if given[1] is None else given[1].size)
        handle, error, pattern = JacobianHandle(), MienError(), _api.MienJacobianPattern()
        with derivatives._alone() as of_rig:
            status = lib.mien_jacobian_create(of_rig, _byref(desc), _byref(handle), _byref(error))
            if status:
                fail(status, "cannot make a matrix of derivatives", error)
            handle.kept = of_rig.kept
        status = lib.mien_jacobian_pattern(handle, _byref(pattern))
        if status:
            fail(status, "cannot read the matrix")
        self._handle = handle
        self.rows, self.columns = (array_over(handle, view.data, view.count, "I", False)
                                   for view in (pattern.rows, pattern.columns))
        self.shape = pattern.row_count, pattern.column_count
        self.directions = pattern.direction_count

    def dense(self, values: Any) -> Floats:
        """float32 of the shape."""
        matrix = numpy.zeros(self.shape, "f")
        matrix[self.rows, self.columns] = values
        return matrix

    def __repr__(self) -> str:
        if self.closed:
            return "<mien.Jacobian, closed>"
        return f"<mien.Jacobian {self.shape[0]} x {self.shape[1]}, {self.rows.size} entries>"
