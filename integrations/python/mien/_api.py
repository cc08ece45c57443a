# SPDX-License-Identifier: MIT
# Code generated from integrations/api/mien_api.json by generate.py; run ./dev api. DO NOT EDIT.
# mypy: ignore-errors
"""The C interface as ctypes sees it: enums, structs, handles and the types of functions.

Nothing here owns or checks anything; the rest of the package does. `mien.h` is the manual.
"""
from __future__ import annotations

import ctypes
from ctypes import (CFUNCTYPE, POINTER, Structure, c_char, c_char_p, c_double, c_float, c_int8,
                    c_int16, c_int32, c_int64, c_size_t, c_uint8, c_uint16, c_uint32, c_uint64,
                    c_void_p)
from enum import IntEnum, IntFlag
from typing import Any, Dict, NamedTuple, Optional, Tuple, Type, TypeVar

VERSION = '0.1.0'

_E = TypeVar("_E", bound=IntEnum)


def _enum(kind: Type[_E], value: int) -> _E:
    """A number that a newer library may give stays a number."""
    try:
        return kind(value)
    except ValueError:
        return value


def text(view: Any) -> str:
    """Copy of a MienStringView. Bytes that are no UTF-8 survive a way back through str.encode()."""
    return ctypes.string_at(view.data, view.count).decode("utf-8", "surrogateescape") \
        if view.count else ""


MIEN_NO_OFFSET = 18446744073709551615
MIEN_TICKS_PER_SECOND = 705600000
MIEN_NO_MESH = 4294967295
MIEN_NO_CONTROL = 65535
MIEN_NO_JOINT = 65535
MIEN_MOST_SHARES = 16


class Status(IntEnum):
    """Numbers are never reused."""

    OK = 0
    #: a required pointer is NULL
    NULL_ARGUMENT = 1
    #: a value out of range, or a buffer that is too small
    INVALID_ARGUMENT = 2
    #: struct_size is too small or above 4096, or a field unknown to the library is not zero
    STRUCT_SIZE = 3
    #: a handle of the wrong kind
    HANDLE = 4
    #: objects that do not belong together
    MISMATCH = 5
    #: an index past the end
    INDEX = 6
    #: a LOD that does not exist, or for which the object has no memory
    LOD = 7
    #: no such name or path
    NAME = 8
    #: an instruction set that the CPU or the build does not support
    ISA = 9
    #: the allocator returned NULL
    MEMORY = 10
    #: this build of the library only opens baked files, or the object is stored in a form that
    #: does not have what was asked for
    UNSUPPORTED = 11
    #: the file cannot be opened
    FILE_OPEN = 20
    #: the file or stream cannot be read
    FILE_READ = 21
    #: the file cannot be written
    FILE_WRITE = 22
    #: not a DNA file
    DNA_SIGNATURE = 30
    #: a DNA file whose generation is not 2
    DNA_VERSION = 31
    #: the file ends before the data that its header or counts announce
    DNA_TRUNCATED = 32
    #: offsets, sizes or counts contradict each other
    DNA_STRUCTURE = 33
    #: an index that refers to nothing
    DNA_REFERENCE = 34
    #: a count above the limit of the format or of Mien
    DNA_LIMIT = 35
    #: a required layer is not loaded or not in the file
    DNA_LAYER = 36
    #: an invalid value, or one that cannot be converted
    DNA_VALUE = 37
    #: not a baked file
    BAKED_SIGNATURE = 50
    #: baked by another version of Mien, or for the other byte order
    BAKED_VERSION = 51
    #: the file is shorter than its header states
    BAKED_TRUNCATED = 52
    #: sizes, counts or indices contradict each other
    BAKED_STRUCTURE = 53
    #: the file has changed since it was written
    BAKED_CHECKSUM = 54
    #: the file does not contain the requested object
    BAKED_PART = 55
    #: not a clip
    CLIP_SIGNATURE = 60
    #: a clip in another version of the format
    CLIP_VERSION = 61
    #: the clip is shorter than its header states
    CLIP_TRUNCATED = 62
    #: sizes, counts or curves contradict each other
    CLIP_STRUCTURE = 63
    #: the clip has changed since it was written
    CLIP_CHECKSUM = 64
    #: a value that is not finite
    CLIP_VALUE = 65
    #: more than a clip, player or binding can hold
    CLIP_LIMIT = 66
    #: not a mix
    MIX_SIGNATURE = 70
    #: a mix in another version of the format
    MIX_VERSION = 71
    #: the file is shorter than its header states
    MIX_TRUNCATED = 72
    #: sizes or counts contradict each other, or a value is out of range
    MIX_STRUCTURE = 73
    #: the mix has changed since it was written
    MIX_CHECKSUM = 74
    #: the arrays of a mesh, shape or bone contradict each other
    AUTHOR_MESH = 80
    #: a mesh that cannot be rigged; the message names the rule
    AUTHOR_REFUSED = 81
    #: the caller's progress function asked to stop
    AUTHOR_CANCELED = 82


class Layer(IntFlag):
    """Layers of a DNA file, combined with |. A layer loads the layers that it refers to: all of
    them need the definition, RBF behavior needs the behavior. The descriptor is always loaded.
    See docs/dna-format.md, 9 "Choosing layers".
    """

    #: only in MienDnaLayer.layer
    UNKNOWN = 0
    DESCRIPTOR = 1
    DEFINITION = 2
    BEHAVIOR = 4
    GEOMETRY = 8
    MACHINE_LEARNED_BEHAVIOR = 16
    RBF_BEHAVIOR = 32
    JOINT_BEHAVIOR_METADATA = 64
    TWIST_SWING_BEHAVIOR = 128
    ALL = 255


class UnknownLayers(IntEnum):
    """What to do with layers of unknown kinds."""

    #: keep their bytes and write them back unchanged
    KEEP = 0
    DROP = 1


class FileAccess(IntEnum):
    """Values of enum MienFileAccess of the C interface."""

    #: map the file; read it into memory if it cannot be mapped, such as a pipe
    MAP = 0
    #: read the whole file into memory: safe even if it is truncated later
    READ = 1


class TranslationUnit(IntEnum):
    """Values of enum MienTranslationUnit of the C interface."""

    CENTIMETERS = 0
    METERS = 1


class RotationUnit(IntEnum):
    """Values of enum MienRotationUnit of the C interface."""

    DEGREES = 0
    RADIANS = 1


class Direction(IntEnum):
    """Directions as seen by the character."""

    LEFT = 0
    RIGHT = 1
    UP = 2
    DOWN = 3
    FRONT = 4
    BACK = 5


class RotationSequence(IntEnum):
    """Order of Euler angles."""

    #: x first, then y, then z, about fixed axes
    XYZ = 0
    XZY = 1
    YXZ = 2
    YZX = 3
    ZXY = 4
    ZYX = 5


class FaceWinding(IntEnum):
    """The side of a face a b c ... to which (b - a) x (c - a) points. The cross product is
    computed from the coordinates in the file, whatever the directions of its axes.
    """

    #: seen from outside: counter-clockwise with right-handed axes, clockwise with left-handed axes
    OUTWARD = 0
    INWARD = 1


class RotationRule(IntEnum):
    """How Euler angles are converted to other axes. Joint values are sums of angles, which have a
    meaning in one rotation sequence only. So only the first rule is exact for all rigs.
    """

    #: keep the sequence of the file and rename its axes: if x and z are exchanged, xyz becomes
    #: zyx, xzy becomes zxy, and so on
    CARRIED = 0
    #: the requested sequence. Neutral poses, quaternion joints, twists, swings, ML joints and
    #: joints that rotate about one axis only are converted exactly; rigs with other joints are
    #: rejected with Status.DNA_VALUE
    EXACT = 1
    #: the requested sequence, converting each column of the joint matrix separately: exact if one
    #: control is 1 and all others are 0, otherwise an approximation for small angles
    PER_COLUMN = 2


class FieldType(IntEnum):
    """Type of a field."""

    #: named fields
    RECORD = 0
    #: records, strings or arrays; element i is at the path of the list + [i]
    LIST = 1
    STRING = 2
    #: numbers: one, or an array
    U8 = 3
    U16 = 4
    U32 = 5
    I32 = 6
    F32 = 7


class Severity(IntEnum):
    """Values of enum MienSeverity of the C interface."""

    #: opening the file or mien_rig_create() fails because of this
    ERROR = 0
    #: allowed, but probably a mistake
    WARNING = 1


class Isa(IntEnum):
    """Instruction sets."""

    #: the best one that the CPU, the operating system and the build support
    BEST = 0
    SCALAR = 1
    SSE2 = 2
    #: with FMA and F16C
    AVX2 = 3
    #: F, CD, DQ, BW and VL
    AVX512 = 4
    NEON = 5
    #: the one named by the environment variable MIEN_ISA ("scalar", "sse2", ...); the best one if
    #: it is unset or empty
    ENVIRONMENT = 1000


class RotationOutput(IntEnum):
    """How joint values store rotations."""

    #: 9 values per joint: tx ty tz rx ry rz sx sy sz
    EULER = 0
    #: 10 values per joint: tx ty tz qx qy qz qw sx sy sz
    QUATERNION = 1


class MlMasks(IntEnum):
    """Effect of a region mask on the networks of the region (mien_instance_ml_masks()). See
    docs/rig-evaluation.md, 8.5 "Region masks".
    """

    #: 0: the outputs of the networks get their default (0, or 1 for the w of a quaternion). Other
    #: values: the networks are evaluated. This is the behavior that DNA files are authored for.
    SWITCH = 0
    #: outputs are blended with their default by the mask, clamped to 0..1
    BLEND = 1


class Storage(IntEnum):
    """How the large arrays that evaluation reads are stored. Sums and results are always 32-bit
    floats. See docs/rig-evaluation.md, 4.9 "16-bit storage".
    """

    BIT_32 = 0
    #: half the memory. Network weights and columns of quaternion joints are IEEE half floats
    #: (rounded to nearest even, at most 65504 in magnitude); the joint matrix is 16-bit fixed
    #: point, in units of 1/32767 of the largest entry of the row
    BIT_16 = 1


class Arithmetic(IntEnum):
    """Which instruction sets give bit-identical results. See docs/numbers.md, 5 "Portable
    arithmetic".
    """

    #: AVX2, AVX-512 and NEON, which fuse multiply and add, agree with each other; scalar and SSE2
    #: agree with each other
    FAST = 0
    #: all agree, because nothing is fused. A baked rig gives the same bits on every machine; a rig
    #: created from a DNA file does if the C libraries compute the same sines.
    PORTABLE = 1


class Reuse(IntEnum):
    """What an instance keeps of its last evaluation. With Reuse.UNCHANGED and Reuse.NOTHING the
    results are bit-identical.
    """

    #: results whose inputs have not changed: joint groups, and other stages as a whole
    UNCHANGED = 0
    #: compute everything in each evaluation, for measurements
    NOTHING = 1
    #: also the sums of the joint matrix: where few controls changed, only their differences are
    #: added, so such a frame costs little even if these controls move joints everywhere. Joint
    #: values then depend on earlier frames: they differ from those of a full evaluation by at most
    #: (n + 1539) * 2^-23 * M, before rotations are made from them. n is the number of controls
    #: that are not 0, M the sum of the magnitudes of the products that a joint value is the sum
    #: of; both are the largest since all sums were last computed, which happens after a reset,
    #: after a change of LOD and before 1536 differences were added. Everything else is bit-
    #: identical. Rigs and instances take more memory: MienRigInfo.rig_bytes, .instance_bytes
    SUMS = 2


class Kind(IntEnum):
    """Kinds of parts of a rig. Most have names."""

    GUI_CONTROL = 0
    RAW_CONTROL = 1
    #: correctives; unnamed in DNA files, here "psd0", "psd1", ...
    PSD_CONTROL = 2
    ML_CONTROL = 3
    RBF_CONTROL = 4
    JOINT = 5
    BLEND_SHAPE_CHANNEL = 6
    ANIMATED_MAP = 7
    MESH = 8
    #: region masks, one per region of each mesh: "mesh/region"
    ML_MASK = 9
    #: without names
    JOINT_GROUP = 10
    #: without names
    RBF_SOLVER = 11
    #: without names: a swing and the twists with the same inputs, or a twist alone
    TWIST_SWING = 12


class Stage(IntFlag):
    """Stages of an evaluation, combined with |."""

    #: neural networks
    ML = 1
    #: RBF solvers
    RBF = 2
    #: correctives
    PSD = 4
    #: joint groups, then twists and swings, then ML joints
    JOINTS = 8
    BLEND_SHAPES = 16
    ANIMATED_MAPS = 32
    ALL = 63


class Compose(IntEnum):
    """How the neutral rotation of a joint is combined with its delta."""

    #: neutral rotation * delta rotation: the delta rotates first
    PRODUCT = 0
    #: the angles are added; requires RotationOutput.EULER. Equals the product where the neutral
    #: rotation is zero.
    EULER_ADD = 1


class Weights(IntEnum):
    """Treatment of skin weights."""

    AS_STORED = 0
    #: drop negative weights and divide the others by their sum
    FIX = 1


class Normals(IntEnum):
    """Normals of deformed meshes; they have unit length. Where no normal can be computed (no
    faces, or faces without area), the neutral one is used. See docs/deformation.md, 3
    "Normals".
    """

    #: as MienDeformerDesc.normals says; in that field: recomputed
    DEFAULT = 0
    #: leave normals unchanged
    NONE = 1
    #: neutral normals rotated by the skinning, correct for any scale; blend shape targets have no
    #: effect
    SKINNED = 2
    #: the area-weighted mean of the normals of the faces around the position. On hard edges, where
    #: this differs from the stored normal by more than 30 degrees in the neutral pose, the stored
    #: normal is rotated by the rotation of this mean from the neutral pose.
    RECOMPUTED = 3


class VertexFormat(IntEnum):
    """Layout of a vertex attribute in memory, in the byte order of the machine. A signed
    normalized integer of n bits is round(clamp(v, -1, 1) * (2^(n-1) - 1)), ties to even, in
    two's complement. These are the vertex formats R32G32B32_SFLOAT, R32G32B32A32_SFLOAT,
    R16G16B16A16_SNORM and A2B10G10R10_SNORM_PACK32 of Vulkan, and float3, float4,
    short4Normalized and int1010102Normalized of Metal. Direct3D 12 and WebGPU lack the last
    one.
    """

    #: 12 bytes: x y z
    FLOAT32X3 = 0
    #: 16 bytes: x y z w
    FLOAT32X4 = 1
    #: 8 bytes: x y z w, 16 bits each
    SNORM16X4 = 2
    #: 4 bytes, one 32-bit word: x in bits 0-9, y in bits 10-19, z in bits 20-29, w in bits 30-31
    SNORM10_10_10_2 = 3


class Point(IntEnum):
    """Points on the way from controls to positions:

        GUI -> RAW -> CONTROLS -> JOINTS -> LOCALS -> MODELS -> SKINS -> POSITIONS
                          |-> CHANNELS ------------------------------------^
                          |-> MAPS

    Derivatives lead from one point to a later one that depends on it. Networks, RBF solvers and
    correctives run between RAW and CONTROLS; the joint stage, channels and maps read CONTROLS.
    From JOINTS on, channel weights are constant. See docs/derivatives.md.
    """

    #: GUI controls
    GUI = 0
    #: raw controls
    RAW = 1
    #: all controls: mien_instance_controls()
    CONTROLS = 2
    #: joint values: mien_instance_joints()
    JOINTS = 3
    #: 16 floats per joint: matrix relative to the parent, four columns
    LOCALS = 4
    #: the same, in model space: mien_deformer_instance_joint_matrices()
    MODELS = 5
    #: the same, of skin matrices: mien_deformer_instance_skin_matrices()
    SKINS = 6
    #: x y z per position of a mesh, in the order of the file
    POSITIONS = 7
    #: blend shape channel weights
    CHANNELS = 8
    #: animated map weights
    MAPS = 9


class BakedCheck(IntEnum):
    """What is checked when a baked file is used."""

    #: all sizes, counts and indices, so that no access is out of bounds whatever the bytes are.
    #: Floats are not checked, so their pages are read from disk only when first used.
    SAFE = 0
    #: also the checksum of all bytes, which reads the whole file
    FULL = 1


class Looping(IntEnum):
    """What happens after the last frame."""

    #: a clip: Looping.CLAMP; a player: the setting of its clip
    DEFAULT = 0
    #: holds the last frame; the length is (frames - 1) * ticks per frame
    CLAMP = 1
    #: starts over; the length is frames * ticks per frame
    WRAP = 2


class Interpolation(IntEnum):
    """How values between two frames are computed. They stay within the range of these two frames.
    """

    LINEAR = 0
    #: the value of the earlier frame
    STEP = 1
    #: a Catmull-Rom spline, clamped to that range
    CATMULL_ROM = 2


class LayerGroup(IntEnum):
    """The purpose of a layer. Guards protect the result of base and speech from the other groups.
    """

    BASE = 0
    SPEECH = 1
    EMOTION = 2
    REACTION = 3
    #: acts after the reactions if no layer of another group follows
    LIFE = 4


class BlendMode(IntEnum):
    """How a layer changes a curve: o is the value so far, x the value of the layer, a = weight *
    mask. Curves for which the layer's source has no value do not change.
    """

    #: o + a (x - o)
    OVERRIDE = 0
    #: o + a x
    ADD = 1
    #: o + a x (1 - p), or o + a x p if x < 0; p is o clamped to 0..1
    SCREEN = 2
    #: o + a max(0, x - o)
    MAX = 3
    #: o (1 + a (x - 1))
    SCALE = 4


class LayerSource(IntEnum):
    """Where the values of a layer come from."""

    #: mien_mixer_play()
    CLIP = 0
    #: a weighted sum: mien_mixer_set_pose_weight()
    POSES = 1
    #: mien_mixer_push()
    STREAM = 2
    #: Generator
    GENERATOR = 3


class Generator(IntEnum):
    """What a layer generates from the seed of the mixer and the time."""

    #: blinks every `period` on average, at least 0.5 s apart. The wait starts over when earlier
    #: layers raise the first curve above 0.6
    BLINK = 0
    #: rises from 0 to 1 in 40 % of the period, then falls back to 0
    BREATH = 1
    #: smooth noise between -1 and 1 with a new random value every period
    NOISE = 2
    #: turns the eyes to a target with saccades, by MienMixDesc.gaze. `curves` are three curves
    #: with the left, up and front of a MienGazeTarget, read after the earlier layers, then
    #: optionally two curves that get the part left for the head (MienGazeRest). `amounts` are
    #: fixation jitter sideways and up in degrees, 0, and factors for the two head curves. Shifts
    #: of 20 degrees or more make the blink layers of the mix blink
    GAZE = 3


class Retrigger(IntEnum):
    """What a trigger does while the reaction is already running."""

    #: extends the stimulus; strokes that are releasing or over start again
    EXTEND = 0
    #: all strokes start again, at most once per cooldown
    RESTART = 1
    IGNORE = 2


class Guard(IntFlag):
    """Built-in guards: gaps that emotions and reactions must not open while speech or a blink
    closes them. Bits of MienMixDesc.guards.
    """

    #: between the lips, left, center and right, and from lower lip to upper teeth
    LIPS = 1
    #: between the lids
    LIDS = 2
    #: between the teeth
    TEETH = 4
    ALL = 7


class Transition(IntEnum):
    """How a layer changes to another clip. A layer that plays no clip fades in, except with a cut.
    """

    #: the old clip stops; each curve blends from its last value and speed
    INERTIAL = 0
    #: both clips play; Transition.INERTIAL if no player is free
    CROSSFADE = 1
    #: immediate; transition_ticks is not used
    CUT = 2


class NameMatch(IntEnum):
    """How a name was matched."""

    NONE = 0
    #: the control has this name
    AS_WRITTEN = 1
    #: the same letters and side
    SPELLING = 2
    #: another word for the same control
    ALIAS = 3
    #: the controls of the left and the right side
    BOTH_SIDES = 4
    #: an expression of several controls
    EXPRESSION = 5


class Preset(IntEnum):
    """Kinds of generated rigs."""

    #: small enough to read
    TINY = 0
    SMALL = 1
    MEDIUM = 2
    #: a synthetic rig of production size: 870 joints, 260 raw controls, 8 LODs, a million matrix
    #: entries
    LARGE = 3
    #: a synthetic rig of the size of a production body: 342 joints, moved by 72 RBF solvers with
    #: 670 poses, 22 twists and 16 swings; some are quaternion joints
    BODY = 4
    #: a stylized head to look at: skin, eyes, teeth, tongue, hair; the 52 ARKit expressions and 20
    #: of MetaHuman rigs as raw controls (0 to 1), correctives, wrinkle maps, 8 LODs. Seed 0 is the
    #: designed head; other seeds vary skull, nose, jaw, age, hair and colors. The metadata holds
    #: vertex colors: key "mien.colors.<mesh name>", value base64 of 3 bytes (sRGB) per vertex
    #: position of the mesh.
    HEAD = 5
    #: a synthetic rig with the published counts of exported heads and names in MetaHuman's
    #: conventions: version 2.5, 870 joints, 263 raw controls (251 expressions, 12 parts of
    #: quaternions), 174 GUI controls, 545 correctives, 782 channels, an RBF solver with 18 poses,
    #: 8 LODs
    METAHUMAN_HEAD = 6
    #: Preset.BODY in version 2.7
    METAHUMAN_BODY = 7
    #: Preset.METAHUMAN_HEAD without blend shapes
    ARCHETYPE = 8


class Generate(IntEnum):
    """Additions to a preset, combined with |."""

    #: machine-learned behavior: networks for mesh regions with all activation functions and
    #: operations, and ML joints; not with Preset.HEAD and those after it
    ML = 1


class BoneKind(IntEnum):
    """The role of a bone."""

    ROOT = 0
    NECK = 1
    HEAD = 2
    FACE = 3
    #: moves with expressions; each LOD keeps the first n of these
    FACIAL = 4
    JAW = 5
    EYE = 6
    #: below the neck
    CHEST = 7
    #: moves with expressions, below the jaw; in every LOD
    TONGUE = 8


class Symmetry(IntEnum):
    """Whether both halves of the face are treated as mirror images."""

    #: if mirrored positions lie within 0.5 % of the face's size of the surface
    AUTO = 0
    ON = 1
    OFF = 2


class MeshAxis(IntEnum):
    """Directions of the axes of a mesh."""

    #: up: Y; front: Z
    DEFAULT = 0
    X = 1
    Y = 2
    Z = 3
    MINUS_X = 4
    MINUS_Y = 5
    MINUS_Z = 6


class AuthorFlags(IntFlag):
    """How bones and weights are computed, combined with |."""

    #: only the published method, plus the neck cut: no symmetry, no weighting by motion, no joints
    #: for jaw and eyes
    PAPER = 1
    #: the face mask may include parts of the neck
    NO_NECK_CUT = 2
    #: the face mask is where shapes move: for heads that are not human
    MASK_FROM_SHAPES = 4
    #: weight positions by the area around them: for scans
    AREA_DENSITY = 8
    #: no blend shape targets for the motion that joints cannot produce
    NO_TARGETS = 16
    #: group by distance in space, not in depth: for comparison
    GROUP_IN_SPACE = 32
    #: name bones that are placed and controls that are added as in MetaHuman heads where they have
    #: a counterpart: neck_01, FACIAL_C_Jaw, CTRL_expressions.jawOpen. The caller's bones and
    #: shapes keep their names
    METAHUMAN_NAMES = 64


class Match(IntEnum):
    """How positions of one mesh are found on another."""

    #: the nearest point in space
    SURFACE = 0
    #: the nearest point in the texture
    UV = 1


class FitConstraintKind(IntEnum):
    """What a constraint asks for. Places and directions are in model space, before the motion of
    MienFitFrame.rigid. Kinds with joints need MienFitDesc.deformer.
    """

    #: `joint` is at `target`: where the jaw is
    JOINT_POSITION = 0
    #: `axis` of `joint` has the direction `target`: an eye's gaze
    JOINT_DIRECTION = 1
    #: `axis` of `joint` points at the place `target`
    JOINT_AIM = 2
    #: `points[0]` is at `target`
    POINT_POSITION = 3
    #: from `distances[0]` to `distances[1]` lie between `points`: 0 and 0 where lips touch
    POINT_DISTANCE = 4


class FitStatus(IntEnum):
    """Why a solve ended."""

    #: further steps change nothing
    CONVERGED = 0
    #: the limit of iterations was reached; the best controls so far
    ITERATIONS = 1
    #: the limit of time was reached; likewise
    TIME = 2
    #: the caller asked to stop; likewise
    CANCELED = 3
    #: no target, or all are missing; the start is returned
    NO_DATA = 4


