// SPDX-License-Identifier: MIT
// Mien in JavaScript: facial rigs in browsers, workers and Node.js.
//
//     DNA file or baked file -> Rig -> Instance          controls in; joint values, weights out
//                                 \ -> Deformer -> DeformerInstance   matrices and vertices
//                                 \ -> Mix -> Mixer   clips, poses and reactions in; controls of an Instance
//                                 \ -> Fit            captured joints, points, surfaces in; controls
//     DNA file -> Dna -> Document -> DNA file            changed
//
// Objects have memory in the module, which is released by dispose() or `using`, never by itself. Typed arrays
// are views of that memory. When it grows, old views become empty; properties and methods make new ones, so
// read them again in each frame, and copy with slice() what you keep. Failures throw a MienError. Descriptions
// of options, units and formulas are those of mien.h, in api.d.ts.
import type {
  ControlShare, NameMatch, MatrixEntry, BatchDesc, ClipBindingDesc, ClipChannel, ClipDesc, ClipEvent, ClipInfo, ClipPlayerDesc, ClipPlayerInfo,
  CoordinateSystem, DeformerDesc, DeformerInfo, DeformerInstanceDesc, DnaDesc, DnaField, DnaInfo, DnaLayer,
  Exports, Finding, GazeDesc, GazeInfo, GazeRest, GazeTarget, GenerateDesc, GuardState, InstanceStatistics, Isa, Kind, Mesh,
  MixDesc, MixGuardInfo, MixInfo, MixReaction, MixStroke, MixerDesc, MixerInfo, Normals, PlayDesc, Preset, Reuse,
  RigDesc, RigInfo, RigStatistics, SolverInput, SolverStackDesc, SolverStackInfo, SpringSolver, Stage, Status,
  TwistSolver, WriteDesc, BakedCheck, AimSolver as AimSolverDesc, BlendMode, CopySolver as CopySolverDesc,
  Generator as GeneratorKind, LayerGroup, LayerSource, MixLayer as MixLayerDesc,
  AuthorBone as AuthorBoneDesc, AuthorDesc, Conformed, ControlError, Placement, ProjectDesc, PruneJointsDesc, PrunedJoints,
  PrunedTargets, TransplantDesc, FitCamera, FitConstraint, FitFrame as FitFrameDesc, FitResult as FitResultDesc,
} from "./api.js";

export * from "./api.js";

/** Where files come from: bytes, a file of a page, an answer of fetch(), or an address; in Node.js also a path. */
export type Source = Uint8Array | ArrayBuffer | ArrayBufferView | Blob | Response | URL | string;

/** A name of Mien.coordinateSystems, such as "gltf", or a system. */
export type System = string | CoordinateSystem;

/** Numbers by the names of controls. Reading or writing a name that the rig lacks throws. */
export type Controls = Record<string, number>;

/** What a call failed with. */
export class MienError extends Error {
  constructor(status: Status, message: string, byteOffset?: number | null);
  readonly status: Status;
  /** "DNA_TRUNCATED" for Status.DNA_TRUNCATED. */
  readonly statusName: string;
  /** Where in the file; null: not about a place in a file. */
  readonly byteOffset: number | null;
}
/** A wrong argument: Status.NULL_ARGUMENT to Status.ISA. */
export class ArgumentError extends MienError {}
/** The module cannot get more memory. */
export class MienMemoryError extends MienError {}
/** A module that opens baked files only was asked for more. */
export class UnsupportedError extends MienError {}
export class FileError extends MienError {}
/** The bytes of a DNA file are not valid. */
export class DnaError extends MienError {}
/** The bytes of a baked file are not valid. */
export class BakedError extends MienError {}
/** The bytes of a clip are not valid. */
export class ClipError extends MienError {}
/** The bytes of a mix are not valid. */
export class MixError extends MienError {}
/** No rig can be made of a mesh, or it was canceled. */
export class AuthorError extends MienError {}

/** What has memory in the module. Using it after dispose() throws. */
interface Handle {
  /** Address of the object, for functions of Mien.exports. */
  readonly handle: number;
  readonly isDisposed: boolean;
  /** Releases the memory. Harmless if it was called before. */
  dispose(): void;
  [Symbol.dispose](): void;
}

export interface LoadOptions {
  /** The module, instead of that of the package: an address, bytes, or a module that is compiled already. */
  wasm?: Source | WebAssembly.Module;
  /** Load the smaller module, which opens baked files only, on one thread. */
  bakedOnly?: boolean;
  /** Threads that work on batches, large meshes and rigs from meshes, with the one that calls: 1 (default) to 64, or
   * true for as many as the machine has. They are workers that share the memory of the module, which pages may have
   * with the headers COOP and COEP; without them there is one. Results are the same bits. */
  threads?: number | true;
}

/** Options of rigs that are made from a DNA file. */
export interface CreateRigOptions extends RigDesc {
  /** false: without meshes. Default: with meshes if the file has them. */
  deformer?: boolean | DeformerDesc;
}

/** Options for DNA files and baked files; each kind of file has some of them. */
export interface OpenRigOptions extends CreateRigOptions {
  /** Bit l keeps LOD l, 0 keeps all. DNA files only. */
  lods?: number;
  /** Convert to this coordinate system. DNA files only. */
  system?: System;
  /** Layer.... combined with |; 0: all. DNA files only. */
  layers?: number;
  /** DNA files only. */
  skipBlendShapeTargets?: boolean | number;
  /** Baked files only. */
  check?: BakedCheck;
  /** Baked files only. */
  normals?: Normals;
  isa?: Isa;
  reuse?: Reuse;
}

