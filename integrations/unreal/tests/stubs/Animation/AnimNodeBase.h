// SPDX-License-Identifier: MIT
#pragma once
#include "CoreMinimal.h"

struct FAnimInstanceProxy;
struct FAnimationInitializeContext {
  FAnimInstanceProxy* AnimInstanceProxy;
};
struct FAnimationCacheBonesContext {};
struct FAnimationUpdateContext {};

struct FMeshPoseBoneIndex {
  int32 Index;
  explicit FMeshPoseBoneIndex(int32 index) : Index(index) {}
};
struct FCompactPoseBoneIndex {
  int32 Index;
  explicit FCompactPoseBoneIndex(int32 index) : Index(index) {}
  int32 GetInt() const { return Index; }
};

/// Every second bone of the mesh is in the pose.
struct FBoneContainer {
  std::map<FName, int32> Bones;
  int32 GetPoseBoneIndexForBoneName(const FName& name) const {
    const auto found = Bones.find(name);
    return found == Bones.end() ? INDEX_NONE : found->second;
  }
  FCompactPoseBoneIndex MakeCompactPoseIndex(const FMeshPoseBoneIndex& bone) const {
    return FCompactPoseBoneIndex(bone.Index % 2 == 0 ? bone.Index / 2 : INDEX_NONE);
  }
};
struct FCompactPose {
  FBoneContainer Bones;
  std::vector<FTransform> Transforms;
  const FBoneContainer& GetBoneContainer() const { return Bones; }
  FTransform& operator[](const FCompactPoseBoneIndex& bone) {
    return Transforms.at(static_cast<size_t>(bone.Index));
  }
};
struct FPoseContext {
  FCompactPose Pose;
};
struct FPoseLink {
  int Evaluated = 0;
  void Initialize(const FAnimationInitializeContext&) {}
  void CacheBones(const FAnimationCacheBonesContext&) {}
  void Update(const FAnimationUpdateContext&) {}
  void Evaluate(FPoseContext&) { ++Evaluated; }
};
struct FAnimNode_Base {
  virtual ~FAnimNode_Base() = default;
  virtual void Initialize_AnyThread(const FAnimationInitializeContext&) {}
  virtual void CacheBones_AnyThread(const FAnimationCacheBonesContext&) {}
  virtual void Update_AnyThread(const FAnimationUpdateContext&) {}
  virtual void Evaluate_AnyThread(FPoseContext&) {}
};
