// SPDX-License-Identifier: MIT
// Documents: fields, layers, undoing, every operation, and what is refused.
import assert from "node:assert/strict";
import { test } from "node:test";
import { api, Mien } from "./support.mjs";

const { ArgumentError, Kind, Layer, Match, MienError, Preset, Status, UnsupportedError } = api;
const mien = await Mien.load();

/** Calls use(document, dna) with a generated head. */
function withHead(use) {
  const dna = mien.generate(Preset.SMALL);
  const head = mien.createDocument(dna);
  try {
    use(head, dna);
  } finally {
    head.dispose();
    dna.dispose();
  }
}

const fails = (status) => (error) => {
  assert.ok(error instanceof MienError, String(error));
  assert.equal(error.status, status, error.message);
  return true;
};

test("fields are written, read and undone", () => withHead((head, dna) => {
  const before = dna.write();
  assert.deepEqual(head.toBytes(), before);
  const mark = head.mark();
  head.write("desc.name", "Ada");
  assert.equal(head.read("desc.name"), "Ada");
  assert.deepEqual([...head.bytes("desc.name")], [65, 100, 97]);
  const xs = "defn.neutralJointTranslations.xs";
  head.write(xs, [1.5, 2.5], 1);
  assert.deepEqual([...head.read(xs).subarray(1, 3)], [1.5, 2.5]);
  head.write("desc.gender", 2);
  assert.equal(head.read("desc.gender"), 2);
  assert.deepEqual(head.children(), dna.children());
  assert.equal(head.children("desc")[0], "name");
  head.resize("desc.metadata", 2);
  head.splice("desc.metadata", 0, 1, 3);
  assert.equal(head.field("desc.metadata").count, 4);
  assert.equal(head.validate().errors, 0);
  const changed = head.toBytes();
  // A write that fails leaves the length, too.
  assert.throws(() => head.write("defn.jointHierarchy", [70000]), fails(Status.INVALID_ARGUMENT));
  assert.throws(() => head.write("defn.jointHierarchy", [0.5]), RangeError);
  assert.throws(() => head.write("desc.name", 1), fails(Status.INVALID_ARGUMENT));
  assert.throws(() => head.field("no.such"), fails(Status.NAME));
  assert.throws(() => head.read("desc"), TypeError);
  assert.deepEqual(head.toBytes(), changed);
  head.undo(mark);
  assert.deepEqual(head.toBytes(), before);
  assert.throws(() => head.undo(77), fails(Status.INDEX));
  const empty = mien.createDocument();
  assert.equal(empty.field("defn.jointNames").count, 0);
  empty.dispose();
  assert.throws(() => empty.mark(), ArgumentError);
}));

test("layers are listed anew", () => withHead((head) => {
  assert.equal(head.version, 8);
  const known = head.layers;
  assert.equal(known[0].code, "desc");
  head.addLayer("note", 1, 2, Uint8Array.of(1, 0, 2));
  const dna = head.toDna();
  const again = mien.createDocument(dna);
  dna.dispose();
  assert.deepEqual([...again.layers.at(-1).bytes], [1, 0, 2]);
  assert.equal(again.layers.at(-1).versionMinor, 2);
  assert.throws(() => head.addLayer("desc", 1, 1), fails(Status.INVALID_ARGUMENT));
  head.clearLayers();
  assert.deepEqual([head.layers.length, head.version], [0, 8]);
  for (const { code, versionMajor, versionMinor } of known) head.addLayer(code, versionMajor, versionMinor);
  assert.deepEqual(head.layers, known);
  again.dispose();
}));

test("every operation changes the character", () => withHead((head, dna) => {
  const other = mien.createDocument(dna);
  head.rename(Kind.JOINT, 2, "jaw");
  assert.equal(head.find(Kind.JOINT, "jaw"), 2);
  assert.throws(() => head.find(Kind.JOINT, "no such"), fails(Status.NAME));
  head.setNeutral("jaw", { translations: [1, 2, 3], rotations: [4, 5, 6] });
  assert.equal(head.read("defn.neutralJointTranslations.ys")[2], 2);
  assert.equal(head.read("defn.neutralJointRotations.zs")[2], 6);
  assert.throws(() => head.setNeutral(2, { translations: [1, 2, 3], rotations: [] }), fails(Status.MISMATCH));
  const mesh = head.read("defn.meshNames[0]");
  const { count } = head.field("geom.meshes[0].positions.xs");
  head.setWeights(mesh, 1, new Uint16Array(count).fill(1), new Float32Array(count).fill(0.5));
  head.normalizeWeights(mesh);
  assert.deepEqual([...head.read("geom.meshes[0].skinWeights[0].weights")], [1]);
  head.limitInfluences(mesh, 1);
  head.smoothWeights(mesh, { iterations: 2 });
  head.setTarget(mesh, 0, [1, 0, 0], [7]);
  assert.deepEqual([...head.read("geom.meshes[0].blendShapeTargets[0].vertexIndices")], [7]);
  assert.throws(() => head.setTarget(mesh, 0, [1, 0, 0], []), fails(Status.MISMATCH));
  assert.ok(head.pruneTargets(100).deltas > 0);
  assert.ok(head.pruneJoints({ translation: 1 }).removedCount > 0);
  head.place({ scale: 2, translation: [0, 1, 0] });
  assert.throws(() => head.place({ scale: 0 }), fails(Status.INVALID_ARGUMENT));
  head.conform(mesh, new Float32Array(3 * count).fill(0.5));
  head.setPositions(mesh, new Float32Array(3 * count).fill(0.25));
  assert.equal(head.read("geom.meshes[0].positions.zs")[count - 1], 0.25);
  head.undo();

  head.makeLod(1, 0, { match: Match.UV, keepTargets: true });
  assert.throws(() => head.project(0, 0), fails(Status.INVALID_ARGUMENT));
  head.copyLayers(other, Layer.DESCRIPTOR);
  assert.equal(head.copyMesh(other, mesh), 0);
  head.clearJoints(3);
  head.remove(Kind.JOINT, 3);
  head.remove(Kind.RAW_CONTROL, [0]);
  head.mergeJoints(other, 10);
  head.splitJoints(other);
  head.convert("unreal");
  head.clear(Kind.ANIMATED_MAP);
  head.keepLods([0]);
  const made = head.toDna();
  assert.deepEqual([made.info.lodCount, made.info.animatedMapCount], [1, 0]);
  assert.equal(made.info.rawControlCount, dna.info.rawControlCount - 1);
  made.dispose();
  head.undo();
  const errors = head.transplant(other);
  assert.equal(errors.length, dna.info.rawControlCount);
  assert.ok(errors.every(({ worst, moved }) => worst <= 0.01 * Math.max(1, moved)));
  other.dispose();
}));

test("the module that opens baked files only has no documents", async () => {
  const small = await Mien.load({ bakedOnly: true });
  assert.throws(() => small.createDocument(), UnsupportedError);
});