export interface OpenDnaOptions extends Omit<DnaDesc, "system"> {
  system?: System;
}

export interface Report {
  readonly errors: number;
  readonly warnings: number;
  readonly findings: readonly (Finding & { readonly isError: boolean })[];
}

/** A loaded module. Its objects share one memory, and belong to the thread that loaded it. */
export class Mien {
  private constructor();
  static load(options?: LoadOptions): Promise<Mien>;
  readonly exports: Exports;
  /** Threads that work, with the one that calls. */
  readonly threads: number;
  /** "0.1.0" */
  readonly version: string;
  /** Memory of the module. It grows and never shrinks. */
  readonly memoryBytes: number;
  /** Names of coordinate systems. */
  readonly coordinateSystems: readonly string[];
  isaAvailable(isa: Isa): boolean;
  isaName(isa: Isa): string;
  /** Opens a DNA file or a baked file: the rig, and the deformer if the file has meshes. */
  openRig(source: Source, options?: OpenRigOptions): Promise<Rig>;
  openDna(source: Source, options?: OpenDnaOptions): Promise<Dna>;
  openClip(source: Source): Promise<Clip>;
  /** Builds a clip of curves. channelCount and frameCount follow from names and values. */
  buildClip(desc: ClipDesc): Clip;
  /** Opens bytes that Mix.write() gave, for a rig that has the controls which the mix uses, by their names; without
   * a rig to look into it. `variables`: names for its pose variables, in their order. */
  openMix(source: Source, rig?: Rig | null, options?: { variables?: readonly string[] }): Promise<Mix>;
  /** For ClipBindingDesc.matrix: binds clips with the names of ARKit to rigs that name raw controls in the other
   * usual way, eyeBlinkL for eyeBlinkLeft. */
  arkitMatrix(): MatrixEntry[];
  /** The usual name of a control, "mouthSmileLeft" for "AU12_L"; undefined: not in the table of names. */
  controlName(name: string): string | undefined;
  /** A response to a light in the eyes. Its five poses: lids closed; squint and lowered brows; gaze turned away;
   * narrow pupils; head turned away. An empty one leaves its part out. */
  glare(poses: readonly Pose[]): Reaction;
  /** Checks the bytes of a DNA file and lists what is wrong with them. */
  validate(source: Source): Promise<Report>;
  /** Generates a rig: generate(Preset.HEAD) is a head to look at. */
  generate(preset: Preset, options?: Omit<GenerateDesc, "preset">): Dna;
  /** Makes a rig for the mesh of a head, with a raw control for each shape: joints, skin weights of each LOD and
   * their motion. Not in the module that opens baked files only. This takes seconds to minutes, so call it in a
   * worker, and end the worker to cancel from outside. docs/authoring.md says what it does. */
  authorRig(mesh: AuthorMesh, options?: AuthorOptions): AuthoredRig;
  /** A document of an open DNA file, which may be disposed afterwards; of null, an empty one. Not in the module that
   * opens baked files only. */
  createDocument(dna?: Dna | null): Document;
  /** A surface without correspondences, for Fit.solve(): three numbers per position, and three positions per
   * triangle. Not in the module that opens baked files only. */
  createFitSurface(positions: Numbers, triangles: Integers): FitSurface;
  /** Frame numbers of the keys of a curve, the first and the last frame among them: straight lines between them are
   * within `tolerance` of all values. Not in the module that opens baked files only. */
  reduceKeys(values: Numbers, tolerance: number): Uint32Array;
  /** The rig of an open DNA file, which may be disposed afterwards. */
  createRig(dna: Dna, options?: CreateRigOptions): Rig;
}

type Numbers = readonly number[] | Float32Array | Float64Array;
type Integers = readonly number[] | Uint8Array | Uint16Array | Uint32Array | Int32Array;

/** The mesh of a head, in the unit and axes of AuthorOptions. */
export interface AuthorMesh {
  /** Three per position. */
  positions: Numbers;
  /** Positions of the corners, counterclockwise from outside: triangles one after the other, or an array per face. */
  faces: Integers | readonly (readonly number[] | Uint32Array)[];
  /** Corners of each face, if `faces` has them one after the other. Default: all are triangles. */
  faceSizes?: Integers;
  /** Two per UV: one UV for each position, or as `cornerUvs` says. */
  uvs?: Numbers;
  /** One per corner. */
  cornerUvs?: Integers;
  /** Parts with names, in the order of the faces; they become meshes. Default: one. */
  objects?: readonly { name: string; faceCount: number }[];
  /** Expressions by name: what is added to all positions at value 1, three numbers each, or to some of them. */
  shapes?: Readonly<Record<string, Numbers | { positions: Integers; displacements: Numbers }>>;
}

/** A bone of yours. `parent` is 0 and `kind` BoneKind.FACIAL by default. */
export interface AuthorBone extends Omit<AuthorBoneDesc, "name" | "position"> {
  name: string;
  /** In the mesh, not relative to the parent. */
  position: readonly number[] | Float32Array | Float64Array;
}

