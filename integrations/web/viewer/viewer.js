// SPDX-License-Identifier: MIT
// The page: opens files, and connects its controls with what is shown.
import { Isa, Kind, Mien, Preset } from "mien";
import { Attention } from "./attention.js";
import { Comparison } from "./compare.js";
import { isPhonemes, readCsv, readFrames } from "./files.js";
import { HeatMap } from "./heat.js";
import { LIGHTS } from "./lights.js";
import { Live } from "./live.js";
import { LiveTake } from "./live_scene.js";
import { Materials } from "./materials.js";
import { Microphone } from "./microphone.js";
import { GlbModel, RigModel } from "./models.js";
import { Panel } from "./panel.js";
import { AnimationTake, ClipTake, Player } from "./playing.js";
import { PRESETS } from "./presets.js";
import { download, exportGlb, Recorder } from "./record.js";
import { isLive, isScene, mixClip, sceneClip, SPEECH } from "./scene.js";
import { Sound, SOUNDS } from "./sound.js";
import { Stage } from "./stage.js";
import { Wireframe } from "./wire.js";

const TAKES = /\.(csv|clip|mix)$/i;

const $ = (id) => document.getElementById(id);
const stage = new Stage($("canvas"));
const heat = new HeatMap();
const wireframe = new Wireframe();
stage.pivot.add(wireframe.object);
const attention = new Attention(stage);
const player = new Player({ sampled: sample, said: say, requested: () => stage.request() });
const comparison = new Comparison(stage, { shown: () => ({ ...opened, model }), changed: setColors });
const recorder = new Recorder($("record"), () => stage.request());
const panel = new Panel({
  changed(kind, index, value) {
    player.leave();
    model.set(kind, index, value);
    pose();
  },
  inspected: (kind, index) => inspect(kind, index),
});

let mien = null;
let model = null;
let opened = null; // name and bytes of the model
let microphone = null;
let live = null;
let dirty = false;
let wasAlive = false; // in the last frame

// ---- messages ---------------------------------------------------------------------------------------

function say(text) {
  $("file").textContent = text;
}

/** Shows what went wrong; what was open stays open. */
function fail(what, error) {
  console.error(error);
  const place = error.byteOffset !== undefined && error.byteOffset !== null ? ` (at byte ${error.byteOffset})` : "";
  const before = $("error").hidden ? "" : `${$("error").textContent}\n`; // of another file of several
  $("error").textContent = `${before}${what}: ${error.message}${place}`;
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
  await loadModule();
  const made = isGlb ? await GlbModel.open(mien, bytes) : await RigModel.open(mien, bytes, options);
  player.drop();
  heat.end();
  attention.show(made);
  model?.dispose();
  model = made;
  if (opened?.materials !== materials && !comparison.uses(opened?.materials)) opened?.materials?.dispose();
  opened = { name, bytes, materials };
  $("welcome").hidden = true;
  stage.show(model.object);
  showRegions();
  comparison.refresh();
  fillView(isGlb);
  panel.show(model);
  showPresets();
  for (const id of ["pose", "camera", "pair", "view", "sliders"]) $(id).hidden = false;
  $("inspect").hidden = $("save-glb").hidden = isGlb;
  recorder.drop();
  $("facts").textContent = model.facts;
  say(name);
  const [animation] = model.animations ?? [];
  if (animation) {
    player.open(new AnimationTake(model, animation));
    say(`${name}: an animation of ${animation.duration.toFixed(1)} s`);
  }
  pose();
}

function needRig() {
  if (!(model instanceof RigModel)) throw new Error("open a rig first, then what it plays");
}

function openTake({ names, values, rate }) {
  openClip(mien.buildClip({ names, values, rateNumerator: rate, rateDenominator: 1 }));
}

function openClip(clip) {
  const take = new ClipTake(clip, model, mien.arkitMatrix());
  player.open(take);
  say(`${opened.name}: ${take.controlCount} controls played, ${take.duration.toFixed(1)} s`);
}

async function openSound(name, bytes) {
  if (!player.take) throw new Error("open a rig and a take first, then its sound");
  const sound = await Sound.open(name, bytes);
  say(`${opened.name}, ${name}: ${sound.duration.toFixed(1)} s of sound`);
  player.openSound(sound);
}

