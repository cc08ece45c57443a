// SPDX-License-Identifier: MIT
// Meshes: the deformer of a rig, its neutral meshes, and the deformed ones of a character.
import { Normals, Status } from "./api.js";
import { errorOf } from "./errors.js";
import { Handle, makeHandle } from "./handle.js";
import { findMirror, Gaze } from "./mix.js";
import { SolverStack } from "./solve.js";

export class Deformer extends Handle {
  #info;
  #vertexCounts;

  static create(memory, dna, rig, desc = {}) {
    return new Deformer(memory, makeHandle(memory, (out, error, scratch) =>
      memory.exports.mien_deformer_create(memory.handleOf(dna), memory.handleOf(rig), scratch.struct("DeformerDesc", desc), out, error)));
  }

  static fromBaked(memory, baked, rig, desc) {
    return new Deformer(memory, makeHandle(memory, (out, error, scratch) =>
      memory.exports.mien_deformer_from_baked(memory.handleOf(baked), memory.handleOf(rig),
        scratch.struct("BakedDeformerDesc", desc), out, error)));
  }

  constructor(memory, handle) {
    super(memory, handle, "mien_deformer_destroy");
  }

  get info() {
    return (this.#info ??= this.struct("mien_deformer_info", "DeformerInfo"));
  }

  /** A neutral mesh. Its arrays are views until memory grows: ask again, or copy what is kept. */
  mesh(index) {
    return this.struct("mien_deformer_mesh", "Mesh", index);
  }

  /** The vertices of each mesh. */
  get vertexCounts() {
    return (this.#vertexCounts ??= Array.from({ length: this.info.meshCount }, (_, i) => this.mesh(i).vertexCount));
  }

  /** Joints and weights of a position. */
  influences(mesh, position) {
    const { memory } = this;
    return memory.withScratch((scratch) => {
      const out = scratch.take(16);
      this.call("mien_deformer_influences", mesh, position, out, out + 8);
      const at = (offset) => memory.data.getUint32(out + offset, true);
      return { joints: memory.array("u16", at(0), at(4)), weights: memory.array("f32", at(8), at(12)) };
    });
  }

  /** A copy of the triangles of a mesh, three vertices each, with any storage. */
  triangles(mesh) {
    return this.#copy("u32", "mien_deformer_triangles", mesh, 3 * this.mesh(mesh).triangleCount);
  }

  /** A copy of the texture coordinates of a mesh, u v per vertex, with any storage. */
  textureCoordinates(mesh) {
    return this.#copy("f32", "mien_deformer_texture_coordinates", mesh, 2 * this.mesh(mesh).vertexCount);
  }

  #copy(type, name, mesh, count) {
    const { memory } = this;
    return memory.withScratch((scratch) => {
      const out = scratch.take(Math.max(1, count) * 4);
      this.call(name, mesh, out, count);
      return memory.array(type, out, count).slice();
    });
  }

  /** A copy of a blend shape target: three floats per position. */
  target(mesh, target) {
    const { memory } = this;
    const count = 3 * this.mesh(mesh).positionCount;
    return memory.withScratch((scratch) => {
      const out = scratch.take(Math.max(1, count) * 4);
      this.call("mien_deformer_target", mesh, target, out, count);
      return memory.array("f32", out, count).slice();
    });
  }

  /** A deformer of some positions of one mesh, ascending, which keeps the memory of this one. */
  subset(mesh, positions) {
    if (!ArrayBuffer.isView(positions) && !Array.isArray(positions)) throw new TypeError("positions is no array of numbers");
    const { memory } = this;
    return new Deformer(memory, makeHandle(memory, (out, error, scratch) => memory.exports.mien_deformer_create_subset(
      this.handle, mesh, scratch.array("u32", positions), positions.length, 0, out, error)));
  }

  get bindMatrices() {
    return this.view("f32", "mien_deformer_bind_matrices");
  }

  get inverseBindMatrices() {
    return this.view("f32", "mien_deformer_inverse_bind_matrices");
  }

  /** A character; `lods` are the LODs that it takes memory for: 0b1 for LOD 0 only. */
  instance(desc = {}) {
    return new DeformerInstance(this.memory, this, desc);
  }

  mirror(curveCount) {
    return findMirror(this.memory, this, curveCount);
  }

  gaze(desc = {}) {
    return Gaze.create(this.memory, this, desc);
  }

  solvers(solvers, desc = {}) {
    return SolverStack.create(this.memory, this, solvers, desc);
  }
}

export class DeformerInstance extends Handle {
  #jointCount;
  #vertexCounts;
  #output = 0;
  #outputBytes = 0;

