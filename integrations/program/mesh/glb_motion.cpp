// SPDX-License-Identifier: MIT
#include "integrations/program/mesh/glb_motion.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "integrations/program/mesh/glb_data.h"

namespace mien::cli {

namespace {

struct TrackPath {
  const char* name;
  uint32_t first, width;
};
constexpr TrackPath kTrackPaths[] = {{"translation", 0, 3}, {"rotation", 3, 4}, {"scale", 7, 3}};

class MotionReader : GlbData {
 public:
  MotionReader(const std::string& bytes, const std::string& path) : GlbData(bytes, path) {}

  GlbMotion read() {
    for (size_t n = 0; n < list(root(), "nodes").size(); ++n) add_node(element("nodes", n));
    if (!list(root(), "animations").empty()) {
      const Json& animation = element("animations", 0);
      const Json& channels = list(animation, "channels");
      for (const Json& channel : channels) add_channel(animation, channel);
    }
    for (const GlbTrack& track : out_.tracks) {
      if (track.times->size() > out_.times.size()) out_.times = *track.times;
    }
    if (out_.times.empty()) out_.times = {0};
    return std::move(out_);
  }

 private:
  void add_node(const Json& node) {
    NodeTransform rest = {0, 0, 0, 0, 0, 0, 1, 1, 1, 1};
    for (const TrackPath& path : kTrackPaths) {
      const Json& given = list(node, path.name);
      if (given.empty()) continue;
      for (size_t k = 0; k < path.width; ++k) {
        const bool number = given.size() == path.width && given[k].is_number();
        const double value = number ? given[k].get<double>() : NAN;
        if (!std::isfinite(value)) fail("", std::string(path.name) + " of a node is wrong");
        rest[path.first + k] = value;
      }
    }
    out_.names.push_back(text(node, "name"));
    out_.rest.push_back(rest);
  }

  void add_channel(const Json& animation, const Json& channel) {
    if (!channel.is_object() || !channel.contains("target") || !channel["target"].is_object()) {
      fail("animation 0", "a channel is wrong");
    }
    const Json& target = channel["target"];
    const TrackPath* path = nullptr;
    for (const TrackPath& known : kTrackPaths) {
      if (text(target, "path") == known.name) path = &known;
    }
    if (!path || !target.contains("node")) return;
    const Json& samplers = list(animation, "samplers");
    const size_t number = whole(channel, "sampler", kMaxElements);
    if (number >= samplers.size() || !samplers[number].is_object()) {
      fail("animation 0", "there is no sampler " + std::to_string(number));
    }
    const Json& sampler = samplers[number];
    const std::string interpolation = text(sampler, "interpolation");
    if (interpolation == "CUBICSPLINE") {
      fail("animation 0", "it has cubic splines", "bake the animation: a key for each frame");
    }
    GlbTrack track;
    const size_t node = whole(target, "node", kMaxElements);
    if (node >= out_.rest.size()) {
      fail("animation 0", "there is no node " + std::to_string(node));
    }
    track.node = static_cast<uint32_t>(node);
    track.first = path->first;
    track.width = path->width;
    track.is_step = interpolation == "STEP";
    track.times = times_of(whole(sampler, "input", kMaxElements));
    track.values = numbers(whole(sampler, "output", kMaxElements), track.width, "an animation");
    if (track.values.size() != track.times->size() * track.width) {
      fail("animation 0", "a track has another number of values than of times");
    }
    out_.tracks.push_back(std::move(track));
  }

  /// Most tracks have the same.
  std::shared_ptr<const std::vector<double>> times_of(size_t accessor) {
    auto& known = times_[accessor];
    if (known) return known;
    std::vector<double> times = numbers(accessor, 1, "a time");
    if (times.empty()) fail("accessor " + std::to_string(accessor), "it has no times");
    for (size_t i = 1; i < times.size(); ++i) {
      if (times[i] > times[i - 1]) continue;
      fail("accessor " + std::to_string(accessor), "times do not ascend");
    }
    return known = std::make_shared<const std::vector<double>>(std::move(times));
  }

  GlbMotion out_;
  std::map<size_t, std::shared_ptr<const std::vector<double>>> times_;
};

}  // namespace

GlbMotion read_glb_motion(const std::string& bytes, const std::string& path) {
  return MotionReader(bytes, path).read();
}

std::vector<NodeTransform> sample_motion(const GlbMotion& motion, double time) {
  std::vector<NodeTransform> out = motion.rest;
  for (const GlbTrack& track : motion.tracks) {
    const std::vector<double>& times = *track.times;
    const auto after = std::upper_bound(times.begin(), times.end(), time);
    const auto next = static_cast<size_t>(after - times.begin());
    const size_t b = std::min(next, times.size() - 1), a = next == 0 ? 0 : next - 1;
    double share = b > a ? (time - times[a]) / (times[b] - times[a]) : 0;
    if (track.is_step) share = 0;
    const double* from = track.values.data() + a * track.width;
    const double* to = track.values.data() + b * track.width;
    // Of q and -q, the nearer one.
    double cosine = 1;
    if (track.width == 4) {
      cosine = 0;
      for (size_t k = 0; k < 4; ++k) cosine += from[k] * to[k];
    }
    for (size_t k = 0; k < track.width; ++k) {
      const double end = cosine < 0 ? -to[k] : to[k];
      out[track.node][track.first + k] = from[k] + (end - from[k]) * share;
    }
  }
  return out;
}

}  // namespace mien::cli
