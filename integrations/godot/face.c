/* SPDX-License-Identifier: MIT */
#include "face.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void face_close(Face* face) {
  mien_deformer_instance_destroy(face->pose);
  mien_instance_destroy(face->instance);
  mien_deformer_destroy(face->deformer);
  mien_rig_destroy(face->rig);
  mien_baked_close(face->baked);
  free(face->transforms);
  memset(face, 0, sizeof *face);
}

/* `end` is in lower case; the path may have either. */
static int ends_with(const char* path, const char* end) {
  const size_t length = strlen(path), part = strlen(end);
  if (length <= part) return 0;
  for (size_t i = 0; i < part; ++i) {
    const char c = path[length - part + i];
    if ((c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c) != end[i]) return 0;
  }
  return 1;
}

/* The bytes of a file, to be freed; NULL on failure. */
static unsigned char* read_file(const char* path, size_t* out_size, MienStatus* out_status) {
  FILE* file = fopen(path, "rb");
  *out_status = MIEN_ERROR_FILE_OPEN;
  if (!file) return NULL;
  unsigned char* bytes = NULL;
  *out_status = MIEN_ERROR_FILE_READ;
  const long size = fseek(file, 0, SEEK_END) == 0 ? ftell(file) : -1;
  if (size >= 0 && fseek(file, 0, SEEK_SET) == 0) {
    *out_size = (size_t)size;
    bytes = malloc(*out_size + 1);
    *out_status = bytes ? MIEN_OK : MIEN_ERROR_MEMORY;
  }
  if (bytes && fread(bytes, 1, *out_size, file) != *out_size) {
    free(bytes);
    bytes = NULL;
    *out_status = MIEN_ERROR_FILE_READ;
  }
  fclose(file);
  return bytes;
}

/* Opens the first DNA in an asset: it begins with the signature and generation 2, and bytes behind it are ignored. Only
 * the first kStarts places that begin so are tried, or else a hostile file could take long. Free `out_bytes` with free()
 * after closing the DNA. */
static MienStatus open_asset(const char* path, const MienDnaDesc* desc, unsigned char** out_bytes,
                             MienDna** out_dna, MienError* error) {
  enum { kStarts = 64 };
  static const unsigned char kStart[] = {'D', 'N', 'A', 0, 2};
  size_t size = 0;
  MienStatus status;
  unsigned char* bytes = read_file(path, &size, &status);
  *out_bytes = bytes;
  if (!bytes) {
    error->status = status;
    snprintf(error->message, sizeof error->message, "cannot read %.200s", path);
    return status;
  }
  error->status = status = MIEN_ERROR_DNA_SIGNATURE;
  snprintf(error->message, sizeof error->message, "no uncompressed DNA in %.180s", path);
  int tried = 0;
  for (size_t at = 0; at + sizeof kStart <= size && tried < kStarts; ++at) {
    if (memcmp(bytes + at, kStart, sizeof kStart) != 0) continue;
    ++tried;
    status = mien_dna_open_memory(bytes + at, size - at, desc, out_dna, error);
    if (status == MIEN_OK || status == MIEN_ERROR_MEMORY) break;
  }
  return status;
}

static int is_dna(const char* path) {
  return ends_with(path, ".dna") || ends_with(path, ".uasset");
}

static MienStatus open_dna(Face* face, const char* path, MienError* error) {
  MienDnaDesc desc = mien_dna_desc_default();
  MienCoordinateSystem system = mien_coordinate_system_default();
  MienStatus status = mien_coordinate_system_find("godot", &system);
  desc.system = &system;
  MienDna* dna = NULL;
  unsigned char* bytes = NULL;
  if (status == MIEN_OK) {
    status = ends_with(path, ".dna") ? mien_dna_open_file(path, &desc, &dna, error)
                                     : open_asset(path, &desc, &bytes, &dna, error);
  }
  if (status == MIEN_OK) status = mien_rig_create(dna, NULL, &face->rig, error);
  if (status == MIEN_OK) {
    /* A file may have no geometry: then only values are driven. */
    const MienStatus meshes = mien_deformer_create(dna, face->rig, NULL, &face->deformer, error);
    if (meshes == MIEN_ERROR_MEMORY) status = meshes;
  }
  mien_dna_close(dna);
  free(bytes);
  return status;
}

/* `baked` is open. */
static MienStatus use_baked(Face* face, MienError* error) {
  MienBakedInfo info = mien_baked_info_default();
  MienStatus status = mien_rig_from_baked(face->baked, NULL, &face->rig, error);
  if (status == MIEN_OK) status = mien_baked_info(face->baked, &info);
  if (status == MIEN_OK && info.deformer_bytes != 0)
    status = mien_deformer_from_baked(face->baked, face->rig, NULL, &face->deformer, error);
  return status;
}

