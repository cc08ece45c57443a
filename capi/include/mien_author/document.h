/* SPDX-License-Identifier: MIT
 *
 * Documents: DNA files that can be changed. A chapter of mien_author.h, which includes it.
 */
#ifndef MIEN_AUTHOR_DOCUMENT_H
#define MIEN_AUTHOR_DOCUMENT_H

#ifndef MIEN_AUTHOR_H
#error "include mien_author.h"
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Documents -------------------------------------------------------------------------------- */

/* A DNA file that can be changed: field by field, with the paths of mien_dna_field(), and by operations
 * that keep all references consistent. Every change happens completely or, if the call fails, not at all.
 * Everything else stays as it is, byte for byte. Memory is taken for the file that was opened, unless it
 * is mapped, and for changed fields. */
typedef struct MienDocument MienDocument;

typedef struct MienDocumentDesc {
    size_t struct_size;
    const MienAllocator* allocator;
    uint32_t file_access;    /* MIEN_FILE_...; for mien_document_open_file() only */
    uint32_t unknown_layers; /* MIEN_UNKNOWN_LAYERS_...; for mien_document_open_file() only */
} MienDocumentDesc;
MIEN_DEFAULT(MienDocumentDesc, mien_document_desc_default)

/* Makes a document of an open file, as it was loaded: layers and LODs that were left out are not in it.
 * `dna` may be NULL, for an empty document of version 2.8 with all layers. `dna` may be closed
 * afterwards. Destroy with mien_document_destroy().
 * Fails with MIEN_ERROR_DNA_LAYER if `dna` has RBF behavior without the machine-learned behavior of its
 * file, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE or MIEN_ERROR_DNA_VALUE if the loaded part would
 * not open by itself, MIEN_ERROR_DNA_LIMIT if it exceeds 4 GiB. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_create(const MienDna* dna, const MienDocumentDesc* desc,
                                                    MienDocument** out_document, MienError* error);

/* Opens a whole DNA file as a document, with the checks of mien_dna_open_file(), without a second copy in
 * memory. Do not truncate or overwrite a mapped file while the document exists; replacing it by renaming is safe,
 * and so is mien_document_write_file() to the same path, except on Windows, where a mapped file cannot be
 * replaced: use MIEN_FILE_READ. Destroy with mien_document_destroy().
 * Fails like mien_dna_open_file(), but not with MIEN_ERROR_LOD. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_open_file(const char* path, const MienDocumentDesc* desc,
                                                       MienDocument** out_document, MienError* error);

/* Destroys a document. */
MIEN_AUTHOR_API void mien_document_destroy(MienDocument* document);

/* ---- Documents: fields ------------------------------------------------------------------------ */

/* Finds a field by its path, like mien_dna_field(). Its byte_offset is MIEN_NO_OFFSET.
 * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is past
 * the end.
 * See docs/dna-format.md, 6 "Layers, field by field". */
MIEN_AUTHOR_CHECKED MienStatus mien_document_field(const MienDocument* document, const char* path,
                                                   MienDnaField* out_field, MienError* error);

