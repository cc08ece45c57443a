// SPDX-License-Identifier: MIT
// The viewer in a headless Chromium, used as people use it.
import assert from "node:assert/strict";
import { copyFileSync, existsSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { deflateSync } from "node:zlib";
import { asEye } from "../viewer/cornea.js";
import { mien, project, sameBits } from "./support.mjs";
import { baked, choose, dna, folder, frames, missing, numbers, open, options, page, press, server, slide, text, work } from "./viewer_page.mjs";

/** The middle of the canvas, as 64 x 64 pixels. */
const canvas = () => page.run(async () => {
  const { renderer, scene, camera, canvas: element } = window.viewer.stage;
  renderer.render(scene, camera);
  const copy = new OffscreenCanvas(64, 64);
  const context = copy.getContext("2d");
  context.drawImage(element, 0, 0, 64, 64);
  const { data } = context.getImageData(0, 0, 64, 64);
  return Array.from(data);
});

/** Structural similarity of the brightness of two images of 64 x 64 pixels, in windows of 8 x 8. */
function similarity(a, b) {
  const gray = (image) => Float64Array.from({ length: 4096 }, (_, i) => 0.3 * image[4 * i] + 0.59 * image[4 * i + 1] + 0.11 * image[4 * i + 2]);
  const [x, y] = [gray(a), gray(b)];
  let sum = 0;
  for (let window = 0; window < 64; ++window) {
    let [mx, my, xx, yy, xy] = [0, 0, 0, 0, 0];
    for (let i = 0; i < 64; ++i) {
      const at = ((window >> 3) * 8 + (i >> 3)) * 64 + (window & 7) * 8 + (i & 7);
      mx += x[at] / 64;
      my += y[at] / 64;
      xx += (x[at] * x[at]) / 64;
      yy += (y[at] * y[at]) / 64;
      xy += (x[at] * y[at]) / 64;
    }
    const [c1, c2] = [6.5025, 58.5225];
    sum += ((2 * mx * my + c1) * (2 * (xy - mx * my) + c2)) /
      ((mx * mx + my * my + c1) * (xx - mx * mx + yy - my * my + c2));
  }
  return sum / 64;
}

test("the page opens without errors and asks no other place for anything", options, async () => {
  assert.match(await text("welcome"), /Nothing is sent anywhere/);
  assert.deepEqual(page.errors, []);
  assert.ok(page.requests.length > 5);
  for (const address of page.requests) assert.ok(address.startsWith(server.url), address);
});

test("the page cannot send anything elsewhere", options, async () => {
  const reached = await page.run(() => fetch("https://example.org/", { mode: "no-cors" }).then(() => true, () => false));
  assert.equal(reached, false);
  assert.ok(page.errors.splice(0).some((error) => /Content Security Policy/.test(error)));
});

test("a file that is no rig gives a message and leaves the page alive", options, async () => {
  const bad = join(work, "bad.dna");
  writeFileSync(bad, readFileSync(dna).subarray(0, 5000));
  await open(bad);
  assert.match(await text("error"), /bad\.dna could not be opened: .* \(at byte \d+\)/);
  for (const [name, content] of [["text.dna", "hello"], ["empty.dna", ""], ["x.glb", "glTF1234"], ["x.json", "{"]]) {
    writeFileSync(join(work, name), content);
    await open(join(work, name));
    assert.match(await text("error"), new RegExp(`${name.replace(".", "\\.")} could not be opened`));
  }
  assert.match(await text("file"), /No file is open/);
  page.errors.length = 0; // each was written to the console, too
});

test("the built-in head opens by its button", options, async () => {
  await page.run(() => document.getElementById("head").click());
  await page.until("() => window.viewer.model", "generated", 120);
  await page.until("() => !document.body.hasAttribute('aria-busy')", "done");
  await frames();
  assert.equal(await text("file"), "Built-in head");
  assert.equal(await text("count"), "72 controls");
  assert.match(await text("facts"), /110 joints.*8 LODs/);
  assert.deepEqual(await seenMeshes(/lash|brow/), ["brows_lod0_mesh"]); // cards of lashes need a texture
  assert.deepEqual(page.errors, []);
});

const seenMeshes = async (pattern) => (await page.run(() => window.viewer.model.object.children.filter((mesh) => mesh.visible).map((mesh) => mesh.name)))
  .filter((name) => pattern.test(name));

/** The bytes of a PNG of 2 x 2 pixels: the color above, black below. */
function png(color) {
  const chunk = (kind, body) => {
    const data = Buffer.concat([Buffer.from(kind), body]);
    const [size, check] = [Buffer.alloc(4), Buffer.alloc(4)];
    size.writeUInt32BE(body.length);
    check.writeUInt32BE(checksum(data));
    return Buffer.concat([size, data, check]);
  };
  const rows = Buffer.from([0, ...color, ...color, 0, 0, 0, 0, 0, 0, 0]);
  return Buffer.concat([Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]),
    chunk("IHDR", Buffer.from([0, 0, 0, 2, 0, 0, 0, 2, 8, 2, 0, 0, 0])), chunk("IDAT", deflateSync(rows)),
    chunk("IEND", Buffer.alloc(0))]);
}

/** CRC-32 as PNG has it; node:zlib has it in newer versions only. */
function checksum(bytes) {
  let sum = ~0;
  for (const byte of bytes) {
    sum ^= byte;
    for (let bit = 0; bit < 8; ++bit) sum = (sum >>> 1) ^ (sum & 1 ? 0xedb88320 : 0);
  }
  return ~sum >>> 0;
}

