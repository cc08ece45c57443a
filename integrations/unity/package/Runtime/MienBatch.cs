// SPDX-License-Identifier: MIT
using System.Runtime.InteropServices;
using Unity.Jobs;
using UnityEngine;

namespace Mien.Unity {
  /// <summary>Evaluates faces of one rig together: in Update as a job, which LateUpdate awaits. Set controls before
  /// Update, and not until LateUpdate.</summary>
  [DefaultExecutionOrder(100)]
  public sealed class MienBatch : MonoBehaviour {
    public MienFace[] faces = new MienFace[0];

    struct EvaluateJob : IJob {
      public GCHandle owner;

      public void Execute() { ((MienBatch)owner.Target).Evaluate(); }
    }

    Batch batch;
    Instance[] instances;
    int[] lods;
    GCHandle self;
    JobHandle running;
    bool isRunning;

    void OnEnable() { self = GCHandle.Alloc(this); }

    // Faces may be enabled after the batch.
    bool Prepare() {
      if (batch != null || faces.Length == 0) return batch != null;
      instances = new Instance[faces.Length];
      lods = new int[faces.Length];
      for (int i = 0; i < faces.Length; ++i) {
        if (faces[i].Face == null) return false;
        faces[i].evaluatesItself = false;
        instances[i] = faces[i].Face;
      }
      batch = faces[0].rig.Rig.CreateBatch(faces.Length);
      return true;
    }

    void OnDisable() {
      Await();
      self.Free();
      if (batch != null) batch.Dispose();
      batch = null;
    }

    void Update() {
      if (!Prepare()) return;
      for (int i = 0; i < faces.Length; ++i) lods[i] = faces[i].lod;
      running = new EvaluateJob { owner = self }.Schedule();
      isRunning = true;
    }

    void Evaluate() { batch.Evaluate(instances, 0, lods); }

    bool Await() {
      if (!isRunning) return false;
      running.Complete();
      isRunning = false;
      return true;
    }

    void LateUpdate() {
      if (!Await()) return;
      foreach (MienFace face in faces) face.Apply();
    }
  }
}
