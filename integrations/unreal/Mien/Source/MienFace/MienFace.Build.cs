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
    bool IsWindows = Target.Platform == UnrealTargetPlatform.Win64;
    PublicAdditionalLibraries.Add(Path.Combine(Root, "lib", IsWindows ? "mien.lib" : "libmien.so"));
    RuntimeDependencies.Add(Path.Combine(Root, IsWindows ? "bin/mien.dll" : "lib/libmien.so.0"));
  }
}
