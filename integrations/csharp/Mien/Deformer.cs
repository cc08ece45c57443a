// SPDX-License-Identifier: MIT
using System;
using System.Runtime.InteropServices;
using Mien.Native;

namespace Mien {
  /// <summary>The meshes of a rig. Immutable: serves any number of instances and threads.</summary>
  public sealed unsafe class Deformer : IDisposable {
    readonly DeformerHandle handle;

    /// <summary>For calls of Native.Functions.</summary>
    public DeformerHandle Handle { get { return handle.Open(); } }

    internal Deformer(IntPtr taken, params Handle[] kept) {
      handle = new DeformerHandle(taken, kept);
      handle.AddPressure(Info.DeformerBytes);
    }

    public void Dispose() { handle.Dispose(); }

    /// <summary>The meshes of a DNA, for a rig created from it. The DNA may be disposed afterwards.</summary>
    public static Deformer Create(Dna dna, Rig rig, MienDeformerDesc desc = default(MienDeformerDesc)) {
      MienError error = MienError.Create();
      desc.StructSize = (UIntPtr)sizeof(MienDeformerDesc);
      IntPtr taken;
      MienException.Check(Functions.mien_deformer_create(dna.Handle, rig.Handle, &desc, out taken, &error), ref error,
                          "cannot create the deformer");
      return new Deformer(taken, rig.Handle);
    }

    public MienDeformerInfo Info {
      get {
        MienDeformerInfo info = MienDeformerInfo.Create();
        MienException.Check(Functions.mien_deformer_info(Handle, &info), "info");
        return info;
      }
    }

    /// <summary>A neutral mesh.</summary>
    public Mesh Mesh(int mesh) {
      MienMesh found = MienMesh.Create();
      MienException.Check(Functions.mien_deformer_mesh(Handle, (uint)mesh, &found), "no such mesh");
      return new Mesh(Handle, found);
    }

    /// <summary>The joints that move a position of a mesh, and their weights.</summary>
    public ReadOnlyView<ushort> Influences(int mesh, int position, out ReadOnlyView<float> weights) {
      MienIndex16View joints;
      MienFloatView shares;
      MienException.Check(Functions.mien_deformer_influences(Handle, (uint)mesh, (uint)position, &joints, &shares),
                          "no such mesh or position");
      weights = new ReadOnlyView<float>(Handle, shares.Data, shares.Count);
      return new ReadOnlyView<ushort>(Handle, joints.Data, joints.Count);
    }

    /// <summary>The triangles of a mesh, three vertices each, with any storage.</summary>
    public uint[] Triangles(int mesh) {
      var triangles = new uint[3 * Mesh(mesh).TriangleCount];
      fixed (uint* first = triangles) {
        MienException.Check(Functions.mien_deformer_triangles(Handle, (uint)mesh, first,
                                                              (UIntPtr)triangles.Length), "no such mesh");
      }
      return triangles;
    }

    /// <summary>The texture coordinates of a mesh, u v per vertex, with any storage.</summary>
    public float[] TextureCoordinates(int mesh) {
      var coordinates = new float[2 * Mesh(mesh).VertexCount];
      fixed (float* first = coordinates) {
        MienException.Check(Functions.mien_deformer_texture_coordinates(Handle, (uint)mesh, first,
                                                                        (UIntPtr)coordinates.Length), "no such mesh");
      }
      return coordinates;
    }

    /// <summary>The displacements of a blend shape target of a mesh: x y z per position.</summary>
    public float[] Target(int mesh, int target) {
      var deltas = new float[3 * Mesh(mesh).PositionCount];
      fixed (float* first = deltas) {
        MienException.Check(Functions.mien_deformer_target(Handle, (uint)mesh, (uint)target, first,
                                                           (UIntPtr)deltas.Length), "no such mesh or target");
      }
      return deltas;
    }