const materialOf = (mesh) => page.run((name) => {
  const { material } = window.viewer.model.object.children.find((child) => child.name === name);
  const { map, normalMap, roughnessMap, roughness, opacity, color, vertexColors } = material;
  return { map: map?.image.width ?? null, normalMap: normalMap?.image.width ?? null, opacity, roughness, vertexColors,
    roughnessMap: roughnessMap?.image.width ?? null, color: color.toArray() };
}, mesh);

test("materials beside a rig are shown, with their textures", options, async () => {
  const file = join(work, "head.materials.json");
  const paths = ["color.png", "normal.png", "rough.png"].map((name) => join(work, name));
  writeFileSync(paths[0], png([255, 0, 0]));
  writeFileSync(paths[1], png([128, 128, 255]));
  writeFileSync(paths[2], png([200, 200, 200]));
  writeFileSync(file, JSON.stringify({
    materials: [
      { name: "skin", roughness: 0.9, textures: { base_color: "color.png", normal: "maps/normal.png", roughness: "rough.png" } },
      { name: "tooth", base_color: [0, 0.25, 1, 0.5] },
      { name: "lost", textures: { base_color: "lost.png" } },
      { name: "card", alpha_cutoff: 0.3, textures: { base_color: "color.png", roughness: "rough.png" } },
    ],
    meshes: { head_lod0_mesh: "skin", teeth_lod0_mesh: "tooth", tongue_lod0_mesh: "lost", hair_lod0_mesh: "card", lashes_lod0_mesh: "card" },
  }));
  await open(dna, file, ...paths);
  assert.deepEqual(await materialOf("head_lod0_mesh"), {
    map: 2, normalMap: 2, roughnessMap: 2, roughness: 0.9, opacity: 1, vertexColors: false, color: [1, 1, 1] });
  const tooth = await materialOf("teeth_lod0_mesh");
  assert.deepEqual([tooth.map, tooth.opacity, tooth.color, tooth.vertexColors], [null, 0.5, [0, 0.25, 1], false]);
  assert.match(await text("error"), /Some textures are missing: lost\.png/);
  assert.deepEqual(await seenMeshes(/lash/), ["lashes_lod0_mesh"]);
  // A texture is the roughness itself; edges of cards are smooth.
  assert.equal((await materialOf("hair_lod0_mesh")).roughness, 1);
  assert.deepEqual(await page.run(() => {
    const { alphaTest, alphaToCoverage } = window.viewer.model.object.children.find((child) => child.name === "hair_lod0_mesh").material;
    return [alphaTest, alphaToCoverage];
  }), [0.3, true]);
  const reds = (await canvas()).filter((value, i, all) => i % 4 === 0 && value > 40 && all[i + 2] < value / 3).length;
  assert.ok(reds > 100, `${reds} of 4096 pixels are red`);
  // They stay when the rig is opened with other options, and go with another rig.
  await page.run(() => { window.viewerModel = window.viewer.model; });
  await choose("films", true);
  await page.until("() => window.viewer.model !== window.viewerModel && !document.body.hasAttribute('aria-busy')", "reopened");
  assert.equal((await materialOf("head_lod0_mesh")).map, 2);
  await choose("films", false);
  await page.until("() => !document.body.hasAttribute('aria-busy')", "reopened");
  writeFileSync(file, "[1]");
  await open(dna, file);
  assert.match(await text("error"), /head\.materials\.json could not be read: it is no list of materials/);
  assert.equal((await materialOf("head_lod0_mesh")).map, null);
  await open(dna);
});

test("sliders give the values of the native program, bit for bit", options, async () => {
  await open(baked);
  assert.equal(await text("file"), "head.rig");
  await slide("jawOpen", 0.6);
  await slide("mouthSmileLeft", 0.75);
  await frames();
  const raw = await numbers("window.viewer.model.face.rawControls");
  const native = JSON.parse(mien(["eval", baked, "--isa", "scalar", "--input", "-", "--quiet"],
    JSON.stringify({ frames: [{ raw: Array.from(raw) }] }))).frames[0].lods[0];
  assert.ok(raw.filter((value) => value !== 0).length === 2);
  assert.ok(sameBits(await numbers("window.viewer.model.face.joints"), native.joints));
  assert.ok(sameBits(await numbers("window.viewer.model.face.blendShapes"), native.blend_shapes));
  assert.ok(sameBits(await numbers("window.viewer.model.face.animatedMaps"), native.animated_maps));
});

test("scalar and vector kernels show the same vertices", options, async () => {
  const positions = () => numbers("window.viewer.model.object.children[0].geometry.attributes.position.array.subarray(0, 3000)");
  const vectors = await positions();
  await page.run(() => { window.viewerModel = window.viewer.model; });
  await choose("isa", "1");
  await page.until("() => window.viewer.model !== window.viewerModel && !document.body.hasAttribute('aria-busy')", "reopened");
  await frames();
  assert.equal(await page.run(() => window.viewer.model.rig.info.isa), 1);
  assert.ok(sameBits(await positions(), vectors));
  await page.run(() => { window.viewerModel = window.viewer.model; });
  await choose("isa", "2");
  await page.until("() => window.viewer.model !== window.viewerModel && !document.body.hasAttribute('aria-busy')", "reopened");
});

