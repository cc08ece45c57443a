# SPDX-License-Identifier: MIT
"""Rigs: a DNA file packed for evaluation, shared by any number of characters and threads."""
from __future__ import annotations

import ctypes
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Iterator, List, Optional, Tuple
from weakref import WeakKeyDictionary

from . import _api, _baked
from ._api import (Arithmetic, BakedCheck, FileAccess, Isa, MienError, MlMasks, Point, Reuse,
                   RotationOutput, Storage)
from ._library import lib
from ._memory import Closable, Floats, RigHandle, uint32
from .batch import Batch
from .dna import Dna
from .errors import fail, raises
from .instance import Instance
from .rig_view import RigView

if TYPE_CHECKING:
    from .deformer import Deformer
    from .derivatives import Derivatives

_byref = ctypes.byref


class Rig(RigView):
    """A rig made from a `Dna`. Immutable: any number of threads may use it at the same time.

        rig = mien.Rig(dna)
        face = rig.instance()

    isa:      `Isa`; one that is absent raises, never is another taken silently
    rotation: `RotationOutput.EULER` gives 9 values per joint, `RotationOutput.QUATERNION` 10
    ml_masks: whether masks switch or blend what was learned, see `MlMasks`
    reuse:    `Reuse.NOTHING` computes all of it each time, even if no input changed: for measuring;
              `Reuse.SUMS` makes frames in which few controls change cheap, within a stated error
    arithmetic: `Arithmetic.PORTABLE` gives the same bits on every instruction set
    storage:  `Storage.BIT_16` halves the memory of the large arrays, at three decimal digits
    """

    # What jvp() and vjp() keep, by deformer; without one, by the rig itself.
    __slots__ = ("_idle",)
    _idle: WeakKeyDictionary[Closable, List[Tuple[Instance, Derivatives]]]

    @raises("mien_rig_create")
    def __init__(self, dna: Dna, isa: int = Isa.BEST, rotation: int = RotationOutput.EULER,
                 ml_masks: int = MlMasks.SWITCH, storage: int = Storage.BIT_32,
                 reuse: int = Reuse.UNCHANGED, arithmetic: int = Arithmetic.FAST) -> None:
        desc = _api.MienRigDesc(isa=uint32(isa, "isa"),
                                rotation_output=uint32(rotation, "rotation"),
                                ml_masks=uint32(ml_masks, "ml_masks"),
                                storage=uint32(storage, "storage"), reuse=uint32(reuse, "reuse"),
                                arithmetic=uint32(arithmetic, "arithmetic"))
        if not isinstance(dna, Dna):
            raise TypeError(f"Rig takes a Dna, not {type(dna).__name__}: Rig(Dna.open(path)), or "
                            "Rig.open(path) for a baked file")
        handle, error = RigHandle(), MienError()
        status = lib.mien_rig_create(dna._open(), _byref(desc), _byref(handle), _byref(error))
        if status:
            fail(status, "cannot make a rig", error)
        self._take(handle)

    @classmethod
    @raises("mien_baked_open_file", "mien_rig_from_baked")
    def open(cls, path: Any, isa: int = Isa.BEST, access: int = FileAccess.READ,
             check: int = BakedCheck.SAFE, reuse: int = Reuse.UNCHANGED) -> Rig:
        """Opens the rig of a baked file, which `bake` or `mien bake` wrote. `Baked` also gives its
        deformer.

        access: `FileAccess.MAP` shares the file's pages with other processes and reads what is
                needed. If a mapped file is truncated while it is open, the process may crash, so
                the default reads it all
        check:  `BakedCheck.FULL` also finds changed numbers
        """
        return cls._of(_baked.rig_of(_baked.open_file(path, access, check), isa, reuse))

    @classmethod
    @raises("mien_baked_open_memory", "mien_rig_from_baked")
    def from_bytes(cls, data: Any, isa: int = Isa.BEST, check: int = BakedCheck.SAFE,
                   reuse: int = Reuse.UNCHANGED) -> Rig:
        """The same from memory, which is kept alive."""
        return cls._of(_baked.rig_of(_baked.open_bytes(data, check), isa, reuse))

    @classmethod
    def _of(cls, handle: RigHandle) -> Rig:
        rig = cls.__new__(cls)
        rig._take(handle)
        return rig

    def _take(self, handle: RigHandle) -> None:
        self._idle = WeakKeyDictionary()
        super()._take(handle)

    @raises("mien_bake_file")
    def bake(self, path: Any, deformer: Optional[Closable] = None) -> None:
        """Writes a baked file, with a `Deformer` of this rig if there is one; a failure leaves
        `path` as it was."""
        _baked.bake(path, self._open(), deformer and deformer._open())

    @raises("mien_bake_memory")
    def to_bytes(self, deformer: Optional[Closable] = None) -> bytes:
        """The same to memory."""
        return _baked.baked_bytes(self._open(), deformer and deformer._open())

    # Pickled and copied as its baked bytes, which the other process or copy opens.

    def __reduce_ex__(self, protocol: Any) -> Tuple[Any, ...]:
        return Rig.from_bytes, (self.to_bytes(), self.info.isa)

    def __copy__(self) -> Rig:
        return self  # immutable

    def __deepcopy__(self, memo: Any) -> Rig:
        return self

    # ---- derivatives ---------------------------------------------------------------------------

    def jvp(self, raw: Any, directions: Any, deformer: Optional[Deformer] = None, to: int = Point.JOINTS,
            mesh: int = 0, lod: int = 0) -> Floats:
        """How the numbers at `to` change along directions of raw controls, at the pose of the raw controls `raw`
        (docs/derivatives.md). Needs NumPy.

        raw:        (raw controls,)
        directions: (raw controls,), or rows of them: (count, raw controls)
        deformer:   of this rig; needed for points from `Point.LOCALS` to `Point.POSITIONS`
        result:     float32 (n,) or (count, n); n is the size of the point, such as 9 times the joints for
                    `Point.JOINTS`, or 3 times the positions of `mesh` for `Point.POSITIONS`

        `Derivatives` differentiates an instance at its last evaluation, by other numbers too.
        """
        with self._linearized(raw, deformer, lod) as derivatives:
            return derivatives.jvp(directions, to=to, mesh=mesh)

    def vjp(self, raw: Any, gradients: Any, deformer: Optional[Deformer] = None, to: int = Point.JOINTS,
            mesh: int = 0, lod: int = 0) -> Floats:
        """The gradients by raw controls that follow from gradients by the numbers at `to`, at the pose of the raw
        controls `raw`: (n,) or rows of them, (count, n), become float32 (raw controls,) or (count, raw controls).
        All else is as for `jvp()`."""
        with self._linearized(raw, deformer, lod) as derivatives:
            return derivatives.vjp(gradients, to=to, mesh=mesh)

    @contextmanager
    def _linearized(self, raw: Any, deformer: Optional[Deformer], lod: int) -> Iterator[Derivatives]:
        """Derivatives at a pose. They are kept for the next call, those of several threads each."""
        from .derivatives import Derivatives
        self._open()
        if deformer is not None:
            deformer._open()
        idle = self._idle.setdefault(self if deformer is None else deformer, [])
        try:
            face, derivatives = idle.pop()
        except IndexError:
            face, derivatives = self.instance(), Derivatives(self, deformer)
        face.raw_controls = raw
        face.evaluate(lod)
        derivatives.linearize(face)
        yield derivatives
        idle.append((face, derivatives))

    def close(self) -> None:
        """Gives up the memory as soon as nothing made of the rig is in use any more. May be called twice."""
        self._idle.clear()
        super().close()

    # ---- characters ----------------------------------------------------------------------------

    def instance(self) -> Instance:
        """A new character in its initial state."""
        return Instance(self)

    def batch(self, count: int, tasks: int = 1) -> Batch:
        """`count` new characters whose values are the rows of common arrays."""
        return Batch(self, count, tasks)
