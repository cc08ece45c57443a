// SPDX-License-Identifier: MIT
// Every call that takes memory, with every one of its requests failing in turn: the status says so,
// nothing is handed out, nothing is kept. And how many requests there are where none should be, or
// few.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <functional>

#include "tests/support/counted_news.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/dna_bytes.h"
#include "tests/support/golden.h"
#include "tests/support/random_layer_rig.h"
#include "tests/support/random_space_rig.h"
#include "tests/support/rig_handles.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

Bytes tiny_file() {
  Arena arena(default_allocator());
  return dna::written(dna::tiny_rig(arena));
}

/// A call that makes an object with an allocator, and the one that takes it back.
template <class Object>
struct Maker {
  std::function<MienStatus(const MienAllocator*, Object** out, MienError*)> make;
  void (*destroy)(Object*);
};

template <class Object>
void expect_failure(const Maker<Object>& maker, CountingAllocator& counter) {
  const MienAllocator allocator = counter.get();
  MienError error = sized<MienError>();
  Object* made = reinterpret_cast<Object*>(&error);  // to be overwritten
  EXPECT_STREQ(mien_status_name(maker.make(&allocator, &made, &error)), "MEMORY");
  EXPECT_EQ(made, nullptr);
  EXPECT_EQ(error.status, MIEN_ERROR_MEMORY);
  EXPECT_NE(error.message[0], 0);
  EXPECT_TRUE(counter.clean()) << counter.live << " blocks left; " << counter.first_wrong;
}

/// Number of requests that the call makes.
template <class Object>
size_t survive_every_failure(const Maker<Object>& maker) {
  size_t requests = 0;
  {
    CountingAllocator counter;
    const MienAllocator allocator = counter.get();
    MienError error = sized<MienError>();
    Object* made = nullptr;
    EXPECT_EQ(maker.make(&allocator, &made, &error), MIEN_OK) << error.message;
    requests = counter.requests;
    maker.destroy(made);
    EXPECT_TRUE(counter.clean()) << counter.live << " blocks left; " << counter.first_wrong;
  }
  for (size_t k = 1; k <= requests; ++k) {
    for (bool keep_failing : {false, true}) {
      SCOPED_TRACE("request " + std::to_string(k) + " of " + std::to_string(requests));
      CountingAllocator counter;
      counter.fail_at = k;
      counter.keep_failing = keep_failing;
      expect_failure(maker, counter);
    }
  }
  // A block that is not aligned as asked for is no block.
  CountingAllocator counter;
  counter.misalign = true;
  expect_failure(maker, counter);
  return requests;
}

Maker<MienDna> opener(const Bytes& bytes, uint32_t layers = 0, uint64_t lods = 0,
                      const MienCoordinateSystem* system = nullptr) {
  auto make = [&bytes, layers, lods, system](const MienAllocator* allocator, MienDna** out,
                                             MienError* error) {
    MienDnaDesc desc = sized<MienDnaDesc>();
    desc.system = system;
    desc.allocator = allocator;
    desc.layers = layers;
    desc.lods = lods;
    return mien_dna_open_memory(bytes.data(), bytes.size(), &desc, out, error);
  };
  return {make, mien_dna_close};
}

Maker<MienRig> compiler(const MienDna* dna, uint32_t storage = MIEN_STORAGE_32_BIT,
                        uint32_t rotation = MIEN_ROTATION_OUTPUT_EULER) {
  auto make = [=](const MienAllocator* allocator, MienRig** out, MienError* error) {
    MienRigDesc desc = sized<MienRigDesc>();
    desc.allocator = allocator;
    desc.storage = storage;
    desc.rotation_output = rotation;
    return mien_rig_create(dna, &desc, out, error);
  };
  return {make, mien_rig_destroy};
}

