// SPDX-License-Identifier: MIT
#include "author/rigging/gaze_shapes.h"

#include <algorithm>
#include <cstring>

#include "author/base/dna_making.h"
#include "author/base/exact_math.h"
#include "author/base/joint_motion.h"
#include "author/place/extra_joints.h"

namespace mien::author {

namespace {

// How far an eye turns with a control at 1, in degrees: to the sides, up and down.
constexpr double kDegrees[kGazeWays] = {30, 30, 25, 30};
constexpr double kTurned = 3;  // degrees: from which on a shape turns the eyeball
// Lids follow the eye in part, those above and those below it, and hardly to the sides.
constexpr double kUpperLid[kGazeWays] = {0, 0, 0.45, 0.7};
constexpr double kLowerLid[kGazeWays] = {0, 0, 0.2, 0.35};
// From the center of the eye, in radii: lids end, and follow no more; how far aside they follow.
constexpr double kLid = 1.2, kBeyondLid = 1.8, kAside = 1.25;

constexpr const char* kAddedNames[2][kGazeWays] = {
    {"eyeLookOutLeft", "eyeLookInLeft", "eyeLookUpLeft", "eyeLookDownLeft"},
    {"eyeLookInRight", "eyeLookOutRight", "eyeLookUpRight", "eyeLookDownRight"}};
constexpr const char* kMetahumanGaze[2][kGazeWays] = {
    {"CTRL_expressions.eyeLookLeftL", "CTRL_expressions.eyeLookRightL",
     "CTRL_expressions.eyeLookUpL", "CTRL_expressions.eyeLookDownL"},
    {"CTRL_expressions.eyeLookLeftR", "CTRL_expressions.eyeLookRightR",
     "CTRL_expressions.eyeLookUpR", "CTRL_expressions.eyeLookDownR"}};

bool take(const char*& at, const char* word) {
  const size_t count = strlen(word);
  if (strncmp(at, word, count) != 0) return false;
  at += count;
  return true;
}

}  // namespace

bool read_gaze_name(Name name, GazeName& out) {
  char letters[64];
  uint32_t count = 0;
  for (char c : name) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (!(c >= 'a' && c <= 'z')) continue;
    if (count + 1 == sizeof(letters)) return false;
    letters[count++] = c;
  }
  letters[count] = 0;
  out = GazeName();
  const char* at = letters;
  take(at, "ctrlexpressions") || take(at, "ctrl");
  // The side comes last, or before the eye.
  bool left = take(at, "left"), right = !left && take(at, "right");
  take(at, "eyes") || take(at, "eye");
  if (!take(at, "look")) return false;
  if (take(at, "up")) {
    out.way = kLookUp;
  } else if (take(at, "down")) {
    out.way = kLookDown;
  } else if (take(at, "inward") || take(at, "in")) {
    out.is_inward = true;
  } else if (take(at, "outward") || take(at, "out")) {
    out.is_outward = true;
  } else if (take(at, "left")) {
    out.way = kLookLeft;
  } else if (take(at, "right")) {
    out.way = kLookRight;
  } else {
    return false;
  }
  left = left || strcmp(at, "left") == 0 || strcmp(at, "l") == 0;
  right = right || strcmp(at, "right") == 0 || strcmp(at, "r") == 0;
  if (!left && !right && *at != 0) return false;
  if (left || right) {
    out.of_eye[0] = left;
    out.of_eye[1] = right;
  }
  return true;
}

namespace {

struct Ball {
  uint32_t bone = kNone;
  Vec3 center;
  double radius = 0;
  uint32_t eye = kNone;  // of find_eyes()
};

class GazeMaker {
 public:
  GazeMaker(const Placement& placement, bool metahuman_names, Arena& arena,
            const Allocator& allocator, AuthorMesh& mesh, GazeReport& report)
      : placement_(placement), added_names_(metahuman_names ? kMetahumanGaze : kAddedNames),
        arena_(arena), scratch_(allocator), mesh_(mesh), report_(report) {}

  bool make() {
    if (!find_balls()) return false;
    if (balls_[0].bone == kNone && balls_[1].bone == kNone) return true;
    const size_t given = mesh_.shapes.count;
    Span<Shape> shapes;
    if (!author::make(arena_, given + 2 * kGazeWays, shapes)) return false;
    std::copy(mesh_.shapes.begin(), mesh_.shapes.end(), shapes.begin());
    size_t count = given;
    for (uint32_t e = 0; e < 2; ++e) {
      if (balls_[e].bone == kNone) continue;
      for (uint32_t way = 0; way < kGazeWays; ++way) {
        if (!make_way(e, static_cast<GazeWay>(way), shapes, given, count)) return false;
      }
    }
    mesh_.shapes = shapes.first(count);
    return true;
  }

 private:
  bool find_balls() {
    Eye eyes[kMaxEyes];
    uint32_t count = 0;
    if (!author::make(scratch_, mesh_.component_count, eye_of_) ||
        !find_eyes(mesh_, placement_.symmetry_plane, placement_.symmetric, scratch_, eyes, count,
                   eye_of_)) {
      return false;
    }
    for (uint32_t b = 0; b < placement_.bones.count; ++b) {
      if (placement_.bones[b].kind != BoneKind::kEye) continue;
      for (uint32_t i = 0; i < count; ++i) {
        Ball& ball = balls_[eyes[i].side < 0];
        const Vec3 off = placement_.bones[b].position - eyes[i].center;
        if (eyes[i].side == 0 || ball.bone != kNone || length(off) > eyes[i].radius) continue;
        ball = {b, placement_.bones[b].position, eyes[i].radius, i};
        report_.eyes[eyes[i].side < 0].bone = b;
      }
    }
    return true;
  }

