// SPDX-License-Identifier: MIT
// Shadows of the key light with soft edges: variance shadow maps (Donnelly and Lauritzen 2006), which are blurred once for
// all pixels, so that a pixel of the screen reads them once.
import { ShaderChunk, VSMShadowMap } from "three";

const SIZE = 256;
/** Pixels of the map, which is as wide as the head, and how many of them are read. */
const [BLUR, SAMPLES] = [2, 5];

// A surface that turns away from the light does not shade itself: light ends there by itself, and that of skin goes
// farther. What is so near that it may be the same surface, of something as round as a head, shades it little by little.
const changes = {
  shadowmap_pars_fragment: [
    ["float VSMShadow", "float shadowTurn = 0.0;\n$&"],
    ["float hard_shadow =", "compare -= 0.3 * max( 0.0, shadowTurn - 0.25 );\n$&"],
    ["occlusion = clamp( max( hard_shadow, softness_probability )",
      "softness_probability = max( softness_probability, 1.0 - smoothstep( 0.0, 0.001 + 0.25 * shadowTurn, distance ) );\n$&"],
  ],
  lights_fragment_begin: [
    ["directionalLightShadow = directionalLightShadows[ i ];",
      "$&\nshadowTurn = max( 0.0, 0.3 - dot( nonPerturbedNormal, directLight.direction ) );"],
  ],
};
for (const [chunk, pairs] of Object.entries(changes)) {
  for (const [from, to] of pairs) {
    if (!ShaderChunk[chunk].includes(from)) throw new Error(`this three.js has no ${from}`);
    ShaderChunk[chunk] = ShaderChunk[chunk].replace(from, to);
  }
}

export function castShadows(renderer) {
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = VSMShadowMap;
}

/** Makes a directional light, which shines along its position, cast shadows on what is in a sphere. */
export function aim(light, center, radius) {
  light.castShadow = true;
  light.target.position.copy(center);
  light.target.updateMatrixWorld();
  light.position.setLength(2 * radius).add(center);
  const { shadow } = light;
  shadow.mapSize.set(SIZE, SIZE);
  Object.assign(shadow, { radius: BLUR, blurSamples: SAMPLES, bias: -0.003 });
  Object.assign(shadow.camera, { left: -radius, right: radius, bottom: -radius, top: radius, near: radius, far: 3 * radius });
  shadow.camera.updateProjectionMatrix();
}
