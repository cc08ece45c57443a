// SPDX-License-Identifier: MIT
// The same bits from every compiler, instruction set, number of threads and size of a batch, with
// everything on; and what LODs, seeds and the length of steps change: nothing, life, nothing.
#include <gtest/gtest.h>

#include <thread>

#include "tests/support/mix_scene.h"
#include "tests/support/rig_handles.h"

namespace mien {
namespace {

constexpr uint32_t kRaws = 61;
constexpr uint64_t kMinute = 0x9726ECE04A9CB369u;

/// 60 s of a character that does whatever can be done.
uint64_t minute_of(const MixScene& scene, uint64_t seed) {
  SceneActor actor(scene, seed);
  Random random = Random::from_seed(seed, 7);
  actor.begin();
  uint64_t hash = kHashStart;
  for (int step = 0; step < 3600; ++step) {
    actor.disturb(random);
    hash = hash_floats(hash, actor.step(kSceneStep), scene.mix->curve_count);
  }
  return hash;
}

TEST(Determinism, OfAMinuteOnEveryInstructionSet) {
  for (uint32_t isa = 1; isa < kIsaCount; ++isa) {
    const KernelTable* kernels = kernels_for(static_cast<Isa>(isa));
    if (!kernels) continue;
    const MixScene scene(kRaws, kernels);
    const uint64_t hash = minute_of(scene, 1);
    EXPECT_EQ(hash, kMinute) << kernels->name << std::hex << ": 0x" << hash;
  }
}

TEST(Determinism, OfAnyNumberOfThreads) {
  const MixScene scene(kRaws);
  constexpr uint32_t kActors = 16, kSteps = 300;
  std::vector<uint64_t> expected;
  for (uint32_t count : {1u, 2u, 3u, 16u}) {
    std::vector<uint64_t> hashes(kActors, kHashStart);
    std::vector<std::thread> threads;
    for (uint32_t t = 0; t < count; ++t) {
      threads.emplace_back([&, t] {
        for (uint32_t a = t; a < kActors; a += count) {
          SceneActor actor(scene, a);
          Random random = Random::from_seed(a, 8);
          actor.begin();
          for (uint32_t step = 0; step < kSteps; ++step) {
            actor.disturb(random);
            hashes[a] = hash_floats(hashes[a], actor.step(kSceneStep), scene.mix->curve_count);
          }
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    if (expected.empty()) expected = hashes;
    EXPECT_EQ(hashes, expected) << count << " threads";
  }
  EXPECT_NE(expected[0], expected[1]);
}

TEST(Determinism, OfABatchOf64AndOfEachAlone) {
  const MixScene scene(kRaws);
  constexpr uint32_t kActors = 64;
  std::deque<SceneActor> together, alone;
  std::vector<Random> randoms;
  std::vector<Mixer*> mixers;
  std::vector<std::vector<float>> rows(kActors, std::vector<float>(scene.mix->curve_count));
  std::vector<float*> outs;
  for (uint32_t a = 0; a < kActors; ++a) {
    for (std::deque<SceneActor>* actors : {&together, &alone}) {
      actors->emplace_back(scene, a);
      actors->back().begin();
    }
    randoms.push_back(Random::from_seed(a, 9));
    mixers.push_back(together[a].mixer.get());
    outs.push_back(rows[a].data());
  }
  for (int step = 0; step < 60; ++step) {
    for (uint32_t a = 0; a < kActors; ++a) {
      Random copy = randoms[a];
      together[a].disturb(copy);
      alone[a].disturb(randoms[a]);
    }
    step_mixers({mixers.data(), kActors}, kSceneStep, outs.data(), scene.mix->curve_count, nullptr,
                0);
    for (uint32_t a = 0; a < kActors; ++a) {
      const float* row = alone[a].step(kSceneStep);
      ASSERT_EQ(memcmp(row, outs[a], rows[a].size() * sizeof(float)), 0) << a << ", " << step;
    }
  }
}

TEST(Determinism, DifferentSeedsChangeTheCurvesOfLifeOnly) {
  const MixScene scene(kRaws);
  SceneActor one(scene, 1), two(scene, 2);
  // Curves that generators have, and what guards and antagonists couple with them.
  std::vector<bool> life(scene.mix->curve_count);
  for (const LayerDesc& layer : scene.mix->layers) {
    if (layer.source != LayerSource::kGenerator) continue;
    for (uint16_t curve : layer.curves) life[curve] = true;
  }
  for (const AntagonistPair& pair : scene.mix->antagonists) {
    if (life[pair.first] || life[pair.second]) life[pair.first] = life[pair.second] = true;
  }
  Error error;
  for (SceneActor* actor : {&one, &two}) {
    actor->begin();
    for (uint32_t g = 0; g < scene.mix->guards.count; ++g) {
      ASSERT_EQ(set_guard(*actor->mixer, g, 0, error), Status::kOk);
    }
  }
  Random random = Random::from_seed(1, 10);
  size_t differ = 0;
  for (int step = 0; step < 600; ++step) {
    Random copy = random;
    one.push(copy);
    two.push(random);
    const float *a = one.step(kSceneStep), *b = two.step(kSceneStep);
    for (uint32_t l = 0; l < scene.mix->curve_count; ++l) {
      if (life[l]) {
        differ += a[l] != b[l];
      } else {
        ASSERT_EQ(memcmp(a + l, b + l, sizeof(float)), 0) << l;
      }
    }
  }
  EXPECT_GT(differ, 600u);
}

TEST(Determinism, DoesNotDependOnTheLodsThatTheRigIsEvaluatedAt) {
  const RigHandle rig = create_rig(generate_dna(MIEN_PRESET_SMALL, 5).get());
  Character character(rig);
  const MixScene scene(static_cast<uint32_t>(character.raw.count));
  SceneActor flipping(scene, 3), steady(scene, 3);
  Random random = Random::from_seed(3, 11);
  for (uint32_t step = 0; step < 300; ++step) {
    Random copy = random;
    flipping.disturb(copy);
    steady.disturb(random);
    // Into the controls of an instance, which is evaluated at another LOD each time.
    step_mixer(*flipping.mixer, kSceneStep, character.raw.data, character.raw.count, nullptr);
    character.evaluate(step % info_of(rig).lod_count);
    ASSERT_EQ(
        memcmp(steady.step(kSceneStep), character.raw.data, character.raw.count * sizeof(float)), 0)
        << step;
  }
}

}  // namespace
}  // namespace mien
