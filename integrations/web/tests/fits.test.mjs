// SPDX-License-Identifier: MIT
// Fits: known controls come back from joints, points, images and surfaces; wrong arguments, functions that throw,
// objects that were disposed.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { api, Mien } from "./support.mjs";

const { ArgumentError, FitStatus, Kind, Normals, Preset, Status } = api;
let mien, rig, face, target, extent;

before(async () => {
  mien = await Mien.load();
  const dna = mien.generate(Preset.SMALL);
  rig = mien.createRig(dna);
  dna.dispose();
  face = rig.instance();
  face.rawControls.forEach((_, i, controls) => { controls[i] = i % 4 ? 0 : 0.4; });
  face.evaluate();
  const pose = rig.deformer.instance();
  pose.update(face);
  pose.deform(0, Normals.NONE);
  target = pose.positions(0).slice();
  pose.dispose();
  const xs = target.filter((_, i) => i % 3 === 0);
  extent = Math.max(...xs) - Math.min(...xs);
});

after(() => {
  face.dispose();
  rig.dispose();
});

const everyPoint = () => [...Array(target.length / 3).keys()];
const fails = (status, call) => assert.throws(call, (error) => error.status === status);

test("joints give their controls", () => {
  const fit = rig.fit();
  const { observability } = fit;
  const joints = face.joints.slice();
  const result = fit.solve({ joints, maxIterations: 200 });
  assert.ok(result.jointResidual < 0.01 && result.jointWorst >= result.jointResidual);
  const known = [...observability.keys()].filter((i) => observability[i] >= 0.05);
  assert.ok(known.length > observability.length / 2);
  for (const i of known) assert.ok(Math.abs(result.controls[i] - face.rawControls[i]) < 0.01, `control ${i}`);
  const start = new Float32Array(observability.length).fill(0.25);
  const nothing = fit.solve({ start });
  assert.equal(nothing.status, FitStatus.NO_DATA);
  assert.deepEqual(nothing.controls, start);
  fit.dispose();
});

test("points, images and surfaces", () => {
  const fit = rig.fit({ points: everyPoint() });
  const moved = target.map((value, i) => value + [1, 2, 0][i % 3]);
  moved[21] = NaN;
  const solved = fit.solve({ points: moved, rigid: true, maxIterations: 200 });
  assert.equal(solved.missingPoints, 1);
  assert.ok(solved.pointResidual < 0.02 * extent && solved.pointWorst < extent);

  const camera = {
    focal: [500, 500], center: [320, 240], rotation: [1, 0, 0, 0, 1, 0, 0, 0, 1], translation: [0, 0, 10 * extent],
  };
  const mesh = rig.deformer.mesh(0);
  const images = new Float32Array(everyPoint().flatMap((i) => {
    const [x, y, z] = mesh.positions.subarray(3 * i, 3 * i + 3);
    return [500 * x / (z + 10 * extent) + 320, 500 * y / (z + 10 * extent) + 240];
  }));
  const seen = fit.solve({ images, camera });
  assert.ok(seen.pointResidual < 0.5);
  assert.deepEqual([...seen.focal], [500, 500]);

  const triangles = rig.deformer.mesh(0).triangles.map((vertex) => rig.deformer.mesh(0).vertexPositionIndices[vertex]);
  const surface = mien.createFitSurface(target, triangles);
  const drawn = fit.solve({ surface, surfaceReach: extent, start: face.rawControls.slice() });
  assert.ok(drawn.pointResidual < 1e-3 * extent, `${drawn.pointResidual}`);
  for (const object of [surface, fit]) object.dispose();
});

test("controls are given by name in any order, each with its bounds", () => {
  const [first, second] = rig.names(Kind.RAW_CONTROL);
  const joints = face.joints.slice();
  const fit = rig.fit({ controls: [second, first], upper: [0.1, 0.2], symmetric: [[0, second]] });
  const { controls } = fit.solve({ joints });
  assert.ok(controls[0] <= Math.fround(0.2) && controls[0] > 0.1 && controls[1] <= Math.fround(0.1), `${controls[0]} ${controls[1]}`);
  assert.ok(controls.subarray(2).every((value) => value === 0));
  fit.dispose();
});

