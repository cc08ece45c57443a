/* SPDX-License-Identifier: MIT
 *
 * The public C interface of libmien-solve: finds the controls of a rig that reproduce captured joints,
 * vertices, surfaces or landmarks. It uses only the public interface of libmien.
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
    uint32_t mesh;         /* of the rig; points of a fit may be on several meshes */
    uint32_t positions[3]; /* in the order of the file */
    float weights[3];
} MienSolvePoint;

/* One rig, the joints and points to match, and the memory to solve. Belongs to one thread at a time; use
 * one for each thread. */
typedef struct MienFit MienFit;

/* How to create a fit. Everything is copied. Raw controls in a row that are named as the parts x y z w of a
 * quaternion (.qx .qy .qz .qw, or .x .y .z .w), and begin as 0 0 0 1, are a rotation: if all four may move, they keep
 * the length 1, and have no bounds. */
typedef struct MienFitDesc {
    size_t struct_size;
    const MienDeformer* deformer;  /* of the rig; needed for points and for constraints on joints. NULL: none */
    const uint32_t* controls;      /* raw controls that may move, ascending. NULL: all */
    const float* lower;            /* bounds of these controls. NULL: 0 */
    const float* upper;            /* NULL: 1 */
    const uint32_t* symmetric;     /* pairs of raw controls kept similar: left, right, left, ... */
    const MienSolvePoint* points;
    const float* joint_weights;    /* per joint value, 0 or more. NULL: 1 each, or 0 if there are points */
    size_t control_count;          /* 0 if `controls` is NULL */
    size_t symmetric_count;        /* elements of `symmetric`, an even number */
    size_t point_count;
    uint32_t lod;
    uint32_t reserved;             /* 0 */
    const MienAllocator* allocator; /* NULL: the heap */
} MienFitDesc;
MIEN_DEFAULT(MienFitDesc, mien_fit_desc_default)

/* Creates a fit. `desc` is required. `rig` must outlive the fit; the deformer may be destroyed. Measures
 * the effect of each control, which takes up to some seconds for large rigs. Destroy with
 * mien_fit_destroy().
 * Fails with MIEN_ERROR_INDEX if a control, position or mesh does not exist, MIEN_ERROR_LOD if the rig has no
 * such LOD, MIEN_ERROR_MISMATCH if the deformer belongs to another rig, MIEN_ERROR_INVALID_ARGUMENT if controls are
 * not ascending, a lower bound is above its upper one, or a weight is not finite. */
MIEN_SOLVE_CHECKED MienStatus mien_fit_create(const MienRig* rig, const MienFitDesc* desc, MienFit** out_fit,
                                        MienError* error);

/* Destroys a fit. NULL is allowed. */
MIEN_SOLVE_API void mien_fit_destroy(MienFit* fit);

/* A surface without correspondences: a scan, or a mesh of another topology. Immutable: any threads may use
 * one at the same time. */
typedef struct MienFitSurface MienFitSurface;

/* How to create a surface. Everything is copied. Its unit and axes are those of the rig; triangles may be
 * wound either way, but all the same way. */
typedef struct MienFitSurfaceDesc {
    size_t struct_size;
    const float* positions;    /* x y z each. Positions in the same place are one, as along texture seams */
    const uint32_t* triangles; /* three positions each */
    size_t position_count;
    size_t triangle_count;
    const MienAllocator* allocator; /* NULL: the heap */
} MienFitSurfaceDesc;
MIEN_DEFAULT(MienFitSurfaceDesc, mien_fit_surface_desc_default)

/* Creates a surface with a tree to find the nearest points. `desc` is required. Destroy with
 * mien_fit_surface_destroy().
 * Fails with MIEN_ERROR_INDEX if a position does not exist, MIEN_ERROR_INVALID_ARGUMENT if there are no
 * triangles, or a coordinate is not finite. */
MIEN_SOLVE_CHECKED MienStatus mien_fit_surface_create(const MienFitSurfaceDesc* desc,
                                                      MienFitSurface** out_surface, MienError* error);

/* Destroys a surface. NULL is allowed. */
MIEN_SOLVE_API void mien_fit_surface_destroy(MienFitSurface* surface);

/* A pinhole camera: image x = focal[0] * x / z + center[0], and y likewise, for the point x y z in camera
 * space, after `rotation` and `translation`. z grows in front of the camera. */
typedef struct MienFitCamera {
    float focal[2];
    float center[2];
    float rotation[9]; /* rows, from model space. With MienFitFrame.rigid, all 0: unknown */
    float translation[3];
} MienFitCamera;

/* What a constraint asks for. Places and directions are in model space, before the motion of
 * MienFitFrame.rigid. Kinds with joints need MienFitDesc.deformer. */
