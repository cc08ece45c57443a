// SPDX-License-Identifier: MIT
// Code generated from integrations/api/mien_api.json by generate.py; run ./dev api. DO NOT EDIT.

package mien

import "unsafe"

const VersionMajor = 0
const VersionMinor = 1
const VersionPatch = 0
const Version = 65536

// A byte offset that means "none".
const NoOffset = 18446744073709551615

// Ticks per second.
const TicksPerSecond = 705600000

// No mesh: the points of a landmark are joints.
const NoMesh = 4294967295

// No raw control.
const NoControl = 65535

// Value of a joint index that means no joint.
const NoJoint = 65535

// The largest number of controls that a name matches.
const MostShares = 16

// Numbers are never reused.
type Status int32

const StatusOk Status = 0

// a required pointer is NULL
const StatusNullArgument Status = 1

// a value out of range, or a buffer that is too small
const StatusInvalidArgument Status = 2

// struct_size is too small or above 4096, or a field unknown to the library is not zero
const StatusStructSize Status = 3

// a handle of the wrong kind
const StatusHandle Status = 4

// objects that do not belong together
const StatusMismatch Status = 5

// an index past the end
const StatusIndex Status = 6

// a LOD that does not exist, or for which the object has no memory
const StatusLod Status = 7

// no such name or path
const StatusName Status = 8

// an instruction set that the CPU or the build does not support
const StatusIsa Status = 9

// the allocator returned NULL
const StatusMemory Status = 10

// this build of the library only opens baked files, or the object is stored in a form that does not have what was asked for
const StatusUnsupported Status = 11

// the file cannot be opened
const StatusFileOpen Status = 20

// the file or stream cannot be read
const StatusFileRead Status = 21

// the file cannot be written
const StatusFileWrite Status = 22

// not a DNA file
const StatusDnaSignature Status = 30

// a DNA file whose generation is not 2
const StatusDnaVersion Status = 31

// the file ends before the data that its header or counts announce
const StatusDnaTruncated Status = 32

// offsets, sizes or counts contradict each other
const StatusDnaStructure Status = 33

// an index that refers to nothing
const StatusDnaReference Status = 34

// a count above the limit of the format or of Mien
const StatusDnaLimit Status = 35

// a required layer is not loaded or not in the file
const StatusDnaLayer Status = 36

// an invalid value, or one that cannot be converted
const StatusDnaValue Status = 37

// not a baked file
const StatusBakedSignature Status = 50

// baked by another version of Mien, or for the other byte order
const StatusBakedVersion Status = 51

// the file is shorter than its header states
const StatusBakedTruncated Status = 52

// sizes, counts or indices contradict each other
const StatusBakedStructure Status = 53

// the file has changed since it was written
const StatusBakedChecksum Status = 54

// the file does not contain the requested object
const StatusBakedPart Status = 55

// not a clip
const StatusClipSignature Status = 60

// a clip in another version of the format
const StatusClipVersion Status = 61

// the clip is shorter than its header states
const StatusClipTruncated Status = 62

// sizes, counts or curves contradict each other
const StatusClipStructure Status = 63

// the clip has changed since it was written
const StatusClipChecksum Status = 64

// a value that is not finite
const StatusClipValue Status = 65

// more than a clip, player or binding can hold
const StatusClipLimit Status = 66

// not a mix
const StatusMixSignature Status = 70

// a mix in another version of the format
const StatusMixVersion Status = 71

// the file is shorter than its header states
const StatusMixTruncated Status = 72

// sizes or counts contradict each other, or a value is out of range
const StatusMixStructure Status = 73

// the mix has changed since it was written
const StatusMixChecksum Status = 74

// the arrays of a mesh, shape or bone contradict each other
const StatusAuthorMesh Status = 80

// a mesh that cannot be rigged; the message names the rule
const StatusAuthorRefused Status = 81

// the caller's progress function asked to stop
const StatusAuthorCanceled Status = 82

// Layers of a DNA file, combined with |. A layer loads the layers that it refers to: all of them need
// the definition, RBF behavior needs the behavior. The descriptor is always loaded.
// See docs/dna-format.md, 9 "Choosing layers".
type Layer uint32

// only in MienDnaLayer.layer
const LayerUnknown Layer = 0
const LayerDescriptor Layer = 1
const LayerDefinition Layer = 2
const LayerBehavior Layer = 4
const LayerGeometry Layer = 8
const LayerMachineLearnedBehavior Layer = 16
const LayerRbfBehavior Layer = 32
const LayerJointBehaviorMetadata Layer = 64
const LayerTwistSwingBehavior Layer = 128
const LayerAll Layer = 255

// What to do with layers of unknown kinds.
type UnknownLayers uint32

// keep their bytes and write them back unchanged
const UnknownLayersKeep UnknownLayers = 0
const UnknownLayersDrop UnknownLayers = 1

type FileAccess uint32

// map the file; read it into memory if it cannot be mapped, such as a pipe
const FileAccessMap FileAccess = 0

// read the whole file into memory: safe even if it is truncated later
const FileAccessRead FileAccess = 1

type TranslationUnit uint32

const TranslationUnitCentimeters TranslationUnit = 0
const TranslationUnitMeters TranslationUnit = 1

type RotationUnit uint32

const RotationUnitDegrees RotationUnit = 0
const RotationUnitRadians RotationUnit = 1

// Directions as seen by the character.
type Direction uint32

const DirectionLeft Direction = 0
const DirectionRight Direction = 1
const DirectionUp Direction = 2
const DirectionDown Direction = 3
const DirectionFront Direction = 4
const DirectionBack Direction = 5

// Order of Euler angles.
type RotationSequence uint32

// x first, then y, then z, about fixed axes
const RotationSequenceXyz RotationSequence = 0
const RotationSequenceXzy RotationSequence = 1
const RotationSequenceYxz RotationSequence = 2
const RotationSequenceYzx RotationSequence = 3
const RotationSequenceZxy RotationSequence = 4
const RotationSequenceZyx RotationSequence = 5

