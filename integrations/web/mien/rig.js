// SPDX-License-Identifier: MIT
// A rig, the characters that it evaluates, and batches of them.
import { Kind, layouts, Stage, Status } from "./api.js";
import { Deformer } from "./deformer.js";
import { errorOf } from "./errors.js";
import { Fit } from "./fit.js";
import { Handle, makeHandle } from "./handle.js";
import { findAntagonists, findMask, Mix } from "./mix.js";

const MAGIC = "MIENBAKE";
const MOST_SHARES = 16;

export function isBaked(bytes) {
  return bytes.length >= 8 && String.fromCharCode(...bytes.subarray(0, 8)) === MAGIC;
}

/** The usual name of a control; undefined if the table of names does not have it. */
export function controlName(memory, name) {
  return memory.withScratch((scratch) => {
    const room = 256;
    const [text, length] = scratch.text(name);
    const out = scratch.take(room);
    const count = scratch.take(4);
    const status = memory.exports.mien_control_name(text, length, out, room, count);
    if (status === Status.NAME) return undefined;
    memory.check(status, 0, "mien_control_name");
    return memory.text(out, memory.data.getUint32(count, true));
  });
}

export class Rig extends Handle {
  #names = new Map();
  #indices = new Map();
  #info;

  /** The deformer that was made with the rig, and is disposed with it; null: there is no geometry. */
  deformer = null;
  /** Metadata of the DNA file; empty for baked files. */
  metadata = new Map();

  static create(memory, dna, desc = {}) {
    return new Rig(memory, makeHandle(memory, (out, error, scratch) =>
      memory.exports.mien_rig_create(memory.handleOf(dna), scratch.struct("RigDesc", desc), out, error)));
  }

  /** The rig of a baked file, and its deformer if it has one. */
  static fromBaked(memory, bytes, { check, isa, reuse, normals, deformer = true } = {}) {
    const baked = new Handle(memory, makeHandle(memory, (out, error, scratch) =>
      memory.withStream(bytes, scratch, (stream) =>
        memory.exports.mien_baked_open_stream(stream, scratch.struct("BakedDesc", { check }), out, error))),
    "mien_baked_close");
    let rig;
    try {
      rig = new Rig(memory, makeHandle(memory, (out, error, scratch) =>
        memory.exports.mien_rig_from_baked(memory.handleOf(baked), scratch.struct("BakedRigDesc", { isa, reuse }), out, error)));
      if (deformer && baked.struct("mien_baked_info", "BakedInfo").deformerBytes) {
        rig.deformer = Deformer.fromBaked(memory, baked, rig, { isa, normals });
      }
      return rig;
    } catch (error) {
      rig?.dispose();
      throw error;
    } finally {
      baked.dispose();
    }
  }

  constructor(memory, handle) {
    super(memory, handle, "mien_rig_destroy");
  }

  dispose() {
    this.deformer?.dispose();
    super.dispose();
  }

  get info() {
    return (this.#info ??= this.struct("mien_rig_info", "RigInfo"));
  }

  count(kind) {
    return this.number("mien_rig_count", kind);
  }

  name(kind, index) {
    const { memory } = this;
    return memory.withScratch((scratch) => {
      const out = scratch.take(8);
      this.call("mien_rig_name", kind, index, out);
      return memory.text(memory.data.getUint32(out, true), memory.data.getUint32(out + 4, true));
    });
  }

  /** All names of a kind. */
  names(kind) {
    let names = this.#names.get(kind);
    if (!names) {
      names = Object.freeze(Array.from({ length: this.count(kind) }, (_, i) => this.name(kind, i)));
      this.#names.set(kind, names);
    }
    return names;
  }

  /** The index of a name, of the name behind its last dot, or of the only one that ends in "." and it;
   * undefined if there is none. */
  find(kind, name) {
    const indices = this.#indicesOf(kind);
    return indices.get(name) ?? indices.get(name.slice(name.lastIndexOf(".") + 1));
  }

  #indicesOf(kind) {
    let indices = this.#indices.get(kind);
    if (!indices) {
      const names = this.names(kind);
      indices = new Map();
      const short = new Map();
      names.forEach((name, i) => {
        if (!indices.has(name)) indices.set(name, i);
        const end = name.slice(name.lastIndexOf(".") + 1);
        if (end !== name) short.set(end, short.has(end) ? undefined : i);
      });
      for (const [name, i] of short) if (i !== undefined && !indices.has(name)) indices.set(name, i);
      this.#indices.set(kind, indices);
    }
    return indices;
  }

