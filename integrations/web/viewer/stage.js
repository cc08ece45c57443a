// SPDX-License-Identifier: MIT
// What is seen: camera, lights, the face, its skeleton and heat map. Drawn when something has changed.
import {
  ACESFilmicToneMapping, AmbientLight, Box3, BufferAttribute, BufferGeometry, DirectionalLight, HemisphereLight,
  LineBasicMaterial, LineSegments, MathUtils, PerspectiveCamera, Scene, Spherical, SRGBColorSpace, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, alpha: true, antialias: true });
    this.renderer.outputColorSpace = SRGBColorSpace;
    this.renderer.toneMapping = ACESFilmicToneMapping;
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(26, 1, 0.005, 50);
    this.camera.position.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.request());
    this.drawn = 0;
    this.beforeDraw = () => false; // returns true to be called again in the next frame
    this.#light();
    new ResizeObserver(() => this.#resize()).observe(canvas.parentElement);
    this.#resize();
    canvas.addEventListener("keydown", (event) => this.#key(event));
  }

  #light() {
    const lamp = (color, strength, x, y, z) => {
      const light = new DirectionalLight(color, strength);
      light.position.set(x, y, z);
      this.scene.add(light);
    };
    lamp(0xfff0e0, 2.6, -0.5, 0.6, 0.8);
    lamp(0xbfd0e8, 0.6, 0.9, 0.1, 0.6);
    lamp(0xdfeaff, 1.8, 0.8, 0.4, -0.7);
    lamp(0xe8ecf4, 0.8, -0.8, 0.3, -0.8);
    this.scene.add(new HemisphereLight(0xd8e0ea, 0x8c7466, 0.9), new AmbientLight(0xffffff, 0.15));
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
    if (this.object) this.scene.remove(this.object);
    this.object = object;
    this.hideSkeleton();
    if (!object) return;
    this.scene.add(object);
    object.updateMatrixWorld(true);
    const box = new Box3();
    object.traverse((node) => {
      if (!node.isMesh || !node.visible) return;
      node.geometry.computeBoundingBox();
      box.union(node.geometry.boundingBox.clone().applyMatrix4(node.matrixWorld));
    });
    if (box.isEmpty()) return;
    const size = box.getSize(new Vector3());
    const center = box.getCenter(new Vector3());
    // Of a body the upper part, where the face is.
    if (size.y > 1) {
      center.y = box.max.y - 0.14;
      size.y = 0.34;
      size.x = Math.min(size.x, 0.34);
    }
    const distance = Math.max(size.y, size.x / Math.min(1, this.camera.aspect)) * 0.5 / Math.tan(MathUtils.degToRad(13));
    this.controls.target.copy(center);
    this.camera.position.copy(center).add(new Vector3(0.12, 0.04, 1).normalize().multiplyScalar(distance * 1.15 + size.z * 0.4));
    this.camera.near = distance / 100;
    this.camera.far = distance * 20;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.request();
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
      this.scene.add(this.bones);
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
    this.scene.remove(this.bones);
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
      this.renderer.render(this.scene, this.camera);
      ++this.drawn;
      if (again) this.request();
    });
  }
}

/** Colors the vertices of meshes by their distance from the neutral pose: still ones gray, the farthest red. */
export class HeatMap {
  #meshes = new Map();

  apply(face) {
    let most = 0;
    const distances = new Map();
    face.traverse((mesh) => {
      if (!mesh.isMesh || !mesh.visible) return;
      if (!this.#meshes.has(mesh)) this.#begin(mesh, face);
      const { neutral } = this.#meshes.get(mesh);
      const { array } = mesh.geometry.attributes.position;
      const found = new Float32Array(array.length / 3);
      for (let i = 0; i < found.length; ++i) {
        const at = 3 * i;
        found[i] = Math.hypot(array[at] - neutral[at], array[at + 1] - neutral[at + 1], array[at + 2] - neutral[at + 2]);
        if (found[i] > most) most = found[i];
      }
      distances.set(mesh, found);
    });
    const scale = most > 0 ? 1 / most : 0;
    for (const [mesh, found] of distances) {
      const color = mesh.geometry.attributes.color;
      found.forEach((distance, i) => {
        const t = distance * scale;
        color.setXYZ(i, 0.35 + 0.5 * t, 0.35 * (1 - t) + 0.35 * t * (1 - t), 0.37 * (1 - t) ** 2);
      });
      color.needsUpdate = true;
    }
    return most;
  }

  #begin(mesh, face) {
    const { material, geometry } = mesh;
    const state = {
      color: geometry.attributes.color, base: material.color.getHex(), vertexColors: material.vertexColors,
      neutral: neutralOf(mesh, face),
    };
    geometry.setAttribute("color", new BufferAttribute(new Float32Array(geometry.attributes.position.array.length), 3));
    material.color.set(0xffffff);
    material.vertexColors = true;
    material.needsUpdate = true;
    this.#meshes.set(mesh, state);
  }

  end() {
    for (const [mesh, state] of this.#meshes) {
      if (state.color) mesh.geometry.setAttribute("color", state.color);
      else mesh.geometry.deleteAttribute("color");
      mesh.material.color.set(state.base);
      mesh.material.vertexColors = state.vertexColors;
      mesh.material.needsUpdate = true;
    }
    this.#meshes.clear();
  }
}

function neutralOf(mesh, face) {
  const { positions, vertexPositionIndices } = face.rig.deformer.mesh(mesh.userData.index);
  const neutral = new Float32Array(3 * vertexPositionIndices.length);
  vertexPositionIndices.forEach((position, i) => {
    for (let k = 0; k < 3; ++k) neutral[3 * i + k] = positions[3 * position + k];
  });
  return neutral;
}
