// SPDX-License-Identifier: MIT
// Wrong numbers, sizes, lists, objects and functions: a TypeError, a RangeError or an error with a status, and the
// module stays as it was.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { api, Mien, sameBits } from "./support.mjs";

const { Kind, Preset, Stage, Status, TICKS_PER_SECOND } = api;
let mien, other, rig, foreign, face, pose, wanted;

const isError = (error) => error instanceof TypeError || error instanceof RangeError;
const refused = (call, kind = isError) => assert.throws(call, kind);
const isAny = (error) => isError(error) || error.status > 0;

function frame() {
  face.rawControls.fill(0.5);
  face.evaluate();
  pose.update(face);
  pose.deform(0);
  return pose.positions(0).slice();
}

before(async () => {
  [mien, other] = await Promise.all([Mien.load(), Mien.load()]);
  [rig, foreign] = [mien, other].map((module) => {
    const dna = module.generate(Preset.SMALL);
    const made = module.createRig(dna);
    dna.dispose();
    return made;
  });
  face = rig.instance();
  pose = rig.deformer.instance();
  wanted = frame();
});

// Whatever was refused has changed nothing.
after(() => assert.ok(sameBits(frame(), wanted)));

const NO_NUMBERS = [NaN, Infinity, -Infinity, 0.5, -1, 2 ** 32, 2 ** 53, 1e300, "0", null, undefined, {}, [], 1n, true];

test("numbers of 32 bits are numbers", () => {
  for (const wrong of NO_NUMBERS) {
    // An optional argument that is undefined is its default.
    if (wrong !== undefined) refused(() => face.evaluate(wrong));
    if (wrong !== undefined) refused(() => face.evaluate(0, wrong));
    refused(() => rig.count(wrong));
    refused(() => rig.name(Kind.JOINT, wrong));
    refused(() => rig.lodIndices(Kind.JOINT, wrong));
    refused(() => rig.statistics(wrong));
    refused(() => rig.deformer.mesh(wrong));
    refused(() => rig.deformer.influences(0, wrong));
    refused(() => rig.deformer.target(0, wrong));
    if (wrong !== "0") refused(() => pose.positions(wrong)); // else one that is kept
    refused(() => pose.deform(wrong));
    refused(() => rig.deformer.mirror(wrong));
  }
  face.evaluate(0, Stage.ALL);
});

test("fields of structs take what fits", () => {
  for (const wrong of NO_NUMBERS.filter((value) => value !== undefined && value !== null)) {
    refused(() => mien.generate(wrong));
    refused(() => rig.batch({ capacity: wrong }), isAny);
    if (wrong !== 1n) refused(() => mien.generate(Preset.TINY, { seed: wrong === true ? "x" : wrong === 2 ** 32 ||
      wrong === 2 ** 53 ? 2 ** 64 : wrong }));
  }
  const spring = { joint: 0, frequency: 1, damping: 1 };
  for (const wrong of ["1", {}, [], 1n, true]) {
    refused(() => rig.deformer.solvers([{ spring: { ...spring, frequency: wrong } }]), TypeError);
  }
  for (const axis of [[1, 0], [1, 0, 0, 0], [], new Float32Array(1000), [1, 0, "0"], [1, 0, null]]) {
    refused(() => rig.deformer.solvers([{ aim: { joint: 0, axis, targetJoint: 1 } }]));
  }
});

test("numbers of 64 bits do not wrap", () => {
  const clip = mien.buildClip({ rateNumerator: 60, rateDenominator: 1, names: ["a"], values: [0, 1] });
  const player = clip.player();
  for (const wrong of [NaN, Infinity, 0.5, 2 ** 63, -(2 ** 64), 1e300, 2n ** 63n, 2n ** 64n]) {
    refused(() => player.seek(wrong), RangeError);
    refused(() => player.advance(wrong), RangeError);
  }
  player.seek(0);
  assert.deepEqual([...player.sample()], [0]);
  for (const object of [player, clip]) object.dispose();
});

test("vertices go to arrays that have room for them", () => {
  const count = rig.deformer.mesh(0).vertexCount;
  assert.equal(rig.deformer.vertexCounts[0], count);
  const room = new Float32Array(3 * count);
  pose.writeVertices(0, room, room.slice());
  const before = mien.memoryBytes;
  for (const small of [0, 1, 3 * count - 1]) {
    refused(() => pose.writeVertices(0, new Float32Array(small)), RangeError);
    refused(() => pose.writeVertices(0, room, new Float32Array(small)), RangeError);
  }
  for (const wrong of [null, undefined, [], count, new Float64Array(3 * count), new Uint8Array(12 * count), { length: 1e9 }]) {
    refused(() => pose.writeVertices(0, wrong), TypeError);
  }
  // As it was called once: a product of these counts wrapped.
  for (const large of [2 ** 31, 2 ** 32 / 24 + 1, 2 ** 53]) refused(() => pose.writeVertices(0, large, room), TypeError);
  for (const mesh of [-1, 1e6, NaN, 0.5, undefined]) {
    refused(() => pose.writeVertices(mesh, room), (error) => error.status === Status.INDEX);
  }
  assert.equal(mien.memoryBytes, before);
  const larger = new Float32Array(3 * count + 5).fill(7);
  pose.writeVertices(0, larger);
  assert.ok(sameBits(larger.subarray(0, 3 * count), room));
  assert.deepEqual([...larger.subarray(3 * count)], [7, 7, 7, 7, 7]);
});

