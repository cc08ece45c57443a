// SPDX-License-Identifier: MIT
// The edges of what is shown, over its surface. Where edges lie closer than some pixels they fade: lines of one pixel
// cannot show them, and give moire patterns instead.
import { BufferAttribute, Group, MeshBasicMaterial, Vector2, Vector3 } from "three";

/** The opacity of lines, and how many pixels apart they have it, and none. Between these it falls faster than their
 * distance, because ever more of them share a pixel. */
const [OPACITY, CLEAR, GONE, FALL] = [0.5, 8, 1, 1.5];

/** Cells along the longest side of a mesh, in which surfaces above each other are counted. */
const CELLS = 32;
/** The most area of one flat surface in a cell, in squares of its side. */
const ONE_SURFACE = Math.sqrt(3);

/** For each vertex the distance between the edges around it: the mean of the least heights of its triangles, less where
 * surfaces lie above each other, as cards of hair do. */
function spacingOf(geometry) {
  const { attributes: { position }, index } = geometry;
  const [sums, counts] = [new Float32Array(position.count), new Uint16Array(position.count)];
  const corners = [new Vector3(), new Vector3(), new Vector3()];
  geometry.computeBoundingBox();
  const { min, max } = geometry.boundingBox;
  const cell = Math.max(max.x - min.x, max.y - min.y, max.z - min.z, Number.MIN_VALUE) / CELLS;
  const areas = new Map();
  const cellOf = (place) => ["x", "y", "z"].reduce((sum, axis) =>
    sum * (CELLS + 1) + Math.floor((place[axis] - min[axis]) / cell), 0);
  const count = index ? index.count : position.count;
  for (let i = 0; i + 2 < count; i += 3) {
    const numbers = [0, 1, 2].map((k) => (index ? index.getX(i + k) : i + k));
    numbers.forEach((vertex, k) => corners[k].fromBufferAttribute(position, vertex));
    const [a, b, c] = corners;
    const longest = Math.max(a.distanceTo(b), b.distanceTo(c), c.distanceTo(a));
    const at = cellOf(a.clone().add(b).add(c).divideScalar(3));
    const area = b.sub(a).cross(c.sub(a)).length();
    areas.set(at, (areas.get(at) ?? 0) + area / 2);
    for (const vertex of numbers) {
      sums[vertex] += longest > 0 ? area / longest : 0;
      ++counts[vertex];
    }
  }
  return sums.map((sum, i) => {
    const area = areas.get(cellOf(corners[0].fromBufferAttribute(position, i))) ?? 0;
    return sum / Math.max(1, counts[i]) / Math.max(1, area / (ONE_SURFACE * cell * cell));
  });
}

/** Lines whose opacity follows from the distance of edges on the screen; `height` is that of the screen in pixels. */
function lineMaterial(height) {
  const material = new MeshBasicMaterial({ color: 0x0b1016, wireframe: true, transparent: true, depthWrite: false });
  material.onBeforeCompile = (shader) => {
    shader.uniforms.screenHeight = height;
    shader.vertexShader = shader.vertexShader
      .replace("void main() {", "attribute float spacing;\nuniform float screenHeight;\nvarying float seen;\nvoid main() {")
      .replace("#include <fog_vertex>", `#include <fog_vertex>
        float size = length(modelMatrix[0].xyz) * projectionMatrix[1][1] * 0.5 * screenHeight / gl_Position.w;
        vec3 facing = normalize(normalMatrix * normal);
        float pixels = spacing * size * abs(dot(facing, normalize(mvPosition.xyz)));
        float near = clamp((pixels - ${GONE.toFixed(1)}) / ${(CLEAR - GONE).toFixed(1)}, 0.0, 1.0);
        seen = ${OPACITY.toFixed(2)} * pow(near, ${FALL.toFixed(1)});
        gl_Position.z -= 3e-4 * gl_Position.w;`);
    shader.fragmentShader = shader.fragmentShader
      .replace("void main() {", "varying float seen;\nvoid main() {")
      .replace("#include <opaque_fragment>", `diffuseColor.a *= seen;\n#include <opaque_fragment>`);
  };
  return material;
}

export class Wireframe {
  object = new Group();
  #height = { value: 1 };
  #material = lineMaterial(this.#height);

  /** Shows the edges of the meshes of an object that are visible and opaque; null: of none. */
  show(object) {
    this.object.clear();
    object?.traverse((mesh) => {
      if (!mesh.isMesh || !mesh.visible || mesh.material.transparent || !mesh.geometry.attributes.normal) return;
      const { geometry } = mesh;
      if (!geometry.attributes.spacing) geometry.setAttribute("spacing", new BufferAttribute(spacingOf(geometry), 1));
      const lines = mesh.clone(false);
      lines.material = this.#material;
      lines.frustumCulled = false;
      lines.renderOrder = 1;
      lines.matrixWorldAutoUpdate = false;
      lines.morphTargetInfluences = mesh.morphTargetInfluences;
      if (mesh.isSkinnedMesh) lines.bindMatrixInverse = mesh.bindMatrixInverse;
      lines.onBeforeRender = (renderer) => {
        lines.matrixWorld.copy(mesh.matrixWorld);
        this.#height.value = renderer.getDrawingBufferSize(new Vector2()).y;
      };
      this.object.add(lines);
    });
  }
}
