// SPDX-License-Identifier: MIT
// What is seen: camera, lights, the face, what it is compared with, and its skeleton. Drawn when something has changed.
import {
  ACESFilmicToneMapping, BufferAttribute, BufferGeometry, Euler, Group, LineBasicMaterial, LineSegments, MathUtils,
  Matrix4, PerspectiveCamera, Scene, Spherical, SRGBColorSpace, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Lights } from "./lights.js";
import { regionsOf } from "./regions.js";
import { castShadows } from "./shadows.js";

export class Stage {
  #how = "now";

  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, alpha: true, antialias: true });
    this.renderer.outputColorSpace = SRGBColorSpace;
    this.renderer.toneMapping = ACESFilmicToneMapping;
    castShadows(this.renderer);
    this.scene = new Scene();
    this.pivot = new Group(); // turns the object as a head turns
    this.pivot.matrixAutoUpdate = false;
    this.scene.add(this.pivot);
    this.camera = new PerspectiveCamera(26, 1, 0.005, 50);
    this.camera.position.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.request());
    this.drawn = 0;
    this.neck = new Vector3();
    this.base = new Matrix4(); // where the object stands
    this.regions = {};
    this.beforeDraw = () => false; // returns true to be called again in the next frame
    this.lights = new Lights(this.scene);
    new ResizeObserver(() => this.#resize()).observe(canvas.parentElement);
    this.#resize();
    canvas.addEventListener("keydown", (event) => this.#key(event));
  }

  #resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    if (!clientWidth || !clientHeight) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.request();
  }

  #key(event) {
    const turn = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    const zoom = { "+": 0.9, "=": 0.9, "-": 1 / 0.9 }[event.key];
    if (!turn && !zoom) return;
    event.preventDefault();
    const offset = this.camera.position.clone().sub(this.controls.target);
    const place = new Spherical().setFromVector3(offset);
    place.theta += (turn?.[0] ?? 0) * 0.12;
    place.phi = MathUtils.clamp(place.phi + (turn?.[1] ?? 0) * 0.12, 0.1, Math.PI - 0.1);
    place.radius *= zoom ?? 1;
    this.camera.position.copy(this.controls.target).add(offset.setFromSpherical(place));
    this.controls.update();
    this.request();
  }

  /** Puts an object in view, seen from the front. */
  show(object) {
    if (this.object) this.pivot.remove(this.object);
    this.object = object;
    this.hideSkeleton();
    this.moveHead(null);
    if (!object) return;
    object.updateMatrixWorld(true);
    const found = regionsOf(object);
    this.pivot.add(object);
    this.regions = found?.regions ?? {};
    if (!found) return;
    this.isBody = found.isBody;
    this.neck.copy(found.neck);
    this.#shade();
    this.lookAt("Head");
  }

  /** Puts the camera before a part of the object that is shown, one of `regions`, with room for so many beside each other. */
  lookAt(name, count = 1) {
    const { center, width, height, depth, yaw, pitch = 0 } = this.regions[name];
    const half = Math.tan(MathUtils.degToRad(this.camera.fov / 2));
    const distance = Math.max(height, count * width / (count > 1 ? this.camera.aspect : Math.min(1, this.camera.aspect))) * 0.5 / half;
    this.controls.target.copy(center);
    const place = new Spherical(distance * 1.15 + depth * 0.4, MathUtils.degToRad(90 - pitch), MathUtils.degToRad(yaw));
    this.camera.position.setFromSpherical(place).add(center);
    this.camera.near = distance / 100;
    this.camera.far = 20 * Math.max(distance, 1);
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.request();
  }

  /** Shows another object, before the object or beside it; null: none. `how` is "side", "before" or "now". */
  compare(other, how) {
    if (this.other) this.scene.remove(this.other);
    const wasSide = this.other && this.#how === "side";
    this.other = other;
    this.#how = how;
    this.pivot.visible = how !== "before";
    const apart = how === "side" ? 0.55 * (this.regions.Head?.width ?? 0) : 0;
    this.base.makeTranslation(apart, 0, 0);
    if (other && how !== "now") {
      other.position.x = -apart;
      this.scene.add(other);
    }
    this.#shade();
    if (this.regions.Head && (how === "side" || wasSide)) this.lookAt("Head", how === "side" ? 2 : 1);
    this.request();
  }

  /** Aims the shadows at the head, or at two. */
  #shade() {
    if (!this.regions.Head) return;
    const { center, width, height, depth } = this.regions.Head;
    this.lights.shade(center, 0.5 * Math.hypot(width + 2 * Math.abs(this.base.elements[12]), height, depth));
  }

  /** Turns the head about its neck: radians to the left and up, and a rise in millimeters; null: back to its place. A
   * body stays where it is. */
  moveHead(motion) {
    const { matrix } = this.pivot;
    matrix.identity();
    this.pivot.matrixWorldNeedsUpdate = true;
    if (motion && !this.isBody) {
      matrix.makeRotationFromEuler(new Euler(-motion.up, motion.left, 0, "YXZ"));
      const moved = this.neck.clone().applyMatrix4(matrix);
      matrix.setPosition(this.neck.clone().sub(moved).add(new Vector3(0, motion.rise / 1000, 0)));
    }
    matrix.premultiply(this.base);
  }

  /** Lines from each joint to its parent; `matrices` are model matrices of 16 floats. */
  showSkeleton(parents, matrices, matrix) {
    if (!this.bones) {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(new Float32Array(6 * parents.length), 3));
      this.bones = new LineSegments(geometry, new LineBasicMaterial({ color: 0x1d70d6, depthTest: false, transparent: true, opacity: 0.8 }));
      this.bones.matrixAutoUpdate = false;
      this.bones.matrix.copy(matrix);
      this.bones.frustumCulled = false;
      this.bones.renderOrder = 1;
      this.pivot.add(this.bones);
    }
    const { position } = this.bones.geometry.attributes;
    parents.forEach((parent, joint) => {
      for (let k = 0; k < 3; ++k) {
        position.array[6 * joint + k] = matrices[16 * joint + 12 + k];
        position.array[6 * joint + 3 + k] = matrices[16 * parent + 12 + k];
      }
    });
    position.needsUpdate = true;
  }

  hideSkeleton() {
    if (!this.bones) return;
    this.pivot.remove(this.bones);
    this.bones.geometry.dispose();
    this.bones.material.dispose();
    this.bones = null;
  }

  request() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame((time) => {
      this.waiting = false;
      const again = this.beforeDraw(time);
      for (const shown of [this.object, this.other]) { // each time, as LODs are made when they are shown
        shown?.traverse((node) => {
          if (node.isMesh) node.castShadow = node.receiveShadow = !node.material.transparent;
        });
      }
      this.renderer.render(this.scene, this.camera);
      ++this.drawn;
      if (again) this.request();
    });
  }
}
