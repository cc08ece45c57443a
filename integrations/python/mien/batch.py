# SPDX-License-Identifier: MIT
"""Many characters of one rig, whose values are the rows of common arrays."""
from __future__ import annotations

import ctypes
from _thread import allocate_lock
from concurrent.futures import Executor
from operator import index
from typing import Any, Dict, Iterator, Optional, Sequence, Union

from . import _api
from ._api import MienError, Stage, Status
from ._library import lib
from ._memory import BatchHandle, Closable, Floats, assign, empty, numpy, uint32
from ._threads import call_with_threads
from .errors import ArgumentError, BusyError, OutOfMemoryError, OutOfRangeError, fail, raises
from .instance import Instance
from .rig_view import RigView

_evaluate_batch = lib.mien_rig_evaluate_batch
_ALIGNMENT = 64
_function: Dict[str, Any] = dict(_api.MienAllocator._fields_)


class _Slab:
    """One block of memory with a place for each character, at equal distances. Being the allocator
    of their instances, it lets NumPy see value i of all of them as a column with a stride.

    Each instance's handle keeps the slab, so the slab goes when the last of them is gone.
    """

    def __init__(self, size: int, count: int) -> None:
        self.stride = -(-size // _ALIGNMENT) * _ALIGNMENT
        if self.stride % 4096 == 0:
            self.stride += _ALIGNMENT  # else all rows would compete for the same cache lines
        self.size = self.stride * count
        self.memory = (ctypes.c_char * (self.size + _ALIGNMENT))()
        self.start = -(-ctypes.addressof(self.memory) // _ALIGNMENT) * _ALIGNMENT
        places = iter(range(self.start, self.start + self.size, self.stride))

        # These refer to the places, not to the slab, which would never go then.
        def allocate(user: Optional[int], size: int, alignment: int) -> Optional[int]:
            return next(places, None) if size <= stride and alignment <= _ALIGNMENT else None

        def release(user: Optional[int], block: Optional[int], size: int, alignment: int) -> None:
            """All places are released at once, with the slab."""

        stride = self.stride
        self.allocator = _api.MienAllocator(None, _function["allocate"](allocate),
                                            _function["release"](release))


class Batch(Closable):
    """`count` new characters of one rig, evaluated together.

        batch = rig.batch(64)
        jaw = rig.raw_control("CTRL_expressions.jawOpen")
        batch.raw_controls[:, jaw] = numpy.linspace(0, 1, 64)
        batch.evaluate(lod=0)
        batch.joints                 # float32 (64, joints, 9)

    Row i of each array is the memory of character `batch[i]`, an `Instance` like any other: nothing
    is copied, and evaluation fetches the rig's matrix once for many of them. Inputs are written in
    place or by assigning (a row for all, or one number, will do too); outputs cannot be written.
    Arrays and closing are as at `Instance`; the arrays need NumPy. A batch is for one thread
    at a time, with all of its characters: a second one gets a BusyError.

    tasks: in how many parts `evaluate(threads=...)` may work at once
    """

    __slots__ = ("rig", "_slab", "_lock", "_instances", "_batch", "_pointers", "_desc", "_lods",
                 "_views")

    @raises("mien_batch_create")
    def __init__(self, rig: RigView, count: int, tasks: int = 1) -> None:
        if not 0 <= count <= 1 << 20:
            raise ArgumentError(f"a batch of {count} characters; there may be 2**20")
        self.rig = rig
        try:
            self._slab = _Slab(rig.info.instance_bytes, count)
        except (MemoryError, OverflowError, ValueError):
            raise OutOfMemoryError(f"no memory for {count} instances of {rig.info.instance_bytes} "
                                   "bytes", Status.MEMORY) from None
        self._lock = allocate_lock()
        self._instances = tuple(Instance(rig, self._slab, self._lock) for _ in range(count))
        self._handle: Any = tuple(instance._open() for instance in self._instances)
        self._batch, error = BatchHandle(), MienError()
        self._desc = _api.MienBatchDesc(capacity=max(count, 1), tasks=uint32(tasks, "tasks"))
        status = lib.mien_batch_create(rig._open(), ctypes.byref(self._desc),
                                       ctypes.byref(self._batch), ctypes.byref(error))
        if status:
            fail(status, "cannot make a batch", error)
        self._pointers = (_api.MienInstance * count)(*self._handle)
        self._lods: Dict[int, Any] = {}
        self._views: Dict[str, Any] = {}

    def close(self) -> None:
        """Closes all characters; memory goes when no array looks into it. May be called twice."""
        self._handle = None
        self._views = {}
        for instance in self._instances:
            instance.close()

    def __len__(self) -> int:
        return len(self._instances)

    def __getitem__(self, i: Any) -> Any:
        """Character i, or those of a slice."""
        return self._instances[i]

    def __iter__(self) -> Iterator[Instance]:
        return iter(self._instances)

    # ---- arrays --------------------------------------------------------------------------------

    def _view(self, call: Any, writable: bool = False, width: int = 0) -> Any:
        found = self._views.get(call.__name__)
        if found is not None:
            return found
        handles = self._open()
        if numpy is None:
            raise ImportError("arrays over many characters need NumPy; batch[i] does without it")
        kind = _api.MienMutableFloatView if writable else _api.MienFloatView
        views = [kind() for _ in handles]
        for handle, view in zip(handles, views):
            status = call(handle, ctypes.byref(view))
            if status:
                fail(status, call.__name__)
        count = views[0].count if views else 0
        shape = (len(views), count // width, width) if width else (len(views), count)
        if not views or not count:
            found = empty(shape, "f", writable)
        else:
            slab = self._slab
            for i, view in enumerate(views):
                if view.count != count or view.data != views[0].data + i * slab.stride:
                    raise RuntimeError("instances of a rig are laid out differently")
            buffer: Any = (ctypes.c_char * slab.size).from_address(slab.start)
            buffer.owner = handles
            memory = memoryview(buffer).cast("B")
            rows = numpy.frombuffer(memory if writable else memory.toreadonly(), "B")
            found = numpy.ndarray(shape, "f", rows,
                                  views[0].data - slab.start,
                                  (slab.stride, width * 4, 4) if width else (slab.stride, 4))
        self._views[call.__name__] = found
        return found

    @property
    def gui_controls(self) -> Floats:
        """float32 (n, GUI controls), writable."""
        return self._view(lib.mien_instance_gui_controls, True)

    @gui_controls.setter
    def gui_controls(self, values: Any) -> None:
        assign(self.gui_controls, values, "gui_controls")

    @property
    def raw_controls(self) -> Floats:
        """float32 (n, raw controls), writable."""
        return self._view(lib.mien_instance_raw_controls, True)

    @raw_controls.setter
    def raw_controls(self, values: Any) -> None:
        assign(self.raw_controls, values, "raw_controls")

    @property
    def ml_masks(self) -> Floats:
        """float32 (n, regions), writable."""
        return self._view(lib.mien_instance_ml_masks, True)

    @ml_masks.setter
    def ml_masks(self, values: Any) -> None:
        assign(self.ml_masks, values, "ml_masks")

    @property
    def controls(self) -> Floats:
        """float32 (n, controls): raw, PSD, ML, RBF."""
        return self._view(lib.mien_instance_controls)

    @property
    def psd_controls(self) -> Floats:
        """float32 (n, correctives)."""
        return self._view(lib.mien_instance_psd_controls)

    @property
    def ml_controls(self) -> Floats:
        """float32 (n, ML controls): outputs of the neural networks."""
        return self._view(lib.mien_instance_ml_controls)

    @property
    def rbf_controls(self) -> Floats:
        """float32 (n, RBF controls): weights of the poses of the RBF solvers."""
        return self._view(lib.mien_instance_rbf_controls)

    @property
    def joints(self) -> Floats:
        """float32 (n, joints, 9 or 10): see `Instance.joints`."""
        return self._view(lib.mien_instance_joints, width=self.rig.joint_width)

    @property
    def blend_shapes(self) -> Floats:
        """float32 (n, channels)."""
        return self._view(lib.mien_instance_blend_shapes)

    @property
    def animated_maps(self) -> Floats:
        """float32 (n, maps)."""
        return self._view(lib.mien_instance_animated_maps)

    # ---- evaluation ----------------------------------------------------------------------------

    @raises("mien_rig_evaluate_batch", but=(Status.MISMATCH,))
    def evaluate(self, lod: Union[int, Sequence[int]] = 0, stages: int = Stage.ALL,
                 threads: Optional[Executor] = None) -> None:
        """Computes the outputs of all characters, at one LOD or at one for each, with the same bits as
        evaluating each alone. Other Python threads run meanwhile.

        stages:  as at `Instance.evaluate`
        threads: such as a ThreadPoolExecutor, for up to `tasks` parts at once; the same bits
        """
        if threads is not None:
            call_with_threads(threads, lambda parallel: self._evaluate(lod, stages, parallel))
        else:
            self._evaluate(lod, stages, None)

    def _evaluate(self, lod: Any, stages: int, parallel: Any) -> None:
        if not self._lock.acquire(False):
            raise BusyError("another thread is working with this batch", Status.HANDLE)
        try:
            handles = self._open()
            lods = self._lods.get(lod) if type(lod) is int else None
            if lods is None:
                lods = self._lods_of(lod)
            status = _evaluate_batch(self.rig._handle, self._batch, self._pointers, lods,
                                     len(handles), uint32(stages, "stages"), parallel)
            if status:
                self.rig._open()
                fail(status, f"evaluate(lod={lod}, stages={stages!r})")
        finally:
            self._lock.release()

    @property
    def scratch_bytes(self) -> int:
        """Memory that evaluating together takes, besides that of the characters."""
        found = ctypes.c_uint64()
        status = lib.mien_batch_bytes(self.rig._open(), ctypes.byref(self._desc),
                                      ctypes.byref(found))
        if status:
            fail(status, "no size")
        return found.value

    def map_gui_to_raw(self) -> None:
        """`Instance.map_gui_to_raw` for all."""
        for instance in self._instances:
            instance.map_gui_to_raw()

    def reset(self) -> None:
        """All as after creation."""
        for instance in self._instances:
            instance.reset()

    def _lods_of(self, lod: Any) -> Any:
        """LODs as the library takes them; of one for all, remembered."""
        count, known = len(self._instances), self.rig.lod_count
        many = hasattr(lod, "__len__")
        numbers = [index(one) for one in lod] if many else [index(lod)] * count
        if len(numbers) != count:
            raise ArgumentError(f"{len(numbers)} LODs for {count} characters")
        for number in numbers:
            if not 0 <= number < known:
                raise OutOfRangeError(f"LOD {number} of a rig with {known}", Status.LOD)
        lods = (ctypes.c_uint32 * count)(*numbers)
        if type(lod) is int:
            self._lods[lod] = lods
        return lods

    def __repr__(self) -> str:
        return f"<mien.Batch{', closed' if self.closed else ''} of {len(self)}: {self.rig!r}>"
