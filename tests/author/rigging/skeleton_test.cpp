// SPDX-License-Identifier: MIT
// What a rigger asks of the skeleton under the fit: joints that are turned by hand move what they should,
// and nothing else. Of a generated head, and of real ones where they are at hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "author/mesh/mirror_places.h"
#include "author/place/extra_joints.h"
#include "runtime/load/dna/format/dna_writer.h"
#include "tests/support/mesh_source.h"
#include "tests/support/played_rig.h"
#include "tests/support/posed_skeleton.h"
#include "tests/support/real_meshes.h"

namespace mien::author {
namespace {

struct SkeletonRig {
  AuthorSetup setup;
  TestMesh mesh;
  Arena arena{default_allocator()};
  Rigging rigging;
  bool there = true;

  explicit SkeletonRig(const std::string& head, uint32_t lod = 0) {
    if (head == "generated") {
      make_author_head(lod, 8, 4, 1, setup);
    } else {
      there = head == "ict" ? load_ict(setup) : load_makehuman(setup);
    }
    if (!there) return;
    mesh = mesh_of(setup, true);
    RiggingOptions options;
    options.place.facial_joints = 80;
    options.place.lods = 1;
    Error error;
    EXPECT_EQ(make_rig(mesh.source(), options, arena, default_allocator(), rigging, error),
              Status::kOk)
        << error.message;
  }
};

class Skeleton : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    // Made once, because that takes a second; tests only read it.
    static std::map<std::string, std::unique_ptr<SkeletonRig>> made;
    std::unique_ptr<SkeletonRig>& of_head = made[GetParam()];
    if (!of_head) of_head = std::make_unique<SkeletonRig>(GetParam());
    made_ = of_head.get();
    if (!made_->there)
      GTEST_SKIP() << "NOT TESTED: skeletons of real heads; there is no $MIEN_SHARED/data/meshes";
  }
  const Rigging& rig() const { return made_->rigging; }
  const AuthorMesh& mesh() const { return made_->rigging.read.mesh; }
  const NeckCut& cut() const { return made_->rigging.placement.neck_cut; }

  const SkeletonRig* made_ = nullptr;
};

/// The normal of a triangle that is no more than a line, as collapses leave some, turns with any motion.
bool is_line(Vec3 a, Vec3 b, Vec3 c) {
  const double longest = std::max({length(b - a), length(c - b), length(a - c)});
  return length(cross(b - a, c - a)) < 0.05 * longest * longest;
}

void expect_head_turns(const Rigging& rig, const std::string& name, bool has_lines) {
  const AuthorMesh& mesh = rig.read.mesh;
  const NeckCut& cut = rig.placement.neck_cut;
  ASSERT_TRUE(cut.exists);
  const uint32_t head = bone_named(rig, "head"), chest = bone_named(rig, "chest");
  const Span<const Bone> bones = rig.placement.bones;
  ASSERT_EQ(bones[chest].parent, 0u);
  EXPECT_TRUE(hangs_below(rig, head, bone_named(rig, "neck")));
  EXPECT_TRUE(hangs_below(rig, bone_named(rig, "neck"), chest));
  EXPECT_LT(bones[chest].position.y, bones[head].position.y);

  const Span<const Vec3> rest = mesh.positions;
  double low = rest[0].y;
  for (const Vec3& p : rest) low = std::min(low, p.y);
  const double sole = low + 0.2 * (cut.y - low);
  for (const Vec3 degrees : {Vec3{30, 0, 0}, Vec3{-30, 0, 0}, Vec3{0, 30, 0}, Vec3{0, 0, 30}}) {
    const std::vector<Vec3> posed = turned(rig, head, degrees);
    double most = 0, bust = 0;
    for (size_t v = 0; v < posed.size(); ++v) {
      const double way = length(posed[v] - rest[v]);
      most = std::max(most, way);
      if (rest[v].y < sole) bust = std::max(bust, way);
    }
    EXPECT_GT(most, 0.1 * mesh.diagonal);
    EXPECT_LT(bust, 0.001 * most);

    // About the head's joint openings of the head sweep no volume, and that of the bust stays.
    double change = 0;
    size_t folded = 0, bent = 0;
    const Vec3 joint = bones[head].position;
    for (size_t t = 0; t < mesh.triangles.count; t += 3) {
      const uint32_t* c = &mesh.triangles[t];
      if (!mesh.is_skin[c[0]]) continue;
      const Vec3 a = rest[c[0]] - joint, b = rest[c[1]] - joint, d = rest[c[2]] - joint;
      const Vec3 e = posed[c[0]] - joint, f = posed[c[1]] - joint, g = posed[c[2]] - joint;
      change += (dot(e, cross(f, g)) - dot(a, cross(b, d))) / 6;
      const double share = share_below(rig, c[0], head);
      if (share <= 0 || share >= 1 || (has_lines && is_line(a, b, d))) continue;
      // Each triangle against itself turned as far as it should be.
      const double part[3] = {share * degrees.x, share * degrees.y, share * degrees.z};
      const Vec3 normal = normalized(motion(part, {}, {}).turn(cross(b - a, d - a)));
      ++bent;
      folded += dot(normal, normalized(cross(f - e, g - e))) < 0;
    }
    double front = -1e9, back = 1e9;
    for (const Vec3& p : rest) {
      if (p.y < cut.base || p.y > cut.y || std::abs(p.x) > cut.half_width) continue;
      front = std::max(front, p.z);
      back = std::min(back, p.z);
    }
    const double neck = kPi * cut.half_width * (front - back) / 2 * (cut.y - cut.base);
    printf("%s: turn %.0f %.0f %.0f: bust %.5f %%, neck volume %+.1f %%, %zu of %zu folded\n",
           name.c_str(), degrees.x, degrees.y, degrees.z, 100 * bust / most, 100 * change / neck,
           folded, bent);
    EXPECT_GT(bent, 20u);
    EXPECT_LT(std::abs(change), 0.05 * neck);
    EXPECT_EQ(folded, 0u);
  }
}

