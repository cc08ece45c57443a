// SPDX-License-Identifier: MIT
// Written by generate_api.py from mien.h. Do not edit.

use crate::{c_char, c_void, size_of, zeroed, Opaque};

/// A `MIEN_OK` or `MIEN_ERROR_...` value.
pub type MienStatus = i32;

/// One task of a MienParallelFor.
pub type MienTask = Option<unsafe extern "C" fn(context: *mut c_void, index: u32)>;

pub const MIEN_VERSION_MAJOR: u32 = 0;
pub const MIEN_VERSION_MINOR: u32 = 1;
pub const MIEN_VERSION_PATCH: u32 = 0;
pub const MIEN_VERSION: u32 = 65536;
/// Value of a byte offset where there is none.
pub const MIEN_NO_OFFSET: u64 = 18446744073709551615;

// enum MienStatusCode
pub const MIEN_OK: MienStatus = 0;
/// A required pointer is NULL.
pub const MIEN_ERROR_NULL_ARGUMENT: MienStatus = 1;
/// A value outside its range, or a buffer that is too small.
pub const MIEN_ERROR_INVALID_ARGUMENT: MienStatus = 2;
/// `struct_size` is too small, or unknown fields are not zero.
pub const MIEN_ERROR_STRUCT_SIZE: MienStatus = 3;
/// A handle of the wrong kind.
pub const MIEN_ERROR_HANDLE: MienStatus = 4;
/// Objects that do not belong together.
pub const MIEN_ERROR_MISMATCH: MienStatus = 5;
/// An index past the end.
pub const MIEN_ERROR_INDEX: MienStatus = 6;
/// A LOD that does not exist, or that the object has no memory for.
pub const MIEN_ERROR_LOD: MienStatus = 7;
/// No such name or path.
pub const MIEN_ERROR_NAME: MienStatus = 8;
/// An instruction set that this CPU or build lacks.
pub const MIEN_ERROR_ISA: MienStatus = 9;
/// The allocator returned NULL.
pub const MIEN_ERROR_MEMORY: MienStatus = 10;
/// The file cannot be opened.
pub const MIEN_ERROR_FILE_OPEN: MienStatus = 20;
/// The file or stream cannot be read.
pub const MIEN_ERROR_FILE_READ: MienStatus = 21;
/// The file cannot be written.
pub const MIEN_ERROR_FILE_WRITE: MienStatus = 22;
/// Not a DNA file.
pub const MIEN_ERROR_DNA_SIGNATURE: MienStatus = 30;
/// A DNA file of a generation other than 2.
pub const MIEN_ERROR_DNA_VERSION: MienStatus = 31;
/// The file is shorter than its header or counts state.
pub const MIEN_ERROR_DNA_TRUNCATED: MienStatus = 32;
/// Offsets, sizes or counts contradict each other.
pub const MIEN_ERROR_DNA_STRUCTURE: MienStatus = 33;
/// An index that refers to nothing.
pub const MIEN_ERROR_DNA_REFERENCE: MienStatus = 34;
/// A count above the limit of the format or of Mien.
pub const MIEN_ERROR_DNA_LIMIT: MienStatus = 35;
/// A required layer is not loaded or not in the file.
pub const MIEN_ERROR_DNA_LAYER: MienStatus = 36;
/// A value without a meaning, or one that cannot be converted.
pub const MIEN_ERROR_DNA_VALUE: MienStatus = 37;
/// Not a baked file.
pub const MIEN_ERROR_BAKED_SIGNATURE: MienStatus = 50;
/// Baked by another version or for another kind of machine.
pub const MIEN_ERROR_BAKED_VERSION: MienStatus = 51;
/// The file is shorter than its header states.
pub const MIEN_ERROR_BAKED_TRUNCATED: MienStatus = 52;
/// Sizes, counts or indices contradict each other.
pub const MIEN_ERROR_BAKED_STRUCTURE: MienStatus = 53;
/// The bytes are not those that were written.
pub const MIEN_ERROR_BAKED_CHECKSUM: MienStatus = 54;
/// The file does not contain the requested object.
pub const MIEN_ERROR_BAKED_PART: MienStatus = 55;

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
/// Map the file; read it into memory if it cannot be mapped, as pipes.
pub const MIEN_FILE_MAP: u32 = 0;
/// Read the whole file into memory: safe if it is truncated later.
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
/// The sequence of the file, about the renamed axes: where x becomes z, xyz becomes zyx, xzy
/// becomes zxy, and so on.
pub const MIEN_ROTATION_RULE_CARRIED: u32 = 0;
/// The requested sequence. Neutral poses, quaternion joints, twists, swings, ML joints and joints
/// that rotate about one axis only are converted exactly; rigs with other joints are rejected with
/// `MIEN_ERROR_DNA_VALUE`.
pub const MIEN_ROTATION_RULE_EXACT: u32 = 1;
/// The requested sequence, each column of the joint matrix on its own: exact while one control is
/// 1 and the others are 0, approximate for small angles.
pub const MIEN_ROTATION_RULE_PER_COLUMN: u32 = 2;

// enum MienFieldType
/// Named fields.
pub const MIEN_FIELD_RECORD: u32 = 0;
/// Records, strings or arrays; element i has the path of the list + \[i\].
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

// enum MienPreset
/// Readable by eye.
pub const MIEN_PRESET_TINY: u32 = 0;
pub const MIEN_PRESET_SMALL: u32 = 1;
pub const MIEN_PRESET_MEDIUM: u32 = 2;
/// A production head: 870 joints, 260 raw controls, 8 LODs, a million matrix entries.
pub const MIEN_PRESET_LARGE: u32 = 3;
/// A production body: 342 joints that 72 RBF solvers with 670 poses, 22 twists and 16 swings move,
/// some of them represented by quaternions.
pub const MIEN_PRESET_BODY: u32 = 4;
/// A stylized person to look at: skin, eyes, teeth, tongue, hair; the 52 expressions of ARKit as
/// raw controls under their names (values 0..1), correctives, wrinkle maps, 8 LODs. Seed 0 is the
/// one that was designed, others vary proportions and colors. Vertex colors are in the metadata:
/// key "mien.colors.\<mesh name\>", value base64 of 3 bytes (sRGB) per position of the mesh.
pub const MIEN_PRESET_HEAD: u32 = 5;

// enum MienGenerate
/// With learned behavior: networks by mesh region, every activation, their operations, and joints
/// that they move (not for `MIEN_PRESET_HEAD`).
pub const MIEN_GENERATE_ML: u32 = 1;

// enum MienIsa
/// The best that this CPU and operating system allow.
pub const MIEN_ISA_BEST: u32 = 0;
pub const MIEN_ISA_SCALAR: u32 = 1;
pub const MIEN_ISA_SSE2: u32 = 2;
/// With FMA and F16C.
pub const MIEN_ISA_AVX2: u32 = 3;
/// F, CD, DQ, BW, VL.
pub const MIEN_ISA_AVX512: u32 = 4;
pub const MIEN_ISA_NEON: u32 = 5;
/// The one that the environment variable `MIEN_ISA` names ("scalar", "sse2", ...); the best if it
/// is unset or empty.
pub const MIEN_ISA_ENVIRONMENT: u32 = 1000;

// enum MienRotationOutput
/// 9 values per joint: tx ty tz rx ry rz sx sy sz.
pub const MIEN_ROTATION_OUTPUT_EULER: u32 = 0;
/// 10 values per joint: tx ty tz qx qy qz qw sx sy sz.
pub const MIEN_ROTATION_OUTPUT_QUATERNION: u32 = 1;

// enum MienMlMasks
/// 0: the networks give their default (0, or 1 for the w of a quaternion); anything else: they are
/// evaluated. What files were made for.
pub const MIEN_ML_MASKS_SWITCH: u32 = 0;
/// In between, outputs are blended with the default; clamped to 0..1.
pub const MIEN_ML_MASKS_BLEND: u32 = 1;

// enum MienStorage
pub const MIEN_STORAGE_32_BIT: u32 = 0;
/// 16 bits: network weights and columns of quaternion joints in IEEE half precision (to nearest,
/// ties to even; what exceeds its range becomes +-65504); the joint matrix as 16-bit fixed point,
/// in units of the largest entry of the row / 32767. Half the memory.
pub const MIEN_STORAGE_16_BIT: u32 = 1;