Maker<MienDna> generator(uint32_t preset, uint32_t flags = 0) {
  auto make = [preset, flags](const MienAllocator* allocator, MienDna** out, MienError* error) {
    MienGenerateDesc desc = sized<MienGenerateDesc>();
    desc.preset = preset;
    desc.flags = flags;
    desc.allocator = allocator;
    return mien_dna_generate(&desc, out, error);
  };
  return {make, mien_dna_close};
}

Maker<MienReport> examiner(const Bytes& bytes) {
  auto make = [&bytes](const MienAllocator* allocator, MienReport** out, MienError* error) {
    const auto desc = desc_with<MienValidateDesc>(allocator);
    return mien_dna_validate_memory(bytes.data(), bytes.size(), &desc, out, error);
  };
  return {make, mien_report_destroy};
}

class OutOfMemory : public testing::Test {
 protected:
  std::string folder;

  void SetUp() override {
    char made[] = "/tmp/mien_memory_XXXXXX";
    ASSERT_NE(mkdtemp(made), nullptr);
    folder = made;
  }
  void TearDown() override {
    remove(path().c_str());
    EXPECT_EQ(rmdir(folder.c_str()), 0) << "something else was left in " << folder;
  }
  std::string path() const { return folder + "/file.dna"; }
};

TEST_F(OutOfMemory, Open) {
  const Bytes tiny = tiny_file();
  EXPECT_GT(survive_every_failure(opener(tiny)), 1u);
  const Bytes generated = write_dna(generate_dna(MIEN_PRESET_SMALL, 1).get());
  for (uint32_t layers : {0u, 1u, 2u, 4u, 8u, 16u, 32u, 64u, 128u}) {
    for (uint64_t lods : {0u, 1u, 2u, 3u}) {
      survive_every_failure(opener(tiny, layers, lods));
      survive_every_failure(opener(generated, layers, lods));
    }
  }
}

TEST_F(OutOfMemory, OpenInAnotherSystem) {
  Random random = Random::from_seed(8, 1);
  const Bytes tiny = tiny_file();
  MienCoordinateSystem system = sized<MienCoordinateSystem>();
  for (const char* name : {"unreal", "opengl", "godot"}) {
    ASSERT_EQ(mien_coordinate_system_find(name, &system), MIEN_OK);
    survive_every_failure(opener(tiny, 0, 0, &system));
    survive_every_failure(opener(tiny, MIEN_LAYER_GEOMETRY, 2, &system));
    const Bytes body = write_dna(generate_dna(MIEN_PRESET_BODY, 1, MIEN_GENERATE_ML).get());
    survive_every_failure(opener(body, 0, 3, &system));
    Arena arena(default_allocator());
    dna::SpaceRigOptions options;
    options.euler_rows = false;
    const Bytes any = dna::written(dna::random_space_rig(random, options, arena));
    for (uint32_t rule : {MIEN_ROTATION_RULE_CARRIED, MIEN_ROTATION_RULE_EXACT}) {
      system.rotation_rule = rule;
      survive_every_failure(opener(any, 0, 0, &system));
    }
  }
}

TEST_F(OutOfMemory, OpenFile) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_TINY, 1);
  ASSERT_EQ(mien_dna_write_file(dna.get(), path().c_str(), nullptr, nullptr), MIEN_OK);
  size_t requests[2] = {};
  for (uint32_t access : {MIEN_FILE_MAP, MIEN_FILE_READ}) {
    auto make = [&](const MienAllocator* allocator, MienDna** out, MienError* error) {
      MienDnaDesc desc = sized<MienDnaDesc>();
      desc.allocator = allocator;
      desc.file_access = access;
      return mien_dna_open_file(path().c_str(), &desc, out, error);
    };
    requests[access] = survive_every_failure(Maker<MienDna>{make, mien_dna_close});
  }
  EXPECT_EQ(requests[MIEN_FILE_READ], requests[MIEN_FILE_MAP] + 1);
}

