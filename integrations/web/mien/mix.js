// SPDX-License-Identifier: MIT
// Mixes: layers, reactions and guards of one rig; mixers: one character each; gazes.
import { Kind, layouts, Status, TICKS_PER_SECOND, Transition } from "./api.js";
import { checkNumber } from "./checks.js";
import { errorOf } from "./errors.js";
import { Handle, handlesOf, makeHandle } from "./handle.js";
import { Curves, Parts } from "./mix_parts.js";

/** Copies of the arrays in a struct: views of memory that may be released. */
function copied(struct) {
  return Object.fromEntries(Object.entries(struct).map(([key, value]) =>
    [key, ArrayBuffer.isView(value) ? value.slice() : value]));
}

export class Mix extends Handle {
  #info;
  #variables;

  static create(memory, rig, {
    layers = [], reactions = [], antagonists = [], customGuards = [], variables = [], lower, upper, mirror, deformer,
    ...rest
  } = {}) {
    const curves = new Curves(rig, variables);
    const parts = new Parts(curves);
    const desc = {
      ...rest,
      layers: layers.map((layer) => parts.layer(layer)),
      reactions: reactions.map((reaction) => parts.reaction(reaction)),
      antagonists: antagonists.map((pair) => parts.antagonists(pair)),
      customGuards: customGuards.map((guard) => parts.guard(guard)),
      poses: parts.poses,
      lower: curves.each(lower, "lower"),
      upper: curves.each(upper, "upper"),
      mirror: mirror && curves.full(mirror, "mirror"),
      // Guards are measured on meshes and joints: those of the rig, unless others are given.
      deformer: deformer ?? (rest.guards || customGuards.length ? rig.deformer : null),
      variableCount: variables.length,
    };
    return new Mix(memory, makeHandle(memory, (out, error, scratch) =>
      memory.exports.mien_mix_create(memory.handleOf(rig), scratch.struct("MixDesc", desc), out, error)), variables);
  }

  /** Opens bytes that write() gave. */
  static open(memory, bytes, rig, { variables = [] } = {}) {
    const mix = new Mix(memory, makeHandle(memory, (out, error, scratch) =>
      memory.exports.mien_mix_open_memory(scratch.array("u8", bytes), bytes.length, rig ? memory.handleOf(rig) : 0,
        scratch.struct("MixOpenDesc"), out, error)), variables);
    const { variableCount } = mix.info;
    if (variables.length && variables.length !== variableCount) {
      mix.dispose();
      throw errorOf(Status.MISMATCH, `${variables.length} names for ${variableCount} pose variables`);
    }
    return mix;
  }

  constructor(memory, handle, variables) {
    super(memory, handle, "mien_mix_destroy");
    this.#variables = new Map(variables.map((name, i) => [name, i]));
  }

  get info() {
    return (this.#info ??= this.struct("mien_mix_info", "MixInfo"));
  }

  /** Numbers of the pose variables by name. */
  get variables() {
    return this.#variables;
  }

  guard(index) {
    return copied(this.struct("mien_mix_guard", "MixGuardInfo", index));
  }

  /** A character. */
  mixer(desc = {}) {
    return new Mixer(this.memory, this, desc);
  }

  #written(name) {
    return this.bytes((buffer, capacity, size, error) =>
      this.memory.exports[name](this.handle, buffer, capacity, size, error));
  }

  /** The bytes of a file. */
  write() {
    return this.#written("mien_mix_write_memory");
  }

  /** The same as text, for people. */
  toText() {
    return new TextDecoder().decode(this.#written("mien_mix_write_text"));
  }
}

/** The response to a light in the eyes: mien_mix_glare(). */
export function glare(memory, poses) {
  if (poses.length !== 5) throw errorOf(Status.INVALID_ARGUMENT, `a glare takes 5 poses, not ${poses.length}`);
  return memory.withScratch((scratch) => {
    const strokes = scratch.take(poses.length * layouts.MixStroke.size);
    const out = scratch.out("MixReaction");
    memory.check(memory.exports.mien_mix_glare(0, strokes, poses.length, out), 0, "mien_mix_glare");
    const { strokeCount, ...reaction } = memory.read("MixReaction", out);
    return {
      ...reaction,
      strokes: Array.from({ length: strokeCount }, (_, i) => {
        const stroke = memory.read("MixStroke", strokes + i * layouts.MixStroke.size);
        return { ...stroke, pose: poses[stroke.pose] };
      }),
    };
  });
}

export class Mixer extends Handle {
  #mix;
  /** What the library may read in a step: of each layer the last two clips with their bindings. */
  #playing = new Map();
  #restored = [];
  /** Kept until the next step, for names of events. */
  #old = [];

