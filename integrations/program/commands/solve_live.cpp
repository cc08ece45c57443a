// SPDX-License-Identifier: MIT
#include "integrations/program/commands/solve_live.h"

#include <algorithm>
#include <cmath>

#include "integrations/program/commands/solve_landmarks.h"

namespace mien::cli {

namespace {

using Outcome = live::LandmarkSolver::Outcome;

constexpr float kUsualSeconds = 0.008f;  // half a frame at 60 per second
constexpr uint32_t kFirstLiveIterations = 200, kMostLiveIterations = 50;
// Of the landmarks. With fewer, neither the place of the head nor its expression is sure.
constexpr size_t kLeastShare = 4;
// Of the spread of the landmarks. Where the residual is larger, they are not those of this face, or the camera was
// lost.
constexpr double kMostResidual = 0.25;

float parse_solve_time(const std::string& word) {
  if (word.empty()) return kUsualSeconds;
  const float seconds = parse_weight("--solve-time", word);
  if (seconds > 0 && seconds <= 1) return seconds;
  fail_usage("--solve-time " + word, "not a number of seconds above 0, up to 1",
             "write it as 0.008");
}

/// Root mean square distance of the landmarks that are there from their middle.
double find_spread(const live::LandmarkPacket& packet, size_t width) {
  double sums[3] = {}, squares = 0;
  for (size_t i = 0; i < packet.values.size(); ++i) {
    const double v = static_cast<double>(packet.values[i]);
    if (!std::isfinite(v)) continue;
    sums[i % width] += v;
    squares += v * v;
  }
  const auto count = static_cast<double>(packet.present);
  for (const double sum : sums) squares -= sum * sum / count;
  return std::sqrt(std::max(squares / count, 0.0));
}

/// The fit, and what the frame before has left.
struct LiveFit {
  Fit fit;
  std::optional<MienFitCamera> given;
  MienFitCamera camera = {};
  size_t width = 3, point_count = 0;
  MienFitFrame frame = sized<MienFitFrame>();
  float smooth = 0;
  bool has_start = false;
  std::vector<float> start;
  std::string shown;

  /// The camera of the file, or one with an angle of view of 53 degrees along the longer side of the picture.
  void begin_camera(const live::LandmarkPacket& packet) {
    if (given) {
      camera = *given;
      return;
    }
    camera = MienFitCamera{};
    for (size_t k = 0; k < 2; ++k) {
      camera.focal[k] = std::max(packet.size[0], packet.size[1]);
      camera.center[k] = packet.size[k] / 2;
    }
  }

  Outcome lose_face() {
    has_start = false;
    return Outcome::kNoFace;
  }

  Outcome solve(const live::LandmarkPacket& packet, double seconds, bool anew, float* raw) {
    if (packet.present == 0 || packet.present * kLeastShare < point_count) return lose_face();
    if (anew) has_start = false;
    if (!has_start) begin_camera(packet);
    frame.points = width == 3 ? packet.values.data() : nullptr;
    frame.images = width == 2 ? packet.values.data() : nullptr;
    frame.camera = width == 2 ? &camera : nullptr;
    frame.start = has_start ? start.data() : nullptr;
    frame.smooth_weight = has_start ? smooth : 0;
    frame.max_iterations = has_start ? kMostLiveIterations : kFirstLiveIterations;
    frame.max_seconds = seconds;
    auto result = sized<MienFitResult>();
    check(mien_fit_solve(fit.get(), &frame, raw, &result), nullptr, "cannot solve", shown);
    const bool fits = result.point_residual <= kMostResidual * find_spread(packet, width);
    if (result.status == MIEN_FIT_NO_DATA || !fits) return lose_face();
    has_start = true;
    std::copy_n(raw, start.size(), start.begin());
    if (width == 2) {
      std::copy_n(result.rotation, 9, camera.rotation);
      std::copy_n(result.translation, 3, camera.translation);
      std::copy_n(result.focal, 2, camera.focal);
    }
    return result.status == MIEN_FIT_TIME ? Outcome::kCutShort : Outcome::kSolved;
  }
};

}  // namespace

void check_landmark_options(const LandmarkOptions& options) {
  if (options.file.empty()) {
    fail_usage("--live landmarks", "nothing says where landmarks are on the rig",
               "add --landmarks FILE, as 'mien solve RIG --place-landmarks 68 -o FILE' makes it");
  }
  parse_weight("--smooth", options.smooth);
  parse_weight("--sparse", options.sparse);
  parse_weight("--robust", options.robust);
  parse_solve_time(options.seconds);
}

live::LandmarkSolver open_landmark_solver(const LandmarkOptions& options, bool images,
                                          const MienRig* rig, const MienDeformer* deformer,
                                          const std::string& shown) {
  if (!deformer) {
    fail(kInvalid, "cannot solve landmarks", shown, "the rig has no geometry",
         "give a file with meshes");
  }
  SolvedRig solved;
  solved.shown = shown;
  solved.rig = rig;
  solved.deformer = deformer;
  TargetOptions target;
  target.landmarks = options.file;
  const PlacedLandmarks places = read_places(target, solved);
  if (places.points.empty()) {
    fail(kInvalid, "cannot use landmarks", places.shown, "it has no points",
         "make one with 'mien solve RIG --place-landmarks 68 -o FILE'");
  }
  live::LandmarkSolver solver;
  std::vector<MienSolvePoint> points;
  for (const auto& [name, point] : places.points) {
    solver.names.names.push_back(name);
    points.push_back(point);
  }
  solver.names.width = images ? 2 : 3;
  solver.names.needs_size = images && !places.camera;
  solver.seconds = static_cast<double>(parse_solve_time(options.seconds));

  auto live = std::make_shared<LiveFit>();
  auto desc = sized<MienFitDesc>();
  desc.deformer = deformer;
  desc.points = points.data();
  desc.point_count = points.size();
  auto error = sized<MienError>();
  MienFit* fit = nullptr;
  check(mien_fit_create(rig, &desc, &fit, &error), &error, "cannot solve landmarks", shown);
  live->fit.reset(fit);
  live->given = places.camera;
  live->width = solver.names.width;
  live->point_count = points.size();
  live->shown = shown;
  live->start.resize(rig_count(rig, MIEN_KIND_RAW_CONTROL));
  // Weights are relative to the mean over the landmarks, as those of `mien solve`.
  const auto amount = static_cast<float>(points.size());
  live->frame.sparse_weight = parse_weight("--sparse", options.sparse) * amount;
  live->smooth = parse_weight("--smooth", options.smooth) * amount;
  live->frame.robust_scale = parse_weight("--robust", options.robust);
  live->frame.rigid = 1;
  live->frame.focal = solver.names.needs_size ? 1 : 0;

  std::vector<float> observed(live->start.size());
  check(mien_fit_observability(fit, observed.data(), observed.size()), nullptr,
        "cannot solve landmarks", shown);
  for (size_t i = 0; i < observed.size(); ++i) {
    if (observed[i] >= kUnobservable) solver.curves.push_back(static_cast<uint16_t>(i));
  }
  if (solver.curves.empty()) {
    fail(kInvalid, "cannot solve landmarks", shown, "no control of the rig moves them",
         "place landmarks on a mesh that controls move");
  }
  solver.solve = [live](const live::LandmarkPacket& packet, double seconds, bool anew, float* raw) {
    return live->solve(packet, seconds, anew, raw);
  };
  return solver;
}

}  // namespace mien::cli
