/* SPDX-License-Identifier: MIT
 *
 * main FILE.dna: evaluates the rig of the file once; 0 if all goes well. With MAKES_FILES, which
 * takes libmien-author, it generates the file before. */
#ifdef MAKES_FILES
#include <mien_author.h>
#else
#include <mien.h>
#endif
#include <stdio.h>

static MienStatus open_rig(const char* path, MienDna** dna, MienError* error) {
#ifdef MAKES_FILES
  MienStatus status = mien_dna_generate(NULL, dna, error);
  return status != MIEN_OK ? status : mien_dna_write_file(*dna, path, NULL, error);
#else
  return mien_dna_open_file(path, NULL, dna, error);
#endif
}

int main(int argc, char** argv) {
  MienError error = {sizeof error, MIEN_OK, 0, ""};
  MienDna* dna = NULL;
  MienRig* rig = NULL;
  MienInstance* instance = NULL;
  MienFloatView joints = {NULL, 0};

  if (mien_version() != MIEN_VERSION) {
    fprintf(stderr, "the library is not of the version of its header\n");
    return 1;
  }
  if (argc != 2) return 1;
  if (open_rig(argv[1], &dna, &error) != MIEN_OK ||
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
