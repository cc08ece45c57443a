// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/bake_poses.h"

#include <algorithm>
#include <cmath>

namespace mien::gltf {

namespace {

constexpr size_t kNoBase = SIZE_MAX;

/// For each expression that is a difference, the expression whose pose it is a difference to.
std::vector<size_t> bases_of(const RigExpressions& set) {
  const auto same = [](const std::vector<ControlValue>& a, const std::vector<ControlValue>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
      return x.control == y.control && x.value == y.value;
    });
  };
  std::vector<size_t> bases(set.expressions.size(), kNoBase);
  for (size_t e = 0; e < bases.size(); ++e) {
    for (size_t other = 0; other < bases.size() && !set.expressions[e].minus.empty(); ++other) {
      const RigExpression& base = set.expressions[other];
      if (base.minus.empty() && same(base.plus, set.expressions[e].minus)) bases[e] = other;
    }
  }
  return bases;
}

}  // namespace

Face::Face(const RigSource& source, const RigExpressions& set)
    : source_(source), set_(set), pose_(make_deformer_instance(source)) {
  MienInstance* made = nullptr;
  auto error = sized<MienError>();
  const MienStatus status = mien_instance_create(source.rig(), nullptr, &made, &error);
  if (status != MIEN_OK) throw ExportError(status, "", error.message, "");
  instance_.reset(made);
}

void Face::deform(uint32_t rig_mesh, uint32_t lod, const Weights& weights, bool with_normals) {
  std::vector<ControlValue> values;
  for (size_t e = 0; e < weights.size(); ++e) {
    if (weights[e] == 0) continue;
    const auto weight = static_cast<float>(weights[e]);
    for (const ControlValue& of : set_.expressions[e].plus) {
      values.push_back({of.control, of.value * weight});
    }
    for (const ControlValue& of : set_.expressions[e].minus) {
      values.push_back({of.control, -of.value * weight});
    }
  }
  deform(rig_mesh, lod, values, with_normals);
}

void Face::deform(uint32_t rig_mesh, uint32_t lod, const std::vector<ControlValue>& values,
                  bool with_normals) {
  MienMutableFloatView raw{};
  check(mien_instance_reset(instance_.get()), "cannot bake");
  check(mien_instance_raw_controls(instance_.get(), &raw), "cannot bake");
  const std::vector<float> initial(raw.data, raw.data + raw.count);
  for (const ControlValue& of : values) raw.data[of.control] += of.value;
  for (const ControlValue& of : values) {
    float& value = raw.data[of.control];
    value = std::max(initial[of.control], std::min(1.0f, value));
  }
  check(mien_rig_evaluate(source_.rig(), instance_.get(), lod), "cannot bake");
  check(mien_deformer_instance_update(pose_.get(), instance_.get()), "cannot bake");
  check(mien_deformer_instance_deform(pose_.get(), rig_mesh,
                                      with_normals ? MIEN_NORMALS_RECOMPUTED : MIEN_NORMALS_NONE,
                                      nullptr),
        "cannot bake");
}

std::vector<float> Face::positions(uint32_t rig_mesh) const {
  MienFloatView view{};
  check(mien_deformer_instance_positions(pose_.get(), rig_mesh, &view), "cannot bake");
  return std::vector<float>(view.data, view.data + view.count);
}

std::vector<float> Face::normals(uint32_t rig_mesh) const {
  MienFloatView view{};
  check(mien_deformer_instance_normals(pose_.get(), rig_mesh, &view), "cannot bake");
  return std::vector<float>(view.data, view.data + view.count);
}

std::vector<ControlValue> times(std::vector<ControlValue> values, float factor) {
  for (ControlValue& value : values) value.value *= factor;
  return values;
}

uint32_t finest_lod(const MienMesh& mesh) {
  for (uint32_t lod = 0; lod < 64; ++lod) {
    if (mesh.lods >> lod & 1) return lod;
  }
  return 0;
}

Combinations::Combinations(const RigExpressions& set) : set_(set), bases_(bases_of(set)) {}

void Combinations::draw(Weights& weights) {
  for (double& weight : weights) {
    const bool is_on = random_.unit() < 0.125;
    const double value = random_.unit();
    weight = is_on ? value : 0;
  }
  for (size_t e = 0; e < weights.size(); ++e) {
    if (set_.expressions[e].minus.empty()) continue;
    weights[e] = bases_[e] == kNoBase ? 0 : std::min(weights[e], weights[bases_[e]]);
  }
}

void Distances::add(double squared) {
  const double distance = std::sqrt(squared);
  squares += squared;
  sum += distance;
  most = std::max(most, distance);
  ++count;
}

void Distances::add(const Distances& other) {
  squares += other.squares;
  sum += other.sum;
  most = std::max(most, other.most);
  count += other.count;
}

Residual Distances::residual(double unit) const {
  if (count == 0) return {};
  const auto n = static_cast<double>(count);
  return {std::sqrt(squares / n) * unit, sum / n * unit, most * unit};
}

void add_to_active(const Distances& distances, const Weights& weights,
                   std::vector<Distances>& by_expression) {
  for (size_t e = 0; e < weights.size(); ++e) {
    if (weights[e] != 0) by_expression[e].add(distances);
  }
}

}  // namespace mien::gltf
