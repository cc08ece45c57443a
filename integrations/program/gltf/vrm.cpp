// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/vrm.h"

#include <algorithm>

namespace mien::gltf {

namespace {

using json = nlohmann::ordered_json;

constexpr const char* kPresets[] = {"happy",    "angry",     "sad",        "relaxed", "surprised",
                                    "aa",       "ih",        "ou",         "ee",      "oh",
                                    "blink",    "blinkLeft", "blinkRight", "lookUp",  "lookDown",
                                    "lookLeft", "lookRight", "neutral"};
// The license that the specification itself brings: what meta allows and forbids.
constexpr char kLicense[] = "https://vrm.dev/licenses/1.0/";
constexpr double kMostDegrees = 90;

bool is_preset(const std::string& name) {
  return std::find(std::begin(kPresets), std::end(kPresets), name) != std::end(kPresets);
}

json array_of(const Float3& values) { return json::array({values[0], values[1], values[2]}); }

/// Each target by name, with the meshes that it moves.
json expressions_json(const Scene& scene, size_t first_mesh_node) {
  json presets = json::object(), customs = json::object();
  for (size_t m = 0; m < scene.meshes.size(); ++m) {
    const std::vector<MorphTarget>& targets = scene.meshes[m].targets;
    for (size_t t = 0; t < targets.size(); ++t) {
      json& expression = (is_preset(targets[t].name) ? presets : customs)[targets[t].name];
      if (expression.is_null()) {
        expression = {{"isBinary", false}, {"morphTargetBinds", json::array()}};
        // Lids and jaw that these move are not to move twice.
        if (targets[t].name == "relaxed") expression["overrideBlink"] = "blend";
        if (targets[t].name == "surprised") expression["overrideMouth"] = "blend";
      }
      if (targets[t].vertices.empty()) continue;
      expression["morphTargetBinds"].push_back(
          {{"node", first_mesh_node + m}, {"index", t}, {"weight", 1}});
    }
  }
  json result = json::object();
  if (!presets.empty()) result["preset"] = std::move(presets);
  if (!customs.empty()) result["custom"] = std::move(customs);
  return result;
}

/// By expressions, which move the lids as well, if each of them turns the eyes; else by the bones of the eyes.
json look_at_json(const Vrm& vrm) {
  const LookAngles& looks = vrm.looks;
  const bool by_expression = looks.sideways > 0 && looks.down > 0 && looks.up > 0;
  json look = {{"type", by_expression ? "expression" : "bone"},
               {"offsetFromHeadBone", array_of(vrm.eyes)}};
  const auto range = [&](const char* name, double degrees) {
    look[name] = {{"inputMaxValue", by_expression ? degrees : kMostDegrees},
                  {"outputScale", by_expression ? 1.0 : kMostDegrees}};
  };
  range("rangeMapHorizontalInner", looks.sideways);
  range("rangeMapHorizontalOuter", looks.sideways);
  range("rangeMapVerticalDown", looks.down);
  range("rangeMapVerticalUp", looks.up);
  return look;
}

}  // namespace

json vrm_json(const Vrm& vrm, const Scene& scene, size_t first_joint_node, size_t first_mesh_node) {
  json bones = json::object();
  for (const HumanBone& bone : vrm.bones) {
    bones[bone.name] = {{"node", first_joint_node + bone.joint}};
  }
  json authors = json::array();
  for (const std::string& author : vrm.authors) authors.push_back(author);
  json result = {{"specVersion", "1.0"}};
  result["meta"] = {{"name", vrm.name},
                    {"authors", std::move(authors)},
                    {"licenseUrl", kLicense},
                    {"avatarPermission", "onlyAuthor"},
                    {"allowExcessivelyViolentUsage", false},
                    {"allowExcessivelySexualUsage", false},
                    {"commercialUsage", "personalNonProfit"},
                    {"allowPoliticalOrReligiousUsage", false},
                    {"allowAntisocialOrHateUsage", false},
                    {"creditNotation", "required"},
                    {"allowRedistribution", false},
                    {"modification", "prohibited"}};
  result["humanoid"] = {{"humanBones", std::move(bones)}};
  result["lookAt"] = look_at_json(vrm);
  json expressions = expressions_json(scene, first_mesh_node);
  if (!expressions.empty()) result["expressions"] = std::move(expressions);
  return result;
}

}  // namespace mien::gltf
