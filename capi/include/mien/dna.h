/* SPDX-License-Identifier: MIT
 *
 * DNA files: opening, reading fields, writing, validating.
 * The rules of mien.h apply.
 */
#ifndef MIEN_DNA_H
#define MIEN_DNA_H

#include "base.h"

#ifdef __cplusplus
extern "C" {
#endif

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
 * completely. Layers that were not loaded are written empty. Another version may lack layers that others
 * need, such as the ML operations of networks; a file that could not be opened again is never written. The
 * file is written under a temporary name and renamed, so that a failure leaves `path` unchanged. An
 * existing file keeps its permissions; a symbolic link is followed, unless it leads nowhere.
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

#ifdef __cplusplus
}
#endif

#endif /* MIEN_DNA_H */
