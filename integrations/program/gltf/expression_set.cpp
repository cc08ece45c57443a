// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/expression_set.h"

#include <algorithm>
#include <set>
#include <sstream>

#include "integrations/program/gltf/control_names.h"
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
  while (std::getline(ways, way, '|')) expression.ways.push_back(parse_way(way));
  if (expression.ways.empty()) expression.ways.emplace_back();  // the neutral face
  return expression;
}

std::string to_text(const MienStringView& view) { return {view.data, view.count}; }

/// Finds controls of one rig.
struct Finder {
  ControlNames names;
  std::vector<MienMatrixEntry> matrix = arkit_matrix();

  explicit Finder(const RigSource& source) : names(source.rig(), MIEN_KIND_RAW_CONTROL) {}

  /// Adds what a control stands for; false if the rig lacks it.
  bool add(const NamedValue& value, std::vector<ControlValue>& out) const {
    uint32_t control = 0;
    if (names.find(value.control, control)) {
      out.push_back({control, value.value});
      return true;
    }
    // One expression of ARKit, two of rigs that have it for each side.
    uint32_t right = 0;
    if (names.find(value.control + "Left", control) && names.find(value.control + "Right", right)) {
      out.push_back({control, value.value});
      out.push_back({right, value.value});
      return true;
    }
    bool found = false;
    for (const MienMatrixEntry& entry : matrix) {
      if (to_text(entry.channel) != value.control) continue;
      if (!names.find(to_text(entry.control), control)) return false;
      out.push_back({control, entry.weight * value.value});
      found = true;
    }
    return found;
  }

  bool add_all(const std::vector<NamedValue>& values, std::vector<ControlValue>& out,
               std::vector<std::string>& missing) const {
    bool complete = true;
    for (const NamedValue& value : values) {
      if (add(value, out)) continue;
      complete = false;
      missing.push_back(value.control);
    }
    return complete;
  }
};

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

std::vector<MienMatrixEntry> arkit_matrix() {
  size_t count = 0;  // neither call can fail
  (void)mien_arkit_matrix(nullptr, 0, &count);
  std::vector<MienMatrixEntry> entries(count);
  (void)mien_arkit_matrix(entries.data(), count, &count);
  return entries;
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

RigExpressions find_expressions(const RigSource& source, const ExpressionSet& set) {
  const Finder finder(source);
  RigExpressions result;
  for (const Expression& expression : set) {
    std::vector<std::string> missing;  // of the first way
    RigExpression made;
    bool complete = false;
    for (const ExpressionWay& way : expression.ways) {
      made = {expression.name, {}, {}, kNone};
      std::vector<std::string> lacks;
      const bool has_plus = finder.add_all(way.plus, made.plus, lacks);
      const bool has_minus = finder.add_all(way.minus, made.minus, lacks);
      complete = has_plus && has_minus;
      if (complete) break;
      if (missing.empty()) missing = distinct(lacks);
    }
    if (!complete) {
      std::string text = expression.name + " (";
      for (size_t i = 0; i < missing.size(); ++i) text += (i == 0 ? "" : ", ") + missing[i];
      result.missing.push_back(text + ")");
      continue;
    }
    if (!finder.names.find(expression.name, made.control)) made.control = kNone;
    result.expressions.push_back(std::move(made));
  }
  if (result.expressions.empty()) {
    throw ExportError(MIEN_ERROR_NAME, "", "the rig has the controls of none of the expressions",
                      "see 'mien info --names raw', or export without --bake");
  }
  return result;
}

}  // namespace mien::gltf
