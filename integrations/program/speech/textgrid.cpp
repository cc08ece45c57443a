// SPDX-License-Identifier: MIT
// Text forms of Praat's TextGrid, the long and the short one. Praat reads both alike: what counts are numbers,
// strings and flags that stand free; all other words are for people.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/text.h"
#include "integrations/program/speech/phoneme_file.h"

namespace mien::speech {

namespace {

constexpr const char* kCannotRead = "cannot read phonemes";
constexpr size_t kMostTiers = 1000;

/// UTF-16, which Praat writes if a label is not ASCII, as UTF-8; other text as it is, without a mark.
std::string as_utf8(const std::string& text) {
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
  if (text.rfind("\xEF\xBB\xBF", 0) == 0) return text.substr(3);
  if (text.size() < 2) return text;
  const bool big = byte(0) == 0xFE && byte(1) == 0xFF, little = byte(0) == 0xFF && byte(1) == 0xFE;
  if (!big && !little) return text;
  const auto unit = [&](size_t i) {
    return static_cast<char32_t>(big ? byte(i) << 8 | byte(i + 1) : byte(i + 1) << 8 | byte(i));
  };
  std::string utf8;
  for (size_t i = 2; i + 1 < text.size(); i += 2) {
    char32_t letter = unit(i);
    const bool high = letter >= 0xD800 && letter < 0xDC00;
    if (high && i + 3 < text.size() && unit(i + 2) >= 0xDC00 && unit(i + 2) < 0xE000) {
      letter = 0x10000 + ((letter - 0xD800) << 10) + (unit(i + 2) - 0xDC00);
      i += 2;
    } else if (letter >= 0xD800 && letter < 0xE000) {
      letter = 0xFFFD;
    }
    const auto add = [&](char32_t bits) { utf8 += static_cast<char>(bits); };
    const auto more = [&](unsigned shift) { add(0x80 | ((letter >> shift) & 0x3F)); };
    if (letter < 0x80) {
      add(letter);
    } else if (letter < 0x800) {
      add(0xC0 | letter >> 6), more(0);
    } else if (letter < 0x10000) {
      add(0xE0 | letter >> 12), more(6), more(0);
    } else {
      add(0xF0 | letter >> 18), more(12), more(6), more(0);
    }
  }
  return utf8;
}

class Tokens {
 public:
  Tokens(std::string_view text, const std::string& shown) : text_(text), shown_(shown) {}

  [[noreturn]] void wrong(const std::string& why) const {
    cli::fail(cli::kInvalid, kCannotRead, shown_ + ", line " + std::to_string(line_), why,
              "give a TextGrid as text, as Praat saves it");
  }

  double number(const char* what) {
    for (std::string_view word = next(what);; word = next(what)) {
      if (word[0] == '"') wrong(std::string("expected ") + what + ", not a text");
      double value = 0;
      const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (stop == word.data()) continue;  // a word for people
      if (error != std::errc() || stop != word.data() + word.size() || !std::isfinite(value)) {
        wrong("\"" + cli::one_line(word) + "\" is no number");
      }
      return value;
    }
  }
  size_t count(const char* what, size_t most) {
    const double value = number(what);
    if (value < 0 || value > static_cast<double>(most) || value != std::floor(value)) {
      wrong(std::string(what) + " is no whole number up to " + cli::grouped(most));
    }
    return static_cast<size_t>(value);
  }
  double time(const char* what) {
    const double value = number(what);
    if (std::abs(value) > kLongestSeconds) wrong(std::string(what) + " is beyond 24 hours");
    return value;
  }
  std::string text(const char* what) {
    std::string_view word = next(what);
    while (word[0] != '"') {
      double value = 0;
      const auto parsed = std::from_chars(word.data(), word.data() + word.size(), value);
      if (parsed.ptr != word.data()) wrong(std::string("expected ") + what + ", not a number");
      word = next(what);
    }
    std::string value;
    for (size_t i = 1; i + 1 < word.size(); ++i) {
      value += word[i];
      if (word[i] == '"') ++i;  // a quotation mark within a text is there twice
    }
    return value;
  }
  bool flag(const char* what) {
    while (true) {
      const std::string_view word = next(what);
      if (word == "<exists>") return true;
      if (word == "<absent>") return false;
    }
  }
  size_t line() const { return line_; }

 private:
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