enum MienFitConstraintKind {
    MIEN_CONSTRAINT_JOINT_POSITION = 0,  /* `joint` is at `target`: where the jaw is */
    MIEN_CONSTRAINT_JOINT_DIRECTION = 1, /* `axis` of `joint` has the direction `target`: an eye's gaze */
    MIEN_CONSTRAINT_JOINT_AIM = 2,       /* `axis` of `joint` points at the place `target` */
    MIEN_CONSTRAINT_POINT_POSITION = 3,  /* `points[0]` is at `target` */
    MIEN_CONSTRAINT_POINT_DISTANCE = 4   /* from `distances[0]` to `distances[1]` lie between `points`: 0 and 0
                                            where lips touch */
};

/* A constraint of a frame. A number that is NaN: the constraint is missing. */
typedef struct MienFitConstraint {
    uint32_t kind;      /* MIEN_CONSTRAINT_... */
    uint32_t joint;     /* of the rig */
    uint32_t points[2]; /* places in MienFitDesc.points */
    float axis[3];      /* in the axes of the joint, of any length but 0 */
    float target[3];    /* a place, or a direction of any length but 0 */
    float distances[2]; /* the smallest and the largest that cost nothing */
    float weight;       /* times the squared residual: of a length in the unit of the rig, or of the difference of
                           directions of length 1 */
} MienFitConstraint;

/* Why a solve ended. */
enum MienFitStatus {
    MIEN_FIT_CONVERGED = 0,  /* further steps change nothing */
    MIEN_FIT_ITERATIONS = 1, /* the limit of iterations was reached; the best controls so far */
    MIEN_FIT_TIME = 2,       /* the limit of time was reached; likewise */
    MIEN_FIT_CANCELED = 3,   /* the caller asked to stop; likewise */
    MIEN_FIT_NO_DATA = 4     /* no target, or all are missing; the start is returned */
};

/* The targets of one frame, and the weights of the terms; terms of weight 0 are left out. Joints, points, images, a
 * surface and constraints may be given together: a point may have a target of each kind. Each kind has a unit of its
 * own: joint values, lengths (points and surface), and that of images. */
typedef struct MienFitFrame {
    size_t struct_size;
    const float* joints;         /* joint values. NULL: none. NaN: missing */
    const float* points;         /* x y z per point. NULL: none. NaN: missing */
    const float* images;         /* x y per point, as `camera` sees them. NULL: none. NaN: missing */
    const MienFitCamera* camera; /* required with `images` */
    const float* point_weights;  /* per point, 0 or more: of points and images. NULL: 1 */
    const float* start;          /* all raw controls of the rig, to start from. NULL: the initial ones */
    const float* prior;          /* raw controls that the result is drawn to. NULL: the initial ones */
    float prior_weight;          /* times the squared distance to `prior` */
    float smooth_weight;         /* times the squared distance to `start`, the previous frame */
    float sparse_weight;         /* times the sum of magnitudes, from the initial values: few controls
                                    explain the frame */
    float symmetric_weight;      /* times the squared differences of symmetric pairs */
    float robust_scale;          /* points farther off than this, or from the surface, count less. 0: all count
                                    fully */
    float joint_weight;          /* weight of the joints relative to the points. 0: 1 */
    uint32_t rigid;              /* boolean: points and surface may be rotated and translated as a whole, by one
                                    motion. With `images`, these stay where they are in model space, and the camera
                                    is found, from that of `camera`, or, if its rotation is unknown, from one that
                                    sees the face from the front */
    uint32_t max_iterations;     /* 0: 50 */
    double max_seconds;          /* 0: no limit. A limit makes results depend on the machine */
    void* user;                  /* passed to `canceled` */
    /* Called before each iteration; a nonzero result stops. NULL: never. */
    uint32_t(MIEN_CALLBACK* canceled)(void* user);
    const MienFitSurface* surface; /* each point is drawn to the nearest place of the surface that faces the same
                                      way, within 60 degrees, and is not at a border. NULL: none */
    float surface_reach;           /* points farther from the surface have no target. 0: no limit */
    uint32_t focal;                /* boolean, with `images` and `rigid`: the focal length is found too, its
                                      two numbers scaled alike */
    size_t constraint_count;
    const MienFitConstraint* constraints; /* up to 64, added to all other targets. NULL: none */
    const uint32_t* stages; /* per raw control of the rig, up to 15: the solve begins with the controls of
                               stage 0 alone, then those of stage 1 move too, and so on, as jaw and eyes before
                               the rest. Each stage may take `max_iterations`. NULL: all move from the start */
    const float* point_offsets; /* x y z per point, in model space: how far the points of the face in the targets are
                                   from those of the rig at rest, where it is another person's. Constraints are about
                                   the points of the rig. NULL: 0 */
    const float* surface_weights;  /* per point, 0 or more: how much it is drawn to `surface`. NULL: those of
                                      `point_weights` */
    float image_weight;            /* weight of the images relative to the points: of a squared length in the image,
                                      against a squared length in space. 0: 1 */
    float image_robust_scale;      /* `robust_scale` of images, in their unit. 0: `robust_scale`, or, if there are
                                      points or a surface too, all count fully */
} MienFitFrame;
MIEN_DEFAULT(MienFitFrame, mien_fit_frame_default)

