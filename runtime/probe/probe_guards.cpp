// SPDX-License-Identifier: MIT
#include "runtime/probe/probe_guards.h"

#include <algorithm>
#include <cmath>

#include "runtime/probe/probe_controls.h"

namespace mien {
namespace {

constexpr float kLeastGain = 0.05f;       // millimeters: smaller gains are not worth a curve
constexpr float kGainStep = 1 / 1024.0f;  // millimeters
constexpr float kProbeValue = 0.5f;       // of the controls that are tried
constexpr double kLeastOfHalves = 0.5;    // of the gain of a control, that its counterpart has
constexpr double kLeastOfPairs = 0.9;     // of that in pairs, where both do nothing alone
constexpr uint32_t kFitRows = 64;

float rounded(double gain) {
  return static_cast<float>(std::floor(gain / kGainStep + 0.5)) * kGainStep;
}

struct PairOfControls {
  uint16_t first, second;
};

/// Pairs of raw controls that share a corrective, each once, ascending.
bool list_pairs(const Rig& rig, Arena& arena, Span<PairOfControls>& out) {
  const PsdTable& psds = rig.psds;
  size_t room = 0;
  for (size_t e = 0; e < psds.outputs.count; ++e) {
    const size_t inputs = psds.first_input[e + 1] - psds.first_input[e];
    room += inputs * (inputs - 1) / 2;
  }
  const Span<PairOfControls> pairs = arena.array<PairOfControls>(room);
  if (room != 0 && !pairs.data) return false;
  size_t count = 0;
  for (size_t e = 0; e < psds.outputs.count; ++e) {
    for (uint32_t i = psds.first_input[e]; i < psds.first_input[e + 1]; ++i) {
      for (uint32_t k = i + 1; k < psds.first_input[e + 1]; ++k) {
        const auto [low, high] = std::minmax(psds.inputs[i], psds.inputs[k]);
        if (low != high && high < rig.raw_count) pairs[count++] = {low, high};
      }
    }
  }
  const auto before = [](const PairOfControls& a, const PairOfControls& b) {
    return a.first != b.first ? a.first < b.first : a.second < b.second;
  };
  const auto same = [](const PairOfControls& a, const PairOfControls& b) {
    return a.first == b.first && a.second == b.second;
  };
  std::sort(pairs.begin(), pairs.begin() + count, before);
  out = pairs.first(
      static_cast<size_t>(std::unique(pairs.begin(), pairs.begin() + count, same) - pairs.begin()));
  return true;
}

/// What was measured for one guard.
struct Measured {
  Span<double> gains;       // [raw control]
  Span<double> pair_gains;  // [pair]
  Span<double> scores;      // [raw control]
  double rest = 0, contact = 0;
};

/// Whether a control and its counterpart do about the same: alone or, where both do nothing alone, in pairs.
bool act_alike(const Measured& measured, uint16_t a, uint16_t b) {
  const double one = rounded(measured.gains[a]), other = rounded(measured.gains[b]);
  if (std::fabs(one) >= kLeastGain || std::fabs(other) >= kLeastGain) {
    return one * other >= 0 && std::fabs(other) >= kLeastOfHalves * std::fabs(one);
  }
  const auto [less, more] = std::minmax(measured.scores[a], measured.scores[b]);
  return less >= kLeastOfPairs * more;
}

/// Puts controls whose counterparts in the other half of the face do about the same beside those.
void join_halves(const Measured& measured, Span<const uint16_t> mirror, uint16_t* curves,
                 Guard& out) {
  for (uint32_t i = 0; i + 1 < out.count; ++i) {
    uint16_t* const other = std::find(curves + i + 1, curves + out.count, mirror[curves[i]]);
    if (other == curves + out.count || !act_alike(measured, curves[i], *other)) continue;
    std::rotate(curves + i + 1, other, other + 1);
    out.together |= 1u << ++i;
  }
}

/// The curves that matter most, alone or in a pair, by falling gain; then their pairs.
void choose_curves(const Measured& measured, Span<const PairOfControls> pairs,
                   Span<const uint16_t> mirror, Span<uint16_t> order, Guard& out) {
  for (size_t c = 0; c < order.count; ++c) {
    order[c] = static_cast<uint16_t>(c);
    measured.scores[c] = std::fabs(measured.gains[c]);
  }
  for (size_t p = 0; p < pairs.count; ++p) {
    for (uint16_t c : {pairs[p].first, pairs[p].second}) {
      measured.scores[c] = std::max(measured.scores[c], std::fabs(measured.pair_gains[p]));
    }
  }
  // Rounding hides what differs between the halves of a face by chance, and numbers of controls differ between them:
  // the guard of the other half is to have the counterparts in the same order.
  const auto by = [&](const Span<double>& sizes) {
    return [&](uint16_t a, uint16_t b) {
      const auto size = [](const Span<double>& of, uint16_t c) {
        return std::fabs(rounded(of[c]));
      };
      if (size(sizes, a) != size(sizes, b)) return size(sizes, a) > size(sizes, b);
      if (size(measured.scores, a) != size(measured.scores, b)) {
        return size(measured.scores, a) > size(measured.scores, b);
      }
      const uint16_t left = std::min(a, mirror[a]), right = std::min(b, mirror[b]);
      return left != right ? left < right : a < b;
    };
  };
  std::sort(order.begin(), order.end(), by(measured.scores));
  while (out.count < kMaxGuardCurves && out.count < order.count &&
         rounded(measured.scores[order[out.count]]) >= kLeastGain) {
    ++out.count;
  }
  // Both halves or none.
  if (out.count == kMaxGuardCurves && out.count < order.count) {
    const uint16_t last = order[out.count - 1], next = order[out.count];
    if (last != next && mirror[last] == next && act_alike(measured, last, next)) --out.count;
  }
  std::sort(order.begin(), order.begin() + out.count, by(measured.gains));
  join_halves(measured, mirror, order.data, out);
  for (uint32_t i = 0; i < out.count; ++i) {
    out.curves[i] = order[i];
    out.gains[i] = rounded(measured.gains[order[i]]);
  }
  for (size_t p = 0; p < pairs.count; ++p) {
    const float gain = rounded(measured.pair_gains[p]);
    const auto curve_of = [&out](uint16_t control) {
      return static_cast<uint16_t>(std::find(out.curves, out.curves + out.count, control) -
                                   out.curves);
    };
    const GuardPair pair = {curve_of(pairs[p].first), curve_of(pairs[p].second), gain};
    if (std::fabs(gain) < kLeastGain || pair.first == out.count || pair.second == out.count)
      continue;
    // The smallest one makes room.
    GuardPair* at = out.pairs + out.pair_count;
    if (out.pair_count == kMaxGuardPairs) {
      at = std::min_element(out.pairs, at, [](const GuardPair& a, const GuardPair& b) {
        return std::fabs(a.gain) < std::fabs(b.gain);
      });
      if (std::fabs(at->gain) >= std::fabs(gain)) continue;
    } else {
      ++out.pair_count;
    }
    *at = pair;
  }
}

Status check_landmark(const Deformer& deformer, const Landmark& landmark, size_t guard,
                      Error& error) {
  const bool joints = landmark.mesh == kOfJoints;
  if (landmark.points.empty()) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "guard %zu: a landmark has no points; give positions of a mesh, or joints", guard);
  }
  if (!joints &&
      (landmark.mesh >= deformer.meshes.count || !(deformer.meshes[landmark.mesh].lods & 1))) {
    return fail(error, Status::kIndex, kNoOffset,
                "guard %zu: mesh %u is none that LOD 0 shows, of %zu", guard, landmark.mesh,
                deformer.meshes.count);
  }
  const uint32_t count =
      joints ? deformer.rig->joint_count : deformer.meshes[landmark.mesh].position_count;
  for (uint32_t point : landmark.points) {
    if (point < count) continue;
    return fail(error, Status::kIndex, kNoOffset, "guard %zu: point %u; %s has %u", guard, point,
                joints ? "joints: the rig" : "positions: the mesh", count);
  }
  return Status::kOk;
}

