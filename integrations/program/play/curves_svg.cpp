// SPDX-License-Identifier: MIT
#include "integrations/program/play/curves_svg.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace mien::cli {

namespace {

constexpr double kLeft = 290, kWidth = 900, kRow = 46, kTop = 64, kGap = 8;
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

/// Between two curves where they differ. `attributes` tell how it is filled.
std::string area(const std::vector<float>& from, const std::vector<float>& to, const Scale& scale,
                 const std::string& attributes) {
  std::string path;
  const float least = static_cast<float>((scale.high - scale.low) * 1e-4);
  for (size_t f = 0; f < to.size();) {
    if (std::abs(to[f] - from[f]) < least) {
      ++f;
      continue;
    }
    const size_t first = f;
    while (f < to.size() && std::abs(to[f] - from[f]) >= least) ++f;
    path += "M";
    for (size_t i = first; i < f; ++i)
      path += number(scale.x(i)) + " " + number(scale.y(to[i])) + " ";
    for (size_t i = f; i-- > first;)
      path += number(scale.x(i)) + " " + number(scale.y(from[i])) + " ";
    path += "Z";
  }
  if (path.empty()) return "";
  return "<path " + attributes + " d=\"" + path + "\"/>\n";
}

std::string line(const std::vector<float>& values, const Scale& scale, const char* attributes) {
  std::string svg = std::string("<polyline fill=\"none\" ") + attributes + " points=\"";
  for (size_t f = 0; f < values.size(); ++f) {
    svg += number(scale.x(f)) + "," + number(scale.y(values[f])) + " ";
  }
  return svg + "\"/>\n";
}

std::string text_at(double x, double y, const char* attributes, const std::string& text) {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" " + attributes + ">" +
         escaped(text) + "</text>\n";
}

std::string level_line(double y, const char* attributes) {
  return "<line x1=\"" + number(kLeft) + "\" x2=\"" + number(kLeft + kWidth) + "\" y1=\"" +
         number(y) + "\" y2=\"" + number(y) + "\" " + attributes + "/>\n";
}

/// Stages that take away what layers want.
bool holds_back(const std::string& stage) {
  return stage == "guards" || stage == "antagonists" || stage == "limits";
}

std::string fill_of(const std::string& stage, size_t number) {
  if (holds_back(stage)) return "fill=\"url(#" + stage + ")\"";
  return std::string("fill=\"") + kColors[number % kColorCount] + "\" fill-opacity=\"0.6\"";
}

/// Lines on white that cover what is below them.
std::string hatch(const std::string& stage, const char* color, int angle) {
  return "<pattern id=\"" + stage +
         "\" width=\"6\" height=\"6\" patternUnits=\"userSpaceOnUse\" patternTransform=\"rotate(" +
         std::to_string(angle) +
         ")\"><rect width=\"6\" height=\"6\" fill=\"white\" fill-opacity=\"0.8\"/>"
         "<line x1=\"0\" x2=\"0\" y1=\"0\" y2=\"6\" stroke=\"" +
         color + "\" stroke-width=\"2\"/></pattern>\n";
}

bool changes(const std::vector<CurvePlot>& curves, size_t stage) {
  for (const CurvePlot& curve : curves) {
    for (size_t f = 0; f < curve.values.size(); ++f) {
      const float before = stage == 0 ? 0.0f : curve.stages[stage - 1][f];
      if (curve.stages[stage][f] != before) return true;
    }
  }
  return false;
}

/// Which color is which stage, of those that do something.
std::string legend(const std::vector<CurvePlot>& curves, const std::vector<std::string>& stages) {
  std::string svg;
  double x = kLeft;
  for (size_t s = 0; s < stages.size(); ++s) {
    if (!changes(curves, s)) continue;
    const std::string words = holds_back(stages[s]) ? "held back by " + stages[s] : stages[s];
    svg += "<rect x=\"" + number(x) + "\" y=\"12\" width=\"14\" height=\"14\" stroke=\"#999\" " +
           fill_of(stages[s], s) + "/>\n";
    svg += text_at(x + 19, 24, "fill=\"#333\"", words);
    x += 40 + 7 * static_cast<double>(words.size());
  }
  return svg;
}

/// Lines down all rows, with names above them: in two rows, those that have room.
std::string caption_lines(const Captions& captions, double seconds, double bottom) {
  std::string svg;
  double free_from[2] = {0, 0};
  for (const auto& [time, name] : captions) {
    if (time > seconds || seconds <= 0) continue;
    const double x = kLeft + kWidth * time / seconds;
    const std::string at = number(x);
    svg += "<line x1=\"" + at + "\" x2=\"" + at + "\" y1=\"" + number(kTop - 4) + "\" y2=\"" +
           number(bottom) + "\" stroke=\"#ddd\"/>\n";
    const int row = free_from[0] <= x ? 0 : 1;
    if (free_from[row] > x) continue;
    svg += text_at(x, kTop - 20 + 12 * row, "font-size=\"10\" fill=\"#555\"", name);
    free_from[row] = x + 8 + 6 * static_cast<double>(name.size());
  }
  return svg;
}

std::string curve_row(const CurvePlot& curve, const std::vector<std::string>& stages, double top) {
  const auto [least, most] = std::minmax_element(curve.values.begin(), curve.values.end());
  double low = std::min(0.0, static_cast<double>(*least));
  double high = std::max(1.0, static_cast<double>(*most));
  for (const std::vector<float>& stage : curve.stages) {
    const auto [lowest, highest] = std::minmax_element(stage.begin(), stage.end());
    low = std::min(low, static_cast<double>(*lowest));
    high = std::max(high, static_cast<double>(*highest));
  }
  const Scale scale = {low, high, top, curve.values.size()};
  std::string svg = level_line(scale.y(0), "stroke=\"#bbb\"");
  svg += level_line(scale.y(1), "stroke=\"#eee\"");
  const double middle = top + (kRow - kGap) / 2;
  svg += text_at(kLeft - 16, middle + (curve.note.empty() ? 4 : -2),
                 "text-anchor=\"end\" fill=\"#333\"", curve.name);
  svg += text_at(kLeft - 16, middle + 11, "text-anchor=\"end\" font-size=\"9\" fill=\"#a33\"",
                 curve.note);
  svg +=
      text_at(kLeft - 4, scale.y(0) + 3, "text-anchor=\"end\" font-size=\"8\" fill=\"#999\"", "0");
  svg +=
      text_at(kLeft - 4, scale.y(1) + 6, "text-anchor=\"end\" font-size=\"8\" fill=\"#999\"", "1");
  std::vector<float> before(curve.values.size());
  for (size_t s = 0; s < curve.stages.size(); ++s) {
    svg += area(before, curve.stages[s], scale, fill_of(stages[s], s));
    before = curve.stages[s];
  }
  return svg + line(curve.values, scale, "stroke=\"black\" stroke-width=\"1.2\"");
}

std::string guard_row(const GuardPlot& guard, double top) {
  const float most = std::max({*std::max_element(guard.wanted.begin(), guard.wanted.end()),
                               *std::max_element(guard.limit.begin(), guard.limit.end()), 1.0f});
  const float least = std::min({*std::min_element(guard.distance.begin(), guard.distance.end()),
                                *std::min_element(guard.wanted.begin(), guard.wanted.end()), 0.0f});
  const Scale scale = {static_cast<double>(least), static_cast<double>(most), top,
                       guard.wanted.size()};
  std::string svg = level_line(scale.y(0), "stroke=\"#bbb\"");
  const double middle = top + (kRow - kGap) / 2;
  svg += text_at(kLeft - 16, middle + 4, "text-anchor=\"end\" fill=\"#333\"", guard.name + ", mm");
  svg +=
      text_at(kLeft - 4, scale.y(0) + 3, "text-anchor=\"end\" font-size=\"8\" fill=\"#999\"", "0");
  svg += text_at(kLeft - 4, top + 6, "text-anchor=\"end\" font-size=\"8\" fill=\"#999\"",
                 number(static_cast<double>(most)));
  svg += area(guard.distance, guard.wanted, scale, "fill=\"url(#guards)\"");
  // The limit counts where the guard is active.
  std::vector<float> limit;
  for (size_t f = 0; f <= guard.limit.size(); ++f) {
    if (f < guard.limit.size() && guard.activation[f] > 0) {
      limit.push_back(guard.limit[f]);
      continue;
    }
    if (!limit.empty()) {
      std::string points;
      for (size_t i = 0; i < limit.size(); ++i) {
        points += number(scale.x(f - limit.size() + i)) + "," + number(scale.y(limit[i])) + " ";
      }
      svg += "<polyline fill=\"none\" stroke=\"#d22\" points=\"" + points + "\"/>\n";
      limit.clear();
    }
  }
  svg += line(guard.wanted, scale, "stroke=\"#555\" stroke-dasharray=\"4 3\"");
  return svg + line(guard.distance, scale, "stroke=\"black\" stroke-width=\"1.2\"");
}

}  // namespace

