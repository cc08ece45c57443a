-- SPDX-License-Identifier: MIT
-- Code generated from integrations/api/mien_api.json by generate.py; run ./dev api. DO NOT EDIT.
-- The declarations and comments of mien.h and mien_author.h, and their enums as tables.
local ffi = require("ffi")
local api = {}

ffi.cdef [[
typedef int32_t MienStatus;
typedef struct MienDna MienDna;
typedef struct MienReport MienReport;
typedef struct MienRig MienRig;
typedef struct MienInstance MienInstance;
typedef struct MienBatch MienBatch;
typedef struct MienDeformer MienDeformer;
typedef struct MienDeformerInstance MienDeformerInstance;
typedef struct MienDerivatives MienDerivatives;
typedef struct MienJacobian MienJacobian;
typedef struct MienBaked MienBaked;
typedef struct MienClip MienClip;
typedef struct MienClipPlayer MienClipPlayer;
typedef struct MienClipBinding MienClipBinding;
typedef struct MienMix MienMix;
typedef struct MienGaze MienGaze;
typedef struct MienMixer MienMixer;
typedef struct MienSolverStack MienSolverStack;
typedef struct MienSolverState MienSolverState;
typedef struct MienAuthorReport MienAuthorReport;
typedef struct MienDocument MienDocument;
typedef struct MienFit MienFit;
typedef struct MienFitSurface MienFitSurface;
typedef void (*MienTask)(void* context, uint32_t index);

/* Details of a failure, owned by the caller. A call that fails fills all fields; a call that succeeds
sets status to MIEN_OK and leaves the other fields unchanged. */
typedef struct MienError {
    size_t struct_size;
    uint64_t byte_offset; /* where in the file; MIEN_NO_OFFSET: nowhere in particular */
    MienStatus status;
    char message[236]; /* what is wrong, where, and how to fix it; null-terminated, truncated if too long */
} MienError;

/* The caller's memory functions. Where a MienAllocator is NULL, the C library's heap is used. The
struct is copied. Both functions must remain callable until the object is destroyed, from every
thread that creates or destroys objects with this allocator. */
typedef struct MienAllocator {
    void* user; /* passed to the functions */
    void* (*allocate)(void* user, size_t size, size_t alignment); /* Returns `size` bytes aligned to `alignment` (a power of two, at most 64), or NULL. */
    void (*release)(void* user, void* block, size_t size, size_t alignment); /* Releases a block. `size` and `alignment` are those it was allocated with. */
} MienAllocator;

/* The caller's thread pool; the library starts no threads. */
typedef struct MienParallelFor {
    void* user; /* passed to the function */
    void (*run)(void* user, uint32_t count, MienTask task, void* context); /* Calls task(context, i) once for each i < count, in any order and on any threads, and returns when all calls have finished. Tasks never wait for each other; each takes about 10 us. */
} MienParallelFor;

typedef struct MienStringView {
    char const* data;
    size_t count; /* bytes; not null-terminated */
} MienStringView;

typedef struct MienFloatView {
    float const* data;
    size_t count;
} MienFloatView;

typedef struct MienMutableFloatView {
    float* data;
    size_t count;
} MienMutableFloatView;

typedef struct MienIndex16View {
    uint16_t const* data;
    size_t count;
} MienIndex16View;

typedef struct MienIndex32View {
    uint32_t const* data;
    size_t count;
} MienIndex32View;

/* A file read by the caller, for example from an archive. `read` is called only during the call that
takes the stream, and on the same thread. */
typedef struct MienStream {
    void* user; /* passed to the function */
    uint64_t size; /* of the file, in bytes */
    size_t (*read)(void* user, uint64_t offset, void* buffer, size_t size); /* Copies `size` bytes at `offset` to `buffer`, never more, and returns the number of bytes copied; any number but `size` is an error. The range is within the file. */
} MienStream;

/* Axes, units and rotation conventions of a rig. Any handedness is allowed.
See docs/dna-format.md, 11 "Coordinate systems". */
typedef struct MienCoordinateSystem {
    size_t struct_size;
    uint32_t axes[3]; /* MIEN_DIRECTION_... of x, y, z */
    uint32_t translation_unit; /* MIEN_TRANSLATION_UNIT_... */
    uint32_t rotation_unit; /* MIEN_ROTATION_UNIT_... */
    uint32_t rotation_rule; /* MIEN_ROTATION_RULE_... */
    uint32_t rotation_sequence; /* MIEN_ROTATION_SEQUENCE_...; ignored with MIEN_ROTATION_RULE_CARRIED */
    int32_t rotation_signs[3]; /* of the angles about x, y, z. 1: rotates y to z, z to x, x to y. -1: the other way. 0: whichever leaves the angles unchanged */
    uint32_t face_winding; /* MIEN_FACE_WINDING_... */
    uint32_t reserved; /* 0 */
} MienCoordinateSystem;

/* What to load of a DNA file, and how.

A rig converted to another coordinate system moves as before: evaluating it gives the joint values
of the original rig, converted. Raw controls that are components of rotations (read by RBF solvers,
twists or swings as quaternions, or named .qx .qy .qz .qw) are expected in the requested system.
Changes of axes and signs are exact, so converting back restores the original numbers; a change of
units rounds each number once. Texture coordinates and unknown layers are not converted. A converted
rig can be written; the file gets version 2.8 if its own version cannot describe the system. */
typedef struct MienDnaDesc {
    size_t struct_size;
    uint32_t layers; /* MIEN_LAYER_..., combined with |; the others are not read. 0: all */
    uint32_t skip_blend_shape_targets; /* load the geometry without blend shape targets */
    uint32_t unknown_layers; /* MIEN_UNKNOWN_LAYERS_... */
    uint32_t file_access; /* MIEN_FILE_...; for mien_dna_open_file() only */
    uint64_t lods; /* bit l keeps LOD l. Kept LODs are renumbered from 0; joints, meshes, channels and maps that none of them uses are dropped, and all indices renumbered. 0: all */
    MienCoordinateSystem const* system; /* convert to this system. NULL: keep the file's own */
    MienAllocator const* allocator;
} MienDnaDesc;

/* Properties of an open DNA. Counts are those of the loaded layers and LODs. */
typedef struct MienDnaInfo {
    size_t struct_size;
    uint32_t generation; /* 2 */
    uint32_t version; /* 1 to 8: the file is of version 2.version */
    uint32_t layers; /* MIEN_LAYER_..., combined with |: the loaded layers */
    uint32_t has_blend_shape_targets; /* the geometry is loaded with its targets */
    uint64_t file_bytes; /* size of the file */
    uint64_t memory_bytes; /* memory taken from the allocator */
    uint32_t is_mapped; /* the file is mapped */
    uint32_t layer_count; /* entries for mien_dna_layer() */
    uint32_t translation_unit; /* MIEN_TRANSLATION_UNIT_... */
    uint32_t rotation_unit; /* MIEN_ROTATION_UNIT_... */
    uint32_t axes[3]; /* MIEN_DIRECTION_... of x, y, z */
    uint32_t rotation_sequence; /* MIEN_ROTATION_SEQUENCE_... */
    int32_t rotation_signs[3]; /* 1 or -1, for the angles about x, y, z */
    uint32_t face_winding; /* MIEN_FACE_WINDING_... */
    uint32_t lod_count;
    uint32_t max_lod; /* LOD 0 of this file is LOD max_lod of its database */
    uint32_t gui_control_count;
    uint32_t raw_control_count;
    uint32_t psd_control_count;
    uint32_t ml_control_count;
    uint32_t rbf_control_count;
    uint32_t joint_count;
    uint32_t joint_group_count;
    uint32_t blend_shape_channel_count;
    uint32_t animated_map_count;
    uint32_t mesh_count;
    uint32_t neural_network_count;
    uint32_t rbf_solver_count;
    uint32_t rbf_pose_count;
    uint32_t twist_count;
    uint32_t swing_count;
    uint32_t metadata_count; /* pairs desc.metadata[i].key and .value */
} MienDnaInfo;

/* An entry of the index table of the file. Files of version 2.1 have no index table; their sections are
listed as the layers desc, defn, bhvr and geom. */
typedef struct MienDnaLayer {
    size_t struct_size;
    uint32_t layer; /* MIEN_LAYER_... that loads it. MIEN_LAYER_UNKNOWN: no known kind */
    uint32_t version_major; /* of the layer: version_major.version_minor */
    uint32_t version_minor;
    uint32_t is_loaded; /* it was parsed, not skipped or kept as bytes */
    uint64_t byte_offset; /* of its first byte in the file */
    uint64_t byte_count;
    char code[8]; /* such as "bhvr"; null-terminated */
} MienDnaLayer;

typedef struct MienDnaField {
    size_t struct_size;
    uint32_t type; /* MIEN_FIELD_... */
    uint32_t is_array; /* an array of numbers, even if it has only one element; not a single number, nor an element of an array */
    uint64_t count; /* elements of an array or list, bytes of a string, fields of a record; 1 for a number */
    uint64_t byte_offset; /* of a string, an array or an element of an array in the file; MIEN_NO_OFFSET: other fields, and data that is not in the file */
} MienDnaField;

/* How to write a DNA file. See docs/dna-format.md, 14.3 "Changing the version". */
typedef struct MienWriteDesc {
    size_t struct_size;
    uint32_t version; /* 1 to 8: write version 2.version; layers that it does not define are kept unless unknown_layers drops them, but 2.1 can only hold the layers desc, defn, bhvr and geom. 0: the version of the DNA */
    uint32_t unknown_layers; /* MIEN_UNKNOWN_LAYERS_... */
} MienWriteDesc;

typedef struct MienFinding {
    size_t struct_size;
    uint32_t severity; /* MIEN_SEVERITY_... */
    MienStatus status; /* the status of the failure; MIEN_OK for a warning */
    uint64_t byte_offset; /* where in the file; MIEN_NO_OFFSET: nowhere in particular */
    MienStringView field; /* path as for mien_dna_field(), or the code of a layer */
    MienStringView message; /* what is wrong */
} MienFinding;

typedef struct MienValidateDesc {
    size_t struct_size;
    MienAllocator const* allocator;
} MienValidateDesc;

/* Options of a rig. See docs/rig-evaluation.md, 9.4 "Options". */
typedef struct MienRigDesc {
    size_t struct_size;
    uint32_t isa; /* MIEN_ISA_... */
    uint32_t rotation_output; /* MIEN_ROTATION_OUTPUT_... */
    uint32_t ml_masks; /* MIEN_ML_MASKS_... */
    uint32_t storage; /* MIEN_STORAGE_... */
    uint32_t reuse; /* MIEN_REUSE_... */
    uint32_t arithmetic; /* MIEN_ARITHMETIC_... */
    MienAllocator const* allocator;
} MienRigDesc;

/* Properties of a rig. */
typedef struct MienRigInfo {
    size_t struct_size;
    uint32_t isa; /* MIEN_ISA_... in use, never MIEN_ISA_BEST */
    uint32_t lod_count;
    uint32_t translation_unit; /* MIEN_TRANSLATION_UNIT_... */
    uint32_t rotation_unit; /* MIEN_ROTATION_UNIT_... */
    uint32_t axes[3]; /* MIEN_DIRECTION_... of x, y, z */
    uint32_t rotation_sequence; /* MIEN_ROTATION_SEQUENCE_... */
    int32_t rotation_signs[3]; /* 1 or -1, for the angles about x, y, z */
    uint32_t control_count; /* length of the control vector: raw, PSD, ML, RBF controls */
    uint32_t joint_value_count; /* 9 or 10 per joint */
    uint32_t rotation_output; /* MIEN_ROTATION_OUTPUT_... */
    uint32_t storage; /* MIEN_STORAGE_... */
    uint32_t arithmetic; /* MIEN_ARITHMETIC_... */
    uint64_t rig_bytes; /* memory of the rig, including its part of a baked file */
    uint64_t instance_bytes; /* memory of each instance */
} MienRigInfo;

/* The work of an evaluation at a LOD when all controls are active. */
typedef struct MienRigStatistics {
    size_t struct_size;
    uint32_t lod;
    uint32_t psd_count; /* correctives computed */
    uint32_t joint_count; /* joints of the LOD */
    uint32_t joint_row_count; /* rows of the joint groups */
    uint32_t blend_shape_count; /* channels written */
    uint32_t animated_map_row_count; /* rows of the animated map table */
    uint32_t rbf_solver_count; /* RBF solvers of the LOD */
    uint32_t quaternion_joint_count; /* quaternion joints */
    uint64_t joint_entry_count; /* stored in the joint matrix: 8 per block that is not all zeros */
    uint64_t joint_byte_count; /* of the joint matrix; an evaluation does not read the columns of controls that are 0 */
} MienRigStatistics;

typedef struct MienInstanceDesc {
    size_t struct_size;
    MienAllocator const* allocator;
} MienInstanceDesc;

/* What the joint stage reads for the current controls, at the LOD of the last evaluation (initially
LOD 0), if it reuses no results. Each byte is counted once, regardless of CPU caches. */
typedef struct MienInstanceStatistics {
    size_t struct_size;
    uint32_t lod; /* of the last evaluation */
    uint32_t control_count; /* of the control vector: raw, PSD, ML and RBF controls */
    uint32_t active_control_count; /* controls that are not 0 */
    uint32_t joint_column_count; /* columns of the joint matrix that active controls drive */
    uint64_t joint_entry_count; /* of these columns: 8 per block */
    uint64_t joint_byte_count; /* of these entries: at most MienRigStatistics.joint_byte_count */
} MienInstanceStatistics;

typedef struct MienBatchDesc {
    size_t struct_size;
    uint32_t capacity; /* instances per call: 1 to 2^20. 0: 32 */
    uint32_t tasks; /* tasks that may run at the same time, each with its own scratch memory. 0: 1, for calls without MienParallelFor */
    MienAllocator const* allocator;
} MienBatchDesc;

/* Options of a deformer. */
typedef struct MienDeformerDesc {
    size_t struct_size;
    uint32_t isa; /* MIEN_ISA_...; MIEN_ISA_BEST is that of the rig */
    uint32_t compose; /* MIEN_COMPOSE_... */
    uint32_t weights; /* MIEN_WEIGHTS_... */
    uint32_t normals; /* MIEN_NORMALS_...: what MIEN_NORMALS_DEFAULT means for this deformer */
    uint32_t with_tangents; /* compute tangents, for mien_deformer_instance_write_vertices() */
    uint32_t storage; /* MIEN_STORAGE_... of blend shape deltas, skin weights, texture coordinates and triangles. With 16 bits these are integers with scales, and triangles follow from faces. See docs/deformation.md, 2.1 "16-bit storage" */
    MienAllocator const* allocator;
    double delta_error; /* largest rounding error of a coordinate of a delta that 16-bit storage may make to store deltas with 10 bits, in translation units. 0: 2^-18 of the size of the mesh, which is also the least */
} MienDeformerDesc;

/* Properties of a deformer. */
typedef struct MienDeformerInfo {
    size_t struct_size;
    uint32_t isa; /* MIEN_ISA_... in use, never MIEN_ISA_BEST */
    uint32_t compose; /* MIEN_COMPOSE_... */
    uint32_t weights; /* MIEN_WEIGHTS_... */
    uint32_t normals; /* MIEN_NORMALS_..., never MIEN_NORMALS_DEFAULT */
    uint32_t lod_count;
    uint32_t joint_count;
    uint32_t channel_count;
    uint32_t mesh_count; /* same as in the rig, which has their names: MIEN_KIND_MESH */
    uint64_t deformer_bytes; /* memory of the deformer, including its part of a baked file */
    uint64_t instance_bytes; /* memory of a deformer instance for all meshes */
    uint32_t storage; /* MIEN_STORAGE_... */
    uint32_t reserved; /* 0 */
} MienDeformerInfo;

/* A neutral mesh. Its views are valid until the deformer is destroyed. */
typedef struct MienMesh {
    size_t struct_size;
    uint32_t position_count;
    uint32_t vertex_count;
    uint32_t triangle_count;
    uint32_t max_influences; /* of one position */
    uint32_t target_count; /* blend shape targets */
    uint32_t delta_count; /* of all targets */
    uint64_t lods; /* bit l: LOD l shows this mesh */
    MienFloatView positions; /* 3 floats per position: x y z */
    MienFloatView normals; /* 3 floats per vertex: x y z, unit length */
    MienFloatView tangents; /* 4 floats per vertex: x y z w, see MienVertexOutput; empty unless MienDeformerDesc.with_tangents was set */
    MienFloatView texture_coordinates; /* 2 floats per vertex: u v, as in the file; may be empty with 16-bit storage: see mien_deformer_texture_coordinates() */
    MienIndex32View vertex_position_indices; /* one index per vertex: its position */
    MienIndex32View triangles; /* 3 indices per triangle: vertices, wound as in the file; faces with more corners become fans about their first corner. May be empty with 16-bit storage: see mien_deformer_triangles() */
    MienIndex16View target_channels; /* one index per target: its blend shape channel; in file order */
} MienMesh;

typedef struct MienDeformerInstanceDesc {
    size_t struct_size;
    uint64_t lods; /* take memory for the meshes of these LODs only: bit l is LOD l. LODs that do not exist are ignored. 0: for all meshes */
    MienAllocator const* allocator;
} MienDeformerInstanceDesc;

/* One attribute of all vertices: vertex i is written at data + i * stride. `data` and `stride` are
multiples of 4; `stride` is at least the size of the format. */
typedef struct MienVertexStream {
    void* data; /* NULL: the attribute is not written */
    uint32_t stride; /* in bytes */
    uint32_t format; /* MIEN_VERTEX_FORMAT_... */
} MienVertexStream;

/* Where to write the vertices of a mesh, in the order of MienMesh.vertex_position_indices. Streams may
be interleaved (with the same stride) or separate, but must not share bytes. At least one is needed.

  positions  as floats; w is 1
  normals    in any format; w is 0
  tangents   in any format with w. The tangent points along the surface in the direction of growing u
             at constant v, perpendicular to the normal; w * cross(normal, tangent) points in the
             direction of growing v. w is 1, or -1 where the texture is mirrored. If you flip v (1 - v),
             negate w.

Neutral tangents are computed as by MikkTSpace, except that vertices are never split: where triangles
of both orientations meet, a vertex takes the orientation with the larger sum of angles. A vertex
without texture coordinates gets an arbitrary, but reproducible, perpendicular of its normal and
w = 1. Tangents are skinned, and then made perpendicular to the written normal.
See docs/deformation.md, 4 "Tangents". */
typedef struct MienVertexOutput {
    size_t struct_size;
    size_t vertex_capacity; /* of each stream: at least MienMesh.vertex_count */
    MienVertexStream positions;
    MienVertexStream normals;
    MienVertexStream tangents; /* requires MienDeformerDesc.with_tangents */
} MienVertexOutput;

/* How to create derivatives. */
typedef struct MienDerivativesDesc {
    size_t struct_size;
    MienDeformer const* deformer; /* of the rig. NULL: none, and no points from LOCALS to POSITIONS */
    MienAllocator const* allocator; /* NULL: the heap */
} MienDerivativesDesc;

/* Which matrix. */
typedef struct MienJacobianDesc {
    size_t struct_size;
    uint32_t from_point; /* MIEN_POINT_...: of the columns */
    uint32_t to_point; /* MIEN_POINT_...: of the rows */
    uint32_t mesh; /* the mesh of MIEN_POINT_POSITIONS, else 0 */
    uint32_t lod; /* of the evaluations: entries that other LODs add are left out */
    uint32_t const* inputs; /* numbers at from_point, one per column. NULL: all */
    uint32_t const* outputs; /* numbers at to_point, one per row, ascending. NULL: all */
    size_t input_count; /* 0 if `inputs` is NULL */
    size_t output_count; /* 0 if `outputs` is NULL */
    MienAllocator const* allocator; /* NULL: the heap */
} MienJacobianDesc;

/* The entries of a matrix: by column, then by row. */
typedef struct MienJacobianPattern {
    size_t struct_size;
    MienIndex32View rows; /* of each entry: a place in MienJacobianDesc.outputs, or a number at to_point */
    MienIndex32View columns; /* of each entry: a place in MienJacobianDesc.inputs, or a number at from_point */
    size_t row_count; /* rows and columns of the matrix, with or without entries */
    size_t column_count;
    size_t direction_count; /* directions that compute all columns: the colors of a coloring */
} MienJacobianPattern;

/* How to open a baked file. */
typedef struct MienBakedDesc {
    size_t struct_size;
    uint32_t file_access; /* MIEN_FILE_...; MIEN_FILE_READ also copies bytes in memory */
    uint32_t check; /* MIEN_BAKED_CHECK_... */
    MienAllocator const* allocator;
} MienBakedDesc;

/* Properties of an open baked file. */
typedef struct MienBakedInfo {
    size_t struct_size;
    uint64_t file_bytes; /* size of the file */
    uint64_t memory_bytes; /* memory taken from the allocator */
    uint64_t rig_bytes; /* size of the rig in the file. 0: it has none */
    uint64_t deformer_bytes; /* size of the deformer in the file. 0: it has none */
    uint32_t part_count; /* parts of the file, including unknown ones */
    uint32_t is_mapped; /* the file is mapped */
} MienBakedInfo;

/* Options of a rig that are not part of a baked file. */
typedef struct MienBakedRigDesc {
    size_t struct_size;
    uint32_t isa; /* MIEN_ISA_... */
    uint32_t reuse; /* MIEN_REUSE_... */
    MienAllocator const* allocator;
} MienBakedRigDesc;

/* Options of a deformer that are not part of a baked file. */
typedef struct MienBakedDeformerDesc {
    size_t struct_size;
    uint32_t isa; /* MIEN_ISA_...; MIEN_ISA_BEST is that of the rig */
    uint32_t normals; /* MIEN_NORMALS_...: what MIEN_NORMALS_DEFAULT means for this deformer; in this field MIEN_NORMALS_DEFAULT keeps the setting of the baked deformer */
    MienAllocator const* allocator;
} MienBakedDeformerDesc;

/* A named moment of a clip, such as a phoneme. In speech layers, events named "close:lips",
"close:lip-to-teeth" and "close:teeth" activate the matching guards of the mixer for `value` seconds. */
typedef struct MienClipEvent {
    int64_t tick;
    MienStringView name;
    float value;
    uint32_t reserved; /* 0 */
} MienClipEvent;

/* What to build a clip from. */
typedef struct MienClipDesc {
    size_t struct_size;
    uint32_t rate_numerator; /* frames per second, as a fraction. 0: 60 */
    uint32_t rate_denominator; /* 0: 1 */
    uint32_t frame_count; /* 1 to 2^28 */
    uint32_t channel_count; /* at most 65535, of which at most 512 may change over time */
    MienStringView const* names; /* one per channel, all different, not empty */
    float const* values; /* channel c of frame f is values[f * frame_stride + c] */
    size_t frame_stride; /* floats from frame to frame. 0: channel_count */
    float const* snaps; /* one per channel, used instead of `snap`; may be NULL */
    float snap; /* 0: values keep all bits. 2^-9, 2^-10 ... 2^-16: values are rounded to multiples of this step, which makes the clip several times smaller */
    uint32_t looping; /* MIEN_LOOPING_... */
    uint32_t is_delta; /* a delta clip, whose values are added to other values */
    uint32_t event_count;
    MienClipEvent const* events; /* in any order; 0 <= tick < frame_count * ticks per frame */
    MienAllocator const* allocator;
} MienClipDesc;

/* How to open a clip. */
typedef struct MienClipOpenDesc {
    size_t struct_size;
    uint32_t file_access; /* MIEN_FILE_...; no effect on memory and streams */
    uint32_t reserved; /* 0 */
    MienAllocator const* allocator;
} MienClipOpenDesc;

/* Properties of a clip. */
typedef struct MienClipInfo {
    size_t struct_size;
    uint32_t rate_numerator; /* frames per second, as a fraction */
    uint32_t rate_denominator;
    uint32_t frame_count;
    uint32_t channel_count;
    uint32_t changing_channel_count; /* channels whose value is not the same in all frames */
    uint32_t event_count;
    uint32_t looping; /* MIEN_LOOPING_CLAMP or MIEN_LOOPING_WRAP */
    uint32_t is_delta; /* as in MienClipDesc */
    float snap; /* largest step to which a channel was rounded. 0: none was */
    uint32_t is_mapped; /* the file is mapped */
    int64_t ticks_per_frame;
    int64_t length; /* ticks */
    uint64_t file_bytes; /* size of the clip */
    uint64_t memory_bytes; /* memory taken from the allocator */
    uint64_t player_bytes; /* memory of a player without MienClipPlayerDesc.reverse */
} MienClipInfo;

/* A channel of a clip. Block counts, bits and max_error are only known for a clip from
mien_clip_build(); they are 0 for a clip that was opened. */
typedef struct MienClipChannel {
    size_t struct_size;
    MienStringView name;
    float rest; /* value of a channel that does not change; otherwise 0 */
    uint32_t is_changing; /* the channel has a curve */
    uint32_t zero_blocks; /* blocks of 64 frames that are zero */
    uint32_t constant_blocks; /* blocks with one other value */
    uint32_t grid_blocks; /* blocks whose values are multiples of a decimal or binary fraction */
    uint32_t float_blocks; /* other blocks */
    uint64_t bits; /* of all blocks */
    float max_error; /* largest error of rounding to a step */
    uint32_t reserved; /* 0 */
} MienClipChannel;

/* How to play a clip. */
typedef struct MienClipPlayerDesc {
    size_t struct_size;
    uint32_t looping; /* MIEN_LOOPING_... */
    uint32_t interpolation; /* MIEN_INTERPOLATION_... */
    int32_t speed_numerator; /* speed, as a fraction; negative plays backward. -2^20 to 2^20 */
    int32_t speed_denominator; /* 1 to 2^20. Both 0: 1 / 1 */
    int64_t start_tick; /* initial position, as for mien_clip_player_seek() */
    uint32_t reverse; /* backward playback costs no more than forward; takes 256 more bytes per changing channel */
    uint32_t reserved; /* 0 */
    MienAllocator const* allocator;
} MienClipPlayerDesc;

/* State of a player. */
typedef struct MienClipPlayerInfo {
    size_t struct_size;
    int64_t tick; /* 0 to the length of the clip; with MIEN_LOOPING_WRAP less than the length */
    int64_t loops; /* loops completed since creation or the last seek, at most 2^61; negative: backward */
    uint32_t looping; /* MIEN_LOOPING_CLAMP or MIEN_LOOPING_WRAP */
    uint32_t is_damaged; /* a damaged curve was played, as zeros */
} MienClipPlayerInfo;

/* Adds weight * value of a channel to a raw or GUI control. */
typedef struct MienMatrixEntry {
    MienStringView channel;
    MienStringView control;
    float weight;
    uint32_t reserved; /* 0 */
} MienMatrixEntry;

/* How to bind a clip. */
typedef struct MienClipBindingDesc {
    size_t struct_size;
    MienMatrixEntry const* matrix; /* for channels whose names the rig does not have; may be NULL: those that mien_rig_match() knows need none */
    size_t matrix_count;
    MienAllocator const* allocator;
} MienClipBindingDesc;

/* What a binding found. Indices are ascending. */
typedef struct MienClipBindingInfo {
    size_t struct_size;
    uint32_t channel_count; /* channels of the clip */
    uint32_t raw_control_count; /* raw controls of the rig */
    uint32_t missing_entry_count; /* matrix entries whose channel or control does not exist */
    uint32_t reserved; /* 0 */
    MienIndex16View controls; /* raw controls that are driven */
    MienIndex16View extra_controls; /* raw controls that are not driven */
    MienIndex16View missing_channels; /* channels that drive nothing: the rig has no such name, or an earlier channel drives the same control */
} MienClipBindingInfo;

/* A layer of a mix. Leave the fields that its source does not use at zero. */
typedef struct MienMixLayer {
    int64_t period; /* of a generator, ticks */
    int64_t delay; /* of a stream, ticks: rows are played this much later than their times */
    float const* mask; /* one per curve, 0 to 1; curves beyond mask_count have 0. NULL: 1 for all */
    uint16_t const* curves; /* the curve of each channel of a stream, or the curves of a generator */
    float const* amounts; /* one per curve of a generator: a factor for its value */
    uint32_t mask_count;
    uint32_t curve_count;
    uint32_t group; /* MIEN_LAYER_GROUP_... */
    uint32_t mode; /* MIEN_BLEND_MODE_... */
    uint32_t source; /* MIEN_LAYER_SOURCE_... */
    uint32_t after_guards; /* acts after the guards; not allowed for base and speech */
    float weight; /* initial weight. 0 to 1; -1 to 1 with MIEN_BLEND_MODE_ADD */
    uint32_t first_pose; /* index of its first pose in MienMixDesc.poses */
    uint32_t pose_count;
    uint32_t generator; /* MIEN_GENERATOR_... */
    uint32_t stream_frames; /* capacity of a stream's queue, in rows. 0: 64; otherwise 2 to 1024 */
    uint32_t reserved; /* 0 */
} MienMixLayer;

/* A pose: the curves that it moves, and their values. */
typedef struct MienMixPose {
    uint16_t const* curves;
    float const* values;
    size_t count;
} MienMixPose;

/* A part of a reaction: moves the curves of a pose to its values and back to 0. Times are in ticks. */
typedef struct MienMixStroke {
    int64_t delay; /* after the trigger */
    int64_t attack; /* time to reach strength * pose */
    int64_t hold; /* time after the attack; ignored if is_held */
    int64_t release; /* time to return to 0 */
    uint32_t pose; /* index in MienMixDesc.poses */
    uint32_t mode; /* MIEN_BLEND_MODE_... */
    uint32_t is_held; /* holds as long as the stimulus lasts, and adapts unless is_lag */
    uint32_t is_lag; /* moves exponentially; attack and release are time constants */
    uint32_t is_scaled; /* scaled by the level of the reaction, which is 1 if mien_mixer_trigger() started it */
    uint32_t reserved; /* 0 */
} MienMixStroke;

/* The response of a face to a stimulus, such as a bright light. */
typedef struct MienMixReaction {
    int64_t cooldown; /* ticks; minimum time between two starts of strokes that are not held */
    int64_t adapt_ticks; /* time constant of adaptation to a lasting stimulus */
    int64_t recover_ticks; /* time constant of recovery after the stimulus */
    MienMixStroke const* strokes; /* at most 8 */
    size_t stroke_count;
    uint32_t retrigger; /* MIEN_RETRIGGER_... */
    uint32_t after_guards; /* acts after the guards */
    float adapted; /* share of the strength that remains after full adaptation; 1: all */
    float level_on; /* levels of this or more are a stimulus: mien_mixer_set_level(). 0: the reaction takes no levels */
    float level_off; /* the stimulus ends below this; at most level_on */
    uint32_t reserved; /* 0 */
} MienMixReaction;

/* Two curves that move the face in opposite directions. If both are above 0, the smaller one times
stiffness is subtracted from both. */
typedef struct MienMixAntagonists {
    uint16_t first;
    uint16_t second;
    float stiffness; /* 0 to 1 */
} MienMixAntagonists;

/* A point of the face: the mean of some positions of a mesh that LOD 0 shows, or of some joints. */
typedef struct MienLandmark {
    uint32_t const* points; /* indices of positions of the mesh, or of joints */
    uint32_t point_count; /* 1 to 65536 */
    uint32_t mesh; /* index of the mesh. MIEN_NO_MESH: the points are joints */
} MienLandmark;

/* A guard with landmarks of the caller. It keeps the gap between them, the height of `upper` above `lower`
along the axis that points up, from being opened. */
typedef struct MienMixGuard {
    MienLandmark upper;
    MienLandmark lower;
    uint32_t closed_by; /* raw control that closes the gap at 1. MIEN_NO_CONTROL: it is closed at rest */
    uint32_t needs_speech; /* acts at most as much as the largest weight of a speech layer */
    float tolerance; /* millimeters by which later layers may open the gap, 0 or more; 0.3 for built-in guards */
    float f_on; /* millimeters, above 0: acts if base and speech leave a smaller gap, fully at 0. Built-in guards: 12 for lips, 6 for lids, 4 for teeth */
} MienMixGuard;

/* What to mix. Everything is copied. */
typedef struct MienMixDesc {
    size_t struct_size;
    MienMixLayer const* layers; /* at most 16 */
    size_t layer_count;
    MienMixPose const* poses; /* at most 1024; used by layers and strokes */
    size_t pose_count;
    MienMixReaction const* reactions; /* at most 16 */
    size_t reaction_count;
    MienMixAntagonists const* antagonists;
    size_t antagonist_count;
    uint16_t const* mirror; /* for each curve its counterpart in the other half of the face, or itself. NULL: clips cannot be played mirrored */
    float const* lower; /* limits per curve. NULL: none; both or neither */
    float const* upper;
    MienMixGuard const* custom_guards; /* numbered after the built-in ones; at most 8 guards in total */
    size_t custom_guard_count;
    MienGaze const* gaze; /* for a layer with MIEN_GENERATOR_GAZE; may be NULL */
    MienDeformer const* deformer; /* to measure guards; may be NULL if there are none */
    uint32_t guards; /* MIEN_GUARD_... bits; a guard is left out if the rig lacks its landmarks */
    uint32_t variable_count; /* pose variables; at most 4096 curves with the raw controls */
    uint32_t player_count; /* clips that can play at the same time; a crossfade needs two. 0: two for each clip layer */
    uint32_t max_channels; /* of any clip. 0: the number of raw controls */
    uint32_t max_changing_channels; /* of any clip. 0: max_channels, 512 at most */
    uint32_t max_events; /* events that one step can report. 0: 64 */
    uint32_t reverse; /* as in MienClipPlayerDesc */
    uint32_t reserved; /* 0 */
    MienAllocator const* allocator;
} MienMixDesc;

/* How to open a mix. */
typedef struct MienMixOpenDesc {
    size_t struct_size;
    MienAllocator const* allocator;
} MienMixOpenDesc;

/* Properties of a mix. */
typedef struct MienMixInfo {
    size_t struct_size;
    uint32_t raw_control_count;
    uint32_t variable_count;
    uint32_t curve_count; /* raw controls and pose variables */
    uint32_t layer_count;
    uint32_t stage_count; /* for mien_mixer_stage() */
    uint32_t guard_count; /* for mien_mixer_set_guard() */
    uint64_t mixer_bytes; /* memory of a mixer without MienMixerDesc.stages */
    uint64_t snapshot_bytes; /* size of a snapshot */
} MienMixInfo;

/* A guard of a mix, as it was measured: the distance in millimeters is `rest`, plus the sum of gain * curve,
plus a sum over pairs of curves that share a corrective. See docs/mixing.md, 4 "Guards". */
typedef struct MienMixGuardInfo {
    size_t struct_size;
    MienIndex16View curves; /* raw controls that change the distance, by descending gain */
    MienFloatView gains; /* 1 float per curve: millimeters at value 1 */
    uint32_t pair_count;
    uint32_t needs_speech; /* as in MienMixGuard */
    float rest; /* distance of a row of zeros */
    float tolerance; /* as in MienMixGuard */
    float f_on;
    float fit_error; /* millimeters, root mean square over the measured rows */
} MienMixGuardInfo;

/* How to create a gaze. */
typedef struct MienGazeDesc {
    size_t struct_size;
    char const* left_eye; /* name of a joint. NULL: L_Eye or FACIAL_L_Eye */
    char const* right_eye; /* name of a joint. NULL: R_Eye or FACIAL_R_Eye */
    MienAllocator const* allocator;
} MienGazeDesc;

/* A point in millimeters from the origin of the rig's model space, with the head in its neutral pose. */
typedef struct MienGazeTarget {
    float left;
    float up;
    float front;
} MienGazeTarget;

/* What was measured on the eyes. */
typedef struct MienGazeInfo {
    size_t struct_size;
    MienGazeTarget left_eye; /* center of rotation */
    MienGazeTarget right_eye;
    float fit_error; /* degrees, largest error found when an eye turns sideways and up at once */
    uint32_t reserved; /* 0 */
} MienGazeInfo;

/* The part of a gaze that the eyes cannot reach, left for the head to turn: tangents of angles, averaged
over both eyes. */
typedef struct MienGazeRest {
    float left;
    float up;
} MienGazeRest;

/* How to create a mixer. */
typedef struct MienMixerDesc {
    size_t struct_size;
    uint64_t seed; /* of the generators */
    uint32_t stages; /* keep the row after each stage, for mien_mixer_stage() */
    uint32_t reserved; /* 0 */
    MienAllocator const* allocator;
} MienMixerDesc;

/* How to play a clip in a layer. */
typedef struct MienPlayDesc {
    size_t struct_size;
    uint64_t clip_id; /* chosen by the caller, to identify clip and binding in mien_mixer_restore() */
    int64_t start_tick; /* in the clip */
    int64_t transition_ticks; /* 0 to 2^40 */
    uint32_t transition; /* MIEN_TRANSITION_... */
    uint32_t looping; /* MIEN_LOOPING_... */
    uint32_t interpolation; /* MIEN_INTERPOLATION_... */
    int32_t speed_numerator; /* as in MienClipPlayerDesc */
    int32_t speed_denominator;
    uint32_t mirrored; /* ; requires MienMixDesc.mirror */
} MienPlayDesc;

/* What a guard did in the last step. Distances are in millimeters, computed by the function of raw controls
that was measured on the rig; a negative distance means that both sides overlap. */
typedef struct MienGuardState {
    size_t struct_size;
    MienStringView name; /* "lips left", "lips center", "lips right", "teeth", "lower lip to teeth", "left lids", "right lids" or "custom" */
    MienIndex16View controls; /* raw controls that it may hold back */
    uint32_t kind; /* MIEN_GUARD_...; 0: one of MienMixDesc.custom_guards */
    float activation; /* how much it acted, 0 to 1 */
    float protected_distance; /* distance after the last layer of base and speech */
    float wanted; /* distance just before the guards, after the later layers and reactions */
    float limit; /* largest distance that the guard allows when fully active */
    float distance; /* distance after the guards: above `limit` if the guard is not fully active, while it eases in, or if other controls open the gap */
} MienGuardState;

/* State of a mixer. */
typedef struct MienMixerInfo {
    size_t struct_size;
    int64_t tick; /* time since creation */
    uint32_t event_count; /* clip events that the last step passed */
    uint32_t lost_events; /* there were more than MienMixDesc.max_events */
} MienMixerInfo;

/* A clip that mien_mixer_restore() may need. */
typedef struct MienMixerClip {
    uint64_t clip_id; /* as in MienPlayDesc */
    MienClip const* clip;
    MienClipBinding const* clip_binding;
} MienMixerClip;

/* Aim constraint: turns a joint so that one of its axes points at a target, by the shortest rotation, then
about that axis so that `up_axis` comes as near to `up` as possible. Directions may have any length. */
typedef struct MienAimSolver {
    uint32_t joint;
    uint32_t target_joint; /* its position is the target. MIEN_NO_JOINT: three curves of the row are */
    uint32_t target_curve; /* first of these three: x y z in model space */
    float axis[3]; /* aim axis, in the space of the joint; not 0 0 0 */
    float up_axis[3]; /* in the space of the joint; 0 0 0: no rotation about the aim axis */
    float up[3]; /* in model space; 0 0 0: 0 1 0 */
    float cone_degrees; /* 0 to 180: largest angle from the neutral direction. 0: no limit */
    float weight; /* 0 to 1 */
} MienAimSolver;

/* Space switch: moves a joint as if its parent were attached to another joint. A curve selects one of the
spaces. When it changes, the joint stays where it is, and the difference to the new space eases out. */
typedef struct MienSpaceSolver {
    int64_t ease_ticks; /* 0 to 2^40 */
    uint16_t const* spaces; /* indices of joints. MIEN_NO_JOINT: model space */
    uint32_t space_count; /* 1 to 8 */
    uint32_t curve; /* of the row: its value, rounded, is an index in `spaces` */
    uint32_t joint;
    uint32_t reserved; /* 0 */
} MienSpaceSolver;

/* Spring: lets the position of a joint swing about its position in the pose. It is a damped harmonic
oscillator in model space, advanced by its exact solution, so it is stable for any time step. Output 0 is
its speed, in translation units per second. */
typedef struct MienSpringSolver {
    uint32_t joint;
    float frequency; /* of the undamped spring, in Hertz; above 0 */
    float damping; /* damping ratio, 0 or more; 1 is critical damping */
    float rest_offset[3]; /* rest position relative to the position in the pose, in model space */
    float stretch; /* largest distance from the rest position. 0: no limit */
    float teleport; /* if the rest position jumps farther than this in a step, the joint jumps with it. 0: never */
} MienSpringSolver;

/* Twist distribution: gives joints a share of another joint's twist about an axis, in place of their own
twist. Output 0 is the sine of half the angle. */
typedef struct MienTwistSolver {
    uint16_t const* joints;
    float const* shares; /* one for each of these joints, -1 to 1; 0.5 is half the angle */
    uint32_t joint_count; /* 1 to 8 */
    uint32_t source; /* the joint whose twist is distributed */
    float axis[3]; /* in the space of the source and of each joint; not 0 0 0 */
    uint32_t reserved; /* 0 */
} MienTwistSolver;

/* Copy: gives a joint the motion of another joint relative to its neutral pose, or the mirrored motion. */
typedef struct MienCopySolver {
    uint32_t source; /* the joint whose motion is copied */
    uint32_t joint;
    uint32_t is_mirrored; /* mirror the motion */
    float mirror_axis[3]; /* from right to left in model space; 0 0 0: 1 0 0 */
    float weight; /* 0 to 1 */
} MienCopySolver;

/* The data of one character that a MienUserSolver gets. */
typedef struct MienSolverPose {
    float* locals; /* 10 floats per joint: tx ty tz qx qy qz qw sx sy sz, relative to the parent. Joints in `writes` may be changed; quaternions of any length but 0 */
    float const* models; /* 16 floats per joint, as in mien_deformer_instance_joint_matrices(); up to date for joints in `reads` */
    float const* previous; /* 16 floats for each joint in `previous_joints`, as the last step left it */
    float const* row; /* MienSolverStackDesc.curve_count floats. NULL: there are none */
    float* outputs; /* MienUserSolver.output_count floats for the caller to read */
    void* state; /* MienUserSolver.state_bytes bytes, aligned to 8; initially zero */
    uint32_t lod;
    uint32_t is_reset; /* the first step, or the character was teleported */
} MienSolverPose;

/* The argument of a MienUserSolver. */
typedef struct MienSolverCall {
    MienSolverPose const* poses; /* one for each of at most 64 characters */
    uint16_t const* parents; /* one per joint; a root is its own parent */
    int64_t ticks; /* since the last step */
    uint32_t pose_count;
    uint32_t joint_count;
} MienSolverCall;

/* A custom solver. It runs on the thread that calls the step function, and must not use the handles passed
to that function. */
typedef struct MienUserSolver {
    void* user; /* passed to the function; must live as long as the stack and its states */
    void (*solve)(void* user, MienSolverCall const* call); /* Changes the locals of the characters in `call`, and their outputs and state, but nothing else. */
    uint16_t const* reads; /* joints whose model matrices it reads */
    uint16_t const* writes; /* joints whose local transforms it changes */
    uint16_t const* previous_joints; /* joints whose model matrices after the last step it reads */
    uint32_t read_count;
    uint32_t write_count; /* 1 or more */
    uint32_t previous_joint_count;
    uint32_t state_bytes; /* 0 to 2^20 */
    uint32_t output_count; /* 0 to 4096 */
    uint32_t reserved; /* 0 */
} MienUserSolver;

/* One solver: exactly one of the pointers aim ... custom is not NULL. */
typedef struct MienSolver {
    char const* name; /* for messages. NULL: the name of its kind */
    MienAimSolver const* aim; /* may be NULL */
    MienSpaceSolver const* space; /* may be NULL */
    MienSpringSolver const* spring; /* may be NULL */
    MienTwistSolver const* twist; /* may be NULL */
    MienCopySolver const* copy; /* may be NULL */
    MienUserSolver const* custom; /* may be NULL */
    uint64_t lods; /* bit l: runs at LOD l. 0: at all LODs */
} MienSolver;

/* How to create a solver stack. Everything is copied. */
typedef struct MienSolverStackDesc {
    size_t struct_size;
    MienSolver const* solvers; /* in the order in which they run; at most 256 */
    size_t solver_count;
    uint32_t curve_count; /* the rows passed to steps have this many curves or more. 0: no row */
    uint32_t check_writes; /* compare all joints before and after each solver, to find undeclared writes: mien_solver_state_undeclared() */
    MienAllocator const* allocator;
} MienSolverStackDesc;

/* Properties of a solver stack. */
typedef struct MienSolverStackInfo {
    size_t struct_size;
    uint32_t solver_count;
    uint32_t curve_count;
    uint32_t output_count; /* of all solvers */
    uint32_t joint_count;
    uint64_t state_bytes; /* memory of a state */
} MienSolverStackInfo;

/* How to create a solver state. */
typedef struct MienSolverStateDesc {
    size_t struct_size;
    MienAllocator const* allocator;
} MienSolverStateDesc;

/* The input of the solvers of one character. */
typedef struct MienSolverInput {
    float const* row; /* such as the one from mien_mixer_row(). NULL: none */
    size_t row_count; /* at least MienSolverStackDesc.curve_count */
    uint32_t lod; /* 0 to 63 */
    uint32_t is_reset; /* the character was teleported, so springs come to rest and space switches do not ease */
} MienSolverInput;

/* A raw control and its share: if the name has the value v, the control gets weight * v. */
typedef struct MienControlShare {
    uint32_t control;
    float weight;
} MienControlShare;

/* What to generate. */
typedef struct MienGenerateDesc {
    size_t struct_size;
    uint32_t preset; /* MIEN_PRESET_... */
    uint32_t flags; /* MIEN_GENERATE_..., combined with | */
    uint64_t seed; /* the same preset, flags and seed give the same bytes on every machine */
    MienAllocator const* allocator;
} MienGenerateDesc;

/* A named part of the input mesh. It becomes a mesh of the DNA file. */
typedef struct MienAuthorObject {
    MienStringView name; /* 1 to 200 bytes */
    uint32_t first_face; /* the face after the last one of the object before it */
    uint32_t face_count;
} MienAuthorObject;

/* An expression. It becomes a raw control of the same name, 0 to 1. */
typedef struct MienAuthorShape {
    MienStringView name; /* 1 to 200 bytes; all different */
    uint32_t const* positions; /* indices of the positions that move. NULL: all, in order */
    size_t position_count; /* of `positions`, or of the mesh */
    double const* displacements; /* 3 for each of these positions, with the control at 1 */
} MienAuthorShape;

/* A mesh to rig: a head, or the front of one, with everything inside it. */
typedef struct MienAuthorMesh {
    size_t struct_size;
    double const* positions; /* 3 per position, in the unit and axes of MienAuthorDesc */
    size_t position_count;
    uint32_t const* face_sizes; /* corners of each face, 3 or more. NULL: all are triangles */
    size_t face_count;
    uint32_t const* corners; /* indices of positions, face by face, counterclockwise seen from outside */
    size_t corner_count;
    double const* uvs; /* 2 per UV; may be NULL */
    size_t uv_count;
    uint32_t const* corner_uvs; /* indices of UVs, one per corner. NULL: no UVs */
    MienAuthorObject const* objects; /* NULL: a single object named "head" */
    size_t object_count;
    MienAuthorShape const* shapes; /* may be NULL */
    size_t shape_count;
} MienAuthorMesh;

/* A bone placed by the caller. */
typedef struct MienAuthorBone {
    MienStringView name; /* 1 to 200 bytes; all different */
    double position[3]; /* in the space of the mesh, not relative to the parent */
    uint32_t parent; /* index of an earlier bone; the first bone is its own parent */
    uint32_t kind; /* MIEN_BONE_...: the first bone is the root, and facial bones are consecutive */
} MienAuthorBone;

/* A point of the face that joints are placed by. */
typedef struct MienAuthorLandmark {
    MienStringView name; /* "nose" (tip), "throat", "lip_upper", "lip_lower" (in the middle), "mouth_l", "mouth_r" (corners, as the character sees them), "chin", "jaw" (its axis, in the middle plane), "eye_l", "eye_r" (centers of the eyeballs), "head", "neck" (pivots) */
    double position[3]; /* in the unit and axes of the mesh */
} MienAuthorLandmark;

/* A LOD of the mesh, made by the caller. */
typedef struct MienAuthorLod {
    uint32_t const* corners; /* indices of positions of the mesh, three per triangle, all three in the same object. Objects without triangles are not in the LOD */
    size_t corner_count;
    uint32_t const* corner_uvs; /* indices of UVs, one per corner. NULL: chosen from the UVs that each position has in the mesh, so that they are nearest to each other */
} MienAuthorLod;

/* How to rig a mesh. bones, weights, depth_groups, mask, lod_joints, bone_groups, bone_motions and
lod_meshes let the caller provide the result of one stage, which is then skipped. */
typedef struct MienAuthorDesc {
    size_t struct_size;
    uint32_t facial_joints; /* 1 to 7000. 0: 240 */
    uint32_t influences; /* per position: 1 to 12. 0: 8 */
    uint32_t lods; /* 1 to 8. 0: 8 */
    uint32_t groups; /* depth groups, of which the front one is the face: 2 to 16. 0: 3 */
    uint64_t seed; /* of the initial guesses of bone placement */
    double unit; /* centimeters per unit of the mesh. 0: 1 */
    uint32_t up; /* MIEN_MESH_AXIS_... */
    uint32_t front; /* MIEN_MESH_AXIS_..., perpendicular to `up` */
    uint32_t symmetry; /* MIEN_SYMMETRY_... */
    uint32_t flags; /* MIEN_AUTHOR_..., combined with | */
    MienStringView name; /* of the character; empty: "head" */
    MienStringView face_object; /* name of the object with the face; empty: found automatically */
    MienAuthorBone const* bones; /* NULL: placed automatically */
    size_t bone_count;
    uint16_t const* weight_joints; /* indices of bones, `influences` per position of the mesh. NULL: weights are computed */
    float const* weights; /* the weights for weight_joints; both or neither, and only with `bones` */
    MienParallelFor const* parallel; /* may be NULL */
    void* progress_user; /* passed to the next function */
    int32_t (*progress)(void* user, char const* step, double share); /* Called on the calling thread with the name of the step that begins and the progress from 0 to 1, which never decreases. Returns 0 to continue; anything else cancels. May be NULL. */
    MienAllocator const* allocator;
    uint8_t const* depth_groups; /* one per position of the mesh: its depth group, less than `groups`, 0 in front. NULL: computed */
    uint8_t const* mask; /* one per position of the mesh: nonzero in the face mask, where facial bones are placed. NULL: computed */
    uint32_t const* lod_joints; /* maximum number of facial joints in each of `lods` LODs (mirrored pairs stay together); never increasing, and LOD 0 has all. NULL: 240, 160, 110, 75, 50, 32, 20, 12, scaled to facial_joints */
    uint32_t const* bone_groups; /* joint group of each of `bones`, 0 to 255. NULL: computed */
    double const* bone_motions; /* 6 numbers for each of `bones`, shape by shape, with the control at 1: translation, then degrees about X, Y, Z, applied in this order, in the unit and axes of the mesh. NULL: fitted */
    uint32_t joint_groups; /* 1 to 24. 0: chosen so that each has about 75 rows */
    uint32_t overlap_correctives; /* maximum number of correctives that damp pairs of shapes with overlapping motion. 0: none */
    double lod_triangles; /* share of the triangles of a LOD that the next one keeps: above 0, at most 1. 0: 0.5. 1: all */
    MienAuthorLod const* lod_meshes; /* LOD 1, LOD 2 and so on. NULL: made according to lod_triangles */
    size_t lod_mesh_count; /* one less than `lods` */
    MienAuthorLandmark const* landmarks; /* used instead of those that are found; each name once, in any order. With "jaw", or a landmark of the mouth, there is a jaw even if no shape opens it. NULL: all are found */
    size_t landmark_count;
} MienAuthorDesc;

typedef struct MienDocumentDesc {
    size_t struct_size;
    MienAllocator const* allocator;
    uint32_t file_access; /* MIEN_FILE_...; for mien_document_open_file() only */
    uint32_t unknown_layers; /* MIEN_UNKNOWN_LAYERS_...; for mien_document_open_file() only */
} MienDocumentDesc;

/* How many deltas and targets mien_document_prune_targets() removed. */
typedef struct MienPrunedTargets {
    size_t struct_size;
    uint64_t deltas;
    uint64_t targets;
} MienPrunedTargets;

/* The largest magnitudes of entries of the joint matrix that count as small, in the units of the file. */
typedef struct MienPruneJointsDesc {
    size_t struct_size;
    float translation;
    float rotation;
    float scale;
    uint32_t reserved; /* 0 */
} MienPruneJointsDesc;

/* The effect of mien_document_prune_joints(): removed entries, and the largest distance by which a position
moved. */
typedef struct MienPrunedJoints {
    size_t struct_size;
    uint64_t entry_count; /* entries of the joint matrix that were not 0 */
    uint64_t removed_count; /* of these, set to 0 */
    double worst_distance; /* in the unit of the file */
    uint32_t worst_control; /* the raw control at 1, or the corrective whose raw controls were at 1 */
    uint32_t worst_mesh;
    uint32_t worst_position;
    uint32_t reserved;
} MienPrunedJoints;

/* How to place a character: it is scaled about the origin, then rotated about it, then moved. */
typedef struct MienPlacement {
    size_t struct_size;
    double scale; /* above 0. 0: 1 */
    double rotation[3]; /* right-handed degrees about x, then y, then z of the file */
    double translation[3]; /* in the unit of the file */
} MienPlacement;

/* How mien_document_project() works. */
typedef struct MienProjectDesc {
    size_t struct_size;
    uint32_t match; /* MIEN_MATCH_... */
    uint32_t influences; /* at most, per position. 0: 8 */
    uint32_t keep_weights; /* leave the skin weights as they are */
    uint32_t keep_targets; /* leave the targets as they are */
} MienProjectDesc;

/* How far the rig moved to follow a mesh. */
typedef struct MienConformed {
    size_t struct_size;
    double joint_distance; /* largest distance by which a joint moved, in the unit of the file */
    uint32_t joint; /* that joint */
    uint32_t reserved;
} MienConformed;

/* How mien_document_transplant() works. */
typedef struct MienTransplantDesc {
    size_t struct_size;
    uint32_t match; /* MIEN_MATCH_..., for meshes of the same name; positions of the same number correspond if the meshes have the same faces */
    uint32_t influences; /* at most, per position. 0: 8 */
} MienTransplantDesc;

/* How differently a raw control of both rigs, at 1, moves the positions of LOD 0. */
typedef struct MienControlError {
    double worst; /* distance of a position, in the unit of the file */
    double rms;
    double moved; /* largest distance by which the control moved a position before */
    uint32_t control; /* its index in the new rig */
    uint32_t reserved;
} MienControlError;

/* Takes the bytes of a file, in pieces and in order. `write` is called only during the call that takes the
struct, and on the same thread. */
typedef struct MienByteSink {
    void* user; /* passed to the function */
    size_t (*write)(void* user, void const* bytes, size_t size); /* Takes `size` bytes and returns the number of bytes taken; any number but `size` ends the call. */
} MienByteSink;

/* A point of a surface: the weighted sum of three positions of a mesh. One position: weights 1 0 0. */
typedef struct MienSolvePoint {
    uint32_t mesh; /* of the rig; points of a fit may be on several meshes */
    uint32_t positions[3]; /* in the order of the file */
    float weights[3];
} MienSolvePoint;

/* How to create a fit. Everything is copied. Raw controls in a row that are named as the parts x y z w of a
quaternion (.qx .qy .qz .qw, or .x .y .z .w), and begin as 0 0 0 1, are a rotation: if all four may move, they keep
the length 1, and have no bounds. */
typedef struct MienFitDesc {
    size_t struct_size;
    MienDeformer const* deformer; /* of the rig; needed for points and for constraints on joints. NULL: none */
    uint32_t const* controls; /* raw controls that may move, ascending. NULL: all */
    float const* lower; /* bounds of these controls. NULL: 0 */
    float const* upper; /* NULL: 1 */
    uint32_t const* symmetric; /* pairs of raw controls kept similar: left, right, left, ... */
    MienSolvePoint const* points;
    float const* joint_weights; /* per joint value, 0 or more. NULL: 1 each, or 0 if there are points */
    size_t control_count; /* 0 if `controls` is NULL */
    size_t symmetric_count; /* elements of `symmetric`, an even number */
    size_t point_count;
    uint32_t lod;
    uint32_t reserved; /* 0 */
    MienAllocator const* allocator; /* NULL: the heap */
} MienFitDesc;

/* How to create a surface. Everything is copied. Its unit and axes are those of the rig; triangles may be
wound either way, but all the same way. */
typedef struct MienFitSurfaceDesc {
    size_t struct_size;
    float const* positions; /* x y z each. Positions in the same place are one, as along texture seams */
    uint32_t const* triangles; /* three positions each */
    size_t position_count;
    size_t triangle_count;
    MienAllocator const* allocator; /* NULL: the heap */
} MienFitSurfaceDesc;

/* A pinhole camera: image x = focal[0] * x / z + center[0], and y likewise, for the point x y z in camera
space, after `rotation` and `translation`. z grows in front of the camera. */
typedef struct MienFitCamera {
    float focal[2];
    float center[2];
    float rotation[9]; /* rows, from model space. With MienFitFrame.rigid, all 0: unknown */
    float translation[3];
} MienFitCamera;

/* A constraint of a frame. A number that is NaN: the constraint is missing. */
typedef struct MienFitConstraint {
    uint32_t kind; /* MIEN_CONSTRAINT_... */
    uint32_t joint; /* of the rig */
    uint32_t points[2]; /* places in MienFitDesc.points */
    float axis[3]; /* in the axes of the joint, of any length but 0 */
    float target[3]; /* a place, or a direction of any length but 0 */
    float distances[2]; /* the smallest and the largest that cost nothing */
    float weight; /* times the squared residual: of a length in the unit of the rig, or of the difference of directions of length 1 */
} MienFitConstraint;

/* The targets of one frame, and the weights of the terms; terms of weight 0 are left out. Joints, points, images, a
surface and constraints may be given together: a point may have a target of each kind. Each kind has a unit of its
own: joint values, lengths (points and surface), and that of images. */
typedef struct MienFitFrame {
    size_t struct_size;
    float const* joints; /* joint values. NULL: none. NaN: missing */
    float const* points; /* x y z per point. NULL: none. NaN: missing */
    float const* images; /* x y per point, as `camera` sees them. NULL: none. NaN: missing */
    MienFitCamera const* camera; /* required with `images` */
    float const* point_weights; /* per point, 0 or more: of points and images. NULL: 1 */
    float const* start; /* all raw controls of the rig, to start from. NULL: the initial ones */
    float const* prior; /* raw controls that the result is drawn to. NULL: the initial ones */
    float prior_weight; /* times the squared distance to `prior` */
    float smooth_weight; /* times the squared distance to `start`, the previous frame */
    float sparse_weight; /* times the sum of magnitudes, from the initial values: few controls explain the frame */
    float symmetric_weight; /* times the squared differences of symmetric pairs */
    float robust_scale; /* points farther off than this, or from the surface, count less. 0: all count fully */
    float joint_weight; /* weight of the joints relative to the points. 0: 1 */
    uint32_t rigid; /* points and surface may be rotated and translated as a whole, by one motion. With `images`, these stay where they are in model space, and the camera is found, from that of `camera`, or, if its rotation is unknown, from one that sees the face from the front */
    uint32_t max_iterations; /* 0: 50 */
    double max_seconds; /* 0: no limit. A limit makes results depend on the machine */
    void* user; /* passed to `canceled` */
    uint32_t (*canceled)(void* user); /* Called before each iteration; a nonzero result stops. NULL: never. */
    MienFitSurface const* surface; /* each point is drawn to the nearest place of the surface that faces the same way, within 60 degrees, and is not at a border. NULL: none */
    float surface_reach; /* points farther from the surface have no target. 0: no limit */
    uint32_t focal; /* , with `images` and `rigid`: the focal length is found too, its two numbers scaled alike */
    size_t constraint_count;
    MienFitConstraint const* constraints; /* up to 64, added to all other targets. NULL: none */
    uint32_t const* stages; /* per raw control of the rig, up to 15: the solve begins with the controls of stage 0 alone, then those of stage 1 move too, and so on, as jaw and eyes before the rest. Each stage may take `max_iterations`. NULL: all move from the start */
    float const* point_offsets; /* x y z per point, in model space: how far the points of the face in the targets are from those of the rig at rest, where it is another person's. Constraints are about the points of the rig. NULL: 0 */
    float const* surface_weights; /* per point, 0 or more: how much it is drawn to `surface`. NULL: those of `point_weights` */
    float image_weight; /* weight of the images relative to the points: of a squared length in the image, against a squared length in space. 0: 1 */
    float image_robust_scale; /* `robust_scale` of images, in their unit. 0: `robust_scale`, or, if there are points or a surface too, all count fully */
} MienFitFrame;

/* The result of a solve. */
typedef struct MienFitResult {
    size_t struct_size;
    uint32_t status; /* MIEN_FIT_... */
    uint32_t iterations;
    double cost; /* the minimized sum, with all terms */
    double joint_residual; /* weighted root mean square of the differences of joint values */
    double point_residual; /* the same for points; without these, for images in their unit; without both, for the surface */
    uint32_t missing_points; /* with a surface: those that have no target */
    uint32_t reserved;
    float rotation[9]; /* rows: points of the target = rotation * model + translation, if rigid; the camera's with images */
    float translation[3];
    double joint_worst; /* largest difference of a joint value that counts */
    double point_worst; /* largest distance of a point that counts, of the same kind */
    float focal[2]; /* of the camera, with images; else 0 */
    double constraint_residual; /* weighted root mean square of the residuals of constraints */
    double constraint_worst; /* largest residual of a constraint that counts */
    uint32_t jumped; /* joint values or points moved farther from where they are at `start` than their targets ask for, as roots of mean squares; those without a target count as such that ask for nothing */
    uint32_t reserved_2;
    double image_residual; /* weighted root mean square of the distances in the image */
    double image_worst;
    double surface_residual; /* the same of the distances from the surface */
    double surface_worst;
} MienFitResult;
]]

