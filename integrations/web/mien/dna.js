// SPDX-License-Identifier: MIT
// An open DNA file: properties, fields by path, writing; and what a validation found.
import { FieldType, Severity } from "./api.js";
import { Handle, makeHandle } from "./handle.js";

export class Dna extends Handle {
  #info;

  /** Opens bytes; of these the loaded layers are copied. */
  static open(memory, bytes, desc = {}) {
    return new Dna(memory, makeHandle(memory, (out, error, scratch) =>
      memory.withStream(bytes, scratch, (stream) => {
        const { system, ...rest } = desc;
        const named = system === undefined ? rest : { ...rest, system: coordinateSystem(memory, system) };
        return memory.exports.mien_dna_open_stream(stream, scratch.struct("DnaDesc", named), out, error);
      })));
  }

  static generate(memory, desc) {
    return new Dna(memory, makeHandle(memory, (out, error, scratch) =>
      memory.exports.mien_dna_generate(scratch.struct("GenerateDesc", desc), out, error)));
  }

  constructor(memory, handle) {
    super(memory, handle, "mien_dna_close");
  }

  get info() {
    return (this.#info ??= this.struct("mien_dna_info", "DnaInfo"));
  }

  /** The entries of the index table. */
  get layers() {
    return Array.from({ length: this.info.layerCount }, (_, i) => this.struct("mien_dna_layer", "DnaLayer", i));
  }

  /** Pairs of keys and values of the descriptor. */
  get metadata() {
    const found = new Map();
    for (let i = 0; i < this.info.metadataCount; ++i) {
      found.set(this.read(`desc.metadata[${i}].key`), this.read(`desc.metadata[${i}].value`));
    }
    return found;
  }

  #atPath(path, call) {
    const { memory } = this;
    return memory.withScratch((scratch) => {
      const error = scratch.out("Error");
      const [text, count] = scratch.text(path);
      return call(text, count, error, scratch);
    });
  }

  /** Type, number of elements and place of a field. */
  field(path) {
    const { memory } = this;
    return this.#atPath(path, (text, count, error, scratch) => {
      const out = scratch.out("DnaField");
      memory.check(memory.exports.mien_dna_field_n(this.handle, text, count, out, error), error);
      return memory.read("DnaField", out);
    });
  }

  /** Names of the fields of a record; of the empty path, the layers. */
  children(path = "") {
    const { memory } = this;
    const count = path === "" ? undefined : this.field(path).count;
    const names = [];
    for (let i = 0; i < (count ?? 64); ++i) {
      const name = this.#atPath(path, (text, length, error, scratch) => {
        const out = scratch.take(8);
        const status = memory.exports.mien_dna_child_name_n(this.handle, text, length, i, out, error);
        if (status && count === undefined && i > 0) return undefined; // past the last layer
        memory.check(status, error);
        return memory.text(memory.data.getUint32(out, true), memory.data.getUint32(out + 4, true));
      });
      if (name === undefined) break;
      names.push(name);
    }
    return names;
  }

  /** A string, a number, or a copy of an array: Float32Array for floats, Float64Array for integers. */
  read(path) {
    const { memory } = this;
    const { type, count, isArray } = this.field(path);
    return this.#atPath(path, (text, length, error, scratch) => {
      const { exports } = memory;
      if (type === FieldType.RECORD || type === FieldType.LIST) {
        throw new TypeError(`${path} holds fields, not values: read one of them`);
      }
      if (type === FieldType.STRING) {
        const out = scratch.take(8);
        memory.check(exports.mien_dna_read_string_n(this.handle, text, length, out, error), error);
        return memory.text(memory.data.getUint32(out, true), memory.data.getUint32(out + 4, true));
      }
      const floats = type === FieldType.F32;
      const out = scratch.take(Math.max(1, count) * (floats ? 4 : 8));
      const read = floats ? exports.mien_dna_read_floats_n : exports.mien_dna_read_integers_n;
      memory.check(read(this.handle, text, length, 0n, BigInt(count), out, error), error);
      const values = floats
        ? memory.array("f32", out, count).slice()
        : Float64Array.from(new BigInt64Array(memory.buffer, out, count), Number);
      return isArray ? values : values[0];
    });
  }

  /** The bytes of a DNA file. */
  write(desc = {}) {
    return this.bytes((buffer, capacity, size, error, scratch) =>
      this.memory.exports.mien_dna_write_memory(this.handle, scratch.struct("WriteDesc", desc), buffer,
        capacity, size, error));
  }
}

/** A coordinate system by name, or as it is. */
export function coordinateSystem(memory, system) {
  if (typeof system !== "string") return system;
  return memory.withScratch((scratch) => {
    const out = scratch.out("CoordinateSystem");
    const [text, count] = scratch.text(system);
    memory.check(memory.exports.mien_coordinate_system_find_n(text, count, out), 0,
      `there is no coordinate system "${system}"; there are ${coordinateSystemNames(memory).join(", ")}`);
    return memory.read("CoordinateSystem", out);
  });
}

export function coordinateSystemNames(memory) {
  return memory.withScratch((scratch) => {
    const out = scratch.take(8);
    const names = [];
    while (memory.exports.mien_coordinate_system_name(names.length, out) === 0) {
      names.push(memory.text(memory.data.getUint32(out, true), memory.data.getUint32(out + 4, true)));
    }
    return names;
  });
}

/** What is wrong with the bytes of a DNA file. */
export function validate(memory, bytes) {
  const handle = makeHandle(memory, (out, error, scratch) => {
    const copy = scratch.array("u8", bytes);
    return memory.exports.mien_dna_validate_memory(copy, bytes.length, scratch.struct("ValidateDesc"), out, error);
  });
  return findingsOf(memory, handle);
}

/** What a report says, which is released. */
export function findingsOf(memory, handle) {
  const report = new Handle(memory, handle, "mien_report_destroy");
  try {
    const [errors, warnings] = memory.withScratch((scratch) => {
      const out = scratch.take(8);
      report.call("mien_report_counts", out, out + 4);
      return [memory.data.getUint32(out, true), memory.data.getUint32(out + 4, true)];
    });
    const findings = Array.from({ length: errors + warnings }, (_, i) => {
      const finding = report.struct("mien_report_finding", "Finding", i);
      return { ...finding, isError: finding.severity === Severity.ERROR };
    });
    return { errors, warnings, findings };
  } finally {
    report.dispose();
  }
}
