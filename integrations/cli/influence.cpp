// SPDX-License-Identifier: MIT
#include "integrations/cli/influence.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace mien::cli {

namespace {

using picture::Vec3;

constexpr size_t kValues = 9;

// Shares of the largest movement, and of the size of the rig, that count as none.
constexpr float kStill = 1e-2f, kStillOfSize = 1e-6f;

std::vector<float> copy(MienStatus (*view)(const MienInstance*, MienFloatView*),
                        const Subject& subject) {
  MienFloatView values{};
  check(view(subject.instance.get(), &values), nullptr, "cannot read outputs", "");
  return {values.data, values.data + values.count};
}

/// Everything that a pose of the subject gives.
struct State {
  std::vector<float> controls, joints, channels, maps;
  std::vector<std::vector<float>> positions;  // of each shown mesh
};

State state_of(Subject& subject, const Frame& frame) {
  pose_subject(subject, frame);
  State state;
  state.controls = copy(mien_instance_controls, subject);
  state.joints = copy(mien_instance_joints, subject);
  state.channels = copy(mien_instance_blend_shapes, subject);
  state.maps = copy(mien_instance_animated_maps, subject);
  for (const ShownMesh& mesh : subject.meshes) {
    const float* values = subject.positions(mesh);
    state.positions.emplace_back(values, values + size_t{mesh.neutral.position_count} * 3);
  }
  return state;
}

/// Numbers of the control row by kind.
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

  // By what a joint does most, each measured by the largest of its kind.
  JointMotion most{};
  for (const JointMotion& motion : joints) {
    most.translation = std::max(most.translation, motion.translation);
    most.rotation = std::max(most.rotation, motion.rotation);
    most.scale = std::max(most.scale, motion.scale);
  }
  const auto share = [](float x, float of) { return of > 0 ? x / of : 0; };
  const auto rank = [&](const JointMotion& m) {
    return share(m.translation, most.translation) + share(m.rotation, most.rotation) +
           share(m.scale, most.scale);
  };
  std::stable_sort(joints.begin(), joints.end(),
                   [&](const JointMotion& a, const JointMotion& b) { return rank(a) > rank(b); });
  return joints;
}

MeshMotion find_motion(const ShownMesh& mesh, const std::vector<float>& rest,
                       const std::vector<float>& on, float still) {
  MeshMotion motion;
  motion.mesh = &mesh;
  const size_t count = mesh.neutral.position_count;
  motion.distances.resize(count);
  for (size_t i = 0; i < count; ++i) {
    const float distance = length(picture::load3(on.data(), i) - picture::load3(rest.data(), i));
    motion.distances[i] = distance;
    if (distance <= motion.most) continue;
    motion.most = distance;
    motion.max_position = static_cast<uint32_t>(i);
  }
  const float least = std::max(still, motion.most * kStill);
  float weight = 0;
  for (size_t i = 0; i < count; ++i) {
    const float distance = motion.distances[i];
    if (distance <= least) continue;
    const Vec3 neutral = picture::load3(mesh.neutral.positions.data, i);
    ++motion.moved;
    motion.box.add(neutral);
    motion.center += neutral * distance;
    motion.mean += picture::load3(on.data(), i) - picture::load3(rest.data(), i);
    weight += distance;
  }
  if (motion.moved == 0) {
    motion.most = 0;
    return motion;
  }
  motion.center = motion.center * (1 / weight);
  motion.mean = motion.mean * (1 / static_cast<float>(motion.moved));
  return motion;
}

/// Correctives of a control by trying: its other inputs alone, and all of them together.
class CorrectiveTrial {
 public:
  CorrectiveTrial(Subject& subject, const State& rest, const std::map<uint32_t, float>& driven)
      : subject_(subject), rest_(rest), driven_(driven) {}