/** A scene: mixed while it plays if it takes live data, otherwise at once. */
async function openScene(value, find) {
  needRig();
  if (!live && !isLive(value)) {
    openClip(await sceneClip(value, model.rig, mien, find));
    return;
  }
  const names = model.rig.names(Kind.RAW_CONTROL);
  const curves = live ? names : [...model.controlsOf(Microphone.silent).keys()].map((control) => names[control]);
  player.open(await LiveTake.open(value, model, mien, find, curves));
  const waits = live || microphone ? "" : "; press Microphone, or open the rig with `mien view --live`, to move its live layer";
  say(`${opened.name}: a live scene of ${player.take.duration.toFixed(1)} s${waits}`);
}

async function openJson(name, text, find) {
  const value = JSON.parse(text);
  if (isPhonemes(value)) throw new Error(`these are phonemes: mien speak --phonemes '${name}' -o take.clip makes a take of them`);
  if (isScene(value)) return openScene(value, find);
  const read = readFrames(value);
  if (!read.pose) {
    needRig();
    openTake(read);
    return;
  }
  if (!model) throw new Error("open a rig first, then a pose");
  player.leave();
  const missing = model.setPose(read.pose);
  pose();
  if (missing.length) throw new Error(`this rig has no ${missing.slice(0, 5).join(", ")}${missing.length > 5 ? " …" : ""}`);
}

/** Opens the bytes of a file. `find` gives the bytes of another one, by its name, or null. */
async function openBytes(name, bytes, materials, find = async () => null) {
  if (SOUNDS.test(name)) return openSound(name, bytes);
  const ending = name.slice(name.lastIndexOf(".") + 1).toLowerCase();
  if (ending === "json") return openJson(name, new TextDecoder().decode(bytes), find);
  if (TAKES.test(name)) {
    needRig();
    if (ending === "csv") return openTake(readCsv(new TextDecoder().decode(bytes)));
    return openClip(ending === "mix" ? await mixClip(bytes, model.rig, mien) : await mien.openClip(bytes));
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

function openFiles(files) {
  clearError();
  return openEach(files);
}

/** Opens files, and shows a message for each that cannot be opened. */
async function openEach(files) {
  const is = (ending) => (file) => ending.test(file.name);
  const list = [...files];
  // Images are found by their names alone: a page does not learn the folders of files.
  const images = list.filter(is(/\.(png|jpe?g)$/i));
  const ofMaterials = list.find(is(/\.materials\.json$/i));
  const [materials, sayFailure] = !ofMaterials ? [] : await openMaterials(ofMaterials.name, await ofMaterials.text(), async (path) => {
    const name = path.slice(path.lastIndexOf("/") + 1);
    return images.find((image) => image.name === name) ?? null;
  });
  // Rigs before what they play, clips and speech before scenes of them, and takes before their sound.
  const order = ({ name }) => (SOUNDS.test(name) ? 3 : TAKES.test(name) || SPEECH.test(name) ? 1 : /\.json$/i.test(name) ? 2 : 0);
  const find = async (name) => {
    const file = list.find((one) => one.name === name);
    return file ? new Uint8Array(await file.arrayBuffer()) : null;
  };
  const others = list.filter((file) => file !== ofMaterials && !(ofMaterials && images.includes(file)));
  if (materials && others.length === 0 && opened) {
    // For the rig that is open.
    const before = opened.materials;
    opened.materials = materials;
    await reopen();
    if (!comparison.uses(before)) before?.dispose();
  }
  for (const file of others.sort((a, b) => order(a) - order(b))) {
    await attempt(`${file.name} could not be opened`, async () => openBytes(file.name, new Uint8Array(await file.arrayBuffer()), materials, find));
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
  if (player.isPlaying) player.advance(time);
  if (microphone) drive(microphone.pose(time));
  if ($("auto-lod").checked && model.rig) {
    const lod = model.object.lodOf(stage.camera);
    if (lod !== model.object.lod) setLod(lod);
  }
  const alive = attention.step(time, player.isPlaying || colorsDistances());
  stage.moveHead(sum(attention.motion, player.motion));
  if (dirty || alive || wasAlive) {
    model.update(alive ?? undefined);
    if (model.rig) afterUpdate();
    panel.refresh();
  }
  dirty = false;
  wasAlive = alive !== null;
  recorder.take(time, model);
  return player.isPlaying || recorder.isOn || wasAlive || microphone !== null;
};

/** Two motions of the head, each of which may be null. */
function sum(a, b) {
  return a && b ? { left: a.left + b.left, up: a.up + b.up, rise: a.rise + b.rise } : a ?? b;
}

/** The take is at another time. */
function sample() {
  player.apply(model);
  dirty = true;
}

const playsLive = () => player.isPlaying && player.take instanceof LiveTake;

/** What a voice or a stream moves: in the live layer of a scene that plays, or over the pose that is set. */
function drive(values) {
  if (playsLive()) {
    player.take.push(model.controlsOf(values));
    return;
  }
  model.drive(values);
  dirty = true;
}

function listen() {
  return attempt("The microphone cannot be used", async () => {
    clearError();
    microphone = await Microphone.open();
    if (!playsLive()) player.leave();
    $("listen").textContent = "Stop listening";
    $("listen").setAttribute("aria-pressed", "true");
    stage.request();
  });
}

function stopListening() {
  microphone.dispose();
  microphone = null;
  $("listen").textContent = "Microphone";
  $("listen").setAttribute("aria-pressed", "false");
  drive(Microphone.silent);
  stage.request();
}

function afterUpdate() {
  if (colorsDistances()) {
    const most = heat.apply(model.object, $("heat").checked ? undefined : comparison.reference(model.object)) * 1000;
    $("heat-legend").textContent = $("heat").checked ? `Gray: still. Red: moved by ${most.toFixed(1)} mm.`
      : `Gray: as in ${comparison.name}. Red: ${most.toFixed(1)} mm from it.`;
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
      player.leave();
      model.setPose(found);
      pose();
    });
    return button;
  }).filter(Boolean);
  $("preset-buttons").replaceChildren(...buttons);
  $("presets").hidden = buttons.length === 0;
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
  setWire();
  if (isGlb) return;
  $("lod").replaceChildren(...Array.from({ length: model.rig.info.lodCount }, (_, lod) => option(lod, String(lod))));
  if (!$("isa").options.length) {
    $("isa").replaceChildren(option(Isa.SSE2, "128-bit vectors"), option(Isa.SCALAR, "scalar"));
  }
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
  wireframe.show($("wire").checked ? model?.object : null);
  stage.request();
}

