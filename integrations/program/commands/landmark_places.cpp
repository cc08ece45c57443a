// SPDX-License-Identifier: MIT
#include "integrations/program/commands/landmark_places.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

using math::Vec3d;

// The controls by which places of two faces are compared. The jaw and the lids come first.
constexpr const char* kComparedControls[kFaceMotions] = {
    "jawOpen",         "eyeBlinkLeft",   "eyeBlinkRight",   "mouthSmileLeft",
    "mouthSmileRight", "browInnerUp",    "browOuterUpLeft", "browOuterUpRight",
    "noseSneerLeft",   "noseSneerRight", "mouthPucker"};
enum ComparedControl { kJaw = 0, kLeftLid = 1, kRightLid = 2 };

// Lengths in distances between the eyes, which are about 6.4 cm.
constexpr double kFaceReach = 1.9;      // of what takes part, from the middle of the face
constexpr double kMatchReach = 0.4;     // farther places do not correspond
constexpr double kMotionLength = 0.12;  // by which places differ that move fully and not at all
constexpr double kFirstRadius = 0.5, kLastRadius = 0.06;  // within which places move alike
constexpr int kBendings = 24;
constexpr size_t kMostSamples = 1200;
constexpr double kSameSide = 0.3;  // least cosine between normals of places that correspond

struct Bendable {
  std::vector<Vec3d> at, normals;
  std::vector<std::array<float, kFaceMotions>> motions;
};

void find_normals(FaceSurface& face) {
  face.normals.assign(face.positions.size(), {});
  for (const std::array<uint32_t, 3>& t : face.triangles) {
    const Vec3d a = face.positions[t[0]], b = face.positions[t[1]], c = face.positions[t[2]];
    const Vec3d normal = cross(b - a, c - a);
    for (const uint32_t corner : t) face.normals[corner] += normal;
  }
  for (Vec3d& normal : face.normals) normal = normalized(normal, Vec3d{});
}

/// The outline seen from the side: of each height the frontmost position near the middle.
struct Profile {
  double top = 0, step = 0;
  std::vector<int64_t> positions;  // from the top down; -1: none

  Profile(const FaceSurface& face, double middle, double from, double to, double size) {
    top = from;
    step = 0.02 * size;
    positions.assign(static_cast<size_t>(std::max(1.0, (from - to) / step)), -1);
    for (size_t i = 0; i < face.positions.size(); ++i) {
      const Vec3d p = face.positions[i];
      const double row = (top - p.y) / step;
      if (std::fabs(p.x - middle) > 0.06 * size || face.normals[i].z <= 0 || row < 0 ||
          row >= static_cast<double>(positions.size())) {
        continue;
      }
      int64_t& front = positions[static_cast<size_t>(row)];
      if (front < 0 || p.z > face.positions[static_cast<size_t>(front)].z) {
        front = static_cast<int64_t>(i);
      }
    }
  }

  /// The frontmost position between two heights.
  Vec3d front(const FaceSurface& face, double high, double low) const {
    Vec3d found = {0, 0, -std::numeric_limits<double>::infinity()};
    for (const int64_t i : positions) {
      if (i < 0) continue;
      const Vec3d p = face.positions[static_cast<size_t>(i)];
      if (p.y <= high && p.y >= low && p.z > found.z) found = p;
    }
    return found;
  }
};

void find_nose_and_chin(FaceSurface& face) {
  const double size = face.eye_distance();
  const Vec3d eyes = (face.left_lid + face.right_lid) * 0.5;
  const Profile profile(face, eyes.x, eyes.y, eyes.y - 2.4 * size, size);
  face.nose = profile.front(face, eyes.y - 0.2 * size, face.mouth.y);
  face.chin = profile.front(face, face.mouth.y - 0.38 * size, face.mouth.y - 0.85 * size);
}

[[noreturn]] void fail_face(const SolvedRig& rig, const std::string& why) {
  fail(kInvalid, "cannot place landmarks", rig.shown, why, "give the places with --landmarks FILE");
}

/// The middle of what the control moves most.
Vec3d find_edge(const FaceSurface& face, ComparedControl control) {
  Vec3d sum;
  double count = 0;
  for (size_t i = 0; i < face.positions.size(); ++i) {
    if (face.motions[i][control] < 0.9f) continue;
    sum += face.positions[i];
    ++count;
  }
  return sum * (1 / std::max(count, 1.0));
}