Status check_guard(const Deformer& deformer, const GuardDesc& desc, size_t guard, Error& error) {
  const bool positive = desc.f_on > 0 && desc.f_on <= kLargestFloat && desc.tolerance >= 0 &&
                        desc.tolerance <= kLargestFloat;
  if (!positive) {
    return fail(
        error, Status::kInvalidArgument, kNoOffset,
        "guard %zu: .f_on is %g and .tolerance %g; the first must be above 0, the second 0 or "
        "more, both finite",
        guard, double{desc.f_on}, double{desc.tolerance});
  }
  if (desc.closed_by != kNoControl && desc.closed_by >= deformer.rig->raw_count) {
    return fail(error, Status::kIndex, kNoOffset, "guard %zu: .closed_by is raw control %u of %u",
                guard, desc.closed_by, deformer.rig->raw_count);
  }
  const Status status = check_landmark(deformer, desc.upper, guard, error);
  return status != Status::kOk ? status : check_landmark(deformer, desc.lower, guard, error);
}

}  // namespace

Status probe_guards(const Deformer& deformer, Span<const GuardDesc> descs,
                    const Allocator& allocator, Span<Guard> out, Error& error) {
  const Rig& rig = *deformer.rig;
  for (size_t g = 0; g < descs.count; ++g) {
    const Status status = check_guard(deformer, descs[g], g, error);
    if (status != Status::kOk) return status;
  }
  Arena arena(allocator);
  RigProbe probe(deformer, allocator);
  Span<PairOfControls> pairs;
  const Span<Measured> measured = arena.array<Measured>(descs.count);
  const Span<uint16_t> order = arena.array<uint16_t>(rig.raw_count);
  const Span<uint16_t> mirror = arena.array<uint16_t>(rig.raw_count);
  const Span<float> tried = arena.array<float>(rig.raw_count);
  bool memory = probe.ready() && list_pairs(rig, arena, pairs) &&
                (measured.data || descs.empty()) &&
                ((order.data && mirror.data && tried.data) || rig.raw_count == 0);
  for (Measured& m : measured) {
    m.gains = arena.array<double>(rig.raw_count);
    m.scores = arena.array<double>(rig.raw_count);
    m.pair_gains = arena.array<double>(pairs.count);
    memory = memory && (rig.raw_count == 0 || (m.gains.data && m.scores.data)) &&
             (pairs.empty() || m.pair_gains.data);
  }
  if (!memory) return fail(error, Status::kMemory, kNoOffset, "no memory to probe guards");

  const Status mirrored = find_mirror(deformer, allocator, mirror, error);
  if (mirrored != Status::kOk) return mirrored;

  const Vec3 up = probe.axis(2) * probe.millimeters();
  const auto distance = [&](size_t guard) {
    const GuardDesc& desc = descs[guard];
    return dot(probe.place(desc.upper) - probe.place(desc.lower), up);
  };
  // Controls that close are tried at 1, where they are needed most.
  for (float& value : tried) value = kProbeValue;
  for (const GuardDesc& desc : descs) {
    if (desc.closed_by != kNoControl) tried[desc.closed_by] = 1;
  }
  const auto pose = [&](std::initializer_list<uint16_t> controls) {
    probe.clear();
    for (uint16_t c : controls) probe.set(c, tried[c]);
    probe.pose();
  };
  pose({});
  for (size_t g = 0; g < descs.count; ++g) measured[g].rest = distance(g);
  for (uint16_t c = 0; c < rig.raw_count; ++c) {
    pose({c});
    for (size_t g = 0; g < descs.count; ++g) {
      measured[g].gains[c] = (distance(g) - measured[g].rest) / tried[c];
    }
  }
  for (size_t p = 0; p < pairs.count; ++p) {
    const auto [a, b] = pairs[p];
    pose({a, b});
    for (size_t g = 0; g < descs.count; ++g) {
      const Measured& m = measured[g];
      const double alone = m.rest + m.gains[a] * tried[a] + m.gains[b] * tried[b];
      m.pair_gains[p] = (distance(g) - alone) / (double{tried[a]} * tried[b]);
    }
  }
  for (size_t g = 0; g < descs.count; ++g) {
    Measured& m = measured[g];
    m.contact = m.rest;
    if (descs[g].closed_by != kNoControl) m.contact += m.gains[descs[g].closed_by];
    out[g] = Guard();
    out[g].f_on = descs[g].f_on;
    out[g].tolerance = descs[g].tolerance;
    out[g].kind = descs[g].kind;
    out[g].needs_speech = descs[g].needs_speech;
    out[g].rest = rounded(m.rest - m.contact);
    choose_curves(m, pairs, mirror, order, out[g]);
  }

  // Rows like those of faces: a few controls, in all strengths. The multiples of irrational numbers
  // spread evenly.
  double turn = 0;
  const auto next = [&turn](double step) {
    turn += step;
    return turn - std::floor(turn);
  };
  for (uint32_t row = 0; row < kFitRows; ++row) {
    probe.clear();
    for (uint32_t k = 0; k < 6 && rig.raw_count != 0; ++k) {
      const double place = next(0.6180339887498949) * rig.raw_count;
      probe.set(static_cast<uint16_t>(place), static_cast<float>(next(0.7548776662466927)));
    }
    probe.pose();
    for (size_t g = 0; g < descs.count; ++g) {
      const double off = distance(g) - measured[g].contact - guard_distance(out[g], probe.row());
      out[g].fit_error += static_cast<float>(off * off / kFitRows);
    }
  }
  for (size_t g = 0; g < descs.count; ++g) out[g].fit_error = std::sqrt(out[g].fit_error);
  return Status::kOk;
}

