/* SPDX-License-Identifier: MIT */
#include "surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Numbers of Mesh.ArrayType, Mesh.PrimitiveType and Mesh.ArrayFormat. */
enum { ARRAY_NORMAL = 1, ARRAY_TEX_UV = 4, ARRAY_INDEX = 12, ARRAY_MAX = 13 };
enum { PRIMITIVE_TRIANGLES = 3, FLAG_USE_DYNAMIC_UPDATE = 1 << 26 };
enum { POSITION_SIZE = 12, NORMAL_SIZE = 4 };

void surface_close(Surface* surface) {
  if (surface->instance) {
    gd.variant_destroy(&surface->mesh);
    gd.variant_destroy(&surface->rid);
    gd.destroy[GD_PACKED_BYTES](&surface->bytes);
  }
  free(surface->normals);
  memset(surface, 0, sizeof *surface);
}

/* The neutral mesh as the arrays of Mesh.ArrayType. Godot counts v from the top of a texture. */
static GdVariant arrays_of(const MienDeformer* deformer, uint32_t index, const MienMesh* mesh) {
  const size_t count = mesh->vertex_count, corners = (size_t)3 * mesh->triangle_count;
  float* values = malloc(count * 3 * sizeof *values);
  uint32_t* triangles = malloc(corners * sizeof *triangles);
  GdVariant arrays = gd_empty(GD_ARRAY);
  if (!values || !triangles ||
      mien_deformer_triangles(deformer, index, triangles, corners) != MIEN_OK) {
    free(triangles);
    free(values);
    return arrays;
  }
  for (int kind = 0; kind < ARRAY_MAX; ++kind) {
    GdVariant array;
    if (kind == 0) {
      for (size_t v = 0; v < count; ++v) {
        memcpy(values + 3 * v,
               mesh->positions.data + (size_t)3 * mesh->vertex_position_indices.data[v],
               POSITION_SIZE);
      }
      array = gd_packed(GD_PACKED_VECTOR3, values, count, POSITION_SIZE);
    } else if (kind == ARRAY_NORMAL) {
      array = gd_packed(GD_PACKED_VECTOR3, mesh->normals.data, count, POSITION_SIZE);
    } else if (kind == ARRAY_TEX_UV) {
      const int has_uvs =
          mien_deformer_texture_coordinates(deformer, index, values, 2 * count) == MIEN_OK;
      for (size_t v = 0; has_uvs && v < count; ++v) values[2 * v + 1] = 1 - values[2 * v + 1];
      array = has_uvs ? gd_packed(GD_PACKED_VECTOR2, values, count, 2 * sizeof(float)) : gd_nil();
    } else if (kind == ARRAY_INDEX) {
      array = gd_packed(GD_PACKED_INT32, triangles, corners, 4);
    } else {
      array = gd_nil();
    }
    GdVariant nothing = gd_call(&arrays, &gd_names.append, &array, 1);
    gd.variant_destroy(&nothing);
  }
  free(triangles);
  free(values);
  return arrays;
}

/* Whether positions and normals lie where surface_show() writes them. */
static int has_known_layout(GdVariant* mesh, int64_t vertex_count) {
  GdVariant first = gd_int(0), server = gd_singleton(&gd_names.RenderingServer);
  const int64_t format = gd_call_int(mesh, &gd_names.surface_get_format, &first, 1);
  GdVariant offset[3] = {gd_int(format), gd_int(vertex_count), gd_int(ARRAY_NORMAL)};
  GdVariant stride[2] = {gd_int(format), gd_int(vertex_count)};
  const int is_known = gd_call_int(&server, &gd_names.mesh_surface_get_format_offset, offset, 3) ==
                           POSITION_SIZE * vertex_count &&
                       gd_call_int(&server, &gd_names.mesh_surface_get_format_normal_tangent_stride,
                                   stride, 2) == NORMAL_SIZE;
  gd.variant_destroy(&server);
  if (!is_known) gd.print_error("unknown layout of vertices", "MienFace3D", __FILE__, __LINE__, 0);
  return is_known;
}

