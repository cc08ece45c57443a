// SPDX-License-Identifier: MIT
#include "integrations/program/commands/exported_rig.h"

#include <algorithm>
#include <cstdio>

#include "integrations/program/gltf/glb_writer.h"
#include "integrations/program/io/dna_fields.h"
#include "integrations/program/io/text.h"
#include "integrations/program/io/texture_folder.h"

namespace mien::cli {

namespace {

constexpr const char* kCannotOpenExport = "cannot export";

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.2g %%", share * 100);
  return text;
}

std::string millimeters(double meters) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.2g mm", meters * 1000);
  return text;
}

}  // namespace

const char* GlbOptions::named() const {
  return !influences.empty() ? "--influences"
         : exact             ? "--exact"
         : quantize          ? "--quantize"
         : no_quantize       ? "--no-quantize"
         : no_uvs            ? "--no-uvs"
         : no_morph_normals  ? "--no-morph-normals"
                             : nullptr;
}

void add_glb_options(CLI::App& command, GlbOptions& options, const std::string& group) {
  command
      .add_option("--influences", options.influences,
                  "Joints per vertex: 1, 2, 4 (default), 8 or 12. Where the rig has more, weights\n"
                  "are fitted to its expressions; the error is printed")
      ->type_name("N")
      ->group(group);
  CLI::Option* exact =
      command
          .add_flag("--exact", options.exact,
                    "Keep motion too small to see; weights and texture coordinates as floats")
          ->group(group);
  command
      .add_flag("--quantize", options.quantize,
                "About half the size: integers of 8 and 16 bits (KHR_mesh_quantization)")
      ->excludes(exact)
      ->group(group);
  command
      .add_flag("--no-quantize", options.no_quantize,
                "Do not use that extension. It is the default for a baked GLB, where it moves\n"
                "vertices by a hundred-thousandth of the size at most")
      ->excludes("--quantize")
      ->group(group);
  command.add_flag("--no-uvs", options.no_uvs, "No texture coordinates")->group(group);
  command
      .add_flag("--no-morph-normals", options.no_morph_normals,
                "Targets move positions only; viewers keep the normals as they are")
      ->group(group);
}

void check_glb_options(const GlbOptions& options) {
  if (!options.influences.empty()) parse_word("--influences", options.influences);
}

ExportedRig::ExportedRig(const std::string& path, const std::string& lod, const Session& session) {
  auto desc = sized<MienDnaDesc>();
  desc.layers = kEvaluationLayers | MIEN_LAYER_GEOMETRY;
  if (lod != "all") {
    first_lod = parse_lod(lod, true);
    desc.lods = uint64_t{1} << first_lod;
  }
  file = open_rig_file(path, desc, session);
  materials = read_materials_beside(path);
  // Plain C++ rounds alike on every machine, and so the files are the same.
  auto rig_desc = sized<MienRigDesc>();
  rig_desc.isa = MIEN_ISA_SCALAR;
  rig = create_rig(file, rig_desc);

  auto error = sized<MienError>();
  MienDeformer* deformer_made = nullptr;
  check(mien_deformer_create(file.dna.get(), rig.get(), nullptr, &deformer_made, &error), &error,
        "cannot prepare geometry", file.shown);
  deformer.reset(deformer_made);
  MienInstance* instance_made = nullptr;
  check(mien_instance_create(rig.get(), nullptr, &instance_made, &error), &error,
        "cannot prepare rig", file.shown);
  instance.reset(instance_made);
  source = std::make_unique<gltf::RigSource>(
      gltf::RigHandles{file.dna.get(), rig.get(), deformer.get()});
  pose = gltf::make_deformer_instance(*source);
}

void ExportedRig::apply(const Frame& frame) {
  check(mien_instance_reset(instance.get()), nullptr, kCannotOpenExport, file.shown);
  apply_frame(frame, rig.get(), instance.get());
  check(mien_rig_evaluate(rig.get(), instance.get(), 0), nullptr, kCannotOpenExport, file.shown);
  check(mien_deformer_instance_update(pose.get(), instance.get()), nullptr, kCannotOpenExport,
        file.shown);
  head_turned = frame.head.turned();
  if (!head_turned) return;
  if (!head) head = std::make_unique<HeadTurn>(rig.get(), deformer.get(), file.shown);
  head->apply(pose.get(), frame.head);
}

