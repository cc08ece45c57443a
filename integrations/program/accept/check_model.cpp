// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "integrations/program/accept/check_results.h"
#include "integrations/program/model/ml_model.h"
#include "integrations/program/model/rbf_model.h"
#include "integrations/program/model/rotation_model.h"

namespace mien::cli {

namespace {

// The loss of precision that floats may cause, as in docs/rig-evaluation.md, 10. In angular RBF solvers,
// the distance of equal rotations is mostly rounding, and solvers whose poses nearly coincide magnify it, in the
// library as well. What a noise changes depends on its signs, so the largest change of several counts.
constexpr double kNoise = 0x1p-22, kNoiseMargin = 32;
constexpr uint32_t kNoises = 16;
constexpr double kLearned = 1e-4, kRbf = 5e-4, kWeights = 1e-5;
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

/// Controls that the model gives, with those of networks and RBF solvers.
struct Expected {
  std::vector<double> controls;
  std::vector<double> unsure;  // how far rounding in RBF solvers may move each
};

/// Of a new instance; all masks are 1.
Expected expected_controls(const model::LayerRig& rig, const std::vector<float>& raw,
                           uint32_t lod) {
  std::vector<double> start = model::initial_controls(rig);
  std::copy(raw.begin(), raw.end(), start.begin());
  model::model_ml(rig, lod, std::vector<double>(rig.regions.size(), 1.0), false, start);
  Expected expected{start, std::vector<double>(start.size())};
  if (rig.rbf_count == 0) return expected;
  model::model_rbf(rig, lod, expected.controls);
  for (uint32_t n = 0; n < kNoises; ++n) {
    // The margin times what noise does, and what noise times the margin does: that crosses clamps and thresholds.
    for (const double times : {1.0, kNoiseMargin}) {
      const double noise = kNoise * (n % 2 == 0 ? times : -times);
      std::vector<double> with = start;
      model::model_rbf(rig, lod, with, {noise, n});
      for (size_t i = 0; i < with.size(); ++i) {
        const double change = std::fabs(with[i] - expected.controls[i]);
        expected.unsure[i] = std::max(expected.unsure[i], change * kNoiseMargin / times);
      }
    }
  }
  return expected;
}

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
void compare_controls(const model::LayerRig& rig, const std::vector<float>& mine,
                      const Expected& expected, const Place& at, Worst& worst) {
  const double scale = largest(expected.controls);
  for (size_t i = rig.first_ml(); i < mine.size(); ++i) {
    const bool learned = i < rig.first_rbf();
    const double distance = std::fabs(mine[i] - expected.controls[i]);
    if (!(distance >= 0)) worst.see_nan("control", i, at.lod, at.pose);
    const double allowed = learned ? kLearned * scale : kRbf * scale + expected.unsure[i];
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
      const Expected expected = expected_controls(rig.model, rig.poses[p], lod);
      for (size_t o = 0; o < 2; ++o) {
        std::map<bool, std::pair<size_t, Results>> first_of_family;
        for (size_t i = 0; i < isas.size(); ++i) {
          const Results mine = evaluate_fresh(rigs[i][o].get(), rig.poses[p], lod);
          compare_controls(rig.model, mine.controls, expected, at, worst[i]);
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
