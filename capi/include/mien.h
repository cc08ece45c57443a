/* SPDX-License-Identifier: MIT
 *
 * Mien: reads DNA files, and evaluates and deforms the facial rigs in them.
 *
 *     DNA file -> MienDna -> MienRig -> MienInstance -> joint values, channel and map weights
 *                    \______ MienDeformer -> MienDeformerInstance -> matrices and vertices
 *
 *   MienDna               a checked, read-only view of a file
 *   MienRig               the behavior of a file, packed for evaluation; immutable
 *   MienInstance          one character: its controls, and the results of its last evaluation
 *   MienBatch             scratch memory for evaluating many instances in one call
 *   MienDeformer          the geometry of a file, packed for deformation; immutable
 *   MienDeformerInstance  one character: its joint matrices and deformed meshes
 *   MienBaked             an open file that holds a packed rig and its deformer
 *   MienClip              compressed curves of named channels; immutable
 *   MienClipPlayer        plays a clip for one character
 *   MienClipBinding       maps the channels of a clip to the raw controls of a rig; immutable
 *   MienMix               layers, reactions, guards and limits that produce the raw controls of a rig;
 *                         immutable
 *   MienMixer             one character in a mix: its running clips, fades and reactions
 *   MienGaze              which raw controls turn the eyes of a rig, and by how much; immutable
 *   MienSolverStack       solvers that move joints after the rig has posed them; immutable
 *   MienSolverState       one character: the state that springs and other solvers keep between steps
 *
 * One rig and one deformer serve any number of characters and threads. Both copy what they need
 * from the DNA, which may be closed afterwards.
 *
 * These rules hold unless a function says otherwise:
 *
 *   Status     Functions that can fail return a MienStatus; MIEN_OK is 0. On failure, `out_...`
 *              parameters are set to NULL or zero; the caller's arrays are left unchanged. Functions
 *              that can fail because of their data also take a MienError, which may be NULL.
 *              Wrong arguments give MIEN_ERROR_NULL_ARGUMENT, MIEN_ERROR_INVALID_ARGUMENT,
 *              MIEN_ERROR_STRUCT_SIZE or MIEN_ERROR_HANDLE; functions that create or open an
 *              object give MIEN_ERROR_MEMORY if the allocator returns NULL. In a library
 *              built with MIEN_BUILD_COMPILER=OFF, functions that create or take a MienDna or
 *              a MienReport give MIEN_ERROR_UNSUPPORTED. "Fails with" lists the other
 *              statuses of a function.
 *   Threads    A const handle may be used by any number of threads at the same time. A handle that
 *              is not const may be used by one thread at a time. There is no global state.
 *   Ownership  Objects that a create, open or generate function returns are released by the
 *              matching destroy or close function, which accepts NULL. Memory that you pass in is
 *              used only during the call.
 *   Views      A view (pointer and count) points into the memory of the handle it was requested
 *              from and is valid until that handle is destroyed or closed. Views of immutable
 *              objects never change.
 *   Strings    UTF-8, not validated. Names and paths that you pass in are null-terminated; functions
 *              whose names end in _n take a length in bytes instead. Strings in a MienStringView
 *              are not null-terminated.
 *   Structs    Later releases may append fields to structs that begin with struct_size.
 *              Initialize such a struct with its default function, or zero it and set struct_size
 *              to its sizeof: zero is the default of every field. A desc or allocator may be NULL,
 *              which means all defaults. MIEN_ERROR_STRUCT_SIZE means that a struct is smaller than
 *              in the release that introduced it, or larger than 4096 bytes, or that an input has
 *              nonzero fields that the library does not know. Unknown fields of outputs are set to
 *              zero.
 *   Enums      Parameters and fields that hold an enum value are fixed-width integers, because the
 *              size of a C enum is not fixed.
 *   Misuse     A NULL handle, an index out of range or a handle of the wrong kind gives an error
 *              status. Using a destroyed handle is undefined behavior, like using freed memory. The
 *              library never aborts or prints.
 *   Units      Those of the file: mien_rig_info() returns the units of translations and rotations
 *              and the directions of the axes. Joint values are deltas from the neutral pose.
 *   Numbers    32-bit floats. docs/numbers.md states which results are bit-identical on which machines.
 */
#ifndef MIEN_H
#define MIEN_H

#include <stddef.h>
#include <stdint.h>

#if defined(MIEN_STATIC)
#define MIEN_API
#elif defined(_WIN32)
#if defined(MIEN_BUILD)
#define MIEN_API __declspec(dllexport)
#else
#define MIEN_API __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define MIEN_API __attribute__((visibility("default")))
#else
#define MIEN_API
#endif

/* Marks functions that return a status: the compiler warns if it is ignored (C++17, C23). */
#if defined(__cplusplus) && __cplusplus >= 201703L
#define MIEN_CHECKED [[nodiscard]] MIEN_API
#elif defined(__STDC_VERSION__) && __STDC_VERSION__ >= 202311L
#define MIEN_CHECKED [[nodiscard]] MIEN_API
#else
#define MIEN_CHECKED MIEN_API
#endif

/* Calling convention of callbacks. */
#if defined(_WIN32) && !defined(_WIN64)
#define MIEN_CALLBACK __cdecl
#else
#define MIEN_CALLBACK
#endif

/* Defines `function`, which returns a `Type` with struct_size set and all other fields zero. */
#ifdef __cplusplus
#define MIEN_ZERO {}
#else
#define MIEN_ZERO {0}
#endif
#define MIEN_DEFAULT(Type, function)      \
    static inline Type function(void) {   \
        Type value = MIEN_ZERO;           \
        value.struct_size = sizeof(Type); \
        return value;                     \
    }

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Version ------------------------------------------------------------------------------- */

#define MIEN_VERSION_MAJOR 0
#define MIEN_VERSION_MINOR 1
#define MIEN_VERSION_PATCH 0
#define MIEN_VERSION ((MIEN_VERSION_MAJOR << 24) | (MIEN_VERSION_MINOR << 16) | MIEN_VERSION_PATCH)

/* Returns the MIEN_VERSION of the library in use, which may differ from that of this header. */
MIEN_API uint32_t mien_version(void);

/* ---- Status and errors ----------------------------------------------------------------------- */

/* A MIEN_OK or MIEN_ERROR_... value. */
typedef int32_t MienStatus;

/* Numbers are never reused. */
enum MienStatusCode {
    MIEN_OK = 0,
    MIEN_ERROR_NULL_ARGUMENT = 1,    /* a required pointer is NULL */
    MIEN_ERROR_INVALID_ARGUMENT = 2, /* a value out of range, or a buffer that is too small */
    MIEN_ERROR_STRUCT_SIZE = 3,      /* struct_size is too small or above 4096, or a field unknown to the
                                        library is not zero */
    MIEN_ERROR_HANDLE = 4,           /* a handle of the wrong kind */
    MIEN_ERROR_MISMATCH = 5,         /* objects that do not belong together */
    MIEN_ERROR_INDEX = 6,            /* an index past the end */
    MIEN_ERROR_LOD = 7,              /* a LOD that does not exist, or for which the object has no memory */
    MIEN_ERROR_NAME = 8,             /* no such name or path */
    MIEN_ERROR_ISA = 9,              /* an instruction set that the CPU or the build does not support */
    MIEN_ERROR_MEMORY = 10,          /* the allocator returned NULL */
    MIEN_ERROR_UNSUPPORTED = 11,     /* this build of the library only opens baked files */
    MIEN_ERROR_FILE_OPEN = 20,       /* the file cannot be opened */
    MIEN_ERROR_FILE_READ = 21,       /* the file or stream cannot be read */
    MIEN_ERROR_FILE_WRITE = 22,      /* the file cannot be written */
    MIEN_ERROR_DNA_SIGNATURE = 30,   /* not a DNA file */
    MIEN_ERROR_DNA_VERSION = 31,     /* a DNA file whose generation is not 2 */
    MIEN_ERROR_DNA_TRUNCATED = 32,   /* the file ends before the data that its header or counts announce */
    MIEN_ERROR_DNA_STRUCTURE = 33,   /* offsets, sizes or counts contradict each other */
    MIEN_ERROR_DNA_REFERENCE = 34,   /* an index that refers to nothing */
    MIEN_ERROR_DNA_LIMIT = 35,       /* a count above the limit of the format or of Mien */
    MIEN_ERROR_DNA_LAYER = 36,       /* a required layer is not loaded or not in the file */
    MIEN_ERROR_DNA_VALUE = 37,       /* an invalid value, or one that cannot be converted */
    MIEN_ERROR_BAKED_SIGNATURE = 50, /* not a baked file */
    MIEN_ERROR_BAKED_VERSION = 51,   /* baked by another version of Mien, or for the other byte order */
    MIEN_ERROR_BAKED_TRUNCATED = 52, /* the file is shorter than its header states */
    MIEN_ERROR_BAKED_STRUCTURE = 53, /* sizes, counts or indices contradict each other */
    MIEN_ERROR_BAKED_CHECKSUM = 54,  /* the file has changed since it was written */
    MIEN_ERROR_BAKED_PART = 55,      /* the file does not contain the requested object */
    MIEN_ERROR_CLIP_SIGNATURE = 60,  /* not a clip */
    MIEN_ERROR_CLIP_VERSION = 61,    /* a clip in another version of the format */
    MIEN_ERROR_CLIP_TRUNCATED = 62,  /* the clip is shorter than its header states */
    MIEN_ERROR_CLIP_STRUCTURE = 63,  /* sizes, counts or curves contradict each other */
    MIEN_ERROR_CLIP_CHECKSUM = 64,   /* the clip has changed since it was written */
    MIEN_ERROR_CLIP_VALUE = 65,      /* a value that is not finite */
    MIEN_ERROR_CLIP_LIMIT = 66,      /* more than a clip, player or binding can hold */
    MIEN_ERROR_MIX_SIGNATURE = 70,   /* not a mix */
    MIEN_ERROR_MIX_VERSION = 71,     /* a mix in another version of the format */
    MIEN_ERROR_MIX_TRUNCATED = 72,   /* the file is shorter than its header states */
    MIEN_ERROR_MIX_STRUCTURE = 73,   /* sizes or counts contradict each other, or a value is out of range */
    MIEN_ERROR_MIX_CHECKSUM = 74,    /* the mix has changed since it was written */
    MIEN_ERROR_AUTHOR_MESH = 80,     /* the arrays of a mesh, shape or bone contradict each other */
    MIEN_ERROR_AUTHOR_REFUSED = 81,  /* a mesh that cannot be rigged; the message names the rule */
    MIEN_ERROR_AUTHOR_CANCELED = 82 /* the caller's progress function asked to stop */
};

/* Returns "DNA_TRUNCATED" for MIEN_ERROR_DNA_TRUNCATED, and "UNKNOWN" for unknown numbers. The string
 * is static and null-terminated. */
MIEN_API const char* mien_status_name(MienStatus status);

/* A byte offset that means "none". */
#define MIEN_NO_OFFSET UINT64_MAX

/* Details of a failure, owned by the caller. A call that fails fills all fields; a call that succeeds
 * sets status to MIEN_OK and leaves the other fields unchanged. */
typedef struct MienError {
    size_t struct_size;
    uint64_t byte_offset; /* where in the file; MIEN_NO_OFFSET: nowhere in particular */
    MienStatus status;
    char message[236];    /* what is wrong, where, and how to fix it; null-terminated, truncated if
                             too long */
} MienError;
MIEN_DEFAULT(MienError, mien_error_default)

/* ---- Memory and views ------------------------------------------------------------------------ */

/* The caller's memory functions. Where a MienAllocator is NULL, the C library's heap is used. The
 * struct is copied. Both functions must remain callable until the object is destroyed, from every
 * thread that creates or destroys objects with this allocator. */
typedef struct MienAllocator {
    void* user; /* passed to the functions */
    /* Returns `size` bytes aligned to `alignment` (a power of two, at most 64), or NULL. */
    void*(MIEN_CALLBACK* allocate)(void* user, size_t size, size_t alignment);
    /* Releases a block. `size` and `alignment` are those it was allocated with. */
    void(MIEN_CALLBACK* release)(void* user, void* block, size_t size, size_t alignment);
} MienAllocator;

/* One task of a MienParallelFor. */
typedef void(MIEN_CALLBACK* MienTask)(void* context, uint32_t index);

/* The caller's thread pool; the library starts no threads. */
typedef struct MienParallelFor {
    void* user; /* passed to the function */
    /* Calls task(context, i) once for each i < count, in any order and on any threads, and returns
     * when all calls have finished. Tasks never wait for each other; each takes about 10 us. */
    void(MIEN_CALLBACK* run)(void* user, uint32_t count, MienTask task, void* context);
} MienParallelFor;

typedef struct MienStringView {
    const char* data;
    size_t count; /* bytes; not null-terminated */
} MienStringView;

