/* SPDX-License-Identifier: MIT
 * What the WebAssembly module has besides the libraries: streams that JavaScript reads, solvers that it
 * runs, progress that it is told, and whether it cancels. Function pointers are not for JavaScript to write. */
#include "capi/include/mien.h"

/* Copies `size` bytes at `offset` of file `user` to `buffer`; see mien/memory.js. */
size_t mien_web_read(void* user, uint64_t offset, void* buffer, size_t size);

/* Fills a stream. */
void mien_web_stream(MienStream* out_stream, void* user, uint64_t size);

void mien_web_stream(MienStream* out_stream, void* user, uint64_t size) {
  out_stream->user = user;
  out_stream->size = size;
  out_stream->read = mien_web_read;
}

/* Runs the custom solver `user`; see mien/memory.js. */
void mien_web_solve(void* user, const MienSolverCall* call);

/* The function of every MienUserSolver. */
uintptr_t mien_web_solver(void);

uintptr_t mien_web_solver(void) { return (uintptr_t)mien_web_solve; }

/* Tells the function `user` of a progress; see mien/memory.js. */
int32_t mien_web_progress(void* user, const char* step, double share);

/* For MienAuthorDesc.progress. */
uintptr_t mien_web_progress_function(void);

uintptr_t mien_web_progress_function(void) { return (uintptr_t)mien_web_progress; }

/* Asks the function `user` whether to stop; see mien/memory.js. */
uint32_t mien_web_canceled(void* user);

/* For MienFitFrame.canceled. */
uintptr_t mien_web_canceled_function(void);

uintptr_t mien_web_canceled_function(void) { return (uintptr_t)mien_web_canceled; }