/** As in AuthorDesc; `seed` is 1 by default. */
export interface AuthorOptions extends Omit<AuthorDesc,
  "bones" | "boneCount" | "weightJoints" | "weights" | "lodMeshes" | "lodMeshCount" | "parallel" | "progress" |
  "progressUser"> {
  /** Bones of yours, instead of those that would be placed. */
  bones?: readonly AuthorBone[];
  /** Skin weights of yours, with `bones`: as many joints and weights for each position. */
  weights?: { joints: Integers; weights: Numbers };
  /** Meshes of yours of LOD 1, LOD 2 and so on, instead of those that would be made: positions of the corners of
   * triangles, each of one object. `cornerUvs` has one per corner; by default, of the UVs that a position has in the
   * mesh, those nearest to each other. */
  lodMeshes?: readonly (Integers | { faces: Integers; cornerUvs?: Integers })[];
  /** Is told which step begins, and a share from 0 to 1. If it returns true, authorRig() throws an AuthorError with
   * Status.AUTHOR_CANCELED; what it throws comes out as it is. */
  progress?: (step: string, share: number) => boolean | void;
}

export interface AuthoredRig {
  /** To be written, made a rig of, and disposed. */
  readonly dna: Dna;
  /** What was found and measured: docs/authoring.md, 6. */
  readonly report: Readonly<Record<string, any>>;
}

/** An open DNA file. */
export interface Dna extends Handle {
  readonly info: DnaInfo;
  readonly layers: readonly DnaLayer[];
  /** Keys and values of the descriptor. */
  readonly metadata: ReadonlyMap<string, string>;
  /** Finds a field by its path: "bhvr.joints.jointGroups[7].values". */
  field(path: string): DnaField;
  /** Names of the fields of a record; without a path, of the layers. */
  children(path?: string): string[];
  /** A string, a number or a copy of an array: Float32Array of floats, Float64Array of integers. */
  read(path: string): string | number | Float32Array | Float64Array;
  /** The bytes of a DNA file. */
  write(desc?: WriteDesc): Uint8Array;
}
export const Dna: { readonly prototype: Dna };

/** A joint, mesh, channel or control: its name or its number. */
type NameOrNumber = string | number;

/** A DNA file that can be changed: its fields by the paths of Dna.field(), and as a whole by operations that keep
 * together what refers to each other. A call that throws changes nothing. What is not changed stays as it was,
 * byte for byte. docs/editing.md says what the operations do. */
export interface Document extends Handle {
  field(path: string): DnaField;
  /** Names of the fields of a record; without a path, of the layers. */
  children(path?: string): string[];
  /** A string, a number or a copy of an array: Float32Array of floats, Float64Array of integers. */
  read(path: string): string | number | Float32Array | Float64Array;
  /** A copy of an array or string as it is in the file: big-endian. */
  bytes(path: string): Uint8Array;
  /** Replaces a string, a number or an array, which takes the length of the value. With `first`, replaces elements of
   * an array from there on. */
  write(path: string, value: string | number | Numbers | Integers, first?: number): void;
  /** Replaces `removed` elements of an array or list by `inserted` new ones: zeros, empty strings or records of
   * these. What refers to elements by number stays as it is. */
  splice(path: string, first: number, removed: number, inserted: number): void;
  /** Gives an array or list `count` elements, at its end. */
  resize(path: string, count: number): void;

  /** The document becomes a file of version 2.`version`. */
  readonly version: number;
  /** The list of layers; those of unknown kinds have bytes. */
  readonly layers: readonly (DnaLayer & { readonly bytes: Uint8Array })[];
  /** Makes the list of layers empty: those of unknown kinds are gone, fields stay. Default: the same version. */
  clearLayers(version?: number): void;
  /** Appends a layer to the list: of a known kind without bytes, or of another one with its bytes. */
  addLayer(code: string, versionMajor: number, versionMinor: number, bytes?: Uint8Array): void;

  /** Remembers the current state, for undo(). */
  mark(): number;
  /** Goes back to the state at a mark, or to the beginning. */
  undo(mark?: number): void;

  /** Number of the element that has a name. */
  find(kind: Kind, element: NameOrNumber): number;
  rename(kind: Kind, element: NameOrNumber, name: string): void;
  /** Removes controls, joints, blend shape channels, animated maps or meshes, and what refers to them. Children and
   * skin weights of joints go to the nearest ancestor that stays. */
  remove(kind: Kind, elements: NameOrNumber | Iterable<NameOrNumber>): void;
  /** Removes all blend shape channels with their targets, all animated maps, or, of Kind.JOINT, all that moves
   * joints. */
  clear(kind: Kind): void;
  /** Removes what moves these joints. */
  clearJoints(joints: NameOrNumber | Iterable<NameOrNumber>): void;

  /** Sets neutral transforms relative to the parents, from a joint on: three numbers for each. */
  setNeutral(firstJoint: NameOrNumber, transforms: { translations?: Numbers; rotations?: Numbers }): void;
  /** Sets all positions of a mesh, three numbers each. Normals stay as they are. */
  setPositions(mesh: NameOrNumber, positions: Numbers): void;
  /** Sets the target of a channel on a mesh: deltas of the positions `vertices`, or of the first ones, three numbers
   * each. Deltas of zero are left out; without any other the target is removed. */
  setTarget(mesh: NameOrNumber, channel: NameOrNumber, deltas: Numbers, vertices?: Integers | null): void;
  /** Removes deltas not longer than this, and targets that have none left. */
  pruneTargets(tolerance: number): PrunedTargets;
  /** Sets entries of the joint matrix not above these to 0, and measures what that does to the positions of LOD 0. */
  pruneJoints(limits: PruneJointsDesc): PrunedJoints;
  /** Sets the skin weights of a mesh: `influences` joints and weights for each position. */
  setWeights(mesh: NameOrNumber, influences: number, joints: Integers, weights: Numbers): void;
  /** Scales the weights of each position of a mesh to a sum of 1. */
  normalizeWeights(mesh: NameOrNumber): void;
  /** Keeps the largest weights of each position of a mesh. */
  limitInfluences(mesh: NameOrNumber, influences: number): void;
  /** Mixes the weights of each position with the mean of its neighbors along edges. Default: once, by 0.5, at most 8
   * influences. */
  smoothWeights(mesh: NameOrNumber, options?: { iterations?: number; strength?: number; influences?: number }): void;
  /** Scales the whole character about the origin, then rotates it, then moves it. */
  place(placement: Placement): void;
  /** Keeps these LODs, renumbered from 0. */
  keepLods(lods: Iterable<number>): void;
  /** Converts to the axes, units and winding of a system. */
  convert(system: string | CoordinateSystem): void;

