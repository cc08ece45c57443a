// SPDX-License-Identifier: MIT
// Kernels of poses and deformation on every instruction set: all counts, and the same bits on every
// machine, which only recorded ones can show. The data is made of integers: no C library rounds it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "simd/kernels.h"

namespace mien {
namespace {

constexpr uint32_t kJoints = 40;
constexpr uint32_t kPlaces = 61;
constexpr uint32_t kFaces = 53;
constexpr uint32_t kMaxInfluences = 13;

/// -1 ... 1 in steps of 2^-23.
class Numbers {
 public:
  explicit Numbers(uint32_t seed) : state_(seed * 2654435761u + 12345u) {}
  uint32_t below(uint32_t limit) {
    state_ = state_ * 1664525u + 1013904223u;
    return static_cast<uint32_t>((uint64_t{state_} * limit) >> 32);
  }
  float next() { return static_cast<float>(int32_t(below(1u << 24)) - (1 << 23)) / (1 << 23); }

 private:
  uint32_t state_;
};

/// Floats at an address that suits every vector.
struct Aligned {
  std::vector<float> memory;
  float* data;
  size_t count;

  Aligned(size_t n, Numbers* numbers) : memory(n + 16), count(n) {
    data = memory.data();
    while (reinterpret_cast<uintptr_t>(data) % 64 != 0) ++data;
    for (size_t i = 0; i < n && numbers; ++i) data[i] = numbers->next();
  }
  Aligned(const Aligned&) = delete;
};

class Bits {
 public:
  void add(const float* values, size_t count) {
    for (size_t i = 0; i < count; ++i) {
      uint32_t bits;
      memcpy(&bits, values + i, sizeof(bits));
      for (int k = 0; k < 4; ++k) hash_ = (hash_ ^ (bits >> 8 * k & 255)) * 1099511628211u;
    }
  }
  uint64_t get() const { return hash_; }

 private:
  uint64_t hash_ = 14695981039346656037u;
};

std::vector<const KernelTable*> present() {
  std::vector<const KernelTable*> tables;
  for (uint32_t i = 1; i < kIsaCount; ++i) {
    if (const KernelTable* table = kernels_for(static_cast<Isa>(i))) tables.push_back(table);
  }
  return tables;
}
bool fuses(const KernelTable* table) {
  return table->isa != Isa::kScalar && table->isa != Isa::kSse2;
}

// Joints ------------------------------------------------------------------------------------------

uint64_t joint_bits(const KernelTable& kernels, uint32_t seed, bool quaternions) {
  Numbers numbers(seed);
  constexpr uint32_t kBlocks = (kJoints + kBlockLanes - 1) / kBlockLanes;
  Aligned neutral(kBlocks * kNeutralRows * kBlockLanes, &numbers);
  Aligned deltas(kBlocks * kDeltaRows * kBlockLanes, &numbers);
  Aligned locals(kBlocks * kLocalRows * kBlockLanes, nullptr);
  Aligned inverse(kJoints * 16, &numbers), model(kJoints * 16, nullptr),
      skin(kJoints * 16, nullptr);
  JointLocalArgs local = {neutral.data, deltas.data, locals.data, kBlocks, {2, 0, 1}, quaternions};
  kernels.joint_locals(local);
  uint16_t order[kJoints], parents[kJoints];
  uint8_t still[kJoints];
  for (uint16_t j = 0; j < kJoints; ++j) {
    order[j] = j;
    parents[j] = static_cast<uint16_t>(j % 7 == 0 ? j : numbers.below(j));
    still[j] = numbers.below(3) == 0;
    for (int k = 3; k < 16; k += 4) inverse.data[j * 16 + k] = k == 15;
  }
  JointTreeArgs tree = {order,        parents,    locals.data, still,
                        inverse.data, model.data, skin.data,   kJoints};
  kernels.joint_tree(tree);
  Bits bits;
  bits.add(locals.data, locals.count);
  bits.add(model.data, model.count);
  bits.add(skin.data, skin.count);
  for (uint32_t j = 0; j < kJoints; ++j) {
    for (uint32_t k = 3; k < 16; k += 4) {
      EXPECT_EQ(model.data[j * 16 + k], k == 15);
      EXPECT_EQ(skin.data[j * 16 + k], k == 15);
    }
    if (still[j]) {
      const float* above = skin.data + parents[j] * 16;
      EXPECT_TRUE(parents[j] == j || memcmp(skin.data + j * 16, above, 64) == 0);
    }
  }
  return bits.get();
}

TEST(KernelsDeform, JointsHaveTheSameBitsEverywhere) {
  for (const KernelTable* kernels : present()) {
    SCOPED_TRACE(kernels->name);
    EXPECT_EQ(joint_bits(*kernels, 1, false), 7918170621521290643u);
    EXPECT_EQ(joint_bits(*kernels, 2, true), 17106545933319630754u);
  }
}

// Meshes ------------------------------------------------------------------------------------------

/// Positions of a piece of mesh, its corners and faces; one corner in five is a hard edge, one face
/// in eight has no area.
struct Piece {
  Numbers numbers;
  Aligned places, weights, matrices, normals, directions;
  std::vector<uint16_t> joints;
  std::vector<uint32_t> position_at, first_corner = {0}, corners, faces, first_touching = {0},
                                     touching;

