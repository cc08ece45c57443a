# SPDX-License-Identifier: MIT
"""Rigs: a DNA file packed for evaluation, shared by any number of characters and threads."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Callable, Dict, List, Optional

from . import _api
from ._api import (FileAccess, BakedCheck, Isa, Kind, MienError, MlMasks, Reuse, RigInfo,
                   RigStatistics, RotationOutput, Status, Storage)
from ._library import lib
from ._memory import (Closable, Floats, Indices, RigHandle, array_over, as_bytes, as_path,
                      uint32)
from .dna import Dna
from .errors import UnknownNameError, fail

if TYPE_CHECKING:
    from .batch import Batch
    from .instance import Instance

_byref = ctypes.byref


def isa_available(isa: int) -> bool:
    """Whether rigs can be made for an `Isa` here."""
    return bool(lib.mien_isa_available(uint32(isa, "isa")))


def isa_name(isa: int) -> str:
    """"avx2" for Isa.AVX2."""
    return str(lib.mien_isa_name(uint32(isa, "isa")).decode())


class Rig(Closable):
    """A rig made of a `Dna`. Immutable: any number of threads may use it at the same time.

        rig = mien.Rig(dna)
        face = rig.instance()

    isa:      `Isa`; one that is absent raises, never is another taken silently
    rotation: `RotationOutput.EULER` gives 9 values per joint, `RotationOutput.QUATERNION` 10
    ml_masks: whether masks switch or blend what was learned, see `MlMasks`
    reuse:    `Reuse.NOTHING` computes all of it each time, even if no input changed: for measuring
    storage:  `Storage.BIT_16` halves the memory of the large arrays, at three decimal digits
    """

    __slots__ = ("info", "lod_count", "_names", "_raw_controls")

    def __init__(self, dna: Dna, isa: int = Isa.BEST, rotation: int = RotationOutput.EULER,
                 ml_masks: int = MlMasks.SWITCH, storage: int = Storage.BIT_32,
                 reuse: int = Reuse.UNCHANGED) -> None:
        desc = _api.MienRigDesc(isa=uint32(isa, "isa"),
                                rotation_output=uint32(rotation, "rotation"),
                                ml_masks=uint32(ml_masks, "ml_masks"),
                                storage=uint32(storage, "storage"), reuse=uint32(reuse, "reuse"))
        if not isinstance(dna, Dna):
            raise TypeError(f"Rig takes a Dna, not {type(dna).__name__}: Rig(Dna.open(path)), or "
                            "Rig.open(path) for a baked file")
        handle, error = RigHandle(), MienError()
        status = lib.mien_rig_create(dna._open(), _byref(desc), _byref(handle), _byref(error))
        if status:
            fail(status, "cannot make a rig", error)
        self._take(handle)

    @classmethod
    def open(cls, path: Any, isa: int = Isa.BEST, access: int = FileAccess.READ,
             check: int = BakedCheck.SAFE, reuse: int = Reuse.UNCHANGED) -> Rig:
        """Opens a baked rig: a file that `save` or `mien bake` wrote.

        access: `FileAccess.MAP` shares the file's pages with other processes and reads what is
                needed; but a process crashes whose mapped file somebody truncates, so the default
                reads it all
        check:  `BakedCheck.FULL` also finds changed numbers
        """
        desc = cls._image_desc(isa, access, check, reuse)
        handle, error = RigHandle(), MienError()
        status = lib.mien_rig_open_file(as_path(path), _byref(desc), _byref(handle), _byref(error))
        if status:
            fail(status, f"cannot open {path}", error, path)
        return cls._of(handle)

    @classmethod
    def from_bytes(cls, data: Any, isa: int = Isa.BEST, check: int = BakedCheck.SAFE,
                   reuse: int = Reuse.UNCHANGED) -> Rig:
        """The same from memory, which is kept alive."""
        data = as_bytes(data)
        desc = cls._image_desc(isa, FileAccess.READ, check, reuse)
        handle, error = RigHandle(), MienError()
        status = lib.mien_rig_open_memory(data, len(data), _byref(desc), _byref(handle),
                                          _byref(error))
        if status:
            fail(status, "cannot open the bytes", error)
        handle.image = data  # whatever evaluates has the handle
        return cls._of(handle)

    @staticmethod
    def _image_desc(isa: int, access: int, check: int, reuse: int) -> Any:
        return _api.MienBakedDesc(isa=uint32(isa, "isa"), file_access=uint32(access, "access"),
                                     check=uint32(check, "check"), reuse=uint32(reuse, "reuse"))

    @classmethod
    def _of(cls, handle: RigHandle) -> Rig:
        rig = cls.__new__(cls)
        rig._take(handle)
        return rig

    def save(self, path: Any) -> None:
        """Bakes the rig into a file that `open` uses as it is; a failure leaves `path` as it
        was."""
        error = MienError()
        status = lib.mien_rig_save_file(self._open(), as_path(path), _byref(error))
        if status:
            fail(status, f"cannot write {path}", error, path)

    def to_bytes(self) -> bytes:
        """The same to memory."""
        handle = self._open()
        size, error = ctypes.c_size_t(), MienError()
        status = lib.mien_rig_save_memory(handle, None, 0, _byref(size), _byref(error))
        if not status:
            buffer = ctypes.create_string_buffer(size.value)
            status = lib.mien_rig_save_memory(handle, buffer, size.value, _byref(size),
                                              _byref(error))
        if status:
            fail(status, "cannot write", error)
        return buffer.raw

    def _take(self, handle: RigHandle) -> None:
        self._handle = handle
        info = _api.MienRigInfo()
        status = lib.mien_rig_info(handle, _byref(info))
        if status:
            fail(status, "no info")
        self.info: RigInfo = RigInfo._of(info)
        self.lod_count: int = info.lod_count
        self._names: Dict[int, List[str]] = {}
        self._raw_controls: Dict[str, int] = {}

    # ---- characters ----------------------------------------------------------------------------

    def instance(self) -> Instance:
        """A new character in its initial state."""
        from .instance import Instance
        return Instance(self)

    def batch(self, count: int, tasks: int = 1) -> Batch:
        """`count` new characters whose values are the rows of common arrays."""
        from .batch import Batch
        return Batch(self, count, tasks)

    # ---- names and numbers ---------------------------------------------------------------------

    def count(self, kind: int) -> int:
        """How many things of a `Kind` there are."""
        found = ctypes.c_uint32()
        status = lib.mien_rig_count(self._open(), uint32(kind, "kind"), _byref(found))
        if status:
            fail(status, f"kind {kind}")
        return found.value

    def name(self, kind: int, index: int) -> str:
        """Name of a thing; "" for kinds without names."""
        view = _api.MienStringView()
        status = lib.mien_rig_name(self._open(), uint32(kind, "kind"), uint32(index, "index"),
                                   _byref(view))
        if status:
            fail(status, f"name {index} of kind {kind}")
        return _api.text(view)

    def names(self, kind: int) -> List[str]:
        """All names of a `Kind`, by index."""
        self._open()
        if kind not in self._names:
            self._names[kind] = [self.name(kind, i) for i in range(self.count(kind))]
        return list(self._names[kind])

    def find(self, kind: int, name: str) -> int:
        """Index of the thing of a `Kind` with exactly this name, or UnknownNameError."""
        encoded = name.encode("utf-8", "surrogateescape")
        found = ctypes.c_uint32()
        status = lib.mien_rig_find_n(self._open(), uint32(kind, "kind"), encoded, len(encoded),
                                     _byref(found))
        if status == Status.NAME:
            raise UnknownNameError(f"the rig has no {_kind_name(kind)} {name!r}", status)
        if status:
            fail(status, f"{name!r} of kind {kind}")
        return found.value

    def raw_control(self, name: str) -> int:
        """Index of a raw control: `find` with a memory."""
        found = self._raw_controls.get(name)
        if found is None:
            found = self._raw_controls[name] = self.find(Kind.RAW_CONTROL, name)
        return found

    # ---- lists; NumPy arrays over the rig's memory, read-only -----------------------------------

    def _view(self, call: Callable[..., int], view: Any, code: str, what: str,
              *arguments: int) -> Any:
        handle = self._open()
        status = call(handle, *arguments, _byref(view))
        if status:
            fail(status, what)
        return array_over(handle, view.data, view.count, code, False)

    def lod_indices(self, kind: int, lod: int) -> Indices:
        """uint16 (n,): which joints, channels, maps, meshes or RBF solvers exist at a LOD."""
        return self._view(lib.mien_rig_lod_indices, _api.MienIndex16View(), "H",
                          f"kind {kind} at LOD {lod}", uint32(kind, "kind"), uint32(lod, "lod"))

    def variable_joint_values(self, lod: int) -> Indices:
        """uint16 (n,): indices into the flat joint outputs that evaluation may change at a LOD."""
        return self._view(lib.mien_rig_variable_joint_values, _api.MienIndex16View(), "H",
                          f"LOD {lod}", uint32(lod, "lod"))

    @property
    def joint_parents(self) -> Indices:
        """uint16 (joints,): parent of each joint; a root is its own parent."""
        return self._view(lib.mien_rig_joint_parents, _api.MienIndex16View(), "H", "joint parents")

    @property
    def neutral_joint_values(self) -> Floats:
        """float32 (joints, 9 or 10): neutral pose relative to the parent, in the layout and units
        of `Instance.joints`; scale is 1."""
        values = self._view(lib.mien_rig_neutral_joint_values, _api.MienFloatView(), "f",
                            "neutral pose")
        return values.reshape(-1, self.joint_width) if hasattr(values, "reshape") else values

    def psd_inputs(self, psd: int) -> Indices:
        """uint16 (n,): the controls whose product drives a corrective, as indices into the whole
        control row."""
        return self._view(lib.mien_rig_psd_inputs, _api.MienIndex16View(), "H", f"corrective {psd}",
                          uint32(psd, "psd"))

    @property
    def initial_raw_controls(self) -> Floats:
        """float32 (raw controls,): what each starts with: 0, or 1 for the w of a quaternion."""
        return self._view(lib.mien_rig_initial_raw_controls, _api.MienFloatView(), "f",
                          "initial controls")

    @property
    def joint_width(self) -> int:
        """Values per joint: 9, or 10 with quaternions; see `Instance.joints`."""
        return 10 if self.info.rotation_output == RotationOutput.QUATERNION else 9

    def statistics(self, lod: int) -> RigStatistics:
        """What one evaluation at a LOD works through."""
        found = _api.MienRigStatistics()
        status = lib.mien_rig_statistics(self._open(), uint32(lod, "lod"), _byref(found))
        if status:
            fail(status, f"LOD {lod}")
        return RigStatistics._of(found)

    def __repr__(self) -> str:
        if self.closed:
            return "<mien.Rig, closed>"
        return (f"<mien.Rig: {self.count(Kind.RAW_CONTROL)} raw controls, "
                f"{self.count(Kind.JOINT)} joints, {self.lod_count} LODs, "
                f"{isa_name(self.info.isa)}>")


def _kind_name(kind: int) -> str:
    return _api._enum(Kind, kind).name.lower().replace("_", " ") if kind in list(Kind) \
        else f"thing of kind {kind}"