TEST_F(OutOfMemory, Generate) {
  for (uint32_t preset : {MIEN_PRESET_TINY, MIEN_PRESET_SMALL, MIEN_PRESET_MEDIUM}) {
    survive_every_failure(generator(preset));
  }
  survive_every_failure(generator(MIEN_PRESET_TINY, MIEN_GENERATE_ML));
  survive_every_failure(generator(MIEN_PRESET_BODY, MIEN_GENERATE_ML));
}

TEST_F(OutOfMemory, Report) {
  const Bytes tiny = tiny_file();
  EXPECT_GT(survive_every_failure(examiner(tiny)), 2u);
  Bytes broken = tiny;
  broken[broken.size() / 2] ^= 0xFF;
  survive_every_failure(examiner(broken));
  const Bytes generated = write_dna(generate_dna(MIEN_PRESET_SMALL, 1).get());
  survive_every_failure(examiner(generated));

  ASSERT_EQ(mien_dna_write_file(open_dna(tiny).get(), path().c_str(), nullptr, nullptr), MIEN_OK);
  auto make = [&](const MienAllocator* allocator, MienReport** out, MienError* error) {
    const auto desc = desc_with<MienValidateDesc>(allocator);
    return mien_dna_validate_file(path().c_str(), &desc, out, error);
  };
  survive_every_failure(Maker<MienReport>{make, mien_report_destroy});
}

TEST_F(OutOfMemory, CreateRig) {
  const Bytes tiny = tiny_file();
  EXPECT_GE(survive_every_failure(compiler(open_dna(tiny).get())), 1u);
  survive_every_failure(compiler(open_dna(tiny, 2).get()));
  // Every layer, in the other storage and form.
  for (uint64_t seed : {1, 2, 3}) {
    Random random = Random::from_seed(61, seed);
    const LayerFile file(random_layer_rig(random, false));
    survive_every_failure(
        compiler(file.dna.get(), MIEN_STORAGE_16_BIT, MIEN_ROTATION_OUTPUT_QUATERNION));
  }
  survive_every_failure(compiler(generate_dna(MIEN_PRESET_TINY, 1).get()));
  survive_every_failure(compiler(generate_dna(MIEN_PRESET_MEDIUM, 1).get()));
  survive_every_failure(compiler(generate_dna(MIEN_PRESET_BODY, 1, MIEN_GENERATE_ML).get()));
}

TEST_F(OutOfMemory, CreateInstance) {
  const RigHandle rig = create_rig(generate_dna(MIEN_PRESET_TINY, 1).get());
  auto make = [&](const MienAllocator* allocator, MienInstance** out, MienError* error) {
    const auto desc = desc_with<MienInstanceDesc>(allocator);
    return mien_instance_create(rig.get(), &desc, out, error);
  };
  const size_t requests = survive_every_failure(Maker<MienInstance>{make, mien_instance_destroy});
  EXPECT_EQ(requests, 1u);

  // A failed instance is no owner of the rig.
  CountingAllocator counter;
  const MienAllocator allocator = counter.get();
  MienRig* counted = nullptr;
  ASSERT_EQ(compiler(generate_dna(MIEN_PRESET_TINY, 1).get()).make(&allocator, &counted, nullptr),
            MIEN_OK);
  CountingAllocator broken;
  broken.fail_at = 1;
  const MienAllocator nothing = broken.get();
  MienInstance* instance = nullptr;
  const auto desc = desc_with<MienInstanceDesc>(&nothing);
  EXPECT_EQ(mien_instance_create(counted, &desc, &instance, nullptr), MIEN_ERROR_MEMORY);
  mien_rig_destroy(counted);
  EXPECT_TRUE(counter.clean());
}

