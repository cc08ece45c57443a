// SPDX-License-Identifier: MIT
using System;
using System.IO;
using Mien;
using Mien.Native;

/// <summary>What the classes give is what the library computes, by every way to it; frames allocate nothing.</summary>
static class ValuesTest {
  public static void StructsHaveTheSizesOfTheHeader() {
    Support.True(Constants.Sizes.Length > 50, "there are few structs");
    for (int i = 0; i < Constants.Sizes.Length; ++i) {
      Support.Equal(Constants.Sizes[i][0], Constants.Sizes[i][1], "size of struct " + i);
    }
  }

  public static void BatchAndBakedFilesGiveTheBitsOfEvaluate() {
    var small = new Small();
    Baked baked = Baked.Open(small.Rig.BakeBytes(small.Deformer));
    Rig same = baked.CreateRig();
    Instance other = same.CreateInstance();
    Batch batch = small.Rig.CreateBatch(4);
    var faces = new Instance[3];
    for (int i = 0; i < 3; ++i) {
      faces[i] = small.Rig.CreateInstance();
      Support.SetControls(faces[i], i);
    }
    batch.Evaluate(faces);
    for (int i = 0; i < 3; ++i) {
      Instance again = small.Rig.CreateInstance();
      Support.SetControls(again, i);
      again.Evaluate();
      Support.ArraysEqual(faces[i].Joints.ToArray(), again.Joints.ToArray(), "joints of the batch");
      Support.ArraysEqual(faces[i].BlendShapes.ToArray(), again.BlendShapes.ToArray(), "blend shapes of the batch");
      Support.SetControls(other, i);
      other.Evaluate();
      Support.ArraysEqual(other.Joints.ToArray(), again.Joints.ToArray(), "joints of the baked rig");
    }
    int different = 0;
    for (int j = 0; j < other.Joints.Length; ++j) different += faces[0].Joints[j] != faces[1].Joints[j] ? 1 : 0;
    Support.True(different > 0, "different controls gave the same joints");
  }

  public static void BatchesTakeOneLodPerInstance() {
    var small = new Small(Preset.Medium);
    int last = (int)small.Rig.Info.LodCount - 1;
    Support.True(last > 0, "there is one LOD only");
    Instance[] faces = { small.Rig.CreateInstance(), small.Rig.CreateInstance() };
    Instance[] again = { small.Rig.CreateInstance(), small.Rig.CreateInstance() };
    for (int i = 0; i < 2; ++i) {
      Support.SetControls(faces[i], i);
      Support.SetControls(again[i], i);
    }
    small.Rig.CreateBatch(2).Evaluate(faces, lodOfEach: new[] { 0, last });
    again[0].Evaluate(0);
    again[1].Evaluate(last);
    for (int i = 0; i < 2; ++i) Support.ArraysEqual(faces[i].Joints.ToArray(), again[i].Joints.ToArray(), "joints");
  }

  public static void ADnaFileSurvivesMemoryAndDisk() {
    string path = Path.GetTempFileName();
    using (Dna dna = Dna.Generate(Preset.Small, 5)) {
      byte[] bytes = dna.ToBytes();
      Support.Equal((int)dna.Info.RawControlCount, Rig.Create(dna).Count(Kind.RawControl), "raw controls");
      dna.Save(path);
      using (Dna again = Dna.Open(path)) Support.ArraysEqual(again.ToBytes(), bytes, "bytes");
      using (Dna again = Dna.Open(bytes)) Support.ArraysEqual(again.ToBytes(), bytes, "bytes");
      using (Dna meters = Dna.Open(path, system: "unity")) {
        Support.Equal(meters.Info.TranslationUnit, TranslationUnit.Meters, "unit");
      }
      Support.Equal(dna.ReadString("defn.jointNames[0]"), Rig.Create(dna).Name(Kind.Joint, 0), "name");
      Support.Equal((long)dna.Field("defn.jointNames").Count, (long)dna.Info.JointCount, "names");
      Support.Equal(dna.ReadIntegers("desc.lodCount")[0], (long)dna.Info.LodCount, "LODs");
      Support.True(dna.ReadFloats("defn.neutralJointTranslations.xs").Length == dna.Info.JointCount, "translations");
    }
    File.Delete(path);
  }