/* Returns the name of field `index` of the record at a path, like mien_dna_child_name(). The string is
 * static.
 * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if `index` or an index in the
 * path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a record. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_child_name(const MienDocument* document,
                                                        const char* path, uint32_t index,
                                                        MienStringView* out_name, MienError* error);

/* Copies `count` elements of a field, beginning with element `first`, to `out`, like
 * mien_dna_read_floats(). `out` may be NULL if `count` is 0.
 * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
 * the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
 * kind. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_read_floats(const MienDocument* document,
                                                         const char* path, uint64_t first,
                                                         uint64_t count, float* out,
                                                         MienError* error);
MIEN_AUTHOR_CHECKED MienStatus mien_document_read_integers(const MienDocument* document,
                                                           const char* path, uint64_t first,
                                                           uint64_t count, int64_t* out,
                                                           MienError* error);

/* Returns a string. Contents change with mien_document_write_string(), mien_document_undo(): the view
 * is valid until the document is changed.
 * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is
 * past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a string. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_read_string(const MienDocument* document,
                                                         const char* path,
                                                         MienStringView* out_string,
                                                         MienError* error);

/* Returns the bytes of an array of numbers or of a string in place: big-endian and unaligned, as in a file.
 * Contents change with mien_document_write_floats(), mien_document_write_integers(), mien_document_undo():
 * the view is valid until the document is changed.
 * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is
 * past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is neither an array nor a string. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_bytes(const MienDocument* document, const char* path,
                                                   MienStringView* out_bytes, MienError* error);

/* Replaces `count` elements of an array, beginning with element `first`, or a single number. The first write
 * to an array after a mark or an operation copies it, later ones do not. `values` may be NULL if `count`
 * is 0.
 * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
 * the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field does not hold numbers of this
 * kind, or none of this size, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_write_floats(MienDocument* document, const char* path,
                                                          uint64_t first, uint64_t count,
                                                          const float* values, MienError* error);
MIEN_AUTHOR_CHECKED MienStatus mien_document_write_integers(MienDocument* document, const char* path,
                                                            uint64_t first, uint64_t count,
                                                            const int64_t* values,
                                                            MienError* error);

/* Replaces a string by `string_count` bytes. `string` may be NULL if `string_count` is 0.
 * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is past
 * the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a string, or if another element of a list of
 * names has this name, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_write_string(MienDocument* document, const char* path,
                                                          const char* string, size_t string_count,
                                                          MienError* error);

/* Replaces `removed_count` elements of an array or list, beginning with element `first`, by
 * `inserted_count` new ones: zeros, empty strings, or records of these. References to elements by number do
 * not change. Copies the array, or the list without its contents.
 * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
 * the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is neither an array nor a list, or
 * would have more than 2^32 - 1 elements, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_splice(MienDocument* document, const char* path,
                                                    uint64_t first, uint64_t removed_count,
                                                    uint64_t inserted_count, MienError* error);

/* Gives an array or list `count` elements: drops the last ones or adds new ones, like
 * mien_document_splice().
 * Fails like mien_document_splice(). */
MIEN_AUTHOR_CHECKED MienStatus mien_document_resize(MienDocument* document, const char* path,
                                                    uint64_t count, MienError* error);

/* ---- Documents: layers ------------------------------------------------------------------------ */

/* Returns the version of the file that the document becomes, 2.`out_version`, and the length of its list of
 * layers. A file also has the layers that its version defines and the list lacks, behind the others. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_layer_count(const MienDocument* document,
                                                         uint32_t* out_version, uint32_t* out_count,
                                                         MienError* error);

/* Returns layer `index` of the list, as mien_dna_layer(); byte_offset is MIEN_NO_OFFSET. `out_bytes` gets the
 * contents of a layer of an unknown kind, else nothing. Contents change with mien_document_clear_layers(),
 * mien_document_undo(): the view is valid until the document is changed.
 * Fails with MIEN_ERROR_INDEX if `index` is past the end. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_layer(const MienDocument* document, uint32_t index,
                                                   MienDnaLayer* out_layer,
                                                   MienStringView* out_bytes, MienError* error);

/* Makes the document a file of version 2.`version` and its list of layers empty: layers of unknown kinds
 * are gone, fields stay as they are. mien_document_add_layer() fills the list again.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if `version` is not 1 to 65535, MIEN_ERROR_MEMORY if the allocator
 * returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_clear_layers(MienDocument* document, uint32_t version,
                                                          MienError* error);

/* Appends a layer to the list: the layer of a known kind, without bytes, or `size` bytes of an
 * unknown kind, which are written to the file as they are. `code` has four characters, such as "bhvr"; the
 * layer is of version `version_major`.`version_minor`. `bytes` may be NULL if `size` is 0.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if `code` has another length, a version is above 65535, the list has a
 * layer of this code and version already, the kind is known and has bytes, or a file of version 2.1 cannot
 * have it, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_add_layer(MienDocument* document, const char* code,
                                                       uint32_t version_major,
                                                       uint32_t version_minor, const void* bytes,
                                                       size_t size, MienError* error);

/* ---- Documents: undoing ----------------------------------------------------------------------- */

