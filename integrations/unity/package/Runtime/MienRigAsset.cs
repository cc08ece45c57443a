// SPDX-License-Identifier: MIT
using UnityEngine;

namespace Mien.Unity {
  /// <summary>A baked rig with its geometry, in the axes and units of Unity, with quaternions.</summary>
  public sealed class MienRigAsset : ScriptableObject {
    [SerializeField] byte[] baked;

    Baked opened;
    Rig rig;
    Deformer deformer;

    public void Fill(byte[] bytes) {
      Close();
      baked = bytes;
    }

    /// <summary>Immutable, shared by all faces. Opened at the first use.</summary>
    public Rig Rig {
      get {
        Open();
        return rig;
      }
    }

    /// <summary>Null if the file has no geometry.</summary>
    public Deformer Deformer {
      get {
        Open();
        return deformer;
      }
    }

    void Open() {
      if (rig != null) return;
      opened = Baked.Open(baked);
      rig = opened.CreateRig();
      if (opened.Info.DeformerBytes != 0) deformer = opened.CreateDeformer(rig);
    }

    void OnDisable() { Close(); }

    // Faces that still use the rig keep its memory.
    void Close() {
      if (deformer != null) deformer.Dispose();
      if (rig != null) rig.Dispose();
      if (opened != null) opened.Dispose();
      deformer = null;
      rig = null;
      opened = null;
    }
  }
}
