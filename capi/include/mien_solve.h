/* SPDX-License-Identifier: MIT
 *
 * The public C interface of libmien-solve: finds the controls of a rig that give captured joints, vertices or
 * landmarks. It uses only the public interface of libmien.
 *
 * The rules of mien.h apply. docs/solving.md has the formulas.
 */
#ifndef MIEN_SOLVE_LIBRARY_H
#define MIEN_SOLVE_LIBRARY_H

#include "mien.h"

#if defined(_WIN32) && defined(MIEN_SOLVE_BUILD) && !defined(MIEN_STATIC)
#define MIEN_SOLVE_API __declspec(dllexport)
#else
#define MIEN_SOLVE_API MIEN_API
#endif

/* Like MIEN_CHECKED in mien.h. */
#if defined(__cplusplus) && __cplusplus >= 201703L
#define MIEN_SOLVE_CHECKED [[nodiscard]] MIEN_SOLVE_API
#elif defined(__STDC_VERSION__) && __STDC_VERSION__ >= 202311L
#define MIEN_SOLVE_CHECKED [[nodiscard]] MIEN_SOLVE_API
#else
#define MIEN_SOLVE_CHECKED MIEN_SOLVE_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* A point of a surface: the weighted sum of three positions of a mesh. One position: weights 1 0 0. */
typedef struct MienSolvePoint {
    uint32_t mesh;         /* all points of a fit are of the same mesh */
    uint32_t positions[3]; /* in the order of the file */
    float weights[3];
} MienSolvePoint;

/* One rig, what is to be met, and the memory to solve. Needed by one thread at a time; for several threads
 * make one for each. */
typedef struct MienFit MienFit;

/* How to create a fit. Everything is copied. */
typedef struct MienFitDesc {
    size_t struct_size;
    const MienDeformer* deformer;  /* of the rig; needed for points. NULL: joints only */
    const uint32_t* controls;      /* raw controls that may move, ascending. NULL: all */
    const float* lower;            /* bounds of these controls. NULL: 0 */
    const float* upper;            /* NULL: 1 */
    const uint32_t* symmetric;     /* pairs of raw controls that tend to be equal: left, right, left, ... */
    const MienSolvePoint* points;
    const float* joint_weights;    /* per joint value, 0 or more. NULL: 1 each, or 0 if there are points */
    size_t control_count;          /* 0 if `controls` is NULL */
    size_t symmetric_count;        /* numbers, an even number of them */
    size_t point_count;
    uint32_t lod;
    uint32_t reserved;             /* 0 */
    const MienAllocator* allocator; /* NULL: the heap */
} MienFitDesc;
MIEN_DEFAULT(MienFitDesc, mien_fit_desc_default)

/* Creates a fit. `desc` is required. `rig` must outlive the fit; the deformer may be destroyed. Measures what
 * each control moves, which takes up to some seconds for large rigs. Destroy with mien_fit_destroy().
 * Fails with MIEN_ERROR_INDEX if a control, position or mesh does not exist, MIEN_ERROR_LOD,
 * MIEN_ERROR_MISMATCH if the deformer is not of the rig, MIEN_ERROR_INVALID_ARGUMENT if controls are not
 * ascending, bounds are the wrong way round, a weight is not finite, or points are of several meshes. */
MIEN_SOLVE_CHECKED MienStatus mien_fit_create(const MienRig* rig, const MienFitDesc* desc, MienFit** out_fit,
                                        MienError* error);

/* Destroys a fit. NULL is allowed. */
MIEN_SOLVE_API void mien_fit_destroy(MienFit* fit);

/* A pinhole camera: image x = focal[0] * x / z + center[0], y likewise; with x y z of a point after
 * `rotation` and `translation`, z in front of the camera. */
typedef struct MienFitCamera {
    float focal[2];
    float center[2];
    float rotation[9]; /* rows, from model space */
    float translation[3];
} MienFitCamera;

/* How the end of a solve is to be understood. */
enum MienFitStatus {
    MIEN_FIT_CONVERGED = 0,  /* further steps change nothing */
    MIEN_FIT_ITERATIONS = 1, /* the limit of iterations was reached; the best controls so far */
    MIEN_FIT_TIME = 2,       /* the limit of time was reached; likewise */
    MIEN_FIT_CANCELED = 3,   /* the caller asked to stop; likewise */
    MIEN_FIT_NO_DATA = 4     /* nothing to meet: no target, or all missing; the start is returned */
};

/* What is to be met in one frame, and how. Zero means that a term is left out. */
typedef struct MienFitFrame {
    size_t struct_size;
    const float* joints;         /* joint values. NULL: none. NaN: missing */
    const float* points;         /* x y z per point. NULL: none. NaN: missing */
    const float* images;         /* x y per point, as `camera` sees them. NULL: none. NaN: missing */
    const MienFitCamera* camera; /* required with `images` */
    const float* point_weights;  /* per point, 0 or more. NULL: 1 */
    const float* start;          /* raw controls to start from, all of the rig. NULL: the initial ones */
    const float* prior;          /* raw controls that the result tends to. NULL: the initial ones */
    float prior_weight;          /* times the squared distance to `prior` */
    float smooth_weight;         /* times the squared distance to `start`, the frame before */
    float sparse_weight;         /* times the sum of magnitudes: few controls explain the frame */
    float symmetric_weight;      /* times the squared differences of symmetric pairs */
    float robust_scale;          /* residuals of points far beyond this length count little. 0: all count */
    float joint_weight;          /* of joints besides points. 0: 1 */
    uint32_t rigid;              /* boolean: `points` may be moved rigidly to fit */
    uint32_t max_iterations;     /* 0: 50 */
    double max_seconds;          /* 0: no limit. A limit makes results depend on the machine */
    void* user;                  /* passed to `canceled` */
    /* Called before each iteration; nonzero stops. NULL: never. */
    uint32_t(MIEN_CALLBACK* canceled)(void* user);
} MienFitFrame;
MIEN_DEFAULT(MienFitFrame, mien_fit_frame_default)

/* How well a frame was met. */
typedef struct MienFitResult {
    size_t struct_size;
    uint32_t status;         /* MIEN_FIT_... */
    uint32_t iterations;
    double cost;             /* what was minimized, with all terms */
    double joint_residual;   /* root of the mean square of joint values, weighted */
    double point_residual;   /* the same of distances of points, or of images in their unit */
    uint32_t missing_points;
    uint32_t reserved;
    float rotation[9];       /* rows: points of the target = rotation * model + translation, if rigid */
    float translation[3];
} MienFitResult;
MIEN_DEFAULT(MienFitResult, mien_fit_result_default)

/* Finds the raw controls of a frame by bounded Gauss-Newton steps with Levenberg-Marquardt damping. Writes
 * all raw controls of the rig to `out_raw`; those that may not move keep their start. `result` may be NULL.
 * Deterministic unless there is a time limit. Allocates nothing.
 * Fails with MIEN_ERROR_NULL_ARGUMENT if points are given to a fit without points, or images without a
 * camera, MIEN_ERROR_INVALID_ARGUMENT if a weight is negative or not finite. */
MIEN_SOLVE_CHECKED MienStatus mien_fit_solve(MienFit* fit, const MienFitFrame* frame, float* out_raw,
                                       MienFitResult* result);

/* Writes for each raw control how well the fit observes it at its start: 0 if it moves nothing that is met,
 * or only what other controls move too, else up to 1 for the best observed one. `count` is the number of raw
 * controls. */
MIEN_SOLVE_CHECKED MienStatus mien_fit_observability(const MienFit* fit, float* out_values, size_t count);

#ifdef __cplusplus
}
#endif

#endif
