// SPDX-License-Identifier: MIT
// Solvers: what moves joints after the rig has posed them.
import { NO_JOINT, Status } from "./api.js";
import { errorOf } from "./errors.js";
import { Handle, handlesOf, makeHandle } from "./handle.js";

const KINDS = ["aim", "space", "spring", "twist", "copy", "custom"];

/** The fields of a struct Solver. Functions of custom solvers are added to `functions`. */
function describe(memory, solver, curveCount, functions) {
  const kinds = KINDS.filter((kind) => solver[kind]);
  if (kinds.length !== 1) throw new TypeError(`a solver has one of ${KINDS.join(", ")}`);
  const [kind] = kinds;
  const given = solver[kind];
  if (kind === "aim") return { ...solver, aim: { weight: 1, ...given, targetJoint: given.targetJoint ?? NO_JOINT } };
  if (kind === "space") {
    return { ...solver, space: { ...given, spaces: given.spaces.map((joint) => joint ?? NO_JOINT) } };
  }
  if (kind === "copy") return { ...solver, copy: { weight: 1, ...given } };
  if (kind === "twist" && given.shares.length !== given.joints.length) {
    throw new RangeError(`${given.shares.length} shares for ${given.joints.length} joints`);
  }
  if (kind !== "custom") return solver;
  const { solve, stateFloats = 0, ...rest } = given;
  if (typeof solve !== "function") throw new TypeError("a custom solver needs a function solve(poses, ticks)");
  const user = memory.addFunction((call) => solve(
    call.poses.map((pose) => poseOf(memory, pose, call.jointCount, { curveCount, stateFloats, ...rest })), call.ticks));
  functions.push(user);
  return { ...solver, custom: { ...rest, user, solve: memory.exports.mien_web_solver(), stateBytes: 4 * stateFloats } };
}

/** What a custom solver sees of a character: arrays over the memory of the module. */
function poseOf(memory, pose, jointCount, { curveCount, stateFloats, outputCount = 0, previousJoints = [] }) {
  const floats = (address, count) => memory.array("f32", address, address ? count : 0);
  return {
    locals: floats(pose.locals, 10 * jointCount), models: floats(pose.models, 16 * jointCount),
    previous: floats(pose.previous, 16 * previousJoints.length), row: floats(pose.row, curveCount),
    outputs: floats(pose.outputs, outputCount), state: floats(pose.state, stateFloats), lod: pose.lod,
    isReset: pose.isReset,
  };
}

export class SolverStack extends Handle {
  #info;

  static create(memory, deformer, solvers, { curveCount = 0, ...desc } = {}) {
    const functions = [];
    try {
      const given = solvers.map((solver) => describe(memory, solver, curveCount, functions));
      const handle = makeHandle(memory, (out, error, scratch) => memory.exports.mien_solver_stack_create(
        memory.handleOf(deformer), scratch.struct("SolverStackDesc", { ...desc, curveCount, solvers: given }), out, error));
      return new SolverStack(memory, handle, functions);
    } catch (error) {
      for (const user of functions) memory.removeFunction(user);
      throw error;
    }
  }

  constructor(memory, handle, functions) {
    super(memory, handle, "mien_solver_stack_destroy", () => {
      for (const user of functions) memory.removeFunction(user);
    });
  }

  get info() {
    return (this.#info ??= this.struct("mien_solver_stack_info", "SolverStackInfo"));
  }

  /** A character. */
  state() {
    return new SolverState(this.memory, this);
  }
}

export class SolverState extends Handle {
  constructor(memory, stack) {
    super(memory, makeHandle(memory, (out, error, scratch) =>
      memory.exports.mien_solver_state_create(memory.handleOf(stack), scratch.struct("SolverStateDesc"), out, error)),
    "mien_solver_state_destroy", () => stack.drop());
    stack.keep();
  }

  step(pose, ticks, input = {}) {
    const { memory } = this;
    memory.withScratch((scratch) => {
      const given = [this.handle, memory.handleOf(pose), scratch.struct("SolverInput", input), BigInt(ticks)];
      memory.withFunctions([this, pose], () =>
        memory.check(memory.exports.mien_solver_state_step(...given), 0, "mien_solver_state_step"));
    });
  }

  static stepAll(states, poses, ticks, inputs = null) {
    if (!states.length) return;
    if (poses.length !== states.length || (inputs && inputs.length !== states.length)) {
      throw errorOf(Status.MISMATCH, `${states.length} states need as many poses and inputs`);
    }
    const { memory } = states[0];
    memory.withScratch((scratch) => {
      const given = [handlesOf(memory, scratch, states), handlesOf(memory, scratch, poses),
        inputs ? scratch.structs("SolverInput", inputs) : 0, states.length, BigInt(ticks)];
      memory.withFunctions([...states, ...poses], () =>
        memory.check(memory.exports.mien_solver_state_step_batch(...given), 0, "mien_solver_state_step_batch"));
    });
  }

  outputs(solver) {
    return this.view("f32", "mien_solver_state_outputs", solver);
  }

  get transforms() {
    return this.view("f32", "mien_solver_state_transforms");
  }

  get undeclared() {
    const { memory } = this;
    return memory.withScratch((scratch) => {
      const out = scratch.take(8);
      this.call("mien_solver_state_undeclared", out);
      return memory.text(memory.data.getUint32(out, true), memory.data.getUint32(out + 4, true));
    });
  }
}
