// SPDX-License-Identifier: MIT
// The package as users call it, with right and wrong arguments.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { Worker } from "node:worker_threads";
import { api, Mien, packageFolder, project, sameBits } from "./support.mjs";

const {
  ArgumentError, BakedCheck, BakedError, ClipError, DnaError, FieldType, Isa, Kind, Layer, NameMatch, MienError, Normals, Preset,
  Stage, Status, TICKS_PER_SECOND, UnsupportedError,
} = api;
const tiny = join(project, "tests/golden/tiny.dna");
const mien = await Mien.load();
const head = mien.createRig(mien.generate(Preset.HEAD, {}));

const fails = (type, status) => (error) => {
  assert.ok(error instanceof type, `${error.name}: ${error.message}`);
  assert.equal(error.statusName, Object.keys(Status).find((name) => Status[name] === error.status));
  assert.equal(error.status, status, error.message);
  return true;
};

test("modules load from addresses, bytes and compiled modules", async () => {
  const path = join(packageFolder, "mien-runtime.wasm");
  const bytes = readFileSync(path);
  for (const wasm of [path, pathToFileURL(path), bytes, new WebAssembly.Module(bytes)]) {
    assert.equal((await Mien.load({ wasm })).version, mien.version);
  }
  await assert.rejects(Mien.load({ wasm: new Uint8Array(8) }), WebAssembly.CompileError);
  await assert.rejects(Mien.load({ wasm: join(packageFolder, "none.wasm") }), { code: "ENOENT" });
  await assert.rejects(Mien.load({ wasm: 7 }), TypeError);
});

test("the version is that of the package", () => {
  assert.equal(mien.version, JSON.parse(readFileSync(join(packageFolder, "package.json"))).version);
  assert.equal(mien.version, api.VERSION);
});

test("rigs open from paths, addresses, buffers, blobs and responses", async () => {
  const bytes = readFileSync(tiny);
  const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
  for (const source of [tiny, pathToFileURL(tiny), pathToFileURL(tiny).href, bytes, buffer, new DataView(buffer),
    new Blob([bytes]), new Response(bytes)]) {
    const rig = await mien.openRig(source);
    assert.equal(rig.count(Kind.RAW_CONTROL), 13);
    rig.dispose();
  }
  await assert.rejects(mien.openRig(undefined), TypeError);
  await assert.rejects(mien.openRig(new Response("", { status: 404 })), /404/);
});

test("controls are set by name, and by the end of a name", () => {
  const face = head.instance();
  face.controls.jawOpen = 0.5;
  face.controls["CTRL_expressions.mouthClose"] = 0.25;
  assert.equal(face.rawControls[head.find(Kind.RAW_CONTROL, "jawOpen")], 0.5);
  assert.equal(face.controls.mouthClose, 0.25);
  assert.ok("jawOpen" in face.controls);
  assert.ok(!("jawopen" in face.controls));
  assert.equal(Object.keys(face.controls).length, 72);
  assert.equal(Object.values(face.controls).filter((value) => value !== 0).length, 2);
  face.dispose();
});

test("names of other tools are matched", () => {
  const smile = head.find(Kind.RAW_CONTROL, "mouthSmileLeft");
  assert.deepEqual(head.match("AU12_L"), { how: NameMatch.ALIAS, shares: [{ control: smile, weight: 1 }] });
  assert.equal(head.match("AU12").shares.length, 2);
  assert.equal(head.match("nobody"), undefined);
  assert.equal(mien.controlName("mouthCornerPullL"), "mouthSmileLeft");
  assert.equal(mien.controlName("nobody"), undefined);
});

test("a name that the rig lacks throws and changes nothing", () => {
  const face = head.instance();
  assert.throws(() => { face.controls.jawopen = 1; }, fails(ArgumentError, Status.NAME));
  assert.throws(() => face.controls.nose, fails(ArgumentError, Status.NAME));
  assert.throws(() => { delete face.controls.jawOpen; }, TypeError);
  assert.throws(() => head.indexOf(Kind.JOINT, "nowhere"), fails(ArgumentError, Status.NAME));
  assert.ok(face.rawControls.every((value) => value === 0));
  face.dispose();
});

