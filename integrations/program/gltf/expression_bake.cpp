// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/expression_bake.h"

#include <algorithm>
#include <cmath>

#include "integrations/program/gltf/bake_poses.h"

namespace mien::gltf {

namespace {

constexpr double kLeastDelta = 2e-6;  // of the diagonal
constexpr double kLeastCorrective = 1e-3;
constexpr size_t kMaxCorrectives = 128;

/// A mesh in neutral, and how far the expressions move its positions, in units of the file.
struct BakedMesh {
  uint32_t rig_mesh = 0, lod = 0;
  std::vector<float> neutral, neutral_normals;
  std::vector<std::vector<float>> moves, turns;  // by expression
  std::vector<bool> is_moved;                    // of the positions
  struct Pair {
    size_t first, second;
    std::vector<float> moves;
  };
  std::vector<Pair> correctives;

  /// Of `posed` from the sum of targets, and `base` if given: the pose that a difference is taken to.
  void compare(const std::vector<float>& posed, const Weights& weights, bool corrected,
               Distances& distances, const std::vector<float>* base = nullptr) const {
    std::vector<std::pair<double, const std::vector<float>*>> terms;
    for (size_t e = 0; e < weights.size(); ++e) {
      if (weights[e] != 0) terms.emplace_back(weights[e], &moves[e]);
    }
    for (const Pair& pair : correctives) {
      const double weight = weights[pair.first] * weights[pair.second];
      if (corrected && weight != 0) terms.emplace_back(weight, &pair.moves);
    }
    for (size_t p = 0; p < is_moved.size(); ++p) {
      if (!is_moved[p]) continue;
      double squared = 0;
      for (size_t i = 3 * p; i < 3 * p + 3; ++i) {
        double sum = base ? (*base)[i] : neutral[i];
        for (const auto& [weight, term] : terms) sum += weight * (*term)[i];
        squared += (posed[i] - sum) * (posed[i] - sum);
      }
      distances.add(squared);
    }
  }
};

double diagonal_of(const RigSource& source) {
  math::Boxd box;
  for (uint32_t m = 0; m < source.count(MIEN_KIND_MESH); ++m) {
    const MienMesh mesh = source.mesh(m);
    for (size_t p = 0; p < mesh.position_count; ++p) {
      box.add(source.point(mesh.positions.data + 3 * p));
    }
  }
  return box.empty() ? 0 : length(box.size());
}

/// Positions and normals of a mesh in one pose.
struct Shape {
  std::vector<float> positions, normals;
};

Shape shape_of(Face& face, uint32_t rig_mesh, uint32_t lod,
               const std::vector<ControlValue>& values) {
  face.deform(rig_mesh, lod, values, true);
  return {face.positions(rig_mesh), face.normals(rig_mesh)};
}

std::vector<float> less(std::vector<float> a, const std::vector<float>& b) {
  for (size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

std::vector<float> sum(std::vector<float> a, const std::vector<float>& b,
                       const std::vector<float>& c) {
  for (size_t i = 0; i < a.size(); ++i) a[i] += b[i] + c[i];
  return a;
}

double length_at(const RigSource& source, const std::vector<float>& moves, size_t position) {
  return length(source.point(moves.data() + 3 * position));
}

/// By how much the difference of mouthClose depends on the jaw; 0 if the set has not both expressions.
double close_with_jaw(const RigSource& source, Face& face, const RigExpressions& set,
                      const BakedMesh& baked) {
  const size_t close = set.find("mouthClose"), jaw = set.find("jawOpen");
  if (std::max(close, jaw) >= set.expressions.size()) return 0;
  const RigExpression& expression = set.expressions[close];
  std::vector<ControlValue> values = expression.plus;
  const auto& open = set.expressions[jaw].plus;
  const bool alone = expression.minus.empty();
  if (alone) {
    values.insert(values.end(), open.begin(), open.end());
  } else {  // without the jaw
    for (const ControlValue& of : expression.minus) values.push_back({of.control, -of.value});
  }
  const Shape other = shape_of(face, baked.rig_mesh, baked.lod, values);
  const std::vector<float> base =
      alone ? shape_of(face, baked.rig_mesh, baked.lod, open).positions : baked.neutral;
  const std::vector<float> apart = less(less(other.positions, base), baked.moves[close]);
  double most = 0;
  for (size_t p = 0; p < baked.is_moved.size(); ++p) {
    most = std::max(most, length_at(source, apart, p));
  }
  return most;
}

/// Targets of one mesh; also fills in what the report says of it.
BakedMesh bake_mesh(const RigSource& source, Face& face, const RigExpressions& set,
                    uint32_t rig_mesh, double diagonal, Mesh& mesh, BakeReport& report) {
  const MienMesh from = source.mesh(rig_mesh);
  BakedMesh baked;
  baked.rig_mesh = rig_mesh;
  baked.lod = finest_lod(from);
  const Shape neutral = shape_of(face, rig_mesh, baked.lod, {});
  baked.neutral = neutral.positions;
  baked.neutral_normals = neutral.normals;
  for (uint32_t v = 0; v < from.vertex_count; ++v) {
    const math::Vec3d p =
        source.point(baked.neutral.data() + size_t{3} * from.vertex_position_indices.data[v]);
    for (int i = 0; i < 3; ++i) mesh.positions[v][size_t(i)] = static_cast<float>(p[i]);
  }

  baked.is_moved.resize(from.position_count);
  for (size_t e = 0; e < set.expressions.size(); ++e) {
    const RigExpression& expression = set.expressions[e];
    const Shape base =
        expression.minus.empty() ? neutral : shape_of(face, rig_mesh, baked.lod, expression.minus);
    const Shape shape = shape_of(face, rig_mesh, baked.lod, expression.plus);
    mesh.targets.push_back(difference(source, rig_mesh, face.pose(), base.positions, base.normals,
                                      kLeastDelta * diagonal));
    mesh.targets.back().name = expression.name;
    baked.moves.push_back(less(shape.positions, base.positions));
    baked.turns.push_back(less(shape.normals, base.normals));
    for (size_t p = 0; p < baked.is_moved.size(); ++p) {
      const double length = length_at(source, baked.moves[e], p);
      if (length > kLeastDelta * diagonal) baked.is_moved[p] = true;
      double& most = report.expressions[e].max_move;
      most = std::max(most, length);
    }
  }
  report.max_close_with_jaw =
      std::max(report.max_close_with_jaw, close_with_jaw(source, face, set, baked));
  const auto moves_nothing = [](const MorphTarget& target) { return target.vertices.empty(); };
  if (std::all_of(mesh.targets.begin(), mesh.targets.end(), moves_nothing)) mesh.targets.clear();
  return baked;
}

/// What two expressions together move beyond their sum, where that is notable: a target each.
void add_correctives(const RigSource& source, Face& face, const RigExpressions& set,
                     double diagonal, BakedMesh& baked, Mesh& mesh) {
  if (mesh.targets.empty()) return;
  struct Found {
    double most;
    size_t first, second;
  };
  std::vector<Found> found;
  const size_t count = set.expressions.size();
  Weights weights(count);
  const auto deform = [&](size_t a, size_t b, bool with_normals) {
    weights[a] = weights[b] = 1;
    face.deform(baked.rig_mesh, baked.lod, weights, with_normals);
    weights[a] = weights[b] = 0;
  };
  for (size_t a = 0; a < count; ++a) {
    for (size_t b = a + 1; b < count; ++b) {
      // A difference is nothing by itself.
      if (!set.expressions[a].minus.empty() || !set.expressions[b].minus.empty()) continue;
      if (mesh.targets[a].vertices.empty() || mesh.targets[b].vertices.empty()) continue;
      deform(a, b, false);
      const std::vector<float> beyond =
          less(face.positions(baked.rig_mesh), sum(baked.neutral, baked.moves[a], baked.moves[b]));
      double most = 0;
      for (size_t p = 0; p < baked.is_moved.size(); ++p) {
        most = std::max(most, length_at(source, beyond, p));
      }
      if (most > kLeastCorrective * diagonal) found.push_back({most, a, b});
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Found& x, const Found& y) { return x.most > y.most; });
  if (found.size() > kMaxCorrectives) found.resize(kMaxCorrectives);
  for (const auto& [most, a, b] : found) {
    deform(a, b, true);
    const std::vector<float> positions = sum(baked.neutral, baked.moves[a], baked.moves[b]);
    MorphTarget target = difference(source, baked.rig_mesh, face.pose(), positions,
                                    sum(baked.neutral_normals, baked.turns[a], baked.turns[b]),
                                    kLeastDelta * diagonal);
    target.name = set.expressions[a].name + "+" + set.expressions[b].name;
    mesh.correctives.push_back({static_cast<uint32_t>(mesh.targets.size()),
                                {static_cast<uint32_t>(a), static_cast<uint32_t>(b)}});
    mesh.targets.push_back(std::move(target));
    baked.correctives.push_back({a, b, less(face.positions(baked.rig_mesh), positions)});
  }
}

/// Half of each target against the rig at half of its controls.
void measure_halfway(Face& face, const RigExpressions& set, const BakedMesh& baked,
                     std::vector<Distances>& halfway) {
  Weights weights(set.expressions.size());
  for (size_t e = 0; e < weights.size(); ++e) {
    const RigExpression& expression = set.expressions[e];
    face.deform(baked.rig_mesh, baked.lod, times(expression.minus, 0.5f), false);
    const std::vector<float> base = face.positions(baked.rig_mesh);
    face.deform(baked.rig_mesh, baked.lod, times(expression.plus, 0.5f), false);
    weights[e] = 0.5;
    baked.compare(face.positions(baked.rig_mesh), weights, false, halfway[e], &base);
    weights[e] = 0;
  }
}

}  // namespace

BakeReport bake_expressions(const RigSource& source, const RigExpressions& set, bool correctives,
                            RigScene& scene, const std::function<void(double share)>& progress) {
  const size_t count = set.expressions.size();
  BakeReport report;
  for (const RigExpression& expression : set.expressions) {
    report.expressions.push_back({expression.name, 0, {}, {}});
  }
  report.worst.resize(count);
  report.diagonal = diagonal_of(source);
  report.combination_count = kCombinations;
  Face face(source, set);
  std::vector<Distances> halfway(count), combined(count);
  Distances together, corrected;
  for (size_t m = 0; m < scene.scene.meshes.size(); ++m) {
    const uint32_t rig_mesh = scene.rig_meshes[m];
    Mesh& mesh = scene.scene.meshes[m];
    BakedMesh baked = bake_mesh(source, face, set, rig_mesh, report.diagonal, mesh, report);
    if (correctives) {
      add_correctives(source, face, set, report.diagonal, baked, mesh);
      report.corrective_count += mesh.correctives.size();
    }
    report.moved_positions +=
        static_cast<size_t>(std::count(baked.is_moved.begin(), baked.is_moved.end(), true));
    measure_halfway(face, set, baked, halfway);
    Combinations combinations(set);
    Weights weights(count);
    for (uint32_t i = 0; i < kCombinations; ++i) {
      // Most of the time goes here.
      const double part = double(i) / kCombinations;
      if (progress) progress((double(m) + part) / double(scene.scene.meshes.size()));
      combinations.draw(weights);
      face.deform(rig_mesh, baked.lod, weights, false);
      const std::vector<float> posed = face.positions(rig_mesh);
      Distances off;
      baked.compare(posed, weights, false, off);
      if (off.most > together.most) {
        std::copy(weights.begin(), weights.end(), report.worst.begin());
      }
      together.add(off);
      add_to_active(off, weights, combined);
      if (!baked.correctives.empty()) off = {};
      if (!baked.correctives.empty()) baked.compare(posed, weights, true, off);
      corrected.add(off);
    }
  }
  const double meters = source.meters_per_unit();
  for (size_t e = 0; e < count; ++e) {
    report.expressions[e].halfway = halfway[e].residual(meters);
    report.expressions[e].combined = combined[e].residual(meters);
  }
  report.combinations = together.residual(meters);
  report.corrected = corrected.residual(meters);
  return report;
}

std::vector<float> expression_weights(const RigExpressions& set, const MienFloatView& raw) {
  std::vector<float> weights;
  for (const RigExpression& expression : set.expressions) {
    weights.push_back(raw.data[expression.control]);
  }
  return weights;
}

namespace {

/// Of the expressions, and of the correctives that they drive.
std::vector<float> target_weights(const Mesh& mesh, const std::vector<float>& expressions) {
  if (mesh.targets.empty()) return {};
  std::vector<float> weights = expressions;
  for (const Corrective& corrective : mesh.correctives) {
    weights.push_back(weights[corrective.product[0]] * weights[corrective.product[1]]);
  }
  return weights;
}

}  // namespace

void set_baked_pose(RigScene& scene, const std::vector<float>& weights) {
  for (Mesh& mesh : scene.scene.meshes) {
    const std::vector<float> all = target_weights(mesh, weights);
    for (size_t t = 0; t < all.size(); ++t) mesh.targets[t].weight = all[t];
  }
}

Animation baked_animation(const RigScene& scene, const std::vector<std::vector<float>>& frames,
                          const std::string& name, double rate) {
  Animation animation;
  animation.name = name;
  for (size_t f = 0; f < frames.size(); ++f) {
    animation.times.push_back(static_cast<float>(static_cast<double>(f) / rate));
  }
  for (uint32_t m = 0; m < scene.scene.meshes.size(); ++m) {
    if (scene.scene.meshes[m].targets.empty()) continue;
    animation.weights.emplace_back();
    animation.weights.back().mesh = m;
    for (const std::vector<float>& weights : frames) {
      std::vector<float>& track = animation.weights.back().weights;
      const std::vector<float> all = target_weights(scene.scene.meshes[m], weights);
      track.insert(track.end(), all.begin(), all.end());
    }
  }
  return animation;
}

}  // namespace mien::gltf
