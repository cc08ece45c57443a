// SPDX-License-Identifier: MIT
#include "integrations/program/commands/solve_mask.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "integrations/program/io/controls.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/json_check.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/npy_reader.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

using MaskJson = nlohmann::basic_json<MemberList>;

constexpr const char* kWhatMask = "cannot use mask";
constexpr const char* kMaskExample =
    "give {\"names\": {\"*Lip*\": 1, \"*Jaw*\": 0.5}, \"positions\": [12, [100, 200]], "
    "\"otherwise\": 0}";

[[noreturn]] void fail_mask(const std::string& where, const std::string& why,
                            const std::string& what_to_do = kMaskExample) {
  fail(kInvalid, kWhatMask, where, why, what_to_do);
}

float read_weight(const MaskJson& value, const std::string& where) {
  const float weight = value.is_number() ? value.get<float>() : -1;
  if (!(weight >= 0) || !std::isfinite(weight)) fail_mask(where, "this is no number from 0 on");
  return weight;
}

/// What has names: landmarks, or the joints of the rig.
std::vector<std::string> names_of(const SolvedRig& rig, const SolveTarget& target) {
  if (!target.point_names.empty()) return target.point_names;
  std::vector<std::string> names;
  for (uint32_t j = 0; j < rig_count(rig.rig, MIEN_KIND_JOINT); ++j) {
    names.push_back(rig_name(rig.rig, MIEN_KIND_JOINT, j));
  }
  return names;
}

/// A weight for each name; later patterns win. NaN: no pattern matches.
std::vector<float> match_names(const MaskJson& patterns, const std::vector<std::string>& names,
                               const std::string& shown) {
  if (!patterns.is_object()) fail_mask(shown + ", names", "it is not an object");
  std::vector<float> weights(names.size(), NAN);
  for (const auto& [pattern, value] : patterns.items()) {
    const std::string where = shown + ", names." + one_line(pattern);
    const float weight = read_weight(value, where);
    bool found = false;
    for (size_t i = 0; i < names.size(); ++i) {
      if (!matches_pattern(pattern, names[i])) continue;
      weights[i] = weight;
      found = true;
    }
    if (!found) {
      fail_mask(where, "no name matches",
                nearest_question(pattern, names, "use * for any letters"));
    }
  }
  return weights;
}

/// Skin weights of joints with a weight count as much as it, the others as `otherwise`.
std::vector<float> spread_over_skin(const std::vector<float>& joints, float otherwise,
                                    const SolvedRig& rig, const SolveTarget& target) {
  std::vector<float> weights;
  for (const MienSolvePoint& point : target.points) {
    MienIndex16View held{};
    MienFloatView shares{};
    check(mien_deformer_influences(rig.deformer, point.mesh, point.positions[0], &held, &shares),
          nullptr, kWhatMask, rig.shown);
    float weight = 0, rest = 1;
    for (size_t i = 0; i < held.count; ++i) {
      const float own = joints[held.data[i]];
      if (std::isnan(own)) continue;
      weight += shares.data[i] * own;
      rest -= shares.data[i];
    }
    weights.push_back(weight + std::max(rest, 0.0f) * otherwise);
  }
  return weights;
}

/// Positions, and ranges [first, last], that count fully.
void mark_positions(const MaskJson& list, const std::string& shown, std::vector<float>& weights) {
  const std::string where = shown + ", positions";
  if (!list.is_array()) fail_mask(where, "it is not a list");
  for (const MaskJson& entry : list) {
    const bool is_range = entry.is_array() && entry.size() == 2;
    const MaskJson& first = is_range ? entry[0] : entry;
    const MaskJson& last = is_range ? entry[1] : entry;
    if (!first.is_number_unsigned() || !last.is_number_unsigned() ||
        last.get<uint64_t>() >= weights.size() || first.get<uint64_t>() > last.get<uint64_t>()) {
      fail_mask(where, one_line(entry.dump()) +
                           " is no position, and no range of them: there are " +
                           grouped(weights.size()));
    }
    std::fill(weights.begin() + first.get<std::ptrdiff_t>(),
              weights.begin() + last.get<std::ptrdiff_t>() + 1, 1.0f);
  }
}

std::vector<float> read_json_mask(const std::string& path, const SolvedRig& rig,
                                  const SolveTarget& target) {
  const std::string shown = shown_name(path);
  const MaskJson document =
      parse_json<MaskJson>(read_json(path, kWhatMask), kWhatMask, shown, kMaskExample);
  if (!document.is_object()) fail_mask(shown, "it is not an object");
  for (const auto& [key, value] : document.items()) {
    if (key == "names" || key == "positions" || key == "otherwise") continue;
    fail_mask(shown + ", " + one_line(key), "this is unknown",
              nearest_question(key, {"names", "positions", "otherwise"}, kMaskExample));
  }
  const float otherwise = document.contains("otherwise")
                              ? read_weight(document["otherwise"], shown + ", otherwise")
                              : 0;
  const std::vector<float> named =
      match_names(document.value("names", MaskJson::object()), names_of(rig, target), shown);
  const bool is_mesh = !target.points.empty() && target.point_names.empty();
  if (!is_mesh && document.contains("positions")) {
    fail_mask(shown + ", positions", "the target is no mesh", "give names");
  }
  if (is_mesh) {
    std::vector<float> weights = spread_over_skin(named, otherwise, rig, target);
    mark_positions(document.value("positions", MaskJson::array()), shown, weights);
    return weights;
  }
  std::vector<float> weights;
  for (const float weight : named) weights.push_back(std::isnan(weight) ? otherwise : weight);
  return weights;
}

}  // namespace

std::vector<float> read_mask(const std::string& path, const SolvedRig& rig,
                             const SolveTarget& target) {
  const bool joints = target.points.empty();
  const size_t count = joints ? rig_count(rig.rig, MIEN_KIND_JOINT) : target.points.size();
  std::vector<float> weights;
  if (is_array_file(path)) {
    const std::string shown = shown_name(path);
    weights = read_npy_or_npz(read_any_bytes(path, kWhatMask), shown).numbers;
    if (weights.size() != count) {
      fail_mask(shown, "it has " + grouped(weights.size()) + " numbers",
                "give one for each of " + grouped(count) + (joints ? " joints" : " points"));
    }
    if (std::any_of(weights.begin(), weights.end(), [](float w) { return w < 0; })) {
      fail_mask(shown, "a weight is negative", "give numbers from 0 on");
    }
  } else {
    weights = read_json_mask(path, rig, target);
  }
  if (std::none_of(weights.begin(), weights.end(), [](float w) { return w > 0; })) {
    fail_mask(shown_name(path), "all weights are 0", kMaskExample);
  }
  if (!joints) return weights;
  std::vector<float> values;
  for (const float weight : weights) values.insert(values.end(), joint_width(rig), weight);
  return values;
}

}  // namespace mien::cli
