// SPDX-License-Identifier: MIT
// The promises of mien.h about threads, to be run under the thread sanitizer: a const handle serves
// any number of threads, an instance one at a time, and a rig may be destroyed while instances of
// it are still in use elsewhere.
#include <atomic>
#include <functional>
#include <new>
#include <thread>

#include "tests/support/deform_rig.h"
#include "tests/support/golden.h"
#include "tests/support/mix_scene.h"

namespace mien {
namespace {

constexpr int kThreads = 32;

/// Runs `body(t)` on all threads, none of which begins before all are there.
void on_threads(int count, const std::function<void(int)>& body) {
  std::atomic<int> missing{count};
  std::vector<std::thread> threads;
  for (int t = 0; t < count; ++t) {
    threads.emplace_back([&, t] {
      --missing;
      while (missing > 0) std::this_thread::yield();
      body(t);
    });
  }
  for (std::thread& thread : threads) thread.join();
}

RigHandle small_rig() { return create_rig(generate_dna(MIEN_PRESET_SMALL, 5).get()); }

/// Frame `frame` of the animation of character `seed`: sliders in 0..1, and the LOD.
uint32_t animate(Character& character, int seed, int frame, uint32_t lods) {
  uint32_t state = static_cast<uint32_t>(seed * 7919 + frame * 104729 + 1);
  for (float& value : character.gui) {
    state = state * 1664525 + 1013904223;
    value = static_cast<float>(state >> 8) / static_cast<float>(1 << 24);
  }
  character.map_gui_to_raw();
  return state % lods;
}

TEST(CapiThreads, InstancesOfOneRigDoNotDisturbEachOther) {
  constexpr int kFrames = 6;
  const RigHandle rig = small_rig();
  const uint32_t lods = info_of(rig).lod_count;
  ASSERT_GT(lods, 1u);

  std::vector<std::vector<float>> expected(kThreads * kFrames), found(kThreads * kFrames);
  auto play = [&](int seed, std::vector<std::vector<float>>& results) {
    Character character(rig);
    for (int frame = 0; frame < kFrames; ++frame) {
      character.evaluate(animate(character, seed, frame, lods));
      results[static_cast<size_t>(seed * kFrames + frame)] = character.results();
    }
  };
  for (int t = 0; t < kThreads; ++t) play(t, expected);
  on_threads(kThreads, [&](int t) { play(t, found); });
  for (size_t i = 0; i < expected.size(); ++i) {
    EXPECT_TRUE(same_bits(span_of(expected[i]), span_of(found[i]))) << "result " << i;
  }
  EXPECT_FALSE(same_bits(span_of(expected[0]), span_of(expected[kFrames]))) << "they all do alike";
}

/// `count` characters, and what a batch makes of them in some frames.
std::vector<float> play_batch(const RigHandle& rig, MienBatch* batch, int seed, uint32_t count,
                              const MienParallelFor* parallel) {
  const uint32_t lod_count = info_of(rig).lod_count;
  std::vector<Character> characters;
  std::vector<MienInstance*> instances;
  std::vector<uint32_t> lods(count);
  std::vector<float> results;
  for (uint32_t i = 0; i < count; ++i) {
    characters.emplace_back(rig);
    instances.push_back(characters.back().instance.get());
  }
  for (int frame = 0; frame < 3; ++frame) {
    for (uint32_t i = 0; i < count; ++i) {
      lods[i] = animate(characters[i], seed + static_cast<int>(i / 2), frame, lod_count);
    }
    EXPECT_EQ(mien_rig_evaluate_batch(rig.get(), batch, instances.data(), lods.data(), count,
                                      MIEN_STAGE_ALL, parallel),
              MIEN_OK);
  }
  for (const Character& character : characters) {
    const std::vector<float> one = character.results();
    results.insert(results.end(), one.begin(), one.end());
  }
  return results;
}

// Rigs with all layers, and one large enough that columns of its matrix are shared.
TEST(CapiThreads, BatchesOfOneRigDoNotDisturbEachOther) {
  constexpr uint32_t kCount = 9;
  for (const RigHandle& rig :
       {small_rig(), create_rig(open_dna(golden::read_rig("ml_ext")).get())}) {
    std::vector<std::vector<float>> expected(kThreads), found(kThreads);
    const auto play = [&](int t) {
      return play_batch(rig, create_batch(rig, kCount, 1).get(), t, kCount, nullptr);
    };
    for (size_t t = 0; t < kThreads; ++t) expected[t] = play(static_cast<int>(t));
    on_threads(kThreads, [&](int t) { found[static_cast<size_t>(t)] = play(t); });
    for (size_t t = 0; t < kThreads; ++t) {
      EXPECT_TRUE(same_bits(span_of(expected[t]), span_of(found[t]))) << "thread " << t;
    }
  }
}

void run_on_four(void*, uint32_t count, void (*task)(void*, uint32_t), void* context) {
  std::atomic<uint32_t> next{0};
  on_threads(4, [&](int) {
    for (uint32_t i = next++; i < count; i = next++) task(context, i);
  });
}
constexpr MienParallelFor kFourThreads = {nullptr, run_on_four};

TEST(CapiThreads, TasksOfABatchWriteToSeparatePlaces) {
  constexpr uint32_t kCount = 130;
  const RigHandle rig = small_rig();
  const std::vector<float> alone =
      play_batch(rig, create_batch(rig, kCount, 1).get(), 1, kCount, nullptr);
  const std::vector<float> together =
      play_batch(rig, create_batch(rig, kCount, 4).get(), 1, kCount, &kFourThreads);
  EXPECT_TRUE(same_bits(span_of(alone), span_of(together)));
}

TEST(CapiThreads, RigsAreReadByAll) {
  const RigHandle rig = small_rig();
  const std::vector<std::string> joints = names_of(rig, MIEN_KIND_JOINT);
  const MienRigInfo info = info_of(rig);
  on_threads(kThreads, [&](int) {
    EXPECT_EQ(names_of(rig, MIEN_KIND_JOINT), joints);
    for (uint32_t i = 0; i < joints.size(); ++i) {
      uint32_t found = 0;
      EXPECT_EQ(
          mien_rig_find_n(rig.get(), MIEN_KIND_JOINT, joints[i].data(), joints[i].size(), &found),
          MIEN_OK);
      EXPECT_EQ(found, i);
    }
    const MienRigInfo again = info_of(rig);
    EXPECT_EQ(memcmp(&again, &info, sizeof(info)), 0);
    for (uint32_t lod = 0; lod < info.lod_count; ++lod) {
      MienRigStatistics statistics = sized<MienRigStatistics>();
      EXPECT_EQ(mien_rig_statistics(rig.get(), lod, &statistics), MIEN_OK);
      MienIndex16View indices = {};
      EXPECT_EQ(mien_rig_variable_joint_values(rig.get(), lod, &indices), MIEN_OK);
      EXPECT_EQ(mien_rig_lod_indices(rig.get(), MIEN_KIND_JOINT, lod, &indices), MIEN_OK);
      EXPECT_EQ(indices.count, statistics.joint_count);
    }
  });
}

TEST(CapiThreads, DnaIsReadWrittenAndCompiledByAll) {
  const DnaHandle generated = generate_dna(MIEN_PRESET_TINY, 5);
  const std::vector<uint8_t> bytes = write_dna(generated.get());
  const DnaHandle opened = open_dna(bytes);
  on_threads(kThreads, [&](int t) {
    const MienDna* dna = t % 2 ? opened.get() : generated.get();
    MienDnaField field = sized<MienDnaField>();
    MienError error = sized<MienError>();
    EXPECT_EQ(mien_dna_field(dna, "bhvr.joints.jointGroups[0].values", &field, &error), MIEN_OK);
    std::vector<float> values(field.count);
    EXPECT_EQ(mien_dna_read_floats(dna, "bhvr.joints.jointGroups[0].values", 0, values.size(),
                                   values.data(), &error),
              MIEN_OK);
    EXPECT_EQ(mien_dna_field(dna, "bhvr.joints.jointGroups[9999]", &field, &error),
              MIEN_ERROR_INDEX);
    MienDnaInfo info = sized<MienDnaInfo>();
    EXPECT_EQ(mien_dna_info(dna, &info), MIEN_OK);
    for (uint32_t i = 0; i < info.joint_count; ++i) {
      MienStringView name = {};
      const std::string path = "defn.jointNames[" + std::to_string(i) + "]";
      EXPECT_EQ(mien_dna_read_string(dna, path.c_str(), &name, nullptr), MIEN_OK);
    }
    EXPECT_EQ(write_dna(dna), bytes);
    const RigHandle rig = create_rig(dna);
    Character character(rig);
    character.evaluate(0);
  });
}

// The allocator counts, so that nothing is released twice or never.
struct CountingAllocator {
  std::atomic<int64_t> live_bytes{0};
  std::atomic<int> calls{0};
  MienAllocator interface = {this, allocate, release};