  constructor(memory, mix, desc) {
    super(memory, makeHandle(memory, (out, error, scratch) =>
      memory.exports.mien_mixer_create(memory.handleOf(mix), scratch.struct("MixerDesc", desc), out, error)),
    "mien_mixer_destroy");
    this.#mix = mix;
  }

  get mix() {
    return this.#mix;
  }

  dispose() {
    super.dispose();
    this.#retire();
    this.#dropOld();
  }

  #retire() {
    for (const clips of [...this.#playing.values(), this.#restored]) this.#old.push(...clips);
    this.#playing.clear();
    this.#restored = [];
  }

  #dropOld() {
    for (const object of this.#old) object.drop();
    this.#old = [];
  }

  play(layer, clip, binding, { transitionTicks = TICKS_PER_SECOND / 4, ...desc } = {}) {
    const { memory } = this;
    memory.withScratch((scratch) => {
      const error = scratch.out("Error");
      const given = scratch.struct("PlayDesc", { transition: Transition.INERTIAL, transitionTicks, ...desc });
      memory.check(
        memory.exports.mien_mixer_play(this.handle, layer, memory.handleOf(clip), memory.handleOf(binding), given, error), error);
    });
    if (!this.#playing.has(layer)) this.#playing.set(layer, []);
    this.#playing.get(layer).push(clip.keep(), binding.keep());
  }

  stop(layer, fadeTicks = 0) {
    this.call("mien_mixer_stop", layer, BigInt(fadeTicks));
  }

  setWeight(layer, weight, fadeTicks = 0) {
    this.call("mien_mixer_set_weight", layer, weight, BigInt(fadeTicks));
  }

  setPoseWeight(layer, pose, weight, fadeTicks = 0) {
    this.call("mien_mixer_set_pose_weight", layer, pose, weight, BigInt(fadeTicks));
  }

  setVariable(variable, value) {
    const index = typeof variable === "string" ? this.#mix.variables.get(variable) : variable;
    if (index === undefined) throw errorOf(Status.NAME, `there is no pose variable "${variable}"`);
    this.call("mien_mixer_set_variable", index, value);
  }

  setGuard(guard, activation) {
    this.call("mien_mixer_set_guard", guard, activation);
  }

  guard(index) {
    return copied(this.struct("mien_mixer_guard", "GuardState", index));
  }

  trigger(reaction, strength = 1, holdTicks = 0) {
    this.call("mien_mixer_trigger", reaction, strength, BigInt(holdTicks));
  }

  release(reaction) {
    this.call("mien_mixer_release", reaction);
  }

  setLevel(reaction, level) {
    this.call("mien_mixer_set_level", reaction, level);
  }

  push(layer, tick, values) {
    const { memory } = this;
    return memory.withScratch((scratch) => {
      const accepted = scratch.take(4);
      this.call("mien_mixer_push", layer, BigInt(tick), scratch.array("f32", values), values.length, accepted);
      return memory.data.getUint32(accepted, true) !== 0;
    });
  }

  step(ticks, instance = null) {
    this.call("mien_mixer_step", BigInt(ticks), instance ? this.memory.handleOf(instance) : 0);
    this.#stepped();
  }

  static stepAll(mixers, ticks, instances = null) {
    if (!mixers.length) return;
    if (instances && instances.length !== mixers.length) {
      throw errorOf(Status.MISMATCH, `${instances.length} instances for ${mixers.length} mixers`);
    }
    const { memory } = mixers[0];
    memory.withScratch((scratch) => {
      memory.check(memory.exports.mien_mixer_step_batch(handlesOf(memory, scratch, mixers), instances ? handlesOf(memory, scratch, instances) : 0,
        mixers.length, BigInt(ticks)), 0, "mien_mixer_step_batch");
    });
    for (const mixer of mixers) mixer.#stepped();
  }

  #stepped() {
    this.#dropOld();
    for (const clips of this.#playing.values()) {
      if (clips.length > 4) for (const object of clips.splice(0, clips.length - 4)) object.drop();
    }
  }

  get events() {
    const { memory } = this;
    return memory.withScratch((scratch) => {
      const event = scratch.out("ClipEvent");
      const layer = scratch.take(4);
      return Array.from({ length: this.info.eventCount }, (_, i) => {
        this.call("mien_mixer_event", i, event, layer);
        return { ...memory.read("ClipEvent", event), layer: memory.data.getUint32(layer, true) };
      });
    });
  }

  get row() {
    return this.view("f32", "mien_mixer_row");
  }

  stage(index) {
    return this.view("f32", "mien_mixer_stage", index);
  }

  get info() {
    return this.struct("mien_mixer_info", "MixerInfo");
  }

  snapshot() {
    return this.bytes((buffer, capacity, size, error) =>
      this.memory.exports.mien_mixer_snapshot(this.handle, buffer, capacity, size, error));
  }

  restore(bytes, clips = []) {
    const { memory } = this;
    memory.withScratch((scratch) => {
      const error = scratch.out("Error");
      const given = scratch.structs("MixerClip",
        clips.map(({ clipId = 0, clip, binding }) => ({ clipId, clip, clipBinding: binding })));
      memory.check(memory.exports.mien_mixer_restore(this.handle, scratch.array("u8", bytes), bytes.length, given,
        clips.length, error), error);
    });
    const kept = clips.flatMap(({ clip, binding }) => [clip.keep(), binding.keep()]);
    this.#retire();
    this.#restored = kept;
  }
}

export class Gaze extends Handle {
  static create(memory, deformer, desc) {
    return new Gaze(memory, makeHandle(memory, (out, error, scratch) =>
      memory.exports.mien_gaze_create(memory.handleOf(deformer), scratch.struct("GazeDesc", desc), out, error)));
  }

