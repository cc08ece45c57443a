// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using Mien.Native;

namespace Mien {
  /// <summary>A pose: values of curves by their names, such as new Pose { { "jawOpen", 0.5f } }. Curves are raw
  /// controls and
  /// the variables of the mix.</summary>
  public sealed class Pose : Dictionary<string, float> { }

  /// <summary>One layer; docs/mixing.md and MienMixLayer explain the fields.</summary>
  public sealed class MixLayer {
    public LayerSource Source;
    public LayerGroup Group;
    public BlendMode Mode;
    public float Weight = 1;
    public bool AfterGuards;

    /// <summary>Weights of curves, 0 of all others; null: 1 of all.</summary>
    public Pose Mask;

    /// <summary>Of a layer with LayerSource.Poses.</summary>
    public Pose[] Poses = new Pose[0];

    /// <summary>Names of the curves of a stream or generator.</summary>
    public string[] Curves = new string[0];

    /// <summary>Of a generator: a factor for each curve, or null.</summary>
    public float[] Amounts;

    public Generator Generator;

    /// <summary>Ticks.</summary>
    public long Period, Delay;
    public int StreamFrames;
  }

  /// <summary>One stroke of a reaction, as in MienMixStroke. Times are ticks.</summary>
  public sealed class MixStroke {
    public Pose Pose;
    public BlendMode Mode;
    public long Delay, Attack, Hold, Release;
    public bool IsHeld, IsLag, IsScaled;
  }

  /// <summary>A reaction to a stimulus, as in MienMixReaction. Times are ticks.</summary>
  public sealed class MixReaction {
    public MixStroke[] Strokes = new MixStroke[0];
    public Retrigger Retrigger;
    public bool AfterGuards;
    public long Cooldown, AdaptTicks, RecoverTicks;
    public float Adapted = 1, LevelOn, LevelOff;
  }

  /// <summary>What a mix does with the curves of a rig; docs/mixing.md and MienMixDesc explain it.</summary>
  public sealed class MixDesc {
    public MixLayer[] Layers = new MixLayer[0];
    public MixReaction[] Reactions = new MixReaction[0];

    /// <summary>Names of pose variables: curves behind the raw controls.</summary>
    public string[] Variables = new string[0];

    /// <summary>Such as of Rig.Antagonists.</summary>
    public MienMixAntagonists[] Antagonists = new MienMixAntagonists[0];

    /// <summary>Such as of Deformer.Mirror, so that clips can be played mirrored; else null.</summary>
    public ushort[] Mirror;

    /// <summary>Limits of all curves, or null.</summary>
    public float[] Lower, Upper;

    /// <summary>Measured with the deformer.</summary>
    public Guard Guards;
    public Deformer Deformer;

    /// <summary>For layers of Generator.Gaze.</summary>
    public Gaze Gaze;
    public int PlayerCount, MaxChannels, MaxChangingChannels, MaxEvents;
    public bool Reverse;
  }

  /// <summary>Makes the structs of a MixDesc.</summary>
  sealed unsafe class MixArrays : IDisposable {
    readonly Scratch scratch = new Scratch();
    readonly List<MienMixPose> poses = new List<MienMixPose>();
    readonly Rig rig;
    readonly string[] variables;
    readonly int rawCount;

    public MienMixDesc Desc = MienMixDesc.Create();

    public MixArrays(Rig rig, MixDesc from) {
      this.rig = rig;
      variables = from.Variables;
      rawCount = rig.Count(Kind.RawControl);
      try {
        Fill(from);
      } catch {
        Dispose();
        throw;
      }
    }

    public void Dispose() { scratch.Dispose(); }

    int CurveCount { get { return rawCount + variables.Length; } }

    ushort Curve(string name) {
      int variable = Array.IndexOf(variables, name);
      int index = variable >= 0 ? rawCount + variable : rig.Find(Kind.RawControl, name);
      if (index < 0) throw new MienException(Status.Name, "NAME: no raw control or variable " + name);
      return (ushort)index;
    }

    ushort[] Curves(string[] names) { return Array.ConvertAll(names, Curve); }

    /// <summary>The index of a pose.</summary>
    uint Pose(Pose pose) {
      var sorted = new SortedDictionary<ushort, float>();
      foreach (KeyValuePair<string, float> one in pose) sorted[Curve(one.Key)] = one.Value;
      poses.Add(new MienMixPose {
        Curves = scratch.Indices(sorted.Keys), Values = scratch.Floats(sorted.Values), Count = (UIntPtr)sorted.Count
      });
      return (uint)poses.Count - 1;
    }