  /** Copies Layers of another document, combined with |. */
  copyLayers(from: Document, layers: number): void;
  /** Copies a mesh of another document, over the one of that name or as a new one; returns its number here. */
  copyMesh(from: Document, mesh: NameOrNumber): number;
  /** Adds the joints of another document that this one lacks. Joints that both have must stand in the same place,
   * within `tolerance` (default 0.001). */
  mergeJoints(from: Document, tolerance?: number): void;
  /** Removes the joints that another document does not have. */
  splitJoints(from: Document): void;
  /** Gives a mesh the skin weights and targets of another one; returns the largest distance to a place on it. */
  project(mesh: NameOrNumber, source: NameOrNumber, options?: ProjectDesc): number;
  /** The same for all meshes of a LOD, from the meshes of LOD `source` whose names differ only in the number of the
   * LOD. */
  makeLod(lod: number, source: number, options?: ProjectDesc): number;
  /** Gives a mesh new positions and lets joints, targets and, unless `others` is false, the other meshes follow. */
  conform(mesh: NameOrNumber, positions: Numbers, options?: { others?: boolean }): Conformed;
  /** Gives the character the rig of a template: controls, joints, behavior and LODs. It keeps its shape. Returns what
   * raw controls that both have do differently. */
  transplant(rig: Document, options?: TransplantDesc): ControlError[];

  /** The document as an open file, checked as files are. */
  toDna(): Dna;
  /** The bytes of that file. */
  toBytes(desc?: WriteDesc): Uint8Array;
  /** What is wrong with the document. */
  validate(): Report;
}
export const Document: { readonly prototype: Document };

/** The behavior of a file, shared by any number of characters. */
export interface Rig extends Handle {
  readonly info: RigInfo;
  /** Disposed with the rig; null: there are no meshes. */
  readonly deformer: Deformer | null;
  /** Metadata of the DNA file; empty for baked files. */
  readonly metadata: ReadonlyMap<string, string>;
  count(kind: Kind): number;
  name(kind: Kind, index: number): string;
  names(kind: Kind): readonly string[];
  /** Index of a name, with or without its prefix ("jawOpen", "CTRL_expressions.jawOpen"); undefined: none. */
  find(kind: Kind, name: string): number | undefined;
  /** Index of exactly this name; throws if there is none. */
  indexOf(kind: Kind, name: string): number;
  /** What a name of another tool means on this rig, "AU12_L" or "mouthSmileLeft" for "mouthSmile_L"; undefined: nothing. */
  match(name: string): { how: NameMatch; shares: ControlShare[] } | undefined;
  /** Joints, blend shape channels, animated maps, meshes or RBF solvers of a LOD. */
  lodIndices(kind: Kind, lod: number): Uint16Array;
  /** Joint values that evaluation may change at a LOD. */
  variableJointValues(lod: number): Uint16Array;
  /** One index per joint. A root is its own parent. */
  readonly jointParents: Uint16Array;
  /** In the order of the joint values. */
  readonly neutralJointValues: Float32Array;
  readonly initialRawControls: Float32Array;
  /** Indices into Instance.allControls. */
  psdInputs(psd: number): Uint16Array;
  statistics(lod: number): RigStatistics;
  /** A character. */
  instance(): Instance;
  batch(desc?: BatchDesc): Batch;
  batchBytes(desc?: BatchDesc): number;
  /** What finds controls for captured motion. Measures the effect of each control, which takes up to some seconds for
   * large rigs. Not in the module that opens baked files only. */
  fit(options?: FitOptions): Fit;
  /** Layers, reactions and guards for characters of this rig. */
  mix(options?: MixOptions): Mix;
  /** Pairs of raw controls that the two halves of one GUI control drive, for MixOptions.antagonists. */
  antagonists(): Antagonists[];
  /** Of each curve the share of its joint motion that is of some joint groups, for masks of layers. Those that
   * move no joint have `otherwise`. */
  groupMask(groups: readonly number[], options?: { otherwise?: number; curveCount?: number }): Float32Array;
  /** Meshes with other options. `dna` is the file that the rig was made from. */
  createDeformer(dna: Dna, desc?: DeformerDesc): Deformer;
  /** The bytes of a baked file; null: without meshes. */
  bake(deformer?: Deformer | null): Uint8Array;
}
export const Rig: { readonly prototype: Rig };

