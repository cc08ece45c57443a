// SPDX-License-Identifier: MIT
// The expressions of ARKit, for rigs that name their raw controls otherwise.
import { Kind } from "mien";

export class ArkitControls {
  /** Null if the rig's own controls have these names, or if it has none for them. */
  static of(mien, rig) {
    const matrix = mien.arkitMatrix();
    const channels = [...new Set(matrix.map(({ channel }) => channel))];
    if (channels.every((name) => rig.find(Kind.RAW_CONTROL, name) !== undefined)) return null;
    const clip = mien.buildClip({ names: channels, values: new Float32Array(channels.length), rateNumerator: 60, rateDenominator: 1 });
    const names = clip.channels.map(({ name }) => name);
    const binding = clip.bind(rig, { matrix });
    clip.dispose();
    const missing = new Set(binding.info.missingChannels);
    if (missing.size < names.length) return new ArkitControls(binding, names, missing);
    binding.dispose();
    return null;
  }

  constructor(binding, names, missing) {
    this.binding = binding;
    this.row = new Float32Array(names.length);
    this.channels = names.map((_, i) => i).filter((i) => !missing.has(i));
    this.names = this.channels.map((i) => names[i]);
    this.values = new Float32Array(this.names.length);
  }

  /** Sets the raw controls of a face that ARKit's expressions drive. */
  set(index, value, face) {
    this.values[index] = this.row[this.channels[index]] = value;
    this.binding.apply(this.row, face);
  }

  /** A row of the binding with one expression at 1. */
  rowOf(index) {
    const row = new Float32Array(this.row.length);
    row[this.channels[index]] = 1;
    return row;
  }

  reset() {
    this.values.fill(0);
    this.row.fill(0);
  }

  dispose() {
    this.binding.dispose();
  }
}
