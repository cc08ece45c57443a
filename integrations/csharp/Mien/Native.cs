// SPDX-License-Identifier: MIT
// Code generated from integrations/api/mien_api.json by generate.py; run ./dev api. DO NOT EDIT.
// The enums, structs and functions of mien.h and mien_author.h, with their comments.
using System;
using System.Runtime.InteropServices;

namespace Mien {

  /// <summary>Numbers are never reused.</summary>
  public enum Status : int {
    Ok = 0,
    /// <summary>a required pointer is NULL</summary>
    NullArgument = 1,
    /// <summary>a value out of range, or a buffer that is too small</summary>
    InvalidArgument = 2,
    /// <summary>struct_size is too small or above 4096, or a field unknown to the library is not zero</summary>
    StructSize = 3,
    /// <summary>a handle of the wrong kind</summary>
    Handle = 4,
    /// <summary>objects that do not belong together</summary>
    Mismatch = 5,
    /// <summary>an index past the end</summary>
    Index = 6,
    /// <summary>a LOD that does not exist, or for which the object has no memory</summary>
    Lod = 7,
    /// <summary>no such name or path</summary>
    Name = 8,
    /// <summary>an instruction set that the CPU or the build does not support</summary>
    Isa = 9,
    /// <summary>the allocator returned NULL</summary>
    Memory = 10,
    /// <summary>this build of the library only opens baked files, or the object is stored in a form that does not have what was asked for</summary>
    Unsupported = 11,
    /// <summary>the file cannot be opened</summary>
    FileOpen = 20,
    /// <summary>the file or stream cannot be read</summary>
    FileRead = 21,
    /// <summary>the file cannot be written</summary>
    FileWrite = 22,
    /// <summary>not a DNA file</summary>
    DnaSignature = 30,
    /// <summary>a DNA file whose generation is not 2</summary>
    DnaVersion = 31,
    /// <summary>the file ends before the data that its header or counts announce</summary>
    DnaTruncated = 32,
    /// <summary>offsets, sizes or counts contradict each other</summary>
    DnaStructure = 33,
    /// <summary>an index that refers to nothing</summary>
    DnaReference = 34,
    /// <summary>a count above the limit of the format or of Mien</summary>
    DnaLimit = 35,
    /// <summary>a required layer is not loaded or not in the file</summary>
    DnaLayer = 36,
    /// <summary>an invalid value, or one that cannot be converted</summary>
    DnaValue = 37,
    /// <summary>not a baked file</summary>
    BakedSignature = 50,
    /// <summary>baked by another version of Mien, or for the other byte order</summary>
    BakedVersion = 51,
    /// <summary>the file is shorter than its header states</summary>
    BakedTruncated = 52,
    /// <summary>sizes, counts or indices contradict each other</summary>
    BakedStructure = 53,
    /// <summary>the file has changed since it was written</summary>
    BakedChecksum = 54,
    /// <summary>the file does not contain the requested object</summary>
    BakedPart = 55,
    /// <summary>not a clip</summary>
    ClipSignature = 60,
    /// <summary>a clip in another version of the format</summary>
    ClipVersion = 61,
    /// <summary>the clip is shorter than its header states</summary>
    ClipTruncated = 62,
    /// <summary>sizes, counts or curves contradict each other</summary>
    ClipStructure = 63,
    /// <summary>the clip has changed since it was written</summary>
    ClipChecksum = 64,
    /// <summary>a value that is not finite</summary>
    ClipValue = 65,
    /// <summary>more than a clip, player or binding can hold</summary>
    ClipLimit = 66,
    /// <summary>not a mix</summary>
    MixSignature = 70,
    /// <summary>a mix in another version of the format</summary>
    MixVersion = 71,
    /// <summary>the file is shorter than its header states</summary>
    MixTruncated = 72,
    /// <summary>sizes or counts contradict each other, or a value is out of range</summary>
    MixStructure = 73,
    /// <summary>the mix has changed since it was written</summary>
    MixChecksum = 74,
    /// <summary>the arrays of a mesh, shape or bone contradict each other</summary>
    AuthorMesh = 80,
    /// <summary>a mesh that cannot be rigged; the message names the rule</summary>
    AuthorRefused = 81,
    /// <summary>the caller's progress function asked to stop</summary>
    AuthorCanceled = 82,
  }

  /// <summary>Layers of a DNA file, combined with |. A layer loads the layers that it refers to: all of them need
  /// the definition, RBF behavior needs the behavior. The descriptor is always loaded.
  /// See docs/dna-format.md, 9 "Choosing layers".</summary>
  [Flags]
  public enum Layer : uint {
    /// <summary>only in MienDnaLayer.layer</summary>
    Unknown = 0,
    Descriptor = 1,
    Definition = 2,
    Behavior = 4,
    Geometry = 8,
    MachineLearnedBehavior = 16,
    RbfBehavior = 32,
    JointBehaviorMetadata = 64,
    TwistSwingBehavior = 128,
    All = 255,
  }

  /// <summary>What to do with layers of unknown kinds.</summary>
  public enum UnknownLayers : uint {
    /// <summary>keep their bytes and write them back unchanged</summary>
    Keep = 0,
    Drop = 1,
  }

  public enum FileAccess : uint {
    /// <summary>map the file; read it into memory if it cannot be mapped, such as a pipe</summary>
    Map = 0,
    /// <summary>read the whole file into memory: safe even if it is truncated later</summary>
    Read = 1,
  }

  public enum TranslationUnit : uint {
    Centimeters = 0,
    Meters = 1,
  }

  public enum RotationUnit : uint {
    Degrees = 0,
    Radians = 1,
  }

  /// <summary>Directions as seen by the character.</summary>
  public enum Direction : uint {
    Left = 0,
    Right = 1,
    Up = 2,
    Down = 3,
    Front = 4,
    Back = 5,
  }

  /// <summary>Order of Euler angles.</summary>
  public enum RotationSequence : uint {
    /// <summary>x first, then y, then z, about fixed axes</summary>
    Xyz = 0,
    Xzy = 1,
    Yxz = 2,
    Yzx = 3,
    Zxy = 4,
    Zyx = 5,
  }

  /// <summary>The side of a face a b c ... to which (b - a) x (c - a) points. The cross product is computed from
  /// the coordinates in the file, whatever the directions of its axes.</summary>
  public enum FaceWinding : uint {
    /// <summary>seen from outside: counter-clockwise with right-handed axes, clockwise with left-handed axes</summary>
    Outward = 0,
    Inward = 1,
  }

  /// <summary>How Euler angles are converted to other axes. Joint values are sums of angles, which have a meaning
  /// in one rotation sequence only. So only the first rule is exact for all rigs.</summary>
  public enum RotationRule : uint {
    /// <summary>keep the sequence of the file and rename its axes: if x and z are exchanged, xyz becomes zyx, xzy becomes zxy, and so on</summary>
    Carried = 0,
    /// <summary>the requested sequence. Neutral poses, quaternion joints, twists, swings, ML joints and joints that rotate about one axis only are converted exactly; rigs with other joints are rejected with MIEN_ERROR_DNA_VALUE</summary>
    Exact = 1,
    /// <summary>the requested sequence, converting each column of the joint matrix separately: exact if one control is 1 and all others are 0, otherwise an approximation for small angles</summary>
    PerColumn = 2,
  }

  /// <summary>Type of a field.</summary>
  public enum FieldType : uint {
    /// <summary>named fields</summary>
    Record = 0,
    /// <summary>records, strings or arrays; element i is at the path of the list + [i]</summary>
    List = 1,
    String = 2,
    /// <summary>numbers: one, or an array</summary>
    U8 = 3,
    U16 = 4,
    U32 = 5,
    I32 = 6,
    F32 = 7,
  }

  public enum Severity : uint {
    /// <summary>opening the file or mien_rig_create() fails because of this</summary>
    Error = 0,
    /// <summary>allowed, but probably a mistake</summary>
    Warning = 1,
  }

  /// <summary>Instruction sets.</summary>
  public enum Isa : uint {
    /// <summary>the best one that the CPU, the operating system and the build support</summary>
    Best = 0,
    Scalar = 1,
    Sse2 = 2,
    /// <summary>with FMA and F16C</summary>
    Avx2 = 3,
    /// <summary>F, CD, DQ, BW and VL</summary>
    Avx512 = 4,
    Neon = 5,
    /// <summary>the one named by the environment variable MIEN_ISA ("scalar", "sse2", ...); the best one if it is unset or empty</summary>
    Environment = 1000,
  }

  /// <summary>How joint values store rotations.</summary>
  public enum RotationOutput : uint {
    /// <summary>9 values per joint: tx ty tz rx ry rz sx sy sz</summary>
    Euler = 0,
    /// <summary>10 values per joint: tx ty tz qx qy qz qw sx sy sz</summary>
    Quaternion = 1,
  }

  /// <summary>Effect of a region mask on the networks of the region (mien_instance_ml_masks()).
  /// See docs/rig-evaluation.md, 8.5 "Region masks".</summary>
  public enum MlMasks : uint {
    /// <summary>0: the outputs of the networks get their default (0, or 1 for the w of a quaternion). Other values: the networks are evaluated. This is the behavior that DNA files are authored for.</summary>
    Switch = 0,
    /// <summary>outputs are blended with their default by the mask, clamped to 0..1</summary>
    Blend = 1,
  }

  /// <summary>How the large arrays that evaluation reads are stored. Sums and results are always 32-bit floats.
  /// See docs/rig-evaluation.md, 4.9 "16-bit storage".</summary>
  public enum Storage : uint {
    Bit_32 = 0,
    /// <summary>half the memory. Network weights and columns of quaternion joints are IEEE half floats (rounded to nearest even, at most 65504 in magnitude); the joint matrix is 16-bit fixed point, in units of 1/32767 of the largest entry of the row</summary>
    Bit_16 = 1,
  }

  /// <summary>Which instruction sets give bit-identical results. See docs/numbers.md, 5 "Portable arithmetic".</summary>
  public enum Arithmetic : uint {
    /// <summary>AVX2, AVX-512 and NEON, which fuse multiply and add, agree with each other; scalar and SSE2 agree with each other</summary>
    Fast = 0,
    /// <summary>all agree, because nothing is fused. A baked rig gives the same bits on every machine; a rig created from a DNA file does if the C libraries compute the same sines.</summary>
    Portable = 1,
  }

  /// <summary>What an instance keeps of its last evaluation. With MIEN_REUSE_UNCHANGED and MIEN_REUSE_NOTHING the
  /// results are bit-identical.</summary>
  public enum Reuse : uint {
    /// <summary>results whose inputs have not changed: joint groups, and other stages as a whole</summary>
    Unchanged = 0,
    /// <summary>compute everything in each evaluation, for measurements</summary>
    Nothing = 1,
    /// <summary>also the sums of the joint matrix: where few controls changed, only their differences are added, so such a frame costs little even if these controls move joints everywhere. Joint values then depend on earlier frames: they differ from those of a full evaluation by at most (n + 1539) * 2^-23 * M, before rotations are made from them. n is the number of controls that are not 0, M the sum of the magnitudes of the products that a joint value is the sum of; both are the largest since all sums were last computed, which happens after a reset, after a change of LOD and before 1536 differences were added. Everything else is bit-identical. Rigs and instances take more memory: MienRigInfo.rig_bytes, .instance_bytes</summary>
    Sums = 2,
  }

  /// <summary>Kinds of parts of a rig. Most have names.</summary>
  public enum Kind : uint {
    GuiControl = 0,
    RawControl = 1,
    /// <summary>correctives; unnamed in DNA files, here "psd0", "psd1", ...</summary>
    PsdControl = 2,
    MlControl = 3,
    RbfControl = 4,
    Joint = 5,
    BlendShapeChannel = 6,
    AnimatedMap = 7,
    Mesh = 8,
    /// <summary>region masks, one per region of each mesh: "mesh/region"</summary>
    MlMask = 9,
    /// <summary>without names</summary>
    JointGroup = 10,
    /// <summary>without names</summary>
    RbfSolver = 11,
    /// <summary>without names: a swing and the twists with the same inputs, or a twist alone</summary>
    TwistSwing = 12,
  }

  /// <summary>Stages of an evaluation, combined with |.</summary>
  [Flags]
  public enum Stage : uint {
    /// <summary>neural networks</summary>
    Ml = 1,
    /// <summary>RBF solvers</summary>
    Rbf = 2,
    /// <summary>correctives</summary>
    Psd = 4,
    /// <summary>joint groups, then twists and swings, then ML joints</summary>
    Joints = 8,
    BlendShapes = 16,
    AnimatedMaps = 32,
    All = 63,
  }

  /// <summary>How the neutral rotation of a joint is combined with its delta.</summary>
  public enum Compose : uint {
    /// <summary>neutral rotation * delta rotation: the delta rotates first</summary>
    Product = 0,
    /// <summary>the angles are added; requires MIEN_ROTATION_OUTPUT_EULER. Equals the product where the neutral rotation is zero.</summary>
    EulerAdd = 1,
  }

  /// <summary>Treatment of skin weights.</summary>
  public enum Weights : uint {
    AsStored = 0,
    /// <summary>drop negative weights and divide the others by their sum</summary>
    Fix = 1,
  }

  /// <summary>Normals of deformed meshes; they have unit length. Where no normal can be computed (no faces, or faces
  /// without area), the neutral one is used. See docs/deformation.md, 3 "Normals".</summary>
  public enum Normals : uint {
    /// <summary>as MienDeformerDesc.normals says; in that field: recomputed</summary>
    Default = 0,
    /// <summary>leave normals unchanged</summary>
    None = 1,
    /// <summary>neutral normals rotated by the skinning, correct for any scale; blend shape targets have no effect</summary>
    Skinned = 2,
    /// <summary>the area-weighted mean of the normals of the faces around the position. On hard edges, where this differs from the stored normal by more than 30 degrees in the neutral pose, the stored normal is rotated by the rotation of this mean from the neutral pose.</summary>
    Recomputed = 3,
  }

  /// <summary>Layout of a vertex attribute in memory, in the byte order of the machine. A signed normalized integer
  /// of n bits is round(clamp(v, -1, 1) * (2^(n-1) - 1)), ties to even, in two's complement. These are
  /// the vertex formats R32G32B32_SFLOAT, R32G32B32A32_SFLOAT, R16G16B16A16_SNORM and
  /// A2B10G10R10_SNORM_PACK32 of Vulkan, and float3, float4, short4Normalized and int1010102Normalized of
  /// Metal. Direct3D 12 and WebGPU lack the last one.</summary>
  public enum VertexFormat : uint {
    /// <summary>12 bytes: x y z</summary>
    Float32x3 = 0,
    /// <summary>16 bytes: x y z w</summary>
    Float32x4 = 1,
    /// <summary>8 bytes: x y z w, 16 bits each</summary>
    Snorm16x4 = 2,
    /// <summary>4 bytes, one 32-bit word: x in bits 0-9, y in bits 10-19, z in bits 20-29, w in bits 30-31</summary>
    Snorm10_10_10_2 = 3,
  }

  /// <summary>Points on the way from controls to positions:
  ///
  ///     GUI -&gt; RAW -&gt; CONTROLS -&gt; JOINTS -&gt; LOCALS -&gt; MODELS -&gt; SKINS -&gt; POSITIONS
  ///                       |-&gt; CHANNELS ------------------------------------^
  ///                       |-&gt; MAPS
  ///
  /// Derivatives lead from one point to a later one that depends on it. Networks, RBF solvers and correctives
  /// run between RAW and CONTROLS; the joint stage, channels and maps read CONTROLS. From JOINTS on, channel
  /// weights are constant. See docs/derivatives.md.</summary>
  public enum Point : uint {
    /// <summary>GUI controls</summary>
    Gui = 0,
    /// <summary>raw controls</summary>
    Raw = 1,
    /// <summary>all controls: mien_instance_controls()</summary>
    Controls = 2,
    /// <summary>joint values: mien_instance_joints()</summary>
    Joints = 3,
    /// <summary>16 floats per joint: matrix relative to the parent, four columns</summary>
    Locals = 4,
    /// <summary>the same, in model space: mien_deformer_instance_joint_matrices()</summary>
    Models = 5,
    /// <summary>the same, of skin matrices: mien_deformer_instance_skin_matrices()</summary>
    Skins = 6,
    /// <summary>x y z per position of a mesh, in the order of the file</summary>
    Positions = 7,
    /// <summary>blend shape channel weights</summary>
    Channels = 8,
    /// <summary>animated map weights</summary>
    Maps = 9,
  }

  /// <summary>What is checked when a baked file is used.</summary>
  public enum BakedCheck : uint {
    /// <summary>all sizes, counts and indices, so that no access is out of bounds whatever the bytes are. Floats are not checked, so their pages are read from disk only when first used.</summary>
    Safe = 0,
    /// <summary>also the checksum of all bytes, which reads the whole file</summary>
    Full = 1,
  }

  /// <summary>What happens after the last frame.</summary>
  public enum Looping : uint {
    /// <summary>a clip: MIEN_LOOPING_CLAMP; a player: the setting of its clip</summary>
    Default = 0,
    /// <summary>holds the last frame; the length is (frames - 1) * ticks per frame</summary>
    Clamp = 1,
    /// <summary>starts over; the length is frames * ticks per frame</summary>
    Wrap = 2,
  }

  /// <summary>How values between two frames are computed. They stay within the range of these two frames.</summary>
  public enum Interpolation : uint {
    Linear = 0,
    /// <summary>the value of the earlier frame</summary>
    Step = 1,
    /// <summary>a Catmull-Rom spline, clamped to that range</summary>
    CatmullRom = 2,
  }

  /// <summary>The purpose of a layer. Guards protect the result of base and speech from the other groups.</summary>
  public enum LayerGroup : uint {
    Base = 0,
    Speech = 1,
    Emotion = 2,
    Reaction = 3,
    /// <summary>acts after the reactions if no layer of another group follows</summary>
    Life = 4,
  }

  /// <summary>How a layer changes a curve: o is the value so far, x the value of the layer, a = weight * mask. Curves
  /// for which the layer's source has no value do not change.</summary>
  public enum BlendMode : uint {
    /// <summary>o + a (x - o)</summary>
    Override = 0,
    /// <summary>o + a x</summary>
    Add = 1,
    /// <summary>o + a x (1 - p), or o + a x p if x &lt; 0; p is o clamped to 0..1</summary>
    Screen = 2,
    /// <summary>o + a max(0, x - o)</summary>
    Max = 3,
    /// <summary>o (1 + a (x - 1))</summary>
    Scale = 4,
  }

  /// <summary>Where the values of a layer come from.</summary>
  public enum LayerSource : uint {
    /// <summary>mien_mixer_play()</summary>
    Clip = 0,
    /// <summary>a weighted sum: mien_mixer_set_pose_weight()</summary>
    Poses = 1,
    /// <summary>mien_mixer_push()</summary>
    Stream = 2,
    /// <summary>MIEN_GENERATOR_...</summary>
    Generator = 3,
  }

  /// <summary>What a layer generates from the seed of the mixer and the time.</summary>
  public enum Generator : uint {
    /// <summary>blinks every `period` on average, at least 0.5 s apart. The wait starts over when earlier layers raise the first curve above 0.6</summary>
    Blink = 0,
    /// <summary>rises from 0 to 1 in 40 % of the period, then falls back to 0</summary>
    Breath = 1,
    /// <summary>smooth noise between -1 and 1 with a new random value every period</summary>
    Noise = 2,
    /// <summary>turns the eyes to a target with saccades, by MienMixDesc.gaze. `curves` are three curves with the left, up and front of a MienGazeTarget, read after the earlier layers, then optionally two curves that get the part left for the head (MienGazeRest). `amounts` are fixation jitter sideways and up in degrees, 0, and factors for the two head curves. Shifts of 20 degrees or more make the blink layers of the mix blink</summary>
    Gaze = 3,
  }

  /// <summary>What a trigger does while the reaction is already running.</summary>
  public enum Retrigger : uint {
    /// <summary>extends the stimulus; strokes that are releasing or over start again</summary>
    Extend = 0,
    /// <summary>all strokes start again, at most once per cooldown</summary>
    Restart = 1,
    Ignore = 2,
  }

  /// <summary>Built-in guards: gaps that emotions and reactions must not open while speech or a blink closes them.
  /// Bits of MienMixDesc.guards.</summary>
  [Flags]
  public enum Guard : uint {
    /// <summary>between the lips, left, center and right, and from lower lip to upper teeth</summary>
    Lips = 1,
    /// <summary>between the lids</summary>
    Lids = 2,
    /// <summary>between the teeth</summary>
    Teeth = 4,
    All = 7,
  }

  /// <summary>How a layer changes to another clip. A layer that plays no clip fades in, except with a cut.</summary>
  public enum Transition : uint {
    /// <summary>the old clip stops; each curve blends from its last value and speed</summary>
    Inertial = 0,
    /// <summary>both clips play; MIEN_TRANSITION_INERTIAL if no player is free</summary>
    Crossfade = 1,
    /// <summary>immediate; transition_ticks is not used</summary>
    Cut = 2,
  }

  /// <summary>How a name was matched.</summary>
  public enum NameMatch : uint {
    None = 0,
    /// <summary>the control has this name</summary>
    AsWritten = 1,
    /// <summary>the same letters and side</summary>
    Spelling = 2,
    /// <summary>another word for the same control</summary>
    Alias = 3,
    /// <summary>the controls of the left and the right side</summary>
    BothSides = 4,
    /// <summary>an expression of several controls</summary>
    Expression = 5,
  }

  /// <summary>Kinds of generated rigs.</summary>
  public enum Preset : uint {
    /// <summary>small enough to read</summary>
    Tiny = 0,
    Small = 1,
    Medium = 2,
    /// <summary>a synthetic rig of production size: 870 joints, 260 raw controls, 8 LODs, a million matrix entries</summary>
    Large = 3,
    /// <summary>a synthetic rig of the size of a production body: 342 joints, moved by 72 RBF solvers with 670 poses, 22 twists and 16 swings; some are quaternion joints</summary>
    Body = 4,
    /// <summary>a stylized head to look at: skin, eyes, teeth, tongue, hair; the 52 ARKit expressions and 20 of MetaHuman rigs as raw controls (0 to 1), correctives, wrinkle maps, 8 LODs. Seed 0 is the designed head; other seeds vary skull, nose, jaw, age, hair and colors. The metadata holds vertex colors: key "mien.colors.&lt;mesh name&gt;", value base64 of 3 bytes (sRGB) per vertex position of the mesh.</summary>
    Head = 5,
    /// <summary>a synthetic rig with the published counts of exported heads and names in MetaHuman's conventions: version 2.5, 870 joints, 263 raw controls (251 expressions, 12 parts of quaternions), 174 GUI controls, 545 correctives, 782 channels, an RBF solver with 18 poses, 8 LODs</summary>
    MetahumanHead = 6,
    /// <summary>MIEN_PRESET_BODY in version 2.7</summary>
    MetahumanBody = 7,
    /// <summary>MIEN_PRESET_METAHUMAN_HEAD without blend shapes</summary>
    Archetype = 8,
  }

  /// <summary>Additions to a preset, combined with |.</summary>
  public enum Generate : uint {
    /// <summary>machine-learned behavior: networks for mesh regions with all activation functions and operations, and ML joints; not with MIEN_PRESET_HEAD and those after it</summary>
    Ml = 1,
  }

  /// <summary>The role of a bone.</summary>
  public enum BoneKind : uint {
    Root = 0,
    Neck = 1,
    Head = 2,
    Face = 3,
    /// <summary>moves with expressions; each LOD keeps the first n of these</summary>
    Facial = 4,
    Jaw = 5,
    Eye = 6,
    /// <summary>below the neck</summary>
    Chest = 7,
    /// <summary>moves with expressions, below the jaw; in every LOD</summary>
    Tongue = 8,
  }

  /// <summary>Whether both halves of the face are treated as mirror images.</summary>
  public enum Symmetry : uint {
    /// <summary>if mirrored positions lie within 0.5 % of the face's size of the surface</summary>
    Auto = 0,
    On = 1,
    Off = 2,
  }

  /// <summary>Directions of the axes of a mesh.</summary>
  public enum MeshAxis : uint {
    /// <summary>up: Y; front: Z</summary>
    Default = 0,
    X = 1,
    Y = 2,
    Z = 3,
    MinusX = 4,
    MinusY = 5,
    MinusZ = 6,
  }

  /// <summary>How bones and weights are computed, combined with |.</summary>
  [Flags]
  public enum AuthorFlags : uint {
    /// <summary>only the published method, plus the neck cut: no symmetry, no weighting by motion, no joints for jaw and eyes</summary>
    Paper = 1,
    /// <summary>the face mask may include parts of the neck</summary>
    NoNeckCut = 2,
    /// <summary>the face mask is where shapes move: for heads that are not human</summary>
    MaskFromShapes = 4,
    /// <summary>weight positions by the area around them: for scans</summary>
    AreaDensity = 8,
    /// <summary>no blend shape targets for the motion that joints cannot produce</summary>
    NoTargets = 16,
    /// <summary>group by distance in space, not in depth: for comparison</summary>
    GroupInSpace = 32,
    /// <summary>name bones that are placed and controls that are added as in MetaHuman heads where they have a counterpart: neck_01, FACIAL_C_Jaw, CTRL_expressions.jawOpen. The caller's bones and shapes keep their names</summary>
    MetahumanNames = 64,
  }

  /// <summary>How positions of one mesh are found on another.</summary>
  public enum Match : uint {
    /// <summary>the nearest point in space</summary>
    Surface = 0,
    /// <summary>the nearest point in the texture</summary>
    Uv = 1,
  }

  /// <summary>What a constraint asks for. Places and directions are in model space, before the motion of
  /// MienFitFrame.rigid. Kinds with joints need MienFitDesc.deformer.</summary>
  public enum FitConstraintKind : uint {
    /// <summary>`joint` is at `target`: where the jaw is</summary>
    JointPosition = 0,
    /// <summary>`axis` of `joint` has the direction `target`: an eye's gaze</summary>
    JointDirection = 1,
    /// <summary>`axis` of `joint` points at the place `target`</summary>
    JointAim = 2,
    /// <summary>`points[0]` is at `target`</summary>
    PointPosition = 3,
    /// <summary>from `distances[0]` to `distances[1]` lie between `points`: 0 and 0 where lips touch</summary>
    PointDistance = 4,
  }

  /// <summary>Why a solve ended.</summary>
  public enum FitStatus : uint {
    /// <summary>further steps change nothing</summary>
    Converged = 0,
    /// <summary>the limit of iterations was reached; the best controls so far</summary>
    Iterations = 1,
    /// <summary>the limit of time was reached; likewise</summary>
    Time = 2,
    /// <summary>the caller asked to stop; likewise</summary>
    Canceled = 3,
    /// <summary>no target, or all are missing; the start is returned</summary>
    NoData = 4,
  }
}

namespace Mien.Native {

  public static class Constants {
    public const int VersionMajor = 0;
    public const int VersionMinor = 1;
    public const int VersionPatch = 0;
    public const int Version = 65536;
    /// <summary>A byte offset that means "none".</summary>
    public const ulong NoOffset = 18446744073709551615;
    /// <summary>Ticks per second.</summary>
    public const int TicksPerSecond = 705600000;
    /// <summary>No mesh: the points of a landmark are joints.</summary>
    public const uint NoMesh = 4294967295;
    /// <summary>No raw control.</summary>
    public const int NoControl = 65535;
    /// <summary>Value of a joint index that means no joint.</summary>
    public const int NoJoint = 65535;
    /// <summary>The largest number of controls that a name matches.</summary>
    public const int MostShares = 16;

