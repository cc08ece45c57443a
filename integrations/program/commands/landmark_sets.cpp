// SPDX-License-Identifier: MIT
#include "integrations/program/commands/landmark_sets.h"

#include <mien_author.h>

#include <cmath>
#include <limits>

#include "integrations/program/commands/landmark_places.h"
#include "integrations/program/io/json_writer.h"
#include "integrations/program/io/text.h"
#include "integrations/program/mesh/mesh_file.h"

namespace mien::cli {

namespace {

using math::Vec3d;

constexpr const char* kWhatPlacing = "cannot place landmarks";

// The 68 points ----------------------------------------------------------------------------------

/// A ray that meets the skin of the generated head in a landmark, from outside. Centimeters.
struct LandmarkRay {
  double x, y;
  double angle = 0;  // degrees from the front to the left: the ray meets the axis of the head at y
  enum Lip { kNone, kUpper, kLower } lip = kNone;
};

// The points of the left half by anatomy, as 300-W defines them; the right half mirrors them. Lids and lips are on
// the edges of their openings.
struct HalfLandmark {
  int left, right;  // numbers; the same in the middle
  LandmarkRay ray;
};
constexpr LandmarkRay::Lip kUpper = LandmarkRay::kUpper, kLower = LandmarkRay::kLower;
constexpr HalfLandmark kHalfOf68[] = {
    // the outline, from the ear to the chin
    {16, 0, {0, 0.3, 78}},
    {15, 1, {0, -1.9, 80}},
    {14, 2, {0, -4.1, 76}},
    {13, 3, {0, -6.1, 68}},
    {12, 4, {0, -7.7, 57}},
    {11, 5, {0, -8.9, 42}},
    {10, 6, {0, -9.6, 27}},
    {9, 7, {0, -9.9, 13}},
    {8, 8, {0, -9.95, 0}},
    // the brow, from the nose outward
    {22, 21, {1.4, 2.7}},
    {23, 20, {2.3, 3.2}},
    {24, 19, {3.3, 3.35}},
    {25, 18, {4.3, 3.1}},
    {26, 17, {5.2, 2.5}},
    // the bridge of the nose and its base
    {27, 27, {0, 0.3}},
    {28, 28, {0, -0.9}},
    {29, 29, {0, -2.05}},
    {30, 30, {0, -3.18}},
    {33, 33, {0, -4.32}},
    {34, 32, {0.65, -4.25}},
    {35, 31, {1.35, -4.1}},
    // the eye, from the inner corner over the upper lid to the outer one, and back
    {42, 39, {1.88, 0.26}},
    {43, 38, {2.6, 0.68}},
    {44, 37, {3.75, 0.76}},
    {45, 36, {4.52, 0.43}},
    {46, 41, {3.83, -0.13}},
    {47, 40, {2.6, -0.22}},
    // the border of the red of the lips
    {54, 48, {2.45, -6.0}},
    {53, 49, {1.4, -5.68, 0, kUpper}},
    {52, 50, {0.5, -5.47, 0, kUpper}},
    {51, 51, {0, -5.57, 0, kUpper}},
    {55, 59, {1.4, -6.55, 0, kLower}},
    {56, 58, {0.6, -6.8, 0, kLower}},
    {57, 57, {0, -6.83, 0, kLower}},
    // the line between the lips
    {64, 60, {2.2, -6.0}},
    {63, 61, {0.9, -6.0, 0, kUpper}},
    {62, 62, {0, -6.05, 0, kUpper}},
    {65, 67, {0.9, -6.12, 0, kLower}},
    {66, 66, {0, -6.14, 0, kLower}}};

/// The position of the generated head that the ray meets first, of those that are nearest to it.
FacePoint find_on_head(const FaceSurface& head, const LandmarkRay& ray, double side) {
  constexpr double kAxisZ = 2, kBesides = 0.1;
  const double angle = ray.angle * 3.14159265358979 / 180;
  const Vec3d direction = {side * std::sin(angle), 0, std::cos(angle)};
  const Vec3d origin = {side * ray.x, ray.y, ray.angle != 0 ? kAxisZ : 0};
  const auto aside = [&](size_t i) {
    const Vec3d p = head.positions[i] - origin;
    const double along = dot(p, direction);
    const bool upper = head.motions[i][0] < 0.5f;
    if (along <= 0 || dot(head.normals[i], direction) <= 0) return 1e9;
    if (ray.lip != LandmarkRay::kNone && upper != (ray.lip == LandmarkRay::kUpper)) return 1e9;
    return length(p - direction * along);
  };
  double nearest = 1e9;
  for (size_t i = 0; i < head.positions.size(); ++i) nearest = std::min(nearest, aside(i));
  uint32_t found = 0;
  double farthest = -std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < head.positions.size(); ++i) {
    const double along = dot(head.positions[i] - origin, direction);
    if (along <= farthest || aside(i) > nearest + kBesides) continue;
    farthest = along;
    found = static_cast<uint32_t>(i);
  }
  return face_point(found);
}

std::vector<FacePoint> find_68(const FaceSurface& head) {
  std::vector<FacePoint> points(68);
  for (const HalfLandmark& half : kHalfOf68) {
    points[static_cast<size_t>(half.left)] = find_on_head(head, half.ray, 1);
    if (half.right != half.left) {
      points[static_cast<size_t>(half.right)] = find_on_head(head, half.ray, -1);
    }
  }
  return points;
}

// MediaPipe --------------------------------------------------------------------------------------

constexpr size_t kMediaPipePoints = 468;  // the others are on the irises

/// The canonical face of MediaPipe, whose positions are its landmarks.
FaceSurface read_canonical_face(const std::string& path) {
  const std::string shown = shown_name(path);
  const MeshFile file = read_mesh_file(path);
  if (file.position_count() != kMediaPipePoints) {
    fail(
        kInvalid, kWhatPlacing, shown,
        "it has " + grouped(file.position_count()) + " positions, not " + grouped(kMediaPipePoints),
        "give canonical_face_model.obj of MediaPipe");
  }
  std::vector<Vec3d> positions;
  for (size_t i = 0; i < file.position_count(); ++i) {
    positions.push_back(
        {file.positions[3 * i], file.positions[3 * i + 1], file.positions[3 * i + 2]});
  }
  std::vector<std::array<uint32_t, 3>> triangles;
  size_t first = 0;
  for (const uint32_t size : file.face_sizes) {
    for (uint32_t k = 2; k < size; ++k) {
      triangles.push_back(
          {file.corners[first], file.corners[first + k - 1], file.corners[first + k]});
    }
    first += size;
  }
  // Middles of the edges of the upper lids, and of both lips.
  constexpr size_t kLeftLid = 386, kRightLid = 159, kUpperLip = 13, kLowerLip = 14;
  return make_face(positions, triangles, positions[kLeftLid], positions[kRightLid],
                   (positions[kUpperLip] + positions[kLowerLip]) * 0.5);
}

// Both -------------------------------------------------------------------------------------------

/// The generated head, on which the places of all sets are known.
SolvedRig generate_head() {
  auto desc = sized<MienGenerateDesc>();
  desc.preset = MIEN_PRESET_HEAD;
  auto error = sized<MienError>();
  MienDna* made = nullptr;
  check(mien_dna_generate(&desc, &made, &error), &error, "cannot generate", "a head");
  const Dna dna(made);
  SolvedRig out;
  out.shown = "the generated head";
  MienRig* rig = nullptr;
  check(mien_rig_create(made, nullptr, &rig, &error), &error, kWhatPlacing, out.shown);
  out.own_rig.reset(rig);
  out.rig = rig;
  MienDeformer* deformer = nullptr;
  check(mien_deformer_create(made, rig, nullptr, &deformer, &error), &error, kWhatPlacing,
        out.shown);
  out.own_deformer.reset(deformer);
  out.deformer = deformer;
  return out;
}

void write_places(const std::vector<FacePoint>& points, const std::string& mesh, Output& output) {
  using Layout = JsonWriter::Layout;
  JsonWriter json(output);
  json.begin_object(Layout::kLines);
  json.member("mesh", mesh);
  json.key("points");
  json.begin_object(Layout::kLines);
  for (size_t i = 0; i < points.size(); ++i) {
    json.key(std::to_string(i));
    json.begin_object();
    json.key("positions");
    json.begin_array();
    for (const uint32_t position : points[i].positions) json.value(position);
    json.end_array();
    json.key("weights");
    json.floats(points[i].weights, 3);
    json.end_object();
  }
  json.end_object();
  json.end_object();
  json.finish();
}

}  // namespace