typedef struct MienFloatView {
    const float* data;
    size_t count;
} MienFloatView;

typedef struct MienMutableFloatView {
    float* data;
    size_t count;
} MienMutableFloatView;

typedef struct MienIndex16View {
    const uint16_t* data;
    size_t count;
} MienIndex16View;

typedef struct MienIndex32View {
    const uint32_t* data;
    size_t count;
} MienIndex32View;

/* A file read by the caller, for example from an archive. `read` is called only during the call that
 * takes the stream, and on the same thread. */
typedef struct MienStream {
    void* user;    /* passed to the function */
    uint64_t size; /* of the file, in bytes */
    /* Copies `size` bytes at `offset` to `buffer` and returns the number of bytes copied; a smaller
     * number is an error. The range is within the file. */
    size_t(MIEN_CALLBACK* read)(void* user, uint64_t offset, void* buffer, size_t size);
} MienStream;

/* ---- DNA: opening ---------------------------------------------------------------------------- */

/* A checked, read-only view of a DNA file. Immutable. */
typedef struct MienDna MienDna;

/* Layers of a DNA file, combined with |. A layer loads the layers that it refers to: all of them need
 * the definition, RBF behavior needs the behavior. The descriptor is always loaded.
 * See docs/dna-format.md, 9 "Choosing layers". */
enum MienLayer {
    MIEN_LAYER_UNKNOWN = 0, /* only in MienDnaLayer.layer */
    MIEN_LAYER_DESCRIPTOR = 1,
    MIEN_LAYER_DEFINITION = 2,
    MIEN_LAYER_BEHAVIOR = 4,
    MIEN_LAYER_GEOMETRY = 8,
    MIEN_LAYER_MACHINE_LEARNED_BEHAVIOR = 16,
    MIEN_LAYER_RBF_BEHAVIOR = 32,
    MIEN_LAYER_JOINT_BEHAVIOR_METADATA = 64,
    MIEN_LAYER_TWIST_SWING_BEHAVIOR = 128,
    MIEN_LAYER_ALL = 255
};

/* What to do with layers of unknown kinds. */
enum MienUnknownLayers {
    MIEN_UNKNOWN_LAYERS_KEEP = 0, /* keep their bytes and write them back unchanged */
    MIEN_UNKNOWN_LAYERS_DROP = 1
};

enum MienFileAccess {
    MIEN_FILE_MAP = 0, /* map the file; read it into memory if it cannot be mapped, such as a pipe */
    MIEN_FILE_READ = 1 /* read the whole file into memory: safe even if it is truncated later */
};

enum MienTranslationUnit { MIEN_TRANSLATION_UNIT_CENTIMETERS = 0, MIEN_TRANSLATION_UNIT_METERS = 1 };
enum MienRotationUnit { MIEN_ROTATION_UNIT_DEGREES = 0, MIEN_ROTATION_UNIT_RADIANS = 1 };

/* Directions as seen by the character. */
enum MienDirection {
    MIEN_DIRECTION_LEFT = 0,
    MIEN_DIRECTION_RIGHT = 1,
    MIEN_DIRECTION_UP = 2,
    MIEN_DIRECTION_DOWN = 3,
    MIEN_DIRECTION_FRONT = 4,
    MIEN_DIRECTION_BACK = 5
};

/* Order of Euler angles. */
enum MienRotationSequence {
    MIEN_ROTATION_SEQUENCE_XYZ = 0, /* x first, then y, then z, about fixed axes */
    MIEN_ROTATION_SEQUENCE_XZY = 1,
    MIEN_ROTATION_SEQUENCE_YXZ = 2,
    MIEN_ROTATION_SEQUENCE_YZX = 3,
    MIEN_ROTATION_SEQUENCE_ZXY = 4,
    MIEN_ROTATION_SEQUENCE_ZYX = 5
};

/* The side of a face a b c ... to which (b - a) x (c - a) points. The cross product is computed from
 * the coordinates in the file, whatever the directions of its axes. */
enum MienFaceWinding {
    MIEN_FACE_WINDING_OUTWARD = 0, /* seen from outside: counter-clockwise with right-handed axes,
                                      clockwise with left-handed axes */
    MIEN_FACE_WINDING_INWARD = 1
};

/* How Euler angles are converted to other axes. Joint values are sums of angles, which have a meaning
 * in one rotation sequence only. So only the first rule is exact for all rigs. */
enum MienRotationRule {
    MIEN_ROTATION_RULE_CARRIED = 0,   /* keep the sequence of the file and rename its axes: if x and z
                                         are exchanged, xyz becomes zyx, xzy becomes zxy, and so on */
    MIEN_ROTATION_RULE_EXACT = 1,     /* the requested sequence. Neutral poses, quaternion joints, twists,
                                         swings, ML joints and joints that rotate about one axis only
                                         are converted exactly; rigs with other joints are rejected
                                         with MIEN_ERROR_DNA_VALUE */
    MIEN_ROTATION_RULE_PER_COLUMN = 2 /* the requested sequence, converting each column of the joint
                                         matrix separately: exact if one control is 1 and all others
                                         are 0, otherwise an approximation for small angles */
};

/* Axes, units and rotation conventions of a rig. Any handedness is allowed.
 * See docs/dna-format.md, 11 "Coordinate systems". */
typedef struct MienCoordinateSystem {
    size_t struct_size;
    uint32_t axes[3];           /* MIEN_DIRECTION_... of x, y, z */
    uint32_t translation_unit;  /* MIEN_TRANSLATION_UNIT_... */
    uint32_t rotation_unit;     /* MIEN_ROTATION_UNIT_... */
    uint32_t rotation_rule;     /* MIEN_ROTATION_RULE_... */
    uint32_t rotation_sequence; /* MIEN_ROTATION_SEQUENCE_...; ignored with MIEN_ROTATION_RULE_CARRIED */
    int32_t rotation_signs[3];  /* of the angles about x, y, z. 1: rotates y to z, z to x, x to y.
                                   -1: the other way. 0: whichever leaves the angles unchanged */
    uint32_t face_winding;      /* MIEN_FACE_WINDING_... */
    uint32_t reserved;          /* 0 */
} MienCoordinateSystem;
MIEN_DEFAULT(MienCoordinateSystem, mien_coordinate_system_default)

/* Returns the coordinate system of an engine or tool: "maya", "unreal", "unreal-mesh" (characters
 * look along y), "unity", "godot", "blender", "gltf", "opengl", "directx" or "houdini". The rotation
 * rule is MIEN_ROTATION_RULE_CARRIED; rotation_sequence is that of the engine's Euler angles, and only
 * takes effect if you set another rule.
 * Fails with MIEN_ERROR_NAME if the name is none of these. */
MIEN_CHECKED MienStatus mien_coordinate_system_find(const char* name,
                                                    MienCoordinateSystem* out_system);
MIEN_CHECKED MienStatus mien_coordinate_system_find_n(const char* name, size_t name_count,
                                                      MienCoordinateSystem* out_system);

/* Returns a name that mien_coordinate_system_find() accepts. The string is static.
 * Fails with MIEN_ERROR_INDEX if `index` is past the last name. */
MIEN_CHECKED MienStatus mien_coordinate_system_name(uint32_t index, MienStringView* out_name);

/* What to load of a DNA file, and how.
 *
 * A rig converted to another coordinate system moves as before: evaluating it gives the joint values
 * of the original rig, converted. Raw controls that are components of rotations (read by RBF solvers,
 * twists or swings as quaternions, or named .qx .qy .qz .qw) are expected in the requested system.
 * Changes of axes and signs are exact, so converting back restores the original numbers; a change of
 * units rounds each number once. Texture coordinates and unknown layers are not converted. A converted
 * rig can be written; the file gets version 2.8 if its own version cannot describe the system. */
typedef struct MienDnaDesc {
    size_t struct_size;
    uint32_t layers;                   /* MIEN_LAYER_..., combined with |; the others are not read.
                                          0: all */
    uint32_t skip_blend_shape_targets; /* boolean: load the geometry without blend shape targets */
    uint32_t unknown_layers;           /* MIEN_UNKNOWN_LAYERS_... */
    uint32_t file_access;              /* MIEN_FILE_...; for mien_dna_open_file() only */
    uint64_t lods; /* bit l keeps LOD l. Kept LODs are renumbered from 0; joints, meshes, channels
                      and maps that none of them uses are dropped, and all indices renumbered.
                      0: all */
    const MienCoordinateSystem* system; /* convert to this system. NULL: keep the file's own */
    const MienAllocator* allocator;
} MienDnaDesc;
MIEN_DEFAULT(MienDnaDesc, mien_dna_desc_default)

/* Opens a DNA file of version 2.1 to 2.8, or the known layers of a later 2.x. Checks everything that
 * it loads. Close with mien_dna_close().
 *
 * Numbers and names stay in the file and are read when needed. Memory is allocated for lists only:
 * typically a few percent of the size of the loaded layers, at most 20 times their size. Do not truncate
 * or overwrite a mapped file while it is open; replacing it by renaming is safe.
 *
 * Fails with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ if the file cannot be read,
 * MIEN_ERROR_DNA_SIGNATURE or MIEN_ERROR_DNA_VERSION if it is not a DNA file of generation 2,
 * MIEN_ERROR_DNA_TRUNCATED, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT
 * or MIEN_ERROR_DNA_VALUE if its contents are not valid or cannot be converted to the requested
 * system, MIEN_ERROR_LOD if it has none of the requested LODs.
 * See docs/dna-format.md, 13 "What is checked". */
MIEN_CHECKED MienStatus mien_dna_open_file(const char* path, const MienDnaDesc* desc, MienDna** out_dna,
                                           MienError* error);

/* Opens a DNA file in memory: `size` bytes, of any alignment. `bytes` must outlive the MienDna,
 * unchanged.
 * Fails like mien_dna_open_file(), but not with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ. */
MIEN_CHECKED MienStatus mien_dna_open_memory(const void* bytes, size_t size, const MienDnaDesc* desc,
                                             MienDna** out_dna, MienError* error);

/* Opens a DNA file through a stream. Reads the header, the index and the requested layers, each
 * with one read, into memory from the allocator.
 * Fails like mien_dna_open_file(), but not with MIEN_ERROR_FILE_OPEN. */
MIEN_CHECKED MienStatus mien_dna_open_stream(const MienStream* stream, const MienDnaDesc* desc,
                                             MienDna** out_dna, MienError* error);

/* Closes a DNA. Rigs and deformers created from it stay valid; views into it do not. */
MIEN_API void mien_dna_close(MienDna* dna);

/* ---- DNA: reading fields --------------------------------------------------------------------- */

/* Properties of an open DNA. Counts are those of the loaded layers and LODs. */
typedef struct MienDnaInfo {
    size_t struct_size;
    uint32_t generation;           /* 2 */
    uint32_t version;              /* 1 to 8: the file is of version 2.version */
    uint32_t layers;               /* MIEN_LAYER_..., combined with |: the loaded layers */
    uint32_t has_blend_shape_targets; /* boolean: the geometry is loaded with its targets */
    uint64_t file_bytes;           /* size of the file */
    uint64_t memory_bytes;         /* memory taken from the allocator */
    uint32_t is_mapped;            /* boolean: the file is mapped */
    uint32_t layer_count;          /* entries for mien_dna_layer() */
    uint32_t translation_unit;     /* MIEN_TRANSLATION_UNIT_... */
    uint32_t rotation_unit;        /* MIEN_ROTATION_UNIT_... */
    uint32_t axes[3];              /* MIEN_DIRECTION_... of x, y, z */
    uint32_t rotation_sequence;    /* MIEN_ROTATION_SEQUENCE_... */
    int32_t rotation_signs[3];     /* 1 or -1, for the angles about x, y, z */
    uint32_t face_winding;         /* MIEN_FACE_WINDING_... */
    uint32_t lod_count;
    uint32_t max_lod;              /* LOD 0 of this file is LOD max_lod of its database */
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
    uint32_t metadata_count;       /* pairs desc.metadata[i].key and .value */
} MienDnaInfo;
MIEN_DEFAULT(MienDnaInfo, mien_dna_info_default)

/* Returns the properties of a DNA. */
MIEN_CHECKED MienStatus mien_dna_info(const MienDna* dna, MienDnaInfo* out_info);

/* An entry of the index table of the file. Files of version 2.1 have no index table; their sections are
 * listed as the layers desc, defn, bhvr and geom. */
typedef struct MienDnaLayer {
    size_t struct_size;
    uint32_t layer;         /* MIEN_LAYER_... that loads it. MIEN_LAYER_UNKNOWN: no known kind */
    uint32_t version_major; /* of the layer: version_major.version_minor */
    uint32_t version_minor;
    uint32_t is_loaded;     /* boolean: it was parsed, not skipped or kept as bytes */
    uint64_t byte_offset;   /* of its first byte in the file */
    uint64_t byte_count;
    char code[8];           /* such as "bhvr"; null-terminated */
} MienDnaLayer;
MIEN_DEFAULT(MienDnaLayer, mien_dna_layer_default)

