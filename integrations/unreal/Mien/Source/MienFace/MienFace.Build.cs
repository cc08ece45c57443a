// SPDX-License-Identifier: MIT
using System.IO;
using UnrealBuildTool;

// Headers and library of Mien lie in ThirdParty/mien of the plugin, as `cmake --install BUILD --prefix` puts them there.
// The module is not named Mien, because its export macro would then have the name of the one in mien/base.h.
public class MienFace : ModuleRules {
  public MienFace(ReadOnlyTargetRules Target) : base(Target) {
    PCHUsage = PCHUsageMode.UseExplicitOrSharedPCHs;
    PublicDependencyModuleNames.AddRange(new string[] { "Core", "CoreUObject", "Engine" });
    string Root = Path.Combine(PluginDirectory, "ThirdParty", "mien");
    PublicSystemIncludePaths.Add(Path.Combine(Root, "include"));
    // What is linked, and what goes beside the game.
    string Linked = "lib/libmien.so", Shipped = "lib/libmien.so.0";
    if (Target.Platform == UnrealTargetPlatform.Win64) {
      Linked = "lib/mien.lib";
      Shipped = "bin/mien.dll";
    } else if (Target.Platform == UnrealTargetPlatform.Mac) {
      Linked = "lib/libmien.dylib";
      Shipped = "lib/libmien.0.dylib";
    }
    PublicAdditionalLibraries.Add(Path.Combine(Root, Linked));
    RuntimeDependencies.Add(Path.Combine(Root, Shipped));
  }
}
