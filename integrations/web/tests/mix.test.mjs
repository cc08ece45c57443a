// SPDX-License-Identifier: MIT
// Mixes, mixers, gazes and solvers: rows reach instances, what they read stays in memory, wrong calls throw.
import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { api, Mien, project, sameBits } from "./support.mjs";

const {
  ArgumentError, BlendMode, Generator, Guard, Kind, LayerGroup, MixError, MixLayer, Mixer, Preset, SolverState, Status, ticks,
  Transition,
} = api;
const mien = await Mien.load();
const rig = mien.createRig(mien.generate(Preset.HEAD));
const raw = (name) => rig.indexOf(Kind.RAW_CONTROL, name);
const FRAME = ticks(1 / 60);
const CUT = { transition: Transition.CUT };

const fails = (status) => (error) => {
  assert.ok(error instanceof ArgumentError, `${error.name}: ${error.message}`);
  assert.equal(error.status, status, error.message);
  return true;
};

function speech() {
  const values = Array.from({ length: 122 }, (_, i) => (i % 2 ? 0.5 : i / 256));
  return mien.buildClip({
    names: ["jawOpen", "mouthPucker"], values, rateNumerator: 60, rateDenominator: 1,
    events: [{ tick: 10 * FRAME, name: "word", value: 0.5 }],
  });
}

function scene(options = {}) {
  return rig.mix({
    layers: [
      MixLayer.clip({ group: LayerGroup.SPEECH }),
      MixLayer.poses([{ mouthSmileLeft: 0.5, wonder: 1 }]),
      MixLayer.stream(["browInnerUp"]),
      MixLayer.generator(Generator.BLINK, { eyeBlinkLeft: 1, eyeBlinkRight: 1 },
        { period: ticks(4), mode: BlendMode.MAX }),
    ],
    reactions: [{ strokes: [
      { pose: { eyeSquintLeft: 1 }, mode: BlendMode.SCREEN, attack: FRAME, release: FRAME, isHeld: true, isScaled: true },
    ], levelOn: 0.5, levelOff: 0.25 }],
    variables: ["wonder"],
    ...options,
  });
}

test("layers, streams and reactions reach the instance", () => {
  const [face, clip, mix] = [rig.instance(), speech(), scene()];
  assert.equal(mix.info.layerCount, 4);
  assert.equal(mix.info.variableCount, 1);
  const mixer = mix.mixer({ seed: 3, stages: 1 });
  mixer.play(0, clip, clip.bind(rig), CUT);
  mixer.setPoseWeight(1, 0, 1);
  mixer.setVariable("wonder", 0);
  mixer.step(9 * FRAME, face);
  assert.deepEqual(mixer.events, []);
  mixer.step(FRAME, face);
  assert.deepEqual(mixer.events.map(({ layer, tick, name, value }) => [layer, tick, name, value]),
    [[0, 10 * FRAME, "word", 0.5]]);
  assert.equal(face.controls.jawOpen, 10 / 128);
  assert.equal(face.controls.mouthPucker, 0.5);
  assert.equal(face.controls.mouthSmileLeft, 0.5);
  assert.equal(mixer.row.at(-1), 1);
  assert.equal(mixer.stage(0).at(-1), 0);
  assert.equal(mixer.info.tick, 10 * FRAME);
  assert.equal(mixer.push(2, 11 * FRAME, [0.75]), true);
  assert.equal(mixer.push(2, 0, [0.75]), false);
  for (let i = 1; i < 60; ++i) {
    mixer.push(2, (11 + i) * FRAME, [0.75]);
    mixer.step(FRAME, face);
  }
  assert.equal(face.controls.browInnerUp, 0.75); // eased in
  mixer.trigger(0, 1, -1);
  mixer.step(ticks(1), face);
  assert.equal(face.controls.eyeSquintLeft, 1);
  mixer.release(0);
  for (const [level, wanted] of [[0.49, 0], [0.5, 0.5], [0.25, 0.25], [0.24, 0]]) {
    mixer.setLevel(0, level);
    mixer.step(ticks(2), face);
    assert.equal(face.controls.eyeSquintLeft, wanted);
  }
  mixer.setWeight(1, 0, FRAME);
  mixer.stop(0);
  mixer.step(ticks(1), face);
  for (const name of ["eyeSquintLeft", "mouthSmileLeft", "jawOpen"]) assert.equal(face.controls[name], 0);
  for (const object of [face, clip, mix, mixer]) object.dispose();
});