/* Returns entry `index` of the index table, in file order.
 * Fails with MIEN_ERROR_INDEX if `index` is not below MienDnaInfo.layer_count.
 * See docs/dna-format.md, 4.1 "Index table". */
MIEN_CHECKED MienStatus mien_dna_layer(const MienDna* dna, uint32_t index, MienDnaLayer* out_layer);

/* Type of a field. */
enum MienFieldType {
    MIEN_FIELD_RECORD = 0,  /* named fields */
    MIEN_FIELD_LIST = 1,    /* records, strings or arrays; element i is at the path of the list + [i] */
    MIEN_FIELD_STRING = 2,
    MIEN_FIELD_U8 = 3,      /* numbers: one, or an array */
    MIEN_FIELD_U16 = 4,
    MIEN_FIELD_U32 = 5,
    MIEN_FIELD_I32 = 6,
    MIEN_FIELD_F32 = 7
};

typedef struct MienDnaField {
    size_t struct_size;
    uint32_t type;        /* MIEN_FIELD_... */
    uint32_t is_array;    /* boolean: an array of numbers, even if it has only one element; not a
                             single number, nor an element of an array */
    uint64_t count;       /* elements of an array or list, bytes of a string, fields of a record; 1 for
                             a number */
    uint64_t byte_offset; /* of a string, an array or an element of an array in the file;
                             MIEN_NO_OFFSET: other fields, and data that is not in the file */
} MienDnaField;
MIEN_DEFAULT(MienDnaField, mien_dna_field_default)

/* Finds a field of a loaded layer by its path: the code of the layer, then the names of fields, with
 * an index after each list.
 *
 *     desc.name                                 a string
 *     desc.metadata[0].key                      a string
 *     defn.jointNames                           a list of strings; defn.jointNames[3] is one
 *     defn.neutralJointTranslations.xs          floats
 *     bhvr.joints.jointGroups[7].values         floats
 *     geom.meshes[0].skinWeights[12].weights    floats
 *     mlbh.neuralNetworks[0].layers[1].biases   floats
 *
 * Layers that are not loaded are empty.
 * Fails with MIEN_ERROR_NAME if there is no such field (the message contains the part of the path that
 * does not exist), MIEN_ERROR_INDEX if an index in the path is past the end.
 * See docs/dna-format.md, 6 "Layers, field by field". */
MIEN_CHECKED MienStatus mien_dna_field(const MienDna* dna, const char* path, MienDnaField* out_field,
                                       MienError* error);
MIEN_CHECKED MienStatus mien_dna_field_n(const MienDna* dna, const char* path, size_t path_count,
                                         MienDnaField* out_field, MienError* error);

/* Returns the name of field `index` of the record at a path. The empty path is the file itself, whose
 * fields are the layers. The string is static.
 * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if `index` or an index in the
 * path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a record.
 * See docs/dna-format.md, 6 "Layers, field by field". */
MIEN_CHECKED MienStatus mien_dna_child_name(const MienDna* dna, const char* path, uint32_t index,
                                            MienStringView* out_name, MienError* error);
MIEN_CHECKED MienStatus mien_dna_child_name_n(const MienDna* dna, const char* path,
                                              size_t path_count, uint32_t index,
                                              MienStringView* out_name, MienError* error);

/* Copies `count` elements of a field, beginning with element `first`, to `out`, in native byte order.
 * A field that is one number has one element. `out` may be NULL if `count` is 0. Integers are widened
 * to 64 bits.
 * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
 * the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
 * kind. */
MIEN_CHECKED MienStatus mien_dna_read_floats(const MienDna* dna, const char* path, uint64_t first,
                                             uint64_t count, float* out, MienError* error);
MIEN_CHECKED MienStatus mien_dna_read_floats_n(const MienDna* dna, const char* path,
                                               size_t path_count, uint64_t first, uint64_t count,
                                               float* out, MienError* error);
MIEN_CHECKED MienStatus mien_dna_read_integers(const MienDna* dna, const char* path, uint64_t first,
                                               uint64_t count, int64_t* out, MienError* error);
MIEN_CHECKED MienStatus mien_dna_read_integers_n(const MienDna* dna, const char* path,
                                                 size_t path_count, uint64_t first, uint64_t count,
                                                 int64_t* out, MienError* error);

/* Returns a string of the file.
 * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is
 * past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a string. */
MIEN_CHECKED MienStatus mien_dna_read_string(const MienDna* dna, const char* path,
                                             MienStringView* out_string, MienError* error);
MIEN_CHECKED MienStatus mien_dna_read_string_n(const MienDna* dna, const char* path,
                                               size_t path_count, MienStringView* out_string,
                                               MienError* error);

/* ---- DNA: writing ---------------------------------------------------------------------------- */

/* How to write a DNA file. See docs/dna-format.md, 14.3 "Changing the version". */
typedef struct MienWriteDesc {
    size_t struct_size;
    uint32_t version;        /* 1 to 8: write version 2.version; layers that it does not define are
                                kept unless unknown_layers drops them, but 2.1 can only hold the
                                layers desc, defn, bhvr and geom. 0: the version of the DNA */
    uint32_t unknown_layers; /* MIEN_UNKNOWN_LAYERS_... */
} MienWriteDesc;
MIEN_DEFAULT(MienWriteDesc, mien_write_desc_default)

/* Writes a DNA file in canonical form: byte for byte the original if that was canonical and was loaded
 * completely. Layers that were not loaded are written empty. Another version may not have layers that
 * others need, such as the ML operations of networks; a file that could not be opened again is never
 * written. The file is written under a temporary name and renamed, so that a failure leaves `path`
 * unchanged. An existing file keeps its permissions; a symbolic link is followed, unless it leads
 * nowhere.
 * Fails with MIEN_ERROR_FILE_WRITE if the file cannot be written, MIEN_ERROR_DNA_LAYER if RBF behavior
 * was loaded without the machine-learned behavior of its file (whose controls are numbered before its
 * own), MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE or MIEN_ERROR_DNA_VALUE if the file could
 * not be opened in the requested version, MIEN_ERROR_DNA_LIMIT if it would exceed 4 GiB,
 * MIEN_ERROR_MEMORY if the allocator of the DNA returns NULL.
 * See docs/dna-format.md, 14 "Writing a canonical file". */
MIEN_CHECKED MienStatus mien_dna_write_file(const MienDna* dna, const char* path,
                                            const MienWriteDesc* desc, MienError* error);

/* Writes a DNA file to memory and returns its size in `out_size`. `buffer` may be NULL with capacity 0
 * to get the size only. Writes nothing if `capacity` is too small; `out_size` is set nevertheless.
 * Fails like mien_dna_write_file(), but not with MIEN_ERROR_FILE_WRITE, and with
 * MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small. */
MIEN_CHECKED MienStatus mien_dna_write_memory(const MienDna* dna, const MienWriteDesc* desc,
                                              void* buffer, size_t capacity, size_t* out_size,
                                              MienError* error);

/* ---- DNA: validating ------------------------------------------------------------------------- */

/* The findings of a validation. Immutable. */
typedef struct MienReport MienReport;

enum MienSeverity {
    MIEN_SEVERITY_ERROR = 0,  /* opening the file or mien_rig_create() fails because of this */
    MIEN_SEVERITY_WARNING = 1 /* allowed, but probably a mistake */
};

typedef struct MienFinding {
    size_t struct_size;
    uint32_t severity;      /* MIEN_SEVERITY_... */
    MienStatus status;      /* the status of the failure; MIEN_OK for a warning */
    uint64_t byte_offset;   /* where in the file; MIEN_NO_OFFSET: nowhere in particular */
    MienStringView field;   /* path as for mien_dna_field(), or the code of a layer */
    MienStringView message; /* what is wrong */
} MienFinding;
MIEN_DEFAULT(MienFinding, mien_finding_default)

typedef struct MienValidateDesc {
    size_t struct_size;
    const MienAllocator* allocator;
} MienValidateDesc;
MIEN_DEFAULT(MienValidateDesc, mien_validate_desc_default)

/* Checks all layers of a file and collects the findings: at most 32 per field and 1000 in total; the
 * last one tells whether there are more. Returns MIEN_OK if the file could be checked, whatever was
 * found. The file is read into memory first, so it may change during the call. Destroy with
 * mien_report_destroy().
 * Fails with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ if the file cannot be read.
 * See docs/dna-format.md, 13 "What is checked". */
MIEN_CHECKED MienStatus mien_dna_validate_file(const char* path, const MienValidateDesc* desc,
                                               MienReport** out_report, MienError* error);

/* Checks a file in memory: `size` bytes. `bytes` may be released afterwards. */
MIEN_CHECKED MienStatus mien_dna_validate_memory(const void* bytes, size_t size,
                                                 const MienValidateDesc* desc,
                                                 MienReport** out_report, MienError* error);

/* Returns the number of errors and the number of warnings. */
MIEN_CHECKED MienStatus mien_report_counts(const MienReport* report, uint32_t* out_errors,
                                           uint32_t* out_warnings);

/* Returns finding `index`, in the order of the checks. Their number is that of errors plus warnings.
 * Fails with MIEN_ERROR_INDEX if `index` is past the last finding. */
MIEN_CHECKED MienStatus mien_report_finding(const MienReport* report, uint32_t index,
                                            MienFinding* out_finding);

/* Destroys a report. */
MIEN_API void mien_report_destroy(MienReport* report);

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

/* Whether an instance keeps results whose inputs have not changed since its last evaluation. The
 * results are bit-identical either way. */
enum MienReuse {
    MIEN_REUSE_UNCHANGED = 0,
    MIEN_REUSE_NOTHING = 1 /* compute everything in each evaluation, for measurements */
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

/* Packs the behavior of a DNA for evaluation. The rig is one block of memory; temporary memory is
 * released before the call returns. `dna` may be closed afterwards. Destroy with mien_rig_destroy().
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
 * are bit-identical to those of mien_rig_evaluate_stages(), but columns of the joint matrix that several
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
    uint32_t reserved;      /* 0 */
    const MienAllocator* allocator;
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
 * instruction set is not available.
 * See docs/deformation.md. */
MIEN_CHECKED MienStatus mien_deformer_create(const MienDna* dna, const MienRig* rig,
                                             const MienDeformerDesc* desc, MienDeformer** out_deformer,
                                             MienError* error);

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
    MienFloatView texture_coordinates;   /* 2 floats per vertex: u v, as in the file */
    MienIndex32View vertex_position_indices; /* one index per vertex: its position */
    MienIndex32View triangles;           /* 3 indices per triangle: vertices, wound as in the file; faces
                                            with more corners become fans about their first corner */
    MienIndex16View target_channels;     /* one index per target: its blend shape channel; in file
                                            order */
} MienMesh;
MIEN_DEFAULT(MienMesh, mien_mesh_default)

/* Returns a neutral mesh.
 * Fails with MIEN_ERROR_INDEX if there is no such mesh. */
MIEN_CHECKED MienStatus mien_deformer_mesh(const MienDeformer* deformer, uint32_t mesh,
                                           MienMesh* out_mesh);

/* Returns the influences of a position, as used for skinning: `out_joints` gets one index per influence,
 * `out_weights` gets one float per influence. There may be none.
 * Fails with MIEN_ERROR_INDEX if there is no such mesh or position. */
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

/* ---- Baked files ----------------------------------------------------------------------------- */

/* An open baked file: a rig, and possibly its deformer, as they are in memory. They are used in place,
 * so that programs can ship without DNA files. A baked file holds all options of its objects except the
 * instruction set and MienReuse, and works on all machines of one byte order. The same objects give the
 * same bytes. Keep the DNA file: a later version of the library may refuse the baked file with
 * MIEN_ERROR_BAKED_VERSION. Immutable.
 * See docs/rig-evaluation.md, 9.5 "Baked files". */
typedef struct MienBaked MienBaked;

/* Writes a rig and its deformer to a baked file. `deformer` may be NULL. The file is written under a
 * temporary name and renamed, so that a failure leaves `path` unchanged.
 * Fails with MIEN_ERROR_MISMATCH if `deformer` was created for another rig, MIEN_ERROR_FILE_WRITE if
 * the file cannot be written, MIEN_ERROR_MEMORY if the allocator of the rig returns NULL. */
MIEN_CHECKED MienStatus mien_bake_file(const MienRig* rig, const MienDeformer* deformer,
                                       const char* path, MienError* error);

