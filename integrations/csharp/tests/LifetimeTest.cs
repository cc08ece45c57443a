// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.IO;
using System.Runtime.CompilerServices;
using Mien;
using Mien.Native;

/// <summary>What is reachable stays, what is not is released, in any order.</summary>
static class LifetimeTest {
  static void Collect() {
    // Mono scans the stack conservatively: overwrite what earlier calls left there.
    ClearStack(200);
    for (int i = 0; i < 3; ++i) {
      GC.Collect();
      GC.WaitForPendingFinalizers();
    }
  }

  [MethodImpl(MethodImplOptions.NoInlining)]
  static unsafe long ClearStack(int depth) {
    long* zeros = stackalloc long[32];
    for (int i = 0; i < 32; ++i) zeros[i] = 0;
    return depth == 0 ? zeros[0] : ClearStack(depth - 1) + zeros[1];
  }

  /// <summary>A handle that counts what was released before it.</summary>
  sealed class Counted : Handle {
    public static readonly List<string> Released = new List<string>();
    readonly string name;

    public Counted(string name, params Handle[] kept) : base((IntPtr)64, kept) { this.name = name; }

    protected override void Destroy(IntPtr taken) {
      lock (Released) Released.Add(name);
    }
  }

  public static void WhatAHandleUsesIsReleasedAfterIt() {
    Counted.Released.Clear();
    var rig = new Counted("rig");
    var face = new Counted("face", rig);
    rig.Dispose();
    rig.Dispose();
    Support.Equal(Counted.Released.Count, 0, "released handles");
    Support.Throws<ObjectDisposedException>("a disposed handle", () => rig.Open());
    face.Dispose();
    Support.Equal(string.Join(" ", Counted.Released.ToArray()), "face rig", "order");
    Support.Throws<ObjectDisposedException>("a released handle", () => new Counted("late", new Counted("kept"), rig));
    Support.Equal(Counted.Released.Count, 3, "handles after one that cannot keep the others");
  }

  [MethodImpl(MethodImplOptions.NoInlining)]
  static void MakeChains(int count) {
    for (int i = 0; i < count; ++i) {
      var file = new Counted("file");
      var rig = new Counted("rig", file);
      GC.KeepAlive(new Counted("face", rig, file));
    }
  }

  public static void FinalizersOfChainsRunInAnyOrder() {
    Collect();
    Counted.Released.Clear();
    var thread = new System.Threading.Thread(() => MakeChains(300));
    thread.Start();
    thread.Join();
    Collect();
    int faces = 0, rigs = 0, files = 0;
    lock (Counted.Released) {
      foreach (string name in Counted.Released) {
        faces += name == "face" ? 1 : 0;
        rigs += name == "rig" ? 1 : 0;
        files += name == "file" ? 1 : 0;
        Support.True(files <= rigs && rigs <= faces, "a handle was released before one that uses it");
      }
    }
    Support.True(files >= 290 && faces <= 300, faces + " faces, " + rigs + " rigs, " + files + " files were released");
  }

  [MethodImpl(MethodImplOptions.NoInlining)]
  static ReadOnlyView<float> JointsOfAPose(out float[] values) {
    Instance face = new Small().Rig.CreateInstance();
    Support.SetControls(face, 3);
    face.Evaluate();
    values = face.Joints.ToArray();
    return face.Joints;
  }

  public static void AViewKeepsItsMemory() {
    float[] values;
    ReadOnlyView<float> joints = JointsOfAPose(out values);
    Collect();
    for (int i = 0; i < 30; ++i) new Small().Rig.CreateInstance().Evaluate();
    Support.ArraysEqual(joints.ToArray(), values, "joints");
  }

  [MethodImpl(MethodImplOptions.NoInlining)]
  static Instance FaceOfBakedBytes() {
    var small = new Small();
    Baked baked = Baked.Open(small.Rig.BakeBytes(small.Deformer));
    Rig rig = baked.CreateRig();
    baked.Dispose();
    return rig.CreateInstance();
  }

