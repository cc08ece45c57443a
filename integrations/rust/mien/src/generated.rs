// SPDX-License-Identifier: MIT
// Code generated from integrations/api/mien_api.json by generate.py; run ./dev api. DO NOT EDIT.

use crate::convert::{flags, numbers, offset, text};
use mien_sys as sys;

/// Why a call failed. The numbers are never used again for something else.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Status(pub i32);

impl Status {
    /// `MIEN_OK` in C.
    pub const OK: Self = Self(0);
    /// A required pointer is NULL.
    pub const NULL_ARGUMENT: Self = Self(1);
    /// A value out of range, or a buffer that is too small.
    pub const INVALID_ARGUMENT: Self = Self(2);
    /// `struct_size` is too small or above 4096, or a field unknown to the library is not zero.
    pub const STRUCT_SIZE: Self = Self(3);
    /// A handle of the wrong kind.
    pub const HANDLE: Self = Self(4);
    /// Objects that do not belong together.
    pub const MISMATCH: Self = Self(5);
    /// An index past the end.
    pub const INDEX: Self = Self(6);
    /// A LOD that does not exist, or for which the object has no memory.
    pub const LOD: Self = Self(7);
    /// No such name or path.
    pub const NAME: Self = Self(8);
    /// An instruction set that the CPU or the build does not support.
    pub const ISA: Self = Self(9);
    /// The allocator returned NULL.
    pub const MEMORY: Self = Self(10);
    /// This build of the library only opens baked files, or the object is stored in a form that
    /// does not have what was asked for.
    pub const UNSUPPORTED: Self = Self(11);
    /// The file cannot be opened.
    pub const FILE_OPEN: Self = Self(20);
    /// The file or stream cannot be read.
    pub const FILE_READ: Self = Self(21);
    /// The file cannot be written.
    pub const FILE_WRITE: Self = Self(22);
    /// Not a DNA file.
    pub const DNA_SIGNATURE: Self = Self(30);
    /// A DNA file whose generation is not 2.
    pub const DNA_VERSION: Self = Self(31);
    /// The file ends before the data that its header or counts announce.
    pub const DNA_TRUNCATED: Self = Self(32);
    /// Offsets, sizes or counts contradict each other.
    pub const DNA_STRUCTURE: Self = Self(33);
    /// An index that refers to nothing.
    pub const DNA_REFERENCE: Self = Self(34);
    /// A count above the limit of the format or of Mien.
    pub const DNA_LIMIT: Self = Self(35);
    /// A required layer is not loaded or not in the file.
    pub const DNA_LAYER: Self = Self(36);
    /// An invalid value, or one that cannot be converted.
    pub const DNA_VALUE: Self = Self(37);
    /// Not a baked file.
    pub const BAKED_SIGNATURE: Self = Self(50);
    /// Baked by another version of Mien, or for the other byte order.
    pub const BAKED_VERSION: Self = Self(51);
    /// The file is shorter than its header states.
    pub const BAKED_TRUNCATED: Self = Self(52);
    /// Sizes, counts or indices contradict each other.
    pub const BAKED_STRUCTURE: Self = Self(53);
    /// The file has changed since it was written.
    pub const BAKED_CHECKSUM: Self = Self(54);
    /// The file does not contain the requested object.
    pub const BAKED_PART: Self = Self(55);
    /// Not a clip.
    pub const CLIP_SIGNATURE: Self = Self(60);
    /// A clip in another version of the format.
    pub const CLIP_VERSION: Self = Self(61);
    /// The clip is shorter than its header states.
    pub const CLIP_TRUNCATED: Self = Self(62);
    /// Sizes, counts or curves contradict each other.
    pub const CLIP_STRUCTURE: Self = Self(63);
    /// The clip has changed since it was written.
    pub const CLIP_CHECKSUM: Self = Self(64);
    /// A value that is not finite.
    pub const CLIP_VALUE: Self = Self(65);
    /// More than a clip, player or binding can hold.
    pub const CLIP_LIMIT: Self = Self(66);
    /// Not a mix.
    pub const MIX_SIGNATURE: Self = Self(70);
    /// A mix in another version of the format.
    pub const MIX_VERSION: Self = Self(71);
    /// The file is shorter than its header states.
    pub const MIX_TRUNCATED: Self = Self(72);
    /// Sizes or counts contradict each other, or a value is out of range.
    pub const MIX_STRUCTURE: Self = Self(73);
    /// The mix has changed since it was written.
    pub const MIX_CHECKSUM: Self = Self(74);
    /// The arrays of a mesh, shape or bone contradict each other.
    pub const AUTHOR_MESH: Self = Self(80);
    /// A mesh that cannot be rigged; the message names the rule.
    pub const AUTHOR_REFUSED: Self = Self(81);
    /// The caller's progress function asked to stop.
    pub const AUTHOR_CANCELED: Self = Self(82);
}

numbers!(Status, i32, [(0, "OK"), (1, "NULL_ARGUMENT"), (2, "INVALID_ARGUMENT"), (3, "STRUCT_SIZE"), (4, "HANDLE"), (5, "MISMATCH"), (6, "INDEX"), (7, "LOD"), (8, "NAME"), (9, "ISA"), (10, "MEMORY"), (11, "UNSUPPORTED"), (20, "FILE_OPEN"), (21, "FILE_READ"), (22, "FILE_WRITE"), (30, "DNA_SIGNATURE"), (31, "DNA_VERSION"), (32, "DNA_TRUNCATED"), (33, "DNA_STRUCTURE"), (34, "DNA_REFERENCE"), (35, "DNA_LIMIT"), (36, "DNA_LAYER"), (37, "DNA_VALUE"), (50, "BAKED_SIGNATURE"), (51, "BAKED_VERSION"), (52, "BAKED_TRUNCATED"), (53, "BAKED_STRUCTURE"), (54, "BAKED_CHECKSUM"), (55, "BAKED_PART"), (60, "CLIP_SIGNATURE"), (61, "CLIP_VERSION"), (62, "CLIP_TRUNCATED"), (63, "CLIP_STRUCTURE"), (64, "CLIP_CHECKSUM"), (65, "CLIP_VALUE"), (66, "CLIP_LIMIT"), (70, "MIX_SIGNATURE"), (71, "MIX_VERSION"), (72, "MIX_TRUNCATED"), (73, "MIX_STRUCTURE"), (74, "MIX_CHECKSUM"), (80, "AUTHOR_MESH"), (81, "AUTHOR_REFUSED"), (82, "AUTHOR_CANCELED")]);

pub(crate) fn describe(status: Status) -> &'static str {
    match status.0 {
        1 => "a required pointer is NULL",
        2 => "a value out of range, or a buffer that is too small",
        3 => "struct_size is too small or above 4096, or a field unknown to the library is not zero",
        4 => "a handle of the wrong kind",
        5 => "objects that do not belong together",
        6 => "an index past the end",
        7 => "a LOD that does not exist, or for which the object has no memory",
        8 => "no such name or path",
        9 => "an instruction set that the CPU or the build does not support",
        10 => "the allocator returned NULL",
        11 => "this build of the library only opens baked files, or the object is stored in a form that does not have what was asked for",
        20 => "the file cannot be opened",
        21 => "the file or stream cannot be read",
        22 => "the file cannot be written",
        30 => "not a DNA file",
        31 => "a DNA file whose generation is not 2",
        32 => "the file ends before the data that its header or counts announce",
        33 => "offsets, sizes or counts contradict each other",
        34 => "an index that refers to nothing",
        35 => "a count above the limit of the format or of Mien",
        36 => "a required layer is not loaded or not in the file",
        37 => "an invalid value, or one that cannot be converted",
        50 => "not a baked file",
        51 => "baked by another version of Mien, or for the other byte order",
        52 => "the file is shorter than its header states",
        53 => "sizes, counts or indices contradict each other",
        54 => "the file has changed since it was written",
        55 => "the file does not contain the requested object",
        60 => "not a clip",
        61 => "a clip in another version of the format",
        62 => "the clip is shorter than its header states",
        63 => "sizes, counts or curves contradict each other",
        64 => "the clip has changed since it was written",
        65 => "a value that is not finite",
        66 => "more than a clip, player or binding can hold",
        70 => "not a mix",
        71 => "a mix in another version of the format",
        72 => "the file is shorter than its header states",
        73 => "sizes or counts contradict each other, or a value is out of range",
        74 => "the mix has changed since it was written",
        80 => "the arrays of a mesh, shape or bone contradict each other",
        81 => "a mesh that cannot be rigged; the message names the rule",
        82 => "the caller's progress function asked to stop",
        _ => "",
    }
}

/// Layers of a DNA file, combined with \|. A layer loads the layers that it refers to: all of them
/// need the definition, RBF behavior needs the behavior. The descriptor is always loaded.
///
/// See docs/dna-format.md, 9 "Choosing layers".
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Layers(pub u32);

impl Layers {
    /// Only in MienDnaLayer.layer.
    pub const UNKNOWN: Self = Self(0);
    /// `MIEN_LAYER_DESCRIPTOR` in C.
    pub const DESCRIPTOR: Self = Self(1);
    /// `MIEN_LAYER_DEFINITION` in C.
    pub const DEFINITION: Self = Self(2);
    /// `MIEN_LAYER_BEHAVIOR` in C.
    pub const BEHAVIOR: Self = Self(4);
    /// `MIEN_LAYER_GEOMETRY` in C.
    pub const GEOMETRY: Self = Self(8);
    /// `MIEN_LAYER_MACHINE_LEARNED_BEHAVIOR` in C.
    pub const MACHINE_LEARNED_BEHAVIOR: Self = Self(16);
    /// `MIEN_LAYER_RBF_BEHAVIOR` in C.
    pub const RBF_BEHAVIOR: Self = Self(32);
    /// `MIEN_LAYER_JOINT_BEHAVIOR_METADATA` in C.
    pub const JOINT_BEHAVIOR_METADATA: Self = Self(64);
    /// `MIEN_LAYER_TWIST_SWING_BEHAVIOR` in C.
    pub const TWIST_SWING_BEHAVIOR: Self = Self(128);
    /// `MIEN_LAYER_ALL` in C.
    pub const ALL: Self = Self(255);
}

flags!(Layers, u32, [(0, "UNKNOWN"), (1, "DESCRIPTOR"), (2, "DEFINITION"), (4, "BEHAVIOR"), (8, "GEOMETRY"), (16, "MACHINE_LEARNED_BEHAVIOR"), (32, "RBF_BEHAVIOR"), (64, "JOINT_BEHAVIOR_METADATA"), (128, "TWIST_SWING_BEHAVIOR"), (255, "ALL")]);

/// What to do with layers of unknown kinds.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct UnknownLayers(pub u32);

impl UnknownLayers {
    /// Keep their bytes and write them back unchanged.
    pub const KEEP: Self = Self(0);
    /// `MIEN_UNKNOWN_LAYERS_DROP` in C.
    pub const DROP: Self = Self(1);
}

numbers!(UnknownLayers, u32, [(0, "KEEP"), (1, "DROP")]);

/// What C calls `MIEN_FILE_...`.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct FileAccess(pub u32);

impl FileAccess {
    /// Map the file; read it into memory if it cannot be mapped, such as a pipe.
    pub const MAP: Self = Self(0);
    /// Read the whole file into memory: safe even if it is truncated later.
    pub const READ: Self = Self(1);
}

numbers!(FileAccess, u32, [(0, "MAP"), (1, "READ")]);

/// What C calls `MIEN_TRANSLATION_UNIT_...`.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct TranslationUnit(pub u32);

impl TranslationUnit {
    /// `MIEN_TRANSLATION_UNIT_CENTIMETERS` in C.
    pub const CENTIMETERS: Self = Self(0);
    /// `MIEN_TRANSLATION_UNIT_METERS` in C.
    pub const METERS: Self = Self(1);
}

numbers!(TranslationUnit, u32, [(0, "CENTIMETERS"), (1, "METERS")]);

/// What C calls `MIEN_ROTATION_UNIT_...`.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct RotationUnit(pub u32);

impl RotationUnit {
    /// `MIEN_ROTATION_UNIT_DEGREES` in C.
    pub const DEGREES: Self = Self(0);
    /// `MIEN_ROTATION_UNIT_RADIANS` in C.
    pub const RADIANS: Self = Self(1);
}

numbers!(RotationUnit, u32, [(0, "DEGREES"), (1, "RADIANS")]);

/// Directions as seen by the character.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Direction(pub u32);

impl Direction {
    /// `MIEN_DIRECTION_LEFT` in C.
    pub const LEFT: Self = Self(0);
    /// `MIEN_DIRECTION_RIGHT` in C.
    pub const RIGHT: Self = Self(1);
    /// `MIEN_DIRECTION_UP` in C.
    pub const UP: Self = Self(2);
    /// `MIEN_DIRECTION_DOWN` in C.
    pub const DOWN: Self = Self(3);
    /// `MIEN_DIRECTION_FRONT` in C.
    pub const FRONT: Self = Self(4);
    /// `MIEN_DIRECTION_BACK` in C.
    pub const BACK: Self = Self(5);
}

numbers!(Direction, u32, [(0, "LEFT"), (1, "RIGHT"), (2, "UP"), (3, "DOWN"), (4, "FRONT"), (5, "BACK")]);

/// Order of Euler angles.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct RotationSequence(pub u32);

impl RotationSequence {
    /// X first, then y, then z, about fixed axes.
    pub const XYZ: Self = Self(0);
    /// `MIEN_ROTATION_SEQUENCE_XZY` in C.
    pub const XZY: Self = Self(1);
    /// `MIEN_ROTATION_SEQUENCE_YXZ` in C.
    pub const YXZ: Self = Self(2);
    /// `MIEN_ROTATION_SEQUENCE_YZX` in C.
    pub const YZX: Self = Self(3);
    /// `MIEN_ROTATION_SEQUENCE_ZXY` in C.
    pub const ZXY: Self = Self(4);
    /// `MIEN_ROTATION_SEQUENCE_ZYX` in C.
    pub const ZYX: Self = Self(5);
}

numbers!(RotationSequence, u32, [(0, "XYZ"), (1, "XZY"), (2, "YXZ"), (3, "YZX"), (4, "ZXY"), (5, "ZYX")]);

/// The side of a face a b c ... to which (b - a) x (c - a) points. The cross product is computed
/// from the coordinates in the file, whatever the directions of its axes.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct FaceWinding(pub u32);

