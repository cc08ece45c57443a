// SPDX-License-Identifier: MIT
// Workers that share the memory of a module and do tasks for the thread that calls it.
const isNode = typeof process === "object" && !!process.versions?.node && process.type !== "renderer";
// As much as the module has for the thread that calls it.
const STACK = 2 ** 20;

/** Whether there is shared memory: not in pages without the headers COOP and COEP. */
export function canShare() {
  return typeof SharedArrayBuffer === "function" && (isNode || globalThis.crossOriginIsolated === true);
}

/** Threads of the machine. */
export async function machineThreads() {
  return globalThis.navigator?.hardwareConcurrency ?? (isNode ? (await import(/* @vite-ignore */ "node:os")).cpus().length : 1);
}

async function started(memory, module) {
  const block = memory.exports.malloc(STACK + memory.exports.mien_web_work_bytes() + 64);
  if (!block) memory.check(10);
  // The stack grows down to the block; behind it are the variables of the thread.
  const stack = (block + STACK + 63) & ~63;
  let worker;
  if (isNode) {
    const { Worker: NodeWorker } = await import(/* @vite-ignore */ "node:worker_threads");
    const file = "./thread_node.js"; // not for bundlers
    worker = new NodeWorker(new URL(file, import.meta.url), { execArgv: [] });
    worker.addEventListener = (type, listen) => worker.on(type, (data) => listen({ data, message: data?.message }));
  } else {
    worker = new Worker(new URL("./thread.js", import.meta.url), { type: "module" });
  }
  await new Promise((resolve, reject) => {
    const failed = (why) => {
      worker.terminate();
      reject(new Error(`a thread cannot start: ${why}`));
    };
    worker.addEventListener("message", ({ data }) => (data.isReady ? resolve() : failed(data.error)));
    worker.addEventListener("error", ({ message }) => failed(message || "the worker does not load"));
    worker.postMessage({ module, memory: memory.exports.memory, stack });
  });
  worker.unref?.(); // threads keep no program alive
}

/** Starts workers. They live as long as the page or program. */
export async function startThreads(memory, module, count) {
  await Promise.all(Array.from({ length: count }, () => started(memory, module)));
}
