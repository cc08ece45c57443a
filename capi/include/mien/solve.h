/* SPDX-License-Identifier: MIT
 *
 * Solvers that move joints after the rig has posed them.
 * The rules of mien.h apply.
 */
#ifndef MIEN_SOLVE_H
#define MIEN_SOLVE_H

#include "mix.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Solvers --------------------------------------------------------------------------------- */

/* Solvers move joints of a deformer after the rig has posed them: eyes aim at a target, a cap moves from
 * hand to head, earrings swing.
 *
 *     mien_deformer_instance_update() -> mien_solver_state_step() -> mien_deformer_instance_deform()
 *
 * A step changes the matrices of the deformer instance in place. Lengths are in the rig's translation
 * unit, points in its model space. Results have the same bits on every machine, stepped alone or in a
 * batch. A stack serves any number of characters and threads. Immutable.
 * See docs/mixing.md, 6 "Solvers". */
typedef struct MienSolverStack MienSolverStack;

/* Value of a joint index that means no joint. */
#define MIEN_NO_JOINT 0xFFFF

/* Aim constraint: turns a joint so that one of its axes points at a target, by the shortest rotation, then
 * about that axis so that `up_axis` comes as near to `up` as possible. Directions may have any length. */
typedef struct MienAimSolver {
    uint32_t joint;
    uint32_t target_joint; /* its position is the target. MIEN_NO_JOINT: three curves of the row are */
    uint32_t target_curve; /* first of these three: x y z in model space */
    float axis[3];         /* aim axis, in the space of the joint; not 0 0 0 */
    float up_axis[3];      /* in the space of the joint; 0 0 0: no rotation about the aim axis */
    float up[3];           /* in model space; 0 0 0: 0 1 0 */
    float cone_degrees;    /* 0 to 180: largest angle from the neutral direction. 0: no limit */
    float weight;          /* 0 to 1 */
} MienAimSolver;

/* Space switch: moves a joint as if its parent were attached to another joint. A curve selects one of the
 * spaces. When it changes, the joint stays where it is, and the difference to the new space eases out. */
typedef struct MienSpaceSolver {
    int64_t ease_ticks;     /* 0 to 2^40 */
    const uint16_t* spaces; /* indices of joints. MIEN_NO_JOINT: model space */
    uint32_t space_count;   /* 1 to 8 */
    uint32_t curve;         /* of the row: its value, rounded, is an index in `spaces` */
    uint32_t joint;
    uint32_t reserved;      /* 0 */
} MienSpaceSolver;

/* Spring: lets the position of a joint swing about its position in the pose. It is a damped harmonic
 * oscillator in model space, advanced by its exact solution, so it is stable for any time step. Output 0 is
 * its speed, in translation units per second. */
typedef struct MienSpringSolver {
    uint32_t joint;
    float frequency;      /* of the undamped spring, in Hertz; above 0 */
    float damping;        /* damping ratio, 0 or more; 1 is critical damping */
    float rest_offset[3]; /* rest position relative to the position in the pose, in model space */
    float stretch;        /* largest distance from the rest position. 0: no limit */
    float teleport;       /* if the rest position jumps farther than this in a step, the joint jumps with
                             it. 0: never */
} MienSpringSolver;

/* Twist distribution: gives joints a share of another joint's twist about an axis, in place of their own
 * twist. Output 0 is the sine of half the angle. */
typedef struct MienTwistSolver {
    const uint16_t* joints;
    const float* shares;  /* one for each of these joints, -1 to 1; 0.5 is half the angle */
    uint32_t joint_count; /* 1 to 8 */
    uint32_t source;      /* the joint whose twist is distributed */
    float axis[3];        /* in the space of the source and of each joint; not 0 0 0 */
    uint32_t reserved;    /* 0 */
} MienTwistSolver;

/* Copy: gives a joint the motion of another joint relative to its neutral pose, or the mirrored motion. */
typedef struct MienCopySolver {
    uint32_t source;      /* the joint whose motion is copied */
    uint32_t joint;
    uint32_t is_mirrored; /* boolean: mirror the motion */
    float mirror_axis[3]; /* from right to left in model space; 0 0 0: 1 0 0 */
    float weight;         /* 0 to 1 */
} MienCopySolver;

