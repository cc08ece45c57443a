// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using System.Text;
using Mien.Native;

namespace Mien {
  /// <summary>A call that writes to `buffer` as many bytes as `capacity` says, or their number to `size`.</summary>
  internal unsafe delegate Status Write(byte* buffer, UIntPtr capacity, UIntPtr* size, MienError* error);

  static class Text {
    /// <summary>UTF-8 with a null at the end.</summary>
    public static byte[] Terminated(string text) {
      if (text == null) throw new ArgumentNullException("text");
      if (text.IndexOf('\0') >= 0) throw new ArgumentException("text with a null character", "text");
      return Encoding.UTF8.GetBytes(text + "\0");
    }

    public static unsafe string Of(MienStringView view) {
      return view.Count == UIntPtr.Zero ? "" : Encoding.UTF8.GetString(view.Data, checked((int)view.Count));
    }

    public static unsafe byte[] Written(Write write, string what) {
      MienError error = MienError.Create();
      UIntPtr size = UIntPtr.Zero;
      MienException.Check(write(null, UIntPtr.Zero, &size, &error), ref error, what);
      var bytes = new byte[checked((int)size)];
      fixed (byte* buffer = bytes) {
        MienException.Check(write(buffer, size, &size, &error), ref error, what);
      }
      if ((int)size != bytes.Length) Array.Resize(ref bytes, (int)size);
      return bytes;
    }
  }

  /// <summary>Memory for the arrays of a desc, until it is disposed.</summary>
  sealed class Scratch : IDisposable {
    readonly List<IntPtr> blocks = new List<IntPtr>();

    /// <summary>Zeroed memory.</summary>
    public unsafe void* Bytes(long size) {
      blocks.Add(IntPtr.Zero);
      IntPtr block = Marshal.AllocHGlobal((IntPtr)Math.Max(size, 1));
      blocks[blocks.Count - 1] = block;
      for (long i = 0; i < size; ++i) ((byte*)block)[i] = 0;
      return (void*)block;
    }

    public unsafe float* Floats(ICollection<float> values) {
      if (values == null) return null;
      var copy = (float*)Bytes(4L * values.Count);
      foreach (float value in values) *copy++ = value;
      return copy - values.Count;
    }

    public unsafe ushort* Indices(ICollection<ushort> values) {
      if (values == null) return null;
      var copy = (ushort*)Bytes(2L * values.Count);
      foreach (ushort value in values) *copy++ = value;
      return copy - values.Count;
    }

    public unsafe MienStringView View(string text) {
      byte[] bytes = Encoding.UTF8.GetBytes(text ?? "");
      var copy = (byte*)Bytes(bytes.Length);
      Marshal.Copy(bytes, 0, (IntPtr)copy, bytes.Length);
      return new MienStringView { Data = copy, Count = (UIntPtr)bytes.Length };
    }

    public unsafe byte* Terminated(string text) {
      if (text == null) return null;
      byte[] bytes = Text.Terminated(text);
      var copy = (byte*)Bytes(bytes.Length);
      Marshal.Copy(bytes, 0, (IntPtr)copy, bytes.Length);
      return copy;
    }

    public void Dispose() {
      foreach (IntPtr block in blocks) Marshal.FreeHGlobal(block);
      blocks.Clear();
    }
  }
}
