// SPDX-License-Identifier: MIT
// The WebAssembly module and its memory: calls, structs, text and arrays. When memory grows, its buffer
// is a new one and typed arrays over the old one are empty, so they are made anew where they are used.
import { calls, layouts, Status } from "./api.js";
import { checked, checkLong, checkNumber, checkNumbers, checkSize } from "./checks.js";
import { errorOf } from "./errors.js";
import { importsOf, sharedMemory } from "./system.js";
import { startThreads } from "./threads.js";

const encoder = new TextEncoder();
const decoder = new TextDecoder();
const NO_OFFSET = 2n ** 64n - 1n;
// Temporary memory comes from the stack of the module, which has 1 MiB; larger blocks, and what a call takes
// beyond a share, from its heap.
const STACK_BLOCK = 4096;
const STACK_SHARE = 65536;

const SIZES = { i8: 1, u8: 1, bool: 4, i16: 2, u16: 2, i32: 4, u32: 4, f32: 4, i64: 8, u64: 8, offset: 8, f64: 8 };
const ARRAYS = {
  i8: Int8Array, u8: Uint8Array, i16: Int16Array, u16: Uint16Array, i32: Int32Array, u32: Uint32Array,
  f32: Float32Array, f64: Float64Array,
};

function getNumber(data, kind, at) {
  switch (kind) {
    case "i8": return data.getInt8(at);
    case "u8": return data.getUint8(at);
    case "bool": return data.getUint32(at, true) !== 0;
    case "i16": return data.getInt16(at, true);
    case "u16": return data.getUint16(at, true);
    case "i32": return data.getInt32(at, true);
    case "u32": return data.getUint32(at, true);
    case "f32": return data.getFloat32(at, true);
    case "f64": return data.getFloat64(at, true);
    case "i64": return Number(data.getBigInt64(at, true));
    case "u64": return Number(data.getBigUint64(at, true));
    default: { // offset
      const value = data.getBigUint64(at, true);
      return value === NO_OFFSET ? null : Number(value);
    }
  }
}

function setNumber(data, kind, at, value, what) {
  if (kind === "bool") return data.setUint32(at, value ? 1 : 0, true);
  if (SIZES[kind] === 8 && kind !== "f64") return data.setBigInt64(at, checkLong(value, kind, what), true);
  checkNumber(value, kind, what);
  switch (kind) {
    case "i8": case "u8": return data.setUint8(at, value);
    case "i16": case "u16": return data.setUint16(at, value, true);
    case "i32": case "u32": return data.setUint32(at, value, true);
    case "f32": return data.setFloat32(at, value, true);
    default: return data.setFloat64(at, value, true);
  }
}

/** What a function of the caller returned, which has to be done by then. */
function notLater(result) {
  if (typeof result?.then === "function") throw new TypeError("functions that the module calls must not be async");
  return result;
}

export class Memory {
  /** Files that streams of the module read. */
  #files = new Map();
  #lastFile = 0;
  /** Functions of the caller that the module calls by number, and what they threw in the calls under way. */
  #functions = new Map();
  #lastFunction = 0;
  #thrown = [];
  #bytes = new Uint8Array(0);
  #data;
  #isShared = false;
  /** Address of the MienParallelFor for calls; 0: there are no workers. */
  parallel = 0;
  /** Threads that do tasks, with the one that calls. */
  threads = 1;

  /** Instantiates a compiled module. */
  static async instantiate(module) {
    const memory = new Memory();
    const shared = sharedMemory(module);
    const imports = importsOf(module, () => shared ?? memory.exports.memory, {
      mien_web_read: (file, offset, buffer, size) => memory.#read(file, Number(offset), buffer, size),
      mien_web_solve: (solver, call) => memory.#solve(solver, call),
      mien_web_progress: (progress, step, share) => memory.#progress(progress, step, share),
      mien_web_canceled: (canceled) => memory.#canceled(canceled),
    });
    const { exports } = await WebAssembly.instantiate(module, imports);
    memory.exports = { ...exports, memory: shared ?? exports.memory };
    for (const [name, letters] of Object.entries(calls)) {
      if (exports[name]) memory.exports[name] = checked(name, exports[name], letters);
    }
    memory.#isShared = shared !== null;
    (exports._initialize ?? exports.__wasm_call_ctors)?.();
    return memory;
  }

