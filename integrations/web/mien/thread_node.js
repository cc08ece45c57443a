// SPDX-License-Identifier: MIT
// thread.js in Node.js, whose workers talk in another way.
import { parentPort } from "node:worker_threads";

globalThis.postMessage = (message) => parentPort.postMessage(message);
await import("./thread.js");
parentPort.on("message", (data) => globalThis.onmessage({ data }));
