// SPDX-License-Identifier: MIT
// Deformers and deformer instances called wrongly, and how long they live.
#include "tests/support/counting_allocator.h"
#include "tests/support/deform_rig.h"
#include "tests/support/misuse.h"

namespace mien {
namespace {

class DeformMisuse : public Misuse {
 protected:
  void SetUp() override {
    Misuse::SetUp();
    MienDeformerDesc desc = sized<MienDeformerDesc>();
    desc.allocator = &kept.interface;
    ASSERT_EQ(mien_deformer_create(dna, rig, &desc, &deformer, nullptr), MIEN_OK);
    MienDeformerInstanceDesc instance_desc = sized<MienDeformerInstanceDesc>();
    instance_desc.allocator = &kept.interface;
    ASSERT_EQ(mien_deformer_instance_create(deformer, &instance_desc, &deformer_instance, nullptr),
              MIEN_OK);
  }
  void TearDown() override {
    mien_deformer_instance_destroy(deformer_instance);
    mien_deformer_destroy(deformer);
    Misuse::TearDown();
  }

  MienDeformer* deformer = nullptr;
  MienDeformerInstance* deformer_instance = nullptr;
};

struct Influences {
  MienIndex16View joints;
  MienFloatView weights;
};

std::vector<Outcome> calls_on(MienDeformer* deformer) {
  float deltas[18];
  uint32_t corners[12];
  Caller c;
  c.into_struct<MienDeformerInfo>("info", [&](auto* o) { return mien_deformer_info(deformer, o); });
  c.into_struct<MienMesh>("mesh", [&](auto* o) { return mien_deformer_mesh(deformer, 0, o); });
  c.plain<Influences>("influences", [&](auto* o) {
    return mien_deformer_influences(deformer, 0, 0, &o->joints, &o->weights);
  });
  c.nothing("triangles", [&] { return mien_deformer_triangles(deformer, 0, corners, 12); });
  c.nothing("texture_coordinates",
            [&] { return mien_deformer_texture_coordinates(deformer, 0, deltas, 12); });
  c.nothing("target", [&] { return mien_deformer_target(deformer, 0, 0, deltas, 18); });
  c.plain<MienFloatView>("bind", [&](auto* o) { return mien_deformer_bind_matrices(deformer, o); });
  c.plain<MienFloatView>("inverse_bind",
                         [&](auto* o) { return mien_deformer_inverse_bind_matrices(deformer, o); });
  c.with_error<MienDeformerInstance*>("deformer_instance_create", [&](auto* o, auto* e) {
    const MienStatus status = mien_deformer_instance_create(deformer, nullptr, o, e);
    mien_deformer_instance_destroy(*o);
    return status;
  });
  return c.outcomes;
}

std::vector<Outcome> calls_on(MienDeformerInstance* deformer_instance,
                              const MienInstance* instance) {
  using Floats = MienFloatView;
  float locals[30];
  Caller c;
  c.nothing("update", [&] { return mien_deformer_instance_update(deformer_instance, instance); });
  c.nothing("values", [&] {
    return mien_deformer_instance_update_from_values(deformer_instance, nullptr, 0, nullptr, 0);
  });
  c.plain<Floats>("joints", [&](auto* o) {
    return mien_deformer_instance_joint_matrices(deformer_instance, o);
  });
  c.plain<Floats>(
      "skins", [&](auto* o) { return mien_deformer_instance_skin_matrices(deformer_instance, o); });
  c.nothing("locals",
            [&] { return mien_deformer_instance_local_transforms(deformer_instance, locals, 30); });
  c.nothing("deform", [&] {
    return mien_deformer_instance_deform(deformer_instance, 0, MIEN_NORMALS_DEFAULT, nullptr);
  });
  float positions[18];
  MienVertexOutput output = sized<MienVertexOutput>();
  output.vertex_capacity = 6;
  output.positions = {positions, 12, MIEN_VERTEX_FORMAT_FLOAT32X3};
  c.nothing("write", [&] {
    return mien_deformer_instance_write_vertices(deformer_instance, 0, 0, &output, nullptr);
  });
  c.nothing("write_batch", [&] {
    return mien_deformer_instance_write_vertices_batch(&deformer_instance, 1, 0, 0, &output,
                                                       nullptr);
  });
  c.nothing("batch", [&] {
    return mien_deformer_instance_deform_batch(&deformer_instance, 1, 0, 0, nullptr);
  });
  c.plain<Floats>("positions", [&](auto* o) {
    return mien_deformer_instance_positions(deformer_instance, 0, o);
  });
  c.plain<Floats>("normals",
                  [&](auto* o) { return mien_deformer_instance_normals(deformer_instance, 0, o); });
  return c.outcomes;
}

TEST_F(DeformMisuse, LiveHandlesAreAccepted) {
  expect_all(calls_on(deformer), MIEN_OK);
  expect_all(calls_on(deformer_instance, instance), MIEN_OK);
}

TEST_F(DeformMisuse, NullIsNoHandle) {
  expect_all(calls_on(static_cast<MienDeformer*>(nullptr)), MIEN_ERROR_NULL_ARGUMENT);
  expect_all(calls_on(static_cast<MienDeformerInstance*>(nullptr), instance),
             MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_deformer_instance_update(deformer_instance, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  mien_deformer_destroy(nullptr);
  mien_deformer_instance_destroy(nullptr);
}

TEST_F(DeformMisuse, HandlesOfAnotherKindAreRefused) {
  alignas(8) uint8_t zeros[64] = {};
  void* const odd = reinterpret_cast<uint8_t*>(deformer_instance) + 1;
  for (void* wrong : {static_cast<void*>(dna), static_cast<void*>(report), static_cast<void*>(rig),
                      static_cast<void*>(instance), static_cast<void*>(deformer),
                      static_cast<void*>(deformer_instance), static_cast<void*>(zeros), odd}) {
    if (wrong != deformer) {
      expect_all(calls_on(static_cast<MienDeformer*>(wrong)), MIEN_ERROR_HANDLE);
      mien_deformer_destroy(static_cast<MienDeformer*>(wrong));
    }
    if (wrong != deformer_instance) {
      expect_all(calls_on(static_cast<MienDeformerInstance*>(wrong), instance), MIEN_ERROR_HANDLE);
      mien_deformer_instance_destroy(static_cast<MienDeformerInstance*>(wrong));
    }
    if (wrong != instance) {
      EXPECT_EQ(mien_deformer_instance_update(deformer_instance, static_cast<MienInstance*>(wrong)),
                MIEN_ERROR_HANDLE);
    }
    MienDeformer* made = nullptr;
    if (wrong != dna) {
      EXPECT_EQ(mien_deformer_create(static_cast<MienDna*>(wrong), rig, nullptr, &made, nullptr),
                MIEN_ERROR_HANDLE);
    }
    if (wrong != rig) {
      EXPECT_EQ(mien_deformer_create(dna, static_cast<MienRig*>(wrong), nullptr, &made, nullptr),
                MIEN_ERROR_HANDLE);
    }
  }
}

// It keeps what it needs of its deformer.
TEST_F(DeformMisuse, InstancesOutliveTheirDeformer) {
  mien_deformer_destroy(deformer);
  deformer = nullptr;
  expect_all(calls_on(deformer_instance, instance), MIEN_OK);
}

TEST_F(DeformMisuse, IndicesPastTheEnd) {
  MienMesh mesh = sized<MienMesh>();
  Influences influences;
  float deltas[18];
  EXPECT_EQ(mien_deformer_mesh(deformer, 1, &mesh), MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_deformer_influences(deformer, 1, 0, &influences.joints, &influences.weights),
            MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_deformer_influences(deformer, 0, 6, &influences.joints, &influences.weights),
            MIEN_ERROR_INDEX);
  uint32_t corners[12];
  EXPECT_EQ(mien_deformer_triangles(deformer, 1, corners, 12), MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_deformer_texture_coordinates(deformer, 1, deltas, 12), MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_deformer_triangles(deformer, 0, corners, 11), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_deformer_texture_coordinates(deformer, 0, deltas, 11),
            MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_deformer_target(deformer, 1, 0, deltas, 18), MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_deformer_target(deformer, 0, 1, deltas, 18), MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_deformer_instance_deform(deformer_instance, 1, 0, nullptr), MIEN_ERROR_INDEX);
  MienFloatView view = {};
  EXPECT_EQ(mien_deformer_instance_positions(deformer_instance, 1, &view), MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_deformer_instance_normals(deformer_instance, ~0u, &view), MIEN_ERROR_INDEX);
}

TEST_F(DeformMisuse, OutputsThatAreNotThere) {
  MienIndex16View joints = {};
  MienFloatView view = {};
  EXPECT_EQ(mien_deformer_create(dna, rig, nullptr, nullptr, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_deformer_info(deformer, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_deformer_mesh(deformer, 0, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_deformer_influences(deformer, 0, 0, nullptr, &view), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_deformer_influences(deformer, 0, 0, &joints, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_deformer_triangles(deformer, 0, nullptr, 12), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_deformer_texture_coordinates(deformer, 0, nullptr, 12), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_deformer_target(deformer, 0, 0, nullptr, 18), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_deformer_bind_matrices(deformer, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_deformer_inverse_bind_matrices(deformer, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_deformer_instance_create(deformer, nullptr, nullptr, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_deformer_instance_joint_matrices(deformer_instance, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_deformer_instance_skin_matrices(deformer_instance, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_deformer_instance_local_transforms(deformer_instance, nullptr, 30),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_deformer_instance_positions(deformer_instance, 0, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_deformer_instance_normals(deformer_instance, 0, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_deformer_instance_deform_batch(nullptr, 1, 0, 0, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_deformer_instance_deform_batch(nullptr, 0, 0, 0, nullptr), MIEN_OK);
}

TEST_F(DeformMisuse, BuffersOfTheWrongSize) {
  float floats[64] = {};
  EXPECT_EQ(mien_deformer_target(deformer, 0, 0, floats, 17), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_deformer_instance_local_transforms(deformer_instance, floats, 29),
            MIEN_ERROR_INVALID_ARGUMENT);
  const auto update = [&](const float* joints, size_t joint_count, const float* weights,
                          size_t weight_count) {
    return mien_deformer_instance_update_from_values(deformer_instance, joints, joint_count,
                                                     weights, weight_count);
  };
  EXPECT_EQ(update(floats, 27, floats, 2), MIEN_OK);
  EXPECT_EQ(update(floats, 27, nullptr, 0), MIEN_OK);
  EXPECT_EQ(update(nullptr, 0, floats, 2), MIEN_OK);
  for (size_t wrong : {size_t{0}, size_t{26}, size_t{28}, size_t{30}}) {
    EXPECT_EQ(update(floats, wrong, floats, 2), MIEN_ERROR_INVALID_ARGUMENT) << wrong;
  }
  EXPECT_EQ(update(floats, 27, floats, 3), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(update(nullptr, 27, floats, 2), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(update(floats, 27, nullptr, 2), MIEN_ERROR_INVALID_ARGUMENT);
}

TEST_F(DeformMisuse, DescriptionsThatAreNone) {
  const auto create = [&](auto&& change) {
    MienDeformerDesc desc = sized<MienDeformerDesc>();
    change(desc);
    MienError error = sized<MienError>();
    MienDeformer* made = nullptr;
    const MienStatus status = mien_deformer_create(dna, rig, &desc, &made, &error);
    EXPECT_EQ(made, nullptr);
    EXPECT_NE(error.message[0], 0);
    return status;
  };
  using Desc = MienDeformerDesc;
  EXPECT_EQ(create([](Desc& d) { d.struct_size = 4; }), MIEN_ERROR_STRUCT_SIZE);
  EXPECT_EQ(create([](Desc& d) { d.isa = 6; }), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(create([](Desc& d) { d.compose = 2; }), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(create([](Desc& d) { d.weights = 2; }), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(create([](Desc& d) { d.normals = 4; }), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(create([](Desc& d) { d.storage = 2; }), MIEN_ERROR_INVALID_ARGUMENT);
  const MienAllocator half = {nullptr, kept.interface.allocate, nullptr};
  EXPECT_EQ(create([&](Desc& d) { d.allocator = &half; }), MIEN_ERROR_INVALID_ARGUMENT);
  for (uint32_t isa = MIEN_ISA_SCALAR; isa <= MIEN_ISA_NEON; ++isa) {
    if (mien_isa_available(isa)) continue;
    EXPECT_EQ(create([&](Desc& d) { d.isa = isa; }), MIEN_ERROR_ISA);
  }
  const RigHandle quaternions = create_rig(dna, 0, MIEN_OK, MIEN_ROTATION_OUTPUT_QUATERNION);
  MienDeformerDesc add = sized<MienDeformerDesc>();
  add.compose = MIEN_COMPOSE_EULER_ADD;
  MienDeformer* made = nullptr;
  EXPECT_EQ(mien_deformer_create(dna, quaternions.get(), &add, &made, nullptr),
            MIEN_ERROR_INVALID_ARGUMENT);

  Longer<MienDeformerDesc> longer;
  ASSERT_EQ(mien_deformer_create(dna, rig, &longer.known, &made, nullptr), MIEN_OK);
  mien_deformer_destroy(made);
  longer.tail[3] = 1;
  EXPECT_EQ(mien_deformer_create(dna, rig, &longer.known, &made, nullptr), MIEN_ERROR_STRUCT_SIZE);

  MienDeformerInstance* created = nullptr;
  MienDeformerInstanceDesc desc = sized<MienDeformerInstanceDesc>();
  desc.struct_size = 8;
  EXPECT_EQ(mien_deformer_instance_create(deformer, &desc, &created, nullptr),
            MIEN_ERROR_STRUCT_SIZE);
  desc = sized<MienDeformerInstanceDesc>();
  desc.allocator = &half;
  EXPECT_EQ(mien_deformer_instance_create(deformer, &desc, &created, nullptr),
            MIEN_ERROR_INVALID_ARGUMENT);
}

TEST_F(DeformMisuse, LongerOutputsAreClearedBehindWhatIsKnown) {
  Longer<MienMesh> mesh;
  memset(mesh.tail, 0xA5, sizeof(mesh.tail));
  ASSERT_EQ(mien_deformer_mesh(deformer, 0, &mesh.known), MIEN_OK);
  EXPECT_TRUE(mesh.tail_is(0));
  EXPECT_EQ(mesh.known.position_count, 6u);
  Longer<MienDeformerInfo> info;
  memset(info.tail, 0xA5, sizeof(info.tail));
  ASSERT_EQ(mien_deformer_info(deformer, &info.known), MIEN_OK);
  EXPECT_TRUE(info.tail_is(0));
  info.known.struct_size = 40;
  EXPECT_EQ(mien_deformer_info(deformer, &info.known), MIEN_ERROR_STRUCT_SIZE);
}

TEST_F(DeformMisuse, NormalsAndThreadsThatAreNone) {
  EXPECT_EQ(mien_deformer_instance_deform(deformer_instance, 0, 4, nullptr),
            MIEN_ERROR_INVALID_ARGUMENT);
  const MienParallelFor nobody = {nullptr, nullptr};
  EXPECT_EQ(mien_deformer_instance_deform(deformer_instance, 0, 0, &nobody),
            MIEN_ERROR_INVALID_ARGUMENT);
}

TEST_F(DeformMisuse, InstancesOfAnotherRig) {
  const Character other(create_rig(dna));
  EXPECT_EQ(mien_deformer_instance_update(deformer_instance, other.instance.get()),
            MIEN_ERROR_MISMATCH);
}

TEST_F(DeformMisuse, BatchesThatDoNotFit) {
  const DeformerHandle other = create_deformer(dna, rig);
  const DeformerInstanceHandle stranger = create_deformer_instance(other.get()),
                               second = create_deformer_instance(deformer);
  float moved[27] = {0, 5};
  ASSERT_EQ(mien_deformer_instance_update_from_values(second.get(), moved, 27, nullptr, 0),
            MIEN_OK);
  const auto deform = [&](std::vector<MienDeformerInstance*> instances) {
    return mien_deformer_instance_deform_batch(instances.data(), instances.size(), 0, 0, nullptr);
  };
  const std::vector<float> before(Deformed::positions(second.get(), 0).begin(),
                                  Deformed::positions(second.get(), 0).end());
  EXPECT_EQ(deform({second.get(), deformer_instance, second.get()}), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(deform({second.get(), stranger.get()}), MIEN_ERROR_MISMATCH);
  EXPECT_EQ(deform({second.get(), nullptr}), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_TRUE(same_bits(Deformed::positions(second.get(), 0), span_of(before)));
  // What was refused leaves no trace.
  EXPECT_EQ(deform({second.get(), deformer_instance}), MIEN_OK);
  EXPECT_FALSE(same_bits(Deformed::positions(second.get(), 0), span_of(before)));
}

// Vertex output -----------------------------------------------------------------------------------

/// Six vertices of the tiny rig, interleaved, and what is done about them.
class VertexMisuse : public DeformMisuse {
 protected:
  void SetUp() override {
    DeformMisuse::SetUp();
    MienDeformerDesc desc = {};
    desc.with_tangents = 1;
    with_tangents = create_deformer(dna, rig, desc);
    able = create_deformer_instance(with_tangents.get());
    output.vertex_capacity = 6;
    output.positions = {bytes_at(0), 32, MIEN_VERTEX_FORMAT_FLOAT32X3};
    output.normals = {bytes_at(12), 32, MIEN_VERTEX_FORMAT_SNORM10_10_10_2};
    output.tangents = {bytes_at(16), 32, MIEN_VERTEX_FORMAT_SNORM16X4};
    memset(memory, 0xA5, sizeof(memory));
  }
  void TearDown() override {
    able.reset();
    with_tangents.reset();
    DeformMisuse::TearDown();
  }
  uint8_t* bytes_at(size_t offset) { return reinterpret_cast<uint8_t*>(memory) + offset; }

  MienStatus write() {
    return mien_deformer_instance_write_vertices(able.get(), 0, 0, &output, nullptr);
  }
  template <class Change>
  void expect_refused(Change&& change, MienStatus status = MIEN_ERROR_INVALID_ARGUMENT) {
    const MienVertexOutput before = output;
    change(output);
    EXPECT_EQ(write(), status);
    output = before;
    for (uint32_t word : memory) EXPECT_EQ(word, 0xA5A5A5A5u);
  }

  uint32_t memory[2 * 6 * 8 + 8];
  DeformerHandle with_tangents;
  DeformerInstanceHandle able;
  MienVertexOutput output = sized<MienVertexOutput>();
};

TEST_F(VertexMisuse, AGoodOutputIsAccepted) {
  EXPECT_EQ(write(), MIEN_OK);
  EXPECT_NE(memory[0], 0xA5A5A5A5u);
}

TEST_F(VertexMisuse, OutputsThatAreNotThere) {
  EXPECT_EQ(mien_deformer_instance_write_vertices(able.get(), 0, 0, nullptr, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_deformer_instance_write_vertices_batch(nullptr, 1, 0, 0, &output, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_deformer_instance_write_vertices_batch(nullptr, 0, 0, 0, nullptr, nullptr),
            MIEN_OK);
  expect_refused(
      [](MienVertexOutput& o) { o.positions.data = o.normals.data = o.tangents.data = nullptr; });
}

TEST_F(VertexMisuse, FormatsThatAnAttributeDoesNotTake) {
  for (uint32_t format : {2u, 3u, 4u, ~0u}) {
    expect_refused([&](MienVertexOutput& o) { o.positions.format = format; });
  }
  for (uint32_t format : {4u, ~0u}) {
    expect_refused([&](MienVertexOutput& o) { o.normals.format = format; });
    expect_refused([&](MienVertexOutput& o) { o.tangents.format = format; });
  }
  expect_refused(
      [](MienVertexOutput& o) { o.tangents.format = MIEN_VERTEX_FORMAT_FLOAT32X3; });  // no w
}

TEST_F(VertexMisuse, MemoryThatIsTooShortOrMisaligned) {
  expect_refused([](MienVertexOutput& o) { o.vertex_capacity = 5; });
  expect_refused([](MienVertexOutput& o) { o.vertex_capacity = 0; });
  for (uint32_t stride : {0u, 4u, 8u, 13u, 30u, 33u}) {
    expect_refused([&](MienVertexOutput& o) {
      o.normals.data = o.tangents.data = nullptr;
      o.positions.stride = stride;
    });
  }
  for (size_t offset : {1u, 2u, 3u}) {
    expect_refused([&](MienVertexOutput& o) { o.positions.data = bytes_at(offset); });
    expect_refused([&](MienVertexOutput& o) { o.tangents.data = bytes_at(20 + offset); });
  }
}

TEST_F(VertexMisuse, StreamsThatOverlap) {
  expect_refused([&](MienVertexOutput& o) { o.normals.data = bytes_at(8); });
  expect_refused([&](MienVertexOutput& o) { o.normals.data = bytes_at(20); });
  expect_refused([&](MienVertexOutput& o) { o.tangents.data = o.positions.data; });
  expect_refused([&](MienVertexOutput& o) { o.normals.data = bytes_at(32 * 5 + 8); });
  expect_refused([&](MienVertexOutput& o) { o.normals.stride = 36; });
  output.normals.data = bytes_at(32 * 6);  // behind the others
  output.normals.stride = 4;
  EXPECT_EQ(write(), MIEN_OK);
}

TEST_F(VertexMisuse, TangentsOfADeformerWithoutThem) {
  EXPECT_EQ(mien_deformer_instance_write_vertices(deformer_instance, 0, 0, &output, nullptr),
            MIEN_ERROR_INVALID_ARGUMENT);
  output.tangents.data = nullptr;
  EXPECT_EQ(mien_deformer_instance_write_vertices(deformer_instance, 0, 0, &output, nullptr),
            MIEN_OK);
  EXPECT_EQ(mesh_of(deformer, 0).tangents.count, 0u);
}

TEST_F(VertexMisuse, ArgumentsAsOfDeforming) {
  const MienParallelFor nobody = {nullptr, nullptr};
  EXPECT_EQ(mien_deformer_instance_write_vertices(able.get(), 1, 0, &output, nullptr),
            MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_deformer_instance_write_vertices(able.get(), 0, 4, &output, nullptr),
            MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_deformer_instance_write_vertices(able.get(), 0, 0, &output, &nobody),
            MIEN_ERROR_INVALID_ARGUMENT);
}

TEST_F(VertexMisuse, StructsOfAnotherSize) {
  expect_refused([](MienVertexOutput& o) { o.struct_size = 0; }, MIEN_ERROR_STRUCT_SIZE);
  expect_refused([](MienVertexOutput& o) { o.struct_size -= 4; }, MIEN_ERROR_STRUCT_SIZE);
  expect_refused([](MienVertexOutput& o) { o.struct_size += 1; }, MIEN_ERROR_STRUCT_SIZE);
  Longer<MienVertexOutput> longer[2];
  const DeformerInstanceHandle second = create_deformer_instance(with_tangents.get());
  MienDeformerInstance* const both[] = {able.get(), second.get()};
  for (size_t i = 0; i < 2; ++i) {
    const size_t size = longer[i].known.struct_size;
    longer[i].known = output;
    longer[i].known.struct_size = size;
    longer[i].known.positions.data = bytes_at(i * 6 * 32);
    longer[i].known.normals.data = longer[i].known.tangents.data = nullptr;
  }
  const auto write_both = [&] {
    return mien_deformer_instance_write_vertices_batch(both, 2, 0, 0, &longer[0].known, nullptr);
  };
  EXPECT_EQ(write_both(), MIEN_OK);
  EXPECT_NE(memory[6 * 8], 0xA5A5A5A5u);  // the second output was found
  longer[1].known.struct_size -= 8;
  EXPECT_EQ(write_both(), MIEN_ERROR_STRUCT_SIZE);
  longer[1].known.struct_size += 8;
  longer[1].tail[0] = 1;
  EXPECT_EQ(write_both(), MIEN_ERROR_STRUCT_SIZE);
}

TEST_F(VertexMisuse, OutputsOfABatchThatOverlap) {
  const DeformerInstanceHandle second = create_deformer_instance(with_tangents.get());
  const auto status_at = [&](size_t first_offset, size_t second_offset) {
    MienVertexOutput outputs[2] = {output, output};
    const size_t offsets[2] = {first_offset, second_offset};
    for (size_t i = 0; i < 2; ++i) {
      for (MienVertexStream* stream :
           {&outputs[i].positions, &outputs[i].normals, &outputs[i].tangents}) {
        stream->data = static_cast<uint8_t*>(stream->data) + offsets[i];
      }
      outputs[i].tangents.data = nullptr;
    }
    MienDeformerInstance* const both[] = {able.get(), second.get()};
    return mien_deformer_instance_write_vertices_batch(both, 2, 0, 0, outputs, nullptr);
  };
  EXPECT_EQ(status_at(0, 0), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(status_at(0, 8), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(status_at(8, 0), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(status_at(0, 32 * 5), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(status_at(32 * 5, 0), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(status_at(0, 16), MIEN_OK);  // interleaved
  EXPECT_EQ(status_at(0, 32 * 6), MIEN_OK);
  EXPECT_EQ(status_at(32 * 6, 0), MIEN_OK);
}

TEST(CapiDeform, VerticesOfMeshesWithoutMemoryAreNotWritten) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 2);
  const RigHandle rig = create_rig(dna.get());
  const DeformerHandle deformer = create_deformer(dna.get(), rig.get());
  const DeformerInstanceHandle last = create_deformer_instance(deformer.get(), uint64_t{1} << 7);
  std::vector<float> positions(mesh_of(deformer.get(), 0).vertex_count * 3);
  MienVertexOutput output = sized<MienVertexOutput>();
  output.vertex_capacity = positions.size() / 3;
  output.positions = {positions.data(), 12, MIEN_VERTEX_FORMAT_FLOAT32X3};
  EXPECT_EQ(mien_deformer_instance_write_vertices(last.get(), 0, 0, &output, nullptr),
            MIEN_ERROR_LOD);
}

// A deformer instance with memory for the meshes of some LODs.
TEST(CapiDeform, RoomForSomeLods) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 2);
  const RigHandle rig = create_rig(dna.get());
  const DeformerHandle deformer = create_deformer(dna.get(), rig.get());
  MienDeformerInfo info = sized<MienDeformerInfo>();
  ASSERT_EQ(mien_deformer_info(deformer.get(), &info), MIEN_OK);
  EXPECT_EQ(info.mesh_count, count_of(rig, MIEN_KIND_MESH));
  EXPECT_EQ(info.joint_count, count_of(rig, MIEN_KIND_JOINT));
  EXPECT_EQ(info.channel_count, count_of(rig, MIEN_KIND_BLEND_SHAPE_CHANNEL));
  EXPECT_EQ(info.isa, info_of(rig).isa);
  EXPECT_EQ(info.normals, uint32_t{MIEN_NORMALS_RECOMPUTED});

  CountingAllocator counter;
  const MienAllocator allocator = counter.get();
  for (uint64_t lods : {uint64_t{0}, uint64_t{1}, uint64_t{6}, uint64_t{1} << 63}) {
    MienDeformerInstanceDesc desc = sized<MienDeformerInstanceDesc>();
    desc.lods = lods;
    desc.allocator = &allocator;
    MienDeformerInstance* deformer_instance = nullptr;
    ASSERT_EQ(mien_deformer_instance_create(deformer.get(), &desc, &deformer_instance, nullptr),
              MIEN_OK);
    EXPECT_EQ(counter.live, 1u);
    EXPECT_EQ(counter.bytes == info.instance_bytes, lods == 0);
    for (uint32_t m = 0; m < info.mesh_count; ++m) {
      const bool room = lods == 0 || (mesh_of(deformer.get(), m).lods & lods);
      MienFloatView view = {};
      EXPECT_EQ(mien_deformer_instance_deform(deformer_instance, m, 0, nullptr),
                room ? MIEN_OK : MIEN_ERROR_LOD);
      EXPECT_EQ(mien_deformer_instance_positions(deformer_instance, m, &view),
                room ? MIEN_OK : MIEN_ERROR_LOD);
      EXPECT_EQ(mien_deformer_instance_normals(deformer_instance, m, &view),
                room ? MIEN_OK : MIEN_ERROR_LOD);
    }
    mien_deformer_instance_destroy(deformer_instance);
    EXPECT_TRUE(counter.clean());
  }
}

// Everything goes on living while somebody needs it, in whatever order it is let go.
TEST(CapiDeform, TheOrderOfDestructionDoesNotMatter) {
  CountingAllocator counter;
  const MienAllocator allocator = counter.get();
  for (int order = 0; order < 6; ++order) {
    MienDna* dna = nullptr;
    MienGenerateDesc generate = sized<MienGenerateDesc>();
    generate.allocator = &allocator;
    ASSERT_EQ(mien_dna_generate(&generate, &dna, nullptr), MIEN_OK);
    MienRigDesc rig_desc = sized<MienRigDesc>();
    rig_desc.allocator = &allocator;
    MienRig* rig = nullptr;
    ASSERT_EQ(mien_rig_create(dna, &rig_desc, &rig, nullptr), MIEN_OK);
    MienDeformerDesc deformer_desc = sized<MienDeformerDesc>();
    deformer_desc.allocator = &allocator;
    MienDeformer* deformer = nullptr;
    ASSERT_EQ(mien_deformer_create(dna, rig, &deformer_desc, &deformer, nullptr), MIEN_OK);
    mien_dna_close(dna);
    MienDeformerInstanceDesc instance_desc = sized<MienDeformerInstanceDesc>();
    instance_desc.allocator = &allocator;
    MienDeformerInstance* deformer_instance = nullptr;
    ASSERT_EQ(mien_deformer_instance_create(deformer, &instance_desc, &deformer_instance, nullptr),
              MIEN_OK);
    for (int step = 0; step < 3; ++step) {
      static constexpr int kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                            {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
      switch (kOrders[order][step]) {
        case 0: mien_rig_destroy(rig); break;
        case 1: mien_deformer_destroy(deformer); break;
        case 2:
          EXPECT_EQ(
              mien_deformer_instance_update_from_values(deformer_instance, nullptr, 0, nullptr, 0),
              MIEN_OK);
          EXPECT_EQ(mien_deformer_instance_deform(deformer_instance, 0, 0, nullptr), MIEN_OK);
          mien_deformer_instance_destroy(deformer_instance);
          break;
      }
    }
    EXPECT_TRUE(counter.clean()) << "order " << order << " " << counter.first_wrong;
  }
}

}  // namespace
}  // namespace mien