ffi.cdef [[

/* Returns the MIEN_VERSION of the library in use, which may differ from that of this header. */
uint32_t mien_version(void);

/* Returns "DNA_TRUNCATED" for MIEN_ERROR_DNA_TRUNCATED, and "UNKNOWN" for unknown numbers. The string
is static and null-terminated. */
char const* mien_status_name(MienStatus status);

/* Returns the coordinate system of an engine or tool: "maya", "unreal", "unreal-mesh" (characters
look along y), "unity", "godot", "blender", "gltf", "opengl", "directx" or "houdini". The rotation
rule is MIEN_ROTATION_RULE_CARRIED; rotation_sequence is that of the engine's Euler angles, and only
takes effect if you set another rule.
Fails with MIEN_ERROR_NAME if the name is none of these. */
MienStatus mien_coordinate_system_find(char const* name, MienCoordinateSystem* out_system);

/* Returns the coordinate system of an engine or tool: "maya", "unreal", "unreal-mesh" (characters
look along y), "unity", "godot", "blender", "gltf", "opengl", "directx" or "houdini". The rotation
rule is MIEN_ROTATION_RULE_CARRIED; rotation_sequence is that of the engine's Euler angles, and only
takes effect if you set another rule.
Fails with MIEN_ERROR_NAME if the name is none of these. */
MienStatus mien_coordinate_system_find_n(char const* name, size_t name_count, MienCoordinateSystem* out_system);

/* Returns a name that mien_coordinate_system_find() accepts. The string is static.
Fails with MIEN_ERROR_INDEX if `index` is past the last name. */
MienStatus mien_coordinate_system_name(uint32_t index, MienStringView* out_name);

/* Opens a DNA file of version 2.1 to 2.8, or the known layers of a later 2.x. Checks everything that
it loads. Close with mien_dna_close().

Numbers and names stay in the file and are read when needed. Memory is allocated for lists only:
typically a few percent of the size of the loaded layers, at most 20 times their size. Do not truncate
or overwrite a mapped file while it is open; replacing it by renaming is safe.

Fails with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ if the file cannot be read,
MIEN_ERROR_DNA_SIGNATURE or MIEN_ERROR_DNA_VERSION if it is not a DNA file of generation 2,
MIEN_ERROR_DNA_TRUNCATED, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT
or MIEN_ERROR_DNA_VALUE if its contents are not valid or cannot be converted to the requested
system, MIEN_ERROR_LOD if it has none of the requested LODs.
See docs/dna-format.md, 13 "What is checked". */
MienStatus mien_dna_open_file(char const* path, MienDnaDesc const* desc, MienDna** out_dna, MienError* error);

/* Opens a DNA file in memory: `size` bytes, of any alignment. `bytes` must outlive the MienDna,
unchanged.
Fails like mien_dna_open_file(), but not with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ. */
MienStatus mien_dna_open_memory(void const* bytes, size_t size, MienDnaDesc const* desc, MienDna** out_dna, MienError* error);

/* Opens a DNA file through a stream. Reads the header, the index and the requested layers, each
with one read, into memory from the allocator.
Fails like mien_dna_open_file(), but not with MIEN_ERROR_FILE_OPEN. */
MienStatus mien_dna_open_stream(MienStream const* stream, MienDnaDesc const* desc, MienDna** out_dna, MienError* error);

/* Closes a DNA. Rigs and deformers created from it stay valid; views into it do not. */
void mien_dna_close(MienDna* dna);

/* Returns the properties of a DNA. */
MienStatus mien_dna_info(MienDna const* dna, MienDnaInfo* out_info);

/* Returns entry `index` of the index table, in file order.
Fails with MIEN_ERROR_INDEX if `index` is not below MienDnaInfo.layer_count.
See docs/dna-format.md, 4.1 "Index table". */
MienStatus mien_dna_layer(MienDna const* dna, uint32_t index, MienDnaLayer* out_layer);

/* Finds a field of a loaded layer by its path: the code of the layer, then the names of fields, with
an index after each list.

    desc.name                                 a string
    desc.metadata[0].key                      a string
    defn.jointNames                           a list of strings; defn.jointNames[3] is one
    defn.neutralJointTranslations.xs          floats
    bhvr.joints.jointGroups[7].values         floats
    geom.meshes[0].skinWeights[12].weights    floats
    mlbh.neuralNetworks[0].layers[1].biases   floats

Layers that are not loaded are empty.
Fails with MIEN_ERROR_NAME if there is no such field (the message contains the part of the path that
does not exist), MIEN_ERROR_INDEX if an index in the path is past the end.
See docs/dna-format.md, 6 "Layers, field by field". */
MienStatus mien_dna_field(MienDna const* dna, char const* path, MienDnaField* out_field, MienError* error);

/* Finds a field of a loaded layer by its path: the code of the layer, then the names of fields, with
an index after each list.

    desc.name                                 a string
    desc.metadata[0].key                      a string
    defn.jointNames                           a list of strings; defn.jointNames[3] is one
    defn.neutralJointTranslations.xs          floats
    bhvr.joints.jointGroups[7].values         floats
    geom.meshes[0].skinWeights[12].weights    floats
    mlbh.neuralNetworks[0].layers[1].biases   floats

Layers that are not loaded are empty.
Fails with MIEN_ERROR_NAME if there is no such field (the message contains the part of the path that
does not exist), MIEN_ERROR_INDEX if an index in the path is past the end.
See docs/dna-format.md, 6 "Layers, field by field". */
MienStatus mien_dna_field_n(MienDna const* dna, char const* path, size_t path_count, MienDnaField* out_field, MienError* error);

/* Returns the name of field `index` of the record at a path. The empty path is the file itself, whose
fields are the layers. The string is static.
Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if `index` or an index in the
path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a record.
See docs/dna-format.md, 6 "Layers, field by field". */
MienStatus mien_dna_child_name(MienDna const* dna, char const* path, uint32_t index, MienStringView* out_name, MienError* error);

/* Returns the name of field `index` of the record at a path. The empty path is the file itself, whose
fields are the layers. The string is static.
Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if `index` or an index in the
path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a record.
See docs/dna-format.md, 6 "Layers, field by field". */
MienStatus mien_dna_child_name_n(MienDna const* dna, char const* path, size_t path_count, uint32_t index, MienStringView* out_name, MienError* error);

/* Copies `count` elements of a field, beginning with element `first`, to `out`, in native byte order.
A field that is one number has one element. `out` may be NULL if `count` is 0. Integers are widened
to 64 bits.
Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
kind. */
MienStatus mien_dna_read_floats(MienDna const* dna, char const* path, uint64_t first, uint64_t count, float* out, MienError* error);

/* Copies `count` elements of a field, beginning with element `first`, to `out`, in native byte order.
A field that is one number has one element. `out` may be NULL if `count` is 0. Integers are widened
to 64 bits.
Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
kind. */
MienStatus mien_dna_read_floats_n(MienDna const* dna, char const* path, size_t path_count, uint64_t first, uint64_t count, float* out, MienError* error);

/* Copies `count` elements of a field, beginning with element `first`, to `out`, in native byte order.
A field that is one number has one element. `out` may be NULL if `count` is 0. Integers are widened
to 64 bits.
Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
kind. */
MienStatus mien_dna_read_integers(MienDna const* dna, char const* path, uint64_t first, uint64_t count, int64_t* out, MienError* error);

/* Copies `count` elements of a field, beginning with element `first`, to `out`, in native byte order.
A field that is one number has one element. `out` may be NULL if `count` is 0. Integers are widened
to 64 bits.
Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
kind. */
MienStatus mien_dna_read_integers_n(MienDna const* dna, char const* path, size_t path_count, uint64_t first, uint64_t count, int64_t* out, MienError* error);

/* Returns a string of the file.
Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is
past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a string. */
MienStatus mien_dna_read_string(MienDna const* dna, char const* path, MienStringView* out_string, MienError* error);

/* Returns a string of the file.
Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is
past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a string. */
MienStatus mien_dna_read_string_n(MienDna const* dna, char const* path, size_t path_count, MienStringView* out_string, MienError* error);

/* Writes a DNA file in canonical form: byte for byte the original if that was canonical and was loaded
completely. Layers that were not loaded are written empty. Another version may lack layers that others
need, such as the ML operations of networks; a file that could not be opened again is never written. The
file is written under a temporary name and renamed, so that a failure leaves `path` unchanged. An
existing file keeps its permissions; a symbolic link is followed, unless it leads nowhere.
Fails with MIEN_ERROR_FILE_WRITE if the file cannot be written, MIEN_ERROR_DNA_LAYER if RBF behavior
was loaded without the machine-learned behavior of its file (whose controls are numbered before its
own), MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE or MIEN_ERROR_DNA_VALUE if the file could
not be opened in the requested version, MIEN_ERROR_DNA_LIMIT if it would exceed 4 GiB,
MIEN_ERROR_MEMORY if the allocator of the DNA returns NULL.
See docs/dna-format.md, 14 "Writing a canonical file". */
MienStatus mien_dna_write_file(MienDna const* dna, char const* path, MienWriteDesc const* desc, MienError* error);

/* Writes a DNA file to memory and returns its size in `out_size`. `buffer` may be NULL with capacity 0
to get the size only. Writes nothing if `capacity` is too small; `out_size` is set nevertheless.
Fails like mien_dna_write_file(), but not with MIEN_ERROR_FILE_WRITE, and with
MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small. */
MienStatus mien_dna_write_memory(MienDna const* dna, MienWriteDesc const* desc, void* buffer, size_t capacity, size_t* out_size, MienError* error);

/* Checks all layers of a file and collects the findings: at most 32 per field and 1000 in total; the
last one tells whether there are more. Returns MIEN_OK if the file could be checked, whatever was
found. The file is read into memory first, so it may change during the call. Destroy with
mien_report_destroy().
Fails with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ if the file cannot be read.
See docs/dna-format.md, 13 "What is checked". */
MienStatus mien_dna_validate_file(char const* path, MienValidateDesc const* desc, MienReport** out_report, MienError* error);

/* Checks a file in memory: `size` bytes. `bytes` may be released afterwards. */
MienStatus mien_dna_validate_memory(void const* bytes, size_t size, MienValidateDesc const* desc, MienReport** out_report, MienError* error);

/* Returns the number of errors and the number of warnings. */
MienStatus mien_report_counts(MienReport const* report, uint32_t* out_errors, uint32_t* out_warnings);

/* Returns finding `index`, in the order of the checks. Their number is that of errors plus warnings.
Fails with MIEN_ERROR_INDEX if `index` is past the last finding. */
MienStatus mien_report_finding(MienReport const* report, uint32_t index, MienFinding* out_finding);

/* Destroys a report. */
void mien_report_destroy(MienReport* report);

/* Returns 1 if rigs can be created for instruction set `isa` on this machine, else 0. */
uint32_t mien_isa_available(uint32_t isa);

/* Returns "avx2" for MIEN_ISA_AVX2, and so on; "unknown" for unknown numbers. The string is static
and null-terminated. */
char const* mien_isa_name(uint32_t isa);

/* Packs the behavior of a DNA for evaluation. The rig is one block of memory, or two with
MIEN_REUSE_SUMS; temporary memory is released before the call returns. `dna` may be closed afterwards. Destroy with mien_rig_destroy().
Fails with MIEN_ERROR_DNA_LAYER if `dna` was opened without its behavior, MIEN_ERROR_DNA_VALUE if
correctives depend on each other in a cycle, MIEN_ERROR_DNA_LIMIT if the rig is too large,
MIEN_ERROR_ISA if the requested instruction set is not available.
See docs/rig-evaluation.md and docs/dna-format.md, 13 "What is checked". */
MienStatus mien_rig_create(MienDna const* dna, MienRigDesc const* desc, MienRig** out_rig, MienError* error);

/* Destroys a rig. The handle is invalid afterwards, but instances, batches and deformers of the rig may
be destroyed later: its memory is released with the last of them. */
void mien_rig_destroy(MienRig* rig);

/* Returns the properties of a rig. */
MienStatus mien_rig_info(MienRig const* rig, MienRigInfo* out_info);

/* Returns the number of parts of a kind. */
MienStatus mien_rig_count(MienRig const* rig, uint32_t kind, uint32_t* out_count);

/* Returns a name; "" for kinds without names.
Fails with MIEN_ERROR_INDEX if `index` is not below mien_rig_count(). */
MienStatus mien_rig_name(MienRig const* rig, uint32_t kind, uint32_t index, MienStringView* out_name);

/* Finds the index of a name by exact match; of equal names, the first. Takes O(log n) time.
Fails with MIEN_ERROR_NAME if there is no such name, MIEN_ERROR_INVALID_ARGUMENT if `kind` has no
names. */
MienStatus mien_rig_find(MienRig const* rig, uint32_t kind, char const* name, uint32_t* out_index);

/* Finds the index of a name by exact match; of equal names, the first. Takes O(log n) time.
Fails with MIEN_ERROR_NAME if there is no such name, MIEN_ERROR_INVALID_ARGUMENT if `kind` has no
names. */
MienStatus mien_rig_find_n(MienRig const* rig, uint32_t kind, char const* name, size_t name_count, uint32_t* out_index);

/* Returns the indices of the joints, blend shape channels, animated maps, meshes or RBF solvers that
a LOD lists, in file order.
Fails with MIEN_ERROR_LOD if the rig has no such LOD, MIEN_ERROR_INVALID_ARGUMENT if `kind` is not
one of these five.
See docs/dna-format.md, 8.2 "LOD mappings". */
MienStatus mien_rig_lod_indices(MienRig const* rig, uint32_t kind, uint32_t lod, MienIndex16View* out_indices);

/* Returns the indices of the joint values that evaluation may change at a LOD, ascending. All others
keep their initial value: 0, or 1 for the w of a quaternion.
Fails with MIEN_ERROR_LOD if the rig has no such LOD.
See docs/rig-evaluation.md, 4.10 "Which joint values a LOD may change". */
MienStatus mien_rig_variable_joint_values(MienRig const* rig, uint32_t lod, MienIndex16View* out_indices);

/* Returns the parents of the joints, one index per joint. A root is its own parent. */
MienStatus mien_rig_joint_parents(MienRig const* rig, MienIndex16View* out_parents);

/* Returns the neutral pose, relative to the parents: 9 or 10 floats per joint, in the order of the
joint values. The scale is 1.
See docs/rig-evaluation.md, 4.2 "Neutral pose". */
MienStatus mien_rig_neutral_joint_values(MienRig const* rig, MienFloatView* out_values);

/* Returns the controls whose product is corrective `psd`, as indices into the control vector.
Fails with MIEN_ERROR_INDEX if there is no such corrective.
See docs/rig-evaluation.md, 3.1 "Weights and inputs". */
MienStatus mien_rig_psd_inputs(MienRig const* rig, uint32_t psd, MienIndex16View* out_controls);

/* Returns the initial values of the raw controls, one float per raw control: 0, or 1 for the w of a
quaternion.
See docs/rig-evaluation.md, 1.2 "Initial values". */
MienStatus mien_rig_initial_raw_controls(MienRig const* rig, MienFloatView* out_values);

/* Returns the statistics of a LOD.
Fails with MIEN_ERROR_LOD if the rig has no such LOD.
See docs/rig-evaluation.md, 9.6 "Statistics". */
MienStatus mien_rig_statistics(MienRig const* rig, uint32_t lod, MienRigStatistics* out_statistics);

/* Creates an instance in its initial state: one allocation of MienRigInfo.instance_bytes. `rig` may be
destroyed before it. Destroy with mien_instance_destroy().
See docs/rig-evaluation.md, 9.2 "Instances". */
MienStatus mien_instance_create(MienRig const* rig, MienInstanceDesc const* desc, MienInstance** out_instance, MienError* error);

/* Destroys an instance. */
void mien_instance_destroy(MienInstance* instance);

/* Resets an instance to its initial state: all inputs and results, at LOD 0.
See docs/rig-evaluation.md, 1.2 "Initial values". */
MienStatus mien_instance_reset(MienInstance* instance);

/* Returns the GUI controls for the caller to write: one float per GUI control. Only
mien_rig_map_gui_to_raw() reads them.
Contents change with mien_rig_map_raw_to_gui(), mien_instance_reset(). */
MienStatus mien_instance_gui_controls(MienInstance* instance, MienMutableFloatView* out_view);

/* Returns the raw controls for the caller to write: one float per raw control, typically 0 to 1, not
clamped. They are the inputs of evaluation.
Contents change with mien_rig_map_gui_to_raw(), mien_instance_reset(). */
MienStatus mien_instance_raw_controls(MienInstance* instance, MienMutableFloatView* out_view);

/* Returns the region masks for the caller to write: one float per region of each mesh, 0 to 1,
initially 1. They switch or blend machine-learned behavior (MIEN_ML_MASKS_...).
Contents change with mien_instance_reset().
See docs/rig-evaluation.md, 8.5 "Region masks". */
MienStatus mien_instance_ml_masks(MienInstance* instance, MienMutableFloatView* out_view);

/* Returns the control vector: one float per control, the raw, PSD, ML and RBF controls in this order.
Contents change with evaluation, mien_rig_map_gui_to_raw(), mien_instance_reset() and writes to the raw
controls.
See docs/rig-evaluation.md, 1.1 "Control vector". */
MienStatus mien_instance_controls(MienInstance const* instance, MienFloatView* out_view);

/* Returns the PSD controls (correctives) of the control vector: one float per PSD control.
Contents change with evaluation, mien_instance_reset(). */
MienStatus mien_instance_psd_controls(MienInstance const* instance, MienFloatView* out_view);

/* Returns the ML controls of the control vector: one float per ML control.
Contents change with evaluation, mien_instance_reset(). */
MienStatus mien_instance_ml_controls(MienInstance const* instance, MienFloatView* out_view);

/* Returns the RBF pose controls of the control vector: one float per RBF control.
Contents change with evaluation, mien_instance_reset(). */
MienStatus mien_instance_rbf_controls(MienInstance const* instance, MienFloatView* out_view);

/* Returns the joint values: 9 or 10 floats per joint (MIEN_ROTATION_OUTPUT_...), as deltas from the
neutral pose. Translation, angles and scale are added to the neutral ones; with quaternions the
rotation is neutral * delta, so the delta rotates first.
Contents change with evaluation, mien_instance_reset().
See docs/rig-evaluation.md, 4.1 "Joint values". */
MienStatus mien_instance_joints(MienInstance const* instance, MienFloatView* out_view);

/* Returns the weights of the blend shape channels: one float per channel.
Contents change with evaluation, mien_instance_reset().
See docs/rig-evaluation.md, 5 "Blend shapes and animated maps". */
MienStatus mien_instance_blend_shapes(MienInstance const* instance, MienFloatView* out_view);

/* Returns the weights of the animated maps, 0 to 1: one float per animated map.
Contents change with evaluation, mien_instance_reset().
See docs/rig-evaluation.md, 5 "Blend shapes and animated maps". */
MienStatus mien_instance_animated_maps(MienInstance const* instance, MienFloatView* out_view);

/* Returns the statistics of an instance. Takes time proportional to the number of controls: meant for
measurements, not for every frame.
See docs/rig-evaluation.md, 9.6 "Statistics". */
MienStatus mien_instance_statistics(MienInstance const* instance, MienInstanceStatistics* out_statistics);

/* Maps GUI controls to raw controls. Raw controls that the rig's table drives are overwritten with
values clamped to 0..1; others are left unchanged. Does not allocate or lock.
Fails with MIEN_ERROR_MISMATCH if `instance` belongs to another rig.
See docs/rig-evaluation.md, 2.3 "GUI controls to raw controls". */
MienStatus mien_rig_map_gui_to_raw(MienRig const* rig, MienInstance* instance);

/* Maps raw controls to GUI controls. Sets every GUI control to the value that maps to the current raw
controls, or to 0 if there is no such value. Does not allocate or lock.
Fails with MIEN_ERROR_MISMATCH if `instance` belongs to another rig.
See docs/rig-evaluation.md, 2.4 "Raw controls to GUI controls". */
MienStatus mien_rig_map_raw_to_gui(MienRig const* rig, MienInstance* instance);

/* Evaluates all stages at a LOD. Results that the LOD does not drive have their initial value. Inputs
must be finite; then the results are finite too. Changing the LOD between calls is cheap: it resets
the results. Does not allocate or lock. Uses up to 48 KiB of stack.
Fails with MIEN_ERROR_LOD if the rig has no such LOD, MIEN_ERROR_MISMATCH if `instance` belongs to
another rig.
See docs/rig-evaluation.md, 1.3 "Order of evaluation". */
MienStatus mien_rig_evaluate(MienRig const* rig, MienInstance* instance, uint32_t lod);

/* Evaluates some stages, in the order of enum MienStage. The others keep the results of the last
evaluation at this LOD; after a change of LOD they are reset. Does not allocate or lock. Uses up to
48 KiB of stack.
Fails with MIEN_ERROR_LOD if the rig has no such LOD, MIEN_ERROR_MISMATCH if `instance` belongs to
another rig.
See docs/rig-evaluation.md, 9.3 "Partial evaluation". */
MienStatus mien_rig_evaluate_stages(MienRig const* rig, MienInstance* instance, uint32_t lod, uint32_t stages);

/* Creates a batch: one allocation of mien_batch_bytes(), which with 16-bit storage includes the weights of
networks as floats, 4 bytes each. `rig` may be destroyed before it. Destroy with
mien_batch_destroy(). */
MienStatus mien_batch_create(MienRig const* rig, MienBatchDesc const* desc, MienBatch** out_batch, MienError* error);

/* Destroys a batch. */
void mien_batch_destroy(MienBatch* batch);

/* Returns the memory that a batch would take. */
MienStatus mien_batch_bytes(MienRig const* rig, MienBatchDesc const* desc, uint64_t* out_bytes);

/* Evaluates stages of `count` different instances of one rig; instance i at LOD lods[i]. The results
are bit-identical to those of mien_rig_evaluate_stages() (joint values with MIEN_REUSE_SUMS: within the
bound of a full evaluation), but columns of the joint matrix that several
instances use are read only once for up to 32 of them. Runs on the calling thread, or in tasks
on `parallel`; `parallel` may be NULL. Does not allocate or lock. Uses up to 48 KiB of stack per
task. On failure no instance is evaluated.
Fails with MIEN_ERROR_LOD if the rig has no such LOD, MIEN_ERROR_MISMATCH if the batch or an
instance belongs to another rig, MIEN_ERROR_INVALID_ARGUMENT if `count` exceeds
MienBatchDesc.capacity or an instance is listed twice.
See docs/numbers.md, 10 "One by one, in batches, with reused results". */
MienStatus mien_rig_evaluate_batch(MienRig const* rig, MienBatch* batch, MienInstance* const* instances, uint32_t const* lods, uint32_t count, uint32_t stages, MienParallelFor const* parallel);

/* Evaluates the joint values of one joint group (MIEN_KIND_JOINT_GROUP), except those that a later
group overrides at all LODs where this one sets them. Does not allocate or lock. Uses up to 48 KiB
of stack.
Fails with MIEN_ERROR_INDEX if there is no such joint group, MIEN_ERROR_LOD if the rig has no such
LOD, MIEN_ERROR_MISMATCH if `instance` belongs to another rig.
See docs/rig-evaluation.md, 4.5 "Order of the joint stage". */
MienStatus mien_rig_evaluate_joint_group(MienRig const* rig, MienInstance* instance, uint32_t lod, uint32_t group);

/* Evaluates the pose controls of one RBF solver (MIEN_KIND_RBF_SOLVER), even if the LOD does not list
it. Does not allocate or lock.
Fails with MIEN_ERROR_INDEX if there is no such solver, MIEN_ERROR_LOD if the rig has no such LOD,
MIEN_ERROR_MISMATCH if `instance` belongs to another rig.
See docs/rig-evaluation.md, 6 "RBF solvers". */
MienStatus mien_rig_evaluate_rbf_solver(MienRig const* rig, MienInstance* instance, uint32_t lod, uint32_t solver);

/* Evaluates the joints of one twist and swing setup (MIEN_KIND_TWIST_SWING). Does not allocate or
lock.
Fails with MIEN_ERROR_INDEX if there is no such setup, MIEN_ERROR_LOD if the rig has no such LOD,
MIEN_ERROR_MISMATCH if `instance` belongs to another rig.
See docs/rig-evaluation.md, 7 "Twist and swing". */
MienStatus mien_rig_evaluate_twist_swing(MienRig const* rig, MienInstance* instance, uint32_t lod, uint32_t setup);

/* Packs the geometry of a DNA for deformation. `dna` is the one that the rig was created from, or the
same file opened with the same LODs. `dna` may be closed and `rig` may be destroyed afterwards. The
deformer is one block of memory; temporary memory is released before the call returns. Destroy with
mien_deformer_destroy().

Influences of weight 0 and faces of fewer than three corners are dropped. Meshes may lack faces,
weights, normals or texture coordinates: missing normals are computed from the faces, missing
texture coordinates are 0. Stored normals determine which side of a face is outside; without
them, the winding and the axes of the file do.

Fails with MIEN_ERROR_DNA_LAYER if `dna` was opened without MIEN_LAYER_GEOMETRY, MIEN_ERROR_MISMATCH
if the number or the names of joints, channels or meshes differ from those of the rig,
MIEN_ERROR_DNA_VALUE if a joint is its own ancestor or a position, delta or weight is not finite,
MIEN_ERROR_DNA_LIMIT if a position has more than 65535 influences, MIEN_ERROR_ISA if the requested
instruction set is not available, MIEN_ERROR_INVALID_ARGUMENT if `delta_error` is negative or not finite.
See docs/deformation.md. */
MienStatus mien_deformer_create(MienDna const* dna, MienRig const* rig, MienDeformerDesc const* desc, MienDeformer** out_deformer, MienError* error);

/* Creates a deformer of some positions of one mesh. Position i of that mesh is `positions[i]` of the mesh of
`deformer`; it has no vertices or triangles, and all other meshes are empty. Deformed positions have the bits of
the whole mesh (with 16-bit storage they may be rounded otherwise), derivatives those of the chosen rows, and both
take time for the chosen positions only. `positions` are ascending, `position_count` of them. `deformer` may be
destroyed afterwards; the new one keeps its memory. Destroy with mien_deformer_destroy().
Fails with MIEN_ERROR_INDEX if there is no such mesh or position, MIEN_ERROR_INVALID_ARGUMENT if positions are not
ascending. */
MienStatus mien_deformer_create_subset(MienDeformer const* deformer, uint32_t mesh, uint32_t const* positions, size_t position_count, MienAllocator const* allocator, MienDeformer** out_deformer, MienError* error);

/* Destroys a deformer. Its instances stay valid; its memory is released with the last of them. */
void mien_deformer_destroy(MienDeformer* deformer);

/* Returns the properties of a deformer. */
MienStatus mien_deformer_info(MienDeformer const* deformer, MienDeformerInfo* out_info);

/* Returns a neutral mesh.
Fails with MIEN_ERROR_INDEX if there is no such mesh. */
MienStatus mien_deformer_mesh(MienDeformer const* deformer, uint32_t mesh, MienMesh* out_mesh);

/* Writes the triangles of a mesh to `out_triangles`: 3 indices per triangle, as in MienMesh.triangles, with any
storage. `count` is the capacity of `out_triangles`, in indices. With 16-bit storage takes memory for the
duration of the call, 4 bytes per position, from the allocator of the deformer.
Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_INVALID_ARGUMENT if `count` is less than
3 * MienMesh.triangle_count, MIEN_ERROR_MEMORY if memory ran out. */
MienStatus mien_deformer_triangles(MienDeformer const* deformer, uint32_t mesh, uint32_t* out_triangles, size_t count);

/* Writes the texture coordinates of a mesh to `out_coordinates`: 2 floats per vertex, u v, with any storage. With
16-bit storage they are off by at most 1/131070 of the range of the mesh. `count` is the capacity of
`out_coordinates`, in floats.
Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_INVALID_ARGUMENT if `count` is less than
2 * MienMesh.vertex_count. */
MienStatus mien_deformer_texture_coordinates(MienDeformer const* deformer, uint32_t mesh, float* out_coordinates, size_t count);

/* Returns the influences of a position, as used for skinning: `out_joints` gets one index per influence,
`out_weights` gets one float per influence. There may be none.
Fails with MIEN_ERROR_INDEX if there is no such mesh or position, MIEN_ERROR_UNSUPPORTED if the weights
are stored with 16 bits (MienDeformerDesc.storage). */
MienStatus mien_deformer_influences(MienDeformer const* deformer, uint32_t mesh, uint32_t position, MienIndex16View* out_joints, MienFloatView* out_weights);

/* Writes a blend shape target to `out_deltas`: 3 floats per position, the offset at channel weight 1.
Positions that the target does not move get 0. `count` is the capacity of `out_deltas`, in floats.
Fails with MIEN_ERROR_INDEX if there is no such mesh or target, MIEN_ERROR_INVALID_ARGUMENT if
`count` is less than 3 * MienMesh.position_count. */
MienStatus mien_deformer_target(MienDeformer const* deformer, uint32_t mesh, uint32_t target, float* out_deltas, size_t count);

/* Returns the model matrices of the neutral pose: 16 floats per joint, column by column, for column
vectors. The last column is the translation, the last row 0 0 0 1. */
MienStatus mien_deformer_bind_matrices(MienDeformer const* deformer, MienFloatView* out_matrices);

/* Returns the inverses of the bind matrices: 16 floats per joint, column by column. */
MienStatus mien_deformer_inverse_bind_matrices(MienDeformer const* deformer, MienFloatView* out_matrices);

/* Creates a deformer instance in the neutral pose: one allocation. `deformer` may be destroyed before
it. Destroy with mien_deformer_instance_destroy(). */
MienStatus mien_deformer_instance_create(MienDeformer const* deformer, MienDeformerInstanceDesc const* desc, MienDeformerInstance** out_deformer_instance, MienError* error);

/* Destroys a deformer instance. */
void mien_deformer_instance_destroy(MienDeformerInstance* deformer_instance);

/* Copies the joint values and channel weights of the last evaluation of `instance`, and computes the
matrices of all joints. mien_deformer_instance_deform() then deforms meshes. Values that are
not finite give results that are not finite. Does not allocate or lock.
Fails with MIEN_ERROR_MISMATCH if `instance` belongs to a rig other than that of the deformer.
See docs/deformation.md, 1 "Joint transforms". */
MienStatus mien_deformer_instance_update(MienDeformerInstance* deformer_instance, MienInstance const* instance);

/* Does the same with arrays: `joint_values` like those of mien_instance_joints(), `channel_weights`
one per channel. `joint_values` may be NULL with count 0: no deltas. `channel_weights` may be NULL
with count 0: all weights are 0. Does not allocate or lock.
Fails with MIEN_ERROR_INVALID_ARGUMENT if a count is not that of the rig. */
MienStatus mien_deformer_instance_update_from_values(MienDeformerInstance* deformer_instance, float const* joint_values, size_t joint_value_count, float const* channel_weights, size_t channel_weight_count);

/* Returns the model matrices: 16 floats per joint, in the layout of mien_deformer_bind_matrices().
Contents change with mien_deformer_instance_update(), mien_deformer_instance_update_from_values(). */
MienStatus mien_deformer_instance_joint_matrices(MienDeformerInstance const* deformer_instance, MienFloatView* out_matrices);

/* Returns the skin matrices, for skinning by the caller, for example on a GPU: 16 floats per joint, in
the layout of mien_deformer_bind_matrices().
Contents change with mien_deformer_instance_update(), mien_deformer_instance_update_from_values(). */
MienStatus mien_deformer_instance_skin_matrices(MienDeformerInstance const* deformer_instance, MienFloatView* out_matrices);

/* Writes the joint transforms of the last update, relative to the parents, to `out_transforms`: 10
floats per joint, tx ty tz qx qy qz qw sx sy sz, with quaternions of unit length. `count` is the
capacity of `out_transforms`, in floats. Does not allocate or lock.
Fails with MIEN_ERROR_INVALID_ARGUMENT if `count` is less than 10 * MienDeformerInfo.joint_count. */
MienStatus mien_deformer_instance_local_transforms(MienDeformerInstance const* deformer_instance, float* out_transforms, size_t count);

/* Computes the positions and normals of a mesh for the last update. Runs on the calling thread; meshes
of at least 16384 positions run in tasks of about 1024 on `parallel`. `parallel` may be NULL. The
results have the same bits either way. Does not allocate or lock. Uses up to 16 KiB of stack per
task.
Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_LOD if `deformer_instance` has no
memory for it (MienDeformerInstanceDesc.lods).
See docs/deformation.md, 2 "Positions" and 3 "Normals". */
MienStatus mien_deformer_instance_deform(MienDeformerInstance* deformer_instance, uint32_t mesh, uint32_t normals, MienParallelFor const* parallel);

/* Deforms the same mesh of `count` different instances of one deformer. The results are bit-identical to
those of mien_deformer_instance_deform(), but each part of the mesh is read only once for all of them,
and the total number of positions decides whether tasks are used. `parallel` may be NULL. Does not
allocate or lock. Uses up to 16 KiB of stack per task. On failure nothing is deformed.
Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_LOD if an instance has no memory for
it, MIEN_ERROR_MISMATCH if the instances have different deformers, MIEN_ERROR_INVALID_ARGUMENT if
an instance is listed twice. */
MienStatus mien_deformer_instance_deform_batch(MienDeformerInstance* const* deformer_instances, size_t count, uint32_t mesh, uint32_t normals, MienParallelFor const* parallel);

/* Returns the deformed positions of a mesh: 3 floats per position, x y z.
Contents change with mien_deformer_instance_deform(), mien_deformer_instance_write_vertices() and
their batches.
Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_LOD if `deformer_instance` has no
memory for it. */
MienStatus mien_deformer_instance_positions(MienDeformerInstance const* deformer_instance, uint32_t mesh, MienFloatView* out_positions);

/* Returns the deformed normals of a mesh: 3 floats per vertex, x y z, unit length.
Contents change with mien_deformer_instance_deform(), mien_deformer_instance_write_vertices() and
their batches.
Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_LOD if `deformer_instance` has no
memory for it. */
MienStatus mien_deformer_instance_normals(MienDeformerInstance const* deformer_instance, uint32_t mesh, MienFloatView* out_normals);

/* Deforms a mesh as mien_deformer_instance_deform() does, and writes its vertices to memory of the
caller, such as a mapped vertex buffer. Each byte is written once, in the order of the vertices, and
none is read, so the memory may be write-combined. Bytes between vertices are left unchanged. `parallel`
may be NULL; the bytes are the same either way. The same positions, normals and tangents give the
same bytes on every instruction set. Does not allocate or lock. Uses up to 16 KiB of stack per task.
On failure nothing is deformed or written.
Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_LOD if `deformer_instance` has no
memory for it, MIEN_ERROR_INVALID_ARGUMENT if a stream has a format that its attribute cannot have,
a wrong stride or alignment or too little capacity, if streams overlap, if there is no stream, or if
tangents are requested from a deformer without them.
See docs/deformation.md, 5 "Vertex output". */
MienStatus mien_deformer_instance_write_vertices(MienDeformerInstance* deformer_instance, uint32_t mesh, uint32_t normals, MienVertexOutput const* output, MienParallelFor const* parallel);

/* Does the same for one mesh of `count` different instances of one deformer: instance i is written to
outputs[i]. All outputs have the same struct_size, and must not share bytes. `parallel` may be NULL.
Does not allocate or lock. Uses up to 16 KiB of stack per task.
Fails like mien_deformer_instance_write_vertices(), and with MIEN_ERROR_MISMATCH if the instances have
different deformers, MIEN_ERROR_INVALID_ARGUMENT if an instance is listed twice. */
MienStatus mien_deformer_instance_write_vertices_batch(MienDeformerInstance* const* deformer_instances, size_t count, uint32_t mesh, uint32_t normals, MienVertexOutput const* outputs, MienParallelFor const* parallel);

/* Creates derivatives. `desc` may be NULL. `rig` may be destroyed afterwards, and so may the deformer.
Takes one block of memory, which holds a copy of the weights of networks, room for 32 directions, and 8
bytes for each 8 numbers of the joint matrix.
Destroy with mien_derivatives_destroy().
Fails with MIEN_ERROR_MISMATCH if the deformer is not of the rig. */
MienStatus mien_derivatives_create(MienRig const* rig, MienDerivativesDesc const* desc, MienDerivatives** out_derivatives, MienError* error);

/* Destroys derivatives. NULL is allowed. */
void mien_derivatives_destroy(MienDerivatives* derivatives);

/* Returns the number of bytes that mien_derivatives_create() would allocate.
Fails with MIEN_ERROR_MISMATCH if the deformer is not of the rig. */
MienStatus mien_derivatives_bytes(MienRig const* rig, MienDerivativesDesc const* desc, uint64_t* out_bytes);

/* Returns how many numbers a point has. `mesh` is the index of the mesh of MIEN_POINT_POSITIONS, else 0.
Fails with MIEN_ERROR_INDEX if there is no such mesh, or the point needs a deformer and there is none. */
MienStatus mien_derivatives_size(MienDerivatives const* derivatives, uint32_t point, uint32_t mesh, size_t* out_size);

/* Computes the derivatives at the values of `instance`, which must belong to the rig and have been
evaluated, alone or in a batch, at the LOD of that evaluation. `stages` selects the stages to differentiate, MIEN_STAGE_ALL or
some of them: the results of the others count as constants. Does not allocate or lock.
Where a function has no derivative, a one-sided one is used, so that solvers do not get stuck:
  - controls at 0 or 1, for correctives, GUI controls and maps: into the interval
  - where two intervals of a conditional table meet: that of the steeper one
  - RBF poses with a weight below the threshold: as without a threshold; at a stored pose: 0
  - ReLU at 0: as above 0
Saturation is ignored: values that overflow have the derivatives of the formula. Controls that a network
or solver reads before they are computed count as constants.
Fails with MIEN_ERROR_MISMATCH if the instance is not of the rig. */
MienStatus mien_derivatives_linearize(MienDerivatives* derivatives, MienInstance const* instance, uint32_t stages);

/* Multiplies directions by the matrix of derivatives (Jacobian-vector products). Each of the `count`
directions is a row of mien_derivatives_size() numbers at `from`; its output is the resulting change of
the numbers at `to`. Rows follow each other without gaps; `outputs` has `count` rows and must not overlap
`directions`. Several directions in one call are faster than one by one, and give the same bits. Does not
allocate or lock.
Fails with MIEN_ERROR_INDEX if a point lacks its deformer or mesh, MIEN_ERROR_INVALID_ARGUMENT if `from`
has no effect on `to` or nothing was linearized. */
MienStatus mien_derivatives_forward(MienDerivatives* derivatives, uint32_t from, uint32_t to, uint32_t mesh, uint32_t count, float const* directions, float* outputs);

/* Multiplies gradients by the transposed matrix (vector-Jacobian products): turns each of `count` gradients
with respect to the numbers at `to` into the gradient with respect to those at `from`. All else is as in
mien_derivatives_forward().
Fails with MIEN_ERROR_INDEX if a point lacks its deformer or mesh, MIEN_ERROR_INVALID_ARGUMENT if `from`
has no effect on `to` or nothing was linearized. */
MienStatus mien_derivatives_reverse(MienDerivatives* derivatives, uint32_t from, uint32_t to, uint32_t mesh, uint32_t count, float const* gradients, float* outputs);

/* Creates a matrix for derivatives that have the rig and the deformer of `derivatives`, linearized or not.
`derivatives` may be destroyed afterwards. The matrix takes one block of memory: 8 bytes per entry, 4 per
row, 20 per column. More is needed until the call returns: 4 bytes per row, 12 per column, and 8 for each
number on the way (controls, joint values, matrices, results of networks, positions of the mesh).
Destroy with mien_jacobian_destroy().
Fails with MIEN_ERROR_INVALID_ARGUMENT if from_point has no effect on to_point or the outputs do not
ascend, MIEN_ERROR_INDEX if a point lacks its deformer or mesh, or an input or output does not exist,
MIEN_ERROR_LOD if the rig has no such LOD. */
MienStatus mien_jacobian_create(MienDerivatives const* derivatives, MienJacobianDesc const* desc, MienJacobian** out_jacobian, MienError* error);

/* Destroys a matrix. NULL is allowed. */
void mien_jacobian_destroy(MienJacobian* jacobian);

/* Returns the entries. They are the same in all poses, so a solver can order and factor the matrix
symbolically once. The views are valid until the matrix is destroyed. */
MienStatus mien_jacobian_pattern(MienJacobian const* jacobian, MienJacobianPattern* out_pattern);

/* Computes the entries of a matrix at the values that were linearized: `values` gets a float per entry of
the pattern, of which some may be 0. Each is equal to what mien_derivatives_forward() computes for a
direction that is 1 at the number of its column, else 0. `wanted` may be NULL: all columns; otherwise it
has a byte per column, and entries of columns with a 0 are not computed and keep their values. Threads may
use one matrix at the same time, each with derivatives of its own. Does not allocate or lock.
Fails with MIEN_ERROR_MISMATCH if the matrix was created for another rig or deformer, or the values were
linearized at another LOD, MIEN_ERROR_INVALID_ARGUMENT if nothing was linearized, `value_count` is not
the number of entries, or `wanted_count` not that of columns (0 if `wanted` is NULL). */
MienStatus mien_derivatives_jacobian(MienDerivatives* derivatives, MienJacobian const* jacobian, uint8_t const* wanted, size_t wanted_count, float* values, size_t value_count);

/* Writes a rig and its deformer to a baked file. `deformer` may be NULL. The file is written under a
temporary name and renamed, so that a failure leaves `path` unchanged.
Fails with MIEN_ERROR_MISMATCH if `deformer` was created for another rig, MIEN_ERROR_FILE_WRITE if
the file cannot be written, MIEN_ERROR_MEMORY if the allocator of the rig returns NULL. */
MienStatus mien_bake_file(MienRig const* rig, MienDeformer const* deformer, char const* path, MienError* error);

/* Writes a baked file to memory and returns its size in `out_size`. `deformer` may be NULL. `buffer`
may be NULL with capacity 0 to get the size only. Writes nothing if `capacity` is too small;
`out_size` is set nevertheless.
Fails with MIEN_ERROR_MISMATCH if `deformer` was created for another rig,
MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small. */
MienStatus mien_bake_memory(MienRig const* rig, MienDeformer const* deformer, void* buffer, size_t capacity, size_t* out_size, MienError* error);

/* Opens a baked file. By default it is mapped, so processes that open the same file share its pages. Do not
truncate or overwrite a mapped file until all objects made from it are destroyed; replacing it by
renaming is safe. The header is checked now, the rest when objects are created. One allocation, and
one more for the bytes if the file is not mapped. Close with mien_baked_close().
Fails with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ if the file cannot be read,
MIEN_ERROR_BAKED_SIGNATURE, MIEN_ERROR_BAKED_VERSION, MIEN_ERROR_BAKED_TRUNCATED or
MIEN_ERROR_BAKED_STRUCTURE if its header is not valid, MIEN_ERROR_BAKED_CHECKSUM if
MIEN_BAKED_CHECK_FULL finds changed bytes. */
MienStatus mien_baked_open_file(char const* path, MienBakedDesc const* desc, MienBaked** out_baked, MienError* error);

/* Opens a baked file in memory: `size` bytes. `bytes` must outlive the MienBaked and all objects made
from it, unchanged, unless they are copied: with MIEN_FILE_READ, or if `bytes` is not aligned to
64.
Fails like mien_baked_open_file(), but not with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ. */
MienStatus mien_baked_open_memory(void const* bytes, size_t size, MienBakedDesc const* desc, MienBaked** out_baked, MienError* error);

/* Opens a baked file through a stream, which is read at once into memory of the allocator.
Fails like mien_baked_open_file(), but not with MIEN_ERROR_FILE_OPEN. */
MienStatus mien_baked_open_stream(MienStream const* stream, MienBakedDesc const* desc, MienBaked** out_baked, MienError* error);

/* Closes a baked file. Objects made from it stay valid; its memory is released and the file unmapped
with the last of them. */
void mien_baked_close(MienBaked* baked);

/* Returns the properties of an open baked file. */
MienStatus mien_baked_info(MienBaked const* baked, MienBakedInfo* out_info);

/* Creates the rig of a baked file, with one allocation, or two with MIEN_REUSE_SUMS. `baked` may be closed afterwards. Destroy with
mien_rig_destroy().
Fails with MIEN_ERROR_BAKED_PART if the file has no rig, MIEN_ERROR_BAKED_VERSION or
MIEN_ERROR_BAKED_STRUCTURE if its rig cannot be used, MIEN_ERROR_ISA if the requested instruction set
is not available. */
MienStatus mien_rig_from_baked(MienBaked const* baked, MienBakedRigDesc const* desc, MienRig** out_rig, MienError* error);

/* Creates the deformer of a baked file, with one allocation. `rig` is the one created from the same
MienBaked. `baked` may be closed and `rig` may be destroyed afterwards. Destroy with
mien_deformer_destroy().
Fails with MIEN_ERROR_MISMATCH if `rig` was not created from `baked`, MIEN_ERROR_BAKED_PART if the
file has no deformer, MIEN_ERROR_BAKED_VERSION or MIEN_ERROR_BAKED_STRUCTURE if its deformer cannot be
used, MIEN_ERROR_ISA if the requested instruction set is not available. */
MienStatus mien_deformer_from_baked(MienBaked const* baked, MienRig const* rig, MienBakedDeformerDesc const* desc, MienDeformer** out_deformer, MienError* error);

/* Builds a clip in memory. `desc` is required. The same values give the same bytes on every machine.
Close with mien_clip_close().
Fails with MIEN_ERROR_CLIP_VALUE if a value is not finite (the message names frame and channel),
MIEN_ERROR_NAME if a name is empty or occurs twice, MIEN_ERROR_CLIP_LIMIT if there are too many
frames, channels or bytes. */
MienStatus mien_clip_build(MienClipDesc const* desc, MienClip** out_clip, MienError* error);

/* Opens a clip. By default it is mapped: do not truncate or overwrite the file until the clip is closed
and its players are destroyed; replacing it by renaming is safe. Names and events are checked now,
curves when they are decoded: damaged ones decode to zeros (see mien_clip_verify()). Close with
mien_clip_close().
Fails with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ if the file cannot be read,
MIEN_ERROR_CLIP_SIGNATURE, MIEN_ERROR_CLIP_VERSION, MIEN_ERROR_CLIP_TRUNCATED or
MIEN_ERROR_CLIP_STRUCTURE if it is not a valid clip. */
MienStatus mien_clip_open_file(char const* path, MienClipOpenDesc const* desc, MienClip** out_clip, MienError* error);

/* Opens a clip in memory, at any alignment. `bytes` must outlive the clip and its players, unchanged.
Fails like mien_clip_open_file(), but not with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ. */
MienStatus mien_clip_open_memory(void const* bytes, size_t size, MienClipOpenDesc const* desc, MienClip** out_clip, MienError* error);

/* Opens a clip through a stream, which is read completely into memory of the allocator.
Fails like mien_clip_open_file(), but not with MIEN_ERROR_FILE_OPEN. */
MienStatus mien_clip_open_stream(MienStream const* stream, MienClipOpenDesc const* desc, MienClip** out_clip, MienError* error);

/* Closes a clip. Players stay valid; memory is released and the file unmapped with the last of them. */
void mien_clip_close(MienClip* clip);

/* Writes a clip to a file. The file is written under a temporary name and renamed, so that a failure
leaves `path` unchanged.
Fails with MIEN_ERROR_FILE_WRITE if the file cannot be written, MIEN_ERROR_MEMORY if the allocator of
the clip returns NULL. */
MienStatus mien_clip_write_file(MienClip const* clip, char const* path, MienError* error);

/* Writes a clip to memory and returns its size in `out_size`. `buffer` may be NULL with capacity 0 to
get the size only. Writes nothing if `capacity` is too small; `out_size` is set nevertheless.
Fails with MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small. */
MienStatus mien_clip_write_memory(MienClip const* clip, void* buffer, size_t capacity, size_t* out_size, MienError* error);

/* Returns the properties of a clip. */
MienStatus mien_clip_info(MienClip const* clip, MienClipInfo* out_info);

/* Returns a channel. Channels keep the order in which the clip was built. The name is a view into the
clip.
Fails with MIEN_ERROR_INDEX if `index` is out of range. */
MienStatus mien_clip_channel(MienClip const* clip, uint32_t index, MienClipChannel* out_channel);

/* Returns the index of the channel with this name. Searches all channels.
Fails with MIEN_ERROR_NAME if there is none. */
MienStatus mien_clip_find_channel(MienClip const* clip, char const* name, uint32_t* out_index);

/* Returns the index of the channel with this name. Searches all channels.
Fails with MIEN_ERROR_NAME if there is none. */
MienStatus mien_clip_find_channel_n(MienClip const* clip, char const* name, size_t name_count, uint32_t* out_index);

/* Returns an event. Events are sorted by tick; those at the same tick keep the order in which they were
given. The name is a view into the clip.
Fails with MIEN_ERROR_INDEX if `index` is out of range. */
MienStatus mien_clip_event(MienClip const* clip, uint32_t index, MienClipEvent* out_event);

/* Checks that no byte of a clip has changed since it was written and that all curves can be decoded.
Reads the whole clip. Uses up to 48 KiB of stack.
Fails with MIEN_ERROR_CLIP_CHECKSUM if bytes have changed, MIEN_ERROR_CLIP_STRUCTURE if a curve cannot
be decoded. */
MienStatus mien_clip_verify(MienClip const* clip, MienError* error);

/* Copies `frame_count` frames, starting at `first_frame`: channel c of frame first_frame + n goes to
out_values[n * frame_stride + c]. frame_stride is at least the number of channels; 0 means that
number. Each call decodes from the start of a block of 64 frames, so reading many frames in one
call costs less than reading them one by one. Uses up to 48 KiB of stack.
Fails with MIEN_ERROR_INVALID_ARGUMENT if frame_stride is too small, MIEN_ERROR_INDEX if the
clip has fewer frames, MIEN_ERROR_CLIP_STRUCTURE if a curve is damaged; its block in `out_values` is
zero. */
MienStatus mien_clip_read(MienClip const* clip, uint32_t first_frame, uint32_t frame_count, float* out_values, size_t frame_stride, MienError* error);

/* Creates a player, with one allocation. `clip` may be closed before the player is destroyed. Destroy with
mien_clip_player_destroy(). */
MienStatus mien_clip_player_create(MienClip const* clip, MienClipPlayerDesc const* desc, MienClipPlayer** out_clip_player, MienError* error);

/* Destroys a player. */
void mien_clip_player_destroy(MienClipPlayer* clip_player);

/* Returns the state of a player. */
MienStatus mien_clip_player_info(MienClipPlayer const* clip_player, MienClipPlayerInfo* out_info);

/* Moves to a tick: modulo the length with MIEN_LOOPING_WRAP, otherwise clamped to the range. Reports no
events; the next mien_clip_player_advance() also reports events at this tick, as it does after
creation. Does not allocate or lock. */
MienStatus mien_clip_player_seek(MienClipPlayer* clip_player, int64_t tick);

/* Sets the speed for later calls of mien_clip_player_advance(). Does not allocate or lock.
Fails with MIEN_ERROR_INVALID_ARGUMENT if it is outside the range of MienClipPlayerDesc. */
MienStatus mien_clip_player_set_speed(MienClipPlayer* clip_player, int32_t numerator, int32_t denominator);

/* Moves by `ticks` times the speed. `ticks` is -2^40 to 2^40 (26 minutes). Fractions of ticks are kept,
so the position does not depend on the step size. Does not allocate or lock.
Fails with MIEN_ERROR_INVALID_ARGUMENT if `ticks` is out of range. */
MienStatus mien_clip_player_advance(MienClipPlayer* clip_player, int64_t ticks);

/* Returns the next event that the last mien_clip_player_advance() passed. `out_found` is 1, or 0 after
the last event. An event is passed when the position reaches or crosses its tick in either
direction, once per loop. The name is a view into the clip. Does not allocate or lock. */
MienStatus mien_clip_player_next_event(MienClipPlayer* clip_player, MienClipEvent* out_event, uint32_t* out_found);

/* Returns the values at the current position: one float per channel. Exactly at a frame they are
bit-identical to those of the clip. Decodes the frames since the last call, or at most 64 after a jump;
without MienClipPlayerDesc.reverse, each step backward is a jump. Does not allocate or lock.
Contents change with mien_clip_player_sample(). */
MienStatus mien_clip_player_sample(MienClipPlayer* clip_player, MienFloatView* out_values);

/* Binds a clip to a rig by names. A channel drives the raw control with its name. If there is none, it
drives the GUI control with its name, which is then mapped as by mien_rig_map_gui_to_raw(). If there is
none either, it drives the controls of its entries in the matrix, which are summed in the order of the
matrix. Names match without regard to case; `.` matches `_`; the prefix `CTRL_expressions.` may be
missing. If several names match, only an exact match counts. A channel that drives nothing so far drives
the controls that mien_rig_match() finds for its name, such as mouthSmile_L for mouthSmileLeft; these are
summed after those of the matrix. A raw control that a channel drives by name is driven by nothing else,
and one that the matrix or mien_rig_match() drives is not driven by GUI controls. Names without a match
are not an error: see mien_clip_binding_info(). `clip` may be closed and `rig` may be destroyed
afterwards. Destroy with mien_clip_binding_destroy().
Fails with MIEN_ERROR_INVALID_ARGUMENT if a weight is not finite, MIEN_ERROR_CLIP_LIMIT if channels
drive more than 4095 GUI controls. */
MienStatus mien_clip_binding_create(MienClip const* clip, MienRig const* rig, MienClipBindingDesc const* desc, MienClipBinding** out_clip_binding, MienError* error);

/* Returns a matrix that binds clips with the 52 ARKit expression names, such as those of the Live Link
Face app, to rigs with the other common naming of raw controls (eyeBlinkL for eyeBlinkLeft). It suits
every rig: channels whose names the rig has do not use the matrix, and entries for missing controls are
skipped. docs/face-capture.md, 3 "ARKit expressions on raw controls" explains the entries. Writes as
many entries as fit; `out_count` is the total number. Names are static. `out_entries` may be NULL if
`capacity` is 0. */
MienStatus mien_arkit_matrix(MienMatrixEntry* out_entries, size_t capacity, size_t* out_count);

/* Destroys a binding. */
void mien_clip_binding_destroy(MienClipBinding* clip_binding);

/* Returns what a binding found. */
MienStatus mien_clip_binding_info(MienClipBinding const* clip_binding, MienClipBindingInfo* out_info);

/* Computes the raw controls that are driven and leaves the others unchanged. `values` has one float
per channel, as mien_clip_player_sample() returns them; `raw_controls` has one float per raw control,
as mien_instance_raw_controls() returns them. Values that drive raw controls by name are
copied exactly; GUI controls give the same bits as mien_rig_map_gui_to_raw(). Does not allocate or
lock. Uses up to 16 KiB of stack.
Fails with MIEN_ERROR_INVALID_ARGUMENT if a count differs from that of the clip or the rig. */
MienStatus mien_clip_binding_apply(MienClipBinding const* clip_binding, float const* values, size_t value_count, float* raw_controls, size_t raw_control_count);

/* Finds for each channel of a clip the coarsest rounding step with no visible effect, for
MienClipDesc.snaps: the largest of 2^-9 to 2^-16 of which half moves no vertex of LOD 0 by more than
`tolerance`, in millimeters, such as 0.02. If LOD 0 has no meshes, joints are measured instead. Each
channel is tried at five values from 0 to 1, and from -1 on if GUI controls are driven, with all other
channels at 0. Channels that drive nothing get 2^-11; channels for which even the finest step is too
coarse get 0. To use the steps, build a clip with all bits, bind it, then build it again with them.
Evaluates and deforms the rig at least 10 times per channel, and takes memory from its allocator during
the call.
Fails with MIEN_ERROR_MEMORY if that returns NULL, MIEN_ERROR_MISMATCH if `channel_count` is not that of
the binding, or the binding is for another rig, MIEN_ERROR_INVALID_ARGUMENT if `tolerance` is not a
number above 0. */
MienStatus mien_clip_binding_snaps(MienClipBinding const* clip_binding, MienDeformer const* deformer, float tolerance, float* out_snaps, size_t channel_count, MienError* error);

/* Creates a mix for a rig. `desc` is required. `rig` may be destroyed afterwards, and so may the
deformer. Measuring guards takes time: it evaluates and deforms the rig at LOD 0 for each raw control
and for pairs of raw controls that share a corrective. Destroy with mien_mix_destroy().
Fails with MIEN_ERROR_MISMATCH if the deformer or the gaze is for another rig, MIEN_ERROR_INDEX if a
landmark names a mesh, position or joint that does not exist, MIEN_ERROR_INVALID_ARGUMENT if a field
of `desc` is out of range; the message names it, MIEN_ERROR_DNA_LIMIT if guards are measured and raw
controls times joints exceed 2^22. */
MienStatus mien_mix_create(MienRig const* rig, MienMixDesc const* desc, MienMix** out_mix, MienError* error);

/* Opens a mix for a rig, which must have all controls that the mix uses; names match as in
mien_clip_binding_create(). For other controls of the rig, the masks of the file are 0 and there are no
limits. Guards and gaze are those measured when the mix was created. `rig` may be NULL: then the raw
controls are those of the file, to inspect it or to write it again. `rig` may be destroyed afterwards.
A hostile file may make mixers large: check MienMixInfo.mixer_bytes. Destroy with mien_mix_destroy().
Fails with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ if the file cannot be read,
MIEN_ERROR_MIX_SIGNATURE, MIEN_ERROR_MIX_VERSION, MIEN_ERROR_MIX_TRUNCATED, MIEN_ERROR_MIX_CHECKSUM or
MIEN_ERROR_MIX_STRUCTURE if it is not a valid mix, MIEN_ERROR_NAME if the rig lacks controls; the
message names them. */
MienStatus mien_mix_open_file(char const* path, MienRig const* rig, MienMixOpenDesc const* desc, MienMix** out_mix, MienError* error);

/* Opens a mix in memory. `bytes` may be released afterwards. `rig` may be NULL. `rig` may be destroyed
afterwards.
Fails like mien_mix_open_file(), but not with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ. */
MienStatus mien_mix_open_memory(void const* bytes, size_t size, MienRig const* rig, MienMixOpenDesc const* desc, MienMix** out_mix, MienError* error);

/* Writes a mix to a file: the arguments of mien_mix_create(), what it measured, and the names of the
controls that the mix uses. Equal mixes give the same bytes on every machine; a mix that was opened is
written with the bytes of its file. The file is written under a temporary name and renamed, so that a
failure leaves `path` unchanged. Takes memory from the allocator of the mix during the call.
Fails with MIEN_ERROR_MEMORY if that returns NULL, MIEN_ERROR_NAME if two of these controls have the
same name, MIEN_ERROR_FILE_WRITE if the file cannot be written. */
MienStatus mien_mix_write_file(MienMix const* mix, char const* path, MienError* error);

/* Writes a mix to memory and returns its size in `out_size`. `buffer` may be NULL with capacity 0 to get
the size only. Writes nothing if `capacity` is too small; `out_size` is set nevertheless.
Fails with MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small, MIEN_ERROR_MEMORY and MIEN_ERROR_NAME
if mien_mix_write_file() would fail with them. */
MienStatus mien_mix_write_memory(MienMix const* mix, void* buffer, size_t capacity, size_t* out_size, MienError* error);

/* Writes a mix as text, for reading and for version control: one line for each number, with its path in
the mix and the names of controls. Floats have nine digits, enough to restore their bits. The text
cannot be opened as a mix, and is not null-terminated. `buffer` may be NULL with capacity 0 to get the
size only.
Fails like mien_mix_write_memory(). */
MienStatus mien_mix_write_text(MienMix const* mix, void* buffer, size_t capacity, size_t* out_size, MienError* error);

/* Destroys a mix. Its mixers stay valid; its memory is released with the last of them. */
void mien_mix_destroy(MienMix* mix);

/* Returns the properties of a mix. */
MienStatus mien_mix_info(MienMix const* mix, MienMixInfo* out_info);

/* Returns the measured function of a guard. `guard_index` counts as in mien_mixer_set_guard(), from 0 to
MienMixInfo.guard_count - 1; mien_mixer_guard() has its name.
Fails with MIEN_ERROR_INDEX if there is no such guard. */
MienStatus mien_mix_guard(MienMix const* mix, uint32_t guard_index, MienMixGuardInfo* out_guard);

/* Returns a ready-made reaction to a light in the eyes, with 5 strokes. The caller provides its poses, from
`first_pose` on: lids closed; squint and lowered brows; gaze turned away; narrow pupils; head turned
away. docs/mixing.md, 3 "Reactions" lists the times. `out_reaction` refers to `out_strokes`.
Fails with MIEN_ERROR_INVALID_ARGUMENT if `stroke_count` is less than 5. */
MienStatus mien_mix_glare(uint32_t first_pose, MienMixStroke* out_strokes, size_t stroke_count, MienMixReaction* out_reaction);

/* Finds antagonists: pairs of raw controls that only the two halves of one GUI control drive. Writes as
many as fit, with stiffness 1; `out_count` is the total number. `out_pairs` may be NULL if `capacity` is
0. Raw controls from 4096 on, which no mix has, are left out. */
MienStatus mien_mix_antagonists(MienRig const* rig, MienMixAntagonists* out_pairs, size_t capacity, size_t* out_count);

/* Finds the counterparts of raw controls in the other half of the face, for MienMixDesc.mirror. Controls
are counterparts if their names differ only in Left and Right (or L and R) and their motions agree, or
else if their motions are mirror images. Other controls, and curves beyond the raw controls, map to
themselves. Evaluates the rig once for each raw control, and takes memory from its allocator during
the call.
Fails with MIEN_ERROR_MEMORY if that returns NULL, MIEN_ERROR_MISMATCH if `curve_count` is less than the
raw controls, MIEN_ERROR_DNA_LIMIT if raw controls times joints exceed 2^22. */
MienStatus mien_mix_mirror(MienDeformer const* deformer, uint16_t* out_curves, size_t curve_count, MienError* error);

/* Computes a mask that selects joint groups: for each raw control the share of its joint motion, at
value 1 and LOD 0, that belongs to these groups. A millimeter counts as much as a degree. Controls
that move no joint, and curves beyond the raw controls, get `otherwise_weight`. Evaluates the rig once
for each raw control and group, and takes memory from its allocator during the call.
Fails with MIEN_ERROR_MEMORY if that returns NULL, MIEN_ERROR_INDEX if a group does not exist,
MIEN_ERROR_MISMATCH if `curve_count` is less than the raw controls. */
MienStatus mien_mix_mask(MienRig const* rig, uint32_t const* groups, size_t group_count, float otherwise_weight, float* out_mask, size_t curve_count, MienError* error);

/* Creates a gaze by measuring how raw controls turn the eyes, which evaluates the rig at least twice per
raw control. `deformer` may be destroyed afterwards. Destroy with mien_gaze_destroy().
Fails with MIEN_ERROR_NAME if there are no such joints, MIEN_ERROR_INVALID_ARGUMENT if no raw
control turns an eye monotonically in one of the four directions. */
MienStatus mien_gaze_create(MienDeformer const* deformer, MienGazeDesc const* desc, MienGaze** out_gaze, MienError* error);

/* Destroys a gaze. */
void mien_gaze_destroy(MienGaze* gaze);

/* Returns where the eyes are, so that a target can be placed in front of them. */
MienStatus mien_gaze_info(MienGaze const* gaze, MienGazeInfo* out_info);

/* Sets the raw controls of a row so that both eyes look at a target. Eyes converge on near targets.
`out_rest` may be NULL. Does not allocate or lock.
Fails with MIEN_ERROR_MISMATCH if `row_count` is less than the raw controls, MIEN_ERROR_INVALID_ARGUMENT
if the target is not finite. */
MienStatus mien_gaze_look_at(MienGaze const* gaze, MienGazeTarget const* target, float* row, size_t row_count, MienGazeRest* out_rest);

/* Creates a mixer at time 0, with one allocation. No clip plays; pose weights and pose variables are 0.
`mix` may be destroyed before it. Destroy with mien_mixer_destroy(). */
MienStatus mien_mixer_create(MienMix const* mix, MienMixerDesc const* desc, MienMixer** out_mixer, MienError* error);

/* Destroys a mixer. */
void mien_mixer_destroy(MienMixer* mixer);

/* Plays a clip in a layer, from the next step on. `clip` and `clip_binding` must outlive their playback,
including the transition to the next clip. On failure the layer continues as before. Does not allocate or
lock.
Fails with MIEN_ERROR_INDEX if the layer does not exist or has another source, MIEN_ERROR_MISMATCH if
the binding is for another clip or rig, MIEN_ERROR_INVALID_ARGUMENT if a time, speed or enum value is
out of range or a delta clip would play in a layer that overrides, MIEN_ERROR_CLIP_LIMIT if the clip is
larger than the mix allows. */
MienStatus mien_mixer_play(MienMixer* mixer, uint32_t layer, MienClip const* clip, MienClipBinding const* clip_binding, MienPlayDesc const* desc, MienError* error);

/* Fades out the clip of a layer and stops it. Fades take 0 to 2^40 ticks, here and below; they start from
the current value and speed, and end with speed 0. Does not allocate or lock.
Fails with MIEN_ERROR_INDEX if the layer does not exist or is not a clip layer. */
MienStatus mien_mixer_stop(MienMixer* mixer, uint32_t layer, int64_t fade_ticks);

/* Fades the weight of a layer to `weight`, which has the range of MienMixLayer.weight. Does not allocate or
lock.
Fails with MIEN_ERROR_INDEX if the layer does not exist. */
MienStatus mien_mixer_set_weight(MienMixer* mixer, uint32_t layer, float weight, int64_t fade_ticks);

/* Fades the weight of a pose to `weight`, 0 to 1. `pose` counts from the first pose of the layer. Weights
of a layer that add up to more than 1 are divided by their sum. Does not allocate or lock.
Fails with MIEN_ERROR_INDEX if the layer or its pose does not exist. */
MienStatus mien_mixer_set_pose_weight(MienMixer* mixer, uint32_t layer, uint32_t pose, float weight, int64_t fade_ticks);

/* Sets the `value` that a pose variable has at the start of each step, before the layers. Does not
allocate or lock.
Fails with MIEN_ERROR_INDEX if it does not exist, MIEN_ERROR_INVALID_ARGUMENT if the value is not
finite. */
MienStatus mien_mixer_set_variable(MienMixer* mixer, uint32_t variable, float value);

/* Sets how much a guard acts: `activation` is 0 to 1, or negative for automatic, the default: the smaller
the gap that base and speech leave, the more the guard acts; guards of lips and teeth act at most as
much as the largest weight of a speech layer. mien_mixer_guard() returns the name for a `guard_index`.
Does not allocate or lock.
Fails with MIEN_ERROR_INDEX if the guard does not exist, MIEN_ERROR_INVALID_ARGUMENT if `activation` is
above 1 or not a number. */
MienStatus mien_mixer_set_guard(MienMixer* mixer, uint32_t guard_index, float activation);

/* Returns what a guard did in the last step. `guard_index` counts as in mien_mixer_set_guard(). Views point
into the mix.
Fails with MIEN_ERROR_INDEX if the guard does not exist. */
MienStatus mien_mixer_guard(MienMixer const* mixer, uint32_t guard_index, MienGuardState* out_state);

/* Starts a reaction to a stimulus of `strength`, 0 to 1, that lasts for `hold_ticks`, at most 2^40; if
negative, until mien_mixer_release(). Does not allocate or lock.
Fails with MIEN_ERROR_INDEX if the reaction does not exist, MIEN_ERROR_INVALID_ARGUMENT if strength or
time is out of range. */
MienStatus mien_mixer_trigger(MienMixer* mixer, uint32_t reaction, float strength, int64_t hold_ticks);

/* Ends the stimulus of a reaction. Does not allocate or lock.
Fails with MIEN_ERROR_INDEX if the reaction does not exist. */
MienStatus mien_mixer_release(MienMixer* mixer, uint32_t reaction);

/* Sets the level of what a reaction responds to, such as a brightness, 0 to 1. Call it whenever the level
changes. A level of MienMixReaction.level_on or more is a stimulus of strength 1, which ends once the
level has been below level_off for 50 ms, so a flickering light counts as on. During the stimulus, scaled
strokes follow the level without overshoot; 90 % of a change takes 0.25 s. Does not allocate or lock.
Fails with MIEN_ERROR_INDEX if the reaction does not exist, MIEN_ERROR_INVALID_ARGUMENT if it has no
level_on or `level` is out of range. */
MienStatus mien_mixer_set_level(MienMixer* mixer, uint32_t reaction, float level);

/* Queues a row for a stream layer: one value per channel, for time `tick` of the mixer. One thread may call
this while another one uses the mixer. `out_accepted` may be NULL; it is set to 0 if the row is dropped
because it is not newer than the last one or the queue is full. Does not allocate or lock.
Fails with MIEN_ERROR_INDEX if the layer does not exist or is not a stream, MIEN_ERROR_MISMATCH if it has
another number of channels, MIEN_ERROR_INVALID_ARGUMENT if a value is not finite or `tick` is 2^61 or
more. */
MienStatus mien_mixer_push(MienMixer* mixer, uint32_t layer, int64_t tick, float const* values, size_t value_count, uint32_t* out_accepted);

/* Advances the time by `ticks`, 0 to 2^40, and mixes. Writes the raw controls to `instance`, which may
be NULL. Does not allocate or lock.
Fails with MIEN_ERROR_INVALID_ARGUMENT if `ticks` is out of range or the time would exceed 2^60 ticks
(51 years), MIEN_ERROR_MISMATCH if the instance has another number of raw controls. */
MienStatus mien_mixer_step(MienMixer* mixer, int64_t ticks, MienInstance* instance);

/* Steps `count` mixers; instances[i] belongs to mixers[i]. `instances` may be NULL. The results are those
of single calls. On failure no mixer is advanced.
Fails like mien_mixer_step(), and with MIEN_ERROR_INVALID_ARGUMENT if a mixer is listed twice. */
MienStatus mien_mixer_step_batch(MienMixer* const* mixers, MienInstance* const* instances, size_t count, int64_t ticks);

/* Returns the row of the last step, one float per curve: raw controls, then pose variables.
Contents change with mien_mixer_step() and mien_mixer_step_batch(). */
MienStatus mien_mixer_row(MienMixer const* mixer, MienFloatView* out_row);

/* Returns the row after a stage of the last step, one float per curve. Stages are numbered: the layers,
then reactions, guards, antagonists, limits. Layers that act after the reactions or the guards keep
their numbers.
Fails with MIEN_ERROR_INDEX if the stage does not exist, MIEN_ERROR_INVALID_ARGUMENT if
MienMixerDesc.stages was 0.
Contents change with mien_mixer_step() and mien_mixer_step_batch(). */
MienStatus mien_mixer_stage(MienMixer const* mixer, uint32_t stage, MienFloatView* out_row);

/* Returns the state of a mixer. */
MienStatus mien_mixer_info(MienMixer const* mixer, MienMixerInfo* out_info);

/* Returns an event of the last step and its layer. The tick is in the time of the clip, and the name is a
view into the clip.
Fails with MIEN_ERROR_INDEX if `index` is out of range. */
MienStatus mien_mixer_event(MienMixer const* mixer, uint32_t index, MienClipEvent* out_event, uint32_t* out_layer);

/* Writes the state of a mixer to memory: everything that later steps depend on, except queued stream rows.
Returns its size in `out_size`. `buffer` may be NULL with capacity 0 to get the size only. Snapshots
can be restored on 64-bit machines of the same byte order. Does not allocate or lock.
Fails with MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small. */
MienStatus mien_mixer_snapshot(MienMixer* mixer, void* buffer, size_t capacity, size_t* out_size, MienError* error);

/* Restores a snapshot of a mixer of the same mix; later steps give the same bits. Queued stream rows are
not part of it. `clips` lists the clips that may have been playing. The bytes are validated, so they
need not be trusted. On failure the mixer does not change. Does not allocate or lock.
Fails with MIEN_ERROR_INVALID_ARGUMENT if the bytes are not a snapshot of this mix,
MIEN_ERROR_MISMATCH if a clip is missing or is not the one that was playing. */
MienStatus mien_mixer_restore(MienMixer* mixer, void const* bytes, size_t size, MienMixerClip const* clips, size_t clip_count, MienError* error);

/* Creates a solver stack. `desc` is required. `deformer` may be destroyed before it. Destroy with
mien_solver_stack_destroy().
Fails with MIEN_ERROR_INDEX if a joint or curve does not exist, MIEN_ERROR_INVALID_ARGUMENT if a number
is out of range, or if a solver reads a joint that a later one moves; the message names both. */
MienStatus mien_solver_stack_create(MienDeformer const* deformer, MienSolverStackDesc const* desc, MienSolverStack** out_solver_stack, MienError* error);

/* Destroys a solver stack. Its states stay valid; its memory is released with the last of them. */
void mien_solver_stack_destroy(MienSolverStack* solver_stack);

/* Returns the properties of a solver stack. */
MienStatus mien_solver_stack_info(MienSolverStack const* solver_stack, MienSolverStackInfo* out_info);

/* Creates a solver state. `solver_stack` may be destroyed before it. Destroy with
mien_solver_state_destroy(). */
MienStatus mien_solver_state_create(MienSolverStack const* solver_stack, MienSolverStateDesc const* desc, MienSolverState** out_solver_state, MienError* error);

/* Destroys a solver state. */
void mien_solver_state_destroy(MienSolverState* solver_state);

/* Runs the solvers on the pose of `deformer_instance`. Call mien_deformer_instance_update() before every
step. `input` may be NULL: no row, LOD 0. `ticks`, the time since the last step, is 0 to
2^40. Does not allocate or lock.
Fails with MIEN_ERROR_MISMATCH if instance and stack have different deformers or the row is
shorter than MienSolverStackDesc.curve_count, MIEN_ERROR_INVALID_ARGUMENT if `ticks` or the LOD is out of
range. */
MienStatus mien_solver_state_step(MienSolverState* solver_state, MienDeformerInstance* deformer_instance, MienSolverInput const* input, int64_t ticks);

/* Steps `count` states of one stack; deformer_instances[i] and inputs[i] belong to solver_states[i].
`inputs` may be NULL. The results are those of single calls. No state or instance may occur twice. On
failure nothing changes. Does not allocate or lock. Uses up to 8 KiB of stack.
Fails like mien_solver_state_step(), and with MIEN_ERROR_MISMATCH if the states have different
stacks. */
MienStatus mien_solver_state_step_batch(MienSolverState* const* solver_states, MienDeformerInstance* const* deformer_instances, MienSolverInput const* inputs, size_t count, int64_t ticks);

/* Returns the outputs of a solver in the last step, one float per output. `solver` is its index in the
stack.
Contents change with mien_solver_state_step(), mien_solver_state_step_batch().
Fails with MIEN_ERROR_INDEX if the solver does not exist. */
MienStatus mien_solver_state_outputs(MienSolverState const* solver_state, uint32_t solver, MienFloatView* out_values);

/* Returns the joint transforms after the last step, relative to the parents: 10 floats per joint, tx ty tz
qx qy qz qw sx sy sz. (mien_deformer_instance_local_transforms() returns those before the step.)
Contents change with mien_solver_state_step(), mien_solver_state_step_batch(). */
MienStatus mien_solver_state_transforms(MienSolverState const* solver_state, MienFloatView* out_transforms);

/* Returns the name of a solver that changed a joint not in its `writes` in the last step, or an empty
string. Contents change with mien_solver_state_step(), mien_solver_state_step_batch().
Fails with MIEN_ERROR_INVALID_ARGUMENT if MienSolverStackDesc.check_writes was 0. */
MienStatus mien_solver_state_undeclared(MienSolverState const* solver_state, MienStringView* out_name);

/* Finds the raw controls that a name stands for on a rig. Takes time proportional to the number of raw
controls: meant for loading, not for every frame. Does not allocate or lock. Writes as many shares as
fit; `out_count` is the total number, at most MIEN_MOST_SHARES, each of a different control. `out_shares`
may be NULL if `capacity` is 0. `out_match` is one of MIEN_NAME_MATCH_....
Fails with MIEN_ERROR_NAME if the name matches no control of this rig, or several in step 1 or 2.
See docs/face-capture.md, 2 "Names". */
MienStatus mien_rig_match(MienRig const* rig, char const* name, size_t name_count, MienControlShare* out_shares, size_t capacity, size_t* out_count, uint32_t* out_match);

/* Returns the usual name of a control: that of ARKit, such as mouthSmileLeft for AU12_L and
mouthCornerPullL, or that of MetaHuman's raw controls if ARKit has none. A name without a side gets none:
mouthSmile. Writes as many bytes as fit, without a null; `out_count` is the total number. `out_name` may
be NULL if `capacity` is 0.
Fails with MIEN_ERROR_NAME if the name is not in the table.
See docs/face-capture.md, 2 "Names". */
MienStatus mien_control_name(char const* name, size_t name_count, char* out_name, size_t capacity, size_t* out_count);

/* Generates a rig and opens it: a file of version 2.8, unless the preset states another one, with all layers
of its version, behavior of realistic size and sparsity, and simple geometry. Close with
mien_dna_close(). */
MienStatus mien_dna_generate(MienGenerateDesc const* desc, MienDna** out_dna, MienError* error);

/* Creates a rig from a mesh, with or without expressions, and opens it as a file of version 2.8: joints,
skin weights for every LOD, and a raw control for each expression. The file has the axes of the mesh, in
centimeters; positions keep their order, but positions that belong to no face are dropped. The same mesh,
options and seed give the same bytes on any number of threads. `mesh` is required;
`out_report` may be NULL. Close with mien_dna_close() and mien_author_report_close().
The report has the confidence of each landmark; a mesh is not refused because it is low.
Fails with MIEN_ERROR_AUTHOR_MESH if the arrays of the mesh or of the caller's results contradict
each other, MIEN_ERROR_AUTHOR_REFUSED if the mesh cannot be rigged or landmarks contradict it,
MIEN_ERROR_AUTHOR_CANCELED if `progress` canceled, MIEN_ERROR_DNA_LIMIT if the file would be too large.
See docs/authoring.md, 1 "What goes in and what comes out". */
MienStatus mien_author_rig(MienAuthorMesh const* mesh, MienAuthorDesc const* desc, MienDna** out_dna, MienAuthorReport** out_report, MienError* error);

/* Closes a report. */
void mien_author_report_close(MienAuthorReport* author_report);

/* Returns the report as JSON: bones, mask, groups, errors of the fit, and more. Lengths are in
centimeters.
See docs/authoring.md, 6 "The report". */
MienStatus mien_author_report_json(MienAuthorReport const* author_report, MienStringView* out_json);

/* Makes a document of an open file, as it was loaded: layers and LODs that were left out are not in it.
`dna` may be NULL, for an empty document of version 2.8 with all layers. `dna` may be closed
afterwards. Destroy with mien_document_destroy().
Fails with MIEN_ERROR_DNA_LAYER if `dna` has RBF behavior without the machine-learned behavior of its
file, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE or MIEN_ERROR_DNA_VALUE if the loaded part would
not open by itself, MIEN_ERROR_DNA_LIMIT if it exceeds 4 GiB. */
MienStatus mien_document_create(MienDna const* dna, MienDocumentDesc const* desc, MienDocument** out_document, MienError* error);

/* Opens a whole DNA file as a document, with the checks of mien_dna_open_file(), without a second copy in
memory. Do not truncate or overwrite a mapped file while the document exists; replacing it by renaming is safe,
and so is mien_document_write_file() to the same path, except on Windows, where a mapped file cannot be
replaced: use MIEN_FILE_READ. Destroy with mien_document_destroy().
Fails like mien_dna_open_file(), but not with MIEN_ERROR_LOD. */
MienStatus mien_document_open_file(char const* path, MienDocumentDesc const* desc, MienDocument** out_document, MienError* error);

/* Destroys a document. */
void mien_document_destroy(MienDocument* document);

/* Finds a field by its path, like mien_dna_field(). Its byte_offset is MIEN_NO_OFFSET.
Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is past
the end.
See docs/dna-format.md, 6 "Layers, field by field". */
MienStatus mien_document_field(MienDocument const* document, char const* path, MienDnaField* out_field, MienError* error);

/* Returns the name of field `index` of the record at a path, like mien_dna_child_name(). The string is
static.
Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if `index` or an index in the
path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a record. */
MienStatus mien_document_child_name(MienDocument const* document, char const* path, uint32_t index, MienStringView* out_name, MienError* error);

/* Copies `count` elements of a field, beginning with element `first`, to `out`, like
mien_dna_read_floats(). `out` may be NULL if `count` is 0.
Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
kind. */
MienStatus mien_document_read_floats(MienDocument const* document, char const* path, uint64_t first, uint64_t count, float* out, MienError* error);

/* Copies `count` elements of a field, beginning with element `first`, to `out`, like
mien_dna_read_floats(). `out` may be NULL if `count` is 0.
Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
kind. */
MienStatus mien_document_read_integers(MienDocument const* document, char const* path, uint64_t first, uint64_t count, int64_t* out, MienError* error);

/* Returns a string. Contents change with mien_document_write_string(), mien_document_undo(): the view
is valid until the document is changed.
Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is
past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a string. */
MienStatus mien_document_read_string(MienDocument const* document, char const* path, MienStringView* out_string, MienError* error);

/* Returns the bytes of an array of numbers or of a string in place: big-endian and unaligned, as in a file.
Contents change with mien_document_write_floats(), mien_document_write_integers(), mien_document_undo():
the view is valid until the document is changed.
Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is
past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is neither an array nor a string. */
MienStatus mien_document_bytes(MienDocument const* document, char const* path, MienStringView* out_bytes, MienError* error);

/* Replaces `count` elements of an array, beginning with element `first`, or a single number. The first write
to an array after a mark or an operation copies it, later ones do not. `values` may be NULL if `count`
is 0.
Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
kind, or none of this size, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MienStatus mien_document_write_floats(MienDocument* document, char const* path, uint64_t first, uint64_t count, float const* values, MienError* error);

/* Replaces `count` elements of an array, beginning with element `first`, or a single number. The first write
to an array after a mark or an operation copies it, later ones do not. `values` may be NULL if `count`
is 0.
Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
kind, or none of this size, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MienStatus mien_document_write_integers(MienDocument* document, char const* path, uint64_t first, uint64_t count, int64_t const* values, MienError* error);

/* Replaces a string by `string_count` bytes. `string` may be NULL if `string_count` is 0.
Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is past
the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a string, or if another element of a list of
names has this name, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MienStatus mien_document_write_string(MienDocument* document, char const* path, char const* string, size_t string_count, MienError* error);

/* Replaces `removed_count` elements of an array or list, beginning with element `first`, by
`inserted_count` new ones: zeros, empty strings, or records of these. References to elements by number do
not change. Copies the array, or the list without its contents.
Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is neither an array nor a list, or
would have more than 2^32 - 1 elements, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MienStatus mien_document_splice(MienDocument* document, char const* path, uint64_t first, uint64_t removed_count, uint64_t inserted_count, MienError* error);

/* Gives an array or list `count` elements: drops the last ones or adds new ones, like
mien_document_splice().
Fails like mien_document_splice(). */
MienStatus mien_document_resize(MienDocument* document, char const* path, uint64_t count, MienError* error);

/* Returns the version of the file that the document becomes, 2.`out_version`, and the length of its list of
layers. A file also has the layers that its version defines and the list lacks, behind the others. */
MienStatus mien_document_layer_count(MienDocument const* document, uint32_t* out_version, uint32_t* out_count, MienError* error);

/* Returns layer `index` of the list, as mien_dna_layer(); byte_offset is MIEN_NO_OFFSET. `out_bytes` gets the
contents of a layer of an unknown kind, else nothing. Contents change with mien_document_clear_layers(),
mien_document_undo(): the view is valid until the document is changed.
Fails with MIEN_ERROR_INDEX if `index` is past the end. */
MienStatus mien_document_layer(MienDocument const* document, uint32_t index, MienDnaLayer* out_layer, MienStringView* out_bytes, MienError* error);

/* Makes the document a file of version 2.`version` and its list of layers empty: layers of unknown kinds
are gone, fields stay as they are. mien_document_add_layer() fills the list again.
Fails with MIEN_ERROR_INVALID_ARGUMENT if `version` is not 1 to 65535, MIEN_ERROR_MEMORY if the allocator
returns NULL. */
MienStatus mien_document_clear_layers(MienDocument* document, uint32_t version, MienError* error);

/* Appends a layer to the list: the layer of a known kind, without bytes, or `size` bytes of an
unknown kind, which are written to the file as they are. `code` has four characters, such as "bhvr"; the
layer is of version `version_major`.`version_minor`. `bytes` may be NULL if `size` is 0.
Fails with MIEN_ERROR_INVALID_ARGUMENT if `code` has another length, a version is above 65535, the list has a
layer of this code and version already, the kind is known and has bytes, or a file of version 2.1 cannot
have it, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MienStatus mien_document_add_layer(MienDocument* document, char const* code, uint32_t version_major, uint32_t version_minor, void const* bytes, size_t size, MienError* error);

/* Remembers the current state, at the cost of some KB. Mark 0 always exists: the state in which the
document was created. Changes before a mark keep their memory until the document is destroyed or an
earlier mark is restored.
Fails with MIEN_ERROR_MEMORY if the allocator returns NULL. */
MienStatus mien_document_mark(MienDocument* document, uint64_t* out_mark, MienError* error);

/* Goes back to the state at a mark: `mark` is a number from mien_document_mark(), or 0. Later marks become
invalid, this one stays valid. Does not allocate or lock.
Fails with MIEN_ERROR_INDEX if `mark` is not a valid mark of the document. */
MienStatus mien_document_undo(MienDocument* document, uint64_t mark, MienError* error);

/* Finds the index of a name; of equal names, the first. `kind` is a MIEN_KIND_...: GUI, raw, PSD ("psd0",
"psd1", ...), ML and RBF controls, joints, blend shape channels, animated maps, meshes.
Fails with MIEN_ERROR_NAME if there is no such name, MIEN_ERROR_INVALID_ARGUMENT if the kind has no names
in a document. */
MienStatus mien_document_find(MienDocument const* document, uint32_t kind, char const* name, uint32_t* out_index, MienError* error);

/* Renames element `index` of a kind of mien_document_find() but PSD controls.
Fails with MIEN_ERROR_INDEX if there is no such element, MIEN_ERROR_INVALID_ARGUMENT if another element
of the kind has the name, or the kind has no names in a document, MIEN_ERROR_MEMORY if the allocator
returns NULL. */
MienStatus mien_document_rename(MienDocument* document, uint32_t kind, uint32_t index, char const* name, MienError* error);

/* Removes controls, joints, blend shape channels, animated maps or meshes, and everything that
refers to them: names, LOD lists, rows of tables, targets, regions of networks. `indices` has
`index_count` elements; PSD, ML and RBF controls are numbered from 0.
Children of a joint go to its nearest ancestor that stays, or become roots, and keep their neutral place
in the world; motions that are relative to the parent keep their numbers. The joint's skin weights go to
the same ancestor, or to the first joint that stays. Quaternion joints move as before within 1e-2
degrees; where the columns of a joint group would rotate them in another order, each quaternion joint of
the group gets a joint group of its own.
A raw, PSD, ML or RBF control is removed as if it stayed 0: with it go its columns of joint groups, its rows
of channels and animated maps, PSD controls that are products of it, RBF solvers, twists and swings that
read it, its inputs of networks, and the outputs of networks and RBF poses that set it. Networks that ML
operations run cannot lose one: their controls are refused. Files before 2.5 cannot lose RBF controls.
Fails with MIEN_ERROR_INDEX if an index is past the end, MIEN_ERROR_INVALID_ARGUMENT if the
networks or the version need a control, or no joint would be left for the skin
weights, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE
if the document is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MienStatus mien_document_remove(MienDocument* document, uint32_t kind, uint32_t const* indices, size_t index_count, MienError* error);

/* Removes all blend shape channels with their targets, all animated maps, or, for MIEN_KIND_JOINT,
everything that moves joints. `kind` is a MIEN_KIND_....
Fails like mien_document_remove(), but not with MIEN_ERROR_INDEX. */
MienStatus mien_document_clear(MienDocument* document, uint32_t kind, MienError* error);

/* Removes everything that moves these joints: their rows of joint groups, twists, swings and ML joints.
Fails like mien_document_remove(). */
MienStatus mien_document_clear_joints(MienDocument* document, uint32_t const* joints, size_t joint_count, MienError* error);

/* Sets neutral transforms of joints from `first_joint` on, relative to their parents, in the units and
axes of the file: translations, 3 floats per joint, and rotations, 3 floats per joint. Either may be
left out: `translations` may be NULL; `rotations` may be NULL.
Fails with MIEN_ERROR_INDEX if there are fewer joints, MIEN_ERROR_INVALID_ARGUMENT if a number is not
finite, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE
if the document is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MienStatus mien_document_set_neutral(MienDocument* document, uint32_t first_joint, float const* translations, float const* rotations, size_t count, MienError* error);

/* Sets all positions of a mesh, 3 floats per position. Normals do not change: deformers recompute them by
default; otherwise write geom.meshes[i].normals.
Fails with MIEN_ERROR_INDEX if `mesh` is past the end, MIEN_ERROR_INVALID_ARGUMENT if the mesh has another
number of positions, or a number is not finite, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MienStatus mien_document_set_positions(MienDocument* document, uint32_t mesh, float const* positions, size_t position_count, MienError* error);

/* Sets the target of blend shape channel `channel` on mesh `mesh`: 3 floats per delta, of the positions
`vertices`. `vertices` may be NULL for the first `count` positions. Deltas of zero are left out; if there
are no others, the target is removed. The pair of mesh and channel in defn.meshBlendShapeChannelMapping
is added or removed with it.
Fails with MIEN_ERROR_INDEX if `mesh`, `channel` or a vertex is past the end, MIEN_ERROR_INVALID_ARGUMENT
if there are more deltas than positions, or a number is not finite, MIEN_ERROR_DNA_STRUCTURE,
MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid,
MIEN_ERROR_MEMORY if the allocator returns NULL. */
MienStatus mien_document_set_target(MienDocument* document, uint32_t mesh, uint32_t channel, uint32_t const* vertices, float const* deltas, size_t count, MienError* error);

/* Removes deltas not longer than `tolerance`, in the unit of the file, and targets that have none left.
`out_pruned` gets their numbers.
Fails with MIEN_ERROR_INVALID_ARGUMENT if `tolerance` is negative or not finite, MIEN_ERROR_DNA_STRUCTURE,
MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid,
MIEN_ERROR_MEMORY if the allocator returns NULL. */
MienStatus mien_document_prune_targets(MienDocument* document, float tolerance, MienPrunedTargets* out_pruned, MienError* error);

/* Sets small entries of the joint matrix to 0, and removes columns and rows of joint groups that have no
others. Measures how far that moves the positions of LOD 0, with each raw control at 1, and with all raw
controls of each corrective at 1. `desc` is required.
Fails with MIEN_ERROR_INVALID_ARGUMENT if a field of `desc` is negative or not finite,
MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the
document is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MienStatus mien_document_prune_joints(MienDocument* document, MienPruneJointsDesc const* desc, MienPrunedJoints* out_pruned, MienError* error);

/* Sets the skin weights of a mesh: `influences` joints and weights per position, row by row. Weights of 0
are left out. `joints` has `weight_count` elements, as many as `weights`.
Fails with MIEN_ERROR_INDEX if `mesh` is past the end, MIEN_ERROR_INVALID_ARGUMENT if there is another
number of weights, a weight is negative or not finite, a joint does not exist, or a position has a
joint twice or no weight, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or
MIEN_ERROR_DNA_VALUE if the document is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MienStatus mien_document_set_weights(MienDocument* document, uint32_t mesh, uint32_t influences, uint16_t const* joints, float const* weights, size_t weight_count, MienError* error);

/* Scales the weights of each position of mesh `mesh` to a sum of 1; sums within 1e-6 of it stay as they are.
Fails with MIEN_ERROR_INDEX if `mesh` is past the end, MIEN_ERROR_DNA_STRUCTURE,
MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid,
MIEN_ERROR_MEMORY if the allocator returns NULL. */
MienStatus mien_document_normalize_weights(MienDocument* document, uint32_t mesh, MienError* error);

/* Keeps the `influences` largest weights of each position of mesh `mesh`, in their order, scaled to the
previous sum.
Fails like mien_document_normalize_weights(), and with MIEN_ERROR_INVALID_ARGUMENT if `influences` is 0. */
MienStatus mien_document_limit_influences(MienDocument* document, uint32_t mesh, uint32_t influences, MienError* error);

/* Smooths the weights of mesh `mesh` `iterations` times: those of each position become (1 - strength) times
its own plus strength times the mean of its neighbors along edges. Positions at the same place count as
one. Each keeps at most `influences`, with a sum of 1.
Fails like mien_document_limit_influences(), and with MIEN_ERROR_INVALID_ARGUMENT if `strength` is not 0
to 1, or there are more than 1000 iterations. */
MienStatus mien_document_smooth_weights(MienDocument* document, uint32_t mesh, uint32_t iterations, float strength, uint32_t influences, MienError* error);

/* Scales, rotates and moves the whole character: neutral joints, positions, normals, targets, and the
translations that controls add to joints. `placement` is required.
Fails with MIEN_ERROR_INVALID_ARGUMENT if a number is not finite or the scale is negative,
MIEN_ERROR_DNA_VALUE if a root joint is moved by controls and the rotation is not 0, networks translate
joints and the scale is not 1, or the document is not valid, MIEN_ERROR_DNA_STRUCTURE,
MIEN_ERROR_DNA_REFERENCE or MIEN_ERROR_DNA_LIMIT if the document is not valid, MIEN_ERROR_MEMORY if the
allocator returns NULL. */
MienStatus mien_document_place(MienDocument* document, MienPlacement const* placement, MienError* error);

/* Keeps the LODs whose bits are set in `lods`, like MienDnaDesc.lods.
Fails with MIEN_ERROR_LOD if none of them exists, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE,
MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid, MIEN_ERROR_MEMORY if the
allocator returns NULL.
See docs/dna-format.md, 10 "Choosing LODs". */
MienStatus mien_document_keep_lods(MienDocument* document, uint64_t lods, MienError* error);

/* Converts to another coordinate system, like MienDnaDesc.system. `system` is required.
Fails with MIEN_ERROR_DNA_VALUE if the rig cannot be converted or the document is not valid,
MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE or MIEN_ERROR_DNA_LIMIT if the document is not valid,
MIEN_ERROR_MEMORY if the allocator returns NULL.
See docs/dna-format.md, 11 "Coordinate systems". */
MienStatus mien_document_convert(MienDocument* document, MienCoordinateSystem const* system, MienError* error);

/* Copies the layers of another document whose bits are set. `layers` is a MIEN_LAYER_..., combined with |.
Layers that refer to each other are copied together.
Fails with MIEN_ERROR_INVALID_ARGUMENT if `layers` has other bits, MIEN_ERROR_DNA_STRUCTURE,
MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if they do not fit the other
layers, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MienStatus mien_document_copy_layers(MienDocument* document, MienDocument const* from, uint32_t layers, MienError* error);

/* Copies mesh `mesh` of another document. It replaces the mesh of the same name, or becomes a new one, at
its LODs in the other document as far as this document has them. Joints and channels are found by name;
the influence of a missing joint goes to its nearest ancestor that exists here, and targets of missing
channels are left out.
Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_INVALID_ARGUMENT if both documents are
the same, MIEN_ERROR_MISMATCH if the documents differ in axes, units or rotations, or this one has no
joint of a position, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or
MIEN_ERROR_DNA_VALUE if one of them is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MienStatus mien_document_copy_mesh(MienDocument* document, MienDocument const* from, uint32_t mesh, uint32_t* out_mesh, MienError* error);

/* Adds the joints of another document whose names this one lacks, such as those of a body to a head: below
the joints with the names of their parents, numbered after the existing ones, at the LODs that list them
in the other document. Joints of both documents stay as they are, but a root that has a parent in the
other one becomes its child. They must have the same place in model space, within `tolerance` in the unit
of the file.
Fails with MIEN_ERROR_INVALID_ARGUMENT if both documents are the same, MIEN_ERROR_MISMATCH if they differ
in axes, units or rotations, or in the place of a joint, MIEN_ERROR_DNA_STRUCTURE,
MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if one of them is not valid or the
result would not be, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MienStatus mien_document_merge_joints(MienDocument* document, MienDocument const* from, double tolerance, MienError* error);

/* Removes the joints whose names another document lacks, like mien_document_remove().
Fails with MIEN_ERROR_INVALID_ARGUMENT if no joint would be left for the skin weights,
MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if
`document` is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MienStatus mien_document_split_joints(MienDocument* document, MienDocument const* from, MienError* error);

/* Gives mesh `mesh` the skin weights and targets of mesh `source`, interpolated at the point of `source`
nearest to each position: a coarser LOD from a finer one. The influence of joints that no LOD of the mesh
lists goes to the nearest ancestor that one of them lists; targets of channels that none lists are left
out. If these LODs list no joints or channels at all, all are kept. `out_farthest` gets the largest
distance to a nearest point, in the unit of the file or of the texture.
Fails with MIEN_ERROR_INDEX if `mesh` or `source` is past the end, MIEN_ERROR_INVALID_ARGUMENT if they are
the same, or lack triangles, texture coordinates or weights, MIEN_ERROR_DNA_STRUCTURE,
MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid,
MIEN_ERROR_MEMORY if the allocator returns NULL. */
MienStatus mien_document_project(MienDocument* document, uint32_t mesh, uint32_t source, MienProjectDesc const* desc, double* out_farthest, MienError* error);

/* The same for all meshes of LOD `lod`, each from the mesh of LOD `source_lod` whose name differs only in the
number of the LOD ("head_lod3_mesh" from "head_lod0_mesh"). A LOD that lists no joints or channels gets
those of `source_lod`.
Fails with MIEN_ERROR_LOD if there is no such LOD, MIEN_ERROR_NAME if a mesh has no counterpart,
MIEN_ERROR_INVALID_ARGUMENT if the LODs are the same, or meshes lack triangles, texture coordinates or
weights, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or
MIEN_ERROR_DNA_VALUE if the document is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MienStatus mien_document_make_lod(MienDocument* document, uint32_t lod, uint32_t source_lod, MienProjectDesc const* desc, double* out_farthest, MienError* error);

/* Gives mesh `mesh` new positions, 3 floats per position, such as a head that an artist reshaped, and lets
the rig follow: joints move with the surface around them and keep their orientation; targets rotate and
scale with the surface, translations that controls add to joints scale with it, and normals rotate.
`others` is 0, or 1 to move the other meshes, too. A motion of the whole mesh is followed exactly.
Fails with MIEN_ERROR_INDEX if `mesh` is past the end, MIEN_ERROR_INVALID_ARGUMENT if the mesh has another
number of positions, or a number is not finite, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE,
MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid, MIEN_ERROR_MEMORY if the
allocator returns NULL. */
MienStatus mien_document_conform(MienDocument* document, uint32_t mesh, float const* positions, size_t position_count, uint32_t others, MienConformed* out_conformed, MienError* error);

/* Gives a character the rig of a template: controls, joints, behavior, and LODs of document `rig`. The
character keeps its shape. Its meshes keep topology and positions where the template has a mesh of the
same name, and get weights and targets from it; other meshes are the template's, moved with the surface.
Joints with names of joints of the character keep the places of those, others move with the surface.
`out_errors` has `capacity` elements, one for each raw control of both rigs, or fewer; `out_errors` may
be NULL; `out_count` gets the number written.
Fails with MIEN_ERROR_MISMATCH if the documents differ in axes, units or rotations,
MIEN_ERROR_INVALID_ARGUMENT if no mesh of LOD 0 has the name of one of the template, or meshes lack
triangles or texture coordinates, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE,
MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if one of them is not valid, MIEN_ERROR_MEMORY if the
allocator returns NULL. */
MienStatus mien_document_transplant(MienDocument* document, MienDocument const* rig, MienTransplantDesc const* desc, MienControlError* out_errors, size_t capacity, size_t* out_count, MienError* error);

/* Opens the document as a file, with all checks of opening a file. `document` may be destroyed afterwards.
Close with mien_dna_close().
Fails with MIEN_ERROR_DNA_TRUNCATED, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE,
MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not a valid file; the message names the
first invalid field, mien_document_validate() lists them all.
See docs/dna-format.md, 13 "What is checked". */
MienStatus mien_document_to_dna(MienDocument const* document, MienDocumentDesc const* desc, MienDna** out_dna, MienError* error);

/* Writes the document to a file, like mien_dna_write_file(), with all checks of opening it as a file.
Fails with MIEN_ERROR_FILE_WRITE if the file cannot be written, MIEN_ERROR_DNA_STRUCTURE,
MIEN_ERROR_DNA_REFERENCE or MIEN_ERROR_DNA_VALUE if the document is not a valid file, or would not be one in
the requested version, MIEN_ERROR_DNA_LIMIT if the file would exceed 4 GiB, MIEN_ERROR_MEMORY if the
allocator returns NULL. */
MienStatus mien_document_write_file(MienDocument const* document, char const* path, MienWriteDesc const* desc, MienError* error);

/* Passes the bytes of the file to `sink`, in pieces of at most 8 MiB.
Fails like mien_document_write_file(), also with MIEN_ERROR_FILE_WRITE if `sink` does not take a piece. */
MienStatus mien_document_write_stream(MienDocument const* document, MienByteSink const* sink, MienWriteDesc const* desc, MienError* error);

/* Writes the document to memory and returns its size in `out_size`. `buffer` may be NULL with capacity 0 to get
the size only. Writes nothing if `capacity` is too small; `out_size` is set nevertheless.
Fails like mien_document_write_file(), but not with MIEN_ERROR_FILE_WRITE, and with
MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small. */
MienStatus mien_document_write_memory(MienDocument const* document, MienWriteDesc const* desc, void* buffer, size_t capacity, size_t* out_size, MienError* error);

/* Checks the document like mien_dna_validate_memory() its file. `document` may be destroyed afterwards.
Destroy with mien_report_destroy().
Fails with MIEN_ERROR_DNA_LIMIT if the file would exceed 4 GiB. */
MienStatus mien_document_validate(MienDocument const* document, MienValidateDesc const* desc, MienReport** out_report, MienError* error);

/* Creates a fit. `desc` is required. `rig` must outlive the fit; the deformer may be destroyed. Measures
the effect of each control, which takes up to some seconds for large rigs. Destroy with
mien_fit_destroy().
Fails with MIEN_ERROR_INDEX if a control, position or mesh does not exist, MIEN_ERROR_LOD if the rig has no
such LOD, MIEN_ERROR_MISMATCH if the deformer belongs to another rig, MIEN_ERROR_INVALID_ARGUMENT if controls are
not ascending, a lower bound is above its upper one, or a weight is not finite. */
MienStatus mien_fit_create(MienRig const* rig, MienFitDesc const* desc, MienFit** out_fit, MienError* error);

/* Destroys a fit. NULL is allowed. */
void mien_fit_destroy(MienFit* fit);

/* Creates a surface with a tree to find the nearest points. `desc` is required. Destroy with
mien_fit_surface_destroy().
Fails with MIEN_ERROR_INDEX if a position does not exist, MIEN_ERROR_INVALID_ARGUMENT if there are no
triangles, or a coordinate is not finite. */
MienStatus mien_fit_surface_create(MienFitSurfaceDesc const* desc, MienFitSurface** out_surface, MienError* error);

/* Destroys a surface. NULL is allowed. */
void mien_fit_surface_destroy(MienFitSurface* surface);

/* Finds the raw controls of a frame by bounded Gauss-Newton steps with Levenberg-Marquardt damping. Writes
all raw controls of the rig to `out_raw`; those that may not move keep their values of `start`. `result`
may be NULL. Deterministic unless there is a time limit. Does not allocate or lock.
Fails with MIEN_ERROR_NULL_ARGUMENT if points, images or a surface are given to a fit without points, or
images without a camera, or constraints on joints to one without a deformer,
MIEN_ERROR_INVALID_ARGUMENT if a stage is above 15, or a weight, a control, an offset or a number of the camera is
not finite, or a weight is negative, MIEN_ERROR_HANDLE if `surface` is none,
MIEN_ERROR_INDEX if a constraint has a joint or point that does not exist. */
MienStatus mien_fit_solve(MienFit* fit, MienFitFrame const* frame, float* out_raw, MienFitResult* result);

/* Solves `count` frames of a motion, each from the result of the one before. `joints`, `points`, `images`,
`point_weights` and `surface_weights` of `frame` have a row for each frame, one after the other; all else is for all
frames. `start` and `stages` are for the first frame, and so is `camera`, if it may move. `out_raw` gets a row of all
raw controls for each frame; `results`, which may be NULL, one result for each, all with the `struct_size` of the
first. Where joints are the only targets, this is faster than calls of mien_fit_solve(), and differs from them by
rounding. Deterministic unless there is a time limit, which is that of a frame. Does not allocate or lock.
Fails like mien_fit_solve(). */
MienStatus mien_fit_solve_frames(MienFit* fit, MienFitFrame const* frame, size_t count, float* out_raw, MienFitResult* results);

/* Writes for each raw control how well the data determines it at the initial pose: 0 if it moves nothing
that has a target, or if other controls have the same effect; up to 1 for the best determined one. The
parts of a rotation get the value of the turn that is determined least.
`count` is the number of raw controls.
Fails with MIEN_ERROR_INVALID_ARGUMENT if `count` is another number. */
MienStatus mien_fit_observability(MienFit const* fit, float* out_values, size_t count);

/* Chooses keys of a curve: straight lines between them are within `tolerance` of all values. `out_keys` gets
the frame numbers, ascending, the first and the last frame among them; `out_key_count` gets how many. `count`
is the number of values and the capacity of `out_keys`.
Fails with MIEN_ERROR_INVALID_ARGUMENT if a value is not finite, or the tolerance is negative or not
finite. */
MienStatus mien_fit_keys(float const* values, size_t count, float tolerance, uint32_t* out_keys, size_t* out_key_count);
]]

