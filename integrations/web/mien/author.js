// SPDX-License-Identifier: MIT
// Rigs from meshes: arrays of the caller as structs of the library, what it says while it works, its report.
import { BoneKind, Status } from "./api.js";
import { Dna } from "./dna.js";
import { errorOf } from "./errors.js";

const wrong = (message) => errorOf(Status.INVALID_ARGUMENT, message);

/** Numbers of which there have to be some per element, and, if `count` is given, for that many elements. */
function numbers(values, what, width, count) {
  if (!ArrayBuffer.isView(values) && !Array.isArray(values)) throw wrong(`${what} is no array of numbers`);
  if (count === undefined ? values.length % width : values.length !== width * count) {
    throw wrong(`${what} has ${values.length} numbers, ` +
      (count === undefined ? `which is no multiple of ${width}` : `not ${width * count}`));
  }
  return values;
}

/** As numbers(), whole ones from 0 to `most`: typed arrays would cut off others. */
function indices(values, what, width, count, most = 2 ** 32 - 1) {
  numbers(values, what, width, count);
  if (values instanceof Uint32Array && most === 2 ** 32 - 1) return values;
  const bad = values.findIndex((value) => !Number.isInteger(value) || value < 0 || value > most);
  if (bad >= 0) throw wrong(`${what}[${bad}] is ${values[bad]}: whole numbers from 0 to ${most} are needed`);
  return values;
}

/** Triangles one after the other, or an array for each face. */
function facesOf({ faces, faceSizes }) {
  if (Array.isArray(faces) && faces.length && typeof faces[0] !== "number") {
    if (faceSizes) throw wrong("faceSizes are for corners one after the other");
    return {
      corners: indices(faces.flatMap((face) => Array.from(face)), "faces", 1),
      faceSizes: faces.map((face) => face.length), faceCount: faces.length,
    };
  }
  const corners = indices(faces, "faces", faceSizes ? 1 : 3);
  if (!faceSizes) return { corners, faceCount: corners.length / 3 };
  return { corners, faceSizes: indices(faceSizes, "faceSizes", 1), faceCount: faceSizes.length };
}

function shapeOf(name, shape, count) {
  if (ArrayBuffer.isView(shape) || Array.isArray(shape)) {
    return { name, displacements: numbers(shape, `shape "${name}"`, 3, count), positionCount: count };
  }
  const positions = indices(shape.positions, `positions of shape "${name}"`, 1);
  const displacements = numbers(shape.displacements, `displacements of shape "${name}"`, 3, positions.length);
  return { name, positions, displacements };
}

function objectsOf(objects) {
  let firstFace = 0;
  return objects.map(({ name, faceCount }) => {
    indices([faceCount], `faceCount of object "${name}"`, 1);
    firstFace += faceCount;
    return { name, firstFace: firstFace - faceCount, faceCount };
  });
}

/** The fields of a struct AuthorMesh. */
function meshOf({ positions, faces, faceSizes, uvs, cornerUvs, objects, shapes = {}, ...rest }) {
  const positionCount = numbers(positions, "positions", 3).length / 3;
  const given = { ...rest, positions, positionCount, ...facesOf({ faces, faceSizes }) };
  if (uvs) {
    given.uvs = numbers(uvs, "uvs", 2, cornerUvs ? undefined : positionCount);
    given.uvCount = uvs.length / 2;
    given.cornerUvs = cornerUvs ? indices(cornerUvs, "cornerUvs", 1, given.corners.length) : given.corners;
  } else if (cornerUvs) {
    throw wrong("cornerUvs need uvs");
  }
  if (objects) given.objects = objectsOf(objects);
  given.shapes = Object.entries(shapes).map(([name, shape]) => shapeOf(name, shape, positionCount));
  return given;
}

/** The fields of a struct AuthorDesc. */
function descOf({ bones, weights, lodMeshes, ...rest }, positionCount, shapeCount) {
  const given = { seed: 1, ...rest };
  const boneCount = bones?.length ?? 0;
  for (const [name, width, count] of [["depthGroups", 1, positionCount], ["mask", 1, positionCount],
    ["boneGroups", 1, boneCount], ["boneMotions", 6, boneCount * shapeCount]]) {
    if (given[name]) numbers(given[name], name, width, count);
  }
  for (const name of ["depthGroups", "mask"]) if (given[name]) indices(given[name], name, 1, positionCount, 255);
  if (given.lodJoints) {
    given.lods ||= indices(given.lodJoints, "lodJoints", 1).length;
    if (!given.lods || given.lods !== given.lodJoints.length) throw wrong("lodJoints are not one for each LOD");
  }
  if (lodMeshes) {
    given.lods ||= lodMeshes.length + 1;
    if (given.lods !== lodMeshes.length + 1) throw wrong("lodMeshes are not one for each LOD but the first");
    given.lodMeshes = lodMeshes.map((lod, i) => {
      const { faces, cornerUvs } = ArrayBuffer.isView(lod) || Array.isArray(lod) ? { faces: lod } : lod;
      const corners = indices(faces, `lodMeshes[${i}]`, 3);
      if (!cornerUvs) return { corners };
      return { corners, cornerUvs: indices(cornerUvs, `cornerUvs of lodMeshes[${i}]`, 1, corners.length) };
    });
  }
  if (bones) {
    given.bones = bones.map(({ name, position, parent = 0, kind = BoneKind.FACIAL }) =>
      ({ name, position: numbers(position, `position of bone "${name}"`, 3, 1), parent, kind }));
  }
  if (weights) {
    const { joints, weights: shares } = weights;
    const influences = positionCount ? joints.length / positionCount : 0;
    if (!Number.isInteger(influences)) {
      throw wrong(`weights have ${joints.length} joints, not as many for each of ${positionCount} positions`);
    }
    if (given.influences && given.influences !== influences) {
      throw wrong(`weights have ${influences} influences, not ${given.influences}`);
    }
    given.influences = influences;
    given.weightJoints = indices(joints, "joints of weights", 1, undefined, 65535);
    given.weights = numbers(shares, "weights of weights", 1, joints.length);
  }
  return given;
}

/** Makes a rig: the file, and what was found and measured. */
export function authorRig(memory, mesh, { progress, ...options } = {}) {
  const { exports } = memory;
  const givenMesh = meshOf(mesh);
  const desc = {
    ...descOf(options, givenMesh.positionCount, givenMesh.shapes.length), parallel: memory.parallel,
  };
  if (progress) {
    desc.progress = exports.mien_web_progress_function();
    desc.progressUser = memory.addFunction(progress);
  }
  try {
    return memory.withScratch((scratch) => {
      const [dna, report, error] = [scratch.take(4), scratch.take(4), scratch.out("Error")];
      const given = [scratch.struct("AuthorMesh", givenMesh), scratch.struct("AuthorDesc", desc), dna, report, error];
      memory.withFunctions([], () => memory.check(exports.mien_author_rig(...given), error));
      const made = new Dna(memory, memory.data.getUint32(dna, true));
      const handle = memory.data.getUint32(report, true);
      try {
        const text = scratch.take(8);
        memory.check(exports.mien_author_report_json(handle, text), 0, "mien_author_report_json");
        const [at, count] = [memory.data.getUint32(text, true), memory.data.getUint32(text + 4, true)];
        return { dna: made, report: JSON.parse(memory.text(at, count)) };
      } catch (failure) {
        made.dispose();
        throw failure;
      } finally {
        exports.mien_author_report_close(handle);
      }
    });
  } finally {
    if (desc.progressUser) memory.removeFunction(desc.progressUser);
  }
}
