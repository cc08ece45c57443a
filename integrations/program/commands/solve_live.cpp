// SPDX-License-Identifier: MIT
#include "integrations/program/commands/solve_live.h"

#include <algorithm>
#include <cmath>

#include "integrations/program/commands/solve_neutral.h"

namespace mien::cli {

namespace {

using Outcome = live::LandmarkSolver::Outcome;

constexpr float kUsualSeconds = 0.008f;  // half a frame at 60 per second
// From the packet before, more than four steps change less than the noise of landmarks; the next packet goes on.
constexpr uint32_t kFirstLiveIterations = 200, kMostLiveIterations = 4;
// Packets from which the focal length is found: a second of most cameras.
constexpr size_t kFocalPackets = 60;

float parse_solve_time(const std::string& word) {
  if (word.empty()) return kUsualSeconds;
  const float seconds = parse_weight("--solve-time", word);
  if (seconds > 0 && seconds <= 1) return seconds;
  fail_usage("--solve-time " + word, "not a number of seconds above 0, up to 1",
             "write it as 0.008");
}

float parse_focal(const std::string& word) {
  if (word.empty()) return 0;
  const float focal = parse_weight("--focal", word);
  if (focal > 0) return focal;
  fail_usage("--focal " + word, "not a focal length above 0",
             "give it in pixels: for an angle of view A it is width / (2 tan(A / 2))");
}

/// The focal length of a camera whose pictures have one size, found from its first packets, then kept.
struct KeptFocal {
  bool finds = false;  // else it is given
  float size[2] = {};
  std::vector<float> found;
  float kept = 0;  // 0: not yet

  /// Begins again where pictures have another size.
  void see(const float* picture) {
    if (!finds || (picture[0] == size[0] && picture[1] == size[1])) return;
    std::copy_n(picture, 2, size);
    found.clear();
    kept = 0;
  }
  bool finding() const { return finds && kept == 0; }
  void add(float focal) {
    found.push_back(focal);
    if (found.size() < kFocalPackets) return;
    std::nth_element(found.begin(), found.begin() + kFocalPackets / 2, found.end());
    kept = found[kFocalPackets / 2];
  }
};

/// The fit, and what the frame before has left.
struct LiveFit {
  Fit fit;
  std::optional<MienFitCamera> given;
  MienFitCamera camera = {};
  KeptFocal focal;
  size_t width = 3, point_count = 0;
  MienFitFrame frame = sized<MienFitFrame>();
  float smooth = 0, given_focal = 0;
  bool has_start = false;
  std::vector<float> start, row;
  std::string shown;
  const Session* session = nullptr;

  // The face of another person at rest: from the first packets, or from rows of a file.
  std::optional<NeutralFinder> finder;  // until it is known
  size_t wanted = 0;                    // packets; 0: a file
  std::vector<std::vector<float>> neutral_rows;
  std::string neutral_shown;
  std::optional<NeutralFace> neutral;

  /// The camera of the file, or one with the focal length that is known, or with an angle of view of 53 degrees along
  /// the longer side of the picture.
  void begin_camera(const live::LandmarkPacket& packet) {
    if (given) {
      camera = *given;
      return;
    }
    camera = MienFitCamera{};
    const float known = given_focal > 0 ? given_focal : focal.kept;
    for (size_t k = 0; k < 2; ++k) {
      camera.focal[k] = known > 0 ? known : std::max(packet.size[0], packet.size[1]);
      camera.center[k] = packet.size[k] / 2;
    }
  }
  void keep_camera(const MienFitResult& result) {
    std::copy_n(result.rotation, 9, camera.rotation);
    std::copy_n(result.translation, 3, camera.translation);
    std::copy_n(result.focal, 2, camera.focal);
    if (!focal.finding()) return;
    focal.add(result.focal[0]);
    if (focal.kept > 0) tell_focal();
  }
  void tell_focal() {
    std::fill_n(camera.focal, 2, focal.kept);
    char text[64];
    std::snprintf(text, sizeof text, "the focal length is %.0f pixels", double{focal.kept});
    note(*session, text);
  }

  Outcome lose_face() {
    has_start = false;
    return Outcome::kNoFace;
  }