test("snapshots continue to the bit, and wrong ones are refused", () => {
  const clip = speech();
  const binding = clip.bind(rig);
  const mix = scene();
  const [one, other] = [mix.mixer({ seed: 1 }), mix.mixer({ seed: 2 })];
  one.play(0, clip, binding, { clipId: 7 });
  one.step(5 * FRAME);
  const saved = one.snapshot();
  assert.equal(saved.length, mix.info.snapshotBytes);
  const clips = [{ clipId: 7, clip, binding }];
  assert.throws(() => other.restore(saved), fails(Status.MISMATCH));
  other.restore(saved, clips);
  for (let i = 0; i < 60; ++i) {
    one.step(FRAME);
    other.step(FRAME);
    assert.ok(sameBits(one.row, other.row));
  }
  for (const wrong of [saved.subarray(1), new Uint8Array(0), new Uint8Array(saved.length).fill(120)]) {
    assert.throws(() => other.restore(wrong, clips), fails(Status.INVALID_ARGUMENT));
  }
  for (const object of [clip, binding, one, other, mix]) object.dispose();
});

test("clips that play stay in memory when they are disposed, and are released afterwards", async () => {
  const bytes = speech().write();
  const mix = scene();
  const crossfades = async () => {
    const [mixer, face] = [mix.mixer(), rig.instance()];
    for (let i = 0; i < 30; ++i) {
      const clip = await mien.openClip(bytes);
      const binding = clip.bind(rig);
      mixer.play(0, clip, binding, { transition: Transition.CROSSFADE });
      clip.dispose();
      binding.dispose();
      assert.throws(() => clip.info, fails(Status.HANDLE));
      mixer.step(FRAME, face);
      assert.ok(face.rawControls.every(Number.isFinite));
    }
    mixer.step(10 * FRAME);
    assert.deepEqual(mixer.events.map((event) => event.name), ["word"]);
    mixer.dispose();
    face.dispose();
  };
  await crossfades();
  const before = mien.memoryBytes;
  for (let i = 0; i < 20; ++i) await crossfades();
  assert.equal(mien.memoryBytes, before);
  mix.dispose();
});

test("mixers that step together have the bits of single steps", () => {
  const clip = speech();
  const binding = clip.bind(rig);
  const mix = scene();
  const [together, alone] = [0, 1].map(() => [1, 2, 3].map((seed) => mix.mixer({ seed })));
  mix.dispose(); // mixers go on
  const faces = together.map(() => rig.instance());
  for (const mixer of [...together, ...alone]) mixer.play(0, clip, binding);
  Mixer.stepAll(together, 12 * FRAME, faces);
  together.forEach((mixer, i) => {
    assert.equal(mixer.events.length, 1);
    alone[i].step(12 * FRAME);
    assert.ok(sameBits(mixer.row, alone[i].row));
    assert.ok(sameBits(faces[i].rawControls, mixer.row.subarray(0, -1)));
  });
  Mixer.stepAll([], 1);
  assert.throws(() => Mixer.stepAll([together[0], together[0]], 1), fails(Status.INVALID_ARGUMENT));
  assert.throws(() => Mixer.stepAll(together, 1, faces.slice(1)), fails(Status.MISMATCH));
  for (const object of [...together, ...alone, ...faces, binding, clip]) object.dispose();
});