/* The result of a solve. */
typedef struct MienFitResult {
    size_t struct_size;
    uint32_t status;         /* MIEN_FIT_... */
    uint32_t iterations;
    double cost;             /* the minimized sum, with all terms */
    double joint_residual;   /* weighted root mean square of the differences of joint values */
    double point_residual;   /* the same for points; without these, for images in their unit; without both, for the
                                surface */
    uint32_t missing_points; /* with a surface: those that have no target */
    uint32_t reserved;
    float rotation[9];       /* rows: points of the target = rotation * model + translation, if rigid; the
                                camera's with images */
    float translation[3];
    double joint_worst;      /* largest difference of a joint value that counts */
    double point_worst;      /* largest distance of a point that counts, of the same kind */
    float focal[2];          /* of the camera, with images; else 0 */
    double constraint_residual; /* weighted root mean square of the residuals of constraints */
    double constraint_worst;    /* largest residual of a constraint that counts */
    uint32_t jumped; /* boolean: joint values or points moved farther from where they are at `start` than their
                        targets ask for, as roots of mean squares; those without a target count as such that
                        ask for nothing */
    uint32_t reserved_2;
    double image_residual; /* weighted root mean square of the distances in the image */
    double image_worst;
    double surface_residual; /* the same of the distances from the surface */
    double surface_worst;
} MienFitResult;
MIEN_DEFAULT(MienFitResult, mien_fit_result_default)

/* Finds the raw controls of a frame by bounded Gauss-Newton steps with Levenberg-Marquardt damping. Writes
 * all raw controls of the rig to `out_raw`; those that may not move keep their values of `start`. `result`
 * may be NULL. Deterministic unless there is a time limit. Does not allocate or lock.
 * Fails with MIEN_ERROR_NULL_ARGUMENT if points, images or a surface are given to a fit without points, or
 * images without a camera, or constraints on joints to one without a deformer,
 * MIEN_ERROR_INVALID_ARGUMENT if a stage is above 15, or a weight, a control, an offset or a number of the camera is
 * not finite, or a weight is negative, MIEN_ERROR_HANDLE if `surface` is none,
 * MIEN_ERROR_INDEX if a constraint has a joint or point that does not exist. */
MIEN_SOLVE_CHECKED MienStatus mien_fit_solve(MienFit* fit, const MienFitFrame* frame, float* out_raw,
                                       MienFitResult* result);

/* Solves `count` frames of a motion, each from the result of the one before. `joints`, `points`, `images`,
 * `point_weights` and `surface_weights` of `frame` have a row for each frame, one after the other; all else is for all
 * frames. `start` and `stages` are for the first frame, and so is `camera`, if it may move. `out_raw` gets a row of all
 * raw controls for each frame; `results`, which may be NULL, one result for each, all with the `struct_size` of the
 * first. Where joints are the only targets, this is faster than calls of mien_fit_solve(), and differs from them by
 * rounding. Deterministic unless there is a time limit, which is that of a frame. Does not allocate or lock.
 * Fails like mien_fit_solve(). */
MIEN_SOLVE_CHECKED MienStatus mien_fit_solve_frames(MienFit* fit, const MienFitFrame* frame, size_t count,
                                                    float* out_raw, MienFitResult* results);

/* Writes for each raw control how well the data determines it at the initial pose: 0 if it moves nothing
 * that has a target, or if other controls have the same effect; up to 1 for the best determined one. The
 * parts of a rotation get the value of the turn that is determined least.
 * `count` is the number of raw controls.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if `count` is another number. */
MIEN_SOLVE_CHECKED MienStatus mien_fit_observability(const MienFit* fit, float* out_values, size_t count);

/* Chooses keys of a curve: straight lines between them are within `tolerance` of all values. `out_keys` gets
 * the frame numbers, ascending, the first and the last frame among them; `out_key_count` gets how many. `count`
 * is the number of values and the capacity of `out_keys`.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if a value is not finite, or the tolerance is negative or not
 * finite. */
MIEN_SOLVE_CHECKED MienStatus mien_fit_keys(const float* values, size_t count, float tolerance,
                                            uint32_t* out_keys, size_t* out_key_count);

#ifdef __cplusplus
}
#endif

#endif
