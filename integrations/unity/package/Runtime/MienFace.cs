// SPDX-License-Identifier: MIT
using System;
using Mien.Native;
using UnityEngine;

namespace Mien.Unity {
  /// <summary>One character. Set controls before LateUpdate, which evaluates the rig and drives what is assigned:
  /// transforms of joints and blend shapes of renderers. Frames allocate nothing.</summary>
  public sealed class MienFace : MonoBehaviour {
    public MienRigAsset rig;
    public int lod;

    /// <summary>In the order of the rig's joints; empty where nothing is to be moved. FindJoints() fills it by name.
    /// </summary>
    public Transform[] joints = new Transform[0];

    /// <summary>Their blend shapes are driven by the channels of the same names.</summary>
    public SkinnedMeshRenderer[] renderers = new SkinnedMeshRenderer[0];

    /// <summary>Off for faces that a MienBatch evaluates.</summary>
    public bool evaluatesItself = true;

    Instance face;
    DeformerInstance pose;
    float[] transforms, matrices;
    int[][] channels;  // of each renderer's blend shapes; -1: none of the rig

    /// <summary>Its controls and results; null while the component is disabled.</summary>
    public Instance Face { get { return face; } }

    /// <summary>Its matrices and meshes; null without geometry.</summary>
    public DeformerInstance Pose { get { return pose; } }

    public float this[string rawControl] {
      get { return face[rawControl]; }
      set { face[rawControl] = value; }
    }

    void OnEnable() {
      if (rig == null) return;
      face = rig.Rig.CreateInstance();
      if (rig.Deformer != null) {
        pose = rig.Deformer.CreateInstance();
        transforms = new float[10 * rig.Rig.Count(Kind.Joint)];
        matrices = new float[pose.SkinMatrices.Length];
      }
      channels = new int[renderers.Length][];
      for (int r = 0; r < renderers.Length; ++r) {
        UnityEngine.Mesh mesh = renderers[r].sharedMesh;
        channels[r] = new int[mesh.blendShapeCount];
        for (int s = 0; s < channels[r].Length; ++s) {
          channels[r][s] = rig.Rig.Find(Kind.BlendShapeChannel, mesh.GetBlendShapeName(s));
        }
      }
    }

    void OnDisable() {
      if (pose != null) pose.Dispose();
      if (face != null) face.Dispose();
      pose = null;
      face = null;
    }

    /// <summary>Takes the transforms below `root` that have the names of joints.</summary>
    public void FindJoints(Transform root) {
      joints = new Transform[rig.Rig.Count(Kind.Joint)];
      Take(root);
    }

    void Take(Transform at) {
      int joint = rig.Rig.Find(Kind.Joint, at.name);
      if (joint >= 0) joints[joint] = at;
      for (int c = 0; c < at.childCount; ++c) Take(at.GetChild(c));
    }

    void LateUpdate() {
      if (face == null) return;
      if (evaluatesItself) {
        face.Evaluate(lod);
        Apply();
      }
    }

    /// <summary>Drives joints and blend shapes by the last evaluation.</summary>
    public void Apply() {
      ReadOnlyView<float> weights = face.BlendShapes;
      for (int r = 0; r < channels.Length; ++r) {
        for (int s = 0; s < channels[r].Length; ++s) {
          if (channels[r][s] >= 0) renderers[r].SetBlendShapeWeight(s, 100 * weights[channels[r][s]]);
        }
      }
      if (pose == null) return;
      pose.Update(face);
      if (joints.Length == 0) return;
      pose.LocalTransforms(transforms);
      for (int j = 0; j < joints.Length; ++j) {
        if (joints[j] == null) continue;
        int t = 10 * j;
        joints[j].localPosition = new Vector3(transforms[t], transforms[t + 1], transforms[t + 2]);
        joints[j].localRotation =
            new Quaternion(transforms[t + 3], transforms[t + 4], transforms[t + 5], transforms[t + 6]);
        joints[j].localScale = new Vector3(transforms[t + 7], transforms[t + 8], transforms[t + 9]);
      }
    }

    /// <summary>Writes the skin matrices, as DeformerInstance.SkinMatrices has them, for shaders that skin by
    /// themselves. The buffer has a stride of 4 bytes and place for all numbers.</summary>
    public void WriteSkinMatrices(GraphicsBuffer buffer) {
      pose.SkinMatrices.Span.CopyTo(matrices);
      buffer.SetData(matrices);
    }
  }
}
