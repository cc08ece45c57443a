// SPDX-License-Identifier: MIT
// Scenes of `mien play` and mix files, on a rig of the page: all their frames become a clip, which plays and scrubs
// like any other, or with a live layer are mixed as data arrive. `mien help play` describes scenes. A page cannot run
// espeak-ng, so the takes of speech come from `mien speak`.
import { BlendMode, Generator, Guard, Kind, LayerGroup, Looping, MixLayer, ticks, TICKS_PER_SECOND, Transition } from "mien";
import { readFrames } from "./files.js";

const EYES = ["gaze.x", "gaze.y", "gaze.z"];
const BLINKS = { eyeBlinkLeft: 1, eyeBlinkRight: 1 };
const BREATH = { noseNostrilDilateL: 0.3, noseNostrilDilateR: 0.3 };
const SQUINT = { eyeSquintLeft: 0.8, eyeSquintRight: 0.8, browDownLeft: 0.7, browDownRight: 0.7 };
const PUPILS = { eyePupilNarrowL: 1, eyePupilNarrowR: 1 };
const VARIABLE = /^(pupil$|breath$|head\.|gaze\.|user\.)/;
const MOST_FRAMES = 36000;
const MOST_EVENTS = 1024;

/** Whether a JSON value is a scene, and no pose or frames. */
export const isScene = (value) => Array.isArray(value?.layers);

/** Whether a scene has a layer that takes live data. */
export const isLive = (value) => value.layers.some(({ source }) => source?.live);

/** Whether a file is a take of speech for a scene, and not to be opened by itself. */
export const SPEECH = /\.speech\.(json|clip)$/i;

const quoted = (text) => `'${String(text).replaceAll("'", "'\\''")}'`;

/** The command that makes a take of speech. */
function speakCommand({ text, voice, audio, phonemes }, file) {
  const words = ["mien speak"];
  if (phonemes !== undefined) words.push("--phonemes", quoted(phonemes));
  else if (audio !== undefined) words.push("--audio", quoted(audio), ...(text === undefined ? [] : ["--text", quoted(text)]));
  else words.push(quoted(text), ...(voice === undefined ? [] : ["--voice", quoted(voice)]));
  return `${words.join(" ")} -o ${quoted(file)}`;
}

function word(of, text, where) {
  const found = Object.entries(of).find(([name]) => name.toLowerCase() === text);
  if (!found) throw new Error(`${where}: "${text}" is none of ${Object.keys(of).join(", ").toLowerCase()}`);
  return found[1];
}

function required(value, where, kind = "object") {
  if (typeof value !== kind || value === null) throw new Error(`${where}: expected ${kind === "object" ? "an object" : `a ${kind}`}`);
  return value;
}

/** Names of a scene as curves of a rig: its raw controls, or variables. */
class Names {
  variables = [];

  constructor(rig) {
    this.rig = rig;
  }

  variable(name) {
    if (!this.variables.includes(name)) this.variables.push(name);
    return name;
  }

  /** {control or variable: value}; what the rig has no control for throws, or is left out if `isOptional`. */
  values(given, where, isOptional = false) {
    const found = {};
    for (const [name, value] of Object.entries(required(given, where))) {
      const shares = this.rig.match(name)?.shares;
      if (shares) {
        for (const { control, weight } of shares) {
          const curve = this.rig.name(Kind.RAW_CONTROL, control);
          found[curve] = (found[curve] ?? 0) + weight * required(value, `${where}, ${name}`, "number");
        }
      } else if (VARIABLE.test(name)) {
        found[this.variable(name)] = required(value, `${where}, ${name}`, "number");
      } else if (!isOptional) {
        throw new Error(`${where}: this rig has no control "${name}"`);
      }
    }
    return found;
  }

  /** A mask by patterns such as mouth*. */
  mask({ controls, invert = false }) {
    const patterns = controls.map((pattern) => new RegExp(`(^|\\.)${pattern.split("*").map((part) =>
      part.replace(/[.+?^${}()|[\]\\]/g, "\\$&")).join(".*")}$`, "i"));
    return Object.fromEntries(this.rig.names(Kind.RAW_CONTROL).map((name) =>
      [name, patterns.some((pattern) => pattern.test(name)) !== invert ? 1 : 0]));
  }
}

/** What a gaze of a scene gives in meters from the middle of the eyes, in millimeters of the model. */
function place(values, mode, middle) {
  if (!middle) return values;
  return Object.fromEntries(Object.entries(values).map(([name, value]) => {
    const axis = EYES.indexOf(name);
    return [name, axis < 0 ? value : 1000 * value + (mode === BlendMode.OVERRIDE ? middle[axis] : 0)];
  }));
}

