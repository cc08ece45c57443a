// SPDX-License-Identifier: MIT
// The meshes of a rig as objects of three.js, posed by Mien.
import type { Camera, Group, Material, Matrix4, MeshStandardMaterial, Object3D, Vector3 } from "three";
import type { DeformerInstance, Instance, Normals, Rig } from "./index.js";

export type MeshClass = "skin" | "eye" | "teeth" | "tongue" | "hair" | "film";

/** What a mesh shows, by its name; "film": tears and shells over the eyes. */
export function meshClass(name: string): MeshClass;

/** The material of a mesh of a class for which FaceObject was given none. */
export function defaultMaterial(kind: MeshClass): MeshStandardMaterial;

/** The matrix from the axes and units of a rig to those of three.js: x left, y up, z front, meters. */
export function rigMatrix(rig: Rig): Matrix4;

export interface FaceObjectOptions {
  /** The character to show; default: a new one, which is disposed with the object. */
  face?: Instance;
  /** "mien" (default): Mien deforms the vertices, with all influences, and computes normals. "gpu": Mien gives
   * skin matrices and target weights, the vertex shader deforms with the four strongest influences of a vertex,
   * and normals follow the skin only. Exact is the first one; the second one leaves the CPU to others. */
  skinning?: "mien" | "gpu";
  /** How Mien makes normals. */
  normals?: Normals;
  /** Makes the material of a mesh; undefined: a MeshStandardMaterial by its class. Colors of vertices that the rig
   * has are multiplied by its color, unless its userData.hasColor is true. */
  material?: (kind: MeshClass, name: string) => Material | undefined;
  /** Show tears, shells, and lashes without a texture: they look right with textures only. Default: false. */
  showFilms?: boolean;
}

/** A face: one mesh for each mesh of the LOD, with vertex colors if the file has them. */
export class FaceObject extends Group {
  constructor(rig: Rig, options?: FaceObjectOptions);
  readonly rig: Rig;
  /** Set its controls, then call update(). */
  readonly face: Instance;
  readonly deformed: DeformerInstance;
  readonly skinning: "mien" | "gpu";
  normals: Normals;
  readonly lodCount: number;
  /** The LOD that is shown; written, it is clamped to those that exist. */
  lod: number;
  /** Center of the neutral head, in the space of the parent. */
  readonly center: Vector3;
  /** Evaluates the controls and poses the meshes. */
  update(): void;
  /** Poses the meshes by the last evaluation of `face`. */
  pose(): void;
  /** The LOD for a camera: 0 up to `near` meters (default: 0.8), the next one with each doubling. */
  lodOf(camera: Camera, near?: number): number;
  /** Releases the memory of GPU and module; the rig stays. */
  dispose(): void;
}

/** Drives a GLB file by the names of its joints and targets: one that `mien export --skeleton` wrote of the same rig.
 * Open the rig with { system: "gltf" }. */
export class GltfFace {
  constructor(object: Object3D, rig: Rig);
  readonly rig: Rig;
  readonly face: Instance;
  readonly deformed: DeformerInstance;
  /** What of the rig was found in the object. */
  readonly found: { readonly joints: number; readonly targets: number };
  update(lod?: number): void;
  dispose(): void;
}
