// SPDX-License-Identifier: MIT
using System;
using System.Runtime.InteropServices;
using Mien.Native;

namespace Mien {
  public sealed unsafe partial class Rig {
    /// <summary>Creates a mix for this rig.</summary>
    public Mix CreateMix(MixDesc from) {
      MienError error = MienError.Create();
      IntPtr taken;
      using (var arrays = new MixArrays(this, from)) {
        using (var gaze = new Borrowed(from.Gaze == null ? null : from.Gaze.Handle))
        using (var deformer = new Borrowed(from.Deformer == null ? null : from.Deformer.Handle)) {
          MienMixDesc desc = arrays.Desc;
          desc.Gaze = gaze.Pointer;
          desc.Deformer = deformer.Pointer;
          MienException.Check(Functions.mien_mix_create(Handle, &desc, out taken, &error), ref error,
                              "cannot create the mix");
        }
      }
      return new Mix(taken);
    }

    /// <summary>Pairs of raw controls that move the face in opposite directions, for MixDesc.Antagonists.</summary>
    public MienMixAntagonists[] Antagonists() {
      UIntPtr count;
      MienException.Check(Functions.mien_mix_antagonists(Handle, null, UIntPtr.Zero, &count), "antagonists");
      var pairs = new MienMixAntagonists[(int)count];
      fixed (MienMixAntagonists* first = pairs) {
        MienException.Check(Functions.mien_mix_antagonists(Handle, first, count, &count), "antagonists");
      }
      return pairs;
    }
  }

  /// <summary>A handle whose pointer is in a struct during a call.</summary>
  struct Borrowed : IDisposable {
    readonly Handle handle;
    public readonly IntPtr Pointer;

    public Borrowed(Handle handle) {
      this.handle = handle;
      Pointer = IntPtr.Zero;
      if (handle == null) return;
      bool isAdded = false;
      handle.DangerousAddRef(ref isAdded);
      Pointer = handle.DangerousGetHandle();
    }

    public void Dispose() {
      if (handle != null) handle.DangerousRelease();
    }
  }

  /// <summary>Layers, reactions and guards of a rig. Immutable: serves any number of mixers and threads.</summary>
  public sealed unsafe class Mix : IDisposable {
    readonly MixHandle handle;

    /// <summary>For calls of Native.Functions.</summary>
    public MixHandle Handle { get { return handle.Open(); } }

    internal Mix(IntPtr taken) { handle = new MixHandle(taken); }

    public void Dispose() { handle.Dispose(); }

    /// <summary>Opens a file, as Save writes it, for a rig that has its controls.</summary>
    public static Mix Open(string path, Rig rig) {
      MienError error = MienError.Create();
      IntPtr taken;
      fixed (byte* text = Text.Terminated(path)) {
        MienException.Check(Functions.mien_mix_open_file(text, rig.Handle, null, out taken, &error), ref error, path);
      }
      return new Mix(taken);
    }

    public static Mix Open(byte[] bytes, Rig rig) {
      if (bytes == null) throw new ArgumentNullException("bytes");
      MienError error = MienError.Create();
      IntPtr taken;
      fixed (byte* first = bytes) {
        MienException.Check(Functions.mien_mix_open_memory(first, (UIntPtr)bytes.Length, rig.Handle, null, out taken,
                                                           &error), ref error, "cannot open the bytes");
      }
      return new Mix(taken);
    }

    public void Save(string path) {
      MienError error = MienError.Create();
      fixed (byte* text = Text.Terminated(path)) {
        MienException.Check(Functions.mien_mix_write_file(Handle, text, &error), ref error, path);
      }
    }

    public byte[] ToBytes() {
      return Text.Written((buffer, capacity, size, error) =>
          Functions.mien_mix_write_memory(Handle, buffer, capacity, size, error), "cannot write");
    }

    /// <summary>The text of the file.</summary>
    public string ToText() {
      return System.Text.Encoding.UTF8.GetString(Text.Written((buffer, capacity, size, error) =>
          Functions.mien_mix_write_text(Handle, buffer, capacity, size, error), "cannot write"));
    }

    public MienMixInfo Info {
      get {
        MienMixInfo info = MienMixInfo.Create();
        MienException.Check(Functions.mien_mix_info(Handle, &info), "info");
        return info;
      }
    }

