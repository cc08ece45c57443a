// SPDX-License-Identifier: MIT
#pragma once
#include "CoreMinimal.h"

#define LOCTEXT(key, text) FText::FromString(text)

struct FText {
  FString Text;
  static FText FromString(const FString& from) { return FText{from}; }
  const FString& ToString() const { return Text; }
};
struct FLinearColor {
  float R, G, B, A;
  FLinearColor(float r, float g, float b, float a = 1) : R(r), G(g), B(b), A(a) {}
};
namespace ENodeTitleType {
enum Type { FullTitle, ListView, EditableTitle, MenuTitle };
}

/// Finds the animation node among the properties of the class that is derived.
class UAnimGraphNode_Base : public UObject {
 public:
  virtual FText GetNodeTitle(ENodeTitleType::Type) const { return {}; }
  virtual FText GetTooltipText() const { return {}; }
  virtual FLinearColor GetNodeTitleColor() const { return {0, 0, 0}; }
  virtual FString GetNodeCategory() const { return ""; }
};