class MienDna(c_void_p):
    pass


class MienReport(c_void_p):
    pass


class MienRig(c_void_p):
    pass


class MienInstance(c_void_p):
    pass


class MienBatch(c_void_p):
    pass


class MienDeformer(c_void_p):
    pass


class MienDeformerInstance(c_void_p):
    pass


class MienDerivatives(c_void_p):
    pass


class MienJacobian(c_void_p):
    pass


class MienBaked(c_void_p):
    pass


class MienClip(c_void_p):
    pass


class MienClipPlayer(c_void_p):
    pass


class MienClipBinding(c_void_p):
    pass


class MienMix(c_void_p):
    pass


class MienGaze(c_void_p):
    pass


class MienMixer(c_void_p):
    pass


class MienSolverStack(c_void_p):
    pass


class MienSolverState(c_void_p):
    pass


class MienAuthorReport(c_void_p):
    pass


class MienDocument(c_void_p):
    pass


class MienFit(c_void_p):
    pass


class MienFitSurface(c_void_p):
    pass


MienTask = CFUNCTYPE(None, c_void_p, c_uint32)


class MienError(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("byte_offset", c_uint64),
        ("status", c_int32),
        ("message", c_char * 236),
    ]
    struct_size: Any
    byte_offset: Any
    status: Any
    message: Any

    def __init__(self) -> None:
        super().__init__(256)


class MienAllocator(Structure):
    _fields_ = [
        ("user", c_void_p),
        ("allocate", CFUNCTYPE(c_void_p, c_void_p, c_size_t, c_size_t)),
        ("release", CFUNCTYPE(None, c_void_p, c_void_p, c_size_t, c_size_t)),
    ]
    user: Any
    allocate: Any
    release: Any


class MienParallelFor(Structure):
    _fields_ = [
        ("user", c_void_p),
        ("run", CFUNCTYPE(None, c_void_p, c_uint32, MienTask, c_void_p)),
    ]
    user: Any
    run: Any


class MienStringView(Structure):
    _fields_ = [
        ("data", c_void_p),
        ("count", c_size_t),
    ]
    data: Any
    count: Any


class MienFloatView(Structure):
    _fields_ = [
        ("data", c_void_p),
        ("count", c_size_t),
    ]
    data: Any
    count: Any


class MienMutableFloatView(Structure):
    _fields_ = [
        ("data", c_void_p),
        ("count", c_size_t),
    ]
    data: Any
    count: Any


class MienIndex16View(Structure):
    _fields_ = [
        ("data", c_void_p),
        ("count", c_size_t),
    ]
    data: Any
    count: Any


class MienIndex32View(Structure):
    _fields_ = [
        ("data", c_void_p),
        ("count", c_size_t),
    ]
    data: Any
    count: Any


class MienStream(Structure):
    _fields_ = [
        ("user", c_void_p),
        ("size", c_uint64),
        ("read", CFUNCTYPE(c_size_t, c_void_p, c_uint64, c_void_p, c_size_t)),
    ]
    user: Any
    size: Any
    read: Any


class MienCoordinateSystem(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("axes", c_uint32 * 3),
        ("translation_unit", c_uint32),
        ("rotation_unit", c_uint32),
        ("rotation_rule", c_uint32),
        ("rotation_sequence", c_uint32),
        ("rotation_signs", c_int32 * 3),
        ("face_winding", c_uint32),
        ("reserved", c_uint32),
    ]
    struct_size: Any
    axes: Any
    translation_unit: Any
    rotation_unit: Any
    rotation_rule: Any
    rotation_sequence: Any
    rotation_signs: Any
    face_winding: Any
    reserved: Any

    def __init__(self, *,
                 axes: Tuple[int, int, int] = (0, 0, 0),
                 translation_unit: int = 0,
                 rotation_unit: int = 0,
                 rotation_rule: int = 0,
                 rotation_sequence: int = 0,
                 rotation_signs: Tuple[int, int, int] = (0, 0, 0),
                 face_winding: int = 0) -> None:
        super().__init__(56)
        self.axes = axes
        self.translation_unit = translation_unit
        self.rotation_unit = rotation_unit
        self.rotation_rule = rotation_rule
        self.rotation_sequence = rotation_sequence
        self.rotation_signs = rotation_signs
        self.face_winding = face_winding


class MienDnaDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("layers", c_uint32),
        ("skip_blend_shape_targets", c_uint32),
        ("unknown_layers", c_uint32),
        ("file_access", c_uint32),
        ("lods", c_uint64),
        ("system", POINTER(MienCoordinateSystem)),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    layers: Any
    skip_blend_shape_targets: Any
    unknown_layers: Any
    file_access: Any
    lods: Any
    system: Any
    allocator: Any

    def __init__(self, *,
                 layers: int = 0,
                 skip_blend_shape_targets: bool = False,
                 unknown_layers: int = 0,
                 file_access: int = 0,
                 lods: int = 0,
                 system: Any = None,
                 allocator: Any = None) -> None:
        super().__init__(48)
        self.layers = layers
        self.skip_blend_shape_targets = skip_blend_shape_targets
        self.unknown_layers = unknown_layers
        self.file_access = file_access
        self.lods = lods
        self.system = system
        self.allocator = allocator


class MienDnaInfo(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("generation", c_uint32),
        ("version", c_uint32),
        ("layers", c_uint32),
        ("has_blend_shape_targets", c_uint32),
        ("file_bytes", c_uint64),
        ("memory_bytes", c_uint64),
        ("is_mapped", c_uint32),
        ("layer_count", c_uint32),
        ("translation_unit", c_uint32),
        ("rotation_unit", c_uint32),
        ("axes", c_uint32 * 3),
        ("rotation_sequence", c_uint32),
        ("rotation_signs", c_int32 * 3),
        ("face_winding", c_uint32),
        ("lod_count", c_uint32),
        ("max_lod", c_uint32),
        ("gui_control_count", c_uint32),
        ("raw_control_count", c_uint32),
        ("psd_control_count", c_uint32),
        ("ml_control_count", c_uint32),
        ("rbf_control_count", c_uint32),
        ("joint_count", c_uint32),
        ("joint_group_count", c_uint32),
        ("blend_shape_channel_count", c_uint32),
        ("animated_map_count", c_uint32),
        ("mesh_count", c_uint32),
        ("neural_network_count", c_uint32),
        ("rbf_solver_count", c_uint32),
        ("rbf_pose_count", c_uint32),
        ("twist_count", c_uint32),
        ("swing_count", c_uint32),
        ("metadata_count", c_uint32),
    ]
    struct_size: Any
    generation: Any
    version: Any
    layers: Any
    has_blend_shape_targets: Any
    file_bytes: Any
    memory_bytes: Any
    is_mapped: Any
    layer_count: Any
    translation_unit: Any
    rotation_unit: Any
    axes: Any
    rotation_sequence: Any
    rotation_signs: Any
    face_winding: Any
    lod_count: Any
    max_lod: Any
    gui_control_count: Any
    raw_control_count: Any
    psd_control_count: Any
    ml_control_count: Any
    rbf_control_count: Any
    joint_count: Any
    joint_group_count: Any
    blend_shape_channel_count: Any
    animated_map_count: Any
    mesh_count: Any
    neural_network_count: Any
    rbf_solver_count: Any
    rbf_pose_count: Any
    twist_count: Any
    swing_count: Any
    metadata_count: Any

    def __init__(self) -> None:
        super().__init__(160)


class MienDnaLayer(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("layer", c_uint32),
        ("version_major", c_uint32),
        ("version_minor", c_uint32),
        ("is_loaded", c_uint32),
        ("byte_offset", c_uint64),
        ("byte_count", c_uint64),
        ("code", c_char * 8),
    ]
    struct_size: Any
    layer: Any
    version_major: Any
    version_minor: Any
    is_loaded: Any
    byte_offset: Any
    byte_count: Any
    code: Any

    def __init__(self) -> None:
        super().__init__(48)


class MienDnaField(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("type", c_uint32),
        ("is_array", c_uint32),
        ("count", c_uint64),
        ("byte_offset", c_uint64),
    ]
    struct_size: Any
    type: Any
    is_array: Any
    count: Any
    byte_offset: Any

    def __init__(self) -> None:
        super().__init__(32)


class MienWriteDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("version", c_uint32),
        ("unknown_layers", c_uint32),
    ]
    struct_size: Any
    version: Any
    unknown_layers: Any

    def __init__(self, *,
                 version: int = 0,
                 unknown_layers: int = 0) -> None:
        super().__init__(16)
        self.version = version
        self.unknown_layers = unknown_layers


class MienFinding(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("severity", c_uint32),
        ("status", c_int32),
        ("byte_offset", c_uint64),
        ("field", MienStringView),
        ("message", MienStringView),
    ]
    struct_size: Any
    severity: Any
    status: Any
    byte_offset: Any
    field: Any
    message: Any

    def __init__(self) -> None:
        super().__init__(56)


class MienValidateDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    allocator: Any

    def __init__(self, *,
                 allocator: Any = None) -> None:
        super().__init__(16)
        self.allocator = allocator


class MienRigDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("isa", c_uint32),
        ("rotation_output", c_uint32),
        ("ml_masks", c_uint32),
        ("storage", c_uint32),
        ("reuse", c_uint32),
        ("arithmetic", c_uint32),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    isa: Any
    rotation_output: Any
    ml_masks: Any
    storage: Any
    reuse: Any
    arithmetic: Any
    allocator: Any

    def __init__(self, *,
                 isa: int = 0,
                 rotation_output: int = 0,
                 ml_masks: int = 0,
                 storage: int = 0,
                 reuse: int = 0,
                 arithmetic: int = 0,
                 allocator: Any = None) -> None:
        super().__init__(40)
        self.isa = isa
        self.rotation_output = rotation_output
        self.ml_masks = ml_masks
        self.storage = storage
        self.reuse = reuse
        self.arithmetic = arithmetic
        self.allocator = allocator


class MienRigInfo(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("isa", c_uint32),
        ("lod_count", c_uint32),
        ("translation_unit", c_uint32),
        ("rotation_unit", c_uint32),
        ("axes", c_uint32 * 3),
        ("rotation_sequence", c_uint32),
        ("rotation_signs", c_int32 * 3),
        ("control_count", c_uint32),
        ("joint_value_count", c_uint32),
        ("rotation_output", c_uint32),
        ("storage", c_uint32),
        ("arithmetic", c_uint32),
        ("rig_bytes", c_uint64),
        ("instance_bytes", c_uint64),
    ]
    struct_size: Any
    isa: Any
    lod_count: Any
    translation_unit: Any
    rotation_unit: Any
    axes: Any
    rotation_sequence: Any
    rotation_signs: Any
    control_count: Any
    joint_value_count: Any
    rotation_output: Any
    storage: Any
    arithmetic: Any
    rig_bytes: Any
    instance_bytes: Any

    def __init__(self) -> None:
        super().__init__(88)


class MienRigStatistics(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("lod", c_uint32),
        ("psd_count", c_uint32),
        ("joint_count", c_uint32),
        ("joint_row_count", c_uint32),
        ("blend_shape_count", c_uint32),
        ("animated_map_row_count", c_uint32),
        ("rbf_solver_count", c_uint32),
        ("quaternion_joint_count", c_uint32),
        ("joint_entry_count", c_uint64),
        ("joint_byte_count", c_uint64),
    ]
    struct_size: Any
    lod: Any
    psd_count: Any
    joint_count: Any
    joint_row_count: Any
    blend_shape_count: Any
    animated_map_row_count: Any
    rbf_solver_count: Any
    quaternion_joint_count: Any
    joint_entry_count: Any
    joint_byte_count: Any

    def __init__(self) -> None:
        super().__init__(56)


class MienInstanceDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    allocator: Any

    def __init__(self, *,
                 allocator: Any = None) -> None:
        super().__init__(16)
        self.allocator = allocator


class MienInstanceStatistics(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("lod", c_uint32),
        ("control_count", c_uint32),
        ("active_control_count", c_uint32),
        ("joint_column_count", c_uint32),
        ("joint_entry_count", c_uint64),
        ("joint_byte_count", c_uint64),
    ]
    struct_size: Any
    lod: Any
    control_count: Any
    active_control_count: Any
    joint_column_count: Any
    joint_entry_count: Any
    joint_byte_count: Any

    def __init__(self) -> None:
        super().__init__(40)


class MienBatchDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("capacity", c_uint32),
        ("tasks", c_uint32),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    capacity: Any
    tasks: Any
    allocator: Any

    def __init__(self, *,
                 capacity: int = 0,
                 tasks: int = 0,
                 allocator: Any = None) -> None:
        super().__init__(24)
        self.capacity = capacity
        self.tasks = tasks
        self.allocator = allocator


class MienDeformerDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("isa", c_uint32),
        ("compose", c_uint32),
        ("weights", c_uint32),
        ("normals", c_uint32),
        ("with_tangents", c_uint32),
        ("storage", c_uint32),
        ("allocator", POINTER(MienAllocator)),
        ("delta_error", c_double),
    ]
    struct_size: Any
    isa: Any
    compose: Any
    weights: Any
    normals: Any
    with_tangents: Any
    storage: Any
    allocator: Any
    delta_error: Any

    def __init__(self, *,
                 isa: int = 0,
                 compose: int = 0,
                 weights: int = 0,
                 normals: int = 0,
                 with_tangents: bool = False,
                 storage: int = 0,
                 allocator: Any = None,
                 delta_error: float = 0) -> None:
        super().__init__(48)
        self.isa = isa
        self.compose = compose
        self.weights = weights
        self.normals = normals
        self.with_tangents = with_tangents
        self.storage = storage
        self.allocator = allocator
        self.delta_error = delta_error


class MienDeformerInfo(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("isa", c_uint32),
        ("compose", c_uint32),
        ("weights", c_uint32),
        ("normals", c_uint32),
        ("lod_count", c_uint32),
        ("joint_count", c_uint32),
        ("channel_count", c_uint32),
        ("mesh_count", c_uint32),
        ("deformer_bytes", c_uint64),
        ("instance_bytes", c_uint64),
        ("storage", c_uint32),
        ("reserved", c_uint32),
    ]
    struct_size: Any
    isa: Any
    compose: Any
    weights: Any
    normals: Any
    lod_count: Any
    joint_count: Any
    channel_count: Any
    mesh_count: Any
    deformer_bytes: Any
    instance_bytes: Any
    storage: Any
    reserved: Any

    def __init__(self) -> None:
        super().__init__(64)


class MienMesh(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("position_count", c_uint32),
        ("vertex_count", c_uint32),
        ("triangle_count", c_uint32),
        ("max_influences", c_uint32),
        ("target_count", c_uint32),
        ("delta_count", c_uint32),
        ("lods", c_uint64),
        ("positions", MienFloatView),
        ("normals", MienFloatView),
        ("tangents", MienFloatView),
        ("texture_coordinates", MienFloatView),
        ("vertex_position_indices", MienIndex32View),
        ("triangles", MienIndex32View),
        ("target_channels", MienIndex16View),
    ]
    struct_size: Any
    position_count: Any
    vertex_count: Any
    triangle_count: Any
    max_influences: Any
    target_count: Any
    delta_count: Any
    lods: Any
    positions: Any
    normals: Any
    tangents: Any
    texture_coordinates: Any
    vertex_position_indices: Any
    triangles: Any
    target_channels: Any

    def __init__(self) -> None:
        super().__init__(152)


class MienDeformerInstanceDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("lods", c_uint64),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    lods: Any
    allocator: Any

    def __init__(self, *,
                 lods: int = 0,
                 allocator: Any = None) -> None:
        super().__init__(24)
        self.lods = lods
        self.allocator = allocator


class MienVertexStream(Structure):
    _fields_ = [
        ("data", c_void_p),
        ("stride", c_uint32),
        ("format", c_uint32),
    ]
    data: Any
    stride: Any
    format: Any


class MienVertexOutput(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("vertex_capacity", c_size_t),
        ("positions", MienVertexStream),
        ("normals", MienVertexStream),
        ("tangents", MienVertexStream),
    ]
    struct_size: Any
    vertex_capacity: Any
    positions: Any
    normals: Any
    tangents: Any

    def __init__(self, *,
                 vertex_capacity: int = 0,
                 positions: Any = MienVertexStream(),
                 normals: Any = MienVertexStream(),
                 tangents: Any = MienVertexStream()) -> None:
        super().__init__(64)
        self.vertex_capacity = vertex_capacity
        self.positions = positions
        self.normals = normals
        self.tangents = tangents


class MienDerivativesDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("deformer", MienDeformer),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    deformer: Any
    allocator: Any

    def __init__(self, *,
                 deformer: Any = None,
                 allocator: Any = None) -> None:
        super().__init__(24)
        self.deformer = deformer
        self.allocator = allocator


class MienJacobianDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("from_point", c_uint32),
        ("to_point", c_uint32),
        ("mesh", c_uint32),
        ("lod", c_uint32),
        ("inputs", c_void_p),
        ("outputs", c_void_p),
        ("input_count", c_size_t),
        ("output_count", c_size_t),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    from_point: Any
    to_point: Any
    mesh: Any
    lod: Any
    inputs: Any
    outputs: Any
    input_count: Any
    output_count: Any
    allocator: Any

    def __init__(self, *,
                 from_point: int = 0,
                 to_point: int = 0,
                 mesh: int = 0,
                 lod: int = 0,
                 inputs: Any = None,
                 outputs: Any = None,
                 input_count: int = 0,
                 output_count: int = 0,
                 allocator: Any = None) -> None:
        super().__init__(64)
        self.from_point = from_point
        self.to_point = to_point
        self.mesh = mesh
        self.lod = lod
        self.inputs = inputs
        self.outputs = outputs
        self.input_count = input_count
        self.output_count = output_count
        self.allocator = allocator


class MienJacobianPattern(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("rows", MienIndex32View),
        ("columns", MienIndex32View),
        ("row_count", c_size_t),
        ("column_count", c_size_t),
        ("direction_count", c_size_t),
    ]
    struct_size: Any
    rows: Any
    columns: Any
    row_count: Any
    column_count: Any
    direction_count: Any

    def __init__(self) -> None:
        super().__init__(64)


class MienBakedDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("file_access", c_uint32),
        ("check", c_uint32),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    file_access: Any
    check: Any
    allocator: Any

    def __init__(self, *,
                 file_access: int = 0,
                 check: int = 0,
                 allocator: Any = None) -> None:
        super().__init__(24)
        self.file_access = file_access
        self.check = check
        self.allocator = allocator


class MienBakedInfo(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("file_bytes", c_uint64),
        ("memory_bytes", c_uint64),
        ("rig_bytes", c_uint64),
        ("deformer_bytes", c_uint64),
        ("part_count", c_uint32),
        ("is_mapped", c_uint32),
    ]
    struct_size: Any
    file_bytes: Any
    memory_bytes: Any
    rig_bytes: Any
    deformer_bytes: Any
    part_count: Any
    is_mapped: Any

    def __init__(self) -> None:
        super().__init__(48)


class MienBakedRigDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("isa", c_uint32),
        ("reuse", c_uint32),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    isa: Any
    reuse: Any
    allocator: Any

    def __init__(self, *,
                 isa: int = 0,
                 reuse: int = 0,
                 allocator: Any = None) -> None:
        super().__init__(24)
        self.isa = isa
        self.reuse = reuse
        self.allocator = allocator


class MienBakedDeformerDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("isa", c_uint32),
        ("normals", c_uint32),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    isa: Any
    normals: Any
    allocator: Any

    def __init__(self, *,
                 isa: int = 0,
                 normals: int = 0,
                 allocator: Any = None) -> None:
        super().__init__(24)
        self.isa = isa
        self.normals = normals
        self.allocator = allocator


class MienClipEvent(Structure):
    _fields_ = [
        ("tick", c_int64),
        ("name", MienStringView),
        ("value", c_float),
        ("reserved", c_uint32),
    ]
    tick: Any
    name: Any
    value: Any
    reserved: Any


class MienClipDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("rate_numerator", c_uint32),
        ("rate_denominator", c_uint32),
        ("frame_count", c_uint32),
        ("channel_count", c_uint32),
        ("names", POINTER(MienStringView)),
        ("values", c_void_p),
        ("frame_stride", c_size_t),
        ("snaps", c_void_p),
        ("snap", c_float),
        ("looping", c_uint32),
        ("is_delta", c_uint32),
        ("event_count", c_uint32),
        ("events", POINTER(MienClipEvent)),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    rate_numerator: Any
    rate_denominator: Any
    frame_count: Any
    channel_count: Any
    names: Any
    values: Any
    frame_stride: Any
    snaps: Any
    snap: Any
    looping: Any
    is_delta: Any
    event_count: Any
    events: Any
    allocator: Any

    def __init__(self, *,
                 rate_numerator: int = 0,
                 rate_denominator: int = 0,
                 frame_count: int = 0,
                 channel_count: int = 0,
                 names: Any = None,
                 values: Any = None,
                 frame_stride: int = 0,
                 snaps: Any = None,
                 snap: float = 0,
                 looping: int = 0,
                 is_delta: bool = False,
                 event_count: int = 0,
                 events: Any = None,
                 allocator: Any = None) -> None:
        super().__init__(88)
        self.rate_numerator = rate_numerator
        self.rate_denominator = rate_denominator
        self.frame_count = frame_count
        self.channel_count = channel_count
        self.names = names
        self.values = values
        self.frame_stride = frame_stride
        self.snaps = snaps
        self.snap = snap
        self.looping = looping
        self.is_delta = is_delta
        self.event_count = event_count
        self.events = events
        self.allocator = allocator


class MienClipOpenDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("file_access", c_uint32),
        ("reserved", c_uint32),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    file_access: Any
    reserved: Any
    allocator: Any

    def __init__(self, *,
                 file_access: int = 0,
                 allocator: Any = None) -> None:
        super().__init__(24)
        self.file_access = file_access
        self.allocator = allocator


class MienClipInfo(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("rate_numerator", c_uint32),
        ("rate_denominator", c_uint32),
        ("frame_count", c_uint32),
        ("channel_count", c_uint32),
        ("changing_channel_count", c_uint32),
        ("event_count", c_uint32),
        ("looping", c_uint32),
        ("is_delta", c_uint32),
        ("snap", c_float),
        ("is_mapped", c_uint32),
        ("ticks_per_frame", c_int64),
        ("length", c_int64),
        ("file_bytes", c_uint64),
        ("memory_bytes", c_uint64),
        ("player_bytes", c_uint64),
    ]
    struct_size: Any
    rate_numerator: Any
    rate_denominator: Any
    frame_count: Any
    channel_count: Any
    changing_channel_count: Any
    event_count: Any
    looping: Any
    is_delta: Any
    snap: Any
    is_mapped: Any
    ticks_per_frame: Any
    length: Any
    file_bytes: Any
    memory_bytes: Any
    player_bytes: Any

    def __init__(self) -> None:
        super().__init__(88)


class MienClipChannel(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("name", MienStringView),
        ("rest", c_float),
        ("is_changing", c_uint32),
        ("zero_blocks", c_uint32),
        ("constant_blocks", c_uint32),
        ("grid_blocks", c_uint32),
        ("float_blocks", c_uint32),
        ("bits", c_uint64),
        ("max_error", c_float),
        ("reserved", c_uint32),
    ]
    struct_size: Any
    name: Any
    rest: Any
    is_changing: Any
    zero_blocks: Any
    constant_blocks: Any
    grid_blocks: Any
    float_blocks: Any
    bits: Any
    max_error: Any
    reserved: Any

    def __init__(self) -> None:
        super().__init__(64)


class MienClipPlayerDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("looping", c_uint32),
        ("interpolation", c_uint32),
        ("speed_numerator", c_int32),
        ("speed_denominator", c_int32),
        ("start_tick", c_int64),
        ("reverse", c_uint32),
        ("reserved", c_uint32),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    looping: Any
    interpolation: Any
    speed_numerator: Any
    speed_denominator: Any
    start_tick: Any
    reverse: Any
    reserved: Any
    allocator: Any

    def __init__(self, *,
                 looping: int = 0,
                 interpolation: int = 0,
                 speed_numerator: int = 0,
                 speed_denominator: int = 0,
                 start_tick: int = 0,
                 reverse: bool = False,
                 allocator: Any = None) -> None:
        super().__init__(48)
        self.looping = looping
        self.interpolation = interpolation
        self.speed_numerator = speed_numerator
        self.speed_denominator = speed_denominator
        self.start_tick = start_tick
        self.reverse = reverse
        self.allocator = allocator


