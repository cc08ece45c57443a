// SPDX-License-Identifier: MIT
#pragma once
#include "Components/ActorComponent.h"

class USkeletalMeshComponent : public UActorComponent {
 public:
  std::map<FName, float> Morphs;
  void SetMorphTarget(FName name, float value, bool = true) { Morphs[name] = value; }
};