test("skin ends softly and in red where light does, other materials do not", options, async () => {
  // Gray skin alone, lit from the side: the terminator runs down the middle of the face.
  const redness = await page.run(() => {
    const { stage, model } = window.viewer;
    const { renderer, scene, camera, canvas: element } = stage;
    const shown = model.object.children.filter(({ visible }) => visible);
    const skin = shown.find(({ userData }) => userData.kind === "skin").material;
    for (const mesh of shown) mesh.visible = mesh.material === skin;
    const { color, vertexColors, map, onBeforeCompile, customProgramCacheKey } = skin;
    const before = color.getHex();
    stage.lights.choose("Side");
    Object.assign(skin, { vertexColors: false, map: null });
    color.set(0xc0c0c0);
    const measure = () => {
      skin.needsUpdate = true;
      renderer.render(scene, camera);
      const context = new OffscreenCanvas(64, 64).getContext("2d");
      context.drawImage(element, 0, 0, 64, 64);
      const { data } = context.getImageData(0, 0, 64, 64);
      const found = [];
      for (let i = 0; i < data.length; i += 4) {
        if (data[i + 3] === 255 && data[i] > 40) found.push(data[i] / data[i + 2]);
      }
      return found;
    };
    const soft = measure();
    delete skin.onBeforeCompile;
    delete skin.customProgramCacheKey;
    const hard = measure();
    Object.assign(skin, { vertexColors, map, onBeforeCompile, customProgramCacheKey, needsUpdate: true });
    color.set(before);
    for (const mesh of shown) mesh.visible = true;
    stage.lights.choose("Studio");
    const most = Math.max(...hard);
    return { redder: soft.filter((of) => of > 1.05 * most).length, most, of: soft.length, lit: hard.length };
  });
  await frames();
  // Redder than anything is with a hard edge: a band along the terminator. Light reaches farther, too.
  assert.ok(redness.redder > 15 && redness.of > redness.lit, JSON.stringify(redness));
  assert.deepEqual(page.errors, []);
});

test("what is no cornea leaves a material as it is", () => {
  for (const given of [{}, "deep", { depth: 0.4 }, { depth: -1, iris: 0.2 }, { depth: 0.4, iris: 0.6 }, { depth: NaN, iris: 0.2 },
    { depth: "0.4", iris: 0.2 }, { depth: 1.5, iris: 0.2 }]) {
    assert.deepEqual(asEye({ map: {} }, given), { map: {} });
  }
  assert.deepEqual(asEye({ map: null }, { depth: 0.4, iris: 0.2 }), { map: null });
  assert.equal(typeof asEye({ map: {} }, { depth: 0.4, iris: 0.2 }).onBeforeCompile, "function");
});

test("irises are seen through the cornea: behind its apex from the side, in place from the front", options, async () => {
  const head = join(work, "textured.dna"), textures = join(work, "textures");
  mien(["demo-head", "-o", head, "--textures", textures, "--quiet"]);
  await open(head, join(work, "textured.materials.json"), ...readdirSync(textures).map((name) => join(textures, name)));
  const seen = await page.run(async () => {
    const { stage, model } = window.viewer;
    const { renderer, scene, camera, canvas: element } = stage;
    const eye = model.object.children.find(({ name }) => name === "eyeLeft_lod0_mesh");
    const shown = model.object.children.filter(({ visible }) => visible);
    for (const mesh of shown) mesh.visible = mesh === eye;
    const box = eye.geometry.boundingBox ?? (eye.geometry.computeBoundingBox(), eye.geometry.boundingBox);
    const middle = camera.position.clone().copy(box.min).add(box.max).multiplyScalar(0.5).applyMatrix4(eye.matrixWorld);
    const radius = (box.max.x - box.min.x) / 2 * eye.matrixWorld.getMaxScaleOnAxis();
    const { near } = camera;
    camera.near = radius;
    camera.updateProjectionMatrix();
    /** Mean place of the pixels of the pupil, in radii of the eye to the right of its middle; and how many there are. */
    const pupil = () => {
      renderer.render(scene, camera);
      const context = new OffscreenCanvas(element.width, element.height).getContext("2d");
      context.drawImage(element, 0, 0);
      const { data, width } = context.getImageData(0, 0, element.width, element.height);
      let [sum, count] = [0, 0];
      for (let i = 0; i < data.length; i += 4) {
        if (data[i + 3] < 255 || data[i] + data[i + 1] + data[i + 2] > 60) continue;
        sum += i / 4 % width;
        ++count;
      }
      const scale = element.height / 2 / Math.tan(camera.fov * Math.PI / 360) / (8 * radius);
      return [(sum / count - width / 2) / scale / radius, count];
    };
    const measure = (degrees) => {
      const angle = degrees * Math.PI / 180;
      camera.position.set(Math.sin(angle), 0, Math.cos(angle)).multiplyScalar(8 * radius).add(middle);
      camera.lookAt(middle);
      camera.updateMatrixWorld();
      const through = pupil();
      const { onBeforeCompile, customProgramCacheKey } = eye.material;
      delete eye.material.onBeforeCompile;
      delete eye.material.customProgramCacheKey;
      eye.material.needsUpdate = true;
      const painted = pupil();
      Object.assign(eye.material, { onBeforeCompile, customProgramCacheKey, needsUpdate: true });
      return { through, painted };
    };
    const found = { front: measure(0), left: measure(45), right: measure(-45) };
    camera.near = near;
    for (const mesh of shown) mesh.visible = true;
    stage.lookAt("Head");
    camera.updateProjectionMatrix();
    return found;
  });
  const moved = ({ through, painted }) => through[0] - painted[0];
  const what = JSON.stringify(seen);
  for (const { through, painted } of Object.values(seen)) assert.ok(through[1] > 50 && painted[1] > 50, what);
  assert.ok(Math.abs(moved(seen.front)) < 0.04, what);
  // The iris is 2.6 mm deep, in an eye with a radius of 12 mm.
  assert.ok(moved(seen.left) > 0.03 && moved(seen.left) < 0.2 && moved(seen.right) < -0.03 && moved(seen.right) > -0.2, what);
  assert.deepEqual(page.errors, []);
  await open(dna);
});