    /// <summary>Model matrices of the joints in the neutral pose, 16 numbers each, column by column.</summary>
    public ReadOnlyView<float> BindMatrices {
      get {
        MienFloatView view;
        MienException.Check(Functions.mien_deformer_bind_matrices(Handle, &view), "bind matrices");
        return new ReadOnlyView<float>(Handle, view.Data, view.Count);
      }
    }

    /// <summary>Their inverses.</summary>
    public ReadOnlyView<float> InverseBindMatrices {
      get {
        MienFloatView view;
        MienException.Check(Functions.mien_deformer_inverse_bind_matrices(Handle, &view), "bind matrices");
        return new ReadOnlyView<float>(Handle, view.Data, view.Count);
      }
    }

    /// <summary>A new character in the neutral pose.</summary>
    public DeformerInstance CreateInstance(MienDeformerInstanceDesc desc = default(MienDeformerInstanceDesc)) {
      return new DeformerInstance(this, desc);
    }

    /// <summary>The counterpart of each curve in the other half of the face, for MixDesc.Mirror: raw controls, then
    /// variables. Measures the rig, which takes time.</summary>
    public ushort[] Mirror(int curveCount) {
      if (curveCount < 0) throw new ArgumentOutOfRangeException("curveCount");
      MienError error = MienError.Create();
      var curves = new ushort[curveCount];
      fixed (ushort* first = curves) {
        MienException.Check(Functions.mien_mix_mirror(Handle, first, (UIntPtr)curveCount, &error), ref error,
                            "cannot find counterparts");
      }
      return curves;
    }

    /// <summary>Measures how raw controls turn the eyes, which are joints; null: found by their names.</summary>
    public Gaze CreateGaze(string leftEye = null, string rightEye = null) {
      MienError error = MienError.Create();
      MienGazeDesc desc = MienGazeDesc.Create();
      IntPtr taken;
      using (var scratch = new Scratch()) {
        desc.LeftEye = scratch.Terminated(leftEye);
        desc.RightEye = scratch.Terminated(rightEye);
        MienException.Check(Functions.mien_gaze_create(Handle, &desc, out taken, &error), ref error,
                            "cannot create a gaze");
      }
      return new Gaze(taken);
    }
  }

  /// <summary>A neutral mesh, in the memory of its deformer.</summary>
  public sealed unsafe class Mesh {
    internal Mesh(DeformerHandle owner, MienMesh found) {
      PositionCount = (int)found.PositionCount;
      VertexCount = (int)found.VertexCount;
      TriangleCount = (int)found.TriangleCount;
      TargetCount = (int)found.TargetCount;
      MaxInfluences = (int)found.MaxInfluences;
      Lods = found.Lods;
      Positions = new ReadOnlyView<float>(owner, found.Positions.Data, found.Positions.Count);
      Normals = new ReadOnlyView<float>(owner, found.Normals.Data, found.Normals.Count);
      Tangents = new ReadOnlyView<float>(owner, found.Tangents.Data, found.Tangents.Count);
      TextureCoordinates =
          new ReadOnlyView<float>(owner, found.TextureCoordinates.Data, found.TextureCoordinates.Count);
      VertexPositionIndices =
          new ReadOnlyView<uint>(owner, found.VertexPositionIndices.Data, found.VertexPositionIndices.Count);
      Triangles = new ReadOnlyView<uint>(owner, found.Triangles.Data, found.Triangles.Count);
      TargetChannels = new ReadOnlyView<ushort>(owner, found.TargetChannels.Data, found.TargetChannels.Count);
    }

    public int PositionCount { get; private set; }
    public int VertexCount { get; private set; }
    public int TriangleCount { get; private set; }
    public int TargetCount { get; private set; }

    /// <summary>Of one position.</summary>
    public int MaxInfluences { get; private set; }

    /// <summary>Bit l: LOD l shows this mesh.</summary>
    public ulong Lods { get; private set; }

    /// <summary>x y z per position.</summary>
    public ReadOnlyView<float> Positions { get; private set; }

    /// <summary>x y z per vertex.</summary>
    public ReadOnlyView<float> Normals { get; private set; }

