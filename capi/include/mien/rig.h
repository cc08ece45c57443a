/* SPDX-License-Identifier: MIT
 *
 * Rigs, instances of them, and their evaluation.
 * The rules of mien.h apply.
 */
#ifndef MIEN_RIG_H
#define MIEN_RIG_H

#include "dna.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Rig ------------------------------------------------------------------------------------- */

/* The behavior of a DNA, packed for evaluation. Immutable. */
typedef struct MienRig MienRig;

/* Instruction sets. */
enum MienIsa {
    MIEN_ISA_BEST = 0, /* the best one that the CPU, the operating system and the build support */
    MIEN_ISA_SCALAR = 1,
    MIEN_ISA_SSE2 = 2,
    MIEN_ISA_AVX2 = 3, /* with FMA and F16C */
    MIEN_ISA_AVX512 = 4, /* F, CD, DQ, BW and VL */
    MIEN_ISA_NEON = 5,
    MIEN_ISA_ENVIRONMENT = 1000 /* the one named by the environment variable MIEN_ISA ("scalar",
                                   "sse2", ...); the best one if it is unset or empty */
};

/* Returns 1 if rigs can be created for instruction set `isa` on this machine, else 0. */
MIEN_API uint32_t mien_isa_available(uint32_t isa);

/* Returns "avx2" for MIEN_ISA_AVX2, and so on; "unknown" for unknown numbers. The string is static
 * and null-terminated. */
MIEN_API const char* mien_isa_name(uint32_t isa);

/* How joint values store rotations. */
enum MienRotationOutput {
    MIEN_ROTATION_OUTPUT_EULER = 0,      /* 9 values per joint: tx ty tz rx ry rz sx sy sz */
    MIEN_ROTATION_OUTPUT_QUATERNION = 1  /* 10 values per joint: tx ty tz qx qy qz qw sx sy sz */
};

/* Effect of a region mask on the networks of the region (mien_instance_ml_masks()).
 * See docs/rig-evaluation.md, 8.5 "Region masks". */
enum MienMlMasks {
    MIEN_ML_MASKS_SWITCH = 0, /* 0: the outputs of the networks get their default (0, or 1 for the w of
                                 a quaternion). Other values: the networks are evaluated. This is the
                                 behavior that DNA files are authored for. */
    MIEN_ML_MASKS_BLEND = 1   /* outputs are blended with their default by the mask, clamped to 0..1 */
};

/* How the large arrays that evaluation reads are stored. Sums and results are always 32-bit floats.
 * See docs/rig-evaluation.md, 4.9 "16-bit storage". */
enum MienStorage {
    MIEN_STORAGE_32_BIT = 0,
    MIEN_STORAGE_16_BIT = 1 /* half the memory. Network weights and columns of quaternion joints are IEEE
                               half floats (rounded to nearest even, at most 65504 in magnitude); the
                               joint matrix is 16-bit fixed point, in units of 1/32767 of the largest
                               entry of the row */
};

/* Which instruction sets give bit-identical results. See docs/numbers.md, 5 "Portable arithmetic". */
enum MienArithmetic {
    MIEN_ARITHMETIC_FAST = 0,    /* AVX2, AVX-512 and NEON, which fuse multiply and add, agree with each
                                    other; scalar and SSE2 agree with each other */
    MIEN_ARITHMETIC_PORTABLE = 1 /* all agree, because nothing is fused. A baked rig gives the same bits
                                    on every machine; a rig created from a DNA file does if the C
                                    libraries compute the same sines. */
};

/* What an instance keeps of its last evaluation. With MIEN_REUSE_UNCHANGED and MIEN_REUSE_NOTHING the
 * results are bit-identical. */
enum MienReuse {
    MIEN_REUSE_UNCHANGED = 0, /* results whose inputs have not changed: joint groups, and other stages as a
                                 whole */
    MIEN_REUSE_NOTHING = 1, /* compute everything in each evaluation, for measurements */
    MIEN_REUSE_SUMS = 2 /* also the sums of the joint matrix: where few controls changed, only their
                           differences are added, so such a frame costs little even if these controls move
                           joints everywhere. Joint values then depend on earlier frames: they differ from
                           those of a full evaluation by at most (n + 1539) * 2^-23 * M, before rotations
                           are made from them. n is the number of controls that are not 0, M the sum of
                           the magnitudes of the products that a joint value is the sum of; both are the
                           largest since all sums were last computed, which happens after a reset, after
                           a change of LOD and before 1536 differences were added. Everything else is
                           bit-identical. Rigs and instances take more memory: MienRigInfo.rig_bytes,
                           .instance_bytes */
};