// The side of a face a b c ... to which (b - a) x (c - a) points. The cross product is computed from
// the coordinates in the file, whatever the directions of its axes.
type FaceWinding uint32

// seen from outside: counter-clockwise with right-handed axes, clockwise with left-handed axes
const FaceWindingOutward FaceWinding = 0
const FaceWindingInward FaceWinding = 1

// How Euler angles are converted to other axes. Joint values are sums of angles, which have a meaning
// in one rotation sequence only. So only the first rule is exact for all rigs.
type RotationRule uint32

// keep the sequence of the file and rename its axes: if x and z are exchanged, xyz becomes zyx, xzy becomes zxy, and so on
const RotationRuleCarried RotationRule = 0

// the requested sequence. Neutral poses, quaternion joints, twists, swings, ML joints and joints that rotate about one axis only are converted exactly; rigs with other joints are rejected with MIEN_ERROR_DNA_VALUE
const RotationRuleExact RotationRule = 1

// the requested sequence, converting each column of the joint matrix separately: exact if one control is 1 and all others are 0, otherwise an approximation for small angles
const RotationRulePerColumn RotationRule = 2

// Type of a field.
type FieldType uint32

// named fields
const FieldTypeRecord FieldType = 0

// records, strings or arrays; element i is at the path of the list + [i]
const FieldTypeList FieldType = 1
const FieldTypeString FieldType = 2

// numbers: one, or an array
const FieldTypeU8 FieldType = 3
const FieldTypeU16 FieldType = 4
const FieldTypeU32 FieldType = 5
const FieldTypeI32 FieldType = 6
const FieldTypeF32 FieldType = 7

type Severity uint32

// opening the file or mien_rig_create() fails because of this
const SeverityError Severity = 0

// allowed, but probably a mistake
const SeverityWarning Severity = 1

// Instruction sets.
type Isa uint32

// the best one that the CPU, the operating system and the build support
const IsaBest Isa = 0
const IsaScalar Isa = 1
const IsaSse2 Isa = 2

// with FMA and F16C
const IsaAvx2 Isa = 3

// F, CD, DQ, BW and VL
const IsaAvx512 Isa = 4
const IsaNeon Isa = 5

// the one named by the environment variable MIEN_ISA ("scalar", "sse2", ...); the best one if it is unset or empty
const IsaEnvironment Isa = 1000

// How joint values store rotations.
type RotationOutput uint32

// 9 values per joint: tx ty tz rx ry rz sx sy sz
const RotationOutputEuler RotationOutput = 0

// 10 values per joint: tx ty tz qx qy qz qw sx sy sz
const RotationOutputQuaternion RotationOutput = 1

// Effect of a region mask on the networks of the region (mien_instance_ml_masks()).
// See docs/rig-evaluation.md, 8.5 "Region masks".
type MlMasks uint32

// 0: the outputs of the networks get their default (0, or 1 for the w of a quaternion). Other values: the networks are evaluated. This is the behavior that DNA files are authored for.
const MlMasksSwitch MlMasks = 0

// outputs are blended with their default by the mask, clamped to 0..1
const MlMasksBlend MlMasks = 1

// How the large arrays that evaluation reads are stored. Sums and results are always 32-bit floats.
// See docs/rig-evaluation.md, 4.9 "16-bit storage".
type Storage uint32

const StorageBit_32 Storage = 0

// half the memory. Network weights and columns of quaternion joints are IEEE half floats (rounded to nearest even, at most 65504 in magnitude); the joint matrix is 16-bit fixed point, in units of 1/32767 of the largest entry of the row
const StorageBit_16 Storage = 1

// Which instruction sets give bit-identical results. See docs/numbers.md, 5 "Portable arithmetic".
type Arithmetic uint32

// AVX2, AVX-512 and NEON, which fuse multiply and add, agree with each other; scalar and SSE2 agree with each other
const ArithmeticFast Arithmetic = 0

// all agree, because nothing is fused. A baked rig gives the same bits on every machine; a rig created from a DNA file does if the C libraries compute the same sines.
const ArithmeticPortable Arithmetic = 1

// What an instance keeps of its last evaluation. With MIEN_REUSE_UNCHANGED and MIEN_REUSE_NOTHING the
// results are bit-identical.
type Reuse uint32

// results whose inputs have not changed: joint groups, and other stages as a whole
const ReuseUnchanged Reuse = 0

// compute everything in each evaluation, for measurements
const ReuseNothing Reuse = 1

// also the sums of the joint matrix: where few controls changed, only their differences are added, so such a frame costs little even if these controls move joints everywhere. Joint values then depend on earlier frames: they differ from those of a full evaluation by at most (n + 1539) * 2^-23 * M, before rotations are made from them. n is the number of controls that are not 0, M the sum of the magnitudes of the products that a joint value is the sum of; both are the largest since all sums were last computed, which happens after a reset, after a change of LOD and before 1536 differences were added. Everything else is bit-identical. Rigs and instances take more memory: MienRigInfo.rig_bytes, .instance_bytes
const ReuseSums Reuse = 2

// Kinds of parts of a rig. Most have names.
type Kind uint32

const KindGuiControl Kind = 0
const KindRawControl Kind = 1

// correctives; unnamed in DNA files, here "psd0", "psd1", ...
const KindPsdControl Kind = 2
const KindMlControl Kind = 3
const KindRbfControl Kind = 4
const KindJoint Kind = 5
const KindBlendShapeChannel Kind = 6
const KindAnimatedMap Kind = 7
const KindMesh Kind = 8

// region masks, one per region of each mesh: "mesh/region"
const KindMlMask Kind = 9

// without names
const KindJointGroup Kind = 10

// without names
const KindRbfSolver Kind = 11

// without names: a swing and the twists with the same inputs, or a twist alone
const KindTwistSwing Kind = 12

// Stages of an evaluation, combined with |.
type Stage uint32

// neural networks
const StageMl Stage = 1

// RBF solvers
const StageRbf Stage = 2

// correctives
const StagePsd Stage = 4