    /// <summary>x y z w per vertex; empty without MienDeformerDesc.WithTangents.</summary>
    public ReadOnlyView<float> Tangents { get; private set; }

    /// <summary>u v per vertex; empty with 16-bit storage: see Deformer.TextureCoordinates().</summary>
    public ReadOnlyView<float> TextureCoordinates { get; private set; }

    public ReadOnlyView<uint> VertexPositionIndices { get; private set; }

    /// <summary>Three vertices each; empty with 16-bit storage: see Deformer.Triangles().</summary>
    public ReadOnlyView<uint> Triangles { get; private set; }

    /// <summary>The blend shape channel of each target.</summary>
    public ReadOnlyView<ushort> TargetChannels { get; private set; }
  }

  /// <summary>The deformed meshes of one character. For one thread at a time; calls allocate nothing.</summary>
  public sealed unsafe class DeformerInstance : IDisposable {
    readonly DeformerInstanceHandle handle;

    /// <summary>For calls of Native.Functions.</summary>
    public DeformerInstanceHandle Handle { get { return handle.Open(); } }
    public Deformer Deformer { get; private set; }

    internal DeformerInstance(Deformer deformer, MienDeformerInstanceDesc desc) {
      MienError error = MienError.Create();
      desc.StructSize = (UIntPtr)sizeof(MienDeformerInstanceDesc);
      IntPtr taken;
      MienException.Check(Functions.mien_deformer_instance_create(deformer.Handle, &desc, out taken, &error), ref error,
                          "cannot create a deformer instance");
      handle = new DeformerInstanceHandle(taken, deformer.Handle);
      Deformer = deformer;
      MienFloatView view;
      MienException.Check(Functions.mien_deformer_instance_joint_matrices(Handle, &view), "joint matrices");
      JointMatrices = new ReadOnlyView<float>(Handle, view.Data, view.Count);
      MienException.Check(Functions.mien_deformer_instance_skin_matrices(Handle, &view), "skin matrices");
      SkinMatrices = new ReadOnlyView<float>(Handle, view.Data, view.Count);
    }

    public void Dispose() { handle.Dispose(); }

    /// <summary>Model matrices, 16 numbers per joint, column by column.</summary>
    public ReadOnlyView<float> JointMatrices { get; private set; }

    /// <summary>For skinning on a GPU, in the same layout.</summary>
    public ReadOnlyView<float> SkinMatrices { get; private set; }

    /// <summary>Takes over the last evaluation of an instance and computes all matrices; then Deform deforms meshes.
    /// </summary>
    public void Update(Instance face) {
      MienException.Check(Functions.mien_deformer_instance_update(Handle, face.Handle),
                          "the instance is of another rig");
    }

    /// <summary>The same from values like those of Instance.Joints and Instance.BlendShapes; without joint values there
    /// are no deltas, without weights all are 0.</summary>
    public void Update(ReadOnlySpan<float> jointValues, ReadOnlySpan<float> channelWeights) {
      fixed (float* joints = &MemoryMarshal.GetReference(jointValues))
      fixed (float* weights = &MemoryMarshal.GetReference(channelWeights)) {
        MienException.Check(Functions.mien_deformer_instance_update_from_values(
            Handle, jointValues.Length == 0 ? null : joints, (UIntPtr)jointValues.Length,
            channelWeights.Length == 0 ? null : weights, (UIntPtr)channelWeights.Length),
            "the rig has another number of values");
      }
    }

    /// <summary>Writes the transform of each joint relative to its parent: tx ty tz qx qy qz qw sx sy sz.</summary>
    public void LocalTransforms(Span<float> transforms) {
      fixed (float* first = &MemoryMarshal.GetReference(transforms)) {
        var count = (UIntPtr)transforms.Length;
        MienException.Check(Functions.mien_deformer_instance_local_transforms(Handle, first, count),
                            "10 numbers per joint are needed");
      }
    }

    /// <summary>Computes positions and normals of a mesh.</summary>
    public void Deform(int mesh, Normals normals = 0) {
      MienException.Check(Functions.mien_deformer_instance_deform(Handle, (uint)mesh, normals, null),
                          "no such mesh, or none of the LODs that this instance has");
    }

