// SPDX-License-Identifier: MIT
// Idle life and looking at the cursor: the check boxes, where the cursor is, and the motion of the head.
import { Plane, Raycaster, Vector2, Vector3 } from "three";
import { Idle } from "./idle.js";

const $ = (id) => document.getElementById(id);

export class Attention {
  #stage;
  #idle = null;
  #rig = null;
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
    this.#rig = model.rig ?? null;
    for (const id of ["idle", "follow"]) {
      $(id).disabled = !this.#rig;
      $(id).parentElement.title = this.#rig ? "" : "A GLB has no controls to mix: open a DNA file or a baked rig";
    }
    this.motion = null;
  }

  /** Before a frame: the instance that shows `face` alive at a time in milliseconds, or null if nothing moves by itself. */
  step(time, face, isStill) {
    const seconds = this.#last ? Math.min(0.1, (time - this.#last) / 1000) : 0;
    this.#last = time;
    const [isAlive, looks] = [$("idle").checked, $("follow").checked];
    if (!this.#rig || isStill || !(isAlive || looks)) {
      this.#last = 0;
      this.motion = null;
      return null;
    }
    this.#idle ??= new Idle(this.#rig, face);
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