/** One character: its controls, and the results of its last evaluation. */
export interface Instance extends Handle {
  readonly rig: Rig;
  /** Raw controls by name, with or without prefix: face.controls.jawOpen = 1. */
  readonly controls: Controls;
  /** GUI controls by name; mapGuiToRaw() applies them. */
  readonly gui: Controls;
  /** To be written, as controls: indices are those of rig.names(Kind.RAW_CONTROL). */
  readonly rawControls: Float32Array;
  readonly guiControls: Float32Array;
  readonly mlMasks: Float32Array;
  /** Raw, PSD, ML and RBF controls. */
  readonly allControls: Float32Array;
  readonly psdControls: Float32Array;
  readonly mlControls: Float32Array;
  readonly rbfControls: Float32Array;
  /** 9 or 10 values per joint, deltas from the neutral pose. */
  readonly joints: Float32Array;
  /** One weight per blend shape channel. */
  readonly blendShapes: Float32Array;
  /** One weight per animated map. */
  readonly animatedMaps: Float32Array;
  readonly statistics: InstanceStatistics;
  /** To the initial state: all inputs and results. */
  reset(): void;
  mapGuiToRaw(): void;
  mapRawToGui(): void;
  /** Evaluates at a LOD: all stages, or those of Stage combined with |. */
  evaluate(lod?: number, stages?: Stage): void;
  evaluateJointGroup(lod: number, group: number): void;
  evaluateRbfSolver(lod: number, solver: number): void;
  evaluateTwistSwing(lod: number, setup: number): void;
}
export const Instance: { readonly prototype: Instance };

/** Evaluates many instances of a rig in one call, with the bits of one by one. */
export interface Batch extends Handle {
  evaluate(instances: readonly Instance[], lods?: number | readonly number[], stages?: Stage): void;
}
export const Batch: { readonly prototype: Batch };

/** The meshes of a rig, shared by any number of characters. */
export interface Deformer extends Handle {
  readonly info: DeformerInfo;
  /** A neutral mesh. */
  mesh(index: number): Mesh;
  /** The number of vertices of each mesh. */
  readonly vertexCounts: readonly number[];
  /** A copy of the triangles, three vertices each, with any storage. */
  triangles(mesh: number): Uint32Array;
  /** A copy of the texture coordinates, u v per vertex, with any storage. */
  textureCoordinates(mesh: number): Float32Array;
  influences(mesh: number, position: number): { joints: Uint16Array; weights: Float32Array };
  /** A copy of a blend shape target: three floats per position. */
  target(mesh: number, target: number): Float32Array;
  /** A deformer of some positions of one mesh, ascending: position i of that mesh is `positions[i]` of this one's. It
   * has no vertices or triangles, all its other meshes are empty, and deforming takes time for the chosen positions
   * only. Keeps the memory of this deformer, which may be disposed. */
  subset(mesh: number, positions: Integers): Deformer;
  /** 16 floats per joint, column by column. */
  readonly bindMatrices: Float32Array;
  readonly inverseBindMatrices: Float32Array;
  /** A character. */
  instance(desc?: DeformerInstanceDesc): DeformerInstance;
  /** Of each curve of a mix its counterpart in the other half of the face, for MixOptions.mirror. */
  mirror(curveCount: number): Uint16Array;
  /** Measures which raw controls turn the eyes. */
  gaze(desc?: GazeDesc): Gaze;
  /** Solvers, in the order in which they run. */
  solvers(solvers: readonly Solver[], desc?: Omit<SolverStackDesc, "solvers" | "solverCount">): SolverStack;
}
export const Deformer: { readonly prototype: Deformer };

/** The matrices and vertices of one character. */
export interface DeformerInstance extends Handle {
  /** Takes over the results of the last evaluation and computes the matrices of all joints. */
  update(instance: Instance): void;
  updateFromValues(jointValues?: ArrayLike<number>, channelWeights?: ArrayLike<number>): void;
  /** Model matrices, 16 floats per joint, column by column. */
  readonly jointMatrices: Float32Array;
  /** For skinning on the GPU: 16 floats per joint, column by column. */
  readonly skinMatrices: Float32Array;
  /** A copy: tx ty tz qx qy qz qw sx sy sz per joint, relative to the parents. */
  readonly localTransforms: Float32Array;
  /** Computes positions and normals of a mesh for the last update. */
  deform(mesh: number, normals?: Normals): void;
  /** Three floats per position. */
  positions(mesh: number): Float32Array;
  /** Three floats per vertex. */
  normals(mesh: number): Float32Array;
  /** Deforms a mesh and copies positions and normals of its vertices, three floats each, to these arrays, which
   * have room for all of them: 3 * `deformer.vertexCounts[mesh]` floats. */
  writeVertices(mesh: number, positions: Float32Array, normals?: Float32Array | null, kind?: Normals): void;
}
export const DeformerInstance: { readonly prototype: DeformerInstance };

/** Curves of named channels at a constant frame rate. */
export interface Clip extends Handle {
  readonly info: ClipInfo;
  /** In seconds. */
  readonly duration: number;
  readonly channels: readonly ClipChannel[];
  readonly events: readonly ClipEvent[];
  findChannel(name: string): number;
  /** Throws if a byte has changed or a curve cannot be decoded. */
  verify(): void;
  /** A copy of frames, one after the other. */
  read(firstFrame?: number, frameCount?: number): Float32Array;
  /** The bytes of the clip. */
  write(): Uint8Array;
  player(desc?: ClipPlayerDesc): ClipPlayer;
  /** Maps channels to raw controls, by names. */
  bind(rig: Rig, desc?: ClipBindingDesc): ClipBinding;
}
export const Clip: { readonly prototype: Clip };

/** Plays a clip for one character. Times are in ticks: Math.round(seconds * TICKS_PER_SECOND). */
export interface ClipPlayer extends Handle {
  readonly info: ClipPlayerInfo;
  seek(tick: number): void;
  setSpeed(numerator: number, denominator?: number): void;
  advance(ticks: number): void;
  /** The events that the last advance() passed, each once. */
  events(): Generator<ClipEvent>;
  /** One float per channel. */
  sample(): Float32Array;
}
export const ClipPlayer: { readonly prototype: ClipPlayer };

