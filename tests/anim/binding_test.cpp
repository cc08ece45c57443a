// SPDX-License-Identifier: MIT
// Names of channels meet names of controls.
#include "runtime/anim/binding.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/counting_allocator.h"
#include "tests/support/made_clip.h"
#include "tests/support/plain_rig.h"
#include "tests/support/rig_handles.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

using Names = std::vector<std::string>;

struct NamedRig {
  Names raw, gui;
  PlainTable gui_to_raw;

  RigHandle make() const {
    PlainRig plain;
    plain.raw_count = static_cast<uint16_t>(raw.size());
    plain.gui_count = static_cast<uint16_t>(gui.size());
    plain.gui_to_raw = gui_to_raw;
    Arena arena(default_allocator());
    dna::DnaView view = to_view(plain, arena);
    view.defn.raw_control_names = names(arena, raw);
    view.defn.gui_control_names = names(arena, gui);
    const std::vector<uint8_t> bytes = write_view(view);
    return create_rig(open_dna(bytes).get());
  }

  static dna::List<dna::String> names(Arena& arena, const Names& from) {
    const Span<dna::String> span = arena.array<dna::String>(from.size());
    for (size_t i = 0; i < from.size(); ++i) span[i] = dna::text(from[i].c_str());
    return {span.data, static_cast<uint32_t>(span.count)};
  }
};

const Rig& rig_of(const RigHandle& handle) { return *capi::object(handle.get()); }

/// Channels of these names with different curves; the third one never changes.
ClipInput input_of(const Names& names) {
  Curves curves(static_cast<uint32_t>(names.size()), 40);
  for (uint32_t f = 0; f < 40; ++f) {
    for (uint32_t c = 0; c < curves.channels; ++c) {
      curves.at(f, c) = c == 2 ? 0.7f : static_cast<float>((f * (c + 3)) % 17) / 17.0f;
    }
  }
  ClipInput input(curves);
  input.names = names;
  return input;
}

struct Matrix {
  struct Entry {
    const char* source;
    const char* control;
    float weight;
  };
  std::vector<MatrixEntry> entries;

  Matrix(std::initializer_list<Entry> list) {
    for (const Entry& e : list) {
      entries.push_back({{e.source, strlen(e.source)}, {e.control, strlen(e.control)}, e.weight});
    }
  }
  operator Span<const MatrixEntry>() const { return {entries.data(), entries.size()}; }
};

class Bound {
 public:
  Bound(const Clip& clip, const RigHandle& rig, Span<const MatrixEntry> matrix = {}) {
    Error error;
    EXPECT_EQ(bind_clip(clip, rig_of(rig), matrix, default_allocator(), binding_, error),
              Status::kOk)
        << error.message;
  }
  ~Bound() { release(binding_); }
  Bound(const Bound&) = delete;
  Bound& operator=(const Bound&) = delete;

  const Binding& operator*() const { return *binding_; }
  const Binding* operator->() const { return binding_; }

  /// Raw controls that were -9 before.
  std::vector<float> apply(const std::vector<float>& values) const {
    std::vector<float> raw(binding_->raw_count, -9), gui(binding_->gui_count, -7);
    apply_binding(*binding_, span_of(values), {gui.data(), gui.size()}, {raw.data(), raw.size()});
    return raw;
  }

 private:
  Binding* binding_ = nullptr;
};

using Indices = std::vector<int>;

Indices list(Span<const uint16_t> span) { return {span.begin(), span.end()}; }

TEST(Binding, FindsRawControlsInAnyOrderAndListsTheRest) {
  const MadeClip made(input_of({"jawOpen", "smile", "still", "tailWag"}));
  const RigHandle rig = NamedRig{{"brow", "smile", "still", "nose", "jawOpen"}, {}, {}}.make();
  const Bound bound(made.clip, rig);
  EXPECT_EQ(bound.apply({0.1f, 0.2f, 0.3f, 0.4f}), (Floats{-9, 0.2f, 0.3f, -9, 0.1f}));
  EXPECT_EQ(list(bound->controls), (Indices{1, 2, 4}));
  EXPECT_EQ(list(bound->missing_channels), (Indices{3}));
  EXPECT_EQ(list(bound->extra_controls), (Indices{0, 3}));
  EXPECT_EQ(bound->gui_count, 0u);
}

