// SPDX-License-Identifier: MIT
#include "integrations/program/io/texture_folder.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <utility>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/mesh_appearance.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxFiles = 4096;

/// Lower case; camelCase is two words, as camel_case is. Digits stay with the letters before them.
std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words;
  std::string word;
  const auto end_word = [&] {
    if (!word.empty()) words.push_back(word);
    word.clear();
  };
  bool was_lower = false;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (!std::isalnum(byte)) {
      end_word();
    } else {
      if (std::isupper(byte) && was_lower) end_word();
      word += static_cast<char>(std::tolower(byte));
    }
    was_lower = std::islower(byte) != 0;
  }
  end_word();
  return words;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += word;
  return text;
}

struct KindWord {
  const char* word;
  TextureKind kind;
};

constexpr KindWord kKindWords[] = {
    {"basecolor", TextureKind::kBaseColor},
    {"albedo", TextureKind::kBaseColor},
    {"diffuse", TextureKind::kBaseColor},
    {"diff", TextureKind::kBaseColor},
    {"color", TextureKind::kBaseColor},
    {"col", TextureKind::kBaseColor},
    {"bc", TextureKind::kBaseColor},
    {"d", TextureKind::kBaseColor},
    {"normal", TextureKind::kNormal},
    {"normals", TextureKind::kNormal},
    {"normalmap", TextureKind::kNormal},
    {"nrm", TextureKind::kNormal},
    {"norm", TextureKind::kNormal},
    {"nor", TextureKind::kNormal},
    {"n", TextureKind::kNormal},
    {"roughness", TextureKind::kRoughness},
    {"rough", TextureKind::kRoughness},
    {"rgh", TextureKind::kRoughness},
    {"r", TextureKind::kRoughness},
};

/// Words that say nothing: prefixes of engines, "map" at the end, names of passes.
bool is_filler(const std::string& word) {
  for (const char* filler : {"t", "tx", "tex", "texture", "m", "mi", "map", "main", "vt"}) {
    if (word == filler) return true;
  }
  return false;
}

/// head_lod0_mesh -> head
std::string mesh_subject(const std::string& name) {
  std::vector<std::string> words = words_of(name);
  const auto says_nothing = [](const std::string& word) {
    return word == "mesh" || word.compare(0, 3, "lod") == 0;
  };
  words.erase(std::remove_if(words.begin(), words.end(), says_nothing), words.end());
  return joined(words);
}

bool has_class(const std::string& subject, MeshClass mesh_class_of_mesh) {
  for (const char* word : {"", "skin", "face", "head"}) {
    if (subject == word) return mesh_class_of_mesh == MeshClass::kSkin;
  }
  return mesh_class(subject) != MeshClass::kSkin && mesh_class(subject) == mesh_class_of_mesh;
}

/// The material of a mesh alone, so that a texture for it changes no other mesh; a copy if it is shared.
SurfaceMaterial& own_material(const std::string& mesh, Materials& materials) {
  const auto found = materials.of_mesh.find(mesh);
  SurfaceMaterial made;
  if (found != materials.of_mesh.end()) {
    size_t users = 0;
    for (const auto& entry : materials.of_mesh) users += entry.second == found->second;
    if (users == 1) return materials.list[found->second];
    made = materials.list[found->second];
  }
  made.name = mesh;
  materials.of_mesh[mesh] = materials.list.size();
  materials.list.push_back(std::move(made));
  return materials.list.back();
}

struct FoundTexture {
  std::string file, path;
  TextureName name;
};

std::vector<FoundTexture> textures_in(const std::string& folder) {
  std::error_code reason;
  std::vector<FoundTexture> found;
  fs::directory_iterator files(folder, reason);
  for (; !reason && files != fs::directory_iterator(); files.increment(reason)) {
    const fs::path& path = files->path();
    std::string ending = path.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (ending != ".png" && ending != ".jpg" && ending != ".jpeg") continue;
    if (found.size() == kMaxFiles) {
      fail(kInvalid, "cannot use textures", one_line(folder),
           "more than " + std::to_string(kMaxFiles) + " images", "name a folder with fewer");
    }
    found.push_back(
        {path.filename().string(), path.string(), parse_texture_name(path.stem().string())});
  }
  if (reason) {
    fail(kFile, "cannot read textures", one_line(folder), reason.message(), "name a folder");
  }
  std::sort(found.begin(), found.end(),
            [](const FoundTexture& a, const FoundTexture& b) { return a.file < b.file; });
  return found;
}

}  // namespace

TextureName parse_texture_name(const std::string& stem) {
  TextureName name;
  std::vector<std::string> words = words_of(stem);
  while (words.size() > 1 && is_filler(words.back())) words.pop_back();
  while (words.size() > 1 && is_filler(words.front())) words.erase(words.begin());
  // "base_color" is two words, "nrm" one; the longer meaning first.
  for (size_t count : {size_t{2}, size_t{1}}) {
    if (name.known || words.size() < count) continue;
    const std::string last(joined({words.end() - static_cast<std::ptrdiff_t>(count), words.end()}));
    for (const KindWord& of : kKindWords) {
      if (last != of.word || (last.size() == 1 && words.size() == 1)) continue;
      name.known = true;
      name.kind = of.kind;
      words.resize(words.size() - count);
      break;
    }
  }
  name.subject = joined(words);
  return name;
}

TextureFolder add_texture_folder(const std::string& folder, const std::vector<std::string>& meshes,
                                 Materials& materials) {
  TextureFolder result;
  for (const FoundTexture& texture : textures_in(folder)) {
    const std::string& subject = texture.name.subject;
    // By the name of a material or a mesh before the class.
    std::vector<std::string> takers;
    for (const std::string& mesh : meshes) {
      const SurfaceMaterial* material = materials.find(mesh);
      if (subject.empty() || !texture.name.known) continue;
      if (subject == mesh_subject(mesh) ||
          (material && subject == joined(words_of(material->name)))) {
        takers.push_back(mesh);
      }
    }
    const bool by_name = !takers.empty();
    for (size_t m = 0; m < meshes.size() && !by_name && texture.name.known; ++m) {
      if (has_class(subject, mesh_class(meshes[m]))) takers.push_back(meshes[m]);
    }
    for (const std::string& mesh : takers) {
      own_material(mesh, materials).textures[size_t(texture.name.kind)] = texture.path;
    }
    result.used += !takers.empty();
    if (takers.empty()) result.unused.push_back(texture.file);
  }
  return result;
}

}  // namespace mien::cli