test("the key light casts the shadow of the head on its neck, and none on the forehead", options, async () => {
  const seen = await page.run(async () => {
    const { stage } = window.viewer;
    const { renderer, scene, camera, canvas: element, regions: { Eyes, Mouth } } = stage;
    stage.lights.choose("Noon");
    stage.lookAt("Head");
    await new Promise(requestAnimationFrame);
    const apart = Eyes.center.y - Mouth.center.y;
    const brightness = () => {
      renderer.render(scene, camera);
      const context = new OffscreenCanvas(element.width, element.height).getContext("2d");
      context.drawImage(element, 0, 0);
      return [Eyes.center.y + 0.6 * apart, Mouth.center.y - 1.5 * apart].map((y) => {
        const place = Mouth.center.clone().setY(y).project(camera);
        const { data } = context.getImageData(Math.round((place.x + 1) / 2 * element.width) - 3,
          Math.round((1 - place.y) / 2 * element.height) - 3, 7, 7);
        return data.filter((_, i) => i % 4 === 1).reduce((sum, value) => sum + value, 0) / 49;
      });
    };
    const key = scene.children.find(({ castShadow }) => castShadow);
    const shaded = brightness();
    key.castShadow = false;
    const plain = brightness();
    stage.lights.choose("Studio");
    return { shaded, plain };
  });
  const [forehead, neck] = seen.shaded.map((value, i) => value / seen.plain[i]);
  assert.ok(seen.plain.every((value) => value > 30) && neck < 0.85 && Math.abs(forehead - 1) < 0.03, JSON.stringify(seen));
  await frames();
  assert.deepEqual(page.errors, []);
});

test("an open mouth is seen, and skinning on the GPU shows nearly the same", options, async () => {
  await page.run(() => document.getElementById("neutral").click());
  await frames();
  const neutral = await canvas();
  assert.ok(neutral.filter((_, i) => i % 4 === 3).filter((alpha) => alpha > 0).length > 400);
  assert.ok(neutral.filter((_, i) => i % 4 === 3).filter((alpha) => alpha === 0).length > 200);
  await slide("jawOpen", 1);
  await frames();
  const opened = await canvas();
  assert.ok(similarity(neutral, neutral) > 0.999);
  const changed = similarity(neutral, opened);
  assert.ok(changed < 0.997, `similarity of neutral and open mouth: ${changed}`);
  await page.run(() => { window.viewerModel = window.viewer.model; });
  await choose("skinning", "gpu");
  await page.until("() => window.viewer.model !== window.viewerModel && !document.body.hasAttribute('aria-busy')", "reopened");
  await frames(4);
  const gpu = similarity(await canvas(), opened);
  assert.ok(1 - gpu < (1 - changed) / 2, `similarity of Mien's and the GPU's skinning: ${gpu}`);
  await page.run(() => { window.viewerModel = window.viewer.model; });
  await choose("skinning", "mien");
  await page.until("() => window.viewer.model !== window.viewerModel && !document.body.hasAttribute('aria-busy')", "reopened");
  assert.deepEqual(page.errors, []);
});

test("expressions, search, LODs, skeleton and heat map", options, async () => {
  await page.run(() => [...document.querySelectorAll("#preset-buttons button")].find((button) => button.textContent === "Surprise").click());
  await frames();
  assert.equal(await page.run(() => window.viewer.model.face.controls.browInnerUp), Math.fround(0.9));
  await page.run(() => {
    const search = document.getElementById("search");
    search.value = "smile left";
    search.dispatchEvent(new Event("input"));
  });
  assert.equal(await text("count"), "1 of 72");
  await page.run(() => document.querySelector("#list li:not([hidden]) button").click());
  assert.match(await text("inspected"), /mouthSmileLeft at 1 moves \d+ joints/);
  assert.ok(await page.run(() => document.querySelectorAll("#moved li").length) > 3);
  await choose("lod", "4");
  await choose("bones", true);
  await choose("heat", true);
  await choose("wire", true);
  await frames(4);
  assert.equal(await page.run(() => window.viewer.model.object.lod), 4);
  assert.match(await text("heat-legend"), /moved by \d+\.\d mm/);
  for (const id of ["bones", "heat", "wire"]) await choose(id, false);
  await choose("lod", "0");
  await choose("auto-lod", true);
  await page.run(() => window.viewer.stage.camera.position.multiplyScalar(8));
  await page.run(() => window.viewer.stage.request());
  await frames(4);
  assert.ok(await page.run(() => window.viewer.model.object.lod) > 1);
  await choose("auto-lod", false);
  assert.deepEqual(page.errors, []);
});

test("poses are downloaded in the form that they are opened in", options, async () => {
  await open(baked);
  await slide("jawOpen", 0.4);
  const saved = await page.run(async () => {
    const made = [];
    const create = URL.createObjectURL;
    URL.createObjectURL = (blob) => { made.push(blob); return create(blob); };
    document.getElementById("save").click();
    URL.createObjectURL = create;
    return made[0].text();
  });
  const file = join(work, "pose.json");
  writeFileSync(file, saved);
  mien(["eval", baked, "--input", file, "--quiet"]); // the program takes it, too
  await page.run(() => document.getElementById("neutral").click());
  await open(file);
  assert.equal(await page.run(() => window.viewer.model.face.controls.jawOpen), Math.fround(0.4));
  writeFileSync(file, JSON.stringify({ raw: { nothing: 1 } }));
  await open(file);
  assert.match(await text("error"), /has no nothing/);
});