// joint groups, then twists and swings, then ML joints
const StageJoints Stage = 8
const StageBlendShapes Stage = 16
const StageAnimatedMaps Stage = 32
const StageAll Stage = 63

// How the neutral rotation of a joint is combined with its delta.
type Compose uint32

// neutral rotation * delta rotation: the delta rotates first
const ComposeProduct Compose = 0

// the angles are added; requires MIEN_ROTATION_OUTPUT_EULER. Equals the product where the neutral rotation is zero.
const ComposeEulerAdd Compose = 1

// Treatment of skin weights.
type Weights uint32

const WeightsAsStored Weights = 0

// drop negative weights and divide the others by their sum
const WeightsFix Weights = 1

// Normals of deformed meshes; they have unit length. Where no normal can be computed (no faces, or faces
// without area), the neutral one is used. See docs/deformation.md, 3 "Normals".
type Normals uint32

// as MienDeformerDesc.normals says; in that field: recomputed
const NormalsDefault Normals = 0

// leave normals unchanged
const NormalsNone Normals = 1

// neutral normals rotated by the skinning, correct for any scale; blend shape targets have no effect
const NormalsSkinned Normals = 2

// the area-weighted mean of the normals of the faces around the position. On hard edges, where this differs from the stored normal by more than 30 degrees in the neutral pose, the stored normal is rotated by the rotation of this mean from the neutral pose.
const NormalsRecomputed Normals = 3

// Layout of a vertex attribute in memory, in the byte order of the machine. A signed normalized integer
// of n bits is round(clamp(v, -1, 1) * (2^(n-1) - 1)), ties to even, in two's complement. These are
// the vertex formats R32G32B32_SFLOAT, R32G32B32A32_SFLOAT, R16G16B16A16_SNORM and
// A2B10G10R10_SNORM_PACK32 of Vulkan, and float3, float4, short4Normalized and int1010102Normalized of
// Metal. Direct3D 12 and WebGPU lack the last one.
type VertexFormat uint32

// 12 bytes: x y z
const VertexFormatFloat32x3 VertexFormat = 0

// 16 bytes: x y z w
const VertexFormatFloat32x4 VertexFormat = 1

// 8 bytes: x y z w, 16 bits each
const VertexFormatSnorm16x4 VertexFormat = 2

// 4 bytes, one 32-bit word: x in bits 0-9, y in bits 10-19, z in bits 20-29, w in bits 30-31
const VertexFormatSnorm10_10_10_2 VertexFormat = 3

// Points on the way from controls to positions:
//
//	GUI -> RAW -> CONTROLS -> JOINTS -> LOCALS -> MODELS -> SKINS -> POSITIONS
//	                  |-> CHANNELS ------------------------------------^
//	                  |-> MAPS
//
// Derivatives lead from one point to a later one that depends on it. Networks, RBF solvers and correctives
// run between RAW and CONTROLS; the joint stage, channels and maps read CONTROLS. From JOINTS on, channel
// weights are constant. See docs/derivatives.md.
type Point uint32

// GUI controls
const PointGui Point = 0

// raw controls
const PointRaw Point = 1

// all controls: mien_instance_controls()
const PointControls Point = 2

// joint values: mien_instance_joints()
const PointJoints Point = 3

// 16 floats per joint: matrix relative to the parent, four columns
const PointLocals Point = 4

// the same, in model space: mien_deformer_instance_joint_matrices()
const PointModels Point = 5

// the same, of skin matrices: mien_deformer_instance_skin_matrices()
const PointSkins Point = 6

// x y z per position of a mesh, in the order of the file
const PointPositions Point = 7

// blend shape channel weights
const PointChannels Point = 8

// animated map weights
const PointMaps Point = 9

// What is checked when a baked file is used.
type BakedCheck uint32

// all sizes, counts and indices, so that no access is out of bounds whatever the bytes are. Floats are not checked, so their pages are read from disk only when first used.
const BakedCheckSafe BakedCheck = 0

// also the checksum of all bytes, which reads the whole file
const BakedCheckFull BakedCheck = 1

// What happens after the last frame.
type Looping uint32

// a clip: MIEN_LOOPING_CLAMP; a player: the setting of its clip
const LoopingDefault Looping = 0

// holds the last frame; the length is (frames - 1) * ticks per frame
const LoopingClamp Looping = 1

// starts over; the length is frames * ticks per frame
const LoopingWrap Looping = 2

// How values between two frames are computed. They stay within the range of these two frames.
type Interpolation uint32

const InterpolationLinear Interpolation = 0

// the value of the earlier frame
const InterpolationStep Interpolation = 1

// a Catmull-Rom spline, clamped to that range
const InterpolationCatmullRom Interpolation = 2

// The purpose of a layer. Guards protect the result of base and speech from the other groups.
type LayerGroup uint32

const LayerGroupBase LayerGroup = 0
const LayerGroupSpeech LayerGroup = 1
const LayerGroupEmotion LayerGroup = 2
const LayerGroupReaction LayerGroup = 3

// acts after the reactions if no layer of another group follows
const LayerGroupLife LayerGroup = 4

// How a layer changes a curve: o is the value so far, x the value of the layer, a = weight * mask. Curves
// for which the layer's source has no value do not change.
type BlendMode uint32

// o + a (x - o)
const BlendModeOverride BlendMode = 0

// o + a x
const BlendModeAdd BlendMode = 1

// o + a x (1 - p), or o + a x p if x < 0; p is o clamped to 0..1
const BlendModeScreen BlendMode = 2

// o + a max(0, x - o)
const BlendModeMax BlendMode = 3

// o (1 + a (x - 1))
const BlendModeScale BlendMode = 4

// Where the values of a layer come from.
type LayerSource uint32

// mien_mixer_play()
const LayerSourceClip LayerSource = 0

// a weighted sum: mien_mixer_set_pose_weight()
const LayerSourcePoses LayerSource = 1

// mien_mixer_push()
const LayerSourceStream LayerSource = 2

// MIEN_GENERATOR_...
const LayerSourceGenerator LayerSource = 3

