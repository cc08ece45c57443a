// SPDX-License-Identifier: MIT
// What the Build.cs files use of UnrealBuildTool, and a program that runs them: for each platform, what they link and ship
// lies in ThirdParty/mien, and on this one it is there after an installation.
using System;
using System.Collections.Generic;
using System.IO;

namespace UnrealBuildTool {
  public enum UnrealTargetPlatform { Win64, Mac, Linux }

  public class ReadOnlyTargetRules {
    public UnrealTargetPlatform Platform;
  }

  public class RuntimeDependencyList {
    public readonly List<string> Paths = new List<string>();
    public void Add(string InPath) { Paths.Add(InPath); }
  }

  public class ModuleRules {
    public enum PCHUsageMode { UseExplicitOrSharedPCHs }
    public static string Plugin;
    public PCHUsageMode PCHUsage;
    public readonly List<string> PublicDependencyModuleNames = new List<string>();
    public readonly List<string> PrivateDependencyModuleNames = new List<string>();
    public readonly List<string> PublicSystemIncludePaths = new List<string>();
    public readonly List<string> PublicAdditionalLibraries = new List<string>();
    public readonly RuntimeDependencyList RuntimeDependencies = new RuntimeDependencyList();
    public string PluginDirectory { get { return Plugin; } }
    public ModuleRules(ReadOnlyTargetRules Target) {}
  }
}

static class Host {
  static int Main(string[] arguments) {
    // The folder of the plugin; modules that engine and plugin have.
    UnrealBuildTool.ModuleRules.Plugin = arguments[0];
    HashSet<string> modules = new HashSet<string> { "Core", "CoreUObject", "Engine", "AnimGraph", "BlueprintGraph",
                                                    "UnrealEd", "MienFace" };
    foreach (UnrealBuildTool.UnrealTargetPlatform platform in
             (UnrealBuildTool.UnrealTargetPlatform[])Enum.GetValues(typeof(UnrealBuildTool.UnrealTargetPlatform))) {
      UnrealBuildTool.ReadOnlyTargetRules target = new UnrealBuildTool.ReadOnlyTargetRules { Platform = platform };
      UnrealBuildTool.ModuleRules runtime = new MienFace(target), editor = new MienFaceEditor(target);
      foreach (string name in runtime.PublicDependencyModuleNames) Expect(modules.Contains(name), name);
      foreach (string name in editor.PublicDependencyModuleNames) Expect(modules.Contains(name), name);
      foreach (string name in editor.PrivateDependencyModuleNames) Expect(modules.Contains(name), name);
      Expect(editor.PublicDependencyModuleNames.Contains("MienFace"), "the editor module uses the other one");
      Expect(!runtime.PublicDependencyModuleNames.Contains("AnimGraph"), "a game has no AnimGraph");
      Expect(runtime.PublicAdditionalLibraries.Count == 1 && runtime.RuntimeDependencies.Paths.Count == 1,
             "one library");
      string suffix = platform == UnrealBuildTool.UnrealTargetPlatform.Win64 ? ".lib"
          : platform == UnrealBuildTool.UnrealTargetPlatform.Mac ? ".dylib" : ".so";
      Expect(runtime.PublicAdditionalLibraries[0].EndsWith(suffix), runtime.PublicAdditionalLibraries[0]);
      if (platform != UnrealBuildTool.UnrealTargetPlatform.Linux) continue;
      Expect(File.Exists(runtime.PublicAdditionalLibraries[0]), runtime.PublicAdditionalLibraries[0]);
      Expect(File.Exists(runtime.RuntimeDependencies.Paths[0]), runtime.RuntimeDependencies.Paths[0]);
      Expect(File.Exists(Path.Combine(runtime.PublicSystemIncludePaths[0], "mien.h")), "mien.h");
    }
    return 0;
  }

  static void Expect(bool truth, string what) {
    if (!truth) throw new Exception(what);
  }
}
