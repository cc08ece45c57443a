// SPDX-License-Identifier: MIT
#include "integrations/gltf/arkit_bake.h"

#include <algorithm>
#include <cmath>

namespace mien::gltf {

namespace {

constexpr uint32_t kCombinations = 200;
constexpr double kLeastMove = 2e-6;  // of the diagonal

struct DestroyInstance {
  void operator()(MienInstance* instance) const { mien_instance_destroy(instance); }
};

/// Pseudo-random numbers that are the same everywhere: splitmix64.
class Random {
 public:
  double unit() {
    uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-53;
  }

 private:
  uint64_t state_ = 0;
};

using Weights = std::vector<double>;  // of the expressions

/// Expressions in, deformed meshes out.
class Face {
 public:
  Face(const RigSource& source, const ArkitControls& controls)
      : source_(source), controls_(controls), pose_(make_pose(source)) {
    MienInstance* made = nullptr;
    auto error = sized<MienError>();
    const MienStatus status = mien_instance_create(source.rig(), nullptr, &made, &error);
    if (status != MIEN_OK) throw ExportError(status, "", error.message, "");
    instance_.reset(made);
  }

  /// Leaves the positions of the mesh, and normals if wanted, in the pose.
  void deform(uint32_t rig_mesh, uint32_t lod, const Weights& weights, bool with_normals) {
    MienMutableFloatView raw{};
    check(mien_instance_reset(instance_.get()), "cannot bake");
    check(mien_instance_raw_controls(instance_.get(), &raw), "cannot bake");
    for (size_t e = 0; e < kArkitCount; ++e) {
      if (weights[e] == 0) continue;
      for (const ControlWeight& control : controls_.controls[e]) {
        float& value = raw.data[control.control];
        value = std::min(1.0f, value + control.weight * static_cast<float>(weights[e]));
      }
    }
    check(mien_rig_evaluate(source_.rig(), instance_.get(), lod), "cannot bake");
    check(mien_pose_update(pose_.get(), instance_.get()), "cannot bake");
    check(mien_pose_deform(pose_.get(), rig_mesh,
                           with_normals ? MIEN_NORMALS_RECOMPUTED : MIEN_NORMALS_NONE, nullptr),
          "cannot bake");
  }

  const MienPose* pose() const { return pose_.get(); }

  std::vector<float> positions(uint32_t rig_mesh) const {
    MienFloatView view{};
    check(mien_pose_positions(pose_.get(), rig_mesh, &view), "cannot bake");
    return std::vector<float>(view.data, view.data + view.count);
  }

  std::vector<float> normals(uint32_t rig_mesh) const {
    MienFloatView view{};
    check(mien_pose_normals(pose_.get(), rig_mesh, &view), "cannot bake");
    return std::vector<float>(view.data, view.data + view.count);
  }

 private:
  const RigSource& source_;
  const ArkitControls& controls_;
  PoseHandle pose_;
  std::unique_ptr<MienInstance, DestroyInstance> instance_;
};

/// Sum of squares and maximum of distances.
struct Distances {
  double squares = 0, most = 0;
  size_t count = 0;

  void add(double squared) {
    squares += squared;
    most = std::max(most, std::sqrt(squared));
    ++count;
  }
  Residual residual(double unit) const {
    return {count == 0 ? 0 : std::sqrt(squares / static_cast<double>(count)) * unit, most * unit};
  }
};

/// A mesh in neutral, and how far the expressions move its positions, in units of the file.
struct BakedMesh {
  uint32_t rig_mesh = 0, lod = 0;
  std::vector<float> neutral;
  std::vector<float> moves[kArkitCount];
  std::vector<bool> is_moved;  // of the positions

