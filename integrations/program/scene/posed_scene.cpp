// SPDX-License-Identifier: MIT
#include "integrations/program/scene/posed_scene.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "integrations/program/io/controls.h"
#include "integrations/program/io/dna_fields.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/text.h"
#include "integrations/program/scene/mesh_material.h"

namespace mien::cli {

namespace {

using math::Vec3;

constexpr const char* kCannot = "cannot draw";

/// Which edges of the triangles are not edges of faces. The deformer makes each face a fan about its
/// first corner, in file order; faces of fewer than three corners have no triangles.
std::vector<uint8_t> find_inner_edges(const RigFile& file, uint32_t mesh, size_t triangle_count) {
  const std::string faces = element("geom.meshes", mesh, ".faces");
  const uint64_t face_count = field_count(file, faces);
  std::vector<uint8_t> inner;
  inner.reserve(triangle_count);
  for (uint64_t face = 0; face < face_count; ++face) {
    const uint64_t corners = field_count(file, element(faces, face, ".layoutIndices"));
    for (uint64_t k = 2; k < corners; ++k) {
      // Edge 0 leaves the first corner, edge 2 comes back to it.
      inner.push_back(static_cast<uint8_t>((k > 2 ? 1 : 0) | (k + 1 < corners ? 4 : 0)));
    }
  }
  inner.resize(triangle_count);
  return inner;
}

/// Null for JPEG, which is not drawn; a note says so, once for each file.
const render::Texture* find_texture(PosedScene& scene, const std::string& path,
                                    const Session& session) {
  if (path.empty()) return nullptr;
  const auto [found, is_new] = scene.textures.try_emplace(path);
  if (!is_new) return found->second.get();
  const TextureFile file = read_texture(path);
  if (!file.is_png) {
    note(session, one_line(path) + ": JPEG textures are not drawn; convert it to PNG");
    return nullptr;
  }
  try {
    std::vector<uint8_t> alpha;
    render::Image image = render::read_png(file.bytes, alpha);
    found->second = std::make_unique<render::Texture>(std::move(image), std::move(alpha));
  } catch (const std::runtime_error& error) {
    fail(kInvalid, "cannot read texture", one_line(path), error.what(), "write the image again");
  }
  return found->second.get();
}

/// Material and textures of the file beside the rig.
void take_material(PosedScene& scene, SceneMesh& mesh, const Session& session) {
  mesh.material = mesh_material(mesh.mesh_class);
  const SurfaceMaterial* from = scene.materials.find(mesh.name);
  if (!from) return;
  if (!mesh.texture_coordinates.empty()) {
    for (size_t k = 0; k < kTextureKinds; ++k) {
      mesh.textures[k] = find_texture(scene, from->textures[k], session);
    }
  }
  const bool has_image = mesh.textures[size_t(TextureKind::kBaseColor)] != nullptr;
  if (from->has_color || has_image) {
    const auto& c = from->color;
    mesh.material.color = render::to_srgb({float(c[0]), float(c[1]), float(c[2])});
    mesh.material.alpha = std::min(std::max(float(c[3]), 0.0f), 1.0f);
    // A plain color would take the iris from an eye.
    if (has_image || mesh.mesh_class != MeshClass::kEye) mesh.colors.clear();
  }
  mesh.cornea = {float(from->cornea_depth), float(from->cornea_iris)};
  if (from->has_roughness) mesh.material.roughness = std::max(float(from->roughness), 0.05f);
}

SceneMesh make_mesh(PosedScene& scene, uint32_t mesh, const std::string& name,
                    const PosedSceneOptions& options, const Session& session) {
  SceneMesh made{};
  made.mesh = mesh;
  made.name = name;
  made.mesh_class = mesh_class(name);
  made.neutral = sized<MienMesh>();
  check(mien_deformer_mesh(scene.deformer.get(), mesh, &made.neutral), nullptr, kCannot,
        scene.shown);
  made.triangles.resize(size_t{3} * made.neutral.triangle_count);
  made.texture_coordinates.resize(size_t{2} * made.neutral.vertex_count);
  check(mien_deformer_triangles(scene.deformer.get(), mesh, made.triangles.data(),
                                made.triangles.size()),
        nullptr, kCannot, scene.shown);
  check(
      mien_deformer_texture_coordinates(scene.deformer.get(), mesh, made.texture_coordinates.data(),
                                        made.texture_coordinates.size()),
      nullptr, kCannot, scene.shown);
  const uint32_t positions = made.neutral.position_count;
  if (scene.file.dna) {
    VertexColors colors = read_vertex_colors(scene.file.dna.get(), name, positions);
    if (!colors.problem.empty()) {
      note(session, scene.shown + ": " + colors.problem + "; drawing without these colors");
    }
    made.colors = std::move(colors.rgb);
  }
  if (made.colors.empty() && made.mesh_class == MeshClass::kEye) {
    made.colors = paint_eye(made.neutral.positions.data, positions, scene.axes.front);
  }
  take_material(scene, made, session);
  if (options.wireframe && scene.file.dna) {
    made.inner_edges = find_inner_edges(scene.file, mesh, made.neutral.triangle_count);
  }
  return made;
}

void choose_meshes(PosedScene& scene, const PosedSceneOptions& options, const Session& session) {
  MienIndex16View indices{};
  check(mien_rig_lod_indices(scene.rig.get(), MIEN_KIND_MESH, scene.rig_lod, &indices), nullptr,
        kCannot, scene.shown);
  NearestName nearest(options.meshes);
  bool any = false;
  for (size_t i = 0; i < indices.count; ++i) {
    const uint32_t index = indices.data[i];
    const std::string name = rig_name(scene.rig.get(), MIEN_KIND_MESH, index);
    const SceneMesh mesh = make_mesh(scene, index, name, options, session);
    if (mesh.neutral.triangle_count == 0) continue;
    any = true;
    nearest.offer(name);
    const bool chosen = options.meshes.empty()
                            ? !mesh.colors.empty() || !needs_textures(mesh.mesh_class) ||
                                  mesh.textures[size_t(TextureKind::kBaseColor)] != nullptr
                            : matches_pattern(options.meshes, name);
    if (chosen) scene.meshes.push_back(mesh);
  }
  if (!scene.meshes.empty()) return;
  const std::string lod = "LOD " + std::to_string(scene.lod);
  if (!any && options.geometry_optional) return;
  if (!any) {
    fail(kInvalid, kCannot, scene.shown, "no mesh of " + lod + " has faces",
         "give a rig with geometry, or another --lod; see 'mien info'");
  }
  if (options.meshes.empty()) {
    fail(kInvalid, kCannot, scene.shown,
         "all meshes of " + lod + " need textures, such as shells of eyes",
         "choose some with --meshes");
  }
  fail(kInvalid, kCannot, scene.shown, "no mesh of " + lod + " matches \"" + options.meshes + "\"",
       nearest.question("'mien info RIG --names meshes' lists the names"));
}

}  // namespace

std::string PosedScene::unit() const {
  return info.translation_unit == MIEN_TRANSLATION_UNIT_METERS ? "m" : "cm";
}

const float* PosedScene::positions(const SceneMesh& mesh) const {
  MienFloatView view{};
  check(mien_deformer_instance_positions(pose.get(), mesh.mesh, &view), nullptr, kCannot, shown);
  return view.data;
}

std::vector<render::Surface> PosedScene::surfaces() const {
  std::vector<render::Surface> surfaces;
  for (const SceneMesh& mesh : meshes) {
    MienFloatView normals{};
    check(mien_deformer_instance_normals(pose.get(), mesh.mesh, &normals), nullptr, kCannot, shown);
    render::Surface surface;
    surface.positions = positions(mesh);
    surface.position_count = mesh.neutral.position_count;
    surface.normals = normals.data;
    surface.vertex_position_indices = mesh.neutral.vertex_position_indices.data;
    surface.vertex_count = mesh.neutral.vertex_count;
    surface.triangles = mesh.triangles.data();
    surface.triangle_count = mesh.neutral.triangle_count;
    if (!mesh.colors.empty()) surface.colors = mesh.colors.data();
    if (!mesh.inner_edges.empty()) surface.inner_edges = mesh.inner_edges.data();
    surface.material = mesh.material;
    surface.cornea = mesh.cornea;
    surface.texture_coordinates = mesh.texture_coordinates.data();
    surface.color_texture = mesh.textures[size_t(TextureKind::kBaseColor)];
    surface.normal_texture = mesh.textures[size_t(TextureKind::kNormal)];
    surface.roughness_texture = mesh.textures[size_t(TextureKind::kRoughness)];
    surfaces.push_back(surface);
  }
  return surfaces;
}

std::vector<Vec3> PosedScene::neutral_points() const {
  std::vector<Vec3> points;
  for (const SceneMesh& mesh : meshes) {
    for (uint32_t i = 0; i < mesh.neutral.position_count; ++i) {
      points.push_back(math::load3(mesh.neutral.positions.data, i));
    }
  }
  return points;
}

math::Box PosedScene::neutral_box() const {
  math::Box box;
  for (const SceneMesh& mesh : meshes) {
    for (uint32_t i = 0; i < mesh.neutral.position_count; ++i) {
      box.add(math::load3(mesh.neutral.positions.data, i));
    }
  }
  return box;
}

namespace {

void compile_scene(PosedScene& scene, uint32_t isa) {
  auto desc = sized<MienRigDesc>();
  desc.isa = isa;
  scene.rig = create_rig(scene.file, desc);
  if (!has_geometry(scene.file)) return;
  auto error = sized<MienError>();
  MienDeformer* deformer = nullptr;
  check(mien_deformer_create(scene.file.dna.get(), scene.rig.get(), nullptr, &deformer, &error),
        &error, "cannot compile geometry", scene.shown);
  scene.deformer.reset(deformer);
}

/// Of a rig that has all its LODs.
void choose_lod(PosedScene& scene, const PosedSceneOptions& options) {
  scene.rig_lod = options.lod;
  const uint32_t lod_count = rig_info(scene.rig.get()).lod_count;
  if (options.lod >= lod_count) {
    fail(kInvalid, kCannot, scene.shown,
         "LOD " + std::to_string(options.lod) + " is out of range: there are " +
             std::to_string(lod_count),
         "count from 0");
  }
}

/// A baked file, used in place.
void map_scene(PosedScene& scene, const PosedSceneOptions& options) {
  auto desc = sized<MienBakedRigDesc>();
  desc.isa = options.isa;
  BakedFile file = open_baked_file(options.rig, desc);
  scene.baked = std::move(file.baked);
  scene.rig = std::move(file.rig);
  if (!options.no_geometry) scene.deformer = std::move(file.deformer);
  choose_lod(scene, options);
}

/// Of the meshes of one LOD.
void make_pose(PosedScene& scene) {
  auto error = sized<MienError>();
  auto desc = sized<MienDeformerInstanceDesc>();
  desc.lods = uint64_t{1} << scene.rig_lod;
  MienDeformerInstance* pose = nullptr;
  check(mien_deformer_instance_create(scene.deformer.get(), &desc, &pose, &error), &error, kCannot,
        scene.shown);
  scene.pose.reset(pose);
}

/// What is the same whatever the rig came from.
PosedScene finish_scene(PosedScene scene, const PosedSceneOptions& options,
                        const Session& session) {
  scene.info = rig_info(scene.rig.get());
  scene.axes = axes_of(scene.info);

  auto error = sized<MienError>();
  MienInstance* instance = nullptr;
  check(mien_instance_create(scene.rig.get(), nullptr, &instance, &error), &error, kCannot,
        scene.shown);
  scene.instance.reset(instance);
  if (!scene.deformer) {
    if (options.geometry_optional || options.no_geometry) return scene;
    fail(kInvalid, kCannot, scene.shown, "the file has no geometry",
         "give a rig with meshes; see 'mien info'");
  }

  make_pose(scene);
  choose_meshes(scene, options, session);
  return scene;
}

}  // namespace

PosedScene open_scene(const PosedSceneOptions& options, const Session& session) {
  PosedScene scene;
  scene.shown = shown_name(options.rig);
  scene.lod = options.lod;
  scene.materials = read_materials_beside(options.rig);
  if (is_baked_file(options.rig)) {
    map_scene(scene, options);
  } else {
    auto desc = sized<MienDnaDesc>();
    desc.layers = kEvaluationLayers | (options.no_geometry ? 0 : uint32_t{MIEN_LAYER_GEOMETRY});
    // Nothing of the other LODs is read.
    if (!options.whole_rig) desc.lods = uint64_t{1} << options.lod;
    scene.file = open_rig_file(options.rig, desc, session);
    compile_scene(scene, options.isa);
    if (options.whole_rig) choose_lod(scene, options);
  }
  return finish_scene(std::move(scene), options, session);
}

PosedScene open_scene(RigFile file, const Session& session) {
  PosedScene scene;
  scene.shown = file.shown;
  scene.file = std::move(file);
  compile_scene(scene, MIEN_ISA_BEST);
  return finish_scene(std::move(scene), {}, session);
}

void show_lod(PosedScene& scene, uint32_t lod, const Session& session) {
  scene.lod = scene.rig_lod = lod;
  scene.meshes.clear();
  make_pose(scene);
  choose_meshes(scene, {}, session);
}

void pose_scene(PosedScene& scene, const Frame& frame) {
  MienInstance* instance = scene.instance.get();
  check(mien_instance_reset(instance), nullptr, kCannot, scene.shown);
  apply_frame(frame, scene.rig.get(), instance);
  check(mien_rig_evaluate(scene.rig.get(), instance, scene.rig_lod), nullptr, kCannot, scene.shown);
  deform_scene(scene, instance, frame.head);
}

void deform_scene(PosedScene& scene, const MienInstance* instance, const HeadPose& head) {
  MienDeformerInstance* pose = scene.pose.get();
  const std::string& shown = scene.shown;
  if (!pose) return;
  check(mien_deformer_instance_update(pose, instance), nullptr, kCannot, shown);
  if (head.turned()) {
    if (!scene.head) {
      scene.head = std::make_unique<HeadTurn>(scene.rig.get(), scene.deformer.get(), shown);
    }
    scene.head->apply(pose, head);
  }
  for (const SceneMesh& mesh : scene.meshes) {
    check(mien_deformer_instance_deform(pose, mesh.mesh, MIEN_NORMALS_DEFAULT, nullptr), nullptr,
          kCannot, shown);
    const float* positions = scene.positions(mesh);
    for (size_t i = 0; i < size_t{mesh.neutral.position_count} * 3; ++i) {
      if (std::isfinite(positions[i])) continue;
      fail(kInvalid, kCannot, shown + ", " + mesh.name + ", position " + std::to_string(i / 3),
           "the result is not a finite number", "give smaller controls; they are usually in 0..1");
    }
  }
}

}  // namespace mien::cli
