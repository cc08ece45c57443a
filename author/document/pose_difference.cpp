// SPDX-License-Identifier: MIT
#include "author/document/pose_difference.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "author/base/dna_making.h"
#include "author/document/control_poses.h"
#include "author/document/document.h"
#include "author/document/rows.h"

namespace mien::author {

namespace {

class Measurement {
 public:
  Measurement(const dna::DnaView& before, const dna::DnaView& after, const Allocator& allocator)
      : view_(before), after_(after), allocator_(allocator), arena_(allocator) {}

  bool prepare() {
    joints_ = view_.defn.joint_names.count;
    const uint32_t channels = view_.defn.channel_names.count;
    const dna::Array<uint16_t> meshes = view_.defn.lod_meshes.at(0);
    if (!make(arena_, meshes.count, meshes_) || !make(arena_, size_t{meshes.count} + 1, firsts_))
      return false;
    uint32_t used = 0;
    for (uint32_t i = 0; i < meshes.count && meshes[i] < view_.geom.meshes.count; ++i) {
      meshes_[used++] = meshes[i];
      firsts_[used] = firsts_[used - 1] + mesh(i).positions.xs.count;
    }
    meshes_ = meshes_.first(used);
    const uint32_t positions = firsts_[used];
    return poses_[0].prepare(view_, arena_) && poses_[1].prepare(after_, arena_) &&
           make(arena_, kMaxControls, controls_) && make(arena_, channels, weights_) &&
           make(arena_, joints_, skins_[0]) && make(arena_, joints_, skins_[1]) &&
           make(arena_, joints_, bounds_) && make(arena_, joints_, boxes_) &&
           make(arena_, positions, offsets_) && make(arena_, positions, seen_) &&
           make(arena_, channels, reaches_) && collect_positions() && collect_targets(channels);
  }

  /// False if memory ran out. `out` is larger than the distance of any position in the pose.
  bool bound(uint32_t pose, double& out) {
    out = 0;
    if (!skin(pose)) return false;
    for (uint32_t j = 0; j < joints_; ++j) out = std::max(out, bounds_[j]);
    return true;
  }

  /// Raises `worst` to the largest distance in a pose. False if memory ran out.
  bool measure(uint32_t pose, PoseDifference& worst) {
    if (!skin(pose)) return false;
    for (uint32_t c = 0; c < weights_.count; ++c) {
      if (weights_[c] != 0) shape(c, weights_[c]);
    }
    ++stamp_;
    for (uint32_t j = 0; j < joints_; ++j) {
      if (bounds_[j] == 0 || bounds_[j] < worst.distance) continue;
      uint32_t i = 0;
      for (uint32_t at : positions_[j]) {
        while (at >= firsts_[i + 1]) ++i;
        if (seen_[at] == stamp_) continue;
        seen_[at] = stamp_;
        measure_position(pose, i, at - firsts_[i], worst);
      }
    }
    for (uint32_t c = 0; c < weights_.count; ++c) {
      if (weights_[c] != 0) shape(c, 0);
    }
    return true;
  }

  const ControlPoses& poses() const { return poses_[0]; }
  Span<double> controls() { return controls_; }

 private:
  const dna::Mesh& mesh(uint32_t i) const { return view_.geom.meshes[meshes_[i]]; }

  /// The positions that each joint moves, and the box around them.
  bool collect_positions() {
    const auto visit = [&](const auto& put) {
      for (uint32_t i = 0; i < meshes_.count; ++i) {
        const dna::Mesh& of = mesh(i);
        const uint32_t count = std::min(of.skin_weights.count, of.positions.xs.count);
        for (uint32_t v = 0; v < count; ++v) {
          const dna::VertexSkinWeights& vertex = of.skin_weights[v];
          for (uint32_t k = 0; k < vertex.weights.count; ++k)
            put(vertex.joint_indices[k], firsts_[i] + v);
        }
      }
    };
    if (!make_rows(arena_, joints_, visit, positions_)) return false;
    for (uint32_t i = 0; i < meshes_.count; ++i) {
      for (const dna::VertexSkinWeights& vertex : mesh(i).skin_weights) {
        double sum = 0;
        for (uint32_t k = 0; k < vertex.weights.count; ++k)
          sum += std::abs(double{vertex.weights[k]});
        most_weight_ = std::max(most_weight_, sum);
      }
    }
    for (uint32_t j = 0; j < joints_; ++j) {
      uint32_t i = 0;
      bool first = true;
      for (uint32_t at : positions_[j]) {
        while (at >= firsts_[i + 1]) ++i;
        const Vec3 p = vector_of(mesh(i).positions, at - firsts_[i]);
        if (first) boxes_[j] = {p, p};
        first = false;
        add(boxes_[j], p);
      }
    }
    return true;
  }