/* Writes a baked file to memory and returns its size in `out_size`. `deformer` may be NULL. `buffer`
 * may be NULL with capacity 0 to get the size only. Writes nothing if `capacity` is too small;
 * `out_size` is set nevertheless.
 * Fails with MIEN_ERROR_MISMATCH if `deformer` was created for another rig,
 * MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small. */
MIEN_CHECKED MienStatus mien_bake_memory(const MienRig* rig, const MienDeformer* deformer, void* buffer,
                                         size_t capacity, size_t* out_size, MienError* error);

/* What is checked when a baked file is used. */
enum MienBakedCheck {
    MIEN_BAKED_CHECK_SAFE = 0, /* all sizes, counts and indices, so that no access is out of bounds
                                  whatever the bytes are. Floats are not checked, so their pages are read
                                  from disk only when first used. */
    MIEN_BAKED_CHECK_FULL = 1  /* also the checksum of all bytes, which reads the whole file */
};

/* How to open a baked file. */
typedef struct MienBakedDesc {
    size_t struct_size;
    uint32_t file_access; /* MIEN_FILE_...; MIEN_FILE_READ also copies bytes in memory */
    uint32_t check;       /* MIEN_BAKED_CHECK_... */
    const MienAllocator* allocator;
} MienBakedDesc;
MIEN_DEFAULT(MienBakedDesc, mien_baked_desc_default)

/* Opens a baked file. By default it is mapped, so processes that open the same file share its pages. Do not
 * truncate or overwrite a mapped file until all objects made from it are destroyed; replacing it by
 * renaming is safe. The header is checked now, the rest when objects are created. One allocation, and
 * one more for the bytes if the file is not mapped. Close with mien_baked_close().
 * Fails with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ if the file cannot be read,
 * MIEN_ERROR_BAKED_SIGNATURE, MIEN_ERROR_BAKED_VERSION, MIEN_ERROR_BAKED_TRUNCATED or
 * MIEN_ERROR_BAKED_STRUCTURE if its header is not valid, MIEN_ERROR_BAKED_CHECKSUM if
 * MIEN_BAKED_CHECK_FULL finds changed bytes. */
MIEN_CHECKED MienStatus mien_baked_open_file(const char* path, const MienBakedDesc* desc,
                                             MienBaked** out_baked, MienError* error);

/* Opens a baked file in memory: `size` bytes. `bytes` must outlive the MienBaked and all objects made
 * from it, unchanged, unless they are copied: with MIEN_FILE_READ, or if `bytes` is not aligned to
 * 64.
 * Fails like mien_baked_open_file(), but not with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ. */
MIEN_CHECKED MienStatus mien_baked_open_memory(const void* bytes, size_t size, const MienBakedDesc* desc,
                                               MienBaked** out_baked, MienError* error);

/* Opens a baked file through a stream, which is read at once into memory of the allocator.
 * Fails like mien_baked_open_file(), but not with MIEN_ERROR_FILE_OPEN. */
MIEN_CHECKED MienStatus mien_baked_open_stream(const MienStream* stream, const MienBakedDesc* desc,
                                               MienBaked** out_baked, MienError* error);

/* Closes a baked file. Objects made from it stay valid; its memory is released and the file unmapped
 * with the last of them. */
MIEN_API void mien_baked_close(MienBaked* baked);

/* Properties of an open baked file. */
typedef struct MienBakedInfo {
    size_t struct_size;
    uint64_t file_bytes;     /* size of the file */
    uint64_t memory_bytes;   /* memory taken from the allocator */
    uint64_t rig_bytes;      /* size of the rig in the file. 0: it has none */
    uint64_t deformer_bytes; /* size of the deformer in the file. 0: it has none */
    uint32_t part_count;     /* parts of the file, including unknown ones */
    uint32_t is_mapped;      /* boolean: the file is mapped */
} MienBakedInfo;
MIEN_DEFAULT(MienBakedInfo, mien_baked_info_default)

/* Returns the properties of an open baked file. */
MIEN_CHECKED MienStatus mien_baked_info(const MienBaked* baked, MienBakedInfo* out_info);

/* Options of a rig that are not part of a baked file. */
typedef struct MienBakedRigDesc {
    size_t struct_size;
    uint32_t isa;   /* MIEN_ISA_... */
    uint32_t reuse; /* MIEN_REUSE_... */
    const MienAllocator* allocator;
} MienBakedRigDesc;
MIEN_DEFAULT(MienBakedRigDesc, mien_baked_rig_desc_default)

/* Creates the rig of a baked file, with one allocation. `baked` may be closed afterwards. Destroy with
 * mien_rig_destroy().
 * Fails with MIEN_ERROR_BAKED_PART if the file has no rig, MIEN_ERROR_BAKED_VERSION or
 * MIEN_ERROR_BAKED_STRUCTURE if its rig cannot be used, MIEN_ERROR_ISA if the requested instruction set
 * is not available. */
MIEN_CHECKED MienStatus mien_rig_from_baked(const MienBaked* baked, const MienBakedRigDesc* desc,
                                            MienRig** out_rig, MienError* error);

/* Options of a deformer that are not part of a baked file. */
typedef struct MienBakedDeformerDesc {
    size_t struct_size;
    uint32_t isa;     /* MIEN_ISA_...; MIEN_ISA_BEST is that of the rig */
    uint32_t normals; /* MIEN_NORMALS_...: what MIEN_NORMALS_DEFAULT means for this deformer; in this
                         field MIEN_NORMALS_DEFAULT keeps the setting of the baked deformer */
    const MienAllocator* allocator;
} MienBakedDeformerDesc;
MIEN_DEFAULT(MienBakedDeformerDesc, mien_baked_deformer_desc_default)

/* Creates the deformer of a baked file, with one allocation. `rig` is the one created from the same
 * MienBaked. `baked` may be closed and `rig` may be destroyed afterwards. Destroy with
 * mien_deformer_destroy().
 * Fails with MIEN_ERROR_MISMATCH if `rig` was not created from `baked`, MIEN_ERROR_BAKED_PART if the
 * file has no deformer, MIEN_ERROR_BAKED_VERSION or MIEN_ERROR_BAKED_STRUCTURE if its deformer cannot be
 * used, MIEN_ERROR_ISA if the requested instruction set is not available. */
MIEN_CHECKED MienStatus mien_deformer_from_baked(const MienBaked* baked, const MienRig* rig,
                                                 const MienBakedDeformerDesc* desc,
                                                 MienDeformer** out_deformer, MienError* error);

/* ---- Clips ----------------------------------------------------------------------------------- */

/* Curves of named channels at a constant frame rate, compressed. A clip is not bound to a rig: a
 * MienClipBinding maps its channels to raw controls.
 *
 *     rows of values -> MienClip -> MienClipPlayer  -> values of channels
 *                              \___ MienClipBinding -> raw controls of a rig
 *
 * Times are integers, in ticks of 1 / MIEN_TICKS_PER_SECOND s. At common frame rates a frame lasts a whole
 * number of ticks; at others its length is rounded to the nearest tick. A clip is used in place: frames
 * are decoded while it plays. Decoded values are always finite, even if the bytes are damaged.
 * Immutable. */
typedef struct MienClip MienClip;

/* Ticks per second. */
#define MIEN_TICKS_PER_SECOND 705600000

/* What happens after the last frame. */
enum MienLooping {
    MIEN_LOOPING_DEFAULT = 0, /* a clip: MIEN_LOOPING_CLAMP; a player: the setting of its clip */
    MIEN_LOOPING_CLAMP = 1,   /* holds the last frame; the length is (frames - 1) * ticks per frame */
    MIEN_LOOPING_WRAP = 2     /* starts over; the length is frames * ticks per frame */
};

/* A named moment of a clip, such as a phoneme. In speech layers, events named "close:lips",
 * "close:lip-to-teeth" and "close:teeth" activate the matching guards of the mixer for `value` seconds. */
typedef struct MienClipEvent {
    int64_t tick;
    MienStringView name;
    float value;
    uint32_t reserved; /* 0 */
} MienClipEvent;

/* What to build a clip from. */
typedef struct MienClipDesc {
    size_t struct_size;
    uint32_t rate_numerator;     /* frames per second, as a fraction. 0: 60 */
    uint32_t rate_denominator;   /* 0: 1 */
    uint32_t frame_count;        /* 1 to 2^28 */
    uint32_t channel_count;      /* at most 65535, of which at most 512 may change over time */
    const MienStringView* names; /* one per channel, all different, not empty */
    const float* values;         /* channel c of frame f is values[f * frame_stride + c] */
    size_t frame_stride;         /* floats from frame to frame. 0: channel_count */
    const float* snaps;          /* one per channel, used instead of `snap`; may be NULL */
    float snap;                  /* 0: values keep all bits. 2^-9, 2^-10 ... 2^-16: values are rounded to
                                    multiples of this step, which makes the clip several times smaller */
    uint32_t looping;            /* MIEN_LOOPING_... */
    uint32_t is_delta;           /* boolean: a delta clip, whose values are added to other values */
    uint32_t event_count;
    const MienClipEvent* events; /* in any order; 0 <= tick < frame_count * ticks per frame */
    const MienAllocator* allocator;
} MienClipDesc;
MIEN_DEFAULT(MienClipDesc, mien_clip_desc_default)

/* Builds a clip in memory. `desc` is required. The same values give the same bytes on every machine.
 * Close with mien_clip_close().
 * Fails with MIEN_ERROR_CLIP_VALUE if a value is not finite (the message names frame and channel),
 * MIEN_ERROR_NAME if a name is empty or occurs twice, MIEN_ERROR_CLIP_LIMIT if there are too many
 * frames, channels or bytes. */
MIEN_CHECKED MienStatus mien_clip_build(const MienClipDesc* desc, MienClip** out_clip,
                                        MienError* error);

/* How to open a clip. */
typedef struct MienClipOpenDesc {
    size_t struct_size;
    uint32_t file_access; /* MIEN_FILE_...; no effect on memory and streams */
    uint32_t reserved;    /* 0 */
    const MienAllocator* allocator;
} MienClipOpenDesc;
MIEN_DEFAULT(MienClipOpenDesc, mien_clip_open_desc_default)

/* Opens a clip. By default it is mapped: do not truncate or overwrite the file until the clip is closed
 * and its players are destroyed; replacing it by renaming is safe. Names and events are checked now,
 * curves when they are decoded: damaged ones decode to zeros (see mien_clip_verify()). Close with
 * mien_clip_close().
 * Fails with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ if the file cannot be read,
 * MIEN_ERROR_CLIP_SIGNATURE, MIEN_ERROR_CLIP_VERSION, MIEN_ERROR_CLIP_TRUNCATED or
 * MIEN_ERROR_CLIP_STRUCTURE if it is not a valid clip. */
MIEN_CHECKED MienStatus mien_clip_open_file(const char* path, const MienClipOpenDesc* desc,
                                            MienClip** out_clip, MienError* error);

/* Opens a clip in memory, at any alignment. `bytes` must outlive the clip and its players, unchanged.
 * Fails like mien_clip_open_file(), but not with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ. */
MIEN_CHECKED MienStatus mien_clip_open_memory(const void* bytes, size_t size,
                                              const MienClipOpenDesc* desc, MienClip** out_clip,
                                              MienError* error);

/* Opens a clip through a stream, which is read completely into memory of the allocator.
 * Fails like mien_clip_open_file(), but not with MIEN_ERROR_FILE_OPEN. */
MIEN_CHECKED MienStatus mien_clip_open_stream(const MienStream* stream, const MienClipOpenDesc* desc,
                                              MienClip** out_clip, MienError* error);

/* Closes a clip. Players stay valid; memory is released and the file unmapped with the last of them. */
MIEN_API void mien_clip_close(MienClip* clip);

/* Writes a clip to a file. The file is written under a temporary name and renamed, so that a failure
 * leaves `path` unchanged.
 * Fails with MIEN_ERROR_FILE_WRITE if the file cannot be written, MIEN_ERROR_MEMORY if the allocator of
 * the clip returns NULL. */
MIEN_CHECKED MienStatus mien_clip_write_file(const MienClip* clip, const char* path,
                                             MienError* error);

/* Writes a clip to memory and returns its size in `out_size`. `buffer` may be NULL with capacity 0 to
 * get the size only. Writes nothing if `capacity` is too small; `out_size` is set nevertheless.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small. */
MIEN_CHECKED MienStatus mien_clip_write_memory(const MienClip* clip, void* buffer, size_t capacity,
                                               size_t* out_size, MienError* error);

