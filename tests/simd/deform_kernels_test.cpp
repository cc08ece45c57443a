// SPDX-License-Identifier: MIT
// Kernels of poses and deformation on every instruction set: all counts, and the same bits on every
// machine, which only recorded ones can show. The data is made of integers: no C library rounds it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <vector>

#include "tests/simd/present_kernels.h"

namespace mien {
namespace {

constexpr uint32_t kJoints = 40;
constexpr uint32_t kPositions = 61;
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
  uint8_t has_no_delta[kJoints];
  for (uint16_t j = 0; j < kJoints; ++j) {
    order[j] = j;
    parents[j] = static_cast<uint16_t>(j % 7 == 0 ? j : numbers.below(j));
    has_no_delta[j] = numbers.below(3) == 0 || j == 14;  // 14 is a root
    for (int k = 3; k < 16; k += 4) inverse.data[j * 16 + k] = k == 15;
  }
  JointTreeArgs tree = {order,        parents,    locals.data, has_no_delta,
                        inverse.data, model.data, skin.data,   kJoints};
  kernels.joint_tree(tree);
  const float identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  int roots = 0, others = 0;
  Bits bits;
  bits.add(locals.data, locals.count);
  bits.add(model.data, model.count);
  bits.add(skin.data, skin.count);
  for (uint32_t j = 0; j < kJoints; ++j) {
    for (uint32_t k = 3; k < 16; k += 4) {
      EXPECT_EQ(model.data[j * 16 + k], k == 15);
      EXPECT_EQ(skin.data[j * 16 + k], k == 15);
    }
    if (has_no_delta[j]) {
      // A joint without a delta moves with its parent; a root stays where it is.
      const bool root = parents[j] == j;
      EXPECT_EQ(memcmp(skin.data + j * 16, root ? identity : skin.data + parents[j] * 16, 64), 0)
          << j;
      ++(root ? roots : others);
    }
  }
  EXPECT_GT(roots, 0);
  EXPECT_GT(others, 0);
  return bits.get();
}

TEST(KernelsDeform, JointsHaveTheSameBitsEverywhere) {
  for (const KernelTable* kernels : present_kernels()) {
    SCOPED_TRACE(kernels->name);
    EXPECT_EQ(joint_bits(*kernels, 1, false), 7918170621521290643u);
    EXPECT_EQ(joint_bits(*kernels, 2, true), 6579404113650687698u);
  }
}

// Meshes ------------------------------------------------------------------------------------------

/// A random part of a mesh: one vertex in five lies on a hard edge, one face in eight has no area.
struct MeshPart {
  Numbers numbers;
  Aligned positions, weights, matrices, deltas, normals, directions;
  std::vector<uint16_t> joints, position_indices;
  std::vector<uint32_t> first_vertex = {0}, vertices, faces, first_adjacent_face = {0},
                        adjacent_faces;

  explicit MeshPart(uint32_t seed)
      : numbers(seed), positions(kPositions * 4, &numbers),
        weights(kPositions * kMaxInfluences, &numbers), matrices(kJoints * 16, &numbers),
        deltas(kPositions * 3 * 3 + 1, &numbers), normals(kPositions * 3 * 3 + 1, nullptr),
        directions(kPositions * 4, &numbers) {
    std::copy(deltas.data, deltas.data + kPositions * 3 * 3, normals.data);
    for (uint32_t i = 0; i < kPositions * kMaxInfluences; ++i) {
      joints.push_back(static_cast<uint16_t>(numbers.below(kJoints)));
    }
    for (uint32_t i = 0; i < kPositions; ++i) {
      position_indices.push_back(static_cast<uint16_t>((i * 17 + 5) % kPositions));
      for (uint32_t n = numbers.below(3); n != 0; --n) {
        const uint32_t vertex = static_cast<uint32_t>(vertices.size());
        vertices.push_back(numbers.below(5) == 0 ? vertex | kHardEdge : vertex);
      }
      first_vertex.push_back(static_cast<uint32_t>(vertices.size()));
      for (uint32_t n = numbers.below(5); n != 0; --n)
        adjacent_faces.push_back(numbers.below(kFaces));
      first_adjacent_face.push_back(static_cast<uint32_t>(adjacent_faces.size()));
    }
    for (uint32_t f = 0; f < kFaces; ++f) {
      for (int k = 0; k < 4; ++k) faces.push_back(numbers.below(kPositions));
      if (f % 8 == 0) faces[f * 4 + 2] = faces[f * 4];
    }
  }

