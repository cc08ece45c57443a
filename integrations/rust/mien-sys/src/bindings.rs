// SPDX-License-Identifier: MIT
// Code generated from integrations/api/mien_api.json by generate.py; run ./dev api. DO NOT EDIT.

use crate::{c_char, c_void, size_of, zeroed, Opaque};

/// A `MIEN_OK` or `MIEN_ERROR_...` value.
pub type MienStatus = i32;

/// One task of a MienParallelFor.
pub type MienTask = Option<unsafe extern "C" fn(context: *mut c_void, index: u32)>;

pub const MIEN_VERSION_MAJOR: u32 = 0;
pub const MIEN_VERSION_MINOR: u32 = 1;
pub const MIEN_VERSION_PATCH: u32 = 0;
pub const MIEN_VERSION: u32 = 65536;
/// A byte offset that means "none".
pub const MIEN_NO_OFFSET: u64 = 18446744073709551615;
/// Ticks per second.
pub const MIEN_TICKS_PER_SECOND: u32 = 705600000;
/// No mesh: the points of a landmark are joints.
pub const MIEN_NO_MESH: u32 = 4294967295;
/// No raw control.
pub const MIEN_NO_CONTROL: u32 = 65535;
/// Value of a joint index that means no joint.
pub const MIEN_NO_JOINT: u32 = 65535;
/// The largest number of controls that a name matches.
pub const MIEN_MOST_SHARES: u32 = 16;

// enum MienStatusCode
pub const MIEN_OK: MienStatus = 0;
/// A required pointer is NULL.
pub const MIEN_ERROR_NULL_ARGUMENT: MienStatus = 1;
/// A value out of range, or a buffer that is too small.
pub const MIEN_ERROR_INVALID_ARGUMENT: MienStatus = 2;
/// `struct_size` is too small or above 4096, or a field unknown to the library is not zero.
pub const MIEN_ERROR_STRUCT_SIZE: MienStatus = 3;
/// A handle of the wrong kind.
pub const MIEN_ERROR_HANDLE: MienStatus = 4;
/// Objects that do not belong together.
pub const MIEN_ERROR_MISMATCH: MienStatus = 5;
/// An index past the end.
pub const MIEN_ERROR_INDEX: MienStatus = 6;
/// A LOD that does not exist, or for which the object has no memory.
pub const MIEN_ERROR_LOD: MienStatus = 7;
/// No such name or path.
pub const MIEN_ERROR_NAME: MienStatus = 8;
/// An instruction set that the CPU or the build does not support.
pub const MIEN_ERROR_ISA: MienStatus = 9;
/// The allocator returned NULL.
pub const MIEN_ERROR_MEMORY: MienStatus = 10;
/// This build of the library only opens baked files, or the object is stored in a form that does
/// not have what was asked for.
pub const MIEN_ERROR_UNSUPPORTED: MienStatus = 11;
/// The file cannot be opened.
pub const MIEN_ERROR_FILE_OPEN: MienStatus = 20;
/// The file or stream cannot be read.
pub const MIEN_ERROR_FILE_READ: MienStatus = 21;
/// The file cannot be written.
pub const MIEN_ERROR_FILE_WRITE: MienStatus = 22;
/// Not a DNA file.
pub const MIEN_ERROR_DNA_SIGNATURE: MienStatus = 30;
/// A DNA file whose generation is not 2.
pub const MIEN_ERROR_DNA_VERSION: MienStatus = 31;
/// The file ends before the data that its header or counts announce.
pub const MIEN_ERROR_DNA_TRUNCATED: MienStatus = 32;
/// Offsets, sizes or counts contradict each other.
pub const MIEN_ERROR_DNA_STRUCTURE: MienStatus = 33;
/// An index that refers to nothing.
pub const MIEN_ERROR_DNA_REFERENCE: MienStatus = 34;
/// A count above the limit of the format or of Mien.
pub const MIEN_ERROR_DNA_LIMIT: MienStatus = 35;
/// A required layer is not loaded or not in the file.
pub const MIEN_ERROR_DNA_LAYER: MienStatus = 36;
/// An invalid value, or one that cannot be converted.
pub const MIEN_ERROR_DNA_VALUE: MienStatus = 37;
/// Not a baked file.
pub const MIEN_ERROR_BAKED_SIGNATURE: MienStatus = 50;
/// Baked by another version of Mien, or for the other byte order.
pub const MIEN_ERROR_BAKED_VERSION: MienStatus = 51;
/// The file is shorter than its header states.
pub const MIEN_ERROR_BAKED_TRUNCATED: MienStatus = 52;
/// Sizes, counts or indices contradict each other.
pub const MIEN_ERROR_BAKED_STRUCTURE: MienStatus = 53;
/// The file has changed since it was written.
pub const MIEN_ERROR_BAKED_CHECKSUM: MienStatus = 54;
/// The file does not contain the requested object.
pub const MIEN_ERROR_BAKED_PART: MienStatus = 55;
/// Not a clip.
pub const MIEN_ERROR_CLIP_SIGNATURE: MienStatus = 60;
/// A clip in another version of the format.
pub const MIEN_ERROR_CLIP_VERSION: MienStatus = 61;
/// The clip is shorter than its header states.
pub const MIEN_ERROR_CLIP_TRUNCATED: MienStatus = 62;
/// Sizes, counts or curves contradict each other.
pub const MIEN_ERROR_CLIP_STRUCTURE: MienStatus = 63;
/// The clip has changed since it was written.
pub const MIEN_ERROR_CLIP_CHECKSUM: MienStatus = 64;
/// A value that is not finite.
pub const MIEN_ERROR_CLIP_VALUE: MienStatus = 65;
/// More than a clip, player or binding can hold.
pub const MIEN_ERROR_CLIP_LIMIT: MienStatus = 66;
/// Not a mix.
pub const MIEN_ERROR_MIX_SIGNATURE: MienStatus = 70;
/// A mix in another version of the format.
pub const MIEN_ERROR_MIX_VERSION: MienStatus = 71;
/// The file is shorter than its header states.
pub const MIEN_ERROR_MIX_TRUNCATED: MienStatus = 72;
/// Sizes or counts contradict each other, or a value is out of range.
pub const MIEN_ERROR_MIX_STRUCTURE: MienStatus = 73;
/// The mix has changed since it was written.
pub const MIEN_ERROR_MIX_CHECKSUM: MienStatus = 74;
/// The arrays of a mesh, shape or bone contradict each other.
pub const MIEN_ERROR_AUTHOR_MESH: MienStatus = 80;
/// A mesh that cannot be rigged; the message names the rule.
pub const MIEN_ERROR_AUTHOR_REFUSED: MienStatus = 81;
/// The caller's progress function asked to stop.
pub const MIEN_ERROR_AUTHOR_CANCELED: MienStatus = 82;

// enum MienLayer
/// Only in MienDnaLayer.layer.
pub const MIEN_LAYER_UNKNOWN: u32 = 0;
pub const MIEN_LAYER_DESCRIPTOR: u32 = 1;
pub const MIEN_LAYER_DEFINITION: u32 = 2;
pub const MIEN_LAYER_BEHAVIOR: u32 = 4;
pub const MIEN_LAYER_GEOMETRY: u32 = 8;
pub const MIEN_LAYER_MACHINE_LEARNED_BEHAVIOR: u32 = 16;
pub const MIEN_LAYER_RBF_BEHAVIOR: u32 = 32;
pub const MIEN_LAYER_JOINT_BEHAVIOR_METADATA: u32 = 64;
pub const MIEN_LAYER_TWIST_SWING_BEHAVIOR: u32 = 128;
pub const MIEN_LAYER_ALL: u32 = 255;

// enum MienUnknownLayers
/// Keep their bytes and write them back unchanged.
pub const MIEN_UNKNOWN_LAYERS_KEEP: u32 = 0;
pub const MIEN_UNKNOWN_LAYERS_DROP: u32 = 1;

// enum MienFileAccess
/// Map the file; read it into memory if it cannot be mapped, such as a pipe.
pub const MIEN_FILE_MAP: u32 = 0;
/// Read the whole file into memory: safe even if it is truncated later.
pub const MIEN_FILE_READ: u32 = 1;

// enum MienTranslationUnit
pub const MIEN_TRANSLATION_UNIT_CENTIMETERS: u32 = 0;
pub const MIEN_TRANSLATION_UNIT_METERS: u32 = 1;

// enum MienRotationUnit
pub const MIEN_ROTATION_UNIT_DEGREES: u32 = 0;
pub const MIEN_ROTATION_UNIT_RADIANS: u32 = 1;

// enum MienDirection
pub const MIEN_DIRECTION_LEFT: u32 = 0;
pub const MIEN_DIRECTION_RIGHT: u32 = 1;
pub const MIEN_DIRECTION_UP: u32 = 2;
pub const MIEN_DIRECTION_DOWN: u32 = 3;
pub const MIEN_DIRECTION_FRONT: u32 = 4;
pub const MIEN_DIRECTION_BACK: u32 = 5;

// enum MienRotationSequence
/// X first, then y, then z, about fixed axes.
pub const MIEN_ROTATION_SEQUENCE_XYZ: u32 = 0;
pub const MIEN_ROTATION_SEQUENCE_XZY: u32 = 1;
pub const MIEN_ROTATION_SEQUENCE_YXZ: u32 = 2;
pub const MIEN_ROTATION_SEQUENCE_YZX: u32 = 3;
pub const MIEN_ROTATION_SEQUENCE_ZXY: u32 = 4;
pub const MIEN_ROTATION_SEQUENCE_ZYX: u32 = 5;

// enum MienFaceWinding
/// Seen from outside: counter-clockwise with right-handed axes, clockwise with left-handed axes.
pub const MIEN_FACE_WINDING_OUTWARD: u32 = 0;
pub const MIEN_FACE_WINDING_INWARD: u32 = 1;

// enum MienRotationRule
/// Keep the sequence of the file and rename its axes: if x and z are exchanged, xyz becomes zyx,
/// xzy becomes zxy, and so on.
pub const MIEN_ROTATION_RULE_CARRIED: u32 = 0;
/// The requested sequence. Neutral poses, quaternion joints, twists, swings, ML joints and joints
/// that rotate about one axis only are converted exactly; rigs with other joints are rejected with
/// `MIEN_ERROR_DNA_VALUE`.
pub const MIEN_ROTATION_RULE_EXACT: u32 = 1;
/// The requested sequence, converting each column of the joint matrix separately: exact if one
/// control is 1 and all others are 0, otherwise an approximation for small angles.
pub const MIEN_ROTATION_RULE_PER_COLUMN: u32 = 2;

// enum MienFieldType
/// Named fields.
pub const MIEN_FIELD_RECORD: u32 = 0;
/// Records, strings or arrays; element i is at the path of the list + \[i\].
pub const MIEN_FIELD_LIST: u32 = 1;
pub const MIEN_FIELD_STRING: u32 = 2;
/// Numbers: one, or an array.
pub const MIEN_FIELD_U8: u32 = 3;
pub const MIEN_FIELD_U16: u32 = 4;
pub const MIEN_FIELD_U32: u32 = 5;
pub const MIEN_FIELD_I32: u32 = 6;
pub const MIEN_FIELD_F32: u32 = 7;

// enum MienSeverity
/// Opening the file or `mien_rig_create()` fails because of this.
pub const MIEN_SEVERITY_ERROR: u32 = 0;
/// Allowed, but probably a mistake.
pub const MIEN_SEVERITY_WARNING: u32 = 1;

// enum MienIsa
/// The best one that the CPU, the operating system and the build support.
pub const MIEN_ISA_BEST: u32 = 0;
pub const MIEN_ISA_SCALAR: u32 = 1;
pub const MIEN_ISA_SSE2: u32 = 2;
/// With FMA and F16C.
pub const MIEN_ISA_AVX2: u32 = 3;
/// F, CD, DQ, BW and VL.
pub const MIEN_ISA_AVX512: u32 = 4;
pub const MIEN_ISA_NEON: u32 = 5;
/// The one named by the environment variable `MIEN_ISA` ("scalar", "sse2", ...); the best one if
/// it is unset or empty.
pub const MIEN_ISA_ENVIRONMENT: u32 = 1000;

// enum MienRotationOutput
/// 9 values per joint: tx ty tz rx ry rz sx sy sz.
pub const MIEN_ROTATION_OUTPUT_EULER: u32 = 0;
/// 10 values per joint: tx ty tz qx qy qz qw sx sy sz.
pub const MIEN_ROTATION_OUTPUT_QUATERNION: u32 = 1;

// enum MienMlMasks
/// 0: the outputs of the networks get their default (0, or 1 for the w of a quaternion). Other
/// values: the networks are evaluated. This is the behavior that DNA files are authored for.
pub const MIEN_ML_MASKS_SWITCH: u32 = 0;
/// Outputs are blended with their default by the mask, clamped to 0..1.
pub const MIEN_ML_MASKS_BLEND: u32 = 1;

// enum MienStorage
pub const MIEN_STORAGE_32_BIT: u32 = 0;
/// Half the memory. Network weights and columns of quaternion joints are IEEE half floats (rounded
/// to nearest even, at most 65504 in magnitude); the joint matrix is 16-bit fixed point, in units
/// of 1/32767 of the largest entry of the row.
pub const MIEN_STORAGE_16_BIT: u32 = 1;

// enum MienArithmetic
/// AVX2, AVX-512 and NEON, which fuse multiply and add, agree with each other; scalar and SSE2
/// agree with each other.
pub const MIEN_ARITHMETIC_FAST: u32 = 0;
/// All agree, because nothing is fused. A baked rig gives the same bits on every machine; a rig
/// created from a DNA file does if the C libraries compute the same sines.
pub const MIEN_ARITHMETIC_PORTABLE: u32 = 1;

// enum MienReuse
/// Results whose inputs have not changed: joint groups, and other stages as a whole.
pub const MIEN_REUSE_UNCHANGED: u32 = 0;
/// Compute everything in each evaluation, for measurements.
pub const MIEN_REUSE_NOTHING: u32 = 1;
/// Also the sums of the joint matrix: where few controls changed, only their differences are
/// added, so such a frame costs little even if these controls move joints everywhere. Joint values
/// then depend on earlier frames: they differ from those of a full evaluation by at most (n +
/// 1539) \* 2^-23 \* M, before rotations are made from them. n is the number of controls that are
/// not 0, M the sum of the magnitudes of the products that a joint value is the sum of; both are
/// the largest since all sums were last computed, which happens after a reset, after a change of
/// LOD and before 1536 differences were added. Everything else is bit-identical. Rigs and
/// instances take more memory: MienRigInfo.`rig_bytes`, .`instance_bytes`.
pub const MIEN_REUSE_SUMS: u32 = 2;

// enum MienKind
pub const MIEN_KIND_GUI_CONTROL: u32 = 0;
pub const MIEN_KIND_RAW_CONTROL: u32 = 1;
/// Correctives; unnamed in DNA files, here "psd0", "psd1", ...
pub const MIEN_KIND_PSD_CONTROL: u32 = 2;
pub const MIEN_KIND_ML_CONTROL: u32 = 3;
pub const MIEN_KIND_RBF_CONTROL: u32 = 4;
pub const MIEN_KIND_JOINT: u32 = 5;
pub const MIEN_KIND_BLEND_SHAPE_CHANNEL: u32 = 6;
pub const MIEN_KIND_ANIMATED_MAP: u32 = 7;
pub const MIEN_KIND_MESH: u32 = 8;
/// Region masks, one per region of each mesh: "mesh/region".
pub const MIEN_KIND_ML_MASK: u32 = 9;
/// Without names.
pub const MIEN_KIND_JOINT_GROUP: u32 = 10;
/// Without names.
pub const MIEN_KIND_RBF_SOLVER: u32 = 11;
/// Without names: a swing and the twists with the same inputs, or a twist alone.
pub const MIEN_KIND_TWIST_SWING: u32 = 12;

// enum MienStage
/// Neural networks.
pub const MIEN_STAGE_ML: u32 = 1;
/// RBF solvers.
pub const MIEN_STAGE_RBF: u32 = 2;
/// correctives.
pub const MIEN_STAGE_PSD: u32 = 4;
/// Joint groups, then twists and swings, then ML joints.
pub const MIEN_STAGE_JOINTS: u32 = 8;
pub const MIEN_STAGE_BLEND_SHAPES: u32 = 16;
pub const MIEN_STAGE_ANIMATED_MAPS: u32 = 32;
pub const MIEN_STAGE_ALL: u32 = 63;

// enum MienCompose
/// Neutral rotation \* delta rotation: the delta rotates first.
pub const MIEN_COMPOSE_PRODUCT: u32 = 0;
/// The angles are added; requires `MIEN_ROTATION_OUTPUT_EULER`. Equals the product where the
/// neutral rotation is zero.
pub const MIEN_COMPOSE_EULER_ADD: u32 = 1;

// enum MienWeights
pub const MIEN_WEIGHTS_AS_STORED: u32 = 0;
/// Drop negative weights and divide the others by their sum.
pub const MIEN_WEIGHTS_FIX: u32 = 1;

// enum MienNormals
/// As MienDeformerDesc.normals says; in that field: recomputed.
pub const MIEN_NORMALS_DEFAULT: u32 = 0;
/// Leave normals unchanged.
pub const MIEN_NORMALS_NONE: u32 = 1;
/// Neutral normals rotated by the skinning, correct for any scale; blend shape targets have no
/// effect.
pub const MIEN_NORMALS_SKINNED: u32 = 2;
/// The area-weighted mean of the normals of the faces around the position. On hard edges, where
/// this differs from the stored normal by more than 30 degrees in the neutral pose, the stored
/// normal is rotated by the rotation of this mean from the neutral pose.
pub const MIEN_NORMALS_RECOMPUTED: u32 = 3;

// enum MienVertexFormat
/// 12 bytes: x y z.
pub const MIEN_VERTEX_FORMAT_FLOAT32X3: u32 = 0;
/// 16 bytes: x y z w.
pub const MIEN_VERTEX_FORMAT_FLOAT32X4: u32 = 1;
/// 8 bytes: x y z w, 16 bits each.
pub const MIEN_VERTEX_FORMAT_SNORM16X4: u32 = 2;
/// 4 bytes, one 32-bit word: x in bits 0-9, y in bits 10-19, z in bits 20-29, w in bits 30-31.
pub const MIEN_VERTEX_FORMAT_SNORM10_10_10_2: u32 = 3;

// enum MienPoint
/// GUI controls.
pub const MIEN_POINT_GUI: u32 = 0;
/// Raw controls.
pub const MIEN_POINT_RAW: u32 = 1;
/// All controls: `mien_instance_controls()`.
pub const MIEN_POINT_CONTROLS: u32 = 2;
/// Joint values: `mien_instance_joints()`.
pub const MIEN_POINT_JOINTS: u32 = 3;
/// 16 floats per joint: matrix relative to the parent, four columns.
pub const MIEN_POINT_LOCALS: u32 = 4;
/// The same, in model space: `mien_deformer_instance_joint_matrices()`.
pub const MIEN_POINT_MODELS: u32 = 5;
/// The same, of skin matrices: `mien_deformer_instance_skin_matrices()`.
pub const MIEN_POINT_SKINS: u32 = 6;
/// X y z per position of a mesh, in the order of the file.
pub const MIEN_POINT_POSITIONS: u32 = 7;
/// Blend shape channel weights.
pub const MIEN_POINT_CHANNELS: u32 = 8;
/// Animated map weights.
pub const MIEN_POINT_MAPS: u32 = 9;

// enum MienBakedCheck
/// All sizes, counts and indices, so that no access is out of bounds whatever the bytes are.
/// Floats are not checked, so their pages are read from disk only when first used.
pub const MIEN_BAKED_CHECK_SAFE: u32 = 0;
/// Also the checksum of all bytes, which reads the whole file.
pub const MIEN_BAKED_CHECK_FULL: u32 = 1;

// enum MienLooping
/// A clip: `MIEN_LOOPING_CLAMP`; a player: the setting of its clip.
pub const MIEN_LOOPING_DEFAULT: u32 = 0;
/// Holds the last frame; the length is (frames - 1) \* ticks per frame.
pub const MIEN_LOOPING_CLAMP: u32 = 1;
/// Starts over; the length is frames \* ticks per frame.
pub const MIEN_LOOPING_WRAP: u32 = 2;

// enum MienInterpolation
pub const MIEN_INTERPOLATION_LINEAR: u32 = 0;
/// The value of the earlier frame.
pub const MIEN_INTERPOLATION_STEP: u32 = 1;
/// A Catmull-Rom spline, clamped to that range.
pub const MIEN_INTERPOLATION_CATMULL_ROM: u32 = 2;

// enum MienLayerGroup
pub const MIEN_LAYER_GROUP_BASE: u32 = 0;
pub const MIEN_LAYER_GROUP_SPEECH: u32 = 1;
pub const MIEN_LAYER_GROUP_EMOTION: u32 = 2;
pub const MIEN_LAYER_GROUP_REACTION: u32 = 3;
/// Acts after the reactions if no layer of another group follows.
pub const MIEN_LAYER_GROUP_LIFE: u32 = 4;

// enum MienBlendMode
/// O + a (x - o).
pub const MIEN_BLEND_MODE_OVERRIDE: u32 = 0;
/// O + a x.
pub const MIEN_BLEND_MODE_ADD: u32 = 1;
/// O + a x (1 - p), or o + a x p if x \< 0; p is o clamped to 0..1.
pub const MIEN_BLEND_MODE_SCREEN: u32 = 2;
/// O + a max(0, x - o).
pub const MIEN_BLEND_MODE_MAX: u32 = 3;
/// O (1 + a (x - 1)).
pub const MIEN_BLEND_MODE_SCALE: u32 = 4;

// enum MienLayerSource
/// `mien_mixer_play()`.
pub const MIEN_LAYER_SOURCE_CLIP: u32 = 0;
/// A weighted sum: `mien_mixer_set_pose_weight()`.
pub const MIEN_LAYER_SOURCE_POSES: u32 = 1;
/// `mien_mixer_push()`.
pub const MIEN_LAYER_SOURCE_STREAM: u32 = 2;
/// `MIEN_GENERATOR_...`
pub const MIEN_LAYER_SOURCE_GENERATOR: u32 = 3;

// enum MienGenerator
/// Blinks every `period` on average, at least 0.5 s apart. The wait starts over when earlier
/// layers raise the first curve above 0.6.
pub const MIEN_GENERATOR_BLINK: u32 = 0;
/// Rises from 0 to 1 in 40 % of the period, then falls back to 0.
pub const MIEN_GENERATOR_BREATH: u32 = 1;
/// Smooth noise between -1 and 1 with a new random value every period.
pub const MIEN_GENERATOR_NOISE: u32 = 2;
/// Turns the eyes to a target with saccades, by MienMixDesc.gaze. `curves` are three curves with
/// the left, up and front of a MienGazeTarget, read after the earlier layers, then optionally two
/// curves that get the part left for the head (MienGazeRest). `amounts` are fixation jitter
/// sideways and up in degrees, 0, and factors for the two head curves. Shifts of 20 degrees or
/// more make the blink layers of the mix blink.
pub const MIEN_GENERATOR_GAZE: u32 = 3;

// enum MienRetrigger
/// Extends the stimulus; strokes that are releasing or over start again.
pub const MIEN_RETRIGGER_EXTEND: u32 = 0;
/// All strokes start again, at most once per cooldown.
pub const MIEN_RETRIGGER_RESTART: u32 = 1;
pub const MIEN_RETRIGGER_IGNORE: u32 = 2;

// enum MienGuard
/// Between the lips, left, center and right, and from lower lip to upper teeth.
pub const MIEN_GUARD_LIPS: u32 = 1;
/// Between the lids.
pub const MIEN_GUARD_LIDS: u32 = 2;
/// Between the teeth.
pub const MIEN_GUARD_TEETH: u32 = 4;
pub const MIEN_GUARD_ALL: u32 = 7;

// enum MienTransition
/// The old clip stops; each curve blends from its last value and speed.
pub const MIEN_TRANSITION_INERTIAL: u32 = 0;
/// Both clips play; `MIEN_TRANSITION_INERTIAL` if no player is free.
pub const MIEN_TRANSITION_CROSSFADE: u32 = 1;
/// Immediate; `transition_ticks` is not used.
pub const MIEN_TRANSITION_CUT: u32 = 2;

// enum MienNameMatch
pub const MIEN_NAME_MATCH_NONE: u32 = 0;
/// The control has this name.
pub const MIEN_NAME_MATCH_AS_WRITTEN: u32 = 1;
/// The same letters and side.
pub const MIEN_NAME_MATCH_SPELLING: u32 = 2;
/// Another word for the same control.
pub const MIEN_NAME_MATCH_ALIAS: u32 = 3;
/// The controls of the left and the right side.
pub const MIEN_NAME_MATCH_BOTH_SIDES: u32 = 4;
/// An expression of several controls.
pub const MIEN_NAME_MATCH_EXPRESSION: u32 = 5;

// enum MienPreset
/// Small enough to read.
pub const MIEN_PRESET_TINY: u32 = 0;
pub const MIEN_PRESET_SMALL: u32 = 1;
pub const MIEN_PRESET_MEDIUM: u32 = 2;
/// A synthetic rig of production size: 870 joints, 260 raw controls, 8 LODs, a million matrix
/// entries.
pub const MIEN_PRESET_LARGE: u32 = 3;
/// A synthetic rig of the size of a production body: 342 joints, moved by 72 RBF solvers with 670
/// poses, 22 twists and 16 swings; some are quaternion joints.
pub const MIEN_PRESET_BODY: u32 = 4;
/// A stylized head to look at: skin, eyes, teeth, tongue, hair; the 52 ARKit expressions and 20 of
/// MetaHuman rigs as raw controls (0 to 1), correctives, wrinkle maps, 8 LODs. Seed 0 is the
/// designed head; other seeds vary skull, nose, jaw, age, hair and colors. The metadata holds
/// vertex colors: key "mien.colors.\<mesh name\>", value base64 of 3 bytes (sRGB) per vertex
/// position of the mesh.
pub const MIEN_PRESET_HEAD: u32 = 5;
/// A synthetic rig with the published counts of exported heads and names in MetaHuman's
/// conventions: version 2.5, 870 joints, 263 raw controls (251 expressions, 12 parts of
/// quaternions), 174 GUI controls, 545 correctives, 782 channels, an RBF solver with 18 poses, 8
/// LODs.
pub const MIEN_PRESET_METAHUMAN_HEAD: u32 = 6;
/// `MIEN_PRESET_BODY` in version 2.7.
pub const MIEN_PRESET_METAHUMAN_BODY: u32 = 7;
/// `MIEN_PRESET_METAHUMAN_HEAD` without blend shapes.
pub const MIEN_PRESET_ARCHETYPE: u32 = 8;

// enum MienGenerate
/// machine-learned behavior: networks for mesh regions with all activation functions and
/// operations, and ML joints; not with `MIEN_PRESET_HEAD` and those after it.
pub const MIEN_GENERATE_ML: u32 = 1;

// enum MienBoneKind
pub const MIEN_BONE_ROOT: u32 = 0;
pub const MIEN_BONE_NECK: u32 = 1;
pub const MIEN_BONE_HEAD: u32 = 2;
pub const MIEN_BONE_FACE: u32 = 3;
/// Moves with expressions; each LOD keeps the first n of these.
pub const MIEN_BONE_FACIAL: u32 = 4;
pub const MIEN_BONE_JAW: u32 = 5;
pub const MIEN_BONE_EYE: u32 = 6;
/// Below the neck.
pub const MIEN_BONE_CHEST: u32 = 7;
/// Moves with expressions, below the jaw; in every LOD.
pub const MIEN_BONE_TONGUE: u32 = 8;

// enum MienSymmetry
/// If mirrored positions lie within 0.5 % of the face's size of the surface.
pub const MIEN_SYMMETRY_AUTO: u32 = 0;
pub const MIEN_SYMMETRY_ON: u32 = 1;
pub const MIEN_SYMMETRY_OFF: u32 = 2;

// enum MienMeshAxis
/// Up: Y; front: Z.
pub const MIEN_MESH_AXIS_DEFAULT: u32 = 0;
pub const MIEN_MESH_AXIS_X: u32 = 1;
pub const MIEN_MESH_AXIS_Y: u32 = 2;
pub const MIEN_MESH_AXIS_Z: u32 = 3;
pub const MIEN_MESH_AXIS_MINUS_X: u32 = 4;
pub const MIEN_MESH_AXIS_MINUS_Y: u32 = 5;
pub const MIEN_MESH_AXIS_MINUS_Z: u32 = 6;

// enum MienAuthorFlags
/// Only the published method, plus the neck cut: no symmetry, no weighting by motion, no joints
/// for jaw and eyes.
pub const MIEN_AUTHOR_PAPER: u32 = 1;
/// The face mask may include parts of the neck.
pub const MIEN_AUTHOR_NO_NECK_CUT: u32 = 2;
/// The face mask is where shapes move: for heads that are not human.
pub const MIEN_AUTHOR_MASK_FROM_SHAPES: u32 = 4;
/// Weight positions by the area around them: for scans.
pub const MIEN_AUTHOR_AREA_DENSITY: u32 = 8;
/// No blend shape targets for the motion that joints cannot produce.
pub const MIEN_AUTHOR_NO_TARGETS: u32 = 16;
/// Group by distance in space, not in depth: for comparison.
pub const MIEN_AUTHOR_GROUP_IN_SPACE: u32 = 32;
/// Name bones that are placed and controls that are added as in MetaHuman heads where they have a
/// counterpart: `neck_01`, FACIAL\_C\_Jaw, CTRL\_expressions.jawOpen. The caller's bones and
/// shapes keep their names.
pub const MIEN_AUTHOR_METAHUMAN_NAMES: u32 = 64;