  public static void NamesAndIndicesAreInverse() {
    Rig rig = new Small().Rig;
    foreach (Kind kind in new[] { Kind.RawControl, Kind.Joint }) {
      Support.True(rig.Count(kind) > 2, "few of " + kind);
      for (int i = 0; i < rig.Count(kind); ++i) Support.Equal(rig.Find(kind, rig.Name(kind, i)), i, "index");
    }
    Support.Equal(rig.Find(Kind.Joint, "nobody"), -1, "index of an unknown name");
    Support.Equal(rig.JointParents.Length, rig.Count(Kind.Joint), "parents");
    Instance face = rig.CreateInstance();
    face[rig.Name(Kind.RawControl, 2)] = 0.25f;
    Support.Equal(face.RawControls[2], 0.25f, "control");
  }

  public static void TheDeformerMovesWhatJointsMoveAndWritesTheSameVertices() {
    var small = new Small();
    Instance face = small.Rig.CreateInstance();
    DeformerInstance body = small.Deformer.CreateInstance();
    Mesh mesh = small.Deformer.Mesh(0);
    body.Update(face);
    body.Deform(0, Normals.Recomputed);
    float[] neutral = body.Positions(0).ToArray();
    for (int i = 0; i < neutral.Length; ++i) {
      Support.True(Math.Abs(neutral[i] - mesh.Positions[i]) < 1e-3, "the neutral pose moves the mesh");
    }
    Support.SetControls(face, 1);
    face.Evaluate();
    body.Update(face);
    body.Deform(0, Normals.Recomputed);
    float[] positions = body.Positions(0).ToArray(), matrices = body.SkinMatrices.ToArray();
    float farthest = 0;
    for (int i = 0; i < neutral.Length; ++i) farthest = Math.Max(farthest, Math.Abs(positions[i] - neutral[i]));
    Support.True(farthest > 0.01, "nothing moved");
    Support.Equal(matrices.Length, 16 * small.Rig.Count(Kind.Joint), "matrices");

    var vertices = new float[3 * mesh.VertexCount];
    var normals = new float[3 * mesh.VertexCount];
    body.WriteVertices(0, vertices, normals);
    for (int i = 0; i < mesh.VertexCount; ++i) {
      int position = (int)mesh.VertexPositionIndices[i];
      for (int k = 0; k < 3; ++k) Support.Equal(vertices[3 * i + k], positions[3 * position + k], "vertex");
    }
    body.Update(face.Joints.Span, face.BlendShapes.Span);
    Support.ArraysEqual(body.SkinMatrices.ToArray(), matrices, "matrices from values");
    var locals = new float[10 * small.Rig.Count(Kind.Joint)];
    body.LocalTransforms(locals);
    Support.True(Math.Abs(locals[6]) > 0, "the root has no rotation");
  }

  public static void ClipsKeepEveryBitPlayAndDriveTheControlsTheyName() {
    Rig rig = new Small().Rig;
    var values = new float[200];
    for (int i = 0; i < 200; ++i) values[i] = i / 300f;
    Clip clip = Clip.Build(new ClipDesc {
      Names = new[] { rig.Name(Kind.RawControl, 1), "nobody" }, Values = values, RateNumerator = 30,
      Events = new[] { new ClipEvent { Tick = Ticks.Of(0.5), Name = "step", Value = 2 } }
    });
    var read = new float[200];
    clip.Read(0, read);
    Support.ArraysEqual(read, values, "values");
    string path = Path.GetTempFileName();
    clip.Save(path);
    using (Clip opened = Clip.Open(path)) Support.ArraysEqual(opened.ToBytes(), clip.ToBytes(), "bytes");
    File.Delete(path);
    ClipPlayer player = Clip.Open(clip.ToBytes()).CreatePlayer();
    player.Advance(Ticks.Of(1));
    ClipEvent passed;
    Support.True(player.TryNextEvent(out passed), "no event");
    Support.Equal(passed.Name + passed.Value, "step2", "event");
    Support.True(!player.TryNextEvent(out passed), "a second event");
    Support.Equal(player.Sample()[0], values[60], "frame 30");
    Instance face = rig.CreateInstance();
    ClipBinding binding = clip.Bind(rig, arkit: true);
    binding.Apply(player.Sample().Span, face);
    Support.Equal(face.RawControls[1], values[60], "control");
    Support.Equal(face.RawControls[2], 0f, "another control");
    Support.Equal(binding.MissingChannels[0], (ushort)1, "missing channel");
    player.SetSpeed(2);
    player.Seek(0);
    player.Advance(Ticks.Of(1));
    Support.Equal(player.Info.Tick, Ticks.Of(2), "tick");
  }

