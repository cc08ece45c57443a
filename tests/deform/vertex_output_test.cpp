// SPDX-License-Identifier: MIT
// Vertices in the caller's memory: the values of the instance in every layout, tangents against
// double precision, the same bytes on threads and in batches, and which layouts are valid.
#include "runtime/deform/vertex_output.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>
#include <thread>

#include "capi/dna_handle.h"
#include "tests/support/deform_rig.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

MienDeformerDesc with_tangents(uint32_t isa = MIEN_ISA_BEST) {
  MienDeformerDesc desc = {};
  desc.isa = isa;
  desc.with_tangents = 1;
  return desc;
}

/// Memory for a mesh and an output into it.
struct Buffer {
  std::vector<uint32_t> memory;  // aligned to 4
  MienVertexOutput output = sized<MienVertexOutput>();

  /// Interleaved: position, normal, tangent, and 4 bytes that nothing writes.
  Buffer(size_t vertex_count, uint32_t position_format, uint32_t normal_format,
         uint32_t tangent_format, uint8_t fill = 0xA5) {
    static constexpr uint32_t kSizes[] = {12, 16, 8, 4};
    const uint32_t normal_at = kSizes[position_format];
    const uint32_t tangent_at = normal_at + kSizes[normal_format];
    const uint32_t stride = tangent_at + kSizes[tangent_format] + 4;
    memory.reserve(vertex_count * stride / 4 + 1);  // so that without vertices it has an address
    memory.assign(vertex_count * stride / 4, 0x0101'0101u * fill);
    output.vertex_capacity = vertex_count;
    output.positions = {bytes(), stride, position_format};
    output.normals = {bytes() + normal_at, stride, normal_format};
    output.tangents = {bytes() + tangent_at, stride, tangent_format};
  }
  uint8_t* bytes() { return reinterpret_cast<uint8_t*>(memory.data()); }

  /// x y z w of a vertex; w of three floats is 0.
  static Vec4d decode(const MienVertexStream& stream, size_t vertex) {
    const uint8_t* at = static_cast<const uint8_t*>(stream.data) + vertex * stream.stride;
    float floats[4] = {};
    int16_t shorts[4];
    uint32_t word;
    Vec4d v = {};
    switch (stream.format) {
      case MIEN_VERTEX_FORMAT_FLOAT32X3: memcpy(floats, at, 12); break;
      case MIEN_VERTEX_FORMAT_FLOAT32X4: memcpy(floats, at, 16); break;
      case MIEN_VERTEX_FORMAT_SNORM16X4:
        memcpy(shorts, at, 8);
        for (size_t k = 0; k < 4; ++k) v[k] = shorts[k] / 32767.0;
        return v;
      default:
        memcpy(&word, at, 4);
        for (size_t k = 0; k < 4; ++k) {
          const int bits = k < 3 ? 10 : 2;
          int part = int(word >> (10 * k) & ((1u << bits) - 1));
          if (part >= 1 << (bits - 1)) part -= 1 << bits;
          v[k] = part / double((1 << (bits - 1)) - 1);
        }
        return v;
    }
    for (size_t k = 0; k < 4; ++k) v[k] = floats[k];
    return v;
  }
  Vec4d position(size_t v) const { return decode(output.positions, v); }
  Vec4d normal(size_t v) const { return decode(output.normals, v); }
  Vec4d tangent(size_t v) const { return decode(output.tangents, v); }
};

void write(MienDeformerInstance* instance, uint32_t mesh, const Buffer& buffer,
           uint32_t normals = MIEN_NORMALS_DEFAULT) {
  ASSERT_EQ(mien_deformer_instance_write_vertices(instance, mesh, normals, &buffer.output, nullptr),
            MIEN_OK);
}

// Values ------------------------------------------------------------------------------------------

TEST(VertexOutput, HasTheValuesOfTheInstance) {
  const std::vector<uint8_t> file = random_deform_rig(1, {});
  Deformed d(file, with_tangents()), apart(file);
  const DeformValues values = random_values(d.rig.get(), 1);
  d.update(values);
  apart.update(values);
  for (uint32_t normals : {MIEN_NORMALS_SKINNED, MIEN_NORMALS_RECOMPUTED}) {
    for (uint32_t position_format : {0u, 1u}) {
      for (uint32_t normal_format = 0; normal_format < 4; ++normal_format) {
        SCOPED_TRACE(normal_format);
        const MienMesh mesh = mesh_of(d.deformer.get(), 1);
        const Buffer buffer(mesh.vertex_count, position_format, normal_format,
                            MIEN_VERTEX_FORMAT_SNORM10_10_10_2);
        write(d.instance.get(), 1, buffer, normals);
        apart.deform(1, normals);
        EXPECT_TRUE(same_bits(d.positions(1), apart.positions(1)));
        EXPECT_TRUE(same_bits(d.normals(1), apart.normals(1)));
        const double tolerance = normal_format == 2   ? 0.51 / 32767
                                 : normal_format == 3 ? 0.51 / 511
                                                      : 0;
        for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
          const uint32_t p = mesh.vertex_position_indices.data[v];
          for (uint32_t k = 0; k < 3; ++k) {
            ASSERT_EQ(buffer.position(v)[k], apart.positions(1)[p * 3 + k]);
            ASSERT_NEAR(buffer.normal(v)[k], apart.normals(1)[v * 3 + k], tolerance);
          }
          ASSERT_EQ(buffer.position(v)[3], position_format);
          ASSERT_EQ(buffer.normal(v)[3], 0);
        }
      }
    }
  }
}

