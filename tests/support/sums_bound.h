// SPDX-License-Identifier: MIT
// How far joint values of MIEN_REUSE_SUMS may be from those of a full evaluation (mien/rig.h), for what an
// instance has evaluated.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/rig_handles.h"

namespace mien {

class SumsBound {
 public:
  /// To be called after each evaluation. `joints`: it included them.
  void note(const Character& c, bool joints) {
    const Rig& rig = *capi::object(c.rig);
    const Instance& instance = *capi::object(c.instance.get());
    const std::vector<double> now = magnitudes(rig, instance);
    double active = 0;
    for (const float control : instance.controls) active += control != 0.0f;
    const Changes& changes = *instance.changes;
    const bool anew =
        joints && changes.roundings == 0 && (changes.all & uint32_t{kStageJoints}) == 0;
    if (anew || largest_.empty()) {
      largest_ = now;
      active_ = active;
      return;
    }
    for (size_t i = 0; i < now.size(); ++i) largest_[i] = std::max(largest_[i], now[i]);
    active_ = std::max(active_, active);
  }

  /// Fails the test if a joint value of `kept` is farther from that of `full`. Returns the largest
  /// difference as a share of its bound.
  double expect_within(const Character& kept, const Character& full) const {
    const Rig& rig = *capi::object(kept.rig);
    double worst = 0;
    for (uint32_t j = 0; j < rig.joint_count; ++j) {
      for (uint32_t a = 0; a < rig.joint_attributes; ++a) {
        const size_t i = size_t{j} * rig.joint_attributes + a;
        const double x = kept.joints[i], y = full.joints[i];
        const double limit = limit_of(rig, j, a);
        double difference = std::fabs(x - y);
        if (is_turn(rig, a)) difference = std::min(difference, std::fabs(x + y));
        if (difference <= limit) {
          if (limit > 0) worst = std::max(worst, difference / limit);
          continue;
        }
        ADD_FAILURE() << "joint " << j << ", value " << a << " is " << x << ", in full " << y
                      << ", bound " << limit;
        return worst;
      }
    }
    return worst;
  }

 private:
  static bool is_turn(const Rig& rig, uint32_t attribute) {
    return rig.quaternion_outputs && attribute >= 3 && attribute < 7;
  }

  double bound(size_t output) const {
    if (largest_.empty()) return 0;  // nothing was evaluated
    // Where products overflow or are NaN, sums saturate at once or later.
    if (!(largest_[output] <= 1e38)) return std::numeric_limits<double>::infinity();
    return (active_ + 1539) * std::ldexp(1.0, -23) * largest_[output];
  }

  double limit_of(const Rig& rig, uint32_t joint, uint32_t attribute) const {
    const double added = rig.ml.joints.empty() ? 0 : 1e-6;  // rounding after ML joints are added
    const size_t first = size_t{joint} * rig.joint_attributes;
    if (!is_turn(rig, attribute)) {
      const double limit = bound(first + attribute);
      return limit == 0 ? added : limit + added + 1e-40;
    }
    double angles = added;
    for (uint32_t k = 0; k < 3; ++k) {
      angles += bound(rig.joint_value_count() + size_t{joint} * 3 + k) * rig.rotation.to_radians;
    }
    if (angles == 0) return 0;
    return angles > 0.1 ? 2 : angles + 1e-6;
  }

  /// Calls f(packed row, joint value or angle) for the rows that a LOD writes, in the order of evaluation.
  template <class F>
  static void for_each_target(const Rig& rig, uint32_t lod, F&& f) {
    const JointMatrix& joints = rig.joints;
    for (uint32_t c = 0; c < joints.panels_at_lod[lod]; ++c) {
      const size_t first_row = size_t{joints.panels[c].first_block_row} * kJointBlockRows;
      const JointTarget* target = joints.targets.data + joints.panels[c].first_target;
      for (uint32_t kind = 0; kind < kTargetKinds; ++kind) {
        const uint16_t* const at_lod =
            joints.targets_at_lod.data + (size_t{c} * kTargetKinds + kind) * rig.lod_count;
        for (uint32_t t = 0; t < at_lod[lod]; ++t) {
          for (uint32_t r = 0; r < kTargetRows[kind]; ++r) {
            f(first_row + target[t].packed_row + r, target[t].output + r);
          }
        }
        target += at_lod[0];
      }
    }
  }

  /// [joint value or angle] the sum of the magnitudes of its products.
  static std::vector<double> magnitudes(const Rig& rig, const Instance& instance) {
    const JointMatrix& joints = rig.joints;
    const uint32_t panels = joints.panels_at_lod[instance.lod];
    std::vector<double> rows(size_t{joints.panels[panels].first_block_row} * kJointBlockRows);
    for (size_t k = 0; k < joints.columns.count; ++k) {
      const double control = std::fabs(double{instance.controls[joints.columns[k]]});
      if (control == 0) continue;
      joints.for_each_block(k, panels, [&](uint32_t block, uint32_t block_row) {
        for (uint32_t r = 0; r < kJointBlockRows; ++r) {
          const size_t at = size_t{block} * kJointBlockRows + r;
          const size_t row = size_t{block_row} * kJointBlockRows + r;
          const double value = joints.values.empty()
                                   ? double{joints.scales[row]} * joints.fixed_values[at]
                                   : double{joints.values[at]};
          rows[row] += std::fabs(value) * control;
        }
      });
    }
    std::vector<double> of_outputs(joints_and_angles_count(rig) + 1);
    for_each_target(rig, instance.lod,
                    [&](size_t row, size_t output) { of_outputs[output] = rows[row]; });
    return of_outputs;
  }

  std::vector<double> largest_;
  double active_ = 0;
};

}  // namespace mien
