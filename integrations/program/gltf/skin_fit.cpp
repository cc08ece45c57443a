// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/skin_fit.h"

#include <algorithm>
#include <cmath>

#include "integrations/program/gltf/rig_scene.h"

namespace mien::gltf {

namespace {

using math::Vec3d;

// A joint whose skin matrix is off the identity by less does not move.
constexpr float kLeastJointMove = 1e-6f;
// Share of the mean of the diagonal that pulls weights to those of the file: where the expressions do
// not tell joints apart, weights stay in proportion.
constexpr double kPull = 1e-6;

/// The rig with one raw control at 1, and without joints: targets only.
class Expressions {
 public:
  explicit Expressions(const RigSource& source)
      : source_(source), posed_(make_deformer_instance(source)),
        bent_(make_deformer_instance(source)), moves_(source.count(MIEN_KIND_JOINT)) {
    MienInstance* made = nullptr;
    auto error = sized<MienError>();
    const MienStatus status = mien_instance_create(source.rig(), nullptr, &made, &error);
    if (status != MIEN_OK) throw ExportError(status, "", error.message, "");
    instance_.reset(made);
  }

  /// False if no joint moves.
  bool pose(uint32_t control) {
    MienMutableFloatView raw{};
    check(mien_instance_reset(instance_.get()), kCannot);
    check(mien_instance_raw_controls(instance_.get(), &raw), kCannot);
    raw.data[control] = 1;
    check(mien_rig_evaluate(source_.rig(), instance_.get(), 0), kCannot);
    check(mien_deformer_instance_update(posed_.get(), instance_.get()), kCannot);
    MienFloatView channels{};
    check(mien_instance_blend_shapes(instance_.get(), &channels), kCannot);
    check(mien_deformer_instance_update_from_values(bent_.get(), nullptr, 0, channels.data,
                                                    channels.count),
          kCannot);
    check(mien_deformer_instance_skin_matrices(posed_.get(), &skin_), kCannot);
    bool any = false;
    for (size_t j = 0; j < moves_.size(); ++j) {
      moves_[j] = false;
      for (size_t i = 0; i < 16; ++i) {
        moves_[j] = moves_[j] || std::abs(skin_.data[16 * j + i] - (i % 5 == 0)) > kLeastJointMove;
      }
      any = any || moves_[j];
    }
    return any;
  }

  void deform(uint32_t rig_mesh) {
    for (const auto& [character, positions] :
         {std::pair{posed_.get(), &posed_positions_}, std::pair{bent_.get(), &bent_positions_}}) {
      check(mien_deformer_instance_deform(character, rig_mesh, MIEN_NORMALS_NONE, nullptr),
            kCannot);
      check(mien_deformer_instance_positions(character, rig_mesh, positions), kCannot);
    }
  }

  bool moves(const CrowdedPosition& crowded) const {
    return std::any_of(crowded.influences.begin(), crowded.influences.end(),
                       [&](const Influence& influence) { return moves_[influence.joint]; });
  }

  /// From where all influences together put the position to where this joint alone would put it.
  Vec3d error(uint32_t position, uint16_t joint) const {
    const float* from = bent_positions_.data + size_t{3} * position;
    const float* to = posed_positions_.data + size_t{3} * position;
    const float* m = skin_.data + size_t{16} * joint;
    Vec3d off;
    for (int r = 0; r < 3; ++r) {
      off[r] = double{m[r]} * from[0] + double{m[4 + r]} * from[1] + double{m[8 + r]} * from[2] +
               m[12 + r] - to[r];
    }
    return off;
  }

 private:
  static constexpr const char* kCannot = "cannot fit skin weights";
  const RigSource& source_;
  cli::DeformerInstance posed_, bent_;
  cli::Instance instance_;
  std::vector<bool> moves_;
  MienFloatView skin_{}, posed_positions_{}, bent_positions_{};
};

/// Calls what(expression's control, position's index) for positions with a joint that moves.
template <class What>
void for_each_pose(const RigSource& source, const std::vector<CrowdedPosition>& positions,
                   Expressions& expressions, const std::function<void(double)>& progress,
                   double first, const What& what) {
  const uint32_t controls = source.count(MIEN_KIND_RAW_CONTROL);
  for (uint32_t control = 0; control < controls; ++control) {
    if (progress) progress(first + 0.5 * control / controls);
    if (!expressions.pose(control)) continue;
    uint32_t deformed = kNone;
    for (size_t i = 0; i < positions.size(); ++i) {
      if (!expressions.moves(positions[i])) continue;
      if (positions[i].rig_mesh != deformed) expressions.deform(deformed = positions[i].rig_mesh);
      what(control, i);
    }
  }
}

/// The quadratic form of a position's weights: its value is the sum of squared distances.
struct Form {
  size_t size = 0;
  std::vector<double> values;  // size x size

  double at(size_t i, size_t j) const { return values[i * size + j]; }

