// SPDX-License-Identifier: MIT
#include "author/fit/correctives.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "author/rig_dna/author_rig.h"
#include "tests/support/author_setup.h"
#include "tests/support/deform_rig.h"
#include "tests/support/rig_handles.h"

namespace mien::author {
namespace {

/// "A B | A_B=A+B": expressions, and combinations with their members.
std::string controls_of(const std::vector<std::string>& names) {
  std::vector<Shape> shapes;
  for (const std::string& n : names) shapes.push_back({{n.data(), n.size()}, {}, {}});
  Arena arena(default_allocator());
  Span<Shape> expressions;
  Span<Combination> combinations;
  EXPECT_TRUE(find_combinations({shapes.data(), shapes.size()}, arena, expressions, combinations));
  const auto text = [](Name name) { return std::string(name.data, name.count); };
  std::string out;
  for (const Shape& s : expressions) out += text(s.name) + " ";
  out += "|";
  for (const Combination& c : combinations) {
    out += " " + text(c.name) + "=";
    for (size_t i = 0; i < c.members.count; ++i) {
      out += (i > 0 ? "," : "") + text(expressions[c.members[i]].name);
    }
  }
  return out;
}

TEST(FindCombinations, NamesOfSeveralShapesAreCombinations) {
  EXPECT_EQ(controls_of({}), "|");
  EXPECT_EQ(controls_of({"a", "b"}), "a b |");
  EXPECT_EQ(controls_of({"a_b", "a", "b"}), "a b | a_b=a,b");
  EXPECT_EQ(controls_of({"a", "b", "b+a"}), "a b | b+a=a,b");
  EXPECT_EQ(controls_of({"a", "b", "c", "a_b_c", "a_c"}), "a b c | a_c=a,c a_b_c=a,b,c");
}

TEST(FindCombinations, UnderlinesOfOrdinaryNamesAreLeftAlone) {
  EXPECT_EQ(controls_of({"smile_L", "smile_R", "jaw_L"}), "smile_L smile_R jaw_L |");
  EXPECT_EQ(controls_of({"smile_L", "jaw", "jaw_smile_L"}),
            "smile_L jaw | jaw_smile_L=smile_L,jaw");
  EXPECT_EQ(controls_of({"_", "a_", "_a", "a", "", "+"}), "_ a_ _a a  + |");
}

TEST(FindCombinations, WhatCannotBeUsedStaysAnExpression) {
  EXPECT_EQ(controls_of({"a", "a_a"}), "a a_a |") << "the same twice";
  EXPECT_EQ(controls_of({"a", "b", "a_b", "b_a"}), "a b b_a | a_b=a,b") << "the same members";
  EXPECT_EQ(controls_of({"a", "b", "ab_c", "a_b_x"}), "a b ab_c a_b_x |") << "an unknown part";
  EXPECT_EQ(controls_of({"a", "b", "c", "d", "e", "f", "g", "h", "i", "a_b_c_d_e_f_g_h_i"}),
            "a b c d e f g h i a_b_c_d_e_f_g_h_i |")
      << "more than eight";
}

TEST(FindCombinations, AmbiguousNamesTakeBoundedTime) {
  std::vector<std::string> names = {"a"};
  while (names.size() < 60) names.push_back(names.back() + "_a");
  const std::string unknown_start = "b_" + names.back();
  names.push_back(unknown_start);
  EXPECT_NE(controls_of(names).find(unknown_start + " |"), std::string::npos);
}

TEST(FindCombinations, LongNamesOfManyPartsEnd) {
  std::string name = "a";
  for (int i = 0; i < 2000; ++i) name += "_a";
  EXPECT_EQ(controls_of({"a", "a_b", name + "_x"}), "a a_b " + name + "_x |");
}

/// Two bumps that shapes raise; together they rise to one height, not to two.
struct Bumps : AuthorSetup {
  explicit Bumps(bool with_combination, double height = 1) {
    add_trunk();
    for (int x = 0; x < 8; ++x) {
      for (int y = 0; y < 8; ++y) add_vertex({0.5 * x, 0.5 * y, 0});
    }
    for (uint32_t x = 0; x < 7; ++x) {
      for (uint32_t y = 0; y < 7; ++y) {
        add_face({x * 8 + y, x * 8 + 8 + y, x * 8 + 9 + y, x * 8 + 1 + y});
      }
    }
    for (int x = 0; x < 3; ++x) {
      for (int y = 0; y < 3; ++y) {
        add_bone("b" + std::to_string(3 * x + y), {0.5 + x * 1.25, 0.5 + y * 1.25, 0},
                 BoneKind::kFacial, 3);
      }
    }
    const auto bump = [this](uint32_t v) {
      const Vec3 d = positions[v] - Vec3{1.75, 1.75, 0};
      return Vec3{0, 0, std::exp(-dot(d, d))};
    };
    add_shape("a", bump);
    add_shape("b", bump);
    if (with_combination) add_shape("a_b", [&](uint32_t v) { return bump(v) * height; });
    finish(4);
  }
};

struct Authored {
  Arena arena{default_allocator()};
  RigReport report;
  std::vector<uint8_t> bytes;

