// SPDX-License-Identifier: MIT
// The page: opens files, and connects its controls with what is shown.
import { Isa, Mien, Preset, TICKS_PER_SECOND } from "mien";
import { readCsv, readJson } from "./files.js";
import { Materials } from "./materials.js";
import { GlbModel, RigModel } from "./models.js";
import { Panel } from "./panel.js";
import { PRESETS } from "./presets.js";
import { exportGlb, Recording } from "./record.js";
import { Sound, SOUNDS } from "./sound.js";
import { HeatMap, Stage } from "./stage.js";

const $ = (id) => document.getElementById(id);
const stage = new Stage($("canvas"));
const heat = new HeatMap();
const panel = new Panel({
  changed(kind, index, value) {
    stop();
    model.set(kind, index, value);
    pose();
  },
  inspected: (kind, index) => inspect(kind, index),
});

let mien = null;
let model = null;
let opened = null; // name and bytes of the model
let take = null; // what plays: clip, player, binding
let sound = null; // what is heard while it plays
let recording = null;
let dirty = false;

// ---- messages ---------------------------------------------------------------------------------------

function say(text) {
  $("file").textContent = text;
}

/** Shows what went wrong; what was open stays open. */
function fail(what, error) {
  console.error(error);
  const place = error.byteOffset !== undefined && error.byteOffset !== null ? ` (at byte ${error.byteOffset})` : "";
  $("error").textContent = `${what}: ${error.message}${place}`;
  $("error").hidden = false;
}

function clearError() {
  $("error").hidden = true;
  $("error").textContent = "";
}

/** Runs a task; a failure becomes a message. */
async function attempt(what, task) {
  document.body.setAttribute("aria-busy", "true");
  try {
    await task();
    return true;
  } catch (error) {
    fail(what, error);
    return false;
  } finally {
    document.body.removeAttribute("aria-busy");
  }
}

// ---- opening ----------------------------------------------------------------------------------------

async function loadModule() {
  // On one thread unless the address says ?threads=N: a head of this size gains little.
  mien ??= await Mien.load({ threads: Number(new URLSearchParams(location.search).get("threads") ?? 1) });
}

async function openModel(name, bytes, materials) {
  const options = {
    isa: Number($("isa").value) || Isa.SSE2, skinning: $("skinning").value, showFilms: $("films").checked, materials,
  };
  const isGlb = bytes.length >= 4 && String.fromCharCode(...bytes.subarray(0, 4)) === "glTF";
  if (!isGlb) await loadModule();
  const made = isGlb ? await GlbModel.open(mien, bytes) : await RigModel.open(mien, bytes, options);
  dropTake();
  heat.end();
  model?.dispose();
  model = made;
  if (opened?.materials !== materials) opened?.materials?.dispose();
  opened = { name, bytes, materials };
  $("welcome").hidden = true;
  stage.show(model.object);
  fillView(isGlb);
  panel.show(model);
  showPresets();
  for (const id of ["pose", "view", "sliders"]) $(id).hidden = false;
  $("inspect").hidden = $("save-glb").hidden = isGlb;
  dropRecording();
  $("play").hidden = $("time-row").hidden = true;
  dropSound();
  $("facts").textContent = model.facts;
  say(name);
  pose();
}

async function openTake({ names, values, rate }) {
  if (!(model instanceof RigModel)) throw new Error("open a rig first, then what it plays");
  openClip(mien.buildClip({ names, values, rateNumerator: rate, rateDenominator: 1 }));
}

function openClip(clip) {
  const binding = clip.bind(model.rig, { matrix: mien.arkitMatrix() });
  if (binding.info.controls.length === 0) {
    for (const object of [binding, clip]) object.dispose();
    throw new Error("none of its channels is a control of this rig");
  }
  dropTake();
  dropSound();
  take = { clip, binding, player: clip.player({ looping: 2 }), isPlaying: false, last: 0 };
  $("play").hidden = $("time-row").hidden = false;
  $("time").max = String(clip.duration);
  say(`${opened.name}: ${binding.info.controls.length} controls played, ${clip.duration.toFixed(1)} s`);
  play();
}

async function openSound(name, bytes) {
  if (!take) throw new Error("open a rig and a take first, then its sound");
  const made = await Sound.open(name, bytes);
  stop();
  dropSound();
  sound = made;
  sound.isMuted = $("mute").checked;
  $("mute-row").hidden = false;
  say(`${opened.name}, ${name}: ${sound.duration.toFixed(1)} s of sound`);
  take.player.seek(0);
  play();
}

