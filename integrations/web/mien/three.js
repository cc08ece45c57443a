// SPDX-License-Identifier: MIT
// The meshes of a rig as objects of three.js, posed by Mien. three.d.ts is the manual.
import {
  Bone, BufferAttribute, BufferGeometry, Color, DoubleSide, Group, Matrix4, Mesh, MeshStandardMaterial, Skeleton,
  SkinnedMesh, Vector3,
} from "three";
import { Direction, Kind, Normals, TranslationUnit } from "./api.js";

// The first word that a name contains decides: an eyelash is not an eye.
const WORDS = [
  ["eyeshell", "film"], ["eyeedge", "film"], ["cornea", "film"], ["occlusion", "film"], ["shell", "film"],
  ["saliva", "film"], ["tear", "film"], ["cartilage", "film"], ["lash", "hair"], ["teeth", "teeth"], ["tooth", "teeth"],
  ["gum", "tongue"], ["tongue", "tongue"], ["brow", "hair"], ["hair", "hair"], ["beard", "hair"], ["eyelid", "skin"],
  ["eye", "eye"], ["iris", "eye"], ["pupil", "eye"], ["mouth", "tongue"],
];
const MATERIALS = {
  skin: { color: 0xcdaa96, roughness: 0.55 },
  eye: { color: 0xffffff, roughness: 0.12 },
  teeth: { color: 0xe4dbc8, roughness: 0.25 },
  tongue: { color: 0xac5c58, roughness: 0.35 },
  hair: { color: 0x3e2e26, roughness: 0.7, side: DoubleSide },
  film: { color: 0x968c87, roughness: 0.2, transparent: true, opacity: 0.25 },
};

/** "skin", "eye", "teeth", "tongue", "hair" or "film" (tears, shells), by the name of a mesh. */
export function meshClass(name) {
  const lower = name.toLowerCase();
  return WORDS.find(([word]) => lower.includes(word))?.[1] ?? "skin";
}

/** The matrix from the axes and units of a rig to those of three.js: x left, y up, z front, meters. */
export function rigMatrix(rig) {
  const directions = {
    [Direction.LEFT]: [1, 0, 0], [Direction.RIGHT]: [-1, 0, 0], [Direction.UP]: [0, 1, 0],
    [Direction.DOWN]: [0, -1, 0], [Direction.FRONT]: [0, 0, 1], [Direction.BACK]: [0, 0, -1],
  };
  const scale = rig.info.translationUnit === TranslationUnit.CENTIMETERS ? 0.01 : 1;
  const [x, y, z] = rig.info.axes.map((axis) => new Vector3(...directions[axis]).multiplyScalar(scale));
  return new Matrix4().makeBasis(x, y, z);
}

/** Colors of the positions of a mesh out of the metadata, sRGB bytes, or null. */
function storedColors(rig, name, positionCount) {
  const text = rig.metadata.get(`mien.colors.${name}`);
  if (!text) return null;
  try {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    return bytes.length === 3 * positionCount ? bytes : null;
  } catch {
    return null;
  }
}

/** An eye without texture gets iris and pupil, by the angles of a human eye. */
function eyeColors(positions, front) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  positions.forEach((value, i) => {
    low[i % 3] = Math.min(low[i % 3], value);
    high[i % 3] = Math.max(high[i % 3], value);
  });
  const center = new Vector3(...low).add(new Vector3(...high)).multiplyScalar(0.5);
  const [pupil, iris, rim, white] = [0x0e0d0e, 0x5c7074, 0x28323a, 0xe8e4de].map((color) => new Color(color));
  const [point, color] = [new Vector3(), new Color()];
  const colors = new Uint8Array(positions.length);
  for (let i = 0; i < positions.length; i += 3) {
    point.fromArray(positions, i).sub(center);
    const angle = (point.angleTo(front) * 180) / Math.PI;
    color.copy(pupil);
    // Soft borders: hard ones would follow the edges of a coarse mesh.
    for (const [border, outside] of [[10, iris], [24, rim], [28, white]]) {
      color.lerp(outside, Math.min(1, Math.max(0, (angle - border) / 3 + 0.5)));
    }
    color.convertLinearToSRGB();
    [color.r, color.g, color.b].forEach((value, k) => { colors[i + k] = Math.round(255 * value); });
  }
  return colors;
}