api.VERSION = "0.1.0"
api.NO_OFFSET = 18446744073709551615ULL
api.TICKS_PER_SECOND = 705600000
api.NO_MESH = 4294967295
api.NO_CONTROL = 65535
api.NO_JOINT = 65535
api.MOST_SHARES = 16

api.Status = {
  OK = 0,
  NULL_ARGUMENT = 1,
  INVALID_ARGUMENT = 2,
  STRUCT_SIZE = 3,
  HANDLE = 4,
  MISMATCH = 5,
  INDEX = 6,
  LOD = 7,
  NAME = 8,
  ISA = 9,
  MEMORY = 10,
  UNSUPPORTED = 11,
  FILE_OPEN = 20,
  FILE_READ = 21,
  FILE_WRITE = 22,
  DNA_SIGNATURE = 30,
  DNA_VERSION = 31,
  DNA_TRUNCATED = 32,
  DNA_STRUCTURE = 33,
  DNA_REFERENCE = 34,
  DNA_LIMIT = 35,
  DNA_LAYER = 36,
  DNA_VALUE = 37,
  BAKED_SIGNATURE = 50,
  BAKED_VERSION = 51,
  BAKED_TRUNCATED = 52,
  BAKED_STRUCTURE = 53,
  BAKED_CHECKSUM = 54,
  BAKED_PART = 55,
  CLIP_SIGNATURE = 60,
  CLIP_VERSION = 61,
  CLIP_TRUNCATED = 62,
  CLIP_STRUCTURE = 63,
  CLIP_CHECKSUM = 64,
  CLIP_VALUE = 65,
  CLIP_LIMIT = 66,
  MIX_SIGNATURE = 70,
  MIX_VERSION = 71,
  MIX_TRUNCATED = 72,
  MIX_STRUCTURE = 73,
  MIX_CHECKSUM = 74,
  AUTHOR_MESH = 80,
  AUTHOR_REFUSED = 81,
  AUTHOR_CANCELED = 82,
}

