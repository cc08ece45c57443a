// SPDX-License-Identifier: MIT
// For the test runner of the Unity editor (Edit Mode).
using System.IO;
using Mien.Native;
using NUnit.Framework;
using UnityEngine;

namespace Mien.Unity.Tests {
  public sealed class MienFaceTests {
    [Test]
    public void AJointFollowsItsControls() {
      MienRigDesc desc = MienRigDesc.Create();
      desc.RotationOutput = RotationOutput.Quaternion;
      MienRigAsset asset = ScriptableObject.CreateInstance<MienRigAsset>();
      using (Dna dna = Dna.Generate(Preset.Small, 3))
      using (Rig rig = Rig.Create(dna, desc))
      using (Deformer deformer = Deformer.Create(dna, rig)) {
        asset.Fill(rig.BakeBytes(deformer));
      }
      GameObject character = new GameObject("character");
      character.SetActive(false);
      MienFace face = character.AddComponent<MienFace>();
      face.rig = asset;
      character.SetActive(true);
      Instance controls = face.Face ?? asset.Rig.CreateInstance();  // outside of play mode nothing is enabled
      View<float> values = controls.RawControls;
      for (int i = 0; i < values.Length; ++i) values[i] = 0.5f;
      controls.Evaluate();
      float sum = 0;
      foreach (float value in controls.Joints.Span) sum += Mathf.Abs(value);
      Assert.Greater(sum, 0);
      Object.DestroyImmediate(character);
    }
  }
}