std::vector<float> ExportedRig::local_transforms() const {
  if (head_turned) {
    const MienFloatView turned = head->transforms();
    return std::vector<float>(turned.data, turned.data + turned.count);
  }
  std::vector<float> values(size_t{10} * rig_count(rig.get(), MIEN_KIND_JOINT));
  check(mien_deformer_instance_local_transforms(pose.get(), values.data(), values.size()), nullptr,
        kCannotOpenExport, file.shown);
  return values;
}

MienFloatView ExportedRig::channel_weights() const {
  MienFloatView view{};
  check(mien_instance_blend_shapes(instance.get(), &view), nullptr, kCannotOpenExport, file.shown);
  return view;
}

MienFloatView ExportedRig::raw_controls() const {
  MienFloatView view{};
  check(mien_instance_controls(instance.get(), &view), nullptr, kCannotOpenExport, file.shown);
  return view;
}

gltf::SceneOptions ExportedRig::scene_options(const GlbOptions& options) const {
  gltf::SceneOptions scene;
  scene.name = read_string(file, "desc.name");
  if (scene.name.empty()) scene.name = "rig";
  scene.first_lod = first_lod;
  scene.exact = options.exact;
  if (!options.influences.empty()) {
    parse_word("--influences", options.influences);
    scene.influences = static_cast<uint32_t>(std::stoul(options.influences));
  }
  return scene;
}

void note_color_problems(const ExportedRig& face, const Session& session) {
  for (const std::string& problem : face.source->color_problems()) {
    note(session, face.file.shown + ": " + problem + "; exporting without these colors");
  }
}

namespace {

void note_skin_and_meshes(const std::string& shown, const gltf::Losses& losses,
                          const Session& session) {
  if (losses.corrected_positions != 0) {
    note(session, shown + ": skin weights of " + std::to_string(losses.corrected_positions) +
                      " positions do not sum to 1 or are negative, which glTF forbids; they were "
                      "corrected, by up to " +
                      percent(losses.max_correction));
  }
  for (const std::string& mesh : losses.empty_meshes) {
    note(session, shown + ": mesh " + one_line(mesh) + " has no faces: left out");
  }
}

}  // namespace

void note_baked_losses(const ExportedRig& face, const gltf::Losses& losses,
                       const Session& session) {
  if (losses.crowded_positions != 0) {
    note(session, face.file.shown + ": " + std::to_string(losses.crowded_positions) + " of " +
                      std::to_string(losses.positions) + " positions follow more than " +
                      std::to_string(losses.places) +
                      " bones, of which the heaviest stay: off by " +
                      millimeters(losses.skin.residual.max) +
                      " at most when one of them turns by 10 degrees");
  }
  note_skin_and_meshes(face.file.shown, losses, session);
}

void note_losses(const ExportedRig& face, const gltf::Losses& losses, const Session& session) {
  const std::string& shown = face.file.shown;
  if (losses.crowded_positions != 0) {
    const gltf::Residual& off = losses.skin.residual;
    std::string text = shown + ": " + std::to_string(losses.crowded_positions) + " of " +
                       std::to_string(losses.positions) + " positions follow more than " +
                       std::to_string(losses.places) +
                       " joints; their weights were fitted to the rig's expressions: off by " +
                       millimeters(off.rms) + " rms, " + millimeters(off.max) + " at most";
    if (!losses.skin.expression.empty()) text += ", with " + one_line(losses.skin.expression);
    if (losses.places == 4) {
      text +=
          ". --influences 8 is for programs that read more than four joints, as Blender does "
          "and three.js does not";
    }
    note(session, text);
  }
  note_skin_and_meshes(shown, losses, session);
}

gltf::RigScene neutral_rig_scene(ExportedRig& face, const GlbOptions& options,
                                 const Session& session) {
  gltf::SceneOptions scene_options = face.scene_options(options);
  gltf::RigScene scene;
  {
    Progress progress(session, "fitting skin weights", 1);
    scene_options.progress = [&](double share) { progress.at_share(share); };
    scene = gltf::make_rig_scene(*face.source, scene_options);
  }
  note_losses(face, scene.losses, session);
  return scene;
}

