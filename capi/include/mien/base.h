/* SPDX-License-Identifier: MIT
 *
 * What every other header needs: version, status, errors, memory, views.
 * The rules of mien.h apply.
 */
#ifndef MIEN_BASE_H
#define MIEN_BASE_H

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

/* Calling convention of callbacks. They must return to the library, without throwing or longjmp(). */
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
    MIEN_ERROR_UNSUPPORTED = 11,     /* this build of the library only opens baked files, or the object is
                                        stored in a form that does not have what was asked for */
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
    /* Copies `size` bytes at `offset` to `buffer`, never more, and returns the number of bytes copied;
     * any number but `size` is an error. The range is within the file. */
    size_t(MIEN_CALLBACK* read)(void* user, uint64_t offset, void* buffer, size_t size);
} MienStream;

#ifdef __cplusplus
}
#endif

#endif /* MIEN_BASE_H */
