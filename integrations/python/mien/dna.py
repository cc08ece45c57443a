# SPDX-License-Identifier: MIT
"""DNA files: opening, looking into them, writing, validating, generating."""
from __future__ import annotations

import ctypes
from typing import Any, Iterable, List, Optional, Union

from . import _api
from ._api import (CoordinateSystem, DnaField, DnaInfo, DnaLayer, FieldType, FileAccess, Finding,
                   Layer, MienError, Preset, UnknownLayers)
from ._library import author, lib
from ._memory import (Closable, DnaHandle, FileStream, ReportHandle, as_bytes, as_path, lod_bits,
                      new_array, terminated, uint32)
from .errors import fail, raises

_byref = ctypes.byref


@raises("mien_coordinate_system_find_n")
def coordinate_system(name: str) -> CoordinateSystem:
    """The system of an engine or tool, by its name: "unreal", "unity", "blender", ... Change what
    should differ by `._replace(rotation_rule=RotationRule.EXACT)`."""
    encoded, found = name.encode("utf-8", "surrogateescape"), _api.MienCoordinateSystem()
    status = lib.mien_coordinate_system_find_n(encoded, len(encoded), _byref(found))
    if status:
        fail(status, f"coordinate system {name!r}, not one of {coordinate_system_names()}")
    return CoordinateSystem._of(found)


def coordinate_system_names() -> List[str]:
    """The names that `coordinate_system` knows."""
    names: List[str] = []
    view = _api.MienStringView()
    while not lib.mien_coordinate_system_name(len(names), _byref(view)):
        names.append(_api.text(view))
    return names


def _dna_desc(layers: int, lods: Optional[Iterable[int]], unknown_layers: int, access: int,
              system: Union[None, str, CoordinateSystem], skip_blend_shape_targets: bool) -> Any:
    desc = _api.MienDnaDesc(layers=uint32(layers, "layers"), lods=lod_bits(lods),
                            skip_blend_shape_targets=bool(skip_blend_shape_targets),
                            unknown_layers=uint32(unknown_layers, "unknown_layers"),
                            file_access=uint32(access, "access"))
    if isinstance(system, str):
        system = coordinate_system(system)
    if system is not None:
        desc.system = ctypes.pointer(_api.MienCoordinateSystem(**system._asdict()))
    return desc


