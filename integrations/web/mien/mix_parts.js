// SPDX-License-Identifier: MIT
// What mixes are made of: layers, poses, reactions and guards as objects, and how they become structs.
import { BlendMode, Generator, Kind, LayerGroup, LayerSource, NO_CONTROL, NO_MESH, Status, TICKS_PER_SECOND } from "./api.js";
import { errorOf } from "./errors.js";

/** Seconds in the unit of all times. */
export function ticks(seconds) {
  return Math.round(seconds * TICKS_PER_SECOND);
}

/** Makes layers of mixes, with the group and mode that each usually has. */
export const MixLayer = Object.freeze({
  /** Plays clips: mixer.play(). */
  clip: (options = {}) => ({
    group: LayerGroup.BASE, mode: BlendMode.OVERRIDE, ...options, source: LayerSource.CLIP,
  }),
  /** A weighted sum of poses: mixer.setPoseWeight(). */
  poses: (poses, options = {}) => ({
    group: LayerGroup.EMOTION, mode: BlendMode.SCREEN, ...options, source: LayerSource.POSES, poses,
  }),
  /** Rows that arrive from outside: mixer.push(). */
  stream: (curves, options = {}) => ({
    group: LayerGroup.BASE, mode: BlendMode.OVERRIDE, ...options, source: LayerSource.STREAM, curves,
  }),
  /** Blinks, breath or noise for curves, scaled by amounts. */
  generator: (generator, amounts, options = {}) => ({
    group: LayerGroup.LIFE, mode: BlendMode.ADD, ...options, source: LayerSource.GENERATOR, generator,
    curves: Object.keys(amounts), amounts: Object.values(amounts),
  }),
  /** Turns the eyes to a place, by the gaze of the mix. */
  gaze: (target, { head = {}, jitter = [0, 0], ...options } = {}) => ({
    group: LayerGroup.LIFE, period: TICKS_PER_SECOND / 4, ...options, mode: BlendMode.OVERRIDE,
    source: LayerSource.GENERATOR, generator: Generator.GAZE, curves: [...target, ...Object.keys(head)],
    amounts: [...jitter, 0, ...Object.values(head)],
  }),
});

/** The curves of a mix by name: raw controls of the rig, then pose variables. */
export class Curves {
  #rig;
  #variables;

  constructor(rig, variables) {
    this.#rig = rig;
    const rawCount = rig.count(Kind.RAW_CONTROL);
    this.#variables = new Map(variables.map((name, i) => [name, rawCount + i]));
    this.count = rawCount + variables.length;
  }

  /** The number of a curve, which may be given by name. */
  index(curve) {
    if (typeof curve === "string") {
      const index = this.#variables.get(curve) ?? this.#rig.find(Kind.RAW_CONTROL, curve);
      if (index === undefined) throw errorOf(Status.NAME, `there is no raw control or pose variable "${curve}"`);
      return index;
    }
    if (!Number.isInteger(curve) || curve < 0 || curve >= this.count) {
      throw errorOf(Status.INDEX, `curve ${curve} of ${this.count}`);
    }
    return curve;
  }

  /** A weight for each curve: of a list of names, of an object by names, or as it is. */
  mask(mask) {
    if (mask === undefined || mask === null) return undefined;
    if (isNumbers(mask)) return mask;
    const entries = Array.isArray(mask) ? mask.map((name) => [name, 1]) : Object.entries(mask);
    const weights = new Float32Array(this.count);
    for (const [name, weight] of entries) weights[this.index(name)] = weight;
    return weights;
  }

  /** A value for each curve: of one number, or of as many as there are curves. */
  each(values, what) {
    if (values === undefined || values === null) return undefined;
    if (typeof values === "number") return new Float32Array(this.count).fill(values);
    return this.full(values, what);
  }

  full(values, what) {
    if (values.length !== this.count) {
      throw errorOf(Status.MISMATCH, `${what} takes one value for each of ${this.count} curves, not ${values.length}`);
    }
    return values;
  }
}

function isNumbers(values) {
  return ArrayBuffer.isView(values) || (Array.isArray(values) && values.every((value) => typeof value === "number"));
}

/** Turns a description by names into the fields of a struct MixDesc. */
export class Parts {
  poses = [];

  constructor(curves) {
    this.curves = curves;
  }

  #pose(pose) {
    const names = Object.keys(pose);
    this.poses.push({ curves: names.map((name) => this.curves.index(name)), values: Object.values(pose) });
    return this.poses.length - 1;
  }

  layer({ poses = [], curves, mask, weight = 1, ...rest }) {
    const firstPose = this.poses.length;
    for (const pose of poses) this.#pose(pose);
    // The library takes as many amounts as curves, and says so of other sources.
    if (rest.amounts && rest.amounts.length < (curves?.length ?? 0)) {
      throw new RangeError(`${rest.amounts.length} amounts for ${curves.length} curves`);
    }
    return {
      ...rest, weight, firstPose, poseCount: poses.length, mask: this.curves.mask(mask),
      curves: curves?.map((curve) => this.curves.index(curve)),
    };
  }

  reaction({ strokes, adapted = 1, ...rest }) {
    return { ...rest, adapted, strokes: strokes.map(({ pose, ...stroke }) => ({ ...stroke, pose: this.#pose(pose) })) };
  }

  guard({ upper, lower, closedBy, tolerance = 0.3, fOn = 12, ...rest }) {
    const landmark = ({ points, mesh }) => ({ points, mesh: mesh ?? NO_MESH });
    return {
      ...rest, tolerance, fOn, upper: landmark(upper), lower: landmark(lower),
      closedBy: closedBy === undefined || closedBy === null ? NO_CONTROL : this.curves.index(closedBy),
    };
  }

  antagonists({ first, second, stiffness = 1 }) {
    return { first: this.curves.index(first), second: this.curves.index(second), stiffness };
  }
}