    // Bytes of each struct where pointers have 64 bits, to compare with sizeof.
    internal static unsafe readonly int[][] Sizes = {
      new[] { sizeof(MienError), 256 },
      new[] { sizeof(MienAllocator), 24 },
      new[] { sizeof(MienParallelFor), 16 },
      new[] { sizeof(MienStringView), 16 },
      new[] { sizeof(MienFloatView), 16 },
      new[] { sizeof(MienMutableFloatView), 16 },
      new[] { sizeof(MienIndex16View), 16 },
      new[] { sizeof(MienIndex32View), 16 },
      new[] { sizeof(MienStream), 24 },
      new[] { sizeof(MienCoordinateSystem), 56 },
      new[] { sizeof(MienDnaDesc), 48 },
      new[] { sizeof(MienDnaInfo), 160 },
      new[] { sizeof(MienDnaLayer), 48 },
      new[] { sizeof(MienDnaField), 32 },
      new[] { sizeof(MienWriteDesc), 16 },
      new[] { sizeof(MienFinding), 56 },
      new[] { sizeof(MienValidateDesc), 16 },
      new[] { sizeof(MienRigDesc), 40 },
      new[] { sizeof(MienRigInfo), 88 },
      new[] { sizeof(MienRigStatistics), 56 },
      new[] { sizeof(MienInstanceDesc), 16 },
      new[] { sizeof(MienInstanceStatistics), 40 },
      new[] { sizeof(MienBatchDesc), 24 },
      new[] { sizeof(MienDeformerDesc), 48 },
      new[] { sizeof(MienDeformerInfo), 64 },
      new[] { sizeof(MienMesh), 152 },
      new[] { sizeof(MienDeformerInstanceDesc), 24 },
      new[] { sizeof(MienVertexStream), 16 },
      new[] { sizeof(MienVertexOutput), 64 },
      new[] { sizeof(MienDerivativesDesc), 24 },
      new[] { sizeof(MienJacobianDesc), 64 },
      new[] { sizeof(MienJacobianPattern), 64 },
      new[] { sizeof(MienBakedDesc), 24 },
      new[] { sizeof(MienBakedInfo), 48 },
      new[] { sizeof(MienBakedRigDesc), 24 },
      new[] { sizeof(MienBakedDeformerDesc), 24 },
      new[] { sizeof(MienClipEvent), 32 },
      new[] { sizeof(MienClipDesc), 88 },
      new[] { sizeof(MienClipOpenDesc), 24 },
      new[] { sizeof(MienClipInfo), 88 },
      new[] { sizeof(MienClipChannel), 64 },
      new[] { sizeof(MienClipPlayerDesc), 48 },
      new[] { sizeof(MienClipPlayerInfo), 32 },
      new[] { sizeof(MienMatrixEntry), 40 },
      new[] { sizeof(MienClipBindingDesc), 32 },
      new[] { sizeof(MienClipBindingInfo), 72 },
      new[] { sizeof(MienMixLayer), 88 },
      new[] { sizeof(MienMixPose), 24 },
      new[] { sizeof(MienMixStroke), 56 },
      new[] { sizeof(MienMixReaction), 64 },
      new[] { sizeof(MienMixAntagonists), 8 },
      new[] { sizeof(MienLandmark), 16 },
      new[] { sizeof(MienMixGuard), 48 },
      new[] { sizeof(MienMixDesc), 168 },
      new[] { sizeof(MienMixOpenDesc), 16 },
      new[] { sizeof(MienMixInfo), 48 },
      new[] { sizeof(MienMixGuardInfo), 64 },
      new[] { sizeof(MienGazeDesc), 32 },
      new[] { sizeof(MienGazeTarget), 12 },
      new[] { sizeof(MienGazeInfo), 40 },
      new[] { sizeof(MienGazeRest), 8 },
      new[] { sizeof(MienMixerDesc), 32 },
      new[] { sizeof(MienPlayDesc), 56 },
      new[] { sizeof(MienGuardState), 64 },
      new[] { sizeof(MienMixerInfo), 24 },
      new[] { sizeof(MienMixerClip), 24 },
      new[] { sizeof(MienAimSolver), 56 },
      new[] { sizeof(MienSpaceSolver), 32 },
      new[] { sizeof(MienSpringSolver), 32 },
      new[] { sizeof(MienTwistSolver), 40 },
      new[] { sizeof(MienCopySolver), 28 },
      new[] { sizeof(MienSolverPose), 56 },
      new[] { sizeof(MienSolverCall), 32 },
      new[] { sizeof(MienUserSolver), 64 },
      new[] { sizeof(MienSolver), 64 },
      new[] { sizeof(MienSolverStackDesc), 40 },
      new[] { sizeof(MienSolverStackInfo), 32 },
      new[] { sizeof(MienSolverStateDesc), 16 },
      new[] { sizeof(MienSolverInput), 24 },
      new[] { sizeof(MienControlShare), 8 },
      new[] { sizeof(MienGenerateDesc), 32 },
      new[] { sizeof(MienAuthorObject), 24 },
      new[] { sizeof(MienAuthorShape), 40 },
      new[] { sizeof(MienAuthorMesh), 112 },
      new[] { sizeof(MienAuthorBone), 48 },
      new[] { sizeof(MienAuthorLandmark), 40 },
      new[] { sizeof(MienAuthorLod), 24 },
      new[] { sizeof(MienAuthorDesc), 240 },
      new[] { sizeof(MienDocumentDesc), 24 },
      new[] { sizeof(MienPrunedTargets), 24 },
      new[] { sizeof(MienPruneJointsDesc), 24 },
      new[] { sizeof(MienPrunedJoints), 48 },
      new[] { sizeof(MienPlacement), 64 },
      new[] { sizeof(MienProjectDesc), 24 },
      new[] { sizeof(MienConformed), 24 },
      new[] { sizeof(MienTransplantDesc), 16 },
      new[] { sizeof(MienControlError), 32 },
      new[] { sizeof(MienByteSink), 16 },
      new[] { sizeof(MienSolvePoint), 28 },
      new[] { sizeof(MienFitDesc), 104 },
      new[] { sizeof(MienFitSurfaceDesc), 48 },
      new[] { sizeof(MienFitCamera), 64 },
      new[] { sizeof(MienFitConstraint), 52 },
      new[] { sizeof(MienFitFrame), 184 },
      new[] { sizeof(MienFitResult), 176 },
    };
  }

  /// <summary>Details of a failure, owned by the caller. A call that fails fills all fields; a call that succeeds
  /// sets status to MIEN_OK and leaves the other fields unchanged.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienError {
    public UIntPtr StructSize;
    /// <summary>where in the file; MIEN_NO_OFFSET: nowhere in particular</summary>
    public ulong ByteOffset;
    public Status Status;
    /// <summary>what is wrong, where, and how to fix it; null-terminated, truncated if too long</summary>
    public fixed byte Message[236];

