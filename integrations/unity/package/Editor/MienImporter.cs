// SPDX-License-Identifier: MIT
using System.IO;
using Mien.Native;
using UnityEditor.AssetImporters;
using UnityEngine;

namespace Mien.Unity.Editor {
  /// <summary>DNA files become baked rigs in the axes and units of Unity.</summary>
  [ScriptedImporter(1, "dna")]
  public sealed class MienImporter : ScriptedImporter {
    /// <summary>Half the memory for the joint matrix, with half precision.</summary>
    public bool halfPrecision;

    public override void OnImportAsset(AssetImportContext context) {
      MienRigAsset asset = ScriptableObject.CreateInstance<MienRigAsset>();
      try {
        asset.Fill(Bake(context.assetPath));
      } catch (MienException error) {
        context.LogImportError(error.Message);
      }
      context.AddObjectToAsset("rig", asset);
      context.SetMainObject(asset);
    }

    byte[] Bake(string path) {
      MienRigDesc desc = MienRigDesc.Create();
      desc.RotationOutput = RotationOutput.Quaternion;
      if (halfPrecision) desc.Storage = Storage.Bit_16;
      using (Dna dna = Dna.Open(path, system: "unity"))
      using (Rig rig = Rig.Create(dna, desc)) {
        if (dna.Info.MeshCount == 0) return rig.BakeBytes();
        using (Deformer deformer = Deformer.Create(dna, rig)) return rig.BakeBytes(deformer);
      }
    }
  }
}
