/* SPDX-License-Identifier: MIT */
#include <mien_author.h>
#include <stdio.h>
#include <stdlib.h>

/* mix: a head speaks, is glad, and closes its eyes when a flashlight hits them. */
enum { JAW, SMILE_L, SMILE_R, CHEEK_L, CHEEK_R, BLINK_L, BLINK_R, SQUINT_L, SQUINT_R, CURVES };
static const char* const names[CURVES] = {"jawOpen",         "mouthSmileLeft",   "mouthSmileRight",
                                          "cheekSquintLeft", "cheekSquintRight", "eyeBlinkLeft",
                                          "eyeBlinkRight",   "eyeSquintLeft",    "eyeSquintRight"};
static MienError error = {.struct_size = sizeof error};

static void check(MienStatus status) {
  if (status == MIEN_OK) return;
  fprintf(stderr, "%s: %s\n", mien_status_name(status), error.message);
  exit(1);
}

int main(void) {
  const int64_t ms = MIEN_TICKS_PER_SECOND / 1000, frame = MIEN_TICKS_PER_SECOND / 60;
  MienGenerateDesc head = {.struct_size = sizeof head, .preset = MIEN_PRESET_HEAD};
  MienDna* dna;
  MienRig* rig;
  MienDeformer* deformer;
  MienInstance* face;
  check(mien_dna_generate(&head, &dna, &error));
  check(mien_rig_create(dna, NULL, &rig, &error));
  check(mien_deformer_create(dna, rig, NULL, &deformer, &error));
  check(mien_instance_create(rig, NULL, &face, &error));
  uint16_t curve[CURVES];
  for (int i = 0; i < CURVES; ++i) {
    uint32_t index;
    check(mien_rig_find(rig, MIEN_KIND_RAW_CONTROL, names[i], &index));
    curve[i] = (uint16_t)index;
  }

  /* Speech: the jaw at 60 frames a second, closed for every m of "mama mama". */
  float jaw[180];
  for (int i = 0; i < 180; ++i) {
    const int phase = i % 30;
    jaw[i] = phase < 8 ? 0 : (float)(phase - 8) * (float)(29 - phase) / 220;
  }
  const MienStringView channel = {"jawOpen", 7};
  MienClipDesc curves = {.struct_size = sizeof curves,
                         .rate_numerator = 60,
                         .rate_denominator = 1,
                         .frame_count = 180,
                         .channel_count = 1,
                         .names = &channel,
                         .values = jaw};
  MienClip* speech;
  MienClipBinding* binding;
  check(mien_clip_build(&curves, &speech, &error));
  check(mien_clip_binding_create(speech, rig, NULL, &binding, &error));

  /* Joy over it, held back where it would part the lips; the flashlight acts last. */
  const float joy[] = {0.2f, 0.9f, 0.9f, 0.6f, 0.6f}, closed[] = {1, 1}, narrow[] = {0.8f, 0.8f};
  const MienMixPose poses[] = {
      {curve, joy, 5}, {curve + BLINK_L, closed, 2}, {curve + SQUINT_L, narrow, 2}};
  const MienMixStroke strokes[] = {{.pose = 1,
                                    .mode = MIEN_BLEND_MODE_MAX,
                                    .delay = 60 * ms,
                                    .attack = 70 * ms,
                                    .hold = 60 * ms,
                                    .release = 220 * ms},
                                   {.pose = 2,
                                    .mode = MIEN_BLEND_MODE_SCREEN,
                                    .delay = 90 * ms,
                                    .attack = 150 * ms,
                                    .release = 400 * ms,
                                    .is_held = 1}};
  const MienMixReaction flashlight = {.strokes = strokes,
                                      .stroke_count = 2,
                                      .adapted = 0.6f,
                                      .adapt_ticks = 1500 * ms,
                                      .recover_ticks = 1500 * ms,
                                      .cooldown = 250 * ms};
  const MienMixLayer layers[] = {
      {.group = MIEN_LAYER_GROUP_SPEECH, .source = MIEN_LAYER_SOURCE_CLIP, .weight = 1},
      {.group = MIEN_LAYER_GROUP_EMOTION,
       .source = MIEN_LAYER_SOURCE_POSES,
       .weight = 1,
       .mode = MIEN_BLEND_MODE_SCREEN,
       .pose_count = 1}};
  MienMixDesc desc = {.struct_size = sizeof desc,
                      .layers = layers,
                      .layer_count = 2,
                      .poses = poses,
                      .pose_count = 3,
                      .reactions = &flashlight,
                      .reaction_count = 1,
                      .deformer = deformer,
                      .guards = MIEN_GUARD_LIPS};
  MienMix* mix;
  MienMixer* mixer;
  MienFloatView row, joints;
  check(mien_mix_create(rig, &desc, &mix, &error));
  check(mien_mixer_create(mix, NULL, &mixer, &error));
  check(mien_mixer_row(mixer, &row));
  check(mien_instance_joints(face, &joints));

  MienPlayDesc play = {.struct_size = sizeof play, .transition_ticks = 100 * ms};
  check(mien_mixer_play(mixer, 0, speech, binding, &play, &error));
  check(mien_mixer_set_pose_weight(mixer, 1, 0, 0.8f, 500 * ms));
  for (int i = 1; i <= 150; ++i) {
    if (i == 90) check(mien_mixer_trigger(mixer, 0, 1, 600 * ms));
    check(mien_mixer_step(mixer, frame, face)); /* writes the raw controls of the face */
    check(mien_rig_evaluate(rig, face, 0));
    if (i % 10 != 0) continue;
    float most = 0;
    for (size_t j = 0; j < joints.count; ++j) most = joints.data[j] > most ? joints.data[j] : most;
    printf("%3d  jaw %.4f  smile %.4f  lids %.4f  squint %.4f  joints up to %.3f\n", i,
           row.data[curve[JAW]], row.data[curve[SMILE_L]], row.data[curve[BLINK_L]],
           row.data[curve[SQUINT_L]], most);
  }
  mien_mixer_destroy(mixer);
  mien_mix_destroy(mix);
  mien_clip_binding_destroy(binding);
  mien_clip_close(speech);
  mien_instance_destroy(face);
  mien_deformer_destroy(deformer);
  mien_rig_destroy(rig);
  mien_dna_close(dna);
  return 0;
}