test("sizes that no memory has are refused before anything is allocated", () => {
  const clip = mien.buildClip({ rateNumerator: 60, rateDenominator: 1, names: ["a", "b"], values: [0, 1, 2, 3] });
  const before = mien.memoryBytes;
  for (const frames of [2 ** 29, 2 ** 30, 2 ** 31, 2 ** 32 - 1]) {
    refused(() => clip.read(0, frames), isAny);
    refused(() => rig.deformer.mirror(frames), isAny);
    refused(() => rig.groupMask([0], { curveCount: frames }), isAny);
    refused(() => rig.batch({ capacity: frames, tasks: 2 ** 31 }), isAny);
  }
  for (const frames of [NaN, 0.5, 2 ** 53, 1e300, Infinity, "2"]) refused(() => clip.read(0, frames));
  for (const first of [NaN, 0.5, -1, 2 ** 32]) refused(() => clip.read(first, 1));
  assert.ok(mien.memoryBytes <= 2 * before, `${mien.memoryBytes} bytes, ${before} before`);
  assert.deepEqual([...clip.read()], [0, 1, 2, 3]);
  clip.dispose();
});

test("lists are as long as they are counted", () => {
  const desc = { rateNumerator: 60, rateDenominator: 1, names: ["a", "b"], values: [0, 1, 2, 3] };
  for (const wrong of [
    { channelCount: 3 }, { frameCount: 3 }, { frameCount: 1e9 }, { frameCount: -1 }, { channelCount: 2 ** 31 },
    { frameStride: 2 ** 31, frameCount: 2 }, { snaps: [1] }, { frameCount: 2 ** 32 + 2 },
    { names: ["a", 5] }, { names: "ab" , values: [1, 2, 3, {}] }, { values: [0, 1, 2, "x"] }, { eventCount: 1 },
  ]) assert.throws(() => mien.buildClip({ ...desc, ...wrong }), isAny, Object.keys(wrong).join());
  const jaw = rig.name(Kind.RAW_CONTROL, 0);
  const layer = { group: 0, mode: 0, source: api.LayerSource.GENERATOR, generator: api.Generator.NOISE, period: TICKS_PER_SECOND };
  refused(() => rig.mix({ layers: [{ ...layer, curves: [jaw], amounts: [] }] }), RangeError);
  refused(() => rig.mix({ layers: [{ ...layer, curves: [jaw], amounts: [1], curveCount: 1000 }] }), RangeError);
  refused(() => rig.mix({ layers: [{ ...layer, curves: [jaw], amounts: [1], mask: [1, 1], maskCount: 1e6 }] }));
  // Lists whose length changes while they are read.
  let reads = 0;
  const growing = new Proxy([1, 2], { get: (list, key) => (key === "length" ? 2 + 100000 * reads++ : list[key]) });
  refused(() => pose.updateFromValues(growing, []));
  assert.ok(reads > 0);
});

test("integers of lists fit their type", () => {
  for (const wrong of [-1, 65536, 1.5, NaN, "1", null]) {
    refused(() => rig.deformer.solvers([{ space: { joint: 0, spaces: [0, wrong ?? "none"], curve: 0 } }]));
    refused(() => rig.groupMask([wrong === 65536 ? 2 ** 32 : wrong]));
  }
});

test("objects of another module, of another kind and none at all", () => {
  const theirs = foreign.instance();
  const theirPose = foreign.deformer.instance();
  const batch = rig.batch();
  const state = rig.deformer.solvers([{ spring: { joint: 0, frequency: 1, damping: 1 } }]).state();
  const mixer = rig.mix().mixer();
  const clip = mien.buildClip({ rateNumerator: 60, rateDenominator: 1, names: [rig.name(Kind.RAW_CONTROL, 0)], values: [0, 1] });
  const binding = clip.bind(rig);
  const gaze = (() => { try { return rig.deformer.gaze(); } catch { return null; } })(); // if it has eyes
  for (const wrong of [theirs, {}, { handle: "1" }, { handle: 65536 }, 5, "face", undefined]) {
    refused(() => pose.update(wrong), TypeError);
    refused(() => batch.evaluate([wrong]), TypeError);
    refused(() => binding.apply([0], wrong), TypeError);
    if (gaze) refused(() => gaze.lookAt({ position: [0, 0, 0] }, wrong), TypeError);
    if (wrong !== undefined) refused(() => mixer.step(0, wrong), TypeError);
  }
  refused(() => state.step(theirPose, 1), TypeError);
  refused(() => api.SolverState.stepAll([state], [theirPose], 1), TypeError);
  refused(() => foreign.mix({ deformer: rig.deformer }), TypeError);
  refused(() => clip.bind(foreign), TypeError);
  refused(() => rig.createDeformer(foreign), TypeError);
  refused(() => mixer.play(0, clip, theirs), isError);
  // One of this module, but of another kind, is told by the library.
  refused(() => pose.update(rig), (error) => error.status === Status.HANDLE);
  for (const object of [theirs, theirPose, batch, state, mixer, binding, clip, gaze]) object?.dispose();
});

