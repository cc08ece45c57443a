// SPDX-License-Identifier: MIT
// Random sparse poses of golden and authored rigs come back from the vertices of a mesh: joint values, and the controls
// that the vertices determine.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/derive/derivatives_handle.h"
#include "tests/fit/fit_head.h"
#include "tests/support/authored_head.h"
#include "tests/support/golden.h"

namespace mien {
namespace {

constexpr float kObserved =
    0.05f;  // a control that the vertices determine: mien_fit_observability()
constexpr double kExplained = 0.01;  // cm: a residual of exact targets that needs no other start

// Of rotations:
// What 1 of a part moves vertices, root mean square in cm. Plainly: 0.01 by twice what the rounding of angles does.
constexpr double kSeen = 0.2;
constexpr double kFaintlySeen = 0.026;  // 0.01: by 4 times the rounding of coordinates of 160 cm
constexpr double kMet = 2e-4;           // cm: a residual that rounding alone leaves
constexpr size_t kRounds = 8;           // of other starts
constexpr size_t kStarts = 2;           // of each rotation in a round
constexpr uint32_t kTurns = 54;         // of which they are the best

/// A rig with a mesh, all vertices of which are targets.
struct Subject {
  Head head;
  FitHandle fit;
  std::vector<MienSolvePoint> points;
  std::vector<uint32_t> observed;  // raw controls
  std::vector<float> initial;
  double full_turn = 360;
  bool turns = false;        // the controls are the parts of unit quaternions, four in a row
  size_t started_again = 0;  // poses that need other starts

  /// `held` are raw controls that do not move.
  explicit Subject(DnaHandle dna, const std::vector<uint32_t>& held = {}) : head(std::move(dna)) {
    MienRigInfo info = sized<MienRigInfo>();
    EXPECT_EQ(mien_rig_info(head.rig.get(), &info), MIEN_OK);
    if (info.rotation_unit == MIEN_ROTATION_UNIT_RADIANS) full_turn = 2 * std::acos(-1.0);
    initial.assign(head.character.raw.begin(), head.character.raw.end());
    points = every(mesh_of(head.deformer.get(), 0).position_count, 1);
    std::vector<uint32_t> controls;
    for (uint32_t c = 0; c < head.character.raw.count; ++c) {
      if (std::find(held.begin(), held.end(), c) == held.end()) controls.push_back(c);
    }
    fit = fit_of(controls);
    std::vector<float> values(head.character.raw.count);
    EXPECT_EQ(mien_fit_observability(fit.get(), values.data(), values.size()), MIEN_OK);
    for (uint32_t c = 0; c < values.size(); ++c) {
      if (values[c] > kObserved) observed.push_back(c);
    }
  }

  /// Only these controls may move.
  FitHandle fit_of(const std::vector<uint32_t>& controls) const {
    MienFitDesc desc = sized<MienFitDesc>();
    desc.deformer = head.deformer.get();
    desc.points = points.data();
    desc.point_count = points.size();
    desc.controls = controls.data();
    desc.control_count = controls.size();
    return create_fit(head.rig, desc);
  }

  /// 8 to 25 of the observed controls, or as many as there are.
  std::vector<float> pose(Random& random) const {
    if (turns) return turned(random);
    std::vector<float> raw = initial;
    for (uint32_t left = 8 + random.below(18); left != 0; --left) {
      raw[observed[random.below(static_cast<uint32_t>(observed.size()))]] =
          static_cast<float>(random.between(0.1, 1));
    }
    return raw;
  }

  /// 2 to 6 of the observed rotations, which are 8 to 24 controls: by 0.1 to 1 radians about any axis.
  std::vector<float> turned(Random& random) const {
    std::vector<float> raw = initial;
    for (uint32_t left = 2 + random.below(5); left != 0; --left) {
      const uint32_t place = random.below(static_cast<uint32_t>(observed.size() / 4));
      double axis[3];
      for (double& v : axis) v = random.between(-1, 1);
      set_turn(raw, observed[4 * place], axis, random.between(0.1, 1));
    }
    return raw;
  }

  static void set_turn(std::vector<float>& raw, uint32_t first, const double* axis, double angle) {
    const double length = std::hypot(axis[0], axis[1], axis[2]);
    for (uint32_t k = 0; k < 3; ++k) {
      raw[first + k] = static_cast<float>(std::sin(angle / 2) * axis[k] / length);
    }
    raw[first + 3] = static_cast<float>(std::cos(angle / 2));
  }

