// SPDX-License-Identifier: MIT
#include "author/rigging/gaze_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "author/rigging/rigging.h"
#include "runtime/load/dna/format/dna_writer.h"
#include "runtime/probe/probe_gaze.h"
#include "tests/support/mesh_source.h"
#include "tests/support/played_rig.h"
#include "tests/support/posed_skeleton.h"

namespace mien::author {
namespace {

bool reads(const std::string& name, GazeName& out) {
  return read_gaze_name({name.data(), name.size()}, out);
}

TEST(GazeShapes, NamesAreReadInTheUsualSpellings) {
  const struct {
    const char* name;
    bool left, right;
    GazeWay of_left, of_right;
  } known[] = {
      {"eyeLookOutLeft", true, false, kLookLeft, kLookLeft},
      {"eyeLookIn_L", true, false, kLookRight, kLookRight},
      {"EyeLookInRight", false, true, kLookLeft, kLookLeft},
      {"CTRL_expressions.eyeLookLeftR", false, true, kLookLeft, kLookLeft},
      {"eye_look_up_r", false, true, kLookUp, kLookUp},
      {"leftEyeLookDown", true, false, kLookDown, kLookDown},
      {"lookRight", true, true, kLookRight, kLookRight},
      {"lookUp", true, true, kLookUp, kLookUp},
  };
  for (const auto& k : known) {
    GazeName name;
    ASSERT_TRUE(reads(k.name, name)) << k.name;
    EXPECT_EQ(name.of_eye[0], k.left) << k.name;
    EXPECT_EQ(name.of_eye[1], k.right) << k.name;
    if (k.left) {
      EXPECT_EQ(name.way_of(0), k.of_left) << k.name;
    }
    if (k.right) {
      EXPECT_EQ(name.way_of(1), k.of_right) << k.name;
    }
  }
  GazeName name;
  for (const char* other :
       {"", "eyeBlinkLeft", "eyeLook", "lookAt", "overlook", "eyeLookUpwards"}) {
    EXPECT_FALSE(reads(other, name)) << other;
  }
  EXPECT_FALSE(reads(std::string(300, 'x'), name));
}

struct EyesRig {
  TestMesh mesh;
  size_t skin = 0, left_end = 0;  // vertices
  Arena arena{default_allocator()};
  Rigging rigging;
  std::vector<uint8_t> bytes;

