// SPDX-License-Identifier: MIT
using System;
using Mien.Native;

namespace Mien {
  /// <summary>An array in the memory of an object, which it keeps alive. Throws ObjectDisposedException once the object
  /// is disposed, IndexOutOfRangeException for a wrong index.</summary>
  public struct View<T> where T : struct {
    readonly Handle owner;
    readonly IntPtr data;
    readonly int count;

    internal unsafe View(Handle owner, void* data, UIntPtr count) {
      this.owner = owner;
      this.data = (IntPtr)data;
      this.count = checked((int)count);
    }

    public int Length { get { return count; } }

    public ref T this[int index] { get { return ref Span[index]; } }

    /// <summary>For inner loops and copies. A span does not keep the object alive: while you use one, something else
    /// has
    /// to refer to the object (a field, or GC.KeepAlive(face) after the loop), and it must not be disposed.</summary>
    public unsafe Span<T> Span {
      get {
        if (owner == null) return default(Span<T>);
        owner.Open();
        return new Span<T>((void*)data, count);
      }
    }

    public T[] ToArray() {
      T[] copy = Span.ToArray();
      GC.KeepAlive(owner);
      return copy;
    }

    public static implicit operator ReadOnlyView<T>(View<T> view) {
      return new ReadOnlyView<T>(view.owner, view.data, view.count);
    }
  }

  /// <summary>A View that is only read.</summary>
  public struct ReadOnlyView<T> where T : struct {
    readonly Handle owner;
    readonly IntPtr data;
    readonly int count;

    internal unsafe ReadOnlyView(Handle owner, void* data, UIntPtr count)
        : this(owner, (IntPtr)data, checked((int)count)) { }

    internal ReadOnlyView(Handle owner, IntPtr data, int count) {
      this.owner = owner;
      this.data = data;
      this.count = count;
    }

    public int Length { get { return count; } }

    public T this[int index] {
      get {
        T value = Span[index];
        GC.KeepAlive(owner);
        return value;
      }
    }

    /// <summary>As of View.Span: for inner loops, while the object is open and something refers to it.</summary>
    public unsafe ReadOnlySpan<T> Span {
      get {
        if (owner == null) return default(ReadOnlySpan<T>);
        owner.Open();
        return new ReadOnlySpan<T>((void*)data, count);
      }
    }

    public T[] ToArray() {
      T[] copy = Span.ToArray();
      GC.KeepAlive(owner);
      return copy;
    }
  }
}