impl FaceWinding {
    /// Seen from outside: counter-clockwise with right-handed axes, clockwise with left-handed
    /// axes.
    pub const OUTWARD: Self = Self(0);
    /// `MIEN_FACE_WINDING_INWARD` in C.
    pub const INWARD: Self = Self(1);
}

numbers!(FaceWinding, u32, [(0, "OUTWARD"), (1, "INWARD")]);

/// How Euler angles are converted to other axes. Joint values are sums of angles, which have a
/// meaning in one rotation sequence only. So only the first rule is exact for all rigs.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct RotationRule(pub u32);

impl RotationRule {
    /// Keep the sequence of the file and rename its axes: if x and z are exchanged, xyz becomes
    /// zyx, xzy becomes zxy, and so on.
    pub const CARRIED: Self = Self(0);
    /// The requested sequence. Neutral poses, quaternion joints, twists, swings, ML joints and
    /// joints that rotate about one axis only are converted exactly; rigs with other joints are
    /// rejected with `Status::DNA_VALUE`.
    pub const EXACT: Self = Self(1);
    /// The requested sequence, converting each column of the joint matrix separately: exact if one
    /// control is 1 and all others are 0, otherwise an approximation for small angles.
    pub const PER_COLUMN: Self = Self(2);
}

numbers!(RotationRule, u32, [(0, "CARRIED"), (1, "EXACT"), (2, "PER_COLUMN")]);

/// Type of a field.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct FieldType(pub u32);

impl FieldType {
    /// Named fields.
    pub const RECORD: Self = Self(0);
    /// Records, strings or arrays; element i is at the path of the list + \[i\].
    pub const LIST: Self = Self(1);
    /// `MIEN_FIELD_STRING` in C.
    pub const STRING: Self = Self(2);
    /// Numbers: one, or an array.
    pub const U8: Self = Self(3);
    /// `MIEN_FIELD_U16` in C.
    pub const U16: Self = Self(4);
    /// `MIEN_FIELD_U32` in C.
    pub const U32: Self = Self(5);
    /// `MIEN_FIELD_I32` in C.
    pub const I32: Self = Self(6);
    /// `MIEN_FIELD_F32` in C.
    pub const F32: Self = Self(7);
}

numbers!(FieldType, u32, [(0, "RECORD"), (1, "LIST"), (2, "STRING"), (3, "U8"), (4, "U16"), (5, "U32"), (6, "I32"), (7, "F32")]);

/// What C calls `MIEN_SEVERITY_...`.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Severity(pub u32);

impl Severity {
    /// Opening the file or `mien_rig_create()` fails because of this.
    pub const ERROR: Self = Self(0);
    /// Allowed, but probably a mistake.
    pub const WARNING: Self = Self(1);
}

numbers!(Severity, u32, [(0, "ERROR"), (1, "WARNING")]);

/// Instruction sets.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Isa(pub u32);

impl Isa {
    /// The best one that the CPU, the operating system and the build support.
    pub const BEST: Self = Self(0);
    /// `MIEN_ISA_SCALAR` in C.
    pub const SCALAR: Self = Self(1);
    /// `MIEN_ISA_SSE2` in C.
    pub const SSE2: Self = Self(2);
    /// With FMA and F16C.
    pub const AVX2: Self = Self(3);
    /// F, CD, DQ, BW and VL.
    pub const AVX512: Self = Self(4);
    /// `MIEN_ISA_NEON` in C.
    pub const NEON: Self = Self(5);
    /// The one named by the environment variable `MIEN_ISA` ("scalar", "sse2", ...); the best one
    /// if it is unset or empty.
    pub const ENVIRONMENT: Self = Self(1000);
}

numbers!(Isa, u32, [(0, "BEST"), (1, "SCALAR"), (2, "SSE2"), (3, "AVX2"), (4, "AVX512"), (5, "NEON"), (1000, "ENVIRONMENT")]);

/// How joint values store rotations.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct RotationOutput(pub u32);

impl RotationOutput {
    /// 9 values per joint: tx ty tz rx ry rz sx sy sz.
    pub const EULER: Self = Self(0);
    /// 10 values per joint: tx ty tz qx qy qz qw sx sy sz.
    pub const QUATERNION: Self = Self(1);
}

numbers!(RotationOutput, u32, [(0, "EULER"), (1, "QUATERNION")]);

/// Effect of a region mask on the networks of the region (`mien_instance_ml_masks()`).
///
/// See docs/rig-evaluation.md, 8.5 "Region masks".
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct MlMasks(pub u32);

impl MlMasks {
    /// 0: the outputs of the networks get their default (0, or 1 for the w of a quaternion). Other
    /// values: the networks are evaluated. This is the behavior that DNA files are authored for.
    pub const SWITCH: Self = Self(0);
    /// Outputs are blended with their default by the mask, clamped to 0..1.
    pub const BLEND: Self = Self(1);
}

numbers!(MlMasks, u32, [(0, "SWITCH"), (1, "BLEND")]);

/// How the large arrays that evaluation reads are stored. Sums and results are always 32-bit
/// floats.
///
/// See docs/rig-evaluation.md, 4.9 "16-bit storage".
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Storage(pub u32);

impl Storage {
    /// `MIEN_STORAGE_32_BIT` in C.
    pub const BIT_32: Self = Self(0);
    /// Half the memory. Network weights and columns of quaternion joints are IEEE half floats
    /// (rounded to nearest even, at most 65504 in magnitude); the joint matrix is 16-bit fixed
    /// point, in units of 1/32767 of the largest entry of the row.
    pub const BIT_16: Self = Self(1);
}

numbers!(Storage, u32, [(0, "BIT_32"), (1, "BIT_16")]);

/// Which instruction sets give bit-identical results. See docs/numbers.md, 5 "Portable
/// arithmetic".
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Arithmetic(pub u32);

impl Arithmetic {
    /// AVX2, AVX-512 and NEON, which fuse multiply and add, agree with each other; scalar and SSE2
    /// agree with each other.
    pub const FAST: Self = Self(0);
    /// All agree, because nothing is fused. A baked rig gives the same bits on every machine; a
    /// rig created from a DNA file does if the C libraries compute the same sines.
    pub const PORTABLE: Self = Self(1);
}

numbers!(Arithmetic, u32, [(0, "FAST"), (1, "PORTABLE")]);

/// What an instance keeps of its last evaluation. With `Reuse::UNCHANGED` and `Reuse::NOTHING` the
/// results are bit-identical.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Reuse(pub u32);

impl Reuse {
    /// Results whose inputs have not changed: joint groups, and other stages as a whole.
    pub const UNCHANGED: Self = Self(0);
    /// Compute everything in each evaluation, for measurements.
    pub const NOTHING: Self = Self(1);
    /// Also the sums of the joint matrix: where few controls changed, only their differences are
    /// added, so such a frame costs little even if these controls move joints everywhere. Joint
    /// values then depend on earlier frames: they differ from those of a full evaluation by at
    /// most (n + 1539) \* 2^-23 \* M, before rotations are made from them. n is the number of
    /// controls that are not 0, M the sum of the magnitudes of the products that a joint value is
    /// the sum of; both are the largest since all sums were last computed, which happens after a
    /// reset, after a change of LOD and before 1536 differences were added. Everything else is
    /// bit-identical. Rigs and instances take more memory: MienRigInfo.`rig_bytes`,
    /// .`instance_bytes`.
    pub const SUMS: Self = Self(2);
}

numbers!(Reuse, u32, [(0, "UNCHANGED"), (1, "NOTHING"), (2, "SUMS")]);

/// Kinds of parts of a rig. Most have names.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Kind(pub u32);

impl Kind {
    /// `MIEN_KIND_GUI_CONTROL` in C.
    pub const GUI_CONTROL: Self = Self(0);
    /// `MIEN_KIND_RAW_CONTROL` in C.
    pub const RAW_CONTROL: Self = Self(1);
    /// Correctives; unnamed in DNA files, here "psd0", "psd1", ...
    pub const PSD_CONTROL: Self = Self(2);
    /// `MIEN_KIND_ML_CONTROL` in C.
    pub const ML_CONTROL: Self = Self(3);
    /// `MIEN_KIND_RBF_CONTROL` in C.
    pub const RBF_CONTROL: Self = Self(4);
    /// `MIEN_KIND_JOINT` in C.
    pub const JOINT: Self = Self(5);
    /// `MIEN_KIND_BLEND_SHAPE_CHANNEL` in C.
    pub const BLEND_SHAPE_CHANNEL: Self = Self(6);
    /// `MIEN_KIND_ANIMATED_MAP` in C.
    pub const ANIMATED_MAP: Self = Self(7);
    /// `MIEN_KIND_MESH` in C.
    pub const MESH: Self = Self(8);
    /// Region masks, one per region of each mesh: "mesh/region".
    pub const ML_MASK: Self = Self(9);
    /// Without names.
    pub const JOINT_GROUP: Self = Self(10);
    /// Without names.
    pub const RBF_SOLVER: Self = Self(11);
    /// Without names: a swing and the twists with the same inputs, or a twist alone.
    pub const TWIST_SWING: Self = Self(12);
}

numbers!(Kind, u32, [(0, "GUI_CONTROL"), (1, "RAW_CONTROL"), (2, "PSD_CONTROL"), (3, "ML_CONTROL"), (4, "RBF_CONTROL"), (5, "JOINT"), (6, "BLEND_SHAPE_CHANNEL"), (7, "ANIMATED_MAP"), (8, "MESH"), (9, "ML_MASK"), (10, "JOINT_GROUP"), (11, "RBF_SOLVER"), (12, "TWIST_SWING")]);

/// Stages of an evaluation, combined with \|.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(transparent)]
pub struct Stages(pub u32);

impl Stages {
    /// Neural networks.
    pub const ML: Self = Self(1);
    /// RBF solvers.
    pub const RBF: Self = Self(2);
    /// correctives.
    pub const PSD: Self = Self(4);
    /// Joint groups, then twists and swings, then ML joints.
    pub const JOINTS: Self = Self(8);
    /// `MIEN_STAGE_BLEND_SHAPES` in C.
    pub const BLEND_SHAPES: Self = Self(16);
    /// `MIEN_STAGE_ANIMATED_MAPS` in C.
    pub const ANIMATED_MAPS: Self = Self(32);
    /// `MIEN_STAGE_ALL` in C.
    pub const ALL: Self = Self(63);
}

flags!(Stages, u32, [(1, "ML"), (2, "RBF"), (4, "PSD"), (8, "JOINTS"), (16, "BLEND_SHAPES"), (32, "ANIMATED_MAPS"), (63, "ALL")]);

/// How the neutral rotation of a joint is combined with its delta.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Compose(pub u32);

impl Compose {
    /// Neutral rotation \* delta rotation: the delta rotates first.
    pub const PRODUCT: Self = Self(0);
    /// The angles are added; requires `RotationOutput::EULER`. Equals the product where the
    /// neutral rotation is zero.
    pub const EULER_ADD: Self = Self(1);
}

numbers!(Compose, u32, [(0, "PRODUCT"), (1, "EULER_ADD")]);

/// Treatment of skin weights.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Weights(pub u32);

impl Weights {
    /// `MIEN_WEIGHTS_AS_STORED` in C.
    pub const AS_STORED: Self = Self(0);
    /// Drop negative weights and divide the others by their sum.
    pub const FIX: Self = Self(1);
}

numbers!(Weights, u32, [(0, "AS_STORED"), (1, "FIX")]);

/// Normals of deformed meshes; they have unit length. Where no normal can be computed (no faces,
/// or faces without area), the neutral one is used. See docs/deformation.md, 3 "Normals".
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Normals(pub u32);

impl Normals {
    /// As MienDeformerDesc.normals says; in that field: recomputed.
    pub const DEFAULT: Self = Self(0);
    /// Leave normals unchanged.
    pub const NONE: Self = Self(1);
    /// Neutral normals rotated by the skinning, correct for any scale; blend shape targets have no
    /// effect.
    pub const SKINNED: Self = Self(2);
    /// The area-weighted mean of the normals of the faces around the position. On hard edges,
    /// where this differs from the stored normal by more than 30 degrees in the neutral pose, the
    /// stored normal is rotated by the rotation of this mean from the neutral pose.
    pub const RECOMPUTED: Self = Self(3);
}

numbers!(Normals, u32, [(0, "DEFAULT"), (1, "NONE"), (2, "SKINNED"), (3, "RECOMPUTED")]);

/// Layout of a vertex attribute in memory, in the byte order of the machine. A signed normalized
/// integer of n bits is round(clamp(v, -1, 1) \* (2^(n-1) - 1)), ties to even, in two's
/// complement. These are the vertex formats R32G32B32\_SFLOAT, R32G32B32A32\_SFLOAT,
/// R16G16B16A16\_SNORM and A2B10G10R10\_SNORM\_PACK32 of Vulkan, and float3, float4,
/// short4Normalized and int1010102Normalized of Metal. Direct3D 12 and WebGPU lack the last one.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct VertexFormat(pub u32);

impl VertexFormat {
    /// 12 bytes: x y z.
    pub const FLOAT32X3: Self = Self(0);
    /// 16 bytes: x y z w.
    pub const FLOAT32X4: Self = Self(1);
    /// 8 bytes: x y z w, 16 bits each.
    pub const SNORM16X4: Self = Self(2);
    /// 4 bytes, one 32-bit word: x in bits 0-9, y in bits 10-19, z in bits 20-29, w in bits 30-31.
    pub const SNORM10_10_10_2: Self = Self(3);
}

numbers!(VertexFormat, u32, [(0, "FLOAT32X3"), (1, "FLOAT32X4"), (2, "SNORM16X4"), (3, "SNORM10_10_10_2")]);

/// Points on the way from controls to positions:
///
/// ```text
/// GUI -> RAW -> CONTROLS -> JOINTS -> LOCALS -> MODELS -> SKINS -> POSITIONS
///                   |-> CHANNELS ------------------------------------^
///                   |-> MAPS
/// ```
///
/// Derivatives lead from one point to a later one that depends on it. Networks, RBF solvers and
/// correctives run between RAW and CONTROLS; the joint stage, channels and maps read CONTROLS.
/// From JOINTS on, channel weights are constant. See docs/derivatives.md.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Point(pub u32);

