// SPDX-License-Identifier: MIT
#include "integrations/program/io/json_check.h"

#include <set>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/text.h"

namespace mien::cli {
namespace {

/// Walks through a document without keeping it. Numbers past the range of its type are errors.
template <class Json>
class JsonCheck : public nlohmann::json_sax<Json> {
 public:
  JsonCheck(const char* what, const std::string& shown, const char* example)
      : what_(what), shown_(shown), example_(example) {}

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(typename Json::number_integer_t) override { return true; }
  bool number_unsigned(typename Json::number_unsigned_t) override { return true; }
  bool number_float(typename Json::number_float_t, const typename Json::string_t&) override {
    return true;
  }
  bool string(typename Json::string_t&) override { return true; }
  bool binary(typename Json::binary_t&) override { return true; }
  bool start_array(size_t) override { return true; }
  bool end_array() override { return true; }

  bool start_object(size_t) override {
    keys_.emplace_back();
    return true;
  }
  bool end_object() override {
    keys_.pop_back();
    return true;
  }
  bool key(typename Json::string_t& key) override {
    if (keys_.back().insert(key).second) return true;
    fail(kInvalid, what_, shown_, "an object has the key \"" + one_line(key) + "\" twice",
         "leave one of them out");
  }

  bool parse_error(size_t position, const std::string&,
                   const nlohmann::detail::exception& error) override {
    // Messages of the parser begin with a tag in brackets.
    const std::string message = error.what();
    const size_t tag = message.find("] ");
    // Its only other error is a number past the range.
    const bool syntax = dynamic_cast<const typename Json::parse_error*>(&error) != nullptr;
    fail(kInvalid, what_, shown_ + ", byte " + std::to_string(position),
         one_line(tag == std::string::npos ? message : message.substr(tag + 2)),
         syntax ? example_ : "give numbers within the range of 32-bit floats");
  }

 private:
  const char* what_;
  const std::string& shown_;
  const char* example_;
  std::vector<std::set<std::string>> keys_;  // of the objects around the current position
};

}  // namespace

template <class Json>
Json parse_json(std::string_view text, const char* what, const std::string& shown,
                const char* example) {
  JsonCheck<Json> check(what, shown, example);
  Json::sax_parse(text, &check);
  return Json::parse(text);
}

template nlohmann::json parse_json(std::string_view, const char*, const std::string&, const char*);
template nlohmann::ordered_json parse_json(std::string_view, const char*, const std::string&,
                                           const char*);
template nlohmann::basic_json<MemberList> parse_json(std::string_view, const char*,
                                                     const std::string&, const char*);
template FloatJson parse_json(std::string_view, const char*, const std::string&, const char*);

template <class Json>
Json parse_written_json(std::string_view text) {
  return Json::parse(text, nullptr, false);
}

template nlohmann::json parse_written_json(std::string_view);
template nlohmann::ordered_json parse_written_json(std::string_view);

}  // namespace mien::cli
