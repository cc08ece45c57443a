// SPDX-License-Identifier: MIT
// A rig that goes into a GLB or OBJ file, and the character that is posed for it.
#pragma once

#include "integrations/program/commands/options.h"
#include "integrations/program/gltf/rig_scene.h"
#include "integrations/program/gltf/scene_materials.h"
#include "integrations/program/io/frames.h"
#include "integrations/program/scene/head_turn.h"

namespace mien::gltf {
struct Vrm;
}

namespace mien::cli {

/// Options of commands that write GLB files.
struct GlbOptions {
  std::string influences;  // 1, 2, 4, 8, 12 or empty
  bool exact = false, quantize = false, no_quantize = false, no_uvs = false,
       no_morph_normals = false;

  /// One of them that was given, or null.
  const char* named() const;
};

void add_glb_options(CLI::App& command, GlbOptions& options, const std::string& group = "Options");
/// Fails on wrong words.
void check_glb_options(const GlbOptions& options);

/// Opened with the LODs to export.
class ExportedRig {
 public:
  /// `lod` is a number or "all".
  ExportedRig(const std::string& path, const std::string& lod, const Session& session);

  /// Evaluates a frame at the finest LOD, and the pose with it.
  void apply(const Frame& frame);
  /// Ten floats per joint, as mien_deformer_instance_local_transforms() gives them.
  std::vector<float> local_transforms() const;

  MienFloatView channel_weights() const;
  MienFloatView raw_controls() const;
  gltf::SceneOptions scene_options(const GlbOptions& options) const;

  uint32_t first_lod = 0;
  RigFile file;
  Materials materials;  // of the file beside it
  Rig rig;
  Deformer deformer;
  Instance instance;
  std::unique_ptr<gltf::RigSource> source;
  DeformerInstance pose;
  std::unique_ptr<HeadTurn> head;  // null until a frame turns it
  bool head_turned = false;        // by the last frame
};

/// Notes for people: colors that are left out, and what glTF has no place for.
void note_color_problems(const ExportedRig& face, const Session& session);
void note_losses(const ExportedRig& face, const gltf::Losses& losses, const Session& session);
/// The same of a baked face, whose vertices follow few bones.
void note_baked_losses(const ExportedRig& face, const gltf::Losses& losses, const Session& session);

/// Skeleton, skin and morph targets in the neutral pose. Throws gltf::ExportError.
gltf::RigScene neutral_rig_scene(ExportedRig& face, const GlbOptions& options,
                                 const Session& session);
/// Puts that scene of the rig into the pose `still`, with `frames` as an animation, if there are any.
void animate_scene(ExportedRig& face, const Frame& still, const std::vector<Frame>& frames,
                   double rate, const Session& session, gltf::RigScene& scene);

/// Skeleton, skin and morph targets, in the pose `still`, with `frames` as an animation, if there are any.
/// Throws gltf::ExportError.
gltf::RigScene rig_scene(ExportedRig& face, const Frame& still, const std::vector<Frame>& frames,
                         double rate, const GlbOptions& options, const Session& session);

/// Materials of the file beside the rig, and textures of a folder if one is named; notes tell what has no use.
void add_materials(const ExportedRig& face, const std::string& texture_folder,
                   const gltf::ImageOptions& options, gltf::Scene& scene, const Session& session);
/// The same for an OBJ file.
Materials materials_of(const ExportedRig& face, const std::string& texture_folder,
                       const std::vector<std::string>& meshes, const Session& session);

/// The same as a GLB, with textures embedded.
std::string rig_glb(ExportedRig& face, const Frame& still, const std::vector<Frame>& frames,
                    double rate, const GlbOptions& options, const Session& session);

/// Leaves of a scene what the options say.
void apply_options(gltf::Scene& scene, const GlbOptions& options);

/// A GLB, or a VRM if `vrm` is not null, of what the options leave of a scene.
std::string glb_bytes(gltf::Scene& scene, const GlbOptions& options,
                      const gltf::Vrm* vrm = nullptr);

/// "cannot export" with the exit code of what was wrong.
[[noreturn]] void fail_export(const gltf::ExportError& error, const std::string& rig);

}  // namespace mien::cli