/* Remembers the current state, at the cost of some KB. Mark 0 always exists: the state in which the
 * document was created. Changes before a mark keep their memory until the document is destroyed or an
 * earlier mark is restored.
 * Fails with MIEN_ERROR_MEMORY if the allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_mark(MienDocument* document, uint64_t* out_mark,
                                                  MienError* error);

/* Goes back to the state at a mark: `mark` is a number from mien_document_mark(), or 0. Later marks become
 * invalid, this one stays valid. Does not allocate or lock.
 * Fails with MIEN_ERROR_INDEX if `mark` is not a valid mark of the document. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_undo(MienDocument* document, uint64_t mark,
                                                  MienError* error);

/* ---- Documents: operations -------------------------------------------------------------------- */

/* Operations first check the document, as a file is checked when it is opened, and fail with the status of
 * the first field that is not valid. They keep all references consistent; removing elements renumbers the
 * others. */

/* Finds the index of a name; of equal names, the first. `kind` is a MIEN_KIND_...: GUI, raw, PSD ("psd0",
 * "psd1", ...), ML and RBF controls, joints, blend shape channels, animated maps, meshes.
 * Fails with MIEN_ERROR_NAME if there is no such name, MIEN_ERROR_INVALID_ARGUMENT if the kind has no names
 * in a document. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_find(const MienDocument* document, uint32_t kind,
                                                  const char* name, uint32_t* out_index,
                                                  MienError* error);

/* Renames element `index` of a kind of mien_document_find() but PSD controls.
 * Fails with MIEN_ERROR_INDEX if there is no such element, MIEN_ERROR_INVALID_ARGUMENT if another element
 * of the kind has the name, or the kind has no names in a document, MIEN_ERROR_MEMORY if the allocator
 * returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_rename(MienDocument* document, uint32_t kind,
                                                    uint32_t index, const char* name,
                                                    MienError* error);

/* Removes controls, joints, blend shape channels, animated maps or meshes, and everything that
 * refers to them: names, LOD lists, rows of tables, targets, regions of networks. `indices` has
 * `index_count` elements; PSD, ML and RBF controls are numbered from 0.
 * Children of a joint go to its nearest ancestor that stays, or become roots, and keep their neutral place
 * in the world; motions that are relative to the parent keep their numbers. The joint's skin weights go to
 * the same ancestor, or to the first joint that stays. Quaternion joints move as before within 1e-2
 * degrees; where the columns of a joint group would rotate them in another order, each quaternion joint of
 * the group gets a joint group of its own.
 * A raw, PSD, ML or RBF control is removed as if it stayed 0: with it go its columns of joint groups, its rows
 * of channels and animated maps, PSD controls that are products of it, RBF solvers, twists and swings that
 * read it, its inputs of networks, and the outputs of networks and RBF poses that set it. Networks that ML
 * operations run cannot lose one: their controls are refused. Files before 2.5 cannot lose RBF controls.
 * Fails with MIEN_ERROR_INDEX if an index is past the end, MIEN_ERROR_INVALID_ARGUMENT if the
 * networks or the version need a control, or no joint would be left for the skin
 * weights, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE
 * if the document is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_remove(MienDocument* document, uint32_t kind,
                                                    const uint32_t* indices, size_t index_count,
                                                    MienError* error);

/* Removes all blend shape channels with their targets, all animated maps, or, for MIEN_KIND_JOINT,
 * everything that moves joints. `kind` is a MIEN_KIND_....
 * Fails like mien_document_remove(), but not with MIEN_ERROR_INDEX. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_clear(MienDocument* document, uint32_t kind,
                                                   MienError* error);

/* Removes everything that moves these joints: their rows of joint groups, twists, swings and ML joints.
 * Fails like mien_document_remove(). */
