// SPDX-License-Identifier: MIT
// TARGET of `mien solve`: files of every kind, as rows of numbers that a fit matches.
#pragma once

#include <mien_solve.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "integrations/program/commands/options.h"
#include "integrations/program/io/baked_file.h"
#include "integrations/program/io/frame_rate.h"

namespace mien::cli {

/// A rig with its meshes, from a DNA file or a baked file.
struct SolvedRig {
  std::string shown;
  std::optional<RigFile> file;
  std::optional<BakedFile> baked;
  Rig own_rig;
  Deformer own_deformer;
  const MienRig* rig = nullptr;
  const MienDeformer* deformer = nullptr;  // null without geometry
};
/// `geometry`: fails without it, otherwise it is left out.
SolvedRig open_solved_rig(const std::string& path, bool geometry, const Session& session);

/// A mesh by its name; the first mesh of LOD 0 if that is empty. Fails with kInvalid.
uint32_t find_mesh(const SolvedRig& rig, const std::string& name);

MienMesh mesh_of(const SolvedRig& rig, uint32_t mesh);

using FitSurface =
    std::unique_ptr<MienFitSurface, Destroy<MienFitSurface, mien_fit_surface_destroy>>;

using Fit = std::unique_ptr<MienFit, Destroy<MienFit, mien_fit_destroy>>;

/// Joint values of a joint: 9, or 10 with quaternions.
uint32_t joint_width(const SolvedRig& rig);

/// Of what mien_fit_observability() gives; rounding is below.
constexpr float kUnobservable = 1e-5f;

/// A number from 0 on; 0 if the word is empty. Wrong usage for anything else.
float parse_weight(const char* option, const std::string& word);

/// In the order of the words of --kind.
enum class TargetKind { kVertices, kJoints, kLandmarks3, kLandmarks2, kWeights, kSurface };

struct TargetOptions {
  std::string path, kind, from, mesh, landmarks, mask, unit;
};

/// .npy or .npz.
bool is_array_file(const std::string& path);

/// A word of --kind.
const char* kind_word(TargetKind kind);

/// KIND:FILE becomes what --kind and the file say.
void split_kind(TargetOptions& options);

/// The kind that is named, or that the file tells.
TargetKind find_kind(const TargetOptions& options);

/// Triangles in the unit and axes of the rig.
struct SurfaceMesh {
  std::vector<float> positions;     // x y z each
  std::vector<uint32_t> triangles;  // three positions each
  std::string shown;                // its file
};

struct SolveTarget {
  TargetKind kind = TargetKind::kVertices;
  size_t frame_count = 0;
  size_t width =
      0;  // numbers of a frame: joint values, or 3 (2 in images) for each point; 0: surfaces
  std::vector<std::string> frame_names;  // where frames are shapes; else empty
  std::vector<MienSolvePoint> points;    // empty: joints
  std::vector<std::string> point_names;  // of landmarks; else empty
  // Of each point or joint value: 0 for what has a target in no frame, or as --mask says. Empty: 1.
  std::vector<float> weights;
  std::vector<float> point_offsets;     // MienFitFrame.point_offsets of another person; else empty
  std::optional<MienFitCamera> camera;  // of images
  Rate rate;                            // unknown if the file has none
  /// Writes the numbers of a frame. Missing ones are NaN.
  std::function<void(size_t frame, float* row)> read;
  std::function<SurfaceMesh(size_t frame)> read_surface;  // of kSurface
};

FitSurface create_surface(const SurfaceMesh& mesh);

/// The mesh that most points are on.
uint32_t main_mesh(const SolveTarget& target);

/// Fails with kInvalid if the file does not fit the rig.
SolveTarget open_target(const TargetOptions& options, TargetKind kind, const SolvedRig& rig,
                        const Session& session);

}  // namespace mien::cli
