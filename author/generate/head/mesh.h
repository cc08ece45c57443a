// SPDX-License-Identifier: MIT
// Meshes of the procedural head: parts sampled from the form, and their coarser LODs.
#pragma once

#include "author/generate/head/form.h"

namespace mien::head {

constexpr uint32_t kLodCount = 8;

enum class Part : uint8_t { kHead, kTeeth, kTongue, kEyeLeft, kEyeRight, kHair, kBrows, kLashes };
constexpr uint32_t kPartCount = 8;

/// The joints that move a vertex besides those of the face.
enum class Carrier : uint8_t {
  kSkin,
  kSkull,       // the head joint alone: hair
  kUpperTeeth,  // rigid
  kLowerTeeth,
  kTongue,
  kEyeball
};

struct Vertex {
  Vec3 position;  // neutral
  Vec3 closed;    // the same with closed lids
  Vec3 look;  // the place on the face whose motion it follows (lips for the inside of the mouth)
  Vec3 normal;
  double u = 0, v = 0;
  double lid = 0;          // see FacePoint
  double above_mouth = 0;  // height of `look` above the line between the lips
  double depth = 0;        // into the mouth: 0 on the face, 1 at its back
  double along = 0;        // tongue: 0 root, 1 tip
  Color color;
  uint32_t number = 0;  // of the vertex in its mesh; after a collapse, in the mesh of LOD 0
  Side side = Side::kAbove;
  bool edge = false;  // of a slit, where it has to meet the other side
  Carrier carrier = Carrier::kSkin;
};

struct Face {
  uint32_t corners[4];
  uint32_t count;
};

/// A list that grows in an arena. If memory runs out it stays as it is and sets failed().
template <class T>
class Growing {
 public:
  explicit Growing(Arena& arena) : arena_(&arena) {}

  uint32_t add(const T& item) {
    if (count_ == items_.count && !grow()) return 0;
    items_[count_] = item;
    return count_++;
  }
  T& operator[](size_t i) const { return items_[i]; }
  uint32_t count() const { return count_; }
  Span<T> span() const { return items_.first(count_); }
  bool failed() const { return failed_; }
  void fail() { failed_ = true; }
  Arena& arena() const { return *arena_; }

 private:
  bool grow() {
    const Span<T> larger = failed_ ? Span<T>() : arena_->array<T>(items_.count * 2 + 256);
    if (larger.empty()) {
      failed_ = true;
      return false;
    }
    for (uint32_t i = 0; i < count_; ++i) larger[i] = items_[i];
    items_ = larger;
    return true;
  }

  Arena* arena_;
  Span<T> items_;
  uint32_t count_ = 0;
  bool failed_ = false;
};

/// The half of a mesh with x >= 0, to be mirrored; or, of one eye, all of it.
struct HalfMesh {
  Growing<Vertex> vertices;
  Growing<Face> faces;
  bool mirrored = true;  // has another half at x < 0

  explicit HalfMesh(Arena& arena) : vertices(arena), faces(arena) {}

  void quad(uint32_t a, uint32_t b, uint32_t c, uint32_t d) { faces.add({{a, b, c, d}, 4}); }
  void triangle(uint32_t a, uint32_t b, uint32_t c) { faces.add({{a, b, c, 0}, 3}); }
  /// Memory ran out; the contents are useless but safe to access.
  bool failed() const { return vertices.failed() || faces.failed(); }
  bool on_plane(uint32_t vertex) const { return mirrored && vertices[vertex].position.x == 0; }
};

/// `full` at LOD 0, about a tenth at the last, never below `least`.
uint32_t at_lod(uint32_t full, uint32_t least, uint32_t lod);
/// Joins rows of equal length by quads; counter-clockwise if rows go up and columns to the right as seen from
/// outside.
void join_rows(HalfMesh& out, uint32_t first, uint32_t rows, uint32_t columns);
/// A pseudorandom number -1 ... 1 for each `i`.
double scatter(uint32_t i);
/// A vertex that moves only with its carrier.
Vertex plain(Vec3 position, Color color, double u, double v, Carrier carrier);

/// These add to `out`, which is failed() if memory ran out. set_normals() completes a mesh.
void add_skin(const Form& form, HalfMesh& out);
void add_teeth(const Form& form, HalfMesh& out);
void add_tongue(const Form& form, HalfMesh& out);
void add_eyeball(const Form& form, HalfMesh& out);
void add_hair(const Form& form, uint32_t lod, HalfMesh& out);
void add_brow(const Form& form, uint32_t lod, HalfMesh& out);
void add_lashes(const Form& form, uint32_t lod, HalfMesh& out);
void set_normals(HalfMesh& mesh);
/// How much hair shows through the skin at a place of the form: 0 below the hair line, 1 under it.
double scalp(const Form& form, double angle, double y);

/// A part at LOD 0. Both eyes use the left one. False if memory ran out.
bool make_part(const Form& form, Part part, HalfMesh& out);
/// Hair, brows or lashes at a LOD.
bool make_hairs(const Form& form, Part part, uint32_t lod, HalfMesh& out);

struct PartLods {
  HalfMesh at[kLodCount];

  explicit PartLods(Arena& arena)
      : at{HalfMesh(arena), HalfMesh(arena), HalfMesh(arena), HalfMesh(arena),
           HalfMesh(arena), HalfMesh(arena), HalfMesh(arena), HalfMesh(arena)} {}
};
/// A part at every LOD: LOD 0 sampled, the others collapsed from it; of hair, brows and lashes all sampled. False if memory ran out.
bool make_lods(const Form& form, Part part, const Allocator& allocator, PartLods& out);

}  // namespace mien::head