  /// Skinned positions and normals; only the first `count` are written.
  std::vector<float> skinned(const KernelTable& kernels, uint32_t count, uint32_t influences,
                             SkinNormals mode) {
    std::vector<float> out(kPositions * 3, -9), out_normals(vertices.size() * 3, -9);
    SkinArgs args = {};
    args.positions = positions.data;
    args.weights = weights.data;
    args.joints = joints.data();
    args.matrices = matrices.data;
    args.position_indices = position_indices.data();
    args.out_positions = out.data();
    args.first_vertex = first_vertex.data();
    args.vertices = vertices.data();
    args.normals = normals.data;
    args.out_normals = out_normals.data();
    args.count = count;
    args.influences = influences;
    args.mode = mode;
    kernels.skin_positions(args);
    const std::vector<float> gathered = out_normals;
    Aligned sorted(vertices.size() * 4, nullptr);
    for (size_t k = 0; k < vertices.size(); ++k) {
      const size_t vertex = vertices[k] & ~kHardEdge;
      std::copy(normals.data + vertex * 3, normals.data + vertex * 3 + 3, sorted.data + k * 4);
    }
    args.sorted_normals = sorted.data;
    kernels.skin_positions(args);
    EXPECT_EQ(out_normals, gathered);
    out.insert(out.end(), out_normals.begin(), out_normals.end());
    return out;
  }
  /// The positions with hard edges, counted from `first`, and their directions.
  std::vector<uint32_t> hard_positions(uint32_t first, std::vector<float>& of_hard) const {
    std::vector<uint32_t> hard;
    for (uint32_t i = 0; i + 1 < first_vertex.size(); ++i) {
      uint32_t marks = 0;
      for (uint32_t k = first_vertex[i]; k < first_vertex[i + 1]; ++k) marks |= vertices[k];
      if ((marks & kHardEdge) == 0) continue;
      hard.push_back(first + i);
      of_hard.insert(of_hard.end(), directions.data + i * 4, directions.data + i * 4 + 4);
    }
    return hard;
  }
  std::vector<float> recomputed(const KernelTable& kernels, uint32_t count, bool narrow) {
    Aligned points(kPositions * 3 + 1, nullptr), areas(kFaces * 4, nullptr);
    for (uint32_t i = 0; i < kPositions * 3; ++i) {
      points.data[i] = positions.data[i / 3 * 4 + i % 3];
    }
    const std::vector<uint16_t> few_faces(faces.begin(), faces.end()),
        few_adjacent(adjacent_faces.begin(), adjacent_faces.end());
    const auto either = [narrow](const auto& few, const auto& many) {
      return narrow ? static_cast<const void*>(few.data()) : many.data();
    };
    kernels.face_areas({points.data, either(few_faces, faces), areas.data, kFaces, narrow});
    std::vector<float> result(vertices.size() * 3, -9), of_hard;
    const std::vector<uint32_t> hard = hard_positions(100, of_hard);
    EXPECT_LT(hard.size(), kPositions);
    kernels.sum_normals({areas.data, first_adjacent_face.data(),
                         either(few_adjacent, adjacent_faces), first_vertex.data(), vertices.data(),
                         normals.data, hard.data(), of_hard.data(), result.data(), 100,
                         static_cast<uint32_t>(hard.size()), count, narrow});
    for (uint32_t f = 0; f < kFaces; ++f) {
      result.insert(result.end(), areas.data + f * 4, areas.data + f * 4 + 3);
    }
    return result;
  }
  /// The deltas rounded to 16 bits, or to 10, by either kernel.
  std::vector<float> with_rounded_target(const KernelTable& kernels, uint32_t count, bool packed,
                                         bool fixed) {
    constexpr float kScale = 1.0f / 32768;
    const float largest = packed ? 511 : 32767;
    std::vector<int16_t> numbers_of(deltas.count);
    Aligned rounded(deltas.count, nullptr);
    for (size_t i = 0; i < deltas.count; ++i) {
      numbers_of[i] = static_cast<int16_t>(deltas.data[i] * largest);
    }
    kernels.floats_from_fixed(numbers_of.data(), kScale, rounded.count, rounded.data);
    for (size_t i = 0; i < rounded.count; ++i) {
      EXPECT_EQ(rounded.data[i], float(numbers_of[i]) * kScale);
    }
    // Ascending positions, of which groups of four have one to four.
    std::vector<uint16_t> at, groups;
    for (uint32_t p = 0; p < kPositions && at.size() < count; ++p) {
      if (p % 7 == 2 || p % 5 == 3 || p / 4 % 6 == 4) continue;
      at.push_back(static_cast<uint16_t>(p));
      if (groups.empty() || groups.back() >> 4 != p / 4) {
        groups.push_back(static_cast<uint16_t>(p / 4 << 4));
      }
      groups.back() = static_cast<uint16_t>(groups.back() | 1u << p % 4);
    }
    Aligned result((kPositions * 4 + 15) / 16 * 16, nullptr);
    std::copy(positions.data, positions.data + kPositions * 4, result.data);
    std::vector<int16_t> words(1);  // the kernels take any even address
    for (size_t i = 0; i < at.size() * 3; i += 3) {
      if (packed) {
        uint32_t bits = 0;
        for (int k = 0; k < 3; ++k) {
          bits |= (static_cast<uint32_t>(numbers_of[i + size_t(k)]) & 1023) << 10 * k;
        }
        words.resize(words.size() + 2);
        memcpy(words.data() + words.size() - 2, &bits, sizeof(bits));
      } else {
        words.insert(words.end(), numbers_of.data() + i, numbers_of.data() + i + 3);
      }
    }
    words.resize(words.size() + kDeltaPadding, -1);
    const FixedTargetArgs args = {groups.data(), words.data() + 1, result.data, 0.7f * kScale,
                                  static_cast<uint32_t>(groups.size())};
    if (fixed) {
      packed ? kernels.add_target_packed(args) : kernels.add_target_fixed(args);
    } else {
      kernels.add_target(
          {rounded.data, at.data(), result.data, 0.7f, static_cast<uint32_t>(at.size())});
    }
    for (uint32_t i = 0; i < kPositions; ++i) result.data[i * 4 + 3] = 0;
    return {result.data, result.data + kPositions * 4};
  }
  std::vector<float> with_target(const KernelTable& kernels, uint32_t count) {
    std::vector<uint16_t> at;
    for (uint32_t i = 0; i < count; ++i) at.push_back(static_cast<uint16_t>(i * 7 % kPositions));
    Aligned result(kPositions * 4, nullptr);
    std::copy(positions.data, positions.data + kPositions * 4, result.data);
    kernels.add_target({deltas.data, at.data(), result.data, 0.7f, count});
    std::vector<float> points;
    for (uint32_t i = 0; i < kPositions; ++i) {
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
  for (const KernelTable* kernels : present_kernels()) {
    SCOPED_TRACE(kernels->name);
    MeshPart part(3);
    Bits skin, normals, targets;
    for (uint32_t influences = 1; influences <= kMaxInfluences; ++influences) {
      for (SkinNormals mode : {SkinNormals::kNone, SkinNormals::kMatrix, SkinNormals::kCofactors}) {
        const std::vector<float> made = part.skinned(*kernels, kPositions, influences, mode);
        skin.add(made.data(), made.size());
      }
    }
    const std::vector<float> recomputed = part.recomputed(*kernels, kPositions, false);
    EXPECT_EQ(part.recomputed(*kernels, kPositions, true), recomputed);
    normals.add(recomputed.data(), recomputed.size());
    const std::vector<float> shaped = part.with_target(*kernels, 100);
    targets.add(shaped.data(), shaped.size());
    EXPECT_EQ(skin.get(), fuses(kernels) ? 17742793177837106399u : 9399108170116113246u);
    EXPECT_EQ(normals.get(), fuses(kernels) ? 5545892496385476698u : 8158691836059751701u);
    EXPECT_EQ(targets.get(), fuses(kernels) ? 17416380660912958779u : 8313780558851541007u);
  }
}

// Whatever the count, positions beyond it are left alone and those before it come out as ever.
TEST(KernelsDeform, AnyCount) {
  const KernelTable& scalar = *kernels_for(Isa::kScalar);
  for (const KernelTable* kernels : present_kernels()) {
    SCOPED_TRACE(kernels->name);
    MeshPart part(4);
    for (uint32_t count = 0; count <= kPositions; ++count) {
      for (SkinNormals mode : {SkinNormals::kNone, SkinNormals::kMatrix}) {
        expect_near(part.skinned(*kernels, count, 5, mode), part.skinned(scalar, count, 5, mode),
                    1e-4f);
      }
      expect_near(part.recomputed(*kernels, count, count % 2 == 0),
                  part.recomputed(scalar, count, false), 1e-4f);
      expect_near(part.with_target(*kernels, count), part.with_target(scalar, count), 1e-6f);
      // The scale is a power of two, so both round alike.
      for (const bool packed : {false, true}) {
        EXPECT_EQ(part.with_rounded_target(*kernels, count, packed, true),
                  part.with_rounded_target(*kernels, count, packed, false));
      }
    }
  }
}

// Kernels make normals some hundred at a time. Few positions with many vertices give each vertex what
// it gets alone.
TEST(KernelsDeform, AnyNumberOfVerticesOfAPosition) {
  MeshPart part(5);
  const uint32_t counts[] = {1, 700, 0, 255, 256, 0, 257, 2, 512, 1};
  const uint32_t count = static_cast<uint32_t>(std::size(counts));
  part.first_vertex = {0};
  part.vertices.clear();
  for (const uint32_t n : counts) {
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t vertex = static_cast<uint32_t>(part.vertices.size());
      part.vertices.push_back(vertex % 5 == 0 ? vertex | kHardEdge : vertex);
    }
    part.first_vertex.push_back(static_cast<uint32_t>(part.vertices.size()));
  }
  const size_t vertices = part.vertices.size();
  Aligned normals(vertices * 3 + 1, &part.numbers), areas(kFaces * 4, &part.numbers);
  for (int i = 0; i < 3; ++i) normals.data[30 + i] = 0;  // without a direction
  std::vector<uint32_t> hard(count);                     // all: those without hard edges do no harm
  for (uint32_t i = 0; i < count; ++i) hard[i] = i;
  for (const KernelTable* kernels : present_kernels()) {
    SCOPED_TRACE(kernels->name);
    std::vector<float> points(kPositions * 3), out[2], alone[2];
    for (std::vector<float>* made : {out, alone}) {
      for (int i = 0; i < 2; ++i) made[i].assign(vertices * 3, -9);
    }
    const auto make = [&](uint32_t position, uint32_t positions, const uint32_t* first_vertex,
                          std::vector<float>* made) {
      SkinArgs skin = {};
      skin.positions = part.positions.data + position * 4;
      skin.weights = part.weights.data + position * 3;
      skin.joints = part.joints.data() + position * 3;
      skin.matrices = part.matrices.data;
      skin.position_indices = part.position_indices.data() + position;
      skin.out_positions = points.data();
      skin.first_vertex = first_vertex;
      skin.vertices = part.vertices.data();
      skin.normals = normals.data;
      skin.out_normals = made[0].data();
      skin.count = positions;
      skin.influences = 3;
      skin.mode = SkinNormals::kMatrix;
      kernels->skin_positions(skin);
      kernels->sum_normals({areas.data, part.first_adjacent_face.data() + position,
                            part.adjacent_faces.data(), first_vertex, part.vertices.data(),
                            normals.data, hard.data() + position,
                            part.directions.data + position * 4, made[1].data(), position,
                            count - position, positions, false});
    };
    make(0, count, part.first_vertex.data(), out);
    for (uint32_t p = 0; p < count; ++p) {
      for (uint32_t v = part.first_vertex[p]; v < part.first_vertex[p + 1]; ++v) {
        const uint32_t one[] = {v, v + 1};
        make(p, 1, one, alone);
      }
    }
    EXPECT_EQ(out[0], alone[0]);
    EXPECT_EQ(out[1], alone[1]);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(out[0][30 + i], 0);
  }
}

}  // namespace
}  // namespace mien
