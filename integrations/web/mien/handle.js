// SPDX-License-Identifier: MIT
// Objects of the C interface: who may use them, and when they are released.
import { Status } from "./api.js";
import { errorOf } from "./errors.js";

/** An object of the C interface. Its memory is released by dispose(), never by itself. */
export class Handle {
  #handle;
  #destroy;
  #afterwards;
  #isDisposed = false;
  #isLocked = false;
  #users = 0;
  #views = new Map();

  /** `destroy` is the function that releases the object; `afterwards` is called after it. */
  constructor(memory, handle, destroy, afterwards) {
    this.memory = memory;
    this.#handle = handle;
    this.#destroy = destroy;
    this.#afterwards = afterwards;
    // Not a property for those who print an object.
    Object.defineProperty(this, "memory", { enumerable: false });
  }

  /** The address of the object, for functions of Mien.exports. */
  get handle() {
    if (this.#isDisposed) throw errorOf(Status.HANDLE, `this ${this.constructor.name} was disposed`);
    this.#checkUnlocked();
    return this.#handle;
  }

  /** Until it is unlocked, using and disposing of the object throws. */
  lock(isLocked) {
    if (isLocked) this.#checkUnlocked();
    this.#isLocked = isLocked;
  }

  #checkUnlocked() {
    if (this.#isLocked) throw new TypeError(`this ${this.constructor.name} is in use by the call that is under way`);
  }

  get isDisposed() {
    return this.#isDisposed;
  }

  dispose() {
    if (this.#isDisposed) return;
    this.#checkUnlocked();
    this.#isDisposed = true;
    this.#views.clear();
    if (!this.#users) this.#release();
  }

  #release() {
    this.memory.exports[this.#destroy](this.#handle);
    this.#handle = 0;
    this.#afterwards?.();
  }

  /** Keeps the object in memory, disposed or not, until drop(): another one reads it. */
  keep() {
    ++this.#users;
    return this;
  }

  drop() {
    if (!--this.#users && this.#isDisposed) this.#release();
  }

  /** Calls a function with this object and further arguments. */
  call(name, ...rest) {
    this.memory.check(this.memory.exports[name](this.handle, ...rest), 0, name);
  }

  /** A struct that a function returns. */
  struct(name, struct, ...rest) {
    return this.memory.withScratch((scratch) => {
      const out = scratch.out(struct);
      this.call(name, ...rest, out);
      return this.memory.read(struct, out);
    });
  }

  /** A number that a function returns. */
  number(name, ...rest) {
    return this.memory.withScratch((scratch) => {
      const out = scratch.take(4);
      this.call(name, ...rest, out);
      return this.memory.data.getUint32(out, true);
    });
  }

  /** The typed array that a function returns as a view: the same one until memory grows. */
  view(kind, name, ...rest) {
    const key = rest.length ? `${name} ${rest}` : name;
    const known = this.#views.get(key);
    const { memory } = this;
    // Growth of the memory empties arrays.
    if (known?.length && !this.#isDisposed) return known;
    const made = memory.withScratch((scratch) => {
      const out = scratch.take(8);
      this.call(name, ...rest, out);
      return memory.array(kind, memory.data.getUint32(out, true), memory.data.getUint32(out + 4, true));
    });
    this.#views.set(key, made);
    return made;
  }

  /** Bytes of which a function tells the size first: call(buffer, capacity, out_size, error). */
  bytes(call) {
    const { memory } = this;
    return memory.withScratch((scratch) => {
      const size = scratch.take(4);
      const error = scratch.out("Error");
      memory.check(call(0, 0, size, error, scratch), error);
      const capacity = memory.data.getUint32(size, true);
      const buffer = scratch.take(Math.max(1, capacity));
      memory.check(call(buffer, capacity, size, error, scratch), error);
      return memory.array("u8", buffer, capacity).slice();
    });
  }
}

if (Symbol.dispose) {
  Handle.prototype[Symbol.dispose] = function () {
    this.dispose();
  };
}

/** The handles of objects, none of which may occur twice. */
export function handlesOf(memory, scratch, objects) {
  if (new Set(objects).size !== objects.length) throw errorOf(Status.INVALID_ARGUMENT, "an object occurs twice");
  return scratch.array("u32", objects.map((object) => memory.handleOf(object)));
}

/** Calls make(out, error, scratch) and returns the handle that it wrote. */
export function makeHandle(memory, make) {
  return memory.withScratch((scratch) => {
    const out = scratch.take(4);
    const error = scratch.out("Error");
    memory.check(make(out, error, scratch), error);
    return memory.data.getUint32(out, true);
  });
}
