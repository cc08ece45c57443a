// SPDX-License-Identifier: MIT
// Random sparse poses of golden and authored rigs come back from the vertices of a mesh: joint values, and the controls
// that the vertices determine.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/fit/fit_head.h"
#include "tests/support/golden.h"
#include "tests/support/mesh_source.h"

namespace mien {
namespace {

constexpr float kObserved =
    0.05f;  // a control that the vertices determine: mien_fit_observability()
constexpr double kExplained = 0.01;  // cm: a residual of exact targets that needs no other start

/// A rig with a mesh, all vertices of which are targets.
struct Subject {
  Head head;
  FitHandle fit;
  std::vector<MienSolvePoint> points;
  std::vector<uint32_t> observed;  // raw controls
  std::vector<float> initial;
  double full_turn = 360;

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
    std::vector<float> raw = initial;
    for (uint32_t left = 8 + random.below(18); left != 0; --left) {
      raw[observed[random.below(static_cast<uint32_t>(observed.size()))]] =
          static_cast<float>(random.between(0.1, 1));
    }
    return raw;
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
    if (result.point_residual > kExplained) {
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
  printf("%s: %zu of %zu poses, %zu of %zu controls observed, %zu vertices\n", name.c_str(), met,
         count, subject.observed.size(), size_t{subject.head.character.raw.count},
         subject.points.size());
  EXPECT_GE(100 * met, 99 * count);
}

/// The skin of the procedural head with its 52 expressions, rigged by libmien-author.
DnaHandle author_head() {
  author::TestMesh source = author::procedural_mesh(4, true);
  std::vector<MienAuthorShape> shapes(source.shape_names.size());
  for (size_t s = 0; s < shapes.size(); ++s) {
    shapes[s].name = {source.shape_names[s].data(), source.shape_names[s].size()};
    shapes[s].position_count = source.positions.size() / 3;
    shapes[s].displacements = source.displacements[s].data();
  }
  MienAuthorMesh mesh = sized<MienAuthorMesh>();
  mesh.positions = source.positions.data();
  mesh.position_count = source.positions.size() / 3;
  mesh.face_sizes = source.face_sizes.data();
  mesh.face_count = source.face_sizes.size();
  mesh.corners = source.corners.data();
  mesh.corner_count = source.corners.size();
  mesh.shapes = shapes.data();
  mesh.shape_count = shapes.size();
  MienAuthorDesc desc = sized<MienAuthorDesc>();
  desc.facial_joints = 60;
  desc.lods = 1;
  MienError error = sized<MienError>();
  MienDna* dna = nullptr;
  EXPECT_EQ(mien_author_rig(&mesh, &desc, &dna, nullptr, &error), MIEN_OK) << error.message;
  return DnaHandle(dna);
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

void expect_all(size_t first, size_t count) {
  // Not body: docs/solving.md, Random poses.
  for (const char* name : {"small", "small_rot", "ml"}) {
    expect_most(name, golden_rig(name), first, count);
  }
  expect_most("ml_ext", determined_rig("ml_ext"), first, count);
  expect_most("authored", Subject(author_head()), first, count);
}

// Among these are poses of ml whose controls move the mesh through networks alone.
TEST(Poses, OfGoldenAndAuthoredRigsComeBackFromVertices) { expect_all(60, 40); }

TEST(ManyPoses, OfGoldenAndAuthoredRigsComeBackFromVertices) { expect_all(0, 1000); }

}  // namespace
}  // namespace mien
