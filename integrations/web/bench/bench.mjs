// SPDX-License-Identifier: MIT
// bench.mjs [RIG.dna]: evaluation in WebAssembly and in the native library: the same frames, one after the
// other, on one thread, in turns, in Node.js and in Chromium. Then a frame of the generated head: evaluation and
// deformation, in Node.js and in the viewer in Chromium, without what draws. Needs ./dev build and ./dev web build.
// The default rig is the golden head, else a generated one.
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { serve } from "../serve.mjs";
import { findChromium, Page } from "../tests/browser.mjs";
import { api, Mien, mien, project } from "../tests/support.mjs";

const FRAMES = 64;
const ROUNDS = 40;
const TURNS = 12;
const ACTIVE = 0.08; // share of controls that are not 0

const share = (values, part) => values.slice().sort((a, b) => a - b)[Math.floor(part * (values.length - 1))];
const median = (values) => values.slice().sort((a, b) => a - b)[values.length >> 1];

/** Frames of random controls, a different set of active ones in each. */
function drawFrames(count) {
  let state = 12345;
  const random = () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 2 ** 32;
  const frames = new Float32Array(FRAMES * count);
  for (let frame = 0; frame < FRAMES; ++frame) {
    for (let left = Math.round(ACTIVE * count); left > 0; ) {
      const at = frame * count + Math.floor(random() * count);
      if (frames[at] !== 0) continue;
      frames[at] = 0.01 + 0.99 * random();
      --left;
    }
  }
  return frames;
}

/** Runs in Node.js and, by its text, in pages. */
function inWebAssembly(rig, frames, rounds, FRAMES) {
  const face = rig.instance();
  const count = face.rawControls.length;
  const samples = [];
  for (let round = 0; round < rounds; ++round) {
    const start = performance.now();
    for (let frame = 0; frame < FRAMES; ++frame) {
      face.rawControls.set(frames.subarray(frame * count, (frame + 1) * count));
      face.evaluate(0);
    }
    samples.push(((performance.now() - start) * 1e6) / FRAMES);
  }
  let hash = 2166136261;
  for (let frame = 0; frame < FRAMES; ++frame) {
    face.rawControls.set(frames.subarray(frame * count, (frame + 1) * count));
    face.evaluate(0);
    const bits = new Uint32Array(face.joints.buffer, face.joints.byteOffset, face.joints.length);
    for (const value of bits) hash = Math.imul(hash ^ value, 16777619) >>> 0;
  }
  face.dispose();
  return { time: Math.min(...samples), hash };
}

/** A page of the viewer in Chromium, with files beside it. */
async function openPage(chromium, folder, files) {
  const beside = join(work, "page");
  mkdirSync(beside);
  for (const name of readdirSync(folder)) symlinkSync(join(folder, name), join(beside, name));
  for (const [name, path] of Object.entries(files)) symlinkSync(path, join(beside, name));
  const server = await serve(beside);
  const page = await Page.open(chromium, { width: 800, height: 400 });
  const close = async () => {
    await page.close();
    server.close();
  };
  await page.goto(server.url);
  await page.until("() => document.body.dataset.ready", "loaded");
  return { page, close };
}

/** The same evaluation in a page: how it is called in turns. */
async function evaluationInChromium(page, isa) {
  await page.run(`async (isa) => {
    ${inWebAssembly}
    const { Mien } = await import("./mien/index.js");
    const mien = await Mien.load();
    const rig = await mien.openRig("rig.baked", { isa });
    const frames = new Float32Array(await (await fetch("frames")).arrayBuffer());
    window.evaluate = () => inWebAssembly(rig, frames, ${ROUNDS}, ${FRAMES});
    window.evaluate(); // until the engine has optimized it
  }`, isa);
  return () => page.run("() => window.evaluate()");
}

/** Frames of the viewer: evaluation, and deformation into buffers of three.js. */
async function inChromium(page) {
  const { times, vertices, controls } = await page.run(async () => {
    await window.viewer.openHead();
    const { model } = window.viewer;
    const times = [];
    for (let frame = 0; frame < 1000; ++frame) {
      model.face.rawControls.forEach((_, i, raw) => { raw[i] = 0.5 + 0.5 * Math.sin(frame * 0.1 + i); });
      const start = performance.now();
      model.face.evaluate(0);
      model.object.pose();
      times.push(performance.now() - start);
    }
    const shown = model.object.children.filter((mesh) => mesh.visible);
    const vertices = shown.reduce((sum, mesh) => sum + mesh.userData.vertexCount, 0);
    return { times, vertices, controls: model.face.rawControls.length };
  });
  console.log(`viewer in Chromium, all ${controls} controls active: ${median(times).toFixed(2)} ms of script per frame ` +
    `for ${vertices} vertices, 95 % of frames at most ${share(times, 0.95).toFixed(2)} ms, all ${Math.max(...times).toFixed(1)} ms`);
}

