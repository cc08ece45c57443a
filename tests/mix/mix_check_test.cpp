// SPDX-License-Identifier: MIT
// Each field of a mix has limits: beyond them, the mix is refused by its name. Sizes that are left out,
// limits of bindings, and the standard guards.
#include "runtime/mix/mix_check.h"

#include <gtest/gtest.h>

#include "runtime/mix/mix_fields.h"
#include "tests/support/mix_setup.h"

namespace mien {
namespace {

/// Takes a field of an element beyond its limits: the n-th that has some.
struct SpoilField : SkipsLists {
  int left;
  std::string name = "";  // of the field; empty: there are not as many

  explicit SpoilField(int n) : left(n) {}
  bool found(Field field) {
    if (left-- != 0) return false;
    name = field.name;
    return true;
  }
  template <class T>
  void value(Field field, const Limits& limits, T& number) {
    if (limits.low == kAnyValue.low || !found(field)) return;
    number = static_cast<T>(limits.high < 1e30 ? limits.high + 1 : limits.low - 1);
  }
  template <class T, size_t N>
  void choice(Field field, const char* const (&)[N], T& number) {
    if (found(field)) number = static_cast<T>(N);
  }
  void mask(Field field, Span<const float>& values) {
    static const float kBeyond[] = {0, 1.5f};
    if (found(field)) values = {kBeyond, 2};
  }
};

/// Expects that a mix is refused for each field of an element that `element(input)` refers to.
template <class Make, class Element>
int expect_limits(Make make, Element element) {
  int count = 0;
  for (;; ++count) {
    auto input = make();
    SpoilField spoil(count);
    visit_fields(spoil, element(*input));
    if (spoil.name.empty()) return count;
    Error error;
    EXPECT_EQ(check_mix(input->finish(), error), Status::kInvalidArgument) << spoil.name;
    EXPECT_NE(std::string(error.message).find("." + spoil.name), std::string::npos)
        << spoil.name << ": " << error.message;
    Mix* mix = nullptr;
    EXPECT_EQ(create_mix(input->finish(), default_allocator(), mix, error),
              Status::kInvalidArgument);
    EXPECT_EQ(mix, nullptr);
  }
}

struct EverySource : MixInput {
  const uint16_t curves[2] = {0, 1};
  const float amounts[2] = {1, 1};
  Stroke stroke = {0, BlendMode::kAdd, false, false, false, 0, 1, 2, 3};
  ReactionDesc reaction;
  AntagonistPair pair = {0, 1, 0.5f};

