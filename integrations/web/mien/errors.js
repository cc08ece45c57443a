// SPDX-License-Identifier: MIT
// What calls throw: a class for each family of statuses of mien.h.
import { Status } from "./api.js";

const names = new Map(Object.entries(Status).map(([name, value]) => [value, name]));

export class MienError extends Error {
  /** @param {number} status @param {string} message @param {number | null} byteOffset */
  constructor(status, message, byteOffset = null) {
    super(message || names.get(status) || `status ${status}`);
    this.status = status;
    this.byteOffset = byteOffset;
  }

  /** "DNA_TRUNCATED" for Status.DNA_TRUNCATED. */
  get statusName() {
    return names.get(this.status) ?? "UNKNOWN";
  }
}

export class ArgumentError extends MienError {}
export class MienMemoryError extends MienError {}
export class UnsupportedError extends MienError {}
export class FileError extends MienError {}
export class DnaError extends MienError {}
export class BakedError extends MienError {}
export class ClipError extends MienError {}
export class MixError extends MienError {}
export class AuthorError extends MienError {}

// Names that minifiers leave alone.
const classes = {
  MienError, ArgumentError, MienMemoryError, UnsupportedError, FileError, DnaError, BakedError, ClipError, MixError,
  AuthorError,
};
for (const [name, error] of Object.entries(classes)) {
  Object.defineProperty(error.prototype, "name", { value: name, configurable: true, writable: true });
}

/** The error of a status, in the class of its family. */
export function errorOf(status, message, byteOffset) {
  let family = MienError;
  if (status < Status.MEMORY) family = ArgumentError;
  else if (status === Status.MEMORY) family = MienMemoryError;
  else if (status === Status.UNSUPPORTED) family = UnsupportedError;
  else if (status < 30) family = FileError;
  else if (status < 50) family = DnaError;
  else if (status < 60) family = BakedError;
  else if (status < 70) family = ClipError;
  else if (status < 80) family = MixError;
  else if (status < 100) family = AuthorError;
  return new family(status, message, byteOffset);
}