api.Layer = {
  UNKNOWN = 0,
  DESCRIPTOR = 1,
  DEFINITION = 2,
  BEHAVIOR = 4,
  GEOMETRY = 8,
  MACHINE_LEARNED_BEHAVIOR = 16,
  RBF_BEHAVIOR = 32,
  JOINT_BEHAVIOR_METADATA = 64,
  TWIST_SWING_BEHAVIOR = 128,
  ALL = 255,
}

api.UnknownLayers = {
  KEEP = 0,
  DROP = 1,
}

api.FileAccess = {
  MAP = 0,
  READ = 1,
}

api.TranslationUnit = {
  CENTIMETERS = 0,
  METERS = 1,
}

api.RotationUnit = {
  DEGREES = 0,
  RADIANS = 1,
}

api.Direction = {
  LEFT = 0,
  RIGHT = 1,
  UP = 2,
  DOWN = 3,
  FRONT = 4,
  BACK = 5,
}

api.RotationSequence = {
  XYZ = 0,
  XZY = 1,
  YXZ = 2,
  YZX = 3,
  ZXY = 4,
  ZYX = 5,
}

api.FaceWinding = {
  OUTWARD = 0,
  INWARD = 1,
}

api.RotationRule = {
  CARRIED = 0,
  EXACT = 1,
  PER_COLUMN = 2,
}

