// SPDX-License-Identifier: MIT
// Lights to look at a face in.
import { AmbientLight, DirectionalLight, HemisphereLight, Vector3 } from "three";
import { aim } from "./shadows.js";

/** Of each: lamps [color, strength, x, y, z], from where they shine, of which the first casts shadows; colors of sky and
 * ground with their strength; and the strength of light from everywhere. Left is +x, up +y, to the front +z. */
const PRESETS = {
  Studio: {
    lamps: [[0xfff0e0, 2.6, -0.5, 0.6, 0.8], [0xbfd0e8, 0.6, 0.9, 0.1, 0.6], [0xdfeaff, 1.8, 0.8, 0.4, -0.7],
      [0xe8ecf4, 0.8, -0.8, 0.3, -0.8]],
    sky: [0xd8e0ea, 0x8c7466, 0.9], everywhere: 0.15,
  },
  Soft: {
    lamps: [[0xfff6ee, 1.1, -0.4, 0.5, 1], [0xf2f6ff, 1, 0.5, 0.3, 1], [0xffffff, 0.5, 0, -0.4, 0.9]],
    sky: [0xf2f4f8, 0xb8a89c, 1.3], everywhere: 0.3,
  },
  Side: {
    lamps: [[0xffedd8, 3.6, -1, 0.25, 0.15], [0x9fb8de, 0.35, 1, 0.1, 0.5]],
    sky: [0x8c96a8, 0x4c4038, 0.25], everywhere: 0.03,
  },
  Rim: {
    lamps: [[0xe4eeff, 4.5, 0.9, 0.4, -0.7], [0xffe6cc, 4.5, -0.9, 0.4, -0.7], [0xffffff, 0.5, 0, 0.3, 1]],
    sky: [0x8c96a8, 0x4c4038, 0.25], everywhere: 0.05,
  },
  Noon: {
    lamps: [[0xfff8ea, 4, 0.15, 1, 0.35]],
    sky: [0xbcd4f4, 0x9a8a70, 1.2], everywhere: 0.05,
  },
  "From below": {
    lamps: [[0xffe2b8, 3.4, 0.1, -0.9, 0.7]],
    sky: [0x5c6678, 0x6c5440, 0.3], everywhere: 0.03,
  },
};

export const LIGHTS = Object.keys(PRESETS);

export class Lights {
  #lights = [];
  #name = LIGHTS[0];
  #center = new Vector3();
  #radius = 0.2;

  constructor(scene) {
    this.scene = scene;
    this.choose(this.#name);
  }

  /** Shadows fall on what is in a sphere. */
  shade(center, radius) {
    this.#center.copy(center);
    this.#radius = radius;
    this.choose(this.#name);
  }

  choose(name) {
    this.#name = name;
    const { lamps, sky, everywhere } = PRESETS[name];
    for (const light of this.#lights) {
      this.scene.remove(light);
      light.dispose();
    }
    this.#lights = lamps.map(([color, strength, x, y, z]) => {
      const light = new DirectionalLight(color, strength);
      light.position.set(x, y, z);
      return light;
    });
    aim(this.#lights[0], this.#center, this.#radius);
    this.#lights.push(new HemisphereLight(...sky), new AmbientLight(0xffffff, everywhere));
    this.scene.add(...this.#lights);
  }
}
