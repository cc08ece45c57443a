// SPDX-License-Identifier: MIT
// Code generated from integrations/api/mien_api.json by generate.py; run ./dev api. DO NOT EDIT.

export declare const VERSION: string;
/** Times of clips and mixers are integers, in ticks. */
export declare const TICKS_PER_SECOND: 705600000;

/** Numbers are never reused. */
export declare const Status: {
  readonly OK: 0;
  /** a required pointer is NULL */
  readonly NULL_ARGUMENT: 1;
  /** a value out of range, or a buffer that is too small */
  readonly INVALID_ARGUMENT: 2;
  /**
   * struct_size is too small or above 4096, or a field unknown to the library is not zero
   */
  readonly STRUCT_SIZE: 3;
  /** a handle of the wrong kind */
  readonly HANDLE: 4;
  /** objects that do not belong together */
  readonly MISMATCH: 5;
  /** an index past the end */
  readonly INDEX: 6;
  /** a LOD that does not exist, or for which the object has no memory */
  readonly LOD: 7;
  /** no such name or path */
  readonly NAME: 8;
  /** an instruction set that the CPU or the build does not support */
  readonly ISA: 9;
  /** the allocator returned NULL */
  readonly MEMORY: 10;
  /**
   * this build of the library only opens baked files, or the object is stored in a form that does not have what was asked for
   */
  readonly UNSUPPORTED: 11;
  /** the file cannot be opened */
  readonly FILE_OPEN: 20;
  /** the file or stream cannot be read */
  readonly FILE_READ: 21;
  /** the file cannot be written */
  readonly FILE_WRITE: 22;
  /** not a DNA file */
  readonly DNA_SIGNATURE: 30;
  /** a DNA file whose generation is not 2 */
  readonly DNA_VERSION: 31;
  /** the file ends before the data that its header or counts announce */
  readonly DNA_TRUNCATED: 32;
  /** offsets, sizes or counts contradict each other */
  readonly DNA_STRUCTURE: 33;
  /** an index that refers to nothing */
  readonly DNA_REFERENCE: 34;
  /** a count above the limit of the format or of Mien */
  readonly DNA_LIMIT: 35;
  /** a required layer is not loaded or not in the file */
  readonly DNA_LAYER: 36;
  /** an invalid value, or one that cannot be converted */
  readonly DNA_VALUE: 37;
  /** not a baked file */
  readonly BAKED_SIGNATURE: 50;
  /** baked by another version of Mien, or for the other byte order */
  readonly BAKED_VERSION: 51;
  /** the file is shorter than its header states */
  readonly BAKED_TRUNCATED: 52;
  /** sizes, counts or indices contradict each other */
  readonly BAKED_STRUCTURE: 53;
  /** the file has changed since it was written */
  readonly BAKED_CHECKSUM: 54;
  /** the file does not contain the requested object */
  readonly BAKED_PART: 55;
  /** not a clip */
  readonly CLIP_SIGNATURE: 60;
  /** a clip in another version of the format */
  readonly CLIP_VERSION: 61;
  /** the clip is shorter than its header states */
  readonly CLIP_TRUNCATED: 62;
  /** sizes, counts or curves contradict each other */
  readonly CLIP_STRUCTURE: 63;
  /** the clip has changed since it was written */
  readonly CLIP_CHECKSUM: 64;
  /** a value that is not finite */
  readonly CLIP_VALUE: 65;
  /** more than a clip, player or binding can hold */
  readonly CLIP_LIMIT: 66;
  /** not a mix */
  readonly MIX_SIGNATURE: 70;
  /** a mix in another version of the format */
  readonly MIX_VERSION: 71;
  /** the file is shorter than its header states */
  readonly MIX_TRUNCATED: 72;
  /** sizes or counts contradict each other, or a value is out of range */
  readonly MIX_STRUCTURE: 73;
  /** the mix has changed since it was written */
  readonly MIX_CHECKSUM: 74;
  /** the arrays of a mesh, shape or bone contradict each other */
  readonly AUTHOR_MESH: 80;
  /** a mesh that cannot be rigged; the message names the rule */
  readonly AUTHOR_REFUSED: 81;
  /** the caller's progress function asked to stop */
  readonly AUTHOR_CANCELED: 82;
};
export type Status = (typeof Status)[keyof typeof Status];

/**
 * Layers of a DNA file, combined with |. A layer loads the layers that it refers to: all of them need
 * the definition, RBF behavior needs the behavior. The descriptor is always loaded.
 * See docs/dna-format.md, 9 "Choosing layers".
 */
export declare const Layer: {
  /** only in MienDnaLayer.layer */
  readonly UNKNOWN: 0;
  readonly DESCRIPTOR: 1;
  readonly DEFINITION: 2;
  readonly BEHAVIOR: 4;
  readonly GEOMETRY: 8;
  readonly MACHINE_LEARNED_BEHAVIOR: 16;
  readonly RBF_BEHAVIOR: 32;
  readonly JOINT_BEHAVIOR_METADATA: 64;
  readonly TWIST_SWING_BEHAVIOR: 128;
  readonly ALL: 255;
};
export type Layer = number;

/** What to do with layers of unknown kinds. */
export declare const UnknownLayers: {
  /** keep their bytes and write them back unchanged */
  readonly KEEP: 0;
  readonly DROP: 1;
};
export type UnknownLayers = (typeof UnknownLayers)[keyof typeof UnknownLayers];

export declare const FileAccess: {
  /** map the file; read it into memory if it cannot be mapped, such as a pipe */
  readonly MAP: 0;
  /** read the whole file into memory: safe even if it is truncated later */
  readonly READ: 1;
};
export type FileAccess = (typeof FileAccess)[keyof typeof FileAccess];

export declare const TranslationUnit: {
  readonly CENTIMETERS: 0;
  readonly METERS: 1;
};
export type TranslationUnit = (typeof TranslationUnit)[keyof typeof TranslationUnit];

export declare const RotationUnit: {
  readonly DEGREES: 0;
  readonly RADIANS: 1;
};
export type RotationUnit = (typeof RotationUnit)[keyof typeof RotationUnit];

/** Directions as seen by the character. */
export declare const Direction: {
  readonly LEFT: 0;
  readonly RIGHT: 1;
  readonly UP: 2;
  readonly DOWN: 3;
  readonly FRONT: 4;
  readonly BACK: 5;
};
export type Direction = (typeof Direction)[keyof typeof Direction];

/** Order of Euler angles. */
export declare const RotationSequence: {
  /** x first, then y, then z, about fixed axes */
  readonly XYZ: 0;
  readonly XZY: 1;
  readonly YXZ: 2;
  readonly YZX: 3;
  readonly ZXY: 4;
  readonly ZYX: 5;
};
export type RotationSequence = (typeof RotationSequence)[keyof typeof RotationSequence];

/**
 * The side of a face a b c ... to which (b - a) x (c - a) points. The cross product is computed from
 * the coordinates in the file, whatever the directions of its axes.
 */
export declare const FaceWinding: {
  /**
   * seen from outside: counter-clockwise with right-handed axes, clockwise with left-handed axes
   */
  readonly OUTWARD: 0;
  readonly INWARD: 1;
};
export type FaceWinding = (typeof FaceWinding)[keyof typeof FaceWinding];

/**
 * How Euler angles are converted to other axes. Joint values are sums of angles, which have a meaning
 * in one rotation sequence only. So only the first rule is exact for all rigs.
 */
export declare const RotationRule: {
  /**
   * keep the sequence of the file and rename its axes: if x and z are exchanged, xyz becomes zyx, xzy becomes zxy, and so on
   */
  readonly CARRIED: 0;
  /**
   * the requested sequence. Neutral poses, quaternion joints, twists, swings, ML joints and joints that rotate about one axis only are converted exactly; rigs with other joints are rejected with MIEN_ERROR_DNA_VALUE
   */
  readonly EXACT: 1;
  /**
   * the requested sequence, converting each column of the joint matrix separately: exact if one control is 1 and all others are 0, otherwise an approximation for small angles
   */
  readonly PER_COLUMN: 2;
};
export type RotationRule = (typeof RotationRule)[keyof typeof RotationRule];

/** Type of a field. */
export declare const FieldType: {
  /** named fields */
  readonly RECORD: 0;
  /** records, strings or arrays; element i is at the path of the list + [i] */
  readonly LIST: 1;
  readonly STRING: 2;
  /** numbers: one, or an array */
  readonly U8: 3;
  readonly U16: 4;
  readonly U32: 5;
  readonly I32: 6;
  readonly F32: 7;
};
export type FieldType = (typeof FieldType)[keyof typeof FieldType];

export declare const Severity: {
  /** opening the file or mien_rig_create() fails because of this */
  readonly ERROR: 0;
  /** allowed, but probably a mistake */
  readonly WARNING: 1;
};
export type Severity = (typeof Severity)[keyof typeof Severity];

/** Instruction sets. */
export declare const Isa: {
  /** the best one that the CPU, the operating system and the build support */
  readonly BEST: 0;
  readonly SCALAR: 1;
  readonly SSE2: 2;
  /** with FMA and F16C */
  readonly AVX2: 3;
  /** F, CD, DQ, BW and VL */
  readonly AVX512: 4;
  readonly NEON: 5;
  /**
   * the one named by the environment variable MIEN_ISA ("scalar", "sse2", ...); the best one if it is unset or empty
   */
  readonly ENVIRONMENT: 1000;
};
export type Isa = (typeof Isa)[keyof typeof Isa];

/** How joint values store rotations. */
export declare const RotationOutput: {
  /** 9 values per joint: tx ty tz rx ry rz sx sy sz */
  readonly EULER: 0;
  /** 10 values per joint: tx ty tz qx qy qz qw sx sy sz */
  readonly QUATERNION: 1;
};
export type RotationOutput = (typeof RotationOutput)[keyof typeof RotationOutput];

/**
 * Effect of a region mask on the networks of the region (mien_instance_ml_masks()).
 * See docs/rig-evaluation.md, 8.5 "Region masks".
 */
export declare const MlMasks: {
  /**
   * 0: the outputs of the networks get their default (0, or 1 for the w of a quaternion). Other values: the networks are evaluated. This is the behavior that DNA files are authored for.
   */
  readonly SWITCH: 0;
  /** outputs are blended with their default by the mask, clamped to 0..1 */
  readonly BLEND: 1;
};
export type MlMasks = (typeof MlMasks)[keyof typeof MlMasks];

/**
 * How the large arrays that evaluation reads are stored. Sums and results are always 32-bit floats.
 * See docs/rig-evaluation.md, 4.9 "16-bit storage".
 */
export declare const Storage: {
  readonly BIT_32: 0;
  /**
   * half the memory. Network weights and columns of quaternion joints are IEEE half floats (rounded to nearest even, at most 65504 in magnitude); the joint matrix is 16-bit fixed point, in units of 1/32767 of the largest entry of the row
   */
  readonly BIT_16: 1;
};
export type Storage = (typeof Storage)[keyof typeof Storage];

/**
 * Which instruction sets give bit-identical results. See docs/numbers.md, 5 "Portable arithmetic".
 */
export declare const Arithmetic: {
  /**
   * AVX2, AVX-512 and NEON, which fuse multiply and add, agree with each other; scalar and SSE2 agree with each other
   */
  readonly FAST: 0;
  /**
   * all agree, because nothing is fused. A baked rig gives the same bits on every machine; a rig created from a DNA file does if the C libraries compute the same sines.
   */
  readonly PORTABLE: 1;
};
export type Arithmetic = (typeof Arithmetic)[keyof typeof Arithmetic];

/**
 * What an instance keeps of its last evaluation. With MIEN_REUSE_UNCHANGED and MIEN_REUSE_NOTHING the
 * results are bit-identical.
 */
export declare const Reuse: {
  /** results whose inputs have not changed: joint groups, and other stages as a whole */
  readonly UNCHANGED: 0;
  /** compute everything in each evaluation, for measurements */
  readonly NOTHING: 1;
  /**
   * also the sums of the joint matrix: where few controls changed, only their differences are added, so such a frame costs little even if these controls move joints everywhere. Joint values then depend on earlier frames: they differ from those of a full evaluation by at most (n + 1539) * 2^-23 * M, before rotations are made from them. n is the number of controls that are not 0, M the sum of the magnitudes of the products that a joint value is the sum of; both are the largest since all sums were last computed, which happens after a reset, after a change of LOD and before 1536 differences were added. Everything else is bit-identical. Rigs and instances take more memory: MienRigInfo.rig_bytes, .instance_bytes
   */
  readonly SUMS: 2;
};
export type Reuse = (typeof Reuse)[keyof typeof Reuse];

/** Kinds of parts of a rig. Most have names. */
export declare const Kind: {
  readonly GUI_CONTROL: 0;
  readonly RAW_CONTROL: 1;
  /** correctives; unnamed in DNA files, here "psd0", "psd1", ... */
  readonly PSD_CONTROL: 2;
  readonly ML_CONTROL: 3;
  readonly RBF_CONTROL: 4;
  readonly JOINT: 5;
  readonly BLEND_SHAPE_CHANNEL: 6;
  readonly ANIMATED_MAP: 7;
  readonly MESH: 8;
  /** region masks, one per region of each mesh: "mesh/region" */
  readonly ML_MASK: 9;
  /** without names */
  readonly JOINT_GROUP: 10;
  /** without names */
  readonly RBF_SOLVER: 11;
  /** without names: a swing and the twists with the same inputs, or a twist alone */
  readonly TWIST_SWING: 12;
};
export type Kind = (typeof Kind)[keyof typeof Kind];

/** Stages of an evaluation, combined with |. */
export declare const Stage: {
  /** neural networks */
  readonly ML: 1;
  /** RBF solvers */
  readonly RBF: 2;
  /** correctives */
  readonly PSD: 4;
  /** joint groups, then twists and swings, then ML joints */
  readonly JOINTS: 8;
  readonly BLEND_SHAPES: 16;
  readonly ANIMATED_MAPS: 32;
  readonly ALL: 63;
};
export type Stage = number;

/** How the neutral rotation of a joint is combined with its delta. */
export declare const Compose: {
  /** neutral rotation * delta rotation: the delta rotates first */
  readonly PRODUCT: 0;
  /**
   * the angles are added; requires MIEN_ROTATION_OUTPUT_EULER. Equals the product where the neutral rotation is zero.
   */
  readonly EULER_ADD: 1;
};
export type Compose = (typeof Compose)[keyof typeof Compose];

/** Treatment of skin weights. */
export declare const Weights: {
  readonly AS_STORED: 0;
  /** drop negative weights and divide the others by their sum */
  readonly FIX: 1;
};
export type Weights = (typeof Weights)[keyof typeof Weights];

/**
 * Normals of deformed meshes; they have unit length. Where no normal can be computed (no faces, or faces
 * without area), the neutral one is used. See docs/deformation.md, 3 "Normals".
 */
export declare const Normals: {
  /** as MienDeformerDesc.normals says; in that field: recomputed */
  readonly DEFAULT: 0;
  /** leave normals unchanged */
  readonly NONE: 1;
  /**
   * neutral normals rotated by the skinning, correct for any scale; blend shape targets have no effect
   */
  readonly SKINNED: 2;
  /**
   * the area-weighted mean of the normals of the faces around the position. On hard edges, where this differs from the stored normal by more than 30 degrees in the neutral pose, the stored normal is rotated by the rotation of this mean from the neutral pose.
   */
  readonly RECOMPUTED: 3;
};
export type Normals = (typeof Normals)[keyof typeof Normals];

/**
 * Layout of a vertex attribute in memory, in the byte order of the machine. A signed normalized integer
 * of n bits is round(clamp(v, -1, 1) * (2^(n-1) - 1)), ties to even, in two's complement. These are
 * the vertex formats R32G32B32_SFLOAT, R32G32B32A32_SFLOAT, R16G16B16A16_SNORM and
 * A2B10G10R10_SNORM_PACK32 of Vulkan, and float3, float4, short4Normalized and int1010102Normalized of
 * Metal. Direct3D 12 and WebGPU lack the last one.
 */
export declare const VertexFormat: {
  /** 12 bytes: x y z */
  readonly FLOAT32X3: 0;
  /** 16 bytes: x y z w */
  readonly FLOAT32X4: 1;
  /** 8 bytes: x y z w, 16 bits each */
  readonly SNORM16X4: 2;
  /**
   * 4 bytes, one 32-bit word: x in bits 0-9, y in bits 10-19, z in bits 20-29, w in bits 30-31
   */
  readonly SNORM10_10_10_2: 3;
};
export type VertexFormat = (typeof VertexFormat)[keyof typeof VertexFormat];

/**
 * Points on the way from controls to positions:
 *
 *     GUI -> RAW -> CONTROLS -> JOINTS -> LOCALS -> MODELS -> SKINS -> POSITIONS
 *                       |-> CHANNELS ------------------------------------^
 *                       |-> MAPS
 *
 * Derivatives lead from one point to a later one that depends on it. Networks, RBF solvers and correctives
 * run between RAW and CONTROLS; the joint stage, channels and maps read CONTROLS. From JOINTS on, channel
 * weights are constant. See docs/derivatives.md.
 */
export declare const Point: {
  /** GUI controls */
  readonly GUI: 0;
  /** raw controls */
  readonly RAW: 1;
  /** all controls: mien_instance_controls() */
  readonly CONTROLS: 2;
  /** joint values: mien_instance_joints() */
  readonly JOINTS: 3;
  /** 16 floats per joint: matrix relative to the parent, four columns */
  readonly LOCALS: 4;
  /** the same, in model space: mien_deformer_instance_joint_matrices() */
  readonly MODELS: 5;
  /** the same, of skin matrices: mien_deformer_instance_skin_matrices() */
  readonly SKINS: 6;
  /** x y z per position of a mesh, in the order of the file */
  readonly POSITIONS: 7;
  /** blend shape channel weights */
  readonly CHANNELS: 8;
  /** animated map weights */
  readonly MAPS: 9;
};
export type Point = (typeof Point)[keyof typeof Point];

/** What is checked when a baked file is used. */
export declare const BakedCheck: {
  /**
   * all sizes, counts and indices, so that no access is out of bounds whatever the bytes are. Floats are not checked, so their pages are read from disk only when first used.
   */
  readonly SAFE: 0;
  /** also the checksum of all bytes, which reads the whole file */
  readonly FULL: 1;
};
export type BakedCheck = (typeof BakedCheck)[keyof typeof BakedCheck];

/** What happens after the last frame. */
export declare const Looping: {
  /** a clip: MIEN_LOOPING_CLAMP; a player: the setting of its clip */
  readonly DEFAULT: 0;
  /** holds the last frame; the length is (frames - 1) * ticks per frame */
  readonly CLAMP: 1;
  /** starts over; the length is frames * ticks per frame */
  readonly WRAP: 2;
};
export type Looping = (typeof Looping)[keyof typeof Looping];

/**
 * How values between two frames are computed. They stay within the range of these two frames.
 */
export declare const Interpolation: {
  readonly LINEAR: 0;
  /** the value of the earlier frame */
  readonly STEP: 1;
  /** a Catmull-Rom spline, clamped to that range */
  readonly CATMULL_ROM: 2;
};
export type Interpolation = (typeof Interpolation)[keyof typeof Interpolation];

/**
 * The purpose of a layer. Guards protect the result of base and speech from the other groups.
 */
export declare const LayerGroup: {
  readonly BASE: 0;
  readonly SPEECH: 1;
  readonly EMOTION: 2;
  readonly REACTION: 3;
  /** acts after the reactions if no layer of another group follows */
  readonly LIFE: 4;
};
export type LayerGroup = (typeof LayerGroup)[keyof typeof LayerGroup];

/**
 * How a layer changes a curve: o is the value so far, x the value of the layer, a = weight * mask. Curves
 * for which the layer's source has no value do not change.
 */
export declare const BlendMode: {
  /** o + a (x - o) */
  readonly OVERRIDE: 0;
  /** o + a x */
  readonly ADD: 1;
  /** o + a x (1 - p), or o + a x p if x < 0; p is o clamped to 0..1 */
  readonly SCREEN: 2;
  /** o + a max(0, x - o) */
  readonly MAX: 3;
  /** o (1 + a (x - 1)) */
  readonly SCALE: 4;
};
export type BlendMode = (typeof BlendMode)[keyof typeof BlendMode];

/** Where the values of a layer come from. */
export declare const LayerSource: {
  /** mien_mixer_play() */
  readonly CLIP: 0;
  /** a weighted sum: mien_mixer_set_pose_weight() */
  readonly POSES: 1;
  /** mien_mixer_push() */
  readonly STREAM: 2;
  /** MIEN_GENERATOR_... */
  readonly GENERATOR: 3;
};
export type LayerSource = (typeof LayerSource)[keyof typeof LayerSource];

/** What a layer generates from the seed of the mixer and the time. */
export declare const Generator: {
  /**
   * blinks every `period` on average, at least 0.5 s apart. The wait starts over when earlier layers raise the first curve above 0.6
   */
  readonly BLINK: 0;
  /** rises from 0 to 1 in 40 % of the period, then falls back to 0 */
  readonly BREATH: 1;
  /** smooth noise between -1 and 1 with a new random value every period */
  readonly NOISE: 2;
  /**
   * turns the eyes to a target with saccades, by MienMixDesc.gaze. `curves` are three curves with the left, up and front of a MienGazeTarget, read after the earlier layers, then optionally two curves that get the part left for the head (MienGazeRest). `amounts` are fixation jitter sideways and up in degrees, 0, and factors for the two head curves. Shifts of 20 degrees or more make the blink layers of the mix blink
   */
  readonly GAZE: 3;
};
export type Generator = (typeof Generator)[keyof typeof Generator];

/** What a trigger does while the reaction is already running. */
export declare const Retrigger: {
  /** extends the stimulus; strokes that are releasing or over start again */
  readonly EXTEND: 0;
  /** all strokes start again, at most once per cooldown */
  readonly RESTART: 1;
  readonly IGNORE: 2;
};
export type Retrigger = (typeof Retrigger)[keyof typeof Retrigger];

/**
 * Built-in guards: gaps that emotions and reactions must not open while speech or a blink closes them.
 * Bits of MienMixDesc.guards.
 */
export declare const Guard: {
  /** between the lips, left, center and right, and from lower lip to upper teeth */
  readonly LIPS: 1;
  /** between the lids */
  readonly LIDS: 2;
  /** between the teeth */
  readonly TEETH: 4;
  readonly ALL: 7;
};
export type Guard = number;

/**
 * How a layer changes to another clip. A layer that plays no clip fades in, except with a cut.
 */
export declare const Transition: {
  /** the old clip stops; each curve blends from its last value and speed */
  readonly INERTIAL: 0;
  /** both clips play; MIEN_TRANSITION_INERTIAL if no player is free */
  readonly CROSSFADE: 1;
  /** immediate; transition_ticks is not used */
  readonly CUT: 2;
};
export type Transition = (typeof Transition)[keyof typeof Transition];

