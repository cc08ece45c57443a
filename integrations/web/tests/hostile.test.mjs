// SPDX-License-Identifier: MIT
// Files that ask for more than their bytes deserve: in WebAssembly, too, they live or are refused with a
// status, as by the native program, and memory stays within the bounds of the native tests.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { api, Mien, program, project } from "./support.mjs";

const { Kind, MienError, Normals, Status } = api;
const folder = join(process.env.MIEN_SHARED || join(project, "../shared"), "data/hostile");
const work = mkdtempSync(join(tmpdir(), "mien-hostile-"));
after(() => rmSync(work, { recursive: true }));

// The sum of the bounds of tests/support/exercise_dna.h, for a file, a rig and a deformer. The module begins with
// 4 MiB and grows by up to a quarter more than it needs.
const bound = (size) => 1.25 * (2 ** 22 + (20 * size + 2 ** 18) + (40 * size + 2 ** 23) + (96 * size + 2 ** 20));

/** A frame at each LOD, with all meshes. */
function runFrames(rig) {
  const face = rig.instance();
  const pose = rig.deformer?.instance();
  const meshes = rig.count(Kind.MESH);
  for (let lod = 0; lod < rig.info.lodCount; ++lod) {
    face.guiControls.fill(0.5);
    face.mapGuiToRaw();
    face.rawControls.forEach((_, i, raw) => { raw[i] = 0.25 + 0.5 * ((i + lod) % 2); });
    face.evaluate(lod);
    assert.ok(face.joints.every(Number.isFinite), `joints at LOD ${lod}`);
    if (!pose) continue;
    pose.update(face);
    for (let mesh = 0; mesh < meshes; ++mesh) pose.deform(mesh, Normals.RECOMPUTED);
  }
  pose?.dispose();
  face.dispose();
}

/** Runs a life in a new module. What is thrown has to be an error with a status. */
async function live(bytes, options) {
  const mien = await Mien.load(options);
  let refused = "";
  try {
    const rig = await mien.openRig(bytes);
    runFrames(rig);
    rig.dispose();
  } catch (error) {
    if (!(error instanceof MienError)) throw error; // a trap
    assert.notEqual(error.statusName, "UNKNOWN");
    assert.notEqual(error.status, Status.MEMORY);
    refused = error.message;
  }
  return { refused, memory: mien.memoryBytes };
}

if (!existsSync(folder)) {
  console.log(`NOT TESTED: hostile files in WebAssembly; there is no ${folder}`);
  test("hostile files", { skip: `there is no ${folder}` }, () => {});
} else {
  const files = readdirSync(folder).filter((name) => /\.(dna|rig)$/.test(name)).sort();
  test("there are hostile files", () => assert.ok(files.length > 0));
  for (const name of files) {
    test(`${name} lives or is refused, as natively`, async (context) => {
      const path = join(folder, name);
      const bytes = readFileSync(path);
      const { refused, memory } = await live(bytes);
      context.diagnostic(`${bytes.length} bytes, ${(memory / 2 ** 20).toFixed(1)} MiB; ${refused || "lives"}`);
      assert.ok(memory <= bound(bytes.length), `${memory} bytes of memory for ${bytes.length}`);
      const baked = join(work, "baked");
      const native = spawnSync(program, ["bake", path, "-o", baked, "--quiet"], { encoding: "utf8" });
      assert.equal(native.status, refused ? 2 : 0, native.stderr);
      assert.ok(native.stderr.includes(refused), `"${refused}" here, natively ${native.stderr}`);
      if (refused) return;
      const again = await live(readFileSync(baked), { bakedOnly: true });
      assert.equal(again.refused, "", "what was baked natively");
      assert.ok(again.memory <= bound(bytes.length), `${again.memory} bytes of memory for what was baked`);
    });
  }
}