  void compare(const Face& face, const Weights& weights, Distances& distances) const {
    const std::vector<float> posed = face.positions(rig_mesh);
    for (size_t p = 0; p < is_moved.size(); ++p) {
      if (!is_moved[p]) continue;
      double squared = 0;
      for (size_t i = 3 * p; i < 3 * p + 3; ++i) {
        double sum = neutral[i];
        for (size_t e = 0; e < kArkitCount; ++e) {
          if (weights[e] != 0) sum += weights[e] * moves[e][i];
        }
        squared += (posed[i] - sum) * (posed[i] - sum);
      }
      distances.add(squared);
    }
  }
};

uint32_t finest_lod(const MienMesh& mesh) {
  for (uint32_t lod = 0; lod < 64; ++lod) {
    if (mesh.lods >> lod & 1) return lod;
  }
  return 0;
}

double diagonal_of(const RigSource& source) {
  Vec3 least = {INFINITY, INFINITY, INFINITY}, most = {-INFINITY, -INFINITY, -INFINITY};
  for (uint32_t m = 0; m < source.count(MIEN_KIND_MESH); ++m) {
    const MienMesh mesh = source.mesh(m);
    for (size_t p = 0; p < mesh.position_count; ++p) {
      const Vec3 point = source.point(mesh.positions.data + 3 * p);
      for (int i = 0; i < 3; ++i) {
        least[i] = std::min(least[i], point[i]);
        most[i] = std::max(most[i], point[i]);
      }
    }
  }
  const Vec3 size = most - least;
  return std::sqrt(dot(size, size));
}

/// Targets of one mesh; also fills in what the report says of it.
BakedMesh bake_mesh(const RigSource& source, Face& face, uint32_t rig_mesh, double diagonal,
                    Mesh& mesh, BakeReport& report) {
  const MienMesh from = source.mesh(rig_mesh);
  BakedMesh baked;
  baked.rig_mesh = rig_mesh;
  baked.lod = finest_lod(from);
  Weights weights(kArkitCount);
  face.deform(rig_mesh, baked.lod, weights, true);
  baked.neutral = face.positions(rig_mesh);
  const std::vector<float> neutral_normals = face.normals(rig_mesh);
  for (uint32_t v = 0; v < from.vertex_count; ++v) {
    const Vec3 p = source.point(baked.neutral.data() + size_t{3} * from.vertex_positions.data[v]);
    for (size_t i = 0; i < 3; ++i) mesh.positions[v][i] = static_cast<float>(p[i]);
  }

  baked.is_moved.resize(from.position_count);
  for (size_t e = 0; e < kArkitCount; ++e) {
    weights[e] = 1;
    face.deform(rig_mesh, baked.lod, weights, true);
    weights[e] = 0;
    mesh.targets.push_back(difference(source, rig_mesh, face.pose(), baked.neutral, neutral_normals,
                                      kLeastMove * diagonal));
    mesh.targets.back().name = kArkitNames[e];
    std::vector<float>& moves = baked.moves[e] = face.positions(rig_mesh);
    for (size_t i = 0; i < moves.size(); ++i) moves[i] -= baked.neutral[i];
    for (size_t p = 0; p < baked.is_moved.size(); ++p) {
      const Vec3 move = source.point(moves.data() + 3 * p);
      const double length = std::sqrt(dot(move, move));
      if (length > kLeastMove * diagonal) baked.is_moved[p] = true;
      double& most = report.expressions[e].most_move;
      most = std::max(most, length);
    }
  }
  const auto moves_nothing = [](const MorphTarget& target) { return target.vertices.empty(); };
  if (std::all_of(mesh.targets.begin(), mesh.targets.end(), moves_nothing)) mesh.targets.clear();
  return baked;
}

}  // namespace

BakeReport bake_arkit(const RigSource& source, const ArkitControls& controls, RigScene& scene) {
  BakeReport report;
  report.expressions.resize(kArkitCount);
  report.diagonal = diagonal_of(source);
  report.combination_count = kCombinations;
  Face face(source, controls);
  Distances halfway[kArkitCount], together;
  for (size_t m = 0; m < scene.scene.meshes.size(); ++m) {
    const uint32_t rig_mesh = scene.rig_meshes[m];
    const BakedMesh baked =
        bake_mesh(source, face, rig_mesh, report.diagonal, scene.scene.meshes[m], report);
    report.moved_positions +=
        static_cast<size_t>(std::count(baked.is_moved.begin(), baked.is_moved.end(), true));
    const auto measure = [&](const Weights& weights, Distances& distances) {
      face.deform(rig_mesh, baked.lod, weights, false);
      baked.compare(face, weights, distances);
    };
    Weights weights(kArkitCount);
    for (size_t e = 0; e < kArkitCount; ++e) {
      weights[e] = 0.5;
      measure(weights, halfway[e]);
      weights[e] = 0;
    }
    Random random;
    for (uint32_t i = 0; i < kCombinations; ++i) {
      for (double& weight : weights) {
        const bool is_on = random.unit() < 0.125;
        const double value = random.unit();
        weight = is_on ? value : 0;
      }
      measure(weights, together);
    }
  }
  const double metres = source.metres_per_unit();
  for (size_t e = 0; e < kArkitCount; ++e) {
    report.expressions[e].halfway = halfway[e].residual(metres);
  }
  report.combinations = together.residual(metres);
  return report;
}

ArkitWeights arkit_weights(const ArkitControls& controls, const MienFloatView& raw) {
  ArkitWeights weights{};
  for (size_t e = 0; e < kArkitCount; ++e) weights[e] = raw.data[controls.controls[e][0].control];
  return weights;
}

void set_baked_pose(RigScene& scene, const ArkitWeights& weights) {
  for (Mesh& mesh : scene.scene.meshes) {
    for (size_t t = 0; t < mesh.targets.size(); ++t) mesh.targets[t].weight = weights[t];
  }
}

Animation baked_animation(const RigScene& scene, const std::vector<ArkitWeights>& frames,
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
    for (const ArkitWeights& weights : frames) {
      std::vector<float>& track = animation.weights.back().weights;
      track.insert(track.end(), weights.begin(), weights.end());
    }
  }
  return animation;
}

}  // namespace mien::gltf