class MienClipPlayerInfo(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("tick", c_int64),
        ("loops", c_int64),
        ("looping", c_uint32),
        ("is_damaged", c_uint32),
    ]
    struct_size: Any
    tick: Any
    loops: Any
    looping: Any
    is_damaged: Any

    def __init__(self) -> None:
        super().__init__(32)


class MienMatrixEntry(Structure):
    _fields_ = [
        ("channel", MienStringView),
        ("control", MienStringView),
        ("weight", c_float),
        ("reserved", c_uint32),
    ]
    channel: Any
    control: Any
    weight: Any
    reserved: Any


class MienClipBindingDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("matrix", POINTER(MienMatrixEntry)),
        ("matrix_count", c_size_t),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    matrix: Any
    matrix_count: Any
    allocator: Any

    def __init__(self, *,
                 matrix: Any = None,
                 matrix_count: int = 0,
                 allocator: Any = None) -> None:
        super().__init__(32)
        self.matrix = matrix
        self.matrix_count = matrix_count
        self.allocator = allocator


class MienClipBindingInfo(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("channel_count", c_uint32),
        ("raw_control_count", c_uint32),
        ("missing_entry_count", c_uint32),
        ("reserved", c_uint32),
        ("controls", MienIndex16View),
        ("extra_controls", MienIndex16View),
        ("missing_channels", MienIndex16View),
    ]
    struct_size: Any
    channel_count: Any
    raw_control_count: Any
    missing_entry_count: Any
    reserved: Any
    controls: Any
    extra_controls: Any
    missing_channels: Any

    def __init__(self) -> None:
        super().__init__(72)


class MienMixLayer(Structure):
    _fields_ = [
        ("period", c_int64),
        ("delay", c_int64),
        ("mask", c_void_p),
        ("curves", c_void_p),
        ("amounts", c_void_p),
        ("mask_count", c_uint32),
        ("curve_count", c_uint32),
        ("group", c_uint32),
        ("mode", c_uint32),
        ("source", c_uint32),
        ("after_guards", c_uint32),
        ("weight", c_float),
        ("first_pose", c_uint32),
        ("pose_count", c_uint32),
        ("generator", c_uint32),
        ("stream_frames", c_uint32),
        ("reserved", c_uint32),
    ]
    period: Any
    delay: Any
    mask: Any
    curves: Any
    amounts: Any
    mask_count: Any
    curve_count: Any
    group: Any
    mode: Any
    source: Any
    after_guards: Any
    weight: Any
    first_pose: Any
    pose_count: Any
    generator: Any
    stream_frames: Any
    reserved: Any


class MienMixPose(Structure):
    _fields_ = [
        ("curves", c_void_p),
        ("values", c_void_p),
        ("count", c_size_t),
    ]
    curves: Any
    values: Any
    count: Any


class MienMixStroke(Structure):
    _fields_ = [
        ("delay", c_int64),
        ("attack", c_int64),
        ("hold", c_int64),
        ("release", c_int64),
        ("pose", c_uint32),
        ("mode", c_uint32),
        ("is_held", c_uint32),
        ("is_lag", c_uint32),
        ("is_scaled", c_uint32),
        ("reserved", c_uint32),
    ]
    delay: Any
    attack: Any
    hold: Any
    release: Any
    pose: Any
    mode: Any
    is_held: Any
    is_lag: Any
    is_scaled: Any
    reserved: Any


class MienMixReaction(Structure):
    _fields_ = [
        ("cooldown", c_int64),
        ("adapt_ticks", c_int64),
        ("recover_ticks", c_int64),
        ("strokes", POINTER(MienMixStroke)),
        ("stroke_count", c_size_t),
        ("retrigger", c_uint32),
        ("after_guards", c_uint32),
        ("adapted", c_float),
        ("level_on", c_float),
        ("level_off", c_float),
        ("reserved", c_uint32),
    ]
    cooldown: Any
    adapt_ticks: Any
    recover_ticks: Any
    strokes: Any
    stroke_count: Any
    retrigger: Any
    after_guards: Any
    adapted: Any
    level_on: Any
    level_off: Any
    reserved: Any


class MienMixAntagonists(Structure):
    _fields_ = [
        ("first", c_uint16),
        ("second", c_uint16),
        ("stiffness", c_float),
    ]
    first: Any
    second: Any
    stiffness: Any


class MienLandmark(Structure):
    _fields_ = [
        ("points", c_void_p),
        ("point_count", c_uint32),
        ("mesh", c_uint32),
    ]
    points: Any
    point_count: Any
    mesh: Any


class MienMixGuard(Structure):
    _fields_ = [
        ("upper", MienLandmark),
        ("lower", MienLandmark),
        ("closed_by", c_uint32),
        ("needs_speech", c_uint32),
        ("tolerance", c_float),
        ("f_on", c_float),
    ]
    upper: Any
    lower: Any
    closed_by: Any
    needs_speech: Any
    tolerance: Any
    f_on: Any


class MienMixDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("layers", POINTER(MienMixLayer)),
        ("layer_count", c_size_t),
        ("poses", POINTER(MienMixPose)),
        ("pose_count", c_size_t),
        ("reactions", POINTER(MienMixReaction)),
        ("reaction_count", c_size_t),
        ("antagonists", POINTER(MienMixAntagonists)),
        ("antagonist_count", c_size_t),
        ("mirror", c_void_p),
        ("lower", c_void_p),
        ("upper", c_void_p),
        ("custom_guards", POINTER(MienMixGuard)),
        ("custom_guard_count", c_size_t),
        ("gaze", MienGaze),
        ("deformer", MienDeformer),
        ("guards", c_uint32),
        ("variable_count", c_uint32),
        ("player_count", c_uint32),
        ("max_channels", c_uint32),
        ("max_changing_channels", c_uint32),
        ("max_events", c_uint32),
        ("reverse", c_uint32),
        ("reserved", c_uint32),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    layers: Any
    layer_count: Any
    poses: Any
    pose_count: Any
    reactions: Any
    reaction_count: Any
    antagonists: Any
    antagonist_count: Any
    mirror: Any
    lower: Any
    upper: Any
    custom_guards: Any
    custom_guard_count: Any
    gaze: Any
    deformer: Any
    guards: Any
    variable_count: Any
    player_count: Any
    max_channels: Any
    max_changing_channels: Any
    max_events: Any
    reverse: Any
    reserved: Any
    allocator: Any

    def __init__(self, *,
                 layers: Any = None,
                 layer_count: int = 0,
                 poses: Any = None,
                 pose_count: int = 0,
                 reactions: Any = None,
                 reaction_count: int = 0,
                 antagonists: Any = None,
                 antagonist_count: int = 0,
                 mirror: Any = None,
                 lower: Any = None,
                 upper: Any = None,
                 custom_guards: Any = None,
                 custom_guard_count: int = 0,
                 gaze: Any = None,
                 deformer: Any = None,
                 guards: int = 0,
                 variable_count: int = 0,
                 player_count: int = 0,
                 max_channels: int = 0,
                 max_changing_channels: int = 0,
                 max_events: int = 0,
                 reverse: bool = False,
                 allocator: Any = None) -> None:
        super().__init__(168)
        self.layers = layers
        self.layer_count = layer_count
        self.poses = poses
        self.pose_count = pose_count
        self.reactions = reactions
        self.reaction_count = reaction_count
        self.antagonists = antagonists
        self.antagonist_count = antagonist_count
        self.mirror = mirror
        self.lower = lower
        self.upper = upper
        self.custom_guards = custom_guards
        self.custom_guard_count = custom_guard_count
        self.gaze = gaze
        self.deformer = deformer
        self.guards = guards
        self.variable_count = variable_count
        self.player_count = player_count
        self.max_channels = max_channels
        self.max_changing_channels = max_changing_channels
        self.max_events = max_events
        self.reverse = reverse
        self.allocator = allocator


class MienMixOpenDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    allocator: Any

    def __init__(self, *,
                 allocator: Any = None) -> None:
        super().__init__(16)
        self.allocator = allocator


class MienMixInfo(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("raw_control_count", c_uint32),
        ("variable_count", c_uint32),
        ("curve_count", c_uint32),
        ("layer_count", c_uint32),
        ("stage_count", c_uint32),
        ("guard_count", c_uint32),
        ("mixer_bytes", c_uint64),
        ("snapshot_bytes", c_uint64),
    ]
    struct_size: Any
    raw_control_count: Any
    variable_count: Any
    curve_count: Any
    layer_count: Any
    stage_count: Any
    guard_count: Any
    mixer_bytes: Any
    snapshot_bytes: Any

    def __init__(self) -> None:
        super().__init__(48)


class MienMixGuardInfo(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("curves", MienIndex16View),
        ("gains", MienFloatView),
        ("pair_count", c_uint32),
        ("needs_speech", c_uint32),
        ("rest", c_float),
        ("tolerance", c_float),
        ("f_on", c_float),
        ("fit_error", c_float),
    ]
    struct_size: Any
    curves: Any
    gains: Any
    pair_count: Any
    needs_speech: Any
    rest: Any
    tolerance: Any
    f_on: Any
    fit_error: Any

    def __init__(self) -> None:
        super().__init__(64)


class MienGazeDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("left_eye", c_void_p),
        ("right_eye", c_void_p),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    left_eye: Any
    right_eye: Any
    allocator: Any

    def __init__(self, *,
                 left_eye: Any = None,
                 right_eye: Any = None,
                 allocator: Any = None) -> None:
        super().__init__(32)
        self.left_eye = left_eye
        self.right_eye = right_eye
        self.allocator = allocator


class MienGazeTarget(Structure):
    _fields_ = [
        ("left", c_float),
        ("up", c_float),
        ("front", c_float),
    ]
    left: Any
    up: Any
    front: Any


class MienGazeInfo(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("left_eye", MienGazeTarget),
        ("right_eye", MienGazeTarget),
        ("fit_error", c_float),
        ("reserved", c_uint32),
    ]
    struct_size: Any
    left_eye: Any
    right_eye: Any
    fit_error: Any
    reserved: Any

    def __init__(self) -> None:
        super().__init__(40)


class MienGazeRest(Structure):
    _fields_ = [
        ("left", c_float),
        ("up", c_float),
    ]
    left: Any
    up: Any


class MienMixerDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("seed", c_uint64),
        ("stages", c_uint32),
        ("reserved", c_uint32),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    seed: Any
    stages: Any
    reserved: Any
    allocator: Any

    def __init__(self, *,
                 seed: int = 0,
                 stages: bool = False,
                 allocator: Any = None) -> None:
        super().__init__(32)
        self.seed = seed
        self.stages = stages
        self.allocator = allocator


class MienPlayDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("clip_id", c_uint64),
        ("start_tick", c_int64),
        ("transition_ticks", c_int64),
        ("transition", c_uint32),
        ("looping", c_uint32),
        ("interpolation", c_uint32),
        ("speed_numerator", c_int32),
        ("speed_denominator", c_int32),
        ("mirrored", c_uint32),
    ]
    struct_size: Any
    clip_id: Any
    start_tick: Any
    transition_ticks: Any
    transition: Any
    looping: Any
    interpolation: Any
    speed_numerator: Any
    speed_denominator: Any
    mirrored: Any

    def __init__(self, *,
                 clip_id: int = 0,
                 start_tick: int = 0,
                 transition_ticks: int = 0,
                 transition: int = 0,
                 looping: int = 0,
                 interpolation: int = 0,
                 speed_numerator: int = 0,
                 speed_denominator: int = 0,
                 mirrored: bool = False) -> None:
        super().__init__(56)
        self.clip_id = clip_id
        self.start_tick = start_tick
        self.transition_ticks = transition_ticks
        self.transition = transition
        self.looping = looping
        self.interpolation = interpolation
        self.speed_numerator = speed_numerator
        self.speed_denominator = speed_denominator
        self.mirrored = mirrored


class MienGuardState(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("name", MienStringView),
        ("controls", MienIndex16View),
        ("kind", c_uint32),
        ("activation", c_float),
        ("protected_distance", c_float),
        ("wanted", c_float),
        ("limit", c_float),
        ("distance", c_float),
    ]
    struct_size: Any
    name: Any
    controls: Any
    kind: Any
    activation: Any
    protected_distance: Any
    wanted: Any
    limit: Any
    distance: Any

    def __init__(self) -> None:
        super().__init__(64)


class MienMixerInfo(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("tick", c_int64),
        ("event_count", c_uint32),
        ("lost_events", c_uint32),
    ]
    struct_size: Any
    tick: Any
    event_count: Any
    lost_events: Any

    def __init__(self) -> None:
        super().__init__(24)


class MienMixerClip(Structure):
    _fields_ = [
        ("clip_id", c_uint64),
        ("clip", MienClip),
        ("clip_binding", MienClipBinding),
    ]
    clip_id: Any
    clip: Any
    clip_binding: Any


class MienAimSolver(Structure):
    _fields_ = [
        ("joint", c_uint32),
        ("target_joint", c_uint32),
        ("target_curve", c_uint32),
        ("axis", c_float * 3),
        ("up_axis", c_float * 3),
        ("up", c_float * 3),
        ("cone_degrees", c_float),
        ("weight", c_float),
    ]
    joint: Any
    target_joint: Any
    target_curve: Any
    axis: Any
    up_axis: Any
    up: Any
    cone_degrees: Any
    weight: Any


class MienSpaceSolver(Structure):
    _fields_ = [
        ("ease_ticks", c_int64),
        ("spaces", c_void_p),
        ("space_count", c_uint32),
        ("curve", c_uint32),
        ("joint", c_uint32),
        ("reserved", c_uint32),
    ]
    ease_ticks: Any
    spaces: Any
    space_count: Any
    curve: Any
    joint: Any
    reserved: Any


class MienSpringSolver(Structure):
    _fields_ = [
        ("joint", c_uint32),
        ("frequency", c_float),
        ("damping", c_float),
        ("rest_offset", c_float * 3),
        ("stretch", c_float),
        ("teleport", c_float),
    ]
    joint: Any
    frequency: Any
    damping: Any
    rest_offset: Any
    stretch: Any
    teleport: Any


class MienTwistSolver(Structure):
    _fields_ = [
        ("joints", c_void_p),
        ("shares", c_void_p),
        ("joint_count", c_uint32),
        ("source", c_uint32),
        ("axis", c_float * 3),
        ("reserved", c_uint32),
    ]
    joints: Any
    shares: Any
    joint_count: Any
    source: Any
    axis: Any
    reserved: Any


class MienCopySolver(Structure):
    _fields_ = [
        ("source", c_uint32),
        ("joint", c_uint32),
        ("is_mirrored", c_uint32),
        ("mirror_axis", c_float * 3),
        ("weight", c_float),
    ]
    source: Any
    joint: Any
    is_mirrored: Any
    mirror_axis: Any
    weight: Any


class MienSolverPose(Structure):
    _fields_ = [
        ("locals", c_void_p),
        ("models", c_void_p),
        ("previous", c_void_p),
        ("row", c_void_p),
        ("outputs", c_void_p),
        ("state", c_void_p),
        ("lod", c_uint32),
        ("is_reset", c_uint32),
    ]
    locals: Any
    models: Any
    previous: Any
    row: Any
    outputs: Any
    state: Any
    lod: Any
    is_reset: Any


class MienSolverCall(Structure):
    _fields_ = [
        ("poses", POINTER(MienSolverPose)),
        ("parents", c_void_p),
        ("ticks", c_int64),
        ("pose_count", c_uint32),
        ("joint_count", c_uint32),
    ]
    poses: Any
    parents: Any
    ticks: Any
    pose_count: Any
    joint_count: Any


class MienUserSolver(Structure):
    _fields_ = [
        ("user", c_void_p),
        ("solve", CFUNCTYPE(None, c_void_p, POINTER(MienSolverCall))),
        ("reads", c_void_p),
        ("writes", c_void_p),
        ("previous_joints", c_void_p),
        ("read_count", c_uint32),
        ("write_count", c_uint32),
        ("previous_joint_count", c_uint32),
        ("state_bytes", c_uint32),
        ("output_count", c_uint32),
        ("reserved", c_uint32),
    ]
    user: Any
    solve: Any
    reads: Any
    writes: Any
    previous_joints: Any
    read_count: Any
    write_count: Any
    previous_joint_count: Any
    state_bytes: Any
    output_count: Any
    reserved: Any


class MienSolver(Structure):
    _fields_ = [
        ("name", c_void_p),
        ("aim", POINTER(MienAimSolver)),
        ("space", POINTER(MienSpaceSolver)),
        ("spring", POINTER(MienSpringSolver)),
        ("twist", POINTER(MienTwistSolver)),
        ("copy", POINTER(MienCopySolver)),
        ("custom", POINTER(MienUserSolver)),
        ("lods", c_uint64),
    ]
    name: Any
    aim: Any
    space: Any
    spring: Any
    twist: Any
    copy: Any
    custom: Any
    lods: Any


class MienSolverStackDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("solvers", POINTER(MienSolver)),
        ("solver_count", c_size_t),
        ("curve_count", c_uint32),
        ("check_writes", c_uint32),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    solvers: Any
    solver_count: Any
    curve_count: Any
    check_writes: Any
    allocator: Any

    def __init__(self, *,
                 solvers: Any = None,
                 solver_count: int = 0,
                 curve_count: int = 0,
                 check_writes: bool = False,
                 allocator: Any = None) -> None:
        super().__init__(40)
        self.solvers = solvers
        self.solver_count = solver_count
        self.curve_count = curve_count
        self.check_writes = check_writes
        self.allocator = allocator


class MienSolverStackInfo(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("solver_count", c_uint32),
        ("curve_count", c_uint32),
        ("output_count", c_uint32),
        ("joint_count", c_uint32),
        ("state_bytes", c_uint64),
    ]
    struct_size: Any
    solver_count: Any
    curve_count: Any
    output_count: Any
    joint_count: Any
    state_bytes: Any

    def __init__(self) -> None:
        super().__init__(32)


class MienSolverStateDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    allocator: Any

    def __init__(self, *,
                 allocator: Any = None) -> None:
        super().__init__(16)
        self.allocator = allocator


class MienSolverInput(Structure):
    _fields_ = [
        ("row", c_void_p),
        ("row_count", c_size_t),
        ("lod", c_uint32),
        ("is_reset", c_uint32),
    ]
    row: Any
    row_count: Any
    lod: Any
    is_reset: Any


class MienControlShare(Structure):
    _fields_ = [
        ("control", c_uint32),
        ("weight", c_float),
    ]
    control: Any
    weight: Any


class MienGenerateDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("preset", c_uint32),
        ("flags", c_uint32),
        ("seed", c_uint64),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    preset: Any
    flags: Any
    seed: Any
    allocator: Any

    def __init__(self, *,
                 preset: int = 0,
                 flags: int = 0,
                 seed: int = 0,
                 allocator: Any = None) -> None:
        super().__init__(32)
        self.preset = preset
        self.flags = flags
        self.seed = seed
        self.allocator = allocator


class MienAuthorObject(Structure):
    _fields_ = [
        ("name", MienStringView),
        ("first_face", c_uint32),
        ("face_count", c_uint32),
    ]
    name: Any
    first_face: Any
    face_count: Any


class MienAuthorShape(Structure):
    _fields_ = [
        ("name", MienStringView),
        ("positions", c_void_p),
        ("position_count", c_size_t),
        ("displacements", c_void_p),
    ]
    name: Any
    positions: Any
    position_count: Any
    displacements: Any


class MienAuthorMesh(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("positions", c_void_p),
        ("position_count", c_size_t),
        ("face_sizes", c_void_p),
        ("face_count", c_size_t),
        ("corners", c_void_p),
        ("corner_count", c_size_t),
        ("uvs", c_void_p),
        ("uv_count", c_size_t),
        ("corner_uvs", c_void_p),
        ("objects", POINTER(MienAuthorObject)),
        ("object_count", c_size_t),
        ("shapes", POINTER(MienAuthorShape)),
        ("shape_count", c_size_t),
    ]
    struct_size: Any
    positions: Any
    position_count: Any
    face_sizes: Any
    face_count: Any
    corners: Any
    corner_count: Any
    uvs: Any
    uv_count: Any
    corner_uvs: Any
    objects: Any
    object_count: Any
    shapes: Any
    shape_count: Any

    def __init__(self, *,
                 positions: Any = None,
                 position_count: int = 0,
                 face_sizes: Any = None,
                 face_count: int = 0,
                 corners: Any = None,
                 corner_count: int = 0,
                 uvs: Any = None,
                 uv_count: int = 0,
                 corner_uvs: Any = None,
                 objects: Any = None,
                 object_count: int = 0,
                 shapes: Any = None,
                 shape_count: int = 0) -> None:
        super().__init__(112)
        self.positions = positions
        self.position_count = position_count
        self.face_sizes = face_sizes
        self.face_count = face_count
        self.corners = corners
        self.corner_count = corner_count
        self.uvs = uvs
        self.uv_count = uv_count
        self.corner_uvs = corner_uvs
        self.objects = objects
        self.object_count = object_count
        self.shapes = shapes
        self.shape_count = shape_count


class MienAuthorBone(Structure):
    _fields_ = [
        ("name", MienStringView),
        ("position", c_double * 3),
        ("parent", c_uint32),
        ("kind", c_uint32),
    ]
    name: Any
    position: Any
    parent: Any
    kind: Any


class MienAuthorLandmark(Structure):
    _fields_ = [
        ("name", MienStringView),
        ("position", c_double * 3),
    ]
    name: Any
    position: Any


class MienAuthorLod(Structure):
    _fields_ = [
        ("corners", c_void_p),
        ("corner_count", c_size_t),
        ("corner_uvs", c_void_p),
    ]
    corners: Any
    corner_count: Any
    corner_uvs: Any


class MienAuthorDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("facial_joints", c_uint32),
        ("influences", c_uint32),
        ("lods", c_uint32),
        ("groups", c_uint32),
        ("seed", c_uint64),
        ("unit", c_double),
        ("up", c_uint32),
        ("front", c_uint32),
        ("symmetry", c_uint32),
        ("flags", c_uint32),
        ("name", MienStringView),
        ("face_object", MienStringView),
        ("bones", POINTER(MienAuthorBone)),
        ("bone_count", c_size_t),
        ("weight_joints", c_void_p),
        ("weights", c_void_p),
        ("parallel", POINTER(MienParallelFor)),
        ("progress_user", c_void_p),
        ("progress", CFUNCTYPE(c_int32, c_void_p, c_void_p, c_double)),
        ("allocator", POINTER(MienAllocator)),
        ("depth_groups", c_void_p),
        ("mask", c_void_p),
        ("lod_joints", c_void_p),
        ("bone_groups", c_void_p),
        ("bone_motions", c_void_p),
        ("joint_groups", c_uint32),
        ("overlap_correctives", c_uint32),
        ("lod_triangles", c_double),
        ("lod_meshes", POINTER(MienAuthorLod)),
        ("lod_mesh_count", c_size_t),
        ("landmarks", POINTER(MienAuthorLandmark)),
        ("landmark_count", c_size_t),
    ]
    struct_size: Any
    facial_joints: Any
    influences: Any
    lods: Any
    groups: Any
    seed: Any
    unit: Any
    up: Any
    front: Any
    symmetry: Any
    flags: Any
    name: Any
    face_object: Any
    bones: Any
    bone_count: Any
    weight_joints: Any
    weights: Any
    parallel: Any
    progress_user: Any
    progress: Any
    allocator: Any
    depth_groups: Any
    mask: Any
    lod_joints: Any
    bone_groups: Any
    bone_motions: Any
    joint_groups: Any
    overlap_correctives: Any
    lod_triangles: Any
    lod_meshes: Any
    lod_mesh_count: Any
    landmarks: Any
    landmark_count: Any

    def __init__(self, *,
                 facial_joints: int = 0,
                 influences: int = 0,
                 lods: int = 0,
                 groups: int = 0,
                 seed: int = 0,
                 unit: float = 0,
                 up: int = 0,
                 front: int = 0,
                 symmetry: int = 0,
                 flags: int = 0,
                 name: Any = MienStringView(),
                 face_object: Any = MienStringView(),
                 bones: Any = None,
                 bone_count: int = 0,
                 weight_joints: Any = None,
                 weights: Any = None,
                 parallel: Any = None,
                 progress_user: Any = None,
                 progress: Any = None,
                 allocator: Any = None,
                 depth_groups: Any = None,
                 mask: Any = None,
                 lod_joints: Any = None,
                 bone_groups: Any = None,
                 bone_motions: Any = None,
                 joint_groups: int = 0,
                 overlap_correctives: int = 0,
                 lod_triangles: float = 0,
                 lod_meshes: Any = None,
                 lod_mesh_count: int = 0,
                 landmarks: Any = None,
                 landmark_count: int = 0) -> None:
        super().__init__(240)
        self.facial_joints = facial_joints
        self.influences = influences
        self.lods = lods
        self.groups = groups
        self.seed = seed
        self.unit = unit
        self.up = up
        self.front = front
        self.symmetry = symmetry
        self.flags = flags
        self.name = name
        self.face_object = face_object
        self.bones = bones
        self.bone_count = bone_count
        self.weight_joints = weight_joints
        self.weights = weights
        self.parallel = parallel
        self.progress_user = progress_user
        self.progress = progress
        self.allocator = allocator
        self.depth_groups = depth_groups
        self.mask = mask
        self.lod_joints = lod_joints
        self.bone_groups = bone_groups
        self.bone_motions = bone_motions
        self.joint_groups = joint_groups
        self.overlap_correctives = overlap_correctives
        self.lod_triangles = lod_triangles
        self.lod_meshes = lod_meshes
        self.lod_mesh_count = lod_mesh_count
        self.landmarks = landmarks
        self.landmark_count = landmark_count


class MienDocumentDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("allocator", POINTER(MienAllocator)),
        ("file_access", c_uint32),
        ("unknown_layers", c_uint32),
    ]
    struct_size: Any
    allocator: Any
    file_access: Any
    unknown_layers: Any

    def __init__(self, *,
                 allocator: Any = None,
                 file_access: int = 0,
                 unknown_layers: int = 0) -> None:
        super().__init__(24)
        self.allocator = allocator
        self.file_access = file_access
        self.unknown_layers = unknown_layers


class MienPrunedTargets(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("deltas", c_uint64),
        ("targets", c_uint64),
    ]
    struct_size: Any
    deltas: Any
    targets: Any

    def __init__(self) -> None:
        super().__init__(24)


class MienPruneJointsDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("translation", c_float),
        ("rotation", c_float),
        ("scale", c_float),
        ("reserved", c_uint32),
    ]
    struct_size: Any
    translation: Any
    rotation: Any
    scale: Any
    reserved: Any

    def __init__(self, *,
                 translation: float = 0,
                 rotation: float = 0,
                 scale: float = 0) -> None:
        super().__init__(24)
        self.translation = translation
        self.rotation = rotation
        self.scale = scale


class MienPrunedJoints(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("entry_count", c_uint64),
        ("removed_count", c_uint64),
        ("worst_distance", c_double),
        ("worst_control", c_uint32),
        ("worst_mesh", c_uint32),
        ("worst_position", c_uint32),
        ("reserved", c_uint32),
    ]
    struct_size: Any
    entry_count: Any
    removed_count: Any
    worst_distance: Any
    worst_control: Any
    worst_mesh: Any
    worst_position: Any
    reserved: Any

    def __init__(self) -> None:
        super().__init__(48)


class MienPlacement(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("scale", c_double),
        ("rotation", c_double * 3),
        ("translation", c_double * 3),
    ]
    struct_size: Any
    scale: Any
    rotation: Any
    translation: Any

    def __init__(self, *,
                 scale: float = 0,
                 rotation: Tuple[float, float, float] = (0, 0, 0),
                 translation: Tuple[float, float, float] = (0, 0, 0)) -> None:
        super().__init__(64)
        self.scale = scale
        self.rotation = rotation
        self.translation = translation


class MienProjectDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("match", c_uint32),
        ("influences", c_uint32),
        ("keep_weights", c_uint32),
        ("keep_targets", c_uint32),
    ]
    struct_size: Any
    match: Any
    influences: Any
    keep_weights: Any
    keep_targets: Any

    def __init__(self, *,
                 match: int = 0,
                 influences: int = 0,
                 keep_weights: bool = False,
                 keep_targets: bool = False) -> None:
        super().__init__(24)
        self.match = match
        self.influences = influences
        self.keep_weights = keep_weights
        self.keep_targets = keep_targets


class MienConformed(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("joint_distance", c_double),
        ("joint", c_uint32),
        ("reserved", c_uint32),
    ]
    struct_size: Any
    joint_distance: Any
    joint: Any
    reserved: Any

    def __init__(self) -> None:
        super().__init__(24)


class MienTransplantDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("match", c_uint32),
        ("influences", c_uint32),
    ]
    struct_size: Any
    match: Any
    influences: Any

    def __init__(self, *,
                 match: int = 0,
                 influences: int = 0) -> None:
        super().__init__(16)
        self.match = match
        self.influences = influences


class MienControlError(Structure):
    _fields_ = [
        ("worst", c_double),
        ("rms", c_double),
        ("moved", c_double),
        ("control", c_uint32),
        ("reserved", c_uint32),
    ]
    worst: Any
    rms: Any
    moved: Any
    control: Any
    reserved: Any


class MienByteSink(Structure):
    _fields_ = [
        ("user", c_void_p),
        ("write", CFUNCTYPE(c_size_t, c_void_p, c_void_p, c_size_t)),
    ]
    user: Any
    write: Any


class MienSolvePoint(Structure):
    _fields_ = [
        ("mesh", c_uint32),
        ("positions", c_uint32 * 3),
        ("weights", c_float * 3),
    ]
    mesh: Any
    positions: Any
    weights: Any


class MienFitDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("deformer", MienDeformer),
        ("controls", c_void_p),
        ("lower", c_void_p),
        ("upper", c_void_p),
        ("symmetric", c_void_p),
        ("points", POINTER(MienSolvePoint)),
        ("joint_weights", c_void_p),
        ("control_count", c_size_t),
        ("symmetric_count", c_size_t),
        ("point_count", c_size_t),
        ("lod", c_uint32),
        ("reserved", c_uint32),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    deformer: Any
    controls: Any
    lower: Any
    upper: Any
    symmetric: Any
    points: Any
    joint_weights: Any
    control_count: Any
    symmetric_count: Any
    point_count: Any
    lod: Any
    reserved: Any
    allocator: Any

    def __init__(self, *,
                 deformer: Any = None,
                 controls: Any = None,
                 lower: Any = None,
                 upper: Any = None,
                 symmetric: Any = None,
                 points: Any = None,
                 joint_weights: Any = None,
                 control_count: int = 0,
                 symmetric_count: int = 0,
                 point_count: int = 0,
                 lod: int = 0,
                 allocator: Any = None) -> None:
        super().__init__(104)
        self.deformer = deformer
        self.controls = controls
        self.lower = lower
        self.upper = upper
        self.symmetric = symmetric
        self.points = points
        self.joint_weights = joint_weights
        self.control_count = control_count
        self.symmetric_count = symmetric_count
        self.point_count = point_count
        self.lod = lod
        self.allocator = allocator


class MienFitSurfaceDesc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("positions", c_void_p),
        ("triangles", c_void_p),
        ("position_count", c_size_t),
        ("triangle_count", c_size_t),
        ("allocator", POINTER(MienAllocator)),
    ]
    struct_size: Any
    positions: Any
    triangles: Any
    position_count: Any
    triangle_count: Any
    allocator: Any

    def __init__(self, *,
                 positions: Any = None,
                 triangles: Any = None,
                 position_count: int = 0,
                 triangle_count: int = 0,
                 allocator: Any = None) -> None:
        super().__init__(48)
        self.positions = positions
        self.triangles = triangles
        self.position_count = position_count
        self.triangle_count = triangle_count
        self.allocator = allocator


class MienFitCamera(Structure):
    _fields_ = [
        ("focal", c_float * 2),
        ("center", c_float * 2),
        ("rotation", c_float * 9),
        ("translation", c_float * 3),
    ]
    focal: Any
    center: Any
    rotation: Any
    translation: Any


class MienFitConstraint(Structure):
    _fields_ = [
        ("kind", c_uint32),
        ("joint", c_uint32),
        ("points", c_uint32 * 2),
        ("axis", c_float * 3),
        ("target", c_float * 3),
        ("distances", c_float * 2),
        ("weight", c_float),
    ]
    kind: Any
    joint: Any
    points: Any
    axis: Any
    target: Any
    distances: Any
    weight: Any


class MienFitFrame(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("joints", c_void_p),
        ("points", c_void_p),
        ("images", c_void_p),
        ("camera", POINTER(MienFitCamera)),
        ("point_weights", c_void_p),
        ("start", c_void_p),
        ("prior", c_void_p),
        ("prior_weight", c_float),
        ("smooth_weight", c_float),
        ("sparse_weight", c_float),
        ("symmetric_weight", c_float),
        ("robust_scale", c_float),
        ("joint_weight", c_float),
        ("rigid", c_uint32),
        ("max_iterations", c_uint32),
        ("max_seconds", c_double),
        ("user", c_void_p),
        ("canceled", CFUNCTYPE(c_uint32, c_void_p)),
        ("surface", MienFitSurface),
        ("surface_reach", c_float),
        ("focal", c_uint32),
        ("constraint_count", c_size_t),
        ("constraints", POINTER(MienFitConstraint)),
        ("stages", c_void_p),
        ("point_offsets", c_void_p),
        ("surface_weights", c_void_p),
        ("image_weight", c_float),
        ("image_robust_scale", c_float),
    ]
    struct_size: Any
    joints: Any
    points: Any
    images: Any
    camera: Any
    point_weights: Any
    start: Any
    prior: Any
    prior_weight: Any
    smooth_weight: Any
    sparse_weight: Any
    symmetric_weight: Any
    robust_scale: Any
    joint_weight: Any
    rigid: Any
    max_iterations: Any
    max_seconds: Any
    user: Any
    canceled: Any
    surface: Any
    surface_reach: Any
    focal: Any
    constraint_count: Any
    constraints: Any
    stages: Any
    point_offsets: Any
    surface_weights: Any
    image_weight: Any
    image_robust_scale: Any

    def __init__(self, *,
                 joints: Any = None,
                 points: Any = None,
                 images: Any = None,
                 camera: Any = None,
                 point_weights: Any = None,
                 start: Any = None,
                 prior: Any = None,
                 prior_weight: float = 0,
                 smooth_weight: float = 0,
                 sparse_weight: float = 0,
                 symmetric_weight: float = 0,
                 robust_scale: float = 0,
                 joint_weight: float = 0,
                 rigid: bool = False,
                 max_iterations: int = 0,
                 max_seconds: float = 0,
                 user: Any = None,
                 canceled: Any = None,
                 surface: Any = None,
                 surface_reach: float = 0,
                 focal: bool = False,
                 constraint_count: int = 0,
                 constraints: Any = None,
                 stages: Any = None,
                 point_offsets: Any = None,
                 surface_weights: Any = None,
                 image_weight: float = 0,
                 image_robust_scale: float = 0) -> None:
        super().__init__(184)
        self.joints = joints
        self.points = points
        self.images = images
        self.camera = camera
        self.point_weights = point_weights
        self.start = start
        self.prior = prior
        self.prior_weight = prior_weight
        self.smooth_weight = smooth_weight
        self.sparse_weight = sparse_weight
        self.symmetric_weight = symmetric_weight
        self.robust_scale = robust_scale
        self.joint_weight = joint_weight
        self.rigid = rigid
        self.max_iterations = max_iterations
        self.max_seconds = max_seconds
        self.user = user
        self.canceled = canceled
        self.surface = surface
        self.surface_reach = surface_reach
        self.focal = focal
        self.constraint_count = constraint_count
        self.constraints = constraints
        self.stages = stages
        self.point_offsets = point_offsets
        self.surface_weights = surface_weights
        self.image_weight = image_weight
        self.image_robust_scale = image_robust_scale


class MienFitResult(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("status", c_uint32),
        ("iterations", c_uint32),
        ("cost", c_double),
        ("joint_residual", c_double),
        ("point_residual", c_double),
        ("missing_points", c_uint32),
        ("reserved", c_uint32),
        ("rotation", c_float * 9),
        ("translation", c_float * 3),
        ("joint_worst", c_double),
        ("point_worst", c_double),
        ("focal", c_float * 2),
        ("constraint_residual", c_double),
        ("constraint_worst", c_double),
        ("jumped", c_uint32),
        ("reserved_2", c_uint32),
        ("image_residual", c_double),
        ("image_worst", c_double),
        ("surface_residual", c_double),
        ("surface_worst", c_double),
    ]
    struct_size: Any
    status: Any
    iterations: Any
    cost: Any
    joint_residual: Any
    point_residual: Any
    missing_points: Any
    reserved: Any
    rotation: Any
    translation: Any
    joint_worst: Any
    point_worst: Any
    focal: Any
    constraint_residual: Any
    constraint_worst: Any
    jumped: Any
    reserved_2: Any
    image_residual: Any
    image_worst: Any
    surface_residual: Any
    surface_worst: Any

    def __init__(self) -> None:
        super().__init__(176)


class CoordinateSystem(NamedTuple):
    """Axes, units and rotation conventions of a rig. Any handedness is allowed. See
    docs/dna-format.md, 11 "Coordinate systems".

      axes: Direction of x, y, z
      translation_unit: TranslationUnit
      rotation_unit: RotationUnit
      rotation_rule: RotationRule
      rotation_sequence: RotationSequence; ignored with RotationRule.CARRIED
      rotation_signs: of the angles about x, y, z. 1: rotates y to z, z to x, x to y. -1: the
        other way. 0: whichever leaves the angles unchanged
      face_winding: FaceWinding
    """

    axes: Tuple[Direction, Direction, Direction]
    translation_unit: TranslationUnit
    rotation_unit: RotationUnit
    rotation_rule: RotationRule
    rotation_sequence: RotationSequence
    rotation_signs: Tuple[int, int, int]
    face_winding: FaceWinding

    @classmethod
    def _of(cls, c: MienCoordinateSystem) -> CoordinateSystem:
        return cls(tuple(_enum(Direction, v) for v in c.axes), _enum(TranslationUnit,
                   c.translation_unit), _enum(RotationUnit, c.rotation_unit), _enum(RotationRule,
                   c.rotation_rule), _enum(RotationSequence, c.rotation_sequence),
                   tuple(c.rotation_signs), _enum(FaceWinding, c.face_winding))


class DnaInfo(NamedTuple):
    """Properties of an open DNA. Counts are those of the loaded layers and LODs.

      generation: 2
      version: 1 to 8: the file is of version 2.version
      layers: Layer, combined with |: the loaded layers
      has_blend_shape_targets: the geometry is loaded with its targets
      file_bytes: size of the file
      memory_bytes: memory taken from the allocator
      is_mapped: the file is mapped
      layer_count: entries for mien_dna_layer()
      translation_unit: TranslationUnit
      rotation_unit: RotationUnit
      axes: Direction of x, y, z
      rotation_sequence: RotationSequence
      rotation_signs: 1 or -1, for the angles about x, y, z
      face_winding: FaceWinding
      max_lod: LOD 0 of this file is LOD max_lod of its database
      metadata_count: pairs desc.metadata[i].key and .value
    """

    generation: int
    version: int
    layers: Layer
    has_blend_shape_targets: bool
    file_bytes: int
    memory_bytes: int
    is_mapped: bool
    layer_count: int
    translation_unit: TranslationUnit
    rotation_unit: RotationUnit
    axes: Tuple[Direction, Direction, Direction]
    rotation_sequence: RotationSequence
    rotation_signs: Tuple[int, int, int]
    face_winding: FaceWinding
    lod_count: int
    max_lod: int
    gui_control_count: int
    raw_control_count: int
    psd_control_count: int
    ml_control_count: int
    rbf_control_count: int
    joint_count: int
    joint_group_count: int
    blend_shape_channel_count: int
    animated_map_count: int
    mesh_count: int
    neural_network_count: int
    rbf_solver_count: int
    rbf_pose_count: int
    twist_count: int
    swing_count: int
    metadata_count: int

    @classmethod
    def _of(cls, c: MienDnaInfo) -> DnaInfo:
        return cls(c.generation, c.version, _enum(Layer, c.layers), bool(c.has_blend_shape_targets),
                   c.file_bytes, c.memory_bytes, bool(c.is_mapped), c.layer_count,
                   _enum(TranslationUnit, c.translation_unit), _enum(RotationUnit, c.rotation_unit),
                   tuple(_enum(Direction, v) for v in c.axes), _enum(RotationSequence,
                   c.rotation_sequence), tuple(c.rotation_signs), _enum(FaceWinding,
                   c.face_winding), c.lod_count, c.max_lod, c.gui_control_count,
                   c.raw_control_count, c.psd_control_count, c.ml_control_count,
                   c.rbf_control_count, c.joint_count, c.joint_group_count,
                   c.blend_shape_channel_count, c.animated_map_count, c.mesh_count,
                   c.neural_network_count, c.rbf_solver_count, c.rbf_pose_count, c.twist_count,
                   c.swing_count, c.metadata_count)


class DnaLayer(NamedTuple):
    """An entry of the index table of the file. Files of version 2.1 have no index table; their
    sections are listed as the layers desc, defn, bhvr and geom.

      layer: Layer that loads it. Layer.UNKNOWN: no known kind
      version_major: of the layer: version_major.version_minor
      is_loaded: it was parsed, not skipped or kept as bytes
      byte_offset: of its first byte in the file
      code: such as "bhvr"; null-terminated
    """

    layer: Layer
    version_major: int
    version_minor: int
    is_loaded: bool
    byte_offset: Optional[int]
    byte_count: int
    code: str

    @classmethod
    def _of(cls, c: MienDnaLayer) -> DnaLayer:
        return cls(_enum(Layer, c.layer), c.version_major, c.version_minor, bool(c.is_loaded), None
                   if c.byte_offset == MIEN_NO_OFFSET else c.byte_offset, c.byte_count,
                   c.code.decode('ascii', 'replace'))


class DnaField(NamedTuple):
    """Copy of a MienDnaField.

      type: FieldType
      is_array: an array of numbers, even if it has only one element; not a single number, nor an
        element of an array
      count: elements of an array or list, bytes of a string, fields of a record; 1 for a number
      byte_offset: of a string, an array or an element of an array in the file; None: other
        fields, and data that is not in the file
    """

    type: FieldType
    is_array: bool
    count: int
    byte_offset: Optional[int]

    @classmethod
    def _of(cls, c: MienDnaField) -> DnaField:
        return cls(_enum(FieldType, c.type), bool(c.is_array), c.count, None if c.byte_offset ==
                   MIEN_NO_OFFSET else c.byte_offset)


class Finding(NamedTuple):
    """Copy of a MienFinding.

      severity: Severity
      status: the status of the failure; Status.OK for a warning
      byte_offset: where in the file; None: nowhere in particular
      field: path as for mien_dna_field(), or the code of a layer
      message: what is wrong
    """

    severity: Severity
    status: Status
    byte_offset: Optional[int]
    field: str
    message: str

    @classmethod
    def _of(cls, c: MienFinding) -> Finding:
        return cls(_enum(Severity, c.severity), _enum(Status, c.status), None if c.byte_offset ==
                   MIEN_NO_OFFSET else c.byte_offset, text(c.field), text(c.message))


class RigInfo(NamedTuple):
    """Properties of a rig.

      isa: Isa in use, never Isa.BEST
      translation_unit: TranslationUnit
      rotation_unit: RotationUnit
      axes: Direction of x, y, z
      rotation_sequence: RotationSequence
      rotation_signs: 1 or -1, for the angles about x, y, z
      control_count: length of the control vector: raw, PSD, ML, RBF controls
      joint_value_count: 9 or 10 per joint
      rotation_output: RotationOutput
      storage: Storage
      arithmetic: Arithmetic
      rig_bytes: memory of the rig, including its part of a baked file
      instance_bytes: memory of each instance
    """

    isa: Isa
    lod_count: int
    translation_unit: TranslationUnit
    rotation_unit: RotationUnit
    axes: Tuple[Direction, Direction, Direction]
    rotation_sequence: RotationSequence
    rotation_signs: Tuple[int, int, int]
    control_count: int
    joint_value_count: int
    rotation_output: RotationOutput
    storage: Storage
    arithmetic: Arithmetic
    rig_bytes: int
    instance_bytes: int

    @classmethod
    def _of(cls, c: MienRigInfo) -> RigInfo:
        return cls(_enum(Isa, c.isa), c.lod_count, _enum(TranslationUnit, c.translation_unit),
                   _enum(RotationUnit, c.rotation_unit), tuple(_enum(Direction, v) for v in c.axes),
                   _enum(RotationSequence, c.rotation_sequence), tuple(c.rotation_signs),
                   c.control_count, c.joint_value_count, _enum(RotationOutput, c.rotation_output),
                   _enum(Storage, c.storage), _enum(Arithmetic, c.arithmetic), c.rig_bytes,
                   c.instance_bytes)


class RigStatistics(NamedTuple):
    """The work of an evaluation at a LOD when all controls are active.

      psd_count: correctives computed
      joint_count: joints of the LOD
      joint_row_count: rows of the joint groups
      blend_shape_count: channels written
      animated_map_row_count: rows of the animated map table
      rbf_solver_count: RBF solvers of the LOD
      quaternion_joint_count: quaternion joints
      joint_entry_count: stored in the joint matrix: 8 per block that is not all zeros
      joint_byte_count: of the joint matrix; an evaluation does not read the columns of controls
        that are 0
    """

    lod: int
    psd_count: int
    joint_count: int
    joint_row_count: int
    blend_shape_count: int
    animated_map_row_count: int
    rbf_solver_count: int
    quaternion_joint_count: int
    joint_entry_count: int
    joint_byte_count: int

    @classmethod
    def _of(cls, c: MienRigStatistics) -> RigStatistics:
        return cls(c.lod, c.psd_count, c.joint_count, c.joint_row_count, c.blend_shape_count,
                   c.animated_map_row_count, c.rbf_solver_count, c.quaternion_joint_count,
                   c.joint_entry_count, c.joint_byte_count)


class InstanceStatistics(NamedTuple):
    """What the joint stage reads for the current controls, at the LOD of the last evaluation
    (initially LOD 0), if it reuses no results. Each byte is counted once, regardless of CPU
    caches.

      lod: of the last evaluation
      control_count: of the control vector: raw, PSD, ML and RBF controls
      active_control_count: controls that are not 0
      joint_column_count: columns of the joint matrix that active controls drive
      joint_entry_count: of these columns: 8 per block
      joint_byte_count: of these entries: at most MienRigStatistics.joint_byte_count
    """

    lod: int
    control_count: int
    active_control_count: int
    joint_column_count: int
    joint_entry_count: int
    joint_byte_count: int

    @classmethod
    def _of(cls, c: MienInstanceStatistics) -> InstanceStatistics:
        return cls(c.lod, c.control_count, c.active_control_count, c.joint_column_count,
                   c.joint_entry_count, c.joint_byte_count)


class DeformerInfo(NamedTuple):
    """Properties of a deformer.

      isa: Isa in use, never Isa.BEST
      compose: Compose
      weights: Weights
      normals: Normals, never Normals.DEFAULT
      mesh_count: same as in the rig, which has their names: Kind.MESH
      deformer_bytes: memory of the deformer, including its part of a baked file
      instance_bytes: memory of a deformer instance for all meshes
      storage: Storage
    """

    isa: Isa
    compose: Compose
    weights: Weights
    normals: Normals
    lod_count: int
    joint_count: int
    channel_count: int
    mesh_count: int
    deformer_bytes: int
    instance_bytes: int
    storage: Storage

    @classmethod
    def _of(cls, c: MienDeformerInfo) -> DeformerInfo:
        return cls(_enum(Isa, c.isa), _enum(Compose, c.compose), _enum(Weights, c.weights),
                   _enum(Normals, c.normals), c.lod_count, c.joint_count, c.channel_count,
                   c.mesh_count, c.deformer_bytes, c.instance_bytes, _enum(Storage, c.storage))


class BakedInfo(NamedTuple):
    """Properties of an open baked file.

      file_bytes: size of the file
      memory_bytes: memory taken from the allocator
      rig_bytes: size of the rig in the file. 0: it has none
      deformer_bytes: size of the deformer in the file. 0: it has none
      part_count: parts of the file, including unknown ones
      is_mapped: the file is mapped
    """

    file_bytes: int
    memory_bytes: int
    rig_bytes: int
    deformer_bytes: int
    part_count: int
    is_mapped: bool

    @classmethod
    def _of(cls, c: MienBakedInfo) -> BakedInfo:
        return cls(c.file_bytes, c.memory_bytes, c.rig_bytes, c.deformer_bytes, c.part_count,
                   bool(c.is_mapped))


