// SPDX-License-Identifier: MIT
// Poses in which baked expressions are compared with the rig, and the distances found there.
#pragma once

#include "integrations/program/gltf/expression_set.h"
#include "integrations/program/gltf/rig_scene.h"
#include "integrations/program/math/random.h"

namespace mien::gltf {

constexpr uint32_t kCombinations = 200;

using Weights = std::vector<double>;  // of the expressions

/// Expressions in, deformed meshes out.
class Face {
 public:
  Face(const RigSource& source, const RigExpressions& set);

  /// Leaves the positions of the mesh, and normals if wanted, in the pose. A difference counts with what it
  /// adds to the pose that it is a difference to.
  void deform(uint32_t rig_mesh, uint32_t lod, const Weights& weights, bool with_normals);
  void deform(uint32_t rig_mesh, uint32_t lod, const std::vector<ControlValue>& values,
              bool with_normals);

  const MienDeformerInstance* pose() const { return pose_.get(); }
  std::vector<float> positions(uint32_t rig_mesh) const;
  std::vector<float> normals(uint32_t rig_mesh) const;

 private:
  const RigSource& source_;
  const RigExpressions& set_;
  cli::DeformerInstance pose_;
  cli::Instance instance_;
};

std::vector<ControlValue> times(std::vector<ControlValue> values, float factor);

/// The finest LOD that shows a mesh.
uint32_t finest_lod(const MienMesh& mesh);

/// Random combinations, the same every time: each expression is on with a chance of 1 in 8, by 0 to 1. One that
/// is a difference to a pose has a weight of at most that of the expression with this pose, and 0 if there is
/// none.
class Combinations {
 public:
  explicit Combinations(const RigExpressions& set);
  void draw(Weights& weights);

 private:
  const RigExpressions& set_;
  std::vector<size_t> bases_;  // of each difference, the expression with its pose
  math::Random random_;
};

/// Sums and maximum of distances.
struct Distances {
  double squares = 0, sum = 0, most = 0;
  size_t count = 0;

  void add(double squared);
  void add(const Distances& other);
  Residual residual(double unit) const;
};

/// Adds the distances of a combination to those of each expression that is in it.
void add_to_active(const Distances& distances, const Weights& weights,
                   std::vector<Distances>& by_expression);

}  // namespace mien::gltf
