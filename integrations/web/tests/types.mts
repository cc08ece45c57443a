// SPDX-License-Identifier: MIT
// What users write, compiled with every check of TypeScript and never run. Lines below @ts-expect-error must not
// compile.
import { DnaError, Isa, Kind, Mien, MienError, Normals, Preset, Stage, TICKS_PER_SECOND } from "mien";
import type { Clip, Mesh, Rig, RigInfo } from "mien";
import { FaceObject, GltfFace } from "mien/three";
import { MeshBasicMaterial, PerspectiveCamera, Scene } from "three";

export async function use(file: File): Promise<number> {
  const mien: Mien = await Mien.load({ bakedOnly: false });
  const rig: Rig = await mien.openRig(file, { isa: Isa.SSE2, system: "gltf", lods: 1 });
  const info: RigInfo = rig.info;
  const face = rig.instance();
  face.controls.jawOpen = 1;
  face.controls["CTRL_expressions.jawOpen"] = 1;
  face.evaluate(0, Stage.PSD | Stage.JOINTS);
  const joints: Float32Array = face.joints;
  const names: readonly string[] = rig.names(Kind.JOINT);
  const meshes = rig.deformer?.instance({ lods: 1 });
  meshes?.update(face);
  meshes?.deform(0, Normals.SKINNED);
  const mesh: Mesh | undefined = rig.deformer?.mesh(0);
  const clip: Clip = mien.buildClip({ names: ["jawOpen"], values: [0, 1] });
  const player = clip.player();
  player.advance(Math.round(TICKS_PER_SECOND / 60));
  clip.bind(rig).apply(player.sample(), face);
  for (const event of player.events()) console.log(event.name);
  using head = mien.createRig(mien.generate(Preset.HEAD));
  const value: string | number | Float32Array | Float64Array = mien.generate(Preset.TINY).read("desc.name");

  // @ts-expect-error: a misspelled option
  await mien.openRig(file, { isaa: 1 });
  // @ts-expect-error: results are not written
  face.joints = joints;
  // @ts-expect-error: no number is an instruction set but those of Isa
  mien.isaAvailable(77);
  // @ts-expect-error: modules are loaded
  new Mien();

  try {
    await mien.openDna("https://example.org/head.dna");
  } catch (error) {
    if (error instanceof DnaError) console.log(error.byteOffset, error.statusName);
    if (error instanceof MienError) return error.status;
  }
  return info.lodCount + joints.length + names.length + (mesh?.vertexCount ?? 0) + head.count(Kind.MESH) + String(value).length;
}

export function show(rig: Rig, scene: Scene, camera: PerspectiveCamera): void {
  const face = new FaceObject(rig, { skinning: "gpu", material: () => new MeshBasicMaterial() });
  scene.add(face);
  face.face.controls.jawOpen = 1;
  face.lod = face.lodOf(camera);
  face.update();
  new GltfFace(scene, rig).update();
  // @ts-expect-error: no such way of skinning
  new FaceObject(rig, { skinning: "cpu" });
}
