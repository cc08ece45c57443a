// SPDX-License-Identifier: MIT
// The microphone opens the mouth, by its loudness alone: no words are known, and no sound leaves the page or is kept.

/** What a loud voice does, by names of ARKit; half as loud, half of it. */
const LOUD = { jawOpen: 0.6, mouthLowerDownLeft: 0.25, mouthLowerDownRight: 0.25, mouthUpperUpLeft: 0.12, mouthUpperUpRight: 0.12, mouthFunnel: 0.12 };

/** Seconds in which the mouth follows a louder and a quieter voice, and in which the range of loudness adapts. */
const [OPENS, CLOSES, ADAPTS] = [0.05, 0.12, 8];
/** Decibels: what is quieter than this is never a voice, and a voice is so much above the noise at least. */
const [SILENCE, RANGE] = [-65, 18];

/** From loudness to how far the mouth is open. */
export class MouthDrive {
  #noise = SILENCE;
  #loud = SILENCE + RANGE;
  open = 0;

  /** The root of the mean square of the last samples, 1 at most, and seconds since the last call. Returns 0 to 1. */
  step(energy, seconds) {
    const level = Math.max(SILENCE, 20 * Math.log10(Math.max(energy, 1e-6)));
    const slowly = 1 - Math.exp(-seconds / ADAPTS);
    // The quietest and the loudest of the last seconds.
    this.#noise = Math.min(level, this.#noise + (level - this.#noise) * slowly);
    this.#loud = Math.max(level, this.#loud + (this.#noise + RANGE - this.#loud) * slowly, this.#noise + RANGE);
    // A third of the range above the noise is breath and room.
    const share = (level - this.#noise) / (this.#loud - this.#noise);
    const wanted = Math.min(1, Math.max(0, (share - 0.33) / 0.67));
    this.open += (wanted - this.open) * (1 - Math.exp(-seconds / (wanted > this.open ? OPENS : CLOSES)));
    return this.open;
  }
}

export class Microphone {
  #drive = new MouthDrive();
  #last = 0;

  /** The browser asks the user; rejects with an Error if there is none, or the answer is no. */
  static async open() {
    if (!navigator.mediaDevices) throw new Error("this browser gives microphones only to pages of https:// or of this machine");
    let stream;
    try {
      stream = await navigator.mediaDevices.getUserMedia({ audio: true });
    } catch (error) {
      throw new Error(error.name === "NotAllowedError" ? "its use was not allowed" : error.name === "NotFoundError" ? "there is none" : error.message);
    }
    return new Microphone(stream);
  }

  constructor(stream) {
    this.stream = stream;
    this.context = new AudioContext();
    this.analyser = new AnalyserNode(this.context, { fftSize: 1024 });
    this.samples = new Float32Array(this.analyser.fftSize);
    // Not connected to what is heard.
    this.context.createMediaStreamSource(stream).connect(this.analyser);
  }

  /** What the voice moves at the time of a frame in milliseconds, by names of ARKit. */
  pose(time) {
    const seconds = this.#last ? Math.min(0.1, (time - this.#last) / 1000) : 0;
    this.#last = time;
    this.analyser.getFloatTimeDomainData(this.samples);
    const energy = Math.sqrt(this.samples.reduce((sum, value) => sum + value * value, 0) / this.samples.length);
    const open = this.#drive.step(energy, seconds);
    return Object.fromEntries(Object.entries(LOUD).map(([name, value]) => [name, value * open]));
  }

  /** As a closed mouth. */
  static get silent() {
    return Object.fromEntries(Object.keys(LOUD).map((name) => [name, 0]));
  }

  dispose() {
    for (const track of this.stream.getTracks()) track.stop();
    this.context.close();
  }
}
