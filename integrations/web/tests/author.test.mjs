// SPDX-License-Identifier: MIT
// Rigs from meshes: what goes in, what comes out, and every wrong array.
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { api, Mien, mien as program, packageFolder } from "./support.mjs";

const { ArgumentError, AuthorError, AuthorFlags, BoneKind, Kind, MeshAxis, Status, UnsupportedError } = api;
const mien = await Mien.load();
const ROWS = 24;
const COLUMNS = 28;

/** An egg with a nose, of quads, and two shapes of it. */
function egg() {
  const positions = new Float64Array(3 * ROWS * COLUMNS);
  const shapes = { smile: new Float64Array(positions.length), puff: new Float64Array(positions.length) };
  for (let i = 0; i < ROWS * COLUMNS; ++i) {
    const v = Math.PI * (0.03 + (0.94 * Math.floor(i / COLUMNS)) / (ROWS - 1));
    const u = (2 * Math.PI * (i % COLUMNS)) / COLUMNS;
    const [x, y] = [7 * Math.sin(v) * Math.sin(u), 10 * Math.cos(v)];
    let z = 8.5 * Math.sin(v) * Math.cos(u);
    if (z > 4) {
      z += 2 * Math.exp(-(x * x + y * y) / 4);
      for (const [name, at, by] of [["smile", 3, [0.2, 0.5, -0.2]], ["puff", 4, [0.3, 0, 0.4]]]) {
        const amount = Math.exp(-((Math.abs(x) - at) ** 2 + (y + 4) ** 2) / 5);
        shapes[name].set(by.map((value) => amount * value), 3 * i);
      }
    }
    positions.set([x, y, z], 3 * i);
  }
  const faces = Array.from({ length: (ROWS - 1) * COLUMNS }, (_, cell) => {
    const beside = cell - (cell % COLUMNS) + ((cell + 1) % COLUMNS);
    return [cell, cell + COLUMNS, beside + COLUMNS, beside]; // counterclockwise from outside
  });
  return { positions, faces, shapes };
}

const mesh = egg();
const FEW = { facialJoints: 12, lods: 1 };

function bytesOf(given, options = {}) {
  const { dna } = mien.authorRig(given, { ...FEW, ...options });
  try {
    return dna.write();
  } finally {
    dna.dispose();
  }
}

const fails = (type, status, words) => (error) => {
  assert.ok(error instanceof type, `${error.name}: ${error.message}`);
  assert.equal(error.status, status, error.message);
  assert.match(error.message, words);
  return true;
};

test("a mesh with shapes becomes a rig that makes them", async () => {
  const steps = [];
  const { dna, report } = mien.authorRig(mesh,
    { ...FEW, facialJoints: 30, progress: (step, share) => { steps.push([step, share]); } });
  assert.deepEqual((await mien.validate(dna.write())).findings, []);
  assert.deepEqual(Object.keys(report.fit.per_shape).sort(), ["puff", "smile"]);
  assert.ok(steps.length > 3 && steps.every(([step], i) => step && (!i || steps[i - 1][1] <= steps[i][1])));
  const rig = mien.createRig(dna);
  dna.dispose();
  assert.deepEqual(rig.names(Kind.RAW_CONTROL), ["smile", "puff"]);
  const [face, pose] = [rig.instance(), rig.deformer.instance()];
  for (const [name, shape] of Object.entries(mesh.shapes)) {
    face.reset();
    face.controls[name] = 1;
    face.evaluate(0);
    pose.update(face);
    pose.deform(0);
    let [left, all] = [0, 0];
    pose.positions(0).forEach((value, i) => {
      left += (value - mesh.positions[i] - shape[i]) ** 2;
      all += shape[i] ** 2;
    });
    assert.ok(left < 0.2 ** 2 * all, `${name}: ${Math.sqrt(left / all)}`);
  }
  for (const object of [face, pose, rig]) object.dispose();
});

test("all ways to give the same mesh give the same bytes", () => {
  const expected = bytesOf(mesh);
  const { positions, faces, shapes } = mesh;
  const sparse = Object.fromEntries(Object.entries(shapes).map(([name, shape]) => {
    const moving = Uint32Array.from(Array(shape.length / 3).keys()).filter((i) =>
      shape[3 * i] || shape[3 * i + 1] || shape[3 * i + 2]);
    return [name, { positions: moving, displacements: Float64Array.from(moving.length * 3 ? [...moving].flatMap((i) =>
      [...shape.subarray(3 * i, 3 * i + 3)]) : []) }];
  }));
  for (const given of [
    { positions: [...positions], faces, shapes: sparse },
    { positions, faces: Uint32Array.from(faces.flat()), faceSizes: new Uint8Array(faces.length).fill(4), shapes },
    { positions, faces: faces.map((face) => Uint32Array.from(face)), shapes: { smile: [...shapes.smile], puff: shapes.puff } },
  ]) assert.deepEqual(bytesOf(given), expected);
  assert.notDeepEqual(bytesOf(mesh, { flags: AuthorFlags.NO_TARGETS }), expected);
});

