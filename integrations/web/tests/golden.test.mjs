// SPDX-License-Identifier: MIT
// Golden rigs in WebAssembly: within their tolerances, and with the bits of the native program where
// docs/numbers.md promises them.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, test } from "node:test";
import {
  api, goldenRigs, Mien, mien, program as nativeProgram, project, readGolden, sameBits,
} from "./support.mjs";

const { Isa, RotationOutput, RotationUnit } = api;
const work = mkdtempSync(join(tmpdir(), "mien-web-"));
after(() => rmSync(work, { recursive: true }));

const full = await Mien.load();
const slim = await Mien.load({ bakedOnly: true });
const tolerances = ["psd", "ml", "rbf", "joints.euler", "joints.quat", "blendShapes", "animatedMaps"];

/** Evaluates each frame at each LOD on a fresh instance, as the results were made. */
function* evaluations(rig, records) {
  const face = rig.instance();
  const row = (name, frame) => {
    const { dims, values } = records.get(name);
    return values.subarray(frame * dims[1], (frame + 1) * dims[1]);
  };
  const frames = records.get("meta.counts").values[12];
  for (let frame = 0; frame < frames; ++frame) {
    for (let lod = 0; lod < rig.info.lodCount; ++lod) {
      face.reset();
      face.mlMasks.set(row("in.mlMask", frame));
      const isGui = records.get("in.mode").values[frame] === 0;
      if (isGui) {
        face.guiControls.set(row("in.gui", frame));
        face.mapGuiToRaw();
        for (const i of records.get("in.quatRaw").values) face.rawControls[i] = row("in.raw", frame)[i];
      } else {
        face.rawControls.set(row("in.raw", frame));
      }
      face.evaluate(lod);
      yield { face, frame, lod, isGui, row };
    }
  }
  face.dispose();
}

const outputs = {
  raw: "rawControls", psd: "psdControls", ml: "mlControls", rbf: "rbfControls", joints: "joints",
  blendShapes: "blendShapes", animatedMaps: "animatedMaps",
};

/** JSON.stringify() loses the sign of -0. */
function json(value) {
  if (Array.isArray(value)) return `[${value.map(json)}]`;
  if (typeof value === "object") return `{${Object.entries(value).map(([key, v]) => `"${key}":${json(v)}`)}}`;
  return Object.is(value, -0) ? "-0.0" : String(value);
}

/** The largest excess of an array over its tolerance. */
function excess(values, expected, tolerance, turn, isEuler, isQuaternion) {
  let most = 0;
  const bound = tolerance + 1e-5 * expected.reduce((max, v) => Math.max(max, Math.abs(v)), 0);
  assert.equal(values.length, expected.length);
  for (let i = 0; i < values.length; ++i) {
    let wanted = expected[i];
    if (isQuaternion && i % 10 >= 3 && i % 10 < 7) {
      const at = i - (i % 10) + 3; // of both signs the nearer one
      let dot = 0;
      for (let k = at; k < at + 4; ++k) dot += values[k] * expected[k];
      if (dot < 0) wanted = -wanted;
    }
    let error = Math.abs(values[i] - wanted);
    if (error > bound && isEuler && i % 9 >= 3 && i % 9 < 6) {
      error = Math.abs(((((values[i] - wanted + turn / 2) % turn) + turn) % turn) - turn / 2);
    }
    most = Math.max(most, bound ? error / bound : error ? Infinity : 0);
  }
  return most;
}

