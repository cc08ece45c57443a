// SPDX-License-Identifier: MIT
// Fits: known controls come back from joints, points, images and surfaces; wrong arguments, functions that throw,
// objects that were disposed.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { api, Mien } from "./support.mjs";

const { ArgumentError, FitConstraintKind, FitStatus, Kind, Normals, Preset, Status } = api;
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
  assert.equal(drawn.surfaceResidual, drawn.pointResidual);

  // Points at rest draw from it, as much as they weigh.
  const points = rig.deformer.mesh(0).positions, none = new Float32Array(points.length / 3);
  const mixed = fit.solve({ surface, points });
  const alone = fit.solve({ surface, points, surfaceWeights: none });
  assert.ok(mixed.surfaceResidual > 0 && mixed.pointResidual > alone.pointResidual);
  assert.equal(alone.surfaceResidual, 0);
  assert.throws(() => fit.solve({ surface, surfaceWeights: none.subarray(1) }), /surfaceWeights/);
  assert.throws(() => fit.solve({ points, pointOffsets: none }), /pointOffsets/);
  for (const object of [surface, fit]) object.dispose();
});

test("points on several meshes", () => {
  const point = (mesh, p) => ({ mesh, positions: [p, p, p], weights: [1, 0, 0] });
  const fit = rig.fit({ points: [point(1, 0), 1, point(1, 2)] });
  const places = [[1, 0], [0, 1], [1, 2]].flatMap(([mesh, p]) => [...rig.deformer.mesh(mesh).positions.subarray(3 * p, 3 * p + 3)]);
  assert.ok(fit.solve({ points: places }).pointWorst < 1e-4 * extent);
  fit.dispose();
  assert.throws(() => rig.fit({ points: [0, point(99, 0)] }));
});

test("constraints", () => {
  const fit = rig.fit({ points: [0, 1] });
  const pose = rig.deformer.instance();
  pose.update(face);
  const placeOf = (matrices, joint) => [...matrices.subarray(16 * joint + 12, 16 * joint + 15)];
  const rest = rig.deformer.bindMatrices.slice();
  const there = pose.jointMatrices.slice();
  const moved = (joint) => Math.hypot(...placeOf(rest, joint).map((value, k) => value - placeOf(there, joint)[k]));
  const joint = [...Array(rest.length / 16).keys()].reduce((a, b) => (moved(a) > moved(b) ? a : b));
  const { JOINT_POSITION, JOINT_DIRECTION, JOINT_AIM, POINT_POSITION, POINT_DISTANCE } = FitConstraintKind;
  const placed = fit.solve({ constraints: [{ kind: JOINT_POSITION, joint, target: placeOf(there, joint) }], maxIterations: 200 });
  assert.ok(placed.constraintWorst < 0.05 * moved(joint), `${placed.constraintWorst} of ${moved(joint)}`);
  // What the neutral pose has already.
  const direction = [...rest.subarray(16 * joint + 8, 16 * joint + 11)];
  const axis = [0, 0, 1];
  const kept = fit.solve({ constraints: [
    { kind: JOINT_DIRECTION, joint, axis, target: direction },
    { kind: JOINT_AIM, joint, axis, target: placeOf(rest, joint).map((value, k) => value + direction[k]) },
    { kind: POINT_POSITION, points: [0, 0], target: [...rig.deformer.mesh(0).positions.subarray(0, 3)] },
    { kind: POINT_DISTANCE, points: [0, 1], distances: [0, 1e6], weight: 2 },
  ] });
  assert.ok(kept.constraintWorst < 1e-3 && kept.controls.every((value) => Math.abs(value) < 0.01));
  const missing = [{ kind: JOINT_POSITION, joint, target: [NaN, 0, 0] }];
  assert.equal(fit.solve({ constraints: missing }).status, FitStatus.NO_DATA);

  const good = { kind: JOINT_POSITION, joint, target: [0, 0, 0] };
  for (const [status, constraint] of [
    [Status.INDEX, { ...good, joint: 1e6 }], [Status.INDEX, { kind: POINT_POSITION, points: [2, 0] }],
    [Status.INDEX, { kind: POINT_DISTANCE, points: [0, 2] }], [Status.INVALID_ARGUMENT, { ...good, kind: 77 }],
    [Status.INVALID_ARGUMENT, { ...good, weight: -1 }], [Status.INVALID_ARGUMENT, { ...good, weight: NaN }],
    [Status.INVALID_ARGUMENT, { kind: JOINT_AIM, joint, axis: [0, 0, 0] }],
    [Status.INVALID_ARGUMENT, { kind: POINT_DISTANCE, points: [0, 1], distances: [2, 1] }],
  ]) fails(status, () => fit.solve({ constraints: [constraint] }));
  fails(Status.INVALID_ARGUMENT, () => fit.solve({ constraints: Array(65).fill(good) }));
  for (const wrong of [null, 5, { joints: 1 }, { target: [1] }, { joint: -1 }, { joint: "jaw" }, { points: [0, 0.5] }]) {
    assert.throws(() => fit.solve({ constraints: [wrong] }), (error) => error instanceof TypeError || error instanceof RangeError);
  }
  assert.throws(() => fit.solve({ constraints: [good], constraintCount: 2 }), RangeError);
  const bare = rig.fit();
  fails(Status.NULL_ARGUMENT, () => bare.solve({ constraints: [good] }));
  for (const object of [pose, fit, bare]) object.dispose();
});