export interface BindingInfo {
  readonly channelCount: number;
  readonly rawControlCount: number;
  readonly missingEntryCount: number;
  /** Raw controls that the clip drives. */
  readonly controls: Uint16Array;
  /** Raw controls that it does not drive. */
  readonly extraControls: Uint16Array;
  /** Channels that drive nothing. */
  readonly missingChannels: Uint16Array;
}

export interface ClipBinding extends Handle {
  readonly info: BindingInfo;
  /** Sets the raw controls that the clip drives. `values` are those of a player. */
  apply(values: Float32Array, instance: Instance): void;
  /** For ClipDesc.snaps: the coarsest steps of which half moves no vertex by more than `tolerance` millimeters, 0.02
   * unless given. */
  findSnaps(deformer: Deformer, tolerance?: number): Float32Array;
}
export const ClipBinding: { readonly prototype: ClipBinding };

// ---- mixing ----------------------------------------------------------------------------------------------

/** Seconds in the unit of all times. */
export declare function ticks(seconds: number): number;

/** A raw control or pose variable: its name, or its number among the curves of a mix. */
export type Curve = string | number;

/** Values of the curves that a pose moves: { mouthSmileLeft: 0.8 }. */
export type Pose = Readonly<Record<string, number>>;

/** Weights of curves, 0 to 1: { jawOpen: 0.5 }, or names alone for 1, others are 0; or one number for each curve. */
export type Mask = readonly string[] | Readonly<Record<string, number>> | readonly number[] | Float32Array;

export interface LayerOptions {
  group?: LayerGroup;
  mode?: BlendMode;
  /** Initial weight, 0 to 1; with BlendMode.ADD -1 to 1. Default: 1. */
  weight?: number;
  /** Default: 1 for all curves. */
  mask?: Mask;
  /** Acts after the guards; not for base and speech. */
  afterGuards?: boolean;
}

/** A layer of a mix, as MixLayer makes it. */
export interface MixLayer extends LayerOptions,
  Omit<MixLayerDesc, "mask" | "maskCount" | "curves" | "curveCount" | "firstPose" | "poseCount" | keyof LayerOptions> {
  source: LayerSource;
  poses?: readonly Pose[];
  curves?: readonly Curve[];
  amounts?: readonly number[];
}

/** Makes layers, with the group and mode that each usually has. */
export declare const MixLayer: {
  /** Plays clips: mixer.play(). Base, override. */
  clip(options?: LayerOptions): MixLayer;
  /** A weighted sum of poses: mixer.setPoseWeight(). Emotion, screen. */
  poses(poses: readonly Pose[], options?: LayerOptions): MixLayer;
  /** Rows that arrive from outside, a value for each of these curves: mixer.push(). Base, override. `delay` in
   * ticks hides jitter; `streamFrames` is how many rows can be queued, 0 means 64. */
  stream(curves: readonly Curve[], options?: LayerOptions & { delay?: number; streamFrames?: number }): MixLayer;
  /** Blinks, breath or noise for curves, scaled by their amounts; `period` in ticks. Life, add. */
  generator(generator: GeneratorKind, amounts: Pose, options: LayerOptions & { period: number }): MixLayer;
  /** Turns the eyes to a place, by MixOptions.gaze. `target`: three curves, usually pose variables, millimeters to
   * the left, up and to the front. `head`: two curves with factors, which get what is left for the head. `jitter`:
   * degrees across and up; `period` is its time, by default a quarter of a second. Life. */
  gaze(target: readonly Curve[], options?: Omit<LayerOptions, "mode"> & {
    head?: Pose; jitter?: readonly [number, number]; period?: number;
  }): MixLayer;
};

/** A part of a reaction: moves curves to a pose and back. */
export interface Stroke extends Omit<MixStroke, "pose"> {
  pose: Pose;
}

/** What a face does in response to a stimulus: mixer.trigger(). `adapted` is 1 by default. */
export interface Reaction extends Omit<MixReaction, "strokes" | "strokeCount"> {
  strokes: readonly Stroke[];
}

/** Two curves that move the face in opposite directions. */
export interface Antagonists {
  first: Curve;
  second: Curve;
  /** Default: 1. */
  stiffness?: number;
}

/** A place of a face: the middle of some positions of a mesh that LOD 0 shows, or without mesh of some joints. */
export interface Landmark {
  points: readonly number[] | Uint32Array;
  mesh?: number | null;
}

/** A guard for landmarks of yours: the distance of `upper` above `lower` must not be opened. */
export interface CustomGuard {
  upper: Landmark;
  lower: Landmark;
  /** Raw control that makes both touch at 1. null: they do at rest. */
  closedBy?: Curve | null;
  needsSpeech?: boolean;
  /** Millimeters by which later layers may open. Default: 0.3. */
  tolerance?: number;
  /** Acts where base and speech open by less millimeters. Default: 12. */
  fOn?: number;
}

export interface MixOptions extends Pick<MixDesc,
  "guards" | "playerCount" | "maxChannels" | "maxChangingChannels" | "maxEvents" | "reverse"> {
  layers?: readonly MixLayer[];
  reactions?: readonly Reaction[];
  /** Such as rig.antagonists(). */
  antagonists?: readonly Antagonists[];
  customGuards?: readonly CustomGuard[];
  /** Names of pose variables, curves behind the raw controls. */
  variables?: readonly string[];
  /** Limits, one for all curves or one for each; both or neither. */
  lower?: number | readonly number[] | Float32Array;
  upper?: number | readonly number[] | Float32Array;
  /** Per curve its counterpart, such as deformer.mirror(). Without it nothing can be played mirrored. */
  mirror?: readonly number[] | Uint16Array;
  /** For a layer of MixLayer.gaze. */
  gaze?: Gaze;
  /** What guards are measured on, which takes time. Default: the deformer of the rig. */
  deformer?: Deformer;
}