    /// <summary>A new character. keepStages: for Mixer.Stage.</summary>
    public Mixer CreateMixer(ulong seed = 0, bool keepStages = false) { return new Mixer(this, seed, keepStages); }
  }

  /// <summary>What a guard did in the last step, as in MienGuardState.</summary>
  public struct GuardState {
    public string Name;
    public Guard Kind;
    public ushort[] Controls;
    public float Activation, ProtectedDistance, Wanted, Limit, Distance;
  }

  /// <summary>A clip that Mixer.Restore may need.</summary>
  public struct MixerClip {
    public ulong ClipId;
    public Clip Clip;
    public ClipBinding Binding;
  }

  /// <summary>Plays a mix for one character. For one thread at a time, except Push; Step, Push, weights and triggers
  /// allocate nothing. Times are ticks.</summary>
  public sealed unsafe class Mixer : IDisposable {
    readonly MixerHandle handle;

    /// <summary>For calls of Native.Functions.</summary>
    public MixerHandle Handle { get { return handle.Open(); } }

    /// <summary>All curves of the last step: raw controls, then variables.</summary>
    public ReadOnlyView<float> Row { get; private set; }

    internal Mixer(Mix mix, ulong seed, bool keepStages) {
      MienError error = MienError.Create();
      MienMixerDesc desc = MienMixerDesc.Create();
      desc.Seed = seed;
      desc.Stages = keepStages ? 1u : 0;
      IntPtr taken;
      MienException.Check(Functions.mien_mixer_create(mix.Handle, &desc, out taken, &error), ref error,
                          "cannot create a mixer");
      handle = new MixerHandle(taken, mix.Handle);
      MienFloatView view;
      MienException.Check(Functions.mien_mixer_row(Handle, &view), "row");
      Row = new ReadOnlyView<float>(Handle, view.Data, view.Count);
    }

    public void Dispose() { handle.Dispose(); }

    /// <summary>Plays a clip in a layer. The mixer keeps the clip and the binding until it is released, even if you
    /// dispose
    /// them. desc.SpeedDenominator 0 stands for normal speed.</summary>
    public void Play(int layer, Clip clip, ClipBinding binding, MienPlayDesc desc = default(MienPlayDesc)) {
      MienError error = MienError.Create();
      desc.StructSize = (UIntPtr)sizeof(MienPlayDesc);
      Handle.Keep(clip.Handle);
      Handle.Keep(binding.Handle);
      MienException.Check(Functions.mien_mixer_play(Handle, (uint)layer, clip.Handle, binding.Handle, &desc, &error),
                          ref error, "cannot play the clip");
    }

    public void Stop(int layer, long fade = 0) {
      MienException.Check(Functions.mien_mixer_stop(Handle, (uint)layer, fade),
                          "no clips play in this layer, or a wrong fade");
    }

    public void SetWeight(int layer, float weight, long fade = 0) {
      MienException.Check(Functions.mien_mixer_set_weight(Handle, (uint)layer, weight, fade),
                          "no such layer, weight or fade");
    }

    public void SetPoseWeight(int layer, int pose, float weight, long fade = 0) {
      MienException.Check(Functions.mien_mixer_set_pose_weight(Handle, (uint)layer, (uint)pose, weight, fade),
                          "no such layer, pose, weight or fade");
    }

    public void SetVariable(int variable, float value) {
      MienException.Check(Functions.mien_mixer_set_variable(Handle, (uint)variable, value),
                          "no such variable or value");
    }

    /// <summary>activation: 0 to 1, or negative: automatic.</summary>
    public void SetGuard(int guard, float activation) {
      MienException.Check(Functions.mien_mixer_set_guard(Handle, (uint)guard, activation),
                          "no such guard or activation");
    }

    /// <summary>Starts a reaction. hold: how long the stimulus lasts; negative: until Release.</summary>
    public void Trigger(int reaction, float strength = 1, long hold = 0) {
      MienException.Check(Functions.mien_mixer_trigger(Handle, (uint)reaction, strength, hold),
                          "no such reaction, strength or hold");
    }

    public void Release(int reaction) {
      MienException.Check(Functions.mien_mixer_release(Handle, (uint)reaction), "no such reaction");
    }

