// SPDX-License-Identifier: MIT
// The viewer when it moves by itself, plays, compares and listens. Time is counted in steps that the tests make, or
// waited for; nothing depends on how fast frames come.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { createSocket } from "node:dgram";
import { once } from "node:events";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { mien, program, sameBits } from "./support.mjs";
import { baked, choose, dna, frames, numbers, open, options, page, press, server, slide, switches, text, work } from "./viewer_page.mjs";

// The program gives the bits of WebAssembly, also where guards measure positions.
process.env.MIEN_ISA = "scalar";

// A microphone that beeps once a second, and is allowed.
switches.push("--use-fake-device-for-media-stream", "--use-fake-ui-for-media-stream");

/** Which check boxes can be used, and what is said below them. */
const lifeSwitches = () => page.run(() => {
  const [idle, follow, note] = ["idle", "follow", "life-note"].map((id) => document.getElementById(id));
  return { idle: !idle.disabled, follow: !follow.disabled, note: note.hidden ? "" : note.textContent };
});

test("a GLB opens as the first file", options, async () => {
  await open(join(work, "head.glb"));
  assert.deepEqual(await lifeSwitches(), { idle: true, follow: true, note: "" });
  assert.match(await text("facts"), /\d+ morph targets/);
  assert.deepEqual(page.errors, []);
});

/** Lets idle life run for some seconds, however long that takes: the largest value of each control that is given, and
 * of the others how many there were. */
const live = (seconds, names) => page.run((count, wanted) => {
  const { attention, model } = window.viewer;
  const found = wanted.map(() => ({ most: 0, values: new Set() }));
  for (let i = 0; i < count; ++i) {
    attention.idle.step(1 / 60, model.face);
    wanted.forEach((name, k) => {
      const value = attention.idle.face.controls[name];
      found[k].most = Math.max(found[k].most, value);
      found[k].values.add(value);
    });
  }
  return found.map(({ most, values }) => ({ most, count: values.size }));
}, seconds * 60, names);

test("idle life blinks and looks around; the sliders and their numbers stay", options, async () => {
  await open(baked);
  const checked = (id) => page.run((of) => document.getElementById(of).checked, id);
  assert.deepEqual([await checked("idle"), await checked("follow")], [false, false], "reduced motion is preferred");
  await slide("mouthSmileLeft", 0.75);
  await frames();
  const drawn = () => page.run(() => window.viewer.stage.drawn);
  const before = await drawn();
  await frames(5);
  assert.equal(await drawn(), before, "nothing moves");
  const joints = await numbers("window.viewer.model.face.joints");
  await page.prefer({ motion: true });
  await page.until("() => window.viewer.attention.idle", "alive");
  assert.deepEqual([await checked("idle"), await checked("follow")], [true, true]);
  const [lid, look, smile] = await live(20, ["eyeBlinkLeft", "eyeLookInLeft", "mouthSmileLeft"]);
  assert.ok(lid.most > 0.95, `the lids close by ${lid.most}`);
  assert.ok(look.count > 100 && look.most > 0.01 && look.most < 0.3, JSON.stringify(look));
  assert.deepEqual(smile, { most: 0.75, count: 1 });
  assert.ok(sameBits(await numbers("window.viewer.model.face.joints"), joints));
  assert.deepEqual(await page.run(() => Object.keys(window.viewer.model.pose()).length), 1);
  // A control that is set stays as it is set, and the others go on.
  await slide("eyeBlinkLeft", 0.25);
  const [held, eyes] = await live(20, ["eyeBlinkLeft", "eyeLookInLeft"]);
  assert.deepEqual([held, eyes.count > 100], [{ most: 0.25, count: 1 }, true]);
  await page.prefer();
  await page.until("() => !document.getElementById('idle').checked", "still again");
  await frames();
  assert.equal(await page.run(() => window.viewer.model.object.face === window.viewer.model.face), true);
  assert.deepEqual(page.errors, []);
});

/** The eyes when the cursor is at a part of the width: how far they look to the left, and how the head turns. */
const lookFrom = (part) => page.run((across) => {
  const { attention, model, stage } = window.viewer;
  const { left, top, width, height } = stage.canvas.getBoundingClientRect();
  stage.canvas.dispatchEvent(new PointerEvent("pointermove", { clientX: left + across * width, clientY: top + height / 2 }));
  for (let i = 0, time = performance.now(); i < 90; ++i) model.update(attention.step(time += 1000 / 60, false));
  const { eyeLookOutLeft, eyeLookInLeft, eyeLookDownRight } = attention.idle.face.controls;
  return { side: eyeLookOutLeft - eyeLookInLeft, down: eyeLookDownRight, turn: attention.idle.motion.left };
}, part);

test("the eyes look at the cursor, and not while a take plays", options, async () => {
  await open(baked);
  await choose("follow", true);
  await page.until("() => window.viewer.attention.idle", "looks");
  const [right, left] = [await lookFrom(0.02), await lookFrom(0.98)];
  assert.ok(right.side < -0.1 && left.side > 0.1, `${right.side} ${left.side}`);
  assert.ok(left.turn > right.turn, "the head turns with them");
  const csv = join(work, "still.csv");
  writeFileSync(csv, "Timecode,BlendShapeCount,EyeBlinkLeft\n00:00:00:00.000,1,0.5\n00:00:00:01.000,1,0.5\n");
  await open(csv);
  await frames();
  assert.deepEqual(await page.run(() => [window.viewer.player.isPlaying, window.viewer.model.object.face === window.viewer.model.face]),
    [true, true]);
  await choose("follow", false);
  await open(baked);
  assert.deepEqual(page.errors, []);
});

