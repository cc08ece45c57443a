// SPDX-License-Identifier: MIT
// read.mjs FOLDER FILE.usda: what TinyUSDZ, from FOLDER/node_modules, makes of a file, as JSON.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

// It is built for browsers, and looks whether this is one.
process.type = "renderer";
globalThis.window ??= globalThis;

const [folder, file] = process.argv.slice(2);
const { default: init } = await import(pathToFileURL(join(folder, "node_modules/tinyusdz/tinyusdz.js")).href);
const native = await init({
  instantiateWasm(imports, done) {
    const bytes = readFileSync(join(folder, "node_modules/tinyusdz/tinyusdz.wasm"));
    WebAssembly.instantiate(bytes, imports).then(({ instance, module }) => done(instance, module));
    return {};
  },
  print: () => {},
});
const scene = new native.TinyUSDZLoaderNative();
if (!scene.loadFromBinary(new Uint8Array(readFileSync(file)), "scene.usda")) {
  process.stderr.write(`${scene.error()}\n`);
  process.exit(1);
}
const meshes = Array.from({ length: scene.numMeshes() }, (_, i) => scene.getMesh(i))
  .map(({ points, faceVertexIndices }) => ({ points: points.length / 3, corners: faceVertexIndices.length }));
process.stdout.write(`${JSON.stringify({ meshes })}\n`);
