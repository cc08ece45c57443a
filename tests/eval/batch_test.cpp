// SPDX-License-Identifier: MIT
// Many instances at once give the bits of one after the other, however they are mixed and split.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

#include "simd/kernels.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/layer_rig.h"
#include "tests/support/many_rigs.h"

namespace mien {
namespace {

/// Pairs of instances: one for the batch, one evaluated by itself, on a rig that keeps nothing.
struct InstancePacket {
  RigHandle rig, plain_rig;
  std::vector<Character> together, alone;
  std::vector<MienInstance*> handles;
  std::vector<uint32_t> lods;

  InstancePacket(const MienDna* dna, MienRigDesc desc, size_t count) : rig(create_rig(dna, desc)) {
    desc.reuse = MIEN_REUSE_NOTHING;
    plain_rig = create_rig(dna, desc);
    for (size_t i = 0; i < count; ++i) {
      together.emplace_back(rig);
      alone.emplace_back(plain_rig);
      handles.push_back(together.back().instance.get());
    }
    lods.resize(count);
  }

  /// New controls for some, the same for all if `shared`, and LODs for all.
  void draw(Random& random, uint32_t percent, bool shared, uint32_t lod_count) {
    const Random start = random;
    for (size_t i = 0; i < together.size(); ++i) {
      lods[i] = random.below(lod_count);
      if (random.below(4) == 0) continue;
      Random own = shared ? start : random;
      draw_controls(own, percent, together[i].raw);
      std::copy(together[i].raw.begin(), together[i].raw.end(), alone[i].raw.begin());
      if (!together[i].masks.empty() && random.below(2)) {
        together[i].masks[0] = alone[i].masks[0] = static_cast<float>(random.below(2));
      }
      for (uint32_t k = 0; k < 8; ++k) random.below(3);
    }
  }

  void evaluate(MienBatch* batch, const MienParallelFor* parallel = nullptr,
                uint32_t stages = MIEN_STAGE_ALL) {
    ASSERT_EQ(mien_rig_evaluate_batch(rig.get(), batch, handles.data(), lods.data(),
                                      static_cast<uint32_t>(handles.size()), stages, parallel),
              MIEN_OK);
    for (size_t i = 0; i < alone.size(); ++i) alone[i].evaluate(lods[i], stages);
  }

  void expect_equal() const {
    for (size_t i = 0; i < alone.size(); ++i) {
      ASSERT_TRUE(same_results(together[i], alone[i])) << "instance " << i << ", LOD " << lods[i];
    }
  }
};

TEST(Batch, HasTheBitsOfSingleEvaluation) {
  Random random = Random::from_seed(11, 1);
  for_each_dna(6, [&](const DnaHandle& dna) {
    for_each_rig_desc([&](const MienRigDesc& desc) {
      for (size_t count : {1, 3, 40}) {
        InstancePacket packet(dna.get(), desc, count);
        const BatchHandle batch = create_batch(packet.rig, static_cast<uint32_t>(count));
        const uint32_t lod_count = info_of(packet.rig).lod_count;
        for (int frame = 0; frame < 6; ++frame) {
          SCOPED_TRACE(std::to_string(count) + " instances, frame " + std::to_string(frame));
          const uint32_t percents[] = {100, 5, 30, 0, 60, 100};
          packet.draw(random, percents[frame], frame % 2 == 0, frame < 4 ? 1 : lod_count);
          packet.evaluate(batch.get());
          packet.expect_equal();
        }
      }
    });
  });
}

// Large enough that lists of active pieces and whole blocks both come up.
// Masks leave some instances out of a network, or blend what it gives.
TEST(Batch, OfNetworksWithMasks) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 5, MIEN_GENERATE_ML);
  Random random = Random::from_seed(15, 1);
  for (uint32_t isa : present_isas()) {
    for (uint32_t variant = 0; variant < 8; ++variant) {
      MienRigDesc desc = sized<MienRigDesc>();
      desc.isa = isa;
      desc.storage = variant & 1 ? MIEN_STORAGE_16_BIT : MIEN_STORAGE_32_BIT;
      desc.arithmetic = variant & 2 ? MIEN_ARITHMETIC_PORTABLE : MIEN_ARITHMETIC_FAST;
      desc.ml_masks = variant & 4 ? MIEN_ML_MASKS_BLEND : MIEN_ML_MASKS_SWITCH;
      for (size_t count : {2, 9, 40}) {
        SCOPED_TRACE(std::string(mien_isa_name(isa)) + ", variant " + std::to_string(variant) +
                     ", " + std::to_string(count) + " instances");
        InstancePacket packet(dna.get(), desc, count);
        const BatchHandle batch = create_batch(packet.rig, static_cast<uint32_t>(count));
        ASSERT_FALSE(packet.together[0].masks.empty());
        for (uint32_t frame = 0; frame < 4; ++frame) {
          packet.draw(random, 60, false, frame < 2 ? 1 : 2);
          for (size_t i = 0; i < count; ++i) {
            for (size_t m = 0; m < packet.together[i].masks.count; ++m) {
              constexpr float kMasks[] = {1, 1, 0, 0.25f};
              const float mask =
                  kMasks[frame == 0 ? 0 : random.below(4)];  // first without leaving lanes
              packet.together[i].masks[m] = packet.alone[i].masks[m] = mask;
            }
          }
          packet.evaluate(batch.get());
          packet.expect_equal();
        }
      }
    }
  }
}

