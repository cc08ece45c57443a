// SPDX-License-Identifier: MIT
// A GLB has no rig, and idle life is mixed on one. A stand-in has the controls that idle life moves, as far as the morph
// targets of the GLB have their names, and two eyes that turn as the targets turn those of the GLB.
import { Kind } from "mien";
import { Vector3 } from "three";
import { BLINKS, LOOKS, NOSTRILS } from "./idle.js";

const SIDES = ["Left", "Right"];
/** Degrees that a target at 1 turns an eye, if that cannot be measured: as those of the built-in head. */
const USUAL = { In: 26, Out: 26, Up: 24, Down: 26 };
/** Of the farthest vertex: what moves so far is an eye, and less are lids and lashes. */
const EYE = 0.5;

/** The places of a mesh that a target moves, at rest and moved, in the coordinates of its scene. */
function* movedBy(mesh, target) {
  const offsets = mesh.geometry.morphAttributes.position?.[target];
  const before = mesh.morphTargetInfluences.slice();
  const at = (i, influence) => {
    mesh.morphTargetInfluences.fill(0)[target] = influence;
    return mesh.getVertexPosition(i, new Vector3()).applyMatrix4(mesh.matrixWorld);
  };
  for (let i = 0; i < (offsets?.count ?? 0); ++i) {
    if (!offsets.getX(i) && !offsets.getY(i) && !offsets.getZ(i)) continue;
    yield { key: `${mesh.id} ${i}`, rest: at(i, 0), moved: at(i, 1) };
  }
  mesh.morphTargetInfluences.splice(0, before.length, ...before);
}

/** The rotation of places from axis `u` towards axis `v` that fits best: its angle in degrees, and the place that it leaves
 * where it is. Null if they do not turn like a body. */
function turnOf(places, u, v) {
  const mean = (of) => places.reduce((sum, place) => sum + of(place), 0) / places.length;
  const by = (axis) => ({ moved, rest }) => moved[axis] - rest[axis];
  const [pu, pv] = [mean(({ rest }) => rest[u]), mean(({ rest }) => rest[v])];
  const [du, dv] = [mean(by(u)), mean(by(v))];
  let [square, along, across, all] = [0, 0, 0, 0];
  for (const place of places) {
    const [a, b, da, db] = [place.rest[u] - pu, place.rest[v] - pv, by(u)(place) - du, by(v)(place) - dv];
    square += a * a + b * b;
    across += a * db - b * da;
    along += a * da + b * db;
    all += da * da + db * db;
  }
  const [sine, less] = [across / square, along / square]; // and the cosine less 1
  const degrees = Math.atan2(sine, 1 + less) * 180 / Math.PI;
  const explained = (across * across + along * along) / (square * all);
  if (!(Math.abs(degrees) > 5 && Math.abs(degrees) < 60 && explained > 0.8)) return null;
  const length = sine * sine + less * less;
  return { degrees, [u]: pu - (less * du + sine * dv) / length, [v]: pv - (less * dv - sine * du) / length };
}

/** Where an eye is, and how far each of its targets turns it about the axes of the scene; null if there is none.
 * `targetsOf` gives the [mesh, target] of a name. */
function measureEye(side, targetsOf) {
  const moves = Object.fromEntries(Object.keys(USUAL).map((way) => [way,
    targetsOf(`eyeLook${way}${side}`).flatMap(([mesh, target]) => [...movedBy(mesh, target)])]));
  // Lids follow a look up or down as far as the eye goes, but not one to a side.
  const sideways = [...moves.In, ...moves.Out].length ? [...moves.In, ...moves.Out] : [...moves.Up, ...moves.Down];
  if (sideways.length === 0) return null;
  const far = ({ rest, moved }) => rest.distanceTo(moved);
  const least = EYE * sideways.reduce((most, place) => Math.max(most, far(place)), 0);
  const keys = new Set(sideways.filter((place) => far(place) >= least).map(({ key }) => key));
  const outwards = side === "Left" ? 1 : -1; // +x is to the left of the face
  const turns = {};
  for (const [way, places] of Object.entries(moves)) {
    const turn = turnOf(places.filter(({ key }) => keys.has(key)), ...(way === "In" || way === "Out" ? ["z", "x"] : ["y", "z"]));
    turns[way] = turn ?? { degrees: USUAL[way] * { In: -outwards, Out: outwards, Up: -1, Down: 1 }[way] };
  }
  const mean = (axis) => {
    const found = Object.values(turns).map((turn) => turn[axis]).filter((value) => value !== undefined);
    if (found.length) return found.reduce((sum, value) => sum + value, 0) / found.length;
    return sideways.reduce((sum, { rest }) => sum + rest[axis], 0) / sideways.length;
  };
  return { center: ["x", "y", "z"].map(mean), degrees: Object.fromEntries(Object.entries(turns).map(([way, turn]) => [way, turn.degrees])) };
}