test("guards are measured on the rig and hold back what parts the lips", () => {
  const mix = rig.mix({
    layers: [MixLayer.clip({ group: LayerGroup.SPEECH }), MixLayer.poses([{ jawOpen: 0.6, mouthSmileLeft: 0.8 }])],
    guards: Guard.LIPS,
  });
  assert.ok(mix.info.guardCount >= 3);
  const closed = mien.buildClip({ names: ["jawOpen"], values: new Float32Array(30) });
  const [mixer, face] = [mix.mixer(), rig.instance()];
  mixer.play(0, closed, closed.bind(rig), CUT);
  mixer.setPoseWeight(1, 0, 1);
  for (let i = 0; i < 30; ++i) mixer.step(FRAME, face);
  assert.ok(face.controls.jawOpen < 0.1);
  assert.ok(face.controls.mouthSmileLeft > 0.5);
  const states = Array.from({ length: mix.info.guardCount }, (_, i) => mixer.guard(i));
  assert.ok(states.some((state) => state.name === "lips center"));
  for (const state of states) {
    assert.equal(state.kind, Guard.LIPS);
    assert.ok(state.wanted > state.limit && state.distance < state.limit + 0.01);
    assert.ok(state.controls.includes(raw("jawOpen")));
  }
  assert.throws(() => mixer.guard(states.length), fails(Status.INDEX));
  states.forEach((_, guard) => mixer.setGuard(guard, 0));
  for (let i = 0; i < 30; ++i) mixer.step(FRAME, face);
  assert.ok(Math.abs(face.controls.jawOpen - 0.6) < 1e-5);
  for (const object of [closed, mixer, face, mix]) object.dispose();
});

test("guards of one's own tell what they measured and held", () => {
  const [upper, lower] = ["C_TeethUpper", "C_TeethLower"].map((name) => ({ points: [rig.indexOf(Kind.JOINT, name)] }));
  const mix = rig.mix({ layers: [MixLayer.poses([{ jawOpen: 0.5 }])], customGuards: [{ upper, lower, fOn: 4 }] });
  const guard = mix.guard(0);
  assert.equal(guard.curves[0], raw("jawOpen"));
  assert.ok(guard.gains[0] > 1);
  const mixer = mix.mixer();
  mixer.setPoseWeight(0, 0, 1);
  mixer.step(ticks(1));
  const state = mixer.guard(0);
  assert.equal(state.activation, 1);
  assert.deepEqual([state.name, state.kind, [...state.controls]], ["custom", 0, [...guard.curves]]);
  assert.ok(state.wanted > state.limit && Math.abs(state.distance - state.limit) < 1e-3);
  assert.throws(() => mix.guard(1), fails(Status.INDEX));
  for (const object of [mixer, mix]) object.dispose();
});

test("a glare closes the lids at once", () => {
  const glare = mien.glare([{ eyeBlinkLeft: 1 }, {}, {}, {}, {}]);
  assert.equal(glare.strokes[0].delay, ticks(0.06));
  const mix = rig.mix({ reactions: [glare] });
  const mixer = mix.mixer();
  mixer.trigger(0);
  mixer.step(ticks(0.13));
  assert.equal(mixer.row[raw("eyeBlinkLeft")], 1);
  assert.throws(() => mien.glare([]), fails(Status.INVALID_ARGUMENT));
  for (const object of [mixer, mix]) object.dispose();
});