// What a layer generates from the seed of the mixer and the time.
type Generator uint32

// blinks every `period` on average, at least 0.5 s apart. The wait starts over when earlier layers raise the first curve above 0.6
const GeneratorBlink Generator = 0

// rises from 0 to 1 in 40 % of the period, then falls back to 0
const GeneratorBreath Generator = 1

// smooth noise between -1 and 1 with a new random value every period
const GeneratorNoise Generator = 2

// turns the eyes to a target with saccades, by MienMixDesc.gaze. `curves` are three curves with the left, up and front of a MienGazeTarget, read after the earlier layers, then optionally two curves that get the part left for the head (MienGazeRest). `amounts` are fixation jitter sideways and up in degrees, 0, and factors for the two head curves. Shifts of 20 degrees or more make the blink layers of the mix blink
const GeneratorGaze Generator = 3

// What a trigger does while the reaction is already running.
type Retrigger uint32

// extends the stimulus; strokes that are releasing or over start again
const RetriggerExtend Retrigger = 0

// all strokes start again, at most once per cooldown
const RetriggerRestart Retrigger = 1
const RetriggerIgnore Retrigger = 2

// Built-in guards: gaps that emotions and reactions must not open while speech or a blink closes them.
// Bits of MienMixDesc.guards.
type Guard uint32

// between the lips, left, center and right, and from lower lip to upper teeth
const GuardLips Guard = 1

// between the lids
const GuardLids Guard = 2

// between the teeth
const GuardTeeth Guard = 4
const GuardAll Guard = 7

// How a layer changes to another clip. A layer that plays no clip fades in, except with a cut.
type Transition uint32

// the old clip stops; each curve blends from its last value and speed
const TransitionInertial Transition = 0

// both clips play; MIEN_TRANSITION_INERTIAL if no player is free
const TransitionCrossfade Transition = 1

// immediate; transition_ticks is not used
const TransitionCut Transition = 2

// How a name was matched.
type NameMatch uint32

const NameMatchNone NameMatch = 0

// the control has this name
const NameMatchAsWritten NameMatch = 1

// the same letters and side
const NameMatchSpelling NameMatch = 2

// another word for the same control
const NameMatchAlias NameMatch = 3

// the controls of the left and the right side
const NameMatchBothSides NameMatch = 4

// an expression of several controls
const NameMatchExpression NameMatch = 5

// Kinds of generated rigs.
type Preset uint32

// small enough to read
const PresetTiny Preset = 0
const PresetSmall Preset = 1
const PresetMedium Preset = 2

// a synthetic rig of production size: 870 joints, 260 raw controls, 8 LODs, a million matrix entries
const PresetLarge Preset = 3

// a synthetic rig of the size of a production body: 342 joints, moved by 72 RBF solvers with 670 poses, 22 twists and 16 swings; some are quaternion joints
const PresetBody Preset = 4

// a stylized head to look at: skin, eyes, teeth, tongue, hair; the 52 ARKit expressions and 20 of MetaHuman rigs as raw controls (0 to 1), correctives, wrinkle maps, 8 LODs. Seed 0 is the designed head; other seeds vary skull, nose, jaw, age, hair and colors. The metadata holds vertex colors: key "mien.colors.<mesh name>", value base64 of 3 bytes (sRGB) per vertex position of the mesh.
const PresetHead Preset = 5

// a synthetic rig with the published counts of exported heads and names in MetaHuman's conventions: version 2.5, 870 joints, 263 raw controls (251 expressions, 12 parts of quaternions), 174 GUI controls, 545 correctives, 782 channels, an RBF solver with 18 poses, 8 LODs
const PresetMetahumanHead Preset = 6

// MIEN_PRESET_BODY in version 2.7
const PresetMetahumanBody Preset = 7

// MIEN_PRESET_METAHUMAN_HEAD without blend shapes
const PresetArchetype Preset = 8

// Additions to a preset, combined with |.
type Generate uint32

// machine-learned behavior: networks for mesh regions with all activation functions and operations, and ML joints; not with MIEN_PRESET_HEAD and those after it
const GenerateMl Generate = 1

// The role of a bone.
type BoneKind uint32

const BoneKindRoot BoneKind = 0
const BoneKindNeck BoneKind = 1
const BoneKindHead BoneKind = 2
const BoneKindFace BoneKind = 3

// moves with expressions; each LOD keeps the first n of these
const BoneKindFacial BoneKind = 4
const BoneKindJaw BoneKind = 5
const BoneKindEye BoneKind = 6

// below the neck
const BoneKindChest BoneKind = 7

// moves with expressions, below the jaw; in every LOD
const BoneKindTongue BoneKind = 8

// Whether both halves of the face are treated as mirror images.
type Symmetry uint32

// if mirrored positions lie within 0.5 % of the face's size of the surface
const SymmetryAuto Symmetry = 0
const SymmetryOn Symmetry = 1
const SymmetryOff Symmetry = 2

// Directions of the axes of a mesh.
type MeshAxis uint32

// up: Y; front: Z
const MeshAxisDefault MeshAxis = 0
const MeshAxisX MeshAxis = 1
const MeshAxisY MeshAxis = 2
const MeshAxisZ MeshAxis = 3
const MeshAxisMinusX MeshAxis = 4
const MeshAxisMinusY MeshAxis = 5
const MeshAxisMinusZ MeshAxis = 6

// How bones and weights are computed, combined with |.
type AuthorFlags uint32

// only the published method, plus the neck cut: no symmetry, no weighting by motion, no joints for jaw and eyes
const AuthorFlagsPaper AuthorFlags = 1

// the face mask may include parts of the neck
const AuthorFlagsNoNeckCut AuthorFlags = 2

// the face mask is where shapes move: for heads that are not human
const AuthorFlagsMaskFromShapes AuthorFlags = 4

// weight positions by the area around them: for scans
const AuthorFlagsAreaDensity AuthorFlags = 8

// no blend shape targets for the motion that joints cannot produce
const AuthorFlagsNoTargets AuthorFlags = 16

