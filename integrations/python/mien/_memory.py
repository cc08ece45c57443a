# SPDX-License-Identifier: MIT
"""Who owns what, and arrays over the library's memory.

An object of the library is released when nothing refers to it any more: neither the Python object
that made it, nor an array that looks into its memory, nor a call that is under way in another
thread. So `close()` gives up a reference and never frees memory that is in use:

    Instance ----> handle <---- buffer <---- array <---- array[3:5]
    a call ----------^

The handle alone knows the destructor. Closing makes further calls through the closed object raise;
arrays taken before keep their last values and stay valid memory for as long as they exist.
"""
from __future__ import annotations

import ctypes
import os
from array import array
from operator import index
from typing import TYPE_CHECKING, Any, Dict, Iterable, NoReturn, Optional, Tuple, TypeVar

from . import _api
from ._library import author, lib, solver
from ._api import Status
from .errors import ArgumentError, ClosedError, OutOfRangeError

try:
    import numpy as _numpy
    numpy: Any = _numpy
except ImportError:
    numpy = None  # arrays are memoryviews then

if TYPE_CHECKING:
    from numpy import float32, uint16
    from numpy.typing import NDArray
    Floats = NDArray[float32]
    Indices = NDArray[uint16]
else:
    Floats = Indices = Any


Self = TypeVar("Self", bound="Closable")


class _Address:
    """An address means nothing in another process, and two owners would release it twice."""

    __slots__ = ()

    def __reduce_ex__(self, protocol: Any) -> Any:
        raise TypeError(f"{type(self).__name__} objects cannot be copied, pickled or sent to other "
                        "processes; make new ones there")


class DnaHandle(_Address, _api.MienDna):
    keeps: Any  # bytes that the library reads from

    def __del__(self, destroy: Any = lib.mien_dna_close) -> None:
        if self.value:
            destroy(self)


class DocumentHandle(_Address, _api.MienDocument):
    def __del__(self, library: Any = author) -> None:
        if self.value:
            library().mien_document_destroy(self)


class ReportHandle(_Address, _api.MienReport):
    def __del__(self, destroy: Any = lib.mien_report_destroy) -> None:
        if self.value:
            destroy(self)


class BakedHandle(_Address, _api.MienBaked):
    keeps: Any  # bytes that the library reads from

    def __del__(self, destroy: Any = lib.mien_baked_close) -> None:
        if self.value:
            destroy(self)


class ClipHandle(_Address, _api.MienClip):
    keeps: Any  # bytes that the library reads from

    def __del__(self, destroy: Any = lib.mien_clip_close) -> None:
        if self.value:
            destroy(self)


class ClipPlayerHandle(_Address, _api.MienClipPlayer):
    clip: Optional[ClipHandle]  # whose bytes may be in memory of Python

    def __del__(self, destroy: Any = lib.mien_clip_player_destroy) -> None:
        if self.value:
            destroy(self)


class ClipBindingHandle(_Address, _api.MienClipBinding):
    def __del__(self, destroy: Any = lib.mien_clip_binding_destroy) -> None:
        if self.value:
            destroy(self)


class MixHandle(_Address, _api.MienMix):
    def __del__(self, destroy: Any = lib.mien_mix_destroy) -> None:
        if self.value:
            destroy(self)


class MixerHandle(_Address, _api.MienMixer):
    def __del__(self, destroy: Any = lib.mien_mixer_destroy) -> None:
        if self.value:
            destroy(self)


class GazeHandle(_Address, _api.MienGaze):
    def __del__(self, destroy: Any = lib.mien_gaze_destroy) -> None:
        if self.value:
            destroy(self)


class SolverStackHandle(_Address, _api.MienSolverStack):
    baked: Optional[BakedHandle]  # of the deformer, whose arrays may be in memory of Python
    functions: Any  # of custom solvers

    def __del__(self, destroy: Any = lib.mien_solver_stack_destroy) -> None:
        if self.value:
            destroy(self)


class SolverStateHandle(_Address, _api.MienSolverState):
    stack: Optional[SolverStackHandle]  # whose functions it calls

    def __del__(self, destroy: Any = lib.mien_solver_state_destroy) -> None:
        if self.value:
            destroy(self)


class RigHandle(_Address, _api.MienRig):
    baked: Optional[BakedHandle] = None  # where its arrays are

    def __del__(self, destroy: Any = lib.mien_rig_destroy) -> None:
        if self.value:
            destroy(self)