test("antagonists, mirrors, masks of joint groups and limits come from the rig", () => {
  const pairs = rig.antagonists();
  assert.ok(pairs.some(({ first, second }) => first === raw("eyeBlinkLeft") && second === raw("eyeWideLeft")));
  const count = rig.count(Kind.RAW_CONTROL) + 1;
  const mirror = rig.deformer.mirror(count);
  assert.equal(mirror[raw("mouthSmileLeft")], raw("mouthSmileRight"));
  const groups = Array.from({ length: rig.count(Kind.JOINT_GROUP) }, (_, i) => i);
  const mask = rig.groupMask(groups, { otherwise: 0.25, curveCount: count });
  assert.equal(mask[count - 1], 0.25);
  const mix = scene({ antagonists: pairs, mirror, lower: 0, upper: new Float32Array(count).fill(1) });
  const clip = mien.buildClip({ names: ["mouthSmileLeft"], values: [0.5, 0.5] });
  const mixer = mix.mixer();
  mixer.play(0, clip, clip.bind(rig), { mirrored: 1, ...CUT });
  mixer.step(FRAME);
  assert.equal(mixer.row[raw("mouthSmileRight")], 0.5);
  assert.equal(mixer.row[raw("mouthSmileLeft")], 0);
  assert.throws(() => rig.deformer.mirror(3), fails(Status.MISMATCH));
  assert.throws(() => rig.groupMask([99]), fails(Status.INDEX));
  for (const object of [clip, mixer, mix]) object.dispose();
});

test("masks are given by names, by numbers or as lists", () => {
  const numbers = new Array(rig.count(Kind.RAW_CONTROL)).fill(0);
  numbers[raw("jawOpen")] = 0.5;
  for (const [mask, weight] of [[{ jawOpen: 0.5 }, 0.5], [numbers, 0.5], [Float32Array.from(numbers), 0.5],
    [["jawOpen"], 1]]) {
    const mix = rig.mix({ layers: [MixLayer.poses([{ jawOpen: 1, mouthPucker: 1 }], { mask })] });
    const mixer = mix.mixer();
    mixer.setPoseWeight(0, 0, 1);
    mixer.step(1);
    assert.equal(mixer.row[raw("jawOpen")], weight);
    assert.equal(mixer.row[raw("mouthPucker")], 0);
    for (const object of [mixer, mix]) object.dispose();
  }
});

test("mixes of hundreds of poses do not use up the stack", () => {
  const pose = Object.fromEntries(rig.names(Kind.RAW_CONTROL).map((name, i) => [name, i / 64]));
  const poses = Array.from({ length: 300 }, () => pose);
  const variables = Array.from({ length: 900 }, (_, i) => `v${i}`);
  for (const name of variables) pose[name] = 0.5;
  const mix = rig.mix({ layers: [MixLayer.poses(poses)], variables });
  const mixer = mix.mixer();
  mixer.setPoseWeight(0, 299, 1);
  mixer.step(FRAME);
  assert.ok(sameBits(mixer.row, Object.values(pose)));
  for (const object of [mixer, mix]) object.dispose();
});

test("wrong mixes and wrong calls throw with their status, and change nothing", async () => {
  const poses = MixLayer.poses;
  assert.throws(() => rig.mix({ layers: [poses([{ nose: 1 }])] }), fails(Status.NAME));
  assert.throws(() => rig.mix({ layers: [MixLayer.stream([999])] }), fails(Status.INDEX));
  assert.throws(() => rig.mix({ layers: [poses([{}], { weight: 2 })] }), fails(Status.INVALID_ARGUMENT));
  assert.throws(() => rig.mix({ layers: [poses([{}], { wait: 2 })] }), TypeError);
  assert.throws(() => rig.mix({ layer: [] }), TypeError);
  assert.throws(() => rig.mix({ layers: new Array(17).fill(MixLayer.clip()) }), fails(Status.INVALID_ARGUMENT));
  assert.throws(() => rig.mix({ lower: 0, upper: [1] }), fails(Status.MISMATCH));
  assert.throws(() => rig.mix({ mirror: [0] }), fails(Status.MISMATCH));
  const [mix, clip] = [scene(), speech()];
  const [mixer, binding] = [mix.mixer(), clip.bind(rig)];
  const other = await mien.openRig(join(project, "tests/golden/tiny.dna"));
  const stranger = other.instance();
  for (const [status, call] of [
    [Status.INDEX, () => mixer.play(1, clip, binding)],
    [Status.INVALID_ARGUMENT, () => mixer.play(0, clip, binding, { transition: 9 })],
    [Status.INVALID_ARGUMENT, () => mixer.play(0, clip, binding, { mirrored: 1 })],
    [Status.INDEX, () => mixer.setWeight(9, 0.5)],
    [Status.INVALID_ARGUMENT, () => mixer.setWeight(0, NaN)],
    [Status.NAME, () => mixer.setVariable("nobody", 1)],
    [Status.INDEX, () => mixer.trigger(1)],
    [Status.INDEX, () => mixer.setLevel(1, 1)],
    [Status.INVALID_ARGUMENT, () => mixer.setLevel(0, 1.5)],
    [Status.MISMATCH, () => mixer.push(2, 0, [1, 2])],
    [Status.INVALID_ARGUMENT, () => mixer.stage(0)],
    [Status.INVALID_ARGUMENT, () => mixer.step(-1)],
    [Status.MISMATCH, () => mixer.step(1, stranger)],
  ]) assert.throws(call, fails(status));
  assert.throws(() => mixer.step(0.5), RangeError);
  assert.equal(mixer.info.tick, 0);
  for (const object of [mixer, binding, clip, mix, stranger, other]) object.dispose();
  assert.throws(() => mixer.step(1), fails(Status.HANDLE));
});