TEST_P(Skeleton, TheHeadTurnsOnANeckAndTheBustStays) {
  expect_head_turns(rig(), GetParam(), false);
}

TEST(SkeletonOfCollapsedMeshes, TheHeadTurnsOnANeckAndTheBustStays) {
  for (const uint32_t lod : {1u, 2u, 3u}) {
    const SkeletonRig made("generated", lod);
    expect_head_turns(made.rigging, "LOD " + std::to_string(lod), true);
  }
}

TEST_P(Skeleton, FacialJointsTakeNothingFromTheNeckAndTheChest) {
  const uint32_t head = bone_named(rig(), "head");
  size_t on_the_chest = 0;
  for (uint32_t v = 0; v < mesh().positions.count; ++v) {
    const Vec3 p = mesh().positions[v];
    const double above = cut().above(p);
    if (above >= 0) continue;
    if (p.y <= cut().base) {
      ++on_the_chest;
      ASSERT_LT(share_below(rig(), v, head), 1e-3) << v;
    }
    // No more than a straight line from the base to the throat gives.
    ASSERT_LT(share_below(rig(), v, head),
              1.35 * std::max(0.0, (p.y - cut().base) / (p.y - cut().base - above)) + 1e-3);
  }
  EXPECT_GT(on_the_chest, 20u);
}

/// Rows of the joint matrix: what the control does to attribute a of the joint; 0 where nothing is stored.
float stored_value(const dna::DnaView& dna, uint32_t joint, uint32_t attribute, uint32_t control) {
  for (const dna::JointGroup& group : dna.bhvr.joints.groups) {
    for (uint32_t r = 0; r < group.output_indices.count; ++r) {
      if (group.output_indices[r] != joint * 9 + attribute) continue;
      for (uint32_t c = 0; c < group.input_indices.count; ++c) {
        if (group.input_indices[c] == control) {
          return group.values[r * group.input_indices.count + c];
        }
      }
    }
  }
  return 0;
}

double turn_of(const dna::DnaView& dna, uint32_t joint, uint32_t control) {
  double square = 0;
  for (uint32_t a = 3; a < 6; ++a) {
    const double angle = double{stored_value(dna, joint, a, control)};
    square += angle * angle;
  }
  return std::sqrt(square);
}

TEST_P(Skeleton, TheJawTurnedAloneOpensTheMouth) {
  const PlaceReport& place = rig().place;
  ASSERT_TRUE(place.jaw_joint);
  const uint32_t jaw = bone_named(rig(), "jaw");
  const uint32_t open = jaw_open_shape(mesh());
  ASSERT_NE(open, kNone);
  const Shape& shape = mesh().shapes[open];
  const std::vector<Vec3> posed = turned(rig(), jaw, {place.jaw_angle, 0, 0});
  double wanted = 0, left = 0, most = 0, above = 0;
  for (uint32_t v = 0; v < posed.size(); ++v) {
    const Vec3f f = shape.displacements[v];
    const Vec3 d = {double{f.x}, double{f.y}, double{f.z}};
    const Vec3 moved = posed[v] - mesh().positions[v];
    wanted += dot(d, d);
    left += dot(moved - d, moved - d);
    most = std::max(most, length(moved));
    if (mesh().positions[v].y > place.throat.nose_y) above = std::max(above, length(moved));
  }
  printf("%s: the jaw alone, turned by %.1f degrees, does %.1f %% of %.*s\n", GetParam(),
         place.jaw_angle, 100 * (1 - left / wanted), static_cast<int>(shape.name.count),
         shape.name.data);
  // In squares. The rest is on facial joints.
  EXPECT_LT(left, 0.25 * wanted);
  EXPECT_LT(above, 0.1 * most) << "what lies above the nose";

  // So does the control that opens it.
  EXPECT_NEAR(turn_of(rig().dna, jaw, open), place.jaw_angle, 0.25 * place.jaw_angle);
  printf("%s: the control turns it by %.1f degrees\n", GetParam(), turn_of(rig().dna, jaw, open));
  uint32_t others = 0;
  for (uint32_t s = 0; s < mesh().shapes.count; ++s) {
    others += s != open && turn_of(rig().dna, jaw, s) > 0.5 * place.jaw_angle;
  }
  EXPECT_LE(others, mesh().shapes.count / 8) << "brows and lids leave the jaw alone";
}

