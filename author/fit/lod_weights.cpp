// SPDX-License-Identifier: MIT
#include "author/fit/lod_weights.h"

#include <algorithm>

#include "author/base/dna_making.h"

namespace mien::author {

bool make_weights_like(const SkinWeights& other, Arena& arena, SkinWeights& out) {
  out.m = other.m;
  return make(arena, other.joints.count, out.joints) &&
         make(arena, other.weights.count, out.weights);
}

bool collapse_weights(const Placement& placement, uint32_t kept, const SkinWeights& from,
                      Arena& scratch, SkinWeights& to) {
  Span<uint16_t> heir;
  if (!make(scratch, placement.bones.count, heir)) return false;
  for (uint32_t j = 0; j < heir.count; ++j) {
    heir[j] = static_cast<uint16_t>(j);
    if (placement.bones[j].kind != BoneKind::kFacial || j - placement.first_facial < kept) continue;
    double nearest = HUGE_VAL;
    for (uint32_t k = placement.first_facial; k < placement.first_facial + kept; ++k) {
      const Vec3 d = placement.bones[k].position - placement.bones[j].position;
      if (dot(d, d) < nearest) {
        nearest = dot(d, d);
        heir[j] = static_cast<uint16_t>(k);
      }
    }
  }
  const uint32_t m = from.m;
  for (size_t first = 0; first < from.weights.count; first += m) {
    uint16_t* joints = &to.joints[first];
    float* weights = &to.weights[first];
    uint32_t count = 0;
    for (uint32_t i = 0; i < m; ++i) {
      const float weight = from.weights[first + i];
      if (!(weight > 0)) continue;
      const uint16_t joint = heir[from.joints[first + i]];
      uint32_t at = 0;
      while (at < count && joints[at] != joint) ++at;
      if (at == count) {
        joints[count] = joint;
        weights[count++] = 0;
      }
      weights[at] += weight;
    }
    for (uint32_t i = count; i < m; ++i) {
      joints[i] = 0;
      weights[i] = 0;
    }
    // Largest first; insertion sort, as there are few.
    for (uint32_t i = 1; i < count; ++i) {
      for (uint32_t k = i; k > 0 && weights[k] > weights[k - 1]; --k) {
        std::swap(weights[k], weights[k - 1]);
        std::swap(joints[k], joints[k - 1]);
      }
    }
  }
  return true;
}

}  // namespace mien::author
