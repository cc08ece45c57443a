// SPDX-License-Identifier: MIT
// Clips with their bytes, and the players that share them.
#include "runtime/anim/clip_player.h"

#include "tests/support/counting_allocator.h"
#include "tests/support/made_clip.h"
#include "tests/support/memory_stream.h"

namespace mien {
namespace {

Allocator from(CountingAllocator& counting) {
  const MienAllocator given = counting.get();
  return {given.user, given.allocate, given.release};
}

ClipInput ramp() {
  Curves curves(2, 90);
  for (uint32_t f = 0; f < 90; ++f) curves.at(f, 1) = static_cast<float>(f) / 90;
  return ClipInput(curves);
}

TEST(SharedClip, IsTheSameBuiltOrOpened) {
  ClipInput input = ramp();
  const std::vector<uint8_t> bytes = input.build();
  const MemoryStream stream(bytes);
  CountingAllocator counting;
  Error error;
  SharedClip* clips[3] = {};
  ASSERT_EQ(create_clip(input.desc(), from(counting), clips[0], error), Status::kOk);
  ASSERT_EQ(open_clip_memory({bytes.data(), bytes.size()}, from(counting), clips[1], error),
            Status::kOk);
  ASSERT_EQ(open_clip_stream(stream.get(), from(counting), clips[2], error), Status::kOk);
  EXPECT_EQ(clips[0]->reports.count, 2u);  // of a clip that was built here
  EXPECT_TRUE(clips[1]->reports.empty());
  EXPECT_EQ(clips[1]->data, bytes.data());  // in place
  for (SharedClip* clip : clips) {
    ASSERT_EQ(clip->size, bytes.size());
    EXPECT_EQ(memcmp(clip->data, bytes.data(), bytes.size()), 0);
    EXPECT_EQ(clip->view.bytes, clip->data);
    release(clip);
  }
  EXPECT_TRUE(counting.clean());
}

TEST(SharedClip, WrongBytesLeaveNothing) {
  std::vector<uint8_t> bytes = ramp().build();
  bytes[0] ^= 1;
  CountingAllocator counting;
  Error error;
  SharedClip* clip = nullptr;
  EXPECT_EQ(open_clip_memory({bytes.data(), bytes.size()}, from(counting), clip, error),
            Status::kClipSignature);
  EXPECT_EQ(clip, nullptr);
  EXPECT_EQ(open_clip_stream(MemoryStream(bytes).get(), from(counting), clip, error),
            Status::kClipSignature);
  EXPECT_EQ(clip, nullptr);
  ClipInput wrong = ramp();
  wrong.names[1] = wrong.names[0];
  EXPECT_EQ(create_clip(wrong.desc(), from(counting), clip, error), Status::kName);
  EXPECT_EQ(clip, nullptr);
  EXPECT_TRUE(counting.clean());
}

TEST(SharedClip, SurvivesEachAllocationThatFails) {
  for (size_t fail_at = 1;; ++fail_at) {
    CountingAllocator counting;
    counting.fail_at = fail_at;
    Error error;
    SharedClip* clip = nullptr;
    const Status status = create_clip(ramp().desc(), from(counting), clip, error);
    if (counting.failed == 0) {
      EXPECT_EQ(status, Status::kOk);
      EXPECT_GT(fail_at, 2u);
      release(clip);
      EXPECT_TRUE(counting.clean());
      break;
    }
    EXPECT_EQ(status, Status::kMemory);
    EXPECT_EQ(clip, nullptr);
    EXPECT_TRUE(counting.clean());
  }
}

TEST(ClipPlayer, KeepsItsClip) {
  CountingAllocator counting;
  Error error;
  SharedClip* clip = nullptr;
  ClipInput input = ramp();
  ASSERT_EQ(create_clip(input.desc(), from(counting), clip, error), Status::kOk);
  for (bool reverse : {false, true}) {
    ClipPlayer* player = nullptr;
    ASSERT_EQ(create_clip_player(*clip, {}, reverse, from(counting), player, error), Status::kOk);
    EXPECT_EQ(player->block_size, clip_player_size(clip->view, reverse));
    EXPECT_EQ(clip->owners, 2u);
    release(player);
  }
  ClipPlayer* player = nullptr;
  ASSERT_EQ(create_clip_player(*clip, {}, false, from(counting), player, error), Status::kOk);
  release(clip);
  seek_clip(player->sampler, 45 * player->clip->view.ticks_per_frame);
  EXPECT_EQ(sample_clip(player->sampler)[1], 0.5f);
  release(player);
  EXPECT_TRUE(counting.clean());
}

TEST(ClipPlayer, FailsWithoutMemoryOrWithAWrongDesc) {
  CountingAllocator counting;
  Error error;
  SharedClip* clip = nullptr;
  ClipInput input = ramp();
  ASSERT_EQ(create_clip(input.desc(), from(counting), clip, error), Status::kOk);
  ClipPlayer* player = nullptr;
  PlayDesc desc;
  desc.speed_denominator = 0;
  EXPECT_EQ(create_clip_player(*clip, desc, false, from(counting), player, error),
            Status::kInvalidArgument);
  EXPECT_EQ(player, nullptr);
  counting.restart();
  counting.fail_at = 1;
  EXPECT_EQ(create_clip_player(*clip, {}, false, from(counting), player, error), Status::kMemory);
  EXPECT_EQ(player, nullptr);
  EXPECT_EQ(clip->owners, 1u);
  release(clip);
  EXPECT_TRUE(counting.clean());
}

TEST(Clip, TellsWhichChannelsChange) {
  Curves curves(5, 10);
  for (uint32_t c : {1, 4}) curves.at(3, c) = 1;
  const MadeClip made{ClipInput(curves)};
  for (uint32_t c = 0; c < 5; ++c) EXPECT_EQ(is_changing(made.clip, c), c == 1 || c == 4);
  const MadeClip still{ClipInput(Curves(3, 10))};
  for (uint32_t c = 0; c < 3; ++c) EXPECT_FALSE(is_changing(still.clip, c));
}

TEST(Clip, StepsOfSnappingArePowersOfTwo) {
  EXPECT_EQ(snap_of_step(0), kNoSnap);
  EXPECT_EQ(snap_step(kNoSnap), 0.0f);
  for (uint32_t n = kMinSnap; n <= kMaxSnap; ++n) EXPECT_EQ(snap_of_step(snap_step(n)), n);
  for (float step : {snap_step(kMinSnap) * 2, snap_step(kMaxSnap) / 2, 0.001f, -1.0f, NAN}) {
    EXPECT_EQ(snap_of_step(step), kInvalidSnap) << step;
  }
}

}  // namespace
}  // namespace mien