  void add(const std::vector<Vec3d>& errors) {
    for (size_t i = 0; i < size; ++i) {
      for (size_t j = 0; j < size; ++j) values[i * size + j] += dot(errors[i], errors[j]);
    }
  }
};

/// Solves a x = b by elimination with pivots; a has rows of n. False if it has no one solution.
bool solve(std::vector<double>& a, std::vector<double>& b) {
  const size_t n = b.size();
  for (size_t c = 0; c < n; ++c) {
    size_t pivot = c;
    for (size_t r = c + 1; r < n; ++r) {
      if (std::abs(a[r * n + c]) > std::abs(a[pivot * n + c])) pivot = r;
    }
    if (!std::isnormal(a[pivot * n + c])) return false;
    if (pivot != c) {
      std::swap_ranges(a.begin() + c * n, a.begin() + (c + 1) * n, a.begin() + pivot * n);
      std::swap(b[c], b[pivot]);
    }
    for (size_t r = c + 1; r < n; ++r) {
      const double factor = a[r * n + c] / a[c * n + c];
      if (factor == 0) continue;
      for (size_t k = c; k < n; ++k) a[r * n + k] -= factor * a[c * n + k];
      b[r] -= factor * b[c];
    }
  }
  for (size_t c = n; c-- > 0;) {
    for (size_t k = c + 1; k < n; ++k) b[c] -= a[c * n + k] * b[k];
    b[c] /= a[c * n + c];
  }
  return true;
}

/// Weights of the chosen joints that minimize form + pull |w - stored|^2 with sum 1, none below 0
/// (negative ones are set to 0, one after the other), and the minimum.
double best_weights(const Form& form, const std::vector<double>& stored, double pull,
                    const std::vector<size_t>& chosen, std::vector<double>& weights) {
  std::vector<size_t> used = chosen;
  std::vector<double> x;
  for (;;) {
    const size_t n = used.size();
    std::vector<double> a((n + 1) * (n + 1)), b(n + 1);
    for (size_t i = 0; i < n; ++i) {
      for (size_t j = 0; j < n; ++j) a[i * (n + 1) + j] = form.at(used[i], used[j]);
      a[i * (n + 1) + i] += pull;
      a[i * (n + 1) + n] = a[n * (n + 1) + i] = pull;  // of the size of the rest
      b[i] = pull * stored[used[i]];
    }
    b[n] = pull;
    if (!solve(a, b)) break;
    const auto least = std::min_element(b.begin(), b.begin() + n);
    x.assign(b.begin(), b.begin() + n);
    if (*least >= 0 || n == 1) break;
    used.erase(used.begin() + (least - b.begin()));
  }
  weights.assign(stored.size(), 0);
  for (size_t i = 0; i < x.size(); ++i) weights[used[i]] = std::max(x[i], 0.0);
  double value = 0;
  for (size_t i = 0; i < stored.size(); ++i) {
    value += pull * (weights[i] - stored[i]) * (weights[i] - stored[i]);
    for (size_t j = 0; j < stored.size(); ++j) value += weights[i] * weights[j] * form.at(i, j);
  }
  return value;
}

/// Leaves `most` of the influences.
void reduce(const Form& form, size_t most, std::vector<Influence>& influences) {
  const size_t n = influences.size();
  std::vector<double> stored, weights, best;
  for (const Influence& influence : influences) stored.push_back(influence.weight);
  double trace = 0;
  for (size_t i = 0; i < n; ++i) trace += form.at(i, i);
  const double pull = trace > 0 ? kPull * trace / static_cast<double>(n) : 1;
  std::vector<size_t> chosen(n);
  for (size_t i = 0; i < n; ++i) chosen[i] = i;
  while (chosen.size() > most) {
    size_t dropped = 0;
    double least = 0;
    for (size_t i = 0; i < chosen.size(); ++i) {
      std::vector<size_t> rest = chosen;
      rest.erase(rest.begin() + i);
      const double value = best_weights(form, stored, pull, rest, weights);
      if (i != 0 && value >= least) continue;
      least = value;
      dropped = i;
      best = weights;
    }
    chosen.erase(chosen.begin() + dropped);
  }
  std::vector<Influence> kept;
  for (const size_t i : chosen) {
    if (best[i] > 0) kept.push_back({influences[i].joint, best[i]});
  }
  if (kept.empty()) {  // poses beyond floats have no distances: the heaviest stay
    double sum = 0;
    kept.assign(influences.begin(), influences.begin() + most);
    for (const Influence& influence : kept) sum += influence.weight;
    for (Influence& influence : kept) influence.weight /= sum;
  }
  std::sort(kept.begin(), kept.end(), [](const Influence& a, const Influence& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.joint < b.joint;
  });
  influences = std::move(kept);
}

}  // namespace

SkinLoss fit_influences(const RigSource& source, size_t most,
                        std::vector<CrowdedPosition>& positions,
                        const std::function<void(double share)>& progress) {
  SkinLoss loss;
  if (positions.empty()) return loss;
  Expressions expressions(source);
  std::vector<Form> forms(positions.size());
  for (size_t i = 0; i < positions.size(); ++i) {
    forms[i].size = positions[i].influences.size();
    forms[i].values.resize(forms[i].size * forms[i].size);
  }
  std::vector<Vec3d> errors;
  for_each_pose(source, positions, expressions, progress, 0, [&](uint32_t, size_t i) {
    errors.clear();
    for (const Influence& influence : positions[i].influences) {
      errors.push_back(expressions.error(positions[i].position, influence.joint));
    }
    forms[i].add(errors);
  });
  const std::vector<CrowdedPosition> all = positions;
  for (size_t i = 0; i < positions.size(); ++i) reduce(forms[i], most, positions[i].influences);

  double squares = 0, largest = 0;
  size_t count = 0;
  for_each_pose(source, all, expressions, progress, 0.5, [&](uint32_t control, size_t i) {
    Vec3d off;
    for (const Influence& influence : positions[i].influences) {
      off += expressions.error(positions[i].position, influence.joint) * influence.weight;
    }
    const double squared = dot(off, off);
    squares += squared;
    ++count;
    if (squared <= largest) return;
    largest = squared;
    loss.expression = source.name(MIEN_KIND_RAW_CONTROL, control);
  });
  const double unit = source.meters_per_unit();
  if (count != 0) loss.residual.rms = std::sqrt(squares / static_cast<double>(count)) * unit;
  loss.residual.max = std::sqrt(largest) * unit;
  return loss;
}

}  // namespace mien::gltf