TEST(Batch, OfALargeRig) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_MEDIUM, 1);
  Random random = Random::from_seed(12, 1);
  for (uint32_t isa : present_isas()) {
    MienRigDesc desc = sized<MienRigDesc>();
    desc.isa = isa;
    InstancePacket packet(dna.get(), desc, 70);
    const BatchHandle batch = create_batch(packet.rig, 100, 3);
    for (uint32_t percent : {100, 3, 40, 100}) {
      for (bool shared : {false, true}) {
        SCOPED_TRACE(std::string(mien_isa_name(isa)) + ", " + std::to_string(percent) + " %");
        packet.draw(random, percent, shared, 2);
        packet.evaluate(batch.get());
        packet.expect_equal();
      }
    }
  }
}

// In full packets, the results of RBF solvers stay in lanes for the joints, which read all controls here: also
// those of solvers that a LOD leaves out, before and behind the others. At a new LOD all instances are
// evaluated; then some have not changed.
TEST(Batch, OfSolversInFullPackets) {
  Random random = Random::from_seed(12, 2);
  LayerRig layers;
  PlainRig& plain = layers.base;
  plain.lod_count = 3;
  plain.raw_count = 4;
  plain.joint_count = 2;
  layers.ml_count = 2;
  layers.rbf_count = 8;
  PlainNetworkLayer layer;
  for (uint32_t i = 0; i < 8; ++i)
    layer.weights.push_back(static_cast<float>(random.between(-1, 1)));
  layer.biases = {0.25f, 1};
  layers.networks = {{{0, 1, 2, 3}, {layers.first_ml(), 5}, {layer}}};
  for (uint16_t s = 0; s < 2; ++s) {
    PlainRbfSolver solver;
    solver.inputs = {0, 1, 2};
    for (uint16_t p = 0; p < 4; ++p) {
      const auto pose = static_cast<uint16_t>(4 * s + p);
      solver.poses.push_back(pose);
      for (uint32_t i = 0; i < 3; ++i) {
        solver.targets.push_back(static_cast<float>(random.between(0, 1)));
      }
      layers.poses.push_back({1, {}, {static_cast<uint16_t>(layers.first_rbf() + pose)}, {1}});
    }
    layers.solvers.push_back(solver);
  }
  layers.lod_solvers = {{0, 1}, {1}, {0}};
  PlainGroup group;
  group.lods = {18, 18, 18};
  for (uint16_t c = 0; c < layers.control_count(); ++c) group.inputs.push_back(c);
  for (uint16_t row = 0; row < 18; ++row) {
    group.outputs.push_back(row);
    for (size_t c = 0; c < group.inputs.size(); ++c) {
      group.values.push_back(static_cast<float>(random.between(-1, 1)));
    }
  }
  plain.groups = {group};
  const LayerFile file(layers);
  for (uint32_t isa : present_isas()) {
    MienRigDesc desc = sized<MienRigDesc>();
    desc.isa = isa;
    InstancePacket packet(file.dna.get(), desc, 2 * kBatchLanes);
    const BatchHandle batch = create_batch(packet.rig, 2 * kBatchLanes);
    for (uint32_t lod : {0, 0, 1, 1, 2, 0}) {
      SCOPED_TRACE(std::string(mien_isa_name(isa)) + ", LOD " + std::to_string(lod));
      packet.draw(random, 100, false, 1);
      std::fill(packet.lods.begin(), packet.lods.end(), lod);
      if (random.below(3) == 0) packet.evaluate(batch.get(), nullptr, MIEN_STAGE_RBF);
      packet.evaluate(batch.get());
      packet.expect_equal();
    }
  }
}

