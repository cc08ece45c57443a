// SPDX-License-Identifier: MIT
// Authored rigs as files: opened, evaluated and deformed by the library, and compared with the shapes
// that they were made from.
#include "author/rig_dna/author_rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "author/base/exact_math.h"
#include "author/base/random.h"
#include "author/rigging/rigging.h"
#include "tests/support/author_setup.h"
#include "tests/support/mesh_source.h"
#include "tests/support/played_rig.h"

namespace mien::author {
namespace {

/// The small head, authored.
struct Authored {
  AuthorSetup head;
  Arena arena{default_allocator()};
  RigReport report;
  Span<LodMesh> lod_meshes;
  std::vector<uint8_t> bytes;

  explicit Authored(RigOptions options = {}, uint32_t lods = 4, const Frame& frame = {},
                    uint32_t bones = 40, double triangles = 1) {
    make_author_head(5, bones, 6, lods, head);
    head.mesh.frame = frame;
    SimplifyOptions simplify;
    simplify.share = triangles;
    simplify.lods = lods;
    EXPECT_TRUE(make_lod_meshes(head.mesh, simplify, arena, default_allocator(), lod_meshes));
    options.lod_meshes = lod_meshes;
    dna::DnaView view;
    EXPECT_TRUE(author_rig(head.mesh, head.placement, {&head.weights, 1}, options, arena,
                           default_allocator(), report, view));
    bytes = write_view(view);
  }
};

const Authored& authored() {
  static const Authored made;
  return made;
}

TEST(AuthorRig, FilesAreValidWithoutFindings) {
  const std::vector<uint8_t>& bytes = authored().bytes;
  EXPECT_EQ(findings(bytes), 0u);
  EXPECT_TRUE(write_dna(open_dna(bytes).get()) == bytes) << "round trip";
}

TEST(AuthorRig, NeutralIsTheMesh) {
  Played played(authored().bytes);
  for (uint32_t lod = 0; lod < 4; ++lod) {
    played.set(kNone);
    const std::vector<Vec3> points = played.deform(lod);
    ASSERT_EQ(points.size(), authored().head.positions.size());
    for (size_t v = 0; v < points.size(); ++v) {
      EXPECT_LT(length(points[v] - authored().head.positions[v]),
                1e-6 * authored().head.mesh.diagonal);
    }
  }
}

TEST(AuthorRig, AHeadThatTurnsKeepsAllDistancesOfItsFace) {
  Played played(authored().bytes);
  const dna::DnaView& view = played.dna->view;
  std::vector<float> joints(view.defn.joint_names.count * size_t{9});
  const float turned[] = {3, 1, -2, 20, -35, 50};  // of joint 2, the head
  ASSERT_EQ(authored().head.bones[2].kind, BoneKind::kHead);
  std::copy(std::begin(turned), std::end(turned), joints.begin() + 2 * 9);
  ASSERT_EQ(mien_deformer_instance_update_from_values(played.instance.get(), joints.data(),
                                                      joints.size(), nullptr, 0),
            MIEN_OK);
  const std::vector<Vec3> points = played.positions(0);
  std::vector<size_t> face;  // carried by the head and what hangs below it
  for (size_t v = 0; v < points.size(); ++v) {
    const dna::VertexSkinWeights& w = view.geom.meshes[0].skin_weights[v];
    bool below = true;
    for (size_t i = 0; i < w.weights.count; ++i) below = below && w.joint_indices[i] >= 2;
    if (below) face.push_back(v);
  }
  ASSERT_GT(face.size(), 100u);
  double moved = 0;
  for (size_t a : face) {
    moved += length(points[a] - authored().head.positions[a]);
    for (size_t b : face) {
      const double was = length(authored().head.positions[a] - authored().head.positions[b]);
      EXPECT_NEAR(length(points[a] - points[b]), was, 1e-5 * authored().head.mesh.diagonal);
    }
  }
  EXPECT_GT(moved / static_cast<double>(face.size()), 1);
}

TEST(AuthorRig, TheReportTellsTheErrorOfTheEvaluatedFile) {
  Played played(authored().bytes);
  double max = 0;
  EXPECT_NEAR(played.error(authored().head.mesh, 0, &max), authored().report.rig.error, 1e-4);
  EXPECT_NEAR(max, authored().report.rig.max, 1e-5);
  for (uint32_t lod = 1; lod < 4; ++lod) {
    EXPECT_NEAR(played.error(authored().head.mesh, lod), authored().report.lods[lod].error, 1e-4);
  }
}

TEST(AuthorRig, LodsWithFewerTrianglesFollowTheirShapes) {
  const Authored made({}, 4, {}, 40, 0.5);
  EXPECT_EQ(findings(made.bytes), 0u);
  Played played(made.bytes);
  const dna::DnaView& view = played.dna->view;
  ASSERT_EQ(view.geom.meshes.count, 4u);
  for (uint32_t lod = 0; lod < 4; ++lod) {
    const LodReport& report = made.report.lods[lod];
    const dna::Mesh& mesh = view.geom.meshes[lod];
    EXPECT_EQ(mesh.positions.xs.count, report.vertices);
    EXPECT_NEAR(played.error(made.head.mesh, lod, nullptr, made.lod_meshes[lod].vertices),
                report.error, 1e-4);
    for (uint32_t v = 0; v < mesh.skin_weights.count; ++v) {
      double sum = 0;
      for (size_t i = 0; i < mesh.skin_weights[v].weights.count; ++i) {
        sum += double{mesh.skin_weights[v].weights[i]};
      }
      EXPECT_NEAR(sum, 1, 1e-6);
    }
    if (lod == 0) continue;
    EXPECT_EQ(mesh.faces.count, report.triangles);
    EXPECT_LT(report.triangles, made.report.lods[lod - 1].triangles * 55 / 100);
    EXPECT_LT(report.vertices, made.report.lods[lod - 1].vertices * 6 / 10);
    EXPECT_LE(report.surface_rms, report.surface_max);
    EXPECT_GT(report.surface_rms, 0);
    EXPECT_LT(report.joints_error, report.collapsed_error);
  }
  EXPECT_GT(view.geom.meshes[1].blend_shape_targets.count, 0u);
  EXPECT_EQ(view.geom.meshes[2].blend_shape_targets.count, 0u);
}

TEST(AuthorRig, ErrorsFallFromStepToStep) {
  const RigReport& r = authored().report;
  EXPECT_LT(r.rotations.error, r.translations.error);
  EXPECT_LT(r.joints.error, 0.7 * r.rotations.error);
  EXPECT_LT(r.rig.error, r.joints.error);
  EXPECT_LE(r.rig.max, 1.05e-3) << "no offset above the threshold is missing";
  EXPECT_LE(r.joints.median, r.joints.worst);
  for (uint32_t lod = 1; lod < 4; ++lod) {
    EXPECT_LT(r.lods[lod].joints_error, r.lods[lod].collapsed_error);
    EXPECT_GE(r.lods[lod].joints_error, r.lods[lod - 1].joints_error);
  }
}

TEST(AuthorRig, JointGroupsAreFullBlocksOfTheirRegions) {
  RigOptions options;
  options.regions = 4;
  for (bool full : {true, false}) {
    options.full_groups = full;
    const Authored made(options);
    const GroupReport& r = made.report.groups;
    const DnaHandle dna = open_dna(made.bytes);
    uint64_t stored = 0, nonzeros = 0;
    std::vector<int> group_of(dna->view.defn.joint_names.count, -1);
    EXPECT_EQ(dna->view.bhvr.joints.groups.count, r.groups);
    EXPECT_GE(r.groups, 3u);
    for (uint32_t g = 0; g < r.groups; ++g) {
      const dna::JointGroup& group = dna->view.bhvr.joints.groups[g];
      stored += group.values.count;
      for (size_t i = 0; i < group.values.count; ++i) nonzeros += group.values[i] != 0;
      EXPECT_LT(group.input_indices.count, 52u) << "a group with every control";
      for (size_t i = 0; i < group.joint_indices.count; ++i) {
        int& owner = group_of[group.joint_indices[i]];
        EXPECT_EQ(owner, -1) << "a joint in two groups";
        owner = static_cast<int>(g);
      }
    }
    EXPECT_EQ(r.stored, stored);
    EXPECT_EQ(r.nonzeros, nonzeros);
    EXPECT_EQ(r.full, uint64_t{40 * 6 * 52});
    EXPECT_LT(r.stored, r.full);
    EXPECT_GT(r.removed.error, r.before.error);
    EXPECT_LT(r.refitted.error, r.before.error + 0.015);
    EXPECT_GE(r.padding[1], r.padding[0]);
    if (full) {
      EXPECT_GT(nonzeros, stored * 99 / 100);
    } else {
      EXPECT_LT(nonzeros, stored * 95 / 100);
    }
  }
}

TEST(AuthorRig, EveryInstructionSetGivesTheSame) {
  const std::vector<uint32_t> isas = present_isas();
  Played first(authored().bytes, isas[0]);
  for (uint32_t isa : isas) {
    Played other(authored().bytes, isa);
    for (uint32_t lod : {0u, 2u}) {
      for (uint32_t control : {0u, 17u, 33u}) {
        first.set(control);
        other.set(control);
        const std::vector<Vec3> a = first.deform(lod), b = other.deform(lod);
        for (size_t v = 0; v < a.size(); ++v) {
          EXPECT_LT(length(a[v] - b[v]), 2e-6 * authored().head.mesh.diagonal);
        }
      }
    }
  }
}

TEST(AuthorRig, RandomControlsAddUpAsInTheModel) {
  const Authored& a = authored();
  Played played(a.bytes);
  const dna::DnaView& view = played.dna->view;
  Random random = Random::from_seed(1, 9);
  const uint32_t joints = view.defn.joint_names.count;
  for (int round = 0; round < 1000; ++round) {
    std::vector<double> expected(size_t{joints} * 9);
    for (float& value : played.character.raw) {
      value = random.chance(0.5) ? static_cast<float>(random.real()) : 0;
    }
    const uint32_t lod = random.below(4);
    for (const dna::JointGroup& group : view.bhvr.joints.groups) {
      for (uint32_t r = 0; r < group.lods[lod]; ++r) {
        for (uint32_t c = 0; c < group.input_indices.count; ++c) {
          expected[group.output_indices[r]] +=
              double{group.values[size_t{r} * group.input_indices.count + c]} *
              double{played.character.raw[group.input_indices[c]]};
        }
      }
    }
    played.character.evaluate(lod);
    for (size_t i = 0; i < expected.size(); ++i) {
      ASSERT_NEAR(played.character.joints[i], expected[i], 1e-4);
    }
  }
}

TEST(AuthorRig, LodsAreNested) {
  const DnaHandle dna = open_dna(authored().bytes);
  const dna::DnaView& view = dna->view;
  EXPECT_EQ(view.desc.lod_count, 4u);
  for (uint32_t lod = 1; lod < 4; ++lod) {
    const dna::Array<uint16_t> fine = view.defn.lod_joints.at(lod - 1);
    const dna::Array<uint16_t> coarse = view.defn.lod_joints.at(lod);
    EXPECT_LT(coarse.count, fine.count);
    for (size_t i = 0, k = 0; i < coarse.count; ++i) {
      while (k < fine.count && fine[k] != coarse[i]) ++k;
      EXPECT_LT(k, fine.count) << "joint " << coarse[i] << " is new at LOD " << lod;
    }
    EXPECT_EQ(view.defn.lod_meshes.at(lod).count, 1u);
    // Weights name joints of the LOD only.
    for (const dna::VertexSkinWeights& w : view.geom.meshes[lod].skin_weights) {
      for (size_t i = 0; i < w.joint_indices.count; ++i)
        EXPECT_LT(w.joint_indices[i], coarse.count);
    }
  }
  EXPECT_EQ(view.defn.lod_channels.at(0).count, view.defn.channel_names.count);
  EXPECT_EQ(view.defn.lod_channels.at(1).count, (view.defn.channel_names.count + 1) / 2);
  EXPECT_EQ(view.defn.lod_channels.at(2).count, 0u);
}

TEST(AuthorRig, GuiControlsDriveTheExpressionsOfTheirNames) {
  Played played(authored().bytes);
  const std::vector<std::string> gui = names_of(played.rig, MIEN_KIND_GUI_CONTROL);
  const std::vector<std::string> raw = names_of(played.rig, MIEN_KIND_RAW_CONTROL);
  ASSERT_EQ(raw, authored().head.shape_names);
  ASSERT_EQ(gui.size(), raw.size());
  for (size_t i = 0; i < gui.size(); ++i) {
    EXPECT_EQ(gui[i], "CTRL_" + raw[i]);
    for (float& value : played.character.gui) value = 0;
    played.character.gui[i] = 0.75f;
    played.character.map_gui_to_raw();
    for (size_t k = 0; k < raw.size(); ++k) {
      EXPECT_EQ(played.character.raw[k], k == i ? 0.75f : 0.0f);
    }
  }
}

TEST(AuthorRig, WithoutResidualTargetsThereAreNoBlendShapes) {
  RigOptions options;
  options.residual_targets = false;
  const Authored made(options);
  EXPECT_EQ(open_dna(made.bytes)->view.defn.channel_names.count, 0u);
  EXPECT_EQ(made.report.rig.error, made.report.joints.error);
  EXPECT_EQ(made.report.target_count, 0u);
}

TEST(AuthorRig, WeightsOfTheCallerStay) {
  RigOptions options;
  options.keep_weights = true;
  AuthorSetup before;
  make_author_head(5, 40, 6, 4, before);
  const Authored made(options);
  EXPECT_EQ(made.head.weight_values, before.weight_values);
  EXPECT_EQ(made.head.joints, before.joints);
  EXPECT_GT(made.report.joints.error, authored().report.joints.error);
}

TEST(AuthorRig, WithoutShapesThereAreJointsAndMeshes) {
  AuthorSetup head;
  make_author_head(6, 12, 4, 2, head);
  head.displacements.clear();
  head.shape_names.clear();
  head.finish(4);
  Arena arena(default_allocator());
  RigReport report;
  dna::DnaView view;
  ASSERT_TRUE(author_rig(head.mesh, head.placement, {&head.weights, 1}, {}, arena,
                         default_allocator(), report, view));
  Played played(write_view(view));
  EXPECT_EQ(count_of(played.rig, MIEN_KIND_RAW_CONTROL), 0u);
  EXPECT_EQ(played.deform(1).size(), head.positions.size());
}

TEST(AuthorRig, OtherAxesGiveTheSameFace) {
  Frame frame;  // z up, y to the back: x y z of the file are x, -z, y
  frame.axis[0] = 0, frame.axis[1] = 2, frame.axis[2] = 1;
  frame.sign[0] = 1, frame.sign[1] = 1, frame.sign[2] = -1;
  const Authored made({}, 4, frame);
  Played played(made.bytes);
  const dna::FileCoordinateSystem axes = played.dna->view.desc.coordinate_system;
  EXPECT_EQ(axes.x_axis, 0);  // left
  EXPECT_EQ(axes.y_axis, 5);  // back
  EXPECT_EQ(axes.z_axis, 2);  // up
  EXPECT_NEAR(played.error(made.head.mesh, 0), authored().report.rig.error, 1e-4);
  // Opened in the first file's axes, it is the first file's face.
  MienCoordinateSystem system = mien_coordinate_system_default();
  const uint32_t left_up_front[3] = {MIEN_DIRECTION_LEFT, MIEN_DIRECTION_UP, MIEN_DIRECTION_FRONT};
  memcpy(system.axes, left_up_front, sizeof(system.axes));
  const DnaHandle same = open_in_system(made.bytes, system);
  const dna::Vec3Array& p = same->view.geom.meshes[0].positions;
  for (size_t v = 0; v < made.head.positions.size(); ++v) {
    EXPECT_LT(
        length(Vec3{double{p.xs[v]}, double{p.ys[v]}, double{p.zs[v]}} - made.head.positions[v]),
        1e-5);
  }
}

void run_in_threads(void*, uint32_t count, void (*task)(void*, uint32_t), void* context) {
  std::vector<std::thread> threads;
  for (uint32_t t = 0; t < 8; ++t) {
    threads.emplace_back([=] {
      for (uint32_t i = t; i < count; i += 8) task(context, i);
    });
  }
  for (std::thread& t : threads) t.join();
}

TEST(AuthorRig, AnyNumberOfThreadsGivesTheSameBytes) {
  RigOptions options;
  options.parallel = {nullptr, run_in_threads};
  EXPECT_TRUE(Authored(options).bytes == authored().bytes);
}

/// An egg with expressions, of formulas that no other test changes.
void make_egg(AuthorSetup& out) {
  constexpr uint32_t kRows = 24, kColumns = 32;
  const auto vertex = [](uint32_t row, uint32_t column) {
    return row == 0 ? 0 : row == kRows ? 1 : 2 + (row - 1) * kColumns + column % kColumns;
  };
  out.add_vertex({0, 10, 0});
  out.add_vertex({0, -10, 0});
  for (uint32_t r = 1; r < kRows; ++r) {
    const double down = 3.14159265358979 * r / kRows;
    for (uint32_t c = 0; c < kColumns; ++c) {
      const double turn = 2 * 3.14159265358979 * c / kColumns, wide = 7 * exact_sine(down);
      out.add_vertex({wide * exact_sine(turn), 10 * exact_cosine(down), wide * exact_cosine(turn)});
    }
  }
  for (uint32_t r = 0; r < kRows; ++r) {
    for (uint32_t c = 0; c < kColumns; ++c) {
      const uint32_t a = vertex(r, c), b = vertex(r + 1, c), d = vertex(r, c + 1);
      const uint32_t across = vertex(r + 1, c + 1);
      out.add_face(r == 0           ? std::vector<uint32_t>{a, b, across}
                   : r + 1 == kRows ? std::vector<uint32_t>{a, b, d}
                                    : std::vector<uint32_t>{a, b, across, d});
    }
  }
  const Vec3 centers[] = {{0, 0, 7}, {3, 3, 6}, {-3, 3, 6}, {0, -5, 5}};
  for (int s = 0; s < 4; ++s) {
    out.add_shape("shape" + std::to_string(s), [&](uint32_t v) {
      const Vec3 d = out.positions[v] - centers[s];
      return Vec3{0.3 * d.y, 0.5 - 0.1 * d.x, 0.8} * std::max(0.0, 1 - dot(d, d) / 16);
    });
  }
  out.add_trunk();
  for (uint32_t v = 0; v < out.positions.size(); ++v) {
    if (out.positions[v].z <= 1) continue;
    out.mask.push_back(v);
    if (v % 19 == 0) {
      out.add_bone("bone" + std::to_string(v), out.positions[v] * 0.95, BoneKind::kFacial, 3);
    }
  }
  const uint32_t facial = static_cast<uint32_t>(out.bones.size()) - 4;
  out.lod_facial_counts = {facial, facial / 2, facial / 4};
  out.finish(6);
}

uint64_t hash_of(const std::vector<uint8_t>& bytes) {
  uint64_t hash = 14695981039346656037u;
  for (uint8_t b : bytes) hash = (hash ^ b) * 1099511628211u;
  return hash;
}

TEST(AuthorRig, HasTheSameBytesOnEveryPlatform) {
  AuthorSetup egg;
  make_egg(egg);
  Arena arena(default_allocator());
  SimplifyOptions simplify;
  simplify.lods = 3;
  Span<LodMesh> lod_meshes;
  ASSERT_TRUE(make_lod_meshes(egg.mesh, simplify, arena, default_allocator(), lod_meshes));
  RigOptions options;
  options.lod_meshes = lod_meshes;
  RigReport report;
  dna::DnaView view;
  ASSERT_TRUE(author_rig(egg.mesh, egg.placement, {&egg.weights, 1}, options, arena,
                         default_allocator(), report, view));
  EXPECT_LT(report.rig.error, 0.1);
  EXPECT_EQ(hash_of(write_view(view)), 4283830556765198953u)
      << "if rigs were meant to change, record the new number";
}

TEST(AuthorRig, WithBonesThatArePlacedHasTheSameBytesOnEveryPlatform) {
  AuthorSetup egg;
  make_egg(egg);
  TestMesh mesh = mesh_of(egg, true);
  RiggingOptions options;
  options.place.facial_joints = 40;
  options.place.lods = 3;
  Arena arena(default_allocator());
  Rigging rigging;
  Error error;
  ASSERT_EQ(make_rig(mesh.source(), options, arena, default_allocator(), rigging, error),
            Status::kOk)
      << error.message;
  EXPECT_LT(rigging.rig.rig.error, 0.1);
  EXPECT_EQ(hash_of(write_view(rigging.dna)), 7808566059597556418u)
      << "if rigs were meant to change, record the new number";
}

TEST(AuthorRig, StopsWhereItIsToldTo) {
  struct Stop {
    int left;
    static bool go_on(void* user, const char*) { return --static_cast<Stop*>(user)->left >= 0; }
  };
  AuthorSetup head;
  make_author_head(6, 12, 4, 2, head);
  int steps = 0;
  for (bool done = false; !done; ++steps) {
    ASSERT_LT(steps, 20);
    Stop stop = {steps};
    RigOptions options;
    options.user = &stop;
    options.go_on = Stop::go_on;
    Arena arena(default_allocator());
    RigReport report;
    dna::DnaView view;
    done = author_rig(head.mesh, head.placement, {&head.weights, 1}, options, arena,
                      default_allocator(), report, view);
    EXPECT_EQ(report.stopped, !done);
    EXPECT_EQ(view.index.count != 0, done);
  }
  EXPECT_GE(steps, 4);
}

/// Gives out a number of blocks and no more than that.
struct FewBlocks {
  size_t left, live = 0;

