// SPDX-License-Identifier: MIT
using System;
using Mien.Native;

namespace Mien {
  /// <summary>The behavior of a DNA, packed for evaluation. Immutable: serves any number of instances and threads.
  /// </summary>
  public sealed unsafe partial class Rig : IDisposable {
    readonly RigHandle handle;

    /// <summary>For calls of Native.Functions.</summary>
    public RigHandle Handle { get { return handle.Open(); } }

    internal Rig(IntPtr taken, params Handle[] kept) {
      handle = new RigHandle(taken, kept);
      handle.AddPressure(Info.RigBytes);
    }

    public void Dispose() { handle.Dispose(); }

    /// <summary>Compiles a rig. The DNA may be disposed afterwards.</summary>
    public static Rig Create(Dna dna, MienRigDesc desc = default(MienRigDesc)) {
      MienError error = MienError.Create();
      desc.StructSize = (UIntPtr)sizeof(MienRigDesc);
      IntPtr taken;
      MienException.Check(Functions.mien_rig_create(dna.Handle, &desc, out taken, &error), ref error,
                          "cannot create the rig");
      return new Rig(taken);
    }

    public MienRigInfo Info {
      get {
        MienRigInfo info = MienRigInfo.Create();
        MienException.Check(Functions.mien_rig_info(Handle, &info), "info");
        return info;
      }
    }

    /// <summary>How many there are of a kind.</summary>
    public int Count(Kind kind) {
      uint count;
      MienException.Check(Functions.mien_rig_count(Handle, kind, &count), "kind " + kind);
      return (int)count;
    }

    public string Name(Kind kind, int index) {
      MienStringView view;
      MienException.Check(Functions.mien_rig_name(Handle, kind, (uint)index, &view), kind + " " + index);
      string name = Text.Of(view);
      GC.KeepAlive(this);
      return name;
    }

    /// <summary>The index of a name, or -1.</summary>
    public int Find(Kind kind, string name) {
      uint index;
      fixed (byte* text = Text.Terminated(name)) {
        Status status = Functions.mien_rig_find(Handle, kind, text, &index);
        if (status == Status.Name) return -1;
        MienException.Check(status, name);
      }
      return (int)index;
    }

    /// <summary>The raw controls that a name of ARKit, VRM, FACS and others stands for, and their weights; empty if
    /// there
    /// are none. match: how it was found.</summary>
    public MienControlShare[] Match(string name, out NameMatch match) {
      var shares = new MienControlShare[Constants.MostShares];
      byte[] text = Text.Terminated(name);
      UIntPtr count;
      NameMatch found = NameMatch.None;
      fixed (byte* bytes = text)
      fixed (MienControlShare* first = shares) {
        Status status = Functions.mien_rig_match(Handle, bytes, (UIntPtr)(text.Length - 1), first,
                                                 (UIntPtr)shares.Length, &count, (uint*)&found);
        match = found;
        if (status == Status.Name) return new MienControlShare[0];
        MienException.Check(status, name);
      }
      Array.Resize(ref shares, (int)count);
      return shares;
    }

    /// <summary>The parent of each joint; a root is its own parent.</summary>
    public ReadOnlyView<ushort> JointParents {
      get {
        MienIndex16View view;
        MienException.Check(Functions.mien_rig_joint_parents(Handle, &view), "parents");
        return new ReadOnlyView<ushort>(Handle, view.Data, view.Count);
      }
    }

    /// <summary>Translation, rotation and scale of each joint in the neutral pose: 9 or 10 numbers, as of
    /// Instance.Joints.</summary>
    public ReadOnlyView<float> NeutralJointValues {
      get {
        MienFloatView view;
        MienException.Check(Functions.mien_rig_neutral_joint_values(Handle, &view), "neutral joint values");
        return new ReadOnlyView<float>(Handle, view.Data, view.Count);
      }
    }

    /// <summary>Indices of a kind that a LOD computes.</summary>
    public ReadOnlyView<ushort> LodIndices(Kind kind, int lod) {
      MienIndex16View view;
      MienException.Check(Functions.mien_rig_lod_indices(Handle, kind, (uint)lod, &view), kind + " of LOD " + lod);
      return new ReadOnlyView<ushort>(Handle, view.Data, view.Count);
    }