/** The weight that a target of the GLB has on its first mesh. */
const weightOf = (name) => page.run((of) => window.viewer.model.targets.get(of).map(([mesh, target]) => mesh.morphTargetInfluences[target])[0], name);

/** Writes a copy of a GLB in which words of its JSON are others, no longer than before. */
function renamed(glb, copy, words) {
  const bytes = readFileSync(glb);
  for (const [from, to] of words) {
    for (let at = bytes.indexOf(`"${from}"`); at >= 0; at = bytes.indexOf(`"${from}"`)) bytes.write(`"${to}"`.padEnd(from.length + 2), at);
  }
  writeFileSync(copy, bytes);
}

test("a GLB blinks and looks at the cursor by its morph targets, as the rig that it is of", options, async () => {
  const glb = join(work, "head.glb");
  // Steps of their own, so that the small movements of both are at the same time.
  const looks = () => page.run(async () => {
    const { Idle } = await import("./idle.js");
    const { model } = window.viewer;
    const idle = new Idle(model.lifeRig, model.face);
    const found = [[-0.3, 0.1, 0.6], [0, 0, 0.3], [0.1, 0.2, 0.5], [0.6, -0.2, 0.5]].map(([x, y, z]) => {
      idle.lookAt({ x, y, z });
      for (let i = 0; i < 90; ++i) idle.step(1 / 60, model.face);
      const { controls } = idle.face;
      return [...["Up", "Down", "In", "Out"].flatMap((way) => [controls[`eyeLook${way}Left`], controls[`eyeLook${way}Right`]]),
        idle.motion.left, idle.motion.up];
    });
    idle.dispose();
    return found.flat();
  });
  await open(baked);
  const rig = await looks();
  await open(glb);
  const most = (await looks()).reduce((worst, value, i) => Math.max(worst, Math.abs(value - rig[i])), 0);
  assert.ok(most < 0.002 && rig.filter((value) => value > 0.2).length > 5, `${most} of ${rig}`);
  await choose("follow", true);
  await page.until("() => window.viewer.attention.idle", "looks");
  const [right, left] = [await lookFrom(0.02), await lookFrom(0.98)];
  assert.ok(right.side < -0.3 && left.side > 0.5 && left.turn > right.turn, JSON.stringify([right, left]));
  assert.ok(Math.abs(await weightOf("eyeLookOutLeft") - left.side) < 0.2, "it is seen");
  await page.run(() => window.viewer.stage.canvas.dispatchEvent(new PointerEvent("pointerleave")));
  await choose("follow", false);
  await frames();
  assert.equal(await weightOf("eyeLookOutLeft"), 0, "the eyes are back");

  await slide("mouthSmileLeft", 0.75);
  await page.prefer({ motion: true });
  await page.until("() => window.viewer.attention.motion", "alive");
  await frames();
  const seen = await page.run(() => {
    const { attention, model } = window.viewer;
    const [most, smiles] = [{ eyeBlinkLeft: 0, eyeLookInLeft: 0 }, new Set()];
    const weight = (name) => model.targets.get(name).map(([mesh, target]) => mesh.morphTargetInfluences[target])[0];
    for (let i = 0; i < 1200; ++i) {
      attention.idle.step(1 / 60, model.face);
      model.update(attention.idle.face);
      for (const name of Object.keys(most)) most[name] = Math.max(most[name], weight(name));
      smiles.add(weight("mouthSmileLeft"));
    }
    return { ...most, smiles: [...smiles], pose: model.pose(), rise: attention.idle.motion.rise };
  });
  assert.ok(seen.eyeBlinkLeft > 0.95 && seen.eyeLookInLeft > 0.01 && seen.eyeLookInLeft < 0.3, JSON.stringify(seen));
  assert.deepEqual([seen.smiles, seen.pose], [[0.75], { mouthSmileLeft: 0.75 }], "the sliders stay");
  assert.ok(seen.rise > 0, "it breathes");
  // A target that is set stays as it is set.
  await slide("eyeBlinkLeft", 0.25);
  const blinks = await page.run(() => {
    const { attention, model } = window.viewer;
    const found = new Set();
    for (let i = 0; i < 1200; ++i) {
      attention.idle.step(1 / 60, model.face);
      model.update(attention.idle.face);
      if (i > 30) found.add(model.targets.get("eyeBlinkLeft").map(([mesh, target]) => mesh.morphTargetInfluences[target])[0]);
    }
    return [...found];
  });
  assert.deepEqual(blinks, [0.25]);
  await page.prefer();
  await page.until("() => !document.getElementById('idle').checked", "still again");
  await frames();
  assert.deepEqual([await weightOf("eyeBlinkLeft"), await weightOf("eyeLookInLeft")], [0.25, 0]);
  assert.deepEqual(page.errors, []);
});

