// SPDX-License-Identifier: MIT
#include "author/generate/synthetic/head.h"

#include <algorithm>
#include <cmath>

namespace mien::synthetic {
namespace {

constexpr Sizes kSizes[] = {
    {"tiny", 3, 12, 6, 7, 3, 8, 5, 8, 4.0, 0, false},
    {"small", 4, 40, 27, 60, 24, 90, 20, 4, 2.5, 1, false},
    {"medium", 5, 100, 68, 300, 45, 360, 40, 2, 2.0, 2, false},
    {"large", 8, 260, 174, 600, 120, 780, 82, 0, 2.0, 3, false},
    {"metahuman-head", 8, 251, 174, 545, 122, 782, 82, 0, 2.0, 3, true},
    {"archetype", 8, 251, 174, 545, 122, 0, 82, 0, 2.0, 3, true},
};

/// Joints at each of eight LODs of a head that has 240; proportional for other counts.
constexpr uint32_t kLadder[kMaxLodCount] = {240, 160, 110, 75, 50, 32, 20, 12};

// Regions ---------------------------------------------------------------------------------------

struct KindOfRegion {
  const char* name;
  const char* meta_human;  // the same in MetaHuman's conventions
  bool mirrored;           // two regions, left and right; else one across the middle
  bool inside;             // at its own depth; else on the skin
  bool on_jaw;             // moved by the jaw joint
  uint8_t zone;            // groups of the tiny preset, which has fewer groups than regions
  Vec3 center;             // of the left region
  Vec3 spread;
  uint8_t units[4];  // per detail; a unit is a mirrored pair of joints or one in the middle
};

constexpr KindOfRegion kKinds[kRegionKindCount] = {
    {"Forehead", "Forehead", false, false, false, 0, {0, 6.5, 0}, {4.5, 1.8, 0}, {0, 5, 12, 28}},
    {"Brow", "ForeheadMid", true, false, false, 0, {3.0, 3.0, 0}, {2.2, 0.7, 0}, {0, 4, 12, 31}},
    {"UpperLid",
     "EyelidUpperA",
     true,
     false,
     false,
     0,
     {3.2, 1.6, 0},
     {1.5, 0.35, 0},
     {1, 5, 14, 40}},
    {"LowerLid",
     "EyelidLowerA",
     true,
     false,
     false,
     0,
     {3.2, 0.4, 0},
     {1.5, 0.35, 0},
     {1, 4, 12, 36}},
    {"Eye", "Eye", true, true, false, 0, kLeftEye.center, {0.5, 0.5, 0.5}, {1, 1, 3, 10}},
    {"Nose", "Nose", false, false, false, 1, {0, -1.5, 0}, {1.4, 2.2, 0}, {0, 4, 14, 44}},
    {"Cheek", "CheekInner", true, false, false, 1, {4.8, -2.0, 0}, {1.6, 1.8, 0}, {0, 5, 16, 38}},
    {"UpperLip", "LipUpper", false, false, false, 1, {0, -5.2, 0}, {2.2, 0.6, 0}, {0, 5, 16, 60}},
    {"LowerLip", "LipLower", false, false, true, 2, {0, -6.6, 0}, {2.2, 0.6, 0}, {1, 5, 16, 60}},
    {"MouthCorner",
     "LipCorner",
     true,
     false,
     false,
     1,
     {2.9, -5.9, 0},
     {0.6, 1.0, 0},
     {1, 3, 10, 34}},
    {"Chin", "Chin", false, false, true, 2, {0, -9.0, 0}, {2.4, 1.4, 0}, {0, 4, 12, 36}},
    {"Side", "Sideburn", true, false, false, 2, {6.0, -4.0, 0}, {1.0, 3.5, 0}, {0, 2, 8, 16}},
    {"Tongue", "Tongue", false, true, true, 2, {0, -6.2, 5.0}, {0.9, 0.3, 1.6}, {0, 2, 5, 12}},
    {"Teeth", "TeethUpper", false, true, false, 2, {0, -5.8, 6.3}, {1.8, 0.8, 0.6}, {0, 2, 3, 8}},
    {"Neck", "NeckA", false, false, false, 2, {0, -13.5, 0}, {3.5, 1.8, 0}, {0, 2, 6, 12}},
};

/// Depth of the skull's front at this place; a little below the skin, where bones are.
double front_depth(double x, double y) {
  double across = (x - kSkull.center.x) / kSkull.radii.x;
  double up = (y - kSkull.center.y) / kSkull.radii.y;
  double rest = std::max(1.0 - across * across - up * up, 0.01);
  return kSkull.center.z + 0.97 * kSkull.radii.z * std::sqrt(rest);
}

// Rotations -------------------------------------------------------------------------------------

/// Neutral rotations use only these angles: their sines are known, so no library computes them.
struct Angle {
  double degrees, cosine, sine;
};
constexpr Angle kAngles[] = {
    {0, 1, 0},
    {7.5, 0.99144486137381038, 0.13052619222005157},
    {15, 0.96592582628906831, 0.25881904510252074},
    {30, 0.86602540378443865, 0.5},
    {45, 0.70710678118654752, 0.70710678118654752},
    {90, 0, 1},
};
constexpr uint32_t kAngleCount = sizeof(kAngles) / sizeof(kAngles[0]);

/// A turn about one axis: an angle of the table and its sign.
struct Turn {
  uint32_t angle = 0;
  double sign = 1;

