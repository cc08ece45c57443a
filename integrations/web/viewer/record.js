// SPDX-License-Identifier: MIT
// What the page gives away as files: the shown head as GLB, and poses recorded over time.
import { BufferAttribute, BufferGeometry, Group, Mesh, MeshStandardMaterial } from "three";

const RATE = 60;
/** Ten minutes. */
const MOST_FRAMES = 600 * RATE;

/** Takes the pose of a model at 60 frames a second of the clock. */
export class Recording {
  #start = 0;
  frames = [];

  /** Fills the frames up to a time in milliseconds with the pose; false when there is room for no more. */
  take(time, pose) {
    if (!this.frames.length) this.#start = time;
    const due = Math.floor(((time - this.#start) * RATE) / 1000);
    while (this.frames.length <= due && this.frames.length < MOST_FRAMES) {
      this.frames.push({ time: this.frames.length / RATE, raw: pose });
    }
    return this.frames.length < MOST_FRAMES;
  }

  /** What `mien eval` and this page take. */
  json() {
    return `${JSON.stringify({ rate: RATE, frames: this.frames })}\n`;
  }
}

/** The bytes of a GLB with the meshes of a rig as they are shown: deformed, in meters, without skeleton. */
export async function exportGlb(model) {
  const { GLTFExporter } = await import("three/addons/exporters/GLTFExporter.js");
  const group = new Group();
  for (const mesh of model.object.children) {
    if (!mesh.isMesh || !mesh.visible) continue;
    const { index, vertexCount } = mesh.userData;
    const [positions, normals] = [new Float32Array(3 * vertexCount), new Float32Array(3 * vertexCount)];
    model.object.deformed.writeVertices(index, vertexCount, positions, normals);
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(positions, 3));
    geometry.setAttribute("normal", new BufferAttribute(normals, 3));
    if (mesh.geometry.attributes.color && mesh.material.vertexColors) {
      geometry.setAttribute("color", mesh.geometry.attributes.color);
    }
    geometry.setIndex(mesh.geometry.index);
    geometry.applyMatrix4(model.object.matrix);
    const { color, roughness = 0.6, metalness = 0, vertexColors, transparent, opacity, side } = mesh.material;
    const material = new MeshStandardMaterial({ color, roughness, metalness, vertexColors, transparent, opacity, side });
    const made = new Mesh(geometry, material);
    made.name = mesh.name;
    group.add(made);
  }
  return new Uint8Array(await new GLTFExporter().parseAsync(group, { binary: true }));
}
