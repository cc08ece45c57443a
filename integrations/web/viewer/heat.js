// SPDX-License-Identifier: MIT
// Colors the vertices of meshes by their distance from the neutral pose, or from other positions: still ones gray, the
// farthest red.
import { BufferAttribute } from "three";

/** What the eye does not see and rounding gives: meters. */
const STILL = 2e-5;
/** A face in which nothing moves farther has no red: meters. */
const LEAST_SCALE = 5e-4;

export class HeatMap {
  #meshes = new Map();

  /** `reference` gives the positions that a mesh is compared with, or null for a mesh that has none; then nothing of it
   * has moved. Returns the largest distance, in meters. */
  apply(face, reference = (mesh) => neutralOf(mesh, face)) {
    const unit = face.matrix.getMaxScaleOnAxis();
    let most = 0;
    const distances = new Map();
    face.traverse((mesh) => {
      if (!mesh.isMesh || !mesh.visible) return;
      if (!this.#meshes.has(mesh)) this.#begin(mesh, reference(mesh));
      const { from } = this.#meshes.get(mesh);
      const { array } = mesh.geometry.attributes.position;
      const found = new Float32Array(array.length / 3);
      for (let i = 0; from && i < found.length; ++i) {
        const at = 3 * i;
        found[i] = unit * Math.hypot(array[at] - from[at], array[at + 1] - from[at + 1], array[at + 2] - from[at + 2]);
        if (found[i] < STILL) found[i] = 0;
        if (found[i] > most) most = found[i];
      }
      distances.set(mesh, found);
    });
    const scale = 1 / Math.max(most, LEAST_SCALE);
    for (const [mesh, found] of distances) {
      const { color } = mesh.geometry.attributes;
      found.forEach((distance, i) => {
        const t = distance * scale;
        color.setXYZ(i, 0.35 + 0.5 * t, 0.35 * (1 - t) + 0.35 * t * (1 - t), 0.37 * (1 - t) ** 2);
      });
      color.needsUpdate = true;
    }
    return most;
  }

  #begin(mesh, from) {
    const { material, geometry } = mesh;
    this.#meshes.set(mesh, {
      color: geometry.attributes.color, base: material.color.getHex(), vertexColors: material.vertexColors, map: material.map, from,
    });
    geometry.setAttribute("color", new BufferAttribute(new Float32Array(geometry.attributes.position.array.length), 3));
    material.color.set(0xffffff);
    material.map = null;
    material.vertexColors = true;
    material.needsUpdate = true;
  }

  end() {
    for (const [mesh, { color, base, vertexColors, map }] of this.#meshes) {
      if (color) mesh.geometry.setAttribute("color", color);
      else mesh.geometry.deleteAttribute("color");
      mesh.material.color.set(base);
      mesh.material.map = map;
      mesh.material.vertexColors = vertexColors;
      mesh.material.needsUpdate = true;
    }
    this.#meshes.clear();
  }
}

function neutralOf(mesh, face) {
  const { positions, vertexPositionIndices } = face.rig.deformer.mesh(mesh.userData.index);
  const neutral = new Float32Array(3 * vertexPositionIndices.length);
  vertexPositionIndices.forEach((position, i) => {
    for (let k = 0; k < 3; ++k) neutral[3 * i + k] = positions[3 * position + k];
  });
  return neutral;
}