  void know_neutral(NeutralFace face) {
    note(*session, "the neutral face is known: " + face.text());
    if (focal.finding() && finder->count() >= kFocalPackets) {
      focal.kept = face.focal;
      tell_focal();
    }
    neutral = std::move(face);
    frame.point_offsets = neutral->offsets.data();
    finder.reset();
    has_start = false;
  }
  Outcome measure_neutral(const live::LandmarkPacket& packet) {
    if (!finder->add(packet.values.data(), &camera, focal.finding())) return lose_face();
    has_start = true;  // of the camera
    if (finder->count() == wanted) know_neutral(finder->find());
    return Outcome::kNeutral;
  }

  Outcome solve(const live::LandmarkPacket& packet, double seconds, bool anew, float* raw) {
    if (packet.present == 0 || packet.present * kLeastLandmarkShare < point_count)
      return lose_face();
    if (anew) has_start = false;
    if (width == 2) focal.see(packet.size);
    if (!has_start) begin_camera(packet);
    if (finder && wanted == 0) {
      know_neutral(
          measure_neutral_rows(*finder, neutral_rows, camera, focal.finding(), neutral_shown));
    }
    if (finder) return measure_neutral(packet);
    row = packet.values;
    if (neutral) neutral->adapt(row.data(), width);
    frame.points = width == 3 ? row.data() : nullptr;
    frame.images = width == 2 ? row.data() : nullptr;
    frame.camera = width == 2 ? &camera : nullptr;
    frame.focal = focal.finding() ? 1 : 0;
    frame.start = has_start ? start.data() : nullptr;
    frame.smooth_weight = has_start ? smooth : 0;
    frame.max_iterations = has_start ? kMostLiveIterations : kFirstLiveIterations;
    frame.max_seconds = seconds;
    auto result = sized<MienFitResult>();
    check(mien_fit_solve(fit.get(), &frame, raw, &result), nullptr, "cannot solve", shown);
    const bool fits = result.point_residual <=
                      kMostLandmarkResidual * landmark_spread(row.data(), point_count, width);
    if (result.status == MIEN_FIT_NO_DATA || !fits) return lose_face();
    has_start = true;
    std::copy_n(raw, start.size(), start.begin());
    if (width == 2) keep_camera(result);
    return result.status == MIEN_FIT_TIME ? Outcome::kCutShort : Outcome::kSolved;
  }
};

}  // namespace

void check_landmark_options(const LandmarkOptions& options, bool images) {
  if (options.file.empty()) {
    fail_usage("--live landmarks", "nothing says where landmarks are on the rig",
               "add --landmarks FILE, as 'mien solve RIG --place-landmarks 68 -o FILE' makes it");
  }
  parse_weight("--smooth", options.smooth);
  parse_weight("--sparse", options.sparse);
  parse_weight("--robust", options.robust);
  parse_solve_time(options.seconds);
  parse_neutral(options.neutral);
  if (parse_focal(options.focal) > 0 && !images) {
    fail_usage("--focal", "landmarks in space have no camera", "leave it out");
  }
}

live::LandmarkSolver open_landmark_solver(const LandmarkOptions& options, bool images,
                                          const MienRig* rig, const MienDeformer* deformer,
                                          const std::string& shown, const Session& session) {
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
  live->session = &session;
  live->start.resize(rig_count(rig, MIEN_KIND_RAW_CONTROL));
  // Weights are relative to the mean over the landmarks, as those of `mien solve`.
  const auto amount = static_cast<float>(points.size());
  live->frame.sparse_weight = parse_weight("--sparse", options.sparse) * amount;
  live->smooth = parse_weight("--smooth", options.smooth) * amount;
  live->frame.robust_scale = parse_weight("--robust", options.robust);
  live->frame.rigid = 1;
  live->given_focal = parse_focal(options.focal);
  if (live->given_focal > 0 && places.camera) {
    fail_usage("--focal " + options.focal, "the file of --landmarks has a camera",
               "leave one of them out");
  }
  live->focal.finds = solver.names.needs_size && live->given_focal == 0;

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
  const NeutralOption neutral = parse_neutral(options.neutral);
  if (neutral.given()) {
    live->finder.emplace(fit, solved, points, images);
    live->wanted = neutral.frame_count;
    if (!neutral.file.empty()) {
      live->neutral_rows = read_neutral_rows(neutral.file, images, solver.names.names);
      live->neutral_shown = shown_name(neutral.file);
    } else {
      note(session, "waiting for a neutral face in " + std::to_string(live->wanted) + " packets");
    }
  }
  solver.solve = [live](const live::LandmarkPacket& packet, double seconds, bool anew, float* raw) {
    return live->solve(packet, seconds, anew, raw);
  };
  return solver;
}

}  // namespace mien::cli
