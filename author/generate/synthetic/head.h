// SPDX-License-Identifier: MIT
// The head of a synthetic rig: where its joints and controls are and which of them meet. rig.cpp writes it as
// definition and behavior, mesh.cpp puts skin around it.
//
// Frame: centimeters, x to the character's left, y up, z to the front.
#pragma once

#include "author/base/dna_making.h"
#include "author/base/face_controls.h"
#include "author/base/random.h"
#include "author/generate/synthetic/rig.h"

namespace mien::synthetic {

using author::copy_text;
using author::fill_index;
using author::kBrow, author::kCheek, author::kChin, author::kEye, author::kForehead,
    author::kLowerLid, author::kLowerLip, author::kMouthCorner, author::kNeck, author::kNose,
    author::kRegionKindCount, author::kSide, author::kTeeth, author::kTongue, author::kUpperLid,
    author::kUpperLip;
using author::make;
using author::make_lod_map;
using author::NewVec3s;
using author::Ramp;
using author::RegionKind;
using author::Text;

/// 1 in the middle, 0 from `radius` on, with a smooth end; takes squares to avoid the root.
inline double falloff(double squared_distance, double radius) {
  double rest = 1.0 - squared_distance / (radius * radius);
  return rest > 0 ? rest * rest : 0.0;
}

/// The skull, and the eyeballs.
struct Ellipsoid {
  Vec3 center, radii;
};
constexpr Ellipsoid kSkull = {{0, -3.5, 0}, {7.6, 15.5, 9.6}};
constexpr Ellipsoid kLeftEye = {{3.2, 1.0, 7.1}, {1.22, 1.22, 1.22}};

// Sizes -----------------------------------------------------------------------------------------

constexpr uint32_t kMaxLodCount = 8;

struct Sizes {
  const char* name;
  uint32_t lod_count, raw_count, gui_count, psd_count, group_count, channel_count, map_count;
  uint32_t first_grid;   // into the table of mesh grids; other LODs have the next ones
  double target_radius;  // of blend shape targets, on the skin
  uint8_t detail;        // 0 ... 3: which families of controls and how many joints
  bool
      meta_human;  // with their names, quaternion inputs of the neck, and an RBF solver that reads them
};

const Sizes& head_sizes_of(SyntheticPreset preset);

/// Raw controls after those of families, in heads of characters: quaternions of these joints.
constexpr const char* kNeckInputs[] = {"neck_01", "neck_02", "head"};
constexpr uint32_t kNeckInputCount = 3 * 4;
constexpr uint32_t kNeckPoseCount = 18;  // one RBF pose control each

/// Elements that are left of `count` at a LOD: all at LOD 0, a twentieth at the last.
uint32_t shrink(uint32_t count, uint32_t lod, uint32_t lod_count);

// Joints ----------------------------------------------------------------------------------------

enum BaseJoint : uint16_t { kRoot, kNeckJoint, kHeadJoint, kFaceJoint, kJawJoint, kBaseJointCount };

/// A patch of the head: a kind, or its left or right half.
struct Region {
  RegionKind kind;
  int side = 0;  // 1 left, -1 right, 0 in the middle
  Vec3 center, spread;
};

constexpr uint32_t kRegionCount = 22;
constexpr uint8_t kNoRegion = 255;

/// The right half of a mirrored kind comes after the left one.
struct Regions {
  Region items[kRegionCount];
  uint8_t first[kRegionKindCount];

  Regions();
  uint8_t find(RegionKind kind, int side) const;
};

struct Joint {
  dna::String name;
  Vec3 position;               // on the head
  double axes[9] = {};         // rotation to the head, row-major, column vectors
  Vec3 translation, rotation;  // neutral: relative to the parent, Euler angles in degrees
  uint16_t parent = 0;
  uint16_t ordinal = 0;     // within the region
  uint16_t rank = 0;        // is in the LODs whose rank limit is above this
  uint16_t group = 0;       // joint group, unless the region is kNoRegion
  uint16_t attributes = 0;  // bit k: attribute k has a row
  uint8_t region = kNoRegion;
  bool inside = false;  // eye, tongue, teeth: does not move skin
};

// Controls --------------------------------------------------------------------------------------

constexpr uint32_t kMaxMembers = 5;

/// A raw control, or a corrective of several raw controls.
struct Control {
  dna::String name;  // without "CTRL_expressions."; members joined by '_'
  Vec3 home;
  double reach = 0;      // moves joints nearer than this ...
  uint32_t regions = 0;  // ... in these regions (bit mask)
  uint16_t gui = 0;      // raw control: what drives it, by these ramps
  uint16_t ramp_count = 0;
  Ramp ramps[2];
  uint16_t member_count = 0;  // corrective: its raw controls, ascending
  uint16_t members[kMaxMembers] = {};
};

/// A separate stream of random numbers for each kind of data.
enum Stream : uint64_t {
  kJointStream = 1,
  kControlStream,
  kCorrectiveStream,
  kWeightStream,
  kGroupStream,
  kChannelStream,
  kMapStream,
  kPoseControlStream,
  kFirstTargetStream = 1000  // and on, one per channel
};

struct Head {
  const Sizes* sizes = nullptr;
  Span<Joint> joints;
  Span<Control> controls;  // raw, correctives, RBF: numbered as in the file
  Span<dna::String> gui_names;
  uint16_t rank_limits[kMaxLodCount] = {};

  bool joint_in_lod(size_t joint, size_t lod) const {
    return joints[joint].rank < rank_limits[lod];
  }
  uint32_t input_count() const { return sizes->meta_human ? kNeckInputCount : 0; }
  uint32_t pose_count() const { return sizes->meta_human ? kNeckPoseCount : 0; }
  /// Raw controls of the file; the quaternion inputs are the last ones.
  uint32_t raw_count() const { return sizes->raw_count + input_count(); }
  bool is_input(size_t control) const {
    return control >= sizes->raw_count && control < raw_count();
  }

  /// Channels are taken evenly from the controls of families and from correctives.
  size_t control_of_channel(size_t channel) const {
    const size_t count = size_t{sizes->raw_count} + sizes->psd_count;
    const size_t control = channel * count / sizes->channel_count;
    return control < sizes->raw_count ? control : control + input_count();
  }
  /// How much the control moves the joint, 0 to 1.
  double influence(const Control& control, const Joint& joint) const {
    if (joint.region == kNoRegion || !(control.regions >> joint.region & 1)) return 0;
    Vec3 apart = joint.position - control.home;
    return falloff(dot(apart, apart), control.reach);
  }
};

/// These return false if memory ran out.
bool make_head(SyntheticPreset preset, uint64_t seed, Arena& arena, Head& out);

/// The part of make_head() that needs no joints.
bool make_controls(uint64_t seed, Arena& arena, Head& head);

/// The RBF solver that turns rotations of neck and head into pose controls; nothing if the head has none.
bool make_neck_solver(const Head& head, Arena& arena, dna::DnaView& out);

/// Head meshes, one per LOD, then two eyes that all LODs share. `kept[c]`: channel c exists at LOD
/// 1 too. Fills geom, and mesh names, LODs and channels of defn.
bool make_meshes(const Head& head, uint64_t seed, Span<const uint8_t> kept, Arena& arena,
                 dna::DnaView& out);

}  // namespace mien::synthetic