const work = mkdtempSync(join(tmpdir(), "mien-bench-"));
let page;
let close;
try {
  let rigFile = process.argv[2] ?? join(process.env.MIEN_SHARED || join(project, "../shared"), "golden/head.dna");
  if (!existsSync(rigFile)) {
    rigFile = join(work, "large.dna");
    mien(["gen", "--preset", "large", "-o", rigFile, "--quiet"]);
  }
  const baked = join(work, "rig.baked");
  const frameFile = join(work, "frames");
  const native = join(work, "native");
  mien(["bake", rigFile, "-o", baked, "--quiet"]);
  execFileSync("cc", ["-O2", "-std=gnu11", `-I${project}/capi`, join(project, "integrations/web/bench/native.c"),
    `-L${project}/build/release/lib`, "-lmien", `-Wl,-rpath,${project}/build/release/lib`, "-o", native],
  { stdio: "inherit" });

  const folder = join(project, "build/web/viewer");
  const chromium = existsSync(folder) && findChromium();
  if (chromium) ({ page, close } = await openPage(chromium, folder, { "rig.baked": baked, frames: frameFile }));

  const module = await Mien.load({ bakedOnly: true });
  const bytes = readFileSync(baked);
  for (const [name, isa] of [["SSE2", api.Isa.SSE2], ["scalar", api.Isa.SCALAR]]) {
    const rig = await module.openRig(bytes, { isa });
    const probe = rig.instance();
    const frames = drawFrames(probe.rawControls.length);
    probe.dispose();
    writeFileSync(frameFile, frames);
    inWebAssembly(rig, frames, ROUNDS, FRAMES); // until the engine has optimized it
    const [here, there, inPage] = [[], [], []];
    const evaluate = page && await evaluationInChromium(page, isa);
    for (let turn = 0; turn < TURNS; ++turn) {
      const result = inWebAssembly(rig, frames, ROUNDS, FRAMES);
      const [time, hash] = execFileSync(native, [baked, frameFile, String(isa), String(ROUNDS)]).toString().split(" ");
      if (Number(hash) !== result.hash) throw new Error(`the joint values of ${name} do not have the native bits`);
      here.push(result.time);
      there.push(Number(time));
      if (!evaluate) continue;
      const shown = await evaluate();
      if (shown.hash !== result.hash) throw new Error(`the joint values of ${name} in Chromium do not have the native bits`);
      inPage.push(shown.time);
    }
    const [mine, theirs] = [Math.min(...here), Math.min(...there)];
    console.log(`${name}: ${(mine / 1000).toFixed(1)} us in WebAssembly, ${(theirs / 1000).toFixed(1)} us native, ` +
      `ratio ${(mine / theirs).toFixed(2)}, the same bits`);
    if (evaluate) {
      console.log(`${name} in Chromium: ${(Math.min(...inPage) / 1000).toFixed(1)} us, ` +
        `ratio ${(Math.min(...inPage) / theirs).toFixed(2)}, the same bits`);
    }
    rig.dispose();
  }

  const start = performance.now();
  const full = await Mien.load();
  const loaded = performance.now();
  const dna = full.generate(api.Preset.HEAD);
  const generated = performance.now();
  const rig = full.createRig(dna);
  const made = performance.now();
  console.log(`module ${(loaded - start).toFixed(0)} ms, head generated in ${(generated - loaded).toFixed(0)} ms, ` +
    `rig and deformer made in ${(made - generated).toFixed(0)} ms`);
  const face = rig.instance();
  const meshes = rig.deformer.instance({ lods: 1 });
  const [evaluation, deformation] = [[], []];
  const shown = rig.lodIndices(api.Kind.MESH, 0).slice();
  const vertices = shown.reduce((sum, mesh) => sum + rig.deformer.mesh(mesh).vertexCount, 0);
  for (let frame = 0; frame < 300; ++frame) {
    face.rawControls.forEach((_, i, raw) => { raw[i] = 0.5 + 0.5 * Math.sin(frame * 0.1 + i); });
    const begin = performance.now();
    face.evaluate(0);
    const middle = performance.now();
    meshes.update(face);
    for (const mesh of shown) meshes.deform(mesh);
    evaluation.push(middle - begin);
    deformation.push(performance.now() - middle);
  }
  console.log(`generated head, all ${face.rawControls.length} controls active: ${(median(evaluation) * 1000).toFixed(0)} us ` +
    `evaluation, ${median(deformation).toFixed(2)} ms for ${vertices} vertices with recomputed normals`);

  if (page) await inChromium(page);
} finally {
  await close?.();
  rmSync(work, { recursive: true });
}
