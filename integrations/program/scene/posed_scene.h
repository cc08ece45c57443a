// SPDX-License-Identifier: MIT
// A rig in a pose: the meshes of one LOD, deformed, with what the renderer needs to draw them.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "integrations/program/io/baked_file.h"
#include "integrations/program/io/frames.h"
#include "integrations/program/io/materials.h"
#include "integrations/program/io/mesh_appearance.h"
#include "integrations/program/io/rig_file.h"
#include "integrations/program/math/vector.h"
#include "integrations/program/render/camera.h"
#include "integrations/program/render/render.h"
#include "integrations/program/render/texture.h"
#include "integrations/program/scene/head_turn.h"

namespace mien::cli {

struct SceneMesh {
  uint32_t mesh;  // in the rig
  std::string name;
  MeshClass mesh_class;
  MienMesh neutral;
  std::vector<uint32_t> triangles;         // three vertices each
  std::vector<float> texture_coordinates;  // u v of each vertex
  std::vector<uint8_t> colors;             // r g b of each position, or empty
  std::vector<uint8_t> inner_edges;        // of each triangle, for wireframes
  render::Material material;
  render::Cornea cornea;
  std::array<const render::Texture*, kTextureKinds> textures;  // of the scene; null: none
};

struct PosedSceneOptions {
  std::string rig;     // DNA file or baked file: path, or "-"
  uint32_t lod = 0;    // 0..kLastMaskLod
  std::string meshes;  // pattern; empty: all meshes that look right without textures
  bool wireframe = false;
  bool geometry_optional = false;  // accept a rig without meshes
  bool whole_rig = false;          // load all LODs, so that indices are those of the file
  bool no_geometry = false;        // load none; also optional then
  uint32_t isa = MIEN_ISA_BEST;
};

struct PosedScene {
  std::string shown;  // path, or "standard input"
  RigFile file;       // without a DNA if the rig comes from a baked file
  Baked baked;        // null if it comes from a DNA file
  Rig rig;
  MienRigInfo info;
  Instance instance;
  Deformer deformer;  // null without geometry, as is the next
  DeformerInstance pose;
  std::unique_ptr<HeadTurn> head;  // null until a frame turns it
  uint32_t lod = 0;                // as the file counts
  uint32_t rig_lod = 0;  // as the rig counts: of a DNA file, usually no other LOD is loaded
  std::vector<SceneMesh> meshes;
  render::Axes axes;
  Materials materials;                                               // of the file beside the rig
  std::map<std::string, std::unique_ptr<render::Texture>> textures;  // by path; null: not drawn

  std::string unit() const;
  /// Positions of a mesh in the current pose.
  const float* positions(const SceneMesh& mesh) const;
  std::vector<render::Surface> surfaces() const;
  std::vector<math::Vec3> neutral_points() const;
  math::Box neutral_box() const;
};

/// Opens the rig, loads one LOD of it and chooses its meshes. Fails if there are none, unless
/// geometry is optional. Baked files have neither vertex colors nor faces of more than three corners:
/// meshes get a material by their names, and wireframes show triangles.
PosedScene open_scene(const PosedSceneOptions& options, const Session& session);

/// LOD 0 of a DNA that is open, with all meshes that look right without textures.
PosedScene open_scene(RigFile file, const Session& session);

/// Another LOD of a scene that was opened from a DNA that has it.
void show_lod(PosedScene& scene, uint32_t lod, const Session& session);

/// Sets the controls of a frame, evaluates and deforms.
void pose_scene(PosedScene& scene, const Frame& frame);

/// Deforms by the results of an evaluated instance of the rig. Does nothing without geometry.
void deform_scene(PosedScene& scene, const MienInstance* instance, const HeadPose& head = {});

}  // namespace mien::cli