/* Options of a rig. See docs/rig-evaluation.md, 9.4 "Options". */
typedef struct MienRigDesc {
    size_t struct_size;
    uint32_t isa;             /* MIEN_ISA_... */
    uint32_t rotation_output; /* MIEN_ROTATION_OUTPUT_... */
    uint32_t ml_masks;        /* MIEN_ML_MASKS_... */
    uint32_t storage;         /* MIEN_STORAGE_... */
    uint32_t reuse;           /* MIEN_REUSE_... */
    uint32_t arithmetic;      /* MIEN_ARITHMETIC_... */
    const MienAllocator* allocator;
} MienRigDesc;
MIEN_DEFAULT(MienRigDesc, mien_rig_desc_default)

/* Properties of a rig. */
typedef struct MienRigInfo {
    size_t struct_size;
    uint32_t isa;               /* MIEN_ISA_... in use, never MIEN_ISA_BEST */
    uint32_t lod_count;
    uint32_t translation_unit;  /* MIEN_TRANSLATION_UNIT_... */
    uint32_t rotation_unit;     /* MIEN_ROTATION_UNIT_... */
    uint32_t axes[3];           /* MIEN_DIRECTION_... of x, y, z */
    uint32_t rotation_sequence; /* MIEN_ROTATION_SEQUENCE_... */
    int32_t rotation_signs[3];  /* 1 or -1, for the angles about x, y, z */
    uint32_t control_count;     /* length of the control vector: raw, PSD, ML, RBF controls */
    uint32_t joint_value_count; /* 9 or 10 per joint */
    uint32_t rotation_output;   /* MIEN_ROTATION_OUTPUT_... */
    uint32_t storage;           /* MIEN_STORAGE_... */
    uint32_t arithmetic;        /* MIEN_ARITHMETIC_... */
    uint64_t rig_bytes;         /* memory of the rig, including its part of a baked file */
    uint64_t instance_bytes;    /* memory of each instance */
} MienRigInfo;
MIEN_DEFAULT(MienRigInfo, mien_rig_info_default)

/* Packs the behavior of a DNA for evaluation. The rig is one block of memory, or two with
 * MIEN_REUSE_SUMS; temporary memory is released before the call returns. `dna` may be closed afterwards. Destroy with mien_rig_destroy().
 * Fails with MIEN_ERROR_DNA_LAYER if `dna` was opened without its behavior, MIEN_ERROR_DNA_VALUE if
 * correctives depend on each other in a cycle, MIEN_ERROR_DNA_LIMIT if the rig is too large,
 * MIEN_ERROR_ISA if the requested instruction set is not available.
 * See docs/rig-evaluation.md and docs/dna-format.md, 13 "What is checked". */
MIEN_CHECKED MienStatus mien_rig_create(const MienDna* dna, const MienRigDesc* desc, MienRig** out_rig,
                                        MienError* error);

/* Destroys a rig. The handle is invalid afterwards, but instances, batches and deformers of the rig may
 * be destroyed later: its memory is released with the last of them. */
MIEN_API void mien_rig_destroy(MienRig* rig);

/* Returns the properties of a rig. */
MIEN_CHECKED MienStatus mien_rig_info(const MienRig* rig, MienRigInfo* out_info);

/* Kinds of parts of a rig. Most have names. */
enum MienKind {
    MIEN_KIND_GUI_CONTROL = 0,
    MIEN_KIND_RAW_CONTROL = 1,
    MIEN_KIND_PSD_CONTROL = 2, /* correctives; unnamed in DNA files, here "psd0", "psd1", ... */
    MIEN_KIND_ML_CONTROL = 3,
    MIEN_KIND_RBF_CONTROL = 4,
    MIEN_KIND_JOINT = 5,
    MIEN_KIND_BLEND_SHAPE_CHANNEL = 6,
    MIEN_KIND_ANIMATED_MAP = 7,
    MIEN_KIND_MESH = 8,
    MIEN_KIND_ML_MASK = 9,      /* region masks, one per region of each mesh: "mesh/region" */
    MIEN_KIND_JOINT_GROUP = 10, /* without names */
    MIEN_KIND_RBF_SOLVER = 11,  /* without names */
    MIEN_KIND_TWIST_SWING = 12  /* without names: a swing and the twists with the same inputs, or a twist
                                   alone */
};

