// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "runtime/probe/probe_guards.h"

namespace mien {
namespace {

constexpr double kTouching = 0.01;  // millimeters
constexpr double kApart = 2;        // millimeters
// Lids also move when the eyes look around or the face smiles, and the jaw moves in all speech: smaller
// motions are no blink and no S.
constexpr float kLidsOn = 6, kTeethOn = 4;

/// Positions on the two edges of a slit, and where they meet, from right to left.
struct EdgePair {
  uint32_t upper, lower;
  double across;
};

using Names = std::initializer_list<const char*>;

class Finder {
 public:
  Finder(const Deformer& deformer, const Allocator& allocator, RigProbe& probe, Arena& arena,
         StandardGuards& out)
      : deformer_(deformer), allocator_(allocator), probe_(probe), arena_(arena), out_(out) {}

  void find_lips() {
    const uint16_t jaw = find_raw_control(probe_.rig(), {"jawOpen"});
    if (jaw != kNoControl && find_edges(kNoControl, jaw)) {
      double half = 0;
      for (const EdgePair& e : edges_) half = std::max(half, std::fabs(e.across));
      add_edges(StandardGuard::kLipsLeft, 0.4 * half, 0.7 * half, kNoControl);
      add_edges(StandardGuard::kLipsCenter, -0.2 * half, 0.2 * half, kNoControl);
      add_edges(StandardGuard::kLipsRight, -0.7 * half, -0.4 * half, kNoControl);
      return;
    }
    add_joints(StandardGuard::kLipsLeft, {"FACIAL_L_LipUpper"}, {"FACIAL_L_LipLower"});
    add_joints(StandardGuard::kLipsCenter, {"FACIAL_C_LipUpper"}, {"FACIAL_C_LipLower"});
    add_joints(StandardGuard::kLipsRight, {"FACIAL_R_LipUpper"}, {"FACIAL_R_LipLower"});
  }

  void find_teeth() {
    const uint32_t lips = out_.count;
    add_joints(StandardGuard::kTeeth, {"C_TeethUpper", "FACIAL_C_TeethUpper"},
               {"C_TeethLower", "FACIAL_C_TeethLower"});
    if (out_.count == lips) return;
    for (uint32_t i = 0; i < lips; ++i) {
      if (out_.kinds[i] != StandardGuard::kLipsCenter) continue;
      GuardDesc desc = out_.descs[i];
      desc.upper = out_.descs[lips].upper;
      add(StandardGuard::kLipToTeeth, desc);
      break;
    }
  }

  void find_lids(StandardGuard kind, Names blinks, Names upper, Names lower) {
    const uint16_t blink = find_raw_control(probe_.rig(), blinks);
    if (blink == kNoControl) return;
    if (find_edges(blink, kNoControl)) {
      double least = edges_[0].across, most = least;
      for (const EdgePair& e : edges_) {
        least = std::min(least, e.across);
        most = std::max(most, e.across);
      }
      const double third = (most - least) / 3;
      add_edges(kind, least + third, most - third, blink);
      return;
    }
    add_joints(kind, upper, lower, blink);
  }

  bool failed() const { return failed_; }

 private:
  /// Positions of one mesh that lie together in one pose and apart in another.
  bool find_edges(uint16_t closed_by, uint16_t opened_by) {
    edges_ = {};
    for (uint32_t m = 0; m < deformer_.meshes.count && edges_.empty(); ++m) {
      mesh_ = m;
      if (deformer_.meshes[m].lods & 1) find_edges_of(m, closed_by, opened_by);
    }
    return !edges_.empty();
  }