class ClipInfo(NamedTuple):
    """Properties of a clip.

      rate_numerator: frames per second, as a fraction
      changing_channel_count: channels whose value is not the same in all frames
      looping: Looping.CLAMP or Looping.WRAP
      is_delta: as in MienClipDesc
      snap: largest step to which a channel was rounded. 0: none was
      is_mapped: the file is mapped
      length: ticks
      file_bytes: size of the clip
      memory_bytes: memory taken from the allocator
      player_bytes: memory of a player without MienClipPlayerDesc.reverse
    """

    rate_numerator: int
    rate_denominator: int
    frame_count: int
    channel_count: int
    changing_channel_count: int
    event_count: int
    looping: Looping
    is_delta: bool
    snap: float
    is_mapped: bool
    ticks_per_frame: int
    length: int
    file_bytes: int
    memory_bytes: int
    player_bytes: int

    @classmethod
    def _of(cls, c: MienClipInfo) -> ClipInfo:
        return cls(c.rate_numerator, c.rate_denominator, c.frame_count, c.channel_count,
                   c.changing_channel_count, c.event_count, _enum(Looping, c.looping),
                   bool(c.is_delta), c.snap, bool(c.is_mapped), c.ticks_per_frame, c.length,
                   c.file_bytes, c.memory_bytes, c.player_bytes)


class ClipChannel(NamedTuple):
    """A channel of a clip. Block counts, bits and max_error are only known for a clip from
    mien_clip_build(); they are 0 for a clip that was opened.

      rest: value of a channel that does not change; otherwise 0
      is_changing: the channel has a curve
      zero_blocks: blocks of 64 frames that are zero
      constant_blocks: blocks with one other value
      grid_blocks: blocks whose values are multiples of a decimal or binary fraction
      float_blocks: other blocks
      bits: of all blocks
      max_error: largest error of rounding to a step
    """

    name: str
    rest: float
    is_changing: bool
    zero_blocks: int
    constant_blocks: int
    grid_blocks: int
    float_blocks: int
    bits: int
    max_error: float

    @classmethod
    def _of(cls, c: MienClipChannel) -> ClipChannel:
        return cls(text(c.name), c.rest, bool(c.is_changing), c.zero_blocks, c.constant_blocks,
                   c.grid_blocks, c.float_blocks, c.bits, c.max_error)


class ClipPlayerInfo(NamedTuple):
    """State of a player.

      tick: 0 to the length of the clip; with Looping.WRAP less than the length
      loops: loops completed since creation or the last seek, at most 2^61; negative: backward
      looping: Looping.CLAMP or Looping.WRAP
      is_damaged: a damaged curve was played, as zeros
    """

    tick: int
    loops: int
    looping: Looping
    is_damaged: bool

    @classmethod
    def _of(cls, c: MienClipPlayerInfo) -> ClipPlayerInfo:
        return cls(c.tick, c.loops, _enum(Looping, c.looping), bool(c.is_damaged))


class MixInfo(NamedTuple):
    """Properties of a mix.

      curve_count: raw controls and pose variables
      stage_count: for mien_mixer_stage()
      guard_count: for mien_mixer_set_guard()
      mixer_bytes: memory of a mixer without MienMixerDesc.stages
      snapshot_bytes: size of a snapshot
    """

    raw_control_count: int
    variable_count: int
    curve_count: int
    layer_count: int
    stage_count: int
    guard_count: int
    mixer_bytes: int
    snapshot_bytes: int

    @classmethod
    def _of(cls, c: MienMixInfo) -> MixInfo:
        return cls(c.raw_control_count, c.variable_count, c.curve_count, c.layer_count,
                   c.stage_count, c.guard_count, c.mixer_bytes, c.snapshot_bytes)


class MixerInfo(NamedTuple):
    """State of a mixer.

      tick: time since creation
      event_count: clip events that the last step passed
      lost_events: there were more than MienMixDesc.max_events
    """

    tick: int
    event_count: int
    lost_events: bool

    @classmethod
    def _of(cls, c: MienMixerInfo) -> MixerInfo:
        return cls(c.tick, c.event_count, bool(c.lost_events))


class SolverStackInfo(NamedTuple):
    """Properties of a solver stack.

      output_count: of all solvers
      state_bytes: memory of a state
    """

    solver_count: int
    curve_count: int
    output_count: int
    joint_count: int
    state_bytes: int

    @classmethod
    def _of(cls, c: MienSolverStackInfo) -> SolverStackInfo:
        return cls(c.solver_count, c.curve_count, c.output_count, c.joint_count, c.state_bytes)


class PrunedTargets(NamedTuple):
    """How many deltas and targets mien_document_prune_targets() removed."""

    deltas: int
    targets: int

    @classmethod
    def _of(cls, c: MienPrunedTargets) -> PrunedTargets:
        return cls(c.deltas, c.targets)


class PrunedJoints(NamedTuple):
    """The effect of mien_document_prune_joints(): removed entries, and the largest distance by
    which a position moved.

      entry_count: entries of the joint matrix that were not 0
      removed_count: of these, set to 0
      worst_distance: in the unit of the file
      worst_control: the raw control at 1, or the corrective whose raw controls were at 1
    """

    entry_count: int
    removed_count: int
    worst_distance: float
    worst_control: int
    worst_mesh: int
    worst_position: int

    @classmethod
    def _of(cls, c: MienPrunedJoints) -> PrunedJoints:
        return cls(c.entry_count, c.removed_count, c.worst_distance, c.worst_control, c.worst_mesh,
                   c.worst_position)


class Conformed(NamedTuple):
    """How far the rig moved to follow a mesh.

      joint_distance: largest distance by which a joint moved, in the unit of the file
      joint: that joint
    """

    joint_distance: float
    joint: int

    @classmethod
    def _of(cls, c: MienConformed) -> Conformed:
        return cls(c.joint_distance, c.joint)