TEST(Binding, CommonControlsAreEqualBitForBitOnEveryRig) {
  const Names all = {"a", "b", "c", "d", "e", "f"};
  const MadeClip made(input_of(all));
  const RigHandle same = NamedRig{all, {}, {}}.make();
  const RigHandle reordered = NamedRig{{"f", "c", "a", "e", "b", "d"}, {}, {}}.make();
  const RigHandle fewer = NamedRig{{"e", "a"}, {}, {}}.make();
  const RigHandle more = NamedRig{{"x", "f", "e", "y", "d", "c", "b", "a", "z"}, {}, {}}.make();
  const Bound expected(made.clip, same);
  OwnSampler own(made.clip);
  for (const RigHandle* rig : {&reordered, &fewer, &more}) {
    const Bound bound(made.clip, *rig);
    const Names names = names_of(*rig, MIEN_KIND_RAW_CONTROL);
    EXPECT_EQ(bound->missing_channels.count + bound->controls.count, all.size());
    EXPECT_EQ(bound->extra_controls.count + bound->controls.count, names.size());
    for (int64_t tick = 0; tick < 400000000; tick += 7654321) {
      const Span<const float> sampled = own.at_tick(tick);
      const Floats values(sampled.begin(), sampled.end());
      const Floats reference = expected.apply(values), raw = bound.apply(values);
      for (uint16_t control : bound->controls) {
        const size_t c = static_cast<size_t>(names[control][0] - 'a');
        ASSERT_EQ(bits_of(raw[control]), bits_of(reference[c])) << names[control];
        ASSERT_EQ(bits_of(raw[control]), bits_of(values[c]));
      }
    }
  }
}

TEST(Binding, CopiesBitsOfNegativeZero) {
  const MadeClip made(input_of({"a"}));
  const RigHandle rig = NamedRig{{"a"}, {}, {}}.make();
  EXPECT_EQ(bits_of(Bound(made.clip, rig).apply({-0.0f})[0]), 0x80000000u);
}

TEST(Binding, NamesAreAlikeWithoutCaseDotsAndPrefix) {
  const MadeClip made(input_of({"JAWOPEN", "ctrl_expressions.Smile", "still", "nose_l"}));
  const RigHandle rig = NamedRig{
      {"CTRL_expressions.jawOpen", "CTRL_expressions_smile", "CTRL_expressions.still",
       "CTRL_expressions.nose.L"},
      {},
      {}}.make();
  const Bound bound(made.clip, rig);
  EXPECT_EQ(bound.apply({0.1f, 0.2f, 0.3f, 0.4f}), (Floats{0.1f, 0.2f, 0.3f, 0.4f}));
}

TEST(Binding, OfSeveralAlikeOneHasToBeEqual) {
  const RigHandle rig = NamedRig{{"jaw.open", "Jaw_Open", "JAW.OPEN"}, {}, {}}.make();
  const MadeClip equal(input_of({"Jaw_Open"})), none(input_of({"jaw_open"}));
  EXPECT_EQ(list(Bound(equal.clip, rig)->controls), (Indices{1}));
  EXPECT_EQ(list(Bound(none.clip, rig)->controls), Indices{});
  EXPECT_EQ(list(Bound(none.clip, rig)->missing_channels), (Indices{0}));
}

TEST(Binding, OfTwoChannelsForOneControlTheFirstCounts) {
  const MadeClip made(input_of({"jawopen", "jawOpen"}));
  const RigHandle rig = NamedRig{{"jawOpen"}, {}, {}}.make();
  const Bound bound(made.clip, rig);
  EXPECT_EQ(bound.apply({0.1f, 0.2f}), (Floats{0.1f}));
  EXPECT_EQ(list(bound->missing_channels), (Indices{1}));
}

TEST(Binding, ThePrefixAloneIsAName) {
  const MadeClip made(input_of({"CTRL_expressions.", "CTRL_expressions"}));
  const RigHandle rig = NamedRig{{"ctrl_expressions_", "x"}, {}, {}}.make();
  EXPECT_EQ(list(Bound(made.clip, rig)->controls), (Indices{0}));
}

// GUI controls --------------------------------------------------------------------------------------------

