// SPDX-License-Identifier: MIT
// Clips: curves of named channels, played and bound to rigs.
import { layouts, TICKS_PER_SECOND } from "./api.js";
import { Handle, makeHandle } from "./handle.js";

export class Clip extends Handle {
  #info;

  static open(memory, bytes) {
    return new Clip(memory, makeHandle(memory, (out, error, scratch) =>
      memory.withStream(bytes, scratch, (stream) =>
        memory.exports.mien_clip_open_stream(stream, scratch.struct("ClipOpenDesc"), out, error))));
  }

  /** Builds a clip: `names` of channels, and `values` of one frame after the other. */
  static build(memory, desc) {
    const channelCount = desc.channelCount ?? desc.names.length;
    const frameStride = desc.frameStride || channelCount;
    const frameCount = desc.frameCount ?? (frameStride ? Math.floor(desc.values.length / frameStride) : 0);
    if (desc.names.length < channelCount || (desc.snaps && desc.snaps.length < channelCount)) {
      throw new RangeError(`${channelCount} channels need as many names and snaps`);
    }
    if (frameCount && desc.values.length < (frameCount - 1) * frameStride + channelCount) {
      throw new RangeError(`${frameCount} frames need more than ${desc.values.length} values`);
    }
    return new Clip(memory, makeHandle(memory, (out, error, scratch) =>
      memory.exports.mien_clip_build(
        scratch.struct("ClipDesc", { ...desc, channelCount, frameStride, frameCount }), out, error)));
  }

  constructor(memory, handle) {
    super(memory, handle, "mien_clip_close");
  }

  get info() {
    return (this.#info ??= this.struct("mien_clip_info", "ClipInfo"));
  }

  /** In seconds. */
  get duration() {
    return this.info.length / TICKS_PER_SECOND;
  }

  get channels() {
    return Array.from({ length: this.info.channelCount }, (_, i) => this.struct("mien_clip_channel", "ClipChannel", i));
  }

  get events() {
    return Array.from({ length: this.info.eventCount }, (_, i) => this.struct("mien_clip_event", "ClipEvent", i));
  }

  findChannel(name) {
    const { memory } = this;
    return memory.withScratch((scratch) => {
      const out = scratch.take(4);
      const [text, count] = scratch.text(name);
      memory.check(memory.exports.mien_clip_find_channel_n(this.handle, text, count, out), 0, `no channel "${name}"`);
      return memory.data.getUint32(out, true);
    });
  }

  /** Throws if a byte has changed or a curve cannot be decoded. */
  verify() {
    const { memory } = this;
    memory.withScratch((scratch) => {
      const error = scratch.out("Error");
      memory.check(memory.exports.mien_clip_verify(this.handle, error), error);
    });
  }

  /** A copy of frames, one after the other. */
  read(firstFrame = 0, frameCount = this.info.frameCount - firstFrame) {
    const { memory } = this;
    return memory.withScratch((scratch) => {
      const error = scratch.out("Error");
      const { frameCount: frames, channelCount } = this.info;
      if (frameCount > frames) throw new RangeError(`${frameCount} frames of ${frames}`);
      const count = Math.max(0, frameCount) * channelCount;
      const out = scratch.take(Math.max(1, count) * 4);
      memory.check(memory.exports.mien_clip_read(this.handle, firstFrame, frameCount, out, 0, error), error);
      return memory.array("f32", out, count).slice();
    });
  }

  /** The bytes of the clip. */
  write() {
    return this.bytes((buffer, capacity, size, error) =>
      this.memory.exports.mien_clip_write_memory(this.handle, buffer, capacity, size, error));
  }

  player(desc = {}) {
    return new ClipPlayer(this.memory, this, desc);
  }

  bind(rig, desc = {}) {
    return new ClipBinding(this.memory, this, rig, desc);
  }
}

export class ClipPlayer extends Handle {
  constructor(memory, clip, desc) {
    super(memory, makeHandle(memory, (out, error, scratch) =>
      memory.exports.mien_clip_player_create(memory.handleOf(clip), scratch.struct("ClipPlayerDesc", desc), out, error)),
    "mien_clip_player_destroy");
  }