  static void* allocate(void* user, size_t size, size_t alignment) {
    CountingAllocator& self = *static_cast<CountingAllocator*>(user);
    self.live_bytes += static_cast<int64_t>(size);
    ++self.calls;
    return ::operator new (size, std::align_val_t{alignment}, std::nothrow);
  }
  static void release(void* user, void* block, size_t size, size_t alignment) {
    static_cast<CountingAllocator*>(user)->live_bytes -= static_cast<int64_t>(size);
    ::operator delete (block, std::align_val_t{alignment});
  }
};

RigHandle counted_rig(const MienDna* dna, CountingAllocator& counting) {
  MienRigDesc desc = sized<MienRigDesc>();
  desc.allocator = &counting.interface;
  MienRig* rig = nullptr;
  EXPECT_EQ(mien_rig_create(dna, &desc, &rig, nullptr), MIEN_OK);
  return RigHandle(rig);
}

TEST(CapiThreads, InstancesComeAndGo) {
  CountingAllocator counting;
  {
    const DnaHandle dna = generate_dna(MIEN_PRESET_TINY, 5);
    const RigHandle rig = counted_rig(dna.get(), counting);
    const int64_t rig_bytes = counting.live_bytes;
    on_threads(kThreads, [&](int t) {
      for (int i = 0; i < 50; ++i) {
        MienInstance* made = nullptr;
        const auto desc = desc_with<MienInstanceDesc>(&counting.interface);
        EXPECT_EQ(mien_instance_create(rig.get(), &desc, &made, nullptr), MIEN_OK);
        EXPECT_EQ(mien_rig_evaluate(rig.get(), made, static_cast<uint32_t>(t % 2)), MIEN_OK);
        mien_instance_destroy(made);
      }
    });
    EXPECT_EQ(counting.live_bytes, rig_bytes);
  }
  EXPECT_EQ(counting.live_bytes, 0);
}

TEST(CapiThreads, RigsComeAndGo) {
  CountingAllocator counting;
  const DnaHandle dna = generate_dna(MIEN_PRESET_TINY, 5);
  on_threads(kThreads, [&](int) {
    for (int i = 0; i < 5; ++i) {
      const RigHandle rig = counted_rig(dna.get(), counting);
      Character character(rig);
      character.evaluate(0);
    }
  });
  EXPECT_EQ(counting.live_bytes, 0);
}

// "Memory is released when the last instance is gone too, so the order of destruction does not
// matter": whoever comes last, on whatever thread.
TEST(CapiThreads, RigIsDestroyedWhileInstancesLive) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_TINY, 5);
  for (int round = 0; round < 20; ++round) {
    CountingAllocator counting;
    RigHandle rig = counted_rig(dna.get(), counting);
    std::vector<InstanceHandle> instances;
    for (int t = 1; t < kThreads; ++t) {
      MienInstance* made = nullptr;
      const auto desc = desc_with<MienInstanceDesc>(&counting.interface);
      ASSERT_EQ(mien_instance_create(rig.get(), &desc, &made, nullptr), MIEN_OK);
      ASSERT_EQ(mien_rig_evaluate(rig.get(), made, 0), MIEN_OK);
      instances.emplace_back(made);
    }
    on_threads(kThreads, [&](int t) {
      if (t == 0) return rig.reset();
      InstanceHandle& mine = instances[static_cast<size_t>(t - 1)];
      MienFloatView joints = {};
      MienMutableFloatView raw = {};
      EXPECT_EQ(mien_instance_raw_controls(mine.get(), &raw), MIEN_OK);
      EXPECT_EQ(mien_instance_reset(mine.get()), MIEN_OK);
      EXPECT_EQ(mien_instance_joints(mine.get(), &joints), MIEN_OK);
      for (size_t i = 0; i < joints.count; ++i) EXPECT_EQ(joints.data[i], 0.0f);
      mine.reset();
    });
    EXPECT_EQ(counting.live_bytes, 0) << "round " << round;
  }
}

