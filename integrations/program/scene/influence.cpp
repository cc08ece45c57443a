// SPDX-License-Identifier: MIT
#include "integrations/program/scene/influence.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace mien::cli {

namespace {

using math::Vec3;

constexpr size_t kValues = 9;

// A position moves if it moves further than both: a share of the largest movement, and a share of
// the size of the rig.
constexpr float kMinShareOfMax = 1e-2f, kMinShareOfSize = 1e-6f;

std::vector<float> copy(MienStatus (*view)(const MienInstance*, MienFloatView*),
                        const PosedScene& scene) {
  MienFloatView values{};
  check(view(scene.instance.get(), &values), nullptr, "cannot read outputs", "");
  return {values.data, values.data + values.count};
}

/// All results of the rig in one pose.
struct State {
  std::vector<float> controls, joints, channels, maps;
  std::vector<std::vector<float>> positions;  // of each shown mesh
};

State state_of(PosedScene& scene, const Frame& frame) {
  pose_scene(scene, frame);
  State state;
  state.controls = copy(mien_instance_controls, scene);
  state.joints = copy(mien_instance_joints, scene);
  state.channels = copy(mien_instance_blend_shapes, scene);
  state.maps = copy(mien_instance_animated_maps, scene);
  for (const SceneMesh& mesh : scene.meshes) {
    const float* values = scene.positions(mesh);
    state.positions.emplace_back(values, values + size_t{mesh.neutral.position_count} * 3);
  }
  return state;
}

/// Numbers of the control vector by kind.
struct Row {
  uint32_t raw, psd, ml, rbf;  // counts

  explicit Row(const MienRig* rig)
      : raw(rig_count(rig, MIEN_KIND_RAW_CONTROL)), psd(rig_count(rig, MIEN_KIND_PSD_CONTROL)),
        ml(rig_count(rig, MIEN_KIND_ML_CONTROL)), rbf(rig_count(rig, MIEN_KIND_RBF_CONTROL)) {}

  std::string name(const MienRig* rig, uint32_t control) const {
    uint32_t first = 0;
    for (const auto& [kind, count] : {std::pair<uint32_t, uint32_t>{MIEN_KIND_RAW_CONTROL, raw},
                                      {MIEN_KIND_PSD_CONTROL, psd},
                                      {MIEN_KIND_ML_CONTROL, ml},
                                      {MIEN_KIND_RBF_CONTROL, rbf}}) {
      if (control < first + count) return rig_name(rig, kind, control - first);
      first += count;
    }
    return "control " + std::to_string(control);
  }
};

std::vector<ValueChange> changes(const MienRig* rig, uint32_t kind, const float* before,
                                 const float* after, size_t count) {
  std::vector<ValueChange> found;
  for (size_t i = 0; i < count; ++i) {
    if (after[i] == before[i]) continue;
    const auto index = static_cast<uint32_t>(i);
    found.push_back({index, rig_name(rig, kind, index), after[i]});
  }
  std::stable_sort(found.begin(), found.end(), [](const ValueChange& a, const ValueChange& b) {
    return std::fabs(a.value) > std::fabs(b.value);
  });
  return found;
}

std::vector<JointMotion> find_joints(const MienRig* rig, const State& rest, const State& on) {
  std::vector<JointMotion> joints;
  for (size_t j = 0; j * kValues < on.joints.size(); ++j) {
    JointMotion motion{};
    motion.joint = static_cast<uint32_t>(j);
    bool moves = false;
    for (size_t k = 0; k < kValues; ++k) {
      motion.change[k] = on.joints[j * kValues + k] - rest.joints[j * kValues + k];
      moves |= motion.change[k] != 0;
    }
    if (!moves) continue;
    const float* c = motion.change;
    const auto largest = [](const float* v) {
      return std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])});
    };
    motion.name = rig_name(rig, MIEN_KIND_JOINT, motion.joint);
    motion.translation = length(Vec3{c[0], c[1], c[2]});
    motion.rotation = largest(c + 3);
    motion.scale = largest(c + 6);
    joints.push_back(motion);
  }

  // The joints that move most come first: translation, rotation and scale each relative to the
  // largest of all joints.
  JointMotion max{};
  for (const JointMotion& motion : joints) {
    max.translation = std::max(max.translation, motion.translation);
    max.rotation = std::max(max.rotation, motion.rotation);
    max.scale = std::max(max.scale, motion.scale);
  }
  const auto share = [](float x, float of) { return of > 0 ? x / of : 0; };
  const auto rank = [&](const JointMotion& m) {
    return share(m.translation, max.translation) + share(m.rotation, max.rotation) +
           share(m.scale, max.scale);
  };
  std::stable_sort(joints.begin(), joints.end(),
                   [&](const JointMotion& a, const JointMotion& b) { return rank(a) > rank(b); });
  return joints;
}

