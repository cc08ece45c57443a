// SPDX-License-Identifier: MIT
// Mien in JavaScript: facial rigs in browsers, workers and Node.js. index.d.ts is the manual.
import { Layer, Status } from "./api.js";
import { authorRig } from "./author.js";
import { arkitMatrix, Clip } from "./clip.js";
import { coordinateSystemNames, Dna, validate } from "./dna.js";
import { Document } from "./document.js";
import { errorOf } from "./errors.js";
import { FitSurface, reduceKeys } from "./fit.js";
import { Memory } from "./memory.js";
import { glare, Mix } from "./mix.js";
import { controlName, isBaked, Rig } from "./rig.js";
import { canShare, machineThreads } from "./threads.js";

export * from "./api.js";
export {
  ArgumentError, AuthorError, BakedError, ClipError, DnaError, FileError, MienError, MienMemoryError, MixError,
  UnsupportedError,
} from "./errors.js";
export { Clip, ClipBinding, ClipPlayer } from "./clip.js";
export { Deformer, DeformerInstance } from "./deformer.js";
export { Dna } from "./dna.js";
export { Document } from "./document.js";
export { Fit, FitSurface } from "./fit.js";
export { Gaze, Mix, Mixer } from "./mix.js";
export { MixLayer, ticks } from "./mix_parts.js";
export { Batch, Instance, Rig } from "./rig.js";
export { SolverStack, SolverState } from "./solve.js";

const MOST_THREADS = 64;
const isNode = typeof process === "object" && !!process.versions?.node && process.type !== "renderer";

/** Bytes of a source: an address, a file of a browser, a response, or bytes as they are. */
async function bytesOf(source) {
  if (source instanceof ArrayBuffer) return new Uint8Array(source);
  if (ArrayBuffer.isView(source)) return new Uint8Array(source.buffer, source.byteOffset, source.byteLength);
  if (typeof Blob === "function" && source instanceof Blob) return new Uint8Array(await source.arrayBuffer());
  const response = typeof Response === "function" && source instanceof Response ? source : await fetched(source);
  if (response instanceof Uint8Array) return response;
  if (!response.ok) throw new Error(`${response.url || source}: ${response.status} ${response.statusText}`);
  return new Uint8Array(await response.arrayBuffer());
}

async function fetched(source) {
  if (typeof source !== "string" && !(source instanceof URL)) {
    throw new TypeError("expected bytes, a Blob, a Response or an address");
  }
  const isFile = source instanceof URL ? source.protocol === "file:" : !/^[a-z][a-z0-9+.-]+:/i.test(source) || source.startsWith("file:");
  if (isNode && isFile) {
    const { readFile } = await import(/* @vite-ignore */ "node:fs/promises");
    const path = typeof source === "string" && source.startsWith("file:") ? new URL(source) : source;
    return new Uint8Array(await readFile(path));
  }
  return fetch(source);
}

async function compiled(source) {
  if (source instanceof WebAssembly.Module) return source;
  if (!isNode && (typeof source === "string" || source instanceof URL)) {
    const response = await fetch(source);
    if (!response.ok) throw new Error(`${response.url}: ${response.status} ${response.statusText}`);
    // Servers that do not know the type of .wasm files get a second way.
    if (response.headers.get("content-type")?.startsWith("application/wasm")) {
      return WebAssembly.compileStreaming(response);
    }
    return WebAssembly.compile(await response.arrayBuffer());
  }
  return WebAssembly.compile(await bytesOf(source));
}

export class Mien {
  #memory;

  /** Loads the WebAssembly module: the one of the package, or `wasm`. */
  static async load({ wasm, bakedOnly = false, threads = 1 } = {}) {
    const wanted = threads === true ? Math.min(await machineThreads(), MOST_THREADS) : threads;
    if (!Number.isInteger(wanted) || wanted < 1 || wanted > MOST_THREADS) {
      throw new RangeError(`threads: true or 1 to ${MOST_THREADS}, not ${threads}`);
    }
    let source = wasm;
    // Bundlers find the files by these expressions.
    if (source === undefined && bakedOnly) source = new URL("./mien-runtime.wasm", import.meta.url);
    else if (source === undefined && wanted > 1 && canShare()) source = new URL("./mien-threads.wasm", import.meta.url);
    else source ??= new URL("./mien.wasm", import.meta.url);
    const module = await compiled(source);
    const memory = await Memory.instantiate(module);
    if (memory.isShared && wanted > 1) await memory.startThreads(module, wanted);
    return new Mien(memory);
  }

