// SPDX-License-Identifier: MIT
// What plays over time: a clip on a rig or the animation of a GLB, with its sound, and the buttons for it.
import { Looping, TICKS_PER_SECOND } from "mien";
import { AnimationMixer } from "three";

const $ = (id) => document.getElementById(id);

/** A clip on the controls of a rig. */
export class ClipTake {
  /** Takes over the clip, also if this throws: none of its channels is a control of the rig. */
  constructor(clip, model, matrix) {
    const binding = clip.bind(model.rig, { matrix });
    this.controlCount = binding.info.controls.length;
    if (this.controlCount === 0) {
      for (const object of [binding, clip]) object.dispose();
      throw new Error("none of its channels is a control of this rig");
    }
    const channels = clip.channels.map(({ name }) => name);
    const named = (pattern) => channels.map((name, i) => i).filter((i) => pattern.test(channels[i]));
    this.head = { left: named(/^head\.(left|turn)$/), up: named(/^head\.up$/) };
    Object.assign(this, { clip, binding, player: clip.player({ looping: Looping.WRAP }) });
  }

  get duration() { return this.clip.duration; }

  get time() { return this.player.info.tick / TICKS_PER_SECOND; }

  seek(seconds) { this.player.seek(Math.round(seconds * TICKS_PER_SECOND)); }

  /** True when it began again. */
  advance(seconds) {
    const before = this.player.info.tick;
    this.player.advance(Math.round(seconds * TICKS_PER_SECOND));
    return this.player.info.tick < before;
  }

  /** Returns how the head is turned, in radians. */
  apply({ face }) {
    const values = this.player.sample();
    const sum = (channels) => channels.reduce((total, i) => total + values[i], 0);
    const motion = { left: sum(this.head.left), up: sum(this.head.up), rise: 0 };
    this.binding.apply(values, face);
    return motion;
  }

  dispose() {
    for (const object of [this.player, this.binding, this.clip]) object.dispose();
  }
}

/** An animation of a GLB: its nodes, and its morph targets, whose sliders follow. */
export class AnimationTake {
  time = 0;

  constructor(model, animation) {
    Object.assign(this, { model, mixer: new AnimationMixer(model.object), duration: animation.duration });
    this.mixer.clipAction(animation).play();
  }

  seek(seconds) { this.time = Math.min(seconds, this.duration); }

  advance(seconds) {
    const next = this.time + seconds;
    this.time = this.duration > 0 ? next % this.duration : 0;
    return next >= this.duration;
  }

  apply(model) {
    model.update(); // without what idle life has added
    // The end of a loop is its beginning, but people who drag the slider to the end want to see the end.
    this.mixer.setTime(Math.min(this.time, this.duration * (1 - 1e-6)));
    model.readTargets();
    return null;
  }

  dispose() {
    this.mixer.stopAllAction();
    this.mixer.uncacheRoot(this.model.object);
  }
}

/** Plays a take; a sound, if there is one, is its clock. */
export class Player {
  take = null;
  sound = null;
  isPlaying = false;
  motion = null; // of the head, where the take turns it
  #last = 0;

  /** `sampled` is called when the controls have changed, `said` with a line for the user. */
  constructor({ sampled, said, requested }) {
    Object.assign(this, { sampled, said, requested });
    $("play").addEventListener("click", () => (this.isPlaying ? this.stop() : this.play()));
    $("time").addEventListener("input", () => this.seek(Number($("time").value)));
    $("mute").addEventListener("change", () => {
      if (this.sound) this.sound.isMuted = $("mute").checked;
    });
    for (const event of ["pointerup", "keydown"]) addEventListener(event, () => this.#hear());
  }

  /** Takes over a take, and plays it. */
  open(take) {
    this.drop();
    this.take = take;
    $("play").hidden = $("time-row").hidden = false;
    $("time").max = String(take.duration);
    this.play();
  }

  /** Takes over the sound of the take, and plays both from their beginning. */
  openSound(sound) {
    this.stop();
    this.dropSound();
    this.sound = sound;
    sound.isMuted = $("mute").checked;
    $("mute-row").hidden = false;
    this.take.seek(0);
    this.play();
  }

  play() {
    this.isPlaying = true;
    this.#last = 0;
    $("play").textContent = "Pause";
    // Browsers play no sound before the page is used. The face moves all the same.
    this.sound?.play(this.take.time).catch(() => this.said(`${this.sound.name}: press a key, or the page, to hear it`));
    this.requested();
  }

  stop() {
    if (!this.isPlaying) return;
    this.isPlaying = false;
    this.sound?.pause();
    $("play").textContent = "Play";
  }

  /** Stops because something else than the take sets the controls now. */
  leave() {
    this.stop();
    this.motion = null;
  }

  seek(seconds) {
    this.stop();
    this.take.seek(seconds);
    this.sound?.scrub(seconds);
    this.sampled();
    this.requested();
  }

  /** The page is used: a sound that waited for this joins in. */
  #hear() {
    const { sound } = this;
    if (!this.isPlaying || !sound?.isWaiting) return;
    sound.play(this.take.time).then(() => this.said(`${sound.name}: ${sound.duration.toFixed(1)} s of sound`), () => {});
  }

  /** To the time of a frame, in milliseconds. */
  advance(time) {
    const { take, sound } = this;
    const seconds = this.#last ? Math.min(0.25, (time - this.#last) / 1000) : 0;
    this.#last = time;
    const heard = sound?.time ?? null;
    if (heard !== null && heard < take.duration) take.seek(heard);
    else if (take.advance(seconds) && sound && !sound.isWaiting) {
      // Both from the beginning again, however far the frame went past the end.
      take.seek(0);
      sound.play(0).catch(() => {});
    }
    this.sampled();
  }

  /** Shows the time of the take, and sets the controls of a model. */
  apply(model) {
    this.motion = this.take.apply(model);
    $("time").value = String(this.take.time);
  }

  dropSound() {
    this.sound?.dispose();
    this.sound = null;
    $("mute-row").hidden = true;
  }

  drop() {
    this.stop();
    this.dropSound();
    this.take?.dispose();
    this.take = this.motion = null;
    $("play").hidden = $("time-row").hidden = true;
  }
}
