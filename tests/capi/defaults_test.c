/* SPDX-License-Identifier: MIT
 * The default of every sized struct: its size in place, all else zero. Compiled as C11 and as C++17,
 * both with the warnings that users turn on. */
#include <mien_author.h>
#include <stdio.h>
#include <string.h>

static int failures;

static void check(const void* object, size_t size, const char* name) {
  const unsigned char* bytes = (const unsigned char*)object;
  size_t struct_size, i;
  memcpy(&struct_size, object, sizeof struct_size);
  if (struct_size != size) {
    fprintf(stderr, "%s: struct_size is not its size\n", name);
    ++failures;
  }
  for (i = sizeof struct_size; i < size; ++i) {
    if (bytes[i] != 0) {
      fprintf(stderr, "%s: byte %lu is not zero\n", name, (unsigned long)i);
      ++failures;
      break;
    }
  }
}

#define CHECK_DEFAULT(Type, function)   \
  do {                                  \
    const Type value = function();      \
    check(&value, sizeof value, #Type); \
  } while (0)

int main(void) {
  CHECK_DEFAULT(MienError, mien_error_default);
  CHECK_DEFAULT(MienCoordinateSystem, mien_coordinate_system_default);
  CHECK_DEFAULT(MienDnaDesc, mien_dna_desc_default);
  CHECK_DEFAULT(MienDnaInfo, mien_dna_info_default);
  CHECK_DEFAULT(MienDnaLayer, mien_dna_layer_default);
  CHECK_DEFAULT(MienDnaField, mien_dna_field_default);
  CHECK_DEFAULT(MienWriteDesc, mien_write_desc_default);
  CHECK_DEFAULT(MienFinding, mien_finding_default);
  CHECK_DEFAULT(MienValidateDesc, mien_validate_desc_default);
  CHECK_DEFAULT(MienGenerateDesc, mien_generate_desc_default);
  CHECK_DEFAULT(MienRigDesc, mien_rig_desc_default);
  CHECK_DEFAULT(MienRigInfo, mien_rig_info_default);
  CHECK_DEFAULT(MienBakedDesc, mien_baked_desc_default);
  CHECK_DEFAULT(MienInstanceDesc, mien_instance_desc_default);
  CHECK_DEFAULT(MienBatchDesc, mien_batch_desc_default);
  CHECK_DEFAULT(MienDeformerDesc, mien_deformer_desc_default);
  CHECK_DEFAULT(MienDeformerInfo, mien_deformer_info_default);
  CHECK_DEFAULT(MienMesh, mien_mesh_default);
  CHECK_DEFAULT(MienDeformerInstanceDesc, mien_deformer_instance_desc_default);
  CHECK_DEFAULT(MienClipDesc, mien_clip_desc_default);
  CHECK_DEFAULT(MienClipOpenDesc, mien_clip_open_desc_default);
  CHECK_DEFAULT(MienClipInfo, mien_clip_info_default);
  CHECK_DEFAULT(MienClipChannel, mien_clip_channel_default);
  CHECK_DEFAULT(MienClipPlayerDesc, mien_clip_player_desc_default);
  CHECK_DEFAULT(MienClipPlayerInfo, mien_clip_player_info_default);
  CHECK_DEFAULT(MienClipBindingDesc, mien_clip_binding_desc_default);
  CHECK_DEFAULT(MienClipBindingInfo, mien_clip_binding_info_default);
  CHECK_DEFAULT(MienMixDesc, mien_mix_desc_default);
  CHECK_DEFAULT(MienGazeDesc, mien_gaze_desc_default);
  CHECK_DEFAULT(MienMixInfo, mien_mix_info_default);
  CHECK_DEFAULT(MienMixerDesc, mien_mixer_desc_default);
  CHECK_DEFAULT(MienPlayDesc, mien_play_desc_default);
  CHECK_DEFAULT(MienMixerInfo, mien_mixer_info_default);
#ifdef MIEN_EXPERIMENTAL
  CHECK_DEFAULT(MienRigStatistics, mien_rig_statistics_default);
  CHECK_DEFAULT(MienInstanceStatistics, mien_instance_statistics_default);
#endif
  return failures != 0;
}