/* Properties of a clip. */
typedef struct MienClipInfo {
    size_t struct_size;
    uint32_t rate_numerator;         /* frames per second, as a fraction */
    uint32_t rate_denominator;
    uint32_t frame_count;
    uint32_t channel_count;
    uint32_t changing_channel_count; /* channels whose value is not the same in all frames */
    uint32_t event_count;
    uint32_t looping;                /* MIEN_LOOPING_CLAMP or MIEN_LOOPING_WRAP */
    uint32_t is_delta;               /* boolean: as in MienClipDesc */
    float snap;                      /* largest step to which a channel was rounded. 0: none was */
    uint32_t is_mapped;              /* boolean: the file is mapped */
    int64_t ticks_per_frame;
    int64_t length;                  /* ticks */
    uint64_t file_bytes;             /* size of the clip */
    uint64_t memory_bytes;           /* memory taken from the allocator */
    uint64_t player_bytes;           /* memory of a player without MienClipPlayerDesc.reverse */
} MienClipInfo;
MIEN_DEFAULT(MienClipInfo, mien_clip_info_default)

/* Returns the properties of a clip. */
MIEN_CHECKED MienStatus mien_clip_info(const MienClip* clip, MienClipInfo* out_info);

/* A channel of a clip. Block counts, bits and max_error are only known for a clip from
 * mien_clip_build(); they are 0 for a clip that was opened. */
typedef struct MienClipChannel {
    size_t struct_size;
    MienStringView name;
    float rest;               /* value of a channel that does not change; otherwise 0 */
    uint32_t is_changing;     /* boolean: the channel has a curve */
    uint32_t zero_blocks;     /* blocks of 64 frames that are zero */
    uint32_t constant_blocks; /* blocks with one other value */
    uint32_t grid_blocks;     /* blocks whose values are multiples of a decimal or binary fraction */
    uint32_t float_blocks;    /* other blocks */
    uint64_t bits;            /* of all blocks */
    float max_error;          /* largest error of rounding to a step */
    uint32_t reserved;        /* 0 */
} MienClipChannel;
MIEN_DEFAULT(MienClipChannel, mien_clip_channel_default)

/* Returns a channel. Channels keep the order in which the clip was built. The name is a view into the
 * clip.
 * Fails with MIEN_ERROR_INDEX if `index` is out of range. */
MIEN_CHECKED MienStatus mien_clip_channel(const MienClip* clip, uint32_t index,
                                          MienClipChannel* out_channel);

/* Returns the index of the channel with this name. Searches all channels.
 * Fails with MIEN_ERROR_NAME if there is none. */
MIEN_CHECKED MienStatus mien_clip_find_channel(const MienClip* clip, const char* name,
                                               uint32_t* out_index);
MIEN_CHECKED MienStatus mien_clip_find_channel_n(const MienClip* clip, const char* name,
                                                 size_t name_count, uint32_t* out_index);

/* Returns an event. Events are sorted by tick; those at the same tick keep the order in which they were
 * given. The name is a view into the clip.
 * Fails with MIEN_ERROR_INDEX if `index` is out of range. */
MIEN_CHECKED MienStatus mien_clip_event(const MienClip* clip, uint32_t index,
                                        MienClipEvent* out_event);

/* Checks that no byte of a clip has changed since it was written and that all curves can be decoded.
 * Reads the whole clip. Uses up to 36 KiB of stack.
 * Fails with MIEN_ERROR_CLIP_CHECKSUM if bytes have changed, MIEN_ERROR_CLIP_STRUCTURE if a curve cannot
 * be decoded. */
MIEN_CHECKED MienStatus mien_clip_verify(const MienClip* clip, MienError* error);

/* Copies `frame_count` frames, starting at `first_frame`: channel c of frame first_frame + n goes to
 * out_values[n * frame_stride + c]. frame_stride is at least the number of channels; 0 means that
 * number. Each call decodes from the start of a block of 64 frames, so reading many frames in one
 * call costs less than reading them one by one. Uses up to 36 KiB of stack.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if frame_stride is too small, MIEN_ERROR_INDEX if the
 * clip has fewer frames, MIEN_ERROR_CLIP_STRUCTURE if a curve is damaged; its block in `out_values` is
 * zero. */
MIEN_CHECKED MienStatus mien_clip_read(const MienClip* clip, uint32_t first_frame,
                                       uint32_t frame_count, float* out_values, size_t frame_stride,
                                       MienError* error);

/* ---- Clip player ----------------------------------------------------------------------------- */

/* Plays a clip for one character: a position, and the state of the decoder. */
typedef struct MienClipPlayer MienClipPlayer;

/* How values between two frames are computed. They stay within the range of these two frames. */
enum MienInterpolation {
    MIEN_INTERPOLATION_LINEAR = 0,
    MIEN_INTERPOLATION_STEP = 1,       /* the value of the earlier frame */
    MIEN_INTERPOLATION_CATMULL_ROM = 2 /* a Catmull-Rom spline, clamped to that range */
};

/* How to play a clip. */
typedef struct MienClipPlayerDesc {
    size_t struct_size;
    uint32_t looping;          /* MIEN_LOOPING_... */
    uint32_t interpolation;    /* MIEN_INTERPOLATION_... */
    int32_t speed_numerator;   /* speed, as a fraction; negative plays backward. -2^20 to 2^20 */
    int32_t speed_denominator; /* 1 to 2^20. Both 0: 1 / 1 */
    int64_t start_tick;        /* initial position, as for mien_clip_player_seek() */
    uint32_t reverse;          /* boolean: backward playback costs no more than forward; takes 256 more
                                  bytes per changing channel */
    uint32_t reserved;         /* 0 */
    const MienAllocator* allocator;
} MienClipPlayerDesc;
MIEN_DEFAULT(MienClipPlayerDesc, mien_clip_player_desc_default)

/* Creates a player, with one allocation. `clip` may be closed before the player is destroyed. Destroy with
 * mien_clip_player_destroy(). */
MIEN_CHECKED MienStatus mien_clip_player_create(const MienClip* clip, const MienClipPlayerDesc* desc,
                                                MienClipPlayer** out_clip_player, MienError* error);

/* Destroys a player. */
MIEN_API void mien_clip_player_destroy(MienClipPlayer* clip_player);

/* State of a player. */
typedef struct MienClipPlayerInfo {
    size_t struct_size;
    int64_t tick;        /* 0 to the length of the clip; with MIEN_LOOPING_WRAP less than the length */
    int64_t loops;       /* loops completed since creation or the last seek, at most 2^61; negative:
                            backward */
    uint32_t looping;    /* MIEN_LOOPING_CLAMP or MIEN_LOOPING_WRAP */
    uint32_t is_damaged; /* boolean: a damaged curve was played, as zeros */
} MienClipPlayerInfo;
MIEN_DEFAULT(MienClipPlayerInfo, mien_clip_player_info_default)

/* Returns the state of a player. */
MIEN_CHECKED MienStatus mien_clip_player_info(const MienClipPlayer* clip_player,
                                              MienClipPlayerInfo* out_info);

/* Moves to a tick: modulo the length with MIEN_LOOPING_WRAP, otherwise clamped to the range. Reports no
 * events; the next mien_clip_player_advance() also reports events at this tick, as it does after
 * creation. Does not allocate or lock. */
MIEN_CHECKED MienStatus mien_clip_player_seek(MienClipPlayer* clip_player, int64_t tick);

/* Sets the speed for later calls of mien_clip_player_advance(). Does not allocate or lock.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if it is outside the range of MienClipPlayerDesc. */
MIEN_CHECKED MienStatus mien_clip_player_set_speed(MienClipPlayer* clip_player, int32_t numerator,
                                                   int32_t denominator);

/* Moves by `ticks` times the speed. `ticks` is -2^40 to 2^40 (26 minutes). Fractions of ticks are kept,
 * so the position does not depend on the step size. Does not allocate or lock.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if `ticks` is out of range. */
MIEN_CHECKED MienStatus mien_clip_player_advance(MienClipPlayer* clip_player, int64_t ticks);

/* Returns the next event that the last mien_clip_player_advance() passed. `out_found` is 1, or 0 after
 * the last event. An event is passed when the position reaches or crosses its tick in either
 * direction, once per loop. The name is a view into the clip. Does not allocate or lock. */
MIEN_CHECKED MienStatus mien_clip_player_next_event(MienClipPlayer* clip_player,
                                                    MienClipEvent* out_event, uint32_t* out_found);

/* Returns the values at the current position: one float per channel. Exactly at a frame they are
 * bit-identical to those of the clip. Decodes the frames since the last call, or at most 64 after a jump;
 * without MienClipPlayerDesc.reverse, each step backward is a jump. Does not allocate or lock.
 * Contents change with mien_clip_player_sample(). */
MIEN_CHECKED MienStatus mien_clip_player_sample(MienClipPlayer* clip_player,
                                                MienFloatView* out_values);

/* ---- Clip binding ---------------------------------------------------------------------------- */

/* Maps the channels of a clip to raw controls of a rig. Serves all clips with the same channels and
 * all rigs with the same raw controls. Immutable. */
typedef struct MienClipBinding MienClipBinding;

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
    const MienMatrixEntry* matrix; /* for channels whose names the rig does not have; may be NULL */
    size_t matrix_count;
    const MienAllocator* allocator;
} MienClipBindingDesc;
MIEN_DEFAULT(MienClipBindingDesc, mien_clip_binding_desc_default)

/* Binds a clip to a rig by names. A channel drives the raw control with its name. If there is none, it
 * drives the GUI control with its name, which is then mapped as by mien_rig_map_gui_to_raw(). If there
 * is none either, it drives the controls of its entries in the matrix, which are summed in the order of
 * the matrix. Names match without regard to case; `.` matches `_`; the prefix `CTRL_expressions.` may be
 * missing. If several names match, only an exact match counts. A raw control that a channel drives by
 * name is driven by nothing else, and one that the matrix drives is not driven by GUI controls. Names
 * without a match are not an error: see mien_clip_binding_info(). `clip` may be closed and `rig` may be
 * destroyed afterwards. Destroy with mien_clip_binding_destroy().
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if a weight is not finite, MIEN_ERROR_CLIP_LIMIT if channels
 * drive more than 4095 GUI controls. */
MIEN_CHECKED MienStatus mien_clip_binding_create(const MienClip* clip, const MienRig* rig,
                                                 const MienClipBindingDesc* desc,
                                                 MienClipBinding** out_clip_binding,
                                                 MienError* error);

/* Returns a matrix that binds clips with the 52 ARKit expression names, such as those of the Live Link
 * Face app, to rigs with the other common naming of raw controls (eyeBlinkL for eyeBlinkLeft). It suits
 * every rig: channels whose names the rig has do not use the matrix, and entries for missing controls are
 * skipped. docs/face-capture.md, 3 "ARKit expressions on raw controls" explains the entries. Writes as
 * many entries as fit; `out_count` is the total number. Names are static. `out_entries` may be NULL if
 * `capacity` is 0. */
MIEN_CHECKED MienStatus mien_arkit_matrix(MienMatrixEntry* out_entries, size_t capacity,
                                          size_t* out_count);

/* Destroys a binding. */
MIEN_API void mien_clip_binding_destroy(MienClipBinding* clip_binding);

/* What a binding found. Indices are ascending. */
typedef struct MienClipBindingInfo {
    size_t struct_size;
    uint32_t channel_count;           /* channels of the clip */
    uint32_t raw_control_count;       /* raw controls of the rig */
    uint32_t missing_entry_count;     /* matrix entries whose channel or control does not exist */
    uint32_t reserved;                /* 0 */
    MienIndex16View controls;         /* raw controls that are driven */
    MienIndex16View extra_controls;   /* raw controls that are not driven */
    MienIndex16View missing_channels; /* channels that drive nothing: the rig has no such name, or an
                                         earlier channel drives the same control */
} MienClipBindingInfo;
MIEN_DEFAULT(MienClipBindingInfo, mien_clip_binding_info_default)

/* Returns what a binding found. */
MIEN_CHECKED MienStatus mien_clip_binding_info(const MienClipBinding* clip_binding,
                                               MienClipBindingInfo* out_info);

/* Computes the raw controls that are driven and leaves the others unchanged. `values` has one float
 * per channel, as mien_clip_player_sample() returns them; `raw_controls` has one float per raw control,
 * as mien_instance_raw_controls() returns them. Values that drive raw controls by name are
 * copied exactly; GUI controls give the same bits as mien_rig_map_gui_to_raw(). Does not allocate or
 * lock. Uses up to 16 KiB of stack.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if a count differs from that of the clip or the rig. */
MIEN_CHECKED MienStatus mien_clip_binding_apply(const MienClipBinding* clip_binding,
                                                const float* values, size_t value_count,
                                                float* raw_controls, size_t raw_control_count);

