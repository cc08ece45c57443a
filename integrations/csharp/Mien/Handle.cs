// SPDX-License-Identifier: MIT
using System;
using System.Runtime.InteropServices;

namespace Mien.Native {
  /// <summary>Owns an object of the library, and keeps alive the objects and bytes that it uses.
  ///
  ///     InstanceHandle ---> RigHandle ---> BakedHandle ---> PinnedBytes
  ///
  /// Finalizers run in any order: a handle that another one uses is released after it.</summary>
  public abstract class Handle : SafeHandle {
    Handle[] kept;
    long pressure;
    volatile bool isDisposed;

    static Handle() { CheckVersion(Functions.mien_version()); }

    /// <summary>Until 1.0 a minor release may change the interface.</summary>
    internal static void CheckVersion(uint number) {
      uint major = number >> 24, minor = number >> 16 & 255;
      if (major == Constants.VersionMajor && (major > 0 || minor == Constants.VersionMinor)) return;
      throw new NotSupportedException("the library is version " + major + "." + minor + ", this assembly is for " +
                                      Constants.VersionMajor + "." + Constants.VersionMinor);
    }

    internal Handle(IntPtr taken, Handle[] kept) : base(IntPtr.Zero, true) {
      int added = 0;
      try {
        foreach (Handle one in kept) {
          bool isAdded = false;
          one.DangerousAddRef(ref isAdded);
          ++added;
        }
      } catch {
        // Another thread closed one of them meanwhile.
        if (taken != IntPtr.Zero) Destroy(taken);
        while (added > 0) kept[--added].DangerousRelease();
        SetHandleAsInvalid();
        throw;
      }
      this.kept = kept;
      SetHandle(taken);
    }

    public override bool IsInvalid {
      get { return handle == IntPtr.Zero; }
    }

    /// <summary>Tells the garbage collector how much memory it frees by releasing this.</summary>
    internal void AddPressure(ulong bytes) {
      if (bytes == 0) return;
      pressure = (long)bytes;
      GC.AddMemoryPressure(pressure);
    }

    /// <summary>Keeps another handle as long as this one.</summary>
    internal void Keep(Handle other) {
      if (Array.IndexOf(kept, other) >= 0) return;
      var longer = new Handle[kept.Length + 1];
      kept.CopyTo(longer, 0);
      longer[kept.Length] = other;
      bool isAdded = false;
      other.DangerousAddRef(ref isAdded);
      kept = longer;
    }

    /// <summary>False once it was disposed, even if other handles still keep the memory.</summary>
    internal bool IsOpen {
      get { return !isDisposed; }
    }

    protected override void Dispose(bool disposing) {
      isDisposed = true;
      base.Dispose(disposing);
    }

    protected abstract void Destroy(IntPtr taken);

    protected override bool ReleaseHandle() {
      Destroy(handle);
      if (pressure > 0) GC.RemoveMemoryPressure(pressure);
      foreach (Handle one in kept) one.DangerousRelease();
      return true;
    }
  }

  static class HandleExtensions {
    /// <summary>The handle itself, unless its object is disposed.</summary>
    public static T Open<T>(this T handle) where T : Handle {
      if (!handle.IsOpen) throw new ObjectDisposedException(handle.GetType().Name.Replace("Handle", ""));
      return handle;
    }
  }

  /// <summary>An array that the library reads as long as an object lives.</summary>
  public sealed class PinnedBytes : Handle {
    /// <summary>Of the first byte.</summary>
    internal readonly IntPtr Address;

    internal PinnedBytes(byte[] bytes) : this(GCHandle.Alloc(bytes, GCHandleType.Pinned)) { }

    PinnedBytes(GCHandle pin) : base(GCHandle.ToIntPtr(pin), new Handle[0]) { Address = pin.AddrOfPinnedObject(); }

    protected override void Destroy(IntPtr taken) { GCHandle.FromIntPtr(taken).Free(); }
  }
}
