// SPDX-License-Identifier: MIT
using System;
using System.Text;
using System.Threading;
using Mien;
using Mien.Native;

/// <summary>Wrong use raises an exception that says what is wrong, and leaves the objects usable.</summary>
static class MisuseTest {
  public static void FilesThatAreNone() {
    Support.Fails(Status.FileOpen, "/nowhere/head.dna", () => Dna.Open("/nowhere/head.dna"));
    byte[] text = Encoding.ASCII.GetBytes("This is neither a DNA file nor a baked rig nor a clip, but long enough.");
    Support.Fails(Status.DnaSignature, "", () => Dna.Open(text));
    Support.Throws<MienException>("baked", () => Baked.Open(text));
    Support.Throws<MienException>("clip", () => Clip.Open(text));
    Rig rig = new Small().Rig;
    Support.Throws<MienException>("mix", () => Mix.Open(text, rig));
    byte[] bytes = Dna.Generate(Preset.Small).ToBytes();
    foreach (int length in new[] { 0, 1, 20, 1000, bytes.Length - 1 }) {
      var cut = new byte[length];
      Array.Copy(bytes, cut, length);
      Support.Throws<MienException>("cut", () => Dna.Open(cut));
    }
    var start = new byte[1000];
    Array.Copy(bytes, start, 1000);
    try {
      Dna.Open(start);
    } catch (MienException e) {
      Support.True(e.ByteOffset != null, "no byte offset");
    }
    Support.Throws<ArgumentNullException>("no bytes", () => Dna.Open((byte[])null));
    Support.Throws<ArgumentNullException>("no path", () => Dna.Open((string)null));
    Support.Throws<ArgumentException>("a null character", () => Dna.Open("head\0.dna"));
    Support.Fails(Status.Name, "nowhere", () => Dna.Open(bytes, system: "nowhere"));
  }

  public static void LibrariesOfAnotherVersion() {
    uint number = Functions.mien_version();
    Handle.CheckVersion(number);
    Support.Throws<NotSupportedException>("minor version", () => Handle.CheckVersion(number + (1 << 16)));
    Support.Throws<NotSupportedException>("major version", () => Handle.CheckVersion(number + (1 << 24)));
  }

  public static void DisposedObjects() {
    Dna dna = Dna.Generate(Preset.Small);
    Rig rig = Rig.Create(dna);
    Deformer deformer = Deformer.Create(dna, rig);
    Instance face = rig.CreateInstance(), living = rig.CreateInstance();
    Batch batch = rig.CreateBatch(1);
    DeformerInstance body = deformer.CreateInstance();
    Clip clip = Clip.Build(new ClipDesc { Names = new[] { rig.Name(Kind.RawControl, 0) }, Values = new float[2] });
    ClipPlayer player = clip.CreatePlayer();
    ClipBinding binding = clip.Bind(rig);
    Mix mix = rig.CreateMix(new MixDesc { Layers = new[] { new MixLayer() } });
    Mixer mixer = mix.CreateMixer();
    ReadOnlyView<float> joints = face.Joints, positions = body.Positions(0), sample = player.Sample();
    View<float> controls = face.RawControls;
    Mesh mesh = deformer.Mesh(0);
    Support.True(joints.Length > 0 && positions.Length > 0, "no values");
    foreach (IDisposable one in new IDisposable[] {
               dna, face, batch, body, player, clip, binding, mixer, mix, deformer, rig }) {
      one.Dispose();
      one.Dispose();
    }
    foreach (Action use in new Action[] {
               () => Rig.Create(dna), () => dna.ToBytes(), () => rig.CreateInstance(), () => rig.BakeBytes(),
               () => rig.Count(Kind.Joint), () => deformer.CreateInstance(), () => face.Evaluate(), () => face.Reset(),
               () => living.Evaluate(), () => body.Deform(0), () => body.Update(living),
               () => batch.Evaluate(new Instance[0]), () => clip.ToBytes(), () => player.Sample(),
               () => binding.Apply(sample.ToArray(), living), () => mix.CreateMixer(), () => mixer.Step(1),
               () => mixer.Play(0, clip, binding), () => mixer.Row.ToArray(),
               () => { float value = joints[0]; }, () => { float value = positions[0]; }, () => controls[0] = 1,
               () => controls.Span.Clear(), () => { float value = mesh.Positions[0]; }, () => sample.ToArray() }) {
      Support.Throws<ObjectDisposedException>("a disposed object was used", use);
    }
    Support.Equal(living.Joints[0], 0f, "joints of an instance outlive the rig object");
  }

  public static void ObjectsOfAnotherRig() {
    var small = new Small();
    Rig other = new Small(Preset.Medium).Rig;
    Instance face = small.Rig.CreateInstance(), stranger = other.CreateInstance();
    Support.Fails(Status.Mismatch, "another rig", () => small.Deformer.CreateInstance().Update(stranger));
    Support.Fails(Status.Mismatch, "", () => small.Rig.CreateBatch(2).Evaluate(new[] { face, stranger }));
    Clip clip = Clip.Build(new ClipDesc { Names = new[] { "a" }, Values = new float[2] });
    Mixer mixer = small.Rig.CreateMix(new MixDesc { Layers = new[] { new MixLayer() } }).CreateMixer();
    Support.Fails(Status.Mismatch, "", () => mixer.Play(0, clip, clip.Bind(other)));
    Support.Fails(Status.Mismatch, "", () => mixer.Step(1, stranger));
    Support.Fails(Status.InvalidArgument, "", () => clip.Bind(small.Rig).Apply(new float[1], stranger));
    mixer.Step(1, face);
  }

