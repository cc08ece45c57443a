// SPDX-License-Identifier: MIT
// Runs the components for some frames as Unity would, and compares with the library.
using System;
using System.IO;
using System.Reflection;
using Mien;
using Mien.Native;
using Mien.Unity;
using Mien.Unity.Editor;
using UnityEditor.AssetImporters;
using UnityEngine;

static class Host {
  const int Frames = 5;

  static void Equal<T>(T got, T expected, string what) {
    if (!Equals(got, expected)) throw new Exception(what + " is " + got + ", not " + expected);
  }

  /// <summary>A message of Unity, which finds private methods by their names.</summary>
  static void Send(object component, string message) {
    MethodInfo method = component.GetType().GetMethod(message, BindingFlags.Instance | BindingFlags.NonPublic);
    method.Invoke(component, null);
  }

  static MienRigAsset Import(string path, string expectedError) {
    AssetImportContext context = new AssetImportContext { assetPath = path };
    new MienImporter().OnImportAsset(context);
    Equal(context.errors.Count, expectedError == null ? 0 : 1, "number of import errors");
    if (expectedError != null && !context.errors[0].Contains(expectedError)) throw new Exception(context.errors[0]);
    return (MienRigAsset)context.mainObject;
  }

  static MienFace MakeFace(MienRigAsset asset) {
    MienFace face = new MienFace { rig = asset };
    // Below a root, as an imported skeleton; one transform is of no joint.
    Transform root = new Transform { name = "not a joint" };
    for (int j = 0; j < asset.Rig.Count(Kind.Joint); ++j) {
      root.children.Add(new Transform { name = asset.Rig.Name(Kind.Joint, j) });
    }
    face.FindJoints(root);
    UnityEngine.Mesh mesh = new UnityEngine.Mesh();
    int channels = asset.Rig.Count(Kind.BlendShapeChannel);
    mesh.shapes = new string[channels + 1];
    mesh.shapes[0] = "not of the rig";
    for (int c = 0; c < channels; ++c) mesh.shapes[c + 1] = asset.Rig.Name(Kind.BlendShapeChannel, c);
    face.renderers = new[] { new SkinnedMeshRenderer { sharedMesh = mesh, weights = new float[channels + 1] } };
    face.renderers[0].weights[0] = -1;
    Send(face, "OnEnable");
    return face;
  }

  static void SetControls(View<float> controls, int frame) {
    for (int i = 0; i < controls.Length; ++i) controls[i] = (i * 7 + frame * 3) % 11 / 10f;
  }

  static void Compare(MienFace face, Rig rig, Deformer deformer, int frame) {
    using (Instance wanted = rig.CreateInstance())
    using (DeformerInstance pose = deformer.CreateInstance()) {
      SetControls(wanted.RawControls, frame);
      wanted.Evaluate(face.lod);
      pose.Update(wanted);
      float[] transforms = new float[10 * rig.Count(Kind.Joint)];
      pose.LocalTransforms(transforms);
      for (int j = 0; j < face.joints.Length; ++j) {
        Transform joint = face.joints[j];
        float[] got = { joint.localPosition.x, joint.localPosition.y, joint.localPosition.z,
                        joint.localRotation.x, joint.localRotation.y, joint.localRotation.z, joint.localRotation.w,
                        joint.localScale.x, joint.localScale.y, joint.localScale.z };
        for (int k = 0; k < 10; ++k) Equal(got[k], transforms[10 * j + k], "value " + k + " of joint " + j);
      }
      float[] weights = face.renderers[0].weights;
      Equal(weights[0], -1f, "a blend shape that the rig does not have");
      for (int c = 0; c + 1 < weights.Length; ++c) {
        Equal(weights[c + 1], 100 * wanted.BlendShapes[c], "blend shape " + c);
      }
      GraphicsBuffer buffer = new GraphicsBuffer();
      face.WriteSkinMatrices(buffer);
      float[] matrices = pose.SkinMatrices.ToArray();
      Equal(buffer.data.Length, matrices.Length, "numbers of skin matrices");
      for (int i = 0; i < matrices.Length; ++i) Equal((float)buffer.data.GetValue(i), matrices[i], "matrix number " + i);
    }
  }

  /// <summary>The edit-mode tests of the package, as the test runner finds them.</summary>
  static int RunTests() {
    int count = 0;
    foreach (Type type in Assembly.GetExecutingAssembly().GetTypes()) {
      foreach (MethodInfo method in type.GetMethods()) {
        if (!method.IsDefined(typeof(NUnit.Framework.TestAttribute), false)) continue;
        method.Invoke(Activator.CreateInstance(type), null);
        ++count;
      }
    }
    if (count == 0) throw new Exception("no tests");
    return count;
  }

  static int Main() {
    string folder = Path.Combine(Path.GetTempPath(), "mien-unity-" + Guid.NewGuid());
    Directory.CreateDirectory(folder);
    try {
      string path = Path.Combine(folder, "head.dna");
      using (Dna dna = Dna.Generate(Preset.Small, 3)) dna.Save(path);
      Import(Path.Combine(folder, "none.dna"), "none.dna");
      MienRigAsset asset = Import(path, null);

      MienRigDesc desc = MienRigDesc.Create();
      desc.RotationOutput = RotationOutput.Quaternion;
      using (Dna dna = Dna.Open(path, system: "unity"))
      using (Rig rig = Rig.Create(dna, desc))
      using (Deformer deformer = Deformer.Create(dna, rig)) {
        MienFace[] faces = { MakeFace(asset), MakeFace(asset), MakeFace(asset) };
        if (faces[0].joints.Length == 0 || faces[0].renderers[0].weights.Length < 2) throw new Exception("nothing to compare");
        for (int frame = 0; frame < Frames; ++frame) {
          SetControls(faces[0].Face.RawControls, frame);
          Send(faces[0], "LateUpdate");
          Compare(faces[0], rig, deformer, frame);
        }
        MienBatch batch = new MienBatch { faces = faces };
        faces[2].lod = 1;
        Send(batch, "OnEnable");
        for (int frame = 0; frame < Frames; ++frame) {
          for (int f = 0; f < faces.Length; ++f) SetControls(faces[f].Face.RawControls, frame + f);
          Send(batch, "Update");
          foreach (MienFace face in faces) Send(face, "LateUpdate");
          Send(batch, "LateUpdate");
          for (int f = 0; f < faces.Length; ++f) Compare(faces[f], rig, deformer, frame + f);
        }
        Send(batch, "OnDisable");
        foreach (MienFace face in faces) Send(face, "OnDisable");
        Send(asset, "OnDisable");
      }
    } finally {
      Directory.Delete(folder, true);
    }
    Console.WriteLine("importer, face and batch agree with the library for " + Frames + " frames; " + RunTests() +
                      " test of the package passes");
    return 0;
  }
}