/// Lids: up opens wide, down closes; jaw: opens, and clenches below 0.
NamedRig gui_rig() {
  return {{"blink", "wide", "jawOpen", "clench", "free"},
          {"CTRL_lid.ty", "CTRL_jaw.ty", "CTRL_other.tx"},
          {{0, 0, -1, 0, -1, 0},
           {0, 1, 0, 1, 1, 0},
           {1, 2, 0, 1, 1, 0},
           {1, 3, -1, 0, -1, 0},
           {2, 2, 0, 1, 0.25f, 0},
           {2, 3, -1, 1, 0.5f, 0.125f}}};
}

TEST(Binding, GuiControlsGoThroughTheTableOfTheRig) {
  const MadeClip made(input_of({"CTRL_lid_ty", "ctrl_jaw.ty"}));
  const RigHandle rig = gui_rig().make();
  const Bound bound(made.clip, rig);
  EXPECT_EQ(list(bound->controls), (Indices{0, 1, 2, 3}));
  EXPECT_EQ(list(bound->extra_controls), (Indices{4}));
  // The third GUI control is at 0, where it gives 0.125 to "clench".
  EXPECT_EQ(bound.apply({-0.5f, 0.75f}), (Floats{0.5f, 0, 0.75f, 0.125f, -9}));
  EXPECT_EQ(bound.apply({0.5f, -0.75f}), (Floats{0, 0.5f, 0, 0.875f, -9}));
  EXPECT_EQ(bound.apply({-3, 3}), (Floats{0, 0, 0, 0.125f, -9})) << "outside of every row";
}

TEST(Binding, ControlsThatNoGuiControlOfTheClipMovesAreLeftAlone) {
  const MadeClip made(input_of({"CTRL_lid.ty"}));
  const Bound bound(made.clip, gui_rig().make());
  EXPECT_EQ(bound.apply({1}), (Floats{0, 1, -9, -9, -9}));
}

TEST(Binding, ARawControlNamedByAChannelIsNotMovedByGuiControls) {
  const MadeClip made(input_of({"CTRL_jaw.ty", "jawOpen"}));
  const Bound bound(made.clip, gui_rig().make());
  EXPECT_EQ(bound.apply({0.75f, 0.3f}), (Floats{-9, -9, 0.3f, 0.125f, -9}));
}

TEST(Binding, GuiControlsGiveTheBitsOfTheRigItself) {
  Random random = Random::from_seed(7, 7);
  int moved = 0;
  for (int i = 0; i < 200; ++i) {
    PlainRig plain = random_rig(random);
    Names channels;
    for (uint32_t g = 0; g < plain.gui_count; ++g) {
      if (random.chance(0.7)) channels.push_back("gui" + std::to_string(g));
    }
    if (channels.empty()) continue;
    const RigHandle rig = make_rig(plain);
    const MadeClip made(input_of(channels));
    const Bound bound(made.clip, rig);
    EXPECT_EQ(bound->missing_channels.count, 0u);
    Character character(rig);
    for (int k = 0; k < 20; ++k) {
      Floats values(channels.size());
      for (float& value : values) value = static_cast<float>(random.between(-1.5, 1.5));
      for (float& gui : character.gui) gui = 0;
      for (size_t c = 0; c < channels.size(); ++c) {
        character.gui[static_cast<size_t>(std::stoi(channels[c].substr(3)))] = values[c];
      }
      character.map_gui_to_raw();
      const Floats raw = bound.apply(values);
      for (uint16_t control : bound->controls) {
        ASSERT_EQ(bits_of(raw[control]), bits_of(character.raw[control])) << control;
        moved += raw[control] != 0;
      }
      for (uint16_t control : bound->extra_controls) ASSERT_EQ(raw[control], -9);
    }
  }
  EXPECT_GT(moved, 1000);
}

// Matrices -------------------------------------------------------------------------------------------

TEST(Binding, AMatrixSumsInItsOrder) {
  const MadeClip made(input_of({"eyeBlinkLeft", "tongueOut", "still"}));
  const RigHandle rig = NamedRig{{"blinkL", "blinkR", "tongue"}, {}, {}}.make();
  const Matrix matrix = {{"tongueOut", "tongue", 0.77f},
                         {"EYEBLINKLEFT", "blinkL", 1},
                         {"still", "blinkR", 0.5f},
                         {"tongueOut", "blinkL", 0.1f},
                         {"eyeBlinkLeft", "blinkR", 0.25f}};
  const Bound bound(made.clip, rig, matrix);
  const float blink = 0.3f, tongue = 0.6f, still = 0.7f;
  EXPECT_EQ(bound.apply({blink, tongue, still}),
            (Floats{blink + 0.1f * tongue, 0.5f * still + 0.25f * blink, 0.77f * tongue}));
  EXPECT_EQ(bound->missing_channels.count, 0u);
  EXPECT_EQ(bound->missing_entries, 0u);
}

