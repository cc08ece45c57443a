// SPDX-License-Identifier: MIT
// Fits on motions that are known, and on the expressions of the procedural head.
#include "author/fit/fit_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "author/base/random.h"
#include "author/fit/procrustes.h"
#include "author/fit/targets.h"
#include "author/weights/skin_weights.h"
#include "tests/support/author_setup.h"

namespace mien::author {
namespace {

void refit(const AuthorMesh& mesh, const Motions& motions, Span<const uint16_t> shared,
           const ParallelFor& parallel, const SkinWeights& from, SkinWeights& out,
           double smoothness = 0) {
  Arena arena(default_allocator());
  SurfaceGraph graph;
  ASSERT_TRUE(make_surface_graph(mesh, arena, arena, graph));
  ASSERT_TRUE(refit_weights(mesh, graph, motions, shared, {}, smoothness, 0.0025, parallel, arena,
                            from, out));
}

double difference(const Affine& a, const Affine& b) {
  double sum = length(a.shift - b.shift);
  for (int r = 0; r < 3; ++r) sum += length(a.rows[r] - b.rows[r]);
  return sum;
}

Affine turned(Vec3 degrees, Vec3 center = {}, Vec3 shift = {}) {
  const double angles[3] = {degrees.x, degrees.y, degrees.z};
  return motion(angles, center, shift);
}

// Rotations --------------------------------------------------------------------------------------

TEST(Procrustes, ARotationIsItsOwnClosest) {
  Random random = Random::from_seed(1, 2);
  for (int i = 0; i < 200; ++i) {
    const Vec3 angles = {random.between(-170, 170), random.between(-80, 80),
                         random.between(-170, 170)};
    const Affine wanted = turned(angles);
    Affine found;
    closest_rotation(wanted.rows, 1, found.rows);
    EXPECT_LT(difference(wanted, found), 1e-12);
    Affine scaled = wanted;
    for (Vec3& row : scaled.rows) row = row * 0.01;
    closest_rotation(scaled.rows, 1, found.rows);
    EXPECT_LT(difference(wanted, found), 1e-12);
  }
}

TEST(Procrustes, AReflectionGivesARotation) {
  const Vec3 mirror[3] = {{-1, 0, 0}, {0, 3, 0}, {0, 0, 2}};
  Vec3 found[3];
  closest_rotation(mirror, 1, found);
  EXPECT_NEAR(dot(found[0], cross(found[1], found[2])), 1, 1e-12);
}

TEST(Procrustes, ZeroGivesTheIdentity) {
  const Vec3 zero[3] = {};
  Affine found;
  closest_rotation(zero, 1, found.rows);
  EXPECT_LT(difference(found, Affine::identity()), 1e-15);
}

TEST(Procrustes, LargeRotationsKeepTheirAxisAndStopAtTheLimit) {
  const double limit = exact_sine(15 * kPi / 180);
  Affine found;
  closest_rotation(turned({0, 50, 0}).rows, limit, found.rows);
  EXPECT_LT(difference(found, turned({0, 30, 0})), 1e-12);
  closest_rotation(turned({0, 29, 0}).rows, limit, found.rows);
  EXPECT_LT(difference(found, turned({0, 29, 0})), 1e-12);
}

TEST(EulerAngles, GiveTheRotationBack) {
  Random random = Random::from_seed(3, 4);
  for (int i = 0; i < 200; ++i) {
    const Affine wanted =
        turned({random.between(-180, 180), random.between(-90, 90), random.between(-180, 180)});
    EXPECT_LT(difference(turned(euler_angles(wanted.rows)), wanted), 1e-9);
  }
  for (double side : {-90.0, 90.0}) {
    const Affine wanted = turned({20, side, 35});
    EXPECT_LT(difference(turned(euler_angles(wanted.rows)), wanted), 1e-9);
  }
}

// Fits -------------------------------------------------------------------------------------------

/// Two clouds of points, each carried by one bone alone, and a third that does not move.
struct Clouds : AuthorSetup {
  Affine first = turned({10, -20, 5}, {3, 0, 0}, {0.5, 0.2, -0.1});
  Affine second = turned({0, 0, 25}, {-3, 0, 0}, {0, 1, 0});