    /// <summary>x y z per position, of the last Deform of this mesh.</summary>
    public ReadOnlyView<float> Positions(int mesh) {
      MienFloatView view;
      MienException.Check(Functions.mien_deformer_instance_positions(Handle, (uint)mesh, &view),
                          "no such mesh, or none of the LODs that this instance has");
      return new ReadOnlyView<float>(Handle, view.Data, view.Count);
    }

    /// <summary>x y z per vertex, of the last Deform of this mesh that computed normals.</summary>
    public ReadOnlyView<float> Normals(int mesh) {
      MienFloatView view;
      MienException.Check(Functions.mien_deformer_instance_normals(Handle, (uint)mesh, &view),
                          "no such mesh, or none of the LODs that this instance has");
      return new ReadOnlyView<float>(Handle, view.Data, view.Count);
    }

    /// <summary>Deforms a mesh and writes its vertices to memory of yours, such as a mapped vertex buffer.</summary>
    public void WriteVertices(int mesh, MienVertexOutput output, Normals normals = 0) {
      output.StructSize = (UIntPtr)sizeof(MienVertexOutput);
      MienException.Check(Functions.mien_deformer_instance_write_vertices(Handle, (uint)mesh, normals, &output, null),
                          "cannot write the vertices");
    }

    /// <summary>Deforms a mesh and writes x y z of the position and the normal of each vertex. Empty spans are not
    /// written.</summary>
    public void WriteVertices(int mesh, Span<float> positions, Span<float> normals) {
      if (positions.Length > 0 && normals.Length > 0 && positions.Length != normals.Length) {
        throw new ArgumentException("not as many normals as positions", "normals");
      }
      MienVertexOutput output = MienVertexOutput.Create();
      output.VertexCapacity = (UIntPtr)(Math.Max(positions.Length, normals.Length) / 3);
      fixed (float* first = &MemoryMarshal.GetReference(positions))
      fixed (float* firstNormal = &MemoryMarshal.GetReference(normals)) {
        if (positions.Length > 0) {
          output.Positions = new MienVertexStream { Data = first, Stride = 12, Format = VertexFormat.Float32x3 };
        }
        if (normals.Length > 0) {
          output.Normals = new MienVertexStream { Data = firstNormal, Stride = 12, Format = VertexFormat.Float32x3 };
        }
        WriteVertices(mesh, output);
      }
    }
  }

  /// <summary>How raw controls turn the eyes of a rig. Immutable.</summary>
  public sealed unsafe class Gaze : IDisposable {
    readonly GazeHandle handle;

    /// <summary>For calls of Native.Functions.</summary>
    public GazeHandle Handle { get { return handle.Open(); } }

    internal Gaze(IntPtr taken) { handle = new GazeHandle(taken); }

    public void Dispose() { handle.Dispose(); }

    public MienGazeInfo Info {
      get {
        MienGazeInfo info = MienGazeInfo.Create();
        MienException.Check(Functions.mien_gaze_info(Handle, &info), "info");
        return info;
      }
    }

    /// <summary>Sets the raw controls of a character so that both eyes look at a point: millimeters to the left, up and
    /// to
    /// the front, in the model space of the rig with its head in the neutral pose. Returns what the eyes cannot reach,
    /// for
    /// the head to turn: tangents of the angles to the left and up. Allocates nothing.</summary>
    public MienGazeRest LookAt(float left, float up, float front, Instance face) {
      var target = new MienGazeTarget { Left = left, Up = up, Front = front };
      MienGazeRest rest;
      Span<float> controls = face.RawControls.Span;
      fixed (float* first = &MemoryMarshal.GetReference(controls)) {
        Status status = Functions.mien_gaze_look_at(Handle, &target, first, (UIntPtr)controls.Length, &rest);
        GC.KeepAlive(face);
        MienException.Check(status, "the target is not finite, or the instance is of another rig");
      }
      return rest;
    }
  }
}