MIEN_AUTHOR_CHECKED MienStatus mien_document_clear_joints(MienDocument* document,
                                                          const uint32_t* joints,
                                                          size_t joint_count, MienError* error);

/* Sets neutral transforms of joints from `first_joint` on, relative to their parents, in the units and
 * axes of the file: translations, 3 floats per joint, and rotations, 3 floats per joint. Either may be
 * left out: `translations` may be NULL; `rotations` may be NULL.
 * Fails with MIEN_ERROR_INDEX if there are fewer joints, MIEN_ERROR_INVALID_ARGUMENT if a number is not
 * finite, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE
 * if the document is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_set_neutral(MienDocument* document, uint32_t first_joint,
                                                         const float* translations,
                                                         const float* rotations, size_t count,
                                                         MienError* error);

/* Sets all positions of a mesh, 3 floats per position. Normals do not change: deformers recompute them by
 * default; otherwise write geom.meshes[i].normals.
 * Fails with MIEN_ERROR_INDEX if `mesh` is past the end, MIEN_ERROR_INVALID_ARGUMENT if the mesh has another
 * number of positions, or a number is not finite, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_set_positions(MienDocument* document, uint32_t mesh,
                                                           const float* positions,
                                                           size_t position_count,
                                                           MienError* error);

/* Sets the target of blend shape channel `channel` on mesh `mesh`: 3 floats per delta, of the positions
 * `vertices`. `vertices` may be NULL for the first `count` positions. Deltas of zero are left out; if there
 * are no others, the target is removed. The pair of mesh and channel in defn.meshBlendShapeChannelMapping
 * is added or removed with it.
 * Fails with MIEN_ERROR_INDEX if `mesh`, `channel` or a vertex is past the end, MIEN_ERROR_INVALID_ARGUMENT
 * if there are more deltas than positions, or a number is not finite, MIEN_ERROR_DNA_STRUCTURE,
 * MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid,
 * MIEN_ERROR_MEMORY if the allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_set_target(MienDocument* document, uint32_t mesh,
                                                        uint32_t channel, const uint32_t* vertices,
                                                        const float* deltas, size_t count,
                                                        MienError* error);

/* How many deltas and targets mien_document_prune_targets() removed. */
typedef struct MienPrunedTargets {
    size_t struct_size;
    uint64_t deltas;
    uint64_t targets;
} MienPrunedTargets;
MIEN_DEFAULT(MienPrunedTargets, mien_pruned_targets_default)

/* Removes deltas not longer than `tolerance`, in the unit of the file, and targets that have none left.
 * `out_pruned` gets their numbers.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if `tolerance` is negative or not finite, MIEN_ERROR_DNA_STRUCTURE,
 * MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid,
 * MIEN_ERROR_MEMORY if the allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_prune_targets(MienDocument* document, float tolerance,
                                                           MienPrunedTargets* out_pruned,
                                                           MienError* error);

/* The largest magnitudes of entries of the joint matrix that count as small, in the units of the file. */
typedef struct MienPruneJointsDesc {
    size_t struct_size;
    float translation;
    float rotation;
    float scale;
    uint32_t reserved; /* 0 */
} MienPruneJointsDesc;
MIEN_DEFAULT(MienPruneJointsDesc, mien_prune_joints_desc_default)

/* The effect of mien_document_prune_joints(): removed entries, and the largest distance by which a position
 * moved. */
typedef struct MienPrunedJoints {
    size_t struct_size;
    uint64_t entry_count; /* entries of the joint matrix that were not 0 */
    uint64_t removed_count; /* of these, set to 0 */
    double worst_distance;  /* in the unit of the file */
    uint32_t worst_control; /* the raw control at 1, or the corrective whose raw controls were at 1 */
    uint32_t worst_mesh;
    uint32_t worst_position;
    uint32_t reserved;
} MienPrunedJoints;
MIEN_DEFAULT(MienPrunedJoints, mien_pruned_joints_default)

