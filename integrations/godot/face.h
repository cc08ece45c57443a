/* SPDX-License-Identifier: MIT
 * One character, without a word about Godot: what the classes for Godot 4 and Godot 3 share. */
#ifndef MIEN_GODOT_FACE_H
#define MIEN_GODOT_FACE_H

#include <mien.h>

/* Zero is a closed face. */
typedef struct {
  MienBaked* baked; /* or the file was DNA */
  MienRig* rig;
  MienDeformer* deformer; /* NULL without geometry */
  MienInstance* instance;
  MienDeformerInstance* pose;
  float* transforms; /* [joint][10]: translation, quaternion x y z w, scale; or NULL */
  uint32_t joint_count, channel_count;
} Face;

/* Opens a file, which is told by its name: in either case: of "*.dna" the DNA and of "*.uasset" the first DNA in it, both in the axes and
 * units of Godot; any other is a baked file. What was open is closed, also on failure. `error` is required. */
MienStatus face_open(Face* face, const char* path, MienError* error);

/* The same from the bytes of a baked file, which are copied. */
MienStatus face_open_bytes(Face* face, const void* bytes, size_t size, MienError* error);

void face_close(Face* face);

/* Bakes a file with its geometry, opened as by face_open(); a baked file is checked and read as it is. Free `out_bytes`
 * with free(). */
MienStatus face_bake(const char* path, void** out_bytes, size_t* out_size, MienError* error);

/* Sets a raw control by its name. Returns 0 if there is none. */
uint8_t face_set_control(Face* face, const char* name, double value);

/* Evaluates a LOD. Returns 0 if there is none. */
uint8_t face_evaluate(Face* face, int64_t lod);

/* Fills `transforms` with the joints relative to their parents. Returns 0 without geometry. */
uint8_t face_read_transforms(Face* face);

/* Deforms a mesh, and returns x y z of its positions in `out_view`, which is valid until the next call for this mesh.
 * Returns 0 if there is none. */
uint8_t face_deform(Face* face, const char* mesh, MienFloatView* out_view);

/* The name of a joint or another thing of the rig, cut at `capacity` - 1 bytes. Empty if there is none. */
void face_name(const Face* face, uint32_t kind, uint32_t index, char* out_text, size_t capacity);

#endif
