// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/expression_file.h"

#include <nlohmann/json.hpp>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/json_check.h"
#include "integrations/program/io/text.h"

namespace mien::gltf {

namespace {

using json = nlohmann::basic_json<cli::MemberList>;

constexpr char kCannot[] = "cannot use expressions";
constexpr char kExample[] = R"(write {"aa": {"jawOpen": 0.6}, "ou": {"mouthPucker": 1}})";
constexpr size_t kMaxExpressions = 512;

[[noreturn]] void wrong(const std::string& where, const std::string& why) {
  cli::fail(cli::kInvalid, kCannot, where, why, kExample);
}

std::vector<NamedValue> values_of(const json& object, const std::string& where) {
  if (!object.is_object()) wrong(where, "expected an object of controls and their values");
  std::vector<NamedValue> values;
  for (const auto& [control, value] : object.items()) {
    const std::string place = where + "." + cli::one_line(control);
    if (!value.is_number()) wrong(place, "expected a number");
    const double number = value.get<double>();
    if (!(number >= 0 && number <= 1)) wrong(place, "the value is not within 0 to 1");
    values.push_back({control, static_cast<float>(number)});
  }
  return values;
}

ExpressionWay way_of(const json& object, const std::string& where) {
  const bool is_difference =
      object.is_object() && (object.contains("plus") || object.contains("minus"));
  if (!is_difference) return {values_of(object, where), {}};
  ExpressionWay way;
  for (const auto& [key, part] : object.items()) {
    if (key != "plus" && key != "minus") {
      wrong(where + "." + cli::one_line(key), "a difference has \"plus\" and \"minus\" only");
    }
    (key == "plus" ? way.plus : way.minus) = values_of(part, where + "." + key);
  }
  return way;
}

}  // namespace

ExpressionSet read_expression_set(const std::string& path) {
  const std::string shown = cli::shown_name(path);
  const json document =
      cli::parse_json<json>(cli::read_json(path, kCannot), kCannot, shown, kExample);
  if (!document.is_object() || document.empty()) wrong(shown, "expected an object of expressions");
  if (document.size() > kMaxExpressions) {
    wrong(shown, "more than " + std::to_string(kMaxExpressions) + " expressions");
  }
  ExpressionSet set;
  for (const auto& [name, object] : document.items()) {
    set.push_back({name, {way_of(object, shown + ", " + cli::one_line(name))}});
  }
  return set;
}

}  // namespace mien::gltf