/* Finds for each channel of a clip the coarsest rounding step with no visible effect, for
 * MienClipDesc.snaps: the largest of 2^-9 to 2^-16 of which half moves no vertex of LOD 0 by more than
 * `tolerance`, in millimeters, such as 0.02. If LOD 0 has no meshes, joints are measured instead. Each
 * channel is tried at five values from 0 to 1, and from -1 on if GUI controls are driven, with all other
 * channels at 0. Channels that drive nothing get 2^-11; channels for which even the finest step is too
 * coarse get 0. To use the steps, build a clip with all bits, bind it, then build it again with them.
 * Evaluates and deforms the rig at least 10 times per channel, and takes memory from its allocator during
 * the call.
 * Fails with MIEN_ERROR_MEMORY if that returns NULL, MIEN_ERROR_MISMATCH if `channel_count` is not that of
 * the binding, or the binding is for another rig, MIEN_ERROR_INVALID_ARGUMENT if `tolerance` is not a
 * number above 0. */
MIEN_CHECKED MienStatus mien_clip_binding_snaps(const MienClipBinding* clip_binding,
                                                const MienDeformer* deformer, float tolerance,
                                                float* out_snaps, size_t channel_count,
                                                MienError* error);

/* ---- Mix ------------------------------------------------------------------------------------- */

/* What is mixed for one rig, and how. A row holds one value per lane. The lanes are the raw controls of
 * the rig, then pose variables: numbers of the caller that are mixed by the same rules (gaze, head turn,
 * breath). Each step of a MienMixer applies the layers in order, then reactions, guards, layers and
 * reactions that act after the guards, antagonists, and limits. docs/mixing.md explains each stage. One
 * mix serves any number of mixers and threads. Immutable. */
typedef struct MienMix MienMix;

/* The purpose of a layer. Guards protect the result of base and speech from the other groups. */
enum MienLayerGroup {
    MIEN_LAYER_GROUP_BASE = 0,
    MIEN_LAYER_GROUP_SPEECH = 1,
    MIEN_LAYER_GROUP_EMOTION = 2,
    MIEN_LAYER_GROUP_REACTION = 3,
    MIEN_LAYER_GROUP_LIFE = 4      /* acts after the reactions if no layer of another group follows */
};

/* How a layer changes a lane: o is the value so far, x the value of the layer, a = weight * mask. Lanes
 * for which the layer's source has no value do not change. */
enum MienBlendMode {
    MIEN_BLEND_MODE_OVERRIDE = 0, /* o + a (x - o) */
    MIEN_BLEND_MODE_ADD = 1,      /* o + a x */
    MIEN_BLEND_MODE_SCREEN = 2,   /* o + a x (1 - p), or o + a x p if x < 0; p is o clamped to 0..1 */
    MIEN_BLEND_MODE_MAX = 3,      /* o + a max(0, x - o) */
    MIEN_BLEND_MODE_SCALE = 4     /* o (1 + a (x - 1)) */
};

/* Where the values of a layer come from. */
enum MienLayerSource {
    MIEN_LAYER_SOURCE_CLIP = 0,     /* mien_mixer_play() */
    MIEN_LAYER_SOURCE_POSES = 1,    /* a weighted sum: mien_mixer_set_pose_weight() */
    MIEN_LAYER_SOURCE_STREAM = 2,   /* mien_mixer_push() */
    MIEN_LAYER_SOURCE_GENERATOR = 3 /* MIEN_GENERATOR_... */
};

/* What a layer generates from the seed of the mixer and the time. */
enum MienGenerator {
    MIEN_GENERATOR_BLINK = 0,  /* blinks every `period` on average, at least 0.5 s apart. The wait starts
                                  over when earlier layers raise the first lane above 0.6 */
    MIEN_GENERATOR_BREATH = 1, /* rises from 0 to 1 in 40 % of the period, then falls back to 0 */
    MIEN_GENERATOR_NOISE = 2,  /* smooth noise between -1 and 1 with a new random value every period */
    MIEN_GENERATOR_GAZE = 3    /* turns the eyes to a target with saccades, by MienMixDesc.gaze. `lanes` are
                                  three lanes with the left, up and front of a MienGazeTarget, read after
                                  the earlier layers, then optionally two lanes that get the part left for
                                  the head (MienGazeRest). `amounts` are fixation jitter sideways and up in
                                  degrees, 0, and factors for the two head lanes. Shifts of 20 degrees or
                                  more make the blink layers of the mix blink */
};

/* A layer of a mix. Leave the fields that its source does not use at zero. */
typedef struct MienMixLayer {
    int64_t period;         /* of a generator, ticks */
    int64_t delay;          /* of a stream, ticks: rows are played this much later than their times */
    const float* mask;      /* one per lane, 0 to 1; lanes beyond mask_count have 0. NULL: 1 for all */
    const uint16_t* lanes;  /* the lane of each channel of a stream, or the lanes of a generator */
    const float* amounts;   /* one per lane of a generator: a factor for its value */
    uint32_t mask_count;
    uint32_t lane_count;
    uint32_t group;         /* MIEN_LAYER_GROUP_... */
    uint32_t mode;          /* MIEN_BLEND_MODE_... */
    uint32_t source;        /* MIEN_LAYER_SOURCE_... */
    uint32_t after_guards;  /* boolean: acts after the guards; not allowed for base and speech */
    float weight;           /* initial weight. 0 to 1; -1 to 1 with MIEN_BLEND_MODE_ADD */
    uint32_t first_pose;    /* index of its first pose in MienMixDesc.poses */
    uint32_t pose_count;
    uint32_t generator;     /* MIEN_GENERATOR_... */
    uint32_t stream_frames; /* capacity of a stream's queue, in rows. 0: 64; otherwise 2 to 1024 */
    uint32_t reserved;      /* 0 */
} MienMixLayer;

/* A pose: the lanes that it moves, and their values. */
typedef struct MienMixPose {
    const uint16_t* lanes;
    const float* values;
    size_t count;
} MienMixPose;

/* A part of a reaction: moves the lanes of a pose to its values and back to 0. Times are in ticks. */
typedef struct MienMixStroke {
    int64_t delay;    /* after the trigger */
    int64_t attack;   /* time to reach strength * pose */
    int64_t hold;     /* time after the attack; ignored if is_held */
    int64_t release;  /* time to return to 0 */
    uint32_t pose;    /* index in MienMixDesc.poses */
    uint32_t mode;    /* MIEN_BLEND_MODE_... */
    uint32_t is_held; /* boolean: holds as long as the stimulus lasts, and adapts unless is_lag */
    uint32_t is_lag;  /* boolean: moves exponentially; attack and release are time constants */
    uint32_t is_scaled; /* boolean: scaled by the level of the reaction, which is 1 if
                           mien_mixer_trigger() started it */
    uint32_t reserved;  /* 0 */
} MienMixStroke;

/* What a trigger does while the reaction is already running. */
enum MienRetrigger {
    MIEN_RETRIGGER_EXTEND = 0,  /* extends the stimulus; strokes that are releasing or over start again */
    MIEN_RETRIGGER_RESTART = 1, /* all strokes start again, at most once per cooldown */
    MIEN_RETRIGGER_IGNORE = 2
};

/* What a face does in response to a stimulus, such as a bright light. */
typedef struct MienMixReaction {
    int64_t cooldown;             /* ticks; minimum time between two starts of strokes that are not held */
    int64_t adapt_ticks;          /* time constant of adaptation to a lasting stimulus */
    int64_t recover_ticks;        /* time constant of recovery after the stimulus */
    const MienMixStroke* strokes; /* at most 8 */
    size_t stroke_count;
    uint32_t retrigger;           /* MIEN_RETRIGGER_... */
    uint32_t after_guards;        /* boolean: acts after the guards */
    float adapted;                /* share of the strength that remains after full adaptation; 1: all */
    float level_on;               /* levels of this or more are a stimulus: mien_mixer_set_level(). 0: the
                                     reaction takes no levels */
    float level_off;              /* the stimulus ends below this; at most level_on */
    uint32_t reserved;            /* 0 */
} MienMixReaction;

/* Two lanes that move the face in opposite directions. If both are above 0, the smaller one times
 * stiffness is subtracted from both. */
typedef struct MienMixAntagonists {
    uint16_t first;
    uint16_t second;
    float stiffness; /* 0 to 1 */
} MienMixAntagonists;

/* Built-in guards: gaps that emotions and reactions must not open while speech or a blink closes them.
 * Bits of MienMixDesc.guards. */
enum MienGuard {
    MIEN_GUARD_LIPS = 1,  /* between the lips, left, center and right, and from lower lip to upper teeth */
    MIEN_GUARD_LIDS = 2,  /* between the lids */
    MIEN_GUARD_TEETH = 4, /* between the teeth */
    MIEN_GUARD_ALL = 7
};

/* No mesh: the points of a landmark are joints. */
#define MIEN_NO_MESH 0xFFFFFFFF
/* No raw control. */
#define MIEN_NO_CONTROL 0xFFFF

/* A point of the face: the mean of some positions of a mesh that LOD 0 shows, or of some joints. */
typedef struct MienLandmark {
    const uint32_t* points; /* indices of positions of the mesh, or of joints */
    uint32_t point_count;   /* 1 to 65536 */
    uint32_t mesh;          /* index of the mesh. MIEN_NO_MESH: the points are joints */
} MienLandmark;

/* A guard with landmarks of the caller. It keeps the gap between them, the height of `upper` above `lower`
 * along the axis that points up, from being opened. */
typedef struct MienMixGuard {
    MienLandmark upper;
    MienLandmark lower;
    uint32_t closed_by;    /* raw control that closes the gap at 1. MIEN_NO_CONTROL: it is closed at rest */
    uint32_t needs_speech; /* boolean: acts at most as much as the largest weight of a speech layer */
    float tolerance;       /* millimeters by which later layers may open the gap, 0 or more; 0.3 for
                              built-in guards */
    float f_on;            /* millimeters, above 0: acts if base and speech leave a smaller gap, fully at 0.
                              Built-in guards: 12 for lips, 6 for lids, 4 for teeth */
} MienMixGuard;

/* Which raw controls turn the eyes of a rig, and by how much. Immutable. */
typedef struct MienGaze MienGaze;

/* What to mix. Everything is copied. */
typedef struct MienMixDesc {
    size_t struct_size;
    const MienMixLayer* layers;            /* at most 16 */
    size_t layer_count;
    const MienMixPose* poses;              /* at most 1024; used by layers and strokes */
    size_t pose_count;
    const MienMixReaction* reactions;      /* at most 16 */
    size_t reaction_count;
    const MienMixAntagonists* antagonists;
    size_t antagonist_count;
    const uint16_t* mirror;                /* for each lane its counterpart in the other half of the face,
                                              or itself. NULL: clips cannot be played mirrored */
    const float* lower;                    /* limits per lane. NULL: none; both or neither */
    const float* upper;
    const MienMixGuard* custom_guards;     /* numbered after the built-in ones; at most 8 guards in total */
    size_t custom_guard_count;
    const MienGaze* gaze;                  /* for a layer with MIEN_GENERATOR_GAZE; may be NULL */
    const MienDeformer* deformer;          /* to measure guards; may be NULL if there are none */
    uint32_t guards;                       /* MIEN_GUARD_... bits; a guard is left out if the rig lacks its
                                              landmarks */
    uint32_t variable_count;               /* pose variables; at most 4096 lanes with the raw controls */
    uint32_t player_count;                 /* clips that can play at the same time; a crossfade needs two.
                                              0: two for each clip layer */
    uint32_t max_channels;                 /* of any clip. 0: the number of raw controls */
    uint32_t max_changing_channels;        /* of any clip. 0: max_channels, 512 at most */
    uint32_t max_events;                   /* events that one step can report. 0: 64 */
    uint32_t reverse;                      /* boolean: as in MienClipPlayerDesc */
    uint32_t reserved;                     /* 0 */
    const MienAllocator* allocator;
} MienMixDesc;
MIEN_DEFAULT(MienMixDesc, mien_mix_desc_default)

/* Creates a mix for a rig. `desc` is required. `rig` may be destroyed afterwards, and so may the
 * deformer. Measuring guards takes time: it evaluates and deforms the rig at LOD 0 for each raw control
 * and for pairs of raw controls that share a corrective. Destroy with mien_mix_destroy().
 * Fails with MIEN_ERROR_MISMATCH if the deformer or the gaze is for another rig, MIEN_ERROR_INDEX if a
 * landmark names a mesh, position or joint that does not exist, MIEN_ERROR_INVALID_ARGUMENT if a field
 * of `desc` is out of range; the message names it, MIEN_ERROR_DNA_LIMIT if guards are measured and raw
 * controls times joints exceed 2^22. */
MIEN_CHECKED MienStatus mien_mix_create(const MienRig* rig, const MienMixDesc* desc,
                                        MienMix** out_mix, MienError* error);

/* How to open a mix. */
typedef struct MienMixOpenDesc {
    size_t struct_size;
    const MienAllocator* allocator;
} MienMixOpenDesc;
MIEN_DEFAULT(MienMixOpenDesc, mien_mix_open_desc_default)

