# SPDX-License-Identifier: MIT
"""Rigs in files: DNA files, and .uasset files that hold them."""
import os
import struct
from dataclasses import dataclass, field

import numpy as np

from .binding import mien

SIGNATURE = b"DNA\x00\x02\x00"  # and a byte: the version
# Axis of Blender and sign: x to the character's left, y to the back, z up.
DIRECTIONS = {mien.Direction.LEFT: (0, 1), mien.Direction.RIGHT: (0, -1), mien.Direction.BACK: (1, 1),
              mien.Direction.FRONT: (1, -1), mien.Direction.UP: (2, 1), mien.Direction.DOWN: (2, -1)}
MAX_NAME = 63  # bytes of a name in Blender

_opened = {}  # path -> RigFile, or the error that opening it gave


@dataclass
class RigFile:
    """A file that is open. Immutable, as are the rigs and the deformer in it.

    Controls that are parts of rotations are in the axes of the file, so that numbers are those of `mien` and of engines: `rig`,
    which is evaluated, is not converted. What has a place in the scene is in Blender's axes and meters.
    """

    path: str
    data: bytes  # of the DNA, from its first byte
    dna: mien.Dna  # converted
    rig: mien.Rig  # in the axes and units of the file
    converted: mien.Rig  # of `dna`
    deformer: mien.Deformer  # of `converted`
    axes: np.ndarray  # float64 (3, 3): a vector of Blender is axes.T @ a vector of the file
    unit: float  # meters of a unit of the file
    controls: list = field(default_factory=list)  # names of the properties, one per raw control
    gui_controls: list = field(default_factory=list)
    joints: list = field(default_factory=list)  # names of the bones, one per joint
    channels: list = field(default_factory=list)
    maps: list = field(default_factory=list)

    @property
    def name(self):
        return os.path.splitext(os.path.basename(self.path))[0]


def blender_names(names):
    """The same names, short enough for Blender and different from each other."""
    made, seen = [], set()
    for name in names:
        short = name.encode("utf-8", "replace")[:MAX_NAME].decode("utf-8", "ignore") or "unnamed"
        number = 1
        while short in seen:
            end = f".{number:03}"
            short = name.encode("utf-8", "replace")[:MAX_NAME - len(end)].decode("utf-8", "ignore") + end
            number += 1
        seen.add(short)
        made.append(short)
    return made


def find_streams(data):
    """Offsets of the DNA files within the bytes of another file; 0 alone for a DNA file itself."""
    if data.startswith(SIGNATURE):
        return [0]
    found, at = [], data.find(SIGNATURE)
    while at >= 0:
        try:
            with mien.Dna.from_bytes(data[at:]) as dna:
                if dna.info.joint_count or dna.info.raw_control_count:
                    found.append(at)
        except mien.Error:
            pass  # these bytes occur in other data too
        at = data.find(SIGNATURE, at + 1)
    return found


def read_dna(path):
    """The bytes of the DNA in a file. Raises ValueError if the file has none, or several."""
    with open(path, "rb") as file:
        data = file.read()
    streams = find_streams(data)
    if not streams and path.lower().endswith(".uasset"):
        raise ValueError(f"{path}: no DNA is stored here uncompressed. Export it from the editor as a .dna file, or "
                         "import the *_FaceMesh_DNA.uasset of the character")
    if len(streams) > 1:
        raise ValueError(f"{path}: has {len(streams)} DNA files. Run 'mien extract' on it, then import one of them")
    return data[streams[0]:] if streams else data


