// SPDX-License-Identifier: MIT
// A project that uses the package as its README says, built by Vite: the head is seen in Chromium.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { serve } from "../serve.mjs";
import { findChromium, Page } from "./browser.mjs";
import { mien, packageFolder, project } from "./support.mjs";

const vite = join(project, "build/web/tools/node_modules/vite/bin/vite.js");
const three = join(project, "build/web/three/node_modules/three");
const chromium = findChromium();
const missing = !existsSync(vite) || !existsSync(three) ? "Vite or three.js could not be fetched"
  : !chromium ? "there is no Chromium" : null;
if (missing) console.log(`NOT TESTED: the npm package in a project of Vite; ${missing}`);

/** What `npm pack` would put into the archive. */
function installPackage(target) {
  const { files, exports } = JSON.parse(readFileSync(join(packageFolder, "package.json")));
  mkdirSync(target, { recursive: true });
  const packed = readdirSync(packageFolder).filter((name) => name === "package.json" ||
    files.some((pattern) => (pattern.startsWith("*") ? name.endsWith(pattern.slice(1)) : name === pattern)));
  for (const name of packed) copyFileSync(join(packageFolder, name), join(target, name));
  for (const entry of Object.values(exports)) {
    for (const path of typeof entry === "string" ? [entry] : Object.values(entry)) {
      assert.ok(existsSync(join(target, path)), `the package lacks ${path}`);
    }
  }
}

test("a project of Vite with the package builds and shows the head", { skip: missing ?? false }, async () => {
  const work = mkdtempSync(join(tmpdir(), "mien-vite-"));
  let server;
  let page;
  try {
    installPackage(join(work, "node_modules/mien"));
    symlinkSync(three, join(work, "node_modules/three"));
    mkdirSync(join(work, "public"));
    mien(["demo-head", "-o", join(work, "public/head.dna"), "--quiet"]);
    writeFileSync(join(work, "package.json"), '{"type": "module"}');
    writeFileSync(join(work, "vite.config.js"), 'export default { build: { target: "es2022" } };\n');
    writeFileSync(join(work, "index.html"), '<!doctype html><link rel="icon" href="data:,">' +
      '<canvas id="canvas" width="256" height="256"></canvas><script type="module" src="main.js"></script>\n');
    // The lines of the package's README up to the loop of its page.
    const { embedded } = /## three\.js.*?(?<embedded>const mien = await Mien\.load\(\);\n.*?)\nrenderer/s
      .exec(readFileSync(join(project, "integrations/web/README.md"), "utf8")).groups;
    writeFileSync(join(work, "main.js"), `
      import { Mien } from "mien";
      import { FaceObject } from "mien/three";
      import { AmbientLight, DirectionalLight, PerspectiveCamera, Scene, WebGLRenderer } from "three";
      const scene = new Scene();
      ${embedded}
      face.face.controls.jawOpen = 1;
      face.update();
      scene.add(new AmbientLight(0xffffff, 1), new DirectionalLight(0xffffff, 2));
      const camera = new PerspectiveCamera(30, 1, 0.01, 10);
      const center = face.center;
      camera.position.set(center.x, center.y, center.z + 0.8);
      const canvas = document.getElementById("canvas");
      const renderer = new WebGLRenderer({ canvas, preserveDrawingBuffer: true });
      renderer.render(scene, camera);
      const copy = new OffscreenCanvas(64, 64).getContext("2d");
      copy.drawImage(canvas, 0, 0, 64, 64);
      const { data } = copy.getImageData(0, 0, 64, 64);
      window.seen = data.filter((_, i) => i % 4 === 0 && data[i] > 20).length;
    `);
    const built = spawnSync(process.execPath, [vite, "build", work, "--logLevel", "warn"], { cwd: work, encoding: "utf8" });
    assert.equal(built.status, 0, built.stdout + built.stderr);
    assert.ok(readdirSync(join(work, "dist/assets")).some((name) => name.endsWith(".wasm")));

    server = await serve(join(work, "dist"));
    page = await Page.open(chromium, { width: 300, height: 300 });
    await page.goto(server.url);
    await page.until("() => window.seen !== undefined", "drawn");
    assert.deepEqual(page.errors, []);
    const seen = await page.run(() => window.seen);
    assert.ok(seen > 400 && seen < 4000, `${seen} of 4096 pixels are not black`);
  } finally {
    await page?.close();
    server?.close();
    rmSync(work, { recursive: true });
  }
});
