/* SPDX-License-Identifier: MIT */
#include <mien_author.h>
#include <stdio.h>
#include <string.h>

/* evaluate [FILE.dna [CONTROL]]: raises a control and prints the joint that moves or turns most. */
int main(int argc, char** argv) {
  const char* control = argc > 2 ? argv[2] : "CTRL_expressions.jawOpen";
  MienGenerateDesc large = {.struct_size = sizeof large, .preset = MIEN_PRESET_LARGE};
  MienError error = {.struct_size = sizeof error};
  MienDna* dna = NULL;
  MienRig* rig = NULL;
  MienInstance* face = NULL;
  MienMutableFloatView inputs;
  MienFloatView moves = {0}; /* per joint tx ty tz rx ry rz sx sy sz, from neutral */
  MienStringView name;
  uint32_t index = 0, most = 0;
  MienStatus status = argc > 1 ? mien_dna_open_file(argv[1], NULL, &dna, &error)
                               : mien_dna_generate(&large, &dna, &error);
  if (!status) status = mien_rig_create(dna, NULL, &rig, &error);
  if (!status) status = mien_instance_create(rig, NULL, &face, &error);
  if (!status) status = mien_rig_find(rig, MIEN_KIND_RAW_CONTROL, control, &index);
  if (status == MIEN_ERROR_NAME && strchr(control, '.')) { /* some rigs leave the prefix out */
    control = strrchr(control, '.') + 1;
    status = mien_rig_find(rig, MIEN_KIND_RAW_CONTROL, control, &index);
  }
  if (!status) status = mien_instance_raw_controls(face, &inputs);
  if (!status) inputs.data[index] = 1; /* written in place */
  if (!status) status = mien_rig_evaluate(rig, face, 0);
  if (!status) status = mien_instance_joints(face, &moves);
  for (uint32_t i = 0; i < moves.count; ++i)
    if (i % 9 < 6 && moves.data[i] * moves.data[i] > moves.data[most] * moves.data[most]) most = i;
  if (!status) status = mien_rig_name(rig, MIEN_KIND_JOINT, most / 9, &name);
  if (status) {
    fprintf(stderr, "%s: %s\n", mien_status_name(status), error.status ? error.message : control);
  } else {
    const float* d = moves.data + most / 9 * 9;
    printf("%s moves %.*s most: by %.3f %.3f %.3f, turning it by %.3f %.3f %.3f\n", control,
           (int)name.count, name.data, d[0], d[1], d[2], d[3], d[4], d[5]);
  }
  mien_instance_destroy(face);
  mien_rig_destroy(rig);
  mien_dna_close(dna);
  return status != MIEN_OK;
}