/// Between the last place from the top that stays where it is, and the first one that follows the jaw.
bool find_mouth(FaceSurface& face) {
  const double size = face.eye_distance();
  const Vec3d eyes = (face.left_lid + face.right_lid) * 0.5;
  const Profile profile(face, eyes.x, eyes.y - 0.5 * size, eyes.y - 2.2 * size, size);
  int64_t above = -1;
  for (const int64_t i : profile.positions) {
    if (i < 0) continue;
    if (above >= 0 && face.motions[static_cast<size_t>(i)][kJaw] > 0.5f) {
      face.mouth =
          (face.positions[static_cast<size_t>(above)] + face.positions[static_cast<size_t>(i)]) *
          0.5;
      return true;
    }
    above = i;
  }
  return false;
}

/// A scale along each axis, then five places exactly, and what is around them with them.
struct FirstGuess {
  Vec3d scale, from_eyes, to_eyes;
  std::array<Vec3d, 5> centers, moves;
  double radius;

  FirstGuess(const FaceSurface& from, const FaceSurface& to) {
    from_eyes = (from.left_lid + from.right_lid) * 0.5;
    to_eyes = (to.left_lid + to.right_lid) * 0.5;
    const double x = to.eye_distance() / from.eye_distance();
    const double y = (to_eyes.y - to.chin.y) / (from_eyes.y - from.chin.y);
    // Faces of the same breadth differ in how far their eyes are apart.
    const double across = y + 0.25 * (x - y);
    scale = {across, y, across};
    radius = to.eye_distance();
    const Vec3d sources[] = {from.left_lid, from.right_lid, from.mouth, from.nose, from.chin};
    const Vec3d targets[] = {to.left_lid, to.right_lid, to.mouth, to.nose, to.chin};
    double matrix[5][8];
    for (size_t i = 0; i < 5; ++i) {
      centers[i] = scaled(sources[i]);
      for (int k = 0; k < 3; ++k) matrix[i][5 + k] = targets[i][k] - centers[i][k];
    }
    for (size_t i = 0; i < 5; ++i) {
      for (size_t j = 0; j < 5; ++j) matrix[i][j] = kernel(centers[i] - centers[j]);
    }
    // Gaussian elimination; kernels make a positive definite matrix.
    for (size_t c = 0; c < 5; ++c) {
      for (size_t r = 0; r < 5; ++r) {
        if (r == c) continue;
        const double factor = matrix[r][c] / matrix[c][c];
        for (size_t k = c; k < 8; ++k) matrix[r][k] -= factor * matrix[c][k];
      }
    }
    for (size_t i = 0; i < 5; ++i) {
      for (int k = 0; k < 3; ++k) moves[i][k] = matrix[i][5 + k] / matrix[i][i];
    }
  }

  Vec3d scaled(Vec3d p) const { return (p - from_eyes) * scale + to_eyes; }
  double kernel(Vec3d d) const { return std::exp(-dot(d, d) / (radius * radius)); }
  Vec3d operator()(Vec3d p) const {
    Vec3d at = scaled(p);
    Vec3d move;
    for (size_t i = 0; i < 5; ++i) move += moves[i] * kernel(at - centers[i]);
    return at + move;
  }
};

bool is_in_face(const FaceSurface& face, size_t i) {
  const Vec3d middle = (face.nose + face.mouth) * 0.5;
  return face.normals[i].z > -0.5 && face.positions[i].z > middle.z - 1.7 * face.eye_distance() &&
         length(face.positions[i] - middle) < kFaceReach * face.eye_distance();
}

std::array<float, kFaceMotions> mixed(const FaceSurface& face, const FacePoint& point) {
  std::array<float, kFaceMotions> out = {};
  if (face.motions.empty()) return out;
  for (size_t k = 0; k < 3; ++k) {
    for (size_t m = 0; m < kFaceMotions; ++m) {
      out[m] += point.weights[k] * face.motions[point.positions[k]][m];
    }
  }
  return out;
}

Vec3d mixed(const std::vector<Vec3d>& values, const FacePoint& point) {
  Vec3d out;
  for (size_t k = 0; k < 3; ++k) {
    out += values[point.positions[k]] * static_cast<double>(point.weights[k]);
  }
  return out;
}

/// The place of a triangle that is nearest to p, as weights of its corners.
std::array<double, 3> nearest_of(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  const Vec3d ab = b - a, ac = c - a, ap = p - a;
  const double bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac);
  const double determinant = bb * cc - bc * bc, pb = dot(ap, ab), pc = dot(ap, ac);
  if (determinant > 0) {
    const double v = (cc * pb - bc * pc) / determinant, w = (bb * pc - bc * pb) / determinant;
    if (v >= 0 && w >= 0 && v + w <= 1) return {1 - v - w, v, w};
  }
  // On an edge.
  const Vec3d corners[] = {a, b, c};
  std::array<double, 3> best = {1, 0, 0};
  double nearest = std::numeric_limits<double>::infinity();
  for (size_t e = 0; e < 3; ++e) {
    const Vec3d from = corners[e], edge = corners[(e + 1) % 3] - from;
    const double t = std::clamp(dot(p - from, edge) / std::max(dot(edge, edge), 1e-12), 0.0, 1.0);
    const double d = length(p - (from + edge * t));
    if (d >= nearest) continue;
    nearest = d;
    best = {};
    best[e] = 1 - t;
    best[(e + 1) % 3] = t;
  }
  return best;
}