  constructor(memory) {
    this.#memory = memory;
  }

  /** Threads that work, with the one that calls. */
  get threads() {
    return this.#memory.threads;
  }

  /** The functions of the C interface, and the memory. */
  get exports() {
    return this.#memory.exports;
  }

  /** "0.1.0" */
  get version() {
    const version = this.exports.mien_version();
    return `${version >>> 24}.${(version >>> 16) & 255}.${version & 0xffff}`;
  }

  isaAvailable(isa) {
    return this.exports.mien_isa_available(isa) !== 0;
  }

  isaName(isa) {
    return this.#memory.terminatedText(this.exports.mien_isa_name(isa));
  }

  /** Bytes of memory that the module has; it grows and never shrinks. */
  get memoryBytes() {
    return this.#memory.buffer.byteLength;
  }

  get coordinateSystems() {
    return coordinateSystemNames(this.#memory);
  }

  /** A rig, with its deformer, of a DNA file or a baked file. */
  async openRig(source, options = {}) {
    const bytes = await bytesOf(source);
    if (isBaked(bytes)) return Rig.fromBaked(this.#memory, bytes, options);
    const { lods, system, layers, skipBlendShapeTargets, ...rest } = options;
    const dna = Dna.open(this.#memory, bytes, { lods, system, layers, skipBlendShapeTargets });
    try {
      return this.createRig(dna, rest);
    } finally {
      dna.dispose();
    }
  }

  async openDna(source, options = {}) {
    return Dna.open(this.#memory, await bytesOf(source), options);
  }

  async openClip(source) {
    return Clip.open(this.#memory, await bytesOf(source));
  }

  buildClip(desc) {
    return Clip.build(this.#memory, desc);
  }

  /** A mix that Mix.write() wrote, for a rig; without one to look into it. */
  async openMix(source, rig = null, options = {}) {
    return Mix.open(this.#memory, await bytesOf(source), rig, options);
  }

  /** For rigs that name raw controls in the other usual way than ARKit does. */
  arkitMatrix() {
    return arkitMatrix(this.#memory);
  }

  controlName(name) {
    return controlName(this.#memory, name);
  }

  glare(poses) {
    return glare(this.#memory, poses);
  }

  /** Findings about the bytes of a DNA file. */
  async validate(source) {
    return validate(this.#memory, await bytesOf(source));
  }

  /** A generated rig: Preset.HEAD is a head to look at. */
  generate(preset, options = {}) {
    if (!this.exports.mien_dna_generate) {
      throw errorOf(Status.UNSUPPORTED, "this module opens baked files only: load the other one to generate rigs");
    }
    return Dna.generate(this.#memory, { preset, ...options });
  }

  /** A rig for the mesh of a head: { dna, report }. */
  authorRig(mesh, options = {}) {
    if (!this.exports.mien_author_rig) {
      throw errorOf(Status.UNSUPPORTED, "this module opens baked files only: load the other one to make rigs");
    }
    return authorRig(this.#memory, mesh, options);
  }

  /** A document of an open DNA file, which may be disposed afterwards; of null, an empty one. */
  createDocument(dna = null) {
    if (!this.exports.mien_document_create) {
      throw errorOf(Status.UNSUPPORTED, "this module opens baked files only: load the other one to change files");
    }
    return Document.create(this.#memory, dna);
  }

  /** A surface without correspondences, for Fit.solve(). */
  createFitSurface(positions, triangles) {
    this.#needSolver();
    return FitSurface.create(this.#memory, positions, triangles);
  }

  /** Frame numbers of the keys of a curve, within a tolerance. */
  reduceKeys(values, tolerance) {
    this.#needSolver();
    return reduceKeys(this.#memory, values, tolerance);
  }

  #needSolver() {
    if (!this.exports.mien_fit_create) {
      throw errorOf(Status.UNSUPPORTED, "this module opens baked files only: load the other one to solve");
    }
  }

  /** The rig of an open DNA file, which may be disposed afterwards. */
  createRig(dna, { deformer = true, ...desc } = {}) {
    const rig = Rig.create(this.#memory, dna, desc);
    try {
      rig.metadata = dna.metadata;
      if (deformer && (dna.info.layers & Layer.GEOMETRY) && dna.info.meshCount) {
        rig.deformer = rig.createDeformer(dna, deformer === true ? {} : deformer);
      }
    } catch (error) {
      rig.dispose();
      throw error;
    }
    return rig;
  }
}