// group by distance in space, not in depth: for comparison
const AuthorFlagsGroupInSpace AuthorFlags = 32

// name bones that are placed and controls that are added as in MetaHuman heads where they have a counterpart: neck_01, FACIAL_C_Jaw, CTRL_expressions.jawOpen. The caller's bones and shapes keep their names
const AuthorFlagsMetahumanNames AuthorFlags = 64

// How positions of one mesh are found on another.
type Match uint32

// the nearest point in space
const MatchSurface Match = 0

// the nearest point in the texture
const MatchUv Match = 1

// What a constraint asks for. Places and directions are in model space, before the motion of
// MienFitFrame.rigid. Kinds with joints need MienFitDesc.deformer.
type FitConstraintKind uint32

// `joint` is at `target`: where the jaw is
const FitConstraintKindJointPosition FitConstraintKind = 0

// `axis` of `joint` has the direction `target`: an eye's gaze
const FitConstraintKindJointDirection FitConstraintKind = 1

// `axis` of `joint` points at the place `target`
const FitConstraintKindJointAim FitConstraintKind = 2

// `points[0]` is at `target`
const FitConstraintKindPointPosition FitConstraintKind = 3

// from `distances[0]` to `distances[1]` lie between `points`: 0 and 0 where lips touch
const FitConstraintKindPointDistance FitConstraintKind = 4

// Why a solve ended.
type FitStatus uint32

// further steps change nothing
const FitStatusConverged FitStatus = 0

// the limit of iterations was reached; the best controls so far
const FitStatusIterations FitStatus = 1

// the limit of time was reached; likewise
const FitStatusTime FitStatus = 2

// the caller asked to stop; likewise
const FitStatusCanceled FitStatus = 3

// no target, or all are missing; the start is returned
const FitStatusNoData FitStatus = 4

// Axes, units and rotation conventions of a rig. Any handedness is allowed.
// See docs/dna-format.md, 11 "Coordinate systems".
type CoordinateSystem struct {
	structSize uint64
	// MIEN_DIRECTION_... of x, y, z
	Axes [3]Direction
	// MIEN_TRANSLATION_UNIT_...
	TranslationUnit TranslationUnit
	// MIEN_ROTATION_UNIT_...
	RotationUnit RotationUnit
	// MIEN_ROTATION_RULE_...
	RotationRule RotationRule
	// MIEN_ROTATION_SEQUENCE_...; ignored with MIEN_ROTATION_RULE_CARRIED
	RotationSequence RotationSequence
	// of the angles about x, y, z. 1: rotates y to z, z to x, x to y. -1: the other way. 0: whichever leaves the angles unchanged
	RotationSigns [3]int32
	// MIEN_FACE_WINDING_...
	FaceWinding FaceWinding
	// 0
	reserved uint32
}

// Properties of an open DNA. Counts are those of the loaded layers and LODs.
type DnaInfo struct {
	structSize uint64
	// 2
	Generation uint32
	// 1 to 8: the file is of version 2.version
	Version uint32
	// MIEN_LAYER_..., combined with |: the loaded layers
	Layers Layer
	// the geometry is loaded with its targets
	HasBlendShapeTargets uint32
	// size of the file
	FileBytes uint64
	// memory taken from the allocator
	MemoryBytes uint64
	// the file is mapped
	IsMapped uint32
	// entries for mien_dna_layer()
	LayerCount uint32
	// MIEN_TRANSLATION_UNIT_...
	TranslationUnit TranslationUnit
	// MIEN_ROTATION_UNIT_...
	RotationUnit RotationUnit
	// MIEN_DIRECTION_... of x, y, z
	Axes [3]Direction
	// MIEN_ROTATION_SEQUENCE_...
	RotationSequence RotationSequence
	// 1 or -1, for the angles about x, y, z
	RotationSigns [3]int32
	// MIEN_FACE_WINDING_...
	FaceWinding FaceWinding
	LodCount    uint32
	// LOD 0 of this file is LOD max_lod of its database
	MaxLod                 uint32
	GuiControlCount        uint32
	RawControlCount        uint32
	PsdControlCount        uint32
	MlControlCount         uint32
	RbfControlCount        uint32
	JointCount             uint32
	JointGroupCount        uint32
	BlendShapeChannelCount uint32
	AnimatedMapCount       uint32
	MeshCount              uint32
	NeuralNetworkCount     uint32
	RbfSolverCount         uint32
	RbfPoseCount           uint32
	TwistCount             uint32
	SwingCount             uint32
	// pairs desc.metadata[i].key and .value
	MetadataCount uint32
}

// An entry of the index table of the file. Files of version 2.1 have no index table; their sections are
// listed as the layers desc, defn, bhvr and geom.
type DnaLayer struct {
	structSize uint64
	// MIEN_LAYER_... that loads it. MIEN_LAYER_UNKNOWN: no known kind
	Layer Layer
	// of the layer: version_major.version_minor
	VersionMajor uint32
	VersionMinor uint32
	// it was parsed, not skipped or kept as bytes
	IsLoaded uint32
	// of its first byte in the file
	ByteOffset uint64
	ByteCount  uint64
	// such as "bhvr"; null-terminated
	Code [8]uint8
}

type DnaField struct {
	structSize uint64
	// MIEN_FIELD_...
	Type FieldType
	// an array of numbers, even if it has only one element; not a single number, nor an element of an array
	IsArray uint32
	// elements of an array or list, bytes of a string, fields of a record; 1 for a number
	Count uint64
	// of a string, an array or an element of an array in the file; MIEN_NO_OFFSET: other fields, and data that is not in the file
	ByteOffset uint64
}

// How to write a DNA file. See docs/dna-format.md, 14.3 "Changing the version".
type WriteDesc struct {
	structSize uint64
	// 1 to 8: write version 2.version; layers that it does not define are kept unless unknown_layers drops them, but 2.1 can only hold the layers desc, defn, bhvr and geom. 0: the version of the DNA
	Version uint32
	// MIEN_UNKNOWN_LAYERS_...
	UnknownLayers UnknownLayers
}