test("eyes look at a place, alone and as a layer", () => {
  const [gaze, face] = [rig.deformer.gaze(), rig.instance()];
  const mix = rig.mix({
    layers: [MixLayer.gaze(["x", "y", "z"], { head: { turn: 1, nod: 1 } })],
    variables: ["x", "y", "z", "turn", "nod"], gaze,
  });
  const mixer = mix.mixer();
  const target = { left: 200, up: 1700, front: 1000 };
  ["x", "y", "z"].forEach((name, i) => mixer.setVariable(name, Object.values(target)[i]));
  mixer.step(FRAME);
  const rest = gaze.lookAt(target, face);
  assert.ok(face.controls.eyeLookOutLeft > 0);
  assert.deepEqual(Object.keys(rest), ["left", "up"]);
  assert.ok(sameBits(mixer.row.subarray(0, face.rawControls.length), face.rawControls));
  assert.throws(() => gaze.lookAt({ left: NaN }, face), fails(Status.INVALID_ARGUMENT));
  assert.throws(() => rig.deformer.gaze({ leftEye: "nobody" }), fails(Status.NAME));
  assert.throws(() => rig.mix({ layers: [MixLayer.gaze([0, 1, 2])] }), fails(Status.INVALID_ARGUMENT));
  for (const object of [gaze, face, mixer, mix]) object.dispose();
});

// ---- solvers ---------------------------------------------------------------------------------------------

const jaw = rig.indexOf(Kind.JOINT, "C_Jaw");
const body = rig.deformer.instance();

function solved(solver, { row, steps = 1, ...input } = {}) {
  const stack = rig.deformer.solvers([solver], { curveCount: row?.length ?? 0, checkWrites: 1 });
  const state = stack.state();
  stack.dispose(); // states go on
  for (let i = 0; i < steps; ++i) {
    body.updateFromValues();
    state.step(body, FRAME, { ...input, ...(row ? { row } : {}) });
  }
  return state;
}

