// SPDX-License-Identifier: MIT
// Fits: the controls of a rig for captured joints, points, images or surfaces.
import { Kind, Status } from "./api.js";
import { checkNumber } from "./checks.js";
import { errorOf } from "./errors.js";
import { Handle, makeHandle } from "./handle.js";

const wrong = (message) => errorOf(Status.INVALID_ARGUMENT, message);

/** Numbers, or null for none; of another count than `count` they are refused. */
function counted(values, count, what) {
  if (values === undefined || values === null) return null;
  if (!ArrayBuffer.isView(values) && !Array.isArray(values)) throw new TypeError(`${what} is no array of numbers`);
  if (values.length !== count) throw wrong(`${what} has ${values.length} numbers, not ${count}`);
  return values;
}

/** The index of a raw control that is given by its name or index. */
function controlOf(rig, control) {
  if (typeof control !== "string") return control;
  const index = rig.find(Kind.RAW_CONTROL, control);
  if (index === undefined) throw errorOf(Status.NAME, `the rig has no raw control "${control}"`);
  return index;
}

/** A bound of each control that may move, of one number for all or a list. */
function boundsOf(bound, count, what) {
  return typeof bound === "number" ? new Float32Array(count).fill(bound) : counted(bound, count, what);
}

/** Fields of the struct FitDesc: which controls may move, ascending, and their bounds. */
function movingOf(rig, { controls, lower, upper }) {
  const count = controls ? controls.length : rig.count(Kind.RAW_CONTROL);
  const bounds = [boundsOf(lower, count, "lower"), boundsOf(upper, count, "upper")];
  if (!controls) return { lower: bounds[0], upper: bounds[1] };
  const indices = Array.from(controls, (control) => controlOf(rig, control));
  const order = indices.map((_, i) => i).sort((a, b) => indices[a] - indices[b]);
  const sorted = (values) => values && order.map((i) => values[i]);
  return { controls: sorted(indices), lower: sorted(bounds[0]), upper: sorted(bounds[1]) };
}

function pointOf(point, mesh) {
  if (typeof point === "number") return { mesh, positions: [point, point, point], weights: [1, 0, 0] };
  const { positions, weights } = point;
  if (!positions || !weights) throw new TypeError("a point is a position, or three of them with their weights");
  return { mesh: point.mesh ?? mesh, positions, weights };
}

function constraintOf(constraint) {
  if (typeof constraint !== "object" || constraint === null) throw new TypeError("a constraint is an object");
  return { weight: 1, ...constraint };
}

/** A scan, or a mesh of another topology. */
export class FitSurface extends Handle {
  static create(memory, positions, triangles) {
    for (const [values, what] of [[positions, "positions"], [triangles, "triangles"]]) {
      if (!ArrayBuffer.isView(values) && !Array.isArray(values)) throw new TypeError(`${what} is no array of numbers`);
      if (values.length % 3) throw wrong(`${what} has ${values.length} numbers, which is no multiple of 3`);
    }
    const given = { positions, triangles, positionCount: positions.length / 3, triangleCount: triangles.length / 3 };
    return new FitSurface(memory, makeHandle(memory, (out, error, scratch) =>
      memory.exports.mien_fit_surface_create(scratch.struct("FitSurfaceDesc", given), out, error)));
  }

  constructor(memory, handle) {
    super(memory, handle, "mien_fit_surface_destroy");
  }
}

export class Fit extends Handle {
  #rawCount;
  #jointCount;
  #pointCount;

  static create(memory, rig, { deformer, points = [], mesh = 0, symmetric = [], jointWeights, controls, lower, upper, ...rest } = {}) {
    if (!ArrayBuffer.isView(points) && !Array.isArray(points)) throw new TypeError("points is no array");
    const given = {
      ...rest, ...movingOf(rig, { controls, lower, upper }), points: Array.from(points, (point) => pointOf(point, mesh)),
      deformer: deformer ?? (points.length ? rig.deformer : null),
      symmetric: symmetric.flatMap((pair) => Array.from(pair, (control) => controlOf(rig, control))),
      jointWeights: counted(jointWeights, rig.info.jointValueCount, "jointWeights"),
    };
    const handle = makeHandle(memory, (out, error, scratch) =>
      memory.exports.mien_fit_create(memory.handleOf(rig), scratch.struct("FitDesc", given), out, error));
    return new Fit(memory, handle, rig, given.points.length);
  }

