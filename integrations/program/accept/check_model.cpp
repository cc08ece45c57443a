// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "integrations/program/accept/check_results.h"
#include "integrations/program/model/evaluate_model.h"

namespace mien::cli {

namespace {

// The loss of precision that floats may cause, as in docs/rig-evaluation.md, 10. In angular RBF solvers,
// the distance of equal rotations is mostly rounding.
constexpr double kNoise = 0x1p-22, kNoiseMargin = 32;
constexpr double kLearned = 1e-4, kRbf = 2e-3, kWeights = 1e-5;
constexpr double kLength = 1e-5;  // of translations and scales, and of the largest of the pose
constexpr double kRadians = 1e-4;

/// The largest distance found, and where.
struct Worst {
  double off = 0;  // in units of what is allowed
  double distance = 0;
  std::string where;

  void see(double distance_found, double allowed, const char* what, size_t index, uint32_t lod,
           size_t pose) {
    const double share = distance_found / allowed;
    if (share <= off) return;
    off = share;
    distance = distance_found;
    where = std::string(what) + " " + std::to_string(index) + " at LOD " + std::to_string(lod) +
            " in pose " + std::to_string(pose);
  }
  void see_nan(const char* what, size_t index, uint32_t lod, size_t pose) {
    see(HUGE_VAL, 1, what, index, lod, pose);
  }
};

double largest(const std::vector<double>& values) {
  double most = 1;
  for (const double value : values) most = std::max(most, std::fabs(value));
  return most;
}

struct Place {
  uint32_t lod;
  size_t pose;
};

void compare_weights(const std::vector<float>& mine, const std::vector<double>& expected,
                     const char* what, const Place& at, Worst& worst) {
  const double allowed = kWeights * largest(expected);
  for (size_t i = 0; i < mine.size() && i < expected.size(); ++i) {
    const double distance = std::fabs(mine[i] - expected[i]);
    if (!(distance >= 0)) worst.see_nan(what, i, at.lod, at.pose);
    worst.see(distance, allowed, what, i, at.lod, at.pose);
  }
}

/// ML and RBF controls; the stages after them are compared with the controls of the library, so that each
/// stage answers for itself.
/// `up` and `down` are the controls of the model with kNoise in the distances of RBF solvers. Solvers whose poses
/// nearly coincide magnify it, in the library as well.
void compare_controls(const model::LayerRig& rig, const std::vector<float>& mine,
                      const std::vector<double>& expected, const std::vector<double>& up,
                      const std::vector<double>& down, const Place& at, Worst& worst) {
  const double scale = largest(expected);
  for (size_t i = rig.first_ml(); i < mine.size(); ++i) {
    const bool learned = i < rig.first_rbf();
    const double distance = std::fabs(mine[i] - expected[i]);
    if (!(distance >= 0)) worst.see_nan("control", i, at.lod, at.pose);
    const double allowed =
        learned ? kLearned * scale
                : kRbf * scale + kNoiseMargin * std::max(std::fabs(up[i] - expected[i]),
                                                         std::fabs(down[i] - expected[i]));
    worst.see(distance, allowed, "control", i, at.lod, at.pose);
  }
}

/// Correctives that something of the LOD uses, from the controls that they read.
void compare_psds(const model::LayerRig& rig, const std::vector<float>& mine,
                  const std::vector<double>& expected, const std::vector<uint8_t>& needed,
                  const Place& at, Worst& worst) {
  for (size_t p = 0; p < needed.size(); ++p) {
    if (!needed[p]) continue;
    const size_t i = rig.base.raw_count + p;
    const double distance = std::fabs(mine[i] - expected[i]);
    if (!(distance >= 0)) worst.see_nan("corrective", p, at.lod, at.pose);
    worst.see(distance, kWeights * std::max(1.0, std::fabs(expected[i])), "corrective", p, at.lod,
              at.pose);
  }
}

void compare_joints(const model::LayerRig& rig, const std::vector<float>& mine, bool quaternions,
                    const std::vector<double>& controls, const Place& at, Worst& worst) {
  const std::vector<model::ModelJoint> expected =
      model::model_joints(rig, controls, at.lod, quaternions);
  const std::vector<model::ModelJoint> found =
      model::joints_of(rig, mine.data(), mine.size(), quaternions);
  double longest = 1;
  for (const model::ModelJoint& joint : expected) {
    for (size_t i = 0; i < 3; ++i) {
      longest = std::max({longest, std::fabs(joint.translation[i]), std::fabs(joint.scale[i])});
    }
  }
  for (size_t j = 0; j < found.size(); ++j) {
    const double turn = model::angle_between(found[j].rotation, expected[j].rotation);
    if (!(turn >= 0)) worst.see_nan("rotation of joint", j, at.lod, at.pose);
    worst.see(turn, kRadians, "rotation of joint", j, at.lod, at.pose);
    for (size_t i = 0; i < 3; ++i) {
      const double moved = std::fabs(found[j].translation[i] - expected[j].translation[i]);
      const double scaled = std::fabs(found[j].scale[i] - expected[j].scale[i]);
      if (!(moved >= 0) || !(scaled >= 0)) worst.see_nan("joint", j, at.lod, at.pose);
      worst.see(moved, kLength * longest, "translation of joint", j, at.lod, at.pose);
      worst.see(scaled, kLength * longest, "scale of joint", j, at.lod, at.pose);
    }
  }
}

std::vector<double> doubles(const std::vector<float>& values) {
  return std::vector<double>(values.begin(), values.end());
}

/// Scalar and SSE2 do not fuse multiply and add; the others do.
bool is_fused(uint32_t isa) { return isa != MIEN_ISA_SCALAR && isa != MIEN_ISA_SSE2; }

}  // namespace

std::vector<Check> check_model(const AcceptedRig& rig, const Session& session) {
  const std::vector<uint32_t> isas = present_isas();
  const uint32_t outputs[] = {MIEN_ROTATION_OUTPUT_EULER, MIEN_ROTATION_OUTPUT_QUATERNION};
  std::vector<Worst> worst(isas.size());
  std::vector<std::array<Rig, 2>> rigs(isas.size());
  for (size_t i = 0; i < isas.size(); ++i) {
    for (size_t o = 0; o < 2; ++o) rigs[i][o] = create_rig(rig, isas[i], outputs[o]);
  }
  std::string unequal;
  Progress progress(session, "comparing with the model", rig.lod_count() * rig.poses.size());
  for (uint32_t lod = 0; lod < rig.lod_count(); ++lod) {
    const std::vector<uint8_t> needed = model::needed_psds(rig.model.base, lod);
    for (size_t p = 0; p < rig.poses.size(); ++p) {
      progress.at(lod * rig.poses.size() + p);
      const Place at = {lod, p};
      const std::vector<double> expected = model::evaluate_controls(rig.model, rig.poses[p], lod);
      const std::vector<double> up = model::evaluate_controls(rig.model, rig.poses[p], lod, kNoise);
      const std::vector<double> down =
          model::evaluate_controls(rig.model, rig.poses[p], lod, -kNoise);
      for (size_t o = 0; o < 2; ++o) {
        std::map<bool, std::pair<size_t, Results>> first_of_family;
        for (size_t i = 0; i < isas.size(); ++i) {
          const Results mine = evaluate_fresh(rigs[i][o].get(), rig.poses[p], lod);
          compare_controls(rig.model, mine.controls, expected, up, down, at, worst[i]);
          std::vector<double> controls = doubles(mine.controls);
          model::model_psds(rig.model.base, controls);
          compare_psds(rig.model, mine.controls, controls, needed, at, worst[i]);
          compare_joints(rig.model, mine.joints, o == 1, controls, at, worst[i]);
          compare_weights(mine.channels, model::plain_channels(rig.model.base, controls, lod),
                          "blend shape channel", at, worst[i]);
          compare_weights(mine.maps, model::plain_maps(rig.model.base, controls, lod),
                          "animated map", at, worst[i]);
          const auto [first, is_first] = first_of_family.try_emplace(is_fused(isas[i]), i, mine);
          if (!is_first && unequal.empty() && !same_bits(mine, first->second.second)) {
            unequal = std::string(mien_isa_name(isas[first->second.first])) + " and " +
                      mien_isa_name(isas[i]) + " differ at LOD " + std::to_string(lod) +
                      " in pose " + std::to_string(p);
          }
        }
      }
    }
  }
  std::vector<Check> checks;
  const std::string extent =
      std::to_string(rig.poses.size()) + " poses at " + std::to_string(rig.lod_count()) + " LODs";
  for (size_t i = 0; i < isas.size(); ++i) {
    Check check{std::string("double precision, ") + mien_isa_name(isas[i]), worst[i].off <= 1,
                false, ""};
    check.detail = extent + ", angles and quaternions: ";
    check.detail += worst[i].off == 0
                        ? "no difference"
                        : short_number(100 * worst[i].off) + " % of what rounding may do, in " +
                              worst[i].where + ", off by " + short_number(worst[i].distance);
    checks.push_back(check);
  }
  Check equal{"instruction sets", unequal.empty(), false, ""};
  equal.detail = !unequal.empty() ? unequal
                                  : extent + ": the same bits within each family of the " +
                                        std::to_string(isas.size()) + " instruction sets";
  checks.push_back(equal);
  return checks;
}

}  // namespace mien::cli
