// SPDX-License-Identifier: MIT
// What users write, compiled with every check of TypeScript and never run. Lines below @ts-expect-error must not
// compile.
import {
  AuthorFlags, BlendMode, BoneKind, DnaError, FitConstraintKind, FitStatus, Generator, Guard, Isa, Kind, LayerGroup, MeshAxis, Mien, MienError, Mixer, MixLayer,
  Normals, Preset, Stage, Symmetry, TICKS_PER_SECOND, ticks,
} from "mien";
import type { Clip, Deformer, FitConstraint, Mesh, Mix, MixerEvent, Reaction, Rig, RigInfo } from "mien";
import { FaceObject, GltfFace } from "mien/three";
import { MeshBasicMaterial, PerspectiveCamera, Scene } from "three";

export async function use(file: File): Promise<number> {
  const mien: Mien = await Mien.load({ bakedOnly: false, threads: true });
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

export function mixing(mien: Mien, rig: Rig, clip: Clip): number {
  const face = rig.instance();
  const dazzled: Reaction = {
    strokes: [{ pose: { eyeBlinkLeft: 1 }, mode: BlendMode.MAX, attack: ticks(0.1) }], cooldown: ticks(1),
  };
  using mix = rig.mix({
    layers: [
      MixLayer.clip({ group: LayerGroup.SPEECH }), MixLayer.poses([{ jawOpen: 0.5 }], { mask: ["jawOpen"] }),
      MixLayer.generator(Generator.BLINK, { eyeBlinkLeft: 1 }, { period: ticks(4) }),
      MixLayer.gaze(["x", "y", "z"], { jitter: [0.1, 0.1] }), MixLayer.stream(["browInnerUp", 3]),
    ],
    reactions: [dazzled, mien.glare([{}, {}, {}, {}, {}])],
    guards: Guard.LIPS | Guard.LIDS, variables: ["x", "y", "z"], antagonists: rig.antagonists(), lower: 0, upper: 1,
  });
  const mixer: Mixer = mix.mixer({ seed: 1 });
  mixer.play(0, clip, clip.bind(rig), { transitionTicks: ticks(0.1) });
  mixer.step(ticks(1 / 60), face);
  const events: readonly MixerEvent[] = mixer.events;
  Mixer.stepAll([mixer], 1);
  mixer.restore(mixer.snapshot(), [{ clipId: 1, clip, binding: clip.bind(rig) }]);
  const stack = rig.deformer?.solvers([
    { spring: { joint: 1, frequency: 3, damping: 0.3 }, lods: 1 },
    { space: { joint: 1, spaces: [null, 2], curve: 0 } },
    { custom: { writes: [1], solve: (poses, time) => { for (const pose of poses) pose.locals[10] = time; } } },
  ], { curveCount: 1 });
  const meshes = rig.deformer?.instance();
  if (meshes) stack?.state().step(meshes, 1, { row: mixer.row });
  // @ts-expect-error: a misspelled option
  rig.mix({ layer: [] });
  // @ts-expect-error: one kind of solver
  rig.deformer?.solvers([{ spring: { joint: 0 }, twist: {} }]);
  // @ts-expect-error: modes are those of BlendMode
  MixLayer.clip({ mode: 77 });
  return events.length + mixer.guard(0).distance;
}

export function solving(mien: Mien, rig: Rig): number {
  const fit = rig.fit({ points: [1, { positions: [1, 2, 3], weights: [0.5, 0.5, 0] }], controls: ["jawOpen", 3], upper: 0.5 });
  using surface = mien.createFitSurface(new Float32Array(9), [0, 1, 2]);
  const { controls, status, rotation } = fit.solve({ surface, rigid: true, canceled: () => false });
  fit.solve({ images: [1, 2, 3, 4], camera: { focal: [1, 1] }, start: controls });
  const gaze: FitConstraint = { kind: FitConstraintKind.JOINT_AIM, joint: 2, axis: [0, 0, 1], target: [0, 0, 99] };
  const take = fit.solveFrames({ joints: new Float32Array(90), constraints: [gaze], stages: new Uint32Array(9) }, 10);
  using part: Deformer | undefined = rig.deformer?.subset(0, [1, 2, 3]);
  console.log(take[0]?.jumped, part?.info.meshCount);
  // @ts-expect-error: how many frames
  fit.solveFrames({ joints: [] });
  if (status === FitStatus.CONVERGED) rig.instance().rawControls.set(controls);
  // @ts-expect-error: a misspelled option
  rig.fit({ point: [1] });
  // @ts-expect-error: a point has three positions
  rig.fit({ points: [{ positions: [1], weights: [1] }] });
  return mien.reduceKeys(controls, 0.01).length + (rotation[0] ?? 0) + (fit.observability[0] ?? 0);
}

export async function files(mien: Mien, rig: Rig, mix: Mix): Promise<string> {
  using again: Mix = await mien.openMix(mix.write(), rig, { variables: ["x"] });
  const triangle = new Float32Array(9);
  const { dna, report } = mien.authorRig({
    positions: triangle, faces: new Uint16Array([0, 1, 2]), uvs: [0, 0, 0, 1, 1, 0],
    shapes: { smile: triangle, puff: { positions: [1], displacements: [0, 0, 1] } },
  }, {
    facialJoints: 100, symmetry: Symmetry.OFF, flags: AuthorFlags.PAPER | AuthorFlags.NO_TARGETS, up: MeshAxis.Z,
    bones: [{ name: "root", position: [0, 0, 0], kind: BoneKind.ROOT }],
    progress: (step, share) => { console.log(step, share); },
  });
  // @ts-expect-error: a misspelled option
  mien.authorRig({ positions: triangle, faces: [0, 1, 2] }, { joints: 100 });
  // @ts-expect-error: a mesh has faces
  mien.authorRig({ positions: triangle });
  return again.toText() + String(report["mesh"]) + dna.info.lodCount;
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