class BatchHandle(_Address, _api.MienBatch):
    def __del__(self, destroy: Any = lib.mien_batch_destroy) -> None:
        if self.value:
            destroy(self)


class DerivativesHandle(_Address, _api.MienDerivatives):
    kept: Any  # rig and deformer, whose arrays may be in memory of Python

    def __del__(self, destroy: Any = lib.mien_derivatives_destroy) -> None:
        if self.value:
            destroy(self)


class JacobianHandle(_Address, _api.MienJacobian):
    kept: Any  # rig and deformer, whose arrays may be in memory of Python

    def __del__(self, destroy: Any = lib.mien_jacobian_destroy) -> None:
        if self.value:
            destroy(self)


class FitHandle(_Address, _api.MienFit):
    kept: Any  # rig and deformer

    def __del__(self, library: Any = solver) -> None:
        if self.value:
            library().mien_fit_destroy(self)


class FitSurfaceHandle(_Address, _api.MienFitSurface):
    def __del__(self, library: Any = solver) -> None:
        if self.value:
            library().mien_fit_surface_destroy(self)


class DeformerHandle(_Address, _api.MienDeformer):
    baked: Optional[BakedHandle] = None  # where its arrays are

    def __del__(self, destroy: Any = lib.mien_deformer_destroy) -> None:
        if self.value:
            destroy(self)


class PoseHandle(_Address, _api.MienDeformerInstance):
    baked: Optional[BakedHandle]  # of the deformer, whose arrays may be in memory of Python

    def __del__(self, destroy: Any = lib.mien_deformer_instance_destroy) -> None:
        if self.value:
            destroy(self)


class InstanceHandle(_Address, _api.MienInstance):
    slab: Any  # where its memory is, for characters of a batch
    baked: Optional[BakedHandle]  # of the rig, whose arrays may be in memory of Python

    def __del__(self, destroy: Any = lib.mien_instance_destroy) -> None:
        if self.value:
            destroy(self)


class Closable(_Address):
    """close(), `with`, and the error for using a closed object."""

    __slots__ = ("_handle", "__weakref__")
    _handle: Any

    def close(self) -> None:
        """Gives up the memory as soon as no array looks into it any more. May be called twice."""
        self._handle = None

    @property
    def closed(self) -> bool:
        """Whether close() was called."""
        return self._handle is None

    def _open(self) -> Any:
        """The handle, if it is still there."""
        handle = self._handle
        if handle is None:
            raise ClosedError(f"this {type(self).__name__} is closed", Status.HANDLE)
        return handle

    def __enter__(self: Self) -> Self:
        self._open()
        return self

    def __exit__(self, *exception: Any) -> None:
        self.close()


_CODES: Dict[str, Any] = {"f": ctypes.c_float, "H": ctypes.c_uint16, "I": ctypes.c_uint32}


def array_over(owner: Any, address: Optional[int], count: int, code: str, writable: bool,
               shape: Optional[Tuple[int, ...]] = None) -> Any:
    """A NumPy array (or, without NumPy, a flat memoryview) over memory that `owner` keeps alive."""
    kind = _CODES[code] * count
    buffer = kind.from_address(address) if count else kind()
    buffer.owner = owner
    view = memoryview(buffer).cast("B")
    if not writable:
        view = view.toreadonly()
    if numpy is None:
        return view.cast(code)
    # frombuffer() keeps the read-only view for its base, so the array cannot be made writable.
    values = numpy.frombuffer(view, code) if count else empty((0,), code, writable)
    return values if shape is None else values.reshape(shape)


def empty(shape: Tuple[int, ...], code: str, writable: bool) -> Any:
    """An array of no elements, which NumPy does not make of a buffer."""
    return numpy.empty(shape, code) if writable else \
        numpy.frombuffer(bytes(8), code)[:0].reshape(shape)


def new_array(code: str, count: int) -> Tuple[Any, int]:
    """An array of Python's own, and its address."""
    if numpy is not None:
        values = numpy.empty(count, code)
        return values, values.ctypes.data
    values = array(code, bytes(array(code).itemsize * count))
    return values, values.buffer_info()[0]


def shaped(values: Any, shape: Tuple[int, ...]) -> Any:
    """A NumPy array of this shape; of what is not one, itself."""
    return values.reshape(shape) if numpy is not None else values