/** Opens the same file with other options, in the same pose. */
function reopen() {
  return attempt("The file could not be opened again", async () => {
    const kept = model.pose();
    const view = [stage.camera.position.clone(), stage.controls.target.clone()];
    const { lod } = model.object;
    player.drop();
    await openModel(opened.name, opened.bytes, opened.materials);
    model.setPose(kept);
    setLod(lod);
    stage.camera.position.copy(view[0]);
    stage.controls.target.copy(view[1]);
    stage.controls.update();
  });
}

/** Whether vertices are colored by their distances: from the neutral pose, or from what was kept. */
function colorsDistances() {
  return $("skinning").value === "mien" && model.rig && ($("heat").checked || comparison.isDifference);
}

/** After another choice of colors. */
function setColors() {
  heat.end();
  $("heat-legend").hidden = !colorsDistances();
  pose();
}

function showRegions() {
  $("regions").replaceChildren(...Object.keys(stage.regions).map((name) => {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = name;
    button.addEventListener("click", () => stage.lookAt(name));
    return button;
  }));
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
  player.leave();
  model.setPose({});
  pose();
});
$("save").addEventListener("click", () => {
  download("pose.json", `${JSON.stringify({ frames: [{ raw: model.pose() }] }, null, 2)}\n`);
});
$("save-glb").addEventListener("click", () => attempt("The head could not be exported", async () => {
  download("head.glb", await exportGlb(model), "model/gltf-binary");
}));
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
$("heat").addEventListener("change", setColors);
$("listen").addEventListener("click", () => (microphone ? stopListening() : listen()));
$("light").replaceChildren(...LIGHTS.map((name) => option(name, name)));
$("light").addEventListener("change", () => {
  stage.lights.choose($("light").value);
  stage.request();
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
  get player() { return player; },
  get attention() { return attention; },
  get microphone() { return microphone; },
  get live() { return live; },
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
    // &more=ADDRESS, of any number: what it plays.
    await openEach(await Promise.all(query.getAll("more").map(async (address) =>
      new File([await (await fetch(address)).blob()], decodeURIComponent(address.slice(address.lastIndexOf("/") + 1))))));
  });
}
// &live=ADDRESS follows what `mien view --live` receives.
if (query.get("live")) {
  let isFirst = true;
  live = new Live(query.get("live"), { said: say, use(values) {
    if (!model) return;
    if (isFirst) say(`${opened.name}: live`);
    isFirst = false;
    if (!playsLive()) player.leave();
    drive(values);
    stage.request();
  } });
  live.run();
}
document.body.dataset.ready = "true";
