// SPDX-License-Identifier: MIT
using System;
using System.Runtime.InteropServices;
using System.Text;
using Mien.Native;

namespace Mien {
  /// <summary>A call of the library failed.</summary>
  public sealed class MienException : Exception {
    public Status Status { get; private set; }

    /// <summary>Where in the file, if it is known.</summary>
    public long? ByteOffset { get; private set; }

    internal MienException(Status status, string message, long? byteOffset = null) : base(message) {
      Status = status;
      ByteOffset = byteOffset;
    }

    /// <summary>For statuses of calls that give no message.</summary>
    internal static void Check(Status status, string what) {
      if (status != Status.Ok) Throw(status, what);
    }

    internal static unsafe void Check(Status status, ref MienError error, string what) {
      if (status == Status.Ok) return;
      fixed (byte* message = error.Message) {
        int count = 0;
        if (error.Status == status) {
          while (message[count] != 0) ++count;
        }
        if (count == 0) Throw(status, what);
        ulong offset = error.ByteOffset;
        throw new MienException(status, Name(status) + ": " + Encoding.UTF8.GetString(message, count),
                                offset == Constants.NoOffset ? (long?)null : (long)offset);
      }
    }

    static string Name(Status status) { return Marshal.PtrToStringAnsi(Functions.mien_status_name(status)); }

    static void Throw(Status status, string what) { throw new MienException(status, Name(status) + ": " + what); }
  }
}
