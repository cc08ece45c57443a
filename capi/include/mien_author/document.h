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

/* A DNA file that can be changed: its fields by the paths of mien_dna_field(), and as a whole by
 * operations that keep together what refers to each other. Every change happens completely or, if
 * the call fails, not at all. What is not changed stays as it is, byte for byte. Memory is taken for what
 * is changed only, beyond a copy of the file that was opened. */
typedef struct MienDocument MienDocument;

typedef struct MienDocumentDesc {
    size_t struct_size;
    const MienAllocator* allocator;
} MienDocumentDesc;
MIEN_DEFAULT(MienDocumentDesc, mien_document_desc_default)

/* Makes a document of an open file, as it was loaded: layers and LODs that were left out are not in it.
 * `dna` may be NULL, for an empty document of version 2.8 with all layers. `dna` may be closed
 * afterwards. Destroy with mien_document_destroy().
 * Fails with MIEN_ERROR_DNA_LAYER if `dna` has RBF behavior without the machine-learned behavior of its
 * file, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE or MIEN_ERROR_DNA_VALUE if what was loaded
 * would not open by itself, MIEN_ERROR_DNA_LIMIT if it has more than 4 GiB. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_create(const MienDna* dna, const MienDocumentDesc* desc,
                                                    MienDocument** out_document, MienError* error);

/* Destroys a document. */
MIEN_AUTHOR_API void mien_document_destroy(MienDocument* document);

/* ---- Documents: fields ------------------------------------------------------------------------ */

/* Finds a field by its path, as mien_dna_field(). byte_offset is MIEN_NO_OFFSET.
 * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if an index in the path is past
 * the end.
 * See docs/dna-format.md, 6 "Layers, field by field". */
MIEN_AUTHOR_CHECKED MienStatus mien_document_field(const MienDocument* document, const char* path,
                                                   MienDnaField* out_field, MienError* error);

/* Returns the name of field `index` of the record at a path, as mien_dna_child_name(). The string is static.
 * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if `index` or an index in the
 * path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is not a record. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_child_name(const MienDocument* document,
                                                        const char* path, uint32_t index,
                                                        MienStringView* out_name, MienError* error);

/* Copies `count` elements of a field, beginning with element `first`, to `out`, as
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

/* Returns the bytes of an array of numbers or of a string where they are: big-endian and unaligned, as in
 * a file. Contents change with mien_document_write_floats(), mien_document_write_integers(),
 * mien_document_undo(): the view is valid until the document is changed.
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
 * `inserted_count` new ones: zeros, empty strings, or records of these. What refers to elements by
 * their number stays as it is. Copies the array, or the list without its contents.
 * Fails with MIEN_ERROR_NAME if there is no such field, MIEN_ERROR_INDEX if the range or an index in
 * the path is past the end, MIEN_ERROR_INVALID_ARGUMENT if the field is neither an array nor a list, or
 * would have more than 2^32 - 1 elements, MIEN_ERROR_MEMORY if the allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_splice(MienDocument* document, const char* path,
                                                    uint64_t first, uint64_t removed_count,
                                                    uint64_t inserted_count, MienError* error);

/* Gives an array or list `count` elements: drops the last ones or adds new ones, as
 * mien_document_splice().
 * Fails like mien_document_splice(). */
MIEN_AUTHOR_CHECKED MienStatus mien_document_resize(MienDocument* document, const char* path,
                                                    uint64_t count, MienError* error);

/* ---- Documents: undoing ----------------------------------------------------------------------- */

/* Remembers the current state, at the cost of some KB. Mark 0 always exists: the state in which the
 * document was created. Memory of changes before a mark is kept until the document is destroyed or an
 * earlier mark restored.
 * Fails with MIEN_ERROR_MEMORY if the allocator returns NULL. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_mark(MienDocument* document, uint64_t* out_mark,
                                                  MienError* error);

/* Goes back to the state at a mark: `mark` is a number of mien_document_mark(), or 0. Later marks are
 * gone, this one stays. Does not allocate or lock.
 * Fails with MIEN_ERROR_INDEX if `mark` is not a mark of the document, or gone. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_undo(MienDocument* document, uint64_t mark,
                                                  MienError* error);

/* ---- Documents: results ----------------------------------------------------------------------- */

/* Checks all that opening a file checks, and opens the document as a file. `document` may be destroyed
 * afterwards. Close with mien_dna_close().
 * Fails with MIEN_ERROR_DNA_TRUNCATED, MIEN_ERROR_DNA_STRUCTURE, MIEN_ERROR_DNA_REFERENCE,
 * MIEN_ERROR_DNA_LIMIT or MIEN_ERROR_DNA_VALUE if the document is not a valid file, of which the message
 * names the first field; mien_document_validate() lists them all.
 * See docs/dna-format.md, 13 "What is checked". */
MIEN_AUTHOR_CHECKED MienStatus mien_document_to_dna(const MienDocument* document,
                                                    const MienDocumentDesc* desc, MienDna** out_dna,
                                                    MienError* error);

/* Checks the document as mien_dna_validate_memory() would check its file. `document` may be destroyed
 * afterwards. Destroy with mien_report_destroy().
 * Fails with MIEN_ERROR_DNA_LIMIT if the file would have more than 4 GiB. */
MIEN_AUTHOR_CHECKED MienStatus mien_document_validate(const MienDocument* document,
                                                      const MienValidateDesc* desc,
                                                      MienReport** out_report, MienError* error);

#ifdef __cplusplus
}
#endif

#endif