test("a GLB says which morph targets its idle life lacks", options, async () => {
  const [glb, copy] = [join(work, "head.glb"), join(work, "lacks.glb")];
  // In the style of another tool.
  renamed(glb, copy, [["eyeBlinkLeft", "eyeBlink_L"], ["eyeBlinkRight", "eyeBlink_R"], ["eyeLookOutLeft", "eyeLookOut_L"]]);
  await open(copy);
  assert.deepEqual(await lifeSwitches(), { idle: true, follow: true, note: "" });
  renamed(glb, copy, [["eyeBlinkRight", "shutRight"], ["eyeLookUpLeft", "upLeft"], ["eyeLookInLeft", "inLeft"]]);
  await open(copy);
  assert.deepEqual(await lifeSwitches(), { idle: true, follow: true,
    note: "This GLB has no morph targets eyeBlinkRight, eyeLookUpLeft, eyeLookInLeft: it moves without them." });
  await choose("follow", true);
  await page.until("() => window.viewer.attention.idle", "looks");
  assert.ok((await lookFrom(0.98)).side > 0.5, "with the targets that there are");
  await choose("follow", false);
  renamed(glb, copy, ["Up", "Down", "In", "Out"].flatMap((way) => ["Left", "Right"].map((side) => [`eyeLook${way}${side}`, `${way}${side}`])));
  await open(copy);
  const { note, ...can } = await lifeSwitches();
  assert.deepEqual(can, { idle: true, follow: false });
  assert.match(note, /eyeLookUpLeft, eyeLookUpRight, eyeLookDownLeft,/);
  // Joints, and what they do not do: no whole expressions.
  mien(["export", dna, "-o", copy, "--lod", "6", "--skeleton", "--force", "--quiet"]);
  await open(copy);
  const none = await lifeSwitches();
  assert.deepEqual([none.idle, none.follow], [false, false]);
  assert.match(none.note, /no morph targets by the names of ARKit, such as eyeBlinkLeft/);
  await page.prefer({ motion: true });
  await frames(3);
  assert.equal(await page.run(() => window.viewer.attention.idle), null);
  await page.prefer();
  await open(baked);
  assert.deepEqual(await lifeSwitches(), { idle: true, follow: true, note: "" });
  assert.deepEqual(page.errors, []);
});

test("eyes that do not turn like a body, and one eye alone, look by usual angles", options, async () => {
  await open(baked); // which loads the module
  const found = await page.run(async () => {
    const [{ StandIn }, { BufferAttribute, BufferGeometry, Mesh }] = await Promise.all([import("./stand_in.js"), import("three")]);
    const { mien } = window.viewer;
    // A patch at an eye's place; its targets shift it, as lids are shifted.
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array([0.03, 0, 0.08, 0.04, 0, 0.08, 0.03, 0.01, 0.08]), 3));
    geometry.morphTargetsRelative = true;
    geometry.morphAttributes.position = [new BufferAttribute(new Float32Array([0.002, 0, 0, 0.002, 0, 0, 0.002, 0, 0]), 3)];
    const mesh = new Mesh(geometry);
    const standIn = StandIn.of(mien, (name) => (name === "eyeLookOutLeft" ? [[mesh, 0]] : []));
    const { face, rig, names, missing } = standIn;
    const turned = ["eyeLookOutLeft", "eyeLookOutRight"].map((name) => {
      face.reset();
      face.rawControls[names.indexOf(name)] = 1;
      face.evaluate(0);
      return [...face.joints].filter((value) => value !== 0);
    });
    const gaze = rig.deformer.gaze();
    const { leftEye, rightEye } = gaze.info;
    for (const object of [gaze, standIn]) object.dispose();
    return { turned, missing: missing.length, left: leftEye.left, right: rightEye.left, influence: mesh.morphTargetInfluences[0],
      none: StandIn.of(mien, () => []) };
  });
  assert.ok(Math.abs(found.left - 33.3) < 0.1 && Math.abs(found.left + found.right) < 1e-3, JSON.stringify(found));
  assert.deepEqual([found.turned, found.missing, found.influence, found.none], [[[26], [-26]], 9, 0, null]);
});

test("reopening a GLB takes no more memory", options, async () => {
  const glb = join(work, "coarse.glb");
  mien(["export", dna, "-o", glb, "--lod", "6", "--quiet"]);
  await open(glb);
  await page.prefer({ motion: true });
  await page.until("() => window.viewer.attention.idle", "alive");
  const [before, after] = await page.run(async (bytes) => {
    const open = async (count) => {
      for (let i = 0; i < count; ++i) {
        await window.viewer.openBytes("coarse.glb", Uint8Array.from(bytes));
        window.viewer.attention.step(performance.now(), false);
      }
      return window.viewer.mien.memoryBytes;
    };
    return [await open(2), await open(8)];
  }, [...readFileSync(glb)]);
  assert.equal(after, before);
  assert.notEqual(await page.run(() => window.viewer.attention.idle), null);
  await page.prefer();
  assert.deepEqual(page.errors, []);
});

