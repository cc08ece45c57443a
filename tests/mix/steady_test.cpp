// SPDX-License-Identifier: MIT
// Steps, plays, triggers, pushes and snapshots for a long time: no memory is taken, the state stays
// what a snapshot accepts, and the character comes to rest when all is over.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/counted_news.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/long_run.h"
#include "tests/support/mix_scene.h"

namespace mien {
namespace {

TEST(Steady, NoMemoryIsTakenAfterTheMixerIsMade) {
  const MixScene scene(61);
  CountingAllocator counting;
  const MienAllocator given = counting.get();
  {
    SceneActor actor(scene, 1, {given.user, given.allocate, given.release});
    Random random = Random::from_seed(1, 12);
    actor.begin();
    std::vector<uint8_t> bytes(snapshot_size(*scene.mix));
    const ClipFinder finder = scene.finder();
    const size_t steps = rounds(20000, 1000000), news = g_news;
    size_t wrong = 0, snapshots = 0;
    Error error;
    for (size_t step = 0; step < steps; ++step) {
      actor.disturb(random);
      const float* row = actor.step(random.below(30) * kSceneMillisecond);
      for (uint32_t l = 0; l < scene.mix->curve_count; ++l) wrong += !std::isfinite(row[l]);
      if (!random.chance(0.01)) continue;
      ++snapshots;
      const Span<uint8_t> out = {bytes.data(), bytes.size()};
      wrong += take_snapshot(*actor.mixer, out, error) != Status::kOk;
      wrong += restore_snapshot(*actor.mixer, out, finder, error) != Status::kOk;
    }
    EXPECT_EQ(g_news, news);
    EXPECT_EQ(counting.requests, 1u) << "the mixer itself";
    EXPECT_EQ(wrong, 0u) << error.message;
    EXPECT_GT(snapshots, steps / 200);

    // All is over; life goes on by itself, so it is turned off too.
    for (uint32_t layer = 0; layer < MixScene::kLayers; ++layer) {
      ASSERT_EQ(set_layer_weight(*actor.mixer, layer, 0, kTicksPerSecond / 2, error), Status::kOk);
    }
    ASSERT_EQ(end_stimulus(*actor.mixer, 0, error), Status::kOk);
    ASSERT_EQ(set_variable(*actor.mixer, 0, 0, error), Status::kOk);
    for (int step = 0; step < 600; ++step) actor.step(kSceneStep);
    for (uint32_t l = 0; l < scene.mix->curve_count; ++l) EXPECT_EQ(actor.mixer->row[l], 0) << l;
  }
  EXPECT_TRUE(counting.clean()) << counting.first_wrong;
}

}  // namespace
}  // namespace mien
