// SPDX-License-Identifier: MIT
// Guards probed on generated heads, and what becomes of lips and lids when emotions are mixed over
// speech. Distances are measured by evaluating and deforming the head.
#include "runtime/probe/probe_guards.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "author/base/dna_making.h"
#include "runtime/probe/probe_controls.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/deform_rig.h"
#include "tests/support/face_poses.h"
#include "tests/support/placed_guards.h"

namespace mien {
namespace {

using Kind = StandardGuard;
constexpr uint64_t kSeeds[] = {0, 7};

struct GuardedHead {
  DnaHandle dna;
  RigHandle rig;
  DeformerHandle handle;
  const Deformer& deformer;
  std::vector<std::string> controls;
  Arena arena{default_allocator()};
  StandardGuards standard = {};
  std::vector<Guard> guards;
  RigProbe probe;

  explicit GuardedHead(DnaHandle made)
      : dna(std::move(made)), rig(create_rig(dna.get())),
        handle(create_deformer(dna.get(), rig.get())), deformer(*capi::object(handle.get())),
        controls(names_of(rig, MIEN_KIND_RAW_CONTROL)), probe(deformer, default_allocator()) {
    Error error;
    EXPECT_EQ(find_standard_guards(deformer, default_allocator(), arena, standard, error),
              Status::kOk);
    guards.resize(standard.count);
    EXPECT_EQ(probe_guards(deformer, {standard.descs, standard.count}, default_allocator(),
                           {guards.data(), guards.size()}, error),
              Status::kOk)
        << error.message;
  }

  size_t index(Kind kind) const {
    const StandardGuard* end = standard.kinds + standard.count;
    return static_cast<size_t>(std::find(standard.kinds, end, kind) - standard.kinds);
  }
  bool has(Kind kind) const { return index(kind) < standard.count; }

  double measure(Kind kind, const Pose& row) {
    probe.clear();
    for (uint16_t c = 0; c < row.size(); ++c) probe.set(c, row[c]);
    probe.pose();
    const GuardDesc& desc = standard.descs[index(kind)];
    const Vec3 up = probe.axis(2) * probe.millimeters();
    return dot(probe.place(desc.upper) - probe.place(desc.lower), up);
  }
  /// Millimeters, as the mesh has it.
  double distance(Kind kind, const Pose& row) {
    if (!contacts.count(kind)) {
      Pose touching(controls.size());
      const uint16_t closed_by = standard.descs[index(kind)].closed_by;
      if (closed_by != kNoControl) touching[closed_by] = 1;
      contacts[kind] = measure(kind, touching);
    }
    return measure(kind, row) - contacts[kind];
  }
  std::map<Kind, double> contacts;
};

GuardedHead& head(uint64_t seed) {
  static std::map<uint64_t, std::unique_ptr<GuardedHead>> heads;
  std::unique_ptr<GuardedHead>& made = heads[seed];
  if (!made) made = std::make_unique<GuardedHead>(generate_dna(MIEN_PRESET_HEAD, seed));
  return *made;
}

/// An emotion over a row, in screen mode.
Pose over(const Pose& row, const Pose& emotion, float weight) {
  Pose mixed = row;
  for (size_t c = 0; c < row.size(); ++c) mixed[c] += weight * emotion[c] * (1 - row[c]);
  return mixed;
}

double change(const Pose& from, const Pose& to) {
  double sum = 0;
  for (size_t c = 0; c < from.size(); ++c) sum += std::abs(double{to[c]} - from[c]);
  return sum;
}

bool is_mouth(const std::string& control) {
  return control.rfind("mouth", 0) == 0 || control.rfind("jaw", 0) == 0 ||
         control.rfind("tongue", 0) == 0;
}

float activation_of(const Guard& guard, const Pose& row) {
  return guard_activation(guard, guard_distance(guard, row.data()));
}
/// The guards of some kinds; fully active, or as active as they find themselves.
struct Guards {
  PlacedGuards guards;