impl Point {
    /// GUI controls.
    pub const GUI: Self = Self(0);
    /// Raw controls.
    pub const RAW: Self = Self(1);
    /// All controls: `mien_instance_controls()`.
    pub const CONTROLS: Self = Self(2);
    /// Joint values: `mien_instance_joints()`.
    pub const JOINTS: Self = Self(3);
    /// 16 floats per joint: matrix relative to the parent, four columns.
    pub const LOCALS: Self = Self(4);
    /// The same, in model space: `mien_deformer_instance_joint_matrices()`.
    pub const MODELS: Self = Self(5);
    /// The same, of skin matrices: `mien_deformer_instance_skin_matrices()`.
    pub const SKINS: Self = Self(6);
    /// X y z per position of a mesh, in the order of the file.
    pub const POSITIONS: Self = Self(7);
    /// Blend shape channel weights.
    pub const CHANNELS: Self = Self(8);
    /// Animated map weights.
    pub const MAPS: Self = Self(9);
}

numbers!(Point, u32, [(0, "GUI"), (1, "RAW"), (2, "CONTROLS"), (3, "JOINTS"), (4, "LOCALS"), (5, "MODELS"), (6, "SKINS"), (7, "POSITIONS"), (8, "CHANNELS"), (9, "MAPS")]);

/// What is checked when a baked file is used.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct BakedCheck(pub u32);

impl BakedCheck {
    /// All sizes, counts and indices, so that no access is out of bounds whatever the bytes are.
    /// Floats are not checked, so their pages are read from disk only when first used.
    pub const SAFE: Self = Self(0);
    /// Also the checksum of all bytes, which reads the whole file.
    pub const FULL: Self = Self(1);
}

numbers!(BakedCheck, u32, [(0, "SAFE"), (1, "FULL")]);

/// What happens after the last frame.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Looping(pub u32);

impl Looping {
    /// A clip: `Looping::CLAMP`; a player: the setting of its clip.
    pub const DEFAULT: Self = Self(0);
    /// Holds the last frame; the length is (frames - 1) \* ticks per frame.
    pub const CLAMP: Self = Self(1);
    /// Starts over; the length is frames \* ticks per frame.
    pub const WRAP: Self = Self(2);
}

numbers!(Looping, u32, [(0, "DEFAULT"), (1, "CLAMP"), (2, "WRAP")]);

/// How values between two frames are computed. They stay within the range of these two frames.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Interpolation(pub u32);

impl Interpolation {
    /// `MIEN_INTERPOLATION_LINEAR` in C.
    pub const LINEAR: Self = Self(0);
    /// The value of the earlier frame.
    pub const STEP: Self = Self(1);
    /// A Catmull-Rom spline, clamped to that range.
    pub const CATMULL_ROM: Self = Self(2);
}

numbers!(Interpolation, u32, [(0, "LINEAR"), (1, "STEP"), (2, "CATMULL_ROM")]);

/// The purpose of a layer. Guards protect the result of base and speech from the other groups.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct LayerGroup(pub u32);

impl LayerGroup {
    /// `MIEN_LAYER_GROUP_BASE` in C.
    pub const BASE: Self = Self(0);
    /// `MIEN_LAYER_GROUP_SPEECH` in C.
    pub const SPEECH: Self = Self(1);
    /// `MIEN_LAYER_GROUP_EMOTION` in C.
    pub const EMOTION: Self = Self(2);
    /// `MIEN_LAYER_GROUP_REACTION` in C.
    pub const REACTION: Self = Self(3);
    /// Acts after the reactions if no layer of another group follows.
    pub const LIFE: Self = Self(4);
}

numbers!(LayerGroup, u32, [(0, "BASE"), (1, "SPEECH"), (2, "EMOTION"), (3, "REACTION"), (4, "LIFE")]);

/// How a layer changes a curve: o is the value so far, x the value of the layer, a = weight \*
/// mask. Curves for which the layer's source has no value do not change.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct BlendMode(pub u32);

impl BlendMode {
    /// O + a (x - o).
    pub const OVERRIDE: Self = Self(0);
    /// O + a x.
    pub const ADD: Self = Self(1);
    /// O + a x (1 - p), or o + a x p if x \< 0; p is o clamped to 0..1.
    pub const SCREEN: Self = Self(2);
    /// O + a max(0, x - o).
    pub const MAX: Self = Self(3);
    /// O (1 + a (x - 1)).
    pub const SCALE: Self = Self(4);
}

numbers!(BlendMode, u32, [(0, "OVERRIDE"), (1, "ADD"), (2, "SCREEN"), (3, "MAX"), (4, "SCALE")]);

/// Where the values of a layer come from.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct LayerSource(pub u32);

impl LayerSource {
    /// `mien_mixer_play()`.
    pub const CLIP: Self = Self(0);
    /// A weighted sum: `mien_mixer_set_pose_weight()`.
    pub const POSES: Self = Self(1);
    /// `mien_mixer_push()`.
    pub const STREAM: Self = Self(2);
    /// `Generator`
    pub const GENERATOR: Self = Self(3);
}

numbers!(LayerSource, u32, [(0, "CLIP"), (1, "POSES"), (2, "STREAM"), (3, "GENERATOR")]);

/// What a layer generates from the seed of the mixer and the time.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Generator(pub u32);

impl Generator {
    /// Blinks every `period` on average, at least 0.5 s apart. The wait starts over when earlier
    /// layers raise the first curve above 0.6.
    pub const BLINK: Self = Self(0);
    /// Rises from 0 to 1 in 40 % of the period, then falls back to 0.
    pub const BREATH: Self = Self(1);
    /// Smooth noise between -1 and 1 with a new random value every period.
    pub const NOISE: Self = Self(2);
    /// Turns the eyes to a target with saccades, by MienMixDesc.gaze. `curves` are three curves
    /// with the left, up and front of a MienGazeTarget, read after the earlier layers, then
    /// optionally two curves that get the part left for the head (MienGazeRest). `amounts` are
    /// fixation jitter sideways and up in degrees, 0, and factors for the two head curves. Shifts
    /// of 20 degrees or more make the blink layers of the mix blink.
    pub const GAZE: Self = Self(3);
}

numbers!(Generator, u32, [(0, "BLINK"), (1, "BREATH"), (2, "NOISE"), (3, "GAZE")]);

/// What a trigger does while the reaction is already running.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Retrigger(pub u32);

impl Retrigger {
    /// Extends the stimulus; strokes that are releasing or over start again.
    pub const EXTEND: Self = Self(0);
    /// All strokes start again, at most once per cooldown.
    pub const RESTART: Self = Self(1);
    /// `MIEN_RETRIGGER_IGNORE` in C.
    pub const IGNORE: Self = Self(2);
}

numbers!(Retrigger, u32, [(0, "EXTEND"), (1, "RESTART"), (2, "IGNORE")]);

/// Built-in guards: gaps that emotions and reactions must not open while speech or a blink closes
/// them. Bits of MienMixDesc.guards.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(transparent)]
pub struct Guard(pub u32);

impl Guard {
    /// Between the lips, left, center and right, and from lower lip to upper teeth.
    pub const LIPS: Self = Self(1);
    /// Between the lids.
    pub const LIDS: Self = Self(2);
    /// Between the teeth.
    pub const TEETH: Self = Self(4);
    /// `MIEN_GUARD_ALL` in C.
    pub const ALL: Self = Self(7);
}

flags!(Guard, u32, [(1, "LIPS"), (2, "LIDS"), (4, "TEETH"), (7, "ALL")]);

/// How a layer changes to another clip. A layer that plays no clip fades in, except with a cut.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Transition(pub u32);

impl Transition {
    /// The old clip stops; each curve blends from its last value and speed.
    pub const INERTIAL: Self = Self(0);
    /// Both clips play; `Transition::INERTIAL` if no player is free.
    pub const CROSSFADE: Self = Self(1);
    /// Immediate; `transition_ticks` is not used.
    pub const CUT: Self = Self(2);
}

numbers!(Transition, u32, [(0, "INERTIAL"), (1, "CROSSFADE"), (2, "CUT")]);

/// How a name was matched.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct NameMatch(pub u32);

impl NameMatch {
    /// `MIEN_NAME_MATCH_NONE` in C.
    pub const NONE: Self = Self(0);
    /// The control has this name.
    pub const AS_WRITTEN: Self = Self(1);
    /// The same letters and side.
    pub const SPELLING: Self = Self(2);
    /// Another word for the same control.
    pub const ALIAS: Self = Self(3);
    /// The controls of the left and the right side.
    pub const BOTH_SIDES: Self = Self(4);
    /// An expression of several controls.
    pub const EXPRESSION: Self = Self(5);
}

numbers!(NameMatch, u32, [(0, "NONE"), (1, "AS_WRITTEN"), (2, "SPELLING"), (3, "ALIAS"), (4, "BOTH_SIDES"), (5, "EXPRESSION")]);

/// Kinds of generated rigs.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Preset(pub u32);

impl Preset {
    /// Small enough to read.
    pub const TINY: Self = Self(0);
    /// `MIEN_PRESET_SMALL` in C.
    pub const SMALL: Self = Self(1);
    /// `MIEN_PRESET_MEDIUM` in C.
    pub const MEDIUM: Self = Self(2);
    /// A synthetic rig of production size: 870 joints, 260 raw controls, 8 LODs, a million matrix
    /// entries.
    pub const LARGE: Self = Self(3);
    /// A synthetic rig of the size of a production body: 342 joints, moved by 72 RBF solvers with
    /// 670 poses, 22 twists and 16 swings; some are quaternion joints.
    pub const BODY: Self = Self(4);
    /// A stylized head to look at: skin, eyes, teeth, tongue, hair; the 52 ARKit expressions and
    /// 20 of MetaHuman rigs as raw controls (0 to 1), correctives, wrinkle maps, 8 LODs. Seed 0 is
    /// the designed head; other seeds vary skull, nose, jaw, age, hair and colors. The metadata
    /// holds vertex colors: key "mien.colors.\<mesh name\>", value base64 of 3 bytes (sRGB) per
    /// vertex position of the mesh.
    pub const HEAD: Self = Self(5);
    /// A synthetic rig with the published counts of exported heads and names in MetaHuman's
    /// conventions: version 2.5, 870 joints, 263 raw controls (251 expressions, 12 parts of
    /// quaternions), 174 GUI controls, 545 correctives, 782 channels, an RBF solver with 18 poses,
    /// 8 LODs.
    pub const METAHUMAN_HEAD: Self = Self(6);
    /// `Preset::BODY` in version 2.7.
    pub const METAHUMAN_BODY: Self = Self(7);
    /// `Preset::METAHUMAN_HEAD` without blend shapes.
    pub const ARCHETYPE: Self = Self(8);
}

numbers!(Preset, u32, [(0, "TINY"), (1, "SMALL"), (2, "MEDIUM"), (3, "LARGE"), (4, "BODY"), (5, "HEAD"), (6, "METAHUMAN_HEAD"), (7, "METAHUMAN_BODY"), (8, "ARCHETYPE")]);

/// Additions to a preset, combined with \|.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(transparent)]
pub struct Generate(pub u32);

impl Generate {
    /// machine-learned behavior: networks for mesh regions with all activation functions and
    /// operations, and ML joints; not with `Preset::HEAD` and those after it.
    pub const ML: Self = Self(1);
}

numbers!(Generate, u32, [(1, "ML")]);

/// The role of a bone.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct BoneKind(pub u32);

impl BoneKind {
    /// `MIEN_BONE_ROOT` in C.
    pub const ROOT: Self = Self(0);
    /// `MIEN_BONE_NECK` in C.
    pub const NECK: Self = Self(1);
    /// `MIEN_BONE_HEAD` in C.
    pub const HEAD: Self = Self(2);
    /// `MIEN_BONE_FACE` in C.
    pub const FACE: Self = Self(3);
    /// Moves with expressions; each LOD keeps the first n of these.
    pub const FACIAL: Self = Self(4);
    /// `MIEN_BONE_JAW` in C.
    pub const JAW: Self = Self(5);
    /// `MIEN_BONE_EYE` in C.
    pub const EYE: Self = Self(6);
    /// Below the neck.
    pub const CHEST: Self = Self(7);
    /// Moves with expressions, below the jaw; in every LOD.
    pub const TONGUE: Self = Self(8);
}

numbers!(BoneKind, u32, [(0, "ROOT"), (1, "NECK"), (2, "HEAD"), (3, "FACE"), (4, "FACIAL"), (5, "JAW"), (6, "EYE"), (7, "CHEST"), (8, "TONGUE")]);

/// Whether both halves of the face are treated as mirror images.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Symmetry(pub u32);

impl Symmetry {
    /// If mirrored positions lie within 0.5 % of the face's size of the surface.
    pub const AUTO: Self = Self(0);
    /// `MIEN_SYMMETRY_ON` in C.
    pub const ON: Self = Self(1);
    /// `MIEN_SYMMETRY_OFF` in C.
    pub const OFF: Self = Self(2);
}

numbers!(Symmetry, u32, [(0, "AUTO"), (1, "ON"), (2, "OFF")]);

/// Directions of the axes of a mesh.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct MeshAxis(pub u32);

impl MeshAxis {
    /// Up: Y; front: Z.
    pub const DEFAULT: Self = Self(0);
    /// `MIEN_MESH_AXIS_X` in C.
    pub const X: Self = Self(1);
    /// `MIEN_MESH_AXIS_Y` in C.
    pub const Y: Self = Self(2);
    /// `MIEN_MESH_AXIS_Z` in C.
    pub const Z: Self = Self(3);
    /// `MIEN_MESH_AXIS_MINUS_X` in C.
    pub const MINUS_X: Self = Self(4);
    /// `MIEN_MESH_AXIS_MINUS_Y` in C.
    pub const MINUS_Y: Self = Self(5);
    /// `MIEN_MESH_AXIS_MINUS_Z` in C.
    pub const MINUS_Z: Self = Self(6);
}

numbers!(MeshAxis, u32, [(0, "DEFAULT"), (1, "X"), (2, "Y"), (3, "Z"), (4, "MINUS_X"), (5, "MINUS_Y"), (6, "MINUS_Z")]);

/// How bones and weights are computed, combined with \|.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(transparent)]
pub struct AuthorFlags(pub u32);

