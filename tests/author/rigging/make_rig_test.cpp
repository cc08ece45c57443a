// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "author/rigging/rigging.h"
#include "runtime/load/dna/check/dna_check.h"
#include "runtime/load/dna/format/dna_writer.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/mesh_source.h"

namespace mien::author {
namespace {

struct Made {
  Arena arena{default_allocator()};
  Rigging rigging;
  Error error;
  Status status = Status::kOk;
  std::vector<uint8_t> bytes;
  std::string report;

  Made(const Made&) = delete;
  explicit Made(TestMesh mesh, RiggingOptions options = {}, uint32_t joints = 40) {
    options.place.facial_joints = joints;
    const MeshSource source = mesh.source();
    status = make_rig(source, options, arena, default_allocator(), rigging, error);
    if (status != Status::kOk) return;
    bytes.resize(dna::encoded_size(rigging.dna, {}));
    dna::encode(rigging.dna, {}, bytes.data());
    Span<const char> json;
    EXPECT_TRUE(write_report(source, options, rigging, arena, json));
    report.assign(json.data, json.count);
  }
  std::string why() const { return error.message; }
};

void run_on_eight(void*, uint32_t count, void (*task)(void*, uint32_t), void* context) {
  std::vector<std::thread> threads;
  for (uint32_t t = 0; t < 8; ++t) {
    threads.emplace_back([=] {
      for (uint32_t i = count; i-- > 0;) {
        if (i % 8 == t) task(context, i);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

TEST(MakeRig, GivesTheSameBytesOnAnyNumberOfThreads) {
  RiggingOptions options;
  options.place.lods = 3;
  const Made one(procedural_mesh(5, true), options);
  ASSERT_EQ(one.status, Status::kOk) << one.why();
  options.parallel.run = run_on_eight;
  const Made eight(procedural_mesh(5, true), options);
  EXPECT_EQ(one.bytes, eight.bytes);
  EXPECT_EQ(one.report, eight.report);
}

TEST(MakeRig, FittedWeightsAreInOnePieceAndSmooth) {
  RiggingOptions options;
  options.place.lods = 1;
  const Made made(procedural_mesh(5, true), options);
  ASSERT_EQ(made.status, Status::kOk) << made.why();
  const WeightReport& report = made.rigging.fitted_weights;
  EXPECT_EQ(report.split_supports, 0u);
  EXPECT_LE(report.worst_sum, 1e-6);
  EXPECT_LT(report.roughness, 2.6);
  EXPECT_LT(made.rigging.rig.joints.error, 0.1);
}

TEST(MakeRig, WithoutShapesPlacesAndWeighsOnly) {
  const Made made(procedural_mesh(5, false));
  ASSERT_EQ(made.status, Status::kOk) << made.why();
  EXPECT_NE(made.report.find("\"fit\": null"), std::string::npos);
  EXPECT_GT(made.bytes.size(), 1000u);
}

TEST(MakeRig, LeavesOutLooseVerticesAndKeepsTheOrderOfTheOthers) {
  TestMesh mesh = procedural_mesh(5, false);
  TestMesh shifted;
  shifted.vertex(1e6, 0, 0);  // in no face
  shifted.positions.insert(shifted.positions.end(), mesh.positions.begin(), mesh.positions.end());
  shifted.face_sizes = mesh.face_sizes;
  for (const uint32_t corner : mesh.corners) shifted.corners.push_back(corner + 1);
  const Made plain(mesh), with(shifted);
  ASSERT_EQ(with.status, Status::kOk) << with.why();
  EXPECT_EQ(with.rigging.read.loose_vertices, 1u);
  EXPECT_EQ(plain.bytes, with.bytes);
}

TEST(MakeRig, StopsWhereItIsTold) {
  struct Count {
    int left;
    double last;
    static bool go_on(void* user, const char* step, double share) {
      Count& count = *static_cast<Count*>(user);
      EXPECT_NE(step, nullptr);
      EXPECT_GE(share, count.last);
      EXPECT_LE(share, 1);
      count.last = share;
      return count.left-- > 0;
    }
  };
  for (int stop = 0; stop < 200; ++stop) {
    Count count = {stop, 0};
    RiggingOptions options;
    options.place.lods = 2;
    options.user = &count;
    options.go_on = Count::go_on;
    const Made made(procedural_mesh(7, true), options, 10);
    if (made.status == Status::kOk) {
      EXPECT_GT(stop, 4);
      return;
    }
    EXPECT_EQ(made.status, Status::kAuthorCanceled) << stop;
  }
  ADD_FAILURE() << "it never ended";
}

TEST(MakeRig, TakesTheCallersBonesAndWeights) {
  TestMesh mesh = procedural_mesh(5, true);
  const double at[4][3] = {{0, 0, 0}, {0, -5, 0}, {2, -6, 8}, {-2, -6, 8}};
  const char* const names[] = {"root", "head", "left", "right"};
  std::vector<OwnBone> bones;
  for (uint32_t b = 0; b < 4; ++b) {
    OwnBone bone = {{names[b], strlen(names[b])},
                    {at[b][0], at[b][1], at[b][2]},
                    b < 2 ? 0u : 1u,
                    b == 0   ? BoneKind::kRoot
                    : b == 1 ? BoneKind::kHead
                             : BoneKind::kFacial};
    bones.push_back(bone);
  }
  RiggingOptions options;
  options.bones = {bones.data(), bones.size()};
  options.place.lods = 1;
  const Made placed(mesh, options);
  ASSERT_EQ(placed.status, Status::kOk) << placed.why();
  EXPECT_EQ(placed.rigging.placement.bones.count, 4u);

  const size_t n = mesh.positions.size() / 3;
  std::vector<uint16_t> joints(2 * n);
  std::vector<float> weights(2 * n);
  for (size_t v = 0; v < n; ++v) {
    joints[2 * v] = 1;
    joints[2 * v + 1] = mesh.positions[3 * v] > 0 ? 2 : 3;
    weights[2 * v] = 1;
    weights[2 * v + 1] = 3;
  }
  options.influences = 2;
  options.weights = {{joints.data(), joints.size()}, {weights.data(), weights.size()}};
  const Made weighed(mesh, options);
  ASSERT_EQ(weighed.status, Status::kOk) << weighed.why();
  for (uint32_t v = 0; v < n; ++v) {
    EXPECT_FLOAT_EQ(weighed.rigging.weights.weights[2 * v], 0.75f);
    EXPECT_GE(weighed.rigging.weights.joints[2 * v], 2);
  }

  joints[0] = 4;
  EXPECT_EQ(Made(mesh, options).status, Status::kAuthorMesh);
  joints[0] = 1;
  weights[0] = weights[1] = 0;
  EXPECT_EQ(Made(mesh, options).status, Status::kAuthorMesh);
  weights[0] = -1;
  EXPECT_EQ(Made(mesh, options).status, Status::kAuthorMesh);
  options.weights = {};
  const auto refused = [&](uint32_t bone, const OwnBone& as) {
    const OwnBone kept = bones[bone];
    bones[bone] = as;
    const Status status = Made(mesh, options).status;
    bones[bone] = kept;
    return status;
  };
  OwnBone wrong = bones[2];
  wrong.parent = 2;
  EXPECT_EQ(refused(2, wrong), Status::kAuthorMesh);
  wrong = bones[3];
  wrong.name = bones[2].name;
  EXPECT_EQ(refused(3, wrong), Status::kAuthorMesh);
  wrong.name = {"x", 1};
  wrong.position[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refused(3, wrong), Status::kAuthorMesh);
  wrong = bones[1];
  wrong.kind = BoneKind::kFacial;
  EXPECT_EQ(refused(1, wrong), Status::kAuthorRefused) << "facial bones below one that moves";
  wrong.kind = BoneKind::kJaw;
  EXPECT_EQ(refused(1, wrong), Status::kAuthorRefused);
  wrong.kind = BoneKind::kFace;
  EXPECT_EQ(refused(1, wrong), Status::kOk);
  const OwnBone head = bones[1];
  bones[1].kind = BoneKind::kFacial;
  EXPECT_EQ(Made(procedural_mesh(5, false), options).status, Status::kOk) << "nothing moves";
  bones[1] = head;
  wrong.kind = BoneKind::kRoot;
  EXPECT_EQ(refused(1, wrong), Status::kAuthorMesh);
}

/// A root and three facial bones.
std::vector<OwnBone> few_bones() {
  return {{{"root", 4}, {0, 0, 0}, 0, BoneKind::kRoot},
          {{"left", 4}, {3, -5, 8}, 0, BoneKind::kFacial},
          {{"right", 5}, {-3, -5, 8}, 0, BoneKind::kFacial},
          {{"chin", 4}, {0, -9, 8}, 0, BoneKind::kFacial}};
}

TEST(MakeRig, TakesTheCallersGroupsMaskAndLadder) {
  TestMesh mesh = procedural_mesh(5, true);
  const size_t n = mesh.positions.size() / 3;
  std::vector<uint8_t> groups(n), mask(n);
  for (size_t v = 0; v < n; ++v) {
    const double y = mesh.positions[3 * v + 1], z = mesh.positions[3 * v + 2];
    groups[v] = z > 5 ? 0 : z > -4 ? 1 : 2;
    mask[v] = z > 3 && y > 2;  // without what shapes move further down
  }
  RiggingOptions options;
  options.place.lods = 3;
  const uint32_t ladder[] = {40, 13, 13};
  options.place.lod_joints = {ladder, 3};
  options.depth_groups = {groups.data(), n};
  options.mask = {mask.data(), n};
  const Made made(mesh, options);
  ASSERT_EQ(made.status, Status::kOk) << made.why();
  size_t in_mask = 0, sizes = 0;
  for (size_t v = 0; v < n; ++v) in_mask += mask[v];
  EXPECT_EQ(made.rigging.placement.mask.count, in_mask);
  for (const uint32_t v : made.rigging.placement.mask) {
    EXPECT_TRUE(mask[made.rigging.read.source_vertices[v]]);
  }
  for (uint32_t g = 0; g < 3; ++g) sizes += made.rigging.place.group_sizes[g];
  EXPECT_LE(sizes, n);
  EXPECT_GT(made.rigging.place.group_sizes[0], 0u);
  EXPECT_EQ(made.rigging.place.border_count, 0u);
  const Span<const uint32_t> counts = made.rigging.placement.lod_facial_counts;
  EXPECT_EQ(counts[0], 40u);
  EXPECT_GE(counts[1], 12u);
  EXPECT_LE(counts[1], 13u);
  EXPECT_EQ(counts[2], counts[1]);

  groups[7] = 3;
  EXPECT_EQ(Made(mesh, options).status, Status::kAuthorMesh);
  groups[7] = 0;
  std::fill(mask.begin(), mask.end(), uint8_t{0});
  EXPECT_EQ(Made(mesh, options).status, Status::kAuthorRefused);
}

TEST(MakeRig, GroupsInSpaceOnlyWhereItIsTold) {
  RiggingOptions options;
  options.place.group_in_space = true;
  const Made space(procedural_mesh(5, false), options), depth(procedural_mesh(5, false));
  ASSERT_EQ(space.status, Status::kOk) << space.why();
  EXPECT_EQ(space.rigging.place.border_count, 0u);
  EXPECT_EQ(depth.rigging.place.border_count, 2u);
  EXPECT_NE(space.rigging.place.group_sizes[0], depth.rigging.place.group_sizes[0]);
}

TEST(MakeRig, WritesTheCallersMotionsAndJointGroupsAsTheyAre) {
  TestMesh mesh = procedural_mesh(5, true);
  mesh.shape_names.resize(2);
  mesh.displacements.resize(2);
  mesh.unit = 10;
  for (double& x : mesh.positions) x /= 10;
  std::vector<OwnBone> bones = few_bones();
  for (OwnBone& bone : bones) {
    for (double& x : bone.position) x /= 10;
  }
  std::vector<double> motions(2 * 4 * 6);
  for (size_t b = 1; b < 4; ++b) {
    motions[(4 + b) * 6 + 0] = 0.125 * static_cast<double>(b);  // the second shape
    motions[(4 + b) * 6 + 5] = 7;
  }
  const uint32_t groups[] = {0, 200, 9, 200};
  RiggingOptions options;
  options.place.lods = 1;
  options.bones = {bones.data(), bones.size()};
  options.bone_motions = {motions.data(), motions.size()};
  options.bone_groups = {groups, 4};
  const Made made(mesh, options);
  ASSERT_EQ(made.status, Status::kOk) << made.why();
  const dna::List<dna::JointGroup>& found = made.rigging.dna.bhvr.joints.groups;
  ASSERT_EQ(found.count, 2u);
  EXPECT_EQ(found[0].joint_indices.count, 1u);  // group 9
  EXPECT_EQ(found[0].joint_indices[0], 2u);
  ASSERT_EQ(found[1].output_indices.count, 4u);
  EXPECT_EQ(found[1].output_indices[0], 9u);
  ASSERT_EQ(found[1].input_indices.count, 1u);
  EXPECT_EQ(found[1].input_indices[0], 1u);
  EXPECT_EQ(found[1].values[0], 1.25f);  // centimeters
  EXPECT_EQ(found[1].values[1], 7.0f);
  EXPECT_EQ(found[1].values[2], 3.75f);
  EXPECT_EQ(made.rigging.rig.groups.pruned.outliers, 0u);

  motions[0] = 1;
  EXPECT_EQ(Made(mesh, options).status, Status::kAuthorMesh) << "the root does not move";
  motions[0] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(Made(mesh, options).status, Status::kAuthorMesh);
  motions[0] = 0;
  const uint32_t too_many[] = {0, 1, 256, 3};
  options.bone_groups = {too_many, 4};
  EXPECT_EQ(Made(mesh, options).status, Status::kAuthorMesh);
}

/// Every second face of the mesh as triangles, but those of `without`.
std::vector<uint32_t> half_of(const TestMesh& mesh, uint32_t without = kNone) {
  std::vector<uint32_t> out;
  size_t first = 0;
  for (uint32_t f = 0; f < mesh.face_sizes.size(); first += mesh.face_sizes[f++]) {
    const bool is_in = without < mesh.objects.size() && f >= mesh.objects[without].first_face &&
                       f < mesh.objects[without].first_face + mesh.objects[without].face_count;
    if (f % 2 || is_in) continue;
    for (size_t k = 2; k < mesh.face_sizes[f]; ++k) {
      for (const size_t c : {first, first + k - 1, first + k}) out.push_back(mesh.corners[c]);
    }
  }
  return out;
}

TEST(MakeRig, TakesTheCallersMeshesOfLods) {
  TestMesh mesh = procedural_mesh(5, true);
  const uint32_t faces = static_cast<uint32_t>(mesh.face_sizes.size());
  add_sphere(mesh, 0, -2, 2, 1);
  const uint32_t all = static_cast<uint32_t>(mesh.face_sizes.size());
  mesh.objects = {{{"head", 4}, 0, faces}, {{"ball", 4}, faces, all - faces}};
  for (std::vector<double>& shape : mesh.displacements) shape.resize(mesh.positions.size());
  const std::vector<uint32_t> first = half_of(mesh), second = half_of(mesh, 1);
  const LodSource lods[] = {{{first.data(), first.size()}, {}},
                            {{second.data(), second.size()}, {}}};
  RiggingOptions options;
  options.place.lods = 3;
  options.lod_meshes = {lods, 2};
  const Made made(mesh, options);
  ASSERT_EQ(made.status, Status::kOk) << made.why();
  EXPECT_EQ(made.rigging.rig.lods[1].triangles, first.size() / 3);
  EXPECT_EQ(made.rigging.rig.lods[2].triangles, second.size() / 3);
  EXPECT_GT(made.rigging.rig.lods[1].surface_max, 0);
  EXPECT_LT(made.rigging.rig.lods[1].joints_error, 0.6);
  const dna::Definition& names = made.rigging.dna.defn;
  ASSERT_EQ(names.mesh_names.count, 5u) << "the ball is not in LOD 2";
  const char* const expected[] = {"head_lod0_mesh", "ball_lod0_mesh", "head_lod1_mesh",
                                  "ball_lod1_mesh", "head_lod2_mesh"};
  for (uint32_t m = 0; m < 5; ++m) {
    EXPECT_EQ(std::string(names.mesh_names[m].chars(), names.mesh_names[m].count), expected[m]);
  }
  ASSERT_EQ(names.lod_meshes.indices.count, 3u);
  EXPECT_EQ(names.lod_meshes.indices[2].count, 1u);
  EXPECT_EQ(names.lod_meshes.indices[2][0], 4u);

  options.parallel.run = run_on_eight;
  EXPECT_EQ(made.bytes, Made(mesh, options).bytes);
  std::vector<uint32_t> wrong = first;
  wrong[7] = 1u << 31;
  const LodSource spoiled[] = {lods[0], {{wrong.data(), wrong.size()}, {}}};
  options.lod_meshes = {spoiled, 2};
  EXPECT_EQ(Made(mesh, options).status, Status::kAuthorMesh);
}

TEST(MakeRig, MakesCorrectivesForPairsThatOverlapWhereItIsTold) {
  RiggingOptions options;
  options.place.lods = 1;
  const Made without(procedural_mesh(6, true), options, 20);
  EXPECT_EQ(without.rigging.rig.correctives.made, 0u);
  options.overlap_correctives = 3;
  const Made with(procedural_mesh(6, true), options, 20);
  ASSERT_EQ(with.status, Status::kOk) << with.why();
  EXPECT_EQ(with.rigging.rig.correctives.made, 3u);
  EXPECT_EQ(with.rigging.dna.bhvr.controls.psd_count, 3u);
}

TEST(MakeRig, NamesWhatIsWrongWithAMesh) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    const char* what;
    Status status;
    void (*spoil)(TestMesh& mesh, double nan);
  } const cases[] = {
      {"position 7", Status::kAuthorMesh, [](TestMesh& m, double x) { m.positions[22] = x; }},
      {"corner 5", Status::kAuthorMesh, [](TestMesh& m, double) { m.corners[5] = 1u << 30; }},
      {"face 2", Status::kAuthorMesh, [](TestMesh& m, double) { m.face_sizes[2] = 2; }},
      {"beyond", Status::kAuthorMesh, [](TestMesh& m, double) { m.face_sizes.back() += 1; }},
      {"corners", Status::kAuthorMesh,
       [](TestMesh& m, double) { m.corners.resize(m.corners.size() + 3); }},
      {"no faces", Status::kAuthorRefused,
       [](TestMesh& m, double) {
         m.face_sizes.clear();
         m.corners.clear();
       }},
      {"flat", Status::kAuthorRefused,
       [](TestMesh& m, double) {
         for (size_t i = 2; i < m.positions.size(); i += 3) m.positions[i] = 4;
       }},
      {"0 cm of 0 cm", Status::kAuthorRefused,
       [](TestMesh& m, double) {
         for (size_t i = 0; i < m.positions.size(); ++i) m.positions[i] = 1;
       }},
      {"fewer than 3", Status::kAuthorRefused,
       [](TestMesh& m, double) {
         for (uint32_t& corner : m.corners) corner = 3;
       }},
      {"shape 0", Status::kAuthorMesh, [](TestMesh& m, double x) { m.displacements[0][5] = x; }},
      {"shape 1", Status::kAuthorMesh, [](TestMesh& m, double) { m.displacements[1].resize(9); }},
      {"two shapes", Status::kAuthorMesh,
       [](TestMesh& m, double) { m.shape_names[1] = m.shape_names[0]; }},
      {"name of shape", Status::kAuthorMesh, [](TestMesh& m, double) { m.shape_names[0] = ""; }},
      {"object 0", Status::kAuthorMesh,
       [](TestMesh& m, double) {
         m.objects = {{{"a", 1}, 1, 5}};
       }},
  };
  for (const Case& one : cases) {
    TestMesh mesh = procedural_mesh(6, true);
    one.spoil(mesh, nan);
    const Made made(mesh);
    EXPECT_EQ(made.status, one.status) << one.what;
    EXPECT_NE(made.why().find(one.what), std::string::npos) << one.what << ": " << made.why();
  }
}

TEST(MakeRig, TakesBrokenButUsableMeshes) {
  TestMesh mesh = procedural_mesh(6, false);
  for (int i = 0; i < 3; ++i) mesh.face({mesh.corners[0], mesh.corners[1], mesh.corners[2]});
  mesh.face({5, 5, 6, 7});
  mesh.face({5, 5, 6});
  mesh.face({1, 2, 40});  // an edge of many faces
  const Made made(mesh);
  EXPECT_EQ(made.status, Status::kOk) << made.why();
  EXPECT_EQ(made.rigging.read.dropped_faces, 1u);
}

TEST(MakeRig, SaysWhenMemoryRunsOut) {
  TestMesh mesh = procedural_mesh(7, true);
  for (size_t fail_at = 1; fail_at < 400; fail_at += fail_at < 40 ? 1 : 13) {
    CountingAllocator counting;
    counting.fail_at = fail_at;
    const MienAllocator given = counting.get();
    const Allocator allocator = {given.user, given.allocate, given.release};
    Status status;
    {
      Arena arena(allocator);
      Rigging rigging;
      Error error;
      RiggingOptions options;
      options.place.facial_joints = 12;
      options.place.lods = 2;
      status = make_rig(mesh.source(), options, arena, allocator, rigging, error);
    }
    EXPECT_TRUE(counting.clean()) << fail_at << " " << counting.first_wrong;
    EXPECT_EQ(status, counting.failed ? Status::kMemory : Status::kOk) << fail_at;
    if (status == Status::kOk) return;
  }
}

}  // namespace
}  // namespace mien::author
