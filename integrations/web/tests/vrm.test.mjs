// SPDX-License-Identifier: MIT
// A VRM that `mien export` wrote, in a headless Chromium with three.js and three-vrm, the library most programs for such
// characters use: it has to load, have a person's bones, and move as its targets say.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { serve } from "../serve.mjs";
import { findChromium, Page } from "./browser.mjs";

const project = fileURLToPath(new URL("../../..", import.meta.url));
const program = process.env.MIEN_BIN ?? join(project, "build/release/bin/mien");
const three = join(project, "build/web/three/node_modules/three");
const vrm = join(project, "build/web/tools/node_modules/@pixiv/three-vrm");
const chromium = findChromium();
const missing = !existsSync(three) || !existsSync(vrm) ? "three.js or three-vrm was not fetched"
  : !chromium ? "there is no Chromium" : null;
if (missing) console.log(`NOT TESTED: VRM in three-vrm; ${missing}`);
const options = { skip: missing ?? false };

const work = mkdtempSync(join(tmpdir(), "mien-vrm-"));
const mien = (...args) => execFileSync(program, [...args, "--quiet"], { stdio: ["ignore", "pipe", "inherit"] });
let server;
let page;

const HTML = `<!doctype html><meta charset="utf-8"><title>VRM</title><link rel="icon" href="data:,">
<script type="importmap">{"imports": {"three": "./three/build/three.module.js", "three/addons/": "./three/examples/jsm/"}}</script>
<script type="module">
import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { VRMLoaderPlugin } from "./vrm/lib/three-vrm.module.js";
window.THREE = THREE;
window.open = async (url) => {
  const loader = new GLTFLoader();
  loader.register((parser) => new VRMLoaderPlugin(parser));
  const gltf = await loader.loadAsync(url);
  window.vrm = gltf.userData.vrm;
  window.meshes = [];
  vrm.scene.traverse((object) => { if (object.isMesh) meshes.push(object); });
  vrm.scene.updateMatrixWorld(true);
};
/** Where vertices of all meshes are, as the GPU has them. */
window.places = () => meshes.flatMap((mesh) => {
  const place = new THREE.Vector3();
  const all = [];
  for (let i = 0; i < mesh.geometry.attributes.position.count; i += 7) {
    mesh.getVertexPosition(i, place);
    all.push(...place.toArray());
  }
  return all;
});
document.body.dataset.ready = "yes";
</script>`;

before(async () => {
  if (missing) return;
  mien("demo-head", "-o", join(work, "head.dna"));
  mien("gen", "--preset", "metahuman-head", "-o", join(work, "metahuman.dna"));
  for (const [name, rig, set] of [["head", "head", "vrm,arkit"], ["metahuman", "metahuman", "vrm"]]) {
    mien("export", join(work, `${rig}.dna`), "-o", join(work, `${name}.vrm`), "--bake", set, "--lod", "3", "--author", "A. Artist");
  }
  mien("gen", "--preset", "metahuman-body", "-o", join(work, "body.dna"));
  symlinkSync(three, join(work, "three"));
  symlinkSync(vrm, join(work, "vrm"));
  writeFileSync(join(work, "index.html"), HTML);
  server = await serve(work);
  page = await Page.open(chromium, { width: 320, height: 240 });
  await page.goto(server.url);
  await page.until("() => document.body.dataset.ready", "loaded");
});

after(async () => {
  await page?.close();
  server?.close();
  rmSync(work, { recursive: true });
});

const BONES = ["hips", "spine", "head", ...["left", "right"].flatMap((side) =>
  ["UpperLeg", "LowerLeg", "Foot", "UpperArm", "LowerArm", "Hand"].map((bone) => side + bone))];
const PRESETS = ["happy", "angry", "sad", "relaxed", "surprised", "aa", "ih", "ou", "ee", "oh", "blink", "blinkLeft",
  "blinkRight", "lookUp", "lookDown", "lookLeft", "lookRight"];

for (const name of ["head", "metahuman"]) {
  test(`three-vrm loads ${name}.vrm`, options, async () => {
    await page.run((url) => window.open(url), `./${name}.vrm`);
    const found = await page.run((bones) => ({
      version: vrm.meta.metaVersion, authors: vrm.meta.authors,
      bones: bones.filter((bone) => vrm.humanoid.getRawBoneNode(bone) !== null),
      presets: Object.keys(vrm.expressionManager.presetExpressionMap),
      customs: Object.keys(vrm.expressionManager.customExpressionMap).length, look: vrm.lookAt !== undefined,
    }), BONES);
    assert.equal(found.version, "1");
    assert.deepEqual(found.authors, ["A. Artist"]);
    assert.deepEqual(found.bones, BONES);
    for (const preset of PRESETS) assert.ok(found.presets.includes(preset), preset);
    assert.equal(found.customs, name === "head" ? 52 : 0);
    assert.ok(found.look);
    assert.deepEqual(page.errors, []);
  });
}

