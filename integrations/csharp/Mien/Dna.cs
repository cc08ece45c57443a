// SPDX-License-Identifier: MIT
using System;
using System.Text;
using Mien.Native;

namespace Mien {
  /// <summary>A checked, read-only view of a DNA file. Immutable: may be used by any number of threads.</summary>
  public sealed unsafe class Dna : IDisposable {
    readonly DnaHandle handle;

    /// <summary>For calls of Native.Functions.</summary>
    public DnaHandle Handle { get { return handle.Open(); } }

    Dna(IntPtr taken, params Handle[] kept) {
      handle = new DnaHandle(taken, kept);
      handle.AddPressure(Info.MemoryBytes);
    }

    public void Dispose() { handle.Dispose(); }

    /// <summary>Opens a file. system: the name of a coordinate system to convert to, such as "unity"; null for that of
    /// the file.</summary>
    public static Dna Open(string path, MienDnaDesc desc = default(MienDnaDesc), string system = null) {
      MienError error = MienError.Create();
      MienCoordinateSystem found = Find(system, ref desc);
      IntPtr taken;
      if (system != null) desc.System = &found;
      fixed (byte* text = Text.Terminated(path)) {
        MienException.Check(Functions.mien_dna_open_file(text, &desc, out taken, &error), ref error, path);
      }
      return new Dna(taken);
    }

    /// <summary>Opens the bytes of a file, which must not change until this is released.
    /// </summary>
    public static Dna Open(byte[] bytes, MienDnaDesc desc = default(MienDnaDesc), string system = null) {
      if (bytes == null) throw new ArgumentNullException("bytes");
      MienError error = MienError.Create();
      MienCoordinateSystem found = Find(system, ref desc);
      IntPtr taken;
      if (system != null) desc.System = &found;
      using (var pinned = new PinnedBytes(bytes)) {
        MienException.Check(Functions.mien_dna_open_memory((void*)pinned.Address, (UIntPtr)bytes.Length, &desc,
                                                           out taken, &error), ref error, "cannot open the bytes");
        return new Dna(taken, pinned);
      }
    }

    static MienCoordinateSystem Find(string system, ref MienDnaDesc desc) {
      desc.StructSize = (UIntPtr)sizeof(MienDnaDesc);
      MienCoordinateSystem found = MienCoordinateSystem.Create();
      if (system == null) return found;
      fixed (byte* name = Text.Terminated(system)) {
        MienException.Check(Functions.mien_coordinate_system_find(name, &found), system);
      }
      return found;
    }

    /// <summary>Generates a rig. Needs libmien-author.</summary>
    public static Dna Generate(Preset preset, ulong seed = 0, Generate flags = 0) {
      MienError error = MienError.Create();
      MienGenerateDesc desc = MienGenerateDesc.Create();
      desc.Preset = preset;
      desc.Seed = seed;
      desc.Flags = flags;
      IntPtr taken;
      MienException.Check(Functions.mien_dna_generate(&desc, out taken, &error), ref error, "cannot generate a rig");
      return new Dna(taken);
    }

    public MienDnaInfo Info {
      get {
        MienDnaInfo info = MienDnaInfo.Create();
        MienException.Check(Functions.mien_dna_info(Handle, &info), "info");
        return info;
      }
    }

    public void Save(string path, MienWriteDesc desc = default(MienWriteDesc)) {
      MienError error = MienError.Create();
      desc.StructSize = (UIntPtr)sizeof(MienWriteDesc);
      fixed (byte* text = Text.Terminated(path)) {
        MienException.Check(Functions.mien_dna_write_file(Handle, text, &desc, &error), ref error, path);
      }
    }

    /// <summary>The bytes of the file.</summary>
    public byte[] ToBytes(MienWriteDesc desc = default(MienWriteDesc)) {
      desc.StructSize = (UIntPtr)sizeof(MienWriteDesc);
      return Text.Written((buffer, capacity, size, error) => {
        MienWriteDesc copy = desc;
        return Functions.mien_dna_write_memory(Handle, &copy, buffer, capacity, size, error);
      }, "cannot write");
    }

    /// <summary>What the field of a loaded layer contains, by its path: "defn.jointNames[3]". docs/dna-format.md lists
    /// the fields.</summary>
    public MienDnaField Field(string path) {
      MienError error = MienError.Create();
      MienDnaField field = MienDnaField.Create();
      fixed (byte* text = Text.Terminated(path)) {
        MienException.Check(Functions.mien_dna_field(Handle, text, &field, &error), ref error, path);
      }
      return field;
    }

    public string ReadString(string path) {
      MienError error = MienError.Create();
      MienStringView view;
      fixed (byte* text = Text.Terminated(path)) {
        MienException.Check(Functions.mien_dna_read_string(Handle, text, &view, &error), ref error, path);
      }
      string result = Text.Of(view);
      GC.KeepAlive(this);
      return result;
    }

    /// <summary>All elements of an array of floats, or the one of a field that is none.</summary>
    public float[] ReadFloats(string path) {
      MienError error = MienError.Create();
      var values = new float[checked((int)Field(path).Count)];
      fixed (byte* text = Text.Terminated(path))
      fixed (float* first = values) {
        MienException.Check(Functions.mien_dna_read_floats(Handle, text, 0, (ulong)values.Length, first, &error),
                            ref error, path);
      }
      return values;
    }

    /// <summary>All elements of an array of integers, or the one of a field that is none.</summary>
    public long[] ReadIntegers(string path) {
      MienError error = MienError.Create();
      var values = new long[checked((int)Field(path).Count)];
      fixed (byte* text = Text.Terminated(path))
      fixed (long* first = values) {
        MienException.Check(Functions.mien_dna_read_integers(Handle, text, 0, (ulong)values.Length, first, &error),
                            ref error, path);
      }
      return values;
    }
  }
}