# Why functions fail, beyond what the package checks: (status, condition).
STATUSES: Dict[str, Tuple[Tuple[Status, str], ...]] = {
    "mien_coordinate_system_find": (
        (Status.NAME,
         "the name is none of these"),
    ),
    "mien_coordinate_system_find_n": (
        (Status.NAME,
         "the name is none of these"),
    ),
    "mien_coordinate_system_name": (
        (Status.INDEX,
         "`index` is past the last name"),
    ),
    "mien_dna_open_file": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.LOD,
         "it has none of the requested LODs"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
        (Status.FILE_OPEN,
         "the file cannot be read"),
        (Status.FILE_READ,
         "the file cannot be read"),
        (Status.DNA_SIGNATURE,
         "it is not a DNA file of generation 2"),
        (Status.DNA_VERSION,
         "it is not a DNA file of generation 2"),
        (Status.DNA_TRUNCATED,
         "its contents are not valid or cannot be converted to the requested system"),
        (Status.DNA_STRUCTURE,
         "its contents are not valid or cannot be converted to the requested system"),
        (Status.DNA_REFERENCE,
         "its contents are not valid or cannot be converted to the requested system"),
        (Status.DNA_LIMIT,
         "its contents are not valid or cannot be converted to the requested system"),
        (Status.DNA_VALUE,
         "its contents are not valid or cannot be converted to the requested system"),
    ),
    "mien_dna_open_memory": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.LOD,
         "it has none of the requested LODs"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
        (Status.DNA_SIGNATURE,
         "it is not a DNA file of generation 2"),
        (Status.DNA_VERSION,
         "it is not a DNA file of generation 2"),
        (Status.DNA_TRUNCATED,
         "its contents are not valid or cannot be converted to the requested system"),
        (Status.DNA_STRUCTURE,
         "its contents are not valid or cannot be converted to the requested system"),
        (Status.DNA_REFERENCE,
         "its contents are not valid or cannot be converted to the requested system"),
        (Status.DNA_LIMIT,
         "its contents are not valid or cannot be converted to the requested system"),
        (Status.DNA_VALUE,
         "its contents are not valid or cannot be converted to the requested system"),
    ),
    "mien_dna_open_stream": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.LOD,
         "it has none of the requested LODs"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
        (Status.FILE_READ,
         "the file cannot be read"),
        (Status.DNA_SIGNATURE,
         "it is not a DNA file of generation 2"),
        (Status.DNA_VERSION,
         "it is not a DNA file of generation 2"),
        (Status.DNA_TRUNCATED,
         "its contents are not valid or cannot be converted to the requested system"),
        (Status.DNA_STRUCTURE,
         "its contents are not valid or cannot be converted to the requested system"),
        (Status.DNA_REFERENCE,
         "its contents are not valid or cannot be converted to the requested system"),
        (Status.DNA_LIMIT,
         "its contents are not valid or cannot be converted to the requested system"),
        (Status.DNA_VALUE,
         "its contents are not valid or cannot be converted to the requested system"),
    ),
    "mien_dna_info": (
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
    ),
    "mien_dna_layer": (
        (Status.INDEX,
         "`index` is not below MienDnaInfo.layer_count"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
    ),
    "mien_dna_field": (
        (Status.INDEX,
         "an index in the path is past the end"),
        (Status.NAME,
         "there is no such field (the message contains the part of the path that does "
         "not exist)"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
    ),
    "mien_dna_field_n": (
        (Status.INDEX,
         "an index in the path is past the end"),
        (Status.NAME,
         "there is no such field (the message contains the part of the path that does "
         "not exist)"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
    ),
    "mien_dna_child_name": (
        (Status.INVALID_ARGUMENT,
         "the field is not a record"),
        (Status.INDEX,
         "`index` or an index in the path is past the end"),
        (Status.NAME,
         "there is no such field"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
    ),
    "mien_dna_child_name_n": (
        (Status.INVALID_ARGUMENT,
         "the field is not a record"),
        (Status.INDEX,
         "`index` or an index in the path is past the end"),
        (Status.NAME,
         "there is no such field"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
    ),
    "mien_dna_read_floats": (
        (Status.INVALID_ARGUMENT,
         "the field does not hold numbers of this kind"),
        (Status.INDEX,
         "the range or an index in the path is past the end"),
        (Status.NAME,
         "there is no such field"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
    ),
    "mien_dna_read_floats_n": (
        (Status.INVALID_ARGUMENT,
         "the field does not hold numbers of this kind"),
        (Status.INDEX,
         "the range or an index in the path is past the end"),
        (Status.NAME,
         "there is no such field"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
    ),
    "mien_dna_read_integers": (
        (Status.INVALID_ARGUMENT,
         "the field does not hold numbers of this kind"),
        (Status.INDEX,
         "the range or an index in the path is past the end"),
        (Status.NAME,
         "there is no such field"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
    ),
    "mien_dna_read_integers_n": (
        (Status.INVALID_ARGUMENT,
         "the field does not hold numbers of this kind"),
        (Status.INDEX,
         "the range or an index in the path is past the end"),
        (Status.NAME,
         "there is no such field"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
    ),
    "mien_dna_read_string": (
        (Status.INVALID_ARGUMENT,
         "the field is not a string"),
        (Status.INDEX,
         "an index in the path is past the end"),
        (Status.NAME,
         "there is no such field"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
    ),
    "mien_dna_read_string_n": (
        (Status.INVALID_ARGUMENT,
         "the field is not a string"),
        (Status.INDEX,
         "an index in the path is past the end"),
        (Status.NAME,
         "there is no such field"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
    ),
    "mien_dna_write_file": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "the allocator of the DNA returns NULL"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
        (Status.FILE_WRITE,
         "the file cannot be written"),
        (Status.DNA_STRUCTURE,
         "the file could not be opened in the requested version"),
        (Status.DNA_REFERENCE,
         "the file could not be opened in the requested version"),
        (Status.DNA_LIMIT,
         "it would exceed 4 GiB"),
        (Status.DNA_LAYER,
         "RBF behavior was loaded without the machine-learned behavior of its file "
         "(whose controls are numbered before its own)"),
        (Status.DNA_VALUE,
         "the file could not be opened in the requested version"),
    ),
    "mien_dna_write_memory": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
        (Status.DNA_STRUCTURE,
         "the file could not be opened in the requested version"),
        (Status.DNA_REFERENCE,
         "the file could not be opened in the requested version"),
        (Status.DNA_LIMIT,
         "it would exceed 4 GiB"),
        (Status.DNA_LAYER,
         "RBF behavior was loaded without the machine-learned behavior of its file "
         "(whose controls are numbered before its own)"),
        (Status.DNA_VALUE,
         "the file could not be opened in the requested version"),
    ),
    "mien_dna_validate_file": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
        (Status.FILE_OPEN,
         "the file cannot be read"),
        (Status.FILE_READ,
         "the file cannot be read"),
    ),
    "mien_dna_validate_memory": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
    ),
    "mien_report_counts": (
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
    ),
    "mien_report_finding": (
        (Status.INDEX,
         "`index` is past the last finding"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
    ),
    "mien_rig_create": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.ISA,
         "the requested instruction set is not available"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
        (Status.DNA_LIMIT,
         "the rig is too large"),
        (Status.DNA_LAYER,
         "`dna` was opened without its behavior"),
        (Status.DNA_VALUE,
         "correctives depend on each other in a cycle"),
    ),
    "mien_rig_info": (),
    "mien_rig_count": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
    ),
    "mien_rig_name": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.INDEX,
         "`index` is not below mien_rig_count()"),
    ),
    "mien_rig_find": (
        (Status.INVALID_ARGUMENT,
         "`kind` has no names"),
        (Status.NAME,
         "there is no such name"),
    ),
    "mien_rig_find_n": (
        (Status.INVALID_ARGUMENT,
         "`kind` has no names"),
        (Status.NAME,
         "there is no such name"),
    ),
    "mien_rig_lod_indices": (
        (Status.INVALID_ARGUMENT,
         "`kind` is not one of these five"),
        (Status.LOD,
         "the rig has no such LOD"),
    ),
    "mien_rig_variable_joint_values": (
        (Status.LOD,
         "the rig has no such LOD"),
    ),
    "mien_rig_joint_parents": (),
    "mien_rig_neutral_joint_values": (),
    "mien_rig_psd_inputs": (
        (Status.INDEX,
         "there is no such corrective"),
    ),
    "mien_rig_initial_raw_controls": (),
    "mien_rig_statistics": (
        (Status.LOD,
         "the rig has no such LOD"),
    ),
    "mien_instance_create": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "memory runs out"),
    ),
    "mien_instance_reset": (),
    "mien_instance_gui_controls": (),
    "mien_instance_raw_controls": (),
    "mien_instance_ml_masks": (),
    "mien_instance_controls": (),
    "mien_instance_psd_controls": (),
    "mien_instance_ml_controls": (),
    "mien_instance_rbf_controls": (),
    "mien_instance_joints": (),
    "mien_instance_blend_shapes": (),
    "mien_instance_animated_maps": (),
    "mien_instance_statistics": (),
    "mien_rig_map_gui_to_raw": (
        (Status.MISMATCH,
         "`instance` belongs to another rig"),
    ),
    "mien_rig_map_raw_to_gui": (
        (Status.MISMATCH,
         "`instance` belongs to another rig"),
    ),
    "mien_rig_evaluate": (
        (Status.MISMATCH,
         "`instance` belongs to another rig"),
        (Status.LOD,
         "the rig has no such LOD"),
    ),
    "mien_rig_evaluate_stages": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MISMATCH,
         "`instance` belongs to another rig"),
        (Status.LOD,
         "the rig has no such LOD"),
    ),
    "mien_batch_create": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "memory runs out"),
    ),
    "mien_batch_bytes": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
    ),
    "mien_rig_evaluate_batch": (
        (Status.INVALID_ARGUMENT,
         "`count` exceeds MienBatchDesc.capacity or an instance is listed twice"),
        (Status.MISMATCH,
         "the batch or an instance belongs to another rig"),
        (Status.LOD,
         "the rig has no such LOD"),
    ),
    "mien_rig_evaluate_joint_group": (
        (Status.MISMATCH,
         "`instance` belongs to another rig"),
        (Status.INDEX,
         "there is no such joint group"),
        (Status.LOD,
         "the rig has no such LOD"),
    ),
    "mien_rig_evaluate_rbf_solver": (
        (Status.MISMATCH,
         "`instance` belongs to another rig"),
        (Status.INDEX,
         "there is no such solver"),
        (Status.LOD,
         "the rig has no such LOD"),
    ),
    "mien_rig_evaluate_twist_swing": (
        (Status.MISMATCH,
         "`instance` belongs to another rig"),
        (Status.INDEX,
         "there is no such setup"),
        (Status.LOD,
         "the rig has no such LOD"),
    ),
    "mien_deformer_create": (
        (Status.INVALID_ARGUMENT,
         "`delta_error` is negative or not finite"),
        (Status.MISMATCH,
         "the number or the names of joints, channels or meshes differ from those of the"
         " rig"),
        (Status.ISA,
         "the requested instruction set is not available"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
        (Status.DNA_LIMIT,
         "a position has more than 65535 influences"),
        (Status.DNA_LAYER,
         "`dna` was opened without Layer.GEOMETRY"),
        (Status.DNA_VALUE,
         "a joint is its own ancestor or a position, delta or weight is not finite"),
    ),
    "mien_deformer_create_subset": (
        (Status.INVALID_ARGUMENT,
         "positions are not ascending"),
        (Status.INDEX,
         "there is no such mesh or position"),
        (Status.MEMORY,
         "memory runs out"),
    ),
    "mien_deformer_info": (),
    "mien_deformer_mesh": (
        (Status.INDEX,
         "there is no such mesh"),
    ),
    "mien_deformer_triangles": (
        (Status.INVALID_ARGUMENT,
         "`count` is less than 3 * MienMesh.triangle_count"),
        (Status.INDEX,
         "there is no such mesh"),
        (Status.MEMORY,
         "memory ran out"),
    ),
    "mien_deformer_texture_coordinates": (
        (Status.INVALID_ARGUMENT,
         "`count` is less than 2 * MienMesh.vertex_count"),
        (Status.INDEX,
         "there is no such mesh"),
    ),
    "mien_deformer_influences": (
        (Status.INDEX,
         "there is no such mesh or position"),
        (Status.UNSUPPORTED,
         "the weights are stored with 16 bits (MienDeformerDesc.storage)"),
    ),
    "mien_deformer_target": (
        (Status.INVALID_ARGUMENT,
         "`count` is less than 3 * MienMesh.position_count"),
        (Status.INDEX,
         "there is no such mesh or target"),
    ),
    "mien_deformer_bind_matrices": (),
    "mien_deformer_inverse_bind_matrices": (),
    "mien_deformer_instance_create": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "memory runs out"),
    ),
    "mien_deformer_instance_update": (
        (Status.MISMATCH,
         "`instance` belongs to a rig other than that of the deformer"),
    ),
    "mien_deformer_instance_update_from_values": (
        (Status.INVALID_ARGUMENT,
         "a count is not that of the rig"),
    ),
    "mien_deformer_instance_joint_matrices": (),
    "mien_deformer_instance_skin_matrices": (),
    "mien_deformer_instance_local_transforms": (
        (Status.INVALID_ARGUMENT,
         "`count` is less than 10 * MienDeformerInfo.joint_count"),
    ),
    "mien_deformer_instance_deform": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.INDEX,
         "there is no such mesh"),
        (Status.LOD,
         "`deformer_instance` has no memory for it (MienDeformerInstanceDesc.lods)"),
    ),
    "mien_deformer_instance_deform_batch": (
        (Status.INVALID_ARGUMENT,
         "an instance is listed twice"),
        (Status.MISMATCH,
         "the instances have different deformers"),
        (Status.INDEX,
         "there is no such mesh"),
        (Status.LOD,
         "an instance has no memory for it"),
    ),
    "mien_deformer_instance_positions": (
        (Status.INDEX,
         "there is no such mesh"),
        (Status.LOD,
         "`deformer_instance` has no memory for it"),
    ),
    "mien_deformer_instance_normals": (
        (Status.INDEX,
         "there is no such mesh"),
        (Status.LOD,
         "`deformer_instance` has no memory for it"),
    ),
    "mien_deformer_instance_write_vertices": (
        (Status.INVALID_ARGUMENT,
         "a stream has a format that its attribute cannot have, a wrong stride or "
         "alignment or too little capacity, if streams overlap, if there is no stream, "
         "or if tangents are requested from a deformer without them"),
        (Status.INDEX,
         "there is no such mesh"),
        (Status.LOD,
         "`deformer_instance` has no memory for it"),
    ),
    "mien_deformer_instance_write_vertices_batch": (
        (Status.INVALID_ARGUMENT,
         "a stream has a format that its attribute cannot have, a wrong stride or "
         "alignment or too little capacity, if streams overlap, if there is no stream, "
         "or if tangents are requested from a deformer without them; or an instance is "
         "listed twice"),
        (Status.MISMATCH,
         "the instances have different deformers"),
        (Status.INDEX,
         "there is no such mesh"),
        (Status.LOD,
         "`deformer_instance` has no memory for it"),
    ),
    "mien_derivatives_create": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MISMATCH,
         "the deformer is not of the rig"),
        (Status.MEMORY,
         "memory runs out"),
    ),
    "mien_derivatives_bytes": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MISMATCH,
         "the deformer is not of the rig"),
    ),
    "mien_derivatives_size": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.INDEX,
         "there is no such mesh, or the point needs a deformer and there is none"),
    ),
    "mien_derivatives_linearize": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MISMATCH,
         "the instance is not of the rig"),
    ),
    "mien_derivatives_forward": (
        (Status.INVALID_ARGUMENT,
         "`from` has no effect on `to` or nothing was linearized"),
        (Status.INDEX,
         "a point lacks its deformer or mesh"),
    ),
    "mien_derivatives_reverse": (
        (Status.INVALID_ARGUMENT,
         "`from` has no effect on `to` or nothing was linearized"),
        (Status.INDEX,
         "a point lacks its deformer or mesh"),
    ),
    "mien_jacobian_create": (
        (Status.INVALID_ARGUMENT,
         "from_point has no effect on to_point or the outputs do not ascend"),
        (Status.INDEX,
         "a point lacks its deformer or mesh, or an input or output does not exist"),
        (Status.LOD,
         "the rig has no such LOD"),
        (Status.MEMORY,
         "memory runs out"),
    ),
    "mien_jacobian_pattern": (),
    "mien_derivatives_jacobian": (
        (Status.INVALID_ARGUMENT,
         "nothing was linearized, `value_count` is not the number of entries, or "
         "`wanted_count` not that of columns (0 if `wanted` is NULL)"),
        (Status.MISMATCH,
         "the matrix was created for another rig or deformer, or the values were "
         "linearized at another LOD"),
    ),
    "mien_bake_file": (
        (Status.MISMATCH,
         "`deformer` was created for another rig"),
        (Status.MEMORY,
         "the allocator of the rig returns NULL"),
        (Status.FILE_WRITE,
         "the file cannot be written"),
    ),
    "mien_bake_memory": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MISMATCH,
         "`deformer` was created for another rig"),
    ),
    "mien_baked_open_file": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.FILE_OPEN,
         "the file cannot be read"),
        (Status.FILE_READ,
         "the file cannot be read"),
        (Status.BAKED_SIGNATURE,
         "its header is not valid"),
        (Status.BAKED_VERSION,
         "its header is not valid"),
        (Status.BAKED_TRUNCATED,
         "its header is not valid"),
        (Status.BAKED_STRUCTURE,
         "its header is not valid"),
        (Status.BAKED_CHECKSUM,
         "BakedCheck.FULL finds changed bytes"),
    ),
    "mien_baked_open_memory": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.BAKED_SIGNATURE,
         "its header is not valid"),
        (Status.BAKED_VERSION,
         "its header is not valid"),
        (Status.BAKED_TRUNCATED,
         "its header is not valid"),
        (Status.BAKED_STRUCTURE,
         "its header is not valid"),
        (Status.BAKED_CHECKSUM,
         "BakedCheck.FULL finds changed bytes"),
    ),
    "mien_baked_open_stream": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.FILE_READ,
         "the file cannot be read"),
        (Status.BAKED_SIGNATURE,
         "its header is not valid"),
        (Status.BAKED_VERSION,
         "its header is not valid"),
        (Status.BAKED_TRUNCATED,
         "its header is not valid"),
        (Status.BAKED_STRUCTURE,
         "its header is not valid"),
        (Status.BAKED_CHECKSUM,
         "BakedCheck.FULL finds changed bytes"),
    ),
    "mien_baked_info": (),
    "mien_rig_from_baked": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.ISA,
         "the requested instruction set is not available"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.BAKED_VERSION,
         "its rig cannot be used"),
        (Status.BAKED_STRUCTURE,
         "its rig cannot be used"),
        (Status.BAKED_PART,
         "the file has no rig"),
    ),
    "mien_deformer_from_baked": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MISMATCH,
         "`rig` was not created from `baked`"),
        (Status.ISA,
         "the requested instruction set is not available"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.BAKED_VERSION,
         "its deformer cannot be used"),
        (Status.BAKED_STRUCTURE,
         "its deformer cannot be used"),
        (Status.BAKED_PART,
         "the file has no deformer"),
    ),
    "mien_clip_build": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.NAME,
         "a name is empty or occurs twice"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.CLIP_VALUE,
         "a value is not finite (the message names frame and channel)"),
        (Status.CLIP_LIMIT,
         "there are too many frames, channels or bytes"),
    ),
    "mien_clip_open_file": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.FILE_OPEN,
         "the file cannot be read"),
        (Status.FILE_READ,
         "the file cannot be read"),
        (Status.CLIP_SIGNATURE,
         "it is not a valid clip"),
        (Status.CLIP_VERSION,
         "it is not a valid clip"),
        (Status.CLIP_TRUNCATED,
         "it is not a valid clip"),
        (Status.CLIP_STRUCTURE,
         "it is not a valid clip"),
    ),
    "mien_clip_open_memory": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.CLIP_SIGNATURE,
         "it is not a valid clip"),
        (Status.CLIP_VERSION,
         "it is not a valid clip"),
        (Status.CLIP_TRUNCATED,
         "it is not a valid clip"),
        (Status.CLIP_STRUCTURE,
         "it is not a valid clip"),
    ),
    "mien_clip_open_stream": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.FILE_READ,
         "the file cannot be read"),
        (Status.CLIP_SIGNATURE,
         "it is not a valid clip"),
        (Status.CLIP_VERSION,
         "it is not a valid clip"),
        (Status.CLIP_TRUNCATED,
         "it is not a valid clip"),
        (Status.CLIP_STRUCTURE,
         "it is not a valid clip"),
    ),
    "mien_clip_write_file": (
        (Status.MEMORY,
         "the allocator of the clip returns NULL"),
        (Status.FILE_WRITE,
         "the file cannot be written"),
    ),
    "mien_clip_write_memory": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
    ),
    "mien_clip_info": (),
    "mien_clip_channel": (
        (Status.INDEX,
         "`index` is out of range"),
    ),
    "mien_clip_find_channel": (
        (Status.NAME,
         "there is none"),
    ),
    "mien_clip_find_channel_n": (
        (Status.NAME,
         "there is none"),
    ),
    "mien_clip_event": (
        (Status.INDEX,
         "`index` is out of range"),
    ),
    "mien_clip_verify": (
        (Status.CLIP_STRUCTURE,
         "a curve cannot be decoded"),
        (Status.CLIP_CHECKSUM,
         "bytes have changed"),
    ),
    "mien_clip_read": (
        (Status.INVALID_ARGUMENT,
         "frame_stride is too small"),
        (Status.INDEX,
         "the clip has fewer frames"),
        (Status.CLIP_STRUCTURE,
         "a curve is damaged; its block in `out_values` is zero"),
    ),
    "mien_clip_player_create": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "memory runs out"),
    ),
    "mien_clip_player_info": (),
    "mien_clip_player_seek": (),
    "mien_clip_player_set_speed": (
        (Status.INVALID_ARGUMENT,
         "it is outside the range of MienClipPlayerDesc"),
    ),
    "mien_clip_player_advance": (
        (Status.INVALID_ARGUMENT,
         "`ticks` is out of range"),
    ),
    "mien_clip_player_next_event": (),
    "mien_clip_player_sample": (),
    "mien_clip_binding_create": (
        (Status.INVALID_ARGUMENT,
         "a weight is not finite"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.CLIP_LIMIT,
         "channels drive more than 4095 GUI controls"),
    ),
    "mien_arkit_matrix": (),
    "mien_clip_binding_info": (),
    "mien_clip_binding_apply": (
        (Status.INVALID_ARGUMENT,
         "a count differs from that of the clip or the rig"),
    ),
    "mien_clip_binding_snaps": (
        (Status.INVALID_ARGUMENT,
         "`tolerance` is not a number above 0"),
        (Status.MISMATCH,
         "`channel_count` is not that of the binding, or the binding is for another rig"),
        (Status.MEMORY,
         "that returns NULL"),
    ),
    "mien_mix_create": (
        (Status.INVALID_ARGUMENT,
         "a field of `desc` is out of range; the message names it"),
        (Status.MISMATCH,
         "the deformer or the gaze is for another rig"),
        (Status.INDEX,
         "a landmark names a mesh, position or joint that does not exist"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.DNA_LIMIT,
         "guards are measured and raw controls times joints exceed 2^22"),
    ),
    "mien_mix_open_file": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.NAME,
         "the rig lacks controls; the message names them"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.FILE_OPEN,
         "the file cannot be read"),
        (Status.FILE_READ,
         "the file cannot be read"),
        (Status.MIX_SIGNATURE,
         "it is not a valid mix"),
        (Status.MIX_VERSION,
         "it is not a valid mix"),
        (Status.MIX_TRUNCATED,
         "it is not a valid mix"),
        (Status.MIX_STRUCTURE,
         "it is not a valid mix"),
        (Status.MIX_CHECKSUM,
         "it is not a valid mix"),
    ),
    "mien_mix_open_memory": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.NAME,
         "the rig lacks controls; the message names them"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.MIX_SIGNATURE,
         "it is not a valid mix"),
        (Status.MIX_VERSION,
         "it is not a valid mix"),
        (Status.MIX_TRUNCATED,
         "it is not a valid mix"),
        (Status.MIX_STRUCTURE,
         "it is not a valid mix"),
        (Status.MIX_CHECKSUM,
         "it is not a valid mix"),
    ),
    "mien_mix_write_file": (
        (Status.NAME,
         "two of these controls have the same name"),
        (Status.MEMORY,
         "that returns NULL"),
        (Status.FILE_WRITE,
         "the file cannot be written"),
    ),
    "mien_mix_write_memory": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.NAME,
         "mien_mix_write_file() would fail with them"),
        (Status.MEMORY,
         "memory runs out"),
    ),
    "mien_mix_write_text": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.NAME,
         "mien_mix_write_file() would fail with them"),
        (Status.MEMORY,
         "memory runs out"),
    ),
    "mien_mix_info": (),
    "mien_mix_guard": (
        (Status.INDEX,
         "there is no such guard"),
    ),
    "mien_mix_glare": (
        (Status.INVALID_ARGUMENT,
         "`stroke_count` is less than 5"),
    ),
    "mien_mix_antagonists": (),
    "mien_mix_mirror": (
        (Status.MISMATCH,
         "`curve_count` is less than the raw controls"),
        (Status.MEMORY,
         "that returns NULL"),
        (Status.DNA_LIMIT,
         "raw controls times joints exceed 2^22"),
    ),
    "mien_mix_mask": (
        (Status.MISMATCH,
         "`curve_count` is less than the raw controls"),
        (Status.INDEX,
         "a group does not exist"),
        (Status.MEMORY,
         "that returns NULL"),
    ),
    "mien_gaze_create": (
        (Status.INVALID_ARGUMENT,
         "no raw control turns an eye monotonically in one of the four directions"),
        (Status.NAME,
         "there are no such joints"),
        (Status.MEMORY,
         "memory runs out"),
    ),
    "mien_gaze_info": (),
    "mien_gaze_look_at": (
        (Status.INVALID_ARGUMENT,
         "the target is not finite"),
        (Status.MISMATCH,
         "`row_count` is less than the raw controls"),
    ),
    "mien_mixer_create": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "memory runs out"),
    ),
    "mien_mixer_play": (
        (Status.INVALID_ARGUMENT,
         "a time, speed or enum value is out of range or a delta clip would play in a "
         "layer that overrides"),
        (Status.MISMATCH,
         "the binding is for another clip or rig"),
        (Status.INDEX,
         "the layer does not exist or has another source"),
        (Status.CLIP_LIMIT,
         "the clip is larger than the mix allows"),
    ),
    "mien_mixer_stop": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.INDEX,
         "the layer does not exist or is not a clip layer"),
    ),
    "mien_mixer_set_weight": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.INDEX,
         "the layer does not exist"),
    ),
    "mien_mixer_set_pose_weight": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.INDEX,
         "the layer or its pose does not exist"),
    ),
    "mien_mixer_set_variable": (
        (Status.INVALID_ARGUMENT,
         "the value is not finite"),
        (Status.INDEX,
         "it does not exist"),
    ),
    "mien_mixer_set_guard": (
        (Status.INVALID_ARGUMENT,
         "`activation` is above 1 or not a number"),
        (Status.INDEX,
         "the guard does not exist"),
    ),
    "mien_mixer_guard": (
        (Status.INDEX,
         "the guard does not exist"),
    ),
    "mien_mixer_trigger": (
        (Status.INVALID_ARGUMENT,
         "strength or time is out of range"),
        (Status.INDEX,
         "the reaction does not exist"),
    ),
    "mien_mixer_release": (
        (Status.INDEX,
         "the reaction does not exist"),
    ),
    "mien_mixer_set_level": (
        (Status.INVALID_ARGUMENT,
         "it has no level_on or `level` is out of range"),
        (Status.INDEX,
         "the reaction does not exist"),
    ),
    "mien_mixer_push": (
        (Status.INVALID_ARGUMENT,
         "a value is not finite or `tick` is 2^61 or more"),
        (Status.MISMATCH,
         "it has another number of channels"),
        (Status.INDEX,
         "the layer does not exist or is not a stream"),
    ),
    "mien_mixer_step": (
        (Status.INVALID_ARGUMENT,
         "`ticks` is out of range or the time would exceed 2^60 ticks (51 years)"),
        (Status.MISMATCH,
         "the instance has another number of raw controls"),
    ),
    "mien_mixer_step_batch": (
        (Status.INVALID_ARGUMENT,
         "`ticks` is out of range or the time would exceed 2^60 ticks (51 years); or a "
         "mixer is listed twice"),
        (Status.MISMATCH,
         "the instance has another number of raw controls"),
    ),
    "mien_mixer_row": (),
    "mien_mixer_stage": (
        (Status.INVALID_ARGUMENT,
         "MienMixerDesc.stages was 0. Contents change with mien_mixer_step() and "
         "mien_mixer_step_batch()"),
        (Status.INDEX,
         "the stage does not exist"),
    ),
    "mien_mixer_info": (),
    "mien_mixer_event": (
        (Status.INDEX,
         "`index` is out of range"),
    ),
    "mien_mixer_snapshot": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
    ),
    "mien_mixer_restore": (
        (Status.INVALID_ARGUMENT,
         "the bytes are not a snapshot of this mix"),
        (Status.MISMATCH,
         "a clip is missing or is not the one that was playing"),
    ),
    "mien_solver_stack_create": (
        (Status.INVALID_ARGUMENT,
         "a number is out of range, or if a solver reads a joint that a later one moves;"
         " the message names both"),
        (Status.INDEX,
         "a joint or curve does not exist"),
        (Status.MEMORY,
         "memory runs out"),
    ),
    "mien_solver_stack_info": (),
    "mien_solver_state_create": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "memory runs out"),
    ),
    "mien_solver_state_step": (
        (Status.INVALID_ARGUMENT,
         "`ticks` or the LOD is out of range"),
        (Status.MISMATCH,
         "instance and stack have different deformers or the row is shorter than "
         "MienSolverStackDesc.curve_count"),
    ),
    "mien_solver_state_step_batch": (
        (Status.INVALID_ARGUMENT,
         "`ticks` or the LOD is out of range"),
        (Status.MISMATCH,
         "instance and stack have different deformers or the row is shorter than "
         "MienSolverStackDesc.curve_count; or the states have different stacks"),
    ),
    "mien_solver_state_outputs": (
        (Status.INDEX,
         "the solver does not exist"),
    ),
    "mien_solver_state_transforms": (),
    "mien_solver_state_undeclared": (
        (Status.INVALID_ARGUMENT,
         "MienSolverStackDesc.check_writes was 0"),
    ),
    "mien_rig_match": (
        (Status.NAME,
         "the name matches no control of this rig, or several in step 1 or 2"),
    ),
    "mien_control_name": (
        (Status.NAME,
         "the name is not in the table"),
    ),
    "mien_dna_generate": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
    ),
    "mien_author_rig": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
        (Status.DNA_LIMIT,
         "the file would be too large"),
        (Status.AUTHOR_MESH,
         "the arrays of the mesh or of the caller's results contradict each other"),
        (Status.AUTHOR_REFUSED,
         "the mesh cannot be rigged or landmarks contradict it"),
        (Status.AUTHOR_CANCELED,
         "`progress` canceled"),
    ),
    "mien_author_report_json": (),
    "mien_document_create": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
        (Status.DNA_STRUCTURE,
         "the loaded part would not open by itself"),
        (Status.DNA_REFERENCE,
         "the loaded part would not open by itself"),
        (Status.DNA_LIMIT,
         "it exceeds 4 GiB"),
        (Status.DNA_LAYER,
         "`dna` has RBF behavior without the machine-learned behavior of its file"),
        (Status.DNA_VALUE,
         "the loaded part would not open by itself"),
    ),
    "mien_document_open_file": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.FILE_OPEN,
         "the file cannot be read"),
        (Status.FILE_READ,
         "the file cannot be read"),
        (Status.DNA_SIGNATURE,
         "it is not a DNA file of generation 2"),
        (Status.DNA_VERSION,
         "it is not a DNA file of generation 2"),
        (Status.DNA_TRUNCATED,
         "its contents are not valid or cannot be converted to the requested system"),
        (Status.DNA_STRUCTURE,
         "its contents are not valid or cannot be converted to the requested system"),
        (Status.DNA_REFERENCE,
         "its contents are not valid or cannot be converted to the requested system"),
        (Status.DNA_LIMIT,
         "its contents are not valid or cannot be converted to the requested system"),
        (Status.DNA_VALUE,
         "its contents are not valid or cannot be converted to the requested system"),
    ),
    "mien_document_field": (
        (Status.INDEX,
         "an index in the path is past the end"),
        (Status.NAME,
         "there is no such field"),
    ),
    "mien_document_child_name": (
        (Status.INVALID_ARGUMENT,
         "the field is not a record"),
        (Status.INDEX,
         "`index` or an index in the path is past the end"),
        (Status.NAME,
         "there is no such field"),
    ),
    "mien_document_read_floats": (
        (Status.INVALID_ARGUMENT,
         "the field does not hold numbers of this kind"),
        (Status.INDEX,
         "the range or an index in the path is past the end"),
        (Status.NAME,
         "there is no such field"),
    ),
    "mien_document_read_integers": (
        (Status.INVALID_ARGUMENT,
         "the field does not hold numbers of this kind"),
        (Status.INDEX,
         "the range or an index in the path is past the end"),
        (Status.NAME,
         "there is no such field"),
    ),
    "mien_document_read_string": (
        (Status.INVALID_ARGUMENT,
         "the field is not a string"),
        (Status.INDEX,
         "an index in the path is past the end"),
        (Status.NAME,
         "there is no such field"),
    ),
    "mien_document_bytes": (
        (Status.INVALID_ARGUMENT,
         "the field is neither an array nor a string"),
        (Status.INDEX,
         "an index in the path is past the end"),
        (Status.NAME,
         "there is no such field"),
    ),
    "mien_document_write_floats": (
        (Status.INVALID_ARGUMENT,
         "the field does not hold numbers of this kind, or none of this size"),
        (Status.INDEX,
         "the range or an index in the path is past the end"),
        (Status.NAME,
         "there is no such field"),
        (Status.MEMORY,
         "the allocator returns NULL"),
    ),
    "mien_document_write_integers": (
        (Status.INVALID_ARGUMENT,
         "the field does not hold numbers of this kind, or none of this size"),
        (Status.INDEX,
         "the range or an index in the path is past the end"),
        (Status.NAME,
         "there is no such field"),
        (Status.MEMORY,
         "the allocator returns NULL"),
    ),
    "mien_document_write_string": (
        (Status.INVALID_ARGUMENT,
         "the field is not a string, or if another element of a list of names has this "
         "name"),
        (Status.INDEX,
         "an index in the path is past the end"),
        (Status.NAME,
         "there is no such field"),
        (Status.MEMORY,
         "the allocator returns NULL"),
    ),
    "mien_document_splice": (
        (Status.INVALID_ARGUMENT,
         "the field is neither an array nor a list, or would have more than 2^32 - 1 "
         "elements"),
        (Status.INDEX,
         "the range or an index in the path is past the end"),
        (Status.NAME,
         "there is no such field"),
        (Status.MEMORY,
         "the allocator returns NULL"),
    ),
    "mien_document_resize": (
        (Status.INVALID_ARGUMENT,
         "the field is neither an array nor a list, or would have more than 2^32 - 1 "
         "elements"),
        (Status.INDEX,
         "the range or an index in the path is past the end"),
        (Status.NAME,
         "there is no such field"),
        (Status.MEMORY,
         "the allocator returns NULL"),
    ),
    "mien_document_layer_count": (),
    "mien_document_layer": (
        (Status.INDEX,
         "`index` is past the end"),
    ),
    "mien_document_clear_layers": (
        (Status.INVALID_ARGUMENT,
         "`version` is not 1 to 65535"),
        (Status.MEMORY,
         "the allocator returns NULL"),
    ),
    "mien_document_add_layer": (
        (Status.INVALID_ARGUMENT,
         "`code` has another length, a version is above 65535, the list has a layer of "
         "this code and version already, the kind is known and has bytes, or a file of "
         "version 2.1 cannot have it"),
        (Status.MEMORY,
         "the allocator returns NULL"),
    ),
    "mien_document_mark": (
        (Status.MEMORY,
         "the allocator returns NULL"),
    ),
    "mien_document_undo": (
        (Status.INDEX,
         "`mark` is not a valid mark of the document"),
    ),
    "mien_document_find": (
        (Status.INVALID_ARGUMENT,
         "the kind has no names in a document"),
        (Status.NAME,
         "there is no such name"),
    ),
    "mien_document_rename": (
        (Status.INVALID_ARGUMENT,
         "another element of the kind has the name, or the kind has no names in a "
         "document"),
        (Status.INDEX,
         "there is no such element"),
        (Status.MEMORY,
         "the allocator returns NULL"),
    ),
    "mien_document_remove": (
        (Status.INVALID_ARGUMENT,
         "the networks or the version need a control, or no joint would be left for the "
         "skin weights"),
        (Status.INDEX,
         "an index is past the end"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.DNA_STRUCTURE,
         "the document is not valid"),
        (Status.DNA_REFERENCE,
         "the document is not valid"),
        (Status.DNA_LIMIT,
         "the document is not valid"),
        (Status.DNA_VALUE,
         "the document is not valid"),
    ),
    "mien_document_clear": (
        (Status.INVALID_ARGUMENT,
         "the networks or the version need a control, or no joint would be left for the "
         "skin weights"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.DNA_STRUCTURE,
         "the document is not valid"),
        (Status.DNA_REFERENCE,
         "the document is not valid"),
        (Status.DNA_LIMIT,
         "the document is not valid"),
        (Status.DNA_VALUE,
         "the document is not valid"),
    ),
    "mien_document_clear_joints": (
        (Status.INVALID_ARGUMENT,
         "the networks or the version need a control, or no joint would be left for the "
         "skin weights"),
        (Status.INDEX,
         "an index is past the end"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.DNA_STRUCTURE,
         "the document is not valid"),
        (Status.DNA_REFERENCE,
         "the document is not valid"),
        (Status.DNA_LIMIT,
         "the document is not valid"),
        (Status.DNA_VALUE,
         "the document is not valid"),
    ),
    "mien_document_set_neutral": (
        (Status.INVALID_ARGUMENT,
         "a number is not finite"),
        (Status.INDEX,
         "there are fewer joints"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.DNA_STRUCTURE,
         "the document is not valid"),
        (Status.DNA_REFERENCE,
         "the document is not valid"),
        (Status.DNA_LIMIT,
         "the document is not valid"),
        (Status.DNA_VALUE,
         "the document is not valid"),
    ),
    "mien_document_set_positions": (
        (Status.INVALID_ARGUMENT,
         "the mesh has another number of positions, or a number is not finite"),
        (Status.INDEX,
         "`mesh` is past the end"),
        (Status.MEMORY,
         "the allocator returns NULL"),
    ),
    "mien_document_set_target": (
        (Status.INVALID_ARGUMENT,
         "there are more deltas than positions, or a number is not finite"),
        (Status.INDEX,
         "`mesh`, `channel` or a vertex is past the end"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.DNA_STRUCTURE,
         "the document is not valid"),
        (Status.DNA_REFERENCE,
         "the document is not valid"),
        (Status.DNA_LIMIT,
         "the document is not valid"),
        (Status.DNA_VALUE,
         "the document is not valid"),
    ),
    "mien_document_prune_targets": (
        (Status.INVALID_ARGUMENT,
         "`tolerance` is negative or not finite"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.DNA_STRUCTURE,
         "the document is not valid"),
        (Status.DNA_REFERENCE,
         "the document is not valid"),
        (Status.DNA_LIMIT,
         "the document is not valid"),
        (Status.DNA_VALUE,
         "the document is not valid"),
    ),
    "mien_document_prune_joints": (
        (Status.INVALID_ARGUMENT,
         "a field of `desc` is negative or not finite"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.DNA_STRUCTURE,
         "the document is not valid"),
        (Status.DNA_REFERENCE,
         "the document is not valid"),
        (Status.DNA_LIMIT,
         "the document is not valid"),
        (Status.DNA_VALUE,
         "the document is not valid"),
    ),
    "mien_document_set_weights": (
        (Status.INVALID_ARGUMENT,
         "there is another number of weights, a weight is negative or not finite, a "
         "joint does not exist, or a position has a joint twice or no weight"),
        (Status.INDEX,
         "`mesh` is past the end"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.DNA_STRUCTURE,
         "the document is not valid"),
        (Status.DNA_REFERENCE,
         "the document is not valid"),
        (Status.DNA_LIMIT,
         "the document is not valid"),
        (Status.DNA_VALUE,
         "the document is not valid"),
    ),
    "mien_document_normalize_weights": (
        (Status.INDEX,
         "`mesh` is past the end"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.DNA_STRUCTURE,
         "the document is not valid"),
        (Status.DNA_REFERENCE,
         "the document is not valid"),
        (Status.DNA_LIMIT,
         "the document is not valid"),
        (Status.DNA_VALUE,
         "the document is not valid"),
    ),
    "mien_document_limit_influences": (
        (Status.INVALID_ARGUMENT,
         "`influences` is 0"),
        (Status.INDEX,
         "`mesh` is past the end"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.DNA_STRUCTURE,
         "the document is not valid"),
        (Status.DNA_REFERENCE,
         "the document is not valid"),
        (Status.DNA_LIMIT,
         "the document is not valid"),
        (Status.DNA_VALUE,
         "the document is not valid"),
    ),
    "mien_document_smooth_weights": (
        (Status.INVALID_ARGUMENT,
         "`influences` is 0; or `strength` is not 0 to 1, or there are more than 1000 "
         "iterations"),
        (Status.INDEX,
         "`mesh` is past the end"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.DNA_STRUCTURE,
         "the document is not valid"),
        (Status.DNA_REFERENCE,
         "the document is not valid"),
        (Status.DNA_LIMIT,
         "the document is not valid"),
        (Status.DNA_VALUE,
         "the document is not valid"),
    ),
    "mien_document_place": (
        (Status.INVALID_ARGUMENT,
         "a number is not finite or the scale is negative"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.DNA_STRUCTURE,
         "the document is not valid"),
        (Status.DNA_REFERENCE,
         "the document is not valid"),
        (Status.DNA_LIMIT,
         "the document is not valid"),
        (Status.DNA_VALUE,
         "a root joint is moved by controls and the rotation is not 0, networks "
         "translate joints and the scale is not 1, or the document is not valid"),
    ),
    "mien_document_keep_lods": (
        (Status.LOD,
         "none of them exists"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.DNA_STRUCTURE,
         "the document is not valid"),
        (Status.DNA_REFERENCE,
         "the document is not valid"),
        (Status.DNA_LIMIT,
         "the document is not valid"),
        (Status.DNA_VALUE,
         "the document is not valid"),
    ),
    "mien_document_convert": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.DNA_STRUCTURE,
         "the document is not valid"),
        (Status.DNA_REFERENCE,
         "the document is not valid"),
        (Status.DNA_LIMIT,
         "the document is not valid"),
        (Status.DNA_VALUE,
         "the rig cannot be converted or the document is not valid"),
    ),
    "mien_document_copy_layers": (
        (Status.INVALID_ARGUMENT,
         "`layers` has other bits"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.DNA_STRUCTURE,
         "they do not fit the other layers"),
        (Status.DNA_REFERENCE,
         "they do not fit the other layers"),
        (Status.DNA_LIMIT,
         "they do not fit the other layers"),
        (Status.DNA_VALUE,
         "they do not fit the other layers"),
    ),
    "mien_document_copy_mesh": (
        (Status.INVALID_ARGUMENT,
         "both documents are the same"),
        (Status.MISMATCH,
         "the documents differ in axes, units or rotations, or this one has no joint of "
         "a position"),
        (Status.INDEX,
         "there is no such mesh"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.DNA_STRUCTURE,
         "one of them is not valid"),
        (Status.DNA_REFERENCE,
         "one of them is not valid"),
        (Status.DNA_LIMIT,
         "one of them is not valid"),
        (Status.DNA_VALUE,
         "one of them is not valid"),
    ),
    "mien_document_merge_joints": (
        (Status.INVALID_ARGUMENT,
         "both documents are the same"),
        (Status.MISMATCH,
         "they differ in axes, units or rotations, or in the place of a joint"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.DNA_STRUCTURE,
         "one of them is not valid or the result would not be"),
        (Status.DNA_REFERENCE,
         "one of them is not valid or the result would not be"),
        (Status.DNA_LIMIT,
         "one of them is not valid or the result would not be"),
        (Status.DNA_VALUE,
         "one of them is not valid or the result would not be"),
    ),
    "mien_document_split_joints": (
        (Status.INVALID_ARGUMENT,
         "no joint would be left for the skin weights"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.DNA_STRUCTURE,
         "`document` is not valid"),
        (Status.DNA_REFERENCE,
         "`document` is not valid"),
        (Status.DNA_LIMIT,
         "`document` is not valid"),
        (Status.DNA_VALUE,
         "`document` is not valid"),
    ),
    "mien_document_project": (
        (Status.INVALID_ARGUMENT,
         "they are the same, or lack triangles, texture coordinates or weights"),
        (Status.INDEX,
         "`mesh` or `source` is past the end"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.DNA_STRUCTURE,
         "the document is not valid"),
        (Status.DNA_REFERENCE,
         "the document is not valid"),
        (Status.DNA_LIMIT,
         "the document is not valid"),
        (Status.DNA_VALUE,
         "the document is not valid"),
    ),
    "mien_document_make_lod": (
        (Status.INVALID_ARGUMENT,
         "the LODs are the same, or meshes lack triangles, texture coordinates or "
         "weights"),
        (Status.LOD,
         "there is no such LOD"),
        (Status.NAME,
         "a mesh has no counterpart"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.DNA_STRUCTURE,
         "the document is not valid"),
        (Status.DNA_REFERENCE,
         "the document is not valid"),
        (Status.DNA_LIMIT,
         "the document is not valid"),
        (Status.DNA_VALUE,
         "the document is not valid"),
    ),
    "mien_document_conform": (
        (Status.INVALID_ARGUMENT,
         "the mesh has another number of positions, or a number is not finite"),
        (Status.INDEX,
         "`mesh` is past the end"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.DNA_STRUCTURE,
         "the document is not valid"),
        (Status.DNA_REFERENCE,
         "the document is not valid"),
        (Status.DNA_LIMIT,
         "the document is not valid"),
        (Status.DNA_VALUE,
         "the document is not valid"),
    ),
    "mien_document_transplant": (
        (Status.INVALID_ARGUMENT,
         "no mesh of LOD 0 has the name of one of the template, or meshes lack triangles"
         " or texture coordinates"),
        (Status.MISMATCH,
         "the documents differ in axes, units or rotations"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.DNA_STRUCTURE,
         "one of them is not valid"),
        (Status.DNA_REFERENCE,
         "one of them is not valid"),
        (Status.DNA_LIMIT,
         "one of them is not valid"),
        (Status.DNA_VALUE,
         "one of them is not valid"),
    ),
    "mien_document_to_dna": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
        (Status.DNA_TRUNCATED,
         "the document is not a valid file; the message names the first invalid field, "
         "mien_document_validate() lists them all"),
        (Status.DNA_STRUCTURE,
         "the document is not a valid file; the message names the first invalid field, "
         "mien_document_validate() lists them all"),
        (Status.DNA_REFERENCE,
         "the document is not a valid file; the message names the first invalid field, "
         "mien_document_validate() lists them all"),
        (Status.DNA_LIMIT,
         "the document is not a valid file; the message names the first invalid field, "
         "mien_document_validate() lists them all"),
        (Status.DNA_VALUE,
         "the document is not a valid file; the message names the first invalid field, "
         "mien_document_validate() lists them all"),
    ),
    "mien_document_write_file": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.FILE_WRITE,
         "the file cannot be written"),
        (Status.DNA_STRUCTURE,
         "the document is not a valid file, or would not be one in the requested version"),
        (Status.DNA_REFERENCE,
         "the document is not a valid file, or would not be one in the requested version"),
        (Status.DNA_LIMIT,
         "the file would exceed 4 GiB"),
        (Status.DNA_VALUE,
         "the document is not a valid file, or would not be one in the requested version"),
    ),
    "mien_document_write_stream": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "the allocator returns NULL"),
        (Status.FILE_WRITE,
         "the file cannot be written; or `sink` does not take a piece"),
        (Status.DNA_STRUCTURE,
         "the document is not a valid file, or would not be one in the requested version"),
        (Status.DNA_REFERENCE,
         "the document is not a valid file, or would not be one in the requested version"),
        (Status.DNA_LIMIT,
         "the file would exceed 4 GiB"),
        (Status.DNA_VALUE,
         "the document is not a valid file, or would not be one in the requested version"),
    ),
    "mien_document_write_memory": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.DNA_STRUCTURE,
         "the document is not a valid file, or would not be one in the requested version"),
        (Status.DNA_REFERENCE,
         "the document is not a valid file, or would not be one in the requested version"),
        (Status.DNA_LIMIT,
         "the file would exceed 4 GiB"),
        (Status.DNA_VALUE,
         "the document is not a valid file, or would not be one in the requested version"),
    ),
    "mien_document_validate": (
        (Status.INVALID_ARGUMENT,
         "an argument is outside its range"),
        (Status.MEMORY,
         "memory runs out"),
        (Status.UNSUPPORTED,
         "this build of libmien opens baked files only"),
        (Status.DNA_LIMIT,
         "the file would exceed 4 GiB"),
    ),
    "mien_fit_create": (
        (Status.INVALID_ARGUMENT,
         "controls are not ascending, a lower bound is above its upper one, or a weight "
         "is not finite"),
        (Status.MISMATCH,
         "the deformer belongs to another rig"),
        (Status.INDEX,
         "a control, position or mesh does not exist"),
        (Status.LOD,
         "the rig has no such LOD"),
        (Status.MEMORY,
         "memory runs out"),
    ),
    "mien_fit_surface_create": (
        (Status.INVALID_ARGUMENT,
         "there are no triangles, or a coordinate is not finite"),
        (Status.INDEX,
         "a position does not exist"),
        (Status.MEMORY,
         "memory runs out"),
    ),
    "mien_fit_solve": (
        (Status.INVALID_ARGUMENT,
         "a stage is above 15, or a weight, a control, an offset or a number of the "
         "camera is not finite, or a weight is negative"),
        (Status.INDEX,
         "a constraint has a joint or point that does not exist"),
    ),
    "mien_fit_solve_frames": (
        (Status.INVALID_ARGUMENT,
         "a stage is above 15, or a weight, a control, an offset or a number of the "
         "camera is not finite, or a weight is negative"),
        (Status.INDEX,
         "a constraint has a joint or point that does not exist"),
    ),
    "mien_fit_observability": (
        (Status.INVALID_ARGUMENT,
         "`count` is another number"),
    ),
    "mien_fit_keys": (
        (Status.INVALID_ARGUMENT,
         "a value is not finite, or the tolerance is negative or not finite"),
    ),
}


