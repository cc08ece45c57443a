// SPDX-License-Identifier: MIT
// What can be opened: a rig, whose controls Mien evaluates, or a GLB, whose morph targets are its controls.
import { Isa, Kind } from "mien";
import { FaceObject, defaultMaterial } from "mien/three";
import { ArkitControls } from "./arkit.js";
import { asEye } from "./cornea.js";
import { refine } from "./materials.js";
import { asSkin } from "./skin.js";
import { StandIn } from "./stand_in.js";

/** A rig of a DNA file or a baked file. */
export class RigModel {
  static async open(mien, bytes, { isa = Isa.SSE2, skinning = "mien", showFilms = false, materials } = {}) {
    const rig = await mien.openRig(bytes, { isa });
    try {
      if (!rig.deformer) throw new Error("this rig has no meshes to show: it was written or baked without geometry");
      return new RigModel(mien, rig, { skinning, showFilms, materials });
    } catch (error) {
      rig.dispose();
      throw error;
    }
  }

  constructor(mien, rig, options) {
    this.rig = this.lifeRig = rig; // the latter is what idle life is mixed on
    const { materials, ...shown } = options;
    this.materials = materials;
    const material = (kind, name) => {
      const made = materials?.of(name) ?? defaultMaterial(kind);
      return kind === "skin" ? asSkin(made) : made;
    };
    this.object = new FaceObject(rig, { ...shown, material });
    this.face = this.object.face; // with the pose of the controls
    this.times = { evaluation: 0, deformation: 0 };
    this.kinds = [["raw", "Raw controls"]];
    this.hasGui = rig.count(Kind.GUI_CONTROL) !== 0;
    if (this.hasGui) this.kinds.push(["gui", "GUI controls"]);
    this.arkit = ArkitControls.of(mien, rig);
    if (this.arkit) this.kinds.push(["arkit", "ARKit expressions"]);
  }

  names(kind) {
    if (kind === "arkit") return this.arkit.names;
    return this.rig.names(kind === "gui" ? Kind.GUI_CONTROL : Kind.RAW_CONTROL);
  }

  range(kind) {
    return kind === "gui" ? [-1, 1] : [0, 1];
  }

  values(kind) {
    if (kind === "arkit") return this.arkit.values;
    return kind === "gui" ? this.face.guiControls : this.face.rawControls;
  }

  set(kind, index, value) {
    if (kind === "arkit") this.arkit.set(index, value, this.face);
    else this.values(kind)[index] = value;
    if (kind === "gui") this.face.mapGuiToRaw();
    else if (this.hasGui) this.face.mapRawToGui();
  }

  /** Raw controls by their names or by names that mean them on this rig; those that mean nothing are returned. */
  setPose(pose) {
    const missing = [];
    const raw = this.face.rawControls;
    raw.set(this.rig.initialRawControls);
    for (const [name, value] of Object.entries(pose)) {
      const match = this.rig.match(name);
      if (!match) missing.push(name);
      const alone = match?.shares.length === 1;
      for (const { control, weight } of match?.shares ?? []) {
        raw[control] = alone ? weight * value : Math.min(1, raw[control] + weight * value);
      }
    }
    if (this.hasGui) this.face.mapRawToGui();
    this.arkit?.reset();
    return missing;
  }

  /** Values of raw controls by their numbers, of names that mean them on this rig. Of several names for a control the
   * largest value counts. */
  controlsOf(pose) {
    const found = new Map();
    for (const [name, value] of Object.entries(pose)) {
      for (const { control, weight } of this.rig.match(name)?.shares ?? []) {
        found.set(control, Math.max(found.get(control) ?? -Infinity, weight * value));
      }
    }
    return found;
  }

  /** Sets some controls, by names that mean them on this rig, and leaves the others. */
  drive(pose) {
    for (const [control, value] of this.controlsOf(pose)) this.face.rawControls[control] = value;
    if (this.hasGui) this.face.mapRawToGui();
  }