TEST(Batch, OfSeveralTiles) {
  Arena arena(default_allocator());
  const std::vector<uint8_t> bytes = write_view(to_view(tall_rig(), arena));
  InstancePacket packet(open_dna(bytes).get(), sized<MienRigDesc>(), 40);
  const BatchHandle batch = create_batch(packet.rig, 40);
  Random random = Random::from_seed(14, 1);
  for (uint32_t percent : {100, 3, 40}) {
    packet.draw(random, percent, true, 2);
    packet.evaluate(batch.get());
    packet.expect_equal();
  }
}

// 0 times such an entry is not 0, and a batch multiplies where a single evaluation skips.
TEST(Batch, OfEntriesThatAreNotFinite) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kLargest = std::numeric_limits<float>::max();
  LayerRig layers;
  layers.rotations = {0, 1, 0};
  PlainRig& plain = layers.base;
  plain.raw_count = 4;
  plain.joint_count = 3;
  PlainGroup group;
  group.lods = {20};
  group.inputs = {0, 1, 2, 3, 0};  // one control twice: its entries are added
  const float awkward[] = {1, kInfinity, -kInfinity, std::nanf(""), kLargest, -2, 0.5f};
  for (uint16_t row = 0; row < 20; ++row) {
    group.outputs.push_back(row);
    for (uint32_t c = 0; c < 5; ++c) group.values.push_back(awkward[(row + 3 * c + row * c) % 7]);
  }
  plain.groups = {group};
  PlainNetworkLayer layer;
  layer.biases = {-0.0f, 1, -1};
  for (uint32_t i = 0; i < 12; ++i) layer.weights.push_back(awkward[(i + i / 4) % 7]);
  layers.networks = {{{0, 1, 2, 3}, {4, 5, 6}, {layer}}};
  layers.ml_count = 3;
  const LayerFile file(layers);
  Random random = Random::from_seed(15, 1);
  for_each_rig_desc([&](const MienRigDesc& desc) {
    InstancePacket packet(file.dna.get(), desc, 32);
    const BatchHandle batch = create_batch(packet.rig, 32);
    for (uint32_t percent : {100, 20, 70}) {
      packet.draw(random, percent, false, 1);
      packet.evaluate(batch.get());
      packet.expect_equal();
      for (const Character& character : packet.alone) {
        for (float value : character.joints) ASSERT_TRUE(std::isfinite(value));
      }
    }
  });
}

