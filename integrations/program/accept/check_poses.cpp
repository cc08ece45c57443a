// SPDX-License-Identifier: MIT
#include "integrations/program/accept/check_poses.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "integrations/program/accept/check_deform.h"
#include "integrations/program/io/controls.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/json_check.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

using json = nlohmann::json;
using math::Matrix;
using math::Quaternion;
using math::Vec3d;

constexpr char kCannotUsePoses[] = "cannot use poses";
constexpr char kExample[] =
    R"(write {"unit": "cm", "poses": [{"controls": {"jawOpen": 1}, "joints": {"FACIAL_C_Jaw": )"
    R"({"translation": [0, 1, 2]}}}]})";

[[noreturn]] void wrong(const std::string& where, const std::string& why) {
  fail(kInvalid, kCannotUsePoses, where, why, kExample);
}

void refuse_other_keys(const json& object, const std::string& where,
                       std::initializer_list<const char*> known) {
  if (!object.is_object()) wrong(where, "expected an object");
  for (const auto& [key, value] : object.items()) {
    const bool is_known = std::any_of(known.begin(), known.end(),
                                      [&, name = key](const char* other) { return name == other; });
    if (!is_known) wrong(where, "unknown key \"" + one_line(key) + "\"");
  }
}

std::vector<double> numbers(const json& array, size_t count, const std::string& where) {
  std::vector<double> values;
  if (array.is_array()) {
    for (const json& value : array) {
      if (value.is_number() && std::isfinite(value.get<double>())) values.push_back(value);
    }
  }
  if (!array.is_array() || values.size() != count || array.size() != count) {
    wrong(where, "expected " + std::to_string(count) + " numbers");
  }
  return values;
}

/// What the unit of the poses is in the unit of the file.
double unit_of(const json& document, const std::string& shown, const MienDnaInfo& info) {
  const std::string word = document.value("unit", json("cm")).is_string()
                               ? document.value("unit", std::string("cm"))
                               : std::string();
  const double meters = word == "cm" ? 0.01 : word == "mm" ? 0.001 : word == "m" ? 1 : 0;
  if (meters == 0) wrong(shown + ", unit", "the unit is not cm, mm or m");
  return meters / (info.translation_unit == MIEN_TRANSLATION_UNIT_METERS ? 1 : 0.01);
}

/// The file in the axes of the poses; `system` outlives it.
RigFile open_in_system(const json& document, const std::string& shown, const std::string& rig,
                       MienCoordinateSystem& system, const Session& session) {
  auto desc = sized<MienDnaDesc>();
  desc.layers = kEvaluationLayers | MIEN_LAYER_GEOMETRY;
  desc.skip_blend_shape_targets = 1;
  if (document.contains("system")) {
    const json& name = document["system"];
    system = sized<MienCoordinateSystem>();
    const std::string word = name.is_string() ? name.get<std::string>() : "";
    if (mien_coordinate_system_find(word.c_str(), &system) != MIEN_OK) {
      fail(kInvalid, kCannotUsePoses, shown + ", system",
           "no coordinate system is named \"" + one_line(word) + "\"",
           "leave it out for the axes of the file; 'mien convert --help' lists the names");
    }
    desc.system = &system;
  }
  return open_rig_file(rig, desc, session);
}

uint32_t find_joint(const MienRig* rig, const std::string& name, const std::string& where) {
  uint32_t joint = 0;
  if (mien_rig_find_n(rig, MIEN_KIND_JOINT, name.data(), name.size(), &joint) == MIEN_OK) {
    return joint;
  }
  NearestName nearest(name);
  for (uint32_t j = 0; j < rig_count(rig, MIEN_KIND_JOINT); ++j) {
    nearest.offer(rig_name(rig, MIEN_KIND_JOINT, j));
  }
  fail(kInvalid, kCannotUsePoses, where, "no joint is named \"" + one_line(name) + "\"",
       nearest.question("'mien info RIG --names joints' lists the names"));
}

Frame frame_of(const json& pose, const MienRig* rig, const std::string& where) {
  Frame frame;
  if (!pose.contains("controls")) return frame;
  const json& controls = pose["controls"];
  if (!controls.is_object()) wrong(where + ", controls", "expected an object");
  for (const auto& [name, value] : controls.items()) {
    if (!value.is_number()) wrong(where + ", controls." + one_line(name), "expected a number");
    const Control control = find_control(rig, name, kCannotUsePoses, where);
    const bool gui = control.kind == MIEN_KIND_GUI_CONTROL;
    (gui ? frame.gui : frame.raw).push_back({control.index, value.get<float>()});
    frame.maps_gui |= gui;
  }
  return frame;
}

/// Degrees between a rotation and the axes of a matrix, whose lengths are scales.
double degrees_between(const Matrix& matrix, const std::vector<double>& xyzw) {
  const Matrix turn =
      math::matrix_of({{}, normalized(Quaternion{xyzw[0], xyzw[1], xyzw[2], xyzw[3]}), {1, 1, 1}});
  double trace = 0;
  for (int c = 0; c < 3; ++c) {
    double product = 0, squared = 0;
    for (int r = 0; r < 3; ++r) {
      product += turn.m[r][c] * matrix.m[r][c];
      squared += matrix.m[r][c] * matrix.m[r][c];
    }
    trace += product / std::sqrt(squared);
  }
  return std::acos(std::clamp((trace - 1) / 2, -1.0, 1.0)) * 180 / 3.14159265358979323846;
}

