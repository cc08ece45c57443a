// SPDX-License-Identifier: MIT
#include "integrations/program/commands/edit_values.h"

#include <charconv>
#include <cmath>

#include "integrations/program/commands/options.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

void fail_edit_value(const Document& document, const std::string& why,
                     const std::string& what_to_do) {
  fail_usage(document.edit, why, what_to_do);
}

NamePair split_pair(const Document& document, const std::string& value, char separator,
                    const char* form, bool at_last) {
  const size_t at = at_last ? value.rfind(separator) : value.find(separator);
  if (at == std::string::npos || at == 0 || at + 1 == value.size()) {
    fail_edit_value(document, std::string("expected ") + form, "see 'mien help edit'");
  }
  return {value.substr(0, at), value.substr(at + 1)};
}

std::vector<double> parse_list(const Document& document, const std::string& list) {
  std::vector<double> numbers;
  const char* at = list.data();
  const char* const end = at + list.size();
  while (true) {
    double number = 0;
    const auto [stop, error] = std::from_chars(at, end, number);
    if (error != std::errc() || !std::isfinite(number) ||
        !std::isfinite(static_cast<float>(number)) || (stop != end && *stop != ',')) {
      fail_edit_value(document, "\"" + list + "\" is not a finite number or a list of them",
                      "separate numbers by commas, without spaces");
    }
    numbers.push_back(number);
    if (stop == end) return numbers;
    at = stop + 1;
  }
}

std::vector<double> parse_list_of(const Document& document, const std::string& list, size_t count,
                                  const char* form) {
  std::vector<double> numbers = parse_list(document, list);
  if (numbers.size() != count) {
    fail_edit_value(
        document,
        "expected " + amount_text(count, "number") + ", not " + std::to_string(numbers.size()),
        std::string("write ") + form);
  }
  return numbers;
}

uint32_t kind_named(const Document& document, const std::string& word) {
  static const Words words = {"joint", "mesh", "blend-shape", "animated-map", "raw",
                              "gui",   "psd",  "ml",          "rbf"};
  constexpr uint32_t kKinds[] = {
      MIEN_KIND_JOINT,        MIEN_KIND_MESH,        MIEN_KIND_BLEND_SHAPE_CHANNEL,
      MIEN_KIND_ANIMATED_MAP, MIEN_KIND_RAW_CONTROL, MIEN_KIND_GUI_CONTROL,
      MIEN_KIND_PSD_CONTROL,  MIEN_KIND_ML_CONTROL,  MIEN_KIND_RBF_CONTROL};
  for (size_t i = 0; i < words.size(); ++i) {
    if (words[i] == word) return kKinds[i];
  }
  fail_edit_value(document, "\"" + word + "\" is not one of " + list_of(words, "and"),
                  nearest_question(word, words, "choose one of them"));
}

MeshAndFile parse_mesh_and_file(const Document& document, const std::string& value) {
  const NamePair pair = split_pair(document, value, '=', "MESH=FILE");
  return {pair.first, find_element(document, MIEN_KIND_MESH, pair.first), pair.second};
}

std::string amount_text(uint64_t count, const std::string& noun) {
  return grouped(count) + " " + noun + (count == 1 ? "" : noun.back() == 'h' ? "es" : "s");
}

std::string length_text(double length) {
  char digits[32];
  const auto end =
      std::to_chars(digits, digits + sizeof(digits), length, std::chars_format::general, 3);
  return std::string(digits, end.ptr);
}

}  // namespace mien::cli