/** What is mixed for one rig, and how. Serves any number of mixers. */
export interface Mix extends Handle {
  readonly info: MixInfo;
  /** Numbers of the pose variables by name. */
  readonly variables: ReadonlyMap<string, number>;
  /** A guard as it was measured, by its number from 0 on; a copy. */
  guard(index: number): MixGuardInfo;
  /** A character. */
  mixer(desc?: MixerDesc): Mixer;
  /** The bytes of a file, for Mien.openMix(): what was given and what was measured, so guards need no meshes. Names of
   * pose variables are not in it. */
  write(): Uint8Array;
  /** The same as text, for people and version control. */
  toText(): string;
}
export const Mix: { readonly prototype: Mix };

/** An event of a clip that a step passed. */
export interface MixerEvent extends ClipEvent {
  readonly layer: number;
}

/** A clip that restore() may need. */
export interface MixerClip {
  /** As in play(). */
  clipId?: number | bigint;
  clip: Clip;
  binding: ClipBinding;
}

/** One character in a mix. Times are in ticks: ticks(0.5) is half a second. */
export interface Mixer extends Handle {
  readonly mix: Mix;
  /** Plays a clip in a layer, from the next step on. The transition from what the layer plays takes a quarter of a
   * second unless desc says otherwise. Clip and binding may be disposed afterwards. */
  play(layer: number, clip: Clip, binding: ClipBinding, desc?: PlayDesc): void;
  /** Fades out the clip of a layer and ends it. */
  stop(layer: number, fadeTicks?: number): void;
  setWeight(layer: number, weight: number, fadeTicks?: number): void;
  /** `pose` counts from the first one of its layer. */
  setPoseWeight(layer: number, pose: number, weight: number, fadeTicks?: number): void;
  /** The value that a pose variable has at the start of each step. */
  setVariable(variable: Curve, value: number): void;
  /** How much a guard acts, 0 to 1; negative: as it finds by itself. */
  setGuard(guard: number, activation: number): void;
  /** What a guard did in the last step; a copy. */
  guard(index: number): GuardState;
  /** Starts a reaction to a stimulus that lasts `holdTicks`; if negative, until release(). */
  trigger(reaction: number, strength?: number, holdTicks?: number): void;
  release(reaction: number): void;
  /** The level, 0 to 1, of what a reaction responds to: from `levelOn` on a stimulus, which ends when it was below
   * `levelOff` for 50 ms. */
  setLevel(reaction: number, level: number): void;
  /** Queues a row for a stream layer, for a time of the mixer. false: it is not newer than the last one, or the
   * queue is full. */
  push(layer: number, tick: number, values: ArrayLike<number>): boolean;
  /** Advances and mixes; raw controls go to the instance. */
  step(ticks: number, instance?: Instance | null): void;
  /** Events of clips that the last step passed. */
  readonly events: readonly MixerEvent[];
  /** What the last step gave: raw controls, then pose variables. */
  readonly row: Float32Array;
  /** The row after a stage of the last step: the layers, reactions, guards, antagonists, limits. Needs
   * mix.mixer({ stages: 1 }). */
  stage(index: number): Float32Array;
  readonly info: MixerInfo;
  /** All that later steps depend on, except queued rows of streams. */
  snapshot(): Uint8Array;
  /** Goes on from a snapshot of a mixer of the same mix, to the bit. `clips`: those that may be playing. */
  restore(bytes: Uint8Array, clips?: readonly MixerClip[]): void;
}
export const Mixer: {
  readonly prototype: Mixer;
  /** Steps several mixers, with an instance for each or none: the results of single calls. */
  stepAll(mixers: readonly Mixer[], ticks: number, instances?: readonly Instance[] | null): void;
};

/** Which raw controls turn the eyes of a rig, and how far. */
export interface Gaze extends Handle {
  /** Where the eyes are. */
  readonly info: GazeInfo;
  /** Sets the raw controls of an instance so that both eyes look at a place, in millimeters. Returns what is
   * beyond the reach of the eyes, for the head to turn: tangents of angles. */
  lookAt(target: GazeTarget, instance: Instance): GazeRest;
}
export const Gaze: { readonly prototype: Gaze };

// ---- fits ------------------------------------------------------------------------------------------------

/** A position of a mesh, or the weighted sum of three. */
export type FitPoint =
  | number
  | { positions: readonly [number, number, number]; weights: readonly [number, number, number]; mesh?: number };

/** How to create a fit. Raw controls are given by name or index. */
export interface FitOptions {
  /** Of the rig; by default its own one, if there are points. */
  deformer?: Deformer | null;
  /** Raw controls that may move; by default all. */
  controls?: readonly (string | number)[] | Uint32Array;
  /** Bounds of these controls, by default 0 and 1: one for all, or one for each. */
  lower?: number | Numbers;
  upper?: number | Numbers;
  /** Pairs of raw controls that are kept similar: left and right. */
  symmetric?: readonly (readonly [string | number, string | number])[];
  /** The mesh of points that do not name another. */
  mesh?: number;
  /** Points to match. Without any, joint values are matched. */
  points?: readonly FitPoint[] | Uint32Array;
  /** Per joint value, 0 or more. By default 1 each, or 0 if there are points. */
  jointWeights?: Numbers;
  lod?: number;
}