TEST(VertexOutput, StreamsMayBeApartOrMissing) {
  Deformed d(random_deform_rig(2, {}), with_tangents());
  d.update(random_values(d.rig.get(), 2));
  const MienMesh mesh = mesh_of(d.deformer.get(), 0);
  const Buffer all(mesh.vertex_count, 0, 2, 2);
  write(d.instance.get(), 0, all);
  for (int present = 1; present < 8; ++present) {
    std::vector<float> positions(mesh.vertex_count * 3 + 1, -7);
    std::vector<uint64_t> normals(mesh.vertex_count + 1, 7), tangents(mesh.vertex_count + 1, 7);
    MienVertexOutput output = sized<MienVertexOutput>();
    output.vertex_capacity = mesh.vertex_count;
    if (present & 1) output.positions = {positions.data(), 12, MIEN_VERTEX_FORMAT_FLOAT32X3};
    if (present & 2) output.normals = {normals.data(), 8, MIEN_VERTEX_FORMAT_SNORM16X4};
    if (present & 4) output.tangents = {tangents.data(), 8, MIEN_VERTEX_FORMAT_SNORM16X4};
    ASSERT_EQ(mien_deformer_instance_write_vertices(d.instance.get(), 0, 0, &output, nullptr),
              MIEN_OK);
    for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
      EXPECT_TRUE(!(present & 1) || Buffer::decode(output.positions, v) == all.position(v));
      EXPECT_TRUE(!(present & 2) || Buffer::decode(output.normals, v) == all.normal(v));
      EXPECT_TRUE(!(present & 4) || Buffer::decode(output.tangents, v) == all.tangent(v));
    }
    EXPECT_EQ(positions.back(), -7);
    EXPECT_EQ(normals.back(), 7u);
    EXPECT_EQ(tangents.back(), 7u);
  }
}

TEST(VertexOutput, WithoutNewNormalsTheLastAreWritten) {
  Deformed d(random_deform_rig(3, {}));
  const MienMesh mesh = mesh_of(d.deformer.get(), 0);
  d.update(random_values(d.rig.get(), 3));
  std::vector<float> normals(mesh.vertex_count * 3);
  MienVertexOutput output = sized<MienVertexOutput>();
  output.vertex_capacity = mesh.vertex_count;
  output.normals = {normals.data(), 12, MIEN_VERTEX_FORMAT_FLOAT32X3};
  const auto written = [&](uint32_t mode) {
    EXPECT_EQ(mien_deformer_instance_write_vertices(d.instance.get(), 0, mode, &output, nullptr),
              MIEN_OK);
    return normals;
  };
  const Span<const float> neutral = {mesh.normals.data, mesh.normals.count};
  EXPECT_TRUE(same_bits(span_of(written(MIEN_NORMALS_NONE)), neutral));
  const std::vector<float> skinned = written(MIEN_NORMALS_SKINNED);
  EXPECT_FALSE(same_bits(span_of(skinned), neutral));
  EXPECT_EQ(written(MIEN_NORMALS_NONE), skinned);
  EXPECT_NE(written(MIEN_NORMALS_DEFAULT), skinned);  // recomputed
}

TEST(VertexOutput, AMeshWithoutVertices) {
  Arena arena(default_allocator());
  dna::DnaView view = dna::tiny_rig(arena);
  view.geom.meshes = {};
  Deformed d(write_view(view), with_tangents());
  const Buffer none(0, 0, 0, 1);
  write(d.instance.get(), 0, none);
}

// Tangents ----------------------------------------------------------------------------------------