  explicit Piece(uint32_t seed)
      : numbers(seed), places(kPlaces * 4, &numbers), weights(kPlaces * kMaxInfluences, &numbers),
        matrices(kJoints * 16, &numbers), normals(kPlaces * 3 * 3 + 1, &numbers),
        directions(kPlaces * 4, &numbers) {
    for (uint32_t i = 0; i < kPlaces * kMaxInfluences; ++i) {
      joints.push_back(static_cast<uint16_t>(numbers.below(kJoints)));
    }
    for (uint32_t i = 0; i < kPlaces; ++i) {
      position_at.push_back((i * 17 + 5) % kPlaces);
      for (uint32_t n = numbers.below(3); n != 0; --n) {
        const uint32_t vertex = static_cast<uint32_t>(corners.size());
        corners.push_back(numbers.below(5) == 0 ? vertex | kHardCorner : vertex);
      }
      first_corner.push_back(static_cast<uint32_t>(corners.size()));
      for (uint32_t n = numbers.below(5); n != 0; --n) touching.push_back(numbers.below(kFaces));
      first_touching.push_back(static_cast<uint32_t>(touching.size()));
    }
    for (uint32_t f = 0; f < kFaces; ++f) {
      for (int k = 0; k < 4; ++k) faces.push_back(numbers.below(kPlaces));
      if (f % 8 == 0) faces[f * 4 + 2] = faces[f * 4];
    }
  }

  /// Positions and normals of the first `count` places.
  std::vector<float> skinned(const KernelTable& kernels, uint32_t count, uint32_t influences,
                             SkinNormals mode) {
    std::vector<float> positions(kPlaces * 3, -9), turned(corners.size() * 3, -9);
    const SkinArgs args = {places.data,
                           weights.data,
                           joints.data(),
                           matrices.data,
                           position_at.data(),
                           positions.data(),
                           first_corner.data(),
                           corners.data(),
                           normals.data,
                           turned.data(),
                           count,
                           influences,
                           mode};
    kernels.skin_places(args);
    positions.insert(positions.end(), turned.begin(), turned.end());
    return positions;
  }
  std::vector<float> recomputed(const KernelTable& kernels, uint32_t count) {
    Aligned positions(kPlaces * 3 + 1, nullptr), areas(kFaces * 4, nullptr);
    for (uint32_t i = 0; i < kPlaces * 3; ++i) positions.data[i] = places.data[i / 3 * 4 + i % 3];
    kernels.face_areas({positions.data, faces.data(), areas.data, kFaces});
    std::vector<float> result(corners.size() * 3, -9);
    kernels.sum_normals({areas.data, first_touching.data(), touching.data(), first_corner.data(),
                         corners.data(), normals.data, directions.data, result.data(), count});
    for (uint32_t f = 0; f < kFaces; ++f) {
      result.insert(result.end(), areas.data + f * 4, areas.data + f * 4 + 3);
    }
    return result;
  }
  std::vector<float> moved(const KernelTable& kernels, uint32_t count) {
    std::vector<uint16_t> at;
    for (uint32_t i = 0; i < count; ++i) at.push_back(static_cast<uint16_t>(i * 7 % kPlaces));
    Aligned result(kPlaces * 4, nullptr);
    std::copy(places.data, places.data + kPlaces * 4, result.data);
    kernels.add_target({normals.data, at.data(), result.data, 0.7f, count});
    std::vector<float> points;
    for (uint32_t i = 0; i < kPlaces; ++i) {
      points.insert(points.end(), result.data + i * 4, result.data + i * 4 + 3);
    }
    return points;
  }
};

void expect_near(const std::vector<float>& a, const std::vector<float>& b, float tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], tolerance) << i;
}

TEST(KernelsDeform, MeshesHaveTheSameBitsWithinAFamily) {
  for (const KernelTable* kernels : present()) {
    SCOPED_TRACE(kernels->name);
    Piece piece(3);
    Bits skin, normals, targets;
    for (uint32_t influences = 1; influences <= kMaxInfluences; ++influences) {
      for (SkinNormals mode : {SkinNormals::kNone, SkinNormals::kMatrix, SkinNormals::kCofactors}) {
        const std::vector<float> made = piece.skinned(*kernels, kPlaces, influences, mode);
        skin.add(made.data(), made.size());
      }
    }
    const std::vector<float> recomputed = piece.recomputed(*kernels, kPlaces);
    normals.add(recomputed.data(), recomputed.size());
    const std::vector<float> moved = piece.moved(*kernels, 100);
    targets.add(moved.data(), moved.size());
    EXPECT_EQ(skin.get(), fuses(kernels) ? 17742793177837106399u : 9399108170116113246u);
    EXPECT_EQ(normals.get(), fuses(kernels) ? 5545892496385476698u : 8158691836059751701u);
    EXPECT_EQ(targets.get(), fuses(kernels) ? 17416380660912958779u : 8313780558851541007u);
  }
}

// Whatever the count, places beyond it are left alone and those before it come out as ever.
TEST(KernelsDeform, AnyCount) {
  const KernelTable& scalar = *kernels_for(Isa::kScalar);
  for (const KernelTable* kernels : present()) {
    SCOPED_TRACE(kernels->name);
    Piece piece(4);
    for (uint32_t count = 0; count <= kPlaces; ++count) {
      for (SkinNormals mode : {SkinNormals::kNone, SkinNormals::kMatrix}) {
        expect_near(piece.skinned(*kernels, count, 5, mode), piece.skinned(scalar, count, 5, mode),
                    1e-4f);
      }
      expect_near(piece.recomputed(*kernels, count), piece.recomputed(scalar, count), 1e-4f);
      expect_near(piece.moved(*kernels, count), piece.moved(scalar, count), 1e-6f);
    }
  }
}

}  // namespace
}  // namespace mien
