/* SPDX-License-Identifier: MIT
 *
 * Baked files: a packed rig and its deformer, used in place.
 * The rules of mien.h apply.
 */
#ifndef MIEN_BAKED_H
#define MIEN_BAKED_H

#include "deform.h"

#ifdef __cplusplus
extern "C" {
#endif

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

/* Creates the rig of a baked file, with one allocation, or two with MIEN_REUSE_SUMS. `baked` may be closed afterwards. Destroy with
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

#ifdef __cplusplus
}
#endif

#endif /* MIEN_BAKED_H */