async function openBytes(name, bytes, materials) {
  clearError();
  if (SOUNDS.test(name)) return openSound(name, bytes);
  const ending = name.slice(name.lastIndexOf(".") + 1).toLowerCase();
  if (ending === "csv") return openTake(readCsv(new TextDecoder().decode(bytes)));
  if (ending === "json") {
    const read = readJson(new TextDecoder().decode(bytes));
    if (!read.pose) return openTake(read);
    if (!model) throw new Error("open a rig first, then a pose");
    stop();
    const missing = model.setPose(read.pose);
    pose();
    if (missing.length) throw new Error(`this rig has no ${missing.slice(0, 5).join(", ")}${missing.length > 5 ? " …" : ""}`);
    return undefined;
  }
  if (ending === "clip") {
    if (!(model instanceof RigModel)) throw new Error("open a rig first, then what it plays");
    return openClip(await mien.openClip(bytes));
  }
  say(`Opening ${name} …`);
  const before = opened?.name ?? "No file is open.";
  try {
    return await openModel(name, bytes, materials);
  } catch (error) {
    say(before);
    throw error;
  }
}

/** The materials, and what tells why there are none. */
async function openMaterials(name, text, find) {
  try {
    return [await Materials.open(text, find), () => {}];
  } catch (error) {
    return [undefined, () => fail(`${name} could not be read`, error)];
  }
}

/** Once the rig is open, because that clears messages. */
function sayAboutMaterials(materials, sayFailure) {
  sayFailure?.();
  if (!materials?.missing.length) return;
  fail("Some textures are missing", new Error(`${materials.missing.slice(0, 5).join(", ")}; drop them together with the rig`));
}

async function openFiles(files) {
  const is = (ending) => (file) => ending.test(file.name);
  const list = [...files];
  // Images are found by their names alone: a page does not learn the folders of files.
  const images = list.filter(is(/\.(png|jpe?g)$/i));
  const ofMaterials = list.find(is(/\.materials\.json$/i));
  const [materials, sayFailure] = !ofMaterials ? [] : await openMaterials(ofMaterials.name, await ofMaterials.text(), async (path) => {
    const name = path.slice(path.lastIndexOf("/") + 1);
    return images.find((image) => image.name === name) ?? null;
  });
  // Rigs before what they play, and takes before their sound.
  const order = (file) => (SOUNDS.test(file.name) ? 2 : /\.(csv|json|clip)$/i.test(file.name) ? 1 : 0);
  const others = list.filter((file) => file !== ofMaterials && !(ofMaterials && images.includes(file)));
  if (materials && others.length === 0 && opened) {
    // For the rig that is open.
    const before = opened.materials;
    opened.materials = materials;
    await reopen();
    before?.dispose();
  }
  for (const file of others.sort((a, b) => order(a) - order(b))) {
    await attempt(`${file.name} could not be opened`, async () => openBytes(file.name, new Uint8Array(await file.arrayBuffer()), materials));
  }
  sayAboutMaterials(materials, sayFailure);
}

function openHead() {
  return attempt("The head could not be generated", async () => {
    clearError();
    say("Generating the head …");
    await new Promise((resolve) => setTimeout(resolve, 30)); // for the text to be seen
    await loadModule();
    const dna = mien.generate(Preset.HEAD);
    const bytes = dna.write();
    dna.dispose();
    await openModel("Built-in head", bytes);
  });
}

// ---- pose -------------------------------------------------------------------------------------------

/** The controls have changed: the next frame shows it. */
function pose() {
  dirty = true;
  stage.request();
}

stage.beforeDraw = (time) => {
  if (!model) return false;
  if (take?.isPlaying) advance(time);
  if ($("auto-lod").checked && model.rig) {
    const lod = model.object.lodOf(stage.camera);
    if (lod !== model.object.lod) setLod(lod);
  }
  if (dirty) {
    dirty = false;
    model.update();
    if (model.rig) afterUpdate();
    panel.refresh();
  }
  if (recording && !recording.take(time, model.pose())) endRecording();
  return take?.isPlaying || recording !== null;
};

/** Poses from now on, until the button is pressed again. */
function record() {
  recording = new Recording();
  $("record").textContent = "Stop and download";
  $("record").setAttribute("aria-pressed", "true");
  stage.request();
}

function endRecording() {
  const { frames } = recording;
  const text = recording.json();
  dropRecording();
  if (frames.length) download("take.json", text);
}

function dropRecording() {
  recording = null;
  $("record").textContent = "Record";
  $("record").setAttribute("aria-pressed", "false");
}

