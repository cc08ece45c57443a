// SPDX-License-Identifier: MIT
#include "integrations/program/io/materials.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/json_check.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::basic_json<MemberList>;

constexpr const char* kCannotUse = "cannot use materials";
constexpr const char* kMaterialsExample =
    R"(write {"materials": [{"name": "skin", "textures": {"base_color": "skin.png"}}], )"
    R"("meshes": {"head_lod0_mesh": "skin"}})";
constexpr size_t kMaxFileBytes = size_t{16} << 20;
constexpr size_t kMaxMaterials = 4096;
constexpr uint64_t kMaxTextureBytes = uint64_t{256} << 20;

constexpr TextureKind kKinds[] = {TextureKind::kBaseColor, TextureKind::kNormal,
                                  TextureKind::kRoughness};

[[noreturn]] void wrong_materials(const std::string& where, const std::string& why) {
  fail(kInvalid, kCannotUse, where, why, kMaterialsExample);
}

std::string text_of(const Json& value, const std::string& where, size_t most) {
  if (!value.is_string()) wrong_materials(where, "expected a text");
  const std::string text = value.get<std::string>();
  if (text.empty()) wrong_materials(where, "it is empty");
  if (text.size() > most) wrong_materials(where, "longer than " + std::to_string(most) + " bytes");
  if (text.find('\0') != std::string::npos) wrong_materials(where, "it has a NUL in it");
  return text;
}

double share_of(const Json& value, const std::string& where) {
  const double number = value.is_number() ? value.get<double>() : -1;
  if (!(number >= 0 && number <= 1)) wrong_materials(where, "expected a number from 0 to 1");
  return number;
}

const Json& object_of(const Json& value, const std::string& where) {
  if (!value.is_object()) wrong_materials(where, "expected an object");
  return value;
}

void read_textures(const Json& object, const std::string& where, const fs::path& folder,
                   SurfaceMaterial& material) {
  for (const auto& [kind_name, path] : object_of(object, where).items()) {
    const std::string place = where + "." + one_line(kind_name);
    bool known = false;
    for (const TextureKind kind : kKinds) {
      if (kind_name != texture_kind_name(kind)) continue;
      known = true;
      const fs::path given = text_of(path, place, kMaxPathBytes);
      material.textures[size_t(kind)] = (folder / given).lexically_normal().string();
    }
    if (!known) wrong_materials(place, "textures are base_color, normal and roughness");
  }
}

void read_cornea(const Json& object, const std::string& where, SurfaceMaterial& material) {
  for (const auto& [key, value] : object_of(object, where).items()) {
    const std::string place = where + "." + one_line(key);
    if (key != "depth" && key != "iris") wrong_materials(place, "a cornea has depth and iris");
    const double number = share_of(value, place);
    (key == "depth" ? material.cornea_depth : material.cornea_iris) = number;
  }
  if (material.cornea_depth == 0 || material.cornea_iris == 0 || material.cornea_iris > 0.5) {
    wrong_materials(where, "expected depth, more than 0, and iris, more than 0 and up to 0.5");
  }
}

SurfaceMaterial material_of(const Json& object, const std::string& where, const fs::path& folder) {
  SurfaceMaterial material;
  for (const auto& [key, value] : object_of(object, where).items()) {
    const std::string place = where + "." + one_line(key);
    if (key == "name") {
      material.name = text_of(value, place, kMaxNameBytes);
    } else if (key == "base_color") {
      if (!value.is_array() || value.size() != 4) wrong_materials(place, "expected four numbers");
      for (size_t i = 0; i < 4; ++i) material.color[i] = share_of(value[i], place);
      material.has_color = true;
    } else if (key == "roughness") {
      material.roughness = share_of(value, place);
      material.has_roughness = true;
    } else if (key == "alpha_cutoff") {
      material.alpha_cutoff = share_of(value, place);
    } else if (key == "cornea") {
      read_cornea(value, place, material);
    } else if (key == "textures") {
      read_textures(value, place, folder, material);
    } else {
      wrong_materials(place,
                      "a material has name, base_color, roughness, alpha_cutoff, cornea and "
                      "textures");
    }
  }
  if (material.name.empty()) wrong_materials(where, "it has no name");
  return material;
}

Materials parse(const std::string& text, const std::string& shown, const fs::path& folder) {
  const Json document = parse_json<Json>(text, kCannotUse, shown, kMaterialsExample);
  Materials materials;
  std::map<std::string, size_t> numbers;
  for (const auto& [key, value] : object_of(document, shown).items()) {
    if (key != "materials" && key != "meshes") {
      wrong_materials(shown + ", " + one_line(key), "the file has materials and meshes");
    }
    if (key == "meshes") continue;
    if (!value.is_array()) wrong_materials(shown + ", materials", "expected a list");
    if (value.size() > kMaxMaterials) {
      wrong_materials(shown, "more than " + std::to_string(kMaxMaterials) + " materials");
    }
    for (const Json& object : value) {
      const std::string where =
          shown + ", materials[" + std::to_string(materials.list.size()) + "]";
      SurfaceMaterial material = material_of(object, where, folder);
      if (!numbers.emplace(material.name, materials.list.size()).second) {
        wrong_materials(where, "another one is named \"" + one_line(material.name) + "\", too");
      }
      materials.list.push_back(std::move(material));
    }
  }
  const auto meshes = document.find("meshes");
  if (meshes == document.end()) return materials;
  for (const auto& [mesh, value] : object_of(*meshes, shown + ", meshes").items()) {
    const std::string where = shown + ", meshes." + one_line(mesh.substr(0, kMaxNameBytes));
    const auto found = numbers.find(text_of(value, where, kMaxNameBytes));
    if (found == numbers.end()) wrong_materials(where, "there is no such material in the file");
    materials.of_mesh[mesh] = found->second;
  }
  return materials;
}

