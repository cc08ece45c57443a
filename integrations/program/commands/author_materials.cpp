// SPDX-License-Identifier: MIT
#include "integrations/program/commands/author_materials.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/handles.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

/// head_lod3_mesh -> head, as the rig's meshes are named after the objects.
std::string object_of_mesh(const std::string& mesh) {
  const size_t at = mesh.rfind("_lod");
  return at == std::string::npos ? mesh : mesh.substr(0, at);
}

std::vector<std::string> dna_mesh_names(const MienDna* dna) {
  std::vector<std::string> names;
  auto field = sized<MienDnaField>();
  auto error = sized<MienError>();
  check(mien_dna_field(dna, "defn.meshNames", &field, &error), &error, "cannot read meshes", "");
  for (uint64_t i = 0; i < field.count; ++i) {
    MienStringView name{};
    const std::string path = "defn.meshNames[" + std::to_string(i) + "]";
    check(mien_dna_read_string(dna, path.c_str(), &name, &error), &error, "cannot read meshes", "");
    names.push_back(to_string(name));
  }
  return names;
}

/// A name for a file, without what systems do not like in one.
std::string file_stem(const std::string& name) {
  std::string stem;
  for (const char c : name.substr(0, 100)) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_';
    stem += plain ? c : '_';
  }
  return stem.empty() ? "material" : stem;
}

void note_material_problems(const MeshFile& mesh, const Session& session) {
  for (const std::string& problem : mesh.material_problems) note(session, one_line(problem));
  if (mesh.lost_materials.empty()) return;
  std::string names;
  for (const std::string& name : mesh.lost_materials) {
    names += (names.empty() ? "" : ", ") + one_line(name);
  }
  note(session,
       "a mesh of the rig has one material, that of most of its faces; faces that share positions "
       "with it lose " +
           names);
}

}  // namespace

AuthoredMaterials::AuthoredMaterials(const MeshFile& mesh, const MienDna* dna,
                                     const std::string& rig, bool copy, const Session& session) {
  note_material_problems(mesh, session);
  std::map<std::string, uint32_t> of_object;
  for (const MeshObject& object : mesh.objects) {
    if (object.material != kNoMaterial) of_object[object.name] = object.material;
  }
  if (of_object.empty()) return;
  if (is_stream(rig)) {
    note(session, "the materials of the mesh are left out: their file would be beside the rig's");
    return;
  }
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(rig).replace_extension(".textures");
  std::map<std::string, std::string> written;  // new path by old path or number
  std::set<std::string> taken;
  const auto write_image = [&](const std::string& key, const std::string& stem,
                               const TextureFile& image) {
    const auto known = written.find(key);
    if (known != written.end()) return known->second;
    if (made_folder_.empty() && fs::create_directories(folder)) made_folder_ = folder.string();
    std::string name = stem;
    while (!taken.insert(name).second) name += "_";
    const std::string path = (folder / (name + (image.is_png ? ".png" : ".jpg"))).string();
    outputs_.push_back(std::make_unique<Output>(path));
    outputs_.back()->write(image.bytes);
    return written[key] = path;
  };
  Materials materials;
  std::map<uint32_t, size_t> numbers;
  for (const std::string& name : dna_mesh_names(dna)) {
    const auto object = of_object.find(object_of_mesh(name));
    if (object == of_object.end()) continue;
    const auto [number, is_new] = numbers.emplace(object->second, materials.list.size());
    materials.of_mesh[name] = number->second;
    if (!is_new) continue;
    const MeshMaterial& from = mesh.materials[object->second];
    SurfaceMaterial material = from.surface;
    for (size_t k = 0; k < kTextureKinds; ++k) {
      const std::string stem =
          file_stem(material.name) + "_" + texture_kind_name(static_cast<TextureKind>(k));
      std::string& path = material.textures[k];
      if (from.images[k] != kNoMaterial) {
        path = write_image("#" + std::to_string(from.images[k]), stem, mesh.images[from.images[k]]);
      } else if (!path.empty() && !fs::is_regular_file(path)) {
        note(session, "material " + one_line(material.name) + ": there is no file " +
                          one_line(path) + ", which is left out");
        path.clear();
      } else if (!path.empty() && copy) {
        path = write_image(path, stem, read_texture(path));
      }
    }
    materials.list.push_back(std::move(material));
  }
  outputs_.push_back(std::make_unique<Output>(materials_path(rig)));
  outputs_.back()->write(materials_json(materials, fs::path(rig).parent_path().string()));
}

AuthoredMaterials::~AuthoredMaterials() {
  outputs_.clear();
  std::error_code ignored;
  if (!made_folder_.empty()) std::filesystem::remove(made_folder_, ignored);  // fails if it is used
}

void AuthoredMaterials::commit() {
  for (const std::unique_ptr<Output>& output : outputs_) output->commit();
}

}  // namespace mien::cli