type ValidateDesc struct {
	structSize uint64
	allocator  unsafe.Pointer
}

// Options of a rig. See docs/rig-evaluation.md, 9.4 "Options".
type RigDesc struct {
	structSize uint64
	// MIEN_ISA_...
	Isa Isa
	// MIEN_ROTATION_OUTPUT_...
	RotationOutput RotationOutput
	// MIEN_ML_MASKS_...
	MlMasks MlMasks
	// MIEN_STORAGE_...
	Storage Storage
	// MIEN_REUSE_...
	Reuse Reuse
	// MIEN_ARITHMETIC_...
	Arithmetic Arithmetic
	allocator  unsafe.Pointer
}

// Properties of a rig.
type RigInfo struct {
	structSize uint64
	// MIEN_ISA_... in use, never MIEN_ISA_BEST
	Isa      Isa
	LodCount uint32
	// MIEN_TRANSLATION_UNIT_...
	TranslationUnit TranslationUnit
	// MIEN_ROTATION_UNIT_...
	RotationUnit RotationUnit
	// MIEN_DIRECTION_... of x, y, z
	Axes [3]Direction
	// MIEN_ROTATION_SEQUENCE_...
	RotationSequence RotationSequence
	// 1 or -1, for the angles about x, y, z
	RotationSigns [3]int32
	// length of the control vector: raw, PSD, ML, RBF controls
	ControlCount uint32
	// 9 or 10 per joint
	JointValueCount uint32
	// MIEN_ROTATION_OUTPUT_...
	RotationOutput RotationOutput
	// MIEN_STORAGE_...
	Storage Storage
	// MIEN_ARITHMETIC_...
	Arithmetic Arithmetic
	// memory of the rig, including its part of a baked file
	RigBytes uint64
	// memory of each instance
	InstanceBytes uint64
}

// The work of an evaluation at a LOD when all controls are active.
type RigStatistics struct {
	structSize uint64
	Lod        uint32
	// correctives computed
	PsdCount uint32
	// joints of the LOD
	JointCount uint32
	// rows of the joint groups
	JointRowCount uint32
	// channels written
	BlendShapeCount uint32
	// rows of the animated map table
	AnimatedMapRowCount uint32
	// RBF solvers of the LOD
	RbfSolverCount uint32
	// quaternion joints
	QuaternionJointCount uint32
	// stored in the joint matrix: 8 per block that is not all zeros
	JointEntryCount uint64
	// of the joint matrix; an evaluation does not read the columns of controls that are 0
	JointByteCount uint64
}

type InstanceDesc struct {
	structSize uint64
	allocator  unsafe.Pointer
}

// What the joint stage reads for the current controls, at the LOD of the last evaluation (initially
// LOD 0), if it reuses no results. Each byte is counted once, regardless of CPU caches.
type InstanceStatistics struct {
	structSize uint64
	// of the last evaluation
	Lod uint32
	// of the control vector: raw, PSD, ML and RBF controls
	ControlCount uint32
	// controls that are not 0
	ActiveControlCount uint32
	// columns of the joint matrix that active controls drive
	JointColumnCount uint32
	// of these columns: 8 per block
	JointEntryCount uint64
	// of these entries: at most MienRigStatistics.joint_byte_count
	JointByteCount uint64
}

type BatchDesc struct {
	structSize uint64
	// instances per call: 1 to 2^20. 0: 32
	Capacity uint32
	// tasks that may run at the same time, each with its own scratch memory. 0: 1, for calls without MienParallelFor
	Tasks     uint32
	allocator unsafe.Pointer
}

// Options of a deformer.
type DeformerDesc struct {
	structSize uint64
	// MIEN_ISA_...; MIEN_ISA_BEST is that of the rig
	Isa Isa
	// MIEN_COMPOSE_...
	Compose Compose
	// MIEN_WEIGHTS_...
	Weights Weights
	// MIEN_NORMALS_...: what MIEN_NORMALS_DEFAULT means for this deformer
	Normals Normals
	// compute tangents, for mien_deformer_instance_write_vertices()
	WithTangents uint32
	// MIEN_STORAGE_... of blend shape deltas, skin weights, texture coordinates and triangles. With 16 bits these are integers with scales, and triangles follow from faces. See docs/deformation.md, 2.1 "16-bit storage"
	Storage   Storage
	allocator unsafe.Pointer
	// largest rounding error of a coordinate of a delta that 16-bit storage may make to store deltas with 10 bits, in translation units. 0: 2^-18 of the size of the mesh, which is also the least
	DeltaError float64
}

// Properties of a deformer.
type DeformerInfo struct {
	structSize uint64
	// MIEN_ISA_... in use, never MIEN_ISA_BEST
	Isa Isa
	// MIEN_COMPOSE_...
	Compose Compose
	// MIEN_WEIGHTS_...
	Weights Weights
	// MIEN_NORMALS_..., never MIEN_NORMALS_DEFAULT
	Normals      Normals
	LodCount     uint32
	JointCount   uint32
	ChannelCount uint32
	// same as in the rig, which has their names: MIEN_KIND_MESH
	MeshCount uint32
	// memory of the deformer, including its part of a baked file
	DeformerBytes uint64
	// memory of a deformer instance for all meshes
	InstanceBytes uint64
	// MIEN_STORAGE_...
	Storage Storage
	// 0
	reserved uint32
}

type DeformerInstanceDesc struct {
	structSize uint64
	// take memory for the meshes of these LODs only: bit l is LOD l. LODs that do not exist are ignored. 0: for all meshes
	Lods      uint64
	allocator unsafe.Pointer
}

// How to open a baked file.
type BakedDesc struct {
	structSize uint64
	// MIEN_FILE_...; MIEN_FILE_READ also copies bytes in memory
	FileAccess FileAccess
	// MIEN_BAKED_CHECK_...
	Check     BakedCheck
	allocator unsafe.Pointer
}

