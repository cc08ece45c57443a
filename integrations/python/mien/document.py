# SPDX-License-Identifier: MIT
"""DNA files that can be changed."""
from __future__ import annotations

import array
import ctypes
from typing import Any, Iterable, List, NamedTuple, Optional, Sequence, Union

from . import _api
from ._api import (Conformed, CoordinateSystem, DnaField, FieldType, FileAccess, Finding, Kind, Match,
                   MienError, PrunedJoints, PrunedTargets, UnknownLayers)
from ._library import author
from ._memory import (Closable, DnaHandle, DocumentHandle, ReportHandle, as_path, floats_of,
                      lod_bits, new_array, numpy, shaped, terminated, uint32)
from .dna import Dna, coordinate_system, findings_of
from .errors import ArgumentError, fail, raises

_byref = ctypes.byref
Element = Union[str, int]  # by name, or by number

_NAMES = {
    Kind.GUI_CONTROL: "defn.guiControlNames", Kind.RAW_CONTROL: "defn.rawControlNames",
    Kind.JOINT: "defn.jointNames", Kind.BLEND_SHAPE_CHANNEL: "defn.blendShapeChannelNames",
    Kind.ANIMATED_MAP: "defn.animatedMapNames", Kind.MESH: "defn.meshNames",
}


class ControlError(NamedTuple):
    """What a raw control that both rigs have does differently after a transplant, at 1.

    worst: distance of a position at LOD 0, in the unit of the file
    moved: the farthest that the control moved a position before
    """

    control: str
    worst: float
    rms: float
    moved: float


class DocumentLayer(NamedTuple):
    """A layer of a document. content: its bytes, if its kind is not known."""

    code: str
    version_major: int
    version_minor: int
    content: bytes


def _text(path: str) -> bytes:
    return terminated(path.encode("utf-8", "surrogateescape"), "a field path or name")


