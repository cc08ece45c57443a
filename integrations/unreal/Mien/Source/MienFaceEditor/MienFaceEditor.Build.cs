// SPDX-License-Identifier: MIT
using UnrealBuildTool;

// What the editor needs of the plugin: the node in animation graphs. Packaged games do not have this module.
public class MienFaceEditor : ModuleRules {
  public MienFaceEditor(ReadOnlyTargetRules Target) : base(Target) {
    PCHUsage = PCHUsageMode.UseExplicitOrSharedPCHs;
    PublicDependencyModuleNames.AddRange(new string[] { "Core", "CoreUObject", "Engine", "AnimGraph", "MienFace" });
    PrivateDependencyModuleNames.AddRange(new string[] { "BlueprintGraph", "UnrealEd" });
  }
}
