// SPDX-License-Identifier: MIT
// The JSON and the numbers of a GLB. What is compressed or lies in other files is refused.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "integrations/program/mesh/mesh_file.h"

namespace mien::cli {

constexpr size_t kMaxElements = size_t{1} << 28;

class GlbData {
 public:
  using Json = nlohmann::json;

  /// Fails with kInvalid. Both must outlive this.
  GlbData(const std::string& bytes, const std::string& path);

  [[noreturn]] void fail(const std::string& where, const std::string& why,
                         const std::string& what_to_do = "export it again") const {
    fail_mesh(path_, where, why, what_to_do);
  }
  static const Json& list(const Json& of, const char* key) {
    static const Json kNothing = Json::array();
    const auto it = of.is_object() ? of.find(key) : of.end();
    return of.is_object() && it != of.end() && it->is_array() ? *it : kNothing;
  }
  const Json& element(const char* key, size_t index) const {
    const Json& all = list(root_, key);
    if (index >= all.size() || !all[index].is_object()) {
      fail("", std::string("there is no element ") + std::to_string(index) + " of " + key);
    }
    return all[index];
  }
  size_t whole(const Json& of, const char* key, size_t otherwise) const {
    const auto it = of.find(key);
    if (it == of.end()) return otherwise;
    if (!it->is_number_unsigned() || it->get<uint64_t>() > kMaxElements) {
      fail("", std::string("\"") + key + "\" is not a number from 0 to 2^28");
    }
    return it->get<size_t>();
  }
  static std::string text(const Json& of, const char* key) {
    const auto it = of.find(key);
    return it != of.end() && it->is_string() ? it->get<std::string>() : std::string();
  }

  /// `count` elements of `width` numbers in the binary chunk, through a buffer view.
  void copy(size_t view, size_t offset, size_t type, bool normalized, size_t count, size_t width,
            std::vector<double>& out) const;
  /// Numbers of an accessor, `width` per element, with sparse ones.
  std::vector<double> numbers(size_t accessor, size_t width, const char* what);
  /// Fails once far more numbers are read than the file has.
  void take_numbers(size_t count);
  const Json& root() const { return root_; }
  const std::string& path() const { return path_; }
  std::string_view binary() const { return binary_; }

 private:
  const std::string& path_;
  std::string_view binary_;
  Json root_;
  size_t numbers_left_;
};

}  // namespace mien::cli