  /** The exact name, as the library finds it; throws if there is none. */
  indexOf(kind, name) {
    const { memory } = this;
    return memory.withScratch((scratch) => {
      const out = scratch.take(4);
      const [text, count] = scratch.text(name);
      memory.check(memory.exports.mien_rig_find_n(this.handle, kind, text, count, out), 0, `there is no "${name}"`);
      return memory.data.getUint32(out, true);
    });
  }

  match(name) {
    const { memory } = this;
    const { size } = layouts.ControlShare;
    return memory.withScratch((scratch) => {
      const shares = scratch.take(MOST_SHARES * size);
      const out = scratch.take(8);
      const [text, length] = scratch.text(name);
      const status = memory.exports.mien_rig_match(this.handle, text, length, shares, MOST_SHARES, out, out + 4);
      if (status === Status.NAME) return undefined;
      memory.check(status, 0, "mien_rig_match");
      const count = memory.data.getUint32(out, true);
      return {
        how: memory.data.getUint32(out + 4, true),
        shares: Array.from({ length: count }, (_, i) => memory.read("ControlShare", shares + i * size)),
      };
    });
  }

  lodIndices(kind, lod) {
    return this.view("u16", "mien_rig_lod_indices", kind, lod);
  }

  variableJointValues(lod) {
    return this.view("u16", "mien_rig_variable_joint_values", lod);
  }

  get jointParents() {
    return this.view("u16", "mien_rig_joint_parents");
  }

  get neutralJointValues() {
    return this.view("f32", "mien_rig_neutral_joint_values");
  }

  psdInputs(psd) {
    return this.view("u16", "mien_rig_psd_inputs", psd);
  }

  get initialRawControls() {
    return this.view("f32", "mien_rig_initial_raw_controls");
  }

  statistics(lod) {
    return this.struct("mien_rig_statistics", "RigStatistics", lod);
  }

  /** A character. */
  instance() {
    return new Instance(this.memory, this);
  }

  batch(desc = {}) {
    return new Batch(this.memory, this, desc);
  }

  batchBytes(desc = {}) {
    const { memory } = this;
    return memory.withScratch((scratch) => {
      const out = scratch.take(8);
      this.call("mien_batch_bytes", scratch.struct("BatchDesc", { tasks: memory.threads, ...desc }), out);
      return Number(memory.data.getBigUint64(out, true));
    });
  }

  mix(desc = {}) {
    return Mix.create(this.memory, this, desc);
  }

  fit(desc = {}) {
    if (!this.memory.exports.mien_fit_create) {
      throw errorOf(Status.UNSUPPORTED, "this module opens baked files only: load the other one to solve");
    }
    return Fit.create(this.memory, this, desc);
  }

  antagonists() {
    return findAntagonists(this.memory, this);
  }

  groupMask(groups, options = {}) {
    return findMask(this.memory, this, groups, options);
  }

  /** A deformer of the file that the rig was made from. */
  createDeformer(dna, desc = {}) {
    return Deformer.create(this.memory, dna, this, desc);
  }

  /** The bytes of a baked file with this rig and a deformer. */
  bake(deformer = this.deformer) {
    return this.bytes((buffer, capacity, size, error) =>
      this.memory.exports.mien_bake_memory(this.handle, deformer ? this.memory.handleOf(deformer) : 0, buffer, capacity, size, error));
  }
}

/** Numbers by name: face.controls.jawOpen = 1. Names without a control throw. */
function named(rig, kind, what, array) {
  const indexOf = (name) => {
    const index = rig.find(kind, name);
    if (index === undefined) throw errorOf(Status.NAME, `the rig has no ${what} "${name}"`);
    return index;
  };
  return new Proxy(Object.create(null), {
    get: (_, name) => (typeof name === "string" ? array()[indexOf(name)] : undefined),
    set(_, name, value) {
      array()[indexOf(String(name))] = value;
      return true;
    },
    has: (_, name) => typeof name === "string" && rig.find(kind, name) !== undefined,
    ownKeys: () => [...new Set(rig.names(kind))],
    getOwnPropertyDescriptor(_, name) {
      if (typeof name !== "string" || rig.find(kind, name) === undefined) return undefined;
      return { value: array()[indexOf(name)], writable: true, enumerable: true, configurable: true };
    },
    deleteProperty: () => false,
  });
}