MeshMotion find_motion(const SceneMesh& mesh, const std::vector<float>& rest,
                       const std::vector<float>& on, float min_distance) {
  MeshMotion motion;
  motion.mesh = &mesh;
  const size_t count = mesh.neutral.position_count;
  motion.distances.resize(count);
  for (size_t i = 0; i < count; ++i) {
    const float distance = length(math::load3(on.data(), i) - math::load3(rest.data(), i));
    motion.distances[i] = distance;
    if (distance <= motion.max_distance) continue;
    motion.max_distance = distance;
    motion.max_position = static_cast<uint32_t>(i);
  }
  const float threshold = std::max(min_distance, motion.max_distance * kMinShareOfMax);
  float weight = 0;
  for (size_t i = 0; i < count; ++i) {
    const float distance = motion.distances[i];
    if (distance <= threshold) continue;
    const Vec3 neutral = math::load3(mesh.neutral.positions.data, i);
    ++motion.moved;
    motion.box.add(neutral);
    motion.center += neutral * distance;
    motion.mean += math::load3(on.data(), i) - math::load3(rest.data(), i);
    weight += distance;
  }
  if (motion.moved == 0) {
    motion.max_distance = 0;
    return motion;
  }
  motion.center = motion.center * (1 / weight);
  motion.mean = motion.mean * (1 / static_cast<float>(motion.moved));
  return motion;
}

/// Measures correctives by evaluating: each input alone, and all inputs together.
class CorrectiveMeter {
 public:
  CorrectiveMeter(PosedScene& scene, const State& rest, const std::map<uint32_t, float>& driven)
      : scene_(scene), rest_(rest), driven_(driven) {}

  void measure(Corrective& corrective, const std::vector<uint32_t>& inputs, const Row& row) {
    Frame frame;
    std::vector<const State*> singles;
    for (const uint32_t input : inputs) {
      frame.raw.push_back({input, value_of(input)});
      singles.push_back(&single(input));
    }
    const State together = state_of(scene_, frame);
    corrective.value_together = together.controls[row.raw + corrective.psd];
    if (scene_.meshes.empty()) {
      corrective.beyond_sum = max_beyond_sum(
          together.joints, rest_.joints, singles,
          [](const State& s) -> const std::vector<float>& { return s.joints; }, kValues);
      return;
    }
    for (size_t m = 0; m < scene_.meshes.size(); ++m) {
      const float beyond = max_beyond_sum(
          together.positions[m], rest_.positions[m], singles,
          [m](const State& s) -> const std::vector<float>& { return s.positions[m]; }, 3);
      corrective.beyond_sum = std::max(corrective.beyond_sum, beyond);
    }
  }

 private:
  float value_of(uint32_t raw) const {
    const auto found = driven_.find(raw);
    return found == driven_.end() ? 1.0f : found->second;
  }

  const State& single(uint32_t raw) {
    const auto found = singles_.find(raw);
    if (found != singles_.end()) return found->second;
    Frame frame;
    frame.raw.push_back({raw, value_of(raw)});
    return singles_.emplace(raw, state_of(scene_, frame)).first->second;
  }

  /// The largest distance between `together` and the sum of what the inputs do alone, over vectors
  /// of three values that are `stride` apart.
  template <class Values>
  static float max_beyond_sum(const std::vector<float>& together, const std::vector<float>& rest,
                              const std::vector<const State*>& singles, Values values,
                              size_t stride) {
    float max = 0;
    for (size_t i = 0; i + stride <= together.size(); i += stride) {
      Vec3 sum;
      for (const State* state : singles) {
        const float* v = values(*state).data() + i;
        sum += Vec3{v[0] - rest[i], v[1] - rest[i + 1], v[2] - rest[i + 2]};
      }
      const Vec3 all = {together[i] - rest[i], together[i + 1] - rest[i + 1],
                        together[i + 2] - rest[i + 2]};
      max = std::max(max, length(all - sum));
    }
    return max;
  }