  constructor(memory, handle) {
    super(memory, handle, "mien_gaze_destroy");
  }

  get info() {
    return this.struct("mien_gaze_info", "GazeInfo");
  }

  lookAt(target, instance) {
    const { memory } = this;
    return memory.withScratch((scratch) => {
      memory.handleOf(instance); // of this module
      const row = instance.rawControls;
      const rest = scratch.out("GazeRest");
      this.call("mien_gaze_look_at", scratch.struct("GazeTarget", target), row.byteOffset, row.length, rest);
      return memory.read("GazeRest", rest);
    });
  }
}

/** Pairs of raw controls that the two halves of one GUI control drive. */
export function findAntagonists(memory, rig) {
  return memory.withScratch((scratch) => {
    const find = (pairs, capacity) => {
      const out = scratch.take(4);
      memory.check(memory.exports.mien_mix_antagonists(memory.handleOf(rig), pairs, capacity, out), 0, "mien_mix_antagonists");
      return memory.data.getUint32(out, true);
    };
    const { size } = layouts.MixAntagonists;
    const count = find(0, 0);
    const pairs = scratch.take(Math.max(1, count) * size);
    find(pairs, count);
    return Array.from({ length: count }, (_, i) => memory.read("MixAntagonists", pairs + i * size));
  });
}

/** The counterpart of each curve in the other half of the face. */
export function findMirror(memory, deformer, curveCount) {
  return memory.withScratch((scratch) => {
    const error = scratch.out("Error");
    const out = scratch.take(Math.max(1, checkNumber(curveCount, "u16", "curveCount")) * 2);
    memory.check(memory.exports.mien_mix_mirror(memory.handleOf(deformer), out, curveCount, error), error);
    return memory.array("u16", out, curveCount).slice();
  });
}

/** The share of some joint groups in what each raw control moves. */
export function findMask(memory, rig, groups, { otherwise = 0, curveCount = rig.count(Kind.RAW_CONTROL) } = {}) {
  return memory.withScratch((scratch) => {
    const error = scratch.out("Error");
    const out = scratch.take(Math.max(1, checkNumber(curveCount, "u16", "curveCount")) * 4);
    memory.check(memory.exports.mien_mix_mask(memory.handleOf(rig), scratch.array("u32", groups), groups.length, otherwise, out,
      curveCount, error), error);
    return memory.array("f32", out, curveCount).slice();
  });
}