  explicit Authored(AuthorSetup& setup, const RigOptions& options = {}) {
    dna::DnaView view;
    EXPECT_TRUE(author_rig(setup.mesh, setup.placement, {&setup.weights, 1}, options, arena,
                           default_allocator(), report, view));
    bytes = write_view(view);
  }
  /// The mean height of the vertices.
  double height(std::vector<float> raw) const {
    const DnaHandle dna = open_dna(bytes);
    Character character(create_rig(dna.get()));
    const DeformerHandle deformer = create_deformer(dna.get(), character.rig);
    const DeformerInstanceHandle instance = create_deformer_instance(deformer.get());
    for (size_t i = 0; i < raw.size(); ++i) character.raw[i] = raw[i];
    character.evaluate(0);
    EXPECT_EQ(mien_deformer_instance_update(instance.get(), character.instance.get()), MIEN_OK);
    EXPECT_EQ(mien_deformer_instance_deform(instance.get(), 0, MIEN_NORMALS_NONE, nullptr),
              MIEN_OK);
    MienFloatView view = {};
    EXPECT_EQ(mien_deformer_instance_positions(instance.get(), 0, &view), MIEN_OK);
    double sum = 0;
    for (size_t i = 2; i < view.count; i += 3) sum += double{view.data[i]};
    return sum / static_cast<double>(view.count / 3);
  }
};

TEST(FitCorrectives, CombinationShapesAreReachedAtTheirPose) {
  Bumps bumps(true, 1.2);
  const Authored made(bumps);
  const CorrectiveReport& r = made.report.correctives;
  EXPECT_EQ(r.given, 1u);
  EXPECT_EQ(r.made, 0u);
  EXPECT_NEAR(r.before, 0.8 / 1.2, 0.02) << "the sum of both is 2";
  EXPECT_LT(r.joints, 0.3 * r.before);
  EXPECT_LE(r.rig, r.joints);
  const double one = made.height({1, 0});
  EXPECT_NEAR(made.height({1, 1}), 1.2 * one, 0.02 * one);
  EXPECT_NEAR(made.height({0, 1}), one, 0.02 * one) << "inactive with one member";
  EXPECT_NEAR(made.height({0.5f, 0.5f}), (1 - 0.8 / 4) * one, 0.03 * one) << "a product";
  const DnaHandle dna = open_dna(made.bytes);
  EXPECT_EQ(dna->view.defn.raw_control_names.count, 2u);
  EXPECT_EQ(dna->view.bhvr.controls.psd_count, 1u);
}

TEST(FitCorrectives, WithoutBlendShapesJointsDoWhatTheyCan) {
  Bumps bumps(true, 1.2);
  RigOptions options;
  options.residual_targets = false;
  const Authored made(bumps, options);
  EXPECT_EQ(made.report.correctives.rig, made.report.correctives.joints);
  EXPECT_EQ(open_dna(made.bytes)->view.defn.channel_names.count, 0u);
  const double one = made.height({1, 0});
  EXPECT_NEAR(made.height({1, 1}), 1.2 * one, 0.05 * one);
}

TEST(FitCorrectives, OverlapsAreDampedWhereAsked) {
  Bumps bumps(false), again(false);
  const Authored plain(bumps);
  EXPECT_NEAR(plain.height({1, 1}), 2 * plain.height({1, 0}), 0.01);
  EXPECT_EQ(open_dna(plain.bytes)->view.bhvr.controls.psd_count, 0u);
  RigOptions options;
  options.overlap_correctives = 5;
  const Authored damped(again, options);
  EXPECT_EQ(damped.report.correctives.made, 1u);
  const double one = damped.height({1, 0});
  EXPECT_NEAR(damped.height({1, 1}), 1.5 * one, 0.05 * one);
  EXPECT_NEAR(damped.height({0, 1}), one, 0.02 * one);
}

TEST(AddOverlaps, GivenPairsAndTheLimitCount) {
  AuthorSetup head;
  make_author_head(7, 8, 4, 1, head);
  Arena arena(default_allocator());
  const uint32_t members[2] = {0, 1};
  Combination given[1] = {{{"x", 1}, {members, 2}, {}}};
  Span<Combination> few = {given, 1}, many = {given, 1};
  ASSERT_TRUE(add_overlaps(head.mesh, 10, {}, arena, arena, few));
  EXPECT_EQ(few.count, 11u);
  ASSERT_TRUE(add_overlaps(head.mesh, 100000, {}, arena, arena, many));
  EXPECT_GT(many.count, 11u);
  EXPECT_LT(many.count, 52u * 51u / 2);
  for (size_t i = 1; i < many.count; ++i) {
    ASSERT_EQ(many[i].members.count, 2u);
    EXPECT_LT(many[i].members[0], many[i].members[1]);
    EXPECT_FALSE(many[i].members[0] == 0 && many[i].members[1] == 1);
    if (i < few.count) {
      EXPECT_EQ(few[i].members[0], many[i].members[0]) << "strongest first";
    }
  }
}

}  // namespace
}  // namespace mien::author
