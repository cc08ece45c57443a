// SPDX-License-Identifier: MIT
// Landmarks of heads: found where they are, also on a turned mesh; those of the caller
// win; what is not there is not found. And jaws that are placed by them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/mesh_source.h"
#include "tests/support/posed_skeleton.h"
#include "tests/support/real_meshes.h"

namespace mien::author {
namespace {

using Kind = LandmarkKind;

struct MarkedHead {
  Arena arena{default_allocator()};
  Rigging rigging;
  Error error;
  Status status = Status::kOk;

  explicit MarkedHead(TestMesh mesh, const std::vector<OwnLandmark>& given = {}) {
    RiggingOptions options;
    options.place.facial_joints = 40;
    options.place.lods = 1;
    options.landmarks = {given.data(), given.size()};
    const MeshSource source = mesh.source();
    status = make_rig(source, options, arena, default_allocator(), rigging, error);
  }
  const Landmark& operator[](Kind kind) const { return rigging.place.landmarks[kind]; }
  bool has(const char* bone) const { return bone_named(rigging, bone) != 0; }
  Vec3 bone(const char* name) const {
    return rigging.placement.bones[bone_named(rigging, name)].position;
  }
};

OwnLandmark landmark(const char* name, double x, double y, double z) {
  return {{name, strlen(name)}, {x, y, z}};
}

/// The generated head with its jaw open at rest, as some scans are; with shapes, jawOpen does the rest of the way.
TestMesh open_head(double share, bool with_shapes = false) {
  TestMesh mesh = procedural_mesh(3, true);
  const size_t open =
      static_cast<size_t>(std::find(mesh.shape_names.begin(), mesh.shape_names.end(), "jawOpen") -
                          mesh.shape_names.begin());
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    mesh.positions[i] += share * mesh.displacements[open][i];
    mesh.displacements[open][i] *= 1 - share;
  }
  if (!with_shapes) {
    mesh.shape_names.clear();
    mesh.displacements.clear();
  }
  return mesh;
}

TEST(Landmarks, OfAGeneratedHeadAreWhereItHasThem) {
  const MarkedHead head(procedural_mesh(2, true));
  ASSERT_EQ(head.status, Status::kOk) << head.error.message;
  for (const Kind kind : {Kind::kNose, Kind::kThroat, Kind::kLipUpper, Kind::kLipLower,
                          Kind::kMouthLeft, Kind::kMouthRight, Kind::kChin, Kind::kJaw}) {
    EXPECT_TRUE(head[kind].known && !head[kind].given) << int(kind);
    EXPECT_GT(head[kind].confidence, 0.6) << int(kind);
  }
  EXPECT_NEAR(head[Kind::kNose].at.y, -2.7, 0.4);
  EXPECT_NEAR(head[Kind::kLipUpper].at.y, -6.1, 0.3);
  EXPECT_NEAR(head[Kind::kLipLower].at.y, -6.1, 0.3);
  EXPECT_NEAR(head[Kind::kMouthLeft].at.x, 2.5, 0.4);
  EXPECT_NEAR(head[Kind::kMouthRight].at.x, -head[Kind::kMouthLeft].at.x, 0.1);
  EXPECT_NEAR(head[Kind::kChin].at.y, -9.5, 0.6);
  EXPECT_FALSE(head[Kind::kEyeLeft].known) << "its skin has no eyeballs";
}

double distance_between(Vec3 a, const TestMesh& mesh, size_t vertex) {
  const double* p = &mesh.positions[3 * vertex];
  return length(a - Vec3{p[0], p[1], p[2]});
}

/// The vertex nearest to the landmark, on this side of it if the side is not 0.
size_t nearest_vertex(const TestMesh& mesh, Vec3 at, int side) {
  size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (size_t v = 0; v < mesh.positions.size() / 3; ++v) {
    if (side * (mesh.positions[3 * v + 1] - at.y) < 0) continue;
    const double off = distance_between(at, mesh, v);
    if (off >= least) continue;
    least = off;
    best = v;
  }
  return best;
}

/// Landmarks of a mouth that hardly gapes are compared with those of the same mouth wide open at rest: they are at
/// the same vertices.
void expect_marks_move_with_the_mouth(TestMesh mesh, const char* name, const char* opens) {
  const size_t open =
      static_cast<size_t>(std::find(mesh.shape_names.begin(), mesh.shape_names.end(), opens) -
                          mesh.shape_names.begin());
  ASSERT_LT(open, mesh.shape_names.size());
  const std::vector<double> way = mesh.displacements[open];
  const std::vector<double> closed = mesh.positions;
  mesh.shape_names.clear();
  mesh.displacements.clear();
  const struct {
    Kind kind;
    int side;
    double close;  // in centimeters
  } marks[] = {{Kind::kLipUpper, 1, 0.6},   {Kind::kLipLower, -1, 0.4},
               {Kind::kMouthLeft, 0, 0.72}, {Kind::kMouthRight, 0, 0.72},
               {Kind::kChin, 0, 0.8},       {Kind::kNose, 0, 0.8}};
  size_t vertices[std::size(marks)] = {};
  Vec3 jaw, throat;
  for (const double share : {0.05, 0.4, 0.7, 1.0}) {
    for (size_t i = 0; i < closed.size(); ++i) mesh.positions[i] = closed[i] + share * way[i];
    const MarkedHead head(mesh);
    ASSERT_EQ(head.status, Status::kOk) << head.error.message;
    ASSERT_TRUE(head.has("jaw")) << name << " " << share;
    for (size_t m = 0; m < std::size(marks); ++m) {
      const Landmark& mark = head[marks[m].kind];
      EXPECT_GT(mark.confidence, 0.6) << name << " " << share << " " << m;
      if (share == 0.05) vertices[m] = nearest_vertex(mesh, mark.at, marks[m].side);
      EXPECT_LT(distance_between(mark.at, mesh, vertices[m]), marks[m].close)
          << name << " " << share << " " << m;
    }
    if (share == 0.05) {
      jaw = head.bone("jaw");
      throat = head[Kind::kThroat].at;
    }
    const double off = length(head.bone("jaw") - jaw);
    printf("%s: open by %.0f %%, the jaw is %.2f cm from where it is found when closed\n", name,
           100 * share, off);
    EXPECT_LT(off, 1.6);
    ASSERT_TRUE(head.rigging.place.throat.found);
    // It is below the chin, not in the mouth, and no farther down than the chin moved.
    EXPECT_LT(head[Kind::kThroat].at.y, head[Kind::kChin].at.y);
    EXPECT_LT(std::abs(head[Kind::kThroat].at.y - throat.y), 3.2);
  }
}

TEST(Landmarks, OfAnOpenMouthAreWhereItsLipsAre) {
  for (const uint32_t lod : {2u, 3u}) {
    expect_marks_move_with_the_mouth(procedural_mesh(lod, true), "generated", "jawOpen");
  }
}

TEST(Landmarks, OfRealOpenMouthsAreWhereTheirLipsAre) {
  AuthorSetup ict, makehuman;
  if (!load_ict(ict) || !load_makehuman(makehuman)) {
    GTEST_SKIP() << "NOT TESTED: open mouths of real heads; there is no $MIEN_SHARED/data/meshes";
  }
  expect_marks_move_with_the_mouth(mesh_of(ict, true), "ict", "jawOpen");
  expect_marks_move_with_the_mouth(mesh_of(makehuman, true), "makehuman", "mouth-open");
}

TEST(Landmarks, DoNotDependOnTheAxesAndTheOrder) {
  TestMesh turned = procedural_mesh(2, true);
  const MarkedHead straight(turned);
  // Z up, the face to -Y, in millimeters.
  turned.transform([](double x, double y, double z) {
    return std::array<double, 3>{10 * x, -10 * z, 10 * y};
  });
  turned.unit = 0.1;
  turned.frame = {{0, 2, 1}, {1, 1, -1}};
  turned.shuffle(5);
  const MarkedHead other(turned);
  ASSERT_EQ(straight.status, Status::kOk);
  ASSERT_EQ(other.status, Status::kOk) << other.error.message;
  for (uint32_t k = 0; k < kLandmarkCount; ++k) {
    const Landmark &a = straight.rigging.place.landmarks.of[k],
                   &b = other.rigging.place.landmarks.of[k];
    ASSERT_EQ(a.known, b.known) << kLandmarkNames[k];
    EXPECT_LT(length(a.at - b.at), 0.01) << kLandmarkNames[k];
    EXPECT_NEAR(a.confidence, b.confidence, 0.02) << kLandmarkNames[k];
  }
}

TEST(Landmarks, OfTheCallerWin) {
  const MarkedHead head(procedural_mesh(3, true),
                        {landmark("jaw", 0, -1.2, 0.9), landmark("head", 0, -12, -1),
                         landmark("neck", 0, -16, -1), landmark("eye_l", 3.1, 0.2, 6.5),
                         landmark("throat", 0, -12.5, 4), landmark("nose", 0, -3.2, 11.5)});
  ASSERT_EQ(head.status, Status::kOk) << head.error.message;
  EXPECT_LT(length(head.bone("jaw") - Vec3{0, -1.2, 0.9}), 1e-9);
  EXPECT_LT(length(head.bone("head") - Vec3{0, -12, -1}), 1e-9);
  EXPECT_LT(length(head.bone("neck") - Vec3{0, -16, -1}), 1e-9);
  EXPECT_LT(length(head.bone("eye_l") - Vec3{3.1, 0.2, 6.5}), 1e-9);
  EXPECT_LT(length(head.bone("eye_r") - Vec3{-3.1, 0.2, 6.5}), 0.05) << "its mirror image";
  EXPECT_EQ(head.rigging.placement.neck_cut.y, -12.5);
  EXPECT_EQ(head[Kind::kNose].at.y, -3.2);
  for (const Kind kind : {Kind::kJaw, Kind::kHead, Kind::kNeck, Kind::kEyeLeft, Kind::kThroat}) {
    EXPECT_TRUE(head[kind].given);
    EXPECT_EQ(head[kind].confidence, 1);
  }
  EXPECT_FALSE(head[Kind::kChin].given);
}

TEST(Landmarks, ThatContradictThemselvesOrTheMeshAreRefused) {
  const struct {
    std::vector<OwnLandmark> given;
    Status status;
    const char* why;
  } cases[] = {
      {{landmark("chin", 0, -95, 95)}, Status::kAuthorRefused, "outside the head"},
      {{landmark("mouth_l", -2, -6, 9), landmark("mouth_r", 2, -6, 9)},
       Status::kAuthorRefused,
       "not on the character's left of mouth_r"},
      {{landmark("nose", 0, -7, 11), landmark("lip_upper", 0, -6, 10)},
       Status::kAuthorRefused,
       "lip_upper is not below nose"},
      {{landmark("throat", 0, -6, 4), landmark("lip_lower", 0, -7, 9)},
       Status::kAuthorRefused,
       "throat is not below lip_lower"},
      {{landmark("nostril", 0, -3, 11)}, Status::kAuthorMesh, "\"nostril\" is unknown"},
      {{landmark("nose", 0, -3, 11), landmark("nose", 0, -3, 11)},
       Status::kAuthorMesh,
       "given twice"},
      {{landmark("jaw", 0, std::numeric_limits<double>::quiet_NaN(), 0)},
       Status::kAuthorMesh,
       "not at a number"},
      {{landmark("jaw", std::numeric_limits<double>::infinity(), 0, 0)},
       Status::kAuthorMesh,
       "not at a number"},
  };
  for (const auto& one : cases) {
    const MarkedHead head(procedural_mesh(3, false), one.given);
    EXPECT_EQ(head.status, one.status) << one.why;
    EXPECT_NE(std::string(head.error.message).find(one.why), std::string::npos)
        << head.error.message;
  }
}

TEST(Landmarks, OfWhatIsNoFaceAreNotCertain) {
  TestMesh ball;
  add_sphere(ball, 0, 0, 0, 10, 40, 48);
  const MarkedHead head(ball);
  ASSERT_EQ(head.status, Status::kOk) << head.error.message;
  EXPECT_LT(head[Kind::kNose].confidence, 0.1);
  EXPECT_FALSE(head.has("jaw"));
  EXPECT_FALSE(head.has("eye_l"));
  EXPECT_LT(head[Kind::kHead].confidence, 0.35);
}

/// Turned alone it opens the mouth. The lower lip follows at least by this share; facial joints do the rest.
void expect_a_jaw(const MarkedHead& head, const char* name, double least_of_lip = 0.8) {
  ASSERT_EQ(head.status, Status::kOk) << head.error.message;
  ASSERT_TRUE(head.has("jaw"));
  const Landmark& upper = head[Kind::kLipUpper];
  const Landmark &lower = head[Kind::kLipLower], &chin = head[Kind::kChin];
  const Rigging& rig = head.rigging;
  const uint32_t jaw = bone_named(rig, "jaw");
  const Span<const Vec3> rest = rig.read.mesh.positions;
  const std::vector<Vec3> posed = turned(rig, jaw, {20, 0, 0});
  const auto motion_near = [&](Vec3 at, int side) {
    double best = 1e9, way = 0;
    for (uint32_t v = 0; v < rest.count; ++v) {
      const double off = length(rest[v] - at);
      if (!rig.read.mesh.is_skin[v] || side * (rest[v].y - at.y) < 0 || !(off < best)) continue;
      best = off;
      way = length(posed[v] - rest[v]);
    }
    return way;
  };
  const double whole = length(motion(std::array<double, 3>{20, 0, 0}.data(),
                                     rig.placement.bones[jaw].position, {})(chin.at) -
                              chin.at);
  const double of_chin = motion_near(chin.at, -1) / whole;
  const double of_lower = motion_near(lower.at, -1) / whole;
  const double of_upper = motion_near(upper.at, 1) / whole;
  double above = 0;
  for (uint32_t v = 0; v < rest.count; ++v) {
    if (rest[v].y > head[Kind::kNose].at.y + 1) {
      above = std::max(above, length(posed[v] - rest[v]) / whole);
    }
  }
  printf(
      "%s: of the jaw's motion the chin takes %.2f, lower lip %.2f, upper lip %.2f, above %.2f\n",
      name, of_chin, of_lower, of_upper, above);
  EXPECT_GT(of_chin, 0.9);
  EXPECT_GT(of_lower, least_of_lip);
  EXPECT_LT(of_upper, 0.15);
  EXPECT_LT(above, 0.12);
  const PlaceReport& place = rig.place;
  EXPECT_EQ(std::string(place.jaw_shape.data, place.jaw_shape.count), "jawOpen");
  // A control that was added does the same.
  if (rig.read.mesh.shapes.count == 1) {
    EXPECT_LT(rig.rig.joints.shapes[0].error, 0.06);
  }
}

TEST(JawByLandmarks, OpensTheMouthOfMeshesWithoutShapes) {
  expect_a_jaw(MarkedHead(open_head(0.05)), "generated");
  expect_a_jaw(MarkedHead(open_head(0.7)), "generated, wide open");
}

TEST(JawByShapes, OpensAMouthThatIsOpenAtRest) {
  const TestMesh gap = open_head(0.05, true), wide = open_head(0.6, true);
  const MarkedHead closed(gap), open(wide);
  expect_a_jaw(closed, "with shapes", 0.75);
  expect_a_jaw(open, "with shapes, open at rest", 0.75);
  EXPECT_LT(length(open.bone("jaw") - closed.bone("jaw")), 1.6);
  EXPECT_LT(open[Kind::kThroat].at.y, open[Kind::kChin].at.y);
  const struct {
    Kind kind;
    int side;
  } marks[] = {{Kind::kLipUpper, 1}, {Kind::kLipLower, -1}, {Kind::kChin, 0}, {Kind::kNose, 0}};
  for (const auto& mark : marks) {
    const size_t vertex = nearest_vertex(gap, closed[mark.kind].at, mark.side);
    EXPECT_LT(distance_between(open[mark.kind].at, wide, vertex), 0.8) << int(mark.kind);
  }
  printf("error %.4f, %.4f open\n", closed.rigging.rig.rig.error, open.rigging.rig.rig.error);
  // In shares of the motion, of which jawOpen has less left.
  EXPECT_LT(open.rigging.rig.rig.error, 1.5 * closed.rigging.rig.rig.error);
}

TEST(JawByLandmarks, OfRealHeadsIsNearTheOneThatShapesTell) {
  for (const char* name : {"ict", "makehuman"}) {
    AuthorSetup setup;
    if (!(name[0] == 'i' ? load_ict(setup) : load_makehuman(setup))) {
      GTEST_SKIP() << "NOT TESTED: jaws of real heads; there is no $MIEN_SHARED/data/meshes";
    }
    const MarkedHead head(mesh_of(setup, false));
    expect_a_jaw(head, name);
    // With shapes the jaw is at (0, -0.5, 1.8) and at (0, 69.6, 6.4).
    const Vec3 told = name[0] == 'i' ? Vec3{0, -0.54, 1.81} : Vec3{0, 69.55, 6.41};
    EXPECT_LT(length(head.bone("jaw") - told), 1.0) << name;
  }
}

TEST(JawByLandmarks, NeedsAMouthOrLandmarks) {
  TestMesh shapes = procedural_mesh(3, true);
  shapes.shape_names.resize(1);  // one that has nothing to do with the jaw
  shapes.displacements.resize(1);
  const MarkedHead without(shapes);
  ASSERT_EQ(without.status, Status::kOk) << without.error.message;
  EXPECT_FALSE(without.has("jaw")) << "shapes are given, and none opens it";
  const MarkedHead given(shapes, {landmark("jaw", 0, -1.6, 0.4)});
  ASSERT_EQ(given.status, Status::kOk) << given.error.message;
  EXPECT_TRUE(given.has("jaw"));
  EXPECT_EQ(given.rigging.read.mesh.shapes.count, 2u) << "and one is added";
}

}  // namespace
}  // namespace mien::author