test("expressions move vertices by their targets, and the head turns them", options, async () => {
  await page.run((url) => window.open(url), "./head.vrm");
  const off = await page.run((presets) => {
    const neutral = places();
    const result = {};
    for (const name of presets) {
      vrm.expressionManager.resetValues();
      vrm.expressionManager.setValue(name, 1);
      vrm.update(0);
      const moved = places();
      result[name] = Math.max(...moved.map((value, i) => Math.abs(value - neutral[i])));
    }
    vrm.expressionManager.resetValues();
    vrm.update(0);
    result.rest = Math.max(...places().map((value, i) => Math.abs(value - neutral[i])));
    vrm.humanoid.getNormalizedBoneNode("head").rotation.y = 0.5;
    vrm.update(0);
    vrm.scene.updateMatrixWorld(true);
    result.turned = Math.max(...places().map((value, i) => Math.abs(value - neutral[i])));
    vrm.humanoid.getNormalizedBoneNode("head").rotation.y = 0;
    vrm.update(0);
    return result;
  }, PRESETS);
  for (const name of PRESETS) assert.ok(off[name] > 0.0005 && off[name] < 0.1, `${name} moves by ${off[name]} m`);
  assert.equal(off.rest, 0);
  assert.ok(off.turned > 0.01, `${off.turned}`);
});

test("looking to the left turns the eyes to the character's left", options, async () => {
  await page.run((url) => window.open(url), "./head.vrm");
  const weights = await page.run(() => {
    const target = new THREE.Object3D();
    target.position.set(1, vrm.humanoid.getRawBoneNode("head").getWorldPosition(new THREE.Vector3()).y, 1); // +x is the left
    vrm.scene.add(target);
    vrm.scene.updateMatrixWorld(true);
    vrm.lookAt.target = target;
    vrm.update(1 / 60);
    return Object.fromEntries(["lookLeft", "lookRight"].map((name) => [name, vrm.expressionManager.getValue(name)]));
  });
  assert.ok(weights.lookLeft > 0.9, JSON.stringify(weights));
  assert.equal(weights.lookRight, 0);
});

test("a rig without a face is refused, and leaves nothing", options, () => {
  const out = join(work, "body.vrm");
  let failure;
  try {
    execFileSync(program, ["export", join(work, "body.dna"), "-o", out], { stdio: ["ignore", "pipe", "pipe"] });
  } catch (error) {
    failure = error;
  }
  assert.equal(failure?.status, 2);
  assert.match(failure.stderr.toString(), /controls of none of the expressions/);
  assert.ok(!existsSync(out));
});

test("what the file says is what VRM 1.0 requires", options, () => {
  const bytes = readFileSync(join(work, "head.vrm"));
  const json = JSON.parse(bytes.toString("utf8", 20, 20 + bytes.readUInt32LE(12)));
  const { VRMC_vrm: extension } = json.extensions;
  assert.ok(json.extensionsUsed.includes("VRMC_vrm"));
  assert.equal(extension.specVersion, "1.0");
  assert.equal(extension.meta.licenseUrl, "https://vrm.dev/licenses/1.0/");
  assert.ok(extension.meta.name && extension.meta.authors.length > 0);
  // Each bone is a node of its own, below the one it hangs from.
  const parents = new Map(json.nodes.flatMap(({ children = [] }, n) => children.map((child) => [child, n])));
  const bones = extension.humanoid.humanBones;
  const nodes = Object.values(bones).map(({ node }) => node);
  assert.equal(new Set(nodes).size, nodes.length);
  const isBelow = (bone, above) => {
    let at = bones[bone].node;
    while (at !== undefined && at !== bones[above].node) at = parents.get(at);
    return at !== undefined;
  };
  for (const bone of BONES.slice(1)) assert.ok(isBelow(bone, "hips"), bone);
  for (const bone of ["head", "leftUpperArm", "rightUpperArm"]) assert.ok(isBelow(bone, "spine"), bone);
  for (const { morphTargetBinds } of Object.values(extension.expressions.preset)) {
    assert.ok(morphTargetBinds.length > 0);
    for (const { node, index } of morphTargetBinds) {
      assert.ok(index < json.meshes[json.nodes[node].mesh].primitives[0].targets.length);
    }
  }
});
