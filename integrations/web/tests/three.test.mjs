// SPDX-License-Identifier: MIT
// mien/three with three.js in Node.js: what its objects and its loader make of a rig, against Mien's deformer.
import assert from "node:assert/strict";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { pathToFileURL } from "node:url";
import { api, Mien, mien as program, packageFolder, project } from "./support.mjs";

const { Kind, Preset } = api;
const three = join(project, "build/web/three/node_modules/three");
const missing = existsSync(three) ? false : "three.js was not fetched";
if (missing) console.log(`NOT TESTED: mien/three; ${missing}`);
const options = { skip: missing };

// The package beside three.js, as in a project: a package that is linked would not find it.
const work = mkdtempSync(join(tmpdir(), "mien-three-"));
after(() => rmSync(work, { recursive: true }));
let FaceObject;
let GltfFace;
let THREE;
let GLTFLoader;
if (!missing) {
  mkdirSync(join(work, "node_modules/mien"), { recursive: true });
  symlinkSync(three, join(work, "node_modules/three"));
  for (const name of ["three.js", "api.js"]) {
    writeFileSync(join(work, "node_modules/mien", name), readFileSync(join(packageFolder, name)));
  }
  writeFileSync(join(work, "node_modules/mien/package.json"), readFileSync(join(packageFolder, "package.json")));
  writeFileSync(join(work, "all.mjs"), `export * as THREE from "three";
    export { FaceObject, GltfFace } from "mien/three";
    export { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";`);
  globalThis.self ??= globalThis; // for the loader
  ({ FaceObject, GltfFace, THREE, GLTFLoader } = await import(pathToFileURL(join(work, "all.mjs")).href));
}
const mien = await Mien.load();
const dna = mien.generate(Preset.HEAD);
const EXPRESSION = { jawOpen: 1, mouthSmileLeft: 0.5, eyeBlinkRight: 1, browInnerUp: 0.75 };

/** Positions of the vertices of a mesh, by Mien's deformer. */
function deformed(rig, face, mesh) {
  const pose = rig.deformer.instance();
  pose.update(face);
  const { vertexCount } = rig.deformer.mesh(mesh);
  const positions = new Float32Array(3 * vertexCount);
  pose.writeVertices(mesh, positions);
  pose.dispose();
  return positions;
}

/** How far positions are apart: root mean square, and the most. */
function apart(a, b) {
  assert.equal(a.length, b.length);
  let [sum, most] = [0, 0];
  for (let i = 0; i < a.length; i += 3) {
    const distance = Math.hypot(a[i] - b[i], a[i + 1] - b[i + 1], a[i + 2] - b[i + 2]);
    sum += distance ** 2;
    most = Math.max(most, distance);
  }
  return { rms: Math.sqrt(sum / (a.length / 3)), most };
}

test("Mien writes the vertices of the shown meshes", options, () => {
  const rig = mien.createRig(dna);
  const object = new FaceObject(rig);
  Object.assign(object.face.controls, EXPRESSION);
  object.update();
  const shown = object.children.filter((mesh) => mesh.visible);
  assert.ok(shown.length > 3);
  for (const mesh of shown) {
    assert.deepEqual(mesh.geometry.attributes.position.array, deformed(rig, object.face, mesh.userData.index));
  }
  object.dispose();
  assert.equal(object.children.length, 0);
  rig.dispose();
});

