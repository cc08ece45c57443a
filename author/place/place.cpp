// SPDX-License-Identifier: MIT
#include "author/place/place.h"

#include <algorithm>
#include <limits>

#include "author/base/dna_making.h"
#include "author/mesh/topology.h"
#include "author/place/extra_joints.h"
#include "author/place/face_mask.h"
#include "author/place/find_landmarks.h"
#include "author/place/jaw_share.h"
#include "author/place/kmeans_run.h"
#include "author/place/rank.h"

namespace mien::author {

namespace {

// Relative to the width of the mask: points nearer to the plane than this lie on it.
constexpr double kOnPlane = 0.02;
constexpr double kLeastMotionWeight = 0.15;
constexpr double kCheapWork = 4e6;  // points times means times runs

/// Facial bones of one mean, in the order of their rank.
struct Unit {
  Vec3 position;  // of the left one
  bool pair;
  Vec3 right;  // of a pair
};

struct Facial {
  KMeansProblem problem;
  Span<const Unit> units;           // by rank
  Span<const uint32_t> lod_counts;  // joints of each LOD
};

/// Points, weights and densities of the mask; folded if the mask is symmetric.
Status pose_problem(Placing& placing, KMeansProblem& out) {
  const size_t n = placing.mask.count;
  const AuthorMesh& mesh = placing.mesh;
  Span<Vec3> points;
  Span<double> weights, density;
  if (!make(placing.scratch, n, points) || !make(placing.scratch, n, weights) ||
      !make(placing.scratch, n, density)) {
    return no_memory(placing);
  }
  for (size_t i = 0; i < n; ++i) points[i] = placing.points[placing.mask[i]];
  if (!surface_density(points, placing.parallel, placing.scratch, density)) {
    return no_memory(placing);
  }
  for (double& weight : weights) weight = 1;
  if (!placing.options.paper && !mesh.shapes.empty()) {
    double sum = 0;
    for (size_t i = 0; i < n; ++i) {
      double square = 0;
      for (const Shape& shape : mesh.shapes) {
        const Vec3f d = shape.displacements[placing.skin[placing.mask[i]]];
        square += double{d.x} * d.x + double{d.y} * d.y + double{d.z} * d.z;
      }
      weights[i] = std::sqrt(square / static_cast<double>(mesh.shapes.count));
      sum += weights[i];
    }
    const double mean = sum / static_cast<double>(n);
    for (double& weight : weights) weight = mean > 0 ? kLeastMotionWeight + weight / mean : 1;
  }
  if (placing.options.area_density) {
    double sum = 0;
    for (size_t i = 0; i < n; ++i) sum += placing.areas[placing.skin[placing.mask[i]]];
    const double mean = sum / static_cast<double>(n);
    for (size_t i = 0; i < n && mean > 0; ++i) {
      weights[i] *= 1e-6 + placing.areas[placing.skin[placing.mask[i]]] / mean;
    }
  }

  const uint32_t asked = placing.options.facial_joints;
  const uint32_t k = std::min(asked, static_cast<uint32_t>(n));
  placing.report.asked_joints = asked;
  if (placing.symmetric || placing.paired) {
    double width = 0;
    for (Vec3& p : points) {
      p.x = std::abs(p.x - placing.plane);
      width = std::max(width, 2 * p.x);
    }
    out.plane_width = kOnPlane * width;
    uint32_t on_plane = 0;
    for (const Vec3& p : points) on_plane += p.x <= out.plane_width;
    const uint32_t beside = (static_cast<uint32_t>(n) - on_plane) / 2;
    uint32_t q = std::max(2u, 2 * static_cast<uint32_t>(k * 0.05 + 0.5));
    q += (k + q) % 2;
    q = std::min(std::min(q, k), on_plane);
    out.free_means = std::min((k - q) / 2, beside);
    out.plane_means = q;
    if (out.free_means + out.plane_means == 0) out.free_means = 1;
    if (out.plane_means == 0) out.plane_width = -1;
  } else {
    out.free_means = k;
  }
  out.points = points;
  out.weights = weights;
  out.density = density;
  return Status::kOk;
}

/// Where halves are unlike, each bone of a pair goes to the mean of what is nearest to it on its own side.
/// False if memory ran out.
bool free_units(Placing& placing, Span<const double> weights, Span<Unit> units) {
  constexpr int kRounds = 8;
  struct Side {
    Vec3 at, sum;
    double weight;
  };
  Span<Side> sides;  // left, right of each unit; of one in the middle the left
  if (!make(placing.scratch, 2 * units.count, sides)) return false;
  for (size_t u = 0; u < units.count; ++u) {
    sides[2 * u].at = units[u].position;
    sides[2 * u + 1].at = units[u].right;
  }
  for (int round = 0; round < kRounds; ++round) {
    for (Side& side : sides) {
      side.sum = {};
      side.weight = 0;
    }
    for (size_t i = 0; i < placing.mask.count; ++i) {
      const Vec3 p = placing.points[placing.mask[i]];
      size_t nearest = 0;
      for (size_t s = 1; s < sides.count; ++s) {
        if (s % 2 == 1 && !units[s / 2].pair) continue;
        if (squared_distance(p, sides[s].at) < squared_distance(p, sides[nearest].at)) nearest = s;
      }
      sides[nearest].sum = sides[nearest].sum + p * weights[i];
      sides[nearest].weight += weights[i];
    }
    for (Side& side : sides) {
      if (side.weight > 0) side.at = side.sum * (1 / side.weight);
    }
  }
  for (size_t u = 0; u < units.count; ++u) {
    units[u].position = sides[2 * u].at;
    units[u].right = sides[2 * u + 1].at;
  }
  return true;
}

Status rank_units(Placing& placing, const KMeansRun& chosen, Facial& facial) {
  PlaceReport& report = placing.report;
  const KMeansProblem& problem = facial.problem;
  const uint32_t k = static_cast<uint32_t>(chosen.means.count);
  Span<uint32_t> joints, order, counts;
  Span<double> lod_objectives;
  Span<Unit> units;
  if (!make(placing.scratch, k, joints) || !make(placing.scratch, k, order) ||
      !make(placing.scratch, k, units) || !make(placing.arena, placing.options.lods, counts) ||
      !make(placing.arena, placing.options.lods, lod_objectives)) {
    return no_memory(placing);
  }
  uint32_t total = 0;
  for (uint32_t c = 0; c < k; ++c) {
    const bool in_pairs = placing.symmetric || placing.paired;
    joints[c] = in_pairs && c < problem.free_means ? 2 : 1;
    total += joints[c];
  }
  joint_ladder(total, placing.options.lod_joints, counts);
  if (!rank_means(problem.points, problem.weights, chosen.means, joints, placing.scratch, order,
                  counts, lod_objectives)) {
    return no_memory(placing);
  }
  for (uint32_t rank = 0; rank < k; ++rank) {
    Vec3 p = chosen.means[order[rank]];
    if (placing.symmetric || placing.paired) p.x += placing.plane;
    units[rank] = {p, joints[order[rank]] == 2, {2 * placing.plane - p.x, p.y, p.z}};
  }
  if (placing.paired && !free_units(placing, problem.weights, units)) return no_memory(placing);
  report.lod_objectives = lod_objectives;
  facial.units = units;
  facial.lod_counts = counts;
  return Status::kOk;
}

Status find_facial(Placing& placing, const Allocator& allocator, Facial& facial) {
  PlaceReport& report = placing.report;
  if (Status status = pose_problem(placing, facial.problem); status != Status::kOk) return status;
  // With few points and means many runs end badly, but runs are cheap.
  const double work = static_cast<double>(facial.problem.points.count) *
                      (facial.problem.free_means + facial.problem.plane_means);
  const double affordable = kCheapWork / work;
  const uint32_t runs = placing.options.paper || affordable < kRuns ? kRuns
                        : affordable > kMaxRuns                     ? kMaxRuns
                                                : static_cast<uint32_t>(affordable);
  report.run_count = runs;
  for (uint32_t r = 0; r < runs; ++r) {
    report.runs[r].start = r == 0                  ? Start::kDenseSpread
                           : placing.options.paper ? Start::kDenseSpreadRandom
                                                   : Start::kPlusPlus;
  }
  if (!run_kmeans(facial.problem, placing.options.seed, placing.parallel, placing.arena, allocator,
                  {report.runs, runs})) {
    return no_memory(placing);
  }
  for (uint32_t r = 1; r < runs; ++r) {
    if (report.runs[r].objective < report.runs[report.chosen_run].objective) report.chosen_run = r;
  }
  if (!placing.options.paper) {
    if (!improve_kmeans(facial.problem, report.runs[report.chosen_run], placing.arena, allocator,
                        report.runs[runs])) {
      return no_memory(placing);
    }
    if (report.runs[runs].objective < report.runs[report.chosen_run].objective) {
      report.chosen_run = runs;
    }
    report.run_count = runs + 1;
  }
  return rank_units(placing, report.runs[report.chosen_run], facial);
}

// Names ------------------------------------------------------------------------------------------

/// The region of the face, by height and distance from the middle relative to the mask.
const char* region_of(double height, double aside) {
  if (height > 0.82) return "Forehead";
  if (height > 0.68) return "Brow";
  if (height > 0.55) return aside < 0.2 ? "Bridge" : "Eye";
  if (height > 0.40) return aside < 0.25 ? "Nose" : "Cheek";
  if (height > 0.20) return aside < 0.45 ? "Mouth" : "Cheek";
  return aside < 0.4 ? "Chin" : "Jaw";
}

bool name_bone(Arena& arena, const Text& text, Name& out) {
  Span<char> chars;
  if (!make(arena, text.count, chars)) return false;
  memcpy(chars.data, text.chars, text.count);
  out = {chars.data, chars.count};
  return true;
}

struct Naming {
  Box mask;
  double plane, width;