function afterUpdate() {
  if ($("heat").checked && $("skinning").value === "mien") {
    const most = heat.apply(model.object) * (model.rig.info.translationUnit === 0 ? 10 : 1000);
    $("heat-legend").textContent = `Gray: still. Red: moved by ${most.toFixed(1)} mm.`;
  }
  if ($("bones").checked) {
    stage.showSkeleton(model.rig.jointParents, model.object.deformed.jointMatrices, model.object.matrix);
  }
  // Clocks of browsers count in tenths of milliseconds.
  const shown = (value) => (value < 0.05 ? "< 0.05 ms" : `${value.toFixed(2)} ms`);
  $("times").replaceChildren(...[["Evaluation", shown(model.times.evaluation)],
    [$("skinning").value === "mien" ? "Deformation" : "Matrices", shown(model.times.deformation)],
    ["LOD", String(model.object.lod)]].flatMap(([term, text]) => {
    const [dt, dd] = [document.createElement("dt"), document.createElement("dd")];
    dt.textContent = term;
    dd.textContent = text;
    return [dt, dd];
  }));
}

function showPresets() {
  const buttons = Object.entries(PRESETS).map(([name, values]) => {
    const found = Object.fromEntries(Object.entries(values).filter(([control]) => model.has(control)));
    // A preset of which the rig has next to nothing would look like another expression.
    if (Object.keys(found).length === 0) return null;
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = name;
    button.addEventListener("click", () => {
      stop();
      model.setPose(found);
      pose();
    });
    return button;
  }).filter(Boolean);
  $("preset-buttons").replaceChildren(...buttons);
  $("presets").hidden = buttons.length === 0;
}

