// SPDX-License-Identifier: MIT
#include "AnimGraphNode_Mien.h"

#define LOCTEXT_NAMESPACE "AnimGraphNode_Mien"

FText UAnimGraphNode_Mien::GetNodeTitle(ENodeTitleType::Type) const {
  return LOCTEXT("Title", "Mien");
}

FText UAnimGraphNode_Mien::GetTooltipText() const {
  return LOCTEXT("Tooltip",
                 "Sets the bones that have the names of joints to what the Mien Face component of "
                 "the actor computed. The others keep the pose that comes in.");
}

FLinearColor UAnimGraphNode_Mien::GetNodeTitleColor() const {
  return FLinearColor(0.75f, 0.35f, 0.3f);
}

FString UAnimGraphNode_Mien::GetNodeCategory() const { return TEXT("Animation|Mien"); }

#undef LOCTEXT_NAMESPACE