  double degrees() const { return sign * kAngles[angle].degrees; }
};

/// matrix = matrix * rotation about `axis`; column vectors.
void turn_matrix(double (&matrix)[9], int axis, Turn turn) {
  double c = kAngles[turn.angle].cosine, s = turn.sign * kAngles[turn.angle].sine;
  int a = (axis + 1) % 3, b = (axis + 2) % 3;
  for (int row = 0; row < 3; ++row) {
    double* m = matrix + row * 3;
    double old_a = m[a], old_b = m[b];
    m[a] = old_a * c + old_b * s;
    m[b] = old_b * c - old_a * s;
  }
}

void attach(Joint& joint, uint16_t parent, const Joint& above, const Turn (&turns)[3]) {
  Vec3 way = joint.position - above.position;
  const double* m = above.axes;
  joint.parent = parent;
  joint.translation = {m[0] * way.x + m[3] * way.y + m[6] * way.z,
                       m[1] * way.x + m[4] * way.y + m[7] * way.z,
                       m[2] * way.x + m[5] * way.y + m[8] * way.z};
  joint.rotation = {turns[0].degrees(), turns[1].degrees(), turns[2].degrees()};
  std::copy(m, m + 9, joint.axes);
  for (int axis = 2; axis >= 0; --axis) turn_matrix(joint.axes, axis, turns[axis]);  // Rz Ry Rx
}

// Joints ----------------------------------------------------------------------------------------

struct Unit {
  RegionKind kind;
  uint16_t ordinal, first_joint, joint_count;
};

/// In regions across the middle every fourth unit is a single joint there.
uint16_t joints_of_unit(const KindOfRegion& kind, uint32_t ordinal) {
  return kind.mirrored || ordinal % 4 != 0 ? 2 : 1;
}

bool make_base_joints(Arena& arena, Head& head) {
  struct Base {
    const char* name;
    const char* meta_human;
    uint16_t parent;
    Vec3 position;
  };
  constexpr Base kBase[kBaseJointCount] = {
      {"root", "spine_05", kRoot, {0, 0, 0}},
      {"neck", "neck_01", kRoot, {0, -15, -2}},
      {"head", "head", kNeckJoint, {0, -6, -1}},
      {"face", "FACIAL_C_FacialRoot", kHeadJoint, {0, -6, -1}},
      {"FACIAL_C_Jaw", "FACIAL_C_Jaw", kFaceJoint, {0, -1, 0.3}}};
  Joint origin;
  for (int i = 0; i < 3; ++i) origin.axes[i * 4] = 1;
  for (uint16_t i = 0; i < kBaseJointCount; ++i) {
    Joint& joint = head.joints[i];
    joint.position = kBase[i].position;
    attach(joint, kBase[i].parent, i == kRoot ? origin : head.joints[kBase[i].parent], {});
    const char* name = head.sizes->meta_human ? kBase[i].meta_human : kBase[i].name;
    if (!copy_text(arena, Text().add(name), joint.name)) return false;
  }
  return true;
}

uint16_t draw_attributes(Random& random) {
  uint16_t mask = 1;  // each joint has a row at least
  for (int k = 1; k < 9; ++k) {
    if (random.chance(k < 3 ? 0.95 : k < 6 ? 0.8 : 0.1)) mask |= 1 << k;
  }
  return mask;
}

/// The one or two joints of a unit; the right one is the mirror image of the left.
bool make_unit(const Unit& unit, const Regions& regions, uint16_t (&roots)[kRegionCount],
               Random& random, Arena& arena, Head& head) {
  const KindOfRegion& kind = kKinds[unit.kind];
  Vec3 place = kind.center;
  if (unit.ordinal > 0) {
    double low = kind.mirrored ? -1.0 : 0.15;  // keeps the two joints of a pair apart
    place.x += random.between(low, 1) * kind.spread.x;
    place.y += random.between(-1, 1) * kind.spread.y;
    place.z += random.between(-1, 1) * kind.spread.z;
  }
  if (unit.joint_count == 1) place.x = 0;
  if (!kind.inside) place.z = front_depth(place.x, place.y);

  Turn turns[3];
  if (unit.ordinal == 0 || random.chance(0.5)) {
    for (Turn& turn : turns) {
      turn.angle = 1 + random.below(kAngleCount - 1);
      turn.sign = random.chance(0.5) ? 1 : -1;
    }
  }
  if (unit.joint_count == 1) turns[1] = turns[2] = Turn();  // stays in the plane of symmetry
  uint16_t attributes = draw_attributes(random);

  for (uint16_t i = 0; i < unit.joint_count; ++i) {
    int side = unit.joint_count == 1 ? 0 : i == 0 ? 1 : -1;
    uint16_t index = static_cast<uint16_t>(unit.first_joint + i);
    Joint& joint = head.joints[index];
    joint.position = {side < 0 ? -place.x : place.x, place.y, place.z};
    joint.ordinal = unit.ordinal;
    joint.attributes = attributes;
    joint.region = regions.find(unit.kind, side);
    joint.inside = kind.inside;
    if (unit.ordinal == 0) roots[joint.region] = index;
    uint16_t base = unit.kind == kNeck ? kNeckJoint : kind.on_jaw ? kJawJoint : kFaceJoint;
    uint16_t parent = unit.ordinal == 0 ? base : roots[joint.region];
    if (i == 1) {
      turns[1].sign = -turns[1].sign;
      turns[2].sign = -turns[2].sign;
    }
    attach(joint, parent, head.joints[parent], turns);
    Text name;
    name.add("FACIAL_").add(side > 0 ? "L_" : side < 0 ? "R_" : "C_");
    if (head.sizes->meta_human) {
      name.add(kind.meta_human);
      if (unit.ordinal != 0) name.add(uint64_t{unit.ordinal});
    } else {
      name.add(kind.name).add(uint64_t{unit.ordinal} + 1);
    }
    if (!copy_text(arena, name, joint.name)) return false;
  }
  return true;
}

/// Finer units come later: eyes, then one unit of each region, then evenly through all regions. So each LOD
/// is a prefix, and every joint has its parent.
void rank_units(Span<Unit> units, Head& head) {
  auto key = [&head](const Unit& unit) {
    uint32_t stage = unit.ordinal > 0 ? 2 : unit.kind == kEye ? 0 : 1;
    uint32_t of = kKinds[unit.kind].units[head.sizes->detail];
    uint32_t share = stage < 2 ? 0 : (unit.ordinal * 2u + 1) * 10000 / of;
    return uint64_t{stage} << 60 | uint64_t{share} << 20 | unit.first_joint;
  };
  std::sort(units.begin(), units.end(),
            [&](const Unit& a, const Unit& b) { return key(a) < key(b); });
  uint16_t rank = 0;
  for (const Unit& unit : units) {
    ++rank;
    for (uint16_t i = 0; i < unit.joint_count; ++i) head.joints[unit.first_joint + i].rank = rank;
  }

  // The base joints and the eyes are in every LOD, the ladder counts the others.
  constexpr uint32_t kAlways = kBaseJointCount + 2;
  for (uint32_t lod = 0; lod < head.sizes->lod_count; ++lod) {
    uint32_t most = kAlways + shrink(static_cast<uint32_t>(head.joints.count) - kAlways, lod,
                                     head.sizes->lod_count);
    uint32_t joints = kBaseJointCount, limit = 0;
    while (limit < units.count && joints + units[limit].joint_count <= most) {
      joints += units[limit++].joint_count;
    }
    head.rank_limits[lod] = static_cast<uint16_t>(limit + 1);
  }
}

/// Cuts the regions into joint groups of about equal size, each with coarse and fine joints.
void assign_groups(const Regions& regions, Head& head) {
  bool by_zone = head.sizes->group_count < kRegionCount;
  uint32_t joints[kRegionCount] = {}, chunks[kRegionCount] = {}, first[kRegionCount] = {};
  for (const Joint& joint : head.joints) {
    if (joint.region != kNoRegion) ++joints[joint.region];
  }
  for (uint32_t& c : chunks) c = 1;
  for (uint32_t total = kRegionCount; total < head.sizes->group_count; ++total) {
    uint32_t fullest = 0;
    for (uint32_t r = 1; r < kRegionCount; ++r) {
      if (joints[r] * chunks[fullest] > joints[fullest] * chunks[r]) fullest = r;
    }
    ++chunks[fullest];
  }
  for (uint32_t r = 1; r < kRegionCount; ++r) first[r] = first[r - 1] + chunks[r - 1];
  for (Joint& joint : head.joints) {
    uint8_t r = joint.region;
    if (r == kNoRegion) continue;
    uint32_t chunk = first[r] + joint.ordinal % chunks[r];
    joint.group = static_cast<uint16_t>(by_zone ? kKinds[regions.items[r].kind].zone : chunk);
  }
}

bool make_joints(uint64_t seed, Arena& arena, Head& head) {
  Regions regions;
  uint32_t p = head.sizes->detail, unit_count = 0;
  for (const KindOfRegion& kind : kKinds) unit_count += kind.units[p];
  Span<Unit> units;
  if (!make(arena, unit_count, units)) return false;
  uint32_t u = 0;
  uint16_t joint_count = kBaseJointCount;
  for (uint8_t k = 0; k < kRegionKindCount; ++k) {
    for (uint16_t ordinal = 0; ordinal < kKinds[k].units[p]; ++ordinal) {
      uint16_t joints = joints_of_unit(kKinds[k], ordinal);
      units[u++] = {static_cast<RegionKind>(k), ordinal, joint_count, joints};
      joint_count = static_cast<uint16_t>(joint_count + joints);
    }
  }

  if (!make(arena, joint_count, head.joints) || !make_base_joints(arena, head)) return false;
  Random random = Random::from_seed(seed, kJointStream);
  Joint& jaw = head.joints[kJawJoint];
  jaw.region = regions.find(kChin, 0);
  jaw.attributes = 0x3F;
  uint16_t roots[kRegionCount] = {};
  for (const Unit& unit : units) {
    if (!make_unit(unit, regions, roots, random, arena, head)) return false;
  }
  rank_units(units, head);
  assign_groups(regions, head);
  return true;
}

}  // namespace

Regions::Regions() {
  uint8_t n = 0;
  for (uint8_t k = 0; k < kRegionKindCount; ++k) {
    const KindOfRegion& kind = kKinds[k];
    first[k] = n;
    Vec3 center = kind.center;
    if (!kind.inside) center.z = front_depth(center.x, center.y);
    items[n++] = {static_cast<RegionKind>(k), kind.mirrored ? 1 : 0, center, kind.spread};
    if (!kind.mirrored) continue;
    center.x = -center.x;
    items[n++] = {static_cast<RegionKind>(k), -1, center, kind.spread};
  }
  assert(n == kRegionCount);
}

uint8_t Regions::find(RegionKind kind, int side) const {
  return static_cast<uint8_t>(first[kind] + (kKinds[kind].mirrored && side < 0 ? 1 : 0));
}

uint32_t shrink(uint32_t count, uint32_t lod, uint32_t lod_count) {
  return count * kLadder[lod * (kMaxLodCount - 1) / (lod_count - 1)] / kLadder[0];
}

const Sizes& head_sizes_of(SyntheticPreset preset) {
  assert(preset != SyntheticPreset::kBody && preset != SyntheticPreset::kMetaHumanBody);
  if (preset == SyntheticPreset::kMetaHumanHead) return kSizes[4];
  if (preset == SyntheticPreset::kArchetype) return kSizes[5];
  return kSizes[static_cast<uint32_t>(preset)];
}

bool make_head(SyntheticPreset preset, uint64_t seed, Arena& arena, Head& out) {
  out = Head();
  out.sizes = &head_sizes_of(preset);
  return make_joints(seed, arena, out) && make_controls(seed, arena, out);
}

}  // namespace mien::synthetic