  get info() {
    return this.struct("mien_clip_player_info", "ClipPlayerInfo");
  }

  /** To a time in ticks. */
  seek(tick) {
    this.call("mien_clip_player_seek", BigInt(tick));
  }

  setSpeed(numerator, denominator = 1) {
    this.call("mien_clip_player_set_speed", numerator, denominator);
  }

  /** By ticks: Math.round(seconds * TICKS_PER_SECOND). */
  advance(ticks) {
    this.call("mien_clip_player_advance", BigInt(ticks));
  }

  /** The events that the last advance() passed. */
  *events() {
    for (;;) {
      const event = this.memory.withScratch((scratch) => {
        const out = scratch.out("ClipEvent");
        const found = scratch.take(4);
        this.call("mien_clip_player_next_event", out, found);
        return this.memory.data.getUint32(found, true) ? this.memory.read("ClipEvent", out) : null;
      });
      if (!event) return;
      yield event;
    }
  }

  /** One float per channel. */
  sample() {
    const { memory } = this;
    return memory.withScratch((scratch) => {
      const out = scratch.take(8);
      this.call("mien_clip_player_sample", out);
      return memory.array("f32", memory.data.getUint32(out, true), memory.data.getUint32(out + 4, true));
    });
  }
}

export class ClipBinding extends Handle {
  #info;

  constructor(memory, clip, rig, desc) {
    super(memory, makeHandle(memory, (out, error, scratch) =>
      memory.exports.mien_clip_binding_create(memory.handleOf(clip), memory.handleOf(rig), scratch.struct("ClipBindingDesc", desc), out, error)),
    "mien_clip_binding_destroy");
  }

  /** What was found, as arrays of indices. */
  get info() {
    if (!this.#info) {
      const info = this.struct("mien_clip_binding_info", "ClipBindingInfo");
      this.#info = Object.fromEntries(Object.entries(info).map(([key, value]) =>
        [key, typeof value === "number" ? value : value.slice()]));
    }
    return this.#info;
  }

  /** Sets the raw controls of an instance that the clip drives. `values` are those of a player. */
  apply(values, instance) {
    const { memory } = this;
    memory.withScratch((scratch) => {
      memory.handleOf(instance); // of this module
      const raw = instance.rawControls;
      const isInside = values instanceof Float32Array && values.buffer === memory.buffer;
      const inside = isInside ? values.byteOffset : scratch.array("f32", values);
      this.call("mien_clip_binding_apply", inside, values.length, raw.byteOffset, raw.length);
    });
  }

  /** Steps for ClipDesc.snaps of which half moves nothing by more than `tolerance` millimeters. */
  findSnaps(deformer, tolerance = 0.02) {
    const { memory } = this;
    return memory.withScratch((scratch) => {
      const error = scratch.out("Error");
      const count = this.info.channelCount;
      const out = scratch.take(Math.max(1, count) * 4);
      memory.check(memory.exports.mien_clip_binding_snaps(
        this.handle, memory.handleOf(deformer), tolerance, out, count, error), error);
      return memory.array("f32", out, count).slice();
    });
  }
}

/** For ClipBindingDesc.matrix of clips with the names of ARKit. */
export function arkitMatrix(memory) {
  return memory.withScratch((scratch) => {
    const find = (entries, capacity) => {
      const out = scratch.take(4);
      memory.check(memory.exports.mien_arkit_matrix(entries, capacity, out), 0, "mien_arkit_matrix");
      return memory.data.getUint32(out, true);
    };
    const { size } = layouts.MatrixEntry;
    const count = find(0, 0);
    const entries = scratch.take(count * size);
    find(entries, count);
    return Array.from({ length: count }, (_, i) => memory.read("MatrixEntry", entries + i * size));
  });
}
