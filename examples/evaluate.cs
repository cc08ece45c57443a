// SPDX-License-Identifier: MIT
using System;
using System.Globalization;
using Mien;

/// <summary>evaluate [FILE.dna [CONTROL]]: turns a control up and tells which joint moves or turns most.</summary>
static class Evaluate {
  static int Main(string[] args) {
    try {
      Run(args.Length > 0 ? args[0] : null, args.Length > 1 ? args[1] : "CTRL_expressions.jawOpen");
      return 0;
    } catch (MienException e) {
      Console.Error.WriteLine(e.Message);
      return 1;
    }
  }

  static void Run(string file, string control) {
    using (Dna dna = file != null ? Dna.Open(file) : Dna.Generate(Preset.Large))
    using (Rig rig = Rig.Create(dna))
    using (Instance face = rig.CreateInstance()) {
      if (rig.Find(Kind.RawControl, control) < 0) {  // some rigs leave the prefix out
        control = control.Substring(control.LastIndexOf('.') + 1);
      }
      face[control] = 1;  // or, with an index: controls[i] = 1, where controls is face.RawControls
      face.Evaluate();

      ReadOnlySpan<float> joints = face.Joints.Span;  // per joint tx ty tz rx ry rz sx sy sz
      int most = 0;
      for (int i = 0; i < joints.Length; ++i) {
        if (i % 9 < 6 && Math.Abs(joints[i]) > Math.Abs(joints[most])) most = i;
      }
      int joint = most / 9;
      ReadOnlySpan<float> d = joints.Slice(9 * joint, 9);
      Console.WriteLine(string.Format(CultureInfo.InvariantCulture,
          "{0} moves {1} most: by {2:F3} {3:F3} {4:F3}, turning it by {5:F3} {6:F3} {7:F3}", control,
          rig.Name(Kind.Joint, joint), d[0], d[1], d[2], d[3], d[4], d[5]));
    }
  }
}