/** The bytes that a button downloads. */
const downloaded = async (id) => Uint8Array.from(await page.run(async (button) => {
  const create = URL.createObjectURL;
  const made = new Promise((resolve) => { URL.createObjectURL = (blob) => { resolve(blob); return create(blob); }; });
  document.getElementById(button).click();
  const bytes = new Uint8Array(await (await made).arrayBuffer());
  URL.createObjectURL = create;
  return Array.from(bytes);
}, id));

test("poses are recorded over time, in a form that the page and the program play", options, async () => {
  await open(baked);
  await page.run(() => document.getElementById("record").click());
  assert.equal(await text("record"), "Stop and download");
  await page.run(async () => {
    // Slow machines draw a few frames in this time; the recording fills what lies between.
    const [end, drawn] = [performance.now() + 500, window.viewer.stage.drawn];
    while (performance.now() < end || window.viewer.stage.drawn < drawn + 4) {
      window.viewer.model.face.controls.jawOpen = Math.min(1, 1 - (end - performance.now()) / 500);
      window.viewer.pose();
      await new Promise(requestAnimationFrame);
    }
    // The last pose is drawn, too.
    const shown = window.viewer.stage.drawn;
    while (window.viewer.stage.drawn < shown + 2) await new Promise(requestAnimationFrame);
  });
  const bytes = await downloaded("record");
  assert.equal(await text("record"), "Record");
  const file = join(work, "take.json");
  writeFileSync(file, bytes);
  const { rate, frames: list } = JSON.parse(Buffer.from(bytes).toString());
  assert.equal(rate, 60);
  assert.ok(list.length > 10 && list.length < 6000, `${list.length} frames`);
  const jaws = list.map(({ raw }) => raw.jawOpen ?? raw["CTRL_expressions.jawOpen"] ?? 0);
  assert.ok(jaws.at(-1) > 0.5 && jaws.every((value, i) => i === 0 || value >= jaws[i - 1]));
  list.forEach(({ time }, i) => assert.equal(time, i / 60));
  mien(["eval", baked, "--input", file, "--quiet"]);
  await open(file);
  assert.match(await text("file"), /1 controls played/);
  await page.run(() => document.getElementById("play").click());
});

test("the shown LOD is downloaded as GLB with its expressions, and opens again in its pose", options, async () => {
  await open(baked);
  await choose("lod", "5");
  await slide("jawOpen", 1);
  await frames();
  const shown = await numbers("window.viewer.model.object.children.find((mesh) => mesh.visible).geometry.attributes.position.array");
  const bytes = await downloaded("save-glb");
  const file = join(work, "shown.glb");
  writeFileSync(file, bytes);
  assert.equal(await page.run(() => window.viewer.model.face.controls.jawOpen), 1); // the page goes on as it was
  await open(file);
  assert.match(await text("facts"), /^72 morph targets, \d/);
  assert.ok(await page.run(() => document.getElementById("save-glb").hidden));
  assert.equal(await page.run(() => window.viewer.model.current[window.viewer.model.list.indexOf("jawOpen")]), 1);
  const posed = await numbers(`(() => {
    let mesh;
    window.viewer.model.object.traverse((node) => { mesh ??= node.isMesh ? node : undefined; });
    const { position } = mesh.geometry.attributes;
    const target = mesh.geometry.morphAttributes.position[mesh.morphTargetDictionary.jawOpen];
    return position.array.map((value, i) => value + target.array[i]);
  })()`);
  assert.equal(posed.length, shown.length);
  // The rig is in centimeters, y up.
  posed.forEach((value, i) => assert.ok(Math.abs(value - shown[i] / 100) < 1e-6, `${i}: ${value}`));
  assert.deepEqual(page.errors, []);
});

test("a Live Link Face recording plays, and one that does not fit says so", options, async () => {
  await open(baked);
  const csv = join(work, "take.csv");
  const rows = Array.from({ length: 30 }, (_, i) => `00:00:00:${String(i).padStart(2, "0")}.000,2,${i / 30},0.5`);
  writeFileSync(csv, ["Timecode,BlendShapeCount,JawOpen,MouthFunnel", ...rows, ""].join("\n"));
  await open(csv);
  assert.match(await text("file"), /2 controls played, 1\.0 s/);
  assert.equal(await page.run(() => window.viewer.model.face.controls.mouthFunnel), 0.5);
  await page.until("() => window.viewer.model.face.controls.jawOpen > 0.2", "moved");
  await page.run(() => document.getElementById("play").click());
  writeFileSync(csv, "Timecode,A\n0,0\n0,x\n");
  await open(csv);
  assert.match(await text("error"), /line 3, A: "x" is not a number/);
});

/** The bytes of a WAV of 8000 samples a second that rises from 0: the level tells the time. */
function rising(seconds) {
  const samples = seconds * 8000;
  const wav = Buffer.alloc(44 + 2 * samples);
  wav.write("RIFF");
  wav.writeUInt32LE(36 + samples * 2, 4);
  wav.write("WAVEfmt ", 8);
  for (const [value, at] of [[16, 16], [8000, 24], [16000, 28]]) wav.writeUInt32LE(value, at);
  for (const [value, at] of [[1, 20], [1, 22], [2, 32], [16, 34]]) wav.writeUInt16LE(value, at);
  wav.write("data", 36);
  wav.writeUInt32LE(samples * 2, 40);
  for (let i = 0; i < samples; ++i) wav.writeInt16LE(Math.round(RISE * i / 8000 * 32768), 44 + 2 * i);
  return wav;
}
const RISE = 1 / 8; // a second

