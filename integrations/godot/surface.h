/* SPDX-License-Identifier: MIT
 * A mesh of a rig in a MeshInstance3D: vertices that Mien deforms, written into the vertex buffer of the RenderingServer. */
#ifndef MIEN_GODOT_SURFACE_H
#define MIEN_GODOT_SURFACE_H

#include "face.h"
#include "godot.h"

/* Zero is a surface that was never shown. */
typedef struct {
  uint64_t instance; /* of the MeshInstance3D that has the mesh; 0: none */
  GdVariant mesh;    /* an ArrayMesh of one surface */
  GdVariant rid;
  GdPackedArray bytes; /* [vertex] x y z as floats, then [vertex] the normal in 2 x 16 bits */
  float* normals;      /* 3 per vertex */
  uint32_t vertex_count;
} Surface;

/* Deforms a mesh as last evaluated, and shows it in a MeshInstance3D: as a new ArrayMesh the first time, by an update of
 * its vertex buffer from then on. Returns 0 without geometry or memory, or if this Godot lays out vertices otherwise. */
uint8_t surface_show(Surface* surface, Face* face, uint32_t mesh, GdObject mesh_instance);

/* The MeshInstance3D keeps the mesh. */
void surface_close(Surface* surface);

#endif
