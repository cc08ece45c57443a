// SPDX-License-Identifier: MIT
// How a mesh looks without its textures: what it is, by its name, and the colors of its vertices,
// where the file has some. Images and exported files share both.
#pragma once

#include <mien.h>

#include <cstdint>
#include <string>
#include <vector>

namespace mien::cli {

enum class MeshClass {
  kSkin,  // whatever has no other name
  kEye,
  kTeeth,
  kGums,
  kTongue,
  kMouth,  // the inside of it
  kBrow,
  kHair,
  kLash,
  kFilm,  // transparent: shells and edges of eyes, saliva, tears
  kCartilage,
};

/// By the words in the name of a mesh.
MeshClass mesh_class(const std::string& name);

/// Whether a mesh of this class hides what is behind it unless it has its textures.
bool needs_textures(MeshClass mesh_class);

/// Colors of a mesh: sRGB, r g b for each position. Empty if the file has none, or none that fit.
struct VertexColors {
  std::vector<uint8_t> rgb;
  std::string problem;  // why the colors of the file were not used; empty without a problem
};

/// Reads the entry "mien.colors.MESH" of the descriptor's metadata: base64 (RFC 4648, padded) of
/// r g b for each position.
VertexColors read_vertex_colors(const MienDna* dna, const std::string& mesh, size_t position_count);

}  // namespace mien::cli