  /// The targets of each channel, as mesh and number in one row of all, and their longest delta.
  bool collect_targets(uint32_t channels) {
    const auto visit = [&](const auto& put) {
      uint32_t number = 0;
      for (uint32_t i = 0; i < meshes_.count; ++i) {
        for (const dna::BlendShapeTarget& target : mesh(i).blend_shape_targets)
          put(target.channel_index, number++);
      }
    };
    uint32_t count = 0;
    for (uint32_t i = 0; i < meshes_.count; ++i) count += mesh(i).blend_shape_targets.count;
    if (!make_rows(arena_, channels, visit, targets_) || !make(arena_, count, target_meshes_))
      return false;
    uint32_t number = 0;
    for (uint32_t i = 0; i < meshes_.count; ++i) {
      for (uint32_t t = 0; t < mesh(i).blend_shape_targets.count; ++t)
        target_meshes_[number++] = {i, t};
    }
    std::fill(reaches_.begin(), reaches_.end(), -1.0);
    return true;
  }

  /// Adds a channel to offsets_, or sets what it moves to 0.
  void shape(uint32_t channel, double weight) {
    for (uint32_t number : targets_[channel]) {
      const TargetPlace& place = target_meshes_[number];
      const dna::BlendShapeTarget& target = mesh(place.mesh).blend_shape_targets[place.target];
      for (uint32_t i = 0; i < target.vertex_indices.count; ++i) {
        Vec3& offset = offsets_[firsts_[place.mesh] + target.vertex_indices[i]];
        offset = weight == 0 ? Vec3{} : offset + vector_of(target.deltas, i) * weight;
      }
    }
  }

  /// The length of the longest delta of a channel.
  double reach(uint32_t channel) {
    double& longest = reaches_[channel];
    if (longest >= 0) return longest;
    double squares = 0;
    for (uint32_t number : targets_[channel]) {
      const TargetPlace& place = target_meshes_[number];
      const dna::BlendShapeTarget& target = mesh(place.mesh).blend_shape_targets[place.target];
      for (uint32_t i = 0; i < target.vertex_indices.count; ++i) {
        const Vec3 delta = vector_of(target.deltas, i);
        squares = std::max(squares, dot(delta, delta));
      }
    }
    return longest = std::sqrt(squares);
  }

