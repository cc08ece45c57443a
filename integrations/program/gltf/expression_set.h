// SPDX-License-Identifier: MIT
// Sets of expressions that other programs expect, as values of controls, and these controls on a rig.
//
// A control is found by its name or by what the name means on the rig (mien_rig_match()), so that one table
// serves rigs with names of ARKit, of MetaHuman's raw controls, and others.
#pragma once

#include <string>
#include <vector>

#include "integrations/program/gltf/rig_source.h"
#include "integrations/program/io/matched_names.h"

namespace mien::gltf {

/// A value of a control by name.
struct NamedValue {
  std::string control;
  float value;
};

/// The mesh in pose `plus` less the mesh in pose `minus`, in which controls not named are as they start.
struct ExpressionWay {
  std::vector<NamedValue> plus, minus;
};

/// The first way of which the rig has all controls counts.
struct Expression {
  std::string name;
  std::vector<ExpressionWay> ways;
};

using ExpressionSet = std::vector<Expression>;

/// What mouthClose is a difference to.
enum class MouthClose {
  kAlone,    // the neutral mesh, as for all others
  kWithJaw,  // the mesh with jawOpen at 1: captured data close the lips of an open jaw with it, to
             // the degree that the jaw is open at most
};

/// "arkit", "visemes", ...
const std::vector<std::string>& expression_set_names();

/// One of them. docs/face-capture.md, 5 "Sets of expressions" has the sources and reasons.
ExpressionSet expression_set(const std::string& name, MouthClose mouth_close);

/// The 52 ARKit expressions, in the order of the ARKit documentation.
const std::vector<std::string>& arkit_names();

struct ControlValue {
  uint32_t control;  // raw
  float value;
};

/// An expression on one rig.
struct RigExpression {
  std::string name;
  std::vector<ControlValue> plus, minus;
  uint32_t control =
      kNone;  // of the name of the expression: its value is the weight of the expression
};

struct RigExpressions {
  std::vector<RigExpression> expressions;
  std::vector<std::string>
      missing;  // "jawOpen (jawOpen)": expressions, and the controls that the rig lacks

  /// Whether values of controls are weights of all expressions.
  bool by_name() const;
  /// Index of an expression; its size if there is none.
  size_t find(const std::string& name) const;
};

/// Throws ExportError if the rig has none of the expressions.
RigExpressions find_expressions(const ExpressionSet& set, cli::MatchedNames& names);

}  // namespace mien::gltf
