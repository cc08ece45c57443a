/* SPDX-License-Identifier: MIT
 *
 * libmien-author: creates and edits DNA files. It is a separate library on top of libmien, because programs
 * that only evaluate and deform rigs do not need it. The rules of mien.h apply.
 * */
#ifndef MIEN_AUTHOR_H
#define MIEN_AUTHOR_H

#include "mien.h"

#if defined(_WIN32) && defined(MIEN_AUTHOR_BUILD) && !defined(MIEN_STATIC)
#define MIEN_AUTHOR_API __declspec(dllexport)
#else
#define MIEN_AUTHOR_API MIEN_API
#endif

/* Like MIEN_CHECKED in mien.h. */
#if defined(__cplusplus) && __cplusplus >= 201703L
#define MIEN_AUTHOR_CHECKED [[nodiscard]] MIEN_AUTHOR_API
#elif defined(__STDC_VERSION__) && __STDC_VERSION__ >= 202311L
#define MIEN_AUTHOR_CHECKED [[nodiscard]] MIEN_AUTHOR_API
#else
#define MIEN_AUTHOR_CHECKED MIEN_AUTHOR_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Generating ------------------------------------------------------------------------------ */

/* Kinds of generated rigs. */
enum MienPreset {
    MIEN_PRESET_TINY = 0,   /* small enough to read */
    MIEN_PRESET_SMALL = 1,
    MIEN_PRESET_MEDIUM = 2,
    MIEN_PRESET_LARGE = 3,  /* a synthetic rig of production size: 870 joints, 260 raw controls, 8 LODs,
                               a million matrix entries */
    MIEN_PRESET_BODY = 4,   /* a synthetic rig of the size of a production body: 342 joints, moved by 72
                               RBF solvers with 670 poses, 22 twists and 16 swings; some are
                               quaternion joints */
    MIEN_PRESET_HEAD = 5,   /* a stylized head to look at: skin, eyes, teeth, tongue, hair; the 52
                               ARKit expressions and 20 of MetaHuman rigs as raw controls (0 to 1),
                               correctives, wrinkle maps, 8 LODs. Seed 0 is the designed head; other
                               seeds vary skull, nose, jaw, age, hair and colors. The metadata holds
                               vertex colors: key "mien.colors.<mesh name>", value base64 of 3 bytes
                               (sRGB) per vertex position of the mesh. */
    MIEN_PRESET_METAHUMAN_HEAD = 6, /* a synthetic rig with the published counts of exported heads and names
                               in MetaHuman's conventions: version 2.5, 870 joints, 263 raw controls
                               (251 expressions, 12 parts of quaternions), 174 GUI controls, 545
                               correctives, 782 channels, an RBF solver with 18 poses, 8 LODs */
    MIEN_PRESET_METAHUMAN_BODY = 7, /* MIEN_PRESET_BODY in version 2.7 */
    MIEN_PRESET_ARCHETYPE = 8       /* MIEN_PRESET_METAHUMAN_HEAD without blend shapes */
};

/* Additions to a preset, combined with |. */
enum MienGenerate {
    MIEN_GENERATE_ML = 1 /* machine-learned behavior: networks for mesh regions with all activation
                            functions and operations, and ML joints; not with MIEN_PRESET_HEAD and
                            those after it */
};

/* What to generate. */
typedef struct MienGenerateDesc {
    size_t struct_size;
    uint32_t preset; /* MIEN_PRESET_... */
    uint32_t flags;  /* MIEN_GENERATE_..., combined with | */
    uint64_t seed;   /* the same preset, flags and seed give the same bytes on every machine */
    const MienAllocator* allocator;
} MienGenerateDesc;
MIEN_DEFAULT(MienGenerateDesc, mien_generate_desc_default)

/* Generates a rig and opens it: a file of version 2.8, unless the preset states another one, with all layers
 * of its version, behavior of realistic size and sparsity, and simple geometry. Close with
 * mien_dna_close(). */
