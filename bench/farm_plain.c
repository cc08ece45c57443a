/* SPDX-License-Identifier: MIT
 *
 * What `mien farm` is compared with: the least that a C program does for the same bytes.
 *
 *     farm_plain RIG.rig ISA FOLDER CLIP...     (FOLDER "-": evaluate only)
 *
 * Writes the joints of every frame to FOLDER/CLIP.npy with fwrite(): no checks of values, no records, no temporary
 * files. ISA is a word such as "avx2". docs/farms.md, 5 "What it costs", has the figures.
 */
#include <mien.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { kFramesAtOnce = 256, kMostChannels = 4096 };

static void stop_if(int failed, const char* what) {
  if (!failed) return;
  fprintf(stderr, "farm_plain: %s\n", what);
  exit(1);
}

static uint32_t isa_of(const char* word) {
  for (uint32_t isa = MIEN_ISA_BEST; isa < 16; ++isa)
    if (strcmp(mien_isa_name(isa), word) == 0) return isa;
  return MIEN_ISA_BEST;
}

static void write_header(FILE* out, uint32_t frames, size_t values) {
  char text[118 + 1];
  int length = snprintf(text, sizeof text,
                        "{'descr': '<f4', 'fortran_order': False, 'shape': (%u, %zu, 9), }", frames,
                        values / 9);
  memset(text + length, ' ', sizeof text - 1 - (size_t)length);
  text[117] = '\n';
  stop_if(fwrite("\x93NUMPY\x01\x00\x76\x00", 1, 10, out) != 10, "cannot write");
  stop_if(fwrite(text, 1, 118, out) != 118, "cannot write");
}

static void run_clip(const MienRig* rig, MienInstance* face, const char* folder, const char* path) {
  static uint32_t controls[kMostChannels];
  static float values[kFramesAtOnce * kMostChannels];
  MienClip* clip = NULL;
  MienClipInfo info = {.struct_size = sizeof info};
  MienMutableFloatView raw;
  MienFloatView joints;
  FILE* out = NULL;
  stop_if(mien_clip_open_file(path, NULL, &clip, NULL) || mien_clip_info(clip, &info), path);
  stop_if(info.channel_count > kMostChannels, "too many channels");
  for (uint32_t c = 0; c < info.channel_count; ++c) {
    MienClipChannel channel = {.struct_size = sizeof channel};
    stop_if(mien_clip_channel(clip, c, &channel) != MIEN_OK, path);
    stop_if(mien_rig_find_n(rig, MIEN_KIND_RAW_CONTROL, channel.name.data, channel.name.count,
                            &controls[c]) != MIEN_OK,
            "the rig lacks a control of the clip");
  }
  stop_if(mien_instance_reset(face) || mien_instance_raw_controls(face, &raw) ||
              mien_instance_joints(face, &joints),
          path);
  if (strcmp(folder, "-") != 0) {
    char name[4096];
    const char* slash = strrchr(path, '/');
    snprintf(name, sizeof name, "%s/%s.npy", folder, slash ? slash + 1 : path);
    out = fopen(name, "wb");
    stop_if(!out, name);
    write_header(out, info.frame_count, joints.count);
  }
  for (uint32_t f = 0; f < info.frame_count; ++f) {
    const float* row = values + (size_t)(f % kFramesAtOnce) * info.channel_count;
    const uint32_t left = info.frame_count - f;
    if (f % kFramesAtOnce == 0)
      stop_if(mien_clip_read(clip, f, left < kFramesAtOnce ? left : kFramesAtOnce, values, 0, NULL),
              path);
    for (uint32_t c = 0; c < info.channel_count; ++c) raw.data[controls[c]] = row[c];
    stop_if(mien_rig_evaluate(rig, face, 0) != MIEN_OK, path);
    if (out) stop_if(fwrite(joints.data, 4, joints.count, out) != joints.count, "cannot write");
  }
  if (out) stop_if(fclose(out) != 0, "cannot write");
  mien_clip_close(clip);
}

int main(int argc, char** argv) {
  MienBaked* baked = NULL;
  MienRig* rig = NULL;
  MienInstance* face = NULL;
  stop_if(argc < 5, "RIG.rig ISA FOLDER CLIP...");
  MienBakedRigDesc desc = {.struct_size = sizeof desc, .isa = isa_of(argv[2])};
  stop_if(mien_baked_open_file(argv[1], NULL, &baked, NULL) ||
              mien_rig_from_baked(baked, &desc, &rig, NULL) ||
              mien_instance_create(rig, NULL, &face, NULL),
          argv[1]);
  for (int i = 4; i < argc; ++i) run_clip(rig, face, argv[3], argv[i]);
  mien_instance_destroy(face);
  mien_rig_destroy(rig);
  mien_baked_close(baked);
  return 0;
}