function solved(solve) {
  const stack = rig.deformer.solvers([{ custom: { writes: [0], solve, outputCount: 1, stateFloats: 2 } }]);
  const state = stack.state();
  stack.dispose();
  return state;
}

test("a custom solver can neither use nor dispose of what is stepped", () => {
  for (const misuse of [
    (state) => state.dispose(), (state, body) => body.dispose(), (state, body) => state.step(body, 1),
    (state, body) => body.update(face), (state, body) => body.writeVertices(0, new Float32Array(1e6)),
    (state) => state.outputs(0), (state) => state.transforms,
  ]) {
    const body = rig.deformer.instance();
    body.update(face);
    const state = solved(() => misuse(state, body));
    refused(() => state.step(body, 1), TypeError);
    refused(() => api.SolverState.stepAll([state], [body], 1), TypeError);
    assert.ok(!state.isDisposed && !body.isDisposed);
    body.update(face); // free again
    assert.equal(state.outputs(0).length, 1);
    for (const object of [state, body]) object.dispose();
  }
});

test("a custom solver may step another character, and dispose of the stack", () => {
  const bodies = [rig.deformer.instance(), rig.deformer.instance()];
  for (const body of bodies) body.update(face);
  let calls = 0;
  const inner = solved(() => { ++calls; });
  const outer = solved(() => inner.step(bodies[1], 1));
  outer.step(bodies[0], 1);
  assert.equal(calls, 1);
  refused(() => api.SolverState.stepAll([outer, inner], bodies, 1), isAny);
  for (const object of [inner, outer, ...bodies]) object.dispose();
});

test("what a custom solver writes beyond its arrays, of another type, and later", () => {
  const body = rig.deformer.instance();
  body.update(face);
  const before = body.jointMatrices.slice();
  for (const [solve, kind] of [
    [([{ locals }]) => locals.set(new Float32Array(locals.length + 1)), RangeError],
    [([{ state }]) => state.set([1, 2, 3]), RangeError],
    [([{ outputs }]) => outputs.set([1], 1), RangeError],
    [([{ locals }]) => { locals[0] = 1n; }, TypeError],
    [([{ locals }]) => { locals[0] = Symbol.iterator; }, TypeError],
    [() => { throw undefined; }, undefined],
    [async () => {}, TypeError], [() => ({ then() {} }), TypeError],
  ]) {
    const state = solved(solve);
    let thrown = "nothing";
    try {
      state.step(body, 1);
    } catch (error) {
      thrown = error;
    }
    if (kind) assert.ok(thrown instanceof kind, String(thrown));
    else assert.equal(thrown, undefined);
    state.dispose();
  }
  const state = solved(([{ locals, state: own, outputs }]) => {
    locals[locals.length] = own[own.length] = outputs[outputs.length] = 1e30; // past the end is nowhere
  });
  state.step(body, 1);
  body.update(face);
  assert.ok(sameBits(body.jointMatrices, before));
  for (const object of [state, body]) object.dispose();
});

test("bytes of a class of their own do not overrun the reader", async () => {
  const dna = mien.generate(Preset.TINY);
  const bytes = dna.write();
  class Longer extends Uint8Array {
    subarray() {
      return new Uint8Array(2 ** 20).fill(255);
    }
    get length() {
      return 2 ** 40;
    }
  }
  const opened = await mien.openRig(new Longer(bytes));
  opened.dispose();
  const cut = new Uint8Array(bytes).subarray(0, 100);
  await assert.rejects(mien.openRig(cut), (error) => error.status > 0);
  for (const wrong of [5, null, {}, [1, 2]]) await assert.rejects(mien.openDna(wrong), TypeError);
  dna.dispose();
});

test("progress that is no function, throws, or is not done", () => {
  const positions = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1];
  const mesh = { positions, faces: [0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2] };
  refused(() => mien.authorRig(mesh, { progress: 5 }), isAny);
  for (const wrong of [[0, 1, 7], [0, 1, -1], [0, 1, 0.5], [0, 1, NaN], [0, 1]]) {
    refused(() => mien.authorRig({ positions, faces: wrong }), isAny);
  }
});