  /// Observed are only rotations that move the vertices by `enough`, about each axis.
  void keep_seen(double enough) {
    const DerivativesHandle derivatives = create_derivatives(head.rig.get(), head.deformer.get());
    head.evaluate(initial);
    linearize(derivatives, head.character);
    std::vector<uint32_t> seen;
    for (size_t i = 0; i < observed.size(); i += 4) {
      double least = HUGE_VAL;
      for (uint32_t k = 0; k < 3; ++k) {
        std::vector<float> direction(initial.size());
        direction[observed[i] + k] = 1;
        double sum = 0;
        for (const float v :
             forward(derivatives, MIEN_POINT_RAW, MIEN_POINT_POSITIONS, direction)) {
          sum += double{v} * double{v};
        }
        least = std::fmin(least, std::sqrt(sum / static_cast<double>(points.size())));
      }
      for (size_t k = 0; k < 4 && least > enough; ++k) seen.push_back(observed[i + k]);
    }
    observed = seen;
  }

  /// How far the vertices are from the targets: a sum of squares.
  double apart(const std::vector<float>& raw, const float* targets) {
    const std::vector<float> positions = head.positions(raw);
    double sum = 0;
    for (size_t k = 0; k < positions.size(); ++k) {
      const double difference = double{positions[k]} - targets[k];
      sum += difference * difference;
    }
    return sum;
  }

  /// `raw` with the quaternion at `first` turned elsewhere, for each of kTurns turns. Without those where it is already.
  void list_starts(const std::vector<float>& raw, uint32_t first, const float* targets,
                   std::vector<std::pair<double, std::vector<float>>>& out) {
    for (uint32_t n = 0; n < kTurns; ++n) {
      double axis[3] = {n % 3 - 1.0, n / 3 % 3 - 1.0, n / 9 % 3 - 1.0};
      const bool rest = n % 27 == 13;
      axis[0] += rest;
      std::vector<float> start = raw;
      set_turn(start, first, axis, rest ? 0 : n < 27 ? 0.4 : 0.8);
      double turned = 0;
      for (size_t k = first; k < first + 4; ++k) turned += std::fabs(double{start[k]} - raw[k]);
      if (turned > 0.1) out.emplace_back(apart(start, targets), start);
    }
    std::sort(out.begin(), out.end());
  }

  /// Other starts: the result with one quaternion turned elsewhere, first the turns that come nearest to the targets,
  /// until only rounding is left.
  void search(MienFitFrame frame, std::vector<float>& found, MienFitResult& result) {
    for (size_t round = 0; round < kRounds && result.point_residual > kMet; ++round) {
      std::vector<std::pair<double, std::vector<float>>> starts;
      for (size_t i = 0; i < observed.size(); i += 4) {
        std::vector<std::pair<double, std::vector<float>>> turns_of_one;
        list_starts(found, observed[i], frame.points, turns_of_one);
        std::move(turns_of_one.begin(), turns_of_one.begin() + kStarts, std::back_inserter(starts));
      }
      std::sort(starts.begin(), starts.end());
      const double before = result.point_residual;
      for (const auto& start : starts) {
        std::vector<float> other(found.size());
        MienFitResult told = mien_fit_result_default();
        frame.start = start.second.data();
        EXPECT_EQ(mien_fit_solve(fit.get(), &frame, other.data(), &told), MIEN_OK);
        if (told.point_residual >= result.point_residual) continue;
        result = told;
        found = other;
        if (result.point_residual < 0.7 * before) break;
      }
      if (result.point_residual == before) return;
    }
  }

