// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using Mien.Native;

namespace Mien {
  /// <summary>Ticks, in which all times are.</summary>
  public static class Ticks {
    public const long PerSecond = Constants.TicksPerSecond;

    public static long Of(double seconds) { return (long)Math.Floor(seconds * PerSecond + 0.5); }
  }

  public struct ClipEvent {
    public long Tick;
    public string Name;
    public float Value;

    internal static ClipEvent From(MienClipEvent from) {
      return new ClipEvent { Tick = from.Tick, Name = Text.Of(from.Name), Value = from.Value };
    }
  }

  /// <summary>What a clip is compressed from.</summary>
  public sealed class ClipDesc {
    /// <summary>Of the channels.</summary>
    public string[] Names;

    /// <summary>One value per channel, one frame after the other.</summary>
    public float[] Values;

    public int RateNumerator = 60, RateDenominator = 1;

    /// <summary>The largest error that the compression may make, as in MienClipDesc.</summary>
    public float Snap;

    /// <summary>Such an error for each channel instead, or null.</summary>
    public float[] Snaps;

    public Looping Looping;
    public bool IsDelta;
    public ClipEvent[] Events = new ClipEvent[0];
  }

  /// <summary>Compressed curves. Immutable.</summary>
  public sealed unsafe class Clip : IDisposable {
    readonly ClipHandle handle;

    /// <summary>For calls of Native.Functions.</summary>
    public ClipHandle Handle { get { return handle.Open(); } }

    Clip(IntPtr taken, params Handle[] kept) { handle = new ClipHandle(taken, kept); }

    public void Dispose() { handle.Dispose(); }

    public static Clip Build(ClipDesc from) {
      int channels = from.Names.Length;
      if (channels == 0 || from.Values.Length == 0 || from.Values.Length % channels != 0) {
        throw new ArgumentException("not one value per channel and frame", "from");
      }
      if (from.Snaps != null && from.Snaps.Length != channels) throw new ArgumentException("not one snap per channel");
      MienError error = MienError.Create();
      MienClipDesc desc = MienClipDesc.Create();
      desc.RateNumerator = (uint)from.RateNumerator;
      desc.RateDenominator = (uint)from.RateDenominator;
      desc.FrameCount = (uint)(from.Values.Length / channels);
      desc.ChannelCount = (uint)channels;
      desc.Snap = from.Snap;
      desc.Looping = from.Looping;
      desc.IsDelta = from.IsDelta ? 1u : 0;
      IntPtr taken;
      using (var scratch = new Scratch()) {
        desc.Names = (MienStringView*)scratch.Bytes((long)channels * sizeof(MienStringView));
        for (int i = 0; i < channels; ++i) desc.Names[i] = scratch.View(from.Names[i]);
        desc.EventCount = (uint)from.Events.Length;
        desc.Events = (MienClipEvent*)scratch.Bytes((long)from.Events.Length * sizeof(MienClipEvent));
        for (int i = 0; i < from.Events.Length; ++i) {
          ClipEvent one = from.Events[i];
          desc.Events[i] = new MienClipEvent { Tick = one.Tick, Name = scratch.View(one.Name), Value = one.Value };
        }
        desc.Snaps = scratch.Floats(from.Snaps);
        fixed (float* values = from.Values) {
          desc.Values = values;
          MienException.Check(Functions.mien_clip_build(&desc, out taken, &error), ref error, "cannot build the clip");
        }
      }
      return new Clip(taken);
    }

    /// <summary>Opens a file, which must not change while it is used: it is mapped.</summary>
    public static Clip Open(string path, MienClipOpenDesc desc = default(MienClipOpenDesc)) {
      MienError error = MienError.Create();
      desc.StructSize = (UIntPtr)sizeof(MienClipOpenDesc);
      IntPtr taken;
      fixed (byte* text = Text.Terminated(path)) {
        MienException.Check(Functions.mien_clip_open_file(text, &desc, out taken, &error), ref error, path);
      }
      return new Clip(taken);
    }

    /// <summary>Opens the bytes of a file, which must not change until this and its players are released.</summary>
    public static Clip Open(byte[] bytes, MienClipOpenDesc desc = default(MienClipOpenDesc)) {
      if (bytes == null) throw new ArgumentNullException("bytes");
      MienError error = MienError.Create();
      desc.StructSize = (UIntPtr)sizeof(MienClipOpenDesc);
      IntPtr taken;
      using (var pinned = new PinnedBytes(bytes)) {
        MienException.Check(Functions.mien_clip_open_memory((void*)pinned.Address, (UIntPtr)bytes.Length, &desc,
                                                            out taken, &error), ref error, "cannot open the bytes");
        return new Clip(taken, pinned);
      }
    }

    public MienClipInfo Info {
      get {
        MienClipInfo info = MienClipInfo.Create();
        MienException.Check(Functions.mien_clip_info(Handle, &info), "info");
        return info;
      }
    }

    public void Save(string path) {
      MienError error = MienError.Create();
      fixed (byte* text = Text.Terminated(path)) {
        MienException.Check(Functions.mien_clip_write_file(Handle, text, &error), ref error, path);
      }
    }

    /// <summary>The bytes of the file.</summary>
    public byte[] ToBytes() {
      return Text.Written((buffer, capacity, size, error) =>
          Functions.mien_clip_write_memory(Handle, buffer, capacity, size, error), "cannot write");
    }

    /// <summary>Values of frames, channels side by side, one frame after the other. values: for whole frames.</summary>
    public void Read(int firstFrame, Span<float> values) {
      MienError error = MienError.Create();
      int channels = (int)Info.ChannelCount;
      if (values.Length % channels != 0) throw new ArgumentException("not one value per channel and frame", "values");
      fixed (float* first = &MemoryMarshal.GetReference(values)) {
        MienException.Check(Functions.mien_clip_read(Handle, (uint)firstFrame, (uint)(values.Length / channels), first,
                                                     UIntPtr.Zero, &error), ref error, "cannot read the frames");
      }
    }