// One deformer, a pose for each thread, and the deformer destroyed under way.
TEST(CapiThreads, InstancesOfOneDeformerDoNotDisturbEachOther) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 5);
  const RigHandle rig = create_rig(dna.get());
  DeformerHandle deformer = create_deformer(dna.get(), rig.get());
  std::vector<std::vector<float>> expected(kThreads), found(kThreads);
  const auto play = [&](int seed, MienDeformerInstance* pose, std::vector<float>& results) {
    const DeformValues values = random_values(rig.get(), static_cast<uint32_t>(seed));
    Deformed::update(pose, values);
    EXPECT_EQ(mien_deformer_instance_deform(pose, 0, MIEN_NORMALS_RECOMPUTED, nullptr), MIEN_OK);
    for (const Span<const float>& part :
         {Deformed::positions(pose, 0), Deformed::normals(pose, 0)}) {
      results.insert(results.end(), part.begin(), part.end());
    }
  };
  std::vector<DeformerInstanceHandle> poses;
  for (int t = 0; t < kThreads; ++t) {
    play(t, create_deformer_instance(deformer.get()).get(), expected[static_cast<size_t>(t)]);
    poses.push_back(create_deformer_instance(deformer.get()));
  }
  on_threads(kThreads, [&](int t) {
    if (t == 0) deformer.reset();
    DeformerInstanceHandle& mine = poses[static_cast<size_t>(t)];
    play(t, mine.get(), found[static_cast<size_t>(t)]);
    mine.reset();
  });
  for (size_t t = 0; t < kThreads; ++t) {
    EXPECT_TRUE(same_bits(span_of(expected[t]), span_of(found[t]))) << "thread " << t;
  }
}

