// SPDX-License-Identifier: MIT
// The effects of the controls of the procedural head: 52 expressions under the names of ARKit, 20 that ARKit lacks
// under those of MetaHuman rigs, and correctives for pairs of them. Each is a motion of the skin, written as windows (where) times vectors (in
// which direction), plus rotations of a few joints: jaw, lids, eyes, tongue.
#pragma once

#include "author/generate/head/mesh.h"

namespace mien::head {

constexpr uint32_t kArkitCount = 52;  // the first of the expressions
constexpr uint32_t kExpressionCount = 72;

/// Motions, as the left half of the face makes them.
enum class Motion : uint8_t {
  kBlink,
  kLookDown,
  kLookIn,
  kLookOut,
  kLookUp,
  kSquint,
  kWide,
  kJawForward,
  kJawLeft,
  kJawOpen,
  kMouthClose,
  kFunnel,
  kPucker,
  kMouthLeft,
  kSmile,
  kFrown,
  kDimple,
  kStretch,
  kRollLower,
  kRollUpper,
  kShrugLower,
  kShrugUpper,
  kPress,
  kLowerDown,
  kUpperUp,
  kBrowDown,
  kBrowInnerUp,
  kBrowOuterUp,
  kCheekPuff,
  kCheekSquint,
  kSneer,
  kTongueOut,
  kLidPress,
  kDilate,
  kDeepenFold,
  kLipsPress,
  kTogetherUpper,
  kTogetherLower,
  kClench,
  kNeckStretch,
  kMastoid,
  kThroatUp,
  kThroatDown,
  // Correctives only.
  kSeal,
  kKeepLidsShut,
  kLessWide,
  kLessRaise,
  kLessRound,
  kBrowsApart,
  kSealUpper,
  kSealLower,
  kLessOpen,
  kTongueUp,
  kNotTwice
};

/// A shape: a motion of one side (1 left, -1 right) or of both (0).
struct Shape {
  const char* name;
  Motion motion;
  int8_t side;
};
extern const Shape kExpressions[kExpressionCount];

/// Added when both members are active, by the product of their values. So mouthClose seals the lips however
/// far the jaw is open, and blinking closes the eye whatever else moves its lids. One that lists a member twice follows
/// it alone, and is fully active before it is.
struct Corrective {
  uint8_t first, second;  // expressions
  Motion motion;
  int8_t side;
  uint8_t undone = 0;  // the expression whose lids (kKeepLidsShut) or opening of the jaw it undoes
};
constexpr uint32_t kMaxCorrectives = 96;
/// Returns the number of correctives.
uint32_t list_correctives(Corrective (&out)[kMaxCorrectives]);

constexpr uint32_t kMaxShapes = kExpressionCount + kMaxCorrectives;

/// Turns of joints at full value. Angles in degrees.
struct JointTurns {
  double jaw_open = 0;
  Vec3 jaw_shift;
  double upper_lid = 0, lower_lid = 0;  // change of the share by which lids are open
  double eye_up = 0, eye_out = 0;
  double tongue = 0, tongue_up = 0;  // how far it comes out, and rises
};

/// The joints of the left half that a motion turns at full value.
JointTurns turns_of(Motion motion);

/// Whether a motion turns the jaw, which both halves share; or undoes the turn of another: an open jaw needs not open
/// further.
bool moves_jaw(Motion motion);
bool undoes_jaw(Motion motion);

/// The weight of the jaw at a vertex.
double jaw_weight(const Vertex& v);

/// Moves `p` with the jaw.
Vec3 move_with_jaw(const JointTurns& turns, Vec3 p);

/// All expressions, then the correctives.
class Shapes {
 public:
  Shapes() { corrective_count_ = list_correctives(list_); }

  uint32_t corrective_count() const { return corrective_count_; }
  uint32_t count() const { return kExpressionCount + corrective_count_; }
  const Corrective& corrective(uint32_t i) const { return list_[i]; }

  /// Whether it is a corrective that keeps a pair from moving the same skin twice.
  bool is_moderation(uint32_t index) const { return shape(index).motion == Motion::kNotTwice; }

  /// Whether it is the corrective that lifts the tongue before it comes out. The skin follows its joints.
  bool is_of_tongue(uint32_t index) const { return shape(index).motion == Motion::kTongueUp; }

  /// The turns on the left (side 1) or right half (side -1) of the face.
  JointTurns turns(uint32_t shape, int side) const;

  /// Displacement of a vertex of the skin with x >= 0. Mirrored shapes give mirrored results: that of the
  /// right half is the mirrored displacement of `twin(shape)` here.
  Vec3 displacement(uint32_t shape, const Vertex& v) const;
  /// The same but for what the jaw carries along.
  Vec3 skin_displacement(uint32_t shape, const Vertex& v) const;
  /// Displacements of all shapes: each expression is evaluated once, also where correctives need it.
  void displacements(const Vertex& v, Vec3 (&out)[kMaxShapes]) const;

  /// The same with left and right exchanged.
  uint32_t twin(uint32_t shape) const;

 private:
  Shape shape(uint32_t index) const;
  Vec3 one_side(Motion motion, Vec3 look, const Vertex& v) const;
  Vec3 both_sides(Motion motion, const Vertex& v) const;
  Vec3 lids(Motion motion, const Vertex& v) const;
  Vec3 with_jaw(uint32_t shape, const Vertex& v, Vec3 skin) const;

  Corrective list_[kMaxCorrectives];
  uint32_t corrective_count_ = 0;
};

/// Displacements of the vertices of a mesh, for all LODs that were collapsed from it: what has been found is kept.
class Displacements {
 public:
  explicit Displacements(const Shapes& shapes) : shapes_(shapes) {}

  /// False if memory ran out.
  bool make(uint32_t vertex_count, Arena& arena);
  /// Finds those of a vertex; at() is of vertices that have been found.
  void find(const Vertex& v);
  Vec3 at(uint32_t shape, const Vertex& v) const {
    return items_[size_t{shape} * found_.count + v.number];
  }

 private:
  const Shapes& shapes_;
  Span<Vec3> items_;  // [shape * vertex count + vertex]
  Span<uint8_t> found_;
};

}  // namespace mien::head