def from_bytes(data, path=""):
    """A RigFile from the bytes of a DNA file."""
    quaternions = mien.RotationOutput.QUATERNION
    with mien.Dna.from_bytes(data, layers=mien.Layer.ALL & ~mien.Layer.GEOMETRY) as source:
        rig, info = mien.Rig(source, rotation=quaternions), source.info
    dna = mien.Dna.from_bytes(data, system="blender")
    converted = mien.Rig(dna, rotation=quaternions)
    deformer = mien.Deformer(dna, converted, weights=mien.Weights.FIX) if dna.info.layers & mien.Layer.GEOMETRY else None
    axes = np.zeros((3, 3))
    for of_file, direction in enumerate(info.axes):
        of_blender, sign = DIRECTIONS[direction]
        axes[of_file, of_blender] = sign
    kind = mien.Kind
    return RigFile(path, data, dna, rig, converted, deformer, axes,
                   0.01 if info.translation_unit == mien.TranslationUnit.CENTIMETERS else 1.0,
                   controls=blender_names(rig.names(kind.RAW_CONTROL)), gui_controls=rig.names(kind.GUI_CONTROL),
                   joints=blender_names(rig.names(kind.JOINT)),
                   channels=blender_names(rig.names(kind.BLEND_SHAPE_CHANNEL)),
                   maps=rig.names(kind.ANIMATED_MAP))


def open_file(path):
    """The RigFile of a path. A file is read once; `forget` lets it be read again. Raises ValueError or OSError,
    with a message for the user; mien.Error is one of these."""
    found = _opened.get(path)
    if found is None:
        try:
            found = from_bytes(read_dna(path), path)
        except (OSError, ValueError) as error:
            found = error if path in str(error) else ValueError(f"{path}: {error}")
        _opened[path] = found
    if isinstance(found, Exception):
        raise found
    return found


def forget(path=None):
    """Reads a file again when it is next used; None: every file."""
    if path is None:
        _opened.clear()
    else:
        _opened.pop(path, None)


# ---- lists of records, straight from the bytes: reading them field by field would take seconds ----------------


def read_faces(rig_file, mesh):
    """The faces of a mesh as sizes and as vertices of the corners, one after the other."""
    dna, path = rig_file.dna, f"geom.meshes[{mesh}].faces"
    count = dna.field(path).count
    sizes = np.zeros(count, np.int32)
    if not count:
        return sizes, np.zeros(0, np.int32)
    # Of each face the number of corners, then the corners: 32 bits each, big-endian.
    start = dna.field(f"{path}[0].layoutIndices").byte_offset - 4
    words = np.frombuffer(rig_file.data, ">u4", (len(rig_file.data) - start) // 4, start)
    quads = words[:5 * count].reshape(-1, 5) if len(words) >= 5 * count else None
    if quads is not None and (quads[:, 0] == 4).all():
        return np.full(count, 4, np.int32), quads[:, 1:].astype(np.int32).ravel()
    corners, at = [], 0
    for face in range(count):
        size = int(words[at])
        sizes[face] = size
        corners.append(words[at + 1:at + 1 + size])
        at += 1 + size
    return sizes, np.concatenate(corners).astype(np.int32)


def read_weights(rig_file, mesh):
    """Joints and weights of a mesh: arrays (n,) of positions, joints and weights that are not 0."""
    dna, path = rig_file.dna, f"geom.meshes[{mesh}].skinWeights"
    count = dna.field(path).count
    start = None
    for i in range(count):  # a position without influences has no offset
        start = dna.field(f"{path}[{i}].weights").byte_offset
        if start is not None:
            start -= 4 + 8 * i
            break
    if start is None:
        return np.zeros(0, np.int32), np.zeros(0, np.int32), np.zeros(0, np.float32)
    # Of each position the number of weights, the weights, the number of joints, the joints.
    data, at, unpack = rig_file.data, start, struct.Struct(">I").unpack_from
    sizes, starts = [], []
    for _ in range(count):
        size = unpack(data, at)[0]
        sizes.append(size)
        starts.append(at)
        at += 8 + 6 * size
    sizes, starts = np.array(sizes), np.array(starts)
    nth = np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    octets = np.frombuffer(data, np.uint8, at - start, start)

    def gather(offsets, bytes_each, kind):
        places = np.repeat(offsets - start, sizes) + bytes_each * nth
        return octets[places[:, None] + np.arange(bytes_each)].view(kind).ravel()

    positions = np.repeat(np.arange(count, dtype=np.int32), sizes)
    weights = gather(starts + 4, 4, ">f4").astype(np.float32)
    joints = gather(starts + 8 + 4 * sizes, 2, ">u2").astype(np.int32)
    keep = weights > 0
    return positions[keep], joints[keep], weights[keep]