  constructor(memory, handle, rig, pointCount) {
    super(memory, handle, "mien_fit_destroy", () => rig.drop());
    rig.keep();
    this.#rawCount = rig.count(Kind.RAW_CONTROL);
    this.#jointCount = rig.info.jointValueCount;
    this.#pointCount = pointCount;
  }

  solve(frame) {
    return this.#run(frame, 1, "mien_fit_solve")[0];
  }

  /** Frames of a motion: targets have a row for each. */
  solveFrames(frame, count) {
    checkNumber(count, "u32", "count");
    return this.#run(frame, count, "mien_fit_solve_frames", count);
  }

  /** Calls a function with a frame, `numbers`, and room for `count` rows of controls and results. */
  #run({ joints, points, images, pointWeights, surfaceWeights, pointOffsets, start, prior, stages, constraints, canceled, ...rest },
    count, name, ...numbers) {
    const { memory } = this;
    if (canceled !== undefined && typeof canceled !== "function") throw new TypeError("canceled is no function");
    const given = {
      ...rest,
      joints: counted(joints, count * this.#jointCount, "joints"),
      points: counted(points, count * 3 * this.#pointCount, "points"),
      images: counted(images, count * 2 * this.#pointCount, "images"),
      pointWeights: counted(pointWeights, count * this.#pointCount, "pointWeights"),
      surfaceWeights: counted(surfaceWeights, count * this.#pointCount, "surfaceWeights"),
      pointOffsets: counted(pointOffsets, 3 * this.#pointCount, "pointOffsets"),
      start: counted(start, this.#rawCount, "start"), prior: counted(prior, this.#rawCount, "prior"),
      stages: counted(stages, this.#rawCount, "stages"),
      constraints: constraints && Array.from(constraints, constraintOf),
    };
    const user = canceled ? memory.addFunction(canceled) : 0;
    try {
      return memory.withScratch((scratch) => {
        const call = canceled ? { user, canceled: memory.exports.mien_web_canceled_function() } : {};
        const frame = scratch.struct("FitFrame", { ...given, ...call });
        const controls = scratch.take(Math.max(1, count * this.#rawCount) * 4);
        const results = scratch.outs("FitResult", count);
        const { handle } = this;
        memory.withFunctions(rest.surface ? [this, rest.surface] : [this], () =>
          memory.check(memory.exports[name](handle, frame, ...numbers, controls, results[0] ?? 0), 0, name));
        const rows = memory.array("f32", controls, count * this.#rawCount).slice();
        return results.map((result, i) => (
          { ...memory.read("FitResult", result), controls: rows.subarray(i * this.#rawCount, (i + 1) * this.#rawCount) }));
      });
    } finally {
      if (user) memory.removeFunction(user);
    }
  }

  get observability() {
    const { memory } = this;
    return memory.withScratch((scratch) => {
      const out = scratch.take(4 * this.#rawCount);
      this.call("mien_fit_observability", out, this.#rawCount);
      return memory.array("f32", out, this.#rawCount).slice();
    });
  }
}

export function reduceKeys(memory, values, tolerance) {
  return memory.withScratch((scratch) => {
    const keys = scratch.take(Math.max(1, values.length) * 4);
    const count = scratch.take(4);
    const status = memory.exports.mien_fit_keys(scratch.array("f32", values), values.length, tolerance, keys, count);
    memory.check(status, 0, "mien_fit_keys");
    return memory.array("u32", keys, memory.data.getUint32(count, true)).slice();
  });
}