api.FieldType = {
  RECORD = 0,
  LIST = 1,
  STRING = 2,
  U8 = 3,
  U16 = 4,
  U32 = 5,
  I32 = 6,
  F32 = 7,
}

api.Severity = {
  ERROR = 0,
  WARNING = 1,
}

api.Isa = {
  BEST = 0,
  SCALAR = 1,
  SSE2 = 2,
  AVX2 = 3,
  AVX512 = 4,
  NEON = 5,
  ENVIRONMENT = 1000,
}

api.RotationOutput = {
  EULER = 0,
  QUATERNION = 1,
}

api.MlMasks = {
  SWITCH = 0,
  BLEND = 1,
}

api.Storage = {
  BIT_32 = 0,
  BIT_16 = 1,
}

api.Arithmetic = {
  FAST = 0,
  PORTABLE = 1,
}

api.Reuse = {
  UNCHANGED = 0,
  NOTHING = 1,
  SUMS = 2,
}

api.Kind = {
  GUI_CONTROL = 0,
  RAW_CONTROL = 1,
  PSD_CONTROL = 2,
  ML_CONTROL = 3,
  RBF_CONTROL = 4,
  JOINT = 5,
  BLEND_SHAPE_CHANNEL = 6,
  ANIMATED_MAP = 7,
  MESH = 8,
  ML_MASK = 9,
  JOINT_GROUP = 10,
  RBF_SOLVER = 11,
  TWIST_SWING = 12,
}