test("stages", () => {
  const fit = rig.fit();
  const joints = face.joints.slice();
  const stages = Array.from(face.rawControls, (_, i) => i % 4);
  // The limit is that of each stage.
  assert.equal(fit.solve({ joints, maxIterations: 1 }).iterations, 1);
  assert.ok(fit.solve({ joints, maxIterations: 1, stages }).iterations > 1);
  // All that moved is in the first one, so the others have nothing to explain.
  const { controls } = fit.solve({ joints, stages: new Uint32Array(stages) });
  assert.ok(controls[0] > 0.3 && controls.every((value, i) => i % 4 === 0 || value < 0.01));
  for (const wrong of [[], [0], stages.map(() => 16)]) fails(Status.INVALID_ARGUMENT, () => fit.solve({ joints, stages: wrong }));
  assert.throws(() => fit.solve({ joints, stages: stages.map(() => 0.5) }), RangeError);
  assert.throws(() => fit.solve({ joints, stages: 1 }), TypeError);
  fit.dispose();
});

test("frames of a motion", () => {
  const count = 6;
  const own = rig.instance();
  const rows = Array.from({ length: count }, (_, f) => {
    own.rawControls.forEach((_, i, controls) => { controls[i] = i % 4 ? 0 : 0.4 * f / count; });
    own.evaluate();
    return { joints: own.joints.slice(), controls: own.rawControls.slice() };
  });
  const joints = new Float32Array(rows.flatMap((row) => [...row.joints]));
  const fit = rig.fit();
  const { observability } = fit;
  const results = fit.solveFrames({ joints, maxIterations: 200 }, count);
  assert.equal(results.length, count);
  results.forEach(({ controls, jointResidual }, f) => {
    assert.ok(jointResidual < 0.01 && controls.length === observability.length);
    controls.forEach((value, i) => assert.ok(observability[i] < 0.05 || Math.abs(value - rows[f].controls[i]) < 0.01, `${f} ${i}`));
  });
  assert.deepEqual(fit.solveFrames({}, 0), []);
  let asked = 0;
  const stopped = fit.solveFrames({ joints, canceled: () => ++asked > 2 }, count);
  assert.equal(stopped.at(-1).status, FitStatus.CANCELED);
  assert.deepEqual(stopped.at(-1).controls, stopped.at(-2).controls);
  asked = 0;
  assert.throws(() => fit.solveFrames({ joints, canceled() { ++asked; throw new Error("stop"); } }, count), /stop/);
  assert.equal(asked, 1);

  fails(Status.INVALID_ARGUMENT, () => fit.solveFrames({ joints }, count - 1));
  fails(Status.INVALID_ARGUMENT, () => fit.solveFrames({ joints: rows[0].joints }, 2));
  fails(Status.INVALID_ARGUMENT, () => fit.solveFrames({ joints, start: joints }, count));
  for (const wrong of [undefined, "2", -1, 0.5, NaN, 2 ** 40, 4e9]) {
    assert.throws(() => fit.solveFrames({}, wrong), (error) => error instanceof TypeError || error instanceof RangeError, String(wrong));
  }
  fit.dispose();
  fails(Status.HANDLE, () => fit.solveFrames({ joints }, count));
  own.dispose();
});

test("a part of a mesh", async () => {
  const chosen = everyPoint().filter((i) => i % 7 === 0);
  const part = rig.deformer.subset(0, chosen);
  assert.equal(part.mesh(0).positionCount, chosen.length);
  assert.equal(part.mesh(0).triangles.length, 0);
  const nested = part.subset(0, [1]);
  part.dispose();
  const pose = nested.instance();
  nested.dispose();
  pose.update(face);
  pose.deform(0, Normals.NONE);
  assert.deepEqual([...pose.positions(0)], [...target.subarray(21, 24)]);
  pose.dispose();

  const { deformer } = rig;
  fails(Status.INDEX, () => deformer.subset(99, [0]));
  fails(Status.INDEX, () => deformer.subset(0, [target.length]));
  for (const wrong of [[3, 1], [3, 3]]) fails(Status.INVALID_ARGUMENT, () => deformer.subset(0, wrong));
  for (const wrong of [null, 5, ["1"], [0.5], [-1]]) {
    assert.throws(() => deformer.subset(0, wrong), (error) => error instanceof TypeError || error instanceof RangeError);
  }
  assert.throws(() => deformer.subset("0", [0]), TypeError);
  fails(Status.HANDLE, () => part.subset(0, [0]));
  // An object of another module.
  const other = await Mien.load();
  const dna = other.generate(Preset.TINY);
  const foreign = other.createRig(dna);
  assert.throws(() => foreign.fit({ deformer, points: [0] }), /of another module/);
  const surface = other.createFitSurface([0, 0, 0, 1, 0, 0, 0, 1, 0], [0, 1, 2]);
  const fit = rig.fit({ points: [0] });
  assert.throws(() => fit.solve({ surface }), /of another module/);
  assert.throws(() => fit.solveFrames({ surface }, 2), /of another module/);
  for (const object of [fit, surface, foreign, dna]) object.dispose();
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