/* The data of one character that a MienUserSolver gets. */
typedef struct MienSolverPose {
    float* locals;         /* 10 floats per joint: tx ty tz qx qy qz qw sx sy sz, relative to the parent.
                              Joints in `writes` may be changed; quaternions of any length but 0 */
    const float* models;   /* 16 floats per joint, as in mien_deformer_instance_joint_matrices(); up to
                              date for joints in `reads` */
    const float* previous; /* 16 floats for each joint in `previous_joints`, as the last step left it */
    const float* row;      /* MienSolverStackDesc.curve_count floats. NULL: there are none */
    float* outputs;        /* MienUserSolver.output_count floats for the caller to read */
    void* state;           /* MienUserSolver.state_bytes bytes, aligned to 8; initially zero */
    uint32_t lod;
    uint32_t is_reset;     /* boolean: the first step, or the character was teleported */
} MienSolverPose;

/* The argument of a MienUserSolver. */
typedef struct MienSolverCall {
    const MienSolverPose* poses; /* one for each of at most 64 characters */
    const uint16_t* parents;     /* one per joint; a root is its own parent */
    int64_t ticks;               /* since the last step */
    uint32_t pose_count;
    uint32_t joint_count;
} MienSolverCall;

/* A custom solver. It runs on the thread that calls the step function, and must not use the handles passed
 * to that function. */
typedef struct MienUserSolver {
    void* user; /* passed to the function; must live as long as the stack and its states */
    /* Changes the locals of the characters in `call`, and their outputs and state, but nothing else. */
    void(MIEN_CALLBACK* solve)(void* user, const MienSolverCall* call);
    const uint16_t* reads;           /* joints whose model matrices it reads */
    const uint16_t* writes;          /* joints whose local transforms it changes */
    const uint16_t* previous_joints; /* joints whose model matrices after the last step it reads */
    uint32_t read_count;
    uint32_t write_count;            /* 1 or more */
    uint32_t previous_joint_count;
    uint32_t state_bytes;            /* 0 to 2^20 */
    uint32_t output_count;           /* 0 to 4096 */
    uint32_t reserved;               /* 0 */
} MienUserSolver;

/* One solver: exactly one of the pointers aim ... custom is not NULL. */
typedef struct MienSolver {
    const char* name;             /* for messages. NULL: the name of its kind */
    const MienAimSolver* aim;     /* may be NULL */
    const MienSpaceSolver* space; /* may be NULL */
    const MienSpringSolver* spring; /* may be NULL */
    const MienTwistSolver* twist; /* may be NULL */
    const MienCopySolver* copy;   /* may be NULL */
    const MienUserSolver* custom; /* may be NULL */
    uint64_t lods;                /* bit l: runs at LOD l. 0: at all LODs */
} MienSolver;

/* How to create a solver stack. Everything is copied. */
typedef struct MienSolverStackDesc {
    size_t struct_size;
    const MienSolver* solvers; /* in the order in which they run; at most 256 */
    size_t solver_count;
    uint32_t curve_count;      /* the rows passed to steps have this many curves or more. 0: no row */
    uint32_t check_writes;     /* boolean: compare all joints before and after each solver, to find
                                  undeclared writes: mien_solver_state_undeclared() */
    const MienAllocator* allocator;
} MienSolverStackDesc;
MIEN_DEFAULT(MienSolverStackDesc, mien_solver_stack_desc_default)

/* Creates a solver stack. `desc` is required. `deformer` may be destroyed before it. Destroy with
 * mien_solver_stack_destroy().
 * Fails with MIEN_ERROR_INDEX if a joint or curve does not exist, MIEN_ERROR_INVALID_ARGUMENT if a number
 * is out of range, or if a solver reads a joint that a later one moves; the message names both. */
MIEN_CHECKED MienStatus mien_solver_stack_create(const MienDeformer* deformer,
                                                 const MienSolverStackDesc* desc,
                                                 MienSolverStack** out_solver_stack,
                                                 MienError* error);

/* Destroys a solver stack. Its states stay valid; its memory is released with the last of them. */
MIEN_API void mien_solver_stack_destroy(MienSolverStack* solver_stack);

/* Properties of a solver stack. */
typedef struct MienSolverStackInfo {
    size_t struct_size;
    uint32_t solver_count;
    uint32_t curve_count;
    uint32_t output_count; /* of all solvers */
    uint32_t joint_count;
    uint64_t state_bytes;  /* memory of a state */
} MienSolverStackInfo;
MIEN_DEFAULT(MienSolverStackInfo, mien_solver_stack_info_default)