/** What tells the clips of a scene apart: a path, or what is said. */
const clipKey = (source) => source?.clip ?? (source?.speech && JSON.stringify(source.speech));

class Scene {
  clips = new Map(); // clip and binding, by clipKey()
  headTurns = new Map(); // clips that turn the head, by layer
  now = 0;           // ticks

  constructor(value, rig, mien, liveCurves) {
    Object.assign(this, { value, rig, mien, liveCurves, names: new Names(rig), layerNames: value.layers.map(({ name }) => name) });
  }

  /** `find` gives the bytes of a file by its name, or null. */
  async openClips(find) {
    const events = [...(this.value.events ?? [])].sort((a, b) => a.time - b.time);
    const sources = [...this.value.layers.map(({ name, source }) => [name, source]), ...events.map(({ layer, play }) => [layer, play])];
    const spoken = {}; // how many takes of speech each layer has
    for (const [layer, source] of sources) {
      const key = clipKey(source);
      if (key === undefined || this.clips.has(key)) continue;
      if (source.speech) spoken[layer] = (spoken[layer] ?? 0) + 1;
      this.clips.set(key, source.speech ? await this.#openSpeech(layer, spoken[layer], source.speech, find)
        : await this.#openClip(source.clip, find));
    }
  }

  async #openClip(path, find) {
    const file = await find(path.slice(path.lastIndexOf("/") + 1));
    if (!file) throw new Error(`the clip ${path} is missing: drop it together with the scene`);
    return this.#bind(await this.mien.openClip(file));
  }

