// SPDX-License-Identifier: MIT
// MTL: colors, roughness and textures of the materials of an OBJ.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "integrations/program/io/texture_folder.h"
#include "integrations/program/mesh/text_lines.h"

namespace mien::cli {

namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxMtlMaterials = 65536;

/// Words that follow an option of a texture; -1 for what is no option.
int option_words_of(std::string_view word) {
  for (const char* one : {"-blendu", "-blendv", "-boost", "-texres", "-clamp", "-bm", "-imfchan",
                          "-type", "-cc", "-colorspace"}) {
    if (word == one) return 1;
  }
  if (word == "-mm") return 2;
  return word == "-o" || word == "-s" || word == "-t" ? 3 : -1;
}

bool is_number(std::string_view word) {
  double value = 0;
  const auto read = std::from_chars(word.data(), word.data() + word.size(), value);
  return read.ec == std::errc() && read.ptr == word.data() + word.size();
}

/// What follows the options: the name of the file, with the spaces in it.
std::string texture_path(TextLines& lines, const fs::path& folder) {
  std::string name = lines.name();
  while (!name.empty() && name[0] == '-') {
    const std::string_view option = lines.word();
    const int count = option_words_of(option);
    if (count < 0) break;
    for (int i = 0; i < count; ++i) {
      // -o, -s and -t may have fewer than three numbers.
      const std::string rest = lines.name();
      const std::string_view next = std::string_view(rest).substr(0, rest.find_first_of(" \t"));
      if (i > 0 && count == 3 && !is_number(next)) break;
      lines.word();
    }
    name = lines.name();
  }
  if (name.empty()) lines.fail("a texture has no file name");
  if (name.size() > kMaxPathBytes) lines.fail("the path is longer than 4095 bytes");
  std::replace(name.begin(), name.end(), '\\', '/');
  return (folder / name).lexically_normal().string();
}

double clamped(double value) { return std::clamp(value, 0.0, 1.0); }

}  // namespace

void read_mtl(const std::string& bytes, const std::string& path, MeshFile& mesh) {
  const fs::path folder = fs::path(path).parent_path();
  std::map<std::string, SurfaceMaterial*> wanted;
  for (MeshMaterial& material : mesh.materials) wanted[material.surface.name] = &material.surface;
  TextLines lines(bytes, path);
  SurfaceMaterial unused;
  SurfaceMaterial* current = nullptr;
  size_t count = 0;
  while (lines.next()) {
    const std::string_view keyword = lines.word();
    if (keyword.empty()) continue;
    if (keyword == "newmtl") {
      const std::string name = lines.name();
      if (name.size() > kMaxNameBytes) lines.fail("the name is longer than 255 bytes");
      if (++count > kMaxMtlMaterials) lines.fail("more than 65536 materials");
      const auto found = wanted.find(name);
      unused = {};
      current = found == wanted.end() ? &unused : found->second;
      continue;
    }
    const std::string word(keyword);
    const bool known = word == "Kd" || word == "d" || word == "Tr" || word == "Ns" ||
                       word == "Pr" || word == "map_Kd" || word == "map_Pr" || word == "norm" ||
                       word == "map_Bump" || word == "map_bump" || word == "bump";
    if (!known) continue;
    if (!current) lines.fail("a " + word + " stands before any newmtl");
    if (word == "Kd") {
      const std::string rest = lines.name();
      if (rest.compare(0, 8, "spectral") == 0 || rest.compare(0, 3, "xyz") == 0) continue;
      for (size_t i = 0; i < 3; ++i) current->color[i] = clamped(lines.number("a color"));
      current->has_color = true;
    } else if (word == "d") {
      if (lines.name().compare(0, 5, "-halo") == 0) lines.word();
      current->color[3] = clamped(lines.number("an opacity"));
    } else if (word == "Tr") {
      current->color[3] = 1 - clamped(lines.number("a transparency"));
    } else if (word == "Ns" && !current->has_roughness) {
      // The exponent that programs write for a roughness; obj_writer.cpp has its inverse.
      current->roughness = 1 - std::sqrt(clamped(lines.number("an exponent") / 1000));
      current->has_roughness = true;
    } else if (word == "Pr") {
      current->roughness = clamped(lines.number("a roughness"));
      current->has_roughness = true;
    } else if (word == "map_Kd") {
      current->textures[size_t(TextureKind::kBaseColor)] = texture_path(lines, folder);
    } else if (word == "map_Pr") {
      current->textures[size_t(TextureKind::kRoughness)] = texture_path(lines, folder);
    } else if (word == "norm") {
      current->textures[size_t(TextureKind::kNormal)] = texture_path(lines, folder);
    } else if (word != "Ns") {
      // A height map, unless its name says otherwise: many programs write normals there.
      const std::string image = texture_path(lines, folder);
      const TextureName name = parse_texture_name(fs::path(image).stem().string());
      std::string& normal = current->textures[size_t(TextureKind::kNormal)];
      if (name.known && name.kind == TextureKind::kNormal && normal.empty()) normal = image;
    }
  }
  // A factor that is usual beside a texture: programs show the texture alone.
  for (MeshMaterial& material : mesh.materials) {
    SurfaceMaterial& surface = material.surface;
    if (surface.texture(TextureKind::kBaseColor).empty()) continue;
    const double opacity = surface.color[3];
    surface.color = {1, 1, 1, opacity};
  }
}

}  // namespace mien::cli