/** A take of the jaw, of 30 frames a second. */
const take = (count) => ["Timecode,BlendShapeCount,JawOpen",
  ...Array.from({ length: count }, (_, i) => `00:00:00:${String(i % 30).padStart(2, "0")}.000,1,${(i % 30) / 30}`), ""].join("\n");

const isPlaying = () => page.run(() => window.viewer.player.isPlaying);

test("the sound of a take is its clock", options, async () => {
  await open(baked);
  const [csv, wav] = [join(work, "heard.csv"), join(work, "voice.wav")];
  writeFileSync(csv, take(150));
  writeFileSync(wav, rising(4)); // a second less than the take
  await open(wav);
  assert.match(await text("error"), /open a rig and a take first/);
  page.errors.length = 0;
  await open(csv, wav); // in any order
  assert.match(await text("file"), /voice\.wav: 4\.0 s of sound/);
  await page.until("() => window.viewer.player.sound.time > 0.3", "heard");
  // The level that the context gives away when a frame is made tells what is heard after the latency.
  const [apart, ahead] = await page.run(async (rise) => {
    const { player } = window.viewer;
    const { context, output } = player.sound;
    const analyser = new AnalyserNode(context, { fftSize: 32 });
    output.connect(analyser);
    const [samples, found] = [new Float32Array(32), []];
    const advance = player.advance.bind(player);
    player.advance = (time) => {
      const { currentTime } = context;
      advance(time);
      analyser.getFloatTimeDomainData(samples);
      wrapped ||= player.take.time < last;
      last = player.take.time;
      if (player.sound.time !== null) ahead = Math.max(ahead, player.take.time - player.sound.time);
      const isHeard = player.sound.time > 0.1 && player.sound.time < 3.7;
      // Between two blocks of samples, and not while the next one was made.
      if (isHeard && context.currentTime === currentTime) found.push(samples[31] / rise - context.outputLatency - player.take.time);
    };
    let [last, wrapped, ahead] = [0, false, 0];
    const begin = performance.now();
    while ((found.length < 12 || !wrapped) && performance.now() < begin + 60000) await new Promise(requestAnimationFrame);
    delete player.advance;
    output.disconnect(analyser);
    return [found.sort((a, b) => Math.abs(a) - Math.abs(b)).map((value) => 1000 * value), 1000 * ahead];
  }, RISE);
  if (process.env.MIEN_SHOTS) console.log(`sound and face apart: ${apart.map((value) => value.toFixed(1)).join(", ")} ms`);
  // ITU-R BT.1359-1: sound that is 45 ms early is noticed.
  assert.ok(apart.length >= 12 && Math.abs(apart[apart.length >> 1]) < 5 && Math.abs(apart.at(-1)) < 45, String(apart));
  assert.ok(ahead < 5, `the face does not wait where both begin again: ${ahead} ms`);
  // However long a frame takes: what is shown is the time of the sound, here of one that stands still for three frames.
  const shown = await page.run(async () => {
    const { sound } = window.viewer.player;
    Object.defineProperty(sound, "time", { configurable: true, value: 0.75 });
    for (let i = 0; i < 3; ++i) await new Promise(requestAnimationFrame);
    const time = Number(document.getElementById("time").value);
    delete sound.time;
    return time;
  });
  assert.equal(shown, 0.75);
  // The take goes on after its sound, and both begin again.
  await page.until("() => Number(document.getElementById('time').value) > 4.2 && window.viewer.player.sound.time === null", "goes on");
  await page.until("() => window.viewer.player.sound.time !== null && window.viewer.player.sound.time < 1.5", "begins again");
  assert.deepEqual(page.errors, []);
});

test("a sound pauses, is heard in parts where the slider passes, and goes on from there", options, async () => {
  const held = await page.run(async () => {
    const { player } = window.viewer;
    document.getElementById("play").click();
    const time = player.take.time;
    await new Promise((resolve) => setTimeout(resolve, 200));
    return [player.isPlaying, player.sound.time, player.take.time === time];
  });
  assert.deepEqual(held, [false, null, true]);
  await page.until("() => window.viewer.player.sound.context.state === 'suspended'", "the device rests");
  // A part is loudest in its middle, by the level of the time that it is from; as loud as it is there, though the slider
  // passes many times while it is heard.
  const loudest = await page.run(async () => {
    const { context, output } = window.viewer.player.sound;
    const analyser = new AnalyserNode(context, { fftSize: 16384 });
    output.connect(analyser);
    const samples = new Float32Array(16384);
    const time = document.getElementById("time");
    for (let i = 0; i < 8; ++i) {
      time.value = "2.5";
      time.dispatchEvent(new Event("input"));
    }
    let [most, since] = [0, performance.now()];
    for (const end = since + 20000; performance.now() < (most > 0 ? since + 500 : end); ) {
      await new Promise((resolve) => setTimeout(resolve, 20));
      analyser.getFloatTimeDomainData(samples);
      const level = Math.max(...samples);
      if (level > most) [most, since] = [level, performance.now()];
    }
    output.disconnect(analyser);
    return most;
  });
  assert.ok(Math.abs(loudest / RISE - 2.55) < 0.06, `${loudest / RISE} s`);
  assert.deepEqual([await isPlaying(), await page.run(() => window.viewer.player.take.time)], [false, 2.5]);
  await press("play");
  await page.until("() => window.viewer.player.sound.time > 2.5", "goes on");
  await press("mute");
  assert.equal(await page.run(() => window.viewer.player.sound.output.gain.value), 0);
  await press("mute");
  assert.equal(await page.run(() => window.viewer.player.sound.output.gain.value), 1);
  assert.deepEqual(page.errors, []);
});

