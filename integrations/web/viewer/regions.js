// SPDX-License-Identifier: MIT
// Parts of a head that the camera can be put before, found by the names of meshes.
import { meshClass } from "mien/three";
import { Box3, Vector3 } from "three";

/** Of the vertices as they are shown: those of the file may be integers that only the joints scale to meters, and the
 * boxes of three.js have room for every morph target. */
function boxOf(object, isMeant) {
  const box = new Box3();
  const vertex = new Vector3();
  object.traverse((node) => {
    if (!node.isMesh || !node.visible || !isMeant(meshClass(node.name))) return;
    for (let i = 0; i < node.geometry.attributes.position.count; ++i) {
      box.expandByPoint(node.getVertexPosition(i, vertex).applyMatrix4(node.matrixWorld));
    }
  });
  return box;
}

/** What the camera can show of an object whose world matrices are current, by name: the center, the width and the height
 * that must fit, how far it is from the camera at least, and from which side it is seen, in degrees to its left.
 * Null for an object without meshes. */
export function regionsOf(object) {
  const whole = boxOf(object, () => true);
  if (whole.isEmpty()) return null;
  const [center, size] = [whole.getCenter(new Vector3()), whole.getSize(new Vector3())];
  const isBody = size.y > 1;
  // Of a body the upper part, where the face is.
  if (isBody) {
    center.y = whole.max.y - 0.14;
    size.set(Math.min(size.x, 0.34), 0.34, size.z);
  }
  const view = (yaw) => ({ center, width: size.x, height: size.y, depth: size.z, yaw });
  const regions = { Head: { ...view(7), pitch: 2 } };
  const [eyes, mouth] = [boxOf(object, (kind) => kind === "eye"), boxOf(object, (kind) => kind === "teeth" || kind === "tongue")];
  const [between, bite] = [eyes.getCenter(new Vector3()), mouth.getCenter(new Vector3())];
  const apart = between.y - bite.y; // of eyes and mouth, in a face with both
  if (!eyes.isEmpty() && !mouth.isEmpty() && apart > 0) {
    const closeUp = (of, width, height) => ({ center: of.clone().setX(between.x), width: width * apart, height: height * apart, depth: 0.3 * apart, yaw: 0 });
    regions.Face = closeUp(between.clone().lerp(bite, 0.5), 2.6, 3.4);
    regions.Eyes = closeUp(between, 1.9, 0.8);
    regions.Mouth = closeUp(bite, 1.4, 0.9);
  }
  regions.Left = view(90);
  regions.Right = view(-90);
  return { regions, isBody, neck: new Vector3(center.x, whole.min.y + 0.25 * (whole.max.y - whole.min.y), center.z) };
}