MIEN_AUTHOR_CHECKED MienStatus mien_dna_generate(const MienGenerateDesc* desc, MienDna** out_dna,
                                                 MienError* error);

/* ---- Rigs from meshes ------------------------------------------------------------------------- */

/* What was found and measured while authoring a rig. Immutable. */
typedef struct MienAuthorReport MienAuthorReport;

/* A named part of the input mesh. It becomes a mesh of the DNA file. */
typedef struct MienAuthorObject {
    MienStringView name; /* 1 to 200 bytes */
    uint32_t first_face; /* the face after the last one of the object before it */
    uint32_t face_count;
} MienAuthorObject;

/* An expression. It becomes a raw control of the same name, 0 to 1. */
typedef struct MienAuthorShape {
    MienStringView name;         /* 1 to 200 bytes; all different */
    const uint32_t* positions;   /* indices of the positions that move. NULL: all, in order */
    size_t position_count;       /* of `positions`, or of the mesh */
    const double* displacements; /* 3 for each of these positions, with the control at 1 */
} MienAuthorShape;

/* A mesh to rig: a head, or the front of one, with everything inside it. */
typedef struct MienAuthorMesh {
    size_t struct_size;
    const double* positions;         /* 3 per position, in the unit and axes of MienAuthorDesc */
    size_t position_count;
    const uint32_t* face_sizes;      /* corners of each face, 3 or more. NULL: all are triangles */
    size_t face_count;
    const uint32_t* corners;         /* indices of positions, face by face, counterclockwise seen from
                                        outside */
    size_t corner_count;
    const double* uvs;               /* 2 per UV; may be NULL */
    size_t uv_count;
    const uint32_t* corner_uvs;      /* indices of UVs, one per corner. NULL: no UVs */
    const MienAuthorObject* objects; /* NULL: a single object named "head" */
    size_t object_count;
    const MienAuthorShape* shapes;   /* may be NULL */
    size_t shape_count;
} MienAuthorMesh;
MIEN_DEFAULT(MienAuthorMesh, mien_author_mesh_default)

/* The role of a bone. */
enum MienBoneKind {
    MIEN_BONE_ROOT = 0,
    MIEN_BONE_NECK = 1,
    MIEN_BONE_HEAD = 2,
    MIEN_BONE_FACE = 3,
    MIEN_BONE_FACIAL = 4, /* moves with expressions; each LOD keeps the first n of these */
    MIEN_BONE_JAW = 5,
    MIEN_BONE_EYE = 6,
    MIEN_BONE_CHEST = 7,  /* below the neck */
    MIEN_BONE_TONGUE = 8  /* moves with expressions, below the jaw; in every LOD */
};

/* A bone placed by the caller. */
typedef struct MienAuthorBone {
    MienStringView name; /* 1 to 200 bytes; all different */
    double position[3];  /* in the space of the mesh, not relative to the parent */
    uint32_t parent;     /* index of an earlier bone; the first bone is its own parent */
    uint32_t kind;       /* MIEN_BONE_...: the first bone is the root, and facial bones are consecutive */
} MienAuthorBone;

/* A point of the face that joints are placed by. */
typedef struct MienAuthorLandmark {
    MienStringView name; /* "nose" (tip), "throat", "lip_upper", "lip_lower" (in the middle), "mouth_l",
                            "mouth_r" (corners, as the character sees them), "chin", "jaw" (its axis, in the
                            middle plane), "eye_l", "eye_r" (centers of the eyeballs), "head", "neck" (pivots) */
    double position[3];  /* in the unit and axes of the mesh */
} MienAuthorLandmark;