/// Compares places: their distance, and what moves them.
class FaceMatcher {
 public:
  FaceMatcher(const FaceSurface& from, const FaceSurface& to) : to_(to) {
    length_ = kMotionLength * to.eye_distance();
    for (size_t m = 0; m < kFaceMotions; ++m) {
      if (from.has_motion[m] && to.has_motion[m]) compared_.push_back(m);
    }
    for (size_t i = 0; i < to.positions.size(); ++i) {
      if (is_in_face(to, i)) near_.push_back(static_cast<uint32_t>(i));
    }
  }

  double difference(const std::array<float, kFaceMotions>& a,
                    const std::array<float, kFaceMotions>& b) const {
    double sum = 0;
    for (const size_t m : compared_) {
      const double d = length_ * static_cast<double>(a[m] - b[m]);
      sum += d * d;
    }
    return sum;
  }

  /// The position that corresponds best; false if none is near.
  bool find(Vec3d p, Vec3d normal, const std::array<float, kFaceMotions>& motion,
            Vec3d& found) const {
    const double reach = kMatchReach * to_.eye_distance();
    double best = reach * reach;
    bool any = false;
    for (const uint32_t i : near_) {
      const Vec3d d = to_.positions[i] - p;
      double cost = dot(d, d);
      if (cost >= best || dot(to_.normals[i], normal) < kSameSide) continue;
      if (!compared_.empty()) cost += difference(motion, to_.motions[i]);
      if (cost >= best) continue;
      best = cost;
      found = to_.positions[i];
      any = true;
    }
    return any;
  }

  /// The place on a face that corresponds best.
  FacePoint place(Vec3d p, Vec3d normal, const std::array<float, kFaceMotions>& motion) const {
    double best = std::numeric_limits<double>::infinity();
    FacePoint found = face_point(0);
    const double reach = kMatchReach * to_.eye_distance();
    for (const std::array<uint32_t, 3>& t : to_.triangles) {
      const Vec3d a = to_.positions[t[0]], b = to_.positions[t[1]], c = to_.positions[t[2]];
      const Vec3d off = a - p;
      if (dot(off, off) > reach * reach * 4) continue;
      const std::array<double, 3> w = nearest_of(p, a, b, c);
      const Vec3d d = a * w[0] + b * w[1] + c * w[2] - p;
      FacePoint point = {0, {t[0], t[1], t[2]}, {}};
      for (size_t k = 0; k < 3; ++k) point.weights[k] = static_cast<float>(w[k]);
      const double facing = dot(normalized(mixed(to_.normals, point), normal), normal);
      double cost = dot(d, d) + (facing < kSameSide ? reach * reach : 0);
      if (cost >= best) continue;
      if (!compared_.empty()) cost += difference(motion, mixed(to_, point));
      if (cost >= best) continue;
      best = cost;
      found = point;
    }
    return found;
  }

 private:
  const FaceSurface& to_;
  double length_;
  std::vector<size_t> compared_;
  std::vector<uint32_t> near_;
};

/// The landmarks, and samples of the face around them.
Bendable sample_face(const FaceSurface& face, const std::vector<FacePoint>& points) {
  Bendable out;
  const auto add = [&](const FacePoint& point) {
    out.at.push_back(mixed(face.positions, point));
    out.normals.push_back(normalized(mixed(face.normals, point), Vec3d{0, 0, 1}));
    out.motions.push_back(mixed(face, point));
  };
  for (const FacePoint& point : points) add(point);
  std::vector<uint32_t> inside;
  for (size_t i = 0; i < face.positions.size(); ++i) {
    if (is_in_face(face, i)) inside.push_back(static_cast<uint32_t>(i));
  }
  const size_t count = std::min(inside.size(), kMostSamples);
  // The golden ratio spreads them without following rows of the mesh.
  for (size_t i = 0; i < count; ++i) {
    const double share = std::fmod(static_cast<double>(i) * 0.6180339887498949, 1.0);
    add(face_point(inside[static_cast<size_t>(share * static_cast<double>(inside.size()))]));
  }
  return out;
}

}  // namespace

FacePoint face_point(uint32_t position) { return {0, {position, position, position}, {1, 0, 0}}; }