  PosedScene& scene_;
  const State& rest_;
  const std::map<uint32_t, float>& driven_;
  std::map<uint32_t, State> singles_;
};

std::vector<Corrective> find_correctives(PosedScene& scene, const State& rest, const State& on,
                                         const std::map<uint32_t, float>& driven,
                                         const Session& session) {
  const MienRig* rig = scene.rig.get();
  const Row row(rig);
  CorrectiveMeter meter(scene, rest, driven);
  std::vector<Corrective> correctives;
  Progress progress(session, "corrective", row.psd);
  for (uint32_t psd = 0; psd < row.psd; ++psd) {
    progress.at(psd);
    MienIndex16View view{};
    check(mien_rig_psd_inputs(rig, psd, &view), nullptr, "cannot examine rig", "");
    const std::vector<uint32_t> inputs(view.data, view.data + view.count);
    Corrective corrective{psd, {}, on.controls[row.raw + psd], true, 0, 0};
    bool is_driven = false;
    for (const uint32_t input : inputs) {
      corrective.reachable &= input < row.raw;
      if (driven.count(input)) {
        is_driven = true;
      } else {
        corrective.partners.push_back(row.name(rig, input));
      }
    }
    if (!is_driven) continue;
    if (corrective.reachable) meter.measure(corrective, inputs, row);
    correctives.push_back(std::move(corrective));
  }
  std::stable_sort(
      correctives.begin(), correctives.end(),
      [](const Corrective& a, const Corrective& b) { return a.beyond_sum > b.beyond_sum; });
  return correctives;
}

}  // namespace

float Influence::max_distance() const {
  float max = 0;
  for (const MeshMotion& motion : meshes) max = std::max(max, motion.max_distance);
  return max;
}

Influence find_influence(PosedScene& scene, const Control& control, float value,
                         const Session& session) {
  const MienRig* rig = scene.rig.get();
  const bool gui = control.kind == MIEN_KIND_GUI_CONTROL;
  Frame rest_frame, frame;
  rest_frame.maps_gui = frame.maps_gui = gui;
  (gui ? frame.gui : frame.raw).push_back({control.index, value});
  const State rest = state_of(scene, rest_frame);
  const State on = state_of(scene, frame);

  Influence influence;
  influence.control = control;
  influence.value = value;
  const Row row(rig);
  std::map<uint32_t, float> driven;
  for (uint32_t i = 0; i < row.raw; ++i) {
    if (on.controls[i] != rest.controls[i]) driven[i] = on.controls[i];
  }
  const float *before = rest.controls.data(), *after = on.controls.data();
  if (gui) influence.raw = changes(rig, MIEN_KIND_RAW_CONTROL, before, after, row.raw);
  const size_t first_ml = row.raw + row.psd, first_rbf = first_ml + row.ml;
  influence.ml = changes(rig, MIEN_KIND_ML_CONTROL, before + first_ml, after + first_ml, row.ml);
  influence.rbf =
      changes(rig, MIEN_KIND_RBF_CONTROL, before + first_rbf, after + first_rbf, row.rbf);
  influence.channels = changes(rig, MIEN_KIND_BLEND_SHAPE_CHANNEL, rest.channels.data(),
                               on.channels.data(), on.channels.size());
  influence.maps =
      changes(rig, MIEN_KIND_ANIMATED_MAP, rest.maps.data(), on.maps.data(), on.maps.size());
  influence.joints = find_joints(rig, rest, on);
  const float min_distance =
      scene.meshes.empty() ? 0 : length(scene.neutral_box().size()) * kMinShareOfSize;
  for (size_t m = 0; m < scene.meshes.size(); ++m) {
    influence.meshes.push_back(
        find_motion(scene.meshes[m], rest.positions[m], on.positions[m], min_distance));
  }
  // Correctives are measured by raw controls, also those of a GUI control.
  const State initial = gui ? state_of(scene, {}) : State{};
  influence.correctives = find_correctives(scene, gui ? initial : rest, on, driven, session);
  pose_scene(scene, frame);
  return influence;
}

}  // namespace mien::cli