// enum MienMatch
/// The nearest point in space.
pub const MIEN_MATCH_SURFACE: u32 = 0;
/// The nearest point in the texture.
pub const MIEN_MATCH_UV: u32 = 1;

// enum MienFitConstraintKind
/// `joint` is at `target`: where the jaw is.
pub const MIEN_CONSTRAINT_JOINT_POSITION: u32 = 0;
/// `axis` of `joint` has the direction `target`: an eye's gaze.
pub const MIEN_CONSTRAINT_JOINT_DIRECTION: u32 = 1;
/// `axis` of `joint` points at the place `target`.
pub const MIEN_CONSTRAINT_JOINT_AIM: u32 = 2;
/// `points[0]` is at `target`.
pub const MIEN_CONSTRAINT_POINT_POSITION: u32 = 3;
/// From `distances[0]` to `distances[1]` lie between `points`: 0 and 0 where lips touch.
pub const MIEN_CONSTRAINT_POINT_DISTANCE: u32 = 4;

// enum MienFitStatus
/// Further steps change nothing.
pub const MIEN_FIT_CONVERGED: u32 = 0;
/// The limit of iterations was reached; the best controls so far.
pub const MIEN_FIT_ITERATIONS: u32 = 1;
/// The limit of time was reached; likewise.
pub const MIEN_FIT_TIME: u32 = 2;
/// The caller asked to stop; likewise.
pub const MIEN_FIT_CANCELED: u32 = 3;
/// No target, or all are missing; the start is returned.
pub const MIEN_FIT_NO_DATA: u32 = 4;