/* Returns the number of parts of a kind. */
MIEN_CHECKED MienStatus mien_rig_count(const MienRig* rig, uint32_t kind, uint32_t* out_count);

/* Returns a name; "" for kinds without names.
 * Fails with MIEN_ERROR_INDEX if `index` is not below mien_rig_count(). */
MIEN_CHECKED MienStatus mien_rig_name(const MienRig* rig, uint32_t kind, uint32_t index,
                                      MienStringView* out_name);

/* Finds the index of a name by exact match; of equal names, the first. Takes O(log n) time.
 * Fails with MIEN_ERROR_NAME if there is no such name, MIEN_ERROR_INVALID_ARGUMENT if `kind` has no
 * names. */
MIEN_CHECKED MienStatus mien_rig_find(const MienRig* rig, uint32_t kind, const char* name,
                                      uint32_t* out_index);
MIEN_CHECKED MienStatus mien_rig_find_n(const MienRig* rig, uint32_t kind, const char* name,
                                        size_t name_count, uint32_t* out_index);

/* Returns the indices of the joints, blend shape channels, animated maps, meshes or RBF solvers that
 * a LOD lists, in file order.
 * Fails with MIEN_ERROR_LOD if the rig has no such LOD, MIEN_ERROR_INVALID_ARGUMENT if `kind` is not
 * one of these five.
 * See docs/dna-format.md, 8.2 "LOD mappings". */
MIEN_CHECKED MienStatus mien_rig_lod_indices(const MienRig* rig, uint32_t kind, uint32_t lod,
                                             MienIndex16View* out_indices);

/* Returns the indices of the joint values that evaluation may change at a LOD, ascending. All others
 * keep their initial value: 0, or 1 for the w of a quaternion.
 * Fails with MIEN_ERROR_LOD if the rig has no such LOD.
 * See docs/rig-evaluation.md, 4.10 "Which joint values a LOD may change". */
MIEN_CHECKED MienStatus mien_rig_variable_joint_values(const MienRig* rig, uint32_t lod,
                                                       MienIndex16View* out_indices);

/* Returns the parents of the joints, one index per joint. A root is its own parent. */
MIEN_CHECKED MienStatus mien_rig_joint_parents(const MienRig* rig, MienIndex16View* out_parents);

/* Returns the neutral pose, relative to the parents: 9 or 10 floats per joint, in the order of the
 * joint values. The scale is 1.
 * See docs/rig-evaluation.md, 4.2 "Neutral pose". */
MIEN_CHECKED MienStatus mien_rig_neutral_joint_values(const MienRig* rig, MienFloatView* out_values);

/* Returns the controls whose product is corrective `psd`, as indices into the control vector.
 * Fails with MIEN_ERROR_INDEX if there is no such corrective.
 * See docs/rig-evaluation.md, 3.1 "Weights and inputs". */
MIEN_CHECKED MienStatus mien_rig_psd_inputs(const MienRig* rig, uint32_t psd,
                                            MienIndex16View* out_controls);

/* Returns the initial values of the raw controls, one float per raw control: 0, or 1 for the w of a
 * quaternion.
 * See docs/rig-evaluation.md, 1.2 "Initial values". */
MIEN_CHECKED MienStatus mien_rig_initial_raw_controls(const MienRig* rig, MienFloatView* out_values);

#ifdef MIEN_EXPERIMENTAL

/* The work of an evaluation at a LOD when all controls are active. */
typedef struct MienRigStatistics {
    size_t struct_size;
    uint32_t lod;
    uint32_t psd_count;               /* correctives computed */
    uint32_t joint_count;             /* joints of the LOD */
    uint32_t joint_row_count;         /* rows of the joint groups */
    uint32_t blend_shape_count;       /* channels written */
    uint32_t animated_map_row_count;  /* rows of the animated map table */
    uint32_t rbf_solver_count;        /* RBF solvers of the LOD */
    uint32_t quaternion_joint_count;  /* quaternion joints */
    uint64_t joint_entry_count;       /* stored in the joint matrix: 8 per block that is not all zeros */
    uint64_t joint_byte_count;        /* of the joint matrix; an evaluation does not read the columns of
                                         controls that are 0 */
} MienRigStatistics;
MIEN_DEFAULT(MienRigStatistics, mien_rig_statistics_default)

/* Returns the statistics of a LOD.
 * Fails with MIEN_ERROR_LOD if the rig has no such LOD.
 * See docs/rig-evaluation.md, 9.6 "Statistics". */