test("each kind of solver moves its joint", () => {
  const neutral = rig.deformer.bindMatrices.slice(16 * jaw, 16 * jaw + 16);
  const [x, y, z] = neutral.subarray(12);
  for (const [solver, input] of [
    [{ aim: { joint: jaw, axis: [1, 0, 0], targetCurve: 1, upAxis: [0, 1, 0] } }, { row: [0, x, y, z + 100] }],
    [{ spring: { joint: jaw, frequency: 2, damping: 0.5, restOffset: [1, 0, 0] } }, { steps: 60 }],
    [{ custom: { writes: [jaw], solve: ([{ locals }]) => { locals[10 * jaw + 1] = 3; } } }, {}],
  ]) {
    const state = solved(solver, input);
    assert.ok(!sameBits(body.jointMatrices.subarray(16 * jaw, 16 * jaw + 16), neutral), Object.keys(solver)[0]);
    assert.equal(state.undeclared, "");
    assert.equal(state.transforms.length, 10 * rig.deformer.info.jointCount);
    state.dispose();
  }
  for (const solver of [
    { space: { joint: jaw, spaces: [null, 0], curve: 0 } },
    { twist: { source: 0, axis: [1, 0, 0], joints: [jaw], shares: [0.5] } },
    { copy: { source: 0, joint: jaw, isMirrored: true } },
  ]) solved(solver, { row: [1] }).dispose();
});

test("custom solvers keep state, see rows and publish, one character or many", () => {
  const seen = [];
  const stack = rig.deformer.solvers([{ name: "hat", custom: {
    writes: [jaw], reads: [jaw], previousJoints: [jaw], stateFloats: 1, outputCount: 2,
    solve(poses, ticks) {
      for (const pose of poses) {
        pose.state[0] += 1;
        pose.outputs.fill(pose.state[0]);
        pose.locals[10 * jaw] += pose.row[1];
        seen.push([ticks, pose.lod, pose.isReset, pose.previous.length]);
      }
    },
  } }], { curveCount: 2 });
  assert.equal(stack.info.outputCount, 2);
  const states = [stack.state(), stack.state()];
  const bodies = [body, rig.deformer.instance()];
  const inputs = [{ row: [0, 2], lod: 1 }, { row: [0, 2] }];
  for (const step of [FRAME, 5]) {
    for (const each of bodies) each.updateFromValues();
    SolverState.stepAll(states, bodies, step, inputs);
  }
  assert.deepEqual(seen, [[FRAME, 1, true, 16], [FRAME, 0, true, 16], [5, 1, false, 16], [5, 0, false, 16]]);
  assert.deepEqual([...states[0].outputs(0)], [2, 2]);
  assert.ok(sameBits(bodies[0].jointMatrices, bodies[1].jointMatrices));
  assert.throws(() => SolverState.stepAll(states, bodies.slice(1), 1), fails(Status.MISMATCH));
  for (const object of [stack, ...states, bodies[1]]) object.dispose();
});

test("what a custom solver throws comes out of the step, and the module goes on", () => {
  const solver = { custom: { writes: [jaw], solve() { throw new RangeError("no"); } } };
  for (let i = 0; i < 100; ++i) assert.throws(() => solved(solver), new RangeError("no"));
  const grown = { custom: { writes: [jaw], solve([{ locals }]) {
    locals[10 * jaw] = 1;
    mien.exports.free(mien.exports.malloc(mien.memoryBytes)); // arrays of the call are empty from here on
  } } };
  solved(grown).dispose();
  assert.equal(body.jointMatrices.length, 16 * rig.deformer.info.jointCount);
});

test("a solver that moves other joints than it said is named", () => {
  const state = solved({ name: "hat", custom: { writes: [jaw], solve: ([{ locals }]) => { locals[0] += 1; } } });
  assert.equal(state.undeclared, "hat");
  state.dispose();
});