    float* Mask(Pose mask) {
      var weights = new float[CurveCount];
      foreach (KeyValuePair<string, float> one in mask) weights[Curve(one.Key)] = one.Value;
      return scratch.Floats(weights);
    }

    float* OfAllCurves(float[] values, string what) {
      if (values != null && values.Length != CurveCount) throw new ArgumentException("not one value per curve", what);
      return scratch.Floats(values);
    }

    MienMixLayer Layer(MixLayer from) {
      if (from.Amounts != null && from.Amounts.Length != from.Curves.Length) {
        throw new ArgumentException("not one amount per curve");
      }
      var to = new MienMixLayer {
        Period = from.Period, Delay = from.Delay, Group = from.Group, Mode = from.Mode, Source = from.Source,
        AfterGuards = from.AfterGuards ? 1u : 0, Weight = from.Weight, Generator = from.Generator,
        StreamFrames = (uint)from.StreamFrames, FirstPose = (uint)poses.Count, PoseCount = (uint)from.Poses.Length,
        Curves = from.Curves.Length == 0 ? null : scratch.Indices(Curves(from.Curves)),
        CurveCount = (uint)from.Curves.Length, Amounts = scratch.Floats(from.Amounts)
      };
      if (from.Mask != null) {
        to.Mask = Mask(from.Mask);
        to.MaskCount = (uint)CurveCount;
      }
      foreach (Pose pose in from.Poses) Pose(pose);
      return to;
    }

    MienMixReaction Reaction(MixReaction from) {
      var strokes = (MienMixStroke*)scratch.Bytes((long)from.Strokes.Length * sizeof(MienMixStroke));
      for (int i = 0; i < from.Strokes.Length; ++i) {
        MixStroke one = from.Strokes[i];
        strokes[i] = new MienMixStroke {
          Delay = one.Delay, Attack = one.Attack, Hold = one.Hold, Release = one.Release, Pose = Pose(one.Pose),
          Mode = one.Mode, IsHeld = one.IsHeld ? 1u : 0, IsLag = one.IsLag ? 1u : 0, IsScaled = one.IsScaled ? 1u : 0
        };
      }
      return new MienMixReaction {
        Cooldown = from.Cooldown, AdaptTicks = from.AdaptTicks, RecoverTicks = from.RecoverTicks, Strokes = strokes,
        StrokeCount = (UIntPtr)from.Strokes.Length, Retrigger = from.Retrigger,
        AfterGuards = from.AfterGuards ? 1u : 0, Adapted = from.Adapted, LevelOn = from.LevelOn,
        LevelOff = from.LevelOff
      };
    }

    void Fill(MixDesc from) {
      Desc.Layers = (MienMixLayer*)scratch.Bytes((long)from.Layers.Length * sizeof(MienMixLayer));
      Desc.LayerCount = (UIntPtr)from.Layers.Length;
      for (int i = 0; i < from.Layers.Length; ++i) Desc.Layers[i] = Layer(from.Layers[i]);
      Desc.Reactions = (MienMixReaction*)scratch.Bytes((long)from.Reactions.Length * sizeof(MienMixReaction));
      Desc.ReactionCount = (UIntPtr)from.Reactions.Length;
      for (int i = 0; i < from.Reactions.Length; ++i) Desc.Reactions[i] = Reaction(from.Reactions[i]);
      Desc.Antagonists = (MienMixAntagonists*)scratch.Bytes((long)from.Antagonists.Length * sizeof(MienMixAntagonists));
      Desc.AntagonistCount = (UIntPtr)from.Antagonists.Length;
      for (int i = 0; i < from.Antagonists.Length; ++i) Desc.Antagonists[i] = from.Antagonists[i];
      if (from.Mirror != null && from.Mirror.Length != CurveCount) {
        throw new ArgumentException("not one counterpart per curve", "Mirror");
      }
      Desc.Mirror = scratch.Indices(from.Mirror);
      Desc.Lower = OfAllCurves(from.Lower, "Lower");
      Desc.Upper = OfAllCurves(from.Upper, "Upper");
      Desc.Guards = from.Guards;
      Desc.VariableCount = (uint)variables.Length;
      Desc.PlayerCount = (uint)from.PlayerCount;
      Desc.MaxChannels = (uint)from.MaxChannels;
      Desc.MaxChangingChannels = (uint)from.MaxChangingChannels;
      Desc.MaxEvents = (uint)from.MaxEvents;
      Desc.Reverse = from.Reverse ? 1u : 0;
      Desc.Poses = (MienMixPose*)scratch.Bytes((long)poses.Count * sizeof(MienMixPose));
      Desc.PoseCount = (UIntPtr)poses.Count;
      for (int i = 0; i < poses.Count; ++i) Desc.Poses[i] = poses[i];
    }
  }
}