class Document(Closable):
    """A DNA file that can be changed: fields by the paths of `Dna.read`, and as a whole by operations
    that keep together what refers to each other. A call that fails changes nothing. What is not
    changed stays as it was, byte for byte. For one thread at a time.

        with mien.Document.open("head.dna") as head:
            head.rename(mien.Kind.JOINT, "FACIAL_C_Jaw", "jaw")
            head.keep_lods(range(2, 8))
            head.save("phone.dna")

    Joints, meshes and channels are given by name or number. `mark` and `undo` go back to a state.
    """

    __slots__ = ()

    @raises("mien_document_create")
    def __init__(self, dna: Optional[Dna] = None) -> None:
        """A document of an open file, which may be closed afterwards; of None, an empty one."""
        handle, error = DocumentHandle(), MienError()
        desc = _api.MienDocumentDesc()
        status = author().mien_document_create(None if dna is None else dna._open(), _byref(desc),
                                               _byref(handle), _byref(error))
        if status:
            fail(status, "cannot edit", error)
        self._handle = handle

    @classmethod
    @raises("mien_document_open_file")
    def open(cls, path: Any, unknown_layers: int = UnknownLayers.KEEP,
             access: int = FileAccess.READ) -> Document:
        """A document of a whole file. `FileAccess.MAP` does not copy it to memory; a mapped file must not be
        truncated while the document is open."""
        handle, error = DocumentHandle(), MienError()
        desc = _api.MienDocumentDesc(file_access=uint32(access, "access"),
                                     unknown_layers=uint32(unknown_layers, "unknown_layers"))
        status = author().mien_document_open_file(as_path(path), _byref(desc), _byref(handle),
                                                  _byref(error))
        if status:
            fail(status, f"cannot open {path}", error, path)
        document = cls.__new__(cls)
        document._handle = handle
        return document

    def _call(self, function: str, *arguments: Any, what: str = "cannot edit") -> None:
        error = MienError()
        status = getattr(author(), function)(self._open(), *arguments, _byref(error))
        if status:
            fail(status, what, error)

    # ---- fields ------------------------------------------------------------------------------------

    @raises("mien_document_field")
    def field(self, path: str) -> DnaField:
        """Type and count of what is at a path, as `Dna.field`."""
        return DnaField._of(self._field(_text(path)))

    def _field(self, path: bytes) -> Any:
        found = _api.MienDnaField()
        self._call("mien_document_field", path, _byref(found), what="no such field")
        return found

    @raises("mien_document_child_name")
    def fields(self, path: str = "") -> List[str]:
        """Names of the fields of the record at a path; of the layers for ""."""
        names, encoded = [], _text(path)
        for i in range(self._field(encoded).count):
            name = _api.MienStringView()
            self._call("mien_document_child_name", encoded, i, _byref(name))
            names.append(_api.text(name))
        return names

    @raises("mien_document_read_floats", "mien_document_read_integers",
            "mien_document_read_string")
    def read(self, path: str) -> Any:
        """Copy of the field at a path, as `Dna.read`: str, number, array, list or dict."""
        encoded = _text(path)
        field = self._field(encoded)
        if field.type == FieldType.STRING:
            view = _api.MienStringView()
            self._call("mien_document_read_string", encoded, _byref(view))
            return _api.text(view)
        if field.type == FieldType.RECORD:
            return {name: self.read(f"{path}.{name}" if path else name)
                    for name in self.fields(path)}
        if field.type == FieldType.LIST:
            return [self.read(f"{path}[{i}]") for i in range(field.count)]
        floats = field.type == FieldType.F32
        values, address = new_array("f" if floats else "q", field.count)
        self._call("mien_document_read_floats" if floats else "mien_document_read_integers",
                   encoded, 0, field.count, address)
        if field.is_array:
            return values
        return float(values[0]) if floats else int(values[0])

    __getitem__ = read

    @raises("mien_document_bytes")
    def raw_bytes(self, path: str) -> bytes:
        """Copy of an array or string as it is in the file: big-endian."""
        view = _api.MienStringView()
        self._call("mien_document_bytes", _text(path), _byref(view))
        return ctypes.string_at(view.data, view.count) if view.count else b""

    @raises("mien_document_write_floats", "mien_document_write_integers",
            "mien_document_write_string")
    def write(self, path: str, value: Any) -> None:
        """Replaces the field at a path by what `read` gives for it: arrays and lists take the length
        of the value, of dicts the members that they have are written. All of it or, if something
        does not fit, nothing."""
        mark = self.mark()
        try:
            self._write(path, value)
        except BaseException:
            self.undo(mark)
            raise

    __setitem__ = write

    def _write(self, path: str, value: Any) -> None:
        encoded = _text(path)
        field = self._field(encoded)
        if field.type == FieldType.STRING:
            text = value.encode("utf-8", "surrogateescape")
            self._call("mien_document_write_string", encoded, text, len(text))
        elif field.type == FieldType.RECORD:
            for name, member in value.items():
                self._write(f"{path}.{name}" if path else name, member)
        elif field.type == FieldType.LIST:
            self.resize(path, len(value))
            # Names that move within the list must not meet each other on the way.
            if value and isinstance(value[0], str):
                self.resize(path, 0)
                self.resize(path, len(value))
            for i, element in enumerate(value):
                self._write(f"{path}[{i}]", element)
        else:
            self._write_numbers(path, encoded, field, value)

    def _write_numbers(self, path: str, encoded: bytes, field: Any, value: Any) -> None:
        values = value if field.is_array else [value]
        if field.type == FieldType.F32:
            held, count, address = floats_of(values, path)
            function = "mien_document_write_floats"
        else:
            held, address = new_array("q", len(values))
            count = len(values)
            given = _integers(values, path)
            held[:] = given if numpy is not None else array.array("q", given)
            function = "mien_document_write_integers"
        if count != field.count:
            if not field.is_array:
                raise ArgumentError(f"{path} is one number, not {count}")
            self.resize(path, count)
        self._call(function, encoded, 0, count, address)
        del held  # not before

    @raises("mien_document_resize")
    def resize(self, path: str, count: int) -> None:
        """Gives an array or list `count` elements: drops the last ones or adds zeros, empty strings
        or records of these."""
        self._call("mien_document_resize", _text(path), count)

    @raises("mien_document_splice")
    def splice(self, path: str, first: int, removed: int, inserted: int) -> None:
        """Replaces `removed` elements of an array or list by `inserted` new ones. What refers to
        elements by number stays as it is."""
        self._call("mien_document_splice", _text(path), first, removed, inserted)

    # ---- layers ------------------------------------------------------------------------------------

    @raises("mien_document_layer_count", "mien_document_layer")
    def layers(self) -> List[DocumentLayer]:
        """The list of layers, in the order of the file."""
        found = []
        for i in range(self._layer_count()[1]):
            layer, view = _api.MienDnaLayer(), _api.MienStringView()
            self._call("mien_document_layer", i, _byref(layer), _byref(view))
            content = ctypes.string_at(view.data, view.count) if view.count else b""
            found.append(DocumentLayer(layer.code.decode("latin-1"), layer.version_major,
                                       layer.version_minor, content))
        return found

    @property
    def version(self) -> int:
        """The document becomes a file of version 2.`version`."""
        return self._layer_count()[0]

    def _layer_count(self) -> Any:
        version, count = ctypes.c_uint32(), ctypes.c_uint32()
        self._call("mien_document_layer_count", _byref(version), _byref(count))
        return version.value, count.value

    @raises("mien_document_clear_layers")
    def clear_layers(self, version: Optional[int] = None) -> None:
        """Makes the document a file of version 2.`version` and its list of layers empty: those of
        unknown kinds are gone, fields stay."""
        self._call("mien_document_clear_layers",
                   self.version if version is None else uint32(version, "version"))

    @raises("mien_document_add_layer")
    def add_layer(self, code: str, version_major: int = 1, version_minor: int = 0,
                  content: bytes = b"") -> None:
        """Appends a layer to the list: of a known kind without content, or of another one with its
        bytes, which are written as they are."""
        self._call("mien_document_add_layer", _text(code), uint32(version_major, "version"),
                   uint32(version_minor, "version"), bytes(content), len(content))

    # ---- undoing -----------------------------------------------------------------------------------

    @raises("mien_document_mark")
    def mark(self) -> int:
        """Remembers the current state, for `undo`."""
        found = ctypes.c_uint64()
        self._call("mien_document_mark", _byref(found))
        return found.value

    @raises("mien_document_undo")
    def undo(self, mark: int = 0) -> None:
        """Goes back to the state at a mark; 0 is the state in which the document was made."""
        self._call("mien_document_undo", mark)

    # ---- operations --------------------------------------------------------------------------------

    def names(self, kind: Kind) -> List[str]:
        """Names of the GUI controls, raw controls, joints, channels, maps or meshes."""
        if kind not in _NAMES:
            raise ArgumentError(f"{kind!r} has no names in a document")
        found: List[str] = self.read(_NAMES[kind])
        return found

    @raises("mien_document_find")
    def find(self, kind: int, element: Element) -> int:
        """The number of an element, given by name; a number is itself."""
        if not isinstance(element, str):
            return uint32(element, "element")
        found = ctypes.c_uint32()
        self._call("mien_document_find", uint32(kind, "kind"), _text(element), _byref(found))
        return found.value

    def _mesh(self, mesh: Element) -> int:
        return self.find(Kind.MESH, mesh)

    @raises("mien_document_rename")
    def rename(self, kind: int, element: Element, name: str) -> None:
        """Gives an element of a kind another name."""
        self._call("mien_document_rename", uint32(kind, "kind"), self.find(kind, element),
                   _text(name))

    def _numbers(self, kind: int, elements: Union[Element, Iterable[Element]]) -> Any:
        given = [elements] if isinstance(elements, (str, int)) else list(elements)
        return (ctypes.c_uint32 * len(given))(*(self.find(kind, element) for element in given))

    @raises("mien_document_remove")
    def remove(self, kind: int, elements: Union[Element, Iterable[Element]]) -> None:
        """Removes controls, joints, blend shape channels, animated maps or meshes, and what refers
        to them: see mien_document_remove(). PSD controls are named "psd0", "psd1", ... Children and skin weights of joints go to the nearest ancestor that stays."""
        numbers = self._numbers(kind, elements)
        self._call("mien_document_remove", uint32(kind, "kind"), numbers, len(numbers))

    @raises("mien_document_clear")
    def clear(self, kind: int) -> None:
        """Removes all blend shape channels with their targets, all animated maps, or, for
        `Kind.JOINT`, all that moves joints."""
        self._call("mien_document_clear", uint32(kind, "kind"))

    @raises("mien_document_clear_joints")
    def clear_joints(self, joints: Union[Element, Iterable[Element]]) -> None:
        """Removes what moves these joints."""
        numbers = self._numbers(Kind.JOINT, joints)
        self._call("mien_document_clear_joints", numbers, len(numbers))

    @raises("mien_document_set_neutral")
    def set_neutral(self, first_joint: Element, translations: Any = None,
                    rotations: Any = None) -> None:
        """Sets neutral transforms relative to the parents, from a joint on: (3,) of one joint or
        (n, 3). None leaves them."""
        moved, moved_count, moved_at = floats_of(_flat(translations), "translations")
        turned, turned_count, turned_at = floats_of(_flat(rotations), "rotations")
        counts = {count for count in (moved_count, turned_count) if count}
        if len(counts) > 1 or any(count % 3 for count in counts):
            raise ArgumentError("translations and rotations take 3 numbers for each joint, and as many "
                                "of both")
        self._call("mien_document_set_neutral", self.find(Kind.JOINT, first_joint), moved_at,
                   turned_at, max(counts, default=0) // 3)
        del moved, turned  # not before

    def positions(self, mesh: Element) -> Any:
        """Copy of the positions of a mesh: float32 (n, 3), or a flat array without NumPy."""
        return self._vectors(f"geom.meshes[{self._mesh(mesh)}].positions")

    def _vectors(self, path: str) -> Any:
        axes = [self.read(f"{path}.{axis}") for axis in ("xs", "ys", "zs")]
        values, _ = new_array("f", 3 * len(axes[0]))
        for axis in range(3):
            values[axis::3] = axes[axis]
        return shaped(values, (-1, 3))

    @raises("mien_document_set_positions")
    def set_positions(self, mesh: Element, positions: Any) -> None:
        """Sets all positions of a mesh, (n, 3). Normals stay as they are."""
        held, count, address = floats_of(positions, "positions", (None, 3))
        self._call("mien_document_set_positions", self._mesh(mesh), address, count // 3)
        del held  # not before

    @raises("mien_document_set_target")
    def set_target(self, mesh: Element, channel: Element, deltas: Any,
                   vertices: Any = None) -> None:
        """Sets the target of a channel on a mesh: (n, 3) deltas of the positions `vertices`, or of
        the first n. Deltas of zero are left out; without any other the target is removed."""
        held, count, address = floats_of(deltas, "deltas", (None, 3))
        numbers = None
        if vertices is not None:
            given = _integers(vertices, "vertices")
            if 3 * len(given) != count:
                raise ArgumentError(f"there are {len(given)} vertices and {count // 3} deltas")
            numbers = (ctypes.c_uint32 * len(given))(*(uint32(v, "vertex") for v in given))
        self._call("mien_document_set_target", self._mesh(mesh),
                   self.find(Kind.BLEND_SHAPE_CHANNEL, channel), numbers, address, count // 3)
        del held  # not before

    @raises("mien_document_prune_targets")
    def prune_targets(self, tolerance: float) -> PrunedTargets:
        """Removes deltas not longer than this, and targets that have none left."""
        pruned = _api.MienPrunedTargets()
        self._call("mien_document_prune_targets", tolerance, _byref(pruned))
        return PrunedTargets._of(pruned)

    @raises("mien_document_prune_joints")
    def prune_joints(self, translation: float = 0, rotation: float = 0,
                     scale: float = 0) -> PrunedJoints:
        """Sets entries of the joint matrix not above these to 0, and measures what that does to the
        positions of LOD 0."""
        desc = _api.MienPruneJointsDesc(translation=translation, rotation=rotation, scale=scale)
        pruned = _api.MienPrunedJoints()
        self._call("mien_document_prune_joints", _byref(desc), _byref(pruned))
        return PrunedJoints._of(pruned)

    @raises("mien_document_set_weights")
    def set_weights(self, mesh: Element, joints: Any, weights: Any) -> None:
        """Sets the skin weights of a mesh: (n, k) numbers of joints and (n, k) weights. Weights of 0
        are left out. Needs NumPy."""
        numbers = numpy.ascontiguousarray(joints)
        shares = numpy.ascontiguousarray(weights, "float32")
        if numbers.ndim != 2 or numbers.shape != shares.shape or numbers.dtype.kind not in "ui":
            raise ArgumentError(f"joints {numbers.dtype}{numbers.shape} and weights {shares.shape} "
                                "are not whole numbers and numbers of one shape (n, k)")
        if numbers.size and not 0 <= numbers.min() <= numbers.max() < 1 << 16:
            raise ArgumentError("a joint is not in 0 ... 65535")
        numbers = numbers.astype("uint16")
        self._call("mien_document_set_weights", self._mesh(mesh), numbers.shape[1],
                   numbers.ctypes.data, shares.ctypes.data, shares.size)

    @raises("mien_document_normalize_weights")
    def normalize_weights(self, mesh: Element) -> None:
        """Scales the weights of each position of a mesh to a sum of 1."""
        self._call("mien_document_normalize_weights", self._mesh(mesh))

    @raises("mien_document_limit_influences")
    def limit_influences(self, mesh: Element, influences: int) -> None:
        """Keeps the largest weights of each position of a mesh."""
        self._call("mien_document_limit_influences", self._mesh(mesh),
                   uint32(influences, "influences"))

    @raises("mien_document_smooth_weights")
    def smooth_weights(self, mesh: Element, iterations: int = 1, strength: float = 0.5,
                       influences: int = 8) -> None:
        """Mixes the weights of each position with the mean of its neighbors along edges."""
        self._call("mien_document_smooth_weights", self._mesh(mesh),
                   uint32(iterations, "iterations"), strength, uint32(influences, "influences"))

    @raises("mien_document_place")
    def place(self, scale: float = 1, rotation: Sequence[float] = (0, 0, 0),
              translation: Sequence[float] = (0, 0, 0)) -> None:
        """Scales the whole character about the origin, then rotates it by right-handed degrees about
        x, then y, then z, then moves it."""
        if scale == 0:
            raise ArgumentError("scale is 0")
        x, y, z = rotation
        along = translation
        placement = _api.MienPlacement(scale=scale, rotation=(x, y, z),
                                       translation=(along[0], along[1], along[2]))
        self._call("mien_document_place", _byref(placement))

    @raises("mien_document_keep_lods")
    def keep_lods(self, lods: Iterable[int]) -> None:
        """Keeps these LODs, renumbered from 0."""
        self._call("mien_document_keep_lods", lod_bits(lods))

    @raises("mien_document_convert")
    def convert(self, system: Union[str, CoordinateSystem]) -> None:
        """Converts to the axes, units and winding of a system, as `Dna.open` does."""
        if isinstance(system, str):
            system = coordinate_system(system)
        given = _api.MienCoordinateSystem(**system._asdict())
        self._call("mien_document_convert", _byref(given))

    # ---- parts of other documents --------------------------------------------------------------------

    @raises("mien_document_copy_layers")
    def copy_layers(self, other: Document, layers: int) -> None:
        """Copies `Layer`s of another document, combined with |."""
        self._call("mien_document_copy_layers", other._open(), uint32(layers, "layers"))

    @raises("mien_document_copy_mesh")
    def copy_mesh(self, other: Document, mesh: Element) -> int:
        """Copies a mesh of another document, over the one of that name or as a new one, and returns
        its number here."""
        found = ctypes.c_uint32()
        self._call("mien_document_copy_mesh", other._open(), other._mesh(mesh), _byref(found))
        return found.value

    @raises("mien_document_merge_joints")
    def merge_joints(self, other: Document, tolerance: float = 1e-3) -> None:
        """Adds the joints of another document that this one lacks, such as those of a body. Joints
        that both have must stand in the same place, within `tolerance`."""
        self._call("mien_document_merge_joints", other._open(), tolerance)

    @raises("mien_document_split_joints")
    def split_joints(self, other: Document) -> None:
        """Removes the joints that another document does not have."""
        self._call("mien_document_split_joints", other._open())

    @staticmethod
    def _project_desc(match: int, influences: int, keep_weights: bool, keep_targets: bool) -> Any:
        return _byref(_api.MienProjectDesc(
            match=uint32(match, "match"), influences=uint32(influences, "influences"),
            keep_weights=bool(keep_weights), keep_targets=bool(keep_targets)))

    @raises("mien_document_project")
    def project(self, mesh: Element, source: Element, match: int = Match.SURFACE,
                influences: int = 0, keep_weights: bool = False,
                keep_targets: bool = False) -> float:
        """Gives a mesh the skin weights and targets of another one, and returns the largest distance
        to a place on it. influences: at most, per position; 0: 8."""
        farthest = ctypes.c_double()
        self._call("mien_document_project", self._mesh(mesh), self._mesh(source),
                   self._project_desc(match, influences, keep_weights, keep_targets),
                   _byref(farthest))
        return farthest.value

    @raises("mien_document_make_lod")
    def make_lod(self, lod: int, source: int, match: int = Match.SURFACE, influences: int = 0,
                 keep_weights: bool = False, keep_targets: bool = False) -> float:
        """The same for all meshes of a LOD, from the meshes of LOD `source` whose names differ only
        in the number of the LOD."""
        farthest = ctypes.c_double()
        self._call("mien_document_make_lod", uint32(lod, "LOD"), uint32(source, "LOD"),
                   self._project_desc(match, influences, keep_weights, keep_targets),
                   _byref(farthest))
        return farthest.value

    @raises("mien_document_conform")
    def conform(self, mesh: Element, positions: Any, others: bool = True) -> Conformed:
        """Gives a mesh new positions, (n, 3), and lets joints, targets and, with `others`, the other
        meshes follow."""
        held, count, address = floats_of(positions, "positions", (None, 3))
        found = _api.MienConformed()
        self._call("mien_document_conform", self._mesh(mesh), address, count // 3, int(others),
                   _byref(found))
        del held  # not before
        return Conformed._of(found)

    @raises("mien_document_transplant")
    def transplant(self, rig: Document, match: int = Match.SURFACE,
                   influences: int = 0) -> List[ControlError]:
        """Gives the character the rig of a template: controls, joints, behavior and LODs. It keeps
        its shape. Returns what raw controls that both have do differently."""
        desc = _api.MienTransplantDesc(match=uint32(match, "match"),
                                       influences=uint32(influences, "influences"))
        names = rig.names(Kind.RAW_CONTROL)
        errors = (_api.MienControlError * len(names))()
        count = ctypes.c_size_t()
        self._call("mien_document_transplant", rig._open(), _byref(desc), errors, len(names),
                   _byref(count))
        return [ControlError(names[e.control], e.worst, e.rms, e.moved)
                for e in errors[:count.value]]

    # ---- results -------------------------------------------------------------------------------------

    @raises("mien_document_to_dna")
    def to_dna(self) -> Dna:
        """The document as an open file, checked as files are."""
        handle = DnaHandle()
        desc = _api.MienDocumentDesc()
        self._call("mien_document_to_dna", _byref(desc), _byref(handle))
        return Dna(handle)

    @raises("mien_document_validate")
    def validate(self) -> List[Finding]:
        """Every finding, as `mien.validate` gives of a file."""
        handle = ReportHandle()
        self._call("mien_document_validate", None, _byref(handle))
        return findings_of(handle)

    @raises("mien_document_write_file")
    def save(self, path: Any, version: int = 0) -> None:
        """Writes the document to a file, as `Dna.save`."""
        error = MienError()
        status = author().mien_document_write_file(self._open(), as_path(path),
                                                   _byref(self._write_desc(version)), _byref(error))
        if status:
            fail(status, f"cannot write {path}", error, path)

    @raises("mien_document_write_memory")
    def to_bytes(self, version: int = 0) -> bytes:
        """The same to memory."""
        desc, size = self._write_desc(version), ctypes.c_size_t()
        self._call("mien_document_write_memory", _byref(desc), None, 0, _byref(size))
        buffer = ctypes.create_string_buffer(size.value)
        self._call("mien_document_write_memory", _byref(desc), buffer, size.value, _byref(size))
        return buffer.raw

    @staticmethod
    def _write_desc(version: int) -> Any:
        return _api.MienWriteDesc(version=uint32(version, "version"))

    def __repr__(self) -> str:
        if self.closed:
            return "<mien.Document, closed>"
        counts = {kind: self.field(path).count for kind, path in _NAMES.items()}
        return (f"<mien.Document: {counts[Kind.RAW_CONTROL]} raw controls, "
                f"{counts[Kind.JOINT]} joints, {counts[Kind.MESH]} meshes>")


def _flat(values: Any) -> Any:
    """Vectors in a row."""
    return values if values is None or numpy is None else numpy.asarray(values).reshape(-1)


def _integers(values: Any, what: str) -> List[int]:
    if hasattr(values, "dtype") and values.dtype.kind not in "ui" and len(values):
        raise ArgumentError(f"{what} takes whole numbers, not {values.dtype}")
    given = list(values.tolist() if hasattr(values, "tolist") else values)
    if any(not isinstance(value, int) for value in given):
        raise ArgumentError(f"{what} takes whole numbers")
    return given
