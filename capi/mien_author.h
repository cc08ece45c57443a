/* SPDX-License-Identifier: MIT
 *
 * libmien-author: creates DNA files. A separate library that uses libmien, because programs that
 * evaluate and deform rigs do not need it. The rules of mien.h apply.
 */
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

/* Generated rigs. */
enum MienPreset {
    MIEN_PRESET_TINY = 0,   /* small enough to read */
    MIEN_PRESET_SMALL = 1,
    MIEN_PRESET_MEDIUM = 2,
    MIEN_PRESET_LARGE = 3,  /* a production head: 870 joints, 260 raw controls, 8 LODs, a million
                               matrix entries */
    MIEN_PRESET_BODY = 4,   /* a production body: 342 joints, moved by 72 RBF solvers with 670 poses,
                               22 twists and 16 swings; some are quaternion joints */
    MIEN_PRESET_HEAD = 5    /* a stylized head to look at: skin, eyes, teeth, tongue, hair; the 52
                               expressions of ARKit as raw controls with their names (0 to 1),
                               correctives, wrinkle maps, 8 LODs. Seed 0 is the designed head, other
                               seeds vary proportions and colors. Vertex colors are in the metadata:
                               key "mien.colors.<mesh name>", value base64 of 3 bytes (sRGB) per
                               vertex position of the mesh. */
};

/* Additions to a preset, combined with |. */
enum MienGenerate {
    MIEN_GENERATE_ML = 1 /* machine-learned behavior: networks for mesh regions with all activation
                            functions and operations, and ML joints; not with MIEN_PRESET_HEAD */
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

/* Generates a rig and opens it: a file of version 2.8 with all layers, behavior of realistic size and
 * sparsity, and simple geometry. Close with mien_dna_close(). */
MIEN_AUTHOR_CHECKED MienStatus mien_dna_generate(const MienGenerateDesc* desc, MienDna** out_dna,
                                                 MienError* error);

#ifdef __cplusplus
}
#endif

#endif