test("sounds are released, and what is no sound or too long says so", options, async () => {
  const [csv, wav] = [join(work, "heard.csv"), join(work, "voice.wav")];
  const states = await page.run(async (bytes) => {
    const { openBytes, player } = window.viewer;
    const seen = [player.sound];
    for (let i = 0; i < 12; ++i) {
      await openBytes("voice.wav", Uint8Array.from(bytes));
      seen.push(player.sound);
    }
    window.viewerSound = player.sound;
    const end = performance.now() + 10000;
    while (performance.now() < end && seen.slice(0, -1).some(({ context }) => context.state !== "closed")) {
      await new Promise((resolve) => setTimeout(resolve, 20));
    }
    return seen.map(({ context }) => context.state);
  }, [...rising(0.5)]);
  assert.deepEqual([states.length, new Set(states.slice(0, -1)), states.at(-1) === "closed"], [13, new Set(["closed"]), false]);
  await open(csv);
  assert.deepEqual(await page.run(() => [window.viewer.player.sound, document.getElementById("mute-row").hidden]), [null, true]);
  await page.until("() => window.viewerSound.context.state === 'closed'", "released");

  for (const [bytes, says] of [["no sound", /cannot decode it: it is no sound, is damaged/], ["", /cannot decode it/],
    [rising(0.5).subarray(0, 30), /cannot decode it/]]) {
    writeFileSync(wav, bytes);
    await open(wav);
    assert.match(await text("error"), says);
  }
  page.errors.length = 0;
  const refused = await page.run(async () => {
    const { Sound } = await import("./sound.js");
    const reason = (name, size) => Sound.open(name, new Uint8Array(size)).then(() => null, ({ message }) => message);
    const found = [await reason("long.mp3", 24e6 + 1), await reason("long.wav", 128e6 + 1)];
    const { decodeAudioData } = OfflineAudioContext.prototype;
    OfflineAudioContext.prototype.decodeAudioData = () => Promise.resolve({ length: 48000 * 601, numberOfChannels: 2, duration: 601 });
    found.push(await reason("long.ogg", 1));
    OfflineAudioContext.prototype.decodeAudioData = decodeAudioData;
    return found;
  });
  assert.match(refused[0], /has 25 MB; at most 24/);
  assert.match(refused[1], /has 129 MB; at most 128/);
  assert.match(refused[2], /601 s of 2 channels; at most ten minutes/);
  assert.equal(await page.run(() => window.viewer.player.sound), null);
});

test("expressions of ARKit drive rigs with other names, by sliders and recordings", options, async () => {
  const other = join(work, "other.dna");
  mien(["gen", "--preset", "medium", "-o", other, "--quiet"]);
  await open(other);
  const raw = (name) => page.run((of) => window.viewer.model.face.controls[`CTRL_expressions.${of}`], name);
  await choose("kind", "arkit");
  await slide("eyeBlinkLeft", 0.75);
  await frames();
  assert.equal(await raw("eyeBlinkL"), 0.75);
  assert.equal(await raw("eyeBlinkR"), 0);
  await page.run(() => document.getElementById("neutral").click());
  await frames();
  assert.equal(await raw("eyeBlinkL"), 0);
  assert.equal(await page.run(() => window.viewer.model.arkit.values.every((value) => value === 0)), true);
  const csv = join(work, "blink.csv");
  writeFileSync(csv, "Timecode,BlendShapeCount,EyeBlinkLeft\n00:00:00:00.000,1,0.5\n00:00:00:01.000,1,0.5\n");
  await open(csv);
  assert.match(await text("file"), /1 controls played/);
  assert.equal(await raw("eyeBlinkL"), 0.5);
  await open(baked);
  assert.equal(await page.run(() => window.viewer.model.arkit), null, "its controls have these names");
  assert.deepEqual(page.errors, []);
});

/** How much of the picture's height the object takes, from below -1 to above 1. */
const seen = () => page.run(() => {
  const { object, camera } = window.viewer.stage;
  const ys = [];
  object.traverse((mesh) => {
    for (let i = 0; mesh.isMesh && mesh.visible && i < mesh.geometry.attributes.position.count; i += 50) {
      ys.push(mesh.getVertexPosition(i, camera.position.clone()).applyMatrix4(mesh.matrixWorld).project(camera).y);
    }
  });
  return [Math.min(...ys), Math.max(...ys)];
});

test("a GLB fills the picture, whatever numbers its vertices have", options, async () => {
  for (const more of [[], ["--no-quantize"], ["--quantize", "--skeleton"], ["--lod", "6", "--skeleton"]]) {
    const [glb, plain] = [join(work, "framed.glb"), join(work, "plain.dna")]; // without materials beside it
    copyFileSync(dna, plain);
    mien(["export", plain, "-o", glb, "--force", "--quiet", ...more]);
    await open(glb);
    const [least, most] = await seen();
    assert.ok(least > -1 && most < 1 && most - least > 1.2, `${more}: ${least} to ${most}`);
    const drawn = (await canvas()).filter((value, i) => i % 4 === 3 && value > 0).length;
    assert.ok(drawn > 300, `${more}: ${drawn} of 4096 pixels are drawn`);
  }
  assert.deepEqual(page.errors, []);
});

