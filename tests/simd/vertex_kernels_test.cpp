// SPDX-License-Identifier: MIT
// The vertex output kernel: every instruction set writes the same bytes, which a plain conversion
// predicts, and no others.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "tests/simd/present_kernels.h"

namespace mien {
namespace {

constexpr uint32_t kVertices = 23, kPositions = 9;
constexpr uint32_t kStride = 44, kPositionAt = 4, kNormalAt = 20, kTangentAt = 28;
constexpr uint8_t kUntouched = 0xA5;

struct Vertices {
  std::vector<float> positions, normals, tangents;
  std::vector<uint32_t> position_indices;

  explicit Vertices(uint32_t seed) {
    std::mt19937 random(seed);
    const auto next = [&] { return static_cast<float>(random() >> 8) / 8388608.0f - 1; };
    for (uint32_t i = 0; i < kPositions * 3 + 1; ++i) positions.push_back(100 * next());
    for (uint32_t v = 0; v < kVertices; ++v) {
      position_indices.push_back(random() % kPositions);
      double n[3] = {next(), next(), next()};
      const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
      for (double part : n) normals.push_back(static_cast<float>(part / length));
      for (int k = 0; k < 3; ++k) tangents.push_back(3 * next());
      tangents.push_back(v % 3 == 0 ? -1.0f : 1.0f);
    }
    // A tangent along the normal, one of length zero, and one that is not finite.
    for (int k = 0; k < 3; ++k) {
      tangents[4 * 4 + k] = 2 * normals[3 * 4 + k];
      tangents[4 * 7 + k] = 0;
      tangents[4 * 9 + k] = INFINITY;
    }
    normals.push_back(0);
  }

  /// One buffer of interleaved vertices; formats ~0: no such stream.
  std::vector<uint8_t> written(const KernelTable& kernels, uint32_t position_format,
                               uint32_t normal_format, uint32_t tangent_format,
                               uint32_t count = kVertices) const {
    std::vector<uint32_t> memory(kStride * kVertices / 4);  // aligned to 4
    uint8_t* const data = reinterpret_cast<uint8_t*>(memory.data());
    memset(data, kUntouched, memory.size() * 4);
    const auto stream = [&](uint32_t at, uint32_t format) {
      return VertexStream{format == ~0u ? nullptr : data + at, kStride,
                          static_cast<VertexFormat>(format)};
    };
    VertexArgs args;
    args.positions = positions.data();
    args.position_indices = position_indices.data();
    args.normals = normals.data();
    args.tangents = tangents.data();
    args.position_stream = stream(kPositionAt, position_format);
    args.normal_stream = stream(kNormalAt, normal_format);
    args.tangent_stream = stream(kTangentAt, tangent_format);
    args.count = count;
    kernels.write_vertices(args);
    return {data, data + memory.size() * 4};
  }

