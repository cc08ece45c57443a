// SPDX-License-Identifier: MIT
// Workers that share the memory of a module: the bits of one thread, growing memory, programs that end.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { join } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { api, goldenRigs, Mien, packageFolder, sameBits } from "./support.mjs";

const { ArgumentError, Kind, Preset, Status } = api;
const one = await Mien.load();
const many = await Mien.load({ threads: 3 });
const heads = [one, many].map((mien) => mien.createRig(mien.generate(Preset.HEAD)));

test("modules have the threads that they were asked for", async () => {
  assert.equal(one.threads, 1);
  assert.equal(many.threads, 3);
  assert.ok(many.exports.memory.buffer instanceof SharedArrayBuffer);
  assert.ok((await Mien.load({ threads: true })).threads >= 1);
  // One thread has nothing to share, and the small module cannot.
  assert.ok((await Mien.load({ threads: 1 })).exports.memory.buffer instanceof ArrayBuffer);
  assert.equal((await Mien.load({ threads: 2, bakedOnly: true })).threads, 1);
  assert.equal((await Mien.load({ threads: 2, wasm: join(packageFolder, "mien.wasm") })).threads, 1);
  assert.equal((await Mien.load({ threads: 2, wasm: join(packageFolder, "mien-threads.wasm") })).threads, 2);
  for (const threads of [0, -1, 1.5, 65, NaN, "2", false]) await assert.rejects(Mien.load({ threads }), RangeError);
});

test("batches and meshes have the bits of one thread", () => {
  const results = heads.map((rig) => {
    const faces = Array.from({ length: 40 }, (_, i) => {
      const face = rig.instance();
      face.rawControls.forEach((_, k, controls) => { controls[k] = ((i * 7 + k * 3) % 11) / 10; });
      return face;
    });
    const batch = rig.batch({ capacity: 40 });
    for (let i = 0; i < 20; ++i) batch.evaluate(faces);
    const pose = rig.deformer.instance();
    const skin = rig.lodIndices(Kind.MESH, 0)[0];
    const { vertexCount } = rig.deformer.mesh(skin);
    assert.ok(vertexCount > 16384); // else it is one task
    const [positions, normals] = [new Float32Array(3 * vertexCount), new Float32Array(3 * vertexCount)];
    const rows = faces.map((face) => {
      pose.update(face);
      pose.writeVertices(skin, positions, normals);
      return [face.joints.slice(), positions.slice(), normals.slice()];
    });
    for (const object of [...faces, batch, pose]) object.dispose();
    return rows;
  });
  results[0].forEach((row, i) => row.forEach((values, k) => assert.ok(sameBits(values, results[1][i][k]), `${i}, ${k}`)));
});

test("golden rigs open and evaluate", async () => {
  for (const [name, path] of goldenRigs()) {
    if (name === "head") continue; // the tests of one thread have it
    const joints = await Promise.all([one, many].map(async (mien) => {
      const rig = await mien.openRig(path);
      const face = rig.instance();
      face.rawControls.fill(0.5);
      face.evaluate(0);
      const values = face.joints.slice();
      for (const object of [face, rig]) object.dispose();
      return values;
    }));
    assert.ok(sameBits(...joints), name);
  }
});

test("views stay while memory grows, and text, bytes and errors come out of it", async () => {
  const mien = await Mien.load({ threads: 2 });
  const rig = mien.createRig(mien.generate(Preset.TINY));
  const face = rig.instance();
  const before = face.rawControls;
  before[0] = 0.75;
  const old = mien.memoryBytes;
  const block = mien.exports.malloc(old);
  assert.ok(block && mien.memoryBytes > old);
  assert.equal(before[0], 0.75);
  assert.equal(face.rawControls[0], 0.75);
  const large = mien.createRig(mien.generate(Preset.SMALL)); // beyond the old end
  assert.ok(large.names(Kind.JOINT).every((name) => typeof name === "string" && name));
  assert.equal((await mien.openRig(rig.bake())).count(Kind.JOINT), rig.count(Kind.JOINT));
  assert.throws(() => face.evaluate(99), (error) => error instanceof ArgumentError && error.status === Status.LOD);
  await assert.rejects(mien.openRig(new Uint8Array(100)), /signature|DNA/);
  assert.equal(mien.exports.malloc(2 ** 31 - 65536), 0); // more than there may be
  assert.equal(face.controls[rig.names(Kind.RAW_CONTROL)[0]], 0.75);
});

test("rigs from meshes have the bytes of one thread", () => {
  const rig = heads[0];
  const mesh = rig.lodIndices(Kind.MESH, 5)[0];
  const { positions, triangles, vertexPositionIndices } = rig.deformer.mesh(mesh);
  const given = {
    positions: positions.slice(), faces: triangles.map((vertex) => vertexPositionIndices[vertex]),
    shapes: { lift: positions.map((value, i) => (i % 3 === 1 && positions[i + 1] > 5 ? 0.1 + value / 100 : 0)) },
  };
  const bytes = [one, many].map((mien) => {
    const { dna } = mien.authorRig(given, { facialJoints: 20, lods: 2 });
    const written = dna.write();
    dna.dispose();
    return written;
  });
  assert.ok(Buffer.compare(...bytes) === 0);
});

test("threads keep no program alive", () => {
  const index = pathToFileURL(join(packageFolder, "index.js")).href;
  const { status, stdout } = spawnSync(process.execPath, ["--input-type=module", "-e",
    `import { Mien } from "${index}"; console.log((await Mien.load({ threads: 3 })).threads);`],
  { encoding: "utf8", timeout: 60000 });
  assert.equal(status, 0);
  assert.equal(stdout, "3\n");
});