static MienStatus open_rig(Face* face, const char* path, MienError* error) {
  if (is_dna(path)) return open_dna(face, path, error);
  const MienStatus status = mien_baked_open_file(path, NULL, &face->baked, error);
  return status == MIEN_OK ? use_baked(face, error) : status;
}

/* The rig is open. */
static MienStatus make_instances(Face* face, MienError* error) {
  MienStatus status = mien_instance_create(face->rig, NULL, &face->instance, error);
  if (status == MIEN_OK) status = mien_rig_count(face->rig, MIEN_KIND_JOINT, &face->joint_count);
  if (status == MIEN_OK)
    status = mien_rig_count(face->rig, MIEN_KIND_BLEND_SHAPE_CHANNEL, &face->channel_count);
  if (status != MIEN_OK || !face->deformer) return status;
  face->transforms = calloc(face->joint_count ? face->joint_count : 1, 10 * sizeof(float));
  if (!face->transforms) return MIEN_ERROR_MEMORY;
  return mien_deformer_instance_create(face->deformer, NULL, &face->pose, error);
}

MienStatus face_open(Face* face, const char* path, MienError* error) {
  face_close(face);
  MienStatus status = open_rig(face, path, error);
  if (status == MIEN_OK) status = make_instances(face, error);
  if (status != MIEN_OK) face_close(face);
  return status;
}

MienStatus face_open_bytes(Face* face, const void* bytes, size_t size, MienError* error) {
  face_close(face);
  MienBakedDesc desc = mien_baked_desc_default();
  desc.file_access = MIEN_FILE_READ; /* a copy */
  MienStatus status = mien_baked_open_memory(bytes, size, &desc, &face->baked, error);
  if (status == MIEN_OK) status = use_baked(face, error);
  if (status == MIEN_OK) status = make_instances(face, error);
  if (status != MIEN_OK) face_close(face);
  return status;
}

MienStatus face_bake(const char* path, void** out_bytes, size_t* out_size, MienError* error) {
  Face face;
  memset(&face, 0, sizeof face);
  *out_bytes = NULL;
  *out_size = 0;
  MienStatus status = open_rig(&face, path, error);
  if (status == MIEN_OK)
    status = mien_bake_memory(face.rig, face.deformer, NULL, 0, out_size, error);
  if (status == MIEN_OK && !(*out_bytes = malloc(*out_size))) status = MIEN_ERROR_MEMORY;
  if (status == MIEN_OK)
    status = mien_bake_memory(face.rig, face.deformer, *out_bytes, *out_size, out_size, error);
  face_close(&face);
  if (status == MIEN_OK) return MIEN_OK;
  free(*out_bytes);
  *out_bytes = NULL;
  *out_size = 0;
  return status;
}

uint8_t face_set_control(Face* face, const char* name, double value) {
  uint32_t index = 0;
  MienMutableFloatView controls;
  if (!face->instance) return 0;
  if (mien_rig_find(face->rig, MIEN_KIND_RAW_CONTROL, name, &index) != MIEN_OK) return 0;
  if (mien_instance_raw_controls(face->instance, &controls) != MIEN_OK || index >= controls.count)
    return 0;
  controls.data[index] = (float)value;
  return 1;
}

uint8_t face_evaluate(Face* face, int64_t lod) {
  if (!face->instance || lod < 0 || lod > UINT32_MAX) return 0;
  if (mien_rig_evaluate(face->rig, face->instance, (uint32_t)lod) != MIEN_OK) return 0;
  return !face->pose || mien_deformer_instance_update(face->pose, face->instance) == MIEN_OK;
}

uint8_t face_read_transforms(Face* face) {
  const size_t count = (size_t)10 * face->joint_count;
  return face->pose &&
         mien_deformer_instance_local_transforms(face->pose, face->transforms, count) == MIEN_OK;
}

uint8_t face_deform(Face* face, const char* mesh, MienFloatView* out_view) {
  uint32_t index = 0;
  return face->pose && mien_rig_find(face->rig, MIEN_KIND_MESH, mesh, &index) == MIEN_OK &&
         mien_deformer_instance_deform(face->pose, index, MIEN_NORMALS_NONE, NULL) == MIEN_OK &&
         mien_deformer_instance_positions(face->pose, index, out_view) == MIEN_OK;
}

void face_name(const Face* face, uint32_t kind, uint32_t index, char* out_text, size_t capacity) {
  MienStringView name;
  out_text[0] = 0;
  if (mien_rig_name(face->rig, kind, index, &name) == MIEN_OK)
    snprintf(out_text, capacity, "%.*s", (int)name.count, name.data);
}
