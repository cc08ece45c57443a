// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/arkit_bake.h"

#include <algorithm>
#include <cmath>

namespace mien::gltf {

namespace {

constexpr uint32_t kCombinations = 200;
constexpr double kLeastMove = 2e-6;  // of the diagonal
constexpr double kLeastCorrective = 1e-3;
constexpr size_t kMaxCorrectives = 128;

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
      : source_(source), controls_(controls), pose_(make_deformer_instance(source)) {
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
    check(mien_deformer_instance_update(pose_.get(), instance_.get()), "cannot bake");
    check(mien_deformer_instance_deform(pose_.get(), rig_mesh,
                                        with_normals ? MIEN_NORMALS_RECOMPUTED : MIEN_NORMALS_NONE,
                                        nullptr),
          "cannot bake");
  }

  const MienDeformerInstance* pose() const { return pose_.get(); }

  std::vector<float> positions(uint32_t rig_mesh) const {
    MienFloatView view{};
    check(mien_deformer_instance_positions(pose_.get(), rig_mesh, &view), "cannot bake");
    return std::vector<float>(view.data, view.data + view.count);
  }

  std::vector<float> normals(uint32_t rig_mesh) const {
    MienFloatView view{};
    check(mien_deformer_instance_normals(pose_.get(), rig_mesh, &view), "cannot bake");
    return std::vector<float>(view.data, view.data + view.count);
  }

 private:
  const RigSource& source_;
  const ArkitControls& controls_;
  cli::DeformerInstance pose_;
  cli::Instance instance_;
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
  std::vector<float> neutral, neutral_normals;
  std::vector<float> moves[kArkitCount], turns[kArkitCount];
  std::vector<bool> is_moved;  // of the positions
  struct Pair {
    size_t first, second;
    std::vector<float> moves;
  };
  std::vector<Pair> correctives;