TEST(Batch, SomeStages) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 2);
  Random random = Random::from_seed(13, 1);
  InstancePacket packet(dna.get(), sized<MienRigDesc>(), 20);
  const BatchHandle batch = create_batch(packet.rig, 20);
  for (int frame = 0; frame < 40; ++frame) {
    packet.draw(random, 50, false, 1);
    const uint32_t stages = frame % 5 == 4 ? uint32_t{MIEN_STAGE_ALL} : random.below(64);
    SCOPED_TRACE("stages " + std::to_string(stages));
    packet.evaluate(batch.get(), nullptr, stages);
    packet.expect_equal();
  }
}

TEST(Batch, AnySplitGivesTheSameBits) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 2);
  Random random = Random::from_seed(14, 1);
  const MienParallelFor backwards = {
      nullptr, [](void*, uint32_t count, void (*task)(void*, uint32_t), void* context) {
        for (uint32_t i = count; i-- > 0;) task(context, i);
      }};
  const MienParallelFor threads = {
      nullptr, [](void*, uint32_t count, void (*task)(void*, uint32_t), void* context) {
        std::vector<std::thread> all;
        for (uint32_t i = 0; i < count; ++i) all.emplace_back(task, context, i);
        for (std::thread& thread : all) thread.join();
      }};
  for (uint32_t tasks : {0, 1, 2, 5, 1000}) {
    for (const MienParallelFor* parallel : {&backwards, &threads}) {
      InstancePacket packet(dna.get(), sized<MienRigDesc>(), 150);
      const BatchHandle batch = create_batch(packet.rig, 150, tasks);
      for (int frame = 0; frame < 3; ++frame) {
        packet.draw(random, 50, false, info_of(packet.rig).lod_count);
        packet.evaluate(batch.get(), parallel);
        packet.expect_equal();
      }
    }
  }
}