void animate_scene(ExportedRig& face, const Frame& still, const std::vector<Frame>& frames,
                   double rate, const Session& session, gltf::RigScene& scene) {
  face.apply(still);
  gltf::set_pose(scene, *face.source, face.pose.get(), face.channel_weights());
  if (frames.empty()) return;
  gltf::AnimationRecorder recorder(scene, *face.source, "frames", rate);
  Progress progress(session, "frame", frames.size());
  for (size_t f = 0; f < frames.size(); ++f) {
    progress.at(f);
    face.apply(frames[f]);
    recorder.add_frame(face.local_transforms(), face.channel_weights());
  }
  scene.scene.animation = recorder.finish();
}

gltf::RigScene rig_scene(ExportedRig& face, const Frame& still, const std::vector<Frame>& frames,
                         double rate, const GlbOptions& options, const Session& session) {
  gltf::RigScene scene = neutral_rig_scene(face, options, session);
  animate_scene(face, still, frames, rate, session, scene);
  return scene;
}

Materials materials_of(const ExportedRig& face, const std::string& texture_folder,
                       const std::vector<std::string>& meshes, const Session& session) {
  Materials materials = face.materials;
  if (texture_folder.empty()) return materials;
  const TextureFolder found = add_texture_folder(texture_folder, meshes, materials);
  std::string list;
  for (const std::string& name : found.unused) list += (list.empty() ? "" : ", ") + one_line(name);
  if (found.used == 0) {
    fail(kInvalid, kCannotOpenExport, one_line(texture_folder),
         found.unused.empty() ? "there are no PNG or JPEG files in it"
                              : "no file in it is named as a texture of a mesh: " + list,
         "name them by mesh or material and kind: head_basecolor.png, teeth_normal.png, "
         "skin_roughness.png");
  }
  if (!list.empty()) {
    note(session, one_line(texture_folder) + ": no mesh takes the textures " + list);
  }
  return materials;
}

void add_materials(const ExportedRig& face, const std::string& texture_folder,
                   const gltf::ImageOptions& options, gltf::Scene& scene, const Session& session) {
  std::vector<std::string> meshes;
  for (const gltf::Mesh& mesh : scene.meshes) meshes.push_back(mesh.name);
  const Materials materials = materials_of(face, texture_folder, meshes, session);
  if (materials.list.empty()) return;
  for (const std::string& mesh : apply_materials(materials, options, scene)) {
    note(session, face.file.shown + ": mesh " + one_line(mesh) +
                      " has no texture coordinates, so it gets no textures");
  }
}

std::string rig_glb(ExportedRig& face, const Frame& still, const std::vector<Frame>& frames,
                    double rate, const GlbOptions& options, const Session& session) {
  gltf::RigScene scene = rig_scene(face, still, frames, rate, options, session);
  apply_options(scene.scene, options);
  add_materials(face, "", {}, scene.scene, session);
  return glb_bytes(scene.scene, options);
}

void apply_options(gltf::Scene& scene, const GlbOptions& options) {
  for (gltf::Mesh& mesh : scene.meshes) {
    if (options.no_uvs) mesh.uvs.clear();
    if (!options.no_morph_normals) continue;
    for (gltf::MorphTarget& target : mesh.targets) {
      target.normals.clear();
      target.normal_vertices.clear();
    }
  }
}

std::string glb_bytes(gltf::Scene& scene, const GlbOptions& options, const gltf::Vrm* vrm) {
  apply_options(scene, options);
  return gltf::write_glb(scene,
                         options.quantize ? gltf::Encoding::kQuantized
                         : options.exact  ? gltf::Encoding::kFloat
                                          : gltf::Encoding::kShares,
                         vrm);
}

void fail_export(const gltf::ExportError& error, const std::string& rig) {
  const std::string where = error.where.empty() ? "" : ", " + one_line(error.where);
  fail(exit_code_of(error.status), kCannotOpenExport, shown_name(rig) + where, error.what(),
       error.what_to_do);
}

}  // namespace mien::cli
