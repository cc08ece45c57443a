// SPDX-License-Identifier: MIT
// Documents: DNA files that can be changed. index.d.ts is the manual.
import { FieldType, Kind, Match, Status } from "./api.js";
import { coordinateSystem, Dna, findingsOf } from "./dna.js";
import { errorOf } from "./errors.js";
import { Handle, makeHandle } from "./handle.js";

const mismatch = (message) => errorOf(Status.MISMATCH, message);

/** How many vectors of three numbers there are. */
function vectors(values, what) {
  if (values.length % 3) throw mismatch(`${what} has ${values.length} numbers, which is no multiple of 3`);
  return values.length / 3;
}

export class Document extends Handle {
  /** Of an open file, or, of null, an empty one. */
  static create(memory, dna) {
    return new Document(memory, makeHandle(memory, (out, error, scratch) => memory.exports.mien_document_create(
      dna === null ? 0 : memory.handleOf(dna), scratch.struct("DocumentDesc"), out, error)));
  }

  constructor(memory, handle) {
    super(memory, handle, "mien_document_destroy");
  }

  /** Calls a function with the document, what give(scratch) returns, and a place for what went wrong. */
  #do(name, give = () => []) {
    const { memory } = this;
    return memory.withScratch((scratch) => {
      const error = scratch.out("Error");
      memory.check(memory.exports[name](this.handle, ...give(scratch), error), error, name);
    });
  }

  /** The same of a function whose last parameter but one is the place of a result. */
  #get(name, take, read, give = () => []) {
    const { memory } = this;
    return memory.withScratch((scratch) => {
      const error = scratch.out("Error");
      const given = give(scratch);
      const out = take(scratch);
      memory.check(memory.exports[name](this.handle, ...given, out, error), error, name);
      return read(memory, out);
    });
  }

  #struct(name, struct, give) {
    return this.#get(name, (scratch) => scratch.out(struct), (memory, out) => memory.read(struct, out), give);
  }

  #number(name, give) {
    return this.#get(name, (scratch) => scratch.take(4), (memory, out) => memory.data.getUint32(out, true), give);
  }

  #double(name, give) {
    return this.#get(name, (scratch) => scratch.take(8), (memory, out) => memory.data.getFloat64(out, true), give);
  }

  /** A view of bytes: calls read(memory, address, count). */
  #view(name, read, give) {
    return this.#get(name, (scratch) => scratch.take(8),
      (memory, out) => read(memory, memory.data.getUint32(out, true), memory.data.getUint32(out + 4, true)), give);
  }

  // Fields

  field(path) {
    return this.#struct("mien_document_field", "DnaField", (scratch) => [scratch.text(path)[0]]);
  }

  children(path = "") {
    return Array.from({ length: this.field(path).count }, (_, i) => this.#view("mien_document_child_name",
      (memory, at, count) => memory.text(at, count), (scratch) => [scratch.text(path)[0], i]));
  }

  read(path) {
    const { type, count, isArray } = this.field(path);
    if (type === FieldType.RECORD || type === FieldType.LIST) {
      throw new TypeError(`${path} holds fields, not values: read one of them`);
    }
    if (type === FieldType.STRING) {
      return this.#view("mien_document_read_string", (memory, at, length) => memory.text(at, length),
        (scratch) => [scratch.text(path)[0]]);
    }
    const { memory } = this;
    const floats = type === FieldType.F32;
    const values = this.#get(floats ? "mien_document_read_floats" : "mien_document_read_integers",
      (scratch) => scratch.take(Math.max(1, count) * (floats ? 4 : 8)),
      (_, out) => (floats ? memory.array("f32", out, count).slice()
        : Float64Array.from(new BigInt64Array(memory.buffer, out, count), Number)),
      (scratch) => [scratch.text(path)[0], 0n, BigInt(count)]);
    return isArray ? values : values[0];
  }

  bytes(path) {
    return this.#view("mien_document_bytes", (memory, at, count) => memory.array("u8", at, count).slice(),
      (scratch) => [scratch.text(path)[0]]);
  }

  write(path, value, first) {
    const { type, count, isArray } = this.field(path);
    if (typeof value === "string") {
      return this.#do("mien_document_write_string", (scratch) => [scratch.text(path)[0], ...scratch.text(value)]);
    }
    const values = typeof value === "number" ? [value] : value;
    // All or nothing: a wrong number is found before the length changes.
    const floats = type === FieldType.F32;
    const longs = floats ? null : BigInt64Array.from(values, (number) => BigInt(number));
    const mark = this.mark();
    try {
      if (isArray && first === undefined && count !== values.length) this.resize(path, values.length);
      this.#do(floats ? "mien_document_write_floats" : "mien_document_write_integers", (scratch) => {
        const text = scratch.text(path)[0];
        let at;
        if (floats) {
          at = scratch.array("f32", values);
        } else {
          at = scratch.take(Math.max(1, longs.length) * 8);
          new BigInt64Array(this.memory.buffer, at, longs.length).set(longs);
        }
        return [text, BigInt(first ?? 0), BigInt(values.length), at];
      });
    } catch (error) {
      this.undo(mark);
      throw error;
    }
    return undefined;
  }

  splice(path, first, removed, inserted) {
    this.#do("mien_document_splice",
      (scratch) => [scratch.text(path)[0], BigInt(first), BigInt(removed), BigInt(inserted)]);
  }

  resize(path, count) {
    this.#do("mien_document_resize", (scratch) => [scratch.text(path)[0], BigInt(count)]);
  }

  // Layers

  #layerCount() {
    return this.memory.withScratch((scratch) => {
      const out = scratch.take(8);
      this.#do("mien_document_layer_count", () => [out, out + 4]);
      return [this.memory.data.getUint32(out, true), this.memory.data.getUint32(out + 4, true)];
    });
  }

  get version() {
    return this.#layerCount()[0];
  }

  get layers() {
    return Array.from({ length: this.#layerCount()[1] }, (_, i) => this.memory.withScratch((scratch) => {
      const layer = scratch.out("DnaLayer");
      const bytes = this.#view("mien_document_layer", (memory, at, count) => memory.array("u8", at, count).slice(),
        () => [i, layer]);
      return { ...this.memory.read("DnaLayer", layer), bytes };
    }));
  }

  clearLayers(version = this.version) {
    this.#do("mien_document_clear_layers", () => [version]);
  }

  addLayer(code, versionMajor, versionMinor, bytes = new Uint8Array(0)) {
    this.#do("mien_document_add_layer", (scratch) =>
      [scratch.text(code)[0], versionMajor, versionMinor, scratch.array("u8", bytes), bytes.length]);
  }

  // Undoing

  mark() {
    return this.#get("mien_document_mark", (scratch) => scratch.take(8),
      (memory, out) => Number(memory.data.getBigUint64(out, true)));
  }

  undo(mark = 0) {
    this.#do("mien_document_undo", () => [BigInt(mark)]);
  }

  // Elements, by name or number

  find(kind, element) {
    if (typeof element === "number") return element;
    return this.#number("mien_document_find", (scratch) => [kind, scratch.text(element)[0]]);
  }

  #found(kind, elements) {
    const list = typeof elements === "string" || typeof elements === "number" ? [elements] : Array.from(elements);
    return list.map((element) => this.find(kind, element));
  }

  rename(kind, element, name) {
    const index = this.find(kind, element);
    this.#do("mien_document_rename", (scratch) => [kind, index, scratch.text(name)[0]]);
  }

  remove(kind, elements) {
    const indices = this.#found(kind, elements);
    this.#do("mien_document_remove", (scratch) => [kind, scratch.array("u32", indices), indices.length]);
  }

  clear(kind) {
    this.#do("mien_document_clear", () => [kind]);
  }

  clearJoints(joints) {
    const indices = this.#found(Kind.JOINT, joints);
    this.#do("mien_document_clear_joints", (scratch) => [scratch.array("u32", indices), indices.length]);
  }

  // Shapes and weights

  setNeutral(firstJoint, { translations, rotations } = {}) {
    const joint = this.find(Kind.JOINT, firstJoint);
    const counts = [translations && vectors(translations, "translations"), rotations && vectors(rotations, "rotations")];
    const [moved, turned] = counts;
    if (translations && rotations && moved !== turned) throw mismatch("translations and rotations are not as many");
    this.#do("mien_document_set_neutral", (scratch) => [joint, translations ? scratch.array("f32", translations) : 0,
      rotations ? scratch.array("f32", rotations) : 0, moved ?? turned ?? 0]);
  }

  setPositions(mesh, positions) {
    const [index, count] = [this.find(Kind.MESH, mesh), vectors(positions, "positions")];
    this.#do("mien_document_set_positions", (scratch) => [index, scratch.array("f32", positions), count]);
  }

  setTarget(mesh, channel, deltas, vertices = null) {
    const indices = [this.find(Kind.MESH, mesh), this.find(Kind.BLEND_SHAPE_CHANNEL, channel)];
    const count = vectors(deltas, "deltas");
    if (vertices && vertices.length !== count) throw mismatch(`${vertices.length} vertices have ${count} deltas`);
    this.#do("mien_document_set_target", (scratch) =>
      [...indices, vertices ? scratch.array("u32", vertices) : 0, scratch.array("f32", deltas), count]);
  }

  pruneTargets(tolerance) {
    return this.#struct("mien_document_prune_targets", "PrunedTargets", () => [tolerance]);
  }

  pruneJoints(limits) {
    return this.#struct("mien_document_prune_joints", "PrunedJoints",
      (scratch) => [scratch.struct("PruneJointsDesc", limits)]);
  }

  setWeights(mesh, influences, joints, weights) {
    const index = this.find(Kind.MESH, mesh);
    if (joints.length !== weights.length) throw mismatch(`${joints.length} joints have ${weights.length} weights`);
    this.#do("mien_document_set_weights", (scratch) =>
      [index, influences, scratch.array("u16", joints), scratch.array("f32", weights), weights.length]);
  }

  normalizeWeights(mesh) {
    const index = this.find(Kind.MESH, mesh);
    this.#do("mien_document_normalize_weights", () => [index]);
  }

  limitInfluences(mesh, influences) {
    const index = this.find(Kind.MESH, mesh);
    this.#do("mien_document_limit_influences", () => [index, influences]);
  }

  smoothWeights(mesh, { iterations = 1, strength = 0.5, influences = 8 } = {}) {
    const index = this.find(Kind.MESH, mesh);
    this.#do("mien_document_smooth_weights", () => [index, iterations, strength, influences]);
  }

  place(placement) {
    if (placement.scale === 0) throw errorOf(Status.INVALID_ARGUMENT, "the scale is 0");
    this.#do("mien_document_place", (scratch) => [scratch.struct("Placement", placement)]);
  }

  keepLods(lods) {
    let bits = 0n;
    for (const lod of lods) bits |= 1n << BigInt(lod);
    this.#do("mien_document_keep_lods", () => [BigInt.asUintN(64, bits)]);
  }

  convert(system) {
    const known = coordinateSystem(this.memory, system);
    this.#do("mien_document_convert", (scratch) => [scratch.struct("CoordinateSystem", known)]);
  }

  // Parts of other documents

  copyLayers(from, layers) {
    this.#do("mien_document_copy_layers", () => [this.memory.handleOf(from), layers]);
  }

  copyMesh(from, mesh) {
    const index = from.find(Kind.MESH, mesh);
    return this.#number("mien_document_copy_mesh", () => [this.memory.handleOf(from), index]);
  }

  mergeJoints(from, tolerance = 1e-3) {
    this.#do("mien_document_merge_joints", () => [this.memory.handleOf(from), tolerance]);
  }

  splitJoints(from) {
    this.#do("mien_document_split_joints", () => [this.memory.handleOf(from)]);
  }

  project(mesh, source, options = {}) {
    const indices = [this.find(Kind.MESH, mesh), this.find(Kind.MESH, source)];
    return this.#double("mien_document_project", (scratch) => [...indices, scratch.struct("ProjectDesc", options)]);
  }

  makeLod(lod, source, options = {}) {
    return this.#double("mien_document_make_lod", (scratch) => [lod, source, scratch.struct("ProjectDesc", options)]);
  }

  conform(mesh, positions, { others = true } = {}) {
    const [index, count] = [this.find(Kind.MESH, mesh), vectors(positions, "positions")];
    return this.#struct("mien_document_conform", "Conformed",
      (scratch) => [index, scratch.array("f32", positions), count, others ? 1 : 0]);
  }

  transplant(rig, { match = Match.SURFACE, influences = 0 } = {}) {
    const capacity = rig.field("defn.rawControlNames").count;
    const { memory } = this;
    return memory.withScratch((scratch) => {
      const errors = scratch.structs("ControlError", Array.from({ length: capacity }, () => ({})));
      const count = this.#number("mien_document_transplant", (more) =>
        [memory.handleOf(rig), more.struct("TransplantDesc", { match, influences }), errors, capacity]);
      return Array.from({ length: count }, (_, i) => memory.read("ControlError", errors + 32 * i));
    });
  }

  // Results

  toDna() {
    const { memory } = this;
    return new Dna(memory, makeHandle(memory, (out, error, scratch) =>
      memory.exports.mien_document_to_dna(this.handle, scratch.struct("DocumentDesc"), out, error)));
  }

  /** The bytes of the DNA file. */
  toBytes(desc = {}) {
    return super.bytes((buffer, capacity, size, error, scratch) =>
      this.memory.exports.mien_document_write_memory(this.handle, scratch.struct("WriteDesc", desc), buffer,
        capacity, size, error));
  }

  validate() {
    const { memory } = this;
    return findingsOf(memory, makeHandle(memory, (out, error, scratch) =>
      memory.exports.mien_document_validate(this.handle, scratch.struct("ValidateDesc"), out, error)));
  }
}