/// The word of a joint's name: "Cheek" for "FACIAL_L_Cheek12".
std::string region_of(const Bone& bone) {
  std::string name(bone.name.data, bone.name.count);
  if (bone.kind == BoneKind::kFacial) name = name.substr(name.rfind('_') + 1);
  return name.substr(0, name.find_first_of("0123456789"));
}

TEST_P(Skeleton, TheFileFollowsTheShapesInEveryRegion) {
  std::vector<uint8_t> bytes(dna::encoded_size(rig().dna, {}));
  dna::encode(rig().dna, {}, bytes.data());
  Played played(bytes);
  struct Sum {
    double squares = 0, energy = 0;
  };
  std::map<std::string, Sum> regions;  // of the heaviest joint
  const SkinWeights& w = rig().weights;
  double energy = 0;
  for (uint32_t s = 0; s < mesh().shapes.count; ++s) {
    played.set(s);
    const std::vector<Vec3> points = played.deform(0);
    for (uint32_t v = 0; v < points.size(); ++v) {
      Sum& sum = regions[region_of(rig().placement.bones[w.joints[size_t{v} * w.m]])];
      const Vec3 d = as_vec3(mesh().shapes[s].displacements[v]);
      const Vec3 off = mesh().frame.to_internal(points[v]) - mesh().positions[v] - d;
      sum.squares += dot(off, off);
      sum.energy += dot(d, d);
      energy += dot(d, d);
    }
  }
  printf("%s: error of", GetParam());
  for (const auto& [name, sum] : regions) {
    if (sum.energy < 0.005 * energy) continue;
    const double error = std::sqrt(sum.squares / sum.energy);
    printf(" %s %.1f %%", name.c_str(), 100 * error);
    // Blend shapes leave out offsets below a length, which is more of the short motions there.
    const bool moves_far = name == "Mouth" || name == "Chin" || name == "Jaw" || name == "jaw";
    EXPECT_LT(error, moves_far ? 0.06 : 0.15) << name;
  }
  size_t skin = 0;
  for (const uint8_t is_skin : mesh().is_skin) skin += is_skin;
  const double mask = static_cast<double>(rig().placement.mask.count) / static_cast<double>(skin);
  printf("; the mask is %.0f %% of the skin\n", 100 * mask);
  EXPECT_GT(mask, 0.3);
  EXPECT_LT(mask, 0.9);
}

TEST_P(Skeleton, FacialJointsHangBelowWhatCarriesThem) {
  const Span<const Bone> bones = rig().placement.bones;
  const uint32_t jaw = bone_named(rig(), "jaw");
  const PlaceReport& place = rig().place;
  uint32_t below = 0, beside = 0;
  for (uint32_t b = 0; b < bones.count; ++b) {
    if (bones[b].kind != BoneKind::kFacial) continue;
    ASSERT_LT(bones[b].parent, b);
    EXPECT_EQ(bones[bones[b].mirror].parent, bones[b].parent) << "mirror images";
    const bool is_below = hangs_below(rig(), b, jaw);
    below += is_below;
    beside += !is_below;
    if (bones[b].position.y > place.throat.nose_y) {
      EXPECT_FALSE(is_below) << bones[b].name.data;
    }
  }
  EXPECT_GT(below, 8u);
  EXPECT_GT(beside, below / 2);
}

TEST_P(Skeleton, WeightsOfAPlaceAreThoseOfItsMirrorImage) {
  const Span<const Bone> bones = rig().placement.bones;
  const SkinWeights& w = rig().weights;
  Arena arena(default_allocator());
  Span<uint32_t> mirror;
  ASSERT_TRUE(find_mirror(mesh(), mesh().welded, arena, arena, mirror));
  ASSERT_FALSE(mirror.empty());
  double sum = 0, most = 0;
  size_t count = 0;
  for (uint32_t v = 0; v < mirror.count; ++v) {
    if (mesh().welded[v] != v || mirror[v] == kNone || !mesh().is_skin[v]) continue;
    // The weight that the mirror images of the joints do not have at the mirror image of the place.
    std::vector<double> left(bones.count);
    for (uint32_t i = 0; i < w.m; ++i) {
      left[bones[w.joints[v * w.m + i]].mirror] += double{w.weights[v * w.m + i]};
    }
    for (uint32_t i = 0; i < w.m; ++i) {
      left[w.joints[mirror[v] * w.m + i]] -= double{w.weights[mirror[v] * w.m + i]};
    }
    double different = 0;
    for (const double weight : left) different += std::abs(weight) / 2;
    sum += different;
    most = std::max(most, different);
    ++count;
  }
  printf("%s: mirrored weights differ by %.3f on average, %.3f at most\n", GetParam(),
         sum / static_cast<double>(count), most);
  EXPECT_GT(count, 1000u);
  EXPECT_LT(sum, 0.03 * static_cast<double>(count));
  EXPECT_LT(most, 0.35);
}

INSTANTIATE_TEST_SUITE_P(Heads, Skeleton, ::testing::Values("generated", "ict", "makehuman"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace mien::author
