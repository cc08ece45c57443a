// SPDX-License-Identifier: MIT
// Scene -> GLB.
#pragma once

#include <string>

#include "integrations/program/gltf/scene.h"

namespace mien::gltf {

struct Vrm;

/// How numbers are stored.
enum class Encoding {
  kFloat,
  kShares,  // weights, and texture coordinates from 0 to 1, in 16 bits: no extension is needed
  kQuantized,  // besides positions and what targets move them in 16 bits (of the longest side of the box,
               // for a head 5 micrometers), normals in 8, by KHR_mesh_quantization
};

/// By how much kQuantized moves a vertex at most, in meters, and again by as much for each target at 1.
double quantization_error(const Scene& scene);

/// A binary glTF 2.0 file; the same scene gives the same bytes everywhere.
///
///   nodes       first one that holds the skeleton (named as the scene), then the joints, then one
///               for each mesh
///   scenes      one per LOD, the finest first and shown first; all of them share the skeleton
///   skin        one for all meshes
///   images      in the file where the scene has their bytes, otherwise by their paths
///   targets     sparse where that is smaller; names in mesh.extras.targetNames, those whose weight is
///               a product in mesh.extras.correctives: [{"target": 52, "product": [17, 23]}, ...]
///   animation   joint channels for what moves, weights for each mesh with targets
///   vrm         null, or what makes the file a VRM 1.0
///
/// Throws ExportError for numbers that are not finite and for more than 4 GiB.
std::string write_glb(const Scene& scene, Encoding encoding = Encoding::kFloat,
                      const Vrm* vrm = nullptr);

}  // namespace mien::gltf