TEST(VertexOutput, NeutralTangentsInTheNeutralPose) {
  Deformed d(random_deform_rig(4, {}), with_tangents());
  const MienMesh mesh = mesh_of(d.deformer.get(), 0);
  ASSERT_EQ(mesh.tangents.count, mesh.vertex_count * 4);
  const Buffer buffer(mesh.vertex_count, 0, 0, MIEN_VERTEX_FORMAT_FLOAT32X4);
  write(d.instance.get(), 0, buffer, MIEN_NORMALS_NONE);
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
    for (uint32_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(buffer.tangent(v)[k], mesh.tangents.data[v * 4 + k], 1e-6);
    }
    EXPECT_EQ(buffer.tangent(v)[3], mesh.tangents.data[v * 4 + 3]);
  }
}

TEST(VertexOutput, TangentsAgreeWithDoublePrecision) {
  for (uint32_t seed = 0; seed < 6; ++seed) {
    DeformRigOptions options;
    options.clockwise = seed % 2;
    const std::vector<uint8_t> file = random_deform_rig(seed, options);
    for (uint32_t isa : present_isas()) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << " " << mien_isa_name(isa));
      Deformed d(file, with_tangents(isa));
      const PlainDeformer plain = {d.dna->view};
      // Skewed every other time, which takes another way to normals but not to tangents.
      const DeformValues values = random_values(d.rig.get(), seed, seed % 2 ? 0.1 : 0);
      d.update(values);
      for (uint32_t normals : {MIEN_NORMALS_SKINNED, MIEN_NORMALS_RECOMPUTED}) {
        const MienMesh mesh = mesh_of(d.deformer.get(), 0);
        const Buffer buffer(mesh.vertex_count, 0, 0, MIEN_VERTEX_FORMAT_FLOAT32X4);
        write(d.instance.get(), 0, buffer, normals);
        std::vector<Vec4d> neutral;
        for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
          const float* t = mesh.tangents.data + v * 4;
          neutral.push_back({t[0], t[1], t[2], t[3]});
        }
        const std::vector<Vec3d> skinned = plain.skinned_tangents(0, values, neutral);
        uint32_t compared = 0;
        for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
          const Vec4d n = buffer.normal(v), made = buffer.tangent(v);
          Vec3d t = skinned[v];
          const double before = std::sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
          const double along = t[0] * n[0] + t[1] * n[1] + t[2] * n[2];
          for (size_t k = 0; k < 3; ++k) t[k] -= along * n[k];
          const double length = std::sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
          EXPECT_NEAR(made[0] * made[0] + made[1] * made[1] + made[2] * made[2], 1, 1e-6);
          EXPECT_NEAR(made[0] * n[0] + made[1] * n[1] + made[2] * n[2], 0, 2e-5);
          EXPECT_EQ(made[3], neutral[v][3]);
          if (length < 0.05 * before) continue;  // almost along the normal: badly determined
          ++compared;
          for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(made[k], t[k] / length, 2e-4) << v;
        }
        EXPECT_GT(compared, mesh.vertex_count * 9 / 10);
      }
    }
  }
}

// The tangent and w still describe the texture after a mirroring scale.
TEST(VertexOutput, MirroringKeepsTheOrientationOfTheTexture) {
  Arena arena(default_allocator());
  dna::DnaView view = dna::tiny_rig(arena);
  for (auto& skin : view.geom.meshes[0].skin_weights) {
    skin = {dna::be<float>(arena, {1}), dna::be<uint16_t>(arena, {0})};
  }
  Deformed d(write_view(view), with_tangents());
  DeformValues values = random_values(d.rig.get(), 0);
  std::fill(values.joints.begin(), values.joints.end(), 0.0f);
  std::fill(values.channels.begin(), values.channels.end(), 0.0f);
  values.joints[6] = -2;  // scale -1 along x
  d.update(values);
  for (uint32_t normals : {MIEN_NORMALS_SKINNED, MIEN_NORMALS_RECOMPUTED}) {
    const Buffer buffer(6, 0, 0, MIEN_VERTEX_FORMAT_FLOAT32X4);
    write(d.instance.get(), 0, buffer, normals);
    for (uint32_t v = 0; v < 6; ++v) {
      const Vec4d n = buffer.normal(v), t = buffer.tangent(v);
      EXPECT_NEAR(t[0], -1, 1e-6);  // u grows with the neutral x
      // v grows with y: w * cross(normal, tangent).
      EXPECT_NEAR(t[3] * (n[2] * t[0] - n[0] * t[2]), 1, 1e-6) << normals;
    }
  }
}

// The same bytes ----------------------------------------------------------------------------------