api.Stage = {
  ML = 1,
  RBF = 2,
  PSD = 4,
  JOINTS = 8,
  BLEND_SHAPES = 16,
  ANIMATED_MAPS = 32,
  ALL = 63,
}

api.Compose = {
  PRODUCT = 0,
  EULER_ADD = 1,
}

api.Weights = {
  AS_STORED = 0,
  FIX = 1,
}

api.Normals = {
  DEFAULT = 0,
  NONE = 1,
  SKINNED = 2,
  RECOMPUTED = 3,
}

api.VertexFormat = {
  FLOAT32X3 = 0,
  FLOAT32X4 = 1,
  SNORM16X4 = 2,
  SNORM10_10_10_2 = 3,
}

api.Point = {
  GUI = 0,
  RAW = 1,
  CONTROLS = 2,
  JOINTS = 3,
  LOCALS = 4,
  MODELS = 5,
  SKINS = 6,
  POSITIONS = 7,
  CHANNELS = 8,
  MAPS = 9,
}

api.BakedCheck = {
  SAFE = 0,
  FULL = 1,
}

api.Looping = {
  DEFAULT = 0,
  CLAMP = 1,
  WRAP = 2,
}

api.Interpolation = {
  LINEAR = 0,
  STEP = 1,
  CATMULL_ROM = 2,
}