test("scenes play as the program plays them, and so do its frames", options, async () => {
  writeFileSync(join(work, "talk.json"), JSON.stringify({ rate: 60, frames: [0, 0.8, 0.2, 0.6].map((jawOpen) => ({ raw: { jawOpen } })) }));
  mien(["clip", "build", join(work, "talk.json"), "-o", join(work, "talk.clip"), "--quiet"]);
  const scene = join(work, "scene.json");
  writeFileSync(scene, JSON.stringify({
    rate: 60, seconds: 2, seed: 7,
    layers: [
      { name: "talk", group: "speech", source: { clip: "talk.clip", loop: true, speed: 0.5 } },
      { name: "joy", group: "emotion", mode: "screen", weight: 0, mask: { controls: ["mouth*", "cheek*"] },
        source: { poses: { joy: { mouthSmileLeft: 0.8, mouthSmileRight: 0.8, browInnerUp: 1 } }, weights: { joy: 1 } } },
      { name: "eyes", group: "life", source: { generator: "gaze", jitter: 0.2 } },
      { name: "breath", group: "life", mode: "add", source: { generator: "breath" } },
      { name: "blink", group: "life", mode: "max", source: { generator: "blink", period: 1 } },
    ],
    guards: ["lips"], antagonists: true, limits: true, reactions: [{ name: "glare", preset: "glare" }],
    events: [
      { time: 0.3, layer: "joy", weight: 1, fade: 0.2 }, { time: 0.5, variable: "gaze.x", value: 0.3 },
      { time: 0.7, layer: "talk", stop: true, fade: 0.1 }, { time: 1, trigger: "glare", strength: 1, hold: 0.3 },
      { time: 1.5, layer: "talk", play: { clip: "talk.clip" }, transition: "crossfade" },
    ],
  }));
  mien(["play", scene, dna, "-o", join(work, "played.json"), "--quiet"]);
  const native = JSON.parse(readFileSync(join(work, "played.json")));
  const [raw, shut] = [native.frames.flatMap((frame) => frame.raw), native.controls.indexOf("eyeBlinkLeft")];
  assert.ok(native.frames.some((frame) => frame.raw[shut] > 0.9), "the light closes the eyes");
  const played = () => page.run(() => {
    const { clip } = window.viewer.player.take;
    const { channelCount } = clip.info;
    return [clip.channels.map(({ name }) => name), Array.from(clip.read()), channelCount];
  });
  await open(dna);
  await open(scene);
  assert.match(await text("error"), /the clip talk\.clip is missing: drop it together/);
  await open(scene, join(work, "talk.clip"));
  assert.match(await text("file"), /72 controls played, 2\.0 s/);
  for (const file of [null, join(work, "played.json")]) {
    if (file) await open(file);
    const [names, values, width] = await played();
    const columns = native.controls.map((name) => names.indexOf(name));
    const found = native.frames.flatMap((_, frame) => columns.map((column) => values[frame * width + column]));
    assert.ok(sameBits(Float32Array.from(found), Float32Array.from(raw)), file ?? scene);
  }
  // Scrubbed to the light, the head turns away from it.
  await page.run(() => window.viewer.player.seek(1.3));
  await frames();
  assert.notEqual(await page.run(() => window.viewer.stage.pivot.matrix.elements[8]), 0);
  for (const [wrong, says] of [[{ layers: [{ name: "x", source: { poses: { p: { nobody: 1 } } } }] }, /no control "nobody"/],
    [{ layers: [{ name: "x", source: { speech: { text: "It's me", voice: "de" } } }] },
      /mien speak 'It'\\''s me' --voice 'de' -o 'x\.speech\.json', and drop it/],
    [{ layers: [{ name: "x", source: { live: true } }, { name: "y", source: { live: true } }] }, /several layers are live/],
    [{ layers: [{ name: "x", group: "choir", source: { generator: "blink" } }] }, /"choir" is none of base/]]) {
    writeFileSync(scene, JSON.stringify(wrong));
    await open(scene);
    assert.match(await text("error"), says);
  }
  await page.run(() => document.getElementById("neutral").click());
  page.errors.length = 0;
});

test("scenes speak as in the program, with takes of `mien speak`", options, async () => {
  const phonemes = (name, labels) => {
    const list = labels.map((label, i) => ({ label, begin: 0.1 + 0.15 * i, end: 0.25 + 0.15 * i, stress: i === 1 ? "primary" : "none" }));
    writeFileSync(join(work, name), JSON.stringify({ alphabet: "ipa", phonemes: list }));
    return { phonemes: name };
  };
  const [first, second] = [phonemes("first.json", ["m", "a", "p", "o"]), phonemes("second.json", ["f", "i", "b", "u"])];
  const scene = join(work, "speaks.json");
  writeFileSync(scene, JSON.stringify({
    rate: 50, seconds: 2.5, seed: 3, guards: ["lips"], limits: true,
    layers: [{ name: "talk", group: "speech", source: { speech: first } },
      { name: "joy", group: "emotion", mode: "screen", source: { poses: { joy: { mouthSmileLeft: 0.8, mouthSmileRight: 0.8, jawOpen: 0.3 } }, weights: { joy: 1 } } }],
    events: [{ time: 0.9, layer: "talk", play: { speech: second, start: 0.05, speed: 0.8 }, transition: "cut" },
      { time: 1.9, layer: "talk", play: { speech: first } }, { time: 2.2, layer: "talk", stop: true, fade: 0.1 }],
  }));
  const takes = [["first.json", "talk.speech.json"], ["second.json", "talk-2.speech.json"]].map(([from, to]) => {
    mien(["speak", "--phonemes", join(work, from), "-o", join(work, to), "--quiet"]);
    return join(work, to);
  });
  mien(["play", scene, baked, "-o", join(work, "spoken.json"), "--quiet"]);
  const native = JSON.parse(readFileSync(join(work, "spoken.json")));
  // `mien view` makes the takes itself.
  const viewing = spawn(program, ["view", baked, scene, "--no-open"]);
  let direct;
  try {
    const [address] = await once(viewing.stdout, "data");
    await page.goto(String(address).trim());
    await page.until("() => window.viewer?.player.take && !document.body.hasAttribute('aria-busy')", "opened");
    assert.match(await text("file"), /72 controls played, 2\.5 s/);
    direct = await page.run(() => Array.from(window.viewer.player.take.clip.read()));
  } finally {
    viewing.kill("SIGINT");
    await once(viewing, "exit");
  }
  await page.goto(server.url);
  await page.until("() => document.body.dataset.ready", "loaded");
  await open(baked);
  await open(scene, takes[0]);
  assert.match(await text("error"), /make it with mien speak --phonemes 'second\.json' -o 'talk-2\.speech\.json'/);
  await open(...takes, scene);
  assert.match(await text("file"), /72 controls played, 2\.5 s/);
  const [names, values] = await page.run(() => {
    const { clip } = window.viewer.player.take;
    return [clip.channels.map(({ name }) => name), Array.from(clip.read())];
  });
  assert.deepEqual(direct, values);
  const curve = (name) => Float32Array.from({ length: native.frames.length }, (_, frame) => values[frame * names.length + names.indexOf(name)]);
  for (const [i, name] of native.controls.entries()) {
    assert.ok(sameBits(curve(name), Float32Array.from(native.frames, ({ raw }) => raw[i])), name);
  }
  const up = Float32Array.from(native.frames, ({ variables }) => variables[native.variables.indexOf("head.up")]);
  assert.ok(up.some((value) => value < -0.01) && curve("jawOpen").some((value) => value > 0.1), "the head beats and the jaw opens");
  assert.ok(sameBits(curve("head.up"), up));
  writeFileSync(takes[0], "{\"frames\": [{}, {}]}");
  await open(...takes, scene);
  assert.match(await text("error"), /talk\.speech\.json is no take of `mien speak`/);
  await press("neutral");
  page.errors.length = 0;
});

test("a sound that the browser holds back until the page is used joins in then", options, async () => {
  const [csv, wav] = [join(work, "held.csv"), join(work, "held.wav")];
  const rows = Array.from({ length: 2400 }, (_, i) => `00:00:00:${String(i % 60).padStart(2, "0")}.000,1,0.5`);
  writeFileSync(csv, ["Timecode,BlendShapeCount,JawOpen", ...rows].join("\n"));
  const header = Buffer.from("UklGRgAAAABXQVZFZm10IBAAAAABAAEAQB8AAEAfAAABAAgAZGF0YQ==", "base64"); // 8000 a second, 8 bits
  const size = Buffer.alloc(4);
  size.writeUInt32LE(8000 * 30);
  writeFileSync(wav, Buffer.concat([header, size, Buffer.alloc(8000 * 30, 128)]));
  // Page.run() acts as if the page was used.
  const value = async (expression) => (await page.send("Runtime.evaluate", { expression, returnByValue: true })).result.value;
  const until = async (expression) => {
    for (const end = Date.now() + 60000; !(await value(expression)); ) {
      assert.ok(Date.now() < end, expression);
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
  };
  const viewing = spawn(program, ["view", baked, csv, wav, "--no-open"]);
  try {
    const [address] = await once(viewing.stdout, "data");
    await page.goto(String(address).trim());
    await until("Boolean(window.viewer?.player.sound?.isWaiting)");
    assert.match(await value("document.getElementById('file').textContent"), /held\.wav: press a key, or the page, to hear it/);
    await until("window.viewer.player.take.time > 1"); // the face moves
    assert.equal(await value("window.viewer.player.sound.time"), null);
    await page.key("a");
    await until("document.getElementById('file').textContent === 'held.wav: 30.0 s of sound'");
    assert.ok(await value("window.viewer.player.sound.time") > 1);
    assert.deepEqual(page.errors, []);
  } finally {
    viewing.kill("SIGINT");
    await once(viewing, "exit");
  }
  await page.goto(server.url);
  await page.until("() => document.body.dataset.ready", "loaded");
});

test("the live layer of a scene takes what the microphone and streams send", options, async () => {
  await open(baked);
  const scene = join(work, "live.json");
  writeFileSync(scene, JSON.stringify({ seconds: 1, layers: [{ name: "me", weight: 0.5, source: { live: true } },
    { name: "joy", group: "emotion", source: { poses: { joy: { mouthSmileLeft: 0.75 } }, weights: { joy: 1 } } }],
    events: [{ time: 0.5, layer: "joy", weight: 0 }] }));
  await open(scene);
  assert.match(await text("file"), /head\.rig: a live scene of 1\.0 s; press Microphone/);
  const found = await page.run(() => {
    const { model, player } = window.viewer;
    player.stop();
    const { take } = player;
    const seen = () => {
      take.apply(model);
      return ["jawOpen", "mouthSmileLeft"].map((name) => model.face.controls[name]);
    };
    take.seek(0);
    const list = [seen()];
    for (let i = 0; i < 20; ++i) {
      take.push(model.controlsOf({ jawOpen: 0.5 }));
      take.advance(1 / 60);
    }
    list.push(seen());
    take.seek(take.time + 1 / 60); // to where its sound is
    list.push(seen());
    take.seek(0.75);
    list.push(seen());
    return [list, take.advance(0.5), take.time];
  });
  assert.deepEqual(found, [[[0, 0.75], [0.25, 0.75], [0.25, 0.75], [0, 0]], true, 0]);
  await press("play");
  await press("listen");
  await page.until("() => window.viewer.model.face.controls.jawOpen > 0.1", "opened");
  assert.equal(await page.run(() => window.viewer.player.isPlaying), true);
  await press("listen");
  await press("neutral");
  assert.deepEqual(page.errors, []);
});

test("what a mix file does by itself plays", options, async () => {
  await open(baked);
  const bytes = await page.run(async () => {
    const { BlendMode, Generator, MixLayer, ticks } = await import("mien");
    const mix = window.viewer.model.rig.mix({ layers: [
      MixLayer.generator(Generator.BLINK, { eyeBlinkLeft: 1 }, { period: ticks(1), mode: BlendMode.MAX })] });
    return Array.from(mix.write());
  });
  const file = join(work, "life.mix");
  writeFileSync(file, Uint8Array.from(bytes));
  await open(file);
  assert.match(await text("file"), /controls played, 10\.0 s/);
  const most = await page.run(() => {
    const { clip } = window.viewer.player.take;
    const [values, width, blink] = [clip.read(), clip.info.channelCount, clip.findChannel("eyeBlinkLeft")];
    return values.reduce((largest, value, i) => (i % width === blink ? Math.max(largest, value) : largest), 0);
  });
  assert.equal(most, 1);
  writeFileSync(file, "no mix");
  await open(file);
  assert.match(await text("error"), /life\.mix could not be opened/);
  await page.run(() => document.getElementById("neutral").click());
  page.errors.length = 0;
});

test("the animation of a GLB plays and can be scrubbed", options, async () => {
  const glb = join(work, "moving.glb");
  mien(["export", dna, "-o", glb, "--lod", "6", "--bake", "arkit", "--animation", "-", "--fps", "10", "--quiet"],
    JSON.stringify({ frames: [0, 0.5, 1].map((jawOpen) => ({ raw: { jawOpen } })) }));
  await open(glb);
  assert.match(await text("file"), /moving\.glb: an animation of 0\.2 s/);
  assert.equal(await page.run(() => window.viewer.player.isPlaying), true);
  const jawAt = (time) => page.run((seconds) => {
    const { model, player } = window.viewer;
    player.seek(seconds);
    const index = model.list.indexOf("jawOpen");
    const [mesh, target] = model.targets.get("jawOpen")[0];
    return [model.values()[index], mesh.morphTargetInfluences[target], player.isPlaying];
  }, time);
  for (const [time, value] of [[0, 0], [0.05, 0.25], [0.1, 0.5], [0.2, 1]]) {
    const [slider, target, isPlaying] = await jawAt(time);
    assert.ok(Math.abs(slider - value) < 1e-3, `${slider} at ${time} s`);
    assert.deepEqual([Math.fround(target), isPlaying], [slider, false]);
  }
  // At its end it begins again.
  assert.deepEqual(await page.run(() => {
    const { take } = window.viewer.player;
    return [take.advance(0.05), Math.round(take.time * 100)];
  }), [true, 5]);
  // Idle life goes on over a take that does not play, and is no part of it.
  await page.prefer({ motion: true });
  await page.until("() => window.viewer.attention.idle", "alive");
  const [closed, kept, open0] = await page.run(() => {
    const { attention, model, player } = window.viewer;
    const weight = () => model.targets.get("eyeBlinkLeft").map(([mesh, target]) => mesh.morphTargetInfluences[target])[0];
    for (let i = 0; i < 1200 && weight() < 0.5; ++i) {
      attention.idle.step(1 / 60, model.face);
      model.update(attention.idle.face);
    }
    const before = weight();
    player.seek(0.1);
    return [before, model.values()[model.list.indexOf("eyeBlinkLeft")], weight()];
  });
  assert.ok(closed >= 0.5, String(closed));
  assert.deepEqual([kept, open0], [0, 0]);
  await page.prefer();
  await slide("jawOpen", 0.4);
  await frames();
  assert.equal((await jawAtRest())[0], Math.fround(0.4));
  assert.deepEqual(page.errors, []);
});

const jawAtRest = () => page.run(() => [window.viewer.model.targets.get("jawOpen")[0]].map(([mesh, target]) => Math.fround(mesh.morphTargetInfluences[target])));

/** Presses the button with a text. */
const pressText = (wanted) => page.run((of) => [...document.querySelectorAll("button")].find((button) => button.textContent === of).click(), wanted);

test("the camera goes to regions, and lights change what is seen", options, async () => {
  await open(dna);
  const camera = () => page.run(() => {
    const { camera: { position }, controls: { target } } = window.viewer.stage;
    return { position: position.toArray(), target: target.toArray(), distance: position.distanceTo(target) };
  });
  assert.deepEqual(await page.run(() => [...document.querySelectorAll("#regions button")].map((button) => button.textContent)),
    ["Head", "Face", "Eyes", "Mouth", "Left", "Right"]);
  const seen = {};
  for (const name of ["Head", "Face", "Eyes", "Mouth", "Left", "Right"]) {
    await pressText(name);
    seen[name] = await camera();
  }
  assert.ok(seen.Head.distance > seen.Face.distance && seen.Face.distance > seen.Eyes.distance && seen.Eyes.distance > seen.Mouth.distance);
  assert.ok(seen.Eyes.target[1] > seen.Face.target[1] && seen.Face.target[1] > seen.Mouth.target[1]);
  assert.ok(seen.Left.position[0] > 0.3 && seen.Right.position[0] < -0.3);
  await pressText("Face");
  // The brightness of the left and the right half of the face.
  const halves = () => page.run(() => {
    const { renderer, scene, camera: of, canvas } = window.viewer.stage;
    renderer.render(scene, of);
    const context = new OffscreenCanvas(32, 32).getContext("2d");
    context.drawImage(canvas, 0, 0, 32, 32);
    const { data } = context.getImageData(0, 0, 32, 32);
    const sums = [0, 0];
    for (let i = 0; i < 1024; ++i) if (data[4 * i + 3] > 250) sums[i % 32 < 16 ? 0 : 1] += data[4 * i + 1];
    return sums[0] / sums[1];
  });
  const studio = await halves();
  await choose("light", "Side");
  const side = await halves();
  assert.ok(side > 1.3 * studio, `${side} ${studio}`);
  const count = () => page.run(() => window.viewer.stage.scene.children.filter((child) => child.isLight).length);
  assert.equal(await count(), 4);
  await choose("light", "Studio");
  assert.equal(await count(), 6);
  assert.deepEqual(page.errors, []);
});

test("edges are seen near by, and fade where they would make patterns", options, async () => {
  await page.size(390, 844, true);
  await open(baked);
  // How many of the pixels of the face lines make clearly darker or brighter, in thousandths.
  const changed = (region, away) => page.run(async (name, times) => {
    const { stage } = window.viewer;
    const { renderer, scene, camera, canvas, controls } = stage;
    stage.lookAt(name);
    camera.position.sub(controls.target).multiplyScalar(times).add(controls.target);
    controls.update();
    const wire = document.getElementById("wire");
    const seen = [false, true].map((on) => {
      wire.checked = on;
      wire.dispatchEvent(new Event("change"));
      renderer.render(scene, camera);
      const context = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
      context.drawImage(canvas, 0, 0);
      return context.getImageData(0, 0, canvas.width, canvas.height).data;
    });
    let [face, clearly] = [0, 0];
    for (let i = 0; i < seen[0].length; i += 4) {
      if (seen[0][i + 3] < 255) continue;
      ++face;
      if (Math.abs(seen[1][i + 1] - seen[0][i + 1]) > 25 || seen[1][i + 3] < 255) ++clearly;
    }
    return Math.round(1000 * clearly / face);
  }, region, away);
  const [far, near] = [await changed("Head", 4), await changed("Eyes", 1)];
  assert.ok(far < 20 && near > 70, `${far} ${near}`);
  const lines = () => page.run(() => {
    const { object } = window.viewer.model;
    const meshes = [];
    object.traverse((mesh) => { if (mesh.isMesh && mesh.visible && !mesh.material.transparent) meshes.push(mesh.geometry.uuid); });
    return [window.viewer.stage.pivot.children.find((child) => child.isGroup && child !== object).children.map((one) => one.geometry.uuid), meshes];
  });
  for (const file of [join(work, "head.glb"), dna]) {
    await open(file);
    await choose("lod", "3");
    await frames();
    const [shown, meshes] = await lines();
    assert.deepEqual(shown, meshes, file);
  }
  await choose("wire", false);
  assert.deepEqual((await lines())[0], []);
  await page.size(800, 400);
  assert.deepEqual(page.errors, []);
});

test("what was kept is seen beside, instead of and as the difference from what is shown", options, async () => {
  await open(dna);
  await press("keep");
  const shown = () => page.run(() => {
    const { stage } = window.viewer;
    return { now: stage.pivot.visible, before: stage.other !== null && stage.scene.children.includes(stage.other), apart: stage.pivot.matrix.elements[12] };
  });
  await frames();
  const { apart, ...both } = await shown();
  assert.deepEqual([both, apart > 0.1], [{ now: true, before: true }, true]);
  // The same pose does not differ, and no rounding is shown as if it did.
  await choose("compare", "difference");
  await frames();
  assert.match(await text("heat-legend"), /as in head\.dna\. Red: 0\.0 mm/);
  const colors = () => page.run(() => {
    const { array } = window.viewer.model.object.children.find((mesh) => mesh.visible).geometry.attributes.color;
    return new Set(array.filter((_, i) => i % 3 === 0)).size;
  });
  assert.equal(await colors(), 1, "all gray");
  await slide("jawOpen", 1);
  await frames();
  assert.match(await text("heat-legend"), /Red: [1-9]\d\.\d mm/);
  assert.ok(await colors() > 100);
  await choose("compare", "before");
  await frames();
  assert.deepEqual(await shown(), { now: false, before: true, apart: 0 });
  // Another file, here the same head from its baked file.
  await choose("compare", "difference");
  await open(baked);
  assert.match(await text("heat-legend"), /as in head\.dna\. Red: 0\.0 mm/);
  // A GLB is kept as its targets move it.
  await open(join(work, "head.glb"));
  await press("keep");
  await frames();
  assert.ok((await shown()).before);
  await choose("compare", "now");
  assert.deepEqual(page.errors, []);
});

test("the heat map of the neutral pose is gray", options, async () => {
  await open(dna);
  await choose("heat", true);
  await frames();
  assert.match(await text("heat-legend"), /moved by 0\.0 mm/);
  assert.equal(await page.run(() => new Set(window.viewer.model.object.children.filter((mesh) => mesh.visible)
    .flatMap((mesh) => Array.from(mesh.geometry.attributes.color.array.filter((_, i) => i % 3 === 0)))).size), 1);
  await choose("heat", false);
});

test("a louder voice opens the mouth more, and silence closes it", options, async () => {
  const run = (steps) => page.run(async (list) => {
    const { MouthDrive } = await import("./microphone.js");
    const drive = new MouthDrive();
    return list.map(([energy, seconds]) => {
      for (let i = 0; i < seconds * 60; ++i) drive.step(energy, 1 / 60);
      return drive.open;
    });
  }, steps);
  const [room, loud, softer, after] = await run([[0.001, 3], [0.2, 0.5], [0.03, 0.5], [0.001, 1]]);
  assert.equal(room, 0);
  assert.ok(loud > 0.95 && softer > 0.2 && softer < 0.8 * loud && after < 0.01, `${loud} ${softer} ${after}`);
  // A louder room is still no voice, once it is known.
  const [still] = (await run([[0.02, 30]])).slice(-1);
  assert.equal(still < 0.05, true, String(still));
});

test("the microphone drives the jaw until it is stopped, and a refusal is said", options, async () => {
  await open(baked);
  await slide("mouthSmileLeft", 0.5);
  await press("listen");
  const jaw = "() => window.viewer.model.face.controls.jawOpen";
  await page.until(`() => (${jaw})() > 0.2`, "opened");
  await page.until(`() => (${jaw})() < 0.1`, "closed between two beeps");
  assert.equal(await page.run(() => window.viewer.model.face.controls.mouthSmileLeft), 0.5);
  const track = await page.run(() => {
    window.heardTrack = window.viewer.microphone.stream.getTracks()[0];
    return window.heardTrack.readyState;
  });
  await press("listen");
  assert.deepEqual([track, await page.run(() => window.heardTrack.readyState), await page.run(() => window.viewer.microphone)], ["live", "ended", null]);
  assert.equal(await page.run(() => window.viewer.model.face.controls.jawOpen), 0);
  await page.run(() => {
    navigator.mediaDevices.getUserMedia = () => Promise.reject(new DOMException("no", "NotAllowedError"));
  });
  await press("listen");
  await page.until("() => !document.getElementById('error').hidden", "refused");
  assert.match(await text("error"), /The microphone cannot be used: its use was not allowed/);
  assert.equal(await text("listen"), "Microphone");
});

test("all of the page is reached on the screen of a phone", options, async () => {
  await page.size(390, 844, true);
  await open(baked);
  const sizes = await page.run(() => ({
    wide: document.documentElement.scrollWidth, tall: document.documentElement.scrollHeight,
    canvas: document.getElementById("stage").clientHeight,
    small: [...document.querySelectorAll("button, select, #list input")].filter((one) => one.offsetParent && one.getBoundingClientRect().height < 24)
      .map((one) => one.id || one.textContent),
    outside: [...document.querySelectorAll("#panel *")].filter((one) => one.offsetParent && one.getBoundingClientRect().right > innerWidth + 0.5)
      .map((one) => one.id || one.tagName),
  }));
  assert.ok(sizes.wide <= 390 && sizes.tall <= 844 && sizes.canvas >= 300, JSON.stringify(sizes));
  assert.deepEqual([sizes.small, sizes.outside], [[], []]);
  // The face fills the width that there is, and no more.
  const face = await page.run(() => {
    const { object, camera } = window.viewer.stage;
    const xs = [];
    const mesh = object.children.find((one) => one.visible);
    const { position } = mesh.geometry.attributes;
    for (let i = 0; i < position.count; i += 50) xs.push(camera.position.clone().fromBufferAttribute(position, i).applyMatrix4(mesh.matrixWorld).project(camera).x);
    return [Math.min(...xs), Math.max(...xs)];
  });
  assert.ok(face[0] > -1 && face[1] < 1 && face[1] - face[0] > 0.8, String(face));
  if (process.env.MIEN_SHOTS) writeFileSync(join(process.env.MIEN_SHOTS, "phone_open.png"), await page.screenshot());
  await page.size(800, 400);
  assert.deepEqual(page.errors, []);
});

/** A packet of the Live Link Face app with one of its 61 values. */
function packet(frame, number, value) {
  const bytes = Buffer.alloc(1 + 4 + 5 + 4 + 4 + 16 + 1 + 4 * 61);
  let at = bytes.writeUInt8(6);
  for (const text of ["phone", "face"]) {
    at = bytes.writeInt32BE(text.length, at);
    at += bytes.write(text, at);
  }
  at = bytes.writeInt32BE(frame, at) + 4; // and no part of a frame
  at = bytes.writeInt32BE(1, bytes.writeInt32BE(60, at));
  at = bytes.writeUInt8(61, at);
  bytes.writeFloatBE(value, at + 4 * number);
  return bytes;
}

test("`mien view --live` shows what a phone sends", options, async () => {
  const server = spawn(program, ["view", dna, "--no-open", "--live", "livelink://127.0.0.1:0"]);
  const socket = createSocket("udp4");
  let timer;
  try {
    let said = "";
    server.stderr.on("data", (bytes) => { said += bytes; });
    const [address] = await once(server.stdout, "data");
    await page.goto(String(address).trim());
    await page.until("() => window.viewer?.model && !document.body.hasAttribute('aria-busy')", "opened");
    const port = Number(/listening on livelink:\/\/127\.0\.0\.1:(\d+)/.exec(said)[1]);
    let frame = 0;
    timer = setInterval(() => socket.send(packet(++frame, 17, 0.625), port, "127.0.0.1"), 16); // 17: jawOpen
    await page.until("() => window.viewer.model.face.controls.jawOpen === 0.625 && window.viewer.live.rows > 2", "moved");
    assert.match(await text("file"), /head\.dna: live/);
    // Scenes play over it.
    const scene = join(work, "over.json");
    writeFileSync(scene, JSON.stringify({ seconds: 60, layers: [{ name: "joy", group: "emotion",
      source: { poses: { joy: { mouthSmileLeft: 0.75 } }, weights: { joy: 1 } } }] }));
    await open(scene);
    await page.until(`() => {
      const { model: { face: { controls } }, player } = window.viewer;
      return player.isPlaying && player.take.time > 0 && controls.jawOpen === 0.625 && controls.mouthSmileLeft === 0.75;
    }`, "both");
    assert.deepEqual(page.errors, []);
  } finally {
    clearInterval(timer);
    socket.close();
    server.kill("SIGINT");
    await once(server, "exit");
  }
  // The page says when the program has ended.
  await page.until("() => /Live data have ended/.test(document.getElementById('file').textContent)", "ended");
});
