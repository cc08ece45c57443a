// SPDX-License-Identifier: MIT
using System;
using System.Reflection;
using System.Runtime.InteropServices;
using Mien;

/// <summary>Runs every public static method without parameters of the test classes.</summary>
static class Support {
  static int Main() {
    int count = 0, failures = 0;
    foreach (Type type in new[] { typeof(ValuesTest), typeof(MisuseTest), typeof(LifetimeTest) }) {
      foreach (MethodInfo test in type.GetMethods(BindingFlags.Public | BindingFlags.Static)) {
        ++count;
        try {
          ((Action)Delegate.CreateDelegate(typeof(Action), test))();
        } catch (Exception e) {
          ++failures;
          Console.WriteLine("FAILED " + type.Name + "." + test.Name + "\n" + e);
        }
      }
    }
    Console.WriteLine(count + " tests, " + failures + " failed");
    return failures == 0 ? 0 : 1;
  }

  public static void True(bool condition, string what) {
    if (!condition) throw new Exception(what);
  }

  public static void Equal<T>(T got, T expected, string what) {
    if (!Equals(got, expected)) throw new Exception(what + " is " + got + ", not " + expected);
  }

  public static void ArraysEqual<T>(T[] got, T[] expected, string what) {
    Equal(got.Length, expected.Length, "length of " + what);
    for (int i = 0; i < got.Length; ++i) Equal(got[i], expected[i], what + "[" + i + "]");
  }

  /// <summary>The call fails with this status, and its message has this text.</summary>
  public static MienException Fails(Status status, string text, Action call) {
    try {
      call();
    } catch (MienException e) {
      Equal(e.Status, status, "status of \"" + e.Message + "\"");
      True(e.Message.Contains(text), "\"" + e.Message + "\" does not contain \"" + text + "\"");
      return e;
    }
    throw new Exception("the call did not fail with " + status + " " + text);
  }

  public static void Throws<T>(string what, Action call) where T : Exception {
    try {
      call();
    } catch (T) {
      return;
    }
    throw new Exception("no " + typeof(T).Name + ": " + what);
  }

  /// <summary>Different values for the raw controls, from `seed`.</summary>
  public static void SetControls(Instance face, int seed) {
    View<float> controls = face.RawControls;
    for (int i = 0; i < controls.Length; ++i) controls[i] = (i * 7 + seed * 5) % 11 / 10f;
  }
}

/// <summary>A small rig with its deformer.</summary>
sealed class Small {
  public readonly Rig Rig;
  public readonly Deformer Deformer;

  public Small(Preset preset = Preset.Small) {
    using (Dna dna = Dna.Generate(preset, 5)) {
      Rig = Rig.Create(dna);
      Deformer = Deformer.Create(dna, Rig);
    }
  }
}