FaceSurface read_face(const SolvedRig& rig, uint32_t mesh) {
  FaceSurface face;
  const MienMesh own = mesh_of(rig, mesh);
  const RigSpace space(rig);
  MovingMesh moving(rig, mesh);
  const std::vector<float> rest = moving.rest();
  for (size_t i = 0; i < rest.size(); i += 3)
    face.positions.push_back(space.to_centimeters(&rest[i]));
  for (size_t i = 0; i < own.triangles.count; i += 3) {
    std::array<uint32_t, 3> corners;
    for (size_t k = 0; k < 3; ++k) {
      corners[k] = own.vertex_position_indices.data[own.triangles.data[i + k]];
    }
    face.triangles.push_back(corners);
  }
  find_normals(face);
  face.motions.resize(face.positions.size());
  for (size_t m = 0; m < kFaceMotions; ++m) {
    const std::string name = kComparedControls[m];
    MienControlShare shares[MIEN_MOST_SHARES];
    size_t count = 0;
    uint32_t how = 0;
    if (mien_rig_match(rig.rig, name.data(), name.size(), shares, MIEN_MOST_SHARES, &count, &how) !=
        MIEN_OK) {
      continue;
    }
    Frame frame;
    for (size_t i = 0; i < count; ++i) frame.raw.push_back({shares[i].control, shares[i].weight});
    const float* const moved = moving.positions(frame);
    float most = 0;
    for (size_t i = 0; i < face.positions.size(); ++i) {
      const math::Vec3 d = math::load3(moved, i) - math::load3(rest.data(), i);
      face.motions[i][m] = length(d);
      most = std::max(most, length(d));
    }
    if (most <= 0) continue;
    face.has_motion[m] = true;
    for (std::array<float, kFaceMotions>& motion : face.motions) motion[m] /= most;
  }
  if (!face.has_motion[kLeftLid] || !face.has_motion[kRightLid]) {
    fail_face(rig, "no controls close the eyes of the mesh");
  }
  if (!face.has_motion[kJaw]) fail_face(rig, "no control opens the jaw of the mesh");
  face.left_lid = find_edge(face, kLeftLid);
  face.right_lid = find_edge(face, kRightLid);
  if (face.left_lid.x - face.right_lid.x < 0.5) {
    fail_face(rig, "the left eye is not to the left of the right one");
  }
  if (!find_mouth(face)) fail_face(rig, "there is no place between lips that the jaw opens");
  find_nose_and_chin(face);
  if (!is_finite(face.nose) || !is_finite(face.chin)) fail_face(rig, "it has no nose or no chin");
  return face;
}

FaceSurface make_face(const std::vector<Vec3d>& positions,
                      const std::vector<std::array<uint32_t, 3>>& triangles, Vec3d left_lid,
                      Vec3d right_lid, Vec3d mouth) {
  FaceSurface face;
  face.positions = positions;
  face.triangles = triangles;
  face.left_lid = left_lid;
  face.right_lid = right_lid;
  face.mouth = mouth;
  find_normals(face);
  find_nose_and_chin(face);
  return face;
}

std::vector<FacePoint> transfer_points(const FaceSurface& from,
                                       const std::vector<FacePoint>& points,
                                       const FaceSurface& to) {
  const FirstGuess guess(from, to);
  const FaceMatcher matcher(from, to);
  Bendable face = sample_face(from, points);
  for (Vec3d& at : face.at) at = guess(at);
  const size_t count = face.at.size();
  std::vector<Vec3d> moves(count);
  std::vector<bool> matched(count);
  const std::vector<Vec3d> first = face.at;  // which places are neighbors does not change
  for (int b = 0; b < kBendings; ++b) {
    const double share = static_cast<double>(b) / (kBendings - 1);
    const double radius =
        to.eye_distance() * kFirstRadius * std::pow(kLastRadius / kFirstRadius, share);
    for (size_t i = 0; i < count; ++i) {
      Vec3d found;
      matched[i] = matcher.find(face.at[i], face.normals[i], face.motions[i], found);
      moves[i] = matched[i] ? found - face.at[i] : Vec3d{};
    }
    for (size_t i = 0; i < count; ++i) {
      Vec3d sum;
      double weights = 1e-9;
      for (size_t j = 0; j < count; ++j) {
        const Vec3d d = first[i] - first[j];
        const double far = dot(d, d) / (radius * radius);
        if (!matched[j] || far > 6) continue;
        const double weight = std::exp(-far);
        sum += moves[j] * weight;
        weights += weight;
      }
      face.at[i] += sum * (1 / weights);
    }
  }
  std::vector<FacePoint> out;
  for (size_t i = 0; i < points.size(); ++i) {
    out.push_back(matcher.place(face.at[i], face.normals[i], face.motions[i]));
  }
  return out;
}

}  // namespace mien::cli