  Text facial(Vec3 p, char side, uint32_t number) const {
    const Vec3 size = mask.size();
    const double height = size.y > 0 ? (p.y - mask.low.y) / size.y : 0;
    const double aside = width > 0 ? std::abs(p.x - plane) / (width / 2) : 0;
    return Text().add("FACIAL_").add(&side, 1).add("_").add(region_of(height, aside)).add(number);
  }
};

// Bones ------------------------------------------------------------------------------------------

struct Bones {
  Arena& arena;
  Span<Bone> bones;
  uint32_t count = 0;
  bool failed = false;

  uint32_t add(const Text& name, Vec3 position, uint32_t parent, BoneKind kind) {
    failed = failed || !name_bone(arena, name, bones[count].name);
    bones[count].position = position;
    bones[count].parent = parent;
    bones[count].mirror = count;
    bones[count].kind = kind;
    return count++;
  }
};

/// The jaw's joint: by the shape that opens it, or by landmarks, where lips are apart or given.
Status place_jaw(Placing& placing, const NeckCut& cut, Placement& out) {
  PlaceReport& report = placing.report;
  Landmarks& marks = report.landmarks;
  Jaw jaw;
  if (!find_jaw(placing.mesh, placing.plane, placing.scratch, jaw)) return no_memory(placing);
  Landmark& mark = marks[LandmarkKind::kJaw];
  if (jaw.found) {
    report.jaw_shape = placing.mesh.shapes[jaw.shape].name;
    report.jaw_angle = jaw.angle;
    marks.found(LandmarkKind::kJaw, jaw.position, jaw.by_teeth ? 0.9 : 0.7);
  } else {
    constexpr LandmarkKind kMouth[] = {LandmarkKind::kLipUpper, LandmarkKind::kLipLower,
                                       LandmarkKind::kMouthLeft, LandmarkKind::kMouthRight,
                                       LandmarkKind::kChin};
    bool is_known = marks[LandmarkKind::kNose].known, is_given = mark.given;
    double sure = 1;
    for (const LandmarkKind kind : kMouth) {
      is_known = is_known && marks[kind].known;
      is_given = is_given || marks[kind].given;
      sure = std::min(sure, marks[kind].confidence);
    }
    // Shapes that do not open the jaw leave it closed.
    const bool has_no_shapes = placing.mesh.shapes.empty() && placing.has_mouth;
    if (!is_known || (!is_given && !has_no_shapes)) return Status::kOk;
    for (const LandmarkKind kind : kMouth) marks[kind].is_used = true;
    marks.found(LandmarkKind::kJaw, jaw_by_proportions(marks), 0.6 * sure);
    Span<float> share;
    if (Status status = make_jaw_share(placing, cut, share); status != Status::kOk) return status;
    out.jaw_share = share;
  }
  report.jaw_joint = mark.is_used = true;
  return Status::kOk;
}

/// Hangs facial bones below the jaw where most of the mask that is nearest to them follows it.
Status hang_by_share(Placing& placing, uint32_t jaw, Span<const float> share, uint32_t first,
                     Span<Bone> facial) {
  struct Sums {
    double share = 0, all = 0;
  };
  Span<Sums> sums;
  if (!make(placing.scratch, facial.count, sums)) return no_memory(placing);
  for (const uint32_t i : placing.mask) {
    size_t nearest = 0;
    for (size_t b = 1; b < facial.count; ++b) {
      if (squared_distance(placing.points[i], facial[b].position) <
          squared_distance(placing.points[i], facial[nearest].position)) {
        nearest = b;
      }
    }
    sums[nearest].share += double{share[placing.skin[i]]};
    sums[nearest].all += 1;
  }
  for (size_t b = 0; b < facial.count; ++b) {
    const size_t other = facial[b].mirror - first;
    if (sums[b].share + sums[other].share > 0.5 * (sums[b].all + sums[other].all)) {
      facial[b].parent = jaw;
    }
  }
  return Status::kOk;
}

/// Eyes that the caller gave: the ball there moves to them, or there is one more eye.
Status use_eye_landmarks(Placing& placing, Eye (&eyes)[kMaxEyes], uint32_t& count) {
  Landmarks& marks = placing.report.landmarks;
  const uint32_t found = count;
  for (const int side : {1, -1}) {
    const LandmarkKind kind = side > 0 ? LandmarkKind::kEyeLeft : LandmarkKind::kEyeRight;
    Landmark& mark = marks[kind];
    Eye* eye = nullptr;
    for (uint32_t e = 0; e < found; ++e) {
      const bool is_there = mark.given ? length(eyes[e].center - mark.at) < 1.5 * eyes[e].radius
                                       : eyes[e].side == side;
      if (is_there && !eye) eye = &eyes[e];
    }
    if (mark.given) {
      if (!eye && count < kMaxEyes) {
        eye = &eyes[count++];
        *eye = Eye();
      }
      if (!eye) continue;
      eye->center = mark.at;
      eye->side = side;
    } else if (eye) {
      marks.found(kind, eye->center, 1 - 5 * eye->error / eye->radius);
    }
    mark.is_used = eye != nullptr;
  }
  return Status::kOk;
}

Status make_bones(Placing& placing, const Facial& facial, const Body& body, Placement& out) {
  PlaceReport& report = placing.report;
  uint32_t facial_count = 0;
  for (const Unit& unit : facial.units) facial_count += unit.pair ? 2 : 1;
  Bones bones = {placing.arena, {}};
  // root, chest, head, face, jaw
  constexpr uint32_t kOthers = 5 + Body::kMaxNecks + Tongue::kJoints + kMaxEyes;
  if (!make(placing.arena, facial_count + kOthers, bones.bones)) return no_memory(placing);
  const uint32_t root = bones.add(Text().add("root"), {}, 0, BoneKind::kRoot);
  uint32_t below = bones.add(Text().add("chest"), body.chest, root, BoneKind::kChest);
  for (uint32_t n = 0; n < body.neck_count; ++n) {
    Text name = Text().add("neck");
    if (n > 0) name.add(uint64_t{n + 1});
    below = bones.add(name, body.necks[n], below, BoneKind::kNeck);
  }
  const uint32_t head_bone = bones.add(Text().add("head"), body.head, below, BoneKind::kHead);
  const uint32_t face = bones.add(Text().add("face"), body.head, head_bone, BoneKind::kFace);

  Naming naming = {{}, placing.plane, 0};
  naming.mask = {placing.points[placing.mask[0]], placing.points[placing.mask[0]]};
  for (uint32_t i : placing.mask) {
    const Vec3 p = placing.points[i];
    Vec3 &low = naming.mask.low, &high = naming.mask.high;
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  naming.width = naming.mask.size().x;
  uint32_t jaw_bone = face;
  if (!placing.options.paper) {
    if (Status status = place_jaw(placing, body.cut, out); status != Status::kOk) return status;
    if (report.jaw_joint) {
      jaw_bone = bones.add(Text().add("jaw"), report.landmarks[LandmarkKind::kJaw].at, face,
                           BoneKind::kJaw);
    }
    Tongue tongue;
    if (!find_tongue(placing.mesh, placing.scratch, tongue)) return no_memory(placing);
    uint32_t above = jaw_bone;
    for (uint32_t i = 0; i < Tongue::kJoints && tongue.component != kNone; ++i) {
      Vec3 at = tongue.joints[i];
      if (placing.symmetric) at.x = placing.plane;
      above = bones.add(Text().add("tongue").add(uint64_t{i + 1}), at, above, BoneKind::kTongue);
    }
  }
  out.first_facial = bones.count;
  for (uint32_t u = 0; u < facial.units.count; ++u) {
    const Unit& unit = facial.units[u];
    const double off = unit.position.x - placing.plane;
    const bool in_pairs = placing.symmetric || placing.paired;
    const bool center = in_pairs ? !unit.pair : std::abs(off) < kOnPlane * naming.width;
    const char side = center ? 'C' : off >= 0 ? 'L' : 'R';
    const uint32_t first = bones.add(naming.facial(unit.position, side, u + 1), unit.position, face,
                                     BoneKind::kFacial);
    bones.bones[first].rank = first - out.first_facial;
    if (!unit.pair) continue;
    const uint32_t second =
        bones.add(naming.facial(unit.position, 'R', u + 1), unit.right, face, BoneKind::kFacial);
    bones.bones[second].rank = second - out.first_facial;
    bones.bones[first].mirror = second;
    bones.bones[second].mirror = first;
  }
  out.facial_count = bones.count - out.first_facial;
  if (!out.jaw_share.empty()) {
    const Status status = hang_by_share(placing, jaw_bone, out.jaw_share, out.first_facial,
                                        bones.bones.slice(out.first_facial, out.facial_count));
    if (status != Status::kOk) return status;
  }

  if (!placing.options.paper) {
    Eye eyes[kMaxEyes];
    uint32_t eye_count = 0;
    Span<uint32_t> eye_of;
    if (!make(placing.scratch, placing.mesh.component_count, eye_of) ||
        !find_eyes(placing.mesh, placing.plane, placing.symmetric, placing.scratch, eyes, eye_count,
                   eye_of)) {
      return no_memory(placing);
    }
    if (Status status = use_eye_landmarks(placing, eyes, eye_count); status != Status::kOk) {
      return status;
    }
    uint32_t numbers[3] = {}, bone_of[kMaxEyes];
    for (uint32_t e = 0; e < eye_count; ++e) {
      Text name = Text().add(eyes[e].side > 0 ? "eye_l" : eyes[e].side < 0 ? "eye_r" : "eye_c");
      const uint32_t number = ++numbers[eyes[e].side + 1];
      if (number > 1) name.add(number);
      bone_of[e] = bones.add(name, eyes[e].center, face, BoneKind::kEye);
      for (uint32_t other = 0; other < e; ++other) {
        const Vec3 a = eyes[e].center, b = eyes[other].center;
        const bool is_mirror =
            a.x - placing.plane == placing.plane - b.x && a.y == b.y && a.z == b.z;
        if (eyes[e].side * eyes[other].side != -1 || !(is_mirror || placing.paired)) continue;
        bones.bones[bone_of[e]].mirror = bone_of[other];
        bones.bones[bone_of[other]].mirror = bone_of[e];
      }
    }
    report.eye_joints = eye_count;
  }
  if (bones.failed) return no_memory(placing);
  out.bones = bones.bones.first(bones.count);
  out.lod_facial_counts = facial.lod_counts;
  out.symmetric = placing.symmetric || placing.paired;
  report.paired = placing.paired;
  out.symmetry_plane = placing.plane;
  out.neck_cut = body.cut;
  return Status::kOk;
}

Status list_mask(Placing& placing, Placement& out) {
  const AuthorMesh& mesh = placing.mesh;
  Span<uint8_t> in;
  if (!make(placing.scratch, mesh.positions.count, in)) return no_memory(placing);
  for (uint32_t i : placing.mask) in[placing.skin[i]] = 1;
  size_t count = 0;
  for (uint32_t v = 0; v < in.count; ++v) count += in[mesh.welded[v]];
  Span<uint32_t> list;
  if (!make(placing.arena, count, list)) return no_memory(placing);
  count = 0;
  for (uint32_t v = 0; v < in.count; ++v) {
    if (in[mesh.welded[v]]) list[count++] = v;
  }
  out.mask = list;
  return Status::kOk;
}

Status measure_coverage(Placing& placing, const Placement& placement) {
  const Span<const Bone> bones =
      placement.bones.slice(placement.first_facial, placement.facial_count);
  Span<double> gaps;
  if (!make(placing.scratch, bones.count, gaps)) return no_memory(placing);
  const auto nearest_to = [&](Vec3 p, size_t except) {
    double best = std::numeric_limits<double>::infinity();
    for (size_t b = 0; b < bones.count; ++b) {
      const Vec3 d = bones[b].position - p;
      if (b != except) best = std::min(best, dot(d, d));
    }
    return std::sqrt(best);
  };
  for (size_t b = 0; b < bones.count; ++b) gaps[b] = nearest_to(bones[b].position, b);
  std::sort(gaps.begin(), gaps.end());
  placing.report.spacing = bones.count > 1 ? gaps[gaps.count / 2] : placing.box.diagonal();
  double far = 0;
  for (uint32_t i : placing.mask) {
    far += nearest_to(placing.points[i], bones.count) > 2 * placing.report.spacing;
  }
  placing.report.uncovered = far / static_cast<double>(placing.mask.count);
  return Status::kOk;
}

}  // namespace

Status place_bones(const AuthorMesh& mesh, const PlaceOptions& options, const ParallelFor& parallel,
                   Arena& arena, const Allocator& allocator, Placement& out, PlaceReport& report,
                   Error& error) {
  out = Placement();
  report = PlaceReport();
  Arena scratch(allocator);
  Placing placing = {mesh, options, parallel, arena, scratch, report, error};
  Body body;
  Facial facial;
  Status status = find_skin(placing);
  if (status == Status::kOk) status = take_landmarks(placing);
  if (status == Status::kOk) status = group_in_depth(placing);
  if (status == Status::kOk) status = find_mask(placing);
  if (status == Status::kOk) status = find_symmetry(placing);
  if (status == Status::kOk) status = find_landmarks(placing);
  if (status == Status::kOk) status = find_body(placing, body);
  if (status == Status::kOk) status = find_facial(placing, allocator, facial);
  if (status == Status::kOk) status = make_bones(placing, facial, body, out);
  if (status == Status::kOk) status = list_mask(placing, out);
  if (status == Status::kOk) status = measure_coverage(placing, out);
  return status;
}

}  // namespace mien::author