# Name, result, parameters.
FUNCTIONS: Tuple[Tuple[str, Any, Tuple[Any, ...]], ...] = (
    ("mien_version", c_uint32, ()),
    ("mien_status_name", c_char_p, (c_int32,)),
    ("mien_coordinate_system_find", c_int32, (c_char_p, POINTER(MienCoordinateSystem))),
    ("mien_coordinate_system_find_n", c_int32, (c_char_p, c_size_t, POINTER(MienCoordinateSystem))),
    ("mien_coordinate_system_name", c_int32, (c_uint32, POINTER(MienStringView))),
    ("mien_dna_open_file", c_int32, (c_char_p, POINTER(MienDnaDesc), POINTER(MienDna),
     POINTER(MienError))),
    ("mien_dna_open_memory", c_int32, (c_void_p, c_size_t, POINTER(MienDnaDesc), POINTER(MienDna),
     POINTER(MienError))),
    ("mien_dna_open_stream", c_int32, (POINTER(MienStream), POINTER(MienDnaDesc), POINTER(MienDna),
     POINTER(MienError))),
    ("mien_dna_close", None, (MienDna,)),
    ("mien_dna_info", c_int32, (MienDna, POINTER(MienDnaInfo))),
    ("mien_dna_layer", c_int32, (MienDna, c_uint32, POINTER(MienDnaLayer))),
    ("mien_dna_field", c_int32, (MienDna, c_char_p, POINTER(MienDnaField), POINTER(MienError))),
    ("mien_dna_field_n", c_int32, (MienDna, c_char_p, c_size_t, POINTER(MienDnaField),
     POINTER(MienError))),
    ("mien_dna_child_name", c_int32, (MienDna, c_char_p, c_uint32, POINTER(MienStringView),
     POINTER(MienError))),
    ("mien_dna_child_name_n", c_int32, (MienDna, c_char_p, c_size_t, c_uint32,
     POINTER(MienStringView), POINTER(MienError))),
    ("mien_dna_read_floats", c_int32, (MienDna, c_char_p, c_uint64, c_uint64, c_void_p,
     POINTER(MienError))),
    ("mien_dna_read_floats_n", c_int32, (MienDna, c_char_p, c_size_t, c_uint64, c_uint64, c_void_p,
     POINTER(MienError))),
    ("mien_dna_read_integers", c_int32, (MienDna, c_char_p, c_uint64, c_uint64, c_void_p,
     POINTER(MienError))),
    ("mien_dna_read_integers_n", c_int32, (MienDna, c_char_p, c_size_t, c_uint64, c_uint64,
     c_void_p, POINTER(MienError))),
    ("mien_dna_read_string", c_int32, (MienDna, c_char_p, POINTER(MienStringView),
     POINTER(MienError))),
    ("mien_dna_read_string_n", c_int32, (MienDna, c_char_p, c_size_t, POINTER(MienStringView),
     POINTER(MienError))),
    ("mien_dna_write_file", c_int32, (MienDna, c_char_p, POINTER(MienWriteDesc),
     POINTER(MienError))),
    ("mien_dna_write_memory", c_int32, (MienDna, POINTER(MienWriteDesc), c_void_p, c_size_t,
     c_void_p, POINTER(MienError))),
    ("mien_dna_validate_file", c_int32, (c_char_p, POINTER(MienValidateDesc), POINTER(MienReport),
     POINTER(MienError))),
    ("mien_dna_validate_memory", c_int32, (c_void_p, c_size_t, POINTER(MienValidateDesc),
     POINTER(MienReport), POINTER(MienError))),
    ("mien_report_counts", c_int32, (MienReport, c_void_p, c_void_p)),
    ("mien_report_finding", c_int32, (MienReport, c_uint32, POINTER(MienFinding))),
    ("mien_report_destroy", None, (MienReport,)),
    ("mien_isa_available", c_uint32, (c_uint32,)),
    ("mien_isa_name", c_char_p, (c_uint32,)),
    ("mien_rig_create", c_int32, (MienDna, POINTER(MienRigDesc), POINTER(MienRig),
     POINTER(MienError))),
    ("mien_rig_destroy", None, (MienRig,)),
    ("mien_rig_info", c_int32, (MienRig, POINTER(MienRigInfo))),
    ("mien_rig_count", c_int32, (MienRig, c_uint32, c_void_p)),
    ("mien_rig_name", c_int32, (MienRig, c_uint32, c_uint32, POINTER(MienStringView))),
    ("mien_rig_find", c_int32, (MienRig, c_uint32, c_char_p, c_void_p)),
    ("mien_rig_find_n", c_int32, (MienRig, c_uint32, c_char_p, c_size_t, c_void_p)),
    ("mien_rig_lod_indices", c_int32, (MienRig, c_uint32, c_uint32, POINTER(MienIndex16View))),
    ("mien_rig_variable_joint_values", c_int32, (MienRig, c_uint32, POINTER(MienIndex16View))),
    ("mien_rig_joint_parents", c_int32, (MienRig, POINTER(MienIndex16View))),
    ("mien_rig_neutral_joint_values", c_int32, (MienRig, POINTER(MienFloatView))),
    ("mien_rig_psd_inputs", c_int32, (MienRig, c_uint32, POINTER(MienIndex16View))),
    ("mien_rig_initial_raw_controls", c_int32, (MienRig, POINTER(MienFloatView))),
    ("mien_rig_statistics", c_int32, (MienRig, c_uint32, POINTER(MienRigStatistics))),
    ("mien_instance_create", c_int32, (MienRig, POINTER(MienInstanceDesc), POINTER(MienInstance),
     POINTER(MienError))),
    ("mien_instance_destroy", None, (MienInstance,)),
    ("mien_instance_reset", c_int32, (MienInstance,)),
    ("mien_instance_gui_controls", c_int32, (MienInstance, POINTER(MienMutableFloatView))),
    ("mien_instance_raw_controls", c_int32, (MienInstance, POINTER(MienMutableFloatView))),
    ("mien_instance_ml_masks", c_int32, (MienInstance, POINTER(MienMutableFloatView))),
    ("mien_instance_controls", c_int32, (MienInstance, POINTER(MienFloatView))),
    ("mien_instance_psd_controls", c_int32, (MienInstance, POINTER(MienFloatView))),
    ("mien_instance_ml_controls", c_int32, (MienInstance, POINTER(MienFloatView))),
    ("mien_instance_rbf_controls", c_int32, (MienInstance, POINTER(MienFloatView))),
    ("mien_instance_joints", c_int32, (MienInstance, POINTER(MienFloatView))),
    ("mien_instance_blend_shapes", c_int32, (MienInstance, POINTER(MienFloatView))),
    ("mien_instance_animated_maps", c_int32, (MienInstance, POINTER(MienFloatView))),
    ("mien_instance_statistics", c_int32, (MienInstance, POINTER(MienInstanceStatistics))),
    ("mien_rig_map_gui_to_raw", c_int32, (MienRig, MienInstance)),
    ("mien_rig_map_raw_to_gui", c_int32, (MienRig, MienInstance)),
    ("mien_rig_evaluate", c_int32, (MienRig, MienInstance, c_uint32)),
    ("mien_rig_evaluate_stages", c_int32, (MienRig, MienInstance, c_uint32, c_uint32)),
    ("mien_batch_create", c_int32, (MienRig, POINTER(MienBatchDesc), POINTER(MienBatch),
     POINTER(MienError))),
    ("mien_batch_destroy", None, (MienBatch,)),
    ("mien_batch_bytes", c_int32, (MienRig, POINTER(MienBatchDesc), c_void_p)),
    ("mien_rig_evaluate_batch", c_int32, (MienRig, MienBatch, POINTER(MienInstance), c_void_p,
     c_uint32, c_uint32, POINTER(MienParallelFor))),
    ("mien_rig_evaluate_joint_group", c_int32, (MienRig, MienInstance, c_uint32, c_uint32)),
    ("mien_rig_evaluate_rbf_solver", c_int32, (MienRig, MienInstance, c_uint32, c_uint32)),
    ("mien_rig_evaluate_twist_swing", c_int32, (MienRig, MienInstance, c_uint32, c_uint32)),
    ("mien_deformer_create", c_int32, (MienDna, MienRig, POINTER(MienDeformerDesc),
     POINTER(MienDeformer), POINTER(MienError))),
    ("mien_deformer_create_subset", c_int32, (MienDeformer, c_uint32, c_void_p, c_size_t,
     POINTER(MienAllocator), POINTER(MienDeformer), POINTER(MienError))),
    ("mien_deformer_destroy", None, (MienDeformer,)),
    ("mien_deformer_info", c_int32, (MienDeformer, POINTER(MienDeformerInfo))),
    ("mien_deformer_mesh", c_int32, (MienDeformer, c_uint32, POINTER(MienMesh))),
    ("mien_deformer_triangles", c_int32, (MienDeformer, c_uint32, c_void_p, c_size_t)),
    ("mien_deformer_texture_coordinates", c_int32, (MienDeformer, c_uint32, c_void_p, c_size_t)),
    ("mien_deformer_influences", c_int32, (MienDeformer, c_uint32, c_uint32,
     POINTER(MienIndex16View), POINTER(MienFloatView))),
    ("mien_deformer_target", c_int32, (MienDeformer, c_uint32, c_uint32, c_void_p, c_size_t)),
    ("mien_deformer_bind_matrices", c_int32, (MienDeformer, POINTER(MienFloatView))),
    ("mien_deformer_inverse_bind_matrices", c_int32, (MienDeformer, POINTER(MienFloatView))),
    ("mien_deformer_instance_create", c_int32, (MienDeformer, POINTER(MienDeformerInstanceDesc),
     POINTER(MienDeformerInstance), POINTER(MienError))),
    ("mien_deformer_instance_destroy", None, (MienDeformerInstance,)),
    ("mien_deformer_instance_update", c_int32, (MienDeformerInstance, MienInstance)),
    ("mien_deformer_instance_update_from_values", c_int32, (MienDeformerInstance, c_void_p,
     c_size_t, c_void_p, c_size_t)),
    ("mien_deformer_instance_joint_matrices", c_int32, (MienDeformerInstance,
     POINTER(MienFloatView))),
    ("mien_deformer_instance_skin_matrices", c_int32, (MienDeformerInstance,
     POINTER(MienFloatView))),
    ("mien_deformer_instance_local_transforms", c_int32, (MienDeformerInstance, c_void_p,
     c_size_t)),
    ("mien_deformer_instance_deform", c_int32, (MienDeformerInstance, c_uint32, c_uint32,
     POINTER(MienParallelFor))),
    ("mien_deformer_instance_deform_batch", c_int32, (POINTER(MienDeformerInstance), c_size_t,
     c_uint32, c_uint32, POINTER(MienParallelFor))),
    ("mien_deformer_instance_positions", c_int32, (MienDeformerInstance, c_uint32,
     POINTER(MienFloatView))),
    ("mien_deformer_instance_normals", c_int32, (MienDeformerInstance, c_uint32,
     POINTER(MienFloatView))),
    ("mien_deformer_instance_write_vertices", c_int32, (MienDeformerInstance, c_uint32, c_uint32,
     POINTER(MienVertexOutput), POINTER(MienParallelFor))),
    ("mien_deformer_instance_write_vertices_batch", c_int32, (POINTER(MienDeformerInstance),
     c_size_t, c_uint32, c_uint32, POINTER(MienVertexOutput), POINTER(MienParallelFor))),
    ("mien_derivatives_create", c_int32, (MienRig, POINTER(MienDerivativesDesc),
     POINTER(MienDerivatives), POINTER(MienError))),
    ("mien_derivatives_destroy", None, (MienDerivatives,)),
    ("mien_derivatives_bytes", c_int32, (MienRig, POINTER(MienDerivativesDesc), c_void_p)),
    ("mien_derivatives_size", c_int32, (MienDerivatives, c_uint32, c_uint32, c_void_p)),
    ("mien_derivatives_linearize", c_int32, (MienDerivatives, MienInstance, c_uint32)),
    ("mien_derivatives_forward", c_int32, (MienDerivatives, c_uint32, c_uint32, c_uint32, c_uint32,
     c_void_p, c_void_p)),
    ("mien_derivatives_reverse", c_int32, (MienDerivatives, c_uint32, c_uint32, c_uint32, c_uint32,
     c_void_p, c_void_p)),
    ("mien_jacobian_create", c_int32, (MienDerivatives, POINTER(MienJacobianDesc),
     POINTER(MienJacobian), POINTER(MienError))),
    ("mien_jacobian_destroy", None, (MienJacobian,)),
    ("mien_jacobian_pattern", c_int32, (MienJacobian, POINTER(MienJacobianPattern))),
    ("mien_derivatives_jacobian", c_int32, (MienDerivatives, MienJacobian, c_void_p, c_size_t,
     c_void_p, c_size_t)),
    ("mien_bake_file", c_int32, (MienRig, MienDeformer, c_char_p, POINTER(MienError))),
    ("mien_bake_memory", c_int32, (MienRig, MienDeformer, c_void_p, c_size_t, c_void_p,
     POINTER(MienError))),
    ("mien_baked_open_file", c_int32, (c_char_p, POINTER(MienBakedDesc), POINTER(MienBaked),
     POINTER(MienError))),
    ("mien_baked_open_memory", c_int32, (c_void_p, c_size_t, POINTER(MienBakedDesc),
     POINTER(MienBaked), POINTER(MienError))),
    ("mien_baked_open_stream", c_int32, (POINTER(MienStream), POINTER(MienBakedDesc),
     POINTER(MienBaked), POINTER(MienError))),
    ("mien_baked_close", None, (MienBaked,)),
    ("mien_baked_info", c_int32, (MienBaked, POINTER(MienBakedInfo))),
    ("mien_rig_from_baked", c_int32, (MienBaked, POINTER(MienBakedRigDesc), POINTER(MienRig),
     POINTER(MienError))),
    ("mien_deformer_from_baked", c_int32, (MienBaked, MienRig, POINTER(MienBakedDeformerDesc),
     POINTER(MienDeformer), POINTER(MienError))),
    ("mien_clip_build", c_int32, (POINTER(MienClipDesc), POINTER(MienClip), POINTER(MienError))),
    ("mien_clip_open_file", c_int32, (c_char_p, POINTER(MienClipOpenDesc), POINTER(MienClip),
     POINTER(MienError))),
    ("mien_clip_open_memory", c_int32, (c_void_p, c_size_t, POINTER(MienClipOpenDesc),
     POINTER(MienClip), POINTER(MienError))),
    ("mien_clip_open_stream", c_int32, (POINTER(MienStream), POINTER(MienClipOpenDesc),
     POINTER(MienClip), POINTER(MienError))),
    ("mien_clip_close", None, (MienClip,)),
    ("mien_clip_write_file", c_int32, (MienClip, c_char_p, POINTER(MienError))),
    ("mien_clip_write_memory", c_int32, (MienClip, c_void_p, c_size_t, c_void_p,
     POINTER(MienError))),
    ("mien_clip_info", c_int32, (MienClip, POINTER(MienClipInfo))),
    ("mien_clip_channel", c_int32, (MienClip, c_uint32, POINTER(MienClipChannel))),
    ("mien_clip_find_channel", c_int32, (MienClip, c_char_p, c_void_p)),
    ("mien_clip_find_channel_n", c_int32, (MienClip, c_char_p, c_size_t, c_void_p)),
    ("mien_clip_event", c_int32, (MienClip, c_uint32, POINTER(MienClipEvent))),
    ("mien_clip_verify", c_int32, (MienClip, POINTER(MienError))),
    ("mien_clip_read", c_int32, (MienClip, c_uint32, c_uint32, c_void_p, c_size_t,
     POINTER(MienError))),
    ("mien_clip_player_create", c_int32, (MienClip, POINTER(MienClipPlayerDesc),
     POINTER(MienClipPlayer), POINTER(MienError))),
    ("mien_clip_player_destroy", None, (MienClipPlayer,)),
    ("mien_clip_player_info", c_int32, (MienClipPlayer, POINTER(MienClipPlayerInfo))),
    ("mien_clip_player_seek", c_int32, (MienClipPlayer, c_int64)),
    ("mien_clip_player_set_speed", c_int32, (MienClipPlayer, c_int32, c_int32)),
    ("mien_clip_player_advance", c_int32, (MienClipPlayer, c_int64)),
    ("mien_clip_player_next_event", c_int32, (MienClipPlayer, POINTER(MienClipEvent), c_void_p)),
    ("mien_clip_player_sample", c_int32, (MienClipPlayer, POINTER(MienFloatView))),
    ("mien_clip_binding_create", c_int32, (MienClip, MienRig, POINTER(MienClipBindingDesc),
     POINTER(MienClipBinding), POINTER(MienError))),
    ("mien_arkit_matrix", c_int32, (POINTER(MienMatrixEntry), c_size_t, c_void_p)),
    ("mien_clip_binding_destroy", None, (MienClipBinding,)),
    ("mien_clip_binding_info", c_int32, (MienClipBinding, POINTER(MienClipBindingInfo))),
    ("mien_clip_binding_apply", c_int32, (MienClipBinding, c_void_p, c_size_t, c_void_p, c_size_t)),
    ("mien_clip_binding_snaps", c_int32, (MienClipBinding, MienDeformer, c_float, c_void_p,
     c_size_t, POINTER(MienError))),
    ("mien_mix_create", c_int32, (MienRig, POINTER(MienMixDesc), POINTER(MienMix),
     POINTER(MienError))),
    ("mien_mix_open_file", c_int32, (c_char_p, MienRig, POINTER(MienMixOpenDesc), POINTER(MienMix),
     POINTER(MienError))),
    ("mien_mix_open_memory", c_int32, (c_void_p, c_size_t, MienRig, POINTER(MienMixOpenDesc),
     POINTER(MienMix), POINTER(MienError))),
    ("mien_mix_write_file", c_int32, (MienMix, c_char_p, POINTER(MienError))),
    ("mien_mix_write_memory", c_int32, (MienMix, c_void_p, c_size_t, c_void_p, POINTER(MienError))),
    ("mien_mix_write_text", c_int32, (MienMix, c_void_p, c_size_t, c_void_p, POINTER(MienError))),
    ("mien_mix_destroy", None, (MienMix,)),
    ("mien_mix_info", c_int32, (MienMix, POINTER(MienMixInfo))),
    ("mien_mix_guard", c_int32, (MienMix, c_uint32, POINTER(MienMixGuardInfo))),
    ("mien_mix_glare", c_int32, (c_uint32, POINTER(MienMixStroke), c_size_t,
     POINTER(MienMixReaction))),
    ("mien_mix_antagonists", c_int32, (MienRig, POINTER(MienMixAntagonists), c_size_t, c_void_p)),
    ("mien_mix_mirror", c_int32, (MienDeformer, c_void_p, c_size_t, POINTER(MienError))),
    ("mien_mix_mask", c_int32, (MienRig, c_void_p, c_size_t, c_float, c_void_p, c_size_t,
     POINTER(MienError))),
    ("mien_gaze_create", c_int32, (MienDeformer, POINTER(MienGazeDesc), POINTER(MienGaze),
     POINTER(MienError))),
    ("mien_gaze_destroy", None, (MienGaze,)),
    ("mien_gaze_info", c_int32, (MienGaze, POINTER(MienGazeInfo))),
    ("mien_gaze_look_at", c_int32, (MienGaze, POINTER(MienGazeTarget), c_void_p, c_size_t,
     POINTER(MienGazeRest))),
    ("mien_mixer_create", c_int32, (MienMix, POINTER(MienMixerDesc), POINTER(MienMixer),
     POINTER(MienError))),
    ("mien_mixer_destroy", None, (MienMixer,)),
    ("mien_mixer_play", c_int32, (MienMixer, c_uint32, MienClip, MienClipBinding,
     POINTER(MienPlayDesc), POINTER(MienError))),
    ("mien_mixer_stop", c_int32, (MienMixer, c_uint32, c_int64)),
    ("mien_mixer_set_weight", c_int32, (MienMixer, c_uint32, c_float, c_int64)),
    ("mien_mixer_set_pose_weight", c_int32, (MienMixer, c_uint32, c_uint32, c_float, c_int64)),
    ("mien_mixer_set_variable", c_int32, (MienMixer, c_uint32, c_float)),
    ("mien_mixer_set_guard", c_int32, (MienMixer, c_uint32, c_float)),
    ("mien_mixer_guard", c_int32, (MienMixer, c_uint32, POINTER(MienGuardState))),
    ("mien_mixer_trigger", c_int32, (MienMixer, c_uint32, c_float, c_int64)),
    ("mien_mixer_release", c_int32, (MienMixer, c_uint32)),
    ("mien_mixer_set_level", c_int32, (MienMixer, c_uint32, c_float)),
    ("mien_mixer_push", c_int32, (MienMixer, c_uint32, c_int64, c_void_p, c_size_t, c_void_p)),
    ("mien_mixer_step", c_int32, (MienMixer, c_int64, MienInstance)),
    ("mien_mixer_step_batch", c_int32, (POINTER(MienMixer), POINTER(MienInstance), c_size_t,
     c_int64)),
    ("mien_mixer_row", c_int32, (MienMixer, POINTER(MienFloatView))),
    ("mien_mixer_stage", c_int32, (MienMixer, c_uint32, POINTER(MienFloatView))),
    ("mien_mixer_info", c_int32, (MienMixer, POINTER(MienMixerInfo))),
    ("mien_mixer_event", c_int32, (MienMixer, c_uint32, POINTER(MienClipEvent), c_void_p)),
    ("mien_mixer_snapshot", c_int32, (MienMixer, c_void_p, c_size_t, c_void_p, POINTER(MienError))),
    ("mien_mixer_restore", c_int32, (MienMixer, c_void_p, c_size_t, POINTER(MienMixerClip),
     c_size_t, POINTER(MienError))),
    ("mien_solver_stack_create", c_int32, (MienDeformer, POINTER(MienSolverStackDesc),
     POINTER(MienSolverStack), POINTER(MienError))),
    ("mien_solver_stack_destroy", None, (MienSolverStack,)),
    ("mien_solver_stack_info", c_int32, (MienSolverStack, POINTER(MienSolverStackInfo))),
    ("mien_solver_state_create", c_int32, (MienSolverStack, POINTER(MienSolverStateDesc),
     POINTER(MienSolverState), POINTER(MienError))),
    ("mien_solver_state_destroy", None, (MienSolverState,)),
    ("mien_solver_state_step", c_int32, (MienSolverState, MienDeformerInstance,
     POINTER(MienSolverInput), c_int64)),
    ("mien_solver_state_step_batch", c_int32, (POINTER(MienSolverState),
     POINTER(MienDeformerInstance), POINTER(MienSolverInput), c_size_t, c_int64)),
    ("mien_solver_state_outputs", c_int32, (MienSolverState, c_uint32, POINTER(MienFloatView))),
    ("mien_solver_state_transforms", c_int32, (MienSolverState, POINTER(MienFloatView))),
    ("mien_solver_state_undeclared", c_int32, (MienSolverState, POINTER(MienStringView))),
    ("mien_rig_match", c_int32, (MienRig, c_char_p, c_size_t, POINTER(MienControlShare), c_size_t,
     c_void_p, c_void_p)),
    ("mien_control_name", c_int32, (c_char_p, c_size_t, c_void_p, c_size_t, c_void_p)),
)