  /// Perpendicular to the normal, in double.
  void tangent(uint32_t v, double* out) const {
    const float *n = &normals[v * 3], *t = &tangents[v * 4];
    const double along = double(n[0]) * t[0] + double(n[1]) * t[1] + double(n[2]) * t[2];
    double length = 0;
    for (int k = 0; k < 3; ++k) {
      out[k] = t[k] - n[k] * along;
      length += out[k] * out[k];
    }
    for (int k = 0; k < 3; ++k) out[k] /= std::sqrt(length);
  }
};

float float_at(const uint8_t* at) {
  float value;
  memcpy(&value, at, 4);
  return value;
}
uint32_t word_at(const uint8_t* at) {
  uint32_t value;
  memcpy(&value, at, 4);
  return value;
}
/// Bits first ... first + bits - 1 as a signed number.
int signed_bits(uint32_t word, int first, int bits) {
  const int value = int(word >> first & ((1u << bits) - 1));
  return value >= 1 << (bits - 1) ? value - (1 << bits) : value;
}
/// x y z w of a vertex, whatever the format.
std::vector<double> decode(const uint8_t* at, uint32_t format) {
  switch (static_cast<VertexFormat>(format)) {
    case VertexFormat::kFloat32x3: return {float_at(at), float_at(at + 4), float_at(at + 8)};
    case VertexFormat::kFloat32x4:
      return {float_at(at), float_at(at + 4), float_at(at + 8), float_at(at + 12)};
    case VertexFormat::kSnorm16x4: {
      const uint32_t low = word_at(at), high = word_at(at + 4);
      return {signed_bits(low, 0, 16) / 32767.0, signed_bits(low, 16, 16) / 32767.0,
              signed_bits(high, 0, 16) / 32767.0, signed_bits(high, 16, 16) / 32767.0};
    }
    case VertexFormat::kSnorm10_10_10_2: {
      const uint32_t word = word_at(at);
      return {signed_bits(word, 0, 10) / 511.0, signed_bits(word, 10, 10) / 511.0,
              signed_bits(word, 20, 10) / 511.0, double(signed_bits(word, 30, 2))};
    }
  }
  return {};
}
double tolerance_of(uint32_t format) {
  switch (static_cast<VertexFormat>(format)) {
    case VertexFormat::kSnorm16x4: return 0.5001 / 32767;
    case VertexFormat::kSnorm10_10_10_2: return 0.5001 / 511;
    default: return 1e-6;
  }
}
size_t size_of(uint32_t format) {
  static constexpr size_t kSizes[] = {12, 16, 8, 4};
  return format == ~0u ? 0 : kSizes[format];
}

TEST(VertexKernels, ValuesOfEveryFormat) {
  const Vertices vertices(1);
  for (const KernelTable* kernels : present_kernels()) {
    SCOPED_TRACE(kernels->name);
    for (uint32_t position_format : {0u, 1u}) {
      for (uint32_t format = 1; format < 4; ++format) {
        const uint32_t normal_format = format == 1 ? 3 : format == 2 ? 2 : 3;
        const std::vector<uint8_t> bytes =
            vertices.written(*kernels, position_format, normal_format, format);
        for (uint32_t v = 0; v < kVertices; ++v) {
          const uint8_t* at = bytes.data() + v * kStride;
          const std::vector<double> p = decode(at + kPositionAt, position_format);
          const std::vector<double> n = decode(at + kNormalAt, normal_format);
          const std::vector<double> t = decode(at + kTangentAt, format);
          for (size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(p[k], vertices.positions[vertices.position_indices[v] * 3 + k]);
            EXPECT_NEAR(n[k], vertices.normals[v * 3 + k], tolerance_of(normal_format));
          }
          EXPECT_EQ(p.back(), position_format == 1 ? 1 : p[2]);
          EXPECT_EQ(n[3], 0);
          EXPECT_EQ(t[3], v % 3 == 0 ? -1 : 1);
          if (v == 4 || v == 7 || v == 9) continue;
          double expected[3];
          vertices.tangent(v, expected);
          for (size_t k = 0; k < 3; ++k) {
            EXPECT_NEAR(t[k], expected[k], tolerance_of(format) + 2e-6) << v;
          }
        }
      }
    }
  }
}

TEST(VertexKernels, NormalsAsFloats) {
  const Vertices vertices(2);
  for (const KernelTable* kernels : present_kernels()) {
    for (uint32_t format : {0u, 1u}) {
      // Not beside a tangent: their places overlap.
      const std::vector<uint8_t> bytes = vertices.written(*kernels, ~0u, format, ~0u);
      for (uint32_t v = 0; v < kVertices; ++v) {
        const std::vector<double> n = decode(bytes.data() + v * kStride + kNormalAt, format);
        for (size_t k = 0; k < 3; ++k) EXPECT_EQ(n[k], vertices.normals[v * 3 + k]);
        EXPECT_EQ(n.back(), format == 1 ? 0 : n[2]);
      }
    }
  }
}

TEST(VertexKernels, ATangentWithoutDirectionBecomesAPerpendicular) {
  const Vertices vertices(3);
  for (const KernelTable* kernels : present_kernels()) {
    const std::vector<uint8_t> bytes = vertices.written(*kernels, ~0u, ~0u, 1);
    for (uint32_t v : {4u, 7u, 9u}) {
      const std::vector<double> t = decode(bytes.data() + v * kStride + kTangentAt, 1);
      double along = 0, squared = 0;
      for (size_t k = 0; k < 3; ++k) {
        along += t[k] * vertices.normals[v * 3 + k];
        squared += t[k] * t[k];
      }
      EXPECT_NEAR(along, 0, 1e-6);
      EXPECT_NEAR(squared, 1, 1e-6);
    }
  }
}

TEST(VertexKernels, EveryInstructionSetWritesTheSameBytes) {
  const KernelTable& scalar = *kernels_for(Isa::kScalar);
  for (uint32_t seed = 0; seed < 20; ++seed) {
    const Vertices vertices(seed);
    for (const KernelTable* kernels : present_kernels()) {
      for (uint32_t format : {1u, 2u, 3u}) {
        for (uint32_t count : {0u, 1u, 2u, 3u, 4u, 5u, kVertices}) {
          EXPECT_EQ(vertices.written(*kernels, 0, 2, format, count),
                    vertices.written(scalar, 0, 2, format, count))
              << kernels->name << " format " << format << " count " << count;
        }
      }
    }
  }
}

TEST(VertexKernels, WritesNothingBetweenAndAfterVertices) {
  const Vertices vertices(4);
  for (const KernelTable* kernels : present_kernels()) {
    for (uint32_t position_format : {0u, 1u, ~0u}) {
      for (uint32_t normal_format : {2u, 3u, ~0u}) {
        for (uint32_t tangent_format : {1u, 2u, 3u, ~0u}) {
          for (uint32_t count : {1u, 6u, kVertices}) {
            const std::vector<uint8_t> bytes =
                vertices.written(*kernels, position_format, normal_format, tangent_format, count);
            for (uint32_t i = 0; i < bytes.size(); ++i) {
              const uint32_t in_vertex = i % kStride;
              const auto covers = [&](uint32_t at, uint32_t format) {
                return in_vertex >= at && in_vertex < at + size_of(format);
              };
              if (i / kStride < count &&
                  (covers(kPositionAt, position_format) || covers(kNormalAt, normal_format) ||
                   covers(kTangentAt, tangent_format))) {
                continue;
              }
              ASSERT_EQ(bytes[i], kUntouched) << kernels->name << " byte " << i;
            }
          }
        }
      }
    }
  }
}

// Ties go to even, what lies outside -1 ... 1 is clamped, and what is not a number becomes -1.
TEST(VertexKernels, RoundingOfSnorm) {
  const float inputs[] = {0,        -0.0f,     1,   -1,         1.5f,       -2,
                          INFINITY, -INFINITY, NAN, 0.5f / 511, 1.5f / 511, -2.5f / 511};
  const int expected[] = {0, 0, 511, -511, 511, -511, 511, -511, -511, 0, 2, -2};
  for (const KernelTable* kernels : present_kernels()) {
    Vertices vertices(5);
    for (uint32_t i = 0; i < 12; ++i) {
      vertices.normals[i * 3] = inputs[i];
      vertices.normals[i * 3 + 1] = -1;
      vertices.normals[i * 3 + 2] = 1;
    }
    const std::vector<uint8_t> bytes = vertices.written(*kernels, ~0u, 3, ~0u);
    for (uint32_t i = 0; i < 12; ++i) {
      const uint32_t word = word_at(bytes.data() + i * kStride + kNormalAt);
      EXPECT_EQ(signed_bits(word, 0, 10), expected[i]) << kernels->name << " " << inputs[i];
      EXPECT_EQ(signed_bits(word, 10, 10), -511);
      EXPECT_EQ(signed_bits(word, 20, 10), 511);
      EXPECT_EQ(word >> 30, 0u);
    }
  }
}

}  // namespace
}  // namespace mien