/* Returns the properties of a solver stack. */
MIEN_CHECKED MienStatus mien_solver_stack_info(const MienSolverStack* solver_stack,
                                               MienSolverStackInfo* out_info);

/* One character: the state that its solvers keep between steps. */
typedef struct MienSolverState MienSolverState;

/* How to create a solver state. */
typedef struct MienSolverStateDesc {
    size_t struct_size;
    const MienAllocator* allocator;
} MienSolverStateDesc;
MIEN_DEFAULT(MienSolverStateDesc, mien_solver_state_desc_default)

/* Creates a solver state. `solver_stack` may be destroyed before it. Destroy with
 * mien_solver_state_destroy(). */
MIEN_CHECKED MienStatus mien_solver_state_create(const MienSolverStack* solver_stack,
                                                 const MienSolverStateDesc* desc,
                                                 MienSolverState** out_solver_state,
                                                 MienError* error);

/* Destroys a solver state. */
MIEN_API void mien_solver_state_destroy(MienSolverState* solver_state);

/* The input of the solvers of one character. */
typedef struct MienSolverInput {
    const float* row;   /* such as the one from mien_mixer_row(). NULL: none */
    size_t row_count;   /* at least MienSolverStackDesc.curve_count */
    uint32_t lod;       /* 0 to 63 */
    uint32_t is_reset;  /* boolean: the character was teleported, so springs come to rest and space
                           switches do not ease */
} MienSolverInput;

/* Runs the solvers on the pose of `deformer_instance`. Call mien_deformer_instance_update() before every
 * step. `input` may be NULL: no row, LOD 0. `ticks`, the time since the last step, is 0 to
 * 2^40. Does not allocate or lock.
 * Fails with MIEN_ERROR_MISMATCH if instance and stack have different deformers or the row is
 * shorter than MienSolverStackDesc.curve_count, MIEN_ERROR_INVALID_ARGUMENT if `ticks` or the LOD is out of
 * range. */
MIEN_CHECKED MienStatus mien_solver_state_step(MienSolverState* solver_state,
                                               MienDeformerInstance* deformer_instance,
                                               const MienSolverInput* input, int64_t ticks);

/* Steps `count` states of one stack; deformer_instances[i] and inputs[i] belong to solver_states[i].
 * `inputs` may be NULL. The results are those of single calls. No state or instance may occur twice. On
 * failure nothing changes. Does not allocate or lock. Uses up to 8 KiB of stack.
 * Fails like mien_solver_state_step(), and with MIEN_ERROR_MISMATCH if the states have different
 * stacks. */
MIEN_CHECKED MienStatus mien_solver_state_step_batch(MienSolverState* const* solver_states,
                                                     MienDeformerInstance* const* deformer_instances,
                                                     const MienSolverInput* inputs, size_t count,
                                                     int64_t ticks);

/* Returns the outputs of a solver in the last step, one float per output. `solver` is its index in the
 * stack.
 * Contents change with mien_solver_state_step(), mien_solver_state_step_batch().
 * Fails with MIEN_ERROR_INDEX if the solver does not exist. */
MIEN_CHECKED MienStatus mien_solver_state_outputs(const MienSolverState* solver_state, uint32_t solver,
                                                  MienFloatView* out_values);

/* Returns the joint transforms after the last step, relative to the parents: 10 floats per joint, tx ty tz
 * qx qy qz qw sx sy sz. (mien_deformer_instance_local_transforms() returns those before the step.)
 * Contents change with mien_solver_state_step(), mien_solver_state_step_batch(). */
MIEN_CHECKED MienStatus mien_solver_state_transforms(const MienSolverState* solver_state,
                                                     MienFloatView* out_transforms);

/* Returns the name of a solver that changed a joint not in its `writes` in the last step, or an empty
 * string. Contents change with mien_solver_state_step(), mien_solver_state_step_batch().
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if MienSolverStackDesc.check_writes was 0. */
MIEN_CHECKED MienStatus mien_solver_state_undeclared(const MienSolverState* solver_state,
                                                     MienStringView* out_name);

#ifdef __cplusplus
}
#endif

#endif /* MIEN_SOLVE_H */