  get isShared() {
    return this.#isShared;
  }

  /** Lets workers do tasks of calls. */
  async startThreads(module, threads) {
    await startThreads(this, module, threads - 1);
    this.parallel = this.exports.mien_web_threads();
    this.threads = threads;
  }

  get buffer() {
    return this.exports.memory.buffer;
  }

  get data() {
    // Growth empties the bytes of the old buffer, unless it is shared: that one only ends too early. Asking the
    // module for its buffer takes longer.
    if (!this.#bytes.length || (this.#isShared && this.#bytes.buffer !== this.buffer)) {
      this.#bytes = new Uint8Array(this.buffer);
      this.#data = new DataView(this.buffer);
    }
    return this.#data;
  }

  /** A typed array over the module's memory, until it grows. */
  array(kind, address, count) {
    return new ARRAYS[kind](this.buffer, count ? address : 0, count);
  }

  /** Copies text out of memory. */
  text(address, count) {
    return this.#decoded(new Uint8Array(this.buffer, address, count));
  }

  terminatedText(address, most = 2 ** 20) {
    const bytes = new Uint8Array(this.buffer, address, Math.min(most, this.buffer.byteLength - address));
    const end = bytes.indexOf(0);
    return this.#decoded(end < 0 ? bytes : bytes.subarray(0, end));
  }

  // Decoders take no shared memory.
  #decoded(bytes) {
    return decoder.decode(this.#isShared ? bytes.slice() : bytes);
  }

