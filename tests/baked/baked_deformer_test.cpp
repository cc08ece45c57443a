// SPDX-License-Identifier: MIT
// Baked deformers: what is opened deforms as what was baked, and whatever else is opened does no
// harm.
#include <gtest/gtest.h>

#include "tests/support/baked_bytes.h"
#include "tests/support/bytes.h"
#include "tests/support/long_run.h"
#include "tests/support/many_rigs.h"

namespace mien {
namespace {

Bytes bake_dna(const MienDna* dna, MienDeformerDesc desc = {}) {
  const RigHandle rig = create_rig(dna);
  return bake(rig.get(), create_deformer(dna, rig.get(), desc).get());
}

Bytes tiny_deformer() {
  Arena arena(default_allocator());
  return bake_dna(open_dna(write_view(dna::tiny_rig(arena))).get());
}

/// Two grids with seams, targets, tangents and every number of influences.
Bytes grid_deformer(DeformRigOptions options = {}) {
  MienDeformerDesc desc = {};
  desc.with_tangents = 1;
  return bake_dna(open_dna(random_deform_rig(1, options)).get(), desc);
}

// What is opened is what was baked ----------------------------------------------------------------

template <class View>
void expect_equal(const View& a, const View& b) {
  ASSERT_EQ(a.count, b.count);
  EXPECT_TRUE(a.count == 0 || memcmp(a.data, b.data, a.count * sizeof(*a.data)) == 0);
}

void expect_same_meshes(const MienDeformer* a, const MienDeformer* b, uint32_t count) {
  for (uint32_t m = 0; m < count; ++m) {
    const MienMesh x = mesh_of(a, m), y = mesh_of(b, m);
    EXPECT_EQ(x.lods, y.lods);
    EXPECT_EQ(x.max_influences, y.max_influences);
    EXPECT_EQ(x.delta_count, y.delta_count);
    expect_equal(x.positions, y.positions);
    expect_equal(x.normals, y.normals);
    expect_equal(x.texture_coordinates, y.texture_coordinates);
    expect_equal(x.vertex_position_indices, y.vertex_position_indices);
    expect_equal(x.triangles, y.triangles);
    expect_equal(x.target_channels, y.target_channels);
    std::vector<uint32_t> x_corners(size_t{3} * x.triangle_count), y_corners = x_corners;
    ASSERT_EQ(mien_deformer_triangles(a, m, x_corners.data(), x_corners.size()), MIEN_OK);
    ASSERT_EQ(mien_deformer_triangles(b, m, y_corners.data(), y_corners.size()), MIEN_OK);
    EXPECT_TRUE(x_corners == y_corners);
    std::vector<float> x_uvs(size_t{2} * x.vertex_count), y_uvs = x_uvs;
    ASSERT_EQ(mien_deformer_texture_coordinates(a, m, x_uvs.data(), x_uvs.size()), MIEN_OK);
    ASSERT_EQ(mien_deformer_texture_coordinates(b, m, y_uvs.data(), y_uvs.size()), MIEN_OK);
    EXPECT_TRUE(x_uvs == y_uvs);
    for (uint32_t p = 0; p < x.position_count; p += 1 + p / 16) {
      MienIndex16View x_joints = {}, y_joints = {};
      MienFloatView x_weights = {}, y_weights = {};
      const MienStatus found = mien_deformer_influences(a, m, p, &x_joints, &x_weights);
      ASSERT_TRUE(found == MIEN_OK || found == MIEN_ERROR_UNSUPPORTED);
      ASSERT_EQ(mien_deformer_influences(b, m, p, &y_joints, &y_weights), found);
      expect_equal(x_joints, y_joints);
      expect_equal(x_weights, y_weights);
    }
    std::vector<float> x_deltas(x.position_count * size_t{3}), y_deltas = x_deltas;
    for (uint32_t t = 0; t < x.target_count; t += 1 + t / 4) {
      ASSERT_EQ(mien_deformer_target(a, m, t, x_deltas.data(), x_deltas.size()), MIEN_OK);
      ASSERT_EQ(mien_deformer_target(b, m, t, y_deltas.data(), y_deltas.size()), MIEN_OK);
      EXPECT_TRUE(x_deltas == y_deltas);
    }
  }
}

void expect_same(const MienDna* dna, const MienRigDesc& rig_desc, MienDeformerDesc desc) {
  const RigHandle rig = create_rig(dna, rig_desc);
  const DeformerHandle deformer = create_deformer(dna, rig.get(), desc);
  const Bytes bytes = bake(rig.get(), deformer.get());
  const AlignedBytes file(bytes);
  const BakedHandle baked = open_baked(file);
  const RigHandle opened_rig = rig_of(baked, rig_desc.isa);
  const DeformerHandle opened = deformer_of(baked, opened_rig);
  ASSERT_TRUE(opened);
  EXPECT_TRUE(bake(opened_rig.get(), opened.get()) == bytes) << "baked again, but other bytes";

  MienDeformerInfo info = sized<MienDeformerInfo>(), again = info;
  ASSERT_EQ(mien_deformer_info(deformer.get(), &info), MIEN_OK);
  ASSERT_EQ(mien_deformer_info(opened.get(), &again), MIEN_OK);
  info.deformer_bytes = again.deformer_bytes = 0;
  EXPECT_EQ(memcmp(&info, &again, sizeof(info)), 0);
  for (const auto matrices : {mien_deformer_bind_matrices, mien_deformer_inverse_bind_matrices}) {
    MienFloatView x = {}, y = {};
    ASSERT_EQ(matrices(deformer.get(), &x), MIEN_OK);
    ASSERT_EQ(matrices(opened.get(), &y), MIEN_OK);
    expect_equal(x, y);
  }
  expect_same_meshes(deformer.get(), opened.get(), info.mesh_count);

  const DeformerInstanceHandle a = create_deformer_instance(deformer.get()),
                               b = create_deformer_instance(opened.get());
  for (uint32_t seed = 0; seed < 3; ++seed) {
    const DeformValues values = random_values(rig.get(), seed, seed == 0 ? 0 : 0.1);
    for (const DeformerInstanceHandle* one : {&a, &b}) {
      ASSERT_EQ(mien_deformer_instance_update_from_values(
                    one->get(), values.joints.data(), values.joints.size(), values.channels.data(),
                    values.channels.size()),
                MIEN_OK);
    }
    for (uint32_t m = 0; m < info.mesh_count; ++m) {
      for (uint32_t normals :
           {MIEN_NORMALS_DEFAULT, MIEN_NORMALS_SKINNED, MIEN_NORMALS_RECOMPUTED}) {
        MienFloatView x = {}, y = {};
        ASSERT_EQ(mien_deformer_instance_deform(a.get(), m, normals, nullptr), MIEN_OK);
        ASSERT_EQ(mien_deformer_instance_deform(b.get(), m, normals, nullptr), MIEN_OK);
        ASSERT_EQ(mien_deformer_instance_positions(a.get(), m, &x), MIEN_OK);
        ASSERT_EQ(mien_deformer_instance_positions(b.get(), m, &y), MIEN_OK);
        expect_equal(x, y);
        ASSERT_EQ(mien_deformer_instance_normals(a.get(), m, &x), MIEN_OK);
        ASSERT_EQ(mien_deformer_instance_normals(b.get(), m, &y), MIEN_OK);
        expect_equal(x, y);
      }
    }
    MienFloatView x = {}, y = {};
    ASSERT_EQ(mien_deformer_instance_skin_matrices(a.get(), &x), MIEN_OK);
    ASSERT_EQ(mien_deformer_instance_skin_matrices(b.get(), &y), MIEN_OK);
    expect_equal(x, y);
  }
}

TEST(BakedDeformer, DeformsAsTheOneThatWasBaked) {
  DeformRigOptions large;
  large.rows = large.columns = 40;  // several blocks of positions
  const Bytes small_file = random_deform_rig(1, {}), large_file = random_deform_rig(2, large);
  const DnaHandle rigs[] = {open_dna(small_file), open_dna(large_file),
                            generate_dna(MIEN_PRESET_SMALL, 1)};
  for (const DnaHandle& dna : rigs) {
    for_each_rig_desc([&](const MienRigDesc& rig_desc) {
      MienDeformerDesc desc = sized<MienDeformerDesc>();
      expect_same(dna.get(), rig_desc, desc);
      desc.storage = MIEN_STORAGE_16_BIT;
      desc.weights = MIEN_WEIGHTS_FIX;
      desc.normals = MIEN_NORMALS_SKINNED;
      desc.with_tangents = 1;
      if (rig_desc.rotation_output == MIEN_ROTATION_OUTPUT_EULER)
        desc.compose = MIEN_COMPOSE_EULER_ADD;
      expect_same(dna.get(), rig_desc, desc);
    });
  }
}

TEST(BakedDeformer, HeadsAndBodies) {
  for (uint32_t preset : {MIEN_PRESET_HEAD, MIEN_PRESET_BODY}) {
    expect_same(generate_dna(preset, 0).get(), sized<MienRigDesc>(), sized<MienDeformerDesc>());
  }
}

TEST(BakedDeformer, MeshesMayBeEmpty) {
  Arena arena(default_allocator());
  dna::DnaView view = dna::tiny_rig(arena);
  view.geom.meshes[0] = dna::Mesh();
  const Bytes file = write_view(view);
  const DnaHandle dna = open_dna(file);
  expect_same(dna.get(), sized<MienRigDesc>(), sized<MienDeformerDesc>());
}

TEST(BakedDeformer, NormalsAreThoseOfTheFileOrOfTheDesc) {
  Arena arena(default_allocator());
  const Bytes bytes = write_view(dna::tiny_rig(arena));
  const DnaHandle dna = open_dna(bytes);
  MienDeformerDesc baked_with = sized<MienDeformerDesc>();
  baked_with.normals = MIEN_NORMALS_SKINNED;
  const AlignedBytes file(bake_dna(dna.get(), baked_with));
  const BakedHandle baked = open_baked(file);
  const RigHandle rig = rig_of(baked);
  for (uint32_t normals : {MIEN_NORMALS_DEFAULT, MIEN_NORMALS_NONE, MIEN_NORMALS_RECOMPUTED}) {
    MienBakedDeformerDesc desc = sized<MienBakedDeformerDesc>();
    desc.normals = normals;
    MienDeformer* made = nullptr;
    ASSERT_EQ(mien_deformer_from_baked(baked.get(), rig.get(), &desc, &made, nullptr), MIEN_OK);
    const DeformerHandle deformer(made);
    MienDeformerInfo info = sized<MienDeformerInfo>();
    ASSERT_EQ(mien_deformer_info(made, &info), MIEN_OK);
    EXPECT_EQ(info.normals,
              normals == MIEN_NORMALS_DEFAULT ? uint32_t{MIEN_NORMALS_SKINNED} : normals);
  }
}

TEST(BakedDeformer, DoesNotDependOnTheInstructionSet) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 3);
  const Bytes expected = bake_dna(dna.get());
  for (uint32_t isa : present_isas()) {
    const RigHandle rig = create_rig(dna.get(), isa);
    EXPECT_TRUE(bake(rig.get(), create_deformer(dna.get(), rig.get()).get()) == expected)
        << mien_isa_name(isa);
    const AlignedBytes file(expected);
    const BakedHandle baked = open_baked(file);
    MienDeformerInfo info = sized<MienDeformerInfo>();
    EXPECT_EQ(mien_deformer_info(deformer_of(baked, rig_of(baked, isa)).get(), &info), MIEN_OK);
    EXPECT_EQ(info.isa, isa);
    EXPECT_EQ(mien_deformer_info(deformer_of(baked, rig_of(baked), isa).get(), &info), MIEN_OK);
    EXPECT_EQ(info.isa, isa);
  }
}