  public static void AMixOpensAgainItsMixerRestoresAndEventsArrive() {
    Rig rig = new Small().Rig;
    string name = rig.Name(Kind.RawControl, 0), other = rig.Name(Kind.RawControl, 1);
    Mix mix = rig.CreateMix(new MixDesc {
      Variables = new[] { "surprise" },
      Layers = new[] {
        new MixLayer { Mask = new Pose { { name, 1 }, { other, 0.5f }, { "surprise", 1 } } },
        new MixLayer { Source = LayerSource.Poses, Group = LayerGroup.Emotion, Mode = BlendMode.Add,
                       Poses = new[] { new Pose { { other, 0.25f } } } },
        new MixLayer { Source = LayerSource.Stream, Group = LayerGroup.Emotion, Mode = BlendMode.Add,
                       Curves = new[] { "surprise" } }
      }
    });
    Support.ArraysEqual(Mix.Open(mix.ToBytes(), rig).ToBytes(), mix.ToBytes(), "bytes");
    Support.True(mix.ToText().Contains(name), "the text has no name");
    Support.Equal((int)mix.Info.LayerCount, 3, "layers");
    Clip clip = Clip.Build(new ClipDesc {
      Names = new[] { name, other }, Values = new[] { 0.5f, 0.5f, 0.5f, 0.5f }, Looping = Looping.Clamp,
      Events = new[] { new ClipEvent { Tick = 100, Name = "now", Value = 3 } }
    });
    ClipBinding binding = clip.Bind(rig);
    Mixer mixer = mix.CreateMixer();
    Instance face = rig.CreateInstance();
    mixer.Play(0, clip, binding, new MienPlayDesc { ClipId = 7, Transition = Transition.Cut });
    mixer.SetPoseWeight(1, 0, 1);
    Support.True(mixer.Push(2, 0, new[] { 0.75f }), "the row was not taken");
    Support.True(!mixer.Push(2, 0, new[] { 0.75f }), "an old row was taken");
    mixer.Step(200, face);
    Support.Equal((int)mixer.Info.EventCount, 1, "events");
    int layer;
    ClipEvent passed = mixer.Event(0, out layer);
    Support.Equal(passed.Name + passed.Value + layer, "now30", "event");
    Support.Equal(face.RawControls[0], 0.5f, "control");
    Support.Equal(face.RawControls[1], 0.5f, "control of two layers");
    const long frame = Ticks.PerSecond / 60;
    for (int i = 1; i <= 60; ++i) {  // the stream fades in
      mixer.Push(2, i * frame, new[] { 0.75f });
      mixer.Step(frame);
    }
    Support.Equal(mixer.Row[face.RawControls.Length], 0.75f, "variable");
    Mixer again = mix.CreateMixer();
    again.Restore(mixer.Snapshot(), new MixerClip { ClipId = 7, Clip = clip, Binding = binding });
    mixer.SetPoseWeight(1, 0, 0, 5 * frame);
    again.SetPoseWeight(1, 0, 0, 5 * frame);
    float first = mixer.Row[1];
    for (int i = 0; i < 4; ++i) {
      mixer.Step(frame);
      again.Step(frame);
      for (int k = 0; k < face.RawControls.Length; ++k) Support.Equal(again.Row[k], mixer.Row[k], "row after Restore");
    }
    Support.True(mixer.Row[1] < first, "the pose does not fade");
  }

