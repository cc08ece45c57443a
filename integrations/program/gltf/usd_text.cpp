// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/usd_text.h"

#include <charconv>
#include <cmath>

#include "integrations/program/io/text.h"

namespace mien::gltf {

namespace {

template <class T>
void append_shortest(std::string& text, T value, const std::string& what) {
  if (!std::isfinite(value)) {
    throw ExportError(MIEN_ERROR_DNA_VALUE, what, "a value is not a finite number",
                      "see 'mien validate', or give smaller controls");
  }
  char digits[40];
  const auto end = std::to_chars(digits, digits + sizeof(digits), value).ptr;
  text.append(digits, end);
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

void UsdText::end_line(const std::vector<std::string>& metadata) {
  text_ += metadata.empty() ? "\n" : " (\n";
  for (const std::string& entry : metadata) line("    " + entry);
  if (!metadata.empty()) line(")");
}

void UsdText::line(const std::string& text, const std::vector<std::string>& metadata) {
  indent();
  text_ += text;
  end_line(metadata);
}

void UsdText::begin_prim(const std::string& type, const std::string& name,
                         const std::vector<std::string>& metadata) {
  line("def " + type + " \"" + name + "\"", metadata);
  line("{");
  ++depth_;
}

void UsdText::end_prim() {
  --depth_;
  line("}");
}

void UsdText::number(double value) { append_shortest(text_, value, what_); }
void UsdText::number(float value) { append_shortest(text_, value, what_); }
void UsdText::token(const std::string& text) { text_ += usd_string(text); }

std::string usd_string(const std::string& text) {
  std::string result = "\"";
  for (size_t i = 0; i < text.size();) {
    const size_t length = utf8_length(std::string_view(text).substr(i));
    const auto byte = static_cast<unsigned char>(text[i]);
    if (length == 0) {
      result += "\xEF\xBF\xBD";
    } else if (text[i] == '"' || text[i] == '\\') {
      result += std::string("\\") + text[i];
    } else if (byte < 0x20 || byte == 0x7f) {
      constexpr char kHex[] = "0123456789abcdef";
      result += std::string("\\x") + kHex[byte >> 4] + kHex[byte & 15];
    } else {
      result.append(text, i, length);
    }
    i += length == 0 ? 1 : length;
  }
  return result + "\"";
}

std::string PrimNames::take(const std::string& name) {
  std::string valid;
  for (const char c : name) valid += is_letter(c) || is_digit(c) ? c : '_';
  if (valid.empty() || is_digit(valid[0])) valid = "_" + valid;
  std::string unique = valid;
  for (size_t n = 1; !taken_.insert(unique).second; ++n) unique = valid + "_" + std::to_string(n);
  return unique;
}

}  // namespace mien::gltf