void place_landmarks(const SolveCommand& command, const Session& session) {
  const bool is_mediapipe = command.place == "mediapipe";
  if (is_mediapipe == command.target.path.empty()) {
    fail_usage(
        "--place-landmarks " + command.place,
        is_mediapipe ? "the face that has these landmarks is missing"
                     : "these places are known without a TARGET",
        is_mediapipe ? "give canonical_face_model.obj of MediaPipe as TARGET" : "leave TARGET out");
  }
  const SolvedRig head = generate_head();
  const FaceSurface known = read_face(head, find_mesh(head, ""));
  std::vector<FacePoint> points;
  if (is_mediapipe) {
    const FaceSurface canonical = read_canonical_face(command.target.path);
    for (uint32_t i = 0; i < kMediaPipePoints; ++i) points.push_back(face_point(i));
    points = transfer_points(canonical, points, known);
  } else {
    points = find_68(known);
  }
  const SolvedRig rig = open_solved_rig(command.rig, true, session);
  const uint32_t mesh = find_mesh(rig, command.target.mesh);
  points = transfer_points(known, points, read_face(rig, mesh));
  Output output(command.output.path);
  write_places(points, rig_name(rig.rig, MIEN_KIND_MESH, mesh), output);
  output.commit();
  note_written(session, command.output.path, output.size());
}

}  // namespace mien::cli
