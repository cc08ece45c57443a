// SPDX-License-Identifier: MIT
#include "integrations/program/speech/mouth.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "integrations/program/gltf/expression_set.h"

namespace mien::speech {

namespace {

// Groups of controls that act together; members of Dominance, and what only closures move.
enum Group : size_t { kJaw, kLips, kRounding, kSpreading, kTongue, kGroups };

/// How far a sound reaches beyond its core, in seconds: the dominance falls to 1/e of its peak there.
struct Reach {
  double before, after;
};
constexpr Reach kReach[kGroups] = {
    {0.085, 0.075},  // jaw
    {0.070, 0.060},  // lips
    {0.150, 0.080},  // rounding: lips protrude well before a rounded vowel
    {0.080, 0.070},  // spreading
    {0.060, 0.050},  // tongue
};
/// The first and the last part of a sound are no core, but a transition.
constexpr double kTransition = 0.05;
/// Further away than this many reaches, a dominance counts as 0: it is below 1e-5.
constexpr double kFarReaches = 3.4;
/// A pause pulls toward rest.
constexpr float kRestDominance = 0.6f;
/// Shorter gaps between phonemes are none of speech.
constexpr double kShortestPause = 0.04;

/// Visemes are held poses. Speech opens the jaw less than half as far.
constexpr float kJawOfSpeech = 0.45f;

// Closures: how long lips take to come together and to part, and at least between two; the jaw, which is
// slower, and turns around before lips or teeth let go; how far open it stays for a lip at the teeth. Lips that
// close need all of it: they meet where they are at rest.
constexpr double kClosing = 0.08, kOpening = 0.07, kQuickest = 0.02, kJawTime = 0.16,
                 kJawTurn = 0.025, kLipTurn = 0.01, kJawOfTeeth = 0.045;
/// The held pose of f brings the lower lip near the teeth; to touch them it rolls in twice as far.
constexpr double kRollToTeeth = 2;
constexpr float kPressToTeeth = 0.7f;  // and is firm
/// Of a stop, the last part is its release.
constexpr double kHeldShare = 0.75;

constexpr const char* kMouthClose = "mouthClose";

struct Controls {
  std::vector<std::string> names;
  std::vector<Group> groups;
  std::map<std::string, std::vector<float>> visemes;  // values of all controls

