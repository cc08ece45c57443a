// SPDX-License-Identifier: MIT
#include "runtime/base/status.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

namespace mien {
namespace {

std::string printable(std::string text) {
  make_printable(text.data());
  return text;
}

TEST(Messages, KeepTextInAnyLanguage) {
  for (const char* text : {"", "plain 1.5 \"~\"", "\xC3\xA4\xC3\xB6\xC2\xA0", "\xE2\x82\xAC",
                           "\xED\x9F\xBF\xEE\x80\x80", "\xF0\x9F\x99\x82", "\xF4\x8F\xBF\xBF"}) {
    EXPECT_EQ(printable(text), text);
  }
}

TEST(Messages, ReplaceWhatTerminalsObeyAndWhatIsNoText) {
  const struct {
    const char *given, *expected;
  } cases[] = {{"\x1B[2J\r\n\t\x7F", "?[2J????"},
               {"\xC2\x9B"
                "31m",
                "??31m"},                // a control character of two bytes
               {"\xFF\xFE\x80", "???"},  // never the first of a character
               {"\xC3", "?"},            // cut off
               {"\xE2\x82", "??"},
               {"\xF0\x9F\x99", "???"},
               {"\xC3(", "?("},
               {"\xC0\xAF\xE0\x80\xAF", "?????"},   // longer than needed
               {"\xED\xA0\x80", "???"},             // half of a pair
               {"\xF4\x90\x80\x80\xF8", "?????"}};  // behind the last character
  for (const auto& c : cases) EXPECT_EQ(printable(c.given), c.expected);
}

TEST(Messages, OfErrorsArePrintable) {
  Error error;
  fail(error, Status::kDnaValue, 3, "layer %.4s", "\x1B[1\xFF");
  EXPECT_STREQ(error.message, "layer ?[1?");
  // Cut in the middle of a character.
  const std::string long_text = std::string(sizeof(error.message) - 2, 'x') + "\xC3\xA4";
  fail(error, Status::kDnaValue, 3, "%s", long_text.c_str());
  EXPECT_EQ(strlen(error.message), sizeof(error.message) - 1);
  EXPECT_EQ(error.message[sizeof(error.message) - 2], '?');
}

}  // namespace
}  // namespace mien