/** A rig of these raw controls; with eyes, that eyeLook controls turn. */
function makeRig(mien, controls, eyes) {
  const file = mien.createDocument();
  const list = (path, values) => {
    file.resize(path, values.length);
    values.forEach((value, i) => file.write(`${path}[${i}]`, value));
  };
  let dna = null;
  try {
    file.write("desc.lodCount", 1);
    file.write("desc.translationUnit", 1); // meters, and degrees
    for (const [axis, direction] of [["xAxis", 0], ["yAxis", 2], ["zAxis", 4]]) file.write(`desc.coordinateSystem.${axis}`, direction);
    const joints = ["head", ...(eyes ? ["L_Eye", "R_Eye"] : [])];
    const all = joints.map((_, i) => i);
    list("defn.rawControlNames", controls);
    list("defn.jointNames", joints);
    file.write("defn.jointHierarchy", all.map(() => 0));
    file.write("defn.lodJointMapping.lods", [0]);
    list("defn.lodJointMapping.indices", [all]);
    ["xs", "ys", "zs"].forEach((axis, k) => {
      file.write(`defn.neutralJointTranslations.${axis}`, [0, ...(eyes ?? []).map(({ center }) => center[k])]);
      file.write(`defn.neutralJointRotations.${axis}`, all.map(() => 0));
    });
    file.write("bhvr.joints.rowCount", 9 * joints.length);
    file.write("bhvr.joints.colCount", controls.length);
    if (eyes) {
      // Of each eye its rotations about x and y, by all controls.
      const rows = [12, 13, 21, 22];
      const values = rows.flatMap((row, i) => controls.map((control) => {
        const [, way, side] = /^eyeLook(Up|Down|In|Out)(Left|Right)$/.exec(control) ?? [];
        const turns = way === "In" || way === "Out" ? 1 : 0;
        return side === SIDES[i >> 1] && turns === i % 2 ? eyes[i >> 1].degrees[way] : 0;
      }));
      file.resize("bhvr.joints.jointGroups", 1);
      for (const [name, content] of [["lods", [rows.length]], ["inputIndices", controls.map((_, i) => i)], ["outputIndices", rows],
        ["values", values], ["jointIndices", [1, 2]]]) {
        file.write(`bhvr.joints.jointGroups[0].${name}`, content);
      }
    }
    dna = file.toDna();
    const rig = mien.createRig(dna);
    rig.deformer = rig.createDeformer(dna); // of joints alone
    return rig;
  } finally {
    dna?.dispose();
    file.dispose();
  }
}

export class StandIn {
  /** `targetsOf` gives the [mesh, target] of a name, at most none; the world matrices of the meshes are current. Null if
   * there are targets of none of the names. */
  static of(mien, targetsOf) {
    const has = (name) => targetsOf(name).length > 0;
    const missing = [...BLINKS, ...LOOKS].filter((name) => !has(name));
    if (missing.length === BLINKS.length + LOOKS.length) return null;
    const eyes = SIDES.map((side) => measureEye(side, targetsOf));
    // One eye alone looks as a pair does.
    const other = (eye) => eye && { ...eye, center: [-eye.center[0], eye.center[1], eye.center[2]],
      degrees: { ...eye.degrees, In: -eye.degrees.In, Out: -eye.degrees.Out } };
    const pair = [eyes[0] ?? other(eyes[1]), eyes[1] ?? other(eyes[0])];
    // The gaze needs all eight, also those that move nothing.
    const controls = [...BLINKS.filter(has), ...NOSTRILS.filter(has), ...(pair[0] ? LOOKS : [])];
    return new StandIn(makeRig(mien, controls, pair[0] ? pair : null), missing);
  }

  constructor(rig, missing) {
    this.rig = rig;
    this.missing = missing;
    this.face = rig.instance(); // with the pose of the GLB
    this.names = rig.names(Kind.RAW_CONTROL);
  }

  dispose() {
    for (const object of [this.face, this.rig]) object.dispose();
  }
}