// Properties of an open baked file.
type BakedInfo struct {
	structSize uint64
	// size of the file
	FileBytes uint64
	// memory taken from the allocator
	MemoryBytes uint64
	// size of the rig in the file. 0: it has none
	RigBytes uint64
	// size of the deformer in the file. 0: it has none
	DeformerBytes uint64
	// parts of the file, including unknown ones
	PartCount uint32
	// the file is mapped
	IsMapped uint32
}

// Options of a rig that are not part of a baked file.
type BakedRigDesc struct {
	structSize uint64
	// MIEN_ISA_...
	Isa Isa
	// MIEN_REUSE_...
	Reuse     Reuse
	allocator unsafe.Pointer
}

// Options of a deformer that are not part of a baked file.
type BakedDeformerDesc struct {
	structSize uint64
	// MIEN_ISA_...; MIEN_ISA_BEST is that of the rig
	Isa Isa
	// MIEN_NORMALS_...: what MIEN_NORMALS_DEFAULT means for this deformer; in this field MIEN_NORMALS_DEFAULT keeps the setting of the baked deformer
	Normals   Normals
	allocator unsafe.Pointer
}

// How to open a clip.
type ClipOpenDesc struct {
	structSize uint64
	// MIEN_FILE_...; no effect on memory and streams
	FileAccess FileAccess
	// 0
	reserved  uint32
	allocator unsafe.Pointer
}

// Properties of a clip.
type ClipInfo struct {
	structSize uint64
	// frames per second, as a fraction
	RateNumerator   uint32
	RateDenominator uint32
	FrameCount      uint32
	ChannelCount    uint32
	// channels whose value is not the same in all frames
	ChangingChannelCount uint32
	EventCount           uint32
	// MIEN_LOOPING_CLAMP or MIEN_LOOPING_WRAP
	Looping Looping
	// as in MienClipDesc
	IsDelta uint32
	// largest step to which a channel was rounded. 0: none was
	Snap float32
	// the file is mapped
	IsMapped      uint32
	TicksPerFrame int64
	// ticks
	Length int64
	// size of the clip
	FileBytes uint64
	// memory taken from the allocator
	MemoryBytes uint64
	// memory of a player without MienClipPlayerDesc.reverse
	PlayerBytes uint64
}

// How to play a clip.
type ClipPlayerDesc struct {
	structSize uint64
	// MIEN_LOOPING_...
	Looping Looping
	// MIEN_INTERPOLATION_...
	Interpolation Interpolation
	// speed, as a fraction; negative plays backward. -2^20 to 2^20
	SpeedNumerator int32
	// 1 to 2^20. Both 0: 1 / 1
	SpeedDenominator int32
	// initial position, as for mien_clip_player_seek()
	StartTick int64
	// backward playback costs no more than forward; takes 256 more bytes per changing channel
	Reverse uint32
	// 0
	reserved  uint32
	allocator unsafe.Pointer
}

// State of a player.
type ClipPlayerInfo struct {
	structSize uint64
	// 0 to the length of the clip; with MIEN_LOOPING_WRAP less than the length
	Tick int64
	// loops completed since creation or the last seek, at most 2^61; negative: backward
	Loops int64
	// MIEN_LOOPING_CLAMP or MIEN_LOOPING_WRAP
	Looping Looping
	// a damaged curve was played, as zeros
	IsDamaged uint32
}

// How to open a mix.
type MixOpenDesc struct {
	structSize uint64
	allocator  unsafe.Pointer
}

// Properties of a mix.
type MixInfo struct {
	structSize      uint64
	RawControlCount uint32
	VariableCount   uint32
	// raw controls and pose variables
	CurveCount uint32
	LayerCount uint32
	// for mien_mixer_stage()
	StageCount uint32
	// for mien_mixer_set_guard()
	GuardCount uint32
	// memory of a mixer without MienMixerDesc.stages
	MixerBytes uint64
	// size of a snapshot
	SnapshotBytes uint64
}

// How to create a mixer.
type MixerDesc struct {
	structSize uint64
	// of the generators
	Seed uint64
	// keep the row after each stage, for mien_mixer_stage()
	Stages uint32
	// 0
	reserved  uint32
	allocator unsafe.Pointer
}

// How to play a clip in a layer.
type PlayDesc struct {
	structSize uint64
	// chosen by the caller, to identify clip and binding in mien_mixer_restore()
	ClipId uint64
	// in the clip
	StartTick int64
	// 0 to 2^40
	TransitionTicks int64
	// MIEN_TRANSITION_...
	Transition Transition
	// MIEN_LOOPING_...
	Looping Looping
	// MIEN_INTERPOLATION_...
	Interpolation Interpolation
	// as in MienClipPlayerDesc
	SpeedNumerator   int32
	SpeedDenominator int32
	// ; requires MienMixDesc.mirror
	Mirrored uint32
}

// State of a mixer.
type MixerInfo struct {
	structSize uint64
	// time since creation
	Tick int64
	// clip events that the last step passed
	EventCount uint32
	// there were more than MienMixDesc.max_events
	LostEvents uint32
}

// Properties of a solver stack.
type SolverStackInfo struct {
	structSize  uint64
	SolverCount uint32
	CurveCount  uint32
	// of all solvers
	OutputCount uint32
	JointCount  uint32
	// memory of a state
	StateBytes uint64
}

// How to create a solver state.
type SolverStateDesc struct {
	structSize uint64
	allocator  unsafe.Pointer
}

// What to generate.
type GenerateDesc struct {
	structSize uint64
	// MIEN_PRESET_...
	Preset Preset
	// MIEN_GENERATE_..., combined with |
	Flags Generate
	// the same preset, flags and seed give the same bytes on every machine
	Seed      uint64
	allocator unsafe.Pointer
}

type DocumentDesc struct {
	structSize uint64
	allocator  unsafe.Pointer
	// MIEN_FILE_...; for mien_document_open_file() only
	FileAccess FileAccess
	// MIEN_UNKNOWN_LAYERS_...; for mien_document_open_file() only
	UnknownLayers UnknownLayers
}