  Controls() {
    const gltf::ExpressionSet set = gltf::expression_set("visemes22", gltf::MouthClose::kAlone);
    for (const gltf::Expression& expression : set) {
      for (const gltf::NamedValue& value : expression.ways[0].plus) add(value.control);
    }
    add(kMouthClose);
    for (const gltf::Expression& expression : set) {
      std::vector<float>& values = visemes[expression.name];
      values.resize(names.size());
      for (const gltf::NamedValue& value : expression.ways[0].plus) {
        values[index(value.control)] = value.value;
      }
    }
  }
  size_t index(const std::string& name) const {
    return static_cast<size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  }
  void add(const std::string& name) {
    if (index(name) < names.size()) return;
    const auto begins = [&](const char* word) { return name.rfind(word, 0) == 0; };
    names.push_back(name);
    groups.push_back(begins("jaw")                                    ? kJaw
                     : begins("mouthFunnel") || begins("mouthPucker") ? kRounding
                     : begins("mouthSmile") || begins("mouthStretch") ? kSpreading
                     : begins("tongue")                               ? kTongue
                                                                      : kLips);
  }
};

const Controls& controls() {
  static const Controls all;
  return all;
}

/// What pulls the mouth somewhere for a time: a sound, or a pause.
struct Pull {
  double core_begin, core_end;
  float dominance[kGroups];
  std::vector<float> targets;  // of all controls; empty: rest
  bool rounds;
};

Pull pull_of(const Segment& segment, float effort) {
  const Sound& sound = *segment.sound;
  const double transition = std::min(kTransition, (segment.end - segment.begin) / 2);
  const Dominance& d = sound.dominance;
  Pull pull{segment.begin + transition,
            segment.end - transition,
            {d.jaw, d.lips, d.rounding, d.spreading, d.tongue},
            {},
            false};
  pull.targets = controls().visemes.at(sound.viseme);
  for (size_t c = 0; c < pull.targets.size(); ++c) {
    pull.targets[c] *= sound.amount * (sound.is_vowel ? effort : 1.0f);
    if (controls().groups[c] == kJaw) pull.targets[c] *= kJawOfSpeech;
    if (controls().groups[c] == kRounding && pull.targets[c] > 0) pull.rounds = true;
  }
  // What touches is up to the closure; before and after it the lips are as they are at rest.
  const bool by_lips = sound.closure == Closure::kLips || sound.closure == Closure::kLipToTeeth;
  for (size_t c = 0; by_lips && c < pull.targets.size(); ++c) {
    if (controls().groups[c] == kLips) pull.targets[c] = 0;
  }
  return pull;
}

/// Sounds, and the pauses between them.
std::vector<Pull> find_pulls(const std::vector<Segment>& segments, const std::vector<float>& effort,
                             double seconds) {
  std::vector<Pull> pulls;
  double last = -10;
  const auto add_pause = [&](double begin, double end) {
    if (end - begin < kShortestPause) return;
    const double transition = std::min(kTransition, (end - begin) / 2);
    Pull pause{begin + transition, end - transition, {}, {}, false};
    std::fill(std::begin(pause.dominance), std::end(pause.dominance), kRestDominance);
    pulls.push_back(std::move(pause));
  };
  for (const Segment& segment : segments) {
    add_pause(last, segment.begin);
    pulls.push_back(pull_of(segment, effort[segment.phoneme]));
    last = segment.end;
  }
  add_pause(last, std::max(last, seconds) + 10);
  return pulls;
}

double dominance(const Pull& pull, Group group, double time) {
  // Lips round early, but part with it no earlier than they move otherwise.
  const Reach& reach = kReach[group == kRounding && !pull.rounds ? kLips : group];
  double away = 0;
  if (time < pull.core_begin) away = (pull.core_begin - time) / reach.before;
  if (time > pull.core_end) away = (time - pull.core_end) / reach.after;
  return away >= kFarReaches ? 0
                             : static_cast<double>(pull.dominance[group]) * std::exp(-away * away);
}

/// How far closures of a kind hold the jaw up at a time, 0 to 1. `turn`: how long before a closure ends it may let go, and
/// how long after its begin it may arrive.
double jaw_held_at(const std::vector<ClosedTime>& closures, size_t first, Closure kind, double time,
                   double turn) {
  double most = 0;
  for (size_t i = first; i < closures.size() && closures[i].begin - kJawTime < time; ++i) {
    if (closures[i].closure != kind) continue;
    const double inset = std::min((closures[i].end - closures[i].begin) / 2, turn);
    const double away =
        std::max({closures[i].begin + inset - time, time - closures[i].end + inset, 0.0});
    most = std::max(most, ease(1 - away / kJawTime));
  }
  return most;
}

/// How closed something is at a time, 0 to 1.
double closed_at(const std::vector<ClosedTime>& closures, size_t first, Closure kind, double time) {
  double most = 0;
  for (size_t i = first; i < closures.size() && closures[i].begin - kClosing < time; ++i) {
    if (closures[i].closure != kind) continue;
    double closing = kClosing, opening = kOpening;
    if (i > 0) closing = std::min(closing, (closures[i].begin - closures[i - 1].end) / 2);
    // Lips part between two closures, however soon the second follows.
    if (i + 1 < closures.size()) {
      opening = std::min(opening, (closures[i + 1].begin - closures[i].end) / 2);
      // The other lip contact that follows comes in place of this one.
      if (closures[i + 1].closure != kind) {
        opening = std::clamp(closures[i + 1].end - closures[i].end, kQuickest, 2 * kOpening) / 2;
      }
    }
    const double before = (closures[i].begin - time) / std::max(closing, kQuickest);
    const double after = (time - closures[i].end) / std::max(opening, kQuickest);
    most = std::max(most, ease(1 - std::max({before, after, 0.0})));
  }
  return most;
}

}  // namespace

double ease(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (u * (u * 6 - 15) + 10);
}

size_t Curves::control(const std::string& name) const {
  return static_cast<size_t>(std::find(controls.begin(), controls.end(), name) - controls.begin());
}

std::vector<std::string> speech_controls() {
  std::vector<std::string> names = controls().names;
  for (const char* name :
       {"browInnerUp", "browOuterUpLeft", "browOuterUpRight", "eyeBlinkLeft", "eyeBlinkRight"}) {
    names.emplace_back(name);
  }
  return names;
}

std::vector<ClosedTime> find_closures(const std::vector<Segment>& segments, double rate) {
  std::vector<ClosedTime> closures;
  for (size_t s = 0; s < segments.size(); ++s) {
    const Segment& segment = segments[s];
    const Closure closure = segment.sound->closure;
    if (closure == Closure::kNone) continue;
    const bool is_stop = segment.sound->letter == U'p' || segment.sound->letter == U'b';
    const double length = (segment.end - segment.begin) * (is_stop ? kHeldShare : 1);
    // A frame shows it in any case, a second one only if that leaves as much time until the next.
    const auto next = std::find_if(segments.begin() + static_cast<long>(s) + 1, segments.end(),
                                   [](const Segment& other) {
                                     return other.sound->closure == Closure::kLips ||
                                            other.sound->closure == Closure::kLipToTeeth;
                                   });
    const double room = next == segments.end() ? 1 : (next->begin - segment.begin) / 2;
    const double least = std::min(2 / rate, std::max(1 / rate, room));
    ClosedTime closed{closure, segment.begin, segment.begin + std::max(length, least)};
    // Of two like each other, such as those of "mb", the second goes on with the first.
    if (!closures.empty() && closures.back().closure == closure &&
        closed.begin - closures.back().end < kQuickest) {
      closures.back().end = std::max(closures.back().end, closed.end);
      continue;
    }
    // Of two that differ, such as those of "pf", each has its frames.
    if (!closures.empty() && closures.back().closure != Closure::kTeeth &&
        closure != Closure::kTeeth) {
      closed.begin = std::max(closed.begin, closures.back().end);
      closed.end = std::max(closed.end, closed.begin + 2 / rate);
    }
    closures.push_back(closed);
  }
  return closures;
}

void move_mouth(const std::vector<Segment>& segments, const std::vector<float>& effort,
                const std::vector<ClosedTime>& closures, Curves& curves) {
  const Controls& all = controls();
  const double seconds = curves.time(curves.frame_count);
  const std::vector<Pull> pulls = find_pulls(segments, effort, seconds);
  std::vector<ClosedTime> lips;
  for (const ClosedTime& closed : closures) {
    if (closed.closure != Closure::kTeeth) lips.push_back(closed);
  }
  const std::vector<float>& bilabial = all.visemes.at("viseme_21_p");
  std::vector<float> labiodental = all.visemes.at("viseme_18_f");
  labiodental[all.index("mouthRollLower")] *= static_cast<float>(kRollToTeeth);
  for (const char* press : {"mouthPressLeft", "mouthPressRight"}) {
    labiodental[all.index(press)] = kPressToTeeth;
  }
  const size_t count = all.names.size(), jaw = all.index("jawOpen"), close = all.index(kMouthClose),
               funnel = all.index("mouthFunnel");
  std::vector<double> sums(count);
  size_t first_pull = 0, first_closure = 0;
  for (size_t f = 0; f < curves.frame_count; ++f) {
    const double time = curves.time(f);
    const auto is_past = [&](double end) {
      return time - end > kFarReaches * kReach[kRounding].before;
    };
    while (first_pull < pulls.size() && is_past(pulls[first_pull].core_end)) ++first_pull;
    while (first_closure < lips.size() && is_past(lips[first_closure].end)) ++first_closure;

    // A funnel parts the lips, so it waits until they have met.
    double next_contact = 1e9;
    for (size_t i = first_closure; i < lips.size(); ++i) {
      const double middle = (lips[i].begin + lips[i].end) / 2;
      if (middle < time) continue;
      next_contact = middle;
      break;
    }

    // Each value is the mean of the targets, weighted by dominance.
    double weights[kGroups] = {};
    std::fill(sums.begin(), sums.end(), 0.0);
    for (size_t p = first_pull; p < pulls.size(); ++p) {
      const Pull& pull = pulls[p];
      if (pull.core_begin - time > kFarReaches * kReach[kRounding].before) break;
      double own[kGroups];
      for (size_t g = 0; g < kGroups; ++g) {
        own[g] = dominance(pull, static_cast<Group>(g), time);
        weights[g] += own[g];
      }
      for (size_t c = 0; c < pull.targets.size(); ++c) {
        if (c == funnel && pull.core_begin > next_contact) continue;
        sums[c] += own[all.groups[c]] * static_cast<double>(pull.targets[c]);
      }
    }

    // Closures go above that: what opens the lips yields, and mouthClose takes back what the jaw does.
    const double with_lips = closed_at(lips, first_closure, Closure::kLips, time);
    const double with_teeth =
        closed_at(lips, first_closure, Closure::kLipToTeeth, time) * (1 - with_lips);
    const double touching = with_lips + with_teeth;
    const double by_lips = jaw_held_at(lips, first_closure, Closure::kLips, time, kLipTurn);
    const double by_teeth = jaw_held_at(lips, first_closure, Closure::kLipToTeeth, time, kJawTurn);
    const double funnel_held =
        std::max(jaw_held_at(lips, first_closure, Closure::kLips, time, 0),
                 jaw_held_at(lips, first_closure, Closure::kLipToTeeth, time, 0));
    for (size_t c = 0; c < count; ++c) {
      const double weight = weights[all.groups[c]];
      double value = weight > 0 ? sums[c] / weight : 0;
      if (c == jaw) {
        value += by_teeth * (std::min(value, kJawOfTeeth) - value);
        value *= 1 - by_lips;
      } else if (all.groups[c] == kLips) {
        value = value * (1 - touching) + with_lips * static_cast<double>(bilabial[c]) +
                with_teeth * static_cast<double>(labiodental[c]);
      } else if (all.groups[c] == kRounding) {
        // Lips that touch each other may protrude; a lip at the teeth cannot. A funnel parts them,
        // and lowers the jaw of some rigs.
        value *= c == funnel ? 1 - funnel_held : 1 - 0.5 * with_lips - with_teeth;
      } else if (all.groups[c] == kSpreading) {
        value *= 1 - touching * 0.5;
      } else {
        value *= 1 - touching;  // the tongue is behind the lips
      }
      curves.at(f, c) = static_cast<float>(std::clamp(value, 0.0, 1.0));
    }
    curves.at(f, close) = static_cast<float>(with_lips) * curves.at(f, jaw);
  }
}

}  // namespace mien::speech
