# SPDX-License-Identifier: MIT
"""The properties of a rig: names, counts, lists. `Rig` adds how rigs are made and used."""
from __future__ import annotations

import ctypes
from typing import Any, Callable, Dict, List, Tuple

from . import _api
from ._api import Kind, NameMatch, RigInfo, RigStatistics, RotationOutput, Status
from ._library import lib
from ._memory import Closable, Floats, Indices, RigHandle, array_over, uint32
from .errors import UnknownNameError, fail, raises

_byref = ctypes.byref


def isa_available(isa: int) -> bool:
    """Whether rigs can be made for an `Isa` here."""
    return bool(lib.mien_isa_available(uint32(isa, "isa")))


def isa_name(isa: int) -> str:
    """"avx2" for Isa.AVX2."""
    return str(lib.mien_isa_name(uint32(isa, "isa")).decode())


@raises("mien_control_name")
def control_name(name: str) -> str:
    """The usual name of a control: "mouthSmileLeft" for "AU12_L". UnknownNameError if Mien knows none."""
    encoded = name.encode("utf-8", "surrogateescape")
    out, count = ctypes.create_string_buffer(256), ctypes.c_size_t()
    status = lib.mien_control_name(encoded, len(encoded), out, len(out), _byref(count))
    if status == Status.NAME:
        raise UnknownNameError(f"{name!r} is not in the table of names", status)
    if status:
        fail(status, repr(name))
    return out.raw[:count.value].decode()


class RigView(Closable):
    """Names, counts and lists of a rig. Immutable: any number of threads may use it."""

    __slots__ = ("info", "lod_count", "_names", "_raw_controls")

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

    # ---- names and numbers ---------------------------------------------------------------------

    def count(self, kind: int) -> int:
        """The number of parts of a `Kind`."""
        found = ctypes.c_uint32()
        status = lib.mien_rig_count(self._open(), uint32(kind, "kind"), _byref(found))
        if status:
            fail(status, f"kind {kind}")
        return found.value

    @raises("mien_rig_name")
    def name(self, kind: int, index: int) -> str:
        """Name of a part; "" for kinds without names."""
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

    @raises("mien_rig_find_n")
    def find(self, kind: int, name: str) -> int:
        """Index of the part of a `Kind` with exactly this name, or UnknownNameError."""
        encoded = name.encode("utf-8", "surrogateescape")
        found = ctypes.c_uint32()
        status = lib.mien_rig_find_n(self._open(), uint32(kind, "kind"), encoded, len(encoded),
                                     _byref(found))
        if status == Status.NAME:
            raise UnknownNameError(f"the rig has no {_kind_name(kind)} {name!r}", status)
        if status:
            fail(status, f"{name!r} of kind {kind}")
        return found.value

    @raises("mien_rig_match")
    def match(self, name: str) -> Tuple[NameMatch, Dict[int, float]]:
        """What a name of another tool means on this rig: how it was matched, and raw controls with their
        weights. "AU12" is both smiles. UnknownNameError if it means nothing."""
        encoded = name.encode("utf-8", "surrogateescape")
        shares = (_api.MienControlShare * _api.MIEN_MOST_SHARES)()
        count, how = ctypes.c_size_t(), ctypes.c_uint32()
        status = lib.mien_rig_match(self._open(), encoded, len(encoded), shares, len(shares),
                                    _byref(count), _byref(how))
        if status == Status.NAME:
            raise UnknownNameError(f"{name!r} means no raw control of the rig", status)
        if status:
            fail(status, repr(name))
        return NameMatch(how.value), {s.control: s.weight for s in shares[:count.value]}

    def raw_control(self, name: str) -> int:
        """Index of a raw control, cached."""
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

    @raises("mien_rig_lod_indices")
    def lod_indices(self, kind: int, lod: int) -> Indices:
        """uint16 (n,): which joints, channels, maps, meshes or RBF solvers exist at a LOD."""
        return self._view(lib.mien_rig_lod_indices, _api.MienIndex16View(), "H",
                          f"kind {kind} at LOD {lod}", uint32(kind, "kind"), uint32(lod, "lod"))

    @raises("mien_rig_variable_joint_values")
    def variable_joint_values(self, lod: int) -> Indices:
        """uint16 (n,): indices into the flat joint values that evaluation may change at a LOD."""
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

    @raises("mien_rig_psd_inputs")
    def psd_inputs(self, psd: int) -> Indices:
        """uint16 (n,): the controls whose product drives a corrective, as indices into the whole
        control vector."""
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

    @raises("mien_rig_statistics")
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