  public static void TablesMeasuredOnTheGeneratedHead() {
    var head = new Small(Preset.Head);
    int left = head.Rig.Find(Kind.RawControl, "eyeBlinkLeft"), right = head.Rig.Find(Kind.RawControl, "eyeBlinkRight");
    NameMatch match;
    Support.Equal((int)head.Rig.Match("eyeBlink_L", out match)[0].Control, left, "control");
    Support.Equal(match, NameMatch.Spelling, "match");
    Support.Equal(head.Rig.Match("no such expression", out match).Length, 0, "shares");
    Instance face = head.Rig.CreateInstance();
    ushort[] mirror = head.Deformer.Mirror(face.RawControls.Length);
    Support.Equal((int)mirror[left], right, "counterpart");
    Gaze gaze = head.Deformer.CreateGaze();
    gaze.LookAt(300, 0, 1000, face);
    float[] toLeft = face.RawControls.ToArray();
    MienGazeRest rest = gaze.LookAt(5000, 0, 1000, face);
    Support.True(rest.Left > 0, "the eyes reach a target far to the side");
    float changed = 0;
    for (int i = 0; i < toLeft.Length; ++i) changed += Math.Abs(toLeft[i] - face.RawControls[i]);
    Support.True(changed > 0.1, "the eyes did not move");

    Clip clip = Clip.Build(new ClipDesc {
      Names = new[] { "eyeBlinkLeft" }, Values = new[] { 0.5f, 0.5f }, Looping = Looping.Clamp
    });
    Mixer mixer = head.Rig.CreateMix(new MixDesc {
      Layers = new[] { new MixLayer { Group = LayerGroup.Speech } }, Mirror = mirror, Gaze = gaze,
      Antagonists = head.Rig.Antagonists(), Guards = Guard.Lips, Deformer = head.Deformer
    }).CreateMixer(keepStages: true);
    mixer.Play(0, clip, clip.Bind(head.Rig), new MienPlayDesc { Transition = Transition.Cut, Mirrored = 1 });
    mixer.Step(1);
    Support.Equal(mixer.Row[right], 0.5f, "the other eye");
    Support.Equal(mixer.Stage(0)[right], 0.5f, "the first stage");
    Support.Equal(mixer.Row[left], 0f, "the eye of the clip");
    GuardState guard = mixer.Guard(0);
    Support.Equal(guard.Kind, Guard.Lips, "kind");
    Support.True(guard.Name.Length > 0 && guard.Controls.Length > 0, "the guard has no name or controls");
  }

  public static void FramesAllocateNothing() {
    var small = new Small();
    Instance face = small.Rig.CreateInstance();
    DeformerInstance body = small.Deformer.CreateInstance();
    Instance[] faces = { small.Rig.CreateInstance(), small.Rig.CreateInstance() };
    Batch batch = small.Rig.CreateBatch(2);
    string name = small.Rig.Name(Kind.RawControl, 0);
    Mixer mixer = small.Rig.CreateMix(new MixDesc {
      Layers = new[] {
        new MixLayer(), new MixLayer { Source = LayerSource.Poses, Poses = new[] { new Pose { { name, 1 } } } },
        new MixLayer { Source = LayerSource.Stream, Curves = new[] { name } }
      }
    }).CreateMixer();
    Clip clip = Clip.Build(new ClipDesc { Names = new[] { name }, Values = new float[100] });
    ClipBinding binding = clip.Bind(small.Rig);
    ClipPlayer player = clip.CreatePlayer();
    var vertices = new float[3 * small.Deformer.Mesh(0).VertexCount];
    var row = new float[1];
    long before = 0, after = 0;
    // The first frames compile the methods.
    for (int i = 0; i < 300; ++i) {
      if (i == 50) before = GC.GetAllocatedBytesForCurrentThread();
      mixer.Play(0, clip, binding);
      mixer.SetPoseWeight(1, 0, i % 2, 100);
      mixer.Push(2, i, row);
      mixer.Step(Ticks.PerSecond / 60, face);
      face.Evaluate();
      batch.Evaluate(faces);
      player.Advance(1000);
      binding.Apply(player.Sample().Span, face);
      body.Update(face);
      body.Deform(0);
      body.WriteVertices(0, vertices, default(Span<float>));
      row[0] = body.Positions(0)[0] + face.Joints[0] + mixer.Row[0] + body.SkinMatrices.Span[0];
      row[0] = Math.Min(Math.Abs(row[0]), 1);
    }
    after = GC.GetAllocatedBytesForCurrentThread();
    Support.Equal(after - before, 0L, "bytes of 250 frames");
    GC.KeepAlive(new byte[1000]);
    Support.True(GC.GetAllocatedBytesForCurrentThread() - after >= 1000, "bytes are not counted");
  }
}
