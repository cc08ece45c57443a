// SPDX-License-Identifier: MIT
#define MIEN_EXCEPTIONS  // value() throws; without, test each result
#include <algorithm>
#include <cstdio>
#include <mien_author.hpp>
#include <vector>

/* mix: a head speaks, is glad, and closes its eyes when a flashlight hits them. */
int main() try {
  constexpr int64_t ms = MIEN_TICKS_PER_SECOND / 1000, frame = MIEN_TICKS_PER_SECOND / 60;
  mien::GenerateDesc head;
  head.preset = MIEN_PRESET_HEAD;
  const mien::Dna dna = mien::generate(head).value();
  const mien::Rig rig = mien::Rig::create(dna).value();
  const mien::Deformer deformer = mien::Deformer::create(dna, rig).value();
  mien::Instance face = rig.instance().value();
  const auto curve = [&](const char* name) {
    return static_cast<uint16_t>(rig.find(MIEN_KIND_RAW_CONTROL, name).value());
  };

  // Speech: the jaw at 60 frames a second, closed for every m of "mama mama".
  std::vector<float> jaw;
  for (int i = 0; i < 180; ++i) {
    const int phase = i % 30;
    jaw.push_back(phase < 8 ? 0 : static_cast<float>((phase - 8) * (29 - phase)) / 220);
  }
  const MienStringView channel = mien::view("jawOpen");
  mien::ClipDesc curves;
  curves.rate_numerator = 60;
  curves.rate_denominator = curves.channel_count = 1;
  curves.frame_count = 180;
  curves.names = &channel;
  curves.values = jaw.data();
  const mien::Clip speech = mien::Clip::build(curves).value();
  const mien::ClipBinding binding = speech.bind(rig).value();

  // Joy over it, held back where it would part the lips; the flashlight acts last.
  const uint16_t glad[] = {curve("jawOpen"), curve("mouthSmileLeft"), curve("mouthSmileRight"),
                           curve("cheekSquintLeft"), curve("cheekSquintRight")};
  const uint16_t lids[] = {curve("eyeBlinkLeft"), curve("eyeBlinkRight")};
  const uint16_t squints[] = {curve("eyeSquintLeft"), curve("eyeSquintRight")};
  const float joy[] = {0.2f, 0.9f, 0.9f, 0.6f, 0.6f}, closed[] = {1, 1}, narrow[] = {0.8f, 0.8f};
  const MienMixPose poses[] = {{glad, joy, 5}, {lids, closed, 2}, {squints, narrow, 2}};
  MienMixStroke strokes[2] = {};
  strokes[0].pose = 1;
  strokes[0].mode = MIEN_BLEND_MODE_MAX;
  strokes[0].delay = 60 * ms;
  strokes[0].attack = 70 * ms;
  strokes[0].hold = 60 * ms;
  strokes[0].release = 220 * ms;
  strokes[1].pose = 2;
  strokes[1].mode = MIEN_BLEND_MODE_SCREEN;
  strokes[1].delay = 90 * ms;
  strokes[1].attack = 150 * ms;
  strokes[1].release = 400 * ms;
  strokes[1].is_held = 1;
  MienMixReaction flashlight = {};
  flashlight.strokes = strokes;
  flashlight.stroke_count = 2;
  flashlight.adapted = 0.6f;
  flashlight.adapt_ticks = flashlight.recover_ticks = 1500 * ms;
  flashlight.cooldown = 250 * ms;
  MienMixLayer layers[2] = {};
  layers[0].group = MIEN_LAYER_GROUP_SPEECH;
  layers[1].group = MIEN_LAYER_GROUP_EMOTION;
  layers[1].source = MIEN_LAYER_SOURCE_POSES;
  layers[1].mode = MIEN_BLEND_MODE_SCREEN;
  layers[1].pose_count = 1;
  layers[0].weight = layers[1].weight = 1;
  mien::MixDesc desc;
  desc.layers = layers;
  desc.layer_count = 2;
  desc.poses = poses;
  desc.pose_count = 3;
  desc.reactions = &flashlight;
  desc.reaction_count = 1;
  desc.deformer = deformer.get();
  desc.guards = MIEN_GUARD_LIPS;
  mien::Mixer mixer = mien::Mix::create(rig, desc).value().mixer().value();

  mien::PlayDesc play;
  play.transition_ticks = 100 * ms;
  mixer.play(0, speech, binding, play).value();
  mixer.set_pose_weight(1, 0, 0.8f, 500 * ms).value();
  for (int i = 1; i <= 150; ++i) {
    if (i == 90) mixer.trigger(0, 1, 600 * ms).value();
    mixer.step(frame, face).value();  // writes the raw controls of the face
    rig.evaluate(face, 0).value();
    if (i % 10 != 0) continue;
    const auto row = mixer.row(), joints = face.joints();
    std::printf("%3d  jaw %.4f  smile %.4f  lids %.4f  squint %.4f  joints up to %.3f\n", i,
                row[glad[0]], row[glad[1]], row[lids[0]], row[squints[0]],
                *std::max_element(joints.begin(), joints.end()));
  }
} catch (const mien::Exception& e) {
  std::fprintf(stderr, "%s: %s\n", e.error().name(), e.what());
  return 1;
}