test("typed arrays are made anew when memory grows", async () => {
  const module = await Mien.load();
  const rig = module.createRig(module.generate(Preset.TINY));
  const face = rig.instance();
  const before = face.rawControls;
  assert.equal(face.rawControls, before);
  face.rawControls[0] = 0.75;
  const old = module.memoryBytes;
  const block = module.exports.malloc(old);
  assert.ok(module.memoryBytes > old);
  assert.equal(before.length, 0);
  assert.equal(face.rawControls[0], 0.75);
  face.evaluate(0);
  assert.ok(face.joints.some((value) => value !== 0));
  module.exports.free(block);
});

test("what was disposed throws, and disposing twice is harmless", async () => {
  const rig = await mien.openRig(tiny);
  const face = rig.instance();
  rig.dispose();
  rig.dispose();
  assert.ok(rig.isDisposed);
  assert.ok(rig.deformer.isDisposed);
  assert.throws(() => rig.count(Kind.JOINT), fails(ArgumentError, Status.HANDLE));
  assert.throws(() => face.evaluate(0), fails(ArgumentError, Status.HANDLE));
  face.dispose();
  assert.throws(() => face.joints, fails(ArgumentError, Status.HANDLE));
  if (Symbol.dispose) assert.equal(typeof rig[Symbol.dispose], "function");
});

test("wrong indices, LODs, kinds and rigs throw with their status", async () => {
  const face = head.instance();
  const other = await mien.openRig(tiny);
  assert.throws(() => face.evaluate(8), fails(ArgumentError, Status.LOD));
  assert.throws(() => head.name(Kind.JOINT, 10000), fails(ArgumentError, Status.INDEX));
  assert.throws(() => head.count(99), fails(ArgumentError, Status.INVALID_ARGUMENT));
  assert.throws(() => head.deformer.mesh(1000), fails(ArgumentError, Status.INDEX));
  const meshes = other.deformer.instance();
  assert.throws(() => meshes.update(face), fails(ArgumentError, Status.MISMATCH));
  assert.throws(() => meshes.updateFromValues([1, 2]), fails(ArgumentError, Status.INVALID_ARGUMENT));
  for (const object of [face, meshes, other]) object.dispose();
});

test("an option that does not exist is a TypeError that lists those that do", async () => {
  await assert.rejects(mien.openRig(tiny, { isaa: 1 }), /RigDesc has no "isaa"; it has isa,/);
  await assert.rejects(mien.openRig(tiny, { system: "nowhere" }), /no coordinate system "nowhere".*gltf/);
  await assert.rejects(mien.openRig(tiny, { isa: Isa.AVX2 }), fails(ArgumentError, Status.ISA));
});

test("files that are not valid fail with status and place, and leave no memory behind", async () => {
  const bytes = readFileSync(tiny);
  await assert.rejects(mien.openRig(new Uint8Array(0)), fails(DnaError, Status.DNA_SIGNATURE));
  await assert.rejects(mien.openRig(new Uint8Array(100)), (error) =>
    fails(DnaError, Status.DNA_SIGNATURE)(error) && error.byteOffset === 0);
  const before = mien.memoryBytes;
  for (let length = 0; length < bytes.length; length += 97) {
    await assert.rejects(mien.openRig(bytes.subarray(0, length)), DnaError);
  }
  let opened = 0;
  for (let at = 0; at < bytes.length; at += 61) {
    const flipped = Uint8Array.from(bytes);
    flipped[at] ^= 0xff;
    try {
      const rig = await mien.openRig(flipped);
      rig.instance().dispose();
      rig.dispose();
      ++opened;
    } catch (error) {
      assert.ok(error instanceof MienError, error);
    }
  }
  assert.ok(opened > 0);
  assert.equal(mien.memoryBytes, before);
});

test("a validation names field and place", async () => {
  const good = await mien.validate(tiny);
  assert.equal(good.errors, 0);
  const bytes = readFileSync(tiny);
  const bad = await mien.validate(bytes.subarray(0, bytes.length / 2));
  assert.ok(bad.errors > 0);
  assert.ok(bad.findings[0].isError);
  assert.ok(bad.findings[0].message.length > 0);
});