    /// <summary>All fields zero but StructSize.</summary>
    public static MienError Create() {
      return new MienError { StructSize = (UIntPtr)sizeof(MienError) };
    }
  }

  /// <summary>The caller's memory functions. Where a MienAllocator is NULL, the C library's heap is used. The
  /// struct is copied. Both functions must remain callable until the object is destroyed, from every
  /// thread that creates or destroys objects with this allocator.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienAllocator {
    /// <summary>passed to the functions</summary>
    public void* User;
    /// <summary>Returns `size` bytes aligned to `alignment` (a power of two, at most 64), or NULL.</summary>
    public IntPtr Allocate;
    /// <summary>Releases a block. `size` and `alignment` are those it was allocated with.</summary>
    public IntPtr Release;
  }

  /// <summary>The caller's thread pool; the library starts no threads.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienParallelFor {
    /// <summary>passed to the function</summary>
    public void* User;
    /// <summary>Calls task(context, i) once for each i &lt; count, in any order and on any threads, and returns when all calls have finished. Tasks never wait for each other; each takes about 10 us.</summary>
    public IntPtr Run;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienStringView {
    public byte* Data;
    /// <summary>bytes; not null-terminated</summary>
    public UIntPtr Count;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienFloatView {
    public float* Data;
    public UIntPtr Count;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienMutableFloatView {
    public float* Data;
    public UIntPtr Count;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienIndex16View {
    public ushort* Data;
    public UIntPtr Count;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienIndex32View {
    public uint* Data;
    public UIntPtr Count;
  }

  /// <summary>A file read by the caller, for example from an archive. `read` is called only during the call that
  /// takes the stream, and on the same thread.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienStream {
    /// <summary>passed to the function</summary>
    public void* User;
    /// <summary>of the file, in bytes</summary>
    public ulong Size;
    /// <summary>Copies `size` bytes at `offset` to `buffer`, never more, and returns the number of bytes copied; any number but `size` is an error. The range is within the file.</summary>
    public IntPtr Read;
  }

  /// <summary>Axes, units and rotation conventions of a rig. Any handedness is allowed.
  /// See docs/dna-format.md, 11 "Coordinate systems".</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienCoordinateSystem {
    public UIntPtr StructSize;
    /// <summary>MIEN_DIRECTION_... of x, y, z</summary>
    public fixed uint Axes[3];
    /// <summary>MIEN_TRANSLATION_UNIT_...</summary>
    public TranslationUnit TranslationUnit;
    /// <summary>MIEN_ROTATION_UNIT_...</summary>
    public RotationUnit RotationUnit;
    /// <summary>MIEN_ROTATION_RULE_...</summary>
    public RotationRule RotationRule;
    /// <summary>MIEN_ROTATION_SEQUENCE_...; ignored with MIEN_ROTATION_RULE_CARRIED</summary>
    public RotationSequence RotationSequence;
    /// <summary>of the angles about x, y, z. 1: rotates y to z, z to x, x to y. -1: the other way. 0: whichever leaves the angles unchanged</summary>
    public fixed int RotationSigns[3];
    /// <summary>MIEN_FACE_WINDING_...</summary>
    public FaceWinding FaceWinding;
    /// <summary>0</summary>
    public uint Reserved;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienCoordinateSystem Create() {
      return new MienCoordinateSystem { StructSize = (UIntPtr)sizeof(MienCoordinateSystem) };
    }
  }

  /// <summary>What to load of a DNA file, and how.
  ///
  /// A rig converted to another coordinate system moves as before: evaluating it gives the joint values
  /// of the original rig, converted. Raw controls that are components of rotations (read by RBF solvers,
  /// twists or swings as quaternions, or named .qx .qy .qz .qw) are expected in the requested system.
  /// Changes of axes and signs are exact, so converting back restores the original numbers; a change of
  /// units rounds each number once. Texture coordinates and unknown layers are not converted. A converted
  /// rig can be written; the file gets version 2.8 if its own version cannot describe the system.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienDnaDesc {
    public UIntPtr StructSize;
    /// <summary>MIEN_LAYER_..., combined with |; the others are not read. 0: all</summary>
    public Layer Layers;
    /// <summary>load the geometry without blend shape targets</summary>
    public uint SkipBlendShapeTargets;
    /// <summary>MIEN_UNKNOWN_LAYERS_...</summary>
    public UnknownLayers UnknownLayers;
    /// <summary>MIEN_FILE_...; for mien_dna_open_file() only</summary>
    public FileAccess FileAccess;
    /// <summary>bit l keeps LOD l. Kept LODs are renumbered from 0; joints, meshes, channels and maps that none of them uses are dropped, and all indices renumbered. 0: all</summary>
    public ulong Lods;
    /// <summary>convert to this system. NULL: keep the file's own</summary>
    public MienCoordinateSystem* System;
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienDnaDesc Create() {
      return new MienDnaDesc { StructSize = (UIntPtr)sizeof(MienDnaDesc) };
    }
  }

  /// <summary>Properties of an open DNA. Counts are those of the loaded layers and LODs.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienDnaInfo {
    public UIntPtr StructSize;
    /// <summary>2</summary>
    public uint Generation;
    /// <summary>1 to 8: the file is of version 2.version</summary>
    public uint Version;
    /// <summary>MIEN_LAYER_..., combined with |: the loaded layers</summary>
    public Layer Layers;
    /// <summary>the geometry is loaded with its targets</summary>
    public uint HasBlendShapeTargets;
    /// <summary>size of the file</summary>
    public ulong FileBytes;
    /// <summary>memory taken from the allocator</summary>
    public ulong MemoryBytes;
    /// <summary>the file is mapped</summary>
    public uint IsMapped;
    /// <summary>entries for mien_dna_layer()</summary>
    public uint LayerCount;
    /// <summary>MIEN_TRANSLATION_UNIT_...</summary>
    public TranslationUnit TranslationUnit;
    /// <summary>MIEN_ROTATION_UNIT_...</summary>
    public RotationUnit RotationUnit;
    /// <summary>MIEN_DIRECTION_... of x, y, z</summary>
    public fixed uint Axes[3];
    /// <summary>MIEN_ROTATION_SEQUENCE_...</summary>
    public RotationSequence RotationSequence;
    /// <summary>1 or -1, for the angles about x, y, z</summary>
    public fixed int RotationSigns[3];
    /// <summary>MIEN_FACE_WINDING_...</summary>
    public FaceWinding FaceWinding;
    public uint LodCount;
    /// <summary>LOD 0 of this file is LOD max_lod of its database</summary>
    public uint MaxLod;
    public uint GuiControlCount;
    public uint RawControlCount;
    public uint PsdControlCount;
    public uint MlControlCount;
    public uint RbfControlCount;
    public uint JointCount;
    public uint JointGroupCount;
    public uint BlendShapeChannelCount;
    public uint AnimatedMapCount;
    public uint MeshCount;
    public uint NeuralNetworkCount;
    public uint RbfSolverCount;
    public uint RbfPoseCount;
    public uint TwistCount;
    public uint SwingCount;
    /// <summary>pairs desc.metadata[i].key and .value</summary>
    public uint MetadataCount;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienDnaInfo Create() {
      return new MienDnaInfo { StructSize = (UIntPtr)sizeof(MienDnaInfo) };
    }
  }

  /// <summary>An entry of the index table of the file. Files of version 2.1 have no index table; their sections are
  /// listed as the layers desc, defn, bhvr and geom.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienDnaLayer {
    public UIntPtr StructSize;
    /// <summary>MIEN_LAYER_... that loads it. MIEN_LAYER_UNKNOWN: no known kind</summary>
    public Layer Layer;
    /// <summary>of the layer: version_major.version_minor</summary>
    public uint VersionMajor;
    public uint VersionMinor;
    /// <summary>it was parsed, not skipped or kept as bytes</summary>
    public uint IsLoaded;
    /// <summary>of its first byte in the file</summary>
    public ulong ByteOffset;
    public ulong ByteCount;
    /// <summary>such as "bhvr"; null-terminated</summary>
    public fixed byte Code[8];

    /// <summary>All fields zero but StructSize.</summary>
    public static MienDnaLayer Create() {
      return new MienDnaLayer { StructSize = (UIntPtr)sizeof(MienDnaLayer) };
    }
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienDnaField {
    public UIntPtr StructSize;
    /// <summary>MIEN_FIELD_...</summary>
    public FieldType Type;
    /// <summary>an array of numbers, even if it has only one element; not a single number, nor an element of an array</summary>
    public uint IsArray;
    /// <summary>elements of an array or list, bytes of a string, fields of a record; 1 for a number</summary>
    public ulong Count;
    /// <summary>of a string, an array or an element of an array in the file; MIEN_NO_OFFSET: other fields, and data that is not in the file</summary>
    public ulong ByteOffset;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienDnaField Create() {
      return new MienDnaField { StructSize = (UIntPtr)sizeof(MienDnaField) };
    }
  }

  /// <summary>How to write a DNA file. See docs/dna-format.md, 14.3 "Changing the version".</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienWriteDesc {
    public UIntPtr StructSize;
    /// <summary>1 to 8: write version 2.version; layers that it does not define are kept unless unknown_layers drops them, but 2.1 can only hold the layers desc, defn, bhvr and geom. 0: the version of the DNA</summary>
    public uint Version;
    /// <summary>MIEN_UNKNOWN_LAYERS_...</summary>
    public UnknownLayers UnknownLayers;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienWriteDesc Create() {
      return new MienWriteDesc { StructSize = (UIntPtr)sizeof(MienWriteDesc) };
    }
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienFinding {
    public UIntPtr StructSize;
    /// <summary>MIEN_SEVERITY_...</summary>
    public Severity Severity;
    /// <summary>the status of the failure; MIEN_OK for a warning</summary>
    public Status Status;
    /// <summary>where in the file; MIEN_NO_OFFSET: nowhere in particular</summary>
    public ulong ByteOffset;
    /// <summary>path as for mien_dna_field(), or the code of a layer</summary>
    public MienStringView Field;
    /// <summary>what is wrong</summary>
    public MienStringView Message;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienFinding Create() {
      return new MienFinding { StructSize = (UIntPtr)sizeof(MienFinding) };
    }
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienValidateDesc {
    public UIntPtr StructSize;
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienValidateDesc Create() {
      return new MienValidateDesc { StructSize = (UIntPtr)sizeof(MienValidateDesc) };
    }
  }

  /// <summary>Options of a rig. See docs/rig-evaluation.md, 9.4 "Options".</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienRigDesc {
    public UIntPtr StructSize;
    /// <summary>MIEN_ISA_...</summary>
    public Isa Isa;
    /// <summary>MIEN_ROTATION_OUTPUT_...</summary>
    public RotationOutput RotationOutput;
    /// <summary>MIEN_ML_MASKS_...</summary>
    public MlMasks MlMasks;
    /// <summary>MIEN_STORAGE_...</summary>
    public Storage Storage;
    /// <summary>MIEN_REUSE_...</summary>
    public Reuse Reuse;
    /// <summary>MIEN_ARITHMETIC_...</summary>
    public Arithmetic Arithmetic;
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienRigDesc Create() {
      return new MienRigDesc { StructSize = (UIntPtr)sizeof(MienRigDesc) };
    }
  }

  /// <summary>Properties of a rig.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienRigInfo {
    public UIntPtr StructSize;
    /// <summary>MIEN_ISA_... in use, never MIEN_ISA_BEST</summary>
    public Isa Isa;
    public uint LodCount;
    /// <summary>MIEN_TRANSLATION_UNIT_...</summary>
    public TranslationUnit TranslationUnit;
    /// <summary>MIEN_ROTATION_UNIT_...</summary>
    public RotationUnit RotationUnit;
    /// <summary>MIEN_DIRECTION_... of x, y, z</summary>
    public fixed uint Axes[3];
    /// <summary>MIEN_ROTATION_SEQUENCE_...</summary>
    public RotationSequence RotationSequence;
    /// <summary>1 or -1, for the angles about x, y, z</summary>
    public fixed int RotationSigns[3];
    /// <summary>length of the control vector: raw, PSD, ML, RBF controls</summary>
    public uint ControlCount;
    /// <summary>9 or 10 per joint</summary>
    public uint JointValueCount;
    /// <summary>MIEN_ROTATION_OUTPUT_...</summary>
    public RotationOutput RotationOutput;
    /// <summary>MIEN_STORAGE_...</summary>
    public Storage Storage;
    /// <summary>MIEN_ARITHMETIC_...</summary>
    public Arithmetic Arithmetic;
    /// <summary>memory of the rig, including its part of a baked file</summary>
    public ulong RigBytes;
    /// <summary>memory of each instance</summary>
    public ulong InstanceBytes;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienRigInfo Create() {
      return new MienRigInfo { StructSize = (UIntPtr)sizeof(MienRigInfo) };
    }
  }

  /// <summary>The work of an evaluation at a LOD when all controls are active.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienRigStatistics {
    public UIntPtr StructSize;
    public uint Lod;
    /// <summary>correctives computed</summary>
    public uint PsdCount;
    /// <summary>joints of the LOD</summary>
    public uint JointCount;
    /// <summary>rows of the joint groups</summary>
    public uint JointRowCount;
    /// <summary>channels written</summary>
    public uint BlendShapeCount;
    /// <summary>rows of the animated map table</summary>
    public uint AnimatedMapRowCount;
    /// <summary>RBF solvers of the LOD</summary>
    public uint RbfSolverCount;
    /// <summary>quaternion joints</summary>
    public uint QuaternionJointCount;
    /// <summary>stored in the joint matrix: 8 per block that is not all zeros</summary>
    public ulong JointEntryCount;
    /// <summary>of the joint matrix; an evaluation does not read the columns of controls that are 0</summary>
    public ulong JointByteCount;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienRigStatistics Create() {
      return new MienRigStatistics { StructSize = (UIntPtr)sizeof(MienRigStatistics) };
    }
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienInstanceDesc {
    public UIntPtr StructSize;
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienInstanceDesc Create() {
      return new MienInstanceDesc { StructSize = (UIntPtr)sizeof(MienInstanceDesc) };
    }
  }

  /// <summary>What the joint stage reads for the current controls, at the LOD of the last evaluation (initially
  /// LOD 0), if it reuses no results. Each byte is counted once, regardless of CPU caches.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienInstanceStatistics {
    public UIntPtr StructSize;
    /// <summary>of the last evaluation</summary>
    public uint Lod;
    /// <summary>of the control vector: raw, PSD, ML and RBF controls</summary>
    public uint ControlCount;
    /// <summary>controls that are not 0</summary>
    public uint ActiveControlCount;
    /// <summary>columns of the joint matrix that active controls drive</summary>
    public uint JointColumnCount;
    /// <summary>of these columns: 8 per block</summary>
    public ulong JointEntryCount;
    /// <summary>of these entries: at most MienRigStatistics.joint_byte_count</summary>
    public ulong JointByteCount;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienInstanceStatistics Create() {
      return new MienInstanceStatistics { StructSize = (UIntPtr)sizeof(MienInstanceStatistics) };
    }
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienBatchDesc {
    public UIntPtr StructSize;
    /// <summary>instances per call: 1 to 2^20. 0: 32</summary>
    public uint Capacity;
    /// <summary>tasks that may run at the same time, each with its own scratch memory. 0: 1, for calls without MienParallelFor</summary>
    public uint Tasks;
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienBatchDesc Create() {
      return new MienBatchDesc { StructSize = (UIntPtr)sizeof(MienBatchDesc) };
    }
  }

  /// <summary>Options of a deformer.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienDeformerDesc {
    public UIntPtr StructSize;
    /// <summary>MIEN_ISA_...; MIEN_ISA_BEST is that of the rig</summary>
    public Isa Isa;
    /// <summary>MIEN_COMPOSE_...</summary>
    public Compose Compose;
    /// <summary>MIEN_WEIGHTS_...</summary>
    public Weights Weights;
    /// <summary>MIEN_NORMALS_...: what MIEN_NORMALS_DEFAULT means for this deformer</summary>
    public Normals Normals;
    /// <summary>compute tangents, for mien_deformer_instance_write_vertices()</summary>
    public uint WithTangents;
    /// <summary>MIEN_STORAGE_... of blend shape deltas, skin weights, texture coordinates and triangles. With 16 bits these are integers with scales, and triangles follow from faces. See docs/deformation.md, 2.1 "16-bit storage"</summary>
    public Storage Storage;
    public MienAllocator* Allocator;
    /// <summary>largest rounding error of a coordinate of a delta that 16-bit storage may make to store deltas with 10 bits, in translation units. 0: 2^-18 of the size of the mesh, which is also the least</summary>
    public double DeltaError;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienDeformerDesc Create() {
      return new MienDeformerDesc { StructSize = (UIntPtr)sizeof(MienDeformerDesc) };
    }
  }

  /// <summary>Properties of a deformer.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienDeformerInfo {
    public UIntPtr StructSize;
    /// <summary>MIEN_ISA_... in use, never MIEN_ISA_BEST</summary>
    public Isa Isa;
    /// <summary>MIEN_COMPOSE_...</summary>
    public Compose Compose;
    /// <summary>MIEN_WEIGHTS_...</summary>
    public Weights Weights;
    /// <summary>MIEN_NORMALS_..., never MIEN_NORMALS_DEFAULT</summary>
    public Normals Normals;
    public uint LodCount;
    public uint JointCount;
    public uint ChannelCount;
    /// <summary>same as in the rig, which has their names: MIEN_KIND_MESH</summary>
    public uint MeshCount;
    /// <summary>memory of the deformer, including its part of a baked file</summary>
    public ulong DeformerBytes;
    /// <summary>memory of a deformer instance for all meshes</summary>
    public ulong InstanceBytes;
    /// <summary>MIEN_STORAGE_...</summary>
    public Storage Storage;
    /// <summary>0</summary>
    public uint Reserved;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienDeformerInfo Create() {
      return new MienDeformerInfo { StructSize = (UIntPtr)sizeof(MienDeformerInfo) };
    }
  }

  /// <summary>A neutral mesh. Its views are valid until the deformer is destroyed.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienMesh {
    public UIntPtr StructSize;
    public uint PositionCount;
    public uint VertexCount;
    public uint TriangleCount;
    /// <summary>of one position</summary>
    public uint MaxInfluences;
    /// <summary>blend shape targets</summary>
    public uint TargetCount;
    /// <summary>of all targets</summary>
    public uint DeltaCount;
    /// <summary>bit l: LOD l shows this mesh</summary>
    public ulong Lods;
    /// <summary>3 floats per position: x y z</summary>
    public MienFloatView Positions;
    /// <summary>3 floats per vertex: x y z, unit length</summary>
    public MienFloatView Normals;
    /// <summary>4 floats per vertex: x y z w, see MienVertexOutput; empty unless MienDeformerDesc.with_tangents was set</summary>
    public MienFloatView Tangents;
    /// <summary>2 floats per vertex: u v, as in the file; may be empty with 16-bit storage: see mien_deformer_texture_coordinates()</summary>
    public MienFloatView TextureCoordinates;
    /// <summary>one index per vertex: its position</summary>
    public MienIndex32View VertexPositionIndices;
    /// <summary>3 indices per triangle: vertices, wound as in the file; faces with more corners become fans about their first corner. May be empty with 16-bit storage: see mien_deformer_triangles()</summary>
    public MienIndex32View Triangles;
    /// <summary>one index per target: its blend shape channel; in file order</summary>
    public MienIndex16View TargetChannels;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienMesh Create() {
      return new MienMesh { StructSize = (UIntPtr)sizeof(MienMesh) };
    }
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienDeformerInstanceDesc {
    public UIntPtr StructSize;
    /// <summary>take memory for the meshes of these LODs only: bit l is LOD l. LODs that do not exist are ignored. 0: for all meshes</summary>
    public ulong Lods;
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienDeformerInstanceDesc Create() {
      return new MienDeformerInstanceDesc { StructSize = (UIntPtr)sizeof(MienDeformerInstanceDesc) };
    }
  }

  /// <summary>One attribute of all vertices: vertex i is written at data + i * stride. `data` and `stride` are
  /// multiples of 4; `stride` is at least the size of the format.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienVertexStream {
    /// <summary>NULL: the attribute is not written</summary>
    public void* Data;
    /// <summary>in bytes</summary>
    public uint Stride;
    /// <summary>MIEN_VERTEX_FORMAT_...</summary>
    public VertexFormat Format;
  }

  /// <summary>Where to write the vertices of a mesh, in the order of MienMesh.vertex_position_indices. Streams may
  /// be interleaved (with the same stride) or separate, but must not share bytes. At least one is needed.
  ///
  ///   positions  as floats; w is 1
  ///   normals    in any format; w is 0
  ///   tangents   in any format with w. The tangent points along the surface in the direction of growing u
  ///              at constant v, perpendicular to the normal; w * cross(normal, tangent) points in the
  ///              direction of growing v. w is 1, or -1 where the texture is mirrored. If you flip v (1 - v),
  ///              negate w.
  ///
  /// Neutral tangents are computed as by MikkTSpace, except that vertices are never split: where triangles
  /// of both orientations meet, a vertex takes the orientation with the larger sum of angles. A vertex
  /// without texture coordinates gets an arbitrary, but reproducible, perpendicular of its normal and
  /// w = 1. Tangents are skinned, and then made perpendicular to the written normal.
  /// See docs/deformation.md, 4 "Tangents".</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienVertexOutput {
    public UIntPtr StructSize;
    /// <summary>of each stream: at least MienMesh.vertex_count</summary>
    public UIntPtr VertexCapacity;
    public MienVertexStream Positions;
    public MienVertexStream Normals;
    /// <summary>requires MienDeformerDesc.with_tangents</summary>
    public MienVertexStream Tangents;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienVertexOutput Create() {
      return new MienVertexOutput { StructSize = (UIntPtr)sizeof(MienVertexOutput) };
    }
  }

  /// <summary>How to create derivatives.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienDerivativesDesc {
    public UIntPtr StructSize;
    /// <summary>of the rig. NULL: none, and no points from LOCALS to POSITIONS</summary>
    public IntPtr Deformer;
    /// <summary>NULL: the heap</summary>
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienDerivativesDesc Create() {
      return new MienDerivativesDesc { StructSize = (UIntPtr)sizeof(MienDerivativesDesc) };
    }
  }

  /// <summary>Which matrix.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienJacobianDesc {
    public UIntPtr StructSize;
    /// <summary>MIEN_POINT_...: of the columns</summary>
    public Point FromPoint;
    /// <summary>MIEN_POINT_...: of the rows</summary>
    public Point ToPoint;
    /// <summary>the mesh of MIEN_POINT_POSITIONS, else 0</summary>
    public uint Mesh;
    /// <summary>of the evaluations: entries that other LODs add are left out</summary>
    public uint Lod;
    /// <summary>numbers at from_point, one per column. NULL: all</summary>
    public uint* Inputs;
    /// <summary>numbers at to_point, one per row, ascending. NULL: all</summary>
    public uint* Outputs;
    /// <summary>0 if `inputs` is NULL</summary>
    public UIntPtr InputCount;
    /// <summary>0 if `outputs` is NULL</summary>
    public UIntPtr OutputCount;
    /// <summary>NULL: the heap</summary>
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienJacobianDesc Create() {
      return new MienJacobianDesc { StructSize = (UIntPtr)sizeof(MienJacobianDesc) };
    }
  }

  /// <summary>The entries of a matrix: by column, then by row.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienJacobianPattern {
    public UIntPtr StructSize;
    /// <summary>of each entry: a place in MienJacobianDesc.outputs, or a number at to_point</summary>
    public MienIndex32View Rows;
    /// <summary>of each entry: a place in MienJacobianDesc.inputs, or a number at from_point</summary>
    public MienIndex32View Columns;
    /// <summary>rows and columns of the matrix, with or without entries</summary>
    public UIntPtr RowCount;
    public UIntPtr ColumnCount;
    /// <summary>directions that compute all columns: the colors of a coloring</summary>
    public UIntPtr DirectionCount;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienJacobianPattern Create() {
      return new MienJacobianPattern { StructSize = (UIntPtr)sizeof(MienJacobianPattern) };
    }
  }

  /// <summary>How to open a baked file.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienBakedDesc {
    public UIntPtr StructSize;
    /// <summary>MIEN_FILE_...; MIEN_FILE_READ also copies bytes in memory</summary>
    public FileAccess FileAccess;
    /// <summary>MIEN_BAKED_CHECK_...</summary>
    public BakedCheck Check;
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienBakedDesc Create() {
      return new MienBakedDesc { StructSize = (UIntPtr)sizeof(MienBakedDesc) };
    }
  }

  /// <summary>Properties of an open baked file.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienBakedInfo {
    public UIntPtr StructSize;
    /// <summary>size of the file</summary>
    public ulong FileBytes;
    /// <summary>memory taken from the allocator</summary>
    public ulong MemoryBytes;
    /// <summary>size of the rig in the file. 0: it has none</summary>
    public ulong RigBytes;
    /// <summary>size of the deformer in the file. 0: it has none</summary>
    public ulong DeformerBytes;
    /// <summary>parts of the file, including unknown ones</summary>
    public uint PartCount;
    /// <summary>the file is mapped</summary>
    public uint IsMapped;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienBakedInfo Create() {
      return new MienBakedInfo { StructSize = (UIntPtr)sizeof(MienBakedInfo) };
    }
  }

  /// <summary>Options of a rig that are not part of a baked file.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienBakedRigDesc {
    public UIntPtr StructSize;
    /// <summary>MIEN_ISA_...</summary>
    public Isa Isa;
    /// <summary>MIEN_REUSE_...</summary>
    public Reuse Reuse;
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienBakedRigDesc Create() {
      return new MienBakedRigDesc { StructSize = (UIntPtr)sizeof(MienBakedRigDesc) };
    }
  }

  /// <summary>Options of a deformer that are not part of a baked file.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienBakedDeformerDesc {
    public UIntPtr StructSize;
    /// <summary>MIEN_ISA_...; MIEN_ISA_BEST is that of the rig</summary>
    public Isa Isa;
    /// <summary>MIEN_NORMALS_...: what MIEN_NORMALS_DEFAULT means for this deformer; in this field MIEN_NORMALS_DEFAULT keeps the setting of the baked deformer</summary>
    public Normals Normals;
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienBakedDeformerDesc Create() {
      return new MienBakedDeformerDesc { StructSize = (UIntPtr)sizeof(MienBakedDeformerDesc) };
    }
  }

  /// <summary>A named moment of a clip, such as a phoneme. In speech layers, events named "close:lips",
  /// "close:lip-to-teeth" and "close:teeth" activate the matching guards of the mixer for `value` seconds.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienClipEvent {
    public long Tick;
    public MienStringView Name;
    public float Value;
    /// <summary>0</summary>
    public uint Reserved;
  }

  /// <summary>What to build a clip from.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienClipDesc {
    public UIntPtr StructSize;
    /// <summary>frames per second, as a fraction. 0: 60</summary>
    public uint RateNumerator;
    /// <summary>0: 1</summary>
    public uint RateDenominator;
    /// <summary>1 to 2^28</summary>
    public uint FrameCount;
    /// <summary>at most 65535, of which at most 512 may change over time</summary>
    public uint ChannelCount;
    /// <summary>one per channel, all different, not empty</summary>
    public MienStringView* Names;
    /// <summary>channel c of frame f is values[f * frame_stride + c]</summary>
    public float* Values;
    /// <summary>floats from frame to frame. 0: channel_count</summary>
    public UIntPtr FrameStride;
    /// <summary>one per channel, used instead of `snap`; may be NULL</summary>
    public float* Snaps;
    /// <summary>0: values keep all bits. 2^-9, 2^-10 ... 2^-16: values are rounded to multiples of this step, which makes the clip several times smaller</summary>
    public float Snap;
    /// <summary>MIEN_LOOPING_...</summary>
    public Looping Looping;
    /// <summary>a delta clip, whose values are added to other values</summary>
    public uint IsDelta;
    public uint EventCount;
    /// <summary>in any order; 0 &lt;= tick &lt; frame_count * ticks per frame</summary>
    public MienClipEvent* Events;
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienClipDesc Create() {
      return new MienClipDesc { StructSize = (UIntPtr)sizeof(MienClipDesc) };
    }
  }

  /// <summary>How to open a clip.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienClipOpenDesc {
    public UIntPtr StructSize;
    /// <summary>MIEN_FILE_...; no effect on memory and streams</summary>
    public FileAccess FileAccess;
    /// <summary>0</summary>
    public uint Reserved;
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienClipOpenDesc Create() {
      return new MienClipOpenDesc { StructSize = (UIntPtr)sizeof(MienClipOpenDesc) };
    }
  }

  /// <summary>Properties of a clip.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienClipInfo {
    public UIntPtr StructSize;
    /// <summary>frames per second, as a fraction</summary>
    public uint RateNumerator;
    public uint RateDenominator;
    public uint FrameCount;
    public uint ChannelCount;
    /// <summary>channels whose value is not the same in all frames</summary>
    public uint ChangingChannelCount;
    public uint EventCount;
    /// <summary>MIEN_LOOPING_CLAMP or MIEN_LOOPING_WRAP</summary>
    public Looping Looping;
    /// <summary>as in MienClipDesc</summary>
    public uint IsDelta;
    /// <summary>largest step to which a channel was rounded. 0: none was</summary>
    public float Snap;
    /// <summary>the file is mapped</summary>
    public uint IsMapped;
    public long TicksPerFrame;
    /// <summary>ticks</summary>
    public long Length;
    /// <summary>size of the clip</summary>
    public ulong FileBytes;
    /// <summary>memory taken from the allocator</summary>
    public ulong MemoryBytes;
    /// <summary>memory of a player without MienClipPlayerDesc.reverse</summary>
    public ulong PlayerBytes;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienClipInfo Create() {
      return new MienClipInfo { StructSize = (UIntPtr)sizeof(MienClipInfo) };
    }
  }

  /// <summary>A channel of a clip. Block counts, bits and max_error are only known for a clip from
  /// mien_clip_build(); they are 0 for a clip that was opened.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienClipChannel {
    public UIntPtr StructSize;
    public MienStringView Name;
    /// <summary>value of a channel that does not change; otherwise 0</summary>
    public float Rest;
    /// <summary>the channel has a curve</summary>
    public uint IsChanging;
    /// <summary>blocks of 64 frames that are zero</summary>
    public uint ZeroBlocks;
    /// <summary>blocks with one other value</summary>
    public uint ConstantBlocks;
    /// <summary>blocks whose values are multiples of a decimal or binary fraction</summary>
    public uint GridBlocks;
    /// <summary>other blocks</summary>
    public uint FloatBlocks;
    /// <summary>of all blocks</summary>
    public ulong Bits;
    /// <summary>largest error of rounding to a step</summary>
    public float MaxError;
    /// <summary>0</summary>
    public uint Reserved;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienClipChannel Create() {
      return new MienClipChannel { StructSize = (UIntPtr)sizeof(MienClipChannel) };
    }
  }

  /// <summary>How to play a clip.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienClipPlayerDesc {
    public UIntPtr StructSize;
    /// <summary>MIEN_LOOPING_...</summary>
    public Looping Looping;
    /// <summary>MIEN_INTERPOLATION_...</summary>
    public Interpolation Interpolation;
    /// <summary>speed, as a fraction; negative plays backward. -2^20 to 2^20</summary>
    public int SpeedNumerator;
    /// <summary>1 to 2^20. Both 0: 1 / 1</summary>
    public int SpeedDenominator;
    /// <summary>initial position, as for mien_clip_player_seek()</summary>
    public long StartTick;
    /// <summary>backward playback costs no more than forward; takes 256 more bytes per changing channel</summary>
    public uint Reverse;
    /// <summary>0</summary>
    public uint Reserved;
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienClipPlayerDesc Create() {
      return new MienClipPlayerDesc { StructSize = (UIntPtr)sizeof(MienClipPlayerDesc) };
    }
  }

  /// <summary>State of a player.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienClipPlayerInfo {
    public UIntPtr StructSize;
    /// <summary>0 to the length of the clip; with MIEN_LOOPING_WRAP less than the length</summary>
    public long Tick;
    /// <summary>loops completed since creation or the last seek, at most 2^61; negative: backward</summary>
    public long Loops;
    /// <summary>MIEN_LOOPING_CLAMP or MIEN_LOOPING_WRAP</summary>
    public Looping Looping;
    /// <summary>a damaged curve was played, as zeros</summary>
    public uint IsDamaged;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienClipPlayerInfo Create() {
      return new MienClipPlayerInfo { StructSize = (UIntPtr)sizeof(MienClipPlayerInfo) };
    }
  }

  /// <summary>Adds weight * value of a channel to a raw or GUI control.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienMatrixEntry {
    public MienStringView Channel;
    public MienStringView Control;
    public float Weight;
    /// <summary>0</summary>
    public uint Reserved;
  }

  /// <summary>How to bind a clip.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienClipBindingDesc {
    public UIntPtr StructSize;
    /// <summary>for channels whose names the rig does not have; may be NULL: those that mien_rig_match() knows need none</summary>
    public MienMatrixEntry* Matrix;
    public UIntPtr MatrixCount;
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienClipBindingDesc Create() {
      return new MienClipBindingDesc { StructSize = (UIntPtr)sizeof(MienClipBindingDesc) };
    }
  }

  /// <summary>What a binding found. Indices are ascending.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienClipBindingInfo {
    public UIntPtr StructSize;
    /// <summary>channels of the clip</summary>
    public uint ChannelCount;
    /// <summary>raw controls of the rig</summary>
    public uint RawControlCount;
    /// <summary>matrix entries whose channel or control does not exist</summary>
    public uint MissingEntryCount;
    /// <summary>0</summary>
    public uint Reserved;
    /// <summary>raw controls that are driven</summary>
    public MienIndex16View Controls;
    /// <summary>raw controls that are not driven</summary>
    public MienIndex16View ExtraControls;
    /// <summary>channels that drive nothing: the rig has no such name, or an earlier channel drives the same control</summary>
    public MienIndex16View MissingChannels;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienClipBindingInfo Create() {
      return new MienClipBindingInfo { StructSize = (UIntPtr)sizeof(MienClipBindingInfo) };
    }
  }

  /// <summary>A layer of a mix. Leave the fields that its source does not use at zero.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienMixLayer {
    /// <summary>of a generator, ticks</summary>
    public long Period;
    /// <summary>of a stream, ticks: rows are played this much later than their times</summary>
    public long Delay;
    /// <summary>one per curve, 0 to 1; curves beyond mask_count have 0. NULL: 1 for all</summary>
    public float* Mask;
    /// <summary>the curve of each channel of a stream, or the curves of a generator</summary>
    public ushort* Curves;
    /// <summary>one per curve of a generator: a factor for its value</summary>
    public float* Amounts;
    public uint MaskCount;
    public uint CurveCount;
    /// <summary>MIEN_LAYER_GROUP_...</summary>
    public LayerGroup Group;
    /// <summary>MIEN_BLEND_MODE_...</summary>
    public BlendMode Mode;
    /// <summary>MIEN_LAYER_SOURCE_...</summary>
    public LayerSource Source;
    /// <summary>acts after the guards; not allowed for base and speech</summary>
    public uint AfterGuards;
    /// <summary>initial weight. 0 to 1; -1 to 1 with MIEN_BLEND_MODE_ADD</summary>
    public float Weight;
    /// <summary>index of its first pose in MienMixDesc.poses</summary>
    public uint FirstPose;
    public uint PoseCount;
    /// <summary>MIEN_GENERATOR_...</summary>
    public Generator Generator;
    /// <summary>capacity of a stream's queue, in rows. 0: 64; otherwise 2 to 1024</summary>
    public uint StreamFrames;
    /// <summary>0</summary>
    public uint Reserved;
  }

  /// <summary>A pose: the curves that it moves, and their values.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienMixPose {
    public ushort* Curves;
    public float* Values;
    public UIntPtr Count;
  }

  /// <summary>A part of a reaction: moves the curves of a pose to its values and back to 0. Times are in ticks.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienMixStroke {
    /// <summary>after the trigger</summary>
    public long Delay;
    /// <summary>time to reach strength * pose</summary>
    public long Attack;
    /// <summary>time after the attack; ignored if is_held</summary>
    public long Hold;
    /// <summary>time to return to 0</summary>
    public long Release;
    /// <summary>index in MienMixDesc.poses</summary>
    public uint Pose;
    /// <summary>MIEN_BLEND_MODE_...</summary>
    public BlendMode Mode;
    /// <summary>holds as long as the stimulus lasts, and adapts unless is_lag</summary>
    public uint IsHeld;
    /// <summary>moves exponentially; attack and release are time constants</summary>
    public uint IsLag;
    /// <summary>scaled by the level of the reaction, which is 1 if mien_mixer_trigger() started it</summary>
    public uint IsScaled;
    /// <summary>0</summary>
    public uint Reserved;
  }

  /// <summary>The response of a face to a stimulus, such as a bright light.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienMixReaction {
    /// <summary>ticks; minimum time between two starts of strokes that are not held</summary>
    public long Cooldown;
    /// <summary>time constant of adaptation to a lasting stimulus</summary>
    public long AdaptTicks;
    /// <summary>time constant of recovery after the stimulus</summary>
    public long RecoverTicks;
    /// <summary>at most 8</summary>
    public MienMixStroke* Strokes;
    public UIntPtr StrokeCount;
    /// <summary>MIEN_RETRIGGER_...</summary>
    public Retrigger Retrigger;
    /// <summary>acts after the guards</summary>
    public uint AfterGuards;
    /// <summary>share of the strength that remains after full adaptation; 1: all</summary>
    public float Adapted;
    /// <summary>levels of this or more are a stimulus: mien_mixer_set_level(). 0: the reaction takes no levels</summary>
    public float LevelOn;
    /// <summary>the stimulus ends below this; at most level_on</summary>
    public float LevelOff;
    /// <summary>0</summary>
    public uint Reserved;
  }

  /// <summary>Two curves that move the face in opposite directions. If both are above 0, the smaller one times
  /// stiffness is subtracted from both.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienMixAntagonists {
    public ushort First;
    public ushort Second;
    /// <summary>0 to 1</summary>
    public float Stiffness;
  }

  /// <summary>A point of the face: the mean of some positions of a mesh that LOD 0 shows, or of some joints.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienLandmark {
    /// <summary>indices of positions of the mesh, or of joints</summary>
    public uint* Points;
    /// <summary>1 to 65536</summary>
    public uint PointCount;
    /// <summary>index of the mesh. MIEN_NO_MESH: the points are joints</summary>
    public uint Mesh;
  }

  /// <summary>A guard with landmarks of the caller. It keeps the gap between them, the height of `upper` above `lower`
  /// along the axis that points up, from being opened.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienMixGuard {
    public MienLandmark Upper;
    public MienLandmark Lower;
    /// <summary>raw control that closes the gap at 1. MIEN_NO_CONTROL: it is closed at rest</summary>
    public uint ClosedBy;
    /// <summary>acts at most as much as the largest weight of a speech layer</summary>
    public uint NeedsSpeech;
    /// <summary>millimeters by which later layers may open the gap, 0 or more; 0.3 for built-in guards</summary>
    public float Tolerance;
    /// <summary>millimeters, above 0: acts if base and speech leave a smaller gap, fully at 0. Built-in guards: 12 for lips, 6 for lids, 4 for teeth</summary>
    public float FOn;
  }

  /// <summary>What to mix. Everything is copied.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienMixDesc {
    public UIntPtr StructSize;
    /// <summary>at most 16</summary>
    public MienMixLayer* Layers;
    public UIntPtr LayerCount;
    /// <summary>at most 1024; used by layers and strokes</summary>
    public MienMixPose* Poses;
    public UIntPtr PoseCount;
    /// <summary>at most 16</summary>
    public MienMixReaction* Reactions;
    public UIntPtr ReactionCount;
    public MienMixAntagonists* Antagonists;
    public UIntPtr AntagonistCount;
    /// <summary>for each curve its counterpart in the other half of the face, or itself. NULL: clips cannot be played mirrored</summary>
    public ushort* Mirror;
    /// <summary>limits per curve. NULL: none; both or neither</summary>
    public float* Lower;
    public float* Upper;
    /// <summary>numbered after the built-in ones; at most 8 guards in total</summary>
    public MienMixGuard* CustomGuards;
    public UIntPtr CustomGuardCount;
    /// <summary>for a layer with MIEN_GENERATOR_GAZE; may be NULL</summary>
    public IntPtr Gaze;
    /// <summary>to measure guards; may be NULL if there are none</summary>
    public IntPtr Deformer;
    /// <summary>MIEN_GUARD_... bits; a guard is left out if the rig lacks its landmarks</summary>
    public Guard Guards;
    /// <summary>pose variables; at most 4096 curves with the raw controls</summary>
    public uint VariableCount;
    /// <summary>clips that can play at the same time; a crossfade needs two. 0: two for each clip layer</summary>
    public uint PlayerCount;
    /// <summary>of any clip. 0: the number of raw controls</summary>
    public uint MaxChannels;
    /// <summary>of any clip. 0: max_channels, 512 at most</summary>
    public uint MaxChangingChannels;
    /// <summary>events that one step can report. 0: 64</summary>
    public uint MaxEvents;
    /// <summary>as in MienClipPlayerDesc</summary>
    public uint Reverse;
    /// <summary>0</summary>
    public uint Reserved;
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienMixDesc Create() {
      return new MienMixDesc { StructSize = (UIntPtr)sizeof(MienMixDesc) };
    }
  }

  /// <summary>How to open a mix.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienMixOpenDesc {
    public UIntPtr StructSize;
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienMixOpenDesc Create() {
      return new MienMixOpenDesc { StructSize = (UIntPtr)sizeof(MienMixOpenDesc) };
    }
  }

  /// <summary>Properties of a mix.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienMixInfo {
    public UIntPtr StructSize;
    public uint RawControlCount;
    public uint VariableCount;
    /// <summary>raw controls and pose variables</summary>
    public uint CurveCount;
    public uint LayerCount;
    /// <summary>for mien_mixer_stage()</summary>
    public uint StageCount;
    /// <summary>for mien_mixer_set_guard()</summary>
    public uint GuardCount;
    /// <summary>memory of a mixer without MienMixerDesc.stages</summary>
    public ulong MixerBytes;
    /// <summary>size of a snapshot</summary>
    public ulong SnapshotBytes;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienMixInfo Create() {
      return new MienMixInfo { StructSize = (UIntPtr)sizeof(MienMixInfo) };
    }
  }

  /// <summary>A guard of a mix, as it was measured: the distance in millimeters is `rest`, plus the sum of gain * curve,
  /// plus a sum over pairs of curves that share a corrective. See docs/mixing.md, 4 "Guards".</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienMixGuardInfo {
    public UIntPtr StructSize;
    /// <summary>raw controls that change the distance, by descending gain</summary>
    public MienIndex16View Curves;
    /// <summary>1 float per curve: millimeters at value 1</summary>
    public MienFloatView Gains;
    public uint PairCount;
    /// <summary>as in MienMixGuard</summary>
    public uint NeedsSpeech;
    /// <summary>distance of a row of zeros</summary>
    public float Rest;
    /// <summary>as in MienMixGuard</summary>
    public float Tolerance;
    public float FOn;
    /// <summary>millimeters, root mean square over the measured rows</summary>
    public float FitError;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienMixGuardInfo Create() {
      return new MienMixGuardInfo { StructSize = (UIntPtr)sizeof(MienMixGuardInfo) };
    }
  }

  /// <summary>How to create a gaze.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienGazeDesc {
    public UIntPtr StructSize;
    /// <summary>name of a joint. NULL: L_Eye or FACIAL_L_Eye</summary>
    public byte* LeftEye;
    /// <summary>name of a joint. NULL: R_Eye or FACIAL_R_Eye</summary>
    public byte* RightEye;
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienGazeDesc Create() {
      return new MienGazeDesc { StructSize = (UIntPtr)sizeof(MienGazeDesc) };
    }
  }

  /// <summary>A point in millimeters from the origin of the rig's model space, with the head in its neutral pose.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienGazeTarget {
    public float Left;
    public float Up;
    public float Front;
  }

  /// <summary>What was measured on the eyes.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienGazeInfo {
    public UIntPtr StructSize;
    /// <summary>center of rotation</summary>
    public MienGazeTarget LeftEye;
    public MienGazeTarget RightEye;
    /// <summary>degrees, largest error found when an eye turns sideways and up at once</summary>
    public float FitError;
    /// <summary>0</summary>
    public uint Reserved;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienGazeInfo Create() {
      return new MienGazeInfo { StructSize = (UIntPtr)sizeof(MienGazeInfo) };
    }
  }

  /// <summary>The part of a gaze that the eyes cannot reach, left for the head to turn: tangents of angles, averaged
  /// over both eyes.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienGazeRest {
    public float Left;
    public float Up;
  }

  /// <summary>How to create a mixer.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienMixerDesc {
    public UIntPtr StructSize;
    /// <summary>of the generators</summary>
    public ulong Seed;
    /// <summary>keep the row after each stage, for mien_mixer_stage()</summary>
    public uint Stages;
    /// <summary>0</summary>
    public uint Reserved;
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienMixerDesc Create() {
      return new MienMixerDesc { StructSize = (UIntPtr)sizeof(MienMixerDesc) };
    }
  }

  /// <summary>How to play a clip in a layer.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienPlayDesc {
    public UIntPtr StructSize;
    /// <summary>chosen by the caller, to identify clip and binding in mien_mixer_restore()</summary>
    public ulong ClipId;
    /// <summary>in the clip</summary>
    public long StartTick;
    /// <summary>0 to 2^40</summary>
    public long TransitionTicks;
    /// <summary>MIEN_TRANSITION_...</summary>
    public Transition Transition;
    /// <summary>MIEN_LOOPING_...</summary>
    public Looping Looping;
    /// <summary>MIEN_INTERPOLATION_...</summary>
    public Interpolation Interpolation;
    /// <summary>as in MienClipPlayerDesc</summary>
    public int SpeedNumerator;
    public int SpeedDenominator;
    /// <summary>; requires MienMixDesc.mirror</summary>
    public uint Mirrored;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienPlayDesc Create() {
      return new MienPlayDesc { StructSize = (UIntPtr)sizeof(MienPlayDesc) };
    }
  }

  /// <summary>What a guard did in the last step. Distances are in millimeters, computed by the function of raw controls
  /// that was measured on the rig; a negative distance means that both sides overlap.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienGuardState {
    public UIntPtr StructSize;
    /// <summary>"lips left", "lips center", "lips right", "teeth", "lower lip to teeth", "left lids", "right lids" or "custom"</summary>
    public MienStringView Name;
    /// <summary>raw controls that it may hold back</summary>
    public MienIndex16View Controls;
    /// <summary>MIEN_GUARD_...; 0: one of MienMixDesc.custom_guards</summary>
    public Guard Kind;
    /// <summary>how much it acted, 0 to 1</summary>
    public float Activation;
    /// <summary>distance after the last layer of base and speech</summary>
    public float ProtectedDistance;
    /// <summary>distance just before the guards, after the later layers and reactions</summary>
    public float Wanted;
    /// <summary>largest distance that the guard allows when fully active</summary>
    public float Limit;
    /// <summary>distance after the guards: above `limit` if the guard is not fully active, while it eases in, or if other controls open the gap</summary>
    public float Distance;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienGuardState Create() {
      return new MienGuardState { StructSize = (UIntPtr)sizeof(MienGuardState) };
    }
  }

  /// <summary>State of a mixer.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienMixerInfo {
    public UIntPtr StructSize;
    /// <summary>time since creation</summary>
    public long Tick;
    /// <summary>clip events that the last step passed</summary>
    public uint EventCount;
    /// <summary>there were more than MienMixDesc.max_events</summary>
    public uint LostEvents;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienMixerInfo Create() {
      return new MienMixerInfo { StructSize = (UIntPtr)sizeof(MienMixerInfo) };
    }
  }

  /// <summary>A clip that mien_mixer_restore() may need.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienMixerClip {
    /// <summary>as in MienPlayDesc</summary>
    public ulong ClipId;
    public IntPtr Clip;
    public IntPtr ClipBinding;
  }

  /// <summary>Aim constraint: turns a joint so that one of its axes points at a target, by the shortest rotation, then
  /// about that axis so that `up_axis` comes as near to `up` as possible. Directions may have any length.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienAimSolver {
    public uint Joint;
    /// <summary>its position is the target. MIEN_NO_JOINT: three curves of the row are</summary>
    public uint TargetJoint;
    /// <summary>first of these three: x y z in model space</summary>
    public uint TargetCurve;
    /// <summary>aim axis, in the space of the joint; not 0 0 0</summary>
    public fixed float Axis[3];
    /// <summary>in the space of the joint; 0 0 0: no rotation about the aim axis</summary>
    public fixed float UpAxis[3];
    /// <summary>in model space; 0 0 0: 0 1 0</summary>
    public fixed float Up[3];
    /// <summary>0 to 180: largest angle from the neutral direction. 0: no limit</summary>
    public float ConeDegrees;
    /// <summary>0 to 1</summary>
    public float Weight;
  }

  /// <summary>Space switch: moves a joint as if its parent were attached to another joint. A curve selects one of the
  /// spaces. When it changes, the joint stays where it is, and the difference to the new space eases out.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienSpaceSolver {
    /// <summary>0 to 2^40</summary>
    public long EaseTicks;
    /// <summary>indices of joints. MIEN_NO_JOINT: model space</summary>
    public ushort* Spaces;
    /// <summary>1 to 8</summary>
    public uint SpaceCount;
    /// <summary>of the row: its value, rounded, is an index in `spaces`</summary>
    public uint Curve;
    public uint Joint;
    /// <summary>0</summary>
    public uint Reserved;
  }

  /// <summary>Spring: lets the position of a joint swing about its position in the pose. It is a damped harmonic
  /// oscillator in model space, advanced by its exact solution, so it is stable for any time step. Output 0 is
  /// its speed, in translation units per second.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienSpringSolver {
    public uint Joint;
    /// <summary>of the undamped spring, in Hertz; above 0</summary>
    public float Frequency;
    /// <summary>damping ratio, 0 or more; 1 is critical damping</summary>
    public float Damping;
    /// <summary>rest position relative to the position in the pose, in model space</summary>
    public fixed float RestOffset[3];
    /// <summary>largest distance from the rest position. 0: no limit</summary>
    public float Stretch;
    /// <summary>if the rest position jumps farther than this in a step, the joint jumps with it. 0: never</summary>
    public float Teleport;
  }

  /// <summary>Twist distribution: gives joints a share of another joint's twist about an axis, in place of their own
  /// twist. Output 0 is the sine of half the angle.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienTwistSolver {
    public ushort* Joints;
    /// <summary>one for each of these joints, -1 to 1; 0.5 is half the angle</summary>
    public float* Shares;
    /// <summary>1 to 8</summary>
    public uint JointCount;
    /// <summary>the joint whose twist is distributed</summary>
    public uint Source;
    /// <summary>in the space of the source and of each joint; not 0 0 0</summary>
    public fixed float Axis[3];
    /// <summary>0</summary>
    public uint Reserved;
  }

  /// <summary>Copy: gives a joint the motion of another joint relative to its neutral pose, or the mirrored motion.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienCopySolver {
    /// <summary>the joint whose motion is copied</summary>
    public uint Source;
    public uint Joint;
    /// <summary>mirror the motion</summary>
    public uint IsMirrored;
    /// <summary>from right to left in model space; 0 0 0: 1 0 0</summary>
    public fixed float MirrorAxis[3];
    /// <summary>0 to 1</summary>
    public float Weight;
  }

  /// <summary>The data of one character that a MienUserSolver gets.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienSolverPose {
    /// <summary>10 floats per joint: tx ty tz qx qy qz qw sx sy sz, relative to the parent. Joints in `writes` may be changed; quaternions of any length but 0</summary>
    public float* Locals;
    /// <summary>16 floats per joint, as in mien_deformer_instance_joint_matrices(); up to date for joints in `reads`</summary>
    public float* Models;
    /// <summary>16 floats for each joint in `previous_joints`, as the last step left it</summary>
    public float* Previous;
    /// <summary>MienSolverStackDesc.curve_count floats. NULL: there are none</summary>
    public float* Row;
    /// <summary>MienUserSolver.output_count floats for the caller to read</summary>
    public float* Outputs;
    /// <summary>MienUserSolver.state_bytes bytes, aligned to 8; initially zero</summary>
    public void* State;
    public uint Lod;
    /// <summary>the first step, or the character was teleported</summary>
    public uint IsReset;
  }

  /// <summary>The argument of a MienUserSolver.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienSolverCall {
    /// <summary>one for each of at most 64 characters</summary>
    public MienSolverPose* Poses;
    /// <summary>one per joint; a root is its own parent</summary>
    public ushort* Parents;
    /// <summary>since the last step</summary>
    public long Ticks;
    public uint PoseCount;
    public uint JointCount;
  }

  /// <summary>A custom solver. It runs on the thread that calls the step function, and must not use the handles passed
  /// to that function.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienUserSolver {
    /// <summary>passed to the function; must live as long as the stack and its states</summary>
    public void* User;
    /// <summary>Changes the locals of the characters in `call`, and their outputs and state, but nothing else.</summary>
    public IntPtr Solve;
    /// <summary>joints whose model matrices it reads</summary>
    public ushort* Reads;
    /// <summary>joints whose local transforms it changes</summary>
    public ushort* Writes;
    /// <summary>joints whose model matrices after the last step it reads</summary>
    public ushort* PreviousJoints;
    public uint ReadCount;
    /// <summary>1 or more</summary>
    public uint WriteCount;
    public uint PreviousJointCount;
    /// <summary>0 to 2^20</summary>
    public uint StateBytes;
    /// <summary>0 to 4096</summary>
    public uint OutputCount;
    /// <summary>0</summary>
    public uint Reserved;
  }

  /// <summary>One solver: exactly one of the pointers aim ... custom is not NULL.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienSolver {
    /// <summary>for messages. NULL: the name of its kind</summary>
    public byte* Name;
    /// <summary>may be NULL</summary>
    public MienAimSolver* Aim;
    /// <summary>may be NULL</summary>
    public MienSpaceSolver* Space;
    /// <summary>may be NULL</summary>
    public MienSpringSolver* Spring;
    /// <summary>may be NULL</summary>
    public MienTwistSolver* Twist;
    /// <summary>may be NULL</summary>
    public MienCopySolver* Copy;
    /// <summary>may be NULL</summary>
    public MienUserSolver* Custom;
    /// <summary>bit l: runs at LOD l. 0: at all LODs</summary>
    public ulong Lods;
  }

  /// <summary>How to create a solver stack. Everything is copied.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienSolverStackDesc {
    public UIntPtr StructSize;
    /// <summary>in the order in which they run; at most 256</summary>
    public MienSolver* Solvers;
    public UIntPtr SolverCount;
    /// <summary>the rows passed to steps have this many curves or more. 0: no row</summary>
    public uint CurveCount;
    /// <summary>compare all joints before and after each solver, to find undeclared writes: mien_solver_state_undeclared()</summary>
    public uint CheckWrites;
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienSolverStackDesc Create() {
      return new MienSolverStackDesc { StructSize = (UIntPtr)sizeof(MienSolverStackDesc) };
    }
  }

  /// <summary>Properties of a solver stack.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienSolverStackInfo {
    public UIntPtr StructSize;
    public uint SolverCount;
    public uint CurveCount;
    /// <summary>of all solvers</summary>
    public uint OutputCount;
    public uint JointCount;
    /// <summary>memory of a state</summary>
    public ulong StateBytes;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienSolverStackInfo Create() {
      return new MienSolverStackInfo { StructSize = (UIntPtr)sizeof(MienSolverStackInfo) };
    }
  }

  /// <summary>How to create a solver state.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienSolverStateDesc {
    public UIntPtr StructSize;
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienSolverStateDesc Create() {
      return new MienSolverStateDesc { StructSize = (UIntPtr)sizeof(MienSolverStateDesc) };
    }
  }

  /// <summary>The input of the solvers of one character.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienSolverInput {
    /// <summary>such as the one from mien_mixer_row(). NULL: none</summary>
    public float* Row;
    /// <summary>at least MienSolverStackDesc.curve_count</summary>
    public UIntPtr RowCount;
    /// <summary>0 to 63</summary>
    public uint Lod;
    /// <summary>the character was teleported, so springs come to rest and space switches do not ease</summary>
    public uint IsReset;
  }

  /// <summary>A raw control and its share: if the name has the value v, the control gets weight * v.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienControlShare {
    public uint Control;
    public float Weight;
  }

  /// <summary>What to generate.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienGenerateDesc {
    public UIntPtr StructSize;
    /// <summary>MIEN_PRESET_...</summary>
    public Preset Preset;
    /// <summary>MIEN_GENERATE_..., combined with |</summary>
    public Generate Flags;
    /// <summary>the same preset, flags and seed give the same bytes on every machine</summary>
    public ulong Seed;
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienGenerateDesc Create() {
      return new MienGenerateDesc { StructSize = (UIntPtr)sizeof(MienGenerateDesc) };
    }
  }

  /// <summary>A named part of the input mesh. It becomes a mesh of the DNA file.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienAuthorObject {
    /// <summary>1 to 200 bytes</summary>
    public MienStringView Name;
    /// <summary>the face after the last one of the object before it</summary>
    public uint FirstFace;
    public uint FaceCount;
  }

  /// <summary>An expression. It becomes a raw control of the same name, 0 to 1.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienAuthorShape {
    /// <summary>1 to 200 bytes; all different</summary>
    public MienStringView Name;
    /// <summary>indices of the positions that move. NULL: all, in order</summary>
    public uint* Positions;
    /// <summary>of `positions`, or of the mesh</summary>
    public UIntPtr PositionCount;
    /// <summary>3 for each of these positions, with the control at 1</summary>
    public double* Displacements;
  }

  /// <summary>A mesh to rig: a head, or the front of one, with everything inside it.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienAuthorMesh {
    public UIntPtr StructSize;
    /// <summary>3 per position, in the unit and axes of MienAuthorDesc</summary>
    public double* Positions;
    public UIntPtr PositionCount;
    /// <summary>corners of each face, 3 or more. NULL: all are triangles</summary>
    public uint* FaceSizes;
    public UIntPtr FaceCount;
    /// <summary>indices of positions, face by face, counterclockwise seen from outside</summary>
    public uint* Corners;
    public UIntPtr CornerCount;
    /// <summary>2 per UV; may be NULL</summary>
    public double* Uvs;
    public UIntPtr UvCount;
    /// <summary>indices of UVs, one per corner. NULL: no UVs</summary>
    public uint* CornerUvs;
    /// <summary>NULL: a single object named "head"</summary>
    public MienAuthorObject* Objects;
    public UIntPtr ObjectCount;
    /// <summary>may be NULL</summary>
    public MienAuthorShape* Shapes;
    public UIntPtr ShapeCount;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienAuthorMesh Create() {
      return new MienAuthorMesh { StructSize = (UIntPtr)sizeof(MienAuthorMesh) };
    }
  }

  /// <summary>A bone placed by the caller.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienAuthorBone {
    /// <summary>1 to 200 bytes; all different</summary>
    public MienStringView Name;
    /// <summary>in the space of the mesh, not relative to the parent</summary>
    public fixed double Position[3];
    /// <summary>index of an earlier bone; the first bone is its own parent</summary>
    public uint Parent;
    /// <summary>MIEN_BONE_...: the first bone is the root, and facial bones are consecutive</summary>
    public BoneKind Kind;
  }

  /// <summary>A point of the face that joints are placed by.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienAuthorLandmark {
    /// <summary>"nose" (tip), "throat", "lip_upper", "lip_lower" (in the middle), "mouth_l", "mouth_r" (corners, as the character sees them), "chin", "jaw" (its axis, in the middle plane), "eye_l", "eye_r" (centers of the eyeballs), "head", "neck" (pivots)</summary>
    public MienStringView Name;
    /// <summary>in the unit and axes of the mesh</summary>
    public fixed double Position[3];
  }

  /// <summary>A LOD of the mesh, made by the caller.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienAuthorLod {
    /// <summary>indices of positions of the mesh, three per triangle, all three in the same object. Objects without triangles are not in the LOD</summary>
    public uint* Corners;
    public UIntPtr CornerCount;
    /// <summary>indices of UVs, one per corner. NULL: chosen from the UVs that each position has in the mesh, so that they are nearest to each other</summary>
    public uint* CornerUvs;
  }

  /// <summary>How to rig a mesh. bones, weights, depth_groups, mask, lod_joints, bone_groups, bone_motions and
  /// lod_meshes let the caller provide the result of one stage, which is then skipped.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienAuthorDesc {
    public UIntPtr StructSize;
    /// <summary>1 to 7000. 0: 240</summary>
    public uint FacialJoints;
    /// <summary>per position: 1 to 12. 0: 8</summary>
    public uint Influences;
    /// <summary>1 to 8. 0: 8</summary>
    public uint Lods;
    /// <summary>depth groups, of which the front one is the face: 2 to 16. 0: 3</summary>
    public uint Groups;
    /// <summary>of the initial guesses of bone placement</summary>
    public ulong Seed;
    /// <summary>centimeters per unit of the mesh. 0: 1</summary>
    public double Unit;
    /// <summary>MIEN_MESH_AXIS_...</summary>
    public MeshAxis Up;
    /// <summary>MIEN_MESH_AXIS_..., perpendicular to `up`</summary>
    public MeshAxis Front;
    /// <summary>MIEN_SYMMETRY_...</summary>
    public Symmetry Symmetry;
    /// <summary>MIEN_AUTHOR_..., combined with |</summary>
    public AuthorFlags Flags;
    /// <summary>of the character; empty: "head"</summary>
    public MienStringView Name;
    /// <summary>name of the object with the face; empty: found automatically</summary>
    public MienStringView FaceObject;
    /// <summary>NULL: placed automatically</summary>
    public MienAuthorBone* Bones;
    public UIntPtr BoneCount;
    /// <summary>indices of bones, `influences` per position of the mesh. NULL: weights are computed</summary>
    public ushort* WeightJoints;
    /// <summary>the weights for weight_joints; both or neither, and only with `bones`</summary>
    public float* Weights;
    /// <summary>may be NULL</summary>
    public MienParallelFor* Parallel;
    /// <summary>passed to the next function</summary>
    public void* ProgressUser;
    /// <summary>Called on the calling thread with the name of the step that begins and the progress from 0 to 1, which never decreases. Returns 0 to continue; anything else cancels. May be NULL.</summary>
    public IntPtr Progress;
    public MienAllocator* Allocator;
    /// <summary>one per position of the mesh: its depth group, less than `groups`, 0 in front. NULL: computed</summary>
    public byte* DepthGroups;
    /// <summary>one per position of the mesh: nonzero in the face mask, where facial bones are placed. NULL: computed</summary>
    public byte* Mask;
    /// <summary>maximum number of facial joints in each of `lods` LODs (mirrored pairs stay together); never increasing, and LOD 0 has all. NULL: 240, 160, 110, 75, 50, 32, 20, 12, scaled to facial_joints</summary>
    public uint* LodJoints;
    /// <summary>joint group of each of `bones`, 0 to 255. NULL: computed</summary>
    public uint* BoneGroups;
    /// <summary>6 numbers for each of `bones`, shape by shape, with the control at 1: translation, then degrees about X, Y, Z, applied in this order, in the unit and axes of the mesh. NULL: fitted</summary>
    public double* BoneMotions;
    /// <summary>1 to 24. 0: chosen so that each has about 75 rows</summary>
    public uint JointGroups;
    /// <summary>maximum number of correctives that damp pairs of shapes with overlapping motion. 0: none</summary>
    public uint OverlapCorrectives;
    /// <summary>share of the triangles of a LOD that the next one keeps: above 0, at most 1. 0: 0.5. 1: all</summary>
    public double LodTriangles;
    /// <summary>LOD 1, LOD 2 and so on. NULL: made according to lod_triangles</summary>
    public MienAuthorLod* LodMeshes;
    /// <summary>one less than `lods`</summary>
    public UIntPtr LodMeshCount;
    /// <summary>used instead of those that are found; each name once, in any order. With "jaw", or a landmark of the mouth, there is a jaw even if no shape opens it. NULL: all are found</summary>
    public MienAuthorLandmark* Landmarks;
    public UIntPtr LandmarkCount;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienAuthorDesc Create() {
      return new MienAuthorDesc { StructSize = (UIntPtr)sizeof(MienAuthorDesc) };
    }
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienDocumentDesc {
    public UIntPtr StructSize;
    public MienAllocator* Allocator;
    /// <summary>MIEN_FILE_...; for mien_document_open_file() only</summary>
    public FileAccess FileAccess;
    /// <summary>MIEN_UNKNOWN_LAYERS_...; for mien_document_open_file() only</summary>
    public UnknownLayers UnknownLayers;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienDocumentDesc Create() {
      return new MienDocumentDesc { StructSize = (UIntPtr)sizeof(MienDocumentDesc) };
    }
  }

  /// <summary>How many deltas and targets mien_document_prune_targets() removed.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienPrunedTargets {
    public UIntPtr StructSize;
    public ulong Deltas;
    public ulong Targets;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienPrunedTargets Create() {
      return new MienPrunedTargets { StructSize = (UIntPtr)sizeof(MienPrunedTargets) };
    }
  }

  /// <summary>The largest magnitudes of entries of the joint matrix that count as small, in the units of the file.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienPruneJointsDesc {
    public UIntPtr StructSize;
    public float Translation;
    public float Rotation;
    public float Scale;
    /// <summary>0</summary>
    public uint Reserved;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienPruneJointsDesc Create() {
      return new MienPruneJointsDesc { StructSize = (UIntPtr)sizeof(MienPruneJointsDesc) };
    }
  }

  /// <summary>The effect of mien_document_prune_joints(): removed entries, and the largest distance by which a position
  /// moved.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienPrunedJoints {
    public UIntPtr StructSize;
    /// <summary>entries of the joint matrix that were not 0</summary>
    public ulong EntryCount;
    /// <summary>of these, set to 0</summary>
    public ulong RemovedCount;
    /// <summary>in the unit of the file</summary>
    public double WorstDistance;
    /// <summary>the raw control at 1, or the corrective whose raw controls were at 1</summary>
    public uint WorstControl;
    public uint WorstMesh;
    public uint WorstPosition;
    public uint Reserved;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienPrunedJoints Create() {
      return new MienPrunedJoints { StructSize = (UIntPtr)sizeof(MienPrunedJoints) };
    }
  }

  /// <summary>How to place a character: it is scaled about the origin, then rotated about it, then moved.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienPlacement {
    public UIntPtr StructSize;
    /// <summary>above 0. 0: 1</summary>
    public double Scale;
    /// <summary>right-handed degrees about x, then y, then z of the file</summary>
    public fixed double Rotation[3];
    /// <summary>in the unit of the file</summary>
    public fixed double Translation[3];

    /// <summary>All fields zero but StructSize.</summary>
    public static MienPlacement Create() {
      return new MienPlacement { StructSize = (UIntPtr)sizeof(MienPlacement) };
    }
  }

  /// <summary>How mien_document_project() works.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienProjectDesc {
    public UIntPtr StructSize;
    /// <summary>MIEN_MATCH_...</summary>
    public Match Match;
    /// <summary>at most, per position. 0: 8</summary>
    public uint Influences;
    /// <summary>leave the skin weights as they are</summary>
    public uint KeepWeights;
    /// <summary>leave the targets as they are</summary>
    public uint KeepTargets;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienProjectDesc Create() {
      return new MienProjectDesc { StructSize = (UIntPtr)sizeof(MienProjectDesc) };
    }
  }

  /// <summary>How far the rig moved to follow a mesh.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienConformed {
    public UIntPtr StructSize;
    /// <summary>largest distance by which a joint moved, in the unit of the file</summary>
    public double JointDistance;
    /// <summary>that joint</summary>
    public uint Joint;
    public uint Reserved;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienConformed Create() {
      return new MienConformed { StructSize = (UIntPtr)sizeof(MienConformed) };
    }
  }

  /// <summary>How mien_document_transplant() works.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienTransplantDesc {
    public UIntPtr StructSize;
    /// <summary>MIEN_MATCH_..., for meshes of the same name; positions of the same number correspond if the meshes have the same faces</summary>
    public Match Match;
    /// <summary>at most, per position. 0: 8</summary>
    public uint Influences;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienTransplantDesc Create() {
      return new MienTransplantDesc { StructSize = (UIntPtr)sizeof(MienTransplantDesc) };
    }
  }

  /// <summary>How differently a raw control of both rigs, at 1, moves the positions of LOD 0.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienControlError {
    /// <summary>distance of a position, in the unit of the file</summary>
    public double Worst;
    public double Rms;
    /// <summary>largest distance by which the control moved a position before</summary>
    public double Moved;
    /// <summary>its index in the new rig</summary>
    public uint Control;
    public uint Reserved;
  }

  /// <summary>Takes the bytes of a file, in pieces and in order. `write` is called only during the call that takes the
  /// struct, and on the same thread.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienByteSink {
    /// <summary>passed to the function</summary>
    public void* User;
    /// <summary>Takes `size` bytes and returns the number of bytes taken; any number but `size` ends the call.</summary>
    public IntPtr Write;
  }

  /// <summary>A point of a surface: the weighted sum of three positions of a mesh. One position: weights 1 0 0.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienSolvePoint {
    /// <summary>of the rig; points of a fit may be on several meshes</summary>
    public uint Mesh;
    /// <summary>in the order of the file</summary>
    public fixed uint Positions[3];
    public fixed float Weights[3];
  }

  /// <summary>How to create a fit. Everything is copied. Raw controls in a row that are named as the parts x y z w of a
  /// quaternion (.qx .qy .qz .qw, or .x .y .z .w), and begin as 0 0 0 1, are a rotation: if all four may move, they keep
  /// the length 1, and have no bounds.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienFitDesc {
    public UIntPtr StructSize;
    /// <summary>of the rig; needed for points and for constraints on joints. NULL: none</summary>
    public IntPtr Deformer;
    /// <summary>raw controls that may move, ascending. NULL: all</summary>
    public uint* Controls;
    /// <summary>bounds of these controls. NULL: 0</summary>
    public float* Lower;
    /// <summary>NULL: 1</summary>
    public float* Upper;
    /// <summary>pairs of raw controls kept similar: left, right, left, ...</summary>
    public uint* Symmetric;
    public MienSolvePoint* Points;
    /// <summary>per joint value, 0 or more. NULL: 1 each, or 0 if there are points</summary>
    public float* JointWeights;
    /// <summary>0 if `controls` is NULL</summary>
    public UIntPtr ControlCount;
    /// <summary>elements of `symmetric`, an even number</summary>
    public UIntPtr SymmetricCount;
    public UIntPtr PointCount;
    public uint Lod;
    /// <summary>0</summary>
    public uint Reserved;
    /// <summary>NULL: the heap</summary>
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienFitDesc Create() {
      return new MienFitDesc { StructSize = (UIntPtr)sizeof(MienFitDesc) };
    }
  }

  /// <summary>How to create a surface. Everything is copied. Its unit and axes are those of the rig; triangles may be
  /// wound either way, but all the same way.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienFitSurfaceDesc {
    public UIntPtr StructSize;
    /// <summary>x y z each. Positions in the same place are one, as along texture seams</summary>
    public float* Positions;
    /// <summary>three positions each</summary>
    public uint* Triangles;
    public UIntPtr PositionCount;
    public UIntPtr TriangleCount;
    /// <summary>NULL: the heap</summary>
    public MienAllocator* Allocator;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienFitSurfaceDesc Create() {
      return new MienFitSurfaceDesc { StructSize = (UIntPtr)sizeof(MienFitSurfaceDesc) };
    }
  }

  /// <summary>A pinhole camera: image x = focal[0] * x / z + center[0], and y likewise, for the point x y z in camera
  /// space, after `rotation` and `translation`. z grows in front of the camera.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienFitCamera {
    public fixed float Focal[2];
    public fixed float Center[2];
    /// <summary>rows, from model space. With MienFitFrame.rigid, all 0: unknown</summary>
    public fixed float Rotation[9];
    public fixed float Translation[3];
  }

  /// <summary>A constraint of a frame. A number that is NaN: the constraint is missing.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienFitConstraint {
    /// <summary>MIEN_CONSTRAINT_...</summary>
    public FitConstraintKind Kind;
    /// <summary>of the rig</summary>
    public uint Joint;
    /// <summary>places in MienFitDesc.points</summary>
    public fixed uint Points[2];
    /// <summary>in the axes of the joint, of any length but 0</summary>
    public fixed float Axis[3];
    /// <summary>a place, or a direction of any length but 0</summary>
    public fixed float Target[3];
    /// <summary>the smallest and the largest that cost nothing</summary>
    public fixed float Distances[2];
    /// <summary>times the squared residual: of a length in the unit of the rig, or of the difference of directions of length 1</summary>
    public float Weight;
  }

  /// <summary>The targets of one frame, and the weights of the terms; terms of weight 0 are left out. Joints, points, images, a
  /// surface and constraints may be given together: a point may have a target of each kind. Each kind has a unit of its
  /// own: joint values, lengths (points and surface), and that of images.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienFitFrame {
    public UIntPtr StructSize;
    /// <summary>joint values. NULL: none. NaN: missing</summary>
    public float* Joints;
    /// <summary>x y z per point. NULL: none. NaN: missing</summary>
    public float* Points;
    /// <summary>x y per point, as `camera` sees them. NULL: none. NaN: missing</summary>
    public float* Images;
    /// <summary>required with `images`</summary>
    public MienFitCamera* Camera;
    /// <summary>per point, 0 or more: of points and images. NULL: 1</summary>
    public float* PointWeights;
    /// <summary>all raw controls of the rig, to start from. NULL: the initial ones</summary>
    public float* Start;
    /// <summary>raw controls that the result is drawn to. NULL: the initial ones</summary>
    public float* Prior;
    /// <summary>times the squared distance to `prior`</summary>
    public float PriorWeight;
    /// <summary>times the squared distance to `start`, the previous frame</summary>
    public float SmoothWeight;
    /// <summary>times the sum of magnitudes, from the initial values: few controls explain the frame</summary>
    public float SparseWeight;
    /// <summary>times the squared differences of symmetric pairs</summary>
    public float SymmetricWeight;
    /// <summary>points farther off than this, or from the surface, count less. 0: all count fully</summary>
    public float RobustScale;
    /// <summary>weight of the joints relative to the points. 0: 1</summary>
    public float JointWeight;
    /// <summary>points and surface may be rotated and translated as a whole, by one motion. With `images`, these stay where they are in model space, and the camera is found, from that of `camera`, or, if its rotation is unknown, from one that sees the face from the front</summary>
    public uint Rigid;
    /// <summary>0: 50</summary>
    public uint MaxIterations;
    /// <summary>0: no limit. A limit makes results depend on the machine</summary>
    public double MaxSeconds;
    /// <summary>passed to `canceled`</summary>
    public void* User;
    /// <summary>Called before each iteration; a nonzero result stops. NULL: never.</summary>
    public IntPtr Canceled;
    /// <summary>each point is drawn to the nearest place of the surface that faces the same way, within 60 degrees, and is not at a border. NULL: none</summary>
    public IntPtr Surface;
    /// <summary>points farther from the surface have no target. 0: no limit</summary>
    public float SurfaceReach;
    /// <summary>, with `images` and `rigid`: the focal length is found too, its two numbers scaled alike</summary>
    public uint Focal;
    public UIntPtr ConstraintCount;
    /// <summary>up to 64, added to all other targets. NULL: none</summary>
    public MienFitConstraint* Constraints;
    /// <summary>per raw control of the rig, up to 15: the solve begins with the controls of stage 0 alone, then those of stage 1 move too, and so on, as jaw and eyes before the rest. Each stage may take `max_iterations`. NULL: all move from the start</summary>
    public uint* Stages;
    /// <summary>x y z per point, in model space: how far the points of the face in the targets are from those of the rig at rest, where it is another person's. Constraints are about the points of the rig. NULL: 0</summary>
    public float* PointOffsets;
    /// <summary>per point, 0 or more: how much it is drawn to `surface`. NULL: those of `point_weights`</summary>
    public float* SurfaceWeights;
    /// <summary>weight of the images relative to the points: of a squared length in the image, against a squared length in space. 0: 1</summary>
    public float ImageWeight;
    /// <summary>`robust_scale` of images, in their unit. 0: `robust_scale`, or, if there are points or a surface too, all count fully</summary>
    public float ImageRobustScale;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienFitFrame Create() {
      return new MienFitFrame { StructSize = (UIntPtr)sizeof(MienFitFrame) };
    }
  }

  /// <summary>The result of a solve.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct MienFitResult {
    public UIntPtr StructSize;
    /// <summary>MIEN_FIT_...</summary>
    public FitStatus Status;
    public uint Iterations;
    /// <summary>the minimized sum, with all terms</summary>
    public double Cost;
    /// <summary>weighted root mean square of the differences of joint values</summary>
    public double JointResidual;
    /// <summary>the same for points; without these, for images in their unit; without both, for the surface</summary>
    public double PointResidual;
    /// <summary>with a surface: those that have no target</summary>
    public uint MissingPoints;
    public uint Reserved;
    /// <summary>rows: points of the target = rotation * model + translation, if rigid; the camera's with images</summary>
    public fixed float Rotation[9];
    public fixed float Translation[3];
    /// <summary>largest difference of a joint value that counts</summary>
    public double JointWorst;
    /// <summary>largest distance of a point that counts, of the same kind</summary>
    public double PointWorst;
    /// <summary>of the camera, with images; else 0</summary>
    public fixed float Focal[2];
    /// <summary>weighted root mean square of the residuals of constraints</summary>
    public double ConstraintResidual;
    /// <summary>largest residual of a constraint that counts</summary>
    public double ConstraintWorst;
    /// <summary>joint values or points moved farther from where they are at `start` than their targets ask for, as roots of mean squares; those without a target count as such that ask for nothing</summary>
    public uint Jumped;
    public uint Reserved_2;
    /// <summary>weighted root mean square of the distances in the image</summary>
    public double ImageResidual;
    public double ImageWorst;
    /// <summary>the same of the distances from the surface</summary>
    public double SurfaceResidual;
    public double SurfaceWorst;

    /// <summary>All fields zero but StructSize.</summary>
    public static MienFitResult Create() {
      return new MienFitResult { StructSize = (UIntPtr)sizeof(MienFitResult) };
    }
  }

  /// <summary>A checked, read-only view of a DNA file. Immutable.</summary>
  public sealed class DnaHandle : Handle {
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly DnaHandle Null = new DnaHandle(IntPtr.Zero);

    internal DnaHandle(IntPtr taken, params Handle[] kept) : base(taken, kept) { }

    protected override void Destroy(IntPtr taken) { Functions.mien_dna_close(taken); }
  }

  /// <summary>The findings of a validation. Immutable.</summary>
  public sealed class ReportHandle : Handle {
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly ReportHandle Null = new ReportHandle(IntPtr.Zero);

    internal ReportHandle(IntPtr taken, params Handle[] kept) : base(taken, kept) { }

    protected override void Destroy(IntPtr taken) { Functions.mien_report_destroy(taken); }
  }

  /// <summary>The behavior of a DNA, packed for evaluation. Immutable.</summary>
  public sealed class RigHandle : Handle {
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly RigHandle Null = new RigHandle(IntPtr.Zero);

    internal RigHandle(IntPtr taken, params Handle[] kept) : base(taken, kept) { }

    protected override void Destroy(IntPtr taken) { Functions.mien_rig_destroy(taken); }
  }

  /// <summary>One character: inputs, and the results of the last evaluation.</summary>
  public sealed class InstanceHandle : Handle {
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly InstanceHandle Null = new InstanceHandle(IntPtr.Zero);

    internal InstanceHandle(IntPtr taken, params Handle[] kept) : base(taken, kept) { }

    protected override void Destroy(IntPtr taken) { Functions.mien_instance_destroy(taken); }
  }

  /// <summary>Scratch memory for evaluating many instances of a rig in one call.</summary>
  public sealed class BatchHandle : Handle {
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly BatchHandle Null = new BatchHandle(IntPtr.Zero);

    internal BatchHandle(IntPtr taken, params Handle[] kept) : base(taken, kept) { }

    protected override void Destroy(IntPtr taken) { Functions.mien_batch_destroy(taken); }
  }

  /// <summary>The geometry of a DNA and its joint hierarchy, packed for deformation. Immutable.
  ///
  ///   local    Translate(neutral + delta) * R * Scale(1 + delta), for column vectors. R is either
  ///            R(neutral) * R(delta) or the rotation of the summed angles (MIEN_COMPOSE_...). With
  ///            quaternion outputs R(delta) is the quaternion, of any length; zero is the identity.
  ///   model    model matrix of the parent * local; a root (its own parent) starts at the origin
  ///   skin     model * inverse of the model matrix of the neutral pose
  ///   vertex   sum over its joints of weight * skin * (neutral position + sum of channel weight *
  ///            target delta): linear blend skinning. A vertex without joints is not skinned. Channel
  ///            weights below 1e-5 in magnitude count as 0.
  ///
  /// Joints that a LOD does not list move with their parent. A position is shared by all faces around it;
  /// a vertex is a position with texture coordinates and a normal (a layout in DNA files). So a mesh has at
  /// least as many vertices as used positions.
  /// See docs/deformation.md, 1 "Joint transforms" and 2 "Positions".</summary>
  public sealed class DeformerHandle : Handle {
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly DeformerHandle Null = new DeformerHandle(IntPtr.Zero);

    internal DeformerHandle(IntPtr taken, params Handle[] kept) : base(taken, kept) { }

    protected override void Destroy(IntPtr taken) { Functions.mien_deformer_destroy(taken); }
  }

  /// <summary>One character: joint matrices, and positions and normals of its meshes.</summary>
  public sealed class DeformerInstanceHandle : Handle {
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly DeformerInstanceHandle Null = new DeformerInstanceHandle(IntPtr.Zero);

    internal DeformerInstanceHandle(IntPtr taken, params Handle[] kept) : base(taken, kept) { }

    protected override void Destroy(IntPtr taken) { Functions.mien_deformer_instance_destroy(taken); }
  }

  /// <summary>Derivatives of one rig, and the memory to compute them. Belongs to one thread at a time.</summary>
  public sealed class DerivativesHandle : Handle {
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly DerivativesHandle Null = new DerivativesHandle(IntPtr.Zero);

    internal DerivativesHandle(IntPtr taken, params Handle[] kept) : base(taken, kept) { }

    protected override void Destroy(IntPtr taken) { Functions.mien_derivatives_destroy(taken); }
  }

  /// <summary>The sparse matrix of the derivatives of chosen numbers at one point, its rows, with respect to chosen
  /// numbers at an earlier one, its columns: which entries may be other than 0 in some pose, and which columns
  /// have no row in common, so that one direction computes them together (docs/derivatives.md, 9). Never
  /// changes.</summary>
  public sealed class JacobianHandle : Handle {
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly JacobianHandle Null = new JacobianHandle(IntPtr.Zero);

    internal JacobianHandle(IntPtr taken, params Handle[] kept) : base(taken, kept) { }

    protected override void Destroy(IntPtr taken) { Functions.mien_jacobian_destroy(taken); }
  }

  /// <summary>An open baked file: a rig, and possibly its deformer, as they are in memory. They are used in place,
  /// so that programs can ship without DNA files. A baked file holds all options of its objects except the
  /// instruction set and MienReuse, and works on all machines of one byte order. The same objects give the
  /// same bytes. Keep the DNA file: a later version of the library may refuse the baked file with
  /// MIEN_ERROR_BAKED_VERSION. Immutable.
  /// See docs/rig-evaluation.md, 9.5 "Baked files".</summary>
  public sealed class BakedHandle : Handle {
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly BakedHandle Null = new BakedHandle(IntPtr.Zero);

    internal BakedHandle(IntPtr taken, params Handle[] kept) : base(taken, kept) { }

    protected override void Destroy(IntPtr taken) { Functions.mien_baked_close(taken); }
  }

  /// <summary>Curves of named channels at a constant frame rate, compressed. A clip is not bound to a rig: a
  /// MienClipBinding maps its channels to raw controls.
  ///
  ///     rows of values -&gt; MienClip -&gt; MienClipPlayer  -&gt; values of channels
  ///                              \___ MienClipBinding -&gt; raw controls of a rig
  ///
  /// Times are integers, in ticks of 1 / MIEN_TICKS_PER_SECOND s. At common frame rates a frame lasts a whole
  /// number of ticks; at others its length is rounded to the nearest tick. A clip is used in place: frames
  /// are decoded while it plays. Decoded values are always finite, even if the bytes are damaged.
  /// Immutable.</summary>
  public sealed class ClipHandle : Handle {
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly ClipHandle Null = new ClipHandle(IntPtr.Zero);

    internal ClipHandle(IntPtr taken, params Handle[] kept) : base(taken, kept) { }

    protected override void Destroy(IntPtr taken) { Functions.mien_clip_close(taken); }
  }

  /// <summary>Plays a clip for one character: a position, and the state of the decoder.</summary>
  public sealed class ClipPlayerHandle : Handle {
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly ClipPlayerHandle Null = new ClipPlayerHandle(IntPtr.Zero);

    internal ClipPlayerHandle(IntPtr taken, params Handle[] kept) : base(taken, kept) { }

    protected override void Destroy(IntPtr taken) { Functions.mien_clip_player_destroy(taken); }
  }

  /// <summary>Maps the channels of a clip to raw controls of a rig. Serves all clips with the same channels and
  /// all rigs with the same raw controls. Immutable.</summary>
  public sealed class ClipBindingHandle : Handle {
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly ClipBindingHandle Null = new ClipBindingHandle(IntPtr.Zero);

    internal ClipBindingHandle(IntPtr taken, params Handle[] kept) : base(taken, kept) { }

    protected override void Destroy(IntPtr taken) { Functions.mien_clip_binding_destroy(taken); }
  }

  /// <summary>A description of what is mixed for one rig, and how. A row holds one value per curve. The curves are the
  /// raw controls of the rig, then pose variables: numbers of the caller that are mixed by the same rules
  /// (gaze, head turn, breath). Each step of a MienMixer applies the layers in order, then reactions, guards,
  /// layers and reactions that act after the guards, antagonists, and limits. docs/mixing.md explains each
  /// stage. One mix serves any number of mixers and threads. Immutable.</summary>
  public sealed class MixHandle : Handle {
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly MixHandle Null = new MixHandle(IntPtr.Zero);

    internal MixHandle(IntPtr taken, params Handle[] kept) : base(taken, kept) { }

    protected override void Destroy(IntPtr taken) { Functions.mien_mix_destroy(taken); }
  }

  /// <summary>Which raw controls turn the eyes of a rig, and by how much. Immutable.</summary>
  public sealed class GazeHandle : Handle {
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly GazeHandle Null = new GazeHandle(IntPtr.Zero);

    internal GazeHandle(IntPtr taken, params Handle[] kept) : base(taken, kept) { }

    protected override void Destroy(IntPtr taken) { Functions.mien_gaze_destroy(taken); }
  }

  /// <summary>One character in a mix: its running clips, fades and reactions. Another thread may only call
  /// mien_mixer_push() at the same time.</summary>
  public sealed class MixerHandle : Handle {
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly MixerHandle Null = new MixerHandle(IntPtr.Zero);

    internal MixerHandle(IntPtr taken, params Handle[] kept) : base(taken, kept) { }

    protected override void Destroy(IntPtr taken) { Functions.mien_mixer_destroy(taken); }
  }

  /// <summary>Solvers move joints of a deformer after the rig has posed them: eyes aim at a target, a cap moves from
  /// hand to head, earrings swing.
  ///
  ///     mien_deformer_instance_update() -&gt; mien_solver_state_step() -&gt; mien_deformer_instance_deform()
  ///
  /// A step changes the matrices of the deformer instance in place. Lengths are in the rig's translation
  /// unit, points in its model space. Results have the same bits on every machine, stepped alone or in a
  /// batch. A stack serves any number of characters and threads. Immutable.
  /// See docs/mixing.md, 6 "Solvers".</summary>
  public sealed class SolverStackHandle : Handle {
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly SolverStackHandle Null = new SolverStackHandle(IntPtr.Zero);

    internal SolverStackHandle(IntPtr taken, params Handle[] kept) : base(taken, kept) { }

    protected override void Destroy(IntPtr taken) { Functions.mien_solver_stack_destroy(taken); }
  }

  /// <summary>One character: the state that its solvers keep between steps.</summary>
  public sealed class SolverStateHandle : Handle {
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly SolverStateHandle Null = new SolverStateHandle(IntPtr.Zero);

    internal SolverStateHandle(IntPtr taken, params Handle[] kept) : base(taken, kept) { }

    protected override void Destroy(IntPtr taken) { Functions.mien_solver_state_destroy(taken); }
  }

  /// <summary>What was found and measured while authoring a rig. Immutable.</summary>
  public sealed class AuthorReportHandle : Handle {
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly AuthorReportHandle Null = new AuthorReportHandle(IntPtr.Zero);

    internal AuthorReportHandle(IntPtr taken, params Handle[] kept) : base(taken, kept) { }

    protected override void Destroy(IntPtr taken) { Functions.mien_author_report_close(taken); }
  }

  /// <summary>A DNA file that can be changed: field by field, with the paths of mien_dna_field(), and by operations
  /// that keep all references consistent. Every change happens completely or, if the call fails, not at all.
  /// Everything else stays as it is, byte for byte. Memory is taken for the file that was opened, unless it
  /// is mapped, and for changed fields.</summary>
  public sealed class DocumentHandle : Handle {
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly DocumentHandle Null = new DocumentHandle(IntPtr.Zero);

    internal DocumentHandle(IntPtr taken, params Handle[] kept) : base(taken, kept) { }

    protected override void Destroy(IntPtr taken) { Functions.mien_document_destroy(taken); }
  }

  /// <summary>One rig, the joints and points to match, and the memory to solve. Belongs to one thread at a time; use
  /// one for each thread.</summary>
  public sealed class FitHandle : Handle {
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly FitHandle Null = new FitHandle(IntPtr.Zero);

    internal FitHandle(IntPtr taken, params Handle[] kept) : base(taken, kept) { }

    protected override void Destroy(IntPtr taken) { Functions.mien_fit_destroy(taken); }
  }

  /// <summary>A surface without correspondences: a scan, or a mesh of another topology. Immutable: any threads may use
  /// one at the same time.</summary>
  public sealed class FitSurfaceHandle : Handle {
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly FitSurfaceHandle Null = new FitSurfaceHandle(IntPtr.Zero);

    internal FitSurfaceHandle(IntPtr taken, params Handle[] kept) : base(taken, kept) { }

    protected override void Destroy(IntPtr taken) { Functions.mien_fit_surface_destroy(taken); }
  }

  /// <summary>The C functions.</summary>
  public static unsafe class Functions {

    /// <summary>Returns the MIEN_VERSION of the library in use, which may differ from that of this header.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern uint mien_version();

    /// <summary>Returns "DNA_TRUNCATED" for MIEN_ERROR_DNA_TRUNCATED, and "UNKNOWN" for unknown numbers. The string
    /// is static and null-terminated.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern IntPtr mien_status_name(Status status);

    /// <summary>Returns the coordinate system of an engine or tool: "maya", "unreal", "unreal-mesh" (characters
    /// look along y), "unity", "godot", "blender", "gltf", "opengl", "directx" or "houdini". The rotation
    /// rule is MIEN_ROTATION_RULE_CARRIED; rotation_sequence is that of the engine's Euler angles, and only
    /// takes effect if you set another rule.
    /// Fails with MIEN_ERROR_NAME if the name is none of these.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_coordinate_system_find(byte* name, MienCoordinateSystem* out_system);

    /// <summary>Returns the coordinate system of an engine or tool: "maya", "unreal", "unreal-mesh" (characters
    /// look along y), "unity", "godot", "blender", "gltf", "opengl", "directx" or "houdini". The rotation
    /// rule is MIEN_ROTATION_RULE_CARRIED; rotation_sequence is that of the engine's Euler angles, and only
    /// takes effect if you set another rule.
    /// Fails with MIEN_ERROR_NAME if the name is none of these.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_coordinate_system_find_n(byte* name, UIntPtr name_count, MienCoordinateSystem* out_system);

    /// <summary>Returns a name that mien_coordinate_system_find() accepts. The string is static.
    /// Fails with MIEN_ERROR_INDEX if `index` is past the last name.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_coordinate_system_name(uint index, MienStringView* out_name);

    /// <summary>Opens a DNA file of version 2.1 to 2.8, or the known layers of a later 2.x. Checks everything that
    /// it loads. Close with mien_dna_close().
    ///
    /// Numbers and names stay in the file and are read when needed. Memory is allocated for lists only:
    /// typically a few percent of the size of the loaded layers, at most 20 times their size. Do not truncate
    /// or overwrite a mapped file while it is open; replacing it by renaming is safe.
    ///
    /// Fails with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ if the file cannot be read,
    /// MIEN_ERROR_DNA_SIGNATURE or MIEN_ERROR_DNA_VERSION if it is not a DNA file of generation 2,
    /// MIEN_ERROR_DNA_TRUNCATED, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT
    /// or MIEN_ERROR_DNA_VALUE if its contents are not valid or cannot be converted to the requested
    /// system, MIEN_ERROR_LOD if it has none of the requested LODs.
    /// See docs/dna-format.md, 13 "What is checked".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_dna_open_file(byte* path, MienDnaDesc* desc, out IntPtr out_dna, MienError* error);

    /// <summary>Opens a DNA file in memory: `size` bytes, of any alignment. `bytes` must outlive the MienDna,
    /// unchanged.
    /// Fails like mien_dna_open_file(), but not with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_dna_open_memory(void* bytes, UIntPtr size, MienDnaDesc* desc, out IntPtr out_dna, MienError* error);

    /// <summary>Opens a DNA file through a stream. Reads the header, the index and the requested layers, each
    /// with one read, into memory from the allocator.
    /// Fails like mien_dna_open_file(), but not with MIEN_ERROR_FILE_OPEN.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_dna_open_stream(MienStream* stream, MienDnaDesc* desc, out IntPtr out_dna, MienError* error);

    /// <summary>Closes a DNA. Rigs and deformers created from it stay valid; views into it do not.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern void mien_dna_close(IntPtr dna);

    /// <summary>Returns the properties of a DNA.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_dna_info(DnaHandle dna, MienDnaInfo* out_info);

    /// <summary>Returns entry `index` of the index table, in file order.
    /// Fails with MIEN_ERROR_INDEX if `index` is not below MienDnaInfo.layer_count.
    /// See docs/dna-format.md, 4.1 "Index table".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_dna_layer(DnaHandle dna, uint index, MienDnaLayer* out_layer);

    /// <summary>Finds a field of a loaded layer by its path: the code of the layer, then the names of fields, with
    /// an index after each list.
    ///
    ///     desc.name                                 a string
    ///     desc.metadata[0].key                      a string
    ///     defn.jointNames                           a list of strings; defn.jointNames[3] is one
    ///     defn.neutralJointTranslations.xs          floats
    ///     bhvr.joints.jointGroups[7].values         floats
    ///     geom.meshes[0].skinWeights[12].weights    floats
    ///     mlbh.neuralNetworks[0].layers[1].biases   floats
    ///
    /// Layers that are not loaded are empty.
    /// Fails with MIEN_ERROR_NAME if there is no such field (the message contains the part of the path that
    /// does not exist), MIEN_ERROR_INDEX if an index in the path is past the end.
    /// See docs/dna-format.md, 6 "Layers, field by field".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_dna_field(DnaHandle dna, byte* path, MienDnaField* out_field, MienError* error);

    /// <summary>Finds a field of a loaded layer by its path: the code of the layer, then the names of fields, with
    /// an index after each list.
    ///
    ///     desc.name                                 a string
    ///     desc.metadata[0].key                      a string
    ///     defn.jointNames                           a list of strings; defn.jointNames[3] is one
    ///     defn.neutralJointTranslations.xs          floats
    ///     bhvr.joints.jointGroups[7].values         floats
    ///     geom.meshes[0].skinWeights[12].weights    floats
    ///     mlbh.neuralNetworks[0].layers[1].biases   floats
    ///
    /// Layers that are not loaded are empty.
    /// Fails with MIEN_ERROR_NAME if there is no such field (the message contains the part of the path that
    /// does not exist), MIEN_ERROR_INDEX if an index in the path is past the end.
    /// See docs/dna-format.md, 6 "Layers, field by field".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_dna_field_n(DnaHandle dna, byte* path, UIntPtr path_count, MienDnaField* out_field, MienError* error);

    /// <summary>Returns the name of field `index` of the record at a path. The empty path is the file itself, whose
    /// fields are the layers. The string is static.
    /// Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if `index` or an index in the
    /// path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a record.
    /// See docs/dna-format.md, 6 "Layers, field by field".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_dna_child_name(DnaHandle dna, byte* path, uint index, MienStringView* out_name, MienError* error);

    /// <summary>Returns the name of field `index` of the record at a path. The empty path is the file itself, whose
    /// fields are the layers. The string is static.
    /// Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if `index` or an index in the
    /// path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a record.
    /// See docs/dna-format.md, 6 "Layers, field by field".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_dna_child_name_n(DnaHandle dna, byte* path, UIntPtr path_count, uint index, MienStringView* out_name, MienError* error);

    /// <summary>Copies `count` elements of a field, beginning with element `first`, to `out`, in native byte order.
    /// A field that is one number has one element. `out` may be NULL if `count` is 0. Integers are widened
    /// to 64 bits.
    /// Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
    /// the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
    /// kind.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_dna_read_floats(DnaHandle dna, byte* path, ulong first, ulong count, float* @out, MienError* error);

    /// <summary>Copies `count` elements of a field, beginning with element `first`, to `out`, in native byte order.
    /// A field that is one number has one element. `out` may be NULL if `count` is 0. Integers are widened
    /// to 64 bits.
    /// Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
    /// the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
    /// kind.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_dna_read_floats_n(DnaHandle dna, byte* path, UIntPtr path_count, ulong first, ulong count, float* @out, MienError* error);

    /// <summary>Copies `count` elements of a field, beginning with element `first`, to `out`, in native byte order.
    /// A field that is one number has one element. `out` may be NULL if `count` is 0. Integers are widened
    /// to 64 bits.
    /// Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
    /// the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
    /// kind.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_dna_read_integers(DnaHandle dna, byte* path, ulong first, ulong count, long* @out, MienError* error);

    /// <summary>Copies `count` elements of a field, beginning with element `first`, to `out`, in native byte order.
    /// A field that is one number has one element. `out` may be NULL if `count` is 0. Integers are widened
    /// to 64 bits.
    /// Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
    /// the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
    /// kind.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_dna_read_integers_n(DnaHandle dna, byte* path, UIntPtr path_count, ulong first, ulong count, long* @out, MienError* error);

    /// <summary>Returns a string of the file.
    /// Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is
    /// past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a string.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_dna_read_string(DnaHandle dna, byte* path, MienStringView* out_string, MienError* error);

    /// <summary>Returns a string of the file.
    /// Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is
    /// past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a string.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_dna_read_string_n(DnaHandle dna, byte* path, UIntPtr path_count, MienStringView* out_string, MienError* error);

    /// <summary>Writes a DNA file in canonical form: byte for byte the original if that was canonical and was loaded
    /// completely. Layers that were not loaded are written empty. Another version may lack layers that others
    /// need, such as the ML operations of networks; a file that could not be opened again is never written. The
    /// file is written under a temporary name and renamed, so that a failure leaves `path` unchanged. An
    /// existing file keeps its permissions; a symbolic link is followed, unless it leads nowhere.
    /// Fails with MIEN_ERROR_FILE_WRITE if the file cannot be written, MIEN_ERROR_DNA_LAYER if RBF behavior
    /// was loaded without the machine-learned behavior of its file (whose controls are numbered before its
    /// own), MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE or MIEN_ERROR_DNA_VALUE if the file could
    /// not be opened in the requested version, MIEN_ERROR_DNA_LIMIT if it would exceed 4 GiB,
    /// MIEN_ERROR_MEMORY if the allocator of the DNA returns NULL.
    /// See docs/dna-format.md, 14 "Writing a canonical file".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_dna_write_file(DnaHandle dna, byte* path, MienWriteDesc* desc, MienError* error);

    /// <summary>Writes a DNA file to memory and returns its size in `out_size`. `buffer` may be NULL with capacity 0
    /// to get the size only. Writes nothing if `capacity` is too small; `out_size` is set nevertheless.
    /// Fails like mien_dna_write_file(), but not with MIEN_ERROR_FILE_WRITE, and with
    /// MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_dna_write_memory(DnaHandle dna, MienWriteDesc* desc, void* buffer, UIntPtr capacity, UIntPtr* out_size, MienError* error);

    /// <summary>Checks all layers of a file and collects the findings: at most 32 per field and 1000 in total; the
    /// last one tells whether there are more. Returns MIEN_OK if the file could be checked, whatever was
    /// found. The file is read into memory first, so it may change during the call. Destroy with
    /// mien_report_destroy().
    /// Fails with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ if the file cannot be read.
    /// See docs/dna-format.md, 13 "What is checked".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_dna_validate_file(byte* path, MienValidateDesc* desc, out IntPtr out_report, MienError* error);

    /// <summary>Checks a file in memory: `size` bytes. `bytes` may be released afterwards.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_dna_validate_memory(void* bytes, UIntPtr size, MienValidateDesc* desc, out IntPtr out_report, MienError* error);

    /// <summary>Returns the number of errors and the number of warnings.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_report_counts(ReportHandle report, uint* out_errors, uint* out_warnings);

    /// <summary>Returns finding `index`, in the order of the checks. Their number is that of errors plus warnings.
    /// Fails with MIEN_ERROR_INDEX if `index` is past the last finding.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_report_finding(ReportHandle report, uint index, MienFinding* out_finding);

    /// <summary>Destroys a report.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern void mien_report_destroy(IntPtr report);

    /// <summary>Returns 1 if rigs can be created for instruction set `isa` on this machine, else 0.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern uint mien_isa_available(Isa isa);

    /// <summary>Returns "avx2" for MIEN_ISA_AVX2, and so on; "unknown" for unknown numbers. The string is static
    /// and null-terminated.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern IntPtr mien_isa_name(Isa isa);

    /// <summary>Packs the behavior of a DNA for evaluation. The rig is one block of memory, or two with
    /// MIEN_REUSE_SUMS; temporary memory is released before the call returns. `dna` may be closed afterwards. Destroy with mien_rig_destroy().
    /// Fails with MIEN_ERROR_DNA_LAYER if `dna` was opened without its behavior, MIEN_ERROR_DNA_VALUE if
    /// correctives depend on each other in a cycle, MIEN_ERROR_DNA_LIMIT if the rig is too large,
    /// MIEN_ERROR_ISA if the requested instruction set is not available.
    /// See docs/rig-evaluation.md and docs/dna-format.md, 13 "What is checked".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_create(DnaHandle dna, MienRigDesc* desc, out IntPtr out_rig, MienError* error);

    /// <summary>Destroys a rig. The handle is invalid afterwards, but instances, batches and deformers of the rig may
    /// be destroyed later: its memory is released with the last of them.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern void mien_rig_destroy(IntPtr rig);

    /// <summary>Returns the properties of a rig.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_info(RigHandle rig, MienRigInfo* out_info);

    /// <summary>Returns the number of parts of a kind.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_count(RigHandle rig, Kind kind, uint* out_count);

    /// <summary>Returns a name; "" for kinds without names.
    /// Fails with MIEN_ERROR_INDEX if `index` is not below mien_rig_count().</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_name(RigHandle rig, Kind kind, uint index, MienStringView* out_name);

    /// <summary>Finds the index of a name by exact match; of equal names, the first. Takes O(log n) time.
    /// Fails with MIEN_ERROR_NAME if there is no such name, MIEN_ERROR_INVALID_ARGUMENT if `kind` has no
    /// names.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_find(RigHandle rig, Kind kind, byte* name, uint* out_index);

    /// <summary>Finds the index of a name by exact match; of equal names, the first. Takes O(log n) time.
    /// Fails with MIEN_ERROR_NAME if there is no such name, MIEN_ERROR_INVALID_ARGUMENT if `kind` has no
    /// names.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_find_n(RigHandle rig, Kind kind, byte* name, UIntPtr name_count, uint* out_index);

    /// <summary>Returns the indices of the joints, blend shape channels, animated maps, meshes or RBF solvers that
    /// a LOD lists, in file order.
    /// Fails with MIEN_ERROR_LOD if the rig has no such LOD, MIEN_ERROR_INVALID_ARGUMENT if `kind` is not
    /// one of these five.
    /// See docs/dna-format.md, 8.2 "LOD mappings".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_lod_indices(RigHandle rig, Kind kind, uint lod, MienIndex16View* out_indices);

    /// <summary>Returns the indices of the joint values that evaluation may change at a LOD, ascending. All others
    /// keep their initial value: 0, or 1 for the w of a quaternion.
    /// Fails with MIEN_ERROR_LOD if the rig has no such LOD.
    /// See docs/rig-evaluation.md, 4.10 "Which joint values a LOD may change".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_variable_joint_values(RigHandle rig, uint lod, MienIndex16View* out_indices);

    /// <summary>Returns the parents of the joints, one index per joint. A root is its own parent.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_joint_parents(RigHandle rig, MienIndex16View* out_parents);

    /// <summary>Returns the neutral pose, relative to the parents: 9 or 10 floats per joint, in the order of the
    /// joint values. The scale is 1.
    /// See docs/rig-evaluation.md, 4.2 "Neutral pose".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_neutral_joint_values(RigHandle rig, MienFloatView* out_values);

    /// <summary>Returns the controls whose product is corrective `psd`, as indices into the control vector.
    /// Fails with MIEN_ERROR_INDEX if there is no such corrective.
    /// See docs/rig-evaluation.md, 3.1 "Weights and inputs".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_psd_inputs(RigHandle rig, uint psd, MienIndex16View* out_controls);

    /// <summary>Returns the initial values of the raw controls, one float per raw control: 0, or 1 for the w of a
    /// quaternion.
    /// See docs/rig-evaluation.md, 1.2 "Initial values".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_initial_raw_controls(RigHandle rig, MienFloatView* out_values);

    /// <summary>Returns the statistics of a LOD.
    /// Fails with MIEN_ERROR_LOD if the rig has no such LOD.
    /// See docs/rig-evaluation.md, 9.6 "Statistics".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_statistics(RigHandle rig, uint lod, MienRigStatistics* out_statistics);

    /// <summary>Creates an instance in its initial state: one allocation of MienRigInfo.instance_bytes. `rig` may be
    /// destroyed before it. Destroy with mien_instance_destroy().
    /// See docs/rig-evaluation.md, 9.2 "Instances".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_instance_create(RigHandle rig, MienInstanceDesc* desc, out IntPtr out_instance, MienError* error);

    /// <summary>Destroys an instance.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern void mien_instance_destroy(IntPtr instance);

    /// <summary>Resets an instance to its initial state: all inputs and results, at LOD 0.
    /// See docs/rig-evaluation.md, 1.2 "Initial values".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_instance_reset(InstanceHandle instance);

    /// <summary>Returns the GUI controls for the caller to write: one float per GUI control. Only
    /// mien_rig_map_gui_to_raw() reads them.
    /// Contents change with mien_rig_map_raw_to_gui(), mien_instance_reset().</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_instance_gui_controls(InstanceHandle instance, MienMutableFloatView* out_view);

    /// <summary>Returns the raw controls for the caller to write: one float per raw control, typically 0 to 1, not
    /// clamped. They are the inputs of evaluation.
    /// Contents change with mien_rig_map_gui_to_raw(), mien_instance_reset().</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_instance_raw_controls(InstanceHandle instance, MienMutableFloatView* out_view);

    /// <summary>Returns the region masks for the caller to write: one float per region of each mesh, 0 to 1,
    /// initially 1. They switch or blend machine-learned behavior (MIEN_ML_MASKS_...).
    /// Contents change with mien_instance_reset().
    /// See docs/rig-evaluation.md, 8.5 "Region masks".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_instance_ml_masks(InstanceHandle instance, MienMutableFloatView* out_view);

    /// <summary>Returns the control vector: one float per control, the raw, PSD, ML and RBF controls in this order.
    /// Contents change with evaluation, mien_rig_map_gui_to_raw(), mien_instance_reset() and writes to the raw
    /// controls.
    /// See docs/rig-evaluation.md, 1.1 "Control vector".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_instance_controls(InstanceHandle instance, MienFloatView* out_view);

    /// <summary>Returns the PSD controls (correctives) of the control vector: one float per PSD control.
    /// Contents change with evaluation, mien_instance_reset().</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_instance_psd_controls(InstanceHandle instance, MienFloatView* out_view);

    /// <summary>Returns the ML controls of the control vector: one float per ML control.
    /// Contents change with evaluation, mien_instance_reset().</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_instance_ml_controls(InstanceHandle instance, MienFloatView* out_view);

    /// <summary>Returns the RBF pose controls of the control vector: one float per RBF control.
    /// Contents change with evaluation, mien_instance_reset().</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_instance_rbf_controls(InstanceHandle instance, MienFloatView* out_view);

    /// <summary>Returns the joint values: 9 or 10 floats per joint (MIEN_ROTATION_OUTPUT_...), as deltas from the
    /// neutral pose. Translation, angles and scale are added to the neutral ones; with quaternions the
    /// rotation is neutral * delta, so the delta rotates first.
    /// Contents change with evaluation, mien_instance_reset().
    /// See docs/rig-evaluation.md, 4.1 "Joint values".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_instance_joints(InstanceHandle instance, MienFloatView* out_view);

    /// <summary>Returns the weights of the blend shape channels: one float per channel.
    /// Contents change with evaluation, mien_instance_reset().
    /// See docs/rig-evaluation.md, 5 "Blend shapes and animated maps".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_instance_blend_shapes(InstanceHandle instance, MienFloatView* out_view);

    /// <summary>Returns the weights of the animated maps, 0 to 1: one float per animated map.
    /// Contents change with evaluation, mien_instance_reset().
    /// See docs/rig-evaluation.md, 5 "Blend shapes and animated maps".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_instance_animated_maps(InstanceHandle instance, MienFloatView* out_view);

    /// <summary>Returns the statistics of an instance. Takes time proportional to the number of controls: meant for
    /// measurements, not for every frame.
    /// See docs/rig-evaluation.md, 9.6 "Statistics".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_instance_statistics(InstanceHandle instance, MienInstanceStatistics* out_statistics);

    /// <summary>Maps GUI controls to raw controls. Raw controls that the rig's table drives are overwritten with
    /// values clamped to 0..1; others are left unchanged. Does not allocate or lock.
    /// Fails with MIEN_ERROR_MISMATCH if `instance` belongs to another rig.
    /// See docs/rig-evaluation.md, 2.3 "GUI controls to raw controls".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_map_gui_to_raw(RigHandle rig, InstanceHandle instance);

    /// <summary>Maps raw controls to GUI controls. Sets every GUI control to the value that maps to the current raw
    /// controls, or to 0 if there is no such value. Does not allocate or lock.
    /// Fails with MIEN_ERROR_MISMATCH if `instance` belongs to another rig.
    /// See docs/rig-evaluation.md, 2.4 "Raw controls to GUI controls".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_map_raw_to_gui(RigHandle rig, InstanceHandle instance);

    /// <summary>Evaluates all stages at a LOD. Results that the LOD does not drive have their initial value. Inputs
    /// must be finite; then the results are finite too. Changing the LOD between calls is cheap: it resets
    /// the results. Does not allocate or lock. Uses up to 48 KiB of stack.
    /// Fails with MIEN_ERROR_LOD if the rig has no such LOD, MIEN_ERROR_MISMATCH if `instance` belongs to
    /// another rig.
    /// See docs/rig-evaluation.md, 1.3 "Order of evaluation".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_evaluate(RigHandle rig, InstanceHandle instance, uint lod);

    /// <summary>Evaluates some stages, in the order of enum MienStage. The others keep the results of the last
    /// evaluation at this LOD; after a change of LOD they are reset. Does not allocate or lock. Uses up to
    /// 48 KiB of stack.
    /// Fails with MIEN_ERROR_LOD if the rig has no such LOD, MIEN_ERROR_MISMATCH if `instance` belongs to
    /// another rig.
    /// See docs/rig-evaluation.md, 9.3 "Partial evaluation".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_evaluate_stages(RigHandle rig, InstanceHandle instance, uint lod, Stage stages);

    /// <summary>Creates a batch: one allocation of mien_batch_bytes(), which with 16-bit storage includes the weights of
    /// networks as floats, 4 bytes each. `rig` may be destroyed before it. Destroy with
    /// mien_batch_destroy().</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_batch_create(RigHandle rig, MienBatchDesc* desc, out IntPtr out_batch, MienError* error);

    /// <summary>Destroys a batch.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern void mien_batch_destroy(IntPtr batch);

    /// <summary>Returns the memory that a batch would take.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_batch_bytes(RigHandle rig, MienBatchDesc* desc, ulong* out_bytes);

    /// <summary>Evaluates stages of `count` different instances of one rig; instance i at LOD lods[i]. The results
    /// are bit-identical to those of mien_rig_evaluate_stages() (joint values with MIEN_REUSE_SUMS: within the
    /// bound of a full evaluation), but columns of the joint matrix that several
    /// instances use are read only once for up to 32 of them. Runs on the calling thread, or in tasks
    /// on `parallel`; `parallel` may be NULL. Does not allocate or lock. Uses up to 48 KiB of stack per
    /// task. On failure no instance is evaluated.
    /// Fails with MIEN_ERROR_LOD if the rig has no such LOD, MIEN_ERROR_MISMATCH if the batch or an
    /// instance belongs to another rig, MIEN_ERROR_INVALID_ARGUMENT if `count` exceeds
    /// MienBatchDesc.capacity or an instance is listed twice.
    /// See docs/numbers.md, 10 "One by one, in batches, with reused results".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_evaluate_batch(RigHandle rig, BatchHandle batch, IntPtr* instances, uint* lods, uint count, Stage stages, MienParallelFor* parallel);

    /// <summary>Evaluates the joint values of one joint group (MIEN_KIND_JOINT_GROUP), except those that a later
    /// group overrides at all LODs where this one sets them. Does not allocate or lock. Uses up to 48 KiB
    /// of stack.
    /// Fails with MIEN_ERROR_INDEX if there is no such joint group, MIEN_ERROR_LOD if the rig has no such
    /// LOD, MIEN_ERROR_MISMATCH if `instance` belongs to another rig.
    /// See docs/rig-evaluation.md, 4.5 "Order of the joint stage".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_evaluate_joint_group(RigHandle rig, InstanceHandle instance, uint lod, uint group);

    /// <summary>Evaluates the pose controls of one RBF solver (MIEN_KIND_RBF_SOLVER), even if the LOD does not list
    /// it. Does not allocate or lock.
    /// Fails with MIEN_ERROR_INDEX if there is no such solver, MIEN_ERROR_LOD if the rig has no such LOD,
    /// MIEN_ERROR_MISMATCH if `instance` belongs to another rig.
    /// See docs/rig-evaluation.md, 6 "RBF solvers".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_evaluate_rbf_solver(RigHandle rig, InstanceHandle instance, uint lod, uint solver);

    /// <summary>Evaluates the joints of one twist and swing setup (MIEN_KIND_TWIST_SWING). Does not allocate or
    /// lock.
    /// Fails with MIEN_ERROR_INDEX if there is no such setup, MIEN_ERROR_LOD if the rig has no such LOD,
    /// MIEN_ERROR_MISMATCH if `instance` belongs to another rig.
    /// See docs/rig-evaluation.md, 7 "Twist and swing".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_evaluate_twist_swing(RigHandle rig, InstanceHandle instance, uint lod, uint setup);

    /// <summary>Packs the geometry of a DNA for deformation. `dna` is the one that the rig was created from, or the
    /// same file opened with the same LODs. `dna` may be closed and `rig` may be destroyed afterwards. The
    /// deformer is one block of memory; temporary memory is released before the call returns. Destroy with
    /// mien_deformer_destroy().
    ///
    /// Influences of weight 0 and faces of fewer than three corners are dropped. Meshes may lack faces,
    /// weights, normals or texture coordinates: missing normals are computed from the faces, missing
    /// texture coordinates are 0. Stored normals determine which side of a face is outside; without
    /// them, the winding and the axes of the file do.
    ///
    /// Fails with MIEN_ERROR_DNA_LAYER if `dna` was opened without MIEN_LAYER_GEOMETRY, MIEN_ERROR_MISMATCH
    /// if the number or the names of joints, channels or meshes differ from those of the rig,
    /// MIEN_ERROR_DNA_VALUE if a joint is its own ancestor or a position, delta or weight is not finite,
    /// MIEN_ERROR_DNA_LIMIT if a position has more than 65535 influences, MIEN_ERROR_ISA if the requested
    /// instruction set is not available, MIEN_ERROR_INVALID_ARGUMENT if `delta_error` is negative or not finite.
    /// See docs/deformation.md.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_create(DnaHandle dna, RigHandle rig, MienDeformerDesc* desc, out IntPtr out_deformer, MienError* error);

    /// <summary>Creates a deformer of some positions of one mesh. Position i of that mesh is `positions[i]` of the mesh of
    /// `deformer`; it has no vertices or triangles, and all other meshes are empty. Deformed positions have the bits of
    /// the whole mesh (with 16-bit storage they may be rounded otherwise), derivatives those of the chosen rows, and both
    /// take time for the chosen positions only. `positions` are ascending, `position_count` of them. `deformer` may be
    /// destroyed afterwards; the new one keeps its memory. Destroy with mien_deformer_destroy().
    /// Fails with MIEN_ERROR_INDEX if there is no such mesh or position, MIEN_ERROR_INVALID_ARGUMENT if positions are not
    /// ascending.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_create_subset(DeformerHandle deformer, uint mesh, uint* positions, UIntPtr position_count, MienAllocator* allocator, out IntPtr out_deformer, MienError* error);

    /// <summary>Destroys a deformer. Its instances stay valid; its memory is released with the last of them.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern void mien_deformer_destroy(IntPtr deformer);

    /// <summary>Returns the properties of a deformer.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_info(DeformerHandle deformer, MienDeformerInfo* out_info);

    /// <summary>Returns a neutral mesh.
    /// Fails with MIEN_ERROR_INDEX if there is no such mesh.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_mesh(DeformerHandle deformer, uint mesh, MienMesh* out_mesh);

    /// <summary>Writes the triangles of a mesh to `out_triangles`: 3 indices per triangle, as in MienMesh.triangles, with any
    /// storage. `count` is the capacity of `out_triangles`, in indices. With 16-bit storage takes memory for the
    /// duration of the call, 4 bytes per position, from the allocator of the deformer.
    /// Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_INVALID_ARGUMENT if `count` is less than
    /// 3 * MienMesh.triangle_count, MIEN_ERROR_MEMORY if memory ran out.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_triangles(DeformerHandle deformer, uint mesh, uint* out_triangles, UIntPtr count);

    /// <summary>Writes the texture coordinates of a mesh to `out_coordinates`: 2 floats per vertex, u v, with any storage. With
    /// 16-bit storage they are off by at most 1/131070 of the range of the mesh. `count` is the capacity of
    /// `out_coordinates`, in floats.
    /// Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_INVALID_ARGUMENT if `count` is less than
    /// 2 * MienMesh.vertex_count.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_texture_coordinates(DeformerHandle deformer, uint mesh, float* out_coordinates, UIntPtr count);

    /// <summary>Returns the influences of a position, as used for skinning: `out_joints` gets one index per influence,
    /// `out_weights` gets one float per influence. There may be none.
    /// Fails with MIEN_ERROR_INDEX if there is no such mesh or position, MIEN_ERROR_UNSUPPORTED if the weights
    /// are stored with 16 bits (MienDeformerDesc.storage).</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_influences(DeformerHandle deformer, uint mesh, uint position, MienIndex16View* out_joints, MienFloatView* out_weights);

    /// <summary>Writes a blend shape target to `out_deltas`: 3 floats per position, the offset at channel weight 1.
    /// Positions that the target does not move get 0. `count` is the capacity of `out_deltas`, in floats.
    /// Fails with MIEN_ERROR_INDEX if there is no such mesh or target, MIEN_ERROR_INVALID_ARGUMENT if
    /// `count` is less than 3 * MienMesh.position_count.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_target(DeformerHandle deformer, uint mesh, uint target, float* out_deltas, UIntPtr count);

    /// <summary>Returns the model matrices of the neutral pose: 16 floats per joint, column by column, for column
    /// vectors. The last column is the translation, the last row 0 0 0 1.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_bind_matrices(DeformerHandle deformer, MienFloatView* out_matrices);

    /// <summary>Returns the inverses of the bind matrices: 16 floats per joint, column by column.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_inverse_bind_matrices(DeformerHandle deformer, MienFloatView* out_matrices);

    /// <summary>Creates a deformer instance in the neutral pose: one allocation. `deformer` may be destroyed before
    /// it. Destroy with mien_deformer_instance_destroy().</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_instance_create(DeformerHandle deformer, MienDeformerInstanceDesc* desc, out IntPtr out_deformer_instance, MienError* error);

    /// <summary>Destroys a deformer instance.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern void mien_deformer_instance_destroy(IntPtr deformer_instance);

    /// <summary>Copies the joint values and channel weights of the last evaluation of `instance`, and computes the
    /// matrices of all joints. mien_deformer_instance_deform() then deforms meshes. Values that are
    /// not finite give results that are not finite. Does not allocate or lock.
    /// Fails with MIEN_ERROR_MISMATCH if `instance` belongs to a rig other than that of the deformer.
    /// See docs/deformation.md, 1 "Joint transforms".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_instance_update(DeformerInstanceHandle deformer_instance, InstanceHandle instance);

    /// <summary>Does the same with arrays: `joint_values` like those of mien_instance_joints(), `channel_weights`
    /// one per channel. `joint_values` may be NULL with count 0: no deltas. `channel_weights` may be NULL
    /// with count 0: all weights are 0. Does not allocate or lock.
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if a count is not that of the rig.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_instance_update_from_values(DeformerInstanceHandle deformer_instance, float* joint_values, UIntPtr joint_value_count, float* channel_weights, UIntPtr channel_weight_count);

    /// <summary>Returns the model matrices: 16 floats per joint, in the layout of mien_deformer_bind_matrices().
    /// Contents change with mien_deformer_instance_update(), mien_deformer_instance_update_from_values().</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_instance_joint_matrices(DeformerInstanceHandle deformer_instance, MienFloatView* out_matrices);

    /// <summary>Returns the skin matrices, for skinning by the caller, for example on a GPU: 16 floats per joint, in
    /// the layout of mien_deformer_bind_matrices().
    /// Contents change with mien_deformer_instance_update(), mien_deformer_instance_update_from_values().</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_instance_skin_matrices(DeformerInstanceHandle deformer_instance, MienFloatView* out_matrices);

    /// <summary>Writes the joint transforms of the last update, relative to the parents, to `out_transforms`: 10
    /// floats per joint, tx ty tz qx qy qz qw sx sy sz, with quaternions of unit length. `count` is the
    /// capacity of `out_transforms`, in floats. Does not allocate or lock.
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if `count` is less than 10 * MienDeformerInfo.joint_count.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_instance_local_transforms(DeformerInstanceHandle deformer_instance, float* out_transforms, UIntPtr count);

    /// <summary>Computes the positions and normals of a mesh for the last update. Runs on the calling thread; meshes
    /// of at least 16384 positions run in tasks of about 1024 on `parallel`. `parallel` may be NULL. The
    /// results have the same bits either way. Does not allocate or lock. Uses up to 16 KiB of stack per
    /// task.
    /// Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_LOD if `deformer_instance` has no
    /// memory for it (MienDeformerInstanceDesc.lods).
    /// See docs/deformation.md, 2 "Positions" and 3 "Normals".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_instance_deform(DeformerInstanceHandle deformer_instance, uint mesh, Normals normals, MienParallelFor* parallel);

    /// <summary>Deforms the same mesh of `count` different instances of one deformer. The results are bit-identical to
    /// those of mien_deformer_instance_deform(), but each part of the mesh is read only once for all of them,
    /// and the total number of positions decides whether tasks are used. `parallel` may be NULL. Does not
    /// allocate or lock. Uses up to 16 KiB of stack per task. On failure nothing is deformed.
    /// Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_LOD if an instance has no memory for
    /// it, MIEN_ERROR_MISMATCH if the instances have different deformers, MIEN_ERROR_INVALID_ARGUMENT if
    /// an instance is listed twice.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_instance_deform_batch(IntPtr* deformer_instances, UIntPtr count, uint mesh, Normals normals, MienParallelFor* parallel);

    /// <summary>Returns the deformed positions of a mesh: 3 floats per position, x y z.
    /// Contents change with mien_deformer_instance_deform(), mien_deformer_instance_write_vertices() and
    /// their batches.
    /// Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_LOD if `deformer_instance` has no
    /// memory for it.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_instance_positions(DeformerInstanceHandle deformer_instance, uint mesh, MienFloatView* out_positions);

    /// <summary>Returns the deformed normals of a mesh: 3 floats per vertex, x y z, unit length.
    /// Contents change with mien_deformer_instance_deform(), mien_deformer_instance_write_vertices() and
    /// their batches.
    /// Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_LOD if `deformer_instance` has no
    /// memory for it.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_instance_normals(DeformerInstanceHandle deformer_instance, uint mesh, MienFloatView* out_normals);

    /// <summary>Deforms a mesh as mien_deformer_instance_deform() does, and writes its vertices to memory of the
    /// caller, such as a mapped vertex buffer. Each byte is written once, in the order of the vertices, and
    /// none is read, so the memory may be write-combined. Bytes between vertices are left unchanged. `parallel`
    /// may be NULL; the bytes are the same either way. The same positions, normals and tangents give the
    /// same bytes on every instruction set. Does not allocate or lock. Uses up to 16 KiB of stack per task.
    /// On failure nothing is deformed or written.
    /// Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_LOD if `deformer_instance` has no
    /// memory for it, MIEN_ERROR_INVALID_ARGUMENT if a stream has a format that its attribute cannot have,
    /// a wrong stride or alignment or too little capacity, if streams overlap, if there is no stream, or if
    /// tangents are requested from a deformer without them.
    /// See docs/deformation.md, 5 "Vertex output".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_instance_write_vertices(DeformerInstanceHandle deformer_instance, uint mesh, Normals normals, MienVertexOutput* output, MienParallelFor* parallel);

    /// <summary>Does the same for one mesh of `count` different instances of one deformer: instance i is written to
    /// outputs[i]. All outputs have the same struct_size, and must not share bytes. `parallel` may be NULL.
    /// Does not allocate or lock. Uses up to 16 KiB of stack per task.
    /// Fails like mien_deformer_instance_write_vertices(), and with MIEN_ERROR_MISMATCH if the instances have
    /// different deformers, MIEN_ERROR_INVALID_ARGUMENT if an instance is listed twice.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_instance_write_vertices_batch(IntPtr* deformer_instances, UIntPtr count, uint mesh, Normals normals, MienVertexOutput* outputs, MienParallelFor* parallel);

    /// <summary>Creates derivatives. `desc` may be NULL. `rig` may be destroyed afterwards, and so may the deformer.
    /// Takes one block of memory, which holds a copy of the weights of networks, room for 32 directions, and 8
    /// bytes for each 8 numbers of the joint matrix.
    /// Destroy with mien_derivatives_destroy().
    /// Fails with MIEN_ERROR_MISMATCH if the deformer is not of the rig.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_derivatives_create(RigHandle rig, MienDerivativesDesc* desc, out IntPtr out_derivatives, MienError* error);

    /// <summary>Destroys derivatives. NULL is allowed.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern void mien_derivatives_destroy(IntPtr derivatives);

    /// <summary>Returns the number of bytes that mien_derivatives_create() would allocate.
    /// Fails with MIEN_ERROR_MISMATCH if the deformer is not of the rig.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_derivatives_bytes(RigHandle rig, MienDerivativesDesc* desc, ulong* out_bytes);

    /// <summary>Returns how many numbers a point has. `mesh` is the index of the mesh of MIEN_POINT_POSITIONS, else 0.
    /// Fails with MIEN_ERROR_INDEX if there is no such mesh, or the point needs a deformer and there is none.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_derivatives_size(DerivativesHandle derivatives, Point point, uint mesh, UIntPtr* out_size);

    /// <summary>Computes the derivatives at the values of `instance`, which must belong to the rig and have been
    /// evaluated, alone or in a batch, at the LOD of that evaluation. `stages` selects the stages to differentiate, MIEN_STAGE_ALL or
    /// some of them: the results of the others count as constants. Does not allocate or lock.
    /// Where a function has no derivative, a one-sided one is used, so that solvers do not get stuck:
    ///   - controls at 0 or 1, for correctives, GUI controls and maps: into the interval
    ///   - where two intervals of a conditional table meet: that of the steeper one
    ///   - RBF poses with a weight below the threshold: as without a threshold; at a stored pose: 0
    ///   - ReLU at 0: as above 0
    /// Saturation is ignored: values that overflow have the derivatives of the formula. Controls that a network
    /// or solver reads before they are computed count as constants.
    /// Fails with MIEN_ERROR_MISMATCH if the instance is not of the rig.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_derivatives_linearize(DerivativesHandle derivatives, InstanceHandle instance, Stage stages);

    /// <summary>Multiplies directions by the matrix of derivatives (Jacobian-vector products). Each of the `count`
    /// directions is a row of mien_derivatives_size() numbers at `from`; its output is the resulting change of
    /// the numbers at `to`. Rows follow each other without gaps; `outputs` has `count` rows and must not overlap
    /// `directions`. Several directions in one call are faster than one by one, and give the same bits. Does not
    /// allocate or lock.
    /// Fails with MIEN_ERROR_INDEX if a point lacks its deformer or mesh, MIEN_ERROR_INVALID_ARGUMENT if `from`
    /// has no effect on `to` or nothing was linearized.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_derivatives_forward(DerivativesHandle derivatives, uint from, uint to, uint mesh, uint count, float* directions, float* outputs);

    /// <summary>Multiplies gradients by the transposed matrix (vector-Jacobian products): turns each of `count` gradients
    /// with respect to the numbers at `to` into the gradient with respect to those at `from`. All else is as in
    /// mien_derivatives_forward().
    /// Fails with MIEN_ERROR_INDEX if a point lacks its deformer or mesh, MIEN_ERROR_INVALID_ARGUMENT if `from`
    /// has no effect on `to` or nothing was linearized.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_derivatives_reverse(DerivativesHandle derivatives, uint from, uint to, uint mesh, uint count, float* gradients, float* outputs);

    /// <summary>Creates a matrix for derivatives that have the rig and the deformer of `derivatives`, linearized or not.
    /// `derivatives` may be destroyed afterwards. The matrix takes one block of memory: 8 bytes per entry, 4 per
    /// row, 20 per column. More is needed until the call returns: 4 bytes per row, 12 per column, and 8 for each
    /// number on the way (controls, joint values, matrices, results of networks, positions of the mesh).
    /// Destroy with mien_jacobian_destroy().
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if from_point has no effect on to_point or the outputs do not
    /// ascend, MIEN_ERROR_INDEX if a point lacks its deformer or mesh, or an input or output does not exist,
    /// MIEN_ERROR_LOD if the rig has no such LOD.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_jacobian_create(DerivativesHandle derivatives, MienJacobianDesc* desc, out IntPtr out_jacobian, MienError* error);

    /// <summary>Destroys a matrix. NULL is allowed.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern void mien_jacobian_destroy(IntPtr jacobian);

    /// <summary>Returns the entries. They are the same in all poses, so a solver can order and factor the matrix
    /// symbolically once. The views are valid until the matrix is destroyed.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_jacobian_pattern(JacobianHandle jacobian, MienJacobianPattern* out_pattern);

    /// <summary>Computes the entries of a matrix at the values that were linearized: `values` gets a float per entry of
    /// the pattern, of which some may be 0. Each is equal to what mien_derivatives_forward() computes for a
    /// direction that is 1 at the number of its column, else 0. `wanted` may be NULL: all columns; otherwise it
    /// has a byte per column, and entries of columns with a 0 are not computed and keep their values. Threads may
    /// use one matrix at the same time, each with derivatives of its own. Does not allocate or lock.
    /// Fails with MIEN_ERROR_MISMATCH if the matrix was created for another rig or deformer, or the values were
    /// linearized at another LOD, MIEN_ERROR_INVALID_ARGUMENT if nothing was linearized, `value_count` is not
    /// the number of entries, or `wanted_count` not that of columns (0 if `wanted` is NULL).</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_derivatives_jacobian(DerivativesHandle derivatives, JacobianHandle jacobian, byte* wanted, UIntPtr wanted_count, float* values, UIntPtr value_count);

    /// <summary>Writes a rig and its deformer to a baked file. `deformer` may be NULL. The file is written under a
    /// temporary name and renamed, so that a failure leaves `path` unchanged.
    /// Fails with MIEN_ERROR_MISMATCH if `deformer` was created for another rig, MIEN_ERROR_FILE_WRITE if
    /// the file cannot be written, MIEN_ERROR_MEMORY if the allocator of the rig returns NULL.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_bake_file(RigHandle rig, DeformerHandle deformer, byte* path, MienError* error);

    /// <summary>Writes a baked file to memory and returns its size in `out_size`. `deformer` may be NULL. `buffer`
    /// may be NULL with capacity 0 to get the size only. Writes nothing if `capacity` is too small;
    /// `out_size` is set nevertheless.
    /// Fails with MIEN_ERROR_MISMATCH if `deformer` was created for another rig,
    /// MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_bake_memory(RigHandle rig, DeformerHandle deformer, void* buffer, UIntPtr capacity, UIntPtr* out_size, MienError* error);

    /// <summary>Opens a baked file. By default it is mapped, so processes that open the same file share its pages. Do not
    /// truncate or overwrite a mapped file until all objects made from it are destroyed; replacing it by
    /// renaming is safe. The header is checked now, the rest when objects are created. One allocation, and
    /// one more for the bytes if the file is not mapped. Close with mien_baked_close().
    /// Fails with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ if the file cannot be read,
    /// MIEN_ERROR_BAKED_SIGNATURE, MIEN_ERROR_BAKED_VERSION, MIEN_ERROR_BAKED_TRUNCATED or
    /// MIEN_ERROR_BAKED_STRUCTURE if its header is not valid, MIEN_ERROR_BAKED_CHECKSUM if
    /// MIEN_BAKED_CHECK_FULL finds changed bytes.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_baked_open_file(byte* path, MienBakedDesc* desc, out IntPtr out_baked, MienError* error);

    /// <summary>Opens a baked file in memory: `size` bytes. `bytes` must outlive the MienBaked and all objects made
    /// from it, unchanged, unless they are copied: with MIEN_FILE_READ, or if `bytes` is not aligned to
    /// 64.
    /// Fails like mien_baked_open_file(), but not with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_baked_open_memory(void* bytes, UIntPtr size, MienBakedDesc* desc, out IntPtr out_baked, MienError* error);

    /// <summary>Opens a baked file through a stream, which is read at once into memory of the allocator.
    /// Fails like mien_baked_open_file(), but not with MIEN_ERROR_FILE_OPEN.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_baked_open_stream(MienStream* stream, MienBakedDesc* desc, out IntPtr out_baked, MienError* error);

    /// <summary>Closes a baked file. Objects made from it stay valid; its memory is released and the file unmapped
    /// with the last of them.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern void mien_baked_close(IntPtr baked);

    /// <summary>Returns the properties of an open baked file.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_baked_info(BakedHandle baked, MienBakedInfo* out_info);

    /// <summary>Creates the rig of a baked file, with one allocation, or two with MIEN_REUSE_SUMS. `baked` may be closed afterwards. Destroy with
    /// mien_rig_destroy().
    /// Fails with MIEN_ERROR_BAKED_PART if the file has no rig, MIEN_ERROR_BAKED_VERSION or
    /// MIEN_ERROR_BAKED_STRUCTURE if its rig cannot be used, MIEN_ERROR_ISA if the requested instruction set
    /// is not available.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_from_baked(BakedHandle baked, MienBakedRigDesc* desc, out IntPtr out_rig, MienError* error);

    /// <summary>Creates the deformer of a baked file, with one allocation. `rig` is the one created from the same
    /// MienBaked. `baked` may be closed and `rig` may be destroyed afterwards. Destroy with
    /// mien_deformer_destroy().
    /// Fails with MIEN_ERROR_MISMATCH if `rig` was not created from `baked`, MIEN_ERROR_BAKED_PART if the
    /// file has no deformer, MIEN_ERROR_BAKED_VERSION or MIEN_ERROR_BAKED_STRUCTURE if its deformer cannot be
    /// used, MIEN_ERROR_ISA if the requested instruction set is not available.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_deformer_from_baked(BakedHandle baked, RigHandle rig, MienBakedDeformerDesc* desc, out IntPtr out_deformer, MienError* error);

    /// <summary>Builds a clip in memory. `desc` is required. The same values give the same bytes on every machine.
    /// Close with mien_clip_close().
    /// Fails with MIEN_ERROR_CLIP_VALUE if a value is not finite (the message names frame and channel),
    /// MIEN_ERROR_NAME if a name is empty or occurs twice, MIEN_ERROR_CLIP_LIMIT if there are too many
    /// frames, channels or bytes.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_build(MienClipDesc* desc, out IntPtr out_clip, MienError* error);

    /// <summary>Opens a clip. By default it is mapped: do not truncate or overwrite the file until the clip is closed
    /// and its players are destroyed; replacing it by renaming is safe. Names and events are checked now,
    /// curves when they are decoded: damaged ones decode to zeros (see mien_clip_verify()). Close with
    /// mien_clip_close().
    /// Fails with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ if the file cannot be read,
    /// MIEN_ERROR_CLIP_SIGNATURE, MIEN_ERROR_CLIP_VERSION, MIEN_ERROR_CLIP_TRUNCATED or
    /// MIEN_ERROR_CLIP_STRUCTURE if it is not a valid clip.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_open_file(byte* path, MienClipOpenDesc* desc, out IntPtr out_clip, MienError* error);

    /// <summary>Opens a clip in memory, at any alignment. `bytes` must outlive the clip and its players, unchanged.
    /// Fails like mien_clip_open_file(), but not with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_open_memory(void* bytes, UIntPtr size, MienClipOpenDesc* desc, out IntPtr out_clip, MienError* error);

    /// <summary>Opens a clip through a stream, which is read completely into memory of the allocator.
    /// Fails like mien_clip_open_file(), but not with MIEN_ERROR_FILE_OPEN.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_open_stream(MienStream* stream, MienClipOpenDesc* desc, out IntPtr out_clip, MienError* error);

    /// <summary>Closes a clip. Players stay valid; memory is released and the file unmapped with the last of them.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern void mien_clip_close(IntPtr clip);

    /// <summary>Writes a clip to a file. The file is written under a temporary name and renamed, so that a failure
    /// leaves `path` unchanged.
    /// Fails with MIEN_ERROR_FILE_WRITE if the file cannot be written, MIEN_ERROR_MEMORY if the allocator of
    /// the clip returns NULL.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_write_file(ClipHandle clip, byte* path, MienError* error);

    /// <summary>Writes a clip to memory and returns its size in `out_size`. `buffer` may be NULL with capacity 0 to
    /// get the size only. Writes nothing if `capacity` is too small; `out_size` is set nevertheless.
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_write_memory(ClipHandle clip, void* buffer, UIntPtr capacity, UIntPtr* out_size, MienError* error);

    /// <summary>Returns the properties of a clip.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_info(ClipHandle clip, MienClipInfo* out_info);

    /// <summary>Returns a channel. Channels keep the order in which the clip was built. The name is a view into the
    /// clip.
    /// Fails with MIEN_ERROR_INDEX if `index` is out of range.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_channel(ClipHandle clip, uint index, MienClipChannel* out_channel);

    /// <summary>Returns the index of the channel with this name. Searches all channels.
    /// Fails with MIEN_ERROR_NAME if there is none.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_find_channel(ClipHandle clip, byte* name, uint* out_index);

    /// <summary>Returns the index of the channel with this name. Searches all channels.
    /// Fails with MIEN_ERROR_NAME if there is none.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_find_channel_n(ClipHandle clip, byte* name, UIntPtr name_count, uint* out_index);

    /// <summary>Returns an event. Events are sorted by tick; those at the same tick keep the order in which they were
    /// given. The name is a view into the clip.
    /// Fails with MIEN_ERROR_INDEX if `index` is out of range.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_event(ClipHandle clip, uint index, MienClipEvent* out_event);

    /// <summary>Checks that no byte of a clip has changed since it was written and that all curves can be decoded.
    /// Reads the whole clip. Uses up to 48 KiB of stack.
    /// Fails with MIEN_ERROR_CLIP_CHECKSUM if bytes have changed, MIEN_ERROR_CLIP_STRUCTURE if a curve cannot
    /// be decoded.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_verify(ClipHandle clip, MienError* error);

    /// <summary>Copies `frame_count` frames, starting at `first_frame`: channel c of frame first_frame + n goes to
    /// out_values[n * frame_stride + c]. frame_stride is at least the number of channels; 0 means that
    /// number. Each call decodes from the start of a block of 64 frames, so reading many frames in one
    /// call costs less than reading them one by one. Uses up to 48 KiB of stack.
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if frame_stride is too small, MIEN_ERROR_INDEX if the
    /// clip has fewer frames, MIEN_ERROR_CLIP_STRUCTURE if a curve is damaged; its block in `out_values` is
    /// zero.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_read(ClipHandle clip, uint first_frame, uint frame_count, float* out_values, UIntPtr frame_stride, MienError* error);

    /// <summary>Creates a player, with one allocation. `clip` may be closed before the player is destroyed. Destroy with
    /// mien_clip_player_destroy().</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_player_create(ClipHandle clip, MienClipPlayerDesc* desc, out IntPtr out_clip_player, MienError* error);

    /// <summary>Destroys a player.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern void mien_clip_player_destroy(IntPtr clip_player);

    /// <summary>Returns the state of a player.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_player_info(ClipPlayerHandle clip_player, MienClipPlayerInfo* out_info);

    /// <summary>Moves to a tick: modulo the length with MIEN_LOOPING_WRAP, otherwise clamped to the range. Reports no
    /// events; the next mien_clip_player_advance() also reports events at this tick, as it does after
    /// creation. Does not allocate or lock.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_player_seek(ClipPlayerHandle clip_player, long tick);

    /// <summary>Sets the speed for later calls of mien_clip_player_advance(). Does not allocate or lock.
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if it is outside the range of MienClipPlayerDesc.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_player_set_speed(ClipPlayerHandle clip_player, int numerator, int denominator);

    /// <summary>Moves by `ticks` times the speed. `ticks` is -2^40 to 2^40 (26 minutes). Fractions of ticks are kept,
    /// so the position does not depend on the step size. Does not allocate or lock.
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if `ticks` is out of range.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_player_advance(ClipPlayerHandle clip_player, long ticks);

    /// <summary>Returns the next event that the last mien_clip_player_advance() passed. `out_found` is 1, or 0 after
    /// the last event. An event is passed when the position reaches or crosses its tick in either
    /// direction, once per loop. The name is a view into the clip. Does not allocate or lock.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_player_next_event(ClipPlayerHandle clip_player, MienClipEvent* out_event, uint* out_found);

    /// <summary>Returns the values at the current position: one float per channel. Exactly at a frame they are
    /// bit-identical to those of the clip. Decodes the frames since the last call, or at most 64 after a jump;
    /// without MienClipPlayerDesc.reverse, each step backward is a jump. Does not allocate or lock.
    /// Contents change with mien_clip_player_sample().</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_player_sample(ClipPlayerHandle clip_player, MienFloatView* out_values);

    /// <summary>Binds a clip to a rig by names. A channel drives the raw control with its name. If there is none, it
    /// drives the GUI control with its name, which is then mapped as by mien_rig_map_gui_to_raw(). If there is
    /// none either, it drives the controls of its entries in the matrix, which are summed in the order of the
    /// matrix. Names match without regard to case; `.` matches `_`; the prefix `CTRL_expressions.` may be
    /// missing. If several names match, only an exact match counts. A channel that drives nothing so far drives
    /// the controls that mien_rig_match() finds for its name, such as mouthSmile_L for mouthSmileLeft; these are
    /// summed after those of the matrix. A raw control that a channel drives by name is driven by nothing else,
    /// and one that the matrix or mien_rig_match() drives is not driven by GUI controls. Names without a match
    /// are not an error: see mien_clip_binding_info(). `clip` may be closed and `rig` may be destroyed
    /// afterwards. Destroy with mien_clip_binding_destroy().
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if a weight is not finite, MIEN_ERROR_CLIP_LIMIT if channels
    /// drive more than 4095 GUI controls.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_binding_create(ClipHandle clip, RigHandle rig, MienClipBindingDesc* desc, out IntPtr out_clip_binding, MienError* error);

    /// <summary>Returns a matrix that binds clips with the 52 ARKit expression names, such as those of the Live Link
    /// Face app, to rigs with the other common naming of raw controls (eyeBlinkL for eyeBlinkLeft). It suits
    /// every rig: channels whose names the rig has do not use the matrix, and entries for missing controls are
    /// skipped. docs/face-capture.md, 3 "ARKit expressions on raw controls" explains the entries. Writes as
    /// many entries as fit; `out_count` is the total number. Names are static. `out_entries` may be NULL if
    /// `capacity` is 0.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_arkit_matrix(MienMatrixEntry* out_entries, UIntPtr capacity, UIntPtr* out_count);

    /// <summary>Destroys a binding.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern void mien_clip_binding_destroy(IntPtr clip_binding);

    /// <summary>Returns what a binding found.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_binding_info(ClipBindingHandle clip_binding, MienClipBindingInfo* out_info);

    /// <summary>Computes the raw controls that are driven and leaves the others unchanged. `values` has one float
    /// per channel, as mien_clip_player_sample() returns them; `raw_controls` has one float per raw control,
    /// as mien_instance_raw_controls() returns them. Values that drive raw controls by name are
    /// copied exactly; GUI controls give the same bits as mien_rig_map_gui_to_raw(). Does not allocate or
    /// lock. Uses up to 16 KiB of stack.
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if a count differs from that of the clip or the rig.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_binding_apply(ClipBindingHandle clip_binding, float* values, UIntPtr value_count, float* raw_controls, UIntPtr raw_control_count);

    /// <summary>Finds for each channel of a clip the coarsest rounding step with no visible effect, for
    /// MienClipDesc.snaps: the largest of 2^-9 to 2^-16 of which half moves no vertex of LOD 0 by more than
    /// `tolerance`, in millimeters, such as 0.02. If LOD 0 has no meshes, joints are measured instead. Each
    /// channel is tried at five values from 0 to 1, and from -1 on if GUI controls are driven, with all other
    /// channels at 0. Channels that drive nothing get 2^-11; channels for which even the finest step is too
    /// coarse get 0. To use the steps, build a clip with all bits, bind it, then build it again with them.
    /// Evaluates and deforms the rig at least 10 times per channel, and takes memory from its allocator during
    /// the call.
    /// Fails with MIEN_ERROR_MEMORY if that returns NULL, MIEN_ERROR_MISMATCH if `channel_count` is not that of
    /// the binding, or the binding is for another rig, MIEN_ERROR_INVALID_ARGUMENT if `tolerance` is not a
    /// number above 0.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_clip_binding_snaps(ClipBindingHandle clip_binding, DeformerHandle deformer, float tolerance, float* out_snaps, UIntPtr channel_count, MienError* error);

    /// <summary>Creates a mix for a rig. `desc` is required. `rig` may be destroyed afterwards, and so may the
    /// deformer. Measuring guards takes time: it evaluates and deforms the rig at LOD 0 for each raw control
    /// and for pairs of raw controls that share a corrective. Destroy with mien_mix_destroy().
    /// Fails with MIEN_ERROR_MISMATCH if the deformer or the gaze is for another rig, MIEN_ERROR_INDEX if a
    /// landmark names a mesh, position or joint that does not exist, MIEN_ERROR_INVALID_ARGUMENT if a field
    /// of `desc` is out of range; the message names it, MIEN_ERROR_DNA_LIMIT if guards are measured and raw
    /// controls times joints exceed 2^22.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mix_create(RigHandle rig, MienMixDesc* desc, out IntPtr out_mix, MienError* error);

    /// <summary>Opens a mix for a rig, which must have all controls that the mix uses; names match as in
    /// mien_clip_binding_create(). For other controls of the rig, the masks of the file are 0 and there are no
    /// limits. Guards and gaze are those measured when the mix was created. `rig` may be NULL: then the raw
    /// controls are those of the file, to inspect it or to write it again. `rig` may be destroyed afterwards.
    /// A hostile file may make mixers large: check MienMixInfo.mixer_bytes. Destroy with mien_mix_destroy().
    /// Fails with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ if the file cannot be read,
    /// MIEN_ERROR_MIX_SIGNATURE, MIEN_ERROR_MIX_VERSION, MIEN_ERROR_MIX_TRUNCATED, MIEN_ERROR_MIX_CHECKSUM or
    /// MIEN_ERROR_MIX_STRUCTURE if it is not a valid mix, MIEN_ERROR_NAME if the rig lacks controls; the
    /// message names them.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mix_open_file(byte* path, RigHandle rig, MienMixOpenDesc* desc, out IntPtr out_mix, MienError* error);

    /// <summary>Opens a mix in memory. `bytes` may be released afterwards. `rig` may be NULL. `rig` may be destroyed
    /// afterwards.
    /// Fails like mien_mix_open_file(), but not with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mix_open_memory(void* bytes, UIntPtr size, RigHandle rig, MienMixOpenDesc* desc, out IntPtr out_mix, MienError* error);

    /// <summary>Writes a mix to a file: the arguments of mien_mix_create(), what it measured, and the names of the
    /// controls that the mix uses. Equal mixes give the same bytes on every machine; a mix that was opened is
    /// written with the bytes of its file. The file is written under a temporary name and renamed, so that a
    /// failure leaves `path` unchanged. Takes memory from the allocator of the mix during the call.
    /// Fails with MIEN_ERROR_MEMORY if that returns NULL, MIEN_ERROR_NAME if two of these controls have the
    /// same name, MIEN_ERROR_FILE_WRITE if the file cannot be written.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mix_write_file(MixHandle mix, byte* path, MienError* error);

    /// <summary>Writes a mix to memory and returns its size in `out_size`. `buffer` may be NULL with capacity 0 to get
    /// the size only. Writes nothing if `capacity` is too small; `out_size` is set nevertheless.
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small, MIEN_ERROR_MEMORY and MIEN_ERROR_NAME
    /// if mien_mix_write_file() would fail with them.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mix_write_memory(MixHandle mix, void* buffer, UIntPtr capacity, UIntPtr* out_size, MienError* error);

    /// <summary>Writes a mix as text, for reading and for version control: one line for each number, with its path in
    /// the mix and the names of controls. Floats have nine digits, enough to restore their bits. The text
    /// cannot be opened as a mix, and is not null-terminated. `buffer` may be NULL with capacity 0 to get the
    /// size only.
    /// Fails like mien_mix_write_memory().</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mix_write_text(MixHandle mix, void* buffer, UIntPtr capacity, UIntPtr* out_size, MienError* error);

    /// <summary>Destroys a mix. Its mixers stay valid; its memory is released with the last of them.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern void mien_mix_destroy(IntPtr mix);

    /// <summary>Returns the properties of a mix.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mix_info(MixHandle mix, MienMixInfo* out_info);

    /// <summary>Returns the measured function of a guard. `guard_index` counts as in mien_mixer_set_guard(), from 0 to
    /// MienMixInfo.guard_count - 1; mien_mixer_guard() has its name.
    /// Fails with MIEN_ERROR_INDEX if there is no such guard.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mix_guard(MixHandle mix, uint guard_index, MienMixGuardInfo* out_guard);

    /// <summary>Returns a ready-made reaction to a light in the eyes, with 5 strokes. The caller provides its poses, from
    /// `first_pose` on: lids closed; squint and lowered brows; gaze turned away; narrow pupils; head turned
    /// away. docs/mixing.md, 3 "Reactions" lists the times. `out_reaction` refers to `out_strokes`.
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if `stroke_count` is less than 5.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mix_glare(uint first_pose, MienMixStroke* out_strokes, UIntPtr stroke_count, MienMixReaction* out_reaction);

    /// <summary>Finds antagonists: pairs of raw controls that only the two halves of one GUI control drive. Writes as
    /// many as fit, with stiffness 1; `out_count` is the total number. `out_pairs` may be NULL if `capacity` is
    /// 0. Raw controls from 4096 on, which no mix has, are left out.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mix_antagonists(RigHandle rig, MienMixAntagonists* out_pairs, UIntPtr capacity, UIntPtr* out_count);

    /// <summary>Finds the counterparts of raw controls in the other half of the face, for MienMixDesc.mirror. Controls
    /// are counterparts if their names differ only in Left and Right (or L and R) and their motions agree, or
    /// else if their motions are mirror images. Other controls, and curves beyond the raw controls, map to
    /// themselves. Evaluates the rig once for each raw control, and takes memory from its allocator during
    /// the call.
    /// Fails with MIEN_ERROR_MEMORY if that returns NULL, MIEN_ERROR_MISMATCH if `curve_count` is less than the
    /// raw controls, MIEN_ERROR_DNA_LIMIT if raw controls times joints exceed 2^22.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mix_mirror(DeformerHandle deformer, ushort* out_curves, UIntPtr curve_count, MienError* error);

    /// <summary>Computes a mask that selects joint groups: for each raw control the share of its joint motion, at
    /// value 1 and LOD 0, that belongs to these groups. A millimeter counts as much as a degree. Controls
    /// that move no joint, and curves beyond the raw controls, get `otherwise_weight`. Evaluates the rig once
    /// for each raw control and group, and takes memory from its allocator during the call.
    /// Fails with MIEN_ERROR_MEMORY if that returns NULL, MIEN_ERROR_INDEX if a group does not exist,
    /// MIEN_ERROR_MISMATCH if `curve_count` is less than the raw controls.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mix_mask(RigHandle rig, uint* groups, UIntPtr group_count, float otherwise_weight, float* out_mask, UIntPtr curve_count, MienError* error);

    /// <summary>Creates a gaze by measuring how raw controls turn the eyes, which evaluates the rig at least twice per
    /// raw control. `deformer` may be destroyed afterwards. Destroy with mien_gaze_destroy().
    /// Fails with MIEN_ERROR_NAME if there are no such joints, MIEN_ERROR_INVALID_ARGUMENT if no raw
    /// control turns an eye monotonically in one of the four directions.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_gaze_create(DeformerHandle deformer, MienGazeDesc* desc, out IntPtr out_gaze, MienError* error);

    /// <summary>Destroys a gaze.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern void mien_gaze_destroy(IntPtr gaze);

    /// <summary>Returns where the eyes are, so that a target can be placed in front of them.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_gaze_info(GazeHandle gaze, MienGazeInfo* out_info);

    /// <summary>Sets the raw controls of a row so that both eyes look at a target. Eyes converge on near targets.
    /// `out_rest` may be NULL. Does not allocate or lock.
    /// Fails with MIEN_ERROR_MISMATCH if `row_count` is less than the raw controls, MIEN_ERROR_INVALID_ARGUMENT
    /// if the target is not finite.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_gaze_look_at(GazeHandle gaze, MienGazeTarget* target, float* row, UIntPtr row_count, MienGazeRest* out_rest);

    /// <summary>Creates a mixer at time 0, with one allocation. No clip plays; pose weights and pose variables are 0.
    /// `mix` may be destroyed before it. Destroy with mien_mixer_destroy().</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mixer_create(MixHandle mix, MienMixerDesc* desc, out IntPtr out_mixer, MienError* error);

    /// <summary>Destroys a mixer.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern void mien_mixer_destroy(IntPtr mixer);

    /// <summary>Plays a clip in a layer, from the next step on. `clip` and `clip_binding` must outlive their playback,
    /// including the transition to the next clip. On failure the layer continues as before. Does not allocate or
    /// lock.
    /// Fails with MIEN_ERROR_INDEX if the layer does not exist or has another source, MIEN_ERROR_MISMATCH if
    /// the binding is for another clip or rig, MIEN_ERROR_INVALID_ARGUMENT if a time, speed or enum value is
    /// out of range or a delta clip would play in a layer that overrides, MIEN_ERROR_CLIP_LIMIT if the clip is
    /// larger than the mix allows.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mixer_play(MixerHandle mixer, uint layer, ClipHandle clip, ClipBindingHandle clip_binding, MienPlayDesc* desc, MienError* error);

    /// <summary>Fades out the clip of a layer and stops it. Fades take 0 to 2^40 ticks, here and below; they start from
    /// the current value and speed, and end with speed 0. Does not allocate or lock.
    /// Fails with MIEN_ERROR_INDEX if the layer does not exist or is not a clip layer.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mixer_stop(MixerHandle mixer, uint layer, long fade_ticks);

    /// <summary>Fades the weight of a layer to `weight`, which has the range of MienMixLayer.weight. Does not allocate or
    /// lock.
    /// Fails with MIEN_ERROR_INDEX if the layer does not exist.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mixer_set_weight(MixerHandle mixer, uint layer, float weight, long fade_ticks);

    /// <summary>Fades the weight of a pose to `weight`, 0 to 1. `pose` counts from the first pose of the layer. Weights
    /// of a layer that add up to more than 1 are divided by their sum. Does not allocate or lock.
    /// Fails with MIEN_ERROR_INDEX if the layer or its pose does not exist.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mixer_set_pose_weight(MixerHandle mixer, uint layer, uint pose, float weight, long fade_ticks);

    /// <summary>Sets the `value` that a pose variable has at the start of each step, before the layers. Does not
    /// allocate or lock.
    /// Fails with MIEN_ERROR_INDEX if it does not exist, MIEN_ERROR_INVALID_ARGUMENT if the value is not
    /// finite.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mixer_set_variable(MixerHandle mixer, uint variable, float value);

    /// <summary>Sets how much a guard acts: `activation` is 0 to 1, or negative for automatic, the default: the smaller
    /// the gap that base and speech leave, the more the guard acts; guards of lips and teeth act at most as
    /// much as the largest weight of a speech layer. mien_mixer_guard() returns the name for a `guard_index`.
    /// Does not allocate or lock.
    /// Fails with MIEN_ERROR_INDEX if the guard does not exist, MIEN_ERROR_INVALID_ARGUMENT if `activation` is
    /// above 1 or not a number.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mixer_set_guard(MixerHandle mixer, uint guard_index, float activation);

    /// <summary>Returns what a guard did in the last step. `guard_index` counts as in mien_mixer_set_guard(). Views point
    /// into the mix.
    /// Fails with MIEN_ERROR_INDEX if the guard does not exist.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mixer_guard(MixerHandle mixer, uint guard_index, MienGuardState* out_state);

    /// <summary>Starts a reaction to a stimulus of `strength`, 0 to 1, that lasts for `hold_ticks`, at most 2^40; if
    /// negative, until mien_mixer_release(). Does not allocate or lock.
    /// Fails with MIEN_ERROR_INDEX if the reaction does not exist, MIEN_ERROR_INVALID_ARGUMENT if strength or
    /// time is out of range.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mixer_trigger(MixerHandle mixer, uint reaction, float strength, long hold_ticks);

    /// <summary>Ends the stimulus of a reaction. Does not allocate or lock.
    /// Fails with MIEN_ERROR_INDEX if the reaction does not exist.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mixer_release(MixerHandle mixer, uint reaction);

    /// <summary>Sets the level of what a reaction responds to, such as a brightness, 0 to 1. Call it whenever the level
    /// changes. A level of MienMixReaction.level_on or more is a stimulus of strength 1, which ends once the
    /// level has been below level_off for 50 ms, so a flickering light counts as on. During the stimulus, scaled
    /// strokes follow the level without overshoot; 90 % of a change takes 0.25 s. Does not allocate or lock.
    /// Fails with MIEN_ERROR_INDEX if the reaction does not exist, MIEN_ERROR_INVALID_ARGUMENT if it has no
    /// level_on or `level` is out of range.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mixer_set_level(MixerHandle mixer, uint reaction, float level);

    /// <summary>Queues a row for a stream layer: one value per channel, for time `tick` of the mixer. One thread may call
    /// this while another one uses the mixer. `out_accepted` may be NULL; it is set to 0 if the row is dropped
    /// because it is not newer than the last one or the queue is full. Does not allocate or lock.
    /// Fails with MIEN_ERROR_INDEX if the layer does not exist or is not a stream, MIEN_ERROR_MISMATCH if it has
    /// another number of channels, MIEN_ERROR_INVALID_ARGUMENT if a value is not finite or `tick` is 2^61 or
    /// more.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mixer_push(MixerHandle mixer, uint layer, long tick, float* values, UIntPtr value_count, uint* out_accepted);

    /// <summary>Advances the time by `ticks`, 0 to 2^40, and mixes. Writes the raw controls to `instance`, which may
    /// be NULL. Does not allocate or lock.
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if `ticks` is out of range or the time would exceed 2^60 ticks
    /// (51 years), MIEN_ERROR_MISMATCH if the instance has another number of raw controls.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mixer_step(MixerHandle mixer, long ticks, InstanceHandle instance);

    /// <summary>Steps `count` mixers; instances[i] belongs to mixers[i]. `instances` may be NULL. The results are those
    /// of single calls. On failure no mixer is advanced.
    /// Fails like mien_mixer_step(), and with MIEN_ERROR_INVALID_ARGUMENT if a mixer is listed twice.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mixer_step_batch(IntPtr* mixers, IntPtr* instances, UIntPtr count, long ticks);

    /// <summary>Returns the row of the last step, one float per curve: raw controls, then pose variables.
    /// Contents change with mien_mixer_step() and mien_mixer_step_batch().</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mixer_row(MixerHandle mixer, MienFloatView* out_row);

    /// <summary>Returns the row after a stage of the last step, one float per curve. Stages are numbered: the layers,
    /// then reactions, guards, antagonists, limits. Layers that act after the reactions or the guards keep
    /// their numbers.
    /// Fails with MIEN_ERROR_INDEX if the stage does not exist, MIEN_ERROR_INVALID_ARGUMENT if
    /// MienMixerDesc.stages was 0.
    /// Contents change with mien_mixer_step() and mien_mixer_step_batch().</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mixer_stage(MixerHandle mixer, uint stage, MienFloatView* out_row);

    /// <summary>Returns the state of a mixer.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mixer_info(MixerHandle mixer, MienMixerInfo* out_info);

    /// <summary>Returns an event of the last step and its layer. The tick is in the time of the clip, and the name is a
    /// view into the clip.
    /// Fails with MIEN_ERROR_INDEX if `index` is out of range.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mixer_event(MixerHandle mixer, uint index, MienClipEvent* out_event, uint* out_layer);

    /// <summary>Writes the state of a mixer to memory: everything that later steps depend on, except queued stream rows.
    /// Returns its size in `out_size`. `buffer` may be NULL with capacity 0 to get the size only. Snapshots
    /// can be restored on 64-bit machines of the same byte order. Does not allocate or lock.
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mixer_snapshot(MixerHandle mixer, void* buffer, UIntPtr capacity, UIntPtr* out_size, MienError* error);

    /// <summary>Restores a snapshot of a mixer of the same mix; later steps give the same bits. Queued stream rows are
    /// not part of it. `clips` lists the clips that may have been playing. The bytes are validated, so they
    /// need not be trusted. On failure the mixer does not change. Does not allocate or lock.
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if the bytes are not a snapshot of this mix,
    /// MIEN_ERROR_MISMATCH if a clip is missing or is not the one that was playing.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_mixer_restore(MixerHandle mixer, void* bytes, UIntPtr size, MienMixerClip* clips, UIntPtr clip_count, MienError* error);

    /// <summary>Creates a solver stack. `desc` is required. `deformer` may be destroyed before it. Destroy with
    /// mien_solver_stack_destroy().
    /// Fails with MIEN_ERROR_INDEX if a joint or curve does not exist, MIEN_ERROR_INVALID_ARGUMENT if a number
    /// is out of range, or if a solver reads a joint that a later one moves; the message names both.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_solver_stack_create(DeformerHandle deformer, MienSolverStackDesc* desc, out IntPtr out_solver_stack, MienError* error);

    /// <summary>Destroys a solver stack. Its states stay valid; its memory is released with the last of them.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern void mien_solver_stack_destroy(IntPtr solver_stack);

    /// <summary>Returns the properties of a solver stack.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_solver_stack_info(SolverStackHandle solver_stack, MienSolverStackInfo* out_info);

    /// <summary>Creates a solver state. `solver_stack` may be destroyed before it. Destroy with
    /// mien_solver_state_destroy().</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_solver_state_create(SolverStackHandle solver_stack, MienSolverStateDesc* desc, out IntPtr out_solver_state, MienError* error);

    /// <summary>Destroys a solver state.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern void mien_solver_state_destroy(IntPtr solver_state);

    /// <summary>Runs the solvers on the pose of `deformer_instance`. Call mien_deformer_instance_update() before every
    /// step. `input` may be NULL: no row, LOD 0. `ticks`, the time since the last step, is 0 to
    /// 2^40. Does not allocate or lock.
    /// Fails with MIEN_ERROR_MISMATCH if instance and stack have different deformers or the row is
    /// shorter than MienSolverStackDesc.curve_count, MIEN_ERROR_INVALID_ARGUMENT if `ticks` or the LOD is out of
    /// range.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_solver_state_step(SolverStateHandle solver_state, DeformerInstanceHandle deformer_instance, MienSolverInput* input, long ticks);

    /// <summary>Steps `count` states of one stack; deformer_instances[i] and inputs[i] belong to solver_states[i].
    /// `inputs` may be NULL. The results are those of single calls. No state or instance may occur twice. On
    /// failure nothing changes. Does not allocate or lock. Uses up to 8 KiB of stack.
    /// Fails like mien_solver_state_step(), and with MIEN_ERROR_MISMATCH if the states have different
    /// stacks.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_solver_state_step_batch(IntPtr* solver_states, IntPtr* deformer_instances, MienSolverInput* inputs, UIntPtr count, long ticks);

    /// <summary>Returns the outputs of a solver in the last step, one float per output. `solver` is its index in the
    /// stack.
    /// Contents change with mien_solver_state_step(), mien_solver_state_step_batch().
    /// Fails with MIEN_ERROR_INDEX if the solver does not exist.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_solver_state_outputs(SolverStateHandle solver_state, uint solver, MienFloatView* out_values);

    /// <summary>Returns the joint transforms after the last step, relative to the parents: 10 floats per joint, tx ty tz
    /// qx qy qz qw sx sy sz. (mien_deformer_instance_local_transforms() returns those before the step.)
    /// Contents change with mien_solver_state_step(), mien_solver_state_step_batch().</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_solver_state_transforms(SolverStateHandle solver_state, MienFloatView* out_transforms);

    /// <summary>Returns the name of a solver that changed a joint not in its `writes` in the last step, or an empty
    /// string. Contents change with mien_solver_state_step(), mien_solver_state_step_batch().
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if MienSolverStackDesc.check_writes was 0.</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_solver_state_undeclared(SolverStateHandle solver_state, MienStringView* out_name);

    /// <summary>Finds the raw controls that a name stands for on a rig. Takes time proportional to the number of raw
    /// controls: meant for loading, not for every frame. Does not allocate or lock. Writes as many shares as
    /// fit; `out_count` is the total number, at most MIEN_MOST_SHARES, each of a different control. `out_shares`
    /// may be NULL if `capacity` is 0. `out_match` is one of MIEN_NAME_MATCH_....
    /// Fails with MIEN_ERROR_NAME if the name matches no control of this rig, or several in step 1 or 2.
    /// See docs/face-capture.md, 2 "Names".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_rig_match(RigHandle rig, byte* name, UIntPtr name_count, MienControlShare* out_shares, UIntPtr capacity, UIntPtr* out_count, uint* out_match);

    /// <summary>Returns the usual name of a control: that of ARKit, such as mouthSmileLeft for AU12_L and
    /// mouthCornerPullL, or that of MetaHuman's raw controls if ARKit has none. A name without a side gets none:
    /// mouthSmile. Writes as many bytes as fit, without a null; `out_count` is the total number. `out_name` may
    /// be NULL if `capacity` is 0.
    /// Fails with MIEN_ERROR_NAME if the name is not in the table.
    /// See docs/face-capture.md, 2 "Names".</summary>
    [DllImport("mien", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_control_name(byte* name, UIntPtr name_count, byte* out_name, UIntPtr capacity, UIntPtr* out_count);

    /// <summary>Generates a rig and opens it: a file of version 2.8, unless the preset states another one, with all layers
    /// of its version, behavior of realistic size and sparsity, and simple geometry. Close with
    /// mien_dna_close().</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_dna_generate(MienGenerateDesc* desc, out IntPtr out_dna, MienError* error);

    /// <summary>Creates a rig from a mesh, with or without expressions, and opens it as a file of version 2.8: joints,
    /// skin weights for every LOD, and a raw control for each expression. The file has the axes of the mesh, in
    /// centimeters; positions keep their order, but positions that belong to no face are dropped. The same mesh,
    /// options and seed give the same bytes on any number of threads. `mesh` is required;
    /// `out_report` may be NULL. Close with mien_dna_close() and mien_author_report_close().
    /// The report has the confidence of each landmark; a mesh is not refused because it is low.
    /// Fails with MIEN_ERROR_AUTHOR_MESH if the arrays of the mesh or of the caller's results contradict
    /// each other, MIEN_ERROR_AUTHOR_REFUSED if the mesh cannot be rigged or landmarks contradict it,
    /// MIEN_ERROR_AUTHOR_CANCELED if `progress` canceled, MIEN_ERROR_DNA_LIMIT if the file would be too large.
    /// See docs/authoring.md, 1 "What goes in and what comes out".</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_author_rig(MienAuthorMesh* mesh, MienAuthorDesc* desc, out IntPtr out_dna, out IntPtr out_report, MienError* error);

    /// <summary>Closes a report.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern void mien_author_report_close(IntPtr author_report);

    /// <summary>Returns the report as JSON: bones, mask, groups, errors of the fit, and more. Lengths are in
    /// centimeters.
    /// See docs/authoring.md, 6 "The report".</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_author_report_json(AuthorReportHandle author_report, MienStringView* out_json);

    /// <summary>Makes a document of an open file, as it was loaded: layers and LODs that were left out are not in it.
    /// `dna` may be NULL, for an empty document of version 2.8 with all layers. `dna` may be closed
    /// afterwards. Destroy with mien_document_destroy().
    /// Fails with MIEN_ERROR_DNA_LAYER if `dna` has RBF behavior without the machine-learned behavior of its
    /// file, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE or MIEN_ERROR_DNA_VALUE if the loaded part would
    /// not open by itself, MIEN_ERROR_DNA_LIMIT if it exceeds 4 GiB.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_create(DnaHandle dna, MienDocumentDesc* desc, out IntPtr out_document, MienError* error);

    /// <summary>Opens a whole DNA file as a document, with the checks of mien_dna_open_file(), without a second copy in
    /// memory. Do not truncate or overwrite a mapped file while the document exists; replacing it by renaming is safe,
    /// and so is mien_document_write_file() to the same path, except on Windows, where a mapped file cannot be
    /// replaced: use MIEN_FILE_READ. Destroy with mien_document_destroy().
    /// Fails like mien_dna_open_file(), but not with MIEN_ERROR_LOD.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_open_file(byte* path, MienDocumentDesc* desc, out IntPtr out_document, MienError* error);

    /// <summary>Destroys a document.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern void mien_document_destroy(IntPtr document);

    /// <summary>Finds a field by its path, like mien_dna_field(). Its byte_offset is MIEN_NO_OFFSET.
    /// Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is past
    /// the end.
    /// See docs/dna-format.md, 6 "Layers, field by field".</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_field(DocumentHandle document, byte* path, MienDnaField* out_field, MienError* error);

    /// <summary>Returns the name of field `index` of the record at a path, like mien_dna_child_name(). The string is
    /// static.
    /// Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if `index` or an index in the
    /// path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a record.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_child_name(DocumentHandle document, byte* path, uint index, MienStringView* out_name, MienError* error);

    /// <summary>Copies `count` elements of a field, beginning with element `first`, to `out`, like
    /// mien_dna_read_floats(). `out` may be NULL if `count` is 0.
    /// Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
    /// the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
    /// kind.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_read_floats(DocumentHandle document, byte* path, ulong first, ulong count, float* @out, MienError* error);

    /// <summary>Copies `count` elements of a field, beginning with element `first`, to `out`, like
    /// mien_dna_read_floats(). `out` may be NULL if `count` is 0.
    /// Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
    /// the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
    /// kind.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_read_integers(DocumentHandle document, byte* path, ulong first, ulong count, long* @out, MienError* error);

    /// <summary>Returns a string. Contents change with mien_document_write_string(), mien_document_undo(): the view
    /// is valid until the document is changed.
    /// Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is
    /// past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a string.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_read_string(DocumentHandle document, byte* path, MienStringView* out_string, MienError* error);

    /// <summary>Returns the bytes of an array of numbers or of a string in place: big-endian and unaligned, as in a file.
    /// Contents change with mien_document_write_floats(), mien_document_write_integers(), mien_document_undo():
    /// the view is valid until the document is changed.
    /// Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is
    /// past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is neither an array nor a string.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_bytes(DocumentHandle document, byte* path, MienStringView* out_bytes, MienError* error);

    /// <summary>Replaces `count` elements of an array, beginning with element `first`, or a single number. The first write
    /// to an array after a mark or an operation copies it, later ones do not. `values` may be NULL if `count`
    /// is 0.
    /// Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
    /// the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
    /// kind, or none of this size, MIEN_ERROR_MEMORY if the allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_write_floats(DocumentHandle document, byte* path, ulong first, ulong count, float* values, MienError* error);

    /// <summary>Replaces `count` elements of an array, beginning with element `first`, or a single number. The first write
    /// to an array after a mark or an operation copies it, later ones do not. `values` may be NULL if `count`
    /// is 0.
    /// Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
    /// the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
    /// kind, or none of this size, MIEN_ERROR_MEMORY if the allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_write_integers(DocumentHandle document, byte* path, ulong first, ulong count, long* values, MienError* error);

    /// <summary>Replaces a string by `string_count` bytes. `string` may be NULL if `string_count` is 0.
    /// Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is past
    /// the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a string, or if another element of a list of
    /// names has this name, MIEN_ERROR_MEMORY if the allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_write_string(DocumentHandle document, byte* path, byte* @string, UIntPtr string_count, MienError* error);

    /// <summary>Replaces `removed_count` elements of an array or list, beginning with element `first`, by
    /// `inserted_count` new ones: zeros, empty strings, or records of these. References to elements by number do
    /// not change. Copies the array, or the list without its contents.
    /// Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
    /// the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is neither an array nor a list, or
    /// would have more than 2^32 - 1 elements, MIEN_ERROR_MEMORY if the allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_splice(DocumentHandle document, byte* path, ulong first, ulong removed_count, ulong inserted_count, MienError* error);

    /// <summary>Gives an array or list `count` elements: drops the last ones or adds new ones, like
    /// mien_document_splice().
    /// Fails like mien_document_splice().</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_resize(DocumentHandle document, byte* path, ulong count, MienError* error);

    /// <summary>Returns the version of the file that the document becomes, 2.`out_version`, and the length of its list of
    /// layers. A file also has the layers that its version defines and the list lacks, behind the others.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_layer_count(DocumentHandle document, uint* out_version, uint* out_count, MienError* error);

    /// <summary>Returns layer `index` of the list, as mien_dna_layer(); byte_offset is MIEN_NO_OFFSET. `out_bytes` gets the
    /// contents of a layer of an unknown kind, else nothing. Contents change with mien_document_clear_layers(),
    /// mien_document_undo(): the view is valid until the document is changed.
    /// Fails with MIEN_ERROR_INDEX if `index` is past the end.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_layer(DocumentHandle document, uint index, MienDnaLayer* out_layer, MienStringView* out_bytes, MienError* error);

    /// <summary>Makes the document a file of version 2.`version` and its list of layers empty: layers of unknown kinds
    /// are gone, fields stay as they are. mien_document_add_layer() fills the list again.
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if `version` is not 1 to 65535, MIEN_ERROR_MEMORY if the allocator
    /// returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_clear_layers(DocumentHandle document, uint version, MienError* error);

    /// <summary>Appends a layer to the list: the layer of a known kind, without bytes, or `size` bytes of an
    /// unknown kind, which are written to the file as they are. `code` has four characters, such as "bhvr"; the
    /// layer is of version `version_major`.`version_minor`. `bytes` may be NULL if `size` is 0.
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if `code` has another length, a version is above 65535, the list has a
    /// layer of this code and version already, the kind is known and has bytes, or a file of version 2.1 cannot
    /// have it, MIEN_ERROR_MEMORY if the allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_add_layer(DocumentHandle document, byte* code, uint version_major, uint version_minor, void* bytes, UIntPtr size, MienError* error);

    /// <summary>Remembers the current state, at the cost of some KB. Mark 0 always exists: the state in which the
    /// document was created. Changes before a mark keep their memory until the document is destroyed or an
    /// earlier mark is restored.
    /// Fails with MIEN_ERROR_MEMORY if the allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_mark(DocumentHandle document, ulong* out_mark, MienError* error);

    /// <summary>Goes back to the state at a mark: `mark` is a number from mien_document_mark(), or 0. Later marks become
    /// invalid, this one stays valid. Does not allocate or lock.
    /// Fails with MIEN_ERROR_INDEX if `mark` is not a valid mark of the document.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_undo(DocumentHandle document, ulong mark, MienError* error);

    /// <summary>Finds the index of a name; of equal names, the first. `kind` is a MIEN_KIND_...: GUI, raw, PSD ("psd0",
    /// "psd1", ...), ML and RBF controls, joints, blend shape channels, animated maps, meshes.
    /// Fails with MIEN_ERROR_NAME if there is no such name, MIEN_ERROR_INVALID_ARGUMENT if the kind has no names
    /// in a document.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_find(DocumentHandle document, Kind kind, byte* name, uint* out_index, MienError* error);

    /// <summary>Renames element `index` of a kind of mien_document_find() but PSD controls.
    /// Fails with MIEN_ERROR_INDEX if there is no such element, MIEN_ERROR_INVALID_ARGUMENT if another element
    /// of the kind has the name, or the kind has no names in a document, MIEN_ERROR_MEMORY if the allocator
    /// returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_rename(DocumentHandle document, Kind kind, uint index, byte* name, MienError* error);

    /// <summary>Removes controls, joints, blend shape channels, animated maps or meshes, and everything that
    /// refers to them: names, LOD lists, rows of tables, targets, regions of networks. `indices` has
    /// `index_count` elements; PSD, ML and RBF controls are numbered from 0.
    /// Children of a joint go to its nearest ancestor that stays, or become roots, and keep their neutral place
    /// in the world; motions that are relative to the parent keep their numbers. The joint's skin weights go to
    /// the same ancestor, or to the first joint that stays. Quaternion joints move as before within 1e-2
    /// degrees; where the columns of a joint group would rotate them in another order, each quaternion joint of
    /// the group gets a joint group of its own.
    /// A raw, PSD, ML or RBF control is removed as if it stayed 0: with it go its columns of joint groups, its rows
    /// of channels and animated maps, PSD controls that are products of it, RBF solvers, twists and swings that
    /// read it, its inputs of networks, and the outputs of networks and RBF poses that set it. Networks that ML
    /// operations run cannot lose one: their controls are refused. Files before 2.5 cannot lose RBF controls.
    /// Fails with MIEN_ERROR_INDEX if an index is past the end, MIEN_ERROR_INVALID_ARGUMENT if the
    /// networks or the version need a control, or no joint would be left for the skin
    /// weights, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE
    /// if the document is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_remove(DocumentHandle document, Kind kind, uint* indices, UIntPtr index_count, MienError* error);

    /// <summary>Removes all blend shape channels with their targets, all animated maps, or, for MIEN_KIND_JOINT,
    /// everything that moves joints. `kind` is a MIEN_KIND_....
    /// Fails like mien_document_remove(), but not with MIEN_ERROR_INDEX.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_clear(DocumentHandle document, Kind kind, MienError* error);

    /// <summary>Removes everything that moves these joints: their rows of joint groups, twists, swings and ML joints.
    /// Fails like mien_document_remove().</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_clear_joints(DocumentHandle document, uint* joints, UIntPtr joint_count, MienError* error);

    /// <summary>Sets neutral transforms of joints from `first_joint` on, relative to their parents, in the units and
    /// axes of the file: translations, 3 floats per joint, and rotations, 3 floats per joint. Either may be
    /// left out: `translations` may be NULL; `rotations` may be NULL.
    /// Fails with MIEN_ERROR_INDEX if there are fewer joints, MIEN_ERROR_INVALID_ARGUMENT if a number is not
    /// finite, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE
    /// if the document is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_set_neutral(DocumentHandle document, uint first_joint, float* translations, float* rotations, UIntPtr count, MienError* error);

    /// <summary>Sets all positions of a mesh, 3 floats per position. Normals do not change: deformers recompute them by
    /// default; otherwise write geom.meshes[i].normals.
    /// Fails with MIEN_ERROR_INDEX if `mesh` is past the end, MIEN_ERROR_INVALID_ARGUMENT if the mesh has another
    /// number of positions, or a number is not finite, MIEN_ERROR_MEMORY if the allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_set_positions(DocumentHandle document, uint mesh, float* positions, UIntPtr position_count, MienError* error);

    /// <summary>Sets the target of blend shape channel `channel` on mesh `mesh`: 3 floats per delta, of the positions
    /// `vertices`. `vertices` may be NULL for the first `count` positions. Deltas of zero are left out; if there
    /// are no others, the target is removed. The pair of mesh and channel in defn.meshBlendShapeChannelMapping
    /// is added or removed with it.
    /// Fails with MIEN_ERROR_INDEX if `mesh`, `channel` or a vertex is past the end, MIEN_ERROR_INVALID_ARGUMENT
    /// if there are more deltas than positions, or a number is not finite, MIEN_ERROR_DNA_STRUCTURE,
    /// MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid,
    /// MIEN_ERROR_MEMORY if the allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_set_target(DocumentHandle document, uint mesh, uint channel, uint* vertices, float* deltas, UIntPtr count, MienError* error);

    /// <summary>Removes deltas not longer than `tolerance`, in the unit of the file, and targets that have none left.
    /// `out_pruned` gets their numbers.
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if `tolerance` is negative or not finite, MIEN_ERROR_DNA_STRUCTURE,
    /// MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid,
    /// MIEN_ERROR_MEMORY if the allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_prune_targets(DocumentHandle document, float tolerance, MienPrunedTargets* out_pruned, MienError* error);

    /// <summary>Sets small entries of the joint matrix to 0, and removes columns and rows of joint groups that have no
    /// others. Measures how far that moves the positions of LOD 0, with each raw control at 1, and with all raw
    /// controls of each corrective at 1. `desc` is required.
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if a field of `desc` is negative or not finite,
    /// MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the
    /// document is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_prune_joints(DocumentHandle document, MienPruneJointsDesc* desc, MienPrunedJoints* out_pruned, MienError* error);

    /// <summary>Sets the skin weights of a mesh: `influences` joints and weights per position, row by row. Weights of 0
    /// are left out. `joints` has `weight_count` elements, as many as `weights`.
    /// Fails with MIEN_ERROR_INDEX if `mesh` is past the end, MIEN_ERROR_INVALID_ARGUMENT if there is another
    /// number of weights, a weight is negative or not finite, a joint does not exist, or a position has a
    /// joint twice or no weight, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or
    /// MIEN_ERROR_DNA_VALUE if the document is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_set_weights(DocumentHandle document, uint mesh, uint influences, ushort* joints, float* weights, UIntPtr weight_count, MienError* error);

    /// <summary>Scales the weights of each position of mesh `mesh` to a sum of 1; sums within 1e-6 of it stay as they are.
    /// Fails with MIEN_ERROR_INDEX if `mesh` is past the end, MIEN_ERROR_DNA_STRUCTURE,
    /// MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid,
    /// MIEN_ERROR_MEMORY if the allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_normalize_weights(DocumentHandle document, uint mesh, MienError* error);

    /// <summary>Keeps the `influences` largest weights of each position of mesh `mesh`, in their order, scaled to the
    /// previous sum.
    /// Fails like mien_document_normalize_weights(), and with MIEN_ERROR_INVALID_ARGUMENT if `influences` is 0.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_limit_influences(DocumentHandle document, uint mesh, uint influences, MienError* error);

    /// <summary>Smooths the weights of mesh `mesh` `iterations` times: those of each position become (1 - strength) times
    /// its own plus strength times the mean of its neighbors along edges. Positions at the same place count as
    /// one. Each keeps at most `influences`, with a sum of 1.
    /// Fails like mien_document_limit_influences(), and with MIEN_ERROR_INVALID_ARGUMENT if `strength` is not 0
    /// to 1, or there are more than 1000 iterations.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_smooth_weights(DocumentHandle document, uint mesh, uint iterations, float strength, uint influences, MienError* error);

    /// <summary>Scales, rotates and moves the whole character: neutral joints, positions, normals, targets, and the
    /// translations that controls add to joints. `placement` is required.
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if a number is not finite or the scale is negative,
    /// MIEN_ERROR_DNA_VALUE if a root joint is moved by controls and the rotation is not 0, networks translate
    /// joints and the scale is not 1, or the document is not valid, MIEN_ERROR_DNA_STRUCTURE,
    /// MIEN_ERROR_DNA_REFERENCE or MIEN_ERROR_DNA_LIMIT if the document is not valid, MIEN_ERROR_MEMORY if the
    /// allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_place(DocumentHandle document, MienPlacement* placement, MienError* error);

    /// <summary>Keeps the LODs whose bits are set in `lods`, like MienDnaDesc.lods.
    /// Fails with MIEN_ERROR_LOD if none of them exists, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE,
    /// MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid, MIEN_ERROR_MEMORY if the
    /// allocator returns NULL.
    /// See docs/dna-format.md, 10 "Choosing LODs".</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_keep_lods(DocumentHandle document, ulong lods, MienError* error);

    /// <summary>Converts to another coordinate system, like MienDnaDesc.system. `system` is required.
    /// Fails with MIEN_ERROR_DNA_VALUE if the rig cannot be converted or the document is not valid,
    /// MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE or MIEN_ERROR_DNA_LIMIT if the document is not valid,
    /// MIEN_ERROR_MEMORY if the allocator returns NULL.
    /// See docs/dna-format.md, 11 "Coordinate systems".</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_convert(DocumentHandle document, MienCoordinateSystem* system, MienError* error);

    /// <summary>Copies the layers of another document whose bits are set. `layers` is a MIEN_LAYER_..., combined with |.
    /// Layers that refer to each other are copied together.
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if `layers` has other bits, MIEN_ERROR_DNA_STRUCTURE,
    /// MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if they do not fit the other
    /// layers, MIEN_ERROR_MEMORY if the allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_copy_layers(DocumentHandle document, DocumentHandle from, Layer layers, MienError* error);

    /// <summary>Copies mesh `mesh` of another document. It replaces the mesh of the same name, or becomes a new one, at
    /// its LODs in the other document as far as this document has them. Joints and channels are found by name;
    /// the influence of a missing joint goes to its nearest ancestor that exists here, and targets of missing
    /// channels are left out.
    /// Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_INVALID_ARGUMENT if both documents are
    /// the same, MIEN_ERROR_MISMATCH if the documents differ in axes, units or rotations, or this one has no
    /// joint of a position, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or
    /// MIEN_ERROR_DNA_VALUE if one of them is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_copy_mesh(DocumentHandle document, DocumentHandle from, uint mesh, uint* out_mesh, MienError* error);

    /// <summary>Adds the joints of another document whose names this one lacks, such as those of a body to a head: below
    /// the joints with the names of their parents, numbered after the existing ones, at the LODs that list them
    /// in the other document. Joints of both documents stay as they are, but a root that has a parent in the
    /// other one becomes its child. They must have the same place in model space, within `tolerance` in the unit
    /// of the file.
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if both documents are the same, MIEN_ERROR_MISMATCH if they differ
    /// in axes, units or rotations, or in the place of a joint, MIEN_ERROR_DNA_STRUCTURE,
    /// MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if one of them is not valid or the
    /// result would not be, MIEN_ERROR_MEMORY if the allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_merge_joints(DocumentHandle document, DocumentHandle from, double tolerance, MienError* error);

    /// <summary>Removes the joints whose names another document lacks, like mien_document_remove().
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if no joint would be left for the skin weights,
    /// MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if
    /// `document` is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_split_joints(DocumentHandle document, DocumentHandle from, MienError* error);

    /// <summary>Gives mesh `mesh` the skin weights and targets of mesh `source`, interpolated at the point of `source`
    /// nearest to each position: a coarser LOD from a finer one. The influence of joints that no LOD of the mesh
    /// lists goes to the nearest ancestor that one of them lists; targets of channels that none lists are left
    /// out. If these LODs list no joints or channels at all, all are kept. `out_farthest` gets the largest
    /// distance to a nearest point, in the unit of the file or of the texture.
    /// Fails with MIEN_ERROR_INDEX if `mesh` or `source` is past the end, MIEN_ERROR_INVALID_ARGUMENT if they are
    /// the same, or lack triangles, texture coordinates or weights, MIEN_ERROR_DNA_STRUCTURE,
    /// MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid,
    /// MIEN_ERROR_MEMORY if the allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_project(DocumentHandle document, uint mesh, uint source, MienProjectDesc* desc, double* out_farthest, MienError* error);

    /// <summary>The same for all meshes of LOD `lod`, each from the mesh of LOD `source_lod` whose name differs only in the
    /// number of the LOD ("head_lod3_mesh" from "head_lod0_mesh"). A LOD that lists no joints or channels gets
    /// those of `source_lod`.
    /// Fails with MIEN_ERROR_LOD if there is no such LOD, MIEN_ERROR_NAME if a mesh has no counterpart,
    /// MIEN_ERROR_INVALID_ARGUMENT if the LODs are the same, or meshes lack triangles, texture coordinates or
    /// weights, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or
    /// MIEN_ERROR_DNA_VALUE if the document is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_make_lod(DocumentHandle document, uint lod, uint source_lod, MienProjectDesc* desc, double* out_farthest, MienError* error);

    /// <summary>Gives mesh `mesh` new positions, 3 floats per position, such as a head that an artist reshaped, and lets
    /// the rig follow: joints move with the surface around them and keep their orientation; targets rotate and
    /// scale with the surface, translations that controls add to joints scale with it, and normals rotate.
    /// `others` is 0, or 1 to move the other meshes, too. A motion of the whole mesh is followed exactly.
    /// Fails with MIEN_ERROR_INDEX if `mesh` is past the end, MIEN_ERROR_INVALID_ARGUMENT if the mesh has another
    /// number of positions, or a number is not finite, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE,
    /// MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid, MIEN_ERROR_MEMORY if the
    /// allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_conform(DocumentHandle document, uint mesh, float* positions, UIntPtr position_count, uint others, MienConformed* out_conformed, MienError* error);

    /// <summary>Gives a character the rig of a template: controls, joints, behavior, and LODs of document `rig`. The
    /// character keeps its shape. Its meshes keep topology and positions where the template has a mesh of the
    /// same name, and get weights and targets from it; other meshes are the template's, moved with the surface.
    /// Joints with names of joints of the character keep the places of those, others move with the surface.
    /// `out_errors` has `capacity` elements, one for each raw control of both rigs, or fewer; `out_errors` may
    /// be NULL; `out_count` gets the number written.
    /// Fails with MIEN_ERROR_MISMATCH if the documents differ in axes, units or rotations,
    /// MIEN_ERROR_INVALID_ARGUMENT if no mesh of LOD 0 has the name of one of the template, or meshes lack
    /// triangles or texture coordinates, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE,
    /// MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if one of them is not valid, MIEN_ERROR_MEMORY if the
    /// allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_transplant(DocumentHandle document, DocumentHandle rig, MienTransplantDesc* desc, MienControlError* out_errors, UIntPtr capacity, UIntPtr* out_count, MienError* error);

    /// <summary>Opens the document as a file, with all checks of opening a file. `document` may be destroyed afterwards.
    /// Close with mien_dna_close().
    /// Fails with MIEN_ERROR_DNA_TRUNCATED, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE,
    /// MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not a valid file; the message names the
    /// first invalid field, mien_document_validate() lists them all.
    /// See docs/dna-format.md, 13 "What is checked".</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_to_dna(DocumentHandle document, MienDocumentDesc* desc, out IntPtr out_dna, MienError* error);

    /// <summary>Writes the document to a file, like mien_dna_write_file(), with all checks of opening it as a file.
    /// Fails with MIEN_ERROR_FILE_WRITE if the file cannot be written, MIEN_ERROR_DNA_STRUCTURE,
    /// MIEN_ERROR_DNA_REFERENCE or MIEN_ERROR_DNA_VALUE if the document is not a valid file, or would not be one in
    /// the requested version, MIEN_ERROR_DNA_LIMIT if the file would exceed 4 GiB, MIEN_ERROR_MEMORY if the
    /// allocator returns NULL.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_write_file(DocumentHandle document, byte* path, MienWriteDesc* desc, MienError* error);

    /// <summary>Passes the bytes of the file to `sink`, in pieces of at most 8 MiB.
    /// Fails like mien_document_write_file(), also with MIEN_ERROR_FILE_WRITE if `sink` does not take a piece.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_write_stream(DocumentHandle document, MienByteSink* sink, MienWriteDesc* desc, MienError* error);

    /// <summary>Writes the document to memory and returns its size in `out_size`. `buffer` may be NULL with capacity 0 to get
    /// the size only. Writes nothing if `capacity` is too small; `out_size` is set nevertheless.
    /// Fails like mien_document_write_file(), but not with MIEN_ERROR_FILE_WRITE, and with
    /// MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_write_memory(DocumentHandle document, MienWriteDesc* desc, void* buffer, UIntPtr capacity, UIntPtr* out_size, MienError* error);

    /// <summary>Checks the document like mien_dna_validate_memory() its file. `document` may be destroyed afterwards.
    /// Destroy with mien_report_destroy().
    /// Fails with MIEN_ERROR_DNA_LIMIT if the file would exceed 4 GiB.</summary>
    [DllImport("mien-author", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_document_validate(DocumentHandle document, MienValidateDesc* desc, out IntPtr out_report, MienError* error);

    /// <summary>Creates a fit. `desc` is required. `rig` must outlive the fit; the deformer may be destroyed. Measures
    /// the effect of each control, which takes up to some seconds for large rigs. Destroy with
    /// mien_fit_destroy().
    /// Fails with MIEN_ERROR_INDEX if a control, position or mesh does not exist, MIEN_ERROR_LOD if the rig has no
    /// such LOD, MIEN_ERROR_MISMATCH if the deformer belongs to another rig, MIEN_ERROR_INVALID_ARGUMENT if controls are
    /// not ascending, a lower bound is above its upper one, or a weight is not finite.</summary>
    [DllImport("mien-solve", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_fit_create(RigHandle rig, MienFitDesc* desc, out IntPtr out_fit, MienError* error);

    /// <summary>Destroys a fit. NULL is allowed.</summary>
    [DllImport("mien-solve", CallingConvention = CallingConvention.Cdecl)]
    public static extern void mien_fit_destroy(IntPtr fit);

    /// <summary>Creates a surface with a tree to find the nearest points. `desc` is required. Destroy with
    /// mien_fit_surface_destroy().
    /// Fails with MIEN_ERROR_INDEX if a position does not exist, MIEN_ERROR_INVALID_ARGUMENT if there are no
    /// triangles, or a coordinate is not finite.</summary>
    [DllImport("mien-solve", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_fit_surface_create(MienFitSurfaceDesc* desc, out IntPtr out_surface, MienError* error);

    /// <summary>Destroys a surface. NULL is allowed.</summary>
    [DllImport("mien-solve", CallingConvention = CallingConvention.Cdecl)]
    public static extern void mien_fit_surface_destroy(IntPtr surface);

    /// <summary>Finds the raw controls of a frame by bounded Gauss-Newton steps with Levenberg-Marquardt damping. Writes
    /// all raw controls of the rig to `out_raw`; those that may not move keep their values of `start`. `result`
    /// may be NULL. Deterministic unless there is a time limit. Does not allocate or lock.
    /// Fails with MIEN_ERROR_NULL_ARGUMENT if points, images or a surface are given to a fit without points, or
    /// images without a camera, or constraints on joints to one without a deformer,
    /// MIEN_ERROR_INVALID_ARGUMENT if a stage is above 15, or a weight, a control, an offset or a number of the camera is
    /// not finite, or a weight is negative, MIEN_ERROR_HANDLE if `surface` is none,
    /// MIEN_ERROR_INDEX if a constraint has a joint or point that does not exist.</summary>
    [DllImport("mien-solve", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_fit_solve(FitHandle fit, MienFitFrame* frame, float* out_raw, MienFitResult* result);

    /// <summary>Solves `count` frames of a motion, each from the result of the one before. `joints`, `points`, `images`,
    /// `point_weights` and `surface_weights` of `frame` have a row for each frame, one after the other; all else is for all
    /// frames. `start` and `stages` are for the first frame, and so is `camera`, if it may move. `out_raw` gets a row of all
    /// raw controls for each frame; `results`, which may be NULL, one result for each, all with the `struct_size` of the
    /// first. Where joints are the only targets, this is faster than calls of mien_fit_solve(), and differs from them by
    /// rounding. Deterministic unless there is a time limit, which is that of a frame. Does not allocate or lock.
    /// Fails like mien_fit_solve().</summary>
    [DllImport("mien-solve", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_fit_solve_frames(FitHandle fit, MienFitFrame* frame, UIntPtr count, float* out_raw, MienFitResult* results);

    /// <summary>Writes for each raw control how well the data determines it at the initial pose: 0 if it moves nothing
    /// that has a target, or if other controls have the same effect; up to 1 for the best determined one. The
    /// parts of a rotation get the value of the turn that is determined least.
    /// `count` is the number of raw controls.
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if `count` is another number.</summary>
    [DllImport("mien-solve", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_fit_observability(FitHandle fit, float* out_values, UIntPtr count);

    /// <summary>Chooses keys of a curve: straight lines between them are within `tolerance` of all values. `out_keys` gets
    /// the frame numbers, ascending, the first and the last frame among them; `out_key_count` gets how many. `count`
    /// is the number of values and the capacity of `out_keys`.
    /// Fails with MIEN_ERROR_INVALID_ARGUMENT if a value is not finite, or the tolerance is negative or not
    /// finite.</summary>
    [DllImport("mien-solve", CallingConvention = CallingConvention.Cdecl)]
    public static extern Status mien_fit_keys(float* values, UIntPtr count, float tolerance, uint* out_keys, UIntPtr* out_key_count);
  }
}
