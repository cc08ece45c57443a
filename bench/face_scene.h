// SPDX-License-Identifier: MIT
// The scene of tests/support/mix_scene.h as a face that talks and feels, for a rig of any size: the
// controls of the generated head stand for raw controls of the rig, drawn at random.
//
// Guards are measured on that head: three of the lips, lower lip to teeth, two of the lids. Speech is
// a clip of visemes, 7.5 a second, of which every second one closes the lips or brings the lower lip to
// the teeth; the other clip and the stream move the rest of the face, and controls that the head lacks.
// Moods open the mouth: laughter, rage, fear, surprise.
#pragma once

#include <algorithm>

#include "bench/bench_support.h"
#include "capi/handles.h"
#include "runtime/probe/probe_guards.h"
#include "tests/support/face_poses.h"
#include "tests/support/mix_scene.h"

namespace mien::bench {

struct MeasuredHead {
  std::vector<std::string> controls;
  std::vector<Guard> guards;
};

inline MeasuredHead measure_head() {
  MienGenerateDesc generate = sized<MienGenerateDesc>();
  generate.preset = MIEN_PRESET_HEAD;
  MienRigDesc rig_desc = sized<MienRigDesc>();
  MienDeformerDesc deformer_desc = sized<MienDeformerDesc>();
  MienError error = sized<MienError>();
  MienDna* dna = nullptr;
  MienRig* rig = nullptr;
  MienDeformer* deformer = nullptr;
  require(mien_dna_generate(&generate, &dna, &error), error);
  require(mien_rig_create(dna, &rig_desc, &rig, &error), error);
  require(mien_deformer_create(dna, rig, &deformer_desc, &deformer, &error), error);
  MeasuredHead head;
  for (uint32_t c = 0; c < capi::object(rig)->raw_count; ++c) {
    MienStringView name = {};
    require(mien_rig_name(rig, MIEN_KIND_RAW_CONTROL, c, &name));
    head.controls.emplace_back(name.data, name.count);
  }
  {
    Arena arena(default_allocator());
    StandardGuards standard = {};
    Error failed;
    const Deformer& measured = *capi::object(deformer);
    scene_requires(find_standard_guards(measured, default_allocator(), arena, standard, failed));
    std::vector<Guard> all(standard.count);
    scene_requires(probe_guards(measured, {standard.descs, standard.count}, default_allocator(),
                                {all.data(), all.size()}, failed));
    for (const Guard& guard : all) {
      if (guard.kind != static_cast<uint32_t>(StandardGuard::kTeeth)) head.guards.push_back(guard);
    }
  }
  mien_deformer_destroy(deformer);
  mien_rig_destroy(rig);
  mien_dna_close(dna);
  return head;
}

class FaceScene {
 public:
  /// `moved_count` raw controls are moved by something.
  FaceScene(const MeasuredHead& of, uint32_t raw_count, uint32_t moved_count) : head_(of) {
    parts.raw_count = raw_count;
    for (uint16_t l = 0; l < raw_count; ++l) parts.moved.push_back(l);
    Random random = Random::from_seed(3, 0);
    for (uint32_t i = 0; i + 1 < raw_count; ++i) {
      std::swap(parts.moved[i], parts.moved[i + random.below(raw_count - i)]);
    }
    parts.moved.resize(moved_count);
    scene_requires(moved_count > head_.controls.size() ? Status::kOk : Status::kMismatch);
    place_guards();
    make_clips();
    make_poses();
    for (size_t c = 0; c < head_.controls.size() && parts.channels.size() < MixScene::kChannels;
         ++c) {
      if (!is_mouth(c)) parts.channels.push_back(parts.moved[c]);
    }
    parts.blinks = curves_of("eyeBlink 1");
    parts.small = curves_of("browOuterUp 1, noseSneer 1");
  }

  SceneParts parts;

 private:
  const MeasuredHead& head_;

  bool is_mouth(size_t control) const {
    const std::string& name = head_.controls[control];
    return name.rfind("mouth", 0) == 0 || name.rfind("jaw", 0) == 0 || name.rfind("tongue", 0) == 0;
  }

