/* SPDX-License-Identifier: MIT
 *
 * Deformers: joint matrices, blend shapes, skinning, vertex output.
 * The rules of mien.h apply.
 */
#ifndef MIEN_DEFORM_H
#define MIEN_DEFORM_H

#include "rig.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Deformer -------------------------------------------------------------------------------- */

/* The geometry of a DNA and its joint hierarchy, packed for deformation. Immutable.
 *
 *   local    Translate(neutral + delta) * R * Scale(1 + delta), for column vectors. R is either
 *            R(neutral) * R(delta) or the rotation of the summed angles (MIEN_COMPOSE_...). With
 *            quaternion outputs R(delta) is the quaternion, of any length; zero is the identity.
 *   model    model matrix of the parent * local; a root (its own parent) starts at the origin
 *   skin     model * inverse of the model matrix of the neutral pose
 *   vertex   sum over its joints of weight * skin * (neutral position + sum of channel weight *
 *            target delta): linear blend skinning. A vertex without joints is not skinned. Channel
 *            weights below 1e-5 in magnitude count as 0.
 *
 * Joints that a LOD does not list move with their parent. A position is shared by all faces around it;
 * a vertex is a position with texture coordinates and a normal (a layout in DNA files). So a mesh has at
 * least as many vertices as used positions.
 * See docs/deformation.md, 1 "Joint transforms" and 2 "Positions". */
typedef struct MienDeformer MienDeformer;

/* How the neutral rotation of a joint is combined with its delta. */
enum MienCompose {
    MIEN_COMPOSE_PRODUCT = 0,  /* neutral rotation * delta rotation: the delta rotates first */
    MIEN_COMPOSE_EULER_ADD = 1 /* the angles are added; requires MIEN_ROTATION_OUTPUT_EULER. Equals the
                                  product where the neutral rotation is zero. */
};

/* Treatment of skin weights. */
enum MienWeights {
    MIEN_WEIGHTS_AS_STORED = 0,
    MIEN_WEIGHTS_FIX = 1 /* drop negative weights and divide the others by their sum */
};

/* Normals of deformed meshes; they have unit length. Where no normal can be computed (no faces, or faces
 * without area), the neutral one is used. See docs/deformation.md, 3 "Normals". */
enum MienNormals {
    MIEN_NORMALS_DEFAULT = 0,    /* as MienDeformerDesc.normals says; in that field: recomputed */
    MIEN_NORMALS_NONE = 1,       /* leave normals unchanged */
    MIEN_NORMALS_SKINNED = 2,    /* neutral normals rotated by the skinning, correct for any scale;
                                    blend shape targets have no effect */
    MIEN_NORMALS_RECOMPUTED = 3  /* the area-weighted mean of the normals of the faces around the
                                    position. On hard edges, where this differs from the stored normal
                                    by more than 30 degrees in the neutral pose, the stored normal is
                                    rotated by the rotation of this mean from the neutral pose. */
};

/* Options of a deformer. */
typedef struct MienDeformerDesc {
    size_t struct_size;
    uint32_t isa;     /* MIEN_ISA_...; MIEN_ISA_BEST is that of the rig */
    uint32_t compose; /* MIEN_COMPOSE_... */
    uint32_t weights; /* MIEN_WEIGHTS_... */
    uint32_t normals; /* MIEN_NORMALS_...: what MIEN_NORMALS_DEFAULT means for this deformer */
    uint32_t with_tangents; /* boolean: compute tangents, for mien_deformer_instance_write_vertices() */
    uint32_t storage;       /* MIEN_STORAGE_... of blend shape deltas, skin weights, texture coordinates and
                               triangles. With 16 bits these are integers with scales, and triangles follow
                               from faces. See docs/deformation.md, 2.1 "16-bit storage" */
    const MienAllocator* allocator;
    double delta_error;     /* largest rounding error of a coordinate of a delta that 16-bit storage may make
                               to store deltas with 10 bits, in translation units. 0: 2^-18 of the size of the
                               mesh, which is also the least */
} MienDeformerDesc;
MIEN_DEFAULT(MienDeformerDesc, mien_deformer_desc_default)

/* Packs the geometry of a DNA for deformation. `dna` is the one that the rig was created from, or the
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
 * See docs/deformation.md. */
