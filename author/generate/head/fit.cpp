// SPDX-License-Identifier: MIT
#include "author/generate/head/fit.h"

#include <algorithm>

#include "author/base/cholesky.h"

namespace mien::head {

using author::Cholesky;
using author::make;
using author::motion;

namespace {

JointDelta delta_of(Vec3 translation, Vec3 rotation) {
  const auto as_float = [](double x) { return static_cast<float>(x); };
  return {{as_float(translation.x), as_float(translation.y), as_float(translation.z)},
          {as_float(rotation.x), as_float(rotation.y), as_float(rotation.z)}};
}

/// Sets the turns that are given by design: those of all but skin joints.
void set_designed(const Shapes& shapes, const Skeleton& skeleton, const JointDeltas& out) {
  for (uint32_t s = 0; s < shapes.count(); ++s) {
    const JointTurns left = shapes.turns(s, 1), right = shapes.turns(s, -1);
    out.at(s, skeleton.jaw) = delta_of(left.jaw_shift, {left.jaw_open, 0, 0});
    for (int i = 0; i < 2; ++i) {
      const JointTurns& t = i == 0 ? left : right;
      const double outwards = i == 0 ? t.eye_out : -t.eye_out;
      out.at(s, skeleton.eye[i]) = delta_of({}, {-t.eye_up, outwards, 0});
      out.at(s, skeleton.upper_lid[i]) =
          delta_of({}, {-t.upper_lid * skeleton.upper_lid_angle, 0, 0});
      out.at(s, skeleton.half_lid[i]) =
          delta_of({}, {-0.5 * t.upper_lid * skeleton.upper_lid_angle, 0, 0});
      out.at(s, skeleton.lower_lid[i]) =
          delta_of({}, {t.lower_lid * skeleton.lower_lid_angle, 0, 0});
    }
    // The tip is raised behind the lower incisors, then goes forward over them and down between both rows.
    const double up = left.tongue_up, forward = left.tongue;
    out.at(s, skeleton.tongue[0]) = delta_of(
        {0, 0.69 * up - 0.27 * forward, 1.8 * forward - 0.3 * up}, {0.4 * forward - 6 * up, 0, 0});
    out.at(s, skeleton.tongue[1]) = delta_of({0, 0.10 * up, 1.5 * forward}, {7 * forward, 0, 0});
    out.at(s, skeleton.tongue[2]) = delta_of({0, 0, 1.3 * forward}, {14 * up + 5 * forward, 0, 0});
  }
}

/// Edges of lips have to meet, even where no blend shape helps.
double importance(const Vertex& v) { return v.edge ? 20 : 1; }

}  // namespace

void pose_joints(const Skeleton& skeleton, const JointDeltas& deltas, const uint32_t* active,
                 uint32_t active_count, Affine* out) {
  for (uint32_t j = 0; j < skeleton.count; ++j) {
    double values[6] = {};
    for (uint32_t a = 0; a < active_count; ++a) {
      const JointDelta& d = deltas.at(active[a], j);
      for (int k = 0; k < 3; ++k) {
        values[k] += d.translation[k];
        values[3 + k] += d.rotation[k];
      }
    }
    const Joint& joint = skeleton.joints[j];
    const Affine local = motion(values + 3, joint.position, {values[0], values[1], values[2]});
    out[j] = j == joint.parent ? local : out[joint.parent] * local;  // parents come first
  }
}

bool fit_joints(const Shapes& shapes, const Skeleton& skeleton, const HalfMesh& mesh,
                Displacements& displacements, Arena& scratch, JointDeltas& out) {
  const uint32_t joints = skeleton.count, shape_count = shapes.count();
  out.joint_count = joints;
  Span<Weights> weights;
  Span<uint16_t> row_of, joint_of;  // joint -> row of the system, and back
  Span<Affine> pose;
  if (!make(scratch, size_t{joints} * shape_count, out.items) ||
      !make(scratch, mesh.vertices.count(), weights) || !make(scratch, joints, row_of) ||
      !make(scratch, joints, joint_of) || !make(scratch, joints, pose)) {
    return false;
  }
  set_designed(shapes, skeleton, out);

  uint32_t rows = 0;
  for (uint32_t j = 0; j < joints; ++j) {
    if (skeleton.joints[j].drive != Drive::kFit) continue;
    joint_of[rows] = static_cast<uint16_t>(j);
    row_of[j] = static_cast<uint16_t>(rows++);
  }
  Span<double> matrix;
  Span<Vec3> right_side;
  if (!make(scratch, size_t{rows} * rows, matrix) || !make(scratch, rows, right_side)) return false;

  // Each vertex counts for itself and for its mirror image.
  const auto is_fitted = [&](uint16_t j) { return skeleton.joints[j].drive == Drive::kFit; };
  const auto twin = [&](uint16_t j) { return skeleton.joints[j].twin; };
  for (uint32_t i = 0; i < mesh.vertices.count(); ++i) {
    displacements.find(mesh.vertices[i]);
    weights[i] = weigh(skeleton, 0, mesh.vertices[i], mesh.on_plane(i));
    const Weights& w = weights[i];
    for (uint32_t a = 0; a < w.count; ++a) {
      for (uint32_t b = 0; b < w.count; ++b) {
        if (!is_fitted(w.joints[a]) || !is_fitted(w.joints[b])) continue;
        const double product = importance(mesh.vertices[i]) * static_cast<double>(w.values[a]) *
                               static_cast<double>(w.values[b]);
        matrix[size_t{row_of[w.joints[a]]} * rows + row_of[w.joints[b]]] += product;
        matrix[size_t{row_of[twin(w.joints[a])]} * rows + row_of[twin(w.joints[b])]] += product;
      }
    }
  }
  double trace = 0;
  for (uint32_t r = 0; r < rows; ++r) trace += matrix[size_t{r} * rows + r];
  for (uint32_t r = 0; r < rows; ++r) matrix[size_t{r} * rows + r] += 2e-4 * trace / rows;
  Cholesky system(matrix.data, rows);
  system.factor();

  for (uint32_t s = 0; s < shape_count; ++s) {
    const uint32_t other = shapes.twin(s);
    if (other < s) {  // solved already, as its mirror image
      for (uint32_t j = 0; j < joints; ++j) {
        if (!is_fitted(static_cast<uint16_t>(j))) continue;
        JointDelta d = out.at(other, twin(static_cast<uint16_t>(j)));
        d.translation[0] = -d.translation[0];
        out.at(s, j) = d;
      }
      continue;
    }
    std::fill(right_side.begin(), right_side.end(), Vec3());
    for (uint32_t half = 0; half < 2; ++half) {
      const uint32_t shape = half == 0 ? s : other;
      pose_joints(skeleton, out, &shape, 1, pose.data);
      for (uint32_t i = 0; i < mesh.vertices.count(); ++i) {
        const Vertex& v = mesh.vertices[i];
        const Vec3 wanted = displacements.at(shape, v) -
                            (skin(pose.data, influences(weights[i]), v.position) - v.position);
        for (uint32_t a = 0; a < weights[i].count; ++a) {
          const uint16_t j = weights[i].joints[a];
          if (!is_fitted(j)) continue;
          const double w = static_cast<double>(weights[i].values[a]);
          Vec3& sum = right_side[row_of[half == 0 ? j : twin(j)]];
          sum = sum + (half == 0 ? wanted : mirrored(wanted)) * (w * importance(v));
        }
      }
    }
    system.solve(right_side.data);
    const bool alone = other == s;  // its own mirror image: made exactly symmetric
    // Below the jaw, translations are in the jaw's frame, turned by the total opening at this shape.
    double opened = shapes.turns(s, 1).jaw_open;
    if (s >= kExpressionCount) {
      const Corrective& c = shapes.corrective(s - kExpressionCount);
      opened += shapes.turns(c.first, 1).jaw_open + shapes.turns(c.second, 1).jaw_open;
    }
    const double back[3] = {-opened, 0, 0};
    const Affine to_jaw = motion(back, {}, {});
    for (uint32_t r = 0; r < rows; ++r) {
      const uint16_t j = joint_of[r];
      Vec3 t = right_side[r];
      if (alone) t = (t + mirrored(right_side[row_of[twin(j)]])) * 0.5;
      if (skeleton.joints[j].below) t = to_jaw(t);
      if (dot(t, t) < 0.012 * 0.012) t = {};
      out.at(s, j) = delta_of(t, {});
    }
  }
  return true;
}

}  // namespace mien::head
