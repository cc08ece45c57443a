// SPDX-License-Identifier: MIT
#include "integrations/program/render/label.h"

#include <cstdint>
#include <vector>

namespace mien::render {

using namespace math;

namespace {

// A glyph is strokes with spaces between; a stroke is points, two characters each: x from 0, and y
// from the base line: 0 ... 9 and a = 10, the height of capitals; below it z = -1, y = -2, x = -3.
// With ~ in front a stroke is round: its points are those of a quadratic B-spline, closed if it
// ends where it begins.
struct Glyph {
  int width;
  const char* strokes;
};

constexpr int kFirst = 32, kLast = 126;
constexpr Glyph kGlyphs[] = {
    {3, ""},                              // space
    {0, "0a03 0001"},                     // !
    {2, "0a07 2a27"},                     // "
    {6, "102a 405a 0363 0767"},           // #
    {6, "~686a0a0565600002 3a30"},        // $
    {6, "006a ~0a2a27070a ~4363604043"},  // %
    {6, "~60171a4a470400404164"},         // &
    {0, "0a07"},                          // '
    {2, "~2a07022z"},                     // (
    {2, "~0a27220z"},                     // )
    {4, "2a24 0945 0549"},                // *
    {4, "0444 2622"},                     // +
    {1, "110y"},                          // ,
    {3, "0434"},                          // -
    {0, "0001"},                          // .
    {4, "0z4a"},                          // /
    {5, "~0a5a50000a"},                   // 0
    {2, "082a20"},                        // 1
    {5, "~080a5a5600 0050"},              // 2
    {5, "~080a5a5525 ~2555500002"},       // 3
    {5, "404a0353"},                      // 4
    {5, "5a0a06 ~0656500001"},            // 5
    {5, "~0656500006 ~4a0803"},           // 6
    {5, "0a5a10"},                        // 7
    {5, "~0a5a55050a ~0555500005"},       // 8
    {5, "~04545a0a04 ~105257"},           // 9
    {0, "0001 0506"},                     // :
    {1, "110y 1516"},                     // ;
    {4, "480440"},                        // <
    {4, "0343 0646"},                     // =
    {4, "084400"},                        // >
    {4, "~080a4a462523 2021"},            // ?
    {6, "~636a0a0050 ~4727234347"},       // @
    {6, "003a60 1353"},                   // A
    {6, "000a ~0a5a5505 ~05656000"},      // B
    {6, "~686a0a006062"},                 // C
    {6, "000a ~0a6a6000"},                // D
    {5, "5a0a0050 0545"},                 // E
    {5, "5a0a00 0545"},                   // F
    {6, "~686a0a006065 6535"},            // G
    {6, "000a 606a 0565"},                // H
    {0, "000a"},                          // I
    {4, "~4a43400003"},                   // J
    {6, "000a 6a04 2660"},                // K
    {5, "0a0050"},                        // L
    {6, "000a346a60"},                    // M
    {6, "000a606a"},                      // N
    {6, "~0a6a60000a"},                   // O
    {6, "000a ~0a6a6404"},                // P
    {6, "~0a6a60000a 426z"},              // Q
    {6, "000a ~0a6a6505 3560"},           // R
    {6, "~686a0a0565600002"},             // S
    {6, "0a6a 3a30"},                     // T
    {6, "~0a030060636a"},                 // U
    {6, "0a306a"},                        // V
    {8, "0a2048608a"},                    // W
    {6, "006a 0a60"},                     // X
    {6, "0a356a 3530"},                   // Y
    {6, "0a6a0060"},                      // Z
    {2, "2a0a0z2z"},                      // [
    {4, "0a4z"},                          // backslash
    {2, "0a2a2z0z"},                      // ]
    {4, "072a47"},                        // ^
    {5, "0z5z"},                          // _
    {1, "0a18"},                          // `
    {5, "~0757500007 5750"},              // a
    {5, "0a00 ~0757500007"},              // b
    {5, "~555707005052"},                 // c
    {5, "5a50 ~0757500007"},              // d
    {5, "0454 ~545707005052"},            // e
    {3, "~3a1a1710 0737"},                // f
    {5, "~0757500007 ~57505x0x"},         // g
    {5, "0a00 ~0407575450"},              // h
    {0, "0700 090a"},                     // i
    {2, "~27202x0x 292a"},                // j
    {4, "0a00 4703 2540"},                // k
    {2, "~0a030020"},                     // l
    {8, "0700 ~0407474440 ~4447878480"},  // m
    {5, "0700 ~0407575450"},              // n
    {5, "~0757500007"},                   // o
    {5, "070x ~0757500007"},              // p
    {5, "575x ~0757500007"},              // q
    {3, "0700 ~040737"},                  // r
    {5, "~5657070453500001"},             // s
    {3, "~1a121030 0737"},                // t
    {5, "~0703005053 5750"},              // u
    {4, "072047"},                        // v
    {8, "0720466087"},                    // w
    {4, "0740 0047"},                     // x
    {4, "0720 471x"},                     // y
    {4, "07470040"},                      // z
    {2, "2a1a1605141z2z"},                // {
    {0, "0a0z"},                          // |
    {2, "0a1a1625141z0z"},                // }
    {4, "~03163245"},                     // ~
};
static_assert(sizeof(kGlyphs) / sizeof(kGlyphs[0]) == kLast - kFirst + 1);
constexpr Glyph kBox = {4, "000a4a4000"};

constexpr float kUnit = 0.07f;    // of the size of a line
constexpr float kSpacing = 2.5f;  // units between glyphs
constexpr float kPen = 0.09f;     // width of a stroke, of the size of a line

struct Point {
  float x, y;
};

float coordinate(char c) {
  if (c >= '0' && c <= '9') return float(c - '0');
  return c == 'a' ? 10.0f : float(c - 'z' - 1);
}

/// Cuts the corners; what is left of an edge is its middle half.
std::vector<Point> cut_corners(const std::vector<Point>& points) {
  const auto between = [](Point a, Point b, float t) {
    return Point{a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t};
  };
  const Point first = points.front(), last = points.back();
  const bool closed = first.x == last.x && first.y == last.y;
  std::vector<Point> cut;
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    const bool starts = i == 0 && !closed, ends = i + 2 == points.size() && !closed;
    cut.push_back(starts ? first : between(points[i], points[i + 1], 0.25f));
    cut.push_back(ends ? last : between(points[i], points[i + 1], 0.75f));
  }
  if (closed) cut.push_back(cut.front());
  return cut;
}

std::vector<std::vector<Point>> strokes_of(const Glyph& glyph) {
  std::vector<std::vector<Point>> strokes;
  for (const char* at = glyph.strokes; *at != '\0';) {
    const bool round = *at == '~';
    if (round) ++at;
    std::vector<Point> points;
    for (; *at != '\0' && *at != ' '; at += 2)
      points.push_back({coordinate(at[0]), coordinate(at[1])});
    if (*at == ' ') ++at;
    if (round) points = cut_corners(cut_corners(cut_corners(points)));
    strokes.push_back(std::move(points));
  }
  return strokes;
}

float distance_to(Point p, Point a, Point b) {
  const float dx = b.x - a.x, dy = b.y - a.y;
  const float squared = dx * dx + dy * dy;
  const float t = squared > 0 ? saturate(((p.x - a.x) * dx + (p.y - a.y) * dy) / squared) : 0.0f;
  const float ex = p.x - a.x - dx * t, ey = p.y - a.y - dy * t;
  return std::sqrt(ex * ex + ey * ey);
}

/// The glyph at the beginning of `text`, which is cut off there.
const Glyph& take_glyph(std::string_view& text) {
  const auto first = static_cast<unsigned char>(text[0]);
  text.remove_prefix(1);
  if (first >= kFirst && first <= kLast) return kGlyphs[first - kFirst];
  while (!text.empty() && (static_cast<unsigned char>(text[0]) & 0xc0) == 0x80)
    text.remove_prefix(1);
  return kBox;
}

void draw_glyph(Image& image, float x, float baseline, const Glyph& glyph, float size,
                Color color) {
  const float unit = size * kUnit, pen = std::max(size * kPen, 1.0f) / 2;
  auto strokes = strokes_of(glyph);
  for (auto& stroke : strokes) {
    for (Point& p : stroke) p = {x + p.x * unit, baseline - p.y * unit};
  }
  const int left = int(std::floor(x - pen - 1));
  const int right = int(std::ceil(x + float(glyph.width) * unit + pen + 1));
  const int top = int(std::floor(baseline - 10 * unit - pen - 1));
  const int bottom = int(std::ceil(baseline + 3 * unit + pen + 1));
  for (int py = top; py <= bottom; ++py) {
    for (int px = left; px <= right; ++px) {
      float nearest = 1e9f;
      for (const auto& stroke : strokes) {
        for (size_t i = 0; i + 1 < stroke.size(); ++i) {
          const Point middle = {float(px) + 0.5f, float(py) + 0.5f};
          nearest = std::min(nearest, distance_to(middle, stroke[i], stroke[i + 1]));
        }
      }
      const float cover = saturate(pen + 0.5f - nearest);
      if (cover > 0) image.blend(px, py, color, cover);
    }
  }
}

/// Bytes of the last character.
size_t last_length(std::string_view text) {
  size_t length = 1;
  while (length < text.size() &&
         (static_cast<unsigned char>(text[text.size() - length]) & 0xc0) == 0x80)
    ++length;
  return length;
}

size_t first_length(std::string_view text) {
  std::string_view rest = text;
  take_glyph(rest);
  return text.size() - rest.size();
}

}  // namespace

