// SPDX-License-Identifier: MIT
// Materials of the meshes of a rig. A DNA file has names of meshes only, so colors and textures are in a JSON
// file beside it, head.materials.json for head.dna:
//
//     {"materials": [{"name": "skin", "base_color": [1, 1, 1, 1], "roughness": 0.5,
//                     "textures": {"base_color": "skin.png", "normal": "skin_n.png", "roughness": "skin_r.png"}},
//                    {"name": "hair", "alpha_cutoff": 0.4, "textures": {"base_color": "hair.png"}}],
//      "meshes": {"head_lod0_mesh": "skin", "hair_lod0_mesh": "hair"}}
//
// Paths of textures are relative to this file. Colors are linear red, green, blue, alpha; colors and roughness are
// multiplied by their textures, of which base colors are sRGB. A texture with alpha is transparent; with an
// alpha_cutoff, as cards of hair have it, it hides all where its alpha is at least that, and nothing elsewhere, and the
// mesh is seen from both sides. "cornea": {"depth": 0.44, "iris": 0.158} of the material of an eye says that the iris is
// seen through the surface: it has that radius around the middle of the base color, 0.5 at most, and lies that many times
// its radius behind the apex. Everything but the name may be left out.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

namespace mien::cli {

enum class TextureKind { kBaseColor, kNormal, kRoughness };
constexpr size_t kTextureKinds = 3;
/// The longest names of materials and objects, and paths of textures, that are read.
constexpr size_t kMaxNameBytes = 255, kMaxPathBytes = 4095;
/// As the file and texture_folder.h name them: base_color, ...
const char* texture_kind_name(TextureKind kind);

struct SurfaceMaterial {
  std::string name;
  std::array<double, 4> color = {1, 1, 1, 1};
  double roughness = 0.5;
  double alpha_cutoff = 0;                          // 0: the alpha of a texture blends
  bool has_color = false, has_roughness = false;    // were given; else the mesh's own hold
  double cornea_depth = 0, cornea_iris = 0;         // 0: no cornea
  std::array<std::string, kTextureKinds> textures;  // paths by kind, from here; empty: none

  const std::string& texture(TextureKind kind) const { return textures[size_t(kind)]; }
};

struct Materials {
  std::vector<SurfaceMaterial> list;
  std::map<std::string, size_t> of_mesh;  // number in the list, by name of a mesh

  /// Null if nothing is said about the mesh.
  const SurfaceMaterial* find(const std::string& mesh) const;
};

/// "head.materials.json" for "head.dna".
std::string materials_path(const std::string& rig);

/// What is beside a rig: nothing if there is no such file, and for streams. Fails with kInvalid, and with kFile
/// if the file cannot be read. Textures are not opened.
Materials read_materials_beside(const std::string& rig);

/// As the text of a file in `folder`: paths become relative to it where they can.
std::string materials_json(const Materials& materials, const std::string& folder);

/// The bytes of a PNG or JPEG file that a material names. Fails with kFile if there is no such file or if it
/// is not a regular one, with kInvalid if it is of another kind or larger than 256 MB.
struct TextureFile {
  std::string bytes;
  bool is_png = false;  // otherwise JPEG

  const char* mime_type() const { return is_png ? "image/png" : "image/jpeg"; }
};
TextureFile read_texture(const std::string& path);
/// Of bytes that are in memory; `shown` is for messages.
TextureFile texture_of(std::string bytes, const std::string& shown);

}  // namespace mien::cli