/** Linear colors of vertices out of sRGB bytes of positions. */
function vertexColors(bytes, indices) {
  const linear = Float32Array.from({ length: 256 }, (_, i) => {
    const value = i / 255;
    return value < 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
  });
  const colors = new Float32Array(3 * indices.length);
  indices.forEach((position, i) => {
    for (let k = 0; k < 3; ++k) colors[3 * i + k] = linear[bytes[3 * position + k]];
  });
  return colors;
}

/** Whether normals point to the other side than the winding of the triangles says. */
function isWoundInward({ positions, normals, triangles, vertexPositionIndices }) {
  const [a, b, c, normal] = [new Vector3(), new Vector3(), new Vector3(), new Vector3()];
  let sum = 0;
  for (let i = 0; i < triangles.length; i += 3 * Math.max(1, Math.floor(triangles.length / 600))) {
    const corner = (k, out) => out.fromArray(positions, 3 * vertexPositionIndices[triangles[i + k]]);
    corner(0, a);
    corner(1, b).sub(a);
    corner(2, c).sub(a);
    sum += Math.sign(b.cross(c).dot(normal.fromArray(normals, 3 * triangles[i])));
  }
  return sum < 0;
}

const expand = (values, width, indices) => {
  const out = new Float32Array(width * indices.length);
  indices.forEach((index, i) => {
    for (let k = 0; k < width; ++k) out[width * i + k] = values[width * index + k];
  });
  return out;
};

/** The four strongest influences of each vertex; their weights add up to 1. */
function skinAttributes(deformer, mesh, neutral) {
  const indices = new Uint16Array(4 * neutral.vertexCount);
  const weights = new Float32Array(4 * neutral.vertexCount);
  const ofPosition = Array.from({ length: neutral.positionCount }, (_, position) => {
    const { joints, weights: all } = deformer.influences(mesh, position);
    const strongest = Array.from(all, (weight, i) => [weight, joints[i]]).sort((a, b) => b[0] - a[0]).slice(0, 4);
    const sum = strongest.reduce((total, [weight]) => total + weight, 0);
    return strongest.map(([weight, joint]) => [weight / (sum || 1), joint]);
  });
  neutral.vertexPositionIndices.forEach((position, vertex) => {
    ofPosition[position].forEach(([weight, joint], i) => {
      indices[4 * vertex + i] = joint;
      weights[4 * vertex + i] = weight;
    });
  });
  return { indices, weights };
}

/** Matrices that Mien has computed, instead of those of bones. */
class FaceSkeleton extends Skeleton {
  constructor(count) {
    super(Array.from({ length: count }, () => new Bone()));
  }

  update() {
    if (this.boneTexture) this.boneTexture.needsUpdate = true;
  }
}

/** The material that a mesh of a class gets if none is given. */
export function defaultMaterial(kind) {
  return new MeshStandardMaterial(MATERIALS[kind]);
}

export class FaceObject extends Group {
  #skeleton = null;
  #lod = -1;
  #loaded = new Map();
  #isOwner;

  constructor(rig, { face, skinning = "mien", normals = Normals.DEFAULT, material, showFilms = false } = {}) {
    super();
    if (!rig.deformer) throw new TypeError("the rig has no meshes");
    if (skinning !== "mien" && skinning !== "gpu") throw new TypeError(`skinning is "mien" or "gpu", not "${skinning}"`);
    this.rig = rig;
    this.#isOwner = !face;
    this.face = face ?? rig.instance();
    this.deformed = rig.deformer.instance();
    this.skinning = skinning;
    this.normals = normals;
    this.showFilms = showFilms;
    this.makeMaterial = (kind, name) => material?.(kind, name) ?? defaultMaterial(kind);
    this.matrix.copy(rigMatrix(rig));
    this.matrixAutoUpdate = false;
    if (skinning === "gpu") this.#skeleton = new FaceSkeleton(rig.deformer.info.jointCount);
    this.lod = 0;
  }

  get lodCount() {
    return this.rig.info.lodCount;
  }

  get lod() {
    return this.#lod;
  }

