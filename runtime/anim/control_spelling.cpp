// SPDX-License-Identifier: MIT
#include "runtime/anim/control_spelling.h"

#include <cstring>

#include "runtime/anim/control_aliases.h"
#include "runtime/anim/control_names.h"

namespace mien {
namespace {

constexpr uint32_t kRows = sizeof(kAliases) / sizeof(kAliases[0]);

bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
bool is_separator(char c) { return c == '_' || c == '-' || c == ' '; }
char lower(char c) { return is_upper(c) ? static_cast<char>(c + 32) : c; }

/// Letters, digits, and whatever is not ASCII.
bool is_letter(char c) {
  const char l = lower(c);
  return (l >= 'a' && l <= 'z') || (l >= '0' && l <= '9') || static_cast<unsigned char>(c) >= 0x80;
}

/// Without the name of its group: "CTRL_expressions_jawOpen", "face:jawOpen" and "face.jawOpen" are
/// "jawOpen".
Span<const char> without_group(Span<const char> name) {
  for (size_t i = name.count; i-- > 1;) {
    const char c = name[i - 1];
    if (c != '.' && c != ':' && c != '|') continue;
    return without_prefix(name.slice(i, name.count - i));
  }
  return without_prefix(name);
}

/// A whole word. A single letter is a side at either end of a name only.
Side side_of_word(Span<const char> word, bool at_end) {
  if (compare_folded(word, {"left", 4}) == 0) return Side::kLeft;
  if (compare_folded(word, {"right", 5}) == 0) return Side::kRight;
  if (word.count != 1 || !at_end) return Side::kNone;
  return lower(word[0]) == 'l' ? Side::kLeft : lower(word[0]) == 'r' ? Side::kRight : Side::kNone;
}

/// A side at the end of the last word: mouthSmileLeft, mouthsmileleft, mouthSmileL. Takes it away.
Side take_side(Span<const char>& word) {
  const auto takes = [&word](const char* end, size_t least) {
    const size_t count = strlen(end);
    if (word.count < count + least ||
        compare_folded(word.slice(word.count - count, count), {end, count}) != 0) {
      return false;
    }
    word = word.first(word.count - count);
    return true;
  };
  // "cleft" and "upright" have no side.
  if (takes("left", 3)) return Side::kLeft;
  if (takes("right", 3)) return Side::kRight;
  const char last = word.count > 2 ? word[word.count - 1] : 0;
  if (last != 'L' && last != 'R') return Side::kNone;
  word = word.first(word.count - 1);
  return last == 'L' ? Side::kLeft : Side::kRight;
}

/// Reads words of `name` into `out`.
void add_words(Span<const char> name, ControlSpelling& out) {
  for (size_t begin = 0; begin < name.count;) {
    size_t end = begin;
    while (end < name.count && !is_separator(name[end])) ++end;
    Span<const char> word = name.slice(begin, end - begin);
    const bool is_first = begin == 0, is_last = end == name.count;
    if (out.side == Side::kNone && word.count != name.count) {
      out.side = side_of_word(word, is_first || is_last);
      if (out.side != Side::kNone) word.count = 0;
    }
    if (out.side == Side::kNone && is_last) out.side = take_side(word);
    for (const char c : word) {
      if (!is_letter(c)) continue;
      if (out.count == ControlSpelling::kMost) {
        out.count = 0;
        return;
      }
      out.text[out.count++] = lower(c);
    }
    begin = end + 1;
  }
}

bool ends(char c) { return c == 0 || c == ' '; }

/// Whether a word of the table, up to a blank, means the spelling. `*` and `/` take any side, which is returned.
bool matches(const char* word, Span<const char> letters, Side side, Side& out) {
  size_t i = 0;
  while (i < letters.count && lower(word[i]) == letters[i]) ++i;
  if (i < letters.count) return false;
  if (word[i] == '*' || word[i] == '/') {
    out = side;
    return ends(word[i + 1]);
  }
  out = Side::kNone;
  if (word[i] == '<') return side == Side::kLeft && ends(word[i + 1]);
  if (word[i] == '>') return side == Side::kRight && ends(word[i + 1]);
  return side == Side::kNone && ends(word[i]);
}

/// Names of rows without a mark end with their side: "jawLeft".
bool matches_name(const char* name, const ControlSpelling& spelling, Side& out) {
  if (matches(name, spelling.letters(), spelling.side, out)) return true;
  if (spelling.side == Side::kNone) return false;
  const ControlSpelling own = spell_control({name, strlen(name)});
  out = Side::kNone;
  return own == spelling;
}

KnownControl find_row(Span<const char> letters, const ControlSpelling& spelling) {
  ControlSpelling wanted = spelling;
  wanted.count = static_cast<uint8_t>(letters.count);
  for (uint32_t r = 0; r < kRows; ++r) {
    Side side = Side::kNone;
    if (matches_name(kAliases[r].name, wanted, side)) return {r, side, 0};
    uint32_t rank = 1;
    for (const char* word = kAliases[r].aliases; *word; ++rank) {
      if (matches(word, letters, spelling.side, side)) return {r, side, rank};
      while (!ends(*word)) ++word;
      if (*word) ++word;
    }
  }
  return {};
}

}  // namespace

ControlSpelling spell_control(Span<const char> name) {
  ControlSpelling out;
  add_words(without_group(name), out);
  // AU01 is AU1.
  if (out.count > 3 && memcmp(out.text, "au0", 3) == 0) {
    memmove(out.text + 2, out.text + 3, out.count - 3u);
    --out.count;
  }
  if (out.empty()) out.side = Side::kNone;
  return out;
}

bool operator==(const ControlSpelling& a, const ControlSpelling& b) {
  return a.side == b.side && a.count == b.count && memcmp(a.text, b.text, a.count) == 0;
}

KnownControl know_control(const ControlSpelling& spelling) {
  if (spelling.empty()) return {};
  const KnownControl found = find_row(spelling.letters(), spelling);
  if (found.known() || spelling.side != Side::kNone || spelling.count < 3) return found;
  // A name in small letters: eyeblinkl.
  const char last = spelling.text[spelling.count - 1];
  if (last != 'l' && last != 'r') return found;
  ControlSpelling sided = spelling;
  sided.side = last == 'l' ? Side::kLeft : Side::kRight;
  return find_row(spelling.letters().first(spelling.count - 1u), sided);
}

size_t write_known_name(const KnownControl& known, char* out) {
  if (!known.known()) return 0;
  const char* name = kAliases[known.row].name;
  size_t count = 0;
  for (; name[count] && name[count] != '*' && name[count] != '/'; ++count) out[count] = name[count];
  if (known.side == Side::kNone) return count;
  const bool is_left = known.side == Side::kLeft;
  if (name[count] == '/') {
    out[count++] = is_left ? 'L' : 'R';
    return count;
  }
  for (const char* side = is_left ? "Left" : "Right"; *side; ++side) out[count++] = *side;
  return count;
}

bool is_direction(const ControlSpelling& spelling) {
  for (const char* word : {"jaw",
                           "mouth",
                           "mouthmove",
                           "mouthupper",
                           "mouthlower",
                           "mouthupperlipshift",
                           "mouthlowerlipshift",
                           "tongue",
                           "tonguetip",
                           "tongueroll",
                           "tonguetwist",
                           "teeth",
                           "look",
                           "eyelook",
                           "eyeslook",
                           "head",
                           "headturn",
                           "headtilt",
                           "headturnu",
                           "headturnm",
                           "headturnd",
                           "headtiltu",
                           "headtiltm",
                           "headtiltd",
                           "neck",
                           "au30",
                           "jawsideways"}) {
    if (spelling.letters().count == strlen(word) &&
        memcmp(spelling.text, word, spelling.count) == 0)
      return true;
  }
  return false;
}

}  // namespace mien
