// SPDX-License-Identifier: MIT
#include "integrations/program/commands/bake_report.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace mien::cli {

namespace {

using ReportJson = nlohmann::ordered_json;

/// Millimeters, in ten-thousandths.
double rounded_millimeters(double meters) { return std::round(meters * 1e7) / 1e4; }

ReportJson residual_json(const gltf::Residual& off) {
  return {{"worst", rounded_millimeters(off.max)},
          {"mean", rounded_millimeters(off.mean)},
          {"rms", rounded_millimeters(off.rms)}};
}

ReportJson shape_json(const gltf::Residual& halfway, const gltf::Residual& combined) {
  ReportJson shape = residual_json(halfway);
  shape["combined"] = residual_json(combined);
  return shape;
}

void print_combinations(const std::string& who, const gltf::Residual& off, double diagonal,
                        FILE* stream) {
  const double share = diagonal > 0 ? 100 / diagonal : 0;
  std::fprintf(stream,
               "%s: off by %.4f mm on average, %.4f mm rms, %.4f mm at most (%.3g %%, %.3g %% and "
               "%.3g %% of the size)\n",
               who.c_str(), off.mean * 1000, off.rms * 1000, off.max * 1000, off.mean * share,
               off.rms * share, off.max * share);
}

}  // namespace

void print_bake_report(const gltf::BakeReport& report, FILE* stream) {
  std::fprintf(stream, "%-20s %12s %23s %23s\n%-20s %12s %11s %11s %11s %11s\n", "expression",
               "largest move", "off at one half", "off in combinations", "", "mm", "mean mm",
               "max mm", "mean mm", "max mm");
  for (const gltf::BakeReport::Shape& shape : report.expressions) {
    std::fprintf(stream, "%-20s %12.3f %11.4f %11.4f %11.4f %11.4f\n", shape.name.c_str(),
                 shape.max_move * 1000, shape.halfway.mean * 1000, shape.halfway.max * 1000,
                 shape.combined.mean * 1000, shape.combined.max * 1000);
  }
  std::fprintf(stream, "%u random combinations against the full rig, %zu positions that move:\n",
               report.combination_count, report.moved_positions);
  print_combinations("in a viewer that adds targets", report.combinations, report.diagonal, stream);
  if (report.corrective_count != 0) {
    print_combinations("with the " + std::to_string(report.corrective_count) +
                           " correctives, driven as in the extras",
                       report.corrected, report.diagonal, stream);
  }
  std::fprintf(stream, "at most in:");
  for (size_t e = 0; e < report.worst.size(); ++e) {
    if (report.worst[e] != 0)
      std::fprintf(stream, " %s %.2f", report.expressions[e].name.c_str(), double{report.worst[e]});
  }
  std::fprintf(stream, "\n");
  for (const gltf::BakeReport::Follower& follower : report.followers) {
    size_t worst = 0;
    for (size_t e = 0; e < follower.halfway.size(); ++e) {
      if (follower.halfway[e].max > follower.halfway[worst].max) worst = e;
    }
    if (!follower.halfway.empty()) {
      std::fprintf(stream, "%s, attached: at one half off by %.4f mm at most, with %s\n",
                   follower.name.c_str(), follower.halfway[worst].max * 1000,
                   report.expressions[worst].name.c_str());
    }
    print_combinations(follower.name + ", attached, in combinations", follower.combinations,
                       report.diagonal, stream);
  }
}

std::string bake_report_json(const gltf::BakeReport& report,
                             const std::vector<std::string>& missing) {
  ReportJson root, followers = ReportJson::object();
  root["shapes"] = ReportJson::object();
  for (const gltf::BakeReport::Shape& shape : report.expressions) {
    root["shapes"][shape.name] = shape_json(shape.halfway, shape.combined);
  }
  root["combinations"] = {{"count", report.combination_count},
                          {"targets", residual_json(report.combinations)},
                          {"with_correctives", residual_json(report.corrected)}};
  for (const gltf::BakeReport::Follower& follower : report.followers) {
    std::string name = follower.name;
    for (int n = 2; followers.contains(name); ++n) name = follower.name + " " + std::to_string(n);
    ReportJson& entry = followers[name];
    entry["shapes"] = ReportJson::object();
    for (size_t e = 0; e < follower.halfway.size(); ++e) {
      entry["shapes"][report.expressions[e].name] =
          shape_json(follower.halfway[e], follower.combined[e]);
    }
    entry["combinations"] = {{"targets", residual_json(follower.combinations)},
                             {"with_correctives", residual_json(follower.corrected)}};
  }
  root["attached"] = std::move(followers);
  root["missing"] = missing;
  return root.dump(1, ' ', false, ReportJson::error_handler_t::replace) + "\n";
}

}  // namespace mien::cli
