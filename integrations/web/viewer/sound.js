// SPDX-License-Identifier: MIT
// The sound of a take, by the WebAudio API. Its clock is the one that a take with sound follows, as ears notice what eyes
// do not.

export const SOUNDS = /\.(wav|mp3|ogg|oga|opus|m4a|flac)$/i;

const RATE = 48000;
/** A sound is kept decoded, four bytes a value: ten minutes of stereo. */
const MOST_VALUES = 2 * 600 * RATE;
/** Of a file, as it is decoded as a whole: what ten minutes take without loss, and with the highest rates of the others. */
const mostBytes = (name) => (/\.(wav|flac)$/i.test(name) ? 128e6 : 24e6);

/** Seconds: how far ahead a sound is scheduled, so that it begins at the sample that is meant; how long the context may
 * take to run; and how long it runs on when nothing is heard. */
const [AHEAD, GRACE, REST] = [0.02, 0.5, 0.5];
/** Seconds of a sound that are heard where the slider is; the next part begins when the last one is half over. */
const GRAIN = 0.1;
/** Seconds in which the level rises at a beginning and falls at an end, so that neither clicks. */
const FADE = 0.005;

const after = (seconds) => new Promise((resolve) => setTimeout(resolve, 1000 * seconds));

export class Sound {
  #playing = null; // what play() has started: nodes, when it begins by the clock of the context, and where in the sound
  #held = null;    // where play() begins once the context runs
  #turn = 0;       // counts calls of play() and pause()
  #grainAt = -Infinity;
  #rest = 0;
  isWaiting = false; // for a key or a press, as the browser refused to play

  /** Decodes the bytes of a file; rejects with an Error if the browser cannot. */
  static async open(name, bytes) {
    const most = mostBytes(name);
    if (bytes.length > most) throw new Error(`it has ${Math.ceil(bytes.length / 1e6)} MB; at most ${most / 1e6} are played`);
    let buffer;
    try {
      // It takes the bytes it is given.
      buffer = await new OfflineAudioContext(1, 1, RATE).decodeAudioData(bytes.slice().buffer);
    } catch {
      throw new Error("this browser cannot decode it: it is no sound, is damaged, or is of a kind that the browser does not know");
    }
    if (buffer.length * buffer.numberOfChannels > MOST_VALUES) {
      const text = `${buffer.duration.toFixed(0)} s of ${buffer.numberOfChannels} channels`;
      throw new Error(`it has ${text}; at most ten minutes of stereo are played`);
    }
    return new Sound(name, buffer);
  }

  constructor(name, buffer) {
    const context = new AudioContext({ sampleRate: RATE });
    const output = new GainNode(context);
    output.connect(context.destination);
    Object.assign(this, { name, buffer, context, output });
  }

  get duration() { return this.buffer.duration; }

  /** Plays from `seconds` on. Rejects where the browser asks for a key or a press first. */
  async play(seconds) {
    this.#silence();
    const turn = this.#turn;
    if (seconds >= this.duration) return;
    this.#held = seconds;
    await Promise.race([this.context.resume().catch(() => {}), after(GRACE)]);
    if (turn !== this.#turn) return;
    this.#held = null;
    if (this.context.state !== "running") {
      this.isWaiting = true;
      throw new Error("the browser does not play it yet");
    }
    const begin = this.context.currentTime + AHEAD;
    const { source, level } = this.#node();
    level.gain.setValueAtTime(0, begin).linearRampToValueAtTime(1, begin + FADE);
    source.start(begin, seconds);
    this.#playing = { source, level, begin, from: seconds };
  }

  pause() {
    this.#silence();
    this.#restLater();
  }

  /** A short part of the sound, as the slider passes. */
  scrub(seconds) {
    const turn = this.#turn;
    this.#restLater();
    this.context.resume().then(() => {
      const { currentTime } = this.context;
      if (turn !== this.#turn || currentTime < this.#grainAt + GRAIN / 2 || seconds >= this.duration) return;
      this.#grainAt = currentTime;
      const { source, level } = this.#node();
      level.gain.setValueAtTime(0, currentTime).linearRampToValueAtTime(1, currentTime + GRAIN / 2)
        .linearRampToValueAtTime(0, currentTime + GRAIN);
      source.start(currentTime, seconds, GRAIN);
    }, () => {});
  }

  /** Where in the sound the ear is, in seconds, or will be in a moment; null while nothing is heard: then the caller's
   * own clock goes on. */
  get time() {
    if (this.#held !== null) return this.#held;
    if (!this.#playing || this.context.state !== "running") return null;
    const { begin, from } = this.#playing;
    // What the context has given away is heard when it has gone through the system and the device.
    const { currentTime, outputLatency, baseLatency } = this.context;
    const heard = from + currentTime - (outputLatency || baseLatency || 0) - begin;
    return heard < this.duration ? Math.max(from, heard) : null;
  }

  set isMuted(value) { this.output.gain.value = value ? 0 : 1; }

  dispose() {
    this.#silence();
    this.context.close().catch(() => {});
  }

  #node() {
    const source = new AudioBufferSourceNode(this.context, { buffer: this.buffer });
    const level = new GainNode(this.context);
    source.connect(level).connect(this.output);
    source.addEventListener("ended", () => level.disconnect());
    return { source, level };
  }

  #silence() {
    ++this.#turn;
    clearTimeout(this.#rest);
    this.#held = null;
    this.isWaiting = false;
    if (!this.#playing) return;
    const { source, level } = this.#playing;
    const { currentTime } = this.context;
    level.gain.cancelScheduledValues(currentTime).setTargetAtTime(0, currentTime, FADE / 2);
    source.stop(currentTime + 4 * FADE);
    this.#playing = null;
  }

  /** A context that runs keeps the device awake. */
  #restLater() {
    clearTimeout(this.#rest);
    this.#rest = setTimeout(() => this.context.suspend().catch(() => {}), 1000 * REST);
  }
}