// How many deltas and targets mien_document_prune_targets() removed.
type PrunedTargets struct {
	structSize uint64
	Deltas     uint64
	Targets    uint64
}

// The largest magnitudes of entries of the joint matrix that count as small, in the units of the file.
type PruneJointsDesc struct {
	structSize  uint64
	Translation float32
	Rotation    float32
	Scale       float32
	// 0
	reserved uint32
}

// The effect of mien_document_prune_joints(): removed entries, and the largest distance by which a position
// moved.
type PrunedJoints struct {
	structSize uint64
	// entries of the joint matrix that were not 0
	EntryCount uint64
	// of these, set to 0
	RemovedCount uint64
	// in the unit of the file
	WorstDistance float64
	// the raw control at 1, or the corrective whose raw controls were at 1
	WorstControl  uint32
	WorstMesh     uint32
	WorstPosition uint32
	reserved      uint32
}

// How to place a character: it is scaled about the origin, then rotated about it, then moved.
type Placement struct {
	structSize uint64
	// above 0. 0: 1
	Scale float64
	// right-handed degrees about x, then y, then z of the file
	Rotation [3]float64
	// in the unit of the file
	Translation [3]float64
}

// How mien_document_project() works.
type ProjectDesc struct {
	structSize uint64
	// MIEN_MATCH_...
	Match Match
	// at most, per position. 0: 8
	Influences uint32
	// leave the skin weights as they are
	KeepWeights uint32
	// leave the targets as they are
	KeepTargets uint32
}

// How far the rig moved to follow a mesh.
type Conformed struct {
	structSize uint64
	// largest distance by which a joint moved, in the unit of the file
	JointDistance float64
	// that joint
	Joint    uint32
	reserved uint32
}

// How mien_document_transplant() works.
type TransplantDesc struct {
	structSize uint64
	// MIEN_MATCH_..., for meshes of the same name; positions of the same number correspond if the meshes have the same faces
	Match Match
	// at most, per position. 0: 8
	Influences uint32
}

// The result of a solve.
type FitResult struct {
	structSize uint64
	// MIEN_FIT_...
	Status     FitStatus
	Iterations uint32
	// the minimized sum, with all terms
	Cost float64
	// weighted root mean square of the differences of joint values
	JointResidual float64
	// the same for points; without these, for images in their unit; without both, for the surface
	PointResidual float64
	// with a surface: those that have no target
	MissingPoints uint32
	reserved      uint32
	// rows: points of the target = rotation * model + translation, if rigid; the camera's with images
	Rotation    [9]float32
	Translation [3]float32
	// largest difference of a joint value that counts
	JointWorst float64
	// largest distance of a point that counts, of the same kind
	PointWorst float64
	// of the camera, with images; else 0
	Focal [2]float32
	// weighted root mean square of the residuals of constraints
	ConstraintResidual float64
	// largest residual of a constraint that counts
	ConstraintWorst float64
	// joint values or points moved farther from where they are at `start` than their targets ask for, as roots of mean squares; those without a target count as such that ask for nothing
	Jumped     uint32
	Reserved_2 uint32
	// weighted root mean square of the distances in the image
	ImageResidual float64
	ImageWorst    float64
	// the same of the distances from the surface
	SurfaceResidual float64
	SurfaceWorst    float64
}

// Bytes of each struct in C, to compare with unsafe.Sizeof.
var structSizes = [][2]uintptr{
	{unsafe.Sizeof(CoordinateSystem{}), 56},
	{unsafe.Sizeof(DnaInfo{}), 160},
	{unsafe.Sizeof(DnaLayer{}), 48},
	{unsafe.Sizeof(DnaField{}), 32},
	{unsafe.Sizeof(WriteDesc{}), 16},
	{unsafe.Sizeof(ValidateDesc{}), 16},
	{unsafe.Sizeof(RigDesc{}), 40},
	{unsafe.Sizeof(RigInfo{}), 88},
	{unsafe.Sizeof(RigStatistics{}), 56},
	{unsafe.Sizeof(InstanceDesc{}), 16},
	{unsafe.Sizeof(InstanceStatistics{}), 40},
	{unsafe.Sizeof(BatchDesc{}), 24},
	{unsafe.Sizeof(DeformerDesc{}), 48},
	{unsafe.Sizeof(DeformerInfo{}), 64},
	{unsafe.Sizeof(DeformerInstanceDesc{}), 24},
	{unsafe.Sizeof(BakedDesc{}), 24},
	{unsafe.Sizeof(BakedInfo{}), 48},
	{unsafe.Sizeof(BakedRigDesc{}), 24},
	{unsafe.Sizeof(BakedDeformerDesc{}), 24},
	{unsafe.Sizeof(ClipOpenDesc{}), 24},
	{unsafe.Sizeof(ClipInfo{}), 88},
	{unsafe.Sizeof(ClipPlayerDesc{}), 48},
	{unsafe.Sizeof(ClipPlayerInfo{}), 32},
	{unsafe.Sizeof(MixOpenDesc{}), 16},
	{unsafe.Sizeof(MixInfo{}), 48},
	{unsafe.Sizeof(MixerDesc{}), 32},
	{unsafe.Sizeof(PlayDesc{}), 56},
	{unsafe.Sizeof(MixerInfo{}), 24},
	{unsafe.Sizeof(SolverStackInfo{}), 32},
	{unsafe.Sizeof(SolverStateDesc{}), 16},
	{unsafe.Sizeof(GenerateDesc{}), 32},
	{unsafe.Sizeof(DocumentDesc{}), 24},
	{unsafe.Sizeof(PrunedTargets{}), 24},
	{unsafe.Sizeof(PruneJointsDesc{}), 24},
	{unsafe.Sizeof(PrunedJoints{}), 48},
	{unsafe.Sizeof(Placement{}), 64},
	{unsafe.Sizeof(ProjectDesc{}), 24},
	{unsafe.Sizeof(Conformed{}), 24},
	{unsafe.Sizeof(TransplantDesc{}), 16},
	{unsafe.Sizeof(FitResult{}), 176},
}