GuardKinds guard_kinds(uint32_t groups) {
  GuardKinds kinds = 0;
  for (uint32_t kind = 0; kind < kStandardGuardCount; ++kind) {
    if ((groups & guard_group(kind)) != 0) kinds |= 1u << kind;
  }
  return kinds;
}

Status plan_guards(const Deformer& deformer, GuardKinds kinds, Span<const GuardDesc> own,
                   const Allocator& allocator, Guard (&out)[kMaxGuards], uint32_t& count,
                   Error& error) {
  count = 0;
  Arena arena(allocator);
  StandardGuards found = {};
  if (kinds != 0) {
    const Status status = find_standard_guards(deformer, allocator, arena, found, error);
    if (status != Status::kOk) return status;
  }
  GuardDesc descs[kMaxGuards];
  uint32_t planned = 0;
  for (uint32_t i = 0; i < found.count; ++i) {
    if ((kinds >> static_cast<uint32_t>(found.kinds[i]) & 1) != 0)
      descs[planned++] = found.descs[i];
  }
  if (own.count > kMaxGuards - planned) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "%u guards of the rig and %zu of the caller; a mix has at most %u", planned,
                own.count, kMaxGuards);
  }
  for (const GuardDesc& desc : own) descs[planned++] = desc;
  if (planned != 0) {
    const Status status =
        probe_guards(deformer, {descs, planned}, allocator, {out, planned}, error);
    if (status != Status::kOk) return status;
  }
  count = planned;
  return Status::kOk;
}

}  // namespace mien
