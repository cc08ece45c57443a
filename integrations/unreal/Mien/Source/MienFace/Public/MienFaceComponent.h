// SPDX-License-Identifier: MIT
#pragma once

// The generated header has to be the last.
// clang-format off
#include "Components/ActorComponent.h"
#include "CoreMinimal.h"

#include <mien.h>

#include "MienFaceComponent.generated.h"
// clang-format on

/** What is opened of a file: shared by the components that name it. */
struct FMienRigFile {
  MienBaked* Baked = nullptr;
  MienRig* Rig = nullptr;
  MienDeformer* Deformer = nullptr;

  FMienRigFile() = default;
  FMienRigFile(const FMienRigFile&) = delete;
  FMienRigFile& operator=(const FMienRigFile&) = delete;
  ~FMienRigFile();
};

/** One character: controls by name; joints for FAnimNode_Mien, morph targets for the skeletal mesh of its actor. Set
 *  controls on the game thread, before the component ticks. */
UCLASS(meta = (BlueprintSpawnableComponent))
class MIENFACE_API UMienFaceComponent : public UActorComponent {
  GENERATED_BODY()

 public:
  UMienFaceComponent();

  /** A .dna file, which is opened in the axes and units of Unreal, or a file of `mien bake --system unreal`. */
  UPROPERTY(EditAnywhere, BlueprintReadOnly, Category = Mien)
  FString RigFile;

  UPROPERTY(EditAnywhere, BlueprintReadWrite, Category = Mien)
  int32 Lod = 0;

  /** Off for components that you evaluate together, by mien_rig_evaluate_batch(), before they tick. */
  UPROPERTY(EditAnywhere, BlueprintReadWrite, Category = Mien)
  bool bEvaluates = true;

  /** False, and a message in the log, if the file cannot be used. BeginPlay calls it. */
  UFUNCTION(BlueprintCallable, Category = Mien)
  bool Open();

  /** False if the rig has no raw control of this name. */
  UFUNCTION(BlueprintCallable, Category = Mien)
  bool SetControl(const FString& Name, float Value);

  virtual void BeginPlay() override;
  virtual void EndPlay(const EEndPlayReason::Type Reason) override;
  virtual void TickComponent(float DeltaTime, ELevelTick TickType,
                             FActorComponentTickFunction* Function) override;

  /** For mixers, batches and what else mien.h offers, on the game thread; null if nothing is open. Components with the
   *  same RigFile have the same rig. */
  const MienRig* GetRig() const { return File ? File->Rig : nullptr; }
  MienInstance* GetInstance() const { return Instance; }

  /** Of the joints, in the order of the rig. */
  const TArray<FName>& JointNames() const { return Joints; }

  /** Copies what the last tick computed, relative to the parents. For any thread. */
  void CopyJointTransforms(TArray<FTransform>& Out) const;

 private:
  void Close();

  TSharedPtr<FMienRigFile> File;
  MienInstance* Instance = nullptr;
  MienDeformerInstance* Pose = nullptr;
  TArray<FName> Joints, Channels;
  TArray<float> Numbers;  // ten of each joint
  TArray<FTransform> Transforms;
  mutable FCriticalSection Lock;  // of Transforms
};
