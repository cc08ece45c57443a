// SPDX-License-Identifier: MIT
#pragma once

// The generated header has to be the last.
// clang-format off
#include "Animation/AnimNodeBase.h"
#include "CoreMinimal.h"
#include "AnimNode_Mien.generated.h"
// clang-format on

class UMienFaceComponent;

/** Sets the bones that have the names of joints to what the Mien Face component of the actor computed. */
USTRUCT(BlueprintInternalUseOnly)
struct MIENFACE_API FAnimNode_Mien : public FAnimNode_Base {
  GENERATED_BODY()

  UPROPERTY(EditAnywhere, BlueprintReadWrite, Category = Links)
  FPoseLink BasePose;

  virtual void Initialize_AnyThread(const FAnimationInitializeContext& Context) override;
  virtual void CacheBones_AnyThread(const FAnimationCacheBonesContext& Context) override;
  virtual void Update_AnyThread(const FAnimationUpdateContext& Context) override;
  virtual void Evaluate_AnyThread(FPoseContext& Output) override;

 private:
  TWeakObjectPtr<UMienFaceComponent> Face;  // the component may be destroyed before the node
  TArray<FTransform> Transforms;
};
