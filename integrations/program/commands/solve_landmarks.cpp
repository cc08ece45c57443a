// SPDX-License-Identifier: MIT
#include "integrations/program/commands/solve_landmarks.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "integrations/program/io/input.h"
#include "integrations/program/io/json_check.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

using LandmarkJson = nlohmann::json;

constexpr const char* kWhatLandmarks = "cannot use landmarks";
constexpr const char* kLandmarksExample =
    "give {\"points\": {NAME: 1234, NAME: {\"positions\": [1, 2, 3], \"weights\": [0.2, 0.3, "
    "0.5]}}}";

[[noreturn]] void fail_landmarks(const std::string& where, const std::string& why,
                                 const std::string& what_to_do = kLandmarksExample) {
  fail(kInvalid, kWhatLandmarks, where, why, what_to_do);
}

/// As many finite numbers as `count`.
void read_numbers(const LandmarkJson& values, size_t count, float* to, const std::string& where) {
  if (!values.is_array() || values.size() != count) {
    fail_landmarks(where, "it is not a list of " + std::to_string(count) + " numbers");
  }
  for (size_t i = 0; i < count; ++i) {
    to[i] = values[i].is_number() ? values[i].get<float>() : NAN;
    if (!std::isfinite(to[i]))
      fail_landmarks(where, "element " + std::to_string(i) + " is no number");
  }
}

uint32_t read_position(const LandmarkJson& value, uint32_t count, const std::string& where) {
  if (!value.is_number_unsigned()) fail_landmarks(where, "a position is not a whole number");
  if (value.get<uint64_t>() < count) return value.get<uint32_t>();
  fail_landmarks(where, "there is no position " + value.dump() + ": the mesh has " + grouped(count),
                 "count from 0");
}

/// On the mesh that it names, or that of the others.
MienSolvePoint read_point(const LandmarkJson& value, const PlacedLandmarks& landmarks,
                          const SolvedRig& rig, const std::string& where) {
  MienSolvePoint point = {landmarks.mesh, {}, {1, 0, 0}};
  if (!value.is_object()) {
    const uint32_t position = read_position(value, landmarks.position_count, where);
    for (uint32_t& p : point.positions) p = position;
    return point;
  }
  uint32_t count = landmarks.position_count;
  if (value.contains("mesh")) {
    const LandmarkJson& name = value["mesh"];
    if (!name.is_string() || name.get<std::string>().empty()) {
      fail_landmarks(where, "\"mesh\" is no name");
    }
    point.mesh = find_mesh(rig, name.get<std::string>());
    count = mesh_of(rig, point.mesh).position_count;
  }
  const LandmarkJson positions = value.value("positions", LandmarkJson());
  if (!positions.is_array() || positions.size() != 3) {
    fail_landmarks(where, "\"positions\" is not a list of three numbers");
  }
  for (size_t i = 0; i < 3; ++i) {
    point.positions[i] = read_position(positions[i], count, where);
  }
  read_numbers(value.value("weights", LandmarkJson()), 3, point.weights, where + ".weights");
  return point;
}

MienFitCamera read_camera(const LandmarkJson& value, const std::string& where) {
  MienFitCamera camera = {};
  if (!value.is_object()) fail_landmarks(where, "the camera is not an object");
  read_numbers(value.value("focal", LandmarkJson()), 2, camera.focal, where + ".focal");
  read_numbers(value.value("center", LandmarkJson()), 2, camera.center, where + ".center");
  // Without either, the rotation stays 0: unknown.
  if (value.contains("rotation") || value.contains("translation")) {
    for (const int k : {0, 4, 8}) camera.rotation[k] = 1;
  }
  if (value.contains("rotation")) {
    read_numbers(value["rotation"], 9, camera.rotation, where + ".rotation");
  }
  if (value.contains("translation")) {
    read_numbers(value["translation"], 3, camera.translation, where + ".translation");
  }
  if (!(camera.focal[0] > 0) || !(camera.focal[1] > 0)) {
    fail_landmarks(where + ".focal", "a focal length is not above 0", "give pixels");
  }
  return camera;
}

