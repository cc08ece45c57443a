/* SPDX-License-Identifier: MIT
 *
 * Derivatives of joint values, matrices and positions with respect to controls, forward and in reverse. The
 * rules of mien.h apply.
 */
#ifndef MIEN_DERIVATIVES_H
#define MIEN_DERIVATIVES_H

#include "deform.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Derivatives ----------------------------------------------------------------------------- */

/* Points on the way from controls to positions:
 *
 *     GUI -> RAW -> CONTROLS -> JOINTS -> LOCALS -> MODELS -> SKINS -> POSITIONS
 *                       |-> CHANNELS ------------------------------------^
 *                       |-> MAPS
 *
 * Derivatives lead from one point to a later one that depends on it. Networks, RBF solvers and correctives
 * run between RAW and CONTROLS; the joint stage, channels and maps read CONTROLS. From JOINTS on, channel
 * weights are constant. See docs/derivatives.md. */
enum MienPoint {
    MIEN_POINT_GUI = 0,       /* GUI controls */
    MIEN_POINT_RAW = 1,       /* raw controls */
    MIEN_POINT_CONTROLS = 2,  /* all controls: mien_instance_controls() */
    MIEN_POINT_JOINTS = 3,    /* joint values: mien_instance_joints() */
    MIEN_POINT_LOCALS = 4,    /* 16 floats per joint: matrix relative to the parent, four columns */
    MIEN_POINT_MODELS = 5,    /* the same, in model space: mien_deformer_instance_joint_matrices() */
    MIEN_POINT_SKINS = 6,     /* the same, of skin matrices: mien_deformer_instance_skin_matrices() */
    MIEN_POINT_POSITIONS = 7, /* x y z per position of a mesh, in the order of the file */
    MIEN_POINT_CHANNELS = 8,  /* blend shape channel weights */
    MIEN_POINT_MAPS = 9       /* animated map weights */
};

/* Derivatives of one rig, and the memory to compute them. Belongs to one thread at a time. */
typedef struct MienDerivatives MienDerivatives;

/* How to create derivatives. */
typedef struct MienDerivativesDesc {
    size_t struct_size;
    const MienDeformer* deformer;   /* of the rig. NULL: none, and no points from LOCALS to
                                       POSITIONS */
    const MienAllocator* allocator; /* NULL: the heap */
} MienDerivativesDesc;
MIEN_DEFAULT(MienDerivativesDesc, mien_derivatives_desc_default)

/* Creates derivatives. `desc` may be NULL. `rig` may be destroyed afterwards, and so may the deformer.
 * Takes one block of memory, which holds a copy of the weights of networks, room for 32 directions, and 8
 * bytes for each 8 numbers of the joint matrix.
 * Destroy with mien_derivatives_destroy().
 * Fails with MIEN_ERROR_MISMATCH if the deformer is not of the rig. */
MIEN_CHECKED MienStatus mien_derivatives_create(const MienRig* rig, const MienDerivativesDesc* desc,
                                                MienDerivatives** out_derivatives, MienError* error);

/* Destroys derivatives. NULL is allowed. */
MIEN_API void mien_derivatives_destroy(MienDerivatives* derivatives);

/* Returns the number of bytes that mien_derivatives_create() would allocate.
 * Fails with MIEN_ERROR_MISMATCH if the deformer is not of the rig. */
MIEN_CHECKED MienStatus mien_derivatives_bytes(const MienRig* rig, const MienDerivativesDesc* desc,
                                               uint64_t* out_bytes);

/* Returns how many numbers a point has. `mesh` is the index of the mesh of MIEN_POINT_POSITIONS, else 0.
 * Fails with MIEN_ERROR_INDEX if there is no such mesh, or the point needs a deformer and there is none. */
MIEN_CHECKED MienStatus mien_derivatives_size(const MienDerivatives* derivatives, uint32_t point,
                                              uint32_t mesh, size_t* out_size);

/* Computes the derivatives at the values of `instance`, which must belong to the rig and have been
 * evaluated, alone or in a batch, at the LOD of that evaluation. `stages` selects the stages to differentiate, MIEN_STAGE_ALL or
 * some of them: the results of the others count as constants. Does not allocate or lock.
 * Where a function has no derivative, a one-sided one is used, so that solvers do not get stuck:
 *   - controls at 0 or 1, for correctives, GUI controls and maps: into the interval
 *   - where two intervals of a conditional table meet: that of the steeper one
 *   - RBF poses with a weight below the threshold: as without a threshold; at a stored pose: 0
 *   - ReLU at 0: as above 0
 * Saturation is ignored: values that overflow have the derivatives of the formula. Controls that a network
 * or solver reads before they are computed count as constants.
 * Fails with MIEN_ERROR_MISMATCH if the instance is not of the rig. */
MIEN_CHECKED MienStatus mien_derivatives_linearize(MienDerivatives* derivatives,
                                                   const MienInstance* instance, uint32_t stages);

/* Multiplies directions by the matrix of derivatives (Jacobian-vector products). Each of the `count`
 * directions is a row of mien_derivatives_size() numbers at `from`; its output is the resulting change of
 * the numbers at `to`. Rows follow each other without gaps; `outputs` has `count` rows and must not overlap
 * `directions`. Several directions in one call are faster than one by one, and give the same bits. Does not
 * allocate or lock.
 * Fails with MIEN_ERROR_INDEX if a point lacks its deformer or mesh, MIEN_ERROR_INVALID_ARGUMENT if `from`
 * has no effect on `to` or nothing was linearized. */
