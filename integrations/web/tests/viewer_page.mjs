// SPDX-License-Identifier: MIT
// What the tests of the viewer share: a page in a headless Chromium, and what a user does on it.
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, afterEach, before } from "node:test";
import { serve } from "../serve.mjs";
import { findChromium, Page } from "./browser.mjs";
import { mien, project } from "./support.mjs";

export const folder = join(project, "build/web/viewer");
export const chromium = findChromium();
export const missing = !existsSync(folder) ? "it was not built" : !chromium ? "there is no Chromium" : null;
if (missing) console.log(`NOT TESTED: the viewer in a browser; ${missing}`);
export const options = { skip: missing ?? false };

export const work = mkdtempSync(join(tmpdir(), "mien-viewer-"));
export const dna = join(work, "head.dna");
export const baked = join(work, "head.rig");
export let server;
export let page;

/** Switches of Chromium, beside the usual ones. */
export const switches = [];

before(async () => {
  if (missing) return;
  mien(["demo-head", "-o", dna, "--quiet"]);
  mien(["bake", dna, "-o", baked, "--quiet"]);
  mien(["export", dna, "-o", join(work, "head.glb"), "--quiet"]);
  server = await serve(folder);
  page = await Page.open(chromium, { width: 800, height: 400, switches }); // small: the GPU is software
  await page.goto(server.url);
  await page.until("() => document.body.dataset.ready", "loaded");
});

after(async () => {
  await page?.close();
  server?.close();
  rmSync(work, { recursive: true });
});

// A test that fails leaves no messages and no motion to the next one.
afterEach(async () => {
  if (!page) return;
  page.errors.length = 0;
  await page.prefer();
});

export const text = (id) => page.run((of) => document.getElementById(of).textContent, id);
export const frames = (count = 2) => page.run(async (wanted) => {
  for (let i = 0; i < wanted; ++i) await new Promise(requestAnimationFrame);
}, count);

/** Opens files by the button, and waits until the page has dealt with them. */
export async function open(...paths) {
  await page.run(() => { window.viewerModel = window.viewer.model; });
  await page.choose("#files", paths);
  await page.until("() => document.body.hasAttribute('aria-busy') || window.viewer.model !== window.viewerModel || " +
    "!document.getElementById('error').hidden || document.getElementById('files').value === ''", "begun");
  await page.until("() => !document.body.hasAttribute('aria-busy') && document.getElementById('files').value === ''", "opened");
  await frames();
}

/** As a person does: browsers play no sound before. */
export const press = (id) => page.run((of) => document.getElementById(of).click(), id);

/** Moves a slider as a user does. */
export const slide = (name, value) => page.run((label, to) => {
  const input = document.querySelector(`#list input[aria-label="${label}"]`);
  input.value = to;
  input.dispatchEvent(new Event("input", { bubbles: true }));
}, name, value);

export const choose = (id, value) => page.run((of, to) => {
  const element = document.getElementById(of);
  if (element.type === "checkbox") element.checked = to;
  else element.value = to;
  element.dispatchEvent(new Event("change"));
}, id, value);

export const numbers = async (what) => Float32Array.from(await page.run(`() => Array.from(${what})`));