// The tasks of one call write to places of their own.
TEST(CapiThreads, TasksOfADeformationWriteToSeparatePlaces) {
  DeformRigOptions options;
  options.rows = options.columns = 130;
  options.meshes = 1;
  const Deformed d(random_deform_rig(1, options));
  Deformed::update(d.instance.get(), random_values(d.rig.get(), 1));
  for (uint32_t normals : {MIEN_NORMALS_SKINNED, MIEN_NORMALS_RECOMPUTED}) {
    EXPECT_EQ(mien_deformer_instance_deform(d.instance.get(), 0, normals, &kFourThreads), MIEN_OK);
  }
}

// One mix and its clips, many mixers; rows of a stream come from yet another thread.
TEST(CapiThreads, MixersOfOneMixDoNotDisturbEachOther) {
  const MixScene scene(24);
  constexpr int kSteps = 60;
  std::vector<uint64_t> expected(kThreads), found(kThreads);
  const auto play = [&](int t, std::vector<uint64_t>& hashes) {
    SceneActor actor(scene, static_cast<uint64_t>(t));
    actor.begin();
    Random random = Random::from_seed(static_cast<uint64_t>(t), 0);
    for (int step = 0; step < kSteps; ++step) {
      actor.disturb(random);
      hashes[static_cast<size_t>(t)] = hash_floats(hashes[static_cast<size_t>(t)],
                                                   actor.step(kSceneStep), scene.mix->curve_count);
    }
  };
  for (int t = 0; t < kThreads; ++t) play(t, expected);
  on_threads(kThreads, [&](int t) { play(t, found); });
  EXPECT_EQ(found, expected);

  SceneActor streamed(scene, 1);
  on_threads(2, [&](int t) {
    Random random = Random::from_seed(static_cast<uint64_t>(t), 1);
    const float row[MixScene::kChannels] = {};
    for (int i = 0; i < 500; ++i) {
      Error error;
      if (t == 0) {
        EXPECT_EQ(push_row(*streamed.mixer, MixScene::kLive, i * kSceneStep,
                           {row, MixScene::kChannels}, nullptr, error),
                  Status::kOk);
      } else {
        streamed.step(random.below(40) * kSceneMillisecond);
      }
    }
  });
}

TEST(CapiThreads, FunctionsWithoutAHandle) {
  on_threads(kThreads, [](int) {
    for (uint32_t isa = MIEN_ISA_BEST; isa <= MIEN_ISA_NEON; ++isa) {
      EXPECT_STRNE(mien_isa_name(isa), "unknown");
      EXPECT_LE(mien_isa_available(isa), 1u);
    }
    EXPECT_STREQ(mien_status_name(MIEN_ERROR_ISA), "ISA");
  });
}

}  // namespace
}  // namespace mien
