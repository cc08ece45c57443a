// SPDX-License-Identifier: MIT
// Reads JSON that people wrote: errors have a place, and no object has a key twice.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace mien::cli {

/// Members of an object in the order of the text. nlohmann::ordered_map looks for each new key among the
/// others, which takes their square; parse_json() refuses keys that come twice.
template <class Key, class T, class Less = std::less<Key>,
          class Allocator = std::allocator<std::pair<const Key, T>>>
struct MemberList : nlohmann::ordered_map<Key, T, Less, Allocator> {
  using Base = nlohmann::ordered_map<Key, T, Less, Allocator>;
  using Base::Base;

  T& operator[](const Key& key) {
    this->emplace_back(key, T());
    return this->back().second;
  }
};

/// Numbers are floats, and those past the range of floats are errors.
using FloatJson =
    nlohmann::basic_json<MemberList, std::vector, std::string, bool, int64_t, uint64_t, float>;

/// The document, or exit code 2: "`what`, `shown`, byte 17: why; `example`". Json is one of the types below: a
/// parser takes long to compile, so each is compiled once, in json_check.cpp.
template <class Json>
Json parse_json(std::string_view text, const char* what, const std::string& shown,
                const char* example);

extern template nlohmann::json parse_json(std::string_view, const char*, const std::string&,
                                          const char*);
extern template nlohmann::ordered_json parse_json(std::string_view, const char*, const std::string&,
                                                  const char*);
extern template nlohmann::basic_json<MemberList> parse_json(std::string_view, const char*,
                                                            const std::string&, const char*);
extern template FloatJson parse_json(std::string_view, const char*, const std::string&,
                                     const char*);

/// JSON that a program wrote: what it holds is not compared with any form. A discarded value if it is none.
template <class Json>
Json parse_written_json(std::string_view text);

extern template nlohmann::json parse_written_json(std::string_view);
extern template nlohmann::ordered_json parse_written_json(std::string_view);

}  // namespace mien::cli