  void find_further(Corrective& corrective, const std::vector<uint32_t>& inputs, const Row& row) {
    Frame frame;
    std::vector<const State*> singles;
    for (const uint32_t input : inputs) {
      frame.raw.push_back({input, value_of(input)});
      singles.push_back(&single(input));
    }
    const State together = state_of(subject_, frame);
    corrective.together = together.controls[row.raw + corrective.psd];
    if (subject_.meshes.empty()) {
      corrective.further = excess(
          together.joints, rest_.joints, singles,
          [](const State& s) -> const std::vector<float>& { return s.joints; }, kValues);
      return;
    }
    for (size_t m = 0; m < subject_.meshes.size(); ++m) {
      const float further = excess(
          together.positions[m], rest_.positions[m], singles,
          [m](const State& s) -> const std::vector<float>& { return s.positions[m]; }, 3);
      corrective.further = std::max(corrective.further, further);
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
    return singles_.emplace(raw, state_of(subject_, frame)).first->second;
  }

  /// Largest distance, over the first three of each `stride` values, between what is there and the
  /// sum of what the inputs do alone.
  template <class Values>
  static float excess(const std::vector<float>& together, const std::vector<float>& rest,
                      const std::vector<const State*>& singles, Values values, size_t stride) {
    float most = 0;
    for (size_t i = 0; i + stride <= together.size(); i += stride) {
      Vec3 sum;
      for (const State* state : singles) {
        const float* v = values(*state).data() + i;
        sum += Vec3{v[0] - rest[i], v[1] - rest[i + 1], v[2] - rest[i + 2]};
      }
      const Vec3 all = {together[i] - rest[i], together[i + 1] - rest[i + 1],
                        together[i + 2] - rest[i + 2]};
      most = std::max(most, length(all - sum));
    }
    return most;
  }

  Subject& subject_;
  const State& rest_;
  const std::map<uint32_t, float>& driven_;
  std::map<uint32_t, State> singles_;
};

std::vector<Corrective> find_correctives(Subject& subject, const State& rest, const State& on,
                                         const std::map<uint32_t, float>& driven,
                                         const Session& session) {
  const MienRig* rig = subject.rig.get();
  const Row row(rig);
  CorrectiveTrial trial(subject, rest, driven);
  std::vector<Corrective> correctives;
  Progress progress(session, "corrective", row.psd);
  for (uint32_t psd = 0; psd < row.psd; ++psd) {
    progress.at(psd);
    MienIndexView view{};
    check(mien_rig_psd_inputs(rig, psd, &view), nullptr, "cannot examine rig", "");
    const std::vector<uint32_t> inputs(view.data, view.data + view.count);
    Corrective corrective{psd, {}, on.controls[row.raw + psd], true, 0, 0};
    bool concerned = false;
    for (const uint32_t input : inputs) {
      corrective.reachable &= input < row.raw;
      if (driven.count(input)) {
        concerned = true;
      } else {
        corrective.partners.push_back(row.name(rig, input));
      }
    }
    if (!concerned) continue;
    if (corrective.reachable) trial.find_further(corrective, inputs, row);
    correctives.push_back(std::move(corrective));
  }
  std::stable_sort(correctives.begin(), correctives.end(),
                   [](const Corrective& a, const Corrective& b) { return a.further > b.further; });
  return correctives;
}

}  // namespace

float Influence::most() const {
  float most = 0;
  for (const MeshMotion& motion : meshes) most = std::max(most, motion.most);
  return most;
}

Influence find_influence(Subject& subject, const Control& control, float value,
                         const Session& session) {
  const MienRig* rig = subject.rig.get();
  const bool gui = control.kind == MIEN_KIND_GUI_CONTROL;
  Frame rest_frame, frame;
  rest_frame.maps_gui = frame.maps_gui = gui;
  (gui ? frame.gui : frame.raw).push_back({control.index, value});
  const State rest = state_of(subject, rest_frame);
  const State on = state_of(subject, frame);

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
  const float still =
      subject.meshes.empty() ? 0 : length(subject.neutral_box().size()) * kStillOfSize;
  for (size_t m = 0; m < subject.meshes.size(); ++m) {
    influence.meshes.push_back(
        find_motion(subject.meshes[m], rest.positions[m], on.positions[m], still));
  }
  // Tried with raw controls, whichever way the control was given.
  const State untouched = gui ? state_of(subject, {}) : State{};
  influence.correctives = find_correctives(subject, gui ? untouched : rest, on, driven, session);
  pose_subject(subject, frame);
  return influence;
}

}  // namespace mien::cli