impl AuthorFlags {
    /// Only the published method, plus the neck cut: no symmetry, no weighting by motion, no
    /// joints for jaw and eyes.
    pub const PAPER: Self = Self(1);
    /// The face mask may include parts of the neck.
    pub const NO_NECK_CUT: Self = Self(2);
    /// The face mask is where shapes move: for heads that are not human.
    pub const MASK_FROM_SHAPES: Self = Self(4);
    /// Weight positions by the area around them: for scans.
    pub const AREA_DENSITY: Self = Self(8);
    /// No blend shape targets for the motion that joints cannot produce.
    pub const NO_TARGETS: Self = Self(16);
    /// Group by distance in space, not in depth: for comparison.
    pub const GROUP_IN_SPACE: Self = Self(32);
    /// Name bones that are placed and controls that are added as in MetaHuman heads where they
    /// have a counterpart: `neck_01`, FACIAL\_C\_Jaw, CTRL\_expressions.jawOpen. The caller's
    /// bones and shapes keep their names.
    pub const METAHUMAN_NAMES: Self = Self(64);
}

flags!(AuthorFlags, u32, [(1, "PAPER"), (2, "NO_NECK_CUT"), (4, "MASK_FROM_SHAPES"), (8, "AREA_DENSITY"), (16, "NO_TARGETS"), (32, "GROUP_IN_SPACE"), (64, "METAHUMAN_NAMES")]);

/// How positions of one mesh are found on another.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Match(pub u32);

impl Match {
    /// The nearest point in space.
    pub const SURFACE: Self = Self(0);
    /// The nearest point in the texture.
    pub const UV: Self = Self(1);
}

numbers!(Match, u32, [(0, "SURFACE"), (1, "UV")]);

/// What a constraint asks for. Places and directions are in model space, before the motion of
/// MienFitFrame.rigid. Kinds with joints need MienFitDesc.deformer.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct FitConstraintKind(pub u32);

impl FitConstraintKind {
    /// `joint` is at `target`: where the jaw is.
    pub const JOINT_POSITION: Self = Self(0);
    /// `axis` of `joint` has the direction `target`: an eye's gaze.
    pub const JOINT_DIRECTION: Self = Self(1);
    /// `axis` of `joint` points at the place `target`.
    pub const JOINT_AIM: Self = Self(2);
    /// `points[0]` is at `target`.
    pub const POINT_POSITION: Self = Self(3);
    /// From `distances[0]` to `distances[1]` lie between `points`: 0 and 0 where lips touch.
    pub const POINT_DISTANCE: Self = Self(4);
}

numbers!(FitConstraintKind, u32, [(0, "JOINT_POSITION"), (1, "JOINT_DIRECTION"), (2, "JOINT_AIM"), (3, "POINT_POSITION"), (4, "POINT_DISTANCE")]);

/// Why a solve ended.
///
/// A later library may give numbers that have no name here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct FitStatus(pub u32);

impl FitStatus {
    /// Further steps change nothing.
    pub const CONVERGED: Self = Self(0);
    /// The limit of iterations was reached; the best controls so far.
    pub const ITERATIONS: Self = Self(1);
    /// The limit of time was reached; likewise.
    pub const TIME: Self = Self(2);
    /// The caller asked to stop; likewise.
    pub const CANCELED: Self = Self(3);
    /// No target, or all are missing; the start is returned.
    pub const NO_DATA: Self = Self(4);
}

numbers!(FitStatus, u32, [(0, "CONVERGED"), (1, "ITERATIONS"), (2, "TIME"), (3, "CANCELED"), (4, "NO_DATA")]);

/// Axes, units and rotation conventions of a rig. Any handedness is allowed.
///
/// See docs/dna-format.md, 11 "Coordinate systems".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct CoordinateSystem {
    /// `Direction` of x, y, z.
    pub axes: [Direction; 3],
    /// Translation unit.
    pub translation_unit: TranslationUnit,
    /// Rotation unit.
    pub rotation_unit: RotationUnit,
    /// Rotation rule.
    pub rotation_rule: RotationRule,
    /// `RotationSequence`; ignored with `RotationRule::CARRIED`.
    pub rotation_sequence: RotationSequence,
    /// Of the angles about x, y, z. 1: rotates y to z, z to x, x to y. -1: the other way. 0:
    /// whichever leaves the angles unchanged.
    pub rotation_signs: [i32; 3],
    /// Face winding.
    pub face_winding: FaceWinding,
}

impl From<sys::MienCoordinateSystem> for CoordinateSystem {
    fn from(c: sys::MienCoordinateSystem) -> Self {
        Self {
            axes: c.axes.map(Direction),
            translation_unit: TranslationUnit(c.translation_unit),
            rotation_unit: RotationUnit(c.rotation_unit),
            rotation_rule: RotationRule(c.rotation_rule),
            rotation_sequence: RotationSequence(c.rotation_sequence),
            rotation_signs: c.rotation_signs,
            face_winding: FaceWinding(c.face_winding),
        }
    }
}

impl From<&CoordinateSystem> for sys::MienCoordinateSystem {
    fn from(safe: &CoordinateSystem) -> Self {
        Self {
            axes: safe.axes.map(|value| value.0),
            translation_unit: safe.translation_unit.0,
            rotation_unit: safe.rotation_unit.0,
            rotation_rule: safe.rotation_rule.0,
            rotation_sequence: safe.rotation_sequence.0,
            rotation_signs: safe.rotation_signs,
            face_winding: safe.face_winding.0,
            ..Default::default()
        }
    }
}

/// Properties of an open DNA. Counts are those of the loaded layers and LODs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct DnaInfo {
    /// 2.
    pub generation: u32,
    /// 1 to 8: the file is of version 2.version.
    pub version: u32,
    /// `Layers`, combined with \|: the loaded layers.
    pub layers: Layers,
    /// The geometry is loaded with its targets.
    pub has_blend_shape_targets: bool,
    /// Size of the file.
    pub file_bytes: u64,
    /// Memory taken from the allocator.
    pub memory_bytes: u64,
    /// The file is mapped.
    pub is_mapped: bool,
    /// Entries for `mien_dna_layer()`.
    pub layer_count: usize,
    /// Translation unit.
    pub translation_unit: TranslationUnit,
    /// Rotation unit.
    pub rotation_unit: RotationUnit,
    /// `Direction` of x, y, z.
    pub axes: [Direction; 3],
    /// Rotation sequence.
    pub rotation_sequence: RotationSequence,
    /// 1 or -1, for the angles about x, y, z.
    pub rotation_signs: [i32; 3],
    /// Face winding.
    pub face_winding: FaceWinding,
    /// Lod count.
    pub lod_count: usize,
    /// LOD 0 of this file is LOD `max_lod` of its database.
    pub max_lod: u32,
    /// Gui control count.
    pub gui_control_count: usize,
    /// Raw control count.
    pub raw_control_count: usize,
    /// Psd control count.
    pub psd_control_count: usize,
    /// Ml control count.
    pub ml_control_count: usize,
    /// Rbf control count.
    pub rbf_control_count: usize,
    /// Joint count.
    pub joint_count: usize,
    /// Joint group count.
    pub joint_group_count: usize,
    /// Blend shape channel count.
    pub blend_shape_channel_count: usize,
    /// Animated map count.
    pub animated_map_count: usize,
    /// Mesh count.
    pub mesh_count: usize,
    /// Neural network count.
    pub neural_network_count: usize,
    /// Rbf solver count.
    pub rbf_solver_count: usize,
    /// Rbf pose count.
    pub rbf_pose_count: usize,
    /// Twist count.
    pub twist_count: usize,
    /// Swing count.
    pub swing_count: usize,
    /// Pairs desc.metadata\[i\].key and .value.
    pub metadata_count: usize,
}

impl From<sys::MienDnaInfo> for DnaInfo {
    fn from(c: sys::MienDnaInfo) -> Self {
        Self {
            generation: c.generation,
            version: c.version,
            layers: Layers(c.layers),
            has_blend_shape_targets: c.has_blend_shape_targets != 0,
            file_bytes: c.file_bytes,
            memory_bytes: c.memory_bytes,
            is_mapped: c.is_mapped != 0,
            layer_count: c.layer_count as usize,
            translation_unit: TranslationUnit(c.translation_unit),
            rotation_unit: RotationUnit(c.rotation_unit),
            axes: c.axes.map(Direction),
            rotation_sequence: RotationSequence(c.rotation_sequence),
            rotation_signs: c.rotation_signs,
            face_winding: FaceWinding(c.face_winding),
            lod_count: c.lod_count as usize,
            max_lod: c.max_lod,
            gui_control_count: c.gui_control_count as usize,
            raw_control_count: c.raw_control_count as usize,
            psd_control_count: c.psd_control_count as usize,
            ml_control_count: c.ml_control_count as usize,
            rbf_control_count: c.rbf_control_count as usize,
            joint_count: c.joint_count as usize,
            joint_group_count: c.joint_group_count as usize,
            blend_shape_channel_count: c.blend_shape_channel_count as usize,
            animated_map_count: c.animated_map_count as usize,
            mesh_count: c.mesh_count as usize,
            neural_network_count: c.neural_network_count as usize,
            rbf_solver_count: c.rbf_solver_count as usize,
            rbf_pose_count: c.rbf_pose_count as usize,
            twist_count: c.twist_count as usize,
            swing_count: c.swing_count as usize,
            metadata_count: c.metadata_count as usize,
        }
    }
}

/// An entry of the index table of the file. Files of version 2.1 have no index table; their
/// sections are listed as the layers desc, defn, bhvr and geom.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct DnaLayer {
    /// `Layers` that loads it. `Layers::UNKNOWN`: no known kind.
    pub layer: Layers,
    /// Of the layer: `version_major`.`version_minor`.
    pub version_major: u32,
    /// Version minor.
    pub version_minor: u32,
    /// It was parsed, not skipped or kept as bytes.
    pub is_loaded: bool,
    /// Of its first byte in the file.
    pub byte_offset: u64,
    /// Byte count.
    pub byte_count: u64,
    /// Such as "bhvr"; null-terminated.
    pub code: String,
}

impl From<sys::MienDnaLayer> for DnaLayer {
    fn from(c: sys::MienDnaLayer) -> Self {
        Self {
            layer: Layers(c.layer),
            version_major: c.version_major,
            version_minor: c.version_minor,
            is_loaded: c.is_loaded != 0,
            byte_offset: c.byte_offset,
            byte_count: c.byte_count,
            code: text(&c.code),
        }
    }
}

/// `MienDnaField` in C.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct DnaField {
    /// Type.
    pub field_type: FieldType,
    /// An array of numbers, even if it has only one element; not a single number, nor an element
    /// of an array.
    pub is_array: bool,
    /// Elements of an array or list, bytes of a string, fields of a record; 1 for a number.
    pub count: u64,
    /// Of a string, an array or an element of an array in the file; `None`: other fields, and data
    /// that is not in the file.
    pub byte_offset: Option<u64>,
}

impl From<sys::MienDnaField> for DnaField {
    fn from(c: sys::MienDnaField) -> Self {
        Self {
            field_type: FieldType(c.r#type),
            is_array: c.is_array != 0,
            count: c.count,
            byte_offset: offset(c.byte_offset),
        }
    }
}

/// Properties of a rig.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct RigInfo {
    /// `Isa` in use, never `Isa::BEST`.
    pub isa: Isa,
    /// Lod count.
    pub lod_count: usize,
    /// Translation unit.
    pub translation_unit: TranslationUnit,
    /// Rotation unit.
    pub rotation_unit: RotationUnit,
    /// `Direction` of x, y, z.
    pub axes: [Direction; 3],
    /// Rotation sequence.
    pub rotation_sequence: RotationSequence,
    /// 1 or -1, for the angles about x, y, z.
    pub rotation_signs: [i32; 3],
    /// Length of the control vector: raw, PSD, ML, RBF controls.
    pub control_count: usize,
    /// 9 or 10 per joint.
    pub joint_value_count: usize,
    /// Rotation output.
    pub rotation_output: RotationOutput,
    /// Storage.
    pub storage: Storage,
    /// Arithmetic.
    pub arithmetic: Arithmetic,
    /// Memory of the rig, including its part of a baked file.
    pub rig_bytes: u64,
    /// Memory of each instance.
    pub instance_bytes: u64,
}

impl From<sys::MienRigInfo> for RigInfo {
    fn from(c: sys::MienRigInfo) -> Self {
        Self {
            isa: Isa(c.isa),
            lod_count: c.lod_count as usize,
            translation_unit: TranslationUnit(c.translation_unit),
            rotation_unit: RotationUnit(c.rotation_unit),
            axes: c.axes.map(Direction),
            rotation_sequence: RotationSequence(c.rotation_sequence),
            rotation_signs: c.rotation_signs,
            control_count: c.control_count as usize,
            joint_value_count: c.joint_value_count as usize,
            rotation_output: RotationOutput(c.rotation_output),
            storage: Storage(c.storage),
            arithmetic: Arithmetic(c.arithmetic),
            rig_bytes: c.rig_bytes,
            instance_bytes: c.instance_bytes,
        }
    }
}

/// The work of an evaluation at a LOD when all controls are active.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct RigStatistics {
    /// Lod.
    pub lod: u32,
    /// Correctives computed.
    pub psd_count: usize,
    /// Joints of the LOD.
    pub joint_count: usize,
    /// Rows of the joint groups.
    pub joint_row_count: usize,
    /// Channels written.
    pub blend_shape_count: usize,
    /// Rows of the animated map table.
    pub animated_map_row_count: usize,
    /// RBF solvers of the LOD.
    pub rbf_solver_count: usize,
    /// Quaternion joints.
    pub quaternion_joint_count: usize,
    /// Stored in the joint matrix: 8 per block that is not all zeros.
    pub joint_entry_count: u64,
    /// Of the joint matrix; an evaluation does not read the columns of controls that are 0.
    pub joint_byte_count: u64,
}

impl From<sys::MienRigStatistics> for RigStatistics {
    fn from(c: sys::MienRigStatistics) -> Self {
        Self {
            lod: c.lod,
            psd_count: c.psd_count as usize,
            joint_count: c.joint_count as usize,
            joint_row_count: c.joint_row_count as usize,
            blend_shape_count: c.blend_shape_count as usize,
            animated_map_row_count: c.animated_map_row_count as usize,
            rbf_solver_count: c.rbf_solver_count as usize,
            quaternion_joint_count: c.quaternion_joint_count as usize,
            joint_entry_count: c.joint_entry_count,
            joint_byte_count: c.joint_byte_count,
        }
    }
}