test("wrong arguments", () => {
  const count = rig.count(Kind.RAW_CONTROL);
  for (const [status, options] of [
    [Status.LOD, { lod: 99 }], [Status.INDEX, { controls: [count] }], [Status.NAME, { controls: ["nobody"] }],
    [Status.INVALID_ARGUMENT, { controls: [1, 1] }], [Status.INVALID_ARGUMENT, { lower: [0] }],
    [Status.INVALID_ARGUMENT, { lower: 2 }], [Status.INVALID_ARGUMENT, { jointWeights: [1] }],
    [Status.INDEX, { points: [1e9] }], [Status.INDEX, { points: [0], mesh: 99 }], [Status.INDEX, { symmetric: [[0, count]] }],
  ]) fails(status, () => rig.fit(options));
  for (const options of [{ points: [0.5] }, { points: [{}] }, { controls: [NaN] }, { lod: "0" }, { points: 7 }, { nothing: 1 }]) {
    assert.throws(() => rig.fit(options), (error) => error instanceof TypeError || error instanceof RangeError || error instanceof ArgumentError);
  }
  const fit = rig.fit({ points: [0, 1] });
  for (const frame of [
    { points: [1, 2, 3] }, { joints: [1] }, { images: [1, 2] }, { pointWeights: [1] }, { start: [] }, { prior: [1] },
    { points: [0, 0, 0, 0, 0, 0], sparseWeight: -1 }, { points: [0, 0, 0, 0, 0, 0], smoothWeight: NaN },
  ]) fails(Status.INVALID_ARGUMENT, () => fit.solve(frame));
  fails(Status.NULL_ARGUMENT, () => fit.solve({ images: [0, 0, 0, 0] }));
  for (const frame of [{ points: 5 }, { points: new Float32Array(6), canceled: 1 }, { pointz: [] }, { surface: {} }]) {
    assert.throws(() => fit.solve(frame), TypeError);
  }
  fit.dispose();
  fails(Status.HANDLE, () => fit.solve({ points: [0, 0, 0, 0, 0, 0] }));
  fails(Status.HANDLE, () => fit.observability);
  fails(Status.INDEX, () => mien.createFitSurface([0, 0, 0], [0, 0, 1]));
  fails(Status.INVALID_ARGUMENT, () => mien.createFitSurface([0, 0, 0], []));
  fails(Status.INVALID_ARGUMENT, () => mien.createFitSurface([0, 0], [0, 0, 0]));
  assert.throws(() => mien.createFitSurface(null, []), TypeError);
});

test("a solve can be stopped, by a function or by time", () => {
  const fit = rig.fit();
  const joints = face.joints.slice();
  let asked = 0;
  assert.equal(fit.solve({ joints, canceled: () => ++asked > 1 }).status, FitStatus.CANCELED);
  assert.equal(asked, 2);
  assert.throws(() => fit.solve({ joints, canceled() { throw new Error("stop"); } }), /stop/);
  assert.throws(() => fit.solve({ joints, canceled: async () => false }), TypeError);
  assert.throws(() => fit.solve({ joints, canceled: () => { fit.dispose(); } }), TypeError);
  assert.ok(!fit.isDisposed);
  assert.equal(fit.solve({ joints, maxSeconds: 1e-9 }).status, FitStatus.TIME);
  assert.equal(fit.solve({ joints, maxSeconds: 1000 }).status, FitStatus.CONVERGED);
  fit.dispose();
});

test("limits of time in the module with threads", async () => {
  const threaded = await Mien.load({ threads: 2 });
  const dna = threaded.generate(Preset.TINY);
  const own = threaded.createRig(dna);
  const fit = own.fit();
  const joints = new Float32Array(own.info.jointValueCount).fill(0.1);
  assert.equal(fit.solve({ joints, maxSeconds: 1e-9 }).status, FitStatus.TIME);
  assert.notEqual(fit.solve({ joints, maxSeconds: 1000 }).status, FitStatus.TIME);
  for (const object of [fit, own, dna]) object.dispose();
});

test("a fit outlives the rig", () => {
  const dna = mien.generate(Preset.TINY);
  const own = mien.createRig(dna);
  const character = own.instance();
  character.rawControls[0] = 0.5;
  character.evaluate();
  const joints = character.joints.slice();
  const fit = own.fit();
  for (const object of [dna, character, own]) object.dispose();
  assert.ok(Math.abs(fit.solve({ joints }).controls[0] - 0.5) < 0.01);
  fit.dispose();
});

test("keys of a curve", () => {
  assert.deepEqual([...mien.reduceKeys([0, 0.25, 0.5, 0.75, 1, 0.5, 0], 0.001)], [0, 4, 6]);
  assert.deepEqual([...mien.reduceKeys([], 0.1)], []);
  fails(Status.INVALID_ARGUMENT, () => mien.reduceKeys([1, 2], -1));
  assert.throws(() => mien.reduceKeys(["1"], 0.1), TypeError);
});

test("the module that opens baked files only says what it lacks", async () => {
  const small = await Mien.load({ bakedOnly: true });
  const opened = await small.openRig(rig.bake());
  for (const call of [() => opened.fit(), () => small.reduceKeys([1], 1), () => small.createFitSurface([], [])]) {
    fails(Status.UNSUPPORTED, call);
  }
  opened.dispose();
});