  [MethodImpl(MethodImplOptions.NoInlining)]
  static ClipPlayer PlayerOfBytes() {
    Clip clip = Clip.Build(new ClipDesc { Names = new[] { "a" }, Values = new[] { 0.25f, 0.5f } });
    return Clip.Open(clip.ToBytes()).CreatePlayer();
  }

  public static void ChildrenKeepBytesAndParents() {
    ClipPlayer player = PlayerOfBytes();
    Instance face = FaceOfBakedBytes();
    Collect();
    var waste = new List<byte[]>();
    for (int i = 0; i < 200; ++i) waste.Add(new byte[100000 + i]);
    Support.SetControls(face, 2);
    face.Evaluate();
    Support.Equal(player.Sample()[0], 0.25f, "value");
    Instance expected = new Small().Rig.CreateInstance();
    Support.SetControls(expected, 2);
    expected.Evaluate();
    Support.ArraysEqual(face.Joints.ToArray(), expected.Joints.ToArray(), "joints");
    GC.KeepAlive(waste);
  }

  [MethodImpl(MethodImplOptions.NoInlining)]
  static void Play(Mixer mixer, Rig rig, int layer, float value, bool isDisposed) {
    Clip clip = Clip.Build(new ClipDesc {
      Names = new[] { rig.Name(Kind.RawControl, 0) }, Values = new[] { value, value }, Looping = Looping.Clamp
    });
    Clip again = Clip.Open(clip.ToBytes());
    ClipBinding binding = again.Bind(rig);
    mixer.Play(layer, again, binding, new MienPlayDesc { Transition = Transition.Cut });
    if (!isDisposed) return;
    again.Dispose();
    binding.Dispose();
  }

  public static void AMixerKeepsItsClipDisposedOrCollected() {
    Rig rig = new Small().Rig;
    Mixer mixer = rig.CreateMix(new MixDesc { Layers = new[] { new MixLayer(), new MixLayer() } }).CreateMixer();
    Play(mixer, rig, 0, 0.75f, true);
    Play(mixer, rig, 1, 0.5f, false);
    Collect();
    for (int i = 0; i < 50; ++i) Clip.Build(new ClipDesc { Names = new[] { "b" }, Values = new float[3] });
    mixer.Step(Ticks.PerSecond / 60);
    Support.Equal(mixer.Row[0], 0.5f, "the upper layer");
    mixer.SetWeight(1, 0);
    mixer.Step(Ticks.PerSecond / 60);
    Support.Equal(mixer.Row[0], 0.75f, "the lower layer");
  }

  /// <summary>Resident memory in MiB, or -1 where /proc is missing.</summary>
  static double Resident() {
    if (!File.Exists("/proc/self/statm")) return -1;
    return long.Parse(File.ReadAllText("/proc/self/statm").Split(' ')[1]) * 4096 / 1048576.0;
  }

  [MethodImpl(MethodImplOptions.NoInlining)]
  static ulong MakeRig(byte[] bytes, bool isDisposed) {
    Dna dna = Dna.Open(bytes);
    Rig rig = Rig.Create(dna);
    Instance face = rig.CreateInstance();
    face.Evaluate();
    ulong size = rig.Info.RigBytes;
    if (isDisposed) {
      dna.Dispose();
      rig.Dispose();
      face.Dispose();
    }
    return size;
  }

  public static void HundredsOfRigsTakeTheMemoryOfAFew() {
    if (Resident() < 0) {
      Console.WriteLine("NOT TESTED: memory of released objects; there is no /proc");
      return;
    }
    byte[] bytes = Dna.Generate(Preset.Medium).ToBytes();
    ulong size = MakeRig(bytes, true);
    for (int i = 0; i < 20; ++i) MakeRig(bytes, i % 2 == 0);
    Collect();
    double before = Resident();
    for (int i = 0; i < 200; ++i) {
      MakeRig(bytes, i % 2 == 0);
      if (i % 10 == 0) Collect();
    }
    Collect();
    double grown = Resident() - before, ofAll = 200 * size / 1048576.0;
    Support.True(grown < ofAll / 4, "memory grew by " + grown + " MiB; the rigs had " + ofAll);
  }
}