TEST(Batch, RefusesMisuse) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_TINY, 1);
  const RigHandle rig = create_rig(dna.get()), other_rig = create_rig(dna.get());
  const BatchHandle batch = create_batch(rig, 2);
  Character a(rig), b(rig), other(other_rig);
  const auto evaluate = [&](std::vector<MienInstance*> instances, std::vector<uint32_t> lods,
                            uint32_t stages = MIEN_STAGE_ALL) {
    return mien_rig_evaluate_batch(rig.get(), batch.get(), instances.data(), lods.data(),
                                   static_cast<uint32_t>(instances.size()), stages, nullptr);
  };
  MienInstance *x = a.instance.get(), *y = b.instance.get(), *z = other.instance.get();
  a.raw[0] = 1;
  const std::vector<float> before = a.results();
  EXPECT_EQ(evaluate({x, x}, {0, 0}), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(evaluate({x, z}, {0, 0}), MIEN_ERROR_MISMATCH);
  EXPECT_EQ(evaluate({x, nullptr}, {0, 0}), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(evaluate({x, y}, {0, 99}), MIEN_ERROR_LOD);
  EXPECT_EQ(evaluate({x, y, x}, {0, 0, 0}), MIEN_ERROR_INVALID_ARGUMENT) << "over the capacity";
  EXPECT_EQ(evaluate({x}, {0}, 64), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(a.results(), before) << "then none is evaluated";
  EXPECT_EQ(evaluate({}, {}), MIEN_OK);
  EXPECT_EQ(evaluate({x, y}, {0, 0}), MIEN_OK) << "refusing leaves no mark";
  EXPECT_NE(a.results(), before);

  uint32_t lod = 0;
  const MienParallelFor nobody = {nullptr, nullptr};
  const MienRig* r = rig.get();
  MienBatch* made = batch.get();
  EXPECT_EQ(mien_rig_evaluate_batch(nullptr, made, &x, &lod, 1, 63, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_rig_evaluate_batch(r, nullptr, &x, &lod, 1, 63, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_rig_evaluate_batch(r, made, nullptr, &lod, 1, 63, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_rig_evaluate_batch(r, made, &x, nullptr, 1, 63, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_rig_evaluate_batch(r, made, &x, &lod, 1, 63, &nobody),
            MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_rig_evaluate_batch(other_rig.get(), made, &z, &lod, 1, 63, nullptr),
            MIEN_ERROR_MISMATCH);
  EXPECT_EQ(mien_rig_evaluate_batch(r, reinterpret_cast<MienBatch*>(x), &x, &lod, 1, 63, nullptr),
            MIEN_ERROR_HANDLE);

  MienError error = sized<MienError>();
  MienBatchDesc desc = batch_desc((1u << 20) + 1);
  uint64_t bytes = 1;
  EXPECT_EQ(mien_batch_create(r, &desc, &made, &error), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_batch_bytes(r, &desc, &bytes), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(bytes, 0u);
  EXPECT_EQ(made, nullptr);
  desc = batch_desc(1);
  EXPECT_EQ(mien_batch_create(nullptr, &desc, &made, &error), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_batch_create(r, &desc, nullptr, &error), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_batch_bytes(nullptr, &desc, &bytes), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_batch_bytes(r, &desc, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  desc.struct_size = 4;
  EXPECT_EQ(mien_batch_create(r, &desc, &made, &error), MIEN_ERROR_STRUCT_SIZE);
  EXPECT_EQ(mien_batch_bytes(r, &desc, &bytes), MIEN_ERROR_STRUCT_SIZE);
  mien_batch_destroy(nullptr);
}

// As many tasks as there may be, until a task has fewer than eight instances.
TEST(Batch, SharesInstancesAmongItsTasks) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 2);
  Random random = Random::from_seed(15, 1);
  uint32_t tasks = 0;
  const MienParallelFor counting = {
      &tasks, [](void* user, uint32_t count, void (*task)(void*, uint32_t), void* context) {
        *static_cast<uint32_t*>(user) = count;
        for (uint32_t i = 0; i < count; ++i) task(context, i);
      }};
  const struct {
    uint32_t instances, wanted, made;
  } cases[] = {{1, 4, 1}, {15, 2, 1}, {16, 2, 2}, {64, 8, 8}, {96, 2, 2}, {150, 1000, 18}};
  for (const auto& c : cases) {
    SCOPED_TRACE(c.instances);
    InstancePacket packet(dna.get(), sized<MienRigDesc>(), c.instances);
    const BatchHandle batch = create_batch(packet.rig, c.instances, c.wanted);
    packet.draw(random, 50, false, 1);
    packet.evaluate(batch.get(), &counting);
    packet.expect_equal();
    EXPECT_EQ(tasks, c.made);
  }
}

TEST(Batch, TakesOneBlockAndThenNothing) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 1);
  RigHandle rig = create_rig(dna.get());
  Character a(rig), b(rig);
  CountingAllocator allocator;
  const MienAllocator given = allocator.get();
  MienBatch* batch = nullptr;
  MienError error = sized<MienError>();
  allocator.fail_at = 1;
  const MienBatchDesc desc = batch_desc(64, 2, &given);
  EXPECT_EQ(mien_batch_create(rig.get(), &desc, &batch, &error), MIEN_ERROR_MEMORY);
  EXPECT_EQ(batch, nullptr);
  EXPECT_TRUE(allocator.clean());

  allocator.fail_at = 0;
  allocator.restart();
  ASSERT_EQ(mien_batch_create(rig.get(), &desc, &batch, &error), MIEN_OK);
  uint64_t bytes = 0;
  EXPECT_EQ(mien_batch_bytes(rig.get(), &desc, &bytes), MIEN_OK);
  EXPECT_EQ(allocator.bytes, bytes);
  MienInstance* instances[] = {a.instance.get(), b.instance.get()};
  const uint32_t lods[] = {0, 0};
  a.raw[0] = b.raw[1] = 1;
  EXPECT_EQ(mien_rig_evaluate_batch(rig.get(), batch, instances, lods, 2, 63, nullptr), MIEN_OK);
  EXPECT_EQ(allocator.requests, 1u);
  rig.reset();
  mien_batch_destroy(batch);
  EXPECT_TRUE(allocator.clean());
}

}  // namespace
}  // namespace mien