test("DNA files are read by paths and written as they were", async () => {
  const dna = await mien.openDna(tiny);
  assert.equal(dna.info.rawControlCount, 13);
  assert.deepEqual(dna.children().slice(0, 4), ["desc", "defn", "bhvr", "geom"]);
  assert.ok(dna.children("desc").includes("name"));
  assert.equal(dna.read("desc.name"), "Synthetic");
  assert.equal(dna.field("desc.name").type, FieldType.STRING);
  assert.equal(dna.field("desc.lodCount").byteOffset, null);
  assert.equal(dna.read("desc.lodCount"), 3);
  const values = dna.read("bhvr.joints.jointGroups[0].values");
  assert.ok(values instanceof Float32Array && values.length > 0);
  assert.ok(dna.read("bhvr.joints.jointGroups[0].inputIndices") instanceof Float64Array);
  assert.throws(() => dna.read("desc.nothing"), fails(ArgumentError, Status.NAME));
  assert.throws(() => dna.read("defn.jointNames[999]"), fails(ArgumentError, Status.INDEX));
  assert.throws(() => dna.read("desc"), TypeError);
  assert.deepEqual(Buffer.from(dna.write()), readFileSync(tiny));
  dna.dispose();
});

test("LODs and layers are chosen before reading", async () => {
  const rig = await mien.openRig(tiny, { lods: 0b10, layers: Layer.BEHAVIOR });
  assert.equal(rig.info.lodCount, 1);
  assert.equal(rig.deformer, null);
  rig.dispose();
  const rotated = await mien.openRig(tiny, { system: "unreal" });
  assert.notDeepEqual(Array.from(rotated.info.axes), Array.from(head.info.axes));
  rotated.dispose();
});

test("a rig that was baked here has the same bits, also in the smaller module", async () => {
  const bytes = head.bake();
  const slim = await Mien.load({ bakedOnly: true });
  const rig = await slim.openRig(bytes);
  const [here, there] = [head.instance(), rig.instance()];
  for (const face of [here, there]) {
    face.controls.jawOpen = 0.7;
    face.controls.mouthSmileLeft = 0.4;
    face.evaluate(0);
  }
  assert.ok(sameBits(here.joints, there.joints));
  assert.ok(sameBits(here.blendShapes, there.blendShapes));
  assert.ok(rig.deformer);
  await assert.rejects(slim.openRig(tiny), fails(UnsupportedError, Status.UNSUPPORTED));
  assert.throws(() => slim.generate(Preset.HEAD), fails(UnsupportedError, Status.UNSUPPORTED));
  here.dispose();
});

test("damaged baked files are found", async () => {
  const bytes = head.bake(null);
  await assert.rejects(mien.openRig(bytes.subarray(0, bytes.length - 1)), fails(BakedError, Status.BAKED_TRUNCATED));
  bytes[bytes.length - 100] ^= 1;
  await assert.rejects(mien.openRig(bytes, { check: BakedCheck.FULL }), fails(BakedError, Status.BAKED_CHECKSUM));
});

test("a batch has the bits of one by one", () => {
  const faces = Array.from({ length: 5 }, () => head.instance());
  const alone = head.instance();
  faces.forEach((face, i) => { face.controls.jawOpen = i / 5; });
  const batch = head.batch({ capacity: 8 });
  batch.evaluate(faces, [0, 1, 2, 0, 1]);
  faces.forEach((face, i) => {
    alone.controls.jawOpen = i / 5;
    alone.evaluate([0, 1, 2, 0, 1][i]);
    assert.ok(sameBits(alone.joints, face.joints));
  });
  assert.throws(() => batch.evaluate([faces[0], faces[0]]), fails(ArgumentError, Status.INVALID_ARGUMENT));
  for (const object of [batch, alone, ...faces]) object.dispose();
});

