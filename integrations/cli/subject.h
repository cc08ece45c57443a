// SPDX-License-Identifier: MIT
// What a picture shows: the meshes of one LOD of a rig, in a pose.
#pragma once

#include <string>
#include <vector>

#include "integrations/cli/frames.h"
#include "integrations/cli/looks.h"
#include "integrations/cli/rig_file.h"
#include "integrations/picture/camera.h"
#include "integrations/picture/render.h"

namespace mien::cli {

using Deformer = std::unique_ptr<MienDeformer, Destroy<MienDeformer, mien_deformer_destroy>>;
using Pose = std::unique_ptr<MienDeformerInstance,
                             Destroy<MienDeformerInstance, mien_deformer_instance_destroy>>;

struct ShownMesh {
  uint32_t mesh;
  std::string name;
  MeshKind kind;
  MienMesh neutral;
  std::vector<uint8_t> colors;       // r g b of each position; or none
  std::vector<uint8_t> inner_edges;  // of each triangle, for wireframes
};

struct SubjectOptions {
  std::string rig, lod = "0", meshes;
  bool wireframe = false;
  bool geometry_optional = false;  // a rig without meshes is good too
};

struct Subject {
  RigFile file;
  Rig rig;
  Deformer deformer;  // null, as is the pose, without geometry
  Instance instance;
  Pose pose;
  uint32_t lod = 0;  // as the file counts; it is the only one that is loaded
  std::vector<ShownMesh> meshes;
  picture::Stand stand;

  std::string unit() const;
  /// Positions of a mesh in the last pose.
  const float* positions(const ShownMesh& mesh) const;
  std::vector<picture::Surface> surfaces() const;
  std::vector<picture::Vec3> neutral_points() const;
  picture::Box neutral_box() const;
};

/// --lod, --meshes
void add_subject_options(CLI::App& app, SubjectOptions& options);

/// Opens the rig, loads one LOD of it and takes the meshes that can be shown: those that match
/// `meshes`, or all that do not cover the face. Fails if there are none.
Subject open_subject(const SubjectOptions& options, const Session& session);

/// Brings controls into the state of a frame, evaluates and deforms.
void pose_subject(Subject& subject, const Frame& frame);

/// Points around the face, the eyes, the mouth, or meshes or joints of that pattern, in neutral; of
/// everything if `target` is empty.
std::vector<picture::Vec3> find_target(const Subject& subject, const std::string& target);

/// True if it shows where the face is: there are eyes and a mouth.
bool has_face(const Subject& subject);

}  // namespace mien::cli
