// SPDX-License-Identifier: MIT
// What the tests of the package share: where things are, golden rigs, results of the program.
import { execFileSync } from "node:child_process";
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

export const project = fileURLToPath(new URL("../../..", import.meta.url));
/** The package with its modules, as `./dev web` makes it. */
export const packageFolder = process.env.MIEN_WEB ?? join(project, "build/web/mien");
/** The native program, which tells what results must be. */
export const program = process.env.MIEN_BIN ?? join(project, "build/release/bin/mien");

export const { Mien, ...api } = await import(join(packageFolder, "index.js"));

/** Paths of the golden rigs by name. */
export function goldenRigs() {
  const folder = join(project, "tests/golden");
  const found = new Map(readdirSync(folder).filter((name) => name.endsWith(".dna")).sort()
    .map((name) => [name.slice(0, -4), join(folder, name)]));
  const head = join(process.env.MIEN_SHARED || join(project, "../shared"), "golden/head.dna");
  if (existsSync(head)) found.set("head", head);
  else console.log(`NOT TESTED: the golden rig of production size in WebAssembly; there is no ${head}`);
  return found;
}

/** The records of a golden.bin file; tests/golden/README.md describes it. */
export function readGolden(path) {
  const bytes = readFileSync(path);
  const types = [Float32Array, Uint16Array, Uint32Array, Uint8Array];
  let at = 8;
  const number = (size) => bytes.readUIntLE((at += size) - size, size);
  const records = new Map();
  for (let count = number(4); count > 0; --count) {
    const length = number(2);
    const name = bytes.toString("latin1", at, (at += length));
    const type = types[number(1)];
    const dims = Array.from({ length: number(1) }, () => 0).map(() => number(4));
    const size = dims.reduce((product, dim) => product * dim, 1) * type.BYTES_PER_ELEMENT;
    records.set(name, { dims, values: new type(bytes.buffer.slice(bytes.byteOffset + at, bytes.byteOffset + at + size)) });
    at += size;
  }
  return records;
}

/** Runs the native program. */
export function mien(args, input) {
  return execFileSync(program, args, { input, maxBuffer: 2 ** 30, stdio: ["pipe", "pipe", "inherit"] });
}

/** True if two arrays have the same bits. */
export function sameBits(a, b) {
  if (a.length !== b.length) return false;
  const [x, y] = [a, b].map((array) => new Uint32Array(Float32Array.from(array).buffer));
  return x.every((bits, i) => bits === y[i]);
}