  explicit EyesRig(bool with_shapes) : mesh(procedural_mesh(4, with_shapes)) {
    skin = mesh.positions.size() / 3;
    add_sphere(mesh, 3.2, 1, 7.15, 1.22);
    left_end = mesh.positions.size() / 3;
    add_sphere(mesh, -3.2, 1, 7.15, 1.22);
    for (std::vector<double>& shape : mesh.displacements) shape.resize(mesh.positions.size());
  }
  void make() {
    RiggingOptions options;
    options.place.facial_joints = 40;
    options.place.lods = 1;
    Error error;
    ASSERT_EQ(make_rig(mesh.source(), options, arena, default_allocator(), rigging, error),
              Status::kOk)
        << error.message;
    bytes.resize(dna::encoded_size(rigging.dna, {}));
    dna::encode(rigging.dna, {}, bytes.data());
  }
  uint32_t control(Name name) const {
    const dna::List<dna::String> names = rigging.dna.defn.raw_control_names;
    for (uint32_t c = 0; c < names.count; ++c) {
      if (std::string(names[c].chars(), names[c].count) == std::string(name.data, name.count)) {
        return c;
      }
    }
    return kNone;
  }
};

void expect_eyes_turn(const EyesRig& rig, GazeSource source) {
  Played played(rig.bytes);
  played.set(kNone);
  const std::vector<Vec3> rest = played.deform(0);
  for (uint32_t e = 0; e < 2; ++e) {
    const GazeEye& eye = rig.rigging.gaze.eyes[e];
    ASSERT_NE(eye.bone, kNone);
    const size_t first = e == 0 ? rig.skin : rig.left_end;
    const size_t end = e == 0 ? rig.left_end : rest.size();
    for (uint32_t way = 0; way < kGazeWays; ++way) {
      EXPECT_EQ(eye.sources[way], source);
      const uint32_t control = rig.control(eye.controls[way]);
      ASSERT_NE(control, kNone);
      played.set(control);
      const std::vector<Vec3> posed = played.deform(0);
      // A point in front of the eye turns by 30 degrees, up by 25, to where it should.
      size_t front = first;
      for (size_t v = first; v < end; ++v) {
        if (rest[v].z > rest[front].z) front = v;
      }
      const Vec3 d = posed[front] - rest[front];
      const double turn = 1.22 * std::sin((way == kLookUp ? 25 : 30) * kPi / 180);
      const double aside = way == kLookLeft ? d.x : way == kLookRight ? -d.x : 0;
      const double above = way == kLookUp ? d.y : way == kLookDown ? -d.y : 0;
      EXPECT_NEAR(way < kLookUp ? aside : above, turn, 0.15 * turn) << e << " " << way;
      // The other eye stays.
      const size_t other = e == 0 ? rig.left_end : rig.skin;
      EXPECT_LT(length(posed[other] - rest[other]), 1e-4);
    }
  }
}

TEST(GazeShapes, EyesOfARigWithoutShapesLookAround) {
  EyesRig rig(false);
  rig.make();
  ASSERT_EQ(rig.rigging.dna.defn.raw_control_names.count, 2 * kGazeWays);
  EXPECT_EQ(findings(rig.bytes), 0u);
  expect_eyes_turn(rig, GazeSource::kAdded);
}

TEST(GazeShapes, ShapesThatMoveLidsOnlyAreCompleted) {
  EyesRig rig(true);
  // Those of the generated head are of its skin: they move lids.
  rig.make();
  EXPECT_EQ(rig.rigging.dna.defn.raw_control_names.count, rig.mesh.shape_names.size());
  expect_eyes_turn(rig, GazeSource::kCompleted);
}

TEST(GazeShapes, ShapesThatTurnTheEyeballsStayAsTheyAre) {
  EyesRig rig(true);
  for (size_t s = 0; s < rig.mesh.shape_names.size(); ++s) {
    GazeName name;
    if (!reads(rig.mesh.shape_names[s], name)) continue;
    for (size_t v = rig.skin; v < rig.mesh.positions.size() / 3; ++v) {
      if (name.of_eye[v >= rig.left_end]) {
        // By ten degrees about the center, whichever way it is called.
        const double y = rig.mesh.positions[3 * v + 1] - 1,
                     z = rig.mesh.positions[3 * v + 2] - 7.15;
        const double c = std::cos(10 * kPi / 180), sine = std::sin(10 * kPi / 180);
        rig.mesh.displacements[s][3 * v + 1] = c * y - sine * z - y;
        rig.mesh.displacements[s][3 * v + 2] = sine * y + c * z - z;
      }
    }
  }
  rig.make();
  for (const GazeEye& eye : rig.rigging.gaze.eyes) {
    for (const GazeSource source : eye.sources) EXPECT_EQ(source, GazeSource::kShape);
  }
}

/// Faces from each eyeball to the next vertices of the skin, or of the other eyeball, which make one surface of them.
void join(EyesRig& rig, bool to_each_other) {
  const auto at = [&](size_t v) {
    const double* p = &rig.mesh.positions[3 * v];
    return Vec3{p[0], p[1], p[2]};
  };
  const size_t ends[] = {rig.skin, rig.left_end, rig.mesh.positions.size() / 3};
  for (int e = 0; e < 2; ++e) {
    for (const Vec3 way : {Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{1, 0, 0}}) {
      size_t from = ends[e];
      for (size_t v = ends[e]; v < ends[e + 1]; ++v) {
        if (dot(at(v), way) > dot(at(from), way)) from = v;
      }
      const size_t first = to_each_other ? ends[1 - e] : 0;
      const size_t end = to_each_other ? ends[2 - e] : rig.skin;
      size_t near[2] = {first, first + 1};
      for (size_t v = first; v < end; ++v) {
        if (length(at(v) - at(from)) >= length(at(near[0]) - at(from))) continue;
        near[1] = near[0];
        near[0] = v;
      }
      rig.mesh.face({static_cast<uint32_t>(from), static_cast<uint32_t>(near[0]),
                     static_cast<uint32_t>(near[1])});
    }
  }
}

TEST(GazeShapes, EyesThatAreJoinedWithTheSkinOrWithEachOtherTurn) {
  for (const bool to_each_other : {false, true}) {
    EyesRig rig(false);
    join(rig, to_each_other);
    rig.make();
    const Rigging& rigging = rig.rigging;
    ASSERT_EQ(rigging.dna.defn.raw_control_names.count, 2 * kGazeWays) << to_each_other;
    EXPECT_EQ(findings(rig.bytes), 0u);
    const Vec3 left = rigging.placement.bones[bone_named(rigging, "eye_l")].position;
    EXPECT_LT(length(left - Vec3{3.2, 1, 7.15}), 0.05);
    const Vec3 right = rigging.placement.bones[bone_named(rigging, "eye_r")].position;
    EXPECT_LT(length(right - Vec3{-3.2, 1, 7.15}), 0.05);
    expect_eyes_turn(rig, GazeSource::kAdded);
    // All of the ball but where it is joined.
    size_t turning = 0;
    const uint32_t eye = bone_named(rigging, "eye_l");
    for (size_t v = rig.skin; v < rig.left_end; ++v) {
      turning += share_below(rigging, static_cast<uint32_t>(v), eye) > 0.999;
    }
    EXPECT_GE(turning + 8, rig.left_end - rig.skin);
  }
}

TEST(GazeShapes, AHeadWithoutEyeballsGetsNone) {
  TestMesh mesh = procedural_mesh(4, false);
  Arena arena(default_allocator());
  Rigging rigging;
  RiggingOptions options;
  options.place.facial_joints = 20;
  options.place.lods = 1;
  Error error;
  ASSERT_EQ(make_rig(mesh.source(), options, arena, default_allocator(), rigging, error),
            Status::kOk);
  EXPECT_EQ(rigging.dna.defn.raw_control_names.count, 0u);
  EXPECT_EQ(rigging.gaze.eyes[0].bone, kNone);
}

}  // namespace
}  // namespace mien::author