// Any change is refused or does no harm -----------------------------------------------------------

/// Each of some bytes: one bit of it, all of it, and the largest value.
void expect_no_harm(const Bytes& whole, size_t begin, size_t end, size_t step) {
  const AlignedBytes file(whole);
  size_t refused = 0, survived = 0;
  for (size_t at = begin; at < end; at += step * byte_stride()) {
    for (const int change : {1 << at % 8, 0xFF, -1}) {
      const auto byte = static_cast<uint8_t>(change < 0 ? 0xFF : whole[at] ^ change);
      file.data()[at] = byte;
      const ExerciseBaked life = exercise_baked(file.data(), file.size());
      ++(life.opened == MIEN_OK ? survived : refused);
      EXPECT_EQ(life.broken, "") << "byte " << at << " is " << unsigned{byte};
    }
    file.data()[at] = whole[at];
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(refused, 0u);
  EXPECT_GT(survived, 0u);
}

TEST(BakedDeformer, AnyChangeIsRefusedOrDoesNoHarm) {
  const Bytes tiny = tiny_deformer(), grid = grid_deformer();
  const auto deformer_of_file = [](const Bytes& file) {
    BakedPart part;
    memcpy(&part, file.data() + sizeof(BakedHeader) + sizeof(part), sizeof(part));
    return static_cast<size_t>(part.offset);
  };
  MienDeformerDesc half = {};
  half.storage = MIEN_STORAGE_16_BIT;
  const Bytes grid_of_16_bits = bake_dna(open_dna(random_deform_rig(1, {})).get(), half);
  expect_no_harm(tiny, deformer_of_file(tiny), tiny.size(), 1);
  expect_no_harm(grid_of_16_bits, deformer_of_file(grid_of_16_bits), grid_of_16_bits.size(), 23);
  expect_no_harm(grid, deformer_of_file(grid), grid.size(), 11);
}

// Damage where it would hurt ----------------------------------------------------------------------

/// The largest number that is no index any more.
template <class T>
constexpr uint64_t kLargest = static_cast<T>(~T{0});

/// `limit` and more are refused wherever they stand in the array.
template <class T>
void expect_below(OpenBaked& file, const Span<T>& array, uint64_t limit, const char* name) {
  ASSERT_FALSE(array.empty()) << name;
  for (const size_t i : {size_t{0}, array.count / 2, array.count - 1}) {
    for (const uint64_t value : {limit, limit + 1, kLargest<T>}) {
      if (value > kLargest<T>) continue;
      EXPECT_EQ(file.status_with(array, i, value), MIEN_ERROR_BAKED_STRUCTURE)
          << name << "[" << i << "] = " << value;
    }
  }
}

/// Where runs begin: a step back, a step past the end, and a beginning that is not 0.
void expect_runs(OpenBaked& file, const Span<uint32_t>& first, uint64_t end, const char* name) {
  ASSERT_GE(first.count, 3u) << name;
  EXPECT_EQ(file.status_with(first, 0, 1), MIEN_ERROR_BAKED_STRUCTURE) << name;
  for (const size_t i : {size_t{1}, first.count / 2, first.count - 1}) {
    for (const uint64_t value : {end + 1, kLargest<uint32_t>}) {
      EXPECT_EQ(file.status_with(first, i, value), MIEN_ERROR_BAKED_STRUCTURE) << name << i;
    }
    if (first[i - 1] != 0) {
      EXPECT_EQ(file.status_with(first, i, first[i - 1] - 1), MIEN_ERROR_BAKED_STRUCTURE) << name;
    }
  }
}

TEST(BakedDeformer, IndicesStayInTheirArrays) {
  OpenBaked file(grid_deformer());
  for (uint32_t m = 0; m < file.deformer_arrays().meshes.count; ++m) {
    SCOPED_TRACE(m);
    const DeformMesh& mesh = file.mesh(m);
    expect_below(file, mesh.vertex_position_indices, mesh.position_count, "vertex positions");
    expect_below(file, mesh.triangles, mesh.vertex_count, "triangles");
    expect_below(file, mesh.target_channels, file.arrays().channel_count, "channels");
    expect_below(file, mesh.position_indices, std::min(mesh.position_count, kWindowPositions),
                 "position indices");
    expect_below(file, mesh.joints, file.arrays().joint_count, "joints");
    expect_below(file, mesh.delta_indices, mesh.position_count, "delta indices");
    expect_below(file, mesh.faces.narrow_span(), mesh.position_count, "faces");
    expect_below(file, mesh.adjacent_faces.narrow_span(), mesh.face_count(), "adjacent faces");
    expect_runs(file, mesh.first_adjacent_face, mesh.adjacent_faces.count, "adjacent faces");
    expect_runs(file, mesh.first_vertex, mesh.vertex_count, "vertices");
  }
  const Skeleton& skeleton = file.deformer_arrays().skeleton;
  expect_below(file, skeleton.order, skeleton.joint_count, "order of joints");
}

// Positions and vertices are written by whoever comes to them: each by one.
TEST(BakedDeformer, NothingIsWrittenTwice) {
  OpenBaked file(grid_deformer());
  const DeformMesh& mesh = file.mesh(0);
  EXPECT_EQ(file.status_with(mesh.position_indices, 1, mesh.position_indices[0]),
            MIEN_ERROR_BAKED_STRUCTURE);
  for (size_t i = 0; i < mesh.vertices.count; i += 13) {
    const uint32_t mark = mesh.vertices[i] & kHardEdge;
    const uint32_t other = mesh.vertices[(i + 1) % mesh.vertices.count] & ~kHardEdge;
    for (const uint32_t wrong : {other, mesh.vertex_count, kHardEdge - 1}) {
      EXPECT_EQ(file.status_with(mesh.vertices, i, wrong | mark), MIEN_ERROR_BAKED_STRUCTURE);
    }
  }
}

// Normals of hard edges find their direction by the list of positions.
TEST(BakedDeformer, HardEdgesAreThoseListed) {
  OpenBaked file(grid_deformer());
  const DeformMesh& mesh = file.mesh(0);
  ASSERT_GT(mesh.hard_positions.count, 2u);
  ASSERT_LT(mesh.hard_positions.count, mesh.position_count);
  for (size_t i = 0; i < mesh.hard_positions.count; i += 7) {
    for (const uint64_t wrong : {uint64_t{mesh.hard_positions[i]} + 1,
                                 uint64_t{mesh.position_count}, kLargest<uint32_t>}) {
      EXPECT_EQ(file.status_with(mesh.hard_positions, i, wrong), MIEN_ERROR_BAKED_STRUCTURE);
    }
  }
  uint32_t p = 0;
  while (mesh.hard_positions[0] == p || mesh.first_vertex[p] == mesh.first_vertex[p + 1]) ++p;
  const uint32_t at = mesh.first_vertex[p];
  EXPECT_EQ(file.status_with(mesh.vertices, at, mesh.vertices[at] | kHardEdge),
            MIEN_ERROR_BAKED_STRUCTURE);
}

TEST(BakedDeformer, RunsOfWeightsFollowEachOther) {
  OpenBaked file(grid_deformer());
  const DeformMesh& mesh = file.mesh(0);
  ASSERT_GT(mesh.skin_runs.count, 3u);
  for (const size_t r : {size_t{0}, mesh.skin_runs.count / 2, mesh.skin_runs.count - 1}) {
    SkinRun& run = mesh.skin_runs[r];
    for (const uint64_t step : {uint64_t{1}, uint64_t{0xFFFFFFFF}}) {
      EXPECT_EQ(file.status_with(run.first, run.first + step), MIEN_ERROR_BAKED_STRUCTURE);
      EXPECT_EQ(file.status_with(run.count, run.count + step), MIEN_ERROR_BAKED_STRUCTURE);
      EXPECT_EQ(file.status_with(run.influences, run.influences + step),
                MIEN_ERROR_BAKED_STRUCTURE);
      EXPECT_EQ(file.status_with(run.first_weight, run.first_weight + step),
                MIEN_ERROR_BAKED_STRUCTURE);
      EXPECT_EQ(file.status_with(run.first_weight, run.first_weight + (step << 32)),
                MIEN_ERROR_BAKED_STRUCTURE);
    }
    EXPECT_EQ(file.status_with(run.count, 0), MIEN_ERROR_BAKED_STRUCTURE);
    EXPECT_EQ(file.status_with(run.zero, 1), MIEN_ERROR_BAKED_STRUCTURE);
  }
}

TEST(BakedDeformer, RunsOfTargetsStayInTheirBlocks) {
  DeformRigOptions options;
  options.rows = options.columns = 40;
  OpenBaked file(grid_deformer(options));
  const DeformMesh& mesh = file.mesh(0);
  ASSERT_GT(mesh.block_count(), 2u);
  expect_runs(file, mesh.first_target_run, mesh.target_runs.count, "target runs");
  ASSERT_GT(mesh.target_runs.count, 4u);
  for (const size_t r : {size_t{0}, mesh.target_runs.count / 2, mesh.target_runs.count - 1}) {
    TargetRun& run = mesh.target_runs[r];
    EXPECT_EQ(file.status_with(run.target, mesh.target_count), MIEN_ERROR_BAKED_STRUCTURE);
    EXPECT_EQ(file.status_with(run.channel, file.arrays().channel_count),
              MIEN_ERROR_BAKED_STRUCTURE);
    for (const uint64_t step : {uint64_t{1}, uint64_t{0xFFFFFFFF}}) {
      EXPECT_EQ(file.status_with(run.first_delta, run.first_delta + step),
                MIEN_ERROR_BAKED_STRUCTURE);
      EXPECT_EQ(file.status_with(run.count, run.count + step), MIEN_ERROR_BAKED_STRUCTURE);
    }
  }
  // Targets of a block ascend.
  TargetRun& second = mesh.target_runs[mesh.first_target_run[0] + 1];
  EXPECT_EQ(file.status_with(second.target, mesh.target_runs[0].target),
            MIEN_ERROR_BAKED_STRUCTURE);
  // The last block is not full.
  const uint32_t last_block = mesh.block_count() - 1;
  const uint32_t left = mesh.position_count - last_block * kBlockPositions;
  ASSERT_LT(left, kBlockPositions);
  const TargetRun& last = mesh.target_runs[mesh.first_target_run[last_block]];
  EXPECT_EQ(file.status_with(mesh.delta_indices, last.first_delta, left - 1), MIEN_OK);
  EXPECT_EQ(file.status_with(mesh.delta_indices, last.first_delta, left),
            MIEN_ERROR_BAKED_STRUCTURE);
}

// Numbers stand in a table at the beginning of the part, 8 bytes each, of which the first 4 count.
TEST(BakedDeformer, NumbersAgreeWithTheirArrays) {
  const Bytes bytes = grid_deformer();
  BakedPart part;
  memcpy(&part, bytes.data() + sizeof(BakedHeader) + sizeof(part), sizeof(part));
  const AlignedBytes file(bytes);
  for (uint32_t i = 0; i < part.number_count; ++i) {
    uint64_t number;
    uint8_t* at = file.data() + part.offset + i * sizeof(number);
    memcpy(&number, at, sizeof(number));
    for (const uint64_t value : {number + 1, number - 1, number * 2 + 1, uint64_t{0xFFFFFFFF},
                                 uint64_t{0x80000000}, ~uint64_t{0}}) {
      memcpy(at, &value, sizeof(value));
      const ExerciseBaked life = exercise_baked(file.data(), file.size());
      EXPECT_EQ(life.broken, "") << "number " << i << " is " << value;
      // The first five are choices; the last six of twelve of each mesh are scales, and how faces are wound; all others
      // count something.
      const bool counts = i >= 5 && (i - 5) % 8 < 6;
      if (counts && memcmp(&value, &number, sizeof(uint32_t)) != 0) {
        EXPECT_EQ(life.opened, MIEN_ERROR_BAKED_STRUCTURE) << "number " << i << " is " << value;
      }
    }
    memcpy(at, &number, sizeof(number));
  }
}

// Harmless, but wrong: found by those who ask for all checks and have no better checksum.
TEST(BakedDeformer, FullCheckKnowsTheOrderOfJoints) {
  OpenBaked file(grid_deformer());
  const Span<uint16_t>& order = file.deformer_arrays().skeleton.order;
  std::swap(order[0], order[order.count - 1]);
  EXPECT_EQ(exercise_baked(file.bytes.data(), file.bytes.size()).broken, "");
  const BakedHandle safe = open_baked(file.bytes, MIEN_BAKED_CHECK_SAFE);
  EXPECT_TRUE(deformer_of(safe, rig_of(safe)));
  file.seal();
  const BakedHandle full = open_baked(file.bytes);
  deformer_of(full, rig_of(full), MIEN_ISA_BEST, MIEN_ERROR_BAKED_STRUCTURE);
}

// Memory is bounded by the file, whatever it announces.
TEST(BakedDeformer, MemoryIsBoundedByTheFile) {
  const Bytes bytes = grid_deformer();
  const AlignedBytes file(bytes);
  const BakedHandle baked = open_baked(file);
  const RigHandle rig = rig_of(baked);
  CountingAllocator counter;
  const MienAllocator allocator = counter.get();
  MienBakedDeformerDesc desc = sized<MienBakedDeformerDesc>();
  desc.allocator = &allocator;
  MienDeformer* deformer = nullptr;
  ASSERT_EQ(mien_deformer_from_baked(baked.get(), rig.get(), &desc, &deformer, nullptr), MIEN_OK);
  const DeformerHandle opened(deformer);
  EXPECT_EQ(counter.requests, 1u);
  EXPECT_LT(counter.bytes, bytes.size());
  MienDeformerInfo info = sized<MienDeformerInfo>();
  ASSERT_EQ(mien_deformer_info(deformer, &info), MIEN_OK);
  EXPECT_GT(info.deformer_bytes, counter.bytes);
  EXPECT_LT(info.deformer_bytes, counter.bytes + bytes.size());
}

}  // namespace
}  // namespace mien