def floats_of(values: Any, what: str,
              table: Tuple[Optional[int], ...] = ()) -> Tuple[Any, int, Optional[int]]:
    """Numbers of any type and stride as floats in a row: what holds them, their count and address.
    They are a row, or a table of this shape. None is no numbers at all."""
    if values is None:
        return None, 0, None
    if numpy is None:
        held = array("f", values)
        return held, len(held), held.buffer_info()[0]
    given = numpy.asarray(values)
    if given.dtype.kind not in "fiub":
        raise TypeError(f"{what} takes numbers, not {given.dtype}")
    fits = len(table) == given.ndim and all(b in (None, a) for a, b in zip(given.shape, table))
    if given.ndim != 1 and not fits:
        raise ArgumentError(f"{what} takes shape {table} or (n,), not {given.shape}" if table else
                            f"{what} takes shape (n,), not {given.shape}")
    given = numpy.ascontiguousarray(given, "f")
    return given, given.size, given.ctypes.data


def assign(target: Any, values: Any, what: str) -> None:
    """target[...] = values, if they are numbers of the same shape or one number."""
    if numpy is None:
        if isinstance(values, (int, float)):
            values = [values] * len(target)
        values = array("f", values)
        if len(values) != len(target):
            raise ArgumentError(f"{what} takes {len(target)} values, not {len(values)}")
        target[:] = memoryview(values)
        return
    given = numpy.asarray(values)
    if given.dtype.kind not in "fiub":
        raise TypeError(f"{what} takes numbers, not {given.dtype}")
    if given.ndim and given.shape not in (target.shape, target.shape[1:]):
        raise ArgumentError(f"{what} takes shape {target.shape} or one number, not shape "
                            f"{given.shape}")
    target[...] = given


def as_path(path: Any) -> bytes:
    """A path for the library."""
    return terminated(os.fsencode(path), "a path")


def terminated(text: bytes, what: str) -> bytes:
    """Text that C will see all of."""
    if b"\0" in text:
        raise ArgumentError(f"{what} with a zero byte in it")
    return text


def as_bytes(data: Any) -> bytes:
    """Immutable bytes: the object itself, or a copy of a mutable buffer."""
    return data if type(data) is bytes else bytes(memoryview(data))


class FileStream:
    """A binary file object, seekable, as the library reads it. What the file raises comes out of
    `check`, once the call that read is over."""

    def __init__(self, file: Any) -> None:
        self._file = file
        self._raised: Optional[BaseException] = None
        kind: Any = dict(_api.MienStream._fields_)["read"]
        start = index(file.tell())
        self._start = start
        size = index(file.seek(0, os.SEEK_END)) - start
        if not 0 <= size < 1 << 63:  # ctypes would take it modulo 2**64
            raise ArgumentError(f"the file object begins at {start} and has {size} bytes after that")
        self.stream = _api.MienStream(size=size, read=kind(self._read))

    def _read(self, _user: Any, offset: int, buffer: int, size: int) -> int:
        try:
            self._file.seek(self._start + offset)
            done = 0
            while done < size:  # raw files may give less than they are asked for
                # Of what a file object returns nothing is certain: neither its type nor its length.
                part = memoryview(self._file.read(size - done)).tobytes()
                if len(part) > size - done:
                    raise ArgumentError(f"read({size - done}) of {type(self._file).__name__} returned "
                                        f"{len(part)} bytes")
                if not part:
                    break
                ctypes.memmove(buffer + done, part, len(part))
                done += len(part)
            return done
        except BaseException as raised:  # must not cross the library
            self._raised = raised
            return 0

    def check(self) -> None:
        """Raises what the file raised."""
        if self._raised is not None:
            raise self._raised


def lod_bits(lods: Optional[Iterable[int]]) -> int:
    """LOD numbers as bits; None, for all, is 0."""
    if lods is None:
        return 0
    bits = 0
    for lod in lods:
        if not 0 <= lod < 64:
            raise ArgumentError(f"LOD {lod}: LODs are numbered 0 ... 63")
        bits |= 1 << lod
    if not bits:
        raise ArgumentError("lods is empty: name at least one, or give None for all")
    return bits


def uint32(value: Any, what: str) -> int:
    """A number for the library; ctypes would cut it to 32 bits silently."""
    number = index(value)
    if not 0 <= number < 1 << 32:
        raise OutOfRangeError(f"{what} {number}: not in 0 ... 2**32 - 1", Status.INDEX)
    return number