// enum MienArithmetic
/// Those on AVX2, AVX-512 and NEON, which multiply and add in one step; and those on scalar and
/// SSE2.
pub const MIEN_ARITHMETIC_FAST: u32 = 0;
/// All: in two steps everywhere. Angles and quaternions are the same as far as the C library's
/// sine and arc tangent are.
pub const MIEN_ARITHMETIC_PORTABLE: u32 = 1;

// enum MienReuse
pub const MIEN_REUSE_UNCHANGED: u32 = 0;
/// Everything is computed each time: for measuring.
pub const MIEN_REUSE_NOTHING: u32 = 1;

// enum MienKind
pub const MIEN_KIND_GUI_CONTROL: u32 = 0;
pub const MIEN_KIND_RAW_CONTROL: u32 = 1;
/// Correctives: DNA files do not name them; here "psd0", "psd1", ...
pub const MIEN_KIND_PSD_CONTROL: u32 = 2;
pub const MIEN_KIND_ML_CONTROL: u32 = 3;
pub const MIEN_KIND_RBF_CONTROL: u32 = 4;
pub const MIEN_KIND_JOINT: u32 = 5;
pub const MIEN_KIND_BLEND_SHAPE_CHANNEL: u32 = 6;
pub const MIEN_KIND_ANIMATED_MAP: u32 = 7;
pub const MIEN_KIND_MESH: u32 = 8;
/// One per region of a mesh; "mesh/region".
pub const MIEN_KIND_ML_MASK: u32 = 9;
/// The last three have no names.
pub const MIEN_KIND_JOINT_GROUP: u32 = 10;
pub const MIEN_KIND_RBF_SOLVER: u32 = 11;
/// A swing with the twists of the same inputs, or a twist alone.
pub const MIEN_KIND_TWIST_SWING: u32 = 12;

// enum MienStage
/// Neural networks.
pub const MIEN_STAGE_ML: u32 = 1;
pub const MIEN_STAGE_RBF: u32 = 2;
pub const MIEN_STAGE_PSD: u32 = 4;
/// Joint groups, then twists and swings, then joints that networks move.
pub const MIEN_STAGE_JOINTS: u32 = 8;
pub const MIEN_STAGE_BLEND_SHAPES: u32 = 16;
pub const MIEN_STAGE_ANIMATED_MAPS: u32 = 32;
pub const MIEN_STAGE_ALL: u32 = 63;

// enum MienCompose
/// Neutral rotation \* delta rotation: the delta turns first.
pub const MIEN_COMPOSE_PRODUCT: u32 = 0;
/// The angles are added; needs `MIEN_ROTATION_OUTPUT_EULER`. The same where the neutral rotation
/// is zero.
pub const MIEN_COMPOSE_EULER_ADD: u32 = 1;

// enum MienWeights
pub const MIEN_WEIGHTS_AS_STORED: u32 = 0;
/// Negative weights count as 0, and the weights of a position sum to 1.
pub const MIEN_WEIGHTS_FIX: u32 = 1;

// enum MienNormals
/// What MienDeformerDesc.normals says; there: recomputed.
pub const MIEN_NORMALS_DEFAULT: u32 = 0;
/// Left as they are.
pub const MIEN_NORMALS_NONE: u32 = 1;
/// Neutral normals turned as the skin is, right for any scale; but blend shape targets do not turn
/// them (they carry none).
pub const MIEN_NORMALS_SKINNED: u32 = 2;
/// Sum of the area vectors of the faces around the position. Where that is more than 30 degrees
/// off the neutral normal (a hard edge), the neutral normal is turned as the sum turned since
/// neutral.
pub const MIEN_NORMALS_RECOMPUTED: u32 = 3;

// enum MienVertexFormat
/// 12 bytes: x y z.
pub const MIEN_VERTEX_FORMAT_FLOAT32X3: u32 = 0;
/// 16 bytes: x y z w.
pub const MIEN_VERTEX_FORMAT_FLOAT32X4: u32 = 1;
/// 8 bytes: x y z w, 16 bits each.
pub const MIEN_VERTEX_FORMAT_SNORM16X4: u32 = 2;
/// 4 bytes, one 32-bit word: x in bits 0-9, y in 10-19, z in 20-29, w in 30-31.
pub const MIEN_VERTEX_FORMAT_SNORM10_10_10_2: u32 = 3;

// enum MienBakedCheck
/// Every size, count and index: whatever the bytes are, nothing is read or written outside of the
/// objects and their instances. Numbers are not looked at, so their pages stay on disk until they
/// are needed.
pub const MIEN_BAKED_CHECK_SAFE: u32 = 0;
/// Also that all bytes are those that were written: reads them all.
pub const MIEN_BAKED_CHECK_FULL: u32 = 1;

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

#[repr(C)]
pub struct MienRig {
    _size: [u8; 0],
    _opaque: Opaque,
}