  Clouds() {
    add_trunk();
    add_bone("a", {3, 0, 0}, BoneKind::kFacial, 3);
    add_bone("b", {-3, 0, 0}, BoneKind::kFacial, 3);
    add_bone("c", {0, 6, 0}, BoneKind::kFacial, 3);
    Random random = Random::from_seed(5, 6);
    for (uint32_t j = 4; j < 7; ++j) {
      for (int i = 0; i < 60; ++i) {
        const Vec3 offset = {random.normal(), random.normal(), random.normal()};
        add_vertex(bones[j].position + offset);
        joints.push_back(static_cast<uint16_t>(j));
        weight_values.push_back(1);
      }
    }
    add_shape("move", [&](uint32_t v) -> Vec3 {
      if (v >= 120) return {};
      return (v < 60 ? first : second)(positions[v]) - positions[v];
    });
    finish(1);
  }
};

struct Fitted {
  Arena arena{default_allocator()};
  Fitter fitter;
  Motions motions;

  Fitted(const AuthorSetup& setup, const FitOptions& options = {},
         const ParallelFor& parallel = {}) {
    EXPECT_TRUE(make_fitter(setup.mesh.positions, setup.placement, setup.weights.m, options, arena,
                            fitter));
    EXPECT_TRUE(make_motions(setup.shapes.size(), setup.bones.size(), arena, motions));
    fit_all(fitter, setup.mesh, setup.weights, false, parallel, motions);
  }
  double error(const AuthorSetup& setup) {
    FitError error;
    EXPECT_TRUE(measure_fit(setup.mesh, setup.weights, motions, {}, {}, arena, error));
    return error.error;
  }
};

TEST(FitShapes, RigidMotionsAreFound) {
  const Clouds clouds;
  Fitted fitted(clouds);
  // The term that keeps bones still costs a little.
  EXPECT_LT(fitted.error(clouds), 0.02);
  EXPECT_LT(difference(fitted.motions.of(0)[4], clouds.first), 0.15);
  EXPECT_LT(difference(fitted.motions.of(0)[5], clouds.second), 0.15);
}

TEST(FitShapes, BonesThatAreNotConcernedStayExactlyStill) {
  const Clouds clouds;
  const Fitted fitted(clouds);
  for (uint32_t j : {0u, 1u, 2u, 3u, 6u}) {
    EXPECT_EQ(fitted.motions.active_in(0)[j], 0) << j;
    EXPECT_EQ(difference(fitted.motions.of(0)[j], Affine::identity()), 0) << j;
  }
}

TEST(FitShapes, TranslationsAloneDoNotTurn) {
  const Clouds clouds;
  FitOptions options;
  options.rotations = false;
  Fitted fitted(clouds, options);
  for (uint32_t j = 4; j < 6; ++j) {
    Affine still = fitted.motions.of(0)[j];
    EXPECT_GT(length(still.shift), 0.1);
    still.shift = {};
    EXPECT_EQ(difference(still, Affine::identity()), 0);
  }
  EXPECT_GT(fitted.error(clouds), 2 * Fitted(clouds).error(clouds));
}

TEST(FitShapes, AJawWithManyVerticesDoesNotHideFacialBones) {
  Clouds clouds;
  clouds.bones[5].kind = BoneKind::kJaw;
  // What the jaw carries moves a hundred times as far as one facial bone, another hardly at all.
  clouds.add_shape("open", [](uint32_t v) -> Vec3 {
    return {0, v < 60 ? 0.1 : v < 120 ? 10 : 1e-4, 0};
  });
  clouds.finish(1);
  const Fitted fitted(clouds);
  EXPECT_TRUE(fitted.motions.active_in(1)[4]);
  EXPECT_TRUE(fitted.motions.active_in(1)[5]);
  EXPECT_FALSE(fitted.motions.active_in(1)[6]);
}

TEST(FitShapes, FacialBonesTurnNoFurtherThanTheLimitAndJawsDo) {
  Clouds clouds;
  FitOptions options;
  options.max_degrees = 10;
  const Fitted limited(clouds, options);
  const auto trace = [](const Affine& m) { return m.rows[0].x + m.rows[1].y + m.rows[2].z; };
  const double at_limit = 1 + 2 * std::cos(10 * M_PI / 180);
  EXPECT_NEAR(trace(limited.motions.of(0)[5]), at_limit, 1e-9);
  clouds.bones[5].kind = BoneKind::kJaw;
  const Fitted free(clouds, options);
  EXPECT_NEAR(trace(free.motions.of(0)[5]), 1 + 2 * std::cos(25 * M_PI / 180), 1e-5);
}

TEST(FitShapes, AShapeWithoutDisplacementsMovesNothing) {
  Clouds clouds;
  clouds.add_shape("nothing", [](uint32_t) { return Vec3(); });
  clouds.finish(1);
  const Fitted fitted(clouds);
  for (uint32_t j = 0; j < 7; ++j) {
    EXPECT_EQ(fitted.motions.active_in(1)[j], 0);
    EXPECT_EQ(difference(fitted.motions.of(1)[j], Affine::identity()), 0);
  }
}

// Weights ----------------------------------------------------------------------------------------

TEST(RefitWeights, WeightsThatMadeTheShapesAreFoundAgain) {
  AuthorSetup setup;
  setup.add_trunk();
  for (int j = 0; j < 4; ++j) {
    setup.add_bone("b" + std::to_string(j), {double(j), 0, 0}, BoneKind::kFacial, 3);
  }
  const std::vector<double> made = {0.5, 0.3, 0.2, 0};
  setup.add_vertex({1, 1, 1});
  for (int j = 0; j < 4; ++j) {
    setup.joints.push_back(static_cast<uint16_t>(4 + j));
    setup.weight_values.push_back(0.25f);
  }
  Random random = Random::from_seed(7, 8);
  std::vector<Vec3> moves;
  for (int s = 0; s < 6; ++s) {
    Vec3 sum;
    for (int j = 0; j < 4; ++j) {
      moves.push_back({random.normal(), random.normal(), random.normal()});
      sum = sum + moves.back() * made[static_cast<size_t>(j)];
    }
    setup.add_shape("s" + std::to_string(s), [&](uint32_t) { return sum; });
  }
  setup.finish(4);
  Arena arena(default_allocator());
  Motions motions;
  ASSERT_TRUE(make_motions(6, setup.bones.size(), arena, motions));
  for (size_t i = 0; i < moves.size(); ++i) {
    motions.of(i / 4)[4 + i % 4].shift = moves[i];
    motions.active_in(i / 4)[4 + i % 4] = 1;
  }
  refit(setup.mesh, motions, {}, {}, setup.weights, setup.weights);
  for (uint16_t i = 0; i < 3; ++i) {
    EXPECT_EQ(setup.joints[i], 4 + i) << "heaviest first";
    EXPECT_NEAR(setup.weight_values[i], made[i], 0.01);
  }
  EXPECT_LT(setup.weight_values[3], 0.01f);
}

TEST(RefitWeights, WeightsStayWeights) {
  AuthorSetup head;
  make_author_head(5, 24, 6, 1, head);
  const std::vector<uint16_t> before = head.joints;
  Fitted fitted(head);
  const double error = fitted.error(head);
  refit(head.mesh, fitted.motions, {}, {}, head.weights, head.weights);
  EXPECT_LT(fitted.error(head), 0.8 * error);
  for (size_t v = 0; v < head.positions.size(); ++v) {
    double sum = 0;
    std::set<uint16_t> own(before.begin() + static_cast<ptrdiff_t>(v * 6),
                           before.begin() + static_cast<ptrdiff_t>(v * 6 + 6));
    for (size_t i = v * 6; i < v * 6 + 6; ++i) {
      const float w = head.weight_values[i];
      EXPECT_GE(w, 0);
      EXPECT_TRUE(i == v * 6 || w <= head.weight_values[i - 1]) << "heaviest first";
      EXPECT_TRUE(w == 0 || w >= 0.99e-4f);
      EXPECT_TRUE(w == 0 || own.count(head.joints[i])) << "a new influence";
      sum += double{w};
    }
    EXPECT_NEAR(sum, 1, 1e-6);
  }
}

/// One vertex with these bones, each of which moves by its own shift in the one shape.
struct OneVertex {
  AuthorSetup setup;
  Arena arena{default_allocator()};
  Motions motions;