TEST(VertexOutput, DoesNotDependOnWhatTheMemoryHeld) {
  Deformed d(random_deform_rig(5, {}), with_tangents());
  const MienMesh mesh = mesh_of(d.deformer.get(), 0);
  d.update(random_values(d.rig.get(), 5));
  for (uint32_t format = 1; format < 4; ++format) {
    Buffer zeros(mesh.vertex_count, 0, format, format, 0);
    Buffer ones(mesh.vertex_count, 0, format, format, 0xFF);
    write(d.instance.get(), 0, zeros);
    write(d.instance.get(), 0, ones);
    const uint32_t stride = zeros.output.positions.stride;
    for (size_t i = 0; i < zeros.memory.size() * 4; ++i) {
      const bool unused = i % stride >= stride - 4;
      ASSERT_EQ(zeros.bytes()[i], unused ? 0 : ones.bytes()[i]);
      ASSERT_TRUE(!unused || ones.bytes()[i] == 0xFF);
    }
  }
}

TEST(VertexOutput, InstructionSetsOfAFamilyWriteTheSameBytes) {
  const std::vector<uint8_t> file = random_deform_rig(6, {});
  std::vector<uint32_t> expected[2];
  for (uint32_t isa : present_isas()) {
    SCOPED_TRACE(mien_isa_name(isa));
    Deformed d(file, with_tangents(isa));
    d.update(random_values(d.rig.get(), 6));
    std::vector<uint32_t> made;
    for (uint32_t format = 1; format < 4; ++format) {
      const Buffer buffer(mesh_of(d.deformer.get(), 0).vertex_count, 0, format, format);
      write(d.instance.get(), 0, buffer);
      made.insert(made.end(), buffer.memory.begin(), buffer.memory.end());
    }
    const bool fuses = isa != MIEN_ISA_SCALAR && isa != MIEN_ISA_SSE2;
    if (expected[fuses].empty()) expected[fuses] = made;
    EXPECT_EQ(made, expected[fuses]);
  }
}

struct CountedThreads {
  MienParallelFor interface = {this, run};
  uint32_t calls = 0;

  static void run(void* user, uint32_t count, void (*task)(void*, uint32_t), void* context) {
    ++static_cast<CountedThreads*>(user)->calls;
    std::atomic<uint32_t> next{0};
    std::vector<std::thread> threads;
    for (int t = 0; t < 3; ++t) {
      threads.emplace_back([&] {
        for (uint32_t i = next++; i < count; i = next++) task(context, count - 1 - i);
      });
    }
    for (std::thread& thread : threads) thread.join();
  }
};

TEST(VertexOutput, ThreadsWriteTheSameBytes) {
  DeformRigOptions options;
  options.rows = 130;
  options.columns = 131;
  options.meshes = 1;
  Deformed d(random_deform_rig(7, options), with_tangents());
  d.update(random_values(d.rig.get(), 7));
  const uint32_t count = mesh_of(d.deformer.get(), 0).vertex_count;
  const Buffer alone(count, 1, 2, 3), threaded(count, 1, 2, 3);
  write(d.instance.get(), 0, alone);
  CountedThreads threads;
  ASSERT_EQ(mien_deformer_instance_write_vertices(d.instance.get(), 0, MIEN_NORMALS_DEFAULT,
                                                  &threaded.output, &threads.interface),
            MIEN_OK);
  EXPECT_EQ(threads.calls, 4u);  // skin, areas, normals, vertices
  EXPECT_EQ(threaded.memory, alone.memory);
}

TEST(VertexOutput, ABatchWritesTheSameBytes) {
  DeformRigOptions options;
  options.rows = 60;
  options.columns = 40;
  Deformed d(random_deform_rig(8, options), with_tangents());
  const uint32_t count = mesh_of(d.deformer.get(), 1).vertex_count;
  std::vector<DeformerInstanceHandle> instances;
  std::vector<MienDeformerInstance*> batch;
  std::vector<Buffer> alone, together;
  for (uint32_t i = 0; i < 9; ++i) {
    instances.push_back(create_deformer_instance(d.deformer.get()));
    batch.push_back(instances.back().get());
    Deformed::update(batch.back(), random_values(d.rig.get(), i));
    alone.emplace_back(count, 0, i % 4, 1 + i % 3);
    together.emplace_back(count, 0, i % 4, 1 + i % 3);
    if (i == 4) alone.back().output.tangents.data = together.back().output.tangents.data = nullptr;
    write(batch.back(), 1, alone.back());
  }
  for (bool with_threads : {false, true}) {
    CountedThreads threads;
    std::vector<MienVertexOutput> outputs;
    for (Buffer& buffer : together) {
      memset(buffer.bytes(), 0xA5, buffer.memory.size() * 4);
      outputs.push_back(buffer.output);
    }
    ASSERT_EQ(mien_deformer_instance_write_vertices_batch(
                  batch.data(), batch.size(), 1, MIEN_NORMALS_DEFAULT, outputs.data(),
                  with_threads ? &threads.interface : nullptr),
              MIEN_OK);
    EXPECT_EQ(threads.calls > 0, with_threads);
    for (size_t i = 0; i < batch.size(); ++i) {
      EXPECT_EQ(together[i].memory, alone[i].memory) << i;
    }
  }
}