  std::vector<uint16_t> curves_of(PoseText text) const {
    std::vector<uint16_t> curves;
    const Pose pose = pose_of(text, head_.controls);
    for (size_t c = 0; c < pose.size(); ++c) {
      if (pose[c] != 0) curves.push_back(parts.moved[c]);
    }
    return curves;
  }

  void place_guards() {
    for (Guard guard : head_.guards) {
      for (uint32_t i = 0; i < guard.count; ++i) guard.curves[i] = parts.moved[guard.curves[i]];
      parts.guards.push_back(guard);
    }
  }

  void make_clips() {
    const uint32_t raws = parts.raw_count;
    for (uint32_t i = 0; i < 2; ++i) {
      parts.clips[i] = scene_curves(80 + i, raws, parts.moved, 100 + 50 * i);
    }
    parts.speech_mask.assign(raws + 1, 0.0f);
    std::vector<uint16_t> mouth;
    for (size_t c = 0; c < head_.controls.size(); ++c) {
      if (!is_mouth(c)) continue;
      mouth.push_back(parts.moved[c]);
      parts.speech_mask[parts.moved[c]] = 1;
    }
    constexpr PoseText kOpen[] = {"jawOpen .45, mouthLowerDown .2", "jawOpen .2, mouthStretch .4",
                                  "jawOpen .25, mouthFunnel .5", "mouthPucker .6, jawOpen .1"};
    std::vector<Pose> visemes;
    for (size_t v = 0; v < 28; ++v) {
      const PoseText closed = v % 8 == 6 ? kLipToTeeth[v / 8 % 2] : kClosedLips[v / 2 % 5];
      visemes.push_back(pose_of(v % 2 == 0 ? closed : kOpen[v / 2 % 4], head_.controls));
    }
    // All channels of a capture move a little.
    constexpr uint32_t kFramesPerViseme = 8;
    const auto frames = static_cast<uint32_t>(visemes.size()) * kFramesPerViseme;
    std::vector<float>& speech = parts.clips[2] = scene_curves(82, raws, mouth, frames);
    for (float& value : speech) value *= 0.02f;
    for (uint32_t f = 0; f < frames; ++f) {
      const size_t v = f / kFramesPerViseme;
      const float u = static_cast<float>(f % kFramesPerViseme) / kFramesPerViseme;
      const float s = u * u * (3 - 2 * u);
      const Pose &from = visemes[v], &to = visemes[(v + 1) % visemes.size()];
      for (size_t c = 0; c < from.size(); ++c) {
        speech[size_t{f} * raws + parts.moved[c]] += (1 - s) * from[c] + s * to[c];
      }
    }
  }

  /// Further curves stand for what the head lacks: pupils, a turn of the head.
  void set_pose(uint32_t at, PoseText text, std::vector<uint16_t> others = {}) {
    SceneParts::Pose& pose = parts.poses[at];
    const Pose values = pose_of(text, head_.controls);
    for (size_t c = 0; c < values.size(); ++c) {
      if (values[c] == 0) continue;
      pose.curves.push_back(parts.moved[c]);
      pose.values.push_back(values[c]);
    }
    for (uint16_t curve : others) {
      pose.curves.push_back(curve);
      pose.values.push_back(0.5f);
    }
  }

  void make_poses() {
    constexpr uint32_t kOfGlare = SceneParts::kMoods + 1;
    const size_t moods[SceneParts::kMoods] = {1, 4, 5, 6};
    for (uint32_t m = 0; m < SceneParts::kMoods; ++m) set_pose(m, kBasicEmotions[moods[m]]);
    set_pose(SceneParts::kMoods, "jawOpen 1");
    set_pose(kOfGlare, "eyeBlink 1");
    set_pose(kOfGlare + 1, "eyeSquint .8, browDown .7, cheekSquint .5");
    set_pose(kOfGlare + 2, "eyeLookOutLeft .5, eyeLookInRight .5, eyeLookDown .2");
    set_pose(kOfGlare + 3, "", {parts.moved[head_.controls.size()]});
    set_pose(kOfGlare + 4, "", {static_cast<uint16_t>(parts.raw_count)});
  }
};

}  // namespace mien::bench