  /** Channels such as head.up are no controls: they are added to the variables of these names. */
  #bind(clip) {
    const names = clip.channels.map(({ name }) => name);
    const channels = names.map((_, i) => i).filter((i) => names[i].startsWith("head."));
    const values = channels.length > 0 ? clip.read() : [];
    const head = channels.map((channel) => ({
      variable: this.names.variable(names[channel]), values: values.filter((_, i) => i % names.length === channel),
    }));
    return { clip, binding: clip.bind(this.rig, { matrix: this.mien.arkitMatrix() }), head };
  }

  /** The take that `mien speak` has written, as a clip or as JSON. */
  async #openSpeech(layer, number, speech, find) {
    const name = `${layer}${number > 1 ? `-${number}` : ""}.speech`;
    const made = await find(`${name}.clip`);
    if (made) return this.#bind(await this.mien.openClip(made));
    const file = `${name}.json`;
    const bytes = await find(file);
    if (!bytes) {
      throw new Error(`the speech of layer ${layer} is missing: make it with ${speakCommand(speech, file)}, and drop it together with the scene`);
    }
    const take = JSON.parse(new TextDecoder().decode(bytes));
    const { names, values, rate } = readFrames(take);
    if (!names || !Array.isArray(take.events)) throw new Error(`${file} is no take of \`mien speak\``);
    const clip = this.mien.buildClip({
      names, values,
      events: take.events.map(({ time, name, value }) => ({ tick: BigInt(ticks(time)), name, value })),
      rateNumerator: rate, rateDenominator: 1,
    });
    return this.#bind(clip);
  }

  #findEyes() {
    const source = this.value.layers.map((layer) => layer.source).find((of) => of?.generator === "gaze");
    if (!source) return;
    const [leftEye, rightEye] = source.eyes ?? [];
    this.gaze = this.rig.deformer.gaze(source.eyes ? { leftEye, rightEye } : {});
    const { leftEye: left, rightEye: right } = this.gaze.info;
    this.middle = ["left", "up", "front"].map((axis) => (left[axis] + right[axis]) / 2);
    EYES.forEach((name) => this.names.variable(name));
  }

  #generator(source, mode, where) {
    const { names } = this;
    const generator = word(Generator, source.generator, where);
    if (generator === Generator.GAZE) {
      const jitter = source.jitter ?? 0;
      return MixLayer.gaze(EYES, { jitter: [jitter, jitter], head: { [names.variable("head.left")]: 1, [names.variable("head.up")]: 1 } });
    }
    const isBlink = generator === Generator.BLINK;
    let amounts = source.controls ? names.values(source.controls, `${where}, controls`) : names.values(isBlink ? BLINKS : BREATH, where, true);
    if (!isBlink && Object.keys(amounts).length === 0) amounts = { [names.variable("breath")]: 1 };
    return MixLayer.generator(generator, place(amounts, mode, this.middle), { period: ticks(source.period ?? 4) });
  }

  #layer({ name, group = "base", mode = "override", weight = 1, mask, source, after_guards: afterGuards = false }) {
    const where = `layer ${required(name, "a layer without name", "string")}`;
    const [blend, of] = [word(BlendMode, mode, where), required(source, where)];
    let made;
    if (clipKey(of) !== undefined) made = MixLayer.clip();
    else if (of.live) made = MixLayer.stream(this.liveCurves);
    else if (of.generator !== undefined) made = this.#generator(of, blend, where);
    else if (of.poses) {
      made = MixLayer.poses(Object.entries(of.poses).map(([pose, values]) =>
        place(this.names.values(values, `${where}, ${pose}`), blend, this.middle)));
    } else throw new Error(`${where}: it has no source`);
    const isGaze = made.generator === Generator.GAZE && of.generator;
    return { ...made, group: word(LayerGroup, group, where), mode: isGaze ? made.mode : blend, weight, afterGuards,
      mask: mask && this.names.mask(mask) };
  }

  /** The response to light in the eyes. */
  #glare() {
    const { names } = this;
    const pupils = names.values(PUPILS, "glare", true);
    return this.mien.glare([
      names.values(BLINKS, "glare", true), names.values(SQUINT, "glare", true),
      { [names.variable("gaze.y")]: this.middle ? -400 : -0.4 },
      Object.keys(pupils).length ? pupils : { [names.variable("pupil")]: -1 }, { [names.variable("head.turn")]: 0.3 },
    ]);
  }

  makeMixer() {
    const { value, rig } = this;
    this.#findEyes();
    if (value.layers.filter(({ source }) => source?.live).length > 1) throw new Error("several layers are live");
    const layers = value.layers.map((layer) => this.#layer(layer));
    const reactions = (value.reactions ?? []).map(() => this.#glare());
    for (const { variable } of value.events ?? []) if (variable) this.names.variable(variable);
    const guards = (value.guards ?? []).reduce((all, name) => all | word(Guard, name, "guards"), 0);
    const rotation = rig.names(Kind.RAW_CONTROL).map((name) => name.includes(".q"));
    const limit = (least, most) => Float32Array.from([...rotation.map(least), ...this.names.variables.map(() => most)]);
    const clips = [...this.clips.values()].map(({ clip }) => clip.info);
    this.mix = rig.mix({
      layers, reactions, guards, gaze: this.gaze, variables: this.names.variables, reverse: true, maxEvents: MOST_EVENTS,
      antagonists: value.antagonists ? rig.antagonists() : [],
      ...(value.limits ? { lower: limit((of) => (of ? -1 : 0), -1e6), upper: limit(() => 1, 1e6) } : {}),
      maxChannels: Math.max(0, ...clips.map(({ channelCount }) => channelCount)),
      maxChangingChannels: Math.max(0, ...clips.map(({ changingChannelCount }) => changingChannelCount)),
    });
  }

  /** To time 0. */
  start() {
    const { value } = this;
    this.mixer?.dispose();
    this.mixer = this.mix.mixer({ seed: value.seed ?? 0 });
    this.headTurns.clear();
    this.now = 0;
    this.events = [...(value.events ?? [])].sort((a, b) => a.time - b.time);
    EYES.forEach((name, axis) => this.middle && this.mixer.setVariable(name, this.middle[axis] + (axis === 2 ? 1000 : 0)));
    value.layers.forEach(({ source }, number) => {
      if (clipKey(source) !== undefined) this.#play(number, source, { transition: Transition.CUT });
      if (source.weights) this.#weigh(number, source.weights, 0);
    });
  }

  #play(number, source, desc) {
    const { loop, speed = 1, start = 0 } = source;
    const { clip, binding, head } = this.clips.get(clipKey(source));
    this.headTurns.delete(number);
    if (head.length > 0) {
      const { rateNumerator, rateDenominator, looping } = clip.info;
      this.headTurns.set(number, { head, rate: rateNumerator / rateDenominator, speed, start,
        loops: loop ?? looping === Looping.WRAP, begin: this.now / TICKS_PER_SECOND });
    }
    this.mixer.play(number, clip, binding, {
      startTick: ticks(start), speedNumerator: Math.round(speed * 1e6), speedDenominator: 1e6,
      ...(loop === undefined ? {} : { looping: loop ? Looping.WRAP : Looping.CLAMP }), ...desc,
    });
  }

  /** Adds the head's channels of the clips that play. */
  #turnHead(row) {
    for (const [, { head, rate, speed, start, loops, begin }] of [...this.headTurns].sort(([a], [b]) => a - b)) {
      const at = (start + (this.now / TICKS_PER_SECOND - begin) * speed) * rate;
      for (const { variable, values } of head) {
        const frame = loops ? at - Math.floor(at / values.length) * values.length : at;
        row[this.rig.count(Kind.RAW_CONTROL) + this.names.variables.indexOf(variable)] += values[Math.trunc(Math.min(Math.max(frame, 0), values.length - 1))];
      }
    }
  }

  #weigh(number, weights, fade) {
    const poses = Object.keys(this.value.layers[number].source.poses ?? {});
    for (const [name, weight] of Object.entries(weights)) {
      if (!poses.includes(name)) throw new Error(`${this.layerNames[number]} has no pose "${name}"`);
      this.mixer.setPoseWeight(number, poses.indexOf(name), weight, fade);
    }
  }

  #apply(event) {
    const { mixer, value } = this;
    const find = (list, name) => {
      const found = list.indexOf(name);
      if (found < 0) throw new Error(`the scene has no "${name}"`);
      return found;
    };
    const fade = ticks(event.fade ?? 0);
    const reactions = (value.reactions ?? []).map(({ name }) => name);
    if (event.trigger !== undefined) {
      mixer.trigger(find(reactions, event.trigger), event.strength ?? 1, ticks(event.hold ?? 0));
    } else if (event.level !== undefined) {
      mixer.setLevel(find(reactions, event.level), event.value);
    } else if (event.variable !== undefined) {
      mixer.setVariable(event.variable, place({ [event.variable]: event.value }, BlendMode.OVERRIDE, this.middle)[event.variable]);
    } else {
      const number = find(this.layerNames, event.layer);
      if (event.play) {
        this.#play(number, event.play, { transition: word(Transition, event.transition ?? "inertial", "an event"),
          transitionTicks: ticks(event.duration ?? 0.25) });
      } else if (event.stop) {
        mixer.stop(number, fade);
        this.headTurns.delete(number);
      } else if (event.weights) this.#weigh(number, event.weights, fade);
      else mixer.setWeight(number, required(event.weight, `an event of ${event.layer}`, "number"), fade);
    }
  }

  get width() { return this.rig.count(Kind.RAW_CONTROL) + this.names.variables.length; }

  #stepTo(tick) {
    this.mixer.step(tick - this.now);
    this.now = tick;
  }

  /** Goes on to a time; returns the row of raw controls and variables. */
  rowAt(tick) {
    while (this.events.length && ticks(this.events[0].time) <= tick) {
      const event = this.events.shift();
      if (ticks(event.time) > this.now) this.#stepTo(ticks(event.time));
      this.#apply(event);
    }
    this.#stepTo(tick);
    const row = this.mixer.row.slice(0, this.width);
    // The w of rotations that nothing moves.
    this.rig.initialRawControls.forEach((value, i) => { row[i] ||= value; });
    this.#turnHead(row);
    return row;
  }

  /** Rows, one after the other. */
  frames(rate, seconds) {
    const count = Math.min(MOST_FRAMES, Math.floor(seconds * rate + 1e-6) + 1);
    const values = new Float32Array(count * this.width);
    for (let frame = 0; frame < count; ++frame) values.set(this.rowAt(ticks(frame / rate)), frame * this.width);
    return values;
  }

  dispose() {
    for (const { clip, binding } of this.clips.values()) for (const object of [binding, clip]) object.dispose();
    for (const object of [this.mixer, this.mix, this.gaze]) object?.dispose();
  }
}