MIEN_CHECKED MienStatus mien_deformer_create(const MienDna* dna, const MienRig* rig,
                                             const MienDeformerDesc* desc, MienDeformer** out_deformer,
                                             MienError* error);

/* Creates a deformer of some positions of one mesh. Position i of that mesh is `positions[i]` of the mesh of
 * `deformer`; it has no vertices or triangles, and all other meshes are empty. Deformed positions have the bits of
 * the whole mesh (with 16-bit storage they may be rounded otherwise), derivatives those of the chosen rows, and both
 * take time for the chosen positions only. `positions` are ascending, `position_count` of them. `deformer` may be
 * destroyed afterwards; the new one keeps its memory. Destroy with mien_deformer_destroy().
 * Fails with MIEN_ERROR_INDEX if there is no such mesh or position, MIEN_ERROR_INVALID_ARGUMENT if positions are not
 * ascending. */
MIEN_CHECKED MienStatus mien_deformer_create_subset(const MienDeformer* deformer, uint32_t mesh,
                                                    const uint32_t* positions, size_t position_count,
                                                    const MienAllocator* allocator,
                                                    MienDeformer** out_deformer, MienError* error);

/* Destroys a deformer. Its instances stay valid; its memory is released with the last of them. */
MIEN_API void mien_deformer_destroy(MienDeformer* deformer);

/* Properties of a deformer. */
typedef struct MienDeformerInfo {
    size_t struct_size;
    uint32_t isa;            /* MIEN_ISA_... in use, never MIEN_ISA_BEST */
    uint32_t compose;        /* MIEN_COMPOSE_... */
    uint32_t weights;        /* MIEN_WEIGHTS_... */
    uint32_t normals;        /* MIEN_NORMALS_..., never MIEN_NORMALS_DEFAULT */
    uint32_t lod_count;
    uint32_t joint_count;
    uint32_t channel_count;
    uint32_t mesh_count;     /* same as in the rig, which has their names: MIEN_KIND_MESH */
    uint64_t deformer_bytes; /* memory of the deformer, including its part of a baked file */
    uint64_t instance_bytes; /* memory of a deformer instance for all meshes */
    uint32_t storage;        /* MIEN_STORAGE_... */
    uint32_t reserved;       /* 0 */
} MienDeformerInfo;
MIEN_DEFAULT(MienDeformerInfo, mien_deformer_info_default)

/* Returns the properties of a deformer. */
MIEN_CHECKED MienStatus mien_deformer_info(const MienDeformer* deformer, MienDeformerInfo* out_info);

/* A neutral mesh. Its views are valid until the deformer is destroyed. */
typedef struct MienMesh {
    size_t struct_size;
    uint32_t position_count;
    uint32_t vertex_count;
    uint32_t triangle_count;
    uint32_t max_influences;             /* of one position */
    uint32_t target_count;               /* blend shape targets */
    uint32_t delta_count;                /* of all targets */
    uint64_t lods;                       /* bit l: LOD l shows this mesh */
    MienFloatView positions;             /* 3 floats per position: x y z */
    MienFloatView normals;               /* 3 floats per vertex: x y z, unit length */
    MienFloatView tangents;              /* 4 floats per vertex: x y z w, see MienVertexOutput; empty
                                            unless MienDeformerDesc.with_tangents was set */
    MienFloatView texture_coordinates;   /* 2 floats per vertex: u v, as in the file; may be empty with
                                            16-bit storage: see mien_deformer_texture_coordinates() */
    MienIndex32View vertex_position_indices; /* one index per vertex: its position */
    MienIndex32View triangles;           /* 3 indices per triangle: vertices, wound as in the file; faces
                                            with more corners become fans about their first corner. May be
                                            empty with 16-bit storage: see mien_deformer_triangles() */
    MienIndex16View target_channels;     /* one index per target: its blend shape channel; in file
                                            order */
} MienMesh;
MIEN_DEFAULT(MienMesh, mien_mesh_default)

/* Returns a neutral mesh.
 * Fails with MIEN_ERROR_INDEX if there is no such mesh. */
MIEN_CHECKED MienStatus mien_deformer_mesh(const MienDeformer* deformer, uint32_t mesh,
                                           MienMesh* out_mesh);

