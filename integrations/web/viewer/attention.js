// SPDX-License-Identifier: MIT
// Idle life and looking at the cursor: the check boxes, where the cursor is, and the motion of the head.
import { Plane, Raycaster, Vector2, Vector3 } from "three";
import { BLINKS, Idle, LOOKS } from "./idle.js";

const $ = (id) => document.getElementById(id);

export class Attention {
  #stage;
  #idle = null;
  #model = null;
  #cursor = null; // in the coordinates of the camera
  #last = 0;
  #ray = new Raycaster();
  motion = null; // of the head

  constructor(stage) {
    this.#stage = stage;
    const reduced = matchMedia("(prefers-reduced-motion: reduce)");
    const choose = () => { $("idle").checked = $("follow").checked = !reduced.matches; };
    choose();
    reduced.addEventListener("change", () => {
      choose();
      stage.request();
    });
    for (const id of ["idle", "follow"]) $(id).addEventListener("change", () => stage.request());
    stage.canvas.addEventListener("pointermove", (event) => {
      const { left, top, width, height } = stage.canvas.getBoundingClientRect();
      this.#cursor = new Vector2(2 * (event.clientX - left) / width - 1, 1 - 2 * (event.clientY - top) / height);
    });
    stage.canvas.addEventListener("pointerleave", () => { this.#cursor = null; });
  }

  /** For tests: the idle life of the shown rig, if there is one. */
  get idle() { return this.#idle; }

  /** Another model is shown; the rig of the last one is about to be disposed. */
  show(model) {
    this.#idle?.dispose();
    this.#idle = null;
    this.#model = model;
    const missing = model.rig ? [] : model.standIn?.missing ?? [...BLINKS, ...LOOKS];
    $("idle").disabled = !model.lifeRig;
    $("follow").disabled = !model.lifeRig || LOOKS.every((name) => missing.includes(name));
    $("life-note").hidden = missing.length === 0;
    $("life-note").textContent = !missing.length ? "" : model.lifeRig ? `This GLB has no morph targets ${missing.join(", ")}: it moves without them.`
      : `This GLB has no morph targets by the names of ARKit, such as ${BLINKS[0]} and ${LOOKS[0]}: it has no idle life.`;
    this.motion = null;
  }

  /** Before a frame: the instance that shows the model alive at a time in milliseconds, or null if nothing moves by
   * itself. */
  step(time, isStill) {
    const seconds = this.#last ? Math.min(0.1, (time - this.#last) / 1000) : 0;
    this.#last = time;
    const [isAlive, looks] = ["idle", "follow"].map((id) => $(id).checked && !$(id).disabled);
    if (isStill || !(isAlive || looks)) {
      this.#last = 0;
      this.motion = null;
      return null;
    }
    const { face, lifeRig } = this.#model;
    this.#idle ??= new Idle(lifeRig, face);
    this.#idle.lookAt(looks ? this.#target() : null);
    this.#idle.step(seconds, face, { isAlive, looks });
    this.motion = this.#idle.motion;
    return this.#idle.face;
  }

  /** Where the cursor is: halfway from the face to the camera. Null where no eye can look. */
  #target() {
    if (!this.#cursor) return null;
    const { camera, controls, pivot } = this.#stage;
    const normal = camera.getWorldDirection(new Vector3());
    const middle = camera.position.clone().add(controls.target).multiplyScalar(0.5);
    this.#ray.setFromCamera(this.#cursor, camera);
    const found = this.#ray.ray.intersectPlane(new Plane().setFromNormalAndCoplanarPoint(normal, middle), new Vector3());
    if (!found) return null;
    pivot.worldToLocal(found);
    return found.z > controls.target.z ? found : null;
  }
}