  #read(file, offset, buffer, size) {
    const bytes = this.#files.get(file).subarray(offset, offset + size);
    new Uint8Array(this.buffer).set(bytes, buffer);
    return bytes.length;
  }

  /** Calls open(stream) with a stream of bytes: they are not copied, but read where they are. */
  withStream(bytes, scratch, open) {
    const file = ++this.#lastFile;
    this.#files.set(file, bytes);
    try {
      const stream = scratch.take(24);
      this.exports.mien_web_stream(stream, file, BigInt(bytes.length));
      return open(stream);
    } finally {
      this.#files.delete(file);
    }
  }

  /** Takes a function that the module will call. Returns its number, for addresses named `user`. */
  addFunction(call) {
    this.#functions.set(++this.#lastFunction, call);
    return this.#lastFunction;
  }

  removeFunction(number) {
    this.#functions.delete(number);
  }

  // What a function throws must not cross the module, whose stack it would leave as it is.
  #guarded(call, otherwise) {
    const thrown = this.#thrown.at(-1);
    if (thrown.length) return otherwise;
    try {
      return call();
    } catch (error) {
      thrown.push(error);
      return otherwise;
    }
  }

  #solve(solver, address) {
    this.#guarded(() => {
      const call = this.read("SolverCall", address);
      const { size } = layouts.SolverPose;
      const poses = Array.from({ length: call.poseCount }, (_, i) => this.read("SolverPose", call.poses + i * size));
      notLater(this.#functions.get(solver)({ ...call, poses }));
    });
  }

  #progress(progress, step, share) {
    return this.#guarded(() => (notLater(this.#functions.get(progress)(this.terminatedText(step), share)) ? 1 : 0), 1);
  }

  #canceled(canceled) {
    return this.#guarded(() => (notLater(this.#functions.get(canceled)()) ? 1 : 0), 1);
  }

  /** The handle of an object, for a function of this module. */
  handleOf(object) {
    if (typeof object?.handle !== "number") throw new TypeError(`${String(object)} is no object of the library`);
    if (object.memory !== this) throw new TypeError(`this ${object.constructor.name} is of another module`);
    return object.handle;
  }

  /** A block of the module's heap. */
  allocate(size) {
    const address = this.exports.malloc(checkSize(size));
    if (!address) throw errorOf(Status.MEMORY, `${size} bytes of memory are not available`);
    return address;
  }

  /** Runs a call that calls functions of the caller; throws what they threw. Until it is over, they can
   * neither use nor dispose of `objects`. */
  withFunctions(objects, call) {
    const thrown = [];
    this.#thrown.push(thrown);
    for (const object of objects) object.lock(true);
    try {
      const result = call();
      if (thrown.length) throw thrown[0];
      return result;
    } catch (error) {
      throw thrown.length ? thrown[0] : error;
    } finally {
      for (const object of objects) object.lock(false);
      this.#thrown.pop();
    }
  }

  /** Calls run(scratch) with memory that is released afterwards. */
  withScratch(run) {
    const scratch = new Scratch(this);
    try {
      return run(scratch);
    } finally {
      scratch.release();
    }
  }

  /** Throws unless a status is OK; `error` is the address of a struct Error, or 0. */
  check(status, error = 0, what = "") {
    if (status === Status.OK) return;
    const { message, byteOffset } = error ? this.read("Error", error) : { message: "", byteOffset: null };
    const text = message || `${what}${what && ": "}${this.terminatedText(this.exports.mien_status_name(status))}`;
    throw errorOf(status, text, byteOffset);
  }

  /** A struct as an object. Arrays in it are views until memory grows; text is copied. */
  read(name, address) {
    const object = {};
    for (const [key, [offset, kind, count]] of Object.entries(layouts[name].fields)) {
      object[key] = this.#readField(kind, address + offset, count);
    }
    return object;
  }

  #readField(kind, at, count) {
    const { data } = this;
    if (kind === "text") return this.terminatedText(at, count);
    if (kind === "string") return this.text(data.getUint32(at, true), data.getUint32(at + 4, true));
    if (kind === "f32s" || kind === "u16s" || kind === "u32s") {
      return this.array(kind.slice(0, 3), data.getUint32(at, true), data.getUint32(at + 4, true));
    }
    if (kind === "handle" || kind.startsWith("*")) return data.getUint32(at, true);
    if (layouts[kind]) return this.read(kind, at);
    if (count === undefined) return getNumber(data, kind, at);
    return Array.from({ length: count }, (_, i) => getNumber(data, kind, at + i * SIZES[kind]));
  }
}

/** Memory for the time of a call: small blocks on the stack of the module, others on its heap. */
class Scratch {
  #memory;
  #stack;
  #stackLeft = STACK_SHARE;
  #blocks = [];

  constructor(memory) {
    this.#memory = memory;
    this.#stack = memory.exports.stackSave();
  }