/// What the joint stage reads for the current controls, at the LOD of the last evaluation
/// (initially LOD 0), if it reuses no results. Each byte is counted once, regardless of CPU
/// caches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct InstanceStatistics {
    /// Of the last evaluation.
    pub lod: u32,
    /// Of the control vector: raw, PSD, ML and RBF controls.
    pub control_count: usize,
    /// Controls that are not 0.
    pub active_control_count: usize,
    /// Columns of the joint matrix that active controls drive.
    pub joint_column_count: usize,
    /// Of these columns: 8 per block.
    pub joint_entry_count: u64,
    /// Of these entries: at most MienRigStatistics.`joint_byte_count`.
    pub joint_byte_count: u64,
}

impl From<sys::MienInstanceStatistics> for InstanceStatistics {
    fn from(c: sys::MienInstanceStatistics) -> Self {
        Self {
            lod: c.lod,
            control_count: c.control_count as usize,
            active_control_count: c.active_control_count as usize,
            joint_column_count: c.joint_column_count as usize,
            joint_entry_count: c.joint_entry_count,
            joint_byte_count: c.joint_byte_count,
        }
    }
}

/// Properties of a deformer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct DeformerInfo {
    /// `Isa` in use, never `Isa::BEST`.
    pub isa: Isa,
    /// Compose.
    pub compose: Compose,
    /// Weights.
    pub weights: Weights,
    /// `Normals`, never `Normals::DEFAULT`.
    pub normals: Normals,
    /// Lod count.
    pub lod_count: usize,
    /// Joint count.
    pub joint_count: usize,
    /// Channel count.
    pub channel_count: usize,
    /// Same as in the rig, which has their names: `Kind::MESH`.
    pub mesh_count: usize,
    /// Memory of the deformer, including its part of a baked file.
    pub deformer_bytes: u64,
    /// Memory of a deformer instance for all meshes.
    pub instance_bytes: u64,
    /// Storage.
    pub storage: Storage,
}

impl From<sys::MienDeformerInfo> for DeformerInfo {
    fn from(c: sys::MienDeformerInfo) -> Self {
        Self {
            isa: Isa(c.isa),
            compose: Compose(c.compose),
            weights: Weights(c.weights),
            normals: Normals(c.normals),
            lod_count: c.lod_count as usize,
            joint_count: c.joint_count as usize,
            channel_count: c.channel_count as usize,
            mesh_count: c.mesh_count as usize,
            deformer_bytes: c.deformer_bytes,
            instance_bytes: c.instance_bytes,
            storage: Storage(c.storage),
        }
    }
}

/// Properties of an open baked file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct BakedInfo {
    /// Size of the file.
    pub file_bytes: u64,
    /// Memory taken from the allocator.
    pub memory_bytes: u64,
    /// Size of the rig in the file. 0: it has none.
    pub rig_bytes: u64,
    /// Size of the deformer in the file. 0: it has none.
    pub deformer_bytes: u64,
    /// Parts of the file, including unknown ones.
    pub part_count: usize,
    /// The file is mapped.
    pub is_mapped: bool,
}

impl From<sys::MienBakedInfo> for BakedInfo {
    fn from(c: sys::MienBakedInfo) -> Self {
        Self {
            file_bytes: c.file_bytes,
            memory_bytes: c.memory_bytes,
            rig_bytes: c.rig_bytes,
            deformer_bytes: c.deformer_bytes,
            part_count: c.part_count as usize,
            is_mapped: c.is_mapped != 0,
        }
    }
}

/// Properties of a clip.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ClipInfo {
    /// Frames per second, as a fraction.
    pub rate_numerator: u32,
    /// Rate denominator.
    pub rate_denominator: u32,
    /// Frame count.
    pub frame_count: usize,
    /// Channel count.
    pub channel_count: usize,
    /// Channels whose value is not the same in all frames.
    pub changing_channel_count: usize,
    /// Event count.
    pub event_count: usize,
    /// `Looping::CLAMP` or `Looping::WRAP`.
    pub looping: Looping,
    /// As in MienClipDesc.
    pub is_delta: bool,
    /// Largest step to which a channel was rounded. 0: none was.
    pub snap: f32,
    /// The file is mapped.
    pub is_mapped: bool,
    /// Ticks per frame.
    pub ticks_per_frame: i64,
    /// ticks.
    pub length: i64,
    /// Size of the clip.
    pub file_bytes: u64,
    /// Memory taken from the allocator.
    pub memory_bytes: u64,
    /// Memory of a player without MienClipPlayerDesc.reverse.
    pub player_bytes: u64,
}

impl From<sys::MienClipInfo> for ClipInfo {
    fn from(c: sys::MienClipInfo) -> Self {
        Self {
            rate_numerator: c.rate_numerator,
            rate_denominator: c.rate_denominator,
            frame_count: c.frame_count as usize,
            channel_count: c.channel_count as usize,
            changing_channel_count: c.changing_channel_count as usize,
            event_count: c.event_count as usize,
            looping: Looping(c.looping),
            is_delta: c.is_delta != 0,
            snap: c.snap,
            is_mapped: c.is_mapped != 0,
            ticks_per_frame: c.ticks_per_frame,
            length: c.length,
            file_bytes: c.file_bytes,
            memory_bytes: c.memory_bytes,
            player_bytes: c.player_bytes,
        }
    }
}

/// State of a player.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ClipPlayerInfo {
    /// 0 to the length of the clip; with `Looping::WRAP` less than the length.
    pub tick: i64,
    /// Loops completed since creation or the last seek, at most 2^61; negative: backward.
    pub loops: i64,
    /// `Looping::CLAMP` or `Looping::WRAP`.
    pub looping: Looping,
    /// A damaged curve was played, as zeros.
    pub is_damaged: bool,
}

impl From<sys::MienClipPlayerInfo> for ClipPlayerInfo {
    fn from(c: sys::MienClipPlayerInfo) -> Self {
        Self {
            tick: c.tick,
            loops: c.loops,
            looping: Looping(c.looping),
            is_damaged: c.is_damaged != 0,
        }
    }
}

/// Properties of a mix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct MixInfo {
    /// Raw control count.
    pub raw_control_count: usize,
    /// Variable count.
    pub variable_count: usize,
    /// Raw controls and pose variables.
    pub curve_count: usize,
    /// Layer count.
    pub layer_count: usize,
    /// For `mien_mixer_stage()`.
    pub stage_count: usize,
    /// For `mien_mixer_set_guard()`.
    pub guard_count: usize,
    /// Memory of a mixer without MienMixerDesc.stages.
    pub mixer_bytes: u64,
    /// Size of a snapshot.
    pub snapshot_bytes: u64,
}

impl From<sys::MienMixInfo> for MixInfo {
    fn from(c: sys::MienMixInfo) -> Self {
        Self {
            raw_control_count: c.raw_control_count as usize,
            variable_count: c.variable_count as usize,
            curve_count: c.curve_count as usize,
            layer_count: c.layer_count as usize,
            stage_count: c.stage_count as usize,
            guard_count: c.guard_count as usize,
            mixer_bytes: c.mixer_bytes,
            snapshot_bytes: c.snapshot_bytes,
        }
    }
}

/// State of a mixer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct MixerInfo {
    /// Time since creation.
    pub tick: i64,
    /// Clip events that the last step passed.
    pub event_count: usize,
    /// There were more than MienMixDesc.`max_events`.
    pub lost_events: bool,
}

impl From<sys::MienMixerInfo> for MixerInfo {
    fn from(c: sys::MienMixerInfo) -> Self {
        Self {
            tick: c.tick,
            event_count: c.event_count as usize,
            lost_events: c.lost_events != 0,
        }
    }
}

/// Properties of a solver stack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct SolverStackInfo {
    /// Solver count.
    pub solver_count: usize,
    /// Curve count.
    pub curve_count: usize,
    /// Of all solvers.
    pub output_count: usize,
    /// Joint count.
    pub joint_count: usize,
    /// Memory of a state.
    pub state_bytes: u64,
}

impl From<sys::MienSolverStackInfo> for SolverStackInfo {
    fn from(c: sys::MienSolverStackInfo) -> Self {
        Self {
            solver_count: c.solver_count as usize,
            curve_count: c.curve_count as usize,
            output_count: c.output_count as usize,
            joint_count: c.joint_count as usize,
            state_bytes: c.state_bytes,
        }
    }
}

/// How many deltas and targets `mien_document_prune_targets()` removed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct PrunedTargets {
    /// Deltas.
    pub deltas: u64,
    /// Targets.
    pub targets: u64,
}

impl From<sys::MienPrunedTargets> for PrunedTargets {
    fn from(c: sys::MienPrunedTargets) -> Self {
        Self {
            deltas: c.deltas,
            targets: c.targets,
        }
    }
}

/// The effect of `mien_document_prune_joints()`: removed entries, and the largest distance by
/// which a position moved.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PrunedJoints {
    /// Entries of the joint matrix that were not 0.
    pub entry_count: u64,
    /// Of these, set to 0.
    pub removed_count: u64,
    /// In the unit of the file.
    pub worst_distance: f64,
    /// The raw control at 1, or the corrective whose raw controls were at 1.
    pub worst_control: u32,
    /// Worst mesh.
    pub worst_mesh: u32,
    /// Worst position.
    pub worst_position: u32,
}

impl From<sys::MienPrunedJoints> for PrunedJoints {
    fn from(c: sys::MienPrunedJoints) -> Self {
        Self {
            entry_count: c.entry_count,
            removed_count: c.removed_count,
            worst_distance: c.worst_distance,
            worst_control: c.worst_control,
            worst_mesh: c.worst_mesh,
            worst_position: c.worst_position,
        }
    }
}

/// How far the rig moved to follow a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Conformed {
    /// Largest distance by which a joint moved, in the unit of the file.
    pub joint_distance: f64,
    /// That joint.
    pub joint: u32,
}

impl From<sys::MienConformed> for Conformed {
    fn from(c: sys::MienConformed) -> Self {
        Self {
            joint_distance: c.joint_distance,
            joint: c.joint,
        }
    }
}

