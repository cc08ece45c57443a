// SPDX-License-Identifier: MIT
// What the C library in the module asks of a system. There is next to none: no files, no environment.

const PAGE = 65536;
const MOST = 2 ** 31;

/** Memory for a module that shares it with workers, of the size that the module is linked for; null: another module. */
export function sharedMemory(module) {
  const isShared = WebAssembly.Module.imports(module).some(({ kind }) => kind === "memory");
  return isShared ? new WebAssembly.Memory({ initial: 2 ** 22 / PAGE, maximum: MOST / PAGE, shared: true }) : null;
}

/** The imports of a module: `own` functions, and those of the system over the memory that `memory()` returns. */
export function importsOf(module, memory, own = {}) {
  // What the module with threads calls: seconds and nanoseconds.
  const clockGettime = (_clock, out) => {
    const milliseconds = performance.now();
    const data = new DataView(memory().buffer);
    data.setInt32(out >>> 0, Math.floor(milliseconds / 1000), true);
    data.setInt32((out >>> 0) + 4, Math.floor((milliseconds % 1000) * 1e6), true);
    return 0;
  };
  const known = {
    ...own,
    clock_gettime: clockGettime,
    __clock_gettime: clockGettime,
    emscripten_notify_memory_growth() {},
    __emscripten_init_main_thread_js() {},
    emscripten_memcpy_big(to, from, size) {
      new Uint8Array(memory().buffer).copyWithin(to >>> 0, from >>> 0, (from >>> 0) + (size >>> 0));
    },
    // Shared memory grows in steps of a quarter, as the module itself lets its own one grow.
    emscripten_resize_heap(size) {
      const [old, wanted] = [memory().buffer.byteLength, size >>> 0];
      for (const bytes of [Math.max(wanted, Math.min(1.25 * old, MOST)), wanted]) {
        try {
          memory().grow(Math.ceil((bytes - old) / PAGE));
          return 1;
        } catch {
          // the smaller step, or none
        }
      }
      return 0;
    },
    environ_sizes_get(count, size) {
      const data = new DataView(memory().buffer);
      data.setUint32(count, 0, true);
      data.setUint32(size, 0, true);
      return 0;
    },
    environ_get: () => 0,
    // Limits of time in Fit.solve(): nanoseconds, whichever clock is asked for.
    clock_time_get(_clock, _precision, out) {
      new DataView(memory().buffer).setBigUint64(out >>> 0, BigInt(Math.round(performance.now() * 1e6)), true);
      return 0;
    },
  };
  const imports = {};
  for (const { module: from, name, kind } of WebAssembly.Module.imports(module)) {
    imports[from] ??= {};
    imports[from][name] = kind === "memory" ? memory() : known[name] ?? (() => {
      throw new WebAssembly.RuntimeError(`the module called ${name}, which there is not`);
    });
  }
  return imports;
}
