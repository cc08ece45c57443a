// SPDX-License-Identifier: MIT
using System;
using System.Globalization;
using Mien;
using Mien.Native;

/// <summary>mix: a head speaks, is glad, and closes its eyes when a flashlight hits them.</summary>
static class MixExample {
  static void Main() {
    using (Dna dna = Dna.Generate(Preset.Head))
    using (Rig rig = Rig.Create(dna))
    using (Deformer deformer = Deformer.Create(dna, rig))
    using (Instance face = rig.CreateInstance()) {
      // Speech: the jaw at 60 frames a second, closed for every m of "mama mama".
      var jaw = new float[180];
      for (int i = 0; i < jaw.Length; ++i) {
        int phase = i % 30;
        jaw[i] = phase < 8 ? 0 : (phase - 8) * (29 - phase) / 220f;
      }

      // Joy over it, held back where it would part the lips; the flashlight acts last.
      var joy = new Pose {
        { "jawOpen", 0.2f }, { "mouthSmileLeft", 0.9f }, { "mouthSmileRight", 0.9f },
        { "cheekSquintLeft", 0.6f }, { "cheekSquintRight", 0.6f }
      };
      var flashlight = new MixReaction {
        Strokes = new[] {
          new MixStroke {
            Pose = new Pose { { "eyeBlinkLeft", 1 }, { "eyeBlinkRight", 1 } }, Mode = BlendMode.Max,
            Delay = Ticks.Of(0.06), Attack = Ticks.Of(0.07), Hold = Ticks.Of(0.06), Release = Ticks.Of(0.22)
          },
          new MixStroke {
            Pose = new Pose { { "eyeSquintLeft", 0.8f }, { "eyeSquintRight", 0.8f } }, Mode = BlendMode.Screen,
            Delay = Ticks.Of(0.09), Attack = Ticks.Of(0.15), Release = Ticks.Of(0.4), IsHeld = true
          }
        },
        Cooldown = Ticks.Of(0.25), Adapted = 0.6f, AdaptTicks = Ticks.Of(1.5), RecoverTicks = Ticks.Of(1.5)
      };
      var desc = new MixDesc {
        Layers = new[] {
          new MixLayer { Source = LayerSource.Clip, Group = LayerGroup.Speech },
          new MixLayer {
            Source = LayerSource.Poses, Group = LayerGroup.Emotion, Mode = BlendMode.Screen, Poses = new[] { joy }
          }
        },
        Reactions = new[] { flashlight }, Guards = Guard.Lips, Deformer = deformer
      };
      using (Clip speech = Clip.Build(new ClipDesc { Names = new[] { "jawOpen" }, Values = jaw }))
      using (ClipBinding binding = speech.Bind(rig))
      using (Mix mix = rig.CreateMix(desc))
      using (Mixer mixer = mix.CreateMixer()) {
        mixer.Play(0, speech, binding, new MienPlayDesc { TransitionTicks = Ticks.Of(0.1) });
        mixer.SetPoseWeight(1, 0, 0.8f, Ticks.Of(0.5));
        for (int i = 1; i <= 150; ++i) {
          if (i == 90) mixer.Trigger(0, 1, Ticks.Of(0.6));
          mixer.Step(Ticks.PerSecond / 60, face);  // writes the raw controls of the face
          face.Evaluate();
          if (i % 10 != 0) continue;
          float most = float.NegativeInfinity;
          foreach (float value in face.Joints.Span) most = Math.Max(most, value);
          Console.WriteLine(string.Format(CultureInfo.InvariantCulture,
              "{0,3}  jaw {1:F4}  smile {2:F4}  lids {3:F4}  squint {4:F4}  joints up to {5:F3}", i, face["jawOpen"],
              face["mouthSmileLeft"], face["eyeBlinkLeft"], face["eyeSquintLeft"], most));
        }
      }
    }
  }
}