/* Writes the triangles of a mesh to `out_triangles`: 3 indices per triangle, as in MienMesh.triangles, with any
 * storage. `count` is the capacity of `out_triangles`, in indices. With 16-bit storage takes memory for the
 * duration of the call, 4 bytes per position, from the allocator of the deformer.
 * Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_INVALID_ARGUMENT if `count` is less than
 * 3 * MienMesh.triangle_count, MIEN_ERROR_MEMORY if memory ran out. */
MIEN_CHECKED MienStatus mien_deformer_triangles(const MienDeformer* deformer, uint32_t mesh,
                                                uint32_t* out_triangles, size_t count);

/* Writes the texture coordinates of a mesh to `out_coordinates`: 2 floats per vertex, u v, with any storage. With
 * 16-bit storage they are off by at most 1/131070 of the range of the mesh. `count` is the capacity of
 * `out_coordinates`, in floats.
 * Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_INVALID_ARGUMENT if `count` is less than
 * 2 * MienMesh.vertex_count. */
MIEN_CHECKED MienStatus mien_deformer_texture_coordinates(const MienDeformer* deformer, uint32_t mesh,
                                                          float* out_coordinates, size_t count);

/* Returns the influences of a position, as used for skinning: `out_joints` gets one index per influence,
 * `out_weights` gets one float per influence. There may be none.
 * Fails with MIEN_ERROR_INDEX if there is no such mesh or position, MIEN_ERROR_UNSUPPORTED if the weights
 * are stored with 16 bits (MienDeformerDesc.storage). */
MIEN_CHECKED MienStatus mien_deformer_influences(const MienDeformer* deformer, uint32_t mesh,
                                                 uint32_t position, MienIndex16View* out_joints,
                                                 MienFloatView* out_weights);

/* Writes a blend shape target to `out_deltas`: 3 floats per position, the offset at channel weight 1.
 * Positions that the target does not move get 0. `count` is the capacity of `out_deltas`, in floats.
 * Fails with MIEN_ERROR_INDEX if there is no such mesh or target, MIEN_ERROR_INVALID_ARGUMENT if
 * `count` is less than 3 * MienMesh.position_count. */
MIEN_CHECKED MienStatus mien_deformer_target(const MienDeformer* deformer, uint32_t mesh,
                                             uint32_t target, float* out_deltas, size_t count);

/* Returns the model matrices of the neutral pose: 16 floats per joint, column by column, for column
 * vectors. The last column is the translation, the last row 0 0 0 1. */
MIEN_CHECKED MienStatus mien_deformer_bind_matrices(const MienDeformer* deformer,
                                                    MienFloatView* out_matrices);

/* Returns the inverses of the bind matrices: 16 floats per joint, column by column. */
MIEN_CHECKED MienStatus mien_deformer_inverse_bind_matrices(const MienDeformer* deformer,
                                                            MienFloatView* out_matrices);

/* ---- Deformer instance ----------------------------------------------------------------------- */

/* One character: joint matrices, and positions and normals of its meshes. */
typedef struct MienDeformerInstance MienDeformerInstance;

typedef struct MienDeformerInstanceDesc {
    size_t struct_size;
    uint64_t lods; /* take memory for the meshes of these LODs only: bit l is LOD l. LODs that do not
                      exist are ignored. 0: for all meshes */
    const MienAllocator* allocator;
} MienDeformerInstanceDesc;
MIEN_DEFAULT(MienDeformerInstanceDesc, mien_deformer_instance_desc_default)

/* Creates a deformer instance in the neutral pose: one allocation. `deformer` may be destroyed before
 * it. Destroy with mien_deformer_instance_destroy(). */
MIEN_CHECKED MienStatus mien_deformer_instance_create(const MienDeformer* deformer,
                                                      const MienDeformerInstanceDesc* desc,
                                                      MienDeformerInstance** out_deformer_instance,
                                                      MienError* error);

/* Destroys a deformer instance. */
MIEN_API void mien_deformer_instance_destroy(MienDeformerInstance* deformer_instance);

/* Copies the joint values and channel weights of the last evaluation of `instance`, and computes the
 * matrices of all joints. mien_deformer_instance_deform() then deforms meshes. Values that are
 * not finite give results that are not finite. Does not allocate or lock.
 * Fails with MIEN_ERROR_MISMATCH if `instance` belongs to a rig other than that of the deformer.
 * See docs/deformation.md, 1 "Joint transforms". */
