// SPDX-License-Identifier: MIT
// Steps of clips, measured on the rig: what is rounded to them moves no vertex by more than was asked.
#include "runtime/probe/probe_snaps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "author/base/random.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/deform_rig.h"
#include "tests/support/plain_rig.h"

namespace mien {
namespace {

struct SnapHead {
  DnaHandle dna = generate_dna(MIEN_PRESET_HEAD, 0);
  RigHandle rig = create_rig(dna.get());
  DeformerHandle handle = create_deformer(dna.get(), rig.get());
  const Deformer& deformer = *capi::object(handle.get());
  std::vector<std::string> names = names_of(rig, MIEN_KIND_RAW_CONTROL);
  MienClip* clip = nullptr;
  MienClipBinding* binding = nullptr;

  SnapHead() {
    names.push_back("nothing");
    std::vector<MienStringView> views;
    for (const std::string& name : names) views.push_back({name.data(), name.size()});
    const std::vector<float> zeros(names.size());
    MienClipDesc desc = sized<MienClipDesc>();
    desc.names = views.data();
    desc.channel_count = static_cast<uint32_t>(views.size());
    desc.values = zeros.data();
    desc.frame_count = 1;
    EXPECT_EQ(mien_clip_build(&desc, &clip, nullptr), MIEN_OK);
    EXPECT_EQ(mien_clip_binding_create(clip, rig.get(), nullptr, &binding, nullptr), MIEN_OK);
  }
  ~SnapHead() {
    mien_clip_binding_destroy(binding);
    mien_clip_close(clip);
  }
  std::vector<float> snaps(float tolerance) const {
    std::vector<float> steps(names.size(), -1.0f);
    EXPECT_EQ(mien_clip_binding_snaps(binding, handle.get(), tolerance, steps.data(), steps.size(),
                                      nullptr),
              MIEN_OK);
    return steps;
  }
};

const SnapHead& made_head() {
  static const SnapHead made;
  return made;
}

/// The farthest that a vertex is apart in two poses of one control.
double distance(RigProbe& probe, uint16_t control, float a, float b) {
  std::vector<std::vector<float>> before;
  double farthest = 0;
  for (int pass = 0; pass < 2; ++pass) {
    probe.clear();
    probe.set(control, pass == 0 ? a : b);
    probe.pose();
    size_t mesh = 0;
    for (uint16_t m : probe.rig().lod_meshes.at(0)) {
      const Span<const float> at = probe.positions(m);
      if (pass == 0) {
        before.emplace_back(at.begin(), at.end());
        continue;
      }
      const std::vector<float>& from = before[mesh++];
      for (size_t i = 0; i + 2 < at.count; i += 3) {
        double square = 0;
        for (size_t k = i; k < i + 3; ++k) {
          square += (double{at[k]} - double{from[k]}) * (double{at[k]} - double{from[k]});
        }
        farthest = std::max(farthest, std::sqrt(square));
      }
    }
  }
  return farthest * probe.millimeters();
}

TEST(Snaps, MoveNoVertexFartherThanTheTolerance) {
  const SnapHead& head = made_head();
  RigProbe probe(head.deformer, default_allocator());
  Random random = Random::from_seed(4, 0);
  for (const float tolerance : {0.02f, 0.002f}) {
    const std::vector<float> steps = head.snaps(tolerance);
    size_t finer = 0;
    for (uint16_t c = 0; c + 1u < steps.size(); ++c) {
      ASSERT_GT(steps[c], 0.0f) << head.names[c];
      finer += steps[c] < 1.0f / 512;
      // At random places, not those that were tried; rounding takes half a step.
      for (int i = 0; i < 3; ++i) {
        const float value = static_cast<float>(random.real()) * (1 - steps[c]) + steps[c] / 2;
        const float other = value + (i % 2 == 0 ? steps[c] : -steps[c]) / 2;
        // Positions of a head are floats in centimeters: 1.5e-5 of them.
        EXPECT_LE(distance(probe, c, value, other), double{tolerance} + 5e-4) << head.names[c];
      }
      // And the next step up would move one farther than a third of it, unless it is the coarsest.
      if (steps[c] < 1.0f / 512) {
        double most = 0;
        for (int k = 0; k < 4; ++k) {
          const float value = 0.25f * static_cast<float>(k);
          most = std::max(most, distance(probe, c, value, value + 1.0f / 64));
        }
        EXPECT_GT(most * 64 * double{steps[c]}, double{tolerance} / 2) << head.names[c];
      }
    }
    EXPECT_GT(finer, tolerance < 0.01f ? 10u : 0u) << "some move vertices by centimeters";
    EXPECT_EQ(steps.back(), 1.0f / 2048) << "drives nothing";
  }
}

TEST(Snaps, RefuseWhatIsWrong) {
  const SnapHead& head = made_head();
  std::vector<float> steps(head.names.size());
  const auto with = [&](const MienClipBinding* binding, const MienDeformer* deformer,
                        float tolerance, float* out, size_t count) {
    return mien_clip_binding_snaps(binding, deformer, tolerance, out, count, nullptr);
  };
  const MienDeformer* const deformer = head.handle.get();
  EXPECT_EQ(with(head.binding, deformer, 0, steps.data(), steps.size()),
            MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(with(head.binding, deformer, NAN, steps.data(), steps.size()),
            MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(with(head.binding, deformer, 1, steps.data(), steps.size() - 1), MIEN_ERROR_MISMATCH);
  EXPECT_EQ(with(head.binding, deformer, 1, nullptr, steps.size()), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(with(head.binding, nullptr, 1, steps.data(), steps.size()), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(with(nullptr, deformer, 1, steps.data(), steps.size()), MIEN_ERROR_NULL_ARGUMENT);
}

TEST(Snaps, FailWithoutALeakWhereverMemoryRunsOut) {
  // A clip of one channel, so that each attempt is short.
  const SnapHead& head = made_head();
  MienClipDesc desc = sized<MienClipDesc>();
  const MienStringView name = {"jawOpen", 7};
  const float zero = 0;
  desc.names = &name;
  desc.channel_count = desc.frame_count = 1;
  desc.values = &zero;
  MienClip* clip = nullptr;
  MienClipBinding* binding = nullptr;
  ASSERT_EQ(mien_clip_build(&desc, &clip, nullptr), MIEN_OK);
  ASSERT_EQ(mien_clip_binding_create(clip, head.rig.get(), nullptr, &binding, nullptr), MIEN_OK);
  CountingAllocator counting;
  const MienAllocator caller = counting.get();
  const Allocator allocator = {caller.user, caller.allocate, caller.release};
  for (size_t fail_at = 1;; ++fail_at) {
    counting.restart();
    counting.fail_at = fail_at;
    uint8_t snap = 99;
    Error error;
    const Status status =
        probe_snaps(head.deformer, *capi::object(binding), 0.02f, allocator, {&snap, 1}, error);
    ASSERT_TRUE(counting.clean()) << counting.first_wrong;
    if (counting.failed == 0) {
      EXPECT_EQ(status, Status::kOk);
      EXPECT_GT(fail_at, 3u);
      break;
    }
    EXPECT_EQ(status, Status::kMemory);
  }
  mien_clip_binding_destroy(binding);
  mien_clip_close(clip);
}

}  // namespace
}  // namespace mien