  void compare(const Face& face, const Weights& weights, bool corrected,
               Distances& distances) const {
    const std::vector<float> posed = face.positions(rig_mesh);
    std::vector<std::pair<double, const std::vector<float>*>> terms;
    for (size_t e = 0; e < kArkitCount; ++e) {
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
        double sum = neutral[i];
        for (const auto& [weight, term] : terms) sum += weight * (*term)[i];
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

Shape shape_of(Face& face, uint32_t rig_mesh, uint32_t lod, const Weights& weights) {
  face.deform(rig_mesh, lod, weights, true);
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

/// Targets of one mesh; also fills in what the report says of it.
BakedMesh bake_mesh(const RigSource& source, Face& face, uint32_t rig_mesh, double diagonal,
                    MouthClose mouth_close, Mesh& mesh, BakeReport& report) {
  const MienMesh from = source.mesh(rig_mesh);
  BakedMesh baked;
  baked.rig_mesh = rig_mesh;
  baked.lod = finest_lod(from);
  Weights weights(kArkitCount);
  const Shape neutral = shape_of(face, rig_mesh, baked.lod, weights);
  baked.neutral = neutral.positions;
  baked.neutral_normals = neutral.normals;
  for (uint32_t v = 0; v < from.vertex_count; ++v) {
    const math::Vec3d p =
        source.point(baked.neutral.data() + size_t{3} * from.vertex_position_indices.data[v]);
    for (int i = 0; i < 3; ++i) mesh.positions[v][size_t(i)] = static_cast<float>(p[i]);
  }

  baked.is_moved.resize(from.position_count);
  Shape open;
  for (size_t e = 0; e < kArkitCount; ++e) {
    const bool with_jaw = e == kMouthClose && mouth_close == MouthClose::kWithJaw;
    weights[e] = 1;
    weights[kJawOpen] = with_jaw || e == kJawOpen;
    const Shape shape = shape_of(face, rig_mesh, baked.lod, weights);
    const Shape& base = with_jaw ? open : neutral;
    mesh.targets.push_back(difference(source, rig_mesh, face.pose(), base.positions, base.normals,
                                      kLeastMove * diagonal));
    mesh.targets.back().name = kArkitNames[e];
    baked.moves[e] = less(shape.positions, base.positions);
    baked.turns[e] = less(shape.normals, base.normals);
    for (size_t p = 0; p < baked.is_moved.size(); ++p) {
      const double length = length_at(source, baked.moves[e], p);
      if (length > kLeastMove * diagonal) baked.is_moved[p] = true;
      double& most = report.expressions[e].max_move;
      most = std::max(most, length);
    }
    if (e == kJawOpen) open = shape;
    if (e == kMouthClose) {
      weights[kJawOpen] = !with_jaw;
      const Shape other = shape_of(face, rig_mesh, baked.lod, weights);
      const Shape& other_base = with_jaw ? neutral : open;
      const std::vector<float> apart =
          less(less(other.positions, other_base.positions), baked.moves[e]);
      for (size_t p = 0; p < baked.is_moved.size(); ++p) {
        report.max_close_with_jaw =
            std::max(report.max_close_with_jaw, length_at(source, apart, p));
      }
    }
    weights[e] = weights[kJawOpen] = 0;
  }
  const auto moves_nothing = [](const MorphTarget& target) { return target.vertices.empty(); };
  if (std::all_of(mesh.targets.begin(), mesh.targets.end(), moves_nothing)) mesh.targets.clear();
  return baked;
}

/// What two expressions together move beyond their sum, where that is notable: a target each.
void add_correctives(const RigSource& source, Face& face, double diagonal, MouthClose mouth_close,
                     BakedMesh& baked, Mesh& mesh) {
  if (mesh.targets.empty()) return;
  struct Found {
    double most;
    size_t first, second;
  };
  std::vector<Found> found;
  Weights weights(kArkitCount);
  const auto deform = [&](size_t a, size_t b, bool with_normals) {
    weights[a] = weights[b] = 1;
    face.deform(baked.rig_mesh, baked.lod, weights, with_normals);
    weights[a] = weights[b] = 0;
  };
  for (size_t a = 0; a < kArkitCount; ++a) {
    for (size_t b = a + 1; b < kArkitCount; ++b) {
      // A mouthClose that goes with the jaw is nothing by itself.
      const bool closes = a == kMouthClose || b == kMouthClose;
      if (closes && mouth_close == MouthClose::kWithJaw) continue;
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
                                    kLeastMove * diagonal);
    target.name = std::string(kArkitNames[a]) + "+" + kArkitNames[b];
    mesh.correctives.push_back({static_cast<uint32_t>(mesh.targets.size()),
                                {static_cast<uint32_t>(a), static_cast<uint32_t>(b)}});
    mesh.targets.push_back(std::move(target));
    baked.correctives.push_back({a, b, less(face.positions(baked.rig_mesh), positions)});
  }
}

}  // namespace

BakeReport bake_arkit(const RigSource& source, const ArkitControls& controls,
                      const BakeOptions& options, RigScene& scene,
                      const std::function<void(double share)>& progress) {
  const bool with_jaw = options.mouth_close == MouthClose::kWithJaw;
  BakeReport report;
  report.expressions.resize(kArkitCount);
  report.diagonal = diagonal_of(source);
  report.combination_count = kCombinations;
  Face face(source, controls);
  Distances halfway[kArkitCount], together, corrected;
  for (size_t m = 0; m < scene.scene.meshes.size(); ++m) {
    const uint32_t rig_mesh = scene.rig_meshes[m];
    Mesh& mesh = scene.scene.meshes[m];
    BakedMesh baked =
        bake_mesh(source, face, rig_mesh, report.diagonal, options.mouth_close, mesh, report);
    if (options.correctives) {
      add_correctives(source, face, report.diagonal, options.mouth_close, baked, mesh);
      report.corrective_count += mesh.correctives.size();
    }
    report.moved_positions +=
        static_cast<size_t>(std::count(baked.is_moved.begin(), baked.is_moved.end(), true));
    Weights weights(kArkitCount);
    for (size_t e = 0; e < kArkitCount; ++e) {
      weights[e] = 0.5;
      if (with_jaw && e == kMouthClose) weights[kJawOpen] = 0.5;
      face.deform(rig_mesh, baked.lod, weights, false);
      baked.compare(face, weights, false, halfway[e]);
      weights[e] = weights[kJawOpen] = 0;
    }
    Random random;
    for (uint32_t i = 0; i < kCombinations; ++i) {
      // Most of the time goes here.
      const double part = double(i) / kCombinations;
      if (progress) progress((double(m) + part) / double(scene.scene.meshes.size()));
      for (double& weight : weights) {
        const bool is_on = random.unit() < 0.125;
        const double value = random.unit();
        weight = is_on ? value : 0;
      }
      if (with_jaw) weights[kMouthClose] = std::min(weights[kMouthClose], weights[kJawOpen]);
      const double most = together.most;
      face.deform(rig_mesh, baked.lod, weights, false);
      baked.compare(face, weights, false, together);
      baked.compare(face, weights, true, corrected);
      if (together.most > most) std::copy(weights.begin(), weights.end(), report.worst.begin());
    }
  }
  const double meters = source.meters_per_unit();
  for (size_t e = 0; e < kArkitCount; ++e) {
    report.expressions[e].halfway = halfway[e].residual(meters);
  }
  report.combinations = together.residual(meters);
  report.corrected = corrected.residual(meters);
  return report;
}

ArkitWeights arkit_weights(const ArkitControls& controls, const MienFloatView& raw) {
  ArkitWeights weights{};
  for (size_t e = 0; e < kArkitCount; ++e) weights[e] = raw.data[controls.controls[e][0].control];
  return weights;
}

namespace {

/// Of the expressions, and of the correctives that they drive.
std::vector<float> target_weights(const Mesh& mesh, const ArkitWeights& expressions) {
  if (mesh.targets.empty()) return {};
  std::vector<float> weights(expressions.begin(), expressions.end());
  for (const Corrective& corrective : mesh.correctives) {
    weights.push_back(weights[corrective.product[0]] * weights[corrective.product[1]]);
  }
  return weights;
}

}  // namespace

void set_baked_pose(RigScene& scene, const ArkitWeights& weights) {
  for (Mesh& mesh : scene.scene.meshes) {
    const std::vector<float> all = target_weights(mesh, weights);
    for (size_t t = 0; t < all.size(); ++t) mesh.targets[t].weight = all[t];
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
      const std::vector<float> all = target_weights(scene.scene.meshes[m], weights);
      track.insert(track.end(), all.begin(), all.end());
    }
  }
  return animation;
}

}  // namespace mien::gltf