MIEN_CHECKED MienStatus mien_deformer_instance_update(MienDeformerInstance* deformer_instance,
                                                      const MienInstance* instance);

/* Does the same with arrays: `joint_values` like those of mien_instance_joints(), `channel_weights`
 * one per channel. `joint_values` may be NULL with count 0: no deltas. `channel_weights` may be NULL
 * with count 0: all weights are 0. Does not allocate or lock.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if a count is not that of the rig. */
MIEN_CHECKED MienStatus mien_deformer_instance_update_from_values(
    MienDeformerInstance* deformer_instance, const float* joint_values, size_t joint_value_count,
    const float* channel_weights, size_t channel_weight_count);

/* Returns the model matrices: 16 floats per joint, in the layout of mien_deformer_bind_matrices().
 * Contents change with mien_deformer_instance_update(), mien_deformer_instance_update_from_values(). */
MIEN_CHECKED MienStatus mien_deformer_instance_joint_matrices(
    const MienDeformerInstance* deformer_instance, MienFloatView* out_matrices);

/* Returns the skin matrices, for skinning by the caller, for example on a GPU: 16 floats per joint, in
 * the layout of mien_deformer_bind_matrices().
 * Contents change with mien_deformer_instance_update(), mien_deformer_instance_update_from_values(). */
MIEN_CHECKED MienStatus mien_deformer_instance_skin_matrices(
    const MienDeformerInstance* deformer_instance, MienFloatView* out_matrices);

/* Writes the joint transforms of the last update, relative to the parents, to `out_transforms`: 10
 * floats per joint, tx ty tz qx qy qz qw sx sy sz, with quaternions of unit length. `count` is the
 * capacity of `out_transforms`, in floats. Does not allocate or lock.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if `count` is less than 10 * MienDeformerInfo.joint_count. */
MIEN_CHECKED MienStatus mien_deformer_instance_local_transforms(
    const MienDeformerInstance* deformer_instance, float* out_transforms, size_t count);

/* Computes the positions and normals of a mesh for the last update. Runs on the calling thread; meshes
 * of at least 16384 positions run in tasks of about 1024 on `parallel`. `parallel` may be NULL. The
 * results have the same bits either way. Does not allocate or lock. Uses up to 16 KiB of stack per
 * task.
 * Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_LOD if `deformer_instance` has no
 * memory for it (MienDeformerInstanceDesc.lods).
 * See docs/deformation.md, 2 "Positions" and 3 "Normals". */
MIEN_CHECKED MienStatus mien_deformer_instance_deform(MienDeformerInstance* deformer_instance,
                                                      uint32_t mesh, uint32_t normals,
                                                      const MienParallelFor* parallel);

/* Deforms the same mesh of `count` different instances of one deformer. The results are bit-identical to
 * those of mien_deformer_instance_deform(), but each part of the mesh is read only once for all of them,
 * and the total number of positions decides whether tasks are used. `parallel` may be NULL. Does not
 * allocate or lock. Uses up to 16 KiB of stack per task. On failure nothing is deformed.
 * Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_LOD if an instance has no memory for
 * it, MIEN_ERROR_MISMATCH if the instances have different deformers, MIEN_ERROR_INVALID_ARGUMENT if
 * an instance is listed twice. */
MIEN_CHECKED MienStatus mien_deformer_instance_deform_batch(
    MienDeformerInstance* const* deformer_instances, size_t count, uint32_t mesh, uint32_t normals,
    const MienParallelFor* parallel);

/* Returns the deformed positions of a mesh: 3 floats per position, x y z.
 * Contents change with mien_deformer_instance_deform(), mien_deformer_instance_write_vertices() and
 * their batches.
 * Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_LOD if `deformer_instance` has no
 * memory for it. */
MIEN_CHECKED MienStatus mien_deformer_instance_positions(
    const MienDeformerInstance* deformer_instance, uint32_t mesh, MienFloatView* out_positions);

/* Returns the deformed normals of a mesh: 3 floats per vertex, x y z, unit length.
 * Contents change with mien_deformer_instance_deform(), mien_deformer_instance_write_vertices() and
 * their batches.
 * Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_LOD if `deformer_instance` has no
 * memory for it. */