MIEN_CHECKED MienStatus mien_rig_statistics(const MienRig* rig, uint32_t lod,
                                            MienRigStatistics* out_statistics);

#endif /* MIEN_EXPERIMENTAL */

/* ---- Instance -------------------------------------------------------------------------------- */

/* One character: inputs, and the results of the last evaluation. */
typedef struct MienInstance MienInstance;

typedef struct MienInstanceDesc {
    size_t struct_size;
    const MienAllocator* allocator;
} MienInstanceDesc;
MIEN_DEFAULT(MienInstanceDesc, mien_instance_desc_default)

/* Creates an instance in its initial state: one allocation of MienRigInfo.instance_bytes. `rig` may be
 * destroyed before it. Destroy with mien_instance_destroy().
 * See docs/rig-evaluation.md, 9.2 "Instances". */
MIEN_CHECKED MienStatus mien_instance_create(const MienRig* rig, const MienInstanceDesc* desc,
                                             MienInstance** out_instance, MienError* error);

/* Destroys an instance. */
MIEN_API void mien_instance_destroy(MienInstance* instance);

/* Resets an instance to its initial state: all inputs and results, at LOD 0.
 * See docs/rig-evaluation.md, 1.2 "Initial values". */
MIEN_CHECKED MienStatus mien_instance_reset(MienInstance* instance);

/* Returns the GUI controls for the caller to write: one float per GUI control. Only
 * mien_rig_map_gui_to_raw() reads them.
 * Contents change with mien_rig_map_raw_to_gui(), mien_instance_reset(). */
MIEN_CHECKED MienStatus mien_instance_gui_controls(MienInstance* instance,
                                                   MienMutableFloatView* out_view);

/* Returns the raw controls for the caller to write: one float per raw control, typically 0 to 1, not
 * clamped. They are the inputs of evaluation.
 * Contents change with mien_rig_map_gui_to_raw(), mien_instance_reset(). */
MIEN_CHECKED MienStatus mien_instance_raw_controls(MienInstance* instance,
                                                   MienMutableFloatView* out_view);

/* Returns the region masks for the caller to write: one float per region of each mesh, 0 to 1,
 * initially 1. They switch or blend machine-learned behavior (MIEN_ML_MASKS_...).
 * Contents change with mien_instance_reset().
 * See docs/rig-evaluation.md, 8.5 "Region masks". */
MIEN_CHECKED MienStatus mien_instance_ml_masks(MienInstance* instance,
                                               MienMutableFloatView* out_view);

/* Returns the control vector: one float per control, the raw, PSD, ML and RBF controls in this order.
 * Contents change with evaluation, mien_rig_map_gui_to_raw(), mien_instance_reset() and writes to the raw
 * controls.
 * See docs/rig-evaluation.md, 1.1 "Control vector". */
MIEN_CHECKED MienStatus mien_instance_controls(const MienInstance* instance, MienFloatView* out_view);

/* Returns the PSD controls (correctives) of the control vector: one float per PSD control.
 * Contents change with evaluation, mien_instance_reset(). */
MIEN_CHECKED MienStatus mien_instance_psd_controls(const MienInstance* instance,
                                                   MienFloatView* out_view);

/* Returns the ML controls of the control vector: one float per ML control.
 * Contents change with evaluation, mien_instance_reset(). */
MIEN_CHECKED MienStatus mien_instance_ml_controls(const MienInstance* instance,
                                                  MienFloatView* out_view);

/* Returns the RBF pose controls of the control vector: one float per RBF control.
 * Contents change with evaluation, mien_instance_reset(). */
MIEN_CHECKED MienStatus mien_instance_rbf_controls(const MienInstance* instance,
                                                   MienFloatView* out_view);

/* Returns the joint values: 9 or 10 floats per joint (MIEN_ROTATION_OUTPUT_...), as deltas from the
 * neutral pose. Translation, angles and scale are added to the neutral ones; with quaternions the
 * rotation is neutral * delta, so the delta rotates first.
 * Contents change with evaluation, mien_instance_reset().
 * See docs/rig-evaluation.md, 4.1 "Joint values". */
MIEN_CHECKED MienStatus mien_instance_joints(const MienInstance* instance, MienFloatView* out_view);

/* Returns the weights of the blend shape channels: one float per channel.
 * Contents change with evaluation, mien_instance_reset().
 * See docs/rig-evaluation.md, 5 "Blend shapes and animated maps". */
MIEN_CHECKED MienStatus mien_instance_blend_shapes(const MienInstance* instance,
                                                   MienFloatView* out_view);

