// SPDX-License-Identifier: MIT
#include "integrations/program/commands/contact_strip.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "integrations/program/commands/options.h"
#include "integrations/program/scene/camera_target.h"

namespace mien::cli {

namespace {

constexpr size_t kUsualImages = 16, kUsualColumns = 8;
constexpr size_t kMaxImages = 10000;

double parse_every(const std::string& word) {
  double seconds = 0;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, seconds);
  if (error == std::errc() && stop == end && seconds >= 0.001 && seconds <= 86400) return seconds;
  fail_usage("--every \"" + word + "\"", "not a number of seconds from 0.001 to 86400",
             "write it as 0.25");
}

/// A round number of seconds that makes 16 images or fewer.
double usual_step(double seconds) {
  for (double power = 0.01;; power *= 10) {
    for (const double digit : {1.0, 2.0, 2.5, 5.0}) {
      if (seconds / (digit * power) < static_cast<double>(kUsualImages)) return digit * power;
    }
  }
}

/// "1.25 s": as many digits as the step has.
std::string time_text(double time, double step) {
  int digits = 0;
  for (double unit = step; digits < 3 && std::abs(unit - std::round(unit)) > 1e-9; unit *= 10) {
    ++digits;
  }
  char text[64];
  std::snprintf(text, sizeof(text), "%.*f s", digits, time);
  return text;
}

std::vector<size_t> chosen_frames(const Recording& recording, double every) {
  std::vector<size_t> frames;
  for (size_t k = 0;; ++k) {
    const double frame = std::round(static_cast<double>(k) * every * recording.rate);
    if (frame >= static_cast<double>(recording.times.size())) return frames;
    const auto number = static_cast<size_t>(frame);
    // Steps below a frame do not show it twice.
    if (frames.empty() || frames.back() != number) frames.push_back(number);
  }
}

/// What began since the image before.
std::string caption(const Captions& captions, double after, double until) {
  std::vector<std::string> names;
  for (const auto& [time, name] : captions) {
    if (time <= after || time > until) continue;
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "  " : ", ") + name;
  return text;
}

}  // namespace

StripPlan plan_strip(const StripOptions& options, const std::string& path) {
  StripPlan plan;
  plan.scene = parse_scene_options(options.scene);
  plan.view = parse_camera(options.output.camera);
  const int side = is_numbered(path) ? 640 : 256;
  plan.size = parse_size(options.output.size, {side, side});
  plan.render = parse_render_options(options.output, plan.size);
  if (!options.every.empty()) plan.every = parse_every(options.every);
  if (!options.columns.empty()) {
    plan.columns = parse_number("--columns", options.columns, 1000);
    if (plan.columns == 0) fail_usage("--columns 0", "a sheet has at least one", "try 8");
    if (is_numbered(path)) {
      fail_usage("--columns", "only images side by side have columns",
                 "leave % out of the file name");
    }
  }
  return plan;
}

uint64_t write_strip(const StripPlan& plan, const std::string& target, const Recording& recording,
                     const Captions& captions, const OutputFile& output, const Session& session) {
  const std::string& path = output.path;
  const double every = plan.every > 0 ? plan.every : usual_step(recording.times.back());
  const std::vector<size_t> frames = chosen_frames(recording, every);
  if (frames.size() > kMaxImages) {
    fail_usage("--every", "there would be " + std::to_string(frames.size()) + " images",
               "give more seconds between them");
  }
  PosedScene scene = open_scene(plan.scene, session);
  render::RenderOptions render = plan.render;
  render.scale = length(scene.neutral_box().size());
  const bool finds_face = target.empty() && has_face(scene);
  const render::Camera camera =
      aim_camera(scene, finds_face ? "face" : target, plan.view, plan.size);
  const uint32_t controls = rig_count(scene.rig.get(), MIEN_KIND_RAW_CONTROL);
  const auto draw = [&](size_t number) {
    pose_scene(scene, recording.shown_frame(number, controls));
    return render_image(scene.surfaces(), camera, render);
  };

  Progress progress(session, "image", frames.size());
  if (is_numbered(path)) {
    uint64_t bytes = 0;
    for (size_t i = 0; i < frames.size(); ++i) {
      progress.at(i);
      const std::string file = numbered(path, i);
      refuse_replacing({file, output.force}, {plan.scene.rig});
      bytes += write_png(file, draw(frames[i]));
    }
    return bytes;
  }
  const size_t columns = std::min(plan.columns != 0 ? plan.columns : kUsualColumns, frames.size());
  render::Sheet sheet = make_sheet({frames.size(), columns, plan.size, true}, render.backdrop);
  double before = -1;
  for (size_t i = 0; i < frames.size(); ++i) {
    progress.at(i);
    const double time = recording.times[frames[i]];
    sheet.add(draw(frames[i]), time_text(time, every) + caption(captions, before, time));
    before = time;
  }
  return write_png(path, sheet.image());
}

}  // namespace mien::cli