test("meshes deform to the same bits with vectors and without", async () => {
  const bytes = head.bake();
  const results = [];
  for (const isa of [Isa.SSE2, Isa.SCALAR]) {
    const rig = await mien.openRig(bytes, { isa });
    const [face, meshes] = [rig.instance(), rig.deformer.instance({ lods: 1 })];
    face.controls.jawOpen = 1;
    face.controls.mouthFunnel = 0.5;
    face.evaluate(0);
    meshes.update(face);
    meshes.deform(0);
    results.push({ positions: meshes.positions(0).slice(), normals: meshes.normals(0).slice(),
      skin: meshes.skinMatrices.slice() });
    assert.throws(() => meshes.deform(8), fails(ArgumentError, Status.LOD)); // a mesh of LOD 1
    for (const object of [face, meshes, rig]) object.dispose();
  }
  for (const key of ["positions", "normals", "skin"]) assert.ok(sameBits(results[0][key], results[1][key]), key);
  assert.ok(!sameBits(results[0].positions, head.deformer.mesh(0).positions));
});

test("vertices are written to arrays of the caller", () => {
  const [face, meshes] = [head.instance(), head.deformer.instance()];
  face.controls.jawOpen = 1;
  face.evaluate(0);
  meshes.update(face);
  const mesh = head.deformer.mesh(0);
  const [positions, normals] = [new Float32Array(mesh.vertexCount * 3), new Float32Array(mesh.vertexCount * 3)];
  meshes.writeVertices(0, positions, normals);
  const expected = meshes.positions(0);
  const indices = head.deformer.mesh(0).vertexPositionIndices;
  for (let i = 0; i < mesh.vertexCount; i += 101) {
    for (let k = 0; k < 3; ++k) assert.equal(positions[3 * i + k], expected[3 * indices[i] + k]);
  }
  assert.ok(sameBits(normals, meshes.normals(0)));
  for (const object of [face, meshes]) object.dispose();
});

test("influences, targets and transforms of a deformer", () => {
  const { joints, weights } = head.deformer.influences(0, 100);
  assert.equal(joints.length, weights.length);
  assert.ok(Math.abs(weights.reduce((sum, weight) => sum + weight, 0) - 1) < 1e-5);
  const mesh = head.deformer.mesh(0);
  assert.deepEqual([...head.deformer.triangles(0)], [...head.deformer.mesh(0).triangles]);
  assert.deepEqual([...head.deformer.textureCoordinates(0)], [...head.deformer.mesh(0).textureCoordinates]);
  const target = head.deformer.target(0, 0);
  assert.equal(target.length, 3 * mesh.positionCount);
  assert.ok(target.some((value) => value !== 0));
  const meshes = head.deformer.instance();
  assert.equal(meshes.localTransforms.length, 10 * head.deformer.info.jointCount);
  assert.equal(head.deformer.bindMatrices.length, meshes.jointMatrices.length);
  meshes.dispose();
});

test("stages are evaluated alone", () => {
  const face = head.instance();
  face.controls.jawOpen = 1;
  face.evaluate(0, Stage.PSD);
  assert.ok(face.joints.every((value) => value === 0));
  face.evaluate(0);
  assert.ok(face.joints.some((value) => value !== 0));
  face.reset();
  assert.ok(face.rawControls.every((value) => value === 0));
  face.dispose();
});

test("clips are built, written, opened, played and bound", async () => {
  const names = ["jawOpen", "mouthSmileLeft", "unknown"];
  const values = Float32Array.from({ length: 30 }, (_, i) => (i % 3 === 0 ? i / 30 : 0.25));
  const built = mien.buildClip({
    names, values, rateNumerator: 60, rateDenominator: 1,
    events: [{ tick: TICKS_PER_SECOND / 60, name: "blink", value: 1 }],
  });
  const clip = await mien.openClip(built.write());
  clip.verify();
  assert.equal(clip.info.frameCount, 10);
  assert.deepEqual(clip.channels.map((channel) => channel.name), names);
  assert.deepEqual(clip.events.map((event) => event.name), ["blink"]);
  assert.ok(sameBits(clip.read(), values));
  assert.equal(clip.findChannel("mouthSmileLeft"), 1);
  const binding = clip.bind(head);
  assert.deepEqual(Array.from(binding.info.missingChannels), [2]);
  const [player, face] = [clip.player(), head.instance()];
  built.dispose();
  player.advance((TICKS_PER_SECOND / 60) * 3);
  assert.deepEqual([...player.events()].map((event) => event.name), ["blink"]);
  binding.apply(player.sample(), face);
  assert.equal(face.controls.jawOpen, values[9]);
  assert.equal(face.controls.mouthSmileLeft, 0.25);
  player.seek(0);
  player.setSpeed(2);
  player.advance(TICKS_PER_SECOND / 60);
  assert.equal(player.info.tick, (TICKS_PER_SECOND / 60) * 2);
  for (const object of [player, binding, clip, face]) object.dispose();
});