/* Returns the weights of the animated maps, 0 to 1: one float per animated map.
 * Contents change with evaluation, mien_instance_reset().
 * See docs/rig-evaluation.md, 5 "Blend shapes and animated maps". */
MIEN_CHECKED MienStatus mien_instance_animated_maps(const MienInstance* instance,
                                                    MienFloatView* out_view);

#ifdef MIEN_EXPERIMENTAL

/* What the joint stage reads for the current controls, at the LOD of the last evaluation (initially
 * LOD 0), if it reuses no results. Each byte is counted once, regardless of CPU caches. */
typedef struct MienInstanceStatistics {
    size_t struct_size;
    uint32_t lod;                  /* of the last evaluation */
    uint32_t control_count;        /* of the control vector: raw, PSD, ML and RBF controls */
    uint32_t active_control_count; /* controls that are not 0 */
    uint32_t joint_column_count;   /* columns of the joint matrix that active controls drive */
    uint64_t joint_entry_count;    /* of these columns: 8 per block */
    uint64_t joint_byte_count;     /* of these entries: at most MienRigStatistics.joint_byte_count */
} MienInstanceStatistics;
MIEN_DEFAULT(MienInstanceStatistics, mien_instance_statistics_default)

/* Returns the statistics of an instance. Takes time proportional to the number of controls: meant for
 * measurements, not for every frame.
 * See docs/rig-evaluation.md, 9.6 "Statistics". */
MIEN_CHECKED MienStatus mien_instance_statistics(const MienInstance* instance,
                                                 MienInstanceStatistics* out_statistics);

#endif /* MIEN_EXPERIMENTAL */

/* ---- Evaluation ------------------------------------------------------------------------------ */

/* Maps GUI controls to raw controls. Raw controls that the rig's table drives are overwritten with
 * values clamped to 0..1; others are left unchanged. Does not allocate or lock.
 * Fails with MIEN_ERROR_MISMATCH if `instance` belongs to another rig.
 * See docs/rig-evaluation.md, 2.3 "GUI controls to raw controls". */
MIEN_CHECKED MienStatus mien_rig_map_gui_to_raw(const MienRig* rig, MienInstance* instance);

/* Maps raw controls to GUI controls. Sets every GUI control to the value that maps to the current raw
 * controls, or to 0 if there is no such value. Does not allocate or lock.
 * Fails with MIEN_ERROR_MISMATCH if `instance` belongs to another rig.
 * See docs/rig-evaluation.md, 2.4 "Raw controls to GUI controls". */
MIEN_CHECKED MienStatus mien_rig_map_raw_to_gui(const MienRig* rig, MienInstance* instance);

/* Evaluates all stages at a LOD. Results that the LOD does not drive have their initial value. Inputs
 * must be finite; then the results are finite too. Changing the LOD between calls is cheap: it resets
 * the results. Does not allocate or lock. Uses up to 48 KiB of stack.
 * Fails with MIEN_ERROR_LOD if the rig has no such LOD, MIEN_ERROR_MISMATCH if `instance` belongs to
 * another rig.
 * See docs/rig-evaluation.md, 1.3 "Order of evaluation". */
MIEN_CHECKED MienStatus mien_rig_evaluate(const MienRig* rig, MienInstance* instance, uint32_t lod);

/* Stages of an evaluation, combined with |. */
enum MienStage {
    MIEN_STAGE_ML = 1,      /* neural networks */
    MIEN_STAGE_RBF = 2,     /* RBF solvers */
    MIEN_STAGE_PSD = 4,     /* correctives */
    MIEN_STAGE_JOINTS = 8,  /* joint groups, then twists and swings, then ML joints */
    MIEN_STAGE_BLEND_SHAPES = 16,
    MIEN_STAGE_ANIMATED_MAPS = 32,
    MIEN_STAGE_ALL = 63
};

/* Evaluates some stages, in the order of enum MienStage. The others keep the results of the last
 * evaluation at this LOD; after a change of LOD they are reset. Does not allocate or lock. Uses up to
 * 48 KiB of stack.
 * Fails with MIEN_ERROR_LOD if the rig has no such LOD, MIEN_ERROR_MISMATCH if `instance` belongs to
 * another rig.
 * See docs/rig-evaluation.md, 9.3 "Partial evaluation". */
MIEN_CHECKED MienStatus mien_rig_evaluate_stages(const MienRig* rig, MienInstance* instance, uint32_t lod,
                                                 uint32_t stages);