test("the GPU gets matrices and weights that move vertices as Mien does", options, () => {
  const rig = mien.createRig(dna);
  const object = new FaceObject(rig, { skinning: "gpu" });
  Object.assign(object.face.controls, EXPRESSION);
  object.update();
  const mesh = object.children.find(({ visible, userData }) => visible && userData.kind === "skin");
  const { position, skinIndex, skinWeight } = mesh.geometry.attributes;
  const targets = mesh.geometry.morphAttributes.position;
  const [place, moved, matrix] = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Matrix4()];
  const found = new Float32Array(3 * position.count);
  for (let i = 0; i < position.count; ++i) {
    place.fromBufferAttribute(position, i);
    targets.forEach((target, k) => place.addScaledVector(moved.fromBufferAttribute(target, i), mesh.morphTargetInfluences[k]));
    const sum = new THREE.Vector3();
    for (let k = 0; k < 4; ++k) {
      matrix.fromArray(mesh.skeleton.boneMatrices, 16 * skinIndex.array[4 * i + k]);
      sum.addScaledVector(moved.copy(place).applyMatrix4(matrix), skinWeight.array[4 * i + k]);
    }
    sum.toArray(found, 3 * i);
  }
  // In centimeters; a fifth of the vertices have more than four influences.
  const { rms, most } = apart(found, deformed(rig, object.face, mesh.userData.index));
  assert.ok(rms < 0.1 && most < 1, `${rms} and ${most} cm`);
  assert.ok(mesh.morphTargetInfluences.some((weight) => weight !== 0));
  object.dispose();
  rig.dispose();
});

test("LODs follow the distance of the camera", options, () => {
  const rig = mien.createRig(dna);
  const object = new FaceObject(rig);
  const camera = new THREE.PerspectiveCamera();
  const lods = [0.5, 0.79, 1.7, 3.3, 7, 1000].map((distance) => {
    camera.position.copy(object.center).add(new THREE.Vector3(0, 0, distance));
    return object.lodOf(camera);
  });
  assert.deepEqual(lods, [0, 0, 1, 2, 3, object.lodCount - 1]);
  object.lod = 4;
  assert.deepEqual(object.children.filter((mesh) => mesh.visible && mesh.userData.kind !== "film").map((mesh) => mesh.name).sort(),
    Array.from(rig.lodIndices(Kind.MESH, 4), (mesh) => rig.name(Kind.MESH, mesh))
      .filter((name) => object.children.find((mesh) => mesh.name === name).userData.kind !== "film").sort());
  object.lod = 99;
  assert.equal(object.lod, object.lodCount - 1);
  object.dispose();
  rig.dispose();
});

test("an exported GLB that the loader of three.js reads is driven by the names of its joints", options, async () => {
  const [file, glb] = [join(work, "head.dna"), join(work, "head.glb")];
  writeFileSync(file, dna.write());
  program(["export", file, "-o", glb, "--skeleton", "--lod", "2", "--quiet"]);
  const { buffer, byteOffset, length } = readFileSync(glb);
  const { scene } = await new GLTFLoader().parseAsync(buffer.slice(byteOffset, byteOffset + length), "");
  const rig = await mien.openRig(readFileSync(file), { system: "gltf" });
  const driven = new GltfFace(scene, rig);
  assert.ok(driven.found.joints > 50 && driven.found.targets > 10, JSON.stringify(driven.found));
  Object.assign(driven.face.controls, EXPRESSION);
  driven.update(2);
  scene.updateMatrixWorld(true);
  let compared = 0;
  scene.traverse((mesh) => {
    if (!mesh.isMesh) return;
    const index = rig.find(Kind.MESH, mesh.name) ?? rig.find(Kind.MESH, mesh.parent.name);
    assert.ok(index !== undefined, mesh.name);
    mesh.skeleton?.update();
    const expected = deformed(rig, driven.face, index);
    const found = new Float32Array(expected.length);
    assert.equal(mesh.geometry.attributes.position.count * 3, expected.length, mesh.name);
    const vertex = new THREE.Vector3();
    for (let i = 0; i < expected.length / 3; ++i) {
      mesh.getVertexPosition(i, vertex).applyMatrix4(mesh.matrixWorld).toArray(found, 3 * i);
    }
    // In meters; four influences, fitted.
    const { rms, most } = apart(found, expected);
    assert.ok(rms < 2e-4 && most < 3e-3, `${mesh.name}: ${rms} and ${most} m`);
    ++compared;
  });
  assert.ok(compared > 3);
  assert.throws(() => new GltfFace(new THREE.Group(), rig), TypeError);
  driven.dispose();
  rig.dispose();
});