test("phonemes are told what makes a take of them, and each of several files has its message", options, async () => {
  writeFileSync(join(work, "said.json"), JSON.stringify({ phonemes: [{ label: "m", begin: 0, end: 1 }] }));
  writeFileSync(join(work, "torn.json"), "{");
  await open(dna);
  await open(join(work, "said.json"), join(work, "torn.json"));
  assert.match(await text("error"), /said\.json could not be opened: these are phonemes: mien speak --phonemes 'said\.json' -o take\.clip/);
  assert.match(await text("error"), /\ntorn\.json could not be opened/);
  await open(dna);
  assert.equal(await text("error"), "");
  page.errors.length = 0;
});

test("a GLB opens with its morph targets", options, async () => {
  await open(join(work, "head.glb"));
  assert.match(await text("facts"), /\d+ morph targets/);
  assert.ok(await page.run(() => window.viewer.model.list.length) > 10);
  await page.run(() => document.querySelector("#list input").dispatchEvent(new Event("input")));
  await frames();
  assert.deepEqual(page.errors, []);
});

test("threads share the memory of the page and show the same vertices", options, async () => {
  const shown = async () => {
    await open(baked);
    await slide("jawOpen", 0.6);
    await frames();
    return numbers("window.viewer.model.object.children[0].geometry.attributes.position.array.subarray(0, 30000)");
  };
  const alone = await shown();
  await page.goto(`${server.url}?threads=3`);
  await page.until("() => location.search && document.body.dataset.ready", "loaded");
  const together = await shown();
  assert.deepEqual(await page.run(() => [crossOriginIsolated, window.viewer.mien.threads]), [true, 3]);
  assert.ok(sameBits(together, alone));
  assert.deepEqual(page.errors, []);
});

test("files of the place of the page open by address", options, async () => {
  assert.ok(readdirSync(folder).includes("index.html"));
  await page.goto(`${server.url}?file=none.dna`);
  await page.until("() => document.body.dataset.ready && !document.getElementById('error').hidden", "refused");
  assert.match(await text("error"), /none\.dna could not be opened: 404/);
});

test("10,000 frames and 100 reopenings take no more memory", options, async () => {
  await open(baked);
  const measure = () => page.run(async () => {
    for (let i = 0; i < 3; ++i) {
      window.gc();
      await new Promise((resolve) => setTimeout(resolve, 20)); // what tasks under way still hold
    }
    return [window.viewer.mien.memoryBytes, performance.memory.usedJSHeapSize];
  });
  const run = (count) => page.run((wanted) => {
    const { model } = window.viewer;
    model.object.lod = 6;
    for (let frame = 0; frame < wanted; ++frame) {
      model.face.controls.jawOpen = (frame % 100) / 100;
      model.update();
    }
  }, count);
  await run(200);
  const [module, heap] = await measure();
  await run(10000);
  const [moduleAfter, heapAfter] = await measure();
  assert.equal(moduleAfter, module);
  assert.ok(heapAfter - heap < 2e6, `the heap grew by ${heapAfter - heap} bytes`);
  const reopen = (count) => page.run(async (wanted) => {
    const bytes = window.viewer.model.rig.bake();
    for (let i = 0; i < wanted; ++i) await window.viewer.openBytes("head.rig", bytes);
    return [document.getElementById("error").hidden, document.querySelectorAll("#list li").length];
  }, count);
  await reopen(5);
  const [before, heapBefore] = await measure();
  assert.deepEqual(await reopen(100), [true, 72]);
  const [afterwards, heapAfterwards] = await measure();
  assert.equal(afterwards, before);
  assert.ok(heapAfterwards - heapBefore < 4e6, `the heap grew by ${heapAfterwards - heapBefore} bytes`);
});

test("the page is used by keyboard alone", options, async () => {
  const seen = new Set();
  for (let i = 0; i < 12; ++i) {
    await page.key("Tab");
    seen.add(await page.run(() => document.activeElement.id || document.activeElement.className || document.activeElement.tagName));
  }
  for (const id of ["skip", "open", "head", "canvas"]) assert.ok(seen.has(id), `${id} is not reached: ${[...seen]}`);
  await page.run(() => document.getElementById("canvas").focus());
  const place = () => page.run(() => window.viewer.stage.camera.position.toArray());
  const old = await place();
  await page.key("ArrowRight");
  await frames();
  assert.notDeepEqual(await place(), old);
});

const axe = join(project, "build/web/tools/node_modules/axe-core/axe.min.js");
if (!missing && !existsSync(axe)) console.log("NOT TESTED: accessibility of the viewer; axe-core could not be fetched");
for (const [name, width, height, dark] of [["light", 1280, 800, false], ["dark", 1280, 800, true], ["phone", 390, 800, false]]) {
  test(`axe-core finds nothing: ${name}`, { skip: missing ?? (existsSync(axe) ? false : "there is no axe-core") }, async () => {
    await page.size(width, height, width < 500);
    await page.prefer({ dark });
    // With a long list of what a control moves.
    await page.run(() => document.querySelector('#list input[aria-label="jawOpen"]').closest("li").querySelector("button").click());
    // Through the protocol, past the policy of the page.
    await page.send("Runtime.evaluate", { expression: readFileSync(axe, "utf8") });
    await frames(3);
    const violations = await page.run(async () => (await window.axe.run()).violations.map(({ id, nodes }) => [id, nodes.map((node) => node.html.slice(0, 120))]));
    assert.deepEqual(violations, []);
    assert.ok(await page.run(() => document.documentElement.scrollWidth <= innerWidth), "the page is wider than the window");
    if (process.env.MIEN_SHOTS) writeFileSync(join(process.env.MIEN_SHOTS, `${name}.png`), await page.screenshot());
  });
}
