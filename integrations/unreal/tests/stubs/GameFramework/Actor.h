// SPDX-License-Identifier: MIT
#pragma once
#include "Components/ActorComponent.h"

class AActor {
 public:
  std::vector<UActorComponent*> Components;
  template <class T>
  T* FindComponentByClass() const {
    for (UActorComponent* component : Components) {
      if (T* found = dynamic_cast<T*>(component)) return found;
    }
    return nullptr;
  }
};