  /** Whether a name means something on this rig. */
  has(name) {
    return this.rig.match(name) !== undefined;
  }

  pose() {
    const initial = this.rig.initialRawControls;
    const raw = this.face.rawControls;
    return Object.fromEntries(this.names("raw").map((name, i) => [name, raw[i]]).filter((_, i) => raw[i] !== initial[i]));
  }

  /** Shows the pose of the controls, or that of another instance of the rig. */
  update(shown = this.face) {
    if (shown !== this.face) this.face.evaluate(this.object.lod); // whose results are asked for, too
    const start = performance.now();
    shown.evaluate(this.object.lod);
    const evaluated = performance.now();
    this.object.face = shown;
    this.object.pose();
    const posed = performance.now();
    // Means over some frames: clocks of browsers are coarse.
    const mix = (old, value) => (old ? old * 0.9 + value * 0.1 : value);
    this.times.evaluation = mix(this.times.evaluation, evaluated - start);
    this.times.deformation = mix(this.times.deformation, posed - evaluated);
  }

  /** What a raw control moves at 1: [kind, name, text] each, the farthest first. */
  inspect(index) {
    const { rig } = this;
    const probe = rig.instance();
    try {
      probe.rawControls[index] = probe.rawControls[index] === 1 ? 0 : 1;
      probe.evaluate(0);
      const width = rig.info.jointValueCount / rig.count(Kind.JOINT);
      const radians = rig.info.rotationUnit === 1;
      const joints = rig.names(Kind.JOINT).map((name, j) => {
        const at = j * width;
        const v = probe.joints;
        const moved = Math.hypot(v[at], v[at + 1], v[at + 2]) * (rig.info.translationUnit === 0 ? 10 : 1000);
        const turned = Math.hypot(v[at + 3], v[at + 4], v[at + 5]) * (radians ? 180 / Math.PI : 1);
        return { name, moved, turned };
      }).filter(({ moved, turned }) => moved > 0.005 || turned > 0.005)
        .sort((a, b) => b.moved + b.turned - a.moved - a.turned)
        .map(({ name, moved, turned }) => ["joint", name, `${moved.toFixed(2)} mm, ${turned.toFixed(1)}°`]);
      const weights = (kind, label, values) => rig.names(kind).map((name, i) => [label, name, values[i]])
        .filter(([, , value]) => Math.abs(value) > 1e-4).sort((a, b) => Math.abs(b[2]) - Math.abs(a[2]))
        .map(([what, name, value]) => [what, name, value.toFixed(2)]);
      return [
        ...weights(Kind.BLEND_SHAPE_CHANNEL, "shape", probe.blendShapes),
        ...weights(Kind.ANIMATED_MAP, "map", probe.animatedMaps),
        ...joints,
      ];
    } finally {
      probe.dispose();
    }
  }

  get facts() {
    const { rig } = this;
    const count = (kind, word) => `${rig.count(kind)} ${word}`;
    const vertices = this.object.children.filter((mesh) => mesh.visible).reduce((sum, mesh) => sum + mesh.userData.vertexCount, 0);
    return [count(Kind.RAW_CONTROL, "raw controls"), count(Kind.PSD_CONTROL, "correctives"), count(Kind.JOINT, "joints"),
      count(Kind.BLEND_SHAPE_CHANNEL, "shapes"), `${rig.info.lodCount} LODs`, `${vertices.toLocaleString("en")} vertices shown`].join(", ");
  }

  dispose() {
    this.arkit?.dispose();
    this.object.face = this.face;
    this.object.dispose();
    this.rig.dispose();
  }
}

/** A GLB file: its morph targets by name. */
export class GlbModel {
  static async open(mien, bytes) {
    const { GLTFLoader } = await import("three/addons/loaders/GLTFLoader.js");
    const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
    return new GlbModel(mien, await new GLTFLoader().parseAsync(buffer, ""));
  }