std::string relative_path(const std::string& path, const std::string& folder) {
  std::error_code ignored;
  const fs::path from = fs::absolute(folder.empty() ? fs::path(".") : fs::path(folder), ignored);
  const fs::path relative =
      fs::absolute(path, ignored).lexically_normal().lexically_relative(from.lexically_normal());
  return relative.empty() ? path : relative.generic_string();
}

}  // namespace

const char* texture_kind_name(TextureKind kind) {
  switch (kind) {
    case TextureKind::kBaseColor: return "base_color";
    case TextureKind::kNormal: return "normal";
    case TextureKind::kRoughness: break;
  }
  return "roughness";
}

const SurfaceMaterial* Materials::find(const std::string& mesh) const {
  const auto found = of_mesh.find(mesh);
  return found == of_mesh.end() ? nullptr : &list[found->second];
}

std::string materials_path(const std::string& rig) {
  return fs::path(rig).replace_extension(".materials.json").string();
}

Materials read_materials_beside(const std::string& rig) {
  if (is_stream(rig)) return {};
  const std::string path = materials_path(rig);
  std::error_code reason;
  const fs::file_status status = fs::status(path, reason);
  if (!fs::exists(status)) return {};
  if (!fs::is_regular_file(status)) {
    fail(kFile, kCannotUse, path, "it is not a regular file", "move it away");
  }
  const uint64_t size = fs::file_size(path, reason);
  if (!reason && size > kMaxFileBytes) {
    fail(kInvalid, kCannotUse, path, "it has " + std::to_string(size) + " bytes, more than 16 MB",
         "move it away");
  }
  return parse(read_json(path, kCannotUse), path, fs::path(path).parent_path());
}

std::string materials_json(const Materials& materials, const std::string& folder) {
  nlohmann::ordered_json root = nlohmann::ordered_json::object();
  root["materials"] = nlohmann::ordered_json::array();
  for (const SurfaceMaterial& material : materials.list) {
    nlohmann::ordered_json object = {{"name", material.name}};
    if (material.has_color) object["base_color"] = material.color;
    if (material.has_roughness) object["roughness"] = material.roughness;
    if (material.alpha_cutoff > 0) object["alpha_cutoff"] = material.alpha_cutoff;
    if (material.cornea_depth > 0) {
      object["cornea"] = {{"depth", material.cornea_depth}, {"iris", material.cornea_iris}};
    }
    for (const TextureKind kind : kKinds) {
      const std::string& path = material.texture(kind);
      if (!path.empty()) object["textures"][texture_kind_name(kind)] = relative_path(path, folder);
    }
    root["materials"].push_back(std::move(object));
  }
  root["meshes"] = nlohmann::ordered_json::object();
  for (const auto& [mesh, number] : materials.of_mesh) {
    root["meshes"][mesh] = materials.list[number].name;
  }
  return root.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

TextureFile texture_of(std::string bytes, const std::string& shown) {
  TextureFile texture;
  texture.is_png = bytes.compare(0, 8, "\x89PNG\r\n\x1a\n") == 0;
  if (!texture.is_png && bytes.compare(0, 3, "\xff\xd8\xff") != 0) {
    fail(kInvalid, "cannot use texture", shown, "it is neither PNG nor JPEG", "convert it to PNG");
  }
  texture.bytes = std::move(bytes);
  return texture;
}

TextureFile read_texture(const std::string& path) {
  constexpr const char* kCannot = "cannot read texture";
  std::error_code reason;
  const fs::file_status status = fs::status(path, reason);
  if (!fs::is_regular_file(status)) {
    fail(kFile, kCannot, one_line(path),
         fs::exists(status) ? "it is not a regular file" : "there is no such file",
         "check the path in the materials");
  }
  const uint64_t size = fs::file_size(path, reason);
  if (reason) fail(kFile, kCannot, one_line(path), reason.message(), "");
  if (size > kMaxTextureBytes) {
    fail(kInvalid, kCannot, one_line(path), "it has more than 256 MB", "make it smaller");
  }
  std::ifstream file(path, std::ios::binary);
  std::string bytes(size, '\0');
  if (!file.read(bytes.data(), static_cast<std::streamsize>(size))) {
    fail(kFile, kCannot, one_line(path), std::strerror(errno), "check the file");
  }
  return texture_of(std::move(bytes), one_line(path));
}

}  // namespace mien::cli