MIEN_CHECKED MienStatus mien_derivatives_forward(MienDerivatives* derivatives, uint32_t from, uint32_t to,
                                                 uint32_t mesh, uint32_t count, const float* directions,
                                                 float* outputs);

/* Multiplies gradients by the transposed matrix (vector-Jacobian products): turns each of `count` gradients
 * with respect to the numbers at `to` into the gradient with respect to those at `from`. All else is as in
 * mien_derivatives_forward().
 * Fails with MIEN_ERROR_INDEX if a point lacks its deformer or mesh, MIEN_ERROR_INVALID_ARGUMENT if `from`
 * has no effect on `to` or nothing was linearized. */
MIEN_CHECKED MienStatus mien_derivatives_reverse(MienDerivatives* derivatives, uint32_t from, uint32_t to,
                                                 uint32_t mesh, uint32_t count, const float* gradients,
                                                 float* outputs);

/* The sparse matrix of the derivatives of chosen numbers at one point, its rows, with respect to chosen
 * numbers at an earlier one, its columns: which entries may be other than 0 in some pose, and which columns
 * have no row in common, so that one direction computes them together (docs/derivatives.md, 9). Never
 * changes. */
typedef struct MienJacobian MienJacobian;

/* Which matrix. */
typedef struct MienJacobianDesc {
    size_t struct_size;
    uint32_t from_point;            /* MIEN_POINT_...: of the columns */
    uint32_t to_point;              /* MIEN_POINT_...: of the rows */
    uint32_t mesh;                  /* the mesh of MIEN_POINT_POSITIONS, else 0 */
    uint32_t lod;                   /* of the evaluations: entries that other LODs add are left out */
    const uint32_t* inputs;         /* numbers at from_point, one per column. NULL: all */
    const uint32_t* outputs;        /* numbers at to_point, one per row, ascending. NULL: all */
    size_t input_count;             /* 0 if `inputs` is NULL */
    size_t output_count;            /* 0 if `outputs` is NULL */
    const MienAllocator* allocator; /* NULL: the heap */
} MienJacobianDesc;
MIEN_DEFAULT(MienJacobianDesc, mien_jacobian_desc_default)

/* The entries of a matrix: by column, then by row. */
typedef struct MienJacobianPattern {
    size_t struct_size;
    MienIndex32View rows;     /* of each entry: a place in MienJacobianDesc.outputs, or a number at to_point */
    MienIndex32View columns;  /* of each entry: a place in MienJacobianDesc.inputs, or a number at
                                 from_point */
    size_t row_count;         /* rows and columns of the matrix, with or without entries */
    size_t column_count;
    size_t direction_count;   /* directions that compute all columns: the colors of a coloring */
} MienJacobianPattern;
MIEN_DEFAULT(MienJacobianPattern, mien_jacobian_pattern_default)

/* Creates a matrix for derivatives that have the rig and the deformer of `derivatives`, linearized or not.
 * `derivatives` may be destroyed afterwards. The matrix takes one block of memory: 8 bytes per entry, 4 per
 * row, 20 per column. More is needed until the call returns: 4 bytes per row, 12 per column, and 8 for each
 * number on the way (controls, joint values, matrices, results of networks, positions of the mesh).
 * Destroy with mien_jacobian_destroy().
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if from_point has no effect on to_point or the outputs do not
 * ascend, MIEN_ERROR_INDEX if a point lacks its deformer or mesh, or an input or output does not exist,
 * MIEN_ERROR_LOD if the rig has no such LOD. */
MIEN_CHECKED MienStatus mien_jacobian_create(const MienDerivatives* derivatives,
                                             const MienJacobianDesc* desc, MienJacobian** out_jacobian,
                                             MienError* error);

/* Destroys a matrix. NULL is allowed. */
MIEN_API void mien_jacobian_destroy(MienJacobian* jacobian);

/* Returns the entries. They are the same in all poses, so a solver can order and factor the matrix
 * symbolically once. The views are valid until the matrix is destroyed. */
MIEN_CHECKED MienStatus mien_jacobian_pattern(const MienJacobian* jacobian,
                                              MienJacobianPattern* out_pattern);

/* Computes the entries of a matrix at the values that were linearized: `values` gets a float per entry of
 * the pattern, of which some may be 0. Each is equal to what mien_derivatives_forward() computes for a
 * direction that is 1 at the number of its column, else 0. `wanted` may be NULL: all columns; otherwise it
 * has a byte per column, and entries of columns with a 0 are not computed and keep their values. Threads may
 * use one matrix at the same time, each with derivatives of its own. Does not allocate or lock.
 * Fails with MIEN_ERROR_MISMATCH if the matrix was created for another rig or deformer, or the values were
 * linearized at another LOD, MIEN_ERROR_INVALID_ARGUMENT if nothing was linearized, `value_count` is not
 * the number of entries, or `wanted_count` not that of columns (0 if `wanted` is NULL). */
MIEN_CHECKED MienStatus mien_derivatives_jacobian(MienDerivatives* derivatives,
                                                  const MienJacobian* jacobian, const uint8_t* wanted,
                                                  size_t wanted_count, float* values,
                                                  size_t value_count);

#ifdef __cplusplus
}
#endif

#endif