export class Instance extends Handle {
  #rig;

  constructor(memory, rig) {
    super(memory, makeHandle(memory, (out, error, scratch) =>
      memory.exports.mien_instance_create(memory.handleOf(rig), scratch.struct("InstanceDesc"), out, error)),
    "mien_instance_destroy");
    this.#rig = rig;
    /** Raw controls by name. */
    this.controls = named(rig, Kind.RAW_CONTROL, "raw control", () => this.rawControls);
    /** GUI controls by name. */
    this.gui = named(rig, Kind.GUI_CONTROL, "GUI control", () => this.guiControls);
  }

  get rig() {
    return this.#rig;
  }

  reset() {
    this.call("mien_instance_reset");
  }

  get rawControls() {
    return this.view("f32", "mien_instance_raw_controls");
  }

  get guiControls() {
    return this.view("f32", "mien_instance_gui_controls");
  }

  get mlMasks() {
    return this.view("f32", "mien_instance_ml_masks");
  }

  get allControls() {
    return this.view("f32", "mien_instance_controls");
  }

  get psdControls() {
    return this.view("f32", "mien_instance_psd_controls");
  }

  get mlControls() {
    return this.view("f32", "mien_instance_ml_controls");
  }

  get rbfControls() {
    return this.view("f32", "mien_instance_rbf_controls");
  }

  get joints() {
    return this.view("f32", "mien_instance_joints");
  }

  get blendShapes() {
    return this.view("f32", "mien_instance_blend_shapes");
  }

  get animatedMaps() {
    return this.view("f32", "mien_instance_animated_maps");
  }

  get statistics() {
    return this.struct("mien_instance_statistics", "InstanceStatistics");
  }

  #run(name, ...rest) {
    const { memory } = this;
    memory.check(memory.exports[name](memory.handleOf(this.#rig), this.handle, ...rest), 0, name);
  }

  mapGuiToRaw() {
    this.#run("mien_rig_map_gui_to_raw");
  }

  mapRawToGui() {
    this.#run("mien_rig_map_raw_to_gui");
  }

  /** All stages, or some: Stage.PSD | Stage.JOINTS. */
  evaluate(lod = 0, stages = Stage.ALL) {
    const { memory } = this;
    const { exports } = memory;
    const status = stages === Stage.ALL
      ? exports.mien_rig_evaluate(memory.handleOf(this.#rig), this.handle, lod)
      : exports.mien_rig_evaluate_stages(memory.handleOf(this.#rig), this.handle, lod, stages);
    if (status !== Status.OK) memory.check(status, 0, "mien_rig_evaluate");
  }

  evaluateJointGroup(lod, group) {
    this.#run("mien_rig_evaluate_joint_group", lod, group);
  }

  evaluateRbfSolver(lod, solver) {
    this.#run("mien_rig_evaluate_rbf_solver", lod, solver);
  }

  evaluateTwistSwing(lod, setup) {
    this.#run("mien_rig_evaluate_twist_swing", lod, setup);
  }
}

export class Batch extends Handle {
  #rig;

  constructor(memory, rig, desc) {
    super(memory, makeHandle(memory, (out, error, scratch) =>
      memory.exports.mien_batch_create(memory.handleOf(rig), scratch.struct("BatchDesc", { tasks: memory.threads, ...desc }), out, error)),
    "mien_batch_destroy");
    this.#rig = rig;
  }

  /** Evaluates instances of the rig in one call; `lods` is one LOD for all, or one for each. */
  evaluate(instances, lods = 0, stages = Stage.ALL) {
    const { memory } = this;
    memory.withScratch((scratch) => {
      const handles = scratch.array("u32", Array.from(instances, (instance) => memory.handleOf(instance)));
      const each = scratch.array("u32", instances.map((_, i) => (typeof lods === "number" ? lods : lods[i])));
      memory.check(memory.exports.mien_rig_evaluate_batch(memory.handleOf(this.#rig), this.handle, handles, each,
        instances.length, stages, memory.parallel), 0, "mien_rig_evaluate_batch");
    });
  }
}