/* Scratch memory for evaluating many instances of a rig in one call. */
typedef struct MienBatch MienBatch;

typedef struct MienBatchDesc {
    size_t struct_size;
    uint32_t capacity; /* instances per call: 1 to 2^20. 0: 32 */
    uint32_t tasks;    /* tasks that may run at the same time, each with its own scratch memory.
                          0: 1, for calls without MienParallelFor */
    const MienAllocator* allocator;
} MienBatchDesc;
MIEN_DEFAULT(MienBatchDesc, mien_batch_desc_default)

/* Creates a batch: one allocation of mien_batch_bytes(), which with 16-bit storage includes the weights of
 * networks as floats, 4 bytes each. `rig` may be destroyed before it. Destroy with
 * mien_batch_destroy(). */
MIEN_CHECKED MienStatus mien_batch_create(const MienRig* rig, const MienBatchDesc* desc,
                                          MienBatch** out_batch, MienError* error);

/* Destroys a batch. */
MIEN_API void mien_batch_destroy(MienBatch* batch);

/* Returns the memory that a batch would take. */
MIEN_CHECKED MienStatus mien_batch_bytes(const MienRig* rig, const MienBatchDesc* desc,
                                         uint64_t* out_bytes);

/* Evaluates stages of `count` different instances of one rig; instance i at LOD lods[i]. The results
 * are bit-identical to those of mien_rig_evaluate_stages() (joint values with MIEN_REUSE_SUMS: within the
 * bound of a full evaluation), but columns of the joint matrix that several
 * instances use are read only once for up to 32 of them. Runs on the calling thread, or in tasks
 * on `parallel`; `parallel` may be NULL. Does not allocate or lock. Uses up to 48 KiB of stack per
 * task. On failure no instance is evaluated.
 * Fails with MIEN_ERROR_LOD if the rig has no such LOD, MIEN_ERROR_MISMATCH if the batch or an
 * instance belongs to another rig, MIEN_ERROR_INVALID_ARGUMENT if `count` exceeds
 * MienBatchDesc.capacity or an instance is listed twice.
 * See docs/numbers.md, 10 "One by one, in batches, with reused results". */
MIEN_CHECKED MienStatus mien_rig_evaluate_batch(const MienRig* rig, MienBatch* batch,
                                                MienInstance* const* instances, const uint32_t* lods,
                                                uint32_t count, uint32_t stages,
                                                const MienParallelFor* parallel);

/* Evaluates the joint values of one joint group (MIEN_KIND_JOINT_GROUP), except those that a later
 * group overrides at all LODs where this one sets them. Does not allocate or lock. Uses up to 48 KiB
 * of stack.
 * Fails with MIEN_ERROR_INDEX if there is no such joint group, MIEN_ERROR_LOD if the rig has no such
 * LOD, MIEN_ERROR_MISMATCH if `instance` belongs to another rig.
 * See docs/rig-evaluation.md, 4.5 "Order of the joint stage". */
MIEN_CHECKED MienStatus mien_rig_evaluate_joint_group(const MienRig* rig, MienInstance* instance,
                                                      uint32_t lod, uint32_t group);

/* Evaluates the pose controls of one RBF solver (MIEN_KIND_RBF_SOLVER), even if the LOD does not list
 * it. Does not allocate or lock.
 * Fails with MIEN_ERROR_INDEX if there is no such solver, MIEN_ERROR_LOD if the rig has no such LOD,
 * MIEN_ERROR_MISMATCH if `instance` belongs to another rig.
 * See docs/rig-evaluation.md, 6 "RBF solvers". */
MIEN_CHECKED MienStatus mien_rig_evaluate_rbf_solver(const MienRig* rig, MienInstance* instance,
                                                     uint32_t lod, uint32_t solver);

/* Evaluates the joints of one twist and swing setup (MIEN_KIND_TWIST_SWING). Does not allocate or
 * lock.
 * Fails with MIEN_ERROR_INDEX if there is no such setup, MIEN_ERROR_LOD if the rig has no such LOD,
 * MIEN_ERROR_MISMATCH if `instance` belongs to another rig.
 * See docs/rig-evaluation.md, 7 "Twist and swing". */
MIEN_CHECKED MienStatus mien_rig_evaluate_twist_swing(const MienRig* rig, MienInstance* instance,
                                                      uint32_t lod, uint32_t setup);

#ifdef __cplusplus
}
#endif

#endif /* MIEN_RIG_H */