#[repr(C)]
pub struct MienInstance {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// Room for evaluating many instances of a rig at once.
#[repr(C)]
pub struct MienBatch {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// The geometry of a DNA and the hierarchy of its joints, packed once, then immutable: one block,
/// shared by any number of characters and threads.
///
/// ```text
/// local    Translate(neutral + delta) * R * Scale(1 + delta), for column vectors. R is, as
///          MIEN_COMPOSE_... says, R(neutral) * R(delta), or the rotation of the summed angles.
///          With quaternion outputs R(delta) is the quaternion, of any length; zero is the
///          identity.
/// model    model of the parent * local; a root (its own parent) starts from the origin
/// skin     model * inverse of the model matrix of the neutral pose
/// vertex   sum of weight * skin * (neutral position + sum of channel weight * target delta), over
///          the joints that hold it: linear blend skinning. A vertex that no joint holds stays
///          where its targets put it. Channel weights within 1e-5 of 0 count as 0.
/// ```
///
/// Joints that a LOD lacks have no delta and pass on their parent's motion. A position is shared
/// by all faces around it; a vertex is a position with a texture coordinate and a normal (a layout
/// of the file), so a mesh has at least as many vertices as positions it uses.
#[repr(C)]
pub struct MienDeformer {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// One character's joint matrices, positions and normals: one block.
#[repr(C)]
pub struct MienDeformerInstance {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// A rig, and its deformer, as they are in memory: used where they lie, so that a shipped program
/// needs no DNA files. A baked file holds all that was chosen when its objects were created but
/// the instruction set and MienReuse; it serves all machines of a byte order. The same objects
/// give the same bytes. A later version of the library may refuse it with
/// `MIEN_ERROR_BAKED_VERSION`: keep the DNA.
#[repr(C)]
pub struct MienBaked {
    _size: [u8; 0],
    _opaque: Opaque,
}

/// Details of a failure, owned by the caller. A call that fails fills all fields; a call that
/// succeeds sets status to `MIEN_OK` and leaves the others as they are.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienError {
    pub struct_size: usize,
    /// In the file; `MIEN_NO_OFFSET`: not about a place in a file.
    pub byte_offset: u64,
    pub status: MienStatus,
    /// What is wrong, where, and what to do; terminated, cut if too long.
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

/// Memory functions of the caller; NULL instead of a MienAllocator means the C library's heap. The
/// struct is copied. Both functions must work until the object is destroyed, on every thread that
/// creates or destroys objects with it.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienAllocator {
    /// Passed to the functions.
    pub user: *mut c_void,
    /// Returns `size` bytes aligned to `alignment` (a power of two, at most 64), or NULL.
    pub allocate: Option<unsafe extern "C" fn(user: *mut c_void, size: usize, alignment: usize) -> *mut c_void>,
    /// Receives the size and alignment that the block was allocated with.
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
    /// Calls task(context, i) once for each i \< count, in any order, on any threads, and returns
    /// when all have finished. Tasks do not wait for each other and take about 10 microseconds
    /// each.
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
    /// Bytes; not terminated.
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

/// A file that the caller reads, for example from an archive. `read` is called during the call
/// that takes the stream, on its thread.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienStream {
    /// Passed to the function.
    pub user: *mut c_void,
    /// Of the file, in bytes.
    pub size: u64,
    /// Copies `size` bytes at `offset` to `buffer` and returns the number of bytes copied; a
    /// smaller number is an error. The range is within the file.
    pub read: Option<unsafe extern "C" fn(user: *mut c_void, offset: u64, buffer: *mut c_void, size: usize) -> usize>,
}

impl Default for MienStream {
    /// All zero.
    fn default() -> Self {
        // SAFETY: numbers, pointers and optional functions may be zero.
        unsafe { zeroed() }
    }
}

/// Axes, units and rotation conventions of a rig. Any handedness is allowed. See
/// docs/dna-format.md, 11 "Coordinate systems".
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
    /// Of the angles about x, y, z. 1: rotates y to z, z to x, x to y. -1: the other way. 0: the
    /// sign that leaves angles unchanged.
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
/// numbers; units round once. Texture coordinates and unknown layers are not converted. A
/// converted rig can be written; the file is of version 2.8 if its own version cannot state the
/// system.
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
    /// Convert to this system. NULL: keep that of the file.
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
    /// Size of the file. 0: generated.
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
    /// `MIEN_LAYER_...` that loads it. `MIEN_LAYER_UNKNOWN`: of an unknown kind.
    pub layer: u32,
    pub version_major: u32,
    pub version_minor: u32,
    /// It was read, not skipped or kept unread.
    pub is_loaded: u32,
    /// Of its first byte in the file.
    pub byte_offset: u64,
    pub byte_count: u64,
    /// Such as "bhvr"; terminated.
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
    /// An array of numbers, even if it has one element; not a single number or an element of an
    /// array.
    pub is_array: u32,
    /// Elements of an array or list, bytes of a string, fields of a record; 1 for a number.
    pub count: u64,
    /// Of the bytes of a string, of an array or of one of its elements in the file;
    /// `MIEN_NO_OFFSET`: other fields, and data that is not in the file.
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
    /// 1 to 8: write version 2.version; layers that it does not know are kept unless
    /// `unknown_layers` drops them, but 2.1 holds the four layers desc, defn, bhvr and geom only.
    /// 0: the version of the DNA.
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
    /// In the file; `MIEN_NO_OFFSET`: not about a place in the file.
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

#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienGenerateDesc {
    pub struct_size: usize,
    /// `MIEN_PRESET_...`
    pub preset: u32,
    /// `MIEN_GENERATE_...`, combined with \|.
    pub flags: u32,
    /// The same seed gives the same bytes on every machine.
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

#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienRigDesc {
    pub struct_size: usize,
    /// `MIEN_ISA_...`; one that is absent is `MIEN_ERROR_ISA`, never replaced silently.
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

#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienRigInfo {
    pub struct_size: usize,
    /// `MIEN_ISA_...` in use.
    pub isa: u32,
    pub lod_count: u32,
    /// `MIEN_TRANSLATION_UNIT_...`
    pub translation_unit: u32,
    /// `MIEN_ROTATION_UNIT_DEGREES` or \_RADIANS.
    pub rotation_unit: u32,
    /// `MIEN_DIRECTION_...` of x, y, z.
    pub axes: [u32; 3],
    /// `MIEN_ROTATION_SEQUENCE_XYZ` ...
    pub rotation_sequence: u32,
    pub rotation_signs: [i32; 3],
    /// Length of a control row: raw, PSD, ML, RBF, in this order.
    pub control_count: u32,
    /// Length of a row of joint outputs: 9 or 10 per joint.
    pub joint_value_count: u32,
    /// `MIEN_ROTATION_OUTPUT_...`
    pub rotation_output: u32,
    /// `MIEN_STORAGE_...`
    pub storage: u32,
    /// `MIEN_ARITHMETIC_...`
    pub arithmetic: u32,
    /// Memory of the rig; with its file if it was opened from one.
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

/// What one evaluation at a LOD works through.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienRigStatistics {
    pub struct_size: usize,
    pub lod: u32,
    /// Correctives computed.
    pub psd_count: u32,
    /// Joints that exist at this LOD.
    pub joint_count: u32,
    /// Rows of the joint groups.
    pub joint_row_count: u32,
    /// Channels written.
    pub blend_shape_count: u32,
    /// Rows of the animated map table.
    pub animated_map_row_count: u32,
    /// Solvers that the LOD lists.
    pub rbf_solver_count: u32,
    /// Joints represented by quaternions.
    pub quaternion_joint_count: u32,
    /// Of the joint matrix: 8 per block, blocks of zeros not counted.
    pub joint_entry_count: u64,
    /// Of the joint matrix, if every control is active: those of controls that are 0 are not read.
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

/// What the joint stage fetches for the control row as it is, at the LOD of the last evaluation
/// (before the first: LOD 0), if it keeps no results. Bytes count once, whatever the caches do.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienInstanceStatistics {
    pub struct_size: usize,
    /// Of the last evaluation.
    pub lod: u32,
    /// Of the control row: raw, PSD, ML and RBF controls.
    pub control_count: u32,
    /// Controls that are not 0.
    pub active_control_count: u32,
    /// Columns of the joint matrix that they drive at this LOD.
    pub joint_column_count: u32,
    /// Of these columns; 8 per block, as in MienRigStatistics.
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
    /// Instances per call: 1 to 2^20; 0 means 32.
    pub capacity: u32,
    /// At once, each with scratch memory of its own; 0 means 1: for calls without threads.
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

#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienDeformerDesc {
    pub struct_size: usize,
    /// `MIEN_ISA_...`; here `MIEN_ISA_BEST` means that of the rig.
    pub isa: u32,
    /// `MIEN_COMPOSE_...`
    pub compose: u32,
    /// `MIEN_WEIGHTS_...`
    pub weights: u32,
    /// `MIEN_NORMALS_...`: of calls that leave the choice open.
    pub normals: u32,
    /// Compute tangents, for `mien_deformer_instance_write_vertices()`.
    pub with_tangents: u32,
    /// 0.
    pub reserved: u32,
    pub allocator: *const MienAllocator,
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

#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienDeformerInfo {
    pub struct_size: usize,
    /// `MIEN_ISA_...` in use.
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
    /// As in the rig, with its names: `MIEN_KIND_MESH`.
    pub mesh_count: u32,
    /// Memory of the deformer.
    pub deformer_bytes: u64,
    /// Memory of a deformer instance with room for all meshes.
    pub instance_bytes: u64,
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

/// The neutral mesh. Views live as long as the deformer.
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
    /// Over all targets.
    pub delta_count: u32,
    /// Bit l: LOD l shows this mesh.
    pub lods: u64,
    /// X y z per position.
    pub positions: MienFloatView,
    /// X y z per vertex, unit length.
    pub normals: MienFloatView,
    /// X y z w per vertex, see MienVertexOutput; empty unless MienDeformerDesc.`with_tangents` was
    /// set.
    pub tangents: MienFloatView,
    /// U v per vertex, as in the file.
    pub texture_coordinates: MienFloatView,
    /// Position of each vertex.
    pub vertex_position_indices: MienIndex32View,
    /// Three vertices each, wound as in the file; faces of more corners are fans about their
    /// first.
    pub triangles: MienIndex32View,
    /// Channel of each target, in file order.
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
    /// Room for the meshes that these LODs show: bit l is LOD l. 0: for all meshes. A LOD that is
    /// not there counts for nothing.
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

/// One attribute of all vertices: vertex i takes the size of the format from data + i \* stride
/// on. `data` and `stride` are multiples of 4, `stride` is at least the size of the format.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienVertexStream {
    /// NULL: this attribute is not written.
    pub data: *mut c_void,
    /// bytes.
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

/// Where the vertices of a mesh go, in the order of MienMesh.`vertex_position_indices`. Streams
/// may be interleaved (the same stride) or apart, but share no byte. At least one is given.
///
/// ```text
/// positions  as floats; w is 1
/// normals    in any format; w is 0
/// tangents   in any format with a w. The tangent points where u grows on the surface while v stays
///            the same, perpendicular to the normal, and w * cross(normal, tangent) points where v
///            grows: w is 1, or -1 where the texture is mirrored. If you flip v (1 - v), negate w.
/// ```
///
/// Neutral tangents are computed as MikkTSpace does, but the vertices of the file are kept: where
/// MikkTSpace splits a vertex between triangles of both orientations, it takes the tangent and the
/// w of those with the larger sum of angles. docs/deformation.md, 4 "Tangents", lists all
/// differences. A vertex without texture coordinates gets an arbitrary perpendicular of its
/// normal, always the same, and w = 1. Tangents move with the skin, and are then made
/// perpendicular to the normal that is written.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienVertexOutput {
    pub struct_size: usize,
    /// Vertices for which each stream has memory: MienMesh.`vertex_count` or more.
    pub vertex_capacity: usize,
    pub positions: MienVertexStream,
    pub normals: MienVertexStream,
    /// Needs MienDeformerDesc.`with_tangents`.
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

#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienBakedDesc {
    pub struct_size: usize,
    /// `MIEN_FILE_...`; `MIEN_FILE_READ` also copies memory.
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

#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienBakedInfo {
    pub struct_size: usize,
    pub file_bytes: u64,
    /// Taken from the allocator.
    pub memory_bytes: u64,
    /// Of the file; 0 if it has no rig.
    pub rig_bytes: u64,
    /// Of the file; 0 if it has no deformer.
    pub deformer_bytes: u64,
    /// Of the file, with those that this library does not know.
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

#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienBakedRigDesc {
    pub struct_size: usize,
    /// `MIEN_ISA_...`, as in MienRigDesc.
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

#[repr(C)]
#[derive(Clone, Copy)]
pub struct MienBakedDeformerDesc {
    pub struct_size: usize,
    /// `MIEN_ISA_...`; here `MIEN_ISA_BEST` means that of the rig.
    pub isa: u32,
    /// `MIEN_NORMALS_...`: of calls that leave the choice open; `MIEN_NORMALS_DEFAULT`: as when it
    /// was baked.
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

extern "C" {
    /// Returns the `MIEN_VERSION` of the library in use, which may differ from that of this
    /// header.
    pub fn mien_version() -> u32;

    /// Returns "DNA\_TRUNCATED" for `MIEN_ERROR_DNA_TRUNCATED`, and "UNKNOWN" for other numbers.
    /// The string is static and terminated.
    pub fn mien_status_name(status: MienStatus) -> *const c_char;

    /// Returns the coordinate system of an engine or tool: "maya", "unreal", "unreal-mesh"
    /// (characters look along y), "unity", "godot", "blender", "gltf", "opengl", "directx" or
    /// "houdini". The rotation rule is `MIEN_ROTATION_RULE_CARRIED`; `rotation_sequence` is that
    /// of the engine's Euler angles, and is used once you set another rule. Fails with
    /// `MIEN_ERROR_NAME` if the name is none of these.
    pub fn mien_coordinate_system_find(name: *const c_char, out_system: *mut MienCoordinateSystem) -> MienStatus;

    /// Returns the coordinate system of an engine or tool: "maya", "unreal", "unreal-mesh"
    /// (characters look along y), "unity", "godot", "blender", "gltf", "opengl", "directx" or
    /// "houdini". The rotation rule is `MIEN_ROTATION_RULE_CARRIED`; `rotation_sequence` is that
    /// of the engine's Euler angles, and is used once you set another rule. Fails with
    /// `MIEN_ERROR_NAME` if the name is none of these.
    pub fn mien_coordinate_system_find_n(name: *const c_char, name_count: usize, out_system: *mut MienCoordinateSystem) -> MienStatus;

    /// Returns a name that `mien_coordinate_system_find()` accepts. The string is static. Fails
    /// with `MIEN_ERROR_INDEX` if `index` is past the last name.
    pub fn mien_coordinate_system_name(index: u32, out_name: *mut MienStringView) -> MienStatus;

    /// Opens a DNA file of version 2.1 to 2.8, or the known layers of a later 2.x. Checks
    /// everything that it loads. Close with `mien_dna_close()`.
    ///
    /// Numbers and names are read from the file when needed. Memory is used for lists: typically a
    /// few percent of the size of the loaded layers, at most 20 times that size. Do not truncate
    /// or overwrite a mapped file while it is open; replacing it by renaming is safe.
    ///
    /// Fails with `MIEN_ERROR_FILE_OPEN` or `MIEN_ERROR_FILE_READ` if the file cannot be read,
    /// `MIEN_ERROR_DNA_SIGNATURE` or `MIEN_ERROR_DNA_VERSION` if it is not a DNA file of
    /// generation 2, `MIEN_ERROR_DNA_TRUNCATED`, `MIEN_ERROR_DNA_STRUCTURE`,
    /// `MIEN_ERROR_DNA_REFERENCE`, `MIEN_ERROR_DNA_LIMIT` or `MIEN_ERROR_DNA_VALUE` if its
    /// contents are not valid or cannot be converted to the requested system, `MIEN_ERROR_LOD` if
    /// it has none of the requested LODs. See docs/dna-format.md, 13 "What is checked".
    pub fn mien_dna_open_file(path: *const c_char, desc: *const MienDnaDesc, out_dna: *mut *mut MienDna, error: *mut MienError) -> MienStatus;

    /// Opens a DNA file in memory: `size` bytes, of any alignment. `bytes` must outlive the
    /// MienDna, unchanged. Fails like `mien_dna_open_file()`, but not with `MIEN_ERROR_FILE_OPEN`
    /// or `MIEN_ERROR_FILE_READ`.
    pub fn mien_dna_open_memory(bytes: *const c_void, size: usize, desc: *const MienDnaDesc, out_dna: *mut *mut MienDna, error: *mut MienError) -> MienStatus;

    /// Opens a DNA file through a stream. Reads the header, the index and the requested layers,
    /// each once and in one piece, into memory of the allocator. Fails like
    /// `mien_dna_open_file()`, but not with `MIEN_ERROR_FILE_OPEN`.
    pub fn mien_dna_open_stream(stream: *const MienStream, desc: *const MienDnaDesc, out_dna: *mut *mut MienDna, error: *mut MienError) -> MienStatus;

    /// Closes a DNA. Rigs and deformers made from it stay valid; its views do not.
    pub fn mien_dna_close(dna: *mut MienDna);

    /// Returns the properties of a DNA.
    pub fn mien_dna_info(dna: *const MienDna, out_info: *mut MienDnaInfo) -> MienStatus;

    /// Returns entry `index` of the index table, in file order. Fails with `MIEN_ERROR_INDEX` if
    /// `index` is not below MienDnaInfo.`layer_count`. See docs/dna-format.md, 4.1 "Index table".
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
    /// Layers that are not loaded are empty. Fails with `MIEN_ERROR_NAME` if there is no such
    /// field (the message contains the part of the path that does not exist), `MIEN_ERROR_INDEX`
    /// if an index in the path is past the end. See docs/dna-format.md, 6 "Layers, field by
    /// field".
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
    /// Layers that are not loaded are empty. Fails with `MIEN_ERROR_NAME` if there is no such
    /// field (the message contains the part of the path that does not exist), `MIEN_ERROR_INDEX`
    /// if an index in the path is past the end. See docs/dna-format.md, 6 "Layers, field by
    /// field".
    pub fn mien_dna_field_n(dna: *const MienDna, path: *const c_char, path_count: usize, out_field: *mut MienDnaField, error: *mut MienError) -> MienStatus;

    /// Returns the name of field `index` of the record at a path. The empty path is the file
    /// itself, whose fields are the layers. The string is static. Fails with `MIEN_ERROR_NAME` if
    /// there is no such field, `MIEN_ERROR_INDEX` if `index` or an index in the path is past the
    /// end, `MIEN_ERROR_INVALID_ARGUMENT` if the field is not a record. See docs/dna-format.md, 6
    /// "Layers, field by field".
    pub fn mien_dna_child_name(dna: *const MienDna, path: *const c_char, index: u32, out_name: *mut MienStringView, error: *mut MienError) -> MienStatus;

    /// Returns the name of field `index` of the record at a path. The empty path is the file
    /// itself, whose fields are the layers. The string is static. Fails with `MIEN_ERROR_NAME` if
    /// there is no such field, `MIEN_ERROR_INDEX` if `index` or an index in the path is past the
    /// end, `MIEN_ERROR_INVALID_ARGUMENT` if the field is not a record. See docs/dna-format.md, 6
    /// "Layers, field by field".
    pub fn mien_dna_child_name_n(dna: *const MienDna, path: *const c_char, path_count: usize, index: u32, out_name: *mut MienStringView, error: *mut MienError) -> MienStatus;

    /// Copies `count` elements of a field, beginning with element `first`, to `out`, in native
    /// byte order. A field that is one number has one element. `out` may be NULL if `count` is 0.
    /// Integers are widened to 64 bits. Fails with `MIEN_ERROR_NAME` if there is no such field,
    /// `MIEN_ERROR_INDEX` if the range or an index in the path is past the end,
    /// `MIEN_ERROR_INVALID_ARGUMENT` if the field does not hold numbers of this kind.
    pub fn mien_dna_read_floats(dna: *const MienDna, path: *const c_char, first: u64, count: u64, out: *mut f32, error: *mut MienError) -> MienStatus;

    /// Copies `count` elements of a field, beginning with element `first`, to `out`, in native
    /// byte order. A field that is one number has one element. `out` may be NULL if `count` is 0.
    /// Integers are widened to 64 bits. Fails with `MIEN_ERROR_NAME` if there is no such field,
    /// `MIEN_ERROR_INDEX` if the range or an index in the path is past the end,
    /// `MIEN_ERROR_INVALID_ARGUMENT` if the field does not hold numbers of this kind.
    pub fn mien_dna_read_floats_n(dna: *const MienDna, path: *const c_char, path_count: usize, first: u64, count: u64, out: *mut f32, error: *mut MienError) -> MienStatus;

    /// Copies `count` elements of a field, beginning with element `first`, to `out`, in native
    /// byte order. A field that is one number has one element. `out` may be NULL if `count` is 0.
    /// Integers are widened to 64 bits. Fails with `MIEN_ERROR_NAME` if there is no such field,
    /// `MIEN_ERROR_INDEX` if the range or an index in the path is past the end,
    /// `MIEN_ERROR_INVALID_ARGUMENT` if the field does not hold numbers of this kind.
    pub fn mien_dna_read_integers(dna: *const MienDna, path: *const c_char, first: u64, count: u64, out: *mut i64, error: *mut MienError) -> MienStatus;

    /// Copies `count` elements of a field, beginning with element `first`, to `out`, in native
    /// byte order. A field that is one number has one element. `out` may be NULL if `count` is 0.
    /// Integers are widened to 64 bits. Fails with `MIEN_ERROR_NAME` if there is no such field,
    /// `MIEN_ERROR_INDEX` if the range or an index in the path is past the end,
    /// `MIEN_ERROR_INVALID_ARGUMENT` if the field does not hold numbers of this kind.
    pub fn mien_dna_read_integers_n(dna: *const MienDna, path: *const c_char, path_count: usize, first: u64, count: u64, out: *mut i64, error: *mut MienError) -> MienStatus;

    /// Returns a string of the file. Fails with `MIEN_ERROR_NAME` if there is no such field,
    /// `MIEN_ERROR_INDEX` if an index in the path is past the end, `MIEN_ERROR_INVALID_ARGUMENT`
    /// if the field is not a string.
    pub fn mien_dna_read_string(dna: *const MienDna, path: *const c_char, out_string: *mut MienStringView, error: *mut MienError) -> MienStatus;

    /// Returns a string of the file. Fails with `MIEN_ERROR_NAME` if there is no such field,
    /// `MIEN_ERROR_INDEX` if an index in the path is past the end, `MIEN_ERROR_INVALID_ARGUMENT`
    /// if the field is not a string.
    pub fn mien_dna_read_string_n(dna: *const MienDna, path: *const c_char, path_count: usize, out_string: *mut MienStringView, error: *mut MienError) -> MienStatus;

    /// Writes a DNA file in canonical form: if the original file was canonical and all of it was
    /// loaded, the same bytes. Layers that were not loaded are written empty. The file is written
    /// under a temporary name and renamed, so that a failure leaves `path` unchanged. Fails with
    /// `MIEN_ERROR_FILE_WRITE` if the file cannot be written, `MIEN_ERROR_DNA_LAYER` if RBF
    /// behavior was loaded without the machine-learned behavior of its file (whose controls are
    /// numbered before its own), `MIEN_ERROR_DNA_LIMIT` if the file would exceed 4 GiB,
    /// `MIEN_ERROR_MEMORY` if there is no memory for its bytes. See docs/dna-format.md, 14
    /// "Writing a canonical file".
    pub fn mien_dna_write_file(dna: *const MienDna, path: *const c_char, desc: *const MienWriteDesc, error: *mut MienError) -> MienStatus;

    /// Writes a DNA file to memory and returns its size in `out_size`. `buffer` may be NULL with
    /// capacity 0 to get the size only. Writes nothing if `capacity` is too small; `out_size` is
    /// set nevertheless. Fails with `MIEN_ERROR_INVALID_ARGUMENT` if `capacity` is too small,
    /// `MIEN_ERROR_DNA_LAYER` or `MIEN_ERROR_DNA_LIMIT` as `mien_dna_write_file()`.
    pub fn mien_dna_write_memory(dna: *const MienDna, desc: *const MienWriteDesc, buffer: *mut c_void, capacity: usize, out_size: *mut usize, error: *mut MienError) -> MienStatus;

    /// Checks all layers of a file and collects the findings: at most 32 per field and 1000 in
    /// total; the last one says if there are more. Returns `MIEN_OK` if the file could be checked,
    /// whatever was found. The file is read into memory, so it may change meanwhile. Destroy with
    /// `mien_report_destroy()`. Fails with `MIEN_ERROR_FILE_OPEN` or `MIEN_ERROR_FILE_READ` if the
    /// file cannot be read. See docs/dna-format.md, 13 "What is checked".
    pub fn mien_dna_validate_file(path: *const c_char, desc: *const MienValidateDesc, out_report: *mut *mut MienReport, error: *mut MienError) -> MienStatus;

    /// Checks a file in memory: `size` bytes. `bytes` may be released afterwards.
    pub fn mien_dna_validate_memory(bytes: *const c_void, size: usize, desc: *const MienValidateDesc, out_report: *mut *mut MienReport, error: *mut MienError) -> MienStatus;

    /// Returns the number of errors and the number of warnings.
    pub fn mien_report_counts(report: *const MienReport, out_errors: *mut u32, out_warnings: *mut u32) -> MienStatus;

    /// Returns finding `index`, in the order of the checks. There are as many as errors and
    /// warnings. Fails with `MIEN_ERROR_INDEX` if `index` is past the last finding.
    pub fn mien_report_finding(report: *const MienReport, index: u32, out_finding: *mut MienFinding) -> MienStatus;

    /// Destroys a report.
    pub fn mien_report_destroy(report: *mut MienReport);

    /// Makes a synthetic rig: behavior of realistic size and sparsity, with simple geometry.
    /// `desc` may be NULL (tiny, seed 0). Close with `mien_dna_close()`.
    pub fn mien_dna_generate(desc: *const MienGenerateDesc, out_dna: *mut *mut MienDna, error: *mut MienError) -> MienStatus;

    /// 1 if rigs can be created for this `MIEN_ISA_...` here. `MIEN_ISA_BEST` is always available.
    pub fn mien_isa_available(isa: u32) -> u32;

    /// "avx2" for `MIEN_ISA_AVX2`, "unknown" for other numbers. Static, terminated.
    pub fn mien_isa_name(isa: u32) -> *const c_char;

    /// Packs the behavior of `dna` for evaluation. The DNA needs definition and behavior loaded,
    /// else `MIEN_ERROR_DNA_LAYER`; correctives that depend on each other in a circle are
    /// `MIEN_ERROR_DNA_VALUE`. `desc` may be NULL. The DNA may be closed afterwards. The rig is
    /// one block of memory; making it takes some more for the time of the call.
    pub fn mien_rig_create(dna: *const MienDna, desc: *const MienRigDesc, out_rig: *mut *mut MienRig, error: *mut MienError) -> MienStatus;

    /// Memory is released when the last instance is gone too, so the order of destruction does not
    /// matter; a destroyed rig cannot be evaluated any more.
    pub fn mien_rig_destroy(rig: *mut MienRig);

    pub fn mien_rig_info(rig: *const MienRig, out_info: *mut MienRigInfo) -> MienStatus;

    pub fn mien_rig_count(rig: *const MienRig, kind: u32, out_count: *mut u32) -> MienStatus;

    /// Kinds without names give "".
    pub fn mien_rig_name(rig: *const MienRig, kind: u32, index: u32, out_name: *mut MienStringView) -> MienStatus;

    /// Exact match, in O(log n); of equal names the first. `MIEN_ERROR_NAME` if there is none.
    pub fn mien_rig_find(rig: *const MienRig, kind: u32, name: *const c_char, out_index: *mut u32) -> MienStatus;

    /// Exact match, in O(log n); of equal names the first. `MIEN_ERROR_NAME` if there is none.
    pub fn mien_rig_find_n(rig: *const MienRig, kind: u32, name: *const c_char, name_count: usize, out_index: *mut u32) -> MienStatus;

    /// Which joints, channels, maps, meshes or RBF solvers exist at a LOD, in file order. Other
    /// kinds: `MIEN_ERROR_INVALID_ARGUMENT`.
    pub fn mien_rig_lod_indices(rig: *const MienRig, kind: u32, lod: u32, out_indices: *mut MienIndex16View) -> MienStatus;

    /// Indices into the joint outputs that evaluation may change at a LOD, ascending: all others
    /// keep their initial value (0, or 1 for the w of a quaternion).
    pub fn mien_rig_variable_joint_values(rig: *const MienRig, lod: u32, out_indices: *mut MienIndex16View) -> MienStatus;

    /// Parent of each joint; a root is its own parent.
    pub fn mien_rig_joint_parents(rig: *const MienRig, out_parents: *mut MienIndex16View) -> MienStatus;

    /// Neutral pose in the layout of the joint outputs, relative to the parent: translation in
    /// translation units, rotation as angles in rotation units or as a quaternion, scale 1.
    pub fn mien_rig_neutral_joint_values(rig: *const MienRig, out_values: *mut MienFloatView) -> MienStatus;

    /// The controls whose product drives a corrective, as indices into the control row.
    pub fn mien_rig_psd_inputs(rig: *const MienRig, psd: u32, out_controls: *mut MienIndex16View) -> MienStatus;

    /// Value each raw control starts with: 0, or 1 for the w of a quaternion input.
    pub fn mien_rig_initial_raw_controls(rig: *const MienRig, out_values: *mut MienFloatView) -> MienStatus;

    pub fn mien_rig_statistics(rig: *const MienRig, lod: u32, out_statistics: *mut MienRigStatistics) -> MienStatus;

    /// One character in its initial state. One allocation of MienRigInfo.`instance_bytes`.
    pub fn mien_instance_create(rig: *const MienRig, desc: *const MienInstanceDesc, out_instance: *mut *mut MienInstance, error: *mut MienError) -> MienStatus;

    pub fn mien_instance_destroy(instance: *mut MienInstance);

    /// Everything as after creation.
    pub fn mien_instance_reset(instance: *mut MienInstance) -> MienStatus;

    /// Inputs, to be written in place: the views stay valid and the same until the instance is
    /// destroyed. GUI controls only matter to `mien_rig_map_gui_to_raw()`. Raw controls are
    /// usually in 0..1 but not clamped. Masks (one per region of a mesh, 0..1, initially 1) switch
    /// or blend learned behavior, see `MIEN_ML_MASKS_...`.
    pub fn mien_instance_gui_controls(instance: *mut MienInstance, out_view: *mut MienMutableFloatView) -> MienStatus;

    /// Inputs, to be written in place: the views stay valid and the same until the instance is
    /// destroyed. GUI controls only matter to `mien_rig_map_gui_to_raw()`. Raw controls are
    /// usually in 0..1 but not clamped. Masks (one per region of a mesh, 0..1, initially 1) switch
    /// or blend learned behavior, see `MIEN_ML_MASKS_...`.
    pub fn mien_instance_raw_controls(instance: *mut MienInstance, out_view: *mut MienMutableFloatView) -> MienStatus;

    /// Inputs, to be written in place: the views stay valid and the same until the instance is
    /// destroyed. GUI controls only matter to `mien_rig_map_gui_to_raw()`. Raw controls are
    /// usually in 0..1 but not clamped. Masks (one per region of a mesh, 0..1, initially 1) switch
    /// or blend learned behavior, see `MIEN_ML_MASKS_...`.
    pub fn mien_instance_ml_masks(instance: *mut MienInstance, out_view: *mut MienMutableFloatView) -> MienStatus;

    /// Outputs of the last evaluation; the views stay valid, their contents change with each
    /// evaluation.
    ///
    /// ```text
    /// controls      the whole control row: raw, PSD, ML, RBF
    /// joints        9 or 10 per joint, as MIEN_ROTATION_OUTPUT_... says: deltas from the neutral pose.
    ///               Translation, angles and scale are added to it; with quaternions the rotation is
    ///               the product neutral * delta (the delta turns first)
    /// blend shapes  one weight per channel
    /// animated maps one weight per map, 0..1
    /// ```
    pub fn mien_instance_controls(instance: *const MienInstance, out_view: *mut MienFloatView) -> MienStatus;

    /// Outputs of the last evaluation; the views stay valid, their contents change with each
    /// evaluation.
    ///
    /// ```text
    /// controls      the whole control row: raw, PSD, ML, RBF
    /// joints        9 or 10 per joint, as MIEN_ROTATION_OUTPUT_... says: deltas from the neutral pose.
    ///               Translation, angles and scale are added to it; with quaternions the rotation is
    ///               the product neutral * delta (the delta turns first)
    /// blend shapes  one weight per channel
    /// animated maps one weight per map, 0..1
    /// ```
    pub fn mien_instance_psd_controls(instance: *const MienInstance, out_view: *mut MienFloatView) -> MienStatus;

    /// Outputs of the last evaluation; the views stay valid, their contents change with each
    /// evaluation.
    ///
    /// ```text
    /// controls      the whole control row: raw, PSD, ML, RBF
    /// joints        9 or 10 per joint, as MIEN_ROTATION_OUTPUT_... says: deltas from the neutral pose.
    ///               Translation, angles and scale are added to it; with quaternions the rotation is
    ///               the product neutral * delta (the delta turns first)
    /// blend shapes  one weight per channel
    /// animated maps one weight per map, 0..1
    /// ```
    pub fn mien_instance_ml_controls(instance: *const MienInstance, out_view: *mut MienFloatView) -> MienStatus;

    /// Outputs of the last evaluation; the views stay valid, their contents change with each
    /// evaluation.
    ///
    /// ```text
    /// controls      the whole control row: raw, PSD, ML, RBF
    /// joints        9 or 10 per joint, as MIEN_ROTATION_OUTPUT_... says: deltas from the neutral pose.
    ///               Translation, angles and scale are added to it; with quaternions the rotation is
    ///               the product neutral * delta (the delta turns first)
    /// blend shapes  one weight per channel
    /// animated maps one weight per map, 0..1
    /// ```
    pub fn mien_instance_rbf_controls(instance: *const MienInstance, out_view: *mut MienFloatView) -> MienStatus;

    /// Outputs of the last evaluation; the views stay valid, their contents change with each
    /// evaluation.
    ///
    /// ```text
    /// controls      the whole control row: raw, PSD, ML, RBF
    /// joints        9 or 10 per joint, as MIEN_ROTATION_OUTPUT_... says: deltas from the neutral pose.
    ///               Translation, angles and scale are added to it; with quaternions the rotation is
    ///               the product neutral * delta (the delta turns first)
    /// blend shapes  one weight per channel
    /// animated maps one weight per map, 0..1
    /// ```
    pub fn mien_instance_joints(instance: *const MienInstance, out_view: *mut MienFloatView) -> MienStatus;

    /// Outputs of the last evaluation; the views stay valid, their contents change with each
    /// evaluation.
    ///
    /// ```text
    /// controls      the whole control row: raw, PSD, ML, RBF
    /// joints        9 or 10 per joint, as MIEN_ROTATION_OUTPUT_... says: deltas from the neutral pose.
    ///               Translation, angles and scale are added to it; with quaternions the rotation is
    ///               the product neutral * delta (the delta turns first)
    /// blend shapes  one weight per channel
    /// animated maps one weight per map, 0..1
    /// ```
    pub fn mien_instance_blend_shapes(instance: *const MienInstance, out_view: *mut MienFloatView) -> MienStatus;

    /// Outputs of the last evaluation; the views stay valid, their contents change with each
    /// evaluation.
    ///
    /// ```text
    /// controls      the whole control row: raw, PSD, ML, RBF
    /// joints        9 or 10 per joint, as MIEN_ROTATION_OUTPUT_... says: deltas from the neutral pose.
    ///               Translation, angles and scale are added to it; with quaternions the rotation is
    ///               the product neutral * delta (the delta turns first)
    /// blend shapes  one weight per channel
    /// animated maps one weight per map, 0..1
    /// ```
    pub fn mien_instance_animated_maps(instance: *const MienInstance, out_view: *mut MienFloatView) -> MienStatus;

    /// For tools that relate times to memory. Looks at each control, so it is not for every frame.
    pub fn mien_instance_statistics(instance: *const MienInstance, out_statistics: *mut MienInstanceStatistics) -> MienStatus;

    /// Raw controls from GUI controls, and back. Forward writes only raw controls that some row of
    /// the table drives, and clamps them to 0..1; others keep what they hold. Backward writes
    /// every GUI control: the value whose forward mapping gives the raw controls, 0 where there is
    /// none.
    pub fn mien_rig_map_gui_to_raw(rig: *const MienRig, instance: *mut MienInstance) -> MienStatus;

    /// Raw controls from GUI controls, and back. Forward writes only raw controls that some row of
    /// the table drives, and clamps them to 0..1; others keep what they hold. Backward writes
    /// every GUI control: the value whose forward mapping gives the raw controls, 0 where there is
    /// none.
    pub fn mien_rig_map_raw_to_gui(rig: *const MienRig, instance: *mut MienInstance) -> MienStatus;

    /// Evaluates all stages at a LOD. Outputs that the LOD does not reach are 0. Changing the LOD
    /// from call to call costs no more than clearing the outputs; raw controls are left alone.
    /// Allocates nothing, locks nothing. Finite inputs are expected.
    pub fn mien_rig_evaluate(rig: *const MienRig, instance: *mut MienInstance, lod: u32) -> MienStatus;

    /// Only some stages, in the order above; the others keep the results of the last evaluation at
    /// the same LOD (after a change of LOD: 0).
    pub fn mien_rig_evaluate_stages(rig: *const MienRig, instance: *mut MienInstance, lod: u32, stages: u32) -> MienStatus;

    /// One allocation; the rig may be destroyed before the batch.
    pub fn mien_batch_create(rig: *const MienRig, desc: *const MienBatchDesc, out_batch: *mut *mut MienBatch, error: *mut MienError) -> MienStatus;

    pub fn mien_batch_destroy(batch: *mut MienBatch);

    /// Bytes of such a batch, asked before it is made.
    pub fn mien_batch_bytes(rig: *const MienRig, desc: *const MienBatchDesc, out_bytes: *mut u64) -> MienStatus;

    /// Evaluates stages (`MIEN_STAGE_...`, usually all) of `count` different instances of the
    /// batch's rig, each at its own LOD: the same bits as `mien_rig_evaluate_stages()` of each,
    /// but columns of the joint matrix that many of them use are fetched once for up to 32.
    /// Results are in the instances. On this thread, or in the batch's tasks on threads of
    /// `parallel`, which may be NULL: any split gives the same bits. Allocates nothing, locks
    /// nothing, takes 48 KiB of stack. If any instance or LOD is not valid, none is evaluated:
    /// `MIEN_ERROR_MISMATCH` for an instance of another rig, `MIEN_ERROR_INVALID_ARGUMENT` for one
    /// that comes up twice or more than `capacity`.
    pub fn mien_rig_evaluate_batch(rig: *const MienRig, batch: *mut MienBatch, instances: *const *mut MienInstance, lods: *const u32, count: u32, stages: u32, parallel: *const MienParallelFor) -> MienStatus;

    /// Only the joint values of one joint group (`MIEN_KIND_JOINT_GROUP`); not those that a later
    /// group overrides wherever this one gives them.
    pub fn mien_rig_evaluate_joint_group(rig: *const MienRig, instance: *mut MienInstance, lod: u32, group: u32) -> MienStatus;

    /// Only the pose controls of one RBF solver (`MIEN_KIND_RBF_SOLVER`), whether the LOD lists it
    /// or not.
    pub fn mien_rig_evaluate_rbf_solver(rig: *const MienRig, instance: *mut MienInstance, lod: u32, solver: u32) -> MienStatus;

    /// Only the joints of one twist and swing set-up (`MIEN_KIND_TWIST_SWING`).
    pub fn mien_rig_evaluate_twist_swing(rig: *const MienRig, instance: *mut MienInstance, lod: u32, setup: u32) -> MienStatus;

    /// Packs the geometry of `dna`, which may be closed afterwards, and keeps the rig's memory
    /// alive (the rig may be destroyed). `dna` is the one that the rig was made of, or another
    /// opening of the same file with the same LODs: other numbers or names of joints, channels or
    /// meshes are `MIEN_ERROR_MISMATCH`. It needs `MIEN_LAYER_GEOMETRY`, else
    /// `MIEN_ERROR_DNA_LAYER`. A position may have any number of influences up to 65535
    /// (`MIEN_ERROR_DNA_LIMIT`); those of weight 0 are dropped. Faces of fewer than three corners
    /// are left out. Meshes without faces, weights, normals, texture coordinates or anything at
    /// all are accepted: normals that the file lacks are recomputed from the faces, texture
    /// coordinates are 0. Which side of a face is outside the stored normals tell; without them
    /// the file's axes and winding do. `MIEN_ERROR_DNA_VALUE`: joints that descend from
    /// themselves; positions, deltas or weights that are not finite (the message names mesh and
    /// position). Takes some memory beyond the block for the time of the call.
    pub fn mien_deformer_create(dna: *const MienDna, rig: *const MienRig, desc: *const MienDeformerDesc, out_deformer: *mut *mut MienDeformer, error: *mut MienError) -> MienStatus;

    /// Memory is released when the last pose is gone too: poses go on working.
    pub fn mien_deformer_destroy(deformer: *mut MienDeformer);

    pub fn mien_deformer_info(deformer: *const MienDeformer, out_info: *mut MienDeformerInfo) -> MienStatus;

    pub fn mien_deformer_mesh(deformer: *const MienDeformer, mesh: u32, out_mesh: *mut MienMesh) -> MienStatus;

    /// Joints that hold a position and their weights, as they are used: as many as each other,
    /// possibly none. Views live as long as the deformer.
    pub fn mien_deformer_influences(deformer: *const MienDeformer, mesh: u32, position: u32, out_joints: *mut MienIndex16View, out_weights: *mut MienFloatView) -> MienStatus;

    /// Writes x y z for each position of the mesh: how far a target moves it at channel weight 1
    /// (0 where it does not). `count` is the room in `out_deltas`, 3 \* `position_count` floats or
    /// more.
    pub fn mien_deformer_target(deformer: *const MienDeformer, mesh: u32, target: u32, out_deltas: *mut f32, count: usize) -> MienStatus;

    /// Model matrices of the joints in the neutral pose, or their inverses: 16 floats per joint,
    /// column by column (column vectors; the last column is the translation, the last row 0 0 0
    /// 1). Views live as long as the deformer.
    pub fn mien_deformer_bind_matrices(deformer: *const MienDeformer, out_matrices: *mut MienFloatView) -> MienStatus;

    /// Model matrices of the joints in the neutral pose, or their inverses: 16 floats per joint,
    /// column by column (column vectors; the last column is the translation, the last row 0 0 0
    /// 1). Views live as long as the deformer.
    pub fn mien_deformer_inverse_bind_matrices(deformer: *const MienDeformer, out_matrices: *mut MienFloatView) -> MienStatus;

    /// A pose in neutral: matrices, positions and normals are those of the deformer. It keeps the
    /// deformer's memory alive. One allocation.
    pub fn mien_deformer_instance_create(deformer: *const MienDeformer, desc: *const MienDeformerInstanceDesc, out_deformer_instance: *mut *mut MienDeformerInstance, error: *mut MienError) -> MienStatus;

    pub fn mien_deformer_instance_destroy(deformer_instance: *mut MienDeformerInstance);

    /// Takes over joint values and channel weights of the instance's last evaluation, and computes
    /// the matrices of all joints; meshes follow with `mien_deformer_instance_deform()`. The
    /// instance is one of the rig that the deformer was made with, else `MIEN_ERROR_MISMATCH`.
    /// Allocates nothing, locks nothing. Values that are not finite give results that are not.
    pub fn mien_deformer_instance_update(deformer_instance: *mut MienDeformerInstance, instance: *const MienInstance) -> MienStatus;

    /// The same from arrays: joint values as `mien_instance_joints()` gives them, and one weight
    /// per channel. `joint_values` may be NULL, with count 0: no deltas. `channel_weights` may be
    /// NULL, with count 0: all 0. Any other count than that of the rig is
    /// `MIEN_ERROR_INVALID_ARGUMENT`.
    pub fn mien_deformer_instance_update_from_values(deformer_instance: *mut MienDeformerInstance, joint_values: *const f32, joint_value_count: usize, channel_weights: *const f32, channel_weight_count: usize) -> MienStatus;

    /// Matrices of the last update, 16 floats per joint, laid out as
    /// `mien_deformer_bind_matrices()` says: model matrices, and skin matrices (for skinning
    /// elsewhere, as on a GPU). The views stay valid, their contents change with each update.
    pub fn mien_deformer_instance_joint_matrices(deformer_instance: *const MienDeformerInstance, out_matrices: *mut MienFloatView) -> MienStatus;

    /// Matrices of the last update, 16 floats per joint, laid out as
    /// `mien_deformer_bind_matrices()` says: model matrices, and skin matrices (for skinning
    /// elsewhere, as on a GPU). The views stay valid, their contents change with each update.
    pub fn mien_deformer_instance_skin_matrices(deformer_instance: *const MienDeformerInstance, out_matrices: *mut MienFloatView) -> MienStatus;

    /// Writes the local transforms of the last update, relative to the parent, 10 floats per
    /// joint: tx ty tz qx qy qz qw sx sy sz, the quaternion of unit length. `count` is the room in
    /// `out_transforms`.
    pub fn mien_deformer_instance_local_transforms(deformer_instance: *const MienDeformerInstance, out_transforms: *mut f32, count: usize) -> MienStatus;

    /// Positions of one mesh as of the last update, and its normals (`MIEN_NORMALS_...`). On this
    /// thread, but for meshes of 16384 positions and more in tasks of about 2048, if there is
    /// somebody to run them: `parallel` may be NULL. The result has the same bits. Allocates
    /// nothing, locks nothing. `MIEN_ERROR_LOD`: the pose has no room for this mesh.
    pub fn mien_deformer_instance_deform(deformer_instance: *mut MienDeformerInstance, mesh: u32, normals: u32, parallel: *const MienParallelFor) -> MienStatus;

    /// The same mesh of several different poses of one deformer: the same bits as one after the
    /// other, but each piece of the mesh is fetched once, and the size that counts is that of all
    /// of them together; `parallel` may be NULL. A pose that comes up twice is
    /// `MIEN_ERROR_INVALID_ARGUMENT`, one of another deformer `MIEN_ERROR_MISMATCH`; then none is
    /// deformed.
    pub fn mien_deformer_instance_deform_batch(deformer_instances: *const *mut MienDeformerInstance, count: usize, mesh: u32, normals: u32, parallel: *const MienParallelFor) -> MienStatus;

    /// Results of the last `mien_deformer_instance_deform()` of the mesh: x y z per position, x y
    /// z per vertex. The views stay valid, their contents change with each call. A mesh without
    /// room: `MIEN_ERROR_LOD`.
    pub fn mien_deformer_instance_positions(deformer_instance: *const MienDeformerInstance, mesh: u32, out_positions: *mut MienFloatView) -> MienStatus;

    /// Results of the last `mien_deformer_instance_deform()` of the mesh: x y z per position, x y
    /// z per vertex. The views stay valid, their contents change with each call. A mesh without
    /// room: `MIEN_ERROR_LOD`.
    pub fn mien_deformer_instance_normals(deformer_instance: *const MienDeformerInstance, mesh: u32, out_normals: *mut MienFloatView) -> MienStatus;

    /// Deforms a mesh as `mien_deformer_instance_deform()` does, then writes its vertices to
    /// memory of the caller, such as a mapped vertex buffer. Each byte is written once, in the
    /// order of the vertices, and none is read, so the memory may be write-combined. Bytes between
    /// vertices are left alone. Threads as for `mien_deformer_instance_deform()`: the bytes are
    /// the same. The same positions, normals and tangents give the same bytes on every instruction
    /// set. Allocates nothing, locks nothing. `MIEN_ERROR_INVALID_ARGUMENT`: a format that the
    /// attribute does not take; a wrong stride or alignment; too little capacity; streams that
    /// overlap; no stream at all; tangents, but the deformer has none. Then nothing is deformed or
    /// written. `MIEN_ERROR_LOD`: the instance has no memory for this mesh. docs/deformation.md, 5
    /// "Vertex output".
    pub fn mien_deformer_instance_write_vertices(deformer_instance: *mut MienDeformerInstance, mesh: u32, normals: u32, output: *const MienVertexOutput, parallel: *const MienParallelFor) -> MienStatus;

    /// The same mesh of several instances, as `mien_deformer_instance_deform_batch()` takes them:
    /// instance i to outputs\[i\]. All outputs have the same `struct_size`, and share no byte
    /// either.
    pub fn mien_deformer_instance_write_vertices_batch(deformer_instances: *const *mut MienDeformerInstance, count: usize, mesh: u32, normals: u32, outputs: *const MienVertexOutput, parallel: *const MienParallelFor) -> MienStatus;

    /// Writes a rig and, unless it is NULL, a deformer of this rig (else `MIEN_ERROR_MISMATCH`).
    /// Goes to a temporary name first, so a failure leaves `path` as it was.
    pub fn mien_bake_file(rig: *const MienRig, deformer: *const MienDeformer, path: *const c_char, error: *mut MienError) -> MienStatus;

    /// The same to memory. With buffer NULL and capacity 0 only \*`out_size` is set; a capacity
    /// that is too small gives `MIEN_ERROR_INVALID_ARGUMENT` and the size.
    pub fn mien_bake_memory(rig: *const MienRig, deformer: *const MienDeformer, buffer: *mut c_void, capacity: usize, out_size: *mut usize, error: *mut MienError) -> MienStatus;

    /// Opens a baked file. It is mapped; all processes that open it share its pages, which are
    /// never written to. A mapped file must not be truncated or rewritten in place until
    /// everything made of it is gone (replacing it by renaming is safe). Checks the header here,
    /// and with `MIEN_BAKED_CHECK_FULL` all bytes; the rest when objects are made. `path` is
    /// UTF-8, `desc` may be NULL. One allocation, and one for the bytes if they are not mapped.
    /// Close with `mien_baked_close()`.
    pub fn mien_baked_open_file(path: *const c_char, desc: *const MienBakedDesc, out_baked: *mut *mut MienBaked, error: *mut MienError) -> MienStatus;

    /// The same from memory, which stays the caller's and has to stay unchanged until everything
    /// made of it is gone. Bytes that are not at a multiple of 64 are copied; so are all with
    /// `MIEN_FILE_READ`.
    pub fn mien_baked_open_memory(bytes: *const c_void, size: usize, desc: *const MienBakedDesc, out_baked: *mut *mut MienBaked, error: *mut MienError) -> MienStatus;

    /// The same from a stream, which is read once, into one block. `MIEN_ERROR_FILE_READ` if it
    /// fails.
    pub fn mien_baked_open_stream(stream: *const MienStream, desc: *const MienBakedDesc, out_baked: *mut *mut MienBaked, error: *mut MienError) -> MienStatus;

    /// Memory is released, and the file unmapped, when everything made of it is gone too.
    pub fn mien_baked_close(baked: *mut MienBaked);

    pub fn mien_baked_info(baked: *const MienBaked, out_info: *mut MienBakedInfo) -> MienStatus;

    /// The rig of a baked file, like one that was created; destroy it with `mien_rig_destroy()`.
    /// One allocation; the bytes of the file stay alive with it. `desc` may be NULL.
    /// `MIEN_ERROR_BAKED_PART` if the file has no rig, `MIEN_ERROR_BAKED_VERSION` or
    /// `MIEN_ERROR_BAKED_STRUCTURE` if its rig cannot be used.
    pub fn mien_rig_from_baked(baked: *const MienBaked, desc: *const MienBakedRigDesc, out_rig: *mut *mut MienRig, error: *mut MienError) -> MienStatus;

    /// The deformer of a baked file, like one that was created; destroy it with
    /// `mien_deformer_destroy()`. `rig` was made of the same MienBaked, else
    /// `MIEN_ERROR_MISMATCH`, and stays alive with the deformer. One allocation. `desc` may be
    /// NULL. Errors as above.
    pub fn mien_deformer_from_baked(baked: *const MienBaked, rig: *const MienRig, desc: *const MienBakedDeformerDesc, out_deformer: *mut *mut MienDeformer, error: *mut MienError) -> MienStatus;
}
