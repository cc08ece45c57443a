// SPDX-License-Identifier: MIT
// The sound of a take: its clock is the one that a take with sound follows, as ears notice what eyes do not.

export const SOUNDS = /\.(wav|mp3|ogg|oga|opus|m4a|flac)$/i;

export class Sound {
  /** Opens the bytes of a file; rejects with an Error if the browser cannot play them. */
  static async open(name, bytes) {
    const address = URL.createObjectURL(new Blob([bytes]));
    const audio = new Audio();
    audio.preload = "auto";
    try {
      await new Promise((resolve, reject) => {
        audio.addEventListener("loadedmetadata", resolve, { once: true });
        audio.addEventListener("error", () => reject(new Error("this browser cannot play it")), { once: true });
        audio.src = address;
      });
    } catch (error) {
      URL.revokeObjectURL(address);
      throw error;
    }
    return new Sound(name, audio, address);
  }

  constructor(name, audio, address) {
    Object.assign(this, { name, audio, address });
  }

  get duration() { return this.audio.duration; }

  /** Plays from `seconds` on. Rejects where the browser asks for a press of a button first. */
  async play(seconds) {
    this.seek(seconds);
    if (seconds < this.duration) await this.audio.play();
  }

  pause() { this.audio.pause(); }

  seek(seconds) { this.audio.currentTime = Math.min(seconds, this.duration); }

  /** Seconds while it is heard, else null: then the caller's own clock goes on. */
  get time() { return this.audio.paused || this.audio.ended ? null : this.audio.currentTime; }

  set isMuted(value) { this.audio.muted = value; }

  dispose() {
    this.audio.pause();
    this.audio.removeAttribute("src");
    URL.revokeObjectURL(this.address);
  }
}