  Allocator get() {
    return {this,
            [](void* user, size_t size, size_t alignment) -> void* {
              FewBlocks& self = *static_cast<FewBlocks*>(user);
              if (self.left == 0) return nullptr;
              --self.left;
              ++self.live;
              return default_allocator().get(size, alignment);
            },
            [](void* user, void* block, size_t size, size_t alignment) {
              --static_cast<FewBlocks*>(user)->live;
              default_allocator().put(block, size, alignment);
            }};
  }
};

TEST(AuthorRig, AnyAllocationMayFail) {
  AuthorSetup head;
  make_author_head(7, 8, 4, 2, head);
  const std::vector<float> weights = head.weight_values;
  const std::vector<uint16_t> joints = head.joints;
  bool made = false;
  size_t blocks = 0;
  for (; !made; ++blocks) {
    ASSERT_LT(blocks, 1000u);
    head.weight_values = weights;
    head.joints = joints;
    FewBlocks few = {blocks};
    {
      const Allocator allocator = few.get();
      Arena arena(allocator);
      RigReport report;
      dna::DnaView view;
      made = author_rig(head.mesh, head.placement, {&head.weights, 1}, {}, arena, allocator, report,
                        view);
      EXPECT_FALSE(report.stopped);
    }
    EXPECT_EQ(few.live, 0u);
  }
  EXPECT_GT(blocks, 8u);
}

}  // namespace
}  // namespace mien::author