class Library:
    """Each function of libmien, by its name."""

    mien_version: Any
    mien_status_name: Any
    mien_coordinate_system_find: Any
    mien_coordinate_system_find_n: Any
    mien_coordinate_system_name: Any
    mien_dna_open_file: Any
    mien_dna_open_memory: Any
    mien_dna_open_stream: Any
    mien_dna_close: Any
    mien_dna_info: Any
    mien_dna_layer: Any
    mien_dna_field: Any
    mien_dna_field_n: Any
    mien_dna_child_name: Any
    mien_dna_child_name_n: Any
    mien_dna_read_floats: Any
    mien_dna_read_floats_n: Any
    mien_dna_read_integers: Any
    mien_dna_read_integers_n: Any
    mien_dna_read_string: Any
    mien_dna_read_string_n: Any
    mien_dna_write_file: Any
    mien_dna_write_memory: Any
    mien_dna_validate_file: Any
    mien_dna_validate_memory: Any
    mien_report_counts: Any
    mien_report_finding: Any
    mien_report_destroy: Any
    mien_isa_available: Any
    mien_isa_name: Any
    mien_rig_create: Any
    mien_rig_destroy: Any
    mien_rig_info: Any
    mien_rig_count: Any
    mien_rig_name: Any
    mien_rig_find: Any
    mien_rig_find_n: Any
    mien_rig_lod_indices: Any
    mien_rig_variable_joint_values: Any
    mien_rig_joint_parents: Any
    mien_rig_neutral_joint_values: Any
    mien_rig_psd_inputs: Any
    mien_rig_initial_raw_controls: Any
    mien_rig_statistics: Any
    mien_instance_create: Any
    mien_instance_destroy: Any
    mien_instance_reset: Any
    mien_instance_gui_controls: Any
    mien_instance_raw_controls: Any
    mien_instance_ml_masks: Any
    mien_instance_controls: Any
    mien_instance_psd_controls: Any
    mien_instance_ml_controls: Any
    mien_instance_rbf_controls: Any
    mien_instance_joints: Any
    mien_instance_blend_shapes: Any
    mien_instance_animated_maps: Any
    mien_instance_statistics: Any
    mien_rig_map_gui_to_raw: Any
    mien_rig_map_raw_to_gui: Any
    mien_rig_evaluate: Any
    mien_rig_evaluate_stages: Any
    mien_batch_create: Any
    mien_batch_destroy: Any
    mien_batch_bytes: Any
    mien_rig_evaluate_batch: Any
    mien_rig_evaluate_joint_group: Any
    mien_rig_evaluate_rbf_solver: Any
    mien_rig_evaluate_twist_swing: Any
    mien_deformer_create: Any
    mien_deformer_create_subset: Any
    mien_deformer_destroy: Any
    mien_deformer_info: Any
    mien_deformer_mesh: Any
    mien_deformer_triangles: Any
    mien_deformer_texture_coordinates: Any
    mien_deformer_influences: Any
    mien_deformer_target: Any
    mien_deformer_bind_matrices: Any
    mien_deformer_inverse_bind_matrices: Any
    mien_deformer_instance_create: Any
    mien_deformer_instance_destroy: Any
    mien_deformer_instance_update: Any
    mien_deformer_instance_update_from_values: Any
    mien_deformer_instance_joint_matrices: Any
    mien_deformer_instance_skin_matrices: Any
    mien_deformer_instance_local_transforms: Any
    mien_deformer_instance_deform: Any
    mien_deformer_instance_deform_batch: Any
    mien_deformer_instance_positions: Any
    mien_deformer_instance_normals: Any
    mien_deformer_instance_write_vertices: Any
    mien_deformer_instance_write_vertices_batch: Any
    mien_derivatives_create: Any
    mien_derivatives_destroy: Any
    mien_derivatives_bytes: Any
    mien_derivatives_size: Any
    mien_derivatives_linearize: Any
    mien_derivatives_forward: Any
    mien_derivatives_reverse: Any
    mien_jacobian_create: Any
    mien_jacobian_destroy: Any
    mien_jacobian_pattern: Any
    mien_derivatives_jacobian: Any
    mien_bake_file: Any
    mien_bake_memory: Any
    mien_baked_open_file: Any
    mien_baked_open_memory: Any
    mien_baked_open_stream: Any
    mien_baked_close: Any
    mien_baked_info: Any
    mien_rig_from_baked: Any
    mien_deformer_from_baked: Any
    mien_clip_build: Any
    mien_clip_open_file: Any
    mien_clip_open_memory: Any
    mien_clip_open_stream: Any
    mien_clip_close: Any
    mien_clip_write_file: Any
    mien_clip_write_memory: Any
    mien_clip_info: Any
    mien_clip_channel: Any
    mien_clip_find_channel: Any
    mien_clip_find_channel_n: Any
    mien_clip_event: Any
    mien_clip_verify: Any
    mien_clip_read: Any
    mien_clip_player_create: Any
    mien_clip_player_destroy: Any
    mien_clip_player_info: Any
    mien_clip_player_seek: Any
    mien_clip_player_set_speed: Any
    mien_clip_player_advance: Any
    mien_clip_player_next_event: Any
    mien_clip_player_sample: Any
    mien_clip_binding_create: Any
    mien_arkit_matrix: Any
    mien_clip_binding_destroy: Any
    mien_clip_binding_info: Any
    mien_clip_binding_apply: Any
    mien_clip_binding_snaps: Any
    mien_mix_create: Any
    mien_mix_open_file: Any
    mien_mix_open_memory: Any
    mien_mix_write_file: Any
    mien_mix_write_memory: Any
    mien_mix_write_text: Any
    mien_mix_destroy: Any
    mien_mix_info: Any
    mien_mix_guard: Any
    mien_mix_glare: Any
    mien_mix_antagonists: Any
    mien_mix_mirror: Any
    mien_mix_mask: Any
    mien_gaze_create: Any
    mien_gaze_destroy: Any
    mien_gaze_info: Any
    mien_gaze_look_at: Any
    mien_mixer_create: Any
    mien_mixer_destroy: Any
    mien_mixer_play: Any
    mien_mixer_stop: Any
    mien_mixer_set_weight: Any
    mien_mixer_set_pose_weight: Any
    mien_mixer_set_variable: Any
    mien_mixer_set_guard: Any
    mien_mixer_guard: Any
    mien_mixer_trigger: Any
    mien_mixer_release: Any
    mien_mixer_set_level: Any
    mien_mixer_push: Any
    mien_mixer_step: Any
    mien_mixer_step_batch: Any
    mien_mixer_row: Any
    mien_mixer_stage: Any
    mien_mixer_info: Any
    mien_mixer_event: Any
    mien_mixer_snapshot: Any
    mien_mixer_restore: Any
    mien_solver_stack_create: Any
    mien_solver_stack_destroy: Any
    mien_solver_stack_info: Any
    mien_solver_state_create: Any
    mien_solver_state_destroy: Any
    mien_solver_state_step: Any
    mien_solver_state_step_batch: Any
    mien_solver_state_outputs: Any
    mien_solver_state_transforms: Any
    mien_solver_state_undeclared: Any
    mien_rig_match: Any
    mien_control_name: Any

    def __init__(self, library: ctypes.CDLL) -> None:
        for name, result, parameters in FUNCTIONS:
            function = getattr(library, name)
            function.restype = result
            function.argtypes = parameters
            setattr(self, name, function)


# Name, result, parameters.
AUTHOR_FUNCTIONS: Tuple[Tuple[str, Any, Tuple[Any, ...]], ...] = (
    ("mien_dna_generate", c_int32, (POINTER(MienGenerateDesc), POINTER(MienDna),
     POINTER(MienError))),
    ("mien_author_rig", c_int32, (POINTER(MienAuthorMesh), POINTER(MienAuthorDesc),
     POINTER(MienDna), POINTER(MienAuthorReport), POINTER(MienError))),
    ("mien_author_report_close", None, (MienAuthorReport,)),
    ("mien_author_report_json", c_int32, (MienAuthorReport, POINTER(MienStringView))),
    ("mien_document_create", c_int32, (MienDna, POINTER(MienDocumentDesc), POINTER(MienDocument),
     POINTER(MienError))),
    ("mien_document_open_file", c_int32, (c_char_p, POINTER(MienDocumentDesc),
     POINTER(MienDocument), POINTER(MienError))),
    ("mien_document_destroy", None, (MienDocument,)),
    ("mien_document_field", c_int32, (MienDocument, c_char_p, POINTER(MienDnaField),
     POINTER(MienError))),
    ("mien_document_child_name", c_int32, (MienDocument, c_char_p, c_uint32,
     POINTER(MienStringView), POINTER(MienError))),
    ("mien_document_read_floats", c_int32, (MienDocument, c_char_p, c_uint64, c_uint64, c_void_p,
     POINTER(MienError))),
    ("mien_document_read_integers", c_int32, (MienDocument, c_char_p, c_uint64, c_uint64, c_void_p,
     POINTER(MienError))),
    ("mien_document_read_string", c_int32, (MienDocument, c_char_p, POINTER(MienStringView),
     POINTER(MienError))),
    ("mien_document_bytes", c_int32, (MienDocument, c_char_p, POINTER(MienStringView),
     POINTER(MienError))),
    ("mien_document_write_floats", c_int32, (MienDocument, c_char_p, c_uint64, c_uint64, c_void_p,
     POINTER(MienError))),
    ("mien_document_write_integers", c_int32, (MienDocument, c_char_p, c_uint64, c_uint64, c_void_p,
     POINTER(MienError))),
    ("mien_document_write_string", c_int32, (MienDocument, c_char_p, c_char_p, c_size_t,
     POINTER(MienError))),
    ("mien_document_splice", c_int32, (MienDocument, c_char_p, c_uint64, c_uint64, c_uint64,
     POINTER(MienError))),
    ("mien_document_resize", c_int32, (MienDocument, c_char_p, c_uint64, POINTER(MienError))),
    ("mien_document_layer_count", c_int32, (MienDocument, c_void_p, c_void_p, POINTER(MienError))),
    ("mien_document_layer", c_int32, (MienDocument, c_uint32, POINTER(MienDnaLayer),
     POINTER(MienStringView), POINTER(MienError))),
    ("mien_document_clear_layers", c_int32, (MienDocument, c_uint32, POINTER(MienError))),
    ("mien_document_add_layer", c_int32, (MienDocument, c_char_p, c_uint32, c_uint32, c_void_p,
     c_size_t, POINTER(MienError))),
    ("mien_document_mark", c_int32, (MienDocument, c_void_p, POINTER(MienError))),
    ("mien_document_undo", c_int32, (MienDocument, c_uint64, POINTER(MienError))),
    ("mien_document_find", c_int32, (MienDocument, c_uint32, c_char_p, c_void_p,
     POINTER(MienError))),
    ("mien_document_rename", c_int32, (MienDocument, c_uint32, c_uint32, c_char_p,
     POINTER(MienError))),
    ("mien_document_remove", c_int32, (MienDocument, c_uint32, c_void_p, c_size_t,
     POINTER(MienError))),
    ("mien_document_clear", c_int32, (MienDocument, c_uint32, POINTER(MienError))),
    ("mien_document_clear_joints", c_int32, (MienDocument, c_void_p, c_size_t, POINTER(MienError))),
    ("mien_document_set_neutral", c_int32, (MienDocument, c_uint32, c_void_p, c_void_p, c_size_t,
     POINTER(MienError))),
    ("mien_document_set_positions", c_int32, (MienDocument, c_uint32, c_void_p, c_size_t,
     POINTER(MienError))),
    ("mien_document_set_target", c_int32, (MienDocument, c_uint32, c_uint32, c_void_p, c_void_p,
     c_size_t, POINTER(MienError))),
    ("mien_document_prune_targets", c_int32, (MienDocument, c_float, POINTER(MienPrunedTargets),
     POINTER(MienError))),
    ("mien_document_prune_joints", c_int32, (MienDocument, POINTER(MienPruneJointsDesc),
     POINTER(MienPrunedJoints), POINTER(MienError))),
    ("mien_document_set_weights", c_int32, (MienDocument, c_uint32, c_uint32, c_void_p, c_void_p,
     c_size_t, POINTER(MienError))),
    ("mien_document_normalize_weights", c_int32, (MienDocument, c_uint32, POINTER(MienError))),
    ("mien_document_limit_influences", c_int32, (MienDocument, c_uint32, c_uint32,
     POINTER(MienError))),
    ("mien_document_smooth_weights", c_int32, (MienDocument, c_uint32, c_uint32, c_float, c_uint32,
     POINTER(MienError))),
    ("mien_document_place", c_int32, (MienDocument, POINTER(MienPlacement), POINTER(MienError))),
    ("mien_document_keep_lods", c_int32, (MienDocument, c_uint64, POINTER(MienError))),
    ("mien_document_convert", c_int32, (MienDocument, POINTER(MienCoordinateSystem),
     POINTER(MienError))),
    ("mien_document_copy_layers", c_int32, (MienDocument, MienDocument, c_uint32,
     POINTER(MienError))),
    ("mien_document_copy_mesh", c_int32, (MienDocument, MienDocument, c_uint32, c_void_p,
     POINTER(MienError))),
    ("mien_document_merge_joints", c_int32, (MienDocument, MienDocument, c_double,
     POINTER(MienError))),
    ("mien_document_split_joints", c_int32, (MienDocument, MienDocument, POINTER(MienError))),
    ("mien_document_project", c_int32, (MienDocument, c_uint32, c_uint32, POINTER(MienProjectDesc),
     c_void_p, POINTER(MienError))),
    ("mien_document_make_lod", c_int32, (MienDocument, c_uint32, c_uint32, POINTER(MienProjectDesc),
     c_void_p, POINTER(MienError))),
    ("mien_document_conform", c_int32, (MienDocument, c_uint32, c_void_p, c_size_t, c_uint32,
     POINTER(MienConformed), POINTER(MienError))),
    ("mien_document_transplant", c_int32, (MienDocument, MienDocument, POINTER(MienTransplantDesc),
     POINTER(MienControlError), c_size_t, c_void_p, POINTER(MienError))),
    ("mien_document_to_dna", c_int32, (MienDocument, POINTER(MienDocumentDesc), POINTER(MienDna),
     POINTER(MienError))),
    ("mien_document_write_file", c_int32, (MienDocument, c_char_p, POINTER(MienWriteDesc),
     POINTER(MienError))),
    ("mien_document_write_stream", c_int32, (MienDocument, POINTER(MienByteSink),
     POINTER(MienWriteDesc), POINTER(MienError))),
    ("mien_document_write_memory", c_int32, (MienDocument, POINTER(MienWriteDesc), c_void_p,
     c_size_t, c_void_p, POINTER(MienError))),
    ("mien_document_validate", c_int32, (MienDocument, POINTER(MienValidateDesc),
     POINTER(MienReport), POINTER(MienError))),
)


class AuthorLibrary:
    """Each function of libmien-author, by its name."""

    mien_dna_generate: Any
    mien_author_rig: Any
    mien_author_report_close: Any
    mien_author_report_json: Any
    mien_document_create: Any
    mien_document_open_file: Any
    mien_document_destroy: Any
    mien_document_field: Any
    mien_document_child_name: Any
    mien_document_read_floats: Any
    mien_document_read_integers: Any
    mien_document_read_string: Any
    mien_document_bytes: Any
    mien_document_write_floats: Any
    mien_document_write_integers: Any
    mien_document_write_string: Any
    mien_document_splice: Any
    mien_document_resize: Any
    mien_document_layer_count: Any
    mien_document_layer: Any
    mien_document_clear_layers: Any
    mien_document_add_layer: Any
    mien_document_mark: Any
    mien_document_undo: Any
    mien_document_find: Any
    mien_document_rename: Any
    mien_document_remove: Any
    mien_document_clear: Any
    mien_document_clear_joints: Any
    mien_document_set_neutral: Any
    mien_document_set_positions: Any
    mien_document_set_target: Any
    mien_document_prune_targets: Any
    mien_document_prune_joints: Any
    mien_document_set_weights: Any
    mien_document_normalize_weights: Any
    mien_document_limit_influences: Any
    mien_document_smooth_weights: Any
    mien_document_place: Any
    mien_document_keep_lods: Any
    mien_document_convert: Any
    mien_document_copy_layers: Any
    mien_document_copy_mesh: Any
    mien_document_merge_joints: Any
    mien_document_split_joints: Any
    mien_document_project: Any
    mien_document_make_lod: Any
    mien_document_conform: Any
    mien_document_transplant: Any
    mien_document_to_dna: Any
    mien_document_write_file: Any
    mien_document_write_stream: Any
    mien_document_write_memory: Any
    mien_document_validate: Any

    def __init__(self, library: ctypes.CDLL) -> None:
        for name, result, parameters in AUTHOR_FUNCTIONS:
            function = getattr(library, name)
            function.restype = result
            function.argtypes = parameters
            setattr(self, name, function)


# Name, result, parameters.
SOLVE_FUNCTIONS: Tuple[Tuple[str, Any, Tuple[Any, ...]], ...] = (
    ("mien_fit_create", c_int32, (MienRig, POINTER(MienFitDesc), POINTER(MienFit),
     POINTER(MienError))),
    ("mien_fit_destroy", None, (MienFit,)),
    ("mien_fit_surface_create", c_int32, (POINTER(MienFitSurfaceDesc), POINTER(MienFitSurface),
     POINTER(MienError))),
    ("mien_fit_surface_destroy", None, (MienFitSurface,)),
    ("mien_fit_solve", c_int32, (MienFit, POINTER(MienFitFrame), c_void_p, POINTER(MienFitResult))),
    ("mien_fit_solve_frames", c_int32, (MienFit, POINTER(MienFitFrame), c_size_t, c_void_p,
     POINTER(MienFitResult))),
    ("mien_fit_observability", c_int32, (MienFit, c_void_p, c_size_t)),
    ("mien_fit_keys", c_int32, (c_void_p, c_size_t, c_float, c_void_p, c_void_p)),
)


class SolveLibrary:
    """Each function of libmien-solve, by its name."""

    mien_fit_create: Any
    mien_fit_destroy: Any
    mien_fit_surface_create: Any
    mien_fit_surface_destroy: Any
    mien_fit_solve: Any
    mien_fit_solve_frames: Any
    mien_fit_observability: Any
    mien_fit_keys: Any

    def __init__(self, library: ctypes.CDLL) -> None:
        for name, result, parameters in SOLVE_FUNCTIONS:
            function = getattr(library, name)
            function.restype = result
            function.argtypes = parameters
            setattr(self, name, function)