  /// Skin matrices of both rigs in a pose, weights of channels, and a bound for each joint: how far apart the two
  /// matrices put the positions of the joint. A difference of linear maps is largest at a corner of a box.
  bool skin(uint32_t pose) {
    poses_[0].controls(pose, controls_);
    poses_[0].channels(controls_, weights_);
    for (int k = 0; k < 2; ++k) {
      Arena scratch(allocator_);
      if (!poses_[k].skin(controls_, scratch, skins_[k])) return false;
    }
    double shift = -1;  // how far targets move a position
    for (uint32_t j = 0; j < joints_; ++j) {
      bounds_[j] = 0;
      const Rigid &a = skins_[0][j], &b = skins_[1][j];
      const Box& box = boxes_[j];
      if (positions_[j].count == 0 || memcmp(&a, &b, sizeof(Rigid)) == 0) continue;
      if (shift < 0) {
        shift = 0;
        for (uint32_t c = 0; c < weights_.count; ++c) {
          if (weights_[c] != 0) shift += std::abs(weights_[c]) * reach(c);
        }
      }
      Rigid difference;
      difference.place = b.place - a.place;
      double squares = 0, longest = 0;
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
          const double value = b.turn.m[r][c] - a.turn.m[r][c];
          difference.turn.m[r][c] = value;
          squares += value * value;
        }
      }
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3 at = {corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                         corner & 4 ? box.high.z : box.low.z};
        longest = std::max(longest, length(apply(at, difference)));
      }
      // A little more than computed, for what rounding does to positions.
      const double size = length(box.low) + length(box.high) + shift + length(a.place);
      bounds_[j] =
          most_weight_ * ((longest + std::sqrt(squares) * shift) * (1 + 1e-9) + 1e-12 * size);
    }
    return true;
  }

  void measure_position(uint32_t pose, uint32_t i, uint32_t v, PoseDifference& worst) {
    const dna::VertexSkinWeights& vertex = mesh(i).skin_weights[v];
    const Vec3 rest = vector_of(mesh(i).positions, v) + offsets_[firsts_[i] + v];
    const Vec3 apart = ControlPoses::skinned(vertex, skins_[0], rest) -
                       ControlPoses::skinned(vertex, skins_[1], rest);
    const double distance = length(apart);
    const PoseDifference found = {distance, pose, meshes_[i], v};
    // Of equal ones the first, whatever the order of the search.
    const bool first = std::tie(found.control, i, found.position) <
                       std::tie(worst.control, worst_mesh_, worst.position);
    if (distance < worst.distance || distance == 0 || (distance == worst.distance && !first))
      return;
    worst = found;
    worst_mesh_ = i;
  }

  struct TargetPlace {
    uint32_t mesh, target;
  };

  const dna::DnaView &view_, &after_;
  const Allocator& allocator_;
  Arena arena_;
  ControlPoses poses_[2];
  uint32_t joints_ = 0;
  Span<uint32_t> meshes_, firsts_;  // of LOD 0, and the first of their positions among all
  Rows positions_, targets_;        // of joints; of channels
  Span<TargetPlace> target_meshes_;
  double most_weight_ = 0;  // sum of the weights of a position
  Span<Box> boxes_;         // [joint] around its positions
  Span<double> reaches_;    // [channel] below 0: not measured yet

  Span<double> controls_, weights_;  // of the pose
  Span<Rigid> skins_[2];
  Span<double> bounds_;  // [joint]
  Span<Vec3> offsets_;   // [position] by targets
  Span<uint32_t> seen_;  // [position] in which measurement
  uint32_t stamp_ = 0, worst_mesh_ = 0;
};

struct BoundedPose {
  double bound;
  uint32_t pose;
};

}  // namespace

Status measure_difference(const dna::DnaView& before, const dna::DnaView& after,
                          Span<const uint8_t> changed, const Allocator& allocator,
                          PoseDifference& out, Error& error) {
  out = {};
  Arena arena(allocator);
  Measurement measurement(before, after, allocator);
  Span<BoundedPose> poses;
  if (!measurement.prepare() || !make(arena, measurement.poses().count(), poses))
    return no_memory(error, "measuring");
  size_t count = 0;
  for (uint32_t p = 0; p < measurement.poses().count(); ++p) {
    const Span<double> controls = measurement.controls();
    measurement.poses().controls(p, controls);
    bool concerned = false;
    for (uint32_t c = 0; c < controls.count && c < changed.count; ++c)
      concerned |= changed[c] && controls[c] != 0;
    if (!concerned) continue;
    double bound = 0;
    if (!measurement.bound(p, bound)) return no_memory(error, "measuring");
    if (bound > 0) poses[count++] = {bound, p};
  }
  std::sort(poses.data, poses.data + count, [](const BoundedPose& a, const BoundedPose& b) {
    return a.bound != b.bound ? a.bound > b.bound : a.pose < b.pose;
  });
  for (size_t i = 0; i < count && poses[i].bound >= out.distance; ++i) {
    if (!measurement.measure(poses[i].pose, out)) return no_memory(error, "measuring");
  }
  return Status::kOk;
}

}  // namespace mien::author