  OneVertex(const std::vector<Vec3>& shifts, Vec3 wanted) {
    setup.add_trunk();
    setup.add_vertex({1, 1, 1});
    const uint32_t count = static_cast<uint32_t>(shifts.size());
    for (uint32_t j = 0; j < count; ++j) {
      setup.add_bone("b" + std::to_string(j), {double(j), 0, 0}, BoneKind::kFacial, 3);
      setup.joints.push_back(static_cast<uint16_t>(4 + j));
      setup.weight_values.push_back(1 / static_cast<float>(count));
    }
    setup.add_shape("s", [&](uint32_t) { return wanted; });
    setup.finish(count);
    EXPECT_TRUE(make_motions(1, setup.bones.size(), arena, motions));
    for (uint32_t j = 0; j < count; ++j) {
      motions.of(0)[4 + j].shift = shifts[j];
      motions.active_in(0)[4 + j] = 1;
    }
  }
};

TEST(RefitWeights, BonesThatAreSharedTakeWhatIsTooMuch) {
  OneVertex alone({{2, 0, 0}, {4, 0, 0}}, {1, 0, 0}), helped({{2, 0, 0}, {4, 0, 0}}, {1, 0, 0});
  refit(alone.setup.mesh, alone.motions, {}, {}, alone.setup.weights, alone.setup.weights);
  EXPECT_EQ(alone.setup.weight_values, (std::vector<float>{1, 0})) << "the shorter motion alone";
  const uint16_t head = 2;
  refit(helped.setup.mesh, helped.motions, {&head, 1}, {}, helped.setup.weights,
        helped.setup.weights);
  double moved = 0, sum = 0;
  for (uint32_t i = 0; i < 2; ++i) {
    moved += helped.setup.weight_values[i] * helped.motions.of(0)[helped.setup.joints[i]].shift.x;
    sum += helped.setup.weight_values[i];
  }
  EXPECT_NEAR(moved, 1, 0.02);
  EXPECT_NEAR(sum, 1, 1e-6);
  EXPECT_TRUE(helped.setup.joints[0] == head || helped.setup.joints[1] == head);
}

TEST(RefitWeights, OfManyInfluencesThoseStayThatThereIsRoomFor) {
  // Only the second and the fourth bone make the shape, half of each.
  const std::vector<Vec3> shifts = {{0, 9, 0}, {2, 0, 0}, {0, -9, 3}, {0, 0, 2}, {5, 0, 9}};
  OneVertex made(shifts, {1, 0, 1});
  std::vector<uint16_t> joints(2);
  std::vector<float> values(2);
  SkinWeights out = {{joints.data(), 2}, {values.data(), 2}, 2};
  refit(made.setup.mesh, made.motions, {}, {}, made.setup.weights, out);
  EXPECT_EQ(std::set<uint16_t>(joints.begin(), joints.end()), (std::set<uint16_t>{5, 7}));
  EXPECT_NEAR(values[0], 0.5, 0.01);
  EXPECT_NEAR(values[0] + values[1], 1, 1e-6);
}

TEST(RefitWeights, MotionsBeyondDoublesLeaveTheWeights) {
  for (const double far : {1e160, 1e300, HUGE_VAL}) {
    OneVertex made({{far, 0, 0}, {0, far, 0}, {-far, 1, 0}}, {1, 0, 1});
    std::vector<uint16_t> joints(2);
    std::vector<float> values(2);
    SkinWeights out = {{joints.data(), 2}, {values.data(), 2}, 2};
    refit(made.setup.mesh, made.motions, {}, {}, made.setup.weights, out);
    EXPECT_EQ(joints, (std::vector<uint16_t>{4, 5})) << far;
    EXPECT_EQ(values, (std::vector<float>{0.5f, 0.5f})) << far;
  }
}

TEST(RefitWeights, RigidVerticesStayRigid) {
  OneVertex made({{2, 0, 0}}, {1, 0, 0});
  const uint16_t head = 2;
  refit(made.setup.mesh, made.motions, {&head, 1}, {}, made.setup.weights, made.setup.weights);
  EXPECT_EQ(made.setup.joints[0], 4);
  EXPECT_EQ(made.setup.weight_values[0], 1);
}

// A face -----------------------------------------------------------------------------------------

TEST(FitShapes, ErrorsFallWithRotationsAlternationsAndBones) {
  AuthorSetup few, many;
  make_author_head(5, 20, 6, 1, few);
  make_author_head(5, 40, 6, 1, many);
  FitOptions translations;
  translations.rotations = false;
  const double moved = Fitted(few, translations).error(few);
  Fitted turned_too(few);
  const double turned_error = turned_too.error(few);
  EXPECT_LT(turned_error, 1.02 * moved);
  EXPECT_LT(Fitted(many).error(many), 1.02 * turned_error);
  double last = turned_error;
  for (int i = 0; i < 3; ++i) {
    refit(few.mesh, turned_too.motions, {}, {}, few.weights, few.weights);
    fit_all(turned_too.fitter, few.mesh, few.weights, false, {}, turned_too.motions);
    const double error = turned_too.error(few);
    EXPECT_LT(error, 1.02 * last);
    last = error;
  }
  EXPECT_LT(last, 0.6 * turned_error);
}

TEST(FitShapes, ErrorsFallWithInfluences) {
  double last = 1;
  for (const uint32_t influences : {2u, 4u, 8u, 12u}) {
    AuthorSetup head;
    make_author_head(5, 40, influences, 1, head);
    Fitted fitted(head);
    refit(head.mesh, fitted.motions, {}, {}, head.weights, head.weights);
    fit_all(fitted.fitter, head.mesh, head.weights, false, {}, fitted.motions);
    const double error = fitted.error(head);
    EXPECT_LT(error, 1.02 * last) << influences;
    last = error;
  }
}

TEST(FitShapes, OrderOfBonesDoesNotMatter) {
  AuthorSetup head, other;
  make_author_head(5, 40, 6, 1, head);
  make_author_head(5, 40, 6, 1, other);
  const uint16_t first = 4, last = static_cast<uint16_t>(other.bones.size() - 1);
  std::reverse(other.bones.begin() + first, other.bones.end());
  for (uint16_t& joint : other.joints) {
    if (joint >= first) joint = static_cast<uint16_t>(first + last - joint);
  }
  Fitted a(head), b(other);
  EXPECT_NEAR(a.error(head), b.error(other), 0.02 * a.error(head));
  // Translations are solved at once, so they are the same.
  FitOptions translations;
  translations.rotations = false;
  const Fitted x(head, translations), y(other, translations);
  for (size_t s = 0; s < head.shapes.size(); ++s) {
    for (uint32_t j = first; j <= last; ++j) {
      const uint32_t there = first + last - j;
      EXPECT_EQ(x.motions.active_in(s)[j], y.motions.active_in(s)[there]);
      EXPECT_LT(difference(x.motions.of(s)[j], y.motions.of(s)[there]), 1e-6);
    }
  }
}

TEST(FitShapes, AnUnusedControlChangesNothing) {
  AuthorSetup head, more;
  make_author_head(6, 16, 4, 1, head);
  make_author_head(6, 16, 4, 1, more);
  more.add_shape("unused", [](uint32_t) { return Vec3(); });
  more.finish(4);
  const Fitted a(head), b(more);
  for (size_t i = 0; i < a.motions.items.count; ++i) {
    EXPECT_EQ(difference(a.motions.items[i], b.motions.items[i]), 0);
  }
  refit(head.mesh, a.motions, {}, {}, head.weights, head.weights);
  refit(more.mesh, b.motions, {}, {}, more.weights, more.weights);
  EXPECT_EQ(head.weight_values, more.weight_values);
}

/// The same head with its vertices in another order, `scale` times as large and moved.
void make_other_head(const AuthorSetup& from, double scale, Vec3 shift, AuthorSetup& out) {
  std::vector<uint32_t> order;  // old numbers
  Random random = Random::from_seed(11, 12);
  for (uint32_t v = 0; v < from.positions.size(); ++v) order.push_back(v);
  for (uint32_t v = static_cast<uint32_t>(order.size()); v > 1; --v) {
    std::swap(order[v - 1], order[random.below(v)]);
  }
  out.bones = from.bones;
  out.bone_names = from.bone_names;
  for (Bone& bone : out.bones) bone.position = bone.position * scale + shift;
  const uint32_t m = from.weights.m;
  for (uint32_t v : order) {
    out.add_vertex(from.positions[v] * scale + shift);
    for (uint32_t i = v * m; i < v * m + m; ++i) {
      out.joints.push_back(from.joints[i]);
      out.weight_values.push_back(from.weight_values[i]);
    }
  }
  for (size_t s = 0; s < from.shapes.size(); ++s) {
    out.add_shape(from.shape_names[s], [&](uint32_t v) {
      const Vec3f d = from.displacements[s][order[v]];
      return Vec3{double{d.x}, double{d.y}, double{d.z}} * scale;
    });
  }
  out.finish(m);
}

TEST(FitShapes, OrderOfVerticesUnitAndPlaceDoNotMatter) {
  AuthorSetup head, other;
  make_author_head(6, 16, 4, 1, head);
  const double scale = 100;
  const Vec3 shift = {300, -200, 50};
  make_other_head(head, scale, shift, other);
  Fitted a(head), b(other);
  for (int round = 0; round < 2; ++round) {
    EXPECT_NEAR(a.error(head), b.error(other), 1e-5);
    for (size_t i = 0; i < a.motions.items.count; ++i) {
      ASSERT_EQ(a.motions.active[i], b.motions.active[i]);
      const Vec3 at = head.bones[i % head.bones.size()].position, there = at * scale + shift;
      const Affine &x = a.motions.items[i], &y = b.motions.items[i];
      for (int r = 0; r < 3; ++r) EXPECT_LT(length(x.rows[r] - y.rows[r]), 1e-3);
      EXPECT_LT(length((x(at) - at) * scale - (y(there) - there)), 1e-4 * other.mesh.diagonal);
    }
    refit(head.mesh, a.motions, {}, {}, head.weights, head.weights);
    refit(other.mesh, b.motions, {}, {}, other.weights, other.weights);
    fit_all(a.fitter, head.mesh, head.weights, false, {}, a.motions);
    fit_all(b.fitter, other.mesh, other.weights, false, {}, b.motions);
  }
}

/// Runs tasks in another order, as threads would.
void run_backwards(void*, uint32_t count, void (*task)(void*, uint32_t), void* context) {
  for (uint32_t i = count; i-- > 0;) task(context, i);
}

TEST(FitShapes, TheOrderOfTasksDoesNotMatter) {
  AuthorSetup a, b;
  make_author_head(6, 16, 4, 1, a);
  make_author_head(6, 16, 4, 1, b);
  const ParallelFor backwards = {nullptr, run_backwards};
  Fitted x(a), y(b, {}, backwards);
  refit(a.mesh, x.motions, {}, {}, a.weights, a.weights);
  refit(b.mesh, y.motions, {}, backwards, b.weights, b.weights);
  fit_all(x.fitter, a.mesh, a.weights, false, {}, x.motions);
  fit_all(y.fitter, b.mesh, b.weights, false, backwards, y.motions);
  EXPECT_EQ(a.weight_values, b.weight_values);
  EXPECT_EQ(a.joints, b.joints);
  for (size_t i = 0; i < x.motions.items.count; ++i) {
    EXPECT_EQ(difference(x.motions.items[i], y.motions.items[i]), 0);
  }
}

// Targets ----------------------------------------------------------------------------------------

TEST(MakeTargets, WithoutThresholdShapesAreReached) {
  AuthorSetup head;
  make_author_head(5, 24, 6, 1, head);
  Fitted fitted(head);
  Span<Target> targets;
  ASSERT_TRUE(make_targets(head.mesh, head.weights, fitted.motions, 0, {}, fitted.arena, targets));
  FitError error;
  ASSERT_TRUE(
      measure_fit(head.mesh, head.weights, fitted.motions, targets, {}, fitted.arena, error));
  EXPECT_LT(error.max, 1e-5);
}

TEST(MakeTargets, OffsetsBelowTheThresholdAreLeftOut) {
  AuthorSetup head;
  make_author_head(5, 24, 6, 1, head);
  Fitted fitted(head);
  Span<Target> targets;
  const double threshold = 1e-3 * head.mesh.diagonal;
  ASSERT_TRUE(
      make_targets(head.mesh, head.weights, fitted.motions, threshold, {}, fitted.arena, targets));
  size_t count = 0;
  for (const Target& t : targets) {
    count += t.vertices.count;
    for (size_t i = 0; i < t.vertices.count; ++i) {
      const Vec3f o = t.offsets[i];
      EXPECT_GT(std::hypot(double{o.x}, double{o.y}, double{o.z}), threshold);
      EXPECT_TRUE(i == 0 || t.vertices[i] > t.vertices[i - 1]);
    }
  }
  EXPECT_GT(count, 0u);
  FitError error;
  ASSERT_TRUE(
      measure_fit(head.mesh, head.weights, fitted.motions, targets, {}, fitted.arena, error));
  // What is left out is short; skinning may turn it but hardly stretches it.
  EXPECT_LT(error.max, 1.05e-3);
}

TEST(RefitWeights, SmoothnessDrawsNeighborsTogether) {
  const auto roughness = [](double smoothness, double* error) {
    AuthorSetup head;
    make_author_head(5, 40, 6, 1, head);
    Fitted fitted(head);
    refit(head.mesh, fitted.motions, {}, {}, head.weights, head.weights, smoothness);
    WeightReport report;
    EXPECT_TRUE(
        measure_weights(head.mesh, head.placement, head.weights, default_allocator(), report));
    EXPECT_LE(report.worst_sum, 1e-6);
    EXPECT_LE(report.max_influences, 6u);
    *error = fitted.error(head);
    return report.roughness;
  };
  double without = 0, with = 0, more = 0;
  const double rough = roughness(0, &without), smooth = roughness(0.5, &with);
  EXPECT_LT(smooth, 0.85 * rough);
  EXPECT_LT(roughness(5, &more), smooth);
  EXPECT_LT(without, with) << "it costs";
  EXPECT_LT(with, 1.5 * without);
  EXPECT_LT(with, more);
}

}  // namespace
}  // namespace mien::author