/* Sets small entries of the joint matrix to 0, and removes columns and rows of joint groups that have no
 * others. Measures how far that moves the positions of LOD 0, with each raw control at 1, and with all raw
 * controls of each corrective at 1. `desc` is required.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if a field of `desc` is negative or not finite,
 * MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the
 * document is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_prune_joints(MienDocument* document,
                                                          const MienPruneJointsDesc* desc,
                                                          MienPrunedJoints* out_pruned,
                                                          MienError* error);

/* Sets the skin weights of a mesh: `influences` joints and weights per position, row by row. Weights of 0
 * are left out. `joints` has `weight_count` elements, as many as `weights`.
 * Fails with MIEN_ERROR_INDEX if `mesh` is past the end, MIEN_ERROR_INVALID_ARGUMENT if there is another
 * number of weights, a weight is negative or not finite, a joint does not exist, or a position has a
 * joint twice or no weight, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or
 * MIEN_ERROR_DNA_VALUE if the document is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_set_weights(MienDocument* document, uint32_t mesh,
                                                         uint32_t influences,
                                                         const uint16_t* joints,
                                                         const float* weights, size_t weight_count,
                                                         MienError* error);

/* Scales the weights of each position of mesh `mesh` to a sum of 1; sums within 1e-6 of it stay as they are.
 * Fails with MIEN_ERROR_INDEX if `mesh` is past the end, MIEN_ERROR_DNA_STRUCTURE,
 * MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid,
 * MIEN_ERROR_MEMORY if the allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_normalize_weights(MienDocument* document, uint32_t mesh,
                                                               MienError* error);

/* Keeps the `influences` largest weights of each position of mesh `mesh`, in their order, scaled to the
 * previous sum.
 * Fails like mien_document_normalize_weights(), and with MIEN_ERROR_INVALID_ARGUMENT if `influences` is 0. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_limit_influences(MienDocument* document, uint32_t mesh,
                                                              uint32_t influences, MienError* error);

/* Smooths the weights of mesh `mesh` `iterations` times: those of each position become (1 - strength) times
 * its own plus strength times the mean of its neighbors along edges. Positions at the same place count as
 * one. Each keeps at most `influences`, with a sum of 1.
 * Fails like mien_document_limit_influences(), and with MIEN_ERROR_INVALID_ARGUMENT if `strength` is not 0
 * to 1, or there are more than 1000 iterations. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_smooth_weights(MienDocument* document, uint32_t mesh,
                                                            uint32_t iterations, float strength,
                                                            uint32_t influences, MienError* error);

/* How to place a character: it is scaled about the origin, then rotated about it, then moved. */
typedef struct MienPlacement {
    size_t struct_size;
    double scale;          /* above 0. 0: 1 */
    double rotation[3];    /* right-handed degrees about x, then y, then z of the file */
    double translation[3]; /* in the unit of the file */
} MienPlacement;
MIEN_DEFAULT(MienPlacement, mien_placement_default)

/* Scales, rotates and moves the whole character: neutral joints, positions, normals, targets, and the
 * translations that controls add to joints. `placement` is required.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if a number is not finite or the scale is negative,
 * MIEN_ERROR_DNA_VALUE if a root joint is moved by controls and the rotation is not 0, networks translate
 * joints and the scale is not 1, or the document is not valid, MIEN_ERROR_DNA_STRUCTURE,
 * MIEN_ERROR_DNA_REFERENCE or MIEN_ERROR_DNA_LIMIT if the document is not valid, MIEN_ERROR_MEMORY if the
 * allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_place(MienDocument* document,
                                                   const MienPlacement* placement,
                                                   MienError* error);

/* Keeps the LODs whose bits are set in `lods`, like MienDnaDesc.lods.
 * Fails with MIEN_ERROR_LOD if none of them exists, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE,
 * MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid, MIEN_ERROR_MEMORY if the
 * allocator returns NULL.
 * See docs/dna-format.md, 10 "Choosing LODs". */
