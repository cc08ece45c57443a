/* SPDX-License-Identifier: MIT
 * Threads of the WebAssembly module: workers of the page that share its memory run mien_web_work(). The
 * thread that calls the library hands out one list of tasks at a time and works on it too, so no task
 * waits for a worker that starts late. */
#include <stdatomic.h>

#include "capi/include/mien.h"

#define CLOSED 0x80000000u

static struct {
  _Atomic uint32_t list;   /* counts the lists; workers sleep on it */
  _Atomic uint32_t joined; /* workers on the list; with CLOSED no more may join */
  _Atomic uint32_t next;   /* task */
  uint32_t count;
  MienTask task;
  void* context;
} tasks = {.joined = CLOSED};

static void take_tasks(void) {
  for (uint32_t i; (i = atomic_fetch_add(&tasks.next, 1)) < tasks.count;)
    tasks.task(tasks.context, i);
}

static void run(void* user, uint32_t count, MienTask task, void* context) {
  (void)user;
  tasks.count = count;
  tasks.task = task;
  tasks.context = context;
  atomic_store(&tasks.next, 0);
  atomic_store(&tasks.joined, 0);
  atomic_fetch_add(&tasks.list, 1);
  __builtin_wasm_memory_atomic_notify((int*)&tasks.list, UINT32_MAX);
  take_tasks();
  /* The main thread of a page must not sleep, and those who joined are at their last tasks. */
  atomic_fetch_or(&tasks.joined, CLOSED);
  while (atomic_load(&tasks.joined) != CLOSED) {
  }
}

/* Made by the linker. */
void __wasm_init_tls(void* memory);

/* A worker, with memory for its thread-local variables: does not return. */
void mien_web_work(void* memory);

void mien_web_work(void* memory) {
  __wasm_init_tls(memory);
  for (uint32_t seen = 0;;) {
    const uint32_t list = atomic_load(&tasks.list);
    if (list == seen) {
      __builtin_wasm_memory_atomic_wait32((int*)&tasks.list, (int)seen, -1);
      continue;
    }
    seen = list;
    uint32_t joined = atomic_load(&tasks.joined);
    while (!(joined & CLOSED) &&
           !atomic_compare_exchange_weak(&tasks.joined, &joined, joined + 1)) {
    }
    if (joined & CLOSED) continue;
    take_tasks();
    atomic_fetch_sub(&tasks.joined, 1);
  }
}

/* Bytes that mien_web_work() takes. */
uintptr_t mien_web_work_bytes(void);

uintptr_t mien_web_work_bytes(void) { return __builtin_wasm_tls_size(); }

/* The MienParallelFor that hands tasks to the workers. */
uintptr_t mien_web_threads(void);

uintptr_t mien_web_threads(void) {
  static const MienParallelFor threads = {NULL, run};
  return (uintptr_t)&threads;
}