  constructor(memory, deformer, desc) {
    super(memory, makeHandle(memory, (out, error, scratch) =>
      memory.exports.mien_deformer_instance_create(memory.handleOf(deformer),
        scratch.struct("DeformerInstanceDesc", desc), out, error)),
    "mien_deformer_instance_destroy");
    this.#jointCount = deformer.info.jointCount;
    this.#vertexCounts = deformer.vertexCounts;
  }

  dispose() {
    super.dispose();
    this.memory.exports.free(this.#output);
    this.#output = this.#outputBytes = 0;
  }

  /** Takes over the results of an instance and computes all matrices. */
  update(instance) {
    this.call("mien_deformer_instance_update", this.memory.handleOf(instance));
  }

  updateFromValues(jointValues = [], channelWeights = []) {
    this.memory.withScratch((scratch) => {
      const joints = jointValues.length ? scratch.array("f32", jointValues) : 0;
      const weights = channelWeights.length ? scratch.array("f32", channelWeights) : 0;
      this.call("mien_deformer_instance_update_from_values", joints, jointValues.length, weights, channelWeights.length);
    });
  }

  get jointMatrices() {
    return this.view("f32", "mien_deformer_instance_joint_matrices");
  }

  get skinMatrices() {
    return this.view("f32", "mien_deformer_instance_skin_matrices");
  }

  /** Ten floats per joint, tx ty tz qx qy qz qw sx sy sz, relative to the parents; a copy. */
  get localTransforms() {
    const { memory } = this;
    const count = 10 * this.#jointCount;
    return memory.withScratch((scratch) => {
      const out = scratch.take(Math.max(1, count) * 4);
      this.call("mien_deformer_instance_local_transforms", out, count);
      return memory.array("f32", out, count).slice();
    });
  }

  deform(mesh, normals = Normals.DEFAULT) {
    this.call("mien_deformer_instance_deform", mesh, normals, this.memory.parallel);
  }

  positions(mesh) {
    return this.view("f32", "mien_deformer_instance_positions", mesh);
  }

  normals(mesh) {
    return this.view("f32", "mien_deformer_instance_normals", mesh);
  }

  /** Deforms a mesh and copies the positions of its vertices, and their normals, to arrays of three
   * floats per vertex, such as those of buffer attributes. */
  writeVertices(mesh, positions, normals = null, kind = Normals.DEFAULT) {
    const { memory } = this;
    const vertexCapacity = this.#vertexCounts[mesh];
    if (vertexCapacity === undefined) throw errorOf(Status.INDEX, `mesh ${mesh} of ${this.#vertexCounts.length}`);
    const count = 3 * vertexCapacity;
    for (const array of normals ? [positions, normals] : [positions]) {
      if (!(array instanceof Float32Array)) throw new TypeError("vertices are written to a Float32Array");
      if (array.length < count) throw new RangeError(`${array.length} floats for ${vertexCapacity} vertices`);
    }
    // Memory of the module, kept from frame to frame.
    const size = 4 * count;
    if (this.#outputBytes < 2 * size) {
      memory.exports.free(this.#output);
      this.#output = this.#outputBytes = 0;
      this.#output = memory.allocate(2 * size);
      this.#outputBytes = 2 * size;
    }
    memory.withScratch((scratch) => {
      const output = scratch.struct("VertexOutput", {
        vertexCapacity,
        positions: { data: this.#output, stride: 12 },
        normals: normals ? { data: this.#output + size, stride: 12 } : undefined,
      });
      this.call("mien_deformer_instance_write_vertices", mesh, kind, output, memory.parallel);
    });
    positions.set(memory.array("f32", this.#output, count));
    normals?.set(memory.array("f32", this.#output + size, count));
  }
}
