/* SPDX-License-Identifier: MIT */
/* play HEAD.baked TAKE.clip: plays the take on the head and prints a hash of all joints and positions. */
#ifdef MIEN_SHARED_LIBRARY /* the same program with libmien, for comparison */
#include <mien.h>
#else
#include <mien_runtime.h>
#endif
#include <stdio.h>
#include <stdlib.h>

static MienError error = {.struct_size = sizeof error};

static void check(MienStatus status) {
  if (status == MIEN_OK) return;
  fprintf(stderr, "%s: %s\n", mien_status_name(status), error.message);
  exit(1);
}

/* FNV-1a, of the bits. */
static uint64_t add(uint64_t hash, MienFloatView floats) {
  const unsigned char* bytes = (const unsigned char*)floats.data;
  for (size_t i = 0; i < floats.count * sizeof(float); ++i)
    hash = (hash ^ bytes[i]) * 1099511628211u;
  return hash;
}

int main(int argc, char** argv) {
  MienBaked* baked;
  MienRig* rig;
  MienInstance* face;
  MienDeformer* deformer;
  MienDeformerInstance* vertices;
  MienClip* clip;
  MienClipBinding* binding;
  MienClipPlayer* player;
  MienMutableFloatView controls;
  MienFloatView view;
  MienBakedRigDesc rig_desc = {.struct_size = sizeof rig_desc, .isa = MIEN_ISA_ENVIRONMENT};
  MienBakedDeformerDesc deformer_desc = {.struct_size = sizeof deformer_desc,
                                         .isa = MIEN_ISA_ENVIRONMENT};
  uint64_t joints = 14695981039346656037u, positions = joints;
  if (argc != 3) return fprintf(stderr, "usage: play HEAD.baked TAKE.clip\n"), 1;
  check(mien_baked_open_file(argv[1], NULL, &baked, &error));
  check(mien_rig_from_baked(baked, &rig_desc, &rig, &error));
  check(mien_deformer_from_baked(baked, rig, &deformer_desc, &deformer, &error));
  mien_baked_close(baked);
  check(mien_instance_create(rig, NULL, &face, &error));
  check(mien_deformer_instance_create(deformer, NULL, &vertices, &error));
  check(mien_clip_open_file(argv[2], NULL, &clip, &error));
  check(mien_clip_binding_create(clip, rig, NULL, &binding, &error));
  check(mien_clip_player_create(clip, NULL, &player, &error));
  check(mien_instance_raw_controls(face, &controls));
  for (int frame = 0; frame < 60; ++frame) {
    check(mien_clip_player_sample(player, &view));
    check(mien_clip_binding_apply(binding, view.data, view.count, controls.data, controls.count));
    check(mien_rig_evaluate(rig, face, 0));
    check(mien_instance_joints(face, &view));
    joints = add(joints, view);
    check(mien_deformer_instance_update(vertices, face));
    check(mien_deformer_instance_deform(vertices, 0, MIEN_NORMALS_SKINNED, NULL));
    check(mien_deformer_instance_positions(vertices, 0, &view));
    positions = add(positions, view);
    check(mien_clip_player_advance(player, MIEN_TICKS_PER_SECOND / 60));
  }
  printf("joints %016llx, positions %016llx\n", (unsigned long long)joints,
         (unsigned long long)positions);
  mien_clip_player_destroy(player);
  mien_clip_binding_destroy(binding);
  mien_clip_close(clip);
  mien_deformer_instance_destroy(vertices);
  mien_instance_destroy(face);
  mien_deformer_destroy(deformer);
  mien_rig_destroy(rig);
  return 0;
}