api.LayerGroup = {
  BASE = 0,
  SPEECH = 1,
  EMOTION = 2,
  REACTION = 3,
  LIFE = 4,
}

api.BlendMode = {
  OVERRIDE = 0,
  ADD = 1,
  SCREEN = 2,
  MAX = 3,
  SCALE = 4,
}

api.LayerSource = {
  CLIP = 0,
  POSES = 1,
  STREAM = 2,
  GENERATOR = 3,
}

api.Generator = {
  BLINK = 0,
  BREATH = 1,
  NOISE = 2,
  GAZE = 3,
}

api.Retrigger = {
  EXTEND = 0,
  RESTART = 1,
  IGNORE = 2,
}

api.Guard = {
  LIPS = 1,
  LIDS = 2,
  TEETH = 4,
  ALL = 7,
}

api.Transition = {
  INERTIAL = 0,
  CROSSFADE = 1,
  CUT = 2,
}

api.NameMatch = {
  NONE = 0,
  AS_WRITTEN = 1,
  SPELLING = 2,
  ALIAS = 3,
  BOTH_SIDES = 4,
  EXPRESSION = 5,
}

api.Preset = {
  TINY = 0,
  SMALL = 1,
  MEDIUM = 2,
  LARGE = 3,
  BODY = 4,
  HEAD = 5,
  METAHUMAN_HEAD = 6,
  METAHUMAN_BODY = 7,
  ARCHETYPE = 8,
}