/// The `# Errors` section of what calls a function of the C interface.
macro_rules! errors {
    (mien_coordinate_system_find) => {
        "- [`Status::NAME`](crate::Status::NAME) if the name is none of these"
    };
    (mien_coordinate_system_find_n) => {
        "- [`Status::NAME`](crate::Status::NAME) if the name is none of these"
    };
    (mien_coordinate_system_name) => {
        "- [`Status::INDEX`](crate::Status::INDEX) if `index` is past the last name"
    };
    (mien_dna_open_file) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::LOD`](crate::Status::LOD) if it has none of the requested LODs\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only\n\
         - [`Status::FILE_OPEN`](crate::Status::FILE_OPEN) if the file cannot be read\n\
         - [`Status::FILE_READ`](crate::Status::FILE_READ) if the file cannot be read\n\
         - [`Status::DNA_SIGNATURE`](crate::Status::DNA_SIGNATURE) if it is not a DNA file of generation 2\n\
         - [`Status::DNA_VERSION`](crate::Status::DNA_VERSION) if it is not a DNA file of generation 2\n\
         - [`Status::DNA_TRUNCATED`](crate::Status::DNA_TRUNCATED) if its contents are not valid or cannot be converted to the requested system\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if its contents are not valid or cannot be converted to the requested system\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if its contents are not valid or cannot be converted to the requested system\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if its contents are not valid or cannot be converted to the requested system\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if its contents are not valid or cannot be converted to the requested system"
    };
    (mien_dna_open_memory) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::LOD`](crate::Status::LOD) if it has none of the requested LODs\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only\n\
         - [`Status::DNA_SIGNATURE`](crate::Status::DNA_SIGNATURE) if it is not a DNA file of generation 2\n\
         - [`Status::DNA_VERSION`](crate::Status::DNA_VERSION) if it is not a DNA file of generation 2\n\
         - [`Status::DNA_TRUNCATED`](crate::Status::DNA_TRUNCATED) if its contents are not valid or cannot be converted to the requested system\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if its contents are not valid or cannot be converted to the requested system\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if its contents are not valid or cannot be converted to the requested system\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if its contents are not valid or cannot be converted to the requested system\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if its contents are not valid or cannot be converted to the requested system"
    };
    (mien_dna_open_stream) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::LOD`](crate::Status::LOD) if it has none of the requested LODs\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only\n\
         - [`Status::FILE_READ`](crate::Status::FILE_READ) if the file cannot be read\n\
         - [`Status::DNA_SIGNATURE`](crate::Status::DNA_SIGNATURE) if it is not a DNA file of generation 2\n\
         - [`Status::DNA_VERSION`](crate::Status::DNA_VERSION) if it is not a DNA file of generation 2\n\
         - [`Status::DNA_TRUNCATED`](crate::Status::DNA_TRUNCATED) if its contents are not valid or cannot be converted to the requested system\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if its contents are not valid or cannot be converted to the requested system\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if its contents are not valid or cannot be converted to the requested system\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if its contents are not valid or cannot be converted to the requested system\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if its contents are not valid or cannot be converted to the requested system"
    };
    (mien_dna_info) => {
        "- [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only"
    };
    (mien_dna_layer) => {
        "- [`Status::INDEX`](crate::Status::INDEX) if `index` is not below MienDnaInfo.`layer_count`\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only"
    };
    (mien_dna_field) => {
        "- [`Status::INDEX`](crate::Status::INDEX) if an index in the path is past the end\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such field (the message contains the part of the path that does not exist)\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only"
    };
    (mien_dna_field_n) => {
        "- [`Status::INDEX`](crate::Status::INDEX) if an index in the path is past the end\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such field (the message contains the part of the path that does not exist)\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only"
    };
    (mien_dna_child_name) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the field is not a record\n\
         - [`Status::INDEX`](crate::Status::INDEX) if `index` or an index in the path is past the end\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such field\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only"
    };
    (mien_dna_child_name_n) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the field is not a record\n\
         - [`Status::INDEX`](crate::Status::INDEX) if `index` or an index in the path is past the end\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such field\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only"
    };
    (mien_dna_read_floats) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the field does not hold numbers of this kind\n\
         - [`Status::INDEX`](crate::Status::INDEX) if the range or an index in the path is past the end\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such field\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only"
    };
    (mien_dna_read_floats_n) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the field does not hold numbers of this kind\n\
         - [`Status::INDEX`](crate::Status::INDEX) if the range or an index in the path is past the end\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such field\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only"
    };
    (mien_dna_read_integers) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the field does not hold numbers of this kind\n\
         - [`Status::INDEX`](crate::Status::INDEX) if the range or an index in the path is past the end\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such field\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only"
    };
    (mien_dna_read_integers_n) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the field does not hold numbers of this kind\n\
         - [`Status::INDEX`](crate::Status::INDEX) if the range or an index in the path is past the end\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such field\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only"
    };
    (mien_dna_read_string) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the field is not a string\n\
         - [`Status::INDEX`](crate::Status::INDEX) if an index in the path is past the end\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such field\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only"
    };
    (mien_dna_read_string_n) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the field is not a string\n\
         - [`Status::INDEX`](crate::Status::INDEX) if an index in the path is past the end\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such field\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only"
    };
    (mien_dna_write_file) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator of the DNA returns NULL\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only\n\
         - [`Status::FILE_WRITE`](crate::Status::FILE_WRITE) if the file cannot be written\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the file could not be opened in the requested version\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the file could not be opened in the requested version\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if it would exceed 4 GiB\n\
         - [`Status::DNA_LAYER`](crate::Status::DNA_LAYER) if RBF behavior was loaded without the machine-learned behavior of its file (whose controls are numbered before its own)\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the file could not be opened in the requested version"
    };
    (mien_dna_write_memory) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the file could not be opened in the requested version\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the file could not be opened in the requested version\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if it would exceed 4 GiB\n\
         - [`Status::DNA_LAYER`](crate::Status::DNA_LAYER) if RBF behavior was loaded without the machine-learned behavior of its file (whose controls are numbered before its own)\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the file could not be opened in the requested version"
    };
    (mien_dna_validate_file) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only\n\
         - [`Status::FILE_OPEN`](crate::Status::FILE_OPEN) if the file cannot be read\n\
         - [`Status::FILE_READ`](crate::Status::FILE_READ) if the file cannot be read"
    };
    (mien_dna_validate_memory) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only"
    };
    (mien_report_counts) => {
        "- [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only"
    };
    (mien_report_finding) => {
        "- [`Status::INDEX`](crate::Status::INDEX) if `index` is past the last finding\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only"
    };
    (mien_rig_create) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::ISA`](crate::Status::ISA) if the requested instruction set is not available\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the rig is too large\n\
         - [`Status::DNA_LAYER`](crate::Status::DNA_LAYER) if `dna` was opened without its behavior\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if correctives depend on each other in a cycle"
    };
    (mien_rig_info) => {
        "- none with valid arguments"
    };
    (mien_rig_count) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range"
    };
    (mien_rig_name) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::INDEX`](crate::Status::INDEX) if `index` is not below `mien_rig_count()`"
    };
    (mien_rig_find) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `kind` has no names\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such name"
    };
    (mien_rig_find_n) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `kind` has no names\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such name"
    };
    (mien_rig_lod_indices) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `kind` is not one of these five\n\
         - [`Status::LOD`](crate::Status::LOD) if the rig has no such LOD"
    };
    (mien_rig_variable_joint_values) => {
        "- [`Status::LOD`](crate::Status::LOD) if the rig has no such LOD"
    };
    (mien_rig_joint_parents) => {
        "- none with valid arguments"
    };
    (mien_rig_neutral_joint_values) => {
        "- none with valid arguments"
    };
    (mien_rig_psd_inputs) => {
        "- [`Status::INDEX`](crate::Status::INDEX) if there is no such corrective"
    };
    (mien_rig_initial_raw_controls) => {
        "- none with valid arguments"
    };
    (mien_rig_statistics) => {
        "- [`Status::LOD`](crate::Status::LOD) if the rig has no such LOD"
    };
    (mien_instance_create) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out"
    };
    (mien_instance_reset) => {
        "- none with valid arguments"
    };
    (mien_instance_gui_controls) => {
        "- none with valid arguments"
    };
    (mien_instance_raw_controls) => {
        "- none with valid arguments"
    };
    (mien_instance_ml_masks) => {
        "- none with valid arguments"
    };
    (mien_instance_controls) => {
        "- none with valid arguments"
    };
    (mien_instance_psd_controls) => {
        "- none with valid arguments"
    };
    (mien_instance_ml_controls) => {
        "- none with valid arguments"
    };
    (mien_instance_rbf_controls) => {
        "- none with valid arguments"
    };
    (mien_instance_joints) => {
        "- none with valid arguments"
    };
    (mien_instance_blend_shapes) => {
        "- none with valid arguments"
    };
    (mien_instance_animated_maps) => {
        "- none with valid arguments"
    };
    (mien_instance_statistics) => {
        "- none with valid arguments"
    };
    (mien_rig_map_gui_to_raw) => {
        "- [`Status::MISMATCH`](crate::Status::MISMATCH) if `instance` belongs to another rig"
    };
    (mien_rig_map_raw_to_gui) => {
        "- [`Status::MISMATCH`](crate::Status::MISMATCH) if `instance` belongs to another rig"
    };
    (mien_rig_evaluate) => {
        "- [`Status::MISMATCH`](crate::Status::MISMATCH) if `instance` belongs to another rig\n\
         - [`Status::LOD`](crate::Status::LOD) if the rig has no such LOD"
    };
    (mien_rig_evaluate_stages) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if `instance` belongs to another rig\n\
         - [`Status::LOD`](crate::Status::LOD) if the rig has no such LOD"
    };
    (mien_batch_create) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out"
    };
    (mien_batch_bytes) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range"
    };
    (mien_rig_evaluate_batch) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `count` exceeds MienBatchDesc.capacity or an instance is listed twice\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if the batch or an instance belongs to another rig\n\
         - [`Status::LOD`](crate::Status::LOD) if the rig has no such LOD"
    };
    (mien_rig_evaluate_joint_group) => {
        "- [`Status::MISMATCH`](crate::Status::MISMATCH) if `instance` belongs to another rig\n\
         - [`Status::INDEX`](crate::Status::INDEX) if there is no such joint group\n\
         - [`Status::LOD`](crate::Status::LOD) if the rig has no such LOD"
    };
    (mien_rig_evaluate_rbf_solver) => {
        "- [`Status::MISMATCH`](crate::Status::MISMATCH) if `instance` belongs to another rig\n\
         - [`Status::INDEX`](crate::Status::INDEX) if there is no such solver\n\
         - [`Status::LOD`](crate::Status::LOD) if the rig has no such LOD"
    };
    (mien_rig_evaluate_twist_swing) => {
        "- [`Status::MISMATCH`](crate::Status::MISMATCH) if `instance` belongs to another rig\n\
         - [`Status::INDEX`](crate::Status::INDEX) if there is no such setup\n\
         - [`Status::LOD`](crate::Status::LOD) if the rig has no such LOD"
    };
    (mien_deformer_create) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `delta_error` is negative or not finite\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if the number or the names of joints, channels or meshes differ from those of the rig\n\
         - [`Status::ISA`](crate::Status::ISA) if the requested instruction set is not available\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if a position has more than 65535 influences\n\
         - [`Status::DNA_LAYER`](crate::Status::DNA_LAYER) if `dna` was opened without `Layers::GEOMETRY`\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if a joint is its own ancestor or a position, delta or weight is not finite"
    };
    (mien_deformer_create_subset) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if positions are not ascending\n\
         - [`Status::INDEX`](crate::Status::INDEX) if there is no such mesh or position\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out"
    };
    (mien_deformer_info) => {
        "- none with valid arguments"
    };
    (mien_deformer_mesh) => {
        "- [`Status::INDEX`](crate::Status::INDEX) if there is no such mesh"
    };
    (mien_deformer_triangles) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `count` is less than 3 \\* MienMesh.`triangle_count`\n\
         - [`Status::INDEX`](crate::Status::INDEX) if there is no such mesh\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory ran out"
    };
    (mien_deformer_texture_coordinates) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `count` is less than 2 \\* MienMesh.`vertex_count`\n\
         - [`Status::INDEX`](crate::Status::INDEX) if there is no such mesh"
    };
    (mien_deformer_influences) => {
        "- [`Status::INDEX`](crate::Status::INDEX) if there is no such mesh or position\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if the weights are stored with 16 bits (MienDeformerDesc.storage)"
    };
    (mien_deformer_target) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `count` is less than 3 \\* MienMesh.`position_count`\n\
         - [`Status::INDEX`](crate::Status::INDEX) if there is no such mesh or target"
    };
    (mien_deformer_bind_matrices) => {
        "- none with valid arguments"
    };
    (mien_deformer_inverse_bind_matrices) => {
        "- none with valid arguments"
    };
    (mien_deformer_instance_create) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out"
    };
    (mien_deformer_instance_update) => {
        "- [`Status::MISMATCH`](crate::Status::MISMATCH) if `instance` belongs to a rig other than that of the deformer"
    };
    (mien_deformer_instance_update_from_values) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if a count is not that of the rig"
    };
    (mien_deformer_instance_joint_matrices) => {
        "- none with valid arguments"
    };
    (mien_deformer_instance_skin_matrices) => {
        "- none with valid arguments"
    };
    (mien_deformer_instance_local_transforms) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `count` is less than 10 \\* MienDeformerInfo.`joint_count`"
    };
    (mien_deformer_instance_deform) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::INDEX`](crate::Status::INDEX) if there is no such mesh\n\
         - [`Status::LOD`](crate::Status::LOD) if `deformer_instance` has no memory for it (MienDeformerInstanceDesc.lods)"
    };
    (mien_deformer_instance_deform_batch) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an instance is listed twice\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if the instances have different deformers\n\
         - [`Status::INDEX`](crate::Status::INDEX) if there is no such mesh\n\
         - [`Status::LOD`](crate::Status::LOD) if an instance has no memory for it"
    };
    (mien_deformer_instance_positions) => {
        "- [`Status::INDEX`](crate::Status::INDEX) if there is no such mesh\n\
         - [`Status::LOD`](crate::Status::LOD) if `deformer_instance` has no memory for it"
    };
    (mien_deformer_instance_normals) => {
        "- [`Status::INDEX`](crate::Status::INDEX) if there is no such mesh\n\
         - [`Status::LOD`](crate::Status::LOD) if `deformer_instance` has no memory for it"
    };
    (mien_deformer_instance_write_vertices) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if a stream has a format that its attribute cannot have, a wrong stride or alignment or too little capacity, if streams overlap, if there is no stream, or if tangents are requested from a deformer without them\n\
         - [`Status::INDEX`](crate::Status::INDEX) if there is no such mesh\n\
         - [`Status::LOD`](crate::Status::LOD) if `deformer_instance` has no memory for it"
    };
    (mien_deformer_instance_write_vertices_batch) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if a stream has a format that its attribute cannot have, a wrong stride or alignment or too little capacity, if streams overlap, if there is no stream, or if tangents are requested from a deformer without them; or an instance is listed twice\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if the instances have different deformers\n\
         - [`Status::INDEX`](crate::Status::INDEX) if there is no such mesh\n\
         - [`Status::LOD`](crate::Status::LOD) if `deformer_instance` has no memory for it"
    };
    (mien_derivatives_create) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if the deformer is not of the rig\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out"
    };
    (mien_derivatives_bytes) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if the deformer is not of the rig"
    };
    (mien_derivatives_size) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::INDEX`](crate::Status::INDEX) if there is no such mesh, or the point needs a deformer and there is none"
    };
    (mien_derivatives_linearize) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if the instance is not of the rig"
    };
    (mien_derivatives_forward) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `from` has no effect on `to` or nothing was linearized\n\
         - [`Status::INDEX`](crate::Status::INDEX) if a point lacks its deformer or mesh"
    };
    (mien_derivatives_reverse) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `from` has no effect on `to` or nothing was linearized\n\
         - [`Status::INDEX`](crate::Status::INDEX) if a point lacks its deformer or mesh"
    };
    (mien_jacobian_create) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `from_point` has no effect on `to_point` or the outputs do not ascend\n\
         - [`Status::INDEX`](crate::Status::INDEX) if a point lacks its deformer or mesh, or an input or output does not exist\n\
         - [`Status::LOD`](crate::Status::LOD) if the rig has no such LOD\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out"
    };
    (mien_jacobian_pattern) => {
        "- none with valid arguments"
    };
    (mien_derivatives_jacobian) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if nothing was linearized, `value_count` is not the number of entries, or `wanted_count` not that of columns (0 if `wanted` is NULL)\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if the matrix was created for another rig or deformer, or the values were linearized at another LOD"
    };
    (mien_bake_file) => {
        "- [`Status::MISMATCH`](crate::Status::MISMATCH) if `deformer` was created for another rig\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator of the rig returns NULL\n\
         - [`Status::FILE_WRITE`](crate::Status::FILE_WRITE) if the file cannot be written"
    };
    (mien_bake_memory) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if `deformer` was created for another rig"
    };
    (mien_baked_open_file) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::FILE_OPEN`](crate::Status::FILE_OPEN) if the file cannot be read\n\
         - [`Status::FILE_READ`](crate::Status::FILE_READ) if the file cannot be read\n\
         - [`Status::BAKED_SIGNATURE`](crate::Status::BAKED_SIGNATURE) if its header is not valid\n\
         - [`Status::BAKED_VERSION`](crate::Status::BAKED_VERSION) if its header is not valid\n\
         - [`Status::BAKED_TRUNCATED`](crate::Status::BAKED_TRUNCATED) if its header is not valid\n\
         - [`Status::BAKED_STRUCTURE`](crate::Status::BAKED_STRUCTURE) if its header is not valid\n\
         - [`Status::BAKED_CHECKSUM`](crate::Status::BAKED_CHECKSUM) if `BakedCheck::FULL` finds changed bytes"
    };
    (mien_baked_open_memory) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::BAKED_SIGNATURE`](crate::Status::BAKED_SIGNATURE) if its header is not valid\n\
         - [`Status::BAKED_VERSION`](crate::Status::BAKED_VERSION) if its header is not valid\n\
         - [`Status::BAKED_TRUNCATED`](crate::Status::BAKED_TRUNCATED) if its header is not valid\n\
         - [`Status::BAKED_STRUCTURE`](crate::Status::BAKED_STRUCTURE) if its header is not valid\n\
         - [`Status::BAKED_CHECKSUM`](crate::Status::BAKED_CHECKSUM) if `BakedCheck::FULL` finds changed bytes"
    };
    (mien_baked_open_stream) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::FILE_READ`](crate::Status::FILE_READ) if the file cannot be read\n\
         - [`Status::BAKED_SIGNATURE`](crate::Status::BAKED_SIGNATURE) if its header is not valid\n\
         - [`Status::BAKED_VERSION`](crate::Status::BAKED_VERSION) if its header is not valid\n\
         - [`Status::BAKED_TRUNCATED`](crate::Status::BAKED_TRUNCATED) if its header is not valid\n\
         - [`Status::BAKED_STRUCTURE`](crate::Status::BAKED_STRUCTURE) if its header is not valid\n\
         - [`Status::BAKED_CHECKSUM`](crate::Status::BAKED_CHECKSUM) if `BakedCheck::FULL` finds changed bytes"
    };
    (mien_baked_info) => {
        "- none with valid arguments"
    };
    (mien_rig_from_baked) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::ISA`](crate::Status::ISA) if the requested instruction set is not available\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::BAKED_VERSION`](crate::Status::BAKED_VERSION) if its rig cannot be used\n\
         - [`Status::BAKED_STRUCTURE`](crate::Status::BAKED_STRUCTURE) if its rig cannot be used\n\
         - [`Status::BAKED_PART`](crate::Status::BAKED_PART) if the file has no rig"
    };
    (mien_deformer_from_baked) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if `rig` was not created from `baked`\n\
         - [`Status::ISA`](crate::Status::ISA) if the requested instruction set is not available\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::BAKED_VERSION`](crate::Status::BAKED_VERSION) if its deformer cannot be used\n\
         - [`Status::BAKED_STRUCTURE`](crate::Status::BAKED_STRUCTURE) if its deformer cannot be used\n\
         - [`Status::BAKED_PART`](crate::Status::BAKED_PART) if the file has no deformer"
    };
    (mien_clip_build) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::NAME`](crate::Status::NAME) if a name is empty or occurs twice\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::CLIP_VALUE`](crate::Status::CLIP_VALUE) if a value is not finite (the message names frame and channel)\n\
         - [`Status::CLIP_LIMIT`](crate::Status::CLIP_LIMIT) if there are too many frames, channels or bytes"
    };
    (mien_clip_open_file) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::FILE_OPEN`](crate::Status::FILE_OPEN) if the file cannot be read\n\
         - [`Status::FILE_READ`](crate::Status::FILE_READ) if the file cannot be read\n\
         - [`Status::CLIP_SIGNATURE`](crate::Status::CLIP_SIGNATURE) if it is not a valid clip\n\
         - [`Status::CLIP_VERSION`](crate::Status::CLIP_VERSION) if it is not a valid clip\n\
         - [`Status::CLIP_TRUNCATED`](crate::Status::CLIP_TRUNCATED) if it is not a valid clip\n\
         - [`Status::CLIP_STRUCTURE`](crate::Status::CLIP_STRUCTURE) if it is not a valid clip"
    };
    (mien_clip_open_memory) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::CLIP_SIGNATURE`](crate::Status::CLIP_SIGNATURE) if it is not a valid clip\n\
         - [`Status::CLIP_VERSION`](crate::Status::CLIP_VERSION) if it is not a valid clip\n\
         - [`Status::CLIP_TRUNCATED`](crate::Status::CLIP_TRUNCATED) if it is not a valid clip\n\
         - [`Status::CLIP_STRUCTURE`](crate::Status::CLIP_STRUCTURE) if it is not a valid clip"
    };
    (mien_clip_open_stream) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::FILE_READ`](crate::Status::FILE_READ) if the file cannot be read\n\
         - [`Status::CLIP_SIGNATURE`](crate::Status::CLIP_SIGNATURE) if it is not a valid clip\n\
         - [`Status::CLIP_VERSION`](crate::Status::CLIP_VERSION) if it is not a valid clip\n\
         - [`Status::CLIP_TRUNCATED`](crate::Status::CLIP_TRUNCATED) if it is not a valid clip\n\
         - [`Status::CLIP_STRUCTURE`](crate::Status::CLIP_STRUCTURE) if it is not a valid clip"
    };
    (mien_clip_write_file) => {
        "- [`Status::MEMORY`](crate::Status::MEMORY) if the allocator of the clip returns NULL\n\
         - [`Status::FILE_WRITE`](crate::Status::FILE_WRITE) if the file cannot be written"
    };
    (mien_clip_write_memory) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range"
    };
    (mien_clip_info) => {
        "- none with valid arguments"
    };
    (mien_clip_channel) => {
        "- [`Status::INDEX`](crate::Status::INDEX) if `index` is out of range"
    };
    (mien_clip_find_channel) => {
        "- [`Status::NAME`](crate::Status::NAME) if there is none"
    };
    (mien_clip_find_channel_n) => {
        "- [`Status::NAME`](crate::Status::NAME) if there is none"
    };
    (mien_clip_event) => {
        "- [`Status::INDEX`](crate::Status::INDEX) if `index` is out of range"
    };
    (mien_clip_verify) => {
        "- [`Status::CLIP_STRUCTURE`](crate::Status::CLIP_STRUCTURE) if a curve cannot be decoded\n\
         - [`Status::CLIP_CHECKSUM`](crate::Status::CLIP_CHECKSUM) if bytes have changed"
    };
    (mien_clip_read) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `frame_stride` is too small\n\
         - [`Status::INDEX`](crate::Status::INDEX) if the clip has fewer frames\n\
         - [`Status::CLIP_STRUCTURE`](crate::Status::CLIP_STRUCTURE) if a curve is damaged; its block in `out_values` is zero"
    };
    (mien_clip_player_create) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out"
    };
    (mien_clip_player_info) => {
        "- none with valid arguments"
    };
    (mien_clip_player_seek) => {
        "- none with valid arguments"
    };
    (mien_clip_player_set_speed) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if it is outside the range of MienClipPlayerDesc"
    };
    (mien_clip_player_advance) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `ticks` is out of range"
    };
    (mien_clip_player_next_event) => {
        "- none with valid arguments"
    };
    (mien_clip_player_sample) => {
        "- none with valid arguments"
    };
    (mien_clip_binding_create) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if a weight is not finite\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::CLIP_LIMIT`](crate::Status::CLIP_LIMIT) if channels drive more than 4095 GUI controls"
    };
    (mien_arkit_matrix) => {
        "- none with valid arguments"
    };
    (mien_clip_binding_info) => {
        "- none with valid arguments"
    };
    (mien_clip_binding_apply) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if a count differs from that of the clip or the rig"
    };
    (mien_clip_binding_snaps) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `tolerance` is not a number above 0\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if `channel_count` is not that of the binding, or the binding is for another rig\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if that returns NULL"
    };
    (mien_mix_create) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if a field of `desc` is out of range; the message names it\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if the deformer or the gaze is for another rig\n\
         - [`Status::INDEX`](crate::Status::INDEX) if a landmark names a mesh, position or joint that does not exist\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if guards are measured and raw controls times joints exceed 2^22"
    };
    (mien_mix_open_file) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::NAME`](crate::Status::NAME) if the rig lacks controls; the message names them\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::FILE_OPEN`](crate::Status::FILE_OPEN) if the file cannot be read\n\
         - [`Status::FILE_READ`](crate::Status::FILE_READ) if the file cannot be read\n\
         - [`Status::MIX_SIGNATURE`](crate::Status::MIX_SIGNATURE) if it is not a valid mix\n\
         - [`Status::MIX_VERSION`](crate::Status::MIX_VERSION) if it is not a valid mix\n\
         - [`Status::MIX_TRUNCATED`](crate::Status::MIX_TRUNCATED) if it is not a valid mix\n\
         - [`Status::MIX_STRUCTURE`](crate::Status::MIX_STRUCTURE) if it is not a valid mix\n\
         - [`Status::MIX_CHECKSUM`](crate::Status::MIX_CHECKSUM) if it is not a valid mix"
    };
    (mien_mix_open_memory) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::NAME`](crate::Status::NAME) if the rig lacks controls; the message names them\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::MIX_SIGNATURE`](crate::Status::MIX_SIGNATURE) if it is not a valid mix\n\
         - [`Status::MIX_VERSION`](crate::Status::MIX_VERSION) if it is not a valid mix\n\
         - [`Status::MIX_TRUNCATED`](crate::Status::MIX_TRUNCATED) if it is not a valid mix\n\
         - [`Status::MIX_STRUCTURE`](crate::Status::MIX_STRUCTURE) if it is not a valid mix\n\
         - [`Status::MIX_CHECKSUM`](crate::Status::MIX_CHECKSUM) if it is not a valid mix"
    };
    (mien_mix_write_file) => {
        "- [`Status::NAME`](crate::Status::NAME) if two of these controls have the same name\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if that returns NULL\n\
         - [`Status::FILE_WRITE`](crate::Status::FILE_WRITE) if the file cannot be written"
    };
    (mien_mix_write_memory) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::NAME`](crate::Status::NAME) if `mien_mix_write_file()` would fail with them\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out"
    };
    (mien_mix_write_text) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::NAME`](crate::Status::NAME) if `mien_mix_write_file()` would fail with them\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out"
    };
    (mien_mix_info) => {
        "- none with valid arguments"
    };
    (mien_mix_guard) => {
        "- [`Status::INDEX`](crate::Status::INDEX) if there is no such guard"
    };
    (mien_mix_glare) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `stroke_count` is less than 5"
    };
    (mien_mix_antagonists) => {
        "- none with valid arguments"
    };
    (mien_mix_mirror) => {
        "- [`Status::MISMATCH`](crate::Status::MISMATCH) if `curve_count` is less than the raw controls\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if that returns NULL\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if raw controls times joints exceed 2^22"
    };
    (mien_mix_mask) => {
        "- [`Status::MISMATCH`](crate::Status::MISMATCH) if `curve_count` is less than the raw controls\n\
         - [`Status::INDEX`](crate::Status::INDEX) if a group does not exist\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if that returns NULL"
    };
    (mien_gaze_create) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if no raw control turns an eye monotonically in one of the four directions\n\
         - [`Status::NAME`](crate::Status::NAME) if there are no such joints\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out"
    };
    (mien_gaze_info) => {
        "- none with valid arguments"
    };
    (mien_gaze_look_at) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the target is not finite\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if `row_count` is less than the raw controls"
    };
    (mien_mixer_create) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out"
    };
    (mien_mixer_play) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if a time, speed or enum value is out of range or a delta clip would play in a layer that overrides\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if the binding is for another clip or rig\n\
         - [`Status::INDEX`](crate::Status::INDEX) if the layer does not exist or has another source\n\
         - [`Status::CLIP_LIMIT`](crate::Status::CLIP_LIMIT) if the clip is larger than the mix allows"
    };
    (mien_mixer_stop) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::INDEX`](crate::Status::INDEX) if the layer does not exist or is not a clip layer"
    };
    (mien_mixer_set_weight) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::INDEX`](crate::Status::INDEX) if the layer does not exist"
    };
    (mien_mixer_set_pose_weight) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::INDEX`](crate::Status::INDEX) if the layer or its pose does not exist"
    };
    (mien_mixer_set_variable) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the value is not finite\n\
         - [`Status::INDEX`](crate::Status::INDEX) if it does not exist"
    };
    (mien_mixer_set_guard) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `activation` is above 1 or not a number\n\
         - [`Status::INDEX`](crate::Status::INDEX) if the guard does not exist"
    };
    (mien_mixer_guard) => {
        "- [`Status::INDEX`](crate::Status::INDEX) if the guard does not exist"
    };
    (mien_mixer_trigger) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if strength or time is out of range\n\
         - [`Status::INDEX`](crate::Status::INDEX) if the reaction does not exist"
    };
    (mien_mixer_release) => {
        "- [`Status::INDEX`](crate::Status::INDEX) if the reaction does not exist"
    };
    (mien_mixer_set_level) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if it has no `level_on` or `level` is out of range\n\
         - [`Status::INDEX`](crate::Status::INDEX) if the reaction does not exist"
    };
    (mien_mixer_push) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if a value is not finite or `tick` is 2^61 or more\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if it has another number of channels\n\
         - [`Status::INDEX`](crate::Status::INDEX) if the layer does not exist or is not a stream"
    };
    (mien_mixer_step) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `ticks` is out of range or the time would exceed 2^60 ticks (51 years)\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if the instance has another number of raw controls"
    };
    (mien_mixer_step_batch) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `ticks` is out of range or the time would exceed 2^60 ticks (51 years); or a mixer is listed twice\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if the instance has another number of raw controls"
    };
    (mien_mixer_row) => {
        "- none with valid arguments"
    };
    (mien_mixer_stage) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if MienMixerDesc.stages was 0. Contents change with `mien_mixer_step()` and `mien_mixer_step_batch()`\n\
         - [`Status::INDEX`](crate::Status::INDEX) if the stage does not exist"
    };
    (mien_mixer_info) => {
        "- none with valid arguments"
    };
    (mien_mixer_event) => {
        "- [`Status::INDEX`](crate::Status::INDEX) if `index` is out of range"
    };
    (mien_mixer_snapshot) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range"
    };
    (mien_mixer_restore) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the bytes are not a snapshot of this mix\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if a clip is missing or is not the one that was playing"
    };
    (mien_solver_stack_create) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if a number is out of range, or if a solver reads a joint that a later one moves; the message names both\n\
         - [`Status::INDEX`](crate::Status::INDEX) if a joint or curve does not exist\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out"
    };
    (mien_solver_stack_info) => {
        "- none with valid arguments"
    };
    (mien_solver_state_create) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out"
    };
    (mien_solver_state_step) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `ticks` or the LOD is out of range\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if instance and stack have different deformers or the row is shorter than MienSolverStackDesc.`curve_count`"
    };
    (mien_solver_state_step_batch) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `ticks` or the LOD is out of range\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if instance and stack have different deformers or the row is shorter than MienSolverStackDesc.`curve_count`; or the states have different stacks"
    };
    (mien_solver_state_outputs) => {
        "- [`Status::INDEX`](crate::Status::INDEX) if the solver does not exist"
    };
    (mien_solver_state_transforms) => {
        "- none with valid arguments"
    };
    (mien_solver_state_undeclared) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if MienSolverStackDesc.`check_writes` was 0"
    };
    (mien_rig_match) => {
        "- [`Status::NAME`](crate::Status::NAME) if the name matches no control of this rig, or several in step 1 or 2"
    };
    (mien_control_name) => {
        "- [`Status::NAME`](crate::Status::NAME) if the name is not in the table"
    };
    (mien_dna_generate) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only"
    };
    (mien_author_rig) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the file would be too large\n\
         - [`Status::AUTHOR_MESH`](crate::Status::AUTHOR_MESH) if the arrays of the mesh or of the caller's results contradict each other\n\
         - [`Status::AUTHOR_REFUSED`](crate::Status::AUTHOR_REFUSED) if the mesh cannot be rigged or landmarks contradict it\n\
         - [`Status::AUTHOR_CANCELED`](crate::Status::AUTHOR_CANCELED) if `progress` canceled"
    };
    (mien_author_report_json) => {
        "- none with valid arguments"
    };
    (mien_document_create) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the loaded part would not open by itself\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the loaded part would not open by itself\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if it exceeds 4 GiB\n\
         - [`Status::DNA_LAYER`](crate::Status::DNA_LAYER) if `dna` has RBF behavior without the machine-learned behavior of its file\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the loaded part would not open by itself"
    };
    (mien_document_open_file) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::FILE_OPEN`](crate::Status::FILE_OPEN) if the file cannot be read\n\
         - [`Status::FILE_READ`](crate::Status::FILE_READ) if the file cannot be read\n\
         - [`Status::DNA_SIGNATURE`](crate::Status::DNA_SIGNATURE) if it is not a DNA file of generation 2\n\
         - [`Status::DNA_VERSION`](crate::Status::DNA_VERSION) if it is not a DNA file of generation 2\n\
         - [`Status::DNA_TRUNCATED`](crate::Status::DNA_TRUNCATED) if its contents are not valid or cannot be converted to the requested system\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if its contents are not valid or cannot be converted to the requested system\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if its contents are not valid or cannot be converted to the requested system\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if its contents are not valid or cannot be converted to the requested system\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if its contents are not valid or cannot be converted to the requested system"
    };
    (mien_document_field) => {
        "- [`Status::INDEX`](crate::Status::INDEX) if an index in the path is past the end\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such field"
    };
    (mien_document_child_name) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the field is not a record\n\
         - [`Status::INDEX`](crate::Status::INDEX) if `index` or an index in the path is past the end\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such field"
    };
    (mien_document_read_floats) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the field does not hold numbers of this kind\n\
         - [`Status::INDEX`](crate::Status::INDEX) if the range or an index in the path is past the end\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such field"
    };
    (mien_document_read_integers) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the field does not hold numbers of this kind\n\
         - [`Status::INDEX`](crate::Status::INDEX) if the range or an index in the path is past the end\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such field"
    };
    (mien_document_read_string) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the field is not a string\n\
         - [`Status::INDEX`](crate::Status::INDEX) if an index in the path is past the end\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such field"
    };
    (mien_document_bytes) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the field is neither an array nor a string\n\
         - [`Status::INDEX`](crate::Status::INDEX) if an index in the path is past the end\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such field"
    };
    (mien_document_write_floats) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the field does not hold numbers of this kind, or none of this size\n\
         - [`Status::INDEX`](crate::Status::INDEX) if the range or an index in the path is past the end\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such field\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL"
    };
    (mien_document_write_integers) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the field does not hold numbers of this kind, or none of this size\n\
         - [`Status::INDEX`](crate::Status::INDEX) if the range or an index in the path is past the end\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such field\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL"
    };
    (mien_document_write_string) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the field is not a string, or if another element of a list of names has this name\n\
         - [`Status::INDEX`](crate::Status::INDEX) if an index in the path is past the end\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such field\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL"
    };
    (mien_document_splice) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the field is neither an array nor a list, or would have more than 2^32 - 1 elements\n\
         - [`Status::INDEX`](crate::Status::INDEX) if the range or an index in the path is past the end\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such field\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL"
    };
    (mien_document_resize) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the field is neither an array nor a list, or would have more than 2^32 - 1 elements\n\
         - [`Status::INDEX`](crate::Status::INDEX) if the range or an index in the path is past the end\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such field\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL"
    };
    (mien_document_layer_count) => {
        "- none with valid arguments"
    };
    (mien_document_layer) => {
        "- [`Status::INDEX`](crate::Status::INDEX) if `index` is past the end"
    };
    (mien_document_clear_layers) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `version` is not 1 to 65535\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL"
    };
    (mien_document_add_layer) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `code` has another length, a version is above 65535, the list has a layer of this code and version already, the kind is known and has bytes, or a file of version 2.1 cannot have it\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL"
    };
    (mien_document_mark) => {
        "- [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL"
    };
    (mien_document_undo) => {
        "- [`Status::INDEX`](crate::Status::INDEX) if `mark` is not a valid mark of the document"
    };
    (mien_document_find) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the kind has no names in a document\n\
         - [`Status::NAME`](crate::Status::NAME) if there is no such name"
    };
    (mien_document_rename) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if another element of the kind has the name, or the kind has no names in a document\n\
         - [`Status::INDEX`](crate::Status::INDEX) if there is no such element\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL"
    };
    (mien_document_remove) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the networks or the version need a control, or no joint would be left for the skin weights\n\
         - [`Status::INDEX`](crate::Status::INDEX) if an index is past the end\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the document is not valid\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the document is not valid\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the document is not valid\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the document is not valid"
    };
    (mien_document_clear) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the networks or the version need a control, or no joint would be left for the skin weights\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the document is not valid\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the document is not valid\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the document is not valid\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the document is not valid"
    };
    (mien_document_clear_joints) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the networks or the version need a control, or no joint would be left for the skin weights\n\
         - [`Status::INDEX`](crate::Status::INDEX) if an index is past the end\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the document is not valid\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the document is not valid\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the document is not valid\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the document is not valid"
    };
    (mien_document_set_neutral) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if a number is not finite\n\
         - [`Status::INDEX`](crate::Status::INDEX) if there are fewer joints\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the document is not valid\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the document is not valid\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the document is not valid\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the document is not valid"
    };
    (mien_document_set_positions) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the mesh has another number of positions, or a number is not finite\n\
         - [`Status::INDEX`](crate::Status::INDEX) if `mesh` is past the end\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL"
    };
    (mien_document_set_target) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if there are more deltas than positions, or a number is not finite\n\
         - [`Status::INDEX`](crate::Status::INDEX) if `mesh`, `channel` or a vertex is past the end\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the document is not valid\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the document is not valid\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the document is not valid\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the document is not valid"
    };
    (mien_document_prune_targets) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `tolerance` is negative or not finite\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the document is not valid\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the document is not valid\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the document is not valid\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the document is not valid"
    };
    (mien_document_prune_joints) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if a field of `desc` is negative or not finite\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the document is not valid\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the document is not valid\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the document is not valid\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the document is not valid"
    };
    (mien_document_set_weights) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if there is another number of weights, a weight is negative or not finite, a joint does not exist, or a position has a joint twice or no weight\n\
         - [`Status::INDEX`](crate::Status::INDEX) if `mesh` is past the end\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the document is not valid\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the document is not valid\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the document is not valid\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the document is not valid"
    };
    (mien_document_normalize_weights) => {
        "- [`Status::INDEX`](crate::Status::INDEX) if `mesh` is past the end\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the document is not valid\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the document is not valid\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the document is not valid\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the document is not valid"
    };
    (mien_document_limit_influences) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `influences` is 0\n\
         - [`Status::INDEX`](crate::Status::INDEX) if `mesh` is past the end\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the document is not valid\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the document is not valid\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the document is not valid\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the document is not valid"
    };
    (mien_document_smooth_weights) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `influences` is 0; or `strength` is not 0 to 1, or there are more than 1000 iterations\n\
         - [`Status::INDEX`](crate::Status::INDEX) if `mesh` is past the end\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the document is not valid\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the document is not valid\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the document is not valid\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the document is not valid"
    };
    (mien_document_place) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if a number is not finite or the scale is negative\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the document is not valid\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the document is not valid\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the document is not valid\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if a root joint is moved by controls and the rotation is not 0, networks translate joints and the scale is not 1, or the document is not valid"
    };
    (mien_document_keep_lods) => {
        "- [`Status::LOD`](crate::Status::LOD) if none of them exists\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the document is not valid\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the document is not valid\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the document is not valid\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the document is not valid"
    };
    (mien_document_convert) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the document is not valid\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the document is not valid\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the document is not valid\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the rig cannot be converted or the document is not valid"
    };
    (mien_document_copy_layers) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `layers` has other bits\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if they do not fit the other layers\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if they do not fit the other layers\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if they do not fit the other layers\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if they do not fit the other layers"
    };
    (mien_document_copy_mesh) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if both documents are the same\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if the documents differ in axes, units or rotations, or this one has no joint of a position\n\
         - [`Status::INDEX`](crate::Status::INDEX) if there is no such mesh\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if one of them is not valid\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if one of them is not valid\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if one of them is not valid\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if one of them is not valid"
    };
    (mien_document_merge_joints) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if both documents are the same\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if they differ in axes, units or rotations, or in the place of a joint\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if one of them is not valid or the result would not be\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if one of them is not valid or the result would not be\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if one of them is not valid or the result would not be\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if one of them is not valid or the result would not be"
    };
    (mien_document_split_joints) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if no joint would be left for the skin weights\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if `document` is not valid\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if `document` is not valid\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if `document` is not valid\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if `document` is not valid"
    };
    (mien_document_project) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if they are the same, or lack triangles, texture coordinates or weights\n\
         - [`Status::INDEX`](crate::Status::INDEX) if `mesh` or `source` is past the end\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the document is not valid\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the document is not valid\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the document is not valid\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the document is not valid"
    };
    (mien_document_make_lod) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the LODs are the same, or meshes lack triangles, texture coordinates or weights\n\
         - [`Status::LOD`](crate::Status::LOD) if there is no such LOD\n\
         - [`Status::NAME`](crate::Status::NAME) if a mesh has no counterpart\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the document is not valid\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the document is not valid\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the document is not valid\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the document is not valid"
    };
    (mien_document_conform) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if the mesh has another number of positions, or a number is not finite\n\
         - [`Status::INDEX`](crate::Status::INDEX) if `mesh` is past the end\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the document is not valid\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the document is not valid\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the document is not valid\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the document is not valid"
    };
    (mien_document_transplant) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if no mesh of LOD 0 has the name of one of the template, or meshes lack triangles or texture coordinates\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if the documents differ in axes, units or rotations\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if one of them is not valid\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if one of them is not valid\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if one of them is not valid\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if one of them is not valid"
    };
    (mien_document_to_dna) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only\n\
         - [`Status::DNA_TRUNCATED`](crate::Status::DNA_TRUNCATED) if the document is not a valid file; the message names the first invalid field, `mien_document_validate()` lists them all\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the document is not a valid file; the message names the first invalid field, `mien_document_validate()` lists them all\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the document is not a valid file; the message names the first invalid field, `mien_document_validate()` lists them all\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the document is not a valid file; the message names the first invalid field, `mien_document_validate()` lists them all\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the document is not a valid file; the message names the first invalid field, `mien_document_validate()` lists them all"
    };
    (mien_document_write_file) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::FILE_WRITE`](crate::Status::FILE_WRITE) if the file cannot be written\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the document is not a valid file, or would not be one in the requested version\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the document is not a valid file, or would not be one in the requested version\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the file would exceed 4 GiB\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the document is not a valid file, or would not be one in the requested version"
    };
    (mien_document_write_stream) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if the allocator returns NULL\n\
         - [`Status::FILE_WRITE`](crate::Status::FILE_WRITE) if the file cannot be written; or `sink` does not take a piece\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the document is not a valid file, or would not be one in the requested version\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the document is not a valid file, or would not be one in the requested version\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the file would exceed 4 GiB\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the document is not a valid file, or would not be one in the requested version"
    };
    (mien_document_write_memory) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::DNA_STRUCTURE`](crate::Status::DNA_STRUCTURE) if the document is not a valid file, or would not be one in the requested version\n\
         - [`Status::DNA_REFERENCE`](crate::Status::DNA_REFERENCE) if the document is not a valid file, or would not be one in the requested version\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the file would exceed 4 GiB\n\
         - [`Status::DNA_VALUE`](crate::Status::DNA_VALUE) if the document is not a valid file, or would not be one in the requested version"
    };
    (mien_document_validate) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if an argument is outside its range\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out\n\
         - [`Status::UNSUPPORTED`](crate::Status::UNSUPPORTED) if this build of libmien opens baked files only\n\
         - [`Status::DNA_LIMIT`](crate::Status::DNA_LIMIT) if the file would exceed 4 GiB"
    };
    (mien_fit_create) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if controls are not ascending, a lower bound is above its upper one, or a weight is not finite\n\
         - [`Status::MISMATCH`](crate::Status::MISMATCH) if the deformer belongs to another rig\n\
         - [`Status::INDEX`](crate::Status::INDEX) if a control, position or mesh does not exist\n\
         - [`Status::LOD`](crate::Status::LOD) if the rig has no such LOD\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out"
    };
    (mien_fit_surface_create) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if there are no triangles, or a coordinate is not finite\n\
         - [`Status::INDEX`](crate::Status::INDEX) if a position does not exist\n\
         - [`Status::MEMORY`](crate::Status::MEMORY) if memory runs out"
    };
    (mien_fit_solve) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if a stage is above 15, or a weight, a control, an offset or a number of the camera is not finite, or a weight is negative\n\
         - [`Status::INDEX`](crate::Status::INDEX) if a constraint has a joint or point that does not exist"
    };
    (mien_fit_solve_frames) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if a stage is above 15, or a weight, a control, an offset or a number of the camera is not finite, or a weight is negative\n\
         - [`Status::INDEX`](crate::Status::INDEX) if a constraint has a joint or point that does not exist"
    };
    (mien_fit_observability) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if `count` is another number"
    };
    (mien_fit_keys) => {
        "- [`Status::INVALID_ARGUMENT`](crate::Status::INVALID_ARGUMENT) if a value is not finite, or the tolerance is negative or not finite"
    };
}