MIEN_AUTHOR_CHECKED MienStatus mien_document_keep_lods(MienDocument* document, uint64_t lods,
                                                       MienError* error);

/* Converts to another coordinate system, like MienDnaDesc.system. `system` is required.
 * Fails with MIEN_ERROR_DNA_VALUE if the rig cannot be converted or the document is not valid,
 * MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE or MIEN_ERROR_DNA_LIMIT if the document is not valid,
 * MIEN_ERROR_MEMORY if the allocator returns NULL.
 * See docs/dna-format.md, 11 "Coordinate systems". */
MIEN_AUTHOR_CHECKED MienStatus mien_document_convert(MienDocument* document,
                                                     const MienCoordinateSystem* system,
                                                     MienError* error);

/* ---- Documents: parts of other documents ------------------------------------------------------ */

/* Copies the layers of another document whose bits are set. `layers` is a MIEN_LAYER_..., combined with |.
 * Layers that refer to each other are copied together.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if `layers` has other bits, MIEN_ERROR_DNA_STRUCTURE,
 * MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if they do not fit the other
 * layers, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_copy_layers(MienDocument* document,
                                                         const MienDocument* from, uint32_t layers,
                                                         MienError* error);

/* Copies mesh `mesh` of another document. It replaces the mesh of the same name, or becomes a new one, at
 * its LODs in the other document as far as this document has them. Joints and channels are found by name;
 * the influence of a missing joint goes to its nearest ancestor that exists here, and targets of missing
 * channels are left out.
 * Fails with MIEN_ERROR_INDEX if there is no such mesh, MIEN_ERROR_INVALID_ARGUMENT if both documents are
 * the same, MIEN_ERROR_MISMATCH if the documents differ in axes, units or rotations, or this one has no
 * joint of a position, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or
 * MIEN_ERROR_DNA_VALUE if one of them is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_copy_mesh(MienDocument* document,
                                                       const MienDocument* from, uint32_t mesh,
                                                       uint32_t* out_mesh, MienError* error);

/* Adds the joints of another document whose names this one lacks, such as those of a body to a head: below
 * the joints with the names of their parents, numbered after the existing ones, at the LODs that list them
 * in the other document. Joints of both documents stay as they are, but a root that has a parent in the
 * other one becomes its child. They must have the same place in model space, within `tolerance` in the unit
 * of the file.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if both documents are the same, MIEN_ERROR_MISMATCH if they differ
 * in axes, units or rotations, or in the place of a joint, MIEN_ERROR_DNA_STRUCTURE,
 * MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if one of them is not valid or the
 * result would not be, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_merge_joints(MienDocument* document,
                                                          const MienDocument* from,
                                                          double tolerance, MienError* error);

/* Removes the joints whose names another document lacks, like mien_document_remove().
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if no joint would be left for the skin weights,
 * MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if
 * `document` is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_split_joints(MienDocument* document,
                                                          const MienDocument* from,
                                                          MienError* error);

/* ---- Documents: shapes ------------------------------------------------------------------------- */

/* How positions of one mesh are found on another. */
enum MienMatch {
    MIEN_MATCH_SURFACE = 0, /* the nearest point in space */
    MIEN_MATCH_UV = 1       /* the nearest point in the texture */
};

/* How mien_document_project() works. */
typedef struct MienProjectDesc {
    size_t struct_size;
    uint32_t match;        /* MIEN_MATCH_... */
    uint32_t influences;   /* at most, per position. 0: 8 */
    uint32_t keep_weights; /* boolean: leave the skin weights as they are */
    uint32_t keep_targets; /* boolean: leave the targets as they are */
} MienProjectDesc;
MIEN_DEFAULT(MienProjectDesc, mien_project_desc_default)

