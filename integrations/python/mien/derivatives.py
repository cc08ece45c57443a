# SPDX-License-Identifier: MIT
"""Derivatives of a rig: products of directions and gradients, and their matrices. Needs NumPy."""
from __future__ import annotations

import ctypes
from _thread import allocate_lock
from contextlib import contextmanager
from typing import Any, Iterator, NamedTuple, Optional, Union

from . import _api
from ._api import MienError, Point, Stage, Status
from ._library import lib
from ._memory import Closable, DerivativesHandle, Floats, Indices, numpy, uint32
from .deformer import Deformer
from .errors import ArgumentError, BusyError, fail, raises
from .instance import Instance
from .rig import Rig

_byref = ctypes.byref


class Jacobian(NamedTuple):
    """The entries of a matrix that are not 0, by column, then by row.

    rows, columns: uint32 (entries,)
    values:        float32 (entries,)
    shape:         of the matrix
    """

    rows: Any
    columns: Any
    values: Any
    shape: Any

    def dense(self) -> Any:
        """float32 of the shape."""
        matrix = numpy.zeros(self.shape, "f")
        matrix[self.rows, self.columns] = self.values
        return matrix


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
    def jacobian(self, of: int = Point.RAW, to: int = Point.JOINTS, mesh: int = 0,
                 inputs: Any = None, outputs: Any = None) -> Jacobian:
        """The matrix of the derivatives of the numbers at `to`, its rows, by those at `of`.

        inputs, outputs: only these columns, and these rows, which ascend
        """
        given = [None if numbers is None else numpy.ascontiguousarray(numbers, "uint32").reshape(-1)
                 for numbers in (inputs, outputs)]
        with self._alone() as handle:
            shape = tuple(self._size(handle, point, mesh) if numbers is None else numbers.size
                          for point, numbers in ((to, given[1]), (of, given[0])))
            desc = _api.MienJacobian(
                inputs=given[0] is not None and given[0].ctypes.data or None,
                outputs=given[1] is not None and given[1].ctypes.data or None,
                input_count=0 if given[0] is None else given[0].size,
                output_count=0 if given[1] is None else given[1].size)
            found = ctypes.c_size_t()

            def compute() -> None:
                status = lib.mien_derivatives_jacobian(handle, uint32(of, "of"), uint32(to, "to"),
                                                       uint32(mesh, "mesh"), _byref(desc), _byref(found))
                if status:
                    fail(status, f"from {of!r} to {to!r}")
            compute()
            count = found.value
            rows, columns, values = (numpy.empty(count, kind) for kind in ("uint32", "uint32", "f"))
            if count:
                desc.rows = rows.ctypes.data
                desc.columns = columns.ctypes.data
                desc.values = values.ctypes.data
                desc.capacity = count
                compute()
        return Jacobian(rows, columns, values, shape)

    def __repr__(self) -> str:
        return "<mien.Derivatives, closed>" if self.closed else "<mien.Derivatives>"