TEST(Binding, AMatrixReachesGuiControls) {
  const MadeClip made(input_of({"eyeBlink", "eyeWide"}));
  const Matrix matrix = {{"eyeBlink", "CTRL_lid.ty", -1}, {"eyeWide", "CTRL_lid.ty", 1}};
  const Bound bound(made.clip, gui_rig().make(), matrix);
  EXPECT_EQ(bound.apply({0.75f, 0.25f}), (Floats{0.5f, 0, -9, -9, -9}));
  EXPECT_EQ(bound.apply({0.25f, 0.75f}), (Floats{0, 0.5f, -9, -9, -9}));
}

TEST(Binding, TheMoreDirectWayWins) {
  const MadeClip made(input_of({"jawOpen", "capture", "still", "CTRL_jaw.ty"}));
  const Matrix matrix = {{"capture", "jawOpen", 1}, {"capture", "clench", 1}};
  const Bound bound(made.clip, gui_rig().make(), matrix);
  EXPECT_EQ(bound.apply({0.1f, 0.2f, 0, 0.9f}), (Floats{-9, -9, 0.1f, 0.2f, -9}));
}

TEST(Binding, EntriesOfAMatrixThatFitNothingAreCounted) {
  const MadeClip made(input_of({"capture", "other"}));
  const Matrix matrix = {
      {"capture", "nowhere", 1}, {"nothing", "blink", 1}, {"capture", "wide", 1}};
  const Bound bound(made.clip, gui_rig().make(), matrix);
  EXPECT_EQ(bound->missing_entries, 2u);
  EXPECT_EQ(list(bound->missing_channels), (Indices{1}));
  EXPECT_EQ(list(bound->controls), (Indices{1}));
}

TEST(Binding, RefusesWeightsThatAreNotFinite) {
  const MadeClip made(input_of({"capture"}));
  const RigHandle rig = gui_rig().make();
  for (float bad :
       {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    const Matrix matrix = {{"capture", "wide", 1}, {"capture", "blink", bad}};
    Binding other;
    Binding* binding = &other;  // to be overwritten
    Error error;
    EXPECT_EQ(bind_clip(made.clip, rig_of(rig), matrix, default_allocator(), binding, error),
              Status::kInvalidArgument);
    EXPECT_EQ(binding, nullptr);
    EXPECT_NE(std::string(error.message).find("entry 1"), std::string::npos) << error.message;
  }
}

TEST(Binding, SurvivesEveryFailureOfTheAllocator) {
  const MadeClip made(input_of({"jawOpen", "capture", "still", "CTRL_jaw.ty"}));
  const RigHandle rig = gui_rig().make();
  const Matrix matrix = {{"capture", "blink", 1}};
  for (size_t k = 0; k <= 2; ++k) {
    CountingAllocator counter;
    counter.fail_at = k;
    const MienAllocator a = counter.get();
    Binding* binding = nullptr;
    Error error;
    const Status status =
        bind_clip(made.clip, rig_of(rig), matrix, {a.user, a.allocate, a.release}, binding, error);
    EXPECT_EQ(status, k == 0 ? Status::kOk : Status::kMemory);
    EXPECT_EQ(binding != nullptr, k == 0);
    EXPECT_EQ(counter.live, k == 0 ? 1u : 0u) << "a binding is one block";
    release(binding);
    EXPECT_TRUE(counter.clean()) << counter.first_wrong;
  }
  release<Binding>(nullptr);
}

TEST(Binding, BindsToARigThatWasOpenedFromDna) {
  Arena arena(default_allocator());
  const std::vector<uint8_t> bytes = write_view(dna::tiny_rig(arena));
  const RigHandle rig = create_rig(open_dna(bytes).get());
  const MadeClip made(input_of({"smileL", "CTRL_jaw.ty"}));
  const Bound bound(made.clip, rig);
  EXPECT_EQ(bound->missing_channels.count, 0u);
  EXPECT_EQ(bound.apply({0.25f, 0})[1], 0.25f);
}

}  // namespace
}  // namespace mien