/// The largest and the mean distance of the joints of one pose.
struct Off {
  double worst = 0, sum = 0;
  size_t count = 0;
  uint32_t joint = 0;

  void see(double distance, uint32_t of) {
    sum += distance;
    ++count;
    if (distance <= worst) return;
    worst = distance;
    joint = of;
  }
};

class PoseChecker {
 public:
  PoseChecker(const PoseOptions& options, const json& document, const Session& session)
      : options_(options), shown_(shown_name(options.poses)),
        file_(open_in_system(document, shown_, options.rig, system_, session)),
        rig_(create_rig(file_, sized<MienRigDesc>())),
        unit_(unit_of(document, shown_, file_.info)) {
    auto error = sized<MienError>();
    MienDeformer* deformer = nullptr;
    check(mien_deformer_create(file_.dna.get(), rig_.get(), nullptr, &deformer, &error), &error,
          "cannot pose joints", file_.shown);
    deformer_.reset(deformer);
    MienDeformerInstance* pose = nullptr;
    check(mien_deformer_instance_create(deformer, nullptr, &pose, &error), &error,
          "cannot pose joints", file_.shown);
    pose_.reset(pose);
  }

  Check check_pose(const json& pose, size_t number) {
    const std::string where = shown_ + ", poses[" + std::to_string(number) + "]";
    refuse_other_keys(pose, where, {"name", "controls", "joints", "lod"});
    uint32_t lod = 0;
    if (pose.contains("lod")) {
      if (!pose["lod"].is_number_unsigned() || pose["lod"] >= file_.info.lod_count) {
        wrong(where + ", lod", "the file has no such LOD");
      }
      lod = pose["lod"];
    }
    MienInstance* made = nullptr;
    check(mien_instance_create(rig_.get(), nullptr, &made, nullptr), nullptr, kCannotUsePoses,
          shown_);
    const Instance instance(made);
    apply_frame(frame_of(pose, rig_.get(), where), rig_.get(), made);
    check(mien_rig_evaluate(rig_.get(), made, lod), nullptr, kCannotUsePoses, shown_);
    check(mien_deformer_instance_update(pose_.get(), made), nullptr, kCannotUsePoses, shown_);
    const std::vector<Matrix> matrices = joint_matrices(rig_.get(), pose_.get());

    if (!pose.contains("joints") || !pose["joints"].is_object() || pose["joints"].empty()) {
      wrong(where + ", joints", "expected an object of joints");
    }
    Off moved, turned;
    for (const auto& [name, value] : pose["joints"].items()) {
      const std::string at = where + ", joints." + one_line(name);
      const uint32_t joint = find_joint(rig_.get(), name, at);
      refuse_other_keys(value, at, {"translation", "rotation"});
      if (!value.contains("translation")) wrong(at, "expected a translation");
      const std::vector<double> t = numbers(value["translation"], 3, at + ".translation");
      const Matrix& m = matrices[joint];
      moved.see(
          length(Vec3d{t[0], t[1], t[2]} * unit_ - Vec3d{m.m[0][3], m.m[1][3], m.m[2][3]}) / unit_,
          joint);
      if (!value.contains("rotation")) continue;
      turned.see(degrees_between(m, numbers(value["rotation"], 4, at + ".rotation")), joint);
    }
    Check result{"pose " + std::to_string(number), true, false, ""};
    result.passed = moved.worst <= options_.length && turned.worst <= options_.degrees;
    result.detail = std::to_string(moved.count) + " joints: off by " + short_number(moved.worst) +
                    " at most, " + short_number(moved.sum / double(moved.count)) + " on average" +
                    worst_joint(moved);
    if (turned.count != 0) {
      result.detail +=
          "; turned by " + short_number(turned.worst) + " degrees at most" + worst_joint(turned);
    }
    return result;
  }

 private:
  std::string worst_joint(const Off& off) const {
    if (off.worst == 0) return "";
    return " (joint " + std::to_string(off.joint) +
           (options_.names ? ", " + one_line(rig_name(rig_.get(), MIEN_KIND_JOINT, off.joint))
                           : "") +
           ")";
  }

  const PoseOptions& options_;
  std::string shown_;
  MienCoordinateSystem system_{};
  RigFile file_;
  Rig rig_;
  double unit_;
  Deformer deformer_;
  DeformerInstance pose_;
};

}  // namespace

std::vector<Check> check_poses(const PoseOptions& options, const Session& session) {
  const std::string shown = shown_name(options.poses);
  const json document =
      parse_json<json>(read_json(options.poses, kCannotUsePoses), kCannotUsePoses, shown, kExample);
  refuse_other_keys(document, shown, {"unit", "system", "poses"});
  if (!document.contains("poses") || !document["poses"].is_array() || document["poses"].empty()) {
    wrong(shown + ", poses", "expected an array of poses");
  }
  PoseChecker checker(options, document, session);
  std::vector<Check> checks;
  Progress progress(session, "pose", document["poses"].size());
  for (const json& pose : document["poses"]) {
    progress.at(checks.size());
    checks.push_back(checker.check_pose(pose, checks.size()));
  }
  return checks;
}

}  // namespace mien::cli