TEST_F(OutOfMemory, CreateDeformer) {
  const Bytes tiny = tiny_file();
  const DnaHandle handles[] = {open_dna(tiny), generate_dna(MIEN_PRESET_TINY, 1),
                               generate_dna(MIEN_PRESET_SMALL, 1)};
  for (const DnaHandle& dna : handles) {
    const RigHandle rig = create_rig(dna.get());
    auto make = [&](const MienAllocator* allocator, MienDeformer** out, MienError* error) {
      MienDeformerDesc desc = sized<MienDeformerDesc>();
      desc.with_tangents = 1;
      desc.allocator = allocator;
      return mien_deformer_create(dna.get(), rig.get(), &desc, out, error);
    };
    EXPECT_GE(survive_every_failure(Maker<MienDeformer>{make, mien_deformer_destroy}), 2u);

    MienDeformer* deformer = nullptr;
    ASSERT_EQ(make(nullptr, &deformer, nullptr), MIEN_OK);
    auto pose = [&](const MienAllocator* allocator, MienDeformerInstance** out, MienError* error) {
      MienDeformerInstanceDesc desc = sized<MienDeformerInstanceDesc>();
      desc.allocator = allocator;
      return mien_deformer_instance_create(deformer, &desc, out, error);
    };
    EXPECT_EQ(
        survive_every_failure(Maker<MienDeformerInstance>{pose, mien_deformer_instance_destroy}),
        1u);
    mien_deformer_destroy(deformer);
  }
}

// A failed deformer or pose is no owner of what it would have kept alive.
TEST_F(OutOfMemory, FailuresKeepNothingAlive) {
  CountingAllocator counter, broken;
  broken.fail_at = 1;
  broken.keep_failing = true;
  const MienAllocator allocator = counter.get(), nothing = broken.get();
  const Bytes tiny = tiny_file();
  MienDna* dna = nullptr;
  MienRig* rig = nullptr;
  MienDeformer* deformer = nullptr;
  MienDeformerInstance* pose = nullptr;
  ASSERT_EQ(opener(tiny).make(&allocator, &dna, nullptr), MIEN_OK);
  ASSERT_EQ(compiler(dna).make(&allocator, &rig, nullptr), MIEN_OK);
  MienDeformerDesc desc = sized<MienDeformerDesc>();
  desc.allocator = &nothing;
  EXPECT_EQ(mien_deformer_create(dna, rig, &desc, &deformer, nullptr), MIEN_ERROR_MEMORY);
  desc.allocator = &allocator;
  ASSERT_EQ(mien_deformer_create(dna, rig, &desc, &deformer, nullptr), MIEN_OK);
  MienDeformerInstanceDesc pose_desc = sized<MienDeformerInstanceDesc>();
  pose_desc.allocator = &nothing;
  EXPECT_EQ(mien_deformer_instance_create(deformer, &pose_desc, &pose, nullptr), MIEN_ERROR_MEMORY);
  mien_deformer_destroy(deformer);
  mien_rig_destroy(rig);
  mien_dna_close(dna);
  EXPECT_TRUE(counter.clean()) << counter.first_wrong;
}

// Writing takes memory from the allocator of the DNA.
TEST_F(OutOfMemory, WriteFile) {
  const Bytes tiny = tiny_file();
  CountingAllocator counter;
  const MienAllocator allocator = counter.get();
  MienDna* dna = nullptr;
  ASSERT_EQ(opener(tiny).make(&allocator, &dna, nullptr), MIEN_OK);
  counter.restart();
  ASSERT_EQ(mien_dna_write_file(dna, path().c_str(), nullptr, nullptr), MIEN_OK);
  const size_t requests = counter.requests, bytes = counter.bytes;
  ASSERT_EQ(remove(path().c_str()), 0);
  for (size_t k = 1; k <= requests; ++k) {
    counter.restart();
    counter.fail_at = k;
    MienError error = sized<MienError>();
    EXPECT_EQ(mien_dna_write_file(dna, path().c_str(), nullptr, &error), MIEN_ERROR_MEMORY) << k;
    EXPECT_NE(error.message[0], 0);
    EXPECT_EQ(counter.bytes, bytes) << "memory of the failed call is left";
    EXPECT_NE(access(path().c_str(), F_OK), 0) << "half a file is left";
  }
  counter.fail_at = 0;
  // To memory it takes none at all.
  counter.restart();
  EXPECT_EQ(write_dna(dna), tiny);
  EXPECT_EQ(counter.requests, 0u);
  mien_dna_close(dna);
  EXPECT_TRUE(counter.clean()) << counter.first_wrong;
}

