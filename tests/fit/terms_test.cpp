// SPDX-License-Identifier: MIT
// The terms beside the data: prior, smooth, sparse and symmetric. On a rig whose joint values are linear in its controls
// the minimum has a closed form; with vertices it is compared with its neighbors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/fit/fit_head.h"

namespace mien {
namespace {

using Doubles = std::vector<double>;

/// Joint values = columns * raw controls.
struct Linear {
  std::vector<Doubles> columns;  // [control][joint value]
  RigHandle rig;
  Floats targets;

  /// The last control has no effect, and the first two have the same one.
  explicit Linear(uint64_t seed, uint16_t control_count = 6) {
    Random random = Random::from_seed(seed, 1);
    PlainRig plain;
    plain.raw_count = control_count;
    plain.joint_count = 2;
    PlainGroup group;
    group.lods = {18};
    columns.assign(control_count, Doubles(18));
    for (uint16_t c = 0; c < control_count; ++c) group.inputs.push_back(c);
    for (uint16_t row = 0; row < 18; ++row) {
      group.outputs.push_back(row);
      for (size_t c = 0; c < control_count; ++c) {
        const double value = static_cast<int>(random.below(33)) / 8.0 - 2;
        columns[c][row] = c + 1 == control_count ? 0 : c == 1 ? columns[0][row] : value;
        group.values.push_back(static_cast<float>(columns[c][row]));
      }
    }
    plain.groups = {group};
    rig = make_rig(plain);
  }
  size_t count() const { return columns.size(); }

