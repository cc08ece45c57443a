// SPDX-License-Identifier: MIT
#pragma once
#include "CoreMinimal.h"

namespace EEndPlayReason {
enum Type { Destroyed };
}
enum ELevelTick { LEVELTICK_All };
struct FActorComponentTickFunction {
  bool bCanEverTick = false;
};

class AActor;
class UActorComponent : public UObject {
 public:
  typedef UActorComponent Super;  // the header tool writes it into each class
  FActorComponentTickFunction PrimaryComponentTick;
  AActor* Owner = nullptr;
  AActor* GetOwner() const { return Owner; }
  virtual void BeginPlay() {}
  virtual void EndPlay(const EEndPlayReason::Type) {}
  virtual void TickComponent(float, ELevelTick, FActorComponentTickFunction*) {}
};
