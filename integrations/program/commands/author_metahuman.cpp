// SPDX-License-Identifier: MIT
#include "integrations/program/commands/author_metahuman.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "integrations/program/io/handles.h"
#include "integrations/program/io/matched_names.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

constexpr const char* kRawPrefix = "CTRL_expressions.";
// How far the parts of a divided shape fade into each other, in standard deviations of where it moves.
constexpr double kFadeAcross = 0.5, kFadeLips = 0.25;

/// A control of which a part of a shape becomes the motion.
struct DividedPart {
  std::string control;
  char lip = 0;   // U or D; 0: both
  char side = 0;  // L or R; 0: both
};

/// mouthFunnelUL is "mouthFunnel", upper lip, left.
DividedPart part_of(const std::string& control, std::string& stem) {
  DividedPart part = {control};
  stem = control;
  if (stem.back() == 'L' || stem.back() == 'R') {
    part.side = stem.back();
    stem.pop_back();
  }
  // "jawChinRaiseD" moves the lower lip alone already.
  const bool has_lips = stem.compare(0, 3, "jaw") != 0;
  if (has_lips && (stem.back() == 'U' || stem.back() == 'D')) {
    part.lip = stem.back();
    stem.pop_back();
  }
  return part;
}

/// The controls that a shape of ARKit is divided among: those of one word that all move fully with it.
std::vector<DividedPart> parts_of(const std::string& shape) {
  const std::string usual = usual_name(shape);
  std::vector<DividedPart> parts;
  std::string word;
  for (const MienMatrixEntry& entry : arkit_matrix()) {
    if (to_string(entry.channel) != usual || entry.weight != 1) continue;
    std::string stem;
    const DividedPart part = part_of(to_string(entry.control), stem);
    if (parts.empty()) word = stem;
    if (stem == word) parts.push_back(part);
  }
  return parts;
}

/// Where a shape moves, along one axis: mean and standard deviation, by squared length.
struct Spread {
  double mean = 0, deviation = 0;
};

template <class Along>
Spread spread_of(const MeshFile& mesh, const MeshShape& shape, const Along& along) {
  double sum = 0, first = 0, second = 0;
  for (size_t i = 0; i < shape.displacements.size() / 3; ++i) {
    const double* d = &shape.displacements[3 * i];
    const size_t v = shape.vertices.empty() ? i : shape.vertices[i];
    const double weight = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    const double x = along(&mesh.positions[3 * v]);
    sum += weight;
    first += weight * x;
    second += weight * x * x;
  }
  if (!(sum > 0)) return {};
  const double mean = first / sum;
  return {mean, std::sqrt(std::max(0.0, second / sum - mean * mean))};
}

/// 0 below, 1 above, a smooth step of width 2 * `fade` between.
double share_above(double x, const Spread& spread, double fade) {
  const double width = fade * spread.deviation;
  if (!(width > 0)) return x > spread.mean ? 1 : 0;
  const double t = std::min(1.0, std::max(0.0, (x - spread.mean) / (2 * width) + 0.5));
  return t * t * (3 - 2 * t);
}

std::vector<MeshShape> divided(const MeshStand& stand, const MeshFile& mesh, const MeshShape& shape,
                               const std::vector<DividedPart>& parts) {
  // Left is up x front.
  const size_t axis = stand.left_axis();
  const bool cyclic = (stand.up.axis + 1) % 3 == stand.front.axis;
  const double sign = stand.up.sign * stand.front.sign * (cyclic ? 1 : -1);
  const auto left_of = [&](const double* p) { return sign * p[axis]; };
  const auto height_of = [&](const double* p) { return stand.height_of(p); };
  const Spread across = spread_of(mesh, shape, left_of), up = spread_of(mesh, shape, height_of);
  std::vector<MeshShape> out;
  for (const DividedPart& part : parts) {
    MeshShape made = {kRawPrefix + part.control, shape.vertices, shape.displacements};
    for (size_t i = 0; i < made.displacements.size() / 3; ++i) {
      const double* p = &mesh.positions[3 * (made.vertices.empty() ? i : made.vertices[i])];
      const double left = share_above(left_of(p), across, kFadeAcross);
      const double upper = share_above(height_of(p), up, kFadeLips);
      const double share = (part.side == 'L'   ? left
                            : part.side == 'R' ? 1 - left
                                               : 1) *
                           (part.lip == 'U'   ? upper
                            : part.lip == 'D' ? 1 - upper
                                              : 1);
      for (size_t k = 0; k < 3; ++k) made.displacements[3 * i + k] *= share;
    }
    out.push_back(std::move(made));
  }
  return out;
}

