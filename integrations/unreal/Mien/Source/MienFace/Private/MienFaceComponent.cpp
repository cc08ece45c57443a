// SPDX-License-Identifier: MIT
#include "MienFaceComponent.h"

#include "Components/SkeletalMeshComponent.h"
#include "GameFramework/Actor.h"

DEFINE_LOG_CATEGORY_STATIC(LogMien, Log, All);

namespace {

TArray<FName> NamesOf(const MienRig* Rig, uint32_t Kind) {
  TArray<FName> Names;
  uint32_t Count = 0;
  if (mien_rig_count(Rig, Kind, &Count) != MIEN_OK) return Names;
  for (uint32_t Index = 0; Index < Count; ++Index) {
    MienStringView View{};
    const bool bFound = mien_rig_name(Rig, Kind, Index, &View) == MIEN_OK;
    Names.Add(bFound
                  ? FName(FString::ConstructFromPtrSize(View.data, static_cast<int32>(View.count)))
                  : NAME_None);
  }
  return Names;
}

MienStatus OpenFile(const FString& Path, FMienRigFile& File, MienError& Error) {
  MienStatus Status;
  if (Path.EndsWith(TEXT(".dna"))) {
    MienCoordinateSystem System = mien_coordinate_system_default();
    MienDnaDesc Desc = mien_dna_desc_default();
    Desc.system = &System;
    MienDna* Dna = nullptr;
    Status = mien_coordinate_system_find("unreal", &System);
    if (Status == MIEN_OK) Status = mien_dna_open_file(TCHAR_TO_UTF8(*Path), &Desc, &Dna, &Error);
    if (Status == MIEN_OK) Status = mien_rig_create(Dna, nullptr, &File.Rig, &Error);
    if (Status == MIEN_OK)
      Status = mien_deformer_create(Dna, File.Rig, nullptr, &File.Deformer, &Error);
    mien_dna_close(Dna);
    return Status;
  }
  Status = mien_baked_open_file(TCHAR_TO_UTF8(*Path), nullptr, &File.Baked, &Error);
  if (Status == MIEN_OK) Status = mien_rig_from_baked(File.Baked, nullptr, &File.Rig, &Error);
  if (Status == MIEN_OK)
    Status = mien_deformer_from_baked(File.Baked, File.Rig, nullptr, &File.Deformer, &Error);
  return Status;
}

// Files in use, by their paths. Only the game thread opens components.
TMap<FString, TWeakPtr<FMienRigFile>> Files;

TSharedPtr<FMienRigFile> FindOrOpen(const FString& Path, MienStatus& Status, MienError& Error) {
  const TWeakPtr<FMienRigFile>* Known = Files.Find(Path);
  TSharedPtr<FMienRigFile> File = Known ? Known->Pin() : nullptr;
  Status = MIEN_OK;
  if (File) return File;
  File = MakeShared<FMienRigFile>();
  Status = OpenFile(Path, *File, Error);
  if (Status != MIEN_OK) return nullptr;
  Files.Add(Path, File);
  return File;
}

}  // namespace

FMienRigFile::~FMienRigFile() {
  mien_deformer_destroy(Deformer);
  mien_rig_destroy(Rig);
  mien_baked_close(Baked);
}

UMienFaceComponent::UMienFaceComponent() { PrimaryComponentTick.bCanEverTick = true; }

bool UMienFaceComponent::Open() {
  Close();
  MienError Error = mien_error_default();
  MienStatus Status;
  File = FindOrOpen(RigFile, Status, Error);
  if (Status == MIEN_OK) Status = mien_instance_create(File->Rig, nullptr, &Instance, &Error);
  if (Status == MIEN_OK)
    Status = mien_deformer_instance_create(File->Deformer, nullptr, &Pose, &Error);
  if (Status != MIEN_OK) {
    UE_LOG(LogMien, Error, TEXT("%s: %s"), *RigFile, UTF8_TO_TCHAR(Error.message));
    Close();
    return false;
  }
  Joints = NamesOf(File->Rig, MIEN_KIND_JOINT);
  Channels = NamesOf(File->Rig, MIEN_KIND_BLEND_SHAPE_CHANNEL);
  Numbers.SetNum(10 * Joints.Num());
  return true;
}

void UMienFaceComponent::Close() {
  mien_deformer_instance_destroy(Pose);
  mien_instance_destroy(Instance);
  Pose = nullptr;
  Instance = nullptr;
  File = nullptr;
  FScopeLock Scope(&Lock);
  Transforms.SetNum(0);
}

void UMienFaceComponent::BeginPlay() {
  Super::BeginPlay();
  Open();
}

void UMienFaceComponent::EndPlay(const EEndPlayReason::Type Reason) {
  Close();
  Super::EndPlay(Reason);
}

bool UMienFaceComponent::SetControl(const FString& Name, float Value) {
  uint32_t Index = 0;
  MienMutableFloatView Controls{};
  if (!Instance ||
      mien_rig_find(File->Rig, MIEN_KIND_RAW_CONTROL, TCHAR_TO_UTF8(*Name), &Index) != MIEN_OK)
    return false;
  if (mien_instance_raw_controls(Instance, &Controls) != MIEN_OK || Index >= Controls.count)
    return false;
  Controls.data[Index] = Value;
  return true;
}

void UMienFaceComponent::TickComponent(float DeltaTime, ELevelTick TickType,
                                       FActorComponentTickFunction* Function) {
  Super::TickComponent(DeltaTime, TickType, Function);
  if (!Instance) return;
  if (bEvaluates &&
      (Lod < 0 || mien_rig_evaluate(File->Rig, Instance, static_cast<uint32_t>(Lod)) != MIEN_OK))
    return;
  MienFloatView Weights{};
  if (mien_deformer_instance_update(Pose, Instance) != MIEN_OK ||
      mien_deformer_instance_local_transforms(Pose, Numbers.GetData(),
                                              static_cast<size_t>(Numbers.Num())) != MIEN_OK ||
      mien_instance_blend_shapes(Instance, &Weights) != MIEN_OK) {
    return;
  }
  {
    FScopeLock Scope(&Lock);
    Transforms.SetNum(Joints.Num());
    for (int32 Joint = 0; Joint < Joints.Num(); ++Joint) {
      const float* N = Numbers.GetData() + 10 * Joint;
      Transforms[Joint] = FTransform(FQuat(N[3], N[4], N[5], N[6]), FVector(N[0], N[1], N[2]),
                                     FVector(N[7], N[8], N[9]));
    }
  }
  USkeletalMeshComponent* Mesh =
      GetOwner() ? GetOwner()->FindComponentByClass<USkeletalMeshComponent>() : nullptr;
  if (!Mesh) return;
  for (int32 Channel = 0; Channel < Channels.Num(); ++Channel) {
    Mesh->SetMorphTarget(Channels[Channel], Weights.data[Channel]);
  }
}

void UMienFaceComponent::CopyJointTransforms(TArray<FTransform>& Out) const {
  FScopeLock Scope(&Lock);
  Out = Transforms;
}