static int open_surface(Surface* surface, const Face* face, uint32_t index, GdObject instance) {
  MienMesh mesh = mien_mesh_default();
  surface_close(surface);
  if (mien_deformer_mesh(face->deformer, index, &mesh) != MIEN_OK || mesh.vertex_count == 0 ||
      mesh.triangle_count == 0)
    return 0;
  const size_t count = mesh.vertex_count;
  surface->normals = malloc(count * 3 * sizeof *surface->normals);
  unsigned char* zeros = calloc(count, POSITION_SIZE + NORMAL_SIZE);
  if (!surface->normals || !zeros) {
    free(zeros);
    return 0;
  }
  GdVariant bytes = gd_packed(GD_PACKED_BYTES, zeros, count * (POSITION_SIZE + NORMAL_SIZE), 1);
  free(zeros);
  gd.to[GD_PACKED_BYTES](&surface->bytes, &bytes);
  const int64_t size = gd_call_int(&bytes, &gd_names.size, NULL, 0);
  gd.variant_destroy(&bytes);

  GdObject object = gd.classdb_construct_object(&gd_names.ArrayMesh);
  surface->mesh = gd_value(GD_OBJECT, &object);
  surface->rid = gd_call(&surface->mesh, &gd_names.get_rid, NULL, 0);
  surface->instance = gd.object_get_instance_id(instance);
  surface->vertex_count = mesh.vertex_count;
  GdVariant arguments[5] = {gd_int(PRIMITIVE_TRIANGLES), arrays_of(face->deformer, index, &mesh),
                            gd_empty(GD_ARRAY), gd_empty(GD_DICTIONARY),
                            gd_int(FLAG_USE_DYNAMIC_UPDATE)};
  GdVariant nothing = gd_call(&surface->mesh, &gd_names.add_surface_from_arrays, arguments, 5);
  gd.variant_destroy(&nothing);
  if (size != (int64_t)(count * (POSITION_SIZE + NORMAL_SIZE)) ||
      gd_call_int(&surface->mesh, &gd_names.get_surface_count, NULL, 0) != 1 ||
      !has_known_layout(&surface->mesh, (int64_t)count))
    return 0;
  GdVariant shown = gd_copy(&surface->mesh);
  nothing = gd_call_object(instance, &gd_names.set_mesh, &shown, 1);
  gd.variant_destroy(&nothing);
  return 1;
}

/* Octahedral coordinates, 16 bits each, as Vector3.octahedron_encode() has them. */
static void encode_normal(const float* normal, unsigned char* out) {
  const float sum = fabsf(normal[0]) + fabsf(normal[1]) + fabsf(normal[2]);
  const float scale = sum > 0 ? 1 / sum : 0;
  const float x = normal[0] * scale, y = normal[1] * scale;
  float at[2] = {x, y};
  if (normal[2] < 0) {
    at[0] = (1 - fabsf(y)) * (x >= 0 ? 1.f : -1.f);
    at[1] = (1 - fabsf(x)) * (y >= 0 ? 1.f : -1.f);
  }
  for (int k = 0; k < 2; ++k) {
    const float value = (at[k] * 0.5f + 0.5f) * 65535;
    const uint16_t bits = (uint16_t)(value > 0 ? value < 65535 ? value : 65535 : 0);
    memcpy(out + 2 * k, &bits, 2);
  }
}

uint8_t surface_show(Surface* surface, Face* face, uint32_t mesh, GdObject mesh_instance) {
  if (!face->pose || !mesh_instance) return 0;
  if (surface->instance != gd.object_get_instance_id(mesh_instance) &&
      !open_surface(surface, face, mesh, mesh_instance)) {
    surface_close(surface);
    return 0;
  }
  /* While the server still reads what it got last, this gives a copy. */
  unsigned char* bytes = gd.packed_byte_array_operator_index(&surface->bytes, 0);
  MienVertexOutput output = mien_vertex_output_default();
  output.vertex_capacity = surface->vertex_count;
  output.positions.data = bytes;
  output.positions.stride = POSITION_SIZE;
  output.normals.data = surface->normals;
  output.normals.stride = POSITION_SIZE;
  if (mien_deformer_instance_write_vertices(face->pose, mesh, MIEN_NORMALS_DEFAULT, &output,
                                            NULL) != MIEN_OK)
    return 0;
  unsigned char* normals = bytes + (size_t)POSITION_SIZE * surface->vertex_count;
  for (size_t v = 0; v < surface->vertex_count; ++v)
    encode_normal(surface->normals + 3 * v, normals + NORMAL_SIZE * v);
  GdVariant server = gd_singleton(&gd_names.RenderingServer);
  GdVariant arguments[4] = {gd_copy(&surface->rid), gd_int(0), gd_int(0),
                            gd_value(GD_PACKED_BYTES, &surface->bytes)};
  GdVariant nothing = gd_call(&server, &gd_names.mesh_surface_update_vertex_region, arguments, 4);
  gd.variant_destroy(&nothing);
  gd.variant_destroy(&server);
  return 1;
}