/* Gives mesh `mesh` the skin weights and targets of mesh `source`, interpolated at the point of `source`
 * nearest to each position: a coarser LOD from a finer one. The influence of joints that no LOD of the mesh
 * lists goes to the nearest ancestor that one of them lists; targets of channels that none lists are left
 * out. If these LODs list no joints or channels at all, all are kept. `out_farthest` gets the largest
 * distance to a nearest point, in the unit of the file or of the texture.
 * Fails with MIEN_ERROR_INDEX if `mesh` or `source` is past the end, MIEN_ERROR_INVALID_ARGUMENT if they are
 * the same, or lack triangles, texture coordinates or weights, MIEN_ERROR_DNA_STRUCTURE,
 * MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid,
 * MIEN_ERROR_MEMORY if the allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_project(MienDocument* document, uint32_t mesh,
                                                     uint32_t source, const MienProjectDesc* desc,
                                                     double* out_farthest, MienError* error);

/* The same for all meshes of LOD `lod`, each from the mesh of LOD `source_lod` whose name differs only in the
 * number of the LOD ("head_lod3_mesh" from "head_lod0_mesh"). A LOD that lists no joints or channels gets
 * those of `source_lod`.
 * Fails with MIEN_ERROR_LOD if there is no such LOD, MIEN_ERROR_NAME if a mesh has no counterpart,
 * MIEN_ERROR_INVALID_ARGUMENT if the LODs are the same, or meshes lack triangles, texture coordinates or
 * weights, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE, MIEN_ERROR_DNA_LIMIT or
 * MIEN_ERROR_DNA_VALUE if the document is not valid, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_make_lod(MienDocument* document, uint32_t lod,
                                                      uint32_t source_lod,
                                                      const MienProjectDesc* desc,
                                                      double* out_farthest, MienError* error);

/* How far the rig moved to follow a mesh. */
typedef struct MienConformed {
    size_t struct_size;
    double joint_distance; /* largest distance by which a joint moved, in the unit of the file */
    uint32_t joint;        /* that joint */
    uint32_t reserved;
} MienConformed;
MIEN_DEFAULT(MienConformed, mien_conformed_default)

/* Gives mesh `mesh` new positions, 3 floats per position, such as a head that an artist reshaped, and lets
 * the rig follow: joints move with the surface around them and keep their orientation; targets rotate and
 * scale with the surface, translations that controls add to joints scale with it, and normals rotate.
 * `others` is 0, or 1 to move the other meshes, too. A motion of the whole mesh is followed exactly.
 * Fails with MIEN_ERROR_INDEX if `mesh` is past the end, MIEN_ERROR_INVALID_ARGUMENT if the mesh has another
 * number of positions, or a number is not finite, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE,
 * MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not valid, MIEN_ERROR_MEMORY if the
 * allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_conform(MienDocument* document, uint32_t mesh,
                                                     const float* positions, size_t position_count,
                                                     uint32_t others, MienConformed* out_conformed,
                                                     MienError* error);

/* How mien_document_transplant() works. */
typedef struct MienTransplantDesc {
    size_t struct_size;
    uint32_t match;      /* MIEN_MATCH_..., for meshes of the same name; positions of the same number correspond
                            if the meshes have the same faces */
    uint32_t influences; /* at most, per position. 0: 8 */
} MienTransplantDesc;
MIEN_DEFAULT(MienTransplantDesc, mien_transplant_desc_default)

/* How differently a raw control of both rigs, at 1, moves the positions of LOD 0. */
typedef struct MienControlError {
    double worst;     /* distance of a position, in the unit of the file */
    double rms;
    double moved;     /* largest distance by which the control moved a position before */
    uint32_t control; /* its index in the new rig */
    uint32_t reserved;
} MienControlError;