float text_width(std::string_view text, float size) {
  float width = 0;
  while (!text.empty()) width += float(take_glyph(text).width) + kSpacing;
  return std::max(width - kSpacing, 0.0f) * size * kUnit;
}

void draw_text(Image& image, float x, float baseline, std::string_view text, float size,
               Color color) {
  while (!text.empty()) {
    const Glyph& glyph = take_glyph(text);
    draw_glyph(image, x, baseline, glyph, size, color);
    x += (float(glyph.width) + kSpacing) * size * kUnit;
  }
}

std::string fit_text(std::string_view text, float size, float width) {
  if (text_width(text, size) <= width) return std::string(text);
  // Names of controls differ at their ends: both are kept, the end first.
  std::string_view head, tail;
  std::string_view rest = text;
  std::string fitting = "..";
  while (!rest.empty()) {
    const bool from_end = tail.size() <= head.size();
    const size_t length = from_end ? last_length(rest) : first_length(rest);
    if (from_end) {
      tail = std::string_view(rest.data() + rest.size() - length, tail.size() + length);
      rest.remove_suffix(length);
    } else {
      head = std::string_view(text.data(), head.size() + length);
      rest.remove_prefix(length);
    }
    std::string next = std::string(head) + ".." + std::string(tail);
    if (text_width(next, size) > width) break;
    fitting = std::move(next);
  }
  return fitting;
}

}  // namespace mien::render