/* A LOD of the mesh, made by the caller. */
typedef struct MienAuthorLod {
    const uint32_t* corners;    /* indices of positions of the mesh, three per triangle, all three in the
                                   same object. Objects without triangles are not in the LOD */
    size_t corner_count;
    const uint32_t* corner_uvs; /* indices of UVs, one per corner. NULL: chosen from the UVs that each
                                   position has in the mesh, so that they are nearest to each other */
} MienAuthorLod;

/* Whether both halves of the face are treated as mirror images. */
enum MienSymmetry {
    MIEN_SYMMETRY_AUTO = 0, /* if mirrored positions lie within 0.5 % of the face's size of the surface */
    MIEN_SYMMETRY_ON = 1,
    MIEN_SYMMETRY_OFF = 2
};

/* Directions of the axes of a mesh. */
enum MienMeshAxis {
    MIEN_MESH_AXIS_DEFAULT = 0, /* up: Y; front: Z */
    MIEN_MESH_AXIS_X = 1,
    MIEN_MESH_AXIS_Y = 2,
    MIEN_MESH_AXIS_Z = 3,
    MIEN_MESH_AXIS_MINUS_X = 4,
    MIEN_MESH_AXIS_MINUS_Y = 5,
    MIEN_MESH_AXIS_MINUS_Z = 6
};

/* How bones and weights are computed, combined with |. */
enum MienAuthorFlags {
    MIEN_AUTHOR_PAPER = 1,            /* only the published method, plus the neck cut: no symmetry, no
                                         weighting by motion, no joints for jaw and eyes */
    MIEN_AUTHOR_NO_NECK_CUT = 2,      /* the face mask may include parts of the neck */
    MIEN_AUTHOR_MASK_FROM_SHAPES = 4, /* the face mask is where shapes move: for heads that are not human */
    MIEN_AUTHOR_AREA_DENSITY = 8,     /* weight positions by the area around them: for scans */
    MIEN_AUTHOR_NO_TARGETS = 16,      /* no blend shape targets for the motion that joints cannot produce */
    MIEN_AUTHOR_GROUP_IN_SPACE = 32,  /* group by distance in space, not in depth: for comparison */
    MIEN_AUTHOR_METAHUMAN_NAMES = 64  /* name bones that are placed and controls that are added as in
                                         MetaHuman heads where they have a counterpart: neck_01,
                                         FACIAL_C_Jaw, CTRL_expressions.jawOpen. The caller's bones and
                                         shapes keep their names */
};

/* How to rig a mesh. bones, weights, depth_groups, mask, lod_joints, bone_groups, bone_motions and
 * lod_meshes let the caller provide the result of one stage, which is then skipped. */
