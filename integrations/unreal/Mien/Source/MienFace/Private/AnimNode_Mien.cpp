// SPDX-License-Identifier: MIT
#include "AnimNode_Mien.h"

#include "Animation/AnimInstanceProxy.h"
#include "Components/SkeletalMeshComponent.h"
#include "GameFramework/Actor.h"
#include "MienFaceComponent.h"

void FAnimNode_Mien::Initialize_AnyThread(const FAnimationInitializeContext& Context) {
  BasePose.Initialize(Context);
  const USkeletalMeshComponent* Mesh = Context.AnimInstanceProxy->GetSkelMeshComponent();
  Face = Mesh && Mesh->GetOwner() ? Mesh->GetOwner()->FindComponentByClass<UMienFaceComponent>()
                                  : nullptr;
}

void FAnimNode_Mien::CacheBones_AnyThread(const FAnimationCacheBonesContext& Context) {
  BasePose.CacheBones(Context);
}

void FAnimNode_Mien::Update_AnyThread(const FAnimationUpdateContext& Context) {
  BasePose.Update(Context);
}

void FAnimNode_Mien::Evaluate_AnyThread(FPoseContext& Output) {
  BasePose.Evaluate(Output);
  const UMienFaceComponent* Component = Face.Get();
  if (!Component) return;
  Component->CopyJointTransforms(Transforms);
  const FBoneContainer& Bones = Output.Pose.GetBoneContainer();
  const TArray<FName>& Joints = Component->JointNames();
  for (int32 Joint = 0; Joint < Transforms.Num() && Joint < Joints.Num(); ++Joint) {
    const int32 Bone = Bones.GetPoseBoneIndexForBoneName(Joints[Joint]);
    if (Bone == INDEX_NONE) continue;
    const FCompactPoseBoneIndex Compact = Bones.MakeCompactPoseIndex(FMeshPoseBoneIndex(Bone));
    if (Compact.GetInt() != INDEX_NONE) Output.Pose[Compact] = Transforms[Joint];
  }
}
