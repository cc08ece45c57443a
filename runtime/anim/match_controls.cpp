// SPDX-License-Identifier: MIT
#include "runtime/anim/match_controls.h"

#include <algorithm>
#include <cstring>

#include "runtime/anim/arkit_table.h"
#include "runtime/anim/control_aliases.h"
#include "runtime/anim/control_names.h"

namespace mien {
namespace {

constexpr uint32_t kUnmatched = kNoName, kSeveral = kUnmatched - 1;  // instead of a control
constexpr uint64_t kNoHash = 0;                                      // of what matches nothing

uint64_t hash_of(const ControlSpelling& spelling) {
  if (spelling.empty()) return kNoHash;
  uint64_t hash = 0xcbf29ce484222325u ^ static_cast<uint64_t>(spelling.side);
  for (const char c : spelling.letters()) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  }
  return hash | 1;
}

uint64_t hash_of(const KnownControl& known) {
  return known.known() ? (uint64_t{known.row} + 1) * 4 + static_cast<uint64_t>(known.side)
                       : kNoHash;
}

bool before(const ControlKey& a, const ControlKey& b) {
  if (a.hash != b.hash) return a.hash < b.hash;
  return a.rank != b.rank ? a.rank < b.rank : a.control < b.control;
}

ControlSpelling with_side(ControlSpelling spelling, Side side) {
  spelling.side = side;
  return spelling;
}

Span<const char> text_of(const char* text) { return {text, strlen(text)}; }

/// The part after the last dot, without the prefix of controls.
Span<const char> short_of(Span<const char> name) {
  for (size_t i = name.count; i-- > 1;) {
    if (name[i - 1] == '.') return without_prefix(name.slice(i, name.count - i));
  }
  return without_prefix(name);
}

/// An expression of kExpressionShares: letters, then its side.
bool is_expression(const char* text, const ControlSpelling& spelling) {
  if (strlen(text) < spelling.count || memcmp(text, spelling.text, spelling.count) != 0)
    return false;
  const char* mark = text + spelling.count;
  switch (spelling.side) {
    case Side::kNone: return *mark == 0;
    case Side::kLeft: return strcmp(mark, "<") == 0;
    case Side::kRight: return strcmp(mark, ">") == 0;
  }
  return false;
}

/// The sum of shares, if a control comes twice.
bool add_share(uint32_t control, float weight, ControlMatch& out) {
  for (uint32_t i = 0; i < out.count; ++i) {
    if (out.shares[i].control != control) continue;
    out.shares[i].weight += weight;
    return true;
  }
  if (control >= kSeveral || out.count == kMostShares) return false;
  out.shares[out.count++] = {control, weight};
  return true;
}

}  // namespace

void ControlFinder::sort(Span<ControlKey> by_spelling, Span<ControlKey> by_alias) {
  for (uint32_t i = 0; i < names_.count(); ++i) {
    const ControlSpelling spelling = spell_control(names_[i]);
    const KnownControl known = know_control(spelling);
    by_spelling[i] = {hash_of(spelling), i, 0};
    by_alias[i] = {hash_of(known), i, known.rank};
  }
  std::sort(by_spelling.begin(), by_spelling.end(), before);
  std::sort(by_alias.begin(), by_alias.end(), before);
  by_spelling_ = by_spelling;
  by_alias_ = by_alias;
}

/// The control of the same name without regard to case, `.` being `_`, with or without the part before its
/// last dot. kUnmatched if there are several.
uint32_t ControlFinder::find_folded(Span<const char> name) const {
  const uint32_t exact = find_name(names_, name);
  if (exact != kNoName) return exact;
  // With lists, the spelling finds it in less time.
  if (!by_spelling_.empty()) return kUnmatched;
  uint32_t found = kUnmatched;
  const Span<const char> key = short_of(name);
  for (uint32_t i = 0; i < names_.count(); ++i) {
    if (compare_folded(short_of(names_[i]), key) != 0) continue;
    if (found != kUnmatched) return kUnmatched;
    found = i;
  }
  return found;
}

uint32_t ControlFinder::find_spelled(const ControlSpelling& spelling) const {
  if (spelling.empty()) return kUnmatched;
  uint32_t found = kUnmatched;
  const auto take = [&](uint32_t control) {
    if (!(spell_control(names_[control]) == spelling)) return true;
    const bool is_first = found == kUnmatched;
    found = is_first ? control : kSeveral;
    return is_first;
  };
  if (by_spelling_.empty()) {
    for (uint32_t i = 0; i < names_.count(); ++i) {
      if (!take(i)) return found;
    }
    return found;
  }
  const ControlKey wanted = {hash_of(spelling), 0, 0};
  const ControlKey* at = std::lower_bound(by_spelling_.begin(), by_spelling_.end(), wanted, before);
  for (; at != by_spelling_.end() && at->hash == wanted.hash; ++at) {
    if (!take(at->control)) return found;
  }
  return found;
}