api.Generate = {
  ML = 1,
}

api.BoneKind = {
  ROOT = 0,
  NECK = 1,
  HEAD = 2,
  FACE = 3,
  FACIAL = 4,
  JAW = 5,
  EYE = 6,
  CHEST = 7,
  TONGUE = 8,
}

api.Symmetry = {
  AUTO = 0,
  ON = 1,
  OFF = 2,
}

api.MeshAxis = {
  DEFAULT = 0,
  X = 1,
  Y = 2,
  Z = 3,
  MINUS_X = 4,
  MINUS_Y = 5,
  MINUS_Z = 6,
}

api.AuthorFlags = {
  PAPER = 1,
  NO_NECK_CUT = 2,
  MASK_FROM_SHAPES = 4,
  AREA_DENSITY = 8,
  NO_TARGETS = 16,
  GROUP_IN_SPACE = 32,
  METAHUMAN_NAMES = 64,
}

api.Match = {
  SURFACE = 0,
  UV = 1,
}

api.FitConstraintKind = {
  JOINT_POSITION = 0,
  JOINT_DIRECTION = 1,
  JOINT_AIM = 2,
  POINT_POSITION = 3,
  POINT_DISTANCE = 4,
}

api.FitStatus = {
  CONVERGED = 0,
  ITERATIONS = 1,
  TIME = 2,
  CANCELED = 3,
  NO_DATA = 4,
}

-- Bytes of each struct where pointers have 64 bits, to compare with ffi.sizeof().
api.sizes = {
  MienError = 256,
  MienAllocator = 24,
  MienParallelFor = 16,
  MienStringView = 16,
  MienFloatView = 16,
  MienMutableFloatView = 16,
  MienIndex16View = 16,
  MienIndex32View = 16,
  MienStream = 24,
  MienCoordinateSystem = 56,
  MienDnaDesc = 48,
  MienDnaInfo = 160,
  MienDnaLayer = 48,
  MienDnaField = 32,
  MienWriteDesc = 16,
  MienFinding = 56,
  MienValidateDesc = 16,
  MienRigDesc = 40,
  MienRigInfo = 88,
  MienRigStatistics = 56,
  MienInstanceDesc = 16,
  MienInstanceStatistics = 40,
  MienBatchDesc = 24,
  MienDeformerDesc = 48,
  MienDeformerInfo = 64,
  MienMesh = 152,
  MienDeformerInstanceDesc = 24,
  MienVertexStream = 16,
  MienVertexOutput = 64,
  MienDerivativesDesc = 24,
  MienJacobianDesc = 64,
  MienJacobianPattern = 64,
  MienBakedDesc = 24,
  MienBakedInfo = 48,
  MienBakedRigDesc = 24,
  MienBakedDeformerDesc = 24,
  MienClipEvent = 32,
  MienClipDesc = 88,
  MienClipOpenDesc = 24,
  MienClipInfo = 88,
  MienClipChannel = 64,
  MienClipPlayerDesc = 48,
  MienClipPlayerInfo = 32,
  MienMatrixEntry = 40,
  MienClipBindingDesc = 32,
  MienClipBindingInfo = 72,
  MienMixLayer = 88,
  MienMixPose = 24,
  MienMixStroke = 56,
  MienMixReaction = 64,
  MienMixAntagonists = 8,
  MienLandmark = 16,
  MienMixGuard = 48,
  MienMixDesc = 168,
  MienMixOpenDesc = 16,
  MienMixInfo = 48,
  MienMixGuardInfo = 64,
  MienGazeDesc = 32,
  MienGazeTarget = 12,
  MienGazeInfo = 40,
  MienGazeRest = 8,
  MienMixerDesc = 32,
  MienPlayDesc = 56,
  MienGuardState = 64,
  MienMixerInfo = 24,
  MienMixerClip = 24,
  MienAimSolver = 56,
  MienSpaceSolver = 32,
  MienSpringSolver = 32,
  MienTwistSolver = 40,
  MienCopySolver = 28,
  MienSolverPose = 56,
  MienSolverCall = 32,
  MienUserSolver = 64,
  MienSolver = 64,
  MienSolverStackDesc = 40,
  MienSolverStackInfo = 32,
  MienSolverStateDesc = 16,
  MienSolverInput = 24,
  MienControlShare = 8,
  MienGenerateDesc = 32,
  MienAuthorObject = 24,
  MienAuthorShape = 40,
  MienAuthorMesh = 112,
  MienAuthorBone = 48,
  MienAuthorLandmark = 40,
  MienAuthorLod = 24,
  MienAuthorDesc = 240,
  MienDocumentDesc = 24,
  MienPrunedTargets = 24,
  MienPruneJointsDesc = 24,
  MienPrunedJoints = 48,
  MienPlacement = 64,
  MienProjectDesc = 24,
  MienConformed = 24,
  MienTransplantDesc = 16,
  MienControlError = 32,
  MienByteSink = 16,
  MienSolvePoint = 28,
  MienFitDesc = 104,
  MienFitSurfaceDesc = 48,
  MienFitCamera = 64,
  MienFitConstraint = 52,
  MienFitFrame = 184,
  MienFitResult = 176,
}

-- The function that releases a handle.
api.destroy = {
  MienDna = "mien_dna_close",
  MienReport = "mien_report_destroy",
  MienRig = "mien_rig_destroy",
  MienInstance = "mien_instance_destroy",
  MienBatch = "mien_batch_destroy",
  MienDeformer = "mien_deformer_destroy",
  MienDeformerInstance = "mien_deformer_instance_destroy",
  MienDerivatives = "mien_derivatives_destroy",
  MienJacobian = "mien_jacobian_destroy",
  MienBaked = "mien_baked_close",
  MienClip = "mien_clip_close",
  MienClipPlayer = "mien_clip_player_destroy",
  MienClipBinding = "mien_clip_binding_destroy",
  MienMix = "mien_mix_destroy",
  MienGaze = "mien_gaze_destroy",
  MienMixer = "mien_mixer_destroy",
  MienSolverStack = "mien_solver_stack_destroy",
  MienSolverState = "mien_solver_state_destroy",
  MienAuthorReport = "mien_author_report_close",
  MienDocument = "mien_document_destroy",
  MienFit = "mien_fit_destroy",
  MienFitSurface = "mien_fit_surface_destroy",
}

return api