test("the native program makes the same bytes", () => {
  const folder = mkdtempSync(join(tmpdir(), "mien-"));
  try {
    const [obj, out] = [join(folder, "egg.obj"), join(folder, "egg.dna")];
    const rows = Array.from({ length: ROWS * COLUMNS }, (_, i) => `v ${mesh.positions.slice(3 * i, 3 * i + 3).join(" ")}`);
    const faces = mesh.faces.map((face) => `f ${face.map((i) => i + 1).join(" ")}`);
    writeFileSync(obj, [...rows, ...faces, ""].join("\n"));
    program(["author", obj, "-o", out, "--joints", "12", "--lods", "1", "--quiet"]);
    const made = bytesOf({ ...mesh, shapes: {} });
    assert.ok(Buffer.compare(readFileSync(out), made) === 0);
  } finally {
    rmSync(folder, { recursive: true });
  }
});

test("meshes of LODs are those of the caller", () => {
  const triangles = Uint32Array.from(mesh.faces.flatMap(([a, b, c, d]) => [a, b, c, a, c, d]));
  const [half, few] = [triangles.subarray(0, triangles.length / 6 * 3), [...triangles.subarray(0, 27)]];
  const { dna, report } = mien.authorRig(mesh, { facialJoints: 12, lodMeshes: [half, few] });
  assert.ok(report.own_lod_meshes);
  assert.deepEqual(report.lods.map((lod) => lod.triangles), [triangles.length / 3, half.length / 3, 9]);
  dna.dispose();
  const textured = { ...mesh, uvs: [0, 0, 0.5, 0.5], cornerUvs: new Uint32Array(mesh.faces.length * 4) };
  const cornerUvs = new Uint8Array(27).fill(1);
  const made = mien.authorRig(textured, { facialJoints: 12, lods: 2, lodMeshes: [{ faces: few, cornerUvs }] }).dna;
  assert.deepEqual([...made.read("geom.meshes[1].textureCoordinates.us")], [0.5]);
  made.dispose();
  const refused = (options, words, type = ArgumentError, status = Status.INVALID_ARGUMENT) =>
    assert.throws(() => bytesOf(mesh, { lods: 0, ...options }), fails(type, status, words));
  refused({ lods: 2, lodMeshes: [half, few] }, /lodMeshes are not one/);
  refused({ lodMeshes: [half, few.slice(1)] }, /lodMeshes\[1\] has 26 numbers, which is no multiple of 3/);
  refused({ lodMeshes: [[0, 1, 1.5]] }, /lodMeshes\[0\]\[2\] is 1.5/);
  refused({ lodMeshes: [{ faces: few, cornerUvs: [0] }] }, /cornerUvs of lodMeshes\[0\] has 1 numbers, not 27/);
  refused({ lodMeshes: [half, []] }, /LOD 2 has 0 corners/, AuthorError, Status.AUTHOR_MESH);
  refused({ lodMeshes: [{ faces: few, cornerUvs }] }, /the mesh has none/, AuthorError, Status.AUTHOR_MESH);
});

test("bones and weights of the caller are taken", () => {
  const bones = [
    { name: "root", position: [0, 0, 0], kind: BoneKind.ROOT },
    { name: "head", position: new Float32Array([0, -5, 0]), kind: BoneKind.HEAD },
    { name: "left", position: [4, 0, 7], parent: 1 }, { name: "right", position: [-4, 0, 7], parent: 1 },
  ];
  const count = mesh.positions.length / 3;
  const joints = Uint16Array.from({ length: 2 * count }, (_, i) => (i % 2 ? 1 : mesh.positions[3 * (i >> 1)] > 0 ? 2 : 3));
  const weights = Float32Array.from({ length: 2 * count }, (_, i) => (i % 2 ? 0.25 : 0.75));
  const { dna, report } = mien.authorRig(mesh, { lods: 1, bones, weights: { joints, weights } });
  assert.ok(report.own_bones && report.own_weights);
  assert.deepEqual([...dna.read("geom.meshes[0].skinWeights[0].weights")], [0.75, 0.25]);
  dna.dispose();
  const refused = (options, words, type = ArgumentError, status = Status.INVALID_ARGUMENT) =>
    assert.throws(() => bytesOf(mesh, { bones, ...options }), fails(type, status, words));
  refused({ weights: { joints: joints.slice(1), weights } }, /joints, not as many/);
  refused({ weights: { joints, weights: weights.slice(2) } }, /weights has/);
  refused({ weights: { joints: [...joints].map((joint) => joint + 0.5), weights } }, /joints of weights\[0\] is 3.5/);
  refused({ weights: { joints: [...joints].map((joint) => joint + 65533), weights } }, /is 65536/);
  refused({ influences: 8, weights: { joints, weights } }, /2 influences, not 8/);
  refused({ weights: { joints: joints.map((joint) => joint + 3), weights } }, /bone/, AuthorError, Status.AUTHOR_MESH);
  refused({ bones: undefined, weights: { joints, weights } }, /with bones/);
  refused({ bones: [{ name: "root", position: [1, 2] }] }, /position of bone "root" has 2 numbers, not 3/);
});

