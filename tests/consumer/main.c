/* SPDX-License-Identifier: MIT
 *
 * Generates a rig, evaluates it once, and returns 0 if all went well. */
#include <mien.h>
#include <stdio.h>

int main(void) {
  MienError error = {sizeof error, MIEN_OK, 0, ""};
  MienDna* dna = NULL;
  MienRig* rig = NULL;
  MienInstance* instance = NULL;
  MienFloatView joints = {NULL, 0};

  if (mien_version() != MIEN_VERSION) {
    fprintf(stderr, "the library is not of the version of its header\n");
    return 1;
  }
  if (mien_dna_generate(NULL, &dna, &error) != MIEN_OK ||
      mien_rig_create(dna, NULL, &rig, &error) != MIEN_OK ||
      mien_instance_create(rig, NULL, &instance, &error) != MIEN_OK ||
      mien_rig_evaluate(rig, instance, 0) != MIEN_OK ||
      mien_instance_joints(instance, &joints) != MIEN_OK) {
    fprintf(stderr, "mien: %s\n", error.message);
    return 1;
  }
  printf("mien %d.%d.%d: %u joint values\n", MIEN_VERSION_MAJOR, MIEN_VERSION_MINOR,
         MIEN_VERSION_PATCH, (unsigned)joints.count);
  mien_instance_destroy(instance);
  mien_rig_destroy(rig);
  mien_dna_close(dna);
  return joints.count > 0 ? 0 : 1;
}
