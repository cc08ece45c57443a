// SPDX-License-Identifier: MIT
// A scene with a live layer, as what plays: mixed while data arrive, and not kept.
import { Kind, ticks, TICKS_PER_SECOND } from "mien";
import { openScene } from "./scene.js";

const STEP = ticks(1 / 60);

export class LiveTake {
  #isNew = false; // whether values have come since the last frame

  /** `names` are the raw controls that the live data may move. A scene without a live layer gets one below the others,
   * as `mien play --live` does. */
  static async open(value, model, mien, find, names) {
    const hasLive = value.layers.some(({ source }) => source?.live);
    const layers = hasLive ? value.layers : [{ name: "live", source: { live: true } }, ...value.layers];
    return new LiveTake(await openScene({ ...value, layers }, model.rig, mien, find, names), model);
  }

  constructor(scene, { rig }) {
    Object.assign(this, { scene, rig, duration: scene.value.seconds || 10, controlCount: rig.count(Kind.RAW_CONTROL) });
    this.layer = scene.value.layers.findIndex(({ source }) => source?.live);
    this.curves = scene.liveCurves.map((name) => rig.find(Kind.RAW_CONTROL, name));
    this.values = new Float32Array(this.curves.length);
    this.row = scene.rowAt(0);
  }

  get time() { return this.scene.now / TICKS_PER_SECOND; }

  /** Takes values of raw controls, a Map by their numbers; the others of the live layer keep theirs. */
  push(values) {
    this.curves.forEach((control, i) => { this.values[i] = values.get(control) ?? this.values[i]; });
    this.#isNew = true;
  }

  /** To another time. Live data are not kept: they go on only if it is the next moment, as when a sound is followed. */
  seek(seconds) {
    const end = ticks(Math.min(seconds, this.duration));
    const ahead = end - this.scene.now;
    if (ahead >= 0 && ahead < ticks(0.25)) {
      if (ahead > 0) this.#goOn(end);
      return;
    }
    this.scene.start();
    for (let tick = 0; tick < end; tick += STEP) this.scene.rowAt(tick);
    this.row = this.scene.rowAt(end);
  }

  advance(seconds) {
    const { scene } = this;
    let tick = scene.now + ticks(seconds);
    const isOver = tick > ticks(this.duration);
    if (isOver) {
      scene.start();
      tick = 0;
    }
    this.#goOn(tick);
    return isOver;
  }

  #goOn(tick) {
    if (this.#isNew) this.scene.mixer.push(this.layer, tick, this.values);
    this.#isNew = false;
    this.row = this.scene.rowAt(tick);
  }

  apply({ face, hasGui }) {
    face.rawControls.set(this.row.subarray(0, this.controlCount));
    if (hasGui) face.mapRawToGui();
    const sum = (...names) => this.scene.names.variables.reduce((total, name, i) =>
      (names.includes(name) ? total + this.row[this.controlCount + i] : total), 0);
    return { left: sum("head.left", "head.turn"), up: sum("head.up"), rise: 0 };
  }

  dispose() { this.scene.dispose(); }
}
