// SPDX-License-Identifier: MIT
// A worker that does tasks of a module with shared memory; threads.js starts it.
import { importsOf } from "./system.js";

globalThis.onmessage = async ({ data: { module, memory, stack } }) => {
  try {
    const { exports } = await WebAssembly.instantiate(module, importsOf(module, () => memory));
    exports.stackRestore(stack);
    globalThis.postMessage({ isReady: true });
    exports.mien_web_work(stack);
  } catch (error) {
    globalThis.postMessage({ error: String(error) });
  }
};