  EverySource() : MixInput(4, 1) {
    add_pose({0, 1}, {0.5f, 1});
    add(BlendMode::kOverride);
    add(BlendMode::kAdd, LayerSource::kPoses).pose_count = 1;
    add(BlendMode::kAdd, LayerSource::kStream).curves = {curves, 2};
    LayerDesc& layer = add(BlendMode::kAdd, LayerSource::kGenerator);
    layer.period = 1;
    layer.curves = {curves, 2};
    layer.amounts = {amounts, 2};
    reaction.strokes = {&stroke, 1};
    desc.reactions = {&reaction, 1};
    desc.antagonists = {&pair, 1};
  }
  EverySource(const EverySource&) = delete;
};

std::unique_ptr<EverySource> everything() { return std::make_unique<EverySource>(); }

TEST(CheckMix, EachFieldHasItsLimits) {
  Error error;
  ASSERT_EQ(check_mix(everything()->finish(), error), Status::kOk) << error.message;
  const int common = 6;  // group, mode, source, after_guards, weight, mask
  const int own[] = {0, 2, 2, 2};
  for (uint32_t i = 0; i < 4; ++i) {
    const auto layer = [i](EverySource& e) -> LayerDesc& { return e.layers[i]; };
    EXPECT_EQ(expect_limits(everything, layer), common + own[i]) << i;
  }
  EXPECT_EQ(expect_limits(everything, [](EverySource& e) -> Stroke& { return e.stroke; }), 6);
  EXPECT_EQ(expect_limits(everything, [](EverySource& e) -> ReactionDesc& { return e.reaction; }),
            7);
  EXPECT_EQ(expect_limits(everything, [](EverySource& e) -> AntagonistPair& { return e.pair; }), 1);
  EXPECT_EQ(expect_limits(everything, [](EverySource& e) -> MixDesc& { return e.desc; }), 5);
}

TEST(CheckMix, MessagesNameTheElement) {
  const auto message = [](auto&& change) {
    const auto input = everything();
    change(*input);
    Error error;
    EXPECT_EQ(check_mix(input->finish(), error), Status::kInvalidArgument);
    return std::string(error.message);
  };
  EXPECT_EQ(message([](EverySource& e) { e.stroke.attack = -3; }),
            "reaction 0, stroke 0: .attack is -3; times are 0 ... 2^40 ticks (26 minutes)");
  EXPECT_EQ(message([](EverySource& e) { e.stroke.pose = 1; }),
            "reaction 0, stroke 0: .pose is 1; the mix has 1 poses");
  EXPECT_EQ(message([](EverySource& e) { e.layers[2].stream_frames = 1; }),
            "layer 2: .stream_frames is 1; it must be within 2 ... 1024");
  EXPECT_EQ(message([](EverySource& e) { e.layers[0].weight = -0.5f; }),
            "layer 0: .weight is -0.5; it must be within 0 ... 1");
  EXPECT_EQ(message([](EverySource& e) { e.layers[3].amounts = {}; }),
            "layer 3: 2 .curves, 0 .amounts; both must be as many");
  EXPECT_EQ(message([](EverySource& e) { e.pair.second = 5; }),
            "antagonists 0: .second is 5; curves are below 5");
  EXPECT_EQ(message([](EverySource& e) { e.reaction.level_off = 0.5f; }),
            "reaction 0: .level_off is 0.5; it is at most .level_on, 0");
}

TEST(MixSizes, ThoseLeftOutFollowFromTheLayersAndTheRig) {
  MixInput input(600);
  input.desc.player_count = input.desc.max_channels = input.desc.max_changing_channels = 0;
  input.add(BlendMode::kOverride);
  input.add(BlendMode::kAdd, LayerSource::kPoses);
  input.add(BlendMode::kAdd);
  MixDesc desc = input.finish();
  EXPECT_EQ(clip_layer_count(desc), 2u);
  set_default_sizes(desc);
  EXPECT_EQ(desc.player_count, 4u);
  EXPECT_EQ(desc.max_channels, 600u);
  EXPECT_EQ(desc.max_changing_channels, kMaxChangingChannels);
  desc.player_count = 3;
  desc.max_channels = 7;
  desc.max_changing_channels = 0;
  set_default_sizes(desc);
  EXPECT_EQ(desc.player_count, 3u);
  EXPECT_EQ(desc.max_channels, 7u);
  EXPECT_EQ(desc.max_changing_channels, 7u);
}

TEST(MixSizes, BindingsMayHaveOneGuiControlMoreThanTheRig) {
  EXPECT_EQ(bound_gui_limit(0), 1u);
  EXPECT_EQ(bound_gui_limit(kMaxBoundGuiControls - 1), kMaxBoundGuiControls);
  EXPECT_EQ(bound_gui_limit(kMaxBoundGuiControls), kMaxBoundGuiControls);
  EXPECT_EQ(bound_gui_limit(~0u), kMaxBoundGuiControls);
}

TEST(StandardGuards, HaveNamesAndGroups) {
  const uint32_t lips = kGuardsOfLips, lids = kGuardsOfLids;
  const uint32_t groups[kStandardGuardCount] = {lips, lips, lips, lips, lids, lids, kGuardsOfTeeth};
  for (uint32_t kind = 0; kind < kStandardGuardCount; ++kind) {
    EXPECT_EQ(guard_group(kind), groups[kind]) << kind;
    for (uint32_t other = 0; other < kind; ++other) {
      EXPECT_STRNE(guard_name(kind), guard_name(other));
    }
  }
  EXPECT_STREQ(guard_name(static_cast<uint32_t>(StandardGuard::kLipToTeeth)), "lower lip to teeth");
  for (uint32_t own : {kStandardGuardCount, ~0u}) {
    EXPECT_STREQ(guard_name(own), "custom");
    EXPECT_EQ(guard_group(own), 0u);
  }
}

}  // namespace
}  // namespace mien
