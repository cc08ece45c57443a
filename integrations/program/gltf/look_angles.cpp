// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "integrations/program/gltf/vrm.h"
#include "integrations/program/io/joint_names.h"

namespace mien::gltf {

namespace {

using math::Matrix;

/// The character with these controls added to the initial ones.
void pose(const RigSource& source, MienInstance* instance, MienDeformerInstance* pose,
          const std::vector<ControlValue>& values) {
  MienMutableFloatView raw{};
  check(mien_instance_reset(instance), "cannot measure looks");
  check(mien_instance_raw_controls(instance, &raw), "cannot measure looks");
  for (const ControlValue& of : values) raw.data[of.control] += of.value;
  check(mien_rig_evaluate(source.rig(), instance, 0), "cannot measure looks");
  check(mien_deformer_instance_update(pose, instance), "cannot measure looks");
}

/// Model matrices, 16 floats for each joint, column by column.
std::vector<float> matrices(const MienDeformerInstance* pose) {
  MienFloatView view{};
  check(mien_deformer_instance_joint_matrices(pose, &view), "cannot measure looks");
  return std::vector<float>(view.data, view.data + view.count);
}

/// Degrees between the axes of a joint in two poses; scale does not count.
double degrees_between(const float* a, const float* b) {
  double trace = 0;
  for (int column = 0; column < 3; ++column) {
    double product = 0, aa = 0, bb = 0;
    for (int row = 0; row < 3; ++row) {
      const double x = a[4 * column + row], y = b[4 * column + row];
      product += x * y;
      aa += x * x;
      bb += y * y;
    }
    trace += product / std::sqrt(aa * bb);
  }
  return std::acos(std::clamp((trace - 1) / 2, -1.0, 1.0)) * 180 / 3.14159265358979323846;
}

constexpr double kLeastDegrees = 1;

}  // namespace

LookAngles measure_looks(const RigSource& source, const RigExpressions& expressions) {
  MienInstance* made = nullptr;
  auto error = sized<MienError>();
  const MienStatus status = mien_instance_create(source.rig(), nullptr, &made, &error);
  if (status != MIEN_OK) throw ExportError(status, "", error.message, "");
  const cli::Instance instance(made);
  const cli::DeformerInstance deformer = make_deformer_instance(source);
  pose(source, made, deformer.get(), {});
  const std::vector<float> neutral = matrices(deformer.get());
  const auto degrees = [&](const char* name) {
    const size_t e = expressions.find(name);
    if (e == expressions.expressions.size()) return 0.0;
    pose(source, made, deformer.get(), expressions.expressions[e].plus);
    const std::vector<float> turned = matrices(deformer.get());
    double most = 0;
    for (uint32_t j = 0; j < source.count(MIEN_KIND_JOINT); ++j) {
      const std::string joint = source.name(MIEN_KIND_JOINT, j);
      if (!cli::is_body_part(joint, {"eye", "eyeball", "lefteye", "righteye"})) continue;
      most = std::max(most, degrees_between(&neutral[size_t{16} * j], &turned[size_t{16} * j]));
    }
    return most < kLeastDegrees ? 0.0 : most;
  };
  const double left = degrees("lookLeft"), right = degrees("lookRight");
  return {std::min(left, right), degrees("lookDown"), degrees("lookUp")};
}

}  // namespace mien::gltf
