/* SPDX-License-Identifier: MIT
 * native RIG.baked FRAMES ISA ROUNDS: evaluates frames of raw controls, one after the other, and prints the
 * shortest time per frame in nanoseconds, of all rounds, and a hash of all joint values. bench.mjs does the
 * same. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "mien.h"

static double now(void) {
  struct timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return (double)time.tv_sec * 1e9 + (double)time.tv_nsec;
}

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  const int rounds = atoi(argv[4]);
  MienBaked* baked = NULL;
  MienRig* rig = NULL;
  MienInstance* face = NULL;
  MienBakedRigDesc desc = mien_baked_rig_desc_default();
  MienMutableFloatView raw = {0};
  MienFloatView joints = {0};
  desc.isa = (uint32_t)atoi(argv[3]);
  if (mien_baked_open_file(argv[1], NULL, &baked, NULL) ||
      mien_rig_from_baked(baked, &desc, &rig, NULL) ||
      mien_instance_create(rig, NULL, &face, NULL) || mien_instance_raw_controls(face, &raw) ||
      mien_instance_joints(face, &joints))
    return 1;
  FILE* file = fopen(argv[2], "rb");
  if (!file || fseek(file, 0, SEEK_END)) return 1;
  const size_t frames = (size_t)ftell(file) / (raw.count * sizeof(float));
  float* values = malloc(frames * raw.count * sizeof(float));
  rewind(file);
  if (!values || fread(values, raw.count * sizeof(float), frames, file) != frames) return 1;
  fclose(file);

  uint32_t hash = 2166136261u;
  double best = 0;
  for (int round = 0; round < rounds; ++round) {
    const double start = now();
    for (size_t frame = 0; frame < frames; ++frame) {
      memcpy(raw.data, values + frame * raw.count, raw.count * sizeof(float));
      if (mien_rig_evaluate(rig, face, 0)) return 1;
    }
    const double time = (now() - start) / (double)frames;
    if (!round || time < best) best = time;
  }
  for (size_t frame = 0; frame < frames; ++frame) {
    memcpy(raw.data, values + frame * raw.count, raw.count * sizeof(float));
    if (mien_rig_evaluate(rig, face, 0)) return 1;
    for (size_t i = 0; i < joints.count; ++i) {
      uint32_t bits;
      memcpy(&bits, joints.data + i, sizeof bits);
      hash = (hash ^ bits) * 16777619u;
    }
  }
  printf("%.1f %" PRIu32 "\n", best, hash);
  mien_instance_destroy(face);
  mien_rig_destroy(rig);
  mien_baked_close(baked);
  free(values);
  return 0;
}