function download(name, content, type = "application/json") {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([content], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

// ---- playing ----------------------------------------------------------------------------------------

function play() {
  take.isPlaying = true;
  take.last = 0;
  $("play").textContent = "Pause";
  // Browsers play no sound before a button of the page is pressed. The face moves all the same.
  sound?.play(take.player.info.tick / TICKS_PER_SECOND).catch(() => say(`${sound.name}: press Pause, then Play, to hear it`));
  stage.request();
}

function stop() {
  if (!take?.isPlaying) return;
  take.isPlaying = false;
  sound?.pause();
  $("play").textContent = "Play";
}

function dropSound() {
  sound?.dispose();
  sound = null;
  $("mute-row").hidden = true;
}

function dropTake() {
  stop();
  if (!take) return;
  for (const object of [take.player, take.binding, take.clip]) object.dispose();
  take = null;
}

function advance(time) {
  const seconds = take.last ? Math.min(0.25, (time - take.last) / 1000) : 0;
  take.last = time;
  const before = take.player.info.tick;
  const heard = sound?.time ?? null;
  if (heard !== null && heard < take.clip.duration) {
    take.player.seek(Math.round(heard * TICKS_PER_SECOND));
  } else {
    take.player.advance(Math.round(seconds * TICKS_PER_SECOND));
    // From the beginning again, with its sound.
    if (take.player.info.tick < before) sound?.play(0).catch(() => {});
  }
  sample();
}

function sample() {
  take.binding.apply(take.player.sample(), model.face);
  $("time").value = String(take.player.info.tick / TICKS_PER_SECOND);
  dirty = true;
}

// ---- view -------------------------------------------------------------------------------------------

function option(value, text) {
  const made = document.createElement("option");
  made.value = String(value);
  made.textContent = text;
  return made;
}

function fillView(isGlb) {
  for (const id of ["lod", "isa", "skinning", "auto-lod", "heat", "bones", "films"]) $(id).disabled = isGlb;
  $("times").replaceChildren();
  if (isGlb) return;
  $("lod").replaceChildren(...Array.from({ length: model.rig.info.lodCount }, (_, lod) => option(lod, String(lod))));
  if (!$("isa").options.length) {
    $("isa").replaceChildren(option(Isa.SSE2, "128-bit vectors"), option(Isa.SCALAR, "scalar"));
  }
  setWire();
}

function setLod(lod) {
  heat.end();
  model.object.lod = lod;
  $("lod").value = String(model.object.lod);
  $("facts").textContent = model.facts;
  setWire();
  pose();
}

function setWire() {
  model?.object.traverse((node) => {
    if (node.isMesh) node.material.wireframe = $("wire").checked;
  });
  stage.request();
}

/** Opens the same file with other options, in the same pose. */
function reopen() {
  return attempt("The file could not be opened again", async () => {
    const kept = model.pose();
    const view = [stage.camera.position.clone(), stage.controls.target.clone()];
    const { lod } = model.object;
    dropTake();
    await openModel(opened.name, opened.bytes, opened.materials);
    model.setPose(kept);
    setLod(lod);
    stage.camera.position.copy(view[0]);
    stage.controls.target.copy(view[1]);
    stage.controls.update();
  });
}

function inspect(kind, index) {
  if (!model.rig || kind !== "raw") {
    $("inspected").textContent = "Select a raw control by its name.";
    $("moved").replaceChildren();
    return;
  }
  const moved = model.inspect(index);
  const name = model.names(kind)[index];
  const count = (of, word) => {
    const number = moved.filter(([what]) => what === of).length;
    return `${number} ${word}${number === 1 ? "" : "s"}`;
  };
  $("inspected").textContent = moved.length
    ? `${name} at 1 moves ${count("joint", "joint")}, ${count("shape", "shape")}, ${count("map", "map")}.`
    : `${name} alone moves nothing.`;
  $("moved").replaceChildren(...moved.map(([what, of, text]) => {
    const item = document.createElement("li");
    for (const part of [`${what} ${of}`, text]) {
      const span = document.createElement("span");
      span.textContent = part;
      item.append(span);
    }
    return item;
  }));
}

// ---- events -----------------------------------------------------------------------------------------

$("open").addEventListener("click", () => $("files").click());
$("files").addEventListener("change", async () => {
  await openFiles($("files").files);
  $("files").value = "";
});
$("head").addEventListener("click", openHead);
$("neutral").addEventListener("click", () => {
  stop();
  model.setPose({});
  pose();
});
$("save").addEventListener("click", () => {
  download("pose.json", `${JSON.stringify({ frames: [{ raw: model.pose() }] }, null, 2)}\n`);
});
$("save-glb").addEventListener("click", () => attempt("The head could not be exported", async () => {
  download("head.glb", await exportGlb(model), "model/gltf-binary");
}));
$("record").addEventListener("click", () => (recording ? endRecording() : record()));
$("play").addEventListener("click", () => (take.isPlaying ? stop() : play()));
$("time").addEventListener("input", () => {
  stop();
  take.player.seek(Math.round(Number($("time").value) * TICKS_PER_SECOND));
  sound?.seek(Number($("time").value));
  sample();
  pose();
});
$("mute").addEventListener("change", () => {
  if (sound) sound.isMuted = $("mute").checked;
});
$("lod").addEventListener("change", () => {
  $("auto-lod").checked = false;
  setLod(Number($("lod").value));
});
for (const id of ["isa", "skinning", "films"]) $(id).addEventListener("change", reopen);
$("skinning").addEventListener("change", () => {
  $("heat").disabled = $("skinning").value === "gpu";
});
$("wire").addEventListener("change", setWire);
$("auto-lod").addEventListener("change", () => stage.request());
$("bones").addEventListener("change", () => {
  if (!$("bones").checked) stage.hideSkeleton();
  pose();
});
$("heat").addEventListener("change", () => {
  if (!$("heat").checked) heat.end();
  $("heat-legend").hidden = !$("heat").checked;
  pose();
});

let over = 0;
addEventListener("dragenter", (event) => {
  event.preventDefault();
  if (++over === 1) $("drop").hidden = false;
});
addEventListener("dragleave", () => {
  if (--over === 0) $("drop").hidden = true;
});
addEventListener("dragover", (event) => event.preventDefault());
addEventListener("drop", (event) => {
  event.preventDefault();
  over = 0;
  $("drop").hidden = true;
  openFiles(event.dataTransfer.files);
});

// For the console, and for tests.
window.viewer = {
  get mien() { return mien; },
  get model() { return model; },
  get stage() { return stage; },
  get take() { return take; },
  get sound() { return sound; },
  openBytes, openHead, pose,
};

// ?file=ADDRESS opens a file of the place that the page is from, with the materials of &materials=ADDRESS.
const query = new URLSearchParams(location.search);
const wanted = query.get("file");
async function fetchMaterials(address) {
  if (!address) return [];
  const answer = await fetch(address);
  if (!answer.ok) return [];
  const folder = address.slice(0, address.lastIndexOf("/") + 1);
  return openMaterials(decodeURIComponent(address), await answer.text(), async (path) => {
    const image = await fetch(folder + path.split("/").map(encodeURIComponent).join("/"));
    return image.ok ? image.blob() : null;
  });
}
if (wanted) {
  const name = decodeURIComponent(wanted.slice(wanted.lastIndexOf("/") + 1));
  attempt(`${name} could not be opened`, async () => {
    const answer = await fetch(wanted);
    if (!answer.ok) throw new Error(`${answer.status} ${answer.statusText}`);
    const [materials, sayFailure] = await fetchMaterials(query.get("materials"));
    await openBytes(name, new Uint8Array(await answer.arrayBuffer()), materials);
    sayAboutMaterials(materials, sayFailure);
  });
}
document.body.dataset.ready = "true";