  /// A word or a text with its quotation marks; never empty.
  std::string_view next(const char* what) {
    while (at_ < text_.size() && (is_space(text_[at_]) || text_[at_] == '!')) {
      if (text_[at_] == '!') {
        while (at_ < text_.size() && text_[at_] != '\n') ++at_;
        continue;
      }
      line_ += text_[at_++] == '\n';
    }
    if (at_ == text_.size()) wrong(std::string("the file ends before ") + what);
    const size_t begin = at_;
    if (text_[at_] == '"') {
      for (++at_; at_ < text_.size(); ++at_) {
        line_ += text_[at_] == '\n';
        if (text_[at_] != '"') continue;
        if (at_ + 1 < text_.size() && text_[at_ + 1] == '"') {
          ++at_;
          continue;
        }
        return text_.substr(begin, ++at_ - begin);
      }
      wrong("a text has no end");
    }
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  std::string_view text_;
  const std::string& shown_;
  size_t at_ = 0, line_ = 1;
};

/// How well the name of a tier says that it has phonemes.
int fitness(const std::string& name) {
  std::string small = name;
  std::transform(small.begin(), small.end(), small.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto has = [&](const char* word) { return small.find(word) != std::string::npos; };
  if (has("phone") || has("phoneme") || has("segment") || small == "mau") return 3;
  if (has("phon") || has("ipa") || has("sampa")) return 2;
  return has("word") || has("ort") || has("sentence") || has("utterance") ? 0 : 1;
}

}  // namespace

PhonemeFile parse_textgrid(const std::string& text, const std::string& shown) {
  const std::string utf8 = as_utf8(text);
  Tokens tokens(utf8, shown);
  if (tokens.text("the type of the file") != "ooTextFile") tokens.wrong("it is no text of Praat");
  if (tokens.text("the class of the object") != "TextGrid") tokens.wrong("it is no TextGrid");
  const double start = tokens.time("its first time"), stop = tokens.time("its last time");
  if (stop < start) tokens.wrong("it ends before it begins");
  PhonemeFile best;
  int best_fitness = -1;
  size_t intervals = 0;
  const size_t tiers =
      tokens.flag("<exists>") ? tokens.count("the number of tiers", kMostTiers) : 0;
  for (size_t t = 0; t < tiers; ++t) {
    const std::string kind = tokens.text("the class of a tier");
    const std::string name = tokens.text("the name of a tier");
    (void)tokens.time("the first time of a tier");
    (void)tokens.time("the last time of a tier");
    const size_t count = tokens.count("the number of intervals", kMostPhonemes);
    intervals += count;
    if (intervals > kMostPhonemes) tokens.wrong("there are more than 1,000,000 intervals");
    Utterance utterance;
    utterance.seconds = stop - start;
    const bool is_points = kind == "TextTier";
    if (!is_points && kind != "IntervalTier") {
      tokens.wrong("\"" + cli::one_line(kind) + "\" is no class of tiers");
    }
    for (size_t i = 0; i < count; ++i) {
      Phoneme phoneme;
      phoneme.begin = tokens.time("the time of an interval") - start;
      phoneme.end = is_points ? phoneme.begin : tokens.time("the last time of an interval") - start;
      phoneme.label = tokens.text("the text of an interval");
      if (is_points) continue;
      const std::string where = shown + ", line " + std::to_string(tokens.line());
      // Words are not phonemes, and may be long.
      if (fitness(name) > 0) add_interval(utterance, std::move(phoneme), where);
    }
    const int fit = is_points ? -1 : fitness(name);
    // Of tiers that fit alike, the last: aligners write words before phonemes.
    if (fit >= best_fitness && fit > 0) {
      best_fitness = fit;
      best.utterance = std::move(utterance);
    }
  }
  if (best_fitness < 0) {
    cli::fail(cli::kInvalid, kCannotRead, shown, "it has no tier of intervals with phonemes",
              "name one \"phones\"");
  }
  best.alphabet = find_alphabet(best.utterance.phonemes);
  return best;
}

PhonemeFile parse_phonemes(const std::string& text, const std::string& shown) {
  const size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first != std::string::npos && text[first] == '{') return parse_phoneme_json(text, shown);
  return parse_textgrid(text, shown);
}

void add_interval(Utterance& utterance, Phoneme phoneme, const std::string& where) {
  const auto wrong = [&](const std::string& why) {
    cli::fail(cli::kInvalid, kCannotRead, where, why, "put phonemes in the order of their times");
  };
  if (phoneme.end < phoneme.begin) wrong("an interval ends before it begins");
  const double last = utterance.phonemes.empty() ? 0 : utterance.phonemes.back().end;
  // Times are rounded on their way.
  if (phoneme.begin < last - 0.001) wrong("an interval begins before the one before it ends");
  phoneme.begin = std::max(phoneme.begin, last);
  phoneme.end = std::max(phoneme.end, phoneme.begin);
  if (is_pause(phoneme.label)) return;
  if (phoneme.label.size() > kLongestLabel) wrong("a label is longer than 63 bytes");
  utterance.seconds = std::max(utterance.seconds, phoneme.end);
  if (utterance.phonemes.size() == kMostPhonemes) wrong("there are more than 1,000,000 phonemes");
  if (phoneme.end > phoneme.begin) utterance.phonemes.push_back(std::move(phoneme));
}

}  // namespace mien::speech