MIEN_CHECKED MienStatus mien_deformer_instance_normals(
    const MienDeformerInstance* deformer_instance, uint32_t mesh, MienFloatView* out_normals);

/* ---- Vertex output --------------------------------------------------------------------------- */

/* Layout of a vertex attribute in memory, in the byte order of the machine. A signed normalized integer
 * of n bits is round(clamp(v, -1, 1) * (2^(n-1) - 1)), ties to even, in two's complement. These are
 * the vertex formats R32G32B32_SFLOAT, R32G32B32A32_SFLOAT, R16G16B16A16_SNORM and
 * A2B10G10R10_SNORM_PACK32 of Vulkan, and float3, float4, short4Normalized and int1010102Normalized of
 * Metal. Direct3D 12 and WebGPU lack the last one. */
enum MienVertexFormat {
    MIEN_VERTEX_FORMAT_FLOAT32X3 = 0,      /* 12 bytes: x y z */
    MIEN_VERTEX_FORMAT_FLOAT32X4 = 1,      /* 16 bytes: x y z w */
    MIEN_VERTEX_FORMAT_SNORM16X4 = 2,      /* 8 bytes: x y z w, 16 bits each */
    MIEN_VERTEX_FORMAT_SNORM10_10_10_2 = 3 /* 4 bytes, one 32-bit word: x in bits 0-9, y in bits 10-19,
                                              z in bits 20-29, w in bits 30-31 */
};

/* One attribute of all vertices: vertex i is written at data + i * stride. `data` and `stride` are
 * multiples of 4; `stride` is at least the size of the format. */
typedef struct MienVertexStream {
    void* data;      /* NULL: the attribute is not written */
    uint32_t stride; /* in bytes */
    uint32_t format; /* MIEN_VERTEX_FORMAT_... */
} MienVertexStream;

/* Where to write the vertices of a mesh, in the order of MienMesh.vertex_position_indices. Streams may
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
 * See docs/deformation.md, 4 "Tangents". */
typedef struct MienVertexOutput {
    size_t struct_size;
    size_t vertex_capacity; /* of each stream: at least MienMesh.vertex_count */
    MienVertexStream positions;
    MienVertexStream normals;
    MienVertexStream tangents; /* requires MienDeformerDesc.with_tangents */
} MienVertexOutput;
MIEN_DEFAULT(MienVertexOutput, mien_vertex_output_default)

/* Deforms a mesh as mien_deformer_instance_deform() does, and writes its vertices to memory of the
 * caller, such as a mapped vertex buffer. Each byte is written once, in the order of the vertices, and
 * none is read, so the memory may be write-combined. Bytes between vertices are left unchanged. `parallel`
 * may be NULL; the bytes are the same either way. The same positions, normals and tangents give the
 * same bytes on every instruction set. Does not allocate or lock. Uses up to 16 KiB of stack per task.
 * On failure nothing is deformed or written.
 * Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_LOD if `deformer_instance` has no
 * memory for it, MIEN_ERROR_INVALID_ARGUMENT if a stream has a format that its attribute cannot have,
 * a wrong stride or alignment or too little capacity, if streams overlap, if there is no stream, or if
 * tangents are requested from a deformer without them.
 * See docs/deformation.md, 5 "Vertex output". */
MIEN_CHECKED MienStatus mien_deformer_instance_write_vertices(MienDeformerInstance* deformer_instance,
                                                              uint32_t mesh, uint32_t normals,
                                                              const MienVertexOutput* output,
                                                              const MienParallelFor* parallel);

/* Does the same for one mesh of `count` different instances of one deformer: instance i is written to
 * outputs[i]. All outputs have the same struct_size, and must not share bytes. `parallel` may be NULL.
 * Does not allocate or lock. Uses up to 16 KiB of stack per task.
 * Fails like mien_deformer_instance_write_vertices(), and with MIEN_ERROR_MISMATCH if the instances have
 * different deformers, MIEN_ERROR_INVALID_ARGUMENT if an instance is listed twice. */
MIEN_CHECKED MienStatus mien_deformer_instance_write_vertices_batch(
    MienDeformerInstance* const* deformer_instances, size_t count, uint32_t mesh, uint32_t normals,
    const MienVertexOutput* outputs, const MienParallelFor* parallel);

#ifdef __cplusplus
}
#endif

#endif /* MIEN_DEFORM_H */