for (const [name, path] of goldenRigs()) {
  const records = readGolden(path.replace(/dna$/, "golden.bin"));
  const bytes = readFileSync(path);

  for (const isa of [Isa.SCALAR, Isa.SSE2]) {
    for (const [rotation, rotationOutput] of Object.entries(RotationOutput)) {
      test(`${name}, ${full.isaName(isa)}, ${rotation}: within the tolerances`, async () => {
        const rig = await full.openRig(bytes, { isa, rotationOutput, deformer: false });
        assert.equal(rig.info.isa, isa);
        const turn = rig.info.rotationUnit === RotationUnit.DEGREES ? 360 : 2 * Math.PI;
        const isQuaternion = rotationOutput === RotationOutput.QUATERNION;
        let compared = 0;
        for (const { face, frame, lod, isGui, row } of evaluations(rig, records)) {
          for (const [key, property] of Object.entries(outputs)) {
            const record = key === "joints" ? `joints.${isQuaternion ? "quat" : "euler"}` : key;
            const expected = row(`lod${lod}.${record}`, frame);
            const tolerance = key === "raw" ? (isGui ? 2e-6 : 0)
              : records.get("meta.tolerance").values[tolerances.indexOf(record)];
            const most = excess(face[property], expected, tolerance, turn, record === "joints.euler",
              record === "joints.quat");
            assert.ok(most <= 1, `frame ${frame}, LOD ${lod}, ${record}: ${most} times the tolerance`);
            compared += expected.length;
          }
        }
        assert.ok(compared > 0);
        rig.dispose();
      });
    }
  }

  test(`${name}, baked natively: the bits of the native program`, async () => {
    const frames = [];
    const frameCount = records.get("meta.counts").values[12];
    for (let frame = 0; frame < frameCount; ++frame) {
      const row = (record) => {
        const { dims, values } = records.get(record);
        return Array.from(values.subarray(frame * dims[1], (frame + 1) * dims[1]));
      };
      const raw = row("in.raw");
      const quaternions = records.get("in.quatRaw").values;
      const mask = row("in.mlMask");
      frames.push({
        ...(records.get("in.mode").values[frame] === 0
          ? { gui: row("in.gui"), raw_after_gui: Object.fromEntries(Array.from(quaternions, (i) => [i, raw[i]])) }
          : { raw }),
        ...(mask.length ? { ml_mask: mask } : {}),
      });
    }
    const baked = join(work, `${name}.baked`);
    mien(["bake", path, "-o", baked, "--quiet"]);
    const native = JSON.parse(mien(["eval", baked, "--input", "-", "--quiet", "--lod", "all", "--isa", "scalar"],
      json({ frames })));
    const bytesOfBaked = readFileSync(baked);
    for (const [module, isa] of [[slim, Isa.SSE2], [slim, Isa.SCALAR], [full, Isa.SSE2]]) {
      const rig = await module.openRig(bytesOfBaked, { isa });
      let compared = 0;
      for (const { face, frame, lod } of evaluations(rig, records)) {
        const expected = native.frames[frame].lods[lod];
        for (const [key, property] of [...Object.entries(outputs)]) {
          const nativeKey = key.replace(/[A-Z]/, (letter) => `_${letter.toLowerCase()}`);
          assert.ok(sameBits(face[property], expected[nativeKey]), `frame ${frame}, LOD ${lod}, ${key}`);
          compared += expected[nativeKey].length;
        }
      }
      assert.ok(compared > 0);
      rig.dispose();
    }
  });
}

test("vertices have the bits of the native library", async (context) => {
  const baked = join(work, "head.baked");
  const generated = join(work, "head.dna");
  mien(["demo-head", "-o", generated, "--quiet"]);
  mien(["bake", generated, "-o", baked, "--quiet"]);
  const pose = { jawOpen: 0.6, mouthSmileLeft: 0.75, eyeBlinkRight: 1, browInnerUp: 0.3 };
  const done = spawnSync("python3", [join(project, "integrations/web/tests/native_vertices.py"), baked,
    ...Object.entries(pose).map(([name, value]) => `${name}=${value}`)], {
    maxBuffer: 2 ** 28,
    env: { ...process.env, PYTHONPATH: join(project, "integrations/python"), PYTHONDONTWRITEBYTECODE: "1",
      MIEN_LIBRARY: join(dirname(dirname(nativeProgram)), "lib/libmien.so") },
  });
  if (/No module named 'numpy'/.test(done.stderr)) {
    console.log("NOT TESTED: bits of vertices in WebAssembly; Python has no NumPy");
    context.skip("Python has no NumPy");
    return;
  }
  assert.equal(done.status, 0, done.stderr.toString());
  const native = new Uint32Array(done.stdout.buffer.slice(done.stdout.byteOffset, done.stdout.byteOffset + done.stdout.length));
  const rig = await slim.openRig(readFileSync(baked));
  const [face, meshes] = [rig.instance(), rig.deformer.instance({ lods: 1 })];
  for (const [name, value] of Object.entries(pose)) face.controls[name] = value;
  face.evaluate(0);
  meshes.update(face);
  let at = 0;
  for (const mesh of rig.lodIndices(api.Kind.MESH, 0).slice()) {
    meshes.deform(mesh);
    for (const values of [meshes.positions(mesh), meshes.normals(mesh)]) {
      const bits = new Uint32Array(values.slice().buffer);
      assert.deepEqual(bits, native.subarray(at, at + bits.length), rig.name(api.Kind.MESH, mesh));
      at += bits.length;
    }
  }
  assert.equal(at, native.length);
  assert.ok(at > 50000);
});

test("a head that was generated here is the one that the program generates", () => {
  const dna = full.generate(api.Preset.HEAD);
  assert.ok(Buffer.from(dna.write()).equals(mien(["demo-head", "-o", "-"])), "the bytes differ");
  dna.dispose();
});