  Guards(const GuardedHead& head, const std::vector<Kind>& kinds) : guards(some(head, kinds)) {}
  static std::vector<Guard> some(const GuardedHead& head, const std::vector<Kind>& kinds) {
    std::vector<Guard> guards;
    for (Kind kind : kinds) guards.push_back(head.guards[head.index(kind)]);
    return guards;
  }
  /// How far they want curves back.
  Pose hold(const Pose& protected_row, const Pose& free_row, bool fully) const {
    return guards.back(protected_row, free_row, fully ? 1.0f : -1.0f);
  }
  /// What they leave when they have the time.
  Pose left_by(const Pose& protected_row, const Pose& free_row) const {
    const Pose back = hold(protected_row, free_row, true);
    Pose row(back.size()), held(back.size());
    ease_guards(free_row.data(), protected_row.data(), back.data(),
                static_cast<uint32_t>(back.size()), std::numeric_limits<float>::infinity(),
                held.data(), row.data());
    return row;
  }
};
const std::vector<Kind> kLips = {Kind::kLipsLeft, Kind::kLipsCenter, Kind::kLipsRight};

/// What emotions do to some poses, with guards and without.
struct Outcome {
  double kept = 0, kept_without_mouth = 0;  // shares of the emotions, means
  double opened_model = 0;                  // worst, by the function of the guard
  double opened = 0, opened_freely = 0;     // worst, measured
  double median_opened_freely = 0;
};

Outcome try_emotions(GuardedHead& head, const std::vector<Pose>& poses, std::vector<Kind> kinds) {
  Outcome out;
  const Guards guards(head, kinds);
  std::vector<double> freely;
  double count = 0;
  for (const Pose& pose : poses) {
    std::vector<double> before;
    for (Kind kind : kinds) before.push_back(std::max(0.0, head.distance(kind, pose)));
    for (const Pose& emotion : emotions_of(head.controls)) {
      for (float weight : {0.3f, 0.7f, 1.0f}) {
        const Pose free = over(pose, emotion, weight);
        const Pose held = guards.left_by(pose, free);
        Pose masked = free;
        for (size_t c = 0; c < masked.size(); ++c) {
          if (is_mouth(head.controls[c])) masked[c] = pose[c];
        }
        const double all = change(pose, free);
        out.kept += change(pose, held) / all;
        out.kept_without_mouth += change(pose, masked) / all;
        ++count;
        for (size_t k = 0; k < kinds.size(); ++k) {
          const Guard& guard = head.guards[head.index(kinds[k])];
          const double model = std::max(0.0f, guard_distance(guard, held.data())) -
                               std::max(0.0f, guard_distance(guard, pose.data()));
          const double opened = std::max(0.0, head.distance(kinds[k], held)) - before[k];
          out.opened_model = std::max(out.opened_model, model);
          out.opened = std::max(out.opened, opened);
          freely.push_back(std::max(0.0, head.distance(kinds[k], free)) - before[k]);
        }
      }
    }
  }
  out.kept /= count;
  out.kept_without_mouth /= count;
  std::sort(freely.begin(), freely.end());
  out.opened_freely = freely.back();
  out.median_opened_freely = freely[freely.size() / 2];
  return out;
}

template <size_t N>
std::vector<Pose> poses_of(const PoseText (&texts)[N], const GuardedHead& head) {
  std::vector<Pose> poses;
  for (PoseText text : texts) poses.push_back(pose_of(text, head.controls));
  return poses;
}

// Landmarks ---------------------------------------------------------------------------------------

TEST(FindGuards, FindsLipsLidsAndTeethOfTheHead) {
  for (uint64_t seed : kSeeds) {
    const GuardedHead& h = head(seed);
    EXPECT_EQ(h.standard.count, kStandardGuardCount);
    for (Kind kind : {Kind::kLipsLeft, Kind::kLipsCenter, Kind::kLipsRight, Kind::kLipToTeeth,
                      Kind::kLidsLeft, Kind::kLidsRight, Kind::kTeeth}) {
      EXPECT_TRUE(h.has(kind)) << static_cast<int>(kind);
    }
    // Left is where x is positive.
    const auto across = [&](Kind kind) {
      GuardedHead& made = head(seed);
      made.probe.clear();
      made.probe.pose();
      return made.probe.place(h.standard.descs[h.index(kind)].upper).x;
    };
    EXPECT_GT(across(Kind::kLipsLeft), 0.5);
    EXPECT_NEAR(across(Kind::kLipsCenter), 0, 1e-3);
    EXPECT_LT(across(Kind::kLipsRight), -0.5);
    EXPECT_GT(across(Kind::kLidsLeft), 2);
    EXPECT_LT(across(Kind::kLidsRight), -2);
  }
}

TEST(FindGuards, TakesJointsOfMetaHumanNamesWhereNoMeshHasEdges) {
  DnaHandle dna = generate_dna(MIEN_PRESET_HEAD, 0);
  dna::Definition& defn = dna->view.defn;
  const auto rename = [&](auto& names, const char* from, const char* to) {
    for (dna::String& name : names) {
      if (std::string(name.chars(), name.count) != from) continue;
      ASSERT_TRUE(author::copy_text(dna->arena, author::Text().add(to), name));
      return;
    }
    FAIL() << from;
  };
  rename(defn.raw_control_names, "jawOpen", "somethingElse");
  rename(defn.raw_control_names, "eyeBlinkLeft", "CTRL_expressions.eyeBlinkL");
  rename(defn.joint_names, "C_LipUpper", "FACIAL_C_LipUpper");
  rename(defn.joint_names, "C_LipLower", "FACIAL_C_LipLower");
  rename(defn.joint_names, "C_TeethUpper", "FACIAL_C_TeethUpper");
  rename(defn.joint_names, "C_TeethLower", "FACIAL_C_TeethLower");
  const GuardedHead h(std::move(dna));
  EXPECT_TRUE(h.has(Kind::kLipsCenter));
  EXPECT_FALSE(h.has(Kind::kLipsLeft)) << "this head has no such joint";
  EXPECT_TRUE(h.has(Kind::kTeeth));
  EXPECT_TRUE(h.has(Kind::kLipToTeeth));
  EXPECT_TRUE(h.has(Kind::kLidsLeft));
  EXPECT_EQ(h.standard.descs[h.index(Kind::kLipsCenter)].upper.mesh, kOfJoints);
  EXPECT_GT(h.guards[h.index(Kind::kLipsCenter)].gains[0], 15) << "the jaw";
}

TEST(FindGuards, FindsNothingOnARigWithoutAFace) {
  const DeformRigOptions options;
  const Deformed rig(random_deform_rig(1, options));
  Arena arena(default_allocator());
  StandardGuards found;
  Error error;
  EXPECT_EQ(find_standard_guards(*capi::object(rig.deformer.get()), default_allocator(), arena,
                                 found, error),
            Status::kOk);
  EXPECT_EQ(found.count, 0u);
}

// Planning ----------------------------------------------------------------------------------------

TEST(PlanGuards, TakesTheStandardGuardsThatAreAskedForThenTheCallers) {
  const GuardedHead& h = head(0);
  const uint32_t lips = static_cast<uint32_t>(h.index(Kind::kLipsCenter));
  GuardDesc own = h.standard.descs[lips];
  own.kind = kStandardGuardCount;
  own.tolerance = 2;
  Guard guards[kMaxGuards];
  uint32_t count = 0;
  Error error;
  const GuardKinds kinds =
      1u << static_cast<uint32_t>(Kind::kLipsCenter) | 1u << static_cast<uint32_t>(Kind::kLidsLeft);
  ASSERT_EQ(plan_guards(h.deformer, kinds, {&own, 1}, default_allocator(), guards, count, error),
            Status::kOk)
      << error.message;
  ASSERT_EQ(count, 3u);
  EXPECT_EQ(guards[0].kind, static_cast<uint32_t>(Kind::kLipsCenter));
  EXPECT_EQ(guards[1].kind, static_cast<uint32_t>(Kind::kLidsLeft));
  EXPECT_EQ(guards[2].kind, kStandardGuardCount);
  EXPECT_EQ(guards[2].tolerance, 2);
  EXPECT_EQ(guards[2].rest, guards[0].rest);  // the same landmarks
  ASSERT_EQ(plan_guards(h.deformer, 0, {&own, 1}, default_allocator(), guards, count, error),
            Status::kOk);
  EXPECT_EQ(count, 1u);
  ASSERT_EQ(plan_guards(h.deformer, 0, {}, default_allocator(), guards, count, error), Status::kOk);
  EXPECT_EQ(count, 0u);
}

TEST(PlanGuards, RefusesMoreThanAMixHas) {
  const GuardedHead& h = head(0);
  const std::vector<GuardDesc> own(kMaxGuards, h.standard.descs[0]);
  Guard guards[kMaxGuards];
  uint32_t count = 7;
  Error error;
  const GuardKinds kinds = 1u << static_cast<uint32_t>(Kind::kLipsCenter);
  EXPECT_EQ(plan_guards(h.deformer, kinds, {own.data(), own.size()}, default_allocator(), guards,
                        count, error),
            Status::kInvalidArgument);
  EXPECT_EQ(count, 0u);
  EXPECT_EQ(std::string(error.message),
            "1 guards of the rig and 8 of the caller; a mix has at "
            "most 8");
}

// Probing -----------------------------------------------------------------------------------------

TEST(ProbeGuards, FitsTheHeadToHalfAMillimeter) {
  for (uint64_t seed : kSeeds) {
    for (const Guard& guard : head(seed).guards) {
      EXPECT_GT(guard.fit_error, 0);
      EXPECT_LT(guard.fit_error, 0.5);
      EXPECT_LE(guard.count, kMaxGuardCurves);
      EXPECT_GT(guard.count, 3u);
      for (uint32_t i = 1; i < guard.count; ++i) {
        EXPECT_GE(std::abs(guard.gains[i - 1]), std::abs(guard.gains[i]));
      }
    }
  }
}

// The jaw turns, and the function is linear in each control: measured at a jaw that is half open, it is off by 2 mm
// when the jaw is wide open. Up to the 0.65 that vowels use, a tenth of a millimeter is left, correctives included.
TEST(ProbeGuards, FitsTheHeadToATenthOfAMillimeterUpToVowels) {
  for (uint64_t seed : kSeeds) {
    GuardedHead& h = head(seed);
    const auto jaw = static_cast<size_t>(
        std::find(h.controls.begin(), h.controls.end(), "jawOpen") - h.controls.begin());
    for (uint32_t g = 0; g < h.standard.count; ++g) {
      const Kind kind = h.standard.kinds[g];
      double turn = 0, squares = 0;
      const auto next = [&turn](double step) {
        turn += step;
        return turn - std::floor(turn);
      };
      constexpr int kRows = 64;
      for (int r = 0; r < kRows; ++r) {
        Pose row(h.controls.size());
        for (int k = 0; k < 6; ++k) {
          const auto at = static_cast<size_t>(next(0.6180339887498949) * double(row.size()));
          row[at] = static_cast<float>(next(0.7548776662466927));
        }
        row[jaw] = std::min(row[jaw], 0.65f);
        const double off = double(guard_distance(h.guards[g], row.data())) - h.distance(kind, row);
        squares += off * off / kRows;
      }
      EXPECT_LT(std::sqrt(squares), 0.1) << guard_name(h.guards[g].kind);
    }
    Pose wide(h.controls.size());
    wide[jaw] = 1;
    const double off = double(guard_distance(h.guards[h.index(Kind::kTeeth)], wide.data())) -
                       h.distance(Kind::kTeeth, wide);
    EXPECT_GT(off, 1.5);
    EXPECT_LT(off, 3);
  }
}

TEST(ProbeGuards, JoinsTheHalvesOfTheFaceInTheMiddleOnly) {
  for (uint64_t seed : kSeeds) {
    const GuardedHead& h = head(seed);
    const auto joined = [&h](Kind kind) {
      const Guard& guard = h.guards[h.index(kind)];
      std::set<std::string> names;
      for (uint32_t i = 1; i < guard.count; ++i) {
        if ((guard.together >> i & 1) == 0) continue;
        names.insert(h.controls[guard.curves[i - 1]] + " " + h.controls[guard.curves[i]]);
      }
      return names;
    };
    for (const char* names : {"mouthLowerDownLeft mouthLowerDownRight",
                              "mouthUpperUpLeft mouthUpperUpRight", "jawLeft jawRight"}) {
      EXPECT_EQ(joined(Kind::kLipsCenter).count(names), 1u) << names;
    }
    EXPECT_EQ(joined(Kind::kLipsLeft), std::set<std::string>{"jawLeft jawRight"});
    EXPECT_TRUE(joined(Kind::kLidsLeft).empty());
  }
}

TEST(ProbeGuards, KnowsThatTheSealUndoesTheJaw) {
  GuardedHead& h = head(0);
  const Guard& lips = h.guards[h.index(Kind::kLipsCenter)];
  const Pose jaw = pose_of("jawOpen .6", h.controls);
  const Pose sealed = pose_of("jawOpen .6, mouthClose 1", h.controls);
  EXPECT_NEAR(guard_distance(lips, jaw.data()), h.distance(Kind::kLipsCenter, jaw), 0.5);
  EXPECT_GT(guard_distance(lips, jaw.data()), 15);
  EXPECT_NEAR(guard_distance(lips, sealed.data()), h.distance(Kind::kLipsCenter, sealed), 0.3);
  EXPECT_LT(guard_distance(lips, sealed.data()), 0.3);
}

TEST(ProbeGuards, LidsTouchWhenTheyBlink) {
  for (uint64_t seed : kSeeds) {
    GuardedHead& h = head(seed);
    const Pose blink = pose_of("eyeBlink 1", h.controls), rest(h.controls.size());
    for (Kind kind : {Kind::kLidsLeft, Kind::kLidsRight}) {
      const Guard& lids = h.guards[h.index(kind)];
      EXPECT_NEAR(guard_distance(lids, blink.data()), 0, 0.01);
      EXPECT_NEAR(guard_distance(lids, rest.data()), h.distance(kind, rest), 0.01);
      EXPECT_EQ(activation_of(lids, rest), 0);
      EXPECT_GT(activation_of(lids, pose_of("eyeBlink .85", h.controls)), 0.5f);
    }
  }
}

TEST(ProbeGuards, GivesTheSameTwice) {
  GuardedHead& h = head(7);
  std::vector<Guard> again(h.guards.size());
  Error error;
  ASSERT_EQ(probe_guards(h.deformer, {h.standard.descs, h.standard.count}, default_allocator(),
                         {again.data(), again.size()}, error),
            Status::kOk);
  for (size_t g = 0; g < again.size(); ++g) {
    EXPECT_EQ(memcmp(&again[g], &h.guards[g], sizeof(Guard)), 0);
  }
}

TEST(ProbeGuards, RefusesDescsThatDoNotFitTheRig) {
  GuardedHead& h = head(0);
  const GuardDesc good = h.standard.descs[0];
  const auto status_of = [&](auto change) {
    GuardDesc descs[2] = {good, good};
    change(descs[1]);
    Guard out[2];
    Error error;
    const Status status =
        probe_guards(h.deformer, {descs, 2}, default_allocator(), {out, 2}, error);
    EXPECT_TRUE(strstr(error.message, "guard 1")) << error.message;
    return status;
  };
  uint32_t far[] = {1u << 20};
  EXPECT_EQ(status_of([](GuardDesc& d) { d.upper.points = {}; }), Status::kInvalidArgument);
  EXPECT_EQ(status_of([&](GuardDesc& d) { d.lower.points = {far, 1}; }), Status::kIndex);
  EXPECT_EQ(status_of([](GuardDesc& d) { d.upper.mesh = 1000; }), Status::kIndex);
  EXPECT_EQ(status_of([](GuardDesc& d) { d.upper.mesh = 40; }), Status::kIndex) << "of LOD 5";
  EXPECT_EQ(status_of([&](GuardDesc& d) { d.lower = {kOfJoints, {far, 1}}; }), Status::kIndex);
  EXPECT_EQ(status_of([](GuardDesc& d) { d.closed_by = 72; }), Status::kIndex);
  for (float bad : {0.0f, -1.0f, NAN, INFINITY}) {
    EXPECT_EQ(status_of([bad](GuardDesc& d) { d.f_on = bad; }), Status::kInvalidArgument);
  }
  for (float bad : {-1.0f, NAN, INFINITY}) {
    EXPECT_EQ(status_of([bad](GuardDesc& d) { d.tolerance = bad; }), Status::kInvalidArgument);
  }
}

TEST(ProbeGuards, FailsWithoutALeakWhereverMemoryRunsOut) {
  GuardedHead& h = head(0);
  for (size_t request = 1;; ++request) {
    CountingAllocator memory;
    memory.fail_at = request;
    const MienAllocator counted = memory.get();
    const Allocator allocator = {counted.user, counted.allocate, counted.release};
    StandardGuards found;
    Guard guard;
    Error error;
    Status status;
    {
      Arena arena(allocator);
      status = find_standard_guards(h.deformer, allocator, arena, found, error);
      if (status == Status::kOk) {
        status = probe_guards(h.deformer, {found.descs, 1}, allocator, {&guard, 1}, error);
      }
    }
    EXPECT_TRUE(memory.clean()) << memory.first_wrong;
    if (memory.failed == 0) {
      EXPECT_EQ(status, Status::kOk);
      EXPECT_GT(request, 10u);
      break;
    }
    EXPECT_EQ(status, Status::kMemory);
  }
}

// Speech under emotion ----------------------------------------------------------------------------

TEST(GuardedSpeech, LipsStayClosedAndMostOfTheEmotionStays) {
  for (uint64_t seed : kSeeds) {
    GuardedHead& h = head(seed);
    const std::vector<Pose> poses = poses_of(kClosedLips, h);
    for (const Pose& pose : poses) EXPECT_LT(h.distance(Kind::kLipsCenter, pose), 0.1);
    const Outcome o = try_emotions(h, poses, kLips);
    EXPECT_GT(o.median_opened_freely, 1) << "the test bites";
    EXPECT_GT(o.opened_freely, 15);
    EXPECT_LE(o.opened_model, 0.3001);
    EXPECT_LE(o.opened, 0.5);
    EXPECT_GE(o.kept, 0.80);
    EXPECT_GE(o.kept, o.kept_without_mouth + 0.20);
    RecordProperty("kept_" + std::to_string(seed), std::to_string(o.kept));
    RecordProperty("kept_without_mouth_" + std::to_string(seed),
                   std::to_string(o.kept_without_mouth));
    RecordProperty("opened_" + std::to_string(seed), std::to_string(o.opened));
    RecordProperty("opened_freely_" + std::to_string(seed), std::to_string(o.opened_freely));
  }
}

TEST(GuardedSpeech, FacesThatAreEvenStayEvenAndMirroredOnesMirrored) {
  for (uint64_t seed : kSeeds) {
    GuardedHead& h = head(seed);
    const Guards guards(h, kLips);
    std::vector<uint16_t> mirror(h.controls.size());
    Error error;
    ASSERT_EQ(find_mirror(h.deformer, default_allocator(), {mirror.data(), mirror.size()}, error),
              Status::kOk);
    const auto mirrored = [&](const Pose& row) {
      Pose out(row.size());
      for (size_t c = 0; c < row.size(); ++c) out[mirror[c]] = row[c];
      return out;
    };
    const auto difference = [](const Pose& a, const Pose& b) {
      float most = 0;
      for (size_t c = 0; c < a.size(); ++c) most = std::max(most, std::abs(a[c] - b[c]));
      return most;
    };
    size_t even = 0, held_back = 0;
    for (const Pose& pose : poses_of(kClosedLips, h)) {
      for (Pose emotion : emotions_of(h.controls)) {
        for (bool one_sided : {false, true}) {
          for (size_t c = 0; one_sided && c < emotion.size(); ++c) {
            if (mirror[c] > c) emotion[c] *= 0.25f;
          }
          const Pose free = over(pose, emotion, 1), held = guards.left_by(pose, free);
          EXPECT_LE(difference(guards.left_by(mirrored(pose), mirrored(free)), mirrored(held)),
                    1e-4f);
          if (difference(free, mirrored(free)) == 0) {
            ++even;
            EXPECT_LE(difference(held, mirrored(held)), 1e-4f);
          }
          held_back += difference(free, held) > 0.1f;
        }
      }
    }
    EXPECT_GT(even, 50u);
    EXPECT_GT(held_back, 200u);
  }
}

TEST(GuardedSpeech, LowerLipStaysAtTheTeeth) {
  for (uint64_t seed : kSeeds) {
    GuardedHead& h = head(seed);
    const Outcome o = try_emotions(h, poses_of(kLipToTeeth, h), {Kind::kLipToTeeth});
    EXPECT_GT(o.opened_freely, 10);
    EXPECT_LE(o.opened_model, 0.3001);
    EXPECT_LE(o.opened, 0.5);
    EXPECT_GE(o.kept, 0.80);
    EXPECT_GE(o.kept, o.kept_without_mouth + 0.20);
  }
}

TEST(GuardedSpeech, LidsStayAsShutAsABlinkHasThem) {
  for (uint64_t seed : kSeeds) {
    GuardedHead& h = head(seed);
    const PoseText blinks[] = {"eyeBlink .8", "eyeBlink .9, mouthSmile .4", "eyeBlink 1"};
    const Outcome o = try_emotions(h, poses_of(blinks, h), {Kind::kLidsLeft, Kind::kLidsRight});
    EXPECT_GT(o.opened_freely, 0.5);
    EXPECT_LE(o.opened_model, 0.3001);
    EXPECT_LE(o.opened, 0.5);
    EXPECT_GE(o.kept, 0.95);
  }
}

/// Vowels and closed lips in turn, 8 a second, each led into the next by a quintic.
Pose speech_at(const GuardedHead& h, double seconds) {
  static constexpr PoseText kVowels[] = {
      "jawOpen .65, mouthUpperUp .15, mouthLowerDown .2", "jawOpen .3, mouthStretch .4",
      "jawOpen .45, mouthFunnel .4, mouthPucker .2", "jawOpen .25, mouthPucker .7",
      "jawOpen .15, mouthUpperUp .2, mouthLowerDown .25"};
  const auto phoneme = [&h](size_t i) {
    return pose_of(i % 2 ? kClosedLips[i / 2 * 3 % 5] : kVowels[i / 2 % 5], h.controls);
  };
  static std::vector<Pose> made;
  while (made.size() < 40) made.push_back(phoneme(made.size()));
  const size_t i = static_cast<size_t>(seconds * 8);
  const float u = static_cast<float>(seconds * 8 - static_cast<double>(i));
  const float s = u * u * u * (u * (6 * u - 15) + 10);
  Pose pose = made[i];
  for (size_t c = 0; c < pose.size(); ++c) pose[c] += s * (made[i + 1][c] - pose[c]);
  return pose;
}

TEST(GuardedSpeech, NoCurveIsFasterThanItsSourcesByMoreThanTheGuardsSpeed) {
  GuardedHead& h = head(0);
  const Guards guards(h, kLips);
  for (double dt : {0.001, 1 / 60.0}) {
    double fastest = 0, fastest_source = 0, fastest_gain = 0;
    std::vector<double> opened, opened_freely;
    for (const Pose& emotion : emotions_of(h.controls)) {
      Pose before, free_before, speech_before, held(h.controls.size());
      for (double time = 0; time < 4; time += dt) {
        const double beat = std::fmod(time, 1.6);  // in 0.3 s, there for 0.8 s, away in 0.3 s
        const float ramp =
            static_cast<float>(std::clamp(std::min(beat, 1.4 - beat) / 0.3, 0.0, 1.0));
        const Pose speech = speech_at(h, time), free = over(speech, emotion, ramp);
        const Pose back = guards.hold(speech, free, false);
        Pose row(free.size());
        ease_guards(free.data(), speech.data(), back.data(), static_cast<uint32_t>(row.size()),
                    static_cast<float>(kGuardSpeed * dt), held.data(), row.data());
        for (size_t c = 0; !before.empty() && c < row.size(); ++c) {
          const double source =
              std::max(std::abs(free[c] - free_before[c]), std::abs(speech[c] - speech_before[c])) /
              dt;
          const double speed = std::abs(row[c] - before[c]) / dt;
          fastest_gain = std::max(fastest_gain, speed - source);
          fastest = std::max(fastest, speed);
          fastest_source = std::max(fastest_source, source);
        }
        const Guard& lips = h.guards[h.index(Kind::kLipsCenter)];
        const float closed = std::max(0.0f, guard_distance(lips, speech.data()));
        if (closed < 0.5f) {
          opened.push_back(guard_distance(lips, row.data()) - closed);
          opened_freely.push_back(guard_distance(lips, free.data()) - closed);
        }
        before = row;
        free_before = free;
        speech_before = speech;
      }
    }
    EXPECT_LE(fastest, fastest_source + 12);
    EXPECT_LE(fastest_gain, 12.01) << "each curve by itself, within rounding";
    EXPECT_GT(fastest_gain, 5);
    // The guards are in time: lips that close stay closed although curves are eased.
    std::sort(opened.begin(), opened.end());
    std::sort(opened_freely.begin(), opened_freely.end());
    EXPECT_LE(opened[opened.size() * 99 / 100], 0.5);
    const auto within = std::upper_bound(opened.begin(), opened.end(), 0.5) - opened.begin();
    RecordProperty(
        "within_half_a_millimeter_" + std::to_string(dt),
        std::to_string(static_cast<double>(within) / static_cast<double>(opened.size())));
    EXPECT_GT(opened_freely[opened_freely.size() * 9 / 10], 5);
  }
}

TEST(GuardedSpeech, AGuardThatIsNotActiveChangesNoBit) {
  GuardedHead& h = head(0);
  const Guards guards(h, kLips);
  const Pose open = pose_of("jawOpen .7", h.controls);
  for (const Pose& emotion : emotions_of(h.controls)) {
    const Pose free = over(open, emotion, 1);
    for (const Guard& guard : guards.guards.as_given) EXPECT_EQ(activation_of(guard, open), 0);
    const Pose back = guards.hold(open, free, false);
    Pose row(free.size()), held(free.size());
    ease_guards(free.data(), open.data(), back.data(), static_cast<uint32_t>(row.size()), 0.2f,
                held.data(), row.data());
    EXPECT_EQ(memcmp(row.data(), free.data(), row.size() * sizeof(float)), 0);
  }
}

}  // namespace
}  // namespace mien