// Layouts -----------------------------------------------------------------------------------------

// Against sets of bytes: small random streams, most of which touch each other.
TEST(VertexOutput, ValidityAndOverlapAreThatOfTheBytes) {
  alignas(4) static uint8_t memory[512];
  std::mt19937 random(1);
  const auto below = [&](uint32_t limit) { return static_cast<uint32_t>(random() % limit); };
  const auto bytes_of = [](const VertexStream& stream, uint32_t count) {
    std::vector<const uint8_t*> bytes;
    for (uint32_t v = 0; v < count && stream.data; ++v) {
      for (size_t k = 0; k < vertex_format_size(stream.format); ++k) {
        bytes.push_back(stream.data + v * stream.stride + k);
      }
    }
    return bytes;
  };
  const auto random_output = [&](bool same_stride) {
    VertexOutput output = {};
    const uint32_t common = 4 * (1 + below(12));
    for (VertexStream* stream : {&output.positions, &output.normals, &output.tangents}) {
      if (below(4) == 0) continue;
      const uint32_t last = stream == &output.positions ? 2 : 4;
      const uint32_t first = stream == &output.tangents ? 1 : 0;
      stream->format = static_cast<VertexFormat>(first + below(last - first));
      stream->stride = same_stride ? common : 4 * (1 + below(12));
      stream->data = memory + 4 * below(24);
    }
    return output;
  };
  uint32_t valid = 0, overlapping = 0, apart = 0;
  for (int i = 0; i < 50000; ++i) {
    const uint32_t count = 1 + below(4);
    const bool same_stride = below(4) != 0;
    const VertexOutput a = random_output(same_stride), b = random_output(same_stride);
    std::vector<const uint8_t*> all;
    bool expected = false;
    for (const VertexStream* stream : {&a.positions, &a.normals, &a.tangents}) {
      const std::vector<const uint8_t*> bytes = bytes_of(*stream, count);
      all.insert(all.end(), bytes.begin(), bytes.end());
      expected |= stream->data != nullptr;
    }
    const std::set<const uint8_t*> different(all.begin(), all.end());
    expected &= different.size() == all.size();
    for (const VertexStream* stream : {&a.positions, &a.normals, &a.tangents}) {
      if (stream->data) expected &= stream->stride >= vertex_format_size(stream->format);
    }
    // Streams of different strides that interleave without a collision are refused too.
    if (same_stride) {
      ASSERT_EQ(is_valid(a, count), expected);
    } else {
      ASSERT_TRUE(expected || !is_valid(a, count));
    }
    if (!is_valid(a, count) || !is_valid(b, count)) continue;
    ++valid;
    bool shared = false;
    for (const VertexStream* stream : {&b.positions, &b.normals, &b.tangents}) {
      for (const uint8_t* byte : bytes_of(*stream, count)) shared |= different.count(byte) != 0;
    }
    ASSERT_TRUE(!shared || overlap(a, b, count));
    (shared ? overlapping : apart) += 1;
    EXPECT_EQ(overlap(a, b, count), overlap(b, a, count));
    const VertexOutputRange range = range_of(a, count);
    EXPECT_EQ(range.begin, reinterpret_cast<uintptr_t>(*different.begin()));
    EXPECT_EQ(range.end, reinterpret_cast<uintptr_t>(*different.rbegin()) + 1);
  }
  EXPECT_GT(valid, 1000u);
  EXPECT_GT(overlapping, 50u);
  EXPECT_GT(apart, 50u);
}

TEST(VertexOutput, TheEndOfTheAddressSpaceIsNotPassed) {
  VertexOutput output = {};
  output.positions = {reinterpret_cast<uint8_t*>(UINTPTR_MAX - 1023), 16, VertexFormat::kFloat32x4};
  EXPECT_TRUE(is_valid(output, 63));
  EXPECT_FALSE(is_valid(output, 64));
  EXPECT_FALSE(is_valid(output, ~0u));
}

}  // namespace
}  // namespace mien
