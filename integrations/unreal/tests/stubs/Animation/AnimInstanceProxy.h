// SPDX-License-Identifier: MIT
#pragma once
#include "Components/SkeletalMeshComponent.h"

struct FAnimInstanceProxy {
  USkeletalMeshComponent* Mesh;
  USkeletalMeshComponent* GetSkelMeshComponent() const { return Mesh; }
};
