// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/expression_set.h"

#include <algorithm>
#include <set>
#include <sstream>

#include "integrations/program/gltf/expression_tables.h"

namespace mien::gltf {

namespace {

/// Words of expression_tables.h: "jawOpen 0.5 tongueOut 1 - jawOpen 0.5".
ExpressionWay parse_way(const std::string& text) {
  ExpressionWay way;
  std::vector<NamedValue>* values = &way.plus;
  std::istringstream words(text);
  words.imbue(std::locale::classic());
  std::string control;
  while (words >> control) {
    if (control == "-") {
      values = &way.minus;
      continue;
    }
    float value = 0;
    words >> value;
    values->push_back({control, value});
  }
  return way;
}

Expression parse_row(const ExpressionRow& row) {
  Expression expression{row.name, {}};
  std::istringstream ways(row.ways);
  std::string way;
  while (std::getline(ways, way, '|')) {
    expression.ways.push_back(way == "=" ? ExpressionWay{{{row.name, 1}}, {}} : parse_way(way));
  }
  if (expression.ways.empty()) expression.ways.emplace_back();  // the neutral face
  return expression;
}

/// Adds what controls stand for; false if the rig lacks some.
bool add_all(const std::vector<NamedValue>& values, cli::MatchedNames& names,
             std::vector<ControlValue>& out, std::vector<std::string>& missing) {
  bool complete = true;
  for (const NamedValue& value : values) {
    const cli::MatchedName match = names.find(value.control);
    for (const MienControlShare& share : match.shares) {
      out.push_back({share.control, share.weight * value.value});
    }
    if (match.found()) continue;
    complete = false;
    const std::string usual = cli::usual_name(value.control);
    const std::string& name = usual.empty() ? value.control : usual;
    missing.push_back(name);
  }
  return complete;
}

/// Without those that came before; a file may have many.
std::vector<std::string> distinct(const std::vector<std::string>& names) {
  std::set<std::string> seen;
  std::vector<std::string> result;
  for (const std::string& name : names) {
    if (seen.insert(name).second) result.push_back(name);
  }
  return result;
}

}  // namespace

const std::vector<std::string>& expression_set_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list = {"arkit"};
    for (const ExpressionTable& table : kExpressionTables) list.emplace_back(table.name);
    return list;
  }();
  return names;
}

const std::vector<std::string>& arkit_names() {
  static const std::vector<std::string> names(std::begin(kArkitNames), std::end(kArkitNames));
  return names;
}

ExpressionSet expression_set(const std::string& name, MouthClose mouth_close) {
  ExpressionSet set;
  if (name == "arkit") {
    for (const std::string& expression : arkit_names()) {
      const bool with_jaw = expression == "mouthClose" && mouth_close == MouthClose::kWithJaw;
      const ExpressionWay way =
          with_jaw ? ExpressionWay{{{expression, 1}, {"jawOpen", 1}}, {{"jawOpen", 1}}}
                   : ExpressionWay{{{expression, 1}}, {}};
      set.push_back({expression, {way}});
    }
    return set;
  }
  for (const ExpressionTable& table : kExpressionTables) {
    if (name != table.name) continue;
    for (size_t i = 0; i < table.count; ++i) set.push_back(parse_row(table.rows[i]));
  }
  return set;
}

bool RigExpressions::by_name() const {
  return std::all_of(expressions.begin(), expressions.end(),
                     [](const RigExpression& expression) { return expression.control != kNone; });
}

size_t RigExpressions::find(const std::string& name) const {
  const auto at =
      std::find_if(expressions.begin(), expressions.end(),
                   [&](const RigExpression& expression) { return expression.name == name; });
  return static_cast<size_t>(at - expressions.begin());
}

RigExpressions find_expressions(const ExpressionSet& set, cli::MatchedNames& names) {
  RigExpressions result;
  std::vector<std::string> all_lacked;
  for (const Expression& expression : set) {
    std::vector<std::string> missing;  // of the first way
    RigExpression made;
    bool complete = false;
    for (const ExpressionWay& way : expression.ways) {
      made = {expression.name, {}, {}, kNone};
      std::vector<std::string> lacks;
      const bool has_plus = add_all(way.plus, names, made.plus, lacks);
      const bool has_minus = add_all(way.minus, names, made.minus, lacks);
      complete = has_plus && has_minus;
      if (complete) break;
      if (missing.empty()) missing = distinct(lacks);
    }
    if (!complete) {
      all_lacked.insert(all_lacked.end(), missing.begin(), missing.end());
      std::string text = expression.name + " (";
      for (size_t i = 0; i < missing.size(); ++i) text += (i == 0 ? "" : ", ") + missing[i];
      result.missing.push_back(text + ")");
      continue;
    }
    const cli::MatchedName own = names.find(expression.name);
    made.control = own.is_one() ? own.shares[0].control : kNone;
    result.expressions.push_back(std::move(made));
  }
  // Silence is no expression: it has no controls to lack.
  const bool any = std::any_of(result.expressions.begin(), result.expressions.end(),
                               [](const RigExpression& of) { return !of.plus.empty(); });
  if (any || (result.missing.empty() && !result.expressions.empty())) return result;
  constexpr size_t kShown = 12;
  std::string lacked;
  all_lacked = distinct(all_lacked);
  for (size_t i = 0; i < std::min(all_lacked.size(), kShown); ++i) {
    lacked += (i == 0 ? "" : ", ") + all_lacked[i];
  }
  if (all_lacked.size() > kShown) {
    lacked += " and " + std::to_string(all_lacked.size() - kShown) + " more";
  }
  throw ExportError(
      MIEN_ERROR_NAME, "",
      "the rig has the controls of none of the expressions; it lacks " + lacked,
      "name the rig of a face, see 'mien info --names raw', or export without --bake");
}

}  // namespace mien::gltf
