// SPDX-License-Identifier: MIT
// Materials of the meshes of a rig, out of the file that `mien author` writes beside it: head.materials.json.
import {
  CustomBlending, DoubleSide, LinearSRGBColorSpace, MeshStandardMaterial, OneFactor, RepeatWrapping, SRGBColorSpace, Texture, ZeroFactor,
} from "three";
import { asEye } from "./cornea.js";

// What each texture of the file is to three.js.
const MAPS = { base_color: "map", normal: "normalMap", roughness: "roughnessMap" };

/** Draws details that are smaller than pixels as well as they can be: textures seen from the side, edges of hair cards. */
export function refine(material) {
  for (const slot of Object.values(MAPS)) if (material[slot]) material[slot].anisotropy = 8; // pores and seams
  if (!(material.alphaTest > 0)) return;
  material.alphaToCoverage = true;
  // What is drawn stays opaque where something opaque is behind it: the page shines through the canvas.
  Object.assign(material, {
    blending: CustomBlending, blendSrc: OneFactor, blendDst: ZeroFactor, blendSrcAlpha: OneFactor, blendDstAlpha: OneFactor,
  });
}

const isObject = (value) => value !== null && typeof value === "object" && !Array.isArray(value);

export class Materials {
  #textures = new Map(); // by path
  #made = [];

  /** `text` is that of the file; `find` gives the image at a path in it, a Blob, or null if there is none. */
  static async open(text, find) {
    const file = JSON.parse(text);
    if (!isObject(file) || !Array.isArray(file.materials) || !isObject(file.meshes)) {
      throw new Error("it is no list of materials and of meshes");
    }
    const materials = new Materials(file);
    const paths = new Set(file.materials.flatMap((material) => Object.values(material?.textures ?? {})));
    materials.missing = [];
    for (const path of paths) {
      const blob = typeof path === "string" && path !== "" ? await find(path) : null;
      const image = blob && await createImageBitmap(blob, { imageOrientation: "flipY", premultiplyAlpha: "none" }).catch(() => null);
      if (image) materials.#textures.set(path, image);
      else materials.missing.push(String(path));
    }
    return materials;
  }

  constructor({ materials, meshes }) {
    this.list = new Map(materials.map((material) => [material?.name, material]));
    this.meshes = new Map(Object.entries(meshes));
  }

  /** The material of a mesh, or undefined if the file says nothing about it. */
  of(mesh) {
    const given = this.list.get(this.meshes.get(mesh));
    if (!given) return undefined;
    const made = new MeshStandardMaterial({ roughness: 0.5 });
    const color = given.base_color;
    if (Array.isArray(color)) {
      made.color.setRGB(color[0] ?? 1, color[1] ?? 1, color[2] ?? 1, LinearSRGBColorSpace);
      made.opacity = color[3] ?? 1;
      made.transparent = made.opacity < 1;
    }
    if (given.alpha_cutoff > 0) { // cards of hair
      made.alphaTest = given.alpha_cutoff;
      made.side = DoubleSide;
    }
    for (const [kind, slot] of Object.entries(MAPS)) {
      const image = this.#textures.get(given.textures?.[kind]);
      if (!image) continue;
      const texture = new Texture(image);
      texture.flipY = false; // the image is
      texture.wrapS = texture.wrapT = RepeatWrapping;
      texture.colorSpace = kind === "base_color" ? SRGBColorSpace : LinearSRGBColorSpace;
      texture.needsUpdate = true;
      made[slot] = texture;
      this.#made.push(texture);
    }
    // A texture is the roughness itself, unless the file scales it.
    if (typeof given.roughness === "number" || made.roughnessMap) made.roughness = given.roughness ?? 1;
    refine(made);
    if (isObject(given.cornea)) asEye(made, given.cornea);
    // Colors of vertices stand for a material where none is given.
    made.userData.hasColor = Array.isArray(color) || made.map !== null;
    return made;
  }

  dispose() {
    for (const texture of this.#made) texture.dispose();
    for (const image of this.#textures.values()) image.close();
  }
}
