// SPDX-License-Identifier: MIT
// The contents of a file of a face, as plain structs: joints, skinned meshes with morph targets, materials,
// an animation. Everything is in the axes and units of glTF: meters, y up, z to the front of the face, x to
// the left of the character, triangles counter-clockwise from outside.
//
//     Mien handles -> (rig_scene, expression_bake) -> Scene -> (glb_writer, obj_writer) -> bytes
#pragma once

#include <mien.h>

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "integrations/program/math/transform.h"

namespace mien::gltf {

/// Why a rig cannot be exported. The status tells the family.
struct ExportError : std::runtime_error {
  ExportError(MienStatus family, const std::string& place, const std::string& why,
              const std::string& advice)
      : std::runtime_error(why), status(family), where(place), what_to_do(advice) {}
  MienStatus status;
  std::string where;       // in the rig; may be empty
  std::string what_to_do;  // may be empty
};

using Float2 = std::array<float, 2>;
using Float3 = std::array<float, 3>;
using Float4 = std::array<float, 4>;

constexpr uint32_t kNone = UINT32_MAX;

/// Distances between two shapes of the same positions.
struct Residual {
  double rms = 0, mean = 0, max = 0;  // meters
};

struct Joint {
  std::string name;
  uint32_t parent = kNone;  // kNone: a root. Parents may follow their children.
  math::Transform bind;     // relative to the parent, in the pose that the vertices are in
  math::Transform pose;     // relative to the parent, as the file opens
};

/// Moves some vertices and turns some normals. Vertices ascend.
struct MorphTarget {
  std::string name;
  float weight = 0;  // as the file opens
  std::vector<uint32_t> vertices;
  std::vector<Float3> positions;  // by what they move; one for each of the vertices
  std::vector<uint32_t> normal_vertices;
  std::vector<Float3> normals;  // by what they turn
};

/// A target whose weight should be the product of the weights of others. glTF itself cannot express that: a
/// program has to read it from the extras.
struct Corrective {
  uint32_t target;
  std::array<uint32_t, 2> product;
};

/// Arrays have one entry per vertex, or none where that is allowed.
struct Mesh {
  std::string name;
  uint32_t material = 0;
  std::vector<Float3> positions;
  std::vector<Float3> normals;                  // may be empty; length 1
  std::vector<Float2> uvs;                      // may be empty; v points down, as in glTF
  std::vector<std::array<uint16_t, 4>> colors;  // may be empty; linear red, green, blue, alpha
  uint32_t influences = 0;                      // places per vertex: 0 (not skinned), 4, 8 or 12
  std::vector<uint16_t> joints;                 // vertices x influences
  std::vector<float> weights;                   // the same; each vertex's sum to 1
  std::vector<uint32_t> triangles;              // three vertices each
  std::vector<MorphTarget> targets;
  std::vector<Corrective> correctives;  // among the targets
};

/// PNG or JPEG. Formats with a place for bytes embed them; the others, and a GLB if there are none, have the path.
struct Image {
  std::string name;
  std::string mime_type;
  std::string bytes;
  std::string path;  // from the folder of the file that is written
};

struct Material {
  std::string name;
  std::array<double, 4> color = {1, 1, 1, 1};  // linear red, green, blue, alpha; times the texture
  double roughness = 1;                        // times the texture
  bool double_sided = false;
  bool see_through = false;  // by the alpha of its texture
  double alpha_cutoff =
      0;  // where that is at least this, it hides all, elsewhere nothing; 0: it blends
  double cornea_depth = 0, cornea_iris = 0;  // as in materials.h
  uint32_t color_image = kNone, normal_image = kNone, roughness_image = kNone;

  bool has_textures() const {
    return color_image != kNone || normal_image != kNone || roughness_image != kNone;
  }
};

/// One sample for each of the animation's times.
struct JointTrack {
  uint32_t joint = 0;
  std::vector<Float3> translations;  // each of the three may be empty: it stays as it is
  std::vector<Float4> rotations;
  std::vector<Float3> scales;
};

/// times x targets of the mesh
struct WeightTrack {
  uint32_t mesh = 0;
  std::vector<float> weights;
};

struct Animation {
  std::string name;
  std::vector<float> times;  // seconds, ascending
  std::vector<JointTrack> joints;
  std::vector<WeightTrack> weights;
};

struct Scene {
  std::string name;
  std::vector<Joint> joints;
  std::vector<Material> materials;
  std::vector<Image> images;
  std::vector<Mesh> meshes;
  std::vector<std::string> lod_names;
  std::vector<std::vector<uint32_t>> lods;  // meshes of each
  Animation animation;                      // none if it has no times
};

}  // namespace mien::gltf