  constructor(mien, { scene, animations }) {
    this.animations = animations;
    this.mien = mien;
    this.object = scene;
    this.times = null;
    this.targets = new Map();
    scene.traverse((mesh) => {
      mesh.frustumCulled = false;
      if (mesh.isMesh) refine(mesh.material);
      if (mesh.material?.name === "skin") asSkin(mesh.material);
      if (mesh.material?.userData.cornea) asEye(mesh.material, mesh.material.userData.cornea);
      for (const [name, target] of Object.entries(mesh.morphTargetDictionary ?? {})) {
        if (!this.targets.has(name)) this.targets.set(name, []);
        this.targets.get(name).push([mesh, target]);
      }
    });
    this.list = [...this.targets.keys()];
    // By their usual names, so that mouthSmile_L is mouthSmileLeft here too.
    this.usual = new Map(this.list.map((name, i) => [mien.controlName(name), i]));
    // As the file has them.
    this.current = Float32Array.from(this.list, (name) => {
      const [mesh, target] = this.targets.get(name)[0];
      return mesh.morphTargetInfluences[target];
    });
    this.kinds = [["raw", "Morph targets"]];
    scene.updateMatrixWorld(true);
    this.standIn = StandIn.of(mien, (name) => this.targets.get(this.list[this.#indexOf(name)]) ?? []);
    this.lifeRig = this.standIn?.rig ?? null;
    this.lifeTargets = this.standIn?.names.map((name) => this.#indexOf(name)) ?? []; // of each of its controls, or -1
  }

  /** The stand-in for idle life, in the pose of the targets. */
  get face() {
    const { face } = this.standIn;
    this.lifeTargets.forEach((index, control) => { if (index >= 0) face.rawControls[control] = this.current[index]; });
    return face;
  }

  names() {
    return this.list;
  }

  range() {
    return [0, 1];
  }

  values() {
    return this.current;
  }

  set(kind, index, value) {
    this.current[index] = value;
  }

  #indexOf(name) {
    const index = this.list.indexOf(name.slice(name.lastIndexOf(".") + 1));
    const usual = index < 0 ? this.mien.controlName(name) : undefined;
    return usual === undefined ? index : this.usual.get(usual) ?? -1;
  }

  has(name) {
    return this.#indexOf(name) >= 0;
  }

  setPose(pose) {
    this.current.fill(0);
    return Object.entries(pose).filter(([name, value]) => {
      const index = this.#indexOf(name);
      if (index >= 0) this.current[index] = value;
      return index < 0;
    }).map(([name]) => name);
  }

  /** Sets some targets, and leaves the others. */
  drive(pose) {
    for (const [name, value] of Object.entries(pose)) {
      const index = this.#indexOf(name);
      if (index >= 0) this.current[index] = value;
    }
  }

  pose() {
    return Object.fromEntries(this.list.map((name, i) => [name, this.current[i]]).filter(([, value]) => value !== 0));
  }

  /** Takes over the weights that the targets have now. */
  readTargets() {
    this.list.forEach((name, i) => {
      const [mesh, target] = this.targets.get(name)[0];
      this.current[i] = mesh.morphTargetInfluences[target];
    });
  }

  /** Shows the weights of the targets, or where idle life moves some, those of an instance of the stand-in. */
  update(shown = null) {
    const weights = this.current.slice();
    if (shown) this.lifeTargets.forEach((index, control) => { if (index >= 0) weights[index] = shown.rawControls[control]; });
    this.list.forEach((name, i) => {
      for (const [mesh, target] of this.targets.get(name)) mesh.morphTargetInfluences[target] = weights[i];
    });
  }

  get facts() {
    let vertices = 0;
    this.object.traverse((mesh) => { vertices += mesh.isMesh ? mesh.geometry.attributes.position.count : 0; });
    return `${this.list.length} morph targets, ${vertices.toLocaleString("en")} vertices`;
  }

  dispose() {
    this.standIn?.dispose();
    this.object.traverse((mesh) => {
      mesh.geometry?.dispose();
      mesh.material?.dispose?.();
    });
  }
}
