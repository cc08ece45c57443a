// SPDX-License-Identifier: MIT
// A face at rest that is alive: it blinks, breathes, moves its eyes a little and looks at the cursor. All of it is mixed
// over the pose of the sliders, on an instance of its own, so the pose itself stays as it is.
import { BlendMode, Generator, Kind, MixLayer, ticks } from "mien";

export const BLINKS = ["eyeBlinkLeft", "eyeBlinkRight"];
export const LOOKS = ["Up", "Down", "In", "Out"].flatMap((way) => [`eyeLook${way}Left`, `eyeLook${way}Right`]);
export const NOSTRILS = ["noseNostrilDilateL", "noseNostrilDilateR"];
const VARIABLES = ["gaze.x", "gaze.y", "gaze.z", "head.left", "head.up", "breath"];
/** Where the eyes look if there is nothing to look at: meters in front of them. */
const AHEAD = 1;

export class Idle {
  #mixer;
  #mix;
  #gaze = null;
  #layers = []; // number of a layer, the raw controls that it moves, and whether it is on
  #eyes = { left: 0, up: 0, front: 0 };
  #base;

  /** For a rig of the page, in a pose that an instance of it has. */
  constructor(rig, pose) {
    const controlsOf = (names) => [...new Set(names.flatMap((name) => rig.match(name)?.shares ?? []).map(({ control }) => control))];
    const [blinks, looks, nostrils] = [BLINKS, LOOKS, NOSTRILS].map(controlsOf);
    const amounts = (controls, amount) => Object.fromEntries(controls.map((control) => [rig.name(Kind.RAW_CONTROL, control), amount]));
    try {
      this.#gaze = rig.deformer.gaze();
    } catch {
      // No joints that are eyes, or no controls that turn them.
    }
    const layers = [MixLayer.stream(Array.from(rig.initialRawControls, (_, control) => control))];
    const add = (layer, controls) => {
      this.#layers.push({ number: layers.length, controls, isOn: true });
      layers.push(layer);
    };
    if (blinks.length) {
      add(MixLayer.generator(Generator.BLINK, amounts(blinks, 1), { mode: BlendMode.MAX, period: ticks(4) }), blinks);
    }
    add(MixLayer.generator(Generator.BREATH, { breath: 1, ...amounts(nostrils, 0.3) }, { period: ticks(4.2) }), nostrils);
    add(MixLayer.generator(Generator.NOISE, { "gaze.x": 22, "gaze.y": 12, "head.left": 0.012, "head.up": 0.008 },
      { period: ticks(1.4) }), []);
    if (this.#gaze) {
      add(MixLayer.gaze(VARIABLES.slice(0, 3), { head: { "head.left": 1, "head.up": 1 }, jitter: [0.25, 0.15] }), looks);
      const { leftEye, rightEye } = this.#gaze.info;
      for (const axis of ["left", "up", "front"]) this.#eyes[axis] = (leftEye[axis] + rightEye[axis]) / 2;
    }
    this.#mix = rig.mix({ layers, variables: VARIABLES, gaze: this.#gaze });
    this.#mixer = this.#mix.mixer({ seed: 1 });
    this.#base = new Float32Array(rig.initialRawControls);
    this.initial = rig.initialRawControls.slice();
    this.face = rig.instance();
    this.lookAt(null);
    // A stream blends to its first rows.
    for (let frame = 0; frame < 30; ++frame) this.step(1 / 60, pose);
  }

  /** Whether the rig has eyes that can look at something. */
  get canLook() {
    return this.#gaze !== null;
  }

  /** Turns the eyes to a point {x, y, z} in meters, as three.js has them; null: straight ahead. */
  lookAt(point) {
    const { left, up, front } = this.#eyes;
    const target = point ? [1000 * point.x, 1000 * point.y, 1000 * point.z] : [left, up, front + 1000 * AHEAD];
    target.forEach((value, i) => this.#mixer.setVariable(VARIABLES[i], value));
  }

  /** Advances by seconds. `face` then has the controls of `pose` with what idle life adds; layers that move a control
   * away from its rest in `pose` are off, and so are all but the gaze unless `isAlive`. */
  step(seconds, pose, { isAlive = true, looks = true } = {}) {
    const raw = pose.rawControls;
    for (const layer of this.#layers) {
      const isGaze = this.#gaze !== null && layer === this.#layers[this.#layers.length - 1];
      const isOn = (isGaze ? isAlive || looks : isAlive) &&
        layer.controls.every((control) => raw[control] === this.initial[control]);
      if (isOn === layer.isOn) continue;
      layer.isOn = isOn;
      this.#mixer.setWeight(layer.number, isOn ? 1 : 0, isOn ? ticks(0.3) : 0);
    }
    const step = Math.max(1, ticks(seconds));
    this.#base.set(raw);
    this.#mixer.push(0, this.#mixer.info.tick + step, this.#base);
    this.#mixer.step(step, this.face);
  }

  /** Of the head after a step: radians to the left and up, and millimeters up. */
  get motion() {
    const [left, up, breath] = this.#mixer.row.slice(this.#base.length + 3);
    // The neck follows a part of what the eyes leave to it, and no farther than is natural.
    const turn = (tangent) => Math.max(-0.3, Math.min(0.3, 0.6 * Math.atan(tangent)));
    return { left: turn(left), up: turn(up) + 0.004 * breath, rise: 0.6 * breath };
  }

  dispose() {
    for (const object of [this.#mixer, this.#mix, this.#gaze, this.face]) object?.dispose();
  }
}
