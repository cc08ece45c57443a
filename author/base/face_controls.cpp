// SPDX-License-Identifier: MIT
#include "author/base/face_controls.h"

namespace mien::author {

namespace {

/// The word up to one of `stops` or the end.
Span<const char> take_word(const char* from, const char* stops) {
  return {from, strcspn(from, stops)};
}

void add_span(Span<const char> from, Text& out) { out.add(from.data, from.count); }

}  // namespace

bool FamilyWalk::next(FamilyControl& out) {
  if (!names_) return false;
  out.names = take_word(names_, " ");
  out.suffix = take_word(sides_, " ");
  const char last = out.suffix.count ? out.suffix[out.suffix.count - 1] : 0;
  out.side = last == 'L' ? 1 : last == 'R' ? -1 : 0;
  out.joiner = 0;
  out.parts = 1;
  for (const char c : out.names) {
    if (!strchr("/+>", c)) continue;
    out.joiner = c;
    ++out.parts;
  }
  out.part = part_++;
  out.name = take_word(names_ + at_, "/+> ");
  at_ += static_cast<uint32_t>(out.name.count) + 1;
  if (part_ < out.parts) return true;

  // The next side, or the next name.
  at_ = part_ = 0;
  sides_ += out.suffix.count;
  if (*sides_) {
    ++sides_;
    return true;
  }
  sides_ = family_.sides;
  names_ += out.names.count;
  names_ = *names_ ? names_ + 1 : nullptr;
  return true;
}

void write_raw_name(const ControlFamily& family, const FamilyControl& control, Text& out) {
  out.add(family.prefix);
  add_span(control.name, out);
  add_span(control.suffix, out);
}

void write_gui_name(const ControlFamily& family, const FamilyControl& control, Text& out) {
  const Span<const char> first = take_word(control.names.data, "/+> ");
  const char small = static_cast<char>(first[0] | 0x20);  // to lower case
  out.add(control.side > 0 ? "CTRL_L_" : control.side < 0 ? "CTRL_R_" : "CTRL_C_");
  out.add(family.prefix).add("_").add(&small, 1);
  add_span(first.slice(1, first.count - 1), out);
  add_span(control.suffix.first(control.suffix.count - (control.side != 0)), out);
  out.add(".ty");
}

uint32_t find_ramps(const FamilyControl& control, Ramp (&out)[2]) {
  if (control.joiner == '/' && control.part == 1) {
    out[0] = {-1, 0, -1, 0};
  } else if (control.joiner == '+' && control.part == 1) {
    out[0] = {0.75f, 1, 4, -3};
  } else if (control.joiner == '>') {
    const float n = static_cast<float>(control.parts), k = static_cast<float>(control.part);
    out[0] = {k / n, (k + 1) / n, n, -k};
    if (control.part + 1 < control.parts) {
      out[1] = {(k + 1) / n, (k + 2) / n, -n, k + 2};
      return 2;
    }
  } else {
    out[0] = {0, 1, 1, 0};
  }
  return 1;
}

bool find_face_control(Span<const char> name, const ControlFamily*& family, FamilyControl& out) {
  static constexpr char kPrefix[] = "CTRL_expressions.";
  constexpr size_t kLength = sizeof(kPrefix) - 1;
  if (name.count <= kLength || memcmp(name.data, kPrefix, kLength) != 0) return false;
  name = name.slice(kLength, name.count - kLength);
  for (const ControlFamily& of : kControlFamilies) {
    if (of.since == kNotMetaHuman) continue;
    FamilyWalk walk(of);
    while (walk.next(out)) {
      Text raw;
      write_raw_name(of, out, raw);
      if (raw.count != name.count || memcmp(raw.chars, name.data, name.count) != 0) continue;
      family = &of;
      return true;
    }
  }
  return false;
}

}  // namespace mien::author