/** How a name was matched. */
export declare const NameMatch: {
  readonly NONE: 0;
  /** the control has this name */
  readonly AS_WRITTEN: 1;
  /** the same letters and side */
  readonly SPELLING: 2;
  /** another word for the same control */
  readonly ALIAS: 3;
  /** the controls of the left and the right side */
  readonly BOTH_SIDES: 4;
  /** an expression of several controls */
  readonly EXPRESSION: 5;
};
export type NameMatch = (typeof NameMatch)[keyof typeof NameMatch];

/** Kinds of generated rigs. */
export declare const Preset: {
  /** small enough to read */
  readonly TINY: 0;
  readonly SMALL: 1;
  readonly MEDIUM: 2;
  /**
   * a synthetic rig of production size: 870 joints, 260 raw controls, 8 LODs, a million matrix entries
   */
  readonly LARGE: 3;
  /**
   * a synthetic rig of the size of a production body: 342 joints, moved by 72 RBF solvers with 670 poses, 22 twists and 16 swings; some are quaternion joints
   */
  readonly BODY: 4;
  /**
   * a stylized head to look at: skin, eyes, teeth, tongue, hair; the 52 ARKit expressions and 20 of MetaHuman rigs as raw controls (0 to 1), correctives, wrinkle maps, 8 LODs. Seed 0 is the designed head; other seeds vary skull, nose, jaw, age, hair and colors. The metadata holds vertex colors: key "mien.colors.<mesh name>", value base64 of 3 bytes (sRGB) per vertex position of the mesh.
   */
  readonly HEAD: 5;
  /**
   * a synthetic rig with the published counts of exported heads and names in MetaHuman's conventions: version 2.5, 870 joints, 263 raw controls (251 expressions, 12 parts of quaternions), 174 GUI controls, 545 correctives, 782 channels, an RBF solver with 18 poses, 8 LODs
   */
  readonly METAHUMAN_HEAD: 6;
  /** MIEN_PRESET_BODY in version 2.7 */
  readonly METAHUMAN_BODY: 7;
  /** MIEN_PRESET_METAHUMAN_HEAD without blend shapes */
  readonly ARCHETYPE: 8;
};
export type Preset = (typeof Preset)[keyof typeof Preset];

/** Additions to a preset, combined with |. */
export declare const Generate: {
  /**
   * machine-learned behavior: networks for mesh regions with all activation functions and operations, and ML joints; not with MIEN_PRESET_HEAD and those after it
   */
  readonly ML: 1;
};
export type Generate = (typeof Generate)[keyof typeof Generate];

/** The role of a bone. */
export declare const BoneKind: {
  readonly ROOT: 0;
  readonly NECK: 1;
  readonly HEAD: 2;
  readonly FACE: 3;
  /** moves with expressions; each LOD keeps the first n of these */
  readonly FACIAL: 4;
  readonly JAW: 5;
  readonly EYE: 6;
  /** below the neck */
  readonly CHEST: 7;
  /** moves with expressions, below the jaw; in every LOD */
  readonly TONGUE: 8;
};
export type BoneKind = (typeof BoneKind)[keyof typeof BoneKind];

/** Whether both halves of the face are treated as mirror images. */
export declare const Symmetry: {
  /** if mirrored positions lie within 0.5 % of the face's size of the surface */
  readonly AUTO: 0;
  readonly ON: 1;
  readonly OFF: 2;
};
export type Symmetry = (typeof Symmetry)[keyof typeof Symmetry];

/** Directions of the axes of a mesh. */
export declare const MeshAxis: {
  /** up: Y; front: Z */
  readonly DEFAULT: 0;
  readonly X: 1;
  readonly Y: 2;
  readonly Z: 3;
  readonly MINUS_X: 4;
  readonly MINUS_Y: 5;
  readonly MINUS_Z: 6;
};
export type MeshAxis = (typeof MeshAxis)[keyof typeof MeshAxis];

/** How bones and weights are computed, combined with |. */
export declare const AuthorFlags: {
  /**
   * only the published method, plus the neck cut: no symmetry, no weighting by motion, no joints for jaw and eyes
   */
  readonly PAPER: 1;
  /** the face mask may include parts of the neck */
  readonly NO_NECK_CUT: 2;
  /** the face mask is where shapes move: for heads that are not human */
  readonly MASK_FROM_SHAPES: 4;
  /** weight positions by the area around them: for scans */
  readonly AREA_DENSITY: 8;
  /** no blend shape targets for the motion that joints cannot produce */
  readonly NO_TARGETS: 16;
  /** group by distance in space, not in depth: for comparison */
  readonly GROUP_IN_SPACE: 32;
  /**
   * name bones that are placed and controls that are added as in MetaHuman heads where they have a counterpart: neck_01, FACIAL_C_Jaw, CTRL_expressions.jawOpen. The caller's bones and shapes keep their names
   */
  readonly METAHUMAN_NAMES: 64;
};
export type AuthorFlags = number;

/** How positions of one mesh are found on another. */
export declare const Match: {
  /** the nearest point in space */
  readonly SURFACE: 0;
  /** the nearest point in the texture */
  readonly UV: 1;
};
export type Match = (typeof Match)[keyof typeof Match];

/**
 * What a constraint asks for. Places and directions are in model space, before the motion of
 * MienFitFrame.rigid. Kinds with joints need MienFitDesc.deformer.
 */
export declare const FitConstraintKind: {
  /** `joint` is at `target`: where the jaw is */
  readonly JOINT_POSITION: 0;
  /** `axis` of `joint` has the direction `target`: an eye's gaze */
  readonly JOINT_DIRECTION: 1;
  /** `axis` of `joint` points at the place `target` */
  readonly JOINT_AIM: 2;
  /** `points[0]` is at `target` */
  readonly POINT_POSITION: 3;
  /**
   * from `distances[0]` to `distances[1]` lie between `points`: 0 and 0 where lips touch
   */
  readonly POINT_DISTANCE: 4;
};
export type FitConstraintKind = (typeof FitConstraintKind)[keyof typeof FitConstraintKind];

/** Why a solve ended. */
export declare const FitStatus: {
  /** further steps change nothing */
  readonly CONVERGED: 0;
  /** the limit of iterations was reached; the best controls so far */
  readonly ITERATIONS: 1;
  /** the limit of time was reached; likewise */
  readonly TIME: 2;
  /** the caller asked to stop; likewise */
  readonly CANCELED: 3;
  /** no target, or all are missing; the start is returned */
  readonly NO_DATA: 4;
};
export type FitStatus = (typeof FitStatus)[keyof typeof FitStatus];

/**
 * Details of a failure, owned by the caller. A call that fails fills all fields; a call that succeeds
 * sets status to MIEN_OK and leaves the other fields unchanged.
 */
export interface Error {
  /** where in the file; MIEN_NO_OFFSET: nowhere in particular */
  readonly byteOffset: number | null;
  readonly status: Status;
  /** what is wrong, where, and how to fix it; null-terminated, truncated if too long */
  readonly message: string;
}

/**
 * Axes, units and rotation conventions of a rig. Any handedness is allowed.
 * See docs/dna-format.md, 11 "Coordinate systems".
 */
export interface CoordinateSystem {
  /** MIEN_DIRECTION_... of x, y, z */
  axes?: readonly number[];
  /** MIEN_TRANSLATION_UNIT_... */
  translationUnit?: TranslationUnit;
  /** MIEN_ROTATION_UNIT_... */
  rotationUnit?: RotationUnit;
  /** MIEN_ROTATION_RULE_... */
  rotationRule?: RotationRule;
  /** MIEN_ROTATION_SEQUENCE_...; ignored with MIEN_ROTATION_RULE_CARRIED */
  rotationSequence?: RotationSequence;
  /**
   * of the angles about x, y, z. 1: rotates y to z, z to x, x to y. -1: the other way. 0: whichever leaves the angles unchanged
   */
  rotationSigns?: readonly number[];
  /** MIEN_FACE_WINDING_... */
  faceWinding?: FaceWinding;
}

/**
 * What to load of a DNA file, and how.
 *
 * A rig converted to another coordinate system moves as before: evaluating it gives the joint values
 * of the original rig, converted. Raw controls that are components of rotations (read by RBF solvers,
 * twists or swings as quaternions, or named .qx .qy .qz .qw) are expected in the requested system.
 * Changes of axes and signs are exact, so converting back restores the original numbers; a change of
 * units rounds each number once. Texture coordinates and unknown layers are not converted. A converted
 * rig can be written; the file gets version 2.8 if its own version cannot describe the system.
 */
export interface DnaDesc {
  /** MIEN_LAYER_..., combined with |; the others are not read. 0: all */
  layers?: Layer;
  /** load the geometry without blend shape targets */
  skipBlendShapeTargets?: boolean;
  /** MIEN_UNKNOWN_LAYERS_... */
  unknownLayers?: UnknownLayers;
  /**
   * bit l keeps LOD l. Kept LODs are renumbered from 0; joints, meshes, channels and maps that none of them uses are dropped, and all indices renumbered. 0: all
   */
  lods?: number;
  /** convert to this system. NULL: keep the file's own */
  system?: CoordinateSystem;
}

/** Properties of an open DNA. Counts are those of the loaded layers and LODs. */
export interface DnaInfo {
  /** 2 */
  readonly generation: number;
  /** 1 to 8: the file is of version 2.version */
  readonly version: number;
  /** MIEN_LAYER_..., combined with |: the loaded layers */
  readonly layers: Layer;
  /** the geometry is loaded with its targets */
  readonly hasBlendShapeTargets: boolean;
  /** size of the file */
  readonly fileBytes: number;
  /** memory taken from the allocator */
  readonly memoryBytes: number;
  /** the file is mapped */
  readonly isMapped: boolean;
  /** entries for mien_dna_layer() */
  readonly layerCount: number;
  /** MIEN_TRANSLATION_UNIT_... */
  readonly translationUnit: TranslationUnit;
  /** MIEN_ROTATION_UNIT_... */
  readonly rotationUnit: RotationUnit;
  /** MIEN_DIRECTION_... of x, y, z */
  readonly axes: readonly number[];
  /** MIEN_ROTATION_SEQUENCE_... */
  readonly rotationSequence: RotationSequence;
  /** 1 or -1, for the angles about x, y, z */
  readonly rotationSigns: readonly number[];
  /** MIEN_FACE_WINDING_... */
  readonly faceWinding: FaceWinding;
  readonly lodCount: number;
  /** LOD 0 of this file is LOD max_lod of its database */
  readonly maxLod: number;
  readonly guiControlCount: number;
  readonly rawControlCount: number;
  readonly psdControlCount: number;
  readonly mlControlCount: number;
  readonly rbfControlCount: number;
  readonly jointCount: number;
  readonly jointGroupCount: number;
  readonly blendShapeChannelCount: number;
  readonly animatedMapCount: number;
  readonly meshCount: number;
  readonly neuralNetworkCount: number;
  readonly rbfSolverCount: number;
  readonly rbfPoseCount: number;
  readonly twistCount: number;
  readonly swingCount: number;
  /** pairs desc.metadata[i].key and .value */
  readonly metadataCount: number;
}

/**
 * An entry of the index table of the file. Files of version 2.1 have no index table; their sections are
 * listed as the layers desc, defn, bhvr and geom.
 */
export interface DnaLayer {
  /** MIEN_LAYER_... that loads it. MIEN_LAYER_UNKNOWN: no known kind */
  readonly layer: Layer;
  /** of the layer: version_major.version_minor */
  readonly versionMajor: number;
  readonly versionMinor: number;
  /** it was parsed, not skipped or kept as bytes */
  readonly isLoaded: boolean;
  /** of its first byte in the file */
  readonly byteOffset: number;
  readonly byteCount: number;
  /** such as "bhvr"; null-terminated */
  readonly code: string;
}

export interface DnaField {
  /** MIEN_FIELD_... */
  readonly type: FieldType;
  /**
   * an array of numbers, even if it has only one element; not a single number, nor an element of an array
   */
  readonly isArray: boolean;
  /** elements of an array or list, bytes of a string, fields of a record; 1 for a number */
  readonly count: number;
  /**
   * of a string, an array or an element of an array in the file; MIEN_NO_OFFSET: other fields, and data that is not in the file
   */
  readonly byteOffset: number | null;
}

/** How to write a DNA file. See docs/dna-format.md, 14.3 "Changing the version". */
export interface WriteDesc {
  /**
   * 1 to 8: write version 2.version; layers that it does not define are kept unless unknown_layers drops them, but 2.1 can only hold the layers desc, defn, bhvr and geom. 0: the version of the DNA
   */
  version?: number;
  /** MIEN_UNKNOWN_LAYERS_... */
  unknownLayers?: UnknownLayers;
}

export interface Finding {
  /** MIEN_SEVERITY_... */
  readonly severity: Severity;
  /** the status of the failure; MIEN_OK for a warning */
  readonly status: Status;
  /** where in the file; MIEN_NO_OFFSET: nowhere in particular */
  readonly byteOffset: number | null;
  /** path as for mien_dna_field(), or the code of a layer */
  readonly field: string;
  /** what is wrong */
  readonly message: string;
}

export interface ValidateDesc {
}

/** Options of a rig. See docs/rig-evaluation.md, 9.4 "Options". */
export interface RigDesc {
  /** MIEN_ISA_... */
  isa?: Isa;
  /** MIEN_ROTATION_OUTPUT_... */
  rotationOutput?: RotationOutput;
  /** MIEN_ML_MASKS_... */
  mlMasks?: MlMasks;
  /** MIEN_STORAGE_... */
  storage?: Storage;
  /** MIEN_REUSE_... */
  reuse?: Reuse;
  /** MIEN_ARITHMETIC_... */
  arithmetic?: Arithmetic;
}

/** Properties of a rig. */
export interface RigInfo {
  /** MIEN_ISA_... in use, never MIEN_ISA_BEST */
  readonly isa: Isa;
  readonly lodCount: number;
  /** MIEN_TRANSLATION_UNIT_... */
  readonly translationUnit: TranslationUnit;
  /** MIEN_ROTATION_UNIT_... */
  readonly rotationUnit: RotationUnit;
  /** MIEN_DIRECTION_... of x, y, z */
  readonly axes: readonly number[];
  /** MIEN_ROTATION_SEQUENCE_... */
  readonly rotationSequence: RotationSequence;
  /** 1 or -1, for the angles about x, y, z */
  readonly rotationSigns: readonly number[];
  /** length of the control vector: raw, PSD, ML, RBF controls */
  readonly controlCount: number;
  /** 9 or 10 per joint */
  readonly jointValueCount: number;
  /** MIEN_ROTATION_OUTPUT_... */
  readonly rotationOutput: RotationOutput;
  /** MIEN_STORAGE_... */
  readonly storage: Storage;
  /** MIEN_ARITHMETIC_... */
  readonly arithmetic: Arithmetic;
  /** memory of the rig, including its part of a baked file */
  readonly rigBytes: number;
  /** memory of each instance */
  readonly instanceBytes: number;
}

/** The work of an evaluation at a LOD when all controls are active. */
export interface RigStatistics {
  readonly lod: number;
  /** correctives computed */
  readonly psdCount: number;
  /** joints of the LOD */
  readonly jointCount: number;
  /** rows of the joint groups */
  readonly jointRowCount: number;
  /** channels written */
  readonly blendShapeCount: number;
  /** rows of the animated map table */
  readonly animatedMapRowCount: number;
  /** RBF solvers of the LOD */
  readonly rbfSolverCount: number;
  /** quaternion joints */
  readonly quaternionJointCount: number;
  /** stored in the joint matrix: 8 per block that is not all zeros */
  readonly jointEntryCount: number;
  /** of the joint matrix; an evaluation does not read the columns of controls that are 0 */
  readonly jointByteCount: number;
}

export interface InstanceDesc {
}

/**
 * What the joint stage reads for the current controls, at the LOD of the last evaluation (initially
 * LOD 0), if it reuses no results. Each byte is counted once, regardless of CPU caches.
 */
export interface InstanceStatistics {
  /** of the last evaluation */
  readonly lod: number;
  /** of the control vector: raw, PSD, ML and RBF controls */
  readonly controlCount: number;
  /** controls that are not 0 */
  readonly activeControlCount: number;
  /** columns of the joint matrix that active controls drive */
  readonly jointColumnCount: number;
  /** of these columns: 8 per block */
  readonly jointEntryCount: number;
  /** of these entries: at most MienRigStatistics.joint_byte_count */
  readonly jointByteCount: number;
}

export interface BatchDesc {
  /** instances per call: 1 to 2^20. 0: 32 */
  capacity?: number;
  /**
   * tasks that may run at the same time, each with its own scratch memory. 0: 1, for calls without MienParallelFor
   */
  tasks?: number;
}

/** Options of a deformer. */
export interface DeformerDesc {
  /** MIEN_ISA_...; MIEN_ISA_BEST is that of the rig */
  isa?: Isa;
  /** MIEN_COMPOSE_... */
  compose?: Compose;
  /** MIEN_WEIGHTS_... */
  weights?: Weights;
  /** MIEN_NORMALS_...: what MIEN_NORMALS_DEFAULT means for this deformer */
  normals?: Normals;
  /** compute tangents, for mien_deformer_instance_write_vertices() */
  withTangents?: boolean;
  /**
   * MIEN_STORAGE_... of blend shape deltas, skin weights, texture coordinates and triangles. With 16 bits these are integers with scales, and triangles follow from faces. See docs/deformation.md, 2.1 "16-bit storage"
   */
  storage?: Storage;
  /**
   * largest rounding error of a coordinate of a delta that 16-bit storage may make to store deltas with 10 bits, in translation units. 0: 2^-18 of the size of the mesh, which is also the least
   */
  deltaError?: number;
}

/** Properties of a deformer. */
export interface DeformerInfo {
  /** MIEN_ISA_... in use, never MIEN_ISA_BEST */
  readonly isa: Isa;
  /** MIEN_COMPOSE_... */
  readonly compose: Compose;
  /** MIEN_WEIGHTS_... */
  readonly weights: Weights;
  /** MIEN_NORMALS_..., never MIEN_NORMALS_DEFAULT */
  readonly normals: Normals;
  readonly lodCount: number;
  readonly jointCount: number;
  readonly channelCount: number;
  /** same as in the rig, which has their names: MIEN_KIND_MESH */
  readonly meshCount: number;
  /** memory of the deformer, including its part of a baked file */
  readonly deformerBytes: number;
  /** memory of a deformer instance for all meshes */
  readonly instanceBytes: number;
  /** MIEN_STORAGE_... */
  readonly storage: Storage;
}

/** A neutral mesh. Its views are valid until the deformer is destroyed. */
export interface Mesh {
  readonly positionCount: number;
  readonly vertexCount: number;
  readonly triangleCount: number;
  /** of one position */
  readonly maxInfluences: number;
  /** blend shape targets */
  readonly targetCount: number;
  /** of all targets */
  readonly deltaCount: number;
  /** bit l: LOD l shows this mesh */
  readonly lods: number;
  /** 3 floats per position: x y z */
  readonly positions: Float32Array;
  /** 3 floats per vertex: x y z, unit length */
  readonly normals: Float32Array;
  /**
   * 4 floats per vertex: x y z w, see MienVertexOutput; empty unless MienDeformerDesc.with_tangents was set
   */
  readonly tangents: Float32Array;
  /**
   * 2 floats per vertex: u v, as in the file; may be empty with 16-bit storage: see mien_deformer_texture_coordinates()
   */
  readonly textureCoordinates: Float32Array;
  /** one index per vertex: its position */
  readonly vertexPositionIndices: Uint32Array;
  /**
   * 3 indices per triangle: vertices, wound as in the file; faces with more corners become fans about their first corner. May be empty with 16-bit storage: see mien_deformer_triangles()
   */
  readonly triangles: Uint32Array;
  /** one index per target: its blend shape channel; in file order */
  readonly targetChannels: Uint16Array;
}

export interface DeformerInstanceDesc {
  /**
   * take memory for the meshes of these LODs only: bit l is LOD l. LODs that do not exist are ignored. 0: for all meshes
   */
  lods?: number;
}

/**
 * One attribute of all vertices: vertex i is written at data + i * stride. `data` and `stride` are
 * multiples of 4; `stride` is at least the size of the format.
 */
export interface VertexStream {
  /** NULL: the attribute is not written */
  data?: number;
  /** in bytes */
  stride?: number;
  /** MIEN_VERTEX_FORMAT_... */
  format?: VertexFormat;
}

/**
 * Where to write the vertices of a mesh, in the order of MienMesh.vertex_position_indices. Streams may
 * be interleaved (with the same stride) or separate, but must not share bytes. At least one is needed.
 *
 *   positions  as floats; w is 1
 *   normals    in any format; w is 0
 *   tangents   in any format with w. The tangent points along the surface in the direction of growing u
 *              at constant v, perpendicular to the normal; w * cross(normal, tangent) points in the
 *              direction of growing v. w is 1, or -1 where the texture is mirrored. If you flip v (1 - v),
 *              negate w.
 *
 * Neutral tangents are computed as by MikkTSpace, except that vertices are never split: where triangles
 * of both orientations meet, a vertex takes the orientation with the larger sum of angles. A vertex
 * without texture coordinates gets an arbitrary, but reproducible, perpendicular of its normal and
 * w = 1. Tangents are skinned, and then made perpendicular to the written normal.
 * See docs/deformation.md, 4 "Tangents".
 */
export interface VertexOutput {
  /** of each stream: at least MienMesh.vertex_count */
  vertexCapacity?: number;
  positions?: VertexStream;
  normals?: VertexStream;
  /** requires MienDeformerDesc.with_tangents */
  tangents?: VertexStream;
}

/** How to create derivatives. */
export interface DerivativesDesc {
  /** of the rig. NULL: none, and no points from LOCALS to POSITIONS */
  deformer?: { readonly handle: number };
}

/** Which matrix. */
export interface JacobianDesc {
  /** MIEN_POINT_...: of the columns */
  fromPoint?: Point;
  /** MIEN_POINT_...: of the rows */
  toPoint?: Point;
  /** the mesh of MIEN_POINT_POSITIONS, else 0 */
  mesh?: number;
  /** of the evaluations: entries that other LODs add are left out */
  lod?: number;
  /** numbers at from_point, one per column. NULL: all */
  inputs?: Uint32Array | readonly number[];
  /** numbers at to_point, one per row, ascending. NULL: all */
  outputs?: Uint32Array | readonly number[];
  /** 0 if `inputs` is NULL */
  inputCount?: number;
  /** 0 if `outputs` is NULL */
  outputCount?: number;
}

/** The entries of a matrix: by column, then by row. */
export interface JacobianPattern {
  /** of each entry: a place in MienJacobianDesc.outputs, or a number at to_point */
  readonly rows: Uint32Array;
  /** of each entry: a place in MienJacobianDesc.inputs, or a number at from_point */
  readonly columns: Uint32Array;
  /** rows and columns of the matrix, with or without entries */
  readonly rowCount: number;
  readonly columnCount: number;
  /** directions that compute all columns: the colors of a coloring */
  readonly directionCount: number;
}

/** How to open a baked file. */
export interface BakedDesc {
  /** MIEN_BAKED_CHECK_... */
  check?: BakedCheck;
}

