// SPDX-License-Identifier: MIT
// How much each place follows the jaw, by landmarks alone: for meshes without a shape that opens it.
#pragma once

#include "author/place/face_mask.h"

namespace mien::author {

/// Where the jaw turns, from lips, chin and nose, by the proportions of a human head.
Vec3 jaw_by_proportions(const Landmarks& landmarks);

/// 1 on chin and lower lip, 0 above the mouth and at the neck, smooth in the cheeks between, for every vertex.
/// Jaw, lips and chin are known. Fails with kMemory.
Status make_jaw_share(Placing& placing, const NeckCut& cut, Span<float>& out);

}  // namespace mien::author