test("clips that are not valid are refused", async () => {
  await assert.rejects(mien.openClip(new Uint8Array(200)), fails(ClipError, Status.CLIP_SIGNATURE));
  assert.throws(() => mien.buildClip({ names: ["a", "a"], values: [0, 0] }), fails(ArgumentError, Status.NAME));
  assert.throws(() => mien.buildClip({ names: ["a"], values: [NaN] }), fails(ClipError, Status.CLIP_VALUE));
  assert.throws(() => mien.buildClip({ names: ["a"], values: [1], frameCount: 5 }), RangeError);
  assert.throws(() => mien.buildClip({ names: ["a"], values: [1], channelCount: 5 }), RangeError);
});

test("10,000 frames and 100 reopenings take no more memory", async () => {
  const bytes = head.bake();
  const face = head.instance();
  const meshes = head.deformer.instance({ lods: 0b10000000 });
  const mesh = head.lodIndices(Kind.MESH, 7)[0];
  const reopen = async () => {
    const rig = await mien.openRig(bytes);
    const character = rig.instance();
    character.evaluate(0);
    character.dispose();
    rig.dispose();
  };
  await reopen();
  const before = mien.memoryBytes;
  for (let frame = 0; frame < 10000; ++frame) {
    face.controls.jawOpen = (frame % 100) / 100;
    face.evaluate(7);
    meshes.update(face);
    meshes.deform(mesh, Normals.NONE);
  }
  for (let i = 0; i < 100; ++i) await reopen();
  assert.equal(mien.memoryBytes, before);
  for (const object of [face, meshes]) object.dispose();
});

test("the package works in a worker", async () => {
  const code = `
    import { parentPort, workerData } from "node:worker_threads";
    const { Mien } = await import(workerData.package);
    const mien = await Mien.load({ wasm: workerData.wasm });
    const rig = await mien.openRig(workerData.bytes);
    const face = rig.instance();
    face.controls.jawOpen = 1;
    face.evaluate(0);
    parentPort.postMessage(face.joints.slice());
  `;
  const worker = new Worker(new URL(`data:text/javascript,${encodeURIComponent(code)}`), {
    workerData: {
      package: pathToFileURL(join(packageFolder, "index.js")).href,
      wasm: new WebAssembly.Module(readFileSync(join(packageFolder, "mien-runtime.wasm"))),
      bytes: head.bake(),
    },
  });
  const joints = await new Promise((resolve, reject) => worker.once("message", resolve).once("error", reject));
  await worker.terminate();
  const face = head.instance();
  face.controls.jawOpen = 1;
  face.evaluate(0);
  assert.ok(sameBits(joints, face.joints));
  face.dispose();
});

test("every member of the classes is declared, and nothing else", () => {
  const declared = readFileSync(join(packageFolder, "index.d.ts"), "utf8");
  for (const name of ["Mien", "Dna", "Rig", "Instance", "Batch", "Deformer", "DeformerInstance", "Clip", "ClipPlayer",
    "ClipBinding", "Mix", "Mixer", "Gaze", "SolverStack", "SolverState"]) {
    const body = new RegExp(`^export (?:class|interface) ${name} [^{]*{(.*?)^}`, "ms").exec(declared)[1];
    const types = new Set([...body.matchAll(/^ {2}(?:readonly |static )*(\w+)[?(:]/gm)].map((match) => match[1]));
    const members = Object.getOwnPropertyNames(api[name]?.prototype ?? Mien.prototype)
      .filter((member) => !["constructor", "dispose"].includes(member));
    for (const member of members) assert.ok(types.has(member), `${name}.${member} is not declared`);
    const own = { Rig: ["deformer", "metadata"], Instance: ["controls", "gui"], Mien: ["load"] }[name] ?? [];
    for (const type of types) {
      assert.ok([...members, ...own, "private", "constructor"].includes(type), `${name}.${type} does not exist`);
    }
  }
});
