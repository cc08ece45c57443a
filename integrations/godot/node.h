/* SPDX-License-Identifier: MIT
 * The state of a MienFace3D: a character, and the nodes of the scene that show it. */
#ifndef MIEN_GODOT_NODE_H
#define MIEN_GODOT_NODE_H

#include "face.h"
#include "godot.h"
#include "surface.h"

enum { SKELETON, MESH, TARGETS };

/* Indices of bones or blend shapes in an object of the scene, looked up once. -1: it has none of the name. */
typedef struct {
  uint64_t instance;
  int64_t* indices;
} Targets;

/* The properties of a rig's raw controls. */
typedef struct {
  uint32_t count;
  GdStringName* names;  /* controls/NAME */
  GdPropertyInfo* list; /* all properties of the class, these last */
} ControlProperties;

/* Zero, with nil for variants, is a node without a rig. */
typedef struct {
  GdObject object;
  Face face;
  Targets targets[TARGETS];
  Surface* surfaces; /* of each mesh of the rig, if it was shown */
  uint64_t* shown;   /* the MeshInstance3D below this node for each mesh of the rig; 0: none */
  uint32_t mesh_count;
  ControlProperties controls;
  GdVariant rig;            /* a MienRig, or nil */
  GdVariant paths[TARGETS]; /* NodePaths, or nil */
  int64_t lod;
  uint8_t shows_geometry, is_changed;
} Node;

/* Opens the file at a path of the file system. Returns a status, after an error message if it is not MIEN_OK. */
int64_t node_open(Node* node, const char* path);

/* Opens what `rig` has, or closes the face. */
void node_open_resource(Node* node);

/* Frees all but the variants. Meshes that the node made stay: Godot frees them with it. */
void node_close(Node* node);

/* Frees the meshes that the node made. */
void node_drop_geometry(Node* node);

/* The value of a raw control; NULL if there is none. */
float* node_control(Node* node, uint32_t control);

/* Drive other nodes as the face was evaluated last; `object` may be NULL. They return 0 if there is nothing to do. */
uint8_t node_drive_skeleton(Node* node, GdObject object);
uint8_t node_drive_mesh(Node* node, GdObject object);
uint8_t node_drive_vertices(Node* node, GdObject mesh_instance, const char* mesh);

/* Evaluates, and drives what the properties name. */
void node_show(Node* node);

/* The properties of the class that do not depend on the rig. */
enum { RIG, LOD, SKELETON_PATH, MESH_PATH, GEOMETRY, FIXED_PROPERTIES };
extern GdPropertyInfo node_fixed_properties[FIXED_PROPERTIES];
extern GdString node_control_hint;

#endif