// What a lower version leaves out is checked for, which takes memory.
TEST_F(OutOfMemory, WriteALowerVersion) {
  const Bytes tiny = tiny_file();
  CountingAllocator counter;
  const MienAllocator allocator = counter.get();
  MienDna* dna = nullptr;
  ASSERT_EQ(opener(tiny).make(&allocator, &dna, nullptr), MIEN_OK);
  MienWriteDesc desc = sized<MienWriteDesc>();
  desc.version = 4;
  desc.unknown_layers = MIEN_UNKNOWN_LAYERS_DROP;
  counter.restart();
  size_t size = 0;
  ASSERT_EQ(mien_dna_write_memory(dna, &desc, nullptr, 0, &size, nullptr), MIEN_OK);
  const size_t requests = counter.requests, bytes = counter.bytes;
  ASSERT_GT(requests, 0u);
  for (size_t k = 1; k <= requests; ++k) {
    counter.restart();
    counter.fail_at = k;
    MienError error = sized<MienError>();
    EXPECT_EQ(mien_dna_write_memory(dna, &desc, nullptr, 0, &size, &error), MIEN_ERROR_MEMORY);
    EXPECT_NE(error.message[0], 0);
    EXPECT_EQ(counter.bytes, bytes);
  }
  mien_dna_close(dna);
  EXPECT_TRUE(counter.clean()) << counter.first_wrong;
}

// Views and look-ups while memory is out ----------------------------------------------------------