/// The members of a combination, "jawOpen_mouthFunnel"; empty if the name is none. Other shapes by name.
std::vector<std::string> members_of(const std::string& name, const std::set<std::string>& shapes) {
  if (shapes.count(name) != 0 && name.find_first_of("_+") == std::string::npos) return {};
  for (size_t end = name.find_first_of("_+"); end != std::string::npos;
       end = name.find_first_of("_+", end + 1)) {
    const std::string first = name.substr(0, end), rest = name.substr(end + 1);
    if (shapes.count(first) == 0) continue;
    std::vector<std::string> members = members_of(rest, shapes);
    if (members.empty() && shapes.count(rest) != 0) members = {rest};
    if (members.empty()) continue;
    members.insert(members.begin(), first);
    return members;
  }
  return {};
}

}  // namespace

nlohmann::ordered_json name_as_metahuman(const MeshStand& stand, MeshFile& mesh,
                                         const Session& session) {
  nlohmann::ordered_json report = nlohmann::ordered_json::object();
  if (mesh.shapes.empty()) return report;
  std::set<std::string> names, in_combinations, taken;
  for (const MeshShape& shape : mesh.shapes) names.insert(shape.name);
  std::map<std::string, std::vector<std::string>> combinations;
  for (const std::string& name : names) {
    std::vector<std::string> members = members_of(name, names);
    if (members.size() < 2) continue;
    in_combinations.insert(members.begin(), members.end());
    combinations[name] = std::move(members);
  }
  taken = names;

  // Shapes of one control first: they win over parts of others.
  std::map<std::string, std::string> renamed;
  for (const std::string& name : names) {
    const std::string control = metahuman_name(name);
    const std::vector<DividedPart> parts = parts_of(name);
    const bool divides = parts.size() > 1 && in_combinations.count(name) == 0;
    if (control.empty() || divides || combinations.count(name) != 0) continue;
    if (control == name || taken.insert(control).second) renamed[name] = control;
  }
  std::vector<MeshShape> shapes;
  std::string without;
  size_t without_count = 0, divided_count = 0;
  for (MeshShape& shape : mesh.shapes) {
    const std::string name = shape.name;
    const auto combination = combinations.find(name);
    const auto one = renamed.find(name);
    nlohmann::ordered_json& became = report[name] = nlohmann::ordered_json::array();
    std::vector<DividedPart> parts;
    if (combination == combinations.end() && one == renamed.end()) parts = parts_of(name);
    bool free = parts.size() > 1 && in_combinations.count(name) == 0;
    for (const DividedPart& part : parts) {
      free = free && taken.count(kRawPrefix + part.control) == 0;
    }
    if (combination != combinations.end()) {
      shape.name.clear();
      for (const std::string& member : combination->second) {
        const auto found = renamed.find(member);
        shape.name +=
            (shape.name.empty() ? "" : "+") + (found == renamed.end() ? member : found->second);
      }
      became.push_back(shape.name);
    } else if (one != renamed.end()) {
      shape.name = one->second;
      became.push_back(shape.name);
    } else if (free) {
      ++divided_count;
      for (MeshShape& part : divided(stand, mesh, shape, parts)) {
        taken.insert(part.name);
        became.push_back(part.name);
        shapes.push_back(std::move(part));
      }
      continue;
    } else {
      if (++without_count <= 8) without += (without.empty() ? "" : ", ") + one_line(name);
    }
    shapes.push_back(std::move(shape));
  }
  const size_t given = report.size();
  mesh.shapes = std::move(shapes);
  if (without_count > 8) without += ", ...";
  note(session,
       std::to_string(given - without_count) + " of " + std::to_string(given) +
           " shapes have a counterpart among MetaHuman's raw controls, and its name" +
           (divided_count > 0 ? "; " + std::to_string(divided_count) +
                                    " of them mean several controls and are divided among these"
                              : "") +
           (without_count > 0 ? "; without one: " + without : ""));
  return report;
}

}  // namespace mien::cli
