// SPDX-License-Identifier: MIT
#include "integrations/cli/play/lanes_svg.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace mien::cli {

namespace {

constexpr double kLeft = 190, kWidth = 900, kRow = 46, kTop = 64, kGap = 8;
constexpr const char* kColors[] = {"#4c78a8", "#f58518", "#54a24b", "#e45756", "#72b7b2",
                                   "#b279a2", "#eeca3b", "#9d755d", "#bab0ac", "#ff9da6"};
constexpr size_t kColorCount = sizeof(kColors) / sizeof(kColors[0]);

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (static_cast<unsigned char>(c) >= 0x20) {
      out += c;
    }
  }
  return out;
}

std::string number(double value) {
  char text[32];
  snprintf(text, sizeof(text), "%.1f", value);
  return text;
}

struct Scale {
  double low, high, top;
  size_t frames;

  double x(size_t frame) const {
    return kLeft +
           (frames > 1 ? kWidth * static_cast<double>(frame) / static_cast<double>(frames - 1) : 0);
  }
  double y(float value) const {
    return top + (kRow - kGap) * (high - static_cast<double>(value)) / (high - low);
  }
};

/// Between two curves where they differ.
std::string area(const std::vector<float>& from, const std::vector<float>& to, const Scale& scale,
                 const char* color) {
  std::string path;
  for (size_t f = 0; f < to.size();) {
    if (std::abs(to[f] - from[f]) < 1e-4f) {
      ++f;
      continue;
    }
    const size_t first = f;
    while (f < to.size() && std::abs(to[f] - from[f]) >= 1e-4f) ++f;
    path += "M";
    for (size_t i = first; i < f; ++i)
      path += number(scale.x(i)) + " " + number(scale.y(to[i])) + " ";
    for (size_t i = f; i-- > first;)
      path += number(scale.x(i)) + " " + number(scale.y(from[i])) + " ";
    path += "Z";
  }
  if (path.empty()) return "";
  return std::string("<path fill=\"") + color + "\" fill-opacity=\"0.55\" d=\"" + path + "\"/>\n";
}

std::string text_at(double x, double y, const char* attributes, const std::string& text) {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" " + attributes + ">" +
         escaped(text) + "</text>\n";
}

}  // namespace

std::string lanes_svg(const std::vector<LanePlot>& lanes, const std::vector<std::string>& stages,
                      double seconds) {
  const double height = kTop + kRow * static_cast<double>(lanes.size()) + 30;
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" +
                    number(kLeft + kWidth + 30) + "\" height=\"" + number(height) +
                    "\" font-family=\"sans-serif\" font-size=\"12\">\n"
                    "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  // Which color is which stage.
  double x = kLeft;
  for (size_t s = 0; s < stages.size(); ++s) {
    svg += "<rect x=\"" + number(x) + "\" y=\"18\" width=\"12\" height=\"12\" fill=\"" +
           kColors[s % kColorCount] + "\" fill-opacity=\"0.55\"/>\n";
    svg += text_at(x + 16, 28, "fill=\"#333\"", stages[s]);
    x += 34 + 7 * static_cast<double>(stages[s].size());
  }
  for (size_t l = 0; l < lanes.size(); ++l) {
    const LanePlot& lane = lanes[l];
    const auto [least, most] = std::minmax_element(lane.values.begin(), lane.values.end());
    const Scale scale = {std::min(0.0, static_cast<double>(*least)),
                         std::max(1.0, static_cast<double>(*most)),
                         kTop + kRow * static_cast<double>(l), lane.values.size()};
    const std::string zero = number(scale.y(0));
    svg += "<line x1=\"" + number(kLeft) + "\" x2=\"" + number(kLeft + kWidth) + "\" y1=\"" + zero +
           "\" y2=\"" + zero + "\" stroke=\"#ccc\"/>\n";
    svg += text_at(kLeft - 8, scale.top + kRow / 2, "text-anchor=\"end\" fill=\"#333\"", lane.name);
    std::vector<float> before(lane.values.size());
    for (size_t s = 0; s < lane.stages.size(); ++s) {
      svg += area(before, lane.stages[s], scale, kColors[s % kColorCount]);
      before = lane.stages[s];
    }
    svg += "<polyline fill=\"none\" stroke=\"black\" points=\"";
    for (size_t f = 0; f < lane.values.size(); ++f) {
      svg += number(scale.x(f)) + "," + number(scale.y(lane.values[f])) + " ";
    }
    svg += "\"/>\n";
  }
  // Seconds below.
  const double step = seconds > 40 ? 10 : seconds > 8 ? 2 : seconds > 2 ? 0.5 : 0.1;
  for (double at = 0; at <= seconds + 1e-9 && seconds > 0; at += step) {
    svg += text_at(kLeft + kWidth * at / seconds, height - 10,
                   "text-anchor=\"middle\" fill=\"#777\"", number(at));
  }
  return svg + "</svg>\n";
}

}  // namespace mien::cli
