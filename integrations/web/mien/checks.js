// SPDX-License-Identifier: MIT
// Numbers before they go to the module: WebAssembly takes any value for a number, modulo 2^32 and NaN for 0.
const INTEGERS = {
  i8: [-(2 ** 7), 2 ** 7 - 1], u8: [0, 2 ** 8 - 1], i16: [-(2 ** 15), 2 ** 15 - 1], u16: [0, 2 ** 16 - 1],
  i32: [-(2 ** 31), 2 ** 31 - 1], u32: [0, 2 ** 32 - 1],
};
const LONGS = { i64: [-(2n ** 63n), 2n ** 63n - 1n], u64: [0n, 2n ** 64n - 1n], offset: [0n, 2n ** 64n - 1n] };
// The letters of `calls` in api.js. Addresses are the package's own.
const LETTERS = { u: "u32", i: "i32", f: "f32", U: "u64", I: "i64" };
// What the memory of a module can grow to.
const MOST_BYTES = 2 ** 31;

/** A number of a kind, or what is wrong with it: a TypeError or RangeError. */
export function checkNumber(value, kind, what) {
  const range = INTEGERS[kind];
  if (typeof value !== "number") throw new TypeError(`${what} is ${String(value)}: a number is needed`);
  if (range && !(Number.isInteger(value) && value >= range[0] && value <= range[1])) {
    throw new RangeError(`${what} is ${value}: a whole number from ${range[0]} to ${range[1]} is needed`);
  }
  return value;
}

/** The same for 64 bits, of a number or a BigInt; BigInt() throws for fractions and what is no number. */
export function checkLong(value, kind, what) {
  if (typeof value !== "number" && typeof value !== "bigint") {
    throw new TypeError(`${what} is ${String(value)}: a number is needed`);
  }
  const long = BigInt(value);
  const [least, most] = LONGS[kind];
  if (long < least || long > most) throw new RangeError(`${what} is ${value}: it needs more than 64 bits`);
  return long;
}

/** Numbers of a list, of the length that it had before. */
export function checkNumbers(values, kind, length) {
  if (values.length !== length) throw new TypeError("a list of numbers that changes its length");
  if (!INTEGERS[kind] && ArrayBuffer.isView(values)) return;
  for (let i = 0; i < length; ++i) checkNumber(values[i], kind, `number ${i} of a list`);
}

/** The size of a block of memory, which may be a product of counts. */
export function checkSize(size) {
  if (!Number.isSafeInteger(size) || size < 0 || size > MOST_BYTES) {
    throw new RangeError(`${size} bytes of memory: a module has at most ${MOST_BYTES}`);
  }
  return size;
}

/** A function of the module that checks the numbers it is given. `letters` tell their kinds. */
export function checked(name, call, letters) {
  const numbers = [...letters].flatMap((letter, i) => (letter === "p" ? [] : [[i, LETTERS[letter]]]));
  return (...given) => {
    for (const [i, kind] of numbers) {
      if (kind in LONGS) checkLong(given[i], kind, `argument ${i} of ${name}`);
      else checkNumber(given[i], kind, `argument ${i} of ${name}`);
    }
    return call(...given);
  };
}
