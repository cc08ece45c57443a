// SPDX-License-Identifier: MIT
// Before and after: what was shown is kept as still meshes, and seen beside, instead of or as the difference from what
// is shown now. Two files, or two poses of one.
import { BufferAttribute, BufferGeometry, Group, Mesh, Vector3 } from "three";

const $ = (id) => document.getElementById(id);

/** Positions and normals of a mesh as they are shown, in meters. */
function shownVertices(mesh, model) {
  const { position, normal } = mesh.geometry.attributes;
  const positions = new Float32Array(3 * position.count);
  if (model.rig) {
    const normals = new Float32Array(positions.length);
    model.object.deformed.writeVertices(mesh.userData.index, positions, normals);
    const { matrix } = model.object;
    return [new BufferAttribute(positions, 3).applyMatrix4(matrix), new BufferAttribute(normals, 3).transformDirection(matrix)];
  }
  const point = new Vector3();
  for (let i = 0; i < position.count; ++i) mesh.getVertexPosition(i, point).toArray(positions, 3 * i);
  // Normals as they are at rest, because the GPU alone knows those that are shown.
  return [new BufferAttribute(positions, 3).applyMatrix4(mesh.matrixWorld), normal?.clone().transformDirection(mesh.matrixWorld)];
}

class Before {
  object = new Group();

  /** Keeps the meshes that a model shows. */
  constructor(name, model) {
    this.name = name;
    model.object.updateMatrixWorld(true);
    model.object.traverse((mesh) => {
      if (!mesh.isMesh || !mesh.visible) return;
      const geometry = new BufferGeometry();
      geometry.setIndex(mesh.geometry.index);
      for (const attribute of ["uv", "color"]) {
        if (mesh.geometry.attributes[attribute]) geometry.setAttribute(attribute, mesh.geometry.attributes[attribute].clone());
      }
      const [position, normal] = shownVertices(mesh, model);
      geometry.setAttribute("position", position);
      if (normal) geometry.setAttribute("normal", normal);
      const kept = new Mesh(geometry, mesh.material.clone());
      kept.name = mesh.name;
      this.object.add(kept);
    });
  }

  /** What each mesh of an object was before, if a mesh of its name had as many vertices. */
  reference(object) {
    const back = object.matrix.clone().invert();
    return (mesh) => {
      const kept = this.object.children.find(({ name }) => name === mesh.name)?.geometry.attributes.position;
      return kept?.count === mesh.geometry.attributes.position.count ? kept.clone().applyMatrix4(back).array : null;
    };
  }

  dispose() {
    for (const mesh of this.object.children) {
      mesh.geometry.dispose();
      mesh.material.dispose();
    }
  }
}

/** The button that keeps, and the list of ways to compare. */
export class Comparison {
  #stage;
  #before = null;

  /** `shown` gives name, model and materials of what is open, `changed` is called after another choice. */
  constructor(stage, { shown, changed }) {
    this.#stage = stage;
    Object.assign(this, { shown, changed });
    $("keep").addEventListener("click", () => this.keep());
    $("compare").addEventListener("change", () => this.choose($("compare").value));
  }

  get isDifference() { return this.#before !== null && $("compare").value === "difference"; }

  get name() { return this.#before?.name; }

  /** For HeatMap.apply(). */
  reference(object) { return this.#before.reference(object); }

  /** Whether materials must not be released yet. */
  uses(materials) { return materials !== undefined && this.#before?.materials === materials; }

  /** Keeps what is shown, to compare with. */
  keep() {
    const { name, model, materials } = this.shown();
    this.choose("now"); // in its own colors
    if (this.#before) {
      this.#stage.compare(null, "now");
      this.#before.dispose();
      if (this.#before.materials !== materials) this.#before.materials?.dispose();
    }
    this.#before = new Before(name, model);
    this.#before.materials = materials;
    $("compare").disabled = false;
    $("kept").textContent = `Kept: ${name}. Change the pose or open another file, and choose how both are shown.`;
    this.choose("side");
  }

  choose(how) {
    $("compare").value = how;
    this.#stage.compare(this.#before?.object ?? null, how === "difference" ? "now" : how);
    this.changed();
  }

  /** Another model is shown. */
  refresh() {
    if (this.#before) this.choose($("compare").value);
  }
}