    public void SetLevel(int reaction, float level) {
      MienException.Check(Functions.mien_mixer_set_level(Handle, (uint)reaction, level), "no such reaction or level");
    }

    /// <summary>Queues a row for a stream layer. False if it was not taken: it is not newer than the last one, or the
    /// queue
    /// is full. One thread may call this while another one uses the mixer.</summary>
    public bool Push(int layer, long tick, ReadOnlySpan<float> values) {
      uint isAccepted;
      fixed (float* first = &MemoryMarshal.GetReference(values)) {
        MienException.Check(Functions.mien_mixer_push(Handle, (uint)layer, tick, first, (UIntPtr)values.Length,
                                                      &isAccepted),
                            "no such stream, or a wrong number of values, or one that is not finite");
      }
      return isAccepted != 0;
    }

    /// <summary>Advances the time and writes the raw controls of a character, if there is one; then evaluate
    /// it.</summary>
    public void Step(long ticks, Instance face = null) {
      MienException.Check(Functions.mien_mixer_step(Handle, ticks, face == null ? InstanceHandle.Null : face.Handle),
                          "ticks are out of range, or the instance is of another rig");
    }

    /// <summary>Its time, and how many events of clips the last step passed.</summary>
    public MienMixerInfo Info {
      get {
        MienMixerInfo info = MienMixerInfo.Create();
        MienException.Check(Functions.mien_mixer_info(Handle, &info), "info");
        return info;
      }
    }

    /// <summary>An event of the last step, and its layer.</summary>
    public ClipEvent Event(int index, out int layer) {
      MienClipEvent found;
      uint of;
      MienException.Check(Functions.mien_mixer_event(Handle, (uint)index, &found, &of), "no such event");
      layer = (int)of;
      ClipEvent result = ClipEvent.From(found);
      GC.KeepAlive(this);
      return result;
    }

    /// <summary>The row after a stage of the last step, of a mixer created with keepStages.</summary>
    public ReadOnlyView<float> Stage(int stage) {
      MienFloatView view;
      MienException.Check(Functions.mien_mixer_stage(Handle, (uint)stage, &view),
                          "no such stage, or no stages are kept");
      return new ReadOnlyView<float>(Handle, view.Data, view.Count);
    }

    public GuardState Guard(int guard) {
      MienGuardState state = MienGuardState.Create();
      MienException.Check(Functions.mien_mixer_guard(Handle, (uint)guard, &state), "no such guard");
      var controls = new ReadOnlyView<ushort>(Handle, state.Controls.Data, state.Controls.Count);
      var result = new GuardState {
        Name = Text.Of(state.Name), Kind = state.Kind, Controls = controls.ToArray(), Activation = state.Activation,
        ProtectedDistance = state.ProtectedDistance, Wanted = state.Wanted, Limit = state.Limit,
        Distance = state.Distance
      };
      GC.KeepAlive(this);
      return result;
    }

    /// <summary>The state as bytes.</summary>
    public byte[] Snapshot() {
      return Text.Written((buffer, capacity, size, error) =>
          Functions.mien_mixer_snapshot(Handle, buffer, capacity, size, error), "cannot write");
    }

    /// <summary>Takes a snapshot of a mixer of the same mix. playing: clips that may have been playing.</summary>
    public void Restore(byte[] snapshot, params MixerClip[] playing) {
      if (snapshot == null) throw new ArgumentNullException("snapshot");
      MienError error = MienError.Create();
      var clips = new MienMixerClip[playing.Length + 1];
      for (int i = 0; i < playing.Length; ++i) {
        Handle.Keep(playing[i].Clip.Handle);
        Handle.Keep(playing[i].Binding.Handle);
        clips[i] = new MienMixerClip {
          ClipId = playing[i].ClipId, Clip = playing[i].Clip.Handle.DangerousGetHandle(),
          ClipBinding = playing[i].Binding.Handle.DangerousGetHandle()
        };
      }
      fixed (byte* bytes = snapshot)
      fixed (MienMixerClip* first = clips) {
        MienException.Check(Functions.mien_mixer_restore(Handle, bytes, (UIntPtr)snapshot.Length, first,
                                                         (UIntPtr)playing.Length, &error), ref error, "cannot restore");
      }
    }
  }
}