/** Properties of an open baked file. */
export interface BakedInfo {
  /** size of the file */
  readonly fileBytes: number;
  /** memory taken from the allocator */
  readonly memoryBytes: number;
  /** size of the rig in the file. 0: it has none */
  readonly rigBytes: number;
  /** size of the deformer in the file. 0: it has none */
  readonly deformerBytes: number;
  /** parts of the file, including unknown ones */
  readonly partCount: number;
  /** the file is mapped */
  readonly isMapped: boolean;
}

/** Options of a rig that are not part of a baked file. */
export interface BakedRigDesc {
  /** MIEN_ISA_... */
  isa?: Isa;
  /** MIEN_REUSE_... */
  reuse?: Reuse;
}

/** Options of a deformer that are not part of a baked file. */
export interface BakedDeformerDesc {
  /** MIEN_ISA_...; MIEN_ISA_BEST is that of the rig */
  isa?: Isa;
  /**
   * MIEN_NORMALS_...: what MIEN_NORMALS_DEFAULT means for this deformer; in this field MIEN_NORMALS_DEFAULT keeps the setting of the baked deformer
   */
  normals?: Normals;
}

/**
 * A named moment of a clip, such as a phoneme. In speech layers, events named "close:lips",
 * "close:lip-to-teeth" and "close:teeth" activate the matching guards of the mixer for `value` seconds.
 */
export interface ClipEvent {
  tick?: number;
  name?: string;
  value?: number;
}

/** What to build a clip from. */
export interface ClipDesc {
  /** frames per second, as a fraction. 0: 60 */
  rateNumerator?: number;
  /** 0: 1 */
  rateDenominator?: number;
  /** 1 to 2^28 */
  frameCount?: number;
  /** at most 65535, of which at most 512 may change over time */
  channelCount?: number;
  /** one per channel, all different, not empty */
  names?: readonly string[];
  /** channel c of frame f is values[f * frame_stride + c] */
  values?: Float32Array | readonly number[];
  /** floats from frame to frame. 0: channel_count */
  frameStride?: number;
  /** one per channel, used instead of `snap`; may be NULL */
  snaps?: Float32Array | readonly number[];
  /**
   * 0: values keep all bits. 2^-9, 2^-10 ... 2^-16: values are rounded to multiples of this step, which makes the clip several times smaller
   */
  snap?: number;
  /** MIEN_LOOPING_... */
  looping?: Looping;
  /** a delta clip, whose values are added to other values */
  isDelta?: boolean;
  eventCount?: number;
  /** in any order; 0 <= tick < frame_count * ticks per frame */
  events?: readonly ClipEvent[];
}

/** How to open a clip. */
export interface ClipOpenDesc {
}

/** Properties of a clip. */
export interface ClipInfo {
  /** frames per second, as a fraction */
  readonly rateNumerator: number;
  readonly rateDenominator: number;
  readonly frameCount: number;
  readonly channelCount: number;
  /** channels whose value is not the same in all frames */
  readonly changingChannelCount: number;
  readonly eventCount: number;
  /** MIEN_LOOPING_CLAMP or MIEN_LOOPING_WRAP */
  readonly looping: Looping;
  /** as in MienClipDesc */
  readonly isDelta: boolean;
  /** largest step to which a channel was rounded. 0: none was */
  readonly snap: number;
  /** the file is mapped */
  readonly isMapped: boolean;
  readonly ticksPerFrame: number;
  /** ticks */
  readonly length: number;
  /** size of the clip */
  readonly fileBytes: number;
  /** memory taken from the allocator */
  readonly memoryBytes: number;
  /** memory of a player without MienClipPlayerDesc.reverse */
  readonly playerBytes: number;
}

/**
 * A channel of a clip. Block counts, bits and max_error are only known for a clip from
 * mien_clip_build(); they are 0 for a clip that was opened.
 */
export interface ClipChannel {
  readonly name: string;
  /** value of a channel that does not change; otherwise 0 */
  readonly rest: number;
  /** the channel has a curve */
  readonly isChanging: boolean;
  /** blocks of 64 frames that are zero */
  readonly zeroBlocks: number;
  /** blocks with one other value */
  readonly constantBlocks: number;
  /** blocks whose values are multiples of a decimal or binary fraction */
  readonly gridBlocks: number;
  /** other blocks */
  readonly floatBlocks: number;
  /** of all blocks */
  readonly bits: number;
  /** largest error of rounding to a step */
  readonly maxError: number;
}

/** How to play a clip. */
export interface ClipPlayerDesc {
  /** MIEN_LOOPING_... */
  looping?: Looping;
  /** MIEN_INTERPOLATION_... */
  interpolation?: Interpolation;
  /** speed, as a fraction; negative plays backward. -2^20 to 2^20 */
  speedNumerator?: number;
  /** 1 to 2^20. Both 0: 1 / 1 */
  speedDenominator?: number;
  /** initial position, as for mien_clip_player_seek() */
  startTick?: number;
  /**
   * backward playback costs no more than forward; takes 256 more bytes per changing channel
   */
  reverse?: boolean;
}

/** State of a player. */
export interface ClipPlayerInfo {
  /** 0 to the length of the clip; with MIEN_LOOPING_WRAP less than the length */
  readonly tick: number;
  /** loops completed since creation or the last seek, at most 2^61; negative: backward */
  readonly loops: number;
  /** MIEN_LOOPING_CLAMP or MIEN_LOOPING_WRAP */
  readonly looping: Looping;
  /** a damaged curve was played, as zeros */
  readonly isDamaged: boolean;
}

/** Adds weight * value of a channel to a raw or GUI control. */
export interface MatrixEntry {
  channel?: string;
  control?: string;
  weight?: number;
}

/** How to bind a clip. */
export interface ClipBindingDesc {
  /**
   * for channels whose names the rig does not have; may be NULL: those that mien_rig_match() knows need none
   */
  matrix?: readonly MatrixEntry[];
  matrixCount?: number;
}

/** What a binding found. Indices are ascending. */
export interface ClipBindingInfo {
  /** channels of the clip */
  readonly channelCount: number;
  /** raw controls of the rig */
  readonly rawControlCount: number;
  /** matrix entries whose channel or control does not exist */
  readonly missingEntryCount: number;
  /** raw controls that are driven */
  readonly controls: Uint16Array;
  /** raw controls that are not driven */
  readonly extraControls: Uint16Array;
  /**
   * channels that drive nothing: the rig has no such name, or an earlier channel drives the same control
   */
  readonly missingChannels: Uint16Array;
}

/** A layer of a mix. Leave the fields that its source does not use at zero. */
export interface MixLayer {
  /** of a generator, ticks */
  period?: number;
  /** of a stream, ticks: rows are played this much later than their times */
  delay?: number;
  /** one per curve, 0 to 1; curves beyond mask_count have 0. NULL: 1 for all */
  mask?: Float32Array | readonly number[];
  /** the curve of each channel of a stream, or the curves of a generator */
  curves?: Uint16Array | readonly number[];
  /** one per curve of a generator: a factor for its value */
  amounts?: Float32Array | readonly number[];
  maskCount?: number;
  curveCount?: number;
  /** MIEN_LAYER_GROUP_... */
  group?: LayerGroup;
  /** MIEN_BLEND_MODE_... */
  mode?: BlendMode;
  /** MIEN_LAYER_SOURCE_... */
  source?: LayerSource;
  /** acts after the guards; not allowed for base and speech */
  afterGuards?: boolean;
  /** initial weight. 0 to 1; -1 to 1 with MIEN_BLEND_MODE_ADD */
  weight?: number;
  /** index of its first pose in MienMixDesc.poses */
  firstPose?: number;
  poseCount?: number;
  /** MIEN_GENERATOR_... */
  generator?: Generator;
  /** capacity of a stream's queue, in rows. 0: 64; otherwise 2 to 1024 */
  streamFrames?: number;
}

/** A pose: the curves that it moves, and their values. */
export interface MixPose {
  curves?: Uint16Array | readonly number[];
  values?: Float32Array | readonly number[];
  count?: number;
}

/**
 * A part of a reaction: moves the curves of a pose to its values and back to 0. Times are in ticks.
 */
export interface MixStroke {
  /** after the trigger */
  delay?: number;
  /** time to reach strength * pose */
  attack?: number;
  /** time after the attack; ignored if is_held */
  hold?: number;
  /** time to return to 0 */
  release?: number;
  /** index in MienMixDesc.poses */
  pose?: number;
  /** MIEN_BLEND_MODE_... */
  mode?: BlendMode;
  /** holds as long as the stimulus lasts, and adapts unless is_lag */
  isHeld?: boolean;
  /** moves exponentially; attack and release are time constants */
  isLag?: boolean;
  /** scaled by the level of the reaction, which is 1 if mien_mixer_trigger() started it */
  isScaled?: boolean;
}

/** The response of a face to a stimulus, such as a bright light. */
export interface MixReaction {
  /** ticks; minimum time between two starts of strokes that are not held */
  cooldown?: number;
  /** time constant of adaptation to a lasting stimulus */
  adaptTicks?: number;
  /** time constant of recovery after the stimulus */
  recoverTicks?: number;
  /** at most 8 */
  strokes?: readonly MixStroke[];
  strokeCount?: number;
  /** MIEN_RETRIGGER_... */
  retrigger?: Retrigger;
  /** acts after the guards */
  afterGuards?: boolean;
  /** share of the strength that remains after full adaptation; 1: all */
  adapted?: number;
  /**
   * levels of this or more are a stimulus: mien_mixer_set_level(). 0: the reaction takes no levels
   */
  levelOn?: number;
  /** the stimulus ends below this; at most level_on */
  levelOff?: number;
}

/**
 * Two curves that move the face in opposite directions. If both are above 0, the smaller one times
 * stiffness is subtracted from both.
 */
export interface MixAntagonists {
  first?: number;
  second?: number;
  /** 0 to 1 */
  stiffness?: number;
}

/**
 * A point of the face: the mean of some positions of a mesh that LOD 0 shows, or of some joints.
 */
export interface Landmark {
  /** indices of positions of the mesh, or of joints */
  points?: Uint32Array | readonly number[];
  /** 1 to 65536 */
  pointCount?: number;
  /** index of the mesh. MIEN_NO_MESH: the points are joints */
  mesh?: number;
}

/**
 * A guard with landmarks of the caller. It keeps the gap between them, the height of `upper` above `lower`
 * along the axis that points up, from being opened.
 */
export interface MixGuard {
  upper?: Landmark;
  lower?: Landmark;
  /** raw control that closes the gap at 1. MIEN_NO_CONTROL: it is closed at rest */
  closedBy?: number;
  /** acts at most as much as the largest weight of a speech layer */
  needsSpeech?: boolean;
  /**
   * millimeters by which later layers may open the gap, 0 or more; 0.3 for built-in guards
   */
  tolerance?: number;
  /**
   * millimeters, above 0: acts if base and speech leave a smaller gap, fully at 0. Built-in guards: 12 for lips, 6 for lids, 4 for teeth
   */
  fOn?: number;
}

/** What to mix. Everything is copied. */
export interface MixDesc {
  /** at most 16 */
  layers?: readonly MixLayer[];
  layerCount?: number;
  /** at most 1024; used by layers and strokes */
  poses?: readonly MixPose[];
  poseCount?: number;
  /** at most 16 */
  reactions?: readonly MixReaction[];
  reactionCount?: number;
  antagonists?: readonly MixAntagonists[];
  antagonistCount?: number;
  /**
   * for each curve its counterpart in the other half of the face, or itself. NULL: clips cannot be played mirrored
   */
  mirror?: Uint16Array | readonly number[];
  /** limits per curve. NULL: none; both or neither */
  lower?: Float32Array | readonly number[];
  upper?: Float32Array | readonly number[];
  /** numbered after the built-in ones; at most 8 guards in total */
  customGuards?: readonly MixGuard[];
  customGuardCount?: number;
  /** for a layer with MIEN_GENERATOR_GAZE; may be NULL */
  gaze?: { readonly handle: number };
  /** to measure guards; may be NULL if there are none */
  deformer?: { readonly handle: number };
  /** MIEN_GUARD_... bits; a guard is left out if the rig lacks its landmarks */
  guards?: Guard;
  /** pose variables; at most 4096 curves with the raw controls */
  variableCount?: number;
  /**
   * clips that can play at the same time; a crossfade needs two. 0: two for each clip layer
   */
  playerCount?: number;
  /** of any clip. 0: the number of raw controls */
  maxChannels?: number;
  /** of any clip. 0: max_channels, 512 at most */
  maxChangingChannels?: number;
  /** events that one step can report. 0: 64 */
  maxEvents?: number;
  /** as in MienClipPlayerDesc */
  reverse?: boolean;
}

/** How to open a mix. */
export interface MixOpenDesc {
}

/** Properties of a mix. */
export interface MixInfo {
  readonly rawControlCount: number;
  readonly variableCount: number;
  /** raw controls and pose variables */
  readonly curveCount: number;
  readonly layerCount: number;
  /** for mien_mixer_stage() */
  readonly stageCount: number;
  /** for mien_mixer_set_guard() */
  readonly guardCount: number;
  /** memory of a mixer without MienMixerDesc.stages */
  readonly mixerBytes: number;
  /** size of a snapshot */
  readonly snapshotBytes: number;
}

/**
 * A guard of a mix, as it was measured: the distance in millimeters is `rest`, plus the sum of gain * curve,
 * plus a sum over pairs of curves that share a corrective. See docs/mixing.md, 4 "Guards".
 */
export interface MixGuardInfo {
  /** raw controls that change the distance, by descending gain */
  readonly curves: Uint16Array;
  /** 1 float per curve: millimeters at value 1 */
  readonly gains: Float32Array;
  readonly pairCount: number;
  /** as in MienMixGuard */
  readonly needsSpeech: boolean;
  /** distance of a row of zeros */
  readonly rest: number;
  /** as in MienMixGuard */
  readonly tolerance: number;
  readonly fOn: number;
  /** millimeters, root mean square over the measured rows */
  readonly fitError: number;
}

/** How to create a gaze. */
export interface GazeDesc {
  /** name of a joint. NULL: L_Eye or FACIAL_L_Eye */
  leftEye?: string;
  /** name of a joint. NULL: R_Eye or FACIAL_R_Eye */
  rightEye?: string;
}

/**
 * A point in millimeters from the origin of the rig's model space, with the head in its neutral pose.
 */
export interface GazeTarget {
  left?: number;
  up?: number;
  front?: number;
}

/** What was measured on the eyes. */
export interface GazeInfo {
  /** center of rotation */
  readonly leftEye: GazeTarget;
  readonly rightEye: GazeTarget;
  /** degrees, largest error found when an eye turns sideways and up at once */
  readonly fitError: number;
}

/**
 * The part of a gaze that the eyes cannot reach, left for the head to turn: tangents of angles, averaged
 * over both eyes.
 */
export interface GazeRest {
  readonly left: number;
  readonly up: number;
}

/** How to create a mixer. */
export interface MixerDesc {
  /** of the generators */
  seed?: number;
  /** keep the row after each stage, for mien_mixer_stage() */
  stages?: boolean;
}

/** How to play a clip in a layer. */
export interface PlayDesc {
  /** chosen by the caller, to identify clip and binding in mien_mixer_restore() */
  clipId?: number;
  /** in the clip */
  startTick?: number;
  /** 0 to 2^40 */
  transitionTicks?: number;
  /** MIEN_TRANSITION_... */
  transition?: Transition;
  /** MIEN_LOOPING_... */
  looping?: Looping;
  /** MIEN_INTERPOLATION_... */
  interpolation?: Interpolation;
  /** as in MienClipPlayerDesc */
  speedNumerator?: number;
  speedDenominator?: number;
  /** ; requires MienMixDesc.mirror */
  mirrored?: boolean;
}

/**
 * What a guard did in the last step. Distances are in millimeters, computed by the function of raw controls
 * that was measured on the rig; a negative distance means that both sides overlap.
 */
export interface GuardState {
  /**
   * "lips left", "lips center", "lips right", "teeth", "lower lip to teeth", "left lids", "right lids" or "custom"
   */
  readonly name: string;
  /** raw controls that it may hold back */
  readonly controls: Uint16Array;
  /** MIEN_GUARD_...; 0: one of MienMixDesc.custom_guards */
  readonly kind: Guard;
  /** how much it acted, 0 to 1 */
  readonly activation: number;
  /** distance after the last layer of base and speech */
  readonly protectedDistance: number;
  /** distance just before the guards, after the later layers and reactions */
  readonly wanted: number;
  /** largest distance that the guard allows when fully active */
  readonly limit: number;
  /**
   * distance after the guards: above `limit` if the guard is not fully active, while it eases in, or if other controls open the gap
   */
  readonly distance: number;
}

/** State of a mixer. */
export interface MixerInfo {
  /** time since creation */
  readonly tick: number;
  /** clip events that the last step passed */
  readonly eventCount: number;
  /** there were more than MienMixDesc.max_events */
  readonly lostEvents: boolean;
}

/** A clip that mien_mixer_restore() may need. */
export interface MixerClip {
  /** as in MienPlayDesc */
  clipId?: number;
  clip?: { readonly handle: number };
  clipBinding?: { readonly handle: number };
}

/**
 * Aim constraint: turns a joint so that one of its axes points at a target, by the shortest rotation, then
 * about that axis so that `up_axis` comes as near to `up` as possible. Directions may have any length.
 */
export interface AimSolver {
  joint?: number;
  /** its position is the target. MIEN_NO_JOINT: three curves of the row are */
  targetJoint?: number;
  /** first of these three: x y z in model space */
  targetCurve?: number;
  /** aim axis, in the space of the joint; not 0 0 0 */
  axis?: readonly number[];
  /** in the space of the joint; 0 0 0: no rotation about the aim axis */
  upAxis?: readonly number[];
  /** in model space; 0 0 0: 0 1 0 */
  up?: readonly number[];
  /** 0 to 180: largest angle from the neutral direction. 0: no limit */
  coneDegrees?: number;
  /** 0 to 1 */
  weight?: number;
}

/**
 * Space switch: moves a joint as if its parent were attached to another joint. A curve selects one of the
 * spaces. When it changes, the joint stays where it is, and the difference to the new space eases out.
 */
export interface SpaceSolver {
  /** 0 to 2^40 */
  easeTicks?: number;
  /** indices of joints. MIEN_NO_JOINT: model space */
  spaces?: Uint16Array | readonly number[];
  /** 1 to 8 */
  spaceCount?: number;
  /** of the row: its value, rounded, is an index in `spaces` */
  curve?: number;
  joint?: number;
}

/**
 * Spring: lets the position of a joint swing about its position in the pose. It is a damped harmonic
 * oscillator in model space, advanced by its exact solution, so it is stable for any time step. Output 0 is
 * its speed, in translation units per second.
 */
export interface SpringSolver {
  joint?: number;
  /** of the undamped spring, in Hertz; above 0 */
  frequency?: number;
  /** damping ratio, 0 or more; 1 is critical damping */
  damping?: number;
  /** rest position relative to the position in the pose, in model space */
  restOffset?: readonly number[];
  /** largest distance from the rest position. 0: no limit */
  stretch?: number;
  /**
   * if the rest position jumps farther than this in a step, the joint jumps with it. 0: never
   */
  teleport?: number;
}

/**
 * Twist distribution: gives joints a share of another joint's twist about an axis, in place of their own
 * twist. Output 0 is the sine of half the angle.
 */
export interface TwistSolver {
  joints?: Uint16Array | readonly number[];
  /** one for each of these joints, -1 to 1; 0.5 is half the angle */
  shares?: Float32Array | readonly number[];
  /** 1 to 8 */
  jointCount?: number;
  /** the joint whose twist is distributed */
  source?: number;
  /** in the space of the source and of each joint; not 0 0 0 */
  axis?: readonly number[];
}

/**
 * Copy: gives a joint the motion of another joint relative to its neutral pose, or the mirrored motion.
 */
export interface CopySolver {
  /** the joint whose motion is copied */
  source?: number;
  joint?: number;
  /** mirror the motion */
  isMirrored?: boolean;
  /** from right to left in model space; 0 0 0: 1 0 0 */
  mirrorAxis?: readonly number[];
  /** 0 to 1 */
  weight?: number;
}

/** The data of one character that a MienUserSolver gets. */
export interface SolverPose {
  /**
   * 10 floats per joint: tx ty tz qx qy qz qw sx sy sz, relative to the parent. Joints in `writes` may be changed; quaternions of any length but 0
   */
  readonly locals: Float32Array | readonly number[];
  /**
   * 16 floats per joint, as in mien_deformer_instance_joint_matrices(); up to date for joints in `reads`
   */
  readonly models: Float32Array | readonly number[];
  /** 16 floats for each joint in `previous_joints`, as the last step left it */
  readonly previous: Float32Array | readonly number[];
  /** MienSolverStackDesc.curve_count floats. NULL: there are none */
  readonly row: Float32Array | readonly number[];
  /** MienUserSolver.output_count floats for the caller to read */
  readonly outputs: Float32Array | readonly number[];
  /** MienUserSolver.state_bytes bytes, aligned to 8; initially zero */
  readonly state: number;
  readonly lod: number;
  /** the first step, or the character was teleported */
  readonly isReset: boolean;
}

/** The argument of a MienUserSolver. */
export interface SolverCall {
  /** one for each of at most 64 characters */
  readonly poses: readonly SolverPose[];
  /** one per joint; a root is its own parent */
  readonly parents: Uint16Array | readonly number[];
  /** since the last step */
  readonly ticks: number;
  readonly poseCount: number;
  readonly jointCount: number;
}

/**
 * A custom solver. It runs on the thread that calls the step function, and must not use the handles passed
 * to that function.
 */
export interface UserSolver {
  /** passed to the function; must live as long as the stack and its states */
  user?: number;
  /**
   * Changes the locals of the characters in `call`, and their outputs and state, but nothing else.
   */
  solve?: number;
  /** joints whose model matrices it reads */
  reads?: Uint16Array | readonly number[];
  /** joints whose local transforms it changes */
  writes?: Uint16Array | readonly number[];
  /** joints whose model matrices after the last step it reads */
  previousJoints?: Uint16Array | readonly number[];
  readCount?: number;
  /** 1 or more */
  writeCount?: number;
  previousJointCount?: number;
  /** 0 to 2^20 */
  stateBytes?: number;
  /** 0 to 4096 */
  outputCount?: number;
}

/** One solver: exactly one of the pointers aim ... custom is not NULL. */
export interface Solver {
  /** for messages. NULL: the name of its kind */
  name?: string;
  /** may be NULL */
  aim?: AimSolver;
  /** may be NULL */
  space?: SpaceSolver;
  /** may be NULL */
  spring?: SpringSolver;
  /** may be NULL */
  twist?: TwistSolver;
  /** may be NULL */
  copy?: CopySolver;
  /** may be NULL */
  custom?: UserSolver;
  /** bit l: runs at LOD l. 0: at all LODs */
  lods?: number;
}