  release() {
    const { exports } = this.#memory;
    for (const block of this.#blocks) exports.free(block);
    exports.stackRestore(this.#stack);
  }

  /** Zeroed memory. */
  take(size) {
    const { exports } = this.#memory;
    let address;
    if (checkSize(size) <= STACK_BLOCK && size <= this.#stackLeft) {
      this.#stackLeft -= size;
      address = exports.stackAlloc(size);
    } else {
      address = this.#memory.allocate(size);
      this.#blocks.push(address);
    }
    new Uint8Array(this.#memory.buffer, address, size).fill(0);
    return address;
  }

  /** UTF-8, terminated: [address, bytes without the end]. */
  text(text) {
    if (typeof text !== "string") throw new TypeError(`${String(text)} is no text`);
    const bytes = encoder.encode(text);
    const address = this.take(bytes.length + 1);
    new Uint8Array(this.#memory.buffer).set(bytes, address);
    return [address, bytes.length];
  }

  /** A copy of numbers. */
  array(kind, values, { length } = values) {
    const address = this.take(Math.max(1, length) * SIZES[kind]);
    checkNumbers(values, kind, length);
    this.#memory.array(kind, address, length).set(values);
    return address;
  }

  /** An empty struct for results. */
  out(name) {
    const { size, sized } = layouts[name];
    const address = this.take(size);
    if (sized) this.#memory.data.setUint32(address, size, true);
    return address;
  }

  /** The addresses of several of them, one after the other. */
  outs(name, count) {
    const { size, sized } = layouts[name];
    const first = this.take(Math.max(1, count) * size);
    const addresses = Array.from({ length: count }, (_, i) => first + i * size);
    if (sized) for (const address of addresses) this.#memory.data.setUint32(address, size, true);
    return addresses;
  }

  /** A struct from an object; fields that it does not have are zero. */
  struct(name, values = {}) {
    const address = this.out(name);
    this.#fill(name, address, values);
    return address;
  }

  structs(name, list) {
    const { size } = layouts[name];
    const address = this.take(Math.max(1, list.length) * size);
    list.forEach((values, i) => this.#fill(name, address + i * size, values));
    return address;
  }

  #fill(name, address, values) {
    const { fields } = layouts[name];
    const lengths = new Map(); // of what a field of the struct counts
    for (const [key, value] of Object.entries(values)) {
      const field = Object.hasOwn(fields, key) ? fields[key] : undefined;
      if (!field) throw new TypeError(`${name} has no "${key}"; it has ${Object.keys(fields).join(", ")}`);
      if (value === undefined || value === null) continue;
      const length = this.#setField(address, field, value, key);
      const counter = field[2];
      if (length === undefined || counter === undefined) continue;
      if (lengths.has(counter) && lengths.get(counter) !== length) {
        throw new RangeError(`${name}: "${key}" and another list have different lengths`);
      }
      lengths.set(counter, length);
    }
    for (const [counter, length] of lengths) {
      const told = values[counter] ?? length; // fewer than there are may be meant
      if (told > length) throw new RangeError(`${name}: "${counter}" is ${told}, and there are ${length}`);
      setNumber(this.#memory.data, fields[counter][1], address + fields[counter][0], told, counter);
    }
  }

  /** Returns the length of a list whose pointer it set. */
  #setField(address, [offset, kind, count], value, key) {
    const memory = this.#memory;
    const at = address + offset;
    if (kind.startsWith("*")) {
      const [pointer, length] = this.#pointed(kind.slice(1), value, count !== undefined);
      memory.data.setUint32(at, pointer, true);
      return length;
    } else if (kind === "string") {
      const [pointer, length] = this.text(value);
      memory.data.setUint32(at, pointer, true);
      memory.data.setUint32(at + 4, length, true);
    } else if (kind === "handle") {
      memory.data.setUint32(at, memory.handleOf(value), true);
    } else if (layouts[kind]) {
      this.#fill(kind, at, value);
    } else if (count !== undefined) {
      if (value.length !== count) throw new RangeError(`"${key}" has ${value.length} numbers, not ${count}`);
      for (let i = 0; i < count; ++i) setNumber(memory.data, kind, at + i * SIZES[kind], value[i], key);
    } else {
      setNumber(memory.data, kind, at, value, key);
    }
    return undefined;
  }

  #pointed(kind, value, isList) {
    if (kind === "text") return this.text(value);
    if (kind === "string") {
      value = Array.from(value);
      const address = this.take(Math.max(1, value.length) * 8);
      value.forEach((text, i) => {
        const [pointer, length] = this.text(text);
        this.#memory.data.setUint32(address + i * 8, pointer, true);
        this.#memory.data.setUint32(address + i * 8 + 4, length, true);
      });
      return [address, value.length];
    }
    if (!layouts[kind]) {
      const { length } = value;
      return [this.array(kind, value, { length }), length];
    }
    if (!isList) return [this.struct(kind, value), 1];
    const list = Array.from(value);
    return [this.structs(kind, list), list.length];
  }
}
