// SPDX-License-Identifier: MIT
// evaluate.mjs [FILE.dna [CONTROL]]: raises a control and prints the joint that moves or turns most.
import { Kind, Mien, Preset } from "mien";

const [file, control = "CTRL_expressions.jawOpen"] = process.argv.slice(2);
const mien = await Mien.load();
const rig = file ? await mien.openRig(file) : mien.createRig(mien.generate(Preset.LARGE));
const face = rig.instance();
face.controls[control] = 1; // or face.rawControls[i]; some rigs leave the prefix out, which is found, too
const name = rig.name(Kind.RAW_CONTROL, rig.find(Kind.RAW_CONTROL, control));
face.evaluate(0);
let most = 0; // per joint tx ty tz rx ry rz sx sy sz
face.joints.forEach((value, i) => {
  if (i % 9 < 6 && Math.abs(value) > Math.abs(face.joints[most])) most = i;
});
const joint = Math.floor(most / 9);
const [x, y, z, rx, ry, rz] = Array.from(face.joints.slice(9 * joint, 9 * joint + 6), (value) => value.toFixed(3));
console.log(`${name} moves ${rig.name(Kind.JOINT, joint)} most: by ${x} ${y} ${z}, turning it by ${rx} ${ry} ${rz}`);