/* Opens a mix for a rig, which must have all controls that the mix uses; names match as in
 * mien_clip_binding_create(). For other controls of the rig, the masks of the file are 0 and there are no
 * limits. Guards and gaze are those measured when the mix was created. `rig` may be NULL: then the raw
 * controls are those of the file, to inspect it or to write it again. `rig` may be destroyed afterwards.
 * A hostile file may make mixers large: check MienMixInfo.mixer_bytes. Destroy with mien_mix_destroy().
 * Fails with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ if the file cannot be read,
 * MIEN_ERROR_MIX_SIGNATURE, MIEN_ERROR_MIX_VERSION, MIEN_ERROR_MIX_TRUNCATED, MIEN_ERROR_MIX_CHECKSUM or
 * MIEN_ERROR_MIX_STRUCTURE if it is not a valid mix, MIEN_ERROR_NAME if the rig lacks controls; the
 * message names them. */
MIEN_CHECKED MienStatus mien_mix_open_file(const char* path, const MienRig* rig,
                                           const MienMixOpenDesc* desc, MienMix** out_mix,
                                           MienError* error);

/* Opens a mix in memory. `bytes` may be released afterwards. `rig` may be NULL. `rig` may be destroyed
 * afterwards.
 * Fails like mien_mix_open_file(), but not with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ. */
MIEN_CHECKED MienStatus mien_mix_open_memory(const void* bytes, size_t size, const MienRig* rig,
                                             const MienMixOpenDesc* desc, MienMix** out_mix,
                                             MienError* error);

/* Writes a mix to a file: the arguments of mien_mix_create(), what it measured, and the names of the
 * controls that the mix uses. Equal mixes give the same bytes on every machine; a mix that was opened is
 * written with the bytes of its file. The file is written under a temporary name and renamed, so that a
 * failure leaves `path` unchanged. Takes memory from the allocator of the mix during the call.
 * Fails with MIEN_ERROR_MEMORY if that returns NULL, MIEN_ERROR_NAME if two of these controls have the
 * same name, MIEN_ERROR_FILE_WRITE if the file cannot be written. */
MIEN_CHECKED MienStatus mien_mix_write_file(const MienMix* mix, const char* path, MienError* error);

/* Writes a mix to memory and returns its size in `out_size`. `buffer` may be NULL with capacity 0 to get
 * the size only. Writes nothing if `capacity` is too small; `out_size` is set nevertheless.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small, MIEN_ERROR_MEMORY and MIEN_ERROR_NAME
 * if mien_mix_write_file() would fail with them. */
MIEN_CHECKED MienStatus mien_mix_write_memory(const MienMix* mix, void* buffer, size_t capacity,
                                              size_t* out_size, MienError* error);

/* Writes a mix as text, for reading and for version control: one line for each number, with its path in
 * the mix and the names of controls. Floats have nine digits, enough to restore their bits. The text
 * cannot be opened as a mix, and is not null-terminated. `buffer` may be NULL with capacity 0 to get the
 * size only.
 * Fails like mien_mix_write_memory(). */
MIEN_CHECKED MienStatus mien_mix_write_text(const MienMix* mix, void* buffer, size_t capacity,
                                            size_t* out_size, MienError* error);

/* Destroys a mix. Its mixers stay valid; its memory is released with the last of them. */
MIEN_API void mien_mix_destroy(MienMix* mix);

/* Properties of a mix. */
typedef struct MienMixInfo {
    size_t struct_size;
    uint32_t raw_control_count;
    uint32_t variable_count;
    uint32_t lane_count;     /* raw controls and pose variables */
    uint32_t layer_count;
    uint32_t stage_count;    /* for mien_mixer_stage() */
    uint32_t guard_count;    /* for mien_mixer_set_guard() */
    uint64_t mixer_bytes;    /* memory of a mixer without MienMixerDesc.stages */
    uint64_t snapshot_bytes; /* size of a snapshot */
} MienMixInfo;
MIEN_DEFAULT(MienMixInfo, mien_mix_info_default)

/* Returns the properties of a mix. */
MIEN_CHECKED MienStatus mien_mix_info(const MienMix* mix, MienMixInfo* out_info);

/* A guard of a mix, as it was measured: the distance in millimeters is `rest`, plus the sum of gain * lane,
 * plus a sum over pairs of lanes that share a corrective. See docs/mixing.md, 4 "Guards". */
typedef struct MienMixGuardInfo {
    size_t struct_size;
    MienIndex16View lanes; /* raw controls that change the distance, by descending gain */
    MienFloatView gains;   /* 1 float per lane: millimeters at value 1 */
    uint32_t pair_count;
    uint32_t needs_speech; /* boolean: as in MienMixGuard */
    float rest;            /* distance of a row of zeros */
    float tolerance;       /* as in MienMixGuard */
    float f_on;
    float fit_error;       /* millimeters, root mean square over the measured rows */
} MienMixGuardInfo;
MIEN_DEFAULT(MienMixGuardInfo, mien_mix_guard_info_default)

/* Returns the measured function of a guard. `guard_index` counts as in mien_mixer_set_guard(), from 0 to
 * MienMixInfo.guard_count - 1; mien_mixer_guard() has its name.
 * Fails with MIEN_ERROR_INDEX if there is no such guard. */
MIEN_CHECKED MienStatus mien_mix_guard(const MienMix* mix, uint32_t guard_index,
                                       MienMixGuardInfo* out_guard);

/* Returns a ready-made reaction to a light in the eyes, with 5 strokes. The caller provides its poses, from
 * `first_pose` on: lids closed; squint and lowered brows; gaze turned away; narrow pupils; head turned
 * away. docs/mixing.md, 3 "Reactions" lists the times. `out_reaction` refers to `out_strokes`.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if `stroke_count` is less than 5. */
MIEN_CHECKED MienStatus mien_mix_glare(uint32_t first_pose, MienMixStroke* out_strokes,
                                       size_t stroke_count, MienMixReaction* out_reaction);

/* Finds antagonists: pairs of raw controls that only the two halves of one GUI control drive. Writes as
 * many as fit, with stiffness 1; `out_count` is the total number. `out_pairs` may be NULL if `capacity` is
 * 0. Raw controls from 4096 on, which no mix has, are left out. */
MIEN_CHECKED MienStatus mien_mix_antagonists(const MienRig* rig, MienMixAntagonists* out_pairs,
                                             size_t capacity, size_t* out_count);

/* Finds the counterparts of raw controls in the other half of the face, for MienMixDesc.mirror. Controls
 * are counterparts if their names differ only in Left and Right (or L and R) and their motions agree, or
 * else if their motions are mirror images. Other controls, and lanes beyond the raw controls, map to
 * themselves. Evaluates the rig once for each raw control, and takes memory from its allocator during
 * the call.
 * Fails with MIEN_ERROR_MEMORY if that returns NULL, MIEN_ERROR_MISMATCH if `lane_count` is less than the
 * raw controls, MIEN_ERROR_DNA_LIMIT if raw controls times joints exceed 2^22. */
MIEN_CHECKED MienStatus mien_mix_mirror(const MienDeformer* deformer, uint16_t* out_lanes,
                                        size_t lane_count, MienError* error);

/* Computes a mask that selects joint groups: for each raw control the share of its joint motion, at
 * value 1 and LOD 0, that belongs to these groups. A millimeter counts as much as a degree. Controls
 * that move no joint, and lanes beyond the raw controls, get `otherwise_weight`. Evaluates the rig once
 * for each raw control and group, and takes memory from its allocator during the call.
 * Fails with MIEN_ERROR_MEMORY if that returns NULL, MIEN_ERROR_INDEX if a group does not exist,
 * MIEN_ERROR_MISMATCH if `lane_count` is less than the raw controls. */
MIEN_CHECKED MienStatus mien_mix_mask(const MienRig* rig, const uint32_t* groups, size_t group_count,
                                      float otherwise_weight, float* out_mask, size_t lane_count,
                                      MienError* error);

/* How to create a gaze. */
typedef struct MienGazeDesc {
    size_t struct_size;
    const char* left_eye;  /* name of a joint. NULL: L_Eye or FACIAL_L_Eye */
    const char* right_eye; /* name of a joint. NULL: R_Eye or FACIAL_R_Eye */
    const MienAllocator* allocator;
} MienGazeDesc;
MIEN_DEFAULT(MienGazeDesc, mien_gaze_desc_default)

/* Creates a gaze by measuring how raw controls turn the eyes, which evaluates the rig at least twice per
 * raw control. `deformer` may be destroyed afterwards. Destroy with mien_gaze_destroy().
 * Fails with MIEN_ERROR_NAME if there are no such joints, MIEN_ERROR_INVALID_ARGUMENT if no raw
 * control turns an eye monotonically in one of the four directions. */
MIEN_CHECKED MienStatus mien_gaze_create(const MienDeformer* deformer, const MienGazeDesc* desc,
                                         MienGaze** out_gaze, MienError* error);

/* Destroys a gaze. */
MIEN_API void mien_gaze_destroy(MienGaze* gaze);

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
    float fit_error;         /* degrees, largest error found when an eye turns sideways and up at once */
    uint32_t reserved;       /* 0 */
} MienGazeInfo;
MIEN_DEFAULT(MienGazeInfo, mien_gaze_info_default)

/* Returns where the eyes are, so that a target can be placed in front of them. */
MIEN_CHECKED MienStatus mien_gaze_info(const MienGaze* gaze, MienGazeInfo* out_info);

/* The part of a gaze that the eyes cannot reach, left for the head to turn: tangents of angles, averaged
 * over both eyes. */
typedef struct MienGazeRest {
    float left;
    float up;
} MienGazeRest;

/* Sets the raw controls of a row so that both eyes look at a target. Eyes converge on near targets.
 * `out_rest` may be NULL. Does not allocate or lock.
 * Fails with MIEN_ERROR_MISMATCH if `row_count` is less than the raw controls, MIEN_ERROR_INVALID_ARGUMENT
 * if the target is not finite. */
MIEN_CHECKED MienStatus mien_gaze_look_at(const MienGaze* gaze, const MienGazeTarget* target, float* row,
                                          size_t row_count, MienGazeRest* out_rest);

/* ---- Mixer ----------------------------------------------------------------------------------- */

/* One character in a mix: its running clips, fades and reactions. Another thread may only call
 * mien_mixer_push() at the same time. */
typedef struct MienMixer MienMixer;

/* How to create a mixer. */
typedef struct MienMixerDesc {
    size_t struct_size;
    uint64_t seed;     /* of the generators */
    uint32_t stages;   /* boolean: keep the row after each stage, for mien_mixer_stage() */
    uint32_t reserved; /* 0 */
    const MienAllocator* allocator;
} MienMixerDesc;
MIEN_DEFAULT(MienMixerDesc, mien_mixer_desc_default)

/* Creates a mixer at time 0, with one allocation. No clip plays; pose weights and pose variables are 0.
 * `mix` may be destroyed before it. Destroy with mien_mixer_destroy(). */
MIEN_CHECKED MienStatus mien_mixer_create(const MienMix* mix, const MienMixerDesc* desc,
                                          MienMixer** out_mixer, MienError* error);

/* Destroys a mixer. */
MIEN_API void mien_mixer_destroy(MienMixer* mixer);

/* How a layer changes to another clip. A layer that plays no clip fades in, except with a cut. */
enum MienTransition {
    MIEN_TRANSITION_INERTIAL = 0,  /* the old clip stops; each lane blends from its last value and speed */
    MIEN_TRANSITION_CROSSFADE = 1, /* both clips play; MIEN_TRANSITION_INERTIAL if no player is free */
    MIEN_TRANSITION_CUT = 2        /* immediate; transition_ticks is not used */
};

/* How to play a clip in a layer. */
typedef struct MienPlayDesc {
    size_t struct_size;
    uint64_t clip_id;          /* chosen by the caller, to identify clip and binding in
                                  mien_mixer_restore() */
    int64_t start_tick;        /* in the clip */
    int64_t transition_ticks;  /* 0 to 2^40 */
    uint32_t transition;       /* MIEN_TRANSITION_... */
    uint32_t looping;          /* MIEN_LOOPING_... */
    uint32_t interpolation;    /* MIEN_INTERPOLATION_... */
    int32_t speed_numerator;   /* as in MienClipPlayerDesc */
    int32_t speed_denominator;
    uint32_t mirrored;         /* boolean; requires MienMixDesc.mirror */
} MienPlayDesc;
MIEN_DEFAULT(MienPlayDesc, mien_play_desc_default)

/* Plays a clip in a layer, from the next step on. `clip` and `clip_binding` must outlive their playback,
 * including the transition to the next clip. On failure the layer continues as before. Does not allocate or
 * lock.
 * Fails with MIEN_ERROR_INDEX if the layer does not exist or has another source, MIEN_ERROR_MISMATCH if
 * the binding is for another clip or rig, MIEN_ERROR_INVALID_ARGUMENT if a time, speed or enum value is
 * out of range or a delta clip would play in a layer that overrides, MIEN_ERROR_CLIP_LIMIT if the clip is
 * larger than the mix allows. */