std::string curves_svg(const std::vector<CurvePlot>& curves, const std::vector<std::string>& stages,
                       const std::vector<GuardPlot>& guards, const Captions& captions,
                       double seconds) {
  const double curves_end = kTop + kRow * static_cast<double>(curves.size());
  const double guards_top = curves_end + 24;
  const double height =
      (guards.empty() ? curves_end : guards_top + kRow * static_cast<double>(guards.size())) + 30;
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" +
                    number(kLeft + kWidth + 30) + "\" height=\"" + number(height) +
                    "\" font-family=\"sans-serif\" font-size=\"12\">\n<defs>" +
                    hatch("guards", "#c33", 45) + hatch("antagonists", "#b279a2", -45) +
                    hatch("limits", "#888", 0) +
                    "</defs>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  svg += legend(curves, stages);
  svg += caption_lines(captions, seconds, height - 26);
  for (size_t l = 0; l < curves.size(); ++l) {
    svg += curve_row(curves[l], stages, kTop + kRow * static_cast<double>(l));
  }
  if (!guards.empty()) {
    svg += text_at(kLeft, guards_top - 8, "fill=\"#333\"",
                   "Guards: distance wanted (dashed), limit while active (red), distance left "
                   "(black)");
  }
  for (size_t g = 0; g < guards.size(); ++g) {
    svg += guard_row(guards[g], guards_top + kRow * static_cast<double>(g));
  }
  // Seconds below.
  const double step = seconds > 40 ? 10 : seconds > 8 ? 2 : seconds > 2 ? 0.5 : 0.1;
  for (double at = 0; at <= seconds + 1e-9 && seconds > 0; at += step) {
    svg += text_at(kLeft + kWidth * at / seconds, height - 10,
                   "text-anchor=\"middle\" fill=\"#777\"", number(at) + " s");
  }
  return svg + "</svg>\n";
}

}  // namespace mien::cli