/* Gives a character the rig of a template: controls, joints, behavior, and LODs of document `rig`. The
 * character keeps its shape. Its meshes keep topology and positions where the template has a mesh of the
 * same name, and get weights and targets from it; other meshes are the template's, moved with the surface.
 * Joints with names of joints of the character keep the places of those, others move with the surface.
 * `out_errors` has `capacity` elements, one for each raw control of both rigs, or fewer; `out_errors` may
 * be NULL; `out_count` gets the number written.
 * Fails with MIEN_ERROR_MISMATCH if the documents differ in axes, units or rotations,
 * MIEN_ERROR_INVALID_ARGUMENT if no mesh of LOD 0 has the name of one of the template, or meshes lack
 * triangles or texture coordinates, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE,
 * MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if one of them is not valid, MIEN_ERROR_MEMORY if the
 * allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_transplant(MienDocument* document,
                                                        const MienDocument* rig,
                                                        const MienTransplantDesc* desc,
                                                        MienControlError* out_errors, size_t capacity,
                                                        size_t* out_count, MienError* error);

/* ---- Documents: results ----------------------------------------------------------------------- */

/* Opens the document as a file, with all checks of opening a file. `document` may be destroyed afterwards.
 * Close with mien_dna_close().
 * Fails with MIEN_ERROR_DNA_TRUNCATED, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE,
 * MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not a valid file; the message names the
 * first invalid field, mien_document_validate() lists them all.
 * See docs/dna-format.md, 13 "What is checked". */
MIEN_AUTHOR_CHECKED MienStatus mien_document_to_dna(const MienDocument* document,
                                                    const MienDocumentDesc* desc, MienDna** out_dna,
                                                    MienError* error);

/* Takes the bytes of a file, in pieces and in order. `write` is called only during the call that takes the
 * struct, and on the same thread. */
typedef struct MienByteSink {
    void* user; /* passed to the function */
    /* Takes `size` bytes and returns the number of bytes taken; any number but `size` ends the call. */
    size_t(MIEN_CALLBACK* write)(void* user, const void* bytes, size_t size);
} MienByteSink;

/* Writes the document to a file, like mien_dna_write_file(), with all checks of opening it as a file.
 * Fails with MIEN_ERROR_FILE_WRITE if the file cannot be written, MIEN_ERROR_DNA_STRUCTURE,
 * MIEN_ERROR_DNA_REFERENCE or MIEN_ERROR_DNA_VALUE if the document is not a valid file, or would not be one in
 * the requested version, MIEN_ERROR_DNA_LIMIT if the file would exceed 4 GiB, MIEN_ERROR_MEMORY if the
 * allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_write_file(const MienDocument* document, const char* path,
                                                        const MienWriteDesc* desc, MienError* error);

/* Passes the bytes of the file to `sink`, in pieces of at most 8 MiB.
 * Fails like mien_document_write_file(), also with MIEN_ERROR_FILE_WRITE if `sink` does not take a piece. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_write_stream(const MienDocument* document,
                                                          const MienByteSink* sink,
                                                          const MienWriteDesc* desc,
                                                          MienError* error);

/* Writes the document to memory and returns its size in `out_size`. `buffer` may be NULL with capacity 0 to get
 * the size only. Writes nothing if `capacity` is too small; `out_size` is set nevertheless.
 * Fails like mien_document_write_file(), but not with MIEN_ERROR_FILE_WRITE, and with
 * MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_write_memory(const MienDocument* document,
                                                          const MienWriteDesc* desc, void* buffer,
                                                          size_t capacity, size_t* out_size,
                                                          MienError* error);

/* Checks the document like mien_dna_validate_memory() its file. `document` may be destroyed afterwards.
 * Destroy with mien_report_destroy().
 * Fails with MIEN_ERROR_DNA_LIMIT if the file would exceed 4 GiB. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_validate(const MienDocument* document,
                                                      const MienValidateDesc* desc,
                                                      MienReport** out_report, MienError* error);

#ifdef __cplusplus
}
#endif

#endif