class Dna(Closable):
    """A checked, read-only view of a DNA file. Safe to use from any number of threads.

    Make one with `Dna.open`, `Dna.from_bytes` or `Dna.generate`; close it with `close()` or `with`.
    A `Rig` keeps its own copy of what it needs, so the DNA may be closed once the rig is made.
    """

    __slots__ = ()

    def __init__(self, handle: DnaHandle, keeps: Any = None) -> None:
        handle.keeps = keeps
        self._handle = handle

    @classmethod
    @raises("mien_dna_open_file")
    def open(cls, path: Any, layers: int = Layer.ALL, lods: Optional[Iterable[int]] = None,
             unknown_layers: int = UnknownLayers.KEEP, access: int = FileAccess.READ,
             system: Union[None, str, CoordinateSystem] = None,
             skip_blend_shape_targets: bool = False) -> Dna:
        """Opens a file of versions 2.1 to 2.8 and checks everything that is loaded.

        layers: which `Layer`s to load, combined with |; what is not chosen is never touched
        lods:   which LODs to keep, by number; they are renumbered from 0. None keeps all
        access: `FileAccess.MAP` does not read what is not chosen. If a mapped file is truncated while it is
                open, the process may crash, so the default reads it all
        system: to convert everything to: a name ("unreal", "blender", see
                `coordinate_system_names`) or a `CoordinateSystem`; None keeps the file's
        skip_blend_shape_targets: loads the geometry without them
        """
        desc = _dna_desc(layers, lods, unknown_layers, access, system, skip_blend_shape_targets)
        handle, error = DnaHandle(), MienError()
        status = lib.mien_dna_open_file(as_path(path), _byref(desc), _byref(handle), _byref(error))
        if status:
            fail(status, f"cannot open {path}", error, path)
        return cls(handle)

    @classmethod
    @raises("mien_dna_open_memory")
    def from_bytes(cls, data: Any, layers: int = Layer.ALL, lods: Optional[Iterable[int]] = None,
                   unknown_layers: int = UnknownLayers.KEEP,
                   system: Union[None, str, CoordinateSystem] = None,
                   skip_blend_shape_targets: bool = False) -> Dna:
        """The same from memory: `bytes` are used where they are and kept alive; any other buffer
        (bytearray, memoryview, array) is copied, since it could change."""
        data = as_bytes(data)
        desc = _dna_desc(layers, lods, unknown_layers, FileAccess.READ, system,
                         skip_blend_shape_targets)
        handle, error = DnaHandle(), MienError()
        status = lib.mien_dna_open_memory(data, len(data), _byref(desc), _byref(handle),
                                          _byref(error))
        if status:
            fail(status, "cannot open the bytes", error)
        return cls(handle, data)

    @classmethod
    @raises("mien_dna_open_stream")
    def from_stream(cls, file: Any, layers: int = Layer.ALL, lods: Optional[Iterable[int]] = None,
                    unknown_layers: int = UnknownLayers.KEEP,
                    system: Union[None, str, CoordinateSystem] = None,
                    skip_blend_shape_targets: bool = False) -> Dna:
        """The same from a binary file object that can seek, such as a member of an archive: reads
        the chosen layers alone. The file ends where the object does and begins where it stands."""
        stream = FileStream(file)
        desc = _dna_desc(layers, lods, unknown_layers, FileAccess.READ, system,
                         skip_blend_shape_targets)
        handle, error = DnaHandle(), MienError()
        status = lib.mien_dna_open_stream(_byref(stream.stream), _byref(desc), _byref(handle),
                                          _byref(error))
        stream.check()
        if status:
            fail(status, "cannot open the stream", error)
        return cls(handle)

    @classmethod
    @raises("mien_dna_generate")
    def generate(cls, preset: int = Preset.TINY, seed: int = 0, flags: int = 0) -> Dna:
        """A synthetic rig of a `Preset`, with what the `Generate` flags add; the same arguments give
        the same bytes anywhere."""
        desc = _api.MienGenerateDesc(preset=uint32(preset, "preset"), seed=seed,
                                     flags=uint32(flags, "flags"))
        handle, error = DnaHandle(), MienError()
        status = author().mien_dna_generate(_byref(desc), _byref(handle), _byref(error))
        if status:
            fail(status, "cannot generate", error)
        return cls(handle)

    # ---- looking into it -----------------------------------------------------------------------

    @property
    def info(self) -> DnaInfo:
        """Version, units, axes and counts."""
        found = _api.MienDnaInfo()
        status = lib.mien_dna_info(self._open(), _byref(found))
        if status:
            fail(status, "no info")
        return DnaInfo._of(found)

    @property
    def layers(self) -> List[DnaLayer]:
        """The file's table of layers, in file order. `layer` is 0 for kinds unknown to Mien."""
        handle, found = self._open(), []
        for i in range(self.info.layer_count):
            entry = _api.MienDnaLayer()
            status = lib.mien_dna_layer(handle, i, _byref(entry))
            if status:
                fail(status, f"no layer {i}")
            found.append(DnaLayer._of(entry))
        return found

    @staticmethod
    def _path(path: str) -> bytes:
        return terminated(path.encode("utf-8", "surrogateescape"), "a field path")

    def _field(self, handle: DnaHandle, path: bytes) -> Any:
        found, error = _api.MienDnaField(), MienError()
        status = lib.mien_dna_field(handle, path, _byref(found), _byref(error))
        if status:
            fail(status, "no such field", error)
        return found

    @raises("mien_dna_field")
    def field(self, path: str) -> DnaField:
        """What is at a path such as "bhvr.joints.jointGroups[7].values": type, count, offset.

        Raises UnknownNameError for a name, OutOfRangeError for an index that is not there.
        """
        return DnaField._of(self._field(self._open(), self._path(path)))

    @raises("mien_dna_child_name")
    def fields(self, path: str = "") -> List[str]:
        """Names of the fields of the record at a path; of the layers for ""."""
        return self._field_names(self._open(), self._path(path))

    def _field_names(self, handle: DnaHandle, path: bytes) -> List[str]:
        names, error = [], MienError()
        for i in range(self._field(handle, path).count):
            name = _api.MienStringView()
            status = lib.mien_dna_child_name(handle, path, i, _byref(name), _byref(error))
            if status:
                fail(status, "no field names", error)
            names.append(_api.text(name))
        return names

    @raises("mien_dna_field")
    def read(self, path: str) -> Any:
        """Copy of the field at a path, of every loaded layer, in native byte order:

            a string             str
            a number             int or float
            an array of numbers  array of float32 or int64 (array.array without NumPy)
            a list               list of these
            a record             dict of these
        """
        return self._read(self._open(), self._path(path))

    def _read(self, handle: DnaHandle, path: bytes) -> Any:
        field, error = self._field(handle, path), MienError()
        if field.type == FieldType.STRING:
            view = _api.MienStringView()
            status = lib.mien_dna_read_string(handle, path, _byref(view), _byref(error))
            if status:
                fail(status, "cannot read", error)
            return _api.text(view)
        if field.type == FieldType.RECORD:
            return {name: self._read(handle, (path + b"." if path else b"") + name.encode())
                    for name in self._field_names(handle, path)}
        if field.type == FieldType.LIST:
            return [self._read(handle, b"%b[%d]" % (path, i)) for i in range(field.count)]
        floats = field.type == FieldType.F32
        values, address = new_array("f" if floats else "q", field.count)
        read = lib.mien_dna_read_floats if floats else lib.mien_dna_read_integers
        status = read(handle, path, 0, field.count, address, _byref(error))
        if status:
            fail(status, "cannot read", error)
        if field.is_array:
            return values
        return float(values[0]) if floats else int(values[0])

    __getitem__ = read

    # ---- writing -------------------------------------------------------------------------------

    @staticmethod
    def _write_desc(version: int, unknown_layers: int) -> Any:
        return _byref(_api.MienWriteDesc(version=uint32(version, "version"),
                                         unknown_layers=uint32(unknown_layers, "unknown_layers")))

    @raises("mien_dna_write_file")
    def save(self, path: Any, version: int = 0, unknown_layers: int = UnknownLayers.KEEP) -> None:
        """Writes a canonical file; a failure leaves `path` as it was. `version` 1 ... 8 writes 2.1
        ... 2.8, 0 keeps the version."""
        error = MienError()
        status = lib.mien_dna_write_file(self._open(), as_path(path),
                                         self._write_desc(version, unknown_layers), _byref(error))
        if status:
            fail(status, f"cannot write {path}", error, path)

    @raises("mien_dna_write_memory")
    def to_bytes(self, version: int = 0, unknown_layers: int = UnknownLayers.KEEP) -> bytes:
        """The same to memory."""
        handle, desc = self._open(), self._write_desc(version, unknown_layers)
        size, error = ctypes.c_size_t(), MienError()
        status = lib.mien_dna_write_memory(handle, desc, None, 0, _byref(size), _byref(error))
        if not status:
            buffer = ctypes.create_string_buffer(size.value)
            status = lib.mien_dna_write_memory(handle, desc, buffer, size.value, _byref(size),
                                               _byref(error))
        if status:
            fail(status, "cannot write", error)
        return buffer.raw

    def __repr__(self) -> str:
        if self.closed:
            return "<mien.Dna, closed>"
        info = self.info
        return (f"<mien.Dna {info.generation}.{info.version}: "
                f"{info.raw_control_count} raw controls, {info.joint_count} joints, "
                f"{info.lod_count} LODs>")