/// A name of the file, or the number of a position.
MienSolvePoint find_point(const PlacedLandmarks& landmarks, const SolvedRig& rig,
                          const std::string& name, const std::string& where) {
  const auto found = landmarks.points.find(name);
  if (found != landmarks.points.end()) return found->second;
  uint32_t number = 0;
  const auto [stop, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error == std::errc() && stop == name.data() + name.size()) {
    return read_point(number, landmarks, rig, where);
  }
  std::vector<std::string> known;
  for (const auto& [other, point] : landmarks.points) known.push_back(other);
  fail_landmarks(where, "no point is named \"" + one_line(name) + "\"",
                 known.empty() ? "say where it is with --landmarks FILE, or name it by the number "
                                 "of its position: 1234.x"
                               : nearest_question(name, known, kLandmarksExample));
}

}  // namespace

bool knows_rotation(const MienFitCamera& camera) {
  return std::any_of(camera.rotation, camera.rotation + 9, [](float v) { return v != 0; });
}

PlacedLandmarks read_places(const TargetOptions& options, const SolvedRig& rig) {
  PlacedLandmarks out;
  LandmarkJson document = LandmarkJson::object();
  if (!options.landmarks.empty()) {
    out.shown = shown_name(options.landmarks);
    document = parse_json<LandmarkJson>(read_json(options.landmarks, kWhatLandmarks),
                                        kWhatLandmarks, out.shown, kLandmarksExample);
  }
  std::string mesh = options.mesh;
  for (const auto& [key, value] : document.items()) {
    if (key == "mesh" && value.is_string()) {
      if (mesh.empty()) mesh = value.get<std::string>();
    } else if (key != "points" && key != "camera") {
      fail_landmarks(out.shown + ", " + one_line(key), "this is unknown, or not a name",
                     nearest_question(key, {"mesh", "points", "camera"}, kLandmarksExample));
    }
  }
  out.mesh = find_mesh(rig, mesh);
  out.position_count = mesh_of(rig, out.mesh).position_count;
  const LandmarkJson points = document.value("points", LandmarkJson::object());
  if (!points.is_object()) fail_landmarks(out.shown + ", points", "it is not an object");
  for (const auto& [name, value] : points.items()) {
    out.points[name] = read_point(value, out, rig, out.shown + ", points." + one_line(name));
  }
  if (document.contains("camera")) {
    out.camera = read_camera(document["camera"], out.shown + ", camera");
  }
  return out;
}

LandmarkTable read_landmark_table(const std::string& path, bool images) {
  LandmarkTable table;
  table.take = parse_csv_take(read_text(path, "cannot read target"), shown_name(path), true);
  const std::vector<std::string> axes =
      images ? std::vector<std::string>{".x", ".y"} : std::vector<std::string>{".x", ".y", ".z"};
  const std::vector<std::string>& columns = table.take.names;
  for (size_t c = 0; c < columns.size(); c += axes.size()) {
    const std::string& first = columns[c];
    const std::string name = ends_with(first, ".x") ? first.substr(0, first.size() - 2) : first;
    for (size_t k = 0; k < axes.size(); ++k) {
      if (c + k < columns.size() && columns[c + k] == name + axes[k]) continue;
      fail(kInvalid, "cannot solve", table.take.shown + ", column " + std::to_string(c + k + 2),
           "a column " + one_line(name) + axes[k] + " is missing there",
           images ? "the header is time,NAME.x,NAME.y,..."
                  : "the header is time,NAME.x,NAME.y,NAME.z,...");
    }
    table.names.push_back(name);
  }
  if (table.names.empty()) {
    fail(kInvalid, "cannot solve", table.take.shown, "it has no landmarks",
         "the header is time,NAME.x,NAME.y,...");
  }
  return table;
}

SolveTarget read_landmarks(const TargetOptions& options, bool images, const SolvedRig& rig) {
  const PlacedLandmarks landmarks = read_places(options, rig);
  const auto table =
      std::make_shared<const LandmarkTable>(read_landmark_table(options.path, images));
  SolveTarget target;
  for (const std::string& name : table->names) {
    target.points.push_back(find_point(landmarks, rig, name, table->take.shown));
  }
  target.point_names = table->names;
  if (images && !landmarks.camera) {
    fail(kInvalid, "cannot solve", options.landmarks.empty() ? table->take.shown : landmarks.shown,
         "there is no camera for landmarks in images",
         "add \"camera\": {\"focal\": [fx, fy], \"center\": [cx, cy]} to --landmarks FILE");
  }
  target.camera = landmarks.camera;
  target.rate = find_rate(table->take.times);
  target.frame_count = table->take.row_count;
  target.width = table->take.names.size();
  target.read = [table](size_t frame, float* row) {
    const size_t width = table->take.names.size();
    std::copy_n(table->take.values.data() + frame * width, width, row);
  };
  return target;
}

}  // namespace mien::cli