TEST_F(OutOfMemory, NothingElseAllocates) {
  CountingAllocator counter;
  const MienAllocator allocator = counter.get();
  const Bytes tiny = tiny_file();
  const Bytes generated = write_dna(generate_dna(MIEN_PRESET_TINY, 1).get());
  for (const Bytes& file : {tiny, generated}) {
    MienDna* dna = nullptr;
    MienRig* rig = nullptr;
    MienInstance* instance = nullptr;
    ASSERT_EQ(opener(file).make(&allocator, &dna, nullptr), MIEN_OK);
    ASSERT_EQ(compiler(dna).make(&allocator, &rig, nullptr), MIEN_OK);
    const auto instance_desc = desc_with<MienInstanceDesc>(&allocator);
    ASSERT_EQ(mien_instance_create(rig, &instance_desc, &instance, nullptr), MIEN_OK);
    MienDeformer* deformer = nullptr;
    MienDeformerInstance* pose = nullptr;
    MienDeformerDesc deformer_desc = sized<MienDeformerDesc>();
    deformer_desc.allocator = &allocator;
    deformer_desc.with_tangents = 1;
    ASSERT_EQ(mien_deformer_create(dna, rig, &deformer_desc, &deformer, nullptr), MIEN_OK);
    MienDeformerInstanceDesc pose_desc = sized<MienDeformerInstanceDesc>();
    pose_desc.allocator = &allocator;
    ASSERT_EQ(mien_deformer_instance_create(deformer, &pose_desc, &pose, nullptr), MIEN_OK);
    MienRigInfo info = sized<MienRigInfo>();
    ASSERT_EQ(mien_rig_info(rig, &info), MIEN_OK);

    std::vector<float> vertices(size_t{1} << 16);
    MienVertexOutput output = sized<MienVertexOutput>();
    output.vertex_capacity = vertices.size() / 10;
    output.positions = {vertices.data(), 40, MIEN_VERTEX_FORMAT_FLOAT32X3};
    output.normals = {vertices.data() + 3, 40, MIEN_VERTEX_FORMAT_FLOAT32X3};
    output.tangents = {vertices.data() + 6, 40, MIEN_VERTEX_FORMAT_FLOAT32X4};

    counter.restart();
    counter.fail_at = 1;
    counter.keep_failing = true;
    const size_t news = g_news;
    MienError error = sized<MienError>();
    MienStatus worst = MIEN_OK;
    size_t calls = 0;
    auto call = [&](MienStatus status) {
      ++calls;
      if (status != MIEN_OK) worst = status;
    };

    // DNA
    MienDnaInfo dna_info = sized<MienDnaInfo>();
    MienDnaLayer layer = sized<MienDnaLayer>();
    MienDnaField field = sized<MienDnaField>();
    MienStringView string;
    float number;
    int64_t integer;
    call(mien_dna_info(dna, &dna_info));
    call(mien_dna_layer(dna, 0, &layer));
    call(mien_dna_field(dna, "bhvr.joints.jointGroups[0].values", &field, &error));
    call(mien_dna_child_name(dna, "bhvr.joints", 0, &string, &error));
    call(mien_dna_read_floats(dna, "bhvr.joints.jointGroups[0].values", 0, 1, &number, &error));
    call(mien_dna_read_integers(dna, "desc.lodCount", 0, 1, &integer, &error));
    call(mien_dna_read_string(dna, "desc.name", &string, &error));

    // Rig
    for (uint32_t kind = 0; kind <= MIEN_KIND_JOINT_GROUP; ++kind) {
      uint32_t count = 0, found = 0;
      call(mien_rig_count(rig, kind, &count));
      if (count == 0) continue;
      call(mien_rig_name(rig, kind, count - 1, &string));
      if (kind != MIEN_KIND_JOINT_GROUP) {
        call(mien_rig_find_n(rig, kind, string.data, string.count, &found));
      }
    }
    MienIndex16View indices;
    MienFloatView floats;
    MienMutableFloatView inputs;
    call(mien_rig_joint_parents(rig, &indices));
    call(mien_rig_neutral_joint_values(rig, &floats));
    call(mien_rig_initial_raw_controls(rig, &floats));
    call(mien_rig_psd_inputs(rig, 0, &indices));

    // Instance
    call(mien_instance_gui_controls(instance, &inputs));
    call(mien_instance_raw_controls(instance, &inputs));
    call(mien_instance_ml_masks(instance, &inputs));
    for (auto view : {mien_instance_controls, mien_instance_psd_controls, mien_instance_ml_controls,
                      mien_instance_rbf_controls, mien_instance_joints, mien_instance_blend_shapes,
                      mien_instance_animated_maps}) {
      call(view(instance, &floats));
    }
    for (uint32_t lod = 0; lod < info.lod_count; ++lod) {
      MienRigStatistics statistics = sized<MienRigStatistics>();
      MienInstanceStatistics fetched = sized<MienInstanceStatistics>();
      call(mien_rig_statistics(rig, lod, &statistics));
      call(mien_instance_statistics(instance, &fetched));
      call(mien_rig_variable_joint_values(rig, lod, &indices));
      call(mien_rig_lod_indices(rig, MIEN_KIND_JOINT, lod, &indices));
      call(mien_rig_map_gui_to_raw(rig, instance));
      call(mien_rig_evaluate(rig, instance, lod));
      call(mien_rig_evaluate_stages(rig, instance, lod, MIEN_STAGE_PSD));
      call(mien_rig_evaluate_joint_group(rig, instance, lod, 0));
      call(mien_rig_map_raw_to_gui(rig, instance));
    }
    call(mien_instance_reset(instance));

    // Deformer and pose
    MienDeformerInfo deformer_info = sized<MienDeformerInfo>();
    call(mien_deformer_info(deformer, &deformer_info));
    call(mien_deformer_bind_matrices(deformer, &floats));
    call(mien_deformer_inverse_bind_matrices(deformer, &floats));
    call(mien_deformer_instance_update(pose, instance));
    call(mien_deformer_instance_joint_matrices(pose, &floats));
    call(mien_deformer_instance_skin_matrices(pose, &floats));
    for (uint32_t m = 0; m < deformer_info.mesh_count; ++m) {
      MienMesh mesh = sized<MienMesh>();
      call(mien_deformer_mesh(deformer, m, &mesh));
      call(mien_deformer_influences(deformer, m, 0, &indices, &floats));
      for (uint32_t normals = 0; normals <= MIEN_NORMALS_RECOMPUTED; ++normals) {
        call(mien_deformer_instance_deform(pose, m, normals, nullptr));
        call(mien_deformer_instance_deform_batch(&pose, 1, m, normals, nullptr));
        call(mien_deformer_instance_write_vertices(pose, m, normals, &output, nullptr));
        call(mien_deformer_instance_write_vertices_batch(&pose, 1, m, normals, &output, nullptr));
      }
      call(mien_deformer_instance_positions(pose, m, &floats));
      call(mien_deformer_instance_normals(pose, m, &floats));
    }

    EXPECT_EQ(worst, MIEN_OK);
    EXPECT_GT(calls, 40u);
    EXPECT_EQ(counter.requests, 0u);
    EXPECT_EQ(g_news, news);
    counter.fail_at = 0;
    mien_deformer_instance_destroy(pose);
    mien_deformer_destroy(deformer);
    mien_instance_destroy(instance);
    mien_rig_destroy(rig);
    mien_dna_close(dna);
    EXPECT_TRUE(counter.clean()) << counter.first_wrong;
  }
}