  void find_edges_of(uint32_t mesh, uint16_t closed_by, uint16_t opened_by) {
    struct Cell {
      int64_t x, y, z;
      uint32_t position;
    };
    const uint32_t count = deformer_.meshes[mesh].position_count;
    const double step = kTouching / probe_.millimeters();
    const Vec3 up = probe_.axis(2) * probe_.millimeters(), left = probe_.axis(0);
    Arena scratch(allocator_);
    const Span<Cell> cells = scratch.array<Cell>(count);
    const Span<EdgePair> found = scratch.array<EdgePair>(count);
    if (count == 0) return;
    if (failed_ = failed_ || !cells.data || !found.data; failed_) return;
    pose(closed_by);
    const auto at = [&](uint32_t p) {
      const float* v = probe_.positions(mesh).data + size_t{p} * 3;
      return Vec3{v[0], v[1], v[2]};
    };
    const auto cell = [step](double v) { return static_cast<int64_t>(std::floor(v / step + 0.5)); };
    for (uint32_t p = 0; p < count; ++p)
      cells[p] = {cell(at(p).x), cell(at(p).y), cell(at(p).z), p};
    std::sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) {
      if (a.x != b.x) return a.x < b.x;
      if (a.y != b.y) return a.y < b.y;
      return a.z != b.z ? a.z < b.z : a.position < b.position;
    });
    uint32_t pairs = 0;
    for (uint32_t i = 0; i + 1 < count; ++i) {
      const Cell &a = cells[i], &b = cells[i + 1];
      if (a.x != b.x || a.y != b.y || a.z != b.z) continue;
      found[pairs++] = {a.position, b.position, dot(at(a.position), left)};
    }
    pose(opened_by);
    uint32_t parted = 0;
    for (uint32_t i = 0; i < pairs; ++i) {
      EdgePair e = found[i];
      const double gap = dot(at(e.upper) - at(e.lower), up);
      if (gap < 0) std::swap(e.upper, e.lower);
      if (std::fabs(gap) >= kApart) found[parted++] = e;
    }
    if (parted == 0) return;
    edges_ = arena_.array<EdgePair>(parted);
    failed_ = failed_ || !edges_.data;
    std::copy_n(found.begin(), edges_.count, edges_.begin());
  }

  void pose(uint16_t control) {
    probe_.clear();
    if (control != kNoControl) probe_.set(control, 1);
    probe_.pose();
  }

  void add(StandardGuard kind, GuardDesc desc) {
    desc.needs_speech = kind != StandardGuard::kLidsLeft && kind != StandardGuard::kLidsRight;
    if (!desc.needs_speech) desc.f_on = kLidsOn;
    if (kind == StandardGuard::kTeeth) desc.f_on = kTeethOn;
    desc.kind = static_cast<uint32_t>(kind);
    out_.kinds[out_.count] = kind;
    out_.descs[out_.count++] = desc;
  }

  /// The edges between two places.
  void add_edges(StandardGuard kind, double from, double to, uint16_t closed_by) {
    const Span<uint32_t> upper = arena_.array<uint32_t>(edges_.count);
    const Span<uint32_t> lower = arena_.array<uint32_t>(edges_.count);
    if (failed_ = failed_ || !upper.data || !lower.data; failed_) return;
    size_t count = 0;
    for (const EdgePair& e : edges_) {
      if (e.across < from || e.across > to) continue;
      upper[count] = e.upper;
      lower[count++] = e.lower;
    }
    if (count == 0) return;
    GuardDesc desc;
    desc.upper = {mesh_, upper.first(count)};
    desc.lower = {mesh_, lower.first(count)};
    desc.closed_by = closed_by;
    add(kind, desc);
  }

  void add_joints(StandardGuard kind, Names upper, Names lower, uint16_t closed_by = kNoControl) {
    const uint16_t above = find_joint(probe_.rig(), upper), below = find_joint(probe_.rig(), lower);
    if (above == kNoJoint || below == kNoJoint) return;
    const Span<uint32_t> points = arena_.array<uint32_t>(2);
    if (failed_ = failed_ || !points.data; failed_) return;
    points[0] = above;
    points[1] = below;
    GuardDesc desc;
    desc.upper = {kOfJoints, points.first(1)};
    desc.lower = {kOfJoints, points.slice(1, 1)};
    desc.closed_by = closed_by;
    add(kind, desc);
  }

  const Deformer& deformer_;
  const Allocator& allocator_;
  RigProbe& probe_;
  Arena& arena_;
  StandardGuards& out_;
  Span<EdgePair> edges_;  // the pair found last
  uint32_t mesh_ = 0;     // of these
  bool failed_ = false;
};

}  // namespace

Status find_standard_guards(const Deformer& deformer, const Allocator& allocator, Arena& arena,
                            StandardGuards& out, Error& error) {
  out = {};
  RigProbe probe(deformer, allocator);
  if (probe.ready()) {
    Finder finder(deformer, allocator, probe, arena, out);
    finder.find_lips();
    finder.find_teeth();
    finder.find_lids(StandardGuard::kLidsLeft, {"eyeBlinkLeft", "eyeBlinkL"},
                     {"FACIAL_L_EyelidUpperA2"}, {"FACIAL_L_EyelidLowerA2"});
    finder.find_lids(StandardGuard::kLidsRight, {"eyeBlinkRight", "eyeBlinkR"},
                     {"FACIAL_R_EyelidUpperA2"}, {"FACIAL_R_EyelidLowerA2"});
    if (!finder.failed()) return Status::kOk;
  }
  out = {};
  return fail(error, Status::kMemory, kNoOffset, "no memory to look for lips and lids");
}

}  // namespace mien