  /// What these controls give, and noise that no controls give.
  void aim_at(const Doubles& controls, double noise) {
    Random random = Random::from_seed(7, 7);
    targets.assign(18, 0);
    for (size_t j = 0; j < 18; ++j) {
      double sum = random.between(-noise, noise);
      for (size_t c = 0; c < count(); ++c) sum += columns[c][j] * controls[c];
      targets[j] = static_cast<float>(sum);
    }
  }
  /// Half the gradient of the data, and its cost.
  Doubles pull(const Doubles& x, double& cost) const {
    Doubles out(count());
    for (size_t j = 0; j < 18; ++j) {
      double r = -double{targets[j]};
      for (size_t c = 0; c < count(); ++c) r += columns[c][j] * x[c];
      cost += r * r;
      for (size_t c = 0; c < count(); ++c) out[c] += columns[c][j] * r;
    }
    return out;
  }
  double product(size_t a, size_t b) const {
    double sum = 0;
    for (size_t j = 0; j < 18; ++j) sum += columns[a][j] * columns[b][j];
    return sum;
  }
};

/// x of matrix x = right, by elimination.
Doubles solve_linear(std::vector<Doubles> matrix, Doubles right) {
  const size_t n = right.size();
  for (size_t p = 0; p < n; ++p) {
    size_t best = p;
    for (size_t r = p; r < n; ++r) {
      if (std::fabs(matrix[r][p]) > std::fabs(matrix[best][p])) best = r;
    }
    std::swap(matrix[p], matrix[best]);
    std::swap(right[p], right[best]);
    for (size_t r = 0; r < n; ++r) {
      if (r == p) continue;
      const double factor = matrix[r][p] / matrix[p][p];
      for (size_t c = p; c < n; ++c) matrix[r][c] -= factor * matrix[p][c];
      right[r] -= factor * right[p];
    }
  }
  for (size_t p = 0; p < n; ++p) right[p] /= matrix[p][p];
  return right;
}

/// Solved alone and as the only frame of a motion, which takes other steps.
void solve_both(MienFit* fit, const MienFitFrame& frame,
                const std::function<void(const Floats&, const MienFitResult&)>& check) {
  for (const bool motion : {false, true}) {
    SCOPED_TRACE(motion ? "as a motion" : "alone");
    Floats found(64);
    MienFitResult result = mien_fit_result_default();
    ASSERT_EQ(motion ? mien_fit_solve_frames(fit, &frame, 1, found.data(), &result)
                     : mien_fit_solve(fit, &frame, found.data(), &result),
              MIEN_OK);
    EXPECT_EQ(result.status, MIEN_FIT_CONVERGED);
    check(found, result);
  }
}

TEST(Terms, PriorAndSmoothGiveTheMinimumInClosedForm) {
  Linear it(91);
  const FitHandle fit = create_fit(it.rig, sized<MienFitDesc>());
  it.aim_at({0.3, 0.3, 0.4, 0.5, 0.6, 0}, 0.2);
  const Floats prior = {0.5f, 0.25f, 0.5f, 0.5f, 0.5f, 0.7f};
  const Floats start = {0.25f, 0.5f, 0.5f, 0.25f, 0.5f, 0.1f};
  for (const auto& weights : {std::pair{1.0, 0.0}, {10.0, 0.0}, {0.0, 10.0}, {3.0, 6.0}}) {
    const double p = weights.first, s = weights.second;
    MienFitFrame frame = mien_fit_frame_default();
    frame.joints = it.targets.data();
    frame.prior = prior.data();
    frame.start = start.data();
    frame.prior_weight = static_cast<float>(p);
    frame.smooth_weight = static_cast<float>(s);
    // (AᵀA + p + s) x = Aᵀt + p prior + s start
    const double own = double{frame.prior_weight} + frame.smooth_weight;
    double unused = 0;
    Doubles right = it.pull(Doubles(it.count()), unused);
    std::vector<Doubles> matrix(it.count(), Doubles(it.count()));
    for (size_t a = 0; a < it.count(); ++a) {
      for (size_t b = 0; b < it.count(); ++b) matrix[a][b] = it.product(a, b);
      matrix[a][a] += own;
      right[a] = -right[a] + double{frame.prior_weight} * prior[a] +
                 double{frame.smooth_weight} * start[a];
    }
    const Doubles expected = solve_linear(matrix, right);
    solve_both(fit.get(), frame, [&](const Floats& found, const MienFitResult& result) {
      double cost = 0;
      it.pull(expected, cost);
      for (size_t c = 0; c < it.count(); ++c) {
        ASSERT_GT(expected[c], 0.0);
        ASSERT_LT(expected[c], 1.0);
        EXPECT_NEAR(found[c], expected[c], 1e-3) << p << ' ' << s << ", control " << c;
        cost += double{frame.prior_weight} * std::pow(expected[c] - prior[c], 2) +
                double{frame.smooth_weight} * std::pow(expected[c] - start[c], 2);
      }
      EXPECT_NEAR(result.cost, cost, 1e-5 * cost) << p << ' ' << s;
      // What the data does not determine.
      EXPECT_NEAR(found[5], (p * double{prior[5]} + s * double{start[5]}) / (p + s), 1e-5);
    });
  }
}

TEST(Terms, SymmetricPairsShareAnAmbiguousTargetInEqualHalves) {
  Linear it(92);
  const uint32_t pairs[] = {0, 1, 2, 3};
  MienFitDesc desc = sized<MienFitDesc>();
  desc.symmetric = pairs;
  desc.symmetric_count = 4;
  const FitHandle fit = create_fit(it.rig, desc);
  // 0 and 1 do the same, so only their sum is determined. 2 and 3 are, and differ.
  it.aim_at({0.5, 0.125, 0.75, 0.25, 0.5, 0}, 0);
  Floats start = {0.6f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
  MienFitFrame frame = mien_fit_frame_default();
  frame.joints = it.targets.data();
  frame.start = start.data();
  solve_both(fit.get(), frame, [&](const Floats& found, const MienFitResult&) {
    EXPECT_GT(found[0] - found[1], 0.1) << "without a weight, nothing makes them alike";
  });
  for (const float weight : {0.1f, 1.0f, 100.0f}) {
    frame.symmetric_weight = weight;
    std::vector<Doubles> matrix(5, Doubles(5));
    double unused = 0;
    Doubles right = it.pull(Doubles(it.count()), unused);
    right.pop_back();
    for (size_t a = 0; a < 5; ++a) {
      right[a] *= -1;
      for (size_t b = 0; b < 5; ++b) matrix[a][b] = it.product(a, b);
    }
    for (const size_t a : {size_t{0}, size_t{2}}) {
      matrix[a][a] += double{weight};
      matrix[a + 1][a + 1] += double{weight};
      matrix[a][a + 1] -= double{weight};
      matrix[a + 1][a] -= double{weight};
    }
    const Doubles expected = solve_linear(matrix, right);
    EXPECT_NEAR(expected[0], expected[1], 1e-9);
    solve_both(fit.get(), frame, [&](const Floats& found, const MienFitResult& result) {
      EXPECT_NEAR(found[0], found[1], 2e-3) << weight;
      for (size_t c = 0; c < 5; ++c) EXPECT_NEAR(found[c], expected[c], 2e-3) << weight << ' ' << c;
      Doubles x(found.begin(), found.begin() + 6);
      double cost = 0;
      it.pull(x, cost);
      cost += double{weight} * (std::pow(x[0] - x[1], 2) + std::pow(x[2] - x[3], 2));
      EXPECT_NEAR(result.cost, cost, 1e-5 * cost + 1e-7) << weight;
    });
  }
  frame.symmetric_weight = 1e5f;  // far more than the data: the pair that differs is alike, too
  solve_both(fit.get(), frame, [&](const Floats& found, const MienFitResult&) {
    EXPECT_NEAR(found[2], found[3], 1e-3);
  });
  // One of the pair may not move: the other is drawn to where it is.
  const uint32_t moving[] = {1, 2, 3, 4, 5};
  desc.controls = moving;
  desc.control_count = 5;
  const FitHandle held = create_fit(it.rig, desc);
  start[0] = 0.4f;
  solve_both(held.get(), frame, [&](const Floats& found, const MienFitResult&) {
    EXPECT_EQ(found[0], 0.4f);
    EXPECT_NEAR(found[1], 0.4, 1e-3);
  });
}

/// The sum of magnitudes has a kink where a control is initial: there the pull of the data is at most half the weight.
TEST(Terms, SparseGivesTheMinimumOnBothSidesOfItsKink) {
  for (const float low : {0.0f, -1.0f}) {
    for (uint64_t seed = 93; seed < 103; ++seed) {
      SCOPED_TRACE(seed);
      Linear it(seed, 8);
      const Floats lower(it.count(), low);
      MienFitDesc desc = sized<MienFitDesc>();
      desc.lower = lower.data();
      const FitHandle fit = create_fit(it.rig, desc);
      const double side = low < 0 ? -1 : 1;
      it.aim_at({0, 0, 0.4, 0, side * 0.5, 0, side * 0.1, 0}, 1);
      for (const float weight : {0.5f, 5.0f, 20.0f}) {
        MienFitFrame frame = mien_fit_frame_default();
        frame.joints = it.targets.data();
        frame.sparse_weight = weight;
        solve_both(fit.get(), frame, [&](const Floats& found, const MienFitResult& result) {
          const Doubles x(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(it.count()));
          double cost = 0;
          const Doubles pull = it.pull(x, cost);
          for (size_t c = 0; c < it.count(); ++c) {
            cost += double{weight} * std::fabs(x[c]);
            // How far the control would still move: the rest of its pull by what a step of 1 changes.
            const double half = 0.5 * double{weight};
            const bool at_low = found[c] <= low, at_high = found[c] >= 1;
            double rest = x[c] > 0 ? pull[c] + half
                          : x[c] < 0
                              ? pull[c] - half
                              : std::copysign(std::fmax(std::fabs(pull[c]) - half, 0), pull[c]);
            if (at_low) rest = std::fmin(rest, 0);
            if (at_high) rest = std::fmax(rest, 0);
            EXPECT_LE(std::fabs(rest), 3e-3 * (it.product(c, c) + 1))
                << weight << ", from " << low << ", control " << c << " at " << x[c];
          }
          EXPECT_NEAR(result.cost, cost, 1e-5 * cost);
          EXPECT_EQ(x.back(), 0) << "what does nothing stays initial";
        });
      }
    }
  }
}

/// All terms together with vertices, held in place and moved rigidly: no control that is changed alone gives less.
TEST(Terms, OfVerticesGiveLessThanTheirNeighbors) {
  Head head;
  const std::vector<MienSolvePoint> points =
      every(mesh_of(head.deformer.get(), 0).position_count, 11);
  const size_t count = head.character.raw.count;
  Random random = Random::from_seed(94, 1);
  const Floats raw = head.pose(random, 12), prior = head.pose(random, 12),
               start = head.pose(random, 12);
  std::vector<uint32_t> pairs;
  for (uint32_t c = 0; c + 1 < count; c += 2) pairs.insert(pairs.end(), {c, c + 1});
  MienFitDesc desc = sized<MienFitDesc>();
  desc.deformer = head.deformer.get();
  desc.points = points.data();
  desc.point_count = points.size();
  desc.symmetric = pairs.data();
  desc.symmetric_count = pairs.size();
  const Floats lower(count, -1.0f);
  const FitHandle of_one_side = create_fit(head.rig, desc);
  desc.lower = lower.data();
  const FitHandle of_both_sides = create_fit(head.rig, desc);
  const Floats all = head.positions(raw);
  Floats targets;
  for (const MienSolvePoint& point : points) {
    const float* p = all.data() + size_t{point.positions[0]} * 3;
    for (size_t k = 0; k < 3; ++k)
      targets.push_back(p[k] + static_cast<float>(random.between(-0.05, 0.05)));
  }
  MienFitFrame frame = mien_fit_frame_default();
  frame.points = targets.data();
  frame.prior = prior.data();
  frame.start = start.data();
  frame.prior_weight = 0.3f;
  frame.smooth_weight = 0.2f;
  frame.sparse_weight = 0.4f;
  frame.symmetric_weight = 0.5f;
  frame.max_iterations = 200;
  const auto terms = [&](const Floats& x) {
    double sum = 0;
    for (size_t c = 0; c < count; ++c) {
      sum += double{frame.prior_weight} * std::pow(double{x[c]} - prior[c], 2) +
             double{frame.smooth_weight} * std::pow(double{x[c]} - start[c], 2) +
             double{frame.sparse_weight} * std::fabs(double{x[c]});
    }
    for (size_t i = 0; i < pairs.size(); i += 2) {
      sum += double{frame.symmetric_weight} * std::pow(double{x[pairs[i]]} - x[pairs[i + 1]], 2);
    }
    return sum;
  };
  for (const uint32_t kind : {0u, 1u, 2u, 3u}) {
    const uint32_t rigid = kind & 1;
    const FitHandle& fit = kind < 2 ? of_one_side : of_both_sides;
    const float low = kind < 2 ? 0.0f : -1.0f;
    frame.rigid = rigid;
    Floats found(count);
    MienFitResult result = mien_fit_result_default();
    ASSERT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK);
    EXPECT_EQ(result.status, MIEN_FIT_CONVERGED) << result.iterations;
    // The motion is the best for each pose, so held where it is it gives the gradient.
    const auto cost = [&](const Floats& x) {
      const Floats surface = head.positions(x);
      double sum = terms(x);
      for (size_t i = 0; i < points.size(); ++i) {
        const float* p = surface.data() + size_t{points[i].positions[0]} * 3;
        for (size_t r = 0; r < 3; ++r) {
          double at = double{p[r]};
          if (rigid) {
            at = double{result.translation[r]};
            for (size_t k = 0; k < 3; ++k) at += double{result.rotation[3 * r + k]} * p[k];
          }
          sum += std::pow(at - targets[3 * i + r], 2);
        }
      }
      return sum;
    };
    const double least = cost(found);
    EXPECT_NEAR(result.cost, least, 1e-4 * least) << kind;
    for (size_t c = 0; c < count; ++c) {
      for (const float change : {-0.01f, 0.01f}) {
        Floats near = found;
        near[c] = std::min(std::max(near[c] + change, low), 1.0f);
        EXPECT_GE(cost(near), least * (1 - 1e-4)) << kind << ", control " << c << ' ' << change;
      }
    }
  }
}

}  // namespace
}  // namespace mien
