// SPDX-License-Identifier: MIT
// What the page gives away as files: the shown head as GLB, and poses recorded over time.
import { Kind, Normals } from "mien";
import { BufferAttribute, BufferGeometry, Group, Mesh, MeshStandardMaterial } from "three";

const RATE = 60;
/** Ten minutes. */
const MOST_FRAMES = 600 * RATE;

/** Takes the pose of a model at 60 frames a second of the clock. */
class Recording {
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

/** Gives the user a file. */
export function download(name, content, type = "application/json") {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([content], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** The button that records, and downloads the recording when it is pressed again. */
export class Recorder {
  #button;
  #recording = null;

  constructor(button, requested) {
    this.#button = button;
    button.addEventListener("click", () => {
      if (this.isOn) this.#end();
      else this.#set(new Recording());
      requested();
    });
  }

  get isOn() { return this.#recording !== null; }

  /** Takes the pose of a frame, if it is on. */
  take(time, model) {
    if (this.isOn && !this.#recording.take(time, model.pose())) this.#end();
  }

  drop() { this.#set(null); }

  #set(recording) {
    this.#recording = recording;
    this.#button.textContent = recording ? "Stop and download" : "Record";
    this.#button.setAttribute("aria-pressed", String(recording !== null));
  }

  #end() {
    const { frames } = this.#recording;
    const text = this.#recording.json();
    this.drop();
    if (frames.length) download("take.json", text);
  }
}

/** A GLB with more targets would be larger than what it is for. */
const MOST_TARGETS = 100;

/** What can be a morph target: names, values now, and how each is set alone at 1. */
function expressionsOf({ arkit, face, rig }) {
  if (arkit) {
    return { names: arkit.names, values: arkit.values, set: (index, probe) => arkit.binding.apply(arkit.rowOf(index), probe) };
  }
  const names = rig.names(Kind.RAW_CONTROL);
  if (names.length > MOST_TARGETS) return { names: [], values: [] };
  return { names, values: face.rawControls, set: (index, probe) => { probe.rawControls[index] = 1; } };
}

/** Positions of the vertices of some meshes: at rest and for each expression alone; normals at rest. If there are no
 * expressions, in the pose that is shown. */
function sample(model, meshes, { names, set }) {
  const { rig, object } = model;
  const probe = names.length ? rig.instance() : model.face;
  const pose = rig.deformer.instance({ lods: 1 << object.lod });
  const write = (normals) => {
    probe.evaluate(object.lod);
    pose.update(probe);
    return meshes.map(({ userData: { index, vertexCount } }, i) => {
      const positions = new Float32Array(3 * vertexCount);
      pose.writeVertices(index, positions, normals?.[i], normals ? undefined : Normals.NONE);
      return positions;
    });
  };
  try {
    const normals = meshes.map(({ userData }) => new Float32Array(3 * userData.vertexCount));
    const rest = write(normals);
    const targets = names.map((_, i) => {
      probe.reset();
      set(i, probe);
      return write();
    });
    return { rest, normals, targets };
  } finally {
    pose.dispose();
    if (probe !== model.face) probe.dispose();
  }
}

const moves = (positions, rest, least) => positions.some((value, i) => Math.abs(value - rest[i]) > least);

/** The bytes of a GLB with the meshes of the shown LOD, in meters, with a morph target for each expression, and the
 * expressions that are set now. Each alone is exact; several add up, without correctives. No skeleton. */
export async function exportGlb(model) {
  const { GLTFExporter } = await import("three/addons/exporters/GLTFExporter.js");
  const shown = model.object.children.filter((mesh) => mesh.isMesh && mesh.visible);
  const expressions = expressionsOf(model);
  const { rest, normals, targets } = sample(model, shown, expressions);
  const least = 1e-5 / model.object.matrix.getMaxScaleOnAxis(); // a hundredth of a millimeter
  const group = new Group();
  shown.forEach((mesh, m) => {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(rest[m], 3));
    geometry.setAttribute("normal", new BufferAttribute(normals[m], 3));
    if (mesh.geometry.attributes.color && mesh.material.vertexColors) {
      geometry.setAttribute("color", mesh.geometry.attributes.color);
    }
    geometry.setIndex(mesh.geometry.index);
    const moving = targets.map((_, i) => i).filter((i) => moves(targets[i][m], rest[m], least));
    geometry.applyMatrix4(model.object.matrix);
    geometry.morphTargetsRelative = true;
    // applyMatrix4() has moved the positions at rest already.
    geometry.morphAttributes.position = moving.map((i) => {
      const moved = new BufferAttribute(targets[i][m], 3).applyMatrix4(model.object.matrix).array;
      return new BufferAttribute(moved.map((value, k) => value - rest[m][k]), 3);
    });
    const { color, roughness = 0.6, metalness = 0, vertexColors, transparent, opacity, side } = mesh.material;
    const material = new MeshStandardMaterial({ color, roughness, metalness, vertexColors, transparent, opacity, side });
    if (mesh.material.alphaTest > 0) { // without its texture a card of hair would be a sheet
      geometry.setAttribute("uv", mesh.geometry.attributes.uv);
      material.setValues({ map: mesh.material.map, alphaTest: mesh.material.alphaTest });
    }
    const made = new Mesh(geometry, material);
    made.name = mesh.name;
    if (moving.length) {
      const short = (name) => name.slice(name.lastIndexOf(".") + 1);
      made.morphTargetDictionary = Object.fromEntries(moving.map((i, k) => [short(expressions.names[i]), k]));
      made.morphTargetInfluences = moving.map((i) => expressions.values[i]);
    }
    group.add(made);
  });
  return new Uint8Array(await new GLTFExporter().parseAsync(group, { binary: true }));
}
