// SPDX-License-Identifier: MIT
#include "integrations/program/commands/author_landmarks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/json_check.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

constexpr char kCannotUseLandmarks[] = "cannot use landmarks";
constexpr char kLandmarksExample[] =
    R"(write {"nose": [0, 1.2, 9], "chin": 1043, "eye_l": "EyeBall_L"})";
const std::vector<std::string> kLandmarkWords = {"nose",    "throat",  "lip_upper", "lip_lower",
                                                 "mouth_l", "mouth_r", "chin",      "jaw",
                                                 "eye_l",   "eye_r",   "head",      "neck"};

[[noreturn]] void wrong_landmark(const std::string& where, const std::string& why) {
  fail(kInvalid, kCannotUseLandmarks, where, why, kLandmarksExample);
}

std::array<double, 3> position_of(const MeshFile& mesh, size_t v) {
  return {mesh.positions[3 * v], mesh.positions[3 * v + 1], mesh.positions[3 * v + 2]};
}

/// The middle of the box around an object; false if there is none of this name.
bool find_object(const MeshFile& mesh, const std::string& name, std::array<double, 3>& middle) {
  std::array<double, 3> low = {INFINITY, INFINITY, INFINITY},
                        high = {-INFINITY, -INFINITY, -INFINITY};
  size_t corner = 0, face = 0;
  for (const MeshObject& object : mesh.objects) {
    for (uint32_t f = 0; f < object.face_count; ++f) {
      const uint32_t size = mesh.face_sizes[face++];
      for (uint32_t c = 0; c < size; ++c) {
        const std::array<double, 3> p = position_of(mesh, mesh.corners[corner++]);
        for (size_t k = 0; k < 3 && object.name == name; ++k) {
          low[k] = std::min(low[k], p[k]);
          high[k] = std::max(high[k], p[k]);
        }
      }
    }
  }
  for (size_t k = 0; k < 3; ++k) middle[k] = (low[k] + high[k]) / 2;
  return low[0] <= high[0];
}

}  // namespace

LandmarksFile::LandmarksFile(const std::string& path, const MeshFile& mesh) {
  if (path.empty()) return;
  using LandmarkJson = nlohmann::basic_json<MemberList>;
  const std::string shown = shown_name(path);
  const LandmarkJson document = parse_json<LandmarkJson>(
      read_json(path, kCannotUseLandmarks), kCannotUseLandmarks, shown, kLandmarksExample);
  if (!document.is_object()) wrong_landmark(shown, "expected an object of landmarks");
  for (const auto& [name, place] : document.items()) {
    const std::string where = shown + ", " + one_line(name);
    if (std::find(kLandmarkWords.begin(), kLandmarkWords.end(), name) == kLandmarkWords.end()) {
      fail(kInvalid, kCannotUseLandmarks, where, "there is no landmark of this name",
           nearest_question(name, kLandmarkWords,
                            "the landmarks are " + list_of(kLandmarkWords, "and")));
    }
    Given given = {name, {}};
    if (place.is_array() && place.size() == 3) {
      for (size_t k = 0; k < 3; ++k) {
        if (!place[k].is_number()) wrong_landmark(where, "a place has three numbers");
        given.at[k] = place[k].template get<double>();
      }
    } else if (place.is_number_unsigned()) {
      const uint64_t number = place.template get<uint64_t>();
      if (number >= mesh.position_count()) {
        wrong_landmark(where, "the mesh has " + std::to_string(mesh.position_count()) +
                                  " positions, numbered from 0");
      }
      given.at = position_of(mesh, static_cast<size_t>(number));
    } else if (place.is_string()) {
      const std::string object = place.template get<std::string>();
      std::vector<std::string> known;
      for (const MeshObject& one : mesh.objects) known.push_back(one.name);
      if (!find_object(mesh, object, given.at)) {
        fail(kInvalid, kCannotUseLandmarks, where,
             "the mesh has no object \"" + one_line(object) + "\"",
             nearest_question(object, known, "give a place, or the number of a position"));
      }
    } else {
      wrong_landmark(where, "expected three numbers, the number of a position, or an object");
    }
    given_.push_back(given);
  }
}

std::vector<MienAuthorLandmark> LandmarksFile::list() const {
  std::vector<MienAuthorLandmark> out;
  for (const Given& given : given_) {
    out.push_back(
        {{given.name.data(), given.name.size()}, {given.at[0], given.at[1], given.at[2]}});
  }
  return out;
}

void refuse_uncertain(const nlohmann::ordered_json& report, double least,
                      const std::string& shown) {
  std::string names, example;
  for (const auto& [name, mark] : report["landmarks"].items()) {
    if (mark.is_null() || !mark["used"].get<bool>()) continue;
    const double confidence = mark["confidence"].get<double>();
    if (confidence >= least) continue;
    char text[16];
    std::snprintf(text, sizeof text, " (%.2f)", confidence);
    names += (names.empty() ? "" : ", ") + name + text;
    example += (example.empty() ? "\"" : ", \"") + name + "\": [x, y, z]";
  }
  if (names.empty()) return;
  fail(kInvalid, "cannot rig", shown, "it is not certain where these landmarks are: " + names,
       "give a file with {" + example + "} as --landmarks, or rig it as it is with --confidence 0");
}

}  // namespace mien::cli