  public static void IndicesLodsAndSizes() {
    var small = new Small();
    Instance face = small.Rig.CreateInstance();
    View<float> controls = face.RawControls;
    foreach (int index in new[] { -1, controls.Length, int.MaxValue }) {
      Support.Throws<IndexOutOfRangeException>("control " + index, () => controls[index] = 1);
    }
    Support.Throws<IndexOutOfRangeException>("joint", () => { float value = face.Joints[face.Joints.Length]; });
    Support.Fails(Status.Lod, "", () => face.Evaluate(99));
    Support.Fails(Status.Lod, "", () => face.Evaluate(-1));
    Support.Fails(Status.InvalidArgument, "", () => face.Evaluate(0, (Stage)(1 << 20)));
    Support.Fails(Status.Index, "", () => small.Rig.Name(Kind.Joint, 1000000));
    Support.Fails(Status.Name, "nobody", () => face["nobody"] = 1);
    Support.Fails(Status.Index, "no such mesh", () => small.Deformer.Mesh(99));
    Batch batch = small.Rig.CreateBatch(1);
    Support.Throws<ArgumentException>("too many", () => batch.Evaluate(new[] { face, small.Rig.CreateInstance() }));
    Support.Throws<ArgumentException>("LODs", () => batch.Evaluate(new[] { face }, lodOfEach: new int[2]));
    Support.Throws<ArgumentNullException>("a null", () => batch.Evaluate(new Instance[] { null }));
    Support.Fails(Status.InvalidArgument, "", () => small.Rig.CreateBatch(2).Evaluate(new[] { face, face }));
    Support.Throws<ArgumentOutOfRangeException>("capacity", () => small.Rig.CreateBatch(-1));
    DeformerInstance body = small.Deformer.CreateInstance();
    Support.Fails(Status.InvalidArgument, "number of values", () => body.Update(new float[1], new float[0]));
    Support.Fails(Status.InvalidArgument, "", () => body.WriteVertices(0, new float[3], default(Span<float>)));
    Support.Throws<ArgumentException>("normals", () => body.WriteVertices(0, new float[300000], new float[3]));
    Support.Fails(Status.InvalidArgument, "10 numbers", () => body.LocalTransforms(new float[9]));
    Support.Throws<ArgumentException>("values",
        () => Clip.Build(new ClipDesc { Names = new[] { "a", "b" }, Values = new float[3] }));
    Clip clip = Clip.Build(new ClipDesc { Names = new[] { "a" }, Values = new float[2] });
    Support.Throws<MienException>("frames", () => clip.Read(1, new float[2]));
    Support.Fails(Status.InvalidArgument, "out of range", () => clip.CreatePlayer().SetSpeed(1, 0));
    Mixer mixer = small.Rig.CreateMix(new MixDesc {
      Layers = new[] {
        new MixLayer { Source = LayerSource.Stream, Curves = new[] { small.Rig.Name(Kind.RawControl, 0) } }
      }
    }).CreateMixer();
    Support.Fails(Status.Mismatch, "", () => mixer.Push(0, 1, new float[2]));
    Support.Fails(Status.InvalidArgument, "", () => mixer.Push(0, 1, new[] { float.NaN }));
    Support.Fails(Status.Index, "", () => mixer.SetWeight(1, 1));
    Support.Fails(Status.InvalidArgument, "", () => mixer.Stage(0));
    Support.Fails(Status.InvalidArgument, "", () => mixer.Restore(new byte[10]));
    Support.Fails(Status.Index, "no such guard", () => mixer.Guard(0));
    Support.Fails(Status.Name, "", () => small.Deformer.CreateGaze("nobody", "nobody"));
    Support.Fails(Status.Name, "nobody", () => small.Rig.CreateMix(new MixDesc {
      Layers = new[] { new MixLayer { Source = LayerSource.Poses, Poses = new[] { new Pose { { "nobody", 1 } } } } }
    }));
    Support.Throws<ArgumentException>("limits", () => small.Rig.CreateMix(new MixDesc { Lower = new float[1] }));
    using (Dna dna = Dna.Generate(Preset.Small)) {
      Support.Fails(Status.Name, "nothing", () => dna.ReadFloats("defn.nothing"));
      Support.Fails(Status.InvalidArgument, "", () => Rig.Create(dna, new MienRigDesc { Storage = (Storage)99 }));
    }
    face.Evaluate();
  }

  public static void DisposeWhileOtherThreadsEvaluate() {
    // A call that began keeps the memory; later ones throw.
    for (int round = 0; round < 20; ++round) {
      Rig rig = new Small().Rig;
      var faces = new Instance[2];
      var threads = new Thread[2];
      int disposed = 0, wrong = 0;
      for (int i = 0; i < 2; ++i) {
        Instance face = faces[i] = rig.CreateInstance();
        threads[i] = new Thread(() => {
          try {
            for (int k = 0; k < 1000000; ++k) face.Evaluate();
          } catch (ObjectDisposedException) {
            Interlocked.Increment(ref disposed);
          } catch (Exception) {
            Interlocked.Increment(ref wrong);
          }
        });
        threads[i].Start();
      }
      Thread.Sleep(2);
      if (round % 2 == 0) rig.Dispose();
      foreach (Instance face in faces) face.Dispose();
      foreach (Thread thread in threads) thread.Join();
      Support.Equal(wrong, 0, "other exceptions");
      Support.Equal(disposed, 2, "threads that noticed");
    }
  }
}
