// SPDX-License-Identifier: MIT
#pragma once

// The generated header has to be the last.
// clang-format off
#include "AnimGraphNode_Base.h"
#include "AnimNode_Mien.h"
#include "CoreMinimal.h"
#include "AnimGraphNode_Mien.generated.h"
// clang-format on

/** The node Mien of animation graphs: takes a pose, and gives it with the bones of the Mien Face component. */
UCLASS()
class MIENFACEEDITOR_API UAnimGraphNode_Mien : public UAnimGraphNode_Base {
  GENERATED_BODY()

 public:
  UPROPERTY(EditAnywhere, Category = Settings)
  FAnimNode_Mien Node;

  virtual FText GetNodeTitle(ENodeTitleType::Type TitleType) const override;
  virtual FText GetTooltipText() const override;
  virtual FLinearColor GetNodeTitleColor() const override;
  virtual FString GetNodeCategory() const override;
};