    /// <summary>A new character in its initial state.</summary>
    public Instance CreateInstance() { return new Instance(this); }

    /// <summary>For evaluating up to `capacity` instances in one call.</summary>
    public Batch CreateBatch(int capacity) { return new Batch(this, capacity); }

    /// <summary>Writes the rig, and its deformer if there is one, to a file that is used as it is.</summary>
    public void Bake(string path, Deformer deformer = null) {
      MienError error = MienError.Create();
      fixed (byte* text = Text.Terminated(path)) {
        DeformerHandle meshes = deformer == null ? DeformerHandle.Null : deformer.Handle;
        MienException.Check(Functions.mien_bake_file(Handle, meshes, text, &error), ref error, path);
      }
    }

    /// <summary>The bytes of such a file.</summary>
    public byte[] BakeBytes(Deformer deformer = null) {
      DeformerHandle meshes = deformer == null ? DeformerHandle.Null : deformer.Handle;
      return Text.Written((buffer, capacity, size, error) =>
          Functions.mien_bake_memory(Handle, meshes, buffer, capacity, size, error), "cannot bake");
    }
  }

  /// <summary>A baked file. Immutable.</summary>
  public sealed unsafe class Baked : IDisposable {
    readonly BakedHandle handle;

    /// <summary>For calls of Native.Functions.</summary>
    public BakedHandle Handle { get { return handle.Open(); } }

    Baked(IntPtr taken, params Handle[] kept) { handle = new BakedHandle(taken, kept); }

    public void Dispose() { handle.Dispose(); }

    /// <summary>Opens a file, which must not change while it is used: it is mapped.</summary>
    public static Baked Open(string path, MienBakedDesc desc = default(MienBakedDesc)) {
      MienError error = MienError.Create();
      desc.StructSize = (UIntPtr)sizeof(MienBakedDesc);
      IntPtr taken;
      fixed (byte* text = Text.Terminated(path)) {
        MienException.Check(Functions.mien_baked_open_file(text, &desc, out taken, &error), ref error, path);
      }
      return new Baked(taken);
    }

    /// <summary>Opens the bytes of a file, which must not change until this and what is created from it is released.
    /// </summary>
    public static Baked Open(byte[] bytes, MienBakedDesc desc = default(MienBakedDesc)) {
      if (bytes == null) throw new ArgumentNullException("bytes");
      MienError error = MienError.Create();
      desc.StructSize = (UIntPtr)sizeof(MienBakedDesc);
      IntPtr taken;
      using (var pinned = new PinnedBytes(bytes)) {
        MienException.Check(Functions.mien_baked_open_memory((void*)pinned.Address, (UIntPtr)bytes.Length, &desc,
                                                             out taken, &error), ref error, "cannot open the bytes");
        return new Baked(taken, pinned);
      }
    }

    public MienBakedInfo Info {
      get {
        MienBakedInfo info = MienBakedInfo.Create();
        MienException.Check(Functions.mien_baked_info(Handle, &info), "info");
        return info;
      }
    }

    /// <summary>Its rig. The baked file may be disposed afterwards.</summary>
    public Rig CreateRig(MienBakedRigDesc desc = default(MienBakedRigDesc)) {
      MienError error = MienError.Create();
      desc.StructSize = (UIntPtr)sizeof(MienBakedRigDesc);
      IntPtr taken;
      MienException.Check(Functions.mien_rig_from_baked(Handle, &desc, out taken, &error), ref error,
                          "cannot create the rig");
      return new Rig(taken, Handle);
    }

    /// <summary>Its deformer, for its rig. The baked file may be disposed afterwards.</summary>
    public Deformer CreateDeformer(Rig rig, MienBakedDeformerDesc desc = default(MienBakedDeformerDesc)) {
      MienError error = MienError.Create();
      desc.StructSize = (UIntPtr)sizeof(MienBakedDeformerDesc);
      IntPtr taken;
      MienException.Check(Functions.mien_deformer_from_baked(Handle, rig.Handle, &desc, out taken, &error), ref error,
                          "cannot create the deformer");
      return new Deformer(taken, Handle, rig.Handle);
    }
  }
}