/// A checked, read-only view of a DNA file. Immutable.
#[repr(C)]
pub struct MienDna {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// The findings of a validation. Immutable.
#[repr(C)]
pub struct MienReport {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// The behavior of a DNA, packed for evaluation. Immutable.
#[repr(C)]
pub struct MienRig {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// One character: inputs, and the results of the last evaluation.
#[repr(C)]
pub struct MienInstance {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// Scratch memory for evaluating many instances of a rig in one call.
#[repr(C)]
pub struct MienBatch {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// The geometry of a DNA and its joint hierarchy, packed for deformation. Immutable.
///
/// ```text
/// local    Translate(neutral + delta) * R * Scale(1 + delta), for column vectors. R is either
///          R(neutral) * R(delta) or the rotation of the summed angles (MIEN_COMPOSE_...). With
///          quaternion outputs R(delta) is the quaternion, of any length; zero is the identity.
/// model    model matrix of the parent * local; a root (its own parent) starts at the origin
/// skin     model * inverse of the model matrix of the neutral pose
/// vertex   sum over its joints of weight * skin * (neutral position + sum of channel weight *
///          target delta): linear blend skinning. A vertex without joints is not skinned. Channel
///          weights below 1e-5 in magnitude count as 0.
/// ```
///
/// Joints that a LOD does not list move with their parent. A position is shared by all faces
/// around it; a vertex is a position with texture coordinates and a normal (a layout in DNA
/// files). So a mesh has at least as many vertices as used positions.
///
/// See docs/deformation.md, 1 "Joint transforms" and 2 "Positions".
#[repr(C)]
pub struct MienDeformer {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// One character: joint matrices, and positions and normals of its meshes.
#[repr(C)]
pub struct MienDeformerInstance {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// Derivatives of one rig, and the memory to compute them. Belongs to one thread at a time.
#[repr(C)]
pub struct MienDerivatives {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// The sparse matrix of the derivatives of chosen numbers at one point, its rows, with respect to
/// chosen numbers at an earlier one, its columns: which entries may be other than 0 in some pose,
/// and which columns have no row in common, so that one direction computes them together
/// (docs/derivatives.md, 9). Never changes.
#[repr(C)]
pub struct MienJacobian {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// An open baked file: a rig, and possibly its deformer, as they are in memory. They are used in
/// place, so that programs can ship without DNA files. A baked file holds all options of its
/// objects except the instruction set and MienReuse, and works on all machines of one byte order.
/// The same objects give the same bytes. Keep the DNA file: a later version of the library may
/// refuse the baked file with `MIEN_ERROR_BAKED_VERSION`. Immutable.
///
/// See docs/rig-evaluation.md, 9.5 "Baked files".
#[repr(C)]
pub struct MienBaked {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// Curves of named channels at a constant frame rate, compressed. A clip is not bound to a rig: a
/// MienClipBinding maps its channels to raw controls.
///
/// ```text
/// rows of values -> MienClip -> MienClipPlayer  -> values of channels
///                          \___ MienClipBinding -> raw controls of a rig
/// ```
///
/// Times are integers, in ticks of 1 / `MIEN_TICKS_PER_SECOND` s. At common frame rates a frame
/// lasts a whole number of ticks; at others its length is rounded to the nearest tick. A clip is
/// used in place: frames are decoded while it plays. Decoded values are always finite, even if the
/// bytes are damaged. Immutable.
#[repr(C)]
pub struct MienClip {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// Plays a clip for one character: a position, and the state of the decoder.
#[repr(C)]
pub struct MienClipPlayer {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// Maps the channels of a clip to raw controls of a rig. Serves all clips with the same channels
/// and all rigs with the same raw controls. Immutable.
#[repr(C)]
pub struct MienClipBinding {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// A description of what is mixed for one rig, and how. A row holds one value per curve. The
/// curves are the raw controls of the rig, then pose variables: numbers of the caller that are
/// mixed by the same rules (gaze, head turn, breath). Each step of a MienMixer applies the layers
/// in order, then reactions, guards, layers and reactions that act after the guards, antagonists,
/// and limits. docs/mixing.md explains each stage. One mix serves any number of mixers and
/// threads. Immutable.
#[repr(C)]
pub struct MienMix {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// Which raw controls turn the eyes of a rig, and by how much. Immutable.
#[repr(C)]
pub struct MienGaze {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// One character in a mix: its running clips, fades and reactions. Another thread may only call
/// `mien_mixer_push()` at the same time.
#[repr(C)]
pub struct MienMixer {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// Solvers move joints of a deformer after the rig has posed them: eyes aim at a target, a cap
/// moves from hand to head, earrings swing.
///
/// ```text
/// mien_deformer_instance_update() -> mien_solver_state_step() -> mien_deformer_instance_deform()
/// ```
///
/// A step changes the matrices of the deformer instance in place. Lengths are in the rig's
/// translation unit, points in its model space. Results have the same bits on every machine,
/// stepped alone or in a batch. A stack serves any number of characters and threads. Immutable.
///
/// See docs/mixing.md, 6 "Solvers".
#[repr(C)]
pub struct MienSolverStack {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// One character: the state that its solvers keep between steps.
#[repr(C)]
pub struct MienSolverState {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// What was found and measured while authoring a rig. Immutable.
#[repr(C)]
pub struct MienAuthorReport {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// A DNA file that can be changed: field by field, with the paths of `mien_dna_field()`, and by
/// operations that keep all references consistent. Every change happens completely or, if the call
/// fails, not at all. Everything else stays as it is, byte for byte. Memory is taken for the file
/// that was opened, unless it is mapped, and for changed fields.
#[repr(C)]
pub struct MienDocument {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// One rig, the joints and points to match, and the memory to solve. Belongs to one thread at a
/// time; use one for each thread.
#[repr(C)]
pub struct MienFit {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// A surface without correspondences: a scan, or a mesh of another topology. Immutable: any
/// threads may use one at the same time.
#[repr(C)]
pub struct MienFitSurface {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// Details of a failure, owned by the caller. A call that fails fills all fields; a call that
/// succeeds sets status to `MIEN_OK` and leaves the other fields unchanged.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienError {
    pub struct_size: usize,
    /// Where in the file; `MIEN_NO_OFFSET`: nowhere in particular.
    pub byte_offset: u64,
    pub status: MienStatus,
    /// What is wrong, where, and how to fix it; null-terminated, truncated if too long.
    pub message: [c_char; 236],
}

impl Default for MienError {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// The caller's memory functions. Where a MienAllocator is NULL, the C library's heap is used. The
/// struct is copied. Both functions must remain callable until the object is destroyed, from every
/// thread that creates or destroys objects with this allocator.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienAllocator {
    /// Passed to the functions.
    pub user: *mut c_void,
    /// Returns `size` bytes aligned to `alignment` (a power of two, at most 64), or NULL.
    pub allocate: Option<unsafe extern "C" fn(user: *mut c_void, size: usize, alignment: usize) -> *mut c_void>,
    /// Releases a block. `size` and `alignment` are those it was allocated with.
    pub release: Option<unsafe extern "C" fn(user: *mut c_void, block: *mut c_void, size: usize, alignment: usize)>,
}

impl Default for MienAllocator {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// The caller's thread pool; the library starts no threads.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienParallelFor {
    /// Passed to the function.
    pub user: *mut c_void,
    /// Calls task(context, i) once for each i \< count, in any order and on any threads, and
    /// returns when all calls have finished. Tasks never wait for each other; each takes about 10
    /// us.
    pub run: Option<unsafe extern "C" fn(user: *mut c_void, count: u32, task: MienTask, context: *mut c_void)>,
}

impl Default for MienParallelFor {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienStringView {
    pub data: *const c_char,
    /// Bytes; not null-terminated.
    pub count: usize,
}

impl Default for MienStringView {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienFloatView {
    pub data: *const f32,
    pub count: usize,
}

impl Default for MienFloatView {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienMutableFloatView {
    pub data: *mut f32,
    pub count: usize,
}

impl Default for MienMutableFloatView {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienIndex16View {
    pub data: *const u16,
    pub count: usize,
}

impl Default for MienIndex16View {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienIndex32View {
    pub data: *const u32,
    pub count: usize,
}

impl Default for MienIndex32View {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// A file read by the caller, for example from an archive. `read` is called only during the call
/// that takes the stream, and on the same thread.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienStream {
    /// Passed to the function.
    pub user: *mut c_void,
    /// Of the file, in bytes.
    pub size: u64,
    /// Copies `size` bytes at `offset` to `buffer`, never more, and returns the number of bytes
    /// copied; any number but `size` is an error. The range is within the file.
    pub read: Option<unsafe extern "C" fn(user: *mut c_void, offset: u64, buffer: *mut c_void, size: usize) -> usize>,
}

impl Default for MienStream {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// Axes, units and rotation conventions of a rig. Any handedness is allowed.
///
/// See docs/dna-format.md, 11 "Coordinate systems".
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienCoordinateSystem {
    pub struct_size: usize,
    /// `MIEN_DIRECTION_...` of x, y, z.
    pub axes: [u32; 3],
    /// `MIEN_TRANSLATION_UNIT_...`
    pub translation_unit: u32,
    /// `MIEN_ROTATION_UNIT_...`
    pub rotation_unit: u32,
    /// `MIEN_ROTATION_RULE_...`
    pub rotation_rule: u32,
    /// `MIEN_ROTATION_SEQUENCE_...`; ignored with `MIEN_ROTATION_RULE_CARRIED`.
    pub rotation_sequence: u32,
    /// Of the angles about x, y, z. 1: rotates y to z, z to x, x to y. -1: the other way. 0:
    /// whichever leaves the angles unchanged.
    pub rotation_signs: [i32; 3],
    /// `MIEN_FACE_WINDING_...`
    pub face_winding: u32,
    /// 0.
    pub reserved: u32,
}

impl Default for MienCoordinateSystem {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// What to load of a DNA file, and how.
///
/// A rig converted to another coordinate system moves as before: evaluating it gives the joint
/// values of the original rig, converted. Raw controls that are components of rotations (read by
/// RBF solvers, twists or swings as quaternions, or named .qx .qy .qz .qw) are expected in the
/// requested system. Changes of axes and signs are exact, so converting back restores the original
/// numbers; a change of units rounds each number once. Texture coordinates and unknown layers are
/// not converted. A converted rig can be written; the file gets version 2.8 if its own version
/// cannot describe the system.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienDnaDesc {
    pub struct_size: usize,
    /// `MIEN_LAYER_...`, combined with \|; the others are not read. 0: all.
    pub layers: u32,
    /// Load the geometry without blend shape targets.
    pub skip_blend_shape_targets: u32,
    /// `MIEN_UNKNOWN_LAYERS_...`
    pub unknown_layers: u32,
    /// `MIEN_FILE_...`; for `mien_dna_open_file()` only.
    pub file_access: u32,
    /// Bit l keeps LOD l. Kept LODs are renumbered from 0; joints, meshes, channels and maps that
    /// none of them uses are dropped, and all indices renumbered. 0: all.
    pub lods: u64,
    /// Convert to this system. NULL: keep the file's own.
    pub system: *const MienCoordinateSystem,
    pub allocator: *const MienAllocator,
}

impl Default for MienDnaDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// Properties of an open DNA. Counts are those of the loaded layers and LODs.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienDnaInfo {
    pub struct_size: usize,
    /// 2.
    pub generation: u32,
    /// 1 to 8: the file is of version 2.version.
    pub version: u32,
    /// `MIEN_LAYER_...`, combined with \|: the loaded layers.
    pub layers: u32,
    /// The geometry is loaded with its targets.
    pub has_blend_shape_targets: u32,
    /// Size of the file.
    pub file_bytes: u64,
    /// Memory taken from the allocator.
    pub memory_bytes: u64,
    /// The file is mapped.
    pub is_mapped: u32,
    /// Entries for `mien_dna_layer()`.
    pub layer_count: u32,
    /// `MIEN_TRANSLATION_UNIT_...`
    pub translation_unit: u32,
    /// `MIEN_ROTATION_UNIT_...`
    pub rotation_unit: u32,
    /// `MIEN_DIRECTION_...` of x, y, z.
    pub axes: [u32; 3],
    /// `MIEN_ROTATION_SEQUENCE_...`
    pub rotation_sequence: u32,
    /// 1 or -1, for the angles about x, y, z.
    pub rotation_signs: [i32; 3],
    /// `MIEN_FACE_WINDING_...`
    pub face_winding: u32,
    pub lod_count: u32,
    /// LOD 0 of this file is LOD `max_lod` of its database.
    pub max_lod: u32,
    pub gui_control_count: u32,
    pub raw_control_count: u32,
    pub psd_control_count: u32,
    pub ml_control_count: u32,
    pub rbf_control_count: u32,
    pub joint_count: u32,
    pub joint_group_count: u32,
    pub blend_shape_channel_count: u32,
    pub animated_map_count: u32,
    pub mesh_count: u32,
    pub neural_network_count: u32,
    pub rbf_solver_count: u32,
    pub rbf_pose_count: u32,
    pub twist_count: u32,
    pub swing_count: u32,
    /// Pairs desc.metadata\[i\].key and .value.
    pub metadata_count: u32,
}

impl Default for MienDnaInfo {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// An entry of the index table of the file. Files of version 2.1 have no index table; their
/// sections are listed as the layers desc, defn, bhvr and geom.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienDnaLayer {
    pub struct_size: usize,
    /// `MIEN_LAYER_...` that loads it. `MIEN_LAYER_UNKNOWN`: no known kind.
    pub layer: u32,
    /// Of the layer: `version_major`.`version_minor`.
    pub version_major: u32,
    pub version_minor: u32,
    /// It was parsed, not skipped or kept as bytes.
    pub is_loaded: u32,
    /// Of its first byte in the file.
    pub byte_offset: u64,
    pub byte_count: u64,
    /// Such as "bhvr"; null-terminated.
    pub code: [c_char; 8],
}

impl Default for MienDnaLayer {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienDnaField {
    pub struct_size: usize,
    /// `MIEN_FIELD_...`
    pub r#type: u32,
    /// An array of numbers, even if it has only one element; not a single number, nor an element
    /// of an array.
    pub is_array: u32,
    /// Elements of an array or list, bytes of a string, fields of a record; 1 for a number.
    pub count: u64,
    /// Of a string, an array or an element of an array in the file; `MIEN_NO_OFFSET`: other
    /// fields, and data that is not in the file.
    pub byte_offset: u64,
}

impl Default for MienDnaField {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// How to write a DNA file. See docs/dna-format.md, 14.3 "Changing the version".
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienWriteDesc {
    pub struct_size: usize,
    /// 1 to 8: write version 2.version; layers that it does not define are kept unless
    /// `unknown_layers` drops them, but 2.1 can only hold the layers desc, defn, bhvr and geom. 0:
    /// the version of the DNA.
    pub version: u32,
    /// `MIEN_UNKNOWN_LAYERS_...`
    pub unknown_layers: u32,
}

impl Default for MienWriteDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienFinding {
    pub struct_size: usize,
    /// `MIEN_SEVERITY_...`
    pub severity: u32,
    /// The status of the failure; `MIEN_OK` for a warning.
    pub status: MienStatus,
    /// Where in the file; `MIEN_NO_OFFSET`: nowhere in particular.
    pub byte_offset: u64,
    /// Path as for `mien_dna_field()`, or the code of a layer.
    pub field: MienStringView,
    /// What is wrong.
    pub message: MienStringView,
}

impl Default for MienFinding {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienValidateDesc {
    pub struct_size: usize,
    pub allocator: *const MienAllocator,
}

impl Default for MienValidateDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// Options of a rig. See docs/rig-evaluation.md, 9.4 "Options".
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienRigDesc {
    pub struct_size: usize,
    /// `MIEN_ISA_...`
    pub isa: u32,
    /// `MIEN_ROTATION_OUTPUT_...`
    pub rotation_output: u32,
    /// `MIEN_ML_MASKS_...`
    pub ml_masks: u32,
    /// `MIEN_STORAGE_...`
    pub storage: u32,
    /// `MIEN_REUSE_...`
    pub reuse: u32,
    /// `MIEN_ARITHMETIC_...`
    pub arithmetic: u32,
    pub allocator: *const MienAllocator,
}

impl Default for MienRigDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// Properties of a rig.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienRigInfo {
    pub struct_size: usize,
    /// `MIEN_ISA_...` in use, never `MIEN_ISA_BEST`.
    pub isa: u32,
    pub lod_count: u32,
    /// `MIEN_TRANSLATION_UNIT_...`
    pub translation_unit: u32,
    /// `MIEN_ROTATION_UNIT_...`
    pub rotation_unit: u32,
    /// `MIEN_DIRECTION_...` of x, y, z.
    pub axes: [u32; 3],
    /// `MIEN_ROTATION_SEQUENCE_...`
    pub rotation_sequence: u32,
    /// 1 or -1, for the angles about x, y, z.
    pub rotation_signs: [i32; 3],
    /// Length of the control vector: raw, PSD, ML, RBF controls.
    pub control_count: u32,
    /// 9 or 10 per joint.
    pub joint_value_count: u32,
    /// `MIEN_ROTATION_OUTPUT_...`
    pub rotation_output: u32,
    /// `MIEN_STORAGE_...`
    pub storage: u32,
    /// `MIEN_ARITHMETIC_...`
    pub arithmetic: u32,
    /// Memory of the rig, including its part of a baked file.
    pub rig_bytes: u64,
    /// Memory of each instance.
    pub instance_bytes: u64,
}

impl Default for MienRigInfo {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// The work of an evaluation at a LOD when all controls are active.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienRigStatistics {
    pub struct_size: usize,
    pub lod: u32,
    /// Correctives computed.
    pub psd_count: u32,
    /// Joints of the LOD.
    pub joint_count: u32,
    /// Rows of the joint groups.
    pub joint_row_count: u32,
    /// Channels written.
    pub blend_shape_count: u32,
    /// Rows of the animated map table.
    pub animated_map_row_count: u32,
    /// RBF solvers of the LOD.
    pub rbf_solver_count: u32,
    /// Quaternion joints.
    pub quaternion_joint_count: u32,
    /// Stored in the joint matrix: 8 per block that is not all zeros.
    pub joint_entry_count: u64,
    /// Of the joint matrix; an evaluation does not read the columns of controls that are 0.
    pub joint_byte_count: u64,
}

impl Default for MienRigStatistics {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienInstanceDesc {
    pub struct_size: usize,
    pub allocator: *const MienAllocator,
}

impl Default for MienInstanceDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// What the joint stage reads for the current controls, at the LOD of the last evaluation
/// (initially LOD 0), if it reuses no results. Each byte is counted once, regardless of CPU
/// caches.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienInstanceStatistics {
    pub struct_size: usize,
    /// Of the last evaluation.
    pub lod: u32,
    /// Of the control vector: raw, PSD, ML and RBF controls.
    pub control_count: u32,
    /// Controls that are not 0.
    pub active_control_count: u32,
    /// Columns of the joint matrix that active controls drive.
    pub joint_column_count: u32,
    /// Of these columns: 8 per block.
    pub joint_entry_count: u64,
    /// Of these entries: at most MienRigStatistics.`joint_byte_count`.
    pub joint_byte_count: u64,
}

impl Default for MienInstanceStatistics {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienBatchDesc {
    pub struct_size: usize,
    /// Instances per call: 1 to 2^20. 0: 32.
    pub capacity: u32,
    /// Tasks that may run at the same time, each with its own scratch memory. 0: 1, for calls
    /// without MienParallelFor.
    pub tasks: u32,
    pub allocator: *const MienAllocator,
}

impl Default for MienBatchDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// Options of a deformer.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienDeformerDesc {
    pub struct_size: usize,
    /// `MIEN_ISA_...`; `MIEN_ISA_BEST` is that of the rig.
    pub isa: u32,
    /// `MIEN_COMPOSE_...`
    pub compose: u32,
    /// `MIEN_WEIGHTS_...`
    pub weights: u32,
    /// `MIEN_NORMALS_...`: what `MIEN_NORMALS_DEFAULT` means for this deformer.
    pub normals: u32,
    /// Compute tangents, for `mien_deformer_instance_write_vertices()`.
    pub with_tangents: u32,
    /// `MIEN_STORAGE_...` of blend shape deltas, skin weights, texture coordinates and triangles.
    /// With 16 bits these are integers with scales, and triangles follow from faces. See
    /// docs/deformation.md, 2.1 "16-bit storage".
    pub storage: u32,
    pub allocator: *const MienAllocator,
    /// Largest rounding error of a coordinate of a delta that 16-bit storage may make to store
    /// deltas with 10 bits, in translation units. 0: 2^-18 of the size of the mesh, which is also
    /// the least.
    pub delta_error: f64,
}

impl Default for MienDeformerDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// Properties of a deformer.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienDeformerInfo {
    pub struct_size: usize,
    /// `MIEN_ISA_...` in use, never `MIEN_ISA_BEST`.
    pub isa: u32,
    /// `MIEN_COMPOSE_...`
    pub compose: u32,
    /// `MIEN_WEIGHTS_...`
    pub weights: u32,
    /// `MIEN_NORMALS_...`, never `MIEN_NORMALS_DEFAULT`.
    pub normals: u32,
    pub lod_count: u32,
    pub joint_count: u32,
    pub channel_count: u32,
    /// Same as in the rig, which has their names: `MIEN_KIND_MESH`.
    pub mesh_count: u32,
    /// Memory of the deformer, including its part of a baked file.
    pub deformer_bytes: u64,
    /// Memory of a deformer instance for all meshes.
    pub instance_bytes: u64,
    /// `MIEN_STORAGE_...`
    pub storage: u32,
    /// 0.
    pub reserved: u32,
}

impl Default for MienDeformerInfo {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// A neutral mesh. Its views are valid until the deformer is destroyed.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienMesh {
    pub struct_size: usize,
    pub position_count: u32,
    pub vertex_count: u32,
    pub triangle_count: u32,
    /// Of one position.
    pub max_influences: u32,
    /// Blend shape targets.
    pub target_count: u32,
    /// Of all targets.
    pub delta_count: u32,
    /// Bit l: LOD l shows this mesh.
    pub lods: u64,
    /// 3 floats per position: x y z.
    pub positions: MienFloatView,
    /// 3 floats per vertex: x y z, unit length.
    pub normals: MienFloatView,
    /// 4 floats per vertex: x y z w, see MienVertexOutput; empty unless
    /// MienDeformerDesc.`with_tangents` was set.
    pub tangents: MienFloatView,
    /// 2 floats per vertex: u v, as in the file; may be empty with 16-bit storage: see
    /// `mien_deformer_texture_coordinates()`.
    pub texture_coordinates: MienFloatView,
    /// One index per vertex: its position.
    pub vertex_position_indices: MienIndex32View,
    /// 3 indices per triangle: vertices, wound as in the file; faces with more corners become fans
    /// about their first corner. May be empty with 16-bit storage: see
    /// `mien_deformer_triangles()`.
    pub triangles: MienIndex32View,
    /// One index per target: its blend shape channel; in file order.
    pub target_channels: MienIndex16View,
}

impl Default for MienMesh {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienDeformerInstanceDesc {
    pub struct_size: usize,
    /// Take memory for the meshes of these LODs only: bit l is LOD l. LODs that do not exist are
    /// ignored. 0: for all meshes.
    pub lods: u64,
    pub allocator: *const MienAllocator,
}

impl Default for MienDeformerInstanceDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// One attribute of all vertices: vertex i is written at data + i \* stride. `data` and `stride`
/// are multiples of 4; `stride` is at least the size of the format.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienVertexStream {
    /// NULL: the attribute is not written.
    pub data: *mut c_void,
    /// In bytes.
    pub stride: u32,
    /// `MIEN_VERTEX_FORMAT_...`
    pub format: u32,
}

impl Default for MienVertexStream {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// Where to write the vertices of a mesh, in the order of MienMesh.`vertex_position_indices`.
/// Streams may be interleaved (with the same stride) or separate, but must not share bytes. At
/// least one is needed.
///
/// ```text
/// positions  as floats; w is 1
/// normals    in any format; w is 0
/// tangents   in any format with w. The tangent points along the surface in the direction of growing u
///            at constant v, perpendicular to the normal; w * cross(normal, tangent) points in the
///            direction of growing v. w is 1, or -1 where the texture is mirrored. If you flip v (1 - v),
///            negate w.
/// ```
///
/// Neutral tangents are computed as by MikkTSpace, except that vertices are never split: where
/// triangles of both orientations meet, a vertex takes the orientation with the larger sum of
/// angles. A vertex without texture coordinates gets an arbitrary, but reproducible, perpendicular
/// of its normal and w = 1. Tangents are skinned, and then made perpendicular to the written
/// normal.
///
/// See docs/deformation.md, 4 "Tangents".
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienVertexOutput {
    pub struct_size: usize,
    /// Of each stream: at least MienMesh.`vertex_count`.
    pub vertex_capacity: usize,
    pub positions: MienVertexStream,
    pub normals: MienVertexStream,
    /// Requires MienDeformerDesc.`with_tangents`.
    pub tangents: MienVertexStream,
}

impl Default for MienVertexOutput {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// How to create derivatives.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienDerivativesDesc {
    pub struct_size: usize,
    /// Of the rig. NULL: none, and no points from LOCALS to POSITIONS.
    pub deformer: *const MienDeformer,
    /// NULL: the heap.
    pub allocator: *const MienAllocator,
}

impl Default for MienDerivativesDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// Which matrix.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienJacobianDesc {
    pub struct_size: usize,
    /// `MIEN_POINT_...`: of the columns.
    pub from_point: u32,
    /// `MIEN_POINT_...`: of the rows.
    pub to_point: u32,
    /// The mesh of `MIEN_POINT_POSITIONS`, else 0.
    pub mesh: u32,
    /// Of the evaluations: entries that other LODs add are left out.
    pub lod: u32,
    /// Numbers at `from_point`, one per column. NULL: all.
    pub inputs: *const u32,
    /// Numbers at `to_point`, one per row, ascending. NULL: all.
    pub outputs: *const u32,
    /// 0 if `inputs` is NULL.
    pub input_count: usize,
    /// 0 if `outputs` is NULL.
    pub output_count: usize,
    /// NULL: the heap.
    pub allocator: *const MienAllocator,
}

impl Default for MienJacobianDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// The entries of a matrix: by column, then by row.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienJacobianPattern {
    pub struct_size: usize,
    /// Of each entry: a place in MienJacobianDesc.outputs, or a number at `to_point`.
    pub rows: MienIndex32View,
    /// Of each entry: a place in MienJacobianDesc.inputs, or a number at `from_point`.
    pub columns: MienIndex32View,
    /// Rows and columns of the matrix, with or without entries.
    pub row_count: usize,
    pub column_count: usize,
    /// Directions that compute all columns: the colors of a coloring.
    pub direction_count: usize,
}

impl Default for MienJacobianPattern {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// How to open a baked file.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienBakedDesc {
    pub struct_size: usize,
    /// `MIEN_FILE_...`; `MIEN_FILE_READ` also copies bytes in memory.
    pub file_access: u32,
    /// `MIEN_BAKED_CHECK_...`
    pub check: u32,
    pub allocator: *const MienAllocator,
}

impl Default for MienBakedDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// Properties of an open baked file.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienBakedInfo {
    pub struct_size: usize,
    /// Size of the file.
    pub file_bytes: u64,
    /// Memory taken from the allocator.
    pub memory_bytes: u64,
    /// Size of the rig in the file. 0: it has none.
    pub rig_bytes: u64,
    /// Size of the deformer in the file. 0: it has none.
    pub deformer_bytes: u64,
    /// Parts of the file, including unknown ones.
    pub part_count: u32,
    /// The file is mapped.
    pub is_mapped: u32,
}

impl Default for MienBakedInfo {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// Options of a rig that are not part of a baked file.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienBakedRigDesc {
    pub struct_size: usize,
    /// `MIEN_ISA_...`
    pub isa: u32,
    /// `MIEN_REUSE_...`
    pub reuse: u32,
    pub allocator: *const MienAllocator,
}

impl Default for MienBakedRigDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// Options of a deformer that are not part of a baked file.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienBakedDeformerDesc {
    pub struct_size: usize,
    /// `MIEN_ISA_...`; `MIEN_ISA_BEST` is that of the rig.
    pub isa: u32,
    /// `MIEN_NORMALS_...`: what `MIEN_NORMALS_DEFAULT` means for this deformer; in this field
    /// `MIEN_NORMALS_DEFAULT` keeps the setting of the baked deformer.
    pub normals: u32,
    pub allocator: *const MienAllocator,
}

impl Default for MienBakedDeformerDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// A named moment of a clip, such as a phoneme. In speech layers, events named "close:lips",
/// "close:lip-to-teeth" and "close:teeth" activate the matching guards of the mixer for `value`
/// seconds.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienClipEvent {
    pub tick: i64,
    pub name: MienStringView,
    pub value: f32,
    /// 0.
    pub reserved: u32,
}

impl Default for MienClipEvent {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// What to build a clip from.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienClipDesc {
    pub struct_size: usize,
    /// Frames per second, as a fraction. 0: 60.
    pub rate_numerator: u32,
    /// 0: 1.
    pub rate_denominator: u32,
    /// 1 to 2^28.
    pub frame_count: u32,
    /// At most 65535, of which at most 512 may change over time.
    pub channel_count: u32,
    /// One per channel, all different, not empty.
    pub names: *const MienStringView,
    /// Channel c of frame f is values\[f \* `frame_stride` + c\].
    pub values: *const f32,
    /// Floats from frame to frame. 0: `channel_count`.
    pub frame_stride: usize,
    /// One per channel, used instead of `snap`; may be NULL.
    pub snaps: *const f32,
    /// 0: values keep all bits. 2^-9, 2^-10 ... 2^-16: values are rounded to multiples of this
    /// step, which makes the clip several times smaller.
    pub snap: f32,
    /// `MIEN_LOOPING_...`
    pub looping: u32,
    /// A delta clip, whose values are added to other values.
    pub is_delta: u32,
    pub event_count: u32,
    /// In any order; 0 \<= tick \< `frame_count` \* ticks per frame.
    pub events: *const MienClipEvent,
    pub allocator: *const MienAllocator,
}

impl Default for MienClipDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// How to open a clip.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienClipOpenDesc {
    pub struct_size: usize,
    /// `MIEN_FILE_...`; no effect on memory and streams.
    pub file_access: u32,
    /// 0.
    pub reserved: u32,
    pub allocator: *const MienAllocator,
}

impl Default for MienClipOpenDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// Properties of a clip.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienClipInfo {
    pub struct_size: usize,
    /// Frames per second, as a fraction.
    pub rate_numerator: u32,
    pub rate_denominator: u32,
    pub frame_count: u32,
    pub channel_count: u32,
    /// Channels whose value is not the same in all frames.
    pub changing_channel_count: u32,
    pub event_count: u32,
    /// `MIEN_LOOPING_CLAMP` or `MIEN_LOOPING_WRAP`.
    pub looping: u32,
    /// As in MienClipDesc.
    pub is_delta: u32,
    /// Largest step to which a channel was rounded. 0: none was.
    pub snap: f32,
    /// The file is mapped.
    pub is_mapped: u32,
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

impl Default for MienClipInfo {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// A channel of a clip. Block counts, bits and `max_error` are only known for a clip from
/// `mien_clip_build()`; they are 0 for a clip that was opened.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienClipChannel {
    pub struct_size: usize,
    pub name: MienStringView,
    /// Value of a channel that does not change; otherwise 0.
    pub rest: f32,
    /// The channel has a curve.
    pub is_changing: u32,
    /// Blocks of 64 frames that are zero.
    pub zero_blocks: u32,
    /// Blocks with one other value.
    pub constant_blocks: u32,
    /// Blocks whose values are multiples of a decimal or binary fraction.
    pub grid_blocks: u32,
    /// Other blocks.
    pub float_blocks: u32,
    /// Of all blocks.
    pub bits: u64,
    /// Largest error of rounding to a step.
    pub max_error: f32,
    /// 0.
    pub reserved: u32,
}

impl Default for MienClipChannel {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// How to play a clip.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienClipPlayerDesc {
    pub struct_size: usize,
    /// `MIEN_LOOPING_...`
    pub looping: u32,
    /// `MIEN_INTERPOLATION_...`
    pub interpolation: u32,
    /// Speed, as a fraction; negative plays backward. -2^20 to 2^20.
    pub speed_numerator: i32,
    /// 1 to 2^20. Both 0: 1 / 1.
    pub speed_denominator: i32,
    /// Initial position, as for `mien_clip_player_seek()`.
    pub start_tick: i64,
    /// Backward playback costs no more than forward; takes 256 more bytes per changing channel.
    pub reverse: u32,
    /// 0.
    pub reserved: u32,
    pub allocator: *const MienAllocator,
}

impl Default for MienClipPlayerDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// State of a player.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienClipPlayerInfo {
    pub struct_size: usize,
    /// 0 to the length of the clip; with `MIEN_LOOPING_WRAP` less than the length.
    pub tick: i64,
    /// Loops completed since creation or the last seek, at most 2^61; negative: backward.
    pub loops: i64,
    /// `MIEN_LOOPING_CLAMP` or `MIEN_LOOPING_WRAP`.
    pub looping: u32,
    /// A damaged curve was played, as zeros.
    pub is_damaged: u32,
}

impl Default for MienClipPlayerInfo {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// Adds weight \* value of a channel to a raw or GUI control.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienMatrixEntry {
    pub channel: MienStringView,
    pub control: MienStringView,
    pub weight: f32,
    /// 0.
    pub reserved: u32,
}

impl Default for MienMatrixEntry {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// How to bind a clip.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienClipBindingDesc {
    pub struct_size: usize,
    /// For channels whose names the rig does not have; may be NULL: those that `mien_rig_match()`
    /// knows need none.
    pub matrix: *const MienMatrixEntry,
    pub matrix_count: usize,
    pub allocator: *const MienAllocator,
}

impl Default for MienClipBindingDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// What a binding found. Indices are ascending.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienClipBindingInfo {
    pub struct_size: usize,
    /// Channels of the clip.
    pub channel_count: u32,
    /// Raw controls of the rig.
    pub raw_control_count: u32,
    /// Matrix entries whose channel or control does not exist.
    pub missing_entry_count: u32,
    /// 0.
    pub reserved: u32,
    /// Raw controls that are driven.
    pub controls: MienIndex16View,
    /// Raw controls that are not driven.
    pub extra_controls: MienIndex16View,
    /// Channels that drive nothing: the rig has no such name, or an earlier channel drives the
    /// same control.
    pub missing_channels: MienIndex16View,
}

impl Default for MienClipBindingInfo {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// A layer of a mix. Leave the fields that its source does not use at zero.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienMixLayer {
    /// Of a generator, ticks.
    pub period: i64,
    /// Of a stream, ticks: rows are played this much later than their times.
    pub delay: i64,
    /// One per curve, 0 to 1; curves beyond `mask_count` have 0. NULL: 1 for all.
    pub mask: *const f32,
    /// The curve of each channel of a stream, or the curves of a generator.
    pub curves: *const u16,
    /// One per curve of a generator: a factor for its value.
    pub amounts: *const f32,
    pub mask_count: u32,
    pub curve_count: u32,
    /// `MIEN_LAYER_GROUP_...`
    pub group: u32,
    /// `MIEN_BLEND_MODE_...`
    pub mode: u32,
    /// `MIEN_LAYER_SOURCE_...`
    pub source: u32,
    /// Acts after the guards; not allowed for base and speech.
    pub after_guards: u32,
    /// Initial weight. 0 to 1; -1 to 1 with `MIEN_BLEND_MODE_ADD`.
    pub weight: f32,
    /// Index of its first pose in MienMixDesc.poses.
    pub first_pose: u32,
    pub pose_count: u32,
    /// `MIEN_GENERATOR_...`
    pub generator: u32,
    /// Capacity of a stream's queue, in rows. 0: 64; otherwise 2 to 1024.
    pub stream_frames: u32,
    /// 0.
    pub reserved: u32,
}

impl Default for MienMixLayer {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// A pose: the curves that it moves, and their values.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienMixPose {
    pub curves: *const u16,
    pub values: *const f32,
    pub count: usize,
}

impl Default for MienMixPose {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// A part of a reaction: moves the curves of a pose to its values and back to 0. Times are in
/// ticks.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienMixStroke {
    /// After the trigger.
    pub delay: i64,
    /// Time to reach strength \* pose.
    pub attack: i64,
    /// Time after the attack; ignored if `is_held`.
    pub hold: i64,
    /// Time to return to 0.
    pub release: i64,
    /// Index in MienMixDesc.poses.
    pub pose: u32,
    /// `MIEN_BLEND_MODE_...`
    pub mode: u32,
    /// Holds as long as the stimulus lasts, and adapts unless `is_lag`.
    pub is_held: u32,
    /// Moves exponentially; attack and release are time constants.
    pub is_lag: u32,
    /// Scaled by the level of the reaction, which is 1 if `mien_mixer_trigger()` started it.
    pub is_scaled: u32,
    /// 0.
    pub reserved: u32,
}

impl Default for MienMixStroke {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// The response of a face to a stimulus, such as a bright light.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienMixReaction {
    /// Ticks; minimum time between two starts of strokes that are not held.
    pub cooldown: i64,
    /// Time constant of adaptation to a lasting stimulus.
    pub adapt_ticks: i64,
    /// Time constant of recovery after the stimulus.
    pub recover_ticks: i64,
    /// At most 8.
    pub strokes: *const MienMixStroke,
    pub stroke_count: usize,
    /// `MIEN_RETRIGGER_...`
    pub retrigger: u32,
    /// Acts after the guards.
    pub after_guards: u32,
    /// Share of the strength that remains after full adaptation; 1: all.
    pub adapted: f32,
    /// Levels of this or more are a stimulus: `mien_mixer_set_level()`. 0: the reaction takes no
    /// levels.
    pub level_on: f32,
    /// The stimulus ends below this; at most `level_on`.
    pub level_off: f32,
    /// 0.
    pub reserved: u32,
}

impl Default for MienMixReaction {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// Two curves that move the face in opposite directions. If both are above 0, the smaller one
/// times stiffness is subtracted from both.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienMixAntagonists {
    pub first: u16,
    pub second: u16,
    /// 0 to 1.
    pub stiffness: f32,
}

impl Default for MienMixAntagonists {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// A point of the face: the mean of some positions of a mesh that LOD 0 shows, or of some joints.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienLandmark {
    /// Indices of positions of the mesh, or of joints.
    pub points: *const u32,
    /// 1 to 65536.
    pub point_count: u32,
    /// Index of the mesh. `MIEN_NO_MESH`: the points are joints.
    pub mesh: u32,
}

impl Default for MienLandmark {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// A guard with landmarks of the caller. It keeps the gap between them, the height of `upper`
/// above `lower` along the axis that points up, from being opened.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienMixGuard {
    pub upper: MienLandmark,
    pub lower: MienLandmark,
    /// Raw control that closes the gap at 1. `MIEN_NO_CONTROL`: it is closed at rest.
    pub closed_by: u32,
    /// Acts at most as much as the largest weight of a speech layer.
    pub needs_speech: u32,
    /// Millimeters by which later layers may open the gap, 0 or more; 0.3 for built-in guards.
    pub tolerance: f32,
    /// Millimeters, above 0: acts if base and speech leave a smaller gap, fully at 0. Built-in
    /// guards: 12 for lips, 6 for lids, 4 for teeth.
    pub f_on: f32,
}

impl Default for MienMixGuard {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// What to mix. Everything is copied.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienMixDesc {
    pub struct_size: usize,
    /// At most 16.
    pub layers: *const MienMixLayer,
    pub layer_count: usize,
    /// At most 1024; used by layers and strokes.
    pub poses: *const MienMixPose,
    pub pose_count: usize,
    /// At most 16.
    pub reactions: *const MienMixReaction,
    pub reaction_count: usize,
    pub antagonists: *const MienMixAntagonists,
    pub antagonist_count: usize,
    /// For each curve its counterpart in the other half of the face, or itself. NULL: clips cannot
    /// be played mirrored.
    pub mirror: *const u16,
    /// Limits per curve. NULL: none; both or neither.
    pub lower: *const f32,
    pub upper: *const f32,
    /// Numbered after the built-in ones; at most 8 guards in total.
    pub custom_guards: *const MienMixGuard,
    pub custom_guard_count: usize,
    /// For a layer with `MIEN_GENERATOR_GAZE`; may be NULL.
    pub gaze: *const MienGaze,
    /// To measure guards; may be NULL if there are none.
    pub deformer: *const MienDeformer,
    /// `MIEN_GUARD_...` bits; a guard is left out if the rig lacks its landmarks.
    pub guards: u32,
    /// Pose variables; at most 4096 curves with the raw controls.
    pub variable_count: u32,
    /// Clips that can play at the same time; a crossfade needs two. 0: two for each clip layer.
    pub player_count: u32,
    /// Of any clip. 0: the number of raw controls.
    pub max_channels: u32,
    /// Of any clip. 0: `max_channels`, 512 at most.
    pub max_changing_channels: u32,
    /// Events that one step can report. 0: 64.
    pub max_events: u32,
    /// As in MienClipPlayerDesc.
    pub reverse: u32,
    /// 0.
    pub reserved: u32,
    pub allocator: *const MienAllocator,
}

impl Default for MienMixDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// How to open a mix.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienMixOpenDesc {
    pub struct_size: usize,
    pub allocator: *const MienAllocator,
}

impl Default for MienMixOpenDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// Properties of a mix.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienMixInfo {
    pub struct_size: usize,
    pub raw_control_count: u32,
    pub variable_count: u32,
    /// Raw controls and pose variables.
    pub curve_count: u32,
    pub layer_count: u32,
    /// For `mien_mixer_stage()`.
    pub stage_count: u32,
    /// For `mien_mixer_set_guard()`.
    pub guard_count: u32,
    /// Memory of a mixer without MienMixerDesc.stages.
    pub mixer_bytes: u64,
    /// Size of a snapshot.
    pub snapshot_bytes: u64,
}

impl Default for MienMixInfo {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// A guard of a mix, as it was measured: the distance in millimeters is `rest`, plus the sum of
/// gain \* curve, plus a sum over pairs of curves that share a corrective. See docs/mixing.md, 4
/// "Guards".
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienMixGuardInfo {
    pub struct_size: usize,
    /// Raw controls that change the distance, by descending gain.
    pub curves: MienIndex16View,
    /// 1 float per curve: millimeters at value 1.
    pub gains: MienFloatView,
    pub pair_count: u32,
    /// As in MienMixGuard.
    pub needs_speech: u32,
    /// Distance of a row of zeros.
    pub rest: f32,
    /// As in MienMixGuard.
    pub tolerance: f32,
    pub f_on: f32,
    /// Millimeters, root mean square over the measured rows.
    pub fit_error: f32,
}

impl Default for MienMixGuardInfo {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// How to create a gaze.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienGazeDesc {
    pub struct_size: usize,
    /// Name of a joint. NULL: L\_Eye or FACIAL\_L\_Eye.
    pub left_eye: *const c_char,
    /// Name of a joint. NULL: R\_Eye or FACIAL\_R\_Eye.
    pub right_eye: *const c_char,
    pub allocator: *const MienAllocator,
}

impl Default for MienGazeDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// A point in millimeters from the origin of the rig's model space, with the head in its neutral
/// pose.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienGazeTarget {
    pub left: f32,
    pub up: f32,
    pub front: f32,
}

impl Default for MienGazeTarget {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// What was measured on the eyes.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienGazeInfo {
    pub struct_size: usize,
    /// Center of rotation.
    pub left_eye: MienGazeTarget,
    pub right_eye: MienGazeTarget,
    /// Degrees, largest error found when an eye turns sideways and up at once.
    pub fit_error: f32,
    /// 0.
    pub reserved: u32,
}

impl Default for MienGazeInfo {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// The part of a gaze that the eyes cannot reach, left for the head to turn: tangents of angles,
/// averaged over both eyes.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienGazeRest {
    pub left: f32,
    pub up: f32,
}

impl Default for MienGazeRest {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// How to create a mixer.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienMixerDesc {
    pub struct_size: usize,
    /// Of the generators.
    pub seed: u64,
    /// Keep the row after each stage, for `mien_mixer_stage()`.
    pub stages: u32,
    /// 0.
    pub reserved: u32,
    pub allocator: *const MienAllocator,
}

impl Default for MienMixerDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// How to play a clip in a layer.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienPlayDesc {
    pub struct_size: usize,
    /// Chosen by the caller, to identify clip and binding in `mien_mixer_restore()`.
    pub clip_id: u64,
    /// In the clip.
    pub start_tick: i64,
    /// 0 to 2^40.
    pub transition_ticks: i64,
    /// `MIEN_TRANSITION_...`
    pub transition: u32,
    /// `MIEN_LOOPING_...`
    pub looping: u32,
    /// `MIEN_INTERPOLATION_...`
    pub interpolation: u32,
    /// As in MienClipPlayerDesc.
    pub speed_numerator: i32,
    pub speed_denominator: i32,
    /// ; requires MienMixDesc.mirror.
    pub mirrored: u32,
}

impl Default for MienPlayDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// What a guard did in the last step. Distances are in millimeters, computed by the function of
/// raw controls that was measured on the rig; a negative distance means that both sides overlap.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienGuardState {
    pub struct_size: usize,
    /// "lips left", "lips center", "lips right", "teeth", "lower lip to teeth", "left lids",
    /// "right lids" or "custom".
    pub name: MienStringView,
    /// Raw controls that it may hold back.
    pub controls: MienIndex16View,
    /// `MIEN_GUARD_...`; 0: one of MienMixDesc.`custom_guards`.
    pub kind: u32,
    /// How much it acted, 0 to 1.
    pub activation: f32,
    /// Distance after the last layer of base and speech.
    pub protected_distance: f32,
    /// Distance just before the guards, after the later layers and reactions.
    pub wanted: f32,
    /// Largest distance that the guard allows when fully active.
    pub limit: f32,
    /// Distance after the guards: above `limit` if the guard is not fully active, while it eases
    /// in, or if other controls open the gap.
    pub distance: f32,
}

impl Default for MienGuardState {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// State of a mixer.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienMixerInfo {
    pub struct_size: usize,
    /// Time since creation.
    pub tick: i64,
    /// Clip events that the last step passed.
    pub event_count: u32,
    /// There were more than MienMixDesc.`max_events`.
    pub lost_events: u32,
}

impl Default for MienMixerInfo {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// A clip that `mien_mixer_restore()` may need.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienMixerClip {
    /// As in MienPlayDesc.
    pub clip_id: u64,
    pub clip: *const MienClip,
    pub clip_binding: *const MienClipBinding,
}

impl Default for MienMixerClip {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// Aim constraint: turns a joint so that one of its axes points at a target, by the shortest
/// rotation, then about that axis so that `up_axis` comes as near to `up` as possible. Directions
/// may have any length.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienAimSolver {
    pub joint: u32,
    /// Its position is the target. `MIEN_NO_JOINT`: three curves of the row are.
    pub target_joint: u32,
    /// First of these three: x y z in model space.
    pub target_curve: u32,
    /// Aim axis, in the space of the joint; not 0 0 0.
    pub axis: [f32; 3],
    /// In the space of the joint; 0 0 0: no rotation about the aim axis.
    pub up_axis: [f32; 3],
    /// In model space; 0 0 0: 0 1 0.
    pub up: [f32; 3],
    /// 0 to 180: largest angle from the neutral direction. 0: no limit.
    pub cone_degrees: f32,
    /// 0 to 1.
    pub weight: f32,
}

impl Default for MienAimSolver {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// Space switch: moves a joint as if its parent were attached to another joint. A curve selects
/// one of the spaces. When it changes, the joint stays where it is, and the difference to the new
/// space eases out.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienSpaceSolver {
    /// 0 to 2^40.
    pub ease_ticks: i64,
    /// Indices of joints. `MIEN_NO_JOINT`: model space.
    pub spaces: *const u16,
    /// 1 to 8.
    pub space_count: u32,
    /// Of the row: its value, rounded, is an index in `spaces`.
    pub curve: u32,
    pub joint: u32,
    /// 0.
    pub reserved: u32,
}

impl Default for MienSpaceSolver {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// Spring: lets the position of a joint swing about its position in the pose. It is a damped
/// harmonic oscillator in model space, advanced by its exact solution, so it is stable for any
/// time step. Output 0 is its speed, in translation units per second.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienSpringSolver {
    pub joint: u32,
    /// Of the undamped spring, in Hertz; above 0.
    pub frequency: f32,
    /// Damping ratio, 0 or more; 1 is critical damping.
    pub damping: f32,
    /// Rest position relative to the position in the pose, in model space.
    pub rest_offset: [f32; 3],
    /// Largest distance from the rest position. 0: no limit.
    pub stretch: f32,
    /// If the rest position jumps farther than this in a step, the joint jumps with it. 0: never.
    pub teleport: f32,
}

impl Default for MienSpringSolver {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// Twist distribution: gives joints a share of another joint's twist about an axis, in place of
/// their own twist. Output 0 is the sine of half the angle.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienTwistSolver {
    pub joints: *const u16,
    /// One for each of these joints, -1 to 1; 0.5 is half the angle.
    pub shares: *const f32,
    /// 1 to 8.
    pub joint_count: u32,
    /// The joint whose twist is distributed.
    pub source: u32,
    /// In the space of the source and of each joint; not 0 0 0.
    pub axis: [f32; 3],
    /// 0.
    pub reserved: u32,
}

impl Default for MienTwistSolver {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// Copy: gives a joint the motion of another joint relative to its neutral pose, or the mirrored
/// motion.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienCopySolver {
    /// The joint whose motion is copied.
    pub source: u32,
    pub joint: u32,
    /// Mirror the motion.
    pub is_mirrored: u32,
    /// From right to left in model space; 0 0 0: 1 0 0.
    pub mirror_axis: [f32; 3],
    /// 0 to 1.
    pub weight: f32,
}

impl Default for MienCopySolver {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// The data of one character that a MienUserSolver gets.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienSolverPose {
    /// 10 floats per joint: tx ty tz qx qy qz qw sx sy sz, relative to the parent. Joints in
    /// `writes` may be changed; quaternions of any length but 0.
    pub locals: *mut f32,
    /// 16 floats per joint, as in `mien_deformer_instance_joint_matrices()`; up to date for joints
    /// in `reads`.
    pub models: *const f32,
    /// 16 floats for each joint in `previous_joints`, as the last step left it.
    pub previous: *const f32,
    /// MienSolverStackDesc.`curve_count` floats. NULL: there are none.
    pub row: *const f32,
    /// MienUserSolver.`output_count` floats for the caller to read.
    pub outputs: *mut f32,
    /// MienUserSolver.`state_bytes` bytes, aligned to 8; initially zero.
    pub state: *mut c_void,
    pub lod: u32,
    /// The first step, or the character was teleported.
    pub is_reset: u32,
}

impl Default for MienSolverPose {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// The argument of a MienUserSolver.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienSolverCall {
    /// One for each of at most 64 characters.
    pub poses: *const MienSolverPose,
    /// One per joint; a root is its own parent.
    pub parents: *const u16,
    /// Since the last step.
    pub ticks: i64,
    pub pose_count: u32,
    pub joint_count: u32,
}

impl Default for MienSolverCall {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// A custom solver. It runs on the thread that calls the step function, and must not use the
/// handles passed to that function.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienUserSolver {
    /// Passed to the function; must live as long as the stack and its states.
    pub user: *mut c_void,
    /// Changes the locals of the characters in `call`, and their outputs and state, but nothing
    /// else.
    pub solve: Option<unsafe extern "C" fn(user: *mut c_void, call: *const MienSolverCall)>,
    /// Joints whose model matrices it reads.
    pub reads: *const u16,
    /// Joints whose local transforms it changes.
    pub writes: *const u16,
    /// Joints whose model matrices after the last step it reads.
    pub previous_joints: *const u16,
    pub read_count: u32,
    /// 1 or more.
    pub write_count: u32,
    pub previous_joint_count: u32,
    /// 0 to 2^20.
    pub state_bytes: u32,
    /// 0 to 4096.
    pub output_count: u32,
    /// 0.
    pub reserved: u32,
}

impl Default for MienUserSolver {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// One solver: exactly one of the pointers aim ... custom is not NULL.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienSolver {
    /// For messages. NULL: the name of its kind.
    pub name: *const c_char,
    /// May be NULL.
    pub aim: *const MienAimSolver,
    /// May be NULL.
    pub space: *const MienSpaceSolver,
    /// May be NULL.
    pub spring: *const MienSpringSolver,
    /// May be NULL.
    pub twist: *const MienTwistSolver,
    /// May be NULL.
    pub copy: *const MienCopySolver,
    /// May be NULL.
    pub custom: *const MienUserSolver,
    /// Bit l: runs at LOD l. 0: at all LODs.
    pub lods: u64,
}

impl Default for MienSolver {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// How to create a solver stack. Everything is copied.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienSolverStackDesc {
    pub struct_size: usize,
    /// In the order in which they run; at most 256.
    pub solvers: *const MienSolver,
    pub solver_count: usize,
    /// The rows passed to steps have this many curves or more. 0: no row.
    pub curve_count: u32,
    /// Compare all joints before and after each solver, to find undeclared writes:
    /// `mien_solver_state_undeclared()`.
    pub check_writes: u32,
    pub allocator: *const MienAllocator,
}

impl Default for MienSolverStackDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// Properties of a solver stack.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienSolverStackInfo {
    pub struct_size: usize,
    pub solver_count: u32,
    pub curve_count: u32,
    /// Of all solvers.
    pub output_count: u32,
    pub joint_count: u32,
    /// Memory of a state.
    pub state_bytes: u64,
}

impl Default for MienSolverStackInfo {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// How to create a solver state.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienSolverStateDesc {
    pub struct_size: usize,
    pub allocator: *const MienAllocator,
}

impl Default for MienSolverStateDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// The input of the solvers of one character.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienSolverInput {
    /// Such as the one from `mien_mixer_row()`. NULL: none.
    pub row: *const f32,
    /// At least MienSolverStackDesc.`curve_count`.
    pub row_count: usize,
    /// 0 to 63.
    pub lod: u32,
    /// The character was teleported, so springs come to rest and space switches do not ease.
    pub is_reset: u32,
}

impl Default for MienSolverInput {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// A raw control and its share: if the name has the value v, the control gets weight \* v.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienControlShare {
    pub control: u32,
    pub weight: f32,
}

impl Default for MienControlShare {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// What to generate.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienGenerateDesc {
    pub struct_size: usize,
    /// `MIEN_PRESET_...`
    pub preset: u32,
    /// `MIEN_GENERATE_...`, combined with \|.
    pub flags: u32,
    /// The same preset, flags and seed give the same bytes on every machine.
    pub seed: u64,
    pub allocator: *const MienAllocator,
}

impl Default for MienGenerateDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// A named part of the input mesh. It becomes a mesh of the DNA file.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienAuthorObject {
    /// 1 to 200 bytes.
    pub name: MienStringView,
    /// The face after the last one of the object before it.
    pub first_face: u32,
    pub face_count: u32,
}

impl Default for MienAuthorObject {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// An expression. It becomes a raw control of the same name, 0 to 1.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienAuthorShape {
    /// 1 to 200 bytes; all different.
    pub name: MienStringView,
    /// Indices of the positions that move. NULL: all, in order.
    pub positions: *const u32,
    /// Of `positions`, or of the mesh.
    pub position_count: usize,
    /// 3 for each of these positions, with the control at 1.
    pub displacements: *const f64,
}

impl Default for MienAuthorShape {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// A mesh to rig: a head, or the front of one, with everything inside it.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienAuthorMesh {
    pub struct_size: usize,
    /// 3 per position, in the unit and axes of MienAuthorDesc.
    pub positions: *const f64,
    pub position_count: usize,
    /// Corners of each face, 3 or more. NULL: all are triangles.
    pub face_sizes: *const u32,
    pub face_count: usize,
    /// Indices of positions, face by face, counterclockwise seen from outside.
    pub corners: *const u32,
    pub corner_count: usize,
    /// 2 per UV; may be NULL.
    pub uvs: *const f64,
    pub uv_count: usize,
    /// Indices of UVs, one per corner. NULL: no UVs.
    pub corner_uvs: *const u32,
    /// NULL: a single object named "head".
    pub objects: *const MienAuthorObject,
    pub object_count: usize,
    /// May be NULL.
    pub shapes: *const MienAuthorShape,
    pub shape_count: usize,
}

impl Default for MienAuthorMesh {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// A bone placed by the caller.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienAuthorBone {
    /// 1 to 200 bytes; all different.
    pub name: MienStringView,
    /// In the space of the mesh, not relative to the parent.
    pub position: [f64; 3],
    /// Index of an earlier bone; the first bone is its own parent.
    pub parent: u32,
    /// `MIEN_BONE_...`: the first bone is the root, and facial bones are consecutive.
    pub kind: u32,
}

impl Default for MienAuthorBone {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// A point of the face that joints are placed by.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienAuthorLandmark {
    /// "nose" (tip), "throat", "`lip_upper`", "`lip_lower`" (in the middle), "`mouth_l`",
    /// "`mouth_r`" (corners, as the character sees them), "chin", "jaw" (its axis, in the middle
    /// plane), "`eye_l`", "`eye_r`" (centers of the eyeballs), "head", "neck" (pivots).
    pub name: MienStringView,
    /// In the unit and axes of the mesh.
    pub position: [f64; 3],
}

impl Default for MienAuthorLandmark {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// A LOD of the mesh, made by the caller.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienAuthorLod {
    /// Indices of positions of the mesh, three per triangle, all three in the same object. Objects
    /// without triangles are not in the LOD.
    pub corners: *const u32,
    pub corner_count: usize,
    /// Indices of UVs, one per corner. NULL: chosen from the UVs that each position has in the
    /// mesh, so that they are nearest to each other.
    pub corner_uvs: *const u32,
}

impl Default for MienAuthorLod {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// How to rig a mesh. bones, weights, `depth_groups`, mask, `lod_joints`, `bone_groups`,
/// `bone_motions` and `lod_meshes` let the caller provide the result of one stage, which is then
/// skipped.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienAuthorDesc {
    pub struct_size: usize,
    /// 1 to 7000. 0: 240.
    pub facial_joints: u32,
    /// Per position: 1 to 12. 0: 8.
    pub influences: u32,
    /// 1 to 8. 0: 8.
    pub lods: u32,
    /// Depth groups, of which the front one is the face: 2 to 16. 0: 3.
    pub groups: u32,
    /// Of the initial guesses of bone placement.
    pub seed: u64,
    /// Centimeters per unit of the mesh. 0: 1.
    pub unit: f64,
    /// `MIEN_MESH_AXIS_...`
    pub up: u32,
    /// `MIEN_MESH_AXIS_...`, perpendicular to `up`.
    pub front: u32,
    /// `MIEN_SYMMETRY_...`
    pub symmetry: u32,
    /// `MIEN_AUTHOR_...`, combined with \|.
    pub flags: u32,
    /// Of the character; empty: "head".
    pub name: MienStringView,
    /// Name of the object with the face; empty: found automatically.
    pub face_object: MienStringView,
    /// NULL: placed automatically.
    pub bones: *const MienAuthorBone,
    pub bone_count: usize,
    /// Indices of bones, `influences` per position of the mesh. NULL: weights are computed.
    pub weight_joints: *const u16,
    /// The weights for `weight_joints`; both or neither, and only with `bones`.
    pub weights: *const f32,
    /// May be NULL.
    pub parallel: *const MienParallelFor,
    /// Passed to the next function.
    pub progress_user: *mut c_void,
    /// Called on the calling thread with the name of the step that begins and the progress from 0
    /// to 1, which never decreases. Returns 0 to continue; anything else cancels. May be NULL.
    pub progress: Option<unsafe extern "C" fn(user: *mut c_void, step: *const c_char, share: f64) -> i32>,
    pub allocator: *const MienAllocator,
    /// One per position of the mesh: its depth group, less than `groups`, 0 in front. NULL:
    /// computed.
    pub depth_groups: *const u8,
    /// One per position of the mesh: nonzero in the face mask, where facial bones are placed.
    /// NULL: computed.
    pub mask: *const u8,
    /// Maximum number of facial joints in each of `lods` LODs (mirrored pairs stay together);
    /// never increasing, and LOD 0 has all. NULL: 240, 160, 110, 75, 50, 32, 20, 12, scaled to
    /// `facial_joints`.
    pub lod_joints: *const u32,
    /// Joint group of each of `bones`, 0 to 255. NULL: computed.
    pub bone_groups: *const u32,
    /// 6 numbers for each of `bones`, shape by shape, with the control at 1: translation, then
    /// degrees about X, Y, Z, applied in this order, in the unit and axes of the mesh. NULL:
    /// fitted.
    pub bone_motions: *const f64,
    /// 1 to 24. 0: chosen so that each has about 75 rows.
    pub joint_groups: u32,
    /// Maximum number of correctives that damp pairs of shapes with overlapping motion. 0: none.
    pub overlap_correctives: u32,
    /// Share of the triangles of a LOD that the next one keeps: above 0, at most 1. 0: 0.5. 1:
    /// all.
    pub lod_triangles: f64,
    /// LOD 1, LOD 2 and so on. NULL: made according to `lod_triangles`.
    pub lod_meshes: *const MienAuthorLod,
    /// One less than `lods`.
    pub lod_mesh_count: usize,
    /// Used instead of those that are found; each name once, in any order. With "jaw", or a
    /// landmark of the mouth, there is a jaw even if no shape opens it. NULL: all are found.
    pub landmarks: *const MienAuthorLandmark,
    pub landmark_count: usize,
}

impl Default for MienAuthorDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienDocumentDesc {
    pub struct_size: usize,
    pub allocator: *const MienAllocator,
    /// `MIEN_FILE_...`; for `mien_document_open_file()` only.
    pub file_access: u32,
    /// `MIEN_UNKNOWN_LAYERS_...`; for `mien_document_open_file()` only.
    pub unknown_layers: u32,
}

impl Default for MienDocumentDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// How many deltas and targets `mien_document_prune_targets()` removed.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienPrunedTargets {
    pub struct_size: usize,
    pub deltas: u64,
    pub targets: u64,
}

impl Default for MienPrunedTargets {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// The largest magnitudes of entries of the joint matrix that count as small, in the units of the
/// file.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienPruneJointsDesc {
    pub struct_size: usize,
    pub translation: f32,
    pub rotation: f32,
    pub scale: f32,
    /// 0.
    pub reserved: u32,
}

impl Default for MienPruneJointsDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// The effect of `mien_document_prune_joints()`: removed entries, and the largest distance by
/// which a position moved.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienPrunedJoints {
    pub struct_size: usize,
    /// Entries of the joint matrix that were not 0.
    pub entry_count: u64,
    /// Of these, set to 0.
    pub removed_count: u64,
    /// In the unit of the file.
    pub worst_distance: f64,
    /// The raw control at 1, or the corrective whose raw controls were at 1.
    pub worst_control: u32,
    pub worst_mesh: u32,
    pub worst_position: u32,
    pub reserved: u32,
}

impl Default for MienPrunedJoints {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// How to place a character: it is scaled about the origin, then rotated about it, then moved.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienPlacement {
    pub struct_size: usize,
    /// Above 0. 0: 1.
    pub scale: f64,
    /// right-handed degrees about x, then y, then z of the file.
    pub rotation: [f64; 3],
    /// In the unit of the file.
    pub translation: [f64; 3],
}

impl Default for MienPlacement {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// How `mien_document_project()` works.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienProjectDesc {
    pub struct_size: usize,
    /// `MIEN_MATCH_...`
    pub r#match: u32,
    /// At most, per position. 0: 8.
    pub influences: u32,
    /// Leave the skin weights as they are.
    pub keep_weights: u32,
    /// Leave the targets as they are.
    pub keep_targets: u32,
}

impl Default for MienProjectDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// How far the rig moved to follow a mesh.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienConformed {
    pub struct_size: usize,
    /// Largest distance by which a joint moved, in the unit of the file.
    pub joint_distance: f64,
    /// That joint.
    pub joint: u32,
    pub reserved: u32,
}

impl Default for MienConformed {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// How `mien_document_transplant()` works.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienTransplantDesc {
    pub struct_size: usize,
    /// `MIEN_MATCH_...`, for meshes of the same name; positions of the same number correspond if
    /// the meshes have the same faces.
    pub r#match: u32,
    /// At most, per position. 0: 8.
    pub influences: u32,
}

impl Default for MienTransplantDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// How differently a raw control of both rigs, at 1, moves the positions of LOD 0.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienControlError {
    /// Distance of a position, in the unit of the file.
    pub worst: f64,
    pub rms: f64,
    /// Largest distance by which the control moved a position before.
    pub moved: f64,
    /// Its index in the new rig.
    pub control: u32,
    pub reserved: u32,
}

impl Default for MienControlError {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// Takes the bytes of a file, in pieces and in order. `write` is called only during the call that
/// takes the struct, and on the same thread.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienByteSink {
    /// Passed to the function.
    pub user: *mut c_void,
    /// Takes `size` bytes and returns the number of bytes taken; any number but `size` ends the
    /// call.
    pub write: Option<unsafe extern "C" fn(user: *mut c_void, bytes: *const c_void, size: usize) -> usize>,
}

impl Default for MienByteSink {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// A point of a surface: the weighted sum of three positions of a mesh. One position: weights 1 0
/// 0.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienSolvePoint {
    /// Of the rig; points of a fit may be on several meshes.
    pub mesh: u32,
    /// In the order of the file.
    pub positions: [u32; 3],
    pub weights: [f32; 3],
}

impl Default for MienSolvePoint {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// How to create a fit. Everything is copied. Raw controls in a row that are named as the parts x
/// y z w of a quaternion (.qx .qy .qz .qw, or .x .y .z .w), and begin as 0 0 0 1, are a rotation:
/// if all four may move, they keep the length 1, and have no bounds.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienFitDesc {
    pub struct_size: usize,
    /// Of the rig; needed for points and for constraints on joints. NULL: none.
    pub deformer: *const MienDeformer,
    /// Raw controls that may move, ascending. NULL: all.
    pub controls: *const u32,
    /// Bounds of these controls. NULL: 0.
    pub lower: *const f32,
    /// NULL: 1.
    pub upper: *const f32,
    /// Pairs of raw controls kept similar: left, right, left, ...
    pub symmetric: *const u32,
    pub points: *const MienSolvePoint,
    /// Per joint value, 0 or more. NULL: 1 each, or 0 if there are points.
    pub joint_weights: *const f32,
    /// 0 if `controls` is NULL.
    pub control_count: usize,
    /// Elements of `symmetric`, an even number.
    pub symmetric_count: usize,
    pub point_count: usize,
    pub lod: u32,
    /// 0.
    pub reserved: u32,
    /// NULL: the heap.
    pub allocator: *const MienAllocator,
}

impl Default for MienFitDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// How to create a surface. Everything is copied. Its unit and axes are those of the rig;
/// triangles may be wound either way, but all the same way.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienFitSurfaceDesc {
    pub struct_size: usize,
    /// X y z each. Positions in the same place are one, as along texture seams.
    pub positions: *const f32,
    /// Three positions each.
    pub triangles: *const u32,
    pub position_count: usize,
    pub triangle_count: usize,
    /// NULL: the heap.
    pub allocator: *const MienAllocator,
}

impl Default for MienFitSurfaceDesc {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// A pinhole camera: image x = focal\[0\] \* x / z + center\[0\], and y likewise, for the point x
/// y z in camera space, after `rotation` and `translation`. z grows in front of the camera.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienFitCamera {
    pub focal: [f32; 2],
    pub center: [f32; 2],
    /// Rows, from model space. With MienFitFrame.rigid, all 0: unknown.
    pub rotation: [f32; 9],
    pub translation: [f32; 3],
}

impl Default for MienFitCamera {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// A constraint of a frame. A number that is NaN: the constraint is missing.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienFitConstraint {
    /// `MIEN_CONSTRAINT_...`
    pub kind: u32,
    /// Of the rig.
    pub joint: u32,
    /// Places in MienFitDesc.points.
    pub points: [u32; 2],
    /// In the axes of the joint, of any length but 0.
    pub axis: [f32; 3],
    /// A place, or a direction of any length but 0.
    pub target: [f32; 3],
    /// The smallest and the largest that cost nothing.
    pub distances: [f32; 2],
    /// Times the squared residual: of a length in the unit of the rig, or of the difference of
    /// directions of length 1.
    pub weight: f32,
}

impl Default for MienFitConstraint {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// The targets of one frame, and the weights of the terms; terms of weight 0 are left out. Joints,
/// points, images, a surface and constraints may be given together: a point may have a target of
/// each kind. Each kind has a unit of its own: joint values, lengths (points and surface), and
/// that of images.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienFitFrame {
    pub struct_size: usize,
    /// Joint values. NULL: none. NaN: missing.
    pub joints: *const f32,
    /// X y z per point. NULL: none. NaN: missing.
    pub points: *const f32,
    /// X y per point, as `camera` sees them. NULL: none. NaN: missing.
    pub images: *const f32,
    /// Required with `images`.
    pub camera: *const MienFitCamera,
    /// Per point, 0 or more: of points and images. NULL: 1.
    pub point_weights: *const f32,
    /// All raw controls of the rig, to start from. NULL: the initial ones.
    pub start: *const f32,
    /// Raw controls that the result is drawn to. NULL: the initial ones.
    pub prior: *const f32,
    /// Times the squared distance to `prior`.
    pub prior_weight: f32,
    /// Times the squared distance to `start`, the previous frame.
    pub smooth_weight: f32,
    /// Times the sum of magnitudes, from the initial values: few controls explain the frame.
    pub sparse_weight: f32,
    /// Times the squared differences of symmetric pairs.
    pub symmetric_weight: f32,
    /// Points farther off than this, or from the surface, count less. 0: all count fully.
    pub robust_scale: f32,
    /// Weight of the joints relative to the points. 0: 1.
    pub joint_weight: f32,
    /// Points and surface may be rotated and translated as a whole, by one motion. With `images`,
    /// these stay where they are in model space, and the camera is found, from that of `camera`,
    /// or, if its rotation is unknown, from one that sees the face from the front.
    pub rigid: u32,
    /// 0: 50.
    pub max_iterations: u32,
    /// 0: no limit. A limit makes results depend on the machine.
    pub max_seconds: f64,
    /// Passed to `canceled`.
    pub user: *mut c_void,
    /// Called before each iteration; a nonzero result stops. NULL: never.
    pub canceled: Option<unsafe extern "C" fn(user: *mut c_void) -> u32>,
    /// Each point is drawn to the nearest place of the surface that faces the same way, within 60
    /// degrees, and is not at a border. NULL: none.
    pub surface: *const MienFitSurface,
    /// Points farther from the surface have no target. 0: no limit.
    pub surface_reach: f32,
    /// , with `images` and `rigid`: the focal length is found too, its two numbers scaled alike.
    pub focal: u32,
    pub constraint_count: usize,
    /// Up to 64, added to all other targets. NULL: none.
    pub constraints: *const MienFitConstraint,
    /// Per raw control of the rig, up to 15: the solve begins with the controls of stage 0 alone,
    /// then those of stage 1 move too, and so on, as jaw and eyes before the rest. Each stage may
    /// take `max_iterations`. NULL: all move from the start.
    pub stages: *const u32,
    /// X y z per point, in model space: how far the points of the face in the targets are from
    /// those of the rig at rest, where it is another person's. Constraints are about the points of
    /// the rig. NULL: 0.
    pub point_offsets: *const f32,
    /// Per point, 0 or more: how much it is drawn to `surface`. NULL: those of `point_weights`.
    pub surface_weights: *const f32,
    /// Weight of the images relative to the points: of a squared length in the image, against a
    /// squared length in space. 0: 1.
    pub image_weight: f32,
    /// `robust_scale` of images, in their unit. 0: `robust_scale`, or, if there are points or a
    /// surface too, all count fully.
    pub image_robust_scale: f32,
}

impl Default for MienFitFrame {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

/// The result of a solve.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienFitResult {
    pub struct_size: usize,
    /// `MIEN_FIT_...`
    pub status: u32,
    pub iterations: u32,
    /// The minimized sum, with all terms.
    pub cost: f64,
    /// Weighted root mean square of the differences of joint values.
    pub joint_residual: f64,
    /// The same for points; without these, for images in their unit; without both, for the
    /// surface.
    pub point_residual: f64,
    /// With a surface: those that have no target.
    pub missing_points: u32,
    pub reserved: u32,
    /// Rows: points of the target = rotation \* model + translation, if rigid; the camera's with
    /// images.
    pub rotation: [f32; 9],
    pub translation: [f32; 3],
    /// Largest difference of a joint value that counts.
    pub joint_worst: f64,
    /// Largest distance of a point that counts, of the same kind.
    pub point_worst: f64,
    /// Of the camera, with images; else 0.
    pub focal: [f32; 2],
    /// Weighted root mean square of the residuals of constraints.
    pub constraint_residual: f64,
    /// Largest residual of a constraint that counts.
    pub constraint_worst: f64,
    /// Joint values or points moved farther from where they are at `start` than their targets ask
    /// for, as roots of mean squares; those without a target count as such that ask for nothing.
    pub jumped: u32,
    pub reserved_2: u32,
    /// Weighted root mean square of the distances in the image.
    pub image_residual: f64,
    pub image_worst: f64,
    /// The same of the distances from the surface.
    pub surface_residual: f64,
    pub surface_worst: f64,
}

impl Default for MienFitResult {
    /// All zero but `struct_size`: every field has its default.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        let mut zero: Self = unsafe { zeroed() };
        zero.struct_size = size_of::<Self>();
        zero
    }
}

extern "C" {
    /// Returns the `MIEN_VERSION` of the library in use, which may differ from that of this
    /// header.
    pub fn mien_version() -> u32;

    /// Returns "DNA\_TRUNCATED" for `MIEN_ERROR_DNA_TRUNCATED`, and "UNKNOWN" for unknown numbers.
    /// The string is static and null-terminated.
    pub fn mien_status_name(status: MienStatus) -> *const c_char;

    /// Returns the coordinate system of an engine or tool: "maya", "unreal", "unreal-mesh"
    /// (characters look along y), "unity", "godot", "blender", "gltf", "opengl", "directx" or
    /// "houdini". The rotation rule is `MIEN_ROTATION_RULE_CARRIED`; `rotation_sequence` is that
    /// of the engine's Euler angles, and only takes effect if you set another rule.
    ///
    /// Fails with `MIEN_ERROR_NAME` if the name is none of these.
    pub fn mien_coordinate_system_find(name: *const c_char, out_system: *mut MienCoordinateSystem) -> MienStatus;

    /// Returns the coordinate system of an engine or tool: "maya", "unreal", "unreal-mesh"
    /// (characters look along y), "unity", "godot", "blender", "gltf", "opengl", "directx" or
    /// "houdini". The rotation rule is `MIEN_ROTATION_RULE_CARRIED`; `rotation_sequence` is that
    /// of the engine's Euler angles, and only takes effect if you set another rule.
    ///
    /// Fails with `MIEN_ERROR_NAME` if the name is none of these.
    pub fn mien_coordinate_system_find_n(name: *const c_char, name_count: usize, out_system: *mut MienCoordinateSystem) -> MienStatus;

    /// Returns a name that `mien_coordinate_system_find()` accepts. The string is static.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if `index` is past the last name.
    pub fn mien_coordinate_system_name(index: u32, out_name: *mut MienStringView) -> MienStatus;

    /// Opens a DNA file of version 2.1 to 2.8, or the known layers of a later 2.x. Checks
    /// everything that it loads. Close with `mien_dna_close()`.
    ///
    /// Numbers and names stay in the file and are read when needed. Memory is allocated for lists
    /// only: typically a few percent of the size of the loaded layers, at most 20 times their
    /// size. Do not truncate or overwrite a mapped file while it is open; replacing it by renaming
    /// is safe.
    ///
    /// Fails with `MIEN_ERROR_FILE_OPEN` or `MIEN_ERROR_FILE_READ` if the file cannot be read,
    /// `MIEN_ERROR_DNA_SIGNATURE` or `MIEN_ERROR_DNA_VERSION` if it is not a DNA file of
    /// generation 2, `MIEN_ERROR_DNA_TRUNCATED`, `MIEN_ERROR_DNA_STRUCTURE`,
    /// `MIEN_ERROR_DNA_REFERENCE`, `MIEN_ERROR_DNA_LIMIT` or `MIEN_ERROR_DNA_VALUE` if its
    /// contents are not valid or cannot be converted to the requested system, `MIEN_ERROR_LOD` if
    /// it has none of the requested LODs.
    ///
    /// See docs/dna-format.md, 13 "What is checked".
    pub fn mien_dna_open_file(path: *const c_char, desc: *const MienDnaDesc, out_dna: *mut *mut MienDna, error: *mut MienError) -> MienStatus;

    /// Opens a DNA file in memory: `size` bytes, of any alignment. `bytes` must outlive the
    /// MienDna, unchanged.
    ///
    /// Fails like `mien_dna_open_file()`, but not with `MIEN_ERROR_FILE_OPEN` or
    /// `MIEN_ERROR_FILE_READ`.
    pub fn mien_dna_open_memory(bytes: *const c_void, size: usize, desc: *const MienDnaDesc, out_dna: *mut *mut MienDna, error: *mut MienError) -> MienStatus;

    /// Opens a DNA file through a stream. Reads the header, the index and the requested layers,
    /// each with one read, into memory from the allocator.
    ///
    /// Fails like `mien_dna_open_file()`, but not with `MIEN_ERROR_FILE_OPEN`.
    pub fn mien_dna_open_stream(stream: *const MienStream, desc: *const MienDnaDesc, out_dna: *mut *mut MienDna, error: *mut MienError) -> MienStatus;

    /// Closes a DNA. Rigs and deformers created from it stay valid; views into it do not.
    pub fn mien_dna_close(dna: *mut MienDna);

    /// Returns the properties of a DNA.
    pub fn mien_dna_info(dna: *const MienDna, out_info: *mut MienDnaInfo) -> MienStatus;

    /// Returns entry `index` of the index table, in file order.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if `index` is not below MienDnaInfo.`layer_count`.
    ///
    /// See docs/dna-format.md, 4.1 "Index table".
    pub fn mien_dna_layer(dna: *const MienDna, index: u32, out_layer: *mut MienDnaLayer) -> MienStatus;

    /// Finds a field of a loaded layer by its path: the code of the layer, then the names of
    /// fields, with an index after each list.
    ///
    /// ```text
    /// desc.name                                 a string
    /// desc.metadata[0].key                      a string
    /// defn.jointNames                           a list of strings; defn.jointNames[3] is one
    /// defn.neutralJointTranslations.xs          floats
    /// bhvr.joints.jointGroups[7].values         floats
    /// geom.meshes[0].skinWeights[12].weights    floats
    /// mlbh.neuralNetworks[0].layers[1].biases   floats
    /// ```
    ///
    /// Layers that are not loaded are empty.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such field (the message contains the part of
    /// the path that does not exist), `MIEN_ERROR_INDEX` if an index in the path is past the end.
    ///
    /// See docs/dna-format.md, 6 "Layers, field by field".
    pub fn mien_dna_field(dna: *const MienDna, path: *const c_char, out_field: *mut MienDnaField, error: *mut MienError) -> MienStatus;

    /// Finds a field of a loaded layer by its path: the code of the layer, then the names of
    /// fields, with an index after each list.
    ///
    /// ```text
    /// desc.name                                 a string
    /// desc.metadata[0].key                      a string
    /// defn.jointNames                           a list of strings; defn.jointNames[3] is one
    /// defn.neutralJointTranslations.xs          floats
    /// bhvr.joints.jointGroups[7].values         floats
    /// geom.meshes[0].skinWeights[12].weights    floats
    /// mlbh.neuralNetworks[0].layers[1].biases   floats
    /// ```
    ///
    /// Layers that are not loaded are empty.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such field (the message contains the part of
    /// the path that does not exist), `MIEN_ERROR_INDEX` if an index in the path is past the end.
    ///
    /// See docs/dna-format.md, 6 "Layers, field by field".
    pub fn mien_dna_field_n(dna: *const MienDna, path: *const c_char, path_count: usize, out_field: *mut MienDnaField, error: *mut MienError) -> MienStatus;

    /// Returns the name of field `index` of the record at a path. The empty path is the file
    /// itself, whose fields are the layers. The string is static.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such field, `MIEN_ERROR_INDEX` if `index` or an
    /// index in the path is past the end, `MIEN_ERROR_INVALID_ARGUMENT` if the field is not a
    /// record.
    ///
    /// See docs/dna-format.md, 6 "Layers, field by field".
    pub fn mien_dna_child_name(dna: *const MienDna, path: *const c_char, index: u32, out_name: *mut MienStringView, error: *mut MienError) -> MienStatus;

    /// Returns the name of field `index` of the record at a path. The empty path is the file
    /// itself, whose fields are the layers. The string is static.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such field, `MIEN_ERROR_INDEX` if `index` or an
    /// index in the path is past the end, `MIEN_ERROR_INVALID_ARGUMENT` if the field is not a
    /// record.
    ///
    /// See docs/dna-format.md, 6 "Layers, field by field".
    pub fn mien_dna_child_name_n(dna: *const MienDna, path: *const c_char, path_count: usize, index: u32, out_name: *mut MienStringView, error: *mut MienError) -> MienStatus;

    /// Copies `count` elements of a field, beginning with element `first`, to `out`, in native
    /// byte order. A field that is one number has one element. `out` may be NULL if `count` is 0.
    /// Integers are widened to 64 bits.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such field, `MIEN_ERROR_INDEX` if the range or
    /// an index in the path is past the end, `MIEN_ERROR_INVALID_ARGUMENT` if the field does not
    /// hold numbers of this kind.
    pub fn mien_dna_read_floats(dna: *const MienDna, path: *const c_char, first: u64, count: u64, out: *mut f32, error: *mut MienError) -> MienStatus;

    /// Copies `count` elements of a field, beginning with element `first`, to `out`, in native
    /// byte order. A field that is one number has one element. `out` may be NULL if `count` is 0.
    /// Integers are widened to 64 bits.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such field, `MIEN_ERROR_INDEX` if the range or
    /// an index in the path is past the end, `MIEN_ERROR_INVALID_ARGUMENT` if the field does not
    /// hold numbers of this kind.
    pub fn mien_dna_read_floats_n(dna: *const MienDna, path: *const c_char, path_count: usize, first: u64, count: u64, out: *mut f32, error: *mut MienError) -> MienStatus;

    /// Copies `count` elements of a field, beginning with element `first`, to `out`, in native
    /// byte order. A field that is one number has one element. `out` may be NULL if `count` is 0.
    /// Integers are widened to 64 bits.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such field, `MIEN_ERROR_INDEX` if the range or
    /// an index in the path is past the end, `MIEN_ERROR_INVALID_ARGUMENT` if the field does not
    /// hold numbers of this kind.
    pub fn mien_dna_read_integers(dna: *const MienDna, path: *const c_char, first: u64, count: u64, out: *mut i64, error: *mut MienError) -> MienStatus;

    /// Copies `count` elements of a field, beginning with element `first`, to `out`, in native
    /// byte order. A field that is one number has one element. `out` may be NULL if `count` is 0.
    /// Integers are widened to 64 bits.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such field, `MIEN_ERROR_INDEX` if the range or
    /// an index in the path is past the end, `MIEN_ERROR_INVALID_ARGUMENT` if the field does not
    /// hold numbers of this kind.
    pub fn mien_dna_read_integers_n(dna: *const MienDna, path: *const c_char, path_count: usize, first: u64, count: u64, out: *mut i64, error: *mut MienError) -> MienStatus;

    /// Returns a string of the file.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such field, `MIEN_ERROR_INDEX` if an index in
    /// the path is past the end, `MIEN_ERROR_INVALID_ARGUMENT` if the field is not a string.
    pub fn mien_dna_read_string(dna: *const MienDna, path: *const c_char, out_string: *mut MienStringView, error: *mut MienError) -> MienStatus;

    /// Returns a string of the file.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such field, `MIEN_ERROR_INDEX` if an index in
    /// the path is past the end, `MIEN_ERROR_INVALID_ARGUMENT` if the field is not a string.
    pub fn mien_dna_read_string_n(dna: *const MienDna, path: *const c_char, path_count: usize, out_string: *mut MienStringView, error: *mut MienError) -> MienStatus;

    /// Writes a DNA file in canonical form: byte for byte the original if that was canonical and
    /// was loaded completely. Layers that were not loaded are written empty. Another version may
    /// lack layers that others need, such as the ML operations of networks; a file that could not
    /// be opened again is never written. The file is written under a temporary name and renamed,
    /// so that a failure leaves `path` unchanged. An existing file keeps its permissions; a
    /// symbolic link is followed, unless it leads nowhere.
    ///
    /// Fails with `MIEN_ERROR_FILE_WRITE` if the file cannot be written, `MIEN_ERROR_DNA_LAYER` if
    /// RBF behavior was loaded without the machine-learned behavior of its file (whose controls
    /// are numbered before its own), `MIEN_ERROR_DNA_STRUCTURE`, `MIEN_ERROR_DNA_REFERENCE` or
    /// `MIEN_ERROR_DNA_VALUE` if the file could not be opened in the requested version,
    /// `MIEN_ERROR_DNA_LIMIT` if it would exceed 4 GiB, `MIEN_ERROR_MEMORY` if the allocator of
    /// the DNA returns NULL.
    ///
    /// See docs/dna-format.md, 14 "Writing a canonical file".
    pub fn mien_dna_write_file(dna: *const MienDna, path: *const c_char, desc: *const MienWriteDesc, error: *mut MienError) -> MienStatus;

    /// Writes a DNA file to memory and returns its size in `out_size`. `buffer` may be NULL with
    /// capacity 0 to get the size only. Writes nothing if `capacity` is too small; `out_size` is
    /// set nevertheless.
    ///
    /// Fails like `mien_dna_write_file()`, but not with `MIEN_ERROR_FILE_WRITE`, and with
    /// `MIEN_ERROR_INVALID_ARGUMENT` if `capacity` is too small.
    pub fn mien_dna_write_memory(dna: *const MienDna, desc: *const MienWriteDesc, buffer: *mut c_void, capacity: usize, out_size: *mut usize, error: *mut MienError) -> MienStatus;

    /// Checks all layers of a file and collects the findings: at most 32 per field and 1000 in
    /// total; the last one tells whether there are more. Returns `MIEN_OK` if the file could be
    /// checked, whatever was found. The file is read into memory first, so it may change during
    /// the call. Destroy with `mien_report_destroy()`.
    ///
    /// Fails with `MIEN_ERROR_FILE_OPEN` or `MIEN_ERROR_FILE_READ` if the file cannot be read.
    ///
    /// See docs/dna-format.md, 13 "What is checked".
    pub fn mien_dna_validate_file(path: *const c_char, desc: *const MienValidateDesc, out_report: *mut *mut MienReport, error: *mut MienError) -> MienStatus;

    /// Checks a file in memory: `size` bytes. `bytes` may be released afterwards.
    pub fn mien_dna_validate_memory(bytes: *const c_void, size: usize, desc: *const MienValidateDesc, out_report: *mut *mut MienReport, error: *mut MienError) -> MienStatus;

    /// Returns the number of errors and the number of warnings.
    pub fn mien_report_counts(report: *const MienReport, out_errors: *mut u32, out_warnings: *mut u32) -> MienStatus;

    /// Returns finding `index`, in the order of the checks. Their number is that of errors plus
    /// warnings.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if `index` is past the last finding.
    pub fn mien_report_finding(report: *const MienReport, index: u32, out_finding: *mut MienFinding) -> MienStatus;

    /// Destroys a report.
    pub fn mien_report_destroy(report: *mut MienReport);

    /// Returns 1 if rigs can be created for instruction set `isa` on this machine, else 0.
    pub fn mien_isa_available(isa: u32) -> u32;

    /// Returns "avx2" for `MIEN_ISA_AVX2`, and so on; "unknown" for unknown numbers. The string is
    /// static and null-terminated.
    pub fn mien_isa_name(isa: u32) -> *const c_char;

    /// Packs the behavior of a DNA for evaluation. The rig is one block of memory, or two with
    /// `MIEN_REUSE_SUMS`; temporary memory is released before the call returns. `dna` may be
    /// closed afterwards. Destroy with `mien_rig_destroy()`.
    ///
    /// Fails with `MIEN_ERROR_DNA_LAYER` if `dna` was opened without its behavior,
    /// `MIEN_ERROR_DNA_VALUE` if correctives depend on each other in a cycle,
    /// `MIEN_ERROR_DNA_LIMIT` if the rig is too large, `MIEN_ERROR_ISA` if the requested
    /// instruction set is not available.
    ///
    /// See docs/rig-evaluation.md and docs/dna-format.md, 13 "What is checked".
    pub fn mien_rig_create(dna: *const MienDna, desc: *const MienRigDesc, out_rig: *mut *mut MienRig, error: *mut MienError) -> MienStatus;

    /// Destroys a rig. The handle is invalid afterwards, but instances, batches and deformers of
    /// the rig may be destroyed later: its memory is released with the last of them.
    pub fn mien_rig_destroy(rig: *mut MienRig);

    /// Returns the properties of a rig.
    pub fn mien_rig_info(rig: *const MienRig, out_info: *mut MienRigInfo) -> MienStatus;

    /// Returns the number of parts of a kind.
    pub fn mien_rig_count(rig: *const MienRig, kind: u32, out_count: *mut u32) -> MienStatus;

    /// Returns a name; "" for kinds without names.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if `index` is not below `mien_rig_count()`.
    pub fn mien_rig_name(rig: *const MienRig, kind: u32, index: u32, out_name: *mut MienStringView) -> MienStatus;

    /// Finds the index of a name by exact match; of equal names, the first. Takes O(log n) time.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such name, `MIEN_ERROR_INVALID_ARGUMENT` if
    /// `kind` has no names.
    pub fn mien_rig_find(rig: *const MienRig, kind: u32, name: *const c_char, out_index: *mut u32) -> MienStatus;

    /// Finds the index of a name by exact match; of equal names, the first. Takes O(log n) time.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such name, `MIEN_ERROR_INVALID_ARGUMENT` if
    /// `kind` has no names.
    pub fn mien_rig_find_n(rig: *const MienRig, kind: u32, name: *const c_char, name_count: usize, out_index: *mut u32) -> MienStatus;

    /// Returns the indices of the joints, blend shape channels, animated maps, meshes or RBF
    /// solvers that a LOD lists, in file order.
    ///
    /// Fails with `MIEN_ERROR_LOD` if the rig has no such LOD, `MIEN_ERROR_INVALID_ARGUMENT` if
    /// `kind` is not one of these five.
    ///
    /// See docs/dna-format.md, 8.2 "LOD mappings".
    pub fn mien_rig_lod_indices(rig: *const MienRig, kind: u32, lod: u32, out_indices: *mut MienIndex16View) -> MienStatus;

    /// Returns the indices of the joint values that evaluation may change at a LOD, ascending. All
    /// others keep their initial value: 0, or 1 for the w of a quaternion.
    ///
    /// Fails with `MIEN_ERROR_LOD` if the rig has no such LOD.
    ///
    /// See docs/rig-evaluation.md, 4.10 "Which joint values a LOD may change".
    pub fn mien_rig_variable_joint_values(rig: *const MienRig, lod: u32, out_indices: *mut MienIndex16View) -> MienStatus;

    /// Returns the parents of the joints, one index per joint. A root is its own parent.
    pub fn mien_rig_joint_parents(rig: *const MienRig, out_parents: *mut MienIndex16View) -> MienStatus;

    /// Returns the neutral pose, relative to the parents: 9 or 10 floats per joint, in the order
    /// of the joint values. The scale is 1.
    ///
    /// See docs/rig-evaluation.md, 4.2 "Neutral pose".
    pub fn mien_rig_neutral_joint_values(rig: *const MienRig, out_values: *mut MienFloatView) -> MienStatus;

    /// Returns the controls whose product is corrective `psd`, as indices into the control vector.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if there is no such corrective.
    ///
    /// See docs/rig-evaluation.md, 3.1 "Weights and inputs".
    pub fn mien_rig_psd_inputs(rig: *const MienRig, psd: u32, out_controls: *mut MienIndex16View) -> MienStatus;

    /// Returns the initial values of the raw controls, one float per raw control: 0, or 1 for the
    /// w of a quaternion.
    ///
    /// See docs/rig-evaluation.md, 1.2 "Initial values".
    pub fn mien_rig_initial_raw_controls(rig: *const MienRig, out_values: *mut MienFloatView) -> MienStatus;

    /// Returns the statistics of a LOD.
    ///
    /// Fails with `MIEN_ERROR_LOD` if the rig has no such LOD.
    ///
    /// See docs/rig-evaluation.md, 9.6 "Statistics".
    pub fn mien_rig_statistics(rig: *const MienRig, lod: u32, out_statistics: *mut MienRigStatistics) -> MienStatus;

    /// Creates an instance in its initial state: one allocation of MienRigInfo.`instance_bytes`.
    /// `rig` may be destroyed before it. Destroy with `mien_instance_destroy()`.
    ///
    /// See docs/rig-evaluation.md, 9.2 "Instances".
    pub fn mien_instance_create(rig: *const MienRig, desc: *const MienInstanceDesc, out_instance: *mut *mut MienInstance, error: *mut MienError) -> MienStatus;

    /// Destroys an instance.
    pub fn mien_instance_destroy(instance: *mut MienInstance);

    /// Resets an instance to its initial state: all inputs and results, at LOD 0.
    ///
    /// See docs/rig-evaluation.md, 1.2 "Initial values".
    pub fn mien_instance_reset(instance: *mut MienInstance) -> MienStatus;

    /// Returns the GUI controls for the caller to write: one float per GUI control. Only
    /// `mien_rig_map_gui_to_raw()` reads them.
    ///
    /// Contents change with `mien_rig_map_raw_to_gui()`, `mien_instance_reset()`.
    pub fn mien_instance_gui_controls(instance: *mut MienInstance, out_view: *mut MienMutableFloatView) -> MienStatus;

    /// Returns the raw controls for the caller to write: one float per raw control, typically 0 to
    /// 1, not clamped. They are the inputs of evaluation.
    ///
    /// Contents change with `mien_rig_map_gui_to_raw()`, `mien_instance_reset()`.
    pub fn mien_instance_raw_controls(instance: *mut MienInstance, out_view: *mut MienMutableFloatView) -> MienStatus;

    /// Returns the region masks for the caller to write: one float per region of each mesh, 0 to
    /// 1, initially 1. They switch or blend machine-learned behavior (`MIEN_ML_MASKS_...`).
    ///
    /// Contents change with `mien_instance_reset()`.
    ///
    /// See docs/rig-evaluation.md, 8.5 "Region masks".
    pub fn mien_instance_ml_masks(instance: *mut MienInstance, out_view: *mut MienMutableFloatView) -> MienStatus;

    /// Returns the control vector: one float per control, the raw, PSD, ML and RBF controls in
    /// this order.
    ///
    /// Contents change with evaluation, `mien_rig_map_gui_to_raw()`, `mien_instance_reset()` and
    /// writes to the raw controls.
    ///
    /// See docs/rig-evaluation.md, 1.1 "Control vector".
    pub fn mien_instance_controls(instance: *const MienInstance, out_view: *mut MienFloatView) -> MienStatus;

    /// Returns the PSD controls (correctives) of the control vector: one float per PSD control.
    ///
    /// Contents change with evaluation, `mien_instance_reset()`.
    pub fn mien_instance_psd_controls(instance: *const MienInstance, out_view: *mut MienFloatView) -> MienStatus;

    /// Returns the ML controls of the control vector: one float per ML control.
    ///
    /// Contents change with evaluation, `mien_instance_reset()`.
    pub fn mien_instance_ml_controls(instance: *const MienInstance, out_view: *mut MienFloatView) -> MienStatus;

    /// Returns the RBF pose controls of the control vector: one float per RBF control.
    ///
    /// Contents change with evaluation, `mien_instance_reset()`.
    pub fn mien_instance_rbf_controls(instance: *const MienInstance, out_view: *mut MienFloatView) -> MienStatus;

    /// Returns the joint values: 9 or 10 floats per joint (`MIEN_ROTATION_OUTPUT_...`), as deltas
    /// from the neutral pose. Translation, angles and scale are added to the neutral ones; with
    /// quaternions the rotation is neutral \* delta, so the delta rotates first.
    ///
    /// Contents change with evaluation, `mien_instance_reset()`.
    ///
    /// See docs/rig-evaluation.md, 4.1 "Joint values".
    pub fn mien_instance_joints(instance: *const MienInstance, out_view: *mut MienFloatView) -> MienStatus;

    /// Returns the weights of the blend shape channels: one float per channel.
    ///
    /// Contents change with evaluation, `mien_instance_reset()`.
    ///
    /// See docs/rig-evaluation.md, 5 "Blend shapes and animated maps".
    pub fn mien_instance_blend_shapes(instance: *const MienInstance, out_view: *mut MienFloatView) -> MienStatus;

    /// Returns the weights of the animated maps, 0 to 1: one float per animated map.
    ///
    /// Contents change with evaluation, `mien_instance_reset()`.
    ///
    /// See docs/rig-evaluation.md, 5 "Blend shapes and animated maps".
    pub fn mien_instance_animated_maps(instance: *const MienInstance, out_view: *mut MienFloatView) -> MienStatus;

    /// Returns the statistics of an instance. Takes time proportional to the number of controls:
    /// meant for measurements, not for every frame.
    ///
    /// See docs/rig-evaluation.md, 9.6 "Statistics".
    pub fn mien_instance_statistics(instance: *const MienInstance, out_statistics: *mut MienInstanceStatistics) -> MienStatus;

    /// Maps GUI controls to raw controls. Raw controls that the rig's table drives are overwritten
    /// with values clamped to 0..1; others are left unchanged. Does not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_MISMATCH` if `instance` belongs to another rig.
    ///
    /// See docs/rig-evaluation.md, 2.3 "GUI controls to raw controls".
    pub fn mien_rig_map_gui_to_raw(rig: *const MienRig, instance: *mut MienInstance) -> MienStatus;

    /// Maps raw controls to GUI controls. Sets every GUI control to the value that maps to the
    /// current raw controls, or to 0 if there is no such value. Does not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_MISMATCH` if `instance` belongs to another rig.
    ///
    /// See docs/rig-evaluation.md, 2.4 "Raw controls to GUI controls".
    pub fn mien_rig_map_raw_to_gui(rig: *const MienRig, instance: *mut MienInstance) -> MienStatus;

    /// Evaluates all stages at a LOD. Results that the LOD does not drive have their initial
    /// value. Inputs must be finite; then the results are finite too. Changing the LOD between
    /// calls is cheap: it resets the results. Does not allocate or lock. Uses up to 48 KiB of
    /// stack.
    ///
    /// Fails with `MIEN_ERROR_LOD` if the rig has no such LOD, `MIEN_ERROR_MISMATCH` if `instance`
    /// belongs to another rig.
    ///
    /// See docs/rig-evaluation.md, 1.3 "Order of evaluation".
    pub fn mien_rig_evaluate(rig: *const MienRig, instance: *mut MienInstance, lod: u32) -> MienStatus;

    /// Evaluates some stages, in the order of enum MienStage. The others keep the results of the
    /// last evaluation at this LOD; after a change of LOD they are reset. Does not allocate or
    /// lock. Uses up to 48 KiB of stack.
    ///
    /// Fails with `MIEN_ERROR_LOD` if the rig has no such LOD, `MIEN_ERROR_MISMATCH` if `instance`
    /// belongs to another rig.
    ///
    /// See docs/rig-evaluation.md, 9.3 "Partial evaluation".
    pub fn mien_rig_evaluate_stages(rig: *const MienRig, instance: *mut MienInstance, lod: u32, stages: u32) -> MienStatus;

    /// Creates a batch: one allocation of `mien_batch_bytes()`, which with 16-bit storage includes
    /// the weights of networks as floats, 4 bytes each. `rig` may be destroyed before it. Destroy
    /// with `mien_batch_destroy()`.
    pub fn mien_batch_create(rig: *const MienRig, desc: *const MienBatchDesc, out_batch: *mut *mut MienBatch, error: *mut MienError) -> MienStatus;

    /// Destroys a batch.
    pub fn mien_batch_destroy(batch: *mut MienBatch);

    /// Returns the memory that a batch would take.
    pub fn mien_batch_bytes(rig: *const MienRig, desc: *const MienBatchDesc, out_bytes: *mut u64) -> MienStatus;

    /// Evaluates stages of `count` different instances of one rig; instance i at LOD lods\[i\].
    /// The results are bit-identical to those of `mien_rig_evaluate_stages()` (joint values with
    /// `MIEN_REUSE_SUMS`: within the bound of a full evaluation), but columns of the joint matrix
    /// that several instances use are read only once for up to 32 of them. Runs on the calling
    /// thread, or in tasks on `parallel`; `parallel` may be NULL. Does not allocate or lock. Uses
    /// up to 48 KiB of stack per task. On failure no instance is evaluated.
    ///
    /// Fails with `MIEN_ERROR_LOD` if the rig has no such LOD, `MIEN_ERROR_MISMATCH` if the batch
    /// or an instance belongs to another rig, `MIEN_ERROR_INVALID_ARGUMENT` if `count` exceeds
    /// MienBatchDesc.capacity or an instance is listed twice.
    ///
    /// See docs/numbers.md, 10 "One by one, in batches, with reused results".
    pub fn mien_rig_evaluate_batch(rig: *const MienRig, batch: *mut MienBatch, instances: *const *mut MienInstance, lods: *const u32, count: u32, stages: u32, parallel: *const MienParallelFor) -> MienStatus;

    /// Evaluates the joint values of one joint group (`MIEN_KIND_JOINT_GROUP`), except those that
    /// a later group overrides at all LODs where this one sets them. Does not allocate or lock.
    /// Uses up to 48 KiB of stack.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if there is no such joint group, `MIEN_ERROR_LOD` if the rig
    /// has no such LOD, `MIEN_ERROR_MISMATCH` if `instance` belongs to another rig.
    ///
    /// See docs/rig-evaluation.md, 4.5 "Order of the joint stage".
    pub fn mien_rig_evaluate_joint_group(rig: *const MienRig, instance: *mut MienInstance, lod: u32, group: u32) -> MienStatus;

    /// Evaluates the pose controls of one RBF solver (`MIEN_KIND_RBF_SOLVER`), even if the LOD
    /// does not list it. Does not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if there is no such solver, `MIEN_ERROR_LOD` if the rig has
    /// no such LOD, `MIEN_ERROR_MISMATCH` if `instance` belongs to another rig.
    ///
    /// See docs/rig-evaluation.md, 6 "RBF solvers".
    pub fn mien_rig_evaluate_rbf_solver(rig: *const MienRig, instance: *mut MienInstance, lod: u32, solver: u32) -> MienStatus;

    /// Evaluates the joints of one twist and swing setup (`MIEN_KIND_TWIST_SWING`). Does not
    /// allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if there is no such setup, `MIEN_ERROR_LOD` if the rig has no
    /// such LOD, `MIEN_ERROR_MISMATCH` if `instance` belongs to another rig.
    ///
    /// See docs/rig-evaluation.md, 7 "Twist and swing".
    pub fn mien_rig_evaluate_twist_swing(rig: *const MienRig, instance: *mut MienInstance, lod: u32, setup: u32) -> MienStatus;

    /// Packs the geometry of a DNA for deformation. `dna` is the one that the rig was created
    /// from, or the same file opened with the same LODs. `dna` may be closed and `rig` may be
    /// destroyed afterwards. The deformer is one block of memory; temporary memory is released
    /// before the call returns. Destroy with `mien_deformer_destroy()`.
    ///
    /// Influences of weight 0 and faces of fewer than three corners are dropped. Meshes may lack
    /// faces, weights, normals or texture coordinates: missing normals are computed from the
    /// faces, missing texture coordinates are 0. Stored normals determine which side of a face is
    /// outside; without them, the winding and the axes of the file do.
    ///
    /// Fails with `MIEN_ERROR_DNA_LAYER` if `dna` was opened without `MIEN_LAYER_GEOMETRY`,
    /// `MIEN_ERROR_MISMATCH` if the number or the names of joints, channels or meshes differ from
    /// those of the rig, `MIEN_ERROR_DNA_VALUE` if a joint is its own ancestor or a position,
    /// delta or weight is not finite, `MIEN_ERROR_DNA_LIMIT` if a position has more than 65535
    /// influences, `MIEN_ERROR_ISA` if the requested instruction set is not available,
    /// `MIEN_ERROR_INVALID_ARGUMENT` if `delta_error` is negative or not finite.
    ///
    /// See docs/deformation.md.
    pub fn mien_deformer_create(dna: *const MienDna, rig: *const MienRig, desc: *const MienDeformerDesc, out_deformer: *mut *mut MienDeformer, error: *mut MienError) -> MienStatus;

    /// Creates a deformer of some positions of one mesh. Position i of that mesh is `positions[i]`
    /// of the mesh of `deformer`; it has no vertices or triangles, and all other meshes are empty.
    /// Deformed positions have the bits of the whole mesh (with 16-bit storage they may be rounded
    /// otherwise), derivatives those of the chosen rows, and both take time for the chosen
    /// positions only. `positions` are ascending, `position_count` of them. `deformer` may be
    /// destroyed afterwards; the new one keeps its memory. Destroy with `mien_deformer_destroy()`.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if there is no such mesh or position,
    /// `MIEN_ERROR_INVALID_ARGUMENT` if positions are not ascending.
    pub fn mien_deformer_create_subset(deformer: *const MienDeformer, mesh: u32, positions: *const u32, position_count: usize, allocator: *const MienAllocator, out_deformer: *mut *mut MienDeformer, error: *mut MienError) -> MienStatus;

    /// Destroys a deformer. Its instances stay valid; its memory is released with the last of
    /// them.
    pub fn mien_deformer_destroy(deformer: *mut MienDeformer);

    /// Returns the properties of a deformer.
    pub fn mien_deformer_info(deformer: *const MienDeformer, out_info: *mut MienDeformerInfo) -> MienStatus;

    /// Returns a neutral mesh.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if there is no such mesh.
    pub fn mien_deformer_mesh(deformer: *const MienDeformer, mesh: u32, out_mesh: *mut MienMesh) -> MienStatus;

    /// Writes the triangles of a mesh to `out_triangles`: 3 indices per triangle, as in
    /// MienMesh.triangles, with any storage. `count` is the capacity of `out_triangles`, in
    /// indices. With 16-bit storage takes memory for the duration of the call, 4 bytes per
    /// position, from the allocator of the deformer.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if there is no such mesh, `MIEN_ERROR_INVALID_ARGUMENT` if
    /// `count` is less than 3 \* MienMesh.`triangle_count`, `MIEN_ERROR_MEMORY` if memory ran out.
    pub fn mien_deformer_triangles(deformer: *const MienDeformer, mesh: u32, out_triangles: *mut u32, count: usize) -> MienStatus;

    /// Writes the texture coordinates of a mesh to `out_coordinates`: 2 floats per vertex, u v,
    /// with any storage. With 16-bit storage they are off by at most 1/131070 of the range of the
    /// mesh. `count` is the capacity of `out_coordinates`, in floats.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if there is no such mesh, `MIEN_ERROR_INVALID_ARGUMENT` if
    /// `count` is less than 2 \* MienMesh.`vertex_count`.
    pub fn mien_deformer_texture_coordinates(deformer: *const MienDeformer, mesh: u32, out_coordinates: *mut f32, count: usize) -> MienStatus;

    /// Returns the influences of a position, as used for skinning: `out_joints` gets one index per
    /// influence, `out_weights` gets one float per influence. There may be none.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if there is no such mesh or position,
    /// `MIEN_ERROR_UNSUPPORTED` if the weights are stored with 16 bits (MienDeformerDesc.storage).
    pub fn mien_deformer_influences(deformer: *const MienDeformer, mesh: u32, position: u32, out_joints: *mut MienIndex16View, out_weights: *mut MienFloatView) -> MienStatus;

    /// Writes a blend shape target to `out_deltas`: 3 floats per position, the offset at channel
    /// weight 1. Positions that the target does not move get 0. `count` is the capacity of
    /// `out_deltas`, in floats.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if there is no such mesh or target,
    /// `MIEN_ERROR_INVALID_ARGUMENT` if `count` is less than 3 \* MienMesh.`position_count`.
    pub fn mien_deformer_target(deformer: *const MienDeformer, mesh: u32, target: u32, out_deltas: *mut f32, count: usize) -> MienStatus;

    /// Returns the model matrices of the neutral pose: 16 floats per joint, column by column, for
    /// column vectors. The last column is the translation, the last row 0 0 0 1.
    pub fn mien_deformer_bind_matrices(deformer: *const MienDeformer, out_matrices: *mut MienFloatView) -> MienStatus;

    /// Returns the inverses of the bind matrices: 16 floats per joint, column by column.
    pub fn mien_deformer_inverse_bind_matrices(deformer: *const MienDeformer, out_matrices: *mut MienFloatView) -> MienStatus;

    /// Creates a deformer instance in the neutral pose: one allocation. `deformer` may be
    /// destroyed before it. Destroy with `mien_deformer_instance_destroy()`.
    pub fn mien_deformer_instance_create(deformer: *const MienDeformer, desc: *const MienDeformerInstanceDesc, out_deformer_instance: *mut *mut MienDeformerInstance, error: *mut MienError) -> MienStatus;

    /// Destroys a deformer instance.
    pub fn mien_deformer_instance_destroy(deformer_instance: *mut MienDeformerInstance);

    /// Copies the joint values and channel weights of the last evaluation of `instance`, and
    /// computes the matrices of all joints. `mien_deformer_instance_deform()` then deforms meshes.
    /// Values that are not finite give results that are not finite. Does not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_MISMATCH` if `instance` belongs to a rig other than that of the
    /// deformer.
    ///
    /// See docs/deformation.md, 1 "Joint transforms".
    pub fn mien_deformer_instance_update(deformer_instance: *mut MienDeformerInstance, instance: *const MienInstance) -> MienStatus;

    /// Does the same with arrays: `joint_values` like those of `mien_instance_joints()`,
    /// `channel_weights` one per channel. `joint_values` may be NULL with count 0: no deltas.
    /// `channel_weights` may be NULL with count 0: all weights are 0. Does not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if a count is not that of the rig.
    pub fn mien_deformer_instance_update_from_values(deformer_instance: *mut MienDeformerInstance, joint_values: *const f32, joint_value_count: usize, channel_weights: *const f32, channel_weight_count: usize) -> MienStatus;

    /// Returns the model matrices: 16 floats per joint, in the layout of
    /// `mien_deformer_bind_matrices()`.
    ///
    /// Contents change with `mien_deformer_instance_update()`,
    /// `mien_deformer_instance_update_from_values()`.
    pub fn mien_deformer_instance_joint_matrices(deformer_instance: *const MienDeformerInstance, out_matrices: *mut MienFloatView) -> MienStatus;

    /// Returns the skin matrices, for skinning by the caller, for example on a GPU: 16 floats per
    /// joint, in the layout of `mien_deformer_bind_matrices()`.
    ///
    /// Contents change with `mien_deformer_instance_update()`,
    /// `mien_deformer_instance_update_from_values()`.
    pub fn mien_deformer_instance_skin_matrices(deformer_instance: *const MienDeformerInstance, out_matrices: *mut MienFloatView) -> MienStatus;

    /// Writes the joint transforms of the last update, relative to the parents, to
    /// `out_transforms`: 10 floats per joint, tx ty tz qx qy qz qw sx sy sz, with quaternions of
    /// unit length. `count` is the capacity of `out_transforms`, in floats. Does not allocate or
    /// lock.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if `count` is less than 10 \*
    /// MienDeformerInfo.`joint_count`.
    pub fn mien_deformer_instance_local_transforms(deformer_instance: *const MienDeformerInstance, out_transforms: *mut f32, count: usize) -> MienStatus;

    /// Computes the positions and normals of a mesh for the last update. Runs on the calling
    /// thread; meshes of at least 16384 positions run in tasks of about 1024 on `parallel`.
    /// `parallel` may be NULL. The results have the same bits either way. Does not allocate or
    /// lock. Uses up to 16 KiB of stack per task.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if there is no such mesh, `MIEN_ERROR_LOD` if
    /// `deformer_instance` has no memory for it (MienDeformerInstanceDesc.lods).
    ///
    /// See docs/deformation.md, 2 "Positions" and 3 "Normals".
    pub fn mien_deformer_instance_deform(deformer_instance: *mut MienDeformerInstance, mesh: u32, normals: u32, parallel: *const MienParallelFor) -> MienStatus;

    /// Deforms the same mesh of `count` different instances of one deformer. The results are
    /// bit-identical to those of `mien_deformer_instance_deform()`, but each part of the mesh is
    /// read only once for all of them, and the total number of positions decides whether tasks are
    /// used. `parallel` may be NULL. Does not allocate or lock. Uses up to 16 KiB of stack per
    /// task. On failure nothing is deformed.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if there is no such mesh, `MIEN_ERROR_LOD` if an instance has
    /// no memory for it, `MIEN_ERROR_MISMATCH` if the instances have different deformers,
    /// `MIEN_ERROR_INVALID_ARGUMENT` if an instance is listed twice.
    pub fn mien_deformer_instance_deform_batch(deformer_instances: *const *mut MienDeformerInstance, count: usize, mesh: u32, normals: u32, parallel: *const MienParallelFor) -> MienStatus;

    /// Returns the deformed positions of a mesh: 3 floats per position, x y z.
    ///
    /// Contents change with `mien_deformer_instance_deform()`,
    /// `mien_deformer_instance_write_vertices()` and their batches.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if there is no such mesh, `MIEN_ERROR_LOD` if
    /// `deformer_instance` has no memory for it.
    pub fn mien_deformer_instance_positions(deformer_instance: *const MienDeformerInstance, mesh: u32, out_positions: *mut MienFloatView) -> MienStatus;

    /// Returns the deformed normals of a mesh: 3 floats per vertex, x y z, unit length.
    ///
    /// Contents change with `mien_deformer_instance_deform()`,
    /// `mien_deformer_instance_write_vertices()` and their batches.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if there is no such mesh, `MIEN_ERROR_LOD` if
    /// `deformer_instance` has no memory for it.
    pub fn mien_deformer_instance_normals(deformer_instance: *const MienDeformerInstance, mesh: u32, out_normals: *mut MienFloatView) -> MienStatus;

    /// Deforms a mesh as `mien_deformer_instance_deform()` does, and writes its vertices to memory
    /// of the caller, such as a mapped vertex buffer. Each byte is written once, in the order of
    /// the vertices, and none is read, so the memory may be write-combined. Bytes between vertices
    /// are left unchanged. `parallel` may be NULL; the bytes are the same either way. The same
    /// positions, normals and tangents give the same bytes on every instruction set. Does not
    /// allocate or lock. Uses up to 16 KiB of stack per task. On failure nothing is deformed or
    /// written.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if there is no such mesh, `MIEN_ERROR_LOD` if
    /// `deformer_instance` has no memory for it, `MIEN_ERROR_INVALID_ARGUMENT` if a stream has a
    /// format that its attribute cannot have, a wrong stride or alignment or too little capacity,
    /// if streams overlap, if there is no stream, or if tangents are requested from a deformer
    /// without them.
    ///
    /// See docs/deformation.md, 5 "Vertex output".
    pub fn mien_deformer_instance_write_vertices(deformer_instance: *mut MienDeformerInstance, mesh: u32, normals: u32, output: *const MienVertexOutput, parallel: *const MienParallelFor) -> MienStatus;

    /// Does the same for one mesh of `count` different instances of one deformer: instance i is
    /// written to outputs\[i\]. All outputs have the same `struct_size`, and must not share bytes.
    /// `parallel` may be NULL. Does not allocate or lock. Uses up to 16 KiB of stack per task.
    ///
    /// Fails like `mien_deformer_instance_write_vertices()`, and with `MIEN_ERROR_MISMATCH` if the
    /// instances have different deformers, `MIEN_ERROR_INVALID_ARGUMENT` if an instance is listed
    /// twice.
    pub fn mien_deformer_instance_write_vertices_batch(deformer_instances: *const *mut MienDeformerInstance, count: usize, mesh: u32, normals: u32, outputs: *const MienVertexOutput, parallel: *const MienParallelFor) -> MienStatus;

    /// Creates derivatives. `desc` may be NULL. `rig` may be destroyed afterwards, and so may the
    /// deformer. Takes one block of memory, which holds a copy of the weights of networks, room
    /// for 32 directions, and 8 bytes for each 8 numbers of the joint matrix. Destroy with
    /// `mien_derivatives_destroy()`.
    ///
    /// Fails with `MIEN_ERROR_MISMATCH` if the deformer is not of the rig.
    pub fn mien_derivatives_create(rig: *const MienRig, desc: *const MienDerivativesDesc, out_derivatives: *mut *mut MienDerivatives, error: *mut MienError) -> MienStatus;

    /// Destroys derivatives. NULL is allowed.
    pub fn mien_derivatives_destroy(derivatives: *mut MienDerivatives);

    /// Returns the number of bytes that `mien_derivatives_create()` would allocate.
    ///
    /// Fails with `MIEN_ERROR_MISMATCH` if the deformer is not of the rig.
    pub fn mien_derivatives_bytes(rig: *const MienRig, desc: *const MienDerivativesDesc, out_bytes: *mut u64) -> MienStatus;

    /// Returns how many numbers a point has. `mesh` is the index of the mesh of
    /// `MIEN_POINT_POSITIONS`, else 0.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if there is no such mesh, or the point needs a deformer and
    /// there is none.
    pub fn mien_derivatives_size(derivatives: *const MienDerivatives, point: u32, mesh: u32, out_size: *mut usize) -> MienStatus;

    /// Computes the derivatives at the values of `instance`, which must belong to the rig and have
    /// been evaluated, alone or in a batch, at the LOD of that evaluation. `stages` selects the
    /// stages to differentiate, `MIEN_STAGE_ALL` or some of them: the results of the others count
    /// as constants. Does not allocate or lock. Where a function has no derivative, a one-sided
    /// one is used, so that solvers do not get stuck:
    ///
    /// ```text
    /// - controls at 0 or 1, for correctives, GUI controls and maps: into the interval
    /// - where two intervals of a conditional table meet: that of the steeper one
    /// - RBF poses with a weight below the threshold: as without a threshold; at a stored pose: 0
    /// - ReLU at 0: as above 0
    /// ```
    ///
    /// Saturation is ignored: values that overflow have the derivatives of the formula. Controls
    /// that a network or solver reads before they are computed count as constants.
    ///
    /// Fails with `MIEN_ERROR_MISMATCH` if the instance is not of the rig.
    pub fn mien_derivatives_linearize(derivatives: *mut MienDerivatives, instance: *const MienInstance, stages: u32) -> MienStatus;

    /// Multiplies directions by the matrix of derivatives (Jacobian-vector products). Each of the
    /// `count` directions is a row of `mien_derivatives_size()` numbers at `from`; its output is
    /// the resulting change of the numbers at `to`. Rows follow each other without gaps; `outputs`
    /// has `count` rows and must not overlap `directions`. Several directions in one call are
    /// faster than one by one, and give the same bits. Does not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if a point lacks its deformer or mesh,
    /// `MIEN_ERROR_INVALID_ARGUMENT` if `from` has no effect on `to` or nothing was linearized.
    pub fn mien_derivatives_forward(derivatives: *mut MienDerivatives, from: u32, to: u32, mesh: u32, count: u32, directions: *const f32, outputs: *mut f32) -> MienStatus;

    /// Multiplies gradients by the transposed matrix (vector-Jacobian products): turns each of
    /// `count` gradients with respect to the numbers at `to` into the gradient with respect to
    /// those at `from`. All else is as in `mien_derivatives_forward()`.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if a point lacks its deformer or mesh,
    /// `MIEN_ERROR_INVALID_ARGUMENT` if `from` has no effect on `to` or nothing was linearized.
    pub fn mien_derivatives_reverse(derivatives: *mut MienDerivatives, from: u32, to: u32, mesh: u32, count: u32, gradients: *const f32, outputs: *mut f32) -> MienStatus;

    /// Creates a matrix for derivatives that have the rig and the deformer of `derivatives`,
    /// linearized or not. `derivatives` may be destroyed afterwards. The matrix takes one block of
    /// memory: 8 bytes per entry, 4 per row, 20 per column. More is needed until the call returns:
    /// 4 bytes per row, 12 per column, and 8 for each number on the way (controls, joint values,
    /// matrices, results of networks, positions of the mesh). Destroy with
    /// `mien_jacobian_destroy()`.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if `from_point` has no effect on `to_point` or the
    /// outputs do not ascend, `MIEN_ERROR_INDEX` if a point lacks its deformer or mesh, or an
    /// input or output does not exist, `MIEN_ERROR_LOD` if the rig has no such LOD.
    pub fn mien_jacobian_create(derivatives: *const MienDerivatives, desc: *const MienJacobianDesc, out_jacobian: *mut *mut MienJacobian, error: *mut MienError) -> MienStatus;

    /// Destroys a matrix. NULL is allowed.
    pub fn mien_jacobian_destroy(jacobian: *mut MienJacobian);

    /// Returns the entries. They are the same in all poses, so a solver can order and factor the
    /// matrix symbolically once. The views are valid until the matrix is destroyed.
    pub fn mien_jacobian_pattern(jacobian: *const MienJacobian, out_pattern: *mut MienJacobianPattern) -> MienStatus;

    /// Computes the entries of a matrix at the values that were linearized: `values` gets a float
    /// per entry of the pattern, of which some may be 0. Each is equal to what
    /// `mien_derivatives_forward()` computes for a direction that is 1 at the number of its
    /// column, else 0. `wanted` may be NULL: all columns; otherwise it has a byte per column, and
    /// entries of columns with a 0 are not computed and keep their values. Threads may use one
    /// matrix at the same time, each with derivatives of its own. Does not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_MISMATCH` if the matrix was created for another rig or deformer, or
    /// the values were linearized at another LOD, `MIEN_ERROR_INVALID_ARGUMENT` if nothing was
    /// linearized, `value_count` is not the number of entries, or `wanted_count` not that of
    /// columns (0 if `wanted` is NULL).
    pub fn mien_derivatives_jacobian(derivatives: *mut MienDerivatives, jacobian: *const MienJacobian, wanted: *const u8, wanted_count: usize, values: *mut f32, value_count: usize) -> MienStatus;

    /// Writes a rig and its deformer to a baked file. `deformer` may be NULL. The file is written
    /// under a temporary name and renamed, so that a failure leaves `path` unchanged.
    ///
    /// Fails with `MIEN_ERROR_MISMATCH` if `deformer` was created for another rig,
    /// `MIEN_ERROR_FILE_WRITE` if the file cannot be written, `MIEN_ERROR_MEMORY` if the allocator
    /// of the rig returns NULL.
    pub fn mien_bake_file(rig: *const MienRig, deformer: *const MienDeformer, path: *const c_char, error: *mut MienError) -> MienStatus;

    /// Writes a baked file to memory and returns its size in `out_size`. `deformer` may be NULL.
    /// `buffer` may be NULL with capacity 0 to get the size only. Writes nothing if `capacity` is
    /// too small; `out_size` is set nevertheless.
    ///
    /// Fails with `MIEN_ERROR_MISMATCH` if `deformer` was created for another rig,
    /// `MIEN_ERROR_INVALID_ARGUMENT` if `capacity` is too small.
    pub fn mien_bake_memory(rig: *const MienRig, deformer: *const MienDeformer, buffer: *mut c_void, capacity: usize, out_size: *mut usize, error: *mut MienError) -> MienStatus;

    /// Opens a baked file. By default it is mapped, so processes that open the same file share its
    /// pages. Do not truncate or overwrite a mapped file until all objects made from it are
    /// destroyed; replacing it by renaming is safe. The header is checked now, the rest when
    /// objects are created. One allocation, and one more for the bytes if the file is not mapped.
    /// Close with `mien_baked_close()`.
    ///
    /// Fails with `MIEN_ERROR_FILE_OPEN` or `MIEN_ERROR_FILE_READ` if the file cannot be read,
    /// `MIEN_ERROR_BAKED_SIGNATURE`, `MIEN_ERROR_BAKED_VERSION`, `MIEN_ERROR_BAKED_TRUNCATED` or
    /// `MIEN_ERROR_BAKED_STRUCTURE` if its header is not valid, `MIEN_ERROR_BAKED_CHECKSUM` if
    /// `MIEN_BAKED_CHECK_FULL` finds changed bytes.
    pub fn mien_baked_open_file(path: *const c_char, desc: *const MienBakedDesc, out_baked: *mut *mut MienBaked, error: *mut MienError) -> MienStatus;

    /// Opens a baked file in memory: `size` bytes. `bytes` must outlive the MienBaked and all
    /// objects made from it, unchanged, unless they are copied: with `MIEN_FILE_READ`, or if
    /// `bytes` is not aligned to 64.
    ///
    /// Fails like `mien_baked_open_file()`, but not with `MIEN_ERROR_FILE_OPEN` or
    /// `MIEN_ERROR_FILE_READ`.
    pub fn mien_baked_open_memory(bytes: *const c_void, size: usize, desc: *const MienBakedDesc, out_baked: *mut *mut MienBaked, error: *mut MienError) -> MienStatus;

    /// Opens a baked file through a stream, which is read at once into memory of the allocator.
    ///
    /// Fails like `mien_baked_open_file()`, but not with `MIEN_ERROR_FILE_OPEN`.
    pub fn mien_baked_open_stream(stream: *const MienStream, desc: *const MienBakedDesc, out_baked: *mut *mut MienBaked, error: *mut MienError) -> MienStatus;

    /// Closes a baked file. Objects made from it stay valid; its memory is released and the file
    /// unmapped with the last of them.
    pub fn mien_baked_close(baked: *mut MienBaked);

    /// Returns the properties of an open baked file.
    pub fn mien_baked_info(baked: *const MienBaked, out_info: *mut MienBakedInfo) -> MienStatus;

    /// Creates the rig of a baked file, with one allocation, or two with `MIEN_REUSE_SUMS`.
    /// `baked` may be closed afterwards. Destroy with `mien_rig_destroy()`.
    ///
    /// Fails with `MIEN_ERROR_BAKED_PART` if the file has no rig, `MIEN_ERROR_BAKED_VERSION` or
    /// `MIEN_ERROR_BAKED_STRUCTURE` if its rig cannot be used, `MIEN_ERROR_ISA` if the requested
    /// instruction set is not available.
    pub fn mien_rig_from_baked(baked: *const MienBaked, desc: *const MienBakedRigDesc, out_rig: *mut *mut MienRig, error: *mut MienError) -> MienStatus;

    /// Creates the deformer of a baked file, with one allocation. `rig` is the one created from
    /// the same MienBaked. `baked` may be closed and `rig` may be destroyed afterwards. Destroy
    /// with `mien_deformer_destroy()`.
    ///
    /// Fails with `MIEN_ERROR_MISMATCH` if `rig` was not created from `baked`,
    /// `MIEN_ERROR_BAKED_PART` if the file has no deformer, `MIEN_ERROR_BAKED_VERSION` or
    /// `MIEN_ERROR_BAKED_STRUCTURE` if its deformer cannot be used, `MIEN_ERROR_ISA` if the
    /// requested instruction set is not available.
    pub fn mien_deformer_from_baked(baked: *const MienBaked, rig: *const MienRig, desc: *const MienBakedDeformerDesc, out_deformer: *mut *mut MienDeformer, error: *mut MienError) -> MienStatus;

    /// Builds a clip in memory. `desc` is required. The same values give the same bytes on every
    /// machine. Close with `mien_clip_close()`.
    ///
    /// Fails with `MIEN_ERROR_CLIP_VALUE` if a value is not finite (the message names frame and
    /// channel), `MIEN_ERROR_NAME` if a name is empty or occurs twice, `MIEN_ERROR_CLIP_LIMIT` if
    /// there are too many frames, channels or bytes.
    pub fn mien_clip_build(desc: *const MienClipDesc, out_clip: *mut *mut MienClip, error: *mut MienError) -> MienStatus;

    /// Opens a clip. By default it is mapped: do not truncate or overwrite the file until the clip
    /// is closed and its players are destroyed; replacing it by renaming is safe. Names and events
    /// are checked now, curves when they are decoded: damaged ones decode to zeros (see
    /// `mien_clip_verify()`). Close with `mien_clip_close()`.
    ///
    /// Fails with `MIEN_ERROR_FILE_OPEN` or `MIEN_ERROR_FILE_READ` if the file cannot be read,
    /// `MIEN_ERROR_CLIP_SIGNATURE`, `MIEN_ERROR_CLIP_VERSION`, `MIEN_ERROR_CLIP_TRUNCATED` or
    /// `MIEN_ERROR_CLIP_STRUCTURE` if it is not a valid clip.
    pub fn mien_clip_open_file(path: *const c_char, desc: *const MienClipOpenDesc, out_clip: *mut *mut MienClip, error: *mut MienError) -> MienStatus;

    /// Opens a clip in memory, at any alignment. `bytes` must outlive the clip and its players,
    /// unchanged.
    ///
    /// Fails like `mien_clip_open_file()`, but not with `MIEN_ERROR_FILE_OPEN` or
    /// `MIEN_ERROR_FILE_READ`.
    pub fn mien_clip_open_memory(bytes: *const c_void, size: usize, desc: *const MienClipOpenDesc, out_clip: *mut *mut MienClip, error: *mut MienError) -> MienStatus;

    /// Opens a clip through a stream, which is read completely into memory of the allocator.
    ///
    /// Fails like `mien_clip_open_file()`, but not with `MIEN_ERROR_FILE_OPEN`.
    pub fn mien_clip_open_stream(stream: *const MienStream, desc: *const MienClipOpenDesc, out_clip: *mut *mut MienClip, error: *mut MienError) -> MienStatus;

    /// Closes a clip. Players stay valid; memory is released and the file unmapped with the last
    /// of them.
    pub fn mien_clip_close(clip: *mut MienClip);

    /// Writes a clip to a file. The file is written under a temporary name and renamed, so that a
    /// failure leaves `path` unchanged.
    ///
    /// Fails with `MIEN_ERROR_FILE_WRITE` if the file cannot be written, `MIEN_ERROR_MEMORY` if
    /// the allocator of the clip returns NULL.
    pub fn mien_clip_write_file(clip: *const MienClip, path: *const c_char, error: *mut MienError) -> MienStatus;

    /// Writes a clip to memory and returns its size in `out_size`. `buffer` may be NULL with
    /// capacity 0 to get the size only. Writes nothing if `capacity` is too small; `out_size` is
    /// set nevertheless.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if `capacity` is too small.
    pub fn mien_clip_write_memory(clip: *const MienClip, buffer: *mut c_void, capacity: usize, out_size: *mut usize, error: *mut MienError) -> MienStatus;

    /// Returns the properties of a clip.
    pub fn mien_clip_info(clip: *const MienClip, out_info: *mut MienClipInfo) -> MienStatus;

    /// Returns a channel. Channels keep the order in which the clip was built. The name is a view
    /// into the clip.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if `index` is out of range.
    pub fn mien_clip_channel(clip: *const MienClip, index: u32, out_channel: *mut MienClipChannel) -> MienStatus;

    /// Returns the index of the channel with this name. Searches all channels.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is none.
    pub fn mien_clip_find_channel(clip: *const MienClip, name: *const c_char, out_index: *mut u32) -> MienStatus;

    /// Returns the index of the channel with this name. Searches all channels.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is none.
    pub fn mien_clip_find_channel_n(clip: *const MienClip, name: *const c_char, name_count: usize, out_index: *mut u32) -> MienStatus;

    /// Returns an event. Events are sorted by tick; those at the same tick keep the order in which
    /// they were given. The name is a view into the clip.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if `index` is out of range.
    pub fn mien_clip_event(clip: *const MienClip, index: u32, out_event: *mut MienClipEvent) -> MienStatus;

    /// Checks that no byte of a clip has changed since it was written and that all curves can be
    /// decoded. Reads the whole clip. Uses up to 48 KiB of stack.
    ///
    /// Fails with `MIEN_ERROR_CLIP_CHECKSUM` if bytes have changed, `MIEN_ERROR_CLIP_STRUCTURE` if
    /// a curve cannot be decoded.
    pub fn mien_clip_verify(clip: *const MienClip, error: *mut MienError) -> MienStatus;

    /// Copies `frame_count` frames, starting at `first_frame`: channel c of frame `first_frame` +
    /// n goes to `out_values`\[n \* `frame_stride` + c\]. `frame_stride` is at least the number of
    /// channels; 0 means that number. Each call decodes from the start of a block of 64 frames, so
    /// reading many frames in one call costs less than reading them one by one. Uses up to 48 KiB
    /// of stack.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if `frame_stride` is too small, `MIEN_ERROR_INDEX`
    /// if the clip has fewer frames, `MIEN_ERROR_CLIP_STRUCTURE` if a curve is damaged; its block
    /// in `out_values` is zero.
    pub fn mien_clip_read(clip: *const MienClip, first_frame: u32, frame_count: u32, out_values: *mut f32, frame_stride: usize, error: *mut MienError) -> MienStatus;

    /// Creates a player, with one allocation. `clip` may be closed before the player is destroyed.
    /// Destroy with `mien_clip_player_destroy()`.
    pub fn mien_clip_player_create(clip: *const MienClip, desc: *const MienClipPlayerDesc, out_clip_player: *mut *mut MienClipPlayer, error: *mut MienError) -> MienStatus;

    /// Destroys a player.
    pub fn mien_clip_player_destroy(clip_player: *mut MienClipPlayer);

    /// Returns the state of a player.
    pub fn mien_clip_player_info(clip_player: *const MienClipPlayer, out_info: *mut MienClipPlayerInfo) -> MienStatus;

    /// Moves to a tick: modulo the length with `MIEN_LOOPING_WRAP`, otherwise clamped to the
    /// range. Reports no events; the next `mien_clip_player_advance()` also reports events at this
    /// tick, as it does after creation. Does not allocate or lock.
    pub fn mien_clip_player_seek(clip_player: *mut MienClipPlayer, tick: i64) -> MienStatus;

    /// Sets the speed for later calls of `mien_clip_player_advance()`. Does not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if it is outside the range of MienClipPlayerDesc.
    pub fn mien_clip_player_set_speed(clip_player: *mut MienClipPlayer, numerator: i32, denominator: i32) -> MienStatus;

    /// Moves by `ticks` times the speed. `ticks` is -2^40 to 2^40 (26 minutes). Fractions of ticks
    /// are kept, so the position does not depend on the step size. Does not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if `ticks` is out of range.
    pub fn mien_clip_player_advance(clip_player: *mut MienClipPlayer, ticks: i64) -> MienStatus;

    /// Returns the next event that the last `mien_clip_player_advance()` passed. `out_found` is 1,
    /// or 0 after the last event. An event is passed when the position reaches or crosses its tick
    /// in either direction, once per loop. The name is a view into the clip. Does not allocate or
    /// lock.
    pub fn mien_clip_player_next_event(clip_player: *mut MienClipPlayer, out_event: *mut MienClipEvent, out_found: *mut u32) -> MienStatus;

    /// Returns the values at the current position: one float per channel. Exactly at a frame they
    /// are bit-identical to those of the clip. Decodes the frames since the last call, or at most
    /// 64 after a jump; without MienClipPlayerDesc.reverse, each step backward is a jump. Does not
    /// allocate or lock.
    ///
    /// Contents change with `mien_clip_player_sample()`.
    pub fn mien_clip_player_sample(clip_player: *mut MienClipPlayer, out_values: *mut MienFloatView) -> MienStatus;

    /// Binds a clip to a rig by names. A channel drives the raw control with its name. If there is
    /// none, it drives the GUI control with its name, which is then mapped as by
    /// `mien_rig_map_gui_to_raw()`. If there is none either, it drives the controls of its entries
    /// in the matrix, which are summed in the order of the matrix. Names match without regard to
    /// case; `.` matches `_`; the prefix `CTRL_expressions.` may be missing. If several names
    /// match, only an exact match counts. A channel that drives nothing so far drives the controls
    /// that `mien_rig_match()` finds for its name, such as mouthSmile\_L for mouthSmileLeft; these
    /// are summed after those of the matrix. A raw control that a channel drives by name is driven
    /// by nothing else, and one that the matrix or `mien_rig_match()` drives is not driven by GUI
    /// controls. Names without a match are not an error: see `mien_clip_binding_info()`. `clip`
    /// may be closed and `rig` may be destroyed afterwards. Destroy with
    /// `mien_clip_binding_destroy()`.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if a weight is not finite, `MIEN_ERROR_CLIP_LIMIT`
    /// if channels drive more than 4095 GUI controls.
    pub fn mien_clip_binding_create(clip: *const MienClip, rig: *const MienRig, desc: *const MienClipBindingDesc, out_clip_binding: *mut *mut MienClipBinding, error: *mut MienError) -> MienStatus;

    /// Returns a matrix that binds clips with the 52 ARKit expression names, such as those of the
    /// Live Link Face app, to rigs with the other common naming of raw controls (eyeBlinkL for
    /// eyeBlinkLeft). It suits every rig: channels whose names the rig has do not use the matrix,
    /// and entries for missing controls are skipped. docs/face-capture.md, 3 "ARKit expressions on
    /// raw controls" explains the entries. Writes as many entries as fit; `out_count` is the total
    /// number. Names are static. `out_entries` may be NULL if `capacity` is 0.
    pub fn mien_arkit_matrix(out_entries: *mut MienMatrixEntry, capacity: usize, out_count: *mut usize) -> MienStatus;

    /// Destroys a binding.
    pub fn mien_clip_binding_destroy(clip_binding: *mut MienClipBinding);

    /// Returns what a binding found.
    pub fn mien_clip_binding_info(clip_binding: *const MienClipBinding, out_info: *mut MienClipBindingInfo) -> MienStatus;

    /// Computes the raw controls that are driven and leaves the others unchanged. `values` has one
    /// float per channel, as `mien_clip_player_sample()` returns them; `raw_controls` has one
    /// float per raw control, as `mien_instance_raw_controls()` returns them. Values that drive
    /// raw controls by name are copied exactly; GUI controls give the same bits as
    /// `mien_rig_map_gui_to_raw()`. Does not allocate or lock. Uses up to 16 KiB of stack.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if a count differs from that of the clip or the
    /// rig.
    pub fn mien_clip_binding_apply(clip_binding: *const MienClipBinding, values: *const f32, value_count: usize, raw_controls: *mut f32, raw_control_count: usize) -> MienStatus;

    /// Finds for each channel of a clip the coarsest rounding step with no visible effect, for
    /// MienClipDesc.snaps: the largest of 2^-9 to 2^-16 of which half moves no vertex of LOD 0 by
    /// more than `tolerance`, in millimeters, such as 0.02. If LOD 0 has no meshes, joints are
    /// measured instead. Each channel is tried at five values from 0 to 1, and from -1 on if GUI
    /// controls are driven, with all other channels at 0. Channels that drive nothing get 2^-11;
    /// channels for which even the finest step is too coarse get 0. To use the steps, build a clip
    /// with all bits, bind it, then build it again with them. Evaluates and deforms the rig at
    /// least 10 times per channel, and takes memory from its allocator during the call.
    ///
    /// Fails with `MIEN_ERROR_MEMORY` if that returns NULL, `MIEN_ERROR_MISMATCH` if
    /// `channel_count` is not that of the binding, or the binding is for another rig,
    /// `MIEN_ERROR_INVALID_ARGUMENT` if `tolerance` is not a number above 0.
    pub fn mien_clip_binding_snaps(clip_binding: *const MienClipBinding, deformer: *const MienDeformer, tolerance: f32, out_snaps: *mut f32, channel_count: usize, error: *mut MienError) -> MienStatus;

    /// Creates a mix for a rig. `desc` is required. `rig` may be destroyed afterwards, and so may
    /// the deformer. Measuring guards takes time: it evaluates and deforms the rig at LOD 0 for
    /// each raw control and for pairs of raw controls that share a corrective. Destroy with
    /// `mien_mix_destroy()`.
    ///
    /// Fails with `MIEN_ERROR_MISMATCH` if the deformer or the gaze is for another rig,
    /// `MIEN_ERROR_INDEX` if a landmark names a mesh, position or joint that does not exist,
    /// `MIEN_ERROR_INVALID_ARGUMENT` if a field of `desc` is out of range; the message names it,
    /// `MIEN_ERROR_DNA_LIMIT` if guards are measured and raw controls times joints exceed 2^22.
    pub fn mien_mix_create(rig: *const MienRig, desc: *const MienMixDesc, out_mix: *mut *mut MienMix, error: *mut MienError) -> MienStatus;

    /// Opens a mix for a rig, which must have all controls that the mix uses; names match as in
    /// `mien_clip_binding_create()`. For other controls of the rig, the masks of the file are 0
    /// and there are no limits. Guards and gaze are those measured when the mix was created. `rig`
    /// may be NULL: then the raw controls are those of the file, to inspect it or to write it
    /// again. `rig` may be destroyed afterwards. A hostile file may make mixers large: check
    /// MienMixInfo.`mixer_bytes`. Destroy with `mien_mix_destroy()`.
    ///
    /// Fails with `MIEN_ERROR_FILE_OPEN` or `MIEN_ERROR_FILE_READ` if the file cannot be read,
    /// `MIEN_ERROR_MIX_SIGNATURE`, `MIEN_ERROR_MIX_VERSION`, `MIEN_ERROR_MIX_TRUNCATED`,
    /// `MIEN_ERROR_MIX_CHECKSUM` or `MIEN_ERROR_MIX_STRUCTURE` if it is not a valid mix,
    /// `MIEN_ERROR_NAME` if the rig lacks controls; the message names them.
    pub fn mien_mix_open_file(path: *const c_char, rig: *const MienRig, desc: *const MienMixOpenDesc, out_mix: *mut *mut MienMix, error: *mut MienError) -> MienStatus;

    /// Opens a mix in memory. `bytes` may be released afterwards. `rig` may be NULL. `rig` may be
    /// destroyed afterwards.
    ///
    /// Fails like `mien_mix_open_file()`, but not with `MIEN_ERROR_FILE_OPEN` or
    /// `MIEN_ERROR_FILE_READ`.
    pub fn mien_mix_open_memory(bytes: *const c_void, size: usize, rig: *const MienRig, desc: *const MienMixOpenDesc, out_mix: *mut *mut MienMix, error: *mut MienError) -> MienStatus;

    /// Writes a mix to a file: the arguments of `mien_mix_create()`, what it measured, and the
    /// names of the controls that the mix uses. Equal mixes give the same bytes on every machine;
    /// a mix that was opened is written with the bytes of its file. The file is written under a
    /// temporary name and renamed, so that a failure leaves `path` unchanged. Takes memory from
    /// the allocator of the mix during the call.
    ///
    /// Fails with `MIEN_ERROR_MEMORY` if that returns NULL, `MIEN_ERROR_NAME` if two of these
    /// controls have the same name, `MIEN_ERROR_FILE_WRITE` if the file cannot be written.
    pub fn mien_mix_write_file(mix: *const MienMix, path: *const c_char, error: *mut MienError) -> MienStatus;

    /// Writes a mix to memory and returns its size in `out_size`. `buffer` may be NULL with
    /// capacity 0 to get the size only. Writes nothing if `capacity` is too small; `out_size` is
    /// set nevertheless.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if `capacity` is too small, `MIEN_ERROR_MEMORY`
    /// and `MIEN_ERROR_NAME` if `mien_mix_write_file()` would fail with them.
    pub fn mien_mix_write_memory(mix: *const MienMix, buffer: *mut c_void, capacity: usize, out_size: *mut usize, error: *mut MienError) -> MienStatus;

    /// Writes a mix as text, for reading and for version control: one line for each number, with
    /// its path in the mix and the names of controls. Floats have nine digits, enough to restore
    /// their bits. The text cannot be opened as a mix, and is not null-terminated. `buffer` may be
    /// NULL with capacity 0 to get the size only.
    ///
    /// Fails like `mien_mix_write_memory()`.
    pub fn mien_mix_write_text(mix: *const MienMix, buffer: *mut c_void, capacity: usize, out_size: *mut usize, error: *mut MienError) -> MienStatus;

    /// Destroys a mix. Its mixers stay valid; its memory is released with the last of them.
    pub fn mien_mix_destroy(mix: *mut MienMix);

    /// Returns the properties of a mix.
    pub fn mien_mix_info(mix: *const MienMix, out_info: *mut MienMixInfo) -> MienStatus;

    /// Returns the measured function of a guard. `guard_index` counts as in
    /// `mien_mixer_set_guard()`, from 0 to MienMixInfo.`guard_count` - 1; `mien_mixer_guard()` has
    /// its name.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if there is no such guard.
    pub fn mien_mix_guard(mix: *const MienMix, guard_index: u32, out_guard: *mut MienMixGuardInfo) -> MienStatus;

    /// Returns a ready-made reaction to a light in the eyes, with 5 strokes. The caller provides
    /// its poses, from `first_pose` on: lids closed; squint and lowered brows; gaze turned away;
    /// narrow pupils; head turned away. docs/mixing.md, 3 "Reactions" lists the times.
    /// `out_reaction` refers to `out_strokes`.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if `stroke_count` is less than 5.
    pub fn mien_mix_glare(first_pose: u32, out_strokes: *mut MienMixStroke, stroke_count: usize, out_reaction: *mut MienMixReaction) -> MienStatus;

    /// Finds antagonists: pairs of raw controls that only the two halves of one GUI control drive.
    /// Writes as many as fit, with stiffness 1; `out_count` is the total number. `out_pairs` may
    /// be NULL if `capacity` is 0. Raw controls from 4096 on, which no mix has, are left out.
    pub fn mien_mix_antagonists(rig: *const MienRig, out_pairs: *mut MienMixAntagonists, capacity: usize, out_count: *mut usize) -> MienStatus;

    /// Finds the counterparts of raw controls in the other half of the face, for
    /// MienMixDesc.mirror. Controls are counterparts if their names differ only in Left and Right
    /// (or L and R) and their motions agree, or else if their motions are mirror images. Other
    /// controls, and curves beyond the raw controls, map to themselves. Evaluates the rig once for
    /// each raw control, and takes memory from its allocator during the call.
    ///
    /// Fails with `MIEN_ERROR_MEMORY` if that returns NULL, `MIEN_ERROR_MISMATCH` if `curve_count`
    /// is less than the raw controls, `MIEN_ERROR_DNA_LIMIT` if raw controls times joints exceed
    /// 2^22.
    pub fn mien_mix_mirror(deformer: *const MienDeformer, out_curves: *mut u16, curve_count: usize, error: *mut MienError) -> MienStatus;

    /// Computes a mask that selects joint groups: for each raw control the share of its joint
    /// motion, at value 1 and LOD 0, that belongs to these groups. A millimeter counts as much as
    /// a degree. Controls that move no joint, and curves beyond the raw controls, get
    /// `otherwise_weight`. Evaluates the rig once for each raw control and group, and takes memory
    /// from its allocator during the call.
    ///
    /// Fails with `MIEN_ERROR_MEMORY` if that returns NULL, `MIEN_ERROR_INDEX` if a group does not
    /// exist, `MIEN_ERROR_MISMATCH` if `curve_count` is less than the raw controls.
    pub fn mien_mix_mask(rig: *const MienRig, groups: *const u32, group_count: usize, otherwise_weight: f32, out_mask: *mut f32, curve_count: usize, error: *mut MienError) -> MienStatus;

    /// Creates a gaze by measuring how raw controls turn the eyes, which evaluates the rig at
    /// least twice per raw control. `deformer` may be destroyed afterwards. Destroy with
    /// `mien_gaze_destroy()`.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there are no such joints, `MIEN_ERROR_INVALID_ARGUMENT` if
    /// no raw control turns an eye monotonically in one of the four directions.
    pub fn mien_gaze_create(deformer: *const MienDeformer, desc: *const MienGazeDesc, out_gaze: *mut *mut MienGaze, error: *mut MienError) -> MienStatus;

    /// Destroys a gaze.
    pub fn mien_gaze_destroy(gaze: *mut MienGaze);

    /// Returns where the eyes are, so that a target can be placed in front of them.
    pub fn mien_gaze_info(gaze: *const MienGaze, out_info: *mut MienGazeInfo) -> MienStatus;

    /// Sets the raw controls of a row so that both eyes look at a target. Eyes converge on near
    /// targets. `out_rest` may be NULL. Does not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_MISMATCH` if `row_count` is less than the raw controls,
    /// `MIEN_ERROR_INVALID_ARGUMENT` if the target is not finite.
    pub fn mien_gaze_look_at(gaze: *const MienGaze, target: *const MienGazeTarget, row: *mut f32, row_count: usize, out_rest: *mut MienGazeRest) -> MienStatus;

    /// Creates a mixer at time 0, with one allocation. No clip plays; pose weights and pose
    /// variables are 0. `mix` may be destroyed before it. Destroy with `mien_mixer_destroy()`.
    pub fn mien_mixer_create(mix: *const MienMix, desc: *const MienMixerDesc, out_mixer: *mut *mut MienMixer, error: *mut MienError) -> MienStatus;

    /// Destroys a mixer.
    pub fn mien_mixer_destroy(mixer: *mut MienMixer);

    /// Plays a clip in a layer, from the next step on. `clip` and `clip_binding` must outlive
    /// their playback, including the transition to the next clip. On failure the layer continues
    /// as before. Does not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if the layer does not exist or has another source,
    /// `MIEN_ERROR_MISMATCH` if the binding is for another clip or rig,
    /// `MIEN_ERROR_INVALID_ARGUMENT` if a time, speed or enum value is out of range or a delta
    /// clip would play in a layer that overrides, `MIEN_ERROR_CLIP_LIMIT` if the clip is larger
    /// than the mix allows.
    pub fn mien_mixer_play(mixer: *mut MienMixer, layer: u32, clip: *const MienClip, clip_binding: *const MienClipBinding, desc: *const MienPlayDesc, error: *mut MienError) -> MienStatus;

    /// Fades out the clip of a layer and stops it. Fades take 0 to 2^40 ticks, here and below;
    /// they start from the current value and speed, and end with speed 0. Does not allocate or
    /// lock.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if the layer does not exist or is not a clip layer.
    pub fn mien_mixer_stop(mixer: *mut MienMixer, layer: u32, fade_ticks: i64) -> MienStatus;

    /// Fades the weight of a layer to `weight`, which has the range of MienMixLayer.weight. Does
    /// not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if the layer does not exist.
    pub fn mien_mixer_set_weight(mixer: *mut MienMixer, layer: u32, weight: f32, fade_ticks: i64) -> MienStatus;

    /// Fades the weight of a pose to `weight`, 0 to 1. `pose` counts from the first pose of the
    /// layer. Weights of a layer that add up to more than 1 are divided by their sum. Does not
    /// allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if the layer or its pose does not exist.
    pub fn mien_mixer_set_pose_weight(mixer: *mut MienMixer, layer: u32, pose: u32, weight: f32, fade_ticks: i64) -> MienStatus;

    /// Sets the `value` that a pose variable has at the start of each step, before the layers.
    /// Does not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if it does not exist, `MIEN_ERROR_INVALID_ARGUMENT` if the
    /// value is not finite.
    pub fn mien_mixer_set_variable(mixer: *mut MienMixer, variable: u32, value: f32) -> MienStatus;

    /// Sets how much a guard acts: `activation` is 0 to 1, or negative for automatic, the default:
    /// the smaller the gap that base and speech leave, the more the guard acts; guards of lips and
    /// teeth act at most as much as the largest weight of a speech layer. `mien_mixer_guard()`
    /// returns the name for a `guard_index`. Does not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if the guard does not exist, `MIEN_ERROR_INVALID_ARGUMENT` if
    /// `activation` is above 1 or not a number.
    pub fn mien_mixer_set_guard(mixer: *mut MienMixer, guard_index: u32, activation: f32) -> MienStatus;

    /// Returns what a guard did in the last step. `guard_index` counts as in
    /// `mien_mixer_set_guard()`. Views point into the mix.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if the guard does not exist.
    pub fn mien_mixer_guard(mixer: *const MienMixer, guard_index: u32, out_state: *mut MienGuardState) -> MienStatus;

    /// Starts a reaction to a stimulus of `strength`, 0 to 1, that lasts for `hold_ticks`, at most
    /// 2^40; if negative, until `mien_mixer_release()`. Does not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if the reaction does not exist, `MIEN_ERROR_INVALID_ARGUMENT`
    /// if strength or time is out of range.
    pub fn mien_mixer_trigger(mixer: *mut MienMixer, reaction: u32, strength: f32, hold_ticks: i64) -> MienStatus;

    /// Ends the stimulus of a reaction. Does not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if the reaction does not exist.
    pub fn mien_mixer_release(mixer: *mut MienMixer, reaction: u32) -> MienStatus;

    /// Sets the level of what a reaction responds to, such as a brightness, 0 to 1. Call it
    /// whenever the level changes. A level of MienMixReaction.`level_on` or more is a stimulus of
    /// strength 1, which ends once the level has been below `level_off` for 50 ms, so a flickering
    /// light counts as on. During the stimulus, scaled strokes follow the level without overshoot;
    /// 90 % of a change takes 0.25 s. Does not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if the reaction does not exist, `MIEN_ERROR_INVALID_ARGUMENT`
    /// if it has no `level_on` or `level` is out of range.
    pub fn mien_mixer_set_level(mixer: *mut MienMixer, reaction: u32, level: f32) -> MienStatus;

    /// Queues a row for a stream layer: one value per channel, for time `tick` of the mixer. One
    /// thread may call this while another one uses the mixer. `out_accepted` may be NULL; it is
    /// set to 0 if the row is dropped because it is not newer than the last one or the queue is
    /// full. Does not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if the layer does not exist or is not a stream,
    /// `MIEN_ERROR_MISMATCH` if it has another number of channels, `MIEN_ERROR_INVALID_ARGUMENT`
    /// if a value is not finite or `tick` is 2^61 or more.
    pub fn mien_mixer_push(mixer: *mut MienMixer, layer: u32, tick: i64, values: *const f32, value_count: usize, out_accepted: *mut u32) -> MienStatus;

    /// Advances the time by `ticks`, 0 to 2^40, and mixes. Writes the raw controls to `instance`,
    /// which may be NULL. Does not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if `ticks` is out of range or the time would
    /// exceed 2^60 ticks (51 years), `MIEN_ERROR_MISMATCH` if the instance has another number of
    /// raw controls.
    pub fn mien_mixer_step(mixer: *mut MienMixer, ticks: i64, instance: *mut MienInstance) -> MienStatus;

    /// Steps `count` mixers; instances\[i\] belongs to mixers\[i\]. `instances` may be NULL. The
    /// results are those of single calls. On failure no mixer is advanced.
    ///
    /// Fails like `mien_mixer_step()`, and with `MIEN_ERROR_INVALID_ARGUMENT` if a mixer is listed
    /// twice.
    pub fn mien_mixer_step_batch(mixers: *const *mut MienMixer, instances: *const *mut MienInstance, count: usize, ticks: i64) -> MienStatus;

    /// Returns the row of the last step, one float per curve: raw controls, then pose variables.
    ///
    /// Contents change with `mien_mixer_step()` and `mien_mixer_step_batch()`.
    pub fn mien_mixer_row(mixer: *const MienMixer, out_row: *mut MienFloatView) -> MienStatus;

    /// Returns the row after a stage of the last step, one float per curve. Stages are numbered:
    /// the layers, then reactions, guards, antagonists, limits. Layers that act after the
    /// reactions or the guards keep their numbers.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if the stage does not exist, `MIEN_ERROR_INVALID_ARGUMENT` if
    /// MienMixerDesc.stages was 0.
    ///
    /// Contents change with `mien_mixer_step()` and `mien_mixer_step_batch()`.
    pub fn mien_mixer_stage(mixer: *const MienMixer, stage: u32, out_row: *mut MienFloatView) -> MienStatus;

    /// Returns the state of a mixer.
    pub fn mien_mixer_info(mixer: *const MienMixer, out_info: *mut MienMixerInfo) -> MienStatus;

    /// Returns an event of the last step and its layer. The tick is in the time of the clip, and
    /// the name is a view into the clip.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if `index` is out of range.
    pub fn mien_mixer_event(mixer: *const MienMixer, index: u32, out_event: *mut MienClipEvent, out_layer: *mut u32) -> MienStatus;

    /// Writes the state of a mixer to memory: everything that later steps depend on, except queued
    /// stream rows. Returns its size in `out_size`. `buffer` may be NULL with capacity 0 to get
    /// the size only. Snapshots can be restored on 64-bit machines of the same byte order. Does
    /// not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if `capacity` is too small.
    pub fn mien_mixer_snapshot(mixer: *mut MienMixer, buffer: *mut c_void, capacity: usize, out_size: *mut usize, error: *mut MienError) -> MienStatus;

    /// Restores a snapshot of a mixer of the same mix; later steps give the same bits. Queued
    /// stream rows are not part of it. `clips` lists the clips that may have been playing. The
    /// bytes are validated, so they need not be trusted. On failure the mixer does not change.
    /// Does not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if the bytes are not a snapshot of this mix,
    /// `MIEN_ERROR_MISMATCH` if a clip is missing or is not the one that was playing.
    pub fn mien_mixer_restore(mixer: *mut MienMixer, bytes: *const c_void, size: usize, clips: *const MienMixerClip, clip_count: usize, error: *mut MienError) -> MienStatus;

    /// Creates a solver stack. `desc` is required. `deformer` may be destroyed before it. Destroy
    /// with `mien_solver_stack_destroy()`.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if a joint or curve does not exist,
    /// `MIEN_ERROR_INVALID_ARGUMENT` if a number is out of range, or if a solver reads a joint
    /// that a later one moves; the message names both.
    pub fn mien_solver_stack_create(deformer: *const MienDeformer, desc: *const MienSolverStackDesc, out_solver_stack: *mut *mut MienSolverStack, error: *mut MienError) -> MienStatus;

    /// Destroys a solver stack. Its states stay valid; its memory is released with the last of
    /// them.
    pub fn mien_solver_stack_destroy(solver_stack: *mut MienSolverStack);

    /// Returns the properties of a solver stack.
    pub fn mien_solver_stack_info(solver_stack: *const MienSolverStack, out_info: *mut MienSolverStackInfo) -> MienStatus;

    /// Creates a solver state. `solver_stack` may be destroyed before it. Destroy with
    /// `mien_solver_state_destroy()`.
    pub fn mien_solver_state_create(solver_stack: *const MienSolverStack, desc: *const MienSolverStateDesc, out_solver_state: *mut *mut MienSolverState, error: *mut MienError) -> MienStatus;

    /// Destroys a solver state.
    pub fn mien_solver_state_destroy(solver_state: *mut MienSolverState);

    /// Runs the solvers on the pose of `deformer_instance`. Call `mien_deformer_instance_update()`
    /// before every step. `input` may be NULL: no row, LOD 0. `ticks`, the time since the last
    /// step, is 0 to 2^40. Does not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_MISMATCH` if instance and stack have different deformers or the row
    /// is shorter than MienSolverStackDesc.`curve_count`, `MIEN_ERROR_INVALID_ARGUMENT` if `ticks`
    /// or the LOD is out of range.
    pub fn mien_solver_state_step(solver_state: *mut MienSolverState, deformer_instance: *mut MienDeformerInstance, input: *const MienSolverInput, ticks: i64) -> MienStatus;

    /// Steps `count` states of one stack; `deformer_instances`\[i\] and inputs\[i\] belong to
    /// `solver_states`\[i\]. `inputs` may be NULL. The results are those of single calls. No state
    /// or instance may occur twice. On failure nothing changes. Does not allocate or lock. Uses up
    /// to 8 KiB of stack.
    ///
    /// Fails like `mien_solver_state_step()`, and with `MIEN_ERROR_MISMATCH` if the states have
    /// different stacks.
    pub fn mien_solver_state_step_batch(solver_states: *const *mut MienSolverState, deformer_instances: *const *mut MienDeformerInstance, inputs: *const MienSolverInput, count: usize, ticks: i64) -> MienStatus;

    /// Returns the outputs of a solver in the last step, one float per output. `solver` is its
    /// index in the stack.
    ///
    /// Contents change with `mien_solver_state_step()`, `mien_solver_state_step_batch()`.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if the solver does not exist.
    pub fn mien_solver_state_outputs(solver_state: *const MienSolverState, solver: u32, out_values: *mut MienFloatView) -> MienStatus;

    /// Returns the joint transforms after the last step, relative to the parents: 10 floats per
    /// joint, tx ty tz qx qy qz qw sx sy sz. (`mien_deformer_instance_local_transforms()` returns
    /// those before the step.)
    ///
    /// Contents change with `mien_solver_state_step()`, `mien_solver_state_step_batch()`.
    pub fn mien_solver_state_transforms(solver_state: *const MienSolverState, out_transforms: *mut MienFloatView) -> MienStatus;

    /// Returns the name of a solver that changed a joint not in its `writes` in the last step, or
    /// an empty string. Contents change with `mien_solver_state_step()`,
    /// `mien_solver_state_step_batch()`.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if MienSolverStackDesc.`check_writes` was 0.
    pub fn mien_solver_state_undeclared(solver_state: *const MienSolverState, out_name: *mut MienStringView) -> MienStatus;

    /// Finds the raw controls that a name stands for on a rig. Takes time proportional to the
    /// number of raw controls: meant for loading, not for every frame. Does not allocate or lock.
    /// Writes as many shares as fit; `out_count` is the total number, at most `MIEN_MOST_SHARES`,
    /// each of a different control. `out_shares` may be NULL if `capacity` is 0. `out_match` is
    /// one of `MIEN_NAME_MATCH_...`.
    ///
    /// Fails with `MIEN_ERROR_NAME` if the name matches no control of this rig, or several in step
    /// 1 or 2.
    ///
    /// See docs/face-capture.md, 2 "Names".
    pub fn mien_rig_match(rig: *const MienRig, name: *const c_char, name_count: usize, out_shares: *mut MienControlShare, capacity: usize, out_count: *mut usize, out_match: *mut u32) -> MienStatus;

    /// Returns the usual name of a control: that of ARKit, such as mouthSmileLeft for AU12\_L and
    /// mouthCornerPullL, or that of MetaHuman's raw controls if ARKit has none. A name without a
    /// side gets none: mouthSmile. Writes as many bytes as fit, without a null; `out_count` is the
    /// total number. `out_name` may be NULL if `capacity` is 0.
    ///
    /// Fails with `MIEN_ERROR_NAME` if the name is not in the table.
    ///
    /// See docs/face-capture.md, 2 "Names".
    pub fn mien_control_name(name: *const c_char, name_count: usize, out_name: *mut c_char, capacity: usize, out_count: *mut usize) -> MienStatus;

    /// Generates a rig and opens it: a file of version 2.8, unless the preset states another one,
    /// with all layers of its version, behavior of realistic size and sparsity, and simple
    /// geometry. Close with `mien_dna_close()`.
    pub fn mien_dna_generate(desc: *const MienGenerateDesc, out_dna: *mut *mut MienDna, error: *mut MienError) -> MienStatus;

    /// Creates a rig from a mesh, with or without expressions, and opens it as a file of version
    /// 2.8: joints, skin weights for every LOD, and a raw control for each expression. The file
    /// has the axes of the mesh, in centimeters; positions keep their order, but positions that
    /// belong to no face are dropped. The same mesh, options and seed give the same bytes on any
    /// number of threads. `mesh` is required; `out_report` may be NULL. Close with
    /// `mien_dna_close()` and `mien_author_report_close()`. The report has the confidence of each
    /// landmark; a mesh is not refused because it is low.
    ///
    /// Fails with `MIEN_ERROR_AUTHOR_MESH` if the arrays of the mesh or of the caller's results
    /// contradict each other, `MIEN_ERROR_AUTHOR_REFUSED` if the mesh cannot be rigged or
    /// landmarks contradict it, `MIEN_ERROR_AUTHOR_CANCELED` if `progress` canceled,
    /// `MIEN_ERROR_DNA_LIMIT` if the file would be too large.
    ///
    /// See docs/authoring.md, 1 "What goes in and what comes out".
    pub fn mien_author_rig(mesh: *const MienAuthorMesh, desc: *const MienAuthorDesc, out_dna: *mut *mut MienDna, out_report: *mut *mut MienAuthorReport, error: *mut MienError) -> MienStatus;

    /// Closes a report.
    pub fn mien_author_report_close(author_report: *mut MienAuthorReport);

    /// Returns the report as JSON: bones, mask, groups, errors of the fit, and more. Lengths are
    /// in centimeters.
    ///
    /// See docs/authoring.md, 6 "The report".
    pub fn mien_author_report_json(author_report: *const MienAuthorReport, out_json: *mut MienStringView) -> MienStatus;

    /// Makes a document of an open file, as it was loaded: layers and LODs that were left out are
    /// not in it. `dna` may be NULL, for an empty document of version 2.8 with all layers. `dna`
    /// may be closed afterwards. Destroy with `mien_document_destroy()`.
    ///
    /// Fails with `MIEN_ERROR_DNA_LAYER` if `dna` has RBF behavior without the machine-learned
    /// behavior of its file, `MIEN_ERROR_DNA_STRUCTURE`, `MIEN_ERROR_DNA_REFERENCE` or
    /// `MIEN_ERROR_DNA_VALUE` if the loaded part would not open by itself, `MIEN_ERROR_DNA_LIMIT`
    /// if it exceeds 4 GiB.
    pub fn mien_document_create(dna: *const MienDna, desc: *const MienDocumentDesc, out_document: *mut *mut MienDocument, error: *mut MienError) -> MienStatus;

    /// Opens a whole DNA file as a document, with the checks of `mien_dna_open_file()`, without a
    /// second copy in memory. Do not truncate or overwrite a mapped file while the document
    /// exists; replacing it by renaming is safe, and so is `mien_document_write_file()` to the
    /// same path, except on Windows, where a mapped file cannot be replaced: use `MIEN_FILE_READ`.
    /// Destroy with `mien_document_destroy()`.
    ///
    /// Fails like `mien_dna_open_file()`, but not with `MIEN_ERROR_LOD`.
    pub fn mien_document_open_file(path: *const c_char, desc: *const MienDocumentDesc, out_document: *mut *mut MienDocument, error: *mut MienError) -> MienStatus;

    /// Destroys a document.
    pub fn mien_document_destroy(document: *mut MienDocument);

    /// Finds a field by its path, like `mien_dna_field()`. Its `byte_offset` is `MIEN_NO_OFFSET`.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such field, `MIEN_ERROR_INDEX` if an index in
    /// the path is past the end.
    ///
    /// See docs/dna-format.md, 6 "Layers, field by field".
    pub fn mien_document_field(document: *const MienDocument, path: *const c_char, out_field: *mut MienDnaField, error: *mut MienError) -> MienStatus;

    /// Returns the name of field `index` of the record at a path, like `mien_dna_child_name()`.
    /// The string is static.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such field, `MIEN_ERROR_INDEX` if `index` or an
    /// index in the path is past the end, `MIEN_ERROR_INVALID_ARGUMENT` if the field is not a
    /// record.
    pub fn mien_document_child_name(document: *const MienDocument, path: *const c_char, index: u32, out_name: *mut MienStringView, error: *mut MienError) -> MienStatus;

    /// Copies `count` elements of a field, beginning with element `first`, to `out`, like
    /// `mien_dna_read_floats()`. `out` may be NULL if `count` is 0.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such field, `MIEN_ERROR_INDEX` if the range or
    /// an index in the path is past the end, `MIEN_ERROR_INVALID_ARGUMENT` if the field does not
    /// hold numbers of this kind.
    pub fn mien_document_read_floats(document: *const MienDocument, path: *const c_char, first: u64, count: u64, out: *mut f32, error: *mut MienError) -> MienStatus;

    /// Copies `count` elements of a field, beginning with element `first`, to `out`, like
    /// `mien_dna_read_floats()`. `out` may be NULL if `count` is 0.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such field, `MIEN_ERROR_INDEX` if the range or
    /// an index in the path is past the end, `MIEN_ERROR_INVALID_ARGUMENT` if the field does not
    /// hold numbers of this kind.
    pub fn mien_document_read_integers(document: *const MienDocument, path: *const c_char, first: u64, count: u64, out: *mut i64, error: *mut MienError) -> MienStatus;

    /// Returns a string. Contents change with `mien_document_write_string()`,
    /// `mien_document_undo()`: the view is valid until the document is changed.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such field, `MIEN_ERROR_INDEX` if an index in
    /// the path is past the end, `MIEN_ERROR_INVALID_ARGUMENT` if the field is not a string.
    pub fn mien_document_read_string(document: *const MienDocument, path: *const c_char, out_string: *mut MienStringView, error: *mut MienError) -> MienStatus;

    /// Returns the bytes of an array of numbers or of a string in place: big-endian and unaligned,
    /// as in a file.
    ///
    /// Contents change with `mien_document_write_floats()`, `mien_document_write_integers()`,
    /// `mien_document_undo()`: the view is valid until the document is changed.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such field, `MIEN_ERROR_INDEX` if an index in
    /// the path is past the end, `MIEN_ERROR_INVALID_ARGUMENT` if the field is neither an array
    /// nor a string.
    pub fn mien_document_bytes(document: *const MienDocument, path: *const c_char, out_bytes: *mut MienStringView, error: *mut MienError) -> MienStatus;

    /// Replaces `count` elements of an array, beginning with element `first`, or a single number.
    /// The first write to an array after a mark or an operation copies it, later ones do not.
    /// `values` may be NULL if `count` is 0.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such field, `MIEN_ERROR_INDEX` if the range or
    /// an index in the path is past the end, `MIEN_ERROR_INVALID_ARGUMENT` if the field does not
    /// hold numbers of this kind, or none of this size, `MIEN_ERROR_MEMORY` if the allocator
    /// returns NULL.
    pub fn mien_document_write_floats(document: *mut MienDocument, path: *const c_char, first: u64, count: u64, values: *const f32, error: *mut MienError) -> MienStatus;

    /// Replaces `count` elements of an array, beginning with element `first`, or a single number.
    /// The first write to an array after a mark or an operation copies it, later ones do not.
    /// `values` may be NULL if `count` is 0.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such field, `MIEN_ERROR_INDEX` if the range or
    /// an index in the path is past the end, `MIEN_ERROR_INVALID_ARGUMENT` if the field does not
    /// hold numbers of this kind, or none of this size, `MIEN_ERROR_MEMORY` if the allocator
    /// returns NULL.
    pub fn mien_document_write_integers(document: *mut MienDocument, path: *const c_char, first: u64, count: u64, values: *const i64, error: *mut MienError) -> MienStatus;

    /// Replaces a string by `string_count` bytes. `string` may be NULL if `string_count` is 0.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such field, `MIEN_ERROR_INDEX` if an index in
    /// the path is past the end, `MIEN_ERROR_INVALID_ARGUMENT` if the field is not a string, or if
    /// another element of a list of names has this name, `MIEN_ERROR_MEMORY` if the allocator
    /// returns NULL.
    pub fn mien_document_write_string(document: *mut MienDocument, path: *const c_char, string: *const c_char, string_count: usize, error: *mut MienError) -> MienStatus;

    /// Replaces `removed_count` elements of an array or list, beginning with element `first`, by
    /// `inserted_count` new ones: zeros, empty strings, or records of these. References to
    /// elements by number do not change. Copies the array, or the list without its contents.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such field, `MIEN_ERROR_INDEX` if the range or
    /// an index in the path is past the end, `MIEN_ERROR_INVALID_ARGUMENT` if the field is neither
    /// an array nor a list, or would have more than 2^32 - 1 elements, `MIEN_ERROR_MEMORY` if the
    /// allocator returns NULL.
    pub fn mien_document_splice(document: *mut MienDocument, path: *const c_char, first: u64, removed_count: u64, inserted_count: u64, error: *mut MienError) -> MienStatus;

    /// Gives an array or list `count` elements: drops the last ones or adds new ones, like
    /// `mien_document_splice()`.
    ///
    /// Fails like `mien_document_splice()`.
    pub fn mien_document_resize(document: *mut MienDocument, path: *const c_char, count: u64, error: *mut MienError) -> MienStatus;

    /// Returns the version of the file that the document becomes, 2.`out_version`, and the length
    /// of its list of layers. A file also has the layers that its version defines and the list
    /// lacks, behind the others.
    pub fn mien_document_layer_count(document: *const MienDocument, out_version: *mut u32, out_count: *mut u32, error: *mut MienError) -> MienStatus;

    /// Returns layer `index` of the list, as `mien_dna_layer()`; `byte_offset` is
    /// `MIEN_NO_OFFSET`. `out_bytes` gets the contents of a layer of an unknown kind, else
    /// nothing. Contents change with `mien_document_clear_layers()`, `mien_document_undo()`: the
    /// view is valid until the document is changed.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if `index` is past the end.
    pub fn mien_document_layer(document: *const MienDocument, index: u32, out_layer: *mut MienDnaLayer, out_bytes: *mut MienStringView, error: *mut MienError) -> MienStatus;

    /// Makes the document a file of version 2.`version` and its list of layers empty: layers of
    /// unknown kinds are gone, fields stay as they are. `mien_document_add_layer()` fills the list
    /// again.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if `version` is not 1 to 65535,
    /// `MIEN_ERROR_MEMORY` if the allocator returns NULL.
    pub fn mien_document_clear_layers(document: *mut MienDocument, version: u32, error: *mut MienError) -> MienStatus;

    /// Appends a layer to the list: the layer of a known kind, without bytes, or `size` bytes of
    /// an unknown kind, which are written to the file as they are. `code` has four characters,
    /// such as "bhvr"; the layer is of version `version_major`.`version_minor`. `bytes` may be
    /// NULL if `size` is 0.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if `code` has another length, a version is above
    /// 65535, the list has a layer of this code and version already, the kind is known and has
    /// bytes, or a file of version 2.1 cannot have it, `MIEN_ERROR_MEMORY` if the allocator
    /// returns NULL.
    pub fn mien_document_add_layer(document: *mut MienDocument, code: *const c_char, version_major: u32, version_minor: u32, bytes: *const c_void, size: usize, error: *mut MienError) -> MienStatus;

    /// Remembers the current state, at the cost of some KB. Mark 0 always exists: the state in
    /// which the document was created. Changes before a mark keep their memory until the document
    /// is destroyed or an earlier mark is restored.
    ///
    /// Fails with `MIEN_ERROR_MEMORY` if the allocator returns NULL.
    pub fn mien_document_mark(document: *mut MienDocument, out_mark: *mut u64, error: *mut MienError) -> MienStatus;

    /// Goes back to the state at a mark: `mark` is a number from `mien_document_mark()`, or 0.
    /// Later marks become invalid, this one stays valid. Does not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if `mark` is not a valid mark of the document.
    pub fn mien_document_undo(document: *mut MienDocument, mark: u64, error: *mut MienError) -> MienStatus;

    /// Finds the index of a name; of equal names, the first. `kind` is a `MIEN_KIND_...`: GUI,
    /// raw, PSD ("psd0", "psd1", ...), ML and RBF controls, joints, blend shape channels, animated
    /// maps, meshes.
    ///
    /// Fails with `MIEN_ERROR_NAME` if there is no such name, `MIEN_ERROR_INVALID_ARGUMENT` if the
    /// kind has no names in a document.
    pub fn mien_document_find(document: *const MienDocument, kind: u32, name: *const c_char, out_index: *mut u32, error: *mut MienError) -> MienStatus;

    /// Renames element `index` of a kind of `mien_document_find()` but PSD controls.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if there is no such element, `MIEN_ERROR_INVALID_ARGUMENT` if
    /// another element of the kind has the name, or the kind has no names in a document,
    /// `MIEN_ERROR_MEMORY` if the allocator returns NULL.
    pub fn mien_document_rename(document: *mut MienDocument, kind: u32, index: u32, name: *const c_char, error: *mut MienError) -> MienStatus;

    /// Removes controls, joints, blend shape channels, animated maps or meshes, and everything
    /// that refers to them: names, LOD lists, rows of tables, targets, regions of networks.
    /// `indices` has `index_count` elements; PSD, ML and RBF controls are numbered from 0.
    /// Children of a joint go to its nearest ancestor that stays, or become roots, and keep their
    /// neutral place in the world; motions that are relative to the parent keep their numbers. The
    /// joint's skin weights go to the same ancestor, or to the first joint that stays. Quaternion
    /// joints move as before within 1e-2 degrees; where the columns of a joint group would rotate
    /// them in another order, each quaternion joint of the group gets a joint group of its own. A
    /// raw, PSD, ML or RBF control is removed as if it stayed 0: with it go its columns of joint
    /// groups, its rows of channels and animated maps, PSD controls that are products of it, RBF
    /// solvers, twists and swings that read it, its inputs of networks, and the outputs of
    /// networks and RBF poses that set it. Networks that ML operations run cannot lose one: their
    /// controls are refused. Files before 2.5 cannot lose RBF controls.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if an index is past the end, `MIEN_ERROR_INVALID_ARGUMENT` if
    /// the networks or the version need a control, or no joint would be left for the skin weights,
    /// `MIEN_ERROR_DNA_STRUCTURE`, `MIEN_ERROR_DNA_REFERENCE`, `MIEN_ERROR_DNA_LIMIT` or
    /// `MIEN_ERROR_DNA_VALUE` if the document is not valid, `MIEN_ERROR_MEMORY` if the allocator
    /// returns NULL.
    pub fn mien_document_remove(document: *mut MienDocument, kind: u32, indices: *const u32, index_count: usize, error: *mut MienError) -> MienStatus;

    /// Removes all blend shape channels with their targets, all animated maps, or, for
    /// `MIEN_KIND_JOINT`, everything that moves joints. `kind` is a `MIEN_KIND_...`.
    ///
    /// Fails like `mien_document_remove()`, but not with `MIEN_ERROR_INDEX`.
    pub fn mien_document_clear(document: *mut MienDocument, kind: u32, error: *mut MienError) -> MienStatus;

    /// Removes everything that moves these joints: their rows of joint groups, twists, swings and
    /// ML joints.
    ///
    /// Fails like `mien_document_remove()`.
    pub fn mien_document_clear_joints(document: *mut MienDocument, joints: *const u32, joint_count: usize, error: *mut MienError) -> MienStatus;

    /// Sets neutral transforms of joints from `first_joint` on, relative to their parents, in the
    /// units and axes of the file: translations, 3 floats per joint, and rotations, 3 floats per
    /// joint. Either may be left out: `translations` may be NULL; `rotations` may be NULL.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if there are fewer joints, `MIEN_ERROR_INVALID_ARGUMENT` if a
    /// number is not finite, `MIEN_ERROR_DNA_STRUCTURE`, `MIEN_ERROR_DNA_REFERENCE`,
    /// `MIEN_ERROR_DNA_LIMIT` or `MIEN_ERROR_DNA_VALUE` if the document is not valid,
    /// `MIEN_ERROR_MEMORY` if the allocator returns NULL.
    pub fn mien_document_set_neutral(document: *mut MienDocument, first_joint: u32, translations: *const f32, rotations: *const f32, count: usize, error: *mut MienError) -> MienStatus;

    /// Sets all positions of a mesh, 3 floats per position. Normals do not change: deformers
    /// recompute them by default; otherwise write geom.meshes\[i\].normals.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if `mesh` is past the end, `MIEN_ERROR_INVALID_ARGUMENT` if
    /// the mesh has another number of positions, or a number is not finite, `MIEN_ERROR_MEMORY` if
    /// the allocator returns NULL.
    pub fn mien_document_set_positions(document: *mut MienDocument, mesh: u32, positions: *const f32, position_count: usize, error: *mut MienError) -> MienStatus;

    /// Sets the target of blend shape channel `channel` on mesh `mesh`: 3 floats per delta, of the
    /// positions `vertices`. `vertices` may be NULL for the first `count` positions. Deltas of
    /// zero are left out; if there are no others, the target is removed. The pair of mesh and
    /// channel in defn.meshBlendShapeChannelMapping is added or removed with it.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if `mesh`, `channel` or a vertex is past the end,
    /// `MIEN_ERROR_INVALID_ARGUMENT` if there are more deltas than positions, or a number is not
    /// finite, `MIEN_ERROR_DNA_STRUCTURE`, `MIEN_ERROR_DNA_REFERENCE`, `MIEN_ERROR_DNA_LIMIT` or
    /// `MIEN_ERROR_DNA_VALUE` if the document is not valid, `MIEN_ERROR_MEMORY` if the allocator
    /// returns NULL.
    pub fn mien_document_set_target(document: *mut MienDocument, mesh: u32, channel: u32, vertices: *const u32, deltas: *const f32, count: usize, error: *mut MienError) -> MienStatus;

    /// Removes deltas not longer than `tolerance`, in the unit of the file, and targets that have
    /// none left. `out_pruned` gets their numbers.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if `tolerance` is negative or not finite,
    /// `MIEN_ERROR_DNA_STRUCTURE`, `MIEN_ERROR_DNA_REFERENCE`, `MIEN_ERROR_DNA_LIMIT` or
    /// `MIEN_ERROR_DNA_VALUE` if the document is not valid, `MIEN_ERROR_MEMORY` if the allocator
    /// returns NULL.
    pub fn mien_document_prune_targets(document: *mut MienDocument, tolerance: f32, out_pruned: *mut MienPrunedTargets, error: *mut MienError) -> MienStatus;

    /// Sets small entries of the joint matrix to 0, and removes columns and rows of joint groups
    /// that have no others. Measures how far that moves the positions of LOD 0, with each raw
    /// control at 1, and with all raw controls of each corrective at 1. `desc` is required.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if a field of `desc` is negative or not finite,
    /// `MIEN_ERROR_DNA_STRUCTURE`, `MIEN_ERROR_DNA_REFERENCE`, `MIEN_ERROR_DNA_LIMIT` or
    /// `MIEN_ERROR_DNA_VALUE` if the document is not valid, `MIEN_ERROR_MEMORY` if the allocator
    /// returns NULL.
    pub fn mien_document_prune_joints(document: *mut MienDocument, desc: *const MienPruneJointsDesc, out_pruned: *mut MienPrunedJoints, error: *mut MienError) -> MienStatus;

    /// Sets the skin weights of a mesh: `influences` joints and weights per position, row by row.
    /// Weights of 0 are left out. `joints` has `weight_count` elements, as many as `weights`.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if `mesh` is past the end, `MIEN_ERROR_INVALID_ARGUMENT` if
    /// there is another number of weights, a weight is negative or not finite, a joint does not
    /// exist, or a position has a joint twice or no weight, `MIEN_ERROR_DNA_STRUCTURE`,
    /// `MIEN_ERROR_DNA_REFERENCE`, `MIEN_ERROR_DNA_LIMIT` or `MIEN_ERROR_DNA_VALUE` if the
    /// document is not valid, `MIEN_ERROR_MEMORY` if the allocator returns NULL.
    pub fn mien_document_set_weights(document: *mut MienDocument, mesh: u32, influences: u32, joints: *const u16, weights: *const f32, weight_count: usize, error: *mut MienError) -> MienStatus;

    /// Scales the weights of each position of mesh `mesh` to a sum of 1; sums within 1e-6 of it
    /// stay as they are.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if `mesh` is past the end, `MIEN_ERROR_DNA_STRUCTURE`,
    /// `MIEN_ERROR_DNA_REFERENCE`, `MIEN_ERROR_DNA_LIMIT` or `MIEN_ERROR_DNA_VALUE` if the
    /// document is not valid, `MIEN_ERROR_MEMORY` if the allocator returns NULL.
    pub fn mien_document_normalize_weights(document: *mut MienDocument, mesh: u32, error: *mut MienError) -> MienStatus;

    /// Keeps the `influences` largest weights of each position of mesh `mesh`, in their order,
    /// scaled to the previous sum.
    ///
    /// Fails like `mien_document_normalize_weights()`, and with `MIEN_ERROR_INVALID_ARGUMENT` if
    /// `influences` is 0.
    pub fn mien_document_limit_influences(document: *mut MienDocument, mesh: u32, influences: u32, error: *mut MienError) -> MienStatus;

    /// Smooths the weights of mesh `mesh` `iterations` times: those of each position become (1 -
    /// strength) times its own plus strength times the mean of its neighbors along edges.
    /// Positions at the same place count as one. Each keeps at most `influences`, with a sum of 1.
    ///
    /// Fails like `mien_document_limit_influences()`, and with `MIEN_ERROR_INVALID_ARGUMENT` if
    /// `strength` is not 0 to 1, or there are more than 1000 iterations.
    pub fn mien_document_smooth_weights(document: *mut MienDocument, mesh: u32, iterations: u32, strength: f32, influences: u32, error: *mut MienError) -> MienStatus;

    /// Scales, rotates and moves the whole character: neutral joints, positions, normals, targets,
    /// and the translations that controls add to joints. `placement` is required.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if a number is not finite or the scale is
    /// negative, `MIEN_ERROR_DNA_VALUE` if a root joint is moved by controls and the rotation is
    /// not 0, networks translate joints and the scale is not 1, or the document is not valid,
    /// `MIEN_ERROR_DNA_STRUCTURE`, `MIEN_ERROR_DNA_REFERENCE` or `MIEN_ERROR_DNA_LIMIT` if the
    /// document is not valid, `MIEN_ERROR_MEMORY` if the allocator returns NULL.
    pub fn mien_document_place(document: *mut MienDocument, placement: *const MienPlacement, error: *mut MienError) -> MienStatus;

    /// Keeps the LODs whose bits are set in `lods`, like MienDnaDesc.lods.
    ///
    /// Fails with `MIEN_ERROR_LOD` if none of them exists, `MIEN_ERROR_DNA_STRUCTURE`,
    /// `MIEN_ERROR_DNA_REFERENCE`, `MIEN_ERROR_DNA_LIMIT` or `MIEN_ERROR_DNA_VALUE` if the
    /// document is not valid, `MIEN_ERROR_MEMORY` if the allocator returns NULL.
    ///
    /// See docs/dna-format.md, 10 "Choosing LODs".
    pub fn mien_document_keep_lods(document: *mut MienDocument, lods: u64, error: *mut MienError) -> MienStatus;

    /// Converts to another coordinate system, like MienDnaDesc.system. `system` is required.
    ///
    /// Fails with `MIEN_ERROR_DNA_VALUE` if the rig cannot be converted or the document is not
    /// valid, `MIEN_ERROR_DNA_STRUCTURE`, `MIEN_ERROR_DNA_REFERENCE` or `MIEN_ERROR_DNA_LIMIT` if
    /// the document is not valid, `MIEN_ERROR_MEMORY` if the allocator returns NULL.
    ///
    /// See docs/dna-format.md, 11 "Coordinate systems".
    pub fn mien_document_convert(document: *mut MienDocument, system: *const MienCoordinateSystem, error: *mut MienError) -> MienStatus;

    /// Copies the layers of another document whose bits are set. `layers` is a `MIEN_LAYER_...`,
    /// combined with \|. Layers that refer to each other are copied together.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if `layers` has other bits,
    /// `MIEN_ERROR_DNA_STRUCTURE`, `MIEN_ERROR_DNA_REFERENCE`, `MIEN_ERROR_DNA_LIMIT` or
    /// `MIEN_ERROR_DNA_VALUE` if they do not fit the other layers, `MIEN_ERROR_MEMORY` if the
    /// allocator returns NULL.
    pub fn mien_document_copy_layers(document: *mut MienDocument, from: *const MienDocument, layers: u32, error: *mut MienError) -> MienStatus;

    /// Copies mesh `mesh` of another document. It replaces the mesh of the same name, or becomes a
    /// new one, at its LODs in the other document as far as this document has them. Joints and
    /// channels are found by name; the influence of a missing joint goes to its nearest ancestor
    /// that exists here, and targets of missing channels are left out.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if there is no such mesh, `MIEN_ERROR_INVALID_ARGUMENT` if
    /// both documents are the same, `MIEN_ERROR_MISMATCH` if the documents differ in axes, units
    /// or rotations, or this one has no joint of a position, `MIEN_ERROR_DNA_STRUCTURE`,
    /// `MIEN_ERROR_DNA_REFERENCE`, `MIEN_ERROR_DNA_LIMIT` or `MIEN_ERROR_DNA_VALUE` if one of them
    /// is not valid, `MIEN_ERROR_MEMORY` if the allocator returns NULL.
    pub fn mien_document_copy_mesh(document: *mut MienDocument, from: *const MienDocument, mesh: u32, out_mesh: *mut u32, error: *mut MienError) -> MienStatus;

    /// Adds the joints of another document whose names this one lacks, such as those of a body to
    /// a head: below the joints with the names of their parents, numbered after the existing ones,
    /// at the LODs that list them in the other document. Joints of both documents stay as they
    /// are, but a root that has a parent in the other one becomes its child. They must have the
    /// same place in model space, within `tolerance` in the unit of the file.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if both documents are the same,
    /// `MIEN_ERROR_MISMATCH` if they differ in axes, units or rotations, or in the place of a
    /// joint, `MIEN_ERROR_DNA_STRUCTURE`, `MIEN_ERROR_DNA_REFERENCE`, `MIEN_ERROR_DNA_LIMIT` or
    /// `MIEN_ERROR_DNA_VALUE` if one of them is not valid or the result would not be,
    /// `MIEN_ERROR_MEMORY` if the allocator returns NULL.
    pub fn mien_document_merge_joints(document: *mut MienDocument, from: *const MienDocument, tolerance: f64, error: *mut MienError) -> MienStatus;

    /// Removes the joints whose names another document lacks, like `mien_document_remove()`.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if no joint would be left for the skin weights,
    /// `MIEN_ERROR_DNA_STRUCTURE`, `MIEN_ERROR_DNA_REFERENCE`, `MIEN_ERROR_DNA_LIMIT` or
    /// `MIEN_ERROR_DNA_VALUE` if `document` is not valid, `MIEN_ERROR_MEMORY` if the allocator
    /// returns NULL.
    pub fn mien_document_split_joints(document: *mut MienDocument, from: *const MienDocument, error: *mut MienError) -> MienStatus;

    /// Gives mesh `mesh` the skin weights and targets of mesh `source`, interpolated at the point
    /// of `source` nearest to each position: a coarser LOD from a finer one. The influence of
    /// joints that no LOD of the mesh lists goes to the nearest ancestor that one of them lists;
    /// targets of channels that none lists are left out. If these LODs list no joints or channels
    /// at all, all are kept. `out_farthest` gets the largest distance to a nearest point, in the
    /// unit of the file or of the texture.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if `mesh` or `source` is past the end,
    /// `MIEN_ERROR_INVALID_ARGUMENT` if they are the same, or lack triangles, texture coordinates
    /// or weights, `MIEN_ERROR_DNA_STRUCTURE`, `MIEN_ERROR_DNA_REFERENCE`, `MIEN_ERROR_DNA_LIMIT`
    /// or `MIEN_ERROR_DNA_VALUE` if the document is not valid, `MIEN_ERROR_MEMORY` if the
    /// allocator returns NULL.
    pub fn mien_document_project(document: *mut MienDocument, mesh: u32, source: u32, desc: *const MienProjectDesc, out_farthest: *mut f64, error: *mut MienError) -> MienStatus;

    /// The same for all meshes of LOD `lod`, each from the mesh of LOD `source_lod` whose name
    /// differs only in the number of the LOD ("`head_lod3_mesh`" from "`head_lod0_mesh`"). A LOD
    /// that lists no joints or channels gets those of `source_lod`.
    ///
    /// Fails with `MIEN_ERROR_LOD` if there is no such LOD, `MIEN_ERROR_NAME` if a mesh has no
    /// counterpart, `MIEN_ERROR_INVALID_ARGUMENT` if the LODs are the same, or meshes lack
    /// triangles, texture coordinates or weights, `MIEN_ERROR_DNA_STRUCTURE`,
    /// `MIEN_ERROR_DNA_REFERENCE`, `MIEN_ERROR_DNA_LIMIT` or `MIEN_ERROR_DNA_VALUE` if the
    /// document is not valid, `MIEN_ERROR_MEMORY` if the allocator returns NULL.
    pub fn mien_document_make_lod(document: *mut MienDocument, lod: u32, source_lod: u32, desc: *const MienProjectDesc, out_farthest: *mut f64, error: *mut MienError) -> MienStatus;

    /// Gives mesh `mesh` new positions, 3 floats per position, such as a head that an artist
    /// reshaped, and lets the rig follow: joints move with the surface around them and keep their
    /// orientation; targets rotate and scale with the surface, translations that controls add to
    /// joints scale with it, and normals rotate. `others` is 0, or 1 to move the other meshes,
    /// too. A motion of the whole mesh is followed exactly.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if `mesh` is past the end, `MIEN_ERROR_INVALID_ARGUMENT` if
    /// the mesh has another number of positions, or a number is not finite,
    /// `MIEN_ERROR_DNA_STRUCTURE`, `MIEN_ERROR_DNA_REFERENCE`, `MIEN_ERROR_DNA_LIMIT` or
    /// `MIEN_ERROR_DNA_VALUE` if the document is not valid, `MIEN_ERROR_MEMORY` if the allocator
    /// returns NULL.
    pub fn mien_document_conform(document: *mut MienDocument, mesh: u32, positions: *const f32, position_count: usize, others: u32, out_conformed: *mut MienConformed, error: *mut MienError) -> MienStatus;

    /// Gives a character the rig of a template: controls, joints, behavior, and LODs of document
    /// `rig`. The character keeps its shape. Its meshes keep topology and positions where the
    /// template has a mesh of the same name, and get weights and targets from it; other meshes are
    /// the template's, moved with the surface. Joints with names of joints of the character keep
    /// the places of those, others move with the surface. `out_errors` has `capacity` elements,
    /// one for each raw control of both rigs, or fewer; `out_errors` may be NULL; `out_count` gets
    /// the number written.
    ///
    /// Fails with `MIEN_ERROR_MISMATCH` if the documents differ in axes, units or rotations,
    /// `MIEN_ERROR_INVALID_ARGUMENT` if no mesh of LOD 0 has the name of one of the template, or
    /// meshes lack triangles or texture coordinates, `MIEN_ERROR_DNA_STRUCTURE`,
    /// `MIEN_ERROR_DNA_REFERENCE`, `MIEN_ERROR_DNA_LIMIT` or `MIEN_ERROR_DNA_VALUE` if one of them
    /// is not valid, `MIEN_ERROR_MEMORY` if the allocator returns NULL.
    pub fn mien_document_transplant(document: *mut MienDocument, rig: *const MienDocument, desc: *const MienTransplantDesc, out_errors: *mut MienControlError, capacity: usize, out_count: *mut usize, error: *mut MienError) -> MienStatus;

    /// Opens the document as a file, with all checks of opening a file. `document` may be
    /// destroyed afterwards. Close with `mien_dna_close()`.
    ///
    /// Fails with `MIEN_ERROR_DNA_TRUNCATED`, `MIEN_ERROR_DNA_STRUCTURE`,
    /// `MIEN_ERROR_DNA_REFERENCE`, `MIEN_ERROR_DNA_LIMIT` or `MIEN_ERROR_DNA_VALUE` if the
    /// document is not a valid file; the message names the first invalid field,
    /// `mien_document_validate()` lists them all.
    ///
    /// See docs/dna-format.md, 13 "What is checked".
    pub fn mien_document_to_dna(document: *const MienDocument, desc: *const MienDocumentDesc, out_dna: *mut *mut MienDna, error: *mut MienError) -> MienStatus;

    /// Writes the document to a file, like `mien_dna_write_file()`, with all checks of opening it
    /// as a file.
    ///
    /// Fails with `MIEN_ERROR_FILE_WRITE` if the file cannot be written,
    /// `MIEN_ERROR_DNA_STRUCTURE`, `MIEN_ERROR_DNA_REFERENCE` or `MIEN_ERROR_DNA_VALUE` if the
    /// document is not a valid file, or would not be one in the requested version,
    /// `MIEN_ERROR_DNA_LIMIT` if the file would exceed 4 GiB, `MIEN_ERROR_MEMORY` if the allocator
    /// returns NULL.
    pub fn mien_document_write_file(document: *const MienDocument, path: *const c_char, desc: *const MienWriteDesc, error: *mut MienError) -> MienStatus;

    /// Passes the bytes of the file to `sink`, in pieces of at most 8 MiB.
    ///
    /// Fails like `mien_document_write_file()`, also with `MIEN_ERROR_FILE_WRITE` if `sink` does
    /// not take a piece.
    pub fn mien_document_write_stream(document: *const MienDocument, sink: *const MienByteSink, desc: *const MienWriteDesc, error: *mut MienError) -> MienStatus;

    /// Writes the document to memory and returns its size in `out_size`. `buffer` may be NULL with
    /// capacity 0 to get the size only. Writes nothing if `capacity` is too small; `out_size` is
    /// set nevertheless.
    ///
    /// Fails like `mien_document_write_file()`, but not with `MIEN_ERROR_FILE_WRITE`, and with
    /// `MIEN_ERROR_INVALID_ARGUMENT` if `capacity` is too small.
    pub fn mien_document_write_memory(document: *const MienDocument, desc: *const MienWriteDesc, buffer: *mut c_void, capacity: usize, out_size: *mut usize, error: *mut MienError) -> MienStatus;

    /// Checks the document like `mien_dna_validate_memory()` its file. `document` may be destroyed
    /// afterwards. Destroy with `mien_report_destroy()`.
    ///
    /// Fails with `MIEN_ERROR_DNA_LIMIT` if the file would exceed 4 GiB.
    pub fn mien_document_validate(document: *const MienDocument, desc: *const MienValidateDesc, out_report: *mut *mut MienReport, error: *mut MienError) -> MienStatus;

    /// Creates a fit. `desc` is required. `rig` must outlive the fit; the deformer may be
    /// destroyed. Measures the effect of each control, which takes up to some seconds for large
    /// rigs. Destroy with `mien_fit_destroy()`.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if a control, position or mesh does not exist,
    /// `MIEN_ERROR_LOD` if the rig has no such LOD, `MIEN_ERROR_MISMATCH` if the deformer belongs
    /// to another rig, `MIEN_ERROR_INVALID_ARGUMENT` if controls are not ascending, a lower bound
    /// is above its upper one, or a weight is not finite.
    pub fn mien_fit_create(rig: *const MienRig, desc: *const MienFitDesc, out_fit: *mut *mut MienFit, error: *mut MienError) -> MienStatus;

    /// Destroys a fit. NULL is allowed.
    pub fn mien_fit_destroy(fit: *mut MienFit);

    /// Creates a surface with a tree to find the nearest points. `desc` is required. Destroy with
    /// `mien_fit_surface_destroy()`.
    ///
    /// Fails with `MIEN_ERROR_INDEX` if a position does not exist, `MIEN_ERROR_INVALID_ARGUMENT`
    /// if there are no triangles, or a coordinate is not finite.
    pub fn mien_fit_surface_create(desc: *const MienFitSurfaceDesc, out_surface: *mut *mut MienFitSurface, error: *mut MienError) -> MienStatus;

    /// Destroys a surface. NULL is allowed.
    pub fn mien_fit_surface_destroy(surface: *mut MienFitSurface);

    /// Finds the raw controls of a frame by bounded Gauss-Newton steps with Levenberg-Marquardt
    /// damping. Writes all raw controls of the rig to `out_raw`; those that may not move keep
    /// their values of `start`. `result` may be NULL. Deterministic unless there is a time limit.
    /// Does not allocate or lock.
    ///
    /// Fails with `MIEN_ERROR_NULL_ARGUMENT` if points, images or a surface are given to a fit
    /// without points, or images without a camera, or constraints on joints to one without a
    /// deformer, `MIEN_ERROR_INVALID_ARGUMENT` if a stage is above 15, or a weight, a control, an
    /// offset or a number of the camera is not finite, or a weight is negative,
    /// `MIEN_ERROR_HANDLE` if `surface` is none, `MIEN_ERROR_INDEX` if a constraint has a joint or
    /// point that does not exist.
    pub fn mien_fit_solve(fit: *mut MienFit, frame: *const MienFitFrame, out_raw: *mut f32, result: *mut MienFitResult) -> MienStatus;

    /// Solves `count` frames of a motion, each from the result of the one before. `joints`,
    /// `points`, `images`, `point_weights` and `surface_weights` of `frame` have a row for each
    /// frame, one after the other; all else is for all frames. `start` and `stages` are for the
    /// first frame, and so is `camera`, if it may move. `out_raw` gets a row of all raw controls
    /// for each frame; `results`, which may be NULL, one result for each, all with the
    /// `struct_size` of the first. Where joints are the only targets, this is faster than calls of
    /// `mien_fit_solve()`, and differs from them by rounding. Deterministic unless there is a time
    /// limit, which is that of a frame. Does not allocate or lock.
    ///
    /// Fails like `mien_fit_solve()`.
    pub fn mien_fit_solve_frames(fit: *mut MienFit, frame: *const MienFitFrame, count: usize, out_raw: *mut f32, results: *mut MienFitResult) -> MienStatus;

    /// Writes for each raw control how well the data determines it at the initial pose: 0 if it
    /// moves nothing that has a target, or if other controls have the same effect; up to 1 for the
    /// best determined one. The parts of a rotation get the value of the turn that is determined
    /// least. `count` is the number of raw controls.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if `count` is another number.
    pub fn mien_fit_observability(fit: *const MienFit, out_values: *mut f32, count: usize) -> MienStatus;

    /// Chooses keys of a curve: straight lines between them are within `tolerance` of all values.
    /// `out_keys` gets the frame numbers, ascending, the first and the last frame among them;
    /// `out_key_count` gets how many. `count` is the number of values and the capacity of
    /// `out_keys`.
    ///
    /// Fails with `MIEN_ERROR_INVALID_ARGUMENT` if a value is not finite, or the tolerance is
    /// negative or not finite.
    pub fn mien_fit_keys(values: *const f32, count: usize, tolerance: f32, out_keys: *mut u32, out_key_count: *mut usize) -> MienStatus;
}