/** How to create a solver stack. Everything is copied. */
export interface SolverStackDesc {
  /** in the order in which they run; at most 256 */
  solvers?: readonly Solver[];
  solverCount?: number;
  /** the rows passed to steps have this many curves or more. 0: no row */
  curveCount?: number;
  /**
   * compare all joints before and after each solver, to find undeclared writes: mien_solver_state_undeclared()
   */
  checkWrites?: boolean;
}

/** Properties of a solver stack. */
export interface SolverStackInfo {
  readonly solverCount: number;
  readonly curveCount: number;
  /** of all solvers */
  readonly outputCount: number;
  readonly jointCount: number;
  /** memory of a state */
  readonly stateBytes: number;
}

/** How to create a solver state. */
export interface SolverStateDesc {
}

/** The input of the solvers of one character. */
export interface SolverInput {
  /** such as the one from mien_mixer_row(). NULL: none */
  row?: Float32Array | readonly number[];
  /** at least MienSolverStackDesc.curve_count */
  rowCount?: number;
  /** 0 to 63 */
  lod?: number;
  /**
   * the character was teleported, so springs come to rest and space switches do not ease
   */
  isReset?: boolean;
}

/**
 * A raw control and its share: if the name has the value v, the control gets weight * v.
 */
export interface ControlShare {
  readonly control: number;
  readonly weight: number;
}

/** What to generate. */
export interface GenerateDesc {
  /** MIEN_PRESET_... */
  preset?: Preset;
  /** MIEN_GENERATE_..., combined with | */
  flags?: Generate;
  /** the same preset, flags and seed give the same bytes on every machine */
  seed?: number;
}

/** A named part of the input mesh. It becomes a mesh of the DNA file. */
export interface AuthorObject {
  /** 1 to 200 bytes */
  name?: string;
  /** the face after the last one of the object before it */
  firstFace?: number;
  faceCount?: number;
}

/** An expression. It becomes a raw control of the same name, 0 to 1. */
export interface AuthorShape {
  /** 1 to 200 bytes; all different */
  name?: string;
  /** indices of the positions that move. NULL: all, in order */
  positions?: Uint32Array | readonly number[];
  /** of `positions`, or of the mesh */
  positionCount?: number;
  /** 3 for each of these positions, with the control at 1 */
  displacements?: Float64Array | readonly number[];
}

/** A mesh to rig: a head, or the front of one, with everything inside it. */
export interface AuthorMesh {
  /** 3 per position, in the unit and axes of MienAuthorDesc */
  positions?: Float64Array | readonly number[];
  positionCount?: number;
  /** corners of each face, 3 or more. NULL: all are triangles */
  faceSizes?: Uint32Array | readonly number[];
  faceCount?: number;
  /** indices of positions, face by face, counterclockwise seen from outside */
  corners?: Uint32Array | readonly number[];
  cornerCount?: number;
  /** 2 per UV; may be NULL */
  uvs?: Float64Array | readonly number[];
  uvCount?: number;
  /** indices of UVs, one per corner. NULL: no UVs */
  cornerUvs?: Uint32Array | readonly number[];
  /** NULL: a single object named "head" */
  objects?: readonly AuthorObject[];
  objectCount?: number;
  /** may be NULL */
  shapes?: readonly AuthorShape[];
  shapeCount?: number;
}

/** A bone placed by the caller. */
export interface AuthorBone {
  /** 1 to 200 bytes; all different */
  name?: string;
  /** in the space of the mesh, not relative to the parent */
  position?: readonly number[];
  /** index of an earlier bone; the first bone is its own parent */
  parent?: number;
  /** MIEN_BONE_...: the first bone is the root, and facial bones are consecutive */
  kind?: BoneKind;
}

/** A point of the face that joints are placed by. */
export interface AuthorLandmark {
  /**
   * "nose" (tip), "throat", "lip_upper", "lip_lower" (in the middle), "mouth_l", "mouth_r" (corners, as the character sees them), "chin", "jaw" (its axis, in the middle plane), "eye_l", "eye_r" (centers of the eyeballs), "head", "neck" (pivots)
   */
  name?: string;
  /** in the unit and axes of the mesh */
  position?: readonly number[];
}

/** A LOD of the mesh, made by the caller. */
export interface AuthorLod {
  /**
   * indices of positions of the mesh, three per triangle, all three in the same object. Objects without triangles are not in the LOD
   */
  corners?: Uint32Array | readonly number[];
  cornerCount?: number;
  /**
   * indices of UVs, one per corner. NULL: chosen from the UVs that each position has in the mesh, so that they are nearest to each other
   */
  cornerUvs?: Uint32Array | readonly number[];
}

/**
 * How to rig a mesh. bones, weights, depth_groups, mask, lod_joints, bone_groups, bone_motions and
 * lod_meshes let the caller provide the result of one stage, which is then skipped.
 */
export interface AuthorDesc {
  /** 1 to 7000. 0: 240 */
  facialJoints?: number;
  /** per position: 1 to 12. 0: 8 */
  influences?: number;
  /** 1 to 8. 0: 8 */
  lods?: number;
  /** depth groups, of which the front one is the face: 2 to 16. 0: 3 */
  groups?: number;
  /** of the initial guesses of bone placement */
  seed?: number;
  /** centimeters per unit of the mesh. 0: 1 */
  unit?: number;
  /** MIEN_MESH_AXIS_... */
  up?: MeshAxis;
  /** MIEN_MESH_AXIS_..., perpendicular to `up` */
  front?: MeshAxis;
  /** MIEN_SYMMETRY_... */
  symmetry?: Symmetry;
  /** MIEN_AUTHOR_..., combined with | */
  flags?: AuthorFlags;
  /** of the character; empty: "head" */
  name?: string;
  /** name of the object with the face; empty: found automatically */
  faceObject?: string;
  /** NULL: placed automatically */
  bones?: readonly AuthorBone[];
  boneCount?: number;
  /** indices of bones, `influences` per position of the mesh. NULL: weights are computed */
  weightJoints?: Uint16Array | readonly number[];
  /** the weights for weight_joints; both or neither, and only with `bones` */
  weights?: Float32Array | readonly number[];
  /** may be NULL */
  parallel?: number;
  /** passed to the next function */
  progressUser?: number;
  /**
   * Called on the calling thread with the name of the step that begins and the progress from 0 to 1, which never decreases. Returns 0 to continue; anything else cancels. May be NULL.
   */
  progress?: number;
  /**
   * one per position of the mesh: its depth group, less than `groups`, 0 in front. NULL: computed
   */
  depthGroups?: Uint8Array | readonly number[];
  /**
   * one per position of the mesh: nonzero in the face mask, where facial bones are placed. NULL: computed
   */
  mask?: Uint8Array | readonly number[];
  /**
   * maximum number of facial joints in each of `lods` LODs (mirrored pairs stay together); never increasing, and LOD 0 has all. NULL: 240, 160, 110, 75, 50, 32, 20, 12, scaled to facial_joints
   */
  lodJoints?: Uint32Array | readonly number[];
  /** joint group of each of `bones`, 0 to 255. NULL: computed */
  boneGroups?: Uint32Array | readonly number[];
  /**
   * 6 numbers for each of `bones`, shape by shape, with the control at 1: translation, then degrees about X, Y, Z, applied in this order, in the unit and axes of the mesh. NULL: fitted
   */
  boneMotions?: Float64Array | readonly number[];
  /** 1 to 24. 0: chosen so that each has about 75 rows */
  jointGroups?: number;
  /**
   * maximum number of correctives that damp pairs of shapes with overlapping motion. 0: none
   */
  overlapCorrectives?: number;
  /**
   * share of the triangles of a LOD that the next one keeps: above 0, at most 1. 0: 0.5. 1: all
   */
  lodTriangles?: number;
  /** LOD 1, LOD 2 and so on. NULL: made according to lod_triangles */
  lodMeshes?: readonly AuthorLod[];
  /** one less than `lods` */
  lodMeshCount?: number;
  /**
   * used instead of those that are found; each name once, in any order. With "jaw", or a landmark of the mouth, there is a jaw even if no shape opens it. NULL: all are found
   */
  landmarks?: readonly AuthorLandmark[];
  landmarkCount?: number;
}

export interface DocumentDesc {
  /** MIEN_UNKNOWN_LAYERS_...; for mien_document_open_file() only */
  unknownLayers?: UnknownLayers;
}

/** How many deltas and targets mien_document_prune_targets() removed. */
export interface PrunedTargets {
  readonly deltas: number;
  readonly targets: number;
}

/**
 * The largest magnitudes of entries of the joint matrix that count as small, in the units of the file.
 */
export interface PruneJointsDesc {
  translation?: number;
  rotation?: number;
  scale?: number;
}

/**
 * The effect of mien_document_prune_joints(): removed entries, and the largest distance by which a position
 * moved.
 */
export interface PrunedJoints {
  /** entries of the joint matrix that were not 0 */
  readonly entryCount: number;
  /** of these, set to 0 */
  readonly removedCount: number;
  /** in the unit of the file */
  readonly worstDistance: number;
  /** the raw control at 1, or the corrective whose raw controls were at 1 */
  readonly worstControl: number;
  readonly worstMesh: number;
  readonly worstPosition: number;
}

/**
 * How to place a character: it is scaled about the origin, then rotated about it, then moved.
 */
export interface Placement {
  /** above 0. 0: 1 */
  scale?: number;
  /** right-handed degrees about x, then y, then z of the file */
  rotation?: readonly number[];
  /** in the unit of the file */
  translation?: readonly number[];
}

/** How mien_document_project() works. */
export interface ProjectDesc {
  /** MIEN_MATCH_... */
  match?: Match;
  /** at most, per position. 0: 8 */
  influences?: number;
  /** leave the skin weights as they are */
  keepWeights?: boolean;
  /** leave the targets as they are */
  keepTargets?: boolean;
}

/** How far the rig moved to follow a mesh. */
export interface Conformed {
  /** largest distance by which a joint moved, in the unit of the file */
  readonly jointDistance: number;
  /** that joint */
  readonly joint: number;
}

/** How mien_document_transplant() works. */
export interface TransplantDesc {
  /**
   * MIEN_MATCH_..., for meshes of the same name; positions of the same number correspond if the meshes have the same faces
   */
  match?: Match;
  /** at most, per position. 0: 8 */
  influences?: number;
}

/** How differently a raw control of both rigs, at 1, moves the positions of LOD 0. */
export interface ControlError {
  /** distance of a position, in the unit of the file */
  readonly worst: number;
  readonly rms: number;
  /** largest distance by which the control moved a position before */
  readonly moved: number;
  /** its index in the new rig */
  readonly control: number;
}

/**
 * A point of a surface: the weighted sum of three positions of a mesh. One position: weights 1 0 0.
 */
export interface SolvePoint {
  /** of the rig; points of a fit may be on several meshes */
  mesh?: number;
  /** in the order of the file */
  positions?: readonly number[];
  weights?: readonly number[];
}

/**
 * How to create a fit. Everything is copied. Raw controls in a row that are named as the parts x y z w of a
 * quaternion (.qx .qy .qz .qw, or .x .y .z .w), and begin as 0 0 0 1, are a rotation: if all four may move, they keep
 * the length 1, and have no bounds.
 */
export interface FitDesc {
  /** of the rig; needed for points and for constraints on joints. NULL: none */
  deformer?: { readonly handle: number };
  /** raw controls that may move, ascending. NULL: all */
  controls?: Uint32Array | readonly number[];
  /** bounds of these controls. NULL: 0 */
  lower?: Float32Array | readonly number[];
  /** NULL: 1 */
  upper?: Float32Array | readonly number[];
  /** pairs of raw controls kept similar: left, right, left, ... */
  symmetric?: Uint32Array | readonly number[];
  points?: readonly SolvePoint[];
  /** per joint value, 0 or more. NULL: 1 each, or 0 if there are points */
  jointWeights?: Float32Array | readonly number[];
  /** 0 if `controls` is NULL */
  controlCount?: number;
  /** elements of `symmetric`, an even number */
  symmetricCount?: number;
  pointCount?: number;
  lod?: number;
}

/**
 * How to create a surface. Everything is copied. Its unit and axes are those of the rig; triangles may be
 * wound either way, but all the same way.
 */
export interface FitSurfaceDesc {
  /** x y z each. Positions in the same place are one, as along texture seams */
  positions?: Float32Array | readonly number[];
  /** three positions each */
  triangles?: Uint32Array | readonly number[];
  positionCount?: number;
  triangleCount?: number;
}

/**
 * A pinhole camera: image x = focal[0] * x / z + center[0], and y likewise, for the point x y z in camera
 * space, after `rotation` and `translation`. z grows in front of the camera.
 */
export interface FitCamera {
  focal?: readonly number[];
  center?: readonly number[];
  /** rows, from model space. With MienFitFrame.rigid, all 0: unknown */
  rotation?: readonly number[];
  translation?: readonly number[];
}

/** A constraint of a frame. A number that is NaN: the constraint is missing. */
export interface FitConstraint {
  /** MIEN_CONSTRAINT_... */
  kind?: FitConstraintKind;
  /** of the rig */
  joint?: number;
  /** places in MienFitDesc.points */
  points?: readonly number[];
  /** in the axes of the joint, of any length but 0 */
  axis?: readonly number[];
  /** a place, or a direction of any length but 0 */
  target?: readonly number[];
  /** the smallest and the largest that cost nothing */
  distances?: readonly number[];
  /**
   * times the squared residual: of a length in the unit of the rig, or of the difference of directions of length 1
   */
  weight?: number;
}

/**
 * The targets of one frame, and the weights of the terms; terms of weight 0 are left out. Joints, points, images, a
 * surface and constraints may be given together: a point may have a target of each kind. Each kind has a unit of its
 * own: joint values, lengths (points and surface), and that of images.
 */
export interface FitFrame {
  /** joint values. NULL: none. NaN: missing */
  joints?: Float32Array | readonly number[];
  /** x y z per point. NULL: none. NaN: missing */
  points?: Float32Array | readonly number[];
  /** x y per point, as `camera` sees them. NULL: none. NaN: missing */
  images?: Float32Array | readonly number[];
  /** required with `images` */
  camera?: FitCamera;
  /** per point, 0 or more: of points and images. NULL: 1 */
  pointWeights?: Float32Array | readonly number[];
  /** all raw controls of the rig, to start from. NULL: the initial ones */
  start?: Float32Array | readonly number[];
  /** raw controls that the result is drawn to. NULL: the initial ones */
  prior?: Float32Array | readonly number[];
  /** times the squared distance to `prior` */
  priorWeight?: number;
  /** times the squared distance to `start`, the previous frame */
  smoothWeight?: number;
  /**
   * times the sum of magnitudes, from the initial values: few controls explain the frame
   */
  sparseWeight?: number;
  /** times the squared differences of symmetric pairs */
  symmetricWeight?: number;
  /** points farther off than this, or from the surface, count less. 0: all count fully */
  robustScale?: number;
  /** weight of the joints relative to the points. 0: 1 */
  jointWeight?: number;
  /**
   * points and surface may be rotated and translated as a whole, by one motion. With `images`, these stay where they are in model space, and the camera is found, from that of `camera`, or, if its rotation is unknown, from one that sees the face from the front
   */
  rigid?: boolean;
  /** 0: 50 */
  maxIterations?: number;
  /** 0: no limit. A limit makes results depend on the machine */
  maxSeconds?: number;
  /** passed to `canceled` */
  user?: number;
  /** Called before each iteration; a nonzero result stops. NULL: never. */
  canceled?: number;
  /**
   * each point is drawn to the nearest place of the surface that faces the same way, within 60 degrees, and is not at a border. NULL: none
   */
  surface?: { readonly handle: number };
  /** points farther from the surface have no target. 0: no limit */
  surfaceReach?: number;
  /**
   * , with `images` and `rigid`: the focal length is found too, its two numbers scaled alike
   */
  focal?: boolean;
  constraintCount?: number;
  /** up to 64, added to all other targets. NULL: none */
  constraints?: readonly FitConstraint[];
  /**
   * per raw control of the rig, up to 15: the solve begins with the controls of stage 0 alone, then those of stage 1 move too, and so on, as jaw and eyes before the rest. Each stage may take `max_iterations`. NULL: all move from the start
   */
  stages?: Uint32Array | readonly number[];
  /**
   * x y z per point, in model space: how far the points of the face in the targets are from those of the rig at rest, where it is another person's. Constraints are about the points of the rig. NULL: 0
   */
  pointOffsets?: Float32Array | readonly number[];
  /**
   * per point, 0 or more: how much it is drawn to `surface`. NULL: those of `point_weights`
   */
  surfaceWeights?: Float32Array | readonly number[];
  /**
   * weight of the images relative to the points: of a squared length in the image, against a squared length in space. 0: 1
   */
  imageWeight?: number;
  /**
   * `robust_scale` of images, in their unit. 0: `robust_scale`, or, if there are points or a surface too, all count fully
   */
  imageRobustScale?: number;
}

/** The result of a solve. */
export interface FitResult {
  /** MIEN_FIT_... */
  readonly status: FitStatus;
  readonly iterations: number;
  /** the minimized sum, with all terms */
  readonly cost: number;
  /** weighted root mean square of the differences of joint values */
  readonly jointResidual: number;
  /**
   * the same for points; without these, for images in their unit; without both, for the surface
   */
  readonly pointResidual: number;
  /** with a surface: those that have no target */
  readonly missingPoints: number;
  /**
   * rows: points of the target = rotation * model + translation, if rigid; the camera's with images
   */
  readonly rotation: readonly number[];
  readonly translation: readonly number[];
  /** largest difference of a joint value that counts */
  readonly jointWorst: number;
  /** largest distance of a point that counts, of the same kind */
  readonly pointWorst: number;
  /** of the camera, with images; else 0 */
  readonly focal: readonly number[];
  /** weighted root mean square of the residuals of constraints */
  readonly constraintResidual: number;
  /** largest residual of a constraint that counts */
  readonly constraintWorst: number;
  /**
   * joint values or points moved farther from where they are at `start` than their targets ask for, as roots of mean squares; those without a target count as such that ask for nothing
   */
  readonly jumped: boolean;
  readonly reserved2: number;
  /** weighted root mean square of the distances in the image */
  readonly imageResidual: number;
  readonly imageWorst: number;
  /** the same of the distances from the surface */
  readonly surfaceResidual: number;
  readonly surfaceWorst: number;
}

/**
 * The functions of the WebAssembly module: the C interface. Pointers and handles are numbers.
 * The classes of this package call them; use them yourself where a class lacks something.
 */