  /// Whether a pose comes back.
  bool meets(const std::vector<float>& raw) {
    const std::vector<float> targets = head.positions(raw), joints = head.joints(raw);
    MienFitFrame frame = mien_fit_frame_default();
    frame.points = targets.data();
    frame.prior_weight = 1e-7f;  // holds what the vertices do not determine
    frame.max_iterations = 100;
    std::vector<float> found(raw.size());
    MienFitResult result = mien_fit_result_default();
    EXPECT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK);
    const bool ended_elsewhere = result.point_residual > (turns ? kMet : kExplained);
    started_again += ended_elsewhere;
    if (ended_elsewhere && turns) {
      search(frame, found, result);
    } else if (ended_elsewhere) {
      // Another minimum of the cost: one more start.
      std::vector<float> start = initial;
      for (const uint32_t c : observed) start[c] = 0.25f;
      frame.start = start.data();
      EXPECT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK);
    }
    const std::vector<float> solved = head.joints(found);
    double range = 0, joint_error = 0, control_error = 0;
    for (size_t i = 0; i < joints.size(); ++i) {
      range = std::fmax(range, std::fabs(joints[i]));
      double error = double{solved[i]} - joints[i];
      if (i % 9 / 3 == 1) error = std::remainder(error, full_turn);
      joint_error = std::fmax(joint_error, std::fabs(error));
    }
    for (const uint32_t c : observed) {
      control_error = std::fmax(control_error, std::fabs(double{found[c]} - raw[c]));
    }
    const bool met = joint_error <= 1e-3 * range && control_error <= 0.01;
    if (!met) {
      printf("joints off by %.2g of %.2g, controls by %.2g, points by %.2g, %u iterations\n",
             joint_error, range, control_error, result.point_residual, result.iterations);
    }
    return met;
  }
};

/// 99 % of `count` random poses come back, after `first` that are left out.
void expect_most(const std::string& name, Subject&& subject, size_t first, size_t count) {
  SCOPED_TRACE(name);
  EXPECT_GE(subject.observed.size(), 8u);
  if (subject.observed.empty()) return;
  Random random = Random::from_seed(84, 1);
  for (size_t i = 0; i < first; ++i) static_cast<void>(subject.pose(random));
  size_t met = 0;
  for (size_t i = 0; i < count; ++i) met += subject.meets(subject.pose(random));
  printf(
      "%s: %zu of %zu poses, %zu with other starts, %zu of %zu controls observed, %zu vertices\n",
      name.c_str(), met, count, subject.started_again, subject.observed.size(),
      size_t{subject.head.character.raw.count}, subject.points.size());
  EXPECT_GE(100 * met, 99 * count);
}

/// A golden rig. The components of quaternions among its raw controls stay as they are: RBF solvers read them, and
/// they are no expressions.
Subject golden_rig(const std::string& name) {
  golden::File file;
  EXPECT_EQ(golden::parse(golden::read_bytes(golden::path_of(name, ".golden.bin")), file), "");
  const golden::Record* quaternions = file.find("in.quatRaw");
  return Subject(open_dna(golden::read_rig(name)),
                 quaternions ? quaternions->integers : std::vector<uint32_t>());
}

/// In ml_ext, random networks turn 30 joints by any angle, and only 17 of 90 controls are determined. These alone may
/// move there: with all, steps that the vertices hardly determine are too long, and 100 iterations do not suffice.
Subject determined_rig(const std::string& name) {
  Subject subject = golden_rig(name);
  subject.fit = subject.fit_of(subject.observed);
  return subject;
}

/// The controls of body are 44 unit quaternions, which RBF solvers, swings and twists read. Those that the vertices
/// determine may move (docs/solving.md, Random poses).
Subject rotated_rig(const std::string& name, double seen) {
  Subject subject(open_dna(golden::read_rig(name)));
  subject.turns = true;
  subject.keep_seen(seen);
  subject.fit = subject.fit_of(subject.observed);
  return subject;
}

void expect_all(size_t first, size_t count) {
  for (const char* name : {"small", "small_rot", "ml"}) {
    expect_most(name, golden_rig(name), first, count);
  }
  expect_most("ml_ext", determined_rig("ml_ext"), first, count);
  expect_most("authored", Subject(author_head(4, 60)), first, count);
}

// Among these are poses of ml whose controls move the mesh through networks alone.
TEST(Poses, OfGoldenAndAuthoredRigsComeBackFromVertices) { expect_all(60, 40); }

TEST(Poses, OfRotationsComeBackFromVertices) {
  Subject body = rotated_rig("body", kSeen);
  EXPECT_EQ(body.observed.size(), 18u * 4);
  expect_most("body", std::move(body), 60, 40);
}

TEST(ManyPoses, OfRotationsComeBackFromVertices) {
  expect_most("body", rotated_rig("body", kSeen), 0, 1000);
}

TEST(ManyPoses, OfFaintRotationsComeBackFromVertices) {
  Subject body = rotated_rig("body", kFaintlySeen);
  EXPECT_EQ(body.observed.size(), 24u * 4);
  expect_most("body, faint", std::move(body), 60, 40);
}

TEST(ManyPoses, OfGoldenAndAuthoredRigsComeBackFromVertices) { expect_all(0, 1000); }

}  // namespace
}  // namespace mien