typedef struct MienAuthorDesc {
    size_t struct_size;
    uint32_t facial_joints;            /* 1 to 7000. 0: 240 */
    uint32_t influences;               /* per position: 1 to 12. 0: 8 */
    uint32_t lods;                     /* 1 to 8. 0: 8 */
    uint32_t groups;                   /* depth groups, of which the front one is the face: 2 to 16. 0: 3 */
    uint64_t seed;                     /* of the initial guesses of bone placement */
    double unit;                       /* centimeters per unit of the mesh. 0: 1 */
    uint32_t up;                       /* MIEN_MESH_AXIS_... */
    uint32_t front;                    /* MIEN_MESH_AXIS_..., perpendicular to `up` */
    uint32_t symmetry;                 /* MIEN_SYMMETRY_... */
    uint32_t flags;                    /* MIEN_AUTHOR_..., combined with | */
    MienStringView name;               /* of the character; empty: "head" */
    MienStringView face_object;        /* name of the object with the face; empty: found automatically */
    const MienAuthorBone* bones;       /* NULL: placed automatically */
    size_t bone_count;
    const uint16_t* weight_joints;     /* indices of bones, `influences` per position of the mesh. NULL:
                                          weights are computed */
    const float* weights;              /* the weights for weight_joints; both or neither, and only with
                                          `bones` */
    const MienParallelFor* parallel;   /* may be NULL */
    void* progress_user;               /* passed to the next function */
    /* Called on the calling thread with the name of the step that begins and the progress from 0 to 1,
     * which never decreases. Returns 0 to continue; anything else cancels. May be NULL. */
    int32_t(MIEN_CALLBACK* progress)(void* user, const char* step, double share);
    const MienAllocator* allocator;
    const uint8_t* depth_groups;       /* one per position of the mesh: its depth group, less than `groups`,
                                          0 in front. NULL: computed */
    const uint8_t* mask;               /* one per position of the mesh: nonzero in the face mask, where
                                          facial bones are placed. NULL: computed */
    const uint32_t* lod_joints;        /* maximum number of facial joints in each of `lods` LODs (mirrored
                                          pairs stay together); never increasing, and LOD 0 has all.
                                          NULL: 240, 160, 110, 75, 50, 32, 20, 12, scaled to
                                          facial_joints */
    const uint32_t* bone_groups;       /* joint group of each of `bones`, 0 to 255. NULL: computed */
    const double* bone_motions;        /* 6 numbers for each of `bones`, shape by shape, with the control at
                                          1: translation, then degrees about X, Y, Z, applied in this
                                          order, in the unit and axes of the mesh. NULL: fitted */
    uint32_t joint_groups;             /* 1 to 24. 0: chosen so that each has about 75 rows */
    uint32_t overlap_correctives;      /* maximum number of correctives that damp pairs of shapes with
                                          overlapping motion. 0: none */
    double lod_triangles;              /* share of the triangles of a LOD that the next one keeps: above 0,
                                          at most 1. 0: 0.5. 1: all */
    const MienAuthorLod* lod_meshes;   /* LOD 1, LOD 2 and so on. NULL: made according to lod_triangles */
    size_t lod_mesh_count;             /* one less than `lods` */
    const MienAuthorLandmark* landmarks; /* used instead of those that are found; each name once, in any
                                          order. With "jaw", or a landmark of the mouth, there is a jaw even if
                                          no shape opens it. NULL: all are found */
    size_t landmark_count;
} MienAuthorDesc;
MIEN_DEFAULT(MienAuthorDesc, mien_author_desc_default)

/* Creates a rig from a mesh, with or without expressions, and opens it as a file of version 2.8: joints,
 * skin weights for every LOD, and a raw control for each expression. The file has the axes of the mesh, in
 * centimeters; positions keep their order, but positions that belong to no face are dropped. The same mesh,
 * options and seed give the same bytes on any number of threads. `mesh` is required;
 * `out_report` may be NULL. Close with mien_dna_close() and mien_author_report_close().
 * The report has the confidence of each landmark; a mesh is not refused because it is low.
 * Fails with MIEN_ERROR_AUTHOR_MESH if the arrays of the mesh or of the caller's results contradict
 * each other, MIEN_ERROR_AUTHOR_REFUSED if the mesh cannot be rigged or landmarks contradict it,
 * MIEN_ERROR_AUTHOR_CANCELED if `progress` canceled, MIEN_ERROR_DNA_LIMIT if the file would be too large.
 * See docs/authoring.md, 1 "What goes in and what comes out". */
MIEN_AUTHOR_CHECKED MienStatus mien_author_rig(const MienAuthorMesh* mesh, const MienAuthorDesc* desc,
                                               MienDna** out_dna, MienAuthorReport** out_report,
                                               MienError* error);

/* Closes a report. */
MIEN_AUTHOR_API void mien_author_report_close(MienAuthorReport* author_report);

/* Returns the report as JSON: bones, mask, groups, errors of the fit, and more. Lengths are in
 * centimeters.
 * See docs/authoring.md, 6 "The report". */
MIEN_AUTHOR_CHECKED MienStatus mien_author_report_json(const MienAuthorReport* author_report,
                                                       MienStringView* out_json);

#ifdef __cplusplus
}
#endif

#include "mien_author/document.h"

#endif