  bool make_way(uint32_t e, GazeWay way, Span<Shape> shapes, size_t given, size_t& count) {
    GazeEye& report = report_.eyes[e];
    // Of several shapes the first one that is of this eye alone, if there is one.
    size_t found = given;
    bool is_own = false;
    for (size_t s = 0; s < given; ++s) {
      GazeName name;
      if (!read_gaze_name(shapes[s].name, name) || !name.of_eye[e] || name.way_of(e) != way) {
        continue;
      }
      const bool own = !name.of_eye[1 - e];
      if (found == given || (own && !is_own)) {
        found = s;
        is_own = own;
      }
    }
    if (found < given) {
      report.controls[way] = shapes[found].name;
      report.sources[way] = GazeSource::kShape;
      double degrees = 0;
      if (!measure_turn(balls_[e], shapes[found], degrees)) return false;
      if (degrees >= kTurned) return true;
      report.sources[way] = GazeSource::kCompleted;
      return turn(e, way, false, shapes[found]);
    }
    Shape& added = shapes[count];
    added.name = {added_names_[e][way], strlen(added_names_[e][way])};
    added.number = static_cast<uint32_t>(count++);
    report.controls[way] = added.name;
    report.sources[way] = GazeSource::kAdded;
    return turn(e, way, true, added);
  }

  bool is_of(uint32_t v, const Ball& ball) const { return eye_of_[mesh_.component[v]] == ball.eye; }

  bool measure_turn(const Ball& ball, const Shape& shape, double& degrees) {
    Span<Vec3> from, to;
    size_t count = 0;
    for (uint32_t v = 0; v < mesh_.positions.count; ++v) count += is_of(v, ball);
    if (!author::make(scratch_, count, from) || !author::make(scratch_, count, to)) return false;
    count = 0;
    for (uint32_t v = 0; v < mesh_.positions.count; ++v) {
      if (!is_of(v, ball)) continue;
      const Vec3f d = shape.displacements[v];
      from[count] = mesh_.positions[v];
      to[count] = from[count] + Vec3{double{d.x}, double{d.y}, double{d.z}};
      ++count;
    }
    degrees = count < 3 ? 0 : fit_rigid(from, to).angle;
    return true;
  }

  /// Turned about the center of the ball.
  static Vec3 turned(const Ball& ball, GazeWay way, double share, Vec3 p) {
    const double degrees = share * kDegrees[way];
    const double angles[3] = {way == kLookUp     ? -degrees
                              : way == kLookDown ? degrees
                                                 : 0,
                              way == kLookLeft    ? degrees
                              : way == kLookRight ? -degrees
                                                  : 0,
                              0};
    return motion(angles, ball.center, {})(p);
  }

  /// How much of the turn the lids take at a place in front of the eye.
  static double follow(const Ball& ball, GazeWay way, Vec3 p) {
    const Vec3 d = (p - ball.center) * (1 / ball.radius);
    const double near = 1 - smooth_step(kLid, kBeyondLid, length(d));
    const double front = smooth_step(0.1, 0.5, d.z);
    const double aside = d.x / kAside;
    const double across = std::abs(aside) < 1 ? (1 - aside * aside) * (1 - aside * aside) : 0;
    const double upper = smooth_step(-0.2, 0.2, d.y);
    const double share = upper * kUpperLid[way] + (1 - upper) * kLowerLid[way];
    return near * front * across * share;
  }

  /// Adds the rotation of the eyeball, and of the lids if wanted, to a copy of the displacements.
  bool turn(uint32_t e, GazeWay way, bool with_lids, Shape& shape) {
    const Ball& ball = balls_[e];
    const size_t n = mesh_.positions.count;
    Span<Vec3f> all;
    Span<uint32_t> moving;
    if (!author::make(arena_, n, all) || !author::make(arena_, n, moving)) return false;
    size_t count = 0;
    for (uint32_t v = 0; v < n; ++v) {
      const Vec3 p = mesh_.positions[v];
      if (!shape.displacements.empty()) all[v] = shape.displacements[v];
      const bool is_ball = is_of(v, ball);
      double share = is_ball ? 1 : 0;
      if (!is_ball && with_lids && eye_of_[mesh_.component[v]] == kNone) {
        share = follow(ball, way, p);
      }
      if (share > 0) {
        const Vec3 d = turned(ball, way, share, p) - p;
        all[v] = {static_cast<float>(double{all[v].x} + d.x),
                  static_cast<float>(double{all[v].y} + d.y),
                  static_cast<float>(double{all[v].z} + d.z)};
      }
      if (all[v].x != 0 || all[v].y != 0 || all[v].z != 0) moving[count++] = v;
    }
    shape.displacements = all;
    shape.moving = moving.first(count);
    return true;
  }

  const Placement& placement_;
  const char* const (*added_names_)[kGazeWays];
  Arena& arena_;
  Arena scratch_;
  AuthorMesh& mesh_;
  GazeReport& report_;
  Ball balls_[2];
  Span<uint32_t> eye_of_;
};

}  // namespace

bool add_gaze_shapes(const Placement& placement, bool metahuman_names, Arena& arena,
                     const Allocator& allocator, AuthorMesh& mesh, GazeReport& report) {
  report = GazeReport();
  return GazeMaker(placement, metahuman_names, arena, allocator, mesh, report).make();
}

}  // namespace mien::author