MIEN_CHECKED MienStatus mien_mixer_play(MienMixer* mixer, uint32_t layer, const MienClip* clip,
                                        const MienClipBinding* clip_binding,
                                        const MienPlayDesc* desc, MienError* error);

/* Fades out the clip of a layer and stops it. Fades take 0 to 2^40 ticks, here and below; they start from
 * the current value and speed, and end with speed 0. Does not allocate or lock.
 * Fails with MIEN_ERROR_INDEX if the layer does not exist or is not a clip layer. */
MIEN_CHECKED MienStatus mien_mixer_stop(MienMixer* mixer, uint32_t layer, int64_t fade_ticks);

/* Fades the weight of a layer to `weight`, which has the range of MienMixLayer.weight. Does not allocate or
 * lock.
 * Fails with MIEN_ERROR_INDEX if the layer does not exist. */
MIEN_CHECKED MienStatus mien_mixer_set_weight(MienMixer* mixer, uint32_t layer, float weight,
                                              int64_t fade_ticks);

/* Fades the weight of a pose to `weight`, 0 to 1. `pose` counts from the first pose of the layer. Weights
 * of a layer that add up to more than 1 are divided by their sum. Does not allocate or lock.
 * Fails with MIEN_ERROR_INDEX if the layer or its pose does not exist. */
MIEN_CHECKED MienStatus mien_mixer_set_pose_weight(MienMixer* mixer, uint32_t layer, uint32_t pose,
                                                   float weight, int64_t fade_ticks);

/* Sets the `value` that a pose variable has at the start of each step, before the layers. Does not
 * allocate or lock.
 * Fails with MIEN_ERROR_INDEX if it does not exist, MIEN_ERROR_INVALID_ARGUMENT if the value is not
 * finite. */
MIEN_CHECKED MienStatus mien_mixer_set_variable(MienMixer* mixer, uint32_t variable, float value);

/* Sets how much a guard acts: `activation` is 0 to 1, or negative for automatic, the default: the smaller
 * the gap that base and speech leave, the more the guard acts; guards of lips and teeth act at most as
 * much as the largest weight of a speech layer. mien_mixer_guard() returns the name for a `guard_index`.
 * Does not allocate or lock.
 * Fails with MIEN_ERROR_INDEX if the guard does not exist, MIEN_ERROR_INVALID_ARGUMENT if `activation` is
 * above 1 or not a number. */
MIEN_CHECKED MienStatus mien_mixer_set_guard(MienMixer* mixer, uint32_t guard_index,
                                             float activation);

/* What a guard did in the last step. Distances are in millimeters, computed by the function of raw controls
 * that was measured on the rig; a negative distance means that both sides overlap. */
typedef struct MienGuardState {
    size_t struct_size;
    MienStringView name;       /* "lips left", "lips center", "lips right", "teeth", "lower lip to teeth",
                                  "left lids", "right lids" or "custom" */
    MienIndex16View controls;  /* raw controls that it may hold back */
    uint32_t kind;             /* MIEN_GUARD_...; 0: one of MienMixDesc.custom_guards */
    float activation;          /* how much it acted, 0 to 1 */
    float protected_distance;  /* distance after the last layer of base and speech */
    float wanted;              /* distance just before the guards, after the later layers and reactions */
    float limit;               /* largest distance that the guard allows when fully active */
    float distance;            /* distance after the guards: above `limit` if the guard is not fully
                                  active, while it eases in, or if other controls open the gap */
} MienGuardState;
MIEN_DEFAULT(MienGuardState, mien_guard_state_default)

/* Returns what a guard did in the last step. `guard_index` counts as in mien_mixer_set_guard(). Views point
 * into the mix.
 * Fails with MIEN_ERROR_INDEX if the guard does not exist. */
MIEN_CHECKED MienStatus mien_mixer_guard(const MienMixer* mixer, uint32_t guard_index,
                                         MienGuardState* out_state);

/* Starts a reaction to a stimulus of `strength`, 0 to 1, that lasts for `hold_ticks`, at most 2^40; if
 * negative, until mien_mixer_release(). Does not allocate or lock.
 * Fails with MIEN_ERROR_INDEX if the reaction does not exist, MIEN_ERROR_INVALID_ARGUMENT if strength or
 * time is out of range. */
MIEN_CHECKED MienStatus mien_mixer_trigger(MienMixer* mixer, uint32_t reaction, float strength,
                                           int64_t hold_ticks);

/* Ends the stimulus of a reaction. Does not allocate or lock.
 * Fails with MIEN_ERROR_INDEX if the reaction does not exist. */
MIEN_CHECKED MienStatus mien_mixer_release(MienMixer* mixer, uint32_t reaction);

/* Sets the level of what a reaction responds to, such as a brightness, 0 to 1. Call it whenever the level
 * changes. A level of MienMixReaction.level_on or more is a stimulus of strength 1, which ends once the
 * level has been below level_off for 50 ms, so a flickering light counts as on. During the stimulus, scaled
 * strokes follow the level without overshoot; 90 % of a change takes 0.25 s. Does not allocate or lock.
 * Fails with MIEN_ERROR_INDEX if the reaction does not exist, MIEN_ERROR_INVALID_ARGUMENT if it has no
 * level_on or `level` is out of range. */
MIEN_CHECKED MienStatus mien_mixer_set_level(MienMixer* mixer, uint32_t reaction, float level);

/* Queues a row for a stream layer: one value per channel, for time `tick` of the mixer. One thread may call
 * this while another one uses the mixer. `out_accepted` may be NULL; it is set to 0 if the row is dropped
 * because it is not newer than the last one or the queue is full. Does not allocate or lock.
 * Fails with MIEN_ERROR_INDEX if the layer does not exist or is not a stream, MIEN_ERROR_MISMATCH if it has
 * another number of channels, MIEN_ERROR_INVALID_ARGUMENT if a value is not finite or `tick` is 2^61 or
 * more. */
MIEN_CHECKED MienStatus mien_mixer_push(MienMixer* mixer, uint32_t layer, int64_t tick,
                                        const float* values, size_t value_count,
                                        uint32_t* out_accepted);

/* Advances the time by `ticks`, 0 to 2^40, and mixes. Writes the raw controls to `instance`, which may
 * be NULL. Does not allocate or lock.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if `ticks` is out of range or the time would exceed 2^60 ticks
 * (51 years), MIEN_ERROR_MISMATCH if the instance has another number of raw controls. */
MIEN_CHECKED MienStatus mien_mixer_step(MienMixer* mixer, int64_t ticks, MienInstance* instance);

/* Steps `count` mixers; instances[i] belongs to mixers[i]. `instances` may be NULL. The results are those
 * of single calls. On failure no mixer is advanced.
 * Fails like mien_mixer_step(), and with MIEN_ERROR_INVALID_ARGUMENT if a mixer is listed twice. */
MIEN_CHECKED MienStatus mien_mixer_step_batch(MienMixer* const* mixers,
                                              MienInstance* const* instances, size_t count,
                                              int64_t ticks);

/* Returns the row of the last step, one float per lane: raw controls, then pose variables.
 * Contents change with mien_mixer_step() and mien_mixer_step_batch(). */
MIEN_CHECKED MienStatus mien_mixer_row(const MienMixer* mixer, MienFloatView* out_row);

/* Returns the row after a stage of the last step, one float per lane. Stages are numbered: the layers,
 * then reactions, guards, antagonists, limits. Layers that act after the reactions or the guards keep
 * their numbers.
 * Fails with MIEN_ERROR_INDEX if the stage does not exist, MIEN_ERROR_INVALID_ARGUMENT if
 * MienMixerDesc.stages was 0.
 * Contents change with mien_mixer_step() and mien_mixer_step_batch(). */
MIEN_CHECKED MienStatus mien_mixer_stage(const MienMixer* mixer, uint32_t stage,
                                         MienFloatView* out_row);

/* State of a mixer. */
typedef struct MienMixerInfo {
    size_t struct_size;
    int64_t tick;         /* time since creation */
    uint32_t event_count; /* clip events that the last step passed */
    uint32_t lost_events; /* boolean: there were more than MienMixDesc.max_events */
} MienMixerInfo;
MIEN_DEFAULT(MienMixerInfo, mien_mixer_info_default)

/* Returns the state of a mixer. */
MIEN_CHECKED MienStatus mien_mixer_info(const MienMixer* mixer, MienMixerInfo* out_info);

/* Returns an event of the last step and its layer. The tick is in the time of the clip, and the name is a
 * view into the clip.
 * Fails with MIEN_ERROR_INDEX if `index` is out of range. */
MIEN_CHECKED MienStatus mien_mixer_event(const MienMixer* mixer, uint32_t index,
                                         MienClipEvent* out_event, uint32_t* out_layer);

/* Writes the state of a mixer to memory: everything that later steps depend on, except queued stream rows.
 * Returns its size in `out_size`. `buffer` may be NULL with capacity 0 to get the size only. Snapshots
 * can be restored on 64-bit machines of the same byte order. Does not allocate or lock.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small. */
MIEN_CHECKED MienStatus mien_mixer_snapshot(MienMixer* mixer, void* buffer, size_t capacity,
                                            size_t* out_size, MienError* error);

/* A clip that mien_mixer_restore() may need. */
typedef struct MienMixerClip {
    uint64_t clip_id; /* as in MienPlayDesc */
    const MienClip* clip;
    const MienClipBinding* clip_binding;
} MienMixerClip;

/* Restores a snapshot of a mixer of the same mix; later steps give the same bits. Queued stream rows are
 * not part of it. `clips` lists the clips that may have been playing. The bytes are validated, so they
 * need not be trusted. On failure the mixer does not change. Does not allocate or lock.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if the bytes are not a snapshot of this mix,
 * MIEN_ERROR_MISMATCH if a clip is missing or is not the one that was playing. */
MIEN_CHECKED MienStatus mien_mixer_restore(MienMixer* mixer, const void* bytes, size_t size,
                                           const MienMixerClip* clips, size_t clip_count,
                                           MienError* error);

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
    uint32_t target_joint; /* its position is the target. MIEN_NO_JOINT: three lanes of the row are */
    uint32_t target_lane;  /* first of these three: x y z in model space */
    float axis[3];         /* aim axis, in the space of the joint; not 0 0 0 */
    float up_axis[3];      /* in the space of the joint; 0 0 0: no rotation about the aim axis */
    float up[3];           /* in model space; 0 0 0: 0 1 0 */
    float cone_degrees;    /* 0 to 180: largest angle from the neutral direction. 0: no limit */
    float weight;          /* 0 to 1 */
} MienAimSolver;

/* Space switch: moves a joint as if its parent were attached to another joint. A lane selects one of the
 * spaces. When it changes, the joint stays where it is, and the difference to the new space eases out. */
typedef struct MienSpaceSolver {
    int64_t ease_ticks;     /* 0 to 2^40 */
    const uint16_t* spaces; /* indices of joints. MIEN_NO_JOINT: model space */
    uint32_t space_count;   /* 1 to 8 */
    uint32_t lane;          /* of the row: its value, rounded, is an index in `spaces` */
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
    const float* row;      /* MienSolverStackDesc.lane_count floats. NULL: there are none */
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
    uint32_t lane_count;       /* the rows passed to steps have this many lanes or more. 0: no row */
    uint32_t check_writes;     /* boolean: compare all joints before and after each solver, to find
                                  undeclared writes: mien_solver_state_undeclared() */
    const MienAllocator* allocator;
} MienSolverStackDesc;
MIEN_DEFAULT(MienSolverStackDesc, mien_solver_stack_desc_default)

/* Creates a solver stack. `desc` is required. `deformer` may be destroyed before it. Destroy with
 * mien_solver_stack_destroy().
 * Fails with MIEN_ERROR_INDEX if a joint or lane does not exist, MIEN_ERROR_INVALID_ARGUMENT if a number
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
    uint32_t lane_count;
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
    size_t row_count;   /* at least MienSolverStackDesc.lane_count */
    uint32_t lod;       /* 0 to 63 */
    uint32_t is_reset;  /* boolean: the character was teleported, so springs come to rest and space
                           switches do not ease */
} MienSolverInput;

/* Runs the solvers on the pose of `deformer_instance`. Call mien_deformer_instance_update() before every
 * step. `input` may be NULL: no row, LOD 0. `ticks`, the time since the last step, is 0 to
 * 2^40. Does not allocate or lock.
 * Fails with MIEN_ERROR_MISMATCH if instance and stack have different deformers or the row is
 * shorter than MienSolverStackDesc.lane_count, MIEN_ERROR_INVALID_ARGUMENT if `ticks` or the LOD is out of
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

#endif /* MIEN_H */