// A rig of production size takes a handful of blocks.
TEST_F(OutOfMemory, FewRequestsForALargeRig) {
  const Bytes file = write_dna(generate_dna(MIEN_PRESET_LARGE, 1).get());
  CountingAllocator counter;
  const MienAllocator allocator = counter.get();
  MienDna* dna = nullptr;
  ASSERT_EQ(opener(file).make(&allocator, &dna, nullptr), MIEN_OK);
  const size_t open_requests = counter.requests, open_peak = counter.peak;
  counter.restart();
  MienRig* rig = nullptr;
  ASSERT_EQ(compiler(dna).make(&allocator, &rig, nullptr), MIEN_OK);
  const size_t create_requests = counter.requests, create_peak = counter.peak - open_peak;
  MienRigInfo info = sized<MienRigInfo>();
  ASSERT_EQ(mien_rig_info(rig, &info), MIEN_OK);
  printf(
      "file of %zu bytes: opened with %zu requests, %zu bytes; compiled with %zu requests, %zu "
      "bytes at most, %llu for the rig\n",
      file.size(), open_requests, open_peak, create_requests, create_peak,
      static_cast<unsigned long long>(info.rig_bytes));
  EXPECT_LE(open_requests, 8u);
  EXPECT_LE(create_requests, 2u) << "the rig, and scratch memory";
  EXPECT_LE(open_peak, file.size());
  EXPECT_LE(create_peak, file.size());
  EXPECT_LE(create_peak, info.rig_bytes + info.rig_bytes * 3 / 10) << "scratch memory";
  mien_dna_close(dna);
  mien_rig_destroy(rig);
  EXPECT_TRUE(counter.clean()) << counter.first_wrong;
}

// A head's behavior, opened and compiled.
TEST_F(OutOfMemory, EightRequestsForAHead) {
  if (!golden::has_head()) GTEST_SKIP() << golden::no_head();
  const Bytes file = golden::read_rig(golden::kHead);
  for (uint64_t lods : {0u, 1u, 2u}) {
    CountingAllocator counter;
    const MienAllocator allocator = counter.get();
    MienDna* dna = nullptr;
    MienRig* rig = nullptr;
    ASSERT_EQ(opener(file, MIEN_LAYER_BEHAVIOR, lods).make(&allocator, &dna, nullptr), MIEN_OK);
    ASSERT_EQ(compiler(dna).make(&allocator, &rig, nullptr), MIEN_OK);
    printf("LODs %llu: %zu requests\n", static_cast<unsigned long long>(lods), counter.requests);
    EXPECT_LE(counter.requests, 8u);
    mien_dna_close(dna);
    mien_rig_destroy(rig);
  }
}

}  // namespace
}  // namespace mien