/** The targets of a frame, NaN where they are missing, and the weights of the terms, which are left out if 0.
 * Targets of several kinds may be given together: a point may have one of each. */
export interface FitFrame extends Omit<FitFrameDesc, "user" | "canceled" | "surface" | "camera" | "constraintCount" | "constraints"> {
  /** As images were taken. */
  camera?: FitCamera;
  /** Each point is drawn to the nearest place of the surface. */
  surface?: FitSurface;
  /** Up to 64, added to all other targets. Their weight is 1 by default. */
  constraints?: readonly FitConstraint[];
  /** Is called before each iteration; the solve stops if it returns true. What it throws comes out as it is. */
  canceled?: () => boolean | void;
}

/** The controls of a frame, and how well they explain it. */
export interface FitResult extends FitResultDesc {
  /** All raw controls, for Instance.rawControls.set(); a copy. */
  readonly controls: Float32Array;
}

/** A scan, or a mesh of another topology, as a target. */
export interface FitSurface extends Handle {}
export const FitSurface: { readonly prototype: FitSurface };

/** Finds the raw controls of a rig that give captured joints, points, images or surfaces; docs/solving.md has the
 * formulas. Keeps the memory of its rig. */
export interface Fit extends Handle {
  /** Deterministic unless there is a limit of time. */
  solve(frame: FitFrame): FitResult;
  /** Solves frames of a motion, each from the result of the one before. `joints`, `points`, `images`,
   * `pointWeights` and `surfaceWeights` have a row for each frame, one after the other; all else is for all frames.
   * `start` and `stages` are for the first frame, and so is `camera`, if it may move. Where joints are the only
   * targets, this is faster than calls of solve(), and differs from them by rounding. `canceled` is asked in each frame; frames after the one that
   * it stopped are solved unless it goes on returning true. */
  solveFrames(frame: FitFrame, count: number): FitResult[];
  /** How well the data determines each raw control at the initial pose, 0 to 1; a copy. */
  readonly observability: Float32Array;
}
export const Fit: { readonly prototype: Fit };

// ---- solvers ---------------------------------------------------------------------------------------------

/** What a custom solver sees of one character: views, for the time of the call. */
export interface SolverPose {
  /** Per joint tx ty tz qx qy qz qw sx sy sz, relative to the parent; to be changed for its `writes`. */
  readonly locals: Float32Array;
  /** Model matrices, 16 floats per joint, column by column. */
  readonly models: Float32Array;
  /** Those of its `previousJoints` after the last step. */
  readonly previous: Float32Array;
  readonly row: Float32Array;
  /** To be written. */
  readonly outputs: Float32Array;
  /** To be written; zeros at first. */
  readonly state: Float32Array;
  readonly lod: number;
  /** The first step, or the character was moved to another place. */
  readonly isReset: boolean;
}

/** A function of yours. What it throws comes out of the step. */
export interface CustomSolver {
  /** Changes the locals of the joints in `writes`. */
  solve(poses: readonly SolverPose[], ticks: number): void;
  writes: readonly number[];
  reads?: readonly number[];
  previousJoints?: readonly number[];
  /** Length of SolverPose.state. */
  stateFloats?: number;
  /** Length of SolverPose.outputs. */
  outputCount?: number;
}

/** `weight` is 1 by default; without `targetJoint` the target is at three curves of the row. */
export interface AimSolver extends Omit<AimSolverDesc, "targetJoint"> {
  targetJoint?: number | null;
}

/** Lets a joint hang on one of some joints, which a curve of the row chooses. null: model space. */
export interface SpaceSolver {
  joint: number;
  spaces: readonly (number | null)[];
  curve: number;
  easeTicks?: number;
}

interface SolverKinds {
  aim: AimSolver;
  space: SpaceSolver;
  spring: SpringSolver;
  twist: TwistSolver;
  /** `weight` is 1 by default. */
  copy: CopySolverDesc;
  custom: CustomSolver;
}

/** One kind of solver: { spring: { joint, frequency: 3, damping: 0.3 } }. */
export type Solver = {
  [K in keyof SolverKinds]: { [L in K]: SolverKinds[L] } & { [L in Exclude<keyof SolverKinds, K>]?: undefined } & {
    /** For messages. */
    name?: string;
    /** Bit l: runs at LOD l. Default: at all. */
    lods?: number;
  };
}[keyof SolverKinds];

/** Solvers of one deformer. Serves any number of characters. */
export interface SolverStack extends Handle {
  readonly info: SolverStackInfo;
  /** A character. */
  state(): SolverState;
}
export const SolverStack: { readonly prototype: SolverStack };

/** What the solvers of one character remember. */
export interface SolverState extends Handle {
  /** Runs the solvers on a pose, which pose.update() has to set before every step. */
  step(pose: DeformerInstance, ticks: number, input?: SolverInput): void;
  /** What a solver has published in the last step. */
  outputs(solver: number): Float32Array;
  /** After the last step: tx ty tz qx qy qz qw sx sy sz per joint, relative to the parents. */
  readonly transforms: Float32Array;
  /** Of a stack with `checkWrites`: the solver that changed a joint which is not in its list in the last step, or "". */
  readonly undeclared: string;
}
export const SolverState: {
  readonly prototype: SolverState;
  /** Steps states of one stack, each with its pose and input: the results of single calls. */
  stepAll(states: readonly SolverState[], poses: readonly DeformerInstance[], ticks: number,
    inputs?: readonly SolverInput[] | null): void;
};