/** A scene at time 0. `find` gives the bytes of a file by its name, or null; `liveCurves` are the raw controls that live
 * data may move. */
export async function openScene(value, rig, mien, find, liveCurves) {
  const scene = new Scene(value, rig, mien, liveCurves);
  try {
    await scene.openClips(find);
    scene.makeMixer();
    scene.start();
    return scene;
  } catch (error) {
    scene.dispose();
    throw error;
  }
}

/** The frames of a scene without live layers, as a clip. */
export async function sceneClip(value, rig, mien, find) {
  const scene = await openScene(value, rig, mien, find);
  try {
    const rate = Math.max(1, Math.round(value.rate ?? 60));
    return mien.buildClip({
      names: [...rig.names(Kind.RAW_CONTROL), ...scene.names.variables], values: scene.frames(rate, value.seconds || 10),
      rateNumerator: rate, rateDenominator: 1,
    });
  } finally {
    scene.dispose();
  }
}

/** Ten seconds of what a mix file does by itself, with the weights that it begins with, as a clip. */
export async function mixClip(bytes, rig, mien) {
  const mix = await mien.openMix(bytes, rig);
  const mixer = mix.mixer();
  try {
    const width = rig.count(Kind.RAW_CONTROL);
    const values = new Float32Array(601 * width);
    for (let frame = 0; frame <= 600; ++frame) {
      mixer.step(frame ? ticks(1 / 60) : 0);
      values.set(mixer.row.subarray(0, width), frame * width);
    }
    return mien.buildClip({ names: rig.names(Kind.RAW_CONTROL), values, rateNumerator: 60, rateDenominator: 1 });
  } finally {
    for (const object of [mixer, mix]) object.dispose();
  }
}