test("objects and UVs arrive", () => {
  const faceCount = mesh.faces.length;
  const { dna, report } = mien.authorRig({
    ...mesh, uvs: [0, 0, 1, 1], cornerUvs: Array.from({ length: 4 * faceCount }, (_, i) => i % 2),
    objects: [{ name: "skin", faceCount: faceCount - 20 }, { name: "cap", faceCount: 20 }],
  }, FEW);
  assert.equal(report.mesh.objects, 2);
  const rig = mien.createRig(dna);
  assert.deepEqual(rig.names(Kind.MESH).map((name) => name.split("_")[0]), ["skin", "cap"]);
  const uvs = new Float32Array((2 * mesh.positions.length) / 3).fill(0.5);
  assert.ok(rig.deformer.mesh(0).textureCoordinates.includes(1));
  assert.equal(bytesOf({ ...mesh, uvs }).length > bytesOf(mesh).length, true);
  for (const object of [dna, rig]) object.dispose();
});

test("wrong arrays are named", () => {
  const { positions, faces, shapes } = mesh;
  const refused = (change, words, type = ArgumentError, status = Status.INVALID_ARGUMENT) =>
    assert.throws(() => bytesOf({ ...mesh, ...change }), fails(type, status, words));
  refused({ positions: positions.subarray(1) }, /positions has \d+ numbers, which is no multiple of 3/);
  refused({ positions: "abc" }, /positions is no array/);
  refused({ positions: undefined }, /positions is no array/);
  refused({ faces: [1, 2] }, /faces has 2 numbers/);
  refused({ faces: [0, 1, -2] }, /faces\[2\] is -2/);
  refused({ faces: new Float32Array([0, 1, 2.5]) }, /faces\[2\] is 2.5/);
  refused({ faces: [[0, 1, 2 ** 32]] }, /is 4294967296/);
  refused({ faces: [0, 1, 2], faceSizes: [-3] }, /faceSizes\[0\]/);
  refused({ faceSizes: [4] }, /faceSizes are for corners/);
  refused({ shapes: { smile: shapes.smile.subarray(3) } }, /shape "smile" has/);
  refused({ shapes: { smile: { positions: [1, 2], displacements: [0, 0, 1] } } }, /displacements of shape "smile"/);
  refused({ uvs: [0, 0] }, /uvs has 2 numbers/);
  refused({ uvs: [0, 0], cornerUvs: [0] }, /cornerUvs has 1/);
  refused({ cornerUvs: [0] }, /need uvs/);
  refused({ objects: [{ name: "skin", faceCount: 0.5 }] }, /faceCount of object "skin"/);
  const wrong = (change, words, status = Status.AUTHOR_MESH) => refused(change, words, AuthorError, status);
  wrong({ objects: [{ name: "skin", faceCount: 5 }] }, /face/);
  wrong({ faces: [0, 1, 99999] }, /position/);
  wrong({ faces: [0, 1, 2], faceSizes: [4] }, /corner/);
  wrong({ positions: positions.map(() => NaN) }, /finite/);
  wrong({ shapes: { smile: { positions: [99999], displacements: [0, 0, 1] } } }, /shape/);
  wrong({ shapes: { "": shapes.smile } }, /name/);
  wrong({ positions: positions.map((value, i) => (i % 3 === 2 ? 0 : value)), shapes: {} }, /flat/, Status.AUTHOR_REFUSED);
  assert.throws(() => mien.authorRig({ ...mesh, face: faces }), /AuthorMesh has no "face"; it has/);
  assert.throws(() => mien.authorRig(mesh, { joints: 3 }), /AuthorDesc has no "joints"; it has facialJoints/);
  assert.throws(() => bytesOf(mesh, { lods: 9 }), fails(ArgumentError, Status.INVALID_ARGUMENT, /lods/));
  assert.throws(() => bytesOf(mesh, { up: MeshAxis.X, front: MeshAxis.MINUS_X }),
    fails(ArgumentError, Status.INVALID_ARGUMENT, /axis|angle/));
});

test("progress cancels and may throw, and no memory stays", () => {
  const cancel = () => assert.throws(() => bytesOf(mesh, { progress: (_, share) => share > 0.1 }),
    fails(AuthorError, Status.AUTHOR_CANCELED, /./));
  cancel();
  const before = mien.memoryBytes;
  for (let i = 0; i < 20; ++i) {
    cancel();
    assert.throws(() => bytesOf(mesh, { progress: (step) => { throw new RangeError(step); } }), RangeError);
  }
  assert.equal(mien.memoryBytes, before);
});

test("rigs can be made while another one is", () => {
  let inner;
  const outer = bytesOf(mesh, { progress: () => { inner ??= bytesOf(mesh); } });
  assert.deepEqual(inner, outer);
});

test("the module for baked files says that it makes no rigs", async () => {
  const small = await Mien.load({ wasm: join(packageFolder, "mien-runtime.wasm") });
  assert.throws(() => small.authorRig(mesh), fails(UnsupportedError, Status.UNSUPPORTED, /other one/));
});