@raises("mien_dna_validate_file")
def validate(file: Any) -> List[Finding]:
    """Every finding of a whole file, given by path or as bytes, in the order of the checks.

    An empty list is a file without fault; `severity` tells errors, which opening refuses, from
    warnings. Raises FileError if the file cannot be read at all.
    """
    handle, error = ReportHandle(), MienError()
    if isinstance(file, (bytes, bytearray, memoryview)):
        data = as_bytes(file)
        status = lib.mien_dna_validate_memory(data, len(data), None, _byref(handle), _byref(error))
    else:
        status = lib.mien_dna_validate_file(as_path(file), None, _byref(handle), _byref(error))
    if status:
        fail(status, "cannot validate", error)
    return findings_of(handle)


def findings_of(handle: ReportHandle) -> List[Finding]:
    """All of a report."""
    errors, warnings = ctypes.c_uint32(), ctypes.c_uint32()
    status = lib.mien_report_counts(handle, _byref(errors), _byref(warnings))
    if status:
        fail(status, "no counts")
    found = []
    for i in range(errors.value + warnings.value):
        finding = _api.MienFinding()
        status = lib.mien_report_finding(handle, i, _byref(finding))
        if status:
            fail(status, f"no finding {i}")
        found.append(Finding._of(finding))
    return found