export interface Exports {
  readonly memory: WebAssembly.Memory;
  malloc(size: number): number;
  free(address: number): void;
  /**
   * Returns the MIEN_VERSION of the library in use, which may differ from that of this header.
   */
  mien_version(): number;
  /**
   * Returns "DNA_TRUNCATED" for MIEN_ERROR_DNA_TRUNCATED, and "UNKNOWN" for unknown numbers. The string
   * is static and null-terminated.
   */
  mien_status_name(status: number): number;
  /**
   * Returns the coordinate system of an engine or tool: "maya", "unreal", "unreal-mesh" (characters
   * look along y), "unity", "godot", "blender", "gltf", "opengl", "directx" or "houdini". The rotation
   * rule is MIEN_ROTATION_RULE_CARRIED; rotation_sequence is that of the engine's Euler angles, and only
   * takes effect if you set another rule.
   * Fails with MIEN_ERROR_NAME if the name is none of these.
   */
  mien_coordinate_system_find(name: number, out_system: number): number;
  /**
   * Returns the coordinate system of an engine or tool: "maya", "unreal", "unreal-mesh" (characters
   * look along y), "unity", "godot", "blender", "gltf", "opengl", "directx" or "houdini". The rotation
   * rule is MIEN_ROTATION_RULE_CARRIED; rotation_sequence is that of the engine's Euler angles, and only
   * takes effect if you set another rule.
   * Fails with MIEN_ERROR_NAME if the name is none of these.
   */
  mien_coordinate_system_find_n(name: number, name_count: number, out_system: number): number;
  /**
   * Returns a name that mien_coordinate_system_find() accepts. The string is static.
   * Fails with MIEN_ERROR_INDEX if `index` is past the last name.
   */
  mien_coordinate_system_name(index: number, out_name: number): number;
  /**
   * Opens a DNA file in memory: `size` bytes, of any alignment. `bytes` must outlive the MienDna,
   * unchanged.
   * Fails like mien_dna_open_file(), but not with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ.
   */
  mien_dna_open_memory(bytes: number, size: number, desc: number, out_dna: number, error: number): number;
  /**
   * Opens a DNA file through a stream. Reads the header, the index and the requested layers, each
   * with one read, into memory from the allocator.
   * Fails like mien_dna_open_file(), but not with MIEN_ERROR_FILE_OPEN.
   */
  mien_dna_open_stream(stream: number, desc: number, out_dna: number, error: number): number;
  /** Closes a DNA. Rigs and deformers created from it stay valid; views into it do not. */
  mien_dna_close(dna: number): void;
  /** Returns the properties of a DNA. */
  mien_dna_info(dna: number, out_info: number): number;
  /**
   * Returns entry `index` of the index table, in file order.
   * Fails with MIEN_ERROR_INDEX if `index` is not below MienDnaInfo.layer_count.
   * See docs/dna-format.md, 4.1 "Index table".
   */
  mien_dna_layer(dna: number, index: number, out_layer: number): number;
  /**
   * Finds a field of a loaded layer by its path: the code of the layer, then the names of fields, with
   * an index after each list.
   *
   *     desc.name                                 a string
   *     desc.metadata[0].key                      a string
   *     defn.jointNames                           a list of strings; defn.jointNames[3] is one
   *     defn.neutralJointTranslations.xs          floats
   *     bhvr.joints.jointGroups[7].values         floats
   *     geom.meshes[0].skinWeights[12].weights    floats
   *     mlbh.neuralNetworks[0].layers[1].biases   floats
   *
   * Layers that are not loaded are empty.
   * Fails with MIEN_ERROR_NAME if there is no such field (the message contains the part of the path that
   * does not exist), MIEN_ERROR_INDEX if an index in the path is past the end.
   * See docs/dna-format.md, 6 "Layers, field by field".
   */
  mien_dna_field(dna: number, path: number, out_field: number, error: number): number;
  /**
   * Finds a field of a loaded layer by its path: the code of the layer, then the names of fields, with
   * an index after each list.
   *
   *     desc.name                                 a string
   *     desc.metadata[0].key                      a string
   *     defn.jointNames                           a list of strings; defn.jointNames[3] is one
   *     defn.neutralJointTranslations.xs          floats
   *     bhvr.joints.jointGroups[7].values         floats
   *     geom.meshes[0].skinWeights[12].weights    floats
   *     mlbh.neuralNetworks[0].layers[1].biases   floats
   *
   * Layers that are not loaded are empty.
   * Fails with MIEN_ERROR_NAME if there is no such field (the message contains the part of the path that
   * does not exist), MIEN_ERROR_INDEX if an index in the path is past the end.
   * See docs/dna-format.md, 6 "Layers, field by field".
   */
  mien_dna_field_n(dna: number, path: number, path_count: number, out_field: number, error: number): number;
  /**
   * Returns the name of field `index` of the record at a path. The empty path is the file itself, whose
   * fields are the layers. The string is static.
   * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if `index` or an index in the
   * path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a record.
   * See docs/dna-format.md, 6 "Layers, field by field".
   */
  mien_dna_child_name(dna: number, path: number, index: number, out_name: number, error: number): number;
  /**
   * Returns the name of field `index` of the record at a path. The empty path is the file itself, whose
   * fields are the layers. The string is static.
   * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if `index` or an index in the
   * path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a record.
   * See docs/dna-format.md, 6 "Layers, field by field".
   */
  mien_dna_child_name_n(dna: number, path: number, path_count: number, index: number, out_name: number, error: number): number;
  /**
   * Copies `count` elements of a field, beginning with element `first`, to `out`, in native byte order.
   * A field that is one number has one element. `out` may be NULL if `count` is 0. Integers are widened
   * to 64 bits.
   * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
   * the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
   * kind.
   */
  mien_dna_read_floats(dna: number, path: number, first: bigint, count: bigint, out: number, error: number): number;
  /**
   * Copies `count` elements of a field, beginning with element `first`, to `out`, in native byte order.
   * A field that is one number has one element. `out` may be NULL if `count` is 0. Integers are widened
   * to 64 bits.
   * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
   * the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
   * kind.
   */
  mien_dna_read_floats_n(dna: number, path: number, path_count: number, first: bigint, count: bigint, out: number, error: number): number;
  /**
   * Copies `count` elements of a field, beginning with element `first`, to `out`, in native byte order.
   * A field that is one number has one element. `out` may be NULL if `count` is 0. Integers are widened
   * to 64 bits.
   * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
   * the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
   * kind.
   */
  mien_dna_read_integers(dna: number, path: number, first: bigint, count: bigint, out: number, error: number): number;
  /**
   * Copies `count` elements of a field, beginning with element `first`, to `out`, in native byte order.
   * A field that is one number has one element. `out` may be NULL if `count` is 0. Integers are widened
   * to 64 bits.
   * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
   * the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
   * kind.
   */
  mien_dna_read_integers_n(dna: number, path: number, path_count: number, first: bigint, count: bigint, out: number, error: number): number;
  /**
   * Returns a string of the file.
   * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is
   * past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a string.
   */
  mien_dna_read_string(dna: number, path: number, out_string: number, error: number): number;
  /**
   * Returns a string of the file.
   * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is
   * past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a string.
   */
  mien_dna_read_string_n(dna: number, path: number, path_count: number, out_string: number, error: number): number;
  /**
   * Writes a DNA file to memory and returns its size in `out_size`. `buffer` may be NULL with capacity 0
   * to get the size only. Writes nothing if `capacity` is too small; `out_size` is set nevertheless.
   * Fails like mien_dna_write_file(), but not with MIEN_ERROR_FILE_WRITE, and with
   * MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small.
   */
  mien_dna_write_memory(dna: number, desc: number, buffer: number, capacity: number, out_size: number, error: number): number;
  /** Checks a file in memory: `size` bytes. `bytes` may be released afterwards. */
  mien_dna_validate_memory(bytes: number, size: number, desc: number, out_report: number, error: number): number;
  /** Returns the number of errors and the number of warnings. */
  mien_report_counts(report: number, out_errors: number, out_warnings: number): number;
  /**
   * Returns finding `index`, in the order of the checks. Their number is that of errors plus warnings.
   * Fails with MIEN_ERROR_INDEX if `index` is past the last finding.
   */
  mien_report_finding(report: number, index: number, out_finding: number): number;
  /** Destroys a report. */
  mien_report_destroy(report: number): void;
  /** Returns 1 if rigs can be created for instruction set `isa` on this machine, else 0. */
  mien_isa_available(isa: number): number;
  /**
   * Returns "avx2" for MIEN_ISA_AVX2, and so on; "unknown" for unknown numbers. The string is static
   * and null-terminated.
   */
  mien_isa_name(isa: number): number;
  /**
   * Packs the behavior of a DNA for evaluation. The rig is one block of memory, or two with
   * MIEN_REUSE_SUMS; temporary memory is released before the call returns. `dna` may be closed afterwards. Destroy with mien_rig_destroy().
   * Fails with MIEN_ERROR_DNA_LAYER if `dna` was opened without its behavior, MIEN_ERROR_DNA_VALUE if
   * correctives depend on each other in a cycle, MIEN_ERROR_DNA_LIMIT if the rig is too large,
   * MIEN_ERROR_ISA if the requested instruction set is not available.
   * See docs/rig-evaluation.md and docs/dna-format.md, 13 "What is checked".
   */
  mien_rig_create(dna: number, desc: number, out_rig: number, error: number): number;
  /**
   * Destroys a rig. The handle is invalid afterwards, but instances, batches and deformers of the rig may
   * be destroyed later: its memory is released with the last of them.
   */
  mien_rig_destroy(rig: number): void;
  /** Returns the properties of a rig. */
  mien_rig_info(rig: number, out_info: number): number;
  /** Returns the number of parts of a kind. */
  mien_rig_count(rig: number, kind: number, out_count: number): number;
  /**
   * Returns a name; "" for kinds without names.
   * Fails with MIEN_ERROR_INDEX if `index` is not below mien_rig_count().
   */
  mien_rig_name(rig: number, kind: number, index: number, out_name: number): number;
  /**
   * Finds the index of a name by exact match; of equal names, the first. Takes O(log n) time.
   * Fails with MIEN_ERROR_NAME if there is no such name, MIEN_ERROR_INVALID_ARGUMENT if `kind` has no
   * names.
   */
  mien_rig_find(rig: number, kind: number, name: number, out_index: number): number;
  /**
   * Finds the index of a name by exact match; of equal names, the first. Takes O(log n) time.
   * Fails with MIEN_ERROR_NAME if there is no such name, MIEN_ERROR_INVALID_ARGUMENT if `kind` has no
   * names.
   */
  mien_rig_find_n(rig: number, kind: number, name: number, name_count: number, out_index: number): number;
  /**
   * Returns the indices of the joints, blend shape channels, animated maps, meshes or RBF solvers that
   * a LOD lists, in file order.
   * Fails with MIEN_ERROR_LOD if the rig has no such LOD, MIEN_ERROR_INVALID_ARGUMENT if `kind` is not
   * one of these five.
   * See docs/dna-format.md, 8.2 "LOD mappings".
   */
  mien_rig_lod_indices(rig: number, kind: number, lod: number, out_indices: number): number;
  /**
   * Returns the indices of the joint values that evaluation may change at a LOD, ascending. All others
   * keep their initial value: 0, or 1 for the w of a quaternion.
   * Fails with MIEN_ERROR_LOD if the rig has no such LOD.
   * See docs/rig-evaluation.md, 4.10 "Which joint values a LOD may change".
   */
  mien_rig_variable_joint_values(rig: number, lod: number, out_indices: number): number;
  /** Returns the parents of the joints, one index per joint. A root is its own parent. */
  mien_rig_joint_parents(rig: number, out_parents: number): number;
  /**
   * Returns the neutral pose, relative to the parents: 9 or 10 floats per joint, in the order of the
   * joint values. The scale is 1.
   * See docs/rig-evaluation.md, 4.2 "Neutral pose".
   */
  mien_rig_neutral_joint_values(rig: number, out_values: number): number;
  /**
   * Returns the controls whose product is corrective `psd`, as indices into the control vector.
   * Fails with MIEN_ERROR_INDEX if there is no such corrective.
   * See docs/rig-evaluation.md, 3.1 "Weights and inputs".
   */
  mien_rig_psd_inputs(rig: number, psd: number, out_controls: number): number;
  /**
   * Returns the initial values of the raw controls, one float per raw control: 0, or 1 for the w of a
   * quaternion.
   * See docs/rig-evaluation.md, 1.2 "Initial values".
   */
  mien_rig_initial_raw_controls(rig: number, out_values: number): number;
  /**
   * Returns the statistics of a LOD.
   * Fails with MIEN_ERROR_LOD if the rig has no such LOD.
   * See docs/rig-evaluation.md, 9.6 "Statistics".
   */
  mien_rig_statistics(rig: number, lod: number, out_statistics: number): number;
  /**
   * Creates an instance in its initial state: one allocation of MienRigInfo.instance_bytes. `rig` may be
   * destroyed before it. Destroy with mien_instance_destroy().
   * See docs/rig-evaluation.md, 9.2 "Instances".
   */
  mien_instance_create(rig: number, desc: number, out_instance: number, error: number): number;
  /** Destroys an instance. */
  mien_instance_destroy(instance: number): void;
  /**
   * Resets an instance to its initial state: all inputs and results, at LOD 0.
   * See docs/rig-evaluation.md, 1.2 "Initial values".
   */
  mien_instance_reset(instance: number): number;
  /**
   * Returns the GUI controls for the caller to write: one float per GUI control. Only
   * mien_rig_map_gui_to_raw() reads them.
   * Contents change with mien_rig_map_raw_to_gui(), mien_instance_reset().
   */
  mien_instance_gui_controls(instance: number, out_view: number): number;
  /**
   * Returns the raw controls for the caller to write: one float per raw control, typically 0 to 1, not
   * clamped. They are the inputs of evaluation.
   * Contents change with mien_rig_map_gui_to_raw(), mien_instance_reset().
   */
  mien_instance_raw_controls(instance: number, out_view: number): number;
  /**
   * Returns the region masks for the caller to write: one float per region of each mesh, 0 to 1,
   * initially 1. They switch or blend machine-learned behavior (MIEN_ML_MASKS_...).
   * Contents change with mien_instance_reset().
   * See docs/rig-evaluation.md, 8.5 "Region masks".
   */
  mien_instance_ml_masks(instance: number, out_view: number): number;
  /**
   * Returns the control vector: one float per control, the raw, PSD, ML and RBF controls in this order.
   * Contents change with evaluation, mien_rig_map_gui_to_raw(), mien_instance_reset() and writes to the raw
   * controls.
   * See docs/rig-evaluation.md, 1.1 "Control vector".
   */
  mien_instance_controls(instance: number, out_view: number): number;
  /**
   * Returns the PSD controls (correctives) of the control vector: one float per PSD control.
   * Contents change with evaluation, mien_instance_reset().
   */
  mien_instance_psd_controls(instance: number, out_view: number): number;
  /**
   * Returns the ML controls of the control vector: one float per ML control.
   * Contents change with evaluation, mien_instance_reset().
   */
  mien_instance_ml_controls(instance: number, out_view: number): number;
  /**
   * Returns the RBF pose controls of the control vector: one float per RBF control.
   * Contents change with evaluation, mien_instance_reset().
   */
  mien_instance_rbf_controls(instance: number, out_view: number): number;
  /**
   * Returns the joint values: 9 or 10 floats per joint (MIEN_ROTATION_OUTPUT_...), as deltas from the
   * neutral pose. Translation, angles and scale are added to the neutral ones; with quaternions the
   * rotation is neutral * delta, so the delta rotates first.
   * Contents change with evaluation, mien_instance_reset().
   * See docs/rig-evaluation.md, 4.1 "Joint values".
   */
  mien_instance_joints(instance: number, out_view: number): number;
  /**
   * Returns the weights of the blend shape channels: one float per channel.
   * Contents change with evaluation, mien_instance_reset().
   * See docs/rig-evaluation.md, 5 "Blend shapes and animated maps".
   */
  mien_instance_blend_shapes(instance: number, out_view: number): number;
  /**
   * Returns the weights of the animated maps, 0 to 1: one float per animated map.
   * Contents change with evaluation, mien_instance_reset().
   * See docs/rig-evaluation.md, 5 "Blend shapes and animated maps".
   */
  mien_instance_animated_maps(instance: number, out_view: number): number;
  /**
   * Returns the statistics of an instance. Takes time proportional to the number of controls: meant for
   * measurements, not for every frame.
   * See docs/rig-evaluation.md, 9.6 "Statistics".
   */
  mien_instance_statistics(instance: number, out_statistics: number): number;
  /**
   * Maps GUI controls to raw controls. Raw controls that the rig's table drives are overwritten with
   * values clamped to 0..1; others are left unchanged. Does not allocate or lock.
   * Fails with MIEN_ERROR_MISMATCH if `instance` belongs to another rig.
   * See docs/rig-evaluation.md, 2.3 "GUI controls to raw controls".
   */
  mien_rig_map_gui_to_raw(rig: number, instance: number): number;
  /**
   * Maps raw controls to GUI controls. Sets every GUI control to the value that maps to the current raw
   * controls, or to 0 if there is no such value. Does not allocate or lock.
   * Fails with MIEN_ERROR_MISMATCH if `instance` belongs to another rig.
   * See docs/rig-evaluation.md, 2.4 "Raw controls to GUI controls".
   */
  mien_rig_map_raw_to_gui(rig: number, instance: number): number;
  /**
   * Evaluates all stages at a LOD. Results that the LOD does not drive have their initial value. Inputs
   * must be finite; then the results are finite too. Changing the LOD between calls is cheap: it resets
   * the results. Does not allocate or lock. Uses up to 48 KiB of stack.
   * Fails with MIEN_ERROR_LOD if the rig has no such LOD, MIEN_ERROR_MISMATCH if `instance` belongs to
   * another rig.
   * See docs/rig-evaluation.md, 1.3 "Order of evaluation".
   */
  mien_rig_evaluate(rig: number, instance: number, lod: number): number;
  /**
   * Evaluates some stages, in the order of enum MienStage. The others keep the results of the last
   * evaluation at this LOD; after a change of LOD they are reset. Does not allocate or lock. Uses up to
   * 48 KiB of stack.
   * Fails with MIEN_ERROR_LOD if the rig has no such LOD, MIEN_ERROR_MISMATCH if `instance` belongs to
   * another rig.
   * See docs/rig-evaluation.md, 9.3 "Partial evaluation".
   */
  mien_rig_evaluate_stages(rig: number, instance: number, lod: number, stages: number): number;
  /**
   * Creates a batch: one allocation of mien_batch_bytes(), which with 16-bit storage includes the weights of
   * networks as floats, 4 bytes each. `rig` may be destroyed before it. Destroy with
   * mien_batch_destroy().
   */
  mien_batch_create(rig: number, desc: number, out_batch: number, error: number): number;
  /** Destroys a batch. */
  mien_batch_destroy(batch: number): void;
  /** Returns the memory that a batch would take. */
  mien_batch_bytes(rig: number, desc: number, out_bytes: number): number;
  /**
   * Evaluates stages of `count` different instances of one rig; instance i at LOD lods[i]. The results
   * are bit-identical to those of mien_rig_evaluate_stages() (joint values with MIEN_REUSE_SUMS: within the
   * bound of a full evaluation), but columns of the joint matrix that several
   * instances use are read only once for up to 32 of them. Runs on the calling thread, or in tasks
   * on `parallel`; `parallel` may be NULL. Does not allocate or lock. Uses up to 48 KiB of stack per
   * task. On failure no instance is evaluated.
   * Fails with MIEN_ERROR_LOD if the rig has no such LOD, MIEN_ERROR_MISMATCH if the batch or an
   * instance belongs to another rig, MIEN_ERROR_INVALID_ARGUMENT if `count` exceeds
   * MienBatchDesc.capacity or an instance is listed twice.
   * See docs/numbers.md, 10 "One by one, in batches, with reused results".
   */
  mien_rig_evaluate_batch(rig: number, batch: number, instances: number, lods: number, count: number, stages: number, parallel: number): number;
  /**
   * Evaluates the joint values of one joint group (MIEN_KIND_JOINT_GROUP), except those that a later
   * group overrides at all LODs where this one sets them. Does not allocate or lock. Uses up to 48 KiB
   * of stack.
   * Fails with MIEN_ERROR_INDEX if there is no such joint group, MIEN_ERROR_LOD if the rig has no such
   * LOD, MIEN_ERROR_MISMATCH if `instance` belongs to another rig.
   * See docs/rig-evaluation.md, 4.5 "Order of the joint stage".
   */
  mien_rig_evaluate_joint_group(rig: number, instance: number, lod: number, group: number): number;
  /**
   * Evaluates the pose controls of one RBF solver (MIEN_KIND_RBF_SOLVER), even if the LOD does not list
   * it. Does not allocate or lock.
   * Fails with MIEN_ERROR_INDEX if there is no such solver, MIEN_ERROR_LOD if the rig has no such LOD,
   * MIEN_ERROR_MISMATCH if `instance` belongs to another rig.
   * See docs/rig-evaluation.md, 6 "RBF solvers".
   */
  mien_rig_evaluate_rbf_solver(rig: number, instance: number, lod: number, solver: number): number;
  /**
   * Evaluates the joints of one twist and swing setup (MIEN_KIND_TWIST_SWING). Does not allocate or
   * lock.
   * Fails with MIEN_ERROR_INDEX if there is no such setup, MIEN_ERROR_LOD if the rig has no such LOD,
   * MIEN_ERROR_MISMATCH if `instance` belongs to another rig.
   * See docs/rig-evaluation.md, 7 "Twist and swing".
   */
  mien_rig_evaluate_twist_swing(rig: number, instance: number, lod: number, setup: number): number;
  /**
   * Packs the geometry of a DNA for deformation. `dna` is the one that the rig was created from, or the
   * same file opened with the same LODs. `dna` may be closed and `rig` may be destroyed afterwards. The
   * deformer is one block of memory; temporary memory is released before the call returns. Destroy with
   * mien_deformer_destroy().
   *
   * Influences of weight 0 and faces of fewer than three corners are dropped. Meshes may lack faces,
   * weights, normals or texture coordinates: missing normals are computed from the faces, missing
   * texture coordinates are 0. Stored normals determine which side of a face is outside; without
   * them, the winding and the axes of the file do.
   *
   * Fails with MIEN_ERROR_DNA_LAYER if `dna` was opened without MIEN_LAYER_GEOMETRY, MIEN_ERROR_MISMATCH
   * if the number or the names of joints, channels or meshes differ from those of the rig,
   * MIEN_ERROR_DNA_VALUE if a joint is its own ancestor or a position, delta or weight is not finite,
   * MIEN_ERROR_DNA_LIMIT if a position has more than 65535 influences, MIEN_ERROR_ISA if the requested
   * instruction set is not available, MIEN_ERROR_INVALID_ARGUMENT if `delta_error` is negative or not finite.
   * See docs/deformation.md.
   */
  mien_deformer_create(dna: number, rig: number, desc: number, out_deformer: number, error: number): number;
  /**
   * Creates a deformer of some positions of one mesh. Position i of that mesh is `positions[i]` of the mesh of
   * `deformer`; it has no vertices or triangles, and all other meshes are empty. Deformed positions have the bits of
   * the whole mesh (with 16-bit storage they may be rounded otherwise), derivatives those of the chosen rows, and both
   * take time for the chosen positions only. `positions` are ascending, `position_count` of them. `deformer` may be
   * destroyed afterwards; the new one keeps its memory. Destroy with mien_deformer_destroy().
   * Fails with MIEN_ERROR_INDEX if there is no such mesh or position, MIEN_ERROR_INVALID_ARGUMENT if positions are not
   * ascending.
   */
  mien_deformer_create_subset(deformer: number, mesh: number, positions: number, position_count: number, allocator: number, out_deformer: number, error: number): number;
  /**
   * Destroys a deformer. Its instances stay valid; its memory is released with the last of them.
   */
  mien_deformer_destroy(deformer: number): void;
  /** Returns the properties of a deformer. */
  mien_deformer_info(deformer: number, out_info: number): number;
  /**
   * Returns a neutral mesh.
   * Fails with MIEN_ERROR_INDEX if there is no such mesh.
   */
  mien_deformer_mesh(deformer: number, mesh: number, out_mesh: number): number;
  /**
   * Writes the triangles of a mesh to `out_triangles`: 3 indices per triangle, as in MienMesh.triangles, with any
   * storage. `count` is the capacity of `out_triangles`, in indices. With 16-bit storage takes memory for the
   * duration of the call, 4 bytes per position, from the allocator of the deformer.
   * Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_INVALID_ARGUMENT if `count` is less than
   * 3 * MienMesh.triangle_count, MIEN_ERROR_MEMORY if memory ran out.
   */
  mien_deformer_triangles(deformer: number, mesh: number, out_triangles: number, count: number): number;
  /**
   * Writes the texture coordinates of a mesh to `out_coordinates`: 2 floats per vertex, u v, with any storage. With
   * 16-bit storage they are off by at most 1/131070 of the range of the mesh. `count` is the capacity of
   * `out_coordinates`, in floats.
   * Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_INVALID_ARGUMENT if `count` is less than
   * 2 * MienMesh.vertex_count.
   */
  mien_deformer_texture_coordinates(deformer: number, mesh: number, out_coordinates: number, count: number): number;
  /**
   * Returns the influences of a position, as used for skinning: `out_joints` gets one index per influence,
   * `out_weights` gets one float per influence. There may be none.
   * Fails with MIEN_ERROR_INDEX if there is no such mesh or position, MIEN_ERROR_UNSUPPORTED if the weights
   * are stored with 16 bits (MienDeformerDesc.storage).
   */
  mien_deformer_influences(deformer: number, mesh: number, position: number, out_joints: number, out_weights: number): number;
  /**
   * Writes a blend shape target to `out_deltas`: 3 floats per position, the offset at channel weight 1.
   * Positions that the target does not move get 0. `count` is the capacity of `out_deltas`, in floats.
   * Fails with MIEN_ERROR_INDEX if there is no such mesh or target, MIEN_ERROR_INVALID_ARGUMENT if
   * `count` is less than 3 * MienMesh.position_count.
   */
  mien_deformer_target(deformer: number, mesh: number, target: number, out_deltas: number, count: number): number;
  /**
   * Returns the model matrices of the neutral pose: 16 floats per joint, column by column, for column
   * vectors. The last column is the translation, the last row 0 0 0 1.
   */
  mien_deformer_bind_matrices(deformer: number, out_matrices: number): number;
  /** Returns the inverses of the bind matrices: 16 floats per joint, column by column. */
  mien_deformer_inverse_bind_matrices(deformer: number, out_matrices: number): number;
  /**
   * Creates a deformer instance in the neutral pose: one allocation. `deformer` may be destroyed before
   * it. Destroy with mien_deformer_instance_destroy().
   */
  mien_deformer_instance_create(deformer: number, desc: number, out_deformer_instance: number, error: number): number;
  /** Destroys a deformer instance. */
  mien_deformer_instance_destroy(deformer_instance: number): void;
  /**
   * Copies the joint values and channel weights of the last evaluation of `instance`, and computes the
   * matrices of all joints. mien_deformer_instance_deform() then deforms meshes. Values that are
   * not finite give results that are not finite. Does not allocate or lock.
   * Fails with MIEN_ERROR_MISMATCH if `instance` belongs to a rig other than that of the deformer.
   * See docs/deformation.md, 1 "Joint transforms".
   */
  mien_deformer_instance_update(deformer_instance: number, instance: number): number;
  /**
   * Does the same with arrays: `joint_values` like those of mien_instance_joints(), `channel_weights`
   * one per channel. `joint_values` may be NULL with count 0: no deltas. `channel_weights` may be NULL
   * with count 0: all weights are 0. Does not allocate or lock.
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if a count is not that of the rig.
   */
  mien_deformer_instance_update_from_values(deformer_instance: number, joint_values: number, joint_value_count: number, channel_weights: number, channel_weight_count: number): number;
  /**
   * Returns the model matrices: 16 floats per joint, in the layout of mien_deformer_bind_matrices().
   * Contents change with mien_deformer_instance_update(), mien_deformer_instance_update_from_values().
   */
  mien_deformer_instance_joint_matrices(deformer_instance: number, out_matrices: number): number;
  /**
   * Returns the skin matrices, for skinning by the caller, for example on a GPU: 16 floats per joint, in
   * the layout of mien_deformer_bind_matrices().
   * Contents change with mien_deformer_instance_update(), mien_deformer_instance_update_from_values().
   */
  mien_deformer_instance_skin_matrices(deformer_instance: number, out_matrices: number): number;
  /**
   * Writes the joint transforms of the last update, relative to the parents, to `out_transforms`: 10
   * floats per joint, tx ty tz qx qy qz qw sx sy sz, with quaternions of unit length. `count` is the
   * capacity of `out_transforms`, in floats. Does not allocate or lock.
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if `count` is less than 10 * MienDeformerInfo.joint_count.
   */
  mien_deformer_instance_local_transforms(deformer_instance: number, out_transforms: number, count: number): number;
  /**
   * Computes the positions and normals of a mesh for the last update. Runs on the calling thread; meshes
   * of at least 16384 positions run in tasks of about 1024 on `parallel`. `parallel` may be NULL. The
   * results have the same bits either way. Does not allocate or lock. Uses up to 16 KiB of stack per
   * task.
   * Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_LOD if `deformer_instance` has no
   * memory for it (MienDeformerInstanceDesc.lods).
   * See docs/deformation.md, 2 "Positions" and 3 "Normals".
   */
  mien_deformer_instance_deform(deformer_instance: number, mesh: number, normals: number, parallel: number): number;
  /**
   * Deforms the same mesh of `count` different instances of one deformer. The results are bit-identical to
   * those of mien_deformer_instance_deform(), but each part of the mesh is read only once for all of them,
   * and the total number of positions decides whether tasks are used. `parallel` may be NULL. Does not
   * allocate or lock. Uses up to 16 KiB of stack per task. On failure nothing is deformed.
   * Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_LOD if an instance has no memory for
   * it, MIEN_ERROR_MISMATCH if the instances have different deformers, MIEN_ERROR_INVALID_ARGUMENT if
   * an instance is listed twice.
   */
  mien_deformer_instance_deform_batch(deformer_instances: number, count: number, mesh: number, normals: number, parallel: number): number;
  /**
   * Returns the deformed positions of a mesh: 3 floats per position, x y z.
   * Contents change with mien_deformer_instance_deform(), mien_deformer_instance_write_vertices() and
   * their batches.
   * Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_LOD if `deformer_instance` has no
   * memory for it.
   */
  mien_deformer_instance_positions(deformer_instance: number, mesh: number, out_positions: number): number;
  /**
   * Returns the deformed normals of a mesh: 3 floats per vertex, x y z, unit length.
   * Contents change with mien_deformer_instance_deform(), mien_deformer_instance_write_vertices() and
   * their batches.
   * Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_LOD if `deformer_instance` has no
   * memory for it.
   */
  mien_deformer_instance_normals(deformer_instance: number, mesh: number, out_normals: number): number;
  /**
   * Deforms a mesh as mien_deformer_instance_deform() does, and writes its vertices to memory of the
   * caller, such as a mapped vertex buffer. Each byte is written once, in the order of the vertices, and
   * none is read, so the memory may be write-combined. Bytes between vertices are left unchanged. `parallel`
   * may be NULL; the bytes are the same either way. The same positions, normals and tangents give the
   * same bytes on every instruction set. Does not allocate or lock. Uses up to 16 KiB of stack per task.
   * On failure nothing is deformed or written.
   * Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_LOD if `deformer_instance` has no
   * memory for it, MIEN_ERROR_INVALID_ARGUMENT if a stream has a format that its attribute cannot have,
   * a wrong stride or alignment or too little capacity, if streams overlap, if there is no stream, or if
   * tangents are requested from a deformer without them.
   * See docs/deformation.md, 5 "Vertex output".
   */
  mien_deformer_instance_write_vertices(deformer_instance: number, mesh: number, normals: number, output: number, parallel: number): number;
  /**
   * Does the same for one mesh of `count` different instances of one deformer: instance i is written to
   * outputs[i]. All outputs have the same struct_size, and must not share bytes. `parallel` may be NULL.
   * Does not allocate or lock. Uses up to 16 KiB of stack per task.
   * Fails like mien_deformer_instance_write_vertices(), and with MIEN_ERROR_MISMATCH if the instances have
   * different deformers, MIEN_ERROR_INVALID_ARGUMENT if an instance is listed twice.
   */
  mien_deformer_instance_write_vertices_batch(deformer_instances: number, count: number, mesh: number, normals: number, outputs: number, parallel: number): number;
  /**
   * Creates derivatives. `desc` may be NULL. `rig` may be destroyed afterwards, and so may the deformer.
   * Takes one block of memory, which holds a copy of the weights of networks, room for 32 directions, and 8
   * bytes for each 8 numbers of the joint matrix.
   * Destroy with mien_derivatives_destroy().
   * Fails with MIEN_ERROR_MISMATCH if the deformer is not of the rig.
   */
  mien_derivatives_create(rig: number, desc: number, out_derivatives: number, error: number): number;
  /** Destroys derivatives. NULL is allowed. */
  mien_derivatives_destroy(derivatives: number): void;
  /**
   * Returns the number of bytes that mien_derivatives_create() would allocate.
   * Fails with MIEN_ERROR_MISMATCH if the deformer is not of the rig.
   */
  mien_derivatives_bytes(rig: number, desc: number, out_bytes: number): number;
  /**
   * Returns how many numbers a point has. `mesh` is the index of the mesh of MIEN_POINT_POSITIONS, else 0.
   * Fails with MIEN_ERROR_INDEX if there is no such mesh, or the point needs a deformer and there is none.
   */
  mien_derivatives_size(derivatives: number, point: number, mesh: number, out_size: number): number;
  /**
   * Computes the derivatives at the values of `instance`, which must belong to the rig and have been
   * evaluated, alone or in a batch, at the LOD of that evaluation. `stages` selects the stages to differentiate, MIEN_STAGE_ALL or
   * some of them: the results of the others count as constants. Does not allocate or lock.
   * Where a function has no derivative, a one-sided one is used, so that solvers do not get stuck:
   *   - controls at 0 or 1, for correctives, GUI controls and maps: into the interval
   *   - where two intervals of a conditional table meet: that of the steeper one
   *   - RBF poses with a weight below the threshold: as without a threshold; at a stored pose: 0
   *   - ReLU at 0: as above 0
   * Saturation is ignored: values that overflow have the derivatives of the formula. Controls that a network
   * or solver reads before they are computed count as constants.
   * Fails with MIEN_ERROR_MISMATCH if the instance is not of the rig.
   */
  mien_derivatives_linearize(derivatives: number, instance: number, stages: number): number;
  /**
   * Multiplies directions by the matrix of derivatives (Jacobian-vector products). Each of the `count`
   * directions is a row of mien_derivatives_size() numbers at `from`; its output is the resulting change of
   * the numbers at `to`. Rows follow each other without gaps; `outputs` has `count` rows and must not overlap
   * `directions`. Several directions in one call are faster than one by one, and give the same bits. Does not
   * allocate or lock.
   * Fails with MIEN_ERROR_INDEX if a point lacks its deformer or mesh, MIEN_ERROR_INVALID_ARGUMENT if `from`
   * has no effect on `to` or nothing was linearized.
   */
  mien_derivatives_forward(derivatives: number, from: number, to: number, mesh: number, count: number, directions: number, outputs: number): number;
  /**
   * Multiplies gradients by the transposed matrix (vector-Jacobian products): turns each of `count` gradients
   * with respect to the numbers at `to` into the gradient with respect to those at `from`. All else is as in
   * mien_derivatives_forward().
   * Fails with MIEN_ERROR_INDEX if a point lacks its deformer or mesh, MIEN_ERROR_INVALID_ARGUMENT if `from`
   * has no effect on `to` or nothing was linearized.
   */
  mien_derivatives_reverse(derivatives: number, from: number, to: number, mesh: number, count: number, gradients: number, outputs: number): number;
  /**
   * Creates a matrix for derivatives that have the rig and the deformer of `derivatives`, linearized or not.
   * `derivatives` may be destroyed afterwards. The matrix takes one block of memory: 8 bytes per entry, 4 per
   * row, 20 per column. More is needed until the call returns: 4 bytes per row, 12 per column, and 8 for each
   * number on the way (controls, joint values, matrices, results of networks, positions of the mesh).
   * Destroy with mien_jacobian_destroy().
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if from_point has no effect on to_point or the outputs do not
   * ascend, MIEN_ERROR_INDEX if a point lacks its deformer or mesh, or an input or output does not exist,
   * MIEN_ERROR_LOD if the rig has no such LOD.
   */
  mien_jacobian_create(derivatives: number, desc: number, out_jacobian: number, error: number): number;
  /** Destroys a matrix. NULL is allowed. */
  mien_jacobian_destroy(jacobian: number): void;
  /**
   * Returns the entries. They are the same in all poses, so a solver can order and factor the matrix
   * symbolically once. The views are valid until the matrix is destroyed.
   */
  mien_jacobian_pattern(jacobian: number, out_pattern: number): number;
  /**
   * Computes the entries of a matrix at the values that were linearized: `values` gets a float per entry of
   * the pattern, of which some may be 0. Each is equal to what mien_derivatives_forward() computes for a
   * direction that is 1 at the number of its column, else 0. `wanted` may be NULL: all columns; otherwise it
   * has a byte per column, and entries of columns with a 0 are not computed and keep their values. Threads may
   * use one matrix at the same time, each with derivatives of its own. Does not allocate or lock.
   * Fails with MIEN_ERROR_MISMATCH if the matrix was created for another rig or deformer, or the values were
   * linearized at another LOD, MIEN_ERROR_INVALID_ARGUMENT if nothing was linearized, `value_count` is not
   * the number of entries, or `wanted_count` not that of columns (0 if `wanted` is NULL).
   */
  mien_derivatives_jacobian(derivatives: number, jacobian: number, wanted: number, wanted_count: number, values: number, value_count: number): number;
  /**
   * Writes a baked file to memory and returns its size in `out_size`. `deformer` may be NULL. `buffer`
   * may be NULL with capacity 0 to get the size only. Writes nothing if `capacity` is too small;
   * `out_size` is set nevertheless.
   * Fails with MIEN_ERROR_MISMATCH if `deformer` was created for another rig,
   * MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small.
   */
  mien_bake_memory(rig: number, deformer: number, buffer: number, capacity: number, out_size: number, error: number): number;
  /**
   * Opens a baked file in memory: `size` bytes. `bytes` must outlive the MienBaked and all objects made
   * from it, unchanged, unless they are copied: with MIEN_FILE_READ, or if `bytes` is not aligned to
   * 64.
   * Fails like mien_baked_open_file(), but not with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ.
   */
  mien_baked_open_memory(bytes: number, size: number, desc: number, out_baked: number, error: number): number;
  /**
   * Opens a baked file through a stream, which is read at once into memory of the allocator.
   * Fails like mien_baked_open_file(), but not with MIEN_ERROR_FILE_OPEN.
   */
  mien_baked_open_stream(stream: number, desc: number, out_baked: number, error: number): number;
  /**
   * Closes a baked file. Objects made from it stay valid; its memory is released and the file unmapped
   * with the last of them.
   */
  mien_baked_close(baked: number): void;
  /** Returns the properties of an open baked file. */
  mien_baked_info(baked: number, out_info: number): number;
  /**
   * Creates the rig of a baked file, with one allocation, or two with MIEN_REUSE_SUMS. `baked` may be closed afterwards. Destroy with
   * mien_rig_destroy().
   * Fails with MIEN_ERROR_BAKED_PART if the file has no rig, MIEN_ERROR_BAKED_VERSION or
   * MIEN_ERROR_BAKED_STRUCTURE if its rig cannot be used, MIEN_ERROR_ISA if the requested instruction set
   * is not available.
   */
  mien_rig_from_baked(baked: number, desc: number, out_rig: number, error: number): number;
  /**
   * Creates the deformer of a baked file, with one allocation. `rig` is the one created from the same
   * MienBaked. `baked` may be closed and `rig` may be destroyed afterwards. Destroy with
   * mien_deformer_destroy().
   * Fails with MIEN_ERROR_MISMATCH if `rig` was not created from `baked`, MIEN_ERROR_BAKED_PART if the
   * file has no deformer, MIEN_ERROR_BAKED_VERSION or MIEN_ERROR_BAKED_STRUCTURE if its deformer cannot be
   * used, MIEN_ERROR_ISA if the requested instruction set is not available.
   */
  mien_deformer_from_baked(baked: number, rig: number, desc: number, out_deformer: number, error: number): number;
  /**
   * Builds a clip in memory. `desc` is required. The same values give the same bytes on every machine.
   * Close with mien_clip_close().
   * Fails with MIEN_ERROR_CLIP_VALUE if a value is not finite (the message names frame and channel),
   * MIEN_ERROR_NAME if a name is empty or occurs twice, MIEN_ERROR_CLIP_LIMIT if there are too many
   * frames, channels or bytes.
   */
  mien_clip_build(desc: number, out_clip: number, error: number): number;
  /**
   * Opens a clip in memory, at any alignment. `bytes` must outlive the clip and its players, unchanged.
   * Fails like mien_clip_open_file(), but not with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ.
   */
  mien_clip_open_memory(bytes: number, size: number, desc: number, out_clip: number, error: number): number;
  /**
   * Opens a clip through a stream, which is read completely into memory of the allocator.
   * Fails like mien_clip_open_file(), but not with MIEN_ERROR_FILE_OPEN.
   */
  mien_clip_open_stream(stream: number, desc: number, out_clip: number, error: number): number;
  /**
   * Closes a clip. Players stay valid; memory is released and the file unmapped with the last of them.
   */
  mien_clip_close(clip: number): void;
  /**
   * Writes a clip to memory and returns its size in `out_size`. `buffer` may be NULL with capacity 0 to
   * get the size only. Writes nothing if `capacity` is too small; `out_size` is set nevertheless.
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small.
   */
  mien_clip_write_memory(clip: number, buffer: number, capacity: number, out_size: number, error: number): number;
  /** Returns the properties of a clip. */
  mien_clip_info(clip: number, out_info: number): number;
  /**
   * Returns a channel. Channels keep the order in which the clip was built. The name is a view into the
   * clip.
   * Fails with MIEN_ERROR_INDEX if `index` is out of range.
   */
  mien_clip_channel(clip: number, index: number, out_channel: number): number;
  /**
   * Returns the index of the channel with this name. Searches all channels.
   * Fails with MIEN_ERROR_NAME if there is none.
   */
  mien_clip_find_channel(clip: number, name: number, out_index: number): number;
  /**
   * Returns the index of the channel with this name. Searches all channels.
   * Fails with MIEN_ERROR_NAME if there is none.
   */
  mien_clip_find_channel_n(clip: number, name: number, name_count: number, out_index: number): number;
  /**
   * Returns an event. Events are sorted by tick; those at the same tick keep the order in which they were
   * given. The name is a view into the clip.
   * Fails with MIEN_ERROR_INDEX if `index` is out of range.
   */
  mien_clip_event(clip: number, index: number, out_event: number): number;
  /**
   * Checks that no byte of a clip has changed since it was written and that all curves can be decoded.
   * Reads the whole clip. Uses up to 48 KiB of stack.
   * Fails with MIEN_ERROR_CLIP_CHECKSUM if bytes have changed, MIEN_ERROR_CLIP_STRUCTURE if a curve cannot
   * be decoded.
   */
  mien_clip_verify(clip: number, error: number): number;
  /**
   * Copies `frame_count` frames, starting at `first_frame`: channel c of frame first_frame + n goes to
   * out_values[n * frame_stride + c]. frame_stride is at least the number of channels; 0 means that
   * number. Each call decodes from the start of a block of 64 frames, so reading many frames in one
   * call costs less than reading them one by one. Uses up to 48 KiB of stack.
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if frame_stride is too small, MIEN_ERROR_INDEX if the
   * clip has fewer frames, MIEN_ERROR_CLIP_STRUCTURE if a curve is damaged; its block in `out_values` is
   * zero.
   */
  mien_clip_read(clip: number, first_frame: number, frame_count: number, out_values: number, frame_stride: number, error: number): number;
  /**
   * Creates a player, with one allocation. `clip` may be closed before the player is destroyed. Destroy with
   * mien_clip_player_destroy().
   */
  mien_clip_player_create(clip: number, desc: number, out_clip_player: number, error: number): number;
  /** Destroys a player. */
  mien_clip_player_destroy(clip_player: number): void;
  /** Returns the state of a player. */
  mien_clip_player_info(clip_player: number, out_info: number): number;
  /**
   * Moves to a tick: modulo the length with MIEN_LOOPING_WRAP, otherwise clamped to the range. Reports no
   * events; the next mien_clip_player_advance() also reports events at this tick, as it does after
   * creation. Does not allocate or lock.
   */
  mien_clip_player_seek(clip_player: number, tick: bigint): number;
  /**
   * Sets the speed for later calls of mien_clip_player_advance(). Does not allocate or lock.
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if it is outside the range of MienClipPlayerDesc.
   */
  mien_clip_player_set_speed(clip_player: number, numerator: number, denominator: number): number;
  /**
   * Moves by `ticks` times the speed. `ticks` is -2^40 to 2^40 (26 minutes). Fractions of ticks are kept,
   * so the position does not depend on the step size. Does not allocate or lock.
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if `ticks` is out of range.
   */
  mien_clip_player_advance(clip_player: number, ticks: bigint): number;
  /**
   * Returns the next event that the last mien_clip_player_advance() passed. `out_found` is 1, or 0 after
   * the last event. An event is passed when the position reaches or crosses its tick in either
   * direction, once per loop. The name is a view into the clip. Does not allocate or lock.
   */
  mien_clip_player_next_event(clip_player: number, out_event: number, out_found: number): number;
  /**
   * Returns the values at the current position: one float per channel. Exactly at a frame they are
   * bit-identical to those of the clip. Decodes the frames since the last call, or at most 64 after a jump;
   * without MienClipPlayerDesc.reverse, each step backward is a jump. Does not allocate or lock.
   * Contents change with mien_clip_player_sample().
   */
  mien_clip_player_sample(clip_player: number, out_values: number): number;
  /**
   * Binds a clip to a rig by names. A channel drives the raw control with its name. If there is none, it
   * drives the GUI control with its name, which is then mapped as by mien_rig_map_gui_to_raw(). If there is
   * none either, it drives the controls of its entries in the matrix, which are summed in the order of the
   * matrix. Names match without regard to case; `.` matches `_`; the prefix `CTRL_expressions.` may be
   * missing. If several names match, only an exact match counts. A channel that drives nothing so far drives
   * the controls that mien_rig_match() finds for its name, such as mouthSmile_L for mouthSmileLeft; these are
   * summed after those of the matrix. A raw control that a channel drives by name is driven by nothing else,
   * and one that the matrix or mien_rig_match() drives is not driven by GUI controls. Names without a match
   * are not an error: see mien_clip_binding_info(). `clip` may be closed and `rig` may be destroyed
   * afterwards. Destroy with mien_clip_binding_destroy().
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if a weight is not finite, MIEN_ERROR_CLIP_LIMIT if channels
   * drive more than 4095 GUI controls.
   */
  mien_clip_binding_create(clip: number, rig: number, desc: number, out_clip_binding: number, error: number): number;
  /**
   * Returns a matrix that binds clips with the 52 ARKit expression names, such as those of the Live Link
   * Face app, to rigs with the other common naming of raw controls (eyeBlinkL for eyeBlinkLeft). It suits
   * every rig: channels whose names the rig has do not use the matrix, and entries for missing controls are
   * skipped. docs/face-capture.md, 3 "ARKit expressions on raw controls" explains the entries. Writes as
   * many entries as fit; `out_count` is the total number. Names are static. `out_entries` may be NULL if
   * `capacity` is 0.
   */
  mien_arkit_matrix(out_entries: number, capacity: number, out_count: number): number;
  /** Destroys a binding. */
  mien_clip_binding_destroy(clip_binding: number): void;
  /** Returns what a binding found. */
  mien_clip_binding_info(clip_binding: number, out_info: number): number;
  /**
   * Computes the raw controls that are driven and leaves the others unchanged. `values` has one float
   * per channel, as mien_clip_player_sample() returns them; `raw_controls` has one float per raw control,
   * as mien_instance_raw_controls() returns them. Values that drive raw controls by name are
   * copied exactly; GUI controls give the same bits as mien_rig_map_gui_to_raw(). Does not allocate or
   * lock. Uses up to 16 KiB of stack.
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if a count differs from that of the clip or the rig.
   */
  mien_clip_binding_apply(clip_binding: number, values: number, value_count: number, raw_controls: number, raw_control_count: number): number;
  /**
   * Finds for each channel of a clip the coarsest rounding step with no visible effect, for
   * MienClipDesc.snaps: the largest of 2^-9 to 2^-16 of which half moves no vertex of LOD 0 by more than
   * `tolerance`, in millimeters, such as 0.02. If LOD 0 has no meshes, joints are measured instead. Each
   * channel is tried at five values from 0 to 1, and from -1 on if GUI controls are driven, with all other
   * channels at 0. Channels that drive nothing get 2^-11; channels for which even the finest step is too
   * coarse get 0. To use the steps, build a clip with all bits, bind it, then build it again with them.
   * Evaluates and deforms the rig at least 10 times per channel, and takes memory from its allocator during
   * the call.
   * Fails with MIEN_ERROR_MEMORY if that returns NULL, MIEN_ERROR_MISMATCH if `channel_count` is not that of
   * the binding, or the binding is for another rig, MIEN_ERROR_INVALID_ARGUMENT if `tolerance` is not a
   * number above 0.
   */
  mien_clip_binding_snaps(clip_binding: number, deformer: number, tolerance: number, out_snaps: number, channel_count: number, error: number): number;
  /**
   * Creates a mix for a rig. `desc` is required. `rig` may be destroyed afterwards, and so may the
   * deformer. Measuring guards takes time: it evaluates and deforms the rig at LOD 0 for each raw control
   * and for pairs of raw controls that share a corrective. Destroy with mien_mix_destroy().
   * Fails with MIEN_ERROR_MISMATCH if the deformer or the gaze is for another rig, MIEN_ERROR_INDEX if a
   * landmark names a mesh, position or joint that does not exist, MIEN_ERROR_INVALID_ARGUMENT if a field
   * of `desc` is out of range; the message names it, MIEN_ERROR_DNA_LIMIT if guards are measured and raw
   * controls times joints exceed 2^22.
   */
  mien_mix_create(rig: number, desc: number, out_mix: number, error: number): number;
  /**
   * Opens a mix in memory. `bytes` may be released afterwards. `rig` may be NULL. `rig` may be destroyed
   * afterwards.
   * Fails like mien_mix_open_file(), but not with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ.
   */
  mien_mix_open_memory(bytes: number, size: number, rig: number, desc: number, out_mix: number, error: number): number;
  /**
   * Writes a mix to memory and returns its size in `out_size`. `buffer` may be NULL with capacity 0 to get
   * the size only. Writes nothing if `capacity` is too small; `out_size` is set nevertheless.
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small, MIEN_ERROR_MEMORY and MIEN_ERROR_NAME
   * if mien_mix_write_file() would fail with them.
   */
  mien_mix_write_memory(mix: number, buffer: number, capacity: number, out_size: number, error: number): number;
  /**
   * Writes a mix as text, for reading and for version control: one line for each number, with its path in
   * the mix and the names of controls. Floats have nine digits, enough to restore their bits. The text
   * cannot be opened as a mix, and is not null-terminated. `buffer` may be NULL with capacity 0 to get the
   * size only.
   * Fails like mien_mix_write_memory().
   */
  mien_mix_write_text(mix: number, buffer: number, capacity: number, out_size: number, error: number): number;
  /**
   * Destroys a mix. Its mixers stay valid; its memory is released with the last of them.
   */
  mien_mix_destroy(mix: number): void;
  /** Returns the properties of a mix. */
  mien_mix_info(mix: number, out_info: number): number;
  /**
   * Returns the measured function of a guard. `guard_index` counts as in mien_mixer_set_guard(), from 0 to
   * MienMixInfo.guard_count - 1; mien_mixer_guard() has its name.
   * Fails with MIEN_ERROR_INDEX if there is no such guard.
   */
  mien_mix_guard(mix: number, guard_index: number, out_guard: number): number;
  /**
   * Returns a ready-made reaction to a light in the eyes, with 5 strokes. The caller provides its poses, from
   * `first_pose` on: lids closed; squint and lowered brows; gaze turned away; narrow pupils; head turned
   * away. docs/mixing.md, 3 "Reactions" lists the times. `out_reaction` refers to `out_strokes`.
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if `stroke_count` is less than 5.
   */
  mien_mix_glare(first_pose: number, out_strokes: number, stroke_count: number, out_reaction: number): number;
  /**
   * Finds antagonists: pairs of raw controls that only the two halves of one GUI control drive. Writes as
   * many as fit, with stiffness 1; `out_count` is the total number. `out_pairs` may be NULL if `capacity` is
   * 0. Raw controls from 4096 on, which no mix has, are left out.
   */
  mien_mix_antagonists(rig: number, out_pairs: number, capacity: number, out_count: number): number;
  /**
   * Finds the counterparts of raw controls in the other half of the face, for MienMixDesc.mirror. Controls
   * are counterparts if their names differ only in Left and Right (or L and R) and their motions agree, or
   * else if their motions are mirror images. Other controls, and curves beyond the raw controls, map to
   * themselves. Evaluates the rig once for each raw control, and takes memory from its allocator during
   * the call.
   * Fails with MIEN_ERROR_MEMORY if that returns NULL, MIEN_ERROR_MISMATCH if `curve_count` is less than the
   * raw controls, MIEN_ERROR_DNA_LIMIT if raw controls times joints exceed 2^22.
   */
  mien_mix_mirror(deformer: number, out_curves: number, curve_count: number, error: number): number;
  /**
   * Computes a mask that selects joint groups: for each raw control the share of its joint motion, at
   * value 1 and LOD 0, that belongs to these groups. A millimeter counts as much as a degree. Controls
   * that move no joint, and curves beyond the raw controls, get `otherwise_weight`. Evaluates the rig once
   * for each raw control and group, and takes memory from its allocator during the call.
   * Fails with MIEN_ERROR_MEMORY if that returns NULL, MIEN_ERROR_INDEX if a group does not exist,
   * MIEN_ERROR_MISMATCH if `curve_count` is less than the raw controls.
   */
  mien_mix_mask(rig: number, groups: number, group_count: number, otherwise_weight: number, out_mask: number, curve_count: number, error: number): number;
  /**
   * Creates a gaze by measuring how raw controls turn the eyes, which evaluates the rig at least twice per
   * raw control. `deformer` may be destroyed afterwards. Destroy with mien_gaze_destroy().
   * Fails with MIEN_ERROR_NAME if there are no such joints, MIEN_ERROR_INVALID_ARGUMENT if no raw
   * control turns an eye monotonically in one of the four directions.
   */
  mien_gaze_create(deformer: number, desc: number, out_gaze: number, error: number): number;
  /** Destroys a gaze. */
  mien_gaze_destroy(gaze: number): void;
  /** Returns where the eyes are, so that a target can be placed in front of them. */
  mien_gaze_info(gaze: number, out_info: number): number;
  /**
   * Sets the raw controls of a row so that both eyes look at a target. Eyes converge on near targets.
   * `out_rest` may be NULL. Does not allocate or lock.
   * Fails with MIEN_ERROR_MISMATCH if `row_count` is less than the raw controls, MIEN_ERROR_INVALID_ARGUMENT
   * if the target is not finite.
   */
  mien_gaze_look_at(gaze: number, target: number, row: number, row_count: number, out_rest: number): number;
  /**
   * Creates a mixer at time 0, with one allocation. No clip plays; pose weights and pose variables are 0.
   * `mix` may be destroyed before it. Destroy with mien_mixer_destroy().
   */
  mien_mixer_create(mix: number, desc: number, out_mixer: number, error: number): number;
  /** Destroys a mixer. */
  mien_mixer_destroy(mixer: number): void;
  /**
   * Plays a clip in a layer, from the next step on. `clip` and `clip_binding` must outlive their playback,
   * including the transition to the next clip. On failure the layer continues as before. Does not allocate or
   * lock.
   * Fails with MIEN_ERROR_INDEX if the layer does not exist or has another source, MIEN_ERROR_MISMATCH if
   * the binding is for another clip or rig, MIEN_ERROR_INVALID_ARGUMENT if a time, speed or enum value is
   * out of range or a delta clip would play in a layer that overrides, MIEN_ERROR_CLIP_LIMIT if the clip is
   * larger than the mix allows.
   */
  mien_mixer_play(mixer: number, layer: number, clip: number, clip_binding: number, desc: number, error: number): number;
  /**
   * Fades out the clip of a layer and stops it. Fades take 0 to 2^40 ticks, here and below; they start from
   * the current value and speed, and end with speed 0. Does not allocate or lock.
   * Fails with MIEN_ERROR_INDEX if the layer does not exist or is not a clip layer.
   */
  mien_mixer_stop(mixer: number, layer: number, fade_ticks: bigint): number;
  /**
   * Fades the weight of a layer to `weight`, which has the range of MienMixLayer.weight. Does not allocate or
   * lock.
   * Fails with MIEN_ERROR_INDEX if the layer does not exist.
   */
  mien_mixer_set_weight(mixer: number, layer: number, weight: number, fade_ticks: bigint): number;
  /**
   * Fades the weight of a pose to `weight`, 0 to 1. `pose` counts from the first pose of the layer. Weights
   * of a layer that add up to more than 1 are divided by their sum. Does not allocate or lock.
   * Fails with MIEN_ERROR_INDEX if the layer or its pose does not exist.
   */
  mien_mixer_set_pose_weight(mixer: number, layer: number, pose: number, weight: number, fade_ticks: bigint): number;
  /**
   * Sets the `value` that a pose variable has at the start of each step, before the layers. Does not
   * allocate or lock.
   * Fails with MIEN_ERROR_INDEX if it does not exist, MIEN_ERROR_INVALID_ARGUMENT if the value is not
   * finite.
   */
  mien_mixer_set_variable(mixer: number, variable: number, value: number): number;
  /**
   * Sets how much a guard acts: `activation` is 0 to 1, or negative for automatic, the default: the smaller
   * the gap that base and speech leave, the more the guard acts; guards of lips and teeth act at most as
   * much as the largest weight of a speech layer. mien_mixer_guard() returns the name for a `guard_index`.
   * Does not allocate or lock.
   * Fails with MIEN_ERROR_INDEX if the guard does not exist, MIEN_ERROR_INVALID_ARGUMENT if `activation` is
   * above 1 or not a number.
   */
  mien_mixer_set_guard(mixer: number, guard_index: number, activation: number): number;
  /**
   * Returns what a guard did in the last step. `guard_index` counts as in mien_mixer_set_guard(). Views point
   * into the mix.
   * Fails with MIEN_ERROR_INDEX if the guard does not exist.
   */
  mien_mixer_guard(mixer: number, guard_index: number, out_state: number): number;
  /**
   * Starts a reaction to a stimulus of `strength`, 0 to 1, that lasts for `hold_ticks`, at most 2^40; if
   * negative, until mien_mixer_release(). Does not allocate or lock.
   * Fails with MIEN_ERROR_INDEX if the reaction does not exist, MIEN_ERROR_INVALID_ARGUMENT if strength or
   * time is out of range.
   */
  mien_mixer_trigger(mixer: number, reaction: number, strength: number, hold_ticks: bigint): number;
  /**
   * Ends the stimulus of a reaction. Does not allocate or lock.
   * Fails with MIEN_ERROR_INDEX if the reaction does not exist.
   */
  mien_mixer_release(mixer: number, reaction: number): number;
  /**
   * Sets the level of what a reaction responds to, such as a brightness, 0 to 1. Call it whenever the level
   * changes. A level of MienMixReaction.level_on or more is a stimulus of strength 1, which ends once the
   * level has been below level_off for 50 ms, so a flickering light counts as on. During the stimulus, scaled
   * strokes follow the level without overshoot; 90 % of a change takes 0.25 s. Does not allocate or lock.
   * Fails with MIEN_ERROR_INDEX if the reaction does not exist, MIEN_ERROR_INVALID_ARGUMENT if it has no
   * level_on or `level` is out of range.
   */
  mien_mixer_set_level(mixer: number, reaction: number, level: number): number;
  /**
   * Queues a row for a stream layer: one value per channel, for time `tick` of the mixer. One thread may call
   * this while another one uses the mixer. `out_accepted` may be NULL; it is set to 0 if the row is dropped
   * because it is not newer than the last one or the queue is full. Does not allocate or lock.
   * Fails with MIEN_ERROR_INDEX if the layer does not exist or is not a stream, MIEN_ERROR_MISMATCH if it has
   * another number of channels, MIEN_ERROR_INVALID_ARGUMENT if a value is not finite or `tick` is 2^61 or
   * more.
   */
  mien_mixer_push(mixer: number, layer: number, tick: bigint, values: number, value_count: number, out_accepted: number): number;
  /**
   * Advances the time by `ticks`, 0 to 2^40, and mixes. Writes the raw controls to `instance`, which may
   * be NULL. Does not allocate or lock.
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if `ticks` is out of range or the time would exceed 2^60 ticks
   * (51 years), MIEN_ERROR_MISMATCH if the instance has another number of raw controls.
   */
  mien_mixer_step(mixer: number, ticks: bigint, instance: number): number;
  /**
   * Steps `count` mixers; instances[i] belongs to mixers[i]. `instances` may be NULL. The results are those
   * of single calls. On failure no mixer is advanced.
   * Fails like mien_mixer_step(), and with MIEN_ERROR_INVALID_ARGUMENT if a mixer is listed twice.
   */
  mien_mixer_step_batch(mixers: number, instances: number, count: number, ticks: bigint): number;
  /**
   * Returns the row of the last step, one float per curve: raw controls, then pose variables.
   * Contents change with mien_mixer_step() and mien_mixer_step_batch().
   */
  mien_mixer_row(mixer: number, out_row: number): number;
  /**
   * Returns the row after a stage of the last step, one float per curve. Stages are numbered: the layers,
   * then reactions, guards, antagonists, limits. Layers that act after the reactions or the guards keep
   * their numbers.
   * Fails with MIEN_ERROR_INDEX if the stage does not exist, MIEN_ERROR_INVALID_ARGUMENT if
   * MienMixerDesc.stages was 0.
   * Contents change with mien_mixer_step() and mien_mixer_step_batch().
   */
  mien_mixer_stage(mixer: number, stage: number, out_row: number): number;
  /** Returns the state of a mixer. */
  mien_mixer_info(mixer: number, out_info: number): number;
  /**
   * Returns an event of the last step and its layer. The tick is in the time of the clip, and the name is a
   * view into the clip.
   * Fails with MIEN_ERROR_INDEX if `index` is out of range.
   */
  mien_mixer_event(mixer: number, index: number, out_event: number, out_layer: number): number;
  /**
   * Writes the state of a mixer to memory: everything that later steps depend on, except queued stream rows.
   * Returns its size in `out_size`. `buffer` may be NULL with capacity 0 to get the size only. Snapshots
   * can be restored on 64-bit machines of the same byte order. Does not allocate or lock.
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small.
   */
  mien_mixer_snapshot(mixer: number, buffer: number, capacity: number, out_size: number, error: number): number;
  /**
   * Restores a snapshot of a mixer of the same mix; later steps give the same bits. Queued stream rows are
   * not part of it. `clips` lists the clips that may have been playing. The bytes are validated, so they
   * need not be trusted. On failure the mixer does not change. Does not allocate or lock.
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if the bytes are not a snapshot of this mix,
   * MIEN_ERROR_MISMATCH if a clip is missing or is not the one that was playing.
   */
  mien_mixer_restore(mixer: number, bytes: number, size: number, clips: number, clip_count: number, error: number): number;
  /**
   * Creates a solver stack. `desc` is required. `deformer` may be destroyed before it. Destroy with
   * mien_solver_stack_destroy().
   * Fails with MIEN_ERROR_INDEX if a joint or curve does not exist, MIEN_ERROR_INVALID_ARGUMENT if a number
   * is out of range, or if a solver reads a joint that a later one moves; the message names both.
   */
  mien_solver_stack_create(deformer: number, desc: number, out_solver_stack: number, error: number): number;
  /**
   * Destroys a solver stack. Its states stay valid; its memory is released with the last of them.
   */
  mien_solver_stack_destroy(solver_stack: number): void;
  /** Returns the properties of a solver stack. */
  mien_solver_stack_info(solver_stack: number, out_info: number): number;
  /**
   * Creates a solver state. `solver_stack` may be destroyed before it. Destroy with
   * mien_solver_state_destroy().
   */
  mien_solver_state_create(solver_stack: number, desc: number, out_solver_state: number, error: number): number;
  /** Destroys a solver state. */
  mien_solver_state_destroy(solver_state: number): void;
  /**
   * Runs the solvers on the pose of `deformer_instance`. Call mien_deformer_instance_update() before every
   * step. `input` may be NULL: no row, LOD 0. `ticks`, the time since the last step, is 0 to
   * 2^40. Does not allocate or lock.
   * Fails with MIEN_ERROR_MISMATCH if instance and stack have different deformers or the row is
   * shorter than MienSolverStackDesc.curve_count, MIEN_ERROR_INVALID_ARGUMENT if `ticks` or the LOD is out of
   * range.
   */
  mien_solver_state_step(solver_state: number, deformer_instance: number, input: number, ticks: bigint): number;
  /**
   * Steps `count` states of one stack; deformer_instances[i] and inputs[i] belong to solver_states[i].
   * `inputs` may be NULL. The results are those of single calls. No state or instance may occur twice. On
   * failure nothing changes. Does not allocate or lock. Uses up to 8 KiB of stack.
   * Fails like mien_solver_state_step(), and with MIEN_ERROR_MISMATCH if the states have different
   * stacks.
   */
  mien_solver_state_step_batch(solver_states: number, deformer_instances: number, inputs: number, count: number, ticks: bigint): number;
  /**
   * Returns the outputs of a solver in the last step, one float per output. `solver` is its index in the
   * stack.
   * Contents change with mien_solver_state_step(), mien_solver_state_step_batch().
   * Fails with MIEN_ERROR_INDEX if the solver does not exist.
   */
  mien_solver_state_outputs(solver_state: number, solver: number, out_values: number): number;
  /**
   * Returns the joint transforms after the last step, relative to the parents: 10 floats per joint, tx ty tz
   * qx qy qz qw sx sy sz. (mien_deformer_instance_local_transforms() returns those before the step.)
   * Contents change with mien_solver_state_step(), mien_solver_state_step_batch().
   */
  mien_solver_state_transforms(solver_state: number, out_transforms: number): number;
  /**
   * Returns the name of a solver that changed a joint not in its `writes` in the last step, or an empty
   * string. Contents change with mien_solver_state_step(), mien_solver_state_step_batch().
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if MienSolverStackDesc.check_writes was 0.
   */
  mien_solver_state_undeclared(solver_state: number, out_name: number): number;
  /**
   * Finds the raw controls that a name stands for on a rig. Takes time proportional to the number of raw
   * controls: meant for loading, not for every frame. Does not allocate or lock. Writes as many shares as
   * fit; `out_count` is the total number, at most MIEN_MOST_SHARES, each of a different control. `out_shares`
   * may be NULL if `capacity` is 0. `out_match` is one of MIEN_NAME_MATCH_....
   * Fails with MIEN_ERROR_NAME if the name matches no control of this rig, or several in step 1 or 2.
   * See docs/face-capture.md, 2 "Names".
   */
  mien_rig_match(rig: number, name: number, name_count: number, out_shares: number, capacity: number, out_count: number, out_match: number): number;
  /**
   * Returns the usual name of a control: that of ARKit, such as mouthSmileLeft for AU12_L and
   * mouthCornerPullL, or that of MetaHuman's raw controls if ARKit has none. A name without a side gets none:
   * mouthSmile. Writes as many bytes as fit, without a null; `out_count` is the total number. `out_name` may
   * be NULL if `capacity` is 0.
   * Fails with MIEN_ERROR_NAME if the name is not in the table.
   * See docs/face-capture.md, 2 "Names".
   */
  mien_control_name(name: number, name_count: number, out_name: number, capacity: number, out_count: number): number;
  /**
   * Generates a rig and opens it: a file of version 2.8, unless the preset states another one, with all layers
   * of its version, behavior of realistic size and sparsity, and simple geometry. Close with
   * mien_dna_close().
   */
  mien_dna_generate(desc: number, out_dna: number, error: number): number;
  /**
   * Creates a rig from a mesh, with or without expressions, and opens it as a file of version 2.8: joints,
   * skin weights for every LOD, and a raw control for each expression. The file has the axes of the mesh, in
   * centimeters; positions keep their order, but positions that belong to no face are dropped. The same mesh,
   * options and seed give the same bytes on any number of threads. `mesh` is required;
   * `out_report` may be NULL. Close with mien_dna_close() and mien_author_report_close().
   * The report has the confidence of each landmark; a mesh is not refused because it is low.
   * Fails with MIEN_ERROR_AUTHOR_MESH if the arrays of the mesh or of the caller's results contradict
   * each other, MIEN_ERROR_AUTHOR_REFUSED if the mesh cannot be rigged or landmarks contradict it,
   * MIEN_ERROR_AUTHOR_CANCELED if `progress` canceled, MIEN_ERROR_DNA_LIMIT if the file would be too large.
   * See docs/authoring.md, 1 "What goes in and what comes out".
   */
  mien_author_rig(mesh: number, desc: number, out_dna: number, out_report: number, error: number): number;
  /** Closes a report. */
  mien_author_report_close(author_report: number): void;
  /**
   * Returns the report as JSON: bones, mask, groups, errors of the fit, and more. Lengths are in
   * centimeters.
   * See docs/authoring.md, 6 "The report".
   */
  mien_author_report_json(author_report: number, out_json: number): number;
  /**
   * Makes a document of an open file, as it was loaded: layers and LODs that were left out are not in it.
   * `dna` may be NULL, for an empty document of version 2.8 with all layers. `dna` may be closed
   * afterwards. Destroy with mien_document_destroy().
   * Fails with MIEN_ERROR_DNA_LAYER if `dna` has RBF behavior without the machine-learned behavior of its
   * file, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE or MIEN_ERROR_DNA_VALUE if the loaded part would
   * not open by itself, MIEN_ERROR_DNA_LIMIT if it exceeds 4 GiB.
   */
  mien_document_create(dna: number, desc: number, out_document: number, error: number): number;
  /** Destroys a document. */
  mien_document_destroy(document: number): void;
  /**
   * Finds a field by its path, like mien_dna_field(). Its byte_offset is MIEN_NO_OFFSET.
   * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is past
   * the end.
   * See docs/dna-format.md, 6 "Layers, field by field".
   */
  mien_document_field(document: number, path: number, out_field: number, error: number): number;
  /**
   * Returns the name of field `index` of the record at a path, like mien_dna_child_name(). The string is
   * static.
   * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if `index` or an index in the
   * path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a record.
   */
  mien_document_child_name(document: number, path: number, index: number, out_name: number, error: number): number;
  /**
   * Copies `count` elements of a field, beginning with element `first`, to `out`, like
   * mien_dna_read_floats(). `out` may be NULL if `count` is 0.
   * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
   * the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
   * kind.
   */
  mien_document_read_floats(document: number, path: number, first: bigint, count: bigint, out: number, error: number): number;
  /**
   * Copies `count` elements of a field, beginning with element `first`, to `out`, like
   * mien_dna_read_floats(). `out` may be NULL if `count` is 0.
   * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
   * the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
   * kind.
   */
  mien_document_read_integers(document: number, path: number, first: bigint, count: bigint, out: number, error: number): number;
  /**
   * Returns a string. Contents change with mien_document_write_string(), mien_document_undo(): the view
   * is valid until the document is changed.
   * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is
   * past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a string.
   */
  mien_document_read_string(document: number, path: number, out_string: number, error: number): number;
  /**
   * Returns the bytes of an array of numbers or of a string in place: big-endian and unaligned, as in a file.
   * Contents change with mien_document_write_floats(), mien_document_write_integers(), mien_document_undo():
   * the view is valid until the document is changed.
   * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is
   * past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is neither an array nor a string.
   */
  mien_document_bytes(document: number, path: number, out_bytes: number, error: number): number;
  /**
   * Replaces `count` elements of an array, beginning with element `first`, or a single number. The first write
   * to an array after a mark or an operation copies it, later ones do not. `values` may be NULL if `count`
   * is 0.
   * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
   * the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
   * kind, or none of this size, MIEN_ERROR_MEMORY if the allocator returns NULL.
   */
  mien_document_write_floats(document: number, path: number, first: bigint, count: bigint, values: number, error: number): number;
  /**
   * Replaces `count` elements of an array, beginning with element `first`, or a single number. The first write
   * to an array after a mark or an operation copies it, later ones do not. `values` may be NULL if `count`
   * is 0.
   * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
   * the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
   * kind, or none of this size, MIEN_ERROR_MEMORY if the allocator returns NULL.
   */
  mien_document_write_integers(document: number, path: number, first: bigint, count: bigint, values: number, error: number): number;
  /**
   * Replaces a string by `string_count` bytes. `string` may be NULL if `string_count` is 0.
   * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is past
   * the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a string, or if another element of a list of
   * names has this name, MIEN_ERROR_MEMORY if the allocator returns NULL.
   */
  mien_document_write_string(document: number, path: number, string: number, string_count: number, error: number): number;
  /**
   * Replaces `removed_count` elements of an array or list, beginning with element `first`, by
   * `inserted_count` new ones: zeros, empty strings, or records of these. References to elements by number do
   * not change. Copies the array, or the list without its contents.
   * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
   * the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is neither an array nor a list, or
   * would have more than 2^32 - 1 elements, MIEN_ERROR_MEMORY if the allocator returns NULL.
   */
  mien_document_splice(document: number, path: number, first: bigint, removed_count: bigint, inserted_count: bigint, error: number): number;
  /**
   * Gives an array or list `count` elements: drops the last ones or adds new ones, like
   * mien_document_splice().
   * Fails like mien_document_splice().
   */
  mien_document_resize(document: number, path: number, count: bigint, error: number): number;
  /**
   * Returns the version of the file that the document becomes, 2.`out_version`, and the length of its list of
   * layers. A file also has the layers that its version defines and the list lacks, behind the others.
   */
  mien_document_layer_count(document: number, out_version: number, out_count: number, error: number): number;
  /**
   * Returns layer `index` of the list, as mien_dna_layer(); byte_offset is MIEN_NO_OFFSET. `out_bytes` gets the
   * contents of a layer of an unknown kind, else nothing. Contents change with mien_document_clear_layers(),
   * mien_document_undo(): the view is valid until the document is changed.
   * Fails with MIEN_ERROR_INDEX if `index` is past the end.
   */
  mien_document_layer(document: number, index: number, out_layer: number, out_bytes: number, error: number): number;
  /**
   * Makes the document a file of version 2.`version` and its list of layers empty: layers of unknown kinds
   * are gone, fields stay as they are. mien_document_add_layer() fills the list again.
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if `version` is not 1 to 65535, MIEN_ERROR_MEMORY if the allocator
   * returns NULL.
   */
  mien_document_clear_layers(document: number, version: number, error: number): number;
  /**
   * Appends a layer to the list: the layer of a known kind, without bytes, or `size` bytes of an
   * unknown kind, which are written to the file as they are. `code` has four characters, such as "bhvr"; the
   * layer is of version `version_major`.`version_minor`. `bytes` may be NULL if `size` is 0.
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if `code` has another length, a version is above 65535, the list has a
   * layer of this code and version already, the kind is known and has bytes, or a file of version 2.1 cannot
   * have it, MIEN_ERROR_MEMORY if the allocator returns NULL.
   */
  mien_document_add_layer(document: number, code: number, version_major: number, version_minor: number, bytes: number, size: number, error: number): number;
  /**
   * Remembers the current state, at the cost of some KB. Mark 0 always exists: the state in which the
   * document was created. Changes before a mark keep their memory until the document is destroyed or an
   * earlier mark is restored.
   * Fails with MIEN_ERROR_MEMORY if the allocator returns NULL.
   */
  mien_document_mark(document: number, out_mark: number, error: number): number;
  /**
   * Goes back to the state at a mark: `mark` is a number from mien_document_mark(), or 0. Later marks become
   * invalid, this one stays valid. Does not allocate or lock.
   * Fails with MIEN_ERROR_INDEX if `mark` is not a valid mark of the document.
   */
  mien_document_undo(document: number, mark: bigint, error: number): number;
  /**
   * Finds the index of a name; of equal names, the first. `kind` is a MIEN_KIND_...: GUI, raw, PSD ("psd0",
   * "psd1", ...), ML and RBF controls, joints, blend shape channels, animated maps, meshes.
   * Fails with MIEN_ERROR_NAME if there is no such name, MIEN_ERROR_INVALID_ARGUMENT if the kind has no names
   * in a document.
   */
  mien_document_find(document: number, kind: number, name: number, out_index: number, error: number): number;
  /**
   * Renames element `index` of a kind of mien_document_find() but PSD controls.
   * Fails with MIEN_ERROR_INDEX if there is no such element, MIEN_ERROR_INVALID_ARGUMENT if another element
   * of the kind has the name, or the kind has no names in a document, MIEN_ERROR_MEMORY if the allocator
   * returns NULL.
   */
  mien_document_rename(document: number, kind: number, index: number, name: number, error: number): number;
  /**
   * Removes controls, joints, blend shape channels, animated maps or meshes, and everything that
   * refers to them: names, LOD lists, rows of tables, targets, regions of networks. `indices` has
   * `index_count` elements; PSD, ML and RBF controls are numbered from 0.
   * Children of a joint go to its nearest ancestor that stays, or become roots, and keep their neutral place
   * in the world; motions that are relative to the parent keep their numbers. The joint's skin weights go to
   * the same ancestor, or to the first joint that stays. Quaternion joints move as before within 1e-2
   * degrees; where the columns of a joint group would rotate them in another order, each quaternion joint of
   * the group gets a joint group of its own.
   * A raw, PSD, ML or RBF control is removed as if it stayed 0: with it go its columns of joint groups, its rows
   * of channels and animated maps, PSD controls that are products of it, RBF solvers, twists and swings that
   * read it, its inputs of networks, and the outputs of networks and RBF poses that set it. Networks that ML
   * operations run cannot lose one: their controls are refused. Files before 2.5 cannot lose RBF controls.
   * Fails with MIEN_ERROR_INDEX if an index is past the end, MIEN_ERROR_INVALID_ARGUMENT if the
   * networks or the version need a control, or no joint would be left for the skin
   * weights, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE
   * if the document is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL.
   */
  mien_document_remove(document: number, kind: number, indices: number, index_count: number, error: number): number;
  /**
   * Removes all blend shape channels with their targets, all animated maps, or, for MIEN_KIND_JOINT,
   * everything that moves joints. `kind` is a MIEN_KIND_....
   * Fails like mien_document_remove(), but not with MIEN_ERROR_INDEX.
   */
  mien_document_clear(document: number, kind: number, error: number): number;
  /**
   * Removes everything that moves these joints: their rows of joint groups, twists, swings and ML joints.
   * Fails like mien_document_remove().
   */
  mien_document_clear_joints(document: number, joints: number, joint_count: number, error: number): number;
  /**
   * Sets neutral transforms of joints from `first_joint` on, relative to their parents, in the units and
   * axes of the file: translations, 3 floats per joint, and rotations, 3 floats per joint. Either may be
   * left out: `translations` may be NULL; `rotations` may be NULL.
   * Fails with MIEN_ERROR_INDEX if there are fewer joints, MIEN_ERROR_INVALID_ARGUMENT if a number is not
   * finite, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE
   * if the document is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL.
   */
  mien_document_set_neutral(document: number, first_joint: number, translations: number, rotations: number, count: number, error: number): number;
  /**
   * Sets all positions of a mesh, 3 floats per position. Normals do not change: deformers recompute them by
   * default; otherwise write geom.meshes[i].normals.
   * Fails with MIEN_ERROR_INDEX if `mesh` is past the end, MIEN_ERROR_INVALID_ARGUMENT if the mesh has another
   * number of positions, or a number is not finite, MIEN_ERROR_MEMORY if the allocator returns NULL.
   */
  mien_document_set_positions(document: number, mesh: number, positions: number, position_count: number, error: number): number;
  /**
   * Sets the target of blend shape channel `channel` on mesh `mesh`: 3 floats per delta, of the positions
   * `vertices`. `vertices` may be NULL for the first `count` positions. Deltas of zero are left out; if there
   * are no others, the target is removed. The pair of mesh and channel in defn.meshBlendShapeChannelMapping
   * is added or removed with it.
   * Fails with MIEN_ERROR_INDEX if `mesh`, `channel` or a vertex is past the end, MIEN_ERROR_INVALID_ARGUMENT
   * if there are more deltas than positions, or a number is not finite, MIEN_ERROR_DNA_STRUCTURE,
   * MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid,
   * MIEN_ERROR_MEMORY if the allocator returns NULL.
   */
  mien_document_set_target(document: number, mesh: number, channel: number, vertices: number, deltas: number, count: number, error: number): number;
  /**
   * Removes deltas not longer than `tolerance`, in the unit of the file, and targets that have none left.
   * `out_pruned` gets their numbers.
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if `tolerance` is negative or not finite, MIEN_ERROR_DNA_STRUCTURE,
   * MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid,
   * MIEN_ERROR_MEMORY if the allocator returns NULL.
   */
  mien_document_prune_targets(document: number, tolerance: number, out_pruned: number, error: number): number;
  /**
   * Sets small entries of the joint matrix to 0, and removes columns and rows of joint groups that have no
   * others. Measures how far that moves the positions of LOD 0, with each raw control at 1, and with all raw
   * controls of each corrective at 1. `desc` is required.
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if a field of `desc` is negative or not finite,
   * MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the
   * document is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL.
   */
  mien_document_prune_joints(document: number, desc: number, out_pruned: number, error: number): number;
  /**
   * Sets the skin weights of a mesh: `influences` joints and weights per position, row by row. Weights of 0
   * are left out. `joints` has `weight_count` elements, as many as `weights`.
   * Fails with MIEN_ERROR_INDEX if `mesh` is past the end, MIEN_ERROR_INVALID_ARGUMENT if there is another
   * number of weights, a weight is negative or not finite, a joint does not exist, or a position has a
   * joint twice or no weight, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or
   * MIEN_ERROR_DNA_VALUE if the document is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL.
   */
  mien_document_set_weights(document: number, mesh: number, influences: number, joints: number, weights: number, weight_count: number, error: number): number;
  /**
   * Scales the weights of each position of mesh `mesh` to a sum of 1; sums within 1e-6 of it stay as they are.
   * Fails with MIEN_ERROR_INDEX if `mesh` is past the end, MIEN_ERROR_DNA_STRUCTURE,
   * MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid,
   * MIEN_ERROR_MEMORY if the allocator returns NULL.
   */
  mien_document_normalize_weights(document: number, mesh: number, error: number): number;
  /**
   * Keeps the `influences` largest weights of each position of mesh `mesh`, in their order, scaled to the
   * previous sum.
   * Fails like mien_document_normalize_weights(), and with MIEN_ERROR_INVALID_ARGUMENT if `influences` is 0.
   */
  mien_document_limit_influences(document: number, mesh: number, influences: number, error: number): number;
  /**
   * Smooths the weights of mesh `mesh` `iterations` times: those of each position become (1 - strength) times
   * its own plus strength times the mean of its neighbors along edges. Positions at the same place count as
   * one. Each keeps at most `influences`, with a sum of 1.
   * Fails like mien_document_limit_influences(), and with MIEN_ERROR_INVALID_ARGUMENT if `strength` is not 0
   * to 1, or there are more than 1000 iterations.
   */
  mien_document_smooth_weights(document: number, mesh: number, iterations: number, strength: number, influences: number, error: number): number;
  /**
   * Scales, rotates and moves the whole character: neutral joints, positions, normals, targets, and the
   * translations that controls add to joints. `placement` is required.
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if a number is not finite or the scale is negative,
   * MIEN_ERROR_DNA_VALUE if a root joint is moved by controls and the rotation is not 0, networks translate
   * joints and the scale is not 1, or the document is not valid, MIEN_ERROR_DNA_STRUCTURE,
   * MIEN_ERROR_DNA_REFERENCE or MIEN_ERROR_DNA_LIMIT if the document is not valid, MIEN_ERROR_MEMORY if the
   * allocator returns NULL.
   */
  mien_document_place(document: number, placement: number, error: number): number;
  /**
   * Keeps the LODs whose bits are set in `lods`, like MienDnaDesc.lods.
   * Fails with MIEN_ERROR_LOD if none of them exists, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE,
   * MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid, MIEN_ERROR_MEMORY if the
   * allocator returns NULL.
   * See docs/dna-format.md, 10 "Choosing LODs".
   */
  mien_document_keep_lods(document: number, lods: bigint, error: number): number;
  /**
   * Converts to another coordinate system, like MienDnaDesc.system. `system` is required.
   * Fails with MIEN_ERROR_DNA_VALUE if the rig cannot be converted or the document is not valid,
   * MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE or MIEN_ERROR_DNA_LIMIT if the document is not valid,
   * MIEN_ERROR_MEMORY if the allocator returns NULL.
   * See docs/dna-format.md, 11 "Coordinate systems".
   */
  mien_document_convert(document: number, system: number, error: number): number;
  /**
   * Copies the layers of another document whose bits are set. `layers` is a MIEN_LAYER_..., combined with |.
   * Layers that refer to each other are copied together.
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if `layers` has other bits, MIEN_ERROR_DNA_STRUCTURE,
   * MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if they do not fit the other
   * layers, MIEN_ERROR_MEMORY if the allocator returns NULL.
   */
  mien_document_copy_layers(document: number, from: number, layers: number, error: number): number;
  /**
   * Copies mesh `mesh` of another document. It replaces the mesh of the same name, or becomes a new one, at
   * its LODs in the other document as far as this document has them. Joints and channels are found by name;
   * the influence of a missing joint goes to its nearest ancestor that exists here, and targets of missing
   * channels are left out.
   * Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_INVALID_ARGUMENT if both documents are
   * the same, MIEN_ERROR_MISMATCH if the documents differ in axes, units or rotations, or this one has no
   * joint of a position, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or
   * MIEN_ERROR_DNA_VALUE if one of them is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL.
   */
  mien_document_copy_mesh(document: number, from: number, mesh: number, out_mesh: number, error: number): number;
  /**
   * Adds the joints of another document whose names this one lacks, such as those of a body to a head: below
   * the joints with the names of their parents, numbered after the existing ones, at the LODs that list them
   * in the other document. Joints of both documents stay as they are, but a root that has a parent in the
   * other one becomes its child. They must have the same place in model space, within `tolerance` in the unit
   * of the file.
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if both documents are the same, MIEN_ERROR_MISMATCH if they differ
   * in axes, units or rotations, or in the place of a joint, MIEN_ERROR_DNA_STRUCTURE,
   * MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if one of them is not valid or the
   * result would not be, MIEN_ERROR_MEMORY if the allocator returns NULL.
   */
  mien_document_merge_joints(document: number, from: number, tolerance: number, error: number): number;
  /**
   * Removes the joints whose names another document lacks, like mien_document_remove().
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if no joint would be left for the skin weights,
   * MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if
   * `document` is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL.
   */
  mien_document_split_joints(document: number, from: number, error: number): number;
  /**
   * Gives mesh `mesh` the skin weights and targets of mesh `source`, interpolated at the point of `source`
   * nearest to each position: a coarser LOD from a finer one. The influence of joints that no LOD of the mesh
   * lists goes to the nearest ancestor that one of them lists; targets of channels that none lists are left
   * out. If these LODs list no joints or channels at all, all are kept. `out_farthest` gets the largest
   * distance to a nearest point, in the unit of the file or of the texture.
   * Fails with MIEN_ERROR_INDEX if `mesh` or `source` is past the end, MIEN_ERROR_INVALID_ARGUMENT if they are
   * the same, or lack triangles, texture coordinates or weights, MIEN_ERROR_DNA_STRUCTURE,
   * MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid,
   * MIEN_ERROR_MEMORY if the allocator returns NULL.
   */
  mien_document_project(document: number, mesh: number, source: number, desc: number, out_farthest: number, error: number): number;
  /**
   * The same for all meshes of LOD `lod`, each from the mesh of LOD `source_lod` whose name differs only in the
   * number of the LOD ("head_lod3_mesh" from "head_lod0_mesh"). A LOD that lists no joints or channels gets
   * those of `source_lod`.
   * Fails with MIEN_ERROR_LOD if there is no such LOD, MIEN_ERROR_NAME if a mesh has no counterpart,
   * MIEN_ERROR_INVALID_ARGUMENT if the LODs are the same, or meshes lack triangles, texture coordinates or
   * weights, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or
   * MIEN_ERROR_DNA_VALUE if the document is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL.
   */
  mien_document_make_lod(document: number, lod: number, source_lod: number, desc: number, out_farthest: number, error: number): number;
  /**
   * Gives mesh `mesh` new positions, 3 floats per position, such as a head that an artist reshaped, and lets
   * the rig follow: joints move with the surface around them and keep their orientation; targets rotate and
   * scale with the surface, translations that controls add to joints scale with it, and normals rotate.
   * `others` is 0, or 1 to move the other meshes, too. A motion of the whole mesh is followed exactly.
   * Fails with MIEN_ERROR_INDEX if `mesh` is past the end, MIEN_ERROR_INVALID_ARGUMENT if the mesh has another
   * number of positions, or a number is not finite, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE,
   * MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid, MIEN_ERROR_MEMORY if the
   * allocator returns NULL.
   */
  mien_document_conform(document: number, mesh: number, positions: number, position_count: number, others: number, out_conformed: number, error: number): number;
  /**
   * Gives a character the rig of a template: controls, joints, behavior, and LODs of document `rig`. The
   * character keeps its shape. Its meshes keep topology and positions where the template has a mesh of the
   * same name, and get weights and targets from it; other meshes are the template's, moved with the surface.
   * Joints with names of joints of the character keep the places of those, others move with the surface.
   * `out_errors` has `capacity` elements, one for each raw control of both rigs, or fewer; `out_errors` may
   * be NULL; `out_count` gets the number written.
   * Fails with MIEN_ERROR_MISMATCH if the documents differ in axes, units or rotations,
   * MIEN_ERROR_INVALID_ARGUMENT if no mesh of LOD 0 has the name of one of the template, or meshes lack
   * triangles or texture coordinates, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE,
   * MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if one of them is not valid, MIEN_ERROR_MEMORY if the
   * allocator returns NULL.
   */
  mien_document_transplant(document: number, rig: number, desc: number, out_errors: number, capacity: number, out_count: number, error: number): number;
  /**
   * Opens the document as a file, with all checks of opening a file. `document` may be destroyed afterwards.
   * Close with mien_dna_close().
   * Fails with MIEN_ERROR_DNA_TRUNCATED, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE,
   * MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not a valid file; the message names the
   * first invalid field, mien_document_validate() lists them all.
   * See docs/dna-format.md, 13 "What is checked".
   */
  mien_document_to_dna(document: number, desc: number, out_dna: number, error: number): number;
  /**
   * Passes the bytes of the file to `sink`, in pieces of at most 8 MiB.
   * Fails like mien_document_write_file(), also with MIEN_ERROR_FILE_WRITE if `sink` does not take a piece.
   */
  mien_document_write_stream(document: number, sink: number, desc: number, error: number): number;
  /**
   * Writes the document to memory and returns its size in `out_size`. `buffer` may be NULL with capacity 0 to get
   * the size only. Writes nothing if `capacity` is too small; `out_size` is set nevertheless.
   * Fails like mien_document_write_file(), but not with MIEN_ERROR_FILE_WRITE, and with
   * MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small.
   */
  mien_document_write_memory(document: number, desc: number, buffer: number, capacity: number, out_size: number, error: number): number;
  /**
   * Checks the document like mien_dna_validate_memory() its file. `document` may be destroyed afterwards.
   * Destroy with mien_report_destroy().
   * Fails with MIEN_ERROR_DNA_LIMIT if the file would exceed 4 GiB.
   */
  mien_document_validate(document: number, desc: number, out_report: number, error: number): number;
  /**
   * Creates a fit. `desc` is required. `rig` must outlive the fit; the deformer may be destroyed. Measures
   * the effect of each control, which takes up to some seconds for large rigs. Destroy with
   * mien_fit_destroy().
   * Fails with MIEN_ERROR_INDEX if a control, position or mesh does not exist, MIEN_ERROR_LOD if the rig has no
   * such LOD, MIEN_ERROR_MISMATCH if the deformer belongs to another rig, MIEN_ERROR_INVALID_ARGUMENT if controls are
   * not ascending, a lower bound is above its upper one, or a weight is not finite.
   */
  mien_fit_create(rig: number, desc: number, out_fit: number, error: number): number;
  /** Destroys a fit. NULL is allowed. */
  mien_fit_destroy(fit: number): void;
  /**
   * Creates a surface with a tree to find the nearest points. `desc` is required. Destroy with
   * mien_fit_surface_destroy().
   * Fails with MIEN_ERROR_INDEX if a position does not exist, MIEN_ERROR_INVALID_ARGUMENT if there are no
   * triangles, or a coordinate is not finite.
   */
  mien_fit_surface_create(desc: number, out_surface: number, error: number): number;
  /** Destroys a surface. NULL is allowed. */
  mien_fit_surface_destroy(surface: number): void;
  /**
   * Finds the raw controls of a frame by bounded Gauss-Newton steps with Levenberg-Marquardt damping. Writes
   * all raw controls of the rig to `out_raw`; those that may not move keep their values of `start`. `result`
   * may be NULL. Deterministic unless there is a time limit. Does not allocate or lock.
   * Fails with MIEN_ERROR_NULL_ARGUMENT if points, images or a surface are given to a fit without points, or
   * images without a camera, or constraints on joints to one without a deformer,
   * MIEN_ERROR_INVALID_ARGUMENT if a stage is above 15, or a weight, a control, an offset or a number of the camera is
   * not finite, or a weight is negative, MIEN_ERROR_HANDLE if `surface` is none,
   * MIEN_ERROR_INDEX if a constraint has a joint or point that does not exist.
   */
  mien_fit_solve(fit: number, frame: number, out_raw: number, result: number): number;
  /**
   * Solves `count` frames of a motion, each from the result of the one before. `joints`, `points`, `images`,
   * `point_weights` and `surface_weights` of `frame` have a row for each frame, one after the other; all else is for all
   * frames. `start` and `stages` are for the first frame, and so is `camera`, if it may move. `out_raw` gets a row of all
   * raw controls for each frame; `results`, which may be NULL, one result for each, all with the `struct_size` of the
   * first. Where joints are the only targets, this is faster than calls of mien_fit_solve(), and differs from them by
   * rounding. Deterministic unless there is a time limit, which is that of a frame. Does not allocate or lock.
   * Fails like mien_fit_solve().
   */
  mien_fit_solve_frames(fit: number, frame: number, count: number, out_raw: number, results: number): number;
  /**
   * Writes for each raw control how well the data determines it at the initial pose: 0 if it moves nothing
   * that has a target, or if other controls have the same effect; up to 1 for the best determined one. The
   * parts of a rotation get the value of the turn that is determined least.
   * `count` is the number of raw controls.
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if `count` is another number.
   */
  mien_fit_observability(fit: number, out_values: number, count: number): number;
  /**
   * Chooses keys of a curve: straight lines between them are within `tolerance` of all values. `out_keys` gets
   * the frame numbers, ascending, the first and the last frame among them; `out_key_count` gets how many. `count`
   * is the number of values and the capacity of `out_keys`.
   * Fails with MIEN_ERROR_INVALID_ARGUMENT if a value is not finite, or the tolerance is negative or not
   * finite.
   */
  mien_fit_keys(values: number, count: number, tolerance: number, out_keys: number, out_key_count: number): number;
}
