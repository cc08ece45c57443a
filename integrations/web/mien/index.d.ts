// SPDX-License-Identifier: MIT
// Mien in JavaScript: facial rigs in browsers, workers and Node.js.
//
//     DNA file or baked file -> Rig -> Instance          controls in; joint values, weights out
//                                 \ -> Deformer -> DeformerInstance   matrices and vertices
//
// Objects have memory in the module, which is released by dispose() or `using`, never by itself. Typed arrays
// are views of that memory. When it grows, old views become empty; properties and methods make new ones, so
// read them again in each frame, and copy with slice() what you keep. Failures throw a MienError. Descriptions
// of options, units and formulas are those of mien.h, in api.d.ts.
import type {
  BatchDesc, ClipBindingDesc, ClipChannel, ClipDesc, ClipEvent, ClipInfo, ClipPlayerDesc, ClipPlayerInfo,
  CoordinateSystem, DeformerDesc, DeformerInfo, DeformerInstanceDesc, DnaDesc, DnaField, DnaInfo, DnaLayer,
  Exports, Finding, GenerateDesc, InstanceStatistics, Isa, Kind, Mesh, Normals, Preset, Reuse, RigDesc, RigInfo,
  RigStatistics, Stage, Status, WriteDesc, BakedCheck,
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
  /** Load the smaller module, which opens baked files only. */
  bakedOnly?: boolean;
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
  /** Checks the bytes of a DNA file and lists what is wrong with them. */
  validate(source: Source): Promise<Report>;
  /** Generates a rig: generate(Preset.HEAD) is a head to look at. */
  generate(preset: Preset, options?: Omit<GenerateDesc, "preset">): Dna;
  /** The rig of an open DNA file, which may be disposed afterwards. */
  createRig(dna: Dna, options?: CreateRigOptions): Rig;
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
  influences(mesh: number, position: number): { joints: Uint16Array; weights: Float32Array };
  /** A copy of a blend shape target: three floats per position. */
  target(mesh: number, target: number): Float32Array;
  /** 16 floats per joint, column by column. */
  readonly bindMatrices: Float32Array;
  readonly inverseBindMatrices: Float32Array;
  /** A character. */
  instance(desc?: DeformerInstanceDesc): DeformerInstance;
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
  /** Deforms a mesh and copies positions and normals of its vertices, three floats each, to these arrays. */
  writeVertices(mesh: number, vertexCount: number, positions: Float32Array, normals?: Float32Array | null,
    kind?: Normals): void;
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
}
export const ClipBinding: { readonly prototype: ClipBinding };