/// The control that the same row of aliases knows; of several the one whose name is first in the row.
uint32_t ControlFinder::find_known(const KnownControl& known) const {
  if (!known.known()) return kUnmatched;
  if (by_alias_.empty()) {
    ControlKey best = {0, kUnmatched, ~uint32_t{0}};
    for (uint32_t i = 0; i < names_.count(); ++i) {
      const KnownControl other = know_control(spell_control(names_[i]));
      if (other.row != known.row || other.side != known.side || other.rank >= best.rank) continue;
      best = {0, i, other.rank};
    }
    return best.control;
  }
  const ControlKey wanted = {hash_of(known), 0, 0};
  const ControlKey* at = std::lower_bound(by_alias_.begin(), by_alias_.end(), wanted, before);
  return at != by_alias_.end() && at->hash == wanted.hash ? at->control : kUnmatched;
}

bool ControlFinder::add_control(const char* name, float weight, ControlMatch& out) const {
  const ControlSpelling spelling = spell_control(text_of(name));
  uint32_t control = find_spelled(spelling);
  if (control < kSeveral) return add_share(control, weight, out);
  const KnownControl known = know_control(spelling);
  if (add_arkit(known, weight, out)) return true;
  control = find_known(known);
  return add_share(control, weight, out);
}

bool ControlFinder::add_arkit(const KnownControl& known, float weight, ControlMatch& out) const {
  char text[kMostKnownName];
  const size_t count = write_known_name(known, text);
  bool found = false;
  for (const ArkitEntry& entry : arkit_table()) {
    if (strlen(entry.expression) != count || memcmp(entry.expression, text, count) != 0) continue;
    const uint32_t control = find_spelled(spell_control(text_of(entry.control)));
    if (!add_share(control, entry.weight * weight, out)) return false;
    found = true;
  }
  return found;
}

bool ControlFinder::add_shares(const ControlSpelling& spelling, const KnownControl& known,
                               ControlMatch& out) const {
  for (const ExpressionShare& share : kExpressionShares) {
    if (is_expression(share.expression, spelling) &&
        !add_control(share.control, share.weight, out)) {
      return false;
    }
  }
  return out.count > 0 || add_arkit(known, 1, out);
}

ControlMatch ControlFinder::match(Span<const char> name) const {
  const auto one = [](Match how, uint32_t control) {
    ControlMatch match;
    match.how = how;
    match.count = 1;
    match.shares[0] = {control, 1};
    return match;
  };
  const auto two = [](uint32_t left, uint32_t right) {
    ControlMatch match;
    match.how = Match::kBothSides;
    match.count = 2;
    match.shares[0] = {left, 1};
    match.shares[1] = {right, 1};
    return match;
  };
  const uint32_t folded = find_folded(name);
  if (folded != kUnmatched) return one(Match::kAsWritten, folded);
  const ControlSpelling spelling = spell_control(name);
  if (spelling.empty()) return {};
  const uint32_t spelled = find_spelled(spelling);
  if (spelled == kSeveral) return {};
  if (spelled != kUnmatched) return one(Match::kSpelling, spelled);

  const bool has_pair = spelling.side == Side::kNone && !is_direction(spelling);
  if (has_pair) {
    const uint32_t left = find_spelled(with_side(spelling, Side::kLeft));
    const uint32_t right = find_spelled(with_side(spelling, Side::kRight));
    if (std::max(left, right) < kSeveral) return two(left, right);
  }
  const KnownControl known = know_control(spelling);
  ControlMatch several;
  if (add_shares(spelling, known, several)) {
    several.how = several.count == 1 ? Match::kAlias : Match::kExpression;
    return several;
  }
  const uint32_t alias = find_known(known);
  if (alias != kUnmatched) return one(Match::kAlias, alias);
  if (has_pair) {
    const uint32_t left = find_known(know_control(with_side(spelling, Side::kLeft)));
    const uint32_t right = find_known(know_control(with_side(spelling, Side::kRight)));
    if (std::max(left, right) < kSeveral) return two(left, right);
  }
  return {};
}

}  // namespace mien
