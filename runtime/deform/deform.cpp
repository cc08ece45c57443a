// SPDX-License-Identifier: MIT
#include "runtime/deform/deform.h"

#include <cmath>
#include <cstring>

namespace mien {
namespace {

constexpr float kLeastChannelWeight = 1e-5f;

/// Unit length; `otherwise` if there is no direction.
void put_unit(const float* v, const float* otherwise, float* out) {
  const float squared = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  if (!(squared > 1e-36f)) {
    memcpy(out, otherwise, 3 * sizeof(float));
    return;
  }
  const float scale = 1.0f / std::sqrt(squared);
  for (int i = 0; i < 3; ++i) out[i] = v[i] * scale;
}

void cross(const float* a, const float* b, float* out) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

void skin_block(const Deformer& deformer, const DeformMesh& mesh, const Pose& pose, uint32_t block,
                bool normals, PosedMesh& out) {
  const uint32_t first = block * kBlockPlaces;
  const uint32_t end = std::min(first + kBlockPlaces, mesh.position_count);
  float moved[kBlockPlaces * 4];
  memcpy(moved, mesh.neutral.data + size_t{first} * 4, (end - first) * 4 * sizeof(float));
  for (uint32_t i = mesh.first_piece[block]; i < mesh.first_piece[block + 1]; ++i) {
    const TargetPiece& piece = mesh.pieces[i];
    const float weight = pose.channels[mesh.target_channels[piece.target]];
    if (std::fabs(weight) < kLeastChannelWeight) continue;
    for (size_t d = piece.first_delta; d < piece.first_delta + piece.count; ++d) {
      for (int k = 0; k < 3; ++k)
        moved[mesh.delta_places[d] * 4 + k] += weight * mesh.deltas[d * 3 + k];
    }
  }
  (void)deformer;
  for (const SkinRun& run : mesh.runs) {
    const uint32_t from = std::max(run.first, first), to = std::min(run.first + run.count, end);
    for (uint32_t place = from; place < to; ++place) {
      const float* v = moved + (place - first) * 4;
      float m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
      if (run.influences != 0) memset(m, 0, sizeof(m));
      const size_t row = run.first_weight + size_t{place - run.first} * run.influences;
      for (size_t k = row; k < row + run.influences; ++k) {
        const float* skin = pose.joints.skin.data + mesh.joints[k] * kMatrixFloats;
        for (int i = 0; i < 16; ++i) m[i] += mesh.weights[k] * skin[i];
      }
      float* p = out.positions.data + size_t{mesh.position_at[place]} * 3;
      for (int r = 0; r < 3; ++r)
        p[r] = m[r] * v[0] + m[4 + r] * v[1] + m[8 + r] * v[2] + m[12 + r];
      if (!normals) continue;
      float c[9];
      for (int i = 0; i < 3; ++i) memcpy(c + i * 3, m + i * 4, 3 * sizeof(float));
      if (pose.joints.skewed) {
        float axes[9];
        memcpy(axes, c, sizeof(axes));
        cross(axes + 3, axes + 6, c);
        cross(axes + 6, axes, c + 3);
        cross(axes, axes + 3, c + 6);
      }
      for (uint32_t i = mesh.first_corner[place]; i < mesh.first_corner[place + 1]; ++i) {
        const size_t vertex = mesh.corners[i] & ~kHardCorner;
        const float* n = mesh.normals.data + vertex * 3;
        float turned[3];
        for (int r = 0; r < 3; ++r) turned[r] = c[r] * n[0] + c[3 + r] * n[1] + c[6 + r] * n[2];
        put_unit(turned, n, out.normals.data + vertex * 3);
      }
    }
  }
}

void recompute_normals(const DeformMesh& mesh, Pose& pose, PosedMesh& out) {
  for (uint32_t f = 0; f < mesh.face_count(); ++f) {
    const uint32_t* corners = mesh.faces.data + size_t{f} * 4;
    float a[3], b[3];
    for (int k = 0; k < 3; ++k) {
      a[k] = out.positions[size_t{corners[2]} * 3 + k] - out.positions[size_t{corners[0]} * 3 + k];
      b[k] = out.positions[size_t{corners[3]} * 3 + k] - out.positions[size_t{corners[1]} * 3 + k];
    }
    cross(a, b, pose.areas.data + size_t{f} * 4);
  }
  for (uint32_t place = 0; place < mesh.position_count; ++place) {
    float sum[3] = {};
    for (uint32_t i = mesh.first_touching[place]; i < mesh.first_touching[place + 1]; ++i) {
      for (int k = 0; k < 3; ++k) sum[k] += pose.areas[size_t{mesh.touching[i]} * 4 + k];
    }
    for (uint32_t i = mesh.first_corner[place]; i < mesh.first_corner[place + 1]; ++i) {
      const size_t vertex = mesh.corners[i] & ~kHardCorner;
      const float* n = mesh.normals.data + vertex * 3;
      float* to = out.normals.data + vertex * 3;
      const float zero[3] = {};
      float now[3];
      put_unit(sum, zero, now);
      if (!(mesh.corners[i] & kHardCorner)) {
        put_unit(sum, n, to);
        continue;
      }
      const float* was = mesh.neutral_directions.data + size_t{place} * 4;
      float axis[3], turned[3];
      cross(was, now, axis);
      cross(axis, n, turned);
      const float c = was[0] * now[0] + was[1] * now[1] + was[2] * now[2];
      const float along =
          (axis[0] * n[0] + axis[1] * n[1] + axis[2] * n[2]) / std::max(1 + c, 1e-6f);
      for (int k = 0; k < 3; ++k) turned[k] += c * n[k] + axis[k] * along;
      put_unit(turned, n, to);
    }
  }
}

}  // namespace

void deform(const Deformer& deformer, Span<Pose* const> poses, uint32_t m, Normals normals,
            const ParallelFor&) {
  const DeformMesh& mesh = deformer.meshes[m];
  for (Pose* pose : poses) {
    PosedMesh& out = pose->meshes[m];
    for (uint32_t b = 0; b < mesh.block_count(); ++b) {
      skin_block(deformer, mesh, *pose, b, normals == Normals::kSkinned, out);
    }
    if (normals == Normals::kRecomputed) recompute_normals(mesh, *pose, out);
  }
}

}  // namespace mien