    public ClipPlayer CreatePlayer(MienClipPlayerDesc desc = default(MienClipPlayerDesc)) {
      return new ClipPlayer(this, desc);
    }

    /// <summary>Finds the controls of a rig that the channels drive, by names. arkit: names of ARKit, which the rig may
    /// lack, drive what they stand for.</summary>
    public ClipBinding Bind(Rig rig, bool arkit = false) {
      MienError error = MienError.Create();
      MienClipBindingDesc desc = MienClipBindingDesc.Create();
      IntPtr taken;
      UIntPtr count = UIntPtr.Zero;
      if (arkit) MienException.Check(Functions.mien_arkit_matrix(null, UIntPtr.Zero, &count), "matrix");
      var matrix = new MienMatrixEntry[(int)count + 1];
      fixed (MienMatrixEntry* entries = matrix) {
        if (arkit) MienException.Check(Functions.mien_arkit_matrix(entries, count, &count), "matrix");
        desc.Matrix = entries;
        desc.MatrixCount = count;
        MienException.Check(Functions.mien_clip_binding_create(Handle, rig.Handle, &desc, out taken, &error), ref error,
                            "cannot bind the clip");
      }
      return new ClipBinding(taken);
    }
  }

  /// <summary>Plays a clip. For one thread at a time; calls allocate nothing, except for events.</summary>
  public sealed unsafe class ClipPlayer : IDisposable {
    readonly ClipPlayerHandle handle;

    /// <summary>For calls of Native.Functions.</summary>
    public ClipPlayerHandle Handle { get { return handle.Open(); } }

    internal ClipPlayer(Clip clip, MienClipPlayerDesc desc) {
      MienError error = MienError.Create();
      desc.StructSize = (UIntPtr)sizeof(MienClipPlayerDesc);
      IntPtr taken;
      MienException.Check(Functions.mien_clip_player_create(clip.Handle, &desc, out taken, &error), ref error,
                          "cannot create a player");
      handle = new ClipPlayerHandle(taken, clip.Handle);
    }

    public void Dispose() { handle.Dispose(); }

    public MienClipPlayerInfo Info {
      get {
        MienClipPlayerInfo info = MienClipPlayerInfo.Create();
        MienException.Check(Functions.mien_clip_player_info(Handle, &info), "info");
        return info;
      }
    }

    public void Seek(long tick) {
      MienException.Check(Functions.mien_clip_player_seek(Handle, tick), "the tick is out of range");
    }

    public void SetSpeed(int numerator, int denominator = 1) {
      MienException.Check(Functions.mien_clip_player_set_speed(Handle, numerator, denominator),
                          "the speed is out of range");
    }

    public void Advance(long ticks) {
      MienException.Check(Functions.mien_clip_player_advance(Handle, ticks), "the player cannot advance as far");
    }

    /// <summary>The next event that the last Advance passed; false after the last one.</summary>
    public bool TryNextEvent(out ClipEvent next) {
      MienClipEvent found;
      uint isFound;
      MienException.Check(Functions.mien_clip_player_next_event(Handle, &found, &isFound), "events");
      next = isFound == 0 ? default(ClipEvent) : ClipEvent.From(found);
      return isFound != 0;
    }

    /// <summary>The values at the current position, one per channel.</summary>
    public ReadOnlyView<float> Sample() {
      MienFloatView view;
      MienException.Check(Functions.mien_clip_player_sample(Handle, &view), "cannot sample");
      return new ReadOnlyView<float>(Handle, view.Data, view.Count);
    }
  }

  /// <summary>Which raw controls of a rig the channels of a clip drive. Immutable. Clip and rig may be
  /// disposed.</summary>
  public sealed unsafe class ClipBinding : IDisposable {
    readonly ClipBindingHandle handle;

    /// <summary>For calls of Native.Functions.</summary>
    public ClipBindingHandle Handle { get { return handle.Open(); } }

    internal ClipBinding(IntPtr taken) { handle = new ClipBindingHandle(taken); }

    public void Dispose() { handle.Dispose(); }

    MienClipBindingInfo Info {
      get {
        MienClipBindingInfo info = MienClipBindingInfo.Create();
        MienException.Check(Functions.mien_clip_binding_info(Handle, &info), "info");
        return info;
      }
    }

    ReadOnlyView<ushort> View(MienIndex16View view) { return new ReadOnlyView<ushort>(Handle, view.Data, view.Count); }

    /// <summary>Raw controls that are driven.</summary>
    public ReadOnlyView<ushort> Controls { get { return View(Info.Controls); } }

    /// <summary>Raw controls that are not.</summary>
    public ReadOnlyView<ushort> ExtraControls { get { return View(Info.ExtraControls); } }

    /// <summary>Channels that drive nothing.</summary>
    public ReadOnlyView<ushort> MissingChannels { get { return View(Info.MissingChannels); } }

    /// <summary>Sets the raw controls of a character from values of the clip, such as of ClipPlayer.Sample. Allocates
    /// nothing.</summary>
    public void Apply(ReadOnlySpan<float> values, Instance face) {
      Span<float> controls = face.RawControls.Span;
      fixed (float* first = &MemoryMarshal.GetReference(values))
      fixed (float* to = &MemoryMarshal.GetReference(controls)) {
        Status status = Functions.mien_clip_binding_apply(Handle, first, (UIntPtr)values.Length, to,
                                                          (UIntPtr)controls.Length);
        GC.KeepAlive(face);
        MienException.Check(status, "the values are of another clip, or the instance of another rig");
      }
    }
  }
}