  /** Shows the meshes of a LOD; they are made when it is first shown. */
  set lod(lod) {
    const wanted = Math.max(0, Math.min(this.lodCount - 1, Math.floor(lod)));
    if (wanted === this.#lod) return;
    this.#lod = wanted;
    for (const mesh of this.#loaded.values()) mesh.visible = false;
    for (const index of this.rig.lodIndices(Kind.MESH, wanted).slice()) {
      let mesh = this.#loaded.get(index);
      if (!mesh) {
        mesh = this.#makeMesh(index);
        this.#loaded.set(index, mesh);
        this.add(mesh);
      }
      mesh.visible = mesh.userData.kind !== "film" || this.showFilms;
    }
    this.update();
  }

  #makeMesh(index) {
    const { rig } = this;
    const { deformer } = rig;
    // Copies first: they may take memory, and views of the mesh are valid until it grows.
    const triangles = deformer.triangles(index);
    const coordinates = deformer.textureCoordinates(index);
    const neutral = deformer.mesh(index);
    const name = rig.name(Kind.MESH, index);
    const kind = meshClass(name);
    const indices = neutral.vertexPositionIndices.slice();
    if (isWoundInward({ ...neutral, triangles })) {
      for (let i = 0; i < triangles.length; i += 3) [triangles[i + 1], triangles[i + 2]] = [triangles[i + 2], triangles[i + 1]];
    }
    const geometry = new BufferGeometry();
    geometry.setIndex(new BufferAttribute(triangles, 1));
    geometry.setAttribute("position", new BufferAttribute(expand(neutral.positions, 3, indices), 3));
    geometry.setAttribute("normal", new BufferAttribute(neutral.normals.slice(), 3));
    geometry.setAttribute("uv", new BufferAttribute(coordinates, 2));
    geometry.computeBoundingSphere();
    geometry.boundingSphere.radius *= 1.3; // for every expression

    const front = new Vector3(0, 0, 1).transformDirection(rigMatrix(rig).invert());
    const bytes = storedColors(rig, name, neutral.positionCount) ??
      (kind === "eye" ? eyeColors(neutral.positions, front) : null);
    const material = this.makeMaterial(kind, name);
    if (bytes && "vertexColors" in material && !material.userData.hasColor) {
      geometry.setAttribute("color", new BufferAttribute(vertexColors(bytes, indices), 3));
      material.vertexColors = true;
      material.color?.set(0xffffff);
    }
    const mesh = this.#skeleton ? this.#skinned(index, neutral, geometry, material) : new Mesh(geometry, material);
    mesh.name = name;
    // Cards of lashes are wedges until a texture cuts hairs out of them.
    const isShown = kind !== "film" && (material.map || !/lash/i.test(name));
    mesh.userData = { kind: isShown ? kind : "film", index, vertexCount: neutral.vertexCount, channels: neutral.targetChannels.slice() };
    return mesh;
  }

  /** A mesh for the GPU: four influences per vertex, and a morph target for each blend shape target. */
  #skinned(index, neutral, geometry, material) {
    const { deformer } = this.rig;
    const { indices, weights } = skinAttributes(deformer, index, neutral);
    geometry.setAttribute("skinIndex", new BufferAttribute(indices, 4));
    geometry.setAttribute("skinWeight", new BufferAttribute(weights, 4));
    if (neutral.targetCount) {
      const ofVertex = deformer.mesh(index).vertexPositionIndices.slice();
      geometry.morphTargetsRelative = true;
      geometry.morphAttributes.position = Array.from({ length: neutral.targetCount }, (_, target) =>
        new BufferAttribute(expand(deformer.target(index, target), 3, ofVertex), 3));
    }
    const mesh = new SkinnedMesh(geometry, material);
    mesh.bind(this.#skeleton, new Matrix4());
    mesh.bindMode = "detached"; // the matrices are in the space of the rig, as the vertices are
    mesh.bindMatrixInverse.identity();
    mesh.frustumCulled = false;
    return mesh;
  }

  /** Evaluates the controls of `face` and poses the visible meshes. */
  update() {
    this.face.evaluate(this.#lod);
    this.pose();
  }

  /** Poses the visible meshes by the last evaluation of `face`. */
  pose() {
    this.deformed.update(this.face);
    if (this.#skeleton) {
      this.#skeleton.boneMatrices.set(this.deformed.skinMatrices);
      this.#skeleton.update();
    }
    const weights = this.face.blendShapes;
    for (const mesh of this.#loaded.values()) {
      if (!mesh.visible) continue;
      const { index, vertexCount, channels } = mesh.userData;
      if (this.#skeleton) {
        channels.forEach((channel, target) => { mesh.morphTargetInfluences[target] = weights[channel]; });
        continue;
      }
      const { position, normal } = mesh.geometry.attributes;
      const wanted = this.normals === Normals.NONE ? null : normal.array;
      this.deformed.writeVertices(index, position.array, wanted, this.normals);
      position.needsUpdate = true;
      normal.needsUpdate = true;
    }
  }

  /** Chooses the LOD by the distance of a camera: the next one with each doubling beyond `near` meters. */
  lodOf(camera, near = 0.8) {
    const distance = camera.getWorldPosition(new Vector3()).distanceTo(this.getWorldPosition(new Vector3()).add(this.center));
    return Math.max(0, Math.min(this.lodCount - 1, Math.floor(Math.log2(Math.max(distance / near, 1)))));
  }

  /** Center of the neutral head, in the space of the parent. */
  get center() {
    const meshes = [...this.#loaded.values()];
    const mesh = meshes.find(({ userData }) => userData.kind === "skin") ?? meshes[0];
    if (!mesh) return new Vector3();
    return mesh.geometry.boundingSphere.center.clone().applyMatrix4(this.matrix);
  }

  /** Releases the memory of the GPU and of the module; the rig stays. */
  dispose() {
    for (const mesh of this.#loaded.values()) {
      mesh.geometry.dispose();
      mesh.material.dispose();
    }
    this.#loaded.clear();
    this.#skeleton?.dispose();
    this.deformed.dispose();
    if (this.#isOwner) this.face.dispose();
    this.clear();
  }
}

/** Drives a GLB file that `mien export --skeleton` wrote, or another one with these names, in the units of glTF: open
 * the rig with { system: "gltf" }. */
export class GltfFace {
  #bones = [];
  #targets = [];

  constructor(object, rig) {
    if (!rig.deformer) throw new TypeError("the rig has no joints: it was opened without meshes");
    this.rig = rig;
    this.face = rig.instance();
    this.deformed = rig.deformer.instance({ lods: 1 });
    // three.js leaves out of names what its animations cannot hold.
    const plain = (name) => name.replace(/\s/g, "_").replace(/[[\].:/]/g, "");
    const joints = new Map(rig.names(Kind.JOINT).map((name, i) => [plain(name), i]));
    const channels = new Map(rig.names(Kind.BLEND_SHAPE_CHANNEL).map((name, i) => [name, i]));
    object.traverse((node) => {
      const joint = joints.get(node.name);
      if (joint !== undefined && !node.isMesh) this.#bones.push([node, joint]);
      for (const [name, target] of Object.entries(node.morphTargetDictionary ?? {})) {
        const channel = channels.get(name);
        if (channel !== undefined) this.#targets.push([node, target, channel]);
      }
    });
    if (this.#bones.length === 0) throw new TypeError("no node has the name of a joint of the rig");
  }

  /** Number of joints and targets that were found. */
  get found() {
    return { joints: this.#bones.length, targets: this.#targets.length };
  }

  /** Evaluates the controls of `face` and poses nodes and morph targets. */
  update(lod = 0) {
    this.face.evaluate(lod);
    this.deformed.update(this.face);
    const transforms = this.deformed.localTransforms;
    for (const [node, joint] of this.#bones) {
      node.position.fromArray(transforms, 10 * joint);
      node.quaternion.fromArray(transforms, 10 * joint + 3);
      node.scale.fromArray(transforms, 10 * joint + 7);
    }
    const weights = this.face.blendShapes;
    for (const [mesh, target, channel] of this.#targets) mesh.morphTargetInfluences[target] = weights[channel];
  }

  dispose() {
    this.face.dispose();
    this.deformed.dispose();
  }
}