test("wrong solvers and wrong steps throw", () => {
  for (const [status, solver] of [
    [Status.INDEX, { spring: { joint: 60000, frequency: 1, damping: 1 } }],
    [Status.INVALID_ARGUMENT, { spring: { joint: jaw, damping: 1 } }],
    [Status.INVALID_ARGUMENT, { aim: { joint: jaw, axis: [0, 0, 0], targetJoint: 0 } }],
    [Status.INDEX, { aim: { joint: jaw, axis: [1, 0, 0] } }],
    [Status.INVALID_ARGUMENT, { custom: { writes: [], solve() {} } }],
  ]) assert.throws(() => rig.deformer.solvers([solver]), fails(status), JSON.stringify(solver));
  for (const solver of [{}, { spring: { joint: 0 }, aim: { joint: 0 } }, { custom: { writes: [jaw] } }]) {
    assert.throws(() => rig.deformer.solvers([solver]), TypeError);
  }
  const twist = { source: jaw, axis: [1, 0, 0], joints: [0], shares: [0.5, 1] };
  assert.throws(() => rig.deformer.solvers([{ twist }]), RangeError);
  const stack = rig.deformer.solvers([{ spring: { joint: jaw, frequency: 1, damping: 1 } }], { curveCount: 2 });
  const state = stack.state();
  assert.throws(() => state.step(body, 1, { row: [0] }), fails(Status.MISMATCH));
  assert.throws(() => state.step(body, -1, { row: [0, 0] }), fails(Status.INVALID_ARGUMENT));
  assert.throws(() => state.undeclared, fails(Status.INVALID_ARGUMENT));
  assert.throws(() => state.outputs(1), fails(Status.INDEX));
  for (const object of [state, stack]) object.dispose();
});

test("a mix that was written opens again, with what was measured, and steps to the same bits", async () => {
  const [clip, mix] = [speech(), scene({ guards: Guard.LIPS })];
  const bytes = mix.write();
  const again = await mien.openMix(new Blob([bytes]), rig, { variables: ["wonder"] });
  assert.deepEqual(again.write(), bytes);
  assert.deepEqual(again.info, mix.info);
  assert.equal(again.guard(0).rest, mix.guard(0).rest);
  const rows = [mix, again].map((one) => {
    const [face, mixer] = [rig.instance(), one.mixer({ seed: 3 })];
    mixer.play(0, clip, clip.bind(rig), CUT);
    mixer.setPoseWeight(1, 0, 1);
    mixer.setVariable("wonder", 0.25);
    for (let i = 0; i < 30; ++i) mixer.step(FRAME, face);
    return mixer.row.slice();
  });
  assert.ok(sameBits(...rows) && rows[0].some((value) => value > 0.1));
  const alone = await mien.openMix(bytes); // without a rig: for looking into it
  assert.deepEqual(alone.write(), bytes);
  const text = mix.toText();
  assert.match(text, /^\S.*\n/);
  assert.match(text, /mouthSmileLeft/);
  assert.ok(text.endsWith("\n"));
  for (const object of [mix, again, alone, clip]) object.dispose();
});

test("mixes for other rigs, and bytes that are none, are refused", async () => {
  const mix = scene();
  const bytes = mix.write();
  const fails = (type, status) => (error) => error instanceof type && error.status === status;
  const other = mien.createRig(mien.generate(Preset.TINY));
  await assert.rejects(mien.openMix(bytes, other), (error) =>
    fails(ArgumentError, Status.NAME)(error) && /mouthSmileLeft|browInnerUp|eye/.test(error.message));
  await assert.rejects(mien.openMix(bytes, rig, { variables: ["a", "b"] }), fails(ArgumentError, Status.MISMATCH));
  await assert.rejects(mien.openMix(new Uint8Array(100), rig), fails(MixError, Status.MIX_SIGNATURE));
  await assert.rejects(mien.openMix(new Uint8Array(0), rig), MixError);
  await assert.rejects(mien.openMix(bytes.subarray(0, -1), rig), fails(MixError, Status.MIX_TRUNCATED));
  const flipped = bytes.slice();
  flipped[bytes.length >> 1] ^= 1;
  await assert.rejects(mien.openMix(flipped, rig), fails(MixError, Status.MIX_CHECKSUM));
  rig.instance().dispose();
  const gone = mien.createRig(mien.generate(Preset.TINY));
  gone.dispose();
  await assert.rejects(mien.openMix(bytes, gone), fails(ArgumentError, Status.HANDLE));
  mix.dispose();
  assert.throws(() => mix.write(), fails(ArgumentError, Status.HANDLE));
});
